//! The motions that a proof hands out: line, record, way, and where the axes stand.

use geom::Vec3;
use program::{
    Builder, Coolant, Cycle, CycleKind, Diagnostic, Feed, Op, Pose, Probe, Program, Spindle, Tool,
};
use toolpost_proof::{
    AxisPositions, MachineState, Motion, MotionKind, Observer, Report, SpindleState, Tolerances,
    prove_for,
};

/// The motions of a program that is proven.
fn motions(source: &Program, machine: &machine::Machine, text: &str) -> Vec<Motion> {
    let mut motions: Vec<Motion> = Vec::new();
    let tolerances = Tolerances::default();
    let report = prove_for(source, machine, "p.ngc", text.as_bytes(), &tolerances, &mut motions);
    assert!(report.proven, "{:#?}", report.mismatches);
    motions
}

/// Line, record, way (R, L or A), tip behind it.
type Row = (u32, usize, char, [f64; 3]);

fn row(motion: &Motion) -> Row {
    let way = match motion.kind {
        MotionKind::Rapid => 'R',
        MotionKind::Line => 'L',
        MotionKind::Arc(_) => 'A',
        MotionKind::Joints => 'J',
    };
    (motion.line, motion.record, way, motion.tool[1].tip.to_array())
}

/// NaN is alike to NaN.
fn alike(is: &Row, should: &Row) -> bool {
    let same = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-9 || a.is_nan() && b.is_nan();
    (is.0, is.1, is.2) == (should.0, should.1, should.2) && is.3.iter().zip(&should.3).all(same)
}

fn job(length: Option<f64>) -> Builder {
    let mut job = Builder::new("job");
    // Records 0, 1 and 2.
    job.tool(Tool { number: 1, length, ..Tool::default() }).unwrap();
    job.spindle(Spindle::Clockwise(5000.0)).unwrap();
    job.feed(Feed::PerMinute(300.0)).unwrap();
    job
}

const START: &str = "G21 G17 G40 G49 G80 G90 G91.1 G94 G54\nG64 P0.005 Q0.005\nG53 G0 Z0\nT1 M6\nS5000 M3\nG43 H1\n";
const END: &str = "M5\nG53 G0 Z0\nM2\n";

#[test]
fn each_block_names_the_record_that_it_makes_or_leads_to() {
    let mut source = job(None);
    source.rapid([0.0, 0.0, 5.0], None).unwrap();
    source.line([0.0, 0.0, -1.0], None).unwrap();
    source.arc([10.0, 0.0, -1.0], [5.0, 0.0, -1.0], [0.0, 0.0, 1.0], 0).unwrap();
    source.rapid([10.0, 0.0, 5.0], None).unwrap();
    // The way to record 3 takes two blocks; the arc is record 5.
    let text = format!("{START}G0 X0 Y0\nZ5\nG1 Z-1 F300\nG3 X10 Y0 I5 J0\nG0 Z5\n{END}");
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let found = motions(&source.build(), &machine, &text);
    let unknown = f64::NAN;
    let should: [Row; 7] = [
        (3, 3, 'R', [unknown; 3]),
        (7, 3, 'R', [0.0, 0.0, unknown]),
        (8, 3, 'R', [0.0, 0.0, 5.0]),
        (9, 4, 'L', [0.0, 0.0, -1.0]),
        (10, 5, 'A', [10.0, 0.0, -1.0]),
        (11, 6, 'R', [10.0, 0.0, 5.0]),
        // Behind the last record, which is the end of the program.
        (13, 8, 'R', [10.0, 0.0, unknown]),
    ];
    let rows: Vec<Row> = found.iter().map(row).collect();
    assert!(rows.len() == 7 && rows.iter().zip(&should).all(|(a, b)| alike(a, b)), "{rows:#?}");
    let MotionKind::Arc(arc) = &found[4].kind else { panic!("{:?}", found[4]) };
    assert!(arc.at(0.5).distance(Vec3::new(5.0, -5.0, -1.0)) < 1e-9, "{:?}", arc.at(0.5));
    // Each begins where the one before ends.
    for pair in found.windows(2) {
        let [end, start] = [pair[0].tool[1].tip, pair[1].tool[0].tip].map(|tip| tip.to_array());
        assert!(end.iter().zip(start).all(|(a, b)| *a == b || a.is_nan() && b.is_nan()));
    }
}

#[test]
fn a_canned_cycle_goes_across_down_and_by_its_pecks() {
    let mut source = job(Some(40.0));
    source.rapid([0.0, 0.0, 20.0], None).unwrap();
    let cycle = Cycle {
        kind: CycleKind::Deep,
        depth: 5.0,
        clearance: 2.0,
        retract: 20.0,
        feed: Some(Feed::PerMinute(100.0)),
        dwell: 0.0,
        first_peck: None,
        peck: Some(3.0),
    };
    source.drill(cycle, &[[10.0, 0.0, 0.0]], None).unwrap();
    let text = format!("{START}G0 X0 Y0\nZ20\nG98 G83 X10 Y0 Z-5 R2 Q3 F100\nG80\n{END}");
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let found = motions(&source.build(), &machine, &text);
    let heights: Vec<(u32, char, f64)> = found
        .iter()
        .filter(|motion| motion.line == 9)
        .map(|motion| {
            let (line, _, way, [x, y, z]) = row(motion);
            assert_eq!([x, y], [10.0, 0.0]);
            (line, way, z)
        })
        .collect();
    // LinuxCNC counts Q from the R plane: -1, -4, and the rest. A further peck begins 0.5 mm above the last depth (`REENTRY`).
    let should = [
        (9, 'R', 20.0),
        (9, 'R', 2.0),
        (9, 'L', -1.0),
        (9, 'R', 2.0),
        (9, 'R', -0.5),
        (9, 'L', -4.0),
        (9, 'R', 2.0),
        (9, 'R', -3.5),
        (9, 'L', -5.0),
        (9, 'R', 20.0),
    ];
    assert_eq!(heights, should);
    // To the gauge line, 40 mm above the tip.
    let bottom = found.iter().find(|motion| motion.tool[1].tip.z == -5.0).unwrap();
    let AxisPositions::Mill { linear, rotary } = bottom.axes else { panic!("{bottom:?}") };
    assert_eq!((linear, rotary), (Vec3::new(10.0, 0.0, 35.0), [0.0; 3]));
}

#[test]
fn without_optional_blocks_nothing_is_told_twice() {
    let mut source = job(None);
    source.rapid([0.0, 0.0, 5.0], None).unwrap();
    source.line([0.0, 0.0, -1.0], None).unwrap();
    source.rapid([0.0, 0.0, 5.0], None).unwrap();
    let text = format!("{START}G0 X0 Y0\nZ5\n/M9\nG1 Z-1 F300\nG0 Z5\n{END}");
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let found = motions(&source.build(), &machine, &text);
    assert_eq!(found.iter().filter(|motion| motion.kind == MotionKind::Line).count(), 1);
}

#[test]
fn what_is_refused_is_not_told() {
    let mut source = job(None);
    source.rapid([0.0, 0.0, 5.0], None).unwrap();
    source.line([0.0, 0.0, -1.0], None).unwrap();
    source.rapid([0.0, 0.0, 5.0], None).unwrap();
    let text = format!("{START}G0 X0 Y0\nZ5\nG1 X1 Z-1 F300\nG0 Z5\n{END}");
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let mut motions: Vec<Motion> = Vec::new();
    let tolerances = Tolerances::default();
    let source = source.build();
    let report = prove_for(&source, &machine, "p.ngc", text.as_bytes(), &tolerances, &mut motions);
    assert!(!report.proven);
    let last = motions.last().unwrap();
    assert_eq!((last.line, last.tool[1].tip), (8, Vec3::new(0.0, 0.0, 5.0)));
}

/// What a follower is told: motions, the first mismatch with the number of motions before it, and the end.
#[derive(Default)]
struct Told {
    motions: Vec<Motion>,
    /// Each with the number of motions before it.
    states: Vec<(usize, MachineState)>,
    mismatch: Option<(usize, &'static str, u32)>,
    mismatches: usize,
    ended: Option<bool>,
}

impl Observer for Told {
    fn wants_motions(&self) -> bool {
        true
    }

    fn moved(&mut self, motion: &Motion) {
        self.motions.push(motion.clone());
    }

    fn stated(&mut self, state: &MachineState) {
        self.states.push((self.motions.len(), state.clone()));
    }

    fn mismatched(&mut self, found: &Diagnostic) {
        self.mismatches += 1;
        self.mismatch = Some((self.motions.len(), found.rule.name(), found.line));
    }

    fn ended(&mut self, report: &Report) {
        assert_eq!(self.ended, None, "told once");
        self.ended = Some(report.proven);
    }
}

#[test]
fn the_first_mismatch_is_told_where_the_walk_comes_to_it() {
    let mut source = job(None);
    source.rapid([0.0, 0.0, 5.0], None).unwrap();
    source.line([0.0, 0.0, -1.0], None).unwrap();
    source.line([5.0, 0.0, -1.0], None).unwrap();
    source.rapid([5.0, 0.0, 5.0], None).unwrap();
    let source = source.build();
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let told = |cuts: &str, end: &str| {
        let text = format!("{START}G0 X0 Y0\nZ5\n{cuts}G0 Z5\n{end}");
        let (mut told, tolerances) = (Told::default(), Tolerances::default());
        prove_for(&source, &machine, "p.ngc", text.as_bytes(), &tolerances, &mut told);
        (told.motions.len(), told.mismatch, told.mismatches, told.ended)
    };
    assert_eq!(told("G1 Z-1 F300\nX5\n", END), (7, None, 0, Some(true)));
    // Home, across, down; the cut with the wrong feed is told, since the comparison goes on behind it, and then what is wrong.
    let wrong_feed = told("G1 Z-1 F200\nX5\n", END);
    assert_eq!(wrong_feed, (7, Some((4, "feed", 9)), 1, Some(false)));
    // The second cut has it too: one finding, which names both lines.
    let text = format!("{START}G0 X0 Y0\nZ5\nG1 Z-1 F200\nX5\nG0 Z5\n{END}");
    let tolerances = Tolerances::default();
    let report = prove_for(&source, &machine, "p", text.as_bytes(), &tolerances, &mut ());
    let [found] = &report.mismatches[..] else { panic!("{:?}", report.mismatches) };
    assert_eq!((found.line, found.count, &found.places[..]), (9, 2, &[10][..]));
    // A block beside the path ends it: the walk stops before it.
    assert_eq!(told("G1 Z-1 F300\nX4 Y1\n", END), (4, Some((4, "path", 10)), 1, Some(false)));
    // The control does not understand a block.
    assert_eq!(told("G1 Z-1 F300\nX5 ?\n", END), (4, Some((4, "syntax", 10)), 1, Some(false)));
    // What is missing is found behind the last motion.
    let unended = told("G1 Z-1 F300\nX5\n", "M5\nG53 G0 Z0\n");
    assert_eq!(unended, (7, Some((7, "no-end", 0)), 1, Some(false)));
}

#[test]
fn what_holds_is_told_where_it_changes() {
    let mut source = job(None);
    source.rapid([0.0, 0.0, 5.0], None).unwrap();
    source.line([0.0, 0.0, -1.0], None).unwrap();
    source.coolant(Coolant::Flood);
    source.line([5.0, 0.0, -1.0], None).unwrap();
    source.feed(Feed::PerMinute(400.0)).unwrap();
    source.line([9.0, 0.0, -1.0], None).unwrap();
    source.coolant(Coolant::Off);
    source.rapid([9.0, 0.0, 5.0], None).unwrap();
    let text = format!("{START}G0 X0 Y0\nZ5\nG1 Z-1 F300\nM8\nX5\nX9 F400\nM9\nG0 Z5\n{END}");
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let (mut told, tolerances) = (Told::default(), Tolerances::default());
    let source = source.build();
    let report = prove_for(&source, &machine, "p.ngc", text.as_bytes(), &tolerances, &mut told);
    assert!(report.proven, "{:?}", report.mismatches);
    let states: Vec<_> = told
        .states
        .iter()
        .map(|(at, state)| {
            let tool = state.tool.as_ref().map(|tool| tool.number);
            (*at, tool, state.spindle, state.length_offset, state.coolant)
        })
        .collect();
    let turns = SpindleState::Clockwise(5000.0);
    let should = [
        // Home; the first motion with the tool; the cut behind M8; up behind M9; home behind M5.
        (0, None, SpindleState::Off, None, Coolant::Off),
        (1, Some(1), turns, Some(1), Coolant::Off),
        (4, Some(1), turns, Some(1), Coolant::Flood),
        (6, Some(1), turns, Some(1), Coolant::Off),
        (7, Some(1), SpindleState::Off, Some(1), Coolant::Off),
    ];
    assert_eq!(states, should);
    let feeds: Vec<_> = told.motions.iter().map(|m| m.feed.map(Feed::value)).collect();
    let (none, slow, fast) = (None, Some(300.0), Some(400.0));
    assert_eq!(feeds, [none, none, none, slow, slow, fast, fast, fast]);
}

#[test]
fn each_motion_takes_what_the_axes_and_the_feed_need() {
    let mut source = job(None);
    source.rapid([0.0, 0.0, 105.0], None).unwrap();
    source.rapid([0.0, 0.0, 5.0], None).unwrap();
    source.line([0.0, 0.0, -1.0], None).unwrap();
    source.arc([10.0, 0.0, -1.0], [5.0, 0.0, -1.0], [0.0, 0.0, 1.0], 0).unwrap();
    source.dwell(1.5).unwrap();
    source.rapid([10.0, 0.0, 5.0], None).unwrap();
    let text =
        format!("{START}G0 X0 Y0\nZ105\nZ5\nG1 Z-1 F300\nG3 X10 Y0 I5 J0\nG4 P1.5\nG0 Z5\n{END}");
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let source = source.build();
    let found = motions(&source, &machine, &text);
    // Rapids at 10 m/min and 2 m/s²: 100 mm at 1000/6 mm/s and 1/12 s for starting and stopping; 6 mm, half of it at 2 m/s².
    let pi = std::f64::consts::PI;
    let short = 2.0 * (6.0_f64 / 2000.0).sqrt();
    let seconds = [0.0, 0.0, 0.0, 0.6 + 1.0 / 12.0, 1.2, pi, short, 0.0];
    // The tool change is before the first motion with the tool.
    let waited = [0.0, 6.0, 0.0, 0.0, 0.0, 0.0, 1.5, 0.0];
    assert_eq!(found.len(), seconds.len());
    for (motion, (seconds, waited)) in found.iter().zip(seconds.into_iter().zip(waited)) {
        let off = (motion.seconds - seconds).abs();
        assert!(off < 1e-9 && motion.waited == waited, "{seconds} {waited}: {motion:?}");
    }
    // The report has their sums, whoever follows.
    let report =
        prove_for(&source, &machine, "p", text.as_bytes(), &Tolerances::default(), &mut ());
    let times = report.program.time_s;
    assert!((times.cutting - (1.2 + pi)).abs() < 1e-9, "{times:?}");
    assert!((times.rapid - (0.6 + 1.0 / 12.0 + short)).abs() < 1e-9, "{times:?}");
    assert_eq!((times.dwell, times.tool_change), (1.5, 6.0));
}

/// What the motions of a program are off, mm and degrees, by its lines.
fn deviations(
    (source, machine): (&Program, &machine::Machine),
    text: &str,
    tolerances: &Tolerances,
) -> Vec<(u32, Option<[f64; 2]>)> {
    let mut motions: Vec<Motion> = Vec::new();
    let report = prove_for(source, machine, "p.ngc", text.as_bytes(), tolerances, &mut motions);
    assert!(report.proven, "{:#?}", report.mismatches);
    let found = motions.iter().map(|motion| {
        let off = motion.deviation.map(|off| [off.tip_mm, off.axis_degrees]);
        (motion.line, off)
    });
    found.collect()
}

fn assert_deviations(found: &[(u32, Option<[f64; 2]>)], should: &[(u32, Option<[f64; 2]>)]) {
    let near = |a: Option<[f64; 2]>, b: Option<[f64; 2]>| match (a, b) {
        (Some(a), Some(b)) => a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-8),
        (a, b) => a == b,
    };
    let alike = |(a, b): (&(u32, _), &(u32, _))| a.0 == b.0 && near(a.1, b.1);
    assert!(found.len() == should.len() && found.iter().zip(should).all(alike), "{found:#?}");
}

#[test]
fn each_motion_says_how_far_it_is_from_that_of_the_source() {
    let mut source = job(None);
    source.rapid([0.0, 0.0, 5.0], None).unwrap();
    source.line([0.0, 0.0, -1.0], None).unwrap();
    source.line([20.0, 0.0, -1.0], None).unwrap();
    source.arc([30.0, 0.0, -1.0], [25.0, 0.0, -1.0], [0.0, 0.0, 1.0], 0).unwrap();
    source.line([40.0, 0.0, -1.0], None).unwrap();
    source.rapid([40.0, 0.0, 5.0], None).unwrap();
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let source = (&source.build(), &machine);
    let tolerances = Tolerances { position: Some(0.01), ..Tolerances::default() };
    let off = |tip: f64| Some([tip, 0.0]);
    let found = |cuts: &str| {
        let text = format!("{START}G0 X0 Y0\nZ5\nG1 Z-1 F300\n{cuts}G0 Z5\n{END}");
        deviations(source, &text, &tolerances)
    };
    // The way to a record by several rapids, and home, are compared with nothing alone.
    let none = None;
    assert_deviations(
        &found("X10\nX20\nG3 X30 Y0 I5 J0\nG1 X40\n"),
        &[
            (3, none),
            (7, none),
            (8, off(0.0)),
            (9, off(0.0)),
            (10, off(0.0)),
            (11, off(0.0)),
            (12, off(0.0)),
            (13, off(0.0)),
            (14, off(0.0)),
            (16, none),
        ],
    );
    // A point on the line of the source is 0.004 mm beside it; the next cut comes back, and ends where it shall. The centre of the arc is 0.003 mm
    // aside: both ends are kept, so the radius is 5.0000009 mm, and the point opposite is 0.0029991 mm off. The last cut ends 0.003 mm
    // short and 0.004 mm aside, and the rapid above it stays aside.
    let arc = 0.003 - ((25.0_f64 + 9e-6).sqrt() - 5.0);
    assert_deviations(
        &found("X10 Y0.004\nX20 Y0\nG3 X30 Y0 I5 J0.003\nG1 X39.997 Y0.004\n"),
        &[
            (3, none),
            (7, none),
            (8, off(0.0)),
            (9, off(0.0)),
            (10, off(0.004)),
            (11, off(0.0)),
            (12, off(arc)),
            (13, off(0.005)),
            (14, off(0.005)),
            (16, none),
        ],
    );
}

#[test]
fn the_tool_axis_of_each_motion_says_how_far_it_is_off() {
    let mut source = job(Some(50.0));
    let at = |degrees: f64| Some([degrees.to_radians().sin(), 0.0, degrees.to_radians().cos()]);
    source.rapid([0.0, 0.0, 60.0], at(0.0)).unwrap();
    source.line([0.0, 0.0, 10.0], at(0.0)).unwrap();
    source.line([10.0, 0.0, 10.0], at(10.0)).unwrap();
    source.line([20.0, 0.0, 10.0], at(20.0)).unwrap();
    source.rapid([20.0, 0.0, 60.0], at(20.0)).unwrap();
    let (source, machine) = (source.build(), machine::load("fanuc-table-bc").unwrap());
    let text = |tilt: &str| {
        format!(
            "G21\nG0 G17 G40 G49 G69 G80 G90 G94 G54\nG91 G28 Z0\nG90\nT1 M6\nS5000 M3\nG0 B0. C0.\nG43.4 X0. Y0. Z60. H1\nG1 Z10. F300.\nX10. B{tilt}\n\
             X20. B20.\nG0 Z60.\nG91 G28 Z0\nG90\nG49\nM5\nG0 B0.\nM30\n"
        )
    };
    let tolerances = Tolerances { angle: Some(0.1), ..Tolerances::default() };
    let found = |tilt: &str| {
        let mut found = deviations((&source, &machine), &text(tilt), &tolerances);
        found.retain(|(line, _)| (8..13).contains(line));
        found
    };
    let off = |axis: f64| Some([0.0, axis]);
    let exact = [(8, off(0.0)), (9, off(0.0)), (10, off(0.0)), (11, off(0.0)), (12, off(0.0))];
    assert_deviations(&found("10."), &exact);
    // 0.05 degrees too far, the tip kept. The next cut comes back evenly: B turns by 9.95 degrees, which are looked at each 3 degrees or
    // less, so 0.04 degrees are left at a fifth of the way, the first of four places between the ends.
    let tilted = [(8, off(0.0)), (9, off(0.0)), (10, off(0.05)), (11, off(0.04)), (12, off(0.0))];
    assert_deviations(&found("10.05"), &tilted);
}

#[test]
fn a_hole_says_how_far_it_is_off() {
    let mut source = job(None);
    source.rapid([0.0, 0.0, 20.0], None).unwrap();
    let cycle = Cycle {
        kind: CycleKind::Drill,
        depth: 5.0,
        clearance: 2.0,
        retract: 20.0,
        feed: Some(Feed::PerMinute(100.0)),
        dwell: 0.0,
        first_peck: None,
        peck: None,
    };
    source.drill(cycle, &[[10.0, 0.0, 0.0]], None).unwrap();
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let source = (&source.build(), &machine);
    let tolerances = Tolerances { position: Some(0.01), ..Tolerances::default() };
    let found = |hole: &str| {
        let text = format!("{START}G0 X0 Y0\nZ20\n{hole}\n{END}");
        let mut found = deviations(source, &text, &tolerances);
        found.retain(|(line, _)| *line > 8);
        found.pop();
        found
    };
    // The bottom is 0.003 mm too deep and 0.004 mm aside; the cycle is one block.
    let most = Some([0.005, 0.0]);
    let cycle = found("G98 G81 X10 Y0.004 Z-5.003 R2 F100\nG80");
    assert_deviations(&cycle, &[(9, most), (9, most), (9, most), (9, most)]);
    // By moves: across, down to the R plane, the hole, and up.
    let aside = Some([0.004, 0.0]);
    let moves = found("G0 X10 Y0.004\nZ2\nG1 Z-5.003 F100\nG0 Z20");
    assert_deviations(&moves, &[(9, None), (10, aside), (11, most), (12, aside)]);
}

/// A tap of 1.25 mm at 400 turns a minute goes at 500 mm/min, whatever F was before: 12 mm down and up in 1.44 s each.
#[test]
fn a_thread_in_step_with_the_spindle_has_its_pitch_by_the_speed_as_feed() {
    let mut source = job(None);
    source.spindle(Spindle::Clockwise(400.0)).unwrap();
    source.rapid([0.0, 0.0, 20.0], None).unwrap();
    source.line([0.0, 0.0, 18.0], None).unwrap();
    source.rapid([0.0, 0.0, 20.0], None).unwrap();
    let cycle = Cycle {
        kind: CycleKind::Tap { pitch: 1.25, left: false },
        depth: 10.0,
        clearance: 2.0,
        retract: 2.0,
        feed: None,
        dwell: 0.0,
        first_peck: None,
        peck: None,
    };
    source.drill(cycle, &[[10.0, 0.0, 0.0]], None).unwrap();
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let start = START.replace("S5000", "S400");
    let text =
        format!("{start}G0 X0 Y0\nZ20\nG1 Z18 F300\nG0 Z20\nX10\nZ2\nG33.1 Z-10 K1.25\nG80\n{END}");
    let found = motions(&source.build(), &machine, &text);
    let cuts = found.iter().filter(|motion| motion.kind == MotionKind::Line);
    let cuts: Vec<_> = cuts.map(|cut| (cut.line, cut.feed.map(Feed::value), cut.seconds)).collect();
    let mut should = vec![(9, Some(300.0), 0.4)];
    should.extend([(13, Some(500.0), 1.44), (13, Some(500.0), 1.44)]);
    let near = |(a, b): (&(u32, _, f64), &(u32, _, f64))| {
        (a.0, a.1) == (b.0, b.1) && (a.2 - b.2).abs() < 1e-9
    };
    assert!(cuts.len() == 3 && cuts.iter().zip(&should).all(near), "{cuts:?}");
}

/// Where the probe touches nobody knows: 15 mm at 300 mm/min are 3 s at the most. The way back from there is not known.
#[test]
fn a_probing_move_takes_as_long_as_it_takes_to_its_end_at_the_most() {
    let mut source = Builder::new("probe");
    source.tool(Tool { number: 1, ..Tool::default() }).unwrap();
    source.feed(Feed::PerMinute(300.0)).unwrap();
    source.rapid([0.0, 0.0, 5.0], None).unwrap();
    let mut source = source.build();
    let at = |z: f64| Pose::upright(Vec3::new(0.0, 0.0, z)).unwrap();
    let probe = Probe { end: at(-10.0), away: false, must_answer: true, place: None };
    source.push(5, Op::Probe(Box::new(probe)));
    source.push(6, Op::Rapid(at(5.0)));
    let start = START.replace("S5000 M3\n", "");
    let text = format!("{start}G0 X0 Y0\nZ5\nG38.2 Z-10 F300\nG0 Z5\nG53 G0 Z0\nM2\n");
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let (mut found, tolerances) = (Vec::<Motion>::new(), Tolerances::default());
    let report = prove_for(&source, &machine, "p.ngc", text.as_bytes(), &tolerances, &mut found);
    assert!(report.proven, "{:#?}", report.mismatches);
    let at_line = |line: u32| found.iter().find(|motion| motion.line == line).unwrap();
    let probed = at_line(8);
    assert!((probed.seconds - 3.0).abs() < 1e-9, "{probed:?}");
    assert!((report.program.time_s.cutting - 3.0).abs() < 1e-9, "{:?}", report.program.time_s);
    assert!(probed.tool[1].tip.z.is_nan(), "{probed:?}");
    assert_eq!(at_line(9).seconds, 0.0);
}

/// A table that is turned by B brings the tip along the tool axis where Z of the machine goes home, and not along Z of the part: where it is
/// then nobody knows in X and Z. Y lies along the axis of B.
#[test]
fn home_of_z_moves_the_tip_along_the_tool_axis_where_the_control_keeps_the_tip() {
    let found = |degrees: f64| {
        let mut source = job(Some(50.0));
        let axis = Some([degrees.to_radians().sin(), 0.0, degrees.to_radians().cos()]);
        source.rapid([7.0, 3.0, 80.0], axis).unwrap();
        source.rapid([7.0, 3.0, 50.0], axis).unwrap();
        source.line([7.0, 3.0, 10.0], axis).unwrap();
        source.rapid([7.0, 3.0, 80.0], axis).unwrap();
        let (source, machine) = (source.build(), machine::load("fanuc-table-bc").unwrap());
        let text = format!(
            "G21\nG0 G17 G40 G49 G69 G80 G90 G94 G54\nG91 G28 Z0\nG90\nT1 M6\nS5000 M3\nG0 B{degrees:.1} C0.\nG43.4 X7. Y3. Z80. H1\nZ50.\nG1 Z10. F300.\n\
             G0 Z80.\nG91 G28 Z0\nG90\nG49\nM5\nG0 B0.\nM30\n"
        );
        let found = motions(&source, &machine, &text);
        let home = found.iter().find(|motion| motion.line == 12).unwrap();
        home.tool[1].tip.to_array().map(f64::is_nan)
    };
    assert_eq!((found(0.0), found(45.0)), ([false, false, true], [true, false, true]));
}
