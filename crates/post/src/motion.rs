//! Straight moves: rapid and in the cut, from known positions and from unknown ones.

use crate::catalogue::{BlockName, WordName};
use crate::place::{Kind, Stop};
use crate::template::{Words, bit};
use crate::walk::{Done, ORIENTATION, POSITION, Walk, motion};
use geom::Vec3;
use program::{Diagnostic, Pose};

impl Walk<'_> {
    /// A rapid of the source.
    pub(crate) fn rapid(&mut self, pose: &Pose, stop: &Stop) -> Done {
        self.end_cycle()?;
        self.sync_spindle()?;
        self.settle(pose, stop, false)?;
        self.rapid_to(pose, stop)
    }

    /// A rapid in the orientation at hand.
    pub(crate) fn rapid_to(&mut self, pose: &Pose, stop: &Stop) -> Done {
        if !self.located {
            return self.approach(pose, stop);
        }
        self.aim(pose, stop);
        self.here = Some(*pose);
        if !self.writer.changes(POSITION | ORIENTATION) {
            self.writer.unset(Words::MAX);
            return Ok(());
        }
        self.compensate(false)?;
        self.writer.code(WordName::Motion, motion::RAPID);
        self.block(self.straight(BlockName::Rapid))
    }

    /// The first position after a tool change or in a new orientation, in the machine's order of axes.
    fn approach(&mut self, pose: &Pose, stop: &Stop) -> Done {
        let machine = self.machine;
        for group in &machine.approach {
            self.aim(pose, stop);
            let words = group.chars().filter_map(|c| WordName::named(c.encode_utf8(&mut [0; 4])));
            let group = words.fold(0, |all, word| all | bit(word));
            let length = bit(WordName::H) | bit(WordName::Length);
            let held = if group & bit(WordName::Z) == 0 { length } else { 0 };
            self.writer.unset((POSITION & !group) | held);
            if self.writer.changes(POSITION | ORIENTATION) {
                self.writer.code(WordName::Motion, motion::RAPID);
                self.compensate(false)?;
                self.block(BlockName::Rapid)?;
            }
            self.writer.unset(Words::MAX);
        }
        self.located = true;
        self.here = Some(*pose);
        Ok(())
    }

    /// A straight cut of the source.
    pub(crate) fn line(&mut self, pose: &Pose, stop: &Stop) -> Done {
        self.end_cycle()?;
        self.before_cut()?;
        self.settle(pose, stop, true)?;
        if !self.located {
            let message =
                "the first move of the tool is a cut: it starts from wherever the tool is";
            self.findings.warn(Diagnostic::warning("feed-approach", message).line(self.line));
            self.located = true;
        }
        self.line_to(pose, stop)
    }

    /// A straight cut in the orientation at hand.
    pub(crate) fn line_to(&mut self, pose: &Pose, stop: &Stop) -> Done {
        let length = self.here.map_or(0.0, |here| here.point.distance(pose.point));
        if self.compensation_pending() {
            self.plane_xy()?;
        }
        self.aim(pose, stop);
        self.here = Some(*pose);
        if !self.writer.changes(POSITION | ORIENTATION) {
            self.writer.unset(Words::MAX);
            return Ok(());
        }
        let turning = matches!(self.place.kind, Kind::Machine) && self.writer.changes(ORIENTATION);
        self.say_feed(length, turning)?;
        self.compensate(true)?;
        self.writer.code(WordName::Motion, motion::LINEAR);
        self.block(self.straight(BlockName::Linear))
    }

    /// The block for a straight move in the orientation at hand.
    #[inline]
    fn straight(&self, name: BlockName) -> BlockName {
        let vector = match name {
            BlockName::Rapid => BlockName::RapidVector,
            _ => BlockName::LinearVector,
        };
        let by_vector = matches!(self.place.kind, Kind::Vectors) && self.templates.has(vector);
        if by_vector { vector } else { name }
    }

    /// Says in the next block where the tool goes.
    #[inline]
    pub(crate) fn aim(&mut self, pose: &Pose, stop: &Stop) {
        if let (Kind::ToolCenter | Kind::Machine, Some(step)) = (&self.place.kind, &stop.step) {
            self.say_degrees(step.degrees);
            self.place.turn_to(self.written(step.degrees));
        }
        if matches!(self.place.kind, Kind::Vectors) {
            let axis = pose.axis().unwrap_or(Vec3::Z);
            self.writer.set(WordName::VX, axis.x);
            self.writer.set(WordName::VY, axis.y);
            self.writer.set(WordName::VZ, axis.z);
        }
        if !matches!(self.place.kind, Kind::ToolCenter | Kind::Vectors) {
            self.say_length_offset();
        }
        let local = self.local(pose.point);
        self.writer.set(WordName::X, local.x);
        self.writer.set(WordName::Y, local.y);
        self.writer.set(WordName::Z, local.z);
    }

    /// A point of the work frame as blocks give it at the moment.
    #[inline]
    pub(crate) fn local(&self, point: Vec3) -> Vec3 {
        match &self.place.kind {
            Kind::Bare | Kind::Plain | Kind::ToolCenter | Kind::Vectors => point,
            Kind::Tilted(into, _) => into.transform_point3(point),
            Kind::Machine => {
                let degrees = self.place.degrees().unwrap_or_default();
                self.machine.linear_for(point, degrees, self.tool_length())
            }
        }
    }

    /// Says the tool length offset in the next block.
    pub(crate) fn say_length_offset(&mut self) {
        if let Some(register) = self.length_offset {
            self.writer.code(WordName::Length, 0);
            self.writer.set(WordName::H, register);
        }
    }

    /// Length of the tool, mm; 0 where the source is silent.
    pub(crate) fn tool_length(&self) -> f64 {
        self.tool.as_ref().and_then(|tool| tool.length).unwrap_or_default()
    }
}
