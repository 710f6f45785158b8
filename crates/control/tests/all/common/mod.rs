//! What the tests of the virtual controls share: running a program, by itself and for each language.

pub mod klartext;
pub mod linuxcnc;
pub mod sinumerik;

use program::Diagnostic;
use toolpost_control::{Action, Event, Settings, read};

/// The records of a program.
pub fn records(
    settings: &Settings,
    file: &str,
    text: impl AsRef<[u8]>,
) -> Result<Vec<Event>, Box<Diagnostic>> {
    let mut records = Vec::new();
    read(settings, file, text.as_ref(), &mut |record| {
        records.push(record);
        Ok(())
    })?;
    Ok(records)
}

/// What a program does.
pub fn ops(
    settings: &Settings,
    file: &str,
    text: impl AsRef<[u8]>,
) -> Result<Vec<Action>, Box<Diagnostic>> {
    let records = records(settings, file, text)?;
    Ok(records.into_iter().map(|record| record.action).collect())
}
