//! Cycles: what `CYCL DEF` says, and what the hole cycles do.

use super::functions::When;
use super::scan::{Result, Scanner};
use super::state::Control;
use super::words::{LINEAR, Words, slot};
use geom::Vec3;
use program::{Cycle, CycleKind, Feed, Op};

/// A hole cycle, ready to be called.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Definition {
    /// What it does, from the surface.
    pub(super) cycle: Cycle,
    /// Surface of the part (Q203) in the coordinates of the program, mm.
    pub(super) surface: f64,
}

/// The unit of a cycle parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unit {
    Length,
    /// mm/min; `MAX` for rapid is infinite.
    Feed,
    /// Seconds, counts, degrees, switches.
    Plain,
}

/// The parameters of the cycles and their units.
const UNITS: [(u16, Unit); 26] = [
    (200, Unit::Length),
    (201, Unit::Length),
    (202, Unit::Length),
    (203, Unit::Length),
    (204, Unit::Length),
    (205, Unit::Length),
    (206, Unit::Feed),
    (208, Unit::Feed),
    (210, Unit::Plain),
    (211, Unit::Plain),
    (212, Unit::Length),
    (213, Unit::Plain),
    (214, Unit::Plain),
    (239, Unit::Length),
    (253, Unit::Feed),
    (256, Unit::Length),
    (257, Unit::Length),
    (258, Unit::Length),
    (259, Unit::Length),
    (336, Unit::Plain),
    (339, Unit::Plain),
    (379, Unit::Length),
    (395, Unit::Plain),
    (403, Unit::Plain),
    (420, Unit::Plain),
    (421, Unit::Plain),
];

/// A cycle with Q parameters: its number, those it needs, and those newer software adds.
struct Layout {
    number: u16,
    needs: &'static [u16],
    takes: &'static [u16],
}

const LAYOUTS: [Layout; 9] = [
    Layout { number: 200, needs: &[200, 201, 206, 202, 210, 203, 204], takes: &[211, 395] },
    Layout { number: 201, needs: &[200, 201, 206, 211, 208, 203, 204], takes: &[] },
    Layout { number: 202, needs: &[200, 201, 206, 211, 208, 203, 204, 214], takes: &[336] },
    Layout {
        number: 203,
        needs: &[200, 201, 206, 202, 210, 203, 204, 212, 213, 205, 211, 208, 256],
        takes: &[395],
    },
    Layout {
        number: 205,
        needs: &[200, 201, 206, 202, 203, 204, 212, 205, 258, 259, 257, 256, 211, 379, 253],
        takes: &[208, 395],
    },
    Layout { number: 206, needs: &[200, 201, 206, 211, 203, 204], takes: &[] },
    Layout { number: 207, needs: &[200, 201, 239, 203, 204], takes: &[] },
    Layout { number: 209, needs: &[200, 201, 239, 203, 204, 257, 256, 336], takes: &[403] },
    Layout { number: 247, needs: &[339], takes: &[] },
];

/// Retraction feeds from here on are rapid: the number that the control shows for `MAX`.
const RAPID_FEED: f64 = 99_999.0;

/// A `CYCL DEF` with Q parameters that is being read.
pub(super) struct Open {
    layout: &'static Layout,
    given: Vec<(u16, f64)>,
}

impl Control<'_, '_> {
    /// `CYCL DEF 2xx NAME`, from behind `CYCL DEF`; the parameters are in the lines that follow.
    pub(super) fn open_cycle(
        &self,
        s: &mut Scanner,
        number: u32,
        span: (usize, usize),
    ) -> Result<Open> {
        let layout = LAYOUTS.iter().find(|l| u32::from(l.number) == number).ok_or_else(|| {
            s.error("unsupported", span, format!("cycle {number} is not supported yet"))
        })?;
        Ok(Open { layout, given: Vec::with_capacity(16) })
    }

    /// One line `Q200=+2 ;SET-UP CLEARANCE` of an open cycle.
    pub(super) fn cycle_parameter(&self, s: &mut Scanner, open: &mut Open) -> Result<()> {
        let (token, span) = s.token();
        let text = std::str::from_utf8(token).unwrap_or_default();
        let split = text.strip_prefix('Q').and_then(|rest| rest.split_once('='));
        let Some((number, value)) = split.and_then(|(n, v)| Some((n.parse::<u16>().ok()?, v)))
        else {
            let message = "a parameter of the cycle (Q200=...) is expected here";
            return Err(s.error("syntax", span, message));
        };
        let unit = UNITS.iter().find(|(q, _)| *q == number).map(|(_, unit)| *unit);
        let known = open.layout.needs.contains(&number) || open.layout.takes.contains(&number);
        let (Some(unit), true) = (unit, known) else {
            let message = format!("cycle {} has no parameter Q{number}", open.layout.number);
            return Err(s.error("cycle-parameter", span, message));
        };
        let mut value = Scanner::within(*s, span.1 - value.len(), span.1);
        if value.is_done() {
            value = *s;
            let (_, end) = s.token();
            value = Scanner::within(value, end.0, end.1);
        }
        let value = match value.peek() {
            b"MAX" | b"FMAX" if number == 208 => f64::INFINITY,
            _ => self.in_unit(value.value()?, unit),
        };
        s.finish()?;
        if open.given.iter().any(|(q, _)| *q == number) {
            return Err(s.error("word-twice", span, format!("Q{number} is given twice")));
        }
        open.given.push((number, value));
        Ok(())
    }

    fn in_unit(&self, value: f64, unit: Unit) -> f64 {
        match unit {
            Unit::Length => value * self.unit,
            Unit::Feed if self.unit == 1.0 => value,
            Unit::Feed => value * super::state::TENTH_INCH,
            Unit::Plain => value,
        }
    }

    /// The last parameter is read: the cycle is checked as a whole.
    pub(super) fn close_cycle(&mut self, s: &Scanner, open: &Open) -> Result<()> {
        let number = open.layout.number;
        if let Some(q) = open.layout.needs.iter().find(|q| open.find(**q).is_none()) {
            let message = format!("cycle {number} lacks its parameter Q{q}");
            return Err(s.error_block("cycle-parameter", message));
        }
        if number == 247 {
            return self.set_datum(s, open.get(339));
        }
        let cycle = open.hole().map_err(|message| {
            s.error_block("cycle-parameter", format!("cycle {number}: {message}"))
        })?;
        self.cycle = Some(Definition { cycle, surface: open.get(203) });
        self.calls_modally = false;
        Ok(())
    }

    /// Cycle 247: a preset becomes the datum, and the datum shift ends.
    fn set_datum(&mut self, s: &Scanner, preset: f64) -> Result<()> {
        if preset.fract() != 0.0 || !(0.0..=9999.0).contains(&preset) {
            return Err(s.error_block("cycle-parameter", "Q339 is the number of a preset"));
        }
        if self.tilt.is_some() {
            return Err(s.error_block("plane", "the datum is set in the untilted plane"));
        }
        self.shift = Vec3::ZERO;
        self.forget_position();
        self.emit(Op::WorkOffset(53 + preset as u32))
    }

    /// `CYCL CALL`, from behind it.
    pub(super) fn cycle_call(&mut self, s: &mut Scanner) -> Result<()> {
        if s.peek() == b"PAT" {
            return Err(s.error_here("unsupported", "CYCL CALL PAT is not supported yet"));
        }
        if s.take(b"POS") {
            return self.cycle_call_at(s);
        }
        let words = Words::read(s, 0, self)?;
        self.functions(s, words.functions, When::Start)?;
        self.call_cycle(s)?;
        self.calls_modally = false;
        self.functions(s, words.functions, When::End)
    }

    /// `CYCL CALL POS X Y Z`: the tool goes there, first in the plane where it is above the surface;
    /// Z adds to the surface of the cycle.
    fn cycle_call_at(&mut self, s: &mut Scanner) -> Result<()> {
        let words = Words::read(s, LINEAR, self)?;
        if !words.has_all(LINEAR) || words.is_incremental(LINEAR) {
            let message = "CYCL CALL POS needs X, Y and Z, absolute";
            return Err(s.error_block("missing-word", message));
        }
        let Some(definition) = self.cycle else {
            return Err(s.error_block("cycle", "no cycle is defined yet"));
        };
        let at = |slot| words.target(slot, f64::NAN);
        let surface = definition.surface + at(slot::Z);
        self.functions(s, words.functions, When::Start)?;
        let rapid = self.set_feed(s, words.feed)?;
        if !rapid {
            let message = "CYCL CALL POS is approached with FMAX here";
            return Err(s.error_block("unsupported", message));
        }
        if self.here.z < surface {
            self.here.z = surface + definition.cycle.clearance;
            self.emit(Op::Rapid(self.pose(self.here)))?;
        }
        self.here = Vec3::new(at(slot::X), at(slot::Y), self.here.z);
        self.emit(Op::Rapid(self.pose(self.here)))?;
        self.cycle = Some(Definition { surface, ..definition });
        let called = self.call_cycle(s);
        self.cycle = Some(definition);
        called?;
        self.functions(s, words.functions, When::End)
    }

    /// A numbered part of an older cycle: `7.1 X+60`, `9.1 DWELL 1.5`, `32.1 T0.01`.
    pub(super) fn cycle_part(&mut self, s: &mut Scanner, cycle: u32, part: u32) -> Result<()> {
        match (cycle, part) {
            (7, _) => self.datum_shift(s),
            (9, 1) => {
                let (_, span) = s.token();
                let seconds = s.value()?;
                s.finish()?;
                if seconds < 0.0 {
                    return Err(s.error("dwell", span, "a dwell is not negative"));
                }
                self.emit(Op::Dwell(seconds))
            }
            // A tolerance changes how the control smooths, not where the program goes.
            (32, 1 | 2) => tolerance(s),
            _ => Err(s.error_block("cycle-parameter", "the cycle has no such part")),
        }
    }

    fn datum_shift(&mut self, s: &mut Scanner) -> Result<()> {
        let words = Words::read(s, LINEAR, self)?;
        if !words.has(LINEAR)
            || words.feed.is_some()
            || words.compensation.is_some()
            || !words.functions.is_empty()
        {
            return Err(s.error_block("cycle-parameter", "cycle 7 takes X, Y or Z here"));
        }
        if self.tilt.is_some() && self.shift != Vec3::ZERO {
            let message = "the datum was already shifted before the plane was tilted";
            let help = "shift the datum before PLANE";
            return Err(s.error_block("plane", message).help(help).into());
        }
        let shift = self.tilt.as_mut().map_or(&mut self.shift, |tilt| &mut tilt.shift);
        let old = *shift;
        for i in 0..3 {
            shift[i] = words.target(i, old[i]);
        }
        self.here += old - *shift;
        Ok(())
    }
}

/// `T0.01`, or `HSC-MODE:1 TA0.5`, or nothing, which ends the tolerance.
fn tolerance(s: &mut Scanner) -> Result<()> {
    while !s.is_done() {
        if s.take(b"HSC-MODE:0") || s.take(b"HSC-MODE:1") {
            continue;
        }
        match s.word()? {
            Some(word) if matches!(word.address, b"T" | b"TA") && word.number.is_some() => {}
            _ => return Err(s.error_block("cycle-parameter", "cycle 32 takes T, HSC-MODE and TA")),
        }
    }
    Ok(())
}

impl Open {
    fn find(&self, q: u16) -> Option<f64> {
        self.given.iter().find(|(number, _)| *number == q).map(|(_, value)| *value)
    }

    /// A parameter that the cycle needs or that is 0 where it is not given.
    fn get(&self, q: u16) -> f64 {
        self.find(q).unwrap_or(0.0)
    }

    /// The cycle in the neutral vocabulary, or why that cannot be.
    fn hole(&self) -> std::result::Result<Cycle, String> {
        let depth = -self.get(201);
        if depth <= 0.0 {
            return Err("the depth Q201 must be negative".into());
        }
        let clearance = self.get(200);
        if clearance < 0.0 || self.get(204) < 0.0 {
            return Err("the clearances Q200 and Q204 must not be negative".into());
        }
        let dwell = self.get(211);
        if !(0.0..=3600.0).contains(&dwell) {
            return Err("the dwell Q211 is 0 to 3600 s".into());
        }
        if self.get(395) != 0.0 {
            return Err("Q395=1 takes the depth from the tool table, which is not at hand".into());
        }
        let feed = self.find(206).map(Feed::PerMinute);
        if feed.is_some() && self.get(206) <= 0.0 {
            return Err("the feed Q206 must be greater than 0".into());
        }
        let mut cycle = Cycle {
            kind: CycleKind::Drill,
            depth,
            clearance,
            // "The 2nd set-up clearance is only effective if it is greater than the set-up clearance".
            retract: clearance.max(self.get(204)),
            feed,
            dwell,
            first_peck: None,
            peck: None,
        };
        match self.layout.number {
            200 => self.peck(&mut cycle, CycleKind::Deep)?,
            201 => cycle.kind = self.feeding_out(CycleKind::Ream)?,
            202 if self.get(214) != 0.0 => {
                return Err("disengaging from the wall (Q214) is not supported yet".into());
            }
            202 if self.rapid_out() => cycle.kind = CycleKind::Bore,
            202 => return Err("boring goes out by rapid: Q208=MAX".into()),
            203 => self.universal_drilling(&mut cycle)?,
            205 => self.universal_pecking(&mut cycle)?,
            206 => cycle.kind = CycleKind::Tap { pitch: f64::NAN, left: false },
            _ => self.rigid_tapping(&mut cycle)?,
        }
        Ok(cycle)
    }

    fn rapid_out(&self) -> bool {
        self.get(208) >= RAPID_FEED
    }

    /// Drilling where the tool goes out by rapid, `slow` where it goes out with the feed in (Q208=0).
    fn feeding_out(&self, slow: CycleKind) -> std::result::Result<CycleKind, String> {
        let out = self.get(208);
        if self.rapid_out() {
            Ok(CycleKind::Drill)
        } else if out == 0.0 || out == self.get(206) {
            Ok(slow)
        } else {
            Err("a retraction feed Q208 other than 0, Q206 or MAX is not supported yet".into())
        }
    }

    /// Pecks of Q202, the later ones less by Q212 down to Q205.
    fn peck(&self, cycle: &mut Cycle, kind: CycleKind) -> std::result::Result<(), String> {
        let (first, decrement, least) = (self.get(202), self.get(212), self.get(205));
        if first <= 0.0 {
            return Err("the plunging depth Q202 must be greater than 0".into());
        }
        if first >= cycle.depth {
            return Ok(());
        }
        if self.get(210) != 0.0 {
            return Err("a dwell at the top (Q210) between pecks is not supported yet".into());
        }
        if decrement < 0.0 || least < 0.0 {
            return Err("the decrement Q212 and the least depth Q205 must not be negative".into());
        }
        // Two depths can be told: the first one, and that of all others.
        let further = if decrement == 0.0 { first } else { (first - decrement).max(least) };
        let ends = decrement == 0.0 || further == least || first + further >= cycle.depth;
        if !ends || further <= 0.0 {
            return Err("pecks that go on decreasing (Q212) are not supported yet".into());
        }
        cycle.kind = kind;
        cycle.first_peck = Some(first);
        cycle.peck = Some(further);
        Ok(())
    }

    fn universal_drilling(&self, cycle: &mut Cycle) -> std::result::Result<(), String> {
        let breaks = self.get(213);
        if breaks < 0.0 || breaks.fract() != 0.0 {
            return Err("the number of breaks Q213 is a whole number".into());
        }
        let kind = if breaks > 0.0 { CycleKind::BreakChip } else { CycleKind::Deep };
        self.peck(cycle, kind)?;
        if let (CycleKind::BreakChip, Some(first), Some(further)) =
            (cycle.kind, cycle.first_peck, cycle.peck)
        {
            if self.get(256) <= 0.0 {
                return Err("the retraction at a chip break Q256 must be greater than 0".into());
            }
            let needed = ((cycle.depth - first) / further - 1e-9).ceil();
            if needed > breaks {
                return Err(format!(
                    "chip breaks with retractions between them are not supported yet: Q213 is {breaks}, \
                     the hole takes {needed}"
                ));
            }
        }
        match (self.feeding_out(CycleKind::Ream)?, cycle.kind) {
            (CycleKind::Drill, _) => Ok(()),
            (slow, CycleKind::Drill) => {
                cycle.kind = slow;
                Ok(())
            }
            _ => Err("pecking goes out by rapid: Q208=MAX".into()),
        }
    }

    fn universal_pecking(&self, cycle: &mut Cycle) -> std::result::Result<(), String> {
        if self.get(379) != 0.0 {
            return Err("a deepened starting point (Q379) is not supported yet".into());
        }
        if self.find(208).is_some() && !self.rapid_out() {
            return Err("pecking goes out by rapid: Q208=MAX".into());
        }
        let chip = self.get(257);
        if chip == 0.0 {
            return self.peck(cycle, CycleKind::Deep);
        }
        if chip < 0.0 || self.get(256) <= 0.0 {
            return Err("chip breaking needs Q257 and Q256 greater than 0".into());
        }
        if self.get(202) < cycle.depth {
            return Err("chip breaks between full retractions are not supported yet".into());
        }
        if chip < cycle.depth {
            cycle.kind = CycleKind::BreakChip;
            cycle.first_peck = Some(chip);
            cycle.peck = Some(chip);
        }
        Ok(())
    }

    fn rigid_tapping(&self, cycle: &mut Cycle) -> std::result::Result<(), String> {
        let pitch = self.get(239);
        if pitch == 0.0 {
            return Err("the pitch Q239 must not be 0".into());
        }
        cycle.kind = CycleKind::Tap { pitch: pitch.abs(), left: pitch < 0.0 };
        let chip = self.get(257);
        if chip < 0.0 {
            return Err("the depth for chip breaking Q257 must not be negative".into());
        }
        if chip > 0.0 && chip < cycle.depth {
            cycle.first_peck = Some(chip);
            cycle.peck = Some(chip);
        }
        Ok(())
    }
}

/// The parts `7` and `1` of `7.1`, or the number alone.
pub(super) fn cycle_number(text: &[u8]) -> Option<(u32, Option<u32>)> {
    let text = std::str::from_utf8(text).ok()?;
    if !text.bytes().all(|b| b.is_ascii_digit() || b == b'.') {
        return None;
    }
    match text.split_once('.') {
        None => Some((text.parse().ok()?, None)),
        Some((number, part)) => Some((number.parse().ok()?, Some(part.parse().ok()?))),
    }
}
