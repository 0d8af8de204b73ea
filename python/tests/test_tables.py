"""Tables and plots."""

import numpy as np
import pytest

import fdcc


def test_a_frame_has_a_column_for_each_signal(hop):
    pytest.importorskip("pandas")
    solution = hop.solve(N=10)
    table = solution.to_pandas()
    assert list(table.columns) == ["x", "v"] and table.index.name == "time" and len(table) == 11
    assert np.array_equal(table["x"], solution["x"]) and table.attrs["units"]["x"] == "m"
    assert len(hop.simulate(u=solution, t=[0, 1]).to_pandas()) == 2


def test_a_dataset_has_units_and_both_axes(hop):
    pytest.importorskip("xarray")
    solution = hop.solve(N=10)
    data = solution.to_xarray()
    assert data["x"].dims == ("time",) and data["v"].dims == ("interval",)
    assert data["v"].attrs["units"] == "m/s" and data["costate(x)"].shape == (11,)
    assert data.attrs["status"] == "solved"
    assert hop.simulate(u=solution).to_xarray()["x"].attrs["units"] == "m"


def test_a_dataset_has_what_is_reported(models):
    pytest.importorskip("xarray")
    data = fdcc.Model(models / "racecar.fdc").solve(N=50, sigma=0.1).to_xarray()
    assert data["v_normal"].dims == ("time",)


def test_phases_have_a_table_each(models):
    pytest.importorskip("pandas")
    solution = fdcc.Model(models / "twostage.fdc").solve()
    assert list(solution.to_pandas()) == list(solution.phases)


def test_plots_have_a_row_for_each_signal(models):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    solution = fdcc.Model(models / "block.fdc").solve(N=50)
    assert [it.get_ylabel() for it in solution.plot()] == ["x [m]", "v [m/s]", "F [N]"]
    assert len(solution.plot(["F"])) == len(solution.plot("F")) == 1
    with pytest.raises(ValueError, match="`mu` is no signal over time"):
        solution.plot(["mu"])
    with pytest.raises(KeyError, match="there is no 'y'"):
        solution.plot(["y"])
    assert len(fdcc.Model(models / "crossing.fdc").simulate().plot()) == 1


def test_phases_are_drawn_one_after_the_other(models):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    solution = fdcc.Model(models / "twostage.fdc").solve(N=10)
    height, *_ = found = solution.plot()
    assert [it.get_ylabel() for it in found] == ["h [m]", "v [m/s]", "m [kg]", "thrust [N]"]
    boost, coast = (it.get_xdata() for it in height.lines)
    assert boost[0] == 0 and boost[-1] == coast[0] and coast[-1] == solution.t[-1]
    assert len(solution.plot(["boost.h"])[0].lines) == 1
    with pytest.raises(KeyError, match="boost.h"):
        solution.plot(["q"])


def test_simulated_phases_have_a_table_each_and_are_drawn_one_after_the_other(drop):
    pytest.importorskip("pandas")
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    simulated = drop.simulate()
    assert list(simulated.to_pandas()) == ["fall", "slide"]
    height, _ = simulated.plot()
    fall, slide = (it.get_xdata() for it in height.lines)
    assert fall[0] == 0 and fall[-1] == slide[0] == 1 and slide[-1] == 4
    assert len(simulated.plot(["fall.h"])[0].lines) == 1 and len(simulated.plot("h")) == 1
    with pytest.raises(KeyError, match="there is no 'q'.*fall.h"):
        simulated.plot("q")


def test_a_jump_has_two_rows(models):
    pytest.importorskip("pandas")
    solution = fdcc.Model(models / "bounce.fdc").solve()
    jump = solution.document.jumps[0]
    rows = solution.to_pandas().loc[jump.time]
    assert rows["v"].tolist() == [jump.before["v"], jump.after["v"]] and len(rows) == 2
    assert len(solution.to_pandas()) == len(solution.t) + len(solution.document.jumps)


def test_both_sides_of_a_jump_are_drawn(models):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    solution = fdcc.Model(models / "bounce.fdc").solve()
    jump = solution.document.jumps[0]
    line = solution.plot("v")[0].lines[0]
    at = line.get_ydata()[line.get_xdata() == jump.time]
    assert at.tolist() == [jump.before["v"], jump.after["v"]]


def test_linear_controls_are_drawn_through_their_values(models):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    solution = fdcc.Model(models / "block.fdc").solve(controls="linear", scheme="trapezoid", sigma=0.1, N=20)
    line = solution.plot("F")[0].lines[0]
    assert np.array_equal(line.get_ydata(), solution.document.control_nodes["values"]["F"])


def test_a_simulation_is_drawn_as_it_moves(models):
    found = fdcc.Model(models / "bounce.fdc").simulate()
    exact = fdcc.Model(models / "bounce.fdc").simulate(t=np.linspace(0, found.t[-1], 200))
    drawn = np.interp(exact.t, found.t, found["h"])
    assert np.abs(drawn - exact["h"]).max() < 0.003 * np.ptp(exact["h"])
