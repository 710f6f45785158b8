//! Moved, turned, scaled and mirrored coordinates of FANUC, Haas and Mach3, tool registers, numbers
//! without a point: programs and the points that their manuals and a pocket calculator give.

use geom::Vec3;
use program::{Compensation, Cycle, CycleKind, Diagnostic, Feed, MachineMove, Spindle, WorkOffset};
use toolpost_control::{Action, Dialect, Settings, Setup, StartModes, ToolData, WholeNumbers};

fn run_with(setup: Setup, dialect: Dialect, text: &str) -> Result<Vec<Action>, Box<Diagnostic>> {
    let known = Settings {
        start_modes: StartModes::SURE,
        dwell_p_milliseconds: Some(true),
        ..Settings::new(dialect, [false; 3])
    };
    let settings = Settings { setup, ..known };
    crate::common::ops(&settings, "p.nc", text)
}

fn ops(dialect: Dialect, text: &str) -> Vec<Action> {
    let text = format!("G21\n{text}");
    run_with(Setup::default(), dialect, &text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[track_caller]
fn rule(dialect: Dialect, text: &str) -> &'static str {
    match run_with(Setup::default(), dialect, &format!("G21\n{text}")) {
        Ok(ops) => panic!("taken:\n{text}\n{ops:?}"),
        Err(error) => error.rule.name(),
    }
}

/// The points that a program goes to.
fn points(dialect: Dialect, text: &str) -> Vec<[f64; 3]> {
    let point = |op: &Action| op.position().map(|pose| pose.point.to_array());
    ops(dialect, text).iter().filter_map(point).collect()
}

#[track_caller]
fn goes_to(dialect: Dialect, text: &str, expected: &[[f64; 3]]) {
    let got = points(dialect, text);
    let near = |a: &[f64; 3], b: &[f64; 3]| Vec3::from(*a).distance(Vec3::from(*b)) < 1e-9;
    let same = got.len() == expected.len() && got.iter().zip(expected).all(|(a, b)| near(a, b));
    assert!(same, "{text}\n{got:?}\n{expected:?}");
}

const FANUC_LIKE: [Dialect; 2] = [Dialect::Fanuc, Dialect::Haas];
const START: &str = "G90 G0 X0 Y0 Z0\n";

#[test]
fn g52_moves_the_zero_and_is_not_added_up() {
    for dialect in [Dialect::Fanuc, Dialect::Haas, Dialect::Mach3] {
        // Mach3 keeps G52 where G92 is, which may hold something: it is cleared first.
        let clear = if dialect == Dialect::Mach3 { "G92.1\n" } else { "" };
        goes_to(
            dialect,
            &format!(
                "{clear}G90 G0 X0 Y0 Z0\nG52 X10. Y5.\nX1. Y1.\nG52 X20.\nX1.\nG91 X1.\n\
                 G90 G52 X0 Y0\nX1. Y1.\n"
            ),
            &[[0.0; 3], [11.0, 6.0, 0.0], [21.0, 6.0, 0.0], [22.0, 6.0, 0.0], [1.0, 1.0, 0.0]],
        );
    }
}

#[test]
fn g92_says_where_the_tool_stands() {
    for dialect in [Dialect::Fanuc, Dialect::Haas, Dialect::Mach3, Dialect::Grbl] {
        goes_to(
            dialect,
            "G90 G0 X30. Y20. Z5.\nG92 X0 Y10.\nX1. Y1.\n",
            &[[30.0, 20.0, 5.0], [31.0, 11.0, 5.0]],
        );
        // Before any move it sets the zero where the operator has brought the tool.
        goes_to(dialect, "G92 X1. Y2. Z3.\nG91 G0 X1.\n", &[[2.0, 2.0, 3.0]]);
        // From there on the way back is not known.
        let lost = "G0 X1. Y1. Z1.\nG28 X1.\nG92 X0\n";
        assert_eq!(rule(dialect, lost), "unknown-shift");
    }
    // In an offset of its own, what it alone has reported is said with the next cut, though one went before.
    let cuts = "G0 X0 Y0 Z0\nG1 X1. F100.\nT1 M6\nG55\nG92 X5. Y5. Z5.\nF100.\nG1 X6.\n";
    let way = [[0.0; 3], [1.0, 0.0, 0.0], [5.0; 3], [6.0, 5.0, 5.0]];
    goes_to(Dialect::Mach3, cuts, &way);
    let marlin = ["G90", "G0 X30 Y20 Z5", "G92 X0", "G0 X1"].join("\n");
    goes_to(Dialect::Marlin, &marlin, &[[30.0, 20.0, 5.0], [31.0, 20.0, 5.0]]);
}

#[test]
fn what_g92_held_before_the_program_is_not_known() {
    for dialect in [Dialect::LinuxCnc, Dialect::Mach3, Dialect::Grbl] {
        // LinuxCNC keeps G92 from one program to the next ("G92 Persistence Cautions").
        let cleared = "G90 G0 X1 Y1 Z1\nG92.1\n";
        // It is the operator's, or another program's: clearing it shifts what they have set up.
        let found = ops(dialect, cleared);
        let [Action::Rapid(_), Action::Risk(risk)] = &found[..] else { panic!("{found:?}") };
        assert_eq!(risk.rule.name(), "operator-data");
        assert_eq!(rule(dialect, &format!("{cleared}X1\n")), "unknown-shift");
        goes_to(
            dialect,
            "G92.1\nG90 G0 X1 Y1 Z1\nG92 X0\nG92.1\nX2\n",
            &[[1.0; 3], [2.0, 1.0, 1.0]],
        );
    }
}

#[test]
fn g92_takes_the_local_zero_of_its_axes_away() {
    // B-64484EN, "Local coordinate system": G92 cancels G52 on the axes that it names.
    goes_to(
        Dialect::Fanuc,
        "G90 G0 X10. Y10. Z0\nG52 X5. Y5.\nG92 X0\nX1. Y1.\nG52 X0 Y0\nX1. Y1.\n",
        &[[10.0, 10.0, 0.0], [11.0, 6.0, 0.0], [11.0, 1.0, 0.0]],
    );
}

#[test]
fn a_written_work_offset_sets_up_before_the_first_move_and_is_a_difference_after() {
    for dialect in [Dialect::Fanuc, Dialect::Haas] {
        goes_to(
            dialect,
            "G90 G10 L2 P1 X100. Y100. Z0\nG54 G0 X1. Y1. Z1.\nG10 L2 P1 X103. Y98.\nX1. Y1.\n\
             G91 G10 L2 P1 X2.\nG90 X1.\n",
            &[[1.0, 1.0, 1.0], [4.0, -1.0, 1.0], [6.0, -1.0, 1.0]],
        );
        // What stood there before is not known.
        let unknown = "G90 G54 G0 X1. Y1. Z1.\nG10 L2 P1 X5.\n";
        assert_eq!(rule(dialect, unknown), "unknown-shift");
        // An increment is known all the same.
        goes_to(
            dialect,
            "G90 G54 G0 X1. Y1. Z1.\nG91 G10 L2 P1 X5.\nG90 X1.\n",
            &[[1.0, 1.0, 1.0], [6.0, 1.0, 1.0]],
        );
    }
}

/// B-64484EN-2, "Changing workpiece coordinate system": P0 is the external offset, which adds to those of
/// all work offsets.
#[test]
fn the_external_offset_moves_all_work_offsets() {
    goes_to(
        Dialect::Fanuc,
        "G90 G10 L2 P0 X5. Y0 Z0\nG10 L2 P1 X100. Y100. Z0\nG54 G0 X1. Y1. Z1.\n\
         G10 L2 P0 X8.\nX1. Y1.\nG91 G10 L2 P0 Y2.\nG90 X1. Y1.\nG10 L2 P1 X101.\nX1.\n",
        &[[1.0, 1.0, 1.0], [4.0, 1.0, 1.0], [4.0, 3.0, 1.0], [5.0, 3.0, 1.0]],
    );
    // In another offset, too: 60 in G54 is 10 in G55 whatever lies outside of both.
    let got = ops(
        Dialect::Fanuc,
        "G90 G10 L2 P1 X0 Y0 Z0\nG10 L2 P2 X50. Y0 Z0\nG10 L2 P0 X7. Y7. Z7.\nG54 G0 X60. Y1. Z1.\n\
         G55\nG91 X1.\n",
    );
    let Some(Action::Rapid(pose)) = got.last() else { panic!("{got:?}") };
    assert_eq!(pose.point, Vec3::new(11.0, 1.0, 1.0));
    // What stood there before is not known; an increment is all the same.
    let unknown = "G90 G54 G0 X1. Y1. Z1.\nG10 L2 P0 X5.\n";
    assert_eq!(rule(Dialect::Fanuc, unknown), "unknown-shift");
    goes_to(
        Dialect::Fanuc,
        "G90 G54 G0 X1. Y1. Z1.\nG91 G10 L2 P0 X5.\nG90 X1.\n",
        &[[1.0, 1.0, 1.0], [6.0, 1.0, 1.0]],
    );
    // Whatever is written over what lies on such a step.
    for rest in ["G90 G10 L2 P1 X100.\n", "G90 G10 L2 P0 X5.\n"] {
        let lost = format!("G90 G10 L2 P1 X100.\nG91 G10 L2 P0 X1.\n{rest}");
        assert_eq!(rule(Dialect::Fanuc, &lost), "unknown-shift", "{rest}");
    }
    // On a Haas P0 is G52.
    assert_eq!(rule(Dialect::Haas, "G90 G10 L2 P0 X5.\n"), "data");
}

#[test]
fn two_offsets_that_the_program_writes_lie_as_it_says() {
    let got = ops(
        Dialect::Fanuc,
        "G90 G10 L2 P1 X0 Y0 Z0\nG10 L2 P2 X50. Y0 Z0\nG54 G0 X60. Y1. Z1.\nG55\nG91 X1.\n",
    );
    let Some(Action::Rapid(pose)) = got.last() else { panic!("{got:?}") };
    // 60 in G54 is 10 in G55.
    assert_eq!(pose.point, Vec3::new(11.0, 1.0, 1.0));
    assert!(got.contains(&Action::WorkOffset(WorkOffset::numbered(55).unwrap())));
}

#[test]
fn the_additional_work_offsets_come_behind_the_first_six() {
    let offsets = |dialect, text: &str| -> Vec<u32> {
        let number =
            |op| if let Action::WorkOffset(offset) = op { Some(offset.number()) } else { None };
        ops(dialect, text).into_iter().filter_map(number).collect()
    };
    assert_eq!(offsets(Dialect::Fanuc, "G54.1 P7\nG54\nG54.1 P300\n"), [66, 54, 359]);
    // G110 to G129 are G154 P1 to P20.
    assert_eq!(offsets(Dialect::Haas, "G110\nG154 P1\nG129\nG154 P99\n"), [60, 79, 158]);
    // G59 P6 is G59.
    assert_eq!(offsets(Dialect::Mach3, "G59 P6\nG59 P7\nG54\n"), [59, 60, 54]);
    assert_eq!(rule(Dialect::Fanuc, "G54.1 P301\n"), "work-offset");
    assert_eq!(rule(Dialect::Haas, "G154\n"), "work-offset");
}

#[test]
fn g68_turns_about_its_centre() {
    for dialect in FANUC_LIKE {
        // (20, 10) lies 10 along X from (10, 10): turned by 90° it is 10 along Y.
        goes_to(
            dialect,
            "G90 G0 X0 Y0 Z0\nG17 G68 X10. Y10. R90.\nX20. Y10.\nG91 X5.\nG69\nG90 X1. Y1.\n",
            &[[0.0; 3], [10.0, 20.0, 0.0], [10.0, 25.0, 0.0], [1.0, 1.0, 0.0]],
        );
        // Without a centre where the tool stands.
        goes_to(
            dialect,
            "G90 G0 X5. Y5. Z0\nG68 R180.\nG1 X6. Y7. F9\n",
            &[[5.0, 5.0, 0.0], [4.0, 3.0, 0.0]],
        );
        // G18: about Y, from Z to X.
        goes_to(
            dialect,
            "G90 G0 X0 Y0 Z0\nG18 G68 X0 Z0 R90.\nG0 Z10. X0\n",
            &[[0.0; 3], [10.0, 0.0, 0.0]],
        );
        // One axis alone, or an increment after G69, depends on the maker.
        assert_eq!(rule(dialect, "G0 X0 Y0 Z0\nG68 X0 Y0 R45.\nX5.\n"), "frame");
        assert_eq!(rule(dialect, "G0 X0 Y0 Z0\nG68 X0 Y0 R45.\nX5. Y5.\nG69\nG91 X1.\n"), "frame");
        // Also where the plane is another one by then.
        assert_eq!(rule(dialect, "G0 X0 Y0 Z0\nG18 G68 X0 Z0 R45.\nG17 Z5.\n"), "frame");
        // Z moves on as it is.
        goes_to(
            dialect,
            "G90 G0 X3. Y4. Z0\nG68 X0 Y0 R45.\nZ5.\nG69\nZ9.\n",
            &[[3.0, 4.0, 0.0], [3.0, 4.0, 5.0], [3.0, 4.0, 9.0]],
        );
    }
    goes_to(
        Dialect::Mach3,
        "G90 G0 X0 Y0 Z0\nG68 A10 B10 R90\nX20 Y10\n",
        &[[0.0; 3], [10.0, 20.0, 0.0]],
    );
    assert_eq!(rule(Dialect::LinuxCnc, "G68 X0 Y0 R45\n"), "unknown-word");
    assert_eq!(rule(Dialect::Fanuc, "G68 X0 Y0\n"), "frame");
}

#[test]
fn a_second_turn_in_g91_adds_on_a_haas_and_depends_on_a_fanuc() {
    let text = "G90 G0 X0 Y0 Z0\nG68 X0 Y0 R30.\nG91 G68 X0 Y0 R60.\nG90 X10. Y0\n";
    goes_to(Dialect::Haas, text, &[[0.0; 3], [0.0, 10.0, 0.0]]);
    assert_eq!(rule(Dialect::Fanuc, text), "frame");
}

#[test]
fn arcs_turn_and_mirror_with_the_coordinates() {
    let arc = |text: &str| {
        let arc = |op| if let Action::Arc(arc) = op { Some(arc) } else { None };
        let arc = ops(Dialect::Fanuc, text).into_iter().find_map(arc).unwrap();
        (arc.end.point, arc.center, arc.normal)
    };
    let (end, center, normal) =
        arc("G90 G0 X0 Y0 Z0\nG68 X0 Y0 R90.\nG1 X10. Y0 F9\nG3 X0 Y10. I-10. J0\n");
    assert!(end.distance(Vec3::new(-10.0, 0.0, 0.0)) < 1e-12, "{end}");
    assert!(center.distance(Vec3::ZERO) < 1e-12 && normal == Vec3::Z, "{center} {normal}");
    // Mirrored about X = 5: what turned left turns right.
    let (end, center, normal) =
        arc("G90 G0 X0 Y0 Z0\nG51.1 X5.\nG1 X10. Y0 F9\nG3 X0 Y10. I-10. J0\n");
    assert_eq!((end, center), (Vec3::new(10.0, 10.0, 0.0), Vec3::new(10.0, 0.0, 0.0)));
    assert_eq!(normal, Vec3::NEG_Z);
    // Mirrored twice it turns left again.
    let (.., normal) = arc("G90 G0 X0 Y0 Z0\nG51.1 X0 Y0\nG1 X10. Y0 F9\nG3 X0 Y10. I-10. J0\n");
    assert_eq!(normal, Vec3::Z);
    let (.., normal) = arc("G90 G0 X0 Y0 Z0\nG51.1 X0\nG18 G1 X10. Z0 F9\nG2 X0 Z10. I-10. K0\n");
    assert_eq!(normal, Vec3::Y);
}

#[test]
fn a_mirror_is_ended_axis_by_axis() {
    goes_to(
        Dialect::Fanuc,
        "G90 G0 X0 Y0 Z0\nG51.1 X50. Y50.\nX10. Y10.\nG50.1 X0\nX10. Y20.\nG91 Y1.\nG50.1 Y0\nG90 X1. Y1.\n",
        &[[0.0; 3], [90.0, 90.0, 0.0], [10.0, 80.0, 0.0], [10.0, 79.0, 0.0], [1.0, 1.0, 0.0]],
    );
    goes_to(
        Dialect::Haas,
        "G90 G0 X0 Y0 Z0\nG101 X0\nX10. Y10.\nG100 X0\nX1. Y1.\n",
        &[[0.0; 3], [-10.0, 10.0, 0.0], [1.0, 1.0, 0.0]],
    );
    assert_eq!(rule(Dialect::Haas, "G101 X5.\n"), "frame");
    assert_eq!(rule(Dialect::Haas, "G51.1 X5.\n"), "unknown-word");
}

#[test]
fn a_mirror_swaps_the_sides_of_compensation() {
    let got = ops(Dialect::Fanuc, "G90 G0 X0 Y0 Z0\nG51.1 X0\nG41 D3 G1 X5. F9\n");
    assert!(got.contains(&Action::Compensation(Compensation::Right(Some(3)))), "{got:?}");
    let got = ops(Dialect::Fanuc, "G90 G0 X0 Y0 Z0\nG51.1 X0 Y0\nG41 D3 G1 X5. F9\n");
    assert!(got.contains(&Action::Compensation(Compensation::Left(Some(3)))), "{got:?}");
}

#[test]
fn g51_scales_about_its_centre() {
    goes_to(
        Dialect::Fanuc,
        "G90 G0 X0 Y0 Z0\nG51 X10. Y10. Z0 P2.\nX20. Y10. Z3.\nG91 X1.\nG50\nG90 X1. Y1.\n",
        &[[0.0; 3], [30.0, 10.0, 6.0], [32.0, 10.0, 6.0], [1.0, 1.0, 6.0]],
    );
    goes_to(
        Dialect::Haas,
        "G90 G0 X0 Y0 Z0\nG51 X0 Y0 Z0 P0.5\nX20. Y10.\nG50\nX1. Y1.\n",
        &[[0.0; 3], [10.0, 5.0, 0.0], [1.0, 1.0, 0.0]],
    );
    goes_to(
        Dialect::Mach3,
        "G90 G0 X0 Y0 Z0\nG51 X2 Y3\nX20 Y10 Z1\nG50\nX1 Y1\n",
        &[[0.0; 3], [40.0, 30.0, 1.0], [1.0, 1.0, 1.0]],
    );
    // Thousandths or hundred thousandths: parameter 5400#7.
    assert_eq!(rule(Dialect::Fanuc, "G0 X0 Y0 Z0\nG51 X0 Y0 Z0 P2000\n"), "decimal-point");
    let uneven = "G0 X0 Y0 Z0\nG51 X0 Y0 Z0 I2. J3. K1.\nG2 X10. I5. J0 F9\n";
    assert_eq!(rule(Dialect::Fanuc, uneven), "frame");
    // The turn lies within the scale, and is taken off first.
    let order = "G0 X0 Y0 Z0\nG68 X0 Y0 R30.\nG51 X0 Y0 Z0 P2.\n";
    assert_eq!(rule(Dialect::Fanuc, order), "frame");
    goes_to(
        Dialect::Fanuc,
        "G90 G0 X0 Y0 Z0\nG51 X0 Y0 Z0 P2.\nG68 X10. Y0 R90.\nX15. Y0\n",
        &[[0.0; 3], [20.0, 10.0, 0.0]],
    );
}

#[test]
fn polar_coordinates_are_radius_and_angle() {
    // B-64484EN, "Polar coordinate command": a bolt hole circle.
    let circle = "G90 G0 X0 Y0 Z9.\nG17 G16\nG99 G81 X100. Y30. Z-20. R5. F200\n";
    let at = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        [100.0 * cos, 100.0 * sin, 5.0]
    };
    let expected = [[0.0, 0.0, 9.0], at(30.0), at(150.0), at(270.0)];
    goes_to(Dialect::Fanuc, &format!("{circle}Y150.\nY270.\nG15 G80\n"), &expected);
    goes_to(Dialect::Fanuc, &format!("{circle}G91 Y120. K2\nG15 G80\n"), &expected);
    assert_eq!(rule(Dialect::Fanuc, &format!("{circle}G91 X5. Y120.\n")), "polar");
    assert_eq!(rule(Dialect::Fanuc, "G0 X0 Y0 Z9.\nG16\nY30.\n"), "polar");
    // Mach3 counts from where the tool stood.
    goes_to(
        Dialect::Mach3,
        "G90 G0 X3 Y4 Z0\nG16\nX10 Y90\nG15\nX1 Y1\n",
        &[[3.0, 4.0, 0.0], [3.0, 14.0, 0.0], [1.0, 1.0, 0.0]],
    );
    assert_eq!(rule(Dialect::Haas, "G16\n"), "unknown-word");
}

#[test]
fn coordinates_do_not_change_under_a_cycle_or_compensation() {
    for change in ["G68 X0 Y0 R45.", "G51.1 X0", "G52 X5.", "G92 X0", "G55"] {
        let cycle = format!("{START}G0 Z9.\nG99 G81 X1. Z-1. R1. F9\n{change}\n");
        assert_eq!(rule(Dialect::Fanuc, &cycle), "cycle", "{change}");
        let compensated = format!("{START}G1 G41 D1 X5. F9\n{change}\n");
        assert_eq!(rule(Dialect::Fanuc, &compensated), "compensation", "{change}");
    }
}

#[test]
fn the_way_back_from_home_leads_through_the_point_on_the_way() {
    for dialect in FANUC_LIKE {
        goes_to(
            dialect,
            "G90 G0 X0 Y0 Z0\nG28 Z50.\nG29 X10. Y5. Z2.\n",
            &[[0.0; 3], [0.0, 0.0, 50.0], [0.0, 0.0, 50.0], [10.0, 5.0, 2.0]],
        );
        assert_eq!(rule(dialect, "G29 X0\n"), "home");
    }
}

#[test]
fn machine_coordinates_are_known_where_the_offset_is() {
    let setup = || Setup { start: Some(Vec3::ZERO), ..Setup::default() };
    let text = "G21 G90 G10 L2 P1 X10. Y0 Z-100.\nG54 G0 X1. Y1. Z1.\nG53 X0 Z0\n";
    let got = run_with(setup(), Dialect::Haas, text).unwrap();
    // Machine zero is at -10 and 100 of that offset.
    let Some(Action::Rapid(pose)) = got.last() else { panic!("{got:?}") };
    assert_eq!(pose.point, Vec3::new(-10.0, 1.0, 100.0));
    // Otherwise only the machine knows.
    let got = ops(Dialect::Haas, "G90 G54 G0 X1. Y1. Z1.\nG53 X0 Z0\n");
    let to = MachineMove { linear: [Some(0.0), None, Some(0.0)], ..MachineMove::default() };
    assert_eq!(got.last(), Some(&Action::MachineMove(Box::new(to))));
}

#[test]
fn whole_numbers_count_what_the_machine_counts() {
    let setup = |whole_numbers| Setup { whole_numbers, ..Setup::default() };
    let program =
        |unit: &str| format!("{unit}\nG90 G0 X1000 Y2. Z50000\nG73 Z-10000 R2000 Q3000 F100\n");
    let cycle = |depth, peck| Cycle {
        kind: CycleKind::BreakChip,
        depth,
        clearance: 0.0,
        retract: 48.0,
        feed: None,
        dwell: 0.0,
        first_peck: Some(peck),
        peck: Some(peck),
    };
    let run = |numbers, unit| run_with(setup(numbers), Dialect::Fanuc, &program(unit));
    let got = run(WholeNumbers::Increments, "G21").unwrap();
    assert_eq!(got[0].position().unwrap().point, Vec3::new(1.0, 2.0, 50.0));
    assert_eq!(got[2], Action::Cycle(Box::new(cycle(12.0, 3.0))));
    // 0.0001 inch: 1000 are 2.54 mm.
    let got = run(WholeNumbers::Increments, "G20").unwrap();
    assert!(got[0].position().unwrap().point.distance(Vec3::new(2.54, 50.8, 127.0)) < 1e-9);
    let got = run(WholeNumbers::Units, "G21").unwrap();
    assert_eq!(got[0].position().unwrap().point, Vec3::new(1000.0, 2.0, 50000.0));
    assert_eq!(run(WholeNumbers::Unknown, "G21").unwrap_err().rule.name(), "decimal-point");
    let dwell = |numbers, text: &str| run_with(setup(numbers), Dialect::Fanuc, text).unwrap();
    assert_eq!(dwell(WholeNumbers::Increments, "G4 X1500\n"), [Action::Dwell(1.5)]);
    assert_eq!(dwell(WholeNumbers::Units, "G4 X2\n"), [Action::Dwell(2.0)]);
    // P counts milliseconds in any case.
    assert_eq!(dwell(WholeNumbers::Units, "G4 P1500\n"), [Action::Dwell(1.5)]);
    // The other dialects have one meaning.
    let got = run_with(Setup::default(), Dialect::Mach3, "G21 G0 X5 Y6 Z7\n").unwrap();
    assert_eq!(got[0].position().unwrap().point, Vec3::new(5.0, 6.0, 7.0));
}

#[test]
fn a_length_that_the_table_or_the_program_gives_is_known() {
    let tool = ToolData { number: 4, name: String::new(), radius: 5.0, length: 80.0 };
    let setup = Setup { tools: vec![tool], start: Some(Vec3::ZERO), ..Setup::default() };
    let run = |text: &str| run_with(setup.clone(), Dialect::Fanuc, &format!("G21 {text}"));
    // With 80 mm of tool the tip is 80 mm lower than the spindle.
    let got = run("G90 G0 X0 Y0 Z100.\nG43 H4\nG91 Z1.\n").unwrap();
    assert_eq!(got.last().unwrap().position().unwrap().point.z, 21.0);
    let got = run("G90 G10 L10 P5 R30.\nG0 X0 Y0 Z100.\nG43 H5\nG91 Z1.\n").unwrap();
    assert_eq!(got.last().unwrap().position().unwrap().point.z, 71.0);
    assert_eq!(run("G90 G43 H5\nG91 G0 Z1.\n").unwrap_err().rule.name(), "unknown-position");
    assert_eq!(run("G43 H4\nG10 L10 P4 R30.\n").unwrap_err().rule.name(), "data");
    // A radius that the program writes would have to reach the compensated path.
    let radius = "G10 L12 P4 R3.\nG0 X0 Y0 Z0\nG1 G41 D4 X5. F9\n";
    assert_eq!(run(radius).unwrap_err().rule.name(), "compensation");
}

#[test]
fn boring_by_hand_is_its_moves() {
    let got =
        ops(Dialect::Fanuc, "G90 G0 X0 Y0 Z50.\nS300 M3\nG98 G88 X10. Z-10. R2. P500 F50\nG80\n");
    let heights: Vec<f64> = got.iter().filter_map(|op| Some(op.position()?.point.z)).collect();
    assert_eq!(heights, [50.0, 50.0, 2.0, -10.0, 50.0]);
    let Some(stop) = got.iter().position(|op| *op == Action::Stop) else { panic!("{got:?}") };
    assert_eq!(got[stop - 2..stop], [Action::Dwell(0.5), Action::Spindle(Spindle::Off)]);
    assert_eq!(got.last(), Some(&Action::Spindle(Spindle::Clockwise(300.0))));
}

#[test]
fn a_thread_and_a_skip() {
    let got = ops(Dialect::Fanuc, "G90 G0 X0 Y0 Z5.\nS100 M3\nG33 Z-20. F1.5\nG0 Z5.\n");
    let Some(Action::Thread(thread)) = got.iter().find(|op| matches!(op, Action::Thread(_))) else {
        panic!("{got:?}")
    };
    assert_eq!((thread.pitch, thread.end.point.z), (1.5, -20.0));
    // The pitch is no feed.
    assert!(!got.iter().any(|op| matches!(op, Action::Feed(_))), "{got:?}");
    // Nor where the same number is the feed of a cut behind it.
    let cuts = "G90 G0 X0 Y0 Z5.\nS100 M3\nG1 Z0 F100.\nG33 Z-20. F1.5\nG0 Z5.\nG1 X5. F1.5\n";
    let feeds: Vec<Action> =
        ops(Dialect::Fanuc, cuts).into_iter().filter(|op| matches!(op, Action::Feed(_))).collect();
    assert_eq!(feeds, [100.0, 1.5].map(|feed| Action::Feed(Feed::PerMinute(feed))));
    for dialect in [Dialect::Fanuc, Dialect::Haas, Dialect::Mach3] {
        let skip = "G90 G0 X0 Y0 Z5.\nG31 Z-20. F100\n";
        let got = ops(dialect, skip);
        assert!(
            matches!(got.last(), Some(Action::Probe(probe)) if probe.end.point.z == -20.0),
            "{got:?}"
        );
        assert_eq!(rule(dialect, &format!("{skip}G91 G0 Z1.\n")), "unknown-position");
    }
}
