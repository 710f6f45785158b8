//! Formulas: operands, and operators by the ranks of RAPID ("Expressions", priority between operators).

use super::records::{fits, part, predefined};
use super::scan::{Rapid, Scan};
use super::value::{Name, Value, frame};
use crate::kernel::formula::{self, Operator, Sign, Terms, Typed, mistaken};
use geom::{Frame, Mat3, Quat, Vec3};
use program::{Outcome, Rule};

/// Most parts of an aggregate.
const MOST_PARTS: usize = 64;

/// What holds data.
pub(crate) trait Readable {
    /// The type of a name and its value, which is `None` where no statement has set it; `None` where nothing is declared by it.
    fn value(&self, name: Name) -> Option<(&'static str, Option<&Value>)>;
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

/// Takes a formula of that type.
///
/// # Errors
/// What is wrong in it, or it is of another.
pub(crate) fn read_as(scan: &mut Scan, variables: &dyn Readable, kind: &str) -> Outcome<Value> {
    scan.peek();
    let from = scan.at;
    let value = read(scan, variables)?;
    match fits(kind, &value) {
        true => Ok(value),
        false => Err(mistaken(scan, from, &value, &format!("a {}", kind.to_lowercase()))),
    }
}

/// Takes a formula that comes to a number.
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

impl Terms for Formulas<'_> {
    type Lexis = Rapid;
    type Value = Value;

    const OPERATORS: &'static [Sign] = &[
        ("*", Operator::Times, 4),
        ("/", Operator::Over, 4),
        ("DIV", Operator::Quotient, 4),
        ("MOD", Operator::Remainder, 4),
        ("+", Operator::Plus, 3),
        ("-", Operator::Minus, 3),
        ("<>", Operator::Unequal, 2),
        ("<=", Operator::LessOrEqual, 2),
        (">=", Operator::GreaterOrEqual, 2),
        ("<", Operator::Less, 2),
        (">", Operator::Greater, 2),
        ("=", Operator::Equal, 2),
        ("AND", Operator::And, 1),
        ("XOR", Operator::Xor, 0),
        ("OR", Operator::Or, 0),
    ];
    const TRUTH: [&'static [&'static str]; 3] = [&["TRUE"], &["FALSE"], &["NOT"]];

    /// An aggregate, or what a name stands for.
    fn operand(self, scan: &mut Scan) -> Outcome<Value> {
        if scan.take(b'[') {
            let parts = scan.list("]", MOST_PARTS, |scan| formula::read(scan, self))?;
            return Ok(Value::List(parts));
        }
        let from = scan.at;
        let name = scan.needed("a value")?;
        if scan.take(b'(') {
            let value = self.function(scan, from, name)?;
            scan.expect(")")?;
            return Ok(value);
        }
        let (kind, value) = match self.0.value(name) {
            Some((kind, Some(value))) => (kind, value.clone()),
            Some((_, None)) => {
                let message = format!("no statement has set {name}");
                return Err(scan.since(from, Rule::Variable, message));
            }
            None => predefined(name).ok_or_else(|| {
                scan.since(from, Rule::Variable, format!("{name} is not declared here"))
            })?,
        };
        let (places, _) = places(scan, kind)?;
        let found = places.iter().try_fold(&value, |value, place| value.parts().get(*place));
        found.cloned().ok_or_else(|| scan.since(from, Rule::Type, "it has no such part"))
    }
}

impl Formulas<'_> {
    /// A function behind its bracket, up to the closing one.
    fn function(self, scan: &mut Scan, from: usize, name: Name) -> Outcome<Value> {
        match name.as_str() {
            "OFFS" => {
                let target = read_as(scan, self.0, "ROBTARGET")?;
                let by = self.three(scan)?;
                Ok(moved(&target, |frame| {
                    Frame::from_mat3_translation(frame.matrix3, frame.translation + by)
                })
                .map_err(|message| scan.since(from, Rule::Frame, message))?)
            }
            "RELTOOL" => {
                let target = read_as(scan, self.0, "ROBTARGET")?;
                let by = self.three(scan)?;
                let [x, y, z] = self.turns(scan)?;
                // The displacement first, then the turns about the new X, Y and Z.
                let turn =
                    Mat3::from_rotation_x(x) * Mat3::from_rotation_y(y) * Mat3::from_rotation_z(z);
                let own = Frame::from_mat3_translation(turn, by);
                Ok(moved(&target, |frame| frame * own)
                    .map_err(|message| scan.since(from, Rule::Frame, message))?)
            }
            "ABS" => Ok(Value::Number(read_number(scan, self.0)?.abs())),
            "SIN" => Ok(Value::Number(read_number(scan, self.0)?.to_radians().sin())),
            "COS" => Ok(Value::Number(read_number(scan, self.0)?.to_radians().cos())),
            "SQRT" => match read_number(scan, self.0)?.sqrt() {
                root if root.is_finite() => Ok(Value::Number(root)),
                _ => Err(scan.since(from, Rule::Arithmetic, "the root of a negative number")),
            },
            _ => {
                let message = format!("the function {name} is not followed");
                Err(scan.since(from, Rule::Unsupported, message))
            }
        }
    }

    /// Three lengths behind a robtarget.
    fn three(self, scan: &mut Scan) -> Outcome<Vec3> {
        let mut all = [0.0; 3];
        for number in &mut all {
            scan.expect(",")?;
            *number = read_number(scan, self.0)?;
        }
        Ok(Vec3::from(all))
    }

    /// `\Rx:=`, `\Ry:=`, `\Rz:=`, radians; 0 where they are left out.
    fn turns(self, scan: &mut Scan) -> Outcome<[f64; 3]> {
        let mut all = [0.0; 3];
        for (angle, word) in all.iter_mut().zip(["RX", "RY", "RZ"]) {
            let before = scan.at;
            scan.take(b',');
            if !(scan.take(b'\\') && scan.take_word(word)) {
                scan.at = before;
                continue;
            }
            scan.expect(":=")?;
            *angle = read_number(scan, self.0)?.to_radians();
        }
        Ok(all)
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
