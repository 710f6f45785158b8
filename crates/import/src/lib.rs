//! Posts and templates of other systems as machine files: what fits becomes blocks and words of ours, and what does
//! not is reported line by line, never dropped in silence.
//!
//! Two readers, `vectric` for the posts of VCarve and Aspire and `parameters` for templates with `@parameter@`, make
//! one `foreign::Post`; `write` makes a file of it that extends a control of the library, which provides what the
//! post does not have. The same bytes give the same file. Lengths are mm, as in every machine file.
//!
//! A millproject of pcb2gcode becomes the options of `toolpost pcb` that do the same.
//!
//! Nothing is evaluated: a template of another system is text. Nothing is proven here either: whoever imports a post
//! loads the file and proves a program with it.
//!
//! ```
//! let post = r#"POST_NAME = "Router (GRBL)"
//! VAR X_POSITION = [X|C|X|1.3]
//! VAR Y_POSITION = [Y|C|Y|1.3]
//! VAR Z_POSITION = [Z|C|Z|1.3]
//! begin RAPID_MOVE
//! "G00[X][Y][Z]"
//! "#;
//! let folder = std::path::Path::new("");
//! let import = toolpost_import::import("router.pp", post.as_bytes(), None, folder).unwrap();
//! assert_eq!(import.extends, "grbl");
//! let machine = machine::load_text("router.toml", &import.text).unwrap();
//! assert_eq!(machine.title, "Router (GRBL)");
//! assert!(machine.blocks["rapid"].text.contains("G00"));
//! ```

mod arms;
mod foreign;
mod items;
mod millproject;
mod moves;
mod parameters;
mod placeholders;
mod text;
mod vectric;
mod write;

pub use arms::{import_calibration, import_urdf};
pub use millproject::{Stated, import_millproject};

use machine::{is_path, load_origin};
use program::{Diagnostic, Rule};
use std::path::Path;

/// The largest file that is taken for a post, bytes.
const LARGEST: usize = 1 << 20;

/// The most findings that are reported.
const MOST_FINDINGS: usize = 200;

/// A machine file made of a post.
#[derive(Clone, Debug)]
pub struct Import {
    /// The file, in TOML.
    pub text: String,
    /// The control or machine that it extends, a file by its path from the folder.
    pub extends: String,
    /// What could not be imported, or was imported in another form than in the post, each with its line.
    pub findings: Vec<Diagnostic>,
}

/// Makes a machine file of a post of VCarve or Aspire (a name that ends in `.pp`) or of templates with
/// parameters, to be saved in `folder`. It extends `extends`, a control or machine of the library or a file,
/// or the control that the post names.
///
/// # Errors
/// What cannot be read, each with its line; a post that names no control where `extends` does not.
pub fn import(
    file: &str,
    bytes: &[u8],
    extends: Option<&str>,
    folder: &Path,
) -> Result<Import, Vec<Diagnostic>> {
    let refused = |rule, message: String| Diagnostic::error(rule, message).file(file);
    if bytes.len() > LARGEST {
        let message = format!("{} bytes are more than any post has: {LARGEST}", bytes.len());
        return Err(vec![refused(Rule::Import, message)]);
    }
    let source = String::from_utf8_lossy(bytes);
    let source = source.trim_start_matches('\u{feff}');
    let mut findings = Findings { file: file.to_owned(), list: Vec::new(), more: 0 };
    let read =
        if file.to_ascii_lowercase().ends_with(".pp") { vectric::read } else { parameters::read };
    let post = read(source, &mut findings);
    if post.parts.is_empty() && !findings.failed() {
        let help = "a post of VCarve or Aspire (.pp), or templates with fields such as `[engraving: linear move]`";
        findings
            .list
            .push(refused(Rule::Import, "no block of a program is in it".to_owned()).help(help));
    }
    if findings.failed() {
        return Err(findings.listed());
    }
    let name = match extends.or_else(|| named(&[&post.title, file])) {
        Some(name) => name.to_owned(),
        None => {
            let help = "say which with --extends, such as grbl, linuxcnc, mach3, marlin, fanuc-31i";
            let message = "it does not say for which control it is".to_owned();
            return Err(vec![refused(Rule::ImportControl, message).help(help)]);
        }
    };
    let base = load_origin(&name).map_err(|why| vec![*why])?;
    let name = match is_path(&name) {
        true => way(folder, Path::new(&name)).ok_or_else(|| {
            let message = format!("there is no way from {} to `{name}`", folder.display());
            vec![refused(Rule::ImportControl, message).help("save it in the folder of that file")]
        })?,
        false => name,
    };
    let text = write::file(&post, &base, &name, file, &mut findings);
    Ok(Import { text, extends: name, findings: findings.listed() })
}

/// The way from a folder to a file, as `extends` has it.
fn way(folder: &Path, file: &Path) -> Option<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let (folder, file) = (folder.canonicalize().ok()?, file.canonicalize().ok()?);
    let (from, to) = (folder.components(), file.components());
    let common = from.clone().zip(to.clone()).take_while(|(a, b)| a == b).count();
    // Another drive has no way.
    let up = (common > 0).then(|| from.skip(common).map(|_| Some("..")))?;
    let down = to.skip(common).map(|part| part.as_os_str().to_str());
    let way = up.chain(down).collect::<Option<Vec<&str>>>()?.join("/");
    Some(if is_path(&way) { way } else { format!("./{way}") })
}

/// What the names of posts call the controls of the library.
const CONTROLS: &[(&str, &str)] = &[
    ("grbl", "grbl"),
    ("mach2", "mach3"),
    ("mach3", "mach3"),
    ("linuxcnc", "linuxcnc"),
    ("emc2", "linuxcnc"),
    ("marlin", "marlin"),
    ("fanuc", "fanuc-31i"),
    ("haas", "haas"),
    ("sinumerik", "sinumerik-828d"),
    ("siemens", "sinumerik-828d"),
    ("heidenhain", "heidenhain-tnc640"),
];

/// The control that one of `names` speaks of; none where they speak of two.
fn named(names: &[&str]) -> Option<&'static str> {
    names.iter().find_map(|name| {
        let name = name.to_ascii_lowercase();
        let mut found: Vec<&str> = (CONTROLS.iter())
            .filter(|(word, _)| name.contains(word))
            .map(|(_, control)| *control)
            .collect();
        found.dedup();
        <[&str; 1]>::try_from(found).ok().map(|[control]| control)
    })
}

/// The findings about a post.
struct Findings {
    file: String,
    list: Vec<Diagnostic>,
    /// How many are not reported.
    more: u32,
}

impl Findings {
    /// What makes the file unreadable.
    fn error(&mut self, line: u32, message: impl Into<String>) {
        self.add(Diagnostic::error(Rule::Import, message), line);
    }

    /// What is not imported.
    fn lost(&mut self, line: u32, message: impl Into<String>) {
        self.add(Diagnostic::warning(Rule::NotCarriedOver, message), line);
    }

    /// What stands otherwise than in the post.
    fn otherwise(&mut self, line: u32, message: impl Into<String>) {
        self.add(Diagnostic::warning(Rule::CarriedOtherwise, message), line);
    }

    /// What no post says, and a machine must.
    fn assumed(&mut self, rule: Rule, message: String) {
        self.add(Diagnostic::warning(rule, message), 0);
    }

    fn add(&mut self, found: Diagnostic, line: u32) {
        if self.list.len() < MOST_FINDINGS {
            self.list.push(found.file(self.file.clone()).line(line));
        } else {
            self.more += 1;
        }
    }

    fn failed(&self) -> bool {
        self.list.iter().any(Diagnostic::is_error)
    }

    fn listed(mut self) -> Vec<Diagnostic> {
        self.list.sort_by_key(|found| found.line);
        if self.more > 0 {
            let message = format!("{} more findings are not shown", self.more);
            self.list.push(Diagnostic::warning(Rule::NotCarriedOver, message).file(self.file));
        }
        self.list
    }
}
