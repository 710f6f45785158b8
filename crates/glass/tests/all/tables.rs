//! The test vectors of the specification and the tables of the source.

use std::collections::BTreeSet;
use toolpost_glass::clock::Clock;
use toolpost_glass::profile::{Limits, Profile};
use toolpost_glass::source::{checks, report, series};

#[test]
fn every_test_vector_of_the_specification_agrees() {
    let checks = checks();
    let wrong: Vec<_> = checks.iter().filter(|check| !check.agrees()).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let ids: BTreeSet<_> = checks.iter().map(|check| check.id).collect();
    let asked = [
        "K1", "K2", "K3", "K4", "K5", "K6", "K7", "K8", "K9", "M1", "M2", "M3", "M4", "M5", "M6",
        "M7", "M8", "M9", "M10", "M11", "M12", "T1", "T2", "T3", "T4", "T5", "L1", "S1", "D1",
    ];
    assert_eq!(ids, asked.into_iter().collect());
}

#[test]
fn appendix_f_has_61_rows_and_53_of_them_are_computed() {
    let rows: Vec<_> = series().into_iter().flat_map(|series| series.rows).collect();
    assert_eq!(rows.len(), 61);
    assert_eq!(rows.iter().filter(|row| row.ours.is_some()).count(), 53);
}

#[test]
fn the_tables_point_out_the_row_of_table_6_that_misses_its_point() {
    let text = report();
    let wrong: Vec<_> = text.lines().filter(|line| line.contains("<- not its point")).collect();
    assert!(
        matches!(wrong[..], [line] if line.contains("(24, 30)") && line.contains("(26.000, 30.000)"))
    );
    assert!(!text.contains("<- differs"));
    // Spot and Rayleigh's length of f = 70 mm; drive, aberration and cone 50 mm deep: as tests/optics.rs calculates them by hand.
    let row: Vec<_> =
        text.lines().filter(|line| line.contains("0.00948") && line.contains(" 50 ")).collect();
    assert!(
        matches!(row[..], [row] if row.contains("32.8937") && row.contains("0.0181")),
        "{text}"
    );
}

#[test]
fn reach_is_the_inverse_of_the_fastest_motion() {
    let limits = Limits::metric(7.5, 0.1);
    for profile in Profile::ALL {
        for length in [0.01, 0.1875, 0.75, 1.3, 1.4, 50.0] {
            let motion = profile.fastest(length, limits);
            let reached = profile.reach(motion.time, limits);
            assert!((reached - length).abs() < 1e-9 * length, "{profile:?} {length} {reached}");
            assert!(motion.speed <= limits.speed * (1.0 + 1e-12), "{profile:?} {length}");
            assert!(
                motion.acceleration <= limits.acceleration * (1.0 + 1e-12),
                "{profile:?} {length}"
            );
        }
    }
}

#[test]
fn a_step_costs_the_ticks_of_its_slowest_axis() {
    let (fast, slow) = (Limits::metric(7.5, 0.1), Limits::metric(0.75, 0.1));
    let clock = Clock::new(100.0, Profile::Triangle, [fast, fast, slow]);
    // One tick: 0.1875 mm for X and Y, 0.01875 mm for Z; two ticks four times as far.
    assert_eq!(clock.step([0; 3], [187, -187, 18]), 1);
    assert_eq!(clock.step([0; 3], [187, -187, 19]), 2);
    assert_eq!(clock.step([0; 3], [750, 0, 75]), 2);
    assert_eq!(clock.step([0; 3], [751, 0, 75]), 3);
    // 50 mm at 0.1 m/s: 513.33 ms (M5).
    assert_eq!(clock.step([0; 3], [50_000, 0, 0]), 52);
    // 100 mm: 1.0133 s, beyond the list.
    assert_eq!(clock.step([0; 3], [0, 100_000, 0]), 102);
}

#[test]
fn a_spline_reaches_two_thirds_of_a_triangle_in_a_tick() {
    let limits = Limits::metric(7.5, 0.1);
    let spline = Profile::Spline.reach(0.01, limits);
    assert!((spline - 0.125).abs() < 1e-12, "{spline}");
}

#[test]
fn the_tables_name_every_slip_of_the_source() {
    let text = report();
    let slips = text.split("Slips of the source").nth(1).unwrap();
    for slip in [
        "Table 6",
        "120 mm",
        "leaves out the corners",
        "A spline does not have",
        "Equation 14",
        "A_M and V_M",
        "V printed as W",
        "up to 60 mm (f = 43)",
        "parallel port",
        "400 000",
        "(116) and (117)",
        "temperature of plasma",
        "+23 points",
        "+82 %",
        "+47 %",
        "1.5195",
        "1.88 mm",
    ] {
        assert!(slips.contains(slip), "{slip}");
    }
}
