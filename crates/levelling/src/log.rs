//! What a probe has found, as machines and programs write it: LinuxCNC's `PROBEOPEN`, GRBL's answers, tables.

use crate::heights::height_map;
use geom::Vec3;
use memchr::memmem;
use program::heights::HeightMap;
use program::{Diagnostic, Rule};

/// After so many errors the reader gives up.
const MOST_ERRORS: usize = 20;

/// What two ways of saying where the zero is may differ by, mm: GRBL shows thousandths.
const STEP: f64 = 0.005;

/// How GRBL begins what a probe has found.
const PROBED: &str = "[PRB:";

/// How GRBL begins the line of `$#` behind which it says the last answer once more.
const LENGTH: &str = "[TLO:";

/// How many numbers a line of LinuxCNC's log has: X Y Z A B C U V W.
const NINE: usize = 9;

/// Reads the heights in `text`: the log of a sender of GRBL, which is known by its `[PRB:`, or else a table of
/// X, Y and Z in mm, of which LinuxCNC's log is one.
///
/// # Errors
/// What is wrong with lines, at most twenty, with `file_name`; or why the points make no [`HeightMap`].
pub fn read(file_name: &str, text: &[u8]) -> Result<HeightMap, Vec<Diagnostic>> {
    let is_grbl = memmem::find(text, PROBED.as_bytes()).is_some();
    let points = if is_grbl { grbl(text) } else { table(text) };
    let map = points.and_then(|points| height_map(&points).map_err(|found| vec![*found]));
    map.map_err(|found| found.into_iter().map(|found| found.file(file_name)).collect())
}

/// The lines of a text with their numbers, without the blanks about them.
fn lines(text: &[u8]) -> impl Iterator<Item = (u32, &[u8])> {
    let lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    lines.enumerate().map(|(index, line)| (u32::try_from(index + 1).unwrap_or(u32::MAX), line))
}

fn wrong(number: u32, line: &[u8], message: impl Into<String>, help: &str) -> Diagnostic {
    Diagnostic::error(Rule::HeightMap, message).help(help).on(number, line)
}

/// The numbers of a line, which commas, semicolons or blanks separate.
fn numbers(line: &[u8]) -> Option<Vec<f64>> {
    let line = std::str::from_utf8(line).ok()?;
    let parts = line.split(|c: char| c == ',' || c == ';' || c.is_ascii_whitespace());
    let number = |part: &str| part.parse::<f64>().ok().filter(|number| number.is_finite());
    parts.filter(|part| !part.is_empty()).map(number).collect()
}

/// The points of a table, one a line. It may have a head that names X, Y and Z, and lines with `#`.
fn table(text: &[u8]) -> Result<Vec<Vec3>, Vec<Diagnostic>> {
    let (mut points, mut errors) = (Vec::new(), Vec::new());
    let mut has_begun = false;
    for (number, line) in lines(text.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(text)) {
        if line.is_empty() || line.starts_with(b"#") {
            continue;
        }
        let is_first = !std::mem::replace(&mut has_begun, true);
        if is_first && is_head(line) {
            continue;
        }
        match numbers(line).as_deref() {
            Some([x, y, z]) => points.push(Vec3::new(*x, *y, *z)),
            Some([x, y, z, rest @ ..]) if rest.len() == NINE - 3 => {
                points.push(Vec3::new(*x, *y, *z));
            }
            _ => {
                let help = "a line is X, Y and Z in mm, or the nine numbers of LinuxCNC's log";
                errors.push(wrong(number, line, "this is no place of a surface", help));
            }
        }
        if errors.len() == MOST_ERRORS {
            break;
        }
    }
    if errors.is_empty() { Ok(points) } else { Err(errors) }
}

/// Whether a line names the columns X, Y and Z.
fn is_head(line: &[u8]) -> bool {
    let letters = line.iter().filter(|byte| byte.is_ascii_alphabetic());
    letters.map(u8::to_ascii_lowercase).eq(*b"xyz")
}

/// What lies between the coordinates of a machine with GRBL and those of its work.
#[derive(Clone, Copy, Debug, Default)]
struct Offsets {
    /// `WCO` of a status: all of them.
    whole: Option<Vec3>,
    /// `G54`, `G92` and `TLO` of `$#`.
    parts: Option<Vec3>,
    shift: Vec3,
    length: f64,
}

impl Offsets {
    fn sum(&self) -> Option<Vec3> {
        let parts = self.parts.map(|offset| offset + self.shift + Vec3::Z * self.length);
        self.whole.or(parts)
    }

    /// Takes what a line says of them.
    fn take(&mut self, line: &str) {
        let of = |key: &str| {
            let (_, rest) = line.split_once(key)?;
            numbers(rest.split(['|', '>', ']']).next()?.as_bytes())
        };
        let vector = |key: &str| match of(key)?[..] {
            [x, y, z, ..] => Some(Vec3::new(x, y, z)),
            _ => None,
        };
        self.whole = vector("WCO:").or(self.whole);
        // What `$#` says is newer than the status before.
        if let Some(offset) = vector("[G54:") {
            (self.whole, self.parts) = (None, Some(offset));
        }
        self.shift = vector("[G92:").unwrap_or(self.shift);
        self.length = of(LENGTH).and_then(|tlo| tlo.first().copied()).unwrap_or(self.length);
    }
}

/// The points of a sender's log. GRBL says them in the coordinates of the machine.
fn grbl(text: &[u8]) -> Result<Vec<Vec3>, Vec<Diagnostic>> {
    let mut offsets = Offsets::default();
    let mut points: Vec<Vec3> = Vec::new();
    // The offset of the points, as far as it has been said.
    let mut known: Option<Vec3> = None;
    let mut repeats = false;
    for (number, line) in lines(text) {
        let Ok(shown) = std::str::from_utf8(line) else { continue };
        let repeated = std::mem::replace(&mut repeats, shown.contains(LENGTH));
        offsets.take(shown);
        if !points.is_empty() && shown.contains("ALARM:") {
            let help = "probe the surface anew, as deep as it lies";
            return Err(vec![wrong(number, line, "the probing was broken off", help)]);
        }
        let Some((_, found)) = shown.split_once(PROBED).filter(|_| !repeated) else { continue };
        let place = found.split_once(']').and_then(|(found, _)| found.rsplit_once(':'));
        let point = place.and_then(|(place, touched)| Some((numbers(place.as_bytes())?, touched)));
        let point = match point.as_ref().map(|(place, touched)| (&place[..], *touched)) {
            Some(([x, y, z, ..], "1")) => Vec3::new(*x, *y, *z),
            // Nothing was touched: an alarm has reported that, or `$#` that nothing was probed.
            Some((_, "0")) => continue,
            _ => {
                let help = "an answer is [PRB:x,y,z:1]";
                return Err(vec![wrong(number, line, "this is no answer of a probe", help)]);
            }
        };
        points.push(point);
        let offset = offsets.sum();
        let moves = |(a, b): (Vec3, Vec3)| a.distance(b) > STEP;
        if known.zip(offset).is_some_and(moves) {
            let message = "the zero of the work was moved while the surface was probed";
            return Err(vec![wrong(number, line, message, "keep the answers of one probing")]);
        }
        known = offset.or(known);
    }
    let Some(offset) = known.or(offsets.sum()) else {
        let message =
            "the answers count from the machine's home, and where the work's zero is, is not said";
        let help =
            "send $# before or after the probing and keep its answer, [G54:x,y,z], in the log";
        return Err(vec![Diagnostic::error(Rule::HeightMap, message).help(help)]);
    };
    Ok(points.into_iter().map(|point| point - offset).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec2;

    fn height(text: &str, x: f64, y: f64) -> f64 {
        let map = read("heights", text.as_bytes()).unwrap_or_else(|found| panic!("{found:?}"));
        map.at(Vec2::new(x, y))
    }

    #[track_caller]
    fn refuses(text: &str, message: &str, line: u32) {
        let found = read("heights.txt", text.as_bytes()).unwrap_err();
        assert!(found[0].message.contains(message), "{found:?}");
        assert_eq!((found[0].line, found[0].file.as_str()), (line, "heights.txt"));
    }

    /// As `emccanon.cc` prints them: `%f`, nine of them.
    #[test]
    fn the_log_of_linuxcnc_is_read() {
        let zero = "0.000000 0.000000 0.000000 0.000000 0.000000 0.000000";
        let points = ["0.000000 0.000000 0.010000", "30.000000 0.000000 0.030000"];
        let more = ["30.000000 20.000000 -0.050000", "0.000000 20.000000 -0.010000"];
        let text: String =
            [points, more].concat().iter().map(|p| format!("{p} {zero}\n")).collect();
        assert!((height(&text, 15.0, 0.0) - 0.02).abs() < 1e-12);
        assert!((height(&text, 15.0, 20.0) + 0.03).abs() < 1e-12);
    }

    const GRBL: &str = "ok\n[PRB:-100.000,-80.000,-20.100:1]\nok\n<Run|MPos:-70.000,-80.000,-18.000|FS:0,0>\n\
        [PRB:-70.000,-80.000,-20.300:1]\nok\n[PRB:-70.000,-60.000,-20.000:1]\r\n[PRB:-100.000,-60.000,-19.900:1]\n";

    /// Work zero at machine -100 -80 -20: heights -0.1, -0.3, 0, 0.1.
    #[test]
    fn the_answers_of_grbl_count_from_the_zero_that_the_log_says() {
        let status =
            format!("<Idle|MPos:0.000,0.000,0.000|FS:0,0|WCO:-100.000,-80.000,-20.000>\n{GRBL}");
        let numbers = "[G54:-100.000,-80.000,-21.000]\n[G55:1.0,2.0,3.0]\n[G92:0.000,0.000,0.500]\n\
            [TLO:0.500]\n";
        // `$#` says the last answer once more, and before the first that there is none.
        let last = "[PRB:-100.000,-60.000,-19.900:1]\nok\n";
        let before = format!("{numbers}[PRB:0.000,0.000,0.000:0]\nok\n{GRBL}");
        let behind = format!("{GRBL}{numbers}{last}");
        // An earlier touch-off next to the surface is the last answer there.
        let touched = format!("{numbers}[PRB:-5.000,-5.000,-42.000:1]\nok\n{GRBL}");
        for text in [&status, &before, &behind, &touched] {
            assert!((height(text, 0.0, 0.0) + 0.1).abs() < 1e-9, "{text}");
            assert!((height(text, 30.0, 0.0) + 0.3).abs() < 1e-9, "{text}");
            assert!((height(text, 0.0, 20.0) - 0.1).abs() < 1e-9, "{text}");
        }
    }

    #[test]
    fn tables_are_read_with_and_without_a_head() {
        let rows = "0,0,0.1\n10,0,0.2\n\n0,10,0.3\n10,10,0.4\n";
        for text in [rows.to_owned(), format!("\u{feff}x, y, z\n{rows}"), format!("# mm\n{rows}")] {
            assert_eq!(height(&text, 10.0, 10.0), 0.4);
        }
        assert_eq!(height(&rows.replace(',', ";").replace('\n', "\r\n"), 0.0, 0.0), 0.1);
        assert_eq!(height(&rows.replace(',', "\t"), 0.0, 10.0), 0.3);
    }

    #[test]
    fn what_is_no_log_is_refused_with_its_line() {
        refuses("0,0,0\n10,0\n", "no place of a surface", 2);
        refuses("0 0 0\n0 10 nan\n", "no place of a surface", 2);
        refuses("0 0 0 0\n", "no place of a surface", 1);
        refuses("x,y,w\n", "no place of a surface", 1);
        refuses("", "0 points", 0);
        refuses(GRBL, "where the work's zero is, is not said", 0);
        let zero = "[G54:-100.000,-80.000,-20.000]\n";
        refuses(&format!("{zero}{GRBL}ALARM:5\n"), "broken off", 10);
        refuses(&format!("{zero}[PRB:1.0,2.0:1]\n"), "no answer of a probe", 2);
        let moved = GRBL.replace("<Run|", "<Run|WCO:-100.000,-80.000,-20.500|");
        refuses(&format!("{zero}{moved}"), "the zero of the work was moved", 6);
        let many = "no number\n".repeat(100);
        assert_eq!(read("heights", many.as_bytes()).unwrap_err().len(), MOST_ERRORS);
    }
}
