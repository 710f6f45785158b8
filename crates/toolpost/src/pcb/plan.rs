//! What is cut of a board, and from which side.

use crate::answer::Stop;
use crate::args::pcb as args;
use crate::toolpath;
use geom::Vec2;
use machine::Machine;
use pcb::board::{Axis, Face};
use pcb::isolation::{Direction, Isolation};
use pcb::tour::Tour;
use pcb::{Board, Cut, Cutter, Operation, Path, Tool, depths};
use program::Diagnostic;

/// What is cut, in programs.
pub struct Plan {
    /// What the board is called.
    pub name: String,
    /// The board as the machine sees it from the front.
    front: Board,
    /// The same, turned over.
    back: Board,
    /// The programs, in the order in which they are run.
    pub jobs: Vec<Job>,
    /// What is odd about it.
    pub warnings: Vec<Diagnostic>,
}

/// What one program does.
pub struct Job {
    /// What the program and its picture are called.
    pub name: &'static str,
    /// From which side it is cut.
    pub from: Face,
    /// Whether it is about copper.
    pub copper: bool,
    /// What is done, tool by tool.
    pub operations: Vec<Operation>,
    /// Places to look at, and why.
    pub problems: Vec<(Vec2, String)>,
}

impl Plan {
    /// The board as it lies on the machine for a job: its front is what is looked at.
    pub fn seen(&self, job: &Job) -> &Board {
        match job.from {
            Face::Front => &self.front,
            Face::Back => &self.back,
        }
    }
}

/// How wide the tool of an operation cuts, mm, at its deepest.
pub fn width(operation: &Operation) -> f64 {
    let deepest = operation.cuts.iter().flat_map(|cut| match cut {
        Cut::Hole { depth, .. } => vec![*depth],
        Cut::Way(stretches) => stretches.iter().map(|stretch| stretch.depth).collect(),
    });
    operation.tool.cutter.width(deepest.fold(0.0, f64::max))
}

/// Plans what `args` ask for.
pub fn of(board: Board, args: &args::Pcb, machine: &Machine) -> Result<Plan, Stop> {
    todo!()
}
