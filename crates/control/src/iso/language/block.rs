//! A block (a line of NC) taken apart into words.

use super::Fault;
use super::arithmetic;
use super::expression::Reader;
use super::parameters::Values;
use super::value::{Target, Value};
use super::words::{G, Group, LETTERS, M, bit, index, set};
use crate::Settings;
use crate::iso::dialects::facts::{BlockDelete, Brackets, CornerWords, Facts, Language, Semicolon};
use crate::kernel::decimal::{self, Decimal};
use program::Rule;

/// The letters of a block that only moves, by [`bit`].
const MOVES: u32 = set(b"NXYZABCIJKRF");

/// A letter with its number.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Word {
    pub letter: u8,
    /// The number.
    pub value: f64,
    /// Whether a decimal point was written.
    pub point: bool,
    /// How many digits were written before the point, and behind it: 255 for more.
    pub digits: [u8; 2],
    /// Whether the program has calculated it.
    pub computed: bool,
    pub start: u32,
    pub end: u32,
}

impl Word {
    /// The word of `letter` with `number`, from byte `start` to byte `end` of its line.
    #[inline]
    pub(super) fn written(letter: u8, number: &Decimal, start: usize, end: usize) -> Word {
        let place = |at| u32::try_from(at).unwrap_or(u32::MAX);
        Word {
            letter,
            value: number.value,
            point: number.point,
            digits: number.digits.map(|count| count.min(255) as u8),
            computed: false,
            start: place(start),
            end: place(end),
        }
    }

    /// Whether it has the letter and the number of another one, in as many digits.
    pub(crate) fn says_the_same_as(&self, other: &Word) -> bool {
        (self.letter, self.value, self.digits) == (other.letter, other.value, other.digits)
    }

    /// Whether it counts units, and not perhaps increments.
    pub(crate) fn is_in_units(&self) -> bool {
        self.point || self.computed
    }
}

/// What a block says. A word is *taken* by what uses it; a word that nothing took is a mistake.
#[derive(Debug)]
pub(crate) struct Block<'a> {
    pub facts: &'static Facts,
    /// The machine, for the M functions that its builder has added.
    settings: &'a Settings,
    /// The line as it stands.
    pub text: &'a [u8],
    /// Its number, from 1.
    pub line: u32,
    /// Whether there is anything but blanks and comments.
    pub is_empty: bool,
    /// How many M words there are.
    pub m_count: u32,
    /// A word has been read.
    started: bool,
    /// A macro is called: the words that follow are its arguments.
    calls: bool,
    pub words: [Word; LETTERS.len()],
    given: u32,
    pending: u32,
    /// The groups of its G and M words, by [`Group::bit`].
    groups: u32,
    g: [Option<G>; Group::COUNT],
    m: [Option<M>; Group::COUNT],
    pub places: [Word; Group::COUNT],
    comments: Vec<(usize, usize)>,
    prompt: Option<(usize, usize)>,
    /// What the block sets (RS274/NGC), which takes effect when the whole block has been read.
    pub assignments: Vec<(Target<'a>, Value)>,
    /// `,C` or `,R`: what is put between this block and the next one.
    pub corner: Option<Word>,
    /// The words behind `G65` or `G66`, in their order.
    pub arguments: Vec<Word>,
    /// The M functions of the machine's builder that stand for themselves, in their order.
    pub auxiliary: Vec<u32>,
}

impl<'a> Block<'a> {
    /// A block without words, for programs of the dialect of `facts` with the M functions that the
    /// builder of the machine has added: those of the wire, and others that change nothing that is
    /// followed here.
    pub(crate) fn new(facts: &'static Facts, settings: &'a Settings) -> Block<'a> {
        Block {
            facts,
            settings,
            text: b"",
            line: 0,
            is_empty: true,
            m_count: 0,
            started: false,
            calls: false,
            words: [Word::default(); LETTERS.len()],
            given: 0,
            pending: 0,
            groups: 0,
            g: [None; Group::COUNT],
            m: [None; Group::COUNT],
            places: [Word::default(); Group::COUNT],
            comments: Vec::new(),
            prompt: None,
            assignments: Vec::new(),
            corner: None,
            arguments: Vec::new(),
            auxiliary: Vec::new(),
        }
    }

    /// Forgets the words of the last block; `text` is the new one.
    pub(crate) fn clear(&mut self, line: u32, text: &'a [u8]) {
        (self.text, self.line) = (text, line);
        (self.is_empty, self.started, self.calls) = (true, false, false);
        while self.groups != 0 {
            let group = self.groups.trailing_zeros() as usize;
            (self.g[group], self.m[group]) = (None, None);
            self.groups &= self.groups - 1;
        }
        (self.m_count, self.given, self.pending) = (0, 0, 0);
        self.comments.clear();
        self.prompt = None;
        self.assignments.clear();
        self.corner = None;
        self.arguments.clear();
        self.auxiliary.clear();
    }

    /// Takes the words of `text` from byte `at` on in place of those of the last block.
    ///
    /// # Errors
    /// What is no word of the dialect, a number that is none, a word given twice, two words of a
    /// modal group, a comment without an end, a block that is too long, a calculation without a result.
    pub(crate) fn read(
        &mut self,
        line: u32,
        text: &'a [u8],
        mut at: usize,
        values: &Values,
    ) -> Result<(), Fault> {
        let facts = self.facts;
        self.clear(line, text);
        let mut length = 0;
        while let Some(&byte) = text.get(at) {
            let from = at;
            match byte {
                b' ' | b'\t' => {
                    at += 1;
                    continue;
                }
                b'A'..=b'Z' => at = self.word(byte, at, values)?,
                b'@' | b'^' | b'$' if facts.words.letters & bit(byte) != 0 => {
                    at = self.word(byte, at, values)?
                }
                b'a'..=b'z' if facts.syntax.small_letters => {
                    at = self.word(byte.to_ascii_uppercase(), at, values)?;
                }
                b'#' if matches!(values.language(), Language::Ngc | Language::Rs274) => {
                    at = self.assignment(at, values)?
                }
                // In ISO code the colon is the O of EIA code.
                b':' if values.language() == Language::MacroB => {
                    at = self.word(b'O', at, values)?
                }
                b',' if facts.syntax.corners != CornerWords::None => {
                    at = self.corner(at, values)?
                }
                b'(' if facts.syntax.brackets != Brackets::None => {
                    at = self.comment(at)?;
                    continue;
                }
                b';' if facts.syntax.semicolon == Semicolon::EndOfBlock => {
                    self.end_of_block(at)?;
                    break;
                }
                b';' if facts.source.is_some() => {
                    let message = "; begins no comment: the words behind it would count";
                    let fault = self.fault(Rule::Syntax, message, at, text.len());
                    return Err(fault.help("put it into ( ) as a command of its own").into());
                }
                b';' => {
                    self.comments.push((at + 1, text.len()));
                    break;
                }
                // The proof holds for the block-delete switch off: the block is run.
                b'/' if self.is_empty && facts.syntax.block_delete != BlockDelete::None => {
                    at = after_block_delete(facts.syntax.block_delete, text, at)
                }
                _ => return Err(self.stray(byte, at)),
            }
            self.is_empty = false;
            length += at - from;
        }
        self.is_short(length)
    }

    /// Reads the word at `at` and gives the place after it.
    fn word(&mut self, letter: u8, at: usize, values: &Values) -> Result<usize, Fault> {
        let facts = self.facts;
        let mut from = at + 1;
        while matches!(self.text.get(from), Some(b' ' | b'\t')) {
            from += 1;
        }
        let number = self.text.get(from..).and_then(decimal::parse);
        let (word, end) = match number {
            Some(number) => {
                let end = from + number.len;
                (Word::written(letter, &number, at, end), end)
            }
            // Marlin's G28 X: an axis that is named.
            None if self.g(Group::OneShot) == Some(G::Home) && facts.syntax.one_command => {
                (Word::written(letter, &Decimal::default(), at, at + 1), at + 1)
            }
            None => {
                let (value, end) = self.computed(letter, at, from, values)?;
                self.started = true;
                // A word whose variable is null is not there (B-63684EN, 16.1).
                let Some(value) = value else { return Ok(end) };
                let number = Decimal { value, ..Decimal::default() };
                (Word { computed: true, ..Word::written(letter, &number, at, end) }, end)
            }
        };
        self.add(&word)?;
        if letter == b'M'
            && facts.syntax.one_command
            && let Some((_, meaning)) = facts.words.m(word.value)
        {
            return Ok(self.prompt(meaning, end));
        }
        Ok(end)
    }

    /// Reads `,C` or `,R` at `at` and gives the place after it.
    fn corner(&mut self, at: usize, values: &Values) -> Result<usize, Fault> {
        let skip = |mut at: usize| {
            while matches!(self.text.get(at), Some(b' ' | b'\t')) {
                at += 1;
            }
            at
        };
        let place = skip(at + 1);
        let from = skip(place + 1);
        let letter = match self.text.get(place) {
            Some(&letter @ (b'C' | b'R')) => letter,
            Some(b'A') => {
                let message = "a line by its angle (,A) is not followed; write its end";
                return Err(self.fault(Rule::Corner, message, at, place + 1));
            }
            _ => {
                let message = "behind a comma stands C or R: a chamfer or a rounding";
                return Err(self.fault(Rule::Syntax, message, at, place + 1));
            }
        };
        let number = self.text.get(from..).and_then(decimal::parse);
        let (word, end) = match number {
            Some(number) => {
                let end = from + number.len;
                (Word::written(letter, &number, at, end), end)
            }
            None => {
                let (value, end) = self.computed(letter, at, from, values)?;
                let Some(value) = value else { return Ok(end) };
                let number = Decimal { value, ..Decimal::default() };
                (Word { computed: true, ..Word::written(letter, &number, at, end) }, end)
            }
        };
        if self.corner.replace(word).is_some() {
            return Err(self.fault(Rule::RepeatedWord, "a block has one corner", at, end));
        }
        Ok(end)
    }

    /// Takes `words`, of which alone `text` consists, in place of those of the last block.
    ///
    /// # Errors
    /// As [`Block::read`].
    pub(crate) fn take_over(
        &mut self,
        line: u32,
        text: &'a [u8],
        words: &[Word],
    ) -> Result<(), Fault> {
        self.clear(line, text);
        self.is_empty = words.is_empty();
        let mut length = 0;
        for word in words {
            self.add(word)?;
            length += (word.end - word.start) as usize;
        }
        self.is_short(length)
    }

    /// # Errors
    /// The block has so many characters, and more than the control takes.
    fn is_short(&self, length: usize) -> Result<(), Fault> {
        let longest = self.facts.words.longest;
        if length <= longest {
            return Ok(());
        }
        let message = format!("the block has {length} characters, at most {longest}");
        Err(self.fault(Rule::BlockLength, message, 0, self.text.len()))
    }

    /// Adds a word.
    ///
    /// # Errors
    /// It is none of the dialect, or does not go together with those before it.
    fn add(&mut self, word: &Word) -> Result<(), Fault> {
        let facts = self.facts;
        let letter = word.letter;
        let (at, end) = (word.start as usize, word.end as usize);
        if facts.source.is_some_and(|source| word.value.abs() >= source.largest) {
            return Err(self.nothing(at, end));
        }
        if self.calls && !matches!(letter, b'N' | b'P' | b'L' | b'G') {
            self.arguments.push(*word);
            return Ok(());
        }
        match letter {
            b'G' => match facts.words.g(word.value) {
                Some((group, meaning)) => {
                    if self.groups & group.bit() != 0 {
                        return Err(self.same_group(group, at, end));
                    }
                    self.g[group as usize] = Some(meaning);
                    self.groups |= group.bit();
                    self.places[group as usize] = *word;
                    self.calls |= matches!(meaning, G::MacroCall { .. });
                }
                None => return Err(self.unknown(letter, word)),
            },
            // What does nothing on the control itself is the builder's where the machine's file says so.
            b'M' => match self
                .stated_coolant(word.value)
                .or_else(|| {
                    facts.words.m(word.value).filter(|usual| self.is_usual(usual, word.value))
                })
                .or_else(|| self.of_the_machine(word.value))
            {
                Some((Group::Coolant, _)) if self.is_controls_own(facts, word.value) => {
                    return Err(self.taken_for_coolant(word));
                }
                Some((group, meaning)) => {
                    if self.groups & group.bit() != 0 {
                        return Err(self.same_group(group, at, end));
                    }
                    self.m[group as usize] = Some(meaning);
                    self.groups |= group.bit();
                    self.places[group as usize] = *word;
                    self.m_count += 1;
                }
                None => match self.auxiliary(word.value) {
                    Some(number) => {
                        self.m_count += 1;
                        self.auxiliary.push(number);
                    }
                    None => return Err(self.unknown(letter, word)),
                },
            },
            _ => {
                let letter_bit = bit(letter);
                if facts.words.letters & letter_bit == 0 {
                    return Err(self.unknown(letter, word));
                }
                if self.given & letter_bit != 0 {
                    return Err(self.repeated(letter, at, end));
                }
                if letter == b'N' {
                    if self.started || word.point || word.value < 0.0 {
                        let message = "N is a whole number and stands first in its block";
                        return Err(self.fault(Rule::BlockNumber, message, at, end));
                    }
                } else {
                    self.pending |= letter_bit;
                }
                self.given |= letter_bit;
                self.words[index(letter)] = *word;
            }
        }
        self.started = true;
        Ok(())
    }

    /// Behind Marlin's `M0`, `M1` and `M117` at `at` stands a text, not words: the place after it.
    fn prompt(&mut self, meaning: M, at: usize) -> usize {
        let rest = self.text.get(at..).unwrap_or_default();
        let text = rest.split(|&b| b == b';').next().unwrap_or_default();
        // `M0 S5`: how long it waits.
        let waits = matches!(text.trim_ascii(), [b'P' | b'S', b'0'..=b'9', ..]);
        let prompts = match meaning {
            M::Stop | M::OptionalStop => !waits && !text.trim_ascii().is_empty(),
            M::Message => true,
            _ => false,
        };
        if !prompts {
            return at;
        }
        self.prompt = Some((at, at + text.len()));
        at + text.len()
    }

    /// What the block shows to the operator, apart from its comments.
    pub(crate) fn message(&self) -> Option<&'a [u8]> {
        let (from, to) = self.prompt?;
        Some(self.text.get(from..to).unwrap_or_default().trim_ascii())
    }

    /// The M function of this number, where the builder of the machine has added it.
    fn auxiliary(&self, number: f64) -> Option<u32> {
        self.settings.auxiliary.iter().copied().find(|&m| f64::from(m) == number)
    }

    /// The M function of this number by which the machine's file says that coolant is switched.
    fn stated_coolant(&self, number: f64) -> Option<(Group, M)> {
        let functions = self.settings.coolant;
        let whole = (number.fract() == 0.0 && number >= 0.0).then_some(number as u32)?;
        functions.switch(whole).map(|switch| (Group::Coolant, M::of_coolant(switch)))
    }

    /// Whether the control has a use of its own for an M function of this number, which a machine file cannot give to coolant.
    fn is_controls_own(&self, facts: &Facts, number: f64) -> bool {
        let is_free = |(group, meaning): (Group, M)| {
            group == Group::Coolant || matches!(meaning, M::Neutral(_))
        };
        facts.words.m(number).map_or(facts.why_refused(b'M', number).is_some(), |m| !is_free(m))
    }

    /// Whether a word of the control is what it usually is: the machine's file lists its number as one of the builder's, or gives
    /// its coolant to another number.
    fn is_usual(&self, (_, meaning): &(Group, M), number: f64) -> bool {
        let is_builders = matches!(meaning, M::Neutral(_)) && self.auxiliary(number).is_some();
        let is_elsewhere =
            meaning.coolant().is_some_and(|switch| self.settings.coolant.is_stated(switch));
        !is_builders && !is_elsewhere
    }

    /// The M function of this number that is the machine's own: it switches the kinematics, threads or cuts the wire, or
    /// runs a program of LinuxCNC's (`M100` to `M199`), to which P and Q belong.
    fn of_the_machine(&self, number: f64) -> Option<(Group, M)> {
        let is = |function: Option<u32>| function.map(f64::from) == Some(number);
        let kinematics = self.settings.kinematics.filter(|_| self.facts.syntax.extended_m);
        for (function, follows) in kinematics.iter().flat_map(|k| [(k.tip, true), (k.axes, false)])
        {
            if is(Some(function)) {
                return Some((Group::Kinematics, M::FollowTip(follows)));
            }
        }
        let runs = self.facts.syntax.extended_m && (100.0..200.0).contains(&number);
        if let Some(number) = self.auxiliary(number).filter(|_| runs) {
            return Some((Group::Output, M::Program(number)));
        }
        match self.settings.wire {
            _ if self.facts.wire.is_none() => None,
            wire if is(wire.thread) => Some((Group::Wire, M::ThreadWire)),
            wire if is(wire.cut) => Some((Group::Wire, M::CutWire)),
            _ => None,
        }
    }

    /// The number of a word that the program calculates at `from`, and the place after it.
    fn computed(
        &self,
        letter: u8,
        at: usize,
        from: usize,
        values: &Values,
    ) -> Result<(Value, usize), Fault> {
        let calculates = match (values.language(), self.text.get(from)) {
            (Language::Plain, _) => false,
            (_, Some(b'#' | b'[' | b'+' | b'-')) => true,
            (language, Some(byte)) => language != Language::MacroB && byte.is_ascii_alphabetic(),
            _ => false,
        };
        if !calculates {
            return Err(self.no_number(letter, at, from));
        }
        let mut reader = Reader::new(values, self.line, self.text, from);
        let value = reader.value()?;
        let rounds = |name: &&[u8]| {
            let text = self.text.get(from..reader.at).unwrap_or_default();
            text.windows(name.len()).any(|part| part == *name)
        };
        // There it goes to the least increment (B-63684EN, 16.3), which is the machine's.
        if values.language() == Language::MacroB && [&b"ROUND"[..], b"RND"].iter().any(rounds) {
            let message = "ROUND in a word rounds to the least increment of the machine";
            let fault = self.fault(Rule::Expression, message, at, reader.at);
            let help = "round in a block before: in #1=ROUND[..] it gives a whole number";
            return Err(fault.help(help).into());
        }
        let value = value.map(|value| match letter {
            b'G' => {
                arithmetic::whole(value * 10.0).map_or(value, |tenths| f64::from(tenths) / 10.0)
            }
            b'M' | b'N' | b'O' => arithmetic::whole(value).map_or(value, f64::from),
            _ => value,
        });
        Ok((value, reader.at))
    }

    /// Reads the setting of a parameter at `at` and gives the place after it.
    fn assignment(&mut self, at: usize, values: &Values) -> Result<usize, Fault> {
        let mut reader = Reader::new(values, self.line, self.text, at + 1);
        let target = reader.target()?;
        if !reader.take(b'=') {
            return Err(reader.wrong("a parameter stands for itself here: = is missing"));
        }
        let value = reader.value()?;
        self.assignments.push((target, value));
        self.started = true;
        Ok(reader.at)
    }

    /// `;` at `at` is the end of the block as a FANUC shows it: behind it there are comments at most.
    fn end_of_block(&mut self, mut at: usize) -> Result<(), Fault> {
        while let Some(&byte) = self.text.get(at) {
            at = match byte {
                b' ' | b'\t' | b';' => at + 1,
                b'(' => self.comment(at)?,
                _ => {
                    let message = "; ends the block, and there is more behind it";
                    let fault = self.fault(Rule::Syntax, message, at, self.text.len());
                    let help = "put a comment into ( ), and another block on a line of its own";
                    return Err(fault.help(help).into());
                }
            };
        }
        Ok(())
    }

    /// Reads the comment at `at` and gives the place after it. On GRBL it ends at the first `)`,
    /// whatever stands in it (`protocol_main_loop`).
    /// That of a CAM system is a command of its own, and may hold the brackets of a label.
    fn comment(&mut self, at: usize) -> Result<usize, Fault> {
        let rest = self.text.get(at + 1..).unwrap_or_default();
        if self.facts.source.is_some() {
            let text = rest.strip_suffix(b")").unwrap_or(rest);
            self.comments.push((at + 1, at + 1 + text.len()));
            return Ok(self.text.len());
        }
        let nests = self.facts.syntax.brackets != Brackets::AnyComment;
        match rest.iter().position(|&b| b == b')' || nests && b == b'(') {
            Some(n) if rest[n] == b')' => {
                self.comments.push((at + 1, at + 1 + n));
                Ok(at + n + 2)
            }
            Some(n) => {
                let place = at + 1 + n;
                let fault =
                    self.fault(Rule::Comment, "comments cannot be nested", place, place + 1);
                Err(fault.help("leave the inner brackets out, or write [ ]").into())
            }
            None => Err(self.fault(Rule::Comment, "the comment has no end", at, self.text.len())),
        }
    }

    /// The comments of the block.
    pub(crate) fn comments(&self) -> impl Iterator<Item = &'a [u8]> + '_ {
        let text = self.text;
        self.comments.iter().map(move |&(from, to)| text.get(from..to).unwrap_or_default())
    }

    /// Whether the block has no word but `letters` and the M word of this group.
    pub(crate) fn has_only(&self, letters: &[u8], group: Group) -> bool {
        let allowed = letters.iter().fold(bit(b'N'), |bits, &letter| bits | bit(letter));
        self.given & !allowed == 0 && self.groups & !group.bit() == 0
    }

    /// Puts a G word into the block.
    pub(crate) fn put_g(&mut self, group: Group, word: G) {
        self.g[group as usize] = Some(word);
        self.groups |= group.bit();
        self.places[group as usize] = Word::default();
        self.is_empty = false;
    }

    /// Puts an M word into the block.
    pub(crate) fn put_m(&mut self, group: Group, word: M) {
        self.m[group as usize] = Some(word);
        self.groups |= group.bit();
        self.m_count += 1;
        self.is_empty = false;
    }

    /// Puts a calculated word into the block.
    pub(crate) fn put(&mut self, letter: u8, value: f64) {
        self.words[index(letter)] = Word { value, computed: true, ..Word::default() };
        self.given |= bit(letter);
        self.pending |= bit(letter);
        self.is_empty = false;
    }

    /// The G word of a group.
    pub(crate) fn g(&self, group: Group) -> Option<G> {
        self.g[group as usize]
    }

    /// The M word of a group.
    pub(crate) fn m(&self, group: Group) -> Option<M> {
        self.m[group as usize]
    }

    /// How many G and M words there are, apart from those of the builder.
    pub(crate) fn commands(&self) -> usize {
        self.groups.count_ones() as usize
    }

    /// Whether it says how the tool moves and how fast, and nothing else.
    pub(crate) fn only_moves(&self) -> bool {
        self.groups & !Group::Motion.bit() == 0 && self.m_count == 0 && self.given & !MOVES == 0
    }

    /// Whether the block has this letter and nothing has taken it yet.
    pub(crate) fn has(&self, letter: u8) -> bool {
        self.pending & bit(letter) != 0
    }

    /// Whether the block has no letter but these, taken or not.
    pub(crate) fn gives_only(&self, letters: &[u8]) -> bool {
        let allowed = letters.iter().fold(0, |bits, &letter| bits | bit(letter));
        self.given & !allowed == 0
    }

    /// Whether the block has this letter, taken or not.
    pub(crate) fn gives(&self, letter: u8) -> bool {
        self.given & bit(letter) != 0
    }

    /// Whether the block has one of these letters ([`bit`]) and nothing has taken it yet.
    pub(crate) fn has_any(&self, letters: u32) -> bool {
        self.pending & letters != 0
    }

    /// The word of this letter, which then counts as used.
    pub(crate) fn take(&mut self, letter: u8) -> Option<Word> {
        if self.pending & bit(letter) == 0 {
            return None;
        }
        self.pending &= !bit(letter);
        Some(self.words[index(letter)])
    }

    /// The words of these letters count as used.
    pub(crate) fn pass(&mut self, letters: &[u8]) {
        for &letter in letters {
            self.pending &= !bit(letter);
        }
    }

    /// The words of these letters can be taken once more.
    pub(crate) fn again(&mut self, letters: &[u8]) {
        for &letter in letters {
            self.pending |= self.given & bit(letter);
        }
    }

    /// # Errors
    /// A word that nothing in the block uses.
    pub(crate) fn all_taken(&self) -> Result<(), Fault> {
        if self.pending == 0 {
            return Ok(());
        }
        let letter = LETTERS[self.pending.trailing_zeros() as usize % LETTERS.len()];
        let message = format!("nothing in the block uses {}", self.shown(letter));
        Err(self.at_word(letter, Rule::UnusedWord, message))
    }
}

/// The place after `/`, or on FANUC `/1` to `/9`.
fn after_block_delete(switch: BlockDelete, text: &[u8], at: usize) -> usize {
    let numbered = switch == BlockDelete::Numbered && matches!(text.get(at + 1), Some(b'1'..=b'9'));
    at + 1 + usize::from(numbered)
}
