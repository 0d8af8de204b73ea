"""Simulations and gradients of the true system, against closed forms."""

import numpy as np
import pytest

import fdcc


def test_a_block_comes_to_rest(slide):
    found = slide.simulate(t=np.linspace(0, 2, 9))
    assert found.status == "completed" and found["v"].unit == "m/s"
    assert np.allclose(found["v"], np.maximum(1 - 2 * found.t, 0), atol=1e-9)
    (event,) = found.events
    assert event.time == pytest.approx(0.5) and event.surface == "slip"
    assert found.end["x"] == pytest.approx(0.25) and found.end["x"].unit == "m"
    assert not found["v"].flags.writeable


def test_values_change_simulations(slide):
    assert slide.simulate(mu=4).end["x"] == pytest.approx(1 / 8)
    assert slide.simulate(values={"v0": 2}).end["x"] == pytest.approx(1)


def test_controls_are_held(slide):
    equal = slide.simulate(u={"F": [2, -2]})
    assert equal.end["v"] == pytest.approx(0, abs=1e-9)
    from_times = slide.simulate(u={"F": [2, -2], "t": [0, 1.5]})
    assert from_times.end["x"] == pytest.approx(1.5 + 1 / 8)
    with pytest.raises(ValueError, match="control 'F'"):
        slide.simulate(u={})
    with pytest.raises(ValueError, match="ascend"):
        slide.simulate(u={"F": [2, -2], "t": [1, 0]})


def test_the_controls_of_a_solution_drive_a_simulation(hop, tmp_path):
    solution = hop.solve(N=20, reach=80)
    solution.save(tmp_path / "r.sol.json")
    for u in (solution, tmp_path / "r.sol.json"):
        found = hop.simulate(u=u, t=solution.t)
        assert np.allclose(found["x"], solution["x"], atol=1e-8)


def test_times_outside_are_refused(slide):
    with pytest.raises(ValueError, match="3"):
        slide.simulate(t=[0, 3])
    with pytest.raises(ValueError, match="ascending"):
        slide.simulate(t=[1, 0])


def test_the_gradient_is_exact_through_the_event(slide):
    # The way until it rests is v0^2 / (2 mu).
    found = slide.grad("x(end)", wrt=["mu", "v0", "x(start)"])
    assert found.trusted and found.value == pytest.approx(0.25)
    assert found["mu"] == pytest.approx(-1 / 8) and found["v0"] == pytest.approx(0.5)
    assert found["x(start)"] == pytest.approx(1)
    assert list(found) == ["mu", "v0", "x(start)"] and found.differentiable


def test_the_gradient_by_controls_has_a_number_for_each_row(slide):
    rows = np.array([4.0, 5.0, 6.0])
    found = slide.grad("x(end)", wrt=["F"], u={"F": rows})["F"]
    step = 1e-5
    for at in range(3):
        ends = [
            slide.simulate(u={"F": rows + sign * step * (np.arange(3) == at)}).end["x"]
            for sign in (1, -1)
        ]
        assert found[at] == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-6)


def test_a_derivative_has_the_unit_of_a_quotient(slide):
    u = {"F": [1.0, 2.0]}
    found = slide.grad("x(end)", wrt=["mu", "v(start)", "x(start)", "F"], u=u)
    units = {name: it.unit for name, it in found.items()}
    assert units["mu"] == units["F"] == "m per m/s^2" and units["x(start)"] == "m per m"
    assert "m per m/s" in found._repr_html_()
    assert fdcc.compile("param a = 1  time t in [0, 1]  state x start 0  dynamics { x' = a }").grad(
        "x(end)", wrt=["a"]
    )["a"].unit == ""


def test_a_derivative_that_is_not_there_says_why():
    model = fdcc.compile("time t in [0, 1]  state x start 1  dynamics { x' = 5 * x^2 }")
    found = model.grad("x(end)", wrt=["x(start)"])
    with pytest.raises(KeyError, match="the trajectory stops at the time 0.2.*'not_finite'"):
        found["x(start)"]


def test_vectors_are_given_and_found(models):
    model = fdcc.Model(models / "puck.fdc")
    parts = model.simulate(u={"u.x": [1.0, 0.5], "u.y": [0.2, 0.1]})
    whole = model.simulate(u={"u": np.array([[1.0, 0.2], [0.5, 0.1]])})
    assert np.array_equal(parts["pos"], whole["pos"]) and parts["pos"].shape[1] == 2
    with pytest.raises(ValueError, match="the control 'u' needs 2 parts, u.x, u.y"):
        model.simulate(u={"u": np.ones((3, 3))})


def test_simulations_show_themselves(slide):
    html = slide.simulate()._repr_html_()
    assert "completed" in html and "<td>m/s</td>" in html


def test_second_derivatives_are_there_when_asked_for(slide):
    found = slide.grad("x(end)", wrt=["mu", "v0"], second=True).second
    assert found["mu"]["mu"] == pytest.approx(1 / 8)  # v0^2 / mu^3
    assert found["mu"]["v0"] == pytest.approx(-1 / 4)


def test_what_cannot_be_differentiated_is_told(slide):
    with pytest.raises(ValueError, match="no objective"):
        slide.grad()
    with pytest.raises(ValueError, match="x\\(start\\)"):
        slide.grad("x(end)", wrt=["x"])
    with pytest.raises(fdcc.ModelError, match="y"):
        slide.grad("y(end)")


def test_phases_are_simulated_one_after_the_other(drop):
    found = drop.simulate()
    landed = 5 - 9.81 / 2
    assert found.phases["fall"]["h"][-1] == pytest.approx(landed)
    rest = landed - 4.905**2 / 10
    assert found["slide.h"][-1] == pytest.approx(rest) and found["slide.h"].unit == "m"
    assert list(found.t) == [0, 4] and found.status == "completed"
    assert found.objective == pytest.approx(landed + rest)
    assert found.phases["fall"].objective == pytest.approx(landed)
    assert [it.time for it in found.events] == pytest.approx([1.981])
    assert found.end == found.phases["slide"].end
    with pytest.raises(KeyError, match="there is no 'h'.*fall.h"):
        found["h"]


def test_phases_are_driven_by_a_solution_and_values(models):
    model = fdcc.Model(models / "twostage.fdc")
    solution = model.solve()
    driven = model.simulate(u=solution)
    assert driven["coast.h"][-1] == pytest.approx(solution["coast.h"][-1], rel=1e-2)
    with pytest.raises(ValueError, match="each phase has controls of its own"):
        model.simulate(u={"thrust": [1]})
    with pytest.raises(ValueError, match="phases have times of their own"):
        model.simulate(t=[0, 1])


def test_unknowns_of_a_solution_hold_in_phases_unless_told_otherwise():
    model = fdcc.compile(
        """free k in [0, 5] guess 1
        phase a { time t in [0, 1]  state x start 1  dynamics { x' = -k }  end x == 0 }
        phase b { time t in [1, 2]  state x  dynamics { x' = k } }
        link a -> b { same }  minimize b.x(end)^2"""
    )
    solution = model.solve()
    assert model.simulate(u=solution)["a.x"][-1] == pytest.approx(0, abs=1e-9)
    assert model.simulate(u=solution, k=3)["a.x"][-1] == pytest.approx(-2)
