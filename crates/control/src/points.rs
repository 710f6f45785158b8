//! Lists of coordinates for a wire-EDM control that knows no G-code: a line a point, `X Y`, or
//! `X Y U V` where the wire leans.
//!
//! The first point is where the wire is threaded; it cuts to each that follows, and is cut at the last.
//! Nothing else can be said: `docs/controls/points.md`.

use crate::Settings;
use crate::event::{Action, Position};
use crate::kernel::decimal;
use crate::kernel::source::Source;
use crate::kernel::{Channel, Outcome};
use geom::{Vec3, direction};
use program::{Diagnostic, Rule};

/// The most numbers of a line.
const MOST: usize = 4;

/// Runs a list.
pub(crate) fn run(settings: &Settings, text: &[u8], channel: &mut Channel) -> Outcome {
    let text = text.strip_suffix(b"\n").unwrap_or(text);
    let mut width = 0;
    let mut last = 0;
    for (index, bytes) in text.split(|&b| b == b'\n').enumerate() {
        let bytes = bytes.strip_suffix(b"\r").unwrap_or(bytes);
        let number = u32::try_from(index + 1).unwrap_or(u32::MAX);
        let line = Line(Source { line: number, text: bytes });
        let mut values = [0.0; MOST];
        let count = line.read(&mut values)?;
        if index > 0 && count != width {
            let message = format!("{count} numbers, where the first line has {width}");
            return Err(line.error(Rule::Syntax, (0, bytes.len()), message).into());
        }
        (width, last) = (count, number);
        let pose = line.pose(values, count, settings.wire.height)?;
        let mut tell = |action| channel.report(line.0.line, action);
        if index == 0 {
            tell(Action::Rapid(pose))?;
            tell(Action::ThreadWire)?;
        } else {
            tell(Action::Line(pose))?;
        }
    }
    channel.report(last, Action::CutWire)?;
    channel.report(last, Action::End)
}

/// A line of a list.
struct Line<'a>(Source<'a>);

impl Line<'_> {
    /// Reads two or four numbers into `values`; how many there are.
    fn read(&self, values: &mut [f64; MOST]) -> Outcome<usize> {
        let blanks = |at: usize| {
            let rest = self.0.text.get(at..).unwrap_or_default();
            at + rest.iter().take_while(|b| matches!(b, b' ' | b'\t')).count()
        };
        let (mut at, mut count) = (blanks(0), 0);
        while at < self.0.text.len() {
            let number = decimal::parse(self.0.text.get(at..).unwrap_or_default());
            let Some((number, value)) = number.zip(values.get_mut(count)) else {
                let found = self.0.text.get(at).map_or(' ', |&b| char::from(b));
                let message = format!("`{found}` where a number or the end of the line is needed");
                return Err(self.error(Rule::Syntax, (at, at + 1), message).into());
            };
            let end = at + number.len;
            if !number.value.is_finite() {
                let message = "a number beyond all numbers";
                return Err(self.error(Rule::Number, (at, end), message).into());
            }
            *value = number.value;
            count += 1;
            at = blanks(end);
            if at == end && at < self.0.text.len() {
                let message = "a blank is needed between two numbers";
                return Err(self.error(Rule::Syntax, (at, at + 1), message).into());
            }
        }
        if matches!(count, 2 | 4) {
            return Ok(count);
        }
        let message = format!("{count} numbers: a point is X Y, or X Y U V");
        Err(self.error(Rule::Syntax, (0, self.0.text.len()), message).into())
    }

    fn pose(
        &self,
        [x, y, u, v]: [f64; MOST],
        count: usize,
        height: Option<f64>,
    ) -> Outcome<Position> {
        let lower = Vec3::new(x, y, 0.0);
        if count == 2 {
            return Ok(Position::new(lower, Vec3::Z));
        }
        let Some(height) = height else {
            let message = "U and V, and the height of the upper plane is not known";
            let found = self.error(Rule::UpperPlane, (0, self.0.text.len()), message);
            return Err(found.help("`height` in the [wire] table of the machine").into());
        };
        let Some(axis) = direction(Vec3::new(u, v, height)) else {
            let message = "U and V lie so far out that the wire has no direction";
            return Err(self.error(Rule::Number, (0, self.0.text.len()), message).into());
        };
        Ok(Position::new(lower, axis))
    }

    fn error(
        &self,
        rule: Rule,
        (start, end): (usize, usize),
        message: impl Into<String>,
    ) -> Diagnostic {
        let help = "a list of coordinates has one point a line: X Y, or X Y U V, parted by blanks";
        self.0.error(rule, start..end, message).help(help)
    }
}
