//! The path of a rapid between its ends: as the control really moves, compared with the straight line of the source.
//!
//! A block goes near the part only on the straight way that the source goes by rapid, along the tool axis away from a
//! place or down to it, or from home along Z. Any other way must be beyond all that the source cuts, along the tool
//! axis as it is at each point; and where its tip is off the line, as high as the source ever goes. Where the axes of the machine go
//! each at its own speed, the way is anywhere in the box that they span.

use super::*;
use crate::line::{blend, turn};
use geom::{nearest_on_segment, off_great_circle};
use program::Rule;

/// Rotary axes turn at most this much between two samples of a rapid, degrees: with the part half a metre off, the tip
/// leaves the chord between two by less than 0.005 mm.
const SAMPLE: f64 = 0.5;

/// Halvings of a way between two places: a metre down to a thousandth of a millimetre.
const HALVINGS: u32 = 20;

/// Corners of the box in which axes go that go each at its own speed.
const CORNERS: usize = 8;

/// Positions at which an axis that is free in a singular pose may stand, as parts of half a turn.
const FREE_POSITIONS: u32 = 16;

impl Prover<'_> {
    /// What is wrong with the way of a rapid block from where the tool is to `to`.
    pub(super) fn wrong_way(&mut self, to: &ResolvedPose) -> Option<Diagnostic> {
        let gauge = self.gauge;
        if gauge.machine.wire.is_some() {
            return None;
        }
        let Step::Move(goal) = &self.cursor.step else { return None };
        if !self.here.place.known() {
            return self.wrong_approach(to);
        }
        if !to.place.known() {
            return None;
        }
        let here = self.here;
        let turns = here.position.orientation != to.position.orientation;
        let from = goal.from.unwrap_or(goal.to);
        let (straight, end) = match &goal.kind {
            Kind::Rapid => (goal.from.map(|from| (from, goal.to)), goal.to),
            // What comes from above is looked at with the hole, and a straight block goes as its ends say.
            Kind::Hole(_) if !turns => return self.wrong_dog_leg(&here, to),
            Kind::Hole(_) if self.progress.hole.over => return None,
            Kind::Hole(cycle) => (None, goal.to.lifted(cycle.clearance)),
            Kind::Line | Kind::Arc(_) => (None, self.progress.left.map_or(from, |left| left.place)),
            Kind::Thread(_) | Kind::Probe { .. } | Kind::Broken(_) => return None,
        };
        let way = StraightPath { gauge: &gauge, straight };
        let is_straight = gauge.straight_rapids && !turns;
        if is_straight && way.holds(&here.place) && way.holds(&to.place) {
            self.note_rapid(&way, std::iter::once(&to.place), to.line);
            return None;
        }
        self.wrong_places(&way, &here, to, &end)
    }

    /// What is wrong with the way to a hole from `here` to `to`, where each axis goes at its own speed: the tool leaves the
    /// straight line between the two beyond all cuts only.
    pub(super) fn wrong_dog_leg(
        &mut self,
        here: &ResolvedPose,
        to: &ResolvedPose,
    ) -> Option<Diagnostic> {
        let gauge = self.gauge;
        if gauge.straight_rapids {
            return None;
        }
        let way = StraightPath { gauge: &gauge, straight: Some((here.place, to.place)) };
        self.wrong_places(&way, here, to, &to.place)
    }

    /// What is wrong with the places to which the axes lead the tool from `here` to `to`, on the way to `end`.
    fn wrong_places(
        &mut self,
        way: &StraightPath,
        here: &ResolvedPose,
        to: &ResolvedPose,
        end: &PartialPose,
    ) -> Option<Diagnostic> {
        let Some(places) = way.places(here, to) else {
            let what = "turns axes that go each at its own speed: where the tool goes between the ends is not known";
            return Some(self.way_refused(to, what));
        };
        if along_axis(way.gauge, here, to, &places, end) {
            return None;
        }
        let turns = here.position.orientation != to.position.orientation;
        let (on_way, mut elsewhere): (Vec<PartialPose>, Vec<PartialPose>) =
            places.iter().partition(|place| way.holds(place));
        elsewhere.extend(way.borders(&places, turns));
        self.note_rapid(way, on_way.iter(), to.line);
        let slack = self.gauge.slack(here);
        // Where axes may turn off the line, each may go at its own speed: so with a leaning tool Z comes down from home.
        let confined: Vec<&PartialPose> =
            elsewhere.iter().filter(|place| self.short_of_free(place) > slack).collect();
        if let Some(what) = self.below_its_end(way, [here, to], &confined) {
            self.note_rapid(way, confined.into_iter(), to.line);
            return Some(self.way_refused(to, &what));
        }
        let shorts = elsewhere.iter().map(|place| {
            let is_off = turns && !way.is_on_line(place);
            let short = match is_off {
                true => self.short_of_free(place),
                false => self.beyond_cuts(place.axis) - place.tip.dot(place.axis),
            };
            (place, short)
        });
        let low: Vec<(&PartialPose, f64)> = shorts.filter(|(_, short)| *short > slack).collect();
        let short = low.iter().map(|(_, short)| *short).reduce(f64::max)?;
        self.note_rapid(way, low.into_iter().map(|(place, _)| place), to.line);
        let what = format!("leaves the straight way of the source {}", self.too_low(short));
        Some(self.way_refused(to, &what))
    }

    /// What is wrong with the places off the way of the source to which a rapid leads the tool, where it does not turn: in a hole or a
    /// pocket that was there before, or was drilled by moves, the tool is beyond all cuts everywhere but at its bottom. So these places, at
    /// which it may not turn off the line, are not below the higher end, and with the tool along Z not below the zero of the part, else not
    /// below where the source goes highest. Where rapids are straight, the higher end is that of the source's own way, and above the zero
    /// of the part a tool along Z may be lower than that.
    fn below_its_end(
        &mut self,
        way: &StraightPath,
        ends: [&ResolvedPose; 2],
        confined: &[&PartialPose],
    ) -> Option<String> {
        let axis = ends[1].place.axis;
        if ends[0].position.orientation != ends[1].position.orientation {
            return None;
        }
        let height = |place: &PartialPose| place.tip.dot(axis);
        let higher = |ends: [&PartialPose; 2]| {
            ends.map(height).into_iter().fold(f64::NEG_INFINITY, f64::max)
        };
        let lowest = confined.iter().map(|place| height(place)).fold(f64::INFINITY, f64::min);
        let allowed = self.gauge.machine.capabilities.rapid_corridor + self.gauge.slack(ends[0]);
        let is_upright =
            geom::angle_between(axis, Vec3::Z).to_degrees() <= self.gauge.allowed.axis_degrees;
        let is_above_zero = is_upright && lowest >= -allowed;
        let below_end = match (self.gauge.straight_rapids, &way.straight) {
            (false, _) => Some(higher(ends.map(|end| &end.place)) - lowest),
            (true, _) if is_above_zero => return None,
            (true, Some((from, to))) => Some(higher([from, to]) - lowest),
            // From home.
            (true, None) => None,
        };
        let (low, what) = match below_end {
            Some(low) if low > allowed => (low, "its higher end"),
            Some(_) if self.gauge.straight_rapids || is_above_zero => return None,
            Some(_) | None => (self.top_along(axis) - lowest, "where the source goes highest"),
        };
        (low > allowed).then(|| {
            format!(
                "leaves the straight way of the source {} mm below {what}: there may be a hole or a pocket around it",
                Number(low)
            )
        })
    }

    /// Holds the rounding of corners of rapids, which goes through the part where one of the two ends is not beyond all cuts.
    pub(super) fn check_rapid_corners(&mut self, to: &ResolvedPose) {
        let found = state::rapid_corners(&self.gauge.corners, &self.running);
        if found.is_none() || self.gauge.machine.wire.is_some() {
            return;
        }
        let ends = [self.here.place, to.place];
        let known = ends.iter().filter(|place| place.known());
        if self.short_of_clearance(known).is_some() {
            self.check(to.line, found);
        }
    }

    /// How far these places of a rapid are from the straight way of the source.
    fn note_rapid<'p>(
        &mut self,
        way: &StraightPath,
        places: impl Iterator<Item = &'p PartialPose>,
        program_line: u32,
    ) {
        let off = places.filter_map(|place| way.off_path(place)).fold(0.0, f64::max);
        self.report.deviations.rapid_mm.note(off, self.cursor.line, program_line);
    }

    /// How far a place is along the straight way of a rapid of the source, 0 to 1, where it is on it; and the length of
    /// the way, mm.
    pub(super) fn on_the_way(&self, to: &ResolvedPose) -> Option<(f64, f64)> {
        let Step::Move(goal @ ExpectedMotion { kind: Kind::Rapid, from: Some(from), .. }) =
            &self.cursor.step
        else {
            return None;
        };
        let way = StraightPath { gauge: &self.gauge, straight: Some((*from, goal.to)) };
        let (t, _) = nearest_on_segment(from.tip, goal.to.tip, to.place.tip);
        way.holds(&to.place).then(|| (t, goal.length()))
    }

    /// By how much the tool is not the clearance beyond all cuts at the worst of these places, mm.
    fn short_of_clearance<'p>(
        &mut self,
        places: impl Iterator<Item = &'p PartialPose>,
    ) -> Option<f64> {
        let short = |place: &PartialPose| self.beyond_cuts(place.axis) - place.tip.dot(place.axis);
        let worst = places.map(short).fold(f64::NEG_INFINITY, f64::max);
        let slack = self.gauge.slack(&self.here);
        (worst > slack).then_some(worst)
    }

    /// How far along the unit vector `axis` the clearance beyond all cuts is, mm.
    pub(super) fn beyond_cuts(&mut self, axis: Vec3) -> f64 {
        let cuts = self.cuts.get_or_insert_with(|| CutBox::of(self.source));
        cuts.reach(axis) + self.gauge.machine.capabilities.rapid_clearance
    }

    /// From how far along the unit vector `axis` on the tool may leave the way of the source, mm: it is as high as the source ever goes,
    /// and the clearance beyond all cuts.
    pub(super) fn free_from(&mut self, axis: Vec3) -> f64 {
        self.beyond_cuts(axis).max(self.top_along(axis))
    }

    /// How high the source goes along the unit vector `axis`, mm.
    pub(super) fn top_along(&mut self, axis: Vec3) -> f64 {
        self.tops.get_or_insert_with(|| Tops::of(self.source)).along(axis)
    }

    /// What is said of a tool that is so many mm too low, or not far enough out, to leave the way of the source.
    pub(super) fn too_low(&self, short: f64) -> String {
        let clearance = Number(self.gauge.machine.capabilities.rapid_clearance);
        format!(
            "{} mm short of where it may: as high as the source ever goes, and {clearance} mm beyond all cuts",
            Number(short)
        )
    }

    pub(super) fn way_refused(&self, to: &ResolvedPose, what: &str) -> Diagnostic {
        let message = format!(
            "{}the program goes by rapid to {} and {what}",
            SourceLine(self.cursor.line),
            to.place
        );
        let help = match self.gauge.machine.settings.rapid_path {
            _ if self.gauge.machine.has_straight_rapids() && !self.gauge.straight_rapids => {
                "go away from the part first, along the tool axis; or leave RTLIOF out, by which each axis goes at its own speed"
            }
            Some(_) => "go away from the part first, along the tool axis",
            None => {
                "go away from the part first, along the tool axis; or say `rapid_path = \"linear\"` in [settings] of the \
                 machine's file where its axes go together by rapid"
            }
        };
        Diagnostic::error(Rule::RapidPath, message).help(help).line(to.line)
    }
}

/// The straight way of the source, where it goes by rapid.
struct StraightPath<'a> {
    gauge: &'a Gauge<'a>,
    straight: Option<(PartialPose, PartialPose)>,
}

impl StraightPath<'_> {
    /// Whether a place is on it, with the tool as it is there.
    fn holds(&self, place: &PartialPose) -> bool {
        let Some((from, to)) = &self.straight else { return false };
        let allowed = &self.gauge.allowed;
        let off = off_great_circle(from.axis, to.axis, place.axis).to_degrees();
        self.is_on_line(place) && off <= allowed.axis_degrees + allowed.sweep_degrees
    }

    /// Whether a place is on its line, however the tool leans there.
    fn is_on_line(&self, place: &PartialPose) -> bool {
        let machine = self.gauge.machine;
        let corridor = machine.capabilities.rapid_corridor + self.gauge.allowed.tip_mm;
        self.off_path(place).is_some_and(|off| off <= corridor)
    }

    /// How far a place is from it, mm.
    fn off_path(&self, place: &PartialPose) -> Option<f64> {
        let (from, to) = self.straight.as_ref()?;
        Some(nearest_on_segment(from.tip, to.tip, place.tip).1)
    }

    /// Places on the way of a block, in all ways that the machine may stand; nothing where it is not known what lies
    /// between its ends.
    fn places(&self, here: &ResolvedPose, to: &ResolvedPose) -> Option<Vec<PartialPose>> {
        let machine = self.gauge.machine;
        let turns = here.position.orientation != to.position.orientation;
        if self.gauge.straight_rapids {
            return Some(if turns { self.turning(here, to) } else { vec![here.place, to.place] });
        }
        let stances = if turns { Vec::new() } else { self.stances(to) };
        let wandering = |degrees| {
            let tips: [Vec3; CORNERS] = machine.wandering(here.place.tip, to.place.tip, degrees);
            tips.map(|tip| PartialPose { tip, axis: to.place.axis })
        };
        (!stances.is_empty()).then(|| stances.into_iter().flat_map(wandering).collect())
    }

    /// The last places off it of ways that come onto it from elsewhere: between its two ends such a way may be lower than at either. Of places
    /// at which the tool turns neighbours have a way between them, else any two corners of a box.
    fn borders(&self, places: &[PartialPose], turns: bool) -> Vec<PartialPose> {
        let mut borders = Vec::new();
        let joined: Vec<&[PartialPose]> =
            if turns { places.windows(2).collect() } else { places.chunks(CORNERS).collect() };
        for joined in joined {
            let (on_way, elsewhere): (Vec<&PartialPose>, Vec<&PartialPose>) =
                joined.iter().partition(|place| self.holds(place));
            for on in on_way {
                // One that is no lower than the place off the line has nothing lower on the way to it.
                let is_lower = |off: &&&PartialPose| {
                    let rise = off.tip - on.tip;
                    turns || rise.dot(on.axis) > SAME || rise.z > SAME
                };
                let lower = elsewhere.iter().filter(is_lower);
                borders.extend(lower.map(|off| self.border(on, off)));
            }
        }
        borders
    }

    /// The last place off it on the way to one that is on it.
    fn border(&self, on: &PartialPose, off: &PartialPose) -> PartialPose {
        let at = |part: f64| PartialPose {
            tip: on.tip.lerp(off.tip, part),
            axis: geom::between(on.axis, off.axis, part),
        };
        // Its corridor is convex.
        let (mut inside, mut outside) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(inside, outside);
            *(if self.holds(&at(middle)) { &mut inside } else { &mut outside }) = middle;
        }
        at(outside)
    }

    /// The positions of the rotary axes with the tool as it stands at `to`.
    fn stances(&self, to: &ResolvedPose) -> Vec<[f64; 3]> {
        let machine = self.gauge.machine;
        match to.position.orientation {
            Orientation::Rotary { degrees, .. } => vec![degrees],
            Orientation::Axis(_) if machine.rotary.is_empty() => vec![[0.0; 3]],
            Orientation::Axis(axis) => {
                let Ok(solutions) = machine.inverse(axis) else { return Vec::new() };
                let free = |degrees: [f64; 3]| {
                    let count = if solutions.free.is_some() { FREE_POSITIONS } else { 1 };
                    (0..count).map(move |k| {
                        let mut degrees = degrees;
                        if let Some(free) = solutions.free {
                            degrees[free] += 180.0 * f64::from(k) / f64::from(count);
                        }
                        degrees
                    })
                };
                solutions.degrees.into_iter().flat_map(free).collect()
            }
        }
    }

    /// Places on a way on which the tool turns, all axes going together.
    fn turning(&self, here: &ResolvedPose, to: &ResolvedPose) -> Vec<PartialPose> {
        let Gauge { machine, tool_length, .. } = *self.gauge;
        let start = in_the_kind_of(machine, here, to, tool_length);
        let most = turn(&start, &to.position).unwrap_or_else(|| here.place.apart(&to.place).1);
        let samples = (most / SAMPLE).ceil().clamp(1.0, 1440.0) as u32;
        let part = |i: u32| f64::from(i) / f64::from(samples);
        (0..=samples)
            .map(|i| match to.position.orientation {
                Orientation::Rotary { .. } => {
                    PartialPose::of(machine, &blend(&start, &to.position, part(i)), tool_length)
                }
                // The control turns the vector itself.
                Orientation::Axis(axis) => PartialPose {
                    tip: here.place.tip.lerp(to.place.tip, part(i)),
                    axis: geom::between(here.place.axis, axis, part(i)),
                },
            })
            .collect()
    }
}

/// Where `here` is, said as the block that goes to `to` says it.
fn in_the_kind_of(
    machine: &Machine,
    here: &ResolvedPose,
    to: &ResolvedPose,
    tool_length: Option<f64>,
) -> Position {
    match (here.position.orientation, to.position.orientation) {
        (
            Orientation::Rotary { degrees, tool_center: before },
            Orientation::Rotary { tool_center, .. },
        ) if before != tool_center => {
            let point = match tool_center {
                true => here.place.tip,
                false => machine.linear_for(here.place.tip, degrees, tool_length.unwrap_or(0.0)),
            };
            Position { point, orientation: Orientation::Rotary { degrees, tool_center } }
        }
        (Orientation::Rotary { .. } | Orientation::Axis(_), _) => here.position,
    }
}

/// Whether a block goes along the tool axis: away, or down to the end of the way.
fn along_axis(
    gauge: &Gauge,
    here: &ResolvedPose,
    to: &ResolvedPose,
    places: &[PartialPose],
    end: &PartialPose,
) -> bool {
    let is_up = stops::lifted(gauge, here, to);
    let is_down = stops::lifted(gauge, to, here) && is_over(gauge, end, to);
    let corridor = gauge.machine.capabilities.rapid_corridor;
    let on_line = |place: &PartialPose| here.place.above(place.tip).1 <= corridor;
    (is_up || is_down) && places.iter().all(on_line)
}

/// Whether `to` is over the end of a way along the tool axis there, but for the rounding of both: the end may be a place of the program,
/// whose axis is known as well as its words say it, so the higher, the farther from the axis.
fn is_over(gauge: &Gauge, end: &PartialPose, to: &ResolvedPose) -> bool {
    let (height, aside) = end.above(to.place.tip);
    let slack = gauge.slack(to);
    let rounding = 2.0 * slack + height.abs() * gauge.allowed.axis_degrees.to_radians();
    height >= -slack && aside <= rounding
}
