//! Which of its two solutions a control takes for a tilted plane, as far as that is known.
//!
//! The rules are those of the manuals ([`TiltChoice`]); where parameters of the control decide and the machine's file does
//! not say how they stand, each solution that some setting would give is possible.

use control::TiltChoice;
use machine::{Machine, Mount, Solutions};

/// What a position that was worked out of a tool axis may be beyond its travel, degrees: the rounding of the words.
pub(crate) const SLACK: f64 = 2e-3;

/// Turns and positions that differ by less, degrees, are alike.
const ALIKE: f64 = 0.01;

/// Positions at which an axis that is free in a singular pose may stand, as parts of a turn.
const FREE_POSITIONS: u32 = 32;

/// Degrees of A, B, C.
pub(crate) type Degrees = [f64; 3];

/// Puts into `taken` the positions that the control may take for a tilted plane with these `solutions`, from where the
/// axes may stand (`from`, empty where nobody knows).
pub(crate) fn take(
    machine: &Machine,
    choice: TiltChoice,
    from: &[Degrees],
    solutions: &Solutions,
    taken: &mut Vec<Degrees>,
) {
    match choice {
        TiltChoice::LeastTurn if is_known(from) => {
            for from in from {
                take_least(machine, from, solutions, taken);
            }
        }
        TiltChoice::LeastTurn => {
            taken.extend(all(machine, solutions));
            if machine.settings.tilt_within_travel == Some(true) {
                keep_within(machine, taken);
            }
        }
        TiltChoice::ShorterWithin => {
            reachable(machine, solutions, taken);
            if let ([one, other], [from]) = (&taken[..], from) {
                let is_shorter = |a: &Degrees, b: &Degrees| {
                    let (a, b) = (turns(machine, from, a), turns(machine, from, b));
                    (0..3).all(|i| a[i] <= b[i] + ALIKE) && (0..3).any(|i| a[i] < b[i] - ALIKE)
                };
                let (one, other) = (*one, *other);
                if is_shorter(&one, &other) {
                    taken.truncate(1);
                } else if is_shorter(&other, &one) {
                    taken.remove(0);
                }
            }
        }
        TiltChoice::Sequence(is_positive) => {
            let main = main_axis(machine);
            let sign = if is_positive { 1.0 } else { -1.0 };
            let fits = |degrees: &Degrees| {
                let at = degrees[main];
                // Beyond half a turn either reading of the sign may be the control's.
                at * sign >= -ALIKE || short(at) * sign >= -ALIKE
            };
            taken.extend(all(machine, solutions).filter(fits));
            keep_within(machine, taken);
        }
        TiltChoice::Symmetry => reachable(machine, solutions, taken),
        TiltChoice::Higher(is_higher) => {
            reachable(machine, solutions, taken);
            keep_side(machine, is_higher, taken);
        }
    }
}

/// What a person can do where it is not known which solution the control takes.
pub(crate) fn way_out(machine: &Machine, choice: TiltChoice) -> Option<&'static str> {
    match choice {
        TiltChoice::LeastTurn if machine.settings.tilt_within_travel != Some(true) => Some(
            "turn the rotary axes to the solution that is meant before G68.2; or say `tilt_within_travel = true` in [settings] \
             of the machine's file where parameters 19741 to 19744 hold its travel",
        ),
        TiltChoice::LeastTurn => {
            Some("turn the rotary axes to the solution that is meant before G68.2")
        }
        TiltChoice::ShorterWithin | TiltChoice::Symmetry => {
            Some("say by SEQ+ or SEQ- which solution the control has to take")
        }
        TiltChoice::Higher(_) if machine.settings.swivel_direction.is_none() => Some(
            "say `swivel_direction` in [settings] of the machine's file: the rotary axis to which _DIR refers ($TC_CARR37)",
        ),
        TiltChoice::Sequence(_) | TiltChoice::Higher(_) => None,
    }
}

/// All solutions, with a free axis anywhere, each in whole turns that are within the travel where there are such.
fn all(machine: &Machine, solutions: &Solutions) -> impl Iterator<Item = Degrees> {
    let count = if solutions.degrees[0] == solutions.degrees[1] { 1 } else { 2 };
    let Solutions { degrees, free } = *solutions;
    let stands = if free.is_some() { FREE_POSITIONS } else { 1 };
    degrees.into_iter().take(count).flat_map(move |degrees| {
        (0..stands).map(move |k| {
            let mut degrees = degrees;
            if let Some(free) = free {
                degrees[free] += 360.0 * f64::from(k) / f64::from(stands);
            }
            within_travel(machine, degrees)
        })
    })
}

/// The solutions to which the axes turn least from `from`, whatever order the axes count in; a free axis stands still.
pub(crate) fn nearest(
    machine: &Machine,
    from: &Degrees,
    solutions: &Solutions,
) -> [Option<Degrees>; 2] {
    let ways = solutions.degrees.map(|degrees| {
        let degrees = wound(machine, from, degrees, solutions.free);
        let turn = turns(machine, from, &degrees).into_iter().fold(0.0, f64::max);
        (degrees, turn)
    });
    let least = ways[0].1.min(ways[1].1);
    let mut taken = ways.map(|(degrees, turn)| (turn <= least + ALIKE).then_some(degrees));
    if taken[0] == taken[1] {
        taken[1] = None;
    }
    taken
}

/// Whether it is known at which of these places the rotary axes stand.
pub(crate) fn is_known(angles: &[Degrees]) -> bool {
    !angles.is_empty() && angles.iter().flatten().all(|degrees| degrees.is_finite())
}

/// Puts into `taken` all solutions, and where some are within the travel those alone.
pub(crate) fn reachable(machine: &Machine, solutions: &Solutions, taken: &mut Vec<Degrees>) {
    taken.extend(all(machine, solutions));
    keep_within(machine, taken);
}

/// Keeps the positions that are within the travel, where some are.
fn keep_within(machine: &Machine, taken: &mut Vec<Degrees>) {
    if taken.iter().any(|degrees| is_within(machine, degrees)) {
        taken.retain(|degrees| is_within(machine, degrees));
    }
}

/// What `G53.1` takes from `from`, in each order of the axes and with each range that may be set.
fn take_least(machine: &Machine, from: &Degrees, solutions: &Solutions, taken: &mut Vec<Degrees>) {
    let settings = &machine.settings;
    let both = solutions.degrees.map(|degrees| wound(machine, from, degrees, solutions.free));
    let inside = both.map(|degrees| within_travel(machine, degrees));
    let is_inside = inside.map(|degrees| is_within(machine, &degrees));
    let orders = [false, true].into_iter();
    let orders =
        orders.filter(|second| settings.tilt_second_axis_first.unwrap_or(*second) == *second);
    for is_second_first in orders {
        let order = counted(machine, is_second_first);
        if settings.tilt_within_travel != Some(true) || is_inside == [false; 2] {
            add_least(machine, from, both, &order, taken);
        }
        if settings.tilt_within_travel != Some(false) {
            match is_inside {
                [true, true] => add_least(machine, from, inside, &order, taken),
                [true, false] => add(inside[0], taken),
                [false, true] => add(inside[1], taken),
                [false, false] => {}
            }
        }
    }
}

/// Adds the one of two positions that is taken: the first axis that turns otherwise decides, then the first that is
/// otherwise near to 0°. Where none is, either may be.
fn add_least(
    machine: &Machine,
    from: &Degrees,
    both: [Degrees; 2],
    order: &[usize],
    taken: &mut Vec<Degrees>,
) {
    let [one, other] = both.map(|degrees| turns(machine, from, &degrees));
    let by_turn = order.iter().map(|&i| one[i] - other[i]);
    let by_place = order.iter().map(|&i| short(both[0][i]).abs() - short(both[1][i]).abs());
    let differs = by_turn.chain(by_place).find(|way| way.abs() > ALIKE).unwrap_or_default();
    if differs <= 0.0 {
        add(both[0], taken);
    }
    if differs >= 0.0 {
        add(both[1], taken);
    }
}

fn add(degrees: Degrees, taken: &mut Vec<Degrees>) {
    if !taken.contains(&degrees) {
        taken.push(degrees);
    }
}

/// The rotary axes in the order in which `G53.1` compares their turns.
fn counted(machine: &Machine, is_second_first: bool) -> Vec<usize> {
    // The list goes from the frame outwards, the head before the table: the first carries the second.
    let mut order: Vec<usize> = machine.rotary.iter().map(machine::RotaryAxis::index).collect();
    let mounts = [Mount::Head, Mount::Table];
    let is_mixed = mounts.iter().all(|side| machine.rotary.iter().any(|axis| axis.on == *side));
    let head_first = machine.rotary.first().is_some_and(|axis| axis.on == Mount::Head);
    // Of a mixed machine the table counts first.
    if is_second_first != (is_mixed && head_first) {
        order.reverse();
    }
    order
}

/// Index (in A, B, C) of the main rotary axis of a HEIDENHAIN: the first seen from the tool, or the last seen from the
/// table.
fn main_axis(machine: &Machine) -> usize {
    let head = machine.rotary.iter().rev().find(|axis| axis.on == Mount::Head);
    head.or(machine.rotary.first()).map_or(0, machine::RotaryAxis::index)
}

/// Keeps the solution with the higher, or lower, position of the axis that the swivel data set refers to, where that is
/// known and its travel leaves each solution one position.
fn keep_side(machine: &Machine, is_higher: bool, taken: &mut Vec<Degrees>) {
    let reference = machine.settings.swivel_direction;
    let axis = machine.rotary.iter().find(|axis| Some(axis.letter) == reference);
    let Some(axis) = axis.filter(|axis| axis.max - axis.min <= 360.0) else { return };
    let at = |degrees: &Degrees| degrees[axis.index()] * if is_higher { 1.0 } else { -1.0 };
    let most = taken.iter().map(at).fold(f64::NEG_INFINITY, f64::max);
    taken.retain(|degrees| at(degrees) >= most - ALIKE);
}

/// The same positions in the whole turns that are nearest to `from`, and with a free axis there.
fn wound(machine: &Machine, from: &Degrees, mut degrees: Degrees, free: Option<usize>) -> Degrees {
    if let Some(free) = free {
        degrees[free] = from[free];
    }
    for axis in &machine.rotary {
        let i = axis.index();
        degrees[i] = from[i] + short(degrees[i] - from[i]);
    }
    degrees
}

/// By how much each axis turns.
fn turns(machine: &Machine, from: &Degrees, to: &Degrees) -> Degrees {
    machine.rotary.iter().fold([0.0; 3], |mut turns, axis| {
        let i = axis.index();
        turns[i] = (to[i] - from[i]).abs();
        turns
    })
}

/// An angle without its whole turns, degrees from -180 to 180.
pub(crate) fn short(degrees: f64) -> f64 {
    degrees - 360.0 * (degrees / 360.0).round()
}

/// The same positions in whole turns that are within the travel, where there are such.
fn within_travel(machine: &Machine, mut degrees: Degrees) -> Degrees {
    for axis in &machine.rotary {
        let at = &mut degrees[axis.index()];
        let (min, max) = (axis.min - SLACK, axis.max + SLACK);
        if *at < min || *at > max {
            let first = *at + 360.0 * ((min - *at) / 360.0).ceil();
            if first <= max {
                *at = first;
            }
        }
    }
    degrees
}

/// Whether the rotary axes stand within their travel.
pub(crate) fn is_within(machine: &Machine, degrees: &Degrees) -> bool {
    machine.rotary.iter().all(|axis| {
        let at = degrees[axis.index()];
        at >= axis.min - SLACK && at <= axis.max + SLACK
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Vec3;

    /// A tilting table A with a rotary table C on it, as ISO 841 counts them.
    fn table(travel: &str, settings: &str) -> Machine {
        let axis = |letter, axis, travel| {
            format!(
                "[[rotary]]\nletter = \"{letter}\"\non = \"table\"\naxis = {axis}\nsign = -1\n{travel}\n\
                 rapid = 9000\nacceleration = 300\n"
            )
        };
        let axes = axis("A", "[1, 0, 0]", travel) + &axis("C", "[0, 0, 1]", "");
        let text = format!(
            "reader = \"fanuc\"\n[settings]\n{settings}\n[words]\nX = {{}}\n[orientation]\n\
             simultaneous = \"tool-center-angles\"\n{axes}"
        );
        machine::load_text("table.toml", &text).unwrap_or_else(|why| panic!("{why}"))
    }

    /// The positions of A and C that are possible for a tool axis that leans by 45° to +X, from A and C.
    fn taken(machine: &Machine, choice: TiltChoice, a: f64, c: f64) -> Vec<[i32; 2]> {
        let solutions = machine.inverse(Vec3::new(1.0, 0.0, 1.0).normalize()).unwrap();
        let mut taken = Vec::new();
        take(machine, choice, &[[a, 0.0, c]], &solutions, &mut taken);
        let mut whole: Vec<_> =
            taken.iter().map(|at| [0, 2].map(|i| at[i].round() as i32)).collect();
        whole.sort_unstable();
        whole
    }

    const PLUS: [i32; 2] = [45, 90];
    const MINUS: [i32; 2] = [-45, -90];

    /// The table of iTNC 530, DIN/ISO programming (6/2010), p. 404: `PLANE SPATIAL SPA+0 SPB+45 SPC+0` on a machine with
    /// a rotary table C and a tilting table A. Of two ways that are as long as each other the manual names the positive
    /// one; here either is possible.
    #[test]
    fn a_plane_takes_the_solution_of_the_manuals_table() {
        use TiltChoice::{Sequence, ShorterWithin};
        let free = table("", "");
        for (a, c, choice, expected) in [
            (0.0, 0.0, ShorterWithin, &[MINUS, PLUS][..]),
            (0.0, 0.0, Sequence(true), &[PLUS]),
            (0.0, 0.0, Sequence(false), &[MINUS]),
            (0.0, -105.0, ShorterWithin, &[MINUS]),
            (0.0, -105.0, Sequence(true), &[PLUS]),
            (0.0, -105.0, Sequence(false), &[MINUS]),
            (0.0, -135.0, Sequence(true), &[PLUS]),
        ] {
            assert_eq!(taken(&free, choice, a, c), expected, "{choice:?} from A{a} C{c}");
        }
        let limited = table("min = -90\nmax = 10", "");
        assert_eq!(taken(&limited, ShorterWithin, 0.0, 0.0), [MINUS]);
        // An error of the control: it is beyond the travel, and so refused.
        assert_eq!(taken(&limited, Sequence(true), 0.0, 0.0), [PLUS]);
    }

    /// FANUC, 16i operator's manual p. 1380: the first axis that turns less decides, then the second, then what is nearer
    /// to 0°. B-63944EN p. 677: 19608#5 turns the order round; p. 756: 19741 to 19744 leave out what is beyond a range.
    #[test]
    fn g53_1_takes_the_least_turn_of_the_first_axis_that_differs() {
        let least = TiltChoice::LeastTurn;
        let plain = table("", "tilt_second_axis_first = false\ntilt_within_travel = false");
        assert_eq!(taken(&plain, least, -10.0, 30.0), [MINUS]);
        assert_eq!(taken(&plain, least, 0.0, 30.0), [PLUS]);
        assert_eq!(taken(&plain, least, 0.0, 0.0), [MINUS, PLUS]);
        let other = table("", "tilt_second_axis_first = true\ntilt_within_travel = false");
        assert_eq!(taken(&other, least, -10.0, 30.0), [PLUS]);
        // Nobody says which of the two holds.
        let unsaid = table("", "tilt_within_travel = false");
        assert_eq!(taken(&unsaid, least, -10.0, 30.0), [MINUS, PLUS]);
        // The axes stand at one of the solutions: no order takes them away from it.
        assert_eq!(taken(&unsaid, least, 45.0, 90.0), [PLUS]);
        let within = "tilt_second_axis_first = false\ntilt_within_travel = true";
        assert_eq!(taken(&table("min = -30\nmax = 110", within), least, -10.0, 30.0), [PLUS]);
        let blind = "tilt_second_axis_first = false\ntilt_within_travel = false";
        assert_eq!(taken(&table("min = -30\nmax = 110", blind), least, -10.0, 30.0), [MINUS]);
        let either = table("min = -30\nmax = 110", "tilt_second_axis_first = false");
        assert_eq!(taken(&either, least, -10.0, 30.0), [MINUS, PLUS]);
    }

    /// SINUMERIK operating manual, "Direction (minus/plus)": the lower or higher position of the axis of the data set; the
    /// other solution where that one is out of reach.
    #[test]
    fn the_direction_of_cycle800_takes_the_lower_or_the_higher_position() {
        let choose = TiltChoice::Higher;
        let range = "min = -110\nmax = 110";
        let known = table(range, "swivel_direction = \"A\"");
        assert_eq!(taken(&known, choose(false), 0.0, 0.0), [MINUS]);
        assert_eq!(taken(&known, choose(true), 0.0, 0.0), [PLUS]);
        assert_eq!(taken(&table(range, ""), choose(true), 0.0, 0.0), [MINUS, PLUS]);
        // C turns for ever: which of its positions is the lower one, nobody says.
        let endless = table(range, "swivel_direction = \"C\"");
        assert_eq!(taken(&endless, choose(true), 0.0, 0.0), [MINUS, PLUS]);
        let limited = table("min = -30\nmax = 110", "swivel_direction = \"A\"");
        assert_eq!(taken(&limited, choose(false), 0.0, 0.0), [PLUS]);
    }

    #[test]
    fn every_solution_brings_the_tool_where_it_should_be() {
        let machine = table("min = -200\nmax = 200", "");
        for axis in [Vec3::Z, Vec3::X, Vec3::new(0.3, -0.5, 0.7), Vec3::new(-0.2, 0.1, -0.9)] {
            let axis = axis.normalize();
            let solutions = machine.inverse(axis).unwrap();
            let found: Vec<Degrees> = all(&machine, &solutions).collect();
            assert!(found.len() >= 2);
            for degrees in found {
                assert!(machine.axis_at(degrees).distance(axis) < 1e-6, "{axis} {degrees:?}");
            }
        }
    }
}
