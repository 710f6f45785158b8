//! The feed that counts is the speed of the tool tip on the part, whatever number stands behind F.

use crate::common::*;
use control::{Action, FeedPath, Orientation, Position};
use geom::Vec3;
use machine::Machine;
use program::*;
use toolpost_proof::Report;

/// The table of [`five_axes`], whose axes turn at 10,000°/min, on the control of this dialect.
fn table(reader: &str) -> Machine {
    Machine { reader: reader.into(), ..five_axes() }
}

/// What a block says: X, and C of the table, which lies flat.
fn block(x: f64, c: f64, tool_center: bool) -> Position {
    let point = if tool_center { on_part(x, c) } else { Vec3::new(x, 0.0, 0.0) };
    Position { point, orientation: Orientation::Rotary { degrees: [0.0, 0.0, c], tool_center } }
}

/// Where a tip at X of the machine stands on the part while the table stands at C: the table turns right-handed by -C.
fn on_part(x: f64, c: f64) -> Vec3 {
    let (sin, cos) = c.to_radians().sin_cos();
    Vec3::new(x * cos, x * sin, 0.0)
}

/// A cut from X to X of the machine while C turns from 0 in so many blocks, at 300 mm/min for the tip.
struct Cut {
    x: [f64; 2],
    c: f64,
    blocks: u32,
}

/// One degree at a radius of 200 mm: the tip goes 2 · 200 · sin 0.5° = 3.4906 mm, the linear axes stand still.
const AT_R_200: Cut = Cut { x: [200.0, 200.0], c: 1.0, blocks: 1 };

/// Half a degree, and 3 mm outwards: the tip goes √(3² + 4 · 200 · 203 · sin² 0.25°) = 3.4773 mm.
const OUTWARDS: Cut = Cut { x: [200.0, 203.0], c: 0.5, blocks: 1 };

/// Ten degrees at a radius of 1 mm: the tip goes 0.17431 mm.
const NEAR_THE_POLE: Cut = Cut { x: [1.0, 1.0], c: 10.0, blocks: 1 };

impl Cut {
    /// What the proof says of a program that sets its feed by these words.
    fn judged(&self, machine: &Machine, tool_center: bool, feed: &[Action]) -> Report {
        let [from, to] = self.x;
        let pose = |x, c| Pose::upright(on_part(x, c)).unwrap();
        let own = source(vec![Op::Rapid(pose(from, 0.0)), Op::Line(pose(to, self.c))]);
        let mut nc = vec![EXACT, Action::Rapid(block(from, 0.0, tool_center))];
        nc.extend_from_slice(feed);
        for i in 1..=self.blocks {
            let tip =
                on_part(from, 0.0).lerp(on_part(to, self.c), f64::from(i) / f64::from(self.blocks));
            nc.push(Action::Line(block(
                tip.length(),
                tip.y.atan2(tip.x).to_degrees(),
                tool_center,
            )));
        }
        judge(machine, &own, nc)
    }

    fn is_proven(&self, machine: &Machine, feed: &[Action]) -> bool {
        let report = self.judged(machine, false, feed);
        assert!(report.proven || rules(&report) == ["feed"], "{:?}", report.mismatches);
        report.proven
    }
}

/// It keeps to the path at corners.
const EXACT: Action = Action::PathMode(PathMode::ExactPath);

fn per_minute(f: f64) -> Action {
    Action::Feed(Feed::PerMinute(f))
}

/// Klartext without `M128`, GRBL: 300 mm/min along 3.4906 mm of the tip are 85.94 counts of a degree.
#[test]
fn where_f_counts_a_degree_as_a_mm_the_tip_at_r_200_would_go_three_and_a_half_times_too_fast() {
    for reader in ["klartext", "grbl"] {
        let machine = table(reader);
        assert!(AT_R_200.is_proven(&machine, &[per_minute(86.0)]));
        assert!(!AT_R_200.is_proven(&machine, &[per_minute(300.0)]));
        assert!(!AT_R_200.is_proven(&machine, &[per_minute(88.0)]));
        assert!(!AT_R_200.is_proven(&machine, &[per_minute(84.0)]));
        // √(3² + 0.5²) = 3.0414 counted: F = 300 · 3.0414 / 3.4773 = 262.4.
        assert!(OUTWARDS.is_proven(&machine, &[per_minute(262.0)]));
        assert!(!OUTWARDS.is_proven(&machine, &[per_minute(259.0)]));
    }
    let report = AT_R_200.judged(&table("klartext"), false, &[per_minute(300.0)]);
    let message = &report.mismatches[0].message;
    assert!(message.contains("1047.1"), "{message}");
    // 300 / 85.94 - 1.
    let worst = report.deviations.tip_speed_percent;
    assert!((worst.value - 249.1).abs() < 1.0 && worst.program_line == 10, "{worst:?}");
}

/// LinuxCNC ("Feed Rate"), Marlin: along X, Y and Z where one of them moves, otherwise in degrees.
#[test]
fn where_f_counts_the_linear_axes_alone_the_rotary_ones_arrive_with_them() {
    for reader in ["linuxcnc", "marlin"] {
        let machine = table(reader);
        assert!(AT_R_200.is_proven(&machine, &[per_minute(86.0)]));
        assert!(!AT_R_200.is_proven(&machine, &[per_minute(300.0)]));
        // F = 300 · 3 / 3.4773 = 258.8.
        assert!(OUTWARDS.is_proven(&machine, &[per_minute(259.0)]));
        assert!(!OUTWARDS.is_proven(&machine, &[per_minute(262.0)]));
    }
}

/// SINUMERIK: `FGROUP` names the axes, `FGREF` says what a degree counts; as delivered F counts X, Y and Z.
#[test]
fn on_a_sinumerik_the_feed_group_decides() {
    let machine = table("sinumerik");
    let group = |c: f64| Action::FeedPath(FeedPath::Group([0.0, 0.0, c]));
    // F is the speed of no axis that moves.
    for f in [86.0, 300.0] {
        assert!(!AT_R_200.is_proven(&machine, &[per_minute(f)]));
    }
    assert!(OUTWARDS.is_proven(&machine, &[per_minute(259.0)]));
    assert!(AT_R_200.is_proven(&machine, &[group(1.0), per_minute(86.0)]));
    assert!(!AT_R_200.is_proven(&machine, &[group(1.0), per_minute(300.0)]));
    let at_200 = group(200f64.to_radians());
    assert!(AT_R_200.is_proven(&machine, &[at_200.clone(), per_minute(300.0)]));
    assert!(!AT_R_200.is_proven(&machine, &[at_200.clone(), per_minute(86.0)]));
    // It counts so under TRAORI too: the way of the tip and 3.4907 mm of C together.
    let under_traori = |f| AT_R_200.judged(&machine, true, &[at_200.clone(), per_minute(f)]).proven;
    assert!(under_traori(424.0) && !under_traori(300.0));
}

/// FANUC 1408#0, Haas settings 34 and 79, Mach3 "Use Radius for Feedrate".
#[test]
fn where_a_parameter_decides_what_f_counts_only_inverse_time_is_proven_without_it() {
    for reader in ["fanuc", "haas", "mach3"] {
        let mut machine = table(reader);
        for f in [86.0, 300.0] {
            let report = AT_R_200.judged(&machine, false, &[per_minute(f)]);
            assert_eq!(rules(&report), ["feed"]);
            assert!(report.mismatches[0].message.contains("rotary_feed"));
        }
        let inverse = |rate| Action::Feed(Feed::InverseTime(rate));
        assert!(AT_R_200.is_proven(&machine, &[inverse(85.94)]));
        assert!(!AT_R_200.is_proven(&machine, &[inverse(88.0)]));
        machine.settings.rotary_feed = Some(machine::RotaryFeed::AllAxes);
        assert!(AT_R_200.is_proven(&machine, &[per_minute(86.0)]));
        assert!(!AT_R_200.is_proven(&machine, &[per_minute(300.0)]));
        machine.settings.rotary_feed = Some(machine::RotaryFeed::LinearAxes);
        assert!(OUTWARDS.is_proven(&machine, &[per_minute(259.0)]));
    }
}

/// What a setting of a control with a rule of its own says changes nothing.
#[test]
fn a_machine_file_does_not_change_what_a_manual_says() {
    let mut machine = table("linuxcnc");
    machine.settings.rotary_feed = Some(machine::RotaryFeed::AllAxes);
    assert!(!OUTWARDS.is_proven(&machine, &[per_minute(262.0)]));
}

#[test]
fn with_tool_centre_control_f_is_the_speed_of_the_tip() {
    for reader in ["fanuc", "klartext", "sinumerik", "linuxcnc", "haas"] {
        let proven = |f| AT_R_200.judged(&table(reader), true, &[per_minute(f)]).proven;
        assert!(proven(300.0) && !proven(86.0), "{reader}");
    }
}

/// The exact F near the pole is 10 · 300 / 0.17431 = 17,211; C, at 10,000°/min, is asked for more than it can.
#[test]
fn near_the_pole_the_tip_may_be_slower_as_far_as_an_axis_can_go_no_faster() {
    let machine = table("klartext");
    let report = NEAR_THE_POLE.judged(&machine, false, &[per_minute(10_000.0)]);
    proven(&report);
    assert_eq!(report.compared.slowed, 1);
    for (f, right) in [(17_000.0, true), (18_000.0, false), (9_600.0, false), (300.0, false)] {
        assert_eq!(NEAR_THE_POLE.is_proven(&machine, &[per_minute(f)]), right, "{f}");
    }
    // F of no more than 5000: 10 counted mm take a 500th of a minute.
    let slow = Machine { feed_max: 5000.0, ..machine };
    assert!(NEAR_THE_POLE.is_proven(&slow, &[per_minute(5000.0)]));
    assert!(!NEAR_THE_POLE.is_proven(&slow, &[per_minute(4500.0)]));
}

/// 100 blocks of 0.0017 mm each, less than the rounding of one can tell.
#[test]
fn blocks_too_short_to_have_a_speed_are_compared_together() {
    let machine = table("klartext");
    let fine = Cut { blocks: 100, ..NEAR_THE_POLE };
    assert!(fine.is_proven(&machine, &[per_minute(10_000.0)]));
    assert!(fine.is_proven(&machine, &[per_minute(17_000.0)]));
    assert!(!fine.is_proven(&machine, &[per_minute(301.0)]));
    assert!(!fine.is_proven(&machine, &[per_minute(25_000.0)]));
}

/// The source gives a tenth of a minute for the whole move, which is written in 100 blocks of 0.0017 mm: each takes a thousandth. Before,
/// blocks so short were not compared.
#[test]
fn short_blocks_of_a_move_whose_time_the_source_gives_take_that_time() {
    let machine = table("fanuc");
    let pose = |x, c| Pose::upright(on_part(x, c)).unwrap();
    let timed = Op::Feed(Feed::InverseTime(10.0));
    let own = source(vec![Op::Rapid(pose(1.0, 0.0)), timed, Op::Line(pose(1.0, 10.0))]);
    let judged = |rate: f64| {
        let mut nc = vec![EXACT, Action::Rapid(block(1.0, 0.0, false))];
        for i in 1..=100 {
            let tip = on_part(1.0, 0.0).lerp(on_part(1.0, 10.0), f64::from(i) / 100.0);
            nc.push(Action::Feed(Feed::InverseTime(rate)));
            nc.push(Action::Line(block(tip.length(), tip.y.atan2(tip.x).to_degrees(), false)));
        }
        let report = judge(&machine, &own, nc);
        assert!(report.proven || rules(&report) == ["feed"], "{:?}", report.mismatches);
        report.proven
    };
    assert!(judged(1000.0));
    assert!(!judged(2100.0) && !judged(600.0));
}

/// The tool turns about its tip: F is the number of the source.
#[test]
fn a_turn_about_the_tip_has_the_number_of_the_source() {
    let machine = table("klartext");
    let lean = |a: f64| {
        let degrees = [a, 0.0, 0.0];
        let point = machine.linear_for(Vec3::new(10.0, 5.0, 2.0), degrees, 0.0);
        let block =
            Position { point, orientation: Orientation::Rotary { degrees, tool_center: false } };
        (Pose::new(Vec3::new(10.0, 5.0, 2.0), machine.axis_at(degrees)).unwrap(), block)
    };
    let own = source(vec![Op::Rapid(lean(0.0).0), Op::Line(lean(1.0).0)]);
    for (f, right) in [(300.0, true), (30.0, false)] {
        let nc = vec![EXACT, Action::Rapid(lean(0.0).1), per_minute(f), Action::Line(lean(1.0).1)];
        assert_eq!(judge(&machine, &own, nc).proven, right);
    }
}

/// Half a step of F in mm/min is half a millimetre a turn where F says that: it is rounded as its own form.
#[test]
fn each_form_of_f_is_rounded_as_it_is_written() {
    let forms = "[words]\nF_per_turn = { address = \"F\", decimals = 3 }\nF_inverse_time = { address = \"F\", decimals = 3 }\n";
    let text = format!(
        "reader = \"fanuc\"\n[capabilities]\nlength_offset = \"tool-number\"\n{forms}F = {{ decimals = 0 }}\nX = {{ decimals = 3 }}\n"
    );
    let machine = machine::load_text("mill.toml", &text).unwrap();
    let own = source(vec![Op::Rapid(at(0.0, 0.0, 0.0)), Op::Line(at(100.0, 0.0, 0.0))]);
    let judged = |feed| {
        let start = crate::common::block(0.0, 0.0, 0.0);
        let end = crate::common::block(100.0, 0.0, 0.0);
        judge(&machine, &own, vec![Action::Rapid(start), Action::Feed(feed), Action::Line(end)])
            .proven
    };
    assert!(judged(Feed::PerTurn(0.3)) && !judged(Feed::PerTurn(0.32)));
    assert!(judged(Feed::InverseTime(3.0)) && !judged(Feed::InverseTime(3.2)));
}
