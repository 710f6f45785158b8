//! Poles and ends of travels: where an axis is free the tool stands while it turns, and is drawn back nowhere but where a travel
//! ends.

use geom::{Vec3, angle_between};
use machine::{Machine, load, load_text};
use program::{Feed, Op, Pose, Program, Spindle, Tool};

/// A tool axis that leans by `tilt` degrees towards `azimuth`.
fn leaning(tilt: f64, azimuth: f64) -> Vec3 {
    let (tilt, azimuth) = (tilt.to_radians(), azimuth.to_radians());
    Vec3::new(tilt.sin() * azimuth.cos(), tilt.sin() * azimuth.sin(), tilt.cos()).normalize()
}

/// A cut along X in 10 mm from one tool axis (tilt and azimuth, degrees) to the next, from above and away again.
fn cut(axes: &[(f64, f64)]) -> Program {
    let mut program = Program::new("poles");
    let tool = Tool { number: 1, length: Some(100.0), ..Tool::default() };
    let mut ops = vec![
        Op::Tool(Box::new(tool)),
        Op::Spindle(Spindle::Clockwise(1000.0)),
        Op::Feed(Feed::PerMinute(300.0)),
    ];
    let place = |i: usize, height: f64| {
        let axis = leaning(axes[i].0, axes[i].1);
        Pose::new(Vec3::new(10.0 * i as f64, 5.0, 0.0) + axis * height, axis).unwrap()
    };
    ops.push(Op::Rapid(place(0, 60.0)));
    ops.extend((0..axes.len()).map(|i| Op::Line(place(i, 0.0))));
    ops.push(Op::Rapid(place(axes.len() - 1, 60.0)));
    for (line, op) in (1..).zip(ops) {
        program.push(line, op);
    }
    program
}

/// The proven program, and the rules of its warnings.
#[track_caller]
fn made(source: &Program, machine: &Machine) -> (String, Vec<&'static str>) {
    let output = post::write(source, machine).unwrap_or_else(|found| panic!("{found:?}"));
    let report = proof::prove(source, machine, "p", &output.text, &Default::default());
    let text = String::from_utf8(output.text).unwrap();
    assert!(report.proven, "{:#?}\n{text}", report.mismatches);
    (text, output.warnings.iter().map(|found| found.rule.name()).collect())
}

/// The blocks that turn rotary axes, as degrees of B and C that each says: of a HEIDENHAIN under `M128`.
fn turns(text: &str) -> Vec<[Option<f64>; 2]> {
    let word = |block: &str, letter: char| {
        let word = block.split(' ').find(|word| word.starts_with(letter) && word.len() > 1)?;
        word[1..].parse().ok()
    };
    // Behind the last cut the table goes home.
    let cuts = text.lines().take_while(|line| !line.ends_with("M129") || line.starts_with("2 "));
    let all = cuts.map(|line| ['B', 'C'].map(|letter| word(line, letter)));
    all.filter(|turn| turn.iter().any(Option::is_some)).collect()
}

/// 120° through the pole: A goes to -30° only, so that C turns by 180° at the pole. It was drawn back before.
#[test]
fn a_cut_through_the_pole_turns_the_table_under_the_standing_tool() {
    for azimuth in [90.0, 37.0] {
        let source = cut(&[(60.0, azimuth), (60.0, azimuth + 180.0)]);
        for name in ["sinumerik-840d-table-ac", "dmu50-heidenhain"] {
            let (text, warnings) = made(&source, &load(name).unwrap());
            assert!(!warnings.contains(&"rewind"), "{name}: {warnings:?}\n{text}");
        }
    }
}

/// B of the table goes to -1° only. The tool was off its way by 6.9° in the first cut, by 1.28° in the second.
#[test]
fn a_pole_between_two_points_is_crossed_with_a_tilt_to_one_side() {
    let machine = load("dmu50-heidenhain").unwrap();
    made(&cut(&[(20.0, 90.0), (20.0, -90.0)]), &machine);
    let steps: Vec<_> = (0..12)
        .map(|i| (20.0 - f64::from(i) * 40.0 / 11.0, 0.0))
        .map(|(tilt, azimuth): (f64, f64)| (tilt.abs(), if tilt < 0.0 { 180.0 } else { azimuth }))
        .collect();
    let (text, _) = made(&cut(&steps), &machine);
    // C turns by itself at the pole: half a turn in two blocks.
    let alone: Vec<_> = turns(&text).into_iter().filter(|turn| turn[0].is_none()).collect();
    assert_eq!(alone.len(), 2, "{text}");
}

/// One rule for each job: in the pole itself C turns under the standing tool, or in the last rapid before; the tool is never
/// drawn back for it.
#[test]
fn in_the_pole_the_free_axis_turns_about_the_tool() {
    let machine = load("dmu50-heidenhain").unwrap();
    for axes in [
        &[(20.0, 0.0), (0.0, 0.0), (20.0, 90.0)][..],
        &[(20.0, 0.0), (0.0, 0.0), (0.0, 0.0), (20.0, 170.0)],
        &[(0.0, 0.0), (20.0, 0.0)],
        &[(20.0, 0.0), (0.0, 0.0), (20.0, 180.0)],
    ] {
        let (text, warnings) = made(&cut(axes), &machine);
        assert!(!warnings.contains(&"rewind"), "{axes:?}\n{text}");
        let mut last = [0.0; 2];
        let mut first = true;
        for turn in turns(&text) {
            let now = [0, 1].map(|i| turn[i].unwrap_or(last[i]));
            // What turns C by more than 10° in the cut leaves the tool where it stands.
            if !first && (now[1] - last[1]).abs() > 10.0 {
                let tool = |at: [f64; 2]| machine.axis_at([0.0, at[0], at[1]]);
                assert!(angle_between(tool(last), tool(now)) < 1e-6, "{axes:?}: {now:?}\n{text}");
            }
            (last, first) = (now, false);
        }
    }
}

/// With B near 180° of a nutating table the tool lies flat, and the words of B and C round it the same way. The proof took the
/// end of a cut for another place.
#[test]
fn near_the_end_of_a_nutating_axis_no_cut_is_missed() {
    let machine = load("dmu50-heidenhain").unwrap();
    let tilt = |i: u32| 85.0 + 4.9 * (f64::from(i) * 0.618_034).fract();
    let axes: Vec<_> = (0..300).map(|i| (tilt(i), 30.0 + 0.31 * f64::from(i))).collect();
    made(&cut(&axes), &machine);
}

/// Two turns of C on a table that has no more than one either way.
#[test]
fn a_rewind_under_tool_centre_control_comes_back_to_where_it_left() {
    let text = "extends = \"dmu50-heidenhain\"\n[[rotary]]\nletter = \"B\"\non = \"table\"\naxis = [0, 1, 1]\nmin = -1\nmax = 181\n\
                rapid = 7200\nacceleration = 300\n[[rotary]]\nletter = \"C\"\non = \"table\"\naxis = [0, 0, 1]\nsign = -1\n\
                min = -360\nmax = 360\nrapid = 10800\nacceleration = 400\n";
    let machine = load_text("counting.toml", text).unwrap();
    let around: Vec<_> = (0..=110).map(|i| (40.0, 12.0 * f64::from(i))).collect();
    let (_, warnings) = made(&cut(&around), &machine);
    assert!(warnings.contains(&"rewind"), "{warnings:?}");
    let dome =
        std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/dome.cls")).unwrap();
    let dome = source::apt::read("dome.cls", &dome, &Default::default()).unwrap().program;
    assert!(made(&dome, &machine).1.contains(&"rewind"));
}

/// The fork head of the library: its pole is Z. From 20° on one side to 20° on the other, 5.3° and 12° aside of the diameter:
/// tan 20° sin 2.65° is the tangent of 0.96°, and of 2.18° at 6°. MD24530 is 2° as delivered.
#[test]
fn a_vector_past_the_pole_within_two_degrees_is_refused_before_it_is_written() {
    let machine = load("sinumerik-840d-traori").unwrap();
    let past = |azimuth: f64| post::write(&cut(&[(20.0, 10.0), (20.0, azimuth)]), &machine);
    let refused = |azimuth: f64| past(azimuth).err().map(|found| found[0].rule.name());
    assert_eq!(refused(184.7), Some("pole-way"));
    assert_eq!(refused(195.3), Some("pole-way"));
    for azimuth in [178.0, 190.0, 202.0] {
        let source = cut(&[(20.0, 10.0), (20.0, azimuth)]);
        let output = post::write(&source, &machine).unwrap_or_else(|found| panic!("{found:?}"));
        let report = proof::prove(&source, &machine, "p", &output.text, &Default::default());
        assert!(report.proven, "{azimuth}: {:?}", report.mismatches);
    }
    // The way out that it names: farther round the pole.
    made(&cut(&[(20.0, 10.0), (6.0, 97.0), (20.0, 184.7)]), &machine);
}
