"""Optimal control of systems with friction, switches and impacts.

>>> import fdcc
>>> m = fdcc.compile('''
... param reach = 0.5 [m]
... time t in [0, 1] [s]
... state x [m] start 0
... control v in [-1, 1] [m/s]
... dynamics { x' = v }
... end x == reach
... minimize integral(v^2)
... ''')
>>> s = m.solve(reach=0.8, N=50)
>>> s.status
'solved'
>>> round(s.objective, 6), s.objective.unit
(0.64, 'm^2/s')
>>> s["x"].shape, s["x"].unit, s.u["v"].shape
((51,), 'm', (50,))

All results are in SI units; values of parameters are given in their declared unit, or as a text with
a unit, as in ``m.solve(reach="80[cm]")``.
"""

from importlib.metadata import version as _version

from ._arrays import Number, Signal
from ._controller import Controller, Step
from ._errors import ModelError
from ._gradient import Gradient
from ._model import Model, check, compile
from ._notebook import load_ipython_extension
from ._records import Diagnostics, Named, Record
from ._simulation import Simulation
from ._solution import Solution
from ._sweep import sweep

__version__ = _version("fdcc")
__all__ = [
    "Controller",
    "Diagnostics",
    "Gradient",
    "Model",
    "ModelError",
    "Named",
    "Number",
    "Record",
    "Signal",
    "Simulation",
    "Solution",
    "Step",
    "check",
    "compile",
    "load_ipython_extension",
    "sweep",
]
