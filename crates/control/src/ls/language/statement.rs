//! Instructions.

use super::scan::Scan;
use super::words::REFUSED;
use program::{Diagnostic, Outcome, Rule};

/// Largest numbers of positions, registers, frames, and inputs or outputs.
const POSITIONS: u32 = 32_767;
const REGISTERS: u32 = 9_999;
const FRAMES: u32 = 10;
const SIGNALS: u32 = 99_999;
const PAYLOADS: u32 = 10;

/// Most operators of an assignment (R-30iB operator's manual, "Mixed logic": 5 in an arithmetic instruction).
const MOST_OPERATORS: usize = 5;

/// Most arguments of a call.
const MOST_ARGUMENTS: usize = 10;

/// A number of an instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    Register(u32),
}

/// How fast a motion goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Speed {
    /// Of joints, percent of the fastest.
    Percent(Value),
    /// Of the tip: a value, and how many mm/min one of it is.
    Tip(Value, f64),
}

/// How the end of a motion is passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Termination {
    Fine,
    /// `CNT`: by an amount that the speed decides.
    Continuous,
    /// `CR`: within so many mm.
    Region(f64),
}

/// Which way a motion goes, and to which positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    Joint(u32),
    Linear(u32),
    Circular(u32, u32),
}

/// A motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motion {
    pub(crate) shape: Shape,
    pub(crate) speed: Speed,
    pub(crate) termination: Termination,
    /// `Wjnt`: the wrist's joints go evenly, and the tool tilts.
    pub(crate) by_wrist: bool,
}

/// Which frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Frames {
    User,
    Tool,
}

/// What an instruction says.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Statement<'t> {
    Nothing,
    Comment(Box<str>),
    /// `UFRAME_NUM=1`.
    Select(Frames, Value),
    /// `UFRAME[9]=PR[8]`.
    Frame(Frames, u32, u32),
    /// `PR[9,1]=`: the register, its element from 1, and the value.
    Element(u32, u32, Sum),
    Register(u32, Sum),
    Motion(Motion),
    Digital(u32, bool),
    Analog(u32, Value),
    Wait(Value),
    Input(u32, bool),
    Message(Box<str>),
    Pause,
    /// `PAYLOAD[1]`
    Payload(u32),
    End,
    Call(&'t str, Vec<Value>),
}

/// A value, and what operators make of it from left to right.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Sum {
    pub(crate) first: Value,
    pub(crate) rest: Vec<(u8, Value)>,
}

/// Reads an instruction. Nothing is executed.
///
/// # Errors
/// What is not understood, at its place.
pub(crate) fn read<'t>(scan: &mut Scan<'t>) -> Outcome<Statement<'t>> {
    if scan.take_text("//") || scan.peek().is_none() {
        return Ok(Statement::Nothing);
    }
    if scan.take(b'!') {
        let text = String::from_utf8_lossy(scan.rest().trim_ascii());
        return Ok(Statement::Comment(text.into()));
    }
    let from = scan.at;
    let Some(word) = scan.letters_alone() else {
        return Err(scan.wrong("an instruction begins with a word"));
    };
    let statement = match word {
        "J" | "L" | "C" => Statement::Motion(motion(scan, word)?),
        "UFRAME_NUM" | "UTOOL_NUM" => {
            scan.expect("=")?;
            Statement::Select(frames(word), value(scan)?)
        }
        "UFRAME" | "UTOOL" => {
            let number = closed(scan, FRAMES)?;
            scan.expect("=")?;
            if scan.letters_alone() != Some("PR") {
                return Err(scan.wrong("a frame is set to a position register: UFRAME[9]=PR[9]"));
            }
            Statement::Frame(frames(word), number, closed(scan, REGISTERS)?)
        }
        "PR" => element(scan)?,
        "R" => {
            let number = closed(scan, REGISTERS)?;
            scan.expect("=")?;
            Statement::Register(number, sum(scan)?)
        }
        "DO" => {
            let number = closed(scan, SIGNALS)?;
            scan.expect("=")?;
            Statement::Digital(number, switched(scan)?)
        }
        "AO" => {
            let number = closed(scan, SIGNALS)?;
            scan.expect("=")?;
            Statement::Analog(number, value(scan)?)
        }
        "WAIT" => wait(scan)?,
        "MESSAGE" => Statement::Message(text(scan)?),
        "PAUSE" => Statement::Pause,
        "END" => Statement::End,
        // Which load: the operator's schedule of that number.
        "PAYLOAD" => Statement::Payload(closed(scan, PAYLOADS)?),
        // A label is only jumped to.
        "LBL" => {
            closed(scan, REGISTERS)?;
            Statement::Nothing
        }
        "CALL" => call(scan)?,
        _ if REFUSED.contains(&word) => {
            let message = format!("{word} is not followed");
            let help = "control structures of hand-written programs are not read yet: write motions, assignments and calls alone";
            return Err(Box::new(scan.since(from, Rule::Unsupported, message).help(help)));
        }
        _ => {
            let message = format!("{word} is no word that is understood");
            return Err(scan.since(from, Rule::UnknownWord, message));
        }
    };
    scan.ends()?;
    Ok(statement)
}

fn frames(word: &str) -> Frames {
    if word.starts_with("UF") { Frames::User } else { Frames::Tool }
}

/// A number in brackets.
fn closed(scan: &mut Scan, most: u32) -> Outcome<u32> {
    let number = scan.index(most)?;
    scan.expect("]")?;
    Ok(number)
}

/// A number, or a register.
fn value(scan: &mut Scan) -> Outcome<Value> {
    if scan.peek() == Some(b'R') {
        scan.at += 1;
        return Ok(Value::Register(closed(scan, REGISTERS)?));
    }
    let bracket = scan.take(b'(');
    let Some(number) = scan.decimal() else {
        return Err(scan.wrong("a number or a register R[1] is needed here"));
    };
    if bracket {
        scan.expect(")")?;
    }
    Ok(Value::Number(number))
}

/// Values with operators between them: either `+` and `-`, or `*` and `/`, which go from left to right.
fn sum(scan: &mut Scan) -> Outcome<Sum> {
    let mut sum = Sum { first: value(scan)?, rest: Vec::new() };
    while let Some(operator @ (b'+' | b'-' | b'*' | b'/')) = scan.peek() {
        let adds = |operator: u8| matches!(operator, b'+' | b'-');
        let mixed = sum.rest.iter().any(|(before, _)| adds(*before) != adds(operator));
        if mixed || sum.rest.len() == MOST_OPERATORS {
            let message = "an instruction has up to five operators, either + and - or * and /";
            return Err(scan.wrong(message));
        }
        scan.at += 1;
        sum.rest.push((operator, value(scan)?));
    }
    Ok(sum)
}

/// `PR[9,1]=`.
fn element<'t>(scan: &mut Scan<'t>) -> Outcome<Statement<'t>> {
    let register = scan.index(REGISTERS)?;
    if !scan.take(b',') {
        let message =
            "a whole position register is not followed: write its elements PR[9,1] to PR[9,6]";
        return Err(scan.since(0, Rule::Unsupported, message));
    }
    let element = scan.decimal().filter(|element| [1.0, 2.0, 3.0, 4.0, 5.0, 6.0].contains(element));
    let Some(element) = element else {
        return Err(scan.wrong("the element is 1 to 6: X, Y, Z, W, P, R"));
    };
    scan.expect("]")?;
    scan.expect("=")?;
    Ok(Statement::Element(register, element as u32, sum(scan)?))
}

fn switched(scan: &mut Scan) -> Outcome<bool> {
    match scan.letters_alone() {
        Some("ON") => Ok(true),
        Some("OFF") => Ok(false),
        _ => Err(scan.wrong("ON or OFF is needed here")),
    }
}

/// `WAIT 2.00(sec)`, `WAIT DI[5]=ON`.
fn wait<'t>(scan: &mut Scan<'t>) -> Outcome<Statement<'t>> {
    if scan.take_text("DI") {
        let number = closed(scan, SIGNALS)?;
        scan.expect("=")?;
        return Ok(Statement::Input(number, switched(scan)?));
    }
    let seconds = value(scan)?;
    if let Value::Register(_) = seconds {
        return Ok(Statement::Wait(seconds));
    }
    match scan.take_text("(sec)") {
        true => Ok(Statement::Wait(seconds)),
        false => Err(scan.wrong("(sec) is needed here: WAIT 2.00(sec)")),
    }
}

/// A text in square brackets.
fn text(scan: &mut Scan) -> Outcome<Box<str>> {
    scan.expect("[")?;
    let rest = scan.rest();
    let Some(length) = rest.iter().position(|byte| *byte == b']') else {
        return Err(scan.wrong("the text has no end"));
    };
    scan.at += length + 1;
    Ok(String::from_utf8_lossy(&rest[..length]).into())
}

/// `CALL NAME`, `CALL NAME(1,2)`.
fn call<'t>(scan: &mut Scan<'t>) -> Outcome<Statement<'t>> {
    let Some(name) = scan.word() else {
        return Err(scan.wrong("the name of a program is needed here"));
    };
    let mut arguments = Vec::new();
    if scan.take(b'(') {
        arguments = scan.list(")", MOST_ARGUMENTS, value)?;
    }
    Ok(Statement::Call(name, arguments))
}

fn motion(scan: &mut Scan, word: &str) -> Outcome<Motion> {
    let shape = match word {
        "J" => Shape::Joint(target(scan)?),
        "L" => Shape::Linear(target(scan)?),
        _ => {
            let via = target(scan)?;
            // The second point stands in a line of its own that has no number.
            scan.take(b':');
            Shape::Circular(via, target(scan)?)
        }
    };
    let speed = speed(scan, matches!(shape, Shape::Joint(_)))?;
    let termination = termination(scan)?;
    let by_wrist = options(scan)?;
    Ok(Motion { shape, speed, termination, by_wrist })
}

fn target(scan: &mut Scan) -> Outcome<u32> {
    scan.peek();
    let from = scan.at;
    match scan.letters_alone() {
        Some("P") => closed(scan, POSITIONS),
        Some("PR") => {
            let message = "a motion to a position register is not followed: write a position P[1]";
            Err(scan.since(from, Rule::Unsupported, message))
        }
        _ => Err(scan.wrong("a position P[1] is needed here")),
    }
}

/// `20%`, `100mm/sec`, `120cm/min`, `12.5inch/min`.
fn speed(scan: &mut Scan, of_joints: bool) -> Outcome<Speed> {
    let from = scan.at;
    let value = value(scan)?;
    let units = [("mm/sec", 60.0), ("cm/min", 10.0), ("inch/min", 25.4)];
    let unit = units.into_iter().find(|(unit, _)| scan.take_text(unit));
    if let (Value::Number(number), Some((name, _))) = (value, unit) {
        // The pendant takes whole mm/sec and cm/min, and tenths of inch/min.
        let parts = if name == "inch/min" { 10.0 } else { 1.0 };
        if (number * parts - (number * parts).round()).abs() > 1e-6 {
            let message = format!("{number} {name} has more digits than the control keeps");
            let found = scan.since(from, Rule::Number, message);
            return Err(Box::new(
                found.help("write whole mm/sec or cm/min, or tenths of inch/min"),
            ));
        }
    }
    match (scan.take(b'%'), unit, of_joints) {
        (true, None, true) => Ok(Speed::Percent(value)),
        (false, Some((_, factor)), false) => Ok(Speed::Tip(value, factor)),
        _ => {
            let message = match of_joints {
                true => "the speed of joints is followed in %",
                false => "the speed of a line or an arc is followed in mm/sec, cm/min and inch/min",
            };
            Err(scan.since(from, Rule::Unsupported, message))
        }
    }
}

fn termination(scan: &mut Scan) -> Outcome<Termination> {
    let number = |scan: &mut Scan, most: f64| {
        scan.decimal()
            .filter(|number| (0.0..=most).contains(number))
            .ok_or_else(|| scan.wrong(format!("a number from 0 to {most} is needed here")))
    };
    match scan.letters_alone() {
        Some("FINE") => Ok(Termination::Fine),
        Some("CNT") => number(scan, 100.0).map(|_| Termination::Continuous),
        Some("CR") => number(scan, 10_000.0).map(Termination::Region),
        _ => Err(scan.wrong("FINE, CNT or CR is needed here")),
    }
}

/// The largest acceleration that a motion may ask for, percent of what the controller would take.
const MOST_ACC: f64 = 150.0;

/// What stands behind: whether the wrist's joints go evenly.
fn options(scan: &mut Scan) -> Outcome<bool> {
    let mut by_wrist = false;
    while scan.peek().is_some() {
        let from = scan.at;
        match scan.letters_alone() {
            Some("ACC") => {
                let within = scan.decimal().is_some_and(|part| (0.0..=MOST_ACC).contains(&part));
                if !within {
                    let message = "ACC is 0 to 150 percent of the acceleration";
                    return Err(scan.since(from, Rule::Number, message));
                }
            }
            Some("Wjnt") => by_wrist = true,
            _ => return Err(unknown_option(scan, from)),
        }
    }
    Ok(by_wrist)
}

fn unknown_option(scan: &Scan, from: usize) -> Box<Diagnostic> {
    let message = "this option of a motion is not followed";
    scan.since(from, Rule::Unsupported, message)
}
