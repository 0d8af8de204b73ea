#!/usr/bin/env python3
"""Takes the pictures of docs/report.md: pages of solutions in Chromium, at three widths; and of the site, if it was built
(docs/site/build).

    cargo build --release && python3 docs/pictures/make.py target/release/fdcc

Needs Chromium, and Pillow to make the files small.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
FOLDER = Path(__file__).resolve().parent
# Pages, and the widths and heights at which they are looked at.
SIZES = [(400, 1500), (1200, 1700), (1920, 1500)]
MODELS = ["racecar", "block", "bounce", "slider_fit"]
# That of the paper, whose replay leaves the track.
SMOOTHED = {"racecar": ["--method", "sigma=0.1"]}
SWEEP = ["sweep", "block.fdc", "mu=0.1,0.2,0.3", "--out", "all", "--trajectories", "--log", "none"]
# One look at each is enough.
PRODUCT = ["sweep", "block.fdc", "mu=0.05:0.05:0.6", "m=0.5:0.25:3", "sigma=0.1", "N=50", "--product",
           "--out", "product", "--log", "none"]
# The first model of the page is the block.
FOLLOW = (ROOT / "docs" / "real-time.md").read_text().split("```fdc\n")[1].split("```")[0]
# Twenty parts of a rod that is heated at one end.
PARTS = 20
CELLS = range(1, PARTS + 1)
ROD = "\n".join([
    "model rod", "time t in [0, 1] [s]", "control heat [K/s] in [0, 400]",
    *(f"state T{at} [K] start 20" for at in CELLS), "dynamics {",
    *(f"  T{at}' = (T{max(at - 1, 1)} - 2*T{at} + T{min(at + 1, PARTS)})*60[1/s]{' + heat' if at == 1 else ''}"
      for at in CELLS), "}",
    f"minimize (T{PARTS}(end)/1[K] - 40)^2 + integral((heat/1[K/s])^2)*1e-3/1[s]",
    "method { N = 60  scheme = gauss2 }", ""])
DARK = ["--force-dark-mode", "--blink-settings=preferredColorScheme=0"]


def shoot(page, picture, width, height, *options, has_shades=False):
    """Chromium windows are not narrower than 500 pixels: a narrow page stands in a frame."""
    if width < 500:
        frame = page.with_name(f"{page.stem}.frame.html")
        frame.write_text(
            f'<body style="margin:0"><iframe src="{page.name}" width="{width}" height="{height}" '
            'style="border:0"></iframe>'
        )
        page = frame
    subprocess.run(
        ["chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
         "--virtual-time-budget=4000", f"--window-size={max(width, 500)},{height}",
         *options, f"--screenshot={picture}", f"file://{page}"],
        check=True, capture_output=True,
    )
    image = Image.open(picture).convert("RGB").crop((0, 0, width, height))
    # Hundreds of shades would take the colours of the words.
    image = image if has_shades else image.quantize(128, dither=Image.Dither.NONE)
    image.save(picture, optimize=True)


def shoot_site():
    pages = ROOT / "target" / "site" / "html" / "docs"
    if pages.exists():
        shoot(pages / "reference" / "jumps.html", FOLDER / "site-1280.png", 1280, 1000)
        shoot(pages / "recipes" / "index.html", FOLDER / "site-400.png", 400, 1000, *DARK)


def main():
    fdcc = str(Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)

        def run(*arguments):
            subprocess.run([fdcc, *arguments], check=True, capture_output=True, cwd=folder)

        for name in MODELS:
            run("solve", str(ROOT / "models" / f"{name}.fdc"), "--out", ".", "--log", "none", *SMOOTHED.get(name, []))
        (folder / "block.fdc").write_text((ROOT / "models" / "block.fdc").read_text())
        run(*SWEEP)
        run("report", *(f"all/block.{row}.sol.json" for row in (1, 2, 3)), "--out", "sweep.html")
        for name in [*MODELS, "sweep"]:
            for width, height in SIZES:
                picture = FOLDER / f"{name}-{width}.png"
                shoot(folder / f"{name}.html", picture, width, height)
        run("solve", str(ROOT / "models" / "racecar.fdc"), "--out", "certified", "--log", "none")
        shoot(folder / "certified" / "racecar.html", FOLDER / "course-1200.png", 1200, 1500)
        (folder / "rod.fdc").write_text(ROD)
        run("solve", "rod.fdc", "--out", ".", "--log", "none")
        shoot(folder / "rod.html", FOLDER / "rod-1200.png", 1200, 1000, has_shades=True)
        run("grad", str(ROOT / "models" / "crossing.fdc"), "--out", ".")
        shoot(folder / "crossing.grad.html", FOLDER / "grad-1200.png", 1200, 900)
        (folder / "follow.fdc").write_text(FOLLOW)
        run("mpc", "follow.fdc", "--steps", "60", "--out", ".")
        shoot(folder / "block.mpc.html", FOLDER / "mpc-1200.png", 1200, 820)
        # Some rows need more force than there is, which is exit code 2.
        subprocess.run([fdcc, *PRODUCT], capture_output=True, cwd=folder)
        [page] = (folder / "product").glob("*.html")
        shoot(page, FOLDER / "product-1200.png", 1200, 920)
        dark = FOLDER / "block-dark.png"
        shoot(folder / "block.html", dark, 1200, 1000, *DARK)
    shoot_site()


main()
