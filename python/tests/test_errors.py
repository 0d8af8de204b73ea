"""Models with mistakes."""

import pickle

import pytest

import fdcc

BROKEN = "time t in [0, 1]\nstate x start 0\ndynamics { x' = y }"


def test_an_error_is_the_drawing_of_check():
    with pytest.raises(fdcc.ModelError) as caught:
        fdcc.compile(BROKEN, name="broken.fdc")
    text = str(caught.value)
    assert "FDC0101" in text and "broken.fdc:3" in text and "x' = y" in text
    (found,) = caught.value.diagnostics
    assert (found.code, found.line, found.severity) == ("FDC0101", 3, "error")
    assert isinstance(caught.value, ValueError)
    assert str(pickle.loads(pickle.dumps(caught.value))) == text


def test_check_tells_without_raising(tmp_path):
    assert [it.code for it in fdcc.check(BROKEN)] == ["FDC0101"]
    file = tmp_path / "broken.fdc"
    file.write_text(BROKEN)
    found = fdcc.check(file)
    assert repr(found) == str(found)
    assert str(file) in str(found) and "<pre>" in found._repr_html_()
    assert str(fdcc.check(BROKEN.replace("= y", "= 1"))) == "nothing wrong"


def test_a_file_that_is_not_there():
    with pytest.raises(FileNotFoundError):
        fdcc.Model("nowhere.fdc")


def test_what_waits_for_a_value_says_so():
    model = fdcc.compile(BROKEN.replace("= y", "= a") + "\nparam a")
    with pytest.raises(fdcc.ModelError, match="a"):
        model.simulate()
    assert model.simulate(a=2).end["x"] == pytest.approx(2)


def test_data_come_from_texts_and_folders(tmp_path):
    text = """data obs = csv("a.csv") columns t, x
    free p in [0, 9]
    time t in [0, 2]
    state x start 0
    dynamics { x' = p }
    minimize sum(k in obs, (x(k.t) - k.x)^2)"""
    table = "t,x\n1,0.5\n2,1\n"
    assert fdcc.compile(text, data={"a.csv": table}).solve().free["p"] == pytest.approx(0.5)
    (tmp_path / "a.csv").write_text(table)
    assert fdcc.compile(text, data=tmp_path).solve().free["p"] == pytest.approx(0.5)
    (tmp_path / "fit.fdc").write_text(text)
    assert fdcc.Model(tmp_path / "fit.fdc").solve().free["p"] == pytest.approx(0.5)
    with pytest.raises(fdcc.ModelError):
        fdcc.compile(text, data={})


def test_a_pattern_is_compared_with_the_names_of_texts(tmp_path):
    text = """free p in [0, 9]
    phase run for each csv("a*.csv") columns t, x {
      time t in [0, run.t(end)]
      state x start 0
      dynamics { x' = p }
      fit run: x sd 0.1
    }"""
    tables = {"a10.csv": "t,x\n1,0.5\n4,2\n", "a9.csv": "t,x\n1,0.5\n2,1\n", "b.csv": ""}
    solution = fdcc.compile(text, data=tables).solve()
    assert solution.free["p"] == pytest.approx(0.5)
    assert [phase.time[-1] for phase in solution.phases.values()] == [2, 4]
    for name, table in tables.items():
        (tmp_path / name).write_text(table)
    assert fdcc.compile(text, data=tmp_path).solve().free["p"] == pytest.approx(0.5)
    with pytest.raises(fdcc.ModelError, match="no file matches"):
        fdcc.compile(text, data={"b.csv": ""})


def test_deep_models_do_not_end_the_process():
    import threading

    text = f"time t in [0, 1]\nstate x start 0\ndynamics {{ x' = {'(' * 120}1{')' * 120} }}"
    found = []
    worker = threading.Thread(target=lambda: found.append(fdcc.check(text)))
    worker.start()
    worker.join()
    assert len(found) == 1


def test_a_solution_of_another_model_is_no_start(models, hop):
    other = fdcc.Model(models / "block.fdc").solve(N=20)
    with pytest.raises(ValueError, match="has no state or control of the model"):
        fdcc.compile("time t in [0, 1]  state q start 0  dynamics { q' = 1 }").solve(warm=other)
    with pytest.raises(FileNotFoundError):
        hop.solve(warm="missing.sol.json")


def test_wrong_arguments_are_told_by_name(hop, tmp_path):
    with pytest.raises(TypeError, match="`values` cannot be 3"):
        hop.solve(values=3)
    with pytest.raises(ValueError, match="would be a JSON document"):
        hop.solve(N=10).save(tmp_path / "x.csv")
    with pytest.raises(AttributeError, match="did you mean 'controls'"):
        hop.solve(N=10).controlls
