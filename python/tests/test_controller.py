"""Models in closed loop."""

import pytest

import fdcc


def test_the_first_step_is_the_solution(models):
    model = fdcc.Model(models / "block.fdc")
    step = model.controller(N=50, sigma=0.05, mu=0.2).step({"x": 0, "v": 0})
    solution = model.solve(N=50, sigma=0.05, mu=0.2)
    assert step["F"] == solution.u["F"][0] and step["F"].unit == "N"
    assert step.is_solved and step.objective == solution.objective
    assert step.interval == pytest.approx(4 / 50) and step.iterations == solution.iterations


def test_it_goes_on_from_the_step_before(hop):
    mpc = hop.controller(N=20)
    first, again = mpc.step([0.0]), mpc.step([0.1])
    assert again["v"] == pytest.approx(0.4) and first["v"] == pytest.approx(0.5)
    mpc.set(reach="80[cm]")
    assert mpc.step([0.0])["v"] == pytest.approx(0.8)
    assert mpc.step([-9.0]).status == "infeasible"


def test_vectors_are_told_and_found(models):
    mpc = fdcc.Model(models / "puck.fdc").controller(N=10, sigma=0.05)
    whole = mpc.step({"pos": (0, 0), "vel": (0.1, 0)})
    assert whole["u"].shape == (2,) and whole["u"][0] == whole["u.x"]
    assert whole.objective.unit == "m^2/s^3" and whole.interval.unit == "s"


def test_wrong_calls_are_told(hop, slide):
    mpc = hop.controller(N=20)
    with pytest.raises(ValueError, match="1 finite value"):
        mpc.step([1, 2])
    with pytest.raises(ValueError, match="did you mean `reach`"):
        mpc.set(raech=1)
    with pytest.raises(ValueError, match="names the width"):
        slide.controller(N=20)
    with pytest.raises(ValueError, match="there is no state 'y'; there is x"):
        mpc.step({"y": 1})
