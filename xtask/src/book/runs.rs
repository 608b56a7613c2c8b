//! The runs behind the figures: calls of `holonom compare`.

use std::path::Path;
use std::process::Command;

/// One call of `holonom compare`.
pub struct Runs {
    pub name: &'static str,
    pub model: &'static str,
    pub methods: &'static [&'static str],
    /// s.
    pub steps: &'static [&'static str],
    /// s.
    pub end: &'static str,
    pub set: &'static [&'static str],
}

const PENDULUM: &str = "example:spherical-compound-pendulum";
const SPRING: &str = "example:spring-pendulum";
/// One centimetre beyond the spring's rest length: a vibration of 0.5 J.
const STRETCHED: &str = "point.bob.position=[1.01, 0]";

/// Every run of the chapter.
pub const RUNS: &[Runs] = &[
    Runs {
        name: "pendulum",
        model: PENDULUM,
        methods: &[
            "trapezoidal",
            "augmented-lagrangian-3/midpoint",
            "lagrange-2/trapezoidal",
            "lagrange-2/radau-3",
            "lagrange-1/trapezoidal",
            "lagrange-1/rk4",
            "lagrange-1/rk4/velocity+acceleration",
            "baumgarte/trapezoidal",
            "baumgarte/rk4",
            "ode/rk4",
            "ode/dopri5",
            "ode/dop853",
            "ggl/bdf-1",
            "ggl/bdf-2",
            "ggl/bdf-3",
            "ggl/bdf-4",
            "ggl/bdf-5",
            "ggl/radau-1",
            "ggl/radau-3",
            "ggl/radau-5",
            "generalized-alpha",
            "lagrange-3/hht",
            "lagrange-3/rattle",
            "conserving",
            "conserving-projected",
            "conserving-ggl",
            "ggl/conserving-ggl-4",
            "ggl/conserving-ggl-6",
            "trapezoidal-projected",
            "penalty/conserving",
            "penalty/trapezoidal",
            "penalty-stabilized/trapezoidal",
        ],
        steps: &["0.025"],
        end: "20",
        set: &[],
    },
    Runs {
        name: "paper-loop",
        model: PENDULUM,
        methods: &["trapezoidal"],
        steps: &["0.025"],
        end: "20",
        set: &["simulation.iteration=simultaneous", "simulation.penalty=1e7"],
    },
    Runs { name: "double-pendulum", model: "example:double-pendulum", methods: &["ode/dop853"], steps: &["0.01"], end: "20", set: &[] },
    Runs {
        name: "accuracy",
        model: PENDULUM,
        methods: &["conserving-ggl", "ggl/conserving-ggl-4", "ggl/conserving-ggl-6", "ggl/radau-5", "ode/dop853", "lagrange-3/rattle"],
        steps: STEPS,
        end: "2",
        set: &[],
    },
    Runs {
        name: "penalty-1e5",
        model: PENDULUM,
        methods: &["penalty/conserving"],
        steps: &["0.025"],
        end: "20",
        set: &["simulation.penalty=1e5"],
    },
    Runs {
        name: "penalty-1e6",
        model: PENDULUM,
        methods: &["penalty/conserving"],
        steps: &["0.025"],
        end: "20",
        set: &["simulation.penalty=1e6"],
    },
    Runs {
        name: "spring",
        model: SPRING,
        methods: &["conserving-ggl", "generalized-alpha", "ggl/bdf-2", "ggl/radau-5"],
        steps: &["0.025"],
        end: "10",
        set: &[STRETCHED],
    },
    Runs {
        name: "spring-rho-0",
        model: SPRING,
        methods: &["generalized-alpha"],
        steps: &["0.025"],
        end: "10",
        set: &[STRETCHED, "simulation.rho=0"],
    },
    Runs {
        name: "spring-rho-1",
        model: SPRING,
        methods: &["generalized-alpha"],
        steps: &["0.025"],
        end: "10",
        set: &[STRETCHED, "simulation.rho=1"],
    },
];

/// Steps of the figure of accuracy, s, from large to small; each divides 2 s.
pub const STEPS: &[&str] = &["0.2", "0.1", "0.05", "0.04", "0.025", "0.02", "0.0125", "0.01"];

impl Runs {
    /// Runs them, with the tables of numbers in a folder below `root`.
    pub fn run(&self, root: &Path, folder: &str) -> Result<(), String> {
        let mut command = Command::new("cargo");
        command.current_dir(root).args(["run", "--quiet", "-p", "holonom-cli", "--", "compare", self.model]);
        let keys = [("--method", self.methods), ("--step", self.steps), ("--set", self.set)];
        for (key, value) in keys.iter().flat_map(|(key, values)| values.iter().map(move |value| (key, value))) {
            command.args([key, value]);
        }
        command.args(["--end", self.end, "--every", "1", "--no-report", "--quiet", "--force", "--out", &format!("{folder}/{}", self.name)]);
        match command.status() {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(format!("the runs `{}` ended with {status}", self.name)),
            Err(error) => Err(format!("cargo does not start: {error}")),
        }
    }

    /// Methods and steps with the file that `holonom compare` writes for each.
    pub fn files(&self) -> impl Iterator<Item = (&'static str, &'static str, String)> {
        let many = self.steps.len() > 1;
        self.steps.iter().flat_map(move |step| {
            self.methods.iter().map(move |method| {
                let name = method.replace('/', "-");
                (*method, *step, if many { format!("{name}-{step}s.csv") } else { format!("{name}.csv") })
            })
        })
    }
}
