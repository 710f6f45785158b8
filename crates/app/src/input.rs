//! Files that are read: those of the computer, and those that the caller has in memory.

use crate::files;
use program::Diagnostic;
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file to read.
#[derive(Clone, Debug)]
pub enum Source {
    /// A file of this computer.
    File(PathBuf),
    /// Bytes that the caller has, under the name of a file: its ending says what they are.
    Memory {
        /// The name of the file, for findings and reports.
        name: PathBuf,
        /// Its content.
        bytes: Arc<Vec<u8>>,
    },
}

impl Source {
    /// Bytes that the caller has.
    pub fn memory(name: impl Into<PathBuf>, bytes: impl Into<Vec<u8>>) -> Source {
        Source::Memory { name: name.into(), bytes: Arc::new(bytes.into()) }
    }

    /// Its path, or the name that it was given.
    pub fn path(&self) -> &Path {
        match self {
            Source::File(path) => path,
            Source::Memory { name, .. } => name,
        }
    }

    /// The file of this computer, where it is one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Source::File(path) => Some(path),
            Source::Memory { .. } => None,
        }
    }

    /// The name of the file, without its folder.
    pub fn name(&self) -> String {
        files::name(self.path())
    }

    /// Its bytes.
    ///
    /// # Errors
    /// As [`files::read`].
    pub fn read(&self) -> Result<Cow<'_, [u8]>, Box<Diagnostic>> {
        match self {
            Source::File(path) => Ok(Cow::Owned(files::read(path)?)),
            Source::Memory { bytes, .. } => Ok(Cow::Borrowed(bytes)),
        }
    }

    /// Its text, as [`files::text`] has it.
    ///
    /// # Errors
    /// As there.
    pub fn text(&self) -> Result<Cow<'_, [u8]>, Box<Diagnostic>> {
        files::text_of(self.path(), self.read()?)
    }
}

impl From<PathBuf> for Source {
    fn from(path: PathBuf) -> Source {
        Source::File(path)
    }
}

impl From<&Path> for Source {
    fn from(path: &Path) -> Source {
        Source::File(path.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of hundreds of megabytes each copy would cost as much time as the reading of the file.
    #[test]
    fn bytes_of_the_caller_are_read_without_a_copy() {
        let source = Source::memory("a.cls", *b"\xef\xbb\xbfFINI");
        let Source::Memory { bytes, .. } = &source else { panic!() };
        let (read, text) = (source.read().unwrap(), source.text().unwrap());
        assert_eq!((read.as_ptr(), &text[..]), (bytes.as_ptr(), &b"FINI"[..]));
        assert_eq!(text.as_ptr(), bytes[3..].as_ptr());
    }
}
