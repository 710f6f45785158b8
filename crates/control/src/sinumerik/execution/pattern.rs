//! Patterns of holes, which the modal cycle drills: `HOLES1`, `HOLES2`, `CYCLE801`.

use super::interpreter::Interpreter;
use super::state::modal::Modal;
use crate::event::Action;
use crate::kernel::Outcome;
use crate::kernel::source::Source;
use crate::sinumerik::language::call::{Argument, Call};
use crate::sinumerik::language::forms::Pattern;
use geom::Vec3;
use program::Rule;

/// Most holes of a pattern; our own limit.
const MOST_HOLES: f64 = 10_000.0;

/// The direction under an angle in the plane.
fn under(degrees: f64) -> Vec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec3::new(cos, sin, 0.0)
}

impl Interpreter<'_, '_> {
    /// Goes to each place of a pattern in rapid and drills there.
    pub fn pattern(&mut self, source: &Source, call: &Call, pattern: Pattern) -> Outcome {
        let error = |rule, message: String| {
            Err(source.block_error(rule, format!("{}: {message}", call.name)))
        };
        if !matches!(self.state.modal, Modal::Cycle(_)) {
            return error(
                Rule::Cycle,
                "there is no modal cycle (MCALL) that it could drill with".into(),
            );
        }
        let count = if pattern == Pattern::Grid { 7 } else { 6 };
        let further = call.arguments.iter().skip(count);
        if further.clone().any(|a| !matches!(a, Argument::None | Argument::Number(0.0))) {
            return error(Rule::Unsupported, format!("parameters beyond the first {count}"));
        }
        let mut values = [0.0; 7];
        for (index, value) in values.iter_mut().enumerate() {
            *value = call.number(source, index)?.unwrap_or(0.0);
        }
        let [a, b, c, d, e, f, g] = values;
        let numbers: &[f64] = if pattern == Pattern::Grid { &[f, g] } else { &[f] };
        let whole = |number: &&f64| number.fract() != 0.0 || **number < 1.0;
        if numbers.iter().any(|number| whole(&number))
            || numbers.iter().product::<f64>() > MOST_HOLES
        {
            return error(
                Rule::CycleParameter,
                format!("the number of holes is from 1 to {MOST_HOLES}"),
            );
        }
        let unit = self.state.unit;
        let origin = Vec3::new(a, b, 0.0) * unit;
        let here = self.state.position;
        match pattern {
            Pattern::Row => {
                let way = under(c);
                let place = |index: f64| origin + way * ((d + index * e) * unit);
                // From the end that is nearer.
                let turned = flat(here, place(f - 1.0)) < flat(here, place(0.0));
                self.drill_each(source, f, |index| {
                    place(if turned { f - 1.0 - index } else { index })
                })
            }
            Pattern::Circle => {
                if c <= 0.0 {
                    return error(Rule::CycleParameter, "the radius RAD is above 0".into());
                }
                let step = if e == 0.0 { 360.0 / f } else { e };
                self.drill_each(source, f, |index| origin + under(d + index * step) * (c * unit))
            }
            Pattern::Grid => {
                let (along, across) = (under(c) * (d * unit), under(c + 90.0) * (e * unit));
                let place = |column: f64, line: f64| origin + along * column + across * line;
                // From the corner that is nearest, there and back.
                let mut best = (false, false);
                for corner in [(true, false), (false, true), (true, true)] {
                    let at = |(x, y): (bool, bool)| {
                        place(if x { f - 1.0 } else { 0.0 }, if y { g - 1.0 } else { 0.0 })
                    };
                    if flat(here, at(corner)) < flat(here, at(best)) {
                        best = corner;
                    }
                }
                self.drill_each(source, f * g, |index| {
                    let line = (index / f).floor();
                    let column = index - line * f;
                    let back = best.0 != (line % 2.0 == 1.0);
                    place(
                        if back { f - 1.0 - column } else { column },
                        if best.1 { g - 1.0 - line } else { line },
                    )
                })
            }
        }
    }

    fn drill_each(&mut self, source: &Source, count: f64, place: impl Fn(f64) -> Vec3) -> Outcome {
        for index in 0..count as u32 {
            let place = place(f64::from(index));
            for i in 0..2 {
                self.state.position[i] = place[i];
                self.state.programmed[i] = place[i];
            }
            let pose = self.state.pose(self.state.position);
            self.emit(source, Action::Rapid(pose))?;
            self.call_modal(source)?;
        }
        Ok(())
    }
}

/// The square of the distance in the plane; one that is not known is not nearer.
fn flat(from: Vec3, to: Vec3) -> f64 {
    let way = (to - from).truncate();
    if way.is_nan() { f64::INFINITY } else { way.length_squared() }
}
