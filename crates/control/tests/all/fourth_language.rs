//! A language of a robot's kind on top of the kernel alone: it costs its grammar. It has labels, variables, a loop,
//! subprograms, formulas by rank, and arcs by a point between their ends (the tests below show them).

use geom::Vec3;
use program::{Diagnostic, Rule};
use std::collections::HashMap;
use toolpost_control::kernel::expression::{Grammar, Next, Rank, Span, evaluate};
use toolpost_control::kernel::flow::{BlockLocation, Calls, Labels, Structures, line, lines};
use toolpost_control::kernel::source::Source;
use toolpost_control::kernel::{Channel, Outcome, arc, decimal};
use toolpost_control::{Action, ArcTo, Dialect, Event, Position, Settings, kernel};

/// A block, read from left to right.
struct Block<'t, 'v> {
    source: Source<'t>,
    at: usize,
    depth: usize,
    variables: &'v HashMap<String, f64>,
}

impl Block<'_, '_> {
    fn byte(&mut self) -> Option<u8> {
        let rest = self.source.text.get(self.at..)?;
        self.at += rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        self.source.text.get(self.at).copied()
    }

    fn take(&mut self, byte: u8) -> bool {
        let here = self.byte() == Some(byte);
        self.at += usize::from(here);
        here
    }

    fn name(&mut self) -> String {
        self.byte();
        let rest = &self.source.text[self.at..];
        let length = rest.iter().take_while(|byte| byte.is_ascii_alphanumeric()).count();
        self.at += length;
        String::from_utf8_lossy(&rest[..length]).into_owned()
    }

    fn wrong(&self, message: impl Into<String>) -> Box<Diagnostic> {
        self.source.error(Rule::Syntax, self.at..self.at + 1, message)
    }

    fn number(&mut self) -> Outcome<f64> {
        let value = evaluate(self)?;
        if value.is_finite() { Ok(value) } else { Err(self.wrong("the number is beyond all")) }
    }

    /// Takes points, each `X, Y, Z`, and then nothing may follow.
    fn points<const N: usize>(&mut self) -> Outcome<[Vec3; N]> {
        let mut points = [Vec3::ZERO; N];
        for index in 0..3 * N {
            if index > 0 && !self.take(b',') {
                return Err(self.wrong("a comma is missing"));
            }
            points[index / 3][index % 3] = self.number()?;
        }
        Ok(points)
    }

    fn ends(&mut self) -> Outcome {
        if self.byte().is_none() { Ok(()) } else { Err(self.wrong("nothing may follow here")) }
    }
}

impl Grammar for Block<'_, '_> {
    type Value = f64;
    type Operator = u8;
    type Error = Box<Diagnostic>;
    const DEEPEST: usize = 20;

    fn depth(&mut self) -> &mut usize {
        &mut self.depth
    }

    fn too_deep(&mut self) -> Box<Diagnostic> {
        self.wrong("brackets and signs nest too deep")
    }

    fn start(&mut self) -> usize {
        self.byte();
        self.at
    }

    fn end(&self) -> usize {
        self.at
    }

    fn operand(&mut self) -> Outcome<f64> {
        if self.take(b'-') {
            return self.nested(Self::operand).map(|value| -value);
        }
        if self.take(b'(') {
            let value = self.nested(evaluate)?;
            return if self.take(b')') { Ok(value) } else { Err(self.wrong(") is missing")) };
        }
        if let Some(number) = decimal::parse(&self.source.text[self.at..]) {
            self.at += number.len;
            return Ok(number.value);
        }
        let name = self.name();
        let value = self.variables.get(&name).copied();
        value.ok_or_else(|| self.wrong(format!("no block has set {name:?}")))
    }

    fn operator(&mut self) -> Option<Next<u8>> {
        let operator = self.byte()?;
        let rank = match operator {
            b'<' | b'>' => Rank::Left(0),
            b'+' | b'-' => Rank::Left(1),
            b'*' | b'/' => Rank::Left(2),
            _ => return None,
        };
        let at = self.at;
        self.at += 1;
        Some(Next { operator, rank, at })
    }

    fn apply(&mut self, operator: u8, [a, b]: [f64; 2], span: Span) -> Outcome<f64> {
        Ok(match operator {
            b'<' => f64::from(u8::from(a < b)),
            b'>' => f64::from(u8::from(a > b)),
            b'+' => a + b,
            b'-' => a - b,
            b'*' => a * b,
            _ if b == 0.0 => {
                return Err(self.source.error(
                    Rule::Arithmetic,
                    span.start..span.end,
                    "a division by 0",
                ));
            }
            _ => a / b,
        })
    }
}

/// A program on its way through the control.
struct Run<'t, 'c, 's> {
    text: &'t [u8],
    labels: Labels<String>,
    /// `WHILE` and `ENDWHILE`, `SUB` and `ENDSUB`.
    structures: Structures<&'static str>,
    variables: HashMap<String, f64>,
    calls: Calls<BlockLocation>,
    at: Vec3,
    channel: &'c mut Channel<'s>,
}

fn run(text: &[u8], channel: &mut Channel) -> Outcome {
    let (mut labels, mut structures) = (Labels::default(), Structures::default());
    for (place, after, block) in lines(text) {
        let variables = &HashMap::new();
        let source = Source { line: place.line, text: block };
        let mut block = Block { source, at: 0, depth: 0, variables };
        let (name, places) = (block.name(), [place, after]);
        if block.take(b':') {
            labels.add(name.clone(), place);
        }
        let (begins, ends) = match name.as_str() {
            "WHILE" => (true, "WHILE"),
            "SUB" => (true, "SUB"),
            "ENDWHILE" => (false, "WHILE"),
            "ENDSUB" => (false, "SUB"),
            _ => continue,
        };
        let begun = structures.unclosed().next_back().map(|[first, _]| structures[first].word);
        if !begins && begun != Some(ends) {
            return Err(
                source.block_error(Rule::ControlStructure, format!("no {ends} belongs to this"))
            );
        }
        if name == "SUB" {
            labels.add(block.name(), after);
        }
        _ = if begins { Some(structures.open(ends, places)) } else { structures.close("", places) };
    }
    let (variables, calls, at) = (HashMap::new(), Calls::new(8), Vec3::NAN);
    Run { text, labels, structures, variables, calls, at, channel }.all()
}

impl Run<'_, '_, '_> {
    fn all(&mut self) -> Outcome {
        let mut place = BlockLocation { at: 0, line: 1 };
        while let Some((text, after)) = line(self.text, place) {
            let source = Source { line: place.line, text };
            let Some(to) = self.block(source, place, after)? else { return Ok(()) };
            if to != after {
                let counted = self.channel.budget.again(place.at.saturating_sub(to.at));
                counted.map_err(|message| source.block_error(Rule::Endless, message))?;
            }
            place = to;
        }
        Err(Diagnostic::error(Rule::NoEnd, "the program has no END").line(place.line).into())
    }

    /// Carries out a block; which comes next, if any does.
    fn block(
        &mut self,
        source: Source,
        here: BlockLocation,
        after: BlockLocation,
    ) -> Outcome<Option<BlockLocation>> {
        let mut block = Block { source, at: 0, depth: 0, variables: &self.variables };
        let first = block.name();
        let name = if block.take(b':') { block.name() } else { first };
        let partner = || self.structures.partner(here.at);
        let whole = |message: &str| source.block_error(Rule::ControlStructure, message);
        let mut to = Some(after);
        match name.as_str() {
            "" => {}
            "END" => return self.channel.report(here.line, Action::End).map(|()| None),
            "PTP" | "LIN" => {
                let pose = Position::new(block.points::<1>()?[0], Vec3::Z);
                let action = if name == "PTP" { Action::Rapid } else { Action::Line };
                self.channel.report(here.line, action(pose))?;
                self.at = pose.point;
            }
            "CIRC" => {
                let [point, end] = block.points()?;
                let Some((center, normal)) = arc::through(self.at, point, end) else {
                    return Err(
                        source.block_error(Rule::Arc, "the points of the arc lie on a line")
                    );
                };
                let arc = ArcTo { end: Position::new(end, Vec3::Z), center, normal, turns: 0 };
                self.channel.report(here.line, Action::Arc(arc.into()))?;
                self.at = end;
            }
            "WHILE" | "SUB" => {
                let end = partner().ok_or_else(|| whole("this has no end"))?;
                let goes_in =
                    if name == "SUB" { block.name().is_empty() } else { block.number()? != 0.0 };
                to = Some(if goes_in { after } else { end.after });
            }
            "ENDWHILE" => to = partner().map(|begin| begin.place),
            "ENDSUB" => to = Some(self.calls.leave().unwrap_or(after)),
            "GOTO" | "CALL" => {
                let found = self.labels.first(&block.name());
                let found = found.ok_or_else(|| block.wrong("there is no such label"))?;
                let goes = block.name() != "IF" || block.number()? != 0.0;
                if name == "GOTO" && !self.structures.may_jump(here.at, found.at) {
                    return Err(whole("a jump into a structure"));
                }
                if name == "CALL" && goes {
                    let entered = self.calls.enter(after);
                    entered.map_err(|most| whole(&format!("calls nest deeper than {most}")))?;
                }
                to = Some(if goes { found } else { after });
            }
            _ if block.take(b'=') => {
                let value = block.number()?;
                self.variables.insert(name, value);
                return Ok(to);
            }
            _ => return Err(block.wrong(format!("{name} is no word of this language"))),
        }
        block.ends()?;
        Ok(to)
    }
}

fn events(text: &str) -> Outcome<Vec<Event>> {
    let mut events = Vec::new();
    let mut sink = |event| {
        events.push(event);
        Ok(())
    };
    let settings = Settings::new(Dialect::Points, [false; 3]);
    let text = text.as_bytes();
    kernel::run(&settings, "a.rob", text, &mut sink, |channel| run(text, channel))?;
    Ok(events)
}

#[test]
fn a_program_with_a_loop_a_label_a_call_and_an_arc_by_a_point_is_followed() {
    let text = "PTP 10, 0, 50\nn = 4 / 2\nWHILE n > 0\nLIN 10 * n, 0, -(1)\nn = n - 1\n\
                ENDWHILE\nCALL round\nGOTO done IF n < 1\nLIN 0, 0, 0\ndone: END\nSUB round\n\
                CIRC 0, 10, -1, -10, 0, -1\nENDSUB\n";
    let found = events(text).unwrap();
    let points: Vec<Vec3> = found.iter().filter_map(|e| Some(e.action.position()?.point)).collect();
    let expected = [(10.0, 50.0), (20.0, -1.0), (10.0, -1.0), (-10.0, -1.0)];
    assert_eq!(points, expected.map(|(x, z)| Vec3::new(x, 0.0, z)));
    assert_eq!(found.iter().map(|e| e.line).collect::<Vec<_>>(), [1, 4, 4, 12, 10]);
    // Half a circle about the origin, by hand.
    let Action::Arc(arc) = &found[3].action else { panic!("{found:?}") };
    assert!((arc.center - Vec3::new(0.0, 0.0, -1.0)).length() < 1e-12 && arc.normal == Vec3::Z);
}

#[test]
fn what_is_wrong_is_shown_in_its_block() {
    let deep = format!("n = {}1\nEND\n", "(".repeat(100));
    for (text, rule, line, column) in [
        ("n = 4 / (2 - 2)\nEND\n", "arithmetic", 1, 5),
        ("n = m\nEND\n", "syntax", 1, 6),
        ("PTP 0,0,0\nCIRC 1,0,0, 2,0,0\nEND\n", "arc", 2, 1),
        ("GOTO in\nWHILE 1 > 0\nin: n = 1\nENDWHILE\nEND\n", "control-structure", 1, 1),
        ("ENDWHILE\nEND\n", "control-structure", 1, 1),
        ("SUB a\nCALL a\nENDSUB\nCALL a\nEND\n", "control-structure", 2, 1),
        ("WHILE 1 > 0\nENDWHILE\nEND\n", "endless", 2, 1),
        (&deep, "syntax", 1, 26),
    ] {
        let found = events(text).unwrap_err();
        assert_eq!(
            (found.rule.name(), found.line, found.column),
            (rule, line, column),
            "{text}: {found}"
        );
        assert_eq!(found.file, "a.rob");
    }
}
