//! What a machine is, after its files are merged.

use crate::option::{OptionKey, wrong_option};
use geom::{Euler, Frame, Vec2, Vec3};
use program::{Axes, CycleKind, Diagnostic, Digest, MachineMove, Rule};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A machine with its control.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// Name of the file without its ending: what `--machine` takes.
    pub name: String,
    /// The file it was loaded from, for findings.
    pub file: String,
    /// All files that it was loaded from.
    pub loaded_from: LoadedFrom,
    /// What a person calls it.
    pub title: String,
    /// The control it extends, itself or by another machine.
    pub control: String,
    /// The dialect whose virtual control proves its programs (`sinumerik`, `fanuc`, `linuxcnc`,
    /// `grbl`, `klartext`); empty for an arm of which the kinematics alone are known.
    pub reader: String,
    /// Where that is said.
    pub reader_place: FileLocation,
    /// Ending of its programs, without the dot.
    pub extension: String,
    /// What the control can do.
    pub capabilities: Capabilities,
    /// How text is put together.
    pub format: Format,
    /// Parameters of the control.
    pub settings: ControlSettings,
    /// The words of the control by name (`X`, `F`, `N` ...).
    pub words: BTreeMap<String, Word>,
    /// The blocks (templates) of the control by name (`linear`, `tool_change` ...).
    pub blocks: BTreeMap<String, Block>,
    /// X, Y and Z.
    pub linear: [LinearAxis; 3],
    /// Rotary axes from the machine's frame outwards: those of the head towards the tool, those of the
    /// table towards the part. At most two.
    pub rotary: Vec<RotaryAxis>,
    /// Work zero (`G54`) in machine coordinates, mm, where it is known. Limits are then checked in
    /// machine coordinates; otherwise only the stroke is compared with the travel.
    pub work_zero: Option<Vec3>,
    /// The least Z of the gauge line in machine coordinates, mm, at which every tool is clear of every part, where
    /// it is known. Retracts in machine coordinates go there.
    pub safe_height: Option<f64>,
    /// How a tool orientation is written.
    pub orientation: OrientationSettings,
    /// The wire, where the machine is one for wire EDM; a mill has none.
    pub wire: Option<Wire>,
    /// The arm, where the machine is a robot.
    pub arm: Option<arm::Arm>,
    /// Where tool and part of the arm are; there where the machine is a robot with a control.
    pub cell: Option<Cell>,
    /// What the spindle can do.
    pub spindle: SpindleRange,
    /// Fastest feed, mm/min; infinite where none is given.
    pub feed_max: f64,
    /// What the tool magazine takes.
    pub tools: ToolRange,
    /// The M functions that switch coolant, where they are not the usual ones of the control.
    pub coolant: program::CoolantFunctions,
    /// M functions of the machine's builder that its programs use; they switch something and move no
    /// axis that the program drives (clamps, doors, air).
    pub auxiliary: Vec<u32>,
    /// R parameters with which the operator shifts the zero of a rotary axis (SINUMERIK).
    pub operator_parameters: Vec<u32>,
    /// The order in which the axes approach the first position after a tool change or a new
    /// orientation: each entry names the axes that move together (`XY`, then `Z`).
    pub approach: Vec<String>,
    /// Values that the templates of this machine read, by name.
    pub options: BTreeMap<String, OptionValue>,
    /// What is drawn of it; where nothing is given, [`crate::linkage::Linkage`] has boxes of its own.
    pub bodies: Vec<Body>,
}

/// A box that stands for a part of a machine in a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// What it is called.
    pub name: String,
    /// What carries it: an axis, `bed`, `spindle` or `table`.
    pub on: String,
    /// The corner with the smallest X, Y and Z while all axes stand at zero, mm, in the world of [`crate::linkage`].
    pub low: Vec3,
    /// The one with the largest.
    pub high: Vec3,
}

/// Where the tool and the part of an arm are, and what its outputs switch.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Where the spindle holds its tools, in the frame of the flange; its Z points out of the tool.
    pub spindle: Frame,
    /// Length of a tool from there to its tip, mm, where the source states none.
    pub tool_length: Option<f64>,
    /// The frame of the source in the world of the controller.
    pub part: Frame,
    /// The joints at which programs begin and end, degrees, as the controller shows them.
    pub home: [f64; 6],
    /// Speed of moves of joints, percent of the fastest.
    pub joint_speed: f64,
    /// Speed of the tip where it goes straight and does not cut, mm/min.
    pub rapid: f64,
    /// Feed at which the tool leaves a cut and comes back into it, where no turn about the tool and no posture carries the whole cut,
    /// mm/min; `None` where no cut may be left.
    pub reentry_feed: Option<f64>,
    /// Name of the operator's program that changes the tool; empty where there is none.
    pub tool_change: String,
    /// Number of the output that switches the spindle on.
    pub spindle_output: Option<u32>,
    /// Number of the analog output that sets its speed, and the speed at its full value, 1/min.
    pub spindle_analog: Option<(u32, f64)>,
    /// Number of the output that switches the coolant on.
    pub coolant_output: Option<u32>,
    /// The number of the user frame, the tool and the position register that its programs set for themselves.
    pub own_frame: Option<u32>,
    /// The number under which the operator has entered what hangs on the flange.
    pub load_number: Option<u32>,
    /// What hangs on the flange with a tool in the spindle, where it is stated.
    pub load: Option<Load>,
    /// Of each joint the range that cables and hoses leave to it, degrees, as the controller shows it, where one is stated; the limits of
    /// the arm are no wider.
    pub cables: [Option<[f64; 2]>; 6],
    /// The rail on which the arm stands, where there is one.
    pub rail: Option<Rail>,
}

/// A straight rail that carries the foot of an arm: its position is the outer axis 1 of the controller (`E1`, `eax_a`), mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rail {
    /// Unit vector in which the arm moves while the position grows, in the world of the controller.
    pub direction: Vec3,
    /// The world of the arm itself, which [`arm::Arm::world_height`] places, in that of the controller, with the rail at 0.
    pub origin: Frame,
    /// Lowest position, mm.
    pub min: f64,
    /// Highest position, mm.
    pub max: f64,
    /// Fastest, mm/min.
    pub speed: f64,
    /// Where it stands when programs begin and end, mm.
    pub home: f64,
}

impl Rail {
    /// Whether a position, mm, is within its travel.
    pub fn holds(&self, position: f64) -> bool {
        // Rounding of a position that stands at its end.
        (self.min - 1e-6..=self.max + 1e-6).contains(&position)
    }
}

/// What hangs on the flange of an arm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// kg.
    pub mass: f64,
    /// Its centre of gravity in the frame of the flange, mm.
    pub center: Vec3,
}

impl Cell {
    /// Which key of the cell bounds a joint, number from 1, more than the arm does, and to what: to say behind what is beyond it.
    pub fn cable(&self, joint: usize) -> Option<String> {
        let [from, to] = (*self.cables.get(joint.checked_sub(1)?)?)?;
        Some(format!(
            "`cable_joint_{joint}` below [cell] keeps joint {joint} within {from} to {to} degrees"
        ))
    }

    /// The frame of a tool's tip in that of the flange. `length` is what the source states, mm; `None` where neither it nor the
    /// file does.
    pub fn tool(&self, length: Option<f64>) -> Option<Frame> {
        let length = length.or(self.tool_length)?;
        Some(self.spindle * Frame::from_translation(Vec3::new(0.0, 0.0, length)))
    }

    /// The world of the arm itself in that of the controller, with the rail at this position, mm: without a rail they are one.
    pub fn foot(&self, rail: f64) -> Frame {
        match &self.rail {
            Some(own) => Frame::from_translation(own.direction * rail) * own.origin,
            None => Frame::IDENTITY,
        }
    }

    /// The frame of the source in the world of the arm itself, with the rail at this position, mm.
    pub fn part_from(&self, rail: f64) -> Frame {
        self.foot(rail).inverse() * self.part
    }

    /// Where the rail stands when programs begin and end, mm; 0 without one.
    pub fn rail_home(&self) -> f64 {
        self.rail.map_or(0.0, |rail| rail.home)
    }

    /// The frame of six numbers: X, Y, Z in mm, and A, B, C in degrees, which turn about Z, the new Y and the new X.
    pub fn frame([x, y, z, a, b, c]: [f64; 6]) -> Frame {
        let turns = [c, b, a].map(f64::to_radians);
        Frame::from_mat3_translation(Euler::FixedXyz.matrix(turns), Vec3::new(x, y, z))
    }
}

/// What a machine was loaded from: its file, and those that it extends.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadedFrom {
    /// The files of the user's own, the nearest first; those of the library are not among them.
    pub files: Vec<PathBuf>,
    /// The keys that they and the nearest file state, which may be one of the library.
    pub keys: Vec<StatedKey>,
    /// SHA-256 of the texts of all files and of the options that were set since, in hexadecimal digits.
    pub digest: String,
}

/// A key that a file states.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StatedKey {
    /// The table that it stands in; empty for the top of the file.
    pub table: String,
    /// The key: of an entry of a table the first part of its name alone.
    pub key: String,
    /// Where it stands.
    pub place: FileLocation,
}

/// Parameters of the control as the machine has them; `None` is not known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ControlSettings {
    /// Whether taps are held in a chuck that floats along its axis, so that feed and spindle need not be coupled.
    pub floating_holder: bool,
    /// How far above R a peck cycle takes the tool to clear chips, mm, where that is known (Haas setting 52).
    pub retract_above_r: Option<f64>,
    /// The feed of rapids near the part that are written as straight cuts, mm/min.
    pub high_feed: Option<f64>,
    /// Modes that the control is set up to start a program in.
    pub start_modes: Vec<StartMode>,
    /// The edge of the tool that counts behind a change where the program says none, 0 for none (SINUMERIK MD20270).
    pub edge_at_change: Option<u32>,
    /// Whether the tool length counts along Z in every plane (SINUMERIK SD42940, FANUC parameter 5001).
    pub length_along_z: Option<bool>,
    /// Whether Z moves where a tool length begins, ends or changes (FANUC parameter 5006#6).
    pub length_moves_axis: Option<bool>,
    /// Whether P of a dwell counts milliseconds, or tenths of them (FANUC parameters 1013, 1015#7), or seconds (Mach3 General Config).
    pub dwell_p_milliseconds: Option<bool>,
    /// Whether the sign of a rotary word is the direction of an axis that rolls over (FANUC parameter 1008#1).
    pub rotary_by_sign: Option<bool>,
    /// Whether X, Y and Z under `G43.4` count in the frame of the part with the table at 0, however the table is turned when
    /// it comes (FANUC).
    pub table_frame_at_zero: Option<bool>,
    /// What the feed counts where rotary axes turn in a cut and the control does not keep the tool tip.
    pub rotary_feed: Option<RotaryFeed>,
    /// Whether programs of this machine write work offsets: its fixtures are set so, and not by the operator.
    pub sets_work_offsets: bool,
    /// The M functions that switch the kinematics of the control (LinuxCNC).
    pub kinematics: Option<Kinematics>,
    /// How the axes go in a rapid (FANUC parameter 1401#1, SINUMERIK MD20730).
    pub rapid_path: Option<RapidPath>,
    /// What the tool table keeps as the radius of a tool.
    pub tool_radius: Option<ToolRadius>,
    /// Letter of the rotary axis to which `_DIR` of `CYCLE800` refers (SINUMERIK, `$TC_CARR37`).
    pub swivel_direction: Option<char>,
    /// Whether `G53.1` compares the turns of the second rotary axis first (FANUC parameter 19608#5).
    pub tilt_second_axis_first: Option<bool>,
    /// Whether `G53.1` takes only positions within the travel of the rotary axes (FANUC parameters 19741 to 19744).
    pub tilt_within_travel: Option<bool>,
}

/// The M functions by which programs switch the kinematics of a LinuxCNC (`switchkins`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kinematics {
    /// X, Y and Z are the tip of the tool in the turned work, from here on.
    pub tip: u32,
    /// X, Y and Z are the axes, from here on.
    pub axes: u32,
}

/// A linear axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearAxis {
    /// Lower end of the travel in machine coordinates, mm; minus infinity where none is given.
    pub min: f64,
    /// Upper end of the travel, mm.
    pub max: f64,
    /// Rapid, mm/min, where it is known; the estimate of the time takes 10 000 otherwise.
    pub rapid: Option<f64>,
    /// Acceleration, m/s²; only the estimate of the time goes by it.
    pub acceleration: f64,
    /// What it carries: the part, or the tool, as where the file does not say it. Only drawings go by it.
    pub on: Mount,
}

impl Default for LinearAxis {
    /// An axis of which nothing is known.
    fn default() -> LinearAxis {
        let (min, max) = (f64::NEG_INFINITY, f64::INFINITY);
        LinearAxis { min, max, rapid: None, acceleration: 2.0, on: Mount::Head }
    }
}

/// A rotary axis.
#[derive(Clone, Debug, PartialEq)]
pub struct RotaryAxis {
    /// Its address: `A`, `B` or `C`.
    pub letter: char,
    /// What it carries.
    pub on: Mount,
    /// Unit vector of the axis at the zero position of all others, machine frame.
    pub axis: Vec3,
    /// A point of the axis, mm: for a table in machine coordinates, for a head from the gauge point
    /// of the spindle (so `[0, 0, 150]` is a pivot 150 mm above it). It means nothing where
    /// [`RotaryAxis::is_placed`] is false.
    pub point: Vec3,
    /// Whether its file says where it lies.
    pub is_placed: bool,
    /// What a growing position does: +1 turns what the axis carries right-handed about `axis`, −1
    /// left-handed (as ISO 841 counts a table).
    pub sign: f64,
    /// Position in degrees at which the axis stands in its kinematic zero.
    pub offset: f64,
    /// Lower end of the travel in degrees; minus infinity for an axis that turns for ever.
    pub min: f64,
    /// Upper end of the travel in degrees.
    pub max: f64,
    /// Rapid, degrees/min.
    pub rapid: f64,
    /// Acceleration, degrees/s².
    pub acceleration: f64,
    /// Whether its control counts it modulo 360° (SINUMERIK MD30310, FANUC parameter 1008#0, the display of a TNC); `None`
    /// where that is not known.
    pub modulo: Option<bool>,
    /// Its clamp, where it has one.
    pub clamp: Option<Clamp>,
    /// Which of the two solutions is taken where nothing else decides: the one in which this axis is
    /// positive or negative; 0 for no preference.
    pub prefer: f64,
}

/// The M functions of a rotary axis's clamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clamp {
    /// Opens it: the axis turns only after it.
    pub open: u32,
    /// Closes it.
    pub close: u32,
}

/// What a rotary axis carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mount {
    /// The part.
    Table,
    /// The tool.
    Head,
}

/// The wire of a machine for wire EDM. Its lower end moves in the plane Z 0 by X and Y; U and V say how
/// far from there the wire crosses the upper plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wire {
    /// Height of the upper plane over the lower, mm; without it no wire can lean.
    pub height: Option<f64>,
    /// Largest U and V in both directions, mm; infinite where none is given.
    pub uv_travel: f64,
    /// How far the wire may lean from upright, degrees; 90 where nothing is given.
    pub taper_max: f64,
    /// Number of the M function that threads it, where the control has one.
    pub thread: Option<u32>,
    /// Number of the M function that cuts it.
    pub cut: Option<u32>,
    /// The most points (lines of the program) that the control holds, where that is known.
    pub memory: Option<usize>,
}

/// How a tool orientation is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientationSettings {
    /// While the tool axis turns in the cut.
    pub simultaneous: OrientationMode,
    /// While it stands still (3+2).
    pub positioned: OrientationMode,
    /// How far the tool tip may leave the commanded line before a point is added, mm.
    pub tolerance: f64,
}

/// How a tool orientation can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OrientationMode {
    /// The machine cannot: the tool axis stays +Z.
    Fixed,
    /// Rotary positions, linear positions of the machine: the post does the kinematics.
    MachineAngles,
    /// Rotary positions, tool tip in the work frame: `TRAORI`, `G43.4`, `M128`.
    ToolCenterAngles,
    /// Vectors, tool tip in the work frame: `A3= B3= C3=`, `LN ... TX TY TZ`.
    Vectors,
    /// A tilted plane of work: `CYCLE800`, `G68.2`, `PLANE SPATIAL`.
    TiltedPlane,
    /// Rotary positions, linear positions of the machine from the work zero as the table has carried it: Haas `G254`.
    DynamicOffset,
}

/// What a control can do; what it cannot is lowered.
#[derive(Clone, Debug, PartialEq)]
pub struct Capabilities {
    /// Planes in which it cuts arcs: any of `XY`, `XZ`, `YZ`.
    pub arcs: Vec<Plane>,
    /// Whether an arc may rise along the plane's normal.
    pub helix: bool,
    /// Whether one block may turn a full circle.
    pub full_circle: bool,
    /// Difference of the radii at the ends of an arc that the control accepts, mm.
    pub arc_tolerance: f64,
    /// Hole cycles it has.
    pub cycles: Vec<CycleName>,
    /// Whether it has cutter radius compensation.
    pub compensation: bool,
    /// Where the move that switches it on ends.
    pub compensation_start: CompensationStart,
    /// Blocks without a move in the plane past which the control sees the next element of a contour; any number without it.
    pub compensation_blind: Option<u32>,
    /// Whether it has feed per turn.
    pub feed_per_turn: bool,
    /// Whether it has inverse-time feed.
    pub inverse_time: bool,
    /// Whether that is, on an arc too, the number of times that the move goes into a minute.
    pub inverse_time_arcs: bool,
    /// How the tool length offset is called.
    pub length_offset: LengthOffset,
    /// Whether rapids go straight while the control keeps the tool tip, however the axes go otherwise (SINUMERIK).
    pub straight_tip_rapids: bool,
    /// Largest number of characters in a line, its end not counted.
    pub line_length: usize,
    /// Chord error of arcs and curves that are split into lines, mm.
    pub lowering_tolerance: f64,
    /// How far a rapid may be from the straight line of the source where it is near the part, mm.
    pub rapid_corridor: f64,
    /// How far beyond all cuts, along its own axis, the tool may go by rapid on any path, mm.
    pub rapid_clearance: f64,
    /// Whether corners that reach beyond half of a motion have to be written shorter, since the control does not shorten them (robots).
    pub fits_corners: bool,
    /// By how much an arc through a point may turn, radians (robots).
    pub arc_sweep: f64,
    /// Most lines of a file of a program (robots): of those with a number, where the control numbers them.
    pub program_lines: usize,
    /// Most bytes of a file of a program (robots).
    pub program_bytes: usize,
    /// Most positions in a file of a program (robots).
    pub program_points: usize,
}

/// Where the move ends that switches cutter compensation on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CompensationStart {
    /// At right angles to the start of the next one.
    NextStart,
    /// At right angles to its own end: it counts as the first element of the contour. Elements that turn by less than 0.05 rad join
    /// without a corner, and the path to a rapid is straight (LinuxCNC).
    OwnEnd,
}

/// How the axes go in a rapid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RapidPath {
    /// Together, so that the path is straight.
    Linear,
    /// Each at its own speed: where the tool goes between the ends is not known.
    Independent,
}

/// What a tool table keeps as the radius of a tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ToolRadius {
    /// The radius itself: compensated programs are contours.
    Full,
    /// By how much the tool differs from the one of the toolpath: compensated programs are paths of the tool's centre.
    Wear,
}

/// A mode that a control is in before a program says it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum StartMode {
    /// The plane XY.
    G17,
    /// The first work offset (ISO code).
    G54,
    /// Lengths in mm (SINUMERIK).
    G71,
    /// Absolute positions.
    G90,
    /// Centres of arcs from their start.
    #[serde(rename = "G91.1")]
    G91Dot1,
    /// Feed a minute.
    G94,
    /// Cycles go back to the initial level.
    G98,
}

/// What a feed in mm/min counts where rotary axes turn in a cut and the control does not keep the tool tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RotaryFeed {
    /// The path of all axes together, a degree as a mm.
    AllAxes,
    /// The path of X, Y and Z, with which the rotary axes arrive; the degrees of the rotary axes where X, Y and Z do not move.
    LinearAxes,
}

impl RotaryFeed {
    /// The length by which the control divides F to find the time of a cut, mm: along it X, Y and Z go so far, and A, B and
    /// C turn by so many degrees.
    pub fn counted(self, linear: Vec3, degrees: [f64; 3]) -> f64 {
        let linear = linear.length();
        match self {
            RotaryFeed::LinearAxes if linear > 0.0 => linear,
            RotaryFeed::LinearAxes | RotaryFeed::AllAxes => {
                linear.hypot(Vec3::from_array(degrees).length())
            }
        }
    }
}

/// A hole cycle that a control may have: [`program::CycleKind`] without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CycleName {
    /// Feed in, rapid out.
    Drill,
    /// Pecks to the R plane.
    Deep,
    /// Pecks with a short break of the chip.
    BreakChip,
    /// Tapping.
    Tap,
    /// Feed in, feed out.
    Ream,
    /// Feed in, spindle stop, rapid out.
    Bore,
}

impl CycleName {
    /// The name of a cycle; none for those that no writer makes.
    pub fn of(kind: CycleKind) -> Option<CycleName> {
        Some(match kind {
            CycleKind::Drill => CycleName::Drill,
            CycleKind::Deep => CycleName::Deep,
            CycleKind::BreakChip => CycleName::BreakChip,
            CycleKind::Tap { .. } => CycleName::Tap,
            CycleKind::Ream => CycleName::Ream,
            CycleKind::Bore => CycleName::Bore,
            CycleKind::FineBore(_) | CycleKind::BackBore { .. } => return None,
        })
    }
}

/// How the tool length offset is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LengthOffset {
    /// The tool call does it, or there is none.
    Implicit,
    /// The first cutting edge of the tool (`D1`).
    One,
    /// The register with the tool's number (`G43 H`).
    ToolNumber,
}

/// A plane of two axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum Plane {
    /// `G17`.
    XY,
    /// `G18`.
    XZ,
    /// `G19`.
    YZ,
}

/// The signs that are harmless in a comment on every control. Whatever ends a comment or a string, starts
/// an expression, or is a command even inside a comment (`!`, `?`, `~`, `%` of GRBL and tapes, `MSG,` and
/// `LOGOPEN,` of LinuxCNC) is not among them.
pub const HARMLESS_SIGNS: &str = " .:+-*/=_<>&@#";

/// Harmless too, but on controls that take what stands before it in a comment as a command (`MSG,` of LinuxCNC).
pub const COMMA: char = ',';

/// How text is put together.
#[derive(Clone, Debug, PartialEq)]
pub struct Format {
    /// What stands between two words of a block.
    pub separator: String,
    /// What ends a line.
    pub line_end: String,
    /// What opens a comment.
    pub comment_start: String,
    /// What closes a comment.
    pub comment_end: String,
    /// Whether each operation says anew what the one before has left active: where the tool is, the kind
    /// of motion, the feed.
    pub fresh_operations: bool,
    /// The signs that a comment may hold, in addition to letters and digits.
    pub comment_signs: String,
    /// Most characters of a comment.
    pub comment_length: usize,
}

/// How a number is written behind its address.
#[derive(Clone, Debug, PartialEq)]
pub struct Word {
    /// What stands before the number: `X`, `A3=`, `C=`.
    pub address: String,
    /// What stands behind it: `+R24`.
    pub suffix: String,
    /// Decimals, 0 to 9.
    pub decimals: u8,
    /// Whether trailing zeros (and a point behind which nothing stands) are dropped.
    pub trim: bool,
    /// Whether a whole number keeps its point: `10.`.
    pub point: bool,
    /// Whether a positive number has its sign: `X+10`.
    pub plus: bool,
    /// Least number of digits before the point, filled with zeros: `N0010`.
    pub digits: u8,
    /// Whether the word is left out while it repeats the active value.
    pub modal: bool,
    /// Whether two values that are written alike are still two, so that the second is written again.
    pub exact: bool,
    /// Whether a position of a rotary axis is written within a turn, from 0 to below 360: `C=DC(350)`.
    pub within_turn: bool,
    /// For the block number: what it grows by.
    pub step: u32,
    /// For the block number, and for the parameters that keep heights: the first one.
    pub first: u32,
    /// What the value is multiplied with before it is written: 1000 for a dwell in milliseconds.
    pub scale: f64,
    /// Largest number that the control takes, as it is written. A block number starts over behind it,
    /// any other word beyond it is refused.
    pub max: f64,
    /// For a word that is no number: its texts by what they mean (`linear` is `G1`). Empty for a
    /// number.
    pub codes: BTreeMap<String, String>,
    /// Where its nearest table stands.
    pub place: FileLocation,
}

/// A line of a machine's files.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileLocation {
    /// The file.
    pub file: String,
    /// The line, from 1.
    pub line: u32,
}

/// A template.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Its text.
    pub text: String,
    /// File that it stands in.
    pub file: String,
    /// Line (from 1) of that file on which the text begins.
    pub line: u32,
    /// Column (from 1) of that line at which the text begins.
    pub column: u32,
}

/// What the spindle can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindleRange {
    /// Slowest, 1/min.
    pub min: f64,
    /// Fastest, 1/min.
    pub max: f64,
    /// How long programs dwell behind each start, s; 0 where the control waits for the spindle.
    pub dwell: f64,
}

/// What the tool magazine takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolRange {
    /// Highest tool number.
    pub max_number: u32,
    /// Largest diameter, mm.
    pub max_diameter: f64,
    /// Longest tool, mm.
    pub max_length: f64,
    /// Whether the tool change brings Z up by itself.
    pub retracts: bool,
    /// Whether the tool change turns the axes of a head to 0 by itself.
    pub turns_upright: bool,
}

/// A value of `[options]`.
#[derive(Clone, Debug, PartialEq)]
pub enum OptionValue {
    /// `true` or `false`.
    Flag(bool),
    /// A number.
    Number(f64),
    /// Text.
    Text(String),
}

/// How a machine file says its safe height.
pub const SAFE_HEIGHT_HELP: &str = "add `safe_height = 0` to the machine's file, with the Z that the control shows in \
     machine coordinates once the axis is homed and at its top (mm)";

/// A plate or a tool setter that answers when a tool touches it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchPlate {
    /// Where it is, mm from the work zero.
    pub at: Vec2,
    /// How high its top is over the work zero, mm.
    pub height: f64,
    /// How far below its top a tool goes at most that has not touched it, mm.
    pub travel: f64,
    /// How fast a tool comes to it at most, mm/min: the zero counts from where it has come to rest.
    pub feed: f64,
}

/// Why further tools cannot be touched off; `None` where they can.
pub(crate) fn no_touch_off(
    blocks: &BTreeMap<String, Block>,
    rotary: &[RotaryAxis],
) -> Option<&'static str> {
    let writes = |block: &Block| block.text.contains(OptionKey::TouchTravel.name());
    match blocks.get("tool_change").is_some_and(writes) {
        false => Some("the block `tool_change` of this control writes no touch-off"),
        true => (!rotary.is_empty()).then_some("a machine with rotary axes has no touch-off"),
    }
}

/// What to do on a machine without a touch-off.
pub(crate) const NO_TOUCH_OFF_HELP: &str =
    "leave it out: tools are touched off by GRBL and LinuxCNC, on machines without rotary axes";

impl Machine {
    /// Whether programs are written for it: an arm of which the kinematics alone are known has no virtual control.
    pub fn has_control(&self) -> bool {
        !self.reader.is_empty()
    }

    /// Gives a value of `[options]` another one, in its own kind.
    ///
    /// # Errors
    /// The machine has no option of that name, or it is of another kind.
    pub fn set_option(&mut self, name: &str, value: &str) -> Result<(), Box<Diagnostic>> {
        let file = self.file.clone();
        let refused = |message: String, help: String| {
            Box::new(Diagnostic::error(Rule::Option, message).help(help).file(file))
        };
        let no_touch_off = no_touch_off(&self.blocks, &self.rotary)
            .filter(|_| name == OptionKey::TouchTravel.name());
        let names = self.options.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
        let Some(option) = self.options.get_mut(name) else {
            let message = format!("the machine has no option `{name}`");
            return Err(refused(message, format!("its options are {names}")));
        };
        let (given, kind) = match option {
            OptionValue::Flag(_) => (value.parse().ok().map(OptionValue::Flag), "true or false"),
            OptionValue::Number(_) => {
                let number = value.parse().ok().filter(|number: &f64| number.is_finite());
                if let Some(wrong) = number.and_then(|number| wrong_option(name, number)) {
                    return Err(refused(format!("option `{name}`: {wrong}"), String::new()));
                }
                if let Some(why) = no_touch_off.filter(|_| number.is_some_and(|mm| mm > 0.0)) {
                    let message = format!("option `{name}`: {why}");
                    return Err(refused(message, NO_TOUCH_OFF_HELP.to_owned()));
                }
                (number.map(OptionValue::Number), "a number")
            }
            // It reaches the program as it is: it must not make a block of its own.
            OptionValue::Text(_) => {
                let text =
                    Some(value).filter(|text| text.chars().all(|c| (' '..='~').contains(&c)));
                (text.map(|text| OptionValue::Text(text.to_owned())), "text of one line, in ASCII")
            }
        };
        *option = given.ok_or_else(|| {
            refused(format!("option `{name}` is {kind}, not `{value}`"), String::new())
        })?;
        let digest = &mut self.loaded_from.digest;
        *digest = Digest::of([digest.as_bytes(), name.as_bytes(), value.as_bytes()]);
        Ok(())
    }

    /// Whether its file says, by an empty block of that name, that the control does nothing for it.
    pub fn leaves_out(&self, block: &str) -> bool {
        self.blocks.get(block).is_some_and(|block| block.text.trim().is_empty())
    }

    /// What is wrong with a move to these positions in machine coordinates: one that is not known (NaN) or beyond the
    /// travel of its axis, an axis whose travel the file does not say, Z below the safe height or without one.
    /// Nothing where it is safe.
    pub fn unsafe_position(&self, to: &MachineMove) -> Option<Diagnostic> {
        let found = |message: String, help: String| {
            Some(Diagnostic::error(Rule::MachinePosition, message).help(help))
        };
        let step = self.resolution() / 2.0;
        for (i, name) in ["X", "Y", "Z"].into_iter().enumerate() {
            let (Some(at), LinearAxis { min, max, .. }) = (to.linear[i], self.linear[i]) else {
                continue;
            };
            let place = format!("{name} goes to {at} mm in machine coordinates");
            if at.is_nan() {
                let message = format!("where {name} goes in machine coordinates is not known");
                let help =
                    "end the tool length in that block, and count from the zero of the machine";
                return found(message, help.into());
            }
            if i == 2 {
                let Some(safe) = self.safe_height else {
                    let message = format!("{place}, and the machine's file gives no safe height");
                    return found(message, SAFE_HEIGHT_HELP.into());
                };
                if (at - safe).abs() <= step {
                    continue;
                }
                if at < safe {
                    let message = format!("{place}, below the safe height of {safe} mm");
                    return found(message, "go to the safe height".into());
                }
            }
            if !(min.is_finite() && max.is_finite()) {
                let message = format!("{place}, and the machine's file gives no travel");
                let help = format!(
                    "give it below [axes], from what the control shows at both ends (mm): \
                     `{name} = {{ min = -300, max = 0 }}`"
                );
                return found(message, help);
            }
            if at < min - step || at > max + step {
                let message = format!("{place}, where it travels from {min} to {max} mm");
                return found(message, "stay within the travel".into());
            }
        }
        for axis in &self.rotary {
            if let Some(at) = to.rotary[axis.index()]
                && !(axis.min..=axis.max).contains(&at)
            {
                let message = format!(
                    "{} goes to {at}° in machine coordinates, where it travels from {}° to {}°",
                    axis.letter, axis.min, axis.max
                );
                return found(message, "stay within the travel".into());
            }
        }
        None
    }

    /// The rotary axes whose clamps `M` and this number work, and whether it closes them: `None` where it works none.
    pub fn clamps(&self, number: u32) -> Option<program::Clamp> {
        let of = |which: fn(&Clamp) -> u32| {
            let works =
                |axis: &&RotaryAxis| axis.clamp.is_some_and(|clamp| which(&clamp) == number);
            let axes = self.rotary.iter().filter(works);
            axes.fold(Axes::NONE, |all, axis| all | Axes::rotary(axis.index()))
        };
        let (opened, closed) = (of(|clamp| clamp.open), of(|clamp| clamp.close));
        match (opened == Axes::NONE, closed == Axes::NONE) {
            (true, true) => None,
            (false, _) => Some(program::Clamp { axes: opened, closed: false }),
            (true, false) => Some(program::Clamp { axes: closed, closed: true }),
        }
    }

    /// Whether a rotary axis has a clamp.
    pub fn has_clamps(&self) -> bool {
        self.rotary.iter().any(|axis| axis.clamp.is_some())
    }

    /// Whether its axes go together in a rapid. Where it is not stated, each goes at its own speed.
    pub fn has_straight_rapids(&self) -> bool {
        self.settings.rapid_path == Some(RapidPath::Linear)
    }

    /// Whether its control may take rotary positions beyond their travel for a tilted plane (FANUC parameters 19741 to
    /// 19744).
    pub fn tilts_blindly(&self) -> bool {
        self.reader == "fanuc" && self.settings.tilt_within_travel != Some(true)
    }

    /// Whether it is known how long a hole cycle dwells: on a FANUC P counts increments, whose length parameters say.
    pub fn counts_dwells(&self) -> bool {
        self.reader != "fanuc" || self.settings.dwell_p_milliseconds.is_some()
    }

    /// How fast the tool may turn, degrees/s, its axis and about it each: `turn_speed` of the options, which the templates of an
    /// arm write; `None` where they do not.
    pub fn turn_speed(&self) -> Option<f64> {
        Some(self.number_of(OptionKey::TurnSpeed)).filter(|speed| *speed > 0.0)
    }

    /// Z over the work zero to which tools retract, mm, where machine zero means nothing, since the machine has no switches to
    /// home to: `retract_height` of the options, which the templates write. Only on a machine without rotary axes.
    pub fn retract_height(&self) -> Option<f64> {
        let height = self.number_of(OptionKey::RetractHeight);
        Some(height).filter(|height| *height > 0.0 && self.rotary.is_empty())
    }

    /// What further tools are touched off on: the options `touch_...`, which the templates write. `None` where a tool change has no
    /// touch-off. Only on a machine without rotary axes.
    pub fn touch_plate(&self) -> Option<TouchPlate> {
        let number = |option| self.number_of(option);
        let plate = TouchPlate {
            at: Vec2::new(number(OptionKey::TouchX), number(OptionKey::TouchY)),
            height: number(OptionKey::TouchHeight),
            travel: number(OptionKey::TouchTravel),
            feed: number(OptionKey::TouchFeed),
        };
        Some(plate).filter(|plate| plate.travel > 0.0 && self.rotary.is_empty())
    }

    /// How far its control may leave the path while it smooths it, mm: `path_tolerance` of the options,
    /// which the templates write. The proof does not see that deviation.
    pub fn path_tolerance(&self) -> f64 {
        self.number_of(OptionKey::PathTolerance)
    }

    /// How far its control may leave the path in cuts for which the source itself says more than
    /// [`path_tolerance`](Machine::path_tolerance), mm: `roughing_tolerance` of the options. 0 where no cut gets more.
    pub fn roughing_tolerance(&self) -> f64 {
        self.number_of(OptionKey::RoughingTolerance)
    }

    /// By how much its control may turn the tool out of its orientation while it smooths the path, degrees:
    /// `orientation_tolerance` of the options, which the templates write. The proof does not see that deviation.
    pub fn orientation_tolerance(&self) -> f64 {
        self.number_of(OptionKey::OrientationTolerance)
    }

    /// The name of the swivel data set that describes the machine: `swivel_data` of the options; empty where none is named.
    pub fn swivel_data(&self) -> &str {
        match self.option(OptionKey::SwivelData) {
            Some(OptionValue::Text(name)) => name,
            _ => "",
        }
    }

    /// The value of an option; `None` where no file of the machine states it.
    pub fn option(&self, option: OptionKey) -> Option<&OptionValue> {
        self.options.get(option.name())
    }

    /// The number of an option; 0 where there is none.
    fn number_of(&self, option: OptionKey) -> f64 {
        match self.option(option) {
            Some(OptionValue::Number(number)) => *number,
            _ => 0.0,
        }
    }

    /// Smallest step of a linear axis in its programs, mm.
    pub fn resolution(&self) -> f64 {
        self.words.get("X").map_or(1e-3, Word::resolution)
    }

    /// Smallest step of a rotary axis in its programs, degrees.
    pub fn rotary_resolution(&self) -> f64 {
        let decimals = self.rotary.iter().filter_map(|r| self.words.get(&r.letter.to_string()));
        decimals.map(|word| 10f64.powi(-i32::from(word.decimals))).fold(0.0, f64::max)
    }
}

impl Word {
    /// The step from one value that it can write to the next, in the unit of the value.
    pub fn resolution(&self) -> f64 {
        10f64.powi(-i32::from(self.decimals)) / self.scale
    }
}

impl RotaryAxis {
    /// Its place in the order A, B, C.
    pub fn index(&self) -> usize {
        match self.letter {
            'A' => 0,
            'B' => 1,
            _ => 2,
        }
    }

    /// Radians by which the axis turns what it carries, right-handed about its axis, at a position in
    /// degrees.
    pub fn turned(&self, degrees: f64) -> f64 {
        self.sign * (degrees - self.offset).to_radians()
    }

    /// The position in degrees at which the axis has turned by so many radians.
    pub fn degrees(&self, turned: f64) -> f64 {
        (self.sign * turned).to_degrees() + self.offset
    }

    /// Whether it turns for ever.
    pub fn unlimited(&self) -> bool {
        self.min == f64::NEG_INFINITY && self.max == f64::INFINITY
    }
}
