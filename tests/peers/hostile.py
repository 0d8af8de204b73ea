#!/usr/bin/env python3
"""Inputs that nobody writes, each at two sizes, with the time and the peak memory that `fdcc` takes for it.

    tests/peers/hostile.py [--check] [FDCC]

writes docs/hostile-inputs.md, with FDCC or target/release/fdcc. `--check` writes nothing, and fails where an input takes more
than LONGEST seconds or LARGEST MB, where one that is twice as large takes more than GROWTH times as long, or where an answer
has another exit code. Needs /usr/bin/time (GNU).
"""

import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
LONGEST, LARGEST, GROWTH = 30.0, 4000.0, 3.0
# Below this a ratio of times says nothing.
SHORT = 0.5

HEAD = "time t in [0, 1]\nstate x start 0.5\nstate v start 0\ncontrol u in [-1, 1]\n"
COST = "minimize integral(u^2)\n"


def motion(right, method="N = 10", more="", sign="="):
    """A model whose speed changes as the right side says."""
    return f"{HEAD}{more}dynamics {{\n  x' = v\n  v' {sign} u + {right}\n}}\n{COST}method {{ {method} }}\n"


def total(n, term):
    return " + ".join(term(i) for i in range(1, n + 1))


def nested(n, wrap, inner="x"):
    for _ in range(n):
        inner = wrap(inner)
    return inner


def chain(n, first, step):
    """A `let` for each level, of the one before."""
    return f"let l0 = {first}\n" + "".join(f"let l{i} = {step(f'l{i - 1}')}\n" for i in range(1, n))


def signs(n):
    surfaces = "".join(f"surface s{i} = v - {i}\n" for i in range(1, n + 1))
    return motion(total(n, lambda i: f"Sgn(s{i})"), "N = 10 scheme = rk4", surfaces, "in")


def stacked(n):
    states = "".join(f"state x{i} start 0\n" for i in range(n))
    rates = "".join(f"  x{i}' = u * x{(i + 1) % n} - x{i}\n" for i in range(n))
    head = "time t in [0, 1]\ncontrol u in [-1, 1]\n"
    return f"{head}{states}dynamics {{\n{rates}}}\n{COST}method {{ N = 10 scheme = rk4 }}\n"


def phases(n):
    each = lambda i: f"phase a{i} {{ state x{i} start 0 dynamics {{ x{i}' = 1 }} }}\n"
    return "time t in [0, 1]\n" + "".join(map(each, range(n)))


def arms(n):
    return "piecewise { " + " ".join(f"t <= {i}/{n} => {i}" for i in range(n)) + " otherwise => 0 }"


def apart(n):
    each = lambda i: f"phase a{i} {{ time t in [0, 1] state x{i} start 0 dynamics {{ x{i}' = 1 }} }}\n"
    return "".join(map(each, range(n)))


def table(n):
    """A model with a curve through n rows, and the rows."""
    data = 'data obs = csv("table.csv") columns t, y\n'
    rows = "".join(f"{i / (n - 1)},{(7 * i) % 11}\n" for i in range(n))
    return motion("interpolate(obs.t, obs.y, t)", more=data), "t,y\n" + rows


def sized(steps):
    return lambda n: motion("-x", f"N = 10 steps = {n}" if steps else f"N = {n}")


CHECK, SOLVE = ["check", "--format", "short"], ["solve", "--no-verify", "--log", "none", "--time-limit", "3"]
GRAD = ["grad", "--of", "x(end)", "--wrt", "x(start)"]

# What it is, the sizes, the model, the command, and the exit codes that it may have.
INPUTS = [
    ("rk4, a sum of n sines", 100, lambda n: motion(total(n, lambda i: f"sin({i}*x)"), "N = 10 scheme = rk4"), SOLVE, {0, 2}),
    ("rk4, a sum of n sines of two states", 100, lambda n: motion(total(n, lambda i: f"sin({i}*x + v)"), "N = 10 scheme = rk4"), SOLVE, {0, 2}),
    ("rk4, n surfaces", 50, signs, SOLVE, {0, 2}),
    ("rk4, n coupled states", 40, stacked, SOLVE, {0, 2}),
    ("Euler, a sum of n sines", 500, lambda n: motion(total(n, lambda i: f"sin({i}*x)")), SOLVE, {0, 2}),
    ("`simulate`, a sum of n sines", 500, lambda n: motion(total(n, lambda i: f"sin({i}*x)")), ["simulate"], {0, 2}),
    ("`grad`, a sum of n sines", 50, lambda n: motion(total(n, lambda i: f"sin({i}*x)")), GRAD, {0, 2}),
    ("`blend(abs(...), w)` nested n deep", 16, lambda n: motion(nested(n, lambda e: f"blend(abs({e} - 0.1), 0.1)")), CHECK, {0, 1}),
    ("`blend(abs, w)(...)` nested n deep", 16, lambda n: motion(nested(n, lambda e: f"blend(abs, 0.1)({e})")), CHECK, {0, 1}),
    ("`blend` of itself and another kink, n times", 100, lambda n: motion(f"l{n - 1}", more=chain(n, "abs(x)", lambda e: f"blend(abs({e} - 0.1) + max({e}, 0.2), 0.1)")), CHECK, {0, 1}),
    ("a function of itself twice, n deep", 16, lambda n: motion(f"f{n}(x)", more="fn f0(y) = sin(y)\n" + "".join(f"fn f{i}(y) = f{i - 1}(y) * f{i - 1}(2*y)\n" for i in range(1, n + 1))), CHECK, {0, 1}),
    ("`piecewise` nested n deep", 40, lambda n: motion(nested(n, lambda e: f"piecewise {{ {e} <= 1 => x otherwise => 1 }}")), CHECK, {0, 1}),
    ("n `let` of the one before", 2_000, lambda n: motion(f"l{n - 1}", more=chain(n, "x", lambda e: f"0.5 * {e} + sin(x)")), CHECK, {0, 1}),
    ("n nested `phase a {` on lines", 20_000, lambda n: "phase a {\n" * n, CHECK, {1}),
    ("n nested `phase a {` on one line", 20_000, lambda n: "phase a { " * n, CHECK, {1}),
    ("n nested phases, closed", 20_000, lambda n: "phase a {\n" * n + "}\n" * n, CHECK, {1}),
    ("n phases side by side", 1_000, phases, CHECK, {0, 1}),
    ("n phases with times of their own", 1_000, apart, CHECK, {0, 1}),
    ("n conditions `at` times", 8_000, lambda n: motion("x", more="".join(f"at {(i + 1) / (n + 2)}: x <= 1\n" for i in range(n))), CHECK, {0, 1}),
    ("a report of one `piecewise` of n arms", 2_000, lambda n: motion("x", more=f"report {{ q = {arms(n)} }}\n"), CHECK, {0, 1}),
    ("`interpolate` of n rows", 1_000, table, ["show"], {0, 1}),
    ("`simulate`, `interpolate` of n rows", 500, table, ["simulate"], {0, 2}),
    ("n `param` that nothing mentions", 100_000, lambda n: "".join(f"param p{i} = {i}\n" for i in range(n)), CHECK, {0, 1}),
    ("n `param` in one sum", 10_000, lambda n: motion(total(n, lambda i: f"p{i}"), more="".join(f"param p{i} = {i}\n" for i in range(1, n + 1))), CHECK, {0, 1}),
    ("n states", 1_000, stacked, CHECK, {0, 1}),
    ("n times the same name", 50_000, lambda n: "param p = 1\n" * n, CHECK, {1}),
    ("n unknown names", 20_000, lambda n: motion(total(n, lambda i: f"q{i}")), CHECK, {1}),
    ("a block without its brace, n lines", 20_000, lambda n: "dynamics\n" + "x y\n" * n, CHECK, {1}),
    ("n lines that no item begins with", 100_000, lambda n: "x y\n" * n, CHECK, {1}),
    ("a unit that never ends, n words", 100_000, lambda n: "param a = 1 [" + "m " * n, CHECK, {1}),
    ("n times `start )`", 50_000, lambda n: "state x " + "start ) " * n, CHECK, {1}),
    ("n comments that allow what there is not", 20_000, lambda n: "# fdc: allow FDC0404\n" * n + motion("x"), CHECK, {0, 1}),
    ("n lines of one sum", 5_000, lambda n: motion("\n+ ".join(["x"] * n)), CHECK, {0, 1}),
    ("a name of n letters", 20_000, lambda n: f"param {'a' * n} = 1\n", CHECK, {1}),
    ("n names of 255 letters", 5_000, lambda n: "".join(f"param {'a' * 240}{i:015d} = 1\n" for i in range(n)), CHECK, {0, 1}),
    ("a number of n digits", 200, lambda n: f"param a = {'9' * n}\n", CHECK, {0, 1}),
    ("a number of 10^n", 400, lambda n: f"param a = 1e{n}\n", CHECK, {1}),
    ("a unit to the power n", 1_000_000, lambda n: f"param a = 1 [m^{n}]\n", CHECK, {0, 1}),
    ("`solve`, N = n", 100_000, sized(False), SOLVE, {0, 2}),
    ("`solve`, N = n, refused", 1_000_000_000, sized(False), SOLVE, {1, 3}),
    ("`solve`, N = 10 and steps = n", 2_000, sized(True), SOLVE, {0, 2}),
    ("`solve`, N = 10 and steps = n, refused", 1_000_000, sized(True), SOLVE, {1, 3}),
    ("`grad --method N=1000000000`, refused", 1, lambda n: motion("-x"), GRAD + ["--method", "N=1000000000"], {3}),
    ("`grad --method steps=1e300`, refused", 1, lambda n: motion("-x"), GRAD + ["--method", "steps=1e300"], {3}),
    ("`simulate`, a stiff system of stiffness n", 1_000_000, lambda n: motion(f"-{n}*v"), ["simulate"], {0, 2}),
    ("a fraction of a second to compile what takes longer", 400, lambda n: motion(total(n, lambda i: f"sin({i}*x + v)"), "N = 10 scheme = rk4"), ["solve", "--log", "none", "--time-limit", "0.1"], {0, 2}),
]


def measured(fdcc, folder, text, command):
    """Seconds, MB, exit code and the last line of what was said."""
    model = folder / "model.fdc"
    text, rows = text if isinstance(text, tuple) else (text, "")
    (folder / "table.csv").write_text(rows)
    model.write_text(text)
    timed = ["/usr/bin/time", "-q", "-f", "%e %M", "-o", str(folder / "time")]
    run = [fdcc, command[0], str(model), *command[1:]]
    done = subprocess.run(timed + run, capture_output=True, text=True, errors="replace", timeout=600)
    seconds, kilobytes = (folder / "time").read_text().split()[-2:]
    said = (done.stderr.strip() or done.stdout.strip() or "nothing").splitlines()
    return float(seconds), float(kilobytes) / 1000, done.returncode, said


def found(fdcc):
    """A row for each input, and what is wrong."""
    rows, wrong = [], []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for what, size, text, command, codes in INPUTS:
            pair = [measured(fdcc, folder, text(n), command) for n in (size, 2 * size)]
            rows.append((what, command[0], size, pair))
            print(what, size, *[it[:3] for it in pair], file=sys.stderr)
            wrong += complaints(what, pair, codes)
    return rows, wrong


def complaints(what, pair, codes):
    (short, _, _, _), (long, _, _, _) = pair
    if long > SHORT and long > GROWTH * max(short, SHORT / GROWTH) and what not in LIMITED:
        yield f"{what}: twice the size takes {long / short:.1f} times as long"
    for seconds, megabytes, code, said in pair:
        if code not in codes or any("panicked" in line for line in said):
            yield f"{what}: exit code {code}: {said[-1]}"
        if seconds > LONGEST or megabytes > LARGEST:
            yield f"{what}: {seconds} s, {megabytes} MB"


# Here a solver runs until its time is up.
LIMITED = {row[0] for row in INPUTS if row[3] is SOLVE}

INTRODUCTION = """# Hostile inputs

Texts and options that nobody writes, each at a size n and at twice that size: what `fdcc` takes for them, measured with
`/usr/bin/time` as wall-clock seconds and peak memory. An answer comes at once or in proportion to the size. What is too large is
refused before memory is asked for. `solve` has a time limit of 3 s here, which counts from its first look at the text.

`tests/peers/hostile.py` makes this page; `tests/peers/hostile.py --check` fails where twice the size takes more than three times as long.

| input | command | n | s | MB | exit | 2n: s | MB | exit |
|---|---|---|---|---|---|---|---|---|
"""


def page(rows):
    text = INTRODUCTION
    for what, command, size, ((s, mb, code, _), (s2, mb2, code2, _)) in rows:
        text += f"| {what} | `{command}` | {size} | {s:.2f} | {mb:.0f} | {code} | {s2:.2f} | {mb2:.0f} | {code2} |\n"
    return text


def main():
    arguments = [it for it in sys.argv[1:] if it != "--check"]
    fdcc = arguments[0] if arguments else str(ROOT / "target/release/fdcc")
    rows, wrong = found(fdcc)
    print(*wrong, sep="\n", file=sys.stderr)
    if "--check" not in sys.argv:
        (ROOT / "docs/hostile-inputs.md").write_text(page(rows))
    sys.exit(1 if wrong else 0)


main()
