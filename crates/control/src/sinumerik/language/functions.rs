//! The functions of expressions (Job Planning 12/2019, 3.1.2 and 3.1.4). Angles are degrees; the first
//! character of a text has index 0.

use super::axis;
use super::value::Value;

/// Most arguments of a function.
pub(super) const MOST_ARGUMENTS: usize = 3;

/// A function.
pub(super) type Function = fn(&[Value]) -> Result<Value, String>;

/// The function of that name.
pub(super) fn named(name: &str) -> Option<Function> {
    Some(match name {
        "SIN" => |a| real(a, |x| x.to_radians().sin()),
        "COS" => |a| real(a, |x| x.to_radians().cos()),
        "TAN" => |a| real(a, |x| x.to_radians().tan()),
        "ASIN" => |a| real(a, |x| x.asin().to_degrees()),
        "ACOS" => |a| real(a, |x| x.acos().to_degrees()),
        "ATAN2" => |a| {
            let [y, x] = numbers(a)?;
            Ok(Value::Real(y.atan2(x).to_degrees()))
        },
        "SQRT" => |a| real(a, f64::sqrt),
        "ABS" => |a| match a {
            [Value::Int(whole)] => Ok(Value::Int(whole.saturating_abs())),
            _ => real(a, f64::abs),
        },
        "POT" => |a| real(a, |x| x * x),
        "TRUNC" => |a| real(a, f64::trunc),
        "ROUND" => |a| real(a, f64::round),
        "ROUNDUP" => |a| real(a, f64::ceil),
        "LN" => |a| real(a, f64::ln),
        "EXP" => |a| real(a, f64::exp),
        "MINVAL" => |a| numbers(a).map(|[x, y]| Value::Real(x.min(y))),
        "MAXVAL" => |a| numbers(a).map(|[x, y]| Value::Real(x.max(y))),
        "BOUND" => |a| {
            let [low, high, value] = numbers(a)?;
            if low > high {
                return Err(format!("the lower limit {low} is above the upper one {high}"));
            }
            Ok(Value::Real(value.clamp(low, high)))
        },
        "ISNUMBER" => |a| Ok(Value::Bool(as_number(text(one(a)?)?).is_some())),
        "NUMBER" => |a| {
            let text = text(one(a)?)?;
            as_number(text).map(Value::Real).ok_or_else(|| format!("'{text}' is no number"))
        },
        "STRLEN" => |a| Ok(Value::Int(text(one(a)?)?.chars().count() as i64)),
        "TOUPPER" => |a| Ok(Value::text(text(one(a)?)?.to_ascii_uppercase())),
        "TOLOWER" => |a| Ok(Value::text(text(one(a)?)?.to_ascii_lowercase())),
        "INDEX" => |a| find(a, |text, wanted| text.find(wanted)),
        "RINDEX" => |a| find(a, |text, wanted| text.rfind(wanted)),
        "SUBSTR" => substring,
        "AXNAME" => |a| {
            let name = text(one(a)?)?;
            axis::axis(&name.to_ascii_uppercase())
                .map(Value::Axis)
                .ok_or_else(|| format!("there is no axis {name}"))
        },
        "AXSTRING" => |a| match one(a)? {
            Value::Axis(axis) => Ok(Value::text(axis::axis_name(*axis))),
            other => Err(format!("{} is no axis", other.name())),
        },
        _ => return None,
    })
}

fn one(arguments: &[Value]) -> Result<&Value, String> {
    match arguments {
        [value] => Ok(value),
        _ => Err(String::from("it takes one argument")),
    }
}

fn numbers<const N: usize>(arguments: &[Value]) -> Result<[f64; N], String> {
    let mut numbers = [0.0; N];
    if arguments.len() != N {
        return Err(format!("it takes {N} arguments"));
    }
    for (number, value) in numbers.iter_mut().zip(arguments) {
        *number = value.number().ok_or_else(|| format!("{} is no number", value.name()))?;
    }
    Ok(numbers)
}

fn real(arguments: &[Value], function: fn(f64) -> f64) -> Result<Value, String> {
    numbers(arguments).map(|[x]| Value::Real(function(x)))
}

fn text(value: &Value) -> Result<&str, String> {
    match value {
        Value::Text(text) => Ok(text),
        other => Err(format!("{} is no text", other.name())),
    }
}

/// The number that a text is, as a block would write it.
fn as_number(text: &str) -> Option<f64> {
    let text = text.trim().to_ascii_uppercase();
    let (mantissa, exponent) = text.split_once("EX").unwrap_or((&text, "0"));
    let decimal = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.');
    if !mantissa.bytes().chain(exponent.bytes()).all(decimal) {
        return None;
    }
    format!("{mantissa}E{exponent}").parse().ok().filter(|value: &f64| value.is_finite())
}

/// Where a character stands in a text; -1 where it does not.
fn find(arguments: &[Value], find: fn(&str, char) -> Option<usize>) -> Result<Value, String> {
    let [within, wanted] = arguments else {
        return Err(String::from("it takes a text and a character"));
    };
    let wanted = match wanted {
        Value::Char(byte) => char::from(*byte),
        Value::Text(text) if text.chars().count() == 1 => text.chars().next().unwrap_or(' '),
        other => return Err(format!("{} is not one character", other.name())),
    };
    let within = text(within)?;
    let place = find(within, wanted).and_then(|byte| within.get(..byte));
    Ok(Value::Int(place.map_or(-1, |before| before.chars().count() as i64)))
}

/// `SUBSTR(text, from)`, `SUBSTR(text, from, length)`.
fn substring(arguments: &[Value]) -> Result<Value, String> {
    let (within, from, length) = match arguments {
        [within, from] => (within, from, None),
        [within, from, length] => (within, from, Some(length)),
        _ => return Err(String::from("it takes a text, a place and perhaps a length")),
    };
    let count = |value: &Value| match value.number() {
        Some(number) if number >= 0.0 && number.fract() == 0.0 => Ok(number as usize),
        _ => Err(String::from("place and length are whole numbers from 0")),
    };
    let within = text(within)?;
    let from = count(from)?;
    if from > within.chars().count() {
        return Err(format!("'{within}' has no character {from}"));
    }
    let length = length.map(count).transpose()?.unwrap_or(usize::MAX);
    Ok(Value::text(within.chars().skip(from).take(length).collect::<String>()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_measured_searched_and_cut() {
        let call = |name: &str, arguments: &[Value]| named(name).unwrap()(arguments);
        let text = |text: &str| Value::text(text);
        assert_eq!(call("STRLEN", &[text("otto")]), Ok(Value::Int(4)));
        assert_eq!(call("INDEX", &[text("CONTROL"), text("O")]), Ok(Value::Int(1)));
        assert_eq!(call("RINDEX", &[text("CONTROL"), text("O")]), Ok(Value::Int(5)));
        assert_eq!(call("INDEX", &[text("CONTROL"), text("X")]), Ok(Value::Int(-1)));
        let cut = call("SUBSTR", &[text("ALARM: 12"), Value::Int(7), Value::Int(2)]);
        assert_eq!(cut, Ok(text("12")));
        assert_eq!(call("NUMBER", &[text("-1.5EX2")]), Ok(Value::Real(-150.0)));
        assert_eq!(call("ISNUMBER", &[text("1234inf")]), Ok(Value::Bool(false)));
        assert!(call("BOUND", &[Value::Int(2), Value::Int(1), Value::Int(0)]).is_err());
        assert!(call("SIN", &[]).is_err() && named("SINUS").is_none());
    }
}
