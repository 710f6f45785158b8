//! Expressions: operands, and operators by their ranks (those of Python, as far as the manual shows them).

use super::scan::Scan;
use super::value::{Value, frame, pose};
use crate::kernel::decimal;
use crate::kernel::expression::{Grammar, Next, Rank, Span, evaluate};
use program::{Diagnostic, Outcome, Rule};

/// How deep brackets, signs and calls may nest.
const DEEPEST: usize = 24;

/// Most arguments of a call.
const MOST_ARGUMENTS: usize = 16;

/// What holds variables.
pub(crate) trait Readable {
    /// What a variable holds; `None` where no line has set it.
    fn value(&self, name: &str) -> Option<Value>;
}

/// An operator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Operator {
    Times,
    Over,
    Plus,
    Minus,
    And,
    Xor,
    Or,
    Equal,
    Unequal,
    Less,
    Greater,
    LessOrEqual,
    GreaterOrEqual,
}

/// An argument of a call: by its place, or by its name (`a=1.2`).
#[derive(Clone, Debug)]
pub(crate) struct Argument<'t> {
    pub(crate) name: Option<&'t str>,
    pub(crate) value: Value,
}

/// The arguments of a call.
pub(crate) type Arguments<'t> = Vec<Argument<'t>>;

/// An expression in a line.
pub(crate) struct Expression<'s, 't, 'v> {
    pub(crate) scan: &'s mut Scan<'t>,
    pub(crate) variables: &'v dyn Readable,
}

/// Takes an expression.
///
/// # Errors
/// What is wrong in it.
pub(crate) fn read(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Value> {
    evaluate(&mut Expression { scan, variables })
}

/// Takes the arguments of a call behind its opening bracket.
///
/// # Errors
/// What is wrong in them.
pub(crate) fn arguments<'t>(
    scan: &mut Scan<'t>,
    variables: &dyn Readable,
) -> Outcome<Arguments<'t>> {
    let mut all: Arguments = Vec::new();
    while !scan.take(b')') {
        if !all.is_empty() {
            scan.expect(b',')?;
        }
        if all.len() == MOST_ARGUMENTS {
            return Err(scan.wrong("more arguments than are read"));
        }
        let before = scan.at;
        let name = scan.name().filter(|_| {
            scan.peek() == Some(b'=') && scan.rest().get(1).is_none_or(|byte| *byte != b'=')
        });
        match name {
            Some(name) => {
                if all.iter().any(|argument| argument.name == Some(name)) {
                    let message = format!("the argument {name} stands twice");
                    return Err(scan.since(before, Rule::RepeatedWord, message));
                }
                scan.expect(b'=')?;
            }
            None => {
                scan.at = before;
                if all.last().is_some_and(|argument| argument.name.is_some()) {
                    return Err(
                        scan.wrong("an argument without a name stands behind one with a name")
                    );
                }
            }
        }
        let value = read(scan, variables)?;
        all.push(Argument { name, value });
    }
    Ok(all)
}

/// The error of a value of another type than is needed.
pub(crate) fn mistaken(scan: &Scan, from: usize, value: &Value, needed: &str) -> Box<Diagnostic> {
    let message = format!("{} where {needed} is needed", value.kind());
    scan.since(from, Rule::Type, message)
}

impl Expression<'_, '_, '_> {
    /// A list behind its bracket.
    fn list(&mut self) -> Outcome<Vec<Value>> {
        let mut all = Vec::with_capacity(6);
        while !self.scan.take(b']') {
            if !all.is_empty() {
                self.scan.expect(b',')?;
            }
            all.push(self.nested(evaluate)?);
        }
        Ok(all)
    }

    fn text(&mut self) -> Outcome<Value> {
        let from = self.scan.at;
        let rest = self.scan.rest().get(1..).unwrap_or_default();
        let Some(length) = rest.iter().position(|byte| *byte == b'"') else {
            return Err(self.scan.since(from, Rule::Syntax, "the text has no end"));
        };
        self.scan.at += length + 2;
        Ok(Value::Text(String::from_utf8_lossy(&rest[..length]).into()))
    }

    /// What a name stands for.
    fn named(&mut self, from: usize, name: &str) -> Outcome<Value> {
        match name {
            "True" | "TRUE" => return Ok(Value::Flag(true)),
            "False" | "FALSE" => return Ok(Value::Flag(false)),
            "not" => {
                let value = self.nested(Self::operand)?;
                let Value::Flag(flag) = value else {
                    return Err(mistaken(self.scan, from, &value, "True or False"));
                };
                return Ok(Value::Flag(!flag));
            }
            "p" if self.scan.rest().first() == Some(&b'[') => {
                self.scan.at += 1;
                let list = Value::List(self.nested(Self::list)?);
                return match list.numbers::<6>() {
                    Some(numbers) => Ok(Value::Pose(numbers)),
                    None => Err(self.scan.since(from, Rule::Type, "a pose has six numbers")),
                };
            }
            _ => {}
        }
        if self.scan.take(b'(') {
            let variables = self.variables;
            let arguments = self.nested(|own| arguments(own.scan, variables))?;
            return function(self.scan, from, name, &arguments);
        }
        let value = self.variables.value(name).ok_or_else(|| {
            let message = format!("no line has set {name}");
            self.scan.since(from, Rule::Variable, message)
        })?;
        if self.scan.take(b'[') {
            return self.element(from, &value);
        }
        Ok(value)
    }

    /// An element of a list or of a pose, from 0.
    fn element(&mut self, from: usize, of: &Value) -> Outcome<Value> {
        let index = self.nested(evaluate)?;
        self.scan.expect(b']')?;
        let index = match index {
            Value::Number(index) if index >= 0.0 && index.fract() == 0.0 => index as usize,
            _ => {
                return Err(self.scan.since(
                    from,
                    Rule::Index,
                    "an index is a whole number from 0",
                ));
            }
        };
        let found = match of {
            Value::List(list) => list.get(index).cloned(),
            Value::Pose(pose) => pose.get(index).map(|number| Value::Number(*number)),
            Value::Number(_) | Value::Flag(_) | Value::Text(_) => {
                return Err(mistaken(self.scan, from, of, "a list or a pose"));
            }
        };
        found.ok_or_else(|| self.scan.since(from, Rule::Index, "there is no such element"))
    }
}

/// A function of the language that gives a value.
fn function(scan: &Scan, from: usize, name: &str, arguments: &[Argument]) -> Outcome<Value> {
    let values: Vec<&Value> = arguments.iter().map(|argument| &argument.value).collect();
    match (name, &values[..]) {
        ("pose_trans", [Value::Pose(a), Value::Pose(b)]) => {
            Ok(Value::Pose(pose(&(frame(*a) * frame(*b)))))
        }
        ("pose_inv", [Value::Pose(a)]) => Ok(Value::Pose(pose(&frame(*a).inverse()))),
        ("d2r", [Value::Number(degrees)]) => Ok(Value::Number(degrees.to_radians())),
        ("r2d", [Value::Number(radians)]) => Ok(Value::Number(radians.to_degrees())),
        ("pose_trans" | "pose_inv" | "d2r" | "r2d", _) => {
            Err(scan.since(from, Rule::Argument, format!("these are no arguments of {name}")))
        }
        _ => {
            let message = format!("the function {name} is not followed");
            Err(scan.since(from, Rule::Unsupported, message))
        }
    }
}

impl Grammar for Expression<'_, '_, '_> {
    type Value = Value;
    type Operator = Operator;
    type Error = Box<Diagnostic>;
    const DEEPEST: usize = DEEPEST;

    fn depth(&mut self) -> &mut usize {
        &mut self.scan.depth
    }

    fn too_deep(&mut self) -> Box<Diagnostic> {
        self.scan.wrong("brackets and signs nest too deep")
    }

    fn start(&mut self) -> usize {
        self.scan.peek();
        self.scan.at
    }

    fn end(&self) -> usize {
        self.scan.at
    }

    fn operand(&mut self) -> Outcome<Value> {
        let next = self.scan.peek();
        let from = self.scan.at;
        match next {
            Some(b'0'..=b'9' | b'.') => number(self.scan),
            Some(sign @ (b'-' | b'+')) => {
                self.scan.at += 1;
                let value = self.nested(Self::operand)?;
                match value {
                    Value::Number(number) if sign == b'-' => Ok(Value::Number(-number)),
                    Value::Number(_) => Ok(value),
                    other => Err(mistaken(self.scan, from, &other, "a number")),
                }
            }
            Some(b'[') => {
                self.scan.at += 1;
                Ok(Value::List(self.nested(Self::list)?))
            }
            Some(b'(') => {
                self.scan.at += 1;
                let value = self.nested(evaluate)?;
                self.scan.expect(b')')?;
                Ok(value)
            }
            Some(b'"') => self.text(),
            _ => match self.scan.name() {
                Some(name) => self.named(from, name),
                None => Err(self.scan.wrong("a value is needed here")),
            },
        }
    }

    fn operator(&mut self) -> Option<Next<Operator>> {
        let first = self.scan.peek()?;
        let at = self.scan.at;
        let second = self.scan.rest().get(1).copied();
        let (operator, rank, length) = match (first, second) {
            (b'*', _) => (Operator::Times, 5, 1),
            (b'/', _) => (Operator::Over, 5, 1),
            (b'+', _) => (Operator::Plus, 4, 1),
            (b'-', _) => (Operator::Minus, 4, 1),
            (b'=', Some(b'=')) => (Operator::Equal, 3, 2),
            (b'!', Some(b'=')) => (Operator::Unequal, 3, 2),
            (b'<', Some(b'=')) => (Operator::LessOrEqual, 3, 2),
            (b'>', Some(b'=')) => (Operator::GreaterOrEqual, 3, 2),
            (b'<', _) => (Operator::Less, 3, 1),
            (b'>', _) => (Operator::Greater, 3, 1),
            _ => return self.logical(at),
        };
        self.scan.at += length;
        Some(Next { operator, rank: Rank::Left(rank), at })
    }

    fn apply(&mut self, operator: Operator, [a, b]: [Value; 2], span: Span) -> Outcome<Value> {
        let refused = |rule: Rule, message: String| {
            Err(self.scan.source.error(rule, span.start..span.end, message))
        };
        match (a, b) {
            (Value::Number(a), Value::Number(b)) => {
                if operator == Operator::Over
                    && a % b != 0.0
                    && a.fract() == 0.0
                    && b.fract() == 0.0
                {
                    let message = "whether a quotient of whole numbers is cut to a whole number is not known here: write what it comes to";
                    return refused(Rule::Arithmetic, message.into());
                }
                match calculated(operator, a, b) {
                    Some(value) => Ok(value),
                    None => refused(
                        Rule::Arithmetic,
                        String::from("the operator has no result for these numbers"),
                    ),
                }
            }
            (Value::Flag(a), Value::Flag(b)) => match operator {
                Operator::And => Ok(Value::Flag(a && b)),
                Operator::Or => Ok(Value::Flag(a || b)),
                Operator::Xor | Operator::Unequal => Ok(Value::Flag(a != b)),
                Operator::Equal => Ok(Value::Flag(a == b)),
                _ => refused(Rule::Type, String::from("True and False have no such operator")),
            },
            (a, b) => {
                refused(Rule::Type, format!("{} and {} have no such operator", a.kind(), b.kind()))
            }
        }
    }
}

impl Expression<'_, '_, '_> {
    /// `and`, `xor`, `or`.
    fn logical(&mut self, at: usize) -> Option<Next<Operator>> {
        let found = match self.scan.name() {
            Some("and") => Some((Operator::And, 2)),
            Some("xor") => Some((Operator::Xor, 1)),
            Some("or") => Some((Operator::Or, 0)),
            _ => None,
        };
        if found.is_none() {
            self.scan.at = at;
        }
        found.map(|(operator, rank)| Next { operator, rank: Rank::Left(rank), at })
    }
}

/// A decimal, with a power of ten (`1.5e-3`).
fn number(scan: &mut Scan) -> Outcome<Value> {
    let from = scan.at;
    let Some(read) = decimal::parse(scan.rest()) else {
        return Err(scan.wrong("a number is needed here"));
    };
    scan.at += read.len;
    if !matches!(scan.rest().first(), Some(b'e' | b'E')) {
        return Ok(Value::Number(read.value));
    }
    let rest = scan.rest().get(1..).unwrap_or_default();
    let sign = usize::from(matches!(rest.first(), Some(b'+' | b'-')));
    let digits = rest.iter().skip(sign).take_while(|byte| byte.is_ascii_digit()).count();
    scan.at += 1 + sign + digits;
    let text = std::str::from_utf8(&scan.source.text[from..scan.at]).unwrap_or_default();
    match text.parse::<f64>().ok().filter(|number| digits > 0 && number.is_finite()) {
        Some(number) => Ok(Value::Number(number)),
        None => Err(scan.since(from, Rule::Number, "this is no number")),
    }
}

fn calculated(operator: Operator, a: f64, b: f64) -> Option<Value> {
    let number = |value: f64| value.is_finite().then_some(Value::Number(value));
    match operator {
        Operator::Times => number(a * b),
        Operator::Over => number(a / b),
        Operator::Plus => number(a + b),
        Operator::Minus => number(a - b),
        Operator::Equal => Some(Value::Flag(a == b)),
        Operator::Unequal => Some(Value::Flag(a != b)),
        Operator::Less => Some(Value::Flag(a < b)),
        Operator::Greater => Some(Value::Flag(a > b)),
        Operator::LessOrEqual => Some(Value::Flag(a <= b)),
        Operator::GreaterOrEqual => Some(Value::Flag(a >= b)),
        Operator::And | Operator::Xor | Operator::Or => None,
    }
}
