//! The parameters of RS274/NGC and the variables of macro B: what a program has set.

use super::value::{Target, Value};
use crate::iso::dialects::facts::Language;
use std::collections::HashMap;

/// Arguments of a call and what a subprogram keeps for itself: `#1` to `#30`, in macro B to `#33`.
pub(crate) type Locals = [Value; 34];

/// Values by name, lower case and without blanks.
type Names = HashMap<Box<[u8]>, f64>;

/// What has been set. A call adds a level of local values.
#[derive(Debug)]
pub(crate) struct Parameters {
    pub language: Language,
    /// Global ones by number; the outer `None` is what no block has set.
    common: Vec<Option<Value>>,
    names: Names,
    levels: Vec<(Locals, Names)>,
    /// What the last `return` or `endsub` has given back.
    pub returned: Option<f64>,
}

/// What an expression can read.
#[derive(Clone, Copy)]
pub(crate) struct Values<'v> {
    pub parameters: &'v Parameters,
    pub system: &'v dyn System,
    /// The control has just been switched on and everything in it is 0.
    pub fresh: bool,
    pub line: u32,
}

/// What a control says of itself.
///
/// # Errors
/// Only the machine knows it, or there is no such value.
pub(crate) trait System {
    /// LinuxCNC's parameter of that number, from 5001 on.
    fn ngc_parameter(&self, values: &Values, number: u32) -> Result<f64, String>;

    /// LinuxCNC's predefined parameter of that name (lower case); none where there is none.
    fn ngc_named(&self, values: &Values, name: &[u8]) -> Option<Result<f64, String>>;

    /// FANUC's system variable of that number.
    fn macro_variable(&self, values: &Values, number: u32) -> Result<f64, String>;
}

/// Names that programs cannot set.
const NGC_NAMES: [&[u8]; 59] = [
    b"_x",
    b"_y",
    b"_z",
    b"_a",
    b"_b",
    b"_c",
    b"_u",
    b"_v",
    b"_w",
    b"_metric",
    b"_imperial",
    b"_feed",
    b"_rpm",
    b"_current_tool",
    b"_selected_tool",
    b"_plane",
    b"_absolute",
    b"_incremental",
    b"_inverse_time",
    b"_units_per_minute",
    b"_units_per_rev",
    b"_coord_system",
    b"_ccomp",
    b"_tool_offset",
    b"_retract_r_plane",
    b"_retract_old_z",
    b"_ijk_absolute_mode",
    b"_motion_mode",
    b"_spindle_on",
    b"_spindle_cw",
    b"_spindle_rpm_mode",
    b"_lathe_radius_mode",
    b"_spindle_css_mode",
    b"_lathe_diameter_mode",
    b"_mist",
    b"_flood",
    b"_value",
    b"_value_returned",
    b"_call_level",
    b"_remap_level",
    b"_task",
    b"_line",
    b"_vmajor",
    b"_vminor",
    b"_current_pocket",
    b"_selected_pocket",
    b"_speed_override",
    b"_feed_override",
    b"_adaptive_feed",
    b"_feed_hold",
    b"_abs_x",
    b"_abs_y",
    b"_abs_z",
    b"_abs_a",
    b"_abs_b",
    b"_abs_c",
    b"_abs_u",
    b"_abs_v",
    b"_abs_w",
];

/// Whether this (lower case) is a name of the control's own.
pub(crate) fn is_ngc_name(name: &[u8]) -> bool {
    matches!(name.get(..5), Some(b"_hal[" | b"_ini["))
        || name.first() == Some(&b'_') && NGC_NAMES.contains(&name)
}

impl Parameters {
    /// Before a program.
    pub(crate) fn new(language: Language) -> Parameters {
        let (common, names) = (Vec::new(), Names::new());
        let levels = vec![([None; 34], Names::new())];
        Parameters { language, common, names, levels, returned: None }
    }

    /// How many calls with values of their own are under way.
    pub(crate) fn level(&self) -> usize {
        self.levels.len().saturating_sub(1)
    }

    /// A call begins; without `locals` it goes on with those of the caller.
    pub(crate) fn enter(&mut self, locals: Option<Locals>) {
        let locals = locals.unwrap_or_else(|| *self.locals());
        self.levels.push((locals, Names::new()));
    }

    /// A call has ended: the values it leaves, which the caller takes over where they were its own
    /// (`shared`).
    pub(crate) fn leave(&mut self, shared: bool) -> Locals {
        let left = self.levels.pop().map_or([None; 34], |(locals, _)| locals);
        if shared {
            *self.locals_mut() = left;
        }
        left
    }

    fn locals(&self) -> &Locals {
        const NONE: Locals = [None; 34];
        self.levels.last().map_or(&NONE, |(locals, _)| locals)
    }

    fn locals_mut(&mut self) -> &mut Locals {
        if self.levels.is_empty() {
            self.levels.push(([None; 34], Names::new()));
        }
        let last = self.levels.len() - 1;
        &mut self.levels[last].0
    }

    fn is_local(&self, number: u32) -> bool {
        match self.language {
            Language::Ngc => (1..=30).contains(&number),
            Language::MacroB => (1..=33).contains(&number),
            Language::Rs274 | Language::Plain => false,
        }
    }

    fn is_common(&self, number: u32) -> bool {
        match self.language {
            Language::Ngc => (31..=5000).contains(&number) || number == 5599,
            Language::Rs274 => (1..=5000).contains(&number),
            _ => (100..=199).contains(&number) || (500..=999).contains(&number),
        }
    }

    /// What a parameter holds; none where no block has set it.
    fn own(&self, number: u32) -> Option<Value> {
        if self.is_local(number) {
            let value = self.locals().get(number as usize).copied().flatten();
            // An unset local variable of macro B is null (B-63684EN, 16.1).
            return (value.is_some() || self.language == Language::MacroB).then_some(value);
        }
        self.common.get(number as usize).copied().flatten()
    }

    /// Sets a parameter.
    ///
    /// # Errors
    /// A program cannot set it, and why.
    pub(crate) fn set(&mut self, target: Target, value: Value) -> Result<(), String> {
        match target {
            Target::Number(number) if self.is_local(number) => {
                if let Some(place) = self.locals_mut().get_mut(number as usize) {
                    *place = value;
                }
            }
            Target::Number(number) if self.is_common(number) => {
                let place = number as usize;
                if self.common.len() <= place {
                    self.common.resize(place + 1, None);
                }
                self.common[place] = Some(value);
            }
            Target::Number(number) => {
                return Err(format!("#{number} is not for programs to set"));
            }
            Target::Name(name) => {
                let name = plain(name);
                if is_ngc_name(&name) {
                    return Err(format!("#<{}> can only be read", String::from_utf8_lossy(&name)));
                }
                let names = match name.first() {
                    Some(b'_') => &mut self.names,
                    _ => match self.levels.last_mut() {
                        Some((_, names)) => names,
                        None => &mut self.names,
                    },
                };
                let value = value.unwrap_or(0.0);
                match names.get_mut(&*name) {
                    Some(place) => *place = value,
                    None => {
                        names.insert(name.into(), value);
                    }
                }
            }
        }
        Ok(())
    }

    fn named(&self, name: &[u8]) -> Option<f64> {
        let names = match name.first() {
            Some(b'_') => &self.names,
            _ => self.levels.last().map_or(&self.names, |(_, names)| names),
        };
        names.get(name).copied()
    }
}

impl Values<'_> {
    /// How the program calculates.
    pub(super) fn language(&self) -> Language {
        self.parameters.language
    }

    /// The value of a parameter.
    ///
    /// # Errors
    /// It is not known, or there is no such one.
    pub(super) fn get(&self, target: Target) -> Result<Value, String> {
        match (target, self.parameters.language) {
            (Target::Number(0), Language::MacroB) => Ok(None),
            (Target::Number(number), _) => {
                if let Some(value) = self.parameters.own(number) {
                    return Ok(value);
                }
                if !self.parameters.is_local(number) && !self.parameters.is_common(number) {
                    return match self.parameters.language {
                        Language::MacroB => self.system.macro_variable(self, number).map(Some),
                        Language::Ngc => self.system.ngc_parameter(self, number).map(Some),
                        _ => Err(format!("what #{number} holds is known only at the machine")),
                    };
                }
                match self.parameters.language {
                    Language::Ngc | Language::Rs274 if self.fresh => Ok(Some(0.0)),
                    Language::MacroB if self.fresh && number < 200 => Ok(None),
                    _ => Err(format!(
                        "no block has set #{number}: it holds what another program or the operator \
                         has left there"
                    )),
                }
            }
            (Target::Name(name), _) => {
                let name = plain(name);
                if let Some(value) = self.parameters.named(&name) {
                    return Ok(Some(value));
                }
                let value = self.system.ngc_named(self, &name).unwrap_or_else(|| {
                    Err(format!("no block has set #<{}>", String::from_utf8_lossy(&name)))
                });
                value.map(Some)
            }
        }
    }

    /// Whether there is such a parameter.
    ///
    /// # Errors
    /// Only the machine knows.
    pub(super) fn exists(&self, target: Target) -> Result<bool, String> {
        match target {
            Target::Number(number) => Ok((1..=5601).contains(&number)),
            Target::Name(name) => {
                let name = plain(name);
                if let Some(b"_hal[" | b"_ini[") = name.get(..5) {
                    return Err("only the machine knows which pins and settings it has".into());
                }
                Ok(self.parameters.named(&name).is_some() || is_ngc_name(&name))
            }
        }
    }
}

/// A name in lower case and without blanks.
fn plain(name: &[u8]) -> std::borrow::Cow<'_, [u8]> {
    let as_it_is = |b: &u8| !b.is_ascii_uppercase() && !matches!(b, b' ' | b'\t');
    if name.iter().all(as_it_is) {
        return name.into();
    }
    let kept = name.iter().filter(|b| !matches!(b, b' ' | b'\t'));
    kept.map(u8::to_ascii_lowercase).collect::<Vec<u8>>().into()
}
