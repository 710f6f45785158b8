//! A record of each kind, where it makes sense. The compiler asks for a sample of a new one.

use geom::{Frame, Vec3};
use program::{
    ArcTo, Auxiliary, Axes, Beam, Circle, Clamp, CompensatedPath, Compensation, Coolant, Course,
    Cycle, CycleKind, Feed, FullPose, Input, JointMove, Kind, MachineMove, Op, Oriented, Output,
    OutputValue, PathMode, Pose, Probe, Program, Spindle, Surface, Thread, Tool, Until, WorkOffset,
    WorkOffsetData,
};

/// A record where it makes sense: what comes before it, and what has to follow.
pub struct Sample {
    pub before: Vec<Op>,
    pub op: Op,
    pub after: Vec<Op>,
}

pub fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, y, z)).unwrap()
}

/// A record of the kind. It stands in a cut at X0 Y0 Z-1, and the next cut goes to X10 Y5 Z-1.
pub fn sample(kind: Kind) -> Sample {
    let alone = |op| Sample { before: Vec::new(), op, after: Vec::new() };
    let cycle = || {
        Op::Cycle(Box::new(Cycle {
            kind: CycleKind::Drill,
            depth: 5.0,
            clearance: 2.0,
            retract: 6.0,
            feed: None,
            dwell: 0.0,
            first_peck: None,
            peck: None,
        }))
    };
    let up = || Op::Rapid(at(0.0, 0.0, 6.0));
    let down = || Op::Line(at(0.0, 0.0, -1.0));
    match kind {
        Kind::Rapid => Sample {
            before: vec![up()],
            op: Op::Rapid(at(30.0, 0.0, 6.0)),
            after: vec![up(), down()],
        },
        Kind::Line => alone(Op::Line(at(-10.0, 0.0, -1.0))),
        Kind::Arc => {
            let (end, center) = (at(-20.0, 0.0, -1.0), Vec3::new(-10.0, 0.0, -1.0));
            alone(Op::Arc(Box::new(ArcTo {
                end,
                circle: Circle::new(center, Vec3::Z, 0).unwrap(),
            })))
        }
        Kind::Thread => alone(Op::Thread(Box::new(Thread::new(at(0.0, 0.0, -8.0), 1.5).unwrap()))),
        Kind::Probe => {
            let (away, must_answer) = (false, true);
            let probe = Probe { end: at(0.0, 0.0, -9.0), away, must_answer, place: None };
            Sample { before: vec![up()], op: Op::Probe(Box::new(probe)), after: vec![up(), down()] }
        }
        Kind::Hole => Sample {
            before: vec![up(), cycle(), Op::Hole(at(0.0, 0.0, 0.0))],
            op: Op::Hole(at(20.0, 0.0, 0.0)),
            after: vec![Op::CycleOff, up(), down()],
        },
        Kind::Cycle => Sample {
            before: vec![up(), cycle(), Op::Hole(at(0.0, 0.0, 0.0))],
            op: {
                let Op::Cycle(cycle) = cycle() else { unreachable!() };
                Op::Cycle(Box::new(Cycle { depth: 9.0, ..*cycle }))
            },
            after: vec![Op::Hole(at(20.0, 0.0, 0.0)), Op::CycleOff, up(), down()],
        },
        Kind::CycleOff => Sample {
            before: vec![up(), cycle(), Op::Hole(at(0.0, 0.0, 0.0))],
            op: Op::CycleOff,
            after: vec![up(), down()],
        },
        Kind::Oriented => alone(Op::Oriented(Box::new(Oriented {
            end: FullPose::new(at(-10.0, 0.0, -1.0), Vec3::X).unwrap(),
            course: Course::Line,
            configuration: None,
            external: Vec::new(),
        }))),
        Kind::Joints => {
            let joints = JointMove { degrees: [0.0, -90.0, 90.0, 0.0, 0.0, 0.0], external: vec![] };
            alone(Op::Joints(Box::new(joints)))
        }
        Kind::MachineMove => {
            let to = MachineMove { linear: [None, None, Some(0.0)], ..MachineMove::default() };
            Sample {
                before: vec![up()],
                op: Op::MachineMove(Box::new(to)),
                after: vec![up(), down()],
            }
        }
        Kind::Home => Sample { before: vec![up()], op: Op::Home, after: vec![up(), down()] },
        Kind::Feed => alone(Op::Feed(Feed::PerMinute(150.0))),
        Kind::PathMode => alone(Op::PathMode(PathMode::Blend(0.005))),
        Kind::Spindle => alone(Op::Spindle(Spindle::Clockwise(700.0))),
        Kind::SurfaceSpeed => alone(Op::SurfaceSpeed(Some(100.0))),
        Kind::Coolant => alone(Op::Coolant(Coolant::Flood)),
        Kind::Beam => alone(Op::Beam(Beam::On(0.5))),
        Kind::Pulses => alone(Op::Pulses(1)),
        Kind::Tool => Sample {
            before: vec![up()],
            op: Op::Tool(Box::new(Tool { number: 2, ..Tool::default() })),
            after: vec![Op::Spindle(Spindle::Clockwise(1000.0)), up(), down()],
        },
        Kind::Preselect => alone(Op::Preselect(2)),
        Kind::Compensation => Sample {
            before: Vec::new(),
            op: Op::Compensation(Compensation::Left(None)),
            after: vec![
                Op::Line(at(0.0, 20.0, -1.0)),
                Op::Line(at(20.0, 20.0, -1.0)),
                Op::Compensation(Compensation::Off),
                Op::Line(at(20.0, 0.0, -1.0)),
            ],
        },
        Kind::Frame => Sample {
            before: vec![up()],
            op: Op::Frame(Box::new(Frame::IDENTITY)),
            after: vec![up(), down()],
        },
        Kind::WorkOffset => Sample {
            before: vec![up()],
            op: Op::WorkOffset(WorkOffset::numbered(55).unwrap()),
            after: vec![up(), down()],
        },
        Kind::Surface => {
            let (columns, rows) = (vec![0.0, 10.0], vec![0.0, 10.0]);
            let surface = Surface::new(columns, rows, [-0.5, 0.5], 3.0).unwrap();
            let places = [(0.0, 0.0), (10.0, 0.0), (0.0, 10.0), (10.0, 10.0)];
            let touched = (0..).zip(places).flat_map(|(place, (x, y))| {
                let (end, place) = (at(x, y, -0.5), Some(place));
                let probe = Probe { end, away: false, must_answer: true, place };
                let over = Op::Rapid(at(x, y, 6.0));
                [over.clone(), Op::Probe(Box::new(probe)), over]
            });
            Sample {
                before: [up()].into_iter().chain(touched).chain([up()]).collect(),
                op: Op::Surface(Box::new(surface)),
                after: vec![down()],
            }
        }
        Kind::WorkOffsetData => alone(Op::WorkOffsetData(Box::new(WorkOffsetData {
            offset: WorkOffset::FIRST,
            zero: [Some(100.0), Some(50.0), Some(-200.0), None, None, None],
        }))),
        Kind::Clamp => alone(Op::Clamp(Clamp { axes: Axes::A, closed: true })),
        Kind::Output => alone(Op::Output(Output {
            number: 3,
            value: OutputValue::Digital(true),
            with_motion: false,
        })),
        Kind::Input => {
            alone(Op::Input(Box::new(Input { number: 2, until: Until::High, timeout: 5.0 })))
        }
        Kind::Auxiliary => alone(Op::Auxiliary(Auxiliary::of(101))),
        Kind::ThreadWire => alone(Op::ThreadWire),
        Kind::CutWire => alone(Op::CutWire),
        Kind::Taper => alone(Op::Taper(2.0)),
        Kind::Dwell => alone(Op::Dwell(2.0)),
        // Out of the cut.
        Kind::Stop => Sample { before: vec![up()], op: Op::Stop, after: Vec::new() },
        Kind::OptionalStop => {
            Sample { before: vec![up()], op: Op::OptionalStop, after: Vec::new() }
        }
        Kind::Operation => alone(Op::Operation("SLOT".into())),
        Kind::EndOfOperation => alone(Op::EndOfOperation),
        Kind::Comment => alone(Op::Comment("here".into())),
        Kind::Message => alone(Op::Message("here".into())),
        Kind::End => Sample { before: vec![up()], op: Op::End, after: Vec::new() },
    }
}

/// A program of these records, a line of the source each.
pub fn lines(ops: impl IntoIterator<Item = Op>) -> Program {
    let compensated_path = Some(CompensatedPath::Contour);
    let mut program = Program { compensated_path, ..Program::new("SAMPLE") };
    for (line, op) in (1..).zip(ops) {
        program.push(line, op);
    }
    program
}
