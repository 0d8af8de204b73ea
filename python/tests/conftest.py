"""Models that several tests use."""

from pathlib import Path

import pytest

import fdcc

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def models() -> Path:
    """The folder of the models of the repository."""
    return REPOSITORY / "models"


@pytest.fixture(scope="session")
def hop() -> fdcc.Model:
    """The shortest way that costs least: x = reach * t, and the objective is w * reach^2."""
    return fdcc.compile(
        """model hop
        param reach = 50 [cm]
        param w = 1
        time t in [0, 1] [s]
        state x [m] start 0
        control v in [-1, 1] [m/s]
        dynamics { x' = v }
        end x == reach
        minimize integral(w * v^2)
        """
    )


@pytest.fixture(scope="session")
def slide() -> fdcc.Model:
    """Coulomb friction: v falls by mu per time until it rests at v0 / mu."""
    return fdcc.compile(
        """model slide
        param mu = 2 [m/s^2]
        param v0 = 1 [m/s]
        time t in [0, 2] [s]
        state x [m] start 0
        state v [m/s] start v0
        control F in [-9, 9] [m/s^2] guess 0
        surface slip = v
        dynamics { x' = v  v' in F - mu * Sgn(slip) }
        """
    )


@pytest.fixture(scope="session")
def drop() -> fdcc.Model:
    """A fall of 1 s from 5 m, and a slide with half the speed that stops after g/2/5 s."""
    return fdcc.compile(
        """model drop
        phase fall { time t in [0, 1] [s]  state h [m] start 5  state v [m/s] start 0
          dynamics { h' = v  v' = -9.81[m/s^2] }  minimize h(end) }
        phase slide { time t in [1, 4] [s]  state h [m]  state v [m/s]  surface slip = v
          dynamics { h' = v  v' in -5[m/s^2]*Sgn(slip) }  minimize h(end) }
        link fall -> slide { same v := 0.5*v }
        """
    )
