//! The drilling cycles: from the arguments of a call to what it does in a hole.
//!
//! Parameters in order, their meaning and the motion: `docs/controls/sinumerik.md`, which names the
//! manuals. What a call asks for and [`Cycle`] cannot say is refused.

use super::state::State;
use super::state::modal::{Drilling, Pause};
use crate::event::Risk;
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use crate::sinumerik::language::call::Call;
use crate::sinumerik::language::commands::FeedType;
use crate::sinumerik::language::forms::{Form, Operation};
use geom::Vec3;
use program::{Cycle, CycleKind, Diagnostic, Feed, Rule, Spindle, Withdrawal};

/// Parameters that may only be left out or have one of these values: others change what the cycle
/// does in a way that is not modelled. `_AXN` 0 and 3 are the axis perpendicular to the plane, 0 in
/// the modes is the meaning of the older cycles, `_PITA` 1 is a pitch in mm.
const FIXED: &[(&str, &[f64])] = &[
    ("_AXN", &[0.0, 3.0]),
    ("_PITA", &[0.0, 1.0]),
    ("_TECHNO", &[0.0]),
    ("_VARI", &[0.0]),
    ("_DAM", &[0.0]),
    ("_PITM", &[0.0]),
    ("_PTAB", &[]),
    ("_PTABA", &[]),
    ("_GMODE", &[0.0]),
    ("_DMODE", &[0.0]),
    ("_AMODE", &[0.0]),
    ("S_ZA", &[0.0]),
    ("S_FA", &[0.0]),
    ("S_ZD", &[0.0]),
    ("S_FD", &[0.0]),
    ("FRF", &[1.0]),
];

/// Coarse pitch of metric threads, mm, by nominal diameter (ISO 261).
const COARSE_PITCH: &[(f64, f64)] = &[
    (3.0, 0.5),
    (4.0, 0.7),
    (5.0, 0.8),
    (6.0, 1.0),
    (8.0, 1.25),
    (10.0, 1.5),
    (12.0, 1.75),
    (14.0, 2.0),
    (16.0, 2.0),
    (18.0, 2.5),
    (20.0, 2.5),
    (22.0, 2.5),
    (24.0, 3.0),
    (27.0, 3.0),
    (30.0, 3.5),
    (33.0, 3.5),
    (36.0, 4.0),
    (39.0, 4.0),
    (42.0, 4.5),
    (45.0, 4.5),
    (48.0, 5.0),
];

/// The arguments of a call, by name.
struct Arguments<'a> {
    source: &'a Source<'a>,
    call: &'a Call,
    form: &'static Form,
    /// mm in a unit of length.
    unit: f64,
}

impl Arguments<'_> {
    fn error(&self, rule: Rule, message: impl AsRef<str>) -> Box<Diagnostic> {
        let message = format!("{}: {}", self.form.name, message.as_ref());
        self.source.block_error(rule, message)
    }

    fn get(&self, name: &str) -> Outcome<Option<f64>> {
        match self.form.parameters.iter().position(|n| *n == name) {
            Some(index) => self.call.number(self.source, index),
            None => Ok(None),
        }
    }

    fn required(&self, name: &str) -> Outcome<f64> {
        self.get(name)?
            .ok_or_else(|| self.error(Rule::CycleParameter, format!("{name} is missing")))
    }

    fn or_zero(&self, name: &str) -> Outcome<f64> {
        Ok(self.get(name)?.unwrap_or(0.0))
    }

    fn length(&self, name: &str) -> Outcome<Option<f64>> {
        Ok(self.get(name)?.map(|value| value * self.unit))
    }

    /// A length that is written without a sign.
    fn unsigned(&self, name: &str) -> Outcome<Option<f64>> {
        let value = self.length(name)?;
        if value.is_some_and(|v| v < 0.0) {
            return Err(self.error(Rule::CycleParameter, format!("{name} has no sign")));
        }
        Ok(value)
    }

    fn check(&self) -> Outcome {
        if self.call.arguments.len() > self.form.parameters.len() {
            let most = self.form.parameters.len();
            return Err(
                self.error(Rule::CycleParameter, format!("it has at most {most} parameters"))
            );
        }
        for (name, allowed) in FIXED {
            if let Some(value) = self.get(name)?
                && !allowed.contains(&value)
            {
                let message = format!("{name} = {value} is not supported");
                return Err(self.error(Rule::Unsupported, message));
            }
        }
        Ok(())
    }

    /// A depth that is given absolute or relative to the reference plane; the depth below it, mm.
    /// A relative depth of 0 is none, as in the calls of older posts. Where both are given they must
    /// agree (the control would take the relative one).
    fn depth(&self, absolute: &str, relative: &str, surface: f64) -> Outcome<Option<f64>> {
        let from_absolute = self.length(absolute)?.map(|level| surface - level);
        let from_relative = self.unsigned(relative)?.filter(|depth| *depth > 0.0);
        match (from_absolute, from_relative) {
            (Some(a), Some(r)) if (a - r).abs() > 1e-6 => Err(self.error(
                Rule::CycleDepth,
                format!("{absolute} says a depth of {a} mm and {relative} one of {r} mm"),
            )),
            (a, r) => Ok(r.or(a)),
        }
    }
}

impl Drilling {
    /// Reads a call.
    ///
    /// # Errors
    /// A parameter is missing, out of its range, or asks for what [`Cycle`] cannot say.
    pub fn read(
        source: &Source,
        call: &Call,
        form: &'static Form,
        state: &State,
    ) -> Outcome<Drilling> {
        let arguments = Arguments { source, call, form, unit: state.unit };
        arguments.check()?;
        let surface = arguments.required("RFP")? * state.unit;
        let retract = arguments.required("RTP")? * state.unit - surface;
        let depth = arguments.depth("DP", "DPR", surface)?;
        let relative = arguments.length("DP")?.is_none();
        if retract < 0.0 || retract == 0.0 && relative {
            return Err(arguments.error(
                Rule::ReferencePlane,
                "the retraction plane RTP must lie above the reference plane RFP (alarm 61101)",
            ));
        }
        let Some(depth) = depth else {
            return Err(arguments.error(Rule::CycleDepth, "there is neither DP nor DPR"));
        };
        if depth <= 0.0 {
            return Err(
                arguments.error(Rule::CycleDepth, "the depth is not below the reference plane")
            );
        }
        let mut drilling = Drilling {
            cycle: Cycle {
                kind: CycleKind::Drill,
                depth,
                clearance: arguments.unsigned("SDIS")?.unwrap_or(0.0),
                retract,
                feed: None,
                dwell: 0.0,
                first_peck: None,
                peck: None,
            },
            dwell: Pause::signed(arguments.or_zero("DTB")?),
            surface,
            spindle_before: None,
            spindle_after: None,
            needs_feed: true,
            risks: Vec::new(),
        };
        match form.action {
            Operation::Drill => {}
            Operation::Peck => drilling.peck(&arguments)?,
            Operation::RigidTap => drilling.rigid_tap(&arguments, state)?,
            Operation::Tap => drilling.tap(&arguments, state)?,
            Operation::Ream => drilling.ream(&arguments, state)?,
            Operation::Bore => drilling.bore(&arguments, state)?,
            Operation::StopInHole => {
                let message = "it stops the program in the hole; use CYCLE86";
                return Err(arguments.error(Rule::Unsupported, message));
            }
        }
        Ok(drilling)
    }

    fn peck(&mut self, arguments: &Arguments) -> Outcome {
        let Some(first) = arguments.depth("FDEP", "FDPR", self.surface)? else {
            let message = "there is neither FDEP nor FDPR (alarm 61107)";
            return Err(arguments.error(Rule::CycleDepth, message));
        };
        if first <= 0.0 || first > self.cycle.depth + 1e-9 {
            let message = format!(
                "the first depth of {first} mm is not between 0 and {} mm (alarm 61107)",
                self.cycle.depth
            );
            return Err(arguments.error(Rule::CycleDepth, message));
        }
        let single = first >= self.cycle.depth - 1e-9;
        if !single && arguments.or_zero("DAM")? != 0.0 {
            let message = "pecks that grow less (DAM) are not supported; leave DAM at 0";
            return Err(arguments.error(Rule::Unsupported, message));
        }
        self.cycle.kind = match arguments.or_zero("VARI")? {
            0.0 => CycleKind::BreakChip,
            1.0 => CycleKind::Deep,
            other => {
                let message = format!("VARI is 0 or 1, not {other}");
                return Err(arguments.error(Rule::CycleParameter, message));
            }
        };
        // The dwell at the final depth is DTB unless _DTD says another.
        let (dwell, final_dwell) = (arguments.or_zero("DTB")?, arguments.or_zero("_DTD")?);
        if final_dwell != 0.0 {
            self.dwell = Pause::signed(final_dwell);
        }
        // DTB is then that of the other depths alone; DTS is that above the hole, where chips are cleared.
        let differs = final_dwell != 0.0 && dwell != 0.0 && dwell != final_dwell;
        let clears = self.cycle.kind == CycleKind::Deep && arguments.or_zero("DTS")? != 0.0;
        if differs || clears {
            self.risks.push(Risk::PECK_DWELL);
        }
        self.cycle.first_peck = Some(first);
        self.cycle.peck = Some(first);
        Ok(())
    }

    /// The pitch in mm and whether the thread is left-handed.
    fn pitch(arguments: &Arguments) -> Outcome<(f64, bool)> {
        if arguments.unit != 1.0 {
            return Err(arguments.error(Rule::Unsupported, "tapping in inches is not supported"));
        }
        let size = arguments.get("MPIT")?.filter(|size| *size != 0.0);
        let pitch = arguments.get("PIT")?.filter(|pitch| *pitch != 0.0);
        let signed = match (size, pitch) {
            (Some(size), None) => {
                let entry = COARSE_PITCH.iter().find(|(diameter, _)| *diameter == size.abs());
                let Some((_, pitch)) = entry else {
                    let message = format!("MPIT {size} is no thread from M3 to M48");
                    return Err(arguments.error(Rule::CycleParameter, message));
                };
                pitch * size.signum()
            }
            (None, Some(pitch)) => pitch,
            (None, None) => {
                let message = "there is neither MPIT nor PIT";
                return Err(arguments.error(Rule::CycleParameter, message));
            }
            (Some(_), Some(_)) => {
                let message = "MPIT and PIT contradict each other; give one";
                return Err(arguments.error(Rule::CycleParameter, message));
            }
        };
        Ok((signed.abs(), signed < 0.0))
    }

    /// `SDAC`: what the spindle does after the cycle.
    fn direction(arguments: &Arguments, name: &str, speed: Option<f64>) -> Outcome<Spindle> {
        let given = || {
            let message = format!("{name} starts the spindle and no speed has been given by S");
            speed.ok_or_else(|| arguments.error(Rule::Spindle, message))
        };
        match arguments.or_zero(name)? {
            3.0 => Ok(Spindle::Clockwise(given()?)),
            4.0 => Ok(Spindle::CounterClockwise(given()?)),
            5.0 if name == "SDAC" => Ok(Spindle::Off),
            other => Err(arguments.error(
                Rule::CycleParameter,
                format!("{name} = {other} is no direction of the spindle (alarm 61102)"),
            )),
        }
    }

    fn rigid_tap(&mut self, arguments: &Arguments, state: &State) -> Outcome {
        let (pitch, left) = Drilling::pitch(arguments)?;
        let speed = arguments.required("SST")?;
        if speed <= 0.0 {
            return Err(
                arguments.error(Rule::CycleParameter, "the tapping speed SST must be above 0")
            );
        }
        let back = arguments.or_zero("SST1")?;
        if back < 0.0 {
            return Err(arguments.error(Rule::CycleParameter, "SST1 has no sign"));
        }
        if back != 0.0 && back != speed {
            self.risks.push(Risk::TAP_RETURN);
        }
        self.cycle.kind = CycleKind::Tap { pitch, left };
        self.needs_feed = false;
        self.spindle_before =
            Some(if left { Spindle::CounterClockwise(speed) } else { Spindle::Clockwise(speed) });
        let after = Drilling::direction(arguments, "SDAC", state.speed)?;
        let turns_so = |spindle: Option<Spindle>| {
            spindle.is_some_and(|s| std::mem::discriminant(&s) == std::mem::discriminant(&after))
        };
        if after != Spindle::Off && !turns_so(Some(state.spindle)) && !turns_so(self.spindle_before)
        {
            self.risks.push(Risk::TURNS_BACK);
        }
        self.spindle_after = Some(after);
        Ok(())
    }

    fn tap(&mut self, arguments: &Arguments, state: &State) -> Outcome {
        let encoder = arguments.or_zero("ENC")?;
        if ![0.0, 11.0, 20.0].contains(&encoder) {
            let message = format!("ENC = {encoder}, a pitch from the feed, is not supported");
            return Err(arguments.error(Rule::Unsupported, message));
        }
        if arguments.or_zero("SDR")? != 0.0 {
            let message = "SDR must be 0: the cycle turns the spindle round by itself";
            return Err(arguments.error(Rule::Unsupported, message));
        }
        let (pitch, negative) = Drilling::pitch(arguments)?;
        let left = matches!(state.spindle, Spindle::CounterClockwise(_));
        if negative || state.spindle == Spindle::Off {
            let message = "the running spindle (M3, M4) gives the hand of the thread, not a sign";
            return Err(arguments.error(Rule::CycleParameter, message));
        }
        self.cycle.kind = CycleKind::Tap { pitch, left };
        self.needs_feed = false;
        Ok(())
    }

    fn ream(&mut self, arguments: &Arguments, state: &State) -> Outcome {
        self.cycle.kind = CycleKind::Ream;
        let feed = arguments.get("FFR")?;
        let back = arguments.get("RFF")?;
        if feed.is_some_and(|f| f <= 0.0) || back.is_some_and(|f| f <= 0.0) {
            return Err(arguments.error(Rule::CycleParameter, "FFR and RFF must be above 0"));
        }
        if back != feed {
            let message = "feeds in (FFR) and out (RFF) that differ are not supported";
            return Err(arguments.error(Rule::Unsupported, message));
        }
        if let Some(feed) = feed {
            self.needs_feed = false;
            self.cycle.feed = match state.feed_type {
                FeedType::PerMinute => Some(Feed::PerMinute(feed * state.feed_unit)),
                FeedType::PerTurn => Some(Feed::PerTurn(feed * state.feed_unit)),
                FeedType::InverseTime => {
                    let message = "a feed in a cycle needs G94 or G95";
                    return Err(arguments.error(Rule::CycleParameter, message));
                }
            };
        }
        Ok(())
    }

    fn bore(&mut self, arguments: &Arguments, state: &State) -> Outcome {
        let mut aside = Vec3::ZERO;
        for (axis, name) in ["RPA", "RPO", "RPAP"].into_iter().enumerate() {
            aside[axis] = arguments.length(name)?.unwrap_or(0.0);
        }
        self.cycle.kind = match aside == Vec3::ZERO {
            true => CycleKind::Bore,
            false => {
                CycleKind::FineBore(Withdrawal { aside, angle: Some(arguments.or_zero("POSS")?) })
            }
        };
        self.spindle_before = Some(Drilling::direction(arguments, "SDIR", state.speed)?);
        // The spindle stands in position at the end; nothing starts it again.
        self.spindle_after = Some(Spindle::Off);
        Ok(())
    }
}
