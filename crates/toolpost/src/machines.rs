//! `toolpost machines`: the library, and files of one's own.

use crate::answer::Answer;
use crate::args::Machines;
use crate::arms;
use app::files::{self, Target};
use app::toolpath::{self, describe};
use app::{Stop, Verdict, summary};
use machine::{Machine, library, starter};
use program::{Diagnostic, Rule, encoding};
use serde_json::{Value, json};
use std::path::Path;

/// Lists, prints, starts or checks machines.
pub fn run(command: &Machines) -> Result<Answer, Stop> {
    match command {
        Machines::List => list(),
        Machines::Show { name } => show(name),
        Machines::New { name, from } => new(name, from),
        Machines::Import { file, output, extends, reach } => {
            import(file, output, extends.as_deref(), *reach)
        }
        Machines::Check { file, upgrade: true } => upgrade(file),
        Machines::Check { file, upgrade: false } => check(file),
    }
}

fn list() -> Result<Answer, Stop> {
    let machines: Result<Vec<Machine>, Stop> =
        library::names(library::MACHINES).map(toolpath::machine).collect();
    let controls: Result<Vec<Machine>, Stop> =
        library::names(library::CONTROLS).map(|name| Ok(machine::load_control(name)?)).collect();
    let robots: Result<Vec<Machine>, Stop> =
        library::names(library::ROBOTS).map(toolpath::machine).collect();
    let arms: Result<Vec<Machine>, Stop> =
        library::names(library::ARMS).map(toolpath::machine_or_arm).collect();
    let (machines, robots, arms, controls) = (machines?, robots?, arms?, controls?);
    let rows = |all: &[Machine], text: &dyn Fn(&Machine) -> String| {
        let lines: Vec<_> = all.iter().map(|m| (m.name.as_str(), text(m))).collect();
        summary::rows(&lines)
    };
    let text = format!(
        "{}\nrobots:\n{}\narms, as kinematics alone:\n{}\ncontrols, for machines of your own to extend:\n{}",
        rows(&machines, &|machine| format!("{}: {}", machine.title, abilities(machine))),
        rows(&robots, &|machine| format!("{}: {}", machine.title, arms::abilities(machine))),
        rows(&arms, &|machine| format!("{}: {}", machine.title, arms::abilities(machine))),
        rows(&controls, &|machine| machine.title.clone())
    );
    let data = |all: &[Machine]| all.iter().map(describe).collect::<Vec<Value>>();
    let data = json!({
        "machines": data(&machines),
        "robots": data(&robots),
        "arms": data(&arms),
        "controls": data(&controls),
    });
    Ok(Answer::product(text, data))
}

/// The axes of a machine, its travel (mm), and the command that writes for it.
fn abilities(machine: &Machine) -> String {
    let rotary = machine.rotary.iter().map(|axis| ['A', 'B', 'C'][axis.index()]);
    let axes: String = match machine.wire {
        Some(_) => "XYUV".into(),
        None => "XYZ".chars().chain(rotary).collect(),
    };
    let travels: Vec<String> =
        machine.linear.iter().map(|axis| axis.max - axis.min).map(travel).collect();
    let travel = match machine.linear.iter().all(|axis| (axis.max - axis.min).is_infinite()) {
        true => String::from("no travel stated"),
        false => format!("{} mm", travels.join(" x ")),
    };
    let command = if machine.wire.is_some() { "wire" } else { "post" };
    format!("{axes}, {travel}, {command}")
}

/// The travel of an axis, mm.
fn travel(length: f64) -> String {
    if length.is_finite() { summary::number(length, 1) } else { String::from("?") }
}

/// The text of a file of the library.
fn show(name: &str) -> Result<Answer, Stop> {
    let text = library_text(name)?;
    Ok(Answer::product(text, json!({ "name": name, "text": text })))
}

/// Copies a machine to a new file of this folder.
fn new(name: &str, from: &str) -> Result<Answer, Stop> {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    if name.is_empty() || !name.chars().all(plain) {
        return Err(Diagnostic::error(
            Rule::MachineName,
            format!("`{name}` is no name for a machine"),
        )
        .help("letters, digits, - and _ make a name; the file is NAME.toml in this folder")
        .into());
    }
    let path = Path::new(name).with_extension("toml");
    if path.symlink_metadata().is_ok() {
        return Err(Diagnostic::error(Rule::OutputFile, "there is such a file already")
            .file(path.display().to_string())
            .help("give another name, or edit the file that is there")
            .into());
    }
    let is_file = from.contains(['/', '\\']) || from.ends_with(".toml");
    let text = if is_file {
        let bytes = files::read(Path::new(from))?;
        encoding::utf_8(&bytes).map_err(|found| found.file(from))?.to_owned()
    } else {
        library_text(from)?.to_owned()
    };
    let file = path.display().to_string();
    let machine = machine::load_text(&file, &text)?;
    // A copy of a copy has one name before the title.
    let stem = Path::new(from).file_stem().unwrap_or_default().to_string_lossy();
    let title = machine.title.strip_prefix(&format!("{stem}: ")).unwrap_or(&machine.title);
    let text = starter::titled(&text, &format!("{name}: {title}"));
    let holds = |text: &str| {
        machine::load_text(&file, text).is_ok_and(|machine| {
            post::check(&machine).is_ok() && post::without_effect(&machine).is_empty()
        })
    };
    let text = match machine.has_control() && !is_file {
        true => starter::offered(&text, &holds),
        false => text,
    };
    let machine = machine::load_text(&file, &text)?;
    let target = Target::new(&path, &[])?;
    files::save(&[(&target, text.as_bytes())])?;
    let command = match machine.has_control() {
        true => format!("toolpost post ... --machine {file}"),
        false => format!("toolpost machines check {file}"),
    };
    let lines = [("saved", file.clone()), ("use it", command)];
    let data = json!({ "file": file, "machine": describe(&machine) });
    Ok(Answer::summary(Verdict::Done, summary::rows(&lines), data))
}

/// The toolpath that an imported machine is tried with.
const SAMPLE: &str = include_str!("../../../machines/samples/three-axes.cls");

/// Makes a machine file of a post, says what it could not carry over, and proves a sample program.
fn import(
    file: &Path,
    output: &Path,
    extends: Option<&str>,
    reach: Option<f64>,
) -> Result<Answer, Stop> {
    let ending = file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
    match (ending.as_deref(), extends, reach) {
        (Some("urdf"), None, reach) => {
            let read = |name: &str, bytes: &[u8]| import::import_urdf(name, bytes, reach);
            return import_arm(file, output, &read);
        }
        (Some("yaml" | "yml"), extends, None) => {
            let read = |name: &str, bytes: &[u8]| import::import_calibration(name, bytes, extends);
            return import_arm(file, output, &read);
        }
        (_, _, None) if ending.as_deref() != Some("urdf") => {}
        (Some("urdf"), Some(_), _) => {
            let message = "the file of an arm extends no other one";
            return Err(Diagnostic::error(Rule::ArmExtends, message)
                .help("leave --extends out")
                .into());
        }
        _ => {
            let message = "--reach is for the description of an arm (.urdf)";
            return Err(Diagnostic::error(Rule::ArmReach, message)
                .help("leave --reach out")
                .into());
        }
    }
    let invalid = |findings| Stop { verdict: Verdict::Invalid, findings };
    let target = Target::new(output, &[file])?;
    let bytes = files::text(file)?;
    let post = files::name(file);
    let folder = output.parent().unwrap_or(Path::new(""));
    let import = import::import(&post, &bytes, extends, folder).map_err(invalid)?;
    let saved = output.display().to_string();
    // What is wrong stands in a file that there will not be.
    let unsaved = |found: Vec<Diagnostic>| {
        let about = |found: Diagnostic| {
            let message = format!("what it becomes is no machine: {}", found.message);
            Diagnostic::error(found.rule, message).help(found.help).file(post.clone())
        };
        invalid([import.findings.clone(), found.into_iter().map(about).collect()].concat())
    };
    let machine =
        machine::load_text(&saved, &import.text).map_err(|found| unsaved(vec![*found]))?;
    post::check(&machine).map_err(unsaved)?;
    let proven = sample(&machine);
    files::save(&[(&target, import.text.as_bytes())])?;
    let (verdict, sample) = match &proven {
        Ok(()) => (Verdict::Done, "proven"),
        Err(_) => {
            (Verdict::Failed, "not proven: change the file until it is (`machines check` reads it)")
        }
    };
    let carried = match import.findings.len() {
        0 => String::from("all of it"),
        some => format!("all but what {some} findings say"),
    };
    let lines = [
        ("saved", saved.clone()),
        ("extends", import.extends.clone()),
        ("carried", carried),
        ("sample", String::from(sample)),
    ];
    let data = json!({
        "file": saved,
        "extends": import.extends,
        "machine": describe(&machine),
        "sample": if proven.is_ok() { "proven" } else { "failed" },
    });
    let findings = [import.findings, proven.err().unwrap_or_default()].concat();
    Ok(Answer::summary(verdict, summary::rows(&lines), data).findings(findings))
}

/// How a description of an arm is read: its name and its bytes.
type ReadArm<'a> = dyn Fn(&str, &[u8]) -> Result<import::Import, Vec<Diagnostic>> + 'a;

/// Makes a machine file of the description of an arm.
fn import_arm(file: &Path, output: &Path, read: &ReadArm<'_>) -> Result<Answer, Stop> {
    let invalid = |findings| Stop { verdict: Verdict::Invalid, findings };
    let target = Target::new(output, &[file])?;
    let import = read(&files::name(file), &files::text(file)?).map_err(invalid)?;
    let saved = output.display().to_string();
    let machine = machine::load_text(&saved, &import.text)?;
    files::save(&[(&target, import.text.as_bytes())])?;
    let arm = arms::abilities(&machine);
    let lines = [("saved", saved.clone()), ("arm", arm)];
    let data = json!({ "file": saved, "extends": import.extends, "machine": describe(&machine) });
    Ok(Answer::summary(Verdict::Done, summary::rows(&lines), data).findings(import.findings))
}

/// Writes the sample for a machine and proves it.
fn sample(machine: &Machine) -> Result<(), Vec<Diagnostic>> {
    let sample = source::apt::read("three-axes.cls", SAMPLE.as_bytes(), &Default::default())?;
    let output = post::write(&sample.program, machine)?;
    let report =
        proof::prove(&sample.program, machine, "sample", &output.text, &Default::default());
    if report.proven { Ok(()) } else { Err(report.mismatches) }
}

/// Loads a file and compiles its templates.
fn check(file: &str) -> Result<Answer, Stop> {
    let machine = toolpath::machine_or_arm(file).map_err(|first| all_mistakes(file, first))?;
    if let Some(arm) = machine.arm.as_ref().filter(|_| !machine.has_control()) {
        return Ok(arms::check(&machine, arm));
    }
    post::check(&machine).map_err(|findings| Stop { verdict: Verdict::Invalid, findings })?;
    nc::settings(&machine, control::Setup::default())
        .and_then(|settings| control::check_coolant(&settings))
        .map_err(|found| Box::new(found.file(file)))?;
    let unchecked = unchecked(&machine);
    let lines = [
        ("machine", machine.title.clone()),
        ("mistakes", String::from("none")),
        ("not checked", unchecked.join("; ")),
    ];
    let data = json!({ "machine": describe(&machine), "not_checked": unchecked });
    let findings = post::without_effect(&machine);
    Ok(Answer::summary(Verdict::Done, summary::rows(&lines), data).findings(findings))
}

/// All mistakes of a file of which the first is known; of a name of the library that one.
fn all_mistakes(file: &str, first: Stop) -> Stop {
    if !machine::is_path(file) {
        return first;
    }
    let (mut found, rest) = machine::Reach::Anywhere.mistakes(Path::new(file));
    // A block may be missing since it was taken out.
    let stands_there = |found: &Diagnostic| found.line > 0 && found.rule != Rule::MissingBlock;
    let templates = rest.filter(Machine::has_control).and_then(|rest| post::check(&rest).err());
    found.extend(templates.unwrap_or_default().into_iter().filter(stands_there));
    if found.is_empty() { first } else { Stop { findings: found, ..first } }
}

/// What a file without mistakes leaves open.
fn unchecked(machine: &Machine) -> Vec<&'static str> {
    let endless = |axis: &machine::LinearAxis| axis.min.is_infinite() || axis.max.is_infinite();
    let has_no_end = machine.linear.iter().any(endless);
    let mut open = Vec::new();
    if machine.arm.is_some() {
        open.push("the arm against itself, the part and the cell; its load");
    } else if has_no_end {
        open.push("the travel of programs: an axis has no min or no max in [axes]");
    } else if machine.work_zero.is_none() {
        open.push("where programs stand in the travel: work_zero is missing, their size alone is compared with it");
    }
    open.push("whether the machine does what the words of the blocks say: post a program that you know, and read it");
    open
}

/// Prints a file with the keys that it lacks, where it is older than they are.
fn upgrade(file: &str) -> Result<Answer, Stop> {
    let machine = toolpath::machine(file)?;
    let missing = machine::upgrade::missing(&machine);
    let text = if missing.is_empty() {
        String::from("nothing is missing\n")
    } else if machine::is_path(file) {
        let bytes = files::read(Path::new(file))?;
        let old = encoding::utf_8(&bytes).map_err(|found| found.file(file))?;
        machine::upgrade::upgraded(old, &missing)
    } else {
        machine::upgrade::upgraded(library_text(file)?, &missing)
    };
    let keys = missing
        .iter()
        .map(|key| json!({ "table": key.table, "line": key.line, "place": key.place }));
    let data = json!({ "machine": describe(&machine), "missing": keys.collect::<Vec<Value>>() });
    Ok(Answer::product(text, data))
}

fn library_text(name: &str) -> Result<&'static str, Stop> {
    let found = library::find(name, library::EVERYTHING).map(|(_, text)| text);
    found.ok_or_else(|| {
        let names: Vec<_> = library::names(library::EVERYTHING).collect();
        Diagnostic::error(Rule::MachineUnknown, format!("`{name}` is not in the library"))
            .help(format!("there are {}", names.join(", ")))
            .into()
    })
}
