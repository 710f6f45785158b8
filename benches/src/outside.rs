//! The clock, checked from outside: a stage that it has measured here runs again alone in a process of its own, and
//! what the system accounts to that process has to agree. A clock that leaves threads out fails.

use crate::clock::{Taken, time, time_children};
use crate::{path, programs, read_write_prove};
use program::{Diagnostic, Rule};
use std::env;
use std::ffi::OsString;
use std::fs;
use std::ops::RangeInclusive;
use std::path::Path;
use std::process::{Command, Stdio};

/// What the clock may say, as a part of the processor time that the system accounts to the process less its start-up.
/// Less than all, because a new process has its memory handed out for the first time; a thread that is left out costs
/// more. More than all only by what the same work differs from run to run.
const AGREES: RangeInclusive<f64> = 0.7..=1.1;

/// Rounds at most, where they do not agree before. Other work on the machine can only add to the processor time of a
/// round, here or there, so the least of many is nearer to what the work takes. A clock that leaves threads out is off
/// in every round.
const MOST: usize = 12;

/// The first word of a process that does one stage alone.
const ALONE: &str = "--alone";

/// Blocks for a block of the programs: long enough that start-up is little of it.
const LONGER: usize = 10;

/// GOTO at most of the toolpath.
const RECORDS: usize = 500_000;

/// Checks the clock by the two stages that use threads in different ways: a program of many `blocks` run on its
/// virtual control, and a toolpath of many `records` read, written for `machine` and proven.
///
/// # Errors
/// Where the clock and the system do not agree, or a stage fails.
pub fn check(
    blocks: usize,
    records: usize,
    machine: &str,
    rounds: usize,
) -> Result<(), Vec<Diagnostic>> {
    let folder = tempfile::tempdir().map_err(|error| failed(&error))?;
    println!(
        "the clock checked: a stage here, and alone in a process of its own; the least of some rounds"
    );
    if blocks > 0 {
        let text = |blocks| programs::plain(LONGER * blocks);
        agree(
            "plain blocks run (LinuxCNC)",
            &["run"],
            folder.path(),
            [text(blocks), text(0)],
            rounds,
        )?;
    }
    if records > 0 {
        let text = |records| path::cutter_location_data(RECORDS.min(records), true);
        let words = ["prove", machine];
        agree(
            "read, kinematics, write, prove",
            &words,
            folder.path(),
            [text(records), text(0)],
            rounds,
        )?;
    }
    Ok(())
}

/// Measures the stage of `words` here and in processes of their own, on a text and, for the start-up, on an empty one.
fn agree(
    name: &str,
    words: &[&str],
    folder: &Path,
    texts: [String; 2],
    rounds: usize,
) -> Result<(), Vec<Diagnostic>> {
    let file = |name: &str, text: &String| {
        let path = folder.join(name);
        fs::write(&path, text).map(|()| path.into_os_string()).map_err(|error| failed(&error))
    };
    let [long, empty] = [file("long", &texts[0])?, file("empty", &texts[1])?];
    let words = |file: &OsString| words.iter().map(OsString::from).chain([file.clone()]).collect();
    let (long_words, empty_words): (Vec<_>, Vec<_>) = (words(&long), words(&empty));
    let (mut here, mut there, mut start) = (Taken::MAX, Taken::MAX, Taken::MAX);
    // In turn, so that other work on the machine is the same for all of them.
    for round in 1..=rounds.max(MOST) {
        let (done, taken) = time(|| stage(&long_words));
        done?;
        here = here.least(taken);
        there = there.least(alone(&long_words, 1)?);
        start = start.least(alone(&empty_words, 1)?);
        if round >= rounds && AGREES.contains(&here.times(there.beyond(start)).processor) {
            break;
        }
    }
    verdict(name, here, there.beyond(start))
}

/// Whether the clock and the system agree; prints how far.
///
/// # Errors
/// Where they do not.
fn verdict(name: &str, here: Taken, there: Taken) -> Result<(), Vec<Diagnostic>> {
    let part = here.times(there).processor;
    let percent = |part: f64| format!("{:.0} %", 100.0 * part);
    let asked = format!("{} to {} is asked for", percent(*AGREES.start()), percent(*AGREES.end()));
    println!("  {name}\n    here:  {here}\n    alone: {there}, less start-up");
    println!("    the clock says {} of what the system accounts; {asked}", percent(part));
    // Not a number is in no range: there is no figure.
    if AGREES.contains(&part) {
        return Ok(());
    }
    let message = format!(
        "{name}: the clock says {} of the processor time that the system accounts to the same work; \
         {asked}, so no figure of this run can be trusted",
        percent(part)
    );
    Err(vec![Diagnostic::error(Rule::Internal, message)])
}

/// What the whole command `toolpost` with these words takes as a process of its own, start-up and files included: the
/// fastest round by wall.
///
/// # Errors
/// Where it fails.
pub fn command(words: &[&str], rounds: usize) -> Result<Taken, Vec<Diagnostic>> {
    let words: Vec<OsString> = ["toolpost"].iter().chain(words).map(OsString::from).collect();
    alone(&words, rounds)
}

/// What a process takes that does only what `words` say.
fn alone(words: &[OsString], rounds: usize) -> Result<Taken, Vec<Diagnostic>> {
    let this = env::current_exe().map_err(|error| failed(&error))?;
    let mut best = Taken::MAX;
    for _ in 0..rounds.max(1) {
        let mut command = Command::new(&this);
        command.arg(ALONE).args(words).stdin(Stdio::null()).stdout(Stdio::null());
        let (status, taken) = time_children(|| command.status());
        let status = status.map_err(|error| failed(&error))?;
        if !status.success() {
            return Err(vec![Diagnostic::error(
                Rule::Internal,
                format!("{words:?} alone: {status}"),
            )]);
        }
        best = best.faster(taken);
    }
    Ok(best)
}

/// Where this process is asked for one stage alone: does it, and answers the exit code.
pub fn asked() -> Option<u8> {
    let mut words = env::args_os().skip(1);
    if words.next()? != ALONE {
        return None;
    }
    let words: Vec<OsString> = words.collect();
    if words.first().is_some_and(|word| word == "toolpost") {
        return Some(toolpost::run(words, None));
    }
    Some(match stage(&words) {
        Ok(()) => 0,
        Err(findings) => {
            findings.iter().for_each(|finding| eprintln!("{finding}"));
            1
        }
    })
}

/// Does a stage on the file that is named last.
fn stage(words: &[OsString]) -> Result<(), Vec<Diagnostic>> {
    let words: Vec<_> = words.iter().map(|word| word.to_string_lossy()).collect();
    let words: Vec<&str> = words.iter().map(AsRef::as_ref).collect();
    let read = |file: &str| fs::read_to_string(file).map_err(|error| failed(&error));
    match words[..] {
        ["run", file] => programs::run(control::Dialect::LinuxCnc, &read(file)?),
        ["prove", name, file] => {
            let machine = machine::load(name).map_err(|finding| vec![*finding])?;
            read_write_prove(&read(file)?, &machine)
        }
        _ => Err(vec![Diagnostic::error(Rule::Internal, format!("no stage: {words:?}"))]),
    }
}

/// What the system refuses.
pub fn failed(error: &std::io::Error) -> Vec<Diagnostic> {
    vec![Diagnostic::error(Rule::Internal, error.to_string())]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn taken(processor: u64) -> Taken {
        let processor = Duration::from_millis(processor);
        Taken { processor, wall: Duration::from_millis(800) }
    }

    #[test]
    fn a_clock_agrees_from_70_to_110_percent_of_what_the_system_accounts() {
        for (here, agrees) in [(40, false), (690, false), (710, true), (1090, true), (1110, false)]
        {
            assert_eq!(verdict("a stage", taken(here), taken(1000)).is_ok(), agrees, "{here}");
        }
    }

    #[test]
    fn a_system_that_accounts_nothing_is_refused() {
        for here in [0, 1] {
            let found = verdict("a stage", taken(here), taken(0)).unwrap_err();
            assert_eq!(found[0].rule, Rule::Internal);
        }
    }
}
