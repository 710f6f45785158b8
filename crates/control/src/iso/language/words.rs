//! What G and M words mean, and which exclude each other in a block. Which of them a dialect has
//! stands in its table ([`crate::iso::dialects`]); what is not in a table is not understood.

/// The meaning of a G word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum G {
    Motion(Motion),
    Cycle(Canned),
    CancelCycle,
    Plane(Plane),
    Incremental(bool),
    CentersAbsolute(bool),
    FeedMode(FeedMode),
    Inches(bool),
    Compensation(Side),
    /// With the diameter in the block (`G41.1`).
    DynamicCompensation(Side),
    /// Lean of a wire by the control, `G50` to `G52`.
    Taper(Side),
    Length,
    ToolCenter,
    DynamicLength,
    CancelLength,
    ReturnToR(bool),
    /// By its number in the neutral program: `G54` is 54.
    WorkOffset(u32),
    /// `G54.1 P`, `G154 P`: those after `G59`.
    FurtherOffset {
        most: u32,
    },
    /// How the path is smoothed, or a mode that is off anyway: nothing moves elsewhere for it. The
    /// letters may stand beside it.
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
    Dwell,
    Home,
    SecondHome,
    /// `G28.1`, `G30.1`
    StoreHome {
        second: bool,
    },
    /// `G29`
    FromHome,
    Machine,
    /// `G5 P`, `G5.1 Q`, `G8 P`: on with this number and off with 0.
    LookAhead {
        letter: u8,
        on: u32,
    },
    SwingToTilt,
    /// `G65`, `G66`: the macro that P names, once or after each move.
    MacroCall {
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
        keep: bool,
    },
    /// `G92.3`
    RestoreShift,
    /// `G12`, `G13`
    Pocket {
        clockwise: bool,
    },
    /// Haas `G70`, `G71`, `G72`
    Pattern(Pattern),
}

/// Holes in a pattern, each made by the active cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pattern {
    Circle,
    Arc,
    Line,
}

/// What to do about a number without its point.
pub(crate) const WHOLE_NUMBERS_HELP: &str = "write the point, or say what whole numbers count: `--whole-numbers units` where X10 is 10 mm, \
                                             `--whole-numbers increments` where it is 0.010 mm (FANUC parameter 3401#0, Haas setting 162)";

/// Interpolation (`G0` to `G3` and the like).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Motion {
    Rapid,
    Line,
    Arc {
        clockwise: bool,
    },
    /// Cubic or, `G5.1`, quadratic spline.
    Spline {
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
        away: bool,
        must_answer: bool,
    },
}

/// The canned cycles that can be told in the neutral program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Canned {
    BreakChip,
    LeftTap,
    Drill,
    DwellDrill,
    Deep,
    Tap,
    Ream,
    Bore,
    DwellReam,
    /// `G88`: out of the hole by hand.
    HandBore,
    FineBore,
    BackBore,
}

/// The working plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Plane {
    Xy,
    Zx,
    Yz,
}

/// What happens at corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Path {
    /// The axes stop at each.
    ExactStop,
    /// The path is kept to.
    Exact,
    /// They are cut: by P, and lines within Q are made one, where `bounded` says that the control has these words.
    Blend { bounded: bool },
}

/// What F means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FeedMode {
    PerMinute,
    PerTurn,
    InverseTime,
}

/// On which side of the path the tool is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Off,
    Left,
    Right,
}

/// The meaning of an M word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum M {
    Stop,
    OptionalStop,
    End,
    Clockwise,
    CounterClockwise,
    SpindleOff,
    Orient,
    ChangeTool,
    /// `M61`: which tool is in.
    ToolIsIn,
    Mist,
    Flood,
    Through,
    ThroughOff,
    CoolantOff,
    RigidTap,
    /// `M98`, Haas `M97`, `M99`: the subprogram that P names, the one that begins at a block of this
    /// program, and the way back.
    Call,
    CallBlock,
    Return,
    /// `M70` to `M73`: the modes kept for `M72`, and for the end of the subroutine too.
    SaveModes {
        until_return: bool,
    },
    ForgetModes,
    RestoreModes,
    ThreadWire,
    CutWire,
    /// Nothing moves for it; the letters may stand beside it.
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
        on: bool,
        with_motion: bool,
    },
    /// `M67`, `M68`: the analog output that E names, to Q.
    Analog {
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

/// Words of one group exclude each other in a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Group {
    OneShot,
    Motion,
    Cycle,
    Plane,
    Distance,
    ArcDistance,
    FeedMode,
    Units,
    Compensation,
    Length,
    Return,
    WorkOffset,
    Path,
    SpindleMode,
    Tilt,
    Scaling,
    Mirror,
    Taper,
    Macro,
    Polar,
    Diameter,
    // M words
    Flow,
    ToolChange,
    Spindle,
    Coolant,
    Override,
    Output,
    Modes,
    Wire,
    Kinematics,
}

impl Group {
    /// How many groups there are.
    pub(in crate::iso) const COUNT: usize = Group::Kinematics as usize + 1;

    /// The bit of the group in a set of groups.
    pub(in crate::iso) const fn bit(self) -> u32 {
        1 << self as u32
    }
}

/// A G word: ten times its number (`G43.4` is 434), its group, its meaning.
pub(in crate::iso) type GRow = (u16, Group, G);

/// An M word: its number, its group, its meaning.
pub(in crate::iso) type MRow = (u16, Group, M);

/// A word that exists and is refused on purpose, with the reason.
pub(in crate::iso) type Refused = (u16, &'static str);

/// What a word may begin with, beside the letters: LinuxCNC's polar words and the number of a spindle.
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
#[derive(Debug)]
pub(crate) struct Dictionary {
    /// By ten times the number.
    g: [Option<(Group, G)>; 2400],
    /// By the number.
    m: [Option<(Group, M)>; 500],
    refused_g: &'static [Refused],
    refused_m: &'static [Refused],
    /// The letters that the dialect has, by [`bit`].
    pub letters: u32,
    /// The longest block in bytes, blanks and comments apart.
    pub longest: usize,
}

impl Dictionary {
    pub(in crate::iso) const fn new(letters: &[u8], longest: usize) -> Dictionary {
        Dictionary {
            g: [None; 2400],
            m: [None; 500],
            refused_g: &[],
            refused_m: &[],
            letters: set(letters),
            longest,
        }
    }

    /// With these words, too.
    pub(in crate::iso) const fn with(mut self, g: &[GRow], m: &[MRow]) -> Dictionary {
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
    pub(in crate::iso) const fn refusing(
        mut self,
        g: &'static [Refused],
        m: &'static [Refused],
    ) -> Dictionary {
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
