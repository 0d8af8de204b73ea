#!/usr/bin/env python3
"""Every model of the tests, and chains of masses with friction, by both factorisations of the interior point method.

    python3 tests/peers/factorisations.py target/release/fdcc

Of the models that the recursion solves it prints those where the sparse factorisation does not end with the same status, an
objective that agrees to 1e-8, and a number of iterations that differs by no more than 10 %, or 3. The table is in
docs/decisions/0029-pivots-in-the-sparse-factorisation.md.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ["models", "tests/classics", "tests/right"]
SECONDS = 60


def chain(masses, stiffness=20, ends="last"):
    """Masses on springs and dampers, all with friction, the last of them pulled."""
    each = range(1, masses + 1)
    lines = ["time t in [0, 4]", "control F in [-50, 50]"]
    rates = []
    for i in each:
        lines += [f"state x{i} start 0", f"state v{i} start 0", f"surface slip{i} = v{i}"]
        left = f"- {stiffness}*(x{i} - x{i - 1}) - 0.5*(v{i} - v{i - 1})" if i > 1 else ""
        right = f"+ {stiffness}*(x{i + 1} - x{i}) + 0.5*(v{i + 1} - v{i})" if i < masses else "+ F"
        rates += [f"x{i}' = v{i}", f"v{i}' in -0.4*Sgn(slip{i}) {left} {right}"]
    lines += ["dynamics {", *rates, "}"]
    lines += [f"end x{i} == 0.5" for i in each if ends == "all" or i == (1 if ends == "first" else masses)]
    lines += [f"end v{i} == 0" for i in each if ends in ("all", "rest")]
    return "\n".join([*lines, "minimize integral(F^2)", "method { N = 100  sigma = 0.05 }"]) + "\n"


def chains(folder):
    for states in (6, 12, 14, 18, 24):
        for ends in ("last", "first", "rest", "all"):
            path = Path(folder) / f"chain of {states} states, {ends}.fdc"
            path.write_text(chain(states // 2, ends=ends))
            yield path


def solve(fdcc, path, linear):
    """Status, objective, iterations and seconds; None where it is not solved at all."""
    command = [fdcc, "solve", path, "--json", "--no-verify", "--log", "none", "--time-limit", str(SECONDS)]
    command += ["--method", "solver=interior_point", "--method", f"linear={linear}"]
    run = subprocess.run(command, capture_output=True, text=True)
    if not run.stdout.startswith("{"):
        return None
    answer = json.loads(run.stdout)
    return (answer["status"], answer["objective"], answer["iterations"], answer["seconds"]["solve"])


def differences(one, other):
    words = []
    if one[0] != other[0]:
        words.append("status")
    elif one[1] is not None and abs(one[1] - other[1]) > 1e-8 * max(1.0, abs(one[1])):
        words.append("objective")
    if abs(one[2] - other[2]) > max(3, 0.1 * one[2]):
        words.append("iterations")
    return ", ".join(words)


def row(name, one, other):
    cells = [name, one[0], other[0], f"{one[1]:.10g}", f"{abs(one[1] - other[1]) / max(1, abs(one[1])):.0e}"]
    cells += [one[2], other[2], f"{one[3]:.3f}", f"{other[3]:.3f}", differences(one, other)]
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def main(fdcc):
    print("| model | riccati | sparse_ldl | objective | differs by | iterations | iterations | s | s | differs |")
    print("|---|---|---|---|---|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        models = [path for place in FOLDERS for path in sorted((ROOT / place).glob("*.fdc"))]
        solved = different = 0
        for path in [*models, *chains(folder)]:
            one = solve(fdcc, path, "riccati")
            if one is None or one[0] != "solved":
                continue
            other = solve(fdcc, path, "sparse_ldl")
            solved, different = solved + 1, different + bool(differences(one, other))
            if differences(one, other):
                print(row(path.stem, one, other), flush=True)
    print(f"\n{solved} models, {different} of them different.")


if __name__ == "__main__":
    main(sys.argv[1])
