//! Formulas: operands, and operators by their ranks (those of Python, as far as the manual shows them).

use super::scan::{Scan, UrScript};
use super::value::{Value, frame, pose};
use crate::kernel::formula::{self, Operator, Sign, Terms, mistaken};
use program::{Outcome, Rule};

/// Most arguments of a call.
const MOST_ARGUMENTS: usize = 16;

/// What holds variables.
pub(crate) trait Readable {
    /// What a variable holds; `None` where no line has set it.
    fn value(&self, name: &str) -> Option<Value>;
}

/// What formulas are made of.
#[derive(Clone, Copy)]
struct Formulas<'v>(&'v dyn Readable);

/// An argument of a call: by its place, or by its name (`a=1.2`).
#[derive(Clone, Debug)]
pub(crate) struct Argument<'t> {
    pub(crate) name: Option<&'t str>,
    pub(crate) value: Value,
}

/// Takes a formula.
///
/// # Errors
/// What is wrong in it.
pub(crate) fn read(scan: &mut Scan, variables: &dyn Readable) -> Outcome<Value> {
    formula::read(scan, Formulas(variables))
}

/// Takes the arguments of a call behind its opening bracket.
///
/// # Errors
/// What is wrong in them.
pub(crate) fn arguments<'t>(
    scan: &mut Scan<'t>,
    variables: &dyn Readable,
) -> Outcome<Vec<Argument<'t>>> {
    let mut names = Vec::new();
    scan.list(")", MOST_ARGUMENTS, |scan| {
        let before = scan.at;
        let name = scan.word().filter(|_| {
            scan.peek() == Some(b'=') && scan.rest().get(1).is_none_or(|byte| *byte != b'=')
        });
        match name {
            Some(name) if names.contains(&name) => {
                let message = format!("the argument {name} stands twice");
                return Err(scan.since(before, Rule::RepeatedWord, message));
            }
            Some(name) => {
                names.push(name);
                scan.expect("=")?;
            }
            None => {
                scan.at = before;
                if !names.is_empty() {
                    return Err(
                        scan.wrong("an argument without a name stands behind one with a name")
                    );
                }
            }
        }
        Ok(Argument { name, value: read(scan, variables)? })
    })
}

impl Terms for Formulas<'_> {
    type Lexis = UrScript;
    type Value = Value;

    const OPERATORS: &'static [Sign] = &[
        ("*", Operator::Times, 5),
        ("/", Operator::Over, 5),
        ("+", Operator::Plus, 4),
        ("-", Operator::Minus, 4),
        ("==", Operator::Equal, 3),
        ("!=", Operator::Unequal, 3),
        ("<=", Operator::LessOrEqual, 3),
        (">=", Operator::GreaterOrEqual, 3),
        ("<", Operator::Less, 3),
        (">", Operator::Greater, 3),
        ("and", Operator::And, 2),
        ("xor", Operator::Xor, 1),
        ("or", Operator::Or, 0),
    ];
    const TRUTH: [&'static [&'static str]; 3] = [&["True", "TRUE"], &["False", "FALSE"], &["not"]];

    fn operand(self, scan: &mut Scan) -> Outcome<Value> {
        if scan.peek() == Some(b'[') {
            return self.list(scan).map(Value::List);
        }
        let from = scan.at;
        match scan.word() {
            Some(name) => self.named(scan, from, name),
            None => Err(scan.wrong("a value is needed here")),
        }
    }

    fn apply(
        self,
        operator: Operator,
        [a, b]: [&Value; 2],
    ) -> Result<Option<Value>, (Rule, String)> {
        match (operator, a, b) {
            (Operator::Over, Value::Number(a), Value::Number(b))
                if a % b != 0.0 && a.fract() == 0.0 && b.fract() == 0.0 =>
            {
                let message = "whether a quotient of whole numbers is cut to a whole number is not known here: write what it comes to";
                Err((Rule::Arithmetic, message.into()))
            }
            _ => Ok(None),
        }
    }
}

impl Formulas<'_> {
    fn list(self, scan: &mut Scan) -> Outcome<Vec<Value>> {
        scan.expect("[")?;
        scan.list("]", usize::MAX, |scan| formula::read(scan, self))
    }

    /// What a name stands for.
    fn named(self, scan: &mut Scan, from: usize, name: &str) -> Outcome<Value> {
        if name == "p" && scan.rest().first() == Some(&b'[') {
            let numbers = Value::List(self.list(scan)?).numbers::<6>();
            return numbers
                .map(Value::Pose)
                .ok_or_else(|| scan.since(from, Rule::Type, "a pose has six numbers"));
        }
        if scan.take(b'(') {
            let arguments = arguments(scan, self.0)?;
            return function(scan, from, name, &arguments);
        }
        let value = self
            .0
            .value(name)
            .ok_or_else(|| scan.since(from, Rule::Variable, format!("no line has set {name}")))?;
        if scan.take(b'[') {
            return self.element(scan, from, &value);
        }
        Ok(value)
    }

    /// An element of a list or of a pose, from 0.
    fn element(self, scan: &mut Scan, from: usize, of: &Value) -> Outcome<Value> {
        let index = formula::read(scan, self)?;
        scan.expect("]")?;
        let index = match index {
            Value::Number(index) if index >= 0.0 && index.fract() == 0.0 => index as usize,
            _ => {
                return Err(scan.since(from, Rule::Index, "an index is a whole number from 0"));
            }
        };
        let found = match of {
            Value::List(list) => list.get(index).cloned(),
            Value::Pose(pose) => pose.get(index).map(|number| Value::Number(*number)),
            Value::Number(_) | Value::Flag(_) | Value::Text(_) => {
                return Err(mistaken(scan, from, of, "a list or a pose"));
            }
        };
        found.ok_or_else(|| scan.since(from, Rule::Index, "there is no such element"))
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
