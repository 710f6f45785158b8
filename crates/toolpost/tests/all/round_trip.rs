//! Random programs through every mill of the library: written, read back, and the same again.

use control::Setup;
use geom::Vec3;
use machine::Machine;
use machine::library::{MACHINES, names};
use program::{
    ArcTo, Circle, Coolant, Cycle, CycleKind, Feed, Op, Pose, Probe, Program, Spindle, Thread,
    Tool, WorkOffset,
};
use proptest::prelude::*;

/// A piece of a program.
#[derive(Clone, Debug)]
enum Piece {
    Rapid(Vec3),
    Line(Vec3),
    /// Centre and start angle are taken from where the tool is: sweep in degrees, rise in mm.
    Arc {
        radius: f64,
        toward: f64,
        sweep: f64,
        rise: f64,
        clockwise: bool,
    },
    Holes(CycleKind, f64, f64, Vec<(f64, f64)>),
    /// Tapped the way the spindle turns.
    Tap(Vec<(f64, f64)>),
    /// Down from above, and up again.
    Thread,
    Probe {
        away: bool,
        must_answer: bool,
    },
    Feed(f64),
    Speed(f64, bool),
    Coolant(bool),
    Tool(u32),
    Dwell(f64),
    WorkOffset(u32),
    Home,
    Stop,
}

/// A coordinate in whole hundredths, so that every control writes it exactly.
fn coordinate(most: i32) -> impl Strategy<Value = f64> {
    (-most * 100..most * 100).prop_map(|n| f64::from(n) / 100.0)
}

fn point() -> impl Strategy<Value = Vec3> {
    (coordinate(60), coordinate(60), -1000..1000i32)
        .prop_map(|(x, y, z)| Vec3::new(x, y, f64::from(z) / 100.0))
}

fn piece() -> impl Strategy<Value = Piece> {
    let kind = prop_oneof![
        Just(CycleKind::Drill),
        Just(CycleKind::Deep),
        Just(CycleKind::BreakChip),
        Just(CycleKind::Ream),
        Just(CycleKind::Bore),
    ];
    let dwell = prop_oneof![Just(0.0), Just(0.5)];
    let holes = || prop::collection::vec((coordinate(60), coordinate(60)), 1..4);
    prop_oneof![
        2 => point().prop_map(Piece::Rapid),
        6 => point().prop_map(Piece::Line),
        4 => (2.0..30.0f64, 0.0..360.0f64, 5.0..359.5f64, prop_oneof![Just(0.0), -3.0..3.0f64], any::<bool>())
            .prop_map(|(radius, toward, sweep, rise, clockwise)| Piece::Arc { radius, toward, sweep, rise, clockwise }),
        1 => (kind, 1..1000u32, dwell, holes())
            .prop_map(|(kind, d, dwell, holes)| Piece::Holes(kind, f64::from(d) / 100.0, dwell, holes)),
        1 => holes().prop_map(Piece::Tap),
        1 => Just(Piece::Thread),
        1 => (any::<bool>(), any::<bool>())
            .prop_map(|(away, must_answer)| Piece::Probe { away, must_answer }),
        1 => (20..3000u32).prop_map(|f| Piece::Feed(f64::from(f))),
        1 => (200..4000u32, any::<bool>()).prop_map(|(s, cw)| Piece::Speed(f64::from(s), cw)),
        1 => any::<bool>().prop_map(Piece::Coolant),
        1 => (1..10u32).prop_map(Piece::Tool),
        1 => (1..50u32).prop_map(|d| Piece::Dwell(f64::from(d) / 10.0)),
        1 => (54..60u32).prop_map(Piece::WorkOffset),
        1 => Just(Piece::Home),
        1 => Just(Piece::Stop),
    ]
}

fn cycle(kind: CycleKind, depth: f64, dwell: f64) -> Cycle {
    let peck = matches!(kind, CycleKind::Deep | CycleKind::BreakChip)
        .then_some((depth / 3.0 * 1000.0).round() / 1000.0 + 0.001);
    Cycle {
        kind,
        depth,
        clearance: 2.0,
        retract: 20.0,
        feed: Some(Feed::PerMinute(120.0)),
        dwell,
        first_peck: peck,
        peck,
    }
}

/// Whether the machine's control has what the piece asks for, by the tables of its manual's words in
/// docs/controls/holes.md and docs/controls/single.md.
fn has(machine: &Machine, piece: &Piece) -> bool {
    let is =
        |names: &[&str]| names.iter().any(|name| machine.name == format!("generic-3axis-{name}"));
    match piece {
        Piece::Tap(_) => !is(&["grbl", "marlin", "iso", "mach3"]),
        Piece::Thread => is(&["linuxcnc", "fanuc", "sinumerik", "sinumerik-828d"]),
        Piece::Probe { away: false, must_answer: false } => {
            is(&["linuxcnc", "grbl", "fanuc", "haas", "mach3"])
        }
        Piece::Probe { .. } => is(&["linuxcnc", "grbl"]),
        _ => true,
    }
}

/// The program of the pieces: legal wherever they meet.
fn assemble(pieces: &[Piece]) -> Program {
    let mut program = Program::new("random");
    let mut line = 0;
    let mut push = |op: Op| {
        line += 1;
        program.push(line, op);
    };
    let pose = |p: Vec3| Pose::upright(p).unwrap();
    let tool = |number| Op::Tool(Box::new(Tool { number, ..Tool::default() }));
    let top = |p: Vec3| Vec3::new(p.x, p.y, 20.0);
    let (mut here, mut left) = (Vec3::new(0.0, 0.0, 20.0), false);
    push(tool(1));
    push(Op::Spindle(Spindle::Clockwise(1000.0)));
    push(Op::Feed(Feed::PerMinute(300.0)));
    push(Op::Rapid(pose(here)));
    for piece in pieces {
        match piece {
            Piece::Rapid(to) => {
                here = *to;
                push(Op::Rapid(pose(here)));
            }
            Piece::Line(to) => {
                here = *to;
                push(Op::Line(pose(here)));
            }
            Piece::Arc { radius, toward, sweep, rise, clockwise } => {
                let sense = if *clockwise { -1.0 } else { 1.0 };
                let toward = toward.to_radians();
                let center = here + Vec3::new(toward.cos(), toward.sin(), 0.0) * *radius;
                let end = center
                    + geom::rotate(here - center, Vec3::Z, sense * sweep.to_radians())
                    + Vec3::Z * *rise;
                here = end;
                let normal = Vec3::Z * sense;
                push(Op::Arc(Box::new(ArcTo {
                    end: pose(end),
                    circle: Circle::new(center, normal, 0).unwrap(),
                })));
            }
            Piece::Thread | Piece::Probe { .. } => {
                here = top(here);
                push(Op::Rapid(pose(here)));
                let end = pose(here.with_z(5.0));
                push(match *piece {
                    Piece::Probe { away, must_answer } => {
                        Op::Probe(Box::new(Probe { end, away, must_answer, place: None }))
                    }
                    _ => Op::Thread(Box::new(Thread::new(end, 1.25).unwrap())),
                });
                push(Op::Rapid(pose(here)));
            }
            Piece::Tap(holes) => {
                push(Op::Rapid(pose(top(here))));
                let kind = CycleKind::Tap { pitch: 1.25, left };
                let of = |kind| Cycle { kind, ..cycle(CycleKind::Drill, 5.0, 0.0) };
                push(Op::Cycle(Box::new(of(kind))));
                for (x, y) in holes {
                    here = Vec3::new(*x, *y, 20.0);
                    push(Op::Hole(pose(here.with_z(0.0))));
                }
                push(Op::CycleOff);
            }
            Piece::Holes(kind, depth, dwell, holes) => {
                push(Op::Rapid(pose(top(here))));
                push(Op::Cycle(Box::new(cycle(*kind, *depth, *dwell))));
                for (x, y) in holes {
                    here = Vec3::new(*x, *y, 20.0);
                    push(Op::Hole(pose(here.with_z(0.0))));
                }
                push(Op::CycleOff);
            }
            Piece::Feed(feed) => push(Op::Feed(Feed::PerMinute(*feed))),
            Piece::Speed(speed, clockwise) => {
                left = !clockwise;
                let turn = if left { Spindle::CounterClockwise } else { Spindle::Clockwise };
                push(Op::Spindle(turn(*speed)));
            }
            Piece::Coolant(on) => {
                push(Op::Coolant(if *on { Coolant::Flood } else { Coolant::Off }))
            }
            Piece::Tool(number) => {
                push(Op::Rapid(pose(top(here))));
                push(tool(*number));
                push(Op::Spindle(Spindle::Clockwise(1200.0)));
                left = false;
                here = top(here);
                push(Op::Rapid(pose(here)));
            }
            Piece::Dwell(seconds) => push(Op::Dwell(*seconds)),
            Piece::WorkOffset(number) => {
                push(Op::WorkOffset(WorkOffset::numbered(*number).unwrap()));
                here = top(here);
                push(Op::Rapid(pose(here)));
            }
            Piece::Home => {
                push(Op::Home);
                here = top(here);
                push(Op::Rapid(pose(here)));
            }
            Piece::Stop => {
                here = top(here);
                push(Op::Rapid(pose(here)));
                push(Op::Stop);
            }
        }
    }
    push(Op::Rapid(pose(top(here))));
    push(Op::End);
    program
}

/// What a program does where it cuts, in the order in which it happens.
#[derive(Clone, Debug, PartialEq)]
struct Cut {
    bottom: Vec3,
    arc: Option<(Vec3, f64)>,
    feed: Option<Feed>,
    spindle: Spindle,
    coolant: Coolant,
    tool: u32,
    work_offset: u32,
}

fn cuts(program: &Program) -> Vec<Cut> {
    let mut now = Cut {
        bottom: Vec3::NAN,
        arc: None,
        feed: None,
        spindle: Spindle::Off,
        coolant: Coolant::Off,
        tool: 0,
        work_offset: 54,
    };
    let (mut cycle, mut all) = (None, Vec::new());
    for record in &program.records {
        match &record.op {
            Op::Line(pose) => all.push(Cut { bottom: pose.point(), ..now.clone() }),
            Op::Thread(thread) => {
                all.push(Cut { bottom: thread.end.point(), feed: None, ..now.clone() });
            }
            Op::Probe(probe) => all.push(Cut { bottom: probe.end.point(), ..now.clone() }),
            Op::Arc(to) => {
                let arc = Some((to.circle.center(), to.circle.normal().z));
                all.push(Cut { bottom: to.end.point(), arc, ..now.clone() });
            }
            Op::Cycle(with) => cycle = Some(**with),
            Op::Hole(pose) => {
                let cycle: Cycle = cycle.unwrap();
                // The pitch of a tap is its feed, which the proof compares.
                let tap = matches!(cycle.kind, CycleKind::Tap { .. });
                let feed = cycle.feed.or(now.feed).filter(|_| !tap);
                let bottom = pose.point() - Vec3::Z * cycle.depth;
                all.push(Cut { bottom, feed, ..now.clone() });
            }
            Op::Feed(feed) => now.feed = Some(*feed),
            Op::Spindle(spindle) => now.spindle = *spindle,
            Op::Coolant(coolant) => now.coolant = *coolant,
            Op::Tool(tool) => now.tool = tool.number,
            Op::WorkOffset(offset) => now.work_offset = offset.number(),
            _ => {}
        }
    }
    all
}

/// The mills without limits of their own, which are no matter of reading. What a control has no cycle
/// for is written as the moves of one: their ends are there too.
fn mills() -> Vec<Machine> {
    let generic = names(MACHINES).filter(|name| name.starts_with("generic"));
    generic.map(|name| machine::load(name).unwrap()).collect()
}

/// Writes the program of `pieces` for every mill, but for what its control has not, proves it, and reads it
/// back. What it has not is refused.
fn comes_back(pieces: &[Piece]) -> Result<(), TestCaseError> {
    for machine in mills() {
        if !pieces.iter().all(|piece| has(&machine, piece)) {
            prop_assert!(post::write(&assemble(pieces), &machine).is_err(), "{}", machine.name);
        }
        let pieces: Vec<Piece> =
            pieces.iter().filter(|piece| has(&machine, piece)).cloned().collect();
        let source = assemble(&pieces);
        let expected = cuts(&source);
        let output = post::write(&source, &machine)
            .map_err(|found| TestCaseError::fail(format!("{}: {found:?}", machine.name)))?;
        let report = proof::prove(&source, &machine, "p", &output.text, &Default::default());
        prop_assert!(report.proven, "{}: {:?}", machine.name, report.mismatches);
        let read = nc::read(&machine, Setup::default(), "p", &output.text)
            .map_err(|found| TestCaseError::fail(format!("{}: {found}", machine.name)))?;
        let read = cuts(&read.program);
        // Moves shorter than a step are left out, arcs may be cut in two: the ends that remain
        // are the same, in their order, under the same conditions.
        let mut rest = read.iter();
        for cut in &expected {
            let same = |other: &&Cut| {
                other.bottom.distance(cut.bottom) < 0.002
                    && other.feed == cut.feed
                    && other.spindle == cut.spindle
                    && other.coolant == cut.coolant
                    && other.tool == cut.tool
                    && other.work_offset == cut.work_offset
                    && match (other.arc, cut.arc) {
                        (Some((a, m)), Some((b, n))) => a.distance(b) < 0.01 && m == n,
                        (None, None) => true,
                        _ => false,
                    }
            };
            prop_assert!(
                rest.any(|c| same(&c)),
                "{}: {cut:?} is missing in {read:?}",
                machine.name
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read_as_the_same(pieces in prop::collection::vec(piece(), 1..24)) {
        comes_back(&pieces)?;
    }
}

/// Half a step of rounding at ends so near each other moves the centre by more than a step, and the far
/// side of the arc by twice that.
#[test]
fn an_arc_that_ends_near_its_start_comes_back() {
    let arc =
        |radius, toward, sweep| Piece::Arc { radius, toward, sweep, rise: 0.0, clockwise: true };
    let here = Piece::Rapid(Vec3::new(0.0, 0.0, 5.0));
    let arcs = [arc(6.8007461215226, 71.60819569439474, 326.7677765621332), arc(29.0, 10.0, 359.9)];
    for arc in arcs {
        comes_back(&[here.clone(), arc]).unwrap();
    }
}
