//! What the tool is and does besides moving: tool, feed, spindle, coolant, compensation, dwell, stop.

use super::report::{Fault, Outcome};
use super::statement::{Field, Statement};
use super::text::decode;
use super::{MaxRpm, Reader, Ready, SurfaceSpeed};
use geom::INCH;
use program::{Auxiliary, Compensation, Coolant, Feed, Op, PathMode, Record, Rule, Spindle, Tool};

/// The largest number of a tool or an offset.
const MAX_NUMBER: f64 = 99_999_999.0;

/// The unit of a feed, as its minor word says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FeedUnit {
    /// `MMPM`.
    MmPerMinute,
    /// `IPM`.
    InchPerMinute,
    /// `PERMIN`: units of the file a minute.
    PerMinute,
    /// `MMPR`.
    MmPerTurn,
    /// `IPR`.
    InchPerTurn,
    /// `PERREV`: units of the file a turn.
    PerTurn,
    /// `INVERS`: moves a minute.
    Inverse,
}

/// Minor words and the units they name.
const FEED_UNITS: [(&str, FeedUnit); 8] = [
    ("MMPM", FeedUnit::MmPerMinute),
    ("IPM", FeedUnit::InchPerMinute),
    ("PERMIN", FeedUnit::PerMinute),
    ("MMPR", FeedUnit::MmPerTurn),
    ("IPR", FeedUnit::InchPerTurn),
    ("PERREV", FeedUnit::PerTurn),
    ("INVERS", FeedUnit::Inverse),
    ("INVERSE", FeedUnit::Inverse),
];

impl FeedUnit {
    /// The unit that field `index` of `statement` names.
    pub(super) fn of(statement: &Statement, index: usize) -> Option<FeedUnit> {
        FEED_UNITS.iter().find(|(word, _)| statement.is(index, word)).map(|(_, unit)| *unit)
    }
}

/// A whole number from `least` on as a number of a tool or register.
fn whole(statement: &Statement, index: usize, least: f64, rule: Rule) -> Result<u32, Box<Fault>> {
    let value = statement.number(index, "a number")?;
    if value.fract() == 0.0 && (least..=MAX_NUMBER).contains(&value) {
        return Ok(value as u32);
    }
    let message = format!("{value} is not a whole number from {least} on");
    Err(Fault::new(rule, message).fields(index, 1))
}

/// Field after the word `word`, where the statement has that word.
fn after(statement: &Statement, word: &str) -> Option<usize> {
    (0..statement.fields.len()).find(|i| statement.is(*i, word)).map(|i| i + 1)
}

impl Reader {
    /// `FEDRAT/v`, `FEDRAT/v,unit`, `FEDRAT/unit,v`. Without a unit the last one holds; at the start,
    /// units of the file a minute.
    pub(super) fn fedrat(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[1, 2], "FEDRAT/value,MMPM")?;
        let number = usize::from(!matches!(statement.fields.first(), Some(Field::Number(_))));
        let value = statement.number(number, "the feed")?;
        if statement.fields.len() == 2 {
            self.feed_unit =
                FeedUnit::of(statement, 1 - number).ok_or_else(|| unknown_feed(1 - number))?;
        }
        let feed = self.feed_of(value, self.feed_unit).map_err(|fault| fault.fields(number, 1))?;
        self.feed = Some(feed);
        if value <= 0.0 {
            self.ready = Ready::No;
        }
        self.push(statement.line, Op::Feed(feed));
        Ok(())
    }

    /// `value` in `unit` as a feed. A feed of 0 is taken; it is an error at the first cut.
    pub(super) fn feed_of(&mut self, value: f64, unit: FeedUnit) -> Result<Feed, Box<Fault>> {
        if !(0.0..=1e9).contains(&value) {
            return Err(Fault::new(Rule::Feed, format!("{value:e} is no feed")));
        }
        if matches!(unit, FeedUnit::InchPerMinute | FeedUnit::InchPerTurn) && !self.unit_known {
            let message =
                "feeds in inches, but the file does not say in which unit its coordinates are";
            return Err(Fault::new(Rule::UnknownUnit, message).help("add UNITS/INCHES or UNITS/MM"));
        }
        Ok(match unit {
            FeedUnit::MmPerMinute => Feed::PerMinute(value),
            FeedUnit::InchPerMinute => Feed::PerMinute(value * INCH),
            FeedUnit::PerMinute => Feed::PerMinute(self.mm(value)),
            FeedUnit::MmPerTurn => Feed::PerTurn(value),
            FeedUnit::InchPerTurn => Feed::PerTurn(value * INCH),
            FeedUnit::PerTurn => Feed::PerTurn(self.mm(value)),
            FeedUnit::Inverse => Feed::InverseTime(value),
        })
    }

    /// `SPINDL/` with, in any order, a speed, `RPM`, `SFM` or `SMM`, `CLW` or `CCLW`, `MAXRPM,n` and
    /// `RANGE,n`; or `ON`, `OFF`. Surface speeds are resolved with the diameter of the tool. `MAXRPM` is
    /// "the maximum RPM to be reached during SFM motion" (Siemens NX, *SPINDL*); whether it holds for later surface speeds, which do not
    /// say it (the dialog of NX writes it "if and only if" its switch is on: `maxrpm_flag` of `UF_PATH_spindle_on_t`), no manual says, so
    /// that one which it would cap is refused.
    pub(super) fn spindl(&mut self, statement: &Statement) -> Outcome {
        let (mut speed, mut surface, mut left, mut max) = (None, None, None, None);
        let mut range = false;
        let mut i = 0;
        while i < statement.fields.len() {
            match statement.fields.get(i) {
                Some(Field::Number(value)) if speed.is_none() => speed = Some((i, *value)),
                _ if statement.is(i, "RPM") => surface = None,
                _ if statement.is(i, "SFM") => surface = Some(12.0 * INCH),
                _ if statement.is(i, "SMM") => surface = Some(1000.0),
                _ if statement.is(i, "CLW") => left = Some(false),
                _ if statement.is(i, "CCLW") => left = Some(true),
                _ if statement.is(i, "ON") => {}
                _ if statement.is(i, "OFF") => return self.turn(statement, Spindle::Off),
                _ if statement.is(i, "MAXRPM") => {
                    i += 1;
                    max = Some((i, statement.number(i, "the greatest speed")?));
                }
                _ if statement.is(i, "RANGE") => {
                    i += 1;
                    let gears = ["LOW", "MEDIUM", "HIGH"];
                    if !gears.iter().any(|gear| statement.is(i, gear)) {
                        statement.number(i, "the range")?;
                    }
                    range = true;
                }
                _ => {
                    return Err(Fault::new(Rule::Malformed, "this is not known of a spindle")
                        .help("write SPINDL/speed,RPM,CLW or SPINDL/OFF")
                        .fields(i, 1));
                }
            }
            i += 1;
        }
        if range {
            let help = "check that the control chooses the gear by the speed";
            let message = "the gear range of SPINDL is not passed on";
            self.report.warn(statement, Rule::SpindleRange, message, help);
            if statement.fields.len() == 2 {
                return Ok(());
            }
        }
        if let Some((field, max)) = max
            && (speed.is_none() || !(1.0..=1e7).contains(&max))
        {
            let message =
                "MAXRPM takes a speed greater than 0, in the statement of the surface speed";
            return Err(Fault::new(Rule::Spindle, message)
                .help("write SPINDL/SFM,speed,MAXRPM,greatest,CLW")
                .fields(field, 1));
        }
        if speed.is_none() && left.is_none() {
            return match self.last_spindle {
                Some(spindle) => self.turn(statement, spindle),
                None => Err(Fault::new(Rule::Malformed, "no speed has been given yet")
                    .help("write SPINDL/speed,RPM,CLW")),
            };
        }
        let was_left = matches!(self.last_spindle, Some(Spindle::CounterClockwise(_)));
        let left = left.unwrap_or(was_left);
        let rpm = match (speed, self.last_spindle) {
            (Some((field, value)), _) => {
                if !(0.0..=1e7).contains(&value) {
                    let message = format!("{value:e} is no spindle speed");
                    return Err(Fault::new(Rule::Spindle, message).fields(field, 1));
                }
                let line = statement.line;
                let max = max.map(|(_, speed)| MaxRpm { line, speed });
                self.max_rpm = max.or(self.max_rpm);
                let last = self.max_rpm;
                self.surface =
                    surface.map(|mm| SurfaceSpeed { line, speed: value * mm, max: last });
                match self.surface {
                    Some(surface) => {
                        self.on_the_tool(surface).map_err(|fault| fault.fields(field, 1))?
                    }
                    None => match max.filter(|max| value > max.speed) {
                        Some(MaxRpm { speed, .. }) => {
                            let message =
                                format!("a speed of {value} 1/min above its MAXRPM of {speed}");
                            return Err(Fault::new(Rule::Spindle, message)
                                .help("give the lower of the two as speed")
                                .fields(field, 1));
                        }
                        None => value,
                    },
                }
            }
            (None, Some(last)) => speed_of(last),
            (None, None) => return Err(Fault::new(Rule::Malformed, "a speed is missing")),
        };
        let spindle = match (rpm, left) {
            (0.0, _) => Spindle::Off,
            (rpm, false) => Spindle::Clockwise(rpm),
            (rpm, true) => Spindle::CounterClockwise(rpm),
        };
        self.turn(statement, spindle)
    }

    /// `surface` in 1/min, on the tool that is meant.
    fn on_the_tool(&self, surface: SurfaceSpeed) -> Result<f64, Box<Fault>> {
        // A description that no LOAD has taken yet is of the tool to come.
        let diameter = match self.tool_record {
            Some(_) => self.tool.diameter,
            None => self.next_tool.diameter.or(self.tool.diameter),
        };
        match diameter {
            Some(diameter) if diameter > 0.0 => surface.on(diameter),
            _ => Err(Fault::new(Rule::Spindle, "a surface speed needs the diameter of the tool")
                .help("add CUTTER/ or TLDATA/ before it, or give the speed in RPM")),
        }
    }

    /// Before the first motion with a tool: a surface speed that an earlier statement gave means another speed of the
    /// spindle on it.
    pub(super) fn settle_surface_speed(&mut self) -> Outcome {
        let (Some(surface), Some(index), Some(last)) =
            (self.surface, self.speed_due, self.last_spindle)
        else {
            return Ok(());
        };
        let Some(diameter) = self.tool.diameter.filter(|diameter| *diameter > 0.0) else {
            if self.spindle == Spindle::Off {
                // `SPINDL/ON` has no speed to go on with.
                self.last_spindle = None;
                return Ok(());
            }
            let message = format!(
                "the surface speed of line {} needs the diameter of tool {}",
                surface.line, self.tool.number
            );
            return Err(Fault::new(Rule::Spindle, message)
                .help("add CUTTER/ behind its LOAD, or give its speed in RPM"));
        };
        let (rpm, old) = (surface.on(diameter)?, speed_of(last));
        if rpm == old {
            return Ok(());
        }
        let turning = |spindle| match spindle {
            Spindle::Off => Spindle::Off,
            Spindle::Clockwise(_) => Spindle::Clockwise(rpm),
            Spindle::CounterClockwise(_) => Spindle::CounterClockwise(rpm),
        };
        (self.last_spindle, self.spindle) = (Some(turning(last)), turning(self.spindle));
        let mut said = false;
        for record in &mut self.program.records[index..] {
            if let Op::Spindle(spindle) = &mut record.op
                && speed_of(*spindle) == old
            {
                (*spindle, said) = (turning(*spindle), true);
            }
        }
        if !said && self.spindle != Spindle::Off {
            let record = Record { line: surface.line, op: Op::Spindle(self.spindle) };
            self.program.records.insert(index + 1, record);
        }
        Ok(())
    }

    fn turn(&mut self, statement: &Statement, spindle: Spindle) -> Outcome {
        if spindle != Spindle::Off {
            self.last_spindle = Some(spindle);
        }
        self.spindle = spindle;
        self.ready = Ready::No;
        self.push(statement.line, Op::Spindle(spindle));
        Ok(())
    }

    /// `COOLNT/FLOOD`, `MIST`, `THRU`, also with `ON`; `ON` alone, which is the last kind again;
    /// `OFF`.
    pub(super) fn coolnt(&mut self, statement: &Statement) -> Outcome {
        let kinds = [
            ("FLOOD", Coolant::Flood),
            ("TAPKUL", Coolant::Flood),
            ("MIST", Coolant::Mist),
            ("THRU", Coolant::Through),
            ("TOOL", Coolant::Through),
        ];
        let count = statement.count(&[1, 2], "COOLNT/FLOOD, MIST, THRU or OFF")?;
        let on = (0..count).find(|i| statement.is(*i, "ON"));
        let coolant = match on {
            Some(_) if count == 1 => self.last_coolant,
            None if count == 1 && statement.is(0, "OFF") => Coolant::Off,
            _ => {
                let field = usize::from(on == Some(0));
                let known = kinds.iter().find(|(word, _)| statement.is(field, word));
                // Two kinds, or OFF with one, are not one thing to do.
                let known = known.filter(|_| on.is_some() || count == 1);
                let (_, coolant) = known.ok_or_else(|| {
                    Fault::new(Rule::Malformed, "this coolant is not known")
                        .help("write COOLNT/ON, FLOOD, MIST, THRU or OFF")
                        .fields(field, 1)
                })?;
                *coolant
            }
        };
        if coolant != Coolant::Off {
            self.last_coolant = coolant;
        }
        self.push(statement.line, Op::Coolant(coolant));
        Ok(())
    }

    /// `CUTCOM/LEFT`, `RIGHT`, `ON`, `OFF`, with the register after it or after `ADJUST`, which may also
    /// come first (Siemens NX); a `GOTO` may follow in the same statement.
    pub(super) fn cutcom(&mut self, statement: &Statement) -> Outcome {
        let goto = after(statement, "GOTO");
        let own = goto.map_or(statement.fields.len(), |i| i - 1);
        let (mut side, mut register) = (None, None);
        for i in 0..own {
            match statement.fields.get(i) {
                Some(Field::Number(_)) if register.is_none() && i > 0 => {
                    register = Some(whole(statement, i, 0.0, Rule::Malformed)?);
                }
                _ if ["LEFT", "RIGHT", "OFF", "ON"].iter().any(|word| statement.is(i, word))
                    && side.is_none() =>
                {
                    side = Some(i);
                }
                _ if statement.is(i, "ADJUST") || statement.is(i, "OSETNO") => {
                    if !matches!(statement.fields.get(i + 1), Some(Field::Number(_))) {
                        return Err(no_register(i));
                    }
                }
                _ if statement.is(i, "XYPLAN") => {}
                _ => {
                    return Err(Fault::new(Rule::Malformed, "this is not known of a compensation")
                        .help("write CUTCOM/LEFT, CUTCOM/RIGHT or CUTCOM/OFF")
                        .fields(i, 1));
                }
            }
        }
        // Without a side ADJUST is an offset of the fixture in some systems.
        let side = side.ok_or_else(|| {
            Fault::new(Rule::Malformed, "a compensation is LEFT, RIGHT, ON or OFF")
                .help("write CUTCOM/LEFT,register, CUTCOM/RIGHT,register or CUTCOM/OFF")
        })?;
        let compensation = match () {
            () if statement.is(side, "LEFT") => Compensation::Left(register),
            () if statement.is(side, "RIGHT") => Compensation::Right(register),
            () if statement.is(side, "OFF") => Compensation::Off,
            () => self.last_side.ok_or_else(|| {
                Fault::new(Rule::Malformed, "CUTCOM/ON before any side was given")
                    .help("write CUTCOM/LEFT or CUTCOM/RIGHT")
                    .fields(side, 1)
            })?,
        };
        if compensation != Compensation::Off {
            self.last_side = Some(compensation);
        }
        self.push(statement.line, Op::Compensation(compensation));
        match goto {
            Some(first) => self.goto_from(statement, first),
            None => Ok(()),
        }
    }

    /// `LOAD/TOOL,n` with, in any order, `ADJUST,k` or `OSETNO,k` (register), `LENGTH,l` (gauge length)
    /// and `ZOFF,z` of Siemens NX; `LOADTL/n` and `LOADTL/n,k` of CATIA.
    pub(super) fn load(&mut self, statement: &Statement) -> Outcome {
        let first = usize::from(statement.major.eq_ignore_ascii_case(b"LOAD"));
        if first == 1 && !statement.is(0, "TOOL") {
            return Err(Fault::new(Rule::Unsupported, "only tools can be loaded").fields(0, 1));
        }
        let mut tool = std::mem::take(&mut self.next_tool);
        tool.number = whole(statement, first, 1.0, Rule::ToolNumber)?;
        let mut i = first + 1;
        if let Some(Field::Number(_)) = statement.fields.get(i) {
            tool.offset = Some(whole(statement, i, 0.0, Rule::Malformed)?);
            i += 1;
        }
        while i < statement.fields.len() {
            match () {
                () if statement.is(i, "ADJUST") || statement.is(i, "OSETNO") => {
                    tool.offset = Some(whole(statement, i + 1, 0.0, Rule::Malformed)?);
                }
                () if statement.is(i, "LENGTH") => {
                    let length = statement.number(i + 1, "the length")?;
                    tool.length = Some(self.length(length)?);
                }
                // Whether the shift is in the register already is known at the machine only.
                () if statement.is(i, "ZOFF") => {
                    if statement.number(i + 1, "the offset")? != 0.0 {
                        let help = "check that the register of the tool length has it";
                        let message = "the Z offset of LOAD/TOOL is not passed on";
                        self.report.warn(statement, Rule::ToolOffset, message, help);
                    }
                }
                () => {
                    return Err(Fault::new(Rule::Malformed, "this is not known of a tool change")
                        .help("write LOAD/TOOL,number,ADJUST,register")
                        .fields(i, 1));
                }
            }
            i += 2;
        }
        self.no_pending_circle()?;
        if let Some(cycle) = &self.cycle {
            // The next GOTO would be a hole of the new tool.
            let message =
                format!("the hole cycle of line {} is still on at the tool change", cycle.line());
            return Err(
                Fault::new(Rule::CycleOn, message).help("add CYCLE/OFF behind the last hole")
            );
        }
        if let Some(early) = self.early.take() {
            if early.diameter.is_some() && early.diameter != tool.diameter {
                let message = format!(
                    "line {} moves with a tool of another diameter, which is not loaded",
                    early.line
                );
                return Err(Fault::new(Rule::ToolNumber, message)
                    .help("add LOAD/TOOL,n before the first motion"));
            }
            self.change_tool_at(early.records, statement.line, tool);
            return Ok(());
        }
        self.change_tool(statement.line, tool);
        Ok(())
    }

    /// Changes to `tool`. Until the next motion its description may still be completed.
    pub(super) fn change_tool(&mut self, line: u32, tool: Tool) {
        self.change_tool_at(self.program.records.len(), line, tool);
    }

    /// As [`Reader::change_tool`], before the record with number `index`.
    fn change_tool_at(&mut self, index: usize, line: u32, tool: Tool) {
        self.tool = tool.clone();
        (self.tool_record, self.speed_due) = (Some(index), Some(index));
        self.ready = Ready::No;
        self.program.records.insert(index, Record { line, op: Op::Tool(Box::new(tool)) });
    }

    /// `SELECT/TOOL,n`, `SELCTL/n`: the tool to come.
    pub(super) fn select(&mut self, statement: &Statement) -> Outcome {
        let first = usize::from(statement.major.eq_ignore_ascii_case(b"SELECT"));
        if first == 1 && !statement.is(0, "TOOL") {
            let help = "only SELECT/TOOL is passed on";
            self.report.warn(
                statement,
                Rule::IgnoredWord,
                "SELECT of another thing is ignored",
                help,
            );
            return Ok(());
        }
        let number = whole(statement, first, 1.0, Rule::ToolNumber)?;
        self.push(statement.line, Op::Preselect(number));
        Ok(())
    }

    /// Describes the tool: the one loaded last where it has not moved since, else the next.
    pub(super) fn describe_tool(
        &mut self,
        statement: &Statement,
        describe: impl FnOnce(&mut Tool),
    ) {
        let Some(index) = self.tool_record else {
            (self.next_line, self.ready) = (statement.line, Ready::No);
            return describe(&mut self.next_tool);
        };
        describe(&mut self.tool);
        if let Some(Op::Tool(tool)) = self.program.records.get_mut(index).map(|r| &mut r.op) {
            **tool = self.tool.clone();
        }
    }

    /// `CUTTER/d,r,e,f,a,b,h`: diameter and corner radius (ISO 4343); the rest of its seven values
    /// says the same in other words, and the height of the cutter, which is not a gauge length.
    pub(super) fn cutter(&mut self, statement: &Statement) -> Outcome {
        let diameter = self.diameter(statement, 0)?;
        let radius = match statement.fields.get(1) {
            Some(Field::Number(_)) => Some(self.length(statement.number(1, "the corner radius")?)?),
            _ => None,
        };
        // SolidWorks CAM writes the name of the tool just before.
        let name = match self.program.records.last().map(|r| &r.op) {
            Some(Op::Comment(text)) if self.inserted == Some(self.program.records.len()) => {
                Some(String::from(text.as_ref()))
            }
            _ => None,
        };
        if name.is_some() {
            self.program.records.pop();
        }
        let angle = match statement.fields.get(4) {
            Some(Field::Number(angle)) if *angle > 0.0 => Some(180.0 - 2.0 * angle),
            _ => None,
        };
        let tapered = leans(statement, 4) || leans(statement, 5);
        self.describe_tool(statement, |tool| {
            tool.diameter = Some(diameter);
            tool.corner_radius = radius;
            tool.tapered = tapered;
            if let Some(name) = name {
                tool.name = name;
            }
        });
        self.point_angle = angle;
        Ok(())
    }

    /// `TLDATA/MILL,d,r,length,taper,tip`, `TLDATA/DRILL,MILL,d,r,length,point angle,...`.
    pub(super) fn tldata(&mut self, statement: &Statement) -> Outcome {
        let is_word = |field: &&Field| matches!(field, Field::Word(..));
        let first = statement.fields.iter().take_while(is_word).count();
        let diameter = self.diameter(statement, first)?;
        let radius = match statement.fields.get(first + 1) {
            Some(Field::Number(_)) => {
                Some(self.length(statement.number(first + 1, "the corner radius")?)?)
            }
            _ => None,
        };
        let angle = match statement.fields.get(first + 3) {
            Some(Field::Number(angle)) if statement.is(0, "DRILL") => Some(*angle),
            _ => None,
        };
        // It belongs to the operation that has just begun, never to a tool loaded before it.
        (self.next_line, self.ready) = (statement.line, Ready::No);
        self.next_tool.diameter = Some(diameter);
        self.next_tool.corner_radius = radius;
        self.next_tool.tapered =
            statement.is(0, "DRILL") || leans(statement, first + 3) || leans(statement, first + 4);
        self.point_angle = angle;
        self.tool_record = None;
        Ok(())
    }

    /// A diameter in mm, at field `index`.
    pub(super) fn diameter(&self, statement: &Statement, index: usize) -> Result<f64, Box<Fault>> {
        let value = statement.number(index, "the diameter")?;
        let diameter = self.length(value).map_err(|fault| fault.fields(index, 1))?;
        if diameter >= 0.0 {
            return Ok(diameter);
        }
        Err(Fault::new(Rule::Malformed, "a diameter cannot be negative").fields(index, 1))
    }

    /// `TPRINT/text`: the name of the tool.
    pub(super) fn tprint(&mut self, statement: &Statement) -> Outcome {
        let name = decode(statement.body.0);
        self.describe_tool(statement, |tool| tool.name = name);
        Ok(())
    }

    /// `INTOL/t`, `OUTTOL/t`, `TOLER/t`: how far the path may lie inside and outside of the part; `TOLER` is both together. With
    /// one for each surface the least holds.
    pub(super) fn tolerance(&mut self, statement: &Statement) -> Outcome {
        if let Some(i) = statement.fields.iter().position(|field| matches!(field, Field::Word(..)))
        {
            return Err(Fault::new(Rule::Malformed, "a tolerance is a number").fields(i, 1));
        }
        let given = statement.fields.iter().filter_map(|field| match field {
            Field::Number(value) => Some(*value),
            Field::Word(..) | Field::Blank => None,
        });
        let Some(least) = given.reduce(f64::min) else { return Ok(()) };
        if least < 0.0 {
            return Err(Fault::new(Rule::Malformed, "a tolerance has no sign"));
        }
        match () {
            () if statement.major.eq_ignore_ascii_case(b"INTOL") => self.tolerances[0] = least,
            () if statement.major.eq_ignore_ascii_case(b"OUTTOL") => self.tolerances[1] = least,
            () => self.tolerances = [0.0, least],
        }
        (self.says_tolerance, self.ready) = (false, Ready::No);
        Ok(())
    }

    /// Before the next motion: how far the path may be left. Where both are 0 that is no tolerance to go by, and the machine's holds.
    pub(super) fn say_tolerance(&mut self, line: u32) {
        if std::mem::replace(&mut self.says_tolerance, true) {
            return;
        }
        let tolerance = self.mm(self.tolerances.iter().sum());
        if std::mem::replace(&mut self.said_tolerance, tolerance) != tolerance {
            let mode = if tolerance > 0.0 { PathMode::Blend(tolerance) } else { PathMode::AsSetUp };
            self.push(line, Op::PathMode(mode));
        }
    }

    /// `DELAY/t`, `DELAY/t,SEC`, `DELAY/n,REV`, and the other way round: dwell in seconds or turns of
    /// the spindle.
    pub(super) fn delay(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[1, 2], "DELAY/seconds or DELAY/turns,REV")?;
        let number = usize::from(!matches!(statement.fields.first(), Some(Field::Number(_))));
        let turns = statement.is(1 - number, "REV");
        if statement.fields.len() == 2 && !turns && !statement.is(1 - number, "SEC") {
            return Err(Fault::new(Rule::Malformed, "a dwell is in seconds, or in REV")
                .fields(1 - number, 1));
        }
        let value = statement.number(number, "the dwell")?;
        if turns {
            self.settle_surface_speed()?;
        }
        let seconds = self.dwell(value, turns).map_err(|fault| fault.fields(number, 1))?;
        self.push(statement.line, Op::Dwell(seconds));
        Ok(())
    }

    /// A dwell in seconds, given so or in turns of the spindle.
    pub(super) fn dwell(&self, value: f64, turns: bool) -> Result<f64, Box<Fault>> {
        is_dwell(value)?;
        match speed_of(self.spindle) {
            _ if !turns => Ok(value),
            rpm if rpm > 0.0 => Ok(value * 60.0 / rpm),
            _ => Err(Fault::new(Rule::Dwell, "a dwell in turns needs a running spindle")
                .help("add SPINDL/speed,RPM,CLW before it, or give the dwell in seconds")),
        }
    }

    /// `AUXFUN/n`: a function that the builder of the machine has added, by the number of its M function.
    pub(super) fn auxfun(&mut self, statement: &Statement) -> Outcome {
        statement.count(&[1], "AUXFUN/number")?;
        let number = whole(statement, 0, 0.0, Rule::Malformed)?;
        self.push(statement.line, Op::Auxiliary(Auxiliary::of(number)));
        Ok(())
    }

    /// `STOP`.
    pub(super) fn stop(&mut self, statement: &Statement) -> Outcome {
        self.push(statement.line, Op::Stop);
        Ok(())
    }

    /// `OPSTOP`.
    pub(super) fn opstop(&mut self, statement: &Statement) -> Outcome {
        self.push(statement.line, Op::OptionalStop);
        Ok(())
    }
}

#[cold]
fn no_register(field: usize) -> Box<Fault> {
    Fault::new(Rule::Malformed, "the number of a register is missing here")
        .help("write CUTCOM/LEFT,ADJUST,register")
        .fields(field, 1)
}

/// Whether `value` can be a dwell, in seconds or turns: at most a day, not before now.
pub(super) fn is_dwell(value: f64) -> Outcome {
    if (0.0..=86_400.0).contains(&value) {
        return Ok(());
    }
    Err(Fault::new(Rule::Dwell, format!("{value:e} is no dwell")).help("give seconds, 0 or more"))
}

/// Speed of a spindle in 1/min; 0 where it stands.
pub(super) fn speed_of(spindle: Spindle) -> f64 {
    match spindle {
        Spindle::Off => 0.0,
        Spindle::Clockwise(rpm) | Spindle::CounterClockwise(rpm) => rpm,
    }
}

fn unknown_feed(field: usize) -> Box<Fault> {
    Fault::new(Rule::UnknownUnit, "this unit of a feed is not known")
        .help("units are MMPM, IPM, PERMIN, MMPR, IPR, PERREV and INVERS")
        .fields(field, 1)
}

/// Whether the angle in field `index` is there and not 0.
fn leans(statement: &Statement, index: usize) -> bool {
    matches!(statement.fields.get(index), Some(Field::Number(angle)) if *angle != 0.0)
}
