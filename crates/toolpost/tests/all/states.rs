//! What a source may say besides points, on every mill of the library: it is written and proven, or
//! refused for the reason that stands here. Nothing is left out in silence.

use geom::Vec3;
use machine::library::{MACHINES, names};
use machine::{Machine, load};
use program::{
    ArcTo, Circle, CompensatedPath, Compensation, Coolant, Cycle, CycleKind, Feed, Op, Pose,
    Program, Spindle, Tool,
};

fn mills() -> impl Iterator<Item = Machine> {
    names(MACHINES).map(|name| load(name).unwrap()).filter(|machine| machine.wire.is_none())
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, z)).unwrap()
}

/// The program of `ops` between a start above the part and its end.
fn program(ops: Vec<Op>) -> Program {
    let start = [
        Op::Tool(Box::new(Tool { number: 1, ..Tool::default() })),
        Op::Spindle(Spindle::Clockwise(1000.0)),
        Op::Feed(Feed::PerMinute(200.0)),
        Op::Rapid(at(10.0, 0.0, 20.0)),
    ];
    let compensated_path = Some(CompensatedPath::Contour);
    let mut program = Program { compensated_path, ..Program::new("states") };
    for (line, op) in (1..).zip(start.into_iter().chain(ops)) {
        program.push(line, op);
    }
    let line = program.records.len() as u32;
    program.push(line + 1, Op::End);
    program
}

/// The program that a machine makes of `ops`, proven, or the rule of its refusal.
fn written(machine: &Machine, ops: &[Op]) -> Result<String, &'static str> {
    let source = program(ops.to_vec());
    let output = post::write(&source, machine).map_err(|found| found[0].rule.name())?;
    let report = proof::prove(&source, machine, "p", &output.text, &Default::default());
    assert!(report.proven, "{}: {:?}", machine.name, report.mismatches);
    Ok(String::from_utf8(output.text).unwrap())
}

/// A helix about the zero from `from`, so many turns, to the height `z`.
fn helix(end: Pose, turns: u32) -> Op {
    Op::Arc(Box::new(ArcTo { end, circle: Circle::new(Vec3::ZERO, Vec3::Z, turns).unwrap() }))
}

#[test]
fn a_thread_is_milled_by_helices() {
    // Five turns of 1.5 mm up from the bottom, in one record, and in one record each.
    let whole = vec![Op::Line(at(10.0, 0.0, -7.5)), helix(at(10.0, 0.0, 0.0), 4)];
    let mut single = vec![Op::Line(at(10.0, 0.0, -7.5))];
    single.extend((1..=5).map(|turn| helix(at(10.0, 0.0, -7.5 + 1.5 * f64::from(turn)), 0)));
    for machine in mills() {
        for ops in [&whole, &single] {
            written(&machine, ops).unwrap();
        }
    }
}

#[test]
fn compensation_is_written_with_its_register_or_refused() {
    let ops = [
        Op::Line(at(10.0, 0.0, -2.0)),
        Op::Compensation(Compensation::Left(Some(7))),
        Op::Line(at(20.0, 10.0, -2.0)),
        Op::Line(at(40.0, 10.0, -2.0)),
        Op::Compensation(Compensation::Off),
        Op::Line(at(50.0, 0.0, -2.0)),
        Op::Rapid(at(50.0, 0.0, 20.0)),
    ];
    for machine in mills() {
        let text = written(&machine, &ops);
        match machine.control.as_str() {
            "grbl" | "marlin" => assert_eq!(text, Err("compensation"), "{}", machine.name),
            // The edge, or the tool in the table, holds the radius.
            control if control.starts_with("sinumerik") => assert!(text.unwrap().contains("G41")),
            "heidenhain-tnc640" => assert!(text.unwrap().contains(" RL")),
            _ => assert!(text.unwrap().contains("G41 D7"), "{}", machine.name),
        }
    }
}

#[test]
fn a_coolant_that_the_machine_does_not_have_is_refused() {
    // Haas has M8 and, through the spindle, M88 (Haas, *Mill Operator's Manual*, M codes). The small
    // router has nothing that could be switched. GRBL has M7 in builds of one's own alone (`ENABLE_M7`).
    const NO_MIST: &[&str] = &["grbl", "haas", "heidenhain-tnc640"];
    for machine in mills() {
        let name = machine.name.as_str();
        for (coolant, code, lacks) in [
            (Coolant::Flood, "M8", false),
            (Coolant::Mist, "M7", NO_MIST.contains(&machine.control.as_str())),
        ] {
            let text = written(&machine, &[Op::Coolant(coolant), Op::Line(at(30.0, 0.0, 20.0))]);
            match lacks || name == "grbl-3018" {
                true => assert_eq!(text, Err("missing-block"), "{name}"),
                false => assert!(text.unwrap().contains(code), "{name}"),
            }
        }
    }
}

/// LinuxCNC, "M7, M8, M9": both may run. On a FANUC it is the builder's affair.
#[test]
fn a_coolant_goes_off_before_another_one_runs() {
    let cut = |x: f64| Op::Line(at(x, 0.0, 20.0));
    let ops = [
        Op::Coolant(Coolant::Flood),
        cut(20.0),
        Op::Coolant(Coolant::Mist),
        cut(30.0),
        Op::Rapid(at(30.0, 0.0, 50.0)),
        Op::Stop,
        Op::Rapid(at(30.0, 0.0, 20.0)),
        Op::Coolant(Coolant::Flood),
        cut(40.0),
    ];
    let both =
        [Op::Coolant(Coolant::Flood), cut(20.0), Op::Coolant(Coolant::FloodAndMist), cut(30.0)];
    for machine in mills() {
        let (name, has) = (machine.name.as_str(), |block: &str| {
            machine.blocks.contains_key(block) && !machine.leaves_out(block)
        });
        match has("coolant_mist") {
            true => {
                let text = written(&machine, &ops).unwrap();
                let codes: Vec<_> = text
                    .lines()
                    .filter_map(|line| {
                        line.split(' ').find(|word| ["M7", "M8", "M9"].contains(word))
                    })
                    .collect();
                assert!(codes.join(" ").contains("M8 M9 M7 M9 M8"), "{name}: {text}");
            }
            false => assert_eq!(written(&machine, &ops), Err("missing-block"), "{name}"),
        }
        let text = written(&machine, &both);
        match has("coolant_flood_and_mist") {
            true => assert!(text.unwrap().contains("M7"), "{name}"),
            false => assert_eq!(text, Err("missing-block"), "{name}"),
        }
    }
}

#[test]
fn feeds_a_turn_and_feeds_in_inverse_time_are_written_or_counted_in_mm_per_minute() {
    // 0.1 mm at 1000 1/min; 20 mm in a tenth of a minute: 100 and 200 mm/min.
    let a_turn = [Op::Feed(Feed::PerTurn(0.1)), Op::Line(at(30.0, 0.0, 20.0))];
    let inverse = [Op::Feed(Feed::InverseTime(10.0)), Op::Line(at(30.0, 0.0, 20.0))];
    for machine in mills() {
        for (ops, own, feed) in [
            (&a_turn, machine.capabilities.feed_per_turn, ["G95", "F100"]),
            (&inverse, machine.capabilities.inverse_time, ["G93", "F200"]),
        ] {
            let text = written(&machine, ops).unwrap();
            assert!(text.contains(feed[usize::from(!own)]), "{}: {text}", machine.name);
        }
    }
}

/// Half a circle of radius 10 in a tenth of a minute: 314.159 mm/min. FANUC would divide by the radius.
#[test]
fn an_arc_in_inverse_time_is_written_where_the_control_counts_its_time() {
    let circle = Circle::new(Vec3::new(20.0, 0.0, 0.0), Vec3::Z, 0).unwrap();
    let arc = Op::Arc(Box::new(ArcTo { end: at(30.0, 0.0, 20.0), circle }));
    let ops = [Op::Feed(Feed::InverseTime(10.0)), arc, Op::Line(at(50.0, 0.0, 20.0))];
    for machine in mills() {
        let can = &machine.capabilities;
        let text = written(&machine, &ops).unwrap();
        let feed = match can.inverse_time && can.inverse_time_arcs {
            true => "F10",
            false => "F314",
        };
        assert!(!can.arcs.is_empty() && text.contains(feed), "{}: {text}", machine.name);
    }
}

/// 15 mm down in a thirtieth of a minute, however long the cut before was.
#[test]
fn a_hole_that_is_drilled_by_moves_takes_its_own_time() {
    let kind = CycleKind::Drill;
    let (first_peck, peck) = (None, None);
    let (feed, dwell, depth) = (None, 0.0, 15.0);
    let cycle = Cycle { kind, depth, clearance: 0.0, retract: 17.0, feed, dwell, first_peck, peck };
    let machine = load("generic-3axis-grbl").unwrap();
    let inverse = machine.capabilities.inverse_time;
    for x in [0.5, 300.0] {
        let hole = Op::Hole(at(x, 0.0, 3.0));
        let ops = [Op::Line(at(x, 0.0, 20.0)), Op::Feed(Feed::InverseTime(30.0))];
        let drilled = [Op::Cycle(Box::new(cycle)), hole, Op::CycleOff];
        let text = written(&machine, &[&ops[..], &drilled[..]].concat()).unwrap();
        let down = text.lines().find(|line| line.contains("Z-12")).unwrap();
        let down = down.trim_end_matches('.');
        assert!(down.ends_with(if inverse { "F30" } else { "F450" }), "{text}");
    }
}

#[test]
fn a_tool_axis_is_written_by_machines_that_turn_it() {
    let lean = Vec3::new(0.0, -0.5, 0.75f64.sqrt());
    let pose = |x: f64| Pose::new(Vec3::new(x, 0.0, 20.0), lean).unwrap();
    let ops = [Op::Rapid(pose(0.0)), Op::Line(pose(30.0))];
    for machine in mills() {
        match machine.rotary.is_empty() {
            true => {
                assert_eq!(
                    written(&machine, &ops),
                    Err("unreachable-orientation"),
                    "{}",
                    machine.name
                )
            }
            false => drop(written(&machine, &ops).unwrap()),
        }
    }
}
