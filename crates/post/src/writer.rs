//! The text as it grows: words with their modality, block numbers, line lengths.

use crate::catalogue::{BlockName, WordName};
use crate::number::Number;
use crate::origins::{self, Origins};
use crate::surface::{DECIMALS, Part};
use crate::template::{Lines, ORIENTATION, POSITION, Step, words_of};
use crate::words::{Words, bit};
use machine::Machine;
use program::{Diagnostic, Rule};

/// How one word is written on this machine.
enum Form {
    /// The control does not use it.
    Absent,
    Number(Number),
    /// Its texts, in the order of [`WordName::codes`].
    Code(Vec<Option<String>>),
}

/// A value as it is compared, for what repeats is left out: the key of a number, the entry of a code.
type Key = i64;

/// The program text and what the control remembers of it.
pub(crate) struct Writer {
    forms: Vec<Form>,
    separator: Vec<u8>,
    line_end: Vec<u8>,
    line_length: usize,
    first: u32,
    step: u32,
    /// The words that every block may write, with values of the machine.
    constant: Words,
    /// The words of the block that comes next, and their values.
    set: Words,
    values: [Key; WordName::COUNT],
    /// The words that [`Writer::repeat`] says.
    kept: Words,
    /// The words whose active value is known, and those values.
    known: Words,
    active: [Key; WordName::COUNT],
    /// The words that are left out where they repeat themselves.
    modal: Words,
    /// The word whose form [`WordName::F`] has.
    feed_form: WordName,
    /// What is added to Z in the block that comes next: parts, and of which parameters, as those are written.
    raised: Option<[(f64, i64); 4]>,
    /// A value that its word cannot take.
    refused: Option<(WordName, f64)>,
    next_number: u64,
    text: Vec<u8>,
    /// Where each line of it comes from.
    origins: Origins,
    /// The record for which it is written, as [`origins::number`] has it.
    record: u32,
    lines: usize,
}

/// Text that has been taken out, with where its lines come from.
#[derive(Debug, Default)]
pub(crate) struct Cutting {
    pub(crate) text: Vec<u8>,
    pub(crate) origins: Origins,
}

impl Cutting {
    /// Puts another one behind it.
    pub(crate) fn append(&mut self, other: Cutting) {
        self.text.extend_from_slice(&other.text);
        self.origins.insert(self.origins.lines(), other.origins);
    }
}

impl Writer {
    pub(crate) fn new(machine: &Machine) -> Writer {
        let words = words_of(machine);
        let word = |name: WordName| machine.words.get(name.name()).filter(|_| words.has(name));
        let form = |&name: &WordName| match word(name) {
            None => Form::Absent,
            Some(word) if name.codes().next().is_some() => {
                Form::Code(name.codes().map(|code| word.codes.get(code).cloned()).collect())
            }
            Some(word) => Form::Number(Number::new(&machine.format.separator, word)),
        };
        let modal = |name: &WordName| word(*name).is_some_and(|word| word.modal);
        let number = machine.words.get(WordName::N.name());
        let first = number.map_or(1, |word| word.first);
        let mut writer = Writer {
            forms: WordName::ALL.iter().map(form).collect(),
            separator: machine.format.separator.clone().into(),
            line_end: machine.format.line_end.clone().into(),
            line_length: machine.capabilities.line_length,
            first,
            step: number.map_or(1, |word| word.step),
            constant: Words::NONE,
            set: Words::NONE,
            values: [0; WordName::COUNT],
            kept: Words::NONE,
            known: Words::NONE,
            active: [0; WordName::COUNT],
            modal: WordName::ALL.iter().copied().filter(modal).collect(),
            feed_form: WordName::F,
            raised: None,
            refused: None,
            next_number: first.into(),
            text: Vec::new(),
            origins: Origins::default(),
            record: origins::number(None),
            lines: 0,
        };
        if let Some(height) = machine.safe_height {
            writer.set(WordName::SafeHeight, height);
        }
        if let Some(rapid) = machine.linear.iter().filter_map(|axis| axis.rapid).reduce(f64::max) {
            writer.set(WordName::RapidFeed, rapid);
        }
        writer.constant = writer.set;
        writer
    }

    /// The next block may write `word` with this value. Nothing where the control lacks the word.
    #[inline]
    pub(crate) fn set(&mut self, word: WordName, value: f64) {
        let Form::Number(number) = &self.forms[self.form(word) as usize] else { return };
        match number.key(value) {
            Some(key) => self.say(word, key),
            None => self.refused = Some((word, value)),
        }
    }

    /// Z of the next block is what has been set and these parts of heights that the control keeps.
    #[inline]
    pub(crate) fn raise(&mut self, parts: Option<[Part; 4]>) {
        self.raised = parts.map(|parts| {
            parts.map(|Part { parameter, part }| {
                let parameter = f64::from(parameter);
                let steps = match &self.forms[WordName::Height as usize] {
                    Form::Number(number) => number.round(parameter),
                    Form::Code(_) | Form::Absent => None,
                };
                if steps.is_none() {
                    self.refused = Some((WordName::Height, parameter));
                }
                (part, steps.unwrap_or_default())
            })
        });
    }

    /// The next block may write the code `word` with its entry `index`.
    #[inline]
    pub(crate) fn code(&mut self, word: WordName, index: usize) {
        self.say(word, index as Key);
    }

    #[inline]
    fn say(&mut self, word: WordName, value: Key) {
        self.values[word as usize] = value;
        self.set.add(word);
    }

    /// Every block from here on may write `word` with this value.
    pub(crate) fn set_always(&mut self, word: WordName, value: f64) {
        self.set(word, value);
        if self.set.has(word) {
            self.constant.add(word);
        }
    }

    /// Where the text ends now.
    pub(crate) fn end(&self) -> usize {
        self.text.len()
    }

    /// What is written from here on is for this record of the source.
    #[inline]
    pub(crate) fn is_for(&mut self, record: Option<usize>) {
        self.record = origins::number(record);
    }

    /// Takes what has been written since the text ended there.
    pub(crate) fn cut(&mut self, from: usize) -> Cutting {
        let text = self.text.split_off(from);
        let lines = text.iter().filter(|byte| **byte == b'\n').count();
        // The text of a code may break a line itself.
        let origins = self.origins.split_off(self.origins.lines().saturating_sub(lines));
        Cutting { text, origins }
    }

    /// Puts text that has been cut at the beginning.
    pub(crate) fn paste_before(&mut self, cutting: Cutting) {
        self.text.splice(..0, cutting.text);
        self.origins.insert(0, cutting.origins);
    }

    /// Puts text that has been cut at the end.
    pub(crate) fn paste(&mut self, cutting: Cutting) {
        self.text.extend_from_slice(&cutting.text);
        self.origins.insert(self.origins.lines(), cutting.origins);
    }

    /// Another file begins: its lines are counted from the first number on.
    pub(crate) fn count_anew(&mut self) {
        self.next_number = self.first.into();
    }

    /// How many lines have carried a number.
    pub(crate) fn numbered(&self) -> u64 {
        (self.next_number - u64::from(self.first)) / u64::from(self.step.max(1))
    }

    /// Whether the control has one of `words`.
    #[inline]
    pub(crate) fn has(&self, words: &[WordName]) -> bool {
        words.iter().any(|word| !matches!(self.forms[*word as usize], Form::Absent))
    }

    /// How `value` is rounded by `word`: what reading it gives. The value itself where the control
    /// lacks the word or cannot take the value.
    #[inline]
    pub(crate) fn rounded(&self, word: WordName, value: f64) -> f64 {
        match &self.forms[self.form(word) as usize] {
            Form::Number(number) => number.round(value).map_or(value, |steps| number.value(steps)),
            Form::Code(_) | Form::Absent => value,
        }
    }

    /// The active value of a number, where it is known.
    #[inline]
    pub(crate) fn active(&self, word: WordName) -> Option<f64> {
        match &self.forms[self.form(word) as usize] {
            Form::Number(number) if self.known.has(word) => {
                Some(number.value(number.steps(self.active[word as usize])))
            }
            Form::Number(_) | Form::Code(_) | Form::Absent => None,
        }
    }

    /// Whether the next block, writing all that is set, changes one of `words`.
    #[inline]
    pub(crate) fn changes(&self, words: Words) -> bool {
        let set = self.set & words;
        let known = set & self.known & !self.raised();
        known != set || known.any(|word| self.values[word] != self.active[word])
    }

    /// The words that are raised: what they come to, only the control knows.
    #[inline]
    fn raised(&self) -> Words {
        if self.raised.is_some() { bit(WordName::Z) } else { Words::NONE }
    }

    /// The words that are left out where they say what is active.
    #[inline]
    fn left_out(&self) -> Words {
        self.modal & self.known & !self.raised()
    }

    /// The words of the next block are kept to be repeated.
    #[inline]
    pub(crate) fn keep(&mut self) {
        self.kept = self.set;
    }

    /// The next block may write the words that have been kept, with the values that they have.
    #[inline]
    pub(crate) fn repeat(&mut self) {
        self.set = self.kept;
    }

    /// Takes `words` out of the next block.
    #[inline]
    pub(crate) fn unset(&mut self, words: Words) {
        self.set &= !words;
        if words.has(WordName::Z) {
            self.raised = None;
        }
    }

    /// The words of the next block.
    pub(crate) fn set_words(&self) -> Words {
        self.set | self.constant | bit(WordName::N)
    }

    /// The control is at this entry of a code without a word.
    pub(crate) fn assume(&mut self, word: WordName, index: usize) {
        self.active[word as usize] = index as Key;
        self.known.add(word);
    }

    /// The control has this value of a number without a word.
    pub(crate) fn is_at(&mut self, word: WordName, value: f64) {
        let Form::Number(number) = &self.forms[self.form(word) as usize] else { return };
        if let Some(key) = number.key(value) {
            self.active[word as usize] = key;
            self.known.add(word);
        }
    }

    /// The active values of `words` are not known: they are written again.
    #[inline]
    pub(crate) fn forget(&mut self, words: Words) {
        self.known &= !words;
    }

    /// `F` is written in the form of `word` from here on.
    pub(crate) fn feed_form(&mut self, word: WordName) {
        if self.feed_form != word {
            self.feed_form = word;
            self.forget(bit(WordName::F));
            self.modal &= !bit(WordName::F);
            if let Form::Number(number) = &self.forms[word as usize]
                && number.modal
            {
                self.modal.add(WordName::F);
            }
        }
    }

    #[inline]
    fn form(&self, word: WordName) -> WordName {
        if word == WordName::F { self.feed_form } else { word }
    }

    /// Writes the block of this name. A line on which nothing but a number would stand is left out.
    ///
    /// # Errors
    /// A value that its word cannot take, a line longer than the control reads.
    pub(crate) fn block(&mut self, name: BlockName, block: &Lines) -> Result<(), Box<Diagnostic>> {
        if let Some((word, value)) = self.refused.take() {
            let message = format!("{value} cannot be written as the word `{}`", word.name());
            return Err(Diagnostic::error(Rule::NumberRange, message).into());
        }
        let mut start = self.text.len();
        let (mut gap, mut full, mut numbered) = (false, false, false);
        let (set, mut left_out) = (self.set | self.constant, self.left_out());
        for step in &block.steps {
            match *step {
                Step::Text { gap: before, from, to } => {
                    gap |= before;
                    if self.separated(&mut gap, start) {
                        self.text.extend_from_slice(&self.separator);
                    }
                    let text = &block.text.as_bytes()[from as usize..to as usize];
                    self.text.extend_from_slice(text);
                    full = true;
                }
                Step::Word { gap: before, word: WordName::N } => {
                    gap |= before;
                    self.number(&mut gap, start);
                    numbered = true;
                }
                Step::Word { gap: before, word } => {
                    gap |= before;
                    let index = word as usize;
                    let repeats = left_out.has(word) && self.values[index] == self.active[index];
                    if set.has(word) && !repeats {
                        full |= self.word(word, &mut gap, start);
                        if !left_out.has(word) {
                            left_out = self.left_out();
                        }
                    }
                }
                Step::End => {
                    if full {
                        self.end_line(start)?;
                        self.origins.push(name, self.record);
                        self.next_number += if numbered { u64::from(self.step) } else { 0 };
                    } else {
                        self.text.truncate(start);
                    }
                    start = self.text.len();
                    (gap, full, numbered) = (false, false, false);
                }
            }
        }
        // A position that the block leads to by other words (a helix by its angle) is not known by its own.
        self.known &= !(self.set & !block.words & (POSITION | ORIENTATION));
        self.set = Words::NONE;
        self.raised = None;
        Ok(())
    }

    /// Whether something stands before on the line that began at `start`, and a gap after it.
    #[inline]
    fn separated(&self, gap: &mut bool, start: usize) -> bool {
        std::mem::take(gap) && self.text.len() > start
    }

    /// Writes the number of the block.
    #[inline]
    fn number(&mut self, gap: &mut bool, start: usize) {
        let Form::Number(number) = &self.forms[WordName::N as usize] else { return };
        let steps = number.round(self.next_number as f64).or_else(|| {
            self.next_number = self.first.into();
            number.round(f64::from(self.first))
        });
        let separated = self.separated(gap, start);
        number.write(separated, steps.unwrap_or_default(), &mut self.text);
    }

    /// Writes a word; whether it has a text.
    #[inline]
    fn word(&mut self, word: WordName, gap: &mut bool, start: usize) -> bool {
        let index = word as usize;
        let value = self.values[index];
        if let Form::Code(texts) = &self.forms[index]
            && texts.get(value as usize).is_none_or(|text| text.as_deref() == Some(""))
        {
            return false;
        }
        self.known.add(word);
        self.active[index] = value;
        let separated = self.separated(gap, start);
        match self.raised {
            Some(parts) if word == WordName::Z => {
                self.known &= !bit(word);
                self.write_raised(word, separated, value, &parts);
            }
            _ => self.write(word, separated, value),
        }
        true
    }

    /// Writes a number and parts of heights as the sum that they are.
    fn write_raised(&mut self, word: WordName, separated: bool, value: Key, parts: &[(f64, i64)]) {
        let forms = [word, WordName::Height].map(|word| &self.forms[word as usize]);
        let [Form::Number(number), Form::Number(height)] = forms else { return };
        let mut sum = Vec::with_capacity(96);
        for (part, parameter) in parts {
            let part = format!("{part:.DECIMALS$}");
            let part = part.trim_end_matches('0').trim_end_matches('.');
            if part == "0" {
                continue;
            }
            sum.push(b'+');
            if part != "1" {
                sum.extend_from_slice(part.as_bytes());
                sum.push(b'*');
            }
            height.write(false, *parameter, &mut sum);
        }
        number.write_sum(separated, number.steps(value), &sum, &mut self.text);
    }

    #[inline]
    fn write(&mut self, word: WordName, separated: bool, value: Key) {
        match &self.forms[self.form(word) as usize] {
            Form::Absent => {}
            Form::Number(number) => {
                number.write(separated, number.steps(value), &mut self.text);
            }
            Form::Code(texts) => {
                if let Some(Some(text)) = texts.get(value as usize) {
                    if separated {
                        self.text.extend_from_slice(&self.separator);
                    }
                    self.text.extend_from_slice(text.as_bytes());
                }
            }
        }
    }

    fn end_line(&mut self, start: usize) -> Result<(), Box<Diagnostic>> {
        self.lines += 1;
        let line = &self.text[start..];
        if line.len() > self.line_length {
            let shown = String::from_utf8_lossy(&line[..line.len().min(40)]).into_owned();
            let message = format!(
                "line {} of the program has {} characters, the control reads {}: `{shown}…`",
                self.lines,
                line.len(),
                self.line_length
            );
            return Err(Diagnostic::error(Rule::LineLength, message).into());
        }
        self.text.extend_from_slice(&self.line_end);
        Ok(())
    }

    /// The number of lines so far.
    #[inline]
    pub(crate) fn lines(&self) -> usize {
        self.lines
    }

    /// The text, where its lines come from, and the number of all lines that were written.
    pub(crate) fn finish(self) -> (Vec<u8>, Origins, usize) {
        (self.text, self.origins, self.lines)
    }
}
