//! What a dialect of ISO code is: its words and the facts in which it differs from others, by name. Each dialect states
//! its own in a file; `docs/controls` gives the sources.
//!
//! `ISO` of a group is what RS274/NGC and most others do; `FANUC` is FANUC and what follows it.

use crate::iso::language::words::Dictionary;
use crate::{Corners, Ending, FeedPath};
use program::WorkOffset;

/// A dialect of ISO code.
#[derive(Debug)]
pub(crate) struct Facts {
    pub words: Dictionary,
    /// How its programs calculate.
    pub language: Language,
    pub syntax: Syntax,
    pub numbers: Numbers,
    pub feed: FeedRules,
    pub functions: Functions,
    pub motion: MotionRules,
    pub arcs: Arcs,
    pub cycles: Cycles,
    pub offsets: Offsets,
    pub frames: FrameRules,
    pub homes: Homes,
    pub tools: Tools,
    /// The wire, where it is a control of a wire-EDM machine.
    pub wire: Option<WireRules>,
    pub reset: Reset,
}

impl Facts {
    /// A dialect with these words, in nothing different from RS274/NGC.
    pub(super) const fn iso(words: Dictionary, language: Language) -> Facts {
        Facts {
            words,
            language,
            syntax: Syntax::ISO,
            numbers: Numbers::ISO,
            feed: FeedRules::ISO,
            functions: Functions::ISO,
            motion: MotionRules::ISO,
            arcs: Arcs::ISO,
            cycles: Cycles::ISO,
            offsets: Offsets::ISO,
            frames: FrameRules::ISO,
            homes: Homes::ISO,
            tools: Tools::ISO,
            wire: None,
            reset: Reset::ISO,
        }
    }

    /// A dialect with these words that follows FANUC.
    pub(super) const fn fanuc(words: Dictionary, language: Language) -> Facts {
        Facts {
            syntax: Syntax::FANUC,
            numbers: Numbers::FANUC,
            feed: FeedRules::FANUC,
            functions: Functions::FANUC,
            motion: MotionRules::FANUC,
            cycles: Cycles::FANUC,
            offsets: Offsets::FANUC,
            frames: FrameRules::FANUC,
            homes: Homes::FANUC,
            tools: Tools::FANUC,
            reset: Reset::FANUC,
            ..Facts::iso(words, language)
        }
    }

    /// Why a word is refused, where there is more to say than that it is not known.
    pub(in crate::iso) fn why_refused(&self, letter: u8, number: f64) -> Option<&'static str> {
        match self.syntax.refused_letter {
            Some((refused, reason)) if refused == letter => Some(reason),
            _ if matches!(letter, b'U' | b'V' | b'W') => Some(self.syntax.further_axes),
            _ => self.words.why_refused(letter, number),
        }
    }
}

/// How a program calculates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Language {
    /// Not at all.
    Plain,
    /// RS274/NGC as it was first written down: numbered parameters, no comparisons.
    Rs274,
    /// RS274/NGC as LinuxCNC has it: named parameters and O-words, too.
    Ngc,
    /// Custom macro B.
    MacroB,
}

/// How a block is written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Syntax {
    /// Small letters are the same as capital ones.
    pub small_letters: bool,
    /// Whether `,C` and `,R` put a chamfer or an arc at a corner.
    pub corners: CornerWords,
    pub brackets: Brackets,
    pub semicolon: Semicolon,
    pub block_delete: BlockDelete,
    /// `%` alone on its line begins and ends a program.
    pub percent: bool,
    /// A line is one command, and what follows are its parameters: texts and axes without a number, too.
    pub one_command: bool,
    /// Values that could not be worked out are written as words that are no numbers, or as very large ones (FreeCAD).
    pub writes_nothing: bool,
    /// `$` begins a command of the console.
    pub console: bool,
    /// How a program ends.
    pub ending: Ending,
    /// P of a call without L: four digits of the program behind those of the repeats.
    pub repeats_in_p: bool,
    /// `M100` to `M199` run programs of the user, and functions of the builder may switch the kinematics.
    pub extended_m: bool,
    /// Why a letter that is none of its words is refused, where there is a reason of its own.
    pub refused_letter: Option<(u8, &'static str)>,
    /// What U, V and W are that are none of its words.
    pub further_axes: &'static str,
}

/// `,C` and `,R`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CornerWords {
    None,
    /// Between straight cuts only.
    AtLines,
    /// At arcs, too.
    AtAll,
}

/// What `(` begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Brackets {
    /// Nothing.
    None,
    /// A comment up to `)`, with no `(` in it.
    Comment,
    /// A comment up to the first `)`, whatever stands in it.
    AnyComment,
    /// A comment that is a line of its own.
    Line,
}

/// What `;` begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Semicolon {
    Comment,
    /// It is the end of the block.
    EndOfBlock,
    /// The words behind it count all the same.
    Refused,
}

/// What switches a block off on demand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BlockDelete {
    None,
    /// `/`
    Slash,
    /// `/`, and `/1` to `/9`.
    Numbered,
}

impl Syntax {
    pub const ISO: Syntax = Syntax {
        small_letters: true,
        corners: CornerWords::None,
        brackets: Brackets::Comment,
        semicolon: Semicolon::Comment,
        block_delete: BlockDelete::Slash,
        percent: true,
        one_command: false,
        writes_nothing: false,
        console: false,
        ending: Ending::CodeOrText,
        repeats_in_p: false,
        extended_m: false,
        refused_letter: None,
        further_axes: "U, V and W are axes parallel to X, Y and Z (ISO 6983), and not followed: write the move as X, Y and Z",
    };
    pub const FANUC: Syntax = Syntax {
        small_letters: false,
        ending: Ending::Code,
        semicolon: Semicolon::EndOfBlock,
        block_delete: BlockDelete::Numbered,
        further_axes: "U, V and W are further axes where parameter 1020 names them, on lathes (G code system A) increments of X, Y \
                       and Z; neither is followed: write X, Y and Z, with G91 where they are increments",
        ..Syntax::ISO
    };
}

/// How numbers count.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Numbers {
    /// What a number without a point counts is a setting of the machine, and a whole number has no point.
    pub point_counts: bool,
    /// A factor of a scale without a point counts thousandths or hundred thousandths (FANUC, parameter 5400#7).
    pub factor_needs_point: bool,
    /// What P of a dwell counts.
    pub dwell: DwellUnit,
    /// The letter of seconds that a dwell may have in place of P.
    pub dwell_letter: Option<u8>,
    /// A dwell counts turns of the spindle in feed per turn, where it is set up so.
    pub dwells_by_turns: bool,
}

/// What P of a dwell counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DwellUnit {
    Seconds,
    Milliseconds,
    /// Milliseconds without a point, seconds with one.
    ByPoint,
    /// Least increments of time, as the machine is set up.
    AsSetUp,
}

impl Numbers {
    pub const ISO: Numbers = Numbers {
        point_counts: false,
        factor_needs_point: false,
        dwell: DwellUnit::Seconds,
        dwell_letter: None,
        dwells_by_turns: false,
    };
    pub const FANUC: Numbers = Numbers { point_counts: true, ..Numbers::ISO };
}

/// How F is read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FeedRules {
    pub meaning: FeedMeaning,
    /// F of a thread is its pitch; it is that of K otherwise.
    pub pitch_by_f: bool,
    /// In which unit F is in the block that changes units.
    pub unit: FeedUnit,
    /// A word of the feed mode ends F, also the one that is on already.
    pub mode_ends_feed: bool,
    /// `G1` needs its F also in a block that names no axis.
    pub word_needs_feed: bool,
}

/// What F is, apart from its modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FeedMeaning {
    PerMinute,
    /// With `G93` a number whose point counts.
    PointedTime,
    /// mm/s, and beside a tap the pitch.
    PerSecond,
}

/// In which unit F is in the block that changes units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FeedUnit {
    /// That of the block (GRBL, `gcode.c`, step 3).
    OfBlock,
    /// That of before, where there is one (LinuxCNC, found with `rs274`).
    OfBefore,
    /// That of the block where none was known before; otherwise it is not clear, and refused.
    OfFirst,
    /// It is not clear, and refused.
    Unclear,
}

impl FeedRules {
    pub const ISO: FeedRules = FeedRules {
        meaning: FeedMeaning::PerMinute,
        pitch_by_f: false,
        unit: FeedUnit::Unclear,
        mode_ends_feed: false,
        word_needs_feed: false,
    };
    pub const FANUC: FeedRules =
        FeedRules { pitch_by_f: true, unit: FeedUnit::OfFirst, ..FeedRules::ISO };
}

/// How M functions act.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Functions {
    /// One M function a block (FANUC, parameter 3404#7), which the builder may have act with the end of its move: what
    /// switches off comes last. Coolants are not added to each other.
    pub builders: bool,
    /// Stops switch spindle and coolant off.
    pub stop_switches_off: bool,
    /// Nothing guarantees that a stop switches them off.
    pub stop_leaves_on: bool,
    /// `M1` is read and does nothing.
    pub ignores_optional_stop: bool,
    /// The end of the program switches spindle and coolant off.
    pub end_switches_off: bool,
    /// `M19` takes P and Q besides R.
    pub orients_by_pq: bool,
}

impl Functions {
    pub const ISO: Functions = Functions {
        builders: false,
        stop_switches_off: false,
        stop_leaves_on: true,
        ignores_optional_stop: false,
        end_switches_off: true,
        orients_by_pq: false,
    };
    pub const FANUC: Functions = Functions { builders: true, ..Functions::ISO };
}

/// How the axes go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MotionRules {
    /// A word of group 00 with axis words may stand beside `G0`, and `G31` beside `G1`.
    pub one_shot_beside_motion: bool,
    /// How an axis that rolls over turns.
    pub rollover: Rollover,
    /// Units change before the first move only.
    pub units_at_start: bool,
    /// Other words beside `G20` and `G21` may not act (FANUC).
    pub units_alone: bool,
    /// A thread runs along one axis only.
    pub threads_along_one_axis: bool,
    /// A straight line out of the plane of compensation switches it, too (LinuxCNC, `rs274`).
    pub any_line_compensates: bool,
}

/// How an axis that rolls over turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rollover {
    /// No rule for it is known.
    NotFollowed,
    /// By the sign of its word (LinuxCNC, `WRAPPED_ROTARY`).
    BySign,
    /// The shorter way or by the sign of its word, as it is set up (FANUC, parameters 1008#0, #1).
    AsSetUp,
}

impl MotionRules {
    pub const ISO: MotionRules = MotionRules {
        one_shot_beside_motion: false,
        rollover: Rollover::NotFollowed,
        units_at_start: false,
        units_alone: false,
        threads_along_one_axis: false,
        any_line_compensates: false,
    };
    pub const FANUC: MotionRules = MotionRules {
        one_shot_beside_motion: true,
        units_at_start: true,
        threads_along_one_axis: true,
        ..MotionRules::ISO
    };
}

/// `G2` and `G3`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arcs {
    /// Whether a control takes an arc whose ends have these radii (mm) from the programmed centre, in a program in inches
    /// or not.
    pub is_circle: fn(inches: bool, start: f64, end: f64) -> bool,
    /// By how much half the chord may be longer than R where the arc is a half circle by rounding, mm.
    pub radius_slack: f64,
    /// A radius below which there is no arc, mm.
    pub least_radius: f64,
    /// Compensation may begin on an arc.
    pub may_compensate: bool,
    /// One of the axes of the plane has to be named.
    pub needs_axis: bool,
    /// What becomes of the word of the centre along the axis of the arc.
    pub outer_center: OuterCenter,
    /// P counts the turns begun.
    pub counts_turns: bool,
    /// Sections of an arc whose radii differ are risky (FANUC).
    pub counts_radii: bool,
}

/// The word of a centre along the axis of the arc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OuterCenter {
    Refused,
    /// 0 says nothing, and another is refused.
    Zero,
    Ignored,
}

/// GRBL 1.1 (`gcode.c`, step 20): up to 0.005 mm, or up to 0.5 mm where that is less than 0.1 % of the radius.
fn grbl_circle(_: bool, start: f64, end: f64) -> bool {
    let apart = (start - end).abs();
    apart <= 0.005 || (apart <= 0.5 && apart <= 0.001 * start)
}

/// Up to 0.01 mm.
pub(super) fn within_a_hundredth(_: bool, start: f64, end: f64) -> bool {
    (start - end).abs() <= 0.01
}

impl Arcs {
    pub const ISO: Arcs = Arcs {
        is_circle: grbl_circle,
        radius_slack: 1e-9,
        least_radius: 1e-6,
        may_compensate: false,
        needs_axis: false,
        outer_center: OuterCenter::Zero,
        counts_turns: false,
        counts_radii: false,
    };
}

/// Canned cycles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cycles {
    /// They are no part of group 01 (FANUC, group 09): the interpolation of before goes on behind them, and data and levels
    /// stay until `G80`. Only `G17` is followed (parameter 5101#0), and the tool is not below R at the start.
    pub apart: bool,
    /// `G86` needs its dwell P (RS274).
    pub bore_dwells: bool,
    /// Tapping in another plane than `G17` feeds along another axis.
    pub taps_in_g17: bool,
    /// Tapping without P dwells as long as the last cycle that had one.
    pub dwell_stays: bool,
    /// Tapping turns the spindle itself.
    pub turns_spindle: bool,
    /// Nobody has to say whether a tap is held in a floating chuck: no machine reads it.
    pub chuck_is_open: bool,
    /// How often the hole is made: its letter, and the least.
    pub repeats: (u8, u32),
    /// A setting says how far above R a peck cycle takes the tool to clear chips.
    pub peck_retract_is_set: bool,
    /// What holds of `G98` and `G99` at the start: up to the initial level, or nothing is known.
    pub returns: Option<bool>,
}

impl Cycles {
    pub const ISO: Cycles = Cycles {
        apart: false,
        bore_dwells: true,
        taps_in_g17: false,
        dwell_stays: false,
        turns_spindle: false,
        chuck_is_open: false,
        repeats: (b'L', 1),
        peck_retract_is_set: false,
        returns: None,
    };
    pub const FANUC: Cycles =
        Cycles { apart: true, bore_dwells: false, returns: Some(false), ..Cycles::ISO };
}

/// Work offsets and what shifts them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Offsets {
    /// `G52` is apart from `G92` and does not stay.
    pub local_apart: bool,
    /// How many there are that `G59 P` names.
    pub by_g59: Option<u32>,
    /// The offset that `G10` writes with this L and P, where one is active.
    pub written: fn(l: u32, p: Option<u32>, active: u32) -> Option<u32>,
    /// `G10 L2 P0` writes the external offset.
    pub external: bool,
    /// `G10 L20` counts from where the tool stands.
    pub sets_here: bool,
    /// In `G91` `G10` adds.
    pub adds: bool,
    /// An offset may turn the coordinates (`G10 R`).
    pub turn: bool,
}

/// `G54` to `G59` by P 1 to 6.
pub(super) fn six(_: u32, p: Option<u32>, _: u32) -> Option<u32> {
    p.filter(|p| (1..=6).contains(p)).map(|p| 53 + p)
}

/// `G54` to `G59` by `L2`, and so many further ones by `L20`.
pub(super) fn further(most: u32, l: u32, p: Option<u32>) -> Option<u32> {
    match l {
        20 => p.filter(|p| (1..=most).contains(p)).map(|p| 59 + p),
        _ => six(l, p, 0),
    }
}

impl Offsets {
    pub const ISO: Offsets = Offsets {
        local_apart: false,
        by_g59: None,
        written: six,
        external: false,
        sets_here: true,
        adds: false,
        turn: false,
    };
    pub const FANUC: Offsets =
        Offsets { local_apart: true, sets_here: false, adds: true, ..Offsets::ISO };
}

/// Turned, scaled, mirrored and polar coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameRules {
    /// The pole of polar coordinates is the zero; it is where the tool stands otherwise.
    pub pole_at_zero: bool,
    /// Mirrors are about the zero.
    pub mirrors_at_zero: bool,
    /// The axes name their factors, and the scale is about the zero.
    pub scales_by_axis: bool,
    /// In `G91` a second `G68` adds; it is a setting otherwise.
    pub turns_add: bool,
    /// The letters of the centre of `G68`, where they are not those of the axes.
    pub turn_center: Option<[u8; 2]>,
}

impl FrameRules {
    pub const ISO: FrameRules = FrameRules {
        pole_at_zero: false,
        mirrors_at_zero: false,
        scales_by_axis: false,
        turns_add: true,
        turn_center: None,
    };
    pub const FANUC: FrameRules = FrameRules { pole_at_zero: true, ..FrameRules::ISO };
}

/// Fixed positions of the machine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Homes {
    /// `G28` goes to the switches of the axes that are named.
    pub switches: bool,
    /// It leads out of a tilted plane.
    pub leaves_tilt: bool,
    /// `G30 P` names one of three positions, and `G53` is always a rapid.
    pub numbered: bool,
    /// The axes have to be named.
    pub names_axes: bool,
    /// `G28` cancels the tool length, and no position is fixed while the control keeps the tool centre point.
    pub cancels_length: bool,
    /// The first position is stored in the control by a program or by hand.
    pub stored: bool,
}

impl Homes {
    pub const ISO: Homes = Homes {
        switches: false,
        leaves_tilt: false,
        numbered: false,
        names_axes: false,
        cancels_length: false,
        stored: false,
    };
    pub const FANUC: Homes = Homes { numbered: true, ..Homes::ISO };
}

/// Tools, their lengths and radii.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tools {
    /// There is no tool changer: T says which tool the operator puts in.
    pub by_hand: bool,
    /// Every tool has a number above 0.
    pub numbered: bool,
    /// D and H stay when they stand alone, for the `G41` and `G43` to come.
    pub remembers_registers: bool,
    /// The letter of the register of the tool's or the wire's radius.
    pub radius_letter: u8,
    /// `G41` and `G42` need it.
    pub needs_radius_register: bool,
    /// `H0` is no length.
    pub h0_cancels: bool,
    /// Without H it is the length of the tool in the spindle; another length and another side need `G40` before, and
    /// there is no compensation in the plane YZ (LinuxCNC).
    pub follows_tool: bool,
    /// Parameters say along which axis a length counts and whether it moves it.
    pub length_as_set_up: bool,
    /// `G10 L1` sets lengths by Z and radii by R, as in RS274/NGC.
    pub rs274_data: bool,
}

impl Tools {
    pub const ISO: Tools = Tools {
        by_hand: false,
        numbered: false,
        remembers_registers: false,
        radius_letter: b'D',
        needs_radius_register: false,
        h0_cancels: false,
        follows_tool: false,
        length_as_set_up: false,
        rs274_data: false,
    };
    pub const FANUC: Tools = Tools { needs_radius_register: true, h0_cancels: true, ..Tools::ISO };
}

/// A wire.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WireRules {
    /// The letters of the generator's conditions.
    pub conditions: &'static [u8],
    /// The letter of the angle by which the control leans the wire.
    pub taper_letter: u8,
}

/// What holds at the start of a program, and behind its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reset {
    /// Lengths are mm whatever is set up.
    pub millimeters: bool,
    /// The control drives X, Y and Z only.
    pub three_axes: bool,
    /// What happens at corners of which the program says nothing.
    pub corners: Corners,
    /// Along which path F counts.
    pub feed_path: FeedPath,
    /// The work offset that is active; none where it is that of the last program, or there is none.
    pub work_offset: Option<WorkOffset>,
    /// What becomes of it at the end of a program.
    pub at_end: AtEnd,
}

/// What the end of a program does to plane, distance, feed mode, compensation, cycle and work offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AtEnd {
    /// It brings them back to those of a start.
    Resets,
    /// It keeps them, or a setting of the machine says whether it does.
    Keeps,
    /// No machine reads the program.
    Unread,
}

impl Reset {
    pub const ISO: Reset = Reset {
        millimeters: false,
        three_axes: false,
        corners: Corners::Followed,
        // FANUC 1408#0 (rotary feed by a radius), Haas settings 34 and 79, Mach3 "Use Radius for Feedrate".
        feed_path: FeedPath::AsSetUp,
        work_offset: Some(WorkOffset::FIRST),
        at_end: AtEnd::Keeps,
    };
    pub const FANUC: Reset = Reset { work_offset: None, ..Reset::ISO };
}
