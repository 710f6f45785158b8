//! A program level: a program that runs, and what its caller gets back.

use super::library::Program;
use crate::kernel::Outcome;
use crate::kernel::flow::BlockLocation;
use crate::kernel::source::Source;
use crate::sinumerik::execution::state::Modes;
use crate::sinumerik::language::scan::{Name, Scanner};
use crate::sinumerik::language::statement::ProgramCall;
use crate::sinumerik::language::variables::{Locals, Variable};
use program::Rule;
use std::rc::Rc;

/// Most characters of a block, its end included (Programming Manual 06/2019, 2.2.2.2).
const LONGEST_BLOCK: usize = 512;

/// Most program levels, that of the main program included (Programming Manual 12/2019, 3.2.1.3).
pub(super) const LEVELS: usize = 16;

/// What a caller gets back.
pub(crate) struct Caller {
    pub(super) locals: Locals,
    /// Variables that were given themselves (`VAR`).
    pub(super) references: Vec<Reference>,
    /// Modal commands (`SAVE`).
    pub(super) modes: Option<Box<Modes>>,
    /// The line that events of the caller carry.
    pub(super) line: Option<u32>,
    /// What `MCALL` calls after the next motion, where it has called this program.
    pub(super) modal: Option<ProgramCall>,
    /// The values of the parameters, and how often the program runs again with them.
    pub(super) again: (u32, Vec<(Name, Variable)>),
}

/// A variable of the caller that is a parameter.
pub(super) struct Reference {
    pub(super) parameter: usize,
    pub(super) variable: usize,
    pub(super) element: Option<usize>,
}

/// A program that runs.
pub(crate) struct Level<'a> {
    pub program: Rc<Program<'a>>,
    /// The block that comes next.
    pub next: BlockLocation,
    /// Whether a block has done something, behind which no variable is defined any more.
    pub working: bool,
    /// The sections that are being repeated, the inmost last.
    pub sections: Vec<Repetition>,
    /// The last values of the `FOR` loops that run, each with the byte of its first block.
    pub counts: Vec<(usize, f64)>,
    /// What the caller gets back; none for the main program.
    pub caller: Option<Caller>,
}

/// A section that is being repeated.
pub(crate) struct Repetition {
    pub(super) from: BlockLocation,
    /// The byte behind its last block.
    pub(super) end: usize,
    /// How often it still starts again.
    pub(super) left: u32,
    /// Where it goes on afterwards.
    pub(super) back: BlockLocation,
}

impl<'a> Level<'a> {
    /// At the start of a program.
    pub fn new(program: Rc<Program<'a>>, caller: Option<Caller>) -> Level<'a> {
        let next = program.start();
        let (sections, counts) = (Vec::new(), Vec::new());
        Level { program, next, working: false, sections, counts, caller }
    }
}

pub(super) fn check_length(source: &Source) -> Outcome {
    if source.text.len() < LONGEST_BLOCK {
        return Ok(());
    }
    let message = format!("a block has at most {LONGEST_BLOCK} characters with its end");
    Err(source.error(Rule::BlockLength, LONGEST_BLOCK - 1..source.text.len(), message))
}

/// Only comments follow the end of a program without jumps.
pub(super) fn check_rest(program: &Program, mut place: BlockLocation) -> Outcome<bool> {
    while let Some((source, next)) = program.block(place.at, place.line) {
        check_length(&source)?;
        // What closes a part of the program for the editor may follow.
        let mut scanner = Scanner::new(source);
        if !scanner.take_word("GROUP_END") && !scanner.rests() {
            let message = "there are blocks behind the end of the program";
            return Err(source.block_error(Rule::ProgramEnd, message));
        }
        place = BlockLocation { at: next, line: place.line.saturating_add(1) };
    }
    Ok(true)
}
