//! `toolpost studio`: the server of the page, until Ctrl-C.

use crate::answer::Answer;
use crate::args::Studio;
use ::studio::{Server, Settings};
use app::{Stop, Verdict};
use program::{Diagnostic, Rule};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Starts the server, says its link, and answers until the process ends. Ctrl-C ends it with all its work; files that are being
/// saved are whole then.
///
/// # Errors
/// Why it did not start.
pub fn run(args: &Studio, json: bool) -> Result<Answer, Stop> {
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
    let settings = Settings { folder: folder.clone(), source, machine, port: args.port };
    let server = Server::bind(&settings)?;
    let link = server.link();
    let text = format!("{link}\n");
    let data = json!({ "link": link, "port": server.port() });
    Answer::summary(Verdict::Done, text, data).say(false, json);
    if !args.no_open
        && let Err(why) = server.show()
    {
        eprintln!("no browser was opened ({why}): open the link in one");
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
