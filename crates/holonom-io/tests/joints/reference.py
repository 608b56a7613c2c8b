#!/usr/bin/env python3
"""Reference motions of bodies on joints, computed in minimal coordinates: the origin of reference.json beside this file.

    python3 -m venv venv && venv/bin/pip install numpy scipy
    venv/bin/python reference.py            # checks, prints a table and writes reference.json; --check writes nothing

Method. Every body hangs on a chain of elementary motions (slides, turns, a motion along a curve) whose coordinates q are
independent: six for the first body, then those that the joint leaves. With the twist Jacobians J of the centres of mass,
the equations of motion are Kane's,

    Σ Jv'·m·(Jv·u̇ + bv - g) + Jw'·(I·(Jw·u̇ + bw) + w × I·w) = 0,

b being what remains of the accelerations at u̇ = 0. u = q̇ but for rolling, where q̇ = N(q)·u. No constraint is solved and
no multiplier appears, so that nothing drifts off the joints. Reactions follow from Newton-Euler on the second body.

Axes. All bodies' reference axes are parallel to the world at the start; a body's own axes are turned against them by its
orientation at the start. So every vector of a joint in a model text serves in a chain as it stands.

Checks, all of which must hold: a second integrator (extrapolation in fixed steps beside DOP853); the energy; the joint's
equations as the model file format states them, evaluated on the bodies; the balance of all reactions (the joint alone acts
between the bodies); rolling also: velocity at the contact, and no moment about it.

A case is {name, kind, freedom, method, note?, model, end, bodies, coordinates, reaction or reactions}: `freedom` counts
relative velocities, `model` is a model text, `bodies` and `coordinates` are those at the end. A reaction is that of the joint
on its second body, moment about the joint's place on that body, world axes, before and after the motion. Cases with a coupler
have the reactions of both hinges, and with the coupler's part added.
"""

import json
import pathlib
import sys

from cases import all_cases


def encoded(value, indent=""):
    """JSON with a list of numbers on one line."""
    inner = indent + " "
    if isinstance(value, dict) and value:
        rows = [f"{inner}{json.dumps(key)}: {encoded(one, inner)}" for key, one in value.items()]
        return "{\n" + ",\n".join(rows) + f"\n{indent}}}"
    if isinstance(value, list) and value:
        return "[\n" + ",\n".join(inner + encoded(one, inner) for one in value) + f"\n{indent}]"
    return json.dumps(value.tolist() if hasattr(value, "tolist") else value)


def main():
    print(f"{'case':28}{'integrators':>13}{'energy':>13}{'joint':>13}{'balance':>13}{'condition':>11}")
    cases = list(all_cases())
    if "--check" not in sys.argv[1:]:
        pathlib.Path(__file__).with_name("reference.json").write_text(encoded(cases) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
