//! The program on a control that knows the tools: where it leads their centres.

use super::centre::{Fault, Slack};
use super::trail::{CompensatedMoves, Piece};
use super::{Part, centre};
use crate::gauge::Gauge;
use crate::report::{Report, SourceLine};
use crate::resolved_pose::{Number, ResolvedPose};
use control::{ArcTo, Dialect, Event, Position, Setup, ToolData};
use machine::{Machine, ToolRadius};
use program::{CompensatedPath, Compensation, Diagnostic, Op, Program, Rule, Tool};
use std::collections::BTreeMap;

/// How far the centre may be from where it should be, in tip tolerances: as an arc, whose centre is rounded too.
const ROUNDINGS: f64 = 3.0;

/// Runs the program once more with the tools of the source in the table of its control, and compares where it leads their centres
/// in each of `stretches`.
pub(crate) fn compare(
    source: &Program,
    setup: Setup,
    (file_name, text): (&str, &[u8]),
    gauge: Gauge,
    stretches: &[CompensatedMoves],
    report: &mut Report,
) {
    let machine = gauge.machine;
    let setup = Setup { tools: table(source, machine), ..setup };
    let mut run = Run {
        gauge,
        offsets: source.compensated_path != Some(CompensatedPath::Center),
        stretches,
        moves: 0,
        path: Vec::new(),
        is_state: false,
        report,
    };
    let done = match nc::settings(machine, setup) {
        Ok(settings) => control::read(&settings, file_name, text, &mut |event| run.take(&event)),
        Err(found) => Err(found),
    };
    match done {
        Ok(()) => run.finish(),
        Err(found) => run.refused(*found),
    }
}

/// The tool table of the machine as it keeps the tools of the source.
fn table(source: &Program, machine: &Machine) -> Vec<ToolData> {
    let mut tools: BTreeMap<u32, Option<&Tool>> = BTreeMap::new();
    for record in &source.records {
        if let Op::Tool(tool) = &record.op {
            let known = tools.entry(tool.number).or_insert(Some(tool));
            // Two tools of one number: which of them the table has is not known.
            if known.is_some_and(|known| known.cutting_radius() != tool.cutting_radius()) {
                *known = None;
            }
        }
    }
    let kept = |radius: f64| match machine.settings.tool_radius {
        Some(ToolRadius::Wear) => 0.0,
        Some(ToolRadius::Full) | None => radius,
    };
    let rows =
        tools.values().flatten().filter_map(|tool| Some((tool, kept(tool.cutting_radius()?))));
    let rows = rows.flat_map(|(tool, radius)| {
        let length = tool.length.unwrap_or(f64::NAN);
        let called = |name: String| ToolData { number: tool.number, name, radius, length };
        let name = tool.name.trim();
        [called(name.to_owned()), called(crate::state::plain(name))]
    });
    rows.collect()
}

/// By how much the control may leave the path where two elements join, mm: nothing, but where it cuts into joints, to what the machine
/// file allows at corners.
fn joints(machine: &Machine) -> f64 {
    match Dialect::named(&machine.reader) {
        Some(dialect) if dialect.cuts_compensated_joints() => machine.path_tolerance(),
        Some(_) | None => 0.0,
    }
}

/// A run of the program.
struct Run<'a> {
    gauge: Gauge<'a>,
    /// Whether the centre has to be off the path of the source, and not on it.
    offsets: bool,
    /// Those that are still to come.
    stretches: &'a [CompensatedMoves],
    /// Moves since the last one.
    moves: usize,
    /// The path of the centre in the stretch at hand.
    path: Vec<Piece>,
    /// Whether the control has no radius for it: it reports compensation as a state.
    is_state: bool,
    report: &'a mut Report,
}

use program::Outcome;

impl Run<'_> {
    fn take(&mut self, event: &Event) -> Outcome {
        match Part::of(&event.action) {
            Part::Move(position, arc) => self.moved(event.line, position, arc),
            Part::Side(Compensation::Left(_) | Compensation::Right(_)) => self.is_state = true,
            Part::End if !self.path.is_empty() => self.judge(),
            Part::End | Part::Side(Compensation::Off) | Part::Other => {}
        }
        Ok(())
    }

    fn moved(&mut self, line: u32, position: &Position, arc: Option<&ArcTo>) {
        let Some(stretch) = self.stretches.first() else { return };
        if self.moves < stretch.before {
            self.moves += 1;
            return;
        }
        let gauge = Gauge { tool_length: stretch.terms.tool_length, ..self.gauge };
        let Some(from) =
            self.path.last().map(|last| last.to).or(stretch.pieces.first().map(|p| p.from))
        else {
            return;
        };
        let to = gauge.resolve(line, *position);
        let here = ResolvedPose { place: from, ..to };
        let arc = arc.and_then(|arc| crate::arc::of_block(&gauge, &here, arc));
        self.path.push(Piece { line, from, to: to.place, arc });
        let Some(exit) = &stretch.exit else { return };
        let out = line == exit.line && to.place.tip.distance(exit.to.tip) <= gauge.slack(&to);
        let enough = match self.is_state {
            true => self.path.len() > stretch.pieces.len(),
            false => out && self.path.len() >= stretch.pieces.len(),
        };
        if enough {
            self.judge();
        }
    }

    /// The stretch at hand is over.
    fn judge(&mut self) {
        let Some((stretch, rest)) = self.stretches.split_first() else { return };
        let path = std::mem::take(&mut self.path);
        (self.stretches, self.moves) = (rest, 0);
        let left = match stretch.terms.side {
            Compensation::Left(_) => 1.0,
            Compensation::Right(_) | Compensation::Off => -1.0,
        };
        let radius = if self.offsets { stretch.terms.radius } else { Some(0.0) };
        let Some(radius) = radius.filter(|_| !std::mem::take(&mut self.is_state)) else {
            return self.open(stretch, "the radius that the control takes is not known");
        };
        let along = ROUNDINGS * self.gauge.allowed.tip_mm + joints(self.gauge.machine);
        let slack = Slack { along, chord: 0.0, start: None };
        match centre::compare(stretch, &path, radius, left, slack) {
            Ok(_) => self.report.compared.contours += 1,
            Err(Fault { block, element, how }) => {
                let at = match (block, element) {
                    (Some(_), Some(line)) => format!(", at the element of line {line}"),
                    _ => String::new(),
                };
                let message = format!(
                    "{}with a radius of {} mm {how}{at}",
                    SourceLine(stretch.terms.source_line),
                    Number(radius)
                );
                let line = block.or(element).unwrap_or_default();
                let found = Diagnostic::error(Rule::Compensation, message).line(line);
                self.report.mismatch(stretch.terms.source_line, found);
            }
        }
    }

    /// What the control makes of this stretch is not compared.
    fn open(&mut self, stretch: &CompensatedMoves, why: &str) {
        let line = stretch.pieces.first().map_or(0, |piece| piece.line);
        self.report.warn(not_compared(why).line(line));
    }

    fn finish(&mut self) {
        if !self.path.is_empty() {
            self.judge();
        }
        if let Some(stretch) = self.stretches.first() {
            let line = stretch.pieces.first().map_or(0, |piece| piece.line);
            let message = "the control does not lead the tool along this contour";
            let found = Diagnostic::error(Rule::Compensation, message).line(line);
            self.report.mismatch(stretch.terms.source_line, found);
        }
    }

    /// The control does not lead the tool along the contour.
    fn refused(&mut self, mut found: Diagnostic) {
        if found.rule == Rule::CompensationUnsupported {
            let warning = not_compared(&found.message).line(found.line);
            return self.report.warn(warning);
        }
        let source_line = self.stretches.first().map_or(0, |stretch| stretch.terms.source_line);
        found.message = format!("with the tools of the source in its table: {}", found.message);
        self.report.mismatch(source_line, found);
    }
}

/// That a contour is compared as programmed alone.
pub(super) fn not_compared(why: &str) -> Diagnostic {
    let message = format!("where compensation leads the tool's centre is not compared: {why}");
    Diagnostic::warning(Rule::CompensationOpen, message)
}
