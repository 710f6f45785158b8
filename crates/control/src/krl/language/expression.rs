//! Expressions: operands, and operators by the ranks of KRL (KSS, "Priority of operators").

use super::scan::Scan;
use super::value::{COORDINATES, Name, Value, coordinates, frame};
use crate::kernel::decimal;
use crate::kernel::expression::{Grammar, Next, Rank, Span, evaluate};
use program::{Diagnostic, Outcome, Rule};

/// How deep brackets, signs and aggregates may nest.
const DEEPEST: usize = 24;

/// What holds variables.
pub(crate) trait Readable {
    /// What a variable holds, by its name, its index, and its field where it is one of a structure; `None` where no block has
    /// set it.
    fn value(&self, name: Name, index: Option<i64>, field: Option<Name>) -> Option<Value>;
}

/// An operator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Operator {
    Chain,
    Times,
    Over,
    Plus,
    Minus,
    And,
    Exor,
    Or,
    Equal,
    Unequal,
    Less,
    Greater,
    LessOrEqual,
    GreaterOrEqual,
}

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

/// Takes an expression that comes to a number.
///
/// # Errors
/// What is wrong in it; it comes to something else, or to a number that is not finite.
pub(crate) fn read_number(scan: &mut Scan, variables: &dyn Readable) -> Outcome<f64> {
    scan.peek();
    let from = scan.at;
    let value = read(scan, variables)?;
    match value.number() {
        Some(number) if number.is_finite() => Ok(number),
        Some(_) => Err(scan.since(from, Rule::Number, "a number beyond all numbers")),
        None => Err(mistaken(scan, from, &value, "a number")),
    }
}

/// Takes an index in square brackets, or its empty form of a text (`[]`), where one comes next.
///
/// # Errors
/// It is no whole number.
pub(crate) fn read_index(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Option<i64>> {
    if !scan.take(b'[') {
        return Ok(None);
    }
    if scan.take(b']') {
        return Ok(None);
    }
    let from = scan.at;
    let number = read_number(scan, variables)?;
    if number.fract() != 0.0 || number.abs() > 1e6 {
        return Err(scan.since(from, Rule::Index, "an index is a whole number"));
    }
    scan.expect(b']')?;
    Ok(Some(number as i64))
}

/// The error of a value of another type than is needed.
pub(crate) fn mistaken(scan: &Scan, from: usize, value: &Value, needed: &str) -> Box<Diagnostic> {
    let message = format!("{} where {needed} is needed", value.kind());
    scan.since(from, Rule::Type, message)
}

impl Expression<'_, '_, '_> {
    /// An aggregate behind its brace: `{X 1,Y 2}`, `{FRAME: X 1}`.
    fn aggregate(&mut self) -> Outcome<Value> {
        let mut fields: Vec<(Name, Value)> = Vec::with_capacity(6);
        let before = self.scan.at;
        let typed = self.scan.name()?.is_some() && self.scan.take(b':');
        if !typed {
            self.scan.at = before;
        }
        loop {
            let from = self.scan.at;
            let Some(name) = self.scan.name()? else {
                return Err(self.scan.wrong("the name of a field is needed here"));
            };
            if self.scan.take(b'[') {
                self.scan.expect(b']')?;
            }
            if fields.iter().any(|(field, _)| *field == name) {
                let message = format!("{name} stands twice in the aggregate");
                return Err(self.scan.since(from, Rule::RepeatedWord, message));
            }
            let value = self.nested(evaluate)?;
            fields.push((name, value.in_field(name)));
            if self.scan.take(b'}') {
                return Ok(Value::Fields(fields));
            }
            self.scan.expect(b',')?;
        }
    }

    /// `'B0110'`, `'HFF'`.
    fn bits(&mut self) -> Outcome<Value> {
        let from = self.scan.at;
        self.scan.at += 1;
        let rest = self.scan.rest();
        let length = rest.iter().take_while(|byte| byte.is_ascii_alphanumeric()).count();
        let digits = std::str::from_utf8(rest.get(1..length).unwrap_or_default()).unwrap_or("");
        let radix = match rest.first().map(u8::to_ascii_uppercase) {
            Some(b'B') => 2,
            Some(b'H') => 16,
            _ => 0,
        };
        self.scan.at += length;
        let number = if radix == 0 { None } else { i32::from_str_radix(digits, radix).ok() };
        let closed = self.scan.take(b'\'');
        match number.filter(|_| closed) {
            Some(number) => Ok(Value::Integer(number)),
            None => Err(self.scan.since(
                from,
                Rule::Number,
                "a number such as 'B0110' or 'HFF' is needed",
            )),
        }
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
    fn named(&mut self, from: usize, name: Name) -> Outcome<Value> {
        match name.as_str() {
            "TRUE" => return Ok(Value::Flag(true)),
            "FALSE" => return Ok(Value::Flag(false)),
            "NOT" => {
                let value = self.nested(Self::operand)?;
                let Value::Flag(flag) = value else {
                    return Err(mistaken(self.scan, from, &value, "TRUE or FALSE"));
                };
                return Ok(Value::Flag(!flag));
            }
            _ => {}
        }
        if self.scan.peek() == Some(b'(') {
            let message = format!("the function {name} is not followed");
            return Err(self.scan.since(from, Rule::Unsupported, message));
        }
        let index = read_index(self.scan, self.variables)?;
        let field = if self.scan.take(b'.') { self.scan.name()? } else { None };
        let value = self.variables.value(name, index, field);
        value.ok_or_else(|| {
            let message = format!("no block has set {name}");
            self.scan.since(from, Rule::Variable, message)
        })
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
                    Value::Integer(number) if sign == b'-' => {
                        Ok(Value::Integer(number.wrapping_neg()))
                    }
                    Value::Number(_) | Value::Integer(_) => Ok(value),
                    other => Err(mistaken(self.scan, from, &other, "a number")),
                }
            }
            Some(b'{') => {
                self.scan.at += 1;
                self.nested(Self::aggregate)
            }
            Some(b'(') => {
                self.scan.at += 1;
                let value = self.nested(evaluate)?;
                self.scan.expect(b')')?;
                Ok(value)
            }
            Some(b'#') => {
                self.scan.at += 1;
                match self.scan.name()? {
                    Some(name) => Ok(Value::Entry(name)),
                    None => Err(self.scan.wrong("the name of an entry is needed behind #")),
                }
            }
            Some(b'\'') => self.bits(),
            Some(b'"') => self.text(),
            _ => match self.scan.name()? {
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
            (b':', _) => (Operator::Chain, 6, 1),
            (b'*', _) => (Operator::Times, 5, 1),
            (b'/', _) => (Operator::Over, 5, 1),
            (b'+', _) => (Operator::Plus, 4, 1),
            (b'-', _) => (Operator::Minus, 4, 1),
            (b'=', Some(b'=')) => (Operator::Equal, 0, 2),
            (b'<', Some(b'>')) => (Operator::Unequal, 0, 2),
            (b'<', Some(b'=')) => (Operator::LessOrEqual, 0, 2),
            (b'>', Some(b'=')) => (Operator::GreaterOrEqual, 0, 2),
            (b'<', _) => (Operator::Less, 0, 1),
            (b'>', _) => (Operator::Greater, 0, 1),
            _ => return self.logical(at),
        };
        self.scan.at += length;
        Some(Next { operator, rank: Rank::Left(rank), at })
    }

    fn apply(&mut self, operator: Operator, [a, b]: [Value; 2], span: Span) -> Outcome<Value> {
        let refused = |message: String| {
            Err(self.scan.source.error(Rule::Type, span.start..span.end, message))
        };
        if operator == Operator::Chain {
            return match (whole_frame(&a), whole_frame(&b)) {
                (Some(a), Some(b)) => Ok(fields(&(frame(a) * frame(b)))),
                _ => refused(String::from("`:` chains two frames of X, Y, Z, A, B, C")),
            };
        }
        if let (Some(x), Some(y)) = (a.number(), b.number()) {
            let value = match (&a, &b) {
                (Value::Integer(a), Value::Integer(b)) => calculated_whole(operator, *a, *b),
                _ => calculated(operator, x, y),
            };
            return value.ok_or_else(|| {
                let message = "the operator has no result for these numbers";
                self.scan.source.error(Rule::Arithmetic, span.start..span.end, message)
            });
        }
        match (a, b) {
            (Value::Flag(a), Value::Flag(b)) => match operator {
                Operator::And => Ok(Value::Flag(a && b)),
                Operator::Or => Ok(Value::Flag(a || b)),
                Operator::Exor | Operator::Unequal => Ok(Value::Flag(a != b)),
                Operator::Equal => Ok(Value::Flag(a == b)),
                _ => refused(String::from("TRUE and FALSE have no such operator")),
            },
            (a, b) => refused(format!("{} and {} have no such operator", a.kind(), b.kind())),
        }
    }
}

impl Expression<'_, '_, '_> {
    /// `AND`, `OR`, `EXOR`.
    fn logical(&mut self, at: usize) -> Option<Next<Operator>> {
        let name = self.scan.name().ok().flatten();
        let found = name.and_then(|name| match name.as_str() {
            "AND" => Some((Operator::And, 3)),
            "EXOR" => Some((Operator::Exor, 2)),
            "OR" => Some((Operator::Or, 1)),
            _ => None,
        });
        if found.is_none() {
            self.scan.at = at;
        }
        found.map(|(operator, rank)| Next { operator, rank: Rank::Left(rank), at })
    }
}

/// A decimal, with the power of ten that KRL allows (`1.5E-3`).
fn number(scan: &mut Scan) -> Outcome<Value> {
    let from = scan.at;
    let Some(read) = decimal::parse(scan.rest()) else {
        return Err(scan.wrong("a number is needed here"));
    };
    scan.at += read.len;
    if !matches!(scan.rest().first(), Some(b'e' | b'E')) {
        let digits = &scan.source.text[from..scan.at];
        if digits.contains(&b'.') {
            return Ok(Value::Number(read.value));
        }
        let whole = std::str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok());
        return whole.map(Value::Integer).ok_or_else(|| {
            let message = "a whole number is at most 2147483647";
            scan.since(from, Rule::Number, message)
        });
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

/// Of two INT the result is one: a division is cut off towards 0.
fn calculated_whole(operator: Operator, a: i32, b: i32) -> Option<Value> {
    let whole = match operator {
        Operator::Times => a.checked_mul(b),
        Operator::Over => a.checked_div(b),
        Operator::Plus => a.checked_add(b),
        Operator::Minus => a.checked_sub(b),
        Operator::Equal
        | Operator::Unequal
        | Operator::Less
        | Operator::Greater
        | Operator::LessOrEqual
        | Operator::GreaterOrEqual
        | Operator::Chain
        | Operator::And
        | Operator::Exor
        | Operator::Or => return calculated(operator, f64::from(a), f64::from(b)),
    };
    whole.map(Value::Integer)
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
        Operator::Chain | Operator::And | Operator::Exor | Operator::Or => None,
    }
}

/// The six numbers of a frame all of which are there.
pub(crate) fn whole_frame(value: &Value) -> Option<[f64; 6]> {
    let mut all = [0.0; 6];
    for (number, name) in all.iter_mut().zip(COORDINATES) {
        *number = value.field(name)?;
    }
    Some(all)
}

/// A frame as an aggregate.
fn fields(frame: &geom::Frame) -> Value {
    let named = COORDINATES.iter().filter_map(|name| Name::of(name.as_bytes()));
    Value::Fields(named.zip(coordinates(frame).map(Value::Number)).collect())
}
