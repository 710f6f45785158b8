//! Real files, read, written and proven on every machine of the library.

use crate::{clock, floor};
use machine::Machine;
use machine::library::{MACHINES, names};
use program::Diagnostic;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Prints what all `files` take on all machines, beside the floor for as many bytes.
///
/// # Errors
/// A file that cannot be read.
pub fn measure(files: &[PathBuf], rounds: usize) -> Result<(), Vec<Diagnostic>> {
    if files.is_empty() {
        println!("no files of cutter-location data were named");
        return Ok(());
    }
    let texts: Vec<(&Path, Vec<u8>)> = files
        .iter()
        .map(|path| Ok((path.as_path(), std::fs::read(path)?)))
        .collect::<std::io::Result<_>>()
        .map_err(|error| vec![Diagnostic::error("unreadable", error.to_string())])?;
    let mut machines: Vec<Machine> = names(MACHINES)
        .map(machine::load)
        .collect::<Result<_, _>>()
        .map_err(|finding| vec![*finding])?;
    machines.retain(|machine| machine.wire.is_none());
    let mut best = (Duration::MAX, 0);
    let mut least = Duration::MAX;
    for _ in 0..rounds.max(1) {
        let start = clock::now();
        let proven = machines.iter().map(|machine| proven(&texts, machine)).sum();
        best = best.min((clock::now().saturating_sub(start), proven));
        let start = clock::now();
        for (_, text) in machines.iter().flat_map(|_| &texts) {
            std::hint::black_box(floor::by_hand(text));
        }
        least = least.min(clock::now().saturating_sub(start));
    }
    println!(
        "{} files on {} machines: {} programs proven, {} refused, in {:.2} s, {:.1} times the floor by hand",
        texts.len(),
        machines.len(),
        best.1,
        texts.len() * machines.len() - best.1,
        best.0.as_secs_f64(),
        best.0.as_secs_f64() / least.as_secs_f64(),
    );
    Ok(())
}

/// How many of the files have a proven program on `machine`.
fn proven(texts: &[(&Path, Vec<u8>)], machine: &Machine) -> usize {
    let one = |(path, text): &&(&Path, Vec<u8>)| {
        let name = path.display().to_string();
        let reading = source::apt::read(&name, text, &source::apt::Options::default()).ok()?;
        let output = post::write(&reading.program, machine).ok()?;
        let tolerances = proof::Tolerances::default();
        let report = proof::prove(&reading.program, machine, "program", &output.text, &tolerances);
        report.proven.then_some(())
    };
    texts.iter().filter_map(|text| one(&text)).count()
}
