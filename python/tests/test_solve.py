"""Solves: values by name, results by name, nothing copied, nothing that can be changed."""

import json

import numpy as np
import pytest

import fdcc


def test_a_file_is_solved_with_values_by_name(models):
    model = fdcc.Model(models / "racecar.fdc")
    solution = model.solve(muN=1.2, N=250, sigma=0.1)
    assert solution.status == "solved" and solution.is_solved
    assert solution.params["muN"] == 1.2
    assert solution.t.shape == (251,) and solution["pos.x"].shape == (251,)
    assert solution.u["a"].shape == (250,) and solution.costates["th"].shape == (251,)
    assert solution.free["T"] == solution["T"] > 5
    # Table 7.1 of Stewart & Anitescu, as the README has it for N = 250.
    assert model.solve(N=250, sigma=0.1).objective == pytest.approx(5.544655, abs=1e-5)


def test_numbers_are_in_the_declared_unit_and_results_in_si(hop):
    assert hop.solve(reach=80).params["reach"] == pytest.approx(0.8)
    solution = hop.solve(reach="80[cm]", N=20)
    assert solution["reach"] == pytest.approx(0.8) and solution["reach"].unit == "m"
    assert solution.objective == pytest.approx(0.64) and solution.objective.unit == "m^2/s"
    assert solution["x"].unit == "m" and solution.t.unit == "s"
    assert solution.costates["x"].unit == "m^2/s per m"
    assert hop.units["v"] == "m/s" and hop.scale("reach") == 0.01


def test_names_that_are_no_names_of_python_go_into_values(hop):
    assert hop.solve(values={"reach": 80}).objective == pytest.approx(0.64)


def test_the_sensitivity_is_that_of_the_closed_form(hop):
    by = hop.solve().sensitivities  # of w * reach^2
    assert by["w"] == pytest.approx(0.25) and by["reach"] == pytest.approx(1.0)
    assert by["reach"].unit == "m^2/s per m"


def test_the_optimum_moves_with_a_parameter(hop):
    by = hop.solve().derivative("reach")  # x = reach * t at constant speed
    assert by.states["x"] == pytest.approx(by.time)
    assert set(np.round(by.controls["v"], 6)) == {1.0}
    with pytest.raises(ValueError, match="there is no parameter `raech`; did you mean `reach`"):
        hop.solve().derivative("raech")


def test_a_saved_optimum_has_the_derivatives_that_were_asked_for(hop, tmp_path):
    path = tmp_path / "hop.sol.json"
    hop.solve().save(path)
    with pytest.raises(ValueError, match="saved without a derivative by 'reach'"):
        fdcc.Solution.load(path).derivative("reach")


def test_arrays_are_the_memory_of_the_result(hop):
    x = hop.solve()["x"]
    again = x[1:3]
    assert not x.flags.owndata and not x.flags.writeable and again.name == "x"
    assert np.shares_memory(x, again)
    with pytest.raises(ValueError):
        x[0] = 1.0
    assert type(2 * x) is np.ndarray and type(np.stack([x, x])) is np.ndarray
    assert isinstance(np.max(x), float)


def test_two_views_of_one_column_share_it(hop):
    solution = hop.solve()
    assert np.shares_memory(solution.states["x"], fdcc.Solution(solution._solution)["x"])


def test_results_outlive_what_they_came_from(hop):
    x = hop.solve(N=40)["x"]
    import gc

    gc.collect()
    assert np.allclose(x, np.linspace(0, 0.5, 41))


def test_results_cannot_be_changed(hop):
    solution = hop.solve()
    for wrong in ("status", "time", "anything"):
        with pytest.raises(AttributeError):
            setattr(solution, wrong, 1)
    with pytest.raises(TypeError):
        solution.states["x"] = 1
    with pytest.raises(AttributeError):
        hop.name = "other"
    with pytest.raises(AttributeError):
        solution.objective.unit = "m"


def test_what_the_document_says_has_the_same_names(hop, tmp_path):
    solution = hop.solve(N=20)
    solution.save(tmp_path / "r.sol.json")
    document = json.loads((tmp_path / "r.sol.json").read_text())
    assert solution.document.keys() == document.keys()
    assert solution.iterations == document["iterations"] and solution.method.N == 20
    for role in ("states", "controls", "costates"):
        own = getattr(solution, role)
        assert {name: list(it) for name, it in own.items()} == document[role]
    assert list(solution.time) == document["time"]
    assert list(solution.hamiltonian) == document["hamiltonian"]
    assert solution.free == document["free"] and solution.params == document["params"]
    assert document["verification"]["confirmed"] is solution.confirmed is True


def test_a_warm_start_needs_fewer_iterations(models, tmp_path):
    model = fdcc.Model(models / "racecar.fdc")
    cold = model.solve(N=100, sigma=0.1)
    warm = model.solve(N=100, sigma=0.1, muN=1.01, warm=cold)
    assert warm.is_solved and warm.iterations < cold.iterations / 2
    cold.save(tmp_path / "r.sol.json")
    assert model.solve(N=100, sigma=0.1, warm=tmp_path / "r.sol.json").is_solved


def test_not_solved_is_a_status(hop):
    solution = hop.solve(reach=200)
    assert solution.status == "infeasible" and not solution.is_solved
    assert "infeasible" in str(solution)
    assert not solution.confirmed and solution.sensitivities == {}


def test_wrong_calls_are_told(hop):
    with pytest.raises(ValueError, match="did you mean `reach`"):
        hop.solve(raech=1)
    with pytest.raises(ValueError):
        hop.solve(N=-1)
    with pytest.raises(ValueError, match="starts"):
        hop.solve(starts=0)
    with pytest.raises(TypeError):
        hop.solve(w=True)
    with pytest.raises(KeyError, match="there is no 'y'"):
        hop.solve()["y"]
    with pytest.raises(OSError):
        hop.solve(warm="nowhere.sol.json")


def test_several_numbers_are_a_list(slide, models):
    solution = fdcc.Model(models / "block.fdc").solve(**{"continue": [0.3, 0.1]}, N=50)
    assert solution.is_solved


def test_several_starts_are_told(hop):
    solution = hop.solve(starts=3)
    assert [it.status for it in solution.starts] == ["solved"] * 3


def test_modes_and_switches(models):
    solution = fdcc.Model(models / "block.fdc").solve(N=50, sigma=0.05)
    spans = solution.surfaces["slip"]
    assert {it.mode for it in spans} <= {"below", "held", "above"}
    times = [it.time for it in solution.switches]
    assert times == sorted(times) and all(it.surface == "slip" for it in solution.switches)
    assert [it.from_ for it in solution.switches] == [it.mode for it in spans[:-1]]
    assert [it.to for it in solution.switches] == [it.mode for it in spans[1:]]
    assert solution.certificate is None and solution.arcs == {}


def test_a_true_optimum_has_its_certificate(models):
    solution = fdcc.Model(models / "block.fdc").solve()
    assert solution.certificate.certified and all(it.passes for it in solution.certificate.checks)
    assert [(it.surface, it.time, it.from_, it.to) for it in solution.switches] == [
        (it.surface, it.time, it.from_, it.to) for it in solution.certificate.switches
    ]
    # It begins to move where the friction's bound is reached from rest: no touch, but a crossing.
    assert all(it.margin > 0 for it in solution.certificate.switches)
    # A block that moves for the time T costs f^2 T + 12 m^2 / T^3 with the friction f = mu m g,
    # and nothing while it rests; T is where that is least.
    m, f = 2.0, 0.3 * 2.0 * 9.81
    moves = np.sqrt(6 * m / f)
    assert solution.objective == pytest.approx(f**2 * moves + 12 * m**2 / moves**3, rel=1e-6)
    # It may move at once or wait: that costs nothing.
    (moving,) = [it for it in solution.surfaces["slip"] if it.mode == "above"]
    assert moving.to - moving.from_ == pytest.approx(moves, rel=1e-6)
    assert solution.switches[-1].to == "held"
    (arc,) = solution.arcs["F"]
    assert (arc.mode, arc.from_, arc.to) == ("free", 0, 4)


def test_phases_are_solutions(models):
    solution = fdcc.Model(models / "twostage.fdc").solve()
    assert solution.is_solved and len(solution.phases) == 2
    for name, phase in solution.phases.items():
        own = solution.document.phases[name]
        assert list(phase.time) == list(own.time)
        assert {it: tuple(column) for it, column in phase.states.items()} == dict(own.states)


def test_signals_of_phases_are_found_by_name(models):
    solution = fdcc.Model(models / "twostage.fdc").solve(N=10)
    boost = solution.phases.boost
    assert np.array_equal(solution["boost.h"], boost["h"]) and "coast.thrust" in solution
    assert np.array_equal(solution.hamiltonian["boost"], boost.hamiltonian)
    with pytest.raises(KeyError, match="there is no 'h'.*boost.h"):
        solution["h"]


def test_surfaces_of_phases_are_theirs():
    solution = fdcc.compile(
        """state x start 0
        state v start 0
        control F in [-12, 12]
        phase pull {
          time t in [0, 2]
          surface slip = v
          dynamics { x' = v  2 * v' in -5.886 * Sgn(slip) + F }
        }
        phase rest like pull { time t in [2, 4] }
        link pull -> rest { }
        end x == 1
        end v == 0
        minimize integral(F^2)
        method { sigma = 0.05  N = 40 }"""
    ).solve()
    for name, phase in solution.phases.items():
        assert phase.surfaces.slip == solution.document.phases[name].surfaces.slip
    assert solution.phases.rest.switches[-1].surface == "slip"


def test_a_vector_is_an_array_of_its_parts(models):
    solution = fdcc.Model(models / "puck.fdc").solve(N=20, sigma=0.05)
    assert solution["pos"].shape == (21, 2) and solution["pos"].unit == "m"
    assert np.array_equal(solution["pos"][:, 1], solution["pos.y"])
    assert solution["u"].shape == (20, 2) and not solution["u"].flags.writeable


def test_records_are_short_for_people(models):
    solution = fdcc.Model(models / "block.fdc").solve(N=50, sigma=0.1)
    assert len(repr(solution.document)) < 2000 and len(repr(solution.verify())) < 500
    assert "'time': <51 entries>" in repr(solution.document)


def test_what_has_names_has_attributes(hop):
    solution = hop.solve(N=10)
    assert hop.names.states == ("x",) and solution.states.x is solution.states["x"]
    with pytest.raises(AttributeError, match="there is no 'y'"):
        solution.states.y


def test_jumps_are_told(models):
    solution = fdcc.Model(models / "bounce.fdc").solve(N=20)
    assert solution.is_solved
    for jump in solution.jumps:
        assert jump.jump == "bounce" and jump.before.keys() == jump.after.keys()


def test_verify_asks_for_what_it_is_told(models):
    solution = fdcc.Model(models / "racecar.fdc").solve(N=100, sigma=0.1)
    assert not solution.confirmed and not solution.verify().confirmed
    assert solution.verify(gap=10).confirmed
    assert solution.verify().state_gap > 1e-3
