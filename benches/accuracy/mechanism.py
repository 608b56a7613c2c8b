"""A mechanism with the truth of its motion, and what models and truths of several families are made of."""

import dataclasses
import math

import numpy as np
from scipy.integrate import solve_ivp


@dataclasses.dataclass
class Case:
    """A mechanism; its truth gives places and speeds, a row of each for every time, from a start that may be nudged."""

    family: str
    name: str
    model: dict
    end: float
    truth: object
    columns: tuple
    # Size, m, by which errors of the columns are divided; angles are in rad.
    length: float
    # Method and step of the run that the truth is compared with, and until when, s.
    probe: tuple = ("ggl/radau-5", 1e-3)
    until: float = math.inf

    def rates(self):
        return tuple(name + "_rate" if "angle" in name else name[:-1] + "v" + name[-1] for name in self.columns)

    def sizes(self):
        return np.array([1.0 if "angle" in name else self.length for name in self.columns])


def plane(gravity, **entries):
    return {"plane": "xy", "gravity": [0, -gravity], **entries}


def bar(first, second):
    return {"between": [first, second], "mass": 1}


def solved(slopes, start, times, **options):
    """States of y' = slopes(t, y) at rising times."""
    settings = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15, **options}
    return solve_ivp(slopes, (0.0, times[-1]), start, t_eval=times, **settings).y.T
