//! Tilted planes and travels: which of two solutions the control takes, and that each is within the travel of every axis.

use machine::{Machine, load, load_text};
use program::{Diagnostic, Program};

/// A table that tilts about X by A and turns by C on it, the centre 60 mm below the work zero, with this control.
fn table(control: &str, top: &str, settings: &str, a: &str, slides: [f64; 3]) -> Machine {
    let slide = |letter, most: f64| {
        format!("{letter} = {{ min = -{most}, max = {most}, rapid = 9000, acceleration = 3 }}\n")
    };
    let [x, y, z] = slides;
    let axes = slide('X', x) + &slide('Y', y) + &slide('Z', z);
    let axis = |letter, axis, more: &str| {
        format!(
            "[[rotary]]\nletter = \"{letter}\"\non = \"table\"\naxis = {axis}\npoint = [0, 0, -60]\nsign = -1\n{more}\n\
             rapid = 9000\nacceleration = 300\n"
        )
    };
    let text = format!(
        "extends = \"{control}\"\nsafe_height = {z}\n{top}\n[settings]\nrapid_path = \"linear\"\ntable_frame_at_zero = true\n{settings}\n\
         [orientation]\nsimultaneous = \"tool-center-angles\"\npositioned = \"tilted-plane\"\ntolerance = 0.01\n\
         [axes]\n{axes}{}{}",
        axis("A", "[1, 0, 0]", a),
        axis("C", "[0, 0, 1]", "modulo = false")
    );
    load_text("mill.toml", &text).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

const ZERO: &str = "work_zero = [0, 0, 0]";
const WIDE: [f64; 3] = [900.0; 3];
const EVEN: &str = "min = -110\nmax = 110";

/// A job with a line, a half circle and a hole in a plane whose tool axis is (i, j, k), the tool 80 mm long.
fn job([i, j, k]: [f64; 3]) -> Program {
    let length = (i * i + j * j + k * k).sqrt();
    let axis = [i / length, j / length, k / length];
    // Two directions of the plane.
    let across = if axis[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let unit = |v: [f64; 3]| {
        let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
        v.map(|c| c / length)
    };
    let u = unit(cross(axis, across));
    let v = cross(axis, u);
    let at = |a: f64, b: f64, up: f64| {
        let [x, y, z] = [0, 1, 2].map(|n| u[n] * a + v[n] * b + axis[n] * up);
        format!("GOTO/{x:.5},{y:.5},{z:.5},{:.7},{:.7},{:.7}\n", axis[0], axis[1], axis[2])
    };
    let half_circle = {
        let [x, y, z] = [0, 1, 2].map(|n| v[n] * 10.0);
        let [i, j, k] = axis;
        format!("CIRCLE/{x:.5},{y:.5},{z:.5},{i:.7},{j:.7},{k:.7},20\n{}", at(-20.0, 10.0, 0.0))
    };
    let text = format!(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,80\nSPINDL/900,RPM,CLW\nFEDRAT/100,MMPM\nRAPID\n{}RAPID\n{}{}{}{}RAPID\n{}\
         CYCLE/DRILL,RAPTO,2,FEDTO,15,RTRCTO,20,MMPM,150\n{}CYCLE/OFF\nRAPID\n{}FINI\n",
        at(0.0, 0.0, 40.0),
        at(0.0, 0.0, 5.0),
        at(0.0, 0.0, 0.0),
        at(20.0, 10.0, 0.0),
        half_circle,
        at(-20.0, 10.0, 40.0),
        at(-15.0, 5.0, 0.0),
        at(-15.0, 5.0, 40.0),
    );
    source::apt::read("job.apt", text.as_bytes(), &Default::default())
        .unwrap_or_else(|found| panic!("{found:?}\n{text}"))
        .program
}

/// A job that turns the tool in the cut, with tool-centre control, 80 mm from the axis of the table.
fn turning() -> Program {
    let at = |x: f64, y: f64, lean: f64, about: f64| {
        let ((s, c), (t, u)) = (lean.to_radians().sin_cos(), about.to_radians().sin_cos());
        format!("GOTO/{x},{y},5,{:.7},{:.7},{c:.7}\n", s * u, s * t)
    };
    let up = |about| at(80.0, -20.0, 40.0, about).replace(",5,", ",70,");
    let text = format!(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1,LENGTH,80\nSPINDL/900,RPM,CLW\nFEDRAT/100,MMPM\nRAPID\n{}{}{}{}RAPID\n{}RAPID\n{}RAPID\n{}RAPID\n{}FINI\n",
        at(80.0, 0.0, 20.0, 0.0),
        at(80.0, 0.0, 20.0, 100.0),
        at(80.0, 20.0, 40.0, 170.0),
        at(80.0, -20.0, 10.0, 170.0),
        up(170.0),
        up(60.0),
        up(-40.0),
        up(-130.0),
    );
    source::apt::read("turning.apt", text.as_bytes(), &Default::default())
        .unwrap_or_else(|found| panic!("{found:?}\n{text}"))
        .program
}

fn written(machine: &Machine, source: &Program) -> Result<String, Box<Diagnostic>> {
    let output = post::write(source, machine);
    let output = output.map_err(|found| Box::new(found.into_iter().next().unwrap()))?;
    Ok(String::from_utf8(output.text).unwrap())
}

fn proven(machine: &Machine, source: &Program, text: &str) -> Result<(), Box<Diagnostic>> {
    let report = proof::prove(source, machine, "p", text.as_bytes(), &Default::default());
    report.mismatches.into_iter().next().map_or(Ok(()), |found| Err(Box::new(found)))
}

/// A tool axis that leans by 40° to +X: A 40 and C 90, or A -40 and C -90.
const SLOPE: [f64; 3] = [0.642_787_6, 0.0, 0.766_044_4];

/// Issue 14: a plane turned by 180° was written with `J180.` for a table of 110° either way.
#[test]
fn a_plane_that_the_table_does_not_reach_is_refused_by_the_writer_and_by_the_proof() {
    let below = job([0.0, 0.0, -1.0]);
    let wide = table("fanuc-31i", ZERO, "", "min = -200\nmax = 200", WIDE);
    let text = written(&wide, &below).unwrap();
    assert!(text.contains(" J180. "), "{text}");
    proven(&wide, &below, &text).unwrap();
    let machine = table("fanuc-31i", ZERO, "", EVEN, WIDE);
    for found in
        [written(&machine, &below).unwrap_err(), proven(&machine, &below, &text).unwrap_err()]
    {
        assert_eq!(found.rule.name(), "axis-limit", "{found}");
        assert!(found.line > 0, "{found}");
    }
    // The library's own table turns as far.
    let library = load("fanuc-table-bc").unwrap();
    assert_eq!(written(&library, &below).unwrap_err().rule.name(), "axis-limit");
}

/// FANUC compares how far the axes turn, which hangs on where they stand: the program turns them to the solution first.
#[test]
fn a_fanuc_stands_at_its_solution_before_the_plane_is_tilted() {
    let slope = job(SLOPE);
    let half = "min = -30\nmax = 110";
    let machine = table("fanuc-31i", ZERO, "", half, WIDE);
    let text = written(&machine, &slope).unwrap();
    let at = |word: &str| text.lines().position(|line| line.contains(word)).unwrap();
    assert_eq!(at("G0 A40. C90.") + 1, at("G68.2"), "{text}");
    proven(&machine, &slope, &text).unwrap();
    // Without that block both solutions are possible, and A-40 is beyond the travel.
    let without: String = text
        .lines()
        .filter(|line| !line.contains("A40."))
        .map(|line| format!("{line}\n"))
        .collect();
    let found = proven(&machine, &slope, &without).unwrap_err();
    assert_eq!(found.rule.name(), "axis-limit");
    assert!(
        found.message.contains("A at -40") && found.help.contains("tilt_within_travel"),
        "{found}"
    );
    let stated = table("fanuc-31i", ZERO, "tilt_within_travel = true", half, WIDE);
    proven(&stated, &slope, &without).unwrap();
}

/// A work zero 50 mm from the axes: with A at 40° the slide of Y stands elsewhere than with A at -40° and C half a turn
/// on.
#[test]
fn cycle800_gets_the_direction_where_the_machines_file_says_which_axis_it_means() {
    let slope = job(SLOPE);
    let aside = "work_zero = [0, 50, 0]";
    let made = |settings: &str, prefer: i32, slides: [f64; 3]| {
        let a = format!("{EVEN}\nprefer = {prefer}");
        table("sinumerik-840d", aside, settings, &a, slides)
    };
    let key = "swivel_direction = \"A\"";
    for (prefer, direction) in [(1, ",1,0)"), (-1, ",-1,0)")] {
        let machine = made(key, prefer, WIDE);
        let text = written(&machine, &slope).unwrap();
        let block = text.lines().find(|line| line.contains("CYCLE800(0")).unwrap();
        assert!(block.ends_with(direction), "{block}");
        proven(&machine, &slope, &text).unwrap();
    }
    // A travel of X that ends between the two solutions: the slide is at +93 mm with one, at -93 mm with the other.
    let mut sides = [1, -1].map(|prefer| {
        let mut machine = made(key, prefer, WIDE);
        machine.linear[0].max = 60.0;
        let text = written(&machine, &slope);
        if let Ok(text) = &text {
            proven(&machine, &slope, text).unwrap();
        }
        text.map_err(|found| found.rule.name())
    });
    sides.sort_by_key(Result::is_err);
    assert!(sides[0].is_ok() && sides[1] == Err("axis-limit"), "{sides:?}");
    // Nobody says which axis the direction is about: either solution may be taken.
    let mut unsaid = made("", 1, WIDE);
    unsaid.linear[0].max = 60.0;
    assert_eq!(written(&unsaid, &slope).unwrap_err().rule.name(), "axis-limit");
    let text = sides[0].clone().unwrap();
    let found = proven(&unsaid, &slope, &text).unwrap_err();
    assert!(
        found.rule.name() == "axis-limit" && found.help.contains("swivel_direction"),
        "{found}"
    );
}

#[test]
fn a_program_for_heidenhain_says_the_sequence_where_both_solutions_are_within_the_travel() {
    let slope = job(SLOPE);
    for (prefer, sequence) in [(1, "TURN FMAX SEQ+"), (-1, "TURN FMAX SEQ-")] {
        let a = format!("{EVEN}\nprefer = {prefer}");
        let machine = table("heidenhain-tnc640", "work_zero = [0, 50, 0]", "", &a, WIDE);
        let text = written(&machine, &slope).unwrap();
        assert!(text.contains(sequence), "{text}");
        proven(&machine, &slope, &text).unwrap();
        // The other solution takes the slide of X to the other side.
        let mut narrow = machine.clone();
        (narrow.linear[0].min, narrow.linear[0].max) =
            if prefer > 0 { (-900.0, 60.0) } else { (-60.0, 900.0) };
        let is_within = written(&narrow, &slope).is_ok();
        let other =
            text.replace(" SEQ+", " SEQ*").replace(" SEQ-", " SEQ+").replace(" SEQ*", " SEQ-");
        assert_eq!(proven(&narrow, &slope, &text).is_ok(), is_within);
        assert_eq!(proven(&narrow, &slope, &other).is_ok(), !is_within);
        // Without it either is possible.
        let without = text.replace(" SEQ+", "").replace(" SEQ-", "");
        let found = proven(&narrow, &slope, &without).unwrap_err();
        assert!(found.rule.name() == "axis-limit" && found.help.contains("SEQ"), "{found}");
    }
    // One way only: there is nothing to choose.
    let machine = table("heidenhain-tnc640", ZERO, "", "min = -30\nmax = 110", WIDE);
    let text = written(&machine, &slope).unwrap();
    assert!(!text.contains("SEQ"), "{text}");
    proven(&machine, &slope, &text).unwrap();
}

/// Wherever the work stands, and however short the slides are: a job is proven, or it is refused before it is written.
#[test]
fn what_the_travel_does_not_take_is_refused_before_it_is_written() {
    let axes = [SLOPE, [0.0, 0.8, 0.6], [-0.6, 0.3, 0.5], [0.2, -0.9, -0.1], [0.0, 0.0, 1.0]];
    let mut jobs = axes.map(job).to_vec();
    jobs.push(turning());
    let (mut made, mut refused) = (0, 0);
    for (control, settings) in [
        ("fanuc-31i", ""),
        ("fanuc-31i", "tilt_within_travel = true"),
        ("heidenhain-tnc640", ""),
        ("sinumerik-840d", ""),
        ("sinumerik-840d", "swivel_direction = \"A\""),
        ("sinumerik-840d", "swivel_direction = \"C\""),
    ] {
        for zero in ["[0, 0, 0]", "[40, -30, 20]", "[-90, 60, -40]", "[0, 140, 0]", "[0, 0, -160]"]
        {
            for (a, slides) in [
                (EVEN, [130.0, 130.0, 200.0]),
                ("min = -30\nmax = 120", [100.0, 160.0, 190.0]),
                ("min = -100\nmax = 5", [200.0, 90.0, 250.0]),
                (EVEN, [300.0, 300.0, 90.0]),
            ] {
                let machine = table(control, &format!("work_zero = {zero}"), settings, a, slides);
                for (number, source) in jobs.iter().enumerate() {
                    match written(&machine, source) {
                        Ok(text) => {
                            made += 1;
                            proven(&machine, source, &text).unwrap_or_else(|why| {
                                panic!("{control} {zero} {a} job {number}: {why}\n{text}")
                            });
                        }
                        Err(why) => {
                            refused += 1;
                            assert!(
                                matches!(why.rule.name(), "axis-limit" | "home-height"),
                                "{control} {zero} {a} job {number}: {why}"
                            );
                        }
                    }
                }
            }
        }
    }
    assert!(made > 60 && refused > 60, "{made} made, {refused} refused");
}

/// High above the part C turns from 50° to -40° under tool-centre control, the tip 82.46 mm from it: on its way X passes
/// that, and stands at less at both ends.
#[test]
fn a_rapid_that_leaves_the_travel_on_its_way_is_refused_before_it_is_written() {
    let judged = |most: f64| {
        let mut machine = table("fanuc-31i", ZERO, "", "min = -30\nmax = 120", WIDE);
        let wide = written(&machine, &turning()).unwrap();
        assert!(wide.contains(" C50.\n") && wide.contains(" C-40.\n"), "{wide}");
        machine.linear[0].max = most;
        let (made, read) = (written(&machine, &turning()), proven(&machine, &turning(), &wide));
        [made.map(drop), read].map(|found| found.map_err(|found| found.rule.name()))
    };
    assert_eq!(judged(82.5), [Ok(()), Ok(())]);
    assert_eq!(judged(82.4), [Err("axis-limit"); 2]);
}
