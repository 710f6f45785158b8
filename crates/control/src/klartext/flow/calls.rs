//! Labels: subprograms, repetitions, jumps; and calls of other programs.

use super::returns::NESTING;
use super::run::Run;
use super::source::{BlockLocation, LAST_LABEL, Label, written_label};
use crate::kernel::Outcome;
use crate::klartext::language::registers::{Numbers, Parameter, Registers};
use crate::klartext::language::scan::Scanner;
use program::Rule;
use std::borrow::Cow;

/// Opening a called program takes as long as reading so many bytes.
const FILE: usize = 4096;

impl<'t> Run<'t, '_, '_, '_> {
    /// `LBL`: a place, which does nothing where the program passes it, or the end of a subprogram.
    pub(super) fn label(&mut self, s: &mut Scanner) -> Outcome {
        let label = written_label(s)?;
        s.finish()?;
        if label == Label::Number(0)
            && let Some(back) = self.calls.end()
        {
            self.jump(s, back)?;
        }
        Ok(())
    }

    pub(super) fn jump(&mut self, s: &Scanner, to: BlockLocation) -> Outcome {
        let again = self.source.place().offset.saturating_sub(to.offset);
        self.control.count_jump(s, again)?;
        self.source.jump(to);
        Ok(())
    }

    /// `CALL LBL`, `CALL PGM`.
    pub(super) fn call(&mut self, s: &mut Scanner, place: BlockLocation) -> Outcome {
        if s.take(b"PGM") {
            self.control.contour_is_closed(s)?;
            return self.call_program(s);
        }
        s.expect(b"LBL")?;
        let to = self.labelled(s)?;
        if !s.take(b"REP") {
            s.finish()?;
            let back = self.source.place();
            self.calls.call(back).map_err(|message| s.error_block(Rule::Nesting, message))?;
            return self.jump(s, to);
        }
        let times = self.repetitions(s)?;
        if to.offset > place.offset {
            let message = "the label of a repetition stands before its call";
            return Err(s.error_block(Rule::Label, message));
        }
        let again = self.calls.repeat(to, place, times);
        if again.map_err(|message| s.error_block(Rule::Label, message))? {
            self.jump(s, to)?;
        }
        Ok(())
    }

    /// How often a part is repeated: `5`, `Q5`, and `5/5` as older controls show it.
    fn repetitions(&mut self, s: &mut Scanner) -> Outcome<u32> {
        s.is_done();
        let from = *s;
        let (_, number) = s.number_or_parameter(&self.control.registers)?;
        let span = (from.at(), s.at());
        if let Some(times) = number.filter(|n| n.fract() == 0.0 && (1.0..=65_534.0).contains(n)) {
            let times = times as u32;
            if s.take_symbol(b"/") && s.digits(65_534)? != times {
                let message = "a repetition that has begun already cannot be followed";
                return Err(s.error(Rule::Label, span, message));
            }
            s.finish()?;
            return Ok(times);
        }
        Err(s.error(
            Rule::Label,
            span,
            "the number of repetitions is a whole number from 1 to 65534",
        ))
    }

    /// The place of a label that is called: `5`, `"NAME"`, or a Q parameter.
    pub(super) fn labelled(&mut self, s: &mut Scanner) -> Outcome<BlockLocation> {
        s.is_done();
        let from = *s;
        let label = match s.parameter()? {
            None => written_label(s)?,
            Some(parameter) => {
                let span = (from.at(), s.at());
                label_in(&self.control.registers, parameter)
                    .map_err(|message| s.error(Rule::Parameter, span, message))?
            }
        };
        let span = (from.at(), s.at());
        if label == Label::Number(0) {
            return Err(s.error(Rule::Label, span, "LBL 0 ends subprograms and cannot be called"));
        }
        self.source.label(&label)?.ok_or_else(|| {
            s.error(Rule::Label, span, format!("there is no label {label} in this program"))
        })
    }

    /// `CALL PGM NAME`: a program of the folders, in which labels and QL parameters are its own.
    fn call_program(&mut self, s: &mut Scanner) -> Outcome {
        let (name, span) = self.program_name(s)?;
        s.finish()?;
        let depth = self.control.enter_program();
        if depth > NESTING {
            let message = format!("programs are nested more than {NESTING} deep");
            return Err(s.error(Rule::Nesting, span, message));
        }
        let folders = &self.control.settings.setup.folders;
        // The control does not tell capitals from small letters.
        let names = [name.to_ascii_uppercase(), name.to_ascii_lowercase(), name];
        let there = |name: &&String| folders.have(name);
        let [_, _, written] = &names;
        let name = names.iter().rev().find(there).unwrap_or(written);
        let text =
            folders.open(name).map_err(|message| s.error(Rule::CalledProgram, span, message))?;
        self.control.count_jump(s, FILE.saturating_add(text.len()))?;
        let unit = self.control.unit;
        let local = self.control.registers.exchange_local(Numbers::default());
        Run::begin(self.control, name, &text)?.finish()?;
        self.control.registers.exchange_local(local);
        self.control.leave_program();
        self.control.set_unit(unit);
        Ok(())
    }

    /// The name of a called program as a file below the folders.
    fn program_name(&mut self, s: &mut Scanner) -> Outcome<(String, (usize, usize))> {
        s.is_done();
        let from = *s;
        let name = match s.parameter()? {
            Some(Parameter::Text(index)) => {
                let text = self.control.registers.text(index);
                let text = text.map(|text| Cow::Owned(text.to_vec()));
                text.map_err(|message| s.error(Rule::Parameter, (from.at(), s.at()), message))?
            }
            Some(_) => {
                return Err(s.error_here(Rule::Syntax, "the name of a program is expected here"));
            }
            None if s.peek().starts_with(b"\"") => Cow::Borrowed(s.quoted()?),
            None => Cow::Borrowed(s.token().0),
        };
        let span = (from.at(), s.at());
        let name = String::from_utf8_lossy(&name).replace('\\', "/");
        // The folders of the control's drive are not those here: of such a path the file counts.
        let mut name = match name.split_once(':') {
            None => name,
            Some((_, path)) => path.rsplit('/').next().unwrap_or_default().to_owned(),
        };
        // Without a type the called program has that of the one that calls.
        if !name.rsplit('/').next().is_some_and(|file| file.contains('.')) {
            name.push_str(".H");
        }
        if !name.to_ascii_uppercase().ends_with(".H") {
            return Err(s.error(
                Rule::CalledProgram,
                span,
                "only Klartext programs (.H) can be called",
            ));
        }
        Ok((name, span))
    }
}

/// The label that a Q parameter holds.
fn label_in<'r>(registers: &Registers, parameter: Parameter) -> Result<Label<'r>, String> {
    if let Parameter::Text(index) = parameter {
        let name = registers.text(index)?;
        return Ok(Label::Name(Cow::Owned(name.to_vec())));
    }
    let number = registers.number(parameter)?;
    if number.fract() != 0.0 || !(0.0..=f64::from(LAST_LABEL)).contains(&number) {
        return Err(format!("{parameter} is {number}, which is no label"));
    }
    Ok(Label::Number(number as u32))
}
