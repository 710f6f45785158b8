//! The motions that a proof hands out, against chains of axes that share no code with the project.

use crate::clock::{Clock, times_of};
use crate::files::{mills, root};
use control::{Action, Event};
use geom::Vec3;
use machine::axis_motion::Chain;
use machine::library::{ROBOTS, names};
use machine::linkage::Linkage;
use machine::{Machine, Mount};
use program::{Builder, Feed, Op, Program, Spindle, Tool};
use proof::{AxisPositions, Course, Motion, MotionKind, Tolerances};

/// The proven program, and its motions.
fn posted(source: &Program, machine: &Machine) -> (String, Vec<Motion>) {
    let written =
        post::write(source, machine).unwrap_or_else(|why| panic!("{}: {why:?}", machine.name));
    let mut motions: Vec<Motion> = Vec::new();
    let tolerances = Tolerances::default();
    let report = proof::prove_for(source, machine, "p", &written.text, &tolerances, &mut motions);
    assert!(report.proven, "{}: {:#?}", machine.name, report.mismatches);
    (String::from_utf8(written.text).unwrap(), motions)
}

/// `v` turned about a unit vector by so many degrees (Rodrigues).
fn turned(v: [f64; 3], about: [f64; 3], degrees: f64) -> [f64; 3] {
    let (s, c) = degrees.to_radians().sin_cos();
    let dot: f64 = (0..3).map(|i| v[i] * about[i]).sum();
    let cross = [
        about[1] * v[2] - about[2] * v[1],
        about[2] * v[0] - about[0] * v[2],
        about[0] * v[1] - about[1] * v[0],
    ];
    [0, 1, 2].map(|i| v[i] * c + cross[i] * s + about[i] * dot * (1.0 - c))
}

/// The tip on the part, from the axes, link by link: from the spindle's gauge line out to the tip, into the machine, into the
/// table, and from there to the work zero.
fn tip(machine: &Machine, linear: Vec3, rotary: [f64; 3], length: f64) -> [f64; 3] {
    let angle = |letter: char| rotary[letter as usize - 'A' as usize];
    let mut at = [0.0, 0.0, -length];
    // The last axis of the head carries the spindle.
    for axis in machine.rotary.iter().rev().filter(|axis| axis.on == Mount::Head) {
        let point = axis.point.to_array();
        let off = [0, 1, 2].map(|i| at[i] - point[i]);
        let off = turned(off, axis.axis.to_array(), axis.sign * (angle(axis.letter) - axis.offset));
        at = [0, 1, 2].map(|i| off[i] + point[i]);
    }
    let linear = linear.to_array();
    at = [0, 1, 2].map(|i| at[i] + linear[i]);
    // The first axis of the table stands on the machine, the last carries the part.
    for axis in machine.rotary.iter().filter(|axis| axis.on == Mount::Table) {
        let point = axis.point.to_array();
        let off = [0, 1, 2].map(|i| at[i] - point[i]);
        let off =
            turned(off, axis.axis.to_array(), -axis.sign * (angle(axis.letter) - axis.offset));
        at = [0, 1, 2].map(|i| off[i] + point[i]);
    }
    let zero = machine.work_zero.unwrap_or_default().to_array();
    [0, 1, 2].map(|i| at[i] - zero[i])
}

#[test]
fn the_axes_of_each_mill_bring_the_tip_to_where_the_motion_ends() {
    let mut compared = 0;
    for machine in mills().filter(|machine| !machine.rotary.is_empty()) {
        let text = std::fs::read(root().join("machines/samples/five-axes.cls")).unwrap();
        let source = source::apt::read("s.cls", &text, &Default::default()).unwrap().program;
        let linkage = Linkage::of(&machine);
        let mut length = 0.0;
        let lengths: Vec<f64> = source
            .records
            .iter()
            .map(|record| {
                if let Op::Tool(tool) = &record.op {
                    length = tool.length.unwrap_or_default();
                }
                length
            })
            .collect();
        for motion in posted(&source, &machine).1 {
            let AxisPositions::Mill { linear, rotary } = motion.axes else { panic!("{motion:?}") };
            let should = motion.tool[1].tip;
            let Some(length) = lengths.get(motion.record).filter(|_| linear.is_finite()) else {
                continue;
            };
            let is = tip(&machine, linear, rotary, *length);
            let off = should.distance(Vec3::from_array(is));
            assert!(off < 1e-9 || should.is_nan(), "{}: {off} mm, {motion:?}", machine.name);
            // The links of a drawing lead there too.
            let letters = machine.rotary.iter().map(|axis| rotary[axis.index()]);
            let axes: Vec<f64> = linear.to_array().into_iter().chain(letters).collect();
            let drawn = linkage.tip(&axes, *length);
            assert!(should.distance(drawn) < 1e-9 || should.is_nan(), "{}: {drawn}", machine.name);
            compared += usize::from(should.is_finite());
        }
    }
    assert!(compared > 150, "{compared}");
}

/// Where rotary axes turn and the control does not keep the tip, the axes lead it, from where the motion begins to where it ends.
#[test]
fn between_the_ends_of_a_motion_the_axes_lead_the_tip() {
    let (mut led, mut farthest) = (0, 0.0_f64);
    for machine in mills().filter(|machine| !machine.rotary.is_empty()) {
        let text = std::fs::read(root().join("machines/samples/five-axes.cls")).unwrap();
        let source = source::apt::read("s.cls", &text, &Default::default()).unwrap().program;
        let length = source.records.iter().find_map(|record| match &record.op {
            Op::Tool(tool) => tool.length,
            _ => None,
        });
        let length = length.unwrap_or_default();
        let chain = Chain::of(&machine);
        let mut before: Option<Vec<f64>> = None;
        for motion in posted(&source, &machine).1 {
            let AxisPositions::Mill { linear, rotary } = motion.axes else { panic!("{motion:?}") };
            let letters = machine.rotary.iter().map(|axis| rotary[axis.index()]);
            let to: Vec<f64> = linear.to_array().into_iter().chain(letters).collect();
            let from = before.replace(to.clone());
            let [start, end] = motion.tool;
            let from = from.filter(|from| from[3..] != to[3..] && start.tip.is_finite());
            let is_led = matches!(motion.course, Course::Axes | Course::EachAxis);
            let Some(from) = from.filter(|_| is_led) else { continue };
            let together = motion.course == Course::Axes;
            let Some(way) = chain.motion([&from, &to], (end.tip, end.axis), together) else {
                continue;
            };
            let tool = way.tool();
            for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
                let axes: Vec<f64> =
                    from.iter().zip(&to).map(|(a, b)| a + (b - a) * part).collect();
                let mut turned = [0.0; 3];
                for (axis, degrees) in machine.rotary.iter().zip(&axes[3..]) {
                    turned[axis.index()] = *degrees;
                }
                let should = tip(&machine, Vec3::new(axes[0], axes[1], axes[2]), turned, length);
                let off = tool(part).0.distance(Vec3::from_array(should));
                assert!(off < 1e-9, "{}: {off} mm at {part} of {motion:?}", machine.name);
            }
            assert!(tool(0.0).0.distance(start.tip) < 1e-9, "{}: {motion:?}", machine.name);
            farthest = farthest.max(tool(0.5).0.distance(start.tip.lerp(end.tip, 0.5)));
            led += 1;
        }
    }
    // Cuts leave their line by as much as they may, which is more than a line is drawn off.
    assert!(led > 20 && farthest > 0.002, "{led} motions, {farthest} mm");
}

/// The motions of the robots' sample on an arm, each between the positions of the axes before it, where they are known, and behind it.
fn motions_of_arm(machine: &Machine) -> Vec<(Option<Vec<f64>>, Motion, Vec<f64>)> {
    let text = std::fs::read(root().join("machines/samples/robot.cls")).unwrap();
    let source = source::apt::read("s.cls", &text, &Default::default()).unwrap().program;
    let mut before: Option<Vec<f64>> = None;
    let between = |motion: Motion| {
        let AxisPositions::Arm { joints, rail } = motion.axes else { panic!("{motion:?}") };
        let to: Vec<f64> = joints.into_iter().chain(rail).collect();
        (before.replace(to.clone()), motion, to)
    };
    posted(&source, machine).1.into_iter().map(between).collect()
}

/// The joints of an arm lead the tip from where the motion before ends: the chain of the drawing, from the end of each motion back to its begin.
#[test]
fn between_the_ends_of_a_motion_of_joints_they_lead_the_tip() {
    let (mut led, mut farthest) = (0, 0.0_f64);
    for name in names(ROBOTS) {
        let machine = machine::load(name).unwrap();
        let chain = Chain::of(&machine);
        for (from, motion, to) in motions_of_arm(&machine) {
            assert_eq!(motion.course == Course::Axes, motion.kind == MotionKind::Joints);
            let Some(from) = from.filter(|_| motion.course == Course::Axes) else { continue };
            let [start, end] = motion.tool;
            let Some(way) = chain.motion([&from, &to], (end.tip, end.axis), true) else { continue };
            let tool = way.tool();
            let (tip, axis) = tool(0.0);
            let off = tip.distance(start.tip);
            assert!(off < 1e-6 && axis.distance(start.axis) < 1e-9, "{name}: {off}, {motion:?}");
            farthest = farthest.max(tool(0.5).0.distance(tip.lerp(end.tip, 0.5)));
            led += 1;
        }
    }
    assert!(led > 20 && farthest > 10.0, "{led} motions, {farthest} mm");
}

/// On the lines and arcs of an arm its joints are those before it at the beginning and those behind it at the end, and in between the links lead the
/// tip to where it is on its way.
#[test]
fn on_lines_and_arcs_of_an_arm_its_joints_lead_the_tip_along_them() {
    let (mut kept, mut farthest) = (0, 0.0_f64);
    for name in names(ROBOTS) {
        let machine = machine::load(name).unwrap();
        let chain = Chain::of(&machine);
        for (from, motion, to) in motions_of_arm(&machine) {
            let Some(from) = from.filter(|_| motion.course == Course::Tool) else { continue };
            let [start, end] = motion.tool;
            let behind = (end.tip, end.axis);
            let at = |part: f64| match &motion.kind {
                MotionKind::Arc(arc) => arc.at(part),
                _ => start.tip.lerp(end.tip, part),
            };
            let axes =
                |part: f64| chain.keeping_tip([&from, &to], behind, at(part), part).unwrap().0;
            for (part, told) in [(0.0, &from), (1.0, &to)] {
                let off =
                    axes(part).iter().zip(told).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(off < 1e-4, "{name}: {off} at {part} of {motion:?}");
            }
            let half = axes(0.5);
            let way = chain.motion([&half, &to], behind, true).unwrap();
            let off = way.tool()(0.0).0.distance(at(0.5));
            assert!(off < 1e-6, "{name}: {off} mm in the midst of {motion:?}");
            // Joints that go evenly would leave it.
            let even: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a.midpoint(*b)).collect();
            let way = chain.motion([&even, &to], behind, true).unwrap();
            farthest = farthest.max(way.tool()(0.0).0.distance(at(0.5)));
            kept += 1;
        }
    }
    assert!(kept > 60 && farthest > 1.0, "{kept} motions, {farthest} mm");
}

/// By hand: 20 degrees are 0.3491 rad, and at 2000 mm/min a UR turns the tool by 4 rad/s for each of 0.0333 m/s: 2.618 s, and not the 0.03 s of 1 mm.
#[test]
fn a_cut_in_which_the_tool_turns_takes_as_long_as_the_control_needs_for_that() {
    let machine = machine::load("universal-ur5e").unwrap();
    let lean = [0.342_020_1, 0.0, 0.939_692_6];
    let mut source = Builder::new("lean");
    source.tool(Tool { number: 1, ..Tool::default() }).unwrap();
    source.spindle(Spindle::Clockwise(5000.0)).unwrap();
    source.feed(Feed::PerMinute(2000.0)).unwrap();
    source.rapid([0.0, 0.0, 40.0], None).unwrap();
    source.line([0.0, 0.0, 0.0], None).unwrap();
    source.line([1.0, 0.0, 0.0], Some(lean)).unwrap();
    source.rapid([35.202_01, 0.0, 93.969_26], Some(lean)).unwrap();
    let (_, motions) = posted(&source.build(), &machine);
    let seconds =
        |record: usize| motions.iter().find(|motion| motion.record == record).unwrap().seconds;
    assert!((seconds(4) - 1.2).abs() < 1e-3, "{}", seconds(4));
    assert!((seconds(5) - 2.618).abs() < 1e-3, "{}", seconds(5));
}

fn slot() -> Program {
    let mut slot = Builder::new("slot");
    slot.tool(Tool { number: 1, ..Tool::default() }).unwrap();
    slot.spindle(Spindle::Clockwise(5000.0)).unwrap();
    slot.feed(Feed::PerMinute(300.0)).unwrap();
    slot.rapid([0.0, 0.0, 30.0], None).unwrap();
    slot.rapid([0.0, 0.0, 5.0], None).unwrap();
    slot.line([0.0, 0.0, -1.0], None).unwrap();
    slot.arc([10.0, 0.0, -1.0], [5.0, 0.0, -1.0], [0.0, 0.0, 1.0], 0).unwrap();
    slot.rapid([10.0, 0.0, 30.0], None).unwrap();
    slot.build()
}

#[test]
fn an_arm_tells_its_joints_and_the_block_of_each_motion() {
    let machine = machine::load("kuka-kr6-r900").unwrap();
    let (text, found) = posted(&slot(), &machine);
    let (arm, cell) = (machine.arm.as_ref().unwrap(), machine.cell.as_ref().unwrap());
    let mut made = Vec::new();
    for motion in &found {
        let AxisPositions::Arm { joints, rail: None } = motion.axes else { panic!("{motion:?}") };
        // The lengths of the arm have tests of their own, against two independent derivations.
        let flange = arm.flange(&arm.model(&joints.map(f64::to_radians)).unwrap());
        let tool = cell.part.inverse() * flange * cell.tool(None).unwrap();
        assert!(tool.translation.distance(motion.tool[1].tip) < 1e-3, "{motion:?}");
        let (word, way) = match motion.kind {
            MotionKind::Joints => ("PTP", 'J'),
            MotionKind::Rapid | MotionKind::Line => ("LIN", 'L'),
            MotionKind::Arc(_) => ("CIRC", 'A'),
        };
        let line = text.lines().nth(motion.line as usize - 1).unwrap();
        assert!(line.trim_start().starts_with(word), "{motion:?}: {line}");
        made.push((motion.record, way));
    }
    // Records 3 and 5 to 7 of the source; the half circle is one arc, and out of the slot the tool goes straight.
    for should in [(3, 'J'), (5, 'L'), (6, 'A'), (7, 'L')] {
        assert!(made.contains(&should), "{should:?} is not in {made:?}");
    }
    assert!(made.windows(2).all(|pair| pair[0].0 <= pair[1].0), "{made:?}");
}

/// What the control reports is what is told: every event that moves, in its order.
#[test]
fn each_move_of_the_control_is_told_once() {
    for name in ["three-axes", "five-axes"] {
        let text = std::fs::read(root().join("machines/samples").join(name).with_extension("cls"));
        let source =
            source::apt::read("s.cls", &text.unwrap(), &Default::default()).unwrap().program;
        let machine = match name {
            "three-axes" => machine::load("generic-3axis-linuxcnc"),
            _ => machine::load("sinumerik-840d-traori"),
        };
        let machine = machine.unwrap();
        let (text, found) = posted(&source, &machine);
        let settings = nc::settings(&machine, control::Setup::default()).unwrap();
        let (mut lines, mut holes): (Vec<u32>, Vec<u32>) = Default::default();
        let keep = &mut |event: Event| {
            let moves = matches!(event.action, Action::Line(_) | Action::Arc(_));
            lines.extend(moves.then_some(event.line));
            holes.extend(matches!(event.action, Action::Hole(_)).then_some(event.line));
            Ok(())
        };
        control::read(&settings, "p", text.as_bytes(), keep).unwrap();
        let told: Vec<u32> = found
            .iter()
            .filter(|motion| !matches!(motion.kind, MotionKind::Rapid))
            .map(|motion| motion.line)
            .filter(|line| !holes.contains(line))
            .collect();
        assert_eq!(told, lines, "{name}");
        assert!(told.len() > 5, "{name}: {told:?}");
    }
}

/// What is cut and what is waited takes what the report says. Rapids take what they take as the program makes them: axis by axis, and by
/// way of a retract; to and from home nothing, which the tool change counts.
#[test]
fn times_of_the_motions_are_those_of_the_report() {
    let mut compared = 0;
    for machine in mills() {
        let name = &machine.name;
        let axes = if machine.rotary.is_empty() { "three-axes" } else { "five-axes" };
        let text = std::fs::read(root().join("machines/samples").join(axes).with_extension("cls"));
        let source =
            source::apt::read("s.cls", &text.unwrap(), &Default::default()).unwrap().program;
        let times = times_of(&source, &machine);
        let found = posted(&source, &machine).1;
        let cuts = found.iter().filter(|motion| motion.kind != MotionKind::Rapid);
        let cutting: f64 = cuts.map(|motion| motion.seconds).sum();
        // Words of positions and of inverse time are rounded.
        let allowed = if machine.rotary.is_empty() { 1e-9 } else { 1e-4 };
        let off = (cutting / times.cutting - 1.0).abs();
        assert!(off < allowed, "{name}: cuts {cutting} s, {} s in the report", times.cutting);
        let waited: f64 = found.iter().map(|motion| motion.waited).sum();
        let waits = times.dwell + times.tool_change;
        assert!((waited - waits).abs() < 1e-9, "{name}: waits {waited} s, {waits} s in the report");

        // A rapid of the source that the program makes in one block, from where the source has it begin.
        let mut clock = Clock::new(&machine);
        let mut here: Option<Vec3> = None;
        for (i, record) in source.records.iter().enumerate() {
            let before = clock.times.rapid;
            clock.run(&record.op);
            let Op::Rapid(to) = &record.op else {
                here = record.op.pose().map(program::Pose::point).or(here);
                continue;
            };
            let made: Vec<&Motion> = found.iter().filter(|motion| motion.record == i).collect();
            if let ([one], Some(here)) = (&made[..], here)
                && one.tool[0].tip.distance(here) < 1e-3
            {
                let should = clock.times.rapid - before;
                // Rounding of a way of some mm.
                let off = (one.seconds - should).abs();
                assert!(off < 1e-3 * should, "{name}: {should} s, {one:?}");
                compared += 1;
            }
            here = Some(to.point());
        }
    }
    assert!(compared > 50, "{compared}");
}

#[test]
fn the_links_of_each_robot_bring_the_tip_to_where_the_motion_ends() {
    let mut compared = 0;
    for name in names(ROBOTS) {
        let machine = machine::load(name).unwrap();
        let text = std::fs::read(root().join("machines/samples/robot.cls")).unwrap();
        let source = source::apt::read("s.cls", &text, &Default::default()).unwrap().program;
        let (linkage, cell) = (Linkage::of(&machine), machine.cell.as_ref().unwrap());
        let mut length = None;
        let lengths: Vec<Option<f64>> = source
            .records
            .iter()
            .map(|record| {
                if let Op::Tool(tool) = &record.op {
                    length = tool.length;
                }
                length.or(cell.tool_length)
            })
            .collect();
        for motion in posted(&source, &machine).1 {
            let AxisPositions::Arm { joints, rail } = motion.axes else { panic!("{motion:?}") };
            let Some(Some(length)) = lengths.get(motion.record) else { continue };
            let axes: Vec<f64> = joints.into_iter().chain(rail).collect();
            let off = linkage.tip(&axes, *length).distance(motion.tool[1].tip);
            // Home, before the tool is called, is told of another tool.
            if motion.tool[1].tip.is_finite() && motion.kind != MotionKind::Joints {
                assert!(off < 1e-6, "{name}: {off} mm, {motion:?}");
                compared += 1;
            }
        }
    }
    assert!(compared > 60, "{compared}");
}

/// The largest deviations of the motions are those of the report, on mills and on robots, and so is the sum of their times.
#[test]
fn deviations_and_times_of_the_motions_are_those_of_the_report() {
    let robots = names(ROBOTS).map(|name| machine::load(name).unwrap());
    for machine in mills().chain(robots) {
        let sample = match (&machine.arm, machine.rotary.is_empty()) {
            (Some(_), _) => "robot.cls",
            (None, true) => "three-axes.cls",
            (None, false) => "five-axes.cls",
        };
        let text = std::fs::read(root().join("machines/samples").join(sample)).unwrap();
        let source = source::apt::read("s.cls", &text, &Default::default()).unwrap().program;
        let text = post::write(&source, &machine).unwrap().text;
        let (mut motions, tolerances) = (Vec::<Motion>::new(), Tolerances::default());
        let report = proof::prove_for(&source, &machine, "p", &text, &tolerances, &mut motions);
        let deviations = motions.iter().filter_map(|motion| motion.deviation);
        let (tip, axis) = deviations.fold((0.0, 0.0), |(tip, axis): (f64, f64), of| {
            (tip.max(of.tip_mm), axis.max(of.axis_degrees))
        });
        let reported = &report.deviations;
        let (name, tip_mm) = (&machine.name, reported.tip_mm.value.max(reported.path_mm.value));
        let times = report.program.time_s;
        let whole: f64 = motions.iter().map(|motion| motion.waited + motion.seconds).sum();
        assert!((whole - times.total()).abs() < 1e-6 * whole, "{name}: {whole} s, {times:?}");
        let alone = proof::prove(&source, &machine, "p", &text, &tolerances);
        assert_eq!(alone, report, "{name}");
        // The report has no ends of rapids of an arm.
        let is_alike = if machine.arm.is_some() { tip >= tip_mm } else { tip == tip_mm };
        assert!(is_alike, "{name}: {tip} mm, {tip_mm} mm in the report");
        // Between the ends of a cut the axis is no nearer than at its end.
        let allowed = &report.tolerances;
        let most = allowed.axis_degrees + allowed.sweep_degrees;
        let least = reported.axis_degrees.value;
        assert!((least..=most).contains(&axis), "{name}: {axis} degrees, {least} in the report");
        // Of an arm, corrections of its pose and retracts have none.
        let mut cuts = motions.iter().filter(|motion| motion.kind != MotionKind::Rapid);
        let is_told = cuts.all(|motion| motion.deviation.is_some());
        assert!(is_told || machine.arm.is_some(), "{name}: {motions:?}");
    }
}
