//! O-words of RS274/NGC: subroutines, branches and loops (LinuxCNC manual, "O Codes").
//!
//! The O-words of a file are found and matched once, when the first of them is met; a line without
//! one is never looked at for that.

use super::start::start;
use crate::iso::language::Fault;
use crate::kernel::decimal;
use crate::kernel::flow::{self, BlockLocation, Structures};
use program::{Diagnostic, Rule};
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
    name: Vec<u8>,
    /// Position in the line, behind the keyword.
    pub rest: usize,
    /// Of what begins a branch or loop, the first O-word of this name in the subroutine that does.
    pub twin: Option<usize>,
}

/// The O-words of a file. The partner of a `break` or `continue` is the loop that it leaves.
#[derive(Debug, Default)]
pub(super) struct OWords {
    pub words: Structures<OWord>,
    pub subroutines: HashMap<Box<[u8]>, usize>,
}

/// Where the O of a line stands, if the line begins with one.
pub(super) fn at(line: &[u8]) -> Option<usize> {
    // The first byte decides for nearly every line.
    let (at, _) = match line.first()? {
        b'O' | b'o' => return Some(0),
        b' ' | b'\t' | b'/' | b'N' | b'n' => start(line),
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

impl OWords {
    /// Finds the O-words of `text` and matches them; those in blocks with `/` are none where block
    /// delete is on (`deletes`).
    pub(super) fn of(text: &[u8], deletes: bool) -> Result<OWords, Fault> {
        let mut found = OWords::default();
        // The names of branches and loops, within their subroutine.
        let mut names: HashMap<(Vec<u8>, Vec<u8>), usize> = HashMap::new();
        let mut percent_signs = 0;
        for (place, after, content) in flow::lines(text) {
            percent_signs += u8::from(content.first() == Some(&b'%'));
            if percent_signs == 2 {
                break;
            }
            let Some(o) = at(content) else { continue };
            if deletes && content.trim_ascii_start().first() == Some(&b'/') {
                continue;
            }
            let fault = |message: &str| -> Fault {
                let fault = Diagnostic::error(Rule::OWord, message);
                fault.at(place.line, content, o, content.len()).into()
            };
            let (name, keyword, rest) = parse(content, o).map_err(fault)?;
            let name = match name {
                Name::Written(name) => name,
                Name::Calculated if keyword == Keyword::Call => Vec::new(),
                Name::Calculated => return Err(fault("only a call may calculate its O number")),
            };
            found.add(&mut names, name, keyword, rest, [place, after]).map_err(|m| fault(&m))?;
        }
        if let Some([begun, _]) = found.words.unclosed().next_back() {
            let mark = &found.words[begun];
            let content = text.get(mark.place.at..mark.after.at).unwrap_or_default();
            let content = content.trim_ascii_end();
            let fault = Diagnostic::error(Rule::OWord, "what begins here has no end");
            return Err(fault.at(mark.place.line, content, 0, content.len()).into());
        }
        Ok(found)
    }

    /// Adds an O-word, and says what is wrong where it does not fit to those before it.
    fn add(
        &mut self,
        names: &mut HashMap<(Vec<u8>, Vec<u8>), usize>,
        name: Vec<u8>,
        mut keyword: Keyword,
        rest: usize,
        place: [BlockLocation; 2],
    ) -> Result<(), String> {
        let words = &mut self.words;
        if words.unclosed().len() > DEEPEST {
            return Err("O-words nest too deep".into());
        }
        let inmost = words.unclosed().next_back().map(|[first, _]| &words[first].word);
        let inmost = inmost.map(|word| (word.keyword, word.name == name));
        let closes = |keyword: Keyword| inmost == Some((keyword, true));
        if keyword == Keyword::While && closes(Keyword::Do) {
            keyword = Keyword::DoWhile;
        }
        let wanted = keyword.begins();
        if let Some((begins, shown)) = wanted
            && !closes(begins)
        {
            return Err(unmatched(words, shown));
        }
        let outmost = words.unclosed().next().map(|[first, _]| &words[first].word);
        let sub = outmost.filter(|word| word.keyword == Keyword::Sub);
        let mut word = OWord { keyword, name, rest, twin: None };
        match keyword {
            Keyword::Call => words.single(word, place, None),
            Keyword::Sub | Keyword::Program => {
                if outmost.is_some() {
                    return Err("a subroutine begins inside of another O-word".into());
                }
                let name = word.name.as_slice().into();
                let index = match keyword == Keyword::Sub {
                    true => words.open(word, place),
                    false => words.single(word, place, None),
                };
                if self.subroutines.insert(name, index).is_some() {
                    return Err("this subroutine is defined twice".into());
                }
                index
            }
            Keyword::Return if sub.is_none() => {
                return Err("a return outside of a subroutine".into());
            }
            Keyword::Return => words.single(word, place, None),
            Keyword::If | Keyword::While | Keyword::Do | Keyword::Repeat => {
                let within = sub.map_or(Vec::new(), |sub| sub.name.clone());
                let key = (within, word.name.clone());
                word.twin = Some(*names.entry(key).or_insert(place[0].at));
                words.open(word, place)
            }
            Keyword::Break | Keyword::Continue => {
                let is_loop = |begun: &OWord| {
                    begun.name == word.name && matches!(begun.keyword, Keyword::While | Keyword::Do)
                };
                let begun = words.unclosed().rev().find(|[first, _]| is_loop(&words[*first].word));
                if begun.is_none() {
                    return Err("no while or do with this number is around it".into());
                }
                words.single(word, place, begun.map(|[first, _]| first))
            }
            Keyword::ElseIf | Keyword::Else => words.clause(word, place).unwrap_or_default(),
            Keyword::EndSub
            | Keyword::DoWhile
            | Keyword::EndIf
            | Keyword::EndWhile
            | Keyword::EndRepeat => words.close(word, place).unwrap_or_default(),
        };
        Ok(())
    }
}

impl Keyword {
    /// What this one continues or ends, and how that is shown.
    fn begins(self) -> Option<(Keyword, &'static str)> {
        match self {
            Keyword::EndSub => Some((Keyword::Sub, "sub")),
            Keyword::DoWhile => Some((Keyword::Do, "do")),
            Keyword::ElseIf | Keyword::Else | Keyword::EndIf => Some((Keyword::If, "if")),
            Keyword::EndWhile => Some((Keyword::While, "while")),
            Keyword::EndRepeat => Some((Keyword::Repeat, "repeat")),
            Keyword::Sub
            | Keyword::Return
            | Keyword::Call
            | Keyword::If
            | Keyword::While
            | Keyword::Do
            | Keyword::Repeat
            | Keyword::Break
            | Keyword::Continue
            | Keyword::Program => None,
        }
    }
}

/// What is wrong where an end has not its beginning.
fn unmatched(words: &Structures<OWord>, wanted: &str) -> String {
    match words.unclosed().next_back() {
        None => format!("there is no {wanted} that this belongs to"),
        Some([first, _]) => format!(
            "this does not belong to the {:?} o{} of line {}, which ends first",
            words[first].word.keyword,
            String::from_utf8_lossy(&words[first].word.name),
            words[first].place.line
        ),
    }
}
