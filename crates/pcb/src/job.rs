//! From operations to a program in the neutral vocabulary.
//!
//! The surface of the board is Z 0. Between two cuts the tool is above the board by [`Heights::travel`];
//! it feeds from [`Heights::approach`] on.

use crate::{Cut, Operation, Segment, Tool};
use geom::{Vec2, Vec3};
use program::{ArcTo, Circle, Cycle, CycleKind, Feed, NoPose, Op, Pose, Program, Spindle};

/// Heights of the tool tip above the board, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heights {
    /// Of rapid moves from cut to cut.
    pub travel: f64,
    /// From which the tool feeds.
    pub approach: f64,
}

/// The program that does `operations`, one after the other, each with the number of its tool. What the
/// records came from is no line of a file: theirs is 0.
///
/// # Errors
/// A place or a height that is not finite.
pub fn program(
    name: &str,
    operations: &[(u32, &Operation)],
    heights: &Heights,
) -> Result<Program, NoPose> {
    let mut writer = Writer {
        program: Program::new(name),
        heights: *heights,
        at: None,
        feed: None,
        cycle: None,
    };
    for (number, operation) in operations {
        writer.operation(operation, *number)?;
    }
    writer.push(Op::Spindle(Spindle::Off));
    writer.push(Op::End);
    Ok(writer.program)
}

struct Writer {
    program: Program,
    heights: Heights,
    /// Where the tool tip is; `None` before the first move and after a change of tool.
    at: Option<Vec3>,
    /// The feed that holds, mm/min.
    feed: Option<f64>,
    /// Depth of the drilling cycle that holds, mm, and of its pecks.
    cycle: Option<(f64, Option<f64>)>,
}

impl Writer {
    fn push(&mut self, op: Op) {
        self.program.push(0, op);
    }

    fn operation(&mut self, operation: &Operation, number: u32) -> Result<(), NoPose> {
        let Operation { name, tool, cuts } = operation;
        self.push(Op::Operation(name.as_str().into()));
        self.push(Op::Tool(Box::new(program::Tool {
            number,
            name: tool.name.clone(),
            diameter: Some(tool.cutter.width(0.0)).filter(|width| *width > 0.0),
            ..program::Tool::default()
        })));
        (self.at, self.feed) = (None, None);
        self.push(Op::Spindle(Spindle::Clockwise(tool.speed)));
        for cut in cuts {
            match cut {
                Cut::Hole { at, depth, peck } => self.hole(tool, *at, *depth, *peck)?,
                Cut::Path(segments) => self.path(tool, segments)?,
            }
        }
        self.end_of_cycle();
        self.push(Op::EndOfOperation);
        Ok(())
    }

    fn hole(&mut self, tool: &Tool, at: Vec2, depth: f64, peck: Option<f64>) -> Result<(), NoPose> {
        if self.cycle != Some((depth, peck)) {
            self.end_of_cycle();
            self.over(at)?;
            self.push(Op::Cycle(Box::new(Cycle {
                kind: if peck.is_some() { CycleKind::Deep } else { CycleKind::Drill },
                depth,
                clearance: self.heights.approach,
                retract: self.heights.travel,
                feed: Some(Feed::PerMinute(tool.plunge)),
                dwell: 0.0,
                first_peck: None,
                peck,
            })));
            self.cycle = Some((depth, peck));
        }
        self.push(Op::Hole(Pose::upright(at.extend(0.0))?));
        self.at = Some(at.extend(self.heights.travel));
        Ok(())
    }

    fn path(&mut self, tool: &Tool, segments: &[Segment]) -> Result<(), NoPose> {
        let Some(first) = segments.first() else { return Ok(()) };
        self.end_of_cycle();
        let start = first.element.start;
        self.over(start)?;
        self.rapid(start.extend(self.heights.approach))?;
        for Segment { element, depth } in segments {
            self.line(tool, element.start.extend(-depth))?;
            self.set_feed(tool.feed);
            let end = element.end.extend(-depth);
            match element.turn {
                None => self.line(tool, end)?,
                Some(turn) => {
                    let normal = if turn.sweep > 0.0 { Vec3::Z } else { Vec3::NEG_Z };
                    let center = turn.center.extend(-depth);
                    self.push(Op::Arc(Box::new(ArcTo {
                        end: Pose::upright(end)?,
                        circle: Circle::new(center, normal, 0)?,
                    })));
                    self.at = Some(end);
                }
            }
        }
        if let Some(at) = self.at {
            self.rapid(Vec3 { z: self.heights.travel, ..at })?;
        }
        Ok(())
    }

    /// By rapid over a place of the board, at the height of travel.
    fn over(&mut self, place: Vec2) -> Result<(), NoPose> {
        self.rapid(place.extend(self.heights.travel))
    }

    fn rapid(&mut self, to: Vec3) -> Result<(), NoPose> {
        if self.at != Some(to) {
            self.push(Op::Rapid(Pose::upright(to)?));
            self.at = Some(to);
        }
        Ok(())
    }

    /// Straight to `to`, where that is somewhere else; straight down at the feed for it.
    fn line(&mut self, tool: &Tool, to: Vec3) -> Result<(), NoPose> {
        let Some(from) = self.at.filter(|from| *from != to) else { return Ok(()) };
        let down = from.truncate() == to.truncate() && to.z < from.z;
        self.set_feed(if down { tool.plunge } else { tool.feed });
        self.push(Op::Line(Pose::upright(to)?));
        self.at = Some(to);
        Ok(())
    }

    fn set_feed(&mut self, feed: f64) {
        if self.feed != Some(feed) {
            self.push(Op::Feed(Feed::PerMinute(feed)));
            self.feed = Some(feed);
        }
    }

    fn end_of_cycle(&mut self) {
        if self.cycle.take().is_some() {
            self.push(Op::CycleOff);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Cutter;
    use geom::Element;

    fn tool() -> Tool {
        let cutter = Cutter::Cylinder { diameter: 0.4 };
        Tool { name: "mill".into(), cutter, feed: 200.0, plunge: 60.0, speed: 9000.0 }
    }

    /// The ops as short words: R rapid, L line, F feed, H hole.
    fn listed(program: &Program) -> Vec<String> {
        let at = |pose: &Pose| pose.point().to_array().map(|value| value.to_string()).join(" ");
        let word = |op: &Op| match op {
            Op::Rapid(pose) => Some(format!("R {}", at(pose))),
            Op::Line(pose) => Some(format!("L {}", at(pose))),
            Op::Hole(pose) => Some(format!("H {}", at(pose))),
            Op::Feed(Feed::PerMinute(feed)) => Some(format!("F {feed}")),
            Op::Arc(arc) => Some(format!("A {} about {}", at(&arc.end), arc.circle.normal().z)),
            _ => None,
        };
        program.records.iter().filter_map(|record| word(&record.op)).collect()
    }

    #[test]
    fn a_way_goes_down_along_deeper_and_out() {
        let forth = Element::line(Vec2::ZERO, Vec2::X);
        let segments = [(forth, 0.1), (forth.reversed(), 0.2)];
        let cuts = vec![Cut::Path(
            segments
                .iter()
                .map(|(element, depth)| Segment { element: *element, depth: *depth })
                .collect(),
        )];
        let operation = Operation { name: "cut".into(), tool: tool(), cuts };
        let heights = Heights { travel: 2.0, approach: 0.5 };
        let right = [
            "R 0 0 2",
            "R 0 0 0.5",
            "F 60",
            "L 0 0 -0.1",
            "F 200",
            "L 1 0 -0.1",
            "F 60",
            "L 1 0 -0.2",
            "F 200",
            "L 0 0 -0.2",
            "R 0 0 2",
        ];
        assert_eq!(listed(&program("a", &[(1, &operation)], &heights).unwrap()), right);
    }

    #[test]
    fn holes_of_one_depth_are_one_cycle() {
        let hole = |x: f64, depth: f64| Cut::Hole { at: Vec2::new(x, 0.0), depth, peck: None };
        let cuts = vec![hole(1.0, 2.0), hole(2.0, 2.0), hole(3.0, 1.0)];
        let operation = Operation { name: "drill".into(), tool: tool(), cuts };
        let program =
            program("a", &[(1, &operation)], &Heights { travel: 2.0, approach: 0.5 }).unwrap();
        let cycles: Vec<f64> = program
            .records
            .iter()
            .filter_map(
                |record| if let Op::Cycle(cycle) = &record.op { Some(cycle.depth) } else { None },
            )
            .collect();
        assert_eq!(cycles, [2.0, 1.0]);
        assert_eq!(listed(&program), ["R 1 0 2", "H 1 0 0", "H 2 0 0", "R 3 0 2", "H 3 0 0"]);
    }
}
