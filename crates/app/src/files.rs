//! Files: read whole, and written whole or not at all.
//!
//! New contents are written under a name of their own in the folder of the file, and renamed at the end. Whoever does
//! that has locked the folder, so that of two commands that save the same files one saves all of them. The system
//! opens the lock of a process that is killed; what such a process left is removed by the next one that is to save there,
//! when it begins, whatever comes of it.

use program::{Diagnostic, Rule, encoding};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::{Builder, NamedTempFile};

/// The largest file that is read, bytes: more lines than a line number counts.
const LARGEST: u64 = 4 << 30;

/// The bytes of a file.
///
/// # Errors
/// Where it cannot be opened, is no file (a folder, a device), or is larger than the memory or 4 GiB.
pub fn read(path: &Path) -> Result<Vec<u8>, Box<Diagnostic>> {
    let unreadable = |why: String| {
        let found = about(path, Rule::Unreadable, format!("cannot be read: {why}"));
        found.help("give the name of a file that is there and may be read")
    };
    // Looked at before it is opened: opening a pipe would wait for ever.
    let metadata = fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
    if !metadata.is_file() {
        return Err(unreadable(String::from("it is not a file")).into());
    }
    if metadata.len() > LARGEST {
        return Err(unreadable(format!("it is larger than {} GiB", LARGEST >> 30)).into());
    }
    let mut bytes = Vec::new();
    let room = usize::try_from(metadata.len()).unwrap_or(usize::MAX);
    bytes.try_reserve_exact(room).map_err(|error| unreadable(error.to_string()))?;
    let file = File::open(path).map_err(|error| unreadable(error.to_string()))?;
    // A file that grows while it is read ends where it ended.
    file.take(metadata.len()).read_to_end(&mut bytes).map_err(|e| unreadable(e.to_string()))?;
    Ok(bytes)
}

/// The text of a file, without the byte order mark that editors of some systems put before UTF-8.
///
/// # Errors
/// As [`read`], and as [`text_of`].
pub fn text(path: &Path) -> Result<Vec<u8>, Box<Diagnostic>> {
    Ok(text_of(path, Cow::Owned(read(path)?))?.into_owned())
}

/// The same of the bytes of the file `path`.
///
/// # Errors
/// The text is in UTF-16.
pub fn text_of<'b>(path: &Path, bytes: Cow<'b, [u8]>) -> Result<Cow<'b, [u8]>, Box<Diagnostic>> {
    if encoding::is_utf_16(&bytes) {
        return Err(encoding::utf_16().file(name(path)).into());
    }
    Ok(match bytes {
        Cow::Borrowed(bytes) => Cow::Borrowed(encoding::without_mark(bytes)),
        Cow::Owned(mut bytes) => {
            bytes.drain(..bytes.len() - encoding::without_mark(&bytes).len());
            Cow::Owned(bytes)
        }
    })
}

/// The name of a file, for findings and reports: without its folder, so that they do not depend on
/// where it lies.
pub fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// Where the report of the program `program` is saved: under its name and one more ending, so that `part.nc` and
/// `part.h` have a report each.
pub fn report_of(program: &Path) -> PathBuf {
    let mut name = program.as_os_str().to_owned();
    name.push(".report.json");
    PathBuf::from(name)
}

/// A place where a file will be saved, looked at before the work begins.
#[derive(Debug)]
pub struct Target {
    /// The path as it was given.
    given: PathBuf,
    /// The file itself, links followed.
    path: PathBuf,
    folder: PathBuf,
}

impl Target {
    /// The file `path`, which must be none of `inputs`.
    ///
    /// # Errors
    /// Where its folder is missing, it is no ordinary file or may not be written, or it is one of the inputs, by
    /// whatever links.
    pub fn new(path: &Path, inputs: &[&Path]) -> Result<Target, Box<Diagnostic>> {
        let refused = |rule, why: &str, way_out: &str| {
            Err(about(path, rule, format!("cannot be saved: {why}")).help(way_out).into())
        };
        if path.file_name().is_none() {
            return refused(Rule::OutputFile, "it names no file", "give a file name");
        }
        let existing = fs::metadata(path);
        let linked = fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_symlink());
        let resolved = match &existing {
            Ok(metadata) if !metadata.is_file() => {
                return refused(Rule::OutputFile, "it is not a file", "give the name of a file");
            }
            Ok(metadata) if metadata.permissions().readonly() => {
                let way_out = "allow writing to it, or give another name";
                return refused(Rule::OutputFile, "it is there already, and read-only", way_out);
            }
            Ok(_) => fs::canonicalize(path).unwrap_or_else(|_| path.to_owned()),
            Err(_) if linked => {
                return refused(Rule::OutputFile, "it is a link to nothing", "remove the link");
            }
            Err(_) => path.to_owned(),
        };
        let folder = match resolved.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
            _ => PathBuf::from("."),
        };
        if !folder.is_dir() {
            let why = format!("there is no folder {}", folder.display());
            return refused(Rule::OutputFolder, &why, "make the folder first");
        }
        let target = Target { given: path.to_owned(), path: resolved, folder };
        target.spare(inputs)?;
        sweep_idle(&target.folder);
        Ok(target)
    }

    /// Checks that it is none of `inputs`: for those that are known only once the work has begun.
    ///
    /// # Errors
    /// It is one of them, by whatever links.
    pub fn spare(&self, inputs: &[impl AsRef<Path>]) -> Result<(), Box<Diagnostic>> {
        match inputs.iter().find(|input| same_file(&self.path, input.as_ref())) {
            Some(input) => {
                let message = format!("cannot be saved: it is the input {}", name(input.as_ref()));
                Err(about(&self.given, Rule::OutputFile, message).help("give another name").into())
            }
            None => Ok(()),
        }
    }

    fn full(&self, error: &io::Error) -> Diagnostic {
        about(&self.given, Rule::OutputFile, format!("cannot be saved: {error}"))
            .help("nothing was changed; make room or give another folder")
    }

    /// A file in the same folder, gone when it is dropped.
    fn temporary(&self) -> io::Result<NamedTempFile> {
        let mut builder = Builder::new();
        builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let ordinary = fs::Permissions::from_mode(0o666);
            let same = fs::metadata(&self.path).map(|metadata| metadata.permissions());
            builder.permissions(same.unwrap_or(ordinary));
        }
        builder.tempfile_in(&self.folder)
    }
}

/// Whether a folder is there or can be made.
///
/// # Errors
/// Where something else has its name, or the folder that it would be in is missing.
pub fn check_folder(path: &Path) -> Result<(), Box<Diagnostic>> {
    let refused = |why: String, help: &str| {
        let message = format!("cannot be the folder of the output: {why}");
        Err(about(path, Rule::OutputFolder, message).help(help).into())
    };
    if path.is_dir() {
        return Ok(());
    }
    if fs::symlink_metadata(path).is_ok() {
        return refused(String::from("it is not a folder"), "give another name");
    }
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() && !parent.is_dir() => {
            refused(format!("there is no folder {}", parent.display()), "make that folder first")
        }
        _ => Ok(()),
    }
}

/// A folder for output. One that was made for it goes again, unless it is kept.
#[derive(Debug)]
pub struct Folder {
    /// The folder, where it was made.
    new: Option<PathBuf>,
}

/// The folder `path`, made where it is missing.
///
/// # Errors
/// As [`check_folder`], and where it cannot be made.
pub fn folder(path: &Path) -> Result<Folder, Box<Diagnostic>> {
    check_folder(path)?;
    if path.is_dir() {
        return Ok(Folder { new: None });
    }
    fs::create_dir(path).map_err(|error| {
        let message = format!("the folder cannot be made: {error}");
        about(path, Rule::OutputFolder, message).help("give another folder")
    })?;
    Ok(Folder { new: Some(path.to_owned()) })
}

impl Folder {
    /// It stays.
    pub fn keep(mut self) {
        self.new = None;
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if let Some(folder) = &self.new {
            // Only when it is empty; what else is in it is not ours.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// What the name of a file begins and ends with until all of it is written.
const TEMPORARY: (&str, &str) = (".toolpost-", ".tmp");

/// Held while files are saved.
static SAVING: Mutex<()> = Mutex::new(());

/// Waits until no file is being saved, and keeps others from beginning: who holds it may end the process.
pub fn saved() -> MutexGuard<'static, ()> {
    SAVING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What is removed when the process ends.
static AT_END: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Has files removed by [`remove_left`], and folders where nothing is in them then.
pub fn remove_at_end(paths: impl IntoIterator<Item = PathBuf>) {
    AT_END.lock().unwrap_or_else(PoisonError::into_inner).extend(paths);
}

/// Removes what is not to outlast the process: for whoever ends it.
pub fn remove_left() {
    let paths = std::mem::take(&mut *AT_END.lock().unwrap_or_else(PoisonError::into_inner));
    for path in paths {
        // What is gone already is as it should be; what cannot be removed stays.
        let _ = fs::remove_file(&path).or_else(|_| fs::remove_dir(&path));
    }
}

/// Folders in which nobody else saves anything meanwhile.
struct Locked {
    /// Their locks, which end with the process at the latest.
    _folders: Vec<File>,
}

impl Locked {
    /// Locks the folders of `files`, waiting for others, and removes what killed processes have left there. A folder
    /// that the system cannot lock is left as it is.
    fn of<'t>(files: impl Iterator<Item = &'t Target>) -> Locked {
        // In the same order by everybody: nobody waits for who waits for him.
        let folders: BTreeSet<PathBuf> =
            files.filter_map(|target| fs::canonicalize(&target.folder).ok()).collect();
        let locked = folders.into_iter().filter_map(|path| {
            let folder = File::open(&path).ok()?;
            folder.lock().ok()?;
            sweep(&path);
            Some(folder)
        });
        Locked { _folders: locked.collect() }
    }
}

/// Removes the files that a killed process has begun in a folder, unless somebody is saving there now.
pub fn sweep_idle(folder: &Path) {
    let Ok(locked) = File::open(folder) else { return };
    if locked.try_lock().is_ok() {
        sweep(folder);
    }
}

/// Checks that the system lets this process write a file of so many bytes (`ulimit -f`): a larger one would end the process by
/// a signal (SIGXFSZ), without a word.
///
/// # Errors
/// It does not.
pub fn check_size(bytes: usize) -> io::Result<()> {
    #[cfg(unix)]
    {
        use rustix::process::{Resource, getrlimit};
        let most = getrlimit(Resource::Fsize).current.unwrap_or(u64::MAX);
        if bytes as u64 > most {
            let why =
                format!("it has {bytes} bytes, and this process may write {most} (`ulimit -f`)");
            return Err(io::Error::other(why));
        }
    }
    Ok(())
}

/// Removes the files that a killed process has begun in a folder. Nobody else may be saving there.
fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let begun = name.strip_prefix(TEMPORARY.0).and_then(|name| name.strip_suffix(TEMPORARY.1));
        let ours = begun.is_some_and(|middle| middle.bytes().all(|b| b.is_ascii_alphanumeric()));
        if ours && entry.file_type().is_ok_and(|kind| kind.is_file()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Saves all of the files or, where one cannot be saved, none: what was there before stays. A copy of
/// what is there is kept of all but the last, so the largest should be the last.
///
/// # Errors
/// The file that could not be saved, and why.
pub fn save(files: &[(&Target, &[u8])]) -> Result<(), Box<Diagnostic>> {
    let _saving = saved();
    let _locked = Locked::of(files.iter().map(|(target, _)| *target));
    let mut staged = Vec::with_capacity(files.len());
    for (i, (target, bytes)) in files.iter().enumerate() {
        let kept = i + 1 < files.len() && target.path.exists();
        let stage = || -> io::Result<_> {
            check_size(bytes.len())?;
            let mut new = target.temporary()?;
            new.write_all(bytes)?;
            let old = kept.then(|| target.temporary()).transpose()?;
            if let Some(old) = &old {
                fs::copy(&target.path, old.path())?;
            }
            Ok((*target, new, old))
        };
        staged.push(stage().map_err(|error| target.full(&error))?);
    }
    // Asked for when all are written, most of them are safe with the first.
    for (target, new, _) in &staged {
        new.as_file().sync_all().map_err(|error| target.full(&error))?;
    }
    let mut saved: Vec<(&Target, Option<NamedTempFile>)> = Vec::with_capacity(files.len());
    for (target, new, old) in staged {
        if let Err(error) = new.persist(&target.path) {
            for (target, old) in saved {
                let _ = match old {
                    Some(old) => old.persist(&target.path).map(drop).map_err(|e| e.error),
                    None => fs::remove_file(&target.path),
                };
            }
            return Err(target.full(&error.error).into());
        }
        saved.push((target, old));
    }
    let folders: BTreeSet<&Path> = saved.iter().map(|(target, _)| &*target.folder).collect();
    for folder in folders {
        // The names are safe once the folder is; where that cannot be asked for, nothing is lost.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
    Ok(())
}

/// Checks that the files which the program at `path` calls are saved over nothing but such files of its own: its report, where it
/// has been saved before, names them.
///
/// # Errors
/// The first that is there already and belongs to another program, or to nobody knows which.
pub fn are_own(path: &Path, parts: &[&str]) -> Result<(), Box<Diagnostic>> {
    let others: Vec<PathBuf> =
        parts.iter().map(|part| path.with_file_name(part)).filter(|part| part.exists()).collect();
    if others.is_empty() {
        return Ok(());
    }
    let own = parts_in(&report_of(path));
    match others.iter().find(|other| !own.contains(&name(other))) {
        Some(other) => {
            let message = "it is there already, and the report beside the program does not name it as one of its parts";
            let help = "move it away, or give the program another name";
            Err(about(other, Rule::OutputFile, message.into()).help(help).into())
        }
        None => Ok(()),
    }
}

/// The parts that a report names; none where there is none, or it is not read.
fn parts_in(report: &Path) -> Vec<String> {
    let report = read(report).unwrap_or_default();
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap_or_default();
    let parts = report["program"]["parts"].as_array().into_iter().flatten();
    parts.filter_map(|part| part["file"].as_str().map(str::to_owned)).collect()
}

/// The ending of a file, in small letters; empty where it has none.
pub fn ending(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// Names files of the program that has been saved at `path` before, which the new one with these `parts` does not call any more; `None` where there are none.
pub fn parts_left(path: &Path, parts: &[&str]) -> Option<Diagnostic> {
    let mut left = parts_in(&report_of(path));
    left.retain(|part| !parts.contains(&&**part) && path.with_file_name(part).is_file());
    (!left.is_empty()).then(|| {
        let message = format!(
            "{} of the program that was here before stay in the folder, and nothing calls them",
            left.join(", ")
        );
        let found = Diagnostic::warning(Rule::OutputFile, message);
        found.help("remove them, and from the controller").file(name(path))
    })
}

/// Checks that a program at `path` does not take the place of a part of another one beside it.
///
/// # Errors
/// It would.
pub fn is_no_part(path: &Path) -> Result<(), Box<Diagnostic>> {
    let own = name(path);
    let cut = |name: &str| name.replace('-', "_").to_ascii_lowercase();
    // A part has the first letters of the program that calls it, and a number.
    let Some((begins, _)) = own.rsplit_once('_').filter(|_| path.is_file()) else { return Ok(()) };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let Ok(entries) = std::fs::read_dir(folder.unwrap_or(Path::new("."))) else { return Ok(()) };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut names: Vec<String> = names
        .filter(|name| name.ends_with(".report.json") && cut(name).starts_with(&cut(begins)))
        .collect();
    names.sort_unstable();
    let calls = |report: &&String| parts_in(&path.with_file_name(report)).contains(&own);
    match names.iter().find(calls) {
        Some(report) => {
            let message = format!("it is there already, and a part of the program of {report}");
            let help = "give the program another name";
            Err(about(path, Rule::OutputFile, message).help(help).into())
        }
        None => Ok(()),
    }
}

/// Saves a program at `path`, the files that it calls beside it, and its report under [`report_of`] that name: all or none, and over
/// none of `inputs`.
///
/// # Errors
/// Why nothing was saved.
pub fn save_program(
    path: &Path,
    text: &[u8],
    parts: &[(&str, &[u8])],
    report: Option<&str>,
    inputs: &[&Path],
) -> Result<(), Box<Diagnostic>> {
    let target = Target::new(path, inputs)?;
    is_no_part(path)?;
    are_own(path, &parts.iter().map(|(file, _)| *file).collect::<Vec<_>>())?;
    let report = report.map(|report| (report_of(path), report.as_bytes()));
    let others = parts.iter().map(|(file, text)| (path.with_file_name(file), *text)).chain(report);
    let others = others.map(|(path, bytes)| Ok((Target::new(&path, inputs)?, bytes)));
    let others = others.collect::<Result<Vec<_>, Box<Diagnostic>>>()?;
    let mut files: Vec<(&Target, &[u8])> =
        others.iter().map(|(target, bytes)| (target, *bytes)).collect();
    files.push((&target, text));
    save(&files)
}

/// Saves files in a folder, which is made where it is missing: all or none, and over none of `inputs`.
///
/// # Errors
/// Why nothing was saved.
pub fn save_in(
    path: &Path,
    contents: &[(String, &[u8])],
    inputs: &[&Path],
) -> Result<(), Box<Diagnostic>> {
    let made = folder(path)?;
    let target = |(name, _): &(String, &[u8])| Target::new(&path.join(name), inputs);
    let targets = contents.iter().map(target).collect::<Result<Vec<_>, _>>()?;
    let bytes = contents.iter().map(|(_, bytes)| *bytes);
    save(&targets.iter().zip(bytes).collect::<Vec<_>>())?;
    made.keep();
    Ok(())
}

/// A finding about a file as a whole.
fn about(path: &Path, rule: Rule, message: String) -> Diagnostic {
    Diagnostic::error(rule, message).file(path.display().to_string())
}

/// Whether two paths are one file, also by links of either kind.
fn same_file(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let identity = |path| fs::metadata(path).map(|m| (m.dev(), m.ino()));
        matches!((identity(a), identity(b)), (Ok(a), Ok(b)) if a == b)
    }
    #[cfg(not(unix))]
    {
        matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| name(&e.unwrap().path())).collect();
        names.sort();
        names
    }

    #[test]
    fn when_the_second_file_cannot_be_saved_the_first_is_as_before() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("a"), folder.path().join("b"));
        for before in [None, Some("before")] {
            if let Some(before) = before {
                fs::write(&a, before).unwrap();
            }
            let (first, second) = (Target::new(&a, &[]).unwrap(), Target::new(&b, &[]).unwrap());
            // A folder that appears after the check, so that the rename fails.
            fs::create_dir(&b).unwrap();
            fs::write(b.join("in the way"), "").unwrap();
            assert!(save(&[(&first, b"new"), (&second, b"new")]).is_err());
            fs::remove_dir_all(&b).unwrap();
            assert_eq!(fs::read_to_string(&a).ok().as_deref(), before);
            assert_eq!(names(folder.path()).len(), usize::from(before.is_some()));
        }
    }

    #[test]
    fn a_file_is_replaced_with_its_permissions_kept_and_no_other_file_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.mpf");
        fs::write(&path, "old").unwrap();
        let before = fs::metadata(&path).unwrap().permissions();
        save(&[(&Target::new(&path, &[]).unwrap(), b"new")]).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(fs::metadata(&path).unwrap().permissions(), before);
        assert_eq!(names(folder.path()), ["a.mpf"]);
    }
}
