//! LinuxCNC's own interpreter as the judge of cutter radius compensation: a contour must make the same
//! path of the centre in both, or be refused by both.

use proptest::prelude::*;
use std::process::Command;
use toolpost_control::{Action, Dialect, Settings, ToolData, read};

/// A move of the centre: end in mm; of an arc also its centre and its turns begun, negative clockwise.
#[derive(Clone, Debug)]
enum Move {
    Rapid([f64; 3]),
    Feed([f64; 3]),
    Arc { end: [f64; 3], center: [f64; 2], turns: i32 },
    Word(String),
}

/// The axes of a plane, first, second, third, by what `rs274` calls it.
fn axes(plane: &str) -> [usize; 3] {
    match plane {
        "CANON_PLANE_XZ)" => [2, 0, 1],
        "CANON_PLANE_YZ)" => [1, 2, 0],
        _ => [0, 1, 2],
    }
}

/// What `rs274 -g` makes of a program with a tool 1 of this radius; `None` where it is not installed.
fn judged(program: &str, radius: f64) -> Option<Result<Vec<Move>, String>> {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    // Alone, rs274 counts the table in inches.
    let tool = format!("T1 P1 Z1 D{:.12}\n", radius * 2.0 / 25.4);
    std::fs::write(path("tool.tbl"), tool).unwrap();
    std::fs::write(path("rs274.var"), "").unwrap();
    std::fs::write(path("program.ngc"), program).unwrap();
    // It keeps the table in a file of the home folder, which two of them at once must not share.
    let output = Command::new("rs274")
        .args(["-t", "tool.tbl", "-v", "rs274.var", "-g", "program.ngc"])
        .env("HOME", folder.path())
        .current_dir(folder.path())
        .output()
        .expect("rs274 is run");
    Some(match output.status.success() {
        true => Ok(canonical(&String::from_utf8_lossy(&output.stdout))),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
    })
}

/// The moves, feeds and dwells among the canonical calls that `rs274` prints.
fn canonical(printed: &str) -> Vec<Move> {
    let (mut moves, mut plane) = (Vec::new(), [0, 1, 2]);
    for line in printed.lines() {
        let Some((name, arguments)) = line.split_once('(') else { continue };
        let numbers: Vec<f64> = arguments
            .trim_end_matches(')')
            .split(',')
            .filter_map(|number| number.trim().parse().ok())
            .collect();
        match name.rsplit(' ').next().unwrap() {
            "STRAIGHT_TRAVERSE" => moves.push(Move::Rapid([numbers[0], numbers[1], numbers[2]])),
            "STRAIGHT_FEED" => moves.push(Move::Feed([numbers[0], numbers[1], numbers[2]])),
            "ARC_FEED" => {
                let mut end = [0.0; 3];
                (end[plane[0]], end[plane[1]], end[plane[2]]) =
                    (numbers[0], numbers[1], numbers[5]);
                let center = [numbers[2], numbers[3]];
                moves.push(Move::Arc { end, center, turns: numbers[4] as i32 });
            }
            "SELECT_PLANE" => plane = axes(arguments),
            "SET_FEED_RATE" if numbers[0] > 0.0 => {
                moves.push(Move::Word(format!("F{}", numbers[0])))
            }
            "DWELL" => moves.push(Move::Word(format!("P{}", numbers[0]))),
            _ => {}
        }
    }
    moves
}

/// What our control makes of it.
fn ours(program: &str, radius: f64) -> Result<Vec<Move>, String> {
    let mut settings = Settings::new(Dialect::LinuxCnc, [false; 3]);
    settings.setup.tools = vec![ToolData { number: 1, name: String::new(), radius, length: 25.4 }];
    let mut moves = Vec::new();
    read(&settings, "program.ngc", program.as_bytes(), &mut |record| {
        moves.push(match record.action {
            Action::Rapid(pose) => Move::Rapid(pose.point.to_array()),
            Action::Line(pose) => Move::Feed(pose.point.to_array()),
            Action::Arc(arc) => {
                let third = arc.normal.abs().max_position();
                let center = arc.center.to_array();
                Move::Arc {
                    end: arc.end.point.to_array(),
                    center: [center[(third + 1) % 3], center[(third + 2) % 3]],
                    turns: (arc.turns as i32 + 1) * arc.normal[third] as i32,
                }
            }
            Action::Feed(program::Feed::PerMinute(feed)) => Move::Word(format!("F{feed}")),
            Action::Dwell(seconds) => Move::Word(format!("P{seconds}")),
            Action::Compensation(_) => panic!("compensation is left in the path"),
            _ => return Ok(()),
        });
        Ok(())
    })
    .map_err(|diagnostic| diagnostic.to_string())?;
    Ok(moves)
}

/// Without moves that go nowhere, of which both sides have some.
fn essential(moves: Vec<Move>) -> Vec<Move> {
    let mut at = [0.0; 3];
    let mut kept: Vec<Move> = Vec::new();
    for motion in moves {
        let here = match &motion {
            Move::Rapid(end) | Move::Feed(end) if near(end, &at) => continue,
            Move::Rapid(end) | Move::Feed(end) | Move::Arc { end, .. } => *end,
            Move::Word(_) => at,
        };
        at = here;
        kept.push(motion);
    }
    kept
}

/// Equal to the four decimals that `rs274` prints, and to what they leave of its table.
fn near(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 3e-4)
}

fn same(a: &Move, b: &Move) -> bool {
    match (a, b) {
        (Move::Rapid(a), Move::Rapid(b)) | (Move::Feed(a), Move::Feed(b)) => near(a, b),
        (Move::Word(a), Move::Word(b)) => a == b,
        (
            Move::Arc { end, center, turns },
            Move::Arc { end: end_b, center: center_b, turns: turns_b },
        ) => near(end, end_b) && near(center, center_b) && turns == turns_b,
        _ => false,
    }
}

/// A stretch of a path in the plane XY: its ends, and of an arc the centre and the sweep.
#[derive(Clone, Copy)]
struct Stretch {
    ends: [[f64; 2]; 2],
    arc: Option<([f64; 2], f64)>,
}

/// The stretches between the move to the contour and the move off it.
fn stretches(moves: &[Move]) -> Vec<Stretch> {
    let (mut at, mut all) = ([0.0, 0.0], Vec::new());
    for motion in moves {
        let (end, arc) = match motion {
            Move::Rapid(end) | Move::Feed(end) => ([end[0], end[1]], None),
            Move::Arc { end, center: [x, y], turns } => {
                let end = [end[0], end[1]];
                let angle = |p: [f64; 2]| (p[1] - y).atan2(p[0] - x);
                let way = f64::from(turns.signum());
                let sweep = ((angle(end) - angle(at)) * way).rem_euclid(std::f64::consts::TAU);
                (end, Some(([*x, *y], way * sweep)))
            }
            Move::Word(_) => continue,
        };
        all.push(Stretch { ends: [at, end], arc });
        at = end;
    }
    all.pop();
    all.split_off(1)
}

impl Stretch {
    /// Points 0.05 mm apart.
    fn points(&self) -> Vec<[f64; 2]> {
        let [[x, y], end] = self.ends;
        let (dx, dy) = (end[0] - x, end[1] - y);
        let length = match self.arc {
            None => dx.hypot(dy),
            Some((center, sweep)) => sweep * (x - center[0]).hypot(y - center[1]),
        };
        let steps = (length.abs() / 0.05).ceil().max(1.0);
        let at = |t: f64| match self.arc {
            None => [x + t * dx, y + t * dy],
            Some((center, sweep)) => {
                let (sin, cos) = (sweep * t).sin_cos();
                let (dx, dy) = (x - center[0], y - center[1]);
                [center[0] + cos * dx - sin * dy, center[1] + sin * dx + cos * dy]
            }
        };
        (0..=steps as usize).map(|i| at(i as f64 / steps)).collect()
    }

    /// Whether it is parallel to `element`, and backwards.
    fn is_back_along(&self, element: &Stretch) -> bool {
        match (self.arc, element.arc) {
            (None, None) => {
                let way = |s: &Stretch| [s.ends[1][0] - s.ends[0][0], s.ends[1][1] - s.ends[0][1]];
                let ([a, b], [c, d]) = (way(self), way(element));
                (a * c + b * d) / (a.hypot(b) * c.hypot(d)) < -0.99
            }
            (Some((a, first)), Some((b, second))) => {
                near(&a, &b) && first.abs() > second.abs() + 1e-3
            }
            _ => false,
        }
    }
}

/// Whether a path of the centre cuts into the contour or runs backwards along one of its elements.
fn spoils(program: &str, radius: f64, centre: &[Move]) -> bool {
    let contour = program.replace("G41 D1", "").replace("G42 D1", "");
    let contour = stretches(&essential(ours(&contour, 0.0).unwrap()));
    let centre = stretches(centre);
    let contour_points: Vec<_> = contour.iter().flat_map(Stretch::points).collect();
    let cuts = centre
        .iter()
        .flat_map(Stretch::points)
        .any(|p| contour_points.iter().any(|q| (p[0] - q[0]).hypot(p[1] - q[1]) < radius - 0.01));
    cuts || centre.iter().any(|stretch| contour.iter().any(|e| stretch.is_back_along(e)))
}

/// Whether both make the same path (or both refuse: false). We also refuse where LinuxCNC's path spoils
/// the contour.
fn agree(program: &str, radius: f64) -> Result<bool, String> {
    let program = &format!("G21 G90 G64 T1 M6\nF100\nG0 X0 Y0 Z0\n{program}\nM2\n");
    let ours = ours(program, radius);
    let Some(theirs) = judged(program, radius) else { return Ok(ours.is_ok()) };
    let (ours, theirs) = match (ours, theirs) {
        (Ok(ours), Ok(theirs)) => (essential(ours), essential(theirs)),
        (Err(_), Err(_)) => return Ok(false),
        (Err(_), Ok(theirs)) if spoils(program, radius, &essential(theirs.clone())) => {
            return Ok(false);
        }
        (ours, theirs) => {
            return Err(format!("radius {radius}\n{program}\nours   {ours:?}\ntheirs {theirs:?}"));
        }
    };
    for n in 0..ours.len().max(theirs.len()) {
        match (ours.get(n), theirs.get(n)) {
            (Some(a), Some(b)) if same(a, b) => {}
            (a, b) => {
                return Err(format!(
                    "radius {radius}, move {n} of\n{program}\nours   {a:?}\ntheirs {b:?}"
                ));
            }
        }
    }
    Ok(true)
}

fn makes_the_same_path(program: &str) {
    assert!(agree(program, 3.0).unwrap_or_else(|e| panic!("{e}")), "both refuse\n{program}");
}

fn is_refused_by_both(program: &str) {
    assert!(!agree(program, 3.0).unwrap_or_else(|e| panic!("{e}")), "both take\n{program}");
}

#[test]
fn inner_corners_are_cut_off_and_outer_ones_gone_around() {
    makes_the_same_path("G41 D1 G1 X10 Y0\nX20\nY20\nX10 Y10\nG40 G1 X0 Y0");
    makes_the_same_path("G42 D1 G1 X10 Y0\nX20\nY20\nX30\nG40\nG0 Z10\nG0 X0");
    makes_the_same_path("G41 D1 G1 X10 Y10\nX30\nX10\nX10 Y20");
    makes_the_same_path("G42 D1 G1 X4 Y0\nX20\nX25\nY30\nG0 X50\nG1 Y10\nG0 X70");
    makes_the_same_path("G41 D1 G1 X4 Y0\nX20\nG0 Y-30\nX0");
}

#[test]
fn the_move_that_begins_counts_as_an_element() {
    makes_the_same_path("G41 D1 G1 X10 Y0\nY20\nX30");
    makes_the_same_path("G41 D1 G1 X10 Y0\nX5 Y20\nX30");
    makes_the_same_path("G41 D1 G1 X4 Y0\nX2 Y20\nX30");
    makes_the_same_path("G42 G0 X10 Y5\nG1 X5 Y20\nX30\nG40 Y40");
    is_refused_by_both("G41 D1 G1 X2 Y0\nX20");
    is_refused_by_both("G41 D1\nG1 Z-1\nX20");
}

#[test]
fn what_lies_between_two_elements_happens_at_the_corner() {
    for side in ["G41", "G42"] {
        makes_the_same_path(&format!(
            "{side} D1\nG1 X10 Y0\nX20\nG4 P1\nZ-2\nF50\nY20\nZ-4\nX30\nM5\nX40\nF20\nY9\nF10\nG40\n\
             G0 Z10\nX0"
        ));
    }
}

#[test]
fn arcs_stay_arcs_about_their_centre() {
    makes_the_same_path("G41 D1 G1 X10 Y0\nG3 X20 Y10 J10\nX0 I-10 Z5\nG1 Y-20");
    makes_the_same_path("G41 D1 G1 X10 Y0\nG2 X20 Y-10 J-10\nG2 X30 I5\nG3 X40 I5");
    makes_the_same_path("G41 D1 G1 X10 Y0\nG2 X10 Y0 J-10 Z-3 P2\nG1 X20");
    makes_the_same_path("G42 D1 G1 X10 Y0\nG2 X10 Y0 J-10 Z-3 P2\nG1 X20");
    makes_the_same_path("G41 D1 G1 X10 Y0\nX30\nG3 X10 Y20 R20\nG1 Y0\nG40 Y-10");
    makes_the_same_path("G41 D1 G1 X10 Y0\nX30\nG2 X30 Y20 R20\nG2 X10 R20\nG1 Y0\nG40 Y-10");
    makes_the_same_path("G41 D1 G1 X10 Y0\nX20\nG3 X30 Y10.2 R10.11");
    is_refused_by_both("G41 D1 G1 X10 Y0\nG3 X12 Y2 J2\nG1 Y20");
}

#[test]
fn it_may_begin_on_an_arc() {
    for side in ["G41", "G42"] {
        makes_the_same_path(&format!("{side} D1\nG2 X10 Y0 I5\nG1 X20"));
        makes_the_same_path(&format!("{side} D1\nG3 X10 Y10 J10 Z-1\nG1 Y20\nX0"));
        makes_the_same_path(&format!("{side} D1\nG2 X10 Y10 I10\nG1 X20"));
        makes_the_same_path(&format!("{side} D1\nG3 X10 Y10 J10 Z-1 P2\nG1 X20 Y0"));
        makes_the_same_path(&format!("{side} D1\nG2 X10 Y10 R-15\nG3 X20 R9"));
    }
    is_refused_by_both("G41 D1\nG3 X1 Y1 J1\nG1 X20");
    is_refused_by_both("G41 D1\nG3 X3 Y3 J3\nG1 Y20");
    is_refused_by_both("G41 D1\nG3 X0 Y0 J10 P2\nG1 X20");
}

#[test]
fn back_on_the_same_way() {
    for x in ["-1", "-.3", "0", ".3", "1"] {
        for side in ["G41.1", "G42.1"] {
            makes_the_same_path(&format!(
                "{side} D.2 G1 X10 Y0\nG2 X20 Y-10 J-10\nG91 G1 X{x} Y20\nG2 X10 R5"
            ));
            makes_the_same_path(&format!("{side} D.2 G1 X10 Y0\nX30\nX10 Y{x}\nX9 Y30"));
        }
    }
    for arc in ["G2 X10 Y10 J10", "G3 X10 Y-10 J-10"] {
        makes_the_same_path(&format!("G41.1 D.2 G1 X10 Y0\nX20 Y0\n{arc}"));
        makes_the_same_path(&format!("G42.1 D.2 G1 X10 Y0\nX20 Y0\n{arc}"));
    }
}

#[test]
fn in_the_other_planes_too() {
    makes_the_same_path("G18 G41 D1 G1 X10 Z0\nX20\nZ10\nX10\nG2 X20 Z0 I5 K-5\nG40 G1 X40 Z-9");
    is_refused_by_both("G19 G41 D1 G1 Y10 Z0\nY20");
}

#[test]
fn small_turns_join() {
    for turn in [0.1, 0.4, 0.49, 0.51, 0.6, -0.1, -0.4, -0.49, -0.51, -0.6] {
        makes_the_same_path(&format!("G41 D1 G1 X10 Y0\nX20\nX30 Y{turn}\nX40\nY20"));
    }
}

#[test]
fn the_diameter_in_the_block() {
    makes_the_same_path("G41.1 D6 G1 X10 Y0\nX20\nY-10\nG40 Y-20\nG42.1 D2.5 X40\nX50\nY0");
    makes_the_same_path("G41.1 D-6 G1 X10 Y0\nX20\nY10");
    is_refused_by_both("G41.1 G1 X10");
}

#[test]
fn what_the_judge_refuses_we_refuse() {
    for program in [
        "G41 D1 G1 X10 Y0\nY2\nX30",
        "G41 D1 G1 X4 Y0\nX20\nX20.1 Y1\nX20 Y30",
        "G41 D1 G1 X10 Y0\nX20\nG42 D1 Y-10",
        "G41 D1 G1 X10 Y0\nX20\nG41 Y-10",
        "G41 D1 G1 X10 Y0\nX20\nG40 G2 X30 Y-20 I10",
        "G41 D1 G1 X10 Y0\nX20\nG18\nX30",
        "G41 D1 G1 X10 Y0\nX20\nG98 G81 X5 Y5 Z-4 R2",
        "G41 D1 G1 X10 Y0\nX20\nT2 M6\nX30",
        "G41 D1 G1 X10 Y0\nX20\nG55\nX30",
        "G41 D1 G1 X10 Y0\nX20\nG43 H1\nX30",
        "G41 D1 G1 X10 Y0\nX20\nG28",
        "G41 D1 G1 X10 Y0\nX20\nG53 G0 X0",
    ] {
        is_refused_by_both(program);
    }
}

/// A contour of lines and arcs from corner to corner.
fn contour() -> impl Strategy<Value = String> {
    let side = prop_oneof![Just("G41"), Just("G42")];
    let step = (-20.0..20.0f64, -20.0..20.0f64, 0..9u8, 0.5..3.0f64, -3.0..3.0f64);
    (side, prop::collection::vec(step, 2..7), -30.0..30.0f64, -30.0..30.0f64).prop_map(
        |(side, steps, x, y)| {
            let mut program = format!("{side} D1 G1 X{x:.3} Y{y:.3}\n");
            for (dx, dy, kind, bulge, z) in steps {
                // Some elements are shorter than the tool.
                let (dx, dy) = if kind > 5 { (dx / 40.0, dy / 40.0) } else { (dx, dy) };
                let radius = dx.hypot(dy) / 2.0 * (1.0 + bulge);
                let word = match kind % 6 {
                    0..=2 => format!("G91 G1 X{dx:.3} Y{dy:.3}"),
                    3 => format!("G91 G2 X{dx:.3} Y{dy:.3} R{radius:.3}"),
                    4 => format!("G91 G3 X{dx:.3} Y{dy:.3} R{radius:.3} Z{z:.3}"),
                    _ => format!("G91 G2 X{dx:.3} Y{dy:.3} R-{radius:.3}"),
                };
                program += &word;
                program.push('\n');
            }
            program + "G90 G40 G1 X100 Y100"
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn any_contour_makes_the_same_path_or_is_refused_by_both(
        contour in contour(),
        radius in prop_oneof![0.1..1.0f64, 1.0..8.0f64],
    ) {
        if let Err(difference) = agree(&contour, (radius * 100.0).round() / 100.0) {
            prop_assert!(false, "{difference}");
        }
    }
}
