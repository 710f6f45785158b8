//! A text by its lines, which end with LF, CR LF or CR, and are counted from 1.

use std::sync::Arc;

/// The most characters of a line that are shown: the rest of a longer one is left out, and that is said.
pub const MOST_SHOWN: usize = 2000;

/// A text, and where its lines begin.
#[derive(Debug, Default)]
pub struct Lines {
    text: Arc<Vec<u8>>,
    /// Where every 16th line begins, from the first.
    begins: Vec<usize>,
    count: u32,
}

/// Of how many lines one place is kept.
const EVERY: usize = 16;

impl Lines {
    /// Of a text, which others may have too.
    pub fn of(text: impl Into<Arc<Vec<u8>>>) -> Lines {
        let text = text.into();
        let (mut begins, mut count, mut at) = (Vec::new(), 0usize, 0);
        while at < text.len() {
            if count.is_multiple_of(EVERY) {
                begins.push(at);
            }
            count += 1;
            at = end_of(&text, at).1;
        }
        Lines { text, begins, count: u32::try_from(count).unwrap_or(u32::MAX) }
    }

    /// The whole text.
    pub fn text(&self) -> &[u8] {
        &self.text
    }

    /// How many lines there are.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// How much memory it takes, bytes.
    pub fn bytes(&self) -> usize {
        self.text.len() + self.begins.len() * size_of::<usize>()
    }

    /// Where a line begins.
    fn begin(&self, line: u32) -> Option<usize> {
        let place = line.checked_sub(1).filter(|_| line <= self.count)? as usize;
        let mut at = *self.begins.get(place / EVERY)?;
        for _ in 0..place % EVERY {
            at = end_of(&self.text, at).1;
        }
        Some(at)
    }

    /// A line without its end; empty where there is none.
    pub fn line(&self, line: u32) -> &[u8] {
        let Some(at) = self.begin(line) else { return &[] };
        &self.text[at..end_of(&self.text, at).0]
    }

    /// Lines `from` up to, not including, `to`, each ended by LF, without control characters and in UTF-8, whatever the file is in; and
    /// how many of them were cut. No more than `most` bytes and one line are answered: the last number is the line behind the last one.
    pub fn shown(&self, from: u32, to: u32, most: usize) -> (Vec<u8>, u32, u32) {
        let (mut shown, mut cut, mut line) = (Vec::new(), 0, from.max(1));
        let Some(mut at) = self.begin(line) else { return (shown, cut, line) };
        while line < to && line <= self.count && shown.len() < most {
            let (end, next) = end_of(&self.text, at);
            let (text, is_cut) = readable(&self.text[at..end]);
            shown.extend_from_slice(text.as_bytes());
            shown.push(b'\n');
            cut += u32::from(is_cut);
            (line, at) = (line + 1, next);
        }
        (shown, cut, line)
    }

    /// The first line from `from` on that has `text` in it, whatever its capitals, and the column (characters, from 1); from the
    /// beginning where there is none behind.
    pub fn find(&self, text: &[u8], from: u32) -> Option<(u32, u32)> {
        if text.is_empty() {
            return None;
        }
        let from = from.clamp(1, self.count.max(1));
        let (behind, before) = ((from, self.count), (1, from - 1));
        [behind, before].into_iter().find_map(|(from, to)| self.find_within(text, from, to))
    }

    fn find_within(&self, text: &[u8], from: u32, to: u32) -> Option<(u32, u32)> {
        let mut at = self.begin(from)?;
        for line in from..=to {
            let (end, next) = end_of(&self.text, at);
            let own = &self.text[at..end];
            if let Some(place) =
                own.windows(text.len()).position(|own| own.eq_ignore_ascii_case(text))
            {
                let before = String::from_utf8_lossy(&own[..place]);
                return Some((line, before.chars().count() as u32 + 1));
            }
            at = next;
        }
        None
    }
}

/// Where the line that begins at `at` ends, and where the next one begins.
fn end_of(text: &[u8], at: usize) -> (usize, usize) {
    let end = memchr::memchr2(b'\n', b'\r', &text[at..]);
    let end = end.map_or(text.len(), |end| at + end);
    let length = if text[end..].starts_with(b"\r\n") { 2 } else { usize::from(end < text.len()) };
    (end, end + length)
}

/// A line as it is shown, and whether it was cut.
pub fn readable(line: &[u8]) -> (String, bool) {
    // A character has four bytes at most.
    let window = &line[..line.len().min(4 * MOST_SHOWN)];
    let text = String::from_utf8_lossy(window);
    let is_cut = window.len() < line.len() || text.chars().nth(MOST_SHOWN).is_some();
    let shown = text.chars().take(MOST_SHOWN);
    let shown = shown.map(|c| if c.is_control() && c != '\t' { '\u{fffd}' } else { c });
    (shown.collect(), is_cut)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &[u8] = b"one\r\ntwo\rthree\n\nfive \xff\x07";

    #[test]
    fn lines_end_as_the_findings_count_them() {
        let lines = Lines::of(TEXT.to_vec());
        assert_eq!(lines.count(), 5);
        for line in 0..=7 {
            assert_eq!(
                lines.line(line),
                program::line_of(TEXT, line.max(1))
                    .to_vec()
                    .as_slice()
                    .get(..lines.line(line).len())
                    .unwrap()
            );
        }
        assert_eq!(lines.line(3), b"three");
        assert_eq!((lines.line(0), lines.line(6)), (&b""[..], &b""[..]));
        let many = Lines::of((1..=100).map(|n| format!("{n}\n")).collect::<String>().into_bytes());
        assert!((1..=100).all(|n| many.line(n) == n.to_string().as_bytes()));
        assert_eq!(Lines::of(Vec::new()).count(), 0);
    }

    #[test]
    fn what_is_shown_is_text_and_says_what_is_cut() {
        let lines = Lines::of(TEXT.to_vec());
        let (shown, cut, next) = lines.shown(4, 9, 1000);
        assert_eq!((shown.as_slice(), cut, next), ("\nfive \u{fffd}\u{fffd}\n".as_bytes(), 0, 6));
        assert_eq!(lines.shown(1, 9, 1), (b"one\n".to_vec(), 0, 2));
        assert_eq!(lines.shown(6, 9, 1000), (Vec::new(), 0, 6));
        let long = Lines::of(vec![b'x'; 50_000_000]);
        let (shown, cut, _) = long.shown(1, 2, 1000);
        assert_eq!((shown.len(), cut), (MOST_SHOWN + 1, 1));
    }

    #[test]
    fn a_search_goes_round() {
        let lines = Lines::of(b"G1 X1\nG1 Y2 (\xc3\xa9) X1\nG0\n".to_vec());
        assert_eq!(lines.find(b"x1", 1), Some((1, 4)));
        assert_eq!(lines.find(b"x1", 2), Some((2, 11)));
        assert_eq!(lines.find(b"x1", 3), Some((1, 4)));
        assert_eq!(lines.find(b"x1", 99), Some((1, 4)));
        assert_eq!((lines.find(b"", 1), lines.find(b"Z", 2)), (None, None));
        assert_eq!(Lines::of(Vec::new()).find(b"x", 1), None);
    }
}
