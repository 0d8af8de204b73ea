#!/usr/bin/env python3
"""Solves the models of the gallery and writes docs/gallery.md with a picture of each.

    cargo build --release && python3 docs/gallery/make.py target/release/fdcc
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "gallery"

# The models of a chapter: a name, and what is drawn; states and controls if nothing is said.
CHAPTERS = {
    "Friction": {
        "models/block": ["v", "F"],
        "models/puck": ["vel.x", "force.x"],
        "models/stacked": [],
        "models/coulomb_energy": [],
        "models/coulomb_rest": [],
        "models/coulomb_reverse": [],
        "tests/classics/switched/belt": [],
        "tests/classics/switched/free_time": [],
        "tests/classics/switched/uphill_soon": [],
        "tests/classics/switched/turn_round": [],
        "tests/classics/switched/two_contacts": [],
        "tests/classics/switched/power_limit": [],
        "tests/classics/switched/speed_limit": [],
        "models/racecar": ["pos.y", "over", "pos.x"],
    },
    "Switches and relays": {
        "models/crossing": [],
        "models/turbo": [],
        "tests/classics/switched/overdrive": [],
        "tests/classics/switched/drag_regimes": [],
        "tests/classics/switched/relay": [],
        "tests/classics/switched/two_relays": [],
        "tests/classics/switched/shoreline": [],
        "tests/classics/switched/toll": [],
        "tests/classics/switched/window": [],
        "tests/classics/switched/twins": [],
        "tests/classics/switched/heater": [],
    },
    "Impacts and phases": {
        "models/bounce": ["h", "over", "x"],
        "tests/classics/switched/wall": [],
        "tests/classics/switched/ricochet": [],
        "tests/classics/phases/gear_shift": [],
        "tests/classics/phases/hopper": [],
        "tests/classics/phases/walker": [],
        "tests/classics/phases/via_point": [],
    },
    "Measured data": {
        "models/slider_fit": ["x", "v"],
        "tests/classics/fits/bouncing_ball": [],
        "tests/classics/fits/damped_oscillator": [],
    },
    "Smooth problems": {
        "tests/classics/brachistochrone": ["pos.y", "over", "pos.x"],
        "tests/classics/bryson_denham": [],
        "tests/classics/cart_pole": [],
        "tests/classics/container_crane": [],
        "tests/classics/dubins": ["y", "over", "x"],
        "tests/classics/goddard": [],
        "tests/classics/hang_glider": [],
        "tests/classics/hanging_chain": [],
        "tests/classics/min_fuel": [],
        "tests/classics/moon_lander": [],
        "tests/classics/mountain_car": [],
        "tests/classics/rayleigh": [],
        "tests/classics/tumor": [],
        "tests/classics/van_der_pol": [],
        "tests/classics/van_der_pol_singular": [],
        "tests/classics/zermelo": ["y", "over", "x"],
        "models/double_integrator": [],
        "models/regulator": [],
    },
}
# More plots than these make no picture.
MOST = 3


def run(*arguments):
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=120)
    return done.returncode, done.stdout, done.stderr


def description(text):
    """The comment at the top of a model."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("#!").strip())
        if line.rstrip().endswith((".", ":")):
            break
    return " ".join(lines).rstrip(".:") + "."


def options(signals, known):
    if "over" in signals and all(it in known for it in (signals[0], signals[2])):
        return ["--signal", signals[0], "--over", signals[2]]
    signals = [it for it in signals if it in known] or known[:MOST]
    return [word for name in signals for word in ("--signal", name)]


def entry(fdcc, path, signals, folder):
    """The words about a model; its picture is written."""
    model = ROOT / f"{path}.fdc"
    text = model.read_text()
    code, verdict, complaint = run(fdcc, "solve", str(model), "--log", "none", "--out", str(folder))
    written = re.search(r"wrote (\S+\.sol\.json)", verdict)
    if code != 0 or not written:
        sys.exit(f"{path}: {verdict}{complaint}")
    _, _, known = run(fdcc, "plot", written[1], "--signal", "?", "--out", "x.svg")
    known = re.sub(r".*there are: ", "", known.strip()).split(", ")
    picture = FOLDER / f"{model.stem}.svg"
    code, _, complaint = run(
        fdcc, "plot", written[1], *options(signals, known), "--out", str(picture)
    )
    if code != 0:
        sys.exit(f"{path}: {complaint}")
    lines = verdict.splitlines()
    begin = next(at for at, line in enumerate(lines) if line.startswith(" done"))
    told = "\n".join(line.rstrip() for line in lines[begin : begin + 2])
    return (
        f"### {model.stem}\n\n{description(text)} [The model](../{path}.fdc).\n\n"
        f"```text\n{told}\n```\n\n![{model.stem}](gallery/{picture.name})\n"
    )


def main():
    fdcc = str(Path(sys.argv[1]).resolve())
    pages = [
        "# Gallery\n\nModels of this repository with what `fdcc solve` says of them, and pictures by `fdcc plot`: "
        "blue is the solution, dashed orange its replay on the true system, shaded where a surface is held, "
        "dashed red a limit. Written by `python3 docs/gallery/make.py target/release/fdcc`.\n"
    ]
    with tempfile.TemporaryDirectory() as folder:
        for chapter, models in CHAPTERS.items():
            pages.append(f"## {chapter}\n")
            pages += [entry(fdcc, path, signals, Path(folder)) for path, signals in models.items()]
    (ROOT / "docs" / "gallery.md").write_text("\n".join(pages))


main()
