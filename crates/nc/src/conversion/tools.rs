//! Tools: their numbers, their lengths, and the length offsets that the program calls.

use super::Conversion;
use crate::pose::ToolPosition;
use crate::refuse;
use control::Action;
use machine::LengthOffset;
use program::{Diagnostic, Op, Outcome, Rule, Tool};

/// The tool in the spindle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Loaded {
    /// Register of its length offset.
    pub(super) register: u32,
    /// Length, where it is known, mm.
    pub(crate) length: Option<f64>,
    /// Whether it has cut with the length offset of the register (`true`) or without any; it has not cut yet without
    /// a value.
    pub(super) offset: Option<bool>,
}

impl Conversion<'_> {
    /// The tool cuts: whether a length offset is on, and whose. The new program calls that of the tool in any case.
    pub(super) fn see_length(&mut self, line: u32) -> Outcome {
        let Some((tool, _)) = &mut self.tool else { return Ok(()) };
        let (register, active) = (tool.register, self.length_offset);
        if tool.offset.replace(active.is_some()).is_some_and(|before| before != active.is_some()) {
            let message = "the tool cuts with its length offset and without: a tool with two lengths cannot be converted";
            let help = "post the parts with the offset and without as programs of their own";
            return Err(refuse(Rule::LengthOffset, message, help));
        }
        match active {
            None if self.bare.insert(register) => {
                let message = format!(
                    "the tool cuts without a length offset (no G43): a control that calls lengths writes register \
                     {register}"
                );
                let help = "where the source counts on a length of 0, set that of the tool to 0 at the new machine";
                let found = Diagnostic::warning(Rule::LengthOffset, message).help(help);
                self.warnings.push(found.line(line));
            }
            Some(active) if active != register => {
                let message = format!(
                    "length offset {active}, which was called before the tool, stays on for it: it is written in \
                     place of {register}"
                );
                let help = "check that the tool is meant to have that length";
                let found = Diagnostic::warning(Rule::LengthOffset, message).help(help);
                self.warnings.push(found.line(line));
                self.correct(active);
            }
            _ => {}
        }
        Ok(())
    }

    /// The tool has another register for its length.
    pub(super) fn correct(&mut self, register: u32) {
        if let Some((tool, _)) = &mut self.tool {
            tool.register = register;
        }
        let mut records = self.program.records.iter_mut().rev();
        let last = records
            .find_map(|record| if let Op::Tool(tool) = &mut record.op { Some(tool) } else { None });
        if let Some(tool) = last {
            tool.offset = Some(register);
        }
    }

    /// Whether this goes by rapid with an empty spindle, from where it stands nobody then knows.
    ///
    /// # Errors
    /// It cuts so.
    pub(super) fn moves_empty(&mut self, action: &Action) -> Outcome<bool> {
        let Some(line) = self.emptied else { return Ok(false) };
        if matches!(action, Action::Rapid(_)) {
            self.tool_at = ToolPosition::Unknown;
            return Ok(true);
        }
        if action.position().is_none() {
            return Ok(false);
        }
        let message = format!("cuts without a tool: line {line} has emptied the spindle (T0)");
        Err(refuse(Rule::Tool, message, "call a tool before the cut"))
    }

    /// Gives a tool that is called by its name a number that no other tool has.
    pub(super) fn number(&mut self, line: u32, tool: &mut Tool) -> Outcome {
        if tool.number > 0 {
            let name = self.numbers.entry(tool.number).or_default();
            if !name.is_empty() {
                let message =
                    format!("T{} is called, and stands for \"{name}\" already", tool.number);
                let help = "give the tools that are called by name their numbers in a tool table";
                return Err(refuse(Rule::ToolNumber, message, help));
            }
            return Ok(());
        }
        if let Some(entry) =
            self.setup.tools.iter().find(|e| e.name.eq_ignore_ascii_case(&tool.name))
        {
            tool.number = entry.number;
            return Ok(());
        }
        if let Some(number) = self.named.get(&tool.name) {
            tool.number = *number;
            return Ok(());
        }
        let free = |n: &u32| {
            !self.numbers.contains_key(n) && self.setup.tools.iter().all(|entry| entry.number != *n)
        };
        tool.number = (self.free_from..).find(free).unwrap_or_default();
        self.free_from = tool.number.saturating_add(1);
        self.numbers.insert(tool.number, tool.name.clone());
        self.named.insert(tool.name.clone(), tool.number);
        let message =
            format!("tool \"{}\" is called by its name, and T{} here", tool.name, tool.number);
        let found = Diagnostic::warning(Rule::ToolNumber, message);
        self.warnings.push(found.help("a tool table gives it a number of your own").line(line));
        Ok(())
    }

    pub(super) fn length_offset(&mut self, line: u32, register: Option<u32>) -> Outcome {
        self.length_offset = register;
        let Some(register) = register else { return Ok(()) };
        let Some((tool, fresh)) = &mut self.tool else {
            let message = format!(
                "length offset {register} is called, and no tool before it: the new program writes the register \
                 of the tool that it calls"
            );
            let found = Diagnostic::warning(Rule::LengthOffset, message);
            let help = "name the tool in the source, or set `default_tool` to the one that has this register";
            self.warnings.push(found.help(help).line(line));
            return Ok(());
        };
        // Where a register is an edge of the tool in the spindle (SINUMERIK's D), the first is the tool
        // itself.
        let edges = self.machine.capabilities.length_offset == LengthOffset::One;
        let own = if edges { 1 } else { tool.register };
        if register == own {
            return Ok(());
        }
        if edges || !*fresh {
            let message = format!(
                "length offset {register} where {own} is the tool's: a tool with two lengths cannot be converted"
            );
            let help = "post the parts with each offset as programs of their own";
            return Err(refuse(Rule::LengthOffset, message, help));
        }
        self.correct(register);
        Ok(())
    }
}
