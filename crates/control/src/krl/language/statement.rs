//! What a line says.

use super::expression::{Readable, read as value, read_index, read_number};
use super::scan::Scan;
use super::value::{Name, Value};
use super::words::{FUNCTIONS, OF_KUKA, REFUSED, STATEMENTS, TYPES};
use crate::kernel::formula::mistaken;
use program::{Outcome, Rule};

/// Most arguments of a call that are read.
const MOST_ARGUMENTS: usize = 16;

/// A wait longer than a day, s, is no wait.
const LONGEST: f64 = 86_400.0;

/// A statement.
#[derive(Debug)]
pub(crate) enum Statement {
    /// A line without one, or one that the program's editor alone reads.
    Nothing,
    /// A whole line of comment.
    Comment(Box<str>),
    /// `DEF name ( )`.
    Define(Name),
    /// `DEFDAT name`.
    DefineData(Name),
    /// `END`.
    End,
    /// `ENDDAT`.
    EndData,
    /// `RETURN`.
    Return,
    /// A declaration: type, variables, and the value that a data list gives.
    Declare(Name, Vec<Name>, Option<Value>),
    /// `PTP`, `LIN`, `LIN_REL`, `CIRC`.
    Motion(Motion),
    /// `target = value`.
    Assign(Target, Value),
    /// `name (arguments)`.
    Call(Name, Vec<Value>),
    /// `WAIT`.
    Wait(Waiting),
    /// `HALT`.
    Halt,
}

/// A motion, its positions as they are written.
#[derive(Debug)]
pub(crate) enum Motion {
    /// `PTP` to joints or to a position.
    Ptp(Value, Approximation),
    /// `PTP $AXIS_ACT`, `PTP $POS_ACT`: to where the arm stands.
    Here,
    Lin(Value, Approximation),
    LinRel(Value, Approximation),
    Circ(Value, Value, Approximation),
}

/// What stands behind a motion: how its end is passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Approximation {
    /// Nothing: the arm stops.
    None,
    /// `C_DIS`.
    Distance,
    /// `C_VEL`, `C_ORI`, `C_PTP`.
    Other,
}

/// What is assigned to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target {
    pub(crate) name: Name,
    pub(crate) index: Option<i64>,
    pub(crate) field: Option<Name>,
}

/// What is waited for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Waiting {
    /// So many seconds.
    Seconds(f64),
    /// An input, and whether it has to be on.
    Input(i64, bool),
    /// A message that the operator takes away.
    Message,
}

/// Reads a line. Nothing is executed.
///
/// # Errors
/// What is not understood, at its place.
pub(crate) fn read(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Statement> {
    let text = scan.text.trim_ascii();
    if text.is_empty() || text.starts_with(b"&") {
        return Ok(Statement::Nothing);
    }
    if let Some(comment) = text.strip_prefix(b";") {
        return Ok(comment_of(comment));
    }
    let from = scan.at;
    let Some(first) = scan.name()? else {
        return Err(scan.wrong("a statement begins with a word"));
    };
    let statement = match first.as_str() {
        "PTP" => ptp(scan, variables)?,
        "LIN" => Statement::Motion(Motion::Lin(value(scan, variables)?, approximation(scan)?)),
        "LIN_REL" => {
            Statement::Motion(Motion::LinRel(value(scan, variables)?, approximation(scan)?))
        }
        "CIRC" => circ(scan, variables)?,
        "WAIT" => wait(scan, variables)?,
        "HALT" => Statement::Halt,
        "DEF" => define(scan)?,
        "DEFDAT" => {
            let name = scan.needed("the name of the program whose data these are")?;
            scan.take_word("PUBLIC");
            Statement::DefineData(name)
        }
        "END" => Statement::End,
        "ENDDAT" => Statement::EndData,
        "RETURN" => Statement::Return,
        "EXT" | "GLOBAL" | "INTERRUPT" => external(scan, first)?,
        "DECL" => {
            scan.take_word("GLOBAL");
            match scan.name()? {
                Some(kind) => declaration(scan, variables, kind)?,
                None => return Err(scan.wrong("the type of the variable is needed here")),
            }
        }
        word if TYPES.contains(&word)
            && !matches!(scan.peek(), Some(b'=' | b'.' | b'[' | b'(')) =>
        {
            declaration(scan, variables, first)?
        }
        word if REFUSED.contains(&word) => {
            let message = format!("{word} is not followed");
            let help = "control structures and splines of hand-written programs are not read yet: write motions, \
                        assignments and calls alone";
            return Err(Box::new(scan.since(from, Rule::Unsupported, message).help(help)));
        }
        _ if scan.peek() == Some(b'(') => call(scan, variables, first)?,
        _ => assignment(scan, variables, first, from)?,
    };
    scan.ends()?;
    Ok(statement)
}

/// A comment for a person; what folds lines in the editor is none.
fn comment_of(text: &[u8]) -> Statement {
    let text = String::from_utf8_lossy(text.trim_ascii());
    let folds = |word: &str| {
        text.trim_start_matches(';').trim_start().to_ascii_uppercase().starts_with(word)
    };
    match text.is_empty() || folds("FOLD") || folds("ENDFOLD") {
        true => Statement::Nothing,
        false => Statement::Comment(text.into()),
    }
}

fn ptp(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Statement> {
    for here in ["$AXIS_ACT", "$POS_ACT"] {
        if scan.take_word(here) {
            return Ok(Statement::Motion(Motion::Here));
        }
    }
    Ok(Statement::Motion(Motion::Ptp(value(scan, variables)?, approximation(scan)?)))
}

fn circ(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Statement> {
    let via = value(scan, variables)?;
    scan.expect(",")?;
    let end = value(scan, variables)?;
    if scan.take(b',') {
        let message =
            "an arc with CA goes on beyond its end, or ends before it: that is not followed";
        return Err(scan.wrong(message));
    }
    Ok(Statement::Motion(Motion::Circ(via, end, approximation(scan)?)))
}

/// `C_DIS` and its kin behind a motion, two at the most.
fn approximation(scan: &mut Scan) -> Outcome<Approximation> {
    let mut found = Approximation::None;
    for _ in 0..2 {
        let before = scan.at;
        let Some(word) = scan.name()? else { break };
        found = match (word.as_str(), found) {
            ("C_DIS", Approximation::None) => Approximation::Distance,
            ("C_DIS" | "C_VEL" | "C_ORI" | "C_PTP", _) => Approximation::Other,
            _ => {
                scan.at = before;
                return Err(scan.wrong(format!("{word} is not understood behind a motion")));
            }
        };
    }
    Ok(found)
}

/// `WAIT SEC 2`, `WAIT FOR $IN[1]`, `WAIT FOR StrClear($LOOP_MSG[])`.
fn wait(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Statement> {
    if scan.take_word("SEC") {
        let from = scan.at;
        let seconds = read_number(scan, variables)?;
        if seconds < 0.0 {
            let message = "a wait below 0 s ends nothing: the control does not wait";
            return Err(scan.since(from, Rule::Dwell, message));
        }
        if seconds > LONGEST {
            let message = "a wait above a day (86400 s) is none that a program means";
            return Err(scan.since(from, Rule::Dwell, message));
        }
        return Ok(Statement::Wait(Waiting::Seconds(seconds)));
    }
    if !scan.take_word("FOR") {
        return Err(scan.wrong("SEC or FOR is needed behind WAIT"));
    }
    if scan.take_word("STRCLEAR") {
        scan.expect("(")?;
        let name = scan.name()?;
        read_index(scan, variables)?;
        scan.expect(")")?;
        return match name.is_some_and(|name| name.as_str() == "$LOOP_MSG") {
            true => Ok(Statement::Wait(Waiting::Message)),
            false => Err(scan.wrong("of texts only $LOOP_MSG[] is waited for")),
        };
    }
    condition(scan, variables)
}

/// An input: `$IN[1]`, `NOT $IN[1]`, `$IN[1]==FALSE`, also in brackets.
fn condition(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Statement> {
    let bracket = scan.take(b'(');
    let mut on = !scan.take_word("NOT");
    if !scan.take_word("$IN") {
        return Err(scan.wrong("only a wait for one input is followed: WAIT FOR $IN[1]"));
    }
    let Some(number) = read_index(scan, variables)? else {
        return Err(scan.wrong("the number of the input is needed: $IN[1]"));
    };
    if scan.take(b'=') {
        scan.expect("=")?;
        let from = scan.at;
        match value(scan, variables)? {
            Value::Flag(flag) => on = on == flag,
            other => return Err(mistaken(scan, from, &other, "TRUE or FALSE")),
        }
    }
    if bracket {
        scan.expect(")")?;
    }
    Ok(Statement::Wait(Waiting::Input(number, on)))
}

/// `DEF name ( )`: without parameters.
fn define(scan: &mut Scan) -> Outcome<Statement> {
    let name = program_name(scan)?;
    scan.expect("(")?;
    if !scan.take(b')') {
        return Err(scan.wrong("programs with parameters are not followed"));
    }
    Ok(Statement::Define(name))
}

/// The name in `DEFFCT type name (..)`, from its first word on. Functions are not followed.
///
/// # Errors
/// No function has that name.
pub(crate) fn function_name(scan: &mut Scan) -> Outcome {
    scan.take_word("DEFFCT");
    scan.needed("the type of the function")?;
    if scan.take(b'[') {
        while !matches!(scan.peek(), Some(b']') | None) {
            scan.at += 1;
        }
        scan.expect("]")?;
    }
    program_name(scan).map(drop)
}

/// The name of a program or a function.
///
/// # Errors
/// The language or KUKA's software has something else of that name.
fn program_name(scan: &mut Scan) -> Outcome<Name> {
    let name = scan.needed("the name of the program")?;
    if [STATEMENTS, REFUSED, TYPES].iter().any(|words| words.contains(&name.as_str())) {
        return Err(scan.wrong(format!("{name} is a word of the language, and names no program")));
    }
    if OF_KUKA.contains(&name.as_str()) {
        let message =
            format!("{name} is a program of KUKA's own software, which calls it by that name");
        let found = scan.since(0, Rule::ProgramFrame, message);
        return Err(Box::new(found.help("give the program, and its file, another name")));
    }
    let of_language = match name.as_str() {
        own if own.starts_with('$') => "variables of the system begin with $",
        own if FUNCTIONS.contains(&own) => "a function of the language has that name",
        _ => return Ok(name),
    };
    let message = format!("{name} names no program: {of_language}");
    Err(scan.since(0, Rule::ProgramFrame, message))
}

/// The programs of KUKA's own software whose files lie in no folder where an operator's programs do. `CELL.SRC` lies there.
pub(crate) fn of_kuka() -> impl Iterator<Item = &'static str> {
    OF_KUKA.iter().copied().filter(|name| *name != "CELL")
}

/// `EXT name (...)`, and the interrupt of the standard head, which stops the program's timers at a stop and moves nothing:
/// `GLOBAL INTERRUPT DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM ( )`, `INTERRUPT ON 3`.
fn external(scan: &mut Scan, first: Name) -> Outcome<Statement> {
    const STANDARD: &str = "DECL 3 WHEN $STOPMESS==TRUE DO IR_STOPM()";
    let text = String::from_utf8_lossy(scan.rest()).to_ascii_uppercase();
    let text = text.split(';').next().unwrap_or_default();
    let squeezed: String = text.split_whitespace().collect();
    let standard: String = STANDARD.split_whitespace().collect();
    let known = match first.as_str() {
        "EXT" => scan.name()?.is_some() && scan.take(b'(') && squeezed.ends_with(')'),
        "GLOBAL" => squeezed == format!("INTERRUPT{standard}"),
        _ => squeezed == standard || squeezed == "ON3" || squeezed == "OFF3",
    };
    if !known {
        let message =
            format!("this form of {first} is not followed: an interrupt may move the arm");
        return Err(Box::new(
            scan.wrong(message).help("leave it out, or write that of KUKA's standard head"),
        ));
    }
    scan.at = scan.text.len();
    Ok(Statement::Nothing)
}

/// The variables of a declaration behind their type; one alone may have a value.
fn declaration(scan: &mut Scan, variables: &dyn Readable, kind: Name) -> Outcome<Statement> {
    let mut names = Vec::new();
    loop {
        let name = scan.needed("the name of the variable")?;
        read_index(scan, variables)?;
        names.push(name);
        if !scan.take(b',') {
            break;
        }
    }
    let value = match names.len() == 1 && scan.take(b'=') {
        true => Some(value(scan, variables)?),
        false => None,
    };
    Ok(Statement::Declare(kind, names, value))
}

fn call(scan: &mut Scan, variables: &dyn Readable, name: Name) -> Outcome<Statement> {
    scan.expect("(")?;
    let arguments = scan.list(")", MOST_ARGUMENTS, |scan| value(scan, variables))?;
    Ok(Statement::Call(name, arguments))
}

fn assignment(
    scan: &mut Scan,
    variables: &dyn Readable,
    name: Name,
    from: usize,
) -> Outcome<Statement> {
    let index = read_index(scan, variables)?;
    let field = if scan.take(b'.') { scan.name()? } else { None };
    if !scan.take(b'=') {
        let message = format!("{name} is no word that is understood");
        return Err(scan.since(from, Rule::UnknownWord, message));
    }
    let value = value(scan, variables)?;
    Ok(Statement::Assign(Target { name, index, field }, value))
}
