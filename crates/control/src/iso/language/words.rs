//! What G and M words mean, and which exclude each other in a block. Which of them a dialect has
//! stands in its table ([`crate::iso::dialects`]); what is not in a table is not understood.

use program::CoolantSwitch;

/// The meaning of a G word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum G {
    /// `G0` to `G3` and the like.
    Motion(Motion),
    /// `G73` to `G89`.
    Cycle(Canned),
    /// `G80`.
    CancelCycle,
    /// `G17` to `G19`.
    Plane(Plane),
    /// `G90`, `G91`.
    Incremental(bool),
    /// `G90.1`, `G91.1`: the centres of arcs.
    CentersAbsolute(bool),
    /// `G93` to `G95`.
    FeedMode(FeedMode),
    /// `G20`, `G21`, or `G70`, `G71`.
    Inches(bool),
    /// `G40` to `G42`.
    Compensation(Side),
    /// With the diameter in the block (`G41.1`).
    DynamicCompensation(Side),
    /// Lean of a wire by the control, `G50` to `G52`.
    Taper(Side),
    /// `G43`.
    Length,
    /// `G43.4`: the control keeps the tool centre point.
    ToolCenter,
    /// `G43.1`.
    DynamicLength,
    /// `G49`.
    CancelLength,
    /// `G98`, `G99`: holes end at the initial level, or at R.
    ReturnToR(bool),
    /// By its number in the neutral program: `G54` is 54.
    WorkOffset(u32),
    /// `G54.1 P`, `G154 P`: those after `G59`.
    FurtherOffset {
        /// How many there are.
        most: u32,
    },
    /// How the path is smoothed, or a mode that is off anyway: nothing moves elsewhere for it. The
    /// letters may stand next to it.
    Neutral(&'static [u8]),
    /// `G61`, `G61.1`, `G64`: what happens at corners.
    Path(Path),
    /// `G63` of FANUC: overrides and feed hold do nothing from here on.
    LockOverrides,
    /// Haas `G187`: P how smooth, E by how much corners are cut; without E as setting 85 says.
    Smoothness,
    /// `G68`
    Turn,
    /// `G68.2`
    Tilt,
    /// `G69`
    Upright,
    /// `G51`
    Scale(bool),
    /// `G51.1`
    Mirror(bool),
    /// `G16`
    Polar(bool),
    /// Lathe: X is a diameter, `G7`.
    Diameter(bool),
    /// `G96`; `G97`, where there is such a thing.
    SurfaceSpeed(bool),
    /// `G4`.
    Dwell,
    /// An exact stop at the end of the block.
    ExactBlock,
    /// The work zero that turns with the table, on or off.
    DynamicOffset(bool),
    /// `G28`.
    Home,
    /// `G30`.
    SecondHome,
    /// `G28.1`, `G30.1`
    StoreHome {
        /// `G30.1`, not `G28.1`.
        second: bool,
    },
    /// `G29`
    FromHome,
    /// `G53`.
    Machine,
    /// `G5 P`, `G5.1 Q`, `G8 P`: on with this number and off with 0.
    LookAhead {
        /// The letter of the number.
        letter: u8,
        /// The number that switches it on.
        on: u32,
    },
    /// `G53.1`.
    SwingToTilt,
    /// `G65`, `G66`: the macro that P names, once or after each move.
    MacroCall {
        /// After each move (`G66`).
        modal: bool,
    },
    /// `G67`.
    CancelMacroCall,
    /// `G31`
    Skip,
    /// `G60`
    OneSided,
    /// `G10`
    WriteData,
    /// `G92`
    ShiftHere,
    /// `G52`
    ShiftTo,
    /// `G92.1`; with `keep` `G92.2`
    CancelShift {
        /// The shift can be restored.
        keep: bool,
    },
    /// `G92.3`
    RestoreShift,
    /// `G12`, `G13`
    Pocket {
        /// Clockwise, seen against the normal of the plane.
        clockwise: bool,
    },
    /// Haas `G70`, `G71`, `G72`
    Pattern(Pattern),
}

/// Holes in a pattern, each made by the active cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// `G70`.
    Circle,
    /// `G71`.
    Arc,
    /// `G72`.
    Line,
}

/// What to do about a number without its point.
pub(crate) const WHOLE_NUMBERS_HELP: &str = "write the point, or say what whole numbers count: `--whole-numbers units` where X10 is 10 mm, \
                                             `--whole-numbers increments` where it is 0.010 mm (FANUC parameter 3401#0, Haas setting 162)";

/// Interpolation (`G0` to `G3` and the like).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// `G0`.
    Rapid,
    /// `G1`.
    Line,
    /// `G2`, `G3`.
    Arc {
        /// Clockwise, seen against the normal of the plane.
        clockwise: bool,
    },
    /// Cubic or, `G5.1`, quadratic spline.
    Spline {
        /// Cubic (`G5`), not quadratic.
        cubic: bool,
    },
    /// `G5.2`: control points of a NURBS.
    Nurbs,
    /// `G5.3`: the tool goes along it.
    EndOfNurbs,
    /// `G33`
    Thread,
    /// `G33.1`
    RigidTap,
    /// `G38.2` to `G38.5`: until the probe lets go or touches, with or without an error where it does not.
    Probe {
        /// Away from what is touched.
        away: bool,
        /// It is an error where the probe does not answer.
        must_answer: bool,
    },
}

/// The canned cycles that the neutral program has a record for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Canned {
    /// `G73`.
    BreakChip,
    /// `G74`.
    LeftTap,
    /// `G81`.
    Drill,
    /// `G82`.
    DwellDrill,
    /// `G83`.
    Deep,
    /// `G84`.
    Tap,
    /// `G85`.
    Ream,
    /// `G86`.
    Bore,
    /// `G89`.
    DwellReam,
    /// `G88`: out of the hole by hand.
    HandBore,
    /// `G76`.
    FineBore,
    /// `G87`, or `G77`.
    BackBore,
}

/// The working plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// `G17`.
    Xy,
    /// `G18`.
    Zx,
    /// `G19`.
    Yz,
}

/// What happens at corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// The axes stop at each.
    ExactStop,
    /// The path is kept to.
    Exact,
    /// They are cut: by P, and lines within Q are made one, where `bounded` says that the control has these words.
    Blend {
        /// The control has these words.
        bounded: bool,
    },
}

/// What F means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeedMode {
    /// `G94`.
    PerMinute,
    /// `G95`.
    PerTurn,
    /// `G93`.
    InverseTime,
}

/// On which side of the path the tool is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// `G40`.
    Off,
    /// `G41`.
    Left,
    /// `G42`.
    Right,
}

/// The meaning of an M word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum M {
    /// `M0`.
    Stop,
    /// `M1`.
    OptionalStop,
    /// `M2`, `M30`.
    End,
    /// `M3`.
    Clockwise,
    /// `M4`.
    CounterClockwise,
    /// `M5`.
    SpindleOff,
    /// `M19`.
    Orient,
    /// `M6`.
    ChangeTool,
    /// `M61`: which tool is in.
    ToolIsIn,
    /// `M7`.
    Mist,
    /// `M8`.
    Flood,
    /// Coolant through the spindle.
    Through,
    /// That off.
    ThroughOff,
    /// `M9`.
    CoolantOff,
    /// `M29`.
    RigidTap,
    /// `M98`: the subprogram that P names.
    Call,
    /// Haas `M97`: the one that begins at a block of this program.
    CallBlock,
    /// `M99`: back to the caller.
    Return,
    /// `M70`, `M73`: the modes are kept for `M72`, and for the end of the subroutine too.
    SaveModes {
        /// Until the subroutine ends.
        until_return: bool,
    },
    /// `M71`.
    ForgetModes,
    /// `M72`.
    RestoreModes,
    /// The wire is threaded.
    ThreadWire,
    /// The wire is cut.
    CutWire,
    /// Nothing moves for it; the letters may stand next to it.
    Neutral(&'static [u8]),
    /// `M49`: overrides do nothing from here on.
    LockOverrides,
    /// `M50`, `M51`, `M53`: an override, or the feed hold, does nothing from here on where P is 0.
    Override,
    /// `M52`: a pin multiplies the feed from here on, unless P is 0.
    AdaptiveFeed,
    /// `M117`: a text for the operator.
    Message,
    /// Marlin's `M18`, `M84`: with S after how many idle seconds the axes are let go.
    IdleTime,
    /// `M62` to `M65`: the digital output that P names.
    Digital {
        /// On, not off.
        on: bool,
        /// With the next move, not at once.
        with_motion: bool,
    },
    /// `M67`, `M68`: the analog output that E names, to Q.
    Analog {
        /// With the next move, not at once.
        with_motion: bool,
    },
    /// `M66`: waits for the input that P or E names.
    Input,
    /// The kinematics that follow the tip from here on, or those of the axes themselves (`switchkins` of LinuxCNC).
    FollowTip(bool),
    /// A program that the user has added as an M function (LinuxCNC's `M100` to `M199`); P and Q are
    /// handed to it.
    Program(u32),
}

impl M {
    /// What it does with the coolant.
    pub(in crate::iso) fn coolant(self) -> Option<CoolantSwitch> {
        let all = [
            CoolantSwitch::Flood,
            CoolantSwitch::Mist,
            CoolantSwitch::Through,
            CoolantSwitch::Off,
            CoolantSwitch::ThroughOff,
        ];
        all.into_iter().find(|switch| M::of_coolant(*switch) == self)
    }

    /// The function that does this with the coolant.
    pub(in crate::iso) fn of_coolant(switch: CoolantSwitch) -> M {
        match switch {
            CoolantSwitch::Flood => M::Flood,
            CoolantSwitch::Mist => M::Mist,
            CoolantSwitch::Through => M::Through,
            CoolantSwitch::Off => M::CoolantOff,
            CoolantSwitch::ThroughOff => M::ThroughOff,
        }
    }
}

/// Words of one group exclude each other in a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// What acts in its own block (group 00).
    OneShot,
    /// Interpolation (group 01).
    Motion,
    /// Canned cycles, where they are no interpolation (group 09).
    Cycle,
    /// The working plane.
    Plane,
    /// Absolute or incremental.
    Distance,
    /// The same of the centres of arcs.
    ArcDistance,
    /// What F means.
    FeedMode,
    /// What lengths count.
    Units,
    /// Cutter radius compensation.
    Compensation,
    /// Tool length.
    Length,
    /// Where a cycle ends.
    Return,
    /// Work offset.
    WorkOffset,
    /// What happens at corners.
    Path,
    /// What S means.
    SpindleMode,
    /// Turned and tilted coordinates.
    Tilt,
    /// Scaled coordinates.
    Scaling,
    /// Mirrored coordinates.
    Mirror,
    /// Lean of the wire.
    Taper,
    /// Calls of macros.
    Macro,
    /// Polar coordinates.
    Polar,
    /// Diameter or radius (lathe).
    Diameter,
    /// M: stops, the end, calls.
    Flow,
    /// M: tool change.
    ToolChange,
    /// M: spindle.
    Spindle,
    /// M: coolant.
    Coolant,
    /// M: overrides.
    Override,
    /// M: signals.
    Output,
    /// M: modes that are kept.
    Modes,
    /// M: the wire.
    Wire,
    /// M: which kinematics are on.
    Kinematics,
    /// The work zero that turns with the table.
    DynamicOffset,
}

impl Group {
    /// How many groups there are.
    pub(in crate::iso) const COUNT: usize = Group::DynamicOffset as usize + 1;

    /// The bit of the group in a set of groups.
    pub(in crate::iso) const fn bit(self) -> u32 {
        1 << self as u32
    }
}

/// A G word: ten times its number (`G43.4` is 434), its group, its meaning.
pub type GRow = (u16, Group, G);

/// An M word: its number, its group, its meaning.
pub type MRow = (u16, Group, M);

/// A word that exists and is refused on purpose, with the reason.
pub type Refused = (u16, &'static str);

/// What a word may begin with, in addition to the letters: LinuxCNC's polar words and the number of a spindle.
pub(in crate::iso) const LETTERS: [u8; 30] = *b"ABCDEFGHIJKLMNOPQRSTUVWXYZ@$ ^";

/// Where each byte stands in [`LETTERS`]; 0 where it does not.
const PLACES: [u8; 128] = {
    let (mut places, mut at) = ([0; 128], 0);
    while at < LETTERS.len() {
        places[LETTERS[at] as usize] = at as u8;
        at += 1;
    }
    places
};

/// Where a letter, which is one of them, stands in [`LETTERS`].
#[inline]
pub(crate) const fn index(letter: u8) -> usize {
    debug_assert!(letter == LETTERS[0] || PLACES[(letter & 0x7F) as usize] > 0);
    PLACES[(letter & 0x7F) as usize] as usize
}

/// The bit of a letter in a set of letters.
#[inline]
pub(crate) const fn bit(letter: u8) -> u32 {
    1 << index(letter)
}

/// The set of these letters, by [`bit`].
pub(in crate::iso) const fn set(letters: &[u8]) -> u32 {
    let (mut bits, mut at) = (0, 0);
    while at < letters.len() {
        bits |= bit(letters[at]);
        at += 1;
    }
    bits
}

/// The words of one dialect, found by number.
pub struct Dictionary {
    /// By ten times the number.
    g: [Option<(Group, G)>; 2600],
    /// By the number.
    m: [Option<(Group, M)>; 500],
    refused_g: &'static [Refused],
    refused_m: &'static [Refused],
    /// The letters that the dialect has, by [`bit`].
    pub(in crate::iso) letters: u32,
    /// The longest block in bytes, blanks and comments apart.
    pub(in crate::iso) longest: usize,
}

/// Its 2900 places say little.
impl std::fmt::Debug for Dictionary {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("Dictionary").field("words", &self.vocabulary().len()).finish()
    }
}

impl Dictionary {
    /// No words, with these letters; a block has `longest` bytes at most, blanks and comments apart.
    pub const fn new(letters: &[u8], longest: usize) -> Dictionary {
        Dictionary {
            g: [None; 2600],
            m: [None; 500],
            refused_g: &[],
            refused_m: &[],
            letters: set(letters),
            longest,
        }
    }

    /// With these words, too.
    pub const fn with(mut self, g: &[GRow], m: &[MRow]) -> Dictionary {
        let mut row = 0;
        while row < g.len() {
            self.g[g[row].0 as usize] = Some((g[row].1, g[row].2));
            row += 1;
        }
        row = 0;
        while row < m.len() {
            self.m[m[row].0 as usize] = Some((m[row].1, m[row].2));
            row += 1;
        }
        self
    }

    /// With reasons for what it refuses.
    pub const fn refusing(mut self, g: &'static [Refused], m: &'static [Refused]) -> Dictionary {
        (self.refused_g, self.refused_m) = (g, m);
        self
    }

    /// Its words: `G0`, `G43.4`, `M30`.
    pub(in crate::iso) fn vocabulary(&self) -> Vec<String> {
        let g = self.g.iter().enumerate().filter(|(_, row)| row.is_some());
        let g = g.map(|(tenths, _)| match tenths % 10 {
            0 => format!("G{}", tenths / 10),
            tenth => format!("G{}.{tenth}", tenths / 10),
        });
        let m = self.m.iter().enumerate().filter(|(_, row)| row.is_some());
        g.chain(m.map(|(number, _)| format!("M{number}"))).collect()
    }

    /// Group and meaning of the G word with this number.
    pub(in crate::iso) fn g(&self, number: f64) -> Option<(Group, G)> {
        *self.g.get(tenths(number)?)?
    }

    /// Group and meaning of the M word with this number.
    pub(in crate::iso) fn m(&self, number: f64) -> Option<(Group, M)> {
        *self.m.get(tenths(number).filter(|t| t % 10 == 0)? / 10)?
    }

    /// Why a word that the dialect does not take is refused, where there is more to say than that it
    /// is not known.
    pub(in crate::iso) fn why_refused(&self, letter: u8, number: f64) -> Option<&'static str> {
        let (table, number) = match letter {
            b'G' => (self.refused_g, tenths(number)?),
            b'M' => (self.refused_m, tenths(number)? / 10),
            _ => return None,
        };
        table.iter().find(|(n, _)| usize::from(*n) == number).map(|(_, reason)| *reason)
    }
}

/// Ten times a number that has at most one decimal and is below 1000.
fn tenths(number: f64) -> Option<usize> {
    let exact = number * 10.0;
    // What is below 0 or no number becomes 0, and is not near to it.
    let tenths = (exact + 0.5) as u32;
    (tenths < 10_000 && (exact - f64::from(tenths)).abs() < 1e-9).then_some(tenths as usize)
}
