//! Real files, read, written and proven on every machine of the library.

use crate::clock::{self, Taken};
use crate::floor;
use machine::Machine;
use machine::library::{MACHINES, names};
use program::{Diagnostic, Rule};
use std::path::{Path, PathBuf};

/// Prints what all `files` take on all machines, compared with the floor for as many bytes.
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
        .map_err(|error| vec![Diagnostic::error(Rule::Unreadable, error.to_string())])?;
    let mut machines: Vec<Machine> = names(MACHINES)
        .map(machine::load)
        .collect::<Result<_, _>>()
        .map_err(|finding| vec![*finding])?;
    machines.retain(|machine| machine.wire.is_none());
    let (mut best, mut least, mut count) = (Taken::MAX, Taken::MAX, 0);
    for _ in 0..rounds.max(1) {
        let (proven, taken) =
            clock::time(|| machines.iter().map(|machine| proven(&texts, machine)).sum());
        (best, count) = (best.faster(taken), proven);
        let ((), taken) = clock::time(|| {
            for (_, text) in machines.iter().flat_map(|_| &texts) {
                std::hint::black_box(floor::by_hand(text));
            }
        });
        least = least.faster(taken);
    }
    println!(
        "{} files on {} machines: {count} programs proven, {} refused\n  {best:.2}\n  divided by the floor by hand: {}",
        texts.len(),
        machines.len(),
        texts.len() * machines.len() - count,
        best.times(least),
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
