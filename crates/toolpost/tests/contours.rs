//! Contours of lines and arcs, made by chance, on robots: what the writer makes of one passes its own proof, or the writer refuses it before.

mod dice;
mod files;
mod robot;

use dice::Dice;
use geom::Vec2;
use machine::Machine;
use program::{CompensatedPath, Program};
use std::fmt::Write as _;

/// Each robot of another language.
const LANGUAGES: [&str; 4] =
    ["kuka-kr6-r900", "universal-ur5e", "fanuc-lrmate-200id-mill", "abb-irb120-mill"];

/// A contour as cutter-location data: a way in to its first point, its elements, and a way out.
struct Contour {
    text: String,
    at: Vec2,
    decimals: usize,
}

impl Contour {
    fn begin(diameter: f64, side: &str, [from, to]: [Vec2; 2], decimals: usize) -> Contour {
        let text = format!(
            "PARTNO/JOB\nUNITS/MM\nCUTTER/{diameter}\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/{0},{1},20\nFEDRAT/MMPM,300\n\
             GOTO/{0},{1},-2\nCUTCOM/{side}\nFEDRAT/MMPM,1200\n",
            from.x, from.y
        );
        let mut contour = Contour { text, at: from, decimals };
        contour.line(to);
        contour
    }

    fn rounded(&self, to: Vec2) -> Vec2 {
        let steps = 10_f64.powi(self.decimals as i32);
        (to * steps).round() / steps
    }

    fn line(&mut self, to: Vec2) {
        self.at = self.rounded(to);
        writeln!(self.text, "GOTO/{},{},-2", self.at.x, self.at.y).unwrap();
    }

    /// About a centre, counter-clockwise or clockwise.
    fn arc(&mut self, center: Vec2, left: bool, to: Vec2) {
        let radius = center.distance(self.at);
        let k = if left { 1 } else { -1 };
        writeln!(self.text, "CIRCLE/{:.5},{:.5},-2,0,0,{k},{radius:.5}", center.x, center.y)
            .unwrap();
        self.line(to);
    }

    fn end(mut self, out: Vec2) -> Program {
        self.text += "CUTCOM/OFF\n";
        self.line(out);
        write!(self.text, "RAPID\nGOTO/{},{},20\nSPINDL/OFF\nFINI\n", self.at.x, self.at.y)
            .unwrap();
        read(&self.text)
    }
}

fn read(text: &str) -> Program {
    let options =
        source::apt::Options { cutcom: Some(CompensatedPath::Contour), ..Default::default() };
    source::apt::read("job.cls", text.as_bytes(), &options).unwrap().program
}

/// Whether it is proven; refused by the writer otherwise.
#[track_caller]
fn made(source: &Program, machine: &Machine, what: &str) -> bool {
    let Ok(text) = robot::written(source, machine) else { return false };
    let report = robot::proof_of(source, machine, &text);
    assert!(report.proven, "{what} {}: {:#?}\n{text}", machine.name, report.mismatches);
    true
}

/// In a wall along X 30 a nose of an arc, or a hollow, of 12 to 35 mm radius: the corners on both sides of it are inner ones where the
/// tool is on the side of the nose, and flat: rounding of three points of such an arc moves its centre by hundredths of a mm.
#[test]
fn corners_between_a_straight_side_and_an_arc_are_made() {
    let mut dice = Dice(5);
    for k in 0..24 {
        let radius: f64 = dice.one_of(&[12.0, 20.0, 35.0]);
        let half = dice.number(4.0, (radius * 0.9).min(15.0));
        let across = (radius * radius - half * half).sqrt();
        let hollow = k % 3 == 2;
        let (center, side) = match hollow {
            false => (Vec2::new(30.0 - across, 0.0), "RIGHT"),
            true => (Vec2::new(30.0 + across, 0.0), "RIGHT"),
        };
        let [x, out] = [30.0, 60.0];
        let mut contour =
            Contour::begin(10.0, side, [Vec2::new(out, -34.0), Vec2::new(x, -34.0)], 5);
        contour.line(Vec2::new(x, -half));
        contour.arc(center, !hollow, Vec2::new(x, half));
        contour.line(Vec2::new(x, 34.0));
        let source = contour.end(Vec2::new(out, 34.0));
        let name = LANGUAGES[k % 4];
        let machine = machine::load(name).unwrap();
        let is_made = made(&source, &machine, &format!("{k}: radius {radius}, half {half}"));
        // By hand: a hollow of radius R takes a tool of radius 5 where the tool fits between its corners.
        assert!(is_made || hollow, "{k} {name} radius {radius} half {half}");
    }
}

/// A full circle as one, and two half circles, from inside and outside.
#[test]
fn circles_are_made() {
    for name in LANGUAGES {
        let machine = machine::load(name).unwrap();
        // From inside down to a centre path of radius 0.2 mm.
        for (radius, out) in [(20.0, 40.0), (20.0, 3.0), (5.2, 0.0)] {
            let (side, left) = if out > radius { ("LEFT", false) } else { ("LEFT", true) };
            let [from, start] = [Vec2::new(out, 0.0), Vec2::new(radius, 0.0)];
            let mut whole = Contour::begin(10.0, side, [from, start], 5);
            whole.arc(Vec2::ZERO, left, start);
            assert!(made(&whole.end(from), &machine, "whole"), "{name} {radius} {out}");
            let mut halves = Contour::begin(10.0, side, [from, start], 5);
            halves.arc(Vec2::ZERO, left, -start);
            halves.arc(Vec2::ZERO, left, start);
            assert!(made(&halves.end(from), &machine, "halves"), "{name} {radius} {out}");
        }
    }
}

/// Around a square of 40 mm: one of its corners, or a point of a side, is given twice, or within 0.4 µm once more.
#[test]
fn a_point_given_twice_changes_nothing() {
    let corners = [[0.0, 0.0], [0.0, 40.0], [40.0, 40.0], [40.0, 0.0], [0.0, 0.0]].map(Vec2::from);
    for name in LANGUAGES {
        let machine = machine::load(name).unwrap();
        for (behind, aside) in
            [(1, 0.0), (2, 0.0), (4, 0.0), (0, 4e-4), (1, 4e-4), (3, 4e-4), (5, 0.0)]
        {
            let mut contour =
                Contour::begin(10.0, "LEFT", [Vec2::new(-20.0, -20.0), corners[0]], 5);
            for (i, corner) in corners.iter().enumerate() {
                if i > 0 {
                    contour.line(*corner);
                }
                if i == behind {
                    contour.line(*corner + Vec2::new(0.0, aside));
                }
                if i == 1 && behind == 5 {
                    contour.line(Vec2::new(20.0, 40.0));
                    contour.line(Vec2::new(20.0004, 40.0));
                }
            }
            let source = contour.end(Vec2::new(-20.0, -20.0));
            assert!(made(&source, &machine, "twice"), "{name} {behind} {aside}");
        }
    }
}
