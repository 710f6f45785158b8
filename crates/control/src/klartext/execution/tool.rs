//! Tools and the blank.

use super::state::{Control, Tip};
use crate::ToolData;
use crate::event::{Action, Risk};
use crate::kernel::Outcome;
use crate::klartext::language::feed;
use crate::klartext::language::feed::feed_word;
use crate::klartext::language::registers::Parameter;
use crate::klartext::language::scan::Scanner;
use crate::klartext::language::words::{LINEAR, Words};
use geom::Vec3;
use program::{Compensation, Diagnostic, Rule, Spindle, Tool};

impl Control<'_, '_> {
    /// `TOOL CALL` and `TOOL DEF`, from behind `TOOL`.
    pub(crate) fn tool(&mut self, s: &mut Scanner) -> Outcome {
        if s.take(b"DEF") {
            return self.define_tool(s);
        }
        s.expect(b"CALL")?;
        let called = match s.peek() {
            [b'"', ..] => {
                let name = String::from_utf8_lossy(s.quoted()?).into_owned();
                Some(Tool { name, ..Tool::default() })
            }
            [b'Q', b'S', ..] => Some(Tool { name: self.tool_name(s)?, ..Tool::default() }),
            [b'0'..=b'9' | b'Q', ..] => {
                Some(Tool { number: self.tool_number(s)?, ..Tool::default() })
            }
            _ => None,
        };
        let (mut axis, mut speed, mut feed) = (false, None, None);
        loop {
            // The digit belongs to the address: `DR2+0.1`.
            let before = *s;
            if let Some(value) = s.peek().strip_prefix(b"DR2") {
                let (_, span) = s.token();
                let mut value = Scanner::within(before, span.1 - value.len(), span.1);
                if value.value(&self.registers)? != 0.0 {
                    return Err(oversize(s, span));
                }
                continue;
            }
            let Some(word) = s.word(&self.registers)? else { break };
            match (word.address, word.number) {
                (b"Z", None) if !axis && word.sign == 0.0 => axis = true,
                (b"X" | b"Y" | b"U" | b"V" | b"W", None) => {
                    return Err(s.error(Rule::Unsupported, word.span, "the tool axis must be Z"));
                }
                (b"S", Some(rpm)) if speed.is_none() && rpm >= 0.0 => speed = Some(rpm),
                (b"F" | b"FU", Some(_)) if feed.is_none() => {
                    feed = Some(feed_word(s, &word, None)?);
                }
                (b"DL" | b"DR", Some(0.0)) => {}
                (b"DL" | b"DR", Some(_)) => return Err(oversize(s, word.span)),
                _ => return Err(feed::unknown(s, &word)),
            }
        }
        if called.is_some() && !axis {
            return Err(s.error_block(Rule::MissingWord, "TOOL CALL needs the tool axis Z"));
        }
        if called.is_none() && speed.is_none() && feed.is_none() {
            return Err(s.error_block(Rule::MissingWord, "TOOL CALL needs a tool, S or F"));
        }
        if let Some(tool) = called {
            self.change_tool(s, tool)?;
        }
        self.tool_feed = feed;
        self.set_feed(s, feed)?;
        let Some(speed) = speed else { return Ok(()) };
        self.speed = Some(speed);
        match self.spindle {
            Spindle::Off => Ok(()),
            Spindle::Clockwise(_) => self.set_spindle(Spindle::Clockwise(speed)),
            Spindle::CounterClockwise(_) => self.set_spindle(Spindle::CounterClockwise(speed)),
        }
    }

    /// `TOOL DEF 5` makes a tool ready; `TOOL DEF 5 L+0 R+4` says what it is, in place of the table.
    fn define_tool(&mut self, s: &mut Scanner) -> Outcome {
        let number = self.tool_number(s)?;
        if s.is_done() {
            return self.emit(Action::Preselect(number));
        }
        let (mut length, mut radius) = (None, None);
        while let Some(word) = s.word(&self.registers)? {
            match (word.address, word.number) {
                (b"L", Some(value)) if length.is_none() => length = Some(value * self.unit),
                (b"R", Some(value)) if radius.is_none() => radius = Some(value * self.unit),
                _ => return Err(feed::unknown(s, &word)),
            }
        }
        let (Some(length), Some(radius)) = (length, radius) else {
            return Err(s.error_block(Rule::MissingWord, "TOOL DEF with data takes L and R"));
        };
        if self
            .settings
            .setup
            .tools
            .iter()
            .any(|tool| tool.number == number && (tool.radius != radius || tool.length != length))
        {
            let message = format!("tool {number} is another one in the tool table");
            return Err(s.error_block(Rule::Tool, message));
        }
        let other = |tool: &ToolData| tool.radius != radius || tool.length != length;
        if self.defined_tools.get(&number).is_some_and(other) {
            let message = format!(
                "tool {number} has been defined with another L or R before: two tools have one number"
            );
            return Err(s.error_block(Rule::ToolTwice, message));
        }
        self.emit(Action::Risk(Risk::OPERATOR_DATA.into()))?;
        self.defined_tools.insert(number, ToolData { number, name: String::new(), radius, length });
        Ok(())
    }

    /// A number that is written, or in a Q parameter.
    fn tool_number(&self, s: &mut Scanner) -> Outcome<u32> {
        let from = *s;
        let unsigned = matches!(s.peek(), [b'0'..=b'9' | b'Q', ..]);
        let number = s.value(&self.registers)?;
        if unsigned && number.fract() == 0.0 && (0.0..=32_767.0).contains(&number) {
            return Ok(number as u32);
        }
        let message = "the number of a tool is a whole number from 0";
        Err(s.error(Rule::Tool, (from.at(), s.at()), message))
    }

    /// A name in a QS parameter.
    fn tool_name(&self, s: &mut Scanner) -> Outcome<String> {
        let from = *s;
        let text = match s.parameter()? {
            Some(Parameter::Text(index)) => self.registers.text(index),
            _ => Err("a QS parameter is expected here".into()),
        };
        text.map(|name| String::from_utf8_lossy(name).into_owned())
            .map_err(|message| s.error(Rule::Parameter, (from.at(), s.at()), message))
    }

    /// The change stops spindle and coolant, goes to a place of its own, and brings another length.
    fn change_tool(&mut self, s: &Scanner, tool: Tool) -> Outcome {
        if self.compensation != Compensation::Off {
            return Err(s.error_block(Rule::Compensation, "a tool is called with R0"));
        }
        if self.tip != Tip::Free {
            let message = "M128 is reset before a tool call";
            let error: Box<Diagnostic> = s.error_block(Rule::ToolCenter, message);
            return Err(error.help("program M129 first").into());
        }
        if let Err(doubt) = self.coolants().allow_change(self.coolant) {
            return Err(s.error_block(Rule::Coolant, doubt.message).help(doubt.help).into());
        }
        self.stop_all()?;
        let mut table = self.settings.setup.tools.iter();
        let data = match tool.name.is_empty() {
            true => table
                .find(|data| data.number == tool.number)
                .or_else(|| self.defined_tools.get(&tool.number)),
            false => table.find(|data| data.name == tool.name),
        };
        self.tool_radius = data.map(|data| data.radius);
        let number = if tool.name.is_empty() { Some(tool.number) } else { data.map(|d| d.number) };
        self.tool_number = number;
        self.has_tool = true;
        self.tool_is_due = true;
        // In which unit an inch program finds them the manuals do not say.
        let metric = if self.unit == 1.0 { data } else { None };
        self.registers.preassign(108, metric.map_or(f64::NAN, |data| data.radius));
        self.registers.preassign(109, 2.0);
        self.registers.preassign(114, metric.map_or(f64::NAN, |data| data.length));
        self.emit(Action::Tool(Box::new(tool)))?;
        self.forget_position();
        Ok(())
    }

    /// `BLK FORM`, from behind `BLK`: the blank, for the screen alone.
    pub(crate) fn blank_form(&mut self, s: &mut Scanner) -> Outcome {
        s.expect(b"FORM")?;
        let is_first = match s.token() {
            (b"0.1", _) => {
                s.expect(b"Z")?;
                true
            }
            (b"0.2", _) => false,
            (b"CYLINDER" | b"ROTATION" | b"FILE", _) => {
                s.skip();
                return Ok(());
            }
            (_, span) => {
                return Err(s.error(Rule::Unsupported, span, "this kind of BLK FORM is not known"));
            }
        };
        let words = Words::read(s, LINEAR, self)?;
        if !words.has_all(LINEAR) || !words.is_plain() {
            return Err(s.error_block(Rule::MissingWord, "BLK FORM takes X, Y and Z"));
        }
        let low = self.blank_low.take();
        let corner = |from: Vec3| {
            Vec3::from_array([0, 1, 2].map(|axis| words.target(axis, from.to_array()[axis])))
        };
        if is_first {
            if words.is_incremental(LINEAR) {
                let message = "BLK FORM 0.1 takes absolute coordinates";
                return Err(s.error_block(Rule::Blank, message));
            }
            self.blank_low = Some(corner(Vec3::ZERO));
            return Ok(());
        }
        let Some(low) = low else {
            let message = "BLK FORM 0.2 without BLK FORM 0.1 before it";
            return Err(s
                .error_block(Rule::Blank, message)
                .help("the MIN point comes first")
                .into());
        };
        if corner(low).cmpgt(low).all() {
            return Ok(());
        }
        let message = "the MAX point of BLK FORM is not above the MIN point in every axis";
        Err(s
            .error_block(Rule::Blank, message)
            .help("give the blank a thickness, or leave both out")
            .into())
    }
}

fn oversize(s: &Scanner, span: (usize, usize)) -> Box<Diagnostic> {
    s.error(Rule::Unsupported, span, "an oversize moves the tool off the programmed path")
        .help("put the wear into the tool table")
        .into()
}
