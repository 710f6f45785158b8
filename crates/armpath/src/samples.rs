//! A path as samples in the world: its points, and some between points that are far apart.

use crate::follow::nearest;
use crate::{Blocked, Cell, Point, SPACING, Settings, Why, Within};
use arm::{Arm, Frame, Posture, Vec3};
use geom::{Mat3, angle_between, between, direction};
use std::f64::consts::TAU;
use std::ops::Range;

/// Largest angle of the tool axis between two samples, radians.
const LEAN: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// The most samples on one line: it would be half a kilometre long.
const MOST: f64 = 100_000.0;

/// A place of the path, in the world.
#[derive(Clone, Copy)]
pub(crate) struct Sample {
    /// The tool tip.
    pub(crate) tip: Vec3,
    /// The tool's Z, out of the tool.
    pub(crate) out: Vec3,
    /// The tool's X at the turn 0; carried along the path without turning.
    pub(crate) side: Vec3,
    /// Seconds from the sample before.
    pub(crate) time: f64,
    /// The number of the point, or of the point towards which it is.
    pub(crate) point: usize,
    /// Whether it is the point itself.
    pub(crate) is_point: bool,
    /// Whether it is within a motion.
    pub(crate) inside: bool,
}

/// A cut: samples that the arm passes without leaving the path, and the intervals between its knots.
pub(crate) struct Cut {
    /// Its samples.
    pub(crate) samples: Range<usize>,
    /// Whether the source says its turn.
    pub(crate) fixed: bool,
}

/// What is to be followed.
pub(crate) struct Job<'a> {
    pub(crate) arm: &'a Arm,
    pub(crate) settings: &'a Settings,
    pub(crate) cuts: Vec<Cut>,
    pub(crate) samples: Vec<Sample>,
    /// The flange in the frame of the tool.
    flange: Frame,
    /// The world in the frame of the part.
    to_part: Frame,
}

impl<'a> Job<'a> {
    pub(crate) fn new(
        arm: &'a Arm,
        cell: &Cell,
        points: &[Point],
        settings: &'a Settings,
    ) -> Result<Job<'a>, Blocked> {
        let good = (1..=360).contains(&settings.turns)
            && settings.turn_rate > 0.0
            && settings.slows_at.is_none_or(|rate| rate > 0.0)
            && settings.speed > 0.0
            && settings.speed <= 1.0
            && [settings.wrist, settings.shoulder, settings.elbow, settings.limit]
                .iter()
                .all(|least| *least >= 0.0)
            && cell.tool.is_finite()
            && cell.part.is_finite();
        if !good {
            return Err(no_numbers(0));
        }
        let mut job = Job {
            arm,
            settings,
            cuts: Vec::new(),
            samples: Vec::with_capacity(points.len()),
            flange: cell.tool.inverse(),
            to_part: cell.part.inverse(),
        };
        for (number, point) in points.iter().enumerate() {
            job.add(number, point, &cell.part)?;
        }
        Ok(job)
    }

    fn add(&mut self, number: usize, point: &Point, part: &Frame) -> Result<(), Blocked> {
        let unit = |v: Vec3| (v.length_squared() - 1.0).abs() < 1e-6;
        let square = point.side.is_none_or(|side| unit(side) && side.dot(point.axis).abs() < 1e-4);
        let fed = !point.cut || (point.feed.is_finite() && point.feed > 0.0);
        if !point.tip.is_finite() || !unit(point.axis) || !square || !fed {
            return Err(no_numbers(number));
        }
        let end = Sample {
            tip: part.transform_point3(point.tip),
            out: -(part.matrix3 * point.axis),
            side: part.matrix3 * point.side.unwrap_or(Vec3::ZERO),
            time: 0.0,
            point: number,
            is_point: true,
            inside: point.inside,
        };
        let fixed = point.side.is_some();
        let last = self.samples.last().copied().filter(|_| {
            // A turn that the source says begins a cut of its own, and so does one that it leaves free.
            point.cut && self.cuts.last().is_some_and(|cut| cut.fixed == fixed)
        });
        match last {
            Some(last) => self.line(&last, end, point.feed / 60.0, fixed)?,
            None => {
                let before = self.samples.last().map(|before| before.side);
                let side = if fixed { end.side } else { level(before.unwrap_or(Vec3::X), end.out) };
                self.cuts.push(Cut { samples: self.samples.len()..self.samples.len() + 1, fixed });
                self.samples.push(Sample { side, ..end });
            }
        }
        Ok(())
    }

    /// The samples of a line from `last`, at mm/s.
    fn line(&mut self, last: &Sample, end: Sample, speed: f64, fixed: bool) -> Result<(), Blocked> {
        let (length, lean) = (last.tip.distance(end.tip), angle_between(last.out, end.out));
        let turned = if fixed { angle_between(last.side, end.side) } else { 0.0 };
        let count = (length / SPACING).max(lean / LEAN).max(turned / LEAN).ceil().max(1.0);
        let turning = self.settings.slows_at.map_or(0.0, |rate| (lean + turned) / rate);
        let time = (length / speed).max(turning);
        if count > MOST {
            return Err(no_numbers(end.point));
        }
        let mut side = last.side;
        for i in 1..=count as usize {
            let t = i as f64 / count;
            let is_point = i as f64 == count;
            let out = if is_point { end.out } else { between(last.out, end.out, t) };
            side = match fixed {
                true if is_point => end.side,
                true => level(between(last.side, end.side, t), out),
                false => level(side, out),
            };
            let tip = last.tip.lerp(end.tip, t);
            self.samples.push(Sample {
                tip,
                out,
                side,
                time: time / count,
                point: end.point,
                is_point,
                inside: end.inside || !is_point,
            });
        }
        if let Some(cut) = self.cuts.last_mut() {
            cut.samples.end = self.samples.len();
        }
        Ok(())
    }

    /// What ends a path at a sample, in a cut whose turn has so many steps.
    pub(crate) fn blocked(&self, at: usize, why: Why, steps: usize) -> Blocked {
        let sample = &self.samples[at];
        let is_end = |sample: &Sample| sample.is_point && !sample.inside;
        let within = (!is_end(sample)).then(|| {
            let end = self.samples[at..].iter().find(|sample| is_end(sample));
            let far = end.map(|end| nearest(self, end, steps, &Posture::ALL));
            Within {
                tip: self.to_part.transform_point3(sample.tip),
                end: far.filter(|why| matches!(why, Why::Reach(_))),
            }
        });
        Blocked { point: sample.point, within, why }
    }

    /// How many steps the turn of a cut has.
    pub(crate) fn steps(&self, cut: &Cut) -> usize {
        if cut.fixed { 1 } else { usize::from(self.settings.turns) }
    }

    /// The angle of a step.
    pub(crate) fn step_angle(&self) -> f64 {
        TAU / f64::from(self.settings.turns)
    }

    /// The flange for a sample with the tool turned by an angle.
    pub(crate) fn frame(&self, sample: &Sample, turn: f64) -> Frame {
        let side = self.side(sample, turn);
        let tool = Mat3::from_cols(side, sample.out.cross(side), sample.out);
        Frame::from_mat3_translation(
            tool * self.flange.matrix3,
            sample.tip + tool * self.flange.translation,
        )
    }

    /// The tool's X in the world.
    fn side(&self, sample: &Sample, turn: f64) -> Vec3 {
        let (sin, cos) = turn.sin_cos();
        sample.side * cos + sample.out.cross(sample.side) * sin
    }

    /// The tool's X in the frame of the part.
    pub(crate) fn side_in_part(&self, sample: &Sample, turn: f64) -> Vec3 {
        self.to_part.matrix3 * self.side(sample, turn)
    }
}

fn no_numbers(point: usize) -> Blocked {
    Blocked { point, within: None, why: Why::Numbers }
}

/// The unit vector at right angles to `out` that is nearest to `side`; any one where `side` is along `out`.
fn level(side: Vec3, out: Vec3) -> Vec3 {
    let flat = |v: Vec3| direction(v - out * out.dot(v)).filter(|_| v.cross(out).length() > 1e-3);
    flat(side).or_else(|| flat(Vec3::X)).or_else(|| flat(Vec3::Y)).unwrap_or(Vec3::Z)
}
