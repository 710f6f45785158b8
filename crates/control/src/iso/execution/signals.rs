//! Outputs and inputs of the machine, and what its builder has added: nothing moves for them, and they are what a
//! gripper, a valve or a beam hangs on.

use super::step::Step;
use crate::event::Action;
use crate::iso::language::Fault;
use crate::iso::language::words::{Group, M};
use program::{Auxiliary, Input, Output, OutputValue, Rule, Until};

impl Step<'_, '_, '_> {
    /// `M62` to `M68` of LinuxCNC ("M codes"), and the M functions of the builder.
    pub(super) fn signals(&mut self) -> Result<(), Fault> {
        match self.block.m(Group::Output) {
            Some(M::Digital { on, with_motion }) => {
                let number = self.needs(b'P')?;
                let value = OutputValue::Digital(on);
                self.actions.push(Action::Output(Output { number, value, with_motion }));
            }
            Some(M::Analog { with_motion }) => {
                let number = self.needs(b'E')?;
                let Some(value) = self.block.take(b'Q') else { return Err(self.lacks(b'Q')) };
                let value = OutputValue::Analog(value.value);
                self.actions.push(Action::Output(Output { number, value, with_motion }));
            }
            Some(M::Input) => self.input()?,
            Some(M::Program(number)) => {
                let values = [b'P', b'Q'].map(|letter| self.block.take(letter).map(|w| w.value));
                self.actions.push(Action::Auxiliary(Auxiliary { number, values }));
            }
            _ => {}
        }
        let added = self.block.auxiliary.iter().copied();
        self.actions.extend(added.map(Auxiliary::of).map(Action::Auxiliary));
        Ok(())
    }

    /// `M66 P- | E- L- Q-`: without L, or with L0, the input is read at once, and an analog one is never waited for;
    /// any other L needs a time in Q.
    fn input(&mut self) -> Result<(), Fault> {
        let wrong = |step: &Self, message: &str| {
            Err(step.block.at_group(Group::Output, Rule::Input, message))
        };
        let (digital, analog) = (self.take_whole(b'P')?, self.take_whole(b'E')?);
        let way = self.take_whole(b'L')?.unwrap_or(0);
        let timeout = self.block.take(b'Q').map_or(0.0, |word| word.value);
        let (number, until) = match (digital, analog, way) {
            (Some(number), None, 0) => (number, Until::Read),
            (Some(number), None, 1) => (number, Until::Rise),
            (Some(number), None, 2) => (number, Until::Fall),
            (Some(number), None, 3) => (number, Until::High),
            (Some(number), None, 4) => (number, Until::Low),
            (None, Some(number), 0) => (number, Until::ReadAnalog),
            (None, Some(_), _) => return wrong(self, "an analog input (E) is read at once: L0"),
            (Some(_), None, _) => return wrong(self, "L is 0 to 4"),
            _ => return wrong(self, "either P or E says which input"),
        };
        let waits = !matches!(until, Until::Read | Until::ReadAnalog);
        if !timeout.is_finite() || timeout < 0.0 || (waits && timeout == 0.0) {
            return wrong(self, "Q says how many seconds it waits at the most, more than 0");
        }
        self.actions.push(Action::Input(Box::new(Input { number, until, timeout })));
        Ok(())
    }

    /// The whole number of a letter that must be there.
    fn needs(&mut self, letter: u8) -> Result<u32, Fault> {
        self.take_whole(letter)?.ok_or_else(|| self.lacks(letter))
    }

    fn lacks(&self, letter: u8) -> Fault {
        let message = format!("{} is missing", char::from(letter));
        self.block.at_group(Group::Output, Rule::Output, message)
    }
}
