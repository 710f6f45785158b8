//! What the G and M words of each flavour mean, and which exclude each other in a block: one table
//! of G words and one of M words a flavour. What is not in a table is not understood.

use crate::Dialect;

/// Which ISO code is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flavor {
    Fanuc,
    LinuxCnc,
    Grbl,
}

/// The meaning of a G word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum G {
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
    Length,
    ToolCenter,
    DynamicLength,
    CancelLength,
    ReturnToR(bool),
    WorkOffset(u16),
    ExactStop,
    Blend,
    /// A mode that is off anyway: a word that switches it off changes nothing.
    Neutral,
    Tilt,
    CancelTilt,
    Dwell,
    Home,
    SecondHome,
    Machine,
    LookAhead,
    SwingToTilt,
}

/// Interpolation (`G0` to `G3`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Motion {
    Rapid,
    Line,
    Arc { clockwise: bool },
}

/// The canned cycles that can be told in the neutral program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Canned {
    BreakChip,
    LeftTap,
    Drill,
    DwellDrill,
    Deep,
    Tap,
    Ream,
    Bore,
    DwellReam,
}

/// The working plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Plane {
    Xy,
    Zx,
    Yz,
}

/// What F means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FeedMode {
    PerMinute,
    PerTurn,
    InverseTime,
}

/// On which side of the path the tool is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Off,
    Left,
    Right,
}

/// The meaning of an M word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum M {
    Stop,
    OptionalStop,
    End,
    Clockwise,
    CounterClockwise,
    SpindleOff,
    Orient,
    ChangeTool,
    Mist,
    Flood,
    CoolantOff,
    Overrides,
    RigidTap,
}

/// Words of one group exclude each other in a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Group {
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
    Macro,
    Polar,
    // M words
    Flow,
    ToolChange,
    Spindle,
    Coolant,
    Override,
}

impl Group {
    /// How many groups there are.
    pub(super) const COUNT: usize = Group::Override as usize + 1;
}

/// A G word: ten times its number (`G43.4` is 434), its group, its meaning.
type GRow = (u16, Group, G);

/// An M word: its number, its group, its meaning.
type MRow = (u16, Group, M);

const RAPID: G = G::Motion(Motion::Rapid);
const LINE: G = G::Motion(Motion::Line);
const CLOCKWISE: G = G::Motion(Motion::Arc { clockwise: true });
const COUNTER: G = G::Motion(Motion::Arc { clockwise: false });

/// FANUC 30i, milling, G code list of B-64484EN-2 (group 09, the canned cycles, is apart from group
/// 01, the interpolation).
const FANUC_G: &[GRow] = &[
    (0, Group::Motion, RAPID),
    (10, Group::Motion, LINE),
    (20, Group::Motion, CLOCKWISE),
    (30, Group::Motion, COUNTER),
    (40, Group::OneShot, G::Dwell),
    (51, Group::OneShot, G::LookAhead),
    (90, Group::OneShot, G::ExactStop),
    (150, Group::Polar, G::Neutral),
    (170, Group::Plane, G::Plane(Plane::Xy)),
    (180, Group::Plane, G::Plane(Plane::Zx)),
    (190, Group::Plane, G::Plane(Plane::Yz)),
    (200, Group::Units, G::Inches(true)),
    (210, Group::Units, G::Inches(false)),
    (280, Group::OneShot, G::Home),
    (300, Group::OneShot, G::SecondHome),
    (400, Group::Compensation, G::Compensation(Side::Off)),
    (410, Group::Compensation, G::Compensation(Side::Left)),
    (420, Group::Compensation, G::Compensation(Side::Right)),
    (430, Group::Length, G::Length),
    (434, Group::Length, G::ToolCenter),
    (490, Group::Length, G::CancelLength),
    (500, Group::Scaling, G::Neutral),
    (530, Group::OneShot, G::Machine),
    (531, Group::OneShot, G::SwingToTilt),
    (540, Group::WorkOffset, G::WorkOffset(54)),
    (550, Group::WorkOffset, G::WorkOffset(55)),
    (560, Group::WorkOffset, G::WorkOffset(56)),
    (570, Group::WorkOffset, G::WorkOffset(57)),
    (580, Group::WorkOffset, G::WorkOffset(58)),
    (590, Group::WorkOffset, G::WorkOffset(59)),
    (610, Group::Path, G::ExactStop),
    (640, Group::Path, G::ExactStop),
    (670, Group::Macro, G::Neutral),
    (682, Group::Tilt, G::Tilt),
    (690, Group::Tilt, G::CancelTilt),
    (730, Group::Cycle, G::Cycle(Canned::BreakChip)),
    (740, Group::Cycle, G::Cycle(Canned::LeftTap)),
    (800, Group::Cycle, G::CancelCycle),
    (810, Group::Cycle, G::Cycle(Canned::Drill)),
    (820, Group::Cycle, G::Cycle(Canned::DwellDrill)),
    (830, Group::Cycle, G::Cycle(Canned::Deep)),
    (840, Group::Cycle, G::Cycle(Canned::Tap)),
    (850, Group::Cycle, G::Cycle(Canned::Ream)),
    (860, Group::Cycle, G::Cycle(Canned::Bore)),
    (890, Group::Cycle, G::Cycle(Canned::DwellReam)),
    (900, Group::Distance, G::Incremental(false)),
    (910, Group::Distance, G::Incremental(true)),
    (930, Group::FeedMode, G::FeedMode(FeedMode::InverseTime)),
    (940, Group::FeedMode, G::FeedMode(FeedMode::PerMinute)),
    (950, Group::FeedMode, G::FeedMode(FeedMode::PerTurn)),
    (970, Group::SpindleMode, G::Neutral),
    (980, Group::Return, G::ReturnToR(false)),
    (990, Group::Return, G::ReturnToR(true)),
];

/// LinuxCNC, "G-Code Overview", table of modal groups; `G80` may stand beside `G0` to `G3`, so it has
/// a group of its own.
const LINUXCNC_G: &[GRow] = &[
    (0, Group::Motion, RAPID),
    (10, Group::Motion, LINE),
    (20, Group::Motion, CLOCKWISE),
    (30, Group::Motion, COUNTER),
    (40, Group::OneShot, G::Dwell),
    (170, Group::Plane, G::Plane(Plane::Xy)),
    (180, Group::Plane, G::Plane(Plane::Zx)),
    (190, Group::Plane, G::Plane(Plane::Yz)),
    (200, Group::Units, G::Inches(true)),
    (210, Group::Units, G::Inches(false)),
    (280, Group::OneShot, G::Home),
    (300, Group::OneShot, G::SecondHome),
    (400, Group::Compensation, G::Compensation(Side::Off)),
    (410, Group::Compensation, G::Compensation(Side::Left)),
    (411, Group::Compensation, G::DynamicCompensation(Side::Left)),
    (420, Group::Compensation, G::Compensation(Side::Right)),
    (421, Group::Compensation, G::DynamicCompensation(Side::Right)),
    (430, Group::Length, G::Length),
    (490, Group::Length, G::CancelLength),
    (530, Group::OneShot, G::Machine),
    (540, Group::WorkOffset, G::WorkOffset(54)),
    (550, Group::WorkOffset, G::WorkOffset(55)),
    (560, Group::WorkOffset, G::WorkOffset(56)),
    (570, Group::WorkOffset, G::WorkOffset(57)),
    (580, Group::WorkOffset, G::WorkOffset(58)),
    (590, Group::WorkOffset, G::WorkOffset(59)),
    (591, Group::WorkOffset, G::WorkOffset(591)),
    (592, Group::WorkOffset, G::WorkOffset(592)),
    (593, Group::WorkOffset, G::WorkOffset(593)),
    (610, Group::Path, G::ExactStop),
    (611, Group::Path, G::ExactStop),
    (640, Group::Path, G::Blend),
    (730, Group::Motion, G::Cycle(Canned::BreakChip)),
    (740, Group::Motion, G::Cycle(Canned::LeftTap)),
    (800, Group::Cycle, G::CancelCycle),
    (810, Group::Motion, G::Cycle(Canned::Drill)),
    (820, Group::Motion, G::Cycle(Canned::DwellDrill)),
    (830, Group::Motion, G::Cycle(Canned::Deep)),
    (840, Group::Motion, G::Cycle(Canned::Tap)),
    (850, Group::Motion, G::Cycle(Canned::Ream)),
    (860, Group::Motion, G::Cycle(Canned::Bore)),
    (890, Group::Motion, G::Cycle(Canned::DwellReam)),
    (900, Group::Distance, G::Incremental(false)),
    (910, Group::Distance, G::Incremental(true)),
    (901, Group::ArcDistance, G::CentersAbsolute(true)),
    (911, Group::ArcDistance, G::CentersAbsolute(false)),
    (921, Group::OneShot, G::Neutral),
    (930, Group::FeedMode, G::FeedMode(FeedMode::InverseTime)),
    (940, Group::FeedMode, G::FeedMode(FeedMode::PerMinute)),
    (950, Group::FeedMode, G::FeedMode(FeedMode::PerTurn)),
    (970, Group::SpindleMode, G::Neutral),
    (980, Group::Return, G::ReturnToR(false)),
    (990, Group::Return, G::ReturnToR(true)),
];

/// GRBL 1.1, wiki page "Grbl v1.1 Commands" and the supported codes in its `gcode.h`.
const GRBL_G: &[GRow] = &[
    (0, Group::Motion, RAPID),
    (10, Group::Motion, LINE),
    (20, Group::Motion, CLOCKWISE),
    (30, Group::Motion, COUNTER),
    (40, Group::OneShot, G::Dwell),
    (170, Group::Plane, G::Plane(Plane::Xy)),
    (180, Group::Plane, G::Plane(Plane::Zx)),
    (190, Group::Plane, G::Plane(Plane::Yz)),
    (200, Group::Units, G::Inches(true)),
    (210, Group::Units, G::Inches(false)),
    (280, Group::OneShot, G::Home),
    (300, Group::OneShot, G::SecondHome),
    (400, Group::Compensation, G::Compensation(Side::Off)),
    (431, Group::Length, G::DynamicLength),
    (490, Group::Length, G::CancelLength),
    (530, Group::OneShot, G::Machine),
    (540, Group::WorkOffset, G::WorkOffset(54)),
    (550, Group::WorkOffset, G::WorkOffset(55)),
    (560, Group::WorkOffset, G::WorkOffset(56)),
    (570, Group::WorkOffset, G::WorkOffset(57)),
    (580, Group::WorkOffset, G::WorkOffset(58)),
    (590, Group::WorkOffset, G::WorkOffset(59)),
    (610, Group::Path, G::ExactStop),
    (800, Group::Motion, G::CancelCycle),
    (900, Group::Distance, G::Incremental(false)),
    (910, Group::Distance, G::Incremental(true)),
    (911, Group::ArcDistance, G::CentersAbsolute(false)),
    (921, Group::OneShot, G::Neutral),
    (930, Group::FeedMode, G::FeedMode(FeedMode::InverseTime)),
    (940, Group::FeedMode, G::FeedMode(FeedMode::PerMinute)),
];

const FANUC_M: &[MRow] = &[
    (0, Group::Flow, M::Stop),
    (1, Group::Flow, M::OptionalStop),
    (2, Group::Flow, M::End),
    (30, Group::Flow, M::End),
    (3, Group::Spindle, M::Clockwise),
    (4, Group::Spindle, M::CounterClockwise),
    (5, Group::Spindle, M::SpindleOff),
    (19, Group::Spindle, M::Orient),
    (29, Group::Spindle, M::RigidTap),
    (6, Group::ToolChange, M::ChangeTool),
    (7, Group::Coolant, M::Mist),
    (8, Group::Coolant, M::Flood),
    (9, Group::Coolant, M::CoolantOff),
    (48, Group::Override, M::Overrides),
    (49, Group::Override, M::Overrides),
];

const LINUXCNC_M: &[MRow] = &[
    (0, Group::Flow, M::Stop),
    (1, Group::Flow, M::OptionalStop),
    (2, Group::Flow, M::End),
    (30, Group::Flow, M::End),
    (3, Group::Spindle, M::Clockwise),
    (4, Group::Spindle, M::CounterClockwise),
    (5, Group::Spindle, M::SpindleOff),
    (19, Group::Spindle, M::Orient),
    (6, Group::ToolChange, M::ChangeTool),
    (7, Group::Coolant, M::Mist),
    (8, Group::Coolant, M::Flood),
    (9, Group::Coolant, M::CoolantOff),
    (48, Group::Override, M::Overrides),
    (49, Group::Override, M::Overrides),
];

const GRBL_M: &[MRow] = &[
    (0, Group::Flow, M::Stop),
    (1, Group::Flow, M::OptionalStop),
    (2, Group::Flow, M::End),
    (30, Group::Flow, M::End),
    (3, Group::Spindle, M::Clockwise),
    (4, Group::Spindle, M::CounterClockwise),
    (5, Group::Spindle, M::SpindleOff),
    (7, Group::Coolant, M::Mist),
    (8, Group::Coolant, M::Flood),
    (9, Group::Coolant, M::CoolantOff),
];

/// Words that exist and are refused on purpose (ten times the number), each with the reason.
const REFUSED_G: &[(u16, &str)] = &[
    (50, "high-precision and spline modes are not followed; write G5.1 Q1 or plain moves"),
    (100, "it changes the offsets of the control, which the proof takes as set up"),
    (160, "polar coordinates are not followed; write X and Y"),
    (331, "spindle-synchronised motion is not followed; tap with G84"),
    (382, "a probed position is known only at the machine"),
    (411, "a tool radius in the block is not followed; use G41 D"),
    (421, "a tool radius in the block is not followed; use G42 D"),
    (510, "scaling is not followed; write the final coordinates"),
    (520, "local shifts are not followed; write the final coordinates"),
    (541, "only the work offsets G54 to G59 are known"),
    (650, "macro calls are not followed"),
    (660, "macro calls are not followed"),
    (680, "rotated coordinates are not followed; write the final coordinates"),
    (760, "the sideways shift of fine boring cannot be told in the neutral program; use G86"),
    (870, "back boring cannot be told in the neutral program"),
    (880, "a cycle that ends by hand cannot be proven; use G86"),
    (920, "it shifts the coordinates from where the machine stands, which the proof does not know"),
    (960, "constant surface speed is for turning"),
];

/// M words that exist and are refused on purpose, each with the reason.
const REFUSED_M: &[(u16, &str)] = &[
    (6, "this control has no tool change; stop with M0 instead"),
    (98, "subprograms are not followed"),
    (99, "subprograms are not followed"),
];

/// The words of one flavour, found by number.
#[derive(Debug)]
pub(super) struct Dictionary {
    /// Which flavour this is.
    pub flavor: Flavor,
    g: &'static [GRow],
    m: &'static [MRow],
    /// Row + 1 in `g` by ten times the number.
    g_rows: [u8; 1000],
    /// Row + 1 in `m` by number.
    m_rows: [u8; 100],
    /// Bit 0 is A: the letters that the flavour has.
    pub letters: u32,
    /// The longest block in bytes, blanks and comments apart.
    pub longest: usize,
}

static FANUC: Dictionary =
    Dictionary::new(Flavor::Fanuc, FANUC_G, FANUC_M, b"ABCDFGHIJKMNOPQRSTXYZ", usize::MAX);
static LINUXCNC: Dictionary =
    Dictionary::new(Flavor::LinuxCnc, LINUXCNC_G, LINUXCNC_M, b"ABCDFGHIJKLMNPQRSTXYZ", 254);
static GRBL: Dictionary = Dictionary::new(Flavor::Grbl, GRBL_G, GRBL_M, b"FGIJKLMNPRSTXYZ", 79);

impl Dictionary {
    const fn new(
        flavor: Flavor,
        g: &'static [GRow],
        m: &'static [MRow],
        letters: &[u8],
        longest: usize,
    ) -> Dictionary {
        let mut dictionary =
            Dictionary { flavor, g, m, g_rows: [0; 1000], m_rows: [0; 100], letters: 0, longest };
        let mut row = 0;
        while row < g.len() {
            dictionary.g_rows[g[row].0 as usize] = row as u8 + 1;
            row += 1;
        }
        row = 0;
        while row < m.len() {
            dictionary.m_rows[m[row].0 as usize] = row as u8 + 1;
            row += 1;
        }
        row = 0;
        while row < letters.len() {
            dictionary.letters |= 1 << (letters[row] - b'A');
            row += 1;
        }
        dictionary
    }

    /// The words of `dialect` (those of LinuxCNC where it is not one of ISO code).
    pub(super) fn of(dialect: Dialect) -> &'static Dictionary {
        match dialect {
            Dialect::Fanuc => &FANUC,
            Dialect::Grbl => &GRBL,
            _ => &LINUXCNC,
        }
    }

    /// Group and meaning of the G word with this number.
    pub(super) fn g(&self, number: f64) -> Option<(Group, G)> {
        let row = *self.g_rows.get(tenths(number)?)?;
        let (_, group, meaning) = self.g.get(usize::from(row).checked_sub(1)?)?;
        Some((*group, *meaning))
    }

    /// Group and meaning of the M word with this number.
    pub(super) fn m(&self, number: f64) -> Option<(Group, M)> {
        let row = *self.m_rows.get(tenths(number).filter(|t| t % 10 == 0)? / 10)?;
        let (_, group, meaning) = self.m.get(usize::from(row).checked_sub(1)?)?;
        Some((*group, *meaning))
    }
}

/// Ten times a number that has at most one decimal and is below 100.
fn tenths(number: f64) -> Option<usize> {
    let tenths = (number * 10.0).round();
    ((0.0..1000.0).contains(&tenths) && (number * 10.0 - tenths).abs() < 1e-9)
        .then_some(tenths as usize)
}

/// Why a word that no table has is refused, where there is more to say than that it is not known.
pub(super) fn why_refused(letter: u8, number: f64) -> Option<&'static str> {
    let (table, number) = if letter == b'G' {
        (REFUSED_G, tenths(number)?)
    } else {
        (REFUSED_M, tenths(number)? / 10)
    };
    table.iter().find(|(n, _)| usize::from(*n) == number).map(|(_, reason)| *reason)
}
