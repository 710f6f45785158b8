//! ISO code: FANUC 30i for milling, Haas, LinuxCNC's RS-274, Mach3, GRBL 1.1, Marlin.
//!
//! They share the words and the order of execution and differ in tables ([`flavors`]) and in the
//! rules that each maker states; `docs/controls/iso.md` and its neighbours say which, with sources.
//! A block is taken apart ([`block`]) and run with its records held back ([`execute`], [`motion`],
//! [`arcs`], [`cycles`], [`coordinates`], [`tools`]): a block with a mistake leaves none.

mod arcs;
mod block;
mod coordinates;
mod cycles;
mod execute;
mod flavors;
mod frames;
mod motion;
mod patterns;
mod places;

mod splines;
mod state;
mod threads;
mod tools;
mod words;

use crate::{Settings, Sink};
use block::{Block, Fault};
use execute::Control;
use program::{Diagnostic, Record};

/// Runs a program.
pub(crate) fn run(settings: &Settings, text: &[u8], sink: &mut Sink) -> Result<(), Fault> {
    let dictionary = flavors::dictionary(settings.dialect);
    let mut control = Control::new(settings, dictionary.flavor);
    let mut block = Block::new(dictionary, &settings.auxiliary);
    let mut ops = Vec::new();
    let mut percent_signs = 0;
    for (index, line) in text.split(|&b| b == b'\n').enumerate() {
        let number = u32::try_from(index + 1).unwrap_or(u32::MAX);
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        if line.first() == Some(&b'%') && !dictionary.flavor.changes_by_hand() {
            percent_signs += 1;
            if !line[1..].iter().all(|b| matches!(b, b' ' | b'\t')) || percent_signs > 2 {
                let message = "a line with % holds nothing else, and a program has two at most";
                let fault = Diagnostic::error("nc-syntax", message);
                return Err(fault.at(number, line, 0, line.len()).into());
            }
            continue;
        }
        block.read(number, line)?;
        control.execute(&mut block, percent_signs == 2, &mut ops)?;
        for op in ops.drain(..) {
            sink(Record { line: number, op })?;
        }
    }
    Ok(())
}
