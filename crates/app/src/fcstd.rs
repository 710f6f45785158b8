//! FreeCAD's documents as a source: the FreeCAD that is installed tells what their job is.

mod inflate;

use crate::files;
use crate::input::Source;
use crate::watch::Watch;
use program::{Diagnostic, Rule, cancelled};
use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// Our part of FreeCAD, which writes the job of the document in `TOOLPOST_FCSTD` to `TOOLPOST_JSON`.
const SCRIPT: &str = include_str!("../../../integrations/freecad/toolpost_job.py");

/// What FreeCAD without a window is called: Debian's name, and that of FreeCAD's own builds.
const PROGRAMS: [&str; 2] = ["freecadcmd", "FreeCADCmd"];

/// How long FreeCAD may take.
const LONGEST: Duration = Duration::from_secs(300);

/// How often it is looked at.
const PAUSE: Duration = Duration::from_millis(5);

/// Whether a file is called as a document of FreeCAD's.
pub fn is(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("fcstd"))
}

/// The job of a document, as JSON.
///
/// # Errors
/// There is no FreeCAD, it takes too long, or the document has no job.
pub fn job(source: &Source, watch: &dyn Watch) -> Result<Vec<u8>, Box<Diagnostic>> {
    let about = |message: String| Diagnostic::error(Rule::Freecad, message).file(source.name());
    let bytes = source.read()?;
    inflate::check(&bytes).map_err(|found| Box::new((*found).file(source.name())))?;
    let no_room = |error| about(format!("there is no room to work in: {error}"));
    let folder = tempfile::tempdir().map_err(no_room)?;
    let [script, json, said, copy] =
        ["toolpost_job.py", "job.json", "said", "copy.FCStd"].map(|name| folder.path().join(name));
    let document = match source.file() {
        Some(path) => fs::canonicalize(path)
            .map_err(|error| about(format!("cannot be read: {error}")).help("look at its name"))?,
        None => fs::write(&copy, &bytes).map(|()| copy).map_err(no_room)?,
    };
    let run = || -> io::Result<Option<ExitStatus>> {
        fs::write(&script, SCRIPT)?;
        let mut child = start(|program| {
            let output = File::create(&said)?;
            Command::new(program)
                .arg(&script)
                .current_dir(folder.path())
                .env("TOOLPOST_FCSTD", &document)
                .env("TOOLPOST_JSON", &json)
                .stdin(Stdio::null())
                .stderr(output.try_clone()?)
                .stdout(output)
                .spawn()
        })?;
        wait(&mut child, watch)
    };
    match run() {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let names = PROGRAMS.join(" or ");
            let help = "install FreeCAD, or post from its window, with the post `toolpost`";
            return Err(about(format!("FreeCAD is needed to read this, and there is no {names}"))
                .help(help)
                .into());
        }
        Err(error) => return Err(about(format!("FreeCAD cannot be run: {error}")).into()),
        Ok(None) if watch.is_cancelled() => return Err(cancelled().into()),
        Ok(None) => {
            let seconds = LONGEST.as_secs();
            let help = "post from FreeCAD's window, with the post `toolpost`";
            let message = format!("FreeCAD has not read it within {seconds} s");
            return Err(about(message).help(help).into());
        }
        Ok(Some(_)) => {}
    }
    match files::read(&json) {
        Ok(job) => Ok(job),
        Err(_) => {
            let said = fs::read(&said).unwrap_or_default();
            let said = String::from_utf8_lossy(&said);
            let last = said.lines().map(str::trim).rfind(|line| !line.is_empty());
            let message = format!("FreeCAD tells no job of it: {}", last.unwrap_or("no word"));
            let help = "open it in FreeCAD, and look at its job";
            Err(about(message).help(help).into())
        }
    }
}

/// Starts the first of the programs that is there.
fn start(spawn: impl Fn(&str) -> io::Result<Child>) -> io::Result<Child> {
    let [first, second] = PROGRAMS;
    match spawn(first) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => spawn(second),
        started => started,
    }
}

/// Waits for the end of a program, which is ended where it takes too long, or nobody waits for it any more.
fn wait(child: &mut Child, watch: &dyn Watch) -> io::Result<Option<ExitStatus>> {
    let began = Instant::now();
    while began.elapsed() < LONGEST && !watch.is_cancelled() {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        thread::sleep(PAUSE);
    }
    child.kill()?;
    child.wait()?;
    Ok(None)
}
