//! The G commands in their groups.
//!
//! A block has at most one command of a group (Programming Manual 06/2019, 4.3.1); one of each
//! modal group holds. The table is the only place that knows a command: what it does is a [`Code`].

use crate::event::Risk;
use crate::kernel::compensation::Outer;
use geom::INCH;
use program::Compensation;

/// What a G command does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Code {
    /// How the axes move from here on.
    Motion(Motion),
    /// `G4`.
    Dwell,
    /// `G9`: the axes stop at the end of this block.
    ExactBlock,
    /// `G74`, `G75`: axes to the reference point, to a fixed point.
    Home,
    /// `TRANS` and its kin.
    Frame(FrameCommand),
    /// The pole of polar coordinates.
    Pole(Origin),
    /// `G25` (false), `G26` (true): lower and upper limits.
    Limit(bool),
    /// `G63`: a straight cut in one block, with a tap in a compensating chuck.
    FloatingTap,
    /// Working plane, by the index of the axis perpendicular to it.
    Plane(usize),
    /// Cutter radius compensation.
    Compensation(Compensation),
    /// How compensation goes around outer corners.
    Corner(Outer),
    /// How compensation begins and ends: straight, or where need be around the first point (`KONT`).
    Approach { around: bool },
    /// Settable work offset, 500 for none.
    WorkOffset(u32),
    /// The path is smoothed within tolerances of machine data (`G642` to `G645`, the compressors), or not.
    Smoothing(Smoothing),
    /// `WALIMON` (true), `WALIMOF`: the limits of the work area hold.
    WorkArea(bool),
    /// `RTLION` (true), `RTLIOF`: the axes of a rapid go together.
    RapidsTogether(bool),
    /// Every offset is off for this block.
    MachineCoordinates,
    /// Length of a unit of the program in mm; whether feeds are counted in it too.
    Units(f64, bool),
    /// Coordinates count from the zero point or from where the tool is.
    Absolute(bool),
    /// What `F` means.
    Feed(FeedType),
    /// What a value of X means.
    Diameter(Diameter),
    /// Vectors of the tool axis count in the work frame or in the machine's.
    VectorsInWorkFrame(bool),
    /// The tool turns on the great circle between two orientations, or its axes turn evenly.
    GreatCircle(bool),
    /// The control smooths how the tool turns, by its setting data, or not.
    TurnsLoosely(bool),
    /// The frame of the part's or the tool's rotation is deleted.
    FrameOff,
    /// How the control drives along the path, not where: dynamics, rounding and compression within
    /// the machine's tolerances, interpolation of the orientation between given ends.
    NoMotion,
    /// `LFON`: axes are lifted when the program is stopped.
    Retract,
    /// Known and not supported, with the reason.
    Unsupported(&'static str),
}

/// By how much the control leaves the path while it smooths it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Smoothing {
    /// It does not.
    #[default]
    Off,
    /// `G60`: the axes stop at the end of each block.
    ExactStop,
    /// By the tolerance of `CTOL`, where the program says one.
    Programmed,
    /// `G644`: by machine data, whatever the program says.
    MachineData,
}

/// How the axes move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    /// `G0`.
    Rapid,
    /// `G1`.
    Line,
    /// `G2`.
    Clockwise,
    /// `G3`.
    CounterClockwise,
    /// `CIP`.
    ThroughPoint,
    /// `CT`.
    Tangential,
    /// `G33`.
    Thread,
    /// `G331`: a tap goes in with the spindle.
    TapIn,
    /// `G332`: it comes out again.
    TapOut,
}

/// What a pole counts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// `G110`: the last programmed position.
    Position,
    /// `G111`: the zero point of the program.
    Zero,
    /// `G112`: the last pole.
    Pole,
}

/// What a value of X means on a lathe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Diameter {
    /// `DIAMOF`: a radius.
    Off,
    /// `DIAMON`: a diameter.
    On,
    /// `DIAM90`: a diameter where it is absolute.
    Absolute,
}

/// What `F` means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FeedType {
    /// `G94`.
    PerMinute,
    /// `G95`.
    PerTurn,
    /// `G93`.
    InverseTime,
}

/// The programmable frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FrameCommand {
    /// `TRANS` (false), `ATRANS` (true: on top of what is there).
    Translate(bool),
    /// `ROT`, `AROT`.
    Rotate(bool),
    /// `SCALE`, `ASCALE`.
    Scale(bool),
    /// `MIRROR`, `AMIRROR`: the axes that are named.
    Mirror(bool),
    /// `G58`: the absolute translation of the axes that are named.
    Coarse,
    /// `G59`: their additive translation.
    Fine,
}

/// A G command.
pub(super) struct Command {
    /// Its name.
    pub name: &'static str,
    /// Number of its group.
    pub group: u8,
    /// What it does.
    pub code: Code,
}

/// Number of the last group.
pub(crate) const GROUPS: usize = 64;

/// The command with that index.
#[inline]
pub(super) fn at(index: u8) -> &'static Command {
    COMMANDS.get(usize::from(index)).unwrap_or(&COMMANDS[0])
}

/// The index of the command of that name.
pub(super) fn named(name: &str) -> Option<u8> {
    COMMANDS.iter().position(|command| command.name == name).map(|index| index as u8)
}

/// The index of the command `G` with that number. `G505` to `G599` are [`settable_offset`]s.
#[inline]
pub(super) fn numbered(number: u32) -> Option<u8> {
    NUMBERED.get(number as usize).copied().filter(|index| *index != NONE)
}

/// Whether `G` with that number is one of the further settable work offsets.
pub(super) fn settable_offset(number: u32) -> bool {
    (505..=599).contains(&number)
}

const fn g(name: &'static str, group: u8, code: Code) -> Command {
    Command { name, group, code }
}

const fn same(name: &'static str, group: u8) -> Command {
    g(name, group, Code::NoMotion)
}

const fn not(name: &'static str, group: u8, reason: &'static str) -> Command {
    g(name, group, Code::Unsupported(reason))
}

const SPLINE: &str = "splines and polynomials";
const FEED_PROFILE: &str = "a feed that changes along the block";
const THREAD: &str = "threads whose pitch changes";
const APPROACH: &str = "smooth approach and retraction";
const SPEED: &str = "constant cutting speed";
const TOOL_FRAME: &str = "frames from the tool's direction";
const COMPENSATION_3D: &str = "compensation in space";

/// Every G command by group: Programming Manual 840D sl 06/2019, 4.3; Fundamentals 10.2004, 12.3.
/// What is not here is not a G command, and an error.
pub(super) static COMMANDS: &[Command] = &[
    // 1: motion, modal
    g("G0", 1, Code::Motion(Motion::Rapid)),
    g("G1", 1, Code::Motion(Motion::Line)),
    g("G2", 1, Code::Motion(Motion::Clockwise)),
    g("G3", 1, Code::Motion(Motion::CounterClockwise)),
    g("CIP", 1, Code::Motion(Motion::ThroughPoint)),
    g("CT", 1, Code::Motion(Motion::Tangential)),
    not("ASPLINE", 1, SPLINE),
    not("BSPLINE", 1, SPLINE),
    not("CSPLINE", 1, SPLINE),
    not("POLY", 1, SPLINE),
    not("INVCW", 1, SPLINE),
    not("INVCCW", 1, SPLINE),
    g("G33", 1, Code::Motion(Motion::Thread)),
    not("G34", 1, THREAD),
    not("G35", 1, THREAD),
    g("G331", 1, Code::Motion(Motion::TapIn)),
    g("G332", 1, Code::Motion(Motion::TapOut)),
    // 2: for one block
    g("G4", 2, Code::Dwell),
    g("G74", 2, Code::Home),
    g("G75", 2, Code::Home),
    g("G63", 2, Code::FloatingTap),
    not("G147", 2, APPROACH),
    not("G148", 2, APPROACH),
    not("G247", 2, APPROACH),
    not("G248", 2, APPROACH),
    not("G347", 2, APPROACH),
    not("G348", 2, APPROACH),
    // 3: programmable frame, limits, poles
    g("TRANS", 3, Code::Frame(FrameCommand::Translate(false))),
    g("ATRANS", 3, Code::Frame(FrameCommand::Translate(true))),
    g("ROT", 3, Code::Frame(FrameCommand::Rotate(false))),
    g("AROT", 3, Code::Frame(FrameCommand::Rotate(true))),
    g("SCALE", 3, Code::Frame(FrameCommand::Scale(false))),
    g("ASCALE", 3, Code::Frame(FrameCommand::Scale(true))),
    g("MIRROR", 3, Code::Frame(FrameCommand::Mirror(false))),
    g("AMIRROR", 3, Code::Frame(FrameCommand::Mirror(true))),
    g("G58", 3, Code::Frame(FrameCommand::Coarse)),
    g("G59", 3, Code::Frame(FrameCommand::Fine)),
    not("ROTS", 3, "rotation by solid angles"),
    not("AROTS", 3, "rotation by solid angles"),
    g("G25", 3, Code::Limit(false)),
    g("G26", 3, Code::Limit(true)),
    g("G110", 3, Code::Pole(Origin::Position)),
    g("G111", 3, Code::Pole(Origin::Zero)),
    g("G112", 3, Code::Pole(Origin::Pole)),
    // 6: plane
    g("G17", 6, Code::Plane(2)),
    g("G18", 6, Code::Plane(1)),
    g("G19", 6, Code::Plane(0)),
    // 7: cutter radius compensation
    g("G40", 7, Code::Compensation(Compensation::Off)),
    g("G41", 7, Code::Compensation(Compensation::Left(None))),
    g("G42", 7, Code::Compensation(Compensation::Right(None))),
    // 8: settable work offset
    g("G500", 8, Code::WorkOffset(500)),
    g("G54", 8, Code::WorkOffset(54)),
    g("G55", 8, Code::WorkOffset(55)),
    g("G56", 8, Code::WorkOffset(56)),
    g("G57", 8, Code::WorkOffset(57)),
    // 9: offsets off, for one block
    g("G53", 9, Code::MachineCoordinates),
    g("G153", 9, Code::MachineCoordinates),
    g("SUPA", 9, Code::MachineCoordinates),
    // 10 to 12: exact stop, continuous path
    g("G60", 10, Code::Smoothing(Smoothing::ExactStop)),
    g("G64", 10, Code::Smoothing(Smoothing::Off)),
    // By ADIS, which is 0 where the program does not say it.
    g("G641", 10, Code::Smoothing(Smoothing::Off)),
    g("G642", 10, Code::Smoothing(Smoothing::Programmed)),
    g("G643", 10, Code::Smoothing(Smoothing::Programmed)),
    g("G644", 10, Code::Smoothing(Smoothing::MachineData)),
    g("G645", 10, Code::Smoothing(Smoothing::Programmed)),
    g("G9", 11, Code::ExactBlock),
    same("G601", 12),
    same("G602", 12),
    same("G603", 12),
    // 13: units
    g("G70", 13, Code::Units(INCH, false)),
    g("G71", 13, Code::Units(1.0, false)),
    g("G700", 13, Code::Units(INCH, true)),
    g("G710", 13, Code::Units(1.0, true)),
    // 14: absolute, incremental
    g("G90", 14, Code::Absolute(true)),
    g("G91", 14, Code::Absolute(false)),
    // 15: feed
    g("G93", 15, Code::Feed(FeedType::InverseTime)),
    g("G94", 15, Code::Feed(FeedType::PerMinute)),
    g("G95", 15, Code::Feed(FeedType::PerTurn)),
    not("G96", 15, SPEED),
    not("G961", 15, SPEED),
    not("G962", 15, SPEED),
    not("G97", 15, SPEED),
    not("G971", 15, SPEED),
    not("G972", 15, SPEED),
    // 16 to 18: feed in arcs, approach to and corners of a compensated contour
    same("CFC", 16),
    same("CFTCP", 16),
    same("CFIN", 16),
    g("NORM", 17, Code::Approach { around: false }),
    g("KONT", 17, Code::Approach { around: true }),
    g("KONTC", 17, Code::Approach { around: true }),
    g("KONTT", 17, Code::Approach { around: true }),
    g("G450", 18, Code::Corner(Outer::Arc)),
    g("G451", 18, Code::Corner(Outer::Intersection)),
    // 21 to 24: jerk, kind of compensation, collision look-ahead, feed-forward
    same("BRISK", 21),
    same("SOFT", 21),
    same("DRIVE", 21),
    same("CUT2D", 22),
    same("CUT2DF", 22),
    not("CUT3DC", 22, COMPENSATION_3D),
    not("CUT3DF", 22, COMPENSATION_3D),
    not("CUT3DFF", 22, COMPENSATION_3D),
    same("CDOF", 23),
    same("CDOF2", 23),
    same("CDON", 23),
    same("FFWOF", 24),
    same("FFWON", 24),
    // 25: what orientations count in
    g("ORIWKS", 25, Code::VectorsInWorkFrame(true)),
    g("ORIMKS", 25, Code::VectorsInWorkFrame(false)),
    // 28 to 30: work area limits, diameters, compression
    g("WALIMOF", 28, Code::WorkArea(false)),
    g("WALIMON", 28, Code::WorkArea(true)),
    g("DIAMOF", 29, Code::Diameter(Diameter::Off)),
    g("DIAMON", 29, Code::Diameter(Diameter::On)),
    g("DIAM90", 29, Code::Diameter(Diameter::Absolute)),
    g("COMPOF", 30, Code::Smoothing(Smoothing::Off)),
    g("COMPON", 30, Code::Smoothing(Smoothing::Programmed)),
    g("COMPCURV", 30, Code::Smoothing(Smoothing::Programmed)),
    g("COMPCAD", 30, Code::Smoothing(Smoothing::Programmed)),
    g("COMPSURF", 30, Code::Smoothing(Smoothing::Programmed)),
    // 34: smoothing of the orientation
    g("OSOF", 34, Code::TurnsLoosely(false)),
    g("OSC", 34, Code::TurnsLoosely(true)),
    g("OSS", 34, Code::TurnsLoosely(true)),
    g("OSSE", 34, Code::TurnsLoosely(true)),
    g("OSD", 34, Code::TurnsLoosely(true)),
    g("OST", 34, Code::TurnsLoosely(true)),
    // 37: how the feed changes within a block
    same("FNORM", 37),
    not("FLIN", 37, FEED_PROFILE),
    not("FCUB", 37, FEED_PROFILE),
    // 41, 46: whether a thread is left when the program stops, and the plane of that way
    g("LFON", 41, Code::Retract),
    same("LFOF", 41),
    same("LFTXT", 46),
    same("LFWP", 46),
    same("LFPOS", 46),
    // 45 to 51: path reference, language, contour end, point to point, orientation
    same("SPATH", 45),
    same("UPATH", 45),
    same("G290", 47),
    not("G291", 47, "the language of other makers"),
    same("G460", 48),
    same("G461", 48),
    same("G462", 48),
    same("CP", 49),
    not("PTP", 49, "point-to-point motion of a transformation"),
    same("ORIEULER", 50),
    same("ORIRPY", 50),
    same("ORIRPY2", 50),
    g("ORIVECT", 51, Code::GreatCircle(true)),
    g("ORIPLANE", 51, Code::GreatCircle(true)),
    g("ORIAXES", 51, Code::GreatCircle(false)),
    not("ORIPATH", 51, "orientation from the path"),
    // 52, 53: frames from part and tool
    g("PAROTOF", 52, Code::FrameOff),
    not("PAROT", 52, TOOL_FRAME),
    g("TOROTOF", 53, Code::FrameOff),
    not("TOROT", 53, TOOL_FRAME),
    not("TOFRAME", 53, TOOL_FRAME),
    // 55, 57, 59, 61: rapid interpolation, corner slow-down, dynamics, smoothing
    g("RTLION", 55, Code::RapidsTogether(true)),
    g("RTLIOF", 55, Code::RapidsTogether(false)),
    same("FENDNORM", 57),
    same("DYNNORM", 59),
    same("DYNPOS", 59),
    same("DYNROUGH", 59),
    same("DYNSEMIFIN", 59),
    same("DYNFINISH", 59),
    same("DYNPREC", 59),
    g("ORISOF", 61, Code::TurnsLoosely(false)),
    g("ORISON", 61, Code::TurnsLoosely(true)),
];

/// What a program leaves of a modal group that no other part of the state follows.
pub(crate) struct Delivered {
    /// Number of the group.
    pub group: u8,
    /// The commands that the next program may find: the one that is active as the maker delivers the control (MD20150), and those
    /// that change nothing for it.
    free: &'static [&'static str],
    /// What any other command of the group is reported as.
    pub risk: Risk,
}

const fn left(
    group: u8,
    free: &'static [&'static str],
    what: &'static str,
    help: &'static str,
) -> Delivered {
    Delivered { group, free, risk: Risk::left_on(what, help) }
}

/// What each program finds of the groups that it need not say: NC programming 12/2019, 4.3 (columns "STD" and "MD20150"), and
/// Fundamentals 10.2004, 12.3 (column "SAG").
pub(crate) static DELIVERED: &[Delivered] = &[
    left(
        10,
        &["G60", "G64"],
        "ends with a smoothed path (G641 to G645)",
        "write G64 before the end",
    ),
    left(12, &["G601"], "ends with G602 or G603", "write G601 before the end"),
    left(
        16,
        &["CFC"],
        "ends with CFTCP or CFIN, by which F of the next one would count at the tool's centre",
        "write CFC before the end",
    ),
    left(17, &["NORM"], "ends with KONT, KONTC or KONTT", "write NORM before the end"),
    left(18, &["G450"], "ends with G451", "write G450 before the end"),
    left(21, &["BRISK"], "ends with SOFT or DRIVE", "write BRISK before the end"),
    left(22, &["CUT2D"], "ends with CUT2DF", "write CUT2D before the end"),
    left(23, &["CDOF"], "ends with CDON or CDOF2", "write CDOF before the end"),
    left(24, &["FFWOF"], "ends with FFWON", "write FFWOF before the end"),
    left(28, &["WALIMON"], "ends with WALIMOF", "write WALIMON before the end"),
    left(30, &["COMPOF"], "ends with a compressor", "write COMPOF before the end"),
    left(
        34,
        &["OSOF"],
        "ends with a smoothed orientation (OSC to OST)",
        "write OSOF before the end",
    ),
    left(37, &["FNORM"], "ends with another feed profile than FNORM", "write FNORM before the end"),
    left(41, &["LFOF"], "ends with LFON", "write LFOF before the end"),
    left(45, &["SPATH"], "ends with UPATH", "write SPATH before the end"),
    left(46, &["LFTXT"], "ends with LFWP or LFPOS", "write LFTXT before the end"),
    left(47, &["G290"], "ends in another language than G290", "write G290 before the end"),
    left(48, &["G460"], "ends with G461 or G462", "write G460 before the end"),
    left(49, &["CP"], "ends with another motion than CP", "write CP before the end"),
    left(50, &["ORIEULER"], "ends with ORIRPY or ORIRPY2", "write ORIEULER before the end"),
    left(52, &["PAROTOF"], "ends with PAROT", "write PAROTOF before the end"),
    left(53, &["TOROTOF"], "ends with a frame of the tool", "write TOROTOF before the end"),
    left(55, &["RTLION"], "ends with RTLIOF", "write RTLION before the end"),
    left(
        57,
        &["FENDNORM"],
        "ends with another corner than FENDNORM",
        "write FENDNORM before the end",
    ),
    left(59, &["DYNNORM"], "ends with dynamics other than DYNNORM", "write DYNNORM before the end"),
    left(61, &["ORISOF"], "ends with ORISON", "write ORISOF before the end"),
];

impl Delivered {
    /// Whether the next program may find the command of that index plus one, 0 where the program has said none.
    pub fn allows(&self, said: u8) -> bool {
        said.checked_sub(1).is_none_or(|index| self.free.contains(&at(index).name))
    }
}

/// Whether F holds on the contour for the command of G group 16 with that index plus one: `CFC`, and 0 for none said.
pub(crate) fn is_constant_on_contour(said: u8) -> bool {
    said.checked_sub(1).is_none_or(|index| at(index).name == "CFC")
}

/// Largest `G` number with an entry, plus one.
const NUMBERS: usize = 1000;

/// No index.
const NONE: u8 = u8::MAX;

/// Index in [`COMMANDS`] by number.
static NUMBERED: [u8; NUMBERS] = index_numbers();

const fn index_numbers() -> [u8; NUMBERS] {
    let mut indices = [NONE; NUMBERS];
    let mut i = 0;
    while i < COMMANDS.len() {
        if let Some(number) = number_of(COMMANDS[i].name.as_bytes()) {
            indices[number] = i as u8;
        }
        i += 1;
    }
    indices
}

const fn number_of(name: &[u8]) -> Option<usize> {
    let mut number = 0;
    let mut i = 1;
    while i < name.len() {
        if !name[i].is_ascii_digit() {
            return None;
        }
        number = number * 10 + (name[i] - b'0') as usize;
        i += 1;
    }
    if name[0] == b'G' && name.len() > 1 { Some(number) } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_is_found_by_its_name_and_stands_once() {
        assert!(COMMANDS.len() < usize::from(NONE));
        for command in COMMANDS {
            assert!(std::ptr::eq(at(named(command.name).unwrap()), command), "{}", command.name);
            assert!(usize::from(command.group) < GROUPS);
        }
        assert_eq!(at(numbered(642).unwrap()).name, "G642");
        assert!(numbered(43).is_none() && numbered(5000).is_none());
    }

    /// A group of which nobody says what its end leaves would be left on unseen.
    #[test]
    fn of_each_group_it_is_known_what_a_program_leaves() {
        // For one block only.
        let passing = [2, 3, 9, 11];
        // Followed by fields of the state, which say at the end what is on: plane, compensation, units, G91, feed, diameters.
        let followed = [6, 7, 13, 14, 15, 29];
        // Each program says its own before it matters: how it moves, its work offset (`work-offset`), how the tool turns
        // (`orientation-way`).
        let said_anew = [1, 8, 25, 51];
        for command in COMMANDS {
            let ways = usize::from(passing.contains(&command.group))
                + usize::from(followed.contains(&command.group))
                + usize::from(said_anew.contains(&command.group))
                + DELIVERED.iter().filter(|group| group.group == command.group).count();
            assert_eq!(ways, 1, "{}", command.name);
        }
        for group in DELIVERED {
            for name in group.free {
                assert_eq!(at(named(name).unwrap()).group, group.group, "{name}");
            }
        }
    }
}
