//! Programs: the main one, those that travel in the same file, and those of the operator's folders.

use super::outline::{self, Outline};
use crate::kernel::Outcome;
use crate::kernel::flow::BlockLocation;
use crate::kernel::folders::Folders;
use crate::kernel::source::Source;
use crate::sinumerik::language::scan::{Name, Scanner};
use program::{Diagnostic, Rule};
use std::borrow::Cow;
use std::cell::OnceCell;
use std::collections::HashMap;
use std::rc::Rc;

/// A program.
pub(crate) struct Program<'a> {
    /// Its name, where its file or its header gives one.
    pub name: Option<Name>,
    /// The file that it came from, where that is not the main one.
    pub file: Option<String>,
    /// Its blocks, without the header.
    pub text: Cow<'a, [u8]>,
    /// The line of its first block within the file.
    pub first_line: u32,
    /// Whether it is called as a main program (`_MPF`).
    main: bool,
    outline: OnceCell<Outline>,
}

impl Program<'_> {
    /// Where its first block starts.
    pub fn start(&self) -> BlockLocation {
        BlockLocation { at: 0, line: self.first_line }
    }

    /// The block that starts at byte `at` on that line, and where the next one starts.
    #[inline]
    pub fn block(&self, at: usize, line: u32) -> Option<(Source<'_>, usize)> {
        outline::block(&self.text, at, line)
    }

    /// Labels and control structures, found when the first jump asks for them.
    ///
    /// # Errors
    /// The control structures do not fit together.
    pub fn outline(&self) -> Outcome<&Outline> {
        if let Some(outline) = self.outline.get() {
            return Ok(outline);
        }
        let outline = Outline::of(&self.text, self.start())?;
        Ok(self.outline.get_or_init(|| outline))
    }

    /// Whether a jump has asked for the outline.
    pub fn has_jumped(&self) -> bool {
        self.outline.get().is_some()
    }
}

/// Where programs are found.
pub(crate) struct Library<'a> {
    folders: &'a Folders,
    /// Those of the main file.
    here: Vec<Rc<Program<'a>>>,
    /// Those of the folders that have been called.
    called: HashMap<Name, Rc<Program<'a>>>,
}

impl<'a> Library<'a> {
    /// With the programs of the main file.
    ///
    /// # Errors
    /// A header that names no program.
    pub fn new(folders: &'a Folders, text: &'a [u8]) -> Outcome<Library<'a>> {
        let here = split(text)?.into_iter().map(Rc::new).collect();
        Ok(Library { folders, here, called: HashMap::new() })
    }

    /// The program that runs: the first main program of the file, else the first.
    pub fn main(&self) -> Option<Rc<Program<'a>>> {
        self.here.iter().find(|program| program.main).or(self.here.first()).cloned()
    }

    /// The program of that name, which may be written with its folders, with `_N_`, `_SPF` or `_MPF`,
    /// `.SPF` or `.MPF`. Of a path only the last part counts: the folders are the operator's.
    ///
    /// # Errors
    /// What to say where there is none.
    pub fn find(&mut self, written: &str) -> Result<Rc<Program<'a>>, String> {
        let last = written.rsplit('/').next().unwrap_or("");
        let upper = last.to_ascii_uppercase();
        let bare = upper.strip_prefix("_N_").unwrap_or(&upper);
        let ending = ["_SPF", "_MPF", ".SPF", ".MPF"].into_iter().find(|e| bare.ends_with(e));
        let stem = ending.and_then(|e| bare.strip_suffix(e)).unwrap_or(bare);
        let name = Name::of(stem).ok_or_else(|| format!("'{written}' is not a program's name"))?;
        let main = ending.map(|e| e.ends_with("MPF"));
        let fits = |program: &Program| {
            program.name == Some(name) && main.is_none_or(|main| program.main == main)
        };
        if let Some(program) = self.here.iter().find(|program| fits(program)) {
            return Ok(Rc::clone(program));
        }
        if let Some(program) = self.called.get(&name).filter(|program| fits(program)) {
            return Ok(Rc::clone(program));
        }
        let start = last.len() - bare.len();
        let program = self.open(&last[start..start + stem.len()], name, main)?;
        let program = Rc::new(program);
        self.called.insert(name, Rc::clone(&program));
        Ok(program)
    }

    fn open(&self, stem: &str, name: Name, main: Option<bool>) -> Result<Program<'a>, String> {
        let endings: &[&str] = match main {
            None => &["SPF", "spf", "MPF", "mpf"],
            Some(false) => &["SPF", "spf"],
            Some(true) => &["MPF", "mpf"],
        };
        let stems = [stem.to_owned(), stem.to_ascii_uppercase(), stem.to_ascii_lowercase()];
        let names: Vec<String> = endings
            .iter()
            .flat_map(|ending| stems.iter().map(move |stem| format!("{stem}.{ending}")))
            .collect();
        let there = |name: &&String| self.folders.have(name);
        let file = names.iter().find(there).or(names.first()).cloned().unwrap_or_default();
        let text = self.folders.open(&file)?;
        let in_file = |error: Box<Diagnostic>| format!("{file}: {}", error.message);
        let mut found = split(&text).map_err(in_file)?;
        // A file of one program is called by the name of the file; of several, each by its header.
        let single = found.len() == 1;
        found.retain(|program| single || program.name == Some(name));
        let program =
            found.pop().ok_or_else(|| format!("{file} holds no program {}", name.as_str()))?;
        let main = file.to_ascii_uppercase().ends_with("MPF");
        let text = Cow::Owned(program.text.into_owned());
        let first_line = program.first_line;
        let outline = OnceCell::new();
        Ok(Program { name: Some(name), file: Some(file), text, first_line, main, outline })
    }
}

/// The programs of a file: each begins with its header, `%_N_NAME_MPF` or `%NAME_SPF`; a file of one
/// program may have none.
fn split(text: &[u8]) -> Outcome<Vec<Program<'_>>> {
    let mut headers: Vec<usize> = memchr::memchr_iter(b'%', text)
        .filter(|at| *at == 0 || text.get(at - 1) == Some(&b'\n'))
        .collect();
    let blank = |end: usize| text.get(..end).is_none_or(|t| t.iter().all(u8::is_ascii_whitespace));
    let unnamed = headers.first().is_none_or(|first| !blank(*first));
    let mut programs = Vec::new();
    if unnamed {
        let end = headers.first().copied().unwrap_or(text.len());
        let text = Cow::Borrowed(text.get(..end).unwrap_or(&[]));
        let outline = OnceCell::new();
        programs.push(Program { name: None, file: None, text, first_line: 1, main: true, outline });
    }
    headers.push(text.len());
    let (mut line, mut counted) = (1, 0);
    for pair in headers.windows(2) {
        let &[from, to] = pair else { continue };
        line += memchr::memchr_iter(b'\n', text.get(counted..from).unwrap_or(&[])).count() as u32;
        counted = from;
        let whole = text.get(from..to).unwrap_or(&[]);
        let length = memchr::memchr(b'\n', whole).unwrap_or(whole.len());
        let header = whole.get(..length).unwrap_or(whole);
        let (name, main) = check_header(&Source { line, text: header })?;
        let text = Cow::Borrowed(whole.get(length + 1..).unwrap_or(&[]));
        let (name, first_line, outline) = (Some(name), line.saturating_add(1), OnceCell::new());
        programs.push(Program { name, file: None, text, first_line, main, outline });
    }
    Ok(programs)
}

/// The name in a header, and whether it is a main program's.
fn check_header(source: &Source) -> Outcome<(Name, bool)> {
    let text = source.text.trim_ascii_end().get(1..).unwrap_or(&[]);
    let name = Scanner::new(Source { line: source.line, text })
        .name()
        .ok()
        .filter(|name| name.as_str().len() == text.len());
    let named = name.as_ref().and_then(|name| {
        let text = name.as_str();
        let bare = text.strip_prefix("_N_").unwrap_or(text);
        let main = bare.strip_suffix("_MPF");
        Some((Name::of(main.or(bare.strip_suffix("_SPF"))?)?, main.is_some()))
    });
    named.ok_or_else(|| {
        source.block_error(Rule::Header, "the header is % and a name that ends with _MPF or _SPF")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_holds_programs_by_their_headers() {
        let text = b"%_N_A_SPF\n;$PATH=/_N_SPF_DIR\nM17\n%_N_B_MPF\nA\nM30\n";
        let folders = Folders::default();
        let mut library = Library::new(&folders, text).unwrap();
        let main = library.main().unwrap();
        assert_eq!((main.first_line, &main.text[..]), (5, &b"A\nM30\n"[..]));
        for name in ["a", "A_SPF", "_N_A_SPF", "/_N_WKS_DIR/_N_X_WPD/_N_A_SPF", "A.spf"] {
            assert_eq!(library.find(name).unwrap().first_line, 2, "{name}");
        }
        for name in ["C", "A_MPF", "", "../A B", "A\u{fc}"] {
            assert!(library.find(name).is_err(), "{name}");
        }
        assert!(Library::new(&Folders::default(), b"%_N_A_XYZ\n").is_err());
        assert!(Library::new(&Folders::default(), b"").unwrap().main().unwrap().text.is_empty());
    }

    #[test]
    fn a_called_file_is_found_in_capitals_or_not() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("sub.spf"), "%_N_OTHER_SPF\nM17\n").unwrap();
        let folders = Folders::from(vec![folder.path().to_owned()]);
        let mut library = Library::new(&folders, b"M30\n").unwrap();
        let program = library.find("SUB").unwrap();
        assert_eq!(program.file.as_deref(), Some("sub.spf"));
        assert_eq!(program.first_line, 2);
        assert!(library.find("SUB_MPF").is_err());
    }
}
