"""Dynamics of mechanisms: exact constraints, audited energy, large steps.

>>> import holonom as hm
>>> m = hm.Model(title="Door")
>>> door = m.body("door", mass=20, shape=hm.Box(1, 0.05, 2), position=[0.5, 0, 1])
>>> hinge = m.revolute("hinge", m.ground, door, at=[0, 0, 1], axis=[0, 0, 1])
>>> closer = m.torsion("closer", joint=hinge, stiffness=5.0, damping=1.0, angle=1.57)
>>> run = m.simulate(end=1, step=1e-3)
>>> run.status
'completed'
"""

from typing import TYPE_CHECKING, Any

from ._builders import *
from ._builders import Entry
from ._analysis import Check, Comparison, Stability, compare
from ._engine import VERSION as __version__
from ._errors import Fault, FunctionError, ModelError, ModelWarning
from ._errors import needed as _needed
from ._functions import Function
from ._model import Model, load, loads, simulate
from ._run import Run
from ._samplers import Normal, Table, Uniform, grid, latin_hypercube, random, sobol
from ._simulation import Simulation, State
from ._study import Failed, Study, sweep

if TYPE_CHECKING:
    from . import gym as gym

__all__ = ["Entry", "Fault", "Function", "FunctionError", "Model", "ModelError", "ModelWarning", "Run", "Simulation", "State", "load", "loads", "simulate"]
__all__ += ["Check", "Comparison", "Failed", "Normal", "Stability", "Study", "Table", "Uniform"]
__all__ += ["compare", "grid", "latin_hypercube", "random", "sobol", "sweep"]
# Type checkers read no names but those that are written here.
__all__ += ["Box", "Capsule", "Cylinder", "Mesh", "Rod", "Sphere"]


def __getattr__(name: str) -> Any:
    # What needs packages of its own is imported where it is used.
    if name == "gym":
        from importlib import import_module

        with _needed("hm.gym", "Gymnasium", "gymnasium"):
            return import_module("holonom.gym")
    raise AttributeError(f"holonom has no `{name}`")
