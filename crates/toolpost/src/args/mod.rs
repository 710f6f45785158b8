//! What can be typed.

pub mod glass;
pub mod pcb;

use app::Stop;
use app::toolpath::Frame;
use app::wire::Sync;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, value_parser};
use clap_complete::Shell;
use control::{Units, WholeNumbers};
use geom::{Vec2, Vec3};
use program::{CompensatedPath, LEAST_SETTING, MOST_SETTING, Rule};
use proof::{Accepted, Tolerances};
use source::apt::Csys;
use std::path::PathBuf;
use wire::cutting::Side;
use wire::plan::Trims;
use wire::taper::Rounding;
use wire::{Lead, LeadShape};

/// Turns a toolpath into a program that a machine runs, and proves it by reading the program back.
#[derive(Debug, Parser)]
#[command(
    name = "toolpost",
    version,
    after_help = "Exit codes: 0 done; 1 the machine cannot do it, or the proof failed; 2 input or usage; 3 `pcb` left a program out; 130 interrupted."
)]
pub struct CommandLine {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Say only what went wrong, what was asked for, and on what assumptions the program rests.
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
    /// Write the program of a wire-EDM machine for a contour (of a program or a drawing), prove it, and
    /// save both program and report.
    Wire(Box<Wire>),
    /// Write the programs that isolate, drill and cut out a printed circuit board, prove them, and save them
    /// with a picture of each and a report.
    Pcb(Box<pcb::Pcb>),
    /// Write the program that engraves bodies and points inside a block of glass, prove it, and save both program
    /// and report.
    Glass(Box<glass::Glass>),
    /// Prove any program, also one edited by hand, against the toolpath that it should make.
    Prove(Prove),
    /// The library of machines, and machines of your own.
    #[command(subcommand)]
    Machines(Machines),
    /// Count and measure a toolpath, and draw it.
    Show(Show),
    /// Look for places of the part at which a robot can make a toolpath, and print each with its margins.
    Fit(Fit),
    /// Open the studio in the browser: source, program, machine and proof in one window. The server listens on this computer alone
    /// and reads and writes one folder alone.
    Studio(Studio),
    /// Say what a name of machine and control files, or a rule of a finding, means.
    Explain {
        /// A key, a word, a block, a variable, or a rule; without one, all of them.
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
    /// File with the toolpath: cutter-location data; a job of FreeCAD (.json, .FCStd, dump); or with
    /// --from an NC program.
    #[arg(value_name = "SOURCE")]
    pub path: PathBuf,
    /// Take every warning about the toolpath as an error.
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub origin: Origin,
}

/// What an NC program was written for, and what the operator has set up.
#[derive(Debug, Default, Args)]
#[command(next_help_heading = "NC program as the source")]
pub struct Origin {
    /// The source is an NC program of this control or machine: a name in the library, or a file
    /// ending in .toml. A program with rotary axes needs its machine.
    #[arg(long, value_name = "NAME|FILE")]
    pub from: Option<String>,
    /// Tool table (LinuxCNC's format): with it cutter radius compensation becomes the path of the
    /// tool's centre.
    #[arg(long, value_name = "FILE")]
    pub tools: Option<PathBuf>,
    /// Folder in which called programs are looked for; may be given several times.
    #[arg(long, value_name = "FOLDER")]
    pub folder: Vec<PathBuf>,
    /// What a length without a decimal point counts on a control that can be set either way.
    #[arg(long, value_name = "WHAT", value_parser = choice(&WHOLE_NUMBERS))]
    pub whole_numbers: Option<WholeNumbers>,
    /// What lengths count before the program says it by G20 or G21.
    #[arg(long, value_name = "UNIT", value_parser = choice(&UNITS))]
    pub units: Option<Units>,
    /// Which way a boring bar goes from the wall of a hole, where the machine is set to it (G76, G87).
    #[arg(long, value_name = "WAY", allow_hyphen_values = true, value_parser = choice(&ASIDE))]
    pub aside: Option<Vec3>,
    /// Skip the blocks that begin with `/`.
    #[arg(long)]
    pub block_delete: bool,
    /// Where the tool stands when the program starts, mm.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub start: Option<[f64; 3]>,
    /// Where the coordinates behind a CSYS of SolidWorks CAM stand [default: world, where the file says TRNTYP/WORLD].
    #[arg(
        long,
        value_name = "FRAME",
        value_parser = choice(&CSYS),
        help_heading = "SolidWorks CAM as the source"
    )]
    pub csys: Option<Csys>,
    /// Which path the coordinates behind CUTCOM are [default: what an arc in the file shows].
    #[arg(
        long,
        value_name = "PATH",
        value_parser = choice(&CUTCOM),
        help_heading = "Cutter-location data as the source"
    )]
    pub cutcom: Option<CompensatedPath>,
}

impl Origin {
    /// As the toolpath is opened.
    pub fn origin(&self) -> app::Origin {
        app::Origin {
            from: self.from.clone(),
            tools: self.tools.clone().map(app::Source::File),
            folders: self.folder.clone(),
            whole_numbers: self.whole_numbers.unwrap_or_default(),
            units: self.units,
            aside: self.aside,
            block_delete: self.block_delete,
            start: self.start.map(Vec3::from_array),
            csys: self.csys,
            cutcom: self.cutcom,
            ..app::Origin::default()
        }
    }
}

/// Values of `--whole-numbers`.
const WHOLE_NUMBERS: [Choice<WholeNumbers>; 2] = [
    ("units", "mm, inches or degrees, as on a calculator", WholeNumbers::Units),
    (
        "increments",
        "Thousandths of a mm, ten-thousandths of an inch, thousandths of a degree",
        WholeNumbers::Increments,
    ),
];

/// Values of `--units`.
const UNITS: [Choice<Units>; 2] =
    [("mm", "Millimetres", Units::Millimeters), ("inch", "Inches", Units::Inches)];

/// Values of `--aside`.
const ASIDE: [Choice<Vec3>; 4] = [
    ("+X", "Along X", Vec3::X),
    ("-X", "Against X", Vec3::NEG_X),
    ("+Y", "Along Y", Vec3::Y),
    ("-Y", "Against Y", Vec3::NEG_Y),
];

/// Values of `--csys`.
const CSYS: [Choice<Csys>; 2] = [
    ("local", "In the frame of each CSYS", Csys::Local),
    ("world", "In one frame, whatever CSYS says", Csys::World),
];

/// Values of `--cutcom`.
const CUTCOM: [Choice<CompensatedPath>; 2] = [
    (
        "centre",
        "That of the tool's centre: the CAM system has offset it by the tool",
        CompensatedPath::Center,
    ),
    ("contour", "The contour that is cut: the control has to offset it", CompensatedPath::Contour),
];

/// Values of `--side`.
const SIDES: [Choice<Side>; 5] = [
    ("inside", "Within a closed contour, as for the opening of a die", Side::Inside),
    ("outside", "Round a closed contour, as for a punch", Side::Outside),
    (
        "part",
        "Round the outer contours and within those inside of them, as for a part with openings",
        Side::Part,
    ),
    ("left", "Left of the way", Side::Left),
    ("right", "Right of the way", Side::Right),
];

/// Values of `--trims`.
const TRIMS: [Choice<Trims>; 2] = [
    (
        "alternate",
        "Each the other way than the one before; the wire stays threaded",
        Trims::Alternate,
    ),
    ("repeat", "Each the way of the first", Trims::Repeat),
];

/// Values of `--rounding`.
const ROUNDING: [Choice<Rounding>; 2] = [
    ("conical", "Their radius grows or shrinks with the lean", Rounding::Conical),
    ("constant", "They keep their radius", Rounding::Constant),
];

/// Values of `--sync`.
const SYNC: [Choice<Sync>; 2] = [
    ("block", "Both programs have the same moves, block for block", Sync::Block),
    ("length", "Both ends have covered the same part of their length", Sync::Length),
];

/// Values of `--frame`.
const FRAMES: [Choice<Frame>; 2] = [
    ("part", "That of the part: where the tip of the tool goes", Frame::Part),
    ("machine", "That of the machine: where X, Y and Z go", Frame::Machine),
];

/// A word that an option takes, what it means, and what it stands for.
type Choice<T> = (&'static str, &'static str, T);

/// The parser of an option that takes one of some words.
fn choice<T: Clone + Send + std::marker::Sync>(
    all: &'static [Choice<T>],
) -> impl TypedValueParser<Value = T> {
    let words = all.iter().map(|(word, help, _)| PossibleValue::new(*word).help(*help));
    PossibleValuesParser::new(words).try_map(|given| {
        let found = all.iter().find(|(word, ..)| *word == given);
        found.map(|(.., meaning)| meaning.clone()).ok_or("it is none of these words")
    })
}

/// How close the proof must be.
#[derive(Debug, Args)]
pub struct Closeness {
    /// Largest distance of the tool tip from the toolpath, mm [default: from the program's own
    /// resolution].
    #[arg(long, value_name = "MM", value_parser = closeness)]
    pub tolerance: Option<f64>,
    /// Let a rule pass in this run that depends on how the machine is set up; may be given several times. The head of the
    /// program and the report name it.
    #[arg(long, value_name = "RULE", value_parser = accepted)]
    pub accept: Vec<Rule>,
}

impl Closeness {
    /// As the proof takes it.
    pub fn tolerances(&self) -> Tolerances {
        let rules = self.accept.iter();
        let accepted =
            rules.fold(Accepted::default(), |all, rule| all.and(rule.name()).unwrap_or(all));
        Tolerances { position: self.tolerance, angle: None, accepted }
    }
}

/// The rule of this name, where it may be accepted.
fn accepted(name: &str) -> Result<Rule, String> {
    Accepted::default().and(name)?.rules().next().ok_or_else(String::new)
}

/// Arguments of `post`.
#[derive(Debug, Args)]
pub struct Post {
    /// Name in the library, or a file ending in .toml.
    #[arg(long, short, value_name = "NAME|FILE")]
    pub machine: String,
    /// Where to save the program; the report goes next to it.
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Another value for one of the options of the machine file; may be given several times.
    #[arg(long, value_name = "NAME=VALUE", value_parser = option)]
    pub option: Vec<(String, String)>,
    #[command(flatten)]
    pub closeness: Closeness,
    #[command(flatten)]
    pub source: Source,
}

/// Arguments of `wire`.
#[derive(Debug, Args)]
pub struct Wire {
    /// Name in the library, or a file ending in .toml.
    #[arg(long, short, value_name = "NAME|FILE")]
    pub machine: String,
    /// Where to save the program; the report goes next to it.
    #[arg(long, short, value_name = "FILE")]
    pub output: PathBuf,
    /// Draw the contour, its points and the ruled surface, as .svg or .png.
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Mark what came from this line of the source.
    #[arg(long, value_name = "LINE")]
    pub select: Option<u32>,
    #[command(flatten)]
    pub closeness: Closeness,
    #[command(flatten)]
    pub source: Source,
    #[command(flatten)]
    pub drawing: Drawing,
    #[command(flatten)]
    pub ends: Ends,
    #[command(flatten)]
    pub cutting: Cutting,
    #[command(flatten)]
    pub division: Division,
}

impl Wire {
    /// As the wire is planned.
    ///
    /// # Errors
    /// Points are asked for in two ways.
    pub fn settings(&self) -> Result<app::wire::Settings, Stop> {
        let Ends { upper, sync, pair, height, uv_height } = &self.ends;
        let Division { step, chord_error, fit, memory } = self.division;
        Ok(app::wire::Settings {
            layers: self.drawing.layer.clone(),
            close: self.drawing.close,
            upper: upper.clone().map(app::Source::File),
            sync: *sync,
            pairs: pair.clone(),
            height: *height,
            uv_height: *uv_height,
            cutting: self.cutting.cutting(),
            step: app::wire::step(step, chord_error, fit)?,
            memory,
            select: self.select,
        })
    }
}

/// What is read of a drawing.
#[derive(Debug, Args)]
#[command(next_help_heading = "Drawing (.dxf) as the source")]
pub struct Drawing {
    /// Read this layer only; may be given several times.
    #[arg(long, value_name = "NAME")]
    pub layer: Vec<String>,
    /// How far ends that belong together may be apart.
    #[arg(long, value_name = "MM", value_parser = length, default_value = "0.01")]
    pub close: f64,
}

/// How the wire goes along a contour.
#[derive(Debug, Args)]
#[command(next_help_heading = "The wire and the contour")]
pub struct Cutting {
    /// On which side of the contours the wire runs [default: along the contours themselves].
    #[arg(long, value_parser = choice(&SIDES))]
    pub side: Option<Side>,
    /// Diameter of the wire.
    #[arg(long, value_name = "MM", value_parser = length)]
    pub wire: Option<f64>,
    /// Spark gap of the last pass.
    #[arg(long, value_name = "MM", value_parser = length)]
    pub gap: Option<f64>,
    /// What each pass but the last leaves for those after it, such as 0.1,0.02 for three passes.
    #[arg(long, value_name = "MM,...", value_parser = length, value_delimiter = ',')]
    pub leave: Vec<f64>,
    /// Which way round the passes after the first go.
    #[arg(long, value_name = "HOW", default_value = "alternate", value_parser = choice(&TRIMS))]
    pub trims: Trims,
    /// Where the wire is threaded; once for each contour, in their order.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    pub thread: Vec<[f64; 2]>,
    /// How far from a contour the wire is threaded where --thread does not say where.
    #[arg(long, value_name = "MM", value_parser = length)]
    pub lead: Option<f64>,
    /// Radius of the quarter circle by which the wire comes to the contour [default: straight].
    #[arg(long, value_name = "MM", value_parser = length)]
    pub lead_arc: Option<f64>,
    /// Where the cut of a closed contour begins: the place nearest to this point.
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    pub begin: Option<[f64; 2]>,
    /// How much of each closed contour holds the part until all else is cut.
    #[arg(long, value_name = "MM", value_parser = length)]
    pub tab: Option<f64>,
    /// How far the wire leans: the part larger at the top, or smaller where negative; over --height.
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true)]
    pub taper: Option<f64>,
    /// What becomes of rounded corners on the way up.
    #[arg(long, value_name = "HOW", default_value = "conical", value_parser = choice(&ROUNDING))]
    pub rounding: Rounding,
    /// Let the control offset and lean the wire, each pass by the register of its number: the program is
    /// then that of the contour itself.
    #[arg(long)]
    pub by_control: bool,
    /// Let inner corners that the wire is too thick for become as round as the wire.
    #[arg(long)]
    pub round_corners: bool,
    /// Feed in mm/s, for the cutting time and the program: one for all passes, or one for each.
    #[arg(long, value_name = "MM/S,...", value_parser = length, value_delimiter = ',')]
    pub feed: Vec<f64>,
}

impl Cutting {
    /// As the passes are planned.
    fn cutting(&self) -> wire::cutting::Cutting {
        wire::cutting::Cutting {
            side: self.side,
            wire: self.wire.unwrap_or(0.0),
            gap: self.gap.unwrap_or(0.0),
            leave: self.leave.clone(),
            trims: self.trims,
            thread: self.thread.iter().copied().map(Vec2::from_array).collect(),
            lead: Lead {
                length: self.lead.unwrap_or(0.0),
                shape: self.lead_arc.map_or(LeadShape::Straight, LeadShape::Arc),
            },
            begin: self.begin.map(Vec2::from_array),
            tab: self.tab,
            taper: self.taper,
            rounding: self.rounding,
            by_control: self.by_control,
            round_corners: self.round_corners,
            feeds: self.feed.clone(),
        }
    }
}

/// What the two ends of the wire follow.
#[derive(Debug, Args)]
#[command(next_help_heading = "The two ends of the wire")]
pub struct Ends {
    /// The upper contour, in a file like the source; the source is then the lower one.
    #[arg(long, value_name = "FILE")]
    pub upper: Option<PathBuf>,
    /// Which point above belongs to which below.
    #[arg(long, value_name = "HOW", default_value = "block", value_parser = choice(&SYNC))]
    pub sync: Sync,
    /// A point below and the one above that belongs to it, instead of --sync; several times in the order
    /// of travel, between which both ends cover the same part of their length.
    #[arg(long, value_name = "X,Y,X,Y", value_parser = pair, allow_hyphen_values = true)]
    pub pair: Vec<[f64; 4]>,
    /// Height of the part: of the upper contour over the lower [default: of a source with U and V, that of its plane].
    #[arg(long, value_name = "MM", value_parser = length)]
    pub height: Option<f64>,
    /// Height of the plane in which the machine counts U and V, where its file does not say it (`height` in [wire]).
    #[arg(long, value_name = "MM", value_parser = length)]
    pub uv_height: Option<f64>,
}

/// Into how many points arcs are divided, for a control that cuts none.
#[derive(Debug, Args)]
#[command(next_help_heading = "Points, for a control without arcs")]
pub struct Division {
    /// One point every so many mm of arc.
    #[arg(long, value_name = "MM", value_parser = number, allow_hyphen_values = true)]
    pub step: Option<f64>,
    /// As many points as keep this chord error [default: lowering_tolerance of the machine file].
    #[arg(long, value_name = "MM", value_parser = number, allow_hyphen_values = true)]
    pub chord_error: Option<f64>,
    /// As many points as the memory of the control holds.
    #[arg(long)]
    pub fit: bool,
    /// How many points the control holds [default: that of the machine file].
    #[arg(long, value_name = "POINTS")]
    pub memory: Option<usize>,
}

/// Arguments of `prove`.
#[derive(Debug, Args)]
pub struct Prove {
    /// The program.
    pub program: PathBuf,
    /// Name in the library, or a file ending in .toml.
    #[arg(long, short, value_name = "NAME|FILE")]
    pub machine: String,
    /// Another value for one of the options of the machine file; may be given several times.
    #[arg(long, value_name = "NAME=VALUE", value_parser = option)]
    pub option: Vec<(String, String)>,
    /// File with the toolpath, as `post` takes it; or for a program of `pcb` the board, with the report.json beside the
    /// program, which has the options.
    #[arg(long, value_name = "SOURCE")]
    pub against: PathBuf,
    #[command(flatten)]
    pub closeness: Closeness,
    #[command(flatten)]
    pub origin: Origin,
}

/// Arguments of `show`.
#[derive(Debug, Args)]
pub struct Show {
    /// Where to save a drawing, as .svg or .png.
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// In which frame an NC program is drawn.
    #[arg(long, default_value = "part", value_parser = choice(&FRAMES))]
    pub frame: Frame,
    /// A robot, which leads the tool: its margins in colours along the path, and its joints and their speeds with their limits. A name in
    /// the library, or a file ending in .toml.
    #[arg(long, short, value_name = "NAME|FILE")]
    pub machine: Option<String>,
    #[command(flatten)]
    pub source: Source,
}

/// Arguments of `fit`.
#[derive(Debug, Args)]
pub struct Fit {
    /// Name of a robot in the library, or a file ending in .toml.
    #[arg(long, short, value_name = "NAME|FILE")]
    pub machine: String,
    /// Another value for one of the options of the machine file; may be given several times.
    #[arg(long, value_name = "NAME=VALUE", value_parser = option)]
    pub option: Vec<(String, String)>,
    /// How far the part may be moved from where the machine file puts it, along each axis, mm.
    #[arg(long, value_name = "MM", default_value = "300", value_parser = length)]
    pub within: f64,
    #[command(flatten)]
    pub source: Source,
}

/// Arguments of `studio`.
#[derive(Debug, Args)]
pub struct Studio {
    /// File with the toolpath, in the folder; it is posted at once where --machine is given too.
    #[arg(value_name = "SOURCE")]
    pub source: Option<PathBuf>,
    /// Name in the library, or a file of the folder ending in .toml.
    #[arg(long, short, value_name = "NAME|FILE")]
    pub machine: Option<String>,
    /// Folder in which files are read and saved, and none outside it [default: that of the source, or this folder].
    #[arg(long, value_name = "FOLDER")]
    pub folder: Option<PathBuf>,
    /// Port of 127.0.0.1 on which the studio listens [default: the folder's own, the same each time, or a free one where that is taken].
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..))]
    pub port: Option<u16>,
    /// Print the link and open no browser.
    #[arg(long)]
    pub no_open: bool,
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
    /// Make a machine file of a post of VCarve or Aspire (.pp), of templates with @parameter@, of an arm (.urdf), or of the
    /// calibration of an arm of Universal Robots (.yaml).
    Import {
        /// The post, the templates, or the description of the arm.
        file: PathBuf,
        /// Where to save the machine file.
        #[arg(long, short, value_name = "FILE")]
        output: PathBuf,
        /// The control or machine that it extends: a name in the library, or a file ending in .toml
        /// [default: the control that the post names].
        #[arg(long, value_name = "NAME|FILE")]
        extends: Option<String>,
        /// Reach of an arm from axis 1 to the wrist centre as its data sheet states it, mm: another one is refused.
        #[arg(long, value_name = "MM", value_parser = length)]
        reach: Option<f64>,
    },
    /// Look for mistakes in a machine file.
    Check {
        /// The file, ending in .toml; or a name in the library.
        file: String,
        /// Print the keys on which its programs hang and which the file does not say, each as the line to add.
        #[arg(long)]
        upgrade: bool,
    },
}

/// A length, a feed or a speed, greater than 0.
fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(mm) if (LEAST_SETTING..=MOST_SETTING).contains(&mm) => Ok(mm),
        _ => Err(format!(
            "a number greater than 0 is needed, {LEAST_SETTING} to {MOST_SETTING}, such as 0.01"
        )),
    }
}

/// How far a program may be from its source, mm.
fn closeness(text: &str) -> Result<f64, String> {
    match length(text)? {
        mm if mm <= MOST_TOLERANCE => Ok(mm),
        _ => Err(format!("more than {MOST_TOLERANCE} mm is no proof")),
    }
}

/// The largest `--tolerance`, mm: beyond it another contour would pass.
const MOST_TOLERANCE: f64 = 2.0;

/// A name and its value.
fn option(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("a name and a value are needed: NAME=VALUE")?;
    Ok((name.trim().to_owned(), value.to_owned()))
}

/// A number, whatever it is good for.
fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| String::from("a number is needed, such as 0.1"))
}

/// Three lengths in mm.
fn point(text: &str) -> Result<[f64; 3], String> {
    lengths(text).ok_or_else(|| String::from("three lengths in mm are needed, such as 0,0,50"))
}

/// Two lengths in mm.
fn place(text: &str) -> Result<[f64; 2], String> {
    lengths(text).ok_or_else(|| String::from("two lengths in mm are needed, such as 10,-5"))
}

/// Two places.
fn pair(text: &str) -> Result<[f64; 4], String> {
    lengths(text).ok_or_else(|| String::from("four lengths in mm are needed, such as 10,-5,12,-6"))
}

/// So many numbers, none beyond what a setting takes, parted by commas.
fn lengths<const N: usize>(text: &str) -> Option<[f64; N]> {
    let part =
        |part: &str| part.trim().parse().ok().filter(|value: &f64| value.abs() <= MOST_SETTING);
    let parts: Option<Vec<f64>> = text.split(',').map(part).collect();
    parts?.try_into().ok()
}
