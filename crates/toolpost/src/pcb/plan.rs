//! What is cut of a board, in which program and from which side.

use crate::answer::Stop;
use crate::args::pcb as args;
use geom::Vec2;
use geom::region::RegionError;
use machine::Machine;
use pcb::board::Face;
use pcb::isolation::{Direction, Isolation};
use pcb::{Board, Copper, Cut, Cutter, Operation, Path, Tool, depths};
use program::Diagnostic;

/// What is cut, in programs.
pub struct Plan {
    /// What the board is called.
    pub name: String,
    /// The board as the machine sees it.
    front: Board,
    /// The same, turned over: its front is the back.
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
    /// What is done, tool by tool.
    pub operations: Vec<Operation>,
    /// Places to look at, and why.
    pub problems: Vec<(Vec2, String)>,
}

impl Plan {
    /// The board as it lies on the machine when its front is up.
    pub fn front(&self) -> &Board {
        &self.front
    }

    /// The board as it lies on the machine for a job: its front is up.
    pub fn seen(&self, job: &Job) -> &Board {
        match job.from {
            Face::Front => &self.front,
            Face::Back => &self.back,
        }
    }
}

/// How wide the tool of an operation cuts at its deepest, mm.
pub fn width(operation: &Operation) -> f64 {
    let deepest = |cut: &Cut| match cut {
        Cut::Hole { depth, .. } => *depth,
        Cut::Way(stretches) => stretches.iter().map(|stretch| stretch.depth).fold(0.0, f64::max),
    };
    let depth = operation.cuts.iter().map(deepest).fold(0.0, f64::max);
    operation.tool.cutter.width(depth)
}

/// Plans what `args` ask for.
pub fn of(board: Board, args: &args::Pcb, machine: &Machine) -> Result<Plan, Stop> {
    let speed = args.running.speed.unwrap_or(USUAL_SPEED.min(machine.spindle.max));
    let planner = Planner { args, speed };
    let mut plan = Plan {
        name: board.name.clone(),
        back: board.clone(),
        front: board,
        jobs: Vec::new(),
        warnings: Vec::new(),
    };
    for (name, part, face) in
        [("front", args::Part::Front, Face::Front), ("back", args::Part::Back, Face::Back)]
    {
        let board = if face == Face::Front { &plan.front } else { &plan.back };
        if let Some(copper) = &board.front.copper
            && planner.wants(part)
        {
            let operations = vec![planner.isolation(copper)?];
            plan.jobs.push(Job { name, from: face, operations, problems: Vec::new() });
        }
    }
    Ok(plan)
}

/// The speed of a spindle that has no limit in its machine file, 1/min.
const USUAL_SPEED: f64 = 10_000.0;

/// What makes operations.
struct Planner<'a> {
    args: &'a args::Pcb,
    speed: f64,
}

impl Planner<'_> {
    /// Whether a program is asked for.
    fn wants(&self, part: args::Part) -> bool {
        self.args.only.is_empty() || self.args.only.contains(&part)
    }

    /// The tool that isolates.
    fn bit(&self) -> Result<(String, Cutter), Stop> {
        let settings = &self.args.isolation;
        match (settings.tool, settings.vee) {
            (Some(diameter), _) => {
                Ok((format!("end mill {diameter} mm"), Cutter::Cylinder { diameter }))
            }
            (None, Some(degrees)) => {
                let cutter = Cutter::Vee { tip: settings.tip, angle: degrees.to_radians() };
                Ok((format!("V-bit {degrees} degrees"), cutter))
            }
            (None, None) => {
                let message = "no tool is given that cuts around copper";
                let help =
                    "give --tool with the width of an end mill, or --vee with the angle of a V-bit";
                Err(Diagnostic::error("no-tool", message).help(help).into())
            }
        }
    }

    fn isolation(&self, copper: &Copper) -> Result<Operation, Stop> {
        let settings = &self.args.isolation;
        let (name, cutter) = self.bit()?;
        let isolation = Isolation {
            cutter,
            depth: settings.depth,
            passes: settings.passes as usize,
            overlap: settings.overlap,
            direction: match settings.direction {
                args::Direction::Climb => Direction::Climb,
                args::Direction::Conventional => Direction::Conventional,
            },
        };
        let paths = isolation.passes(copper, None).map_err(too_much)?;
        let tool = self.mill(name, cutter);
        let depths = depths(settings.depth, settings.step.unwrap_or(settings.depth));
        Ok(Operation { name: "isolation".into(), tool, cuts: self.along(&paths, &depths) })
    }

    fn mill(&self, name: String, cutter: Cutter) -> Tool {
        let running = &self.args.running;
        Tool { name, cutter, feed: running.feed, plunge: running.plunge, speed: self.speed }
    }

    fn along(&self, paths: &[Path], depths: &[f64]) -> Vec<Cut> {
        paths.iter().map(|path| Cut::along(path, depths)).collect()
    }
}

fn too_much(error: RegionError) -> Stop {
    let message = format!("the board cannot be worked out: {error}");
    Diagnostic::error("too-much", message).help("look at the unit of its files").into()
}
