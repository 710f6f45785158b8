//! Programs that find the surface themselves: written, proven, and what goes wrong.

use geom::{Vec2, Vec3};
use program::{ArcTo, Feed, Op, Pose, Program, Spindle, Tool};
use toolpost_levelling::{Allowed, Grid, Probing, follow};

const ALLOWED: Allowed = Allowed { deviation: 0.005, outside: 5.0 };
const PROBING: Probing = Probing { travel: 1.0, depth: 1.0, feed: 50.0 };

fn pose(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(Vec3::new(x, y, z), Vec3::Z)
}

fn grid(columns: usize, rows: usize) -> Grid {
    Grid::new(Vec2::ZERO, Vec2::new(40.0, 20.0), columns, rows).unwrap()
}

/// A tool, a way down at (10, 5), and these cuts.
fn board(cuts: Vec<Op>) -> Program {
    let mut program = Program::new("board");
    let mut push = |op| program.push(0, op);
    push(Op::Tool(Box::new(Tool { number: 1, ..Tool::default() })));
    push(Op::Spindle(Spindle::Clockwise(9000.0)));
    push(Op::Rapid(pose(10.0, 5.0, 2.0)));
    push(Op::Rapid(pose(10.0, 5.0, 0.5)));
    push(Op::Feed(Feed::PerMinute(60.0)));
    push(Op::Line(pose(10.0, 5.0, -0.1)));
    cuts.into_iter().for_each(&mut push);
    push(Op::Rapid(pose(10.0, 15.0, 2.0)));
    push(Op::Spindle(Spindle::Off));
    push(Op::End);
    program
}

fn text(program: &Program) -> String {
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    String::from_utf8(post::write(program, &machine).unwrap().text).unwrap()
}

#[test]
fn first() {
    let arc = ArcTo {
        end: pose(30.0, 5.0, -0.1),
        center: Vec3::new(20.0, 5.0, -0.1),
        normal: Vec3::NEG_Z,
        turns: 0,
    };
    let flat = board(vec![
        Op::Arc(Box::new(arc)),
        Op::Line(pose(30.0, 15.0, -0.1)),
        Op::Line(pose(10.0, 15.0, -0.1)),
    ]);
    let program = follow(&flat, &grid(3, 3), &PROBING, 0.02, &ALLOWED).unwrap();
    let text = text(&program);
    println!("{text}");
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let proof = proof::prove(&program, &machine, "board", text.as_bytes(), &Default::default());
    println!("{proof:#?}");
    assert!(proof.proven);
}
