//! Numbers of programs and blocks and the loops of a file in custom macro B (B-63684EN, 16.3 and 16.5): found when the first jump or
//! call needs them.

use super::start::start;
use crate::iso::language::Fault;
use crate::iso::language::arithmetic;
use crate::kernel::decimal;
use crate::kernel::flow::{self, BlockLocation, Labels, Structures};
use program::{Diagnostic, Rule};

/// What begins a statement.
const KEYWORDS: [(&[u8], Keyword); 10] = [
    (b"IF", Keyword::If),
    (b"WHILE", Keyword::While),
    (b"DO", Keyword::Do),
    (b"END", Keyword::End),
    (b"GOTO", Keyword::GoTo),
    (b"POPEN", Keyword::Print),
    (b"PCLOS", Keyword::Print),
    (b"DPRNT", Keyword::Print),
    (b"BPRNT", Keyword::Print),
    (b"SETVN", Keyword::Print),
];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keyword {
    If,
    While,
    Do,
    End,
    GoTo,
    /// Goes to a printer or gives a name to a variable, and moves nothing.
    Print,
}

/// The numbers of programs and blocks and the loops of a file.
#[derive(Debug, Default)]
pub(super) struct Numbers {
    /// Where each program begins.
    programs: Vec<usize>,
    pub(super) by_number: Labels<u32>,
    blocks: Labels<u32>,
    /// Each `DO` and `END` by its number.
    pub(super) loops: Structures<usize>,
}

/// Where the statement of a line stands, if the line is one.
pub(super) fn at(line: &[u8]) -> Option<usize> {
    let at = match line.first()? {
        b'#' => return Some(0),
        b' ' | b'\t' | b'/' | b'N' => start(line).0,
        b'A'..=b'Z' => 0,
        _ => return None,
    };
    match line.get(at)? {
        b'#' => Some(at),
        b'A'..=b'Z' if line.get(at + 1).is_some_and(u8::is_ascii_uppercase) => Some(at),
        _ => None,
    }
}

/// The keyword at `at` and its length.
pub(super) fn keyword(line: &[u8], at: usize) -> Option<(Keyword, usize)> {
    let rest = line.get(at..)?;
    let found = KEYWORDS.iter().find(|(word, _)| rest.starts_with(word));
    found.map(|(word, keyword)| (*keyword, word.len()))
}

/// The number of a `DO` or `END` behind the keyword: 1, 2 or 3.
fn loop_number(line: &[u8], at: usize) -> Option<usize> {
    let rest = line.get(at..)?.trim_ascii_start();
    let number = decimal::parse(rest).filter(|n| matches!(n.value, 1.0 | 2.0 | 3.0) && !n.point)?;
    Some(number.value as usize)
}

/// The `DO` of a line that loops, the place behind it.
pub(super) fn do_of(line: &[u8], at: usize) -> Option<usize> {
    match keyword(line, at)? {
        (Keyword::Do, length) => Some(at + length),
        (Keyword::While, _) => {
            // It stands behind the last bracket.
            let bracket = line.iter().rposition(|&b| b == b']')?;
            let rest = &line[bracket + 1..];
            let blanks = rest.iter().take_while(|b| matches!(b, b' ' | b'\t')).count();
            rest.get(blanks..)?.starts_with(b"DO").then_some(bracket + 1 + blanks + 2)
        }
        _ => None,
    }
}

impl Numbers {
    /// Finds the numbers and loops of `text`; those in blocks with `/` are none where block delete is on
    /// (`deletes`).
    pub(super) fn of(text: &[u8], deletes: bool) -> Result<Numbers, Fault> {
        let mut found = Numbers { programs: vec![0], ..Numbers::default() };
        let mut percent_signs = 0;
        for (place, after, content) in flow::lines(text) {
            percent_signs += u8::from(content.first() == Some(&b'%'));
            if percent_signs == 2 {
                break;
            }
            let deleted = deletes && content.trim_ascii_start().first() == Some(&b'/');
            let (start, number) = start(content);
            if deleted {
                continue;
            }
            if let Some(number) = number {
                found.blocks.add(number, place);
            }
            let fault = |message: &str| -> Fault {
                let fault = Diagnostic::error(Rule::Macro, message);
                fault.at(place.line, content, start, content.len()).into()
            };
            if let Some(b'O' | b':') = content.get(start) {
                let rest = content.get(start + 1..).unwrap_or_default();
                let number = decimal::parse(rest.trim_ascii_start());
                let Some(number) = number.and_then(|n| arithmetic::whole(n.value)) else {
                    return Err(fault("O needs the number of the program"));
                };
                found.programs.push(place.at);
                if !found.by_number.add(number, place) {
                    return Err(fault("two programs of this number are in the file"));
                }
                found.loops_end(text)?;
                continue;
            }
            let Some(statement) = at(content) else { continue };
            if let Some(behind) = do_of(content, statement) {
                let Some(number) = loop_number(content, behind) else {
                    return Err(fault("DO needs its number 1, 2 or 3"));
                };
                let loops = &found.loops;
                if loops.unclosed().any(|[first, _]| loops[first].word == number) {
                    return Err(fault("a loop of this number is around this one"));
                }
                found.loops.open(number, [place, after]);
            } else if let Some((Keyword::End, length)) = keyword(content, statement) {
                let begun = found.loops.unclosed().next_back();
                let begun = begun.map(|[first, _]| found.loops[first].word);
                let Some(number) =
                    begun.filter(|_| begun == loop_number(content, statement + length))
                else {
                    return Err(fault("END without its DO, or across another loop"));
                };
                found.loops.close(number, [place, after]);
            }
        }
        found.loops_end(text)?;
        Ok(found)
    }

    /// # Errors
    /// A loop has no end.
    fn loops_end(&self, text: &[u8]) -> Result<(), Fault> {
        let Some([begun, _]) = self.loops.unclosed().next() else { return Ok(()) };
        let place = self.loops[begun].place;
        let rest = text.get(place.at..).unwrap_or_default();
        let content = rest.split(|&b| b == b'\n').next().unwrap_or_default();
        let fault = Diagnostic::error(Rule::Macro, "the DO has no END");
        Err(fault.at(place.line, content, 0, content.len()).into())
    }

    /// The block of this number that a jump from byte `from` finds: downwards to the end of the program,
    /// then from its start.
    pub(super) fn block(&self, number: u32, from: usize) -> Option<BlockLocation> {
        let program = self.programs.partition_point(|at| *at <= from).saturating_sub(1);
        let start = *self.programs.get(program)?;
        let end = self.programs.get(program + 1).copied().unwrap_or(usize::MAX);
        let find = |from| self.blocks.behind(&number, from).filter(|place| place.at < end);
        find(from).or_else(|| find(start))
    }
}
