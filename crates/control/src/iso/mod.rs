//! ISO code: FANUC 30i for milling, LinuxCNC's RS-274, and GRBL 1.1.
//!
//! The three share the words and the order of execution and differ in tables ([`words`]) and in the
//! rules that each maker states; `docs/controls/iso.md` and its neighbours say which, with sources.
//! A block is taken apart ([`block`]), run on a copy of the [`state`] with its records held back
//! ([`execute`], [`motion`], [`arcs`], [`cycles`]), and only a block without a mistake takes effect.

mod arcs;
mod block;
mod cycles;
mod execute;
mod motion;
mod state;
mod words;

use crate::Settings;
use crate::compensation::Compensator;
use block::{Block, Fault};
use execute::Control;
use program::{Diagnostic, Op, Record};
use words::{Dictionary, Flavor};

/// Runs a program.
pub(crate) fn run(settings: &Settings, text: &[u8], path: &mut Compensator) -> Result<(), Fault> {
    let dictionary = Dictionary::of(settings.dialect);
    let mut control = Control::new(settings, dictionary.flavor);
    let mut block = Block::new(dictionary, &settings.auxiliary);
    let mut ops = Vec::new();
    let mut percent_signs = 0;
    for (index, line) in text.split(|&b| b == b'\n').enumerate() {
        let number = u32::try_from(index + 1).unwrap_or(u32::MAX);
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        if line.first() == Some(&b'%') && dictionary.flavor != Flavor::Grbl {
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
            match op {
                Op::Compensation(side) => path.switch(number, side, control.compensation())?,
                op => path.take(Record { line: number, op })?,
            }
        }
    }
    Ok(())
}
