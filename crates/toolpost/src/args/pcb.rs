//! What can be typed after `toolpost pcb`.

use super::{Choice, Closeness, choice, length, lengths, option};
use crate::settings::Origin;
use ::pcb::board::{Face, Layer};
use ::pcb::excellon::Unit;
use ::pcb::isolation::{Direction, Narrow};
use ::pcb::plan::{self, Isolate, Part, Settings, Turn};
use clap::Args;
use drawing::Format;
use geom::{INCH, Vec2};
use program::{Diagnostic, LEAST_SETTING, MOST_SETTING};
use std::path::PathBuf;

/// Arguments of `pcb`.
#[derive(Debug, Args)]
pub struct Pcb {
    /// The board: a folder of Gerber and Excellon files, or such files; a board of KiCad (.kicad_pcb); or a
    /// board of nodes, tracks and pads (.toml, .json).
    #[arg(value_name = "BOARD", required_unless_present_any = ["front", "back", "drill"])]
    pub board: Vec<PathBuf>,
    #[command(flatten)]
    pub files: Files,
    /// Name in the library, or a file ending in .toml.
    #[arg(long, short, value_name = "NAME|FILE")]
    pub machine: String,
    /// Folder for the programs, their pictures and the report; made where it is missing.
    #[arg(long, short, value_name = "FOLDER")]
    pub output: PathBuf,
    /// Options of this command in a file: `toolpost.toml` (`passes = 2`; what is typed counts more), or a millproject of pcb2gcode
    /// [default: toolpost.toml beside the board, where there is one].
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
    /// What was found in the settings file.
    #[arg(skip)]
    pub found: Vec<Diagnostic>,
    /// Where the options of the settings file stand.
    #[arg(skip)]
    pub origins: Vec<Origin>,
    /// The options as words of a command line, those of the settings file among them.
    #[arg(skip)]
    pub options: Vec<String>,
    /// Another value for one of the options of the machine file; may be given several times.
    #[arg(long, value_name = "NAME=VALUE", value_parser = option)]
    pub option: Vec<(String, String)>,
    /// What to make [default: all that the board has and that tools are given for].
    #[arg(long, value_name = "WHAT,...", value_delimiter = ',', value_parser = choice(&PARTS))]
    pub only: Vec<Part>,
    /// Take every warning about the board as an error, and make all programs or none.
    #[arg(long)]
    pub strict: bool,
    /// How pictures are saved.
    #[arg(long, value_name = "FORMAT", default_value = "svg", value_parser = choice(&PICTURES))]
    pub picture: std::option::Option<Format>,
    #[command(flatten)]
    pub closeness: Closeness,
    #[command(flatten)]
    pub isolation: Isolation,
    #[command(flatten)]
    pub clearing: Clearing,
    #[command(flatten)]
    pub drilling: Drilling,
    #[command(flatten)]
    pub outline: Outline,
    #[command(flatten)]
    pub placing: Placing,
    #[command(flatten)]
    pub running: Running,
}

impl Pcb {
    /// As the board is planned.
    pub fn plan(&self) -> Settings {
        let Pcb { isolation, clearing, drilling, outline, placing, running, .. } = self;
        let (tool, wider) = match isolation.tool.split_last() {
            Some((tool, wider)) => (Some(*tool), wider.to_vec()),
            None => (None, Vec::new()),
        };
        Settings {
            only: self.only.clone(),
            unit: self.files.unit,
            isolation: plan::Isolation {
                wider,
                tool,
                vee: isolation.vee,
                tip: isolation.tip,
                depth: isolation.depth,
                step: isolation.step,
                passes: isolation.passes,
                isolation_width: isolation.isolation_width,
                overlap: isolation.overlap,
                direction: isolation.direction,
                narrow: isolation.narrow,
                isolate: isolation.isolate,
                invert: isolation.invert,
            },
            clearing: plan::Clearing {
                clear: clearing.clear.clone(),
                margin: clearing.margin,
                mask_tool: clearing.mask_tool,
                legend_tool: clearing.legend_tool,
                engrave: clearing.engrave,
            },
            drilling: plan::Drilling {
                drills: drilling.drills.clone(),
                drill_tolerance: drilling.drill_tolerance,
                hole_mill: drilling.hole_mill,
                mill_holes_over: drilling.mill_holes_over,
                peck: drilling.peck,
                from: drilling.from,
            },
            outline: plan::Outline {
                outline_tool: outline.outline_tool,
                outline_step: outline.outline_step,
                tabs: outline.tabs,
                tab_at: outline.tab_at.iter().copied().map(Vec2::from_array).collect(),
                tab_width: outline.tab_width,
                tab_height: outline.tab_height,
                close_gaps: outline.close_gaps,
                board_margin: outline.board_margin,
                rectangular: outline.rectangular,
            },
            placing: plan::Placing {
                thickness: placing.thickness,
                through: placing.through,
                rotate: placing.rotate,
                corner: placing.corner.map(Vec2::from_array),
                as_drawn: placing.as_drawn,
                turn: placing.turn,
                alignment: placing.alignment,
                panel: placing.panel,
                spacing: placing.spacing,
            },
            running: plan::Running {
                feed: running.feed,
                plunge: running.plunge,
                drill_feed: running.drill_feed,
                outline_feed: running.outline_feed,
                speed: running.speed,
                spin_up: running.spin_up,
                text: [&running.text_before, &running.text_after]
                    .map(|text| text.replace('@', "\n")),
                travel: running.travel,
                approach: running.approach,
                probe: running.probe,
                on_control: running.on_control,
                split_tools: running.split_tools,
            },
        }
    }
}

/// Values of `--only`.
const PARTS: [Choice<Part>; 8] = [
    ("front", "The copper of the front", Part::Front),
    ("back", "The copper of the back, from the back", Part::Back),
    ("drill", "The holes", Part::Drill),
    ("outline", "The edge of the board and its cut-outs", Part::Outline),
    ("front-mask", "The solder mask of the front", Part::FrontMask),
    ("back-mask", "The solder mask of the back, from the back", Part::BackMask),
    ("front-legend", "The legend of the front", Part::FrontLegend),
    ("back-legend", "The legend of the back, from the back", Part::BackLegend),
];

/// Values of `--picture`.
const PICTURES: [Choice<Option<Format>>; 3] = [
    ("svg", "As lines", Some(Format::Svg)),
    ("png", "As pixels", Some(Format::Png)),
    ("none", "Not at all", None),
];

/// Values of `--direction`.
const DIRECTIONS: [Choice<Direction>; 2] = [
    ("climb", "The edge of the tool leaves the copper that stays: clean edges", Direction::Climb),
    (
        "conventional",
        "The edge of the tool enters at the copper that stays",
        Direction::Conventional,
    ),
];

/// Values of `--narrow`.
const NARROW: [Choice<Narrow>; 3] = [
    (
        "bite",
        "A cut down the middle where it takes no more than 0.03 mm (in the board 0.002 mm more at most), and a tenth of the copper there, from either side; else nothing",
        Narrow::Bite,
    ),
    ("leave-out", "Nothing: the nets stay joined there", Narrow::LeaveOut),
    ("middle", "A cut down the middle, which takes some copper from both", Narrow::Middle),
];

/// Values of `--isolate`.
const ISOLATE: [Choice<Isolate>; 3] = [
    ("contours", "Around copper, as near as the tool allows", Isolate::Contours),
    (
        "middle",
        "In the middle between nets: they keep all copper that is nearer to them than to others",
        Isolate::Middle,
    ),
    (
        "lines",
        "Along the middle of the lines that copper is drawn with: a drawing, no isolation",
        Isolate::Lines,
    ),
];

/// Values of `--unit`.
const UNITS: [Choice<Unit>; 2] =
    [("mm", "Millimetres", Unit::Metric), ("inch", "Inches", Unit::Inch)];

/// Values of `--from`.
const FACES: [Choice<Face>; 2] =
    [("front", "The front", Face::Front), ("back", "The back", Face::Back)];

/// Values of `--turn`.
const TURNS: [Choice<Turn>; 2] = [
    ("y", "Along Y: left and right change places", Turn::Y),
    ("x", "Along X: up and down change places", Turn::X),
];

/// Files of which nobody has to guess what they hold.
#[derive(Debug, Args)]
#[command(next_help_heading = "Gerber and drill files")]
pub struct Files {
    /// The Gerber file of the copper of the front, whatever its name; others are still looked for in BOARD.
    #[arg(long, value_name = "FILE")]
    pub front: Option<PathBuf>,
    /// The Gerber file of the copper of the back.
    #[arg(long, value_name = "FILE")]
    pub back: Option<PathBuf>,
    /// The Gerber file of the edge.
    #[arg(long, value_name = "FILE")]
    pub outline: Option<PathBuf>,
    /// A drill file; may be given several times.
    #[arg(long, value_name = "FILE")]
    pub drill: Vec<PathBuf>,
    /// The unit of drill files that do not say it.
    #[arg(long, value_name = "UNIT", value_parser = choice(&UNITS))]
    pub unit: Option<Unit>,
}

impl Files {
    /// Each file, and what it holds.
    pub fn named(&self) -> Vec<(PathBuf, Layer)> {
        let one = [
            (&self.front, Layer::Copper(Face::Front)),
            (&self.back, Layer::Copper(Face::Back)),
            (&self.outline, Layer::Outline),
        ];
        let one = one.into_iter().filter_map(|(file, layer)| Some((file.clone()?, layer)));
        one.chain(self.drill.iter().map(|file| (file.clone(), Layer::Holes(None)))).collect()
    }
}

/// How copper is isolated.
#[derive(Debug, Args)]
#[command(next_help_heading = "Copper")]
pub struct Isolation {
    /// Width of the end mill that cuts around copper, also as `8mil` or `0.01in`; of several the widest first: each cuts as far
    /// as it goes in, and the next one what is left.
    #[arg(long, value_name = "MM,...", value_parser = size, value_delimiter = ',', allow_negative_numbers = true)]
    pub tool: Vec<f64>,
    /// Angle between the edges of the V-bit that cuts around copper, in place of --tool; its width follows from --tip and --depth.
    #[arg(long, value_name = "DEGREES", value_parser = angle)]
    pub vee: Option<f64>,
    /// Width of the tip of the V-bit.
    #[arg(long, value_name = "MM", value_parser = not_negative, default_value = "0.1")]
    pub tip: f64,
    /// How deep below the surface.
    #[arg(long, value_name = "MM", value_parser = size, default_value = "0.1")]
    pub depth: f64,
    /// How deep at once [default: all of --depth].
    #[arg(long, value_name = "MM", value_parser = step)]
    pub step: Option<f64>,
    /// How often around, each time farther out.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=100), default_value = "1")]
    pub passes: u32,
    /// How wide all passes together cut around copper, in place of --passes.
    #[arg(long, value_name = "MM", value_parser = size)]
    pub isolation_width: Option<f64>,
    /// Which part of the width passes overlap.
    #[arg(long, value_name = "PART", value_parser = part, default_value = "0.25")]
    pub overlap: f64,
    /// Which way around.
    #[arg(long, value_name = "HOW", default_value = "climb", value_parser = choice(&DIRECTIONS))]
    pub direction: Direction,
    /// What is done between nets where the tool is wider than the gap.
    #[arg(long, value_name = "HOW", default_value = "bite", value_parser = choice(&NARROW))]
    pub narrow: Narrow,
    /// Where the cuts are.
    #[arg(long, value_name = "HOW", default_value = "contours", value_parser = choice(&ISOLATE))]
    pub isolate: Isolate,
    /// Cut away what is drawn: all else of the board is copper that stays.
    #[arg(long)]
    pub invert: bool,
}

/// What else is cut of copper, mask and legend.
#[derive(Debug, Args)]
#[command(next_help_heading = "Areas")]
pub struct Clearing {
    /// Widths of end mills that take away all copper that is part of no net, the widest first.
    #[arg(long, value_name = "MM,...", value_parser = size, value_delimiter = ',')]
    pub clear: Vec<f64>,
    /// How far they stay from nets [default: not at all].
    #[arg(long, value_name = "MM", value_parser = not_negative, default_value = "0")]
    pub margin: f64,
    /// Width of the end mill that opens the solder mask over pads.
    #[arg(long, value_name = "MM", value_parser = size)]
    pub mask_tool: Option<f64>,
    /// Width of the tool that engraves the legend.
    #[arg(long, value_name = "MM", value_parser = size)]
    pub legend_tool: Option<f64>,
    /// How deep masks and legends are cut.
    #[arg(long, value_name = "MM", value_parser = size, default_value = "0.05")]
    pub engrave: f64,
}

/// How holes are made.
#[derive(Debug, Args)]
#[command(next_help_heading = "Holes")]
pub struct Drilling {
    /// The drills that there are [default: one for each width of holes].
    #[arg(long, value_name = "MM,...", value_parser = size, value_delimiter = ',')]
    pub drills: Vec<f64>,
    /// By how much a drill may be wider or narrower than its hole; without --drills at most 0.015 mm count.
    #[arg(long, value_name = "MM", value_parser = not_negative, default_value = "0.05")]
    pub drill_tolerance: f64,
    /// Width of the end mill for holes without a drill, for slots and routes.
    #[arg(long, value_name = "MM", value_parser = size)]
    pub hole_mill: Option<f64>,
    /// Holes so wide and wider are milled by --hole-mill though there is a drill.
    #[arg(long, value_name = "MM", value_parser = not_negative)]
    pub mill_holes_over: Option<f64>,
    /// How deep a drill goes at once [default: through].
    #[arg(long, value_name = "MM", value_parser = step)]
    pub peck: Option<f64>,
    /// From which side holes and edges are cut.
    #[arg(long, value_name = "SIDE", default_value = "front", value_parser = choice(&FACES))]
    pub from: Face,
}

/// How the board is cut out.
#[derive(Debug, Args)]
#[command(next_help_heading = "Edge")]
pub struct Outline {
    /// Width of the end mill that cuts the board out.
    #[arg(long, value_name = "MM", value_parser = size, default_value = "2")]
    pub outline_tool: f64,
    /// How deep at once.
    #[arg(long, value_name = "MM", value_parser = step, default_value = "0.5")]
    pub outline_step: f64,
    /// How many tabs hold the board.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(0..=100), default_value = "4")]
    pub tabs: u32,
    /// Where a tab is put by hand, as the program has it; may be given several times: each on the nearest contour, which has no
    /// others then.
    #[arg(long, value_name = "X,Y", value_parser = at, allow_hyphen_values = true)]
    pub tab_at: Vec<[f64; 2]>,
    /// How wide a tab is.
    #[arg(long, value_name = "MM", value_parser = size, default_value = "2")]
    pub tab_width: f64,
    /// How high a tab is.
    #[arg(long, value_name = "MM", value_parser = size, default_value = "0.6")]
    pub tab_height: f64,
    /// How wide a gap between lines of the edge may be that is closed; each is reported.
    #[arg(long, value_name = "MM", value_parser = not_negative, default_value = "0.3")]
    pub close_gaps: f64,
    /// Where no file has the edge: the board is a rectangle that reaches so far beyond copper and holes.
    #[arg(long, value_name = "MM", value_parser = not_negative)]
    pub board_margin: Option<f64>,
    /// The board is a rectangle around its edge, --board-margin larger, whatever form the edge has; its cut-outs stay.
    #[arg(long)]
    pub rectangular: bool,
}

/// Where the board lies on the machine.
#[derive(Debug, Args)]
#[command(next_help_heading = "Board")]
pub struct Placing {
    /// How thick the board is.
    #[arg(long, value_name = "MM", value_parser = size, default_value = "1.6")]
    pub thickness: f64,
    /// How far drills and mills go through it.
    #[arg(long, value_name = "MM", value_parser = not_negative, default_value = "0.2")]
    pub through: f64,
    /// By how much the board is turned counter-clockwise before that.
    #[arg(long, value_name = "DEGREES", value_parser = turned, default_value = "0", allow_negative_numbers = true)]
    pub rotate: f64,
    /// Where the lower left corner of the board is put [default: 0,0].
    #[arg(long, value_name = "X,Y", value_parser = at, allow_hyphen_values = true)]
    pub corner: Option<[f64; 2]>,
    /// Leave the board where its files have it.
    #[arg(long)]
    pub as_drawn: bool,
    /// How the board is turned over for its back: about a line along Y, or along X, through its middle.
    #[arg(long, value_name = "LINE", default_value = "y", value_parser = choice(&TURNS))]
    pub turn: Turn,
    /// Diameter of holes next to the board, drilled with the others, by which it is aligned when it is turned.
    #[arg(long, value_name = "MM", value_parser = size)]
    pub alignment: Option<f64>,
    /// Make a panel of so many boards.
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = grid)]
    pub panel: Option<[u32; 2]>,
    /// How far the boards of a panel are apart.
    #[arg(long, value_name = "MM", value_parser = not_negative, default_value = "4")]
    pub spacing: f64,
}

/// How the machine runs.
#[derive(Debug, Args)]
#[command(next_help_heading = "Feeds and heights")]
pub struct Running {
    /// Feed along copper, mm/min.
    #[arg(long, value_name = "MM/MIN", value_parser = size, default_value = "200")]
    pub feed: f64,
    /// Feed straight down into copper, mm/min.
    #[arg(long, value_name = "MM/MIN", value_parser = size, default_value = "60")]
    pub plunge: f64,
    /// Feed of drills, mm/min.
    #[arg(long, value_name = "MM/MIN", value_parser = size, default_value = "100")]
    pub drill_feed: f64,
    /// Feed of the end mill that cuts the board out, mm/min.
    #[arg(long, value_name = "MM/MIN", value_parser = size, default_value = "150")]
    pub outline_feed: f64,
    /// Speed of the spindle, 1/min [default: 10000, or what the machine has].
    #[arg(long, value_name = "1/MIN", value_parser = length)]
    pub speed: Option<f64>,
    /// How long each start of the spindle is waited for, s [default: as the machine file says].
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub spin_up: Option<f64>,
    /// Blocks of the control that each program begins with, behind the machine's own; @ begins a new line.
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
    pub text_before: String,
    /// Blocks of the control that each program ends with, before the machine's own.
    #[arg(long, value_name = "TEXT", default_value = "", hide_default_value = true)]
    pub text_after: String,
    /// Height of rapid moves over the board.
    #[arg(long, value_name = "MM", value_parser = size, default_value = "2")]
    pub travel: f64,
    /// Height from which tools feed.
    #[arg(long, value_name = "MM", value_parser = size, default_value = "0.5")]
    pub approach: f64,
    /// Write a program too that measures the height of the board at so many places (probe.nc).
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = grid)]
    pub probe: Option<[u32; 2]>,
    /// The programs that cut copper measure these heights themselves, with the tool that cuts, and follow them: the
    /// control does it, which needs one that keeps numbers (LinuxCNC). Z 0 is set on the copper, from which holes and
    /// edge count. Replaces probe.nc and --heights.
    #[arg(long)]
    pub on_control: bool,
    /// Write a program for each tool (drill-1-0.8mm.nc), so that none changes tools: Z 0 is set anew with each.
    #[arg(long)]
    pub split_tools: bool,
    /// Measured heights that the programs follow: what a probing program has logged, or X, Y and Z in
    /// columns.
    #[arg(long, value_name = "FILE")]
    pub heights: Option<PathBuf>,
}

/// Units that may stand behind a length, in mm.
const BEHIND: [(&str, f64); 8] = [
    ("mm", 1.0),
    ("um", 1e-3),
    ("µm", 1e-3),
    ("inch", INCH),
    ("in", INCH),
    ("\"", INCH),
    ("mil", INCH / 1000.0),
    ("thou", INCH / 1000.0),
];

/// A length, mm, or as its unit says.
fn mm(text: &str) -> Option<f64> {
    let text = text.trim();
    let unit = BEHIND.iter().find_map(|(unit, mm)| Some((text.strip_suffix(unit)?, *mm)));
    let (number, unit) = unit.unwrap_or((text, 1.0));
    let mm = number.trim_end().parse::<f64>().ok()? * unit;
    // 8 mil are 0.2032 mm, and not a rounding of the product more.
    let mm = (mm * 1e9).round() / 1e9;
    (mm.abs() <= MOST_SETTING).then_some(mm)
}

/// A length or a feed, greater than 0.
fn size(text: &str) -> Result<f64, String> {
    match mm(text) {
        Some(mm) if mm >= LEAST_SETTING => Ok(mm),
        _ => Err(format!(
            "a number greater than 0 is needed, {LEAST_SETTING} to {MOST_SETTING}, such as 0.2, 0.2mm or 8mil"
        )),
    }
}

/// Two lengths.
fn at(text: &str) -> Result<[f64; 2], String> {
    let parsed = text.split_once(',').and_then(|(x, y)| Some([mm(x)?, mm(y)?]));
    parsed.ok_or_else(|| String::from("two lengths in mm are needed, such as 10,-5"))
}

/// A length in mm that may be 0.
fn not_negative(text: &str) -> Result<f64, String> {
    match mm(text) {
        Some(mm) if mm >= 0.0 => Ok(mm),
        _ => Err(String::from("a length in mm is needed, from 0 to 100000, such as 0.1")),
    }
}

/// Degrees, either way around.
fn turned(text: &str) -> Result<f64, String> {
    match lengths(text) {
        Some([degrees]) if (-360.0..=360.0).contains(&degrees) => Ok(degrees),
        _ => Err(String::from("an angle in degrees is needed, -360 to 360, such as 90")),
    }
}

/// Seconds.
fn seconds(text: &str) -> Result<f64, String> {
    match lengths(text) {
        Some([seconds]) if (0.0..=600.0).contains(&seconds) => Ok(seconds),
        _ => Err(String::from("a number of seconds is needed, 0 to 600, such as 3")),
    }
}

/// How deep at once, mm: not less than a machine can.
fn step(text: &str) -> Result<f64, String> {
    match mm(text) {
        Some(mm) if mm >= 0.001 => Ok(mm),
        _ => {
            Err(String::from("a length in mm is needed, 0.001 or more, up to 100000, such as 0.1"))
        }
    }
}

/// An angle between the edges of a V-bit, degrees.
fn angle(text: &str) -> Result<f64, String> {
    match lengths(text) {
        Some([degrees]) if (0.1..=179.9).contains(&degrees) => Ok(degrees),
        _ => Err(String::from(
            "an angle above 0 and below 180 degrees is needed, 0.1 to 179.9, such as 30",
        )),
    }
}

/// A part of a whole.
fn part(text: &str) -> Result<f64, String> {
    match lengths(text) {
        Some([part]) if (0.0..0.95).contains(&part) => Ok(part),
        _ => Err(String::from("a part from 0 to below 0.95 is needed, such as 0.25")),
    }
}

/// Columns and rows.
fn grid(text: &str) -> Result<[u32; 2], String> {
    let parts = text.split_once(['x', 'X', '×']);
    let parsed = parts.and_then(|(a, b)| Some([a.trim().parse().ok()?, b.trim().parse().ok()?]));
    match parsed {
        Some(grid) if grid.iter().all(|count| (1..=1000).contains(count)) => Ok(grid),
        _ => Err(String::from("columns and rows are needed, such as 2x3, up to 1000 each")),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Command, CommandLine};
    use ::pcb::plan::Settings;
    use clap::Parser;

    #[test]
    fn what_nobody_types_is_the_default_of_the_crates() {
        let parsed = |words: &str| CommandLine::try_parse_from(words.split(' ')).unwrap().command;
        match parsed("toolpost pcb board.toml -m grbl-3018 -o out") {
            Command::Pcb(args) => assert_eq!(args.plan(), Settings::default()),
            other => panic!("{other:?}"),
        }
        match parsed("toolpost wire part.nc -m bp-95d -o part.pts") {
            Command::Wire(args) => {
                let (typed, default) = (args.settings().unwrap(), app::wire::Settings::default());
                assert_eq!(typed.cutting, default.cutting);
                assert_eq!((typed.close, typed.sync), (default.close, default.sync));
            }
            other => panic!("{other:?}"),
        }
    }
}
