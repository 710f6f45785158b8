//! Definitions: `DEF` of variables, and the `PROC` line of a program with parameters.

use super::expression::Evaluator;
use super::scan::{Name, Scanner};
use super::value::{Kind, LONGEST_TEXT, Value};
use super::variables::{MOST_ELEMENTS, Variable};
use super::words::reserved;
use crate::kernel::Outcome;
use program::Rule;

/// Most dimensions of an array.
const DIMENSIONS: usize = 3;

/// What the elements of an array are set to, from the first one named on.
pub(super) enum Filling {
    /// `SET(...)` or `(...)`: one after the other; what is left out stays as it is.
    Each(Vec<Option<Value>>),
    /// `REP(value)`, `REP(value, count)`.
    All(Value, Option<usize>),
}

impl Filling {
    /// Takes the values behind `=`, where they are those of an array.
    pub fn read(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Option<Filling>> {
        if scanner.take_word("REP") {
            scanner.expect(b'(')?;
            let value = evaluator.value(scanner)?;
            let count = match scanner.take(b',') {
                true => Some(evaluator.within(scanner, 0..=MOST_ELEMENTS as u32)? as usize),
                false => None,
            };
            scanner.expect(b')')?;
            return Ok(Some(Filling::All(value, count)));
        }
        let back = scanner.at;
        if !scanner.take_word("SET") && !scanner.take(b'(') {
            return Ok(None);
        }
        scanner.at = back;
        scanner.take_word("SET");
        scanner.expect(b'(')?;
        let mut values = Vec::new();
        loop {
            scanner.blanks();
            values.push(match scanner.peek() {
                b',' | b')' => None,
                _ => Some(evaluator.value(scanner)?),
            });
            if scanner.take(b')') {
                return Ok(Some(Filling::Each(values)));
            }
            scanner.expect(b',')?;
        }
    }

    /// The elements of an array of `kind` with `room` of them left, each by its number.
    ///
    /// # Errors
    /// What to say where they do not fit.
    pub fn elements(self, kind: Kind, room: usize) -> Result<Vec<(usize, Value)>, String> {
        let count = match &self {
            Filling::Each(values) => values.len(),
            Filling::All(_, count) => count.unwrap_or(room),
        };
        if count > room {
            return Err(format!("{count} values for {room} elements of the array"));
        }
        match self {
            Filling::Each(values) => values
                .into_iter()
                .enumerate()
                .filter_map(|(i, value)| Some((i, value?)))
                .map(|(i, value)| Ok((i, kind.keep(value)?)))
                .collect(),
            Filling::All(value, _) => {
                let value = kind.keep(value)?;
                Ok((0..count).map(|i| (i, value.clone())).collect())
            }
        }
    }
}

/// Takes a type.
fn kind(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Kind> {
    scanner.blanks();
    let start = scanner.at;
    let name = scanner.name()?;
    Ok(match name.as_str() {
        "REAL" => Kind::Real,
        "INT" => Kind::Int,
        "BOOL" => Kind::Bool,
        "CHAR" => Kind::Char,
        "AXIS" => Kind::Axis,
        "STRING" => {
            scanner.expect(b'[')?;
            let most = evaluator.within(scanner, 1..=LONGEST_TEXT as u32)?;
            scanner.expect(b']')?;
            Kind::Text(most as usize)
        }
        "FRAME" => {
            let message = "variables of the type FRAME are not supported";
            return Err(scanner.error_since(start, Rule::Unsupported, message));
        }
        other => {
            let message =
                format!("'{other}' is not a type: REAL, INT, BOOL, CHAR, STRING[n], AXIS");
            return Err(scanner.error_since(start, Rule::Definition, message));
        }
    })
}

/// Takes the name of a new variable: it begins with two letters or underscores and means nothing else.
fn new_name(scanner: &mut Scanner) -> Outcome<Name> {
    scanner.blanks();
    let start = scanner.at;
    if !scanner.name_next() {
        let message = "the name of a variable begins with two letters or underscores";
        return Err(scanner.error_here(Rule::Definition, message));
    }
    let name = scanner.name()?;
    if reserved(name.as_str()) {
        let message = format!("{} is a word of the language (alarm 12170)", name.as_str());
        return Err(scanner.error_since(start, Rule::Definition, message));
    }
    Ok(name)
}

/// Takes the dimensions of an array in brackets; none where no bracket comes.
fn sizes(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Vec<usize>> {
    let mut sizes = Vec::new();
    if !scanner.take(b'[') {
        return Ok(sizes);
    }
    loop {
        sizes.push(evaluator.within(scanner, 1..=MOST_ELEMENTS as u32)? as usize);
        if scanner.take(b']') {
            return Ok(sizes);
        }
        scanner.expect(b',')?;
        if sizes.len() == DIMENSIONS {
            return Err(scanner.error_here(Rule::Definition, "an array has at most 3 dimensions"));
        }
    }
}

/// Takes the variables behind `DEF`.
pub(super) fn define(
    scanner: &mut Scanner,
    evaluator: &Evaluator,
) -> Outcome<Vec<(Name, Variable)>> {
    let kind = kind(scanner, evaluator)?;
    let mut variables = Vec::new();
    loop {
        scanner.blanks();
        let start = scanner.at;
        let name = new_name(scanner)?;
        let sizes = sizes(scanner, evaluator)?;
        let count = sizes.iter().try_fold(1usize, |all, size| all.checked_mul(*size));
        let Some(count) = count.filter(|count| *count <= MOST_ELEMENTS) else {
            let message = format!("an array has at most {MOST_ELEMENTS} elements");
            return Err(scanner.error_since(start, Rule::Definition, message));
        };
        let mut variable = Variable { kind, sizes, values: vec![kind.initial(); count] };
        if scanner.take(b'=') {
            let start = scanner.at;
            let array = !variable.sizes.is_empty();
            let filling = if array { Filling::read(scanner, evaluator)? } else { None };
            let filling = match filling {
                Some(filling) => filling,
                None => Filling::Each(vec![Some(evaluator.value(scanner)?)]),
            };
            let elements = filling
                .elements(kind, count)
                .map_err(|message| scanner.error_since(start, Rule::Type, message))?;
            for (place, value) in elements {
                if let Some(element) = variable.values.get_mut(place) {
                    *element = Some(value);
                }
            }
        }
        variables.push((name, variable));
        if !scanner.take(b',') {
            return Ok(variables);
        }
    }
}

/// A parameter of a program.
pub(crate) struct Formal {
    /// Its name.
    pub name: Name,
    /// Its type.
    pub kind: Kind,
    /// Whether the caller's variable itself is meant (`VAR`).
    pub by_reference: bool,
    /// How many dimensions it has, where it is an array.
    pub dimensions: usize,
    /// What it is where the call leaves it out.
    pub default: Option<Value>,
}

/// A `PROC` line.
#[derive(Default)]
pub(crate) struct Signature {
    /// The parameters in the order of a call.
    pub parameters: Vec<Formal>,
    /// `SAVE`: the caller gets back its modal G commands and its frame.
    pub save: bool,
}

impl Signature {
    /// Takes the name, the parameters and the attributes behind `PROC` (or `EXTERN`, which names types
    /// only).
    pub fn read(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Signature> {
        let mut signature = Signature::default();
        scanner.blanks();
        scanner.name()?;
        if scanner.take(b'(') && !scanner.take(b')') {
            loop {
                signature.parameters.push(Formal::read(scanner, evaluator)?);
                if scanner.take(b')') {
                    break;
                }
                scanner.expect(b',')?;
            }
        }
        while !scanner.rests() {
            let start = scanner.at;
            match scanner.name()?.as_str() {
                "SAVE" => signature.save = true,
                // What the operator sees, and where a single block stops.
                "SBLOF" | "SBLON" | "DISPLOF" | "DISPLON" | "ACTBLOCNO" => {}
                other => {
                    let message = format!("'{other}' is not an attribute of a program known here");
                    let end = scanner.at.max(start + 1);
                    return Err(scanner.source.error(Rule::Unsupported, start..end, message));
                }
            }
        }
        Ok(signature)
    }
}

impl Formal {
    fn read(scanner: &mut Scanner, evaluator: &Evaluator) -> Outcome<Formal> {
        let by_reference = scanner.take_word("VAR");
        let kind = kind(scanner, evaluator)?;
        scanner.blanks();
        let unnamed = !scanner.name_next();
        let name = if unnamed { None } else { Some(new_name(scanner)?) };
        let mut dimensions = 0;
        if scanner.take(b'[') {
            dimensions = 1;
            while !scanner.take(b']') {
                if scanner.take(b',') {
                    dimensions += 1;
                } else {
                    evaluator.within(scanner, 1..=MOST_ELEMENTS as u32)?;
                }
            }
        }
        let default = match scanner.take(b'=') {
            true => {
                let start = scanner.at;
                let value = kind.keep(evaluator.value(scanner)?);
                Some(value.map_err(|message| scanner.error_since(start, Rule::Type, message))?)
            }
            false => kind.initial(),
        };
        // EXTERN names no names.
        let name = name
            .or_else(|| Name::of("_"))
            .ok_or_else(|| scanner.error_here(Rule::Definition, "the parameter has no name"))?;
        Ok(Formal { name, kind, by_reference, dimensions, default })
    }
}
