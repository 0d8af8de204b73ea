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


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=120, resources={"metadata": {"path": path.parent}}).execute()


def test_there_are_three_notebooks():
    assert len(NOTEBOOKS) == 3
