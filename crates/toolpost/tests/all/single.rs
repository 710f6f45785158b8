//! Threads and probing moves: the block that each control has for one, worked out by hand, or the reason
//! why it has none.

use geom::Vec3;
use program::{Diagnostic, Feed, Op, Pose, Probe, Program, Spindle, Thread, Tool};
use std::process::{Command, Stdio};

fn at(x: f64, z: f64) -> Pose {
    Pose::upright(Vec3::new(x, 0.0, z)).unwrap()
}

fn program(ops: Vec<Op>) -> Program {
    let start = [
        Op::Tool(Box::new(Tool { number: 1, ..Tool::default() })),
        Op::Feed(Feed::PerMinute(100.0)),
    ];
    let end = [Op::Rapid(at(0.0, 50.0)), Op::End];
    let mut program = Program::new("single");
    for (line, op) in (1..).zip(start.into_iter().chain(ops).chain(end)) {
        program.push(line, op);
    }
    program
}

fn written(machine: &str, ops: Vec<Op>) -> Result<String, Box<Diagnostic>> {
    let machine = machine::load(machine).unwrap();
    let source = program(ops);
    let output = post::write(&source, &machine).map_err(|found| found[0].clone())?;
    let report = proof::prove(&source, &machine, "p", &output.text, &Default::default());
    assert!(report.proven, "{}: {:?}", machine.name, report.mismatches);
    Ok(String::from_utf8(output.text).unwrap())
}

fn refused(machine: &str, ops: Vec<Op>) -> &'static str {
    written(machine, ops).expect_err("a program").rule.name()
}

/// Two places probed downwards, each left upwards.
fn probing(away: bool, must_answer: bool) -> Vec<Op> {
    let probe = |x| {
        let end = at(x, -10.0);
        Op::Probe(Box::new(Probe { end, away, must_answer, place: None }))
    };
    let rapid = |x| Op::Rapid(at(x, 5.0));
    vec![rapid(0.0), probe(0.0), rapid(0.0), rapid(20.0), probe(20.0), rapid(20.0)]
}

/// A thread 15 mm deep of 1.5 mm pitch, and a cut after it.
fn threading(to: Pose) -> Vec<Op> {
    let thread = Thread::new(to, 1.5).unwrap();
    vec![
        Op::Spindle(Spindle::Clockwise(500.0)),
        Op::Rapid(at(0.0, 3.0)),
        Op::Thread(Box::new(thread)),
        Op::Rapid(at(30.0, 3.0)),
        Op::Line(at(30.0, 1.0)),
    ]
}

#[track_caller]
fn stands(text: &str, blocks: &str) {
    let unnumbered = |line: &str| match line.split_once(' ') {
        Some((number, rest)) if number.starts_with('N') => rest.to_string(),
        _ => line.to_string(),
    };
    let text = text.lines().map(unnumbered).collect::<Vec<_>>().join("\n");
    assert!(text.contains(blocks), "{blocks}\nis not in\n{text}");
}

/// LinuxCNC's manual, "G38.n Straight Probe"; GRBL 1.1 has the same four words.
#[test]
fn linuxcnc_and_grbl_have_all_probing_moves() {
    for machine in ["generic-3axis-linuxcnc", "generic-3axis-grbl"] {
        for (away, must_answer, word) in [
            (false, true, "G38.2"),
            (false, false, "G38.3"),
            (true, true, "G38.4"),
            (true, false, "G38.5"),
        ] {
            let text = written(machine, probing(away, must_answer)).unwrap();
            // Where Z is then nobody knows; X and Y have stayed.
            stands(&text, &format!("{word} Z-10 F100\nG0 Z5\nX20\n{word} Z-10\nG0 Z5\n"));
        }
    }
}

/// B-63944EN-1, 3.4, and Haas's "G31 Feed Until Skip": one block, and the program goes on where the
/// signal has not come.
#[test]
fn g31_goes_on_where_nothing_is_touched() {
    for (machine, point) in
        [("generic-3axis-fanuc", "."), ("generic-3axis-haas", "."), ("generic-3axis-mach3", "")]
    {
        let text = written(machine, probing(false, false)).unwrap();
        let blocks =
            format!("G31 Z-10{point} F100{point}\nG0 Z5{point}\nX20{point}\nG31 Z-10{point}\n");
        stands(&text, &blocks);
        let found = written(machine, probing(false, true)).expect_err("a program");
        assert_eq!(found.message, "the control goes on where its probe has touched nothing");
        assert_eq!(refused(machine, probing(true, false)), "probe");
    }
}

#[test]
fn other_controls_have_no_probing_move() {
    for machine in ["marlin", "sinumerik", "sinumerik-828d", "heidenhain", "iso"] {
        let machine = format!("generic-3axis-{machine}");
        assert_eq!(refused(&machine, probing(false, false)), "missing-block", "{machine}");
    }
}

#[test]
fn only_a_rapid_leads_from_where_a_probe_has_answered() {
    let probe = || probing(false, true)[..2].to_vec();
    let machine = "generic-3axis-linuxcnc";
    let then =
        |op| refused(machine, [probe(), vec![Op::Spindle(Spindle::Clockwise(9.0)), op]].concat());
    assert_eq!(then(Op::Line(at(5.0, -10.0))), "probe");
    assert_eq!(then(Op::Thread(Box::new(Thread::new(at(0.0, -12.0), 1.0).unwrap()))), "probe");
    assert_eq!(then(probe()[1].clone()), "probe");
    let feed = [vec![Op::Feed(Feed::InverseTime(2.0))], probing(false, true)].concat();
    assert_eq!(refused(machine, feed), "probe");
    let nowhere = Op::Probe(Box::new(Probe {
        end: at(0.0, 5.0),
        away: false,
        must_answer: true,
        place: None,
    }));
    assert_eq!(refused(machine, vec![Op::Rapid(at(0.0, 5.0)), nowhere]), "probe");
    assert_eq!(refused(machine, probe()[1..].to_vec()), "single-block");
}

/// LinuxCNC's "G33" counts K along the way; FANUC's (B-64484EN-2) F and SINUMERIK's K along Z, and F is
/// the feed again behind it.
#[test]
fn threads() {
    let down = || threading(at(0.0, -12.0));
    let text = written("generic-3axis-linuxcnc", down()).unwrap();
    stands(&text, "G33 Z-12 K1.5\nG0 X30 Z3\nG1 Z1 F100");
    let text = written("generic-3axis-linuxcnc", threading(at(20.0, 3.0))).unwrap();
    stands(&text, "G33 X20 K1.5\n");
    let text = written("generic-3axis-fanuc", down()).unwrap();
    // Its rapids are not straight: up first, then across.
    stands(&text, "G33 Z-12. F1.5\nG0 Z3.\nX30.\nG1 Z1. F100.");
    let text = written("generic-3axis-sinumerik", down()).unwrap();
    // The thread is none of the cuts that the control may smooth.
    stands(&text, "G33 Z-12 K1.5\nG0 X30 Z3\nCYCLE832(0.01,_FINISH,1)\nG1 Z1 F100");
    for machine in ["generic-3axis-fanuc", "generic-3axis-sinumerik"] {
        assert_eq!(refused(machine, threading(at(20.0, 3.0))), "thread");
    }
    for machine in ["haas", "mach3", "grbl", "marlin", "heidenhain", "iso"] {
        let machine = format!("generic-3axis-{machine}");
        assert_eq!(refused(&machine, down()), "missing-block", "{machine}");
    }
}

#[test]
fn a_thread_needs_a_pitch_and_a_spindle_that_turns() {
    for pitch in [0.0, -1.5, f64::NAN, f64::INFINITY] {
        let refused = Thread::new(at(0.0, -12.0), pitch).map_err(|found| found.rule.name());
        assert_eq!(refused, Err("thread"), "{pitch}");
    }
    // Finer than the program can say.
    let mut ops = threading(at(0.0, -12.0));
    ops[2] = Op::Thread(Box::new(Thread::new(at(0.0, -12.0), 1e-6).unwrap()));
    assert_eq!(refused("generic-3axis-linuxcnc", ops), "thread");
    let still = threading(at(0.0, -12.0)).split_off(1);
    assert_eq!(refused("generic-3axis-linuxcnc", still), "spindle-off");
}

/// What another moves or says is reported.
#[test]
fn another_thread_or_probing_move_is_not_proven() {
    let rule = |ops: Vec<Op>, from: &str, to: &str| {
        let machine = machine::load("generic-3axis-linuxcnc").unwrap();
        let source = program(ops);
        let text = String::from_utf8(post::write(&source, &machine).unwrap().text).unwrap();
        assert!(text.contains(from), "{text}");
        let text = text.replacen(from, to, 1);
        let report = proof::prove(&source, &machine, "p", text.as_bytes(), &Default::default());
        report.mismatches.first().map(|found| found.rule.name())
    };
    let probes = |from: &str, to: &str| rule(probing(false, true), from, to);
    assert_eq!(probes("G38.2", "G38.2"), None);
    assert_eq!(probes("G38.2", "G38.3"), Some("single-block"));
    assert_eq!(probes("G38.2", "G38.4"), Some("single-block"));
    assert_eq!(probes("G38.2", "G1"), Some("single-block"));
    assert_eq!(probes("G38.2 Z-10", "G38.2 Z-11"), Some("path"));
    assert_eq!(probes("Z-10 F100", "Z-10 F200"), Some("feed"));
    assert_eq!(probes("G38.2 Z-10 F100\n", "F100\n"), Some("single-block"));
    let threads = |from: &str, to: &str| rule(threading(at(0.0, -12.0)), from, to);
    assert_eq!(threads("K1.5", "K1.5"), None);
    assert_eq!(threads("K1.5", "K1.51"), Some("single-block"));
    assert_eq!(threads("Z-12", "Z-13"), Some("path"));
    assert_eq!(threads("G33 Z-12 K1.5", "G1 Z-12 F750"), Some("single-block"));
    assert_eq!(threads("S500", "S600"), Some("spindle"));
    assert_eq!(threads("G0 X30 Z3\nG1", "G1 X30 Z3 F100\nG1"), Some("rapid-feed"));
}

#[test]
fn linuxcnc_itself_probes_and_cuts_the_thread() {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("t.tbl"), "T1 P1 D0 Z0\n").unwrap();
    let said = |ops| {
        let text = written("generic-3axis-linuxcnc", ops).unwrap();
        std::fs::write(folder.path().join("p.ngc"), text).unwrap();
        let run = Command::new("rs274")
            .args(["-t", "t.tbl", "-g", "p.ngc"])
            .current_dir(folder.path())
            .env("HOME", folder.path())
            .stdin(Stdio::null())
            .output()
            .unwrap();
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        String::from_utf8_lossy(&run.stdout).into_owned()
    };
    let probes = said(probing(false, true));
    let probe = |x: &str| probes.contains(&format!("STRAIGHT_PROBE({x}.0000, 0.0000, -10.0000"));
    assert!(probe("0") && probe("20"), "{probes}");
    let thread = said(threading(at(0.0, -12.0)));
    assert!(thread.contains("START_SPEED_FEED_SYNC(1.500000,0)"), "{thread}");
}
