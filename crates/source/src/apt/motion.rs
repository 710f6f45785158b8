//! Statements that move the tool.

use super::arc::CircleWord;
use super::frame::{FARTHEST, SKEW};
use super::number;
use super::report::{Fault, Outcome};
use super::statement::{Field, Statement, is_blank};
use super::{Dialect, Early, Reader, Ready};
use geom::{ANGLE_EPSILON, Vec3};
use program::{Feed, Op, Pose, Rule, Spindle, Tool};

/// How the next `GOTO` goes.
#[derive(Clone, Debug, Default)]
pub(super) enum Next {
    /// Straight, at the active feed.
    #[default]
    Line,
    /// By rapid.
    Rapid,
    /// Along a circle.
    Arc(Box<CircleWord>),
}

/// The values of a `GOTO` line in its plain shape, read without taking the statement apart: three or six
/// numbers and nothing else.
#[inline]
pub(super) fn plain_goto(text: &[u8]) -> Option<([f64; 6], bool)> {
    let mut rest = text.strip_prefix(b"GOTO")?;
    if rest.first() != Some(&b'/') {
        let slash = rest.iter().position(|c| *c != b' ')?;
        rest = rest.get(slash..)?;
    }
    rest = rest.strip_prefix(b"/")?;
    let mut values = [0.0; 6];
    let mut count = 0;
    loop {
        while let [b' ', after @ ..] = rest {
            rest = after;
        }
        let (value, length) = number::leading(rest)?;
        *values.get_mut(count)? = value;
        count += 1;
        rest = rest.get(length..)?;
        match rest {
            [b',', after @ ..] => rest = after,
            [] => break,
            _ if rest.iter().all(|c| is_blank(*c)) => break,
            // A blank before the comma, a remark, a continuation: the full reader takes them.
            _ => return None,
        }
    }
    matches!(count, 3 | 6).then_some((values, count == 6))
}

impl Reader {
    /// A plain `GOTO` line where nothing else is going on. Whether it was one, and was obeyed; if not,
    /// nothing has changed.
    #[inline]
    pub(super) fn obey_plain_goto(&mut self, line: u32, text: &[u8]) -> bool {
        if self.cycle.is_some() || self.ready != Ready::Cut || self.last_arc.is_some() {
            return false;
        }
        let rapid = match self.next {
            Next::Line => false,
            Next::Rapid => true,
            Next::Arc(_) => return false,
        };
        let Some((values, with_axis)) = plain_goto(text) else { return false };
        let [x, y, z, i, j, k] = values;
        let mut point = Vec3::new(x, y, z) * self.unit;
        if point.abs().max_element() > FARTHEST {
            return false;
        }
        if !with_axis && self.axis_is_due() {
            return false;
        }
        let mut axis = self.axis;
        if with_axis {
            match self.work_axis(Vec3::new(i, j, k)) {
                Ok(given) => axis = given,
                Err(_) => return false,
            }
        }
        if !self.setup.identity {
            point = self.setup.to_work.transform_point3(point);
        }
        let Ok(pose) = Pose::new(point, axis) else { return false };
        self.axis = axis;
        self.next = Next::Line;
        self.inside_goto = true;
        self.arrive(pose);
        self.push(line, if rapid { Op::Rapid(pose) } else { Op::Line(pose) });
        true
    }

    /// `GOTO/x,y,z`, `GOTO/x,y,z,i,j,k`: a value left out stays.
    pub(super) fn goto(&mut self, statement: &Statement) -> Outcome {
        self.goto_from(statement, 0)
    }

    /// A `GOTO` whose values begin at field `first`.
    pub(super) fn goto_from(&mut self, statement: &Statement, first: usize) -> Outcome {
        self.inside_goto = true;
        let count = statement.fields.len() - first.min(statement.fields.len());
        if count != 3 && count != 6 {
            let message = format!("{count} values where a point takes 3, or 6 with the tool axis");
            return Err(Fault::new(Rule::Malformed, message)
                .help("write GOTO/x,y,z or GOTO/x,y,z,i,j,k")
                .fields(first, count));
        }
        let point = self.given_point(statement, first)?;
        let is_given = |i: usize| statement.fields.get(i).is_some_and(|f| *f != Field::Blank);
        if (first + 3..first + 6).any(is_given) {
            self.axis = self.given_axis(statement, first + 3)?;
        } else if self.axis_is_due() {
            let message = "the tool is tilted, and this system gives its axis in every GOTO: is it kept \
                           here, or along Z again?";
            return Err(Fault::new(Rule::ToolAxis, message)
                .help("give the vector: GOTO/x,y,z,i,j,k")
                .fields(first, count));
        }
        let pose = Pose::new(point, self.axis)?;
        self.go(statement, pose).map_err(|fault| fault.fields(first, count))
    }

    /// Whether a `GOTO` without a vector leaves the tool axis in doubt. In the measured set-ups of
    /// SolidWorks CAM every `GOTO` of a tilted tool has its vector, so leaving it out may mean Z.
    #[inline]
    fn axis_is_due(&self) -> bool {
        self.dialect == Dialect::SolidWorksCam && self.axis.distance(Vec3::Z) > ANGLE_EPSILON
    }

    /// The point at field `first`, in the work frame; a blank keeps the last value.
    fn given_point(&self, statement: &Statement, first: usize) -> Result<Vec3, Box<Fault>> {
        let last = || Some(self.setup.to_work.inverse().transform_point3(self.point?));
        let mut point = [0.0; 3];
        for (i, value) in point.iter_mut().enumerate() {
            *value = match statement.fields.get(first + i) {
                Some(Field::Blank) => last().map(|last| last[i]).ok_or_else(|| {
                    Fault::new(Rule::Malformed, "no earlier point has this value to keep")
                        .help("give all three coordinates of the first point")
                        .fields(first + i, 1)
                })?,
                _ => {
                    let value = statement.number(first + i, "a coordinate")?;
                    self.length(value).map_err(|fault| fault.fields(first + i, 1))?
                }
            };
        }
        Ok(self.setup.to_work.transform_point3(Vec3::from_array(point)))
    }

    /// The tool axis at field `first`, in the work frame; a blank keeps the last value.
    fn given_axis(&self, statement: &Statement, first: usize) -> Result<Vec3, Box<Fault>> {
        let blank = |i: usize| statement.fields.get(first + i) == Some(&Field::Blank);
        let mut axis = self.setup.to_work.inverse().transform_vector3(self.axis).to_array();
        for (i, value) in axis.iter_mut().enumerate() {
            if !blank(i) {
                *value = statement.number(first + i, "a value")?;
            }
        }
        let axis = Vec3::from_array(axis);
        // Values of two vectors make one vector only where both have the same length: that of 1, in
        // which the last one is kept.
        if (0..3).any(blank) && (axis.length() - 1.0).abs() > SKEW {
            let message =
                "what this vector gives and what it keeps of the last one are no unit vector";
            return Err(Fault::new(Rule::ToolAxis, message)
                .help("give all three values of the vector")
                .fields(first, 3));
        }
        self.work_axis(axis).map_err(|fault| fault.fields(first, 3))
    }

    /// Goes to `pose` by rapid, line or arc, as the statements before state.
    fn go(&mut self, statement: &Statement, pose: Pose) -> Outcome {
        match std::mem::take(&mut self.next) {
            Next::Arc(circle) => self.arc(statement, &circle, pose),
            Next::Rapid => {
                self.prepare(statement, false)?;
                self.push(statement.line, Op::Rapid(pose));
                self.arrive(pose);
                Ok(())
            }
            Next::Line if self.cycle.is_some() => {
                self.prepare(statement, true)?;
                self.hole(statement, pose)
            }
            Next::Line => {
                self.prepare(statement, true)?;
                self.not_on_the_arc(statement, &pose)?;
                self.push(statement.line, Op::Line(pose));
                self.arrive(pose);
                Ok(())
            }
        }
    }

    /// The tool is at `pose` now.
    #[inline]
    pub(super) fn arrive(&mut self, pose: Pose) {
        self.point = Some(pose.point());
        self.tip = Some(pose);
        self.last_arc = None;
        self.towards = None;
    }

    /// What has to be settled before the tool moves; with `cut`, in the part.
    pub(super) fn prepare(&mut self, statement: &Statement, cut: bool) -> Outcome {
        if self.ready == Ready::Cut || (self.ready == Ready::Rapid && !cut) {
            return Ok(());
        }
        if !self.unit_known && !std::mem::replace(&mut self.unit_assumed, true) {
            let help = "add UNITS/MM, or UNITS/INCHES where that is meant";
            let message = "the file does not say its unit: read as mm";
            self.report.warn(statement, Rule::UnknownUnit, message, help);
            // Plain points after this one are not looked at one by one.
            if self.unit_used.get() == 0 {
                self.unit_used.set(statement.line);
            }
        }
        self.say_tolerance(statement.line);
        self.settle_tool(statement, cut)?;
        if let Some((line, pose)) = self.from.take()
            && cut
        {
            let message = "the first motion from FROM is a cut: a rapid to FROM goes before it";
            self.report.warn(statement, Rule::From, message, "check that the path there is free");
            self.push(line, Op::Rapid(pose));
        }
        self.ready = Ready::Rapid;
        if !cut {
            return Ok(());
        }
        let stands = self.spindle == Spindle::Off;
        let no_feed = match self.cycle.as_ref().and_then(|cycle| cycle.feed()).or(self.feed) {
            Some(Feed::PerMinute(f) | Feed::PerTurn(f) | Feed::InverseTime(f)) => f <= 0.0,
            None => true,
        };
        self.ready = Ready::Cut;
        if stands && !std::mem::replace(&mut self.stands, true) {
            return Err(Fault::new(Rule::SpindleOff, "the tool cuts here, but the spindle stands")
                .help("add SPINDL/speed,RPM,CLW before it"));
        }
        if no_feed && !std::mem::replace(&mut self.no_feed, true) {
            return Err(Fault::new(Rule::NoFeed, "the tool cuts here without a feed")
                .help("add FEDRAT/value,MMPM before it"));
        }
        Ok(())
    }

    /// Makes sure that a tool is in the spindle, and that it is the one the operation names.
    fn settle_tool(&mut self, statement: &Statement, cut: bool) -> Outcome {
        if self.tool.number == 0 {
            if let Some(load) = self.first_load {
                return self.move_before_load(statement, cut, load);
            }
            let mut tool = std::mem::take(&mut self.next_tool);
            tool.number = 1;
            let line = if self.next_line > 0 { self.next_line } else { statement.line };
            let message = "the file loads no tool: the tool is taken as number 1";
            let help = "add LOAD/TOOL,n before the first motion";
            self.report.warn(statement, Rule::ToolNumber, message, help);
            self.change_tool(line, tool);
        }
        self.settle_surface_speed()?;
        self.speed_due = None;
        self.tool_record = None;
        let wanted = std::mem::take(&mut self.next_tool.name);
        let both_named = !wanted.is_empty() && !self.tool.name.is_empty();
        if self.operation.is_some() && both_named && wanted != self.tool.name {
            let message = format!(
                "this operation is for tool {wanted}, but {} is in the spindle",
                self.tool.name
            );
            return Err(Fault::new(Rule::ToolChange, message)
                .help("add LOAD/TOOL,n at the start of the operation"));
        }
        if cut { self.cut_with_described_tool(statement) } else { Ok(()) }
    }

    /// A cut behind the description of a tool that no statement loads: the tool in the spindle has to be that one. Before a
    /// rapid the description may still belong to a tool that is loaded behind it.
    fn cut_with_described_tool(&mut self, statement: &Statement) -> Outcome {
        let described = std::mem::take(&mut self.next_tool);
        let differs = |described: Option<f64>, loaded: Option<f64>| {
            described.zip(loaded).is_some_and(|(described, loaded)| described != loaded)
        };
        let (number, line) = (self.tool.number, self.next_line);
        if differs(described.diameter, self.tool.diameter)
            || differs(described.corner_radius, self.tool.corner_radius)
        {
            let message = format!(
                "this cut is for {}, as line {line} describes it, but tool {number}, {}, is in the spindle",
                size(&described),
                size(&self.tool)
            );
            return Err(Fault::new(Rule::ToolChange, message)
                .help("add LOAD/TOOL,n behind that line, or take the line out"));
        }
        if described.diameter.is_some() && self.tool.diameter.is_none() {
            let message = format!(
                "line {line} describes {} and no tool is loaded behind it: that tool {number} is this one is not known, and is not passed on",
                size(&described)
            );
            let help = "move the line to directly behind LOAD/TOOL";
            self.report.warn(statement, Rule::ToolChange, &message, help);
        }
        Ok(())
    }

    /// A motion before line `load` loads the first tool. CATIA goes to the point of tool change so,
    /// before it describes and loads the tool (Dassault Systèmes, *NC Data Options*, "Include GOTO for
    /// tool change"; example in *Syntax of Generated APT Instructions*). A rapid has no other meaning than where the tool is to be: with the first
    /// tool loaded before it, its tip is there. With which tool a cut is made is not known.
    fn move_before_load(&mut self, statement: &Statement, cut: bool, load: u32) -> Outcome {
        if cut {
            let message = format!(
                "line {} cuts before the first tool is loaded (line {load})",
                statement.line
            );
            return Err(Fault::new(Rule::ToolNumber, message)
                .help("load the tool first, or make the motion a RAPID"));
        }
        if self.early.is_none() {
            let message = format!(
                "line {} moves before the first tool is loaded (line {load}): the tool is loaded first",
                statement.line
            );
            let help = "check that the path there is free with this tool";
            self.report.warn(statement, Rule::ToolNumber, &message, help);
            let (line, records) = (statement.line, self.program.records.len());
            self.early = Some(Early { line, records, diameter: self.next_tool.diameter });
        }
        Ok(())
    }

    /// `FROM/x,y,z`, `FROM/x,y,z,i,j,k`: where the tool is. It is no motion.
    pub(super) fn from(&mut self, statement: &Statement) -> Outcome {
        let count = statement.count(&[3, 6], "FROM/x,y,z or FROM/x,y,z,i,j,k")?;
        let point = self.given_point(statement, 0)?;
        if count == 6 {
            self.axis = self.given_axis(statement, 3)?;
        }
        let pose = Pose::new(point, self.axis)?;
        self.arrive(pose);
        self.from = Some((statement.line, pose));
        self.ready = Ready::No;
        Ok(())
    }

    /// `GODLTA/dx,dy,dz`, `GODLTA/dx,dy,dz,i,j,k`, `GODLTA/d` along the tool axis: relative motion.
    pub(super) fn godlta(&mut self, statement: &Statement) -> Outcome {
        let count = statement.count(&[1, 3, 6], "GODLTA/dx,dy,dz or GODLTA/d")?;
        let Some(last) = self.point else {
            return Err(Fault::new(Rule::NoStart, "a relative motion, but from nowhere")
                .help("add FROM/x,y,z or an absolute GOTO before it"));
        };
        if self.cycle.is_none() && self.tip.is_some_and(|tip| tip.point() != last) {
            return Err(Fault::new(
                Rule::NoStart,
                "a relative motion after a hole: from which height?",
            )
            .help("write an absolute GOTO after CYCLE/OFF"));
        }
        let step = if count == 1 {
            let along = statement.number(0, "a distance")?;
            self.axis * self.length(along).map_err(|fault| fault.fields(0, 1))?
        } else {
            self.setup.to_work.transform_vector3(self.point(statement, 0)?)
        };
        if count == 6 {
            let axis = Vec3::from_array(statement.numbers(3)?);
            self.axis = self.work_axis(axis).map_err(|fault| fault.fields(3, 3))?;
        }
        let to = last + step;
        if to.abs().max_element() > FARTHEST {
            return Err(Fault::new(Rule::OutOfRange, "this leads beyond the farthest point"));
        }
        self.go(statement, Pose::new(to, self.axis)?)
    }

    /// `RAPID`: the next motion is one.
    pub(super) fn rapid(&mut self, statement: &Statement) -> Outcome {
        self.no_pending_circle()?;
        statement.count(&[0], "RAPID")?;
        self.next = Next::Rapid;
        Ok(())
    }

    /// `x,y,z` alone on a line: a further point of the `GOTO` before it, as Creo lists the points of
    /// an arc.
    pub(super) fn further_point(&mut self, statement: &Statement) -> Outcome {
        if !self.inside_goto {
            return Err(Fault::new(Rule::Malformed, "a line of numbers, but no GOTO before it"));
        }
        if self.lengthen_arc(statement)? { Ok(()) } else { self.goto(statement) }
    }
}

/// A cutter by its diameter, and its corner radius where that is known.
fn size(tool: &Tool) -> String {
    let diameter =
        tool.diameter.map_or_else(|| "a cutter".into(), |d| format!("a cutter of {d} mm"));
    tool.corner_radius
        .map_or_else(|| diameter.clone(), |r| format!("{diameter} with a corner radius of {r} mm"))
}

#[cfg(test)]
mod tests {
    use super::super::table::WORDS;
    use super::super::{Options, read};
    use super::*;

    #[test]
    fn a_plain_goto_is_three_or_six_numbers_and_nothing_else() {
        let three = Some(([1.0, -2.5, 0.25, 0.0, 0.0, 0.0], false));
        let six = Some(([1.0, 2.0, 3.0, 0.0, 0.5, -1.0], true));
        assert_eq!(plain_goto(b"GOTO/1,-2.5,.25"), three);
        assert_eq!(plain_goto(b"GOTO / 1.0, -2.5, .25  "), three);
        assert_eq!(plain_goto(b"GOTO/1,2,3,0,.5,-1."), six);
        for text in [
            "GOTO/1,2",
            "GOTO/1,2,3,4",
            "GOTO/1,,3",
            "GOTO/1,2,3,0,0,1,2",
            "GOTO/1,2,3$",
            "GOTO/1,2,3,$",
            "GOTO/1,2,3 $$ remark",
            "GOTO/1,2,x",
            "GOTO 1,2,3",
            "FROM/1,2,3",
            "GOTO/1 2,3,4",
        ] {
            assert_eq!(plain_goto(text.as_bytes()), None, "{text}");
        }
    }

    /// What may stand behind a word; what it does not take there is refused on both paths.
    const BODIES: [&str; 18] = [
        "",
        "/ON",
        "/OFF",
        "/1",
        "/2,MMPM",
        "/0,0,1",
        "/1,2,3",
        "/TOOL,2",
        "/LEFT",
        "/AAXIS,90",
        "/DRILL,DEPTH,5,MMPM,100,CLEAR,1",
        "/DRILL,5,MMPM,100,1",
        "/3,0,0,0,0,1,2",
        "/10,0.5",
        "/1,0,0,0,0,1,0,0,0,0,1,0",
        "/MILL",
        // Arcs to the next point; on the second lies the point behind that, too.
        "/1.5,0,0,0,0,1,0.5",
        "/1.5,1.5,0,0,0,1,1.5811388",
    ];

    const START: &str = "PARTNO/A\nUNITS/MM\nLOADTL/1\nSPINDL/1000,RPM,CLW\nFEDRAT/100,MMPM\nRAPID\nGOTO/0,0,5\nGOTO/0,0,0\n";

    /// What comes of a text: records and warnings, or errors.
    fn result(text: &str) -> String {
        match read("a.cls", text.as_bytes(), &Options::default()) {
            Ok(read) => {
                let warnings = read.warnings.iter().map(|found| (found.rule, found.line));
                format!("{:?} {:?}", read.program.records, warnings.collect::<Vec<_>>())
            }
            Err(found) => {
                let found = found.iter().map(|found| (found.rule, found.line));
                format!("{:?}", found.collect::<Vec<_>>())
            }
        }
    }

    /// What comes of it on the short path and past it; a blank before a comma leads past it.
    fn both_paths(text: &str) -> [String; 2] {
        let past: String = text
            .split_inclusive('\n')
            .map(|line| match line.starts_with("GOTO/") {
                true => line.replacen(',', " ,", 1),
                false => line.into(),
            })
            .collect();
        [result(text), result(&past)]
    }

    #[test]
    fn a_plain_goto_does_the_same_on_the_short_path_behind_every_word() {
        let end = "GOTO/2,0,0\nGOTO/2,3,0,0,0,1\nRAPID\nGOTO/2,3,5\nGOTO/4,0,0\nFINI\n";
        for (word, _) in WORDS {
            for body in BODIES {
                let text = format!("{START}GOTO/1,0,0\n{word}{body}\n{end}");
                let [short, past] = both_paths(&text);
                assert_eq!(short, past, "{text}");
            }
        }
    }

    /// Points that are far off, on lines of their own, with an axis that is none; a vector left out behind a tilted tool means Z to some
    /// systems. Each in straight cuts, by the habits of each system.
    #[test]
    fn a_plain_goto_does_the_same_on_the_short_path_wherever_it_goes() {
        let heads =
            ["", "CSI_SET_FLUTE_LENGTH/2.\n", "$$* Pro/CLfile  Version Creo\n", "$$ CATIA\n"];
        let points = [
            "GOTO/2,0,0\n3,1,0\n4,1,0\n",
            "FEDRAT/50,MMPM\nGOTO/2,0,0\n3,1,0\n",
            "GOTO/2,0,0,0,0,1\n3,1,0,0,0.6,0.8\n",
            "GOTO/1000001,0,0\n",
            "GOTO/0,-1000001,0\n",
            "GOTO/0,0,40000\n",
            "GOTO/1000000,0,0\n",
            "GOTO/2,0,0,0,0,0\n",
            "GOTO/2,0,0,0,0,1.5\n",
            "GOTO/2,0,0,0,0.6,0.8\n",
            "GOTO/2,0,0,0,0.6,0.8\nGOTO/3,0,0\n",
            "GOTO/2,0,0,0,0.6,0.8\nGOTO/3,0,0,0,0.6,0.8\n",
            "GOTO/2,0,0,0,0,1\nGOTO/3,0,0\n",
        ];
        let mut refused = 0;
        for head in heads {
            for units in [START.to_owned(), START.replace("UNITS/MM", "UNITS/INCHES")] {
                for [first, second] in points.iter().flat_map(|a| points.map(|b| [a, b])) {
                    let text =
                        format!("{head}{units}GOTO/1,0,0\n{first}{second}GOTO/5,0,0\nFINI\n");
                    let [short, past] = both_paths(&text);
                    assert_eq!(short, past, "{text}");
                    refused += usize::from(short.contains("OutOfRange"));
                }
            }
        }
        assert!(refused > 100, "{refused}");
    }

    /// Half circles one behind the other, each word between them, and points on the last circle, at its start and off it: what Creo means
    /// by those depends on the arc that was just cut.
    #[test]
    fn points_behind_arcs_of_creo_mean_the_same_on_the_short_path() {
        let first = "CIRCLE/0.5,0,0,0,0,1,0.5\nGOTO/1,0,0\n";
        let second = "CIRCLE/1.5,0,0,0,0,1,0.5\nGOTO/2,0,0\n";
        let ends =
            ["GOTO/1.5,0.5,0\n", "GOTO/1,0,0\n", "GOTO/2,3,0\n", "1.5,0.5,0\n", "1.7,0.4,0\n"];
        let mut read = 0;
        for (word, _) in WORDS {
            for body in ["", "/1", "/ON", "/0,0,1", "/100,MMPM", "/2,2,0", "/DRILL,5,MMPM,100,1"] {
                for (arcs, end) in [first, second]
                    .into_iter()
                    .flat_map(|last| ends.map(|end| (format!("{first}{last}"), end)))
                {
                    for between in [String::new(), format!("{word}{body}\n")] {
                        let text = format!(
                            "$$* Pro/CLfile  Version Creo\n{START}{arcs}{between}{end}{end}GOTO/4,0,0\nFINI\n"
                        );
                        let [short, past] = both_paths(&text);
                        assert_eq!(short, past, "{text}");
                        read += usize::from(short.contains("Line"));
                    }
                }
            }
        }
        assert!(read > 1000, "{read}");
        let behind = |end: &str| {
            result(&format!("$$* Pro/CLfile  Version Creo\n{START}{first}{second}{end}FINI\n"))
        };
        // A further point of the circle in a GOTO of its own is refused; in a line of its own the arc goes on to it.
        assert!(behind("GOTO/1.5,0.5,0\n").contains("ArcPoints"), "{}", behind("GOTO/1.5,0.5,0\n"));
        assert!(!behind("1.5,0.5,0\n").contains("ArcPoints"), "{}", behind("1.5,0.5,0\n"));
        // So is one behind a statement that moves nothing.
        assert!(
            behind("FEDRAT/50,MMPM\nGOTO/1.5,0.5,0\n").contains("ArcPoints"),
            "{}",
            behind("FEDRAT/50,MMPM\nGOTO/1.5,0.5,0\n")
        );
    }
}
