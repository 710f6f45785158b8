//! The path of a tool that an arm leads: how easily the arm stands along it, in colours, and each joint with its limits and its speed.

use crate::paper::{INK, RAPID, SIZE, begin, lines, scale_bar, shorten, triad, write_text};
use crate::trace::Trace;
use crate::view::View;
use geom::Vec3;
use glam::DVec2;
use std::fmt::Write as _;

/// The field of the path: low and high corner, pixels.
const PATH: [DVec2; 2] = [DVec2::new(50.0, 110.0), DVec2::new(560.0, 590.0)];

/// From where to where the joints are drawn: across, and the tops of the first and of what is below the last.
const ACROSS: [f64; 2] = [700.0, 1150.0];
const TOP: f64 = 100.0;
const BELOW: f64 = 718.0;

/// How high the speeds of a joint are drawn, below its angles, and what is left free above and below them, pixels.
const SPEEDS: f64 = 22.0;
const FREE: f64 = 25.0;

/// How far a drawn line may be from the path, pixels; doubled until the picture is small enough.
const TOLERANCE: f64 = 0.1;

/// The most points of the path.
const MAX_POINTS: usize = 200_000;

/// Margins up to this part of what is ample have this colour; more than the last has the colour of what is ample.
const CLASSES: [(f64, &str); 4] =
    [(0.25, "#b3261e"), (0.5, "#de7a18"), (0.75, "#c9a514"), (1.0, "#6c9a2e")];
const AMPLE: &str = "#2678be";

const FRAME: &str = "#c9ced4";
const ANGLE: &str = "#2678be";
const SPEED: &str = "#de7a18";
const LIMIT: &str = "#b3261e";

/// What is drawn.
#[derive(Clone, Debug)]
pub struct ArmPicture {
    /// In their order.
    pub samples: Vec<ArmSample>,
    /// The limits of each joint, degrees.
    pub limits: [[f64; 2]; 6],
    /// From where to where the rail goes on which the arm stands, mm; `None` without one.
    pub rail: Option<[f64; 2]>,
    /// What is said below the title.
    pub text: String,
}

/// Where an arm stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArmSample {
    /// Whether the tool cuts on the way here.
    pub cuts: bool,
    /// Whether it has left the cut here, and enters it again.
    pub enters_again: bool,
    /// Seconds from the first one.
    pub time: f64,
    /// The tool tip, mm.
    pub tip: Vec3,
    /// Degrees.
    pub joints: [f64; 6],
    /// Which part of its speed each joint needs on the way here.
    pub speeds: [f64; 6],
    /// Where the rail stands, mm.
    pub rail: f64,
    /// The least margin as a part of what is ample.
    pub ease: f64,
}

/// Draws it as SVG under a title.
pub fn arm_path(title: &str, picture: &ArmPicture) -> String {
    let mut out = begin(&format!("Joints of the arm along {title}"));
    write_text(&mut out, &shorten(title, 70), DVec2::new(40.0, 40.0), 12.0, INK);
    write_text(&mut out, &shorten(&picture.text, 160), DVec2::new(40.0, 62.0), 7.0, INK);
    path(&mut out, &picture.samples);
    let joints = (0..6).map(|joint| (Axis::Joint(joint), picture.limits[joint]));
    let rows: Vec<_> = joints.chain(picture.rail.map(|limits| (Axis::Rail, limits))).collect();
    let height = (BELOW - TOP) / rows.len() as f64;
    for (i, (axis, limits)) in rows.into_iter().enumerate() {
        row(&mut out, &picture.samples, (axis, limits), [TOP + height * i as f64, height]);
    }
    let seconds = picture.samples.last().map_or(0.0, |last| last.time);
    let below = BELOW - 4.0;
    write_text(&mut out, "0", DVec2::new(ACROSS[0], below), 8.0, INK);
    let end = format!("{seconds:.0} S");
    let start = ACROSS[1] - crate::lettering::width(&end, 8.0);
    write_text(&mut out, &end, DVec2::new(start, below), 8.0, INK);
    out.push_str("</svg>\n");
    out
}

/// The class of a margin.
fn class(ease: f64) -> usize {
    CLASSES.iter().position(|(most, _)| ease < *most).unwrap_or(CLASSES.len())
}

fn color(class: usize) -> &'static str {
    CLASSES.get(class).map_or(AMPLE, |(_, color)| color)
}

fn path(out: &mut String, samples: &[ArmSample]) {
    let none = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    let corners = samples.iter().fold(none, |[low, high], at| [low.min(at.tip), high.max(at.tip)]);
    if samples.is_empty() {
        return;
    }
    let view = View::from_above(corners, PATH);
    let mut tolerance = TOLERANCE;
    let (rapids, cuts) = loop {
        let mut rapids = Trace::new(tolerance);
        let mut cuts: [Trace; CLASSES.len() + 1] = std::array::from_fn(|_| Trace::new(tolerance));
        for pair in samples.windows(2) {
            let [from, to] = [&pair[0], &pair[1]].map(|sample| view.at(sample.tip));
            match pair[1].cuts {
                true => cuts[class(pair[0].ease.min(pair[1].ease))].segment(from, to),
                false => rapids.segment(from, to),
            }
        }
        let points = cuts.iter().map(Trace::points).sum::<usize>() + rapids.points();
        if points <= MAX_POINTS {
            break (rapids, cuts);
        }
        tolerance *= 2.0;
    };
    lines(out, rapids, RAPID, 0.8, "stroke-dasharray=\"40 40\"");
    // What is near to a limit lies on top.
    for (class, trace) in cuts.into_iter().enumerate().rev() {
        lines(out, trace, color(class), 2.0, "");
    }
    for sample in samples.iter().filter(|sample| sample.enters_again).take(MOST_MARKS) {
        let at = view.at(sample.tip);
        ring(out, at.x, at.y);
    }
    if samples.iter().any(|sample| sample.enters_again) {
        let at = DVec2::new(192.0, 660.0 + 16.0 * (CLASSES.len() + 1) as f64);
        ring(out, at.x, at.y - 3.5);
        write_text(out, "THE CUT IS LEFT AND ENTERED AGAIN", at + DVec2::X * 22.0, 7.5, INK);
    }
    triad(out, &view, DVec2::new(90.0, 690.0));
    scale_bar(out, &view, DVec2::new(560.0, 640.0));
    for class in 0..=CLASSES.len() {
        let at = DVec2::new(180.0, 660.0 + 16.0 * class as f64);
        let _ = writeln!(
            out,
            "<path stroke=\"{}\" stroke-width=\"3\" d=\"M{:.1} {:.1}h24\"/>",
            color(class),
            at.x,
            at.y - 3.5
        );
        let text = match CLASSES.get(class) {
            Some((most, _)) => format!("MARGIN BELOW {:.0} %", 100.0 * most),
            None => String::from("AMPLE: 30 DEGREES, 200 MM FROM AXIS 1"),
        };
        write_text(out, &text, DVec2::new(at.x + 34.0, at.y), 7.5, INK);
    }
}

/// The most places of one picture that have a ring.
const MOST_MARKS: usize = 1000;

fn ring(out: &mut String, x: f64, y: f64) {
    let _ = writeln!(
        out,
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\" stroke=\"{INK}\" stroke-width=\"1.6\" fill=\"none\"/>"
    );
}

/// The least and the largest of one column of pixels.
#[derive(Clone, Copy)]
struct Column {
    angles: Option<[f64; 2]>,
    speed: f64,
}

/// What a row is of.
#[derive(Clone, Copy, PartialEq)]
enum Axis {
    /// A joint, from 0.
    Joint(usize),
    /// It stands in cuts: no speed is drawn.
    Rail,
}

impl Axis {
    fn name(self) -> String {
        match self {
            Axis::Joint(joint) => format!("JOINT {}", joint + 1),
            Axis::Rail => String::from("RAIL, MM"),
        }
    }

    /// Where it is at a sample, and which part of its speed it needs on the way there.
    fn at(self, sample: &ArmSample) -> (f64, f64) {
        match self {
            Axis::Joint(joint) => (sample.joints[joint], sample.speeds[joint]),
            Axis::Rail => (sample.rail, 0.0),
        }
    }
}

/// A joint, or the rail, along the time: where it is between its limits, and which part of its speed it needs; at the top and as high as stated.
fn row(
    out: &mut String,
    samples: &[ArmSample],
    (axis, [min, max]): (Axis, [f64; 2]),
    [top, height]: [f64; 2],
) {
    let [left, right] = ACROSS;
    let angles_height = height - SPEEDS - FREE;
    let whole = samples.last().map_or(0.0, |last| last.time).max(1e-9);
    let mut columns: Vec<Option<Column>> = vec![None; (right - left) as usize + 1];
    let last = columns.len() - 1;
    let mut from = 0;
    for sample in samples {
        let (angle, speed) = axis.at(sample);
        let at = ((sample.time / whole * last as f64) as usize).min(last);
        for column in columns[from..at].iter_mut().filter(|_| sample.cuts) {
            let known = column.get_or_insert(Column { angles: None, speed });
            known.speed = known.speed.max(speed);
        }
        from = at;
        let before = columns[at].unwrap_or(Column { angles: None, speed });
        let [low, high] = before.angles.unwrap_or([angle; 2]);
        let angles = Some([low.min(angle), high.max(angle)]);
        columns[at] = Some(Column { angles, speed: before.speed.max(speed) });
    }
    let place = |angle: f64| top + angles_height * (1.0 - (angle - min) / (max - min));
    let (mut angles, mut speeds) = (String::new(), String::new());
    let floor = top + angles_height + 6.0 + SPEEDS;
    let mut most: f64 = 0.0;
    for (i, column) in columns.iter().enumerate() {
        let Some(Column { angles: found, speed }) = column else { continue };
        let x = left + i as f64;
        if let Some([low, high]) = found {
            let pen = if angles.is_empty() { 'M' } else { 'L' };
            let _ = write!(angles, "{pen}{x} {:.1}L{x} {:.1}", place(*low), place(*high));
        }
        if *speed > 0.0 {
            let _ = write!(speeds, "M{x} {floor}V{:.1}", floor - SPEEDS * speed.min(1.0));
        }
        most = most.max(*speed);
    }
    let (mut base, mut fastest) = (String::new(), String::new());
    if axis != Axis::Rail {
        base = format!("M{left} {floor}h{}", right - left);
        fastest = format!("M{left} {}H{right}", floor - SPEEDS);
    }
    let _ = writeln!(
        out,
        "<path stroke=\"{FRAME}\" d=\"M{left} {top}h{0}v{angles_height}h-{0}z{base}\"/>\n\
         <path stroke=\"{LIMIT}\" stroke-width=\"0.8\" d=\"M{left} {top}H{right}M{left} {1}H{right}{fastest}\"/>\n\
         <path stroke=\"{SPEED}\" d=\"{speeds}\"/>\n<path stroke=\"{ANGLE}\" stroke-width=\"1.6\" d=\"{angles}\"/>",
        right - left,
        top + angles_height,
    );
    let name = DVec2::new(left - 92.0, top + angles_height / 2.0 + 4.0);
    write_text(out, &axis.name(), name, 9.0, INK);
    let mut beside = |text: String, y: f64| {
        let x = left - 6.0 - crate::lettering::width(&text, 6.5);
        write_text(out, &text, DVec2::new(x, y), 6.5, LIMIT);
    };
    beside(format!("{max:.0}"), top + 5.0);
    beside(format!("{min:.0}"), top + angles_height + 1.0);
    if axis != Axis::Rail {
        beside(format!("{:.0} % OF ITS SPEED", 100.0 * most), floor);
    }
    debug_assert!(floor < SIZE.y, "the rows are within the paper");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(time: f64, ease: f64, angle: f64, speed: f64) -> ArmSample {
        let tip = Vec3::new(10.0 * time, 0.0, 0.0);
        ArmSample {
            cuts: true,
            enters_again: false,
            time,
            tip,
            joints: [angle; 6],
            speeds: [speed; 6],
            rail: 500.0,
            ease,
        }
    }

    /// The colour of the class in which a margin is, and a column as high as the part of the speed.
    #[test]
    fn margins_have_colours_and_speeds_are_columns() {
        let picture = |ease: f64, speed: f64| ArmPicture {
            samples: vec![sample(0.0, ease, 0.0, 0.0), sample(1.0, ease, 45.0, speed)],
            limits: [[-90.0, 90.0]; 6],
            rail: None,
            text: String::new(),
        };
        let near = arm_path("job", &picture(0.1, 0.5));
        let line = |color: &str| format!("stroke=\"{color}\" stroke-width=\"20\"");
        assert!(near.contains(&line(CLASSES[0].1)) && !near.contains(&line(AMPLE)), "{near}");
        let ample = arm_path("job", &picture(1.2, 0.5));
        assert!(ample.contains(&line(AMPLE)) && !ample.contains(&line(CLASSES[0].1)));
        assert!(!near.contains("<circle"));
        let mut left = picture(0.1, 0.5);
        left.samples[1].enters_again = true;
        // The place and the legend.
        assert_eq!(arm_path("job", &left).matches("<circle").count(), 2);
        // By hand: the floor of joint 1 is at 100 + 56 + 6 + 22 = 184; half of 22 pixels above it is 173.
        assert!(near.contains("M1150 184V173.0"), "{near}");
        // 45 of -90 to 90 degrees: a quarter of 56 pixels below the top.
        assert!(near.contains("L1150 114.0"), "{near}");
        // Seven rows of 618 / 7 pixels; 500 of 0 to 2000 mm is three quarters of 41.3 pixels below the top of the last.
        let rail = arm_path("job", &ArmPicture { rail: Some([0.0, 2000.0]), ..picture(0.1, 0.5) });
        assert!(rail.contains("L1150 660.7"), "{rail}");
        assert!(
            arm_path("nothing", &ArmPicture { samples: Vec::new(), ..picture(1.0, 0.0) })
                .ends_with("</svg>\n")
        );
    }
}
