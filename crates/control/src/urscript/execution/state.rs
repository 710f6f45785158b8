//! What a program has set.

use crate::ArmAction;
use crate::kernel::Channel;
use crate::kernel::arm::MOST_VARIABLES;
use crate::urscript::language::{Readable, Scan, Scope, Value};
use geom::Frame;
use program::{Outcome, Rule};
use std::collections::HashMap;

/// What is active. The tool and the load are as the installation says them, before the program does.
pub(in crate::urscript) struct State {
    globals: HashMap<Box<str>, Value>,
    /// Those of the functions that have been called, the inmost last.
    locals: Vec<HashMap<Box<str>, Value>>,
    count: usize,
    /// The `v` of the last line or arc, m/s.
    pub(super) speed: Option<f64>,
    /// The `v` of the last motion of joints, rad/s.
    pub(super) joint_rate: Option<f64>,
    /// The `a` of the last line or arc, m/s2, and of the last motion of joints, rad/s2.
    pub(super) tip_acceleration: Option<f64>,
    pub(super) joint_acceleration: Option<f64>,
    /// The name of the operator's function that changes tools.
    pub(super) tool_change: String,
}

impl Readable for State {
    fn value(&self, name: &str) -> Option<Value> {
        let local = self.locals.last().and_then(|locals| locals.get(name));
        local.or_else(|| self.globals.get(name)).cloned()
    }
}

impl State {
    pub(in crate::urscript) fn new(tool_change: &str) -> State {
        State {
            globals: HashMap::new(),
            locals: vec![HashMap::new()],
            count: 0,
            speed: None,
            joint_rate: None,
            tip_acceleration: None,
            joint_acceleration: None,
            tool_change: tool_change.into(),
        }
    }

    /// What holds before the first line: poses count in the base of the robot, and the tool is that of the installation.
    pub(in crate::urscript) fn begins(&mut self, line: u32, channel: &mut Channel) -> Outcome {
        for action in [
            ArmAction::Base(Some(Box::new(Frame::IDENTITY))),
            ArmAction::PartOnFlange(false),
            ArmAction::Tool(None),
        ] {
            channel.arm(line, action)?;
        }
        Ok(())
    }

    /// A variable has this value from here on.
    ///
    /// # Errors
    /// There are too many; or the name stands in two scopes, and which of them the line means depends on where the controller takes the first
    /// level of the program to be (URScript, "Scoping rules": variables there are global, whatever their qualifier).
    pub(in crate::urscript) fn assign(
        &mut self,
        scan: &Scan,
        scope: Scope,
        name: &str,
        value: Value,
    ) -> Outcome {
        let last = self.locals.len().saturating_sub(1);
        let of_others = self.locals[..last].iter().any(|locals| locals.contains_key(name));
        let is_own = self.locals.get(last).is_some_and(|locals| locals.contains_key(name));
        let is_doubtful = match scope {
            Scope::Global => is_own || of_others,
            // The program itself is the first function, or the one that stands outside of all calls.
            Scope::Local => last <= 1 && self.globals.contains_key(name),
            Scope::Found => !is_own && !self.globals.contains_key(name) && of_others,
        };
        if is_doubtful {
            let message = format!(
                "{name} stands in two scopes: which of them this line means, the first level of the program decides"
            );
            return Err(Box::new(
                scan.since(0, Rule::Variable, message)
                    .help("give the variables of functions names of their own"),
            ));
        }
        let Some(locals) = self.locals.get_mut(last) else { return Ok(()) };
        let is_global = match scope {
            Scope::Global => true,
            Scope::Local => false,
            Scope::Found => !locals.contains_key(name) && self.globals.contains_key(name),
        };
        let place = if is_global { &mut self.globals } else { locals };
        if place.insert(name.into(), value).is_none() {
            self.count += 1;
        }
        match self.count > MOST_VARIABLES {
            true => {
                let message = "more variables than a controller has room for";
                Err(scan.since(0, Rule::TooMuch, message))
            }
            false => Ok(()),
        }
    }

    /// A function begins, with these parameters.
    pub(in crate::urscript) fn enter(&mut self, parameters: HashMap<Box<str>, Value>) {
        self.locals.push(parameters);
    }

    /// It is at its end.
    pub(in crate::urscript) fn leave(&mut self) {
        let gone = self.locals.pop();
        self.count = self.count.saturating_sub(gone.map_or(0, |gone| gone.len()));
    }
}
