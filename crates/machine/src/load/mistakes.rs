//! All mistakes of a machine file: each that is found is taken out of the text, and the rest is read again.

use super::file::SheetFile;
use super::{Reach, build};
use crate::model::Machine;
use program::Diagnostic;
use std::path::Path;

/// The most mistakes that are looked for.
const MOST: usize = 20;

/// The largest file in which more than one mistake is looked for, bytes: it is parsed many times.
const LARGEST: usize = 1 << 18;

/// The most lines of a value that are taken out together.
const LONGEST_VALUE: usize = 12;

impl Reach {
    /// The mistakes of the machine file `path`, and the machine that it is without them, where it is one. What only follows from
    /// what was taken out is not among them.
    pub fn mistakes(&self, path: &Path) -> (Vec<Diagnostic>, Option<Machine>) {
        let mut file = match SheetFile::read(path, self) {
            Ok(file) => file,
            Err(found) => return (vec![*found], None),
        };
        let mut mistakes = Vec::new();
        loop {
            let found = match build(file.clone(), self) {
                Ok(machine) => return (mistakes, Some(machine)),
                Err(found) => found,
            };
            let is_own = found.file == file.name() && found.line > 0;
            if !is_own && !mistakes.is_empty() {
                return (mistakes, None);
            }
            let rest = without(&file.text, found.line as usize).filter(|_| is_own);
            mistakes.push(*found);
            match rest.filter(|_| mistakes.len() < MOST) {
                Some(text) => file = SheetFile::new(path.to_path_buf(), text, true),
                None => return (mistakes, None),
            }
        }
    }
}

/// The text with blank lines in place of the value, or the table, that has this line (from 1); nothing where it is not TOML
/// without it either.
fn without(text: &str, line: usize) -> Option<String> {
    let lines: Vec<&str> = text.split('\n').collect();
    let at = line.checked_sub(1).filter(|at| *at < lines.len() && text.len() <= LARGEST)?;
    let begins_table = |line: &&str| line.trim_start().starts_with('[');
    let blank = |from: usize, to: usize| -> Option<String> {
        let kept = lines.iter().enumerate();
        let kept = kept.map(|(i, line)| if (from..to).contains(&i) { "" } else { *line });
        let rest = kept.collect::<Vec<_>>().join("\n");
        (rest != text && rest.parse::<toml::Table>().is_ok()).then_some(rest)
    };
    if begins_table(&lines[at]) {
        let next = lines.iter().skip(at + 1).position(begins_table);
        return blank(at, next.map_or(lines.len(), |more| at + 1 + more));
    }
    let around = (1..=LONGEST_VALUE).flat_map(|size| (0..size).map(move |up| (size, up)));
    around.filter(|(_, up)| *up <= at).find_map(|(size, up)| blank(at - up, at - up + size))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_of_several_lines_is_taken_out_whole_and_so_is_a_table() {
        let text = "a = 1\nb = [\n  2,\n  x,\n]\n[c]\nd = 3\n[e]\nf = 4\n";
        assert_eq!(without(text, 4).unwrap(), "a = 1\nb = [\n  2,\n\n]\n[c]\nd = 3\n[e]\nf = 4\n");
        assert_eq!(without("a = \"\"\"\n{{\n\"\"\"\nb = 2", 1).unwrap(), "\n\n\nb = 2");
        assert_eq!(without("a = 1\n[c]\nd = 3\n[e]\nf = 4", 2).unwrap(), "a = 1\n\n\n[e]\nf = 4");
        assert_eq!(without("a = 1", 7), None);
    }
}
