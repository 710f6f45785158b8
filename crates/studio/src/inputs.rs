//! The files of the folder that a work is made of, as they were when they were read, and what has become of them since.
//!
//! A file is looked at before it is read: what is changed behind that counts as changed, whether or not it was read so.

use crate::ask::{ChangedFile, Changes, Of};
use crate::folder::{Folder, Stamp};
use machine::{Reach, is_path};
use program::{Diagnostic, Digest, Rule};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

/// The largest file of which the content is compared, bytes; a larger one is known by its size and its times.
const LARGEST: u64 = 16 << 20;

/// How far the clock of files may be behind.
const BEHIND: Duration = Duration::from_millis(20);

/// A file that was written so shortly ago may be written again at the same time, as the clock of files counts it.
const TICK: Duration = Duration::from_secs(2);

/// What is at a path.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Content {
    /// Nothing that can be read.
    Nothing,
    /// A file of this SHA-256.
    File(String),
    /// A file that is too large for that.
    Large(Stamp),
    /// A folder with files of these names.
    Folder(Vec<String>),
    /// A file that was changed while the work went on: nobody knows what was read.
    Unknown,
}

impl Content {
    /// What is at a path in the folder now.
    fn at(folder: &Folder, path: &Path) -> Content {
        let Some(stamp) = folder.stamp(path) else { return Content::Nothing };
        if stamp.is_folder {
            return folder.names_of_files(path).map_or(Content::Nothing, Content::Folder);
        }
        if stamp.bytes > LARGEST {
            return Content::Large(stamp);
        }
        match folder.bytes(path, LARGEST) {
            Ok(bytes) => Content::File(Digest::of([&bytes[..]])),
            Err(_) => Content::Nothing,
        }
    }
}

/// A file that was read, or was looked for.
#[derive(Debug)]
struct Input {
    of: Of,
    was: Content,
    /// As what it was seen last with the same content.
    same: Option<Stamp>,
}

/// The files that a work is made of.
#[derive(Debug)]
pub struct Inputs {
    /// By their paths in the folder.
    all: Mutex<BTreeMap<PathBuf, Input>>,
    /// When the work began.
    since: SystemTime,
}

impl Default for Inputs {
    fn default() -> Inputs {
        Inputs { all: Mutex::default(), since: SystemTime::now() }
    }
}

impl Inputs {
    fn all(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Input>> {
        self.all.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn add(&self, path: &Path, of: Of, was: Content) {
        // What was seen first is older, and what is read behind it no older than that.
        self.all().entry(path.to_owned()).or_insert(Input { of, was, same: None });
    }

    /// Takes over what `posted` is made of, as that was: what has changed since then has changed for an edit of it too, whatever is read for its proof.
    pub fn begin_as(&self, posted: &Inputs) {
        for (path, input) in posted.all().iter() {
            self.add(path, input.of, input.was.clone());
        }
    }

    /// Looks at what is about to be read, given by its whole path or by that in the folder; it may not be there.
    pub fn look(&self, folder: &Folder, path: &Path, of: Of) {
        let path = folder.within(path);
        self.add(path, of, Content::at(folder, path));
    }

    /// Looks at a machine that is about to be loaded, with all that its file extends; one of the library is no file.
    pub fn look_at_machine(&self, folder: &Folder, name: &str) {
        if !is_path(name) {
            return;
        }
        let reach = Reach::Folder(folder.path().to_owned());
        for file in reach.chain(&folder.path().join(name)) {
            self.look(folder, &file, Of::Machine);
        }
    }

    /// Adds what was read meanwhile by others, where it was not looked at before.
    pub fn add_read(&self, folder: &Folder, path: &Path, of: Of) {
        let path = folder.within(path);
        if self.all().contains_key(path) {
            return;
        }
        let is_older =
            |stamp: Stamp| stamp.changed.is_some_and(|changed| changed + BEHIND < self.since);
        let was = match folder.stamp(path).is_some_and(is_older) {
            true => Content::at(folder, path),
            false => Content::Unknown,
        };
        self.add(path, of, was);
    }

    /// Reads a file of the folder.
    ///
    /// # Errors
    /// As [`Folder::read`].
    pub fn read(&self, folder: &Folder, path: &str, of: Of) -> Result<Vec<u8>, Box<Diagnostic>> {
        let stamp = folder.stamp(Path::new(path));
        let read = folder.read(path);
        let was = match (&read, stamp) {
            (Ok(bytes), _) if bytes.len() as u64 <= LARGEST => {
                Content::File(Digest::of([&bytes[..]]))
            }
            (Ok(_), Some(stamp)) => Content::Large(stamp),
            (Ok(_), None) => Content::Unknown,
            (Err(_), _) => Content::Nothing,
        };
        self.add(folder.within(Path::new(path)), of, was);
        read
    }

    /// The whole paths of the files that were read: nothing is saved over them. Of some kind, or of all.
    pub fn files(&self, folder: &Folder, of: Option<Of>) -> Vec<PathBuf> {
        let all = self.all();
        let is_meant = |input: &Input| {
            of.is_none_or(|of| input.of == of)
                && !matches!(input.was, Content::Nothing | Content::Folder(_))
        };
        let files = all.iter().filter(|(_, input)| is_meant(input));
        files.map(|(path, _)| folder.path().join(path)).collect()
    }

    /// Which of them are others now.
    pub fn changes(&self, folder: &Folder) -> Changes {
        self.compared(folder, true)
    }

    /// Checks that all of them are as they were.
    ///
    /// # Errors
    /// Names those that are not.
    pub fn check(&self, folder: &Folder) -> Result<(), Box<Diagnostic>> {
        let Changes { files, .. } = self.compared(folder, false);
        let Some(first) = files.first() else { return Ok(()) };
        let others = match files.len() - 1 {
            0 => String::new(),
            others => format!(", and {others} more"),
        };
        let message = match first.is_gone {
            true => format!("{} is not there any more{others}", first.path),
            false => format!("{} has changed since this program was proven{others}", first.path),
        };
        let help = match files.iter().all(|file| file.is_gone) {
            true => "put it back, or open another source or machine; nothing was saved",
            false => "post again (in Ctrl K), then save; nothing was saved",
        };
        let found = Diagnostic::error(Rule::StudioChanged, message).file(first.path.clone());
        Err(found.help(help).into())
    }

    /// Compares them with what there is now: where `trusts`, without reading those anew that have the same size and times as when that was done last.
    fn compared(&self, folder: &Folder, trusts: bool) -> Changes {
        // Work that goes on may add to them meanwhile, and nobody waits for a file to be read.
        let asked: Vec<(PathBuf, Option<Stamp>)> =
            self.all().iter().map(|(path, input)| (path.clone(), input.same)).collect();
        let mut changes = Changes { files: Vec::new(), state: String::new() };
        let mut state = Digest::default();
        for (path, same) in asked {
            let stamp = folder.stamp(&path);
            if trusts && same.is_some() && same == stamp {
                continue;
            }
            let now = Content::at(folder, &path);
            let mut all = self.all();
            let Some(input) = all.get_mut(&path) else { continue };
            if now == input.was {
                let is_old = |stamp: &Stamp| {
                    stamp
                        .changed
                        .is_some_and(|changed| changed.elapsed().is_ok_and(|since| since > TICK))
                };
                input.same = stamp.filter(is_old);
                continue;
            }
            let shown = path.to_string_lossy().replace(std::path::MAIN_SEPARATOR, "/");
            state.add(shown.as_bytes());
            state.add(format!("{now:?}").as_bytes());
            let is_gone = now == Content::Nothing;
            changes.files.push(ChangedFile { path: shown, of: input.of, is_gone });
        }
        if !changes.files.is_empty() {
            changes.state = state.finish();
        }
        changes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    struct Kept {
        own: tempfile::TempDir,
        folder: Folder,
        inputs: Inputs,
    }

    impl Kept {
        fn new(files: &[(&str, &str)]) -> Kept {
            let own = tempfile::tempdir().unwrap();
            for (name, text) in files {
                fs::write(own.path().join(name), text).unwrap();
            }
            let folder = Folder::open(own.path()).unwrap();
            Kept { own, folder, inputs: Inputs::default() }
        }

        fn path(&self, name: &str) -> PathBuf {
            self.own.path().join(name)
        }

        fn changed(&self) -> Vec<(String, bool)> {
            let Changes { files, .. } = self.inputs.changes(&self.folder);
            files.into_iter().map(|file| (file.path, file.is_gone)).collect()
        }
    }

    #[test]
    fn a_file_is_as_it_was_while_its_content_is() {
        let kept = Kept::new(&[("a.cls", "GOTO/1,2,3\n")]);
        let a = kept.path("a.cls");
        kept.inputs.read(&kept.folder, "a.cls", Of::Source).unwrap();
        assert!(kept.changed().is_empty());
        // Written again, and by an editor that puts a new file in its place.
        fs::write(&a, "GOTO/1,2,3\n").unwrap();
        assert!(kept.changed().is_empty());
        fs::write(kept.path("new"), "GOTO/1,2,3\n").unwrap();
        fs::rename(kept.path("new"), &a).unwrap();
        assert!(kept.changed().is_empty());
        // Of the same size, and within one tick of the clock of files.
        fs::write(&a, "GOTO/1,2,4\n").unwrap();
        assert_eq!(kept.changed(), [(String::from("a.cls"), false)]);
        assert!(kept.inputs.check(&kept.folder).unwrap_err().message.contains("a.cls has changed"));
        fs::remove_file(&a).unwrap();
        assert_eq!(kept.changed(), [(String::from("a.cls"), true)]);
        assert!(
            kept.inputs.check(&kept.folder).unwrap_err().message.contains("not there any more")
        );
        fs::write(&a, "GOTO/1,2,3\n").unwrap();
        kept.inputs.check(&kept.folder).unwrap();
    }

    #[test]
    fn what_was_looked_for_in_vain_has_changed_when_it_comes() {
        let kept = Kept::new(&[("board.toml", "")]);
        kept.inputs.look(&kept.folder, Path::new("toolpost.toml"), Of::Source);
        kept.inputs.look(&kept.folder, kept.folder.path(), Of::Source);
        assert!(kept.changed().is_empty() && kept.inputs.files(&kept.folder, None).is_empty());
        // What is hidden is no file of a board.
        fs::write(kept.path(".hidden"), "").unwrap();
        assert!(kept.changed().is_empty());
        fs::write(kept.path("toolpost.toml"), "").unwrap();
        let names: Vec<String> = kept.changed().into_iter().map(|(path, _)| path).collect();
        assert_eq!(names, ["", "toolpost.toml"]);
    }

    /// A file on which nothing is known before it is read.
    #[test]
    fn what_was_changed_while_the_work_went_on_counts_as_changed() {
        let kept = Kept::new(&[]);
        fs::write(kept.path("called.ngc"), "").unwrap();
        kept.inputs.add_read(&kept.folder, &kept.path("called.ngc"), Of::Source);
        assert_eq!(kept.changed().len(), 1);
        std::thread::sleep(Duration::from_millis(50));
        let later = Inputs::default();
        later.add_read(&kept.folder, &kept.path("called.ngc"), Of::Source);
        later.check(&kept.folder).unwrap();
    }

    #[test]
    fn a_machine_is_all_files_that_it_extends_as_far_as_they_can_be_read() {
        let kept = Kept::new(&[("own.toml", "extends = \"shop/base.toml\"\n")]);
        let chain = || {
            let inputs = Inputs::default();
            inputs.look_at_machine(&kept.folder, "own.toml");
            let all = inputs.all();
            all.keys().map(|path| path.to_string_lossy().into_owned()).collect::<Vec<_>>()
        };
        assert_eq!(chain(), ["own.toml", "shop/base.toml"], "it is not there yet");
        fs::create_dir(kept.path("shop")).unwrap();
        fs::write(kept.path("shop/base.toml"), "extends = \"linuxcnc-mill\"\n").unwrap();
        assert_eq!(chain(), ["own.toml", "shop/base.toml"]);
        // Without end.
        fs::write(kept.path("shop/base.toml"), "extends = \"base.toml\"\n").unwrap();
        assert_eq!(chain(), ["own.toml", "shop/base.toml"]);
        fs::write(kept.path("own.toml"), "extends = \"shop/base.toml\"\nspeed = 1\n").unwrap();
        assert_eq!(chain(), ["own.toml"], "it has a mistake");
    }
}
