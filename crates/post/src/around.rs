//! What the source says before and behind the record at hand. Records come in their order, and each answer is kept for as long as it
//! holds: however often somebody asks, each record is looked at a few times altogether.

use geom::Vec3;
use program::{Diagnostic, Op, Pose, Record, Rule, Spindle, Tool};

/// How far off the tool axis a cut may end that has drawn the tool back along it, mm.
const ALONG: f64 = 1e-3;

/// The source `ends`, or changes the tool, in the cut: the tool is drawn back along its axis, which nobody has asked for.
pub(crate) fn ends_in_cut(ends: &str) -> Diagnostic {
    let message = format!(
        "the tool is in the cut where the source {ends}: it goes out along its axis from there"
    );
    let help = "retract in the toolpath; a file that ends in a cut may be cut off";
    Diagnostic::warning(Rule::EndsInCut, message).help(help)
}

/// The source stops the program in the cut.
pub(crate) fn stops_in_cut() -> Diagnostic {
    let message = "the program stops for somebody while the tool is in the cut: the spindle would have to stop there, too";
    let help =
        "draw the tool back in the toolpath before STOP or OPSTOP, by rapid or along the tool axis";
    Diagnostic::error(Rule::StopInCut, message).help(help)
}

/// What is known of the records around the one at hand, whose index never becomes less.
#[derive(Debug, Default)]
pub(crate) struct Around {
    /// No record before this one needs the spindle.
    idle_until: usize,
    /// So many records have been looked at for the last motion.
    seen: usize,
    /// The last of them that has a pose, changes the tool, sends it home or changes the work offset.
    last: Option<usize>,
    /// The last one with a pose before that.
    before: Option<usize>,
    /// The next record that has a pose or calls a tool; how many there are where none does.
    next: Option<usize>,
    /// The next record that cuts or starts the spindle; how many there are where none does.
    start: Option<usize>,
    /// A tool, the record up to which the answer holds, and the record that calls the other tool.
    other: Option<(u32, usize, Option<usize>)>,
}

impl Around {
    /// Whether the source cuts, or dwells, before it stops the spindle or gives it another speed.
    pub(crate) fn needs_spindle(&mut self, records: &[Record], index: usize) -> bool {
        if index < self.idle_until {
            return false;
        }
        let needs = |op: &Op| {
            matches!(
                op,
                Op::Line(_)
                    | Op::Arc(_)
                    | Op::Thread(_)
                    | Op::Hole(_)
                    | Op::Probe(_)
                    | Op::Dwell(_)
            )
        };
        let ends = |op: &Op| {
            matches!(op, Op::Spindle(_) | Op::Tool(_) | Op::Stop | Op::OptionalStop | Op::End)
        };
        let next = position(records, index, |op| needs(op) || ends(op));
        if records.get(next).is_some_and(|record| needs(&record.op)) {
            return true;
        }
        self.idle_until = next;
        false
    }

    /// How the spindle is started before the next cut.
    pub(crate) fn spindle_before_cut(
        &mut self,
        records: &[Record],
        index: usize,
    ) -> Option<Spindle> {
        let ends = |op: &Op| {
            matches!(op, Op::Line(_) | Op::Arc(_) | Op::Thread(_) | Op::Hole(_))
                || started(op).is_some()
        };
        let find = || position(records, index, ends);
        let start = self.start.filter(|start| *start >= index).unwrap_or_else(find);
        self.start = Some(start);
        records.get(start).and_then(|record| started(&record.op))
    }

    /// The last motion, tool change, home position or change of the work offset before the record at hand, and the pose before it.
    fn last_motion<'r>(
        &mut self,
        records: &'r [Record],
        index: usize,
    ) -> Option<(&'r Record, Option<&'r Pose>)> {
        let pose = |at: usize| records.get(at).and_then(|record| record.op.pose());
        for (at, record) in records.iter().enumerate().take(index).skip(self.seen) {
            let parts = matches!(record.op, Op::Tool(_) | Op::Home | Op::WorkOffset(_));
            if parts || record.op.pose().is_some() {
                self.before = self.last.filter(|last| pose(*last).is_some()).or(self.before);
                self.last = Some(at);
            }
        }
        self.seen = self.seen.max(index);
        Some((records.get(self.last?)?, self.before.and_then(pose)))
    }

    /// Whether the last motion of the source is a cut that has not drawn the tool back along its axis.
    pub(crate) fn stands_in_cut(&mut self, records: &[Record], index: usize) -> bool {
        let Some((last, from)) = self.last_motion(records, index) else { return false };
        let cut = matches!(last.op, Op::Line(_) | Op::Arc(_) | Op::Thread(_));
        let (true, Op::Line(to)) = (cut, &last.op) else { return cut };
        let Some(from) = from else { return true };
        let way: Vec3 = to.point() - from.point();
        let out = way.dot(to.axis());
        out <= 0.0 || (way - to.axis() * out).length() > ALONG
    }

    /// The tool that is called before anything moves.
    pub(crate) fn tool_before_motion(&mut self, records: &[Record], index: usize) -> Option<u32> {
        let find = || position(records, index, |op| op.pose().is_some() || tool(op).is_some());
        let next = self.next.filter(|next| *next >= index).unwrap_or_else(find);
        self.next = Some(next);
        records.get(next).and_then(|record| tool(&record.op))
    }

    /// The tool that is called next and is not `number`; behind the last one the first.
    pub(crate) fn other_tool<'r>(
        &mut self,
        records: &'r [Record],
        index: usize,
        number: u32,
    ) -> Option<&'r Tool> {
        let known = self.other.filter(|(asked, until, _)| *asked == number && index <= *until);
        let at = known.map_or_else(
            || {
                let calls = |op: &Op| tool(op).is_some_and(|other| other != number);
                let until = position(records, index, calls);
                let first = || records.iter().take(index).position(|record| calls(&record.op));
                let at = if until < records.len() { Some(until) } else { first() };
                self.other = Some((number, until, at));
                at
            },
            |(_, _, at)| at,
        )?;
        called(&records.get(at)?.op)
    }
}

/// The first record from `index` on that `is` one, or how many there are.
fn position(records: &[Record], index: usize, is: impl Fn(&Op) -> bool) -> usize {
    let mut coming = records.iter().enumerate().skip(index);
    coming.find(|(_, record)| is(&record.op)).map_or(records.len(), |(at, _)| at)
}

fn started(op: &Op) -> Option<Spindle> {
    if let Op::Spindle(spindle) = op { Some(*spindle) } else { None }
        .filter(|spindle| *spindle != Spindle::Off)
}

fn called(op: &Op) -> Option<&Tool> {
    if let Op::Tool(tool) = op { Some(tool) } else { None }
}

fn tool(op: &Op) -> Option<u32> {
    called(op).map(|tool| tool.number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;
    use program::{Program, WorkOffset};
    use proptest::prelude::*;

    fn op(kind: u8, number: u8) -> Op {
        let pose = Pose::upright(Vec3::new(f64::from(number), 0.0, 0.0)).unwrap();
        match kind {
            0 => Op::Line(pose),
            1 => Op::Rapid(pose),
            2 | 3 => Op::Tool(Box::new(Tool { number: u32::from(number % 3), ..Tool::default() })),
            4 => Op::Home,
            5 => Op::WorkOffset(WorkOffset::FIRST),
            6 => Op::Stop,
            7 if number < 3 => Op::Spindle(Spindle::Off),
            7 => Op::Spindle(Spindle::Clockwise(f64::from(number))),
            8 => Op::Dwell(1.0),
            _ => Op::Preselect(u32::from(number)),
        }
    }

    proptest! {
        /// Whoever asks again and again hears what a search through all records finds.
        #[test]
        fn what_is_kept_is_what_a_search_finds(
            ops in prop::collection::vec((0_u8..10, 0_u8..6), 0..40),
            asked in prop::collection::vec((any::<bool>(), 0_u32..4), 40),
        ) {
            let mut program = Program::new("t");
            for (kind, number) in ops {
                program.push(1, op(kind, number));
            }
            let records = &program.records;
            let mut around = Around::default();
            for (index, &(asks, number)) in (0..=records.len()).zip(&asked) {
                if !asks {
                    continue;
                }
                let (behind, coming) = records.split_at(index);
                let called = |record: &Record| tool(&record.op).filter(|other| *other != number);
                let other = coming.iter().find_map(called).or_else(|| behind.iter().find_map(called));
                let found = around.other_tool(records, index, number).map(|tool| tool.number);
                prop_assert_eq!(found, other);
                let mut still = coming.iter().take_while(|record| record.op.pose().is_none());
                let next = still.find_map(|record| tool(&record.op));
                prop_assert_eq!(around.tool_before_motion(records, index), next);
                let mut before = behind.iter().rev();
                let ends = |record: &&Record| {
                    let parts = matches!(record.op, Op::Tool(_) | Op::Home | Op::WorkOffset(_));
                    parts || record.op.pose().is_some()
                };
                let last = before.find(ends);
                let from = before.find_map(|record| record.op.pose());
                prop_assert_eq!(around.last_motion(records, index), last.map(|last| (last, from)));
                let mut until_cut =
                    coming.iter().take_while(|record| !matches!(record.op, Op::Line(_)));
                let start = until_cut.find_map(|record| {
                    let Op::Spindle(spindle) = record.op else { return None };
                    Some(spindle).filter(|spindle| *spindle != Spindle::Off)
                });
                prop_assert_eq!(around.spindle_before_cut(records, index), start);
                let needs = |record: &Record| matches!(record.op, Op::Line(_) | Op::Dwell(_));
                let mut deciding = coming.iter().filter(|record| {
                    needs(record) || matches!(record.op, Op::Spindle(_) | Op::Tool(_) | Op::Stop)
                });
                prop_assert_eq!(around.needs_spindle(records, index), deciding.next().is_some_and(needs));
            }
        }
    }
}
