//! Virtual controls: an NC program in, the motion it makes out.
//!
//! Each dialect is written from the makers' manuals (`docs/controls/` names them), never from our own
//! writer: the two sides of a proof must not share a misunderstanding. A word or a block that a
//! control does not understand is an error, never skipped. A block is read, checked as a whole, and
//! only then executed, so that a bad block changes nothing.
//!
//! ```
//! use toolpost_control::{Action, Dialect, Settings, Setup, Units, read};
//!
//! let setup = Setup { units: Some(Units::Millimeters), ..Setup::default() };
//! let settings = Settings { setup, ..Settings::new(Dialect::LinuxCnc, [false; 3]) };
//! let mut cuts = Vec::new();
//! read(&settings, "slot.ngc", b"G90 G54\nG0 X0 Y0 Z5\nF100\nG1 Z-1\nX10\nM2\n", &mut |event| {
//!     if let Action::Line(to) = event.action {
//!         cuts.push((event.line, to.point.to_array()));
//!     }
//!     Ok(())
//! })
//! .unwrap();
//! assert_eq!(cuts, [(4, [0.0, 0.0, -1.0]), (5, [10.0, 0.0, -1.0])]);
//! // A word that the control does not have is never skipped.
//! assert!(read(&settings, "slot.ngc", b"G90 G13.7\n", &mut |_| Ok(())).is_err());
//! ```
//!
//! Lengths are mm, feeds mm/min, times s, angles degrees. The same text gives the same events.
//!
//! [`Event`]s come out one by one as the program runs. Positions say what the block says: those of rotary axes
//! as [`Orientation::Rotary`]; vectors and tilted planes resolved into the work frame as
//! [`Orientation::Axis`]. It contains no kinematics.

// Words and events are named one by one where they are executed, resolved or passed on: there `clippy::wildcard_enum_match_arm` is denied
// (`iso::execution`, `iso::flow`, `klartext::execution` and its M functions, `sinumerik::execution`, `kernel::compensation`). Elsewhere `_` is
// right: in formulas, values and the statements of robots it is what is refused, or what the next function takes.

mod arm;
mod event;
pub mod iso;
pub mod kernel;
mod klartext;
mod krl;
mod ls;
mod points;
mod rapid;
mod sinumerik;
pub mod tools;
mod urscript;

pub use arm::{ArmAction, ArmMove, ArmPath, ArmPosture, Corner, Rounding, Turning};
pub use event::{Action, ArcTo, Event, FeedPath, Orientation, Position, Risk, Thread, TiltChoice};
use geom::Vec3;
use iso::Facts;
use iso::dialects::{fanuc, grbl, haas, linuxcnc, mach3, marlin, wire};
use kernel::compensation::Rules;
pub use kernel::folders::Folders;
use program::{Diagnostic, Purpose, Rule, WorkOffset};

/// The languages that are understood.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// FANUC 30i family, milling, G-code system of the mill.
    Fanuc,
    /// Haas NGC, milling.
    Haas,
    /// LinuxCNC's RS-274.
    LinuxCnc,
    /// Mach3 Mill.
    Mach3,
    /// GRBL 1.1.
    Grbl,
    /// Marlin 2, on a mill.
    Marlin,
    /// SINUMERIK 840D sl.
    Sinumerik,
    /// SINUMERIK 828D: the same but for some work offsets.
    Sinumerik828d,
    /// HEIDENHAIN Klartext (TNC 640, iTNC 530).
    Klartext,
    /// ISO code of wire-EDM machines: FANUC ROBOCUT.
    FanucWire,
    /// Sodick.
    Sodick,
    /// Agie.
    Agie,
    /// Lists of coordinates for wire EDM.
    Points,
    /// KUKA's robot language (KRC2, KRC4).
    Krl,
    /// The language of Universal Robots.
    UrScript,
    /// Listings of FANUC's robot programs.
    Ls,
    /// ABB's robot language (IRC5, OmniCore).
    Rapid,
    /// ISO code in which a CAM system keeps its toolpaths and which no machine reads: the crate that reads them describes it.
    Source(&'static Facts),
}

impl Dialect {
    /// Whether a program has to state what hangs on the flange of the robot: elsewhere it is data of the operator.
    pub fn asks_for_load(self) -> bool {
        matches!(self, Dialect::UrScript | Dialect::Rapid)
    }

    /// Whether the orientation at the way point of an arc may count for the way from its start to its end.
    pub fn turns_over_way_point(self) -> bool {
        self == Dialect::Ls
    }

    /// Whether the control keeps coordinates in single precision: it rounds them to 24 bits.
    pub fn is_single_precision(self) -> bool {
        self == Dialect::Rapid
    }

    /// Every dialect of a control with the name that its file gives as its `reader`.
    pub const NAMES: [(&'static str, Dialect); 17] = [
        ("fanuc", Dialect::Fanuc),
        ("haas", Dialect::Haas),
        ("linuxcnc", Dialect::LinuxCnc),
        ("mach3", Dialect::Mach3),
        ("grbl", Dialect::Grbl),
        ("marlin", Dialect::Marlin),
        ("sinumerik", Dialect::Sinumerik),
        ("sinumerik-828d", Dialect::Sinumerik828d),
        ("klartext", Dialect::Klartext),
        ("fanuc-wire", Dialect::FanucWire),
        ("sodick", Dialect::Sodick),
        ("agie", Dialect::Agie),
        ("points", Dialect::Points),
        ("krl", Dialect::Krl),
        ("urscript", Dialect::UrScript),
        ("ls", Dialect::Ls),
        ("rapid", Dialect::Rapid),
    ];

    /// The dialect of that name.
    pub fn named(name: &str) -> Option<Dialect> {
        Dialect::NAMES.iter().find(|(n, _)| *n == name).map(|(_, dialect)| *dialect)
    }

    /// Which interpreter reads it.
    fn language(self) -> Language {
        match self {
            Dialect::Fanuc => Language::Iso(&fanuc::FACTS),
            Dialect::Haas => Language::Iso(&haas::FACTS),
            Dialect::LinuxCnc => Language::Iso(&linuxcnc::FACTS),
            Dialect::Mach3 => Language::Iso(&mach3::FACTS),
            Dialect::Grbl => Language::Iso(&grbl::FACTS),
            Dialect::Marlin => Language::Iso(&marlin::FACTS),
            Dialect::FanucWire => Language::Iso(&wire::FANUC),
            Dialect::Sodick => Language::Iso(&wire::SODICK),
            Dialect::Agie => Language::Iso(&wire::AGIE),
            Dialect::Source(facts) => Language::Iso(facts),
            Dialect::Sinumerik => Language::Sinumerik(&sinumerik::S840D),
            Dialect::Sinumerik828d => Language::Sinumerik(&sinumerik::S828D),
            Dialect::Klartext => Language::Klartext,
            Dialect::Points => Language::Points,
            Dialect::Krl => Language::Krl,
            Dialect::UrScript => Language::UrScript,
            Dialect::Ls => Language::Ls,
            Dialect::Rapid => Language::Rapid,
        }
    }

    /// By how much this control leaves the path at corners where it is said no bound (`G64` alone, or nothing at all).
    pub fn corners(self) -> Corners {
        match self.language() {
            Language::Iso(facts) => facts.reset.corners,
            Language::Klartext => Corners::Unbounded,
            Language::Sinumerik(_)
            | Language::Points
            | Language::Krl
            | Language::UrScript
            | Language::Ls
            | Language::Rapid => Corners::Followed,
        }
    }

    /// Whether compensation with a tool of the table is resolved into the path of its centre; with the others such a program is
    /// refused, since how they lead it is not documented well enough.
    pub fn resolves_compensation(self) -> bool {
        Rules::of(self).is_some()
    }

    /// Whether, under compensation, it joins elements that turn by little without a corner, so that the tool cuts into the joint by up to
    /// a thousandth of its radius.
    pub fn cuts_compensated_joints(self) -> bool {
        Rules::of(self).is_some_and(Rules::cuts_joints)
    }

    /// How a program for this control ends.
    pub fn ending(self) -> Ending {
        match self.language() {
            Language::Iso(facts) => facts.syntax.ending,
            Language::Sinumerik(_)
            | Language::Klartext
            | Language::Krl
            | Language::UrScript
            | Language::Ls
            | Language::Rapid => Ending::Code,
            Language::Points => Ending::Text,
        }
    }

    /// Along which way this control counts the feed before a program says it (docs/controls, "F where rotary axes turn").
    pub fn feed_path(self) -> FeedPath {
        match self.language() {
            Language::Iso(facts) => facts.reset.feed_path,
            Language::Sinumerik(_) => FeedPath::Group([0.0; 3]),
            Language::Klartext => FeedPath::AllAxes,
            Language::Points => FeedPath::AsSetUp,
            // The speed of the tip, whatever turns.
            Language::Krl | Language::UrScript | Language::Ls | Language::Rapid => {
                FeedPath::LinearAxes
            }
        }
    }

    /// The work offset that is active before a program names one: on a SINUMERIK `G500`, which is none.
    /// A FANUC and a Marlin may keep that of the last program, and Klartext takes the operator's preset.
    pub fn work_offset_at_reset(self) -> Option<WorkOffset> {
        match self.language() {
            Language::Iso(facts) => facts.reset.work_offset,
            Language::Sinumerik(_) => Some(WorkOffset::NONE),
            Language::Klartext
            | Language::Points
            | Language::Krl
            | Language::UrScript
            | Language::Ls
            | Language::Rapid => None,
        }
    }

    /// Whether the length of a tool counts only where a word takes it (`G43 H`, `D`): a change of the tool does not.
    pub fn takes_length_by_word(self) -> bool {
        match self.language() {
            // Where the operator puts the tools in, no register holds their lengths.
            Language::Iso(facts) => !facts.tools.by_hand && facts.wire.is_none(),
            Language::Sinumerik(_) => true,
            Language::Klartext
            | Language::Points
            | Language::Krl
            | Language::UrScript
            | Language::Ls
            | Language::Rapid => false,
        }
    }
}

/// An interpreter.
enum Language {
    /// With the facts of its dialect.
    Iso(&'static Facts),
    Sinumerik(&'static sinumerik::Facts),
    Klartext,
    Points,
    Krl,
    UrScript,
    Ls,
    Rapid,
}

/// How a program ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// By a code (`M2`, `M30`, `END PGM`): without it the control gives an alarm, or the file is cut off.
    Code,
    /// By a code, or by a second `%` (LinuxCNC's manual, "File Requirements").
    CodeOrPercent,
    /// By a code, which many programs leave out, or with its last line.
    CodeOrText,
    /// With its last line: there is no code.
    Text,
}

/// What a control does at corners of which the program says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corners {
    /// It keeps to the path, but for what its drives lag behind.
    Followed,
    /// It cuts them by an amount that depends on the feed, or on parameters of its builder.
    Unbounded,
    /// Its operator has set by how much it cuts them.
    AsSetUp,
}

/// Modes in which a control starts a program: `true` where it is sure that the mode is the one which is named here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StartModes {
    /// The plane of arcs, cycles and compensation is `G17`.
    pub plane_xy: bool,
    /// Positions are absolute (`G90`).
    pub absolute: bool,
    /// F counts a minute (`G94`).
    pub feed_per_minute: bool,
    /// I, J and K of an arc count from its start (`G91.1`).
    pub centers_from_start: bool,
    /// Lengths are millimetres (`G71` of SINUMERIK; other controls are asked for their units in any case).
    pub metric: bool,
    /// Cycles go back to the initial level (`G98` of FANUC and Haas; LinuxCNC and Mach3 are asked in any case).
    pub returns_up: bool,
    /// The first work offset is active (`G54`; a SINUMERIK starts in `G500`, with which the source's is compared).
    pub first_offset: bool,
}

impl StartModes {
    /// All of them are sure.
    pub const SURE: StartModes = StartModes {
        plane_xy: true,
        absolute: true,
        feed_per_minute: true,
        centers_from_start: true,
        metric: true,
        returns_up: true,
        first_offset: true,
    };

    /// None of them is.
    pub(crate) const NONE: StartModes = StartModes {
        plane_xy: false,
        absolute: false,
        feed_per_minute: false,
        centers_from_start: false,
        metric: false,
        returns_up: false,
        first_offset: false,
    };

    /// Those that are sure here or there.
    pub(crate) fn or(self, other: StartModes) -> StartModes {
        StartModes {
            plane_xy: self.plane_xy || other.plane_xy,
            absolute: self.absolute || other.absolute,
            feed_per_minute: self.feed_per_minute || other.feed_per_minute,
            centers_from_start: self.centers_from_start || other.centers_from_start,
            metric: self.metric || other.metric,
            returns_up: self.returns_up || other.returns_up,
            first_offset: self.first_offset || other.first_offset,
        }
    }
}

/// What a virtual control has to know of its machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The language.
    pub dialect: Dialect,
    /// Which of the rotary axes A, B, C exist; a word for one that does not is an error.
    pub rotary: [bool; 3],
    /// Whether the control counts A, B, C modulo 360°; `None` where that is not known.
    pub modulo: [Option<bool>; 3],
    /// Whether the tool length counts along Z in every plane, where that is known (SINUMERIK SD42940, FANUC parameter
    /// 5001).
    pub length_along_z: Option<bool>,
    /// Modes that this control is set up to start a program in. Of those that are neither set up so nor fixed by the control each
    /// program has to say its own.
    pub start_modes: StartModes,
    /// The edge of the tool that counts behind a change where the program says none, 0 for none, where that is known (SINUMERIK
    /// MD20270).
    pub edge_at_change: Option<u32>,
    /// Whether Z moves where a tool length begins, ends or changes, where that is known (FANUC parameter 5006#6).
    pub length_moves_axis: Option<bool>,
    /// Whether P of a dwell counts milliseconds, or tenths of them, where that is known (FANUC parameters 1013, 1015#7).
    pub dwell_p_milliseconds: Option<bool>,
    /// Whether the sign of a rotary word is the direction of an axis that rolls over, where that is known (FANUC parameter
    /// 1008#1).
    pub rotary_by_sign: Option<bool>,
    /// Which of A, B and C turn a table.
    pub table: [bool; 3],
    /// Where they turn it, in the order from the part to the bed, as the control has measured it; `None` where that or the
    /// work zero is not known, or an axis turns the head as well.
    pub table_axes: Option<Vec<TableAxis>>,
    /// Whether X, Y and Z under `G43.4` count in the frame of the part with the table at 0, however the table is turned
    /// when it comes, where that is known (FANUC).
    pub table_frame_at_zero: Option<bool>,
    /// Whether programs of this machine write work offsets (`G10 L2`).
    pub sets_work_offsets: bool,
    /// Whether taps are held in a chuck that floats along its axis.
    pub floating_holder: bool,
    /// How far above R a peck cycle takes the tool to clear chips, mm, where that is known (Haas setting 52).
    pub retract_above_r: Option<f64>,
    /// Numbers of the M functions that the machine's builder has added (clamps, flaps, chip conveyor),
    /// none of which moves an axis or touches spindle and coolant. Any other M function that is not
    /// the control's own is an error.
    pub auxiliary: Vec<u32>,
    /// The M functions that switch coolant, where they are not the usual ones of the control.
    pub coolant: program::CoolantFunctions,
    /// R parameters that the operator sets at the machine to shift the zero of a rotary axis
    /// (SINUMERIK). They count as 0; any other that no block has set is an error.
    pub operator_parameters: Vec<u32>,
    /// Name of the swivel data set that describes the machine (`_TC` of CYCLE800); empty where it has one only.
    pub swivel_data: String,
    /// The M functions that switch the kinematics, where the machine has two (LinuxCNC).
    pub kinematics: Option<Kinematics>,
    /// Name of the operator's program that changes the tool of an arm; empty where there is none.
    pub tool_change: String,
    /// The number of the user frame, the tool and the position register that programs of an arm set for themselves (FANUC).
    pub own_frame: Option<u32>,
    /// What the names of a robot's digital and of its analog outputs begin with, where outputs have names; their numbers follow.
    pub signals: [String; 2],
    /// The wire, where the machine has one.
    pub wire: Wire,
    /// How far the control may be allowed to leave the path while it smooths it, mm.
    pub path_tolerance: f64,
    /// By how much the control may be allowed to turn the tool out of its orientation while it smooths the way, degrees.
    pub orientation_tolerance: f64,
    /// What the operator has set up.
    pub setup: Setup,
}

/// A rotary axis that carries the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableAxis {
    /// Its place in the order A, B, C.
    pub index: usize,
    /// A point of it, mm, from the zero of the first work offset with the table at 0.
    pub point: Vec3,
    /// The unit vector about which the table turns, right-handed, while its position grows.
    pub axis: Vec3,
    /// Its position where the table is at 0, degrees.
    pub offset: f64,
}

/// The M functions by which a program switches the kinematics of a LinuxCNC (`switchkins`, remapped).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kinematics {
    /// X, Y and Z are the tip of the tool in the work frame, from here on: rotary axes that turn leave it there.
    pub tip: u32,
    /// X, Y and Z are the axes themselves, from here on.
    pub axes: u32,
}

/// What a virtual control has to know of a wire.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wire {
    /// Height over the lower plane at which U and V are counted, mm; `None` where it is not known.
    pub height: Option<f64>,
    /// Number of the M function that threads it.
    pub thread: Option<u32>,
    /// Number of the M function that cuts it.
    pub cut: Option<u32>,
}

/// What a program leans on that stands in the control and not in its text. Nothing of it is known by
/// default; what the program then asks for without having set it is an error.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Setup {
    /// The tool table. Cutter radius compensation with a tool of the table is resolved into the path
    /// of the tool's centre; with any other it stays a state ([`Action::Compensation`]).
    pub tools: Vec<ToolData>,
    /// Folders in which called programs are looked for.
    pub folders: Folders,
    /// What a length or an angle without a decimal point counts.
    pub whole_numbers: WholeNumbers,
    /// What lengths count before the program says it (`G20`, `G21`): what the last program has left.
    /// Not known, a length without it is an error.
    pub units: Option<Units>,
    /// Whether the operator has switched block delete on: blocks that begin with `/` are skipped.
    pub block_delete: bool,
    /// Where to a boring bar leaves the wall of a hole once the spindle stands in position, as a unit
    /// vector along X or Y (FANUC, parameter 5148; Haas, setting 27); `None` where that is not known.
    pub aside: Option<Vec3>,
    /// Where the tool stands in the work frame when the program starts, mm, with all offsets of the
    /// control at 0; `None` where that is not known, and no offset is.
    pub start: Option<Vec3>,
    /// Whether the program is read for its contour in the plane XY alone: Z is 0 while nothing says it.
    pub flat: bool,
    /// What the program is read for.
    pub purpose: Purpose,
    /// Whether words that leave a rotary axis at 0 are taken where the machine has none (ISO code): only the control is known
    /// that the program was written for, and not its machine.
    pub rotary_at_zero: bool,
    /// Points of the part's surface, mm, work frame: straight down onto one of them a probe answers there. Of any
    /// other probing move only the machine knows where it has ended.
    pub surface: Vec<Vec3>,
}

impl Setup {
    /// Where the tool stands in the work frame before the first block, mm; NaN where that is not known.
    pub(crate) fn position_at_start(&self) -> Vec3 {
        self.start.unwrap_or(Vec3::NAN)
    }

    /// Puts the Z that no block has said, or that only the machine knows, on the plane of a flat contour.
    pub fn flatten(&self, position: &mut Vec3) {
        if self.flat && position.z.is_nan() {
            position.z = 0.0;
        }
    }
}

/// A line of the control's tool table.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolData {
    /// Number of the tool and of its registers.
    pub number: u32,
    /// Name, where the control calls tools by it; empty otherwise.
    pub name: String,
    /// Cutting radius, mm.
    pub radius: f64,
    /// Length from the gauge line, mm.
    pub length: f64,
}

/// What lengths count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// mm.
    Millimeters,
    /// Inches.
    Inches,
}

/// What a length or an angle without a decimal point counts (FANUC, parameter 3401#0).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WholeNumbers {
    /// Not known: such a word is an error.
    #[default]
    Unknown,
    /// mm, inches or degrees, as a calculator.
    Units,
    /// Least input increments: 0.001 mm, 0.0001 inch, 0.001°.
    Increments,
}

impl Settings {
    /// A machine with these rotary axes that has nothing of its own.
    pub fn new(dialect: Dialect, rotary: [bool; 3]) -> Settings {
        Settings {
            dialect,
            rotary,
            modulo: [None; 3],
            length_along_z: None,
            edge_at_change: None,
            start_modes: StartModes::default(),
            floating_holder: false,
            retract_above_r: None,
            length_moves_axis: None,
            dwell_p_milliseconds: None,
            rotary_by_sign: None,
            table: [false; 3],
            table_axes: None,
            table_frame_at_zero: None,
            sets_work_offsets: false,
            auxiliary: Vec::new(),
            coolant: program::CoolantFunctions::default(),
            operator_parameters: Vec::new(),
            kinematics: None,
            tool_change: String::new(),
            own_frame: None,
            signals: [const { String::new() }; 2],
            wire: Wire::default(),
            path_tolerance: 0.0,
            orientation_tolerance: 0.0,
            swivel_data: String::new(),
            setup: Setup::default(),
        }
    }
}

/// Where the events of a running program go. An error stops the run.
pub type Sink<'a> = dyn FnMut(Event) -> Result<(), Box<Diagnostic>> + 'a;

/// The blocks of `text` that the operator may switch off, since they begin with `/`: their lines, from 1, and the levels
/// of the switch, `/1` to `/9`, 0 for `/` alone.
pub fn optional_blocks(text: &[u8]) -> impl Iterator<Item = (u32, u8)> {
    let end = if text.contains(&b'\n') { b'\n' } else { b'\r' };
    let lines = (1..).zip(text.split(move |byte| *byte == end));
    lines.filter_map(|(number, line)| {
        let block = line.trim_ascii_start().strip_prefix(b"/")?;
        let level = block.first().filter(|byte| byte.is_ascii_digit());
        Some((number, level.map_or(0, |digit| digit - b'0')))
    })
}

/// Blocks of one word each: every G and M word, command, address and call of the tables of `dialect`, with a value where it
/// needs one and in the order of the tables. A test puts them into programs; what they do there, [`read`] says.
pub fn vocabulary(dialect: Dialect) -> Vec<String> {
    match dialect.language() {
        Language::Iso(facts) => iso::vocabulary(facts),
        Language::Sinumerik(_) => sinumerik::vocabulary(),
        Language::Klartext => klartext::vocabulary(),
        Language::Points => Vec::new(),
        Language::Krl => krl::vocabulary(),
        Language::UrScript => urscript::vocabulary(),
        Language::Ls => ls::vocabulary(),
        Language::Rapid => rapid::vocabulary(),
    }
}

/// How often `%` stands first on a line of `text`.
pub fn percent_signs(text: &[u8]) -> usize {
    let lines = text.split(|byte| matches!(byte, b'\n' | b'\r'));
    lines.filter(|line| line.trim_ascii_start().first() == Some(&b'%')).count()
}

/// Whether the machine file gives coolant M functions for which the control has another use.
///
/// # Errors
/// The first of them, without a place.
pub fn check_coolant(settings: &Settings) -> Result<(), Box<Diagnostic>> {
    for number in settings.coolant.numbers() {
        let block = match settings.dialect.language() {
            Language::Klartext => format!("0 BEGIN PGM C MM\n1 M{number}\n"),
            _ => format!("M{number}\n"),
        };
        let found = read(settings, "", block.as_bytes(), &mut |_| Ok(()));
        // Nothing runs, so that there is no other doubt about coolant.
        if let Err(found) = found
            && found.rule == Rule::Coolant
        {
            return Err(Diagnostic::error(found.rule, found.message).help(found.help).into());
        }
    }
    Ok(())
}

/// Whether a control of this dialect takes a program whose file has that name: a KUKA finds it by the name of its file.
///
/// # Errors
/// It does not, and why.
pub fn check_file_name(dialect: Dialect, file_name: &str) -> Result<(), Box<Diagnostic>> {
    match dialect.language() {
        Language::Krl => krl::check_file_name(file_name),
        Language::Iso(_)
        | Language::Sinumerik(_)
        | Language::Klartext
        | Language::Points
        | Language::UrScript
        | Language::Ls
        | Language::Rapid => Ok(()),
    }
}

/// Runs `text` on the virtual control of `settings` and hands each event to `sink`, in order. The
/// line of an event is the line of the program (from 1); in a program that is called from another
/// file, the line of the call in `text`.
///
/// # Errors
/// The first block that is not understood, or not legal where it stands, with `file_name`, line and
/// column; or what `sink` answered.
pub fn read(
    settings: &Settings,
    file_name: &str,
    text: &[u8],
    sink: &mut Sink,
) -> Result<(), Box<Diagnostic>> {
    kernel::run(settings, file_name, text, sink, |channel| match settings.dialect.language() {
        Language::Iso(facts) => iso::run(facts, settings, text, channel),
        Language::Sinumerik(facts) => sinumerik::run(facts, settings, text, channel),
        Language::Klartext => klartext::run(settings, text, channel),
        Language::Points => points::run(settings, text, channel),
        Language::Krl => krl::run(settings, (file_name, text), channel),
        Language::UrScript => urscript::run(settings, text, channel),
        Language::Ls => ls::run(settings, text, channel),
        Language::Rapid => rapid::run(settings, text, channel),
    })
}
