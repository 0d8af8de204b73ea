"""Options that are wrong are told in the words of the command, with the name of the option."""

import numpy as np
import pytest

import fdcc

NAN = float("nan")
SECONDS = "it needs a number of seconds above 0"
ONE_VALUE = "it needs a number, or a text such as"


@pytest.mark.parametrize("wrong", [0, -1, NAN, "3", True, [1]])
def test_limits_of_time(hop, wrong):
    for call in (hop.solve, hop.simulate):
        with pytest.raises(ValueError, match=f"`time_limit` cannot be .*; {SECONDS}"):
            call(time_limit=wrong)
    with pytest.raises(ValueError, match=f"`budget` cannot be .*; {SECONDS}"):
        hop.controller(N=5).step([0], budget=wrong)


@pytest.mark.parametrize("wrong", [-1, 0, 1, 10, NAN, "a"])
def test_tolerances(slide, wrong):
    for call in (slide.simulate, lambda rtol: slide.grad("x(end)", rtol=rtol)):
        with pytest.raises(ValueError, match="`rtol` .* needs a number from 1e-14 to 1"):
            call(rtol=wrong)


@pytest.mark.parametrize("wrong", [-1, NAN, float("inf"), "a"])
def test_gaps(hop, wrong):
    with pytest.raises(ValueError, match="`gap` .* needs a finite number that is not negative"):
        hop.solve(N=5).verify(gap=wrong)
    pytest.importorskip("pandas")
    with pytest.raises(ValueError, match="`gap`"):
        fdcc.sweep(hop, {"w": [1]}, confirmed=True, gap=wrong)


@pytest.mark.parametrize("wrong", [0, -1, 1.5, 10**30, "2", True])
def test_numbers_of_things(hop, wrong):
    with pytest.raises(ValueError, match="`starts` .* needs a whole number, 1 to 10000"):
        hop.solve(starts=wrong)
    with pytest.raises(ValueError, match="`N` .* needs a whole number"):
        hop.controller(N=wrong)


@pytest.mark.parametrize("wrong", [1j, {}, b"0.2", True, [1, 2], object()])
def test_values_of_parameters(hop, wrong):
    for call in (hop.solve, hop.simulate, hop.controller(N=5).set):
        with pytest.raises(TypeError, match=f"`w` cannot be .*; {ONE_VALUE}"):
            call(w=wrong)


def test_values_of_keys(slide, hop):
    with pytest.raises(TypeError, match="`sigma` cannot be .* or several numbers"):
        slide.solve(sigma={"slip": 0.1})
    with pytest.raises(TypeError, match="`w` cannot be None"):
        hop.controller(N=5).set(w=None)
    assert hop.solve(N=5, w=None).params["w"] == 1
    assert hop.solve(N=np.int64(5), w=np.array(2.0), reach=np.float32(50)).params["w"] == 2


def test_a_value_is_given_once(hop):
    for call in (hop.solve, hop.simulate):
        with pytest.raises(ValueError, match="`w` is given twice"):
            call(values={"w": 1}, w=2)


def test_controls(slide):
    for wrong, why in [
        ({"F": [1], "Fx": [1]}, "there is no control 'Fx'; did you mean 'F'"),
        ({"F": [[1, 2], [3, 4]]}, "the control 'F' cannot be"),
        ({"F": "a"}, "the control 'F' cannot be 'a'"),
        ({"F": []}, "the control 'F' cannot be"),
        ({"F": [1, 2], "t": [[0, 1]]}, "the times `t` cannot be"),
    ]:
        with pytest.raises(ValueError, match=why):
            slide.simulate(u=wrong)
    for wrong in (3, [1, 2], np.ones(3)):
        with pytest.raises(TypeError, match="`u` cannot be .*values of each control by name"):
            slide.simulate(u=wrong)
    with pytest.raises(TypeError, match="`warm` cannot be 3; it needs a solution"):
        slide.solve(warm=3)


@pytest.mark.parametrize("wrong", [[], [[0, 1]], ["1[min]"], "a"])
def test_times(slide, wrong):
    with pytest.raises(ValueError, match="the times `t` cannot be"):
        slide.simulate(t=wrong)


def test_states_of_a_controller(models):
    mpc = fdcc.Model(models / "block.fdc").controller(N=5, sigma=0.1)
    for wrong, why in [
        ({"x": 0.2, "v": 0, "w": 3}, "there is no state 'w'; there is x, v"),
        ({"x": 0.2}, "there is no value of the state 'v'"),
        (None, "the state cannot be None"),
        ([[0.1, 0.2]], "the state cannot be"),
        (["a", "b"], "the state cannot be"),
    ]:
        with pytest.raises(ValueError, match=why):
            mpc.step(wrong)
    assert repr(mpc) == "<fdcc.Controller block, 5 intervals: x, v to F>"


def test_texts():
    for wrong in (None, b"", 3):
        with pytest.raises(TypeError, match="`text` cannot be .*; it needs the text of a model"):
            fdcc.compile(wrong)
    with pytest.raises(TypeError, match="`data`: 'a.csv' needs the text of the file"):
        fdcc.compile("", data={"a.csv": np.ones(3)})
