//! From a job to a neutral program.

use crate::between_holes::BetweenHoles;
use crate::commands::COMMANDS;
use crate::job::{Job, Tool};
use crate::listing::Listing;
use control::{Dialect, Setup};
use geom::Vec3;
use machine::Machine;
use program::{Diagnostic, Op, Program, Progress, Purpose, Record, Rule, Spindle};
use std::collections::HashMap;
use std::mem;

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

/// Reads `job` of the file `file_name` for `machine`: words for rotary axes are positions of its
/// axes.
///
/// # Errors
/// The first command that means nothing or cannot be converted, and what an operation lacks, with the
/// operation, the command and the way out.
pub fn read(
    machine: &Machine,
    file_name: &str,
    job: Job,
    purpose: Purpose,
) -> Result<Reading, Box<Diagnostic>> {
    read_for(machine, file_name, job, purpose, &())
}

/// The same for somebody who waits for it.
///
/// # Errors
/// As [`read`]; the work was ended (`cancelled`).
pub fn read_for(
    machine: &Machine,
    file_name: &str,
    mut job: Job,
    purpose: Purpose,
    progress: &dyn Progress,
) -> Result<Reading, Box<Diagnostic>> {
    if let Some((number, what)) = two_tools(&job) {
        let message = format!("two tools of different {what} have the number {number}");
        let help = "give one of the tool controllers another number";
        return Err(Diagnostic::error(Rule::TwoTools, message).help(help).file(file_name).into());
    }
    let unfed = without_feed(&job)
        .filter(|_| purpose.asks_technology())
        .map(|(operation, tool)| (operation.to_owned(), tool.to_owned()));
    let listing = Listing::of(file_name, &mut job)?;
    let mut turning = machine.clone();
    if !listing.turns() {
        turning.rotary.clear();
    }
    let mut collector = Collector::new(&job, &listing, purpose);
    let keep =
        &mut |records: &mut Vec<Record>, record, several| collector.keep(records, record, several);
    let setup = Setup { purpose, ..Setup::default() };
    let settings = nc::settings_in(Dialect::Source(&COMMANDS), &turning, setup);
    let read = nc::read_by(&turning, &settings, ("", listing.text()), keep, progress);
    let located = |found: Diagnostic| Box::new(listing.located(found));
    let (mut reading, several) = read.map_err(|found| located(way_out(*found)))?;
    let mut records = std::mem::take(&mut reading.program.records);
    collector.finish(&mut records, several).map_err(|found| match found.line {
        0 => Box::new(found.file(file_name)),
        _ => located(*found),
    })?;
    if let Some((operation, tool)) = unfed {
        let message = format!(
            "operation `{operation}`: the tool controller {tool} has a horizontal feed of 0, and the cuts along X and Y would go \
             at the vertical one"
        );
        let help = "give the tool controller a horizontal feed, and recompute";
        return Err(Diagnostic::error(Rule::Feed, message).help(help).file(file_name).into());
    }
    let warnings = reading.warnings.into_iter().map(|found| listing.located(found)).collect();
    let stock = job.stock.map(|stock| [stock.low, stock.high].map(Vec3::from));
    let program = Program { name: job.name, records, stock, ..reading.program };
    Ok(Reading { program, listing, warnings })
}

/// The number of two tools that are not one, and in what they differ. Several tool controllers may be for one tool.
fn two_tools(job: &Job) -> Option<(u32, &'static str)> {
    let mut known = HashMap::new();
    let differ = |a: &Tool, b: &Tool| {
        let diameters = a.diameter.zip(b.diameter).is_some_and(|(a, b)| a != b);
        let shapes = a.shape.as_ref().zip(b.shape.as_ref()).is_some_and(|(a, b)| a != b);
        [(diameters, "diameters"), (shapes, "shapes")].into_iter().find(|(differ, _)| *differ)
    };
    job.tools.iter().find_map(|tool| {
        let first = *known.entry(tool.number).or_insert(tool);
        differ(first, tool).map(|(_, what)| (tool.number, what))
    })
}

/// An operation that cuts along X or Y without a feed of its own, and its tool controller, which has none for that.
fn without_feed(job: &Job) -> Option<(&str, &str)> {
    let cuts = |line: &str| {
        let mut words = line.split_ascii_whitespace();
        matches!(words.next(), Some("G1" | "G01" | "G2" | "G02" | "G3" | "G03"))
            && words.clone().any(|word| word.starts_with(['X', 'Y']))
            && !words.any(|word| word.starts_with('F'))
    };
    let unfed = job.tools.iter().filter(|tool| tool.horizontal_feed == Some(0.0));
    let unfed: HashMap<u32, &Tool> = unfed.map(|tool| (tool.number, tool)).collect();
    job.operations.iter().find_map(|operation| {
        let tool = unfed.get(&operation.tool?)?;
        operation
            .commands
            .lines()
            .any(cuts)
            .then_some((operation.label.as_str(), tool.name.as_str()))
    })
}

/// Adds to a finding of the control where FreeCAD corrects it.
fn way_out(mut found: Diagnostic) -> Diagnostic {
    let way_out = match found.rule {
        Rule::Feed => {
            "give the tool controller of the operation its feeds, horizontal and vertical, and recompute"
        }
        Rule::Spindle => "give the tool controller of the operation its speed, and recompute",
        Rule::Tool => "give the tool controller a number above 0, and recompute",
        Rule::UnknownWord => "change the commands of the operation",
        // FreeCAD writes what it could not work out as a huge number, or as a word.
        Rule::Number => "recompute the operation in FreeCAD, and look at what it is made from",
        _ => return found,
    };
    found.help_too(way_out);
    found
}

/// Collects the records of the control, with what the job says of them.
struct Collector<'a> {
    job: &'a Job,
    listing: &'a Listing,
    /// Which of the operations have moved.
    moves: Vec<bool>,
    /// The last operation of which there is a record.
    last: usize,
    /// Its records, and what has come between them, while it has not moved: the name of an operation that
    /// moves comes before them.
    waiting: Vec<Record>,
    between_holes: BetweenHoles,
    /// The operation of the record at hand.
    at: Option<usize>,
    /// Number and name of the tool in the spindle.
    tool: Option<(u32, String)>,
    turns: bool,
    /// Whether a cut needs a spindle that turns.
    asks_spindle: bool,
    /// The next work offset belongs only to a program that works in others, too.
    is_offset_open: bool,
    /// That one.
    offset: Option<Offset>,
    /// What is wrong with the first record that cannot be converted.
    refused: Option<Box<Diagnostic>>,
}

/// A work offset that is left out of the records.
struct Offset {
    record: Record,
    /// How many records are before it.
    before: usize,
    /// Whether it is the first record of its operation.
    opens: bool,
}

impl<'a> Collector<'a> {
    fn new(job: &'a Job, listing: &'a Listing, purpose: Purpose) -> Collector<'a> {
        Collector {
            job,
            listing,
            moves: vec![false; job.operations.len()],
            last: 0,
            waiting: Vec::new(),
            between_holes: BetweenHoles::default(),
            at: None,
            tool: None,
            turns: false,
            asks_spindle: purpose.asks_technology(),
            is_offset_open: false,
            offset: None,
            refused: None,
        }
    }

    /// Adds the next record to `records`, as soon as it is known whether its operation moves.
    fn keep(&mut self, records: &mut Vec<Record>, record: Record, several: bool) {
        self.is_offset_open |= !several && matches!(record.op, Op::WorkOffset(_));
        let at = self.listing.operation(record.line);
        if at > self.last {
            self.last = at;
            self.add_waiting(records);
        }
        if is_move(&record.op)
            && let Some(moves @ false) = self.moves.get_mut(at)
        {
            *moves = true;
            if at == self.last {
                self.add_waiting(records);
            }
        }
        match self.moves.get(self.last) {
            Some(true) => self.add(records, at, record),
            _ => self.waiting.push(record),
        }
    }

    fn add_waiting(&mut self, records: &mut Vec<Record>) {
        for record in mem::take(&mut self.waiting) {
            self.add(records, self.listing.operation(record.line), record);
        }
    }

    /// The program is complete; it works in `several` work offsets.
    ///
    /// # Errors
    /// Nothing moves, or the first record that cannot be converted.
    fn finish(mut self, records: &mut Vec<Record>, several: bool) -> Result<(), Box<Diagnostic>> {
        if !self.moves.contains(&true) {
            let message = "no operation of the job moves the tool";
            let help = "give the job operations, make them active, and recompute";
            return Err(Diagnostic::error(Rule::NoMotion, message).help(help).into());
        }
        self.add_waiting(records);
        if let Some(refused) = self.refused {
            return Err(refused);
        }
        self.between_holes.end(records);
        if let Some(offset) = self.offset.filter(|_| several) {
            offset.insert(records, self.listing);
        }
        Ok(())
    }

    /// Adds the record, which is of operation `at`, and what the job says of that.
    fn add(&mut self, records: &mut Vec<Record>, at: usize, record: Record) {
        if self.refused.is_some() {
            return;
        }
        if matches!(record.op, Op::WorkOffset(_)) && mem::take(&mut self.is_offset_open) {
            let opens = self.at != Some(at);
            self.offset = Some(Offset { record, before: records.len(), opens });
            return;
        }
        if matches!(record.op, Op::End) {
            self.end(records, record.line);
        } else if self.at != Some(at) {
            self.end(records, record.line);
            self.at = Some(at);
            if self.moves.get(at) == Some(&true) {
                self.begin(records, at, record.line);
            }
        }
        self.refused = self.record(records, record).err();
    }

    /// Whether the operation at hand moves.
    fn within(&self) -> bool {
        self.at.is_some_and(|at| self.moves.get(at) == Some(&true))
    }

    fn end(&mut self, records: &mut Vec<Record>, line: u32) {
        if self.within() {
            self.between_holes
                .push(records, Record { line: line.saturating_sub(1), op: Op::EndOfOperation });
        }
    }

    fn begin(&mut self, records: &mut Vec<Record>, at: usize, line: u32) {
        let label = self.job.operations.get(at).map_or("", |operation| operation.label.as_str());
        self.between_holes.push(records, Record { line, op: Op::Operation(label.into()) });
    }

    fn record(
        &mut self,
        records: &mut Vec<Record>,
        mut record: Record,
    ) -> Result<(), Box<Diagnostic>> {
        let line = record.line;
        match &mut record.op {
            Op::Comment(text) if self.is_repeated(text) => return Ok(()),
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
                    return Err(Diagnostic::error(Rule::SpindleSpeed, message)
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
        self.between_holes.push(records, record);
        Ok(())
    }

    /// Whether a comment repeats what is said otherwise: the label of an operation, the name of a tool.
    fn is_repeated(&self, text: &str) -> bool {
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
                refused(Rule::NoTool, message, "give the operation a tool controller of the job")
            }
            (Some(number), Some(asked)) if number != asked => {
                let message = format!("the operation is made for T{asked}, and T{number} is in");
                let help =
                    "post it together with its tool controller: order the job by operation or tool";
                refused(Rule::ToolNumber, message, help)
            }
            _ if self.asks_spindle
                && !self.turns
                && matches!(op, Op::Line(_) | Op::Arc(_) | Op::Hole(_)) =>
            {
                let message = String::from("a cut while the spindle stands");
                refused(
                    Rule::SpindleOff,
                    message,
                    "give the tool controller its speed and direction",
                )
            }
            _ => Ok(()),
        }
    }
}

impl Offset {
    /// Inserts it where it was left out. Where it is the first of its operation, the name of the operation comes before it.
    fn insert(self, records: &mut Vec<Record>, listing: &Listing) {
        let Offset { record, before: mut at, opens } = self;
        if opens {
            if let Some(Record { line, op: Op::EndOfOperation }) = records.get_mut(at) {
                *line = record.line.saturating_sub(1);
                at += 1;
            }
            if let Some(Record { line, op: Op::Operation(_) }) = records.get_mut(at)
                && listing.operation(*line) == listing.operation(record.line)
            {
                *line = record.line;
                at += 1;
            }
        }
        records.insert(at, record);
    }
}

/// Whether the tool moves for it.
fn is_move(op: &Op) -> bool {
    op.pose().is_some() || matches!(op, Op::Probe(_))
}
