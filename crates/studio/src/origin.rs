//! The files that a program is made of, as one text: their lines are counted through, so that a line of any of them is one number.

use crate::lines::Lines;

/// The files of a source. The first one is the source that the page shows where no file is named.
#[derive(Debug)]
pub struct Texts {
    /// Each with its name, and how many lines there are before it.
    files: Vec<(String, Lines, u32)>,
}

impl Texts {
    /// Of a file.
    pub fn of(name: String, text: Lines) -> Texts {
        Texts { files: vec![(name, text, 0)] }
    }

    /// The same with another file behind. One whose name is there already cannot be asked for, and is left out.
    #[must_use]
    pub fn with(mut self, name: String, text: Lines) -> Texts {
        if self.files.iter().all(|(own, ..)| *own != name) {
            let before = self.files.last().map_or(0, |(_, text, before)| before + text.count());
            self.files.push((name, text, before));
        }
        self
    }

    /// The name of the first.
    pub fn name(&self) -> &str {
        self.files.first().map_or("", |(name, ..)| name)
    }

    /// All, each with its name.
    pub fn all(&self) -> impl Iterator<Item = (&str, &Lines)> {
        self.files.iter().map(|(name, text, _)| (&**name, text))
    }

    /// The text of a file; of the first where none is named.
    pub fn text(&self, file: Option<&str>) -> Option<&Lines> {
        self.file(file).map(|(_, text, _)| text)
    }

    fn file(&self, file: Option<&str>) -> Option<&(String, Lines, u32)> {
        self.files.iter().find(|(name, ..)| file.is_none_or(|file| file == name))
    }

    /// The number of a line of a file.
    pub fn number(&self, file: Option<&str>, line: u32) -> Option<u32> {
        let (_, text, before) = self.file(file)?;
        (1..=text.count()).contains(&line).then(|| before + line)
    }

    /// The file that a line stands in, where it is not the first, and its line there.
    pub fn place(&self, number: u32) -> (Option<&str>, u32) {
        let behind = self.files.partition_point(|(.., before)| *before < number);
        match behind.checked_sub(1).map(|place| (place, &self.files[place])) {
            None | Some((0, _)) => (None, number),
            Some((_, (name, _, before))) => (Some(name), number - before),
        }
    }

    /// How much memory they take, bytes.
    pub fn bytes(&self) -> usize {
        self.files.iter().map(|(_, text, _)| text.bytes()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_several_files_are_counted_through() {
        let text = |text: &str| Lines::of(text.as_bytes().to_vec());
        let texts = Texts::of("board".into(), text("a\nb\n"))
            .with("front.gbr".into(), text("c\nd\ne\n"))
            .with("empty".into(), text(""))
            .with("front.gbr".into(), text("again\n"))
            .with("holes.drl".into(), text("f\n"));
        assert_eq!(texts.number(None, 2), Some(2));
        assert_eq!(texts.number(Some("front.gbr"), 1), Some(3));
        assert_eq!(texts.number(Some("front.gbr"), 4), None);
        assert_eq!(texts.number(Some("holes.drl"), 1), Some(6));
        assert_eq!((texts.number(Some("empty"), 1), texts.number(Some("none"), 1)), (None, None));
        assert_eq!((texts.place(0), texts.place(2)), ((None, 0), (None, 2)));
        assert_eq!(texts.place(3), (Some("front.gbr"), 1));
        assert_eq!(texts.place(5), (Some("front.gbr"), 3));
        assert_eq!(texts.place(6), (Some("holes.drl"), 1));
        assert_eq!(texts.text(Some("holes.drl")).unwrap().line(1), b"f");
    }
}
