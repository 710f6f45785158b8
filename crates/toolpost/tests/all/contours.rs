//! Contours of lines and arcs, made by chance, on robots: what the writer makes of one passes its own proof, or the writer refuses it before.

use crate::dice::Dice;
use control::{ArmPath, Dialect};
use geom::{Vec2, Vec3, nearest_on_segment};
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

    fn end(self, out: Vec2) -> Program {
        self.read(out).unwrap()
    }

    /// What the reader makes of it, which takes no arc that is smaller than the tool.
    fn read(mut self, out: Vec2) -> Option<Program> {
        self.text += "CUTCOM/OFF\n";
        self.line(out);
        write!(self.text, "RAPID\nGOTO/{},{},20\nSPINDL/OFF\nFINI\n", self.at.x, self.at.y)
            .unwrap();
        read(&self.text)
    }
}

fn read(text: &str) -> Option<Program> {
    let options =
        source::apt::Options { cutcom: Some(CompensatedPath::Contour), ..Default::default() };
    source::apt::read("job.cls", text.as_bytes(), &options).ok().map(|read| read.program)
}

/// Whether it is proven; refused by the writer otherwise.
#[track_caller]
fn made(source: &Program, machine: &Machine, what: &str) -> bool {
    let Ok(text) = crate::robot::written(source, machine) else { return false };
    let report = crate::robot::proof_of(source, machine, &text);
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
/// Lines and arcs, half of the corners tangent, coordinates of three to five decimals.
#[test]
fn what_the_writer_makes_of_a_contour_passes_its_proof() {
    let mut dice = Dice(17);
    let machines = LANGUAGES.map(|name| machine::load(name).unwrap());
    let (mut count, most) = (0, if cfg!(debug_assertions) { 120 } else { 600 });
    for k in 0..most {
        let (mut heading, start) = (dice.number(-3.0, 3.0), Vec2::new(20.0, 0.0));
        let left = dice.once_in(2);
        let side = if left { 1.0 } else { -1.0 };
        let aside = |heading: f64| Vec2::from_angle(heading).perp() * side * 15.0;
        let decimals = 3 + dice.index(3);
        let from = start + aside(heading);
        let mut contour = Contour::begin(
            dice.number(1.0, 8.0),
            if left { "LEFT" } else { "RIGHT" },
            [from, start],
            decimals,
        );
        for _ in 0..2 + dice.index(5) {
            let length = dice.number(2.0, 18.0);
            if dice.once_in(2) {
                contour.line(contour.at + Vec2::from_angle(heading) * length);
            } else {
                let (radius, left) = (dice.number(2.0, 25.0), dice.once_in(2));
                let sign = if left { 1.0 } else { -1.0 };
                let angle = (length / radius).min(3.0) * sign;
                let center = contour.at + Vec2::from_angle(heading).perp() * radius * sign;
                let spoke = contour.at - center;
                contour.arc(center, left, center + Vec2::from_angle(angle).rotate(spoke));
                heading += angle;
            }
            if dice.once_in(2) {
                heading += dice.number(-1.2, 1.2);
            }
        }
        let out = contour.at + aside(heading);
        let text = contour.text.clone();
        let Some(source) = contour.read(out) else { continue };
        count += usize::from(made(&source, &machines[k % 4], &format!("{k}\n{text}")));
    }
    assert!(count > most / 4, "{count} of {most}");
}

/// Around a square of 60 by 40 mm from outside, from the middle of its left side: with the way in from, and the way out to, these points.
fn square([from, out]: [[f64; 2]; 2], more: &str) -> Program {
    let text = format!(
        "PARTNO/JOB\nUNITS/MM\nCUTTER/10\nLOADTL/1\nSPINDL/RPM,12000,CLW\nRAPID\nGOTO/{0},{1},20\nFEDRAT/MMPM,300\nGOTO/{0},{1},-2\nCUTCOM/LEFT\n\
         GOTO/0,20,-2\nGOTO/0,40,-2\nGOTO/60,40,-2\nGOTO/60,0,-2\nGOTO/0,0,-2\nGOTO/0,20,-2\nCUTCOM/OFF\nGOTO/{2},{3},-2\nRAPID\n\
         GOTO/{2},{3},20\n{more}SPINDL/OFF\nFINI\n",
        from[0], from[1], out[0], out[1]
    );
    read(&text).unwrap()
}

/// A robot, and mills whose controls offset.
fn offsetting() -> Vec<Machine> {
    let mill = |name: &str| {
        let text = format!("extends = \"{name}\"\n[settings]\ntool_radius = \"full\"\n");
        machine::load_text("mine.toml", &text).unwrap()
    };
    let mills =
        ["generic-3axis-sinumerik", "generic-3axis-fanuc", "generic-3axis-linuxcnc"].map(mill);
    std::iter::once(machine::load(LANGUAGES[0]).unwrap()).chain(mills).collect()
}

#[test]
fn a_way_through_the_contour_itself_is_refused() {
    let refused = |source: &Program, line: u32, of: &str| {
        for machine in offsetting() {
            let found = post::write(source, &machine).expect_err(&machine.name);
            let known = found.iter().any(|found| {
                (found.rule.name(), found.line) == ("compensation-gouge", line)
                    && (found.message.contains(of) || found.message.contains("cuts into it"))
            });
            assert!(known, "{}: {found:?}", machine.name);
        }
    };
    // From the middle of the part, and through the whole of it to its other side.
    refused(&square([[30.0, 20.0], [-20.0, 20.0]], ""), 11, "element of line 1");
    refused(&square([[-20.0, 20.0], [75.0, 20.0]], ""), 18, "element of line 1");
    let straight = square([[-20.0, 20.0], [-20.0, 20.0]], "");
    for machine in offsetting() {
        let output = post::write(&straight, &machine).unwrap();
        let gouges = output.warnings.iter().any(|found| found.rule.name() == "compensation-gouge");
        assert!(!gouges, "{}", machine.name);
    }
}

#[test]
fn a_way_that_comes_near_to_a_contour_is_a_warning() {
    let warned = |source: &Program, count: usize| -> Vec<Vec<(u32, String)>> {
        let of = |machine: Machine| {
            let output = post::write(source, &machine).expect(&machine.name);
            let report = proof::prove(source, &machine, "p", &output.text, &Default::default());
            assert!(report.proven, "{}: {:?}", machine.name, report.mismatches);
            let gouges = output.warnings.into_iter();
            let gouges = gouges.filter(|found| found.rule.name() == "compensation-gouge");
            gouges.map(|found| (found.line, found.message)).collect()
        };
        offsetting().into_iter().take(count).map(of).collect()
    };
    // Down at 4 mm from the last side, which a tool of radius 5 then cuts by 1 mm; a LinuxCNC, the last one, finds no way from there.
    for found in warned(&square([[-4.0, 10.0], [-20.0, 20.0]], ""), 3) {
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].0, 11);
        assert!(found[0].1.contains("within 4 mm of its element of line 16"), "{}", found[0].1);
    }
    // Around once more with 0.5 mm of stock less: the second way in crosses no wall that stays.
    let finish = "RAPID\nGOTO/-20,20,20\nGOTO/-20,20,-2\nCUTCOM/LEFT\nGOTO/0.5,20,-2\nGOTO/0.5,39.5,-2\nGOTO/59.5,39.5,-2\nGOTO/59.5,0.5,-2\n\
        GOTO/0.5,0.5,-2\nGOTO/0.5,20,-2\nCUTCOM/OFF\nGOTO/-20,20,-2\nRAPID\nGOTO/-20,20,20\n";
    for found in warned(&square([[-20.0, 20.0], [-20.0, 20.0]], finish), 4) {
        assert_eq!(found, []);
    }
    // Straight on over a second part.
    let second = "RAPID\nGOTO/30,20,20\nRAPID\nGOTO/80,20,20\nGOTO/80,20,-2\nCUTCOM/LEFT\nGOTO/80,60,-2\nGOTO/90,60,-2\nCUTCOM/OFF\nGOTO/90,80,-2\nRAPID\n\
        GOTO/90,80,20\n"
        .replace("GOTO/80,20,20\nGOTO/80,20,-2", "GOTO/30,30,20\nGOTO/30,30,-2");
    for found in warned(&square([[-20.0, 20.0], [-20.0, 20.0]], &second), 4) {
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].1.contains("goes over another contour"), "{}", found[0].1);
    }
}

/// A tool of radius 8 around a corner of 4 degrees: one chord would come to 8 cos 2° = 7.9951 mm from it.
#[test]
fn a_flat_outer_corner_is_cut_into_by_two_steps_of_the_words_at_the_most() {
    let corner = Vec2::new(40.0, 0.0);
    let mut contour = Contour::begin(16.0, "LEFT", [Vec2::new(-12.0, 12.0), Vec2::ZERO], 4);
    contour.line(corner);
    contour.line(corner + 40.0 * Vec2::from_angle(-4_f64.to_radians()));
    let source = contour.end(Vec2::new(92.0, 10.0));
    for (name, dialect) in
        LANGUAGES.iter().zip([Dialect::Krl, Dialect::UrScript, Dialect::Ls, Dialect::Rapid])
    {
        let machine = machine::load(name).unwrap();
        let text = crate::robot::proven(&source, &machine);
        let part = machine.cell.as_ref().unwrap().part;
        // Poses of URScript count in the base of the robot.
        let in_world = dialect == Dialect::UrScript;
        let tips: Vec<Vec3> = crate::robot::paths(dialect, &text)
            .into_iter()
            .filter_map(|path| match path {
                ArmPath::Line(end) => Some(end.translation),
                ArmPath::Arc { .. } | ArmPath::Joints(_) | ArmPath::Point(_) => None,
            })
            .map(|tip| if in_world { part.inverse().transform_point3(tip) } else { tip })
            .collect();
        let nearest = tips
            .windows(2)
            .map(|pair| nearest_on_segment(pair[0], pair[1], corner.extend(-2.0)).1)
            .fold(f64::INFINITY, f64::min);
        assert!((8.0 - 0.0025..8.0 + 1e-3).contains(&nearest), "{name}: {nearest}\n{text}");
    }
}

/// Two rooms of 20 by 40 mm with a passage so many mm wide between them, along their walls from inside with a tool of 10 mm.
fn rooms(passage: f64) -> Program {
    let half = passage / 2.0;
    let corners = [
        [30.0, -20.0],
        [30.0, 20.0],
        [10.0, 20.0],
        [10.0, half],
        [-10.0, half],
        [-10.0, 20.0],
        [-30.0, 20.0],
        [-30.0, -20.0],
        [-10.0, -20.0],
        [-10.0, -half],
        [10.0, -half],
        [10.0, -20.0],
        [20.0, -20.0],
    ];
    let walls: String = corners.iter().map(|[x, y]| format!("GOTO/{x},{y},-2\n")).collect();
    let text = format!(
        "PARTNO/ROOMS\nUNITS/MM\nCUTTER/10\nLOADTL/1\nSPINDL/RPM,8000,CLW\nRAPID\nGOTO/20,0,20\nFEDRAT/MMPM,300\nGOTO/20,0,-2\n\
         CUTCOM/LEFT\nGOTO/20,-20,-2\n{walls}CUTCOM/OFF\nGOTO/20,0,-2\nRAPID\nGOTO/20,0,20\nSPINDL/OFF\nFINI\n"
    );
    read(&text).unwrap()
}

#[test]
fn a_passage_that_is_narrower_than_the_tool_is_refused_with_its_line_and_a_wider_one_is_proven() {
    for (k, machine) in offsetting().into_iter().enumerate() {
        let found = post::write(&rooms(9.9), &machine).expect_err(&machine.name);
        // The first wall of the passage, and the one across it. The way in of a LinuxCNC is an element, along the same walls.
        let known = found.iter().any(|found| {
            (found.rule.name(), found.line) == ("compensation", 16)
                && found.message.contains("between this element and that of line 22")
        });
        assert!(known, "{}: {found:?}", machine.name);
        if k == 3 {
            continue;
        }
        let source = rooms(10.1);
        let output = post::write(&source, &machine).expect(&machine.name);
        let report = proof::prove(&source, &machine, "p", &output.text, &Default::default());
        assert!(report.proven, "{}: {:?}", machine.name, report.mismatches);
    }
}

/// A contour that begins and ends 12 mm beyond its corner: a mill's control goes along the overrun, which bounds nothing.
#[test]
fn what_runs_on_beyond_a_corner_is_no_wall_to_a_control_that_offsets() {
    let text = "PARTNO/OVER\nUNITS/MM\nCUTTER/10\nLOADTL/1\nSPINDL/RPM,8000,CLW\nRAPID\nGOTO/-20,-20,20\nFEDRAT/MMPM,300\nGOTO/-20,-20,-2\n\
        CUTCOM/LEFT\nGOTO/0,-12,-2\nGOTO/0,40,-2\nGOTO/60,40,-2\nGOTO/60,0,-2\nGOTO/-12,0,-2\nCUTCOM/OFF\nGOTO/-25,-8,-2\nRAPID\n\
        GOTO/-25,-8,20\nSPINDL/OFF\nFINI\n";
    let source = read(text).unwrap();
    for machine in offsetting().into_iter().skip(1) {
        let output = post::write(&source, &machine).expect(&machine.name);
        let report = proof::prove(&source, &machine, "p", &output.text, &Default::default());
        assert!(report.proven, "{}: {:?}", machine.name, report.mismatches);
    }
}
