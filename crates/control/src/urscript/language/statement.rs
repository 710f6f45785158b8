//! Statements.

use super::expression::{Argument, Readable, arguments, read as value};
use super::scan::Scan;
use super::value::Value;
use super::words::{KEYWORDS, REFUSED};
use program::{Outcome, Rule};

/// Most parameters of a function.
const MOST_PARAMETERS: usize = 16;

/// Where a variable is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scope {
    /// `global`.
    Global,
    /// `local`.
    Local,
    /// Where it is known already; in the function, where it is not.
    Found,
}

/// What a line says.
#[derive(Clone, Debug)]
pub(crate) enum Statement<'t> {
    /// Nothing, for a person.
    Nothing,
    Comment(Box<str>),
    /// `def name(a,b):`.
    Define(&'t str, Vec<&'t str>),
    /// `end`.
    End,
    Return,
    Assign(Scope, &'t str, Value),
    Call(&'t str, Vec<Argument<'t>>),
    /// `while` that waits for an input, by its number, until it is on or off.
    While(u32, bool),
}

/// The first word of a line, where it begins with one.
pub(crate) fn word_of<'t>(scan: &mut Scan<'t>) -> Option<&'t str> {
    let word = scan.word();
    scan.at = 0;
    word
}

/// Reads a line. Nothing is executed.
///
/// # Errors
/// What is not understood, at its place.
pub(crate) fn read<'t>(scan: &mut Scan<'t>, variables: &dyn Readable) -> Outcome<Statement<'t>> {
    let text = scan.text.trim_ascii();
    if text.is_empty() {
        return Ok(Statement::Nothing);
    }
    if let Some(comment) = text.strip_prefix(b"#") {
        let comment = String::from_utf8_lossy(comment.trim_ascii());
        return Ok(match comment.is_empty() {
            true => Statement::Nothing,
            false => Statement::Comment(comment.into()),
        });
    }
    scan.peek();
    let from = scan.at;
    let Some(first) = scan.word() else {
        return Err(scan.wrong("a statement begins with a word"));
    };
    let statement = match first {
        "def" => define(scan)?,
        "end" => Statement::End,
        "return" => Statement::Return,
        "global" | "local" => {
            let scope = if first == "global" { Scope::Global } else { Scope::Local };
            let from = scan.at;
            match scan.word() {
                Some(name) => assignment(scan, variables, scope, (name, from))?,
                None => return Err(scan.wrong("the name of the variable is needed here")),
            }
        }
        "while" => wait(scan, from)?,
        word if REFUSED.contains(&word) => return Err(refused(scan, from, word)),
        _ if scan.take(b'(') => Statement::Call(first, arguments(scan, variables)?),
        _ => assignment(scan, variables, Scope::Found, (first, from))?,
    };
    scan.ends()?;
    Ok(statement)
}

fn refused(scan: &Scan, from: usize, word: &str) -> Box<program::Diagnostic> {
    let message = format!("{word} is not followed");
    let help = "control structures, threads and other motions of hand-written programs are not read yet: write movej, movel, movec, \
                assignments and calls alone";
    Box::new(scan.since(from, Rule::Unsupported, message).help(help))
}

/// `def name(a,b):`.
fn define<'t>(scan: &mut Scan<'t>) -> Outcome<Statement<'t>> {
    scan.peek();
    let from = scan.at;
    let Some(name) = scan.word() else {
        return Err(scan.wrong("the name of the function is needed here"));
    };
    if is_taken(name) {
        let message = format!("{name} is a word of the language: no function may have that name");
        return Err(scan.since(from, Rule::Definition, message));
    }
    scan.expect("(")?;
    let parameters = scan.list(")", MOST_PARAMETERS, |scan| {
        scan.word().ok_or_else(|| scan.wrong("the name of a parameter is needed here"))
    })?;
    scan.expect(":")?;
    Ok(Statement::Define(name, parameters))
}

fn is_taken(name: &str) -> bool {
    KEYWORDS.contains(&name) || REFUSED.contains(&name)
}

/// `while (get_standard_digital_in(5) != True):`, and its kin: until an input is on or off.
fn wait<'t>(scan: &mut Scan<'t>, from: usize) -> Outcome<Statement<'t>> {
    let waits = input(scan);
    match waits {
        Some((number, on)) => Ok(Statement::While(number, on)),
        None => Err(refused(scan, from, "while")),
    }
}

/// The input for which a `while` waits, and whether until it is on.
fn input(scan: &mut Scan) -> Option<(u32, bool)> {
    let bracket = scan.take(b'(');
    let negated = scan.take_word("not");
    if !scan.take_word("get_standard_digital_in") || !scan.take(b'(') {
        return None;
    }
    scan.peek();
    let digits = scan.rest().iter().take_while(|byte| byte.is_ascii_digit()).count();
    let number = std::str::from_utf8(scan.rest().get(..digits)?).ok()?.parse().ok()?;
    scan.at += digits;
    if !scan.take(b')') {
        return None;
    }
    // While the input is this, the program waits.
    let mut while_on = !negated;
    if let Some(first @ (b'=' | b'!')) = scan.peek() {
        scan.at += 1;
        if !scan.take(b'=') {
            return None;
        }
        let flag = match scan.word()? {
            "True" => true,
            "False" => false,
            _ => return None,
        };
        while_on = (while_on == flag) == (first == b'=');
    }
    if bracket && !scan.take(b')') {
        return None;
    }
    scan.take(b':').then_some((number, !while_on))
}

fn assignment<'t>(
    scan: &mut Scan<'t>,
    variables: &dyn Readable,
    scope: Scope,
    (name, from): (&'t str, usize),
) -> Outcome<Statement<'t>> {
    if !scan.take(b'=') || scan.rest().first() == Some(&b'=') {
        let message = format!("{name} is no word that is understood");
        return Err(scan.since(from, Rule::UnknownWord, message));
    }
    if is_taken(name) {
        let message = format!("{name} is a word of the language: no variable may have that name");
        return Err(scan.since(from, Rule::Definition, message));
    }
    Ok(Statement::Assign(scope, name, value(scan, variables)?))
}
