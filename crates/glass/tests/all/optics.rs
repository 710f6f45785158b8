//! Refraction and the cone of the beam; expected values are traced by Snell's law by hand.

use toolpost_glass::machine::{Lens, Machine, library};
use toolpost_glass::material::{TABLE, find};
use toolpost_glass::optics::{Beam, Cut, Ray, cut, rayleigh, spot};

fn lens(focal: f64) -> Lens {
    Machine::read(library("glass-xyz-100hz").unwrap(), "").unwrap().lens(focal).unwrap()
}

#[test]
fn the_focus_is_driven_less_deep_than_the_point_lies() {
    // (focal length, drive by the outermost ray for 50 mm, both rays apart): tan(asin(sin(atan(2.5 / f)) / n)) / (2.5 / f).
    for (focal, marginal, apart, deeper) in [
        (70.0, 32.893_670_9, 0.011_890_1, 0.018_073_5),
        (43.0, 32.874_079_4, 0.031_481_6, 0.047_882_1),
    ] {
        let beam = Beam::new(&lens(focal), 5.0, 1.5195);
        let drive = |ray| 50.0 * beam.drive(ray);
        assert!((drive(Ray::Paraxial) - 50.0 / 1.5195).abs() < 1e-12);
        assert!((drive(Ray::Marginal) - marginal).abs() < 1e-7, "{}", drive(Ray::Marginal));
        assert!((drive(Ray::Paraxial) - drive(Ray::Marginal) - apart).abs() < 1e-7);
        // The point is moved by more than the drive: by 50 mm x (32.905_560_8 / 32.893_670_9 - 1) at f = 70 mm.
        let moved = 50.0 * (drive(Ray::Paraxial) / drive(Ray::Marginal) - 1.0);
        assert!((moved - deeper).abs() < 1e-6, "{moved}");
    }
    // Without glass the focus is where it is driven.
    let air = Beam::new(&lens(70.0), 5.0, 1.0);
    assert_eq!((air.drive(Ray::Marginal), air.drive(Ray::Paraxial)), (1.0, 1.0));
}

#[test]
fn the_cone_of_f_70_has_1_35_degrees_and_a_radius_of_1_88_mm_at_80_mm() {
    let slope = Beam::new(&lens(70.0), 5.0, 1.5195).slope_in_glass();
    assert!((slope.atan().to_degrees() - 1.35).abs() < 0.005, "{slope}");
    assert!((80.0 * slope - 1.88).abs() < 0.005, "{slope}");
}

#[test]
fn side_faces_cut_the_cone_of_deep_points_near_them() {
    let slope = Beam::new(&lens(70.0), 5.0, 1.5195).slope_in_glass();
    let size = [50.0, 50.0, 80.0];
    // 1.5 mm from a side: at 60 mm depth the cone has 1.41 mm, at 79 mm 1.86 mm.
    let shallow = [1_500, 25_000, 20_000];
    let deep = [25_000, 48_500, 1_000];
    assert_eq!(cut(&[shallow], size, slope), Cut { points: 0, more: 0.0 });
    let found = cut(&[shallow, deep], size, slope);
    assert_eq!(found.points, 1);
    assert!((found.more - 0.356).abs() < 0.001, "{found:?}");
}

#[test]
fn the_index_of_k9_is_that_of_532_nm_and_other_lasers_are_refused() {
    assert_eq!(find(TABLE, "materials.toml", "k9", 532.0).unwrap().index, 1.5195);
    let found = find(TABLE, "materials.toml", "k9", 1064.0).unwrap_err();
    assert_eq!(found.rule, "wavelength");
    let found = find(TABLE, "materials.toml", "wood", 532.0).unwrap_err();
    assert!(found.help.contains("k9") && found.help.contains("silica"), "{found}");
    let table = "[air]\ntitle = \"thin\"\nindex = 0.9\nwavelength = 532\n";
    assert_eq!(find(table, "mine.toml", "air", 532.0).unwrap_err().rule, "index");
    let found = find("[k9]\ntitle = \"x\"\nindex = one\n", "mine.toml", "k9", 532.0).unwrap_err();
    assert_eq!((found.rule.name(), found.line), ("materials", 3));
}

#[test]
fn spot_and_aberration_are_those_of_a_hand_calculation() {
    // 4 x 0.000532 x f / (5 pi); pi x 1.5195 x spot² / (4 x 0.000532).
    for (focal, width, length, aberration) in
        [(70.0, 0.009_483, 0.201_73, 0.018_073_5), (43.0, 0.005_825, 0.076_12, 0.047_882_1)]
    {
        let found = spot(532e-6, focal, 5.0);
        assert!((found - width).abs() < 1e-6, "{found}");
        let found = rayleigh(found, 532e-6, 1.5195);
        assert!((found - length).abs() < 2e-5, "{found}");
        // 50 mm deep, traced by Snell's law as above.
        let found = 50.0 * Beam::new(&lens(focal), 5.0, 1.5195).aberration();
        assert!((found - aberration).abs() < 1e-6, "{found}");
    }
}
