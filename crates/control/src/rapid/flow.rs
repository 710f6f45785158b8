//! Through a module: its data, `main`, and what that calls in it and in the modules of other files.

use super::execution::{Data, State};
use super::language::{Name, REFUSED, RESERVED, Routine, Scan, Statement, declaration, read};
use crate::event::{Action, Risk};
use crate::kernel::Channel;
use crate::kernel::flow::BlockLocation;
use crate::{ArmAction, Settings};
use program::{Diagnostic, Outcome, OutputValue, Rule};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// Most calls within calls.
const DEEPEST: usize = 20;

/// Most modules that are loaded at once: no manual at hand states a number.
const MOST_MODULES: usize = 50;

/// A module.
struct Module<'t> {
    text: Cow<'t, [u8]>,
    name: Name,
    /// The name of its file; none of the one that is run.
    file: Option<Box<str>>,
    /// Where its procedures begin: behind their heads.
    routines: HashMap<Name, BlockLocation>,
    /// Those of them that other modules do not see.
    local: HashSet<Name>,
}

/// Whether a procedure has come to its end, or the program.
#[derive(Clone, Copy, PartialEq)]
enum Ended {
    Routine(u32),
    Program(u32),
}

/// Runs a program.
pub(super) fn run(settings: &Settings, text: &[u8], channel: &mut Channel) -> Outcome {
    let mut state = State::new(&settings.tool_change, &settings.signals);
    let module = Module::of(Cow::Borrowed(text), None, &mut state)?;
    let main = Name::of("MAIN").and_then(|name| module.routines.get(&name).copied());
    let Some(main) = main else {
        let message = "the module has no procedure main";
        return Err(Diagnostic::error(Rule::ProgramFrame, message).line(1).into());
    };
    let mut run = Run { settings, state, channel, loaded: Vec::new() };
    let ended = run.routine(&module, main, 0)?;
    if let Some(loaded) = run.loaded.first() {
        let (Ended::Program(line) | Ended::Routine(line)) = ended;
        let message = format!("the program ends, and {} is still loaded", loaded.path);
        let found = Diagnostic::error(Rule::CalledProgram, message);
        return Err(found.help("UnLoad with the same file behind its call").line(line).into());
    }
    let end = match ended {
        Ended::Program(end) => end,
        Ended::Routine(end) => {
            run.channel.report(end, Action::Risk(BEGINS_ANEW.into()))?;
            end
        }
    };
    run.channel.report(end, Action::End)
}

/// Technical reference manual RAPID, `EXIT`, and "Running modes": at the end of `main` a program in continuous mode begins at its start.
const BEGINS_ANEW: Risk = Risk {
    rule: Rule::NoEnd,
    what: "ends without EXIT: in continuous mode it begins anew and cuts the part once more",
    help: "EXIT; before ENDPROC of main",
    refused: true,
};

impl<'t> Module<'t> {
    /// Takes the data of a module, and finds its procedures.
    ///
    /// # Errors
    /// What is not understood, but for what stands in procedures.
    fn of(text: Cow<'t, [u8]>, file: Option<Box<str>>, state: &mut State) -> Outcome<Module<'t>> {
        let mut scan = Scan::within(&text, BlockLocation { at: 0, line: 1 });
        head(&mut scan)?;
        if !scan.take_word("MODULE") {
            return Err(scan.wrong("the file begins with MODULE and a name"));
        }
        let from = scan.at;
        let name = scan.needed("the name of the module")?;
        if RESERVED.contains(&name.as_str()) {
            let message = format!("{name} is a word of RAPID: no module may be called so");
            return Err(scan.since(from, Rule::Definition, message));
        }
        if scan.take(b'(') {
            while !scan.take(b')') {
                scan.needed("an attribute of the module")?;
                scan.take(b',');
            }
        }
        let (mut routines, mut local) = (HashMap::new(), HashSet::new());
        let (mut declared, mut assigned) = (Vec::new(), HashSet::new());
        loop {
            scan.peek();
            let from = scan.at;
            let is_local = scan.take_word("LOCAL");
            let word = scan.needed("a declaration, PROC or ENDMODULE")?;
            match word.as_str() {
                "CONST" | "PERS" | "VAR" => {
                    let data = declaration(&mut scan, state, word)?;
                    declared.push(data.name);
                    state.declare(&scan, from, data)?;
                }
                "PROC" => {
                    let Routine(name) = Routine::read(&mut scan)?;
                    if routines.insert(name, scan.location()).is_some() {
                        let message = format!("the module has two procedures {name}");
                        return Err(scan.since(from, Rule::Twice, message));
                    }
                    if is_local {
                        local.insert(name);
                    }
                    over(&mut scan, &mut assigned)?;
                }
                "ENDMODULE" => break,
                _ => {
                    let message = format!("{word} is not followed here");
                    return Err(scan.since(from, Rule::Unsupported, message));
                }
            }
        }
        for name in declared {
            state.outlive(name, assigned.contains(&name));
        }
        if scan.peek().is_some() {
            return Err(scan.wrong("something stands behind ENDMODULE"));
        }
        Ok(Module { text, name, file, routines, local })
    }

    /// Basic characteristics RAPID, "Routine scope": the scope of a local routine is the module in which it is.
    fn seen_outside(&self, name: Name) -> Option<BlockLocation> {
        self.routines.get(&name).copied().filter(|_| !self.local.contains(&name))
    }
}

/// `%%% VERSION:1 LANGUAGE:ENGLISH %%%`, with which older controllers begin a file.
fn head(scan: &mut Scan) -> Outcome {
    scan.peek();
    if !scan.rest().starts_with(b"%%%") {
        return Ok(());
    }
    match memchr::memmem::find(&scan.rest()[3..], b"%%%") {
        Some(length) => {
            scan.at += length + 6;
            Ok(())
        }
        None => Err(scan.wrong("the head of the file has no end: %%%")),
    }
}

/// Goes over the statements of a procedure to behind its `ENDPROC`, and notes what they assign.
fn over(scan: &mut Scan, assigned: &mut HashSet<Name>) -> Outcome {
    loop {
        if scan.peek() == Some(b'%') {
            scan.skip()?;
            continue;
        }
        let from = scan.at;
        let name = scan.needed("a statement or ENDPROC")?;
        if matches!(scan.peek(), Some(b'.' | b':')) {
            assigned.insert(name);
        }
        let word = name.as_str();
        if word == "ENDPROC" {
            return Ok(());
        }
        if matches!(word, "PROC" | "MODULE" | "ENDMODULE") {
            let message = "a procedure has no end: ENDPROC is missing before this";
            return Err(scan.since(from, Rule::NoEnd, message));
        }
        if REFUSED.contains(&word) {
            let message = format!("{word} is not followed");
            return Err(scan.since(from, Rule::Unsupported, message));
        }
        scan.skip()?;
    }
}

/// A module that `Load` has taken from a file.
struct Loaded {
    /// As it is written.
    path: Box<str>,
    module: Rc<Module<'static>>,
    /// None while it is run.
    data: Option<Data>,
}

struct Run<'r, 'c> {
    settings: &'r Settings,
    state: State,
    channel: &'r mut Channel<'c>,
    loaded: Vec<Loaded>,
}

impl Run<'_, '_> {
    /// Runs a procedure from behind its head to its end.
    fn routine(&mut self, module: &Module, from: BlockLocation, depth: usize) -> Outcome<Ended> {
        let mut scan = Scan::within(&module.text, from);
        let mut declared = Vec::new();
        let ended = loop {
            scan.blanks();
            let line = scan.location().line;
            if let Some(comment) = scan.comment() {
                if !comment.is_empty() {
                    let text = String::from_utf8_lossy(comment);
                    self.channel.report(line, Action::Comment(text.into()))?;
                }
                continue;
            }
            let from = scan.at;
            match read(&mut scan, &self.state)? {
                Statement::EndRoutine | Statement::Return => break Ended::Routine(line),
                Statement::Exit => break Ended::Program(line),
                Statement::Call(name, arguments) => {
                    let place = (&scan, from, line);
                    if self.state.called(place, name, &arguments, self.channel)? {
                        continue;
                    }
                    let call = (name, arguments.is_empty());
                    if let Ended::Program(end) = self.call(module, place, call, depth)? {
                        break Ended::Program(end);
                    }
                }
                Statement::CallByName(of, name) => {
                    let place = (&scan, from, line);
                    let ended = self.call_by_name(module, place, (of, name), depth)?;
                    if let Ended::Program(end) = ended {
                        break Ended::Program(end);
                    }
                }
                Statement::Load(path) => self.load(module, (&scan, from, line), path)?,
                Statement::Unload(path) => self.unload(module, (&scan, from, line), &path)?,
                Statement::Declare(declaration) => {
                    declared.push(declaration.name);
                    self.state.declare(&scan, from, declaration)?;
                }
                other => self.statement((&scan, from, line), other)?,
            }
        };
        self.state.leave(&declared);
        Ok(ended)
    }

    fn statement(
        &mut self,
        (scan, from, line): (&Scan, usize, u32),
        statement: Statement,
    ) -> Outcome {
        match statement {
            Statement::Motion(motion) => {
                return self.state.go((scan, from, line), &motion, self.channel);
            }
            Statement::Assign(target, value) => {
                return self.state.assign(scan, from, &target, value);
            }
            Statement::Configuration(on) => self.state.set_nearest(!on),
            Statement::Singularity(turning) => self.state.set_turning(turning),
            Statement::Circles(turning) => self.state.set_circles(turning),
            Statement::Digital(name, on) => {
                let value = OutputValue::Digital(on);
                return self.state.output(line, name, value, self.channel);
            }
            Statement::Analog(name, number) => {
                let value = OutputValue::Analog(number);
                return self.state.output(line, name, value, self.channel);
            }
            Statement::Input(name, on) => return self.state.input(line, name, on, self.channel),
            Statement::Wait(seconds) => return self.channel.report(line, Action::Dwell(seconds)),
            Statement::Message(text) => return self.channel.report(line, Action::Message(text)),
            Statement::Stop => return self.channel.report(line, Action::Stop),
            Statement::Nothing
            | Statement::Declare(_)
            | Statement::Call(..)
            | Statement::CallByName(..)
            | Statement::Load(_)
            | Statement::Unload(_)
            | Statement::Exit
            | Statement::Return
            | Statement::EndRoutine => {}
        }
        Ok(())
    }

    /// A call of a procedure of this module, or of another one; whether it is called without arguments.
    fn call(
        &mut self,
        module: &Module,
        (scan, from, line): (&Scan, usize, u32),
        (name, plain): (Name, bool),
        depth: usize,
    ) -> Outcome<Ended> {
        let refused = |rule: Rule, message: String| scan.since(from, rule, message);
        let counted = self.channel.budget.call(depth, DEEPEST);
        counted.map_err(|(rule, message)| refused(rule, message))?;
        let own = module.routines.get(&name).copied();
        let called = self.settings.setup.folders.called(name.as_str(), "mod");
        let called = called.map_err(|message| refused(Rule::CalledProgram, message))?;
        if !plain && (own.is_some() || called.is_some()) {
            let message = format!("{name} is called with arguments, which is not followed");
            return Err(refused(Rule::Argument, message));
        }
        if let Some(place) = own {
            return self.routine(module, place, depth + 1);
        }
        let Some(called) = called else {
            let message = format!(
                "{name} is no instruction that is understood, and no procedure of this module or of a folder for called programs"
            );
            return Err(refused(Rule::CalledProgram, message));
        };
        let inside = |found: Box<Diagnostic>| called.inside(found);
        let other = Module::of(
            Cow::Borrowed(&called.text),
            Some(called.name.as_str().into()),
            &mut self.state,
        )
        .map_err(inside)?;
        let Some(place) = other.seen_outside(name) else {
            let is_local = other.local.contains(&name);
            let hidden = if is_local { " that is not LOCAL" } else { "" };
            let message = format!("{} has no procedure {name}{hidden}", called.name);
            return Err(refused(Rule::CalledProgram, message));
        };
        self.channel.arm(line, ArmAction::File(other.file.clone()))?;
        let ended = self.routine(&other, place, depth + 1).map_err(inside)?;
        if let Ended::Routine(end) = ended {
            self.channel.arm(end, ArmAction::File(module.file.clone())).map_err(inside)?;
        }
        Ok(ended)
    }

    /// `Load`: the arm stands meanwhile.
    fn load(
        &mut self,
        module: &Module,
        (scan, from, line): (&Scan, usize, u32),
        path: Box<str>,
    ) -> Outcome {
        let refused = |message: String| Err(scan.since(from, Rule::CalledProgram, message));
        let file = path.strip_prefix("HOME:").map(|file| file.trim_start_matches('/'));
        let parts = file.filter(|file| !file.contains('/')).and_then(|file| file.rsplit_once('.'));
        let Some((stem, ending)) = parts else {
            return refused(format!("{path:?} is no file that lies in HOME: itself"));
        };
        if self.loaded.iter().any(|loaded| loaded.path.eq_ignore_ascii_case(&path)) {
            return refused(format!("{path} is loaded already"));
        }
        if self.loaded.len() == MOST_MODULES {
            let message = format!("more than {MOST_MODULES} modules are loaded at once");
            return Err(scan.since(from, Rule::TooMuch, message));
        }
        let called = self.settings.setup.folders.called(stem, ending);
        let called = called.map_err(|message| scan.since(from, Rule::CalledProgram, message))?;
        let Some(called) = called else {
            return refused(format!("the module {path} is in no folder for called programs"));
        };
        self.channel.arm(line, ArmAction::File(module.file.clone()))?;
        let outer = self.state.exchange(Data::default());
        let name: Box<str> = called.name.as_str().into();
        let read = Module::of(Cow::Owned(called.text), Some(name.clone()), &mut self.state);
        let data = self.state.exchange(outer);
        let read = read.map_err(|found| match found.file.is_empty() {
            true => Box::new(found.file(name.to_string())),
            false => found,
        })?;
        let others = self.loaded.iter().map(|loaded| loaded.module.name);
        if let Some(other) = others.chain([module.name]).find(|other| *other == read.name) {
            return refused(format!(
                "{path} has the module {other}, and another of that name is there"
            ));
        }
        self.loaded.push(Loaded { path, module: Rc::new(read), data: Some(data) });
        Ok(())
    }

    /// `UnLoad`.
    fn unload(
        &mut self,
        module: &Module,
        (scan, from, line): (&Scan, usize, u32),
        path: &str,
    ) -> Outcome {
        let refused = |message: String| Err(scan.since(from, Rule::CalledProgram, message));
        let at = self.loaded.iter().position(|loaded| loaded.path.eq_ignore_ascii_case(path));
        let Some(at) = at else { return refused(format!("{path} is not loaded")) };
        if self.loaded[at].data.is_none() {
            return refused(format!("{path} is unloaded while it is run"));
        }
        self.channel.arm(line, ArmAction::File(module.file.clone()))?;
        self.loaded.remove(at);
        Ok(())
    }

    /// `%"name"%`: of the module that is run, or of one that is loaded.
    fn call_by_name(
        &mut self,
        module: &Module,
        (scan, from, line): (&Scan, usize, u32),
        (of, name): (Option<Name>, Name),
        depth: usize,
    ) -> Outcome<Ended> {
        let refused = |rule: Rule, message: String| scan.since(from, rule, message);
        let counted = self.channel.budget.call(depth, DEEPEST);
        counted.map_err(|(rule, message)| refused(rule, message))?;
        let named = |module: &Module| of.is_some_and(|of| of == module.name);
        // By the name of its module a local procedure is found as well.
        let has = |module: &Module| match of {
            Some(_) => named(module) && module.routines.contains_key(&name),
            None => module.seen_outside(name).is_some(),
        };
        let own = module.routines.get(&name).copied().filter(|_| of.is_none() || named(module));
        let other = |at: &usize| self.loaded[*at].module.name != module.name;
        let mut found =
            (0..self.loaded.len()).filter(other).filter(|at| has(&self.loaded[*at].module));
        let (loaded, next) = (found.next(), found.next());
        let at = match (own, loaded, next) {
            (Some(place), None, _) => return self.routine(module, place, depth + 1),
            (None, Some(at), None) => at,
            (None, None, _) => {
                let hides = |loaded: &&Loaded| of.is_none() && loaded.module.local.contains(&name);
                let message = match self.loaded.iter().find(hides).map(|loaded| loaded.module.name)
                {
                    None => format!("no module that is loaded has a procedure {name}"),
                    Some(of) => format!(
                        "{name} of the module {of} is LOCAL, which other modules do not see: leave LOCAL out there, or call it as \
                         %\"{of}:{name}\"%"
                    ),
                };
                return Err(refused(Rule::CalledProgram, message));
            }
            (Some(_), Some(_), _) | (None, Some(_), Some(_)) => {
                let message = format!("two modules have a procedure {name}");
                return Err(refused(Rule::CalledProgram, message));
            }
        };
        let Some(data) = self.loaded[at].data.take() else {
            let message = format!("{name} belongs to a module that is run already");
            return Err(refused(Rule::CalledProgram, message));
        };
        let other = Rc::clone(&self.loaded[at].module);
        let inside = |found: Box<Diagnostic>| match (&other.file, found.file.is_empty()) {
            (Some(file), true) => Box::new(found.file(file.to_string())),
            (_, _) => found,
        };
        let place = other.routines[&name];
        self.channel.arm(line, ArmAction::File(other.file.clone()))?;
        let outer = self.state.exchange(data);
        let ended = self.routine(&other, place, depth + 1).map_err(inside)?;
        let data = self.state.exchange(outer);
        if let Some(loaded) =
            self.loaded.iter_mut().find(|loaded| Rc::ptr_eq(&loaded.module, &other))
        {
            loaded.data = Some(data);
        }
        if let Ended::Routine(end) = ended {
            self.channel.arm(end, ArmAction::File(module.file.clone())).map_err(inside)?;
        }
        Ok(ended)
    }
}
