//! Expressions: operands with operators between them, by the ranks of their language.
//!
//! A language says by a [`Grammar`] what its operands and operators are, how closely each operator binds, and what it
//! calculates; [`evaluate`] reads and calculates in one pass, by a [`Stack`]. Operators need no recursion; that of brackets
//! and signs is bounded by [`Grammar::nested`].

/// Operands and operators of a language, on their way through a text.
pub trait Grammar: Sized {
    /// What is calculated.
    type Value;
    /// What stands between two operands.
    type Operator: Copy;
    /// What is wrong.
    type Error;

    /// How deep brackets and signs may nest.
    const DEEPEST: usize;

    /// How deep they nest here.
    fn depth(&mut self) -> &mut usize;

    /// They would nest deeper than [`Grammar::DEEPEST`].
    fn too_deep(&mut self) -> Self::Error;

    /// The byte at which the next operand begins.
    fn start(&mut self) -> usize;

    /// The byte behind what has been taken.
    fn end(&self) -> usize;

    /// Takes an operand: a number, a variable, a function, signs, an expression in brackets.
    ///
    /// # Errors
    /// There is none.
    fn operand(&mut self) -> Result<Self::Value, Self::Error>;

    /// Takes the operator that comes next, if one does.
    fn operator(&mut self) -> Option<Next<Self::Operator>>;

    /// What an operator makes of two values, the left one first.
    ///
    /// # Errors
    /// They have no such result.
    fn apply(
        &mut self,
        operator: Self::Operator,
        values: [Self::Value; 2],
        span: Span,
    ) -> Result<Self::Value, Self::Error>;

    /// Takes a part of an expression in which others may stand.
    ///
    /// # Errors
    /// It is too deep within others, or what is wrong in it.
    fn nested<T>(
        &mut self,
        part: impl FnOnce(&mut Self) -> Result<T, Self::Error>,
    ) -> Result<T, Self::Error> {
        if *self.depth() >= Self::DEEPEST {
            return Err(self.too_deep());
        }
        *self.depth() += 1;
        let answer = part(self);
        *self.depth() -= 1;
        answer
    }
}

/// An operator in a text.
#[derive(Clone, Copy, Debug)]
pub struct Next<O> {
    /// Which it is.
    pub operator: O,
    /// How closely it binds.
    pub rank: Rank,
    /// The byte at which it begins.
    pub at: usize,
}

/// How closely an operator binds: the higher goes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
    /// Those of one rank go from left to right.
    Left(u8),
    /// Those of one rank go from right to left.
    Right(u8),
}

impl Rank {
    /// Whether an operator of this rank goes before one of rank `next` that follows it.
    fn goes_before(self, next: Rank) -> bool {
        let (Rank::Left(own) | Rank::Right(own)) = self;
        match next {
            Rank::Left(other) => own >= other,
            Rank::Right(other) => own > other,
        }
    }
}

/// Where an operator stands with its operands, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// The left operand begins.
    pub start: usize,
    /// The operator begins.
    pub operator: usize,
    /// The right operand has ended.
    pub end: usize,
}

/// A value with the bytes at which it begins and ends.
#[derive(Clone, Debug)]
pub struct Operand<V> {
    /// What it is.
    pub value: V,
    /// Where it stands.
    pub place: [usize; 2],
}

/// How many values wait without memory of their own: as many as a language has ranks in most formulas.
const NEAR: usize = 4;

/// Values that wait for what follows them, each with the operator behind it.
#[derive(Debug)]
pub struct Stack<V, O> {
    near: [Option<(Operand<V>, Next<O>)>; NEAR],
    far: Vec<(Operand<V>, Next<O>)>,
    length: usize,
}

impl<V, O> Default for Stack<V, O> {
    #[inline]
    fn default() -> Stack<V, O> {
        Stack { near: [const { None }; NEAR], far: Vec::new(), length: 0 }
    }
}

impl<V, O: Copy> Stack<V, O> {
    /// Applies to `last` the operators that go before one of rank `next`, or all.
    ///
    /// # Errors
    /// Two values have no result.
    #[inline]
    pub fn settle<E>(
        &mut self,
        mut last: Operand<V>,
        next: Option<Rank>,
        mut apply: impl FnMut(O, [V; 2], Span) -> Result<V, E>,
    ) -> Result<Operand<V>, E> {
        let goes = |by: &Next<O>| next.is_none_or(|next| by.rank.goes_before(next));
        while let Some((left, by)) = self.pop_if(goes) {
            let ([start, _], [_, end]) = (left.place, last.place);
            let span = Span { start, operator: by.at, end };
            let value = apply(by.operator, [left.value, last.value], span)?;
            last = Operand { value, place: [start, end] };
        }
        Ok(last)
    }

    /// A value waits for the right operand of `operator`.
    #[inline]
    pub fn push(&mut self, left: Operand<V>, operator: Next<O>) {
        match self.near.get_mut(self.length) {
            Some(free) => *free = Some((left, operator)),
            None => self.far.push((left, operator)),
        }
        self.length += 1;
    }

    #[inline]
    fn pop_if(&mut self, goes: impl Fn(&Next<O>) -> bool) -> Option<(Operand<V>, Next<O>)> {
        let index = self.length.checked_sub(1)?;
        let popped = match self.near.get_mut(index) {
            Some(last) => last.take_if(|(_, by)| goes(by)),
            None => self.far.pop_if(|(_, by)| goes(by)),
        };
        self.length -= usize::from(popped.is_some());
        popped
    }
}

/// Takes an expression and gives its value.
///
/// # Errors
/// The first that the grammar finds.
pub fn evaluate<G: Grammar>(grammar: &mut G) -> Result<G::Value, G::Error> {
    let mut stack = Stack::default();
    loop {
        let start = grammar.start();
        let value = grammar.operand()?;
        let operand = Operand { value, place: [start, grammar.end()] };
        let next = grammar.operator();
        let apply = |operator, values, span| grammar.apply(operator, values, span);
        let operand = stack.settle(operand, next.map(|next| next.rank), apply)?;
        match next {
            Some(next) => stack.push(operand, next),
            None => return Ok(operand.value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole numbers of one digit, `+ - * ^`, signs and brackets.
    struct Digits<'t> {
        text: &'t [u8],
        at: usize,
        depth: usize,
    }

    impl Grammar for Digits<'_> {
        type Value = i64;
        type Operator = u8;
        type Error = String;
        const DEEPEST: usize = 100;

        fn depth(&mut self) -> &mut usize {
            &mut self.depth
        }

        fn too_deep(&mut self) -> String {
            format!("too deep at {}", self.at)
        }

        fn start(&mut self) -> usize {
            self.at
        }

        fn end(&self) -> usize {
            self.at
        }

        fn operand(&mut self) -> Result<i64, String> {
            let byte = self.text.get(self.at).copied();
            self.at += 1;
            match byte {
                Some(digit @ b'0'..=b'9') => Ok(i64::from(digit - b'0')),
                Some(b'-') => self.nested(Self::operand).map(|value| -value),
                Some(b'(') => {
                    let value = self.nested(evaluate)?;
                    self.at += 1;
                    Ok(value)
                }
                _ => Err(format!("no operand at {}", self.at - 1)),
            }
        }

        fn operator(&mut self) -> Option<Next<u8>> {
            let (byte, at) = (*self.text.get(self.at)?, self.at);
            let rank = match byte {
                b'+' | b'-' => Rank::Left(0),
                b'*' => Rank::Left(1),
                b'^' => Rank::Right(2),
                _ => return None,
            };
            self.at += 1;
            Some(Next { operator: byte, rank, at })
        }

        fn apply(&mut self, operator: u8, [a, b]: [i64; 2], span: Span) -> Result<i64, String> {
            let result = match operator {
                b'+' => a.checked_add(b),
                b'-' => a.checked_sub(b),
                b'*' => a.checked_mul(b),
                _ => u32::try_from(b).ok().and_then(|b| a.checked_pow(b)),
            };
            result.ok_or_else(|| format!("no result of {span:?}"))
        }
    }

    fn value(text: &str) -> Result<i64, String> {
        evaluate(&mut Digits { text: text.as_bytes(), at: 0, depth: 0 })
    }

    #[test]
    fn operators_go_by_rank_and_within_one_from_the_side_that_it_names() {
        for (text, expected) in [
            ("7", 7),
            ("9-3-2", 4),
            ("1+2*3", 7),
            ("2*3+1", 7),
            ("(1+2)*3", 9),
            ("2^3^2", 512),
            ("2*2^3*2+1", 33),
            ("-2^2", 4),
            ("1--2", 3),
        ] {
            assert_eq!(value(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn errors_name_the_part_that_has_no_value() {
        let span = Span { start: 2, operator: 3, end: 6 };
        assert_eq!(value("1+2^-1+3"), Err(format!("no result of {span:?}")));
        assert_eq!(value("1+*2"), Err("no operand at 2".into()));
    }

    #[test]
    fn no_expression_recurses_without_bound() {
        for part in ["(", "-"] {
            assert!(value(&part.repeat(100_000)).unwrap_err().starts_with("too deep"), "{part}");
            assert!(value(&(part.repeat(100) + "1" + &")".repeat(100))).is_ok(), "{part}");
        }
        assert_eq!(value(&("1+".repeat(100_000) + "1")), Ok(100_001));
        assert_eq!(value(&("1^".repeat(100_000) + "1")), Ok(1));
    }
}
