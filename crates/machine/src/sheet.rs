//! What one file may say: every key, in one table with its unit and help. The structs that a file is
//! read into are generated from it, and `toolpost explain` prints it.

use crate::model::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use toml::Spanned;

/// A key of machine and control files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Key {
    /// The table it stands in; empty for the top of the file.
    pub table: &'static str,
    /// The key.
    pub name: &'static str,
    /// Unit of the value; empty where there is none.
    pub unit: &'static str,
    /// What it says, in a sentence.
    pub help: &'static str,
}

/// Every key of machine and control files.
pub fn keys() -> impl Iterator<Item = &'static Key> {
    let tables = [
        Sheet::KEYS,
        CapabilitiesSheet::KEYS,
        FormatSheet::KEYS,
        SettingsSheet::KEYS,
        WordSheet::KEYS,
        LinearSheet::KEYS,
        RotarySheet::KEYS,
        BodySheet::KEYS,
        OrientationSheet::KEYS,
        WireSheet::KEYS,
        SpindleSheet::KEYS,
        ToolsSheet::KEYS,
        CoolantSheet::KEYS,
        ArmSheet::KEYS,
        CellSheet::KEYS,
        RailSheet::KEYS,
        LengthsSheet::KEYS,
        DhSheet::KEYS,
        JointSheet::KEYS,
    ];
    tables.into_iter().flatten()
}

/// A struct whose fields are all optional, its keys, and (`merged`) how a nearer one lies over it.
macro_rules! sheet {
    (merged $sheet:ident $table:literal {
        $($field:ident: $type:ty, $unit:literal, $help:literal;)*
    }) => {
        sheet!($sheet $table { $($field: $type, $unit, $help;)* });
        impl $sheet {
            pub(crate) fn under(self, nearer: $sheet) -> $sheet {
                $sheet { $($field: nearer.$field.or(self.$field),)* }
            }
        }
    };
    ($sheet:ident $table:literal {
        $($field:ident: $type:ty, $unit:literal, $help:literal;)*
    }) => {
        #[derive(Default, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(crate) struct $sheet { $(pub(crate) $field: Option<$type>,)* }
        impl $sheet {
            const KEYS: &[Key] = &[$(
                Key { table: $table, name: stringify!($field), unit: $unit, help: $help },
            )*];
        }
    };
}

sheet!(Sheet "" {
    extends: Spanned<String>, "", "The machine or control that this file changes: a name in the library, or the path of a file.";
    title: String, "", "What a person calls it.";
    reader: Spanned<String>, "", "The virtual control that proves its programs: sinumerik, sinumerik-828d, klartext, fanuc, haas, linuxcnc, mach3, grbl, marlin, fanuc-wire, sodick, agie, points, krl, urscript, ls, rapid.";
    extension: String, "", "Ending of its programs, without the dot.";
    capabilities: CapabilitiesSheet, "", "Table: what the control can do; what it cannot is lowered.";
    format: FormatSheet, "", "Table: how text is put together.";
    settings: SettingsSheet, "", "Table: parameters of the control as this machine has them; of one that is not given every value is tried, and each must be safe.";
    words: BTreeMap<String, Spanned<WordSheet>>, "", "Table: how each word is written.";
    blocks: BTreeMap<String, Spanned<String>>, "", "Table: the templates of the blocks.";
    axes: BTreeMap<LinearName, Spanned<LinearSheet>>, "", "Table: X, Y and Z.";
    rotary: Spanned<Vec<Spanned<RotarySheet>>>, "", "Tables [[rotary]]: the rotary axes from the machine's frame outwards, at most two.";
    body: Vec<Spanned<BodySheet>>, "", "Tables [[body]]: boxes that stand for parts of the machine in drawings; where there are none, boxes of about the right size are drawn.";
    work_zero: Place3, "mm", "The work zero (G54) in machine coordinates, where it is known: travels are then checked in machine coordinates, otherwise only their length.";
    safe_height: Spanned<Position>, "mm", "Z of the gauge line in machine coordinates at which every tool is clear of every part: where the control shows it, homed and at its top. Retracts in machine coordinates (G53, SUPA, M91) go there; without it none is written.";
    orientation: Spanned<OrientationSheet>, "", "Table: how a tool axis is written.";
    wire: Spanned<WireSheet>, "", "Table: the wire of a machine for wire EDM; a machine without it is a mill.";
    spindle: Spanned<SpindleSheet>, "", "Table: the speeds of the spindle.";
    arm: Spanned<ArmSheet>, "", "Table: a six-axis arm. A file with it and without `reader` says how the arm moves; programs are written for no such file.";
    coolant: Spanned<CoolantSheet>, "", "Table: the M functions that switch coolant, where they are others than M7, M8 and M9.";
    cell: Spanned<CellSheet>, "", "Table: where the tool and the part of an arm are, and what its outputs switch.";
    feed_max: Rate, "mm/min", "The fastest feed of the machine; a program that asks for more is refused.";
    tools: ToolsSheet, "", "Table: what the magazine takes.";
    auxiliary: Vec<u32>, "", "Numbers of the M functions of the builder that programs use; none moves an axis that the program drives.";
    operator_parameters: Vec<OperatorParameter>, "", "R parameters with which the operator shifts the zero of a rotary axis, such as [\"R24\"] (SINUMERIK).";
    approach: Spanned<Vec<String>>, "", "In which order the axes go to the first position after a tool change: each entry names axes that move together.";
    options: BTreeMap<String, Spanned<OptionSheet>>, "", "Table: values of this machine that its templates read.";
});

sheet!(merged CapabilitiesSheet "capabilities" {
    arcs: Vec<Plane>, "", "Planes in which it cuts arcs: XY, XZ, YZ.";
    helix: bool, "", "Whether an arc may rise along the normal of the plane.";
    full_circle: bool, "", "Whether one block may turn a full circle.";
    arc_tolerance: Tolerance, "mm", "Difference of the radii at the ends of an arc that the control accepts.";
    cycles: Vec<CycleName>, "", "Hole cycles that it has: drill, deep, break-chip, tap, ream, bore.";
    compensation: bool, "", "Whether it has cutter radius compensation.";
    compensation_start: CompensationStart, "", "Where the move that switches cutter compensation on ends: next-start (at right angles to the start of the next one), which is taken where it is missing; or own-end (at right angles to its own end: it has to be longer than the tool's radius, elements that turn by less than 0.05 rad join without a corner, and the path to a rapid is straight: LinuxCNC).";
    compensation_blind: u32, "", "Most blocks without a move in the plane past which the control sees the next element of a contour: FANUC parameter 19625 less 2, SINUMERIK MD20250; any number where it is missing.";
    feed_per_turn: bool, "", "Whether it has feed per turn.";
    inverse_time: bool, "", "Whether it has inverse-time feed.";
    inverse_time_arcs: bool, "", "Whether inverse-time feed counts the time of an arc as that of a line; FANUC divides by the radius.";
    length_offset: LengthOffset, "", "How the tool length offset is called: implicit, one, tool-number.";
    straight_tip_rapids: bool, "", "Whether rapids go straight while the control keeps the tool tip, whatever `rapid_path` says: SINUMERIK with TRAORI.";
    line_length: usize, "", "Most characters of a line, its end not counted.";
    lowering_tolerance: Tolerance, "mm", "How far arcs and curves that are split into lines may leave the path.";
    rapid_corridor: Tolerance, "mm", "How far a rapid may be from the straight line of the source where it is not beyond all cuts; 0.1 where it is missing.";
    rapid_clearance: Clearance, "mm", "How far the tool must be beyond all cuts, along its own axis, to go by rapid on any path; 1 where it is missing.";
    fits_corners: bool, "", "Whether a robot's corners that reach beyond half of a motion have to be written shorter, since its control does not shorten them.";
    arc_sweep: ArcSweep, "degrees", "By how much a robot's arc through a point may turn; 180 where it is missing.";
    program_lines: usize, "", "Most lines of a file of a robot's program (of those with a number, where the control numbers them): a longer program is divided at retracts; any number where it is missing.";
    program_bytes: usize, "", "Most bytes of such a file; any number where it is missing.";
    program_points: usize, "", "Most positions in such a file; any number where it is missing.";
});

sheet!(merged SettingsSheet "settings" {
    dwell_p_milliseconds: bool, "", "Whether P of a dwell counts milliseconds, or tenths of them: FANUC increment system B (parameter 1013), or 1015#7 is 1; or milliseconds, or seconds: Mach3 General Config.";
    start_modes: Vec<StartMode>, "", "Modes that the control is set up to start a program in, so that programs need not say them: G17, G54, G71 (SINUMERIK), G90, G91.1, G94, G98 (FANUC, Haas).";
    edge_at_change: u32, "", "The edge D of a tool that counts behind M6 where the program says none, 0 for none: SINUMERIK MD20270, where it is not negative.";
    floating_holder: bool, "", "Whether taps are held in a chuck that floats along its axis, so that a tapping cycle need not couple feed and spindle.";
    high_feed: Rate, "mm/min", "The feed of rapids near the part that are written as G1, since each axis goes at its own speed by rapid: as fast as the machine is to go through the air there.";
    length_along_z: bool, "", "Whether the tool length counts along Z in every plane: SINUMERIK SD42940 is 17, FANUC parameters 5001#0 and 5001#1 are 0.";
    length_moves_axis: bool, "", "Whether Z moves where a tool length begins, ends or changes: FANUC parameter 5006#6 is 0.";
    retract_above_r: Retract, "mm", "How far above R a peck cycle (G83) takes the tool each time it clears chips: Haas setting 52.";
    rapid_path: RapidPath, "", "How the axes go in a rapid: linear (together, on a straight line) or independent (each at its own speed), which is taken where it is missing. FANUC: linear where parameter 1401#1 is 1; SINUMERIK: MD20730.";
    tool_radius: ToolRadius, "", "What the tool table keeps as the radius of a tool (D, the radius of an edge, R): full, the radius itself, for contours; or wear, its difference from the tool of the toolpath, for paths of the tool's centre.";
    rotary_feed: RotaryFeed, "", "What F in mm/min counts where rotary axes turn in a cut and the control does not keep the tool tip: all-axes (all of them together, a degree as a mm: FANUC where parameter 1408#0 is 0, HEIDENHAIN, SINUMERIK after FGROUP with them) or linear-axes (X, Y and Z alone; LinuxCNC). It is needed where the control has no inverse-time feed.";
    sets_work_offsets: bool, "", "Whether programs write the work offsets that their source writes (G10 L2): the shop sets its fixtures so, and not by the operator.";
    tip_kinematics: u32, "", "M function that switches a LinuxCNC to the kinematics that follow the tip (switchkins): X, Y and Z are then the tip in the turned work.";
    axis_kinematics: u32, "", "M function that switches a LinuxCNC back to the kinematics of the axes themselves.";
    swivel_direction: char, "", "Letter of the rotary axis to which _DIR of CYCLE800 refers: SINUMERIK, direction reference of the swivel data set ($TC_CARR37).";
    tilt_second_axis_first: bool, "", "Whether G53.1 compares the turns of the second rotary axis before those of the first, where it chooses between two solutions: FANUC parameter 19608#5 is 1.";
    tilt_within_travel: bool, "", "Whether G53.1 takes only rotary positions within the travel of this file: FANUC parameters 19741 to 19744 hold it.";
    rotary_by_sign: bool, "", "Whether the sign of a rotary word is the direction of an axis that rolls over: FANUC parameter 1008#1 is 1.";
    table_frame_at_zero: bool, "", "Whether X, Y and Z under G43.4 count in the frame of the part with the table at 0, however the table is turned when G43.4 comes: parameter 19696#5 is 0, and the work offset is that of the table at 0. The manuals of FANUC can be read otherwise (A-79348E, parameter 19696#5): try a point off the centre of the table.";
});

sheet!(merged FormatSheet "format" {
    separator: String, "", "What stands between two words.";
    line_end: String, "", "What ends a line.";
    comment_start: String, "", "What opens a comment.";
    comment_end: String, "", "What closes a comment; empty where the end of the line does.";
    fresh_operations: bool, "", "Whether each operation says position, kind of motion and feed anew, as if the control had forgotten them.";
    comment_signs: String, "", "The signs that a comment may hold, in addition to letters and digits of ASCII: some of ` .:+-*/=_<>&@#,`, without it all of them but the comma, behind which LinuxCNC takes `MSG` for a command. What is none of them is spelt with letters (`é` as e) or left blank.";
    comment_length: usize, "", "Most characters of a comment; the length of a line less 24 where it is missing.";
});

sheet!(merged WordSheet "words.NAME" {
    address: String, "", "What stands before the number; the name of the word where it is missing.";
    suffix: String, "", "What stands behind the number.";
    decimals: Decimals, "", "How many decimals are written, 0 to 9.";
    trim: bool, "", "Whether zeros at the end of the decimals are left out.";
    point: bool, "", "Whether a whole number keeps its point.";
    plus: bool, "", "Whether a positive number has its sign.";
    digits: u8, "", "Fewest digits before the point, filled with zeros.";
    modal: bool, "", "Whether the word is left out while it repeats the active value.";
    exact: bool, "", "Whether values that differ by less than the decimals show are different, so that a modal word is written again.";
    within_turn: bool, "", "Whether a position of a rotary axis is written within a turn, from 0 to below 360: what DC() of a SINUMERIK takes.";
    step: u32, "", "Block number: what it grows by; 0 for none.";
    first: u32, "", "Block number, parameters that keep heights: the first one.";
    scale: Scale, "", "What the value is multiplied with before it is written: 1000 for a dwell in milliseconds.";
    max: Largest, "", "Largest number that the control takes, as it is written. A block number starts over behind it.";
    codes: BTreeMap<String, String>, "", "Texts of a word that is no number, by what they mean.";
});

sheet!(merged LinearSheet "axes.X" {
    min: Position, "mm", "Lower end of the travel in machine coordinates; without one there is no limit.";
    max: Position, "mm", "Upper end of the travel.";
    rapid: Rate, "mm/min", "Speed of a rapid move.";
    acceleration: Acceleration, "m/s²", "Acceleration.";
    on: Mount, "", "What it carries, for drawings: table (the part) or head (the tool, as where it is missing). On either side Y carries X, and X carries Z.";
});

sheet!(BodySheet "body" {
    name: String, "", "What it is called.";
    on: String, "", "What carries it: X, Y, Z or a rotary axis, J1 to J6 or rail of a robot, bed (nothing moves it), spindle (what carries the tool), table (what carries the part).";
    low: Place3, "mm", "Its corner with the smallest X, Y and Z in machine coordinates, on a robot in the world of the controller, while all axes stand at zero and the gauge point of the spindle at the origin.";
    high: Place3, "mm", "Its corner with the largest.";
});

sheet!(RotarySheet "rotary" {
    letter: char, "", "Its address: A, B or C.";
    on: Mount, "", "What it carries: table (the part) or head (the tool).";
    axis: Direction, "", "Direction of the axis while all others stand at zero.";
    point: Place3, "mm", "A point of the axis: of a table in machine coordinates, of a head from the gauge point of the spindle.";
    sign: f64, "", "1 where a growing position turns what the axis carries right-handed about it, -1 where left-handed.";
    offset: Angle, "degrees", "Position at which the axis stands in its kinematic zero.";
    min: Angle, "degrees", "Lower end of the travel; without one there is no limit.";
    max: Angle, "degrees", "Upper end of the travel.";
    rapid: TurnRate, "degrees/min", "Speed of a rapid move.";
    acceleration: TurnAcceleration, "degrees/s²", "Acceleration.";
    modulo: bool, "", "Whether its control counts it modulo 360 degrees; an axis whose travel ends within a turn is not, of another it is not known.";
    clamp_open: u32, "", "M function that opens its clamp: the axis turns only after it.";
    clamp_close: u32, "", "M function that closes its clamp. A machine whose axes have clamps needs the blocks `unclamp` and `clamp`.";
    prefer: Angle, "", "Which solution is taken where nothing else decides: the one in which this axis is positive (1) or negative (-1).";
});

sheet!(merged OrientationSheet "orientation" {
    simultaneous: OrientationMode, "", "How the tool axis is written while it turns in the cut: fixed, machine-angles, tool-center-angles, vectors, tilted-plane, dynamic-offset.";
    positioned: OrientationMode, "", "The same while it stands still (3+2); as `simultaneous` where it is missing.";
    tolerance: Tolerance, "mm", "How far the tool tip may leave the line between two points before a point is added.";
});

sheet!(merged WireSheet "wire" {
    height: Length, "mm", "Height of the upper plane over the lower: U and V are the offset of the wire from X and Y there.";
    uv_travel: Length, "mm", "Farthest U and V either way; without it there is no limit.";
    taper_max: Lean, "degrees", "How far the wire may lean from upright; without it there is no limit.";
    thread: u32, "", "Number of the M function that threads the wire.";
    cut: u32, "", "Number of the M function that cuts the wire.";
    memory: u32, "", "The most points that the control holds, one a line.";
});

sheet!(merged SpindleSheet "spindle" {
    min: Speed, "1/min", "The slowest speed.";
    max: Speed, "1/min", "The fastest speed.";
    dwell: Wait, "s", "How long the spindle takes to reach its speed where the control does not wait for it: programs dwell so long behind each start.";
});

sheet!(merged ToolsSheet "tools" {
    max_number: u32, "", "Highest number of a tool.";
    max_diameter: Length, "mm", "Largest diameter.";
    max_length: Length, "mm", "Longest tool.";
    retracts: bool, "", "Whether the tool change brings Z up by itself; without it Z has to be home before each.";
    turns_upright: bool, "", "Whether the tool change turns the axes of a head to 0 by itself; without it they have to stand there before each.";
});

sheet!(merged CoolantSheet "coolant" {
    flood: u32, "", "Number of the M function that switches flood on, where it is not M8; M8 then is none.";
    mist: u32, "", "Number of the M function that switches mist on, where it is not M7; M7 then is none.";
    through: u32, "", "Number of the M function that switches coolant through the tool on: Haas M88, elsewhere as the builder has it. The block `coolant_through` writes it.";
    off: u32, "", "Number of the M function that switches coolant off, where it is not M9; M9 then is none.";
    through_off: u32, "", "Number of the M function that switches coolant through the tool off, where the one for all coolant does not: Haas M89.";
});

sheet!(merged ArmSheet "arm" {
    model: Spanned<String>, "", "An arm of the library (`toolpost machines list` names them) whose figures hold where this table states none.";
    lengths: Spanned<LengthsSheet>, "", "Table: an arm whose last three axes meet in one point, by its seven lengths.";
    dh: Spanned<DhSheet>, "", "Table: an arm of Universal Robots, by its Denavit-Hartenberg parameters.";
    offsets: SixAngles, "degrees", "What is taken from each joint: joint i has the angle sign * position - offset, and with all those angles 0 the arm stands straight up. With `lengths` alone.";
    signs: [f64; 6], "", "1 or -1: which way each joint counts. With `lengths` alone.";
    coupling: CouplingSheet, "", "How the controller counts joint 3: none (against the upper arm), less-joint-2 (against the horizontal: what it shows is the joint less joint 2, FANUC), plus-joint-2 (by a parallel rod, ABB). Without it no joint positions are written: look at the controller.";
    coupled_min: Angle, "degrees", "Lower limit of joint 3 as the controller counts it, beyond that of the joint itself.";
    coupled_max: Angle, "degrees", "Upper limit of the same.";
    world_height: Position, "mm", "How far the origin of the controller's world lies above the foot of the arm.";
    reach: Length, "mm", "What the data sheet states from axis 1 to the wrist centre. Lengths that reach more than 2 % farther or less far are refused.";
    joints: Spanned<Vec<JointSheet>>, "", "Tables: the six joints from the foot upwards, each { min, max, speed, acceleration }.";
    calibration: Spanned<Vec<[f64; 6]>>, "mm, degrees", "What the factory has measured of an arm of Universal Robots: of each joint x, y, z and the turns about the fixed X, Y and Z axes in the frame of the one before it.";
});

sheet!(merged CellSheet "cell" {
    spindle: SixNumbers, "mm, degrees", "Where the spindle holds its tools, in the frame of the flange: X, Y, Z, and A, B, C, which turn about Z, the new Y and the new X. Its Z points out of the tool.";
    tool_length: Length, "mm", "Length of a tool from there to its tip, where the source states none.";
    part: SixNumbers, "mm, degrees", "The frame of the source in the world of the controller, as six numbers like those of `spindle`.";
    home: SixAngles, "degrees", "The joints at which programs begin and end, as the controller shows them.";
    joint_speed: Percent, "%", "Speed of moves of joints, of the fastest.";
    rapid: Rate, "mm/min", "Speed of the tip where it goes straight and does not cut.";
    cable_joint_4: Range, "degrees", "From where to where joint 4 may turn with the cables and hoses on the arm, in cuts and in the air: two numbers within the limits of the joint, as the controller shows it.";
    cable_joint_6: Range, "degrees", "The same of joint 6.";
    reentry_feed: Rate, "mm/min", "Feed straight out of a cut and back into it at the same place, where no turn about the tool and no posture carries the whole cut: the arm is retracted along the tool, takes another posture or turn above all cuts, and enters again. Without it such a cut is refused.";
    tool_change: String, "", "Name of the operator's program that changes the tool, called with its number. Without it the one tool of a program is in the spindle, and a program with several stops at home for each of them, to have it put in by hand.";
    spindle_output: u32, "", "Number of the digital output that switches the spindle on.";
    spindle_analog: u32, "", "Number of the analog output that sets its speed.";
    spindle_full: Speed, "1/min", "Speed of the spindle at the full value of that output.";
    coolant_output: u32, "", "Number of the digital output that switches the coolant on.";
    own_frame: OwnFrame, "", "The number of the user frame, the tool and the position register that programs set for themselves (FANUC): no other program and no operator uses them.";
    load_number: LoadNumber, "", "The number under which the operator has entered what hangs on the flange (FANUC, `PAYLOAD[1]`): programs choose it.";
    load_mass: Mass, "kg", "What hangs on the flange: the spindle with a tool in it.";
    load_center: LoadCenter, "mm", "Its centre of gravity in the frame of the flange.";
    rail: Spanned<RailSheet>, "", "Table: the straight rail on which the arm stands, outer axis 1 of the controller (KUKA E1, ABB eax_a, FANUC E1); `part` then is in the world that stays.";
});

sheet!(RailSheet "cell.rail" {
    direction: Direction, "", "Where the arm moves while the position of the rail grows, in the world of the controller: a vector of any length.";
    origin: SixNumbers, "mm, degrees", "Where the arm's own world stands in that of the controller with the rail at 0, as six numbers like those of `spindle` (KUKA: $ROBROOT; FANUC: zeros).";
    min: Position, "mm", "Lowest position.";
    max: Position, "mm", "Highest position.";
    speed: Rate, "mm/min", "Fastest.";
    home: Position, "mm", "Where the rail stands when programs begin and end.";
});

sheet!(LengthsSheet "arm.lengths" {
    a1: Position, "mm", "From axis 1 forward to axis 2.";
    a2: Position, "mm", "From axis 3 across to axis 4: negative where axis 4 lies above axis 3 while the forearm is level.";
    b: Position, "mm", "Sideways from axis 1 to the plane in which the arm bends.";
    c1: Position, "mm", "From the foot up to axis 2.";
    c2: Position, "mm", "From axis 2 to axis 3.";
    c3: Position, "mm", "From axis 3 along the forearm to the wrist centre.";
    c4: Position, "mm", "From the wrist centre to the flange.";
});

sheet!(DhSheet "arm.dh" {
    d1: Position, "mm", "From the foot up to axis 2.";
    a2: Position, "mm", "Upper arm, negative.";
    a3: Position, "mm", "Forearm, negative.";
    d4: Position, "mm", "Sideways from axis 1 to axis 5.";
    d5: Position, "mm", "From axis 4 to axis 6.";
    d6: Position, "mm", "From axis 5 to the flange.";
});

sheet!(JointSheet "arm.joints" {
    min: Angle, "degrees", "Lower limit.";
    max: Angle, "degrees", "Upper limit.";
    speed: JointRate, "degrees/s", "Fastest.";
    acceleration: JointAcceleration, "degrees/s²", "Acceleration, where the maker states one.";
});

#[derive(Clone, Copy, Deserialize)]
pub(crate) enum CouplingSheet {
    #[serde(rename = "none")]
    None,
    #[serde(rename = "less-joint-2")]
    LessJoint2,
    #[serde(rename = "plus-joint-2")]
    PlusJoint2,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
pub(crate) enum LinearName {
    X,
    Y,
    Z,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "a text, a number, true or false is needed")]
pub(crate) enum OptionSheet {
    Flag(bool),
    Number(f64),
    Text(String),
}

/// Values that are looked at when they are read, so that a mistake is reported at its location.
macro_rules! value {
    ($($name:ident($type:ty, $as:literal) $good:expr, $need:literal;)*) => {$(
        #[derive(Clone, Copy, Deserialize)]
        #[serde(try_from = $as)]
        pub(crate) struct $name(pub(crate) $type);

        impl TryFrom<$type> for $name {
            type Error = String;

            fn try_from(value: $type) -> Result<$name, String> {
                let good: fn(&$type) -> bool = $good;
                let need = || format!("{value:?} is given, and {} is needed", $need);
                good(&value).then_some($name(value)).ok_or_else(need)
            }
        }
    )*};
}

/// Whether a number is above 0 and at most `most`.
fn above_0(value: f64, most: f64) -> bool {
    value > 0.0 && value <= most
}

// What no machine has by far is a slip of the pen: a figure in another unit, or a digit too many.
value! {
    Position(f64, "f64") |mm| mm.abs() <= 1e5, "a number from -100000 to 100000 mm";
    Place3([f64; 3], "[f64; 3]") |point| point.iter().all(|mm| mm.abs() <= 1e5), "three numbers from -100000 to 100000 mm";
    Direction([f64; 3], "[f64; 3]") |axis| axis.iter().all(|part| part.abs() <= 1e6), "three numbers from -1000000 to 1000000";
    Length(f64, "f64") |mm| above_0(*mm, 1e4), "a number above 0, at most 10000 mm,";
    Clearance(f64, "f64") |mm| above_0(*mm, 1e3), "a number above 0, at most 1000 mm,";
    Tolerance(f64, "f64") |mm| (1e-6..=10.0).contains(mm), "a number from 0.000001 to 10 mm";
    Retract(f64, "f64") |mm| (0.0..=1e3).contains(mm), "a number from 0 to 1000 mm";
    Rate(f64, "f64") |rate| above_0(*rate, 1e6), "a number above 0, at most 1000000 mm/min,";
    Acceleration(f64, "f64") |rate| above_0(*rate, 1e3), "a number above 0, at most 1000 m/s²,";
    Angle(f64, "f64") |degrees| degrees.abs() <= 1e6, "a number from -1000000 to 1000000 degrees";
    Lean(f64, "f64") |degrees| above_0(*degrees, 90.0), "a number above 0, at most 90 degrees,";
    SixAngles([f64; 6], "[f64; 6]") |six| six.iter().all(|degrees| degrees.abs() <= 360.0), "six numbers from -360 to 360 degrees";
    Range([f64; 2], "[f64; 2]") |range| range[0] < range[1] && range.iter().all(|degrees| degrees.abs() <= 3600.0), "two numbers from -3600 to 3600 degrees, the lower one first,";
    SixNumbers([f64; 6], "[f64; 6]") |six| six.iter().all(|number| number.abs() <= 1e5), "six numbers from -100000 to 100000";
    ArcSweep(f64, "f64") |degrees| (10.0..=180.0).contains(degrees), "a number from 10 to 180 degrees";
    OwnFrame(u32, "u32") |number| (1..=9).contains(number), "a whole number from 1 to 9";
    LoadNumber(u32, "u32") |number| (1..=10).contains(number), "a whole number from 1 to 10";
    Mass(f64, "f64") |kg| above_0(*kg, 5000.0), "a number above 0, at most 5000 kg,";
    LoadCenter([f64; 3], "[f64; 3]") |point| point.iter().all(|mm| mm.abs() <= 1e4), "three numbers from -10000 to 10000 mm";
    Percent(f64, "f64") |percent| above_0(*percent, 100.0), "a number above 0, at most 100 %,";
    JointRate(f64, "f64") |rate| above_0(*rate, 1e5), "a number above 0, at most 100000 degrees/s,";
    JointAcceleration(f64, "f64") |rate| above_0(*rate, 1e6), "a number above 0, at most 1000000 degrees/s²,";
    TurnRate(f64, "f64") |rate| above_0(*rate, 1e7), "a number above 0, at most 10000000 degrees/min,";
    TurnAcceleration(f64, "f64") |rate| above_0(*rate, 1e7), "a number above 0, at most 10000000 degrees/s²,";
    Speed(f64, "f64") |speed| (0.0..=1e6).contains(speed), "a number from 0 to 1000000 1/min";
    Wait(f64, "f64") |seconds| above_0(*seconds, 600.0), "a number above 0, at most 600 s,";
    Scale(f64, "f64") |scale| (1e-6..=1e6).contains(scale), "a number from 0.000001 to 1000000";
    Largest(f64, "f64") |most| above_0(*most, 1e15), "a number above 0, at most 10^15,";
    Decimals(u8, "u8") |value| *value <= 9, "0 to 9";
}

/// `R24`.
#[derive(Clone, Copy, Deserialize)]
#[serde(try_from = "String")]
pub(crate) struct OperatorParameter(pub(crate) u32);

impl TryFrom<String> for OperatorParameter {
    type Error = String;

    fn try_from(name: String) -> Result<OperatorParameter, String> {
        let number = name.strip_prefix('R').and_then(|number| number.parse().ok());
        let number = number.filter(|number| *number < 1000);
        number.map(OperatorParameter).ok_or_else(|| format!("{name:?} is not one of R0 to R999"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_stands_once_and_has_help() {
        let mut names: Vec<_> = keys().map(|key| (key.table, key.name)).collect();
        assert!(keys().all(|key| key.help.ends_with('.')));
        let all = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), all);
    }
}
