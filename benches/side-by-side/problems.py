"""The problems: holonom's model, its reference, and every program with its settings."""

import dataclasses

import errors
from programs import ROOT, Holonom, Peer

# Methods of the table of costs: name, and whether steps follow from an accuracy.
CONSERVING = [("conserving", False), ("conserving-ggl", False)]

# Methods of work against precision.
METHODS = [
    *CONSERVING,
    ("lagrange-3/conserving-4", False),
    ("ggl/conserving-ggl-4", False),
    ("lagrange-3/rattle", False),
    ("generalized-alpha", False),
    ("ggl/radau-5", False),
    ("ggl/radau-5", True),
]

# Exudyn's options that make it fastest where its scripts' author found some: new Jacobian each step, kept pattern, a tolerance that suffices.
TUNED = ["--upd", "--reuse", "--atol", "1e-5"]


@dataclasses.dataclass
class Problem:
    """A problem with a step, or with steps to be swept from a first one."""

    name: str
    title: str
    model: str
    step: float
    end: float
    # Rows of the trajectory that are compared with the reference: one each so many seconds.
    samples: float
    # Bodies, where the problem is swept over them.
    bodies: int
    set: list = dataclasses.field(default_factory=list)
    reference: str | None = None
    key: object = None
    # What tells this model of the mechanism from others, where it has several.
    form: list = dataclasses.field(default_factory=list)
    # Whether the peers' scripts measure energy and violations.
    peers_measure: bool = True
    programs: list = dataclasses.field(default_factory=list)

    def add(self, program, setting, options, of_step=None):
        self.programs.append(Peer(self, program, setting, options, of_step))


def stiff_as_the_step(step):
    """MuJoCo's constraints are springs, at their stiffest with a time constant of two steps."""
    return [f"--solref={2 * step!r},1"]


def with_methods(problem, methods, form=None):
    """Methods of holonom come first, on the same model as the peers or on another form of it."""
    problem.programs[:0] = [Holonom(form or problem, name, by_accuracy) for name, by_accuracy in methods]
    return problem


def pendulum(step, end):
    problem = Problem("pendulum", "Spherical compound pendulum", "example:spherical-compound-pendulum", step, end, 0.25, 2,
                      reference="scp", key=errors.pendulum)
    options = ["--problem", "scp", "--model", "coords", "--ignore_dup"]
    problem.add("Exudyn", "trapezoidal", [*options, "--solver", "trap"])
    problem.add("Exudyn", "generalized-α", [*options, "--solver", "ga"])
    problem.add("MuJoCo", "RK4, ball joint", ["--problem", "scp"])
    return problem


def pendulum_in_both_forms(step, end):
    """As two particles with five rows, and as one rigid body on a ball joint, which is what MuJoCo's is."""
    problem = pendulum(step, end)
    rod = dataclasses.replace(problem, model=str(ROOT / "benches" / "models" / "pendulum-rod.toml"), key=errors.pendulum_rod,
                              form=["one rod"])
    return with_methods(with_methods(problem, [*METHODS[:4], ("ode/dop853", False), ("ode/dop853", True)], rod), METHODS)


def four_bar(windows, step, end):
    problem = Problem("four-bar", f"Four-bar, N = {windows}", "example:four-bar", step, end, 0.1, windows,
                      set=[f"parameters.N={windows}"], reference=f"fb{windows}", key=errors.four_bar)
    options = ["--problem", "fourbar", "--n", str(windows)]
    linear = ["--linear", "dense" if windows == 1 else "sparse"]
    problem.add("Exudyn", "generalized-α", [*options, *linear, "--solver", "ga"])
    problem.add("Exudyn", "generalized-α, tuned", [*options, *linear, "--solver", "ga", *TUNED])
    problem.add("MuJoCo", "RK4", options)
    problem.add("MuJoCo", "RK4, tuned", options, stiff_as_the_step)
    problem.add("MuJoCo", "implicitfast, tuned", [*options, "--integrator", "implicitfast"], stiff_as_the_step)
    return problem


def chain(rods, step, end):
    of_a_metre = [f"parameters.N={rods}", 'point.P.position=["i/N", 0]', "bar.first.mass=1/N", "bar.rod.mass=1/N"]
    problem = Problem("chain", f"Chain, N = {rods}", "example:chain", step, end, 0.05, rods, set=of_a_metre,
                      reference=f"chain{rods}", key=errors.chain)
    options = ["--problem", "chain", "--n", str(rods)]
    exudyn = [*options, "--model", "rb2d", "--linear", "sparse"]
    problem.add("Exudyn", "trapezoidal", exudyn)
    problem.add("Exudyn", "trapezoidal, tuned", [*exudyn, *TUNED])
    problem.add("MuJoCo", "RK4, tree", options)
    problem.add("Pinocchio", "RK4, ABA", options)
    return problem


def long_chain(rods, step, end):
    """Too long for the peers and without a reference."""
    problem = chain(rods, step, end)
    problem.reference, problem.programs = None, []
    return problem


def spatial_chain(rods, step, end):
    model = str(ROOT / "benches" / "models" / "spatial-chain.toml")
    problem = Problem("spatial-chain", f"Spatial chain, N = {rods}", model, step, end, 0.05, rods, set=[f"parameters.N={rods}"],
                      reference=f"chain{rods}", key=errors.spatial_chain)
    options = ["--problem", "chain", "--n", str(rods), "--model", "rb3d", "--linear", "sparse"]
    problem.add("Exudyn", "trapezoidal", options)
    problem.add("Exudyn", "trapezoidal, tuned", [*options, *TUNED])
    return problem


def andrews(step, end):
    problem = Problem("andrews", "Andrews' mechanism", "example:andrews", step, end, 1e-3, 7, reference="andrews", key=errors.andrews)
    options = ["--problem", "andrews"]
    problem.add("Exudyn", "generalized-α", [*options, "--solver", "ga"])
    problem.add("Exudyn", "trapezoidal", [*options, "--solver", "trap"])
    problem.add("MuJoCo", "RK4, tuned", options, stiff_as_the_step)
    return problem


def bricard(step, end):
    """The peers' rods are slender: what is left of their inertia about themselves moves the mechanism by 1e-6 m."""
    across, along = "0.08333333333333333", "1e-7"
    inertia = {1: [along, across, across], 2: [across, along, across], 3: [across, across, along],
               4: [along, across, across], 5: [across, along, across]}
    slender = [f"body.rod{k}.inertia=[{', '.join(moments)}]" for k, moments in inertia.items()]
    problem = Problem("bricard", "Bricard's mechanism", "example:bricard", step, end, 0.1, 5, set=slender, reference="bricard",
                      key=errors.bricard)
    options = ["--problem", "bricard"]
    full = [*options, "--model", "full", "--linear", "eigendense", "--ignore"]
    problem.add("Exudyn", "generalized-α", [*full, "--solver", "ga"])
    problem.add("Exudyn", "trapezoidal", [*full, "--solver", "trap"])
    problem.add("Exudyn", "generalized-α, reduced", [*options, "--model", "red", "--solver", "ga"])
    problem.add("MuJoCo", "RK4, tuned", options, stiff_as_the_step)
    problem.add("Pinocchio", "RK4, proximal", options)
    return problem


def governor(step, end):
    problem = Problem("governor", "Flyball governor", "example:flyball-governor", step, end, 0.1, 4, reference="flyball",
                      key=errors.governor, peers_measure=False)
    options = ["--problem", "flyball"]
    problem.add("Exudyn", "generalized-α", [*options, "--solver", "ga"])
    problem.add("Exudyn", "trapezoidal", [*options, "--solver", "trap"])
    problem.add("MuJoCo", "implicitfast", [*options, "--integrator", "implicitfast"])
    return problem


def of_costs():
    """Problems at equal steps."""
    found = [
        pendulum(0.025, 100.0),
        four_bar(1, 1e-3, 10.0),
        four_bar(40, 1e-3, 10.0),
        four_bar(1000, 1e-3, 0.5),
        *(chain(rods, 1e-3, 0.2) for rods in (10, 40, 160, 640)),
        long_chain(10_000, 1e-3, 0.2),
        spatial_chain(160, 1e-3, 0.2),
        andrews(1e-5, 0.05),
        bricard(1e-3, 10.0),
        governor(1e-3, 10.0),
    ]
    return [with_methods(problem, CONSERVING) for problem in found]


def of_precision():
    """Problems whose steps are swept, from the largest that has rows at the times of the reference."""
    explicit = [*METHODS, ("ode/dop853", True)]
    return [
        pendulum_in_both_forms(0.25, 20.0),
        with_methods(four_bar(40, 0.1, 10.0), METHODS),
        with_methods(chain(40, 0.05, 1.0), explicit),
        with_methods(andrews(1e-3, 0.05), METHODS),
        with_methods(bricard(0.1, 10.0), METHODS),
        with_methods(governor(0.1, 10.0), METHODS),
    ]
