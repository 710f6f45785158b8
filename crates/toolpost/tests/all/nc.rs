//! NC programs as a source: the samples of the library, from each machine to each other.

use crate::files::{mills, root};
use control::Setup;
use machine::Machine;
use program::{Op, Pose, Program};

/// The mill whose Z travels 45 mm.
const SMALL: &str = "grbl-3018";

/// The sample of a machine as its control reads it.
fn sample(machine: &Machine) -> Program {
    let file = format!("{}.{}", machine.name, machine.extension);
    let text = std::fs::read(root().join("machines/samples").join(&file)).unwrap();
    nc::read(machine, Setup::default(), &file, &text).unwrap_or_else(|e| panic!("{e}")).program
}

/// The sample programs are read by a person, so what they say is known: what is read from one must be
/// the toolpath that it was made from, by the proof's measure.
#[test]
fn the_sample_of_each_machine_is_the_toolpath_that_it_was_made_from() {
    for machine in mills() {
        let name = &machine.name;
        let axes = if machine.rotary.is_empty() { "three-axes" } else { "five-axes" };
        let path = root().join("machines/samples").join(axes).with_extension("cls");
        let text = std::fs::read(path).unwrap();
        let source = source::apt::read("source", &text, &Default::default()).unwrap().program;
        // Every place of the source is one of the program that was read, in the same order.
        let mut rest = places(&sample(&machine)).into_iter();
        for place in places(&source) {
            let near = rest.any(|p| {
                let (a, b) = (p.axis(), place.axis());
                p.point().distance(place.point()) < 0.003 && a.distance(b) < 1e-4
            });
            assert!(near, "{name}: nothing at {}", place.point());
        }
    }
}

/// Where the tool goes; for a hole its bottom, since controls differ in where a cycle begins.
fn places(program: &Program) -> Vec<Pose> {
    let (mut places, mut depth) = (Vec::new(), 0.0);
    for record in &program.records {
        match &record.op {
            Op::Cycle(cycle) => depth = cycle.depth,
            Op::Hole(pose) => {
                let axis = pose.axis();
                places.push(Pose::new(pose.point() - axis * depth, axis).unwrap());
            }
            op => places.extend(op.pose().copied()),
        }
    }
    places
}

#[test]
fn the_sample_of_each_machine_is_proven_on_every_other_that_can_make_it() {
    for from in mills() {
        let program = sample(&from);
        for machine in mills() {
            let (to, tilts) = (&machine.name, !from.rotary.is_empty());
            let machine = without_functions_of(&from, &program, &machine);
            let from = &from.name;
            match post::write(&program, &machine) {
                Ok(output) => {
                    let tolerances = Default::default();
                    let report = proof::prove(&program, &machine, "new", &output.text, &tolerances);
                    assert!(report.proven, "{from} on {to}: {:?}", report.mismatches);
                }
                // Nothing else is refused than a tilted tool where no axis tilts it.
                Err(found) => {
                    assert!(tilts && machine.rotary.is_empty(), "{from} on {to}: {found:?}");
                    let tilted = |found: &program::Diagnostic| {
                        found.rule.name() == "unreachable-orientation"
                    };
                    assert!(found.iter().any(tilted), "{from} on {to}: {found:?}");
                }
            }
        }
    }
}

/// The machine as somebody sets it up who knows that the functions of the builder of `from`, which a program of that
/// machine calls, mean nothing on it: until then it refuses them.
fn without_functions_of(from: &Machine, program: &Program, machine: &Machine) -> Machine {
    let calls = program.records.iter().any(|record| matches!(record.op, Op::Auxiliary(_)));
    if !calls || from.name == machine.name {
        return machine.clone();
    }
    let found = post::write(program, machine).unwrap_err();
    assert!(
        found.iter().any(|found| found.rule.name() == "auxiliary"),
        "{}: {found:?}",
        machine.name
    );
    let text = format!("extends = \"{}\"\n[blocks]\nauxiliary = \"\"\n", machine.name);
    machine::load_text("mine.toml", &text).unwrap()
}

/// A program for LinuxCNC, written for Mach3.
fn rewritten(blocks: &str) -> Result<String, Box<program::Diagnostic>> {
    let load = |name| machine::load(name).unwrap();
    let text = format!("G21 G90 G54\nT1 M6\nS500 M3\nG43 H1\nG0 X0 Y0\nZ9\n{blocks}\nG0 Z9\nM2\n");
    let from = load("generic-3axis-linuxcnc");
    let reading = nc::read(&from, Setup::default(), "old.ngc", text.as_bytes()).unwrap();
    let output = post::write(&reading.program, &load("generic-3axis-mach3"));
    output.map_err(|errors| errors[0].clone().into()).map(|o| String::from_utf8(o.text).unwrap())
}

#[test]
fn both_coolants_and_a_probe_are_written_and_what_mach3_does_not_do_is_refused() {
    let text = rewritten("M8\nM7\nG1 Z-1 F100").unwrap();
    assert!(text.contains(" M7\n") && text.contains(" M8\n"), "{text}");
    let text = rewritten("G38.3 Z-9 F100").unwrap();
    assert!(text.contains(" G31 Z-9 F100\n"), "{text}");
    // Mach3 cuts no thread, and goes on where its probe has touched nothing.
    for (blocks, rule) in [("G33 Z-9 K1.5", "missing-block"), ("G38.2 Z-9 F100", "probe")] {
        let error = rewritten(blocks).unwrap_err();
        assert_eq!((error.rule.name(), error.line), (rule, 7), "{error}");
    }
}

/// Loops, a subprogram, compensation by the tool table and holes, written for a mill: as motions of an arm.
#[test]
fn the_example_is_made_by_robots() {
    let text = std::fs::read(root().join("examples/flange.nc")).unwrap();
    let tool = |number, radius: f64| control::ToolData {
        number,
        name: String::new(),
        radius,
        length: 45.0,
    };
    let setup = Setup { tools: vec![tool(1, 6.0), tool(2, 3.3)], ..Setup::default() };
    let from = machine::load_origin("fanuc-31i").unwrap();
    let program = nc::read(&from, setup, "flange.nc", &text).unwrap().program;
    for robot in ["universal-ur5e", "fanuc-lrmate-200id-mill", "abb-irb120-mill"] {
        let machine = machine::load(robot).unwrap();
        let text = post::write(&program, &machine).unwrap().text;
        let report = proof::prove(&program, &machine, "flange", &text, &Default::default());
        assert!(report.proven, "{robot}: {:#?}", report.mismatches);
        // Around the flange at its two depths.
        assert!(report.compared.arcs >= 2, "{robot}");
    }
}

/// A clamp is one of a rotary axis, which a robot does not have.
#[test]
fn a_clamp_is_left_out_on_a_robot_with_a_warning() {
    let text = "N1 G54 G90 G71\nN2 T1 D1\nN3 S3000 M3\nN4 M27 M29\nN5 G0 X10 Y0 Z20 A0 C0\nN6 G1 Z-1 F300\nN7 X20\nN8 G0 Z20\nN9 M30\n";
    let from = machine::load_origin("sinumerik-840d-table-ac").unwrap();
    let program = nc::read(&from, Setup::default(), "old.mpf", text.as_bytes()).unwrap().program;
    assert!(program.records.iter().any(|record| matches!(record.op, Op::Clamp(_))));
    let machine = machine::load("kuka-kr6-r900").unwrap();
    let output = post::write(&program, &machine).unwrap();
    assert!(output.warnings.iter().any(|found| found.rule.name() == "clamp"));
    let report = proof::prove(&program, &machine, "old.src", &output.text, &Default::default());
    assert!(report.proven, "{:#?}", report.mismatches);
}

/// The example goes round a flange of R 42 by `G41`, in two depths by a loop and a subprogram, and drills
/// six holes on R 30 by a loop.
#[test]
fn the_example_is_made_by_every_mill_that_is_high_enough_and_is_what_it_says() {
    let text = std::fs::read(root().join("examples/flange.nc")).unwrap();
    let tool = |number, diameter: f64| control::ToolData {
        number,
        name: String::new(),
        radius: diameter / 2.0,
        length: 45.0,
    };
    let setup = Setup { tools: vec![tool(1, 12.0), tool(2, 6.6)], ..Setup::default() };
    let from = machine::load_origin("fanuc-31i").unwrap();
    let program = nc::read(&from, setup, "flange.nc", &text).unwrap().program;
    let (mut circles, mut holes) = (Vec::new(), Vec::new());
    for record in &program.records {
        match &record.op {
            Op::Arc(arc) => circles.push((arc.circle.center(), arc.end.point())),
            Op::Hole(pose) => holes.push(pose.point()),
            _ => {}
        }
    }
    // The centre of the tool is 6 mm outside.
    assert_eq!(circles.len(), 2);
    for ((center, end), depth) in circles.iter().zip([-4.0, -8.0]) {
        assert!(center.with_z(0.0).length() < 1e-9 && end.z == depth);
        assert!((end.with_z(0.0).length() - 48.0).abs() < 1e-9, "{end}");
    }
    assert_eq!(holes.len(), 6);
    for (hole, degrees) in holes.iter().zip([0.0f64, 60.0, 120.0, 180.0, 240.0, 300.0]) {
        let (sin, cos) = degrees.to_radians().sin_cos();
        assert!((hole.x - 30.0 * cos).hypot(hole.y - 30.0 * sin) < 1e-9, "{hole}");
    }
    for machine in mills().filter(|machine| machine.name != SMALL) {
        let output =
            post::write(&program, &machine).unwrap_or_else(|e| panic!("{}: {e:?}", machine.name));
        let report = proof::prove(&program, &machine, "new", &output.text, &Default::default());
        assert!(report.proven, "{}: {:?}", machine.name, report.mismatches);
    }
}
