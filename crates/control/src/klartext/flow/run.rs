//! A program runs: its blocks in their order, jumps, subprograms, called programs.

use super::returns::Calls;
use super::source::{BlockLocation, Line, Source};
use crate::event::{Action, Risk};
use crate::kernel::Outcome;
use crate::klartext::execution::cycle::Designation;
use crate::klartext::execution::state::Control;
use crate::klartext::execution::state::older::parts_needed;
use crate::klartext::language::formula;
use crate::klartext::language::functions::{Function, Functions, When};
use crate::klartext::language::registers::Parameter;
use crate::klartext::language::scan::Scanner;
use crate::klartext::language::words::Words;
use program::{Diagnostic, Rule, encoding};

/// A program on its way through the control.
pub(crate) struct Run<'t, 'c, 'a, 's> {
    pub(super) control: &'c mut Control<'a, 's>,
    pub(super) source: Source<'t>,
    name: &'t [u8],
    pub(super) calls: Calls,
    /// Number and next part of an older cycle (`7.0`, `7.1` ...) that is being defined.
    part: Option<(u32, u32)>,
    /// Whether `END PGM` is read.
    closed: bool,
}

impl<'t, 'c, 'a, 's> Run<'t, 'c, 'a, 's> {
    /// Reads the first block, `0 BEGIN PGM NAME MM`. `file` is the name of a called file.
    pub(crate) fn begin(
        control: &'c mut Control<'a, 's>,
        file: &'t str,
        text: &'t [u8],
    ) -> Outcome<Self> {
        // A text may begin with the mark of its encoding.
        let text = encoding::without_mark(text);
        let mut source = Source::new(file, text, control.settings.setup.block_delete);
        let Some(Line { scanner: mut s, .. }) = source.next()? else {
            let empty = Scanner::new(file, 1, text);
            return Err(empty.error_block(Rule::ProgramFrame, "the program is empty"));
        };
        if !s.take(b"BEGIN") {
            let error = s.error_here(Rule::ProgramFrame, "a program begins with BEGIN PGM");
            return Err(error.help("take away what stands before it").into());
        }
        s.expect(b"PGM")?;
        let (name, _) = s.token();
        let unit = match s.token() {
            (b"MM", _) => 1.0,
            (b"INCH", _) => geom::INCH,
            (_, span) => {
                let message = "BEGIN PGM needs a name, then MM or INCH";
                return Err(s.error(Rule::ProgramFrame, span, message));
            }
        };
        s.finish()?;
        control.set_unit(unit);
        Ok(Run { control, source, name, calls: Calls::new(), part: None, closed: false })
    }

    /// Runs the program up to its `END PGM`.
    pub(crate) fn finish(mut self) -> Outcome {
        let mut last = self.source.place();
        // Behind M30 there are subprograms, which begin with a label.
        let mut subprograms = false;
        while !self.closed {
            let place = self.source.place();
            let Some(line) = self.source.next()? else {
                let message = "the program ends without END PGM";
                return Err(self.source.line_at(last).error_block(Rule::ProgramFrame, message));
            };
            last = place;
            if self.control.ended {
                self.unreached(line, &mut subprograms)?;
            } else {
                self.block(line, place)?;
            }
        }
        self.source.close()
    }

    /// A block behind the end of the program.
    fn unreached(&mut self, line: Line<'t>, subprograms: &mut bool) -> Outcome {
        let mut s = line.scanner;
        match s.peek() {
            b"END" => {
                s.expect(b"END")?;
                return self.end(&mut s);
            }
            b"LBL" => *subprograms = true,
            b"" | b"*" => {}
            _ if *subprograms => {}
            _ => {
                let message = "a block after the end of the program (M2, M30) never runs";
                return Err(s.error_block(Rule::ProgramFrame, message));
            }
        }
        let mut continued = line.continued;
        while continued {
            continued = self.source.continuation().is_some_and(|line| line.continued);
        }
        Ok(())
    }

    /// One block, from behind its number.
    fn block(&mut self, line: Line<'t>, place: BlockLocation) -> Outcome {
        let Line { mut scanner, continued } = line;
        let s = &mut scanner;
        let part = self.part.take();
        self.control.at_line(s.line);
        let (keyword, span) = s.token();
        if matches!(keyword, b"" | b"*") {
            self.part = part;
            return self.comment(line);
        }
        if keyword == b"CYCL" && s.take_symbol(b"DEF") {
            return self.cycle_definition(s, part, continued);
        }
        if let Some((cycle, next)) = part.filter(|(cycle, next)| *next <= parts_needed(*cycle)) {
            let message =
                format!("cycle {cycle} is not complete: CYCL DEF {cycle}.{next} is expected");
            return Err(s.error_block(Rule::CycleParameter, message));
        }
        if keyword == b"PATTERN" {
            self.control.contour_is_closed(s)?;
            return self.pattern_definition(s, continued);
        }
        if continued {
            let message = "this block cannot go on in the next line";
            return Err(refused(s, keyword, span)
                .unwrap_or_else(|| s.error_block(Rule::Unsupported, message)));
        }
        let control = &mut *self.control;
        let source = &self.source;
        match keyword {
            b"L" => control.line(s, source.corner_follows()),
            b"C" => control.arc(s, source.corner_follows()),
            b"CR" => control.arc_of_radius(s, source.corner_follows()),
            b"CT" => control.tangential_arc(s, source.corner_follows()),
            b"CP" => control.polar_arc(s, source.corner_follows()),
            b"CTP" => control.polar_tangential_arc(s, source.corner_follows()),
            b"LP" => control.polar_line(s, source.corner_follows()),
            b"CC" => control.circle_center(s),
            b"RND" => control.rounding(s),
            b"CHF" => control.chamfer(s),
            _ => {
                // Jumps and calculations change nothing at a corner that waits for its second side.
                let flow = matches!(keyword, b"LBL" | b"CALL" | [b'F', b'N', ..] | [b'Q', ..]);
                if !flow {
                    control.contour_is_closed(s)?;
                }
                self.other(s, line.scanner, keyword, span, place)
            }
        }
    }

    /// A block that is no part of a contour.
    fn other(
        &mut self,
        s: &mut Scanner<'t>,
        start: Scanner<'t>,
        keyword: &[u8],
        span: (usize, usize),
        place: BlockLocation,
    ) -> Outcome {
        let control = &mut *self.control;
        match keyword {
            b"LN" => control.vector_line(s),
            b"TOOL" => control.tool(s),
            b"CYCL" => {
                s.expect(b"CALL")?;
                control.cycle_call(s)
            }
            b"PLANE" => control.plane(s),
            b"FUNCTION" => control.function_block(s),
            b"TRANS" => control.transformation(s),
            b"APPR" => control.approach(s),
            b"DEP" => control.departure(s),
            b"BLK" => control.blank_form(s),
            b"STOP" => {
                let words = Words::read(s, 0, control)?;
                control.functions(s, words.functions, When::Start)?;
                control.functions(s, words.functions, When::End)?;
                control.functions(s, Functions::of(Function::ProgramStop), When::End)
            }
            b"LBL" => self.label(s),
            b"CALL" => self.call(s, place),
            [b'F', b'N'] | [b'F', b'N', b'0'..=b'9', ..] => {
                *s = start;
                s.take_symbol(b"FN");
                self.numbered_function(s)
            }
            b"DECLARE" => {
                s.expect(b"STRING")?;
                self.assignment(s)
            }
            b"END" => self.end(s),
            [b'M', b'0'..=b'9', ..] => {
                *s = start;
                control.line(s, false)
            }
            [b'Q', ..] => {
                *s = start;
                self.assignment(s)
            }
            _ => Err(refused(s, keyword, span).unwrap_or_else(|| {
                let shown: String = String::from_utf8_lossy(keyword).chars().take(40).collect();
                let message = format!("a block that begins with {shown} is not understood");
                s.error(Rule::UnknownBlock, span, message)
            })),
        }
    }

    /// A comment: the words behind `;` or `*`.
    fn comment(&mut self, line: Line<'t>) -> Outcome {
        if line.scanner.rest().is_empty() {
            return Err(line.scanner.error_block(Rule::Syntax, "the block is empty"));
        }
        let mut next = Some(line);
        while let Some(line) = next {
            let text = line.scanner.rest();
            let text = text.strip_prefix(b";").unwrap_or(text).trim_ascii_start();
            self.control.at_line(line.scanner.line);
            self.control.emit(Action::Comment(String::from_utf8_lossy(text).into()))?;
            next = if line.continued { self.source.continuation() } else { None };
        }
        Ok(())
    }

    /// `END PGM NAME MM`.
    fn end(&mut self, s: &mut Scanner) -> Outcome {
        s.expect(b"PGM")?;
        let (name, span) = s.token();
        if name != self.name {
            return Err(s.error(Rule::ProgramFrame, span, "END PGM names another program"));
        }
        s.expect(if self.control.unit == 1.0 { b"MM" } else { b"INCH" })?;
        s.finish()?;
        if self.calls.is_open() && !self.control.ended {
            return Err(s.error_block(
                Rule::Label,
                "the subprogram that runs has no end: LBL 0 is missing",
            ));
        }
        self.closed = true;
        if self.control.ended || self.control.is_called() { Ok(()) } else { self.control.end() }
    }

    /// `Q5 = 3 * Q2`, `QS1 = "A" || QS2`, from its first parameter.
    fn assignment(&mut self, s: &mut Scanner) -> Outcome {
        let (parameter, span) = target(s)?;
        let registers = &mut self.control.registers;
        let assigned = match parameter {
            Parameter::Text(index) => {
                let text = formula::text(s, registers)?;
                registers.assign_text(index, text)
            }
            _ => {
                let value = formula::formula(s, registers)?;
                registers.assign(parameter, value)
            }
        };
        assigned.map_err(|message| s.error(Rule::Parameter, span, message))?;
        self.tell_kept(parameter)
    }

    /// QR parameters are kept when the power is off.
    fn tell_kept(&mut self, parameter: Parameter) -> Outcome {
        match parameter {
            Parameter::Lasting(_) => self.control.emit(Action::Risk(Risk::KEPT_VARIABLE.into())),
            Parameter::Global(_) | Parameter::Local(_) | Parameter::Text(_) => Ok(()),
        }
    }

    /// `FN n: ...`, from behind `FN`.
    fn numbered_function(&mut self, s: &mut Scanner) -> Outcome {
        s.is_done();
        let from = *s;
        let number = s.digits(99)?;
        let span = (from.at(), s.at());
        if !s.take_symbol(b":") {
            return Err(s.error_here(Rule::Syntax, ": is expected here"));
        }
        match number {
            0..=8 | 13 | 18 => {
                if number == 18 {
                    s.expect(b"SYSREAD")?;
                }
                let (parameter, span) = target(s)?;
                let value = match number {
                    18 => {
                        self.control.contour_is_closed(s)?;
                        self.control.system_datum(s)?
                    }
                    _ => formula::calculated(s, number, &self.control.registers)?,
                };
                let assigned = self.control.registers.assign(parameter, value);
                assigned.map_err(|message| s.error(Rule::Parameter, span, message))?;
                self.tell_kept(parameter)
            }
            9..=12 => {
                let holds = formula::condition(s, number, &self.control.registers)?;
                s.expect(b"GOTO")?;
                s.expect(b"LBL")?;
                if !holds {
                    // The label of a jump that is not made need not be there.
                    s.skip();
                    return Ok(());
                }
                let to = self.labelled(s)?;
                s.finish()?;
                self.calls.jump(to);
                self.jump(s, to)
            }
            14 => {
                let shown = String::from_utf8_lossy(s.rest()).into_owned();
                let message = format!("the program stops itself here: FN 14: {shown}");
                Err(s.error_block(Rule::Alarm, message))
            }
            _ => {
                let message = match number {
                    15 | 16 | 38 => "writes to a file or a printer",
                    17 => "writes into the tables of the control",
                    19 | 20 | 29 => "talks to the PLC of the machine",
                    25 => "sets the preset where the tool stands",
                    26..=28 => "reads and writes tables of the control",
                    37 => "is for the cycles of the machine's builder",
                    _ => "is not supported",
                };
                Err(s.error(Rule::Unsupported, span, format!("FN {number} {message}")))
            }
        }
    }

    /// `CYCL DEF`, from behind it.
    fn cycle_definition(
        &mut self,
        s: &mut Scanner<'t>,
        part: Option<(u32, u32)>,
        continued: bool,
    ) -> Outcome {
        self.control.contour_is_closed(s)?;
        s.is_done();
        let from = s.at();
        let designation = Designation::read(s)?;
        let span = (from, s.at());
        let Designation { cycle, part: Some(sub) } = designation else {
            return self.cycle_parameters(s, designation.cycle, span, continued);
        };
        if continued {
            return Err(
                s.error_block(Rule::Unsupported, "this block cannot go on in the next line")
            );
        }
        match part {
            Some((open, next)) if open == cycle && next == sub => {
                self.control.cycle_part(s, cycle, sub)?;
            }
            _ if sub == 0 => self.control.begin_cycle_parts(s, cycle, span)?,
            _ => {
                let message =
                    format!("the parts of cycle {cycle} stand one after the other from {cycle}.0");
                return Err(s.error(Rule::CycleParameter, span, message));
            }
        }
        self.part = Some((cycle, sub.saturating_add(1)));
        Ok(())
    }

    /// A cycle with Q parameters: in its first line and the lines that follow.
    fn cycle_parameters(
        &mut self,
        s: &mut Scanner<'t>,
        cycle: u32,
        span: (usize, usize),
        mut continued: bool,
    ) -> Outcome {
        let mut open = self.control.open_cycle(s, cycle, span)?;
        let mut line = *s;
        self.control.cycle_line(&mut line, &mut open)?;
        while continued {
            let Some(next) = self.source.continuation() else { break };
            (line, continued) = (next.scanner, next.continued);
            self.control.cycle_line(&mut line, &mut open)?;
        }
        self.control.close_cycle(&line, open)
    }

    /// `PATTERN DEF`, from behind `PATTERN`: points in its line and the lines that follow.
    fn pattern_definition(&mut self, s: &mut Scanner<'t>, mut continued: bool) -> Outcome {
        s.expect(b"DEF")?;
        let mut pattern = Vec::new();
        let mut line = *s;
        loop {
            self.control.pattern_line(&mut line, &mut pattern)?;
            if !continued {
                return self.control.close_pattern(s, pattern);
            }
            let Some(next) = self.source.continuation() else {
                return self.control.close_pattern(s, pattern);
            };
            (line, continued) = (next.scanner, next.continued);
        }
    }
}

/// The parameter that a block assigns to, up to behind its `=`, and where it stands.
fn target(s: &mut Scanner) -> Outcome<(Parameter, (usize, usize))> {
    s.is_done();
    let from = s.at();
    let Some(parameter) = s.parameter()? else {
        return Err(s.error_here(Rule::Syntax, "a Q parameter is expected here"));
    };
    let span = (from, s.at());
    if !s.take_symbol(b"=") {
        return Err(s.error_here(Rule::Syntax, "= is expected here"));
    }
    Ok((parameter, span))
}

/// Why a block of the control that begins with a keyword is refused.
fn refused(s: &Scanner, keyword: &[u8], span: (usize, usize)) -> Option<Box<Diagnostic>> {
    let reason = match keyword {
        b"FL" | b"FLT" | b"FC" | b"FCT" | b"FPOL" | b"FSELECT" | b"FEND" => {
            "free contour programming leaves the choice of a solution to the control"
        }
        b"SEL" => "selects a table, a contour or a program of the control",
        b"TCH" => "touch probes measure what is not in the program",
        b"SPL" => "splines are not supported",
        b"POLARKIN" | b"PARAXCOMP" | b"PARAXMODE" => "changes the kinematics of the machine",
        b"GLOBAL" => "preset values of cycles are not supported",
        b"PGM" | b"PREDEF" | b"OPEN" | b"ERROR" | b"SQL" | b"TABDATA" | b"MONITORING"
        | b"SECTION" | b"PROGRAM" => "is not supported",
        _ => return None,
    };
    let shown = String::from_utf8_lossy(keyword);
    Some(s.error(Rule::Unsupported, span, format!("{shown}: {reason}")))
}
