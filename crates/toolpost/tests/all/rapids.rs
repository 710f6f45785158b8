//! A rapid is a path: the tool goes where the source goes, straight, or beyond all that it cuts, whatever the axes of the
//! machine do between two blocks.

use geom::{Vec3, nearest_on_segment};
use machine::{ControlSettings, Machine, load, load_text};
use program::{Diagnostic, Program};

fn read(text: &str) -> Program {
    let read = source::apt::read("job.cls", text.as_bytes(), &Default::default());
    read.unwrap_or_else(|found| panic!("{found:?}")).program
}

/// Cuts near Y 100, then goes at Z 5 straight to Y -100 while the tool leans by 60°, and cuts there.
fn leaning() -> Program {
    read(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,100\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\nRAPID\nGOTO/0,100,50,0,0,1\n\
         RAPID\nGOTO/0,100,5\nGOTO/0,100,0\nGOTO/10,100,0,0,0.087156,0.996195\nGOTO/0,100,0,0,0,1\nGOTO/0,100,5\n\
         RAPID\nGOTO/0,-100,5,0,0.866025,0.5\nGOTO/0,-100,0\nGOTO/10,-100,0\nRAPID\nGOTO/10,-100,60\nFINI\n",
    )
}

fn written(source: &Program, machine: &Machine) -> post::Output {
    post::write(source, machine).unwrap_or_else(|found| panic!("{found:?}"))
}

fn text(output: &post::Output) -> String {
    String::from_utf8(output.text.clone()).unwrap()
}

/// A program without its block numbers.
fn plain(text: &str) -> String {
    let words = |line: &str| match line.strip_prefix('N') {
        Some(rest) => rest.split_once(' ').map_or(String::new(), |(_, words)| format!("{words}\n")),
        None => format!("{line}\n"),
    };
    text.lines().map(words).collect()
}

/// The mismatches of a program.
fn found(source: &Program, machine: &Machine, text: &str) -> Vec<Diagnostic> {
    proof::prove(source, machine, "p", text.as_bytes(), &Default::default()).mismatches
}

#[track_caller]
fn proven(source: &Program, machine: &Machine, text: &str) {
    let found = found(source, machine, text);
    assert!(found.is_empty(), "{found:#?}\n{text}");
}

/// The rules that a program breaks, and in which lines.
fn refused(source: &Program, machine: &Machine, text: &str) -> Vec<(&'static str, u32)> {
    found(source, machine, text).iter().map(|found| (found.rule.name(), found.line)).collect()
}

/// Of blocks of `text`, each of which is changed to another one by itself, none is proven: the way is not that of a rapid.
#[track_caller]
fn none_is_proven<const N: usize>(
    source: &Program,
    machine: &Machine,
    text: &str,
    changes: [(&str, &str); N],
) {
    for (own, by_rapid) in changes {
        assert!(text.contains(own), "{own}: {text}");
        let found = refused(source, machine, &text.replacen(own, by_rapid, 1));
        assert!(found.iter().any(|(rule, _)| *rule == "rapid-path"), "{by_rapid}: {found:?}");
    }
}

/// The number behind `letter` in a block of a SINUMERIK.
fn word(block: &str, letter: char) -> Option<f64> {
    let at = block.find(letter)? + 1;
    let number = block[at..].trim_start_matches('=');
    let end = number.find(|c: char| c != '-' && c != '.' && !c.is_ascii_digit());
    number[..end.unwrap_or(number.len())].parse().ok()
}

/// The positions X, Y, Z, A, C that the blocks of `sinumerik-840d-table-ac` go to, each with its line and whether the
/// move is a rapid; from the first block that says where Z is.
fn positions(text: &str) -> Vec<(u32, bool, [f64; 5])> {
    let (mut at, mut rapid, mut all) = ([f64::NAN; 5], false, Vec::new());
    for (line, block) in (1..).zip(text.lines()) {
        let block = block.split_once(' ').map_or(block, |(_, words)| words);
        rapid = if block.contains("G0") { true } else { rapid && !block.contains("G1") };
        if block.starts_with("G75") {
            at[2] = f64::NAN;
            continue;
        }
        let words = ['X', 'Y', 'Z', 'A', 'C'].map(|letter| word(block, letter));
        if block.contains("FGROUP") || words.iter().all(Option::is_none) {
            continue;
        }
        for (at, word) in at.iter_mut().zip(words) {
            *at = word.unwrap_or(*at);
        }
        if at.iter().all(|at| at.is_finite()) {
            all.push((line, rapid, at));
        }
    }
    all
}

/// Where the tip is on the part: the table tilts by A about X and turns by C about Z on it, both right-handed for the part
/// but for the sign of C.
fn tip([x, y, z, a, c]: [f64; 5]) -> Vec3 {
    let (sin, cos) = a.to_radians().sin_cos();
    let (y, z) = (y * cos + z * sin, z * cos - y * sin);
    let (sin, cos) = c.to_radians().sin_cos();
    Vec3::new(x * cos - y * sin, x * sin + y * cos, z)
}

/// The farthest that the tip is from the line `from` to `to` in the blocks of these lines, with the axes going together.
fn farthest(positions: &[(u32, bool, [f64; 5])], from: Vec3, to: Vec3) -> f64 {
    let off = |pair: &[(u32, bool, [f64; 5])]| {
        (0..=200)
            .map(f64::from)
            .map(|i| {
                let at: [f64; 5] = std::array::from_fn(|k| {
                    pair[0].2[k] + (pair[1].2[k] - pair[0].2[k]) * i / 200.0
                });
                geom::nearest_on_segment(from, to, tip(at)).1
            })
            .fold(0.0, f64::max)
    };
    positions.windows(2).map(off).fold(0.0, f64::max)
}

/// `Y-54.33Z-84.103A60` in one block takes the tip some 50 mm below the straight way.
#[test]
fn a_rapid_that_leans_the_tool_stays_on_the_straight_way() {
    let (source, machine) = (leaning(), load("sinumerik-840d-table-ac").unwrap());
    let good = text(&written(&source, &machine));
    proven(&source, &machine, &good);
    let all = positions(&good);
    let end = all.iter().position(|(_, rapid, at)| *rapid && at[3] == 60.0).unwrap();
    let start = all[..end].iter().rposition(|(_, rapid, _)| !rapid).unwrap();
    assert!(good.lines().nth(all[end].0 as usize - 1).unwrap().ends_with("Y-54.33Z-84.103A60"));
    let (from, to) = (Vec3::new(0.0, 100.0, 5.0), Vec3::new(0.0, -100.0, 5.0));
    assert!(farthest(&all[start..=end], from, to) < 0.1);
    let swung = farthest(&[all[start], all[end]], from, to);
    assert!((swung - 50.7).abs() < 0.1, "{swung}");
    // The report measures it as the tip really goes.
    let report = |text: &str| {
        let accepted = proof::Accepted::default().and("rapid-path").unwrap();
        let tolerances = proof::Tolerances { accepted, ..Default::default() };
        proof::prove(&source, &machine, "p", text.as_bytes(), &tolerances).deviations.rapid_mm
    };
    let measured = report(&good);
    let mine = farthest(&all[start..=end], from, to);
    assert!((measured.value - mine).abs() < 5e-3, "{measured:?} {mine}");
    assert!((all[start].0..=all[end].0).contains(&measured.program_line), "{measured:?}");
    // The same in one block.
    let between = |line: u32| line > all[start + 1].0 && line < all[end].0;
    let lines = (1..).zip(good.lines()).filter(|(line, _)| !between(*line));
    let mut bad: Vec<String> = lines.map(|(_, line)| line.to_owned()).collect();
    bad.remove(all[start + 1].0 as usize - 1);
    let at = all[start + 1].0;
    bad[at as usize - 1] = bad[at as usize - 1].replace(" Y", " G0Y");
    let bad = bad.join("\n") + "\n";
    assert_eq!(refused(&source, &machine, &bad), [("rapid-path", at)]);
    let measured = report(&bad);
    assert!((measured.value - swung).abs() < 1e-2 && measured.program_line == at, "{measured:?}");
}

/// The example of docs/proof.md, as `show` draws it: in one block the tip comes 50.7 mm below Z 5, in pieces it stays there.
#[test]
fn a_picture_shows_where_the_axes_take_the_tip_by_rapid() {
    let machine = load("sinumerik-840d-table-ac").unwrap();
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/");
    let example = |name: &str| std::fs::read_to_string(format!("{root}{name}")).unwrap();
    let source = read(&example("lean.cls"));
    let (good, bad) = (text(&written(&source, &machine)), example("lean-one-block.mpf"));
    let found = refused(&source, &machine, &bad);
    assert!(found.iter().any(|found| found.0 == "rapid-path"), "{found:?}");
    let lowest = |text: &str| {
        let program =
            nc::read_with_rapids_sampled(&machine, Default::default(), "p", text.as_bytes())
                .unwrap();
        let rapids = program.records.iter().filter_map(|record| match &record.op {
            program::Op::Rapid(pose) => Some(pose.point().z),
            _ => None,
        });
        rapids.fold(f64::INFINITY, f64::min)
    };
    assert!((lowest(&bad) - (5.0 - 50.7)).abs() < 0.1, "{}", lowest(&bad));
    assert!((lowest(&good) - 5.0).abs() < 0.1, "{}", lowest(&good));
}

/// The same two in the frame of the machine: one block is straight there. Half way the table stands at A30, and the tip at Y 0 and Z 5 of the
/// part: by hand that is Y -5 sin 30° = -2.5 and Z 5 cos 30° = 4.33 of the machine, 50.7 mm from the path of the block.
#[test]
fn in_the_frame_of_the_machine_one_block_is_straight_and_the_pieces_go_round() {
    let machine = load("sinumerik-840d-table-ac").unwrap();
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/");
    let example = |name: &str| std::fs::read_to_string(format!("{root}{name}")).unwrap();
    let (good, bad) =
        (text(&written(&read(&example("lean.cls")), &machine)), example("lean-one-block.mpf"));
    let rapids = |text: &str| -> Vec<Vec3> {
        let program =
            nc::read_in_machine(&machine, Default::default(), "p", text.as_bytes()).unwrap();
        let rapids = program.records.iter().filter_map(|record| match &record.op {
            program::Op::Rapid(pose) => Some(pose.point()),
            _ => None,
        });
        rapids.collect()
    };
    let end = Vec3::new(0.0, -54.33, -84.103);
    let (one, pieces) = (rapids(&bad), rapids(&good));
    let place = |rapids: &[Vec3]| rapids.iter().position(|at| at.distance(end) < 0.01).unwrap();
    // Before it only the two blocks to the first place.
    assert!(place(&one) <= 3, "{one:?}");
    let half = Vec3::new(0.0, -2.5, 5.0 * 30f64.to_radians().cos());
    let near = |rapids: &[Vec3]| {
        let ways = rapids.windows(2).map(|pair| nearest_on_segment(pair[0], pair[1], half).1);
        ways.fold(f64::INFINITY, f64::min)
    };
    assert!(near(&pieces) < 0.2 && place(&pieces) > 10, "{}", near(&pieces));
    assert!((near(&one) - 50.7).abs() < 0.1, "{}", near(&one));
}

/// The axis of C is 30 mm from the bore: C may not turn on the way down unless X and Y follow.
#[test]
fn a_rapid_down_a_bore_keeps_to_the_bore_while_the_table_turns() {
    let source = read(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,100\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\nRAPID\nGOTO/-40,0,50,0,0,1\n\
         GOTO/-40,0,0\nGOTO/-30,0,0,0,0.087156,0.996195\nGOTO/-30,0,10,0,0,1\nRAPID\nGOTO/-30,0,50\nRAPID\nGOTO/30,0,50\n\
         RAPID\nGOTO/30,0,-20\nGOTO/30,0,-22\nGOTO/31,0,-22,0.087156,0,0.996195\nGOTO/30,0,-22,0,0,1\nRAPID\n\
         GOTO/30,0,60\nFINI\n",
    );
    let machine = load("sinumerik-840d-table-ac").unwrap();
    let good = text(&written(&source, &machine));
    proven(&source, &machine, &good);
    let all = positions(&good);
    let down = all.iter().rposition(|(_, rapid, at)| *rapid && at[2] == -20.0).unwrap();
    let over = all[..down].iter().rposition(|(_, _, at)| at[2] >= 50.0).unwrap();
    let bore = [50.0, -20.0].map(|z| Vec3::new(30.0, 0.0, z));
    assert!(farthest(&all[over..=down], bore[0], bore[1]) < 0.1, "{good}");
}

/// B and C of the nutating table swing the tool off its way: it goes home first.
#[test]
fn a_rapid_whose_tool_leaves_its_way_goes_home_first() {
    let (source, machine) = (leaning(), load("dmu50-heidenhain").unwrap());
    let good = text(&written(&source, &machine));
    proven(&source, &machine, &good);
    let lines: Vec<&str> = good.lines().collect();
    let turn = lines.iter().position(|line| line.contains("B+90")).unwrap();
    assert!(lines[turn - 1].contains("M91"), "{good}");
    // At once under M128, without the way home.
    let kept = lines[..turn - 2].iter().copied();
    let all = kept
        .chain(["19 L X+0 Y-100 Z+5 B+90 C-54.736 R0 FMAX"])
        .chain(lines[turn + 4..].iter().copied());
    let numbered =
        all.enumerate().map(|(i, line)| format!("{i} {}\n", line.split_once(' ').unwrap().1));
    let rules = refused(&source, &machine, &numbered.collect::<String>());
    assert_eq!(rules, [("rapid-path", turn as u32 - 1)]);
}

/// Rapids in a pocket: up and over, down, and from one low place to another.
fn pocket() -> Program {
    read(
        "UNITS/MM\nLOADTL/1\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\nRAPID\nGOTO/0,0,50\nRAPID\nGOTO/0,0,2\nGOTO/0,0,-5\n\
         GOTO/40,0,-5\nRAPID\nGOTO/60,20,2\nGOTO/60,20,-5\nRAPID\nGOTO/0,20,-4\nRAPID\nGOTO/30,0,-4\nGOTO/30,0,-5\n\
         GOTO/0,0,0\nRAPID\nGOTO/0,0,50\nFINI\n",
    )
}

#[test]
fn where_each_axis_goes_at_its_own_speed_only_one_moves_near_the_part() {
    let source = pocket();
    let straight = load_text(
        "m.toml",
        "extends = \"generic-3axis-fanuc\"\n[settings]\nrapid_path = \"linear\"\n",
    )
    .unwrap();
    let at_once = plain(&text(&written(&source, &straight)));
    proven(&source, &straight, &at_once);
    assert!(
        at_once.contains("G0 X60. Y20. Z2.\n") && at_once.contains("G0 X0. Z-4.\nX30. Y0.\n"),
        "{at_once}"
    );
    let mut machine = load("generic-3axis-fanuc").unwrap();
    let high_feed = machine.settings.high_feed.take();
    let found = found(&source, &machine, &at_once);
    let rules: Vec<_> = found.iter().map(|found| (found.rule.name(), found.count)).collect();
    assert_eq!(rules, [("rapid-path", 3)], "{at_once}");
    let output = written(&source, &machine);
    let good = plain(&text(&output));
    proven(&source, &machine, &good);
    // Up first; where no height is beyond the cuts by feed, at the fastest that the source has.
    assert!(good.contains("G0 Z2.\nX60. Y20.\nG1 Z-5."), "{good}");
    assert!(good.contains("X0. Z-4.\nX30. Y0.\nZ-5.\n"), "{good}");
    let warnings: Vec<_> =
        output.warnings.iter().filter(|found| found.rule.name() == "rapid-path").collect();
    assert!(warnings.len() == 1 && warnings[0].message.contains("300 mm/min"), "{warnings:?}");
    // From X60 Y20 Z-5 to X0 Y20 Z-4 and on to X30 Y0: 60.01 mm and 36.06 mm, 19.2 s at F300.
    assert!(warnings[0].message.ends_with("together 0.10 m, 19 s"), "{warnings:?}");
    assert!(warnings[0].help.contains("high_feed") && warnings[0].count == 2, "{warnings:?}");
    // The machine file may say how fast the machine goes through the air there.
    assert_eq!(high_feed, Some(5000.0));
    let fast = Machine {
        settings: ControlSettings { high_feed, ..machine.settings.clone() },
        ..machine.clone()
    };
    let output = written(&source, &fast);
    let text = plain(&text(&output));
    proven(&source, &fast, &text);
    assert!(text.contains("X0. Z-4. F5000.\nX30. Y0.\nZ-5. F300.\n"), "{text}");
    let warning = output.warnings.iter().find(|found| found.rule.name() == "rapid-path").unwrap();
    assert!(
        warning.message.contains("5000 mm/min") && warning.message.ends_with("1 s"),
        "{warning}"
    );
    // A feed in place of a rapid that does not keep to the way is none.
    let aside = good.replace("X30. Y0.\nZ-5.", "X0. Y0.\nX30.\nZ-5.");
    assert_eq!(refused(&source, &machine, &aside)[0].0, "path");
    // Where rapids are straight, nobody asks for it.
    assert_eq!(refused(&source, &straight, &good)[0].0, "rapid-feed");
}

/// A wall at height 10, and three holes at height 0 whose cycle retracts to 2, in a plane with the tool along its Z: along its
/// X from the first to the second, aslant to the third.
fn holes_next_to_a_wall(retract: f64, [x, y, z]: [Vec3; 3]) -> Program {
    let at = |[a, b, c]: [f64; 3]| {
        let (p, axis) = (x * a + y * b + z * c, z);
        format!("GOTO/{:.6},{:.6},{:.6},{:.8},{:.8},{:.8}\n", p.x, p.y, p.z, axis.x, axis.y, axis.z)
    };
    let rapid = |to| format!("RAPID\n{}", at(to));
    let all = [
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,60\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\n"
            .to_owned(),
        rapid([-20.0, -20.0, 50.0]),
        rapid([-20.0, -20.0, 12.0]),
        at([-20.0, -20.0, 10.0]),
        at([60.0, -20.0, 10.0]),
        rapid([60.0, -20.0, 50.0]),
        rapid([0.0, 0.0, 50.0]),
        format!("CYCLE/DRILL,RAPTO,2,FEDTO,6,RTRCTO,{retract},MMPM,150\n"),
        at([0.0; 3]),
        at([40.0, 0.0, 0.0]),
        at([0.0, 30.0, 0.0]),
        "CYCLE/OFF\n".to_owned(),
        rapid([0.0, 30.0, 50.0]),
        "FINI\n".to_owned(),
    ];
    read(&all.concat())
}

const LEVEL: [Vec3; 3] = [Vec3::X, Vec3::Y, Vec3::Z];

/// Within a cycle the control goes across by rapid, in the height of the retract level: with each axis at its own speed first
/// by 45°, which no source asks for. 1 mm and the rounding above the wall there is room for that.
#[test]
fn between_holes_a_cycle_goes_across_beyond_all_cuts_or_along_one_axis() {
    let machine = load("generic-3axis-fanuc").unwrap();
    let linear = load_text(
        "m.toml",
        "extends = \"generic-3axis-fanuc\"\n[settings]\nrapid_path = \"linear\"\n",
    )
    .unwrap();
    let source = holes_next_to_a_wall(2.0, LEVEL);
    let straight = plain(&text(&written(&source, &linear)));
    proven(&source, &linear, &straight);
    assert!(straight.contains("\nX40. Y0.\nX0. Y30.\nG80\n"), "{straight}");
    let third = straight.lines().position(|line| line == "X0. Y30.").unwrap() as u32 + 1;
    assert_eq!(refused(&source, &machine, &straight), [("rapid-path", third)]);
    let good = plain(&text(&written(&source, &machine)));
    proven(&source, &machine, &good);
    assert!(good.contains("\nX40. Y0.\nG80\nG0 Z11.02\nX0. Y30.\nZ2.\n"), "{good}");
    // So high does the cycle retract by itself.
    let high = holes_next_to_a_wall(12.0, LEVEL);
    let good = plain(&text(&written(&high, &machine)));
    proven(&high, &machine, &good);
    assert!(good.contains("\nX40. Y0.\nX0. Y30.\nG80\n"), "{good}");
}

/// The same on a plane that is tilted by 45° about an axis aslant of X and Y: its X is none of the machine's.
#[test]
fn in_a_tilted_plane_a_cycle_goes_across_beyond_all_cuts_too() {
    let z = Vec3::new(0.5, 0.5, 0.5_f64.sqrt());
    let x = Vec3::new(0.5_f64.sqrt(), -(0.5_f64.sqrt()), 0.0);
    let source = holes_next_to_a_wall(2.0, [x, z.cross(x), z]);
    let linear = load("fanuc-table-bc").unwrap();
    let text_of = "extends = \"fanuc-table-bc\"\n[settings]\nrapid_path = \"independent\"\n";
    let machine = load_text("m.toml", text_of).unwrap();
    let straight = plain(&text(&written(&source, &linear)));
    proven(&source, &linear, &straight);
    let rules: Vec<_> = refused(&source, &machine, &straight);
    assert!(!rules.is_empty() && rules.iter().all(|(rule, _)| *rule == "rapid-path"), "{rules:?}");
    let good = plain(&text(&written(&source, &machine)));
    proven(&source, &machine, &good);
    assert!(good.matches("G80").count() >= straight.matches("G80").count(), "{good}");
}

#[test]
fn from_home_only_z_comes_down() {
    let source = read(
        "UNITS/MM\nLOADTL/1\nSPINDL/1000,RPM,CLW\nFEDRAT/300,MMPM\nRAPID\nGOTO/0,0,50\nGOTO/0,0,-5\nRAPID\nGOTO/0,0,50\n\
         LOADTL/2\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/60,20,-4\nGOTO/60,30,-5\nRAPID\nGOTO/60,30,50\nFINI\n",
    );
    let machine = load("generic-3axis-sinumerik").unwrap();
    let good = text(&written(&source, &machine));
    proven(&source, &machine, &good);
    let approach = good.lines().position(|line| line.contains("X60 Y20")).unwrap();
    let lines: Vec<&str> = good.lines().collect();
    assert!(lines[approach + 1].ends_with("Z-4"), "{good}");
    let mut all: Vec<String> = lines.iter().map(|&line| line.to_owned()).collect();
    all[approach] = all[approach].replace("Y20", "Y20 Z-4");
    all.remove(approach + 1);
    let line = approach as u32 + 1;
    assert_eq!(refused(&source, &machine, &(all.join("\n") + "\n")), [("rapid-path", line)]);
}

/// A head that turns about Y, and axes that go each at its own speed.
fn leaning_head() -> Machine {
    machine::load_text(
        "head.toml",
        "extends = \"fanuc-31i\"\n[orientation]\nsimultaneous = \"tool-center-angles\"\npositioned = \"tool-center-angles\"\n\
         tolerance = 0.005\n[settings]\nrapid_path = \"independent\"\nrotary_by_sign = false\ntool_radius = \"full\"\n\
         [axes]\nX = { min = -1400, max = 1400, rapid = 36000, acceleration = 4 }\nY = { min = -1400, max = 1400, rapid = 36000, acceleration = 4 }\n\
         Z = { min = -1400, max = 1400, rapid = 10000, acceleration = 4 }\n\
         [[rotary]]\nletter = \"B\"\non = \"head\"\naxis = [0, 1, 0]\npoint = [0, 0, 250]\nsign = -1\nmin = -110\nmax = 110\nrapid = 3600\nacceleration = 300\n",
    )
    .unwrap()
}

/// A head that leans the tool and axes that go each at its own speed: off its straight way the tool would cut the wall of the hole, though it is
/// beyond the bottom, which is all that a plunge cuts.
#[test]
fn a_hole_along_a_leaning_tool_is_left_and_entered_straight_where_each_axis_goes_at_its_own_speed()
{
    let machine = leaning_head();
    // Drilled from (105, 5) down to (40, -60), by a peck at (46, -54).
    let at = |place: &str| format!("GOTO/{place},0.70710678,0,0.70710678\n");
    let [top, above, peck, back, bottom] =
        ["145,0,45", "105,0,5", "46,0,-54", "100,0,0", "40,0,-60"].map(at);
    let source = read(&format!(
        "PARTNO/JOB\nUNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\n{top}RAPID\n{above}FEDRAT/MMPM,300\n{peck}\
         RAPID\n{back}RAPID\n{peck}{bottom}RAPID\n{peck}RAPID\n{top}SPINDL/OFF\nFINI\n"
    ));
    let text = text(&written(&source, &machine));
    proven(&source, &machine, &text);
    // The rapids of the source in the hole are written by feed; by rapid none of them is proven.
    none_is_proven(
        &source,
        &machine,
        &text,
        [
            ("N160 X100. Z0.\nN170 ", "N160 G0 X100. Z0.\nN170 G1 "),
            ("N170 X46. Z-54.\nN180 ", "N170 G0 X46. Z-54.\nN180 G1 "),
            ("N190 X46. Z-54.\nN200 ", "N190 G0 X46. Z-54.\nN200 G1 "),
            ("N200 X145. Z45.", "N200 G0 X145. Z45."),
        ],
    );
}

/// In a bore that was there before nothing is fed but at its bottom: no rapid in it begins or ends where a feed does, and off its straight
/// way each would lead the tool into the wall, though it is far beyond all cuts.
#[test]
fn further_rapids_in_a_bore_along_a_leaning_tool_are_straight_too() {
    let machine = leaning_head();
    let at = |place: &str| format!("GOTO/{place},0.70710678,0,0.70710678\n");
    // The bore leads from (105, 5) down to (40, -60); its bottom is milled along Y, from (42, -58) on.
    let [top, above, middle, over, bottom, beside] =
        ["145,0,45", "105,0,5", "70,0,-30", "42,0,-58", "40,0,-60", "40,8,-60"].map(at);
    let source = read(&format!(
        "PARTNO/JOB\nUNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\n{top}RAPID\n{above}RAPID\n{middle}\
         RAPID\n{over}FEDRAT/MMPM,300\n{bottom}{beside}{bottom}RAPID\n{over}RAPID\n{middle}RAPID\n{above}RAPID\n{top}SPINDL/OFF\nFINI\n"
    ));
    let text = text(&written(&source, &machine));
    proven(&source, &machine, &text);
    // They are written by feed; by rapid none of them is proven.
    none_is_proven(
        &source,
        &machine,
        &text,
        [
            ("N150 X70. Z-30.\nN160 ", "N150 G0 X70. Z-30.\nN160 G1 "),
            ("N160 X42. Z-58.\nN170 ", "N160 G0 X42. Z-58.\nN170 G1 "),
            ("N200 X42. Z-58.\nN210 ", "N200 G0 X42. Z-58.\nN210 G1 "),
            ("N210 X70. Z-30.\nN220 ", "N210 G0 X70. Z-30.\nN220 G1 "),
            ("N220 X105. Z5.\nN230 ", "N220 G0 X105. Z5.\nN230 G1 "),
            ("N230 X145. Z45.", "N230 G0 X145. Z45."),
        ],
    );
}

/// A pocket that was there before, wider at its top: at once X would be at the wall before Z is out.
#[test]
fn a_slanting_rapid_out_of_a_pocket_goes_up_first_where_each_axis_goes_at_its_own_speed() {
    let machine = machine::load_text(
        "plain.toml",
        "extends = \"generic-3axis-fanuc\"\n[settings]\nrapid_path = \"independent\"\n",
    )
    .unwrap();
    let source = read(
        "PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/0,0,60\nRAPID\nGOTO/0,0,-20\nFEDRAT/MMPM,300\n\
         GOTO/0,0,-30\nGOTO/4,0,-30\nRAPID\nGOTO/5,0,-20\nRAPID\nGOTO/60,0,40\nSPINDL/OFF\nFINI\n",
    );
    let text = text(&written(&source, &machine));
    let up_first = text.lines().position(|line| line.ends_with(" Z40.")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[up_first + 1].ends_with(" X60."), "{text}");
    let at_once = text.replacen(&format!("{}\n", lines[up_first]), "", 1);
    let at_once = at_once.replacen(" X60.", " G0 X60. Z40.", 1);
    assert_eq!(refused(&source, &machine, &at_once), [("rapid-path", up_first as u32 + 1)]);
}

/// The first place is in a bore that was there before; the source leaves it upwards, to Z 65. Where X, Y and Z come from home in one block, they come
/// to there: to Z -20 each axis would go at its own speed, or all together aslant.
#[test]
fn from_home_into_a_bore_the_tool_comes_from_as_high_as_the_source_goes() {
    let source = read(
        "PARTNO/JOB\nUNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nRAPID\nGOTO/100,50,-20,0,0,1\n\
         FEDRAT/MMPM,300\nGOTO/100,50,-30\nRAPID\nGOTO/100,50,-20\nRAPID\nGOTO/100,50,65\nSPINDL/OFF\nFINI\n",
    );
    let machine = leaning_head();
    let good = text(&written(&source, &machine));
    let report = proof::prove(&source, &machine, "job.nc", good.as_bytes(), &Default::default());
    assert!(report.proven, "{:#?}\n{good}", report.mismatches);
    let own = "X100. Y50. Z65. H1\nN130 Z-20.\n";
    assert!(good.contains(own), "{good}");
    for (low, line) in [("Z-20.", 14), ("Z64.9", 14)] {
        let other = good.replacen("Z65. H1", &format!("{low} H1"), 1);
        assert_eq!(refused(&source, &machine, &other).first(), Some(&("rapid-path", line)));
    }
}

/// A pocket that was there before, its floor at Z -38, and two holes in it: each axis at its own speed led the tool up to 18.6 mm beside the
/// straight line of 50 by 20 mm. With the zero of the part at the floor nothing tells it from clearance above a part.
#[test]
fn across_on_the_floor_of_a_pocket_the_tool_goes_straight() {
    let machine = load("generic-3axis-fanuc").unwrap();
    let source = |floor: f64| {
        let [top, deep] = [floor + 103.0, floor - 22.0];
        read(&format!(
            "PARTNO/JOB\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFEDRAT/300,MMPM\nRAPID\nGOTO/10,10,{top}\nRAPID\nGOTO/10,10,{floor}\n\
             GOTO/10,10,{deep}\nRAPID\nGOTO/10,10,{floor}\nRAPID\nGOTO/60,30,{floor}\nGOTO/60,30,{deep}\nRAPID\nGOTO/60,30,{top}\nFINI\n"
        ))
    };
    let job = source(-38.0);
    let output = written(&job, &machine);
    let good = plain(&text(&output));
    proven(&job, &machine, &good);
    assert!(good.contains("G0 Z-38.\nG1 X60. Y30. F5000.\n"), "{good}");
    assert!(output.warnings.iter().any(|found| found.rule.name() == "rapid-path"), "{good}");
    let at_once = good.replacen("G1 X60. Y30. F5000.\n", "X60. Y30.\nG1 ", 1);
    assert_eq!(refused(&job, &machine, &at_once).first().map(|found| found.0), Some("rapid-path"));
    // Above the zero of the part each axis may go as it likes.
    let over = good.replacen("G1 X60. Y30. F5000.\n", "Z0.\nX60. Y30.\nZ-38.\nG1 ", 1);
    proven(&job, &machine, &over);
    let low = over.replacen("Z0.\nX60. Y30.", "Z-0.2\nX60. Y30.", 1);
    assert_eq!(refused(&job, &machine, &low).first().map(|found| found.0), Some("rapid-path"));
    let clear = source(2.0);
    let good = plain(&text(&written(&clear, &machine)));
    proven(&clear, &machine, &good);
    assert!(good.contains("G0 Z2.\nX60. Y30.\nG1 Z-20."), "{good}");
}

/// A bore along a leaning tool that was there before, in which the toolpath begins and ends, or changes its tool: the way along the tool, from as
/// high as the toolpath ever goes and out to there, is by feed, which is straight.
#[test]
fn from_home_and_to_home_along_a_leaning_tool_the_way_is_straight() {
    let machine = leaning_head();
    // Upwards of Z 20 nobody goes: (100, 0, 20) is 80 times the root of 2 above the bottom at (20, 0, -60).
    let at = |place: &str| format!("GOTO/{place},0.70710678,0,0.70710678\n");
    let [top, in_bore, bottom] = ["100,0,20", "40,0,-40", "20,0,-60"].map(at);
    let head = "PARTNO/JOB\nUNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,50\nSPINDL/RPM,9000,CLW\nFEDRAT/MMPM,300\n";
    let change = "LOADTL/2,LENGTH,60\nSPINDL/RPM,9000,CLW\n";
    let source = read(&format!(
        "{head}RAPID\n{in_bore}{bottom}{change}RAPID\n{in_bore}{bottom}RAPID\n{top}RAPID\n{in_bore}{bottom}FINI\n"
    ));
    let good = plain(&text(&written(&source, &machine)));
    proven(&source, &machine, &good);
    let (enters, leaves) = (
        "X100. Y0. Z20. H1\nG1 X40. Z-40. F300.\nX20. Z-60.\n",
        "X20. Z-60.\nX100. Z20.\nG91 G28 Z0\n",
    );
    assert!(good.contains(enters) && good.matches(leaves).count() == 2, "{good}");
    none_is_proven(
        &source,
        &machine,
        &good,
        [
            (enters, "X100. Y0. Z20. H1\nX40. Z-40.\nG1 X20. Z-60. F300.\n"),
            (enters, "X40. Y0. Z-40. H1\nG1 X20. Z-60. F300.\n"),
            (leaves, "X20. Z-60.\nG0 X100. Z20.\nG91 G28 Z0\n"),
            (leaves, "X20. Z-60.\nX99. Z19.\nG91 G28 Z0\n"),
            (leaves, "X20. Z-60.\nG91 G28 Z0\n"),
        ],
    );
    // Where rapids are straight, nobody asks for it.
    let straight = Machine {
        settings: ControlSettings {
            rapid_path: Some(machine::RapidPath::Linear),
            ..machine.settings.clone()
        },
        ..machine.clone()
    };
    assert!(!found(&source, &straight, &good).is_empty());
}

/// A rotary word that is rounded leans the tool by up to 0.0005°, which is more than the rounding of a length where the highest place of
/// the source is far away: 50 mm to the side, the height at which the tool may come from home differs by 0.0004 mm.
#[test]
fn the_tool_comes_from_home_as_high_as_its_rounded_angles_ask_for() {
    let source = read(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,60\nRAPID\nGOTO/46.4701,-39.5908,55.9488,-0.1846029,-0.1531830,0.9708021\n\
         SPINDL/3000,RPM,CLW\nFEDRAT/200,MMPM\nRAPID\nGOTO/29.6725,33.4741,53.3834,-0.1502332,0.0688155,0.9862527\n\
         GOTO/30.8694,38.1385,8.5573,-0.2155986,0.0272328,0.9761023\nRAPID\n\
         GOTO/-34.0924,26.8618,3.0623,0.4274968,0.0268617,0.9036177\nFINI\n",
    );
    for name in ["linuxcnc-xyzac", "linuxcnc-xyzbc", "haas-umc-750", "dmu50-heidenhain"] {
        let machine = load(name).unwrap();
        let output = written(&source, &machine);
        proven(&source, &machine, &text(&output));
    }
}

/// PM19 p. 181: with TRAORI rapids are straight, also where MD20730 is 0. So the tool is drawn back and brought in again by rapid where
/// the travel of an axis ends in a cut, and rapids near the part are rapids.
#[test]
fn under_traori_a_rapid_is_straight_whatever_the_axes_do_without() {
    let apart = "extends = \"sinumerik-840d-traori\"\n[settings]\nrapid_path = \"independent\"\n";
    let apart = load_text("apart.toml", apart).unwrap();
    let source = read(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,60\nSPINDL/1000,RPM,CLW\nFEDRAT/200,MMPM\n\
         RAPID\nGOTO/-24.7027,18.7882,71.4794,-0.0852832,-0.0066342,0.9963347\n\
         GOTO/-19.5857,19.1863,11.6993\nGOTO/-56.4949,7.2801,12.3344,0.0912560,-0.0730376,0.9931454\n\
         GOTO/-68.7291,-3.5677,12.2351,-0.0288811,-0.0618227,0.9976692\n\
         GOTO/-66.0328,9.1400,12.1846,-0.2314535,-0.0691443,0.9703857\nRAPID\nGOTO/-79.9200,4.9913,70.4077\nFINI\n",
    );
    let together = load("sinumerik-840d-traori").unwrap();
    let (output, other) = (written(&source, &apart), written(&source, &together));
    let program = text(&output);
    proven(&source, &apart, &program);
    assert!(output.warnings.iter().any(|found| found.rule.name() == "rewind"), "{program}");
    assert_eq!(program, text(&other));
}

/// The words of a program round a tool axis to both sides of 60°, where a tool counts as one that stands.
#[test]
fn a_tool_that_leans_by_just_60_degrees_comes_from_home() {
    let source = read(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,50\nSPINDL/RPM,5000,CLW\nFEDRAT/MMPM,300\nRAPID\n\
         GOTO/115.7471,41.1387,67.0000,0.8365163,0.2241439,0.5000000\n\
         GOTO/2.3130,-40.4670,119.4420,0.1109416,-0.3538913,0.9286834\nRAPID\nGOTO/2.3130,-40.4670,150,0.1109416,-0.3538913,0.9286834\nFINI\n",
    );
    for name in ["fanuc-table-bc", "haas-umc-750", "linuxcnc-xyzac", "linuxcnc-xyzbc"] {
        let machine = load(name).unwrap();
        proven(&source, &machine, &text(&written(&source, &machine)));
    }
}

/// A tool that leans by more than 60° in a head comes from home beside all cuts: to over its place along Z of the machine, where all axes may go
/// together, and by Z alone down to as far out along itself as the source ever goes. That is free where each axis goes at its own speed too.
#[test]
fn by_z_of_the_machine_a_leaning_tool_comes_down_where_it_is_free_along_itself() {
    let apart = "extends = \"sinumerik-840d-traori\"\n[settings]\nrapid_path = \"independent\"\n";
    let apart = load_text("apart.toml", apart).unwrap();
    let source = read(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,120\nSPINDL/1000,RPM,CLW\nFEDRAT/600,MMPM\nRAPID\n\
         GOTO/-35.0043,-39.8946,-3.6492,-0.8527891,-0.3208662,0.4120626\n\
         GOTO/-26.4764,-36.6859,-7.7698\nFINI\n",
    );
    for machine in [apart, load("sinumerik-840d-traori").unwrap()] {
        let good = plain(&text(&written(&source, &machine)));
        proven(&source, &machine, &good);
        let way = "G0 X2.763 Y-31.348 Z44.655\nX0.166 Y-33.719 Z43.064\n";
        none_is_proven(
            &source,
            &machine,
            &good,
            [
                (way, "G0 X0.166 Y-33.719 Z43.064\n"),
                (way, "G0 X2.763 Y-31.348 Z43.064\nX0.166 Y-33.719 Z43.064\n"),
            ],
        );
    }
}

/// From a stop above all cuts a rapid slants down to a place next to them, which is the end of the source's rapid: both ends are where they
/// may be, and between them the tool is off the line and lower than the boss that is cut first (its top at Z 30).
#[test]
fn a_rapid_from_a_free_place_to_one_on_the_line_is_looked_at_between_them() {
    let source = read(
        "UNITS/MM\nLOADTL/1,LENGTH,60\nSPINDL/1000,RPM,CLW\nFEDRAT/600,MMPM\nRAPID\nGOTO/-100,0,50\nGOTO/-100,0,30\n\
         RAPID\nGOTO/-100,0,80\nRAPID\nGOTO/0,0,80\nRAPID\nGOTO/50,100,0\nGOTO/50,100,-5\nRAPID\nGOTO/50,100,80\nFINI\n",
    );
    let straight = load("generic-3axis-linuxcnc").unwrap();
    let good = text(&written(&source, &straight));
    proven(&source, &straight, &good);
    let way = "X50 Y100 Z0\n";
    none_is_proven(&source, &straight, &good, [(way, "X50\nY100 Z0\n"), (way, "Y100\nX50 Z0\n")]);
    proven(&source, &straight, &good.replacen(way, "X50 Y100\nZ0\n", 1));
}

/// A bore along a leaning tool that was there before: the toolpath goes straight down it by rapid, to where it is fed on along the tool, and from
/// that place back.
fn along_a_bore() -> Program {
    read(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,60\nSPINDL/1000,RPM,CLW\nFEDRAT/600,MMPM\n\
         RAPID\nGOTO/100,0,60,0.70710678,0,0.70710678\nRAPID\nGOTO/40,0,0\nGOTO/20,0,-20\n\
         GOTO/21,0,-20,0.71,0,0.7042\nGOTO/20,0,-20,0.70710678,0,0.70710678\nGOTO/40,0,0\nRAPID\nGOTO/100,0,60\nFINI\n",
    )
}

/// Where rapids are straight, a program may still go axis by axis, or in the order that whoever edits it likes. Beyond all cuts, which
/// a plunge is at its bottom alone, the tool is in the wall of the bore all the same.
#[test]
fn beside_a_bore_along_a_leaning_tool_no_straight_rapid_goes_axis_by_axis() {
    let source = along_a_bore();
    let control = |name: &str, words: &str| {
        let machine = load(name).unwrap();
        let own = plain(&text(&written(&source, &machine)));
        proven(&source, &machine, &own);
        assert!(own.contains(words), "{own}");
        (machine, own)
    };
    let (machine, own) = control("linuxcnc-xyzbc-head", "\nX40 Z0\n");
    let (into, out) = ("\nX40 Z0\n", "\nG0 X100 Z60\n");
    let changes = [
        (into, "\nX40\nZ0\n"),
        (into, "\nZ0\nX40\n"),
        // From farther out along the tool, which is no way of the source either.
        (into, "\nX140 Z100\nX40\nZ0\n"),
        (out, "\nG0 X100\nZ60\n"),
        (out, "\nG0 Z60\nX100\n"),
    ];
    none_is_proven(&source, &machine, &own, changes);
    // On the way along the tool it may stop, and begin farther out.
    for (block, good) in [
        (into, "\nX70 Z30\nX40 Z0\n"),
        (into, "\nX140 Z100\nX40 Z0\n"),
        (out, "\nG0 X60 Z20\nX100 Z60\n"),
    ] {
        proven(&source, &machine, &own.replacen(block, good, 1));
    }
    let (machine, own) = control("fanuc-table-bc", "\nX40. Z0.\n");
    let changes = [("\nX40. Z0.\n", "\nX40.\nZ0.\n"), ("\nX40. Z0.\n", "\nZ0.\nX40.\n")];
    none_is_proven(&source, &machine, &own, changes);
    let (machine, own) = control("sinumerik-840d-traori", "\nX40 Z0 A3=");
    let changes = [("\nX40 Z0 A3=", "\nX40\nZ0 A3="), ("\nX40 Z0 A3=", "\nZ0\nX40 A3=")];
    none_is_proven(&source, &machine, &own, changes);
}

/// The same where the bore is the first place behind home: there is no way of the source besides.
#[test]
fn from_home_into_a_bore_along_a_leaning_tool_no_straight_rapid_goes_axis_by_axis() {
    let source = read(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,60\nSPINDL/1000,RPM,CLW\nFEDRAT/600,MMPM\n\
         RAPID\nGOTO/40,0,0,0.70710678,0,0.70710678\nGOTO/20,0,-20\nGOTO/21,0,-20\nRAPID\nGOTO/101,0,60\nFINI\n",
    );
    let machine = load("linuxcnc-xyzbc-head").unwrap();
    let own = plain(&text(&written(&source, &machine)));
    proven(&source, &machine, &own);
    let into = "\nX40 Z0\n";
    let changes = [(into, "\nX40\nZ0\n"), (into, "\nZ0\nX40\n")];
    none_is_proven(&source, &machine, &own, changes);
    proven(&source, &machine, &own.replacen(into, "\nX70 Z30\nX40 Z0\n", 1));
}

/// With the tool along Z it may stop beside the way of the source above the zero of the part; below that there may be a pocket.
#[test]
fn an_upright_tool_goes_axis_by_axis_above_the_zero_of_the_part() {
    let job = |low: i32| {
        read(&format!(
            "UNITS/MM\nLOADTL/1,LENGTH,60\nSPINDL/1000,RPM,CLW\nFEDRAT/600,MMPM\nRAPID\nGOTO/100,0,60\n\
             RAPID\nGOTO/40,0,{low}\nGOTO/40,0,-20\nGOTO/41,0,-20\nRAPID\nGOTO/41,0,60\nFINI\n"
        ))
    };
    let machine = load("linuxcnc-mill").unwrap();
    for low in [-5, 2] {
        let source = job(low);
        let own = plain(&text(&written(&source, &machine)));
        let into = format!("\nX40 Z{low}\n");
        assert!(own.contains(&into), "{own}");
        let [across, down] = [format!("\nX40\nZ{low}\n"), format!("\nZ{low}\nX40\n")]
            .map(|by| own.replacen(&into, &by, 1));
        proven(&source, &machine, &across);
        match low < 0 {
            true => assert!(
                refused(&source, &machine, &down).iter().any(|(rule, _)| *rule == "rapid-path")
            ),
            false => proven(&source, &machine, &down),
        }
    }
}
