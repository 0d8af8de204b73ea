"""Whether two builds of `fdcc` say the same, to the byte: `same_numbers.py OLD NEW [classics]`.

Runs check, fmt, solve, verify, simulate, grad, test and sweep on all models with both, and prints every difference; with
`classics` on those of `tests/classics/`, too, which takes long unless both are release builds. Seconds and the version are left out, since they differ between any two runs or builds.
"""

import itertools
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MODELS = sorted(ROOT.glob("models/*.fdc"))
CLASSICS = sorted(ROOT.glob("tests/classics/*.fdc")) if "classics" in sys.argv else []
TIME_LIMIT = 300.0

# What differs between any two runs: "compile": 0.01, `0.035 s` at the end of a verdict, and the column of a table.
VOLATILE = [
    (re.compile(r'"(compile|solve|total)": [0-9.e-]+'), r'"\1": 0'),
    (re.compile(r'"fdcc": "[^"]*"'), '"fdcc": ""'),
    (re.compile(r"\d+\.\d{3} s$", re.M), "0 s"),
    (re.compile(r" +\d+\.\d{3}(?=  [a-z_ ]+$)", re.M), "  0"),
]


def said(binary, arguments):
    """Exit code, standard output and standard error."""
    command = [binary, *map(str, arguments)]
    try:
        run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=TIME_LIMIT, check=False)
    except subprocess.TimeoutExpired:
        return "took too long"
    text = f"exit {run.returncode}\n{run.stdout}\n{run.stderr}"
    for pattern, instead in VOLATILE:
        text = pattern.sub(instead, text)
    return text


def cases(folder):
    """Argument lists; those that read a solution come after the one that writes it."""
    for model in MODELS + CLASSICS:
        solution = folder / f"{model.stem}.sol.json"
        yield [
            ["check", "--format", "json", model],
            ["show", model],
            ["solve", model, "--json", "--log", "none", "--out", folder],
            ["verify", solution, model, "--json"],
            ["simulate", model, "--json"],
            ["grad", model, "--json"],
        ]
    for model in MODELS:
        solution = folder / f"{model.stem}.sol.json"
        yield [
            ["solve", model, "--log", "none", "--out", folder],
            ["solve", model, "--log", "full", "--no-verify", "--method", "N=20"],
            ["solve", model, "--json", "--log", "full", "--no-verify", "--method", "N=20", "--starts", "3"],
            ["solve", model, "--json", "--log", "none", "--warm", solution],
            ["solve", model, "--json", "--log", "none", "--method", "N=auto"],
            ["test", model, "--method", "N=40"],
            ["sweep", model, "N=20,30", "--json", "--log", "none", "--confirmed"],
            ["sweep", model, "N=20,20,30", "--continue", "--json", "--log", "none"],
            ["verify", solution, model],
            ["simulate", model, "--control", solution],
            ["grad", model, "--control", solution, "--second"],
            ["fmt", "--check", model],
        ]


def compared(old, new, arguments_of):
    """The differences of a group of cases, each binary with a folder of its own."""
    with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
        found, count = [], 0
        for left, right in zip(arguments_of(Path(one)), arguments_of(Path(other))):
            count += 1
            texts = [said(old, left).replace(one, "OUT"), said(new, right).replace(other, "OUT")]
            # Several starts or sequences of jumps end in any order; so do their lines on the standard error.
            if "--starts" in left or "full" in left:
                texts = ["\n".join(sorted(text.splitlines())) for text in texts]
            if texts[0] != texts[1]:
                found.append((" ".join(map(str, left)).replace(one, "OUT"), texts))
        return count, found


def main(old, new):
    groups = len(list(cases(Path())))
    group = lambda at: lambda folder: next(itertools.islice(cases(folder), at, None))
    # A group of the second kind needs a solution, so it solves first.
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda at: compared(old, new, group(at)), range(groups)))
    for command, texts in itertools.chain.from_iterable(found for _, found in results):
        lines = zip(*(text.splitlines() for text in texts))
        first = next((pair for pair in lines if pair[0] != pair[1]), tuple(f"{len(text)} bytes" for text in texts))
        print(f"{command}\n  old {first[0][:200]}\n  new {first[1][:200]}")
    differences = sum(len(found) for _, found in results)
    print(f"{sum(count for count, _ in results)} commands, {differences} differ")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main(*(str(Path(path).resolve()) for path in sys.argv[1:3])))
