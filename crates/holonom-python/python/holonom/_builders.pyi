# Written by stubs.py from the definitions of all kinds.
from collections.abc import Mapping, Sequence
from typing import Any

from . import _engine
from ._types import Number, Numbers, Place, Rows

DEFINITIONS: list[tuple[str, str | None, str, str, list[tuple[str, str, bool, str, str, str]]]]
KEYS: dict[str, list[str]]
SHAPES: dict[str, Any]

class Entry(str):
    section: str
    kind: str | None
    def __new__(cls, name: str, section: str, kind: str | None = None) -> Entry: ...
    def __getitem__(self, part: Any) -> str: ...

def line() -> str: ...
def text_of(path: str, given: Any) -> str: ...
def builder_name(section: str, kind: str | None) -> str: ...

__all__ = ["Box", "Cylinder", "Sphere", "Rod", "Capsule", "Mesh"]

def Box(*sizes: Any) -> dict[str, Any]:
    """The shape `box` of a body: its edges along x, y and z [m]."""

def Cylinder(*sizes: Any) -> dict[str, Any]:
    """The shape `cylinder` of a body: radius and length; its axis is z [m]."""

def Sphere(*sizes: Any) -> dict[str, Any]:
    """The shape `sphere` of a body: its radius [m]."""

def Rod(*sizes: Any) -> dict[str, Any]:
    """The shape `rod` of a body: length of a slender rod along x [m]."""

def Capsule(*sizes: Any) -> dict[str, Any]:
    """The shape `capsule` of a body: radius, and length of the cylinder between its half spheres; its axis is z [m]."""

def Mesh(*sizes: Any) -> dict[str, Any]:
    """The shape `mesh` of a body: file with a closed triangle mesh in m, STL or OBJ, beside the model file."""

class Builders:
    _draft: _engine.Draft

    def spherical(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``spherical``: a ball in its socket: the two bodies share a point and turn freely about it; also between points.

        Equations: d = r_B − r_A = 0

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def revolute(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        axis: Place | Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``revolute``: a hinge: the two bodies share a point and an axis and turn about it; in a planar model they share a point.

        Equations: d = 0, u_B·v_A = 0, u_B·w_A = 0

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        axis: its direction at the start: a vector, "BODY.AXIS", or one for each body [any]; default: needed
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def prismatic(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        axis: Place | Sequence[Place] | None = None,
        at: Place | Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``prismatic``: a slider on a rail: the second body moves along an axis of the first and does not turn against it.

        Equations: d·v_A = 0, d·w_A = 0, u_B·v_A = 0, u_B·w_A = 0, v_B·w_A = 0; in the plane d·v_A = 0, u_B·v_A = 0

        between: the two bodies, or a body and "ground"
        axis: its direction at the start: a vector, "BODY.AXIS", or one for each body [any]; default: needed
        at: where displacements and moments are measured: a place, "BODY.POINT", or one for each body [m]; default: the centre of the second body
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def cylindrical(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        axis: Place | Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``cylindrical``: a sleeve on a shaft: the second body slides along an axis of the first and turns about it.

        Equations: d·v_A = 0, d·w_A = 0, u_B·v_A = 0, u_B·w_A = 0

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        axis: its direction at the start: a vector, "BODY.AXIS", or one for each body [any]; default: needed
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def universal(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        axes: Sequence[Place],
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``universal``: a cardan joint: the two bodies share a point, and an axis of the one stays at a right angle to an axis of the other; angle1 is the turn about the axis of the first body, angle2 that about the axis of the second.

        Equations: d = 0, u_A·u_B = 0

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        axes: a direction of the first body and one of the second, at the start [any]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def planar(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        axis: Place | Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``planar``: a body on a table: the second body slides in a plane of the first and turns about its normal.

        Equations: d·u_A = 0, u_B·v_A = 0, u_B·w_A = 0

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        axis: its direction at the start: a vector, "BODY.AXIS", or one for each body [any]; default: needed
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def fixed(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``fixed``: two bodies as one.

        Equations: d = 0, u_B·v_A = 0, u_B·w_A = 0, v_B·w_A = 0; none where their reactions are not asked for: the two then are one body

        between: the two bodies, or a body and "ground"
        at: where displacements and moments are measured: a place, "BODY.POINT", or one for each body [m]; default: the centre of the second body
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def screw(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        axis: Place | Sequence[Place] | None = None,
        pitch: Number,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``screw``: a nut on a spindle: a cylindrical joint that moves along its axis by the pitch with every turn.

        Equations: d·v_A = 0, d·w_A = 0, u_B·v_A = 0, u_B·w_A = 0, d·u_A − pitch θ/2π = 0, θ counted over any number of turns

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        axis: its direction at the start: a vector, "BODY.AXIS", or one for each body [any]; default: needed
        pitch: displacement of the second body with each turn, right-handed when positive [m]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def constant_velocity(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        axes: Sequence[Place],
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``constant-velocity``: two shafts that share a point and turn at the same speed however they are bent against each other.

        Equations: d = 0, w_A·v_B − v_A·w_B = 0 with v_A = v_B at right angles to both shafts at the start: no turn about u_A + u_B

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        axes: a direction of the first body and one of the second, at the start [any]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def point_on_line(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        axis: Place | Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``point-on-line``: a pin in a slot: a point of the second body moves along a line of the first; the second may be a point.

        Equations: d·v_A = 0, d·w_A = 0; in the plane d·v_A = 0

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        axis: its direction at the start: a vector, "BODY.AXIS", or one for each body [any]; default: needed
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def point_on_plane(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        axis: Place | Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``point-on-plane``: a foot on a floor: a point of the second body stays on a plane of the first; the second may be a point.

        Equations: d·u_A = 0

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        axis: its direction at the start: a vector, "BODY.AXIS", or one for each body [any]; default: needed
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def point_on_curve(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        curve: Sequence[Place],
        closed: bool | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``point-on-curve``: a cam, a track, a roller coaster: a point of the second body moves along a curve of the first, a cubic spline; the second may be a point.

        Equations: (a − C(s))·n_1(s) = 0, (a − C(s))·n_2(s) = 0 with a_k = d·e_k(A), the nearest s and n ⊥ C'(s); one row in the plane

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        curve: points that the curve goes through, at the start: at least three [m]
        closed: whether it goes back to its first point; otherwise it goes on straight; default: false
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def parallel(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        axis: Place | Sequence[Place] | None = None,
        at: Place | Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``parallel``: an axis of the one body stays parallel to an axis of the other.

        Equations: u_B·v_A = 0, u_B·w_A = 0

        between: the two bodies, or a body and "ground"
        axis: its direction at the start: a vector, "BODY.AXIS", or one for each body [any]; default: needed
        at: where displacements and moments are measured: a place, "BODY.POINT", or one for each body [m]; default: the centre of the second body
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def perpendicular(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        axes: Sequence[Place],
        at: Place | Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``perpendicular``: an axis of the one body stays at a right angle to an axis of the other.

        Equations: u_A·u_B = 0

        between: the two bodies, or a body and "ground"
        axes: a direction of the first body and one of the second, at the start [any]
        at: where displacements and moments are measured: a place, "BODY.POINT", or one for each body [m]; default: the centre of the second body
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def orientation(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``orientation``: the second body does not turn against the first and moves freely otherwise.

        Equations: u_B·v_A = 0, u_B·w_A = 0, v_B·w_A = 0; in the plane u_B·v_A = 0

        between: the two bodies, or a body and "ground"
        at: where displacements and moments are measured: a place, "BODY.POINT", or one for each body [m]; default: the centre of the second body
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def distance(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``distance``: a massless rod between a place of the one body and a place of the other; the two may be points.

        Equations: ½ d·d − ½ L² = 0 with the length L of the start

        between: the two bodies, or a body and "ground"
        at: a place of the first body and one of the second, at the start [m]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def revolute_spherical(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        axis: Place | Sequence[Place],
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``revolute-spherical``: a massless link with a hinge on the first body and a ball on the second, which may be a point: the link turns about the axis of the first, at a right angle to it.

        Equations: ½ d·d − ½ L² = 0 with the length L of the start, d·u_A = 0

        between: the two bodies, or a body and "ground"
        at: the hinge on the first body and the ball on the second, at the start [m]
        axis: of the hinge, fixed in the first body, at the start [any]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def generic(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        locks: Sequence[str],
        axes: Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``generic``: any of the six motions of two bodies against each other locked, along and about three axes of the first body; locks of rotation hold for any others, but two alone are those of a joint with one free axis: locked rx and ry leave rz.

        Equations: x: d·x_A = 0, y: d·y_A = 0, z: d·z_A = 0, rx: y_A·z_B = 0, ry: z_A·x_B = 0, rz: x_A·y_B = 0; of two with one free axis f_B·m_A = 0 and f_B·n_A = 0

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        locks: which motions are locked
        axes: the x axis at the start, and a direction towards the y axis [any]; default: those of the model
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def rolling(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place | Sequence[Place],
        axis: Place | Sequence[Place] | None = None,
        normal: Numbers,
        radius: Number,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``rolling``: a disc or wheel with a sharp edge that rolls on a plane of the first body without slipping, upright or tilted; its rows hold velocities along the plane, and no coordinate.

        Equations: d·N + R s(0) − R s = 0 and t_j·(ḋ − R/s (N·v v̇ + N·w ẇ)) = 0 in the axes of the first body, with v, w in the disc, s² = (N·v)² + (N·w)²

        between: the two bodies, or a body and "ground"
        at: where it sits at the start: a place, "BODY.POINT", or one for each body [m]
        axis: its direction at the start: a vector, "BODY.AXIS", or one for each body [any]; default: needed
        normal: direction away from the plane at the start [any]
        radius: R; the plane is where the disc touches it at the start [m]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def gear(
        self,
        name: str,
        /,
        *,
        joints: Sequence[str],
        ratio: Number,
        pressure_angle: Number | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``gear``: wheels that mesh, or any two coordinates of which one is a multiple of the other.

        Equations: q_1 − ratio q_2 = 0, angles counted over any number of turns

        joints: two joints, or coordinates of joints as "JOINT.angle" or "JOINT.displacement"
        ratio: how many times the second coordinate the first is; negative for outside gears about parallel axes
        pressure_angle: angle between what teeth push with and the tangent of the pitch circles; with it the force of the teeth is recorded, and the bearings of wheels about parallel axes feel it [rad]; default: teeth are left out
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def rack_and_pinion(
        self,
        name: str,
        /,
        *,
        joints: Sequence[str],
        radius: Number,
        pressure_angle: Number | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``rack-and-pinion``: a wheel that rolls along a toothed rail: the displacement of the one joint is the radius times the angle of the other.

        Equations: s − r θ = 0, θ counted over any number of turns

        joints: two joints in either order, or coordinates of joints as "JOINT.angle" or "JOINT.displacement"
        radius: displacement over angle; negative when they count against each other [m]
        pressure_angle: angle between what teeth push with and the way of the rack; with it the force of the teeth is recorded, and the bearings feel it [rad]; default: teeth are left out
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def pulley(
        self,
        name: str,
        /,
        *,
        joints: Sequence[str],
        radii: Numbers,
        crossed: bool | None = None,
        pretension: Number | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``pulley``: two wheels with a belt between them.

        Equations: r_1 θ_1 − r_2 θ_2 = 0, crossed r_1 θ_1 + r_2 θ_2 = 0, angles counted over any number of turns

        joints: two joints, or coordinates of joints as "JOINT.angle" or "JOINT.displacement"
        radii: radii of the two wheels [m]
        crossed: whether the belt crosses itself, so that the wheels turn against each other, whichever way their joints are written; default: false
        pretension: tension of the belt at rest, 0 for a chain; with it the force of the belt is recorded, and the bearings of the wheels feel it [N]; default: the belt's pull is left out
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def linear(
        self,
        name: str,
        /,
        *,
        terms: Sequence[Mapping[str, Any]],
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``linear``: a sum of joint coordinates that stays as it is: a differential, a tilting table, any linear coupling.

        Equations: Σ factor_k q_k = 0, angles counted over any number of turns

        terms: the summands: { joint = "JOINT", factor = 1.0 }
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def cam(
        self,
        name: str,
        /,
        *,
        joints: Sequence[str],
        lift: Number,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a joint of the kind ``cam``: a coordinate that follows another by a formula or a table: a cam with a groove, a Geneva wheel, gears that are not round.

        Equations: q_2 − f(q_1) + f(0) = 0, angles counted over any number of turns

        joints: two joints, or coordinates of joints as "JOINT.angle" or "JOINT.displacement": the one that leads, and the one that follows
        lift: the second coordinate over the first, q; only its differences count, as both are zero at the start [m or rad]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def constraint_distance(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[Place] | None = None,
        length: Number | None = None,
        stroke: Number | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a constraint of the kind ``distance``: keeps two points a distance apart: a massless rod, or with a length that depends on time an actuator.

        Equations: ½ |x_b − x_a|² − ½ L(t)² = 0

        between: the two points
        length: number, or formula of the time t [m]; default: the distance at the start
        stroke: by how much the distance differs from that of the start, as a formula of t; instead of a length, and zero at the start [m]; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def constraint_collinear(
        self,
        name: str,
        /,
        *,
        points: Sequence[Place],
        repeat: str | None = None,
    ) -> Entry:
        """Adds a constraint of the kind ``collinear``: keeps three or more points on a straight line by the cross products of the paper (§7), in space three with one redundant, or two where points slide.

        Equations: (x_1 − x_0) × (x_2 − x_1) = 0, (x_2 − x_1) × (x_3 − x_2) = 0, …; these rows turn with the mechanism but are not invariant: together with other rows that do not keep it straight, angular momentum may drift with O(h²)

        points: the points, in their order along the line
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def constraint_perpendicular(
        self,
        name: str,
        /,
        *,
        first: Sequence[Place],
        second: Sequence[Place],
        repeat: str | None = None,
    ) -> Entry:
        """Adds a constraint of the kind ``perpendicular``: keeps the directions of two pairs of points at a right angle.

        Equations: (x_b − x_a) · (x_d − x_c) = 0 for first = [a, b], second = [c, d]

        first: from one point to another
        second: from one point to another
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def constraint_point_on_line(
        self,
        name: str,
        /,
        *,
        point: str,
        direction: Numbers | None = None,
        through: Place | None = None,
        line: Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a constraint of the kind ``point-on-line``: keeps a point on a line of fixed direction, or on the line through two points.

        Equations: e_k · (x − x_through) = 0 with e_k ⊥ direction: 2 rows in space, 1 in the plane; with line = [a, b]: (x_b − x_a) × (x − x_a) = 0, in space 3 rows with one redundant, or 2 where points slide

        point: the point that slides
        direction: direction of the line [any]; default: none: this or a line is needed
        through: a point of the line of that direction; default: where the point starts
        line: two points that the line goes through, instead of direction and through; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def constraint_point_on_plane(
        self,
        name: str,
        /,
        *,
        point: str,
        normal: Numbers,
        through: Place | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a constraint of the kind ``point-on-plane``: keeps a point on a plane of fixed direction; not in planar models.

        Equations: n · (x − x_through) = 0, |n| = 1

        point: the point that slides
        normal: direction at right angles to the plane [any]
        through: a point of the plane; default: where the point starts
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def constraint_fixed(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        point: str | None = None,
        between: Sequence[Place] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a constraint of the kind ``fixed``: keeps a point where it starts, or two points as far apart and in the direction in which they start.

        Equations: x − x(0) = 0, or (x_b − x_a) − (x_b − x_a)(0) = 0; one row an axis, linear

        point: the point that stays; default: none: this or between is needed
        between: the two points whose offset stays; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def constraint_expression(
        self,
        name: str,
        /,
        *,
        value: Number,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a constraint of the kind ``expression``: keeps a formula of positions and of time at zero.

        Equations: f(x, t) = 0

        value: a formula of positions of points and bodies and of t, kept at zero; its slope should not be zero there [any]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def drive_angle(
        self,
        name: str,
        /,
        *,
        joint: str,
        profile: Number | Mapping[str, Any],
        repeat: str | None = None,
    ) -> Entry:
        """Adds a drive of the kind ``angle``: a motor that turns a joint as it is told, counted from the start over any number of turns.

        Equations: θ − θ(t) = 0; its torque is −λ

        joint: the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
        profile: angle as a formula of t, or { table = [[t, angle], …] }; zero at the start [rad]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def drive_displacement(
        self,
        name: str,
        /,
        *,
        joint: str,
        profile: Number | Mapping[str, Any],
        repeat: str | None = None,
    ) -> Entry:
        """Adds a drive of the kind ``displacement``: a drive that moves a joint along its axis as it is told, counted from the start.

        Equations: s − s(t) = 0; its force is −λ

        joint: the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
        profile: displacement as a formula of t, or { table = [[t, s], …] }; zero at the start [m]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def drive_distance(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[Place] | None = None,
        profile: Number | Mapping[str, Any] | None = None,
        stroke: Number | Mapping[str, Any] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a drive of the kind ``distance``: a cylinder that keeps two points as far apart as it is told.

        Equations: ½ |x_b − x_a|² − ½ L(t)² = 0; it pushes with −λ L

        between: the two points, or places of bodies
        profile: distance as a formula of t, or { table = [[t, L], …] } [m]; default: this or `stroke`
        stroke: by how much the distance differs from that of the start, in the same spellings; zero at the start [m]; default: this or `profile`
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def drive_point(
        self,
        name: str,
        /,
        *,
        point: str,
        profile: Numbers,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a drive of the kind ``point``: a hand that leads a point, or a place of a body, along a path.

        Equations: x − x(t) = 0, a row an axis; its force is −λ

        point: the point that is led
        profile: its coordinates as formulas of t [m]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def spring(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[Place] | None = None,
        along: Place | Sequence[Place] | None = None,
        stiffness: Number | None = None,
        rest_length: Number | None = None,
        damping: Number | None = None,
        energy: Number | None = None,
        force: Number | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a force of the kind ``spring``: a spring, a damper, or both, between two points or along an axis; linear or as a formula.

        Equations: V = ½ k (r − L₀)², tension c ṙ, V(r), tension F(r, ṙ, t), whichever are given, with r = |x_b − x_a|, or along an axis r = (x_b − x_a)·e

        between: the two points
        along: e, a direction in the axes of the model at the start, which stays, or "BODY.AXIS", which turns with the body: the length is that along it and may be negative [any]; default: none: from point to point
        stiffness: k; as a formula of t, of inputs, measures and what moves, by the names of columns, its work is booked [N/m]; default: none
        rest_length: L₀, the length without tension of the stiffness, and `rest` in formulas; as k it may be a formula [m]; default: the length at the start
        damping: c, which may be a formula as k; what it takes is booked as work [N·s/m]; default: none
        energy: energy as a formula of the length, of `rest` and of `extension`, the length less `rest` [J]; default: none
        force: tension as a formula of length, rate and t, of `rest` and of `extension`, of inputs, measures and what moves, booked as work [N]; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def rope(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[Place] | None = None,
        through: Sequence[Place] | None = None,
        length: Number | None = None,
        drum: str | None = None,
        radius: Number | None = None,
        stiffness: Number,
        damping: Number | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a force of the kind ``rope``: an elastic rope between two points, also over small sheaves and from a drum: it pulls when it is longer than its free length, and never pushes.

        Equations: tension k (ℓ − L) + c dℓ/dt where ℓ > L, never below 0, with ℓ = |x_1 − x_a| + |x_2 − x_1| + … + |x_b − x_n|; slack where ℓ ≤ L. From a drum L + R q in place of L, with the effort R times the tension along q

        between: the two points it is tied to
        through: the sheaves between them, without friction and so small that they are points, in their order along the rope; default: none
        length: L, the free length of the whole rope, with a drum where its coordinate is zero; as a formula of t, of inputs, measures of positions and what moves, by the names of columns, its work is booked [m]; default: the length at the start
        drum: the drum that it is wound on: a joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"; default: none
        radius: R, the radius of the drum: what it lets out when it turns forward; below 0 it lets out when it turns back [m, or m/m along a rail]; default: needed with `drum`
        stiffness: k of the whole rope; it may be a formula, of velocities too [N/m]
        damping: c while it is taut, which may be a formula; what it takes is booked as work [N·s/m]; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def torsion(
        self,
        name: str,
        /,
        *,
        joint: str,
        stiffness: Number | None = None,
        angle: Number | None = None,
        damping: Number | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a force of the kind ``torsion``: a spring, a damper, or both, along the coordinate of a joint: about a hinge, or along a rail.

        Equations: V = ½ k (q − q₀)², effort −c q̇ against the motion, q counted over any number of turns

        joint: the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
        stiffness: k; as a formula of t, of inputs, measures and what moves, by the names of columns, its work is booked [N·m/rad or N/m]; default: none
        angle: q₀, the coordinate without effort, counted from the start; as k it may be a formula [rad or m]; default: 0
        damping: c, which may be a formula; what it takes is booked as work [N·m·s/rad or N·s/m]; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def bushing(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[str] | None = None,
        at: Place,
        stiffness: Numbers,
        damping: Numbers | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a force of the kind ``bushing``: a rubber bearing between two bodies: springs and dampers along and about three axes of the first body, which are those of the model at the start; without force as the bodies start; for rotations well below a right angle.

        Equations: V = ½ Σ k q², effort −c q̇, with q = d·e_k(A) and about e_k the mean of e_j(A)·e_i(B) and −e_i(A)·e_j(B), (i, j, k) cyclic: the sine of a rotation about one axis alone

        between: the two bodies, or "ground" and a body
        at: where it sits at the start [m]
        stiffness: along x, y, z and about x, y, z; in a planar model three: along both axes and about the normal [N/m, N·m/rad]
        damping: in the same order; what it takes is booked as work [N·s/m, N·m·s/rad]; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def force(
        self,
        name: str,
        /,
        *,
        body: str,
        at: Place | None = None,
        force: Numbers,
        axes: str | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a force of the kind ``force``: a force at a place of a body, in the axes of the model or following the body, as formulas of time and of its motion.

        Equations: Q = F(t, x, v, ω), booked as work

        body: the body it acts on
        at: where it acts: a place at the start, or "BODY.POINT" [m]; default: the centre of mass
        force: its components as formulas of t, of x, y, z and vx, vy, vz of that place and of the angular velocity wx, wy, wz; in a planar model of those of its plane, with w for the angular velocity [N]
        axes: whether it is given in the axes of the model or of the body; default: "world"
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def torque(
        self,
        name: str,
        /,
        *,
        body: str,
        torque: Number | Numbers,
        axes: str | None = None,
        reaction: str | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a force of the kind ``torque``: a torque on a body, which may react on another one, as formulas of time and of the motion of the body.

        Equations: Q of each body axis e_k: ½ n × e_k; booked as work

        body: the body it acts on
        torque: three formulas of t, of x, y, z and vx, vy, vz of the centre of mass and of the angular velocity wx, wy, wz; in a planar model one, with w for the angular velocity [N·m]
        axes: whether it is given in the axes of the model or of the body; default: "world"
        reaction: the body that takes the opposite torque; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def effort(
        self,
        name: str,
        /,
        *,
        joint: str,
        effort: Number,
        coordinates: Mapping[str, str] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a force of the kind ``effort``: a motor or any other effort along the coordinate of a joint, as a formula of time, of that coordinate and its rate, and of whatever else moves: control laws, nonlinear springs, engines.

        Equations: effort E(t, q, q̇, …), booked as work

        joint: the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
        effort: E as a formula of t, q and q_rate, of the names below, and of inputs, measures and what moves, by the names of its columns [N·m or N]
        coordinates: names for coordinates of other joints: { a = "JOINT" } makes a and a_rate variables of the formula; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def friction(
        self,
        name: str,
        /,
        *,
        joint: str,
        effort: Number,
        speed: Number,
        damping: Number | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a force of the kind ``friction``: friction in a joint: an effort of one size against the motion, smooth at rest, so that what should stick creeps slowly; and one in proportion to the speed.

        Equations: effort −F tanh(q̇/v) − c q̇

        joint: the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
        effort: F, the size of the friction when the joint moves [N·m or N]
        speed: v, the speed at which three quarters of it are reached: well below those of the motion [rad/s or m/s]
        damping: c [N·m·s/rad or N·s/m]; default: 0
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def stop(
        self,
        name: str,
        /,
        *,
        joint: str,
        lower: Number | None = None,
        upper: Number | None = None,
        stiffness: Number,
        dissipation: Number | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a force of the kind ``stop``: buffers at the ends of a joint's way: springs that act beyond its limits only, with what an impact takes out.

        Equations: beyond a limit by p: V = ½ k p², effort −k d p q̇, which takes at most all of the spring's (Hunt and Crossley)

        joint: the joint, or its coordinate as "JOINT.angle" or "JOINT.displacement"
        lower: smallest coordinate without contact, counted from the start [rad or m]; default: none
        upper: largest coordinate without contact [rad or m]; default: none
        stiffness: k [N·m/rad or N/m]
        dissipation: d; what it takes is booked as work [s/rad or s/m]; default: 0
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def constant(
        self,
        name: str,
        /,
        *,
        point: str,
        force: Numbers,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a force of the kind ``constant``: a force on a point, or on a place of a body, that never changes, booked as work.

        Equations: Q = F

        point: the point it acts on
        force: the force, in the axes of the model [N]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def expression(
        self,
        name: str,
        /,
        *,
        point: str,
        force: Numbers,
        repeat: str | None = None,
    ) -> Entry:
        """Adds a force of the kind ``expression``: a force on a point as formulas of time, its position and its velocity, booked as work.

        Equations: Q = F(t, x, v)

        point: the point it acts on
        force: its components as formulas of t, x, y, z, vx, vy, vz; a planar model has those of its plane [N]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def table(
        self,
        name: str,
        /,
        *,
        points: Rows | None = None,
        file: str | None = None,
        x: str | None = None,
        y: str | None = None,
        interpolation: str | None = None,
        outside: str | None = None,
    ) -> Entry:
        """Adds an entry of ``[table.NAME]``: a curve, which formulas call as a function.

        points: rows of argument and value, with rising arguments; default: those of `file`
        file: a CSV file with a line of names, beside the model; default: none
        x: its column of arguments; default: the first
        y: its column of values; default: the second
        interpolation: what lies between the points: straight lines, a spline with two derivatives, or cubics that never overshoot; default: "linear"
        outside: what lies beyond them: the last value, a straight line, nothing (a run that comes there stops), or the same again; default: "hold"
        """

    def input(
        self,
        name: str,
        /,
        *,
        default: Number | None = None,
        unit: str | None = None,
        meaning: str | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds an entry of ``[input.NAME]``: a number from outside, which is set while the model runs.

        default: what it is until it is set; default: 0
        unit: for people; default: none
        meaning: one line for people; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def point(
        self,
        name: str,
        /,
        *,
        mass: Number | None = None,
        position: Place | None = None,
        velocity: Numbers | None = None,
        fixed: bool | None = None,
        motion: Numbers | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds an entry of ``[point.NAME]``: a particle, a place that stays, or a driven support.

        mass: mass of the point itself; a free point without any must be the end of a bar with mass [kg]; default: 0
        position: where it is at the start; or the name of another point, or of a body or a place of one, where that is [m]; default: none: needed unless there is a motion
        velocity: how fast it is at the start [m/s]; default: 0
        fixed: true ties it to the ground; default: false
        motion: makes it a driven support: its coordinates as formulas of the time t [m]; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def body(
        self,
        name: str,
        /,
        *,
        mass: Number | None = None,
        inertia: Number | Numbers | Rows | None = None,
        check_inertia: bool | None = None,
        shape: Mapping[str, Any] | None = None,
        density: Number | None = None,
        com: Numbers | None = None,
        position: Place,
        orientation: Mapping[str, Any] | None = None,
        velocity: Numbers | None = None,
        angular_velocity: Number | Numbers | None = None,
        points: Mapping[str, Numbers] | None = None,
        axes: Mapping[str, Numbers] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds an entry of ``[body.NAME]``: a rigid body.

        mass: mass [kg]; default: that of the shape by its density
        inertia: about the centre of mass in body axes: [Ixx, Iyy, Izz], with the products behind them as entries of the tensor, [.., Ixy, Ixz, Iyz] with Ixy = −∫ x y dm, or the tensor (3 × 3); one number in a planar model [kg·m²]; default: that of the shape
        check_inertia: false lets a principal moment exceed the sum of the others, which is noted; default: true
        shape: a shape of uniform density, for mass, inertia and picture [m]; default: none: mass and inertia are needed
        density: of the shape, instead of a mass; of a rod in kg/m [kg/m³]; default: none
        com: centre of mass in body axes; position, velocity and points are then those of the origin of these axes, and counted from there [m]; default: the origin of the body axes
        position: of the centre of mass, or with `com` of the origin of the body axes, at the start; or the name of a point, or of a body or a place of one, where that is [m]
        orientation: of the body's axes, at the start; default: that of the model's axes
        velocity: of the same place, at the start [m/s]; default: 0
        angular_velocity: in the axes of the model, at the start; one number in a planar model [rad/s]; default: 0
        points: named places in body axes from the centre of mass, or with `com` from the origin of these axes, used as "NAME.POINT" [m]; default: none
        axes: named directions in body axes, used as "NAME.AXIS" [any]; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def bar(
        self,
        name: str,
        first: Place | None = None,
        second: Place | None = None,
        /,
        *,
        between: Sequence[Place] | None = None,
        mass: Number,
        repeat: str | None = None,
    ) -> Entry:
        """Adds an entry of ``[bar.NAME]``: a uniform rigid rod between two points.

        between: its two ends
        mass: mass, spread evenly over its length [kg]
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def beam(
        self,
        name: str,
        /,
        *,
        from_: Numbers,
        to: Numbers,
        elements: Number | None = None,
        section: Mapping[str, Any],
        modulus: Number,
        poisson: Number | None = None,
        density: Number,
        up: Numbers | None = None,
        damping: Number | None = None,
        velocity: Numbers | None = None,
        angular_velocity: Number | Numbers | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds an entry of ``[beam.NAME]``: an elastic beam.

        from_: its first end at the start [m]
        to: its second end at the start [m]
        elements: number of elements; n of them have n + 1 bodies at their ends, `NAME[0]` to `NAME[n]`; default: 8
        section: its cross section
        modulus: Young's modulus [N/m²]
        poisson: Poisson's ratio, which the shear modulus follows from; default: 0.3
        density: of the material [kg/m³]
        up: direction that z of the beam is as near to as it can be; x goes along it [any]; default: z of the model, or x for beams along z
        damping: of the material: stress per rate of strain over the modulus [s]; default: 0
        velocity: of its first end, at the start; the beam moves as a rigid body then [m/s]; default: 0
        angular_velocity: in the axes of the model, at the start; one number in a planar model [rad/s]; default: 0
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def start(
        self,
        name: str,
        /,
        *,
        angle: Number | None = None,
        displacement: Number | None = None,
        angle1: Number | None = None,
        angle2: Number | None = None,
        x: Number | None = None,
        y: Number | None = None,
        z: Number | None = None,
        angle_rate: Number | None = None,
        displacement_rate: Number | None = None,
        angle1_rate: Number | None = None,
        angle2_rate: Number | None = None,
        x_rate: Number | None = None,
        y_rate: Number | None = None,
        z_rate: Number | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds an entry of ``[start.NAME]``: where a joint is at the start: the mechanism is moved there before it runs.

        angle: angle of the joint at the start, counted from the pose that is written; less than half a turn [rad]; default: as it comes
        displacement: displacement of the joint at the start, counted from the pose that is written [m]; default: as it comes
        angle1: first angle of a universal joint at the start, in the same way [rad]; default: as it comes
        angle2: second angle of a universal joint at the start, in the same way [rad]; default: as it comes
        x: displacement along x at the start, of a joint that leaves that free, in the same way [m]; default: as it comes
        y: displacement along y at the start, of a joint that leaves that free, in the same way [m]; default: as it comes
        z: displacement along z at the start, of a joint that leaves that free, in the same way [m]; default: as it comes
        angle_rate: rate of the angle at the start [rad/s]; default: as it comes
        displacement_rate: rate of the displacement at the start [m/s]; default: as it comes
        angle1_rate: rate of `angle1` at the start [rad/s]; default: as it comes
        angle2_rate: rate of `angle2` at the start [rad/s]; default: as it comes
        x_rate: rate of `x` at the start [m/s]; default: as it comes
        y_rate: rate of `y` at the start [m/s]; default: as it comes
        z_rate: rate of `z` at the start [m/s]; default: as it comes
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def measure(
        self,
        name: str,
        /,
        *,
        value: Number,
        unit: str | None = None,
        meaning: str | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds an entry of ``[measure.NAME]``: a formula of what the mechanism does, recorded as a column and read by other formulas.

        value: a formula of any recorded columns and other measures, by their names: `distance(hook, drum.top)`, `max(strut.force)`
        unit: as the author states it; default: none
        meaning: one line for people; default: the formula
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """

    def event(
        self,
        name: str,
        /,
        *,
        when: Number | None = None,
        direction: str | None = None,
        every: Number | None = None,
        stop: bool | None = None,
        set: Mapping[str, Number] | None = None,
        repeat: str | None = None,
    ) -> Entry:
        """Adds an entry of ``[event.NAME]``: a condition whose time is found, and what happens then.

        when: a formula that is zero when it happens, of what moves, inputs, measures and `t`; default: needed without `every`
        direction: which way the formula goes through zero then; default: "both"
        every: the period with which it happens, from t = 0 on [s]; default: none
        stop: whether the run ends there; default: false
        set: inputs that are set there, and to what: formulas of what moves, inputs, measures and `t`; default: none
        repeat: makes NAME[0], NAME[1], …: "i = 0 to N", also nested: "i = 0 to N, j = 1 to M"; default: one entry
        """
