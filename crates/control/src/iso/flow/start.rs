//! Where the words of a line begin.

/// Where the words of a line begin, behind blanks, `/` and `N`; and the number of that N.
pub(super) fn start(line: &[u8]) -> (usize, Option<u32>) {
    let blanks = |at: usize| {
        let rest = line.get(at..).unwrap_or_default();
        at + rest.iter().take_while(|b| matches!(b, b' ' | b'\t')).count()
    };
    let digits = |at: usize| {
        let rest = line.get(at..).unwrap_or_default();
        at + rest.iter().take_while(|b| b.is_ascii_digit()).count()
    };
    let mut at = blanks(0);
    if line.get(at) == Some(&b'/') {
        at = blanks(digits(at + 1));
    }
    if !matches!(line.get(at), Some(b'N' | b'n')) {
        return (at, None);
    }
    let from = blanks(at + 1);
    let to = digits(from);
    let number = std::str::from_utf8(&line[from..to]).ok().and_then(|n| n.parse().ok());
    (blanks(to), number)
}
