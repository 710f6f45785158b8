//! What a dialect of ISO code is: its words and the facts in which it differs from others, by name. Each dialect states
//! its own in a file; `docs/controls` gives the sources.
//!
//! Behind each fact stands what RS274/NGC and most others do (`ISO` of its group), and behind `FANUC` what FANUC and its
//! followers do, where that is something else.

use crate::iso::language::words::Dictionary;
use crate::{Corners, Ending, FeedPath, StartModes};
use program::WorkOffset;

/// A group of facts: `name: type = what RS274/NGC has, FANUC = what FANUC has`, where that is something else.
macro_rules! group {
    (
        $(#[$doc:meta])*
        $group:ident {
            $($(#[$fact:meta])* $name:ident: $type:ty = $iso:expr $(, FANUC = $fanuc:expr)?;)*
        }
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct $group {
            $($(#[$fact])* pub $name: $type,)*
        }

        impl $group {
            pub const ISO: $group = $group { $($name: $iso,)* };
            pub const FANUC: $group = $group { $($name: group!(@ $iso $(, $fanuc)?),)* };
        }
    };
    (@ $iso:expr) => { $iso };
    (@ $iso:expr, $fanuc:expr) => { $fanuc };
}

/// A dialect of ISO code.
#[derive(Debug)]
pub struct Facts {
    pub(crate) words: Dictionary,
    /// How its programs calculate.
    pub(crate) language: Language,
    pub(crate) syntax: Syntax,
    pub(crate) numbers: Numbers,
    pub(crate) feed: FeedRules,
    pub(crate) functions: Functions,
    pub(crate) motion: MotionRules,
    pub(crate) arcs: Arcs,
    pub(crate) cycles: Cycles,
    pub(crate) offsets: Offsets,
    pub(crate) frames: FrameRules,
    pub(crate) homes: Homes,
    pub(crate) tools: Tools,
    /// The wire, where it is a control of a wire-EDM machine.
    pub(crate) wire: Option<WireRules>,
    /// The CAM system, where it keeps toolpaths in this dialect and no machine reads them.
    pub(crate) source: Option<SourceRules>,
    pub(crate) reset: Reset,
}

/// A dialect is one value.
impl PartialEq for Facts {
    fn eq(&self, other: &Facts) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Eq for Facts {}

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
            source: None,
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
            arcs: Arcs::FANUC,
            cycles: Cycles::FANUC,
            offsets: Offsets::FANUC,
            frames: FrameRules::FANUC,
            homes: Homes::FANUC,
            tools: Tools::FANUC,
            reset: Reset::FANUC,
            ..Facts::iso(words, language)
        }
    }

    /// What a CAM system keeps in these words, and no machine reads. Lengths are mm; a comment is a line of its own in `( )`; T is
    /// a number above 0; the centre of an arc has no word along its axis. What a machine alone knows (how a tap is held, what a stop
    /// switches off, what the end of a program resets) nobody is asked for.
    pub const fn source(words: Dictionary, rules: SourceRules) -> Facts {
        Facts {
            syntax: Syntax { ending: Ending::Text, ..Syntax::ISO },
            functions: Functions { stop_leaves_on: false, ..Functions::ISO },
            arcs: Arcs { outer_center: OuterCenter::Ignored, ..Arcs::ISO },
            cycles: Cycles { returns: Some(false), ..Cycles::ISO },
            source: Some(rules),
            ..Facts::iso(words, Language::Plain)
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

group! {
    /// How a block is written.
    Syntax {
        /// Small letters are the same as capital ones.
        small_letters: bool = true, FANUC = false;
        /// Whether `,C` and `,R` put a chamfer or an arc at a corner.
        corners: CornerWords = CornerWords::None;
        /// What `(` begins.
        brackets: Brackets = Brackets::Comment;
        /// What `;` begins.
        semicolon: Semicolon = Semicolon::Comment, FANUC = Semicolon::EndOfBlock;
        /// What switches a block off on demand.
        block_delete: BlockDelete = BlockDelete::Slash, FANUC = BlockDelete::Numbered;
        /// `%` alone on its line begins and ends a program.
        percent: bool = true;
        /// A line is one command, and what follows are its parameters: texts and axes without a number, too.
        one_command: bool = false;
        /// The longest line that the control reads, bytes: with its blanks, its comments and a CR at its end.
        longest_line: usize = usize::MAX;
        /// `$` begins a command of the console.
        console: bool = false;
        /// How a program ends.
        ending: Ending = Ending::CodeOrText, FANUC = Ending::Code;
        /// P of a call without L: four digits of the program behind those of the repeats.
        repeats_in_p: bool = false;
        /// `M100` to `M199` run programs of the user, and functions of the builder may switch the kinematics.
        extended_m: bool = false;
        /// Why a letter that is none of its words is refused, where there is a reason of its own.
        refused_letter: Option<(u8, &'static str)> = None;
        /// What U, V and W are that are none of its words.
        further_axes: &'static str = "U, V and W are axes parallel to X, Y and Z (ISO 6983), and not followed: write the move as X, Y and Z",
            FANUC = "U, V and W are further axes where parameter 1020 names them, on lathes (G code system A) increments of X, Y \
                     and Z; neither is followed: write X, Y and Z, with G91 where they are increments";
    }
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
}

/// What `;` begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Semicolon {
    Comment,
    /// It is the end of the block.
    EndOfBlock,
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

group! {
    /// How numbers count.
    Numbers {
        /// What a number without a point counts is a setting of the machine, and a whole number has no point.
        point_counts: bool = false, FANUC = true;
        /// A factor of a scale without a point counts thousandths or hundred thousandths (FANUC, parameter 5400#7).
        factor_needs_point: bool = false;
        /// What P of a dwell counts.
        dwell: DwellUnit = DwellUnit::Seconds;
        /// The letter of seconds that a dwell may have in place of P.
        dwell_letter: Option<u8> = None;
        /// A dwell counts turns of the spindle in feed per turn, where it is set up so.
        dwells_by_turns: bool = false;
    }
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
    /// Seconds or milliseconds, as the operator has set it up.
    SecondsAsSetUp,
}

group! {
    /// How F is read.
    FeedRules {
        /// What F is, apart from its modes.
        meaning: FeedMeaning = FeedMeaning::PerMinute;
        /// F of a thread is its pitch; it is that of K otherwise.
        pitch_by_f: bool = false, FANUC = true;
        /// In which unit F is in the block that changes units.
        unit: FeedUnit = FeedUnit::Unclear, FANUC = FeedUnit::OfFirst;
        /// A word of the feed mode ends F, also the one that is on already.
        mode_ends_feed: bool = false;
        /// `G1` needs its F also in a block that names no axis.
        word_needs_feed: bool = false;
    }
}

/// What F is, apart from its modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FeedMeaning {
    PerMinute,
    /// With `G93` a number whose point counts.
    PointedTime,
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

group! {
    /// How M functions act.
    Functions {
        /// One M function a block (FANUC, parameter 3404#7), which the builder may have act with the end of its move: what
        /// switches off comes last. Coolants are not added to each other.
        builders: bool = false, FANUC = true;
        /// Stops switch spindle and coolant off.
        stop_switches_off: bool = false;
        /// Nothing guarantees that a stop switches them off.
        stop_leaves_on: bool = true;
        /// `M1` is read and does nothing.
        ignores_optional_stop: bool = false;
        /// The end of the program switches spindle and coolant off.
        end_switches_off: bool = true;
        /// The M function that ends coolant through the tool, where that for all coolant leaves it on.
        ends_through: Option<u32> = None;
        /// `M19` takes P and Q in addition to R.
        orients_by_pq: bool = false;
    }
}

group! {
    /// How the axes go.
    MotionRules {
        /// A word of group 00 with axis words may stand in a block with `G0`, and `G31` with `G1`.
        one_shot_with_motion: bool = false, FANUC = true;
        /// How an axis that rolls over turns.
        rollover: Rollover = Rollover::NotFollowed;
        /// Units change before the first move only.
        units_at_start: bool = false, FANUC = true;
        /// Other words in a block with `G20` and `G21` may not act (FANUC).
        units_alone: bool = false;
        /// A thread runs along one axis only.
        threads_along_one_axis: bool = false, FANUC = true;
        /// A straight line out of the plane of compensation switches it, too (LinuxCNC, `rs274`).
        any_line_compensates: bool = false;
    }
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

group! {
    /// `G2` and `G3`.
    Arcs {
        /// Whether a control takes an arc whose ends have these radii (mm) from the programmed centre, in a program in inches
        /// or not.
        is_circle: fn(inches: bool, start: f64, end: f64) -> bool = grbl_circle;
        /// By how much half the chord may be longer than R where the arc is a half circle by rounding, mm.
        radius_slack: f64 = 1e-9;
        /// A radius below which there is no arc, mm.
        least_radius: f64 = 1e-6;
        /// Compensation may begin on an arc.
        may_compensate: bool = false;
        /// One of the axes of the plane has to be named.
        needs_axis: bool = false;
        /// What becomes of the word of the centre along the axis of the arc.
        outer_center: OuterCenter = OuterCenter::Zero;
        /// P counts the turns begun.
        counts_turns: bool = false;
        /// Sections of an arc whose radii differ are risky (FANUC).
        counts_radii: bool = false;
    }
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

group! {
    /// Canned cycles.
    Cycles {
        /// They are no part of group 01 (FANUC, group 09): the interpolation of before goes on behind them, and data and levels
        /// stay until `G80`. Only `G17` is followed (parameter 5101#0), and the tool is not below R at the start.
        apart: bool = false, FANUC = true;
        /// `G86` needs its dwell P (RS274).
        bore_dwells: bool = true, FANUC = false;
        /// Tapping in another plane than `G17` feeds along another axis.
        taps_in_g17: bool = false;
        /// Tapping without P dwells as long as the last cycle that had one.
        dwell_stays: bool = false;
        /// Tapping turns the spindle itself.
        turns_spindle: bool = false;
        /// How often the hole is made: its letter, and the least.
        repeats: (u8, u32) = (b'L', 1);
        /// A setting says how far above R a peck cycle takes the tool to clear chips.
        peck_retract_is_set: bool = false;
        /// What holds of `G98` and `G99` at the start: up to the initial level, or nothing is known.
        returns: Option<bool> = None, FANUC = Some(false);
    }
}

group! {
    /// Work offsets and what shifts them.
    Offsets {
        /// `G52` is apart from `G92` and does not stay.
        local_apart: bool = false, FANUC = true;
        /// How many there are that `G59 P` names.
        by_g59: Option<u32> = None;
        /// The offset that `G10` writes with this L and P, where one is active.
        written: fn(l: u32, p: Option<u32>, active: u32) -> Option<u32> = six;
        /// `G10 L2 P0` writes the external offset.
        external: bool = false;
        /// `G10 L20` counts from where the tool stands.
        sets_here: bool = true, FANUC = false;
        /// In `G91` `G10` adds.
        adds: bool = false, FANUC = true;
        /// An offset may turn the coordinates (`G10 R`).
        turn: bool = false;
        /// `G28` takes away that of its axes, and its word said again does not bring it back; `G53`, and another offset, do.
        homing_takes_away: bool = false;
    }
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

group! {
    /// Turned, scaled, mirrored and polar coordinates.
    FrameRules {
        /// The pole of polar coordinates is the zero; it is where the tool stands otherwise.
        pole_at_zero: bool = false, FANUC = true;
        /// Mirrors are about the zero.
        mirrors_at_zero: bool = false;
        /// The axes name their factors, and the scale is about the zero.
        scales_by_axis: bool = false;
        /// In `G91` a second `G68` adds; it is a setting otherwise.
        turns_add: bool = true;
        /// The letters of the centre of `G68`, where they are not those of the axes.
        turn_center: Option<[u8; 2]> = None;
    }
}

group! {
    /// Fixed positions of the machine.
    Homes {
        /// `G28` goes to the switches of the axes that are named.
        switches: bool = false;
        /// It leads out of a tilted plane.
        leaves_tilt: bool = false;
        /// `G30 P` names one of three positions, and `G53` is always a rapid.
        numbered: bool = false, FANUC = true;
        /// The axes have to be named.
        names_axes: bool = false;
        /// `G28` cancels the tool length, and no position is fixed while the control keeps the tool centre point.
        cancels_length: bool = false;
        /// The first position is stored in the control by a program or by hand.
        stored: bool = false;
    }
}

group! {
    /// Tools, their lengths and radii.
    Tools {
        /// There is no tool changer: T says which tool the operator puts in.
        by_hand: bool = false;
        /// D and H stay when they stand alone, for the `G41` and `G43` to come.
        remembers_registers: bool = false;
        /// The letter of the register of the tool's or the wire's radius.
        radius_letter: u8 = b'D';
        /// `G41` and `G42` need it.
        needs_radius_register: bool = false, FANUC = true;
        /// `H0` is no length.
        h0_cancels: bool = false, FANUC = true;
        /// Without H it is the length of the tool in the spindle; another length and another side need `G40` before, and
        /// there is no compensation in the plane YZ (LinuxCNC).
        follows_tool: bool = false;
        /// Parameters say along which axis a length counts and whether it moves it.
        length_as_set_up: bool = false;
        /// `G10 L1` sets lengths by Z and radii by R, as in RS274/NGC.
        rs274_data: bool = false;
    }
}

/// A wire.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WireRules {
    /// The letters of the generator's conditions.
    pub conditions: &'static [u8],
    /// The letter of the angle by which the control leans the wire.
    pub taper_letter: u8,
}

/// How a CAM system writes what it keeps.
#[derive(Clone, Copy, Debug)]
pub struct SourceRules {
    /// The feed, mm/min, that is meant by a number with so many digits before and behind its point. Next to a tap F is the pitch,
    /// mm, and next to a rapid no feed of the moves behind it.
    pub feed: fn(value: f64, digits: [u8; 2]) -> f64,
    /// What is so large is no number: it could not be worked out.
    pub largest: f64,
}

group! {
    /// What holds at the start of a program, and behind its end.
    Reset {
        /// The control drives X, Y and Z only.
        three_axes: bool = false;
        /// What happens at corners of which the program says nothing.
        corners: Corners = Corners::Followed;
        /// Along which path F counts: FANUC 1408#0 (rotary feed by a radius), Haas settings 34 and 79, Mach3 "Use Radius for
        /// Feedrate".
        feed_path: FeedPath = FeedPath::AsSetUp;
        /// The work offset that is active; none where it is that of the last program, or there is none.
        work_offset: Option<WorkOffset> = Some(WorkOffset::FIRST), FANUC = None;
        /// What becomes of it at the end of a program.
        at_end: AtEnd = AtEnd::Keeps;
        /// The modes that are sure before a program says them; the others are set up at the machine.
        modes: StartModes = StartModes::SURE;
    }
}

/// What the end of a program does to plane, distance, feed mode, compensation, cycle and work offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AtEnd {
    /// It brings them back to those of a start.
    Resets,
    /// It keeps them, or a setting of the machine says whether it does.
    Keeps,
}
