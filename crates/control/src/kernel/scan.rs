//! A text, taken from left to right: names, numbers, texts, lists, and what is said about a part of it.

use super::decimal;
use super::flow::BlockLocation;
use super::source::Source;
use program::{Diagnostic, Outcome, Rule};
use std::fmt;
use std::marker::PhantomData;
use std::ops::Range;

/// Most letters that a [`Name`] has room for.
const ROOM: usize = 32;

/// How a language writes names, texts and comments.
pub trait Lexis {
    /// What a comment begins with; it ends with its line. `None` where comments stand elsewhere.
    const COMMENT: Option<u8>;
    /// What a name may begin with that is no letter.
    const FIRST: &'static [u8];
    /// Whether capitals make no difference.
    const ANY_CASE: bool;
    /// Most letters of a name, up to 32.
    const LONGEST_NAME: usize = ROOM;
    /// Whether two quotation marks within a text are one.
    const DOUBLED_QUOTES: bool = false;
    /// Most bytes of a text.
    const LONGEST_TEXT: usize = usize::MAX;

    /// Whether two words are one.
    fn same(one: &str, other: &str) -> bool {
        if Self::ANY_CASE { one.eq_ignore_ascii_case(other) } else { one == other }
    }
}

/// A name in capitals, of a language in which they make no difference.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Name {
    letters: [u8; ROOM],
    length: u8,
}

impl Name {
    /// The name of that text; `None` where it is longer than any name.
    pub fn of(text: &str) -> Option<Name> {
        let mut letters = [0; ROOM];
        letters.get_mut(..text.len())?.copy_from_slice(text.as_bytes());
        letters.make_ascii_uppercase();
        Some(Name { letters, length: text.len() as u8 })
    }

    /// Whether it is `text`, which is in capitals.
    pub fn is(&self, text: &str) -> bool {
        usize::from(self.length) == text.len() && self.letters.starts_with(text.as_bytes())
    }

    /// Its letters.
    pub fn as_str(&self) -> &str {
        let letters = self.letters.get(..usize::from(self.length)).unwrap_or_default();
        std::str::from_utf8(letters).unwrap_or_default()
    }
}

impl fmt::Debug for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// A text on its way through a reader: a line, or several.
#[derive(Debug)]
pub struct Scan<'t, L> {
    /// The text.
    pub text: &'t [u8],
    /// The next byte.
    pub at: usize,
    /// The line that errors name for the first line of the text.
    pub line: u32,
    /// How deep the formula nests here.
    pub(super) depth: usize,
    /// The line of a byte at or before the next one.
    counted: BlockLocation,
    lexis: PhantomData<L>,
}

impl<'t, L: Lexis> Scan<'t, L> {
    /// At the start of a text.
    pub fn new(source: Source<'t>) -> Scan<'t, L> {
        let Source { line, text } = source;
        Scan { line, ..Scan::within(text, BlockLocation { at: 0, line }) }
    }

    /// At a place of a text of several lines, the first of which is line 1.
    pub fn within(text: &'t [u8], place: BlockLocation) -> Scan<'t, L> {
        Scan { text, at: place.at, line: 1, depth: 0, counted: place, lexis: PhantomData }
    }

    /// Where the next byte stands.
    pub fn location(&mut self) -> BlockLocation {
        let passed = self.text.get(self.counted.at..self.at).unwrap_or_default();
        let lines = memchr::memchr_iter(b'\n', passed).count();
        self.counted.line = self.counted.line.saturating_add(lines as u32);
        self.counted.at = self.at;
        self.counted
    }

    /// Goes over blanks.
    pub fn blanks(&mut self) {
        let rest = self.rest();
        self.at += rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    }

    /// The next byte that is neither blank nor comment; `None` at the end, and before a comment that ends the text.
    pub fn peek(&mut self) -> Option<u8> {
        loop {
            self.blanks();
            let next = self.text.get(self.at).copied();
            if next.is_none() || next != L::COMMENT {
                return next;
            }
            self.at += memchr::memchr(b'\n', self.rest())?;
        }
    }

    /// What has not been taken yet.
    pub fn rest(&self) -> &'t [u8] {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Takes `byte` where it comes next.
    pub fn take(&mut self, byte: u8) -> bool {
        let here = self.peek() == Some(byte);
        self.at += usize::from(here);
        here
    }

    /// Takes `text`, which need not be a whole word, where it comes next.
    pub fn take_text(&mut self, text: &str) -> bool {
        self.peek();
        let here = self.rest().starts_with(text.as_bytes());
        self.at += if here { text.len() } else { 0 };
        here
    }

    /// Takes `text`, which is no word.
    ///
    /// # Errors
    /// Something else comes next.
    pub fn expect(&mut self, text: &str) -> Outcome {
        match self.take_text(text) {
            true => Ok(()),
            false => Err(self.wrong(format!("`{text}` is needed here"))),
        }
    }

    /// Takes a word where one comes next, however long: letters and `_`, behind the first digits too.
    pub fn word(&mut self) -> Option<&'t str> {
        self.letters(true)
    }

    /// Takes letters and `_` alone, without the number behind them.
    pub fn letters_alone(&mut self) -> Option<&'t str> {
        self.letters(false)
    }

    fn letters(&mut self, with_digits: bool) -> Option<&'t str> {
        let begins = |byte: u8| byte.is_ascii_alphabetic() || L::FIRST.contains(&byte);
        if !self.peek().is_some_and(begins) {
            return None;
        }
        let rest = self.rest();
        let goes_on =
            |byte: u8| begins(byte) || byte == b'_' || with_digits && byte.is_ascii_digit();
        let length = rest.iter().take_while(|byte| goes_on(**byte)).count();
        self.at += length;
        rest.get(..length).and_then(|word| std::str::from_utf8(word).ok())
    }

    /// Takes `word` where it comes next as a whole one.
    pub fn take_word(&mut self, word: &str) -> bool {
        let before = self.at;
        let here = self.word().is_some_and(|own| L::same(own, word));
        if !here {
            self.at = before;
        }
        here
    }

    /// Takes a name where one comes next.
    ///
    /// # Errors
    /// It is longer than a name may be.
    pub fn name(&mut self) -> Outcome<Option<Name>> {
        self.peek();
        let from = self.at;
        let Some(word) = self.word() else { return Ok(None) };
        match Name::of(word).filter(|_| word.len() <= L::LONGEST_NAME) {
            Some(name) => Ok(Some(name)),
            None => {
                let message = format!("a name has at most {} letters", L::LONGEST_NAME);
                Err(self.since(from, Rule::Syntax, message))
            }
        }
    }

    /// Takes a name.
    ///
    /// # Errors
    /// Something else comes next: `what` says what is needed.
    pub fn needed(&mut self, what: &str) -> Outcome<Name> {
        let name = self.name()?;
        name.ok_or_else(|| self.wrong(format!("{what} is needed here")))
    }

    /// Takes a decimal, with the power of ten that may stand behind it (`1.5E-3`).
    ///
    /// # Errors
    /// There is none, or it is beyond all numbers.
    pub fn number(&mut self) -> Outcome<f64> {
        let from = self.at;
        let Some(read) = decimal::parse(self.rest()) else {
            return Err(self.wrong("a number is needed here"));
        };
        self.at += read.len;
        if !matches!(self.rest().first(), Some(b'e' | b'E')) {
            return Ok(read.value);
        }
        let rest = self.rest().get(1..).unwrap_or_default();
        let sign = usize::from(matches!(rest.first(), Some(b'+' | b'-')));
        let digits = rest.iter().skip(sign).take_while(|byte| byte.is_ascii_digit()).count();
        self.at += 1 + sign + digits;
        let text = std::str::from_utf8(&self.text[from..self.at]).unwrap_or_default();
        let number = text.parse::<f64>().ok().filter(|number| digits > 0 && number.is_finite());
        number.ok_or_else(|| self.since(from, Rule::Number, "this is no number"))
    }

    /// Takes a text in quotation marks, whose first comes next.
    ///
    /// # Errors
    /// It has no end in its line, or is longer than a text may be.
    pub fn text(&mut self) -> Outcome<Box<str>> {
        let (from, mut found) = (self.at, Vec::new());
        self.at += 1;
        loop {
            let (byte, next) = (self.rest().first(), self.rest().get(1));
            self.at += 1;
            match (byte, next) {
                (Some(b'"'), Some(b'"')) if L::DOUBLED_QUOTES => {
                    found.push(b'"');
                    self.at += 1;
                }
                (Some(b'"'), _) => break,
                (None | Some(b'\n' | b'\r'), _) => {
                    self.at -= 1;
                    return Err(self.since(from, Rule::Syntax, "the text has no end"));
                }
                (Some(byte), _) => found.push(*byte),
            }
        }
        if found.len() > L::LONGEST_TEXT {
            let message = format!("a text has at most {} letters", L::LONGEST_TEXT);
            return Err(self.since(from, Rule::Syntax, message));
        }
        Ok(String::from_utf8_lossy(&found).into())
    }

    /// Takes what stands between commas up to the bracket `end`, which is taken too.
    ///
    /// # Errors
    /// A comma is missing, there are more than `most`, or what is wrong in one of them.
    pub fn list<T>(
        &mut self,
        end: &str,
        most: usize,
        mut item: impl FnMut(&mut Self) -> Outcome<T>,
    ) -> Outcome<Vec<T>> {
        let mut all = Vec::new();
        let mut has_ended = self.take_text(end);
        while !has_ended {
            if all.len() == most {
                return Err(self.wrong(format!("more than {most} are not read")));
            }
            all.push(item(self)?);
            has_ended = self.take_text(end);
            if !has_ended {
                self.expect(",")?;
            }
        }
        Ok(all)
    }

    /// # Errors
    /// Anything but a comment follows.
    pub fn ends(&mut self) -> Outcome {
        match self.peek() {
            None => Ok(()),
            Some(_) => {
                let rest = String::from_utf8_lossy(self.rest());
                let word = rest.split_whitespace().next().unwrap_or_default();
                Err(self.wrong(format!("`{word}` is not understood here")))
            }
        }
    }

    /// An error about what comes next.
    #[cold]
    pub fn wrong(&self, message: impl Into<String>) -> Box<Diagnostic> {
        let end = (self.at + 1).min(self.text.len().max(self.at));
        self.error(Rule::Syntax, self.at..end, message)
    }

    /// An error about what stands from byte `from` to here.
    #[cold]
    pub fn since(&self, from: usize, rule: Rule, message: impl Into<String>) -> Box<Diagnostic> {
        self.error(rule, from..self.at.max(from), message)
    }

    /// An error about a part of the text.
    #[cold]
    pub fn error(
        &self,
        rule: Rule,
        piece: Range<usize>,
        message: impl Into<String>,
    ) -> Box<Diagnostic> {
        let before = self.text.get(..piece.start).unwrap_or(self.text);
        let passed = memchr::memchr_iter(b'\n', before).count();
        let line = self.line.saturating_add(u32::try_from(passed).unwrap_or(u32::MAX));
        let start = memchr::memrchr(b'\n', before).map_or(0, |at| at + 1);
        let rest = self.text.get(start..).unwrap_or_default();
        let length = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        let block = rest.get(..length).unwrap_or_default();
        let text = block.strip_suffix(b"\r").unwrap_or(block);
        let [from, to] = [piece.start, piece.end].map(|at| (at - start).min(text.len()));
        Source { line, text }.error(rule, from..to, message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Comments from `!`, doubled quotation marks, names of up to eight letters.
    struct Short;

    impl Lexis for Short {
        const COMMENT: Option<u8> = Some(b'!');
        const FIRST: &'static [u8] = b"$";
        const ANY_CASE: bool = true;
        const LONGEST_NAME: usize = 8;
        const DOUBLED_QUOTES: bool = true;
        const LONGEST_TEXT: usize = 6;
    }

    fn scan(text: &str) -> Scan<'_, Short> {
        Scan::new(Source { line: 7, text: text.as_bytes() })
    }

    #[test]
    fn names_numbers_texts_and_lists_are_taken_one_behind_the_other() {
        let mut scan = scan("$Speed_1 = -1.5e2 ! a comment\n , \"a\"\"b\" ,(1, 2 ,3)");
        assert_eq!(scan.name().unwrap().unwrap().as_str(), "$SPEED_1");
        assert!(scan.take(b'='));
        scan.peek();
        assert_eq!(scan.number().unwrap(), -150.0);
        assert!(scan.take(b','), "a comment ends with its line");
        scan.peek();
        assert_eq!(&*scan.text().unwrap(), "a\"b");
        scan.expect(",").unwrap();
        scan.expect("(").unwrap();
        let list = |most: usize, text: &str| {
            let mut scan = Scan::<Short>::new(Source { line: 1, text: text.as_bytes() });
            scan.list(")", most, |scan| {
                scan.peek();
                scan.number()
            })
        };
        assert_eq!(list(3, "1, 2 ,3)").unwrap(), [1.0, 2.0, 3.0]);
        assert!(list(2, "1, 2 ,3)").unwrap_err().message.contains("more than 2"));
        assert!(list(3, "1 2)").unwrap_err().message.contains("`,` is needed"));
        assert!(list(3, "1,2").is_err());
    }

    #[test]
    fn words_are_whole_ones_and_capitals_count_where_the_language_says_so() {
        assert!(scan(" Linear").take_word("LINEAR"));
        assert!(!scan("LINEARS").take_word("LINEAR"));
        assert!(scan("LINEARS").take_text("LINEAR"));
        assert_eq!(scan("CNT50").letters_alone(), Some("CNT"));
        assert_eq!(scan("50").word(), None);
        assert!(scan("nine_long").name().unwrap_err().message.contains("8 letters"));
    }

    #[test]
    fn errors_name_the_line_the_column_and_the_piece() {
        let mut scan = scan("first\r\n  second = \"long \r\nthird");
        assert!(scan.take_word("FIRST"));
        scan.peek();
        let from = scan.at;
        assert!(scan.take_word("SECOND"));
        let found = scan.since(from, Rule::Syntax, "it");
        assert_eq!((found.line, found.column), (8, 3));
        assert_eq!(&*found.excerpt, "  second = \"long \n  ^^^^^^");
        assert!(scan.take(b'='));
        scan.peek();
        let found = scan.text().unwrap_err();
        assert_eq!((found.line, found.column), (8, 12));
        assert!(found.message.contains("no end"));
    }

    #[test]
    fn what_is_no_number_or_too_long_a_text_is_refused() {
        for text in ["1e", "1e999", "x", "1e+"] {
            assert!(scan(text).number().is_err(), "{text}");
        }
        assert!(scan("\"seven77\"").text().unwrap_err().message.contains("at most 6"));
        assert!(scan("rest of it").ends().unwrap_err().message.contains("`rest`"));
        assert!(scan(" ! comment").ends().is_ok());
    }
}
