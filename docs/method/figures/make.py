#!/usr/bin/env python3
"""Draws certified optima for docs/method: the pictures that no test writes.

    pip install matplotlib && cargo build --release && python3 docs/method/figures/make.py target/release/fdcc
"""

import json
import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

ROOT = Path(__file__).resolve().parents[3]
FOLDER = Path(__file__).resolve().parent
# Colours that also the colour-blind tell apart (M. Okabe, K. Ito).
BLUE, RED, GREEN = "#0072b2", "#d55e00", "#009e73"
MODES = {
    "held": "#999999", "above": "#56b4e9", "below": "#e69f00",
    "free": "#dddddd", "max": "#009e73", "min": "#cc79a7", "singular": "#dddddd",
}
plt.rcParams |= {
    "svg.fonttype": "none", "svg.hashsalt": "fdcc", "font.family": "sans-serif", "font.size": 9,
    "axes.spines.top": False, "axes.spines.right": False,
}


def solved(name, *words):
    """The document of a solution."""
    command = [sys.argv[1], "solve", f"models/{name}.fdc", "--json", "--log", "none", *words]
    return json.loads(subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout)


def save(figure, name):
    path = FOLDER / f"{name}.svg"
    figure.savefig(path, metadata={"Date": None})
    text = "\n".join(line.rstrip() for line in path.read_text().splitlines())
    path.write_text(text + "\n")


def strips(axes, answer, names):
    """A row of coloured pieces for each surface and control, with the word of each that is wide enough."""
    pieces = answer["surfaces"] | (answer.get("certificate") or {"arcs": arcs(answer)})["arcs"]
    end = answer["time"][-1]
    for row, name in enumerate(names):
        for it in pieces[name]:
            width = it["to"] - it["from"]
            axes.barh(row, width, 0.8, it["from"], color=MODES[it["mode"]], edgecolor="white", linewidth=0.5)
            if width > 0.06 * end:
                axes.text(it["from"] + width / 2, row, it["mode"], ha="center", va="center", fontsize=8)
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.tick_params(left=False)
    axes.spines["left"].set_visible(False)


def arcs(answer):
    """The arcs of controls that were not located: on which intervals each is at a bound."""
    found, time = {}, answer["time"]
    for name, values in answer["controls"].items():
        low, high = answer["bounds"][name]
        near = 1e-3 * (high - low)
        word = lambda it: "max" if it > high - near else "min" if it < low + near else "free"
        found[name] = []
        for begin, end, value in zip(time, time[1:], values):
            if found[name] and found[name][-1]["mode"] == word(value):
                found[name][-1]["to"] = end
            else:
                found[name].append({"mode": word(value), "from": begin, "to": end})
    return found


def intervals(answer, control):
    """Of each interval its two ends, and the control there: the cubic through its four nodes."""
    time, nodes = answer["time"], answer["control_nodes"]
    points = len(nodes["time"]) // (len(time) - 1)
    for k, (begin, end) in enumerate(zip(time, time[1:])):
        own = slice(points * k, points * (k + 1))
        at = (np.array(nodes["time"][own]) - begin) / (end - begin)
        values = nodes["values"][control][own]
        yield begin, end, np.polynomial.Polynomial.fit(at, values, points - 1, domain=[0, 1])


def with_jumps(answer, name):
    """Times and values of a costate: two at each time at which it has two sides."""
    before = {it["time"]: it["values"][name] for it in answer["costates_before"]}
    pairs = []
    for time, value in zip(answer["time"], answer["costates"][name]):
        pairs += [(time, before[time])] if time in before else []
        pairs += [(time, value)]
    return np.array(pairs).T


def mode_at(answer, time):
    (surface,) = answer["surfaces"].values()
    return next(it["mode"] for it in surface if time <= it["to"])


def hamiltonian(answer, control, rate, cost):
    """The Hamiltonian at both ends of each interval; `rate` is that of the velocity in a mode."""
    before = {it["time"]: it["values"] for it in answer["costates_before"]}
    after = {name: dict(zip(answer["time"], values)) for name, values in answer["costates"].items()}
    velocity = dict(zip(answer["time"], answer["states"]["v"]))
    pairs = []
    for begin, end, polynomial in intervals(answer, control):
        mode = mode_at(answer, (begin + end) / 2)
        for time, at in ((begin, 0), (end, 1)):
            u, sides = polynomial(at), before if time == end and time in before else None
            p, q = (sides[time][name] if sides else after[name][time] for name in ("x", "v"))
            pairs.append((time, cost(u) + p * velocity[time] + q * rate(u, mode)))
    return np.array(pairs).T


def draw_motion(motion, pull, answer, control, rate):
    """Position and velocity, each a cubic with the right slopes on each interval, and the control."""
    states, s = answer["states"], np.linspace(0, 1, 9)
    for k, (begin, end, polynomial) in enumerate(intervals(answer, control)):
        h, mode = end - begin, mode_at(answer, (begin + end) / 2)
        x, v = states["x"][k : k + 2], states["v"][k : k + 2]
        slopes = {"x": v, "v": [rate(polynomial(at), mode) for at in (0, 1)]}
        for name, values, colour in (("x", x, BLUE), ("v", v, RED)):
            a, b = (h * it for it in slopes[name])
            rise = values[1] - values[0]
            curve = values[0] + a * s + (3 * rise - 2 * a - b) * s**2 + (a + b - 2 * rise) * s**3
            label = f"{name} [{answer['units'][name]}]" if k == 0 else None
            motion.plot(begin + s * h, curve, color=colour, label=label)
        pull.plot(begin + s * h, polynomial(s), color=GREEN)
    for bound in answer["bounds"][control]:
        pull.axhline(bound, color="black", linewidth=0.7, linestyle="--")


def certified(name, control, rate, cost, unit):
    """States, control, strips, costates and Hamiltonian of a mass on a line, one above the other."""
    answer = solved(name)
    assert answer["certificate"]["certified"]
    figure, rows = plt.subplots(
        5, 1, sharex=True, figsize=(7.6, 7.6), layout="constrained", height_ratios=[3, 2.2, 1, 3, 1.2])
    motion, pull, strip, dual, energy = rows
    draw_motion(motion, pull, answer, control, rate)
    strips(strip, answer, [*answer["surfaces"], control])
    for state, colour in (("x", BLUE), ("v", RED)):
        dual.plot(*with_jumps(answer, state), color=colour, label=f"costate of {state}")
    energy.plot(*hamiltonian(answer, control, rate, cost), color="black")
    energy.set_ylim(-1, 1)
    for axes in (motion, pull, dual, energy):
        for switch in answer["certificate"]["switches"]:
            axes.axvline(switch["time"], color="black", linewidth=0.7, linestyle=":")
    for axes in (motion, dual):
        axes.axhline(0, color="#bbbbbb", linewidth=0.5)
        axes.legend(frameon=False, loc="best")
    pull.set_ylabel(f"{control} [{answer['units'][control]}]")
    energy.set_ylabel(f"H{unit}")
    energy.set_xlabel("t [s]")
    energy.set_xlim(answer["time"][0], answer["time"][-1])
    save(figure, f"true-optimum-{name}")


def centre(x):
    """The middle of the track, equation (7.6)."""
    return np.where(x <= np.pi, np.sin(x), np.where(x <= 2 * np.pi, np.pi - x, -np.pi - np.sin(x)))


def race_car():
    """The certified path on the track in the colours of the modes, the controls, and the strips."""
    answer = solved("racecar")
    assert answer["certificate"]["certified"]
    figure, (path, throttle, steering, strip) = plt.subplots(
        4, 1, figsize=(7.6, 8.4), layout="constrained", height_ratios=[6, 1.6, 1.6, 1.6])
    x, y, time = (np.array(it) for it in (answer["states"]["pos.x"], answer["states"]["pos.y"], answer["time"]))
    along = np.linspace(0, 3.05 * np.pi, 400)
    for side in (-0.25, 0.25):
        path.plot(along, centre(along) + side, color="black", linewidth=0.7)
    for it in answer["surfaces"]["slip"]:
        own = (time >= it["from"] - 1e-9) & (time <= it["to"] + 1e-9)
        path.plot(x[own], y[own], color=MODES[it["mode"]], linewidth=2.5)
    for name, word in (("held", "rolls (held)"), ("above", "slips (above)"), ("below", "slips (below)")):
        path.plot([], [], color=MODES[name], linewidth=2.5, label=word)
    touched = [it["from"] for it in answer["certificate"]["arcs"]["track"] if it["mode"] != "free"]
    at = [np.argmin(abs(time - it)) for it in touched]
    path.plot(x[at], y[at], "o", color="black", markersize=4, label="touches the limit of the track")
    path.legend(frameon=False, loc="upper right")
    path.set_aspect("equal")
    path.set_xlabel("pos.x")
    path.set_ylabel("pos.y")
    for axes, name, word in ((throttle, "a", "throttle a"), (steering, "s", "steering s")):
        axes.stairs(answer["controls"][name][: len(time) - 1], time, color=GREEN, baseline=None)
        axes.set_ylabel(word)
        axes.set_xlim(time[0], time[-1])
        axes.tick_params(labelbottom=False)
    strips(strip, answer, ["slip", "a", "s"])
    strip.set_xlim(time[0], time[-1])
    strip.set_xlabel("t")
    save(figure, "racecar-strips")


def main():
    slide = lambda push, mode, grip: push - {"above": grip, "below": -grip, "held": push}[mode]
    certified("block", "F", lambda u, mode: slide(u / 2, mode, 0.3 * 9.81), lambda u: u**2, " [N^2]")
    certified("coulomb_reverse", "u", lambda u, mode: slide(u, mode, 0.5), lambda u: 1, "")
    race_car()


main()
