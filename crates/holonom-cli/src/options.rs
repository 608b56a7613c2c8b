//! What can be typed.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueHint};
use clap_complete::Shell;

/// Dynamics of mechanisms: exact constraints, audited energy, large steps.
#[derive(Debug, Parser)]
#[command(name = "holonom", version, about, arg_required_else_help = true)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Simulate a model; table on screen, results and report in a folder
    Run(RunArguments),
    /// Methods, steps, models, variants, earlier results and measured data in one report, curves overlaid
    Compare(CompareArguments),
    /// Many runs of a model whose keys take several values, on all cores, in one table
    Sweep(SweepArguments),
    /// The largest step with which each method completes, by bisection
    Stability(StabilityArguments),
    /// Validate a model: degrees of freedom, rank, redundant rows, what is near singular
    Check(CheckArguments),
    /// Natural frequencies, damping and shapes of small vibrations about the start, and whether it is stable
    Modes(ModesArguments),
    /// Formulations, integrators and projections, and which go together
    Methods(MethodsArguments),
    /// The gallery inside the binary
    Examples(ExamplesArguments),
    /// Show the report of a run in the browser, served on 127.0.0.1
    View(ViewArguments),
    /// JSON Schema of the model file
    Schema,
    /// Print what makes a shell complete commands and options
    Completions(CompletionsArguments),
}

/// A model and what is changed of it.
#[derive(Debug, Args)]
pub struct ModelArguments {
    /// A model file, - for standard input, or example:NAME
    #[arg(value_hint = ValueHint::FilePath)]
    pub model: String,
    /// Set any key of the model file, such as simulation.step=0.01 or parameters.N=40
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// Where results go, and what is said of them.
#[derive(Debug, Args)]
pub struct Destination {
    /// Folder for the results [default: results/<model>-<method>, -compare, -sweep, -stability or -modes; with -2, -3, … where these hold others]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Overwrite the results of another run
    #[arg(long)]
    pub force: bool,
    /// Print the result as JSON on standard output, nothing else there
    #[arg(long)]
    pub json: bool,
    /// Print nothing but errors and why a run stopped
    #[arg(long)]
    pub quiet: bool,
}

/// What is kept of a run.
#[derive(Debug, Args)]
pub struct OutputArguments {
    #[command(flatten)]
    pub to: Destination,
    /// Write no report
    #[arg(long)]
    pub no_report: bool,
    /// Format of the trajectory; may be given several times
    #[arg(long = "format", value_name = "FORMAT", default_value = "csv")]
    pub formats: Vec<String>,
    /// Record every N-th step
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub every: Option<u64>,
}

/// How a model runs.
#[derive(Debug, Args)]
pub struct MethodArguments {
    /// Method by name; see `holonom methods`
    #[arg(long = "method", value_name = "NAME")]
    pub name: Option<String>,
    /// Step, s
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub step: Option<String>,
    /// Choose steps so that errors over the run stay about this share of the mechanism's size; results come at every --step
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    pub accuracy: Option<String>,
    /// End of the run, s
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub end: Option<String>,
}

#[derive(Debug, Args)]
pub struct RunArguments {
    #[command(flatten)]
    pub model: ModelArguments,
    #[command(flatten)]
    pub method: MethodArguments,
    /// Go on with an earlier run, that was ended or killed, in its folder; with a later --end, too
    #[arg(long, value_name = "FOLDER or CHECKPOINT")]
    pub resume: Option<PathBuf>,
    #[command(flatten)]
    pub output: OutputArguments,
}

#[derive(Debug, Args)]
pub struct CompareArguments {
    /// Models (files or example:NAME), folders of earlier runs, CSV files of measured data; the first is what the others are compared with
    #[arg(required = true, value_name = "MODEL|FOLDER|CSV")]
    pub subjects: Vec<String>,
    /// Set any key of all models, such as simulation.step=0.01 or parameters.N=40
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Run each model once more with these keys set, too; give several
    #[arg(long = "variant", value_name = "KEY=VALUE,…")]
    pub variants: Vec<String>,
    /// Columns whose largest and rms difference to the first is told, and that are plotted first
    #[arg(long, value_name = "COLUMN,…")]
    pub columns: Vec<String>,
    /// Method by name; give several [default: all named methods, or of several models and variants their own]
    #[arg(long = "method", value_name = "NAME")]
    pub methods: Vec<String>,
    /// Step, s; give several
    #[arg(long = "step", value_name = "S", allow_negative_numbers = true)]
    pub steps: Vec<String>,
    /// End of the run, s
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub end: Option<String>,
    #[command(flatten)]
    pub output: OutputArguments,
}

#[derive(Debug, Args)]
pub struct StabilityArguments {
    #[command(flatten)]
    pub model: ModelArguments,
    /// Method by name; give several [default: all named methods]
    #[arg(long = "method", value_name = "NAME")]
    pub methods: Vec<String>,
    /// End of the run, s
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub end: Option<String>,
    /// First step to try, s [default: the model's]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub step: Option<String>,
    #[command(flatten)]
    pub to: Destination,
    /// Write no report
    #[arg(long)]
    pub no_report: bool,
}

#[derive(Debug, Args)]
pub struct SweepArguments {
    #[command(flatten)]
    pub model: ModelArguments,
    /// A key of the model file and its values: lo..hi:N, lo..hi:Nlog for even ratios, or a,b,c; give several for a grid
    #[arg(long, value_name = "KEY=VALUES", required = true)]
    pub vary: Vec<String>,
    /// Draw N random samples in place of the grid: evenly from lo..hi (lo..hi:log in ratio), one of a,b,c
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub samples: Option<u64>,
    /// Seed of the samples; the same seed gives the same samples everywhere
    #[arg(long, value_name = "S", default_value_t = 0, requires = "samples")]
    pub seed: u64,
    #[command(flatten)]
    pub method: MethodArguments,
    /// Columns of the table: last values of columns of the trajectory or of formulas of some, or max(…), min(…), mean(…), rms(…), at(…, t) of them;
    /// frequency(N), damping(N), growth(N) of modes
    /// [default: energy, and all of points, bodies, joints and drives]
    #[arg(long, value_name = "COLUMN,…")]
    pub columns: Vec<String>,
    /// Runs at a time [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Write no report
    #[arg(long)]
    pub no_report: bool,
    /// Write the table in another format, too; may be given several times
    #[arg(long = "format", value_name = "FORMAT")]
    pub formats: Vec<String>,
    #[command(flatten)]
    pub to: Destination,
}

#[derive(Debug, Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub model: ModelArguments,
    /// Say what the projection of the model's method can do to the energy: the matrix D of (30)
    #[arg(long)]
    pub projection: bool,
    /// Print the result as JSON on standard output, nothing else there
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct ModesArguments {
    #[command(flatten)]
    pub model: ModelArguments,
    #[command(flatten)]
    pub to: Destination,
    /// Write no report
    #[arg(long)]
    pub no_report: bool,
}

#[derive(Debug, Args)]
pub struct MethodsArguments {
    /// One method, formulation, integrator or projection to explain
    pub name: Option<String>,
}

#[derive(Debug, Args)]
pub struct ExamplesArguments {
    /// One example to show
    pub name: Option<String>,
    /// Write its file into a folder
    #[arg(long, value_name = "DIR", requires = "name")]
    pub copy: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct ViewArguments {
    /// A folder with results
    pub folder: PathBuf,
    /// Port; 0 takes a free one
    #[arg(long, default_value_t = 0)]
    pub port: u16,
    /// Print the address only
    #[arg(long)]
    pub no_browser: bool,
}

#[derive(Debug, Args)]
pub struct CompletionsArguments {
    /// The shell
    pub shell: Shell,
}
