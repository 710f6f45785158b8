//! A control in a thread of its own: while it runs on, its events are dealt with.

use crate::Sink;
use crate::event::Event;
use crate::kernel::queue::bounded;
use program::{Diagnostic, Rule};
use std::{mem, panic, thread};

/// Events that are handed over at once.
const BATCH: usize = 2048;

/// Hands what `run` gives to its sink over to `sink`, in the same order and on this thread, while `run` goes on
/// in another.
///
/// # Errors
/// The first of what `sink` and `run` answered, as their events come.
pub fn relayed(
    run: impl FnOnce(&mut Sink) -> Result<(), Box<Diagnostic>> + Send,
    sink: &mut Sink,
) -> Result<(), Box<Diagnostic>> {
    let (feed, taken) = bounded::<Vec<Event>>();
    thread::scope(|scope| {
        let control = scope.spawn(move || {
            let mut batch = Vec::with_capacity(BATCH);
            let result = run(&mut |event| {
                batch.push(event);
                if batch.len() < BATCH {
                    return Ok(());
                }
                // Where nobody takes it, the sink has refused an event, and its answer is the one that counts.
                let stopped = || Diagnostic::error(Rule::Stopped, "");
                batch = feed.lay(mem::take(&mut batch)).ok_or_else(stopped)?;
                Ok(())
            });
            // What came before a block that is refused comes before the refusal.
            feed.lay(batch).map_or(Ok(()), |_| result)
        });
        let answer = (|| {
            while let Some(mut batch) = taken.take() {
                batch.drain(..).try_for_each(&mut *sink)?;
                taken.give_back(batch);
            }
            Ok(())
        })();
        drop(taken);
        let run = control.join().unwrap_or_else(|cause| panic::resume_unwind(cause));
        answer.and(run)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::Action;

    /// A control that makes so many events, and then stops with an error where it has one.
    fn control(
        count: u32,
        end: Option<Rule>,
    ) -> impl FnOnce(&mut Sink) -> Result<(), Box<Diagnostic>> + Send {
        move |sink| {
            (1..=count).try_for_each(|line| sink(Event { line, action: Action::End }))?;
            end.map_or(Ok(()), |rule| Err(Diagnostic::error(rule, "").into()))
        }
    }

    #[test]
    fn every_event_arrives_in_its_order_and_before_what_is_refused_behind_it() {
        let batch = BATCH as u32;
        for count in [0, 1, batch - 1, batch, batch + 1, 20 * batch + 7] {
            for end in [None, Some(Rule::Syntax)] {
                let mut lines = Vec::new();
                let answer = relayed(control(count, end), &mut |event| {
                    lines.push(event.line);
                    Ok(())
                });
                assert!(lines.into_iter().eq(1..=count), "{count}");
                assert_eq!(answer.err().map(|found| found.rule), end);
            }
        }
    }

    #[test]
    fn the_sink_stops_a_control_that_would_go_on() {
        for last in [1, BATCH as u32, 50_000] {
            let mut taken = 0;
            let answer = relayed(control(u32::MAX, Some(Rule::Syntax)), &mut |event| {
                taken += 1;
                match event.line == last {
                    true => Err(Diagnostic::error(Rule::ProgramLength, "").into()),
                    false => Ok(()),
                }
            });
            assert_eq!(answer.unwrap_err().rule, "program-length");
            assert_eq!(taken, last);
        }
    }
}
