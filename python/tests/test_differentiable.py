"""Derivatives in JAX and PyTorch, against differences."""

import numpy as np
import pytest

import fdcc

STEP = 1e-5
POINT = {"mu": 2.0, "v0": 1.1, "F": np.array([0.5, 0.4, -0.3, 0.2])}


def differences(function, point):
    """Central differences of a function of numbers and arrays."""
    found = {}
    for name, value in point.items():
        value = np.asarray(value, dtype=float)
        by = np.zeros(value.shape)
        for at in np.ndindex(value.shape):
            step = np.zeros(value.shape)
            step[at] = STEP
            ends = [function({**point, name: value + sign * step}) for sign in (1, -1)]
            by[at] = (ends[0] - ends[1]) / (2 * STEP)
        found[name] = by
    return found


def end(slide):
    def value(point):
        params = {name: float(it) for name, it in point.items() if name != "F"}
        return slide.simulate(u={"F": point["F"]}, values=params).end["x"]

    return value


def test_jax_has_the_derivatives_of_the_true_system(slide):
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    import fdcc.jax

    found = jax.jit(jax.grad(fdcc.jax.simulate(slide, "x(end)")))(POINT)
    expected = differences(end(slide), POINT)
    for name in POINT:
        assert np.allclose(found[name], expected[name], rtol=1e-6, atol=1e-9), name


def test_jax_differentiates_an_optimum_by_values_in_their_unit(hop):
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    import fdcc.jax

    optimum = fdcc.jax.solve(hop, N=20)
    found = jax.grad(optimum)({"reach": 50.0, "w": 3.0})  # w * (reach / 100)^2
    assert found["reach"] == pytest.approx(3 * 2 * 0.5 / 100) and found["w"] == pytest.approx(0.25)
    many = jax.vmap(lambda reach: optimum({"reach": reach, "w": 3.0}))(np.array([50.0, 80.0]))
    assert np.allclose(many, [0.75, 1.92])


def test_torch_has_the_same(slide, hop):
    torch = pytest.importorskip("torch")
    import fdcc.torch

    point = {
        name: torch.tensor(it, dtype=torch.float64, requires_grad=True)
        for name, it in POINT.items()
    }
    fdcc.torch.simulate(slide, "x(end)")(point).backward()
    expected = differences(end(slide), POINT)
    for name in POINT:
        assert np.allclose(point[name].grad, expected[name], rtol=1e-6, atol=1e-9), name
    reach = torch.tensor(50.0, dtype=torch.float64, requires_grad=True)
    fdcc.torch.solve(hop, N=20, w=3)({"reach": reach}).backward()
    assert reach.grad.item() == pytest.approx(3 * 2 * 0.5 / 100)


def test_where_nothing_is_found_it_is_nan(hop):
    torch = pytest.importorskip("torch")
    import fdcc.torch

    reach = torch.tensor(200.0, dtype=torch.float64, requires_grad=True)
    with pytest.warns(RuntimeWarning, match="infeasible"):
        value = fdcc.torch.solve(hop, N=20)({"reach": reach})
    value.backward()
    assert torch.isnan(value) and torch.isnan(reach.grad)


def test_other_names_are_refused(slide):
    torch = pytest.importorskip("torch")
    import fdcc.torch

    with pytest.raises(ValueError, match="nu"):
        fdcc.torch.simulate(slide, "x(end)")({"nu": 1.0})
