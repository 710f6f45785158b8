//! HEIDENHAIN Klartext (TNC 640, iTNC 530).
//!
//! A program is a list of numbered blocks between `BEGIN PGM` and `END PGM`; a line that ends in `~`
//! goes on in the next one. What a block means, in which order its parts act, and where that is
//! written is told in `docs/controls/klartext.md`.

mod cycle;
mod functions;
mod motion;
mod plane;
mod scan;
mod state;
mod words;

use crate::Settings;
use crate::compensation::Compensator;
use cycle::{Open, cycle_number};
use functions::{Function, When};
use geom::Vec3;
use program::{Compensation, Diagnostic, Op, Spindle, Tool};
use scan::{Lines, Result, Scanner};
use state::{Control, Tip};
use words::{LINEAR, Words, feed_word};

/// Runs a program.
pub(crate) fn run(settings: &Settings, text: &[u8], path: &mut Compensator) -> Result<()> {
    let mut lines = Lines::new(text);
    let Some(mut first) = lines.next() else {
        return Err(Diagnostic::error("program-frame", "the program is empty")
            .at(1, text, 0, 0)
            .into());
    };
    let (name, unit) = begin(&mut first)?;
    let mut program = Run {
        control: Control::new(settings, path, unit),
        name,
        next: 1,
        open: Continued::Nothing,
        part: None,
        blank: None,
        closed: false,
    };
    let mut last = first;
    for line in lines {
        last = line;
        program.line(line)?;
    }
    program.finish(&last)
}

/// `0 BEGIN PGM NAME MM`: the name, and mm in the unit of length.
fn begin<'t>(s: &mut Scanner<'t>) -> Result<(&'t [u8], f64)> {
    block_number(s, 0)?;
    s.expect(b"BEGIN")?;
    s.expect(b"PGM")?;
    let (name, _) = s.token();
    let unit = match s.token() {
        (b"MM", _) => 1.0,
        (b"INCH", _) => 25.4,
        (_, span) => {
            return Err(s.error("program-frame", span, "BEGIN PGM needs a name, then MM or INCH"));
        }
    };
    s.finish()?;
    Ok((name, unit))
}

/// The number at the start of a block, which counts the blocks.
fn block_number(s: &mut Scanner, expected: u32) -> Result<()> {
    let (token, span) = s.token();
    let number = std::str::from_utf8(token).ok().and_then(|text| text.parse::<u32>().ok());
    if number == Some(expected) && token.first() != Some(&b'+') {
        s.begin_block();
        return Ok(());
    }
    let message = format!("block number {expected} is expected here");
    Err(s.error("block-number", span, message))
}

/// What the next line goes on with.
enum Continued {
    Nothing,
    Comment,
    Cycle(Open),
}

/// A program on its way through the control.
struct Run<'t, 'a, 's> {
    control: Control<'a, 's>,
    name: &'t [u8],
    /// Number of the next block.
    next: u32,
    open: Continued,
    /// Number and next part of an older cycle (`7.0`, `7.1` ...) that is being defined.
    part: Option<(u32, u32)>,
    /// The first blank line; only the end of the file may follow it.
    blank: Option<Scanner<'t>>,
    /// Whether `END PGM` is read.
    closed: bool,
}

impl<'t> Run<'t, '_, '_> {
    fn line(&mut self, mut s: Scanner<'t>) -> Result<()> {
        if s.rest().is_empty() {
            self.blank.get_or_insert(s);
            return Ok(());
        }
        if let Some(blank) = &self.blank {
            return Err(blank.error_block("syntax", "a line without a block"));
        }
        if self.closed {
            return Err(s.error_block("program-frame", "nothing may follow END PGM"));
        }
        let continued = s.take_continuation();
        match std::mem::replace(&mut self.open, Continued::Nothing) {
            Continued::Nothing => {
                block_number(&mut s, self.next)?;
                self.next = self.next.saturating_add(1);
                self.control.at_line(s.line);
                self.block(&mut s, continued)
            }
            Continued::Comment => self.comment(&s, continued),
            Continued::Cycle(mut open) => {
                self.control.cycle_parameter(&mut s, &mut open)?;
                if continued {
                    self.open = Continued::Cycle(open);
                    return Ok(());
                }
                self.control.close_cycle(&s, &open)
            }
        }
    }

    /// The end of the file.
    fn finish(&self, last: &Scanner) -> Result<()> {
        if self.closed {
            return Ok(());
        }
        Err(last.error_block("program-frame", "the program ends without END PGM"))
    }

    /// One block, from behind its number.
    fn block(&mut self, s: &mut Scanner<'t>, continued: bool) -> Result<()> {
        let part = self.part.take();
        if s.is_done() {
            return self.comment(s, continued);
        }
        let start = *s;
        let (keyword, span) = s.token();
        if keyword == b"*" {
            return self.comment(s, continued);
        }
        if keyword == b"CYCL" && s.take(b"DEF") {
            return self.cycle_definition(s, part, continued);
        }
        if let Some((cycle, 1)) = part {
            let message = format!("cycle {cycle} is not complete: CYCL DEF {cycle}.1 is expected");
            return Err(s.error_block("cycle-parameter", message));
        }
        if continued {
            return Err(s.error_block("unsupported", "this block cannot go on in the next line"));
        }
        if keyword == b"END" {
            return self.end(s);
        }
        if self.control.ended {
            let message = "a block after the end of the program (M2, M30) never runs";
            return Err(s.error_block("program-frame", message));
        }
        let control = &mut self.control;
        match keyword {
            b"L" => control.line(s),
            b"C" => control.arc(s),
            b"CC" => control.circle_center(s),
            b"CR" => control.arc_of_radius(s),
            b"CP" => control.polar_arc(s),
            b"LP" => control.polar_line(s),
            b"LN" => control.vector_line(s),
            b"TOOL" => tool(control, s),
            b"CYCL" => {
                s.expect(b"CALL")?;
                control.cycle_call(s)
            }
            b"PLANE" => control.plane(s),
            b"FUNCTION" => control.function_block(s),
            b"BLK" => blank_form(control, s),
            b"STOP" => {
                let words = Words::read(s, 0, control)?;
                control.functions(s, words.functions, When::Start)?;
                control.functions(s, words.functions, When::End)?;
                let mut stop = functions::Functions::default();
                let _ = stop.push(Function::Stop);
                control.functions(s, stop, When::End)
            }
            [b'M', b'0'..=b'9', ..] => {
                *s = start;
                control.line(s)
            }
            _ => Err(not_understood(s, keyword, span)),
        }
    }

    /// A comment, from where the scanner stands; the words behind `;` or `*`.
    fn comment(&mut self, s: &Scanner, continued: bool) -> Result<()> {
        if s.rest().is_empty() {
            return Err(s.error_block("syntax", "the block is empty"));
        }
        let text = s.rest();
        let text = text.strip_prefix(b";").unwrap_or(text).trim_ascii_start();
        let text = String::from_utf8_lossy(text);
        // What stands behind M30 never comes to the operator.
        if !self.control.ended {
            self.control.at_line(s.line);
            self.control.emit(Op::Comment(text.into()))?;
        }
        if continued {
            self.open = Continued::Comment;
        }
        Ok(())
    }

    /// `END PGM NAME MM`.
    fn end(&mut self, s: &mut Scanner) -> Result<()> {
        s.expect(b"PGM")?;
        let (name, span) = s.token();
        if name != self.name {
            return Err(s.error("program-frame", span, "END PGM names another program"));
        }
        s.expect(if self.control.unit == 1.0 { b"MM" } else { b"INCH" })?;
        s.finish()?;
        self.closed = true;
        if self.control.ended { Ok(()) } else { self.control.end() }
    }

    /// `CYCL DEF`, from behind it.
    fn cycle_definition(
        &mut self,
        s: &mut Scanner,
        part: Option<(u32, u32)>,
        continued: bool,
    ) -> Result<()> {
        if self.control.ended {
            let message = "a block after the end of the program (M2, M30) never runs";
            return Err(s.error_block("program-frame", message));
        }
        let (token, span) = s.token();
        let Some((cycle, sub)) = cycle_number(token) else {
            return Err(s.error("syntax", span, "the number of a cycle is expected here"));
        };
        let Some(sub) = sub else {
            let open = self.control.open_cycle(s, cycle, span)?;
            if !continued {
                let message = "the parameters of the cycle are missing";
                let help = "end the line with ~ and give one parameter a line";
                return Err(s.error_block("cycle-parameter", message).help(help).into());
            }
            self.open = Continued::Cycle(open);
            return Ok(());
        };
        if continued {
            return Err(s.error_block("unsupported", "this block cannot go on in the next line"));
        }
        match (cycle, sub, part) {
            (7 | 9 | 32, 0, _) => {}
            (19, _, _) => {
                let message = "cycle 19 means axis or spatial angles as the machine is set";
                return Err(s.error("unsupported", span, message).help("use PLANE SPATIAL").into());
            }
            (_, _, Some((open, next))) if open == cycle && next == sub => {
                self.control.cycle_part(s, cycle, sub)?;
            }
            (7 | 9 | 32, _, _) => {
                let message =
                    format!("the parts of cycle {cycle} stand one after the other from {cycle}.0");
                return Err(s.error("cycle-parameter", span, message));
            }
            _ => return Err(s.error("unsupported", span, "this cycle is not supported yet")),
        }
        self.part = Some((cycle, sub.saturating_add(1)));
        Ok(())
    }
}

/// `TOOL CALL` and `TOOL DEF`, from behind `TOOL`.
fn tool(control: &mut Control, s: &mut Scanner) -> Result<()> {
    if s.take(b"DEF") {
        let number = tool_number(s)?;
        s.finish()?;
        return control.emit(Op::Preselect(number));
    }
    s.expect(b"CALL")?;
    let called = match s.peek() {
        [b'"', ..] => Some(Tool { name: tool_name(s)?, ..Tool::default() }),
        [b'0'..=b'9', ..] => Some(Tool { number: tool_number(s)?, ..Tool::default() }),
        _ => None,
    };
    let (mut axis, mut speed, mut feed) = (false, None, None);
    loop {
        // The digit belongs to the address: `DR2+0.1`.
        let before = *s;
        if let Some(value) = s.peek().strip_prefix(b"DR2") {
            let (_, span) = s.token();
            if Scanner::within(before, span.1 - value.len(), span.1).value()? != 0.0 {
                return Err(oversize(s, span));
            }
            continue;
        }
        let Some(word) = s.word()? else { break };
        match (word.address, word.number) {
            (b"Z", None) if !axis && word.sign == 0.0 => axis = true,
            (b"X" | b"Y" | b"U" | b"V" | b"W", None) => {
                return Err(s.error("unsupported", word.span, "the tool axis must be Z"));
            }
            (b"S", Some(rpm)) if speed.is_none() && rpm >= 0.0 => speed = Some(rpm),
            (b"F" | b"FU", Some(_)) if feed.is_none() => feed = Some(feed_word(s, &word)?),
            (b"DL" | b"DR", Some(0.0)) => {}
            (b"DL" | b"DR", Some(_)) => return Err(oversize(s, word.span)),
            _ => return Err(words::unknown(s, &word)),
        }
    }
    if called.is_some() && !axis {
        return Err(s.error_block("missing-word", "TOOL CALL needs the tool axis Z"));
    }
    if called.is_none() && speed.is_none() && feed.is_none() {
        return Err(s.error_block("missing-word", "TOOL CALL needs a tool, S or F"));
    }
    control.tool_call(s, called, speed, feed)
}

fn oversize(s: &Scanner, span: (usize, usize)) -> Box<Diagnostic> {
    s.error("unsupported", span, "an oversize moves the tool off the programmed path")
        .help("put the wear into the tool table")
        .into()
}

fn tool_number(s: &mut Scanner) -> Result<u32> {
    let (token, span) = s.token();
    let text = std::str::from_utf8(token).unwrap_or_default();
    let digits = text.bytes().all(|b| b.is_ascii_digit());
    text.parse()
        .ok()
        .filter(|_| digits)
        .ok_or_else(|| s.error("tool", span, "the number of a tool is a whole number from 0"))
}

/// A tool's name between quotes; it may hold blanks.
fn tool_name(s: &mut Scanner) -> Result<String> {
    s.quoted().map(|name| String::from_utf8_lossy(name).into_owned())
}

/// `BLK FORM 0.1 Z X Y Z`, `BLK FORM 0.2 X Y Z`: the blank, for the screen alone.
fn blank_form(control: &Control, s: &mut Scanner) -> Result<()> {
    s.expect(b"FORM")?;
    match s.token() {
        (b"0.1", _) => s.expect(b"Z")?,
        (b"0.2", _) => {}
        (_, span) => {
            let message = "this kind of BLK FORM is not supported yet";
            return Err(s.error("unsupported", span, message));
        }
    }
    let words = Words::read(s, LINEAR, control)?;
    if words.has_all(LINEAR) && words.feed.is_none() && words.functions.is_empty() {
        return Ok(());
    }
    Err(s.error_block("missing-word", "BLK FORM takes X, Y and Z"))
}

/// What begins with a keyword that is not understood.
fn not_understood(s: &Scanner, keyword: &[u8], span: (usize, usize)) -> Box<Diagnostic> {
    let shown: String = String::from_utf8_lossy(keyword).chars().take(40).collect();
    let later = matches!(
        keyword,
        b"RND"
            | b"CHF"
            | b"APPR"
            | b"DEP"
            | b"CT"
            | b"CTP"
            | b"LBL"
            | b"CALL"
            | b"FN"
            | b"TRANS"
            | b"FL"
            | b"FLT"
            | b"FC"
            | b"FCT"
            | b"FPOL"
            | b"SEL"
            | b"PATTERN"
            | b"TCH"
            | b"POLARKIN"
            | b"DECLARE"
    ) || matches!(keyword, [b'Q', ..]);
    if later {
        let message = format!("{shown} is not supported yet");
        return s.error("unsupported", span, message);
    }
    s.error("unknown-block", span, format!("a block that begins with {shown} is not understood"))
}

impl Control<'_, '_> {
    /// A tool call: the change stops spindle and coolant.
    fn tool_call(
        &mut self,
        s: &Scanner,
        tool: Option<Tool>,
        speed: Option<f64>,
        feed: Option<words::FeedWord>,
    ) -> Result<()> {
        if let Some(tool) = tool {
            if self.compensation != Compensation::Off {
                return Err(s.error_block("compensation", "a tool is called with R0"));
            }
            if self.tip != Tip::Free {
                let message = "M128 is reset before a tool call";
                return Err(s
                    .error_block("tool-center", message)
                    .help("program M129 first")
                    .into());
            }
            self.stop_all()?;
            self.emit(Op::Tool(Box::new(tool)))?;
            // The change goes to a place of its own, and the new tool has another length.
            self.here = Vec3::NAN;
        }
        self.set_feed(s, feed)?;
        let Some(speed) = speed else { return Ok(()) };
        self.speed = Some(speed);
        match self.spindle {
            Spindle::Off => Ok(()),
            Spindle::Clockwise(_) => self.set_spindle(Spindle::Clockwise(speed)),
            Spindle::CounterClockwise(_) => self.set_spindle(Spindle::CounterClockwise(speed)),
        }
    }

    /// The end of the program.
    fn end(&mut self) -> Result<()> {
        self.stop_all()?;
        self.ended = true;
        self.emit(Op::End)
    }
}
