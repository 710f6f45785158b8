//! GRBL 1.1, wiki page "Grbl v1.1 Commands" and the supported codes in its `gcode.h`.

use super::facts::{
    Arcs, AtEnd, Brackets, Facts, FeedRules, FeedUnit, Functions, Homes, Language, Offsets,
    OuterCenter, Reset, Syntax, Tools, six,
};
use super::{END_M, MILL_G, mill};
use crate::iso::language::words::{Dictionary, G, GRow, Group, M, MRow, Motion, Refused};
use crate::{FeedPath, StartModes};

const G_WORDS: &[GRow] = &[
    (100, Group::OneShot, G::WriteData),
    (281, Group::OneShot, G::StoreHome { second: false }),
    (301, Group::OneShot, G::StoreHome { second: true }),
    (382, Group::Motion, G::Motion(Motion::Probe { away: false, must_answer: true })),
    (383, Group::Motion, G::Motion(Motion::Probe { away: false, must_answer: false })),
    (384, Group::Motion, G::Motion(Motion::Probe { away: true, must_answer: true })),
    (385, Group::Motion, G::Motion(Motion::Probe { away: true, must_answer: false })),
    (431, Group::Length, G::DynamicLength),
    (800, Group::Motion, G::CancelCycle),
    (911, Group::ArcDistance, G::CentersAbsolute(false)),
    (921, Group::OneShot, G::CancelShift { keep: false }),
];

const M_WORDS: &[MRow] = &[(7, Group::Coolant, M::Mist)];

const REFUSED_G: &[Refused] = &[
    (410, "this control has no radius compensation; write the compensated path"),
    (420, "this control has no radius compensation; write the compensated path"),
    (430, "this control has no tool table; write G43.1 Z"),
    (640, "this control has no modes of the path: take it out"),
    (810, "this control has no cycles; write their moves"),
    (820, "this control has no cycles; write their moves"),
    (830, "this control has no cycles; write their moves"),
];

const REFUSED_M: &[Refused] = &[
    (6, "this control has no tool change: where its sender stops for it, write M0"),
    (98, "this control has no subprograms"),
    (99, "this control has no subprograms"),
];

const WORDS: Dictionary = mill(b"FGIJKLMNPRSTXYZ", 79)
    .with(MILL_G, END_M)
    .with(G_WORDS, M_WORDS)
    .refusing(REFUSED_G, REFUSED_M);

pub(crate) static FACTS: Facts = Facts {
    syntax: Syntax {
        brackets: Brackets::AnyComment,
        percent: false,
        console: true,
        further_axes: "this control has X, Y and Z, and gives error 20 for another axis: write the move with them",
        ..Syntax::ISO
    },
    feed: FeedRules { unit: FeedUnit::OfBlock, ..FeedRules::ISO },
    functions: Functions { ignores_optional_stop: true, ..Functions::ISO },
    arcs: Arcs { needs_axis: true, outer_center: OuterCenter::Ignored, ..Arcs::ISO },
    offsets: Offsets {
        written: |l, p, active| match p {
            Some(0) => Some(active),
            p => six(l, p, active),
        },
        ..Offsets::ISO
    },
    homes: Homes { stored: true, ..Homes::ISO },
    tools: Tools { by_hand: true, ..Tools::ISO },
    reset: Reset {
        feed_path: FeedPath::AllAxes,
        three_axes: true,
        // `gcode.c`, step 21.
        at_end: AtEnd::Resets,
        // The blocks of the start, $N0 and $N1; I, J and K always count from the start of the arc.
        modes: StartModes {
            metric: true,
            centers_from_start: true,
            returns_up: true,
            ..StartModes::NONE
        },
        ..Reset::ISO
    },
    ..Facts::iso(WORDS, Language::Plain)
};
