//! Patterns of points at which a cycle is called.

use super::state::Control;
use super::state::cycle::Definition;
use crate::event::Action;
use crate::kernel::Outcome;
use crate::klartext::language::functions::When;
use crate::klartext::language::scan::Scanner;
use crate::klartext::language::words::Words;
use geom::Vec3;
use program::Rule;

/// Most points of a pattern.
const MOST: f64 = 99_999.0;

/// So far in a direction, degrees from X.
fn toward(degrees: f64, length: f64) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec3::new(length * cos, length * sin, 0.0)
}

/// Points on a circle.
fn on_circle(center: Vec3, diameter: f64, start: f64, step: f64, count: u32) -> Vec<Vec3> {
    let point = |i| center + toward(start + step * f64::from(i), diameter / 2.0);
    (0..count).map(point).collect()
}

/// Points in lines of even spacing, every second line backwards.
fn in_lines(start: Vec3, across: Vec3, up: Vec3, columns: u32, lines: u32) -> Vec<Vec3> {
    let mut points = Vec::new();
    for line in 0..lines {
        let column = |i: u32| if line % 2 == 0 { i } else { columns - 1 - i };
        let place = |i| start + across * f64::from(column(i)) + up * f64::from(line);
        points.extend((0..columns).map(place));
    }
    points
}

/// A count within its limit.
fn count(value: f64) -> Option<u32> {
    (value.fract() == 0.0 && (1.0..=MOST).contains(&value)).then_some(value as u32)
}

impl Control<'_, '_> {
    /// Cycles 220 and 221: call the cycle defined before at their points, with the clearances and the
    /// surface that they set.
    pub(super) fn point_pattern(&mut self, s: &Scanner, pattern: &Definition) -> Outcome {
        let q = pattern.hole(&self.registers);
        let bad = |message: &str| {
            s.error_block(Rule::CycleParameter, format!("cycle {}: {message}", pattern.number()))
        };
        if q.get(365) != 0.0 {
            return Err(bad(
                "on a circle from point to point (Q365=1) is not followed: write Q365=+0",
            ));
        }
        let points = if pattern.number() == 220 {
            let number = count(q.get(241)).ok_or_else(|| bad("Q241 is a number of points"))?;
            let span = q.get(246) - q.get(245);
            // The stopping angle does not count for a full circle, nor where a step is given.
            let step = match (q.get(247), number) {
                (step, _) if step != 0.0 => step,
                (_, 1) => 0.0,
                _ if span == 0.0 => return Err(bad("Q245 and Q246 must not be the same")),
                _ if span.abs() == 360.0 => span / f64::from(number),
                _ => span / f64::from(number - 1),
            };
            let center = Vec3::new(q.get(216), q.get(217), 0.0);
            on_circle(center, q.get(244), q.get(245), step, number)
        } else {
            let sizes = count(q.get(242)).zip(count(q.get(243)));
            let (columns, lines) = sizes
                .filter(|(columns, lines)| f64::from(*columns) * f64::from(*lines) <= MOST)
                .ok_or_else(|| bad("Q242 and Q243 are numbers of columns and lines"))?;
            let start = Vec3::new(q.get(225), q.get(226), 0.0);
            let across = toward(q.get(224), q.get(237));
            in_lines(start, across, toward(q.get(224) + 90.0, q.get(238)), columns, lines)
        };
        let (surface, clearance, second) = (q.get(203), q.get(200), q.get(204));
        let between = match q.get(301) {
            0.0 => surface + clearance,
            1.0 => surface + clearance.max(second),
            _ => return Err(bad("Q301 is 0 or 1")),
        };
        // First to the second clearance, then in the plane.
        self.here.z = surface + second;
        self.check_descent(s)?;
        self.emit(Action::Rapid(self.pose(self.here)))?;
        self.drill_at(s, &points, between)?;
        // At which of the two heights the tool ends is not said where they differ.
        if between != surface + clearance.max(second) {
            self.here.z = f64::NAN;
        }
        Ok(())
    }

    /// One line of `PATTERN DEF`: `POS1 (X+25 Y+33.5 Z+0)`, `ROW1 (...)` and so on.
    pub(crate) fn pattern_line(&mut self, s: &mut Scanner, points: &mut Vec<Vec3>) -> Outcome {
        while !s.is_done() {
            let from = *s;
            let kind = s.letters();
            s.digits(9)?;
            let span = (from.at(), s.at());
            let Some(mut inside) = s.parenthesis() else {
                let message = "a pattern such as POS1 (X+0 Y+0 Z+0) is expected here";
                return Err(s.error(Rule::Syntax, span, message));
            };
            let words = PatternWords::read(&mut inside, self)?;
            let more =
                words.points(kind).map_err(|message| s.error(Rule::Pattern, span, message))?;
            points.extend(more);
            if points.len() as f64 > MOST {
                let message = format!("a pattern has at most {MOST} points");
                return Err(s.error(Rule::Pattern, span, message));
            }
        }
        Ok(())
    }

    /// The last line of `PATTERN DEF` is read.
    pub(crate) fn close_pattern(&mut self, s: &Scanner, points: Vec<Vec3>) -> Outcome {
        if points.is_empty() {
            return Err(s.error_block(Rule::Pattern, "PATTERN DEF has no points"));
        }
        self.pattern = points;
        Ok(())
    }

    /// `CYCL CALL PAT`: at every point of the pattern; the tool goes between them at the height at
    /// which it is, or the second clearance where that is higher.
    pub(super) fn pattern_call(&mut self, s: &mut Scanner) -> Outcome {
        let words = Words::read(s, 0, self)?;
        if self.pattern.is_empty() {
            return Err(s.error_block(Rule::Cycle, "no PATTERN DEF comes before"));
        }
        if !words.is_rapid() {
            let message = "CYCL CALL PAT goes between the points with FMAX here";
            return Err(s.error_block(Rule::Unsupported, message));
        }
        let hole = self.definition(s)?.hole(&self.registers);
        let (surface, second) = (hole.surface(), hole.get(204).max(hole.get(200)));
        let height = self.here.z;
        if height.is_nan() {
            let message = "the height at which the pattern is called is not known";
            return Err(s.error_block(Rule::UnknownPosition, message));
        }
        self.functions(s, words.functions, When::Start)?;
        let points = std::mem::take(&mut self.pattern);
        let called = points.iter().try_for_each(|point| {
            let level = height.max(surface + point.z + second);
            self.drill_at(s, std::slice::from_ref(point), level)
        });
        self.pattern = points;
        called?;
        self.functions(s, words.functions, When::End)
    }

    /// Drills at points whose Z adds to the surface, and goes from one to the next at a height.
    fn drill_at(&mut self, s: &Scanner, points: &[Vec3], level: f64) -> Outcome {
        for point in points {
            self.count_jump(s, 0)?;
            // Upwards before it goes in the plane.
            if self.here.z < level {
                self.here.z = level;
                self.emit(Action::Rapid(self.pose(self.here)))?;
            }
            self.here = point.with_z(self.here.z);
            self.emit(Action::Rapid(self.pose(self.here)))?;
            self.drill(s, point.z, Some(level))?;
        }
        Ok(())
    }
}

/// The words of one pattern. Lengths are mm.
#[derive(Default)]
struct PatternWords(Vec<(Vec<u8>, f64)>);

/// Words whose values are no lengths.
const PLAIN: [&[u8]; 9] =
    [b"NUM", b"NUMX", b"NUMY", b"ROT", b"ROTX", b"ROTY", b"START", b"STEP", b"END"];

impl PatternWords {
    fn read(s: &mut Scanner, control: &Control) -> Outcome<PatternWords> {
        let mut words = PatternWords::default();
        while let Some(word) = s.word(&control.registers)? {
            let plain = PLAIN.contains(&word.address);
            let length = matches!(word.address, b"X" | b"Y" | b"Z" | b"D" | b"DX" | b"DY");
            let Some(number) = word.number.filter(|_| plain || length) else {
                return Err(crate::klartext::language::feed::unknown(s, &word));
            };
            if words.find(word.address).is_some() {
                return Err(s.error(
                    Rule::RepeatedWord,
                    word.span,
                    "the word stands twice in the pattern",
                ));
            }
            let value = if plain { number } else { number * control.unit };
            words.0.push((word.address.to_vec(), value));
        }
        Ok(words)
    }

    fn find(&self, address: &[u8]) -> Option<f64> {
        self.0.iter().find(|(known, _)| known == address).map(|(_, value)| *value)
    }

    fn get(&self, address: &[u8]) -> Result<f64, String> {
        let missing = || format!("{} is missing", String::from_utf8_lossy(address));
        self.find(address).ok_or_else(missing)
    }

    fn count(&self, address: &[u8]) -> Result<u32, String> {
        let message = || format!("{} is a whole number from 1", String::from_utf8_lossy(address));
        count(self.get(address)?).ok_or_else(message)
    }

    /// The points, or why there are none.
    fn points(&self, kind: &[u8]) -> Result<Vec<Vec3>, String> {
        let takes: &[&[u8]] = match kind {
            b"POS" => &[],
            b"ROW" => &[b"D", b"NUM", b"ROT"],
            b"PAT" => &[b"DX", b"DY", b"NUMX", b"NUMY", b"ROT", b"ROTX", b"ROTY"],
            b"CIRC" => &[b"D", b"START", b"NUM"],
            b"PITCHCIRC" => &[b"D", b"START", b"STEP", b"NUM"],
            b"FRAME" => return Err("in which order the points of a frame come is not known".into()),
            _ => return Err("this kind of pattern is not known".into()),
        };
        let own =
            |address: &[u8]| matches!(address, b"X" | b"Y" | b"Z") || takes.contains(&address);
        if let Some((address, _)) = self.0.iter().find(|(address, _)| !own(address)) {
            let address = String::from_utf8_lossy(address);
            return Err(format!("{address} is not a word of this pattern"));
        }
        let start = Vec3::new(self.get(b"X")?, self.get(b"Y")?, self.find(b"Z").unwrap_or(0.0));
        let angle = self.find(b"ROT").unwrap_or(0.0);
        match kind {
            b"POS" => Ok(vec![start]),
            b"ROW" => {
                let along = toward(angle, self.get(b"D")?);
                Ok(in_lines(start, along, Vec3::ZERO, self.count(b"NUM")?, 1))
            }
            b"PAT" => {
                let skew = [b"ROTX", b"ROTY"].map(|address| self.find(address).unwrap_or(0.0));
                if skew != [0.0; 2] {
                    return Err("a pattern that is askew (ROTX, ROTY) is not supported".into());
                }
                let (columns, lines) = (self.count(b"NUMX")?, self.count(b"NUMY")?);
                if f64::from(columns) * f64::from(lines) > MOST {
                    return Err(format!("a pattern has at most {MOST} points"));
                }
                let across = toward(angle, self.get(b"DX")?);
                Ok(in_lines(start, across, toward(angle + 90.0, self.get(b"DY")?), columns, lines))
            }
            _ => {
                let number = self.count(b"NUM")?;
                let full = 360.0 / f64::from(number);
                let step = if kind == b"CIRC" { full } else { self.get(b"STEP")? };
                Ok(on_circle(start, self.get(b"D")?, self.get(b"START")?, step, number))
            }
        }
    }
}
