//! Through a file: the function that is run, and those of the file that it calls.

use super::execution::State;
use super::language::{Argument, Scan, Statement, read, word_of};
use crate::Settings;
use crate::event::Action;
use crate::kernel::Channel;
use crate::kernel::flow::{BlockLocation, Structures, line, lines};
use crate::kernel::source::Source;
use program::{Diagnostic, Outcome, Rule};
use std::collections::HashMap;

/// Most calls within calls: no manual states a number.
const DEEPEST: usize = 20;

/// A function of the file.
struct Function<'t> {
    parameters: Vec<&'t str>,
    /// Behind its `def`.
    body: BlockLocation,
}

struct File<'t> {
    text: &'t [u8],
    functions: HashMap<&'t str, Function<'t>>,
    /// The functions that stand in no other, in order.
    outer: Vec<&'t str>,
    structures: Structures<()>,
}

/// Runs a program.
pub(super) fn run(settings: &Settings, text: &[u8], channel: &mut Channel) -> Outcome {
    let file = File::of(text)?;
    let mut run = Run { state: State::new(&settings.tool_change), channel };
    run.state.begins(1, run.channel)?;
    let end = run.outside(&file)?;
    run.channel.report(end, Action::End)
}

impl<'t> File<'t> {
    /// # Errors
    /// Structures without an end, an end without a structure, two functions of one name.
    fn of(text: &'t [u8]) -> Outcome<File<'t>> {
        let mut file = File {
            text,
            functions: HashMap::new(),
            outer: Vec::new(),
            structures: Structures::default(),
        };
        for (place, after, block) in lines(text) {
            let mut scan = Scan::new(Source { line: place.line, text: block });
            match word_of(&mut scan) {
                Some("def") => {
                    let is_outer = file.structures.unclosed().len() == 0;
                    if let Statement::Define(name, parameters) = read(&mut scan, &State::new(""))? {
                        let function = Function { parameters, body: after };
                        if file.functions.insert(name, function).is_some() {
                            let message = format!("the file has two functions {name}");
                            return Err(scan.since(0, Rule::Twice, message));
                        }
                        if is_outer {
                            file.outer.push(name);
                        }
                    }
                    file.structures.open((), [place, after]);
                }
                Some("if" | "while" | "thread") => {
                    file.structures.open((), [place, after]);
                }
                Some("end") if file.structures.close((), [place, after]).is_none() => {
                    let message = "this end closes nothing";
                    return Err(scan.since(0, Rule::ProgramFrame, message));
                }
                _ => {}
            }
        }
        let open =
            file.structures.unclosed().next_back().map(|[first, _]| file.structures[first].place);
        match open {
            Some(place) => {
                let message = "this has no end: the controller does not take the program";
                Err(Diagnostic::error(Rule::NoEnd, message).line(place.line).into())
            }
            None => Ok(file),
        }
    }

    /// Behind the end of what begins at byte `at`.
    fn behind(&self, at: usize) -> Option<BlockLocation> {
        let index = self.structures.find(at)?;
        Some(self.structures[self.structures.end(index)].after)
    }
}

struct Run<'r, 'c> {
    state: State,
    channel: &'r mut Channel<'c>,
}

impl Run<'_, '_> {
    /// What stands outside of all functions: where that is nothing but one function, the controller runs it. The line of the end.
    fn outside(&mut self, file: &File) -> Outcome<u32> {
        let mut place = BlockLocation { at: 0, line: 1 };
        let (mut last, mut called) = (1, false);
        while let Some((text, after)) = line(file.text, place) {
            let mut scan = Scan::new(Source { line: place.line, text });
            if word_of(&mut scan) == Some("def") {
                place = file.behind(place.at).unwrap_or(after);
                continue;
            }
            match read(&mut scan, &self.state)? {
                Statement::Nothing => {}
                Statement::Comment(text) => {
                    self.channel.report(place.line, Action::Comment(text))?;
                }
                Statement::Call(name, arguments)
                    if !called && file.functions.contains_key(name) =>
                {
                    called = true;
                    last = self.call(file, &scan, (name, &arguments), 0)?;
                }
                _ => {
                    let message =
                        "outside of functions a program has the call of one of them and no more";
                    return Err(scan.since(0, Rule::ProgramFrame, message));
                }
            }
            place = after;
        }
        match (called, &file.outer[..]) {
            (true, _) => Ok(last),
            (false, [name]) => {
                let Some(Function { body, parameters }) = file.functions.get(name) else {
                    return Ok(last);
                };
                if !parameters.is_empty() {
                    let message =
                        format!("the program {name} has parameters, and nothing calls it");
                    return Err(Diagnostic::error(Rule::Argument, message).line(1).into());
                }
                self.routine(file, *body, 0)
            }
            (false, []) => {
                let message = "the file has no program: it begins with def name():";
                Err(Diagnostic::error(Rule::ProgramFrame, message).line(1).into())
            }
            (false, [_, second, ..]) => {
                let message = format!(
                    "the file has more than one function ({second} is another), and no call says which is the program"
                );
                Err(Diagnostic::error(Rule::ProgramFrame, message).line(1).into())
            }
        }
    }

    /// Runs a function from behind its `def` to its end; the line of that.
    fn routine(&mut self, file: &File, from: BlockLocation, depth: usize) -> Outcome<u32> {
        let mut place = from;
        while let Some((text, mut after)) = line(file.text, place) {
            let number = place.line;
            let mut scan = Scan::new(Source { line: number, text });
            if word_of(&mut scan) == Some("def") {
                place = file.behind(place.at).unwrap_or(after);
                continue;
            }
            match read(&mut scan, &self.state)? {
                Statement::End | Statement::Return => return Ok(number),
                Statement::Comment(text) => self.channel.report(number, Action::Comment(text))?,
                Statement::Assign(scope, name, value) => {
                    self.state.assign(&scan, scope, name, value)?;
                }
                Statement::Call(name, arguments) => {
                    if !self.state.command(&scan, (name, &arguments), self.channel)? {
                        self.call(file, &scan, (name, &arguments), depth)?;
                    }
                }
                Statement::While(input, on) => {
                    let behind = file.behind(place.at).unwrap_or(after);
                    self.wait(file, [after, behind], (number, input, on))?;
                    after = behind;
                }
                Statement::Nothing | Statement::Define(..) => {}
            }
            place = after;
        }
        Err(Diagnostic::error(Rule::NoEnd, "the function has no end").line(place.line).into())
    }

    /// Waits for an input: what stands in the loop does nothing but let time go by.
    ///
    /// # Errors
    /// It does something else.
    fn wait(
        &mut self,
        file: &File,
        [from, behind]: [BlockLocation; 2],
        (number, input, on): (u32, u32, bool),
    ) -> Outcome {
        let mut place = from;
        while let Some((text, after)) = line(file.text, place).filter(|_| place.at < behind.at) {
            let mut scan = Scan::new(Source { line: place.line, text });
            match read(&mut scan, &self.state)? {
                Statement::Nothing | Statement::Comment(_) | Statement::End => {}
                Statement::Call("sync" | "sleep", _) => {}
                _ => {
                    let message = "a loop that does more than wait for an input is not followed";
                    return Err(scan.since(0, Rule::Unsupported, message));
                }
            }
            place = after;
        }
        self.channel.input(number, input, on)
    }

    /// A call of a function of this file; the line of its end.
    fn call(
        &mut self,
        file: &File,
        scan: &Scan,
        (name, arguments): (&str, &[Argument]),
        depth: usize,
    ) -> Outcome<u32> {
        let refused = |rule: Rule, message: String| Err(scan.since(0, rule, message));
        let Some(function) = file.functions.get(name) else {
            return refused(
                Rule::UnknownCommand,
                format!(
                    "{name} is neither a command that is understood nor a function of the file"
                ),
            );
        };
        let counted = self.channel.budget.call(depth, DEEPEST);
        counted.map_err(|(rule, message)| scan.since(0, rule, message))?;
        let by_place = arguments.iter().all(|argument| argument.name.is_none());
        if !by_place || arguments.len() != function.parameters.len() {
            let message =
                format!("{name} has {} parameters, by their places", function.parameters.len());
            return refused(Rule::Argument, message);
        }
        let values = arguments.iter().map(|argument| argument.value.clone());
        let names = function.parameters.iter().map(|name| Box::from(*name));
        self.state.enter(names.zip(values).collect());
        let end = self.routine(file, function.body, depth + 1);
        self.state.leave();
        end
    }
}
