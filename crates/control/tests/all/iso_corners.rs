//! Chamfers and roundings of FANUC and Haas (`,C` and `,R`; B-64484EN-2, "Optional chamfering and corner R"), against hand
//! calculation.

use geom::Vec3;
use program::Diagnostic;
use toolpost_control::{Action, ArcTo, Dialect, Event, Settings, Setup, WholeNumbers};

fn run_on(
    dialect: Dialect,
    whole_numbers: WholeNumbers,
    blocks: &str,
) -> Result<Vec<Event>, Box<Diagnostic>> {
    let setup = Setup { start: Some(Vec3::ZERO), whole_numbers, ..Setup::default() };
    let settings = Settings { setup, ..Settings::new(dialect, [false; 3]) };
    let text = format!("G21\nG17 G90 G94 F100.\nG0 X0. Y0. Z0.\n{blocks}\nM30\n");
    crate::common::records(&settings, "p.nc", text)
}

/// The line of a cut, its end, and centre and normal of an arc.
type Cut = (u32, Vec3, Option<(Vec3, Vec3)>);

/// The same by hand.
type Expected = (u32, [f64; 3], Option<([f64; 3], Vec3)>);

/// The cuts of a program, whose own blocks begin at line 4.
#[track_caller]
fn cuts(blocks: &str) -> Vec<Cut> {
    let events = run_on(Dialect::Fanuc, WholeNumbers::Unknown, blocks);
    let events = events.unwrap_or_else(|error| panic!("{error}\n{blocks}"));
    let cut = |event: &Event| match &event.action {
        Action::Line(end) => Some((event.line, end.point, None)),
        Action::Arc(arc) => {
            let ArcTo { end, center, normal, .. } = &**arc;
            Some((event.line, end.point, Some((*center, *normal))))
        }
        _ => None,
    };
    events.iter().filter_map(cut).collect()
}

#[track_caller]
fn assert_cuts(blocks: &str, expected: &[Expected]) {
    let found = cuts(blocks);
    let near = |a: Vec3, b: [f64; 3]| a.distance(Vec3::from_array(b)) < 1e-5;
    let same = found.len() == expected.len()
        && found.iter().zip(expected).all(|(found, expected)| {
            let circle = match (found.2, expected.2) {
                (None, None) => true,
                (Some((center, normal)), Some((at, about))) => {
                    near(center, at) && normal.distance(about) < 1e-9
                }
                _ => false,
            };
            found.0 == expected.0 && near(found.1, expected.1) && circle
        });
    assert!(same, "{blocks}\n{found:?}\n{expected:?}");
}

#[track_caller]
fn refused(blocks: &str) -> Box<Diagnostic> {
    match run_on(Dialect::Fanuc, WholeNumbers::Unknown, blocks) {
        Ok(events) => panic!("taken:\n{blocks}\n{events:?}"),
        Err(error) => error,
    }
}

#[test]
fn a_chamfer_begins_and_ends_so_far_from_the_corner() {
    assert_cuts(
        "G1 X20. ,C3.\nY20.",
        &[(4, [17.0, 0.0, 0.0], None), (4, [20.0, 3.0, 0.0], None), (5, [20.0, 20.0, 0.0], None)],
    );
    // 3 mm along each of the sides of a corner of 45 degrees, whatever its angle.
    let along = 3.0 * std::f64::consts::FRAC_1_SQRT_2;
    assert_cuts(
        "G1 X20. ,C3.\nX30. Y10.",
        &[
            (4, [17.0, 0.0, 0.0], None),
            (4, [20.0 + along, along, 0.0], None),
            (5, [30.0, 10.0, 0.0], None),
        ],
    );
}

#[test]
fn a_rounding_touches_both_lines() {
    assert_cuts(
        "G1 X20. ,R5.\nY20.",
        &[
            (4, [15.0, 0.0, 0.0], None),
            (4, [20.0, 5.0, 0.0], Some(([15.0, 5.0, 0.0], Vec3::Z))),
            (5, [20.0, 20.0, 0.0], None),
        ],
    );
    // To the right it turns clockwise.
    assert_cuts(
        "G1 X20. ,R5.\nY-20.",
        &[
            (4, [15.0, 0.0, 0.0], None),
            (4, [20.0, -5.0, 0.0], Some(([15.0, -5.0, 0.0], -Vec3::Z))),
            (5, [20.0, -20.0, 0.0], None),
        ],
    );
}

#[test]
fn a_rounding_touches_a_line_and_an_arc() {
    // The centre is 2 mm above the line and 12 mm from (20, 0): at X 20 - √(144 - 4).
    let x = 20.0 - 140.0f64.sqrt();
    let touches = [20.0 - 140.0f64.sqrt() * 10.0 / 12.0, 2.0 * 10.0 / 12.0, 0.0];
    assert_cuts(
        "G1 X10. ,R2.\nG2 X20. Y10. I10. J0.",
        &[
            (4, [x, 0.0, 0.0], None),
            (4, touches, Some(([x, 2.0, 0.0], Vec3::Z))),
            (5, [20.0, 10.0, 0.0], Some(([20.0, 0.0, 0.0], -Vec3::Z))),
        ],
    );
    // The same from the other side.
    assert_cuts(
        "G1 X20. Y10.\nG3 X10. Y0. I0. J-10. ,R2.\nG1 X0.",
        &[
            (4, [20.0, 10.0, 0.0], None),
            (5, touches, Some(([20.0, 0.0, 0.0], Vec3::Z))),
            (5, [x, 0.0, 0.0], Some(([x, 2.0, 0.0], -Vec3::Z))),
            (6, [0.0, 0.0, 0.0], None),
        ],
    );
}

#[test]
fn a_rounding_touches_two_arcs() {
    // Quarter and half of circles of 10 mm about (10, 0) and (20, 10) meet at (10, 10) at a right angle. The arc of 2 mm lies
    // outside of both: 12 mm from either centre, on the line across (15, 5), by √(12² - 50) along it.
    let h = 94.0f64.sqrt() / 2.0f64.sqrt();
    let (x, y) = (15.0 - h, 5.0 + h);
    let touches =
        |cx: f64, cy: f64| [cx + (x - cx) * 10.0 / 12.0, cy + (y - cy) * 10.0 / 12.0, 0.0];
    assert_cuts(
        "G2 X10. Y10. I10. J0. ,R2.\nG2 X30. Y10. I10. J0.",
        &[
            (4, touches(10.0, 0.0), Some(([10.0, 0.0, 0.0], -Vec3::Z))),
            (4, touches(20.0, 10.0), Some(([x, y, 0.0], Vec3::Z))),
            (5, [30.0, 10.0, 0.0], Some(([20.0, 10.0, 0.0], -Vec3::Z))),
        ],
    );
}

#[test]
fn corners_follow_each_other_and_lie_in_the_plane_that_is_selected() {
    assert_cuts(
        "G1 X20. ,C3.\nY20. ,R5.\nX0.",
        &[
            (4, [17.0, 0.0, 0.0], None),
            (4, [20.0, 3.0, 0.0], None),
            (5, [20.0, 15.0, 0.0], None),
            (5, [15.0, 20.0, 0.0], Some(([15.0, 15.0, 0.0], Vec3::Z))),
            (6, [0.0, 20.0, 0.0], None),
        ],
    );
    // Seen along Y, Z to X turns counter-clockwise.
    assert_cuts(
        "G18\nG1 Z20. ,R5.\nX20.",
        &[
            (5, [0.0, 0.0, 15.0], None),
            (5, [5.0, 0.0, 20.0], Some(([5.0, 0.0, 15.0], Vec3::Y))),
            (6, [20.0, 0.0, 20.0], None),
        ],
    );
}

#[test]
fn what_turns_by_less_than_a_degree_has_no_corner() {
    let y = 20.0 * 0.9f64.to_radians().tan();
    assert_cuts(
        &format!("G1 X20. ,C3.\nX40. Y{y:.6}"),
        &[(4, [20.0, 0.0, 0.0], None), (5, [40.0, y, 0.0], None)],
    );
    assert_eq!(cuts("G1 X20. ,C3.\nX40. Y0.36").len(), 3);
}

#[test]
fn the_size_of_a_corner_is_a_length_like_others() {
    assert_cuts(
        "#1=2.5\nG1 X20. , C#1\nY20.",
        &[(5, [17.5, 0.0, 0.0], None), (5, [20.0, 2.5, 0.0], None), (6, [20.0, 20.0, 0.0], None)],
    );
    assert_eq!(cuts("G1 X20. ,C#1\nY20.").len(), 2, "a null is no corner");
    assert_eq!(refused("G1 X20. ,C3\nY20.").rule, "decimal-point");
    let first = |whole_numbers| {
        let events = run_on(Dialect::Fanuc, whole_numbers, "G1 X20. ,C3\nY20.").unwrap();
        let cut = events.iter().find_map(|event| match &event.action {
            Action::Line(end) => Some(end.point.x),
            _ => None,
        });
        cut.unwrap()
    };
    assert_eq!(first(WholeNumbers::Units), 17.0);
    assert_eq!(first(WholeNumbers::Increments), 20.0 - 0.003);
}

#[test]
fn a_corner_without_two_cuts_in_the_plane_is_refused() {
    for (blocks, says) in [
        ("G1 X20. ,R5.\nG0 Y20.", "no second side"),
        ("G1 X20. ,R5.", "no second side"),
        ("G1 X20. ,R5.\nM8\nY20.", "no second side"),
        ("G1 X20. ,R5.\nG4 X1.\nY20.", "no second side"),
        ("G1 X20. ,R5.\nZ-5.", "in the plane"),
        ("G1 X20. ,R5.\nG18 Y20.", "plane"),
        ("G1 X20. ,R5.\nX5.", "turns back"),
        ("G1 X20. ,R25.\nY20.", "does not fit"),
        ("G1 X20. ,C5.\nY4.", "does not fit"),
        ("G1 X20. ,C-5.\nY20.", "no sign"),
        ("G1 X20. ,C2.\nG2 X30. Y10. I10. J0.", "arc"),
        ("G0 X20. ,R5.\nG1 Y20.", "belongs to a cut"),
        ("G1 X20. ,R5. ,C2.\nY20.", "one corner"),
        ("G1 X20. ,A45.\nY20.", "angle"),
        ("G1 X20. ,R5.\nY20. F200.", "how fast"),
        ("G68 X0. Y0. R30.\nG1 X20. Y0. ,R5.\nX20. Y20.", "turned"),
        ("G1 X20. ,\nY20.", "comma"),
    ] {
        let error = refused(blocks);
        assert!(error.message.contains(says), "{blocks}\n{error}");
        assert!(error.line >= 4 && error.column > 0, "{error}");
    }
}

#[test]
fn a_haas_has_corners_between_lines() {
    let run = |blocks| run_on(Dialect::Haas, WholeNumbers::Unknown, blocks);
    assert_eq!(
        run("G1 X20. ,R5.\nY20.").unwrap().iter().filter(|e| e.action.position().is_some()).count(),
        4
    );
    assert!(run("G1 X10. ,R2.\nG2 X20. Y10. I10. J0.").unwrap_err().message.contains("Haas"));
}
