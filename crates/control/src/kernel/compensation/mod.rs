//! Cutter radius compensation: the path of the tool's centre from the programmed contour.
//!
//! It stands between a control and the caller's sink. While compensation is on with a tool whose
//! radius is known, contour goes in and the centre's path comes out: arcs stay arcs, corners are
//! treated as the control treats them ([`rules`]), one element of the contour is held back until the
//! next one says where it ends ([`path`]). With any other tool compensation stays a state and nothing
//! is changed. What each control does is in `docs/controls/compensation.md`, with sources.

#![deny(clippy::wildcard_enum_match_arm)]

mod faults;
mod leaving;
mod path;
mod plane;
mod rules;

use crate::event::{Action, Event, Orientation, Position};
use crate::kernel::Outcome;
use crate::{Dialect, Settings, Sink, ToolData};
use faults::{error, inverse_time, on_arc};
use geom::Vec3;
use leaving::Leaving;
use path::Path;
use program::{Axes, Compensation, Feed, Rule};
use rules::Registers;
pub(crate) use rules::{Outer, Rules};

/// What a control says of compensation in addition to its side and register.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms {
    /// Unit vector across the plane of compensation, from where the side is seen, in the frame of the
    /// poses.
    pub normal: Vec3,
    /// Whether it is the plane across the tool (`G17`).
    pub across_tool: bool,
    /// Radius that the program itself gives, mm.
    pub radius: Option<f64>,
    /// How outer corners are gone around where the program chooses.
    pub outer: Option<Outer>,
    /// The tool goes around the first and the last point where the way leads that way (`KONT`).
    pub around: bool,
}

/// Where the events of a control go: on to the sink, compensated.
pub(crate) struct Compensator<'a> {
    sink: &'a mut Sink<'a>,
    dialect: Dialect,
    tools: &'a [ToolData],
    /// The tool in the spindle, where the table has it.
    tool: Option<&'a ToolData>,
    /// Where the tool was sent last; NaN where that is not known.
    at: Position,
    inverse_time: bool,
    /// The contour, while compensation is on and resolved.
    path: Option<Box<Path>>,
    /// Compensation has been reported as a state, and nothing has moved since.
    reported: bool,
    /// The end of the contour, until the tool has left it.
    leaving: Option<Box<Leaving>>,
}

impl<'a> Compensator<'a> {
    pub(crate) fn new(settings: &'a Settings, sink: &'a mut Sink<'a>) -> Compensator<'a> {
        let nowhere = Orientation::Rotary { degrees: [f64::NAN; 3], tool_center: false };
        Compensator {
            sink,
            dialect: settings.dialect,
            tools: &settings.setup.tools,
            tool: None,
            at: Position { point: Vec3::NAN, orientation: nowhere },
            inverse_time: false,
            path: None,
            reported: false,
            leaving: None,
        }
    }

    /// Takes any event but a change of compensation.
    #[inline]
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "what moves the tool is found by `Action::position`, which names each"
    )]
    pub(crate) fn take(&mut self, event: Event) -> Outcome {
        match self.path {
            Some(_) => self.follow(event),
            None => {
                match &event.action {
                    Action::Rapid(pose) | Action::Line(pose) => self.arrive(event.line, *pose)?,
                    _ => self.note(&event)?,
                }
                (self.sink)(event)
            }
        }
    }

    /// Compensation changes to `side` in `line`, with the next move.
    pub(crate) fn switch(&mut self, line: u32, side: Compensation, terms: Terms) -> Outcome {
        if let Some(mut path) = self.path.take() {
            if side != Compensation::Off {
                let message = "compensation changes its side or its register while it is on";
                return Err(error(Rule::CompensationChange, line, message)
                    .help("switch it off (G40, R0) with a straight move first")
                    .into());
            }
            self.leaving = path.finish(self.sink)?.map(Box::new);
            self.at = path.programmed();
            return Ok(());
        }
        let (register, left) = match side {
            Compensation::Off => (None, 0.0),
            Compensation::Left(register) => (register, 1.0),
            Compensation::Right(register) => (register, -1.0),
        };
        let radius = terms.radius.or_else(|| self.radius(register));
        let (Some(radius), true) = (radius, left != 0.0) else {
            if side != Compensation::Off && !terms.across_tool {
                let message = "compensation in a plane that is not that of the tool";
                return Err(error(Rule::CompensationPlane, line, message)
                    .help("with the tool in the tool table it is resolved into the path")
                    .into());
            }
            self.reported = side != Compensation::Off;
            return (self.sink)(Event { line, action: Action::Compensation(side) });
        };
        let Some(rules) = Rules::of(self.dialect) else {
            let message = "how this control leads the tool with compensation is not known";
            return Err(error(Rule::CompensationUnsupported, line, message)
                .help("leave the tool out of the tool table: compensation then stays a state")
                .into());
        };
        if terms.around {
            let message = "KONT with compensation that is resolved into the path";
            return Err(error(Rule::CompensationUnsupported, line, message)
                .help("write NORM: the tool then goes straight to the contour")
                .into());
        }
        if terms.outer == Some(Outer::Peak) {
            let message = "DISC= above 0 with compensation that is resolved into the path";
            return Err(error(Rule::CompensationUnsupported, line, message)
                .help("write DISC=0: the tool then goes around corners on an arc")
                .into());
        }
        if !radius.is_finite() {
            let message = format!("the radius of the tool is {radius} mm");
            return Err(error(Rule::CompensationRadius, line, message).into());
        }
        if self.inverse_time {
            return Err(inverse_time(line));
        }
        if self.leaving.is_some() {
            let message = "compensation is switched on again before the tool has left the contour";
            return Err(error(Rule::CompensationChange, line, message)
                .help("a straight move in the plane must come between")
                .into());
        }
        let rules = Rules { outer: terms.outer.unwrap_or(rules.outer), ..rules };
        self.path = Some(Box::new(Path::new(rules, terms.normal, left * radius, self.at)));
        Ok(())
    }

    /// The program has ended.
    pub(crate) fn finish(&mut self) -> Outcome {
        match self.path.take() {
            Some(mut path) => path.finish(self.sink).map(|_| ()),
            None => Ok(()),
        }
    }

    fn follow(&mut self, event: Event) -> Outcome {
        if event.action == Action::End {
            self.finish()?;
            return (self.sink)(event);
        }
        match &mut self.path {
            Some(path) => path.take(event, self.sink),
            None => (self.sink)(event),
        }
    }

    /// Keeps in mind what compensation will need.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "what moves the tool is found by `Action::position`, which names each"
    )]
    fn note(&mut self, event: &Event) -> Outcome {
        match &event.action {
            Action::Feed(feed) => self.inverse_time = matches!(feed, Feed::InverseTime(_)),
            Action::Tool(tool) => {
                let named = |t: &&ToolData| !tool.name.is_empty() && t.name == tool.name;
                self.tool = match self.tools.iter().find(named) {
                    None if tool.name.is_empty() => self.of_number(tool.number),
                    found => found,
                };
                self.at.point = Vec3::NAN;
            }
            Action::Arc(_) if self.reported => return Err(on_arc(event.line)),
            Action::WorkOffset(_) | Action::Probe(_) | Action::Across(_) => {
                self.at.point = Vec3::NAN;
            }
            Action::Home(axes) => self.leave_for(*axes),
            Action::MachineMove(to) => self.leave_for(to.axes()),
            action => {
                if let Some(pose) = action.position() {
                    self.arrive(event.line, *pose)?;
                }
            }
        }
        Ok(())
    }

    /// The axes go where only the machine knows.
    fn leave_for(&mut self, axes: Axes) {
        self.leaving = None;
        for axis in (0..3).filter(|axis| axes.contains(Axes::linear(*axis))) {
            self.at.point[axis] = f64::NAN;
        }
    }

    /// The tool moves to `pose`, without compensation.
    #[inline]
    fn arrive(&mut self, line: u32, pose: Position) -> Outcome {
        if let Some(leaving) = self.leaving.take() {
            leaving.check(line, &pose)?;
        }
        self.at = pose;
        self.reported = false;
        Ok(())
    }

    /// The tool of that number in the table.
    fn of_number(&self, number: u32) -> Option<&'a ToolData> {
        self.tools.iter().find(|tool| tool.number == number)
    }

    /// The radius that `register` stands for, where the table has it.
    fn radius(&self, register: Option<u32>) -> Option<f64> {
        let tool = match (Registers::of(self.dialect), register) {
            (Registers::Edges, Some(1))
            | (Registers::NumberedOrHeld, None | Some(0))
            | (Registers::Held, None) => self.tool,
            (Registers::Edges, _) | (Registers::Numbered, None) => None,
            (_, Some(0)) => return (!self.tools.is_empty()).then_some(0.0),
            (_, Some(number)) => self.of_number(number),
        };
        tool.map(|tool| tool.radius)
    }
}
