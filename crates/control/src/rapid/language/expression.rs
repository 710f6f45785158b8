//! Expressions: operands, and operators by the ranks of RAPID ("Expressions", priority between operators).

use super::records::{fits, part, predefined};
use super::scan::Scan;
use super::value::{Name, Value, frame};
use crate::kernel::decimal;
use crate::kernel::expression::{Grammar, Next, Rank, Span, evaluate};
use geom::{Frame, Mat3, Quat, Vec3};
use program::{Diagnostic, Outcome, Rule};

/// How deep brackets, signs and aggregates may nest.
const DEEPEST: usize = 24;

/// Most parts of an aggregate.
const MOST_PARTS: usize = 64;

/// What holds data.
pub(crate) trait Readable {
    /// The type of a name and its value, which is `None` where no statement has set it; `None` where nothing is declared by it.
    fn value(&self, name: Name) -> Option<(&'static str, Option<&Value>)>;
}

/// An operator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Operator {
    Times,
    Over,
    Div,
    Mod,
    Plus,
    Minus,
    And,
    Or,
    Xor,
    Equal,
    Unequal,
    Less,
    Greater,
    LessOrEqual,
    GreaterOrEqual,
}

/// An expression in a statement.
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

/// Takes an expression of that type.
///
/// # Errors
/// What is wrong in it, or it is of another.
pub(crate) fn read_as(scan: &mut Scan, variables: &dyn Readable, kind: &str) -> Outcome<Value> {
    scan.peek();
    let from = scan.at;
    let value = read(scan, variables)?;
    match fits(kind, &value) {
        true => Ok(value),
        false => {
            let message = format!("{} where a {} is needed", value.kind(), kind.to_lowercase());
            Err(scan.since(from, Rule::Type, message))
        }
    }
}

/// Takes an expression that comes to a number.
///
/// # Errors
/// As [`read_as`].
pub(crate) fn read_number(scan: &mut Scan, variables: &dyn Readable) -> Outcome<f64> {
    Ok(read_as(scan, variables, "NUM")?.number().unwrap_or(f64::NAN))
}

/// The parts behind a name (`.trans.z`): their places, and the type of the last.
///
/// # Errors
/// The type has no such part.
pub(super) fn places(scan: &mut Scan, kind: &'static str) -> Outcome<(Vec<usize>, &'static str)> {
    let (mut places, mut kind) = (Vec::new(), kind);
    while scan.take(b'.') {
        let from = scan.at;
        let name = scan.needed("the name of a part")?;
        let Some((place, inner)) = part(kind, name.as_str()) else {
            let message = format!("a {} has no part {name}", kind.to_lowercase());
            return Err(scan.since(from, Rule::Type, message));
        };
        places.push(place);
        kind = inner;
    }
    Ok((places, kind))
}

impl Expression<'_, '_, '_> {
    /// An aggregate behind its bracket: `[1,2,3]`.
    fn aggregate(&mut self) -> Outcome<Value> {
        let mut parts = Vec::with_capacity(4);
        loop {
            if parts.len() == MOST_PARTS {
                return Err(self.scan.wrong("more parts than any record has"));
            }
            parts.push(evaluate(self)?);
            if self.scan.take(b']') {
                return Ok(Value::List(parts));
            }
            self.scan.expect(b',')?;
        }
    }

    /// What a name stands for.
    fn named(&mut self, from: usize, name: Name) -> Outcome<Value> {
        match name.as_str() {
            "TRUE" => return Ok(Value::Flag(true)),
            "FALSE" => return Ok(Value::Flag(false)),
            "NOT" => {
                let value = self.nested(Self::operand)?;
                return match value {
                    Value::Flag(flag) => Ok(Value::Flag(!flag)),
                    other => Err(self.not_a(from, &other, "TRUE or FALSE")),
                };
            }
            _ => {}
        }
        if self.scan.take(b'(') {
            let value = self.nested(|this| this.function(from, name))?;
            self.scan.expect(b')')?;
            return Ok(value);
        }
        let own = self.variables.value(name);
        let (kind, value) = match own {
            Some((kind, Some(value))) => (kind, value.clone()),
            Some((_, None)) => {
                let message = format!("no statement has set {name}");
                return Err(self.scan.since(from, Rule::Variable, message));
            }
            None => predefined(name).ok_or_else(|| {
                let message = format!("{name} is not declared here");
                self.scan.since(from, Rule::Variable, message)
            })?,
        };
        let (places, _) = places(self.scan, kind)?;
        let found = places.iter().try_fold(&value, |value, place| value.parts().get(*place));
        found.cloned().ok_or_else(|| self.scan.since(from, Rule::Type, "it has no such part"))
    }

    /// A function behind its bracket, up to the closing one.
    fn function(&mut self, from: usize, name: Name) -> Outcome<Value> {
        match name.as_str() {
            "OFFS" => {
                let target = read_as(self.scan, self.variables, "ROBTARGET")?;
                let by = self.three()?;
                Ok(moved(&target, |frame| {
                    Frame::from_mat3_translation(frame.matrix3, frame.translation + by)
                })
                .map_err(|message| self.scan.since(from, Rule::Frame, message))?)
            }
            "RELTOOL" => {
                let target = read_as(self.scan, self.variables, "ROBTARGET")?;
                let by = self.three()?;
                let [x, y, z] = self.turns()?;
                // The displacement first, then the turns about the new X, Y and Z.
                let turn =
                    Mat3::from_rotation_x(x) * Mat3::from_rotation_y(y) * Mat3::from_rotation_z(z);
                let own = Frame::from_mat3_translation(turn, by);
                Ok(moved(&target, |frame| frame * own)
                    .map_err(|message| self.scan.since(from, Rule::Frame, message))?)
            }
            "ABS" => Ok(Value::Number(read_number(self.scan, self.variables)?.abs())),
            "SIN" => Ok(Value::Number(read_number(self.scan, self.variables)?.to_radians().sin())),
            "COS" => Ok(Value::Number(read_number(self.scan, self.variables)?.to_radians().cos())),
            "SQRT" => match read_number(self.scan, self.variables)?.sqrt() {
                root if root.is_finite() => Ok(Value::Number(root)),
                _ => Err(self.scan.since(from, Rule::Arithmetic, "the root of a negative number")),
            },
            _ => {
                let message = format!("the function {name} is not followed");
                Err(self.scan.since(from, Rule::Unsupported, message))
            }
        }
    }

    /// Three lengths behind a robtarget.
    fn three(&mut self) -> Outcome<Vec3> {
        let mut all = [0.0; 3];
        for number in &mut all {
            self.scan.expect(b',')?;
            *number = read_number(self.scan, self.variables)?;
        }
        Ok(Vec3::from(all))
    }

    /// `\Rx:=`, `\Ry:=`, `\Rz:=`, radians; 0 where they are left out.
    fn turns(&mut self) -> Outcome<[f64; 3]> {
        let mut all = [0.0; 3];
        for (angle, word) in all.iter_mut().zip(["RX", "RY", "RZ"]) {
            let before = self.scan.at;
            self.scan.take(b',');
            if !(self.scan.take(b'\\') && self.scan.take_word(word)?) {
                self.scan.at = before;
                continue;
            }
            if !self.scan.assigns() {
                return Err(self.scan.wrong("`:=` is needed here"));
            }
            *angle = read_number(self.scan, self.variables)?.to_radians();
        }
        Ok(all)
    }

    fn not_a(&self, from: usize, value: &Value, needed: &str) -> Box<Diagnostic> {
        let message = format!("{} where {needed} is needed", value.kind());
        self.scan.since(from, Rule::Type, message)
    }

    /// `AND`, `OR`, `XOR`, `DIV`, `MOD`.
    fn worded(&mut self, at: usize) -> Option<Next<Operator>> {
        let name = self.scan.name().ok().flatten();
        let found = name.and_then(|name| match name.as_str() {
            "DIV" => Some((Operator::Div, 4)),
            "MOD" => Some((Operator::Mod, 4)),
            "AND" => Some((Operator::And, 1)),
            "XOR" => Some((Operator::Xor, 0)),
            "OR" => Some((Operator::Or, 0)),
            _ => None,
        });
        if found.is_none() {
            self.scan.at = at;
        }
        found.map(|(operator, rank)| Next { operator, rank: Rank::Left(rank), at })
    }
}

/// A robtarget whose frame becomes another.
fn moved(target: &Value, by: impl Fn(Frame) -> Frame) -> Result<Value, String> {
    let parts = target.parts();
    let moved = by(frame(parts)?);
    let numbers = |all: &[f64]| Value::List(all.iter().copied().map(Value::Number).collect());
    let turn = Quat::from_mat3(&moved.matrix3);
    let own = [numbers(&moved.translation.to_array()), numbers(&[turn.w, turn.x, turn.y, turn.z])];
    Ok(Value::List(own.into_iter().chain(parts.iter().skip(2).cloned()).collect()))
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
                match self.nested(Self::operand)? {
                    Value::Number(number) if sign == b'-' => Ok(Value::Number(-number)),
                    Value::Number(number) => Ok(Value::Number(number)),
                    other => Err(self.not_a(from, &other, "a number")),
                }
            }
            Some(b'[') => {
                self.scan.at += 1;
                self.nested(Self::aggregate)
            }
            Some(b'(') => {
                self.scan.at += 1;
                let value = self.nested(evaluate)?;
                self.scan.expect(b')')?;
                Ok(value)
            }
            Some(b'"') => Ok(Value::Text(self.scan.text()?)),
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
            (b'*', _) => (Operator::Times, 4, 1),
            (b'/', _) => (Operator::Over, 4, 1),
            (b'+', _) => (Operator::Plus, 3, 1),
            (b'-', _) => (Operator::Minus, 3, 1),
            (b'<', Some(b'>')) => (Operator::Unequal, 2, 2),
            (b'<', Some(b'=')) => (Operator::LessOrEqual, 2, 2),
            (b'>', Some(b'=')) => (Operator::GreaterOrEqual, 2, 2),
            (b'<', _) => (Operator::Less, 2, 1),
            (b'>', _) => (Operator::Greater, 2, 1),
            (b'=', _) => (Operator::Equal, 2, 1),
            _ => return self.worded(at),
        };
        self.scan.at += length;
        Some(Next { operator, rank: Rank::Left(rank), at })
    }

    fn apply(&mut self, operator: Operator, [a, b]: [Value; 2], span: Span) -> Outcome<Value> {
        let answer = match (&a, &b) {
            (Value::Number(a), Value::Number(b)) => calculated(operator, *a, *b),
            (Value::Flag(a), Value::Flag(b)) => match operator {
                Operator::And => Some(Value::Flag(*a && *b)),
                Operator::Or => Some(Value::Flag(*a || *b)),
                Operator::Xor | Operator::Unequal => Some(Value::Flag(a != b)),
                Operator::Equal => Some(Value::Flag(a == b)),
                _ => None,
            },
            (_, _) => None,
        };
        answer.ok_or_else(|| {
            let message = format!("{} and {} have no such result", a.kind(), b.kind());
            self.scan.since(span.start, Rule::Arithmetic, message)
        })
    }
}

/// A decimal, with the power of ten that RAPID allows (`9E9`).
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
    let text = scan.text.get(from..scan.at).unwrap_or_default();
    let text = std::str::from_utf8(text).unwrap_or_default();
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
        // Of whole numbers alone.
        Operator::Div if a.fract() == 0.0 && b.fract() == 0.0 => number((a / b).trunc()),
        Operator::Mod if a.fract() == 0.0 && b.fract() == 0.0 => number(a % b),
        Operator::Plus => number(a + b),
        Operator::Minus => number(a - b),
        Operator::Equal => Some(Value::Flag(a == b)),
        Operator::Unequal => Some(Value::Flag(a != b)),
        Operator::Less => Some(Value::Flag(a < b)),
        Operator::Greater => Some(Value::Flag(a > b)),
        Operator::LessOrEqual => Some(Value::Flag(a <= b)),
        Operator::GreaterOrEqual => Some(Value::Flag(a >= b)),
        Operator::Div | Operator::Mod | Operator::And | Operator::Or | Operator::Xor => None,
    }
}
