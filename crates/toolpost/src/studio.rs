//! `toolpost studio`: the server of the page, until Ctrl-C.

use crate::answer::Answer;
use crate::args::glass::Glass;
use crate::args::{Closeness, Command, CommandLine, Studio};
use crate::settings::{self, Expanded};
use ::studio::ask::{self, Field};
use ::studio::board::Settings;
use ::studio::server::{More, SETTINGS};
use ::studio::{Options, Server};
use app::helper::Launcher;
use app::{Source, Stop, Verdict};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, ArgAction, CommandFactory, Parser};
use program::{Diagnostic, Rule};
use serde_json::json;
use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Starts the server, says its link, and answers until the process ends. Ctrl-C ends it with all its work; files that are being
/// saved are whole then.
///
/// # Errors
/// Why it did not start.
pub fn run(args: &Studio, json: bool, helper: Option<Launcher>) -> Result<Answer, Stop> {
    if !::studio::has_page() {
        let message = "this command was built without the page of the studio";
        return Err(Diagnostic::error(Rule::StudioPage, message).into());
    }
    let folder = folder(args);
    let within = |path: &Path| below(&folder, path);
    let machine = match &args.machine {
        Some(name) if machine::is_path(name) => Some(within(Path::new(name))?),
        name => name.clone(),
    };
    let source = args.source.as_deref().map(within).transpose()?;
    let settings = ::studio::Settings {
        folder: folder.clone(),
        source,
        machine,
        port: args.port,
        form: Some(form),
        options: Some(options),
        helper,
    };
    let server = Server::bind(&settings)?;
    let link = server.link();
    let text = format!("{link}\n");
    let data = json!({ "link": link, "port": server.port() });
    Answer::summary(Verdict::Done, text, data).say(false, json);
    if !args.no_open
        && let Err(why) = server.show()
    {
        let _ = writeln!(std::io::stderr(), "no browser was opened ({why}): open the link in one");
    }
    server.run()
}

/// The folder that is named, that of the source, or this one.
fn folder(args: &Studio) -> PathBuf {
    let of_source = args.source.as_deref().and_then(Path::parent);
    let folder = args.folder.as_deref().or(of_source).filter(|path| !path.as_os_str().is_empty());
    folder.unwrap_or(Path::new(".")).to_owned()
}

/// The path of a file below the folder.
///
/// # Errors
/// It is not there, or lies elsewhere.
fn below(folder: &Path, path: &Path) -> Result<String, Stop> {
    let refused = |rule, message: String| {
        Stop::from(Diagnostic::error(rule, message).file(path.display().to_string()))
    };
    let whole = path.canonicalize();
    let whole = whole.map_err(|error| {
        let found = Diagnostic::error(Rule::Unreadable, format!("cannot be read: {error}"));
        found.help("give the name of a file that is there").file(path.display().to_string())
    })?;
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let inner = whole.strip_prefix(&folder).ok().and_then(Path::to_str);
    let inner = inner.ok_or_else(|| {
        let name = folder.display();
        refused(Rule::FolderReach, format!("lies outside of the folder of the studio, {name}"))
    })?;
    Ok(inner.replace(std::path::MAIN_SEPARATOR, "/"))
}

/// Arguments that the page gives by itself, or does by itself.
const GIVEN: [&str; 13] = [
    "machine", "output", "path", "board", "help", "picture", "select", "bodies", "cloud", "camera",
    "distance", "zoom", "grid",
];

fn name(command: ask::Command) -> &'static str {
    match command {
        ask::Command::Post => "post",
        ask::Command::Wire => "wire",
        ask::Command::Pcb => "pcb",
        ask::Command::Glass => "glass",
    }
}

/// The form of the options of a command.
fn form(command: ask::Command) -> Vec<Field> {
    let all = CommandLine::command();
    let own = all.find_subcommand(name(command));
    let arguments = own.into_iter().flat_map(|command| command.get_arguments());
    let arguments = arguments
        .filter(|arg| !GIVEN.contains(&arg.get_id().as_str()) && !arg.is_global_set())
        .filter_map(field);
    let file = (command == ask::Command::Post).then(|| Field {
        name: OUTPUT.to_owned(),
        help: "Name of the program's file, where it is not that of the source: a robot's program calls itself by it.".to_owned(),
        value: Some(String::from("NAME")),
        values: Vec::new(),
        default: None,
        group: None,
        repeats: false,
    });
    arguments.chain(file).collect()
}

/// The option that says the name of the program's file: the page says in which folder it is saved.
const OUTPUT: &str = "output";

/// Checks the name of a program's file.
///
/// # Errors
/// It is none, or a path.
fn file_name(name: &str) -> Result<(), Stop> {
    let is_plain = |sign: char| !sign.is_control() && !"/\\:".contains(sign);
    if !name.starts_with('.') && (1..=100).contains(&name.len()) && name.chars().all(is_plain) {
        return Ok(());
    }
    let found = Diagnostic::error(Rule::StudioAsk, "--output is no name of a file");
    Err(found.help("give a name without folders: the folder is asked for when it is saved").into())
}

fn field(arg: &Arg) -> Option<Field> {
    let takes = arg.get_action().takes_values();
    let value = arg.get_value_names().filter(|_| takes).and_then(|names| names.first());
    let values = arg.get_possible_values().into_iter().filter(|_| takes).map(|value| {
        let help = value.get_help().map(ToString::to_string).unwrap_or_default();
        (value.get_name().to_owned(), help)
    });
    let default = arg.get_default_values().first().filter(|_| takes);
    Some(Field {
        name: arg.get_long()?.to_owned(),
        help: arg.get_help().map(ToString::to_string).unwrap_or_default(),
        value: value.map(ToString::to_string),
        values: values.collect(),
        default: default.map(|value| value.to_string_lossy().into_owned()),
        group: arg.get_help_heading().map(str::to_owned),
        repeats: matches!(arg.get_action(), ArgAction::Append),
    })
}

/// The options that a command cannot do without and that were not given.
fn missing(usage: &clap::Error) -> Option<String> {
    let Some(ContextValue::Strings(names)) = usage.get(ContextKind::InvalidArg) else {
        return None;
    };
    let name = |usage: &String| usage.split(' ').next().unwrap_or_default().to_owned();
    let is_missing = usage.kind() == ErrorKind::MissingRequiredArgument;
    is_missing.then(|| names.iter().map(name).collect::<Vec<_>>().join(", "))
}

/// Whether this option is the one that was not understood, and its value a number with a decimal comma.
fn has_comma(usage: &clap::Error, (name, value): &(String, String)) -> bool {
    let Some(ContextValue::String(wrong)) = usage.get(ContextKind::InvalidArg) else {
        return false;
    };
    let is_it = wrong.split(' ').next() == Some(&format!("--{name}"));
    let is_whole = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let parts = value.trim().trim_start_matches('-').split_once(',');
    is_it && parts.is_some_and(|(whole, behind)| is_whole(whole) && is_whole(behind))
}

/// What options of the form mean, with those of a file beside the board: they are read as the command line reads them.
///
/// # Errors
/// As there.
fn options(
    command: ask::Command,
    given: &[(String, String)],
    more: Option<&More>,
) -> Result<Options, Stop> {
    let form = form(command);
    let begin = ["toolpost", name(command), "--machine=m", "--output=o"];
    let mut file = None;
    let mut words: Vec<String> = begin.map(str::to_owned).to_vec();
    // What the file says that this option names comes with it.
    for (name, value) in given.iter().filter(|(name, _)| more.is_none() || name != SETTINGS) {
        let field = form.iter().find(|field| field.name == *name).ok_or_else(|| {
            let message =
                format!("there is no option `{}`", name.chars().take(80).collect::<String>());
            Diagnostic::error(Rule::StudioAsk, message)
        })?;
        if name == OUTPUT {
            file_name(value)?;
            file = Some(value.clone());
            continue;
        }
        words.push(match field.value {
            Some(_) => format!("--{name}={value}"),
            None if value.is_empty() => format!("--{name}"),
            None => {
                let message = format!("the option `{name}` is on or off: it takes no value");
                let found = Diagnostic::error(Rule::StudioAsk, message);
                return Err(found.help("leave it out to switch it off").into());
            }
        });
    }
    words.extend(["--", "source"].map(str::to_owned));
    let words: Vec<OsString> = words.into_iter().map(Into::into).collect();
    let (words, found, stated) = match more {
        Some(More { file, is_asked }) if *is_asked || file.name() == app::pcb::SETTINGS[0] => {
            let Expanded { words, found, stated, .. } = settings::with(words, file)?;
            let stated: Vec<&str> =
                stated.iter().map(|word| word.trim_start_matches('-')).collect();
            let row = format!("{} from {}", stated.join(" "), file.path().display());
            (words, found, (!stated.is_empty()).then_some(row))
        }
        Some(More { file, .. }) => (words, vec![settings::unused(file.path())], None),
        None => (words, Vec::new(), None),
    };
    let parsed = CommandLine::try_parse_from(&words).map_err(|usage| {
        let missing = missing(&usage);
        if let Some((name, value)) = given.iter().find(|given| has_comma(&usage, given)) {
            let message = format!("--{name} is {value}, with a comma");
            let found = Diagnostic::error(Rule::StudioAsk, message);
            let point = value.replace(',', ".");
            return found.help(format!("write the decimal point: {point}"));
        }
        let found = crate::misused(usage, Rule::StudioAsk);
        match missing {
            Some(names) => found.help(format!("set {names}")),
            None => found.help("correct the option in the form"),
        }
    })?;
    let of = |source: &crate::args::Source, closeness: &Closeness, machine, wire| Options {
        strict: source.strict,
        origin: source.origin.origin(),
        tolerances: closeness.tolerances(),
        machine,
        wire,
        file: None,
        board: None,
        glass: None,
    };
    match parsed.command {
        Command::Post(post) => {
            Ok(Options { file, ..of(&post.source, &post.closeness, post.option, None) })
        }
        Command::Wire(wire) => {
            let settings = wire.settings()?;
            Ok(of(&wire.source, &wire.closeness, Vec::new(), Some(settings)))
        }
        Command::Pcb(pcb) => {
            let named = pcb.files.named().into_iter();
            let board = Settings {
                plan: pcb.plan(),
                heights: pcb.running.heights.clone().map(Source::File),
                named: named.map(|(file, layer)| (Source::File(file), layer)).collect(),
                typed: settings::options(&words),
                stated,
                found,
            };
            Ok(Options {
                strict: pcb.strict,
                tolerances: pcb.closeness.tolerances(),
                machine: pcb.option,
                board: Some(Box::new(board)),
                ..Options::default()
            })
        }
        Command::Glass(glass) => Ok(Options {
            glass: match *glass {
                Glass::Engrave(engraved) => Some(Box::new(engraved.settings(Instant::now()))),
                Glass::Command(_) => None,
            },
            ..Options::default()
        }),
        _ => Ok(Options::default()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_form_has_the_options_of_post_and_none_that_the_page_gives() {
        let form = form(ask::Command::Post);
        let named = |name: &str| form.iter().find(|field| field.name == name);
        for given in ["machine", "json", "quiet", "help"] {
            assert_eq!(named(given), None);
        }
        // A name: the page asks for the folder when the program is saved.
        assert_eq!(named("output").unwrap().value.as_deref(), Some("NAME"));
        let units = named("units").unwrap();
        assert_eq!(units.value.as_deref(), Some("UNIT"));
        assert_eq!(units.values[1], (String::from("inch"), String::from("Inches")));
        assert_eq!(units.group.as_deref(), Some("NC program as the source"));
        assert_eq!(
            (named("strict").unwrap().value.clone(), named("accept").unwrap().repeats),
            (None, true)
        );
    }

    #[test]
    fn options_are_read_as_the_command_line_reads_them() {
        let given = |list: &[(&str, &str)]| {
            let list: Vec<_> = list.iter().map(|(a, b)| (a.to_string(), b.to_string())).collect();
            options(ask::Command::Post, &list, None)
        };
        let read = given(&[
            ("strict", ""),
            ("from", "fanuc-31i"),
            ("tolerance", "0.02"),
            ("option", "a=b"),
        ]);
        let read = read.unwrap();
        assert!(read.strict);
        assert_eq!(read.origin.from.as_deref(), Some("fanuc-31i"));
        assert_eq!(read.tolerances.position, Some(0.02));
        assert_eq!(read.machine, [(String::from("a"), String::from("b"))]);
        assert_eq!(read.file, None);
        assert_eq!(given(&[("output", "a_b")]).unwrap().file.as_deref(), Some("a_b"));
        for wrong in [
            ("units", "yards"),
            ("tolerance", "5"),
            ("machine", "x"),
            ("output", "/etc/x"),
            ("output", "..\\x"),
            ("output", ""),
            ("strict", "1"),
            ("no", ""),
        ] {
            let stop = given(&[wrong]).unwrap_err();
            assert!(stop.findings[0].rule == "studio-ask", "{wrong:?}: {:?}", stop.findings);
        }
        // A comma stands between values, also where a decimal point is meant.
        for (name, value, point) in [("tool", "0,4", "0.4"), ("depth", "1,5", "1.5")] {
            let given = [(name.to_owned(), value.to_owned())];
            let stop = options(ask::Command::Pcb, &given, None).unwrap_err();
            assert_eq!(stop.findings[0].message, format!("--{name} is {value}, with a comma"));
            assert_eq!(stop.findings[0].help, format!("write the decimal point: {point}"));
        }
        let stop = options(ask::Command::Pcb, &[("at".into(), "0,x".into())], None).unwrap_err();
        assert!(!stop.findings[0].message.contains("with a comma"), "{:?}", stop.findings);
        let list = [("tool", "8mil"), ("only", "front,drill"), ("drill", "b.drl"), ("strict", "")];
        let list: Vec<_> = list.iter().map(|(a, b)| (a.to_string(), b.to_string())).collect();
        let read = options(ask::Command::Pcb, &list, None).unwrap();
        let board = read.board.unwrap();
        assert!(read.strict);
        assert_eq!(board.plan.isolation.tool, Some(0.2032));
        assert_eq!(board.plan.only.len(), 2);
        assert_eq!(board.named[0].0.path(), Path::new("b.drl"));
        // As the report keeps them for a later proof.
        assert_eq!(board.typed, ["--drill=b.drl", "--only=front", "--only=drill", "--tool=8mil"]);
        for given in ["output", "picture", "machine"] {
            assert!(
                options(ask::Command::Pcb, &[(given.to_owned(), "x".to_owned())], None).is_err()
            );
        }
        // What stands in the file beside the board counts less, and what it names lies where it does.
        let beside = "tool = 0.5\npasses = 3\nheights = \"map.txt\"\nmachine = \"other\"\n";
        let more = |name: &str, text: &str, is_asked| More {
            file: Source::memory(name, text.as_bytes()),
            is_asked,
        };
        let beside = more("lamp/toolpost.toml", beside, false);
        let board = options(ask::Command::Pcb, &list, Some(&beside)).unwrap().board.unwrap();
        assert_eq!(board.plan.isolation.tool, Some(0.2032));
        assert_eq!(board.plan.isolation.passes, 3);
        assert_eq!(board.heights.unwrap().path(), Path::new("lamp/map.txt"));
        // What counts of it is said.
        let stated = "passes=3 heights=lamp/map.txt from lamp/toolpost.toml";
        assert_eq!(board.stated.as_deref(), Some(stated));
        // A project of pcb2gcode is used where it is asked for, and else it is said that it is not.
        let project = "metric=true\nmill-diameters=0.3\nextra-passes=2\n";
        let read = |is_asked| {
            let more = more("a64/millproject", project, is_asked);
            let list = if is_asked {
                vec![(SETTINGS.to_owned(), "a64/millproject".to_owned())]
            } else {
                Vec::new()
            };
            let board = options(ask::Command::Pcb, &list, Some(&more)).unwrap().board.unwrap();
            let rules = board.found.iter().map(|found| found.rule.name()).collect::<Vec<_>>();
            (board.plan.isolation.passes, rules)
        };
        assert_eq!(read(false), (1, vec!["file-unused"]));
        assert_eq!(read(true), (3, vec![]));
        let wrong = more("lamp/toolpost.toml", "passes = 3\nwidth = 2\n", false);
        let stop = options(ask::Command::Pcb, &list, Some(&wrong)).unwrap_err();
        let found = &stop.findings[0];
        assert_eq!(
            (found.rule.name(), &*found.file, found.line),
            ("settings-key", "lamp/toolpost.toml", 2)
        );
        let side = [(String::from("side"), String::from("inside"))];
        let wire = options(ask::Command::Wire, &side, None).unwrap().wire.unwrap();
        assert_eq!(wire.cutting.side, Some(wire::cutting::Side::Inside));
        assert!(options(ask::Command::Post, &side, None).is_err());
        // Of glass those of a job, and not where the command saves and how it draws.
        let form = form(ask::Command::Glass);
        let named = |name: &str| form.iter().any(|field| field.name == name);
        assert!(["block", "material", "lens", "order", "place"].into_iter().all(named));
        for given in ["bodies", "machine", "output", "cloud", "picture", "camera", "zoom"] {
            assert!(!named(given), "{given}");
        }
        let list = [("block", "20x20x30"), ("material", "k9"), ("lens", "70"), ("order", "arcs")];
        let list: Vec<_> = list.iter().map(|(a, b)| (a.to_string(), b.to_string())).collect();
        let glass = options(ask::Command::Glass, &list, None).unwrap().glass.unwrap();
        assert_eq!((glass.job.placing.block, &*glass.material), ([20.0, 20.0, 30.0], "k9"));
        let stop = options(ask::Command::Glass, &list[1..], None).unwrap_err();
        assert_eq!(stop.findings[0].help, "set --block");
        // What looks like another option is a value.
        assert_eq!(
            given(&[("from", "--strict")]).unwrap().origin.from.as_deref(),
            Some("--strict")
        );
    }

    #[test]
    fn it_does_not_start_without_its_page_nor_with_a_source_elsewhere() {
        let folder = Some(std::env::temp_dir().join("nothing-of-this-name"));
        let args = |source: &str| Studio {
            source: Some(source.into()),
            machine: None,
            folder: folder.clone(),
            port: None,
            no_open: true,
        };
        for (source, rule) in [("missing.cls", Rule::Unreadable), ("Cargo.toml", Rule::FolderReach)]
        {
            let expected = if ::studio::has_page() { rule } else { Rule::StudioPage };
            let found = run(&args(source), false, None).unwrap_err().findings.remove(0);
            assert_eq!(found.rule, expected, "{found}");
            assert!(!found.help.is_empty());
        }
    }
}
