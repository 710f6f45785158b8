//! What a statement says.

use super::expression::{Readable, places, read as value, read_as, read_number};
use super::records::{fits, kind_of};
use super::scan::Scan;
use super::value::{Name, Value};
use super::words::{REFUSED, RESERVED};
use crate::Turning;
use crate::kernel::flow::BlockLocation;
use program::{Outcome, Rule};

/// Most arguments of a call that are read.
const MOST_ARGUMENTS: usize = 16;

/// A statement of a procedure.
#[derive(Debug)]
pub(crate) enum Statement {
    /// What changes nothing that is followed: `ConfJ`, `AccSet`.
    Nothing,
    Motion(Box<Motion>),
    /// `target := value`.
    Assign(Target, Value),
    Declare(Declaration),
    /// A call of a procedure with its arguments.
    Call(Name, Vec<Value>),
    /// A call by a name that a text has: of a module, or of the only one that has it.
    CallByName(Option<Name>, Name),
    /// `Load \Dynamic`: a module from this file of the controller.
    Load(Box<str>),
    /// `UnLoad`: the module of this file.
    Unload(Box<str>),
    /// `ConfL \On`, `ConfL \Off`.
    Configuration(bool),
    /// `SingArea`: how the tool turns along lines.
    Singularity(Turning),
    /// `CirPathMode`: how it turns along arcs.
    Circles(Turning),
    /// `SetDO signal,1`.
    Digital(Name, bool),
    /// `SetAO signal,0.5`.
    Analog(Name, f64),
    /// `WaitDI signal,1`.
    Input(Name, bool),
    /// `WaitTime`, seconds.
    Wait(f64),
    Message(Box<str>),
    /// `Stop`.
    Stop,
    /// `EXIT`: the end of the program.
    Exit,
    Return,
    /// `ENDPROC`.
    EndRoutine,
}

/// How a motion goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MotionKind {
    /// `MoveAbsJ`.
    AbsoluteJoints,
    /// `MoveJ`.
    Joints,
    /// `MoveL`.
    Line,
    /// `MoveC`.
    Arc,
}

/// A motion; each value has the shape of its type.
#[derive(Debug)]
pub(crate) struct Motion {
    pub(crate) kind: MotionKind,
    /// The point on the way of an arc.
    pub(crate) via: Option<Value>,
    pub(crate) to: Value,
    pub(crate) speed: Value,
    pub(crate) zone: Value,
    pub(crate) tool: Value,
    /// `None` is `wobj0`.
    pub(crate) object: Option<Value>,
}

/// What is assigned to: a name, and the places of parts in it.
#[derive(Debug)]
pub(crate) struct Target {
    pub(crate) name: Name,
    pub(crate) places: Vec<usize>,
}

/// `PERS tooldata tSpindle:=..`.
#[derive(Debug)]
pub(crate) struct Declaration {
    pub(crate) name: Name,
    pub(crate) kind: &'static str,
    pub(crate) value: Option<Value>,
    pub(crate) constant: bool,
}

/// The head of a procedure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Routine(pub(crate) Name);

impl Routine {
    /// `name ( )` behind `PROC`: without parameters.
    pub(crate) fn read(scan: &mut Scan) -> Outcome<Routine> {
        let name = own_name(scan, "the name of the procedure")?;
        scan.expect("(")?;
        match scan.take(b')') {
            true => Ok(Routine(name)),
            false => {
                let message = "procedures with parameters are not followed";
                Err(scan.since(scan.at, Rule::Unsupported, message))
            }
        }
    }
}

/// A name that is no word of the language.
pub(crate) fn own_name(scan: &mut Scan, what: &str) -> Outcome<Name> {
    let from = scan.at;
    let name = scan.needed(what)?;
    match RESERVED.contains(&name.as_str()) {
        true => {
            let message = format!("{name} is a word of RAPID: nothing may be called so");
            Err(scan.since(from, Rule::Definition, message))
        }
        false => Ok(name),
    }
}

/// A declaration behind its first word, up to its `;`.
///
/// # Errors
/// What is not understood in it.
pub(crate) fn declaration(
    scan: &mut Scan,
    variables: &dyn Readable,
    first: Name,
) -> Outcome<Declaration> {
    let from = scan.at;
    let kind = scan.needed("the type of the data")?;
    let Some(kind) = kind_of(kind) else {
        let message = format!("data of the type {kind} are not followed");
        return Err(scan.since(from, Rule::Unsupported, message));
    };
    let name = own_name(scan, "the name of the data")?;
    if scan.take(b'{') {
        let message = "arrays are not followed";
        return Err(scan.since(from, Rule::Unsupported, message));
    }
    let value = match scan.take_text(":=") {
        true => Some(read_as(scan, variables, kind)?),
        false => None,
    };
    if matches!(kind, "TOOLDATA" | "WOBJDATA") && first.as_str() != "PERS" {
        let message = format!("{first} {kind}: motions take persistent ones alone, PERS {kind}");
        return Err(scan.since(from, Rule::Definition, message));
    }
    if value.is_none() && first.as_str() != "VAR" {
        let message = format!("{first} data have a value from their declaration on");
        return Err(scan.since(from, Rule::Definition, message));
    }
    scan.expect(";")?;
    Ok(Declaration { name, kind, value, constant: first.as_str() == "CONST" })
}

/// Reads a statement with its end. Nothing is executed.
///
/// # Errors
/// What is not understood, at its place.
pub(crate) fn read(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Statement> {
    if scan.take(b'%') {
        let statement = by_name(scan)?;
        scan.expect(";")?;
        return Ok(statement);
    }
    let from = scan.at;
    let first = scan.needed("a statement, which begins with a word,")?;
    let statement = match first.as_str() {
        "LOAD" => {
            let dynamic = scan.take(b'\\');
            if !dynamic || !scan.take_word("DYNAMIC") {
                let message = "a module that is loaded without \\Dynamic is still there when the program is started anew";
                return Err(scan.since(from, Rule::Unsupported, message));
            }
            scan.expect(",")?;
            Statement::Load(path(scan, variables)?)
        }
        "UNLOAD" => Statement::Unload(path(scan, variables)?),
        "ENDPROC" => return Ok(Statement::EndRoutine),
        "CONST" | "VAR" | "PERS" => {
            return declaration(scan, variables, first).map(Statement::Declare);
        }
        "MOVEABSJ" => motion(scan, variables, MotionKind::AbsoluteJoints)?,
        "MOVEJ" => motion(scan, variables, MotionKind::Joints)?,
        "MOVEL" => motion(scan, variables, MotionKind::Line)?,
        "MOVEC" => motion(scan, variables, MotionKind::Arc)?,
        "CONFL" => Statement::Configuration(chosen(scan, &[("ON", true), ("OFF", false)])?),
        "CONFJ" => {
            chosen(scan, &[("ON", true), ("OFF", false)])?;
            Statement::Nothing
        }
        "SINGAREA" => Statement::Singularity(chosen(
            scan,
            &[("OFF", Turning::Even), ("WRIST", Turning::ByJoints)],
        )?),
        "CIRPATHMODE" => Statement::Circles(chosen(
            scan,
            &[("OBJECTFRAME", Turning::Even), ("PATHFRAME", Turning::AlongPath)],
        )?),
        "ACCSET" => {
            for number in 0..2 {
                if number > 0 {
                    scan.expect(",")?;
                }
                let percent = read_number(scan, variables)?;
                if !(20.0..=100.0).contains(&percent) {
                    let message = format!("AccSet takes 20 to 100 percent, not {percent}");
                    return Err(scan.since(from, Rule::Number, message));
                }
            }
            Statement::Nothing
        }
        "SETDO" => {
            let signal = scan.needed("the name of the signal")?;
            scan.expect(",")?;
            Statement::Digital(signal, bit(scan, variables)?)
        }
        "SETAO" => {
            let signal = scan.needed("the name of the signal")?;
            scan.expect(",")?;
            Statement::Analog(signal, read_number(scan, variables)?)
        }
        "WAITDI" => {
            let signal = scan.needed("the name of the signal")?;
            scan.expect(",")?;
            Statement::Input(signal, bit(scan, variables)?)
        }
        "WAITTIME" => match read_number(scan, variables)? {
            seconds if seconds >= 0.0 => Statement::Wait(seconds),
            _ => return Err(scan.since(from, Rule::Dwell, "a wait is not below 0 s")),
        },
        "TPWRITE" => match read_as(scan, variables, "STRING")? {
            Value::Text(text) => Statement::Message(text),
            Value::Number(_) | Value::Flag(_) | Value::List(_) => Statement::Nothing,
        },
        // The display is empty.
        "TPERASE" => Statement::Message("".into()),
        "STOP" => Statement::Stop,
        "EXIT" => Statement::Exit,
        "RETURN" => Statement::Return,
        word if REFUSED.contains(&word) => {
            let message = format!("{first} is not followed");
            let help = "control structures and motions of hand-written programs beyond MoveAbsJ, MoveJ, MoveL and MoveC are not read yet";
            return Err(Box::new(scan.since(from, Rule::Unsupported, message).help(help)));
        }
        _ => assignment_or_call(scan, variables, first, from)?,
    };
    scan.expect(";")?;
    Ok(statement)
}

/// The name in `%"procedure"%` or `%"module:procedure"%` behind its first sign.
fn by_name(scan: &mut Scan) -> Outcome<Statement> {
    if scan.peek() != Some(b'"') {
        return Err(scan.wrong("between two % the name of a procedure is followed as a text alone"));
    }
    let from = scan.at;
    let text = scan.text()?;
    scan.expect("%")?;
    let (module, routine) = match text.split_once(':') {
        Some((module, routine)) => (Some(module), routine),
        None => (None, &*text),
    };
    let name = |text: &str| {
        let mut inner = Scan::within(text.as_bytes(), BlockLocation { at: 0, line: 1 });
        let name = inner.name().ok().flatten();
        name.filter(|_| inner.at == text.len())
    };
    let wrong = || scan.since(from, Rule::Argument, format!("{text:?} is no name of a procedure"));
    let module = module.map(|module| name(module).ok_or_else(wrong)).transpose()?;
    let routine = name(routine).ok_or_else(wrong)?;
    if scan.peek() != Some(b';') {
        return Err(scan.wrong("a call by a name with arguments is not followed"));
    }
    Ok(Statement::CallByName(module, routine))
}

/// A file of the controller: `diskhome\File:="NAME.MOD"`, or one text.
fn path(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Box<str>> {
    let text = |scan: &mut Scan| match read_as(scan, variables, "STRING")? {
        Value::Text(text) => Ok(text),
        Value::Number(_) | Value::Flag(_) | Value::List(_) => {
            Err(scan.wrong("the name of a file is needed here"))
        }
    };
    let folder = text(scan)?;
    if !scan.take(b'\\') {
        return Ok(folder);
    }
    if !scan.take_word("FILE") {
        return Err(scan.wrong("of options only \\File is followed here"));
    }
    scan.expect(":=")?;
    let file = text(scan)?;
    let between = if folder.ends_with('/') { "" } else { "/" };
    Ok(format!("{folder}{between}{file}").into())
}

/// What an option such as `\On` means.
fn chosen<T: Copy>(scan: &mut Scan, entries: &[(&str, T)]) -> Outcome<T> {
    scan.expect("\\")?;
    let from = scan.at;
    let name = scan.needed("an option")?;
    let found = entries.iter().find(|(known, _)| *known == name.as_str());
    found.map(|(_, meaning)| *meaning).ok_or_else(|| {
        scan.since(from, Rule::Unsupported, format!("the option \\{name} is not followed here"))
    })
}

/// 0 or 1.
fn bit(scan: &mut Scan, variables: &dyn Readable) -> Outcome<bool> {
    let from = scan.at;
    match read_number(scan, variables)? {
        0.0 => Ok(false),
        1.0 => Ok(true),
        other => Err(scan.since(from, Rule::Number, format!("a signal is 0 or 1, not {other}"))),
    }
}

fn assignment_or_call(
    scan: &mut Scan,
    variables: &dyn Readable,
    name: Name,
    from: usize,
) -> Outcome<Statement> {
    if !matches!(scan.peek(), Some(b'.' | b':')) {
        return call(scan, variables, name);
    }
    let Some((kind, _)) = variables.value(name) else {
        return Err(scan.since(from, Rule::Variable, format!("{name} is not declared here")));
    };
    let (places, kind) = places(scan, kind)?;
    scan.expect(":=")?;
    Ok(Statement::Assign(Target { name, places }, read_as(scan, variables, kind)?))
}

fn call(scan: &mut Scan, variables: &dyn Readable, name: Name) -> Outcome<Statement> {
    let mut arguments = Vec::new();
    while scan.peek().is_some_and(|byte| byte != b';') {
        if !arguments.is_empty() {
            scan.expect(",")?;
        }
        if arguments.len() == MOST_ARGUMENTS {
            return Err(scan.wrong("more arguments than are read"));
        }
        arguments.push(value(scan, variables)?);
    }
    Ok(Statement::Call(name, arguments))
}

/// `MoveL p,v,zone,tool\WObj:=w`.
fn motion(scan: &mut Scan, variables: &dyn Readable, kind: MotionKind) -> Outcome<Statement> {
    let target = if kind == MotionKind::AbsoluteJoints { "JOINTTARGET" } else { "ROBTARGET" };
    let via = match kind {
        MotionKind::Arc => {
            let via = read_as(scan, variables, target)?;
            scan.expect(",")?;
            Some(via)
        }
        MotionKind::AbsoluteJoints | MotionKind::Joints | MotionKind::Line => None,
    };
    let to = read_as(scan, variables, target)?;
    if kind == MotionKind::AbsoluteJoints && scan.take(b'\\') && !scan.take_word("NOEOFFS") {
        return Err(scan.wrong("of options only \\NoEOffs is followed here"));
    }
    scan.expect(",")?;
    let mut speed = read_as(scan, variables, "SPEEDDATA")?;
    replaced(scan, variables, "V", (&mut speed, &[0]))?;
    scan.expect(",")?;
    let mut zone = read_as(scan, variables, "ZONEDATA")?;
    replaced(scan, variables, "Z", (&mut zone, &[1]))?;
    scan.expect(",")?;
    let tool = persistent(scan, variables, "TOOLDATA")?;
    // Both `tool,\WObj:=` and `tool\WObj:=` occur.
    scan.take(b',');
    let object = match scan.take(b'\\') {
        true => {
            if !scan.take_word("WOBJ") {
                return Err(scan.wrong("of options only \\WObj is followed here"));
            }
            scan.expect(":=")?;
            Some(persistent(scan, variables, "WOBJDATA")?)
        }
        false => None,
    };
    Ok(Statement::Motion(Box::new(Motion { kind, via, to, speed, zone, tool, object })))
}

/// `\V:=20` behind a speed and `\Z:=0.5` behind a zone: another number in place of these parts.
fn replaced(
    scan: &mut Scan,
    variables: &dyn Readable,
    word: &str,
    (record, places): (&mut Value, &[usize]),
) -> Outcome {
    if !scan.take(b'\\') {
        return Ok(());
    }
    if !scan.take_word(word) {
        return Err(scan.wrong(format!("of options only \\{word} is followed here")));
    }
    scan.expect(":=")?;
    let number = read_number(scan, variables)?;
    if let Value::List(parts) = record {
        for place in places {
            if let Some(part) = parts.get_mut(*place) {
                *part = Value::Number(number);
            }
        }
    }
    Ok(())
}

/// Data of that type by their name: a motion takes no other tool and no other work object.
fn persistent(scan: &mut Scan, variables: &dyn Readable, kind: &str) -> Outcome<Value> {
    scan.peek();
    let from = scan.at;
    let named = scan.name()?.is_some();
    scan.at = from;
    let value = value(scan, variables)?;
    match named && fits(kind, &value) {
        true => Ok(value),
        false => {
            let message = format!("the name of a {} is needed here", kind.to_lowercase());
            Err(scan.since(from, Rule::Type, message))
        }
    }
}
