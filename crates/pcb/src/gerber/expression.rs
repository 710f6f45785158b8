//! Expressions of aperture macros (section 4.5.4): numbers, variables, `+ - x /` and brackets.

use crate::decimal::{decimal, whole};
use crate::report::{Outcome, fault};
use program::Rule;
use std::collections::HashMap;

/// The values of `$1`, `$2` and so on; one that is not there is 0.
pub(super) type Variables = HashMap<u32, f64>;

/// An expression, in the order in which it is evaluated: operators stand behind what they join, so
/// brackets of any depth need no recursion.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Expression {
    steps: Vec<Step>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Number(f64),
    Variable(u32),
    Operator(Operator),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operator {
    Open,
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
}

impl Operator {
    /// How strongly it binds.
    fn rank(self) -> u8 {
        match self {
            Operator::Open => 0,
            Operator::Add | Operator::Subtract => 1,
            Operator::Multiply | Operator::Divide => 2,
            Operator::Negate => 3,
        }
    }
}

impl Expression {
    /// Reads an expression.
    ///
    /// # Errors
    /// `macro-expression`
    pub(super) fn of(text: &[u8]) -> Outcome<Expression> {
        let text = text.trim_ascii();
        if let Some(number) = decimal(text) {
            return Ok(Expression { steps: vec![Step::Number(number)] });
        }
        let odd = |what: &str| {
            let shown = String::from_utf8_lossy(&text[..text.len().min(60)]);
            let help = "a value of a macro is made of numbers, $1, +, -, x, / and brackets";
            fault(Rule::MacroExpression, format!("{shown:?}: {what}"), help)
        };
        let (mut steps, mut waiting) = (Vec::new(), Vec::new());
        let mut wants_value = true;
        let mut rest = text;
        while let Some((&c, next)) = rest.split_first() {
            let length = match c {
                b'0'..=b'9' | b'.' => number_length(rest),
                b'$' => 1 + number_length(next),
                _ => 1,
            };
            let (part, after) = rest.split_at(length);
            rest = after;
            let operator = match c {
                _ if c.is_ascii_whitespace() => continue,
                b'0'..=b'9' | b'.' | b'$' if !wants_value => {
                    return Err(odd("no operator between values"));
                }
                b'0'..=b'9' | b'.' => {
                    let number = decimal(part).ok_or_else(|| odd("a number is malformed"))?;
                    steps.push(Step::Number(number));
                    wants_value = false;
                    continue;
                }
                b'$' => {
                    let variable = part.get(1..).and_then(whole);
                    steps
                        .push(Step::Variable(variable.ok_or_else(|| odd("$ without its number"))?));
                    wants_value = false;
                    continue;
                }
                b'(' if wants_value => Operator::Open,
                b'+' if wants_value => continue,
                b'-' if wants_value => Operator::Negate,
                b')' if !wants_value => {
                    loop {
                        match waiting.pop() {
                            Some(Operator::Open) => break,
                            Some(operator) => steps.push(Step::Operator(operator)),
                            None => return Err(odd("a ) without its (")),
                        }
                    }
                    continue;
                }
                b'+' => Operator::Add,
                b'-' => Operator::Subtract,
                b'x' | b'X' => Operator::Multiply,
                b'/' => Operator::Divide,
                _ => return Err(odd("not understood")),
            };
            if !matches!(operator, Operator::Open | Operator::Negate) {
                if wants_value {
                    return Err(odd("an operator without a value before it"));
                }
                while let Some(last) = waiting.pop_if(|last| last.rank() >= operator.rank()) {
                    steps.push(Step::Operator(last));
                }
            }
            waiting.push(operator);
            wants_value = true;
        }
        if wants_value {
            return Err(odd("a value is missing"));
        }
        while let Some(operator) = waiting.pop() {
            if operator == Operator::Open {
                return Err(odd("a ( without its )"));
            }
            steps.push(Step::Operator(operator));
        }
        Ok(Expression { steps })
    }

    /// How much there is to do.
    pub(super) fn steps(&self) -> usize {
        self.steps.len()
    }

    /// Its value.
    ///
    /// # Errors
    /// `macro-division` by zero, `macro-value` where the result is no number within 10¹².
    pub(super) fn value(&self, variables: &Variables) -> Outcome<f64> {
        let mut values: Vec<f64> = Vec::new();
        for step in &self.steps {
            let value = match step {
                Step::Number(number) => *number,
                Step::Variable(variable) => variables.get(variable).copied().unwrap_or(0.0),
                Step::Operator(operator) => {
                    let right = values.pop().unwrap_or(0.0);
                    let mut left = || values.pop().unwrap_or(0.0);
                    match operator {
                        Operator::Add => left() + right,
                        Operator::Subtract => left() - right,
                        Operator::Multiply => left() * right,
                        Operator::Divide if right == 0.0 => {
                            let help = "correct the macro, or the values that %AD gives it";
                            return Err(fault(Rule::MacroDivision, "a division by zero", help));
                        }
                        Operator::Divide => left() / right,
                        Operator::Negate | Operator::Open => -right,
                    }
                }
            };
            if value.is_nan() || value.abs() > 1e12 {
                let help = "correct the macro, or the values that %AD gives it";
                return Err(fault(
                    Rule::MacroValue,
                    format!("a value of {value:e} is out of this world"),
                    help,
                ));
            }
            values.push(value);
        }
        Ok(values.pop().unwrap_or(0.0))
    }
}

/// How many characters of a number `text` begins with.
fn number_length(text: &[u8]) -> usize {
    text.iter().position(|c| !c.is_ascii_digit() && *c != b'.').unwrap_or(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> Outcome<f64> {
        Expression::of(text.as_bytes())?.value(&Variables::from([(1, 0.5), (2, -3.0)]))
    }

    #[test]
    fn precedence_and_brackets() {
        for (text, expected) in [
            ("1+2x3", 7.0),
            ("(1+2)x3", 9.0),
            ("8/4/2", 1.0),
            ("8-4-2", 2.0),
            ("-$2", 3.0),
            ("2x-$1", -1.0),
            ("-(1+$1)X2", -3.0),
            ("--1", 1.0),
            ("$1+$1", 1.0),
            ("$7", 0.0),
            ("1.5-+.5", 1.0),
            ("100+$3", 100.0),
        ] {
            assert_eq!(value(text).unwrap(), expected, "{text}");
        }
    }

    #[test]
    fn what_is_no_expression_is_refused() {
        for text in ["", "1+", "(1", "1)", "1 2", "$", "$x", "1.2.3", "a", "x2", "()", "1,2"] {
            assert_eq!(value(text).unwrap_err().rule, "macro-expression", "{text}");
        }
        assert_eq!(value("1/0").unwrap_err().rule, "macro-division");
        assert_eq!(value("1/($1-0.5)").unwrap_err().rule, "macro-division");
        assert_eq!(value("1000000x1000000x10").unwrap_err().rule, "macro-value");
    }

    #[test]
    fn brackets_of_any_depth() {
        let deep = [vec![b'('; 100_000], vec![b'1'], vec![b')'; 100_000]].concat();
        assert_eq!(Expression::of(&deep).unwrap().value(&Variables::new()).unwrap(), 1.0);
    }
}
