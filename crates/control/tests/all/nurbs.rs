//! `G5.2` to `G5.3` of LinuxCNC. The judge is its own preview (the module `gcode` of the package), which prints places on the
//! curve, and `rs274` for what it refuses; the circle is known without either.

use crate::common::linuxcnc::{ours, theirs};
use geom::Vec3;
use std::process::Command;
use toolpost_control::{Action, Dialect, Settings, read};

/// Prints the end of each cut in mm, without what moves the work.
const PREVIEW: &str = r#"
import sys
import gcode
class Canon:
    parameter_file = sys.argv[2]
    def __getattr__(self, name):
        return lambda *_: None
    def straight_feed(self, *place):
        print(*(25.4 * value for value in place[:3]))
    def get_tool(self, number):
        return (-1,) + 13 * (0,)
    def get_external_length_units(self):
        return 1.0
    def get_external_angular_units(self):
        return 1.0
    def get_axis_mask(self):
        return 7
    def get_block_delete(self):
        return False
    def check_abort(self):
        return False
result, line = gcode.parse(sys.argv[1], Canon(), "G21", "")
sys.exit(0 if result <= 1 else 1)
"#;

/// The ends of our cuts, mm.
fn cuts(text: &str) -> Vec<Vec3> {
    let settings = Settings::new(Dialect::LinuxCnc, [false; 3]);
    let mut ends = Vec::new();
    let run = read(&settings, "nurbs.ngc", text.as_bytes(), &mut |event| {
        if let Action::Line(position) = event.action {
            ends.push(position.point);
        }
        Ok(())
    });
    run.unwrap_or_else(|error| panic!("{text}\n{error}"));
    ends
}

/// Places of LinuxCNC's preview on the cuts, mm; `None` where it is not installed.
fn preview(text: &str) -> Option<Vec<Vec3>> {
    let python = judge::python("gcode")?;
    let place = tempfile::tempdir().unwrap();
    let (program, parameters) = (place.path().join("nurbs.ngc"), place.path().join("rs274.var"));
    std::fs::write(&program, text).unwrap();
    std::fs::write(&parameters, "").unwrap();
    let mut run = Command::new(python);
    let run = run.args(["-c", PREVIEW]).args([&program, &parameters]);
    let run = run.env("HOME", place.path()).output().unwrap();
    assert!(run.status.success(), "{text}\n{}", String::from_utf8_lossy(&run.stderr));
    let numbers = |line: &str| -> Option<Vec3> {
        let mut numbers = line.split(' ').map(|number| number.parse().ok());
        Some(Vec3::new(numbers.next()??, numbers.next()??, numbers.next()??))
    };
    Some(String::from_utf8_lossy(&run.stdout).lines().filter_map(numbers).collect())
}

/// Distance of `point` from the nearest of the straight lines through `way`.
fn away(way: &[Vec3], point: Vec3) -> f64 {
    let from_line = |pair: &[Vec3]| {
        let way = pair[1] - pair[0];
        let part = (point - pair[0]).dot(way) / way.length_squared().max(1e-18);
        point.distance(pair[0] + way * part.clamp(0.0, 1.0))
    };
    way.windows(2).map(from_line).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_nurbs_goes_where_linuxcnc_goes() {
    let start = "G21 G90 G17\nF100\nG0 X3 Y-2 Z1\n";
    let curves = [
        "G5.2 P1 L3\nX0 Y1 P1\nX2 Y2 P1\nX2 Y0 P1\nX0 Y0 P2\nG5.3\n",
        "G5.2 X0 Y1 P3\nX20 Y22 P1\nX25 Y0 P.5\nX0 Y0 P2\nG5.3\n",
        "G5.2 P3 L3\nX0 Y10 P1\nX20 Y20 P1\nX20 Y0 P1\nX0 Y0 P2\nG5.3\n",
        "G5.2 X0 Y10 P1 L2\nX20 Y20 P1\nX20 Y0 P1\nG5.3\n",
        "G5.2 X0 Y10 P1 L4\nX20 Y20 P1\nX20 Y0 P1\nX0 Y0 P2\nX5 Y30 P1\nX9 Y9 P1\nG5.3\n",
        "G5.2 X0 Y10 P1 L5\nX20 Y20 P1\nX20 Y0 P1\nX0 Y0 P2\nG5.3\n",
        "G5.2\nX0 Y10 P1 F200\n(words)\n\nX20 Y20 P1\nX20 Y0 P1\nG5.3\n",
        // Increments count from where the tool stands before the curve.
        "G91 G5.2 X0 Y10 P1\nX20 Y10 P1\nX20 Y0 P1\nG5.3\nG1 X1\n",
        "G20 G1 X1 Y1 Z1\nG5.2 X0 Y1 P1\nX2 Y1 P1\nX2 Y0 P1\nG5.3\n",
        "#1=5\nG5.2 X#1 Y10 P[#1-4]\no1 repeat [3]\n#1=[#1+3]\nX#1 Y[#1*#1/10] P1\no1 endrepeat\nG5.3\n",
    ];
    for curve in curves {
        let text = format!("{start}{curve}M2\n");
        let ours = cuts(&text);
        let Some(theirs) = preview(&text) else { return };
        let from = Vec3::new(3.0, -2.0, 1.0);
        let [ours, theirs] = [ours, theirs].map(|ends| [vec![from], ends].concat());
        assert!(theirs.len() > 40, "{text}\n{theirs:?}");
        let ends = [&ours, &theirs].map(|way| way[way.len() - 1]);
        assert!(ends[0].distance(ends[1]) < 1e-6, "{text}\n{ends:?}");
        for point in &theirs {
            assert!(away(&ours, *point) < 0.00051, "{text}\n{point} by {}", away(&ours, *point));
        }
        // Its own chords are off by more than ours.
        for point in &ours {
            assert!(away(&theirs, *point) < 0.06, "{text}\n{point} by {}", away(&theirs, *point));
        }
    }
}

/// A quarter of a circle is a curve of order 3 whose middle point has the weight √½ (Piegl and Tiller, "The NURBS Book", 7.3).
#[test]
fn a_nurbs_can_be_a_circle() {
    let text =
        "G21 G90 G17\nF100\nG0 X10 Y0 Z0\nG5.2 X10 Y10 P0.70710678118654757\nX0 Y10 P1\nG5.3\nM2\n";
    let ends = cuts(text);
    assert!(ends.len() > 8, "{ends:?}");
    for end in &ends {
        assert!((end.length() - 10.0).abs() < 1e-9, "{end}");
    }
    // A chord of R 10 within 0.0005 mm turns by 4·asin(√(0.0005 / 20)) = 1.146°: the quarter takes 79 of them or more.
    assert!((79..=160).contains(&ends.len()), "{}", ends.len());
}

#[test]
fn what_is_no_nurbs_is_refused_as_by_linuxcnc() {
    let points = "X2 Y2 P1\nX2 Y0 P1\nX0 Y0 P2\n";
    for curve in [
        format!("G5.2 X0 Y1 P1 L6\n{points}G5.3\n"),
        format!("G5.2 X0 P1\n{points}G5.3\n"),
        "G5.2 X0 Y1 P1\nX2 P1\nX3 Y3 P1\nG5.3\n".to_owned(),
        "G5.2 X0 Y1 P1\nX2 Y2\nX3 Y3 P1\nG5.3\n".to_owned(),
        format!("G18 G5.2 X0 Z1 P1\n{points}G5.3\n"),
        "G5.3\n".to_owned(),
        format!("G5.2 X0 Y1 P1 L2.5\n{points}G5.3\n"),
        format!("G5.2 X0 Y1 P1\n{points}G5.3\nX1\n"),
    ] {
        let text = format!("G21 G90 G17\nF100\nG0 X0 Y0 Z0\n{curve}M2\n");
        assert!(ours(text.as_bytes(), [false; 3], &[]).is_err(), "we take\n{text}");
        if let Some(theirs) = theirs(text.as_bytes(), &[]) {
            assert!(theirs.is_err(), "LinuxCNC takes\n{text}");
        }
    }
    // What LinuxCNC passes over or drops in silence: weights that are missing or 0, other axes and words, no end.
    for curve in [
        format!("G5.2 X0 Y1\n{points}G5.3\n"),
        format!("G5.2 X0 Y1 P0\n{points}G5.3\n"),
        format!("G5.2 X0 Y1 P1 Z1\n{points}G5.3\n"),
        format!("G18 G5.2 X0 Y1 P1\n{points}G5.3\n"),
        format!("G5.2 X0 Y1 P1\n{points}"),
        format!("G5.2 X0 Y1 P1\nG1 X5\n{points}G5.3\n"),
        format!("G5.2 X0 Y1 P1\n{points}G5.3 X1 Y1\n"),
        format!("G5.2 X0 Y1 P1\n{points}M3\nG5.3\n"),
        format!("G5.2 X0 Y1 P1\nG5.2 X1 Y1 P1\n{points}G5.3\n"),
        format!("G41.1 D1\nG5.2 X0 Y1 P1\n{points}G5.3\n"),
    ] {
        for end in ["M2\n", ""] {
            let text = format!("G21 G90 G17\nF100\nG0 X0 Y0 Z0\n{curve}{end}");
            assert!(ours(text.as_bytes(), [false; 3], &[]).is_err(), "we take\n{text}");
        }
    }
}
