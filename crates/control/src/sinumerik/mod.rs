//! SINUMERIK 840D sl and 828D, milling.
//!
//! What the language means, with the manual that says so: `docs/controls/sinumerik.md`. A block is
//! read whole ([`block`]), with every word looked up in a table ([`commands`], [`call`], [`cycles`]) and
//! every expression evaluated ([`expression`]); then it is carried out ([`interpreter`]).

mod arc;
mod block;
mod call;
mod commands;
mod cycles;
mod expression;
mod frames;
mod interpreter;
mod motion;
mod orientation;
mod scan;
mod state;

use crate::Settings;
use crate::compensation::Compensator;
use block::Block;
use interpreter::Interpreter;
use program::Diagnostic;
use scan::Source;

pub(crate) use state::WORK_OFFSET_AT_RESET;

/// What may go wrong.
type Fallible<T> = Result<T, Box<Diagnostic>>;

/// Most characters of a block, its end included (Programming Manual 06/2019, 2.2.2.2).
const LONGEST_BLOCK: usize = 512;

/// Runs a program.
pub(crate) fn run(settings: &Settings, text: &[u8], path: &mut Compensator) -> Fallible<()> {
    let mut interpreter = Interpreter::new(settings, path);
    let mut block = Block::empty();
    let mut line = 0u32;
    let mut started = false;
    let mut rest = text;
    while !rest.is_empty() {
        let end = memchr::memchr(b'\n', rest);
        let (piece, after) = rest.split_at(end.unwrap_or(rest.len()));
        rest = after.get(1..).unwrap_or(&[]);
        line = line.saturating_add(1);
        let piece = piece.strip_suffix(b"\r").unwrap_or(piece);
        let source = Source { line, text: piece };
        if piece.iter().all(u8::is_ascii_whitespace) {
            continue;
        }
        check_block(&source, interpreter.state.ended)?;
        if interpreter.state.ended {
            continue;
        }
        let header = !started && piece.first() == Some(&b'%');
        started = true;
        if header {
            check_header(&source)?;
            continue;
        }
        block.read(source, &interpreter.state.parameters)?;
        interpreter.run(&source, &mut block)?;
        if interpreter.state.ended && end.is_none() {
            let message = "the last block has no line end, without which the control (828D) does not \
                           take the program as ended";
            return Err(source.block_error("program-end", message));
        }
    }
    if interpreter.state.ended {
        return Ok(());
    }
    Err(Diagnostic::error("program-end", "the program has no end: M30, M2, M17 or RET is missing")
        .line(line)
        .into())
}

/// What holds for a block whatever is in it.
fn check_block(source: &Source, ended: bool) -> Fallible<()> {
    if source.text.len() >= LONGEST_BLOCK {
        let message = format!("a block has at most {LONGEST_BLOCK} characters with its end");
        return Err(source.error("block-length", LONGEST_BLOCK - 1..source.text.len(), message));
    }
    if ended && !source.text.trim_ascii_start().starts_with(b";") {
        return Err(
            source.block_error("program-end", "there are blocks behind the end of the program")
        );
    }
    Ok(())
}

/// `%_N_NAME_MPF`, `%NAME_MPF`: the name of a program that travels as a file.
fn check_header(source: &Source) -> Fallible<()> {
    let name = source.text.trim_ascii_end().get(1..).unwrap_or(&[]);
    let legal = name.iter().all(|byte| *byte == b'_' || byte.is_ascii_alphanumeric());
    let kind = name.len().checked_sub(4).and_then(|at| name.get(at..));
    if legal && matches!(kind, Some(b"_MPF" | b"_SPF")) {
        return Ok(());
    }
    Err(source.block_error("header", "the header is % and a name that ends with _MPF or _SPF"))
}
