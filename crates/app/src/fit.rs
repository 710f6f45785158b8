//! Where a part would fit a robot: places in the cell at which the arm can make a toolpath, with the margin of each.
//!
//! Many places are looked at with a few points of the toolpath, one turn about the tool and one posture; at the best of them the writer
//! makes the whole program, and only those count. The same places come of the same input, on any number of threads.

use crate::account::Stop;
use crate::toolpath::Toolpath;
use crate::watch::Watch;
use ::post::{ArmLooks, ArmMargins, arm_margins};
use geom::{Euler, Frame, Mat3, Vec3};
use machine::{Cell, Machine};
use program::{Diagnostic, Rule};
use rayon::prelude::*;

/// Steps of the places to each side in the plane, and up and down.
const STEPS: i32 = 3;
const STEPS_UP: i32 = 2;

/// Places in a row that are looked at closer.
const CLOSER: usize = 4;

/// The most places at which the whole program is made, and that are answered.
const TRIES: usize = 12;
const ANSWERS: usize = 6;

/// So many of the best places are looked at again where the writer has refused one.
const MOST_LEFT: usize = 300;

/// A place of the part at which the robot makes the toolpath.
#[derive(Clone, Debug)]
pub struct Place {
    /// `part` of the cell: X, Y, Z in mm, and A, B, C in degrees.
    pub part: [f64; 6],
    /// The margins there.
    pub margins: ArmMargins,
}

/// What a search has found.
#[derive(Debug)]
pub struct Fit {
    /// Where the machine file puts the part, and the margins there, or why not.
    pub here: ([f64; 6], Result<ArmMargins, Box<Diagnostic>>),
    /// Places that looked best, and why the writer cannot make the toolpath there; where it can at none.
    pub refused: Vec<([f64; 6], Box<Diagnostic>)>,
    /// The best places, the one with the best margin first.
    pub places: Vec<Place>,
    /// How many places were looked at, and at how many of them the arm stands.
    pub looked: [usize; 2],
}

/// A place: steps along X, Y and Z from that of the machine file, and quarter turns about the vertical through the part's zero.
#[derive(Clone, Copy, PartialEq)]
struct Spot {
    moved: Vec3,
    quarters: u8,
}

/// Looks for places within so many mm of that of the machine file, along each axis of the controller's world (two thirds of it up and
/// down), turned by quarters about the vertical.
///
/// # Errors
/// The machine is no robot, the source has what no arm can do, or the work shall end.
pub fn search(
    toolpath: &Toolpath,
    machine: &Machine,
    within: f64,
    watch: &dyn Watch,
) -> Result<Fit, Stop> {
    watch.begin("looking at places")?;
    let program = &toolpath.program;
    let quoted = |mut findings: Vec<Diagnostic>| {
        toolpath.quote(&mut findings);
        Stop::invalid(findings)
    };
    let mut looks = ArmLooks::of(program, machine).map_err(quoted)?;
    let part = looks.part();
    let eased = |looks: &ArmLooks, spots: Vec<Spot>| -> Vec<(Spot, f64)> {
        let ease = |spot: Spot| {
            let go_on = !watch.is_cancelled();
            (spot, go_on.then(|| looks.ease(spot.part(&part))).flatten())
        };
        let found: Vec<_> = spots.into_par_iter().map(ease).collect();
        found.into_iter().filter_map(|(spot, ease)| Some((spot, ease?))).collect()
    };
    let step = within / f64::from(STEPS);
    let mut spots = Vec::new();
    for quarters in 0..4 {
        for [x, y, z] in around(STEPS, STEPS_UP) {
            spots.push(Spot { moved: Vec3::new(x, y, z) * step, quarters });
        }
    }
    let mut looked = spots.len();
    let mut found = eased(&looks, spots);
    sort(&mut found);
    watch.begin("looking closer")?;
    let mut closer: Vec<Spot> = Vec::new();
    for (best, _) in apart(&found, step).take(CLOSER) {
        for [x, y, z] in around(1, 1) {
            let spot = Spot { moved: best.moved + Vec3::new(x, y, z) * (step / 2.0), ..best };
            let is_known = closer.contains(&spot) || found.iter().any(|(known, _)| *known == spot);
            if !is_known {
                closer.push(spot);
            }
        }
    }
    looked += closer.len();
    found.extend(eased(&looks, closer));
    sort(&mut found);
    watch.begin("writing programs")?;
    let at = |spot: Spot| -> Result<ArmMargins, Box<Diagnostic>> {
        let moved = |cell| Cell { part: spot.part(&part), ..cell };
        let machine = Machine { cell: machine.cell.clone().map(moved), ..machine.clone() };
        let first = |mut findings: Vec<Diagnostic>| {
            findings.retain(Diagnostic::is_error);
            Box::new(findings.swap_remove(0))
        };
        ::post::write(program, &machine).map_err(first)?;
        let margins = arm_margins(program, &machine).map_err(first)?;
        margins.ok_or_else(|| {
            let found = Diagnostic::error(Rule::Empty, "the toolpath moves nothing");
            Box::new(found.help("check the source"))
        })
    };
    let own = Spot { moved: Vec3::ZERO, quarters: 0 };
    let here = (own.numbers(&part), at(own));
    let (mut places, mut refused) = (Vec::new(), Vec::new());
    let stood = found.len();
    let mut tried: Vec<Spot> = Vec::new();
    for _ in 0..TRIES {
        watch.go_on()?;
        let is_new = |spot: &Spot| !tried.iter().any(|known| known.is_near(spot, step));
        let next = found.iter().map(|(spot, _)| *spot).find(is_new);
        let Some(spot) = next.filter(|_| places.len() < ANSWERS) else { break };
        tried.push(spot);
        let numbers = spot.numbers(&part);
        match at(spot) {
            Ok(margins) => places.push(Place { part: numbers, margins }),
            Err(why) => {
                // Where the writer stopped the others are looked at too.
                looks.look_at(why.line);
                refused.push((numbers, why));
                found.truncate(MOST_LEFT);
                found = eased(&looks, found.into_iter().map(|(spot, _)| spot).collect());
                sort(&mut found);
            }
        }
    }
    // A place at which no cut is left comes before one at which the arm stands more easily.
    places.sort_by(|a, b| {
        let [(cuts_a, ease_a), (cuts_b, ease_b)] =
            [a, b].map(|place| (place.margins.reentries, place.margins.ease));
        cuts_a.cmp(&cuts_b).then(ease_b.total_cmp(&ease_a))
    });
    if !places.is_empty() {
        refused.clear();
    }
    Ok(Fit { here, refused, places, looked: [looked, stood] })
}

/// Steps around nothing.
fn around(wide: i32, high: i32) -> impl Iterator<Item = [f64; 3]> {
    let plane = move |z| (-wide..=wide).flat_map(move |x| (-wide..=wide).map(move |y| [x, y, z]));
    (-high..=high).flat_map(plane).map(|steps| steps.map(f64::from))
}

/// The easiest first; of equals that which is moved and turned least.
fn sort(found: &mut [(Spot, f64)]) {
    let far = |spot: &Spot| (spot.moved.length(), spot.quarters);
    found.sort_by(|(a, of_a), (b, of_b)| {
        let ((a, turn_a), (b, turn_b)) = (far(a), far(b));
        of_b.total_cmp(of_a).then(a.total_cmp(&b)).then(turn_a.cmp(&turn_b))
    });
}

/// Those that are no neighbours of a better one.
fn apart(found: &[(Spot, f64)], step: f64) -> impl Iterator<Item = (Spot, f64)> + '_ {
    let mut taken: Vec<Spot> = Vec::new();
    found.iter().copied().filter(move |(spot, _)| {
        let is_new = !taken.iter().any(|known| known.is_near(spot, step));
        if is_new {
            taken.push(*spot);
        }
        is_new
    })
}

impl Spot {
    fn is_near(&self, other: &Spot, step: f64) -> bool {
        self.quarters == other.quarters && self.moved.distance(other.moved) < step - 1e-6
    }

    fn part(&self, part: &Frame) -> Frame {
        let turn = Mat3::from_rotation_z(f64::from(self.quarters) * std::f64::consts::FRAC_PI_2);
        Frame::from_mat3_translation(turn * part.matrix3, part.translation + self.moved)
    }

    /// As `part` of a machine file has it.
    fn numbers(&self, part: &Frame) -> [f64; 6] {
        let part = self.part(part);
        let [c, b, a] = Euler::FixedXyz.angles(&part.matrix3).map(f64::to_degrees);
        let [x, y, z] = part.translation.to_array();
        [x, y, z, a, b, c].map(|value| (value * 1e4).round() / 1e4 + 0.0)
    }
}
