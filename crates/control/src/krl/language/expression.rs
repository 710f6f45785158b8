//! Formulas: operands, and operators by the ranks of KRL (KSS, "Priority of operators").

use super::scan::{Krl, Scan};
use super::value::{COORDINATES, Name, Value, coordinates, frame};
use crate::kernel::formula::{self, Operator, Sign, Terms};
use program::{Outcome, Rule};

/// What holds variables.
pub(crate) trait Readable {
    /// What a variable holds, by its name, its index, and its field where it is one of a structure; `None` where no block has
    /// set it.
    fn value(&self, name: Name, index: Option<i64>, field: Option<Name>) -> Option<Value>;
}

/// What formulas are made of.
#[derive(Clone, Copy)]
struct Formulas<'v>(&'v dyn Readable);

/// Takes a formula.
///
/// # Errors
/// What is wrong in it.
pub(crate) fn read(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Value> {
    formula::read(scan, Formulas(variables))
}

/// Takes a formula that comes to a number.
///
/// # Errors
/// What is wrong in it; it comes to something else, or to a number that is not finite.
pub(crate) fn read_number(scan: &mut Scan, variables: &dyn Readable) -> Outcome<f64> {
    formula::read_number(scan, Formulas(variables))
}

/// Takes an index in square brackets, or its empty form of a text (`[]`), where one comes next.
///
/// # Errors
/// It is no whole number.
pub(crate) fn read_index(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Option<i64>> {
    if !scan.take(b'[') || scan.take(b']') {
        return Ok(None);
    }
    let from = scan.at;
    let number = read_number(scan, variables)?;
    if number.fract() != 0.0 || number.abs() > 1e6 {
        return Err(scan.since(from, Rule::Index, "an index is a whole number"));
    }
    scan.expect("]")?;
    Ok(Some(number as i64))
}

impl Terms for Formulas<'_> {
    type Lexis = Krl;
    type Value = Value;

    const OPERATORS: &'static [Sign] = &[
        (":", Operator::Chain, 6),
        ("*", Operator::Times, 5),
        ("/", Operator::Over, 5),
        ("+", Operator::Plus, 4),
        ("-", Operator::Minus, 4),
        ("AND", Operator::And, 3),
        ("EXOR", Operator::Xor, 2),
        ("OR", Operator::Or, 1),
        ("==", Operator::Equal, 0),
        ("<>", Operator::Unequal, 0),
        ("<=", Operator::LessOrEqual, 0),
        (">=", Operator::GreaterOrEqual, 0),
        ("<", Operator::Less, 0),
        (">", Operator::Greater, 0),
    ];
    const TRUTH: [&'static [&'static str]; 3] = [&["TRUE"], &["FALSE"], &["NOT"]];

    /// An INT where it has neither point nor exponent.
    fn number(self, value: f64, written: &[u8]) -> Result<Value, &'static str> {
        if !written.iter().all(u8::is_ascii_digit) {
            return Ok(Value::Number(value));
        }
        let whole = std::str::from_utf8(written).ok().and_then(|digits| digits.parse().ok());
        whole.map(Value::Integer).ok_or("a whole number is at most 2147483647")
    }

    fn operand(self, scan: &mut Scan) -> Outcome<Value> {
        match scan.peek() {
            Some(b'{') => self.aggregate(scan),
            Some(b'#') => {
                scan.at += 1;
                Ok(Value::Entry(scan.needed("the name of an entry behind #")?))
            }
            Some(b'\'') => bits(scan),
            _ => self.named(scan),
        }
    }

    fn apply(
        self,
        operator: Operator,
        [a, b]: [&Value; 2],
    ) -> Result<Option<Value>, (Rule, String)> {
        if operator == Operator::Chain {
            return match (whole_frame(a), whole_frame(b)) {
                (Some(a), Some(b)) => Ok(Some(fields(&(frame(a) * frame(b))))),
                _ => Err((Rule::Type, String::from("`:` chains two frames of X, Y, Z, A, B, C"))),
            };
        }
        let (Value::Integer(a), Value::Integer(b)) = (a, b) else { return Ok(None) };
        // Of two INT the result is one: a division is cut off towards 0.
        let whole = match operator {
            Operator::Times => a.checked_mul(*b),
            Operator::Over => a.checked_div(*b),
            Operator::Plus => a.checked_add(*b),
            Operator::Minus => a.checked_sub(*b),
            _ => return Ok(None),
        };
        let message = "the operator has no result for these numbers";
        whole.map(|whole| Some(Value::Integer(whole))).ok_or((Rule::Arithmetic, message.into()))
    }
}

impl Formulas<'_> {
    /// An aggregate: `{X 1,Y 2}`, `{FRAME: X 1}`.
    fn aggregate(self, scan: &mut Scan) -> Outcome<Value> {
        scan.expect("{")?;
        let before = scan.at;
        let typed = scan.word().is_some() && scan.take(b':');
        if !typed {
            scan.at = before;
        }
        let mut fields: Vec<(Name, Value)> = Vec::with_capacity(6);
        loop {
            scan.peek();
            let from = scan.at;
            let name = scan.needed("the name of a field")?;
            if scan.take(b'[') {
                scan.expect("]")?;
            }
            if fields.iter().any(|(field, _)| *field == name) {
                let message = format!("{name} stands twice in the aggregate");
                return Err(scan.since(from, Rule::RepeatedWord, message));
            }
            fields.push((name, formula::read(scan, self)?.in_field(name)));
            if scan.take(b'}') {
                return Ok(Value::Fields(fields));
            }
            scan.expect(",")?;
        }
    }

    /// What a name stands for.
    fn named(self, scan: &mut Scan) -> Outcome<Value> {
        let from = scan.at;
        let name = scan.needed("a value")?;
        if scan.peek() == Some(b'(') {
            let message = format!("the function {name} is not followed");
            return Err(scan.since(from, Rule::Unsupported, message));
        }
        let index = read_index(scan, self.0)?;
        let field = if scan.take(b'.') { scan.name()? } else { None };
        self.0
            .value(name, index, field)
            .ok_or_else(|| scan.since(from, Rule::Variable, format!("no block has set {name}")))
    }
}

/// `'B0110'`, `'HFF'`.
fn bits(scan: &mut Scan) -> Outcome<Value> {
    let from = scan.at;
    scan.at += 1;
    let rest = scan.rest();
    let length = rest.iter().take_while(|byte| byte.is_ascii_alphanumeric()).count();
    let digits = std::str::from_utf8(rest.get(1..length).unwrap_or_default()).unwrap_or("");
    let radix = match rest.first().map(u8::to_ascii_uppercase) {
        Some(b'B') => Some(2),
        Some(b'H') => Some(16),
        _ => None,
    };
    scan.at += length;
    let number = radix.and_then(|radix| i32::from_str_radix(digits, radix).ok());
    let closed = scan.take(b'\'');
    number.filter(|_| closed).map(Value::Integer).ok_or_else(|| {
        scan.since(from, Rule::Number, "a number such as 'B0110' or 'HFF' is needed")
    })
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
    let named = COORDINATES.iter().filter_map(|name| Name::of(name));
    Value::Fields(named.zip(coordinates(frame).map(Value::Number)).collect())
}
