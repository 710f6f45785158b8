//! R parameters, and the variables that a program defines.

use super::scan::Name;
use super::value::{Kind, Value};
use crate::sinumerik::models::Facts;
use program::Feed;
use std::collections::HashMap;

/// What a block can read: the values before it. Axes are X, Y, Z, A, B, C; lengths mm, angles degrees; NaN is what is not
/// known.
pub(crate) trait Readable {
    /// The variables of the program.
    fn locals(&self) -> &Locals;

    /// The R parameters.
    fn parameters(&self) -> &Parameters;

    /// What the model of the control reads otherwise than the others.
    fn facts(&self) -> &'static Facts;

    /// Whether lengths are programmed in mm and as radii.
    fn counts_plainly(&self) -> bool;

    /// The position of an axis in the frame of the program.
    fn position_of(&self, axis: usize) -> f64;

    /// The position of an axis of the machine.
    fn machine_position_of(&self, axis: usize) -> f64;

    /// The translation of the programmable frame along an axis.
    fn translation(&self, axis: usize) -> f64;

    /// A settable offset along an axis, by the number of its G command.
    fn work_offset(&self, number: u32, axis: usize) -> f64;

    /// The feed that holds.
    fn active_feed(&self) -> Option<Feed>;

    /// The cutting edge that is active.
    fn edge(&self) -> Option<u32>;
    /// Whether it is known, and not as the machine data have it.
    fn edge_is_known(&self) -> bool;

    /// The number of the tool, where it is called by one.
    fn tool_number(&self) -> Option<u32>;
}

/// How many R parameters there are (`R0` to `R999`; the machine's builder says how many, MD28050).
pub(super) const R_PARAMETERS: usize = 1000;

/// Most elements of the variables of a program; our own limit.
pub(super) const MOST_ELEMENTS: usize = 1 << 14;

/// So many elements set cost as much as one turn of a loop.
pub(crate) const ELEMENTS_IN_A_TURN: usize = 64;

/// What is known of an R parameter.
#[derive(Clone, Copy)]
pub(crate) enum Parameter {
    /// A block has set it.
    Set(f64),
    /// The operator sets it at the machine.
    Operator,
    /// Nothing: it keeps what another program has left there.
    Unknown,
}

/// The R parameters.
pub(crate) struct Parameters {
    values: Vec<Parameter>,
}

impl Parameters {
    /// Before a program: those of the operator, and no other.
    pub fn new(operator: &[u32]) -> Parameters {
        let mut values = vec![Parameter::Unknown; R_PARAMETERS];
        for index in operator {
            if let Some(place) = values.get_mut(*index as usize) {
                *place = Parameter::Operator;
            }
        }
        Parameters { values }
    }

    /// Sets a parameter (an index beyond the last is checked where it is read).
    pub fn set(&mut self, index: usize, value: f64) {
        if let Some(place) = self.values.get_mut(index) {
            *place = Parameter::Set(value);
        }
    }

    /// What is known of a parameter.
    pub fn get(&self, index: usize) -> Parameter {
        self.values.get(index).copied().unwrap_or(Parameter::Unknown)
    }
}

/// A variable: one value, or an array of up to three dimensions.
#[derive(Clone, Debug)]
pub(crate) struct Variable {
    /// Its type.
    pub kind: Kind,
    /// Length of each dimension; none for a single value.
    pub sizes: Vec<usize>,
    /// Its elements, the last dimension fastest; an axis that has none yet is `None`.
    pub values: Vec<Option<Value>>,
}

/// The variables that one program has defined (Job Planning: local user variables).
#[derive(Default)]
pub(crate) struct Locals {
    names: HashMap<Name, usize>,
    variables: Vec<Variable>,
    elements: usize,
}

impl Locals {
    /// The index of the variable of that name.
    #[inline]
    pub fn find(&self, name: &Name) -> Option<usize> {
        if self.variables.is_empty() { None } else { self.names.get(name).copied() }
    }

    /// The variable with that index.
    pub fn get(&self, index: usize) -> Option<&Variable> {
        self.variables.get(index)
    }

    /// Adds a variable.
    ///
    /// # Errors
    /// What to say where there is one of that name, or too much.
    pub fn define(&mut self, name: Name, variable: Variable) -> Result<(), String> {
        self.elements += variable.values.len();
        if self.elements > MOST_ELEMENTS {
            return Err(format!("the variables have more than {MOST_ELEMENTS} elements"));
        }
        if self.names.insert(name, self.variables.len()).is_some() {
            return Err(format!("{} is defined twice", name.as_str()));
        }
        self.variables.push(variable);
        Ok(())
    }

    /// Sets elements of a variable from `element` on (a place beyond the last is checked where it is
    /// read).
    pub fn set(&mut self, index: usize, element: usize, value: Value) {
        let place = self.variables.get_mut(index).and_then(|v| v.values.get_mut(element));
        if let Some(place) = place {
            *place = Some(value);
        }
    }

    /// Replaces all elements of a variable.
    pub fn replace(&mut self, index: usize, values: Vec<Option<Value>>) {
        if let Some(variable) = self.variables.get_mut(index) {
            variable.values = values;
        }
    }
}

/// Where a value can be assigned to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AssignmentTarget {
    /// An R parameter.
    Parameter(usize),
    /// An element of a variable.
    Element(usize, usize),
    /// Component of a settable work offset: its number, its axis.
    WorkOffset(u32, usize),
}
