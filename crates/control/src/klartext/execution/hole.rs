//! Hole cycles: what they do, from their parameters.

use super::state::cycle::Definition;
use crate::event::Risk;
use crate::klartext::language::registers::{Parameter, Registers};
use geom::Vec3;
use program::{Cycle, CycleKind, Feed, Withdrawal};

/// Retraction feeds from here on are rapid: the number that the control shows for `MAX`.
pub(super) const RAPID_FEED: f64 = 99_999.0;

/// How far cycle 202 goes from the wall, mm: a fixed value of the control.
const DISENGAGING: f64 = 0.2;

/// A hole cycle with what its parameters hold when it is called.
pub(super) struct Hole<'a> {
    pub(super) definition: &'a Definition,
    pub(super) registers: &'a Registers,
}

impl Definition {
    /// The cycle with what its parameters hold now.
    pub(super) fn hole<'a>(&'a self, registers: &'a Registers) -> Hole<'a> {
        Hole { definition: self, registers }
    }
}

impl Hole<'_> {
    /// The value of a parameter in mm, mm/min or its own unit, where the definition gave it.
    pub(super) fn find(&self, q: u16) -> Option<f64> {
        let unit = self.definition.unit_of(q)?;
        self.registers.number(Parameter::Global(q)).ok().map(|value| value * unit)
    }

    /// A parameter that the cycle needs or that is 0 where it is not given.
    pub(super) fn get(&self, q: u16) -> f64 {
        self.find(q).unwrap_or(0.0)
    }

    /// Surface of the part in the coordinates of the program, mm.
    pub(super) fn surface(&self) -> f64 {
        self.get(203)
    }

    /// Height of the cycle's point: the surface, or where back boring ends.
    pub(super) fn point(&self) -> f64 {
        match self.definition.number() {
            204 => self.surface() + self.get(249) - self.get(250) - self.get(252),
            _ => self.surface(),
        }
    }

    /// The cycle in the neutral vocabulary, or why that cannot be.
    pub(super) fn cycle(&self) -> Result<Cycle, String> {
        if self.definition.number() == 204 {
            return self.back_boring();
        }
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
        match self.definition.number() {
            200 => self.peck(&mut cycle, CycleKind::Deep)?,
            201 => cycle.kind = self.feeding_out(CycleKind::Ream)?,
            202 if !self.rapid_out() => return Err("boring goes out by rapid: Q208=MAX".into()),
            202 if self.get(214) == 0.0 => cycle.kind = CycleKind::Bore,
            202 => cycle.kind = CycleKind::FineBore(self.withdrawal(DISENGAGING)?),
            203 => self.universal_drilling(&mut cycle)?,
            205 => self.universal_pecking(&mut cycle)?,
            240 if self.get(343) != 0.0 => {
                return Err(
                    "Q343=1 centers to a diameter by the angle of the tool, which is not at hand"
                        .into(),
                );
            }
            240 => {}
            206 => cycle.kind = CycleKind::Tap { pitch: f64::NAN, left: false },
            _ => self.rigid_tapping(&mut cycle)?,
        }
        Ok(cycle)
    }

    /// What its parameters ask for that a source cannot say.
    pub(super) fn risk(&self, cycle: &Cycle) -> Option<Risk> {
        // The factor by which the spindle is faster on the way out.
        let faster = self.find(403).is_some_and(|factor| factor != 1.0);
        let clears = cycle.kind == CycleKind::Deep && cycle.first_peck.is_some();
        let above = match self.definition.number() {
            205 => self.get(258).min(self.get(259)),
            _ => cycle.clearance,
        };
        if faster {
            Some(Risk::TAP_RETURN)
        } else {
            (clears && above <= 0.0).then_some(Risk::RAPID_TO_DEPTH)
        }
    }

    /// How the tool leaves the wall, by `distance`: Q214 says which way, Q336 how the spindle stands.
    fn withdrawal(&self, distance: f64) -> Result<Withdrawal, String> {
        let way = match self.get(214) {
            1.0 => Vec3::NEG_X,
            2.0 => Vec3::NEG_Y,
            3.0 => Vec3::X,
            4.0 => Vec3::Y,
            _ => return Err("the disengaging direction Q214 is 1 to 4".into()),
        };
        Ok(Withdrawal { aside: way * distance, angle: Some(self.get(336)) })
    }

    /// Cycle 204. The length of the tool is that of its lower end, and the edge stands Q252 above it; from
    /// the set-up clearance below the part, which is Q250 thick, it bores Q249 into it.
    fn back_boring(&self) -> Result<Cycle, String> {
        let (clearance, bored, thickness) = (self.get(200), self.get(249), self.get(250));
        if !(bored > 0.0 && thickness > 0.0 && self.get(251) > 0.0) {
            return Err("Q249, Q250 and Q251 must be greater than 0".into());
        }
        if clearance < 0.0 || self.get(204) < 0.0 || self.get(252) < 0.0 {
            return Err("Q200, Q204 and Q252 must not be negative".into());
        }
        if self.get(253) <= 0.0 || self.get(254) <= 0.0 {
            return Err("the feeds Q253 and Q254 must be greater than 0".into());
        }
        let dwell = self.get(255);
        if !(0.0..=3600.0).contains(&dwell) {
            return Err("the dwell Q255 is 0 to 3600 s".into());
        }
        let through = Some(self.get(253)).filter(|feed| *feed < RAPID_FEED).map(Feed::PerMinute);
        let above = self.surface() - self.point();
        Ok(Cycle {
            kind: CycleKind::BackBore { withdrawal: self.withdrawal(self.get(251))?, through },
            depth: bored + clearance,
            clearance: above + clearance,
            retract: above + clearance.max(self.get(204)),
            feed: Some(Feed::PerMinute(self.get(254))),
            dwell,
            first_peck: None,
            peck: None,
        })
    }

    fn rapid_out(&self) -> bool {
        self.find(208).is_some_and(|out| out >= RAPID_FEED)
    }

    /// Drilling where the tool goes out by rapid, `slow` where it goes out with the feed in (Q208=0).
    fn feeding_out(&self, slow: CycleKind) -> Result<CycleKind, String> {
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
    fn peck(&self, cycle: &mut Cycle, kind: CycleKind) -> Result<(), String> {
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
        // Two depths can be reported: the first one, and that of all others.
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

    fn universal_drilling(&self, cycle: &mut Cycle) -> Result<(), String> {
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

    fn universal_pecking(&self, cycle: &mut Cycle) -> Result<(), String> {
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

    fn rigid_tapping(&self, cycle: &mut Cycle) -> Result<(), String> {
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
