//! How fast each tool of a source turns at the most: a cutter bursts in the air as well as in the part.

use crate::state::{same_tool, speed};
use program::{Op, Program, Tool};

/// The fastest speed that a source names for each of its tools, 1/min.
pub(crate) struct Speeds {
    /// Of none: what is named before the first tool.
    tools: Vec<(Option<Tool>, f64)>,
}

impl Speeds {
    /// The speeds of a source.
    pub fn of(source: &Program) -> Speeds {
        let mut tools: Vec<(Option<Tool>, f64)> = Vec::new();
        let mut at = tool(&mut tools, None);
        // The speed that holds, and whether it has been named since the tool was called: otherwise it is this tool's with the first motion.
        let (mut holds, mut is_named) = (0.0, true);
        for record in source.each() {
            match &record.op {
                Op::Spindle(spindle) => {
                    (holds, is_named) = (speed(*spindle), true);
                    tools[at].1 = holds.max(tools[at].1);
                }
                Op::Tool(called) => {
                    at = tool(&mut tools, Some(called));
                    is_named = false;
                }
                Op::Rapid(_)
                | Op::Line(_)
                | Op::Arc(_)
                | Op::Thread(_)
                | Op::Probe(_)
                | Op::Hole(_)
                | Op::Oriented(_)
                | Op::Joints(_)
                | Op::MachineMove(_)
                | Op::Home
                | Op::Output(_)
                | Op::Input(_)
                | Op::Auxiliary(_)
                | Op::Dwell(_)
                | Op::Stop
                | Op::OptionalStop => {
                    if !is_named {
                        tools[at].1 = holds.max(tools[at].1);
                        is_named = true;
                    }
                }
                // The tool is neither moved nor waited with.
                Op::Cycle(_)
                | Op::CycleOff
                | Op::Feed(_)
                | Op::PathMode(_)
                | Op::SurfaceSpeed(_)
                | Op::Coolant(_)
                | Op::Preselect(_)
                | Op::Compensation(_)
                | Op::Frame(_)
                | Op::WorkOffset(_)
                | Op::WorkOffsetData(_)
                | Op::Surface(_)
                | Op::Clamp(_)
                | Op::Operation(_)
                | Op::EndOfOperation
                | Op::Comment(_)
                | Op::Message(_)
                | Op::End => {}
                // No spindle turns there.
                Op::Beam(_) | Op::Pulses(_) | Op::ThreadWire | Op::CutWire | Op::Taper(_) => {}
            }
        }
        Speeds { tools }
    }

    /// The fastest speed for `held`, the tool in the spindle; for any tool where the source names none for that one.
    pub fn fastest(&self, held: Option<&Tool>) -> f64 {
        let of = |is_held: &dyn Fn(&Tool) -> bool| {
            let of_it = self.tools.iter().filter(|(tool, _)| tool.as_ref().is_some_and(is_held));
            of_it.map(|(_, speed)| *speed).fold(0.0, f64::max)
        };
        let own = held.map_or(0.0, |held| of(&|tool| same_tool(tool, held)));
        if own > 0.0 { own } else { self.tools.iter().map(|(_, speed)| *speed).fold(0.0, f64::max) }
    }
}

/// The place of a tool among `tools`.
fn tool(tools: &mut Vec<(Option<Tool>, f64)>, called: Option<&Tool>) -> usize {
    let same = |known: &Option<Tool>| match (known, called) {
        (Some(known), Some(called)) => (known.number, &known.name) == (called.number, &called.name),
        (known, called) => known.is_none() == called.is_none(),
    };
    let known = tools.iter().position(|(known, _)| same(known));
    known.unwrap_or_else(|| {
        tools.push((called.cloned(), 0.0));
        tools.len() - 1
    })
}
