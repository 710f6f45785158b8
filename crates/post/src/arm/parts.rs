//! A program that is larger than the controller takes: in files, which a main program calls.
//!
//! The first run writes it whole, and notes what there is at each place where it may be divided: where a rapid has taken the tool beyond
//! all cuts. The second run knows by that how much there is to the next one, and begins another file where it would not fit any more.

use super::{BlockName, STEPS_AT_ONCE, Step, Walk, WordName, named};
use crate::Part;
use crate::writer::Cutting;
use machine::Machine;
use program::{Diagnostic, Outcome, Progress, Pulse, Rule};

/// How large a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    bytes: usize,
    lines: usize,
    points: usize,
}

/// Where a program may be divided.
#[derive(Clone, Copy, Debug)]
pub(super) struct Border {
    /// Before this step.
    pub(super) step: usize,
    /// What has been written up to there.
    pub(super) size: Size,
}

/// What a file has besides what stands in it of the whole program: a feed and a corner once more, and its end with its head.
const BESIDES: Size = Size { bytes: 1024, lines: 4, points: 1 };

/// Most letters of the name of a program.
const LETTERS: usize = 24;

/// The largest file that the machine takes.
pub(super) fn bounds(machine: &Machine) -> Size {
    let can = &machine.capabilities;
    Size { bytes: can.program_bytes, lines: can.program_lines, points: can.program_points }
}

impl Size {
    /// Larger than any program.
    pub(super) const MOST: Size = Size { bytes: usize::MAX, lines: usize::MAX, points: usize::MAX };

    /// Whether a file of this size is none too large.
    pub(super) fn hold(&self, size: &Size) -> bool {
        size.bytes <= self.bytes && size.lines <= self.lines && size.points <= self.points
    }

    fn each(self, other: Size, both: impl Fn(usize, usize) -> usize) -> Size {
        Size {
            bytes: both(self.bytes, other.bytes),
            lines: both(self.lines, other.lines),
            points: both(self.points, other.points),
        }
    }
}

impl Walk<'_> {
    /// What the file has that is being written.
    pub(super) fn size(&self) -> Size {
        let lines = match self.writer.has(&[WordName::N]) {
            true => self.writer.numbered() as usize,
            false => self.writer.lines() - self.earlier_lines,
        };
        Size {
            bytes: self.writer.end() + self.table.text.len(),
            lines,
            points: self.points as usize,
        }
    }

    /// Whether a file may end here: nothing is cut, and the tool is beyond all cuts.
    pub(super) fn is_border(&self) -> bool {
        !self.is_cutting && self.tool.is_some() && self.rapids.is_beyond_cuts(&self.here.tool)
    }

    /// Writes the program in files, of which `whole` is the size of all, and then the one that calls them.
    ///
    /// # Errors
    /// Between two places where it may be divided it has more than a file takes; the control has no call.
    pub(super) fn divided(
        &mut self,
        steps: &[Step<'_>],
        borders: &[Border],
        whole: Size,
        progress: &dyn Progress,
    ) -> Outcome {
        let mut pulse = Pulse::new(progress, steps.len(), STEPS_AT_ONCE);
        let bounds = bounds(self.machine);
        if !self.templates.has(BlockName::PartCall) {
            let why = "its control has no call of another file";
            return Err(too_large(&whole, &bounds, why).help("a program of its own for each operation of the toolpath, run one after the other; or fewer points: a larger tolerance of the toolpath").into());
        }
        let [start, end] = [
            (BlockName::PartStart, BlockName::ProgramStart),
            (BlockName::PartEnd, BlockName::ProgramEnd),
        ]
        .map(|(own, otherwise)| if self.templates.has(own) { own } else { otherwise });
        let mut names = vec![self.part_name(1)];
        self.scope.program = named(self.machine, &names[0], "");
        self.start(start)?;
        let mut borders = borders.iter().peekable();
        for index in 0..steps.len() {
            pulse.step(index)?;
            if let Some(border) = borders.next_if(|border| border.step == index) {
                let next = borders.peek().map_or(whole, |next| next.size);
                let comes = next
                    .each(border.size, usize::saturating_sub)
                    .each(BESIDES, usize::saturating_add);
                if !bounds.hold(&self.size().each(comes, usize::saturating_add)) {
                    self.save_part(&names, (start, end), &bounds)?;
                    names.push(self.part_name(names.len() + 1));
                    self.scope.program = named(self.machine, &names[names.len() - 1], "");
                    self.start(start)?;
                    if let Some(tool) = self.tool {
                        self.state_frames(&tool)?;
                        self.joints(&self.here.clone())?;
                    }
                }
            }
            self.step(steps, index)?;
        }
        self.finish()?;
        self.save_part(&names, (start, end), &bounds)?;
        let own = self.name.clone();
        self.scope.program = named(self.machine, &own, "");
        self.start(BlockName::ProgramStart)?;
        for name in &names {
            self.scope.program = named(self.machine, &own, name);
            self.required(BlockName::PartCall)?;
        }
        self.end(BlockName::ProgramStart, BlockName::ProgramEnd).map(drop)
    }

    /// The name of a part, which is that of its file too.
    fn part_name(&self, number: usize) -> String {
        let number = format!("_{number}");
        let kept = self.name.len().min(LETTERS - number.len());
        let name = format!("{}{number}", &self.name[..kept]);
        // A name of that length may end like a part itself.
        if name == self.name { format!("{}{number}", &self.name[..kept - 1]) } else { name }
    }

    /// Ends a file.
    ///
    /// # Errors
    /// It is too large.
    fn save_part(
        &mut self,
        names: &[String],
        (start, end): (BlockName, BlockName),
        bounds: &Size,
    ) -> Outcome {
        let size = self.end(start, end)?;
        if !bounds.hold(&size) {
            let why = "there is no retract at which it could be divided";
            return Err(too_large(&size, bounds, why).help("rapids of the source that take the tool beyond all cuts, or fewer points: a larger tolerance of the toolpath").into());
        }
        let name = names.last().map_or("", |name| name).to_ascii_lowercase();
        let file = format!("{name}.{}", self.machine.extension);
        let Cutting { text, origins } = self.writer.cut(0);
        self.parts.push(Part { file, text, origins });
        self.writer.count_anew();
        self.points = 0;
        self.earlier_lines = self.writer.lines();
        Ok(())
    }
}

/// The refusal of a file.
fn too_large(size: &Size, bounds: &Size, why: &str) -> Diagnostic {
    let row = |has: usize, most: usize, what: &str| {
        (has > most).then(|| format!("{has} {what}, the control takes {most}"))
    };
    let rows = [
        row(size.lines, bounds.lines, "lines"),
        row(size.points, bounds.points, "positions"),
        row(size.bytes, bounds.bytes, "bytes"),
    ];
    let rows: Vec<String> = rows.into_iter().flatten().collect();
    let message = format!("a file of the program has {}, and {why}", rows.join("; "));
    Diagnostic::error(Rule::Memory, message)
}
