//! O-words of RS274/NGC: subroutines, branches and loops (LinuxCNC manual, "O Codes").
//!
//! The O-words of a file are found and matched once, when the first of them is met; a line without
//! one is never looked at for that.

use super::source;
use crate::iso::language::block::Fault;
use crate::kernel::decimal;
use program::Diagnostic;
use std::collections::HashMap;

/// How deep branches and loops may nest.
const DEEPEST: usize = 100;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Keyword {
    Sub,
    EndSub,
    Return,
    Call,
    If,
    ElseIf,
    Else,
    EndIf,
    While,
    EndWhile,
    Do,
    /// The `while` that ends a `do`.
    DoWhile,
    Repeat,
    EndRepeat,
    Break,
    Continue,
    /// A number alone begins a subprogram for `M98`.
    Program,
}

/// In the order in which a word is looked for: none begins with one before it.
const KEYWORDS: [(&[u8], Keyword); 15] = [
    (b"sub", Keyword::Sub),
    (b"endsub", Keyword::EndSub),
    (b"return", Keyword::Return),
    (b"call", Keyword::Call),
    (b"if", Keyword::If),
    (b"elseif", Keyword::ElseIf),
    (b"else", Keyword::Else),
    (b"endif", Keyword::EndIf),
    (b"while", Keyword::While),
    (b"endwhile", Keyword::EndWhile),
    (b"do", Keyword::Do),
    (b"repeat", Keyword::Repeat),
    (b"endrepeat", Keyword::EndRepeat),
    (b"break", Keyword::Break),
    (b"continue", Keyword::Continue),
];

/// A line with an O-word.
#[derive(Debug)]
pub(super) struct OWord {
    pub keyword: Keyword,
    /// Where the line begins, and where the next one does.
    pub from: usize,
    pub next: usize,
    pub line: u32,
    /// Place in the line behind the keyword.
    pub rest: usize,
    /// The O-word that belongs to this one: the next clause of a branch, the other end of a loop or a
    /// subroutine, the loop that is left.
    pub partner: usize,
    /// The end of the branch that a clause belongs to.
    pub end: usize,
    /// The first O-word of this name in the subroutine, where it begins more than one branch or loop.
    pub twin: Option<usize>,
}

/// The O-words of a file.
#[derive(Debug, Default)]
pub(super) struct OWords {
    pub words: Vec<OWord>,
    pub subroutines: HashMap<Box<[u8]>, usize>,
}

/// Where the O of a line stands, if the line begins with one.
pub(super) fn at(line: &[u8]) -> Option<usize> {
    // Nearly every line is told by its first byte.
    let (at, _) = match line.first()? {
        b'O' | b'o' => return Some(0),
        b' ' | b'\t' | b'/' | b'N' | b'n' => source::start(line),
        _ => return None,
    };
    matches!(line.get(at), Some(b'O' | b'o')).then_some(at)
}

/// The name of an O-word.
pub(super) enum Name {
    Written(Vec<u8>),
    /// `o#1` or `o[#1]`, evaluated when it is run.
    Calculated,
}

/// An O-word taken apart: its name, its keyword and the place behind that.
pub(super) fn parse(line: &[u8], o: usize) -> Result<(Name, Keyword, usize), &'static str> {
    let blanks = |at: usize| {
        let rest = line.get(at..).unwrap_or_default();
        at + rest.iter().take_while(|b| matches!(b, b' ' | b'\t')).count()
    };
    let mut at = blanks(o + 1);
    let rest = line.get(at..).unwrap_or_default();
    let name = match rest.first() {
        Some(b'<') => {
            let length = memchr::memchr(b'>', rest).ok_or("the name has no end; write >")?;
            at += length + 1;
            Name::Written(plain(&rest[1..length]))
        }
        Some(b'#') => {
            at += 1 + skip_parameter(&rest[1..]).ok_or("the number of the O-word has no end")?;
            Name::Calculated
        }
        Some(b'[') => {
            at += skip_brackets(rest).ok_or("the number of the O-word has no end; write ]")?;
            Name::Calculated
        }
        _ => {
            let number = decimal::parse(rest).filter(|n| n.value >= 0.0 && n.value.fract() == 0.0);
            let number = number.ok_or("an O-word needs a number or a name: o100, o<name>")?;
            at += number.len;
            Name::Written(format!("{}", number.value).into_bytes())
        }
    };
    let at = blanks(at);
    let rest = line.get(at..).unwrap_or_default();
    if matches!(rest.first(), None | Some(b'(' | b';')) {
        return Ok((name, Keyword::Program, at));
    }
    // The longest that fits: `else` begins `elseif`.
    let found = KEYWORDS.iter().filter(|(word, _)| {
        rest.get(..word.len()).is_some_and(|here| here.eq_ignore_ascii_case(word))
    });
    let (word, keyword) = found.max_by_key(|(word, _)| word.len()).ok_or(
        "no O-word: sub, endsub, return, call, if, elseif, else, endif, while, endwhile, do, \
         repeat, endrepeat, break or continue is missing",
    )?;
    Ok((name, *keyword, at + word.len()))
}

/// A name in lower case and without blanks.
fn plain(name: &[u8]) -> Vec<u8> {
    let kept = name.iter().filter(|b| !matches!(b, b' ' | b'\t'));
    kept.map(u8::to_ascii_lowercase).collect()
}

/// The length of what stands behind a `#`.
fn skip_parameter(text: &[u8]) -> Option<usize> {
    match text.first()? {
        b'<' => memchr::memchr(b'>', text).map(|n| n + 1),
        b'[' => skip_brackets(text),
        b'#' => {
            let signs = text.iter().take_while(|&&b| b == b'#').count();
            let rest = text.get(signs..)?;
            Some(signs + if rest.first() == Some(&b'#') { 0 } else { skip_parameter(rest)? })
        }
        _ => decimal::parse(text).map(|number| number.len),
    }
}

/// The length of a text in brackets.
fn skip_brackets(text: &[u8]) -> Option<usize> {
    let mut depth = 0;
    for (at, byte) in text.iter().enumerate() {
        match byte {
            b'[' => depth += 1,
            b']' if depth == 1 => return Some(at + 1),
            b']' => depth -= 1,
            _ => {}
        }
    }
    None
}

/// What is open while the O-words of a file are matched.
struct Open {
    /// The O-word that began it.
    word: usize,
    /// The clause of a branch that came last.
    last: usize,
    name: Vec<u8>,
}

impl OWords {
    /// Finds the O-words of `text` and matches them; those in blocks with `/` are none where block
    /// delete is on (`deletes`).
    pub(super) fn of(text: &[u8], deletes: bool) -> Result<OWords, Fault> {
        let mut found = OWords::default();
        let mut open: Vec<Open> = Vec::new();
        // The names of branches and loops, within their subroutine.
        let mut names: HashMap<(Vec<u8>, Vec<u8>), usize> = HashMap::new();
        let mut percent_signs = 0;
        for (from, next, line, content) in source::lines(text) {
            percent_signs += u8::from(content.first() == Some(&b'%'));
            if percent_signs == 2 {
                break;
            }
            let Some(o) = at(content) else { continue };
            if deletes && content.trim_ascii_start().first() == Some(&b'/') {
                continue;
            }
            let fault = |message: &str| -> Fault {
                Diagnostic::error("nc-o-word", message).at(line, content, o, content.len()).into()
            };
            let (name, keyword, rest) = parse(content, o).map_err(fault)?;
            let index = found.words.len();
            let mut word =
                OWord { keyword, from, next, line, rest, partner: index, end: index, twin: None };
            let name = match name {
                Name::Written(name) => name,
                Name::Calculated if keyword == Keyword::Call => Vec::new(),
                Name::Calculated => return Err(fault("only a call may calculate its O number")),
            };
            if open.len() > DEEPEST {
                return Err(fault("O-words nest too deep"));
            }
            let top = open.last().map(|open| (open.word, found.words[open.word].keyword));
            let closes = |keyword: Keyword| {
                let here = open.last().filter(|open| open.name == name);
                here.is_some() && top.is_some_and(|(_, begun)| begun == keyword)
            };
            match keyword {
                Keyword::Call => {}
                Keyword::Sub | Keyword::Program => {
                    if !open.is_empty() {
                        return Err(fault("a subroutine begins inside of another O-word"));
                    }
                    if found.subroutines.insert(name.as_slice().into(), index).is_some() {
                        return Err(fault("this subroutine is defined twice"));
                    }
                    if keyword == Keyword::Sub {
                        open.push(Open { word: index, last: index, name });
                    }
                }
                Keyword::EndSub => {
                    if !closes(Keyword::Sub) {
                        return Err(fault(&unmatched(&found, &open, "sub")));
                    }
                    if let Some(sub) = open.pop() {
                        word.partner = sub.word;
                        found.words[sub.word].partner = index;
                    }
                }
                Keyword::Return => {
                    let begun = open.first();
                    if begun.is_none_or(|sub| found.words[sub.word].keyword != Keyword::Sub) {
                        return Err(fault("a return outside of a subroutine"));
                    }
                }
                Keyword::While if closes(Keyword::Do) => {
                    word.keyword = Keyword::DoWhile;
                    if let Some(begun) = open.pop() {
                        word.partner = begun.word;
                        found.words[begun.word].partner = index;
                    }
                }
                Keyword::If | Keyword::While | Keyword::Do | Keyword::Repeat => {
                    let within = open.first().map_or(Vec::new(), |sub| match sub.word {
                        word if found.words[word].keyword == Keyword::Sub => sub.name.clone(),
                        _ => Vec::new(),
                    });
                    let first = *names.entry((within, name.clone())).or_insert(index);
                    if first != index {
                        word.twin = Some(first);
                        found.words[first].twin = Some(first);
                    }
                    open.push(Open { word: index, last: index, name });
                }
                Keyword::ElseIf | Keyword::Else | Keyword::EndIf => {
                    if !closes(Keyword::If) {
                        return Err(fault(&unmatched(&found, &open, "if")));
                    }
                    let Some(branch) = open.last_mut() else { continue };
                    let last = std::mem::replace(&mut branch.last, index);
                    found.words[last].partner = index;
                    if keyword == Keyword::EndIf
                        && let Some(branch) = open.pop()
                    {
                        let mut clause = branch.word;
                        while clause != index {
                            let word = &mut found.words[clause];
                            (word.end, clause) = (index, word.partner);
                        }
                    }
                }
                Keyword::EndWhile | Keyword::EndRepeat => {
                    let (begin, shown) = match keyword {
                        Keyword::EndWhile => (Keyword::While, "while"),
                        _ => (Keyword::Repeat, "repeat"),
                    };
                    if !closes(begin) {
                        return Err(fault(&unmatched(&found, &open, shown)));
                    }
                    if let Some(begun) = open.pop() {
                        word.partner = begun.word;
                        found.words[begun.word].partner = index;
                    }
                }
                Keyword::Break | Keyword::Continue => {
                    let around = open.iter().rev().find(|open| {
                        let begun = found.words[open.word].keyword;
                        open.name == name && matches!(begun, Keyword::While | Keyword::Do)
                    });
                    let Some(around) = around else {
                        return Err(fault("no while or do with this number is around it"));
                    };
                    word.partner = around.word;
                }
                // `parse` gives none of these.
                Keyword::DoWhile => {}
            }
            found.words.push(word);
        }
        if let Some(open) = open.last() {
            let word = &found.words[open.word];
            let content = text.get(word.from..word.next).unwrap_or_default().trim_ascii_end();
            let message = "what begins here has no end";
            let fault = Diagnostic::error("nc-o-word", message);
            return Err(fault.at(word.line, content, 0, content.len()).into());
        }
        Ok(found)
    }

    /// The O-word of the line that begins at `from`.
    pub(super) fn find(&self, from: usize) -> Option<usize> {
        self.words.binary_search_by_key(&from, |word| word.from).ok()
    }
}

/// What is wrong where an end has not its beginning.
fn unmatched(found: &OWords, open: &[Open], wanted: &str) -> String {
    match open.last() {
        None => format!("there is no {wanted} that this belongs to"),
        Some(open) => format!(
            "this does not belong to the {:?} o{} of line {}, which ends first",
            found.words[open.word].keyword,
            String::from_utf8_lossy(&open.name),
            found.words[open.word].line
        ),
    }
}
