//! Proven programs with one character damaged, or with a block put in: the proof refuses each, or the machine does the
//! same. `make judges-long` damages ten times as many.
//!
//! What a surviving program does is shown without the proof: the virtual control runs it and the
//! one it came from, and both do the same things at the same places.

use crate::dice::Dice;
use crate::files::root;
use control::{Action, ArcTo, Event, Orientation, Position};
use geom::{Arc, Vec3, nearest_on_segment};
use machine::Machine;
use program::{
    Axes, Compensation, Coolant, Cycle, CycleKind, Feed, Op, Program, Spindle, Tool, WorkOffset,
};
use proof::{Applied, Tolerances};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// So many damages of each of two kinds, spread evenly over the programs.
fn damages() -> usize {
    if judge::long() { 1000 } else { 100 }
}

/// Blocks for the controls that read ISO code.
const ISO_BLOCKS: &[&str] = &[
    "G53 G0 Z-400",
    "G53 G0 X-9999",
    "G53 G0 Z0",
    "G10 L2 P1 X0 Y0 Z-50",
    "G10 L1 P1 Z500",
    "G92 X0 Y0 Z0",
    "G92 Z300",
    "G52 X5",
    "G49",
    "G43 H2",
    "G43.1 Z-20",
    "G64",
    "G64 P5",
    "G61",
    "G18",
    "G19",
    "G20",
    "G91",
    "G93",
    "G95",
    "G55",
    "G59",
    "G54.1 P1",
    "G68 X0 Y0 R5",
    "G51 X0 Y0 P2",
    "G28 Z0",
    "G91 G28 Z0",
    "G28",
    "G30 Z0",
    "G30 P4 Z0",
    "G29 Z2",
    "M3",
    "M4",
    "M5",
    "M8",
    "M9",
    "M0",
    "M1",
    "M2",
    "M30",
    "M98 P1",
    "M99",
    "G41 D1",
    "G40",
    "G98",
    "G99",
    "G81 X0 Y0 Z-5 R2",
    "G80",
    "G4 P1",
    "M6",
    "T9",
    "T9 M6",
    "#5221=5",
    "#3004=7",
    "#1=5",
    "G0",
    "G1",
    "G2",
    "F9999",
    "S50",
    "G96 S100",
    "M62 P1",
    "M10",
    "M29 S100",
    "G5.1 Q1",
    "G187 P3 E5.",
    "M48",
    "M49",
    "M50 P0",
    "M51 P0",
    "M52 P1",
    "M53 P0",
    "G63",
    "#500=5",
    "#700=5",
    "G81",
    "G29 Z0",
    "G43",
    "G28.1",
    "G30.1",
    "M61 Q9",
    "G90",
    "G17",
    "G21",
    "G94",
    "G54",
    "G0 Z-5",
    "G1 Z-5",
    "G0 X500",
];

/// Blocks for a SINUMERIK.
const SINUMERIK_BLOCKS: &[&str] = &[
    "G0 SUPA Z-400",
    "G0 G53 X999",
    "G500",
    "G54",
    "G55",
    "TRANS X5",
    "ATRANS Z-1",
    "ROT RPL=5",
    "MIRROR X0",
    "SCALE X2",
    "G64",
    "G641",
    "G642 ADIS=5",
    "CYCLE832(5,_FINISH,1)",
    "CTOL=5",
    "G18",
    "G19",
    "G70",
    "G700",
    "G91",
    "G93",
    "G95",
    "G41",
    "G40",
    "D0",
    "D1",
    "D2",
    "T9",
    "M6",
    "M0",
    "M1",
    "M2",
    "M17",
    "M30",
    "M3",
    "M4",
    "M5",
    "M8",
    "M9",
    "$P_UIFR[1,Z,TR]=-50",
    "$TC_DP3[1,1]=5",
    "TRAORI",
    "TRAFOOF",
    "STOPRE",
    "G74 Z1=0",
    "G75 Z0",
    "MSG(\"x\")",
    "FFWON",
    "SOFT",
    "G4 F1",
    "R1=5",
    "G0",
    "G1",
    "F9999",
    "S50",
    "M10",
    "G58 X5",
    "COMPCAD",
    "G505",
    "G0 Z-5",
    "G1 Z-5",
    "G0 X500",
    "CYCLE800()",
    "MCALL",
    "MCALL CYCLE81(10,0,2,-5)",
    "M26",
    "M27",
    "M28 M29",
    "G9",
    "G60",
    "FNORM",
    "SPOS=0",
    "AROT Z5",
    "R24=0",
    "RTLIOF",
    "RTLION",
    "G25 X-5",
    "G26 X10",
    "G26 S500",
    "WALIMOF",
    "G644",
    "G641 ADISPOS=5",
    "CTOL=0.01 G645",
    "CYCLE832(-0.99,_FINISH,1)",
    "M41",
    "ACC[X]=200",
    "G63 X1",
];

/// Blocks for Klartext, whose numbers are made anew.
const KLARTEXT_BLOCKS: &[&str] = &[
    "L Z-400 R0 FMAX M91",
    "L Z+0 R0 FMAX M91",
    "L X+999 R0 FMAX M92",
    "CYCL DEF 7.0 DATUM SHIFT\n0 CYCL DEF 7.1 Z-5",
    "TOOL DEF 1 L+5 R+3",
    "M126",
    "M127",
    "M128",
    "M129",
    "M140 MB MAX",
    "M3",
    "M4",
    "M5",
    "M8",
    "M9",
    "STOP",
    "M0",
    "M1",
    "M2",
    "M30",
    "CYCL DEF 247 DATUM SETTING ~\n  Q339=+2 ;DATUM NUMBER",
    "CYCL DEF 10.0 ROTATION\n0 CYCL DEF 10.1 ROT+5",
    "CYCL DEF 8.0 MIRRORING\n0 CYCL DEF 8.1 X",
    "CYCL DEF 32.0 TOLERANCE\n0 CYCL DEF 32.1 T5",
    "CYCL DEF 32.0 TOLERANCE\n0 CYCL DEF 32.1",
    "TOOL CALL 1",
    "TOOL CALL 2 Z S500",
    "TOOL CALL DL+1",
    "PLANE RESET STAY",
    "L Z+5 R0 FMAX",
    "L Z-5 R0 FMAX",
    "L X+500 FMAX",
    "L IZ-1 R0 F100",
    "CC X+0 Y+0",
    "M136",
    "M137",
    "M89",
    "M99",
    "Q1=+5",
    "CYCL DEF 11.0 SCALING\n0 CYCL DEF 11.1 SCL 2",
    "CYCL DEF 19.0 WORKING PLANE\n0 CYCL DEF 19.1 A+5",
    "CYCL DEF 9.0 DWELL TIME\n0 CYCL DEF 9.1 DWELL 1",
    "FN 17: SYSWRITE ID50 NR1 IDX1 = +5",
    "M101",
    "M120 LA5",
    "LBL 1",
    "CALL LBL 1",
    "; WORDS",
    "M107",
    "M141",
    "QR5 = +3",
];

/// A program that is proven, and what it is proven against.
struct Sample {
    name: String,
    machine: Machine,
    source: Program,
    text: Vec<u8>,
    /// The lines of the text (their newlines with them), those that differ only in digits together.
    kinds: Vec<Vec<(usize, usize)>>,
    records: Vec<Event>,
}

impl Sample {
    fn new(name: &str, cldata: &str, machine: &str) -> Sample {
        let reading = source::apt::read(name, cldata.as_bytes(), &Default::default()).unwrap();
        let source = reading.program;
        let loaded = machine::load(machine).unwrap();
        let text = post::write(&source, &loaded)
            .unwrap_or_else(|refusals| panic!("{name} for {machine}: {}", refusals[0]))
            .text;
        let report = proof::prove(&source, &loaded, "", &text, &Tolerances::default());
        assert!(report.proven, "{name} for {machine}: {}", report.mismatches[0]);
        let mut kinds = BTreeMap::<Vec<u8>, Vec<(usize, usize)>>::new();
        let mut start = 0;
        for line in text.split_inclusive(|byte| *byte == b'\n') {
            let kind = line.iter().copied().filter(|byte| !byte.is_ascii_digit()).collect();
            kinds.entry(kind).or_default().push((start, line.len()));
            start += line.len();
        }
        let records = records(&loaded, &text);
        let name = format!("{name} for {machine}");
        let kinds = kinds.into_values().collect();
        Sample { name, machine: loaded, source, text, kinds, records }
    }

    /// The text with one character replaced, deleted, inserted, or swapped with the next. What comes
    /// in is a character of the text, as often as it is there.
    fn damaged(&self, random: &mut Dice) -> Vec<u8> {
        loop {
            // Every kind of block is as likely as any other: most blocks are points of a path.
            let kind = &self.kinds[random.index(self.kinds.len())];
            let (start, length) = kind[random.index(kind.len())];
            let place = start + random.index(length);
            let byte = self.text[random.index(self.text.len())];
            let mut text = self.text.clone();
            match random.index(4) {
                0 => text[place] = byte,
                1 => drop(text.remove(place)),
                2 => text.insert(place, byte),
                _ if place + 1 < text.len() => text.swap(place, place + 1),
                _ => {}
            }
            if text != self.text {
                return text;
            }
        }
    }

    /// The text with a block put in somewhere, or with a block that the operator may switch off.
    fn with_block(&self, random: &mut Dice) -> Vec<u8> {
        let blocks = match self.machine.reader.as_str() {
            "sinumerik" | "sinumerik-828d" => SINUMERIK_BLOCKS,
            "klartext" => KLARTEXT_BLOCKS,
            _ => ISO_BLOCKS,
        };
        let text = std::str::from_utf8(&self.text).unwrap();
        let mut lines: Vec<String> = text.split_inclusive('\n').map(str::to_owned).collect();
        let pointed = |block: &str| match self.machine.reader.as_str() {
            "fanuc" | "haas" => block.split(' ').map(with_point).collect::<Vec<_>>().join(" "),
            _ => block.to_owned(),
        };
        // Behind the start, before the end.
        let place = 2 + random.index(lines.len() - 4);
        let dialect = control::Dialect::named(&self.machine.reader).unwrap();
        match random.index(8) {
            0 => lines[place].insert(0, '/'),
            // Any word that the tables of the dialect hold.
            1..=3 => {
                let words = control::vocabulary(dialect);
                lines.insert(place, format!("{}\n", words[random.index(words.len())]));
            }
            _ => lines.insert(place, format!("{}\n", pointed(blocks[random.index(blocks.len())]))),
        }
        if self.machine.reader == "klartext" {
            lines = numbered(&lines.concat());
        }
        lines.concat().into_bytes()
    }

    /// Why the machine does the same when it is given the proven `text`.
    ///
    /// # Errors
    /// What it does else.
    fn harmless(&self, text: &[u8]) -> Result<&'static str, String> {
        let records = records(&self.machine, text);
        // As text, for a coordinate that is not known equals nothing.
        let said = |records: &[Event], comments: bool| -> Vec<String> {
            let comment = |op: &Action| matches!(op, Action::Comment(_) | Action::Message(_));
            let ops = records.iter().map(|record| &record.action);
            ops.filter(|op| comments || !comment(op)).map(|op| format!("{op:?}")).collect()
        };
        let alike = |comments| said(&self.records, comments) == said(&records, comments);
        match (alike(true), alike(false)) {
            (true, _) => Ok("the same in other writing"),
            (_, true) => Ok("a comment"),
            _ => Allowed::new(&self.machine, &self.source)
                .compare(&steps(&self.records), &steps(&records)),
        }
    }
}

/// What the control of `machine` makes of `text`.
fn records(machine: &Machine, text: &[u8]) -> Vec<Event> {
    let settings = nc::settings(machine, control::Setup::default()).unwrap();
    let mut records = Vec::new();
    control::read(&settings, "", text, &mut |record| {
        records.push(record);
        Ok(())
    })
    .unwrap();
    records
}

/// Something the machine does, and what is switched on meanwhile.
#[derive(Clone, Debug)]
struct Step {
    act: Act,
    on: On,
}

#[derive(Clone, Debug)]
enum Act {
    Rapid(Position),
    Home(Axes),
    Line(Position),
    /// From a pose.
    Arc(Position, Box<ArcTo>),
    Hole(Position, Box<Cycle>),
    Tool(Box<Tool>),
    Dwell(f64),
    Stop,
    OptionalStop,
    End,
}

#[derive(Clone, Copy, Debug)]
struct On {
    feed: Option<Feed>,
    spindle: Spindle,
    coolant: Coolant,
    compensation: Compensation,
    length_offset: Option<u32>,
    work_offset: Option<WorkOffset>,
}

/// What a machine does that is given `records`.
fn steps(records: &[Event]) -> Vec<Step> {
    let mut on = On {
        feed: None,
        spindle: Spindle::Off,
        coolant: Coolant::Off,
        compensation: Compensation::Off,
        length_offset: None,
        work_offset: None,
    };
    let (mut steps, mut cycle, mut here) = (Vec::new(), None, None);
    // A tool change stops spindle and coolant, but for what its own block switches on.
    let (mut spindle_line, mut coolant_line) = (0, 0);
    for Event { line, action: op } in records {
        let act = match op {
            // Nothing moves where the tool already is.
            Action::Rapid(to) | Action::Line(to) if here == Some(*to) => continue,
            Action::Rapid(to) => Act::Rapid(*to),
            Action::Home(axes) => Act::Home(*axes),
            Action::Line(to) => Act::Line(*to),
            Action::Arc(to) => Act::Arc(here.unwrap_or(to.end), to.clone()),
            Action::Hole(at) => Act::Hole(*at, Option::clone(&cycle).unwrap()),
            Action::Tool(tool) => {
                if spindle_line != *line {
                    on.spindle = Spindle::Off;
                }
                if coolant_line != *line {
                    on.coolant = Coolant::Off;
                }
                Act::Tool(tool.clone())
            }
            Action::Dwell(seconds) => Act::Dwell(*seconds),
            Action::Stop => Act::Stop,
            Action::OptionalStop => Act::OptionalStop,
            Action::End => Act::End,
            op => {
                match op {
                    Action::Feed(feed) => on.feed = Some(*feed),
                    Action::Spindle(spindle) => (on.spindle, spindle_line) = (*spindle, *line),
                    Action::Coolant(coolant) => (on.coolant, coolant_line) = (*coolant, *line),
                    Action::Compensation(side) => on.compensation = *side,
                    Action::LengthOffset(register) => on.length_offset = *register,
                    Action::WorkOffset(number) => on.work_offset = Some(*number),
                    Action::Cycle(new) => cycle = Some(new.clone()),
                    Action::CycleOff => cycle = None,
                    _ => {}
                }
                continue;
            }
        };
        here = match op {
            Action::Home(_) | Action::Hole(_) => None,
            op => op.position().copied().or(here),
        };
        steps.push(Step { act, on });
    }
    steps
}

/// How far two proven programs may be apart: each keeps the tolerance from the source.
struct Allowed<'a> {
    machine: &'a Machine,
    proof: Applied,
    /// The longest tool, mm.
    tool_length: f64,
    /// Height of the highest place of the source, mm.
    top: f64,
    /// The hole cycles of the source.
    cycles: Vec<Cycle>,
}

impl Allowed<'_> {
    fn new<'a>(machine: &'a Machine, source: &Program) -> Allowed<'a> {
        let lengths = source.records.iter().map(|record| match &record.op {
            Op::Tool(tool) => tool.length.unwrap_or(0.0),
            _ => 0.0,
        });
        let heights = source.records.iter().filter_map(|record| record.op.pose());
        let cycles = source.records.iter().filter_map(|record| match &record.op {
            Op::Cycle(cycle) => Some(**cycle),
            _ => None,
        });
        Allowed {
            machine,
            proof: Applied::new(machine, &Tolerances::default()),
            tool_length: lengths.fold(0.0, f64::max),
            top: heights.map(|pose| pose.point().z).fold(f64::NEG_INFINITY, f64::max),
            cycles: cycles.collect(),
        }
    }

    /// Whether the tool stands at the same place and angle, as far as either is known.
    fn pose(&self, a: &Position, b: &Position) -> bool {
        let unknown = |a: f64, b: f64| a.is_nan() && b.is_nan();
        let degrees = |pose: &Position| match pose.orientation {
            Orientation::Rotary { degrees, .. } => degrees,
            Orientation::Axis(_) => [0.0; 3],
        };
        let (mut a, mut b) = (*a, *b);
        for i in 0..3 {
            if unknown(a.point[i], b.point[i]) {
                (a.point[i], b.point[i]) = (0.0, 0.0);
            }
            if unknown(degrees(&a)[i], degrees(&b)[i]) {
                for pose in [&mut a, &mut b] {
                    if let Orientation::Rotary { degrees, .. } = &mut pose.orientation {
                        degrees[i] = 0.0;
                    }
                }
            }
        }
        let (tip, axis) = nc::resolve(self.machine, &a, Some(self.tool_length));
        let (other, toward) = nc::resolve(self.machine, &b, Some(self.tool_length));
        tip.distance(other) <= 2.0 * self.tip(&a)
            && (axis == toward
                || geom::angle_between(axis, toward).to_degrees() <= 2.0 * self.proof.axis_degrees)
    }

    /// How far the tip may be from the source, mm: rotary words err at their distance from the centre.
    fn tip(&self, pose: &Position) -> f64 {
        let (tip, _) = nc::resolve(self.machine, pose, Some(self.tool_length));
        let lever = match pose.orientation {
            Orientation::Rotary { tool_center: true, .. } => 0.0,
            Orientation::Axis(axis) if axis == Vec3::Z => 0.0,
            Orientation::Axis(_) => tip.length() * 3f64.sqrt(),
            Orientation::Rotary { .. } => {
                let arms = self.machine.rotary.iter().map(|axis| axis.point.distance(tip));
                arms.map(|arm| arm + self.tool_length).sum()
            }
        };
        self.proof.tip_mm + lever * self.proof.rotary_degrees.to_radians()
    }

    fn feed(&self, a: Option<Feed>, b: Option<Feed>) -> bool {
        match (a, b) {
            (Some(Feed::PerMinute(a)), Some(Feed::PerMinute(b)))
            | (Some(Feed::PerTurn(a)), Some(Feed::PerTurn(b)))
            | (Some(Feed::InverseTime(a)), Some(Feed::InverseTime(b))) => {
                // Of an F that is worked out for a block with rotary axes, the sixth digit is rounding of the block.
                (a - b).abs() <= (2.0 * self.proof.feed).max(1e-5 * a)
            }
            (a, b) => a == b,
        }
    }

    fn spindle(&self, a: Spindle, b: Spindle) -> bool {
        match (a, b) {
            (Spindle::Clockwise(a), Spindle::Clockwise(b))
            | (Spindle::CounterClockwise(a), Spindle::CounterClockwise(b)) => {
                (a - b).abs() <= 2.0 * self.proof.speed_per_min
            }
            (a, b) => a == b,
        }
    }

    /// Whether two cycles do the same in a hole, the second with its point `higher` by so much.
    fn cycle(&self, a: &Cycle, b: &Cycle, higher: f64) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= 2.0 * self.proof.tip_mm;
        let peck = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => near(a, b),
            (a, b) => a == b,
        };
        // The first peck may count from the R plane.
        let first = near(higher, 0.0) || near(higher, a.clearance);
        let as_often =
            a.kind == b.kind && peck(a.first_peck, b.first_peck) && peck(a.peck, b.peck) && first;
        // A control with one depth for all pecks may take the first of the source, if that is all.
        let at_once = |cycle: &Cycle| {
            let first = cycle.first_peck.or(cycle.peck);
            cycle.kind == CycleKind::Drill
                || matches!(cycle.kind, CycleKind::Deep | CycleKind::BreakChip)
                    && first.is_some_and(|first| first > cycle.depth - 2.0 * self.proof.tip_mm)
        };
        let wanted_at_once =
            || self.cycles.iter().any(|wanted| near(wanted.depth, a.depth) && at_once(wanted));
        near(a.depth, b.depth - higher)
            && near(a.clearance, b.clearance + higher)
            && near(a.retract, b.retract + higher)
            && self.feed(a.feed, b.feed)
            && (a.dwell - b.dwell).abs() <= 2.0 * self.proof.dwell_s
            && (as_often || at_once(b) && (at_once(a) || wanted_at_once()))
    }

    /// Whether what counts in a cut is switched on alike.
    fn switched(&self, a: &On, b: &On) -> bool {
        self.feed(a.feed, b.feed)
            && self.spindle(a.spindle, b.spindle)
            && a.coolant == b.coolant
            && a.compensation == b.compensation
            && a.length_offset == b.length_offset
            && a.work_offset == b.work_offset
    }

    /// Whether two steps are one and the same, with what counts in them switched on alike.
    fn step(&self, a: &Step, b: &Step) -> bool {
        let set_up =
            a.on.length_offset == b.on.length_offset && a.on.work_offset == b.on.work_offset;
        let on = (&a.on, &b.on);
        let cut = self.switched(on.0, on.1);
        match (&a.act, &b.act) {
            (Act::Rapid(a), Act::Rapid(b)) => set_up && self.pose(a, b),
            (Act::Home(a), Act::Home(b)) => a == b,
            (Act::Line(a), Act::Line(b)) => cut && self.pose(a, b),
            (Act::Arc(start, a), Act::Arc(other, b)) => {
                cut && self.pose(start, other) && self.pose(&a.end, &b.end) && {
                    let arc = |from: &Position, to: &ArcTo| {
                        let radius = from.point.distance(to.center);
                        let (center, end) = (to.center, to.end.point);
                        Arc::new(from.point, end, center, to.normal, to.turns, radius).unwrap()
                    };
                    let (first, second) = (arc(start, a), arc(other, b));
                    // Each has three times the tolerance: ends and centre are rounded.
                    let off = 6.0 * self.tip(&a.end);
                    (0..=16)
                        .map(|i| f64::from(i) / 16.0)
                        .all(|t| first.at(t).distance(second.at(t)) <= off)
                }
            }
            (Act::Hole(a, first), Act::Hole(b, second)) => {
                let along = a.axis().unwrap_or(Vec3::Z);
                let higher = (b.point - a.point).dot(along);
                let level = Position { point: b.point - along * higher, ..*b };
                // A tap's feed is its pitch, and a cycle may name its own.
                let own = matches!(first.kind, CycleKind::Tap { .. }) || first.feed.is_some();
                let feed = if own { on.1.feed } else { on.0.feed };
                self.switched(&On { feed, ..*on.0 }, on.1)
                    && self.pose(a, &level)
                    && self.cycle(first, second, higher)
            }
            (Act::Tool(a), Act::Tool(b)) => a.number == b.number && a.name == b.name,
            (Act::Dwell(a), Act::Dwell(b)) => (a - b).abs() <= 2.0 * self.proof.dwell_s,
            (Act::Stop, Act::Stop) | (Act::OptionalStop, Act::OptionalStop) => {
                (a.on.spindle == Spindle::Off) == (b.on.spindle == Spindle::Off)
            }
            (Act::End, Act::End) => true,
            _ => false,
        }
    }

    /// Why a machine that is given `damaged` does what it does for `original`.
    ///
    /// # Errors
    /// The first step that is another one.
    fn compare(&self, original: &[Step], damaged: &[Step]) -> Result<&'static str, String> {
        let mut reason = "unused words or rounding";
        let (mut a, mut b) = (original, damaged);
        let mut before = None;
        loop {
            for (part, other) in [
                (Act::is_transit as fn(&Act) -> bool, "another way by rapid"),
                (Act::is_line, "a cut in other steps"),
            ] {
                let [first, second] = [a, b].map(|steps| {
                    let length = steps.iter().take_while(|step| part(&step.act)).count();
                    &steps[..length]
                });
                (a, b) = (&a[first.len()..], &b[second.len()..]);
                let mut pairs = first.iter().zip(second);
                if first.len() != second.len() || !pairs.all(|(a, b)| self.step(a, b)) {
                    let fair = match part(&Act::Stop) {
                        true => {
                            let next = a.first().map_or(&Act::End, |step| &step.act);
                            self.same_transit(before, first, second, next)
                        }
                        false => self.same_path(before, first, second),
                    };
                    if !fair {
                        let acts = |steps: &[Step]| -> Vec<Act> {
                            steps.iter().map(|step| step.act.clone()).collect()
                        };
                        return Err(format!("{:?}\nbecame\n{:?}", acts(first), acts(second)));
                    }
                    reason = other;
                }
                before = first.iter().rev().find_map(|step| step.act.end()).or(before);
            }
            match (a, b) {
                ([], []) => return Ok(reason),
                ([first, ..], [second, ..]) if first.act.is_moves() || second.act.is_moves() => {}
                ([first, rest @ ..], [second, others @ ..]) if self.step(first, second) => {
                    before = first.act.end().or(before);
                    (a, b) = (rest, others);
                }
                _ => return Err(format!("{:?}\nbecame\n{:?}", a.first(), b.first())),
            }
        }
    }

    /// Whether two ways without a cut are the same but for what the proof leaves open. The same tool
    /// comes in. They end in the same place, or higher on the tool axis, or, before a hole or after the
    /// last cut, anywhere on the way. Each stop has each coordinate from the other way, or turns rotary
    /// axes while Z is home, and none is reached by going down aside where the other way does not. Z may
    /// go home, other axes after it or from the top. Stops of the program may be added where a tool is
    /// changed or nothing has been cut.
    fn same_transit(&self, before: Option<Position>, a: &[Step], b: &[Step], next: &Act) -> bool {
        let tool = |steps: &[Step]| {
            let mut tools = steps.iter().rev().filter_map(|step| match &step.act {
                Act::Tool(tool) => Some((tool.number, tool.name.clone())),
                _ => None,
            });
            tools.next()
        };
        let halts = |steps: &[Step]| {
            steps.iter().filter(|step| matches!(step.act, Act::Stop | Act::OptionalStop)).count()
        };
        let ends = |steps: &[Step]| -> Vec<Position> {
            before.into_iter().chain(steps.iter().filter_map(|step| step.act.end())).collect()
        };
        let (mut way, other) = (ends(a), ends(b));
        let same_end = match (way.last(), other.last()) {
            (Some(a), Some(b)) => self.pose(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        // A hole takes the tool to its place, and nothing comes after the end.
        let open_end = matches!(next, Act::Hole(..) | Act::End);
        way.extend(next.r_plane());
        let free = before.is_none() || tool(a).is_some();
        let same_halts = halts(a) == halts(b) || (free && halts(a) < halts(b));
        let offset =
            |step: &Step| a.iter().any(|other| other.on.length_offset == step.on.length_offset);
        let (mut homed, mut here) = (false, before);
        let fair = b.iter().all(|step| match &step.act {
            Act::Rapid(to) => {
                let known = to.point.is_finite();
                let slope = here.is_some_and(|here| {
                    let segment = |segment: &[Position]| {
                        self.pose(&segment[0], &here) && self.pose(&segment[1], to)
                    };
                    self.slopes(&here, to) && !way.windows(2).any(segment)
                });
                here = Some(*to);
                if slope || (known && !offset(step)) {
                    return false;
                }
                if way.iter().any(|place| self.above(place, to)) {
                    way.push(*to);
                }
                way.iter().any(|place| self.pose(place, to)) || self.corner(&way, to)
            }
            Act::Home(axes) => {
                let top = here.is_none_or(|here| here.point.z >= self.top);
                let fair = *axes == Axes::Z || homed || top || a.iter().any(|a| self.step(a, step));
                homed |= axes.contains(Axes::Z);
                if let (Some(here), true) = (&mut here, axes.contains(Axes::Z)) {
                    here.point.z = f64::NAN;
                }
                fair
            }
            _ => true,
        });
        let lifted = here.is_some_and(|here| way.iter().any(|place| self.above(place, &here)));
        tool(a) == tool(b) && same_halts && fair && (same_end || open_end || lifted)
    }

    /// Whether each coordinate of `to`, as its block says it or in the work frame, is that of a place on
    /// the way or not known.
    fn corner(&self, way: &[Position], to: &Position) -> bool {
        let tip = |pose: &Position| nc::resolve(self.machine, pose, Some(self.tool_length)).0;
        let near = |a: f64, b: f64| (a - b).abs() <= 2.0 * self.proof.tip_mm;
        (0..3).all(|i| {
            to.point[i].is_nan()
                || way
                    .iter()
                    .any(|at| near(at.point[i], to.point[i]) || near(tip(at)[i], tip(to)[i]))
        })
    }

    /// Whether the tool stands at `to` as at `place`, higher along its axis.
    fn above(&self, place: &Position, to: &Position) -> bool {
        let (tip, axis) = nc::resolve(self.machine, place, Some(self.tool_length));
        let height = (nc::resolve(self.machine, to, Some(self.tool_length)).0 - tip).dot(axis);
        height > 0.0 && {
            let mut lower = *to;
            lower.point -= match to.orientation {
                Orientation::Rotary { tool_center: false, .. } => Vec3::Z,
                _ => axis,
            } * height;
            self.pose(place, &lower)
        }
    }

    /// Whether a rapid goes down and aside in one, seen along the tool axis and along Z.
    fn slopes(&self, from: &Position, to: &Position) -> bool {
        let (tip, axis) = nc::resolve(self.machine, to, Some(self.tool_length));
        let way = tip - nc::resolve(self.machine, from, Some(self.tool_length)).0;
        let off = 2.0 * self.proof.tip_mm;
        [axis, Vec3::Z].iter().all(|along| {
            let down = way.dot(*along);
            down < -off && (way - along * down).length() > off
        })
    }

    /// Whether two rows of lines are one path, cut at the same feed and so on: the points of each lie on
    /// the other, in their order.
    fn same_path(&self, before: Option<Position>, a: &[Step], b: &[Step]) -> bool {
        let Some(before) = before else { return false };
        let tip = |pose: &Position| nc::resolve(self.machine, pose, Some(self.tool_length)).0;
        let points = |steps: &[Step]| -> Vec<Vec3> {
            let ends = steps.iter().filter_map(|step| step.act.end());
            std::iter::once(before).chain(ends).map(|pose| tip(&pose)).collect()
        };
        let off = 2.0 * self.proof.tip_mm + self.proof.linearisation_mm + self.proof.chord_mm;
        let on_the_way = |steps: &[Step], others: &[Step]| {
            let (way, mut segment) = (points(others), 0);
            steps.iter().zip(&points(steps)[1..]).all(|(step, point)| {
                let near = |segment: &usize| {
                    let distance = nearest_on_segment(way[*segment], way[segment + 1], *point).1;
                    distance <= off && self.switched(&step.on, &others[*segment].on)
                };
                let found = (segment..others.len()).find(near);
                segment = found.unwrap_or(segment);
                found.is_some()
            })
        };
        let same_end = match (a.last(), b.last()) {
            (Some(a), Some(b)) => self.step(a, b),
            _ => false,
        };
        same_end && on_the_way(a, b) && on_the_way(b, a)
    }
}

/// The pose so many mm above that of a hole, along Z of its coordinates.
fn above(hole: &Position, height: f64) -> Position {
    Position { point: hole.point + hole.axis().unwrap_or(Vec3::Z) * height, ..*hole }
}

impl Act {
    /// Nothing is cut, nobody waits.
    fn is_transit(&self) -> bool {
        matches!(self, Act::Rapid(_) | Act::Home(_) | Act::Tool(_) | Act::Stop | Act::OptionalStop)
    }

    fn is_line(&self) -> bool {
        matches!(self, Act::Line(_))
    }

    fn is_moves(&self) -> bool {
        self.is_transit() || self.is_line()
    }

    /// Where the tool is afterwards, if this moves it to a place.
    fn end(&self) -> Option<Position> {
        match self {
            Act::Rapid(to) | Act::Line(to) => Some(*to),
            Act::Arc(_, arc) => Some(arc.end),
            Act::Hole(at, cycle) => Some(above(at, cycle.retract)),
            _ => None,
        }
    }

    fn r_plane(&self) -> Option<Position> {
        match self {
            Act::Hole(at, cycle) => Some(above(at, cycle.clearance)),
            _ => None,
        }
    }
}

/// A program for every control, with three axes and with five, in angles of the machine, in angles
/// with the tool centre kept (`G43.4`, `M128`), in vectors (`TRAORI`); our examples, and small real
/// files where they are.
fn samples() -> Vec<Sample> {
    let read = |path: PathBuf| std::fs::read_to_string(path).unwrap();
    let dome = read(root().join("examples/dome.cls"));
    let plate = read(root().join("examples/plate.cls"));
    let lines = |text: &str, ranges: &[RangeInclusive<usize>]| -> String {
        let lines: Vec<&str> = text.lines().collect();
        let kept = ranges.iter().flat_map(|range| &lines[range.start() - 1..*range.end()]);
        kept.flat_map(|line| [line, "\n"]).collect()
    };
    // Three axes can make neither the spiral nor the tilted holes; five need not make all of it.
    let flat = lines(&dome, &[1..=143, 1841..=1860, 1882..=1883, 1885..=1885]);
    let dome = lines(&dome, &[1..=260, 1836..=1885]);
    // GRBL has neither compensation nor a tap.
    let plain = lines(&plate, &[1..=43, 45..=47, 49..=92, 105..=107]);
    let mut samples: Vec<Sample> = [
        ("dome", &dome, "sinumerik-840d-traori"),
        ("dome", &dome, "sinumerik-840d-table-ac"),
        ("dome", &dome, "fanuc-table-bc"),
        ("dome", &dome, "dmu50-heidenhain"),
        ("flat dome", &flat, "generic-3axis-fanuc"),
        ("flat dome", &flat, "generic-3axis-linuxcnc"),
        ("flat dome", &flat, "generic-3axis-grbl"),
        ("plate", &plate, "generic-3axis-sinumerik"),
        ("plate", &plate, "generic-3axis-sinumerik-828d"),
        ("plate", &plate, "generic-3axis-fanuc"),
        ("plate", &plate, "generic-3axis-heidenhain"),
        ("plate", &plate, "generic-3axis-linuxcnc"),
        ("plate", &plate, "sinumerik-840d-table-ac"),
        ("plate", &plate, "fanuc-table-bc"),
        ("plate", &plate, "dmu50-heidenhain"),
        ("plain plate", &plain, "generic-3axis-grbl"),
    ]
    .map(|(name, cldata, machine)| Sample::new(name, cldata, machine))
    .into();
    for (file, machine) in [
        ("makino/Plane_2.cldata", "generic-3axis-fanuc"),
        ("nx/simple_block.cls", "generic-3axis-linuxcnc"),
        ("solidworks/shimemcunha.apt", "dmu50-heidenhain"),
        ("solidworks/SupPetriLED.apt", "sinumerik-840d-traori"),
    ] {
        let Some(cldata) = judge::data("cldata") else { continue };
        samples.push(Sample::new(file, &read(cldata.join(file)), machine));
    }
    samples
}

/// A word of a length with its point.
fn with_point(word: &str) -> String {
    let length = word.starts_with(['X', 'Y', 'Z', 'R', 'I', 'J', 'K']) && !word.contains('.');
    if length { format!("{word}.") } else { word.to_owned() }
}

/// Blocks of Klartext with their numbers from 0; a line that goes on has none.
fn numbered(text: &str) -> Vec<String> {
    let mut next = 0;
    let number = |line: &str| {
        let rest = match line.split_once(' ') {
            Some((number, rest)) if number.parse::<u32>().is_ok() => rest,
            _ if line.trim_start().starts_with('Q') && !line.contains("Q1=") => {
                return format!("{line}\n");
            }
            _ => line,
        };
        let (skip, rest) = rest.strip_prefix('/').map_or(("", rest), |rest| ("/", rest));
        next += 1;
        format!("{skip}{} {rest}\n", next - 1)
    };
    text.lines().map(number).collect()
}

#[test]
fn a_damaged_program_is_refused_or_does_the_same() {
    judged(45, Sample::damaged);
}

#[test]
fn a_program_with_a_block_put_in_is_refused_or_does_the_same() {
    judged(46, Sample::with_block);
}

/// Damages the programs, as `seed` draws it.
fn judged(seed: u64, damage: impl Fn(&Sample, &mut Dice) -> Vec<u8>) {
    let samples = samples();
    let mut random = Dice(seed);
    let mut table = BTreeMap::<String, BTreeMap<&str, BTreeMap<&str, usize>>>::new();
    let (mut harmful, mut survivors) = (Vec::new(), BTreeMap::<(String, String), usize>::new());
    for sample in samples.iter().cycle().take(damages()) {
        let text = damage(sample, &mut random);
        let report =
            proof::prove(&sample.source, &sample.machine, "", &text, &Tolerances::default());
        let (end, why) = match report.mismatches.first() {
            Some(found) => ("caught", found.rule.name()),
            None => match sample.harmless(&text) {
                Ok(why) => {
                    let (_, before, after) = difference(&sample.text, &text);
                    let reader = sample.machine.reader.clone();
                    if judge::long() {
                        *survivors
                            .entry((reader, format!("{after} (at {before})")))
                            .or_default() += 1;
                    }
                    ("harmless", why)
                }
                Err(what) => {
                    let (line, before, after) = difference(&sample.text, &text);
                    let name = &sample.name;
                    harmful.push(format!("{name}:{line}: {before:?} became {after:?}\n{what}"));
                    ("harmful", "it does something else")
                }
            },
        };
        let control = table.entry(sample.machine.reader.clone()).or_default();
        *control.entry(end).or_default().entry(why).or_default() += 1;
    }
    for (control, ends) in &table {
        let all: usize = ends.values().flat_map(BTreeMap::values).sum();
        println!("{control}: {all} damages");
        for (end, reasons) in ends {
            let reasons: Vec<_> =
                reasons.iter().map(|(why, count)| format!("{why} {count}")).collect();
            println!("    {end}: {}", reasons.join(", "));
        }
    }
    for ((control, change), count) in survivors {
        println!("{control}: {change}: {count}");
    }
    assert!(harmful.is_empty(), "{}", harmful.join("\n\n"));
}

/// Where two texts differ: the line (from 1), and what it was and has become.
fn difference(original: &[u8], damaged: &[u8]) -> (usize, String, String) {
    let place = original.iter().zip(damaged).take_while(|(a, b)| a == b).count();
    let start = original[..place].iter().rposition(|byte| *byte == b'\n').map_or(0, |i| i + 1);
    let line = |text: &[u8]| {
        let rest = text[place..].iter().position(|byte| *byte == b'\n');
        let end = rest.map_or(text.len(), |length| place + length);
        String::from_utf8_lossy(&text[start..end]).into_owned()
    };
    let number = original[..place].iter().filter(|byte| **byte == b'\n').count() + 1;
    (number, line(original), line(damaged))
}
