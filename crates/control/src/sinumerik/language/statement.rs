//! Statements: what a block says of the order of blocks. They are read with their conditions evaluated
//! and carried out by [`mod@crate::sinumerik::flow::run`].

use super::call;
use super::definition;
use super::expression::Evaluator;
use super::scan::{Name, Scanner};
use super::structure::Word;
use super::value::Value;
use super::variables::{AssignmentTarget, Variable};
use crate::kernel::Outcome;
use program::Rule;
use std::rc::Rc;

/// Most repetitions of a call or a section (`P`; Job Planning 04.00, 1.15 and 2.5).
const MOST_TIMES: u32 = 9999;

/// Most arguments of a call (Programming Manual 06/2019, 3.2.2.2).
const MOST_ARGUMENTS: usize = 127;

/// A statement.
pub(crate) enum Statement {
    /// `IF` without a jump.
    If(bool),
    /// `WHILE`.
    While(bool),
    /// `UNTIL`.
    Until(bool),
    /// `FOR`.
    For(Count),
    /// `ELSE`, and what ends or begins a structure without a condition.
    Plain(Word),
    /// A jump; `None` where its conditions do not hold.
    Jump(Option<Jump>),
    /// `REPEAT`, `REPEATB` with a label.
    Section(Section),
    /// A call of a program.
    Call(ProgramCall),
    /// `MCALL`: a call of a program after each block with a motion.
    ModalCall(ProgramCall),
    /// `DEF`.
    Define(Vec<(Name, Variable)>),
    /// `PROC`, `EXTERN`: they matter where the program is called.
    Declaration,
}

/// `FOR`.
pub(crate) struct Count {
    /// What counts.
    pub place: AssignmentTarget,
    /// From.
    pub start: f64,
    /// To, itself included.
    pub end: f64,
}

/// Where a jump looks for its target.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Search {
    /// `GOTOF`: behind it.
    Forward,
    /// `GOTOB`: before it.
    Backward,
    /// `GOTO`: behind it, then before it.
    Both,
    /// `GOTOC`: as `GOTO`, but going on where there is none.
    Optional,
    /// `GOTOS`: the start of the program.
    Start,
}

/// A jump.
#[derive(Clone)]
pub(crate) struct Jump {
    /// Where its target is looked for.
    pub search: Search,
    /// Its target.
    pub target: Target,
}

/// The target of a jump.
#[derive(Clone)]
pub(crate) enum Target {
    /// A label.
    Label(Name),
    /// A block number.
    Number(u32),
    /// The start of the program.
    Start,
}

/// A section of the program that is run again.
pub(crate) struct Section {
    /// The label that it starts with.
    pub from: Name,
    /// The label of its last block, where one is named.
    pub to: Option<Name>,
    /// Whether it is the one block only (`REPEATB`).
    pub one_block: bool,
    /// How often.
    pub times: u32,
}

/// A call of a program.
#[derive(Clone)]
pub(crate) struct ProgramCall {
    /// The program as it is written.
    pub program: Rc<str>,
    /// Its arguments.
    pub arguments: Vec<Actual>,
    /// How often it is run.
    pub times: u32,
}

/// An argument of a call.
#[derive(Clone)]
pub(crate) struct Actual {
    /// Its value, where it is not left out or a whole array.
    pub value: Option<Value>,
    /// The variable that it is: its index, and the element (none for a whole array).
    pub variable: Option<(usize, Option<usize>)>,
}

/// Takes a statement that begins with `name`, where it is one.
pub(super) fn read(
    scanner: &mut Scanner,
    evaluator: &Evaluator,
    start: usize,
    name: &Name,
) -> Outcome<Option<Statement>> {
    let statement = match name.as_str() {
        "IF" => condition(scanner, evaluator)?,
        "WHILE" => Statement::While(evaluator.condition(scanner)?),
        "UNTIL" => Statement::Until(evaluator.condition(scanner)?),
        "FOR" => Statement::For(count(scanner, evaluator)?),
        "REPEAT" if scanner.rests() => Statement::Plain(Word::Repeat),
        "REPEAT" | "REPEATB" => {
            Statement::Section(section(scanner, evaluator, name.as_str() == "REPEATB")?)
        }
        "CASE" => case(scanner, evaluator)?,
        "MCALL" => match modal_call(scanner, evaluator)? {
            Some(call) => Statement::ModalCall(call),
            None => return Ok(None),
        },
        "CALL" | "EXTCALL" => {
            let brackets = scanner.take(b'(');
            let program = evaluator.text(scanner)?;
            if brackets {
                scanner.expect(b')')?;
            }
            let times = times(scanner, evaluator)?;
            Statement::Call(ProgramCall { program, arguments: Vec::new(), times })
        }
        "PCALL" => path_call(scanner, evaluator)?,
        "DEF" => Statement::Define(definition::define(scanner, evaluator)?),
        "PROC" | "EXTERN" => {
            definition::Signature::read(scanner, evaluator)?;
            Statement::Declaration
        }
        word => match Word::named(word) {
            Some(word) => Statement::Plain(word),
            None => match search(word) {
                Some(search) => Statement::Jump(Some(jump(scanner, evaluator, search)?)),
                None => return Ok(None),
            },
        },
    };
    if scanner.rests() {
        return Ok(Some(statement));
    }
    let message = format!("{} stands in a block of its own", name.as_str());
    let at = scanner.at;
    scanner.at = start;
    Err(scanner.source.error(Rule::Syntax, at..at + 1, message))
}

/// Whether `name` is the word of a statement, or belongs to one.
pub(super) fn is_word(name: &str) -> bool {
    const WORDS: [&str; 15] = [
        "CASE", "OF", "DEFAULT", "TO", "CALL", "EXTCALL", "PCALL", "DEF", "PROC", "EXTERN", "VAR",
        "REPEATB", "SET", "REP", "ENDLABEL",
    ];
    WORDS.contains(&name) || Word::named(name).is_some() || search(name).is_some()
}

fn search(name: &str) -> Option<Search> {
    Some(match name {
        "GOTOF" => Search::Forward,
        "GOTOB" => Search::Backward,
        "GOTO" => Search::Both,
        "GOTOC" => Search::Optional,
        "GOTOS" => Search::Start,
        _ => return None,
    })
}

/// `IF condition`, or `IF condition GOTOF label`, which may be followed by further ones of which the
/// first that holds counts.
fn condition(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Statement> {
    let holds = evaluator.condition(scanner)?;
    if scanner.rests() {
        return Ok(Statement::If(holds));
    }
    let mut taken = jump_word(scanner, evaluator)?.filter_if(holds);
    while scanner.take_word("IF") {
        let holds = evaluator.condition(scanner)?;
        let next = jump_word(scanner, evaluator)?;
        taken = taken.or(next.filter_if(holds));
    }
    Ok(Statement::Jump(taken))
}

impl Jump {
    fn filter_if(self, holds: bool) -> Option<Jump> {
        holds.then_some(self)
    }
}

/// Takes a jump with its word.
fn jump_word(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Jump> {
    scanner.blanks();
    let start = scanner.at;
    let name = scanner.name()?;
    match search(name.as_str()) {
        Some(search) => jump(scanner, evaluator, search),
        None => {
            let message = "a jump must stand here: GOTO, GOTOF, GOTOB, GOTOC or GOTOS";
            Err(scanner.error_since(start, Rule::Syntax, message))
        }
    }
}

/// Takes the target of a jump: a label, a block number, or a text that names one.
fn jump(scanner: &mut Scanner, evaluator: &Evaluator, search: Search) -> Outcome<Jump> {
    if search == Search::Start {
        return Ok(Jump { search, target: Target::Start });
    }
    scanner.blanks();
    let start = scanner.at;
    if scanner.take(b':') {
        return Ok(Jump { search, target: Target::Number(scanner.integer()?) });
    }
    let label = (scanner.peek() != b'"').then(|| scanner.name()).transpose()?;
    let label = label.filter(|name| !evaluator.is_variable(name));
    let target = match label {
        Some(name) => target(name.as_str()),
        None => {
            scanner.at = start;
            target(&evaluator.text(scanner)?)
        }
    };
    match target {
        Some(target) => Ok(Jump { search, target }),
        None => {
            let message = "the target of a jump is a label or a block number";
            Err(scanner.error_since(start, Rule::Jump, message))
        }
    }
}

fn target(text: &str) -> Option<Target> {
    let name = Name::of(text.trim())?;
    let number = name.as_str().strip_prefix('N').and_then(|digits| digits.parse().ok());
    Some(number.map_or(Target::Label(name), Target::Number))
}

/// `CASE expression OF constant GOTOF label ... DEFAULT GOTOF label`.
fn case(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Statement> {
    let value = evaluator.expression(scanner)?;
    if !scanner.take_word("OF") {
        return Err(scanner.error_here(Rule::Syntax, "OF is missing here"));
    }
    let mut taken = None;
    while !scanner.rests() {
        if scanner.take_word("DEFAULT") {
            let otherwise = jump_word(scanner, evaluator)?;
            taken = taken.or(Some(otherwise));
            break;
        }
        let constant = evaluator.expression(scanner)?;
        let next = jump_word(scanner, evaluator)?;
        taken = taken.or(next.filter_if(constant == value));
    }
    Ok(Statement::Jump(taken))
}

/// `variable = start TO end`.
fn count(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Count> {
    scanner.blanks();
    let place = evaluator.place(scanner)?;
    scanner.expect(b'=')?;
    let start = evaluator.expression(scanner)?;
    if !scanner.take_word("TO") {
        return Err(scanner.error_here(Rule::Syntax, "TO is missing here"));
    }
    let end = evaluator.expression(scanner)?;
    Ok(Count { place, start, end })
}

fn section(scanner: &mut Scanner, evaluator: &Evaluator, one_block: bool) -> Outcome<Section> {
    scanner.blanks();
    let from = label(scanner)?;
    scanner.blanks();
    let to = scanner.name_next().then(|| label(scanner)).transpose()?;
    if one_block && to.is_some() {
        return Err(
            scanner.error_here(Rule::Syntax, "REPEATB repeats one block: it takes one label")
        );
    }
    let times = times(scanner, evaluator)?;
    Ok(Section { from, to, one_block, times })
}

fn label(scanner: &mut Scanner) -> Outcome<Name> {
    if scanner.name_next() {
        return scanner.name();
    }
    Err(scanner.error_here(Rule::Syntax, "a label must stand here"))
}

/// `P3`, `P=n`; once where there is none.
fn times(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<u32> {
    scanner.blanks();
    if scanner.peek() != b'P' {
        return Ok(1);
    }
    scanner.at += 1;
    if scanner.take(b'=') {
        return evaluator.within(scanner, 0..=MOST_TIMES);
    }
    scanner.blanks();
    let start = scanner.at;
    let times = scanner.integer()?;
    if times <= MOST_TIMES {
        return Ok(times);
    }
    let message = format!("a program is repeated at most {MOST_TIMES} times");
    Err(scanner.error_since(start, Rule::Number, message))
}

/// `PCALL /_N_WKS_DIR/NAME(arguments)`: the path is not in quotes.
fn path_call(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Statement> {
    scanner.blanks();
    let start = scanner.at;
    let rest = scanner.source.text.get(start..).unwrap_or(&[]);
    let ends = |byte: &u8| matches!(byte, b'(' | b' ' | b'\t' | b';');
    let length = rest.iter().position(ends).unwrap_or(rest.len());
    let path = String::from_utf8_lossy(rest.get(..length).unwrap_or(rest));
    scanner.at = start + length;
    let arguments = arguments(scanner, evaluator)?;
    let times = times(scanner, evaluator)?;
    Ok(Statement::Call(ProgramCall { program: path.into(), arguments, times }))
}

/// Takes a call of the program whose name stands from `start` to here.
pub(super) fn program_call(
    scanner: &mut Scanner,
    evaluator: &Evaluator,
    start: usize,
) -> Outcome<Statement> {
    named_call(scanner, evaluator, start).map(Statement::Call)
}

/// Takes what `MCALL` calls, where that is a program and not a cycle. Its arguments are passed once, here
/// (Job Planning, "Modal subprogram call").
fn modal_call(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Option<ProgramCall>> {
    let before = scanner.at;
    scanner.blanks();
    let start = scanner.at;
    if !scanner.name_goes_on() || call::is_known(scanner.name()?.as_str()) {
        scanner.at = before;
        return Ok(None);
    }
    let mut call = named_call(scanner, evaluator, start)?;
    if call.times != 1 {
        return Err(scanner.error_since(
            start,
            Rule::Call,
            "MCALL calls the program once each time",
        ));
    }
    for actual in &mut call.arguments {
        if actual.variable.take().is_some() && actual.value.is_none() {
            let message = "MCALL with a whole array is not supported";
            return Err(scanner.error_since(start, Rule::Unsupported, message));
        }
    }
    Ok(Some(call))
}

/// A program's name up to here, its arguments, and how often.
fn named_call(scanner: &mut Scanner, evaluator: &Evaluator, start: usize) -> Outcome<ProgramCall> {
    let name = scanner.source.text.get(start..scanner.at).unwrap_or(&[]);
    let program = String::from_utf8_lossy(name.trim_ascii_end()).into();
    let arguments = arguments(scanner, evaluator)?;
    let times = times(scanner, evaluator)?;
    if !scanner.rests() {
        let message = "a call of a program stands in a block of its own";
        return Err(scanner.error_here(Rule::Syntax, message));
    }
    Ok(ProgramCall { program, arguments, times })
}

/// Takes arguments in brackets; none where no bracket comes.
fn arguments(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Vec<Actual>> {
    let mut arguments = Vec::new();
    if !scanner.take(b'(') || scanner.take(b')') {
        return Ok(arguments);
    }
    loop {
        scanner.blanks();
        let actual = match scanner.peek() {
            b',' | b')' => Actual { value: None, variable: None },
            _ => match evaluator.variable_alone(scanner)? {
                Some((variable, value)) => Actual { value, variable: Some(variable) },
                None => Actual { value: Some(evaluator.value(scanner)?), variable: None },
            },
        };
        arguments.push(actual);
        if scanner.take(b')') {
            return Ok(arguments);
        }
        scanner.expect(b',')?;
        if arguments.len() >= MOST_ARGUMENTS {
            return Err(scanner.error_here(Rule::Syntax, "a call has at most 127 arguments"));
        }
    }
}
