//! From a job to a neutral program.

use crate::job::{Job, Tool};
use crate::listing::Listing;
use crate::way::Way;
use control::Setup;
use machine::Machine;
use program::{Diagnostic, Op, Program, Record, Spindle};

/// What was read.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// What the job does. The lines of its records are those of the listing.
    pub program: Program,
    /// Where they come from.
    pub listing: Listing,
    /// What is worth knowing.
    pub warnings: Vec<Diagnostic>,
}

/// Reads `job`, which stands in `file_name`, for `machine`: words for rotary axes are positions of its
/// axes.
///
/// # Errors
/// The first command that means nothing or cannot be told, and what an operation lacks, with the
/// operation, the command and the way out.
pub fn read(machine: &Machine, file_name: &str, job: &Job) -> Result<Reading, Box<Diagnostic>> {
    if let Some(number) = two_diameters(job) {
        let message = format!("two tools of different diameters have the number {number}");
        let help = "give one of the tool controllers another number";
        return Err(Diagnostic::error("two-tools", message).help(help).file(file_name).into());
    }
    let listing = Listing::of(file_name, job);
    let mut speaks = Machine { reader: String::from("freecad"), ..machine.clone() };
    if !listing.turns() {
        speaks.rotary.clear();
    }
    let read = nc::read(&speaks, Setup::default(), "", listing.text());
    let located = |found: Diagnostic| Box::new(listing.located(found));
    let reading = read.map_err(|found| located(way_out(*found)))?;
    let records = Told::new(job, &listing, &reading.program.records)
        .tell(reading.program.records)
        .map_err(|found| match found.line {
            0 => Box::new(found.file(file_name)),
            _ => located(*found),
        })?;
    let warnings = reading.warnings.into_iter().map(|found| listing.located(found)).collect();
    Ok(Reading { program: Program { name: job.name.clone(), records }, listing, warnings })
}

/// The number of two tools that differ in their diameter.
fn two_diameters(job: &Job) -> Option<u32> {
    let mut known = std::collections::HashMap::new();
    let mut tools = job.tools.iter().filter_map(|tool| Some((tool.number, tool.diameter?)));
    tools
        .find(|&(number, diameter)| *known.entry(number).or_insert(diameter) != diameter)
        .map(|(number, _)| number)
}

/// Adds to what the control refuses where in FreeCAD it is set right.
fn way_out(mut found: Diagnostic) -> Diagnostic {
    let way_out = match found.rule {
        "nc-feed" => {
            "give the tool controller of the operation its feeds, horizontal and vertical, and recompute"
        }
        "nc-spindle" => "give the tool controller of the operation its speed, and recompute",
        "nc-tool" => "give the tool controller a number above 0, and recompute",
        "nc-unknown-word" => "change the commands of the operation",
        _ => return found,
    };
    found.help_too(way_out);
    found
}

/// The records on their way, with what the job says of them.
struct Told<'a> {
    job: &'a Job,
    listing: &'a Listing,
    /// Which of the operations move.
    moves: Vec<bool>,
    way: Way,
    /// The operation of the record at hand.
    at: Option<usize>,
    /// Number and name of the tool in the spindle.
    tool: Option<(u32, String)>,
    turns: bool,
}

impl<'a> Told<'a> {
    fn new(job: &'a Job, listing: &'a Listing, records: &[Record]) -> Told<'a> {
        let mut moves = vec![false; job.operations.len()];
        for record in records.iter().filter(|record| is_move(&record.op)) {
            if let Some(moves) = moves.get_mut(listing.operation(record.line)) {
                *moves = true;
            }
        }
        let way = Way::with_capacity(records.len() + 2 * moves.len());
        Told { job, listing, moves, way, at: None, tool: None, turns: false }
    }

    fn tell(mut self, records: Vec<Record>) -> Result<Vec<Record>, Box<Diagnostic>> {
        if !self.moves.contains(&true) {
            let message = "no operation of the job moves the tool";
            let help = "give the job operations, make them active, and recompute";
            return Err(Diagnostic::error("no-motion", message).help(help).into());
        }
        for record in records {
            let at = self.listing.operation(record.line);
            if matches!(record.op, Op::End) {
                self.end(record.line);
            } else if self.at != Some(at) {
                self.end(record.line);
                self.at = Some(at);
                if self.moves.get(at) == Some(&true) {
                    self.begin(at, record.line);
                }
            }
            self.record(record)?;
        }
        Ok(self.way.finish())
    }

    /// Whether the operation at hand moves.
    fn within(&self) -> bool {
        self.at.is_some_and(|at| self.moves.get(at) == Some(&true))
    }

    fn end(&mut self, line: u32) {
        if self.within() {
            self.way.push(Record { line: line.saturating_sub(1), op: Op::EndOfOperation });
        }
    }

    fn begin(&mut self, at: usize, line: u32) {
        let label = self.job.operations.get(at).map_or("", |operation| operation.label.as_str());
        self.way.push(Record { line, op: Op::Operation(label.into()) });
    }

    fn record(&mut self, mut record: Record) -> Result<(), Box<Diagnostic>> {
        let line = record.line;
        match &mut record.op {
            Op::Comment(text) if self.is_told(text) => return Ok(()),
            Op::Tool(tool) => {
                let described = self.job.tools.iter().find(|entry| entry.number == tool.number);
                if let Some(Tool { name, diameter, .. }) = described {
                    tool.name.clone_from(name);
                    tool.diameter = *diameter;
                }
                self.tool = Some((tool.number, tool.name.clone()));
            }
            Op::Spindle(Spindle::Clockwise(speed) | Spindle::CounterClockwise(speed)) => {
                if *speed <= 0.0 {
                    let message = format!("the spindle turns at {speed} 1/min");
                    let help = "give the tool controller its speed, and recompute";
                    return Err(Diagnostic::error("spindle-speed", message)
                        .help(help)
                        .line(line)
                        .into());
                }
                self.turns = true;
            }
            Op::Spindle(Spindle::Off) => self.turns = false,
            op if is_move(op) => self.may_move(op, line)?,
            _ => {}
        }
        self.way.push(record);
        Ok(())
    }

    /// Whether a comment repeats what is said otherwise: the label of an operation, the name of a tool.
    fn is_told(&self, text: &str) -> bool {
        let operation = self.at.and_then(|at| self.job.operations.get(at));
        let label = operation.map_or("", |operation| operation.label.as_str());
        text == label && (self.within() || self.job.tools.iter().any(|tool| tool.name == text))
    }

    /// # Errors
    /// The operation has no tool, or not that which the job gives it, or its spindle stands.
    fn may_move(&self, op: &Op, line: u32) -> Result<(), Box<Diagnostic>> {
        let asked = self.at.and_then(|at| self.job.operations.get(at)?.tool);
        let number = self.tool.as_ref().map(|(number, _)| *number);
        let refused = |rule, message, help: &str| {
            Err(Diagnostic::error(rule, message).help(help).line(line).into())
        };
        match (number, asked) {
            (None, _) => {
                let message = String::from("the operation moves, and no tool has been called");
                refused("no-tool", message, "give the operation a tool controller of the job")
            }
            (Some(number), Some(asked)) if number != asked => {
                let message = format!("the operation is made for T{asked}, and T{number} is in");
                let help =
                    "post it together with its tool controller: order the job by operation or tool";
                refused("tool-number", message, help)
            }
            _ if !self.turns && matches!(op, Op::Line(_) | Op::Arc(_) | Op::Hole(_)) => {
                let message = String::from("a cut while the spindle stands");
                refused("spindle-off", message, "give the tool controller its speed and direction")
            }
            _ => Ok(()),
        }
    }
}

/// Whether the tool moves for it.
fn is_move(op: &Op) -> bool {
    op.pose().is_some() || matches!(op, Op::Probe(_))
}
