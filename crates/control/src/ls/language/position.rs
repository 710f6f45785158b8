//! Positions: what stands behind `/POS`.

use super::scan::Scan;
use crate::ArmPosture;
use crate::kernel::arm::FARTHEST;
use crate::kernel::source::Source;
use geom::{Euler, Frame, Vec3};
use program::{Outcome, Rule};
use std::collections::HashMap;

/// Largest number of a position.
const MOST: u32 = 32_767;

/// Where a position is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Coordinates {
    /// As the controller shows the joints, degrees.
    Joints([f64; 6]),
    /// The tool in the user frame, and the posture that its letters and turns state.
    Pose(Frame, ArmPosture),
}

/// A position of the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Position {
    pub(crate) coordinates: Coordinates,
    /// Numbers of the user frame and of the tool in which it counts.
    pub(crate) frames: [u32; 2],
    /// Where the rail on which the arm stands is, mm: the outer axis `E1`.
    pub(crate) rail: Option<f64>,
}

/// The positions of these lines.
///
/// # Errors
/// What is not understood in them; two of one number.
pub(crate) fn positions<'t>(
    lines: impl Iterator<Item = (u32, &'t [u8])>,
) -> Outcome<HashMap<u32, Position>> {
    let mut all = HashMap::new();
    let mut open: Option<(u32, Reading)> = None;
    for (line, text) in lines {
        let mut scan = Scan::new(Source { line, text });
        while scan.peek().is_some() {
            match &mut open {
                None => {
                    if scan.letters_alone() != Some("P") {
                        return Err(scan.wrong("a position P[1]{ is needed here"));
                    }
                    let number = scan.index(MOST)?;
                    scan.expect("]")?;
                    scan.expect("{")?;
                    if all.contains_key(&number) {
                        let message = format!("the program has two positions P[{number}]");
                        return Err(scan.since(0, Rule::Twice, message));
                    }
                    open = Some((number, Reading::default()));
                }
                Some((number, reading)) => {
                    if scan.take(b'}') {
                        if !scan.take(b';') {
                            return Err(scan.wrong("a position ends with };"));
                        }
                        all.insert(*number, reading.finish(&scan, *number)?);
                        open = None;
                    } else {
                        reading.entry(&mut scan)?;
                    }
                }
            }
        }
    }
    match open {
        Some((number, _)) => {
            let message = format!("P[{number}] has no end: }};");
            Err(program::Diagnostic::error(Rule::NoEnd, message).line(1).into())
        }
        None => Ok(all),
    }
}

/// A position of which some entries have been read.
#[derive(Default)]
struct Reading {
    /// Whether its motion group has been named.
    has_group: bool,
    /// Which of its coordinates comes next, of the six.
    next: usize,
    frames: [Option<u32>; 2],
    posture: Option<ArmPosture>,
    pose: [Option<f64>; 6],
    joints: [Option<f64>; 6],
    rail: Option<f64>,
}

const POSE: [&str; 6] = ["X", "Y", "Z", "W", "P", "R"];
const JOINTS: [&str; 6] = ["J1", "J2", "J3", "J4", "J5", "J6"];
const RAIL: &str = "E1";

impl Reading {
    /// An entry, and the comma behind it.
    fn entry(&mut self, scan: &mut Scan) -> Outcome {
        scan.peek();
        let from = scan.at;
        let Some(name) = scan.word() else {
            return Err(scan.wrong("an entry of a position is needed here"));
        };
        if !self.has_group && !name.starts_with("GP") {
            let message = "a position begins with its motion group: GP1:";
            return Err(scan.since(from, Rule::Syntax, message));
        }
        match name {
            "GP1" => {
                if std::mem::replace(&mut self.has_group, true) {
                    let message = "GP1 stands twice in the position";
                    return Err(scan.since(from, Rule::RepeatedWord, message));
                }
                return scan.expect(":");
            }
            "UF" | "UT" => {
                scan.expect(":")?;
                let number = scan.decimal().filter(|number| (0.0..=10.0).contains(number));
                let Some(number) = number.filter(|number| number.fract() == 0.0) else {
                    let message = "the number of a frame is needed here: the position must say in which it counts";
                    return Err(scan.wrong(message));
                };
                let frame = &mut self.frames[usize::from(name == "UT")];
                if frame.replace(number as u32).is_some() {
                    let message = format!("{name} stands twice in the position");
                    return Err(scan.since(from, Rule::RepeatedWord, message));
                }
            }
            "CONFIG" => {
                scan.expect(":")?;
                self.posture = Some(config(scan)?);
            }
            _ => {
                let places = [(&POSE, &mut self.pose, "mm"), (&JOINTS, &mut self.joints, "deg")];
                let mut place = None;
                let found = places.into_iter().find_map(|(names, values, unit)| {
                    let i = names.iter().position(|own| *own == name)?;
                    place = Some(i);
                    Some((&mut values[i], if *names == POSE && i > 2 { "deg" } else { unit }))
                });
                let found = if name == RAIL { Some((&mut self.rail, "mm")) } else { found };
                let Some((value, unit)) = found else {
                    let message = format!("{name} of a position is not followed");
                    return Err(scan.since(from, Rule::Unsupported, message));
                };
                scan.expect("=")?;
                let number = scan.decimal().filter(|number| number.abs() <= FARTHEST);
                let Some(number) = number else {
                    return Err(scan.wrong(format!("{name} is a number in {unit}")));
                };
                if scan.letters_alone() != Some(unit) {
                    return Err(scan.wrong(format!("{name} counts in {unit}")));
                }
                if value.replace(number).is_some() {
                    let message = format!("{name} stands twice in the position");
                    return Err(scan.since(from, Rule::RepeatedWord, message));
                }
                if let Some(place) = place {
                    if place != self.next {
                        let message = format!(
                            "{name} stands where another coordinate is needed: X, Y, Z, W, P, R or J1 to J6 in this order"
                        );
                        return Err(scan.since(from, Rule::Syntax, message));
                    }
                    self.next += 1;
                }
            }
        }
        scan.take(b',');
        Ok(())
    }

    /// # Errors
    /// Something is missing, or there are joints and coordinates.
    fn finish(&self, scan: &Scan, number: u32) -> Outcome<Position> {
        let refused = |what: &str| {
            let message = format!("P[{number}] {what}");
            Err(scan.since(0, Rule::UnknownPosition, message))
        };
        let [Some(frame), Some(tool)] = self.frames else {
            return refused("does not say in which user frame and tool it counts (UF, UT)");
        };
        let all = |values: &[Option<f64>; 6]| {
            let known: Vec<f64> = values.iter().flatten().copied().collect();
            <[f64; 6]>::try_from(known).ok()
        };
        let coordinates = match (all(&self.pose), all(&self.joints), self.posture) {
            (None, Some(joints), None) if self.pose.iter().all(Option::is_none) => {
                Coordinates::Joints(joints)
            }
            (Some([x, y, z, w, p, r]), None, Some(posture))
                if self.joints.iter().all(Option::is_none) =>
            {
                let turns = [w, p, r].map(f64::to_radians);
                let turn = Euler::FixedXyz.matrix(turns);
                Coordinates::Pose(Frame::from_mat3_translation(turn, Vec3::new(x, y, z)), posture)
            }
            _ => {
                return refused("has neither six joints nor X, Y, Z, W, P, R with CONFIG");
            }
        };
        Ok(Position { coordinates, frames: [frame, tool], rail: self.rail })
    }
}

/// `'N U T, 0, 0, 0'`: wrist not flipped or flipped (F), elbow up or down (D), wrist in front of axis 1 or at the back (B), and the
/// turns of joints 1, 4 and 6: 0 is from -180 to below 180 degrees.
fn config(scan: &mut Scan) -> Outcome<ArmPosture> {
    scan.expect("'")?;
    let mut letters = [false; 3];
    for (letter, pair) in letters.iter_mut().zip(["NF", "UD", "TB"]) {
        let Some(index) = scan.peek().and_then(|byte| pair.bytes().position(|own| own == byte))
        else {
            return Err(
                scan.wrong(format!("one of the letters {pair} is needed here: 'N U T, 0, 0, 0'"))
            );
        };
        scan.at += 1;
        *letter = index == 1;
    }
    let mut joints = [None; 6];
    for joint in [0, 3, 5] {
        scan.expect(",")?;
        let turn = scan.decimal().filter(|turn| turn.fract() == 0.0 && turn.abs() <= 8.0);
        let Some(turn) = turn else {
            return Err(scan.wrong("the number of turns is a whole one from -8 to 8"));
        };
        joints[joint] = Some([360.0 * turn - 180.0, 360.0 * turn + 180.0]);
    }
    scan.expect("'")?;
    let [flip, below, rear] = letters.map(Some);
    Ok(ArmPosture { rear, below, flip, joints })
}
