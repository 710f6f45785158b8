//! FreeCAD's own commands, in which its CAM workbench keeps toolpaths (`docs/sources/freecad.md`): lengths
//! are mm and times s, whatever the job shows: a feed is mm/s.

use super::facts::{
    Arcs, AtEnd, Brackets, Cycles, Facts, FeedMeaning, FeedRules, Functions, Language, OuterCenter,
    Reset, Semicolon, Syntax, Tools,
};
use super::{BASIC_G, BASIC_M, END_M, SPINDLE_G, SPINDLE_M, cycles};
use crate::Ending;
use crate::iso::language::words::{
    Dictionary, FeedMode, G, GRow, Group, M, MRow, Motion, Refused, Side,
};

const G_WORDS: &[GRow] = &[
    (210, Group::Units, G::Inches(false)),
    (382, Group::Motion, G::Motion(Motion::Probe { away: false, must_answer: true })),
    (383, Group::Motion, G::Motion(Motion::Probe { away: false, must_answer: false })),
    (384, Group::Motion, G::Motion(Motion::Probe { away: true, must_answer: true })),
    (385, Group::Motion, G::Motion(Motion::Probe { away: true, must_answer: false })),
    (400, Group::Compensation, G::Compensation(Side::Off)),
    (410, Group::Compensation, G::Compensation(Side::Left)),
    (420, Group::Compensation, G::Compensation(Side::Right)),
    (591, Group::WorkOffset, G::WorkOffset(60)),
    (592, Group::WorkOffset, G::WorkOffset(61)),
    (593, Group::WorkOffset, G::WorkOffset(62)),
    (594, Group::WorkOffset, G::WorkOffset(63)),
    (595, Group::WorkOffset, G::WorkOffset(64)),
    (596, Group::WorkOffset, G::WorkOffset(65)),
    (597, Group::WorkOffset, G::WorkOffset(66)),
    (598, Group::WorkOffset, G::WorkOffset(67)),
    (599, Group::WorkOffset, G::WorkOffset(68)),
    (800, Group::Cycle, G::CancelCycle),
    (911, Group::ArcDistance, G::CentersAbsolute(false)),
    (930, Group::FeedMode, G::FeedMode(FeedMode::InverseTime)),
    (940, Group::FeedMode, G::FeedMode(FeedMode::PerMinute)),
    (950, Group::FeedMode, G::FeedMode(FeedMode::PerTurn)),
    (980, Group::Return, G::ReturnToR(false)),
    (990, Group::Return, G::ReturnToR(true)),
];

const M_WORDS: &[MRow] = &[(6, Group::ToolChange, M::ChangeTool), (7, Group::Coolant, M::Mist)];

const REFUSED_G: &[Refused] = &[
    (200, "FreeCAD keeps its toolpaths in mm, also where the job shows inches"),
    (430, "the post calls the length of the tool with the tool"),
    (490, "the post calls the length of the tool with the tool"),
];

const WORDS: Dictionary = Dictionary::new(b"ABCDFGIJKLMNPQRSTXYZ", usize::MAX)
    .with(BASIC_G, BASIC_M)
    .with(SPINDLE_G, SPINDLE_M)
    .with(&cycles(Group::Motion), END_M)
    .with(G_WORDS, M_WORDS)
    .refusing(REFUSED_G, &[]);

pub(crate) static FACTS: Facts = Facts {
    syntax: Syntax {
        brackets: Brackets::Line,
        semicolon: Semicolon::Refused,
        writes_nothing: true,
        ending: Ending::Text,
        ..Syntax::ISO
    },
    feed: FeedRules { meaning: FeedMeaning::PerSecond, ..FeedRules::ISO },
    arcs: Arcs { outer_center: OuterCenter::Ignored, ..Arcs::ISO },
    cycles: Cycles { chuck_is_open: true, returns: Some(false), ..Cycles::ISO },
    tools: Tools { numbered: true, ..Tools::ISO },
    reset: Reset { millimeters: true, at_end: AtEnd::Unread, ..Reset::ISO },
    // What the machine does at a stop, the post knows.
    functions: Functions { stop_leaves_on: false, ..Functions::ISO },
    ..Facts::iso(WORDS, Language::Plain)
};
