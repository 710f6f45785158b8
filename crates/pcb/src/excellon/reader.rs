//! The lines of a drill file, obeyed one after the other.

use super::coordinate::{Notation, Unit, Zeros};
use super::evidence::Evidence;
use super::route::{by_center, by_radius};
use super::tools::Tools;
use super::words::{Word, lines, words};
use super::{Cut, Drill, Reading};
use crate::FAR;
use crate::HoleShape;
use crate::decimal::whole;
use crate::report::{Location, Outcome, Report, fault};
use geom::ending::go_on;
use geom::{Element, Vec2};
use program::{Diagnostic, Rule, encoding};

/// So many holes are more than any board has.
const MOST_CUTS: usize = 1_000_000;

/// What coordinates do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Drill,
    /// Routing, before a route starts.
    Position,
    Line,
    Clockwise,
    CounterClockwise,
}

/// What has been read, and what holds.
struct Reader<'a> {
    report: Report<'a>,
    location: Location,
    cuts: Vec<Cut>,
    tools: Tools,
    evidence: Evidence,
    notation: Notation,
    header: bool,
    incremental: bool,
    mode: Mode,
    /// Whether the tool is in the board.
    down: bool,
    point: Option<Vec2>,
    /// The route at work.
    route: Vec<Element>,
    ended: bool,
}

/// Reads a file; see [`super::read`].
pub(super) fn read(
    file_name: &str,
    text: &[u8],
    unit: Option<Unit>,
) -> Result<Reading, Vec<Diagnostic>> {
    let text = encoding::without_mark(text);
    let evidence = Evidence::of(text);
    let mut reader = Reader {
        report: Report::new(file_name, text),
        location: Location::default(),
        cuts: Vec::new(),
        tools: Tools::of_file(file_name),
        notation: Notation { unit: evidence.comments.unit.or(unit), ..evidence.comments },
        evidence,
        header: false,
        incremental: false,
        mode: Mode::Drill,
        down: false,
        point: Some(Vec2::ZERO),
        route: Vec::new(),
        ended: false,
    };
    for (line, start, text) in lines(text) {
        go_on();
        if text.is_empty() {
            continue;
        }
        reader.location = Location { line, start, end: start + text.len() };
        if let Err(fault) = reader.obey(text) {
            let hopeless = fault.rule == Rule::TooLarge;
            reader.report.error(reader.location, *fault);
            if hopeless || reader.report.is_full() {
                return Err(reader.report.errors);
            }
        }
    }
    reader.finish()
}

impl Reader<'_> {
    fn obey(&mut self, text: &[u8]) -> Outcome {
        if let Some(comment) = text.strip_prefix(b";") {
            self.tools.comment(comment.trim_ascii());
            return Ok(());
        }
        if self.ended {
            self.report.warn(
                self.location,
                Rule::AfterEnd,
                "lines after the end",
                "they are not read",
            );
            return Ok(());
        }
        match text {
            b"M48" => self.header = true,
            b"%" | b"M95" => self.header = false,
            _ if text.first() == Some(&b'/') => {
                if !self.header {
                    let help = "it depends on a switch of the machine: keep it or leave it out";
                    return Err(fault(Rule::BlockDelete, "a line that may be skipped", help));
                }
            }
            _ if UNITS.iter().any(|unit| text.starts_with(unit.as_bytes())) => self.unit(text)?,
            _ if text.starts_with(b"ICI") => self.incremental = !text.ends_with(b"OFF"),
            _ if text.starts_with(b"FMAT") => {
                if !matches!(text, b"FMAT,1" | b"FMAT,2") {
                    return Err(fault(Rule::Format, "FMAT is 1 or 2", "say FMAT,2"));
                }
            }
            _ if text.starts_with(b"VER") => {
                if text != b"VER,1" {
                    let help = "say VER,1: X to the right and Y away";
                    return Err(fault(Rule::Axes, "other directions of the axes", help));
                }
            }
            _ if self.header && !matches!(text.first(), Some(b'T' | b'M' | b'G')) => {
                let known = HEADER.iter().any(|word| text.starts_with(word.as_bytes()));
                if !known && !text.first().is_some_and(u8::is_ascii_digit) {
                    let help = "it is not known and not used";
                    self.report.warn(
                        self.location,
                        Rule::Header,
                        "a line of the header is not known",
                        help,
                    );
                }
            }
            b"TCST" | b"TCST,ON" | b"TCST,OFF" => {}
            _ => self.line(&words(text)?)?,
        }
        Ok(())
    }

    /// `INCH` or `METRIC`, with `LZ` or `TZ`, and the format by zeros: `000.000`.
    fn unit(&mut self, text: &[u8]) -> Outcome {
        let odd = || {
            let help = "it is such as METRIC,TZ or INCH,LZ,00.0000";
            fault(Rule::Unit, "not a unit with its zeros and its format", help)
        };
        for field in text.split(|c| *c == b',') {
            match field.trim_ascii() {
                b"INCH" | b"M72" => self.notation.unit = Some(Unit::Inch),
                b"METRIC" | b"M71" => self.notation.unit = Some(Unit::Metric),
                b"LZ" => self.notation.zeros = Some(Zeros::Leading),
                b"TZ" => self.notation.zeros = Some(Zeros::Trailing),
                places => {
                    let mut parts = places.split(|c| *c == b'.').map(|part| {
                        let zeros = part.iter().all(|c| *c == b'0');
                        (zeros && part.len() <= 6).then_some(part.len())
                    });
                    match (parts.next(), parts.next(), parts.next()) {
                        (Some(Some(before)), Some(Some(after)), None) => {
                            self.notation.places = Some((before, after));
                        }
                        _ => return Err(odd()),
                    }
                }
            }
        }
        Ok(())
    }

    fn line(&mut self, words: &[Word]) -> Outcome {
        if let [Word { letter: b'T', number }, parameters @ ..] = words {
            return self.tool(number, parameters);
        }
        let mut ends: [[Option<&[u8]>; 2]; 2] = [[None; 2]; 2];
        let mut center: [Option<&[u8]>; 2] = [None; 2];
        let (mut radius, mut repeats, mut slot) = (None, None, false);
        for word in words {
            match word.letter {
                letter @ (b'X' | b'Y') => {
                    let axis = usize::from(letter == b'Y');
                    ends[usize::from(slot)][axis] = Some(word.number);
                }
                b'I' => center[0] = Some(word.number),
                b'J' => center[1] = Some(word.number),
                b'A' => radius = Some(word.number),
                b'R' => {
                    let count = whole(word.number).filter(|count| *count > 0);
                    let help = "a repeat is such as R5X0.1: count and distances";
                    repeats = Some(
                        count.ok_or_else(|| fault(Rule::Repeat, "no count of repeats", help))?,
                    );
                }
                b'G' if whole(word.number) == Some(85) => slot = true,
                b'G' => self.general(word.number)?,
                b'M' => {
                    let pattern = ends[0] != [None; 2] || repeats.is_some();
                    self.machine(word.number, pattern || words.len() > 1)?;
                    if matches!(whole(word.number), Some(45 | 47)) {
                        return Ok(());
                    }
                }
                // Feeds, speeds, numbers of blocks, depths.
                b'F' | b'S' | b'B' | b'H' | b'N' | b'Z' => {}
                letter => {
                    let message = format!("there is no word {}", char::from(letter));
                    return Err(fault(
                        Rule::DataWord,
                        message,
                        "see docs/sources/excellon.md for what is read",
                    ));
                }
            }
        }
        if self.ended {
            return Ok(());
        }
        let [first, second] = ends;
        match repeats {
            Some(count) => self.repeat(count, first),
            None if slot => {
                let from = self.to(first)?;
                let to = self.to(second)?;
                self.cut(HoleShape::Slot(from, to))
            }
            None if first != [None; 2] => self.travel(first, center, radius),
            None => Ok(()),
        }
    }

    /// `T1` selects, `T1C0.5` defines and, in the body, selects too.
    fn tool(&mut self, number: &[u8], parameters: &[Word]) -> Outcome {
        let number = whole(number).ok_or_else(|| {
            fault(
                Rule::DataWord,
                "no number of a tool",
                "a tool is such as T1, or T1C0.5 in the header",
            )
        })?;
        if !self.header {
            self.lift();
        }
        let diameter = match parameters.iter().find(|word| word.letter == b'C') {
            None => None,
            Some(word) => {
                self.conclude_unit();
                Some(self.notation.length(word.number)?)
            }
        };
        if diameter.is_some() || self.header {
            self.tools.define(number, diameter)?;
        }
        if self.header { Ok(()) } else { self.tools.select(number) }
    }

    fn general(&mut self, code: &[u8]) -> Outcome {
        match whole(code) {
            Some(0) => {
                self.lift();
                self.mode = Mode::Position;
            }
            Some(1) => self.route_mode(Mode::Line)?,
            Some(2) => self.route_mode(Mode::Clockwise)?,
            Some(3) => self.route_mode(Mode::CounterClockwise)?,
            // G81 is how format 1 says it.
            Some(5 | 81) => {
                self.lift();
                self.mode = Mode::Drill;
            }
            // Dwell, feed and speed, no compensation.
            Some(4 | 7 | 40) => {}
            Some(90) => self.incremental = false,
            Some(91) => self.incremental = true,
            code => {
                let code = code.map_or("G without a number".into(), |code| format!("G{code:02}"));
                let help = "what is read are G00 to G05, G40, G81, G85, G90 and G91";
                return Err(fault(Rule::UnknownCommand, format!("{code} is not read"), help));
            }
        }
        Ok(())
    }

    fn route_mode(&mut self, mode: Mode) -> Outcome {
        if self.mode == Mode::Drill {
            let help = "G00 begins a route";
            return Err(fault(Rule::Route, "a route that was not begun", help));
        }
        self.mode = mode;
        Ok(())
    }

    fn machine(&mut self, code: &[u8], more: bool) -> Outcome {
        match whole(code) {
            Some(0 | 30) => self.end(),
            Some(2) if !more => self.end(),
            Some(14 | 15) => self.down = true,
            Some(16 | 17) => self.lift(),
            // Stops, messages, checks and pecks.
            Some(6 | 9 | 18 | 45 | 47 | 62 | 63) => {}
            Some(48) => self.header = true,
            Some(95) => self.header = false,
            Some(code @ (1 | 2 | 8 | 25 | 31 | 70 | 80 | 90)) => {
                let help = "write every hole by itself";
                return Err(fault(
                    Rule::Pattern,
                    format!("M{code:02}: patterns are not read"),
                    help,
                ));
            }
            code => {
                let code = code.map_or("M without a number".into(), |code| format!("M{code:02}"));
                let help =
                    "what is read are M00, M02, M06, M09, M14 to M18, M30, M48, M71, M72 and M95";
                return Err(fault(Rule::UnknownCommand, format!("{code} is not read"), help));
            }
        }
        Ok(())
    }

    fn end(&mut self) {
        self.lift();
        self.ended = true;
    }

    /// The tool leaves the board: the route at work is whole.
    fn lift(&mut self) {
        self.down = false;
        let route = std::mem::take(&mut self.route);
        // What was cut had a tool.
        if let (false, Ok(tool)) = (route.is_empty(), self.tools.selected()) {
            self.cuts.push(Cut { line: self.location.line, tool, path: HoleShape::Route(route) });
        }
    }

    fn travel(
        &mut self,
        end: [Option<&[u8]>; 2],
        center: [Option<&[u8]>; 2],
        radius: Option<&[u8]>,
    ) -> Outcome {
        let start = self.point;
        let end = self.to(end)?;
        let clockwise = self.mode == Mode::Clockwise;
        match self.mode {
            Mode::Drill => return self.cut(HoleShape::Round(end)),
            Mode::Position => return Ok(()),
            // The tool is over the board.
            _ if !self.down && self.evidence.plunges => return Ok(()),
            _ => {}
        }
        self.tools.selected()?;
        if !self.down {
            let help = "the route is cut: say M15 where it begins and M16 where it ends";
            self.report.warn(self.location, Rule::NoPlunge, "a route without M15", help);
        }
        let start = start.ok_or_else(no_point)?;
        let element = match self.mode {
            Mode::Clockwise | Mode::CounterClockwise => match radius {
                Some(radius) => {
                    by_radius(start, end, self.notation.coordinate(radius)?, clockwise)?
                }
                None if center == [None; 2] => {
                    let help = "give the radius with A, or the centre with I and J";
                    return Err(fault(Rule::Arc, "an arc without radius and centre", help));
                }
                None => {
                    let offset = |number: Option<&[u8]>| {
                        number.map_or(Ok(0.0), |number| self.notation.coordinate(number))
                    };
                    by_center(
                        start,
                        end,
                        Vec2::new(offset(center[0])?, offset(center[1])?),
                        clockwise,
                    )?
                }
            },
            _ => Element::line(start, end),
        };
        if self.route.len() + self.cuts.len() >= 2 * MOST_CUTS {
            return Err(too_large());
        }
        self.route.push(element);
        Ok(())
    }

    fn cut(&mut self, path: HoleShape) -> Outcome {
        let tool = self.tools.selected()?;
        if self.cuts.len() >= MOST_CUTS {
            return Err(too_large());
        }
        self.cuts.push(Cut { line: self.location.line, tool, path });
        Ok(())
    }

    /// So many more holes, each as far from the one before.
    fn repeat(&mut self, count: u32, distance: [Option<&[u8]>; 2]) -> Outcome {
        let last = self.point.filter(|_| self.mode == Mode::Drill).ok_or_else(|| {
            fault(Rule::Repeat, "a repeat of what is no hole", "repeat holes only")
        })?;
        if self.cuts.len().saturating_add(count as usize) > MOST_CUTS {
            return Err(too_large());
        }
        self.conclude();
        let along = |number: Option<&[u8]>| {
            number.map_or(Ok(0.0), |number| self.notation.coordinate(number))
        };
        let step = Vec2::new(along(distance[0])?, along(distance[1])?);
        for i in 1..=count {
            go_on();
            let at = last + step * f64::from(i);
            self.point = Some(at);
            if at.abs().max_element() > FAR {
                let message = format!("hole {i} of {count} is at X {} Y {} mm", at.x, at.y);
                return Err(fault(Rule::NotAPlace, message, "look at the count and the distance"));
            }
            self.cut(HoleShape::Round(at))?;
        }
        Ok(())
    }

    /// Where the coordinates lead; what is left out stays.
    fn to(&mut self, [x, y]: [Option<&[u8]>; 2]) -> Outcome<Vec2> {
        self.conclude();
        let last = self.point.take();
        let along = |number: Option<&[u8]>, last: Option<f64>| match (number, last) {
            (None, last) => last.ok_or_else(no_point),
            (Some(number), Some(last)) if self.incremental => {
                Ok(last + self.notation.coordinate(number)?)
            }
            (Some(_), None) if self.incremental => Err(no_point()),
            (Some(number), _) => self.notation.coordinate(number),
        };
        let to = Vec2::new(along(x, last.map(|p| p.x))?, along(y, last.map(|p| p.y))?);
        if to.abs().max_element() > FAR {
            let message = format!("X {} Y {} is not a place within {FAR} mm", to.x, to.y);
            return Err(fault(Rule::NotAPlace, message, "look at the distances"));
        }
        self.point = Some(to);
        Ok(to)
    }

    /// Before the first coordinate: what the file did not say, if there is evidence.
    fn conclude(&mut self) {
        self.conclude_unit();
        if self.notation.zeros.is_none()
            && let Some(zeros) = self.evidence.zeros()
        {
            self.notation.zeros = Some(zeros);
            let (name, message) = match zeros {
                Zeros::Leading => {
                    ("LZ", "short coordinates begin with zeros: those behind are left out")
                }
                Zeros::Trailing => {
                    ("TZ", "short coordinates end with zeros: those in front are left out")
                }
            };
            let help = format!("say {name} in the header, if that is right");
            self.report.warn(self.location, Rule::ZerosConcluded, message, &help);
        }
    }

    fn conclude_unit(&mut self) {
        if self.notation.unit.is_none()
            && let Some((unit, word)) = self.evidence.late_unit()
        {
            self.notation.unit = Some(unit);
            let message = format!(
                "{word} stands behind the first length: it is taken to hold for all of them"
            );
            let help = format!("write {word} in the header, above the tools, if that is right");
            self.report.warn(self.location, Rule::UnitConcluded, &message, &help);
        }
        if self.notation.unit.is_none()
            && let Some(unit) = self.evidence.unit()
        {
            self.notation.unit = Some(unit);
            let (name, message) = match unit {
                Unit::Inch => ("INCH", "the diameters can only be inches: so are the coordinates"),
                Unit::Metric => ("METRIC", "the diameters can only be mm: so are the coordinates"),
            };
            let help = format!("say {name} in the header, if that is right");
            self.report.warn(self.location, Rule::UnitConcluded, message, &help);
        }
    }

    fn finish(mut self) -> Result<Reading, Vec<Diagnostic>> {
        if !self.ended {
            let help = "the file may be cut off: write it again";
            let error = fault(Rule::NoEnd, "the file does not end with M30", help);
            self.report.error(self.location, *error);
        }
        match self.report.errors.is_empty() {
            true => {
                let drill = Drill { tools: self.tools.all, cuts: self.cuts };
                Ok(Reading { drill, warnings: self.report.warnings })
            }
            false => Err(self.report.errors),
        }
    }
}

/// What says the unit; behind it may stand which zeros are written, and the format.
const UNITS: [&str; 4] = ["INCH", "METRIC", "M71", "M72"];

/// Words of the header that say how the machine is set, not where holes are.
const HEADER: [&str; 32] = [
    "AFS", "ATC", "BLKD", "CCW", "CP", "DETECT", "DN", "DTMDIST", "EXDA", "FSB", "HPCK", "NCSL",
    "OM48", "OSTOP", "OTCLMP", "PCKPARAM", "PF", "PPR", "PVS", "R,C", "R,CP", "R,CR", "R,D", "R,H",
    "R,T", "SBK", "SG", "SIXM", "TCST", "UP", "N", "S",
];

#[cold]
fn no_point() -> crate::report::Fault {
    fault(Rule::NoPoint, "nothing says where this is", "give X and Y")
}

#[cold]
fn too_large() -> crate::report::Fault {
    let message = format!("more than {MOST_CUTS} holes");
    fault(Rule::TooLarge, message, "look at the counts of the repeats")
}
