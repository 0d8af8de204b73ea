"""Stopping, and telling how far it is."""

import os
import signal
import sys
import threading
import time

import pytest

import fdcc


@pytest.fixture(scope="module")
def long(models):
    """A model and options that take many seconds."""
    return fdcc.Model(models / "racecar.fdc"), dict(N=4000, sigma=0.001, starts=64)


def test_a_time_limit_keeps_the_best_iterate(long):
    model, options = long
    solution = model.solve(**{**options, "starts": 1, "N": 20000}, time_limit=0.2)
    assert solution.status == "time_limit" and solution.t.shape == (20001,)


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of POSIX")
@pytest.mark.parametrize("starts", [1, 64])
def test_ctrl_c_stops_a_solve_with_its_best_iterate(long, starts):
    model, options = long
    model.solve(N=4000, sigma=0.001, time_limit=0.01)  # compiled
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    begin = time.monotonic()
    timer.start()
    solution = model.solve(**{**options, "starts": starts, "N": 20000, "progress": False})
    timer.join()
    assert solution.status == "interrupted" and time.monotonic() - begin < 20


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of POSIX")
def test_another_exception_of_a_signal_is_raised(long):
    model, options = long

    def fail(*_):
        raise TimeoutError("too long")

    before = signal.signal(signal.SIGINT, fail)
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        with pytest.raises(TimeoutError, match="too long"):
            model.solve(**options)
    finally:
        timer.join()
        signal.signal(signal.SIGINT, before)


def test_other_threads_run_meanwhile(long):
    model, options = long
    model.solve(N=4000, sigma=0.001, time_limit=0.01)
    ticks = []
    worker = threading.Thread(target=lambda: model.solve(**options, time_limit=0.5))
    worker.start()
    while worker.is_alive():
        ticks.append(time.monotonic())
        time.sleep(0.005)
    assert len(ticks) > 20


def test_progress_is_told(models, capsys):
    pytest.importorskip("tqdm")
    model = fdcc.Model(models / "racecar.fdc")
    solution = model.solve(N=100, sigma=0.1, progress=True)
    assert solution.is_solved and "iterations" in capsys.readouterr().err


def test_a_report_that_fails_stops_the_solve(models):
    def fail(*_):
        raise RuntimeError("no")

    model = fdcc.Model(models / "racecar.fdc")
    with pytest.raises(RuntimeError, match="no"):
        model._model.solve([("N", 100.0)], report=fail)
