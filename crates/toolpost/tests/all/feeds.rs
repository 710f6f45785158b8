//! F is what the control makes of it: the tool tip goes over the part at the feed of the source, also where rotary axes turn
//! and the control counts their degrees. Programs are read here by words and kinematics of this page alone.

use geom::Vec3;
use machine::{Machine, load, load_text};
use program::{Feed, Op, Pose, Program, Spindle, Tool};

/// What F of a control counts in a cut with rotary axes, by its manual.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Counts {
    /// All axes together, a degree as a mm.
    All,
    /// X, Y and Z; where these stand still, degrees.
    Linear,
    /// The time of the block.
    Time,
}

/// A table that tilts by A about X and turns by C about Z on it, both axes through the work zero, on this control.
fn table(control: &str, more: &str) -> Machine {
    let text = format!(
        "extends = \"{control}\"\nsafe_height = 800\nwork_zero = [0, 0, 0]\n{more}\n\
         [orientation]\nsimultaneous = \"machine-angles\"\npositioned = \"machine-angles\"\ntolerance = 0.005\n[axes]\n\
         X = {{ min = -3000, max = 3000, rapid = 24000, acceleration = 3 }}\n\
         Y = {{ min = -3000, max = 3000, rapid = 24000, acceleration = 3 }}\n\
         Z = {{ min = -3000, max = 3000, rapid = 20000, acceleration = 3 }}\n\
         [[rotary]]\nletter = \"A\"\non = \"table\"\naxis = [1, 0, 0]\npoint = [0, 0, 0]\nmin = -30\nmax = 120\n\
         rapid = 5400\nacceleration = 300\n\
         [[rotary]]\nletter = \"C\"\non = \"table\"\naxis = [0, 0, 1]\npoint = [0, 0, 0]\nsign = -1\nmodulo = false\n\
         rapid = 7200\nacceleration = 400\n"
    );
    load_text("table.toml", &text).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

/// Each family of controls, how it is written, and what its F counts.
fn machines() -> Vec<(&'static str, Machine, Counts)> {
    let without_time = |way: &str| {
        format!("[settings]\nrotary_feed = \"{way}\"\n[capabilities]\ninverse_time = false")
    };
    let fanuc =
        "[settings]\nlength_moves_axis = false\nlength_along_z = true\nrapid_path = \"linear\"";
    let by_minute = "rotary_feed = \"all-axes\"\n[capabilities]\ninverse_time = false";
    vec![
        ("sinumerik-840d-table-ac", load("sinumerik-840d-table-ac").unwrap(), Counts::All),
        ("SINUMERIK", table("sinumerik-840d", ""), Counts::Time),
        ("HEIDENHAIN", table("heidenhain-tnc640", ""), Counts::All),
        ("FANUC", table("fanuc-31i", fanuc), Counts::Time),
        ("FANUC, 1408#0 is 0", table("fanuc-31i", &format!("{fanuc}\n{by_minute}")), Counts::All),
        ("LinuxCNC", table("linuxcnc", ""), Counts::Time),
        ("LinuxCNC, G94", table("linuxcnc", &without_time("linear-axes")), Counts::Linear),
        ("Haas", table("haas", ""), Counts::Time),
    ]
}

fn start(feed: Feed) -> Vec<Op> {
    vec![
        Op::Tool(Box::new(Tool { number: 1, length: Some(100.0), ..Tool::default() })),
        Op::Spindle(Spindle::Clockwise(1000.0)),
        Op::Feed(feed),
    ]
}

/// A job: a rapid to the first of these tips and positions of A and C, and cuts along the others.
fn job(feed: Feed, points: impl IntoIterator<Item = (Vec3, f64, f64)>) -> Program {
    let machine = load("sinumerik-840d-table-ac").unwrap();
    let mut points =
        points.into_iter().map(|(tip, a, c)| Pose::new(tip, machine.axis_at([a, 0.0, c])).unwrap());
    let first = points.next().unwrap();
    let mut ops = start(feed);
    ops.push(Op::Rapid(first.at(first.point() + first.axis() * 50.0).unwrap()));
    ops.extend([Op::Rapid(first), Op::Line(first)]);
    ops.extend(points.map(Op::Line));
    let last = *ops.last().unwrap().pose().unwrap();
    ops.extend([Op::Rapid(last.at(last.point() + last.axis() * 50.0).unwrap()), Op::End]);
    let mut program = Program::new("feeds");
    for (line, op) in (1..).zip(ops) {
        program.push(line, op);
    }
    program
}

/// Around the middle of the table at a radius of 200 mm, the tool leaning by 30°: C turns the part under a tool that stands.
fn at_r_200(feed: Feed) -> Program {
    let point = |i: i32| {
        let c = f64::from(i);
        let (sin, cos) = c.to_radians().sin_cos();
        (Vec3::new(200.0 * sin, 200.0 * cos, 0.0), 30.0, -c)
    };
    job(feed, (0..=30).map(point))
}

/// Past the middle of the table, the tool leaning by 2° in a direction that turns by 180°.
fn near_the_pole(feed: Feed) -> Program {
    let point = |i: i32| (Vec3::new(-2.0 + 0.4 * f64::from(i), 0.5, 0.0), 2.0, 18.0 * f64::from(i));
    job(feed, (0..=10).map(point))
}

/// The number behind `letter` in a block.
fn word(block: &str, letter: char) -> Option<f64> {
    let mut rest = block;
    while let Some(at) = rest.find(letter) {
        rest = &rest[at + 1..];
        let number = rest.trim_start_matches('=').trim_start_matches('+');
        let end = number.find(|c: char| c != '-' && c != '.' && !c.is_ascii_digit());
        if let Ok(value) = number[..end.unwrap_or(number.len())].parse() {
            return Some(value);
        }
    }
    None
}

/// Where the tip is on the part.
fn tip([x, y, z, a, c]: [f64; 5]) -> Vec3 {
    let (sin, cos) = a.to_radians().sin_cos();
    let (y, z) = (y * cos + z * sin, z * cos - y * sin);
    let (sin, cos) = c.to_radians().sin_cos();
    Vec3::new(x * cos - y * sin, x * sin + y * cos, z)
}

/// A cut of a program in which rotary axes turn.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// The block, from 0.
    line: usize,
    /// Path length of the tip, mm.
    way: f64,
    /// The number behind F.
    feed: f64,
    /// By F, minutes.
    time: f64,
    /// By the slowest axis at its rapid, minutes.
    least: f64,
}

/// The cuts in which rotary axes turn.
fn cuts(text: &str, counts: Counts) -> Vec<Cut> {
    let (mut at, mut rapid, mut feed, mut all) = ([f64::NAN; 5], true, f64::NAN, Vec::new());
    for (line, block) in text.lines().enumerate() {
        let block = match block.strip_prefix('N') {
            Some(rest) => rest.split_once(' ').map_or("", |(_, words)| words),
            None => block.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start(),
        };
        let words: Vec<&str> = block.split(' ').collect();
        let passes =
            ["FGROUP", "CYCL", "TOOL", "M91", "G28", "G75", "SUPA", "G53", "BLK", ";", "("];
        if passes.iter().any(|word| block.contains(word)) {
            continue;
        }
        let said = |word: &str| {
            words.iter().any(|said| {
                said.starts_with(word)
                    && !said[word.len()..].starts_with(|c: char| c.is_ascii_digit())
            })
        };
        rapid = if said("G0") || block.contains("FMAX") {
            true
        } else {
            rapid && !said("G1") && !block.starts_with("L ")
        };
        let values = ['X', 'Y', 'Z', 'A', 'C'].map(|letter| word(block, letter));
        feed = word(block, 'F').unwrap_or(feed);
        let from = at;
        for (at, value) in at.iter_mut().zip(values) {
            *at = value.unwrap_or(*at);
        }
        let by: [f64; 5] = std::array::from_fn(|i| at[i] - from[i]);
        // Not a number where a coordinate is not known yet.
        let turns = by[3].hypot(by[4]);
        let is_turning = turns > 0.0;
        if rapid || !is_turning {
            continue;
        }
        let linear = Vec3::new(by[0], by[1], by[2]).length();
        let counted = match counts {
            Counts::All => linear.hypot(turns),
            Counts::Linear if linear > 0.0 => linear,
            Counts::Linear => turns,
            Counts::Time => 1.0,
        };
        let rapids = [24000.0, 24000.0, 20000.0, 5400.0, 7200.0];
        let least = (0..5).map(|i| by[i].abs() / rapids[i]).fold(0.0, f64::max);
        let way = tip(from).distance(tip(at));
        all.push(Cut { line, way, feed, time: counted / feed, least });
    }
    all
}

fn written(source: &Program, machine: &Machine) -> (String, Vec<program::Diagnostic>) {
    let output = post::write(source, machine).unwrap_or_else(|found| panic!("{found:?}"));
    (String::from_utf8(output.text).unwrap(), output.warnings)
}

fn judged(source: &Program, machine: &Machine, text: &str) -> proof::Report {
    proof::prove(source, machine, "p", text.as_bytes(), &Default::default())
}

/// Each cut of the tip at `speed` mm/min, or as fast as its axes can. Answers the lowest and the highest speed.
#[track_caller]
fn goes_at(speed: f64, name: &str, cuts: &[Cut]) -> [f64; 2] {
    let mut range = [f64::INFINITY, 0.0f64];
    for cut in cuts {
        let wanted = (cut.way / speed).max(cut.least);
        // Half a step of each word at a radius of 200 mm, and of F.
        let rounding = 0.006 / cut.way + 0.05 / cut.feed + 0.006;
        assert!((cut.time / wanted - 1.0).abs() < rounding, "{name}: {cut:?}");
        range = [range[0].min(cut.way / cut.time), range[1].max(cut.way / cut.time)];
    }
    range
}

#[test]
fn the_tip_goes_at_the_feed_of_the_source_at_r_200_on_every_family_of_controls() {
    let source = at_r_200(Feed::PerMinute(1000.0));
    for (name, machine, counts) in machines() {
        let (text, warnings) = written(&source, &machine);
        let report = judged(&source, &machine, &text);
        assert!(report.proven, "{name}: {:?}\n{text}", report.mismatches);
        let cuts = cuts(&text, counts);
        let way: f64 = cuts.iter().map(|cut| cut.way).sum();
        assert!((way - 104.7).abs() < 0.1, "{name}: {way}\n{text}");
        let [low, high] = goes_at(1000.0, name, &cuts);
        // Where F counts what the linear axes do by rounding alone, its own rounding is large.
        let most = if counts == Counts::Linear { 25.0 } else { 1.5 };
        assert!(
            (low / 10.0 - 100.0).abs() < most && (high / 10.0 - 100.0).abs() < most,
            "{name}: {low} to {high}"
        );
        let worst = report.deviations.tip_speed_percent;
        assert!(worst.value > 0.0 && worst.value < most, "{name}: {worst:?}");
        assert!(warnings.iter().all(|found| found.rule != "feed-limited"));
        assert_eq!(report.compared.slowed, 0);
    }
}

#[test]
fn near_the_pole_the_tip_goes_at_the_feed_as_far_as_the_axes_can() {
    for feed in [1000.0, 60.0] {
        let source = near_the_pole(Feed::PerMinute(feed));
        for (name, machine, counts) in machines() {
            let (text, warnings) = written(&source, &machine);
            let report = judged(&source, &machine, &text);
            assert!(report.proven, "{name}: {:?}\n{text}", report.mismatches);
            let cuts = cuts(&text, counts);
            assert!(cuts.len() >= 10, "{name}");
            let [low, high] = goes_at(feed, name, &cuts);
            // C turns by 18° in 400 ms of 0.4 mm at F60; at F1000 in 24 ms it would have to do 45,000°/min.
            let limited = feed == 1000.0;
            assert_eq!(low < 0.3 * feed, limited, "{name}: {low}");
            assert!(high < 1.03 * feed, "{name}: {high}");
            let warned = warnings.iter().find(|found| found.rule == "feed-limited");
            assert_eq!(warned.is_some(), limited, "{name}");
            assert_eq!(report.compared.slowed > 0, limited, "{name}");
            if let Some(warned) = warned {
                assert!(warned.message.contains("C goes no faster"), "{warned}");
                assert!(warned.count >= 10, "{name}: {}", warned.count);
            }
        }
    }
}

/// F of the source in each block, as it was written before: at R 200 the tip goes 3.4 times as fast, near the pole at 2 % of
/// F.
#[test]
fn f_of_the_source_in_the_blocks_is_refused_where_the_control_counts_degrees() {
    for (source, factor) in [
        (at_r_200(Feed::PerMinute(1000.0)), 3.4..3.6),
        (near_the_pole(Feed::PerMinute(1000.0)), 0.013..0.03),
    ] {
        for (name, machine, counts) in machines() {
            // F1000 along X, Y and Z near the pole is more than C can follow, and less than the tip may go at.
            if counts == Counts::Time || (counts == Counts::Linear && factor.start < 1.0) {
                continue;
            }
            let (good, _) = written(&source, &machine);
            let bad: String = good
                .lines()
                .map(|line| {
                    match cuts(&good, counts)
                        .iter()
                        .any(|cut| good.lines().nth(cut.line) == Some(line))
                    {
                        true => with_feed(line, "1000") + "\n",
                        false => format!("{line}\n"),
                    }
                })
                .collect();
            let report = judged(&source, &machine, &bad);
            assert!(report.mismatches.iter().any(|found| found.rule == "feed"), "{name}\n{bad}");
            let speeds = cuts(&bad, counts).into_iter().map(|cut| cut.way / cut.time / 1000.0);
            let worst = speeds.max_by(|a, b| a.ln().abs().total_cmp(&b.ln().abs())).unwrap();
            assert!(counts != Counts::All || factor.contains(&worst), "{name}: {worst}");
        }
    }
}

/// A block with another number behind F.
fn with_feed(block: &str, feed: &str) -> String {
    let Some(at) = block.find('F') else { return block.to_owned() };
    let end = block[at + 1..].find(|c: char| c != '.' && !c.is_ascii_digit());
    let rest = end.map_or("", |end| &block[at + 1 + end..]);
    format!("{}F{feed}{rest}", &block[..at])
}

/// Where the file forbids inverse time and does not say what F counts, nobody can write it.
#[test]
fn a_machine_that_does_not_say_what_f_counts_is_refused_with_the_key() {
    let machine = table("fanuc-31i", "[capabilities]\ninverse_time = false");
    let found = post::write(&at_r_200(Feed::PerMinute(1000.0)), &machine).err().unwrap();
    assert!(found[0].rule == "rotary-feed" && found[0].help.contains("rotary_feed"), "{found:?}");
}

/// FANUC counts X, Y and Z alone nowhere: the judge knows a LinuxCNC by its manual.
#[test]
fn a_machine_file_that_says_otherwise_than_the_manual_makes_no_proven_program() {
    let more = "[settings]\nrotary_feed = \"all-axes\"\n[capabilities]\ninverse_time = false";
    let machine = table("linuxcnc", more);
    let source = at_r_200(Feed::PerMinute(1000.0));
    let (text, _) = written(&source, &machine);
    assert!(judged(&source, &machine, &text).mismatches.iter().any(|found| found.rule == "feed"));
}

/// A feed in inverse time of the source, and one above `feed_max` by what F would have to count.
#[test]
fn other_feeds_of_the_source_and_the_most_f_are_kept_too() {
    let source = at_r_200(Feed::InverseTime(1000.0 / 3.490_62));
    for (name, machine, counts) in machines() {
        let (text, _) = written(&source, &machine);
        let report = judged(&source, &machine, &text);
        assert!(report.proven, "{name}: {:?}\n{text}", report.mismatches);
        goes_at(1000.0, name, &cuts(&text, counts));
    }
    let mut machine = load("sinumerik-840d-table-ac").unwrap();
    machine.feed_max = 300.0;
    let source = near_the_pole(Feed::PerMinute(60.0));
    let (text, warnings) = written(&source, &machine);
    assert!(warnings.iter().any(|found| found.message.contains("F is 300 at the most")));
    let report = judged(&source, &machine, &text);
    assert!(report.proven, "{:?}", report.mismatches);
    assert!(report.compared.slowed > 0);
    assert!(cuts(&text, Counts::All).iter().all(|cut| cut.way / cut.time < 61.0));
}

/// A program whose F counts degrees, read as a source: the cuts take as long on another machine.
#[test]
fn a_program_that_counts_degrees_is_read_with_the_speed_of_its_tip() {
    let source = at_r_200(Feed::PerMinute(1000.0));
    let machine = load("sinumerik-840d-table-ac").unwrap();
    let (text, _) = written(&source, &machine);
    let read = nc::read(&machine, control::Setup::default(), "p.mpf", text.as_bytes()).unwrap();
    for (name, other, counts) in machines() {
        let (again, _) = written(&read.program, &other);
        let report = judged(&read.program, &other, &again);
        assert!(report.proven, "{name}: {:?}", report.mismatches);
        goes_at(1000.0, name, &cuts(&again, counts));
    }
    // FANUC in G94: nobody knows, and it is said.
    let fanuc = table("fanuc-31i", "[settings]\nlength_moves_axis = false\nlength_along_z = true");
    let text = "%\nO1\nG21\nG90 G94 G17 G54\nT1 M6\nS1000 M3\nG91 G28 Z0\nG90\nG0 A0 C0\nG43 H1 Z50.\nG0 X200. Y0\nG1 Z0 F1000\nG1 C1.\nM30\n%\n";
    let read = nc::read(&fanuc, control::Setup::default(), "p.nc", text.as_bytes()).unwrap();
    assert!(read.warnings.iter().any(|found| found.rule == "rotary-feed"), "{:?}", read.warnings);
}
