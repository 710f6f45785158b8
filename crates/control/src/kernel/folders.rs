//! Programs that a program calls, from the folders that the operator has given.

use program::{Diagnostic, encoding};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Largest called program, bytes.
const LARGEST: u64 = 64 << 20;

/// Programs by the names of their files.
type Texts = BTreeMap<String, Vec<u8>>;

/// Folders in which called programs are looked for, in this order. Nothing outside them is opened.
#[derive(Clone, Debug, Default)]
pub struct Folders {
    /// Programs that are in no folder yet, by the names of their files: they are found first.
    texts: Arc<Texts>,
    paths: Vec<PathBuf>,
    /// The files that have been read; clones have it in common.
    read: Arc<Mutex<BTreeSet<PathBuf>>>,
    /// Where they are kept, the texts of all programs that were called; clones have them in common.
    kept: Option<Arc<Mutex<Texts>>>,
}

impl PartialEq for Folders {
    fn eq(&self, other: &Folders) -> bool {
        self.texts == other.texts && self.paths == other.paths
    }
}

impl From<Vec<PathBuf>> for Folders {
    fn from(paths: Vec<PathBuf>) -> Folders {
        Folders { paths, ..Folders::default() }
    }
}

impl From<Texts> for Folders {
    fn from(texts: Texts) -> Folders {
        Folders::default().with_texts(texts)
    }
}

impl Folders {
    /// The same, with programs that are in no folder yet, by the names of their files: they are found first.
    #[must_use]
    pub fn with_texts(mut self, texts: Texts) -> Folders {
        self.texts = Arc::new(texts);
        self
    }

    /// The same, which keeps the text of each program that is called.
    #[must_use]
    pub fn keeping(mut self) -> Folders {
        self.kept = Some(Arc::default());
        self
    }

    /// The texts that were kept, by the names of their files: what the controls that were set up with clones of it have read.
    pub fn take_kept(&self) -> BTreeMap<String, Vec<u8>> {
        let kept =
            self.kept.as_ref().map(|kept| kept.lock().unwrap_or_else(PoisonError::into_inner));
        kept.map(|mut kept| std::mem::take(&mut *kept)).unwrap_or_default()
    }

    /// Keeps the text of a program that is called, where that is asked for.
    fn keep(&self, name: &str, text: &[u8]) {
        if let Some(kept) = &self.kept {
            let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
            kept.entry(name.to_owned()).or_insert_with(|| text.to_vec());
        }
    }

    /// The files that have been read from them, by any of the controls that were set up with clones of it.
    pub fn files_read(&self) -> Vec<PathBuf> {
        self.read.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }

    /// Whether one of them has a file of that name.
    pub(crate) fn have(&self, name: &str) -> bool {
        self.texts.contains_key(name) || self.paths.iter().any(|folder| folder.join(name).is_file())
    }

    /// The program `name`, in a file with that ending: as it is written, or else in small letters; `None` where no folder has it.
    ///
    /// # Errors
    /// As [`Folders::open`]; two files differ in capitals alone.
    pub(crate) fn called(&self, name: &str, ending: &str) -> Result<Option<CalledFile>, String> {
        let Some(name) = self.find(name, ending) else { return Ok(None) };
        if let Some(other) = self.spelled_otherwise(&name) {
            return Err(format!(
                "{name} and {other} are one file on the controller, where capitals make no difference, and which of the two it has is not \
                 known: take one of them out of the folder"
            ));
        }
        let text = self.open(&name)?;
        Ok(Some(CalledFile { name, text }))
    }

    /// The file of the program `name`, with that ending: as it is written, or else in small letters or in capitals.
    pub(crate) fn find(&self, name: &str, ending: &str) -> Option<String> {
        let file = format!("{name}.{ending}");
        let spellings = [file.to_ascii_uppercase(), file.to_ascii_lowercase(), file];
        spellings.into_iter().rfind(|own| self.have(own))
    }

    /// Another file whose name differs from `name` in capitals alone; the first by its name.
    fn spelled_otherwise(&self, name: &str) -> Option<String> {
        let same = |other: &str| other != name && other.eq_ignore_ascii_case(name);
        let files = self.paths.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten();
        let in_folders = files.filter_map(|file| file.ok()?.file_name().into_string().ok());
        self.texts.keys().cloned().chain(in_folders).filter(|other| same(other)).min()
    }

    /// Finds a called program, in the first folder that has it, and reads it.
    ///
    /// # Errors
    /// What to say where there is none, or it cannot be read.
    pub fn open(&self, name: &str) -> Result<Vec<u8>, String> {
        if let Some(text) = self.texts.get(name) {
            self.keep(name, text);
            return Ok(text.clone());
        }
        let (path, text) = open(&self.paths, name)?;
        self.keep(name, &text);
        self.read.lock().unwrap_or_else(PoisonError::into_inner).insert(path);
        Ok(text)
    }
}

/// A called program.
pub(crate) struct CalledFile {
    /// The name of the file.
    pub(crate) name: String,
    pub(crate) text: Vec<u8>,
}

impl CalledFile {
    /// A finding in it, or in a file that it calls.
    pub(crate) fn inside(&self, found: Box<Diagnostic>) -> Box<Diagnostic> {
        if found.file.is_empty() { Box::new(found.file(self.name.clone())) } else { found }
    }
}

/// Finds a called program in `folders`, the first that has it, and reads it. `name` may lead into a
/// folder below, never out: a name with `..` or a root, or a link that leads out, finds nothing.
///
/// # Errors
/// What to say where there is none, or it cannot be read.
fn open(folders: &[PathBuf], name: &str) -> Result<(PathBuf, Vec<u8>), String> {
    let inside = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
    if !inside || name.is_empty() {
        return Err(format!("{name:?} does not name a file within the given folders"));
    }
    for folder in folders {
        let path = folder.join(name);
        let (Ok(root), Ok(real)) = (folder.canonicalize(), path.canonicalize()) else { continue };
        if !real.starts_with(root) || !real.is_file() {
            continue;
        }
        let mut text = Vec::new();
        let file = fs::File::open(&real).map_err(|e| format!("{name} cannot be read: {e}"))?;
        file.take(LARGEST + 1)
            .read_to_end(&mut text)
            .map_err(|e| format!("{name} cannot be read: {e}"))?;
        if text.len() as u64 > LARGEST {
            return Err(format!("{name} is larger than {} MB", LARGEST >> 20));
        }
        if encoding::is_utf_16(&text) {
            return Err(format!("{name} is in UTF-16: save it as plain text"));
        }
        text.drain(..text.len() - encoding::without_mark(&text).len());
        return Ok((real, text));
    }
    let among = match folders {
        [] => String::from("no folder for called programs is given"),
        _ => {
            let names: Vec<String> = folders.iter().map(|f| f.display().to_string()).collect();
            format!("looked in {}", names.join(", "))
        }
    };
    Err(format!("the called program {name} is not there ({among})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_is_found_in_the_first_folder_that_has_it_and_never_outside() {
        let outside = tempfile::tempdir().unwrap();
        let folders = [outside.path().join("a"), outside.path().join("b")];
        for folder in &folders {
            fs::create_dir(folder).unwrap();
        }
        fs::write(outside.path().join("secret.ngc"), "no").unwrap();
        fs::write(folders[1].join("sub.ngc"), "second").unwrap();
        assert_eq!(open(&folders, "sub.ngc").unwrap().1, b"second");
        fs::write(folders[0].join("sub.ngc"), "first").unwrap();
        assert_eq!(open(&folders, "sub.ngc").unwrap().1, b"first");
        let absolute = outside.path().join("secret.ngc").display().to_string();
        for name in ["../secret.ngc", &absolute, "a/../../secret.ngc", "", "missing.ngc"] {
            assert!(open(&folders, name).is_err(), "{name}");
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(outside.path().join("secret.ngc"), folders[0].join("link"))
                .unwrap();
            assert!(open(&folders, "link").is_err());
        }
    }
}
