"""What notebooks show, and three notebooks."""

from pathlib import Path

import pytest

import fdcc

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))


def test_models_and_solutions_show_themselves(hop, models):
    html = hop.solve(N=10)._repr_html_()
    assert html.startswith('<div class="fdcc">') and "<svg" in html and "x [m]" in html
    assert "minimize integral(w * v^2)" in hop._repr_html_()
    assert repr(hop) == "<fdcc.Model hop: 1 state, 1 control, 0 surfaces>"


def test_a_cell_is_a_model():
    testing = pytest.importorskip("IPython.testing.globalipapp")
    shell = testing.start_ipython() or testing.get_ipython()
    shell.run_line_magic("load_ext", "fdcc")
    text = "time t in [0, 1]\nstate x start 0\ndynamics { x' = 2 }"
    shell.run_cell_magic("fdc", "ramp", text)
    assert shell.user_ns["ramp"].simulate().end["x"] == pytest.approx(2)
    found = shell.run_cell_magic("fdc", "ramp", text.replace("2 }", "y }"))
    assert "FDC0101" in str(found) and "ramp" not in shell.user_ns


def test_a_cell_has_a_folder_of_data(models):
    testing = pytest.importorskip("IPython.testing.globalipapp")
    shell = testing.start_ipython() or testing.get_ipython()
    shell.run_line_magic("load_ext", "fdcc")
    text = (models / "slider_fit.fdc").read_text()
    shell.run_cell_magic("fdc", f"slider --data '{models}'", text)
    assert shell.user_ns["slider"].solve(N=50, sigma=0.05).is_solved
    for wrong in ("class", "a b", "a --data", "2"):
        with pytest.raises(ValueError, match="write the name of a variable"):
            shell.run_cell_magic("fdc", wrong, text)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": path.parent}}).execute()


def test_there_are_three_notebooks():
    assert len(NOTEBOOKS) == 3
