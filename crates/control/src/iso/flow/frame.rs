//! A program that is under way, and what it keeps: a call begins one, its end goes back to the one before.

use super::source::SourceLocation;
use crate::StartModes;
use crate::iso::execution::state::{Length, State};
use crate::iso::language::parameters::Locals;
use crate::iso::language::words::{FeedMode, Plane};
use program::{Compensation, Coolant, Spindle};

/// What has been called, and how it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// The program itself.
    Main,
    /// `o<name> call`.
    Subroutine,
    /// `M98`.
    Subprogram,
    /// `G65`, or after a move the macro of `G66` (`modal`).
    Macro { modal: bool },
}

/// A program that is under way.
pub(crate) struct Frame<'a> {
    pub kind: Kind,
    /// Where its caller goes on.
    pub(super) back: SourceLocation<'a>,
    pub(super) caller: Option<u32>,
    pub(super) begin: SourceLocation<'a>,
    /// How often it is still run, with this time.
    pub(super) turns: u32,
    /// With which arguments.
    pub(super) locals: Option<Locals>,
    /// A block of it has been executed.
    pub begun: bool,
    /// The `repeat` loops that are under way.
    pub repeats: Vec<Repeat>,
    /// The modes that it keeps.
    pub modes: Option<Modes>,
    /// The macro that is called after each move.
    pub modal: Option<Modal<'a>>,
}

/// A `repeat` under way.
pub(crate) struct Repeat {
    /// Which of the O-words of the file.
    pub word: usize,
    /// How often it is still run, with this time.
    pub left: f64,
}

/// What `G66` has asked for.
pub(crate) struct Modal<'a> {
    pub(super) place: SourceLocation<'a>,
    pub(super) turns: u32,
    pub(super) locals: Locals,
}

impl<'a> Frame<'a> {
    pub(super) fn new(
        kind: Kind,
        begin: SourceLocation<'a>,
        back: SourceLocation<'a>,
    ) -> Frame<'a> {
        Frame {
            kind,
            back,
            caller: None,
            begin,
            turns: 1,
            locals: None,
            begun: false,
            repeats: Vec::new(),
            modes: None,
            modal: None,
        }
    }
}

/// What is kept (LinuxCNC manual, "M70 Save Modal State"): the motion word is not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Modes {
    /// They come back at the end of the subroutine (`M73`).
    pub until_return: bool,
    pub(super) inches: Option<bool>,
    pub(super) plane: Plane,
    pub(super) incremental: bool,
    pub(super) centers_absolute: bool,
    pub(super) sure: StartModes,
    pub(super) unsaid: u8,
    pub(super) feed_mode: FeedMode,
    pub(super) return_to_r: Option<bool>,
    pub(super) work_offset: u32,
    pub(super) compensation: Compensation,
    pub(super) length: Length,
    pub(super) f: Option<f64>,
    pub(super) speed: Option<f64>,
    pub(super) surface: Option<f64>,
    pub(super) spindle: Spindle,
    pub(super) coolant: Coolant,
}

impl Modes {
    pub(super) fn of(state: &State, until_return: bool) -> Modes {
        Modes {
            until_return,
            inches: state.inches,
            plane: state.plane,
            incremental: state.incremental,
            centers_absolute: state.centers_absolute,
            sure: state.sure,
            unsaid: state.frames.unsaid,
            feed_mode: state.feed_mode,
            return_to_r: state.return_to_r,
            work_offset: state.frames.active(),
            compensation: state.compensation.asked,
            length: state.length,
            f: state.f,
            speed: state.speed,
            surface: state.surface,
            spindle: state.spindle,
            coolant: state.coolant,
        }
    }
}
