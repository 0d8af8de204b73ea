"""Results that are saved, read again, copied and pickled."""

import copy
import json
import pickle

import numpy as np
import pytest

import fdcc


def again(result):
    return pickle.loads(pickle.dumps(result))


@pytest.fixture(scope="module")
def solution(models):
    return fdcc.Model(models / "block.fdc").solve(N=50, sigma=0.1)


@pytest.fixture(scope="module")
def saved(solution, tmp_path_factory):
    path = tmp_path_factory.mktemp("saved") / "r.sol.json"
    solution.save(path)
    return fdcc.Solution.load(path)


def test_a_saved_solution_says_the_same(solution, saved):
    for role in ("states", "controls", "costates", "report"):
        own = getattr(saved, role)
        assert own.keys() == getattr(solution, role).keys()
        for name, signal in getattr(solution, role).items():
            assert np.array_equal(own[name], signal) and own[name].unit == signal.unit
            assert not own[name].flags.writeable
    for name in ("model", "status", "is_solved", "objective", "free", "params", "sensitivities"):
        assert getattr(saved, name) == getattr(solution, name), name
    assert list(saved.t) == list(solution.t) and saved.t.unit == "s"
    assert np.array_equal(saved.hamiltonian, solution.hamiltonian)
    assert saved.confirmed == solution.confirmed and saved.switches == solution.switches
    assert saved.document == solution.document and repr(saved) == repr(solution)
    assert str(saved) == str(solution) and "NOT CONFIRMED" in saved._repr_html_()


def test_a_saved_solution_is_verified_with_any_gap(solution, saved):
    for gap in (1e-3, 0.05, 0.1, 10):
        assert saved.verify(gap) == solution.verify(gap)


def test_a_saved_solution_is_a_start_and_drives(models, solution, saved):
    model = fdcc.Model(models / "block.fdc")
    warm = [model.solve(N=50, sigma=0.1, mu=0.29, warm=it) for it in (solution, saved)]
    assert warm[0].iterations == warm[1].iterations and warm[1].is_solved
    ends = [model.simulate(u=it).end for it in (solution, saved)]
    assert ends[0]["x"] == pytest.approx(ends[1]["x"], rel=1e-12)


def test_solutions_go_through_pickle_and_copy(models, solution):
    assert again(solution).document == solution.document
    assert again(again(solution))["x"].unit == "m"
    assert copy.deepcopy(solution) is solution and copy.copy(solution) is solution
    phases = fdcc.Model(models / "twostage.fdc").solve(N=10)
    for own, it in zip(again(phases).phases.values(), phases.phases.values()):
        assert (own.model, own.status) == (it.model, it.status)
        assert np.array_equal(own["h"], it["h"]) and own.t.unit == "s"
    assert str(again(phases)) == str(phases) and "phase by phase" in str(phases)
    coast = again(phases.phases["coast"])
    assert coast.model == "coast" and np.array_equal(coast["h"], phases.phases["coast"]["h"])


def test_what_was_not_solved_is_saved_without_a_replay(hop):
    found = again(hop.solve(reach=200))
    assert found.status == "infeasible" and not found.is_solved and not found.confirmed
    with pytest.raises(ValueError, match="without a replay; solve it again"):
        found.verify()


def test_simulations_and_gradients_go_through_pickle_and_copy(slide):
    simulated = slide.simulate(t=[0, 0.25, 2])
    found = again(simulated)
    assert list(found["v"]) == list(simulated["v"]) and found["v"].unit == "m/s"
    assert found.end == simulated.end and found.events == simulated.events
    gradient = slide.grad("x(end)", wrt=["mu", "F"], u={"F": [1, 2]}, second=True)
    found = again(gradient)
    assert found["mu"] == gradient["mu"] and list(found["F"]) == list(gradient["F"])
    assert found.value == gradient.value and found.second == gradient.second
    assert copy.deepcopy(simulated) is simulated and copy.deepcopy(gradient) is gradient


def test_simulations_of_phases_go_through_pickle(drop):
    simulated = drop.simulate()
    for it in (again(simulated), again(again(simulated))):
        assert list(it.phases) == ["fall", "slide"] and it.objective == simulated.objective
        assert np.array_equal(it["slide.v"], simulated["slide.v"]) and it.end == simulated.end
    slide = again(simulated.phases["slide"])
    assert slide.status == "completed" and slide.objective == slide.end["h"]
    assert np.array_equal(slide["h"], simulated["slide.h"]) and slide["h"].unit == "m"


def test_diagnostics_go_through_pickle_and_copy():
    found = fdcc.check("time t in [0, 1]\nstate x start 0\ndynamics { x' = y }")
    for it in (again(found), copy.deepcopy(found)):
        assert tuple(it) == tuple(found) and str(it) == str(found)


def test_what_is_no_solution_is_told(tmp_path):
    for wrong in ("{", "[]", '{"fdcc": "0.1.0"}'):
        (tmp_path / "r.sol.json").write_text(wrong)
        with pytest.raises(ValueError, match="r.sol.json is not a solution"):
            fdcc.Solution.load(tmp_path / "r.sol.json")
    with pytest.raises(TypeError, match="fdcc.Solution.load"):
        fdcc.Solution("r.sol.json")
    for kind in (fdcc.Simulation, fdcc.Gradient, fdcc.Controller):
        with pytest.raises(TypeError, match="makes a"):
            kind("r.sol.json", *[{}, ""][: 1 + (kind is fdcc.Controller)])


def test_documents_become_json_again(solution):
    assert json.loads(json.dumps(solution.document.to_dict())) == json.loads(
        solution._solution.json()
    )
