//! Templates: what a block looks like.
//!
//! A template is Jinja. One that consists only of literal text and words is compiled once into a list
//! of steps and runs without the engine; in any other the engine renders the statements and leaves
//! the words standing, so that both end as the same steps and follow the same rules of modality and
//! spacing.

use crate::catalogue::{BlockName, VARIABLES, WordName};
use crate::guard::{self, Fault};
use crate::text::{clean, printed};
use crate::words::{Words, bit};
use deunicode::deunicode;
use machine::{Block, Format, Machine, OptionKey, OptionValue, OrientationMode};
use minijinja::value::{Object, Value};
use minijinja::{AutoEscape, Environment, ErrorKind, UndefinedBehavior};
use program::{Diagnostic, Op, Program, Record, Rule, Tool, nearest};
use std::collections::BTreeMap;
use std::io;
use std::ops::Range;
use std::sync::Arc;

/// Steps of the engine after which a template is stopped: an endless loop.
const FUEL: u64 = 100_000;

/// The most bytes that one block may give.
const MOST_BYTES: usize = 1 << 20;

/// A word in text stands as one character of the private use area, from here on.
const FIRST_WORD: u32 = 0xE000;

/// The words that say where the tool is.
pub(crate) const POSITION: Words = Words::of(&[WordName::X, WordName::Y, WordName::Z]);
/// The words that call the tool length offset.
pub(crate) const LENGTH_OFFSET: Words = Words::of(&[WordName::H, WordName::Length]);
/// The words that say where it points.
pub(crate) const ORIENTATION: Words = Words::of(&[
    WordName::A,
    WordName::B,
    WordName::C,
    WordName::U,
    WordName::V,
    WordName::VX,
    WordName::VY,
    WordName::VZ,
]);

/// One step of a block; with a gap before it, what separates two words, if something stands on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// Bytes of [`Lines::text`].
    Text { gap: bool, from: u32, to: u32 },
    /// A word, left out where it repeats itself.
    Word { gap: bool, word: WordName },
    /// End of the line.
    End,
}

/// Whether a place of a line stands in a comment or in quotes.
#[derive(Clone, Copy, Default)]
struct Marks {
    quoted: bool,
    comment: bool,
}

impl Marks {
    /// Goes past the first character of `rest`.
    fn pass(&mut self, rest: &str, format: &Format) {
        if !self.quoted && !self.comment && !format.comment_start.is_empty() {
            self.comment = rest.starts_with(&format.comment_start);
        } else if self.comment && !format.comment_end.is_empty() {
            self.comment = !rest.starts_with(&format.comment_end);
        }
        self.quoted ^= rest.starts_with('"') && !self.comment;
    }

    fn inside(self) -> bool {
        self.quoted || self.comment
    }
}

/// A block without statements.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Lines {
    pub(crate) text: String,
    pub(crate) steps: Vec<Step>,
    /// The words among them.
    pub(crate) words: Words,
}

impl Lines {
    /// Cuts `text` into steps, for a control that has only `words`. A blank next to a word, outside of comments
    /// and quotes, is a separator.
    fn of(text: String, format: &Format, words: Words) -> Lines {
        let (mut steps, mut placed) = (Vec::new(), Words::NONE);
        for line in text.split('\n') {
            let origin = line.as_ptr() as usize - text.as_ptr() as usize;
            let (mut from, mut gap) = (0, false);
            let mut marks = Marks::default();
            for (at, c) in line.char_indices() {
                marks.pass(&line[at..], format);
                let word = u32::from(c).checked_sub(FIRST_WORD).map(|i| i as usize);
                let word = word.and_then(|i| WordName::ALL.get(i).copied());
                let blank = c == '\r' || c.is_ascii_whitespace() && !marks.inside();
                if word.is_none() && !blank {
                    continue;
                }
                literal(&mut steps, &mut gap, origin + from..origin + at);
                from = at + c.len_utf8();
                gap |= blank;
                if let Some(word) = word.filter(|word| words.has(*word)) {
                    steps.push(Step::Word { gap: std::mem::take(&mut gap), word });
                    placed.add(word);
                }
            }
            literal(&mut steps, &mut gap, origin + from..origin + line.len());
            steps.push(Step::End);
        }
        Lines { text, steps, words: placed }
    }
}

/// Puts bytes of a text behind `steps`, where there are some.
fn literal(steps: &mut Vec<Step>, gap: &mut bool, bytes: Range<usize>) {
    let (from, to) = (bytes.start as u32, bytes.end as u32);
    match steps.last_mut() {
        _ if bytes.is_empty() => {}
        // The author of the text has put a blank between two literals: it stays.
        Some(Step::Text { to: last, .. }) if *last + 1 == from => (*last, *gap) = (to, false),
        _ => steps.push(Step::Text { gap: std::mem::take(gap), from, to }),
    }
}

/// The words that the control of `machine` has.
pub(crate) fn words_of(machine: &Machine) -> Words {
    let has = |name: &&WordName| {
        let word = machine.words.get(name.name());
        // Blocks whose numbers do not grow have none.
        word.is_some_and(|word| **name != WordName::N || word.step != 0)
    };
    WordName::ALL.iter().filter(has).copied().collect()
}

/// `text` with each `{{ word }}` as one character, and these words, where it consists of nothing but text and
/// words.
fn plain(text: &str) -> Option<(String, Words)> {
    let mut plain = String::with_capacity(text.len());
    let mut words = Words::NONE;
    let mut rest = text;
    while let Some(at) = rest.find('{') {
        plain.push_str(&rest[..at]);
        rest = &rest[at..];
        if let Some(inner) = rest.strip_prefix("{{") {
            let (name, behind) = inner.split_once("}}")?;
            let word = WordName::named(name.trim())?;
            plain.push(placeholder(word));
            words.add(word);
            rest = behind;
        } else if rest.starts_with("{%") || rest.starts_with("{#") {
            return None;
        } else {
            plain.push('{');
            rest = &rest[1..];
        }
    }
    plain.push_str(rest);
    Some((plain, words))
}

fn placeholder(word: WordName) -> char {
    char::from_u32(FIRST_WORD + word as u32).unwrap_or_default()
}

/// A block of a machine, ready to run.
pub(crate) struct Template<'a> {
    block: &'a Block,
    uses: Words,
    /// The words and variables that it reads, where it has statements.
    names: Vec<String>,
    /// Whether it may read which tools the program calls.
    tools: bool,
    /// Whether it may read that the cuts to come keep to the path.
    exact: bool,
    /// `None`: the engine renders it.
    lines: Option<Lines>,
}

/// What the statements of a template may read.
#[derive(Clone, Debug)]
pub(crate) struct Scope {
    /// The words that the block may write.
    pub(crate) set: Words,
    pub(crate) program: Value,
    pub(crate) machine: Value,
    pub(crate) options: Value,
    pub(crate) operation: Value,
    pub(crate) tool: Value,
    pub(crate) spindle: Value,
    pub(crate) coolant: Value,
    pub(crate) place: Value,
    pub(crate) cut: Value,
    pub(crate) text: Value,
}

impl Object for Scope {
    fn get_value(self: &Arc<Self>, key: &Value) -> Option<Value> {
        let value = match key.as_str()? {
            "program" => &self.program,
            "machine" => &self.machine,
            "options" => &self.options,
            "operation" => &self.operation,
            "tool" => &self.tool,
            "spindle" => &self.spindle,
            "coolant" => &self.coolant,
            "place" => &self.place,
            "cut" => &self.cut,
            "text" => &self.text,
            name => {
                let word = WordName::named(name)?;
                let text = self.set.has(word).then(|| placeholder(word));
                return Some(Value::from(text.map(String::from).unwrap_or_default()));
            }
        };
        Some(value.clone())
    }
}

/// Free text of a source as a trial fills it in: nothing that a control could run.
const SAMPLES: [(&str, &str); 3] = [
    ("text", "sample of a text"),
    ("operation.name", "sample of an operation"),
    ("tool.name", "sample of a tool"),
];

/// Whether `sample` stands anywhere in `text` outside of comments and quotes.
fn bare(text: &str, sample: &str, format: &Format) -> bool {
    text.split('\n').any(|line| {
        let mut marks = Marks::default();
        line.char_indices().any(|(at, _)| {
            marks.pass(&line[at..], format);
            !marks.inside() && line[at..].starts_with(sample)
        })
    })
}

impl Scope {
    /// What a trial runs on: every value is there. With `first` the tool is the first one and has a
    /// name that describes it, and every word may be written; else its name identifies it.
    fn sample(machine: &Machine, first: bool) -> Scope {
        let [(_, text), (_, operation), (_, name)] = SAMPLES;
        let name = if first { name } else { "SAMPLE" };
        let (diameter, corner_radius, length) = (Some(10.0), Some(0.5), Some(100.0));
        let tool = Tool {
            number: 1,
            name: name.into(),
            diameter,
            corner_radius,
            length,
            ..Tool::default()
        };
        let mut program = Program::new("sample");
        program.push(1, Op::Tool(Box::new(tool.clone())));
        let blank = [("blank", true), ("stock", first)];
        Scope {
            set: if first { Words::ALL } else { Words::NONE },
            program: program_value(
                machine,
                "SAMPLE".into(),
                &program.records,
                first.then(|| "1".into()),
                blank,
                "SAMPLE_1",
            ),
            operation: map([("name", Value::from(operation))]),
            tool: tool_value(machine, &tool, first, first.then_some(&tool)),
            spindle: spindle_value(first, first, !first),
            coolant: coolant_value(machine, !first, !first),
            place: place_value(!first, first, !first, [!first; 2]),
            cut: cut_value(!first, first),
            text: Value::from(text),
            ..Scope::new(machine)
        }
    }

    pub(crate) fn new(machine: &Machine) -> Scope {
        let options = machine.options.iter().map(|(name, value)| {
            let value = match value {
                OptionValue::Flag(flag) => Value::from(*flag),
                OptionValue::Number(number) => number_value(*number),
                OptionValue::Text(text) => Value::from(text.as_str()),
            };
            (name.clone(), value)
        });
        let names = [("name", &machine.name), ("title", &machine.title)];
        let names = names.map(|(key, name)| (key, Value::from(clean(name))));
        let turning = machine.orientation.simultaneous;
        let vectors = turning == OrientationMode::Vectors;
        let modes = [
            ("vectors", vectors),
            ("tool_center", vectors || turning == OrientationMode::ToolCenterAngles),
            ("tilted_plane", machine.orientation.positioned == OrientationMode::TiltedPlane),
        ];
        let modes = modes.map(|(key, value)| (key, Value::from(value)));
        Scope {
            set: Words::NONE,
            program: Value::UNDEFINED,
            machine: map(names.into_iter().chain(modes)),
            options: Value::from(options.collect::<BTreeMap<String, Value>>()),
            operation: map([("name", Value::from(""))]),
            tool: tool_value(machine, &Tool::default(), true, None),
            spindle: spindle_value(true, true, false),
            coolant: coolant_value(machine, false, false),
            place: place_value(false, false, false, [false; 2]),
            cut: cut_value(false, false),
            text: Value::from(""),
        }
    }
}

/// A whole number without a point, any other as it is.
fn number_value(number: f64) -> Value {
    let whole = number.fract() == 0.0 && number.abs() < 1e15;
    if whole { Value::from(number as i64) } else { Value::from(number) }
}

/// A value with members.
pub(crate) fn map(members: impl IntoIterator<Item = (&'static str, Value)>) -> Value {
    Value::from(members.into_iter().collect::<BTreeMap<&'static str, Value>>())
}

/// The spindle as templates see it.
pub(crate) fn spindle_value(changed: bool, clockwise: bool, stopped: bool) -> Value {
    let members = [("changed", changed), ("clockwise", clockwise), ("stopped", stopped)];
    map(members.map(|(key, value)| (key, Value::from(value))))
}

/// The coolant as templates see it: whether it is known to be off, whether that through the tool was switched on last, and the M
/// function that ends what was.
pub(crate) fn coolant_value(machine: &Machine, stopped: bool, through: bool) -> Value {
    let functions = machine.coolant;
    let apart = functions.through_off.filter(|_| through);
    let off = apart.or(functions.off).unwrap_or(9);
    map([
        ("stopped", Value::from(stopped)),
        ("through", Value::from(through)),
        ("off", Value::from(format!("M{off}"))),
    ])
}

/// The cuts to come, as templates see them.
pub(crate) fn cut_value(exact: bool, rough: bool) -> Value {
    map([("exact", Value::from(exact)), ("rough", Value::from(rough))])
}

/// Where the tool is, as templates see it.
pub(crate) fn place_value(
    home: bool,
    turned: bool,
    tilted: bool,
    [tool_center_off, plane_off]: [bool; 2],
) -> Value {
    let members = [
        ("home", home),
        ("turned", turned),
        ("tilted", tilted),
        ("tool_center_off", tool_center_off),
        ("plane_off", plane_off),
    ];
    map(members.map(|(key, value)| (key, Value::from(value))))
}

/// A tool as templates see it; `first` where none has been called before, `next` the one that is called behind it.
pub(crate) fn tool_value(
    machine: &Machine,
    tool: &Tool,
    first: bool,
    next: Option<&Tool>,
) -> Value {
    let sizes = [
        ("diameter", tool.diameter),
        ("corner_radius", tool.corner_radius),
        ("length", tool.length),
    ];
    let sizes = sizes.into_iter().filter_map(|(key, size)| Some((key, number_value(size?))));
    let named = [
        ("number", Value::from(tool.number)),
        ("name", Value::from(printed(machine, &tool.name))),
        ("first", Value::from(first)),
    ];
    let identifier =
        |key, tool: &Tool| identifies(&tool.name).then(|| (key, Value::from(tool.name.as_str())));
    let by_name = identifier("identifier", tool);
    let next_by_name = next.and_then(|next| identifier("next_identifier", next));
    let next = next.map(|next| ("next", Value::from(next.number)));
    map(named.into_iter().chain(by_name).chain(sizes).chain(next).chain(next_by_name))
}

/// Whether a control can call a tool by this name: what is longer (SINUMERIK: 32 characters) or has
/// blanks describes the tool rather than naming it.
fn identifies(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_.-".contains(c);
    (1..=32).contains(&name.len()) && name.chars().all(plain)
}

/// A program as templates see it. Its name becomes a file name on the control: the last part of a
/// path, letters, digits, `_` and `-`, at most 24 of them (SINUMERIK), never empty. Its tools are those that
/// `records` call; `blank` says whether there is a blank, and whether that is the stock.
pub(crate) fn program_value(
    machine: &Machine,
    name: String,
    records: &[Record],
    number: Option<String>,
    blank: [(&'static str, bool); 2],
    part: &str,
) -> Value {
    let mut seen = Vec::new();
    let mut tools = Vec::new();
    for record in records {
        if let Op::Tool(tool) = &record.op
            && !seen.contains(&tool.number)
        {
            tools.push(tool_value(machine, tool, seen.is_empty(), None));
            seen.push(tool.number);
        }
    }
    let number = number.map(|number| ("number", Value::from(number)));
    let members = [("name", Value::from(name)), ("tools", Value::from(tools))];
    let blank = blank.map(|(key, value)| (key, Value::from(value)));
    let part = [("part", Value::from(part))];
    map(members.into_iter().chain(blank).chain(part).chain(number))
}

/// The name of a program as a file on the control has it: the last part of a path without its extension.
pub(crate) fn file_name(name: &str) -> String {
    let name = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let name = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let kept = |c: &char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    let name: String = deunicode(name).chars().filter(kept).take(24).collect();
    if name.is_empty() { "PROGRAM".into() } else { name }
}

/// The number of a program: the one that `program_number` says, else its name, where that is one.
///
/// # Errors
/// `program_number` says none that is free for everybody. FANUC can keep 8000 to 8999 from being edited (parameter 3202#0), and 9000
/// and above are the builder's, there and at Haas.
pub(crate) fn program_number(
    machine: &Machine,
    name: &str,
) -> Result<Option<String>, Box<Diagnostic>> {
    let said = match machine.option(OptionKey::ProgramNumber) {
        Some(OptionValue::Text(text)) if !text.trim().is_empty() => text.trim().to_owned(),
        Some(OptionValue::Number(number)) => number.to_string(),
        Some(OptionValue::Text(_) | OptionValue::Flag(_)) | None => {
            return Ok(number_of(name)
                .filter(|_| name.len() <= 5)
                .map(|number| number.to_string()));
        }
    };
    if let Some(number) = number_of(&said) {
        return Ok(Some(number.to_string()));
    }
    let message = format!(
        "`program_number` is {said}: numbers of programs that everybody may use are 1 to 7999"
    );
    let help = "write `program_number = \"O1234\"`, or leave it out";
    let found = Diagnostic::error(Rule::ProgramNumber, message).help(help);
    Err(Box::new(found.file(machine.file.clone())))
}

/// The number of a program that `name` says, with or without an O: 1 to 7999, which everybody may use.
pub fn number_of(name: &str) -> Option<u32> {
    let digits = name.strip_prefix(['O', 'o']).unwrap_or(name);
    let plain = (1..=8).contains(&digits.len()) && digits.bytes().all(|c| c.is_ascii_digit());
    let number: u32 = digits.parse().ok().filter(|_| plain)?;
    (1..8000).contains(&number).then_some(number)
}

/// All blocks of a machine.
pub(crate) struct Templates<'a> {
    machine: &'a Machine,
    /// The words that its control has.
    words: Words,
    engine: Environment<'a>,
    blocks: Vec<Option<Template<'a>>>,
}

impl<'a> Templates<'a> {
    /// Compiles the blocks of `machine`.
    ///
    /// # Errors
    /// Every block, word or variable that the catalogue does not know, and every template that the
    /// engine does not understand, each with its place in the machine's files.
    pub(crate) fn compile(machine: &'a Machine) -> Result<Templates<'a>, Vec<Diagnostic>> {
        let mut engine = guard::engine();
        engine.set_undefined_behavior(UndefinedBehavior::SemiStrict);
        engine.set_auto_escape_callback(|_| AutoEscape::None);
        engine.set_fuel(Some(FUEL));
        let mut templates =
            Templates { machine, words: words_of(machine), engine, blocks: Vec::new() };
        templates.blocks.resize_with(BlockName::COUNT, || None);
        let mut errors = Vec::new();
        for (name, block) in &machine.blocks {
            let compiled = match BlockName::named(name) {
                Some(known) => templates.one(block).map(|template| (known, template)),
                None => Err(unknown_block(name, block)),
            };
            match compiled {
                Ok((known, template)) => templates.blocks[known as usize] = Some(template),
                Err(error) => errors.push(*error),
            }
        }
        if errors.is_empty() {
            for &name in BlockName::ALL {
                match templates.attempt(name) {
                    // A machine whose options leave the safe height out need not have one.
                    Ok(placed) if !placed.has(WordName::SafeHeight) => {
                        templates.unplace(name, bit(WordName::SafeHeight));
                    }
                    Ok(_) => {}
                    Err(error) => errors.push(*error),
                }
            }
        }
        if errors.is_empty() { Ok(templates) } else { Err(errors) }
    }

    /// The block places none of `words` on this machine.
    fn unplace(&mut self, name: BlockName, words: Words) {
        if let Some(template) = &mut self.blocks[name as usize] {
            template.uses &= !words;
        }
    }

    /// Runs a block on samples, so that one that can never run is reported before a program needs it. Answers the words that
    /// it has placed.
    fn attempt(&self, name: BlockName) -> Result<Words, Box<Diagnostic>> {
        let (Some(template), None) = (&self.blocks[name as usize], self.lines(name)) else {
            return Ok(Words::ALL);
        };
        let mut placed = Words::NONE;
        for first in [true, false] {
            let rendered = self.render(name, Scope::sample(self.machine, first))?;
            placed |= rendered.words;
            let spoken =
                SAMPLES.iter().find(|(_, text)| bare(&rendered.text, text, &self.machine.format));
            if let Some((variable, _)) = spoken {
                let Format { comment_start, comment_end, .. } = &self.machine.format;
                let message = format!(
                    "`{variable}` stands outside of comments and quotes: the control would take it for words"
                );
                let help = format!("put it between `{comment_start}` and the end of the line");
                let help = if comment_end.is_empty() {
                    help
                } else {
                    format!("put it between `{comment_start}` and `{comment_end}`")
                };
                let found = Diagnostic::error(Rule::TemplateComment, message).help(help);
                let place = template.block.text.find(variable).unwrap_or(0);
                return Err(Box::new(at(template.block, found, place, place + variable.len())));
            }
        }
        Ok(placed)
    }

    fn one(&self, block: &'a Block) -> Result<Template<'a>, Box<Diagnostic>> {
        if let Some((text, uses)) = plain(&block.text) {
            let lines = Lines::of(text, &self.machine.format, self.words);
            let names = Vec::new();
            return Ok(Template {
                block,
                uses,
                names,
                tools: false,
                exact: false,
                lines: Some(lines),
            });
        }
        guard::check(&block.text, self.machine).map_err(|fault| match fault {
            Fault::Syntax(error) => {
                let mut found = self::fault(block, &error);
                let at = error.range().map_or(0, |range| range.start);
                found.help = guard::way_out(block.text.get(..at).unwrap_or_default());
                found
            }
            Fault::Refused(no) => {
                let found = Diagnostic::error(no.rule, no.message).help(no.help);
                Box::new(at(block, found, no.place.start, no.place.end))
            }
        })?;
        let compiled = self.engine.template_from_str(&block.text).map_err(|e| fault(block, &e))?;
        let mut uses = Words::NONE;
        let mut names: Vec<String> = compiled.undeclared_variables(true).into_iter().collect();
        names.sort();
        for name in &names {
            match WordName::named(name) {
                Some(word) => uses.add(word),
                None => self.check_variable(block, name)?,
            }
        }
        let tools = names.iter().any(|name| name == "program" || name.starts_with("program.tools"));
        let exact = names.iter().any(|name| name == "cut" || name == "cut.exact");
        Ok(Template { block, uses, names, tools, exact, lines: None })
    }

    fn check_variable(&self, block: &Block, name: &str) -> Result<(), Box<Diagnostic>> {
        let known = match name.split_once('.') {
            Some(("options", option)) => self.machine.options.contains_key(option),
            Some((
                "tool" | "spindle" | "coolant" | "place" | "cut" | "operation" | "program"
                | "machine",
                _,
            )) => VARIABLES.iter().any(|row| row.name == name),
            _ => {
                let root = |row: &crate::Parameter| row.name.split('.').next() == Some(name);
                VARIABLES.iter().any(root)
                    || self.engine.globals().any(|(global, _)| global == name)
            }
        };
        if known {
            return Ok(());
        }
        let options: Vec<String> =
            self.machine.options.keys().map(|option| format!("options.{option}")).collect();
        let names = WordName::TABLE.iter().chain(VARIABLES).map(|row| row.name);
        let near = nearest(name, names.chain(options.iter().map(String::as_str)));
        let help = if near.is_empty() { String::new() } else { format!("did you mean {near}? ") };
        let error = Diagnostic::error(
            Rule::TemplateName,
            format!("no word or variable is called `{name}`"),
        )
        .help(help + "`toolpost explain` lists them");
        let place = block.text.find(name).unwrap_or(0);
        Err(Box::new(at(block, error, place, place + name.len())))
    }

    /// Whether some block may read which tools the program calls.
    pub(crate) fn read_tools(&self) -> bool {
        self.blocks.iter().flatten().any(|block| block.tools)
    }

    /// Whether some block reads the variable of this name, `options.blank` say.
    pub(crate) fn reads(&self, name: &str) -> bool {
        self.blocks.iter().flatten().any(|block| block.names.iter().any(|read| read == name))
    }

    /// Whether the machine has the block.
    pub(crate) fn has(&self, name: BlockName) -> bool {
        self.blocks[name as usize].is_some()
    }

    /// What is wrong where the machine lacks a block that must be written.
    pub(crate) fn missing(name: BlockName) -> Diagnostic {
        let message = format!("the control has no block `{}`", name.name());
        // No control but one of Haas has a number of its own for it.
        let number = match name == BlockName::CoolantThrough {
            true => " and the number of its M function, `through` under [coolant]",
            false => "",
        };
        let help = format!(
            "the block `{}` under [blocks] of the machine file{number}, or a toolpath that does without",
            name.name()
        );
        Diagnostic::error(Rule::MissingBlock, message).help(help)
    }

    /// Whether the machine has the block, and the block places the word.
    pub(crate) fn places(&self, name: BlockName, word: WordName) -> bool {
        self.blocks[name as usize].as_ref().is_some_and(|block| block.uses.has(word))
    }

    /// Whether the machine has the block, and the block may say that the cuts to come keep to the path.
    pub(crate) fn says_exact(&self, name: BlockName) -> bool {
        self.blocks[name as usize].as_ref().is_some_and(|block| block.exact)
    }

    /// Each word that some block places, and a block that does.
    pub(crate) fn words(&self) -> impl Iterator<Item = (WordName, &'a Block)> {
        WordName::ALL.iter().filter_map(|&word| {
            let places = self.blocks.iter().flatten().find(|block| block.uses.has(word));
            places.map(|template| (word, template.block))
        })
    }

    /// The compiled lines of a block that needs no engine.
    #[inline]
    pub(crate) fn lines(&self, name: BlockName) -> Option<&Lines> {
        self.blocks[name as usize].as_ref()?.lines.as_ref()
    }

    /// Runs the engine on a block that needs it; nothing where the machine lacks the block.
    ///
    /// # Errors
    /// What the engine found, with the place in the machine's file: an undefined value, an endless
    /// loop, an output without end.
    pub(crate) fn render(&self, name: BlockName, scope: Scope) -> Result<Lines, Box<Diagnostic>> {
        let Some(template) = &self.blocks[name as usize] else { return Ok(Lines::default()) };
        let block = template.block;
        let mut out = Capped(Vec::new());
        self.engine
            .template_from_str(&block.text)
            .and_then(|compiled| {
                compiled.render_captured_to(Value::from_object(scope), &mut out).map(drop)
            })
            .map_err(|e| fault(block, &e))?;
        let text = String::from_utf8_lossy(&out.0).into_owned();
        Ok(Lines::of(text, &self.machine.format, self.words))
    }
}

fn unknown_block(name: &str, block: &Block) -> Box<Diagnostic> {
    let near = nearest(name, BlockName::TABLE.iter().map(|row| row.name));
    let help = if near.is_empty() { String::new() } else { format!("did you mean {near}? ") };
    let error = Diagnostic::error(Rule::TemplateBlock, format!("no block is called `{name}`"))
        .help(help + "`toolpost explain` lists them")
        .file(block.file.clone())
        .line(block.line);
    Box::new(error)
}

/// What the engine says, at its place.
fn fault(block: &Block, error: &minijinja::Error) -> Box<Diagnostic> {
    let mut message = match error.kind() == ErrorKind::OutOfFuel {
        true => String::from("it does not come to an end"),
        false => error.kind().to_string(),
    };
    if let Some(detail) = error.detail() {
        message = format!("{message}: {detail}");
    }
    let source = std::error::Error::source(error).map(|s| format!(": {s}")).unwrap_or_default();
    let found =
        Diagnostic::error(Rule::Template, format!("the template cannot run: {message}{source}"));
    let range = error.range().unwrap_or(0..0);
    Box::new(at(block, found, range.start, range.end))
}

/// `found` at bytes `from..to` of the block's text, as a place of the machine's file.
fn at(block: &Block, found: Diagnostic, from: usize, to: usize) -> Diagnostic {
    let text = block.text.as_bytes();
    let from = from.min(text.len());
    let start = text[..from].iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
    let line = text[start..].split(|&b| b == b'\n').next().unwrap_or_default();
    let before = text[..start].iter().filter(|&&b| b == b'\n').count() as u32;
    let mut found =
        found.file(block.file.clone()).at(block.line + before, line, from - start, to - start);
    if before == 0 {
        found.column += block.column - 1;
    }
    found
}

/// Takes so many bytes and no more.
struct Capped(Vec<u8>);

impl io::Write for Capped {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.0.len() + bytes.len() > MOST_BYTES {
            let message = format!("one block gives more than {MOST_BYTES} bytes");
            return Err(io::Error::other(message));
        }
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
