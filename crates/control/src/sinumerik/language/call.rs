//! Calls: words of the language that take arguments in brackets, and the cycles.

use super::expression::Evaluator;
use super::forms::{CYCLES, Form, Pattern};
use super::scan::Scanner;
use super::value::Value;
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use program::{Diagnostic, Rule};

/// What a call does.
#[derive(Clone, Copy)]
pub(crate) enum Procedure {
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
    /// `GROUP_BEGIN` and its kin: parts of the program, for the editor.
    Group,
    /// Nothing that moves an axis or changes where one goes.
    NoMotion,
    /// `POLFMASK` and its kin: which axes go where when the program is stopped.
    Retract,
    /// `MCALL` without a cycle.
    EndOfModalCall,
    /// A drilling cycle.
    Drill(&'static Form),
    /// A pattern of holes.
    Pattern(Pattern),
    /// `SETMS`: which spindle the others' words mean.
    MasterSpindle,
    /// `RET`, `ENDPROC`.
    Return,
}

/// An argument.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Argument {
    /// Left out.
    None,
    /// A number.
    Number(f64),
    /// A text, or a name that is no value (an axis, a constant of a cycle).
    Text(String),
}

/// A call.
pub(crate) struct Call {
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
    ("HOLES1", Procedure::Pattern(Pattern::Row)),
    ("HOLES2", Procedure::Pattern(Pattern::Circle)),
    ("CYCLE801", Procedure::Pattern(Pattern::Grid)),
    ("GROUP_BEGIN", Procedure::Group),
    ("GROUP_END", Procedure::Group),
    ("GROUP_ADDEND", Procedure::Group),
    // Look-ahead stops.
    ("STOPRE", Procedure::NoMotion),
    // The raw part, for the control's picture.
    ("WORKPIECE", Procedure::NoMotion),
    ("POLFA", Procedure::Retract),
    ("POLFMASK", Procedure::Retract),
    ("POLFMLIN", Procedure::Retract),
    ("SETMS", Procedure::MasterSpindle),
    ("RET", Procedure::Return),
    ("ENDPROC", Procedure::Return),
];

/// Words of the language that are known and not supported.
const UNSUPPORTED: &[(&str, &str)] = &[
    ("WHEN", SYNCHRONISED),
    ("WHENEVER", SYNCHRONISED),
    ("EVERY", SYNCHRONISED),
    ("FROM", SYNCHRONISED),
    ("DO", SYNCHRONISED),
    ("ID", SYNCHRONISED),
    ("IDS", SYNCHRONISED),
    ("DEFINE", "macros"),
    ("REDEF", "changes to definitions"),
    ("ISOCALL", "the language of other makers"),
    ("CALLPATH", "another search path; give the folders"),
    ("WRITE", "files written by the program"),
    ("READ", "files read by the program"),
    ("DELETE", "files deleted by the program"),
    ("EXECSTRING", "blocks made from texts"),
    ("EXECTAB", "blocks made from tables"),
    ("TRANSMIT", "the transformation of a face"),
    ("TRACYL", "the transformation of a cylinder"),
    ("TRAANG", "the transformation of an inclined axis"),
    ("OFFN", "an allowance on the contour"),
    ("POSA", "axes that move on over the end of the block"),
    ("SPOSA", "a spindle that turns on over the end of the block"),
    ("FL", "a feed for synchronous axes"),
    ("FA", "a feed for positioning axes"),
    ("SPCON", "position control of the spindle"),
    ("SPCOF", "position control of the spindle"),
    ("LIMS", "a limit of the speed for constant cutting speed"),
    ("GEOAX", "other geometry axes"),
    ("SETINT", INTERRUPT),
    ("LIFTFAST", INTERRUPT),
    ("DRFOF", "overlaid motions"),
    ("MEAS", MEASURING),
    ("MEAW", MEASURING),
    ("MEASA", MEASURING),
    ("MEAWA", MEASURING),
    ("POCKET1", MILLING),
    ("POCKET2", MILLING),
    ("POCKET3", MILLING),
    ("POCKET4", MILLING),
    ("SLOT1", MILLING),
    ("SLOT2", MILLING),
    ("LONGHOLE", MILLING),
    ("CYCLE60", MILLING),
    ("CYCLE61", MILLING),
    ("CYCLE62", MILLING),
    ("CYCLE63", MILLING),
    ("CYCLE64", MILLING),
    ("CYCLE70", MILLING),
    ("CYCLE71", MILLING),
    ("CYCLE72", MILLING),
    ("CYCLE73", MILLING),
    ("CYCLE74", MILLING),
    ("CYCLE75", MILLING),
    ("CYCLE76", MILLING),
    ("CYCLE77", MILLING),
    ("CYCLE78", MILLING),
    ("CYCLE79", MILLING),
    ("CYCLE90", MILLING),
    ("CYCLE899", MILLING),
    ("CYCLE802", "places by the machine's own pattern"),
    ("CYCLE97", TURNING),
    ("CYCLE98", TURNING),
    ("CYCLE99", TURNING),
    ("CYCLE93", TURNING),
    ("CYCLE94", TURNING),
    ("CYCLE95", TURNING),
];

const SYNCHRONISED: &str = "synchronised actions";
const INTERRUPT: &str = "an interrupt, which may run at any place of the program; leave it out";
const MEASURING: &str = "measuring";
const TURNING: &str = "a turning cycle, whose path the control makes; write the path";
const MILLING: &str = "a milling cycle, whose path the control makes; write the path";

/// Each word that is called, and each cycle with the arguments that all of them have.
pub(super) fn vocabulary() -> impl Iterator<Item = String> {
    let procedures = PROCEDURES.iter().map(|(name, _)| (*name).to_owned());
    let unsupported = UNSUPPORTED.iter().map(|(name, _)| (*name).to_owned());
    let cycles = CYCLES.iter().map(|form| format!("{}(10,0,2,-5)", form.name));
    procedures.chain(cycles).chain(unsupported).chain([String::from("MCALL")])
}

/// Whether `name` is a word that is called.
pub(super) fn is_known(name: &str) -> bool {
    name == "MCALL"
        || PROCEDURES.iter().any(|(n, _)| *n == name)
        || CYCLES.iter().any(|form| form.name == name)
        || UNSUPPORTED.iter().any(|(n, _)| *n == name)
}

/// Most arguments of a call (Programming Manual 06/2019, 3.2.2.2).
const MOST_ARGUMENTS: usize = 127;

impl Call {
    /// Takes a call behind its name, which starts at `start`; none where that name is not known.
    pub fn read(
        scanner: &mut Scanner,
        start: usize,
        name: &str,
        evaluator: &Evaluator,
    ) -> Outcome<Option<Call>> {
        if name == "MCALL" {
            return Call::read_modal(scanner, start, evaluator).map(Some);
        }
        if let Some((name, procedure)) = PROCEDURES.iter().find(|(n, _)| *n == name) {
            let arguments = read_arguments(scanner, evaluator)?;
            return Ok(Some(Call { procedure: *procedure, name, modal: false, arguments }));
        }
        if let Some(form) = CYCLES.iter().find(|form| form.name == name) {
            let arguments = read_arguments(scanner, evaluator)?;
            let procedure = Procedure::Drill(form);
            return Ok(Some(Call { procedure, name: form.name, modal: false, arguments }));
        }
        match UNSUPPORTED.iter().find(|(n, _)| *n == name) {
            None => Ok(None),
            Some((name, reason)) => {
                let message = format!("{name} is not supported: {reason}");
                Err(scanner.error_since(start, Rule::Unsupported, message))
            }
        }
    }

    fn read_modal(scanner: &mut Scanner, start: usize, evaluator: &Evaluator) -> Outcome<Call> {
        scanner.blanks();
        if !scanner.name_goes_on() {
            let procedure = Procedure::EndOfModalCall;
            return Ok(Call { procedure, name: "MCALL", modal: false, arguments: Vec::new() });
        }
        let name_start = scanner.at;
        let name = scanner.name()?;
        let call = match name.as_str() {
            "MCALL" => None,
            name => Call::read(scanner, name_start, name, evaluator)?,
        };
        match call {
            Some(call) if matches!(call.procedure, Procedure::Drill(_)) => {
                Ok(Call { modal: true, ..call })
            }
            _ => {
                let message = "MCALL takes a drilling cycle or a program";
                Err(scanner.error_since(start, Rule::Unsupported, message))
            }
        }
    }

    /// The number at `index`, where one is given.
    ///
    /// # Errors
    /// It is a text.
    pub fn number(&self, source: &Source, index: usize) -> Outcome<Option<f64>> {
        match self.arguments.get(index) {
            None | Some(Argument::None) => Ok(None),
            Some(Argument::Number(value)) => Ok(Some(*value)),
            Some(Argument::Text(text)) => Err(source.block_error(
                Rule::CycleParameter,
                format!("argument {} of {} is a number, not '{text}'", index + 1, self.name),
            )),
        }
    }
}

/// Takes arguments in brackets; none where no bracket comes.
fn read_arguments(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Vec<Argument>> {
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
    scanner.error_here(Rule::Syntax, "a call has at most 127 arguments")
}

/// An argument: left out, a value, or a name that is none (a constant of the cycle).
fn read_argument(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Argument> {
    scanner.blanks();
    if matches!(scanner.peek(), b',' | b')') {
        return Ok(Argument::None);
    }
    if scanner.peek() == b'_' || scanner.peek().is_ascii_alphabetic() {
        let back = scanner.at;
        let name = scanner.name()?;
        scanner.blanks();
        let alone = matches!(scanner.peek(), b',' | b')');
        let parameter = name.as_str().strip_prefix('R').is_some_and(|digits| {
            !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
        });
        let value = matches!(name.as_str(), "TRUE" | "FALSE");
        if alone && !parameter && !value && !evaluator.is_variable(&name) {
            return Ok(Argument::Text(name.as_str().to_owned()));
        }
        scanner.at = back;
    }
    let start = scanner.at;
    match evaluator.value(scanner)? {
        Value::Text(text) => Ok(Argument::Text(text.to_string())),
        value => match value.number() {
            Some(number) => Ok(Argument::Number(number)),
            None => Err(scanner.error_since(start, Rule::Type, "an axis is no argument here")),
        },
    }
}
