//! Aperture macros (section 4.5): templates of apertures.

use super::expression::{Expression, Variables};
use super::primitive;
use super::reader::Budget;
use crate::FAR;
use crate::contour::{Contour, Piece};
use crate::decimal::whole;
use crate::report::{Fault, Location, Outcome, fault};
use program::Rule;

/// The template of an aperture.
#[derive(Default)]
pub(super) struct Template {
    statements: Vec<(Location, Statement)>,
}

enum Statement {
    Assign(u32, Expression),
    Primitive(u32, Vec<Expression>),
}

impl Template {
    /// Adds what stands between two `*`.
    ///
    /// # Errors
    /// `macro-expression`, and `macro-primitive` for what is neither a primitive nor an assignment.
    pub(super) fn push(&mut self, location: Location, text: &[u8]) -> Outcome {
        let text = text.trim_ascii();
        // Primitive 0 is a comment.
        if text.first() == Some(&b'0') {
            return Ok(());
        }
        let statement = match text.strip_prefix(b"$") {
            Some(rest) => {
                let mut sides = rest.splitn(2, |c| *c == b'=');
                let variable = sides.next().and_then(|name| whole(name.trim_ascii()));
                let (Some(variable), Some(value)) = (variable, sides.next()) else {
                    let help = "a variable is set by $4=$1x0.5";
                    return Err(fault(Rule::MacroExpression, "not an assignment", help));
                };
                Statement::Assign(variable, Expression::of(value)?)
            }
            None => {
                let mut fields = text.split(|c| *c == b',');
                let code = fields.next().and_then(|code| whole(code.trim_ascii()));
                let Some(code) = code else {
                    let help = "a primitive begins with its number, such as 1,1,0.5,0,0";
                    return Err(fault(
                        Rule::MacroPrimitive,
                        "a primitive without its number",
                        help,
                    ));
                };
                Statement::Primitive(code, fields.map(Expression::of).collect::<Outcome<_>>()?)
            }
        };
        self.statements.push((location, statement));
        Ok(())
    }

    /// The pieces of the aperture that the values `$1`, `$2` and so on make of it, for a unit of so many
    /// mm.
    ///
    /// # Errors
    /// What is wrong, with the location of the statement.
    pub(super) fn pieces(
        &self,
        values: &[f64],
        unit: f64,
        budget: &mut Budget,
    ) -> Result<Vec<Piece>, (Location, Fault)> {
        let mut variables: Variables = (1..).zip(values.iter().copied()).collect();
        let mut pieces = Vec::new();
        for (location, statement) in &self.statements {
            let drawn: Outcome<Vec<Piece>> = match statement {
                Statement::Assign(variable, value) => budget
                    .spend(value.steps())
                    .and_then(|()| value.value(&variables))
                    .map(|value| {
                        variables.insert(*variable, value);
                        Vec::new()
                    }),
                Statement::Primitive(code, values) => budget
                    .spend(1 + values.iter().map(Expression::steps).sum::<usize>())
                    .and_then(|()| values.iter().map(|value| value.value(&variables)).collect())
                    .and_then(|values: Vec<f64>| primitive::pieces(*code, &values, unit)),
            };
            let drawn = drawn.and_then(|drawn| {
                drawn.iter().try_for_each(near)?;
                budget.spend(drawn.len())?;
                Ok(drawn)
            });
            pieces.extend(drawn.map_err(|fault| (*location, fault))?);
        }
        Ok(pieces)
    }

    /// Whether it uses a primitive that is deprecated (chapter 8).
    pub(super) fn is_deprecated(&self) -> bool {
        let old = |(_, statement): &(Location, Statement)| {
            matches!(statement, Statement::Primitive(2 | 6 | 22, _))
        };
        self.statements.iter().any(old)
    }
}

/// Refuses a piece that is out of this world.
fn near(piece: &Piece) -> Outcome {
    let far = |contour: &Contour| {
        let (low, high) = contour.extents();
        low.abs().max(high.abs()).max_element() > FAR
    };
    match piece.contours.iter().any(far) {
        true => {
            let message = format!("a primitive that reaches beyond {FAR} mm");
            Err(fault(
                Rule::MacroValue,
                message,
                "correct the macro, or the values that %AD gives it",
            ))
        }
        false => Ok(()),
    }
}
