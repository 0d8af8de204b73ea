"""Sweeps, here and on workers that die."""

import os
import pickle
import signal
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import fdcc

pandas = pytest.importorskip("pandas")

REACHES = np.linspace(10, 90, 41)


@pytest.fixture(scope="module")
def block(models):
    return fdcc.Model(models / "block.fdc")


def test_a_table_has_a_row_for_each_case(hop):
    table = fdcc.sweep(hop, {"reach": REACHES}, N=20, w=2)
    assert list(table["reach"]) == list(REACHES) and set(table["status"]) == {"solved"}
    assert np.allclose(table["objective"], 2 * (REACHES / 100) ** 2)  # w * reach^2
    assert table.attrs["units"]["objective"] == "m^2/s"
    assert list(table.columns[:3]) == ["reach", "status", "objective"]
    assert len(table.to_xarray()["case"]) == 41


def test_cases_come_in_three_forms(hop):
    columns = {"reach": [20, "40[cm]"], "N": [10, 20]}
    rows = [{"reach": 20, "N": 10}, {"reach": "40[cm]", "N": 20}]
    expected = fdcc.sweep(hop, rows)
    assert np.allclose(expected["objective"], [0.04, 0.16])
    for cases in (columns, pandas.DataFrame(columns)):
        pandas.testing.assert_frame_equal(fdcc.sweep(hop, cases), expected)


def test_a_case_that_is_not_solved_is_a_row(hop):
    table = fdcc.sweep(hop, {"reach": [50, 200]}, N=10, confirmed=True)
    assert list(table["status"]) == ["solved", "infeasible"]
    assert list(table["confirmed"]) == [True, False]


def test_wrong_cases_are_told(hop):
    with pytest.raises(ValueError, match="did you mean `reach`"):
        fdcc.sweep(hop, {"raech": [1]})
    with pytest.raises(ValueError, match="different lengths"):
        fdcc.sweep(hop, {"reach": [1], "w": [1, 2]})
    with pytest.raises(TypeError, match="joblib.Parallel"):
        fdcc.sweep(hop, {"reach": [1]}, client=3)
    with pytest.raises(ValueError, match="`reach` is swept twice"):
        fdcc.sweep(hop, {"reach": [1]}, reach=2)
    with pytest.raises(TypeError, match="`cases` cannot be 3; it needs a table"):
        fdcc.sweep(hop, 3)
    with pytest.raises(ValueError, match="`starts`"):
        fdcc.sweep(hop, {"reach": [1]}, starts=0)


def test_a_single_value_goes_with_every_row(hop):
    table = fdcc.sweep(hop, {"reach": "40[cm]", "w": [1, 2]}, N=10)
    assert list(table["reach"]) == [40, 40] and np.allclose(table["objective"], [0.16, 0.32])
    assert len(fdcc.sweep(hop, {"w": 2}, N=10)) == 1


def test_a_column_has_one_kind_and_one_unit(hop):
    cases = {"reach": ["200[mm]", 40, "0.6 [m]"], "N": [10, "auto", 10]}
    table = fdcc.sweep(hop, cases)
    assert np.allclose(table["reach"], [20, 40, 60]) and table["reach"].dtype == float
    assert list(table["N"]) == ["10", "auto", "10"]
    assert np.allclose(table["objective"], (table["reach"] / 100) ** 2)
    assert table.attrs["units"] == {"reach": "cm", "N": "", "objective": "m^2/s"}
    again = fdcc.sweep(hop, table[["reach", "N"]])
    pandas.testing.assert_frame_equal(again, table)


@pytest.mark.parametrize("cases", [{}, [], {"w": []}])
def test_no_case_is_a_table_without_rows(hop, cases):
    table = fdcc.sweep(hop, cases)
    assert len(table) == 0 and list(table.columns[-5:-3]) == ["status", "objective"]


@pytest.fixture
def ctrl_c(monkeypatch):
    """Somebody presses Ctrl-C soon after the first rows are there."""
    own, timer = fdcc._sweep._each, threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))

    def each(*args):
        for rows in own(*args):
            yield rows
            if timer.ident is None:
                timer.start()

    monkeypatch.setattr(fdcc._sweep, "_each", each)
    yield
    timer.join()


@pytest.mark.skipif(os.name == "nt", reason="signals are those of POSIX")
@pytest.mark.parametrize("kind", ["here", "threads", "dask"])
def test_ctrl_c_keeps_the_rows_that_ran(block, kind, ctrl_c):
    cases, options = {"mu": np.linspace(0.1, 0.5, 40_000)}, dict(sigma=0.1, N=200, confirmed=True)
    if kind == "dask":
        distributed = pytest.importorskip("distributed")
        local = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
        with distributed.LocalCluster(**local) as cluster, distributed.Client(cluster) as client:
            table = fdcc.sweep(block, cases, client, **options)
    elif kind == "threads":
        with ThreadPoolExecutor(2) as executor:
            table = fdcc.sweep(block, cases, executor, **options)
    else:
        table = fdcc.sweep(block, cases, **options)
    assert len(table) == 40_000 and set(table["status"]) == {"solved", "interrupted"}
    ran = table["status"] == "solved"
    assert table["objective"][ran].notna().all() and table["objective"][~ran].isna().all()
    assert table["iterations"].dtype == int and not table["confirmed"][~ran].any()


def test_models_go_through_pickle_with_their_data(tmp_path):
    (tmp_path / "a.csv").write_text("t,x\n1,0.5\n2,1\n")
    (tmp_path / "fit.fdc").write_text(
        """data obs = csv("a.csv") columns t, x
        free p in [0, 9]
        time t in [0, 2]
        state x start 0
        dynamics { x' = p }
        minimize sum(k in obs, (x(k.t) - k.x)^2)"""
    )
    dumped = pickle.dumps(fdcc.Model(tmp_path / "fit.fdc"))
    (tmp_path / "a.csv").unlink()
    assert pickle.loads(dumped).solve().free["p"] == pytest.approx(0.5)


@pytest.mark.parametrize("kind", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_executors_give_the_same_bytes(block, kind):
    cases = {"mu": np.linspace(0.1, 0.5, 60)}
    with kind(2) as executor:
        found = fdcc.sweep(block, cases, executor, sigma=0.1, N=50)
    pandas.testing.assert_frame_equal(
        found, fdcc.sweep(block, cases, sigma=0.1, N=50), check_exact=True
    )


def killing(find, ended):
    """Kills a worker that `find` finds, as soon as there is one, unless all has `ended`."""

    def kill():
        time.sleep(0.5)
        while not ended.is_set():
            for worker in find():
                os.kill(worker, signal.SIGKILL)
                return
            time.sleep(0.01)

    thread = threading.Thread(target=kill)
    thread.start()
    return thread


@pytest.fixture(scope="module")
def long():
    """Cases that take some seconds."""
    return {"mu": np.linspace(0.1, 0.5, 2500)}


@pytest.fixture(scope="module")
def expected(block, long):
    return fdcc.sweep(block, long, sigma=0.1, N=50)


def check(block, long, expected, client, find):
    ended = threading.Event()
    thread = killing(find, ended)
    try:
        found = fdcc.sweep(block, long, client, sigma=0.1, N=50)
    finally:
        was_killed = not thread.is_alive()
        ended.set()
        thread.join()
    assert was_killed, "it took long enough for a worker to die"
    pandas.testing.assert_frame_equal(found, expected, check_exact=True)


def test_dask_loses_no_row_with_a_worker(block, long, expected):
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        workers = [it.pid for it in cluster.workers.values()]
        check(block, long, expected, client, lambda: workers[:1])


def test_ray_loses_no_row_with_a_worker(block, long, expected, monkeypatch):
    monkeypatch.setenv("RAY_AUTH_MODE", "disabled")
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        own = ray.remote(lambda: os.getpid())
        check(block, long, expected, ray, lambda: [ray.get(own.remote())])
    finally:
        ray.shutdown()


def test_joblib_loses_no_row_with_a_worker(block, long, expected):
    joblib, psutil = pytest.importorskip("joblib"), pytest.importorskip("psutil")

    def workers():
        children = psutil.Process().children()
        return [it.pid for it in children if any("popen_loky" in word for word in it.cmdline())][:1]

    check(block, long, expected, joblib.Parallel(n_jobs=2), workers)
