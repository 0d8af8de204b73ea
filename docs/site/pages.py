"""Copies the Markdown of the repository, and the files that it links to, to a folder for mkdocs.

    python pages.py OUT     writes OUT/pages and OUT/mkdocs.yml
"""

import json
import re
import shutil
import sys
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
SITE = Path("docs/site")
TOP = ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"]
LINK = re.compile(r"(\]\()([^)#\s:]+)(#[^)\s]*)?(\))")
FENCE = re.compile(r"^( *```)(\w*)[^\n]*\n(.*?)^\1$", re.S | re.M)
PICTURES = (".svg", ".png", ".csv")
LANGUAGES = {".fdc": "fdc", ".rs": "rust", ".c": "c", ".h": "c", ".csv": "text"}


def outside_fences(text, change):
    """The text with its prose changed, and with the tags of fences that mkdocs knows."""
    parts, at = [], 0
    for fence in FENCE.finditer(text):
        parts += [change(text[at : fence.start()])]
        parts += [f"{fence[1]}{fence[2]}\n{fence[3]}{fence[1]}"]
        at = fence.end()
    return "".join(parts) + change(text[at:])


def page_of(target):
    """The page of a file that is not Markdown; pictures and folders are what they are."""
    is_page = target.suffix == ".md" or target.suffix in PICTURES
    return target if is_page else target.with_name(target.name + ".md")


def links(source, text, linked):
    """The text with links to code leading to pages of code. What is linked is added to `linked`."""

    def link(match):
        target = (ROOT / source.parent / match[2]).resolve()
        if not target.is_file():
            return match[0]
        target = target.relative_to(ROOT)
        linked.add(target)
        new = match[2].removesuffix(target.name) + page_of(target).name
        return f"{match[1]}{new}{match[3] or ''}{match[4]}"

    def prose(text):
        # A comment in front of a table hides it from mkdocs.
        return LINK.sub(link, re.sub(r"<!--.*?-->\n*", "", text, flags=re.S))

    return outside_fences(text, prose)


def notebook(text):
    cells = [(cell["cell_type"], "".join(cell["source"])) for cell in json.loads(text)["cells"]]
    return "\n\n".join(it if kind == "markdown" else f"```python\n{it}\n```" for kind, it in cells)


def code_page(path, text):
    if path.suffix == ".ipynb":
        return notebook(text) + "\n"
    language = LANGUAGES.get(path.suffix, "text")
    return f"---\nsearch: {{ exclude: true }}\n---\n\n# {path.name}\n\n`{path}`\n\n```{language}\n{text}```\n"


def write(pages):
    """All pages, and the files that they link to."""
    sources = [Path(it) for it in TOP]
    sources += sorted(it.relative_to(ROOT) for it in (ROOT / "docs").rglob("*.md"))
    linked = set()
    for source in sources:
        target = pages / source
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(links(source, (ROOT / source).read_text(), linked))
    for path in sorted(linked - set(sources)):
        target = pages / page_of(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix in PICTURES:
            shutil.copy(ROOT / path, target)
        else:
            target.write_text(code_page(path, (ROOT / path).read_text()))
    shutil.copytree(ROOT / SITE / "static", pages / "static")


def title(path):
    return re.search(r"^# (.*)", (ROOT / path).read_text(), re.M)[1].replace("`", "")


def named(pattern, *first):
    """The pages of a folder by their titles, some of them first."""
    paths = {str(it.relative_to(ROOT)) for it in ROOT.glob(pattern)}
    order = [*first, *sorted(paths - set(first))]
    return [{title(path): path} for path in order]


def listed(path):
    """The pages of a folder in the order in which its first page links to them."""
    folder = Path(path).parent
    found = [str(folder / link[2]) for link in LINK.finditer((ROOT / path).read_text())]
    ours = [it for it in dict.fromkeys(found) if it.endswith(".md") and Path(it).parent == folder]
    return [{title(it): it} for it in ours]


def is_development(entry):
    """Whether a recipe is for those who change fdcc."""
    return any(Path(path).name.startswith(("add-", "change-", "fuzz")) for path in entry.values())


def navigation():
    recipes = listed("docs/recipes/README.md")
    docs = lambda *names: [{title(it): it} for it in (f"docs/{name}.md" for name in names)]
    return [
        {"Home": ["README.md", *docs("comparison", "paper", "glossary"), {"Changes": "CHANGELOG.md"}]},
        {"Tutorial": docs("tutorial", "report", "python", "library", "real-time", "clusters", "editors")},
        {"Recipes": ["docs/recipes/README.md", *(it for it in recipes if not is_development(it))]},
        {"Reference": ["docs/reference/index.md", *listed("docs/reference/index.md")]},
        {"Method": named("docs/method/*.md", "docs/method/transcription.md", "docs/method/smoothing.md",
                         "docs/method/true-optimum.md", "docs/method/verdict.md")
                   + docs("performance", "random-problems", "hostile-inputs")},
        {"Gallery": docs("gallery")},
        {"Diagnostics": named("docs/diagnostics/*.md")},
        {"Development": [
            {"Contributing": "CONTRIBUTING.md"},
            {"Architecture": "ARCHITECTURE.md"},
            {"Recipes": [it for it in recipes if is_development(it)]},
            {"Decisions": named("docs/decisions/*.md")},
        ]},
    ]


def main():
    out = Path(sys.argv[1]).resolve()
    shutil.rmtree(out / "pages", ignore_errors=True)
    write(out / "pages")
    settings = {
        "INHERIT": str(ROOT / SITE / "mkdocs.yml"),
        "docs_dir": str(out / "pages"),
        "site_dir": str(out / "html"),
        "hooks": [str(ROOT / SITE / "hooks.py")],
        "not_in_nav": "*.fdc.md\n*.rs.md\n*.c.md\n*.h.md\n*.ipynb.md\nLICENSE*.md\n",
        "nav": navigation(),
    }
    (out / "mkdocs.yml").write_text(yaml.safe_dump(settings, sort_keys=False, allow_unicode=True))


main()
