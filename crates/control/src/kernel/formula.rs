//! Formulas of typed values: numbers, truth values, texts and what else a language has, with the operators of that language.
//!
//! A language says by [`Terms`] how its operators are written and rank, which operands it has beyond numbers, texts, signs,
//! brackets and truth values, and where its operators calculate otherwise; [`read`] does the rest.

use super::expression::{Grammar, Next, Rank, Span, evaluate};
use super::scan::{Lexis, Scan};
use program::{Diagnostic, Outcome, Rule};

/// How deep brackets, signs, aggregates and calls may nest.
const DEEPEST: usize = 24;

/// What formulas of a language come to.
pub trait Typed: Sized {
    /// The value of a number.
    const NUMBER: fn(f64) -> Self;
    /// The value of a truth value.
    const FLAG: fn(bool) -> Self;
    /// The value of a text.
    const TEXT: fn(Box<str>) -> Self;

    /// What it is, for an error: "a number".
    fn kind(&self) -> &'static str;

    /// Its number, of whatever type.
    fn number(&self) -> Option<f64>;

    /// Its truth value.
    fn flag(&self) -> Option<bool>;

    /// The number with the other sign.
    fn negated(&self) -> Option<Self> {
        self.number().map(|number| (Self::NUMBER)(-number))
    }
}

/// An operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// Chains two frames.
    Chain,
    /// A product.
    Times,
    /// A quotient.
    Over,
    /// The whole quotient of whole numbers, cut off towards 0.
    Quotient,
    /// What remains of such a division, with the sign of the first.
    Remainder,
    /// A sum.
    Plus,
    /// A difference.
    Minus,
    /// Both.
    And,
    /// One alone.
    Xor,
    /// One or both.
    Or,
    /// The same.
    Equal,
    /// Not the same.
    Unequal,
    /// `<`
    Less,
    /// `>`
    Greater,
    /// `<=`
    LessOrEqual,
    /// `>=`
    GreaterOrEqual,
}

impl Operator {
    /// What it makes of two numbers; `None` where that is nothing finite.
    pub fn of_numbers<V: Typed>(self, a: f64, b: f64) -> Option<V> {
        let finite = |value: f64| value.is_finite().then(|| (V::NUMBER)(value));
        let whole = a.fract() == 0.0 && b.fract() == 0.0;
        match self {
            Operator::Times => finite(a * b),
            Operator::Over => finite(a / b),
            Operator::Quotient if whole => finite((a / b).trunc()),
            Operator::Remainder if whole => finite(a % b),
            Operator::Plus => finite(a + b),
            Operator::Minus => finite(a - b),
            Operator::Equal => Some((V::FLAG)(a == b)),
            Operator::Unequal => Some((V::FLAG)(a != b)),
            Operator::Less => Some((V::FLAG)(a < b)),
            Operator::Greater => Some((V::FLAG)(a > b)),
            Operator::LessOrEqual => Some((V::FLAG)(a <= b)),
            Operator::GreaterOrEqual => Some((V::FLAG)(a >= b)),
            Operator::Quotient
            | Operator::Remainder
            | Operator::Chain
            | Operator::And
            | Operator::Xor
            | Operator::Or => None,
        }
    }

    /// What it makes of two truth values.
    pub fn of_flags(self, a: bool, b: bool) -> Option<bool> {
        match self {
            Operator::And => Some(a && b),
            Operator::Or => Some(a || b),
            Operator::Xor | Operator::Unequal => Some(a != b),
            Operator::Equal => Some(a == b),
            _ => None,
        }
    }
}

/// An operator as it is written, and its rank: the higher goes first, those of one rank from left to right.
pub type Sign = (&'static str, Operator, u8);

/// What formulas of a language are made of, with the variables that they may name.
pub trait Terms: Copy {
    /// How it writes names, texts and comments.
    type Lexis: Lexis;
    /// What formulas come to.
    type Value: Typed;

    /// Its operators; one that another begins with stands behind that (`<` behind `<=`).
    const OPERATORS: &'static [Sign];
    /// The words for what is true, what is not, and what turns one into the other.
    const TRUTH: [&'static [&'static str]; 3];

    /// A number as it is written.
    ///
    /// # Errors
    /// What to say of a number that is none of the language.
    fn number(self, value: f64, written: &[u8]) -> Result<Self::Value, &'static str> {
        let _ = written;
        Ok((Self::Value::NUMBER)(value))
    }

    /// Takes an operand of another kind than a number, a text, a truth value, a sign or a bracket. Formulas may stand in it.
    ///
    /// # Errors
    /// There is none.
    fn operand(self, scan: &mut Scan<Self::Lexis>) -> Outcome<Self::Value>;

    /// What an operator makes of two values where the language has a rule of its own; `None` where it has none.
    ///
    /// # Errors
    /// They have no such result.
    fn apply(
        self,
        operator: Operator,
        values: [&Self::Value; 2],
    ) -> Result<Option<Self::Value>, (Rule, String)> {
        let _ = (operator, values);
        Ok(None)
    }
}

/// Takes a formula.
///
/// # Errors
/// What is wrong in it.
pub fn read<T: Terms>(scan: &mut Scan<T::Lexis>, terms: T) -> Outcome<T::Value> {
    evaluate(&mut Formula { scan, terms })
}

/// Takes a formula that comes to a number.
///
/// # Errors
/// What is wrong in it; it comes to something else, or to a number that is not finite.
pub fn read_number<T: Terms>(scan: &mut Scan<T::Lexis>, terms: T) -> Outcome<f64> {
    scan.peek();
    let from = scan.at;
    let value = read(scan, terms)?;
    match value.number() {
        Some(number) if number.is_finite() => Ok(number),
        Some(_) => Err(scan.since(from, Rule::Number, "a number beyond all numbers")),
        None => Err(mistaken(scan, from, &value, "a number")),
    }
}

/// The error of a value of another type than is needed.
pub fn mistaken<L: Lexis>(
    scan: &Scan<L>,
    from: usize,
    value: &impl Typed,
    needed: &str,
) -> Box<Diagnostic> {
    let message = format!("{} where {needed} is needed", value.kind());
    scan.since(from, Rule::Type, message)
}

/// A formula on its way through a text.
struct Formula<'s, 't, T: Terms> {
    scan: &'s mut Scan<'t, T::Lexis>,
    terms: T,
}

impl<T: Terms> Formula<'_, '_, T> {
    /// A truth value by its word, or the opposite of one.
    fn truth(&mut self) -> Outcome<Option<T::Value>> {
        let from = self.scan.at;
        let word = self.scan.word().unwrap_or_default();
        let [yes, no, not] =
            T::TRUTH.map(|words| words.iter().any(|own| T::Lexis::same(own, word)));
        if yes || no {
            return Ok(Some((T::Value::FLAG)(yes)));
        }
        if !not {
            self.scan.at = from;
            return Ok(None);
        }
        let value = self.nested(Self::operand)?;
        match value.flag() {
            Some(flag) => Ok(Some((T::Value::FLAG)(!flag))),
            None => Err(mistaken(self.scan, from, &value, (T::Value::FLAG)(true).kind())),
        }
    }

    fn signed(&mut self, is_negative: bool) -> Outcome<T::Value> {
        let from = self.scan.at;
        self.scan.at += 1;
        let value = self.nested(Self::operand)?;
        let number = if is_negative { value.negated() } else { None };
        match (number, value.number()) {
            (Some(number), _) => Ok(number),
            (None, Some(_)) => Ok(value),
            (None, None) => Err(mistaken(self.scan, from, &value, "a number")),
        }
    }
}

impl<T: Terms> Grammar for Formula<'_, '_, T> {
    type Value = T::Value;
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

    fn operand(&mut self) -> Outcome<T::Value> {
        let next = self.scan.peek();
        let from = self.scan.at;
        match next {
            Some(b'0'..=b'9' | b'.') => {
                let number = self.scan.number()?;
                let value = self.terms.number(number, &self.scan.text[from..self.scan.at]);
                value.map_err(|message| self.scan.since(from, Rule::Number, message))
            }
            Some(sign @ (b'-' | b'+')) => self.signed(sign == b'-'),
            Some(b'(') => {
                self.scan.at += 1;
                let value = self.nested(evaluate)?;
                self.scan.expect(")")?;
                Ok(value)
            }
            Some(b'"') => self.scan.text().map(T::Value::TEXT),
            _ => match self.truth()? {
                Some(value) => Ok(value),
                None => self.nested(|own| own.terms.operand(own.scan)),
            },
        }
    }

    fn operator(&mut self) -> Option<Next<Operator>> {
        let next = self.scan.peek()?;
        let at = self.scan.at;
        let (_, operator, rank) = T::OPERATORS.iter().find(|(sign, _, _)| {
            let first = sign.bytes().next().unwrap_or_default();
            // Behind most numbers none stands.
            first.eq_ignore_ascii_case(&next)
                && match first.is_ascii_alphabetic() {
                    true => self.scan.take_word(sign),
                    false => self.scan.take_text(sign),
                }
        })?;
        Some(Next { operator: *operator, rank: Rank::Left(*rank), at })
    }

    fn apply(
        &mut self,
        operator: Operator,
        [a, b]: [T::Value; 2],
        span: Span,
    ) -> Outcome<T::Value> {
        let wrong =
            |rule: Rule, message: String| self.scan.error(rule, span.start..span.end, message);
        let own = self.terms.apply(operator, [&a, &b]);
        if let Some(value) = own.map_err(|(rule, message)| wrong(rule, message))? {
            return Ok(value);
        }
        if let (Some(x), Some(y)) = (a.number(), b.number()) {
            let message = "the operator has no result for these numbers";
            return operator
                .of_numbers(x, y)
                .ok_or_else(|| wrong(Rule::Arithmetic, message.into()));
        }
        let flags = a.flag().zip(b.flag()).and_then(|(a, b)| operator.of_flags(a, b));
        flags.map(T::Value::FLAG).ok_or_else(|| {
            wrong(Rule::Type, format!("{} and {} have no such operator", a.kind(), b.kind()))
        })
    }
}
