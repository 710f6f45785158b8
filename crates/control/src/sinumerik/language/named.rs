//! What a name in an expression stands for: R parameters, variables and their elements.

use super::expression::{Evaluator, Operand, without_offset};
use super::scan::{Name, Scanner};
use super::system;
use super::value::{Kind, LONGEST_TEXT, Value};
use super::variables::{AssignmentTarget, Parameter, R_PARAMETERS, Variable};
use crate::kernel::Outcome;
use program::Rule;

impl Evaluator<'_> {
    /// Whether that name is a variable of the program.
    pub fn is_variable(&self, name: &Name) -> bool {
        self.state.locals().find(name).is_some()
    }

    /// Takes what a value is assigned to.
    pub fn place(&self, scanner: &mut Scanner) -> Outcome<AssignmentTarget> {
        let start = scanner.at;
        match (scanner.peek(), scanner.peek_at(1)) {
            (b'$', _) => system::place(self, scanner),
            (b'R', next) if !scanner.name_next() && next != b'=' => {
                scanner.at += 1;
                self.index(scanner).map(AssignmentTarget::Parameter)
            }
            _ => {
                let name = scanner.name()?;
                let index = self.state.locals().find(&name);
                let variable = index.and_then(|i| Some((i, self.state.locals().get(i)?)));
                let Some((index, variable)) = variable else {
                    let message = format!("'{}' is not a variable (alarm 12550)", name.as_str());
                    let mut error = scanner.error_since(start, Rule::UnknownWord, message);
                    error.help = "a variable needs its DEF in the same program".into();
                    return Err(error);
                };
                self.element(scanner, variable)
                    .map(|element| AssignmentTarget::Element(index, element))
            }
        }
    }

    /// The type of a place, and how many elements there are from it on.
    pub fn room(&self, place: AssignmentTarget) -> (Kind, usize) {
        match place {
            AssignmentTarget::Element(index, element) => match self.state.locals().get(index) {
                Some(variable) if variable.sizes.is_empty() => (variable.kind, 1),
                Some(variable) => (variable.kind, variable.values.len().saturating_sub(element)),
                None => (Kind::Real, 0),
            },
            AssignmentTarget::Parameter(_) | AssignmentTarget::WorkOffset(..) => (Kind::Real, 1),
        }
    }

    /// Takes a variable that is the whole argument of a call: its index and element, and its value.
    #[allow(clippy::type_complexity, reason = "it is taken apart at once")]
    pub fn variable_alone(
        &self,
        scanner: &mut Scanner,
    ) -> Outcome<Option<((usize, Option<usize>), Option<Value>)>> {
        let back = scanner.at;
        if !scanner.name_next() {
            return Ok(None);
        }
        let name = scanner.name()?;
        let index = self.state.locals().find(&name);
        if let Some((index, variable)) = index.and_then(|i| Some((i, self.state.locals().get(i)?)))
        {
            let array = !variable.sizes.is_empty() && scanner.peek() != b'[';
            let element = if array { None } else { Some(self.element(scanner, variable)?) };
            scanner.blanks();
            if matches!(scanner.peek(), b',' | b')') {
                let value = element.and_then(|e| variable.values.get(e).cloned().flatten());
                return Ok(Some(((index, element), value)));
            }
        }
        scanner.at = back;
        Ok(None)
    }

    /// Takes the index of an R parameter behind its `R`.
    pub fn index(&self, scanner: &mut Scanner) -> Outcome<usize> {
        let start = scanner.at;
        let index = if scanner.take(b'[') {
            let index = Evaluator::new(self.state, self.assigned).expression(scanner)?;
            scanner.expect(b']')?;
            if index.fract() == 0.0 && index >= 0.0 { index as usize } else { R_PARAMETERS }
        } else {
            scanner.integer()? as usize
        };
        if index < R_PARAMETERS {
            return Ok(index);
        }
        Err(scanner.error_since(start, Rule::RParameter, "there are R0 to R999"))
    }

    /// Takes the element in brackets of a variable, where it is an array.
    pub fn element(&self, scanner: &mut Scanner, variable: &Variable) -> Outcome<usize> {
        let start = scanner.at;
        let mut element = 0;
        for (i, size) in variable.sizes.iter().enumerate() {
            scanner.expect(if i == 0 { b'[' } else { b',' })?;
            let at = scanner.at;
            let index = Evaluator::new(self.state, self.assigned).expression(scanner)?;
            if index.fract() != 0.0 || !(0.0..*size as f64).contains(&index) {
                let message = format!("index {index} of an array that goes from 0 to {}", size - 1);
                return Err(scanner.error_since(at, Rule::ArrayIndex, message));
            }
            element = element * size + index as usize;
        }
        if !variable.sizes.is_empty() {
            scanner.expect(b']')?;
        }
        if element < variable.values.len() {
            return Ok(element);
        }
        Err(scanner.error_since(start, Rule::ArrayIndex, "the array has no such element"))
    }

    /// Takes an R parameter: its value. That of the operator is added where it is named by its number.
    pub(super) fn parameter(&self, scanner: &mut Scanner) -> Outcome<Operand> {
        let start = scanner.at;
        scanner.at += 1;
        let by_number = scanner.digit_next();
        let index = self.index(scanner)?;
        let operator = ["AND", "OR", "XOR", "DIV", "MOD", "B_AND", "B_OR", "B_XOR"];
        let back = scanner.at;
        if scanner.name_goes_on() && !operator.iter().any(|word| scanner.take_word(word)) {
            return Err(scanner.error_here(
                Rule::Syntax,
                "a blank is missing: letters behind an R parameter would read as its name",
            ));
        }
        scanner.at = back;
        let found = self.parameter_value(scanner, start, index)?;
        if by_number { Ok(found) } else { without_offset(scanner, start, found).map(Operand::from) }
    }

    /// The value of an R parameter, whose name stands from `start`.
    pub(super) fn parameter_value(
        &self,
        scanner: &Scanner,
        start: usize,
        index: usize,
    ) -> Outcome<Operand> {
        if self.assigned.iter().any(|(place, _)| *place == AssignmentTarget::Parameter(index)) {
            return Err(scanner.error_since(
                start,
                Rule::RParameter,
                format!("R{index} is set and read in one block"),
            ));
        }
        match self.state.parameters().get(index) {
            Parameter::Set(value) => Ok(Value::Real(value).into()),
            Parameter::Operator => Ok(Operand { value: Value::Real(0.0), offset: Some(index) }),
            Parameter::Unknown => {
                let message = format!("R{index} is read, and no block before has set it");
                let mut error = scanner.error_since(start, Rule::RParameter, message);
                error.help = format!(
                    "set it in the program; or, where the operator sets it, write \
                     operator_parameters = [\"R{index}\"] into the machine file"
                );
                Err(error)
            }
        }
    }

    /// The value of the variable `index`, whose name stands from `start`, or of one of its elements.
    pub fn variable(&self, scanner: &mut Scanner, start: usize, index: usize) -> Outcome<Value> {
        let Some(variable) = self.state.locals().get(index) else {
            return Err(scanner.error_since(start, Rule::UnknownWord, "there is no such variable"));
        };
        let element = self.element(scanner, variable)?;
        if self
            .assigned
            .iter()
            .any(|(place, _)| *place == AssignmentTarget::Element(index, element))
        {
            let message = "the variable is set and read in one block";
            return Err(scanner.error_since(start, Rule::Variable, message));
        }
        match variable.values.get(element) {
            Some(Some(Value::Text(text))) if scanner.peek() == b'[' => {
                scanner.at += 1;
                let at = Evaluator::new(self.state, self.assigned)
                    .within(scanner, 0..=LONGEST_TEXT as u32)?;
                scanner.expect(b']')?;
                let byte = text.as_bytes().get(at as usize).copied();
                byte.map(Value::Char).ok_or_else(|| {
                    let message = format!("character {at} of a text of {}", text.len());
                    scanner.error_since(start, Rule::ArrayIndex, message)
                })
            }
            Some(Some(value)) => Ok(value.clone()),
            _ => {
                let message = "the variable is read, and no block before has set it";
                Err(scanner.error_since(start, Rule::Variable, message))
            }
        }
    }
}
