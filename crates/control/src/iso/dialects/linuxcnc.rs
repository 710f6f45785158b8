//! LinuxCNC, "G-Code Overview", table of modal groups. `G80` may stand in a block with `G0` to `G3`, so it has
//! a group of its own.

use super::facts::{
    Arcs, AtEnd, Cycles, Facts, FeedRules, FeedUnit, Functions, Homes, Language, MotionRules,
    Offsets, OuterCenter, Reset, Rollover, Syntax, Tools,
};
use super::{END_M, MILL_G, SUBPROGRAM_M, TOOL_G, TOOL_M, cycles, mill};
use crate::iso::language::words::{
    Dictionary, G, GRow, Group, M, MRow, Motion, Path, Refused, Side,
};
use crate::{Corners, Ending, FeedPath, StartModes};

const G_WORDS: &[GRow] = &[
    (50, Group::Motion, G::Motion(Motion::Spline { cubic: true })),
    (51, Group::Motion, G::Motion(Motion::Spline { cubic: false })),
    (52, Group::Motion, G::Motion(Motion::Nurbs)),
    (53, Group::Motion, G::Motion(Motion::EndOfNurbs)),
    (70, Group::Diameter, G::Diameter(true)),
    (80, Group::Diameter, G::Diameter(false)),
    (100, Group::OneShot, G::WriteData),
    (281, Group::OneShot, G::StoreHome { second: false }),
    (301, Group::OneShot, G::StoreHome { second: true }),
    (330, Group::Motion, G::Motion(Motion::Thread)),
    (331, Group::Motion, G::Motion(Motion::RigidTap)),
    (382, Group::Motion, G::Motion(Motion::Probe { away: false, must_answer: true })),
    (383, Group::Motion, G::Motion(Motion::Probe { away: false, must_answer: false })),
    (384, Group::Motion, G::Motion(Motion::Probe { away: true, must_answer: true })),
    (385, Group::Motion, G::Motion(Motion::Probe { away: true, must_answer: false })),
    (431, Group::Length, G::DynamicLength),
    (591, Group::WorkOffset, G::WorkOffset(60)),
    (592, Group::WorkOffset, G::WorkOffset(61)),
    (593, Group::WorkOffset, G::WorkOffset(62)),
    (610, Group::Path, G::Path(Path::Exact)),
    (611, Group::Path, G::Path(Path::ExactStop)),
    (640, Group::Path, G::Path(Path::Blend { bounded: true })),
    (800, Group::Cycle, G::CancelCycle),
    (901, Group::ArcDistance, G::CentersAbsolute(true)),
    (911, Group::ArcDistance, G::CentersAbsolute(false)),
    (921, Group::OneShot, G::CancelShift { keep: false }),
    (922, Group::OneShot, G::CancelShift { keep: true }),
    (923, Group::OneShot, G::RestoreShift),
    (960, Group::SpindleMode, G::SurfaceSpeed(true)),
    (970, Group::SpindleMode, G::SurfaceSpeed(false)),
    (411, Group::Compensation, G::DynamicCompensation(Side::Left)),
    (421, Group::Compensation, G::DynamicCompensation(Side::Right)),
];

const M_WORDS: &[MRow] = &[
    (7, Group::Coolant, M::Mist),
    (50, Group::Override, M::Override),
    (51, Group::Override, M::Override),
    (52, Group::Override, M::AdaptiveFeed),
    (53, Group::Override, M::Override),
    (60, Group::Flow, M::Stop),
    (61, Group::ToolChange, M::ToolIsIn),
    (62, Group::Output, M::Digital { on: true, with_motion: true }),
    (63, Group::Output, M::Digital { on: false, with_motion: true }),
    (64, Group::Output, M::Digital { on: true, with_motion: false }),
    (65, Group::Output, M::Digital { on: false, with_motion: false }),
    (66, Group::Output, M::Input),
    (67, Group::Output, M::Analog { with_motion: true }),
    (68, Group::Output, M::Analog { with_motion: false }),
    (70, Group::Modes, M::SaveModes { until_return: false }),
    (71, Group::Modes, M::ForgetModes),
    (72, Group::Modes, M::RestoreModes),
    (73, Group::Modes, M::SaveModes { until_return: true }),
];

const REFUSED_G: &[Refused] = &[
    (432, "a second length added to the first is not followed; write their sum in the tool table"),
    (700, "lathe cycles are not followed; write their moves"),
    (710, "lathe cycles are not followed; write their moves"),
    (711, "lathe cycles are not followed; write their moves"),
    (712, "lathe cycles are not followed; write their moves"),
    (720, "lathe cycles are not followed; write their moves"),
    (760, "the lathe's threading cycle is not followed; write its passes with G33"),
    (870, "LinuxCNC's back boring is not followed; write its moves"),
];

/// "Command too long" from 253 bytes on (found with `rs274`): a line with its comments, its blanks and a CR at its end.
const LONGEST_LINE: usize = 252;

const WORDS: Dictionary = mill(b"ABCDEFGHIJKLMNPQRSTXYZ@^$", LONGEST_LINE)
    .with(MILL_G, END_M)
    .with(TOOL_G, TOOL_M)
    .with(&[], SUBPROGRAM_M)
    .with(&cycles(Group::Motion), &[])
    .with(G_WORDS, M_WORDS)
    .refusing(REFUSED_G, &[]);

/// By 2√2 of 0.01 mm or of 0.001 inch, and beyond that up to a hundred times as much where it is at most 0.1 % of the larger
/// radius (found with `rs274`; `CENTER_ARC_RADIUS_TOLERANCE_MM` and `_INCH` of the INI file set it otherwise).
fn is_circle(inches: bool, start: f64, end: f64) -> bool {
    let apart = (start - end).abs();
    let unit = if inches { 0.001 * geom::INCH } else { 0.01 };
    let near = 2.0 * std::f64::consts::SQRT_2 * unit;
    apart <= near || (apart <= 100.0 * near && apart <= 0.001 * start.max(end))
}

pub(crate) static FACTS: Facts = Facts {
    syntax: Syntax {
        ending: Ending::CodeOrPercent,
        extended_m: true,
        longest_line: LONGEST_LINE,
        further_axes: "U, V and W are axes of machines whose [TRAJ]COORDINATES name them, and not followed: write the move as X, Y and Z",
        ..Syntax::ISO
    },
    // Both found with `rs274`: "Cannot do g1 with zero feed rate".
    feed: FeedRules {
        unit: FeedUnit::OfBefore,
        mode_ends_feed: true,
        word_needs_feed: true,
        ..FeedRules::ISO
    },
    functions: Functions { orients_by_pq: true, ..Functions::ISO },
    motion: MotionRules {
        rollover: Rollover::BySign,
        any_line_compensates: true,
        ..MotionRules::ISO
    },
    arcs: Arcs {
        is_circle,
        // Both 0.000 05 inch, found with `rs274`.
        radius_slack: 0.00127,
        least_radius: 0.00127,
        may_compensate: true,
        outer_center: OuterCenter::Refused,
        counts_turns: true,
        ..Arcs::ISO
    },
    cycles: Cycles { taps_in_g17: true, dwell_stays: true, ..Cycles::ISO },
    offsets: Offsets {
        written: |_, p, active| match p? {
            0 => Some(active),
            p @ 1..=9 => Some(53 + p),
            _ => None,
        },
        turn: true,
        ..Offsets::ISO
    },
    homes: Homes { stored: true, ..Homes::ISO },
    tools: Tools { follows_tool: true, rs274_data: true, ..Tools::ISO },
    reset: Reset {
        corners: Corners::Unbounded,
        feed_path: FeedPath::LinearAxes,
        // M codes, "M2, M30 Program End".
        at_end: AtEnd::Resets,
        // RS274NGC_STARTUP_CODE; of the work offset parameter 5220 besides.
        modes: StartModes { metric: true, returns_up: true, ..StartModes::NONE },
        ..Reset::ISO
    },
    ..Facts::iso(WORDS, Language::Ngc)
};
