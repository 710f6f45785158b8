//! O-words as they are run: branches, loops and calls of subroutines (LinuxCNC manual, "O Codes").

use super::frame::{Kind, Repeat};
use super::owords::{Keyword, Name, OWords, parse};
use super::run::Run;
use super::source::{Source, SourceLocation};
use crate::iso::language::Fault;
use crate::iso::language::expression::Reader;
use crate::iso::language::parameters::Locals;

/// The most arguments of a call.
const MOST_ARGUMENTS: usize = 30;

impl<'a> Run<'a, '_> {
    /// Runs the line `text`, whose O stands at `o`; it began at byte `from`.
    pub(super) fn o_word(&mut self, from: usize, text: &'a [u8], o: usize) -> Result<(), Fault> {
        self.flows = true;
        let source = self.here.source;
        let words = source.o_words(self.settings.setup.block_delete)?;
        let Some(index) = words.words.find(from) else {
            return Err(self.wrong(text, o, "this O-word stands behind the end of the program"));
        };
        let mark = &words.words[index];
        let word = &mark.word;
        if let Some(first) = word.twin
            && *self.twins.entry((source.text.as_ptr(), first)).or_insert(index) != index
        {
            let message =
                "another branch or loop of this name has been run; give it one of its own";
            return Err(self.wrong(text, o, message));
        }
        match word.keyword {
            // A definition is passed by; a called subprogram begins behind its O-word.
            Keyword::Sub => self.go(words, mark.partner),
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
                false => self.clause(words, mark.partner),
            },
            Keyword::ElseIf | Keyword::Else => self.go(words, words.words.end(index)),
            Keyword::EndIf | Keyword::Do => self.rest(text, word.rest),
            Keyword::While => match self.holds(text, word.rest)? {
                true => Ok(()),
                false => self.go(words, mark.partner),
            },
            Keyword::EndWhile => {
                self.rest(text, word.rest)?;
                self.back_to(words, mark.partner)
            }
            Keyword::DoWhile => match self.holds(text, word.rest)? {
                true => self.back_to(words, mark.partner),
                false => Ok(()),
            },
            Keyword::Repeat => {
                let times = self.number(text, word.rest)?.round();
                if times < 1.0 {
                    return self.go(words, mark.partner);
                }
                let repeat = Repeat { word: index, left: times };
                self.frame().repeats.push(repeat);
                Ok(())
            }
            Keyword::EndRepeat => {
                self.rest(text, word.rest)?;
                let repeats = &mut self.frame().repeats;
                let Some(repeat) = repeats.last_mut().filter(|last| last.word == mark.partner)
                else {
                    return Ok(());
                };
                repeat.left -= 1.0;
                if repeat.left < 1.0 {
                    repeats.pop();
                    return Ok(());
                }
                self.go(words, mark.partner)
            }
            Keyword::Break | Keyword::Continue => {
                self.rest(text, word.rest)?;
                let begin = mark.partner;
                // Repeats inside of the loop are left with it.
                let end = words.words.end(begin);
                self.frame().repeats.retain(|repeat| !(begin..end).contains(&repeat.word));
                if word.keyword == Keyword::Break {
                    return self.go(words, end);
                }
                self.back_to_line(
                    words,
                    if words.words[begin].word.keyword == Keyword::Do { end } else { begin },
                )
            }
        }
    }

    /// Goes on behind the O-word of this index.
    fn go(&mut self, words: &OWords, index: usize) -> Result<(), Fault> {
        self.jump(words.words[index].after)
    }

    /// Goes on behind a `do`, or at the condition of a `while`.
    fn back_to(&mut self, words: &OWords, index: usize) -> Result<(), Fault> {
        match words.words[index].word.keyword == Keyword::Do {
            true => self.go(words, index),
            false => self.back_to_line(words, index),
        }
    }

    /// Goes on at the line of an O-word.
    fn back_to_line(&mut self, words: &OWords, index: usize) -> Result<(), Fault> {
        self.jump(words.words[index].place)
    }

    /// Goes on in the first clause from `index` on whose condition holds, or behind the branch.
    fn clause(&mut self, words: &OWords, mut index: usize) -> Result<(), Fault> {
        loop {
            self.go(words, index)?;
            let mark = &words.words[index];
            if mark.word.keyword != Keyword::ElseIf {
                return Ok(());
            }
            let text = self.here.source.text.get(mark.place.at..mark.after.at).unwrap_or_default();
            if self.holds(text.trim_ascii_end(), mark.word.rest)? {
                return Ok(());
            }
            index = mark.partner;
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
        loop {
            // Comments may stand between the arguments (`rs274`).
            match reader.peek() {
                Some(b'(') => reader.pass_comment()?,
                Some(b'[') => {}
                _ => break,
            }
            if reader.peek() != Some(b'[') {
                continue;
            }
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
    pub(super) fn o_program(
        &self,
        number: u32,
    ) -> Result<Result<SourceLocation<'a>, String>, Fault> {
        Ok(match self.subroutine(number.to_string().as_bytes())? {
            Ok((place, Keyword::Program)) => Ok(place),
            Ok(_) => Err(format!("o{number} is a subroutine: call it by o{number} call")),
            Err(message) => Err(message),
        })
    }

    /// Where a subroutine begins: in this file, in the program itself, or in a file of its name.
    fn subroutine(
        &self,
        name: &[u8],
    ) -> Result<Result<(SourceLocation<'a>, Keyword), String>, Fault> {
        let find =
            |source: &'a Source<'a>| -> Result<Option<(SourceLocation<'a>, Keyword)>, Fault> {
                let words = source.o_words(self.settings.setup.block_delete)?;
                let base = name.rsplit(|&b| b == b'/').next().unwrap_or(name);
                Ok(words.subroutines.get(base).map(|&index| {
                    let mark = &words.words[index];
                    (SourceLocation::called(source, mark.after), mark.word.keyword)
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
