//! What can be typed.

use clap::{Args, Parser, Subcommand, ValueEnum, value_parser};
use clap_complete::Shell;
use std::path::PathBuf;

/// Turns a toolpath into a program that a machine runs, and proves it by reading the program back.
#[derive(Debug, Parser)]
#[command(
    name = "toolpost",
    version,
    after_help = "Exit codes: 0 done; 1 the machine cannot do it, or the proof failed; 2 input or usage."
)]
pub struct CommandLine {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Say only what went wrong, and what was asked for.
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// Answer with one JSON object instead of text.
    #[arg(long, global = true)]
    pub json: bool,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Write the program of a toolpath for a machine, prove it, and save both program and report.
    Post(Post),
    /// Hold any program, also one edited by hand, against the toolpath it should make.
    Prove(Prove),
    /// The library of machines, and machines of your own.
    #[command(subcommand)]
    Machines(Machines),
    /// Count and measure a toolpath, and draw it.
    Show(Show),
    /// Say what a name of machine and control files means.
    Explain {
        /// A key, a word, a block or a variable; without one, all of them.
        topic: Option<String>,
    },
    /// Print the completions of a shell.
    Completions {
        /// Which shell.
        #[arg(value_parser = value_parser!(Shell))]
        shell: Shell,
    },
}

/// The toolpath.
#[derive(Debug, Args)]
pub struct Source {
    /// File with the toolpath: cutter-location data, or with --from an NC program.
    #[arg(value_name = "SOURCE")]
    pub path: PathBuf,
    /// Take every warning about the toolpath as an error.
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub origin: Origin,
}

/// What an NC program was written for.
#[derive(Debug, Args)]
#[command(next_help_heading = "NC program as the source")]
pub struct Origin {
    /// The source is an NC program of this control or machine: a name in the library, or a file
    /// ending in .toml. A program with rotary axes needs its machine.
    #[arg(long, value_name = "NAME|FILE")]
    pub from: Option<String>,
    /// Tool table (LinuxCNC's format): with it cutter radius compensation becomes the path of the
    /// tool's centre.
    #[arg(long, value_name = "FILE", requires = "from")]
    pub tools: Option<PathBuf>,
    /// Folder in which called programs are looked for; may be given several times.
    #[arg(long, value_name = "FOLDER", requires = "from")]
    pub folder: Vec<PathBuf>,
    /// What a length without a decimal point counts on a control that can be set either way.
    #[arg(long, value_name = "WHAT", requires = "from")]
    pub whole_numbers: Option<WholeNumbers>,
    /// Skip the blocks that begin with `/`.
    #[arg(long, requires = "from")]
    pub block_delete: bool,
    /// Where the tool stands when the program starts, mm.
    #[arg(long, value_name = "X,Y,Z", requires = "from", value_parser = point, allow_hyphen_values = true)]
    pub start: Option<[f64; 3]>,
}

/// What a length without a decimal point counts.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum WholeNumbers {
    /// mm, inches or degrees, as on a calculator.
    Units,
    /// Thousandths of a mm, ten-thousandths of an inch, thousandths of a degree.
    Increments,
}

/// How close the proof must be.
#[derive(Debug, Args)]
pub struct Closeness {
    /// Largest distance of the tool tip from the toolpath, mm [default: from the program's own
    /// resolution].
    #[arg(long, value_name = "MM", value_parser = length)]
    pub tolerance: Option<f64>,
}

/// Arguments of `post`.
#[derive(Debug, Args)]
pub struct Post {
    #[command(flatten)]
    pub source: Source,
    /// Name in the library, or a file ending in .toml.
    #[arg(long, short, value_name = "NAME|FILE")]
    pub machine: String,
    /// Where to save the program; the report goes beside it.
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    #[command(flatten)]
    pub closeness: Closeness,
}

/// Arguments of `prove`.
#[derive(Debug, Args)]
pub struct Prove {
    /// The program.
    pub program: PathBuf,
    /// Name in the library, or a file ending in .toml.
    #[arg(long, short, value_name = "NAME|FILE")]
    pub machine: String,
    /// File with the toolpath: cutter-location data, or with --from an NC program.
    #[arg(long, value_name = "SOURCE")]
    pub against: PathBuf,
    #[command(flatten)]
    pub origin: Origin,
    #[command(flatten)]
    pub closeness: Closeness,
}

/// Arguments of `show`.
#[derive(Debug, Args)]
pub struct Show {
    #[command(flatten)]
    pub source: Source,
    /// Where to save a drawing, as .svg or .png.
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// Commands of `machines`.
#[derive(Debug, Subcommand)]
pub enum Machines {
    /// The machines and controls of the library.
    List,
    /// Print a machine or a control of the library, ready to be copied.
    Show {
        /// Name in the library.
        name: String,
    },
    /// Start a machine of your own: NAME.toml in this folder.
    New {
        /// Its name.
        name: String,
        /// The machine it starts as: a name in the library, or a file ending in .toml.
        #[arg(long, value_name = "NAME|FILE")]
        from: String,
    },
    /// Look for mistakes in a machine file.
    Check {
        /// The file, ending in .toml; or a name in the library.
        file: String,
    },
}

/// A length in mm, greater than 0.
fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(mm) if mm > 0.0 && mm.is_finite() => Ok(mm),
        _ => Err(String::from("a length in mm greater than 0 is needed, such as 0.01")),
    }
}

/// Three lengths in mm.
fn point(text: &str) -> Result<[f64; 3], String> {
    let parts: Vec<Option<f64>> = text
        .split(',')
        .map(|part| part.trim().parse().ok().filter(|v: &f64| v.is_finite()))
        .collect();
    match parts[..] {
        [Some(x), Some(y), Some(z)] => Ok([x, y, z]),
        _ => Err(String::from("three lengths in mm are needed, such as 0,0,50")),
    }
}
