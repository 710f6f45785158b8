//! The way from a control to who asked: its events go out one by one, compensated, and jumps are counted against them.

use super::Outcome;
use super::budget::Budget;
use super::compensation::{Compensator, Terms};
use super::relay;
use crate::event::{Action, Event};
use crate::{Settings, Sink};
use program::{Compensation, Diagnostic};

/// Length of a program, bytes, from which its control runs in a thread of its own.
pub(crate) const LONG: usize = 1 << 16;

/// Where the events of a control go.
pub struct Channel<'a> {
    compensator: Compensator<'a>,
    /// How far the program may still jump without a move.
    pub budget: Budget,
}

impl<'a> Channel<'a> {
    fn new(settings: &'a Settings, sink: &'a mut Sink<'a>) -> Channel<'a> {
        Channel { compensator: Compensator::new(settings, sink), budget: Budget::default() }
    }

    /// Takes any event but a change of compensation.
    ///
    /// # Errors
    /// What the caller answered; or the event does not fit to compensation that is on.
    #[inline]
    pub fn take(&mut self, event: Event) -> Outcome {
        self.budget.note(&event.action);
        self.compensator.take(event)
    }

    /// An event of what `line` does.
    ///
    /// # Errors
    /// As [`Channel::take`].
    pub fn report(&mut self, line: u32, action: Action) -> Outcome {
        self.take(Event { line, action })
    }

    /// Compensation changes to `side` in `line`, with the next move.
    pub(crate) fn switch(&mut self, line: u32, side: Compensation, terms: Terms) -> Outcome {
        self.compensator.switch(line, side, terms)
    }
}

/// Runs a control: `language` reads `text` and hands its events to the channel, from which `sink` takes them in order and on
/// this thread. What a language reads is named by `file_name`, where it names no other file.
///
/// # Errors
/// What `language` or `sink` answered first.
pub fn run(
    settings: &Settings,
    file_name: &str,
    text: &[u8],
    sink: &mut Sink,
    language: impl FnOnce(&mut Channel) -> Outcome + Send,
) -> Outcome {
    let control = |sink: &mut Sink| {
        let mut channel = Channel::new(settings, sink);
        language(&mut channel)?;
        channel.compensator.finish()
    };
    let read = if text.len() < LONG { control(sink) } else { relay::relayed(control, sink) };
    read.map_err(|d| if d.file.is_empty() { shown(*d, text).file(file_name).into() } else { d })
}

/// With the block that it is about, where only its line is known.
fn shown(found: Diagnostic, text: &[u8]) -> Diagnostic {
    let line = found.line;
    if line == 0 || found.column > 0 || !found.excerpt.is_empty() {
        return found;
    }
    let block = program::line_of(text, line);
    found.at(line, block, 0, block.trim_ascii_end().len())
}
