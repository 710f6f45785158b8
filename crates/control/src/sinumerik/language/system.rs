//! System variables (`$...`): those whose value the program itself gives or the operator has said.

use super::expression::{Evaluator, without_offset};
use super::scan::Scanner;
use super::value::Value;
use super::variables::{AssignmentTarget, Readable};
use crate::kernel::Outcome;
use program::{Diagnostic, Feed, Rule};

/// Takes a system variable and gives its value.
pub(super) fn read(
    evaluator: &Evaluator,
    state: &dyn Readable,
    scanner: &mut Scanner,
) -> Outcome<Value> {
    let start = scanner.at;
    scanner.at += 1;
    let name = scanner.name()?;
    let lengths = ["AA_IW", "AA_IM", "P_EP", "P_PFRAME", "P_UIFR", "P_F"];
    if !state.counts_plainly() && lengths.contains(&name.as_str()) {
        let message =
            format!("${} while inches or diameters are programmed is not supported", name.as_str());
        return Err(scanner.error_since(start, Rule::Unsupported, message));
    }
    let unknown = |scanner: &Scanner, what: &str| {
        scanner.error_since(start, Rule::UnknownPosition, format!("{what} is not known here"))
    };
    let known = |scanner: &Scanner, value: f64, what: &str| {
        if value.is_nan() { Err(unknown(scanner, what)) } else { Ok(Value::Real(value)) }
    };
    match name.as_str() {
        "R" => {
            let index = evaluator.index(scanner)?;
            let found = evaluator.parameter_value(scanner, start, index)?;
            without_offset(scanner, start, found)
        }
        "PI" => Ok(Value::Real(std::f64::consts::PI)),
        // Program and machine run in automatic mode, from the start.
        "P_SEARCH" | "P_ISTEST" | "P_SIM" | "P_DRYRUN" => Ok(Value::Bool(false)),
        "AA_IW" | "P_EP" => {
            let axis = axis_in_brackets(evaluator, scanner)?;
            known(scanner, state.position_of(axis), "where that axis stands")
        }
        "AA_IM" => {
            let axis = axis_in_brackets(evaluator, scanner)?;
            let value = state.machine_position_of(axis);
            if value.is_nan() {
                let mut error = unknown(scanner, "where that axis stands in machine coordinates");
                error.help =
                    "it takes the place where the tool starts (with all offsets at 0) and \
                              a tool without length"
                        .into();
                return Err(error);
            }
            Ok(Value::Real(value))
        }
        "P_PFRAME" => {
            let axis = frame_component(evaluator, scanner, false)?.1;
            known(scanner, state.translation(axis), "the frame")
        }
        "P_UIFR" => {
            let (number, axis) = frame_component(evaluator, scanner, true)?;
            known(scanner, state.work_offset(number, axis), "the value of that work offset")
        }
        "P_F" => match state.active_feed() {
            Some(Feed::PerMinute(value) | Feed::PerTurn(value) | Feed::InverseTime(value)) => {
                Ok(Value::Real(value))
            }
            None => Err(unknown(scanner, "the feed")),
        },
        "P_TOOL" if !state.edge_is_known() => Err(unknown(scanner, "the edge of the tool")),
        "P_TOOL" => Ok(Value::Int(i64::from(state.edge().unwrap_or(0)))),
        "P_TOOLNO" => match state.tool_number() {
            Some(number) => Ok(Value::Int(i64::from(number))),
            None => Err(unknown(scanner, "the number of the tool")),
        },
        _ => Err(not_known(scanner, start, name.as_str())),
    }
}

/// Takes the system variable that is assigned to.
pub(super) fn place(evaluator: &Evaluator, scanner: &mut Scanner) -> Outcome<AssignmentTarget> {
    let start = scanner.at;
    scanner.at += 1;
    let name = scanner.name()?;
    match name.as_str() {
        "R" => evaluator.index(scanner).map(AssignmentTarget::Parameter),
        "P_UIFR" => {
            let (number, axis) = frame_component(evaluator, scanner, true)?;
            Ok(AssignmentTarget::WorkOffset(number, axis))
        }
        _ => Err(not_known(scanner, start, name.as_str())),
    }
}

#[cold]
fn not_known(scanner: &Scanner, start: usize, name: &str) -> Box<Diagnostic> {
    let message = if name.starts_with('M') || name.starts_with("SC") || name.starts_with("SN") {
        format!("${name} is machine data, which are the machine's and not known here")
    } else if name.starts_with("TC_") {
        format!("${name} belongs to the control's tool table, which a program may not change here")
    } else {
        format!("${name} is a system variable whose value is not known here")
    };
    scanner.error_since(start, Rule::Unsupported, message)
}

/// `[X]`.
fn axis_in_brackets(evaluator: &Evaluator, scanner: &mut Scanner) -> Outcome<usize> {
    scanner.expect(b'[')?;
    let axis = take_axis(evaluator, scanner)?;
    scanner.expect(b']')?;
    Ok(axis)
}

fn take_axis(evaluator: &Evaluator, scanner: &mut Scanner) -> Outcome<usize> {
    scanner.blanks();
    let start = scanner.at;
    match evaluator.value(scanner)? {
        Value::Axis(axis) => Ok(axis),
        other => {
            let message = format!("an axis must stand here, not {}", other.name());
            Err(scanner.error_since(start, Rule::Type, message))
        }
    }
}

/// `[n,X,TR]` or `[X,TR]`: the number of the work offset (of its `G` command) and the axis.
fn frame_component(
    evaluator: &Evaluator,
    scanner: &mut Scanner,
    numbered: bool,
) -> Outcome<(u32, usize)> {
    scanner.expect(b'[')?;
    let mut number = 0;
    if numbered {
        number = match evaluator.within(scanner, 0..=99)? {
            index @ 1..=4 => 53 + index,
            index => 500 + index,
        };
        scanner.expect(b',')?;
    }
    scanner.blanks();
    let start = scanner.at;
    let axis = take_axis(evaluator, scanner)?;
    if axis > 2 {
        let message = "the offset of a rotary axis is not supported";
        return Err(scanner.error_since(start, Rule::Unsupported, message));
    }
    scanner.expect(b',')?;
    if !scanner.take_word("TR") {
        let message = "of a frame the translation (TR) is supported, not its other components";
        return Err(scanner.error_here(Rule::Unsupported, message));
    }
    scanner.expect(b']')?;
    Ok((number, axis))
}
