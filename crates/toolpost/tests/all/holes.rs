//! Every hole cycle on every control: the blocks that its manual asks for, worked out by hand, and the
//! motion that they make.
//!
//! One hole at X10 Y5, drilled from Z3 to Z-12 with 120 mm/min; before it and behind it the tool is at
//! Z20. So the reference plane is 3, the depth 15, and 17 mm are left to the retract level. Pecks are 4 mm.

use control::Setup;
use geom::Vec3;
use machine::Machine;
use program::{Cycle, CycleKind, Feed, Op, Pose, Program, Spindle, Tool};
use std::process::{Command, Stdio};

const DRILL: CycleKind = CycleKind::Drill;
const DEEP: CycleKind = CycleKind::Deep;
const BREAK_CHIP: CycleKind = CycleKind::BreakChip;
const TAP: CycleKind = CycleKind::Tap { pitch: 1.25, left: false };
const LEFT_TAP: CycleKind = CycleKind::Tap { pitch: 1.25, left: true };
const REAM: CycleKind = CycleKind::Ream;
const BORE: CycleKind = CycleKind::Bore;

fn cycle(kind: CycleKind, dwell: f64) -> Cycle {
    let peck = matches!(kind, DEEP | BREAK_CHIP).then_some(4.0);
    Cycle {
        kind,
        depth: 15.0,
        clearance: 0.0,
        retract: 17.0,
        feed: Some(Feed::PerMinute(120.0)),
        dwell,
        first_peck: peck,
        peck,
    }
}

fn source(cycle: Cycle) -> Program {
    let at = |z| Pose::upright(Vec3::new(10.0, 5.0, z)).unwrap();
    let left = matches!(cycle.kind, CycleKind::Tap { left: true, .. });
    let turn = if left { Spindle::CounterClockwise } else { Spindle::Clockwise };
    let mut program = Program::new("holes");
    let ops = [
        Op::Tool(Box::new(Tool { number: 1, ..Tool::default() })),
        Op::Spindle(turn(1000.0)),
        Op::Feed(Feed::PerMinute(300.0)),
        Op::Rapid(at(20.0)),
        Op::Cycle(Box::new(cycle)),
        Op::Hole(at(3.0)),
        Op::CycleOff,
        Op::Rapid(at(50.0)),
        Op::End,
    ];
    for (line, op) in (1..).zip(ops) {
        program.push(line, op);
    }
    program
}

/// The proven program of one hole, without its block numbers.
fn posted(machine: &str, cycle: Cycle) -> Result<Vec<String>, &'static str> {
    posted_for(&machine::load(machine).unwrap(), cycle)
}

fn posted_for(machine: &Machine, cycle: Cycle) -> Result<Vec<String>, &'static str> {
    let source = source(cycle);
    let output = post::write(&source, machine).map_err(|found| found[0].rule.name())?;
    let report = proof::prove(&source, machine, "p", &output.text, &Default::default());
    assert!(report.proven, "{}: {:?}", machine.name, report.mismatches);
    let numbered = |line: &str| match line.split_once(' ') {
        Some((number, rest)) if number.trim_start_matches('N').parse::<u32>().is_ok() => {
            rest.to_string()
        }
        _ => line.trim_start().to_string(),
    };
    Ok(String::from_utf8(output.text).unwrap().lines().map(numbered).collect())
}

#[track_caller]
fn stands(machine: &str, kind: CycleKind, dwell: f64, row: &[&str]) {
    stand(&machine::load(machine).unwrap(), kind, dwell, row);
}

#[track_caller]
fn stand(machine: &Machine, kind: CycleKind, dwell: f64, row: &[&str]) {
    let blocks = posted_for(machine, cycle(kind, dwell)).unwrap();
    let found = blocks.windows(row.len()).any(|blocks| blocks == row);
    assert!(found, "{kind:?}: {row:#?} is not in\n{}", blocks.join("\n"));
}

/// Two holes of one cycle, whose tool axes differ, in an operation that also turns the tool in a cut: between them the
/// tool turns, beyond all cuts or from home, and stops at no corner that is on neither way.
#[test]
fn the_tool_turns_between_two_holes_of_one_cycle() {
    let pose = |x: f64, y: f64, z: f64, lean: [f64; 2]| {
        let axis = Vec3::new(lean[0], lean[1], 1.0).normalize();
        Pose::new(Vec3::new(x, y, z), axis).unwrap()
    };
    let reaming = Cycle { clearance: 3.0, depth: 7.0, ..cycle(REAM, 0.0) };
    for machine in [
        "fanuc-table-bc",
        "dmu50-heidenhain",
        "linuxcnc-xyzac",
        "linuxcnc-xyzbc-head",
        "sinumerik-840d-table-ac",
        "sinumerik-840d-traori",
    ] {
        let machine = machine::load(machine).unwrap();
        // One retract level from which the tool reaches the next hole beyond all cuts, and one from which it does not.
        for retract in [40.0, 5.0] {
            let mut source = Program::new("holes");
            let ops = [
                Op::Tool(Box::new(Tool { number: 1, length: Some(140.0), ..Tool::default() })),
                Op::Spindle(Spindle::Clockwise(1000.0)),
                Op::Feed(Feed::PerMinute(300.0)),
                Op::Rapid(pose(0.0, 0.0, 60.0, [0.0, 0.0])),
                Op::Cycle(Box::new(Cycle { retract, ..reaming })),
                Op::Hole(pose(-7.8, 20.2, -4.6, [0.486, 0.157])),
                Op::Hole(pose(-8.4, -27.2, -1.3, [-0.119, 0.06])),
                Op::Hole(pose(-8.4, -7.2, -1.3, [-0.119, 0.06])),
                Op::CycleOff,
                Op::Rapid(pose(35.0, -20.0, 60.0, [-0.157, 0.308])),
                Op::Rapid(pose(35.0, -20.0, 2.0, [-0.157, 0.308])),
                Op::Line(pose(35.0, -20.0, -3.0, [-0.157, 0.308])),
                Op::Line(pose(30.0, -6.0, -3.0, [-0.05, -0.016])),
                Op::Rapid(pose(30.0, -6.0, 60.0, [-0.05, -0.016])),
                Op::End,
            ];
            for (line, op) in (1..).zip(ops) {
                source.push(line, op);
            }
            let output = post::write(&source, &machine)
                .unwrap_or_else(|found| panic!("{}: {found:?}", machine.name));
            let report = proof::prove(&source, &machine, "p", &output.text, &Default::default());
            let text = String::from_utf8_lossy(&output.text);
            assert!(report.proven, "{}: {:?}\n{text}", machine.name, report.mismatches);
        }
    }
}

/// LinuxCNC's manual, "Canned Cycles": P in seconds, the pitch of a tap is F / S.
const LINUXCNC: [(CycleKind, f64, &str); 8] = [
    (DRILL, 0.0, "G98 G81 X10 Y5 Z-12 R3 F120"),
    (DRILL, 0.5, "G98 G82 X10 Y5 Z-12 R3 P0.5 F120"),
    (DEEP, 0.0, "G98 G83 X10 Y5 Z-12 R3 Q4 F120"),
    (BREAK_CHIP, 0.0, "G98 G73 X10 Y5 Z-12 R3 Q4 F120"),
    (REAM, 0.0, "G98 G85 X10 Y5 Z-12 R3 F120"),
    (REAM, 0.5, "G98 G89 X10 Y5 Z-12 R3 P0.5 F120"),
    (BORE, 0.0, "G98 G86 X10 Y5 Z-12 R3 P0 F120"),
    (BORE, 0.5, "G98 G86 X10 Y5 Z-12 R3 P0.5 F120"),
];

#[test]
fn linuxcnc_and_mach3() {
    for (kind, dwell, block) in LINUXCNC {
        stands("generic-3axis-linuxcnc", kind, dwell, &[block, "G80"]);
        stands("generic-3axis-mach3", kind, dwell, &[block, "G80"]);
    }
    // Rigid tapping: in, and with the spindle reversed out to where it began.
    for kind in [TAP, LEFT_TAP] {
        stands("generic-3axis-linuxcnc", kind, 0.0, &["G0 Z3", "G33.1 Z-12 K1.25", "G0 Z20"]);
    }
    assert_eq!(posted("generic-3axis-linuxcnc", cycle(TAP, 0.5)), Err("cycle-tap"));
}

/// LinuxCNC's manual, "G84", "G74": for a floating chuck. Mach3 has no G74; FANUC couples feed and spindle behind M29
/// (parameter 5200#0). Where taps float the machine's file says it.
#[test]
fn taps_that_are_not_coupled_need_a_floating_holder() {
    let g84 = "cycle_tap = \"{{N}} {{feed_mode}} G98 G84 {{X}} {{Y}} {{BOTTOM}} {{CLEAR}} {{F}}\"";
    for name in [
        "generic-3axis-iso",
        "generic-3axis-mach3",
        "generic-3axis-fanuc",
        "generic-3axis-linuxcnc",
    ] {
        for floats in [false, true] {
            let text = format!(
                "extends = \"{name}\"\n[settings]\nfloating_holder = {floats}\n[capabilities]\n\
                 cycles = [\"tap\"]\n[blocks]\n{g84}\n"
            );
            let machine = machine::load_text("m.toml", &text).unwrap();
            let source = source(cycle(TAP, 0.0));
            let output = post::write(&source, &machine).unwrap();
            let report = proof::prove(&source, &machine, "p", &output.text, &Default::default());
            let found = report.mismatches.first().map(|found| found.rule.name());
            assert_eq!(found, (!floats).then_some("floating-tap"), "{name}");
        }
    }
    for name in ["generic-3axis-iso", "generic-3axis-mach3"] {
        assert_eq!(posted(name, cycle(TAP, 0.0)), Err("cycle-tap"));
        assert_eq!(posted(name, cycle(LEFT_TAP, 0.0)), Err("cycle-tap"));
    }
}

/// A hole that ends at the R plane is done when the tool is at the retract level, straight above.
#[test]
fn the_way_up_belongs_to_a_hole_that_ends_at_the_r_plane() {
    let machine = machine::load("generic-3axis-linuxcnc").unwrap();
    let source = source(cycle(TAP, 0.0));
    let output = post::write(&source, &machine).unwrap();
    let text = String::from_utf8(output.text).unwrap();
    let rule = |text: &str| {
        let report = proof::prove(&source, &machine, "p", text.as_bytes(), &Default::default());
        report.mismatches.first().map(|found| found.rule.name())
    };
    assert_eq!(rule(&text), None);
    let up = "G33.1 Z-12 K1.25\nG0 Z20\n";
    assert!(text.contains(up), "{text}");
    for other in [
        "G33.1 Z-12 K1.25\n",
        "G33.1 Z-12 K1.25\nG0 X50\nG0 Z20\n",
        "G33.1 Z-12 K1.25\nG0 Z25\n",
        "G33.1 Z-12 K1.2\nG0 Z20\n",
        "G33.1 Z-13 K1.25\nG0 Z20\n",
    ] {
        assert!(rule(&text.replace(up, other)).is_some(), "{other}");
    }
}

/// B-64484EN-2, "Canned cycle for drilling": P in increments of time, milliseconds as a rule (1013#1, 1015#7); M29 announces
/// rigid tapping.
#[test]
fn fanuc() {
    let counts = "extends = \"generic-3axis-fanuc\"\n[settings]\ndwell_p_milliseconds = true\n";
    let counts = machine::load_text("counts.toml", counts).unwrap();
    let fanuc = |kind, dwell, row: &[&str]| stand(&counts, kind, dwell, row);
    let unknown = |kind, dwell, row: &[&str]| stands("generic-3axis-fanuc", kind, dwell, row);
    unknown(DRILL, 0.0, &["G98 G81 X10. Y5. Z-12. R3. F120."]);
    unknown(DRILL, 0.5, &["G1 Z-12. F120.", "G4 X0.5", "G0 Z20."]);
    unknown(TAP, 0.0, &["M29 S1000", "G98 G84 X10. Y5. Z-12. R3. P0 F1250."]);
    assert_eq!(posted("generic-3axis-fanuc", cycle(TAP, 0.5)), Err("cycle-tap"));
    fanuc(DRILL, 0.0, &["G98 G81 X10. Y5. Z-12. R3. F120."]);
    fanuc(DRILL, 0.5, &["G98 G82 X10. Y5. Z-12. R3. P500 F120."]);
    fanuc(DEEP, 0.0, &["G98 G83 X10. Y5. Z-12. R3. Q4. F120."]);
    fanuc(BREAK_CHIP, 0.0, &["G98 G73 X10. Y5. Z-12. R3. Q4. F120."]);
    fanuc(TAP, 0.5, &["M29 S1000", "G98 G84 X10. Y5. Z-12. R3. P500 F1250."]);
    fanuc(LEFT_TAP, 0.0, &["M29 S1000", "G98 G74 X10. Y5. Z-12. R3. P0 F1250."]);
    fanuc(REAM, 0.0, &["G98 G85 X10. Y5. Z-12. R3. F120."]);
    fanuc(REAM, 0.5, &["G98 G89 X10. Y5. Z-12. R3. P500 F120."]);
    fanuc(BORE, 0.0, &["G98 G86 X10. Y5. Z-12. R3. F120."]);
    // G86 has no dwell: the hole is made by moves.
    fanuc(BORE, 0.5, &["G1 Z-12. F120.", "G4 X0.5", "M5", "G0 Z20."]);
}

/// Haas Mill Operator's Manual: P in milliseconds without a point; G84 and G74 turn the spindle, and have
/// no P.
#[test]
fn haas() {
    let haas = |kind, dwell, row: &[&str]| stands("generic-3axis-haas", kind, dwell, row);
    haas(DRILL, 0.5, &["G98 G82 X10. Y5. Z-12. R3. P500 F120."]);
    haas(REAM, 0.5, &["G98 G89 X10. Y5. Z-12. R3. P500 F120."]);
    haas(TAP, 0.0, &["S1000", "G98 G84 X10. Y5. Z-12. R3. F1250."]);
    assert_eq!(posted("generic-3axis-haas", cycle(TAP, 0.5)), Err("cycle-tap"));
}

/// NC programming manual 06/2019, 3.25.1: RTP 20, RFP 3, SDIS 0, DP -12, then what is the cycle's own.
#[test]
fn sinumerik() {
    let sinumerik = |kind, dwell, call: &str| {
        for machine in ["generic-3axis-sinumerik", "generic-3axis-sinumerik-828d"] {
            stands(machine, kind, dwell, &[call, "G0 X10 Y5", "MCALL"]);
        }
    };
    sinumerik(DRILL, 0.0, "MCALL CYCLE81(20,3,0,-12)");
    // DTB in seconds, behind an empty DPR.
    sinumerik(DRILL, 0.5, "MCALL CYCLE82(20,3,0,-12,,0.5)");
    // FDPR 4, DAM 0, DTB 0, DTS 0, FRF 1, VARI 1: out of the hole after each peck.
    sinumerik(DEEP, 0.0, "MCALL CYCLE83(20,3,0,-12,,,4,0,0,0,1,1)");
    // VARI 0: breaks the chip.
    sinumerik(BREAK_CHIP, 0.0, "MCALL CYCLE83(20,3,0,-12,,,4,0,0,0,1,0)");
    // DTB, SDAC 3 (goes on clockwise), no MPIT, PIT, POSS 0, SST and SST1.
    sinumerik(TAP, 0.5, "MCALL CYCLE84(20,3,0,-12,,0.5,3,,1.25,0,1000,1000)");
    // A left-hand thread has a pitch below 0.
    sinumerik(LEFT_TAP, 0.0, "MCALL CYCLE84(20,3,0,-12,,0,4,,-1.25,0,1000,1000)");
    // DTB, FFR, RFF.
    sinumerik(REAM, 0.0, "MCALL CYCLE85(20,3,0,-12,,0,120,120)");
    sinumerik(REAM, 0.5, "MCALL CYCLE85(20,3,0,-12,,0.5,120,120)");
    // The cycle would orient the spindle, which the source has not asked for.
    for machine in ["generic-3axis-sinumerik", "generic-3axis-sinumerik-828d"] {
        stands(machine, BORE, 0.5, &["G1 Z-12 F120", "G4 F0.5", "M5", "G0 Z20"]);
    }
    // DTB, SDIR 3, RPA RPO RPAP 0 (not aside), POSS 0.
    let call = ["MCALL CYCLE86(20,3,0,-12,,0.5,3,0,0,0,0)", "G0 X10 Y5", "MCALL"];
    stand(&boring("generic-3axis-sinumerik"), BORE, 0.5, &call);
}

/// A machine whose spindle can be positioned: it bores by a cycle.
fn boring(name: &str) -> Machine {
    let text = format!("extends = \"{name}\"\n[capabilities]\ncycles = [\"drill\", \"bore\"]\n");
    machine::load_text("boring.toml", &text).unwrap()
}

#[test]
fn the_feeds_of_cycle85_count_as_the_feed_does() {
    let feed = Some(Feed::PerTurn(0.12));
    let blocks =
        posted("generic-3axis-sinumerik", Cycle { feed, ..cycle(REAM, 0.0) }).unwrap().join("\n");
    assert!(blocks.contains("G95 F0.12\nMCALL CYCLE85(20,3,0,-12,,0,0.12,0.12)"), "{blocks}");
}

/// The spindle stands after CYCLE86 until it is started; before each hole the cycle starts it.
#[test]
fn the_spindle_is_printed_again_after_boring() {
    let machine = boring("generic-3axis-sinumerik");
    let mut source = source(cycle(BORE, 0.0));
    let at = |z| Pose::upright(Vec3::new(30.0, 5.0, z)).unwrap();
    source.records.truncate(7);
    let ops = [Op::Rapid(at(20.0)), Op::Line(at(3.0)), Op::Rapid(at(50.0)), Op::End];
    for (line, op) in (8..).zip(ops) {
        source.push(line, op);
    }
    let output = post::write(&source, &machine).unwrap();
    let report = proof::prove(&source, &machine, "p", &output.text, &Default::default());
    assert!(report.proven, "{:?}", report.mismatches);
    let text = String::from_utf8(output.text).unwrap();
    let after = text.split("MCALL\n").nth(1).unwrap();
    assert!(after.contains("S1000 M3"), "{after}");
}

/// The parameters of a Klartext cycle (200 and on), without their names: `Q200=+0 Q201=-15 ...`.
fn klartext(kind: CycleKind, dwell: f64) -> String {
    klartext_of(&machine::load("generic-3axis-heidenhain").unwrap(), kind, dwell)
}

fn klartext_of(machine: &Machine, kind: CycleKind, dwell: f64) -> String {
    let blocks = posted_for(machine, cycle(kind, dwell)).unwrap();
    let start = blocks.iter().position(|block| block.starts_with("CYCL DEF 2")).unwrap();
    let number = blocks[start].split(' ').nth(2).unwrap().to_string();
    let parameters = blocks[start + 1..].iter().take_while(|block| block.starts_with('Q'));
    let parameters = parameters.map(|block| block.split(' ').next().unwrap().to_string());
    [number].into_iter().chain(parameters).collect::<Vec<_>>().join(" ")
}

/// Set-up clearance Q200 0 above the surface Q203 3, depth Q201 -15, second clearance Q204 17.
#[test]
fn heidenhain() {
    assert_eq!(
        klartext(DRILL, 0.5),
        "200 Q200=+0 Q201=-15 Q206=+120 Q202=+15 Q210=+0 Q203=+3 Q204=+17 Q211=+0.5"
    );
    let pecks = "Q203=+3 Q204=+17 Q212=+0 Q205=+0 Q258=+0.5 Q259=+0.5";
    assert_eq!(
        klartext(DEEP, 0.0),
        format!(
            "205 Q200=+0 Q201=-15 Q206=+120 Q202=+4 {pecks} Q257=+0 Q256=+0.5 Q211=+0 Q379=+0 Q253=+750"
        )
    );
    // Q202 is the whole depth: chips are broken, and the tool stays in the hole.
    assert_eq!(
        klartext(BREAK_CHIP, 0.5),
        format!(
            "205 Q200=+0 Q201=-15 Q206=+120 Q202=+15 {pecks} Q257=+4 Q256=+0.5 Q211=+0.5 Q379=+0 Q253=+750"
        )
    );
    assert_eq!(klartext(TAP, 0.0), "207 Q200=+0 Q201=-15 Q239=+1.25 Q203=+3 Q204=+17");
    assert_eq!(klartext(LEFT_TAP, 0.0), "207 Q200=+0 Q201=-15 Q239=-1.25 Q203=+3 Q204=+17");
    // Q208 0: out with the feed in.
    assert_eq!(
        klartext(REAM, 0.5),
        "201 Q200=+0 Q201=-15 Q206=+120 Q211=+0.5 Q208=+0 Q203=+3 Q204=+17"
    );
    // 202 would orient the spindle, which the source has not asked for.
    stands("generic-3axis-heidenhain", BORE, 0.0, &["L Z-12 R0 F120", "M5", "L Z+20 R0 FMAX"]);
    assert_eq!(
        klartext_of(&boring("generic-3axis-heidenhain"), BORE, 0.0),
        "202 Q200=+0 Q201=-15 Q206=+120 Q211=+0 Q208=+99999 Q203=+3 Q204=+17 Q214=+0 Q336=+0"
    );
    assert_eq!(posted("generic-3axis-heidenhain", cycle(TAP, 0.5)), Err("cycle-tap"));
}

/// GRBL and Marlin have no cycles: the moves, with rapids back to half a millimetre above the last depth.
#[test]
fn grbl_and_marlin() {
    let in_and_out = |kind, dwell, row: &[&str]| {
        stands("generic-3axis-grbl", kind, dwell, row);
        let blocks = posted("generic-3axis-marlin", cycle(kind, dwell)).unwrap();
        // Every block of Marlin says its G word.
        let heights = |blocks: &[String]| -> Vec<String> {
            let z = |block: &String| {
                block.split(' ').find(|word| word.starts_with('Z')).map(String::from)
            };
            blocks.iter().filter_map(z).collect()
        };
        let row: Vec<String> = row.iter().map(|block| block.to_string()).collect();
        let (all, some) = (heights(&blocks), heights(&row));
        assert!(all.windows(some.len()).any(|part| part == some), "{all:?}, {some:?}");
    };
    in_and_out(DRILL, 0.5, &["Z3", "G1 Z-12 F120", "G4 P0.5", "G0 Z20"]);
    in_and_out(
        DEEP,
        0.0,
        &[
            "Z3",
            "G1 Z-1 F120",
            "G0 Z3",
            "Z-0.5",
            "G1 Z-5",
            "G0 Z3",
            "Z-4.5",
            "G1 Z-9",
            "G0 Z3",
            "Z-8.5",
            "G1 Z-12",
            "G0 Z20",
        ],
    );
    in_and_out(
        BREAK_CHIP,
        0.0,
        &[
            "G1 Z-1 F120",
            "G0 Z-0.5",
            "G1 Z-5",
            "G0 Z-4.5",
            "G1 Z-9",
            "G0 Z-8.5",
            "G1 Z-12",
            "G0 Z20",
        ],
    );
    in_and_out(REAM, 0.5, &["G1 Z-12 F120", "G4 P0.5", "Z3", "G0 Z20"]);
    // No hole follows that needs the spindle again.
    in_and_out(BORE, 0.0, &["G1 Z-12 F120", "M5", "G0 Z20", "Z50"]);
    for machine in ["generic-3axis-grbl", "generic-3axis-marlin"] {
        assert_eq!(posted(machine, cycle(TAP, 0.0)), Err("cycle-tap"));
    }
}

/// What is read back of a cycle is what was asked for.
#[test]
fn every_cycle_is_read_as_it_was_meant() {
    let machines = [
        "generic-3axis-iso",
        "generic-3axis-fanuc",
        "generic-3axis-haas",
        "generic-3axis-linuxcnc",
        "generic-3axis-mach3",
        "generic-3axis-sinumerik",
        "generic-3axis-heidenhain",
    ];
    for machine in machines.map(|name| machine::load(name).unwrap()) {
        // LinuxCNC's taps end at the R plane; what does not couple feed and spindle taps nothing.
        let taps: &[CycleKind] = match machine.reader.as_str() {
            "linuxcnc" | "mach3" => &[],
            _ if machine.control == "iso" => &[],
            _ => &[TAP, LEFT_TAP],
        };
        for &kind in [DRILL, DEEP, BREAK_CHIP, REAM, BORE].iter().chain(taps) {
            let asked = cycle(kind, 0.0);
            let bores = machine.capabilities.cycles.contains(&machine::CycleName::Bore);
            let own = (kind == BORE && !bores).then(|| boring(&machine.name));
            let machine = own.as_ref().unwrap_or(&machine);
            let output = post::write(&source(asked), machine).unwrap();
            let read = nc::read(machine, Setup::default(), "p", &output.text).unwrap();
            let mut records = read.program.records.iter();
            let read = records.find_map(|record| match &record.op {
                Op::Cycle(cycle) => Some(**cycle),
                _ => None,
            });
            let read = read.unwrap_or_else(|| panic!("{}: {kind:?} by moves", machine.name));
            // The feed may be that of a block, and is the pitch's in a tap.
            assert_eq!(
                Cycle { feed: None, ..read },
                Cycle { feed: None, ..asked },
                "{}",
                machine.name
            );
        }
    }
}

/// What `rs274` does in the hole: `rapid 3`, `feed -12`, `dwell`, `stop`, `start`.
fn rs274(program: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("p.ngc"), program).unwrap();
    std::fs::write(folder.path().join("t.tbl"), "T1 P1 D0 Z0\n").unwrap();
    let run = Command::new("rs274")
        .args(["-t", "t.tbl", "-g", "p.ngc"])
        .current_dir(folder.path())
        .env("HOME", folder.path())
        .stdin(Stdio::null())
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let said = String::from_utf8_lossy(&run.stdout).into_owned();
    let mut heights = String::new();
    let does = |line: &str| {
        let (head, rest) = line.split_once('(')?;
        let third = rest.trim_end_matches(')').split(',').nth(2);
        let z = third.and_then(|z| z.trim().parse::<f64>().ok());
        let step = match (head.rsplit(' ').next()?, z) {
            ("STRAIGHT_TRAVERSE", Some(z)) => format!("rapid {z}"),
            ("STRAIGHT_FEED", Some(z)) => format!("feed {z}"),
            ("RIGID_TAP", Some(z)) => format!("rigid tap {z}"),
            ("DWELL", _) => "dwell".into(),
            ("STOP_SPINDLE_TURNING", _) => "stop".into(),
            ("START_SPINDLE_CLOCKWISE", _) => "clockwise".into(),
            ("START_SPINDLE_COUNTERCLOCKWISE", _) => "counter-clockwise".into(),
            _ => return None,
        };
        // Moves across only.
        (std::mem::replace(&mut heights, step.clone()) != step).then_some(step)
    };
    said.lines().filter_map(does).collect()
}

#[test]
fn linuxcnc_itself_moves_as_the_manual_says() {
    if !judge::program("rs274", "Debian package linuxcnc-uspace") {
        return;
    }
    // It draws back and comes back by a hundredth of an inch.
    let motions: [&[&str]; 8] = [
        &["feed -12", "rapid 20"],
        &["feed -12", "dwell", "rapid 20"],
        &[
            "feed -1",
            "rapid 3",
            "rapid -0.746",
            "feed -5",
            "rapid 3",
            "rapid -4.746",
            "feed -9",
            "rapid 3",
            "rapid -8.746",
            "feed -12",
            "rapid 20",
        ],
        &[
            "feed -1",
            "rapid -0.746",
            "feed -5",
            "rapid -4.746",
            "feed -9",
            "rapid -8.746",
            "feed -12",
            "rapid 20",
        ],
        &["feed -12", "feed 3", "rapid 20"],
        &["feed -12", "dwell", "feed 20"],
        &["feed -12", "dwell", "stop", "rapid 20", "clockwise"],
        &["feed -12", "dwell", "stop", "rapid 20", "clockwise"],
    ];
    let cycles = LINUXCNC.map(|(kind, dwell, _)| (kind, dwell)).into_iter().zip(motions);
    // In step with the spindle to the bottom, and back to where it began.
    let tap: &[&str] = &["rigid tap -12", "rapid 20"];
    let taps = [TAP, LEFT_TAP].map(|kind| ((kind, 0.0), tap));
    for ((kind, dwell), motion) in cycles.chain(taps) {
        let program = posted("generic-3axis-linuxcnc", cycle(kind, dwell)).unwrap().join("\n");
        let steps = rs274(&program);
        let row = [&["rapid 3"], motion].concat();
        let found = steps.windows(row.len()).any(|steps| steps == row);
        assert!(found, "{kind:?}: {row:?} is not in {steps:?}");
    }
}
