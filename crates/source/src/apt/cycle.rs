//! Hole cycles: `CYCLE/` and the points that follow.
//!
//! Heights count from the point of the hole along the tool axis, away from the part. The statement gives
//! them as couplets of a word and a value in any order (ISO 4343:2000).

use super::motion::Next;
use super::report::{Fault, Outcome};
use super::statement::{Field, Statement};
use super::technology::{FeedUnit, is_dwell, speed_of};
use super::{Dialect, Reader, Ready};
use geom::Vec3;
use program::{Cycle, CycleKind, Feed, Op, Pose, Rule, Spindle};

/// What a minor word of a `CYCLE` statement is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// Depth of the bottom.
    Depth,
    /// Height from which the tool feeds.
    Clearance,
    /// Height to which it goes back.
    Retract,
    /// Depth of the first peck.
    FirstPeck,
    /// Depth of the pecks.
    Peck,
    /// Dwell at the bottom.
    Dwell,
    /// Dwell at the bottom, in turns.
    DwellTurns,
    /// Threads an inch.
    ThreadsPerInch,
    /// Diameter of a countersink.
    Diameter,
    /// Point angle of the tool, degrees.
    Angle,
}

const PARTS: [(&str, Part); 17] = [
    ("FEDTO", Part::Depth),
    ("DEPTH", Part::Depth),
    ("RAPTO", Part::Clearance),
    ("CLEAR", Part::Clearance),
    ("RTRCTO", Part::Retract),
    ("RETURN", Part::Retract),
    ("1STPECK", Part::FirstPeck),
    ("SUBPECK", Part::Peck),
    ("INCR", Part::Peck),
    ("STEP", Part::Peck),
    ("DWELL", Part::Dwell),
    ("REV", Part::DwellTurns),
    ("TPI", Part::ThreadsPerInch),
    ("DIAMET", Part::Diameter),
    ("DIAMETR", Part::Diameter),
    ("TLANGL", Part::Angle),
    ("ANGLE", Part::Angle),
];

/// The words and values of a `CYCLE` statement.
#[derive(Default)]
struct Parts {
    /// By [`Part`].
    values: [Option<f64>; PARTS.len()],
    feed: Option<Feed>,
    /// Retract to the level before the cycle.
    to_initial: bool,
}

impl Parts {
    fn get(&self, part: Part) -> Option<f64> {
        self.values.get(part as usize).copied().flatten()
    }
}

/// What the first words of a `CYCLE` statement ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Drill,
    Face,
    Countersink,
    Deep,
    BreakChip,
    Tap,
    Ream,
    Bore,
}

/// No peck is shorter, mm: with the three decimals of its word it would be none.
const SHORTEST_PECK: f64 = 1e-3;

/// Names of cycles, longest first.
const KINDS: [(&[&str], Kind); 15] = [
    (&["DRILL", "DEEP"], Kind::Deep),
    (&["DRILL", "BRKCHP"], Kind::BreakChip),
    (&["DRILL", "CSINK"], Kind::Countersink),
    (&["BORE", "DRAG"], Kind::Bore),
    (&["DRILL"], Kind::Drill),
    (&["THRU"], Kind::Drill),
    (&["FACE"], Kind::Face),
    (&["CSINK"], Kind::Countersink),
    (&["DEEP2"], Kind::Deep),
    (&["DEEP"], Kind::Deep),
    (&["BRKCHP"], Kind::BreakChip),
    (&["TAP", "FLOAT"], Kind::Tap),
    (&["TAP"], Kind::Tap),
    (&["REAM"], Kind::Ream),
    // The bore that stops the spindle is BORE,DRAG; this one feeds out again (Siemens NX, its posts: G85 and G86; Autodesk
    // FeatureCAM: "Bore (F-F)"). G85 where G86 was meant scraps no bore; a standing insert dragged up the wall does.
    (&["BORE"], Kind::Ream),
];

/// Bores of Siemens NX that are none of the kinds, and why.
const OTHER_BORES: [(&str, &str); 3] = [
    (
        "NODRAG",
        "orients the spindle and moves off the wall before it goes out, on a path that is not given",
    ),
    ("BACK", "goes in off the axis and bores upwards, on a path that is not given"),
    ("MANUAL", "stops in the hole for the operator to take the tool out"),
];

/// The active cycle.
#[derive(Clone, Debug)]
pub(super) struct ActiveCycle {
    /// Of its statement.
    line: u32,
    /// As its statement gives it; pitch, hand and a dwell in turns follow at each hole.
    cycle: Cycle,
    /// Threads an inch of a tap, where the statement gives them.
    threads: Option<f64>,
    /// Dwell in turns of the spindle.
    turns: Option<f64>,
    /// Retract to the level at which the tool was before the cycle.
    to_initial: bool,
    /// Where the tool was before the cycle, where that is known.
    initial: Option<Vec3>,
    /// The cycle of the last `Op::Cycle`.
    written: Option<Cycle>,
}

impl ActiveCycle {
    /// Line of its statement.
    pub fn line(&self) -> u32 {
        self.line
    }
}

impl ActiveCycle {
    /// The feed of the cycle itself.
    pub(super) fn feed(&self) -> Option<Feed> {
        self.cycle.feed
    }
}

impl Reader {
    /// `CYCLE/kind,word,value,...`, `CYCLE/OFF`, `CYCLE/ON`; `CYCLE/INIT` and `CYCLE/CLEAR` of
    /// SolidWorks CAM before the kind.
    pub(super) fn cycle_statement(&mut self, statement: &Statement) -> Outcome {
        self.no_pending_circle()?;
        self.ready = Ready::No;
        match () {
            () if statement.is(0, "OFF") => {
                self.end_cycle(statement);
                return Ok(());
            }
            () if statement.is(0, "ON") => {
                let initial = self.tip.map(|tip| tip.point());
                let last = self.cycle.take().or_else(|| self.last_cycle.take());
                self.cycle = last.map(|last| ActiveCycle { initial, ..last });
                return match self.cycle {
                    Some(_) => Ok(()),
                    None => Err(Fault::new(Rule::Malformed, "no cycle has been given yet")),
                };
            }
            // Both say to which level the tool goes back between holes. The statement that follows gives
            // RTRCTO, the higher of the two, and that is what is kept.
            () if statement.is(0, "INIT") || statement.is(0, "CLEAR") => {
                return statement.count(&[1], "CYCLE/INIT or CYCLE/CLEAR").map(drop);
            }
            () => {}
        }
        if matches!(self.next, Next::Rapid) {
            let message = "RAPID before a cycle: is the next GOTO a rapid or a hole?";
            return Err(Fault::new(Rule::Unsupported, message).help(
                "write the RAPID after the cycle, or \
                                                               not at all",
            ));
        }
        let active = self.define(statement)?;
        self.cycle = Some(active);
        Ok(())
    }

    fn end_cycle(&mut self, statement: &Statement) {
        let Some(mut active) = self.cycle.take() else { return };
        if active.written.take().is_some() {
            self.push(statement.line, Op::CycleOff);
        }
        self.last_cycle = Some(active);
    }

    /// The cycle that `statement` describes.
    fn define(&mut self, statement: &Statement) -> Result<ActiveCycle, Box<Fault>> {
        let (words, kind) = self.kind(statement)?;
        if statement.is(0, "TAP") && statement.is(1, "FLOAT") {
            let help = "a floating holder takes it too; check which one holds the tap";
            let message = "TAP,FLOAT is written as any tap, with its pitch";
            self.report.warn(statement, Rule::TapHolder, message, help);
        }
        let parts = self.parts(statement, words)?;
        let clearance = parts.get(Part::Clearance).ok_or_else(|| {
            Fault::new(
                Rule::NoClearPlane,
                "this cycle does not say from which height the tool feeds",
            )
            .help("add RAPTO,height or CLEAR,height")
        })?;
        let depth = self.depth(kind, &parts)?;
        if clearance <= -depth {
            let message = "the tool would feed from below the bottom of the hole";
            return Err(Fault::new(Rule::NoClearPlane, message));
        }
        let retract = parts.get(Part::Retract).unwrap_or(clearance);
        if retract < clearance && !parts.to_initial {
            let help = "the tool goes back to the higher of the two";
            self.report.warn(statement, Rule::Retract, "RTRCTO is lower than RAPTO", help);
        }
        let kind = cycle_kind(kind, &parts)?;
        let (first_peck, peck) = (parts.get(Part::FirstPeck), parts.get(Part::Peck));
        let mut pecks = first_peck.iter().chain(&peck).peekable();
        let is_pecking = matches!(kind, CycleKind::Deep | CycleKind::BreakChip);
        if is_pecking != pecks.peek().is_some() || pecks.any(|peck| *peck < SHORTEST_PECK) {
            let message = "a cycle that pecks, and no other, takes a peck of 0.001 mm or more";
            return Err(
                Fault::new(Rule::Peck, message).help("write DEEP or BRKCHP with INCR,depth")
            );
        }
        let cycle = Cycle {
            kind,
            depth,
            clearance,
            retract: retract.max(clearance),
            feed: parts.feed,
            dwell: parts.get(Part::Dwell).unwrap_or(0.0),
            first_peck,
            peck,
        };
        let (threads, turns) = (parts.get(Part::ThreadsPerInch), parts.get(Part::DwellTurns));
        let (initial, written) = match &self.cycle {
            Some(active) => (active.initial, active.written),
            None => (self.tip.map(|tip| tip.point()), None),
        };
        let (line, to_initial) = (statement.line, parts.to_initial);
        Ok(ActiveCycle { line, cycle, threads, turns, to_initial, initial, written })
    }

    /// The words and values of `statement` from field `i` on.
    fn parts(&mut self, statement: &Statement, mut i: usize) -> Result<Parts, Box<Fault>> {
        let mut parts = Parts::default();
        while i < statement.fields.len() {
            if let Some(unit) = FeedUnit::of(statement, i) {
                let number = statement.number(i + 1, "the feed")?;
                let feed = self.feed_of(number, unit).map_err(|fault| fault.fields(i + 1, 1))?;
                parts.feed = Some(feed);
                i += 2;
                continue;
            }
            if let Some(word) = ["OPTION", "CAM"].iter().find(|word| statement.is(i, word)) {
                // Codes of one control (Siemens NX); OPTION may stand alone.
                let has_value = matches!(statement.fields.get(i + 1), Some(Field::Number(_)));
                if !has_value && *word == "CAM" {
                    statement.number(i + 1, "its value")?;
                }
                let message = format!("{word} of a cycle is not passed on");
                let help = "check whether the job needs it";
                self.report.warn(statement, Rule::IgnoredWord, &message, help);
                i += 1 + usize::from(has_value);
                continue;
            }
            let known = PARTS.iter().find(|(word, _)| statement.is(i, word));
            let (word, mut part) = *known.ok_or_else(|| {
                Fault::new(Rule::Unsupported, "this is not known of a cycle")
                    .help("write a word and its value: FEDTO, RAPTO, RTRCTO, INCR, DWELL, MMPM")
                    .fields(i, 1)
            })?;
            if part == Part::Retract && statement.is(i + 1, "AUTO") {
                parts.to_initial = true;
                i += 2;
                continue;
            }
            if part == Part::Dwell && statement.is(i + 1, "REV") {
                part = Part::DwellTurns;
                i += 1;
            }
            let number = statement.number(i + 1, "its value")?;
            if matches!(statement.fields.get(i + 2), Some(Field::Number(_))) {
                return Err(
                    Fault::new(Rule::Unsupported, "one value is taken here").fields(i + 2, 1)
                );
            }
            // Creo: a return of 0 is to the retract plane.
            parts.to_initial |= word == "RETURN" && number == 0.0;
            let number = match part {
                Part::Dwell | Part::DwellTurns => is_dwell(number).map(|()| number),
                Part::ThreadsPerInch | Part::Angle => Ok(number),
                _ => self.length(number),
            };
            let number = number.map_err(|fault| fault.fields(i + 1, 1))?;
            let other = match part {
                Part::Dwell => Part::DwellTurns,
                Part::DwellTurns => Part::Dwell,
                part => part,
            };
            if let Some(earlier) = parts.get(part).or(parts.get(other)) {
                self.twice(statement, i, part, earlier != number)?;
            }
            let slot = &mut parts.values[part as usize];
            // Of two heights from which to feed, the higher is safe.
            *slot = Some(slot.map_or(number, |earlier| earlier.max(number)));
            i += 2;
        }
        Ok(parts)
    }

    /// A part that is given twice: only two heights from which to feed make sense together.
    fn twice(&mut self, statement: &Statement, field: usize, part: Part, differ: bool) -> Outcome {
        if part != Part::Clearance {
            return Err(Fault::new(Rule::Malformed, "this is given twice").fields(field, 2));
        }
        if differ {
            let help = "the tool feeds from the higher of the two";
            self.report.warn(statement, Rule::ClearPlane, "CLEAR and RAPTO are both given", help);
        }
        Ok(())
    }

    /// How many words name the cycle, and which it is.
    fn kind(&self, statement: &Statement) -> Result<(usize, Kind), Box<Fault>> {
        let matches = |words: &&[&str]| words.iter().enumerate().all(|(i, w)| statement.is(i, w));
        let other =
            OTHER_BORES.iter().find(|(word, _)| statement.is(0, "BORE") && statement.is(1, word));
        if let Some((word, reason)) = other {
            return Err(Fault::new(Rule::Unsupported, format!("BORE,{word} {reason}"))
                .help("let the CAM system write BORE or BORE,DRAG, or the single moves")
                .fields(0, 2));
        }
        let known = KINDS.iter().find(|(words, _)| matches(words));
        let (words, kind) = known.ok_or_else(|| {
            Fault::new(Rule::Unsupported, "this cycle is not known")
                .help("cycles are DRILL, DEEP, DEEP2, BRKCHP, TAP, BORE, REAM, FACE, CSINK, THRU")
                .fields(0, 1)
        })?;
        if matches!(statement.fields.get(words.len()), Some(Field::Number(_))) {
            return Err(self.by_position().fields(words.len(), 1));
        }
        Ok((words.len(), *kind))
    }

    /// The refusal of a cycle whose values have no words. What each place means is not in the file:
    /// CATIA fills it from the table of the machine (Dassault Systèmes, *PP Tables and Word Syntaxes*:
    /// `CYCLE/TAP,%MFG_TOTAL_DEPTH,%MFG_CLEAR_TIP`; published files have depth, feed, unit, clearance,
    /// and others two lengths before the feed), Creo counts `z` as the depth to feed to (PTC, *CL Output
    /// for Holemaking Cycles*) and does not say from where.
    #[cold]
    fn by_position(&self) -> Box<Fault> {
        let (message, help) = match self.dialect {
            Dialect::Catia => (
                "a cycle by position: what each place means is in the PP table of the CATIA machine, not \
                 in the file",
                "let the PP table write words: CYCLE/DRILL,DEPTH,depth,MMPM,feed,CLEAR,height; or \
                 output the single moves",
            ),
            Dialect::Creo => (
                "a cycle by position (cycle_format fixed): from where its depths count is not said",
                "set the Creo option cycle_format to couplet",
            ),
            _ => (
                "the form of ISO 4343:1978, by position",
                "let the CAM system write words and values: FEDTO,depth,RAPTO,height",
            ),
        };
        Fault::new(Rule::Unsupported, message).help(help)
    }

    /// The depth below the point of the hole. Siemens NX gives it as a height, below zero.
    fn depth(&self, kind: Kind, parts: &Parts) -> Result<f64, Box<Fault>> {
        let depth = match (parts.get(Part::Depth), parts.get(Part::Diameter)) {
            (Some(depth), _) if self.dialect == Dialect::Nx => -depth,
            (Some(depth), _) => depth,
            (None, Some(diameter)) if kind == Kind::Countersink => {
                let angle = parts.get(Part::Angle).or(self.point_angle);
                let angle = angle.filter(|a| (1.0..180.0).contains(a));
                let angle = angle.ok_or_else(|| {
                    Fault::new(
                        Rule::CycleDepth,
                        "a countersink by diameter needs the tool's point angle",
                    )
                    .help("add TLANGL,degrees or FEDTO,depth")
                })?;
                diameter / 2.0 / (angle / 2.0).to_radians().tan()
            }
            _ => f64::NAN,
        };
        if depth > 0.0 {
            return Ok(depth);
        }
        let message = "this cycle has no depth below the point of the hole";
        let sign = match self.dialect {
            Dialect::Nx => "FEDTO,-depth (NX counts it as a height)",
            _ => "FEDTO,depth or DEPTH,depth, greater than 0",
        };
        Err(Fault::new(Rule::CycleDepth, message).help(format!("give {sign}")))
    }

    /// The tap of `active` with the spindle and the feed that hold now. The pitch is the threads an
    /// inch, or the feed a turn, or the feed a minute over the speed.
    fn tap(&self, active: &ActiveCycle) -> Result<CycleKind, Box<Fault>> {
        let rpm = speed_of(self.spindle);
        let pitch = match (active.threads, active.cycle.feed.or(self.feed)) {
            (Some(threads), _) => geom::INCH / threads,
            (None, Some(Feed::PerTurn(pitch))) => pitch,
            (None, Some(Feed::PerMinute(feed))) if rpm > 0.0 => feed / rpm,
            _ => f64::NAN,
        };
        if !(pitch > 0.0 && pitch.is_finite()) {
            return Err(unknown_pitch());
        }
        let left = matches!(self.spindle, Spindle::CounterClockwise(_));
        Ok(CycleKind::Tap { pitch, left })
    }

    /// The cycle of `active` as it is at a hole here. A tap and a dwell in turns hang on the speed, the
    /// hand and the feed, which are modal and may change after the statement of the cycle and between two
    /// holes.
    fn at_this_hole(&self, active: &ActiveCycle) -> Result<Cycle, Box<Fault>> {
        let mut cycle = active.cycle;
        if matches!(cycle.kind, CycleKind::Tap { .. }) {
            cycle.kind = self.tap(active)?;
        }
        if let Some(turns) = active.turns {
            cycle.dwell = self.dwell(turns, true)?;
        }
        Ok(cycle)
    }

    /// One hole of the active cycle, at `pose`.
    pub(super) fn hole(&mut self, statement: &Statement, pose: Pose) -> Outcome {
        let Some(active) = &self.cycle else { return Ok(()) };
        let mut cycle = self.at_this_hole(active)?;
        let axis = self.axis;
        if active.to_initial {
            let Some(initial) = active.initial else {
                return Err(Fault::new(
                    Rule::NoStart,
                    "the retract level is that before the cycle, which \
                                                   is not known",
                )
                .help("add a RAPID GOTO before the cycle"));
            };
            cycle.retract = cycle.clearance.max((initial - pose.point()).dot(axis));
        }
        if active.written != Some(cycle) {
            let line = active.line;
            self.push(line, Op::Cycle(Box::new(cycle)));
            if let Some(active) = &mut self.cycle {
                active.written = Some(cycle);
            }
        }
        self.push(statement.line, Op::Hole(pose));
        self.arrive(pose);
        self.tip = Some(pose.at(pose.point() + axis * cycle.retract)?);
        Ok(())
    }
}

/// The kind of the neutral program. Pitch and hand of a tap are not known before its hole.
fn cycle_kind(kind: Kind, parts: &Parts) -> Result<CycleKind, Box<Fault>> {
    Ok(match kind {
        Kind::Drill | Kind::Face | Kind::Countersink => CycleKind::Drill,
        Kind::Deep => CycleKind::Deep,
        Kind::BreakChip => CycleKind::BreakChip,
        Kind::Ream => CycleKind::Ream,
        Kind::Bore => CycleKind::Bore,
        Kind::Tap if parts.get(Part::ThreadsPerInch).is_some_and(|threads| threads <= 0.0) => {
            return Err(unknown_pitch());
        }
        Kind::Tap => CycleKind::Tap { pitch: f64::NAN, left: false },
    })
}

#[cold]
fn unknown_pitch() -> Box<Fault> {
    Fault::new(Rule::TapPitch, "the pitch of this tap is not known")
        .help("give MMPR,pitch or TPI,threads, or feed and spindle speed")
}
