//! O-words of RS274/NGC: subroutines, branches and loops (LinuxCNC manual, "O Codes").
//!
//! The O-words of a file are found and matched once, when the first of them is met; a line without
//! one is never looked at for that.

use super::block::Fault;
use super::calls::{Kind, Repeat};
use super::expression::Reader;
use super::parameters::Locals;
use super::run::Run;
use super::source::{self, Place, Source};
use crate::decimal;
use program::Diagnostic;
use std::collections::HashMap;

/// How deep branches and loops may nest.
const DEEPEST: usize = 100;

/// The most arguments of a call.
const MOST_ARGUMENTS: usize = 30;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Keyword {
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
struct OWord {
    keyword: Keyword,
    /// Where the line begins, and where the next one does.
    from: usize,
    next: usize,
    line: u32,
    /// Place in the line behind the keyword.
    rest: usize,
    /// The O-word that belongs to this one: the next clause of a branch, the other end of a loop or a
    /// subroutine, the loop that is left.
    partner: usize,
    /// The end of the branch that a clause belongs to.
    end: usize,
    /// The first O-word of this name in the subroutine, where it begins more than one branch or loop.
    twin: Option<usize>,
}

/// The O-words of a file.
#[derive(Debug, Default)]
pub(super) struct OWords {
    words: Vec<OWord>,
    subroutines: HashMap<Box<[u8]>, usize>,
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
enum Name {
    Written(Vec<u8>),
    /// `o#1` or `o[#1]`, evaluated when it is run.
    Calculated,
}

/// An O-word taken apart: its name, its keyword and the place behind that.
fn parse(line: &[u8], o: usize) -> Result<(Name, Keyword, usize), &'static str> {
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
    fn find(&self, from: usize) -> Option<usize> {
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

impl<'a> Run<'a, '_> {
    /// Runs the line `text`, whose O stands at `o`; it began at byte `from`.
    pub(super) fn o_word(&mut self, from: usize, text: &'a [u8], o: usize) -> Result<(), Fault> {
        self.flows = true;
        let source = self.here.source;
        let words = source.o_words(self.settings.setup.block_delete)?;
        let Some(index) = words.find(from) else {
            return Err(self.wrong(text, o, "this O-word stands behind the end of the program"));
        };
        let word = &words.words[index];
        if let Some(first) = word.twin
            && *self.twins.entry((source.text.as_ptr(), first)).or_insert(index) != index
        {
            let message =
                "another branch or loop of this name has been run; give it one of its own";
            return Err(self.wrong(text, o, message));
        }
        match word.keyword {
            // A definition is passed by; a called subprogram begins behind its O-word.
            Keyword::Sub => self.go(words, word.partner),
            Keyword::Program => self.rest(text, word.rest),
            Keyword::EndSub | Keyword::Return => {
                let values = self.values();
                let mut reader = Reader::new(&values, self.here.line, text, word.rest);
                let value = match reader.peek() {
                    Some(b'[') => reader.expression()?,
                    _ => None,
                };
                let at = reader.at;
                self.rest(text, at)?;
                if !self.is_within(Kind::Subroutine) {
                    return Err(self.wrong(text, o, "no call of a subroutine is under way"));
                }
                self.parameters.returned = value;
                self.leave()
            }
            Keyword::Call => self.call_subroutine(text, o),
            Keyword::If => match self.holds(text, word.rest)? {
                true => Ok(()),
                false => self.clause(words, word.partner),
            },
            Keyword::ElseIf | Keyword::Else => self.go(words, word.end),
            Keyword::EndIf | Keyword::Do => self.rest(text, word.rest),
            Keyword::While => match self.holds(text, word.rest)? {
                true => Ok(()),
                false => self.go(words, word.partner),
            },
            Keyword::EndWhile => {
                self.rest(text, word.rest)?;
                self.back_to(words, word.partner)
            }
            Keyword::DoWhile => match self.holds(text, word.rest)? {
                true => self.back_to(words, word.partner),
                false => Ok(()),
            },
            Keyword::Repeat => {
                let times = self.number(text, word.rest)?.round();
                if times < 1.0 {
                    return self.go(words, word.partner);
                }
                let repeat = Repeat { word: index, left: times };
                self.frame().repeats.push(repeat);
                Ok(())
            }
            Keyword::EndRepeat => {
                self.rest(text, word.rest)?;
                let repeats = &mut self.frame().repeats;
                let Some(repeat) = repeats.last_mut().filter(|last| last.word == word.partner)
                else {
                    return Ok(());
                };
                repeat.left -= 1.0;
                if repeat.left < 1.0 {
                    repeats.pop();
                    return Ok(());
                }
                self.go(words, word.partner)
            }
            Keyword::Break | Keyword::Continue => {
                self.rest(text, word.rest)?;
                let begin = word.partner;
                // Repeats inside of the loop are left with it.
                let end = words.words[begin].partner;
                self.frame().repeats.retain(|repeat| !(begin..end).contains(&repeat.word));
                if word.keyword == Keyword::Break {
                    return self.go(words, end);
                }
                self.back_to_line(
                    words,
                    if words.words[begin].keyword == Keyword::Do { end } else { begin },
                )
            }
        }
    }

    /// Goes on behind the O-word of this index.
    fn go(&mut self, words: &OWords, index: usize) -> Result<(), Fault> {
        let word = &words.words[index];
        self.jump(word.next, word.line)
    }

    /// Goes on behind a `do`, or at the condition of a `while`.
    fn back_to(&mut self, words: &OWords, index: usize) -> Result<(), Fault> {
        match words.words[index].keyword {
            Keyword::Do => self.go(words, index),
            _ => self.back_to_line(words, index),
        }
    }

    /// Goes on at the line of an O-word.
    fn back_to_line(&mut self, words: &OWords, index: usize) -> Result<(), Fault> {
        let word = &words.words[index];
        self.jump(word.from, word.line.saturating_sub(1))
    }

    /// Goes on in the first clause from `index` on whose condition holds, or behind the branch.
    fn clause(&mut self, words: &OWords, mut index: usize) -> Result<(), Fault> {
        loop {
            self.go(words, index)?;
            let word = &words.words[index];
            if word.keyword != Keyword::ElseIf {
                return Ok(());
            }
            let text = self.here.source.text.get(word.from..word.next).unwrap_or_default();
            if self.holds(text.trim_ascii_end(), word.rest)? {
                return Ok(());
            }
            index = word.partner;
        }
    }

    /// Whether the condition at `at` holds.
    fn holds(&mut self, text: &'a [u8], at: usize) -> Result<bool, Fault> {
        self.number(text, at).map(|value| value != 0.0)
    }

    /// The expression at `at`, which ends the line.
    fn number(&mut self, text: &'a [u8], at: usize) -> Result<f64, Fault> {
        let values = self.values();
        let mut reader = Reader::new(&values, self.here.line, text, at);
        let value = reader.expression()?.unwrap_or(0.0);
        let at = reader.at;
        self.rest(text, at)?;
        Ok(value)
    }

    /// `o<name> call [1] [2]`.
    fn call_subroutine(&mut self, text: &'a [u8], o: usize) -> Result<(), Fault> {
        let (name, _, rest) = parse(text, o).map_err(|message| self.wrong(text, o, message))?;
        let values = self.values();
        let name = match name {
            Name::Written(name) => name,
            Name::Calculated => {
                let number = Reader::new(&values, self.here.line, text, o + 1).whole("an O number");
                number?.to_string().into_bytes()
            }
        };
        let mut reader = Reader::new(&values, self.here.line, text, rest);
        let mut locals: Locals = [Some(0.0); 34];
        let mut count = 0;
        while reader.peek() == Some(b'[') {
            if count == MOST_ARGUMENTS {
                return Err(reader.wrong(format!("a call has at most {MOST_ARGUMENTS} arguments")));
            }
            count += 1;
            locals[count] = reader.expression()?;
        }
        let at = reader.at;
        self.rest(text, at)?;
        let fault = |run: &Self, message: String| run.wrong(text, o, message);
        let (place, keyword) = match self.subroutine(&name)? {
            Ok(found) => found,
            Err(message) => return Err(fault(self, message)),
        };
        if keyword != Keyword::Sub {
            return Err(fault(self, "a subprogram for M98 is called by M98".into()));
        }
        self.parameters.returned = None;
        self.call(Kind::Subroutine, place, 1, Some(locals)).map_err(|message| fault(self, message))
    }

    /// The subprogram that `M98 P` names.
    pub(super) fn o_program(&self, number: u32) -> Result<Result<Place<'a>, String>, Fault> {
        Ok(match self.subroutine(number.to_string().as_bytes())? {
            Ok((place, Keyword::Program)) => Ok(place),
            Ok(_) => Err(format!("o{number} is a subroutine: call it by o{number} call")),
            Err(message) => Err(message),
        })
    }

    /// Where a subroutine begins: in this file, in the program itself, or in a file of its name.
    fn subroutine(&self, name: &[u8]) -> Result<Result<(Place<'a>, Keyword), String>, Fault> {
        let find = |source: &'a Source<'a>| -> Result<Option<(Place<'a>, Keyword)>, Fault> {
            let words = source.o_words(self.settings.setup.block_delete)?;
            let base = name.rsplit(|&b| b == b'/').next().unwrap_or(name);
            Ok(words.subroutines.get(base).map(|&index| {
                let word = &words.words[index];
                let place = Place { source, at: word.next, line: word.line, percent_signs: 1 };
                (place, word.keyword)
            }))
        };
        for source in [self.here.source, self.main] {
            if let Some(found) = find(source)? {
                return Ok(Ok(found));
            }
        }
        let shown = String::from_utf8_lossy(name);
        match self.main.open(&self.settings.setup.folders, &[format!("{shown}.ngc")]) {
            Ok(source) => match find(source)? {
                Some(found) => Ok(Ok(found)),
                None => Ok(Err(format!("{} does not define o<{shown}> sub", source.name))),
            },
            Err(missing) => Ok(Err(format!("no o<{shown}> sub in this file, and {missing}"))),
        }
    }
}
