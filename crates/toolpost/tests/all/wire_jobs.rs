//! Random wire jobs on the wire machines of the library: each is made and proven, or refused by the planner under a rule that a
//! machinist accepts, with a way out. What is written never fails its own proof.

use crate::dice::Dice;
use crate::folder::Folder;
use geom::Vec2;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Rules under which a job may be refused, each before anything is written.
const ACCEPTED: &[&str] = &[
    "cuts-part",
    "inner-corner",
    "offset-divides",
    "offset-vanishes",
    "self-crossing",
    "tab",
    "taper",
    "taper-corner",
    "taper-lead",
];

/// How many jobs there are, and how many with `TOOLPOST_JUDGES=long`.
const JOBS: [u64; 2] = [240, 2_000];

/// The corners of a shape, counter-clockwise about the origin.
fn corners(dice: &mut Dice) -> Vec<Vec2> {
    let (w, h) = (dice.number(6.0, 40.0), dice.number(6.0, 40.0));
    let p = Vec2::new;
    match dice.below(5) {
        0 => vec![p(-w, -h), p(w, -h), p(w, h), p(-w, h)],
        // An angle with one inner corner.
        1 => vec![p(-w, -h), p(w, -h), p(w, 0.0), p(0.0, 0.0), p(0.0, h), p(-w, h)],
        // A wedge with a sharp tip.
        2 => vec![p(-w, -h / 4.0), p(w, 0.0), p(-w, h / 4.0)],
        // A square with a slot.
        3 => {
            let half = dice.number(0.2, 3.0);
            let slot = [p(w, -half), p(0.0, -half), p(0.0, half), p(w, half)];
            [p(-w, -h), p(w, -h)].into_iter().chain(slot).chain([p(w, h), p(-w, h)]).collect()
        }
        // A star of any corners.
        _ => {
            let n = 3 + dice.below(7);
            let corner = |i: u64| {
                let angle = std::f64::consts::TAU * i as f64 / n as f64;
                Vec2::from_angle(angle) * dice.number(8.0, 30.0)
            };
            (0..n).map(corner).collect()
        }
    }
}

/// A program of one contour: straight sides and bulging ones, corners that are sharp and such with a fillet.
fn contour(dice: &mut Dice) -> String {
    if dice.once_in(8) {
        let r = dice.number(0.3, 20.0);
        return program(&[format!("G3 X{r:.4} Y0. I{:.4} J0.", -r)], Vec2::new(r, 0.0));
    }
    let corners = corners(dice);
    let n = corners.len();
    let fillets = dice.below(4);
    let fillet = |dice: &mut Dice| match fillets {
        0 => 0.0,
        1 => dice.one_of(&[0.0, 0.0, 0.05, 0.2, 1.0]),
        2 => dice.number(0.1, 2.0),
        _ => 3.0,
    };
    let bulges = dice.once_in(3);
    // Of each corner where its fillet begins and ends.
    let mut ends = Vec::new();
    let mut bulged = vec![false; n];
    if bulges {
        bulged.iter_mut().for_each(|side| *side = dice.once_in(2));
    }
    for i in 0..n {
        let (before, here, after) = (corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]);
        let (p, q) = ((before - here).normalize(), (after - here).normalize());
        let half = p.angle_to(q).abs() / 2.0;
        let radius = fillet(dice);
        let along = radius / half.tan();
        let room = before.distance(here).min(after.distance(here)) / 2.0;
        if radius == 0.0 || along > 0.9 * room || bulged[i] || bulged[(i + n - 1) % n] {
            ends.push((here, here, Vec2::ZERO, 0.0));
            continue;
        }
        let center = here + (p + q).normalize() * (radius / half.sin());
        ends.push((here + p * along, here + q * along, center, p.perp_dot(q)));
    }
    let first = ends[0].1;
    let mut moves = Vec::new();
    for i in 0..n {
        let (_, from, ..) = ends[i];
        let (to, after, center, turn) = ends[(i + 1) % n];
        if bulged[i] {
            let chord = to - from;
            let bulge = dice.one_of(&[-0.3, -0.1, 0.15, 0.4]);
            // The middle of the chord, and the centre on its normal: sagitta over half the chord is the bulge.
            let radius = chord.length() * (1.0 + bulge * bulge) / (4.0 * f64::abs(bulge));
            let g = if bulge > 0.0 { 3 } else { 2 };
            moves.push(format!("G{g} X{:.4} Y{:.4} R{:.4}", to.x, to.y, radius));
        } else {
            moves.push(format!("G1 X{:.4} Y{:.4}", to.x, to.y));
        }
        if to != after {
            let (i, j) = (center.x - to.x, center.y - to.y);
            let g = if turn < 0.0 { 3 } else { 2 };
            moves.push(format!("G{g} X{:.4} Y{:.4} I{i:.4} J{j:.4}", after.x, after.y));
        }
    }
    program(&moves, first)
}

fn program(moves: &[String], start: Vec2) -> String {
    let mut text = format!("%\nO1\nG21 G90\nG0 X{:.4} Y{:.4}\nM60\n", start.x, start.y);
    for line in moves {
        writeln!(text, "{line}").unwrap();
    }
    text + "M50\nM30\n%\n"
}

/// What is asked for.
fn call(dice: &mut Dice) -> Vec<String> {
    let machine = dice.one_of(&["fanuc-wire", "sodick-iso", "agie-iso", "bp-95d"]);
    let mut words = vec!["--machine".into(), machine.into()];
    let mut say = |name: &str, value: String| words.extend([format!("--{name}"), value]);
    say("side", dice.one_of(&["inside", "outside", "left", "right", "part"]).into());
    say("wire", dice.one_of(&["0.1", "0.2", "0.25", "0.3"]).into());
    say("gap", dice.one_of(&["0.005", "0.01", "0.03"]).into());
    match dice.below(4) {
        0 => say("leave", "0.05".into()),
        1 => say("leave", "0.1,0.03".into()),
        2 => say("leave", "0.15,0.05,0.005".into()),
        _ => {}
    }
    say("lead", dice.one_of(&["0.1", "0.5", "1", "2", "4", "6"]).into());
    if dice.once_in(4) {
        say("lead-arc", dice.one_of(&["0.05", "0.5", "1.5"]).into());
    }
    if dice.once_in(5) {
        let place = (dice.number(-20.0, 20.0), dice.number(-20.0, 20.0));
        say("begin", format!("{},{}", place.0, place.1));
    }
    if dice.once_in(6) {
        let place = (dice.number(-30.0, 30.0), dice.number(-30.0, 30.0));
        say("thread", format!("{},{}", place.0, place.1));
    }
    if dice.once_in(3) {
        say("trims", "repeat".into());
    }
    if !dice.once_in(3) {
        let angle = dice.one_of(&[0.25, 1.0, 3.0, 5.0, 15.0]);
        let sign = dice.one_of(&[1.0, -1.0]);
        say("taper", format!("{}", angle * sign));
        say("height", dice.one_of(&["5", "20", "60"]).into());
        say("uv-height", "80".into());
        say("rounding", dice.one_of(&["conical", "constant"]).into());
    }
    match dice.below(5) {
        0 => say("step", "0.5".into()),
        1 => say("chord-error", "0.002".into()),
        _ => {}
    }
    match dice.below(4) {
        0 if machine != "bp-95d" => words.push("--by-control".into()),
        1 => words.extend(["--tab".into(), "1.5".into()]),
        _ => {}
    }
    if !dice.once_in(3) {
        words.push("--round-corners".into());
    }
    words
}

/// How a job ends: made, or refused by a rule; `Err` is what it must not be.
fn outcome(folder: &Folder, seed: u64) -> Result<String, String> {
    let mut dice = Dice(seed);
    let (source, call) = (contour(&mut dice), call(&mut dice));
    folder.write("part.nc", &source);
    let Err(found) = made(folder, &call) else { return Ok("made".into()) };
    let text = |key: &str| found[key].as_str().unwrap_or_default().to_owned();
    let (rule, help) = (text("rule"), text("help"));
    let shown = || format!("{rule}: seed {seed}: {}\n{source}{found:#}", call.join(" "));
    if !ACCEPTED.contains(&rule.as_str()) || help.is_empty() {
        return Err(shown());
    }
    // A lead that the message names has room.
    let Some(offered) = help.strip_prefix("there is room with ") else { return Ok(rule) };
    let offered = offered.split(" and ").next().unwrap_or_default();
    let mut again = call.clone();
    for name in ["--lead", "--begin", "--thread"] {
        let at = again.iter().position(|word| word == name);
        if let Some(at) = at.filter(|_| name != "--begin" || offered.contains("--begin")) {
            again.drain(at..at + 2);
        }
    }
    again.extend(offered.split(' ').map(str::to_owned));
    match made(folder, &again) {
        Ok(()) => Ok(format!("{rule}, then made")),
        // An Agie leans no wire by itself, whatever the lead.
        Err(why) if why["rule"] == "taper" => Ok(format!("{rule}, then taper")),
        Err(why) => Err(format!("{}\nand with {offered}: {why:#}", shown())),
    }
}

/// Calls the command.
fn made(folder: &Folder, call: &[String]) -> Result<(), serde_json::Value> {
    let words = ["wire", "part.nc", "--from", "fanuc-wire", "--output", "out.nc", "--json"];
    let words: Vec<&str> = words.into_iter().chain(call.iter().map(String::as_str)).collect();
    let said = folder.run(&words);
    let answer = said.json();
    if said.code == 0 { Ok(()) } else { Err(answer["errors"][0].clone()) }
}

#[test]
fn each_wire_job_is_made_and_proven_or_refused_with_a_way_out() {
    let long = std::env::var("TOOLPOST_JUDGES").is_ok_and(|value| value == "long");
    let folder = Folder::empty();
    let mut outcomes: BTreeMap<String, u64> = BTreeMap::new();
    let mut failed = Vec::new();
    for seed in 0..JOBS[usize::from(long)] {
        match outcome(&folder, seed) {
            Ok(how) => *outcomes.entry(how).or_default() += 1,
            Err(why) => failed.push(why),
        }
    }
    eprintln!("{outcomes:?}");
    assert!(failed.is_empty(), "{} jobs fail:\n{}", failed.len(), failed.join("\n"));
    // At once, or with the lead that the refusal names.
    let made = outcomes.iter().filter(|(how, _)| how.ends_with("made"));
    let made: u64 = made.map(|(_, count)| count).sum();
    assert!(made * 2 > JOBS[usize::from(long)], "{outcomes:?}");
}
