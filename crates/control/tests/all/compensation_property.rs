//! The centre of the tool stays its radius away from the contour, on every control: random closed
//! contours of lines and arcs, machined inside and outside, and distances computed by the test.

use proptest::prelude::*;
use std::f64::consts::TAU;
use toolpost_control::{Action, Dialect, Settings, ToolData, read};

type Point = [f64; 2];

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn length(a: Point) -> f64 {
    a[0].hypot(a[1])
}

fn along(a: Point, way: Point, by: f64) -> Point {
    [a[0] + way[0] * by, a[1] + way[1] * by]
}

/// A side of a contour or a move of the centre; an arc with its centre and sweep.
#[derive(Clone, Copy, Debug)]
struct Side {
    from: Point,
    to: Point,
    arc: Option<(Point, f64)>,
}

impl Side {
    fn arc(from: Point, to: Point, center: Point, counter_clockwise: bool) -> Side {
        let angle = |p: Point| (p[1] - center[1]).atan2(p[0] - center[0]);
        let turn = angle(to) - angle(from);
        let sweep = if counter_clockwise { turn.rem_euclid(TAU) } else { -(-turn).rem_euclid(TAU) };
        Side { from, to, arc: Some((center, sweep)) }
    }

    fn at(&self, t: f64) -> Point {
        match self.arc {
            None => along(self.from, minus(self.to, self.from), t),
            Some((center, sweep)) => {
                let ([x, y], (sin, cos)) = (minus(self.from, center), (sweep * t).sin_cos());
                [center[0] + x * cos - y * sin, center[1] + x * sin + y * cos]
            }
        }
    }

    /// Points along it, dense near its ends: where two sides part at a small angle they may cross once more after a
    /// millimetre, and a contour that crosses itself has no inside.
    fn points(&self) -> impl Iterator<Item = Point> {
        (0..=80).map(|i| {
            let t = f64::from(i) / 80.0;
            self.at(t * t * (3.0 - 2.0 * t))
        })
    }

    /// The direction of travel at its start (0) or its end (1).
    fn direction(&self, t: f64) -> f64 {
        let way = minus(self.to, self.from);
        let along = match self.arc {
            None => way,
            Some((center, sweep)) => {
                let [x, y] = minus(self.at(t), center);
                [-y * sweep.signum(), x * sweep.signum()]
            }
        };
        along[1].atan2(along[0])
    }

    fn distance(&self, p: Point) -> f64 {
        let ends = length(minus(p, self.from)).min(length(minus(p, self.to)));
        match self.arc {
            None => {
                let way = minus(self.to, self.from);
                let from = minus(p, self.from);
                let t = (from[0] * way[0] + from[1] * way[1]) / length(way).powi(2);
                let foot = along(self.from, way, t.clamp(0.0, 1.0));
                length(minus(p, foot))
            }
            Some((center, sweep)) => {
                let angle = |p: Point| (p[1] - center[1]).atan2(p[0] - center[0]);
                let turn = (angle(p) - angle(self.from)) * sweep.signum();
                if turn.rem_euclid(TAU) <= sweep.abs() {
                    let radius = length(minus(self.from, center));
                    ends.min((length(minus(p, center)) - radius).abs())
                } else {
                    ends
                }
            }
        }
    }
}

/// A contour that begins and ends in the middle of its first side, which is straight, and the inside
/// of which is on the left.
#[derive(Clone, Debug)]
struct Contour {
    sides: Vec<Side>,
    outside: bool,
    radius: f64,
}

fn rounded(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

fn contour() -> impl Strategy<Value = Contour> {
    let corner = (0.15..0.85f64, 25.0..60.0f64, 0..5u8, 0.55..2.5f64);
    (prop::collection::vec(corner, 3..9), any::<bool>(), 0.3..9.0f64).prop_map(
        |(corners, outside, radius)| {
            let count = corners.len() as f64;
            let points: Vec<Point> = corners
                .iter()
                .enumerate()
                .map(|(i, (within, far, ..))| {
                    let (sin, cos) = ((i as f64 + within) / count * TAU).sin_cos();
                    [rounded(far * cos), rounded(far * sin)]
                })
                .collect();
            let mut sides = Vec::new();
            for (i, (.., kind, bulge)) in corners.iter().enumerate() {
                let (from, to) = (points[i], points[(i + 1) % points.len()]);
                let way = minus(to, from);
                let chord = length(way);
                let unit = [way[0] / chord, way[1] / chord];
                let counter_clockwise = *kind == 3;
                if i == 0 || *kind < 3 {
                    sides.push(Side { from, to, arc: None });
                } else {
                    let half = (rounded(chord * bulge).powi(2) - chord * chord / 4.0).sqrt();
                    let left = if counter_clockwise { half } else { -half };
                    let middle = along(from, way, 0.5);
                    let center = along(middle, [-unit[1], unit[0]], left);
                    sides.push(Side::arc(from, to, center, counter_clockwise));
                }
            }
            let first = sides[0];
            let middle = first.at(0.5).map(rounded);
            sides[0] = Side { from: middle, ..first };
            sides.push(Side { to: middle, ..first });
            Contour { sides, outside, radius: rounded(radius) }
        },
    )
}

impl Contour {
    /// Where the tool waits before and after: straight in front of the middle of the first side.
    fn waits(&self) -> Point {
        let way = minus(self.sides[0].to, self.sides[0].from);
        let by = if self.outside { -12.0 } else { 12.0 } / length(way);
        along(self.sides[0].from, [-way[1], way[0]], by).map(rounded)
    }

    /// Whether there is room for the tool: sides that are no neighbours leave its width between them,
    /// and neighbours go apart from their corner until they do.
    fn has_room(&self) -> bool {
        let (count, width) = (self.sides.len(), 2.0 * self.radius);
        // The two halves of the first side are one.
        let whole = |i: usize| i % (count - 1);
        (0..count).all(|i| {
            (0..count).all(|j| {
                let (side, other) = (&self.sides[i], &self.sides[j]);
                let mut distances: Vec<f64> = side.points().map(|p| other.distance(p)).collect();
                if whole(i) == whole(j) {
                    return true;
                }
                if length(minus(side.to, other.from)) < 1e-9 {
                    // In a cusp the last decimal of the corner decides on which side of each other the two are.
                    let turn = other.direction(0.0) - side.direction(1.0);
                    if (turn.rem_euclid(TAU) - TAU / 2.0).abs() < 0.02 {
                        return false;
                    }
                    distances.reverse();
                } else if length(minus(side.from, other.to)) > 1e-9 {
                    return distances.iter().all(|&d| d > width);
                }
                let apart = distances.iter().position(|&d| d > width).unwrap_or(distances.len());
                distances[apart..].iter().all(|&d| d > width)
                    && distances[..apart].is_sorted_by(|a, b| a < b)
            })
        })
    }

    /// How deep LinuxCNC may cut at a joint of less than 0.05 rad, mm: the next way begins where the last one ends, 0.05 radii before or
    /// behind its own start; on an arc inside which the tool runs, so much farther out.
    fn joint(&self) -> f64 {
        let aside = 0.05 * self.radius;
        let on_arc = |side: &Side| {
            let (center, sweep) = side.arc?;
            let concave = (sweep > 0.0) != self.outside;
            let parallel = length(minus(side.from, center)) - self.radius;
            (concave && parallel > 0.0).then(|| parallel.hypot(aside) - parallel)
        };
        self.sides.iter().filter_map(on_arc).fold(0.002 * self.radius, f64::max)
    }

    /// The program; an arc by its radius.
    fn program(&self, dialect: Dialect) -> String {
        let klartext = dialect == Dialect::Klartext;
        let left = !self.outside;
        let point = |[x, y]: Point| match klartext {
            true => format!("X{x:+.3} Y{y:+.3}"),
            false => format!("X{x:.3} Y{y:.3}"),
        };
        let mut blocks = vec![];
        let [wait, start] = [self.waits(), self.sides[0].from].map(point);
        let g41 = if left { "G41" } else { "G42" };
        match dialect {
            Dialect::Sinumerik => blocks.extend([
                "T1 M6 D1".into(),
                format!("G0 {wait} Z0 F100"),
                format!("G1 {g41} {start}"),
            ]),
            Dialect::Klartext => blocks.extend([
                "TOOL CALL 1 Z S1000".into(),
                format!("L {wait} Z+0 R0 FMAX"),
                format!("L {start} {} F100", if left { "RL" } else { "RR" }),
            ]),
            _ => blocks.extend([
                "G21 G90 T1 M6".into(),
                format!("G0 {wait} Z0. F100."),
                format!("G1 {g41} D1 {start}"),
            ]),
        }
        for side in &self.sides {
            let end = point(side.to);
            blocks.push(match (side.arc, dialect) {
                (None, Dialect::Klartext) => format!("L {end}"),
                (None, _) => format!("G1 {end}"),
                (Some((center, sweep)), _) => {
                    let radius = length(minus(side.from, center));
                    let ccw = sweep > 0.0;
                    match dialect {
                        Dialect::Klartext => {
                            format!("CR {end} R{radius:+.4} DR{}", if ccw { '+' } else { '-' })
                        }
                        Dialect::Sinumerik => {
                            format!("G{} {end} CR={radius:.4}", if ccw { 3 } else { 2 })
                        }
                        _ => format!("G{} {end} R{radius:.4}", if ccw { 3 } else { 2 }),
                    }
                }
            });
        }
        match klartext {
            true => blocks.extend([format!("L {wait} R0"), "L Z+9 M30".into()]),
            false => blocks.extend([format!("G40 G1 {wait}"), "M30".into()]),
        }
        if !klartext {
            return blocks.join("\n") + "\n";
        }
        blocks.insert(0, "BEGIN PGM P MM".into());
        blocks.push("END PGM P MM".into());
        blocks.iter().enumerate().map(|(i, block)| format!("{i} {block}\n")).collect()
    }
}

/// The moves of the centre between the move to the contour and the move off it.
fn centre(dialect: Dialect, contour: &Contour) -> Result<Vec<Side>, &'static str> {
    let mut settings = Settings::new(dialect, [false; 3]);
    let (radius, length) = (contour.radius, 50.0);
    settings.setup.tools = vec![ToolData { number: 1, name: String::new(), radius, length }];
    let (mut at, mut moves) = ([f64::NAN; 2], Vec::new());
    let program = contour.program(dialect);
    read(&settings, "p.nc", program.as_bytes(), &mut |record| {
        if let Some(pose) = record.action.position() {
            let to = [pose.point.x, pose.point.y];
            moves.push(match &record.action {
                Action::Arc(arc) => {
                    Side::arc(at, to, [arc.center.x, arc.center.y], arc.normal.z > 0.0)
                }
                _ => Side { from: at, to, arc: None },
            });
            at = to;
        }
        Ok(())
    })
    .map_err(|error| match error.rule.name().starts_with("compensation-") {
        true => error.rule.name(),
        false => panic!("{error}\n{program}"),
    })?;
    // To where the tool waits, to the contour; and off it to where the tool waits.
    let moves = moves.split_off(2);
    Ok(moves.into_iter().take_while(|side| side.to != contour.waits()).collect())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn the_centre_stays_the_radius_away_from_the_contour(contour in contour()) {
        // LinuxCNC joins turns below 0.05 without a corner: a radius·(1 - cos 0.05) nearer.
        for (dialect, joins, farthest) in [
            (Dialect::LinuxCnc, true, 1.002),
            (Dialect::Sinumerik, false, 1.0),
            (Dialect::Klartext, false, 1.0),
            (Dialect::Fanuc, false, 2f64.sqrt()),
        ] {
            let Ok(moves) = centre(dialect, &contour) else { continue };
            let slack = if joins { contour.joint() } else { 0.0 };
            for side in &moves {
                if let Some((center, _)) = side.arc {
                    let radii = [side.from, side.to].map(|p| length(minus(p, center)));
                    let apart = (radii[0] - radii[1]).abs();
                    prop_assert!(apart < 0.005 + slack, "{dialect:?} {side:?}");
                }
                if !contour.has_room() {
                    continue;
                }
                for point in side.points() {
                    let distances = contour.sides.iter().map(|side| side.distance(point));
                    let nearest = distances.fold(f64::INFINITY, f64::min);
                    let radius = contour.radius;
                    prop_assert!(
                        nearest > radius - slack - 0.002
                            && nearest < radius * farthest + 0.002,
                        "{dialect:?}: {nearest} from the contour, radius {radius}\n{}\n{side:?}",
                        contour.program(dialect)
                    );
                }
            }
        }
    }
}
