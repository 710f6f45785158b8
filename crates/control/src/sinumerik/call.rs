//! Calls: words of the language that take arguments in brackets, and the cycles.

use super::Fallible;
use super::cycles::{CYCLES, Form};
use super::expression::Evaluator;
use super::scan::{Scanner, Source};
use program::Diagnostic;

/// What a call does.
#[derive(Clone, Copy)]
pub(super) enum Procedure {
    /// `TRAORI`: positions are the tool tip's from here on.
    Traori,
    /// `TRAFOOF`.
    Trafoof,
    /// `CYCLE800`.
    Swivel,
    /// `CYCLE832`: how closely the path is followed.
    HighSpeed,
    /// `FGROUP`: which axes the feed is the speed of.
    FeedGroup,
    /// Nothing that moves an axis or changes where one goes.
    NoMotion,
    /// `MCALL` without a cycle.
    EndOfModalCall,
    /// A drilling cycle.
    Drill(&'static Form),
    /// `RET`.
    Return,
}

/// An argument.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Argument {
    /// Left out.
    None,
    /// A number.
    Number(f64),
    /// A text, or a name that is no value (an axis, a constant of a cycle).
    Text(String),
}

/// A call.
pub(super) struct Call {
    /// What is called.
    pub procedure: Procedure,
    /// Its name.
    pub name: &'static str,
    /// Whether `MCALL` stands before it.
    pub modal: bool,
    /// Its arguments.
    pub arguments: Vec<Argument>,
}

/// Words that are called, besides the cycles.
const PROCEDURES: &[(&str, Procedure)] = &[
    ("TRAORI", Procedure::Traori),
    ("TRAFOOF", Procedure::Trafoof),
    ("CYCLE800", Procedure::Swivel),
    ("CYCLE832", Procedure::HighSpeed),
    ("FGROUP", Procedure::FeedGroup),
    // Look-ahead stops.
    ("STOPRE", Procedure::NoMotion),
    // The raw part, for the control's picture.
    ("WORKPIECE", Procedure::NoMotion),
    ("RET", Procedure::Return),
];

/// Words of the language above blocks and words.
const HIGHER_LANGUAGE: &[&str] = &[
    "DEF", "IF", "ELSE", "ENDIF", "FOR", "ENDFOR", "WHILE", "ENDWHILE", "LOOP", "ENDLOOP",
    "REPEAT", "REPEATB", "UNTIL", "GOTO", "GOTOF", "GOTOB", "GOTOC", "GOTOS", "CASE", "PROC",
    "EXTERN", "CALL", "PCALL", "EXTCALL", "ISOCALL", "WHEN", "WHENEVER", "EVERY", "DO", "ID",
    "IDS", "SET", "REP", "DEFINE", "REDEF",
];

/// Most arguments of a call (Programming Manual 06/2019, 3.2.2.2).
const MOST_ARGUMENTS: usize = 127;

impl Call {
    /// Takes a call behind its name, which starts at `start`.
    pub fn read(
        scanner: &mut Scanner,
        start: usize,
        name: &str,
        evaluator: &Evaluator,
    ) -> Fallible<Call> {
        if name == "MCALL" {
            return Call::read_modal(scanner, start, evaluator);
        }
        if let Some((name, procedure)) = PROCEDURES.iter().find(|(n, _)| *n == name) {
            let arguments = read_arguments(scanner, evaluator)?;
            return Ok(Call { procedure: *procedure, name, modal: false, arguments });
        }
        if let Some(form) = CYCLES.iter().find(|form| form.name == name) {
            let arguments = read_arguments(scanner, evaluator)?;
            let procedure = Procedure::Drill(form);
            return Ok(Call { procedure, name: form.name, modal: false, arguments });
        }
        let message = if HIGHER_LANGUAGE.contains(&name) {
            format!("{name} is not supported yet")
        } else {
            format!("'{name}' is not known: not a command, a cycle or an address of this control")
        };
        let rule = if HIGHER_LANGUAGE.contains(&name) { "unsupported" } else { "unknown-word" };
        Err(scanner.error_since(start, rule, message))
    }

    fn read_modal(scanner: &mut Scanner, start: usize, evaluator: &Evaluator) -> Fallible<Call> {
        scanner.blanks();
        if !scanner.name_goes_on() {
            let procedure = Procedure::EndOfModalCall;
            return Ok(Call { procedure, name: "MCALL", modal: false, arguments: Vec::new() });
        }
        let name_start = scanner.at;
        let name = scanner.name()?;
        let call = match name.as_str() {
            "MCALL" => None,
            name => Some(Call::read(scanner, name_start, name, evaluator)?),
        };
        match call {
            Some(call) if matches!(call.procedure, Procedure::Drill(_)) => {
                Ok(Call { modal: true, ..call })
            }
            _ => Err(scanner.error_since(start, "unsupported", "MCALL needs a drilling cycle")),
        }
    }

    /// The number at `index`, where one is given.
    ///
    /// # Errors
    /// It is a text.
    pub fn number(&self, source: &Source, index: usize) -> Fallible<Option<f64>> {
        match self.arguments.get(index) {
            None | Some(Argument::None) => Ok(None),
            Some(Argument::Number(value)) => Ok(Some(*value)),
            Some(Argument::Text(text)) => Err(source.block_error(
                "cycle-parameter",
                format!("argument {} of {} is a number, not '{text}'", index + 1, self.name),
            )),
        }
    }
}

/// Takes arguments in brackets; none where no bracket comes.
fn read_arguments(scanner: &mut Scanner, evaluator: &Evaluator) -> Fallible<Vec<Argument>> {
    let mut arguments = Vec::new();
    if !scanner.take(b'(') || scanner.take(b')') {
        return Ok(arguments);
    }
    loop {
        arguments.push(read_argument(scanner, evaluator)?);
        if scanner.take(b')') {
            return Ok(arguments);
        }
        scanner.expect(b',')?;
        if arguments.len() > MOST_ARGUMENTS {
            return Err(too_many(scanner));
        }
    }
}

fn too_many(scanner: &Scanner) -> Box<Diagnostic> {
    scanner.error_here("syntax", "a call has at most 127 arguments")
}

fn read_argument(scanner: &mut Scanner, evaluator: &Evaluator) -> Fallible<Argument> {
    scanner.blanks();
    match scanner.peek() {
        b',' | b')' => Ok(Argument::None),
        b'"' => scanner.quoted().map(Argument::Text),
        b'_' | b'A'..=b'Z' => {
            let back = scanner.at;
            let name = scanner.name()?;
            scanner.blanks();
            let alone = matches!(scanner.peek(), b',' | b')');
            let parameter = name.as_str().starts_with('R')
                && name.as_str().bytes().skip(1).all(|b| b.is_ascii_digit())
                && name.as_str().len() > 1;
            if alone && !parameter {
                return Ok(Argument::Text(name.as_str().to_owned()));
            }
            scanner.at = back;
            evaluator.expression(scanner).map(Argument::Number)
        }
        _ => evaluator.expression(scanner).map(Argument::Number),
    }
}
