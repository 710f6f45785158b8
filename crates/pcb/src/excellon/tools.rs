//! The tools of a drill file: their diameters, and whether their holes are plated.

use super::Tool;
use crate::report::{Outcome, fault};
use crate::{FAR, SAME};
use program::Rule;
use std::collections::HashMap;

/// The tools that are known, and the one in the spindle.
pub(super) struct Tools {
    /// In the order of their definition; the diameter is 0 where it is not known yet.
    pub(super) all: Vec<Tool>,
    /// Index by number.
    by_number: HashMap<u32, u32>,
    /// Number of the tool in the spindle; 0 for none.
    selected: u32,
    /// Whether the tools that come next make plated holes, and what for.
    plated: Option<bool>,
    function: Option<String>,
}

impl Tools {
    /// None yet. Names of files distinguish plated holes from others by the habit of KiCad: `board-PTH.drl`,
    /// `board-NPTH.drl`.
    pub(super) fn of_file(name: &str) -> Tools {
        let name = name.rsplit(['/', '\\']).next().unwrap_or_default().to_ascii_uppercase();
        let plated = match (name.contains("NPTH"), name.contains("PTH")) {
            (true, _) => Some(false),
            (false, true) => Some(true),
            (false, false) => None,
        };
        let (all, by_number) = (Vec::new(), HashMap::new());
        Tools { all, by_number, selected: 0, plated, function: None }
    }

    /// Listens to attributes of X2, and to Altium.
    pub(super) fn comment(&mut self, comment: &[u8]) {
        let comment = String::from_utf8_lossy(comment);
        if let Some(attribute) = comment.strip_prefix("#@!") {
            let attribute = attribute.trim();
            if let Some(function) = attribute.strip_prefix("TF.FileFunction,") {
                self.plated = plated_by_function(function).or(self.plated);
            } else if let Some(function) = attribute.strip_prefix("TA.AperFunction,") {
                self.plated = plated_by_function(function).or(self.plated);
                self.function = Some(function.into());
            }
        } else if let Some(kind) = comment.strip_prefix("TYPE=") {
            self.plated = match kind {
                "PLATED" => Some(true),
                "NON_PLATED" => Some(false),
                _ => self.plated,
            };
        }
    }

    /// Defines tool `number`, or gives it a diameter, mm.
    ///
    /// # Errors
    /// `diameter` where that is none, or another than before.
    pub(super) fn define(&mut self, number: u32, diameter: Option<f64>) -> Outcome {
        if let Some(diameter) = diameter
            && !(diameter > 0.0 && diameter <= FAR)
        {
            let message = format!("T{number} has a diameter of {diameter} mm");
            return Err(fault(Rule::Diameter, message, "give it the diameter of the hole"));
        }
        let index = match self.by_number.get(&number) {
            Some(index) => *index,
            None => {
                let index = u32::try_from(self.all.len()).unwrap_or(u32::MAX);
                let (plated, function) = (self.plated, self.function.clone());
                self.all.push(Tool { number, diameter: 0.0, plated, function });
                self.by_number.insert(number, index);
                index
            }
        };
        let (Some(diameter), Some(tool)) = (diameter, self.all.get_mut(index as usize)) else {
            return Ok(());
        };
        if tool.diameter > 0.0 && (diameter - tool.diameter).abs() > SAME {
            let message = format!("T{number} has a diameter of {} mm already", tool.diameter);
            return Err(fault(Rule::Diameter, message, "give every diameter a number of its own"));
        }
        tool.diameter = diameter;
        Ok(())
    }

    /// Puts tool `number` into the spindle; 0 takes it out.
    ///
    /// # Errors
    /// `missing-tool`
    pub(super) fn select(&mut self, number: u32) -> Outcome {
        let known = number == 0 || self.by_number.contains_key(&number);
        self.selected = if known { number } else { 0 };
        if !known {
            let help = "define it in the header, such as T1C0.8";
            return Err(fault(Rule::MissingTool, format!("T{number} is not defined"), help));
        }
        Ok(())
    }

    /// Index of the tool in the spindle.
    ///
    /// # Errors
    /// `no-tool`, `no-diameter`
    pub(super) fn selected(&self) -> Outcome<u32> {
        let Some(index) = self.by_number.get(&self.selected).filter(|_| self.selected != 0) else {
            let help = "select one before the first hole, such as T1";
            return Err(fault(Rule::NoTool, "a hole without a tool", help));
        };
        match self.all.get(*index as usize) {
            Some(tool) if tool.diameter > 0.0 => Ok(*index),
            _ => {
                let message = format!("T{} has no diameter", self.selected);
                Err(fault(Rule::NoDiameter, message, "define it in the header, such as T1C0.8"))
            }
        }
    }
}

/// `Plated,1,2,PTH`, `NonPlated,...`; `MixedPlating` says neither.
fn plated_by_function(function: &str) -> Option<bool> {
    match function.split(',').next() {
        Some("Plated") => Some(true),
        Some("NonPlated") => Some(false),
        _ => None,
    }
}
