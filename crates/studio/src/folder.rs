//! The named folder: nothing outside it is read or written, by whatever path or link.
//!
//! Paths are those of the page: relative to the folder, with `/` between names. Every file is opened below a handle of the
//! folder (`cap-std`), so a link that is put in place meanwhile leads nowhere else. Hidden names (`.toolpost`) are not listed.

use crate::ask::{Draft, Entry, EntryKind, Finding};
use app::files;
use cap_std::ambient_authority;
use cap_std::fs::{Dir, Metadata, OpenOptions};
use program::{Diagnostic, Rule};
use std::collections::VecDeque;
use std::io::{self, Read, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// The most entries of a folder that are listed.
const MOST_ENTRIES: usize = 10_000;

/// How deep below the folder, and among how many entries, files are looked for.
const DEEPEST: usize = 4;
const MOST_LOOKED_AT: usize = 5000;

/// The largest file that is opened, bytes.
const MOST_BYTES: u64 = 1 << 30;

/// Where drafts are kept, in the named folder.
const DRAFTS: &str = ".toolpost/drafts";

/// The folder within it that is the studio's own.
const OWN: &str = ".toolpost";

/// The most drafts that are kept, and the largest, bytes.
const MOST_DRAFTS: usize = 100;
const LARGEST_DRAFT: usize = 64 << 20;

/// How a file ends that is being written, and after what time nobody does so any more.
const NEW: &str = ".new";
const LEFT: Duration = Duration::from_secs(60);

/// How a page ends that nobody but this user may read.
pub const SECRET: &str = ".html";

/// What the system answers where a path leads out.
const ESCAPES: &str = "a path led outside of the filesystem";

/// What tells without reading it that a file is another one now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    /// Whether it is a folder.
    pub is_folder: bool,
    /// Its size.
    pub bytes: u64,
    /// When it was written last; none where the system does not say.
    written: Option<SystemTime>,
    /// When it or its name was changed last.
    pub changed: Option<SystemTime>,
    /// Its number on the disk; 0 where there is none.
    number: u64,
}

/// The folder in which the studio reads and writes.
#[derive(Debug)]
pub struct Folder {
    dir: Dir,
    path: PathBuf,
    /// Held while a draft is kept: of two of one name the later one holds, text and all.
    drafting: Mutex<()>,
}

impl Folder {
    /// Opens the folder `path`.
    ///
    /// # Errors
    /// It is none, or may not be read.
    pub fn open(path: &Path) -> Result<Folder, Box<Diagnostic>> {
        let open = || {
            let path = path.canonicalize()?;
            Ok((Dir::open_ambient_dir(&path, ambient_authority())?, path))
        };
        let (dir, path) = open().map_err(|error: io::Error| {
            let message = format!("the folder cannot be opened: {error}");
            let found = Diagnostic::error(Rule::Folder, message).file(path.display().to_string());
            Box::new(found.help("give the name of a folder that is there and may be read"))
        })?;
        Ok(Folder { dir, path, drafting: Mutex::new(()) })
    }

    /// Where it lies, without links.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What it is called.
    pub fn name(&self) -> String {
        self.path.file_name().unwrap_or(self.path.as_os_str()).to_string_lossy().into_owned()
    }

    /// What is in one of its folders, folders first, and whether that is all.
    ///
    /// # Errors
    /// It leads out, or is no folder that may be read.
    pub fn list(&self, path: &str) -> Result<(Vec<Entry>, bool), Box<Diagnostic>> {
        let inner = inner(path)?;
        let unreadable = |error: io::Error| unreadable(path, &error);
        let mut entries = Vec::new();
        let mut is_whole = true;
        for entry in self.dir.read_dir(&inner).map_err(unreadable)? {
            let Ok(entry) = entry else { continue };
            // A name that is no UTF-8 cannot be asked for by the page.
            let Ok(name) = entry.file_name().into_string() else { continue };
            if name.starts_with('.') {
                continue;
            }
            if entries.len() == MOST_ENTRIES {
                is_whole = false;
                break;
            }
            // What a link that leads out, a pipe or a device has in it is nobody's to open here.
            let at = inner.join(&name);
            let Ok(metadata) = self.dir.metadata(&at) else { continue };
            let (kind, bytes) = match (metadata.is_dir(), metadata.is_file()) {
                (true, _) => (EntryKind::Folder, None),
                (_, true) => (EntryKind::File, Some(metadata.len())),
                _ => continue,
            };
            let path = spelled(&at);
            let written = metadata.modified().ok().map(cap_std::time::SystemTime::into_std);
            let written = written.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
            let written = written.map_or(0, |since| since.as_secs());
            entries.push(Entry { name, path, kind, bytes, written });
        }
        entries.sort_by(|a, b| (a.kind, &a.name).cmp(&(b.kind, &b.name)));
        Ok((entries, is_whole))
    }

    /// Up to so many files, no larger than so many bytes, whose names end so: those of the folder and of the folders in it, the nearest first. Hidden names are
    /// left out, and links are not followed further down.
    pub fn files_below(&self, ending: &str, most: usize, largest: u64) -> Vec<String> {
        let mut found = Vec::new();
        let mut folders = VecDeque::from([(PathBuf::new(), 0)]);
        let mut looked_at = 0;
        while let Some((folder, depth)) = folders.pop_front() {
            let Ok(entries) = self.dir.read_dir(at(&folder)) else { continue };
            let entries = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
            let left = MOST_LOOKED_AT - looked_at;
            let names = entries.filter(|name| !name.starts_with('.')).take(left);
            let mut names: Vec<String> = names.collect();
            looked_at += names.len();
            names.sort_unstable();
            for path in names.into_iter().map(|name| folder.join(name)) {
                let Ok(metadata) = self.dir.symlink_metadata(&path) else { continue };
                let is_meant = |to: &Metadata| {
                    path.to_string_lossy().ends_with(ending) && to.is_file() && to.len() <= largest
                };
                let is_linked = || {
                    let is_link = depth == 0 && metadata.is_symlink();
                    is_link && self.dir.metadata(&path).is_ok_and(|to| is_meant(&to))
                };
                if is_meant(&metadata) || is_linked() {
                    found.push(spelled(&path));
                    if found.len() == most {
                        return found;
                    }
                } else if metadata.is_dir() && depth < DEEPEST {
                    folders.push_back((path, depth + 1));
                }
            }
        }
        found
    }

    /// The bytes of a file.
    ///
    /// # Errors
    /// It leads out, is no file, is too large, or may not be read.
    pub fn read(&self, path: &str) -> Result<Vec<u8>, Box<Diagnostic>> {
        self.bytes(&inner(path)?, MOST_BYTES).map_err(|error| unreadable(path, &error))
    }

    /// Checks that a file can be read.
    ///
    /// # Errors
    /// As [`Folder::read`].
    pub fn check(&self, path: &str) -> Result<(), Box<Diagnostic>> {
        let opened = self.open_file(&inner(path)?, MOST_BYTES);
        opened.map(drop).map_err(|error| unreadable(path, &error))
    }

    /// The files of one of its folders, each with its path and its bytes as `read` reads it: no more than so many files and bytes.
    ///
    /// # Errors
    /// It leads out, is no folder that may be read, has more, or one of its files may not be read.
    pub fn read_all(
        &self,
        path: &str,
        files: usize,
        bytes: u64,
        read: impl Fn(&str) -> Result<Vec<u8>, Box<Diagnostic>>,
    ) -> Result<Vec<(String, Vec<u8>)>, Box<Diagnostic>> {
        let (entries, is_whole) = self.list(path)?;
        self.leads_nowhere(path)?;
        let own = entries.into_iter().filter(|entry| entry.kind == EntryKind::File);
        let own: Vec<Entry> = own.collect();
        let all: u64 = own.iter().filter_map(|entry| entry.bytes).sum();
        if !is_whole || own.len() > files || all > bytes {
            let message =
                format!("there are more than {files} files or {} MB in this folder", bytes >> 20);
            let found = Diagnostic::error(Rule::Folder, message).file(path);
            return Err(found.help("give a folder with the files of one board alone").into());
        }
        let each = own.into_iter().map(|Entry { path, .. }| {
            let bytes = read(&path)?;
            Ok((path, bytes))
        });
        each.collect()
    }

    /// Checks that no entry of one of its folders is a link that leads out: such a one is not listed.
    ///
    /// # Errors
    /// The first that is.
    fn leads_nowhere(&self, path: &str) -> Result<(), Box<Diagnostic>> {
        let inner = inner(path)?;
        let entries = self.dir.read_dir(&inner).map_err(|error| unreadable(path, &error))?;
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        let mut names: Vec<String> = names.filter(|name| !name.starts_with('.')).collect();
        names.sort_unstable();
        let leads_out = |name: &&String| {
            self.dir.metadata(inner.join(name)).is_err_and(|error| is_escape(&error))
        };
        match names.iter().find(leads_out) {
            Some(name) => Err(self::leads_out(&spelled(&inner.join(name)))),
            None => Ok(()),
        }
    }

    /// Whether a path is one of its folders.
    pub fn is_folder(&self, path: &str) -> bool {
        inner(path).is_ok_and(|inner| self.dir.metadata(inner).is_ok_and(|at| at.is_dir()))
    }

    /// A path as it is from the folder on, where it is a whole one below it.
    pub fn within<'p>(&self, path: &'p Path) -> &'p Path {
        path.strip_prefix(&self.path).unwrap_or(path)
    }

    /// A finding as the page has it: a file of the folder by its path in it.
    pub fn finding(&self, found: Diagnostic) -> Finding {
        let mut found = Finding::from(found);
        self.shorten(&mut found.file);
        found
    }

    /// Makes of the whole path of a file of the folder its path in it.
    pub fn shorten(&self, file: &mut String) {
        if let Ok(path) = Path::new(file).strip_prefix(&self.path) {
            *file = spelled(path);
        }
    }

    /// What a file, or a folder, is known by; `None` where there is none that can be reached.
    pub fn stamp(&self, path: &Path) -> Option<Stamp> {
        let metadata = self.dir.metadata(at(path)).ok()?;
        let written = metadata.modified().ok().map(cap_std::time::SystemTime::into_std);
        #[cfg(unix)]
        let (changed, number) = {
            use cap_std::fs::MetadataExt;
            let seconds = Duration::from_secs(u64::try_from(metadata.ctime()).ok()?);
            let nanoseconds = Duration::from_nanos(u64::try_from(metadata.ctime_nsec()).ok()?);
            (UNIX_EPOCH.checked_add(seconds + nanoseconds), metadata.ino())
        };
        #[cfg(not(unix))]
        let (changed, number) = (written, 0);
        let (is_folder, bytes) = (metadata.is_dir(), metadata.len());
        Some(Stamp { is_folder, bytes, written, changed, number })
    }

    /// The names of the files in a folder, in their order; hidden ones left out.
    pub(crate) fn names_of_files(&self, path: &Path) -> Option<Vec<String>> {
        let (entries, _) = self.list(&spelled(path)).ok()?;
        let files = entries.into_iter().filter(|entry| entry.kind == EntryKind::File);
        Some(files.map(|entry| entry.name).collect())
    }

    /// Whether there is something of this name, also a link that leads nowhere or out.
    pub fn has(&self, path: &str) -> bool {
        inner(path).is_ok_and(|inner| self.dir.symlink_metadata(inner).is_ok())
    }

    /// The whole path of a file of the folder that is to be written, or of one that is there.
    ///
    /// # Errors
    /// It leads out, also by a link.
    pub fn target(&self, path: &str) -> Result<PathBuf, Box<Diagnostic>> {
        let inner = inner(path)?;
        let name = inner.file_name().map(|name| name.to_string_lossy().into_owned());
        let is_blank = name.is_none_or(|name| name.trim().is_empty()) || path.ends_with('/');
        if is_blank || path.chars().any(char::is_control) || inner.starts_with(OWN) {
            let message = format!("is no name for a program: {path:?}");
            let help = "give the name of a file, without signs that cannot be seen and not in the studio's own folder";
            return Err(Diagnostic::error(Rule::OutputFile, message).help(help).into());
        }
        let parent = inner.parent().unwrap_or(Path::new(""));
        let parent = if parent.as_os_str().is_empty() { Path::new(".") } else { parent };
        self.stays_in(parent, path)?;
        self.stays_in(&inner, path)?;
        Ok(self.path.join(inner))
    }

    /// Checks that what lies at `inner`, if anything does, is in the folder; `path`: as it was given.
    fn stays_in(&self, inner: &Path, path: &str) -> Result<(), Box<Diagnostic>> {
        match self.dir.metadata(inner) {
            Err(error) if is_escape(&error) => Err(leads_out(path)),
            _ => Ok(()),
        }
    }

    /// The whole path of a folder in the folder, or of that itself, given by it or by its path in the folder.
    ///
    /// # Errors
    /// It leads out.
    pub fn inner_folder(&self, path: &Path) -> Result<PathBuf, Box<Diagnostic>> {
        let path = self.within(path).to_string_lossy();
        let inner = inner(&path)?;
        self.stays_in(&inner, &path)?;
        Ok(self.path.join(inner))
    }

    /// The drafts that are kept, by their names.
    pub fn drafts(&self) -> Vec<Draft> {
        let Ok(folder) = self.dir.open_dir(DRAFTS) else { return Vec::new() };
        let Ok(entries) = folder.entries() else { return Vec::new() };
        let mut names: Vec<String> = entries
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter_map(|name| name.strip_suffix(".json").map(str::to_owned))
            .take(MOST_DRAFTS)
            .collect();
        names.sort_unstable();
        let draft = |name: String| {
            let (of, bytes) = (self.of_draft(&name)?, self.text_of_draft(&name).ok()?.len());
            Some(Draft { name, of, bytes: bytes as u64 })
        };
        names.into_iter().filter_map(draft).collect()
    }

    fn of_draft(&self, name: &str) -> Option<serde_json::Value> {
        let bytes = self.bytes(&draft(name, "json").ok()?, LARGEST_DRAFT as u64).ok()?;
        serde_json::from_slice(&bytes).ok()
    }

    /// The text of a draft.
    ///
    /// # Errors
    /// There is none.
    pub fn text_of_draft(&self, name: &str) -> Result<Vec<u8>, Box<Diagnostic>> {
        let path = draft(name, "text")?;
        self.bytes(&path, LARGEST_DRAFT as u64).map_err(|error| unreadable(name, &error))
    }

    /// Keeps a draft: whole, or as it was before.
    ///
    /// # Errors
    /// Its name is none, it is too large, or the folder cannot be written.
    pub fn keep_draft(
        &self,
        name: &str,
        of: &serde_json::Value,
        text: &[u8],
    ) -> Result<(), Box<Diagnostic>> {
        let (json, path) = (draft(name, "json")?, draft(name, "text")?);
        let _drafting = self.drafting.lock().unwrap_or_else(PoisonError::into_inner);
        let of = of.to_string();
        if text.len() + of.len() > LARGEST_DRAFT {
            let message = "this edit is larger than 64 MB: it is not kept as a draft";
            return Err(Diagnostic::error(Rule::StudioLimit, message).help("save it often").into());
        }
        let is_draft = |entry: io::Result<cap_std::fs::DirEntry>| {
            entry.is_ok_and(|entry| entry.file_name().to_string_lossy().ends_with(".json"))
        };
        let count = || match self.dir.read_dir(DRAFTS) {
            Ok(entries) => entries.map(is_draft).filter(|is| *is).count(),
            Err(_) => 0,
        };
        if !self.dir.exists(&json) && count() >= MOST_DRAFTS {
            let message = format!("{MOST_DRAFTS} drafts are kept already in {DRAFTS}");
            return Err(Diagnostic::error(Rule::StudioLimit, message).help("drop some").into());
        }
        let keep = || {
            self.dir.create_dir_all(DRAFTS)?;
            // The text goes first: a draft is there once its JSON is.
            self.replace(&path, text)?;
            self.replace(&json, of.as_bytes())
        };
        keep().map_err(|error: io::Error| {
            let message = format!("the edit cannot be kept as a draft: {error}");
            let help = "save it elsewhere, or make the folder writable: a reload would lose it";
            Box::new(Diagnostic::error(Rule::OutputFile, message).help(help).file(DRAFTS))
        })
    }

    /// Drops a draft, where it is there.
    ///
    /// # Errors
    /// Its name is none, or the folder cannot be written.
    pub fn drop_draft(&self, name: &str) -> Result<(), Box<Diagnostic>> {
        for ending in ["json", "text"] {
            let path = draft(name, ending)?;
            match self.dir.remove_file(&path) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => {
                    let message = format!("the draft cannot be removed: {error}");
                    let found = Diagnostic::error(Rule::OutputFile, message);
                    return Err(found.help("remove it by hand").file(spelled(&path)).into());
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// Writes a page that nobody but this user may read into the studio's own folder, which is gone at the end with it, and answers
    /// where it lies.
    ///
    /// # Errors
    /// The folder cannot be written.
    pub fn keep_secret(&self, name: &str, text: &str) -> io::Result<PathBuf> {
        self.dir.create_dir_all(OWN)?;
        self.sweep(OWN, |name| name.ends_with(SECRET));
        let inner = Path::new(OWN).join(name);
        let whole = self.path.join(&inner);
        files::remove_at_end([whole.clone(), self.path.join(OWN)]);
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        {
            use cap_std::fs::OpenOptionsExt;
            options.mode(0o600);
        }
        self.dir.open_with(&inner, &options)?.write_all(text.as_bytes())?;
        Ok(whole)
    }

    /// Removes such a page.
    pub fn drop_secret(&self, name: &str) {
        // Where it is gone already, or stays, it has led to a server that is gone soon.
        let _ = self.dir.remove_file(Path::new(OWN).join(name));
    }

    /// Writes a file under another name, and puts it in the place of the one that was there.
    fn replace(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        files::check_size(bytes.len())?;
        self.sweep(DRAFTS, |name| name.ends_with(NEW));
        let mut new = path.as_os_str().to_owned();
        // Another server may work in the same folder.
        new.push(format!(".{}{NEW}", std::process::id()));
        let written = || {
            let mut file = self.dir.create(&new)?;
            file.write_all(bytes)?;
            file.sync_all()?;
            self.dir.rename(&new, &self.dir, path)
        };
        written().inspect_err(|_| drop(self.dir.remove_file(&new)))
    }

    /// Removes what a server that was killed has left of the files that `is_ours`.
    fn sweep(&self, folder: &str, is_ours: impl Fn(&str) -> bool) {
        let Ok(entries) = self.dir.read_dir(folder) else { return };
        for entry in entries.filter_map(Result::ok) {
            let begun = entry.metadata().and_then(|metadata| metadata.modified());
            let age = begun.ok().and_then(|begun| begun.into_std().elapsed().ok());
            let is_left = age.is_some_and(|age| age > LEFT);
            if is_left && is_ours(&entry.file_name().to_string_lossy()) {
                let _ = entry.remove_file();
            }
        }
    }

    /// The bytes of a file that has no more than so many.
    pub(crate) fn bytes(&self, path: &Path, most: u64) -> io::Result<Vec<u8>> {
        let (file, length) = self.open_file(path, most)?;
        let mut bytes = Vec::new();
        bytes.try_reserve_exact(length as usize).map_err(io::Error::other)?;
        // A file that grows while it is read ends where it ended.
        file.take(length).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    /// A file that is read, and how many bytes it has: no more than so many.
    fn open_file(&self, path: &Path, most: u64) -> io::Result<(cap_std::fs::File, u64)> {
        // Looked at before it is opened: opening a pipe would wait for ever. One that takes the place of the file after
        // that is opened without waiting.
        let no_file = || io::Error::other("it is not a file");
        if !self.dir.metadata(path)?.is_file() {
            return Err(no_file());
        }
        let mut options = OpenOptions::new();
        options.read(true);
        #[cfg(unix)]
        {
            use cap_std::fs::OpenOptionsExt;
            options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits() as i32);
        }
        let file = self.dir.open_with(path, &options)?;
        let metadata = file.metadata()?;
        if !metadata.is_file() {
            return Err(no_file());
        }
        if metadata.len() > most {
            return Err(io::Error::other(format!("it is larger than {} MB", most >> 20)));
        }
        Ok((file, metadata.len()))
    }
}

/// The folder itself has no path in it.
fn at(path: &Path) -> &Path {
    if path.as_os_str().is_empty() { Path::new(".") } else { path }
}

/// A path of the page as one below the folder.
///
/// # Errors
/// It is absolute, or goes up.
fn inner(path: &str) -> Result<PathBuf, Box<Diagnostic>> {
    let mut inner = PathBuf::new();
    for part in Path::new(path).components() {
        match part {
            Component::Normal(name) => inner.push(name),
            Component::CurDir => {}
            Component::ParentDir | Component::RootDir | Component::Prefix(_) => {
                return Err(leads_out(path));
            }
        }
    }
    Ok(if inner.as_os_str().is_empty() { PathBuf::from(".") } else { inner })
}

/// The path as the page has it.
fn spelled(path: &Path) -> String {
    let parts = path.components().filter(|part| *part != Component::CurDir);
    parts.map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
}

/// The file of a draft: its name is one of letters, digits, `-`, `_` and `.`.
fn draft(name: &str, ending: &str) -> Result<PathBuf, Box<Diagnostic>> {
    let is_good = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if name.is_empty() || name.len() > 100 || name.starts_with('.') || !name.chars().all(is_good) {
        let message = "a draft is named by up to 100 letters, digits, `-`, `_` and `.`";
        return Err(Diagnostic::error(Rule::StudioAsk, message).into());
    }
    Ok(Path::new(DRAFTS).join(format!("{name}.{ending}")))
}

fn is_escape(error: &io::Error) -> bool {
    error.to_string().contains(ESCAPES)
}

fn leads_out(path: &str) -> Box<Diagnostic> {
    let message = "the path leads out of the folder that the studio was started in";
    Diagnostic::error(Rule::FolderReach, message).file(path).into()
}

fn unreadable(path: &str, error: &io::Error) -> Box<Diagnostic> {
    if is_escape(error) {
        return leads_out(path);
    }
    let message = format!("cannot be read: {error}");
    let help = "give the name of a file that is there and may be read";
    Diagnostic::error(Rule::Unreadable, message).help(help).file(path).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::fs;

    fn folder() -> (tempfile::TempDir, Folder) {
        let all = tempfile::tempdir().unwrap();
        let own = all.path().join("own");
        fs::create_dir_all(own.join("parts")).unwrap();
        fs::write(own.join("a.cls"), "GOTO/1,2,3\n").unwrap();
        fs::write(own.join("parts/b.cls"), "GOTO/4,5,6\n").unwrap();
        fs::write(own.join(".hidden"), "x").unwrap();
        fs::write(all.path().join("secret"), "secret").unwrap();
        let folder = Folder::open(&own).unwrap();
        (all, folder)
    }

    #[test]
    fn what_is_in_it_is_listed_folders_first_and_hidden_names_are_not() {
        let (all, folder) = folder();
        let file = fs::File::options().append(true).open(all.path().join("own/a.cls")).unwrap();
        file.set_modified(UNIX_EPOCH + Duration::from_secs(86_400)).unwrap();
        let (entries, is_whole) = folder.list("").unwrap();
        let names: Vec<_> = entries.iter().map(|entry| entry.path.as_str()).collect();
        assert_eq!((names, is_whole), (vec!["parts", "a.cls"], true));
        assert_eq!((entries[1].bytes, entries[1].written), (Some(11), 86_400));
        assert_eq!(folder.list("parts/").unwrap().0[0].path, "parts/b.cls");
        assert_eq!(folder.read("./parts/b.cls").unwrap(), b"GOTO/4,5,6\n");
    }

    #[test]
    fn no_path_leads_out() {
        let (all, folder) = folder();
        for path in ["../secret", "/etc/passwd", "parts/../../secret", "..", "parts/.."] {
            assert!(folder.read(path).unwrap_err().rule == "folder-reach", "{path}");
            assert!(folder.list(path).unwrap_err().rule == "folder-reach", "{path}");
            assert!(folder.target(path).unwrap_err().rule == "folder-reach", "{path}");
        }
        assert!(all.path().join("secret").is_file());
    }

    #[cfg(unix)]
    #[test]
    fn no_link_leads_out_and_one_within_is_followed() {
        use std::os::unix::fs::symlink;
        let (all, folder) = folder();
        let own = all.path().join("own");
        symlink("../secret", own.join("up")).unwrap();
        symlink(all.path().join("secret"), own.join("whole")).unwrap();
        symlink(all.path(), own.join("above")).unwrap();
        symlink("parts/b.cls", own.join("within")).unwrap();
        symlink("loop", own.join("loop")).unwrap();
        for path in ["up", "whole", "above/secret"] {
            assert!(folder.read(path).unwrap_err().rule == "folder-reach", "{path}");
            assert!(folder.target(path).unwrap_err().rule == "folder-reach", "{path}");
        }
        assert!(folder.list("above").is_err());
        assert!(folder.read("loop").is_err());
        assert_eq!(folder.read("within").unwrap(), b"GOTO/4,5,6\n");
        let names: Vec<_> =
            folder.list("").unwrap().0.into_iter().map(|entry| entry.name).collect();
        assert_eq!(names, ["parts", "a.cls", "within"]);
        // A hard link is a file of the folder; drafts behind a link out are not written.
        fs::create_dir(all.path().join("elsewhere")).unwrap();
        symlink("../elsewhere", own.join(".toolpost")).unwrap();
        assert!(folder.keep_draft("a", &json!({}), b"x").is_err());
        assert!(folder.drafts().is_empty());
        assert_eq!(fs::read_dir(all.path().join("elsewhere")).unwrap().count(), 0);
    }

    #[cfg(unix)]
    #[test]
    fn files_further_down_are_found_within_bounds() {
        use std::os::unix::fs::symlink;
        let (all, folder) = folder();
        let own = all.path().join("own");
        fs::create_dir_all(own.join("a/b/c/d/e")).unwrap();
        fs::create_dir(own.join(".git")).unwrap();
        let paths = ["z.toml", "a/y.toml", "a/b/c/d/x.toml", "a/b/c/d/e/deep.toml", ".git/w.toml"];
        for path in paths.into_iter().chain(["a/.hidden.toml", "a/other.txt"]) {
            fs::write(own.join(path), "x").unwrap();
        }
        fs::write(own.join("a/large.toml"), "xx").unwrap();
        symlink("..", own.join("parts/up")).unwrap();
        symlink("../z.toml", own.join("parts/link.toml")).unwrap();
        symlink("a/y.toml", own.join("link.toml")).unwrap();
        let found = folder.files_below(".toml", 100, 1);
        assert_eq!(found, ["link.toml", "z.toml", "a/y.toml", "a/b/c/d/x.toml"]);
        let found = folder.files_below(".toml", 3, 100);
        assert_eq!(found, ["link.toml", "z.toml", "a/large.toml"]);
        fs::create_dir(own.join("0")).unwrap();
        for number in 0..MOST_LOOKED_AT {
            fs::write(own.join(format!("0/{number}")), "").unwrap();
        }
        // All that is looked at further down is in the first folder.
        assert_eq!(folder.files_below(".toml", 100, 1), ["link.toml", "z.toml"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_a_device_and_a_folder_are_no_files_and_nobody_waits_for_them() {
        let (all, folder) = folder();
        let pipe = all.path().join("own/pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
        assert!(made.success());
        for path in ["pipe", "parts"] {
            let found = folder.read(path).unwrap_err();
            assert!(found.message.contains("not a file"), "{found}");
        }
        assert!(folder.list("").unwrap().0.iter().all(|entry| entry.name != "pipe"));
    }

    #[test]
    fn drafts_are_kept_and_dropped() {
        let (all, folder) = folder();
        assert!(folder.drafts().is_empty());
        let of = json!({ "source": { "file": "a.cls" } });
        folder.keep_draft("a.nc-1", &of, b"G0 X1\n").unwrap();
        folder.keep_draft("a.nc-1", &of, b"G0 X2\n").unwrap();
        let drafts = folder.drafts();
        assert_eq!((drafts.len(), &drafts[0].of, drafts[0].bytes), (1, &of, 6));
        assert_eq!(folder.text_of_draft("a.nc-1").unwrap(), b"G0 X2\n");
        let kept = fs::read_dir(all.path().join("own/.toolpost/drafts")).unwrap().count();
        assert_eq!(kept, 2, "nothing but text and JSON");
        for name in ["", "../a", "a/b", ".a", "ä", &"a".repeat(101)] {
            assert!(folder.keep_draft(name, &of, b"").unwrap_err().rule == "studio-ask", "{name}");
        }
        folder.drop_draft("a.nc-1").unwrap();
        folder.drop_draft("a.nc-1").unwrap();
        assert!(folder.drafts().is_empty());
    }

    /// A page that leads to the server with its token.
    #[test]
    fn a_secret_is_left_by_nobody() {
        let (all, folder) = folder();
        let own = all.path().join("own/.toolpost");
        fs::create_dir(&own).unwrap();
        let old = own.join("open-1.html");
        let before = std::time::SystemTime::now() - 2 * LEFT;
        fs::File::create(&old).unwrap().set_modified(before).unwrap();
        let kept = folder.keep_secret("open-2.html", "x").unwrap();
        assert_eq!(kept, own.canonicalize().unwrap().join("open-2.html"));
        assert!(!old.exists(), "a server that was killed has left it");
        assert!(folder.keep_secret("open-2.html", "y").is_err(), "nobody else has made it");
        assert_eq!(fs::read_to_string(&kept).unwrap(), "x");
        folder.drop_secret("open-2.html");
        assert!(!kept.exists());
        folder.keep_secret("open-3.html", "x").unwrap();
        files::remove_left();
        assert!(!own.exists());
        folder.keep_secret("open-4.html", "x").unwrap();
        fs::write(own.join("other"), "x").unwrap();
        files::remove_left();
        assert!(!own.join("open-4.html").exists() && own.join("other").exists());
    }

    #[test]
    fn a_draft_that_is_too_large_is_refused() {
        let (_all, folder) = folder();
        let found = folder.keep_draft("a", &json!({}), &vec![b' '; LARGEST_DRAFT + 1]).unwrap_err();
        assert!(found.rule == "studio-limit");
        assert!(folder.drafts().is_empty());
    }
}
