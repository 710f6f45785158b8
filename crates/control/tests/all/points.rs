//! Lists of coordinates, and what is none.

use geom::Vec3;
use program::Diagnostic;
use proptest::prelude::*;
use toolpost_control::{Action, Dialect, Position, Settings, Wire};

fn run(text: &str, upper_plane: Option<f64>) -> Result<Vec<(u32, Action)>, Box<Diagnostic>> {
    let wire = Wire { height: upper_plane, ..Wire::default() };
    let settings = Settings { wire, ..Settings::new(Dialect::Points, [false; 3]) };
    let records = crate::common::records(&settings, "part.pts", text)?;
    Ok(records.into_iter().map(|record| (record.line, record.action)).collect())
}

fn at(x: f64, y: f64) -> Position {
    Position::new(Vec3::new(x, y, 0.0), Vec3::Z)
}

#[test]
fn the_first_point_is_threaded_and_the_last_one_cut() {
    let expected = vec![
        (1, Action::Rapid(at(0.0, -1.5))),
        (1, Action::ThreadWire),
        (2, Action::Line(at(10.0, 0.25))),
        (3, Action::Line(at(-0.0, 7.0))),
        (3, Action::CutWire),
        (3, Action::End),
    ];
    for text in ["0 -1.5\n10. .25\n-0 +7\n", "0\t-1.5 \r\n  10 0.25\r\n0 7"] {
        assert_eq!(run(text, None).unwrap(), expected, "{text:?}");
    }
}

#[test]
fn u_and_v_lean_the_wire_over_the_height_of_the_upper_plane() {
    let records = run("0 0 3 0\n5 0 0 -4\n", Some(4.0)).unwrap();
    let axes: Vec<Vec3> = records.iter().filter_map(|(_, op)| op.position()?.axis()).collect();
    // 3-4-5, and 45 degrees.
    assert!(axes[0].distance(Vec3::new(0.6, 0.0, 0.8)) < 1e-15);
    let half = 0.5f64.sqrt();
    assert!(axes[1].distance(Vec3::new(0.0, -half, half)) < 1e-15);
}

#[test]
fn whatever_is_no_point_is_refused_where_it_stands() {
    let refused = |text: &str| {
        let found = run(text, None).unwrap_err();
        assert_eq!(found.file, "part.pts");
        (found.rule.name(), found.line, found.column)
    };
    assert_eq!(refused(""), ("syntax", 1, 1));
    assert_eq!(refused("1 2\n\n3 4\n"), ("syntax", 2, 1));
    assert_eq!(refused("1 2\n3 4\n\n"), ("syntax", 3, 1));
    assert_eq!(refused("1 2\n3\n"), ("syntax", 2, 1));
    assert_eq!(refused("1 2 3\n"), ("syntax", 1, 1));
    assert_eq!(refused("1 2 3 4 5\n"), ("syntax", 1, 9));
    assert_eq!(refused("1 2\n3 4 0 0\n"), ("syntax", 2, 1));
    assert_eq!(refused("1 2\nX3 Y4\n"), ("syntax", 2, 1));
    assert_eq!(refused("1 2\n3,4\n"), ("syntax", 2, 2));
    assert_eq!(refused("1 2\n3-4\n"), ("syntax", 2, 2));
    assert_eq!(refused("1 2\n3 1e3\n"), ("syntax", 2, 4));
    assert_eq!(refused("1 2 0 0\n"), ("upper-plane", 1, 1));
    assert_eq!(run("1 2 1e0 0", Some(1.0)).unwrap_err().column, 6);
    let far = format!("1 2 {} 0\n", "9".repeat(200));
    assert_eq!(run(&far, Some(1.0)).unwrap_err().rule.name(), "number");
    let long = format!("1 {}\n", "9".repeat(400));
    assert_eq!(refused(&long), ("number", 1, 3));
}

proptest! {
    /// Whole thousandths, written here and read there.
    #[test]
    fn every_list_is_read_as_it_was_written(
        points in prop::collection::vec((-99_999..99_999i32, -99_999..99_999i32, -9999..9999i32, -9999..9999i32), 2..40),
        leans in any::<bool>(),
        gap in "[ \t]{1,3}",
    ) {
        let mm = |thousandths: i32| f64::from(thousandths) / 1000.0;
        let mut text = String::new();
        for (x, y, u, v) in &points {
            text += &format!("{:.3}{gap}{:.3}", mm(*x), mm(*y));
            if leans {
                text += &format!("{gap}{:.3}{gap}{:.3}", mm(*u), mm(*v));
            }
            text.push('\n');
        }
        let records = run(&text, Some(25.0)).unwrap();
        let poses: Vec<&Position> = records.iter().filter_map(|(_, op)| op.position()).collect();
        prop_assert_eq!(poses.len(), points.len());
        for (pose, (x, y, u, v)) in poses.iter().zip(&points) {
            prop_assert_eq!(pose.point, Vec3::new(mm(*x), mm(*y), 0.0));
            let axis = pose.axis().unwrap();
            let upper = axis * (25.0 / axis.z);
            let (u, v) = if leans { (mm(*u), mm(*v)) } else { (0.0, 0.0) };
            prop_assert!((upper.x - u).abs() < 1e-9 && (upper.y - v).abs() < 1e-9);
        }
    }

    #[test]
    fn no_bytes_make_it_panic(text in prop::collection::vec(prop::sample::select(b"0123456789.-+ \t\r\nX,e".to_vec()), 0..80)) {
        let text = String::from_utf8(text).unwrap();
        if let Err(found) = run(&text, Some(10.0)) {
            prop_assert!(found.is_error() && found.line > 0 && found.column > 0);
        }
    }
}
