//! What layers mean: hand calculation, and the examples of the Gerber specification.

use crate::data;
use crate::raster::Raster;
use geom::Vec2;
use std::f64::consts::PI;
use toolpost_pcb::gerber::{Image, Pen, Reading, Shape, read};

/// A file in mm with six decimals, of these commands.
fn layer(commands: &str) -> Reading {
    let text = format!("%FSLAX36Y36*%%MOMM*%{commands}M02*");
    read("test.gbr", text.as_bytes()).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

fn image(commands: &str) -> Image {
    layer(commands).image
}

/// Dark area, mm², by counting pixels of 5 µm.
fn area(image: &Image) -> f64 {
    Raster::of_image(image, 0.005, 100.0).map_or(0.0, |raster| raster.area())
}

#[track_caller]
fn assert_area(image: &Image, expected: f64) {
    let area = area(image);
    assert!((area - expected).abs() < 0.002 * expected.max(1.0), "{area} is not {expected}");
}

#[track_caller]
fn assert_extents(image: &Image, low: (f64, f64), high: (f64, f64)) {
    let (a, b) = image.extents().expect("something is dark");
    let near = |p: Vec2, q: (f64, f64)| p.distance(Vec2::new(q.0, q.1)) < 1e-9;
    assert!(near(a, low) && near(b, high), "{a} {b}");
}

/// A file of the real data, read.
fn real(name: &str) -> Option<Reading> {
    let file = data::folder()?.join(name);
    Some(read(name, &data::bytes(&file)).unwrap_or_else(|errors| panic!("{errors:#?}")))
}

#[test]
fn standard_apertures_have_the_areas_of_their_shapes() {
    let root = 3f64.sqrt();
    for (aperture, expected) in [
        ("C,4", PI * 4.0),
        ("C,4X2", PI * 3.0),
        ("C,4X2X1", PI * 4.0 - 2.0),
        ("R,4X2", 8.0),
        ("R,4X2X1", 8.0 - PI / 4.0),
        ("R,4X2X1X0.5", 7.5),
        ("O,4X2", 4.0 + PI),
        ("O,2X4", 4.0 + PI),
        ("O,3X3", PI * 2.25),
        ("O,4X2X1", 4.0 + PI * 0.75),
        // A hexagon's area is 3√3/2 r², a triangle's 3√3/4 r².
        ("P,4X6", 6.0 * root),
        ("P,4X6X17.5X1", 6.0 * root - PI / 4.0),
        ("P,4X3", 3.0 * root),
    ] {
        let image = image(&format!("%ADD10{aperture}*%D10*X1000000Y2000000D03*"));
        assert_area(&image, expected);
        let Shape::Flash { at, .. } = image.objects[0].shape else { panic!("no flash") };
        assert_eq!(at, Vec2::new(1.0, 2.0));
    }
    assert_extents(
        &image("%ADD10P,4X4X45*%D10*X0Y0D03*"),
        (-2f64.sqrt(), -2f64.sqrt()),
        (2f64.sqrt(), 2f64.sqrt()),
    );
    assert_extents(&image("%ADD10P,4X4*%D10*X0Y0D03*"), (-2.0, -2.0), (2.0, 2.0));
}

#[test]
fn a_hole_in_an_aperture_does_not_erase_what_is_under_it() {
    // Section 4.5.2: a 10 mm square with a hole of 5 mm over a line.
    let square = "%AMSQ*21,1,10,10,0,0,0*1,0,5,0,0*%%ADD10SQ*%";
    assert_area(&image(&format!("{square}D10*X0Y0D03*")), 100.0 - PI * 6.25);
    let line = "%ADD11C,1*%D11*X-8000000Y0D02*X8000000Y0D01*";
    // Within the square's hole the line covers 5 by 1 less the rounding of the hole's edge: the two
    // circular segments outside it, each r²(φ − sin φ)/2 with sin(φ/2) = 0.5/2.5, fall on the square.
    let half = (0.2f64).asin();
    let within = 2.0 * (2.5f64.powi(2) * half + 0.5 * 2.5 * half.cos());
    let outside = 2.0 * 3.0 + PI * 0.25;
    assert_area(
        &image(&format!("{square}{line}D10*X0Y0D03*")),
        100.0 - PI * 6.25 + within + outside,
    );
}

#[test]
fn strokes_of_a_disc() {
    let round = "%ADD10C,2*%D10*G75*";
    assert_area(&image(&format!("{round}X0Y0D02*X3000000Y4000000D01*")), 10.0 + PI);
    assert_area(&image(&format!("{round}X0Y0D02*X0Y0D01*")), PI);
    // A quarter of a ring of radii 4 and 6, and two half discs.
    let arc = image(&format!("{round}G03*X5000000Y0D02*X0Y5000000I-5000000J0D01*"));
    assert_area(&arc, PI * (36.0 - 16.0) / 4.0 + PI);
    assert_extents(&arc, (-1.0, -1.0), (6.0, 6.0));
    // Clockwise it is the other three quarters.
    let arc = image(&format!("{round}G02*X5000000Y0D02*X0Y5000000I-5000000J0D01*"));
    assert_area(&arc, PI * (36.0 - 16.0) * 0.75 + PI);
    // A whole circle is a ring; one that is smaller than the pen, a disc.
    assert_area(&image(&format!("{round}G03*X5000000Y0D02*X5000000Y0I-5000000J0D01*")), 20.0 * PI);
    assert_area(&image(&format!("{round}G03*X500000Y0D02*X500000Y0I-500000J0D01*")), PI * 2.25);
    // Half a circle of radius 0.5: a half disc of radius 1.5 and, beyond its ends, half discs of radius
    // 1 about them, of which the parts within the other half of a disc of 1 about the centre overlap.
    let small = image(&format!("{round}G03*X500000Y0D02*X-500000Y0I-500000J0D01*"));
    let overlap = 2.0 * (1f64 * 0.5f64.acos() - 0.5 * 0.75f64.sqrt());
    assert_area(&small, PI * 1.125 + PI - overlap / 2.0);
    // A pen without size leaves its path, but nothing dark.
    let thin = image("%ADD10C,0*%D10*X0Y0D02*X1000000D01*");
    assert!(thin.pieces(&thin.objects[0]).is_empty());
    assert!(matches!(thin.objects[0].shape, Shape::Stroke { path, .. } if path.end == Vec2::X));
    assert_eq!(thin.apertures[0].pen, Some(Pen::Round(0.0)));
}

#[test]
fn strokes_of_a_rectangle_cover_what_it_sweeps() {
    // Section 8.2.3: no rotation; the area is w·h + |dx|·h + |dy|·w.
    let reading = layer("%ADD10R,2X1*%D10*X0Y0D02*X3000000Y4000000D01*");
    assert_area(&reading.image, 2.0 + 3.0 + 8.0);
    assert!(reading.warnings.iter().any(|warning| warning.rule.name() == "deprecated"));
    assert_area(&image("%ADD10R,2X1*%D10*X0Y0D02*X-3000000D01*"), 5.0);
    assert_area(&image("%ADD10R,2X1*%D10*X0Y0D02*X0Y0D01*"), 2.0);
    assert_area(&image("%ADD10R,2X1*%%LR90*%D10*X0Y0D02*X-3000000D01*"), 2.0 + 6.0);
}

#[test]
fn macro_primitives() {
    let flash = |body: &str| image(&format!("%AMM*{body}*%%ADD10M,4X2*%D10*X0Y0D03*"));
    for (body, expected) in [
        ("1,1,$1,0,0", PI * 4.0),
        ("1,1,$1,1,2,30", PI * 4.0),
        ("20,1,$2,0,0,3,4,0", 10.0),
        ("2,1,$2,0,0,3,4,77", 10.0),
        ("21,1,$1,$2,0,0,45", 8.0),
        ("22,1,$1,$2,0,0,0", 8.0),
        ("4,1,3,0,0,4,0,0,3,0,0,0", 6.0),
        // The other way round.
        ("4,1,3,0,0,0,3,4,0,0,0,10", 6.0),
        ("5,1,6,0,0,$1,5", 6.0 * 3f64.sqrt()),
        ("21,1,4,4,0,0,0*1,0,$2,0,0", 16.0 - PI),
        // What is erased may be covered again.
        ("21,1,4,4,0,0,0*1,0,$2,0,0*1,1,1,0,0", 16.0 - PI + PI / 4.0),
        // Variables, set and not set.
        ("$3=$1x0.25+($2-1)/4*1,1,$3,$9,0", PI * 0.390_625),
        // Rings of 3.5 to 4 and 2.5 to 3, without a cross.
        ("6,0,0,8,0.5,0.5,2,0,0,0", PI * (16.0 - 12.25 + 9.0 - 6.25)),
        // The innermost ring is a disc.
        ("6,0,0,2,1.5,0.5,5,0,0,0", PI),
    ] {
        assert_area(&flash(body), expected);
    }
    // The rings of a moiré do not erase what an earlier primitive has filled.
    assert_area(&flash("1,1,8,0,0*6,0,0,8,0.5,0.5,2,0,0,0"), PI * 16.0);
    // Rotation is about the origin of the macro (section 4.5.3).
    assert_extents(&flash("22,1,4,2,1,1,90"), (-3.0, 1.0), (-1.0, 5.0));
    assert_extents(&flash("21,1,4,2,5,0,180"), (-7.0, -1.0), (-3.0, 1.0));
}

#[test]
fn a_thermal_is_a_ring_without_its_cross() {
    let flash = |body: &str| image(&format!("%AMM*{body}*%%ADD10M*%D10*X0Y0D03*"));
    // A disc of radius r less a cross of bars 2h wide: 4 times the area beyond h in both directions.
    let corner = |r: f64, h: f64| {
        if r <= h * 2f64.sqrt() {
            return 0.0;
        }
        let far = (r * r - h * h).sqrt();
        h * h - h * far + r * r * ((far / r).asin() - (h / r).asin()) / 2.0
    };
    for (outer, inner, gap, angle) in
        [(9.5, 7.5, 1.75, 0.0), (8.0, 4.0, 1.0, 30.0), (8.0, 2.0, 3.0, 0.0), (8.0, 0.0, 0.0, 0.0)]
    {
        let thermal = flash(&format!("7,0,0,{outer},{inner},{gap},{angle}"));
        let h = gap / 2.0;
        let expected = 4.0 * (corner(outer / 2.0, h) - corner(inner / 2.0, h));
        assert_area(&thermal, expected);
    }
}

#[test]
fn regions() {
    // Section 4.10.4.6: squares and discs, dark and clear in turn (here a tenth of the size).
    let holes = "G01*%LPD*%G75*G36*X2500000Y2500000D02*X17500000D01*Y17500000D01*X2500000D01*Y2500000D01*G37*\
        %LPC*%G36*X5000000Y10000000D02*G03*X5000000Y10000000I5000000J0D01*G37*\
        %LPD*%G01*G36*X7500000Y7500000D02*X12500000D01*Y12500000D01*X7500000D01*Y7500000D01*G37*\
        %LPC*%G36*X11500000Y10000000D02*G03*X11500000Y10000000I2500000J0D01*G37*";
    // The last disc reaches 1 mm into the small square and lies in the big hole otherwise, which ends at
    // x = 15; it is beyond it by a lens less.
    let image = image(holes);
    let lens = |d: f64, r: f64, s: f64| {
        let a = (d * d + r * r - s * s) / (2.0 * d);
        let b = d - a;
        r * r * (a / r).acos() - a * (r * r - a * a).sqrt() + s * s * (b / s).acos()
            - b * (s * s - b * b).sqrt()
    };
    let beyond = PI * 6.25 - lens(4.0, 5.0, 2.5);
    let bite = 6.25 * (1.5f64 / 2.5).acos() - 1.5 * 2.0;
    assert_area(&image, 225.0 - PI * 25.0 + 25.0 - bite - beyond);
    assert_eq!(
        image.objects.iter().map(|o| o.dark).collect::<Vec<_>>(),
        [true, false, true, false]
    );
}

#[test]
fn contours_of_a_region_are_united_whichever_way_they_run() {
    // Sections 4.10.4.2 and 4.10.4.3: a diamond next to a square, and within it.
    let square = "G01*G36*X0Y5000000D02*Y10000000D01*X10000000D01*Y0D01*X0D01*Y5000000D01*";
    let diamond = "X-1000000D02*X-5000000Y1000000D01*X-9000000Y5000000D01*X-5000000Y9000000D01*X-1000000Y5000000D01*G37*";
    let within = "X1000000D02*X5000000Y1000000D01*X9000000Y5000000D01*X5000000Y9000000D01*X1000000Y5000000D01*G37*";
    let other_way = "X1000000D02*X5000000Y9000000D01*X9000000Y5000000D01*X5000000Y1000000D01*X1000000Y5000000D01*G37*";
    assert_area(&image(&format!("{square}{diamond}")), 100.0 + 32.0);
    assert_area(&image(&format!("{square}{within}")), 100.0);
    assert_area(&image(&format!("{square}{other_way}")), 100.0);
    // A cut-in makes a hole (section 4.10.4.7): 10 by 8 with a disc of radius 3.
    let cut_in = "G75*G36*X2000000Y10000000D02*G01*X12000000D01*Y2000000D01*X2000000D01*Y6000000D01*X5000000D01*\
        G03*X5000000Y6000000I3000000J0D01*G01*X2000000D01*Y10000000D01*G37*";
    let hole = image(cut_in);
    assert!((hole.regions[0].contours[0].area() - (80.0 - 9.0 * PI)).abs() < 1e-9);
    assert_area(&hole, 80.0 - 9.0 * PI);
    // Two areas joined by a line there and back (section 4.10.4.8).
    let joined = "X-1000000D01*X-5000000Y1000000D01*X-9000000Y5000000D01*X-5000000Y9000000D01*X-1000000Y5000000D01*X0D01*G37*";
    assert_area(&image(&format!("{square}{joined}")), 132.0);
}

#[test]
fn arcs_of_one_quadrant() {
    // The centre has no sign: of the four the one that makes a quarter turn or less.
    let reading = layer("%ADD10C,1*%D10*G74*G03*X5000000Y0D02*X0Y5000000I5000000J0D01*");
    let Shape::Stroke { path, .. } = reading.image.objects[0].shape else { panic!("no stroke") };
    let turn = path.turn.unwrap();
    assert!(turn.center.length() < 1e-9 && (turn.sweep - PI / 2.0).abs() < 1e-9);
    // Equal ends are an arc without length: a dot.
    assert_area(&image("%ADD10C,2*%D10*G74*G02*X0Y0I5000000D01*"), PI);
    // The fixture of tracespace: the arc from (−0.25, 0) to (0.25, 0) clockwise has its centre below, at
    // (0, −0.4) inches, and the other from (0.25, 0.4) to (−0.25, 0.4) at the origin.
    let Some(reading) = real("features/arc-strokes/single-quadrant-I-to-II.gbr") else { return };
    let centers = reading.image.objects.iter().map(|object| match object.shape {
        Shape::Stroke { path, .. } => path.turn.unwrap().center / 25.4,
        _ => panic!("no stroke"),
    });
    for (center, expected) in centers.zip([Vec2::new(0.0, -0.4), Vec2::ZERO]) {
        assert!(center.distance(expected) < 1e-9);
    }
}

#[test]
fn arcs_that_miss_their_centre_a_little_keep_their_ends() {
    let image = image("%ADD10C,1*%D10*G75*G03*X5000000Y0D02*X0Y5002000I-5000000J0D01*");
    let Shape::Stroke { path, .. } = image.objects[0].shape else { panic!("no stroke") };
    assert_eq!((path.start, path.end), (Vec2::new(5.0, 0.0), Vec2::new(0.0, 5.002)));
    let center = path.turn.unwrap().center;
    assert!((center.distance(path.start) - center.distance(path.end)).abs() < 1e-9);
    assert!(center.length() < 0.002);
}

#[test]
fn polarity_is_obeyed_in_order() {
    let image = image(
        "%ADD10R,4X4*%%ADD11C,2*%%ADD12C,1*%D10*X0Y0D03*%LPC*%D11*X0Y0D03*%LPD*%D12*X0Y0D03*",
    );
    assert_area(&image, 16.0 - PI + PI / 4.0);
}

#[test]
fn step_and_repeat_copies_the_block_as_a_whole() {
    // Section 4.12: first along Y, then along X. Squares of 2 mm with a hole of 0.5 mm, 1 mm apart: each
    // copy darkens what it covers of the holes before it. Of the first a quarter stays clear, of the next
    // two a half, and the last is whole.
    let block = "%ADD10R,2X2*%%ADD11R,0.5X0.5*%%SRX2Y2I1J1*%D10*X0Y0D03*%LPC*%D11*X0Y0D03*%SR*%";
    let repeated = image(block);
    let places: Vec<Vec2> = repeated
        .objects
        .iter()
        .filter(|o| o.dark)
        .map(|object| match object.shape {
            Shape::Flash { at, .. } => at,
            _ => panic!("no flash"),
        })
        .collect();
    assert_eq!(places, [Vec2::ZERO, Vec2::Y, Vec2::X, Vec2::ONE]);
    assert_area(&repeated, 9.0 - 0.25 * (0.25 + 0.5 + 0.5 + 1.0));
    // Inches: the steps are in the unit of the file.
    let text = "%FSLAX24Y24*%%MOIN*%%ADD10C,0.1*%%SRX3Y1I0.5J0*%D10*X0Y0D03*%SR*%M02*";
    let (_, high) = read("test.gbr", text.as_bytes()).unwrap().image.extents().unwrap();
    assert!((high.x - 1.05 * 25.4).abs() < 1e-9);
}

#[test]
fn blocks_are_flashed_mirrored_turned_scaled_and_inverted() {
    // An L: 4 by 1 along X and 1 by 3 along Y, with a hole in its foot.
    let block = "%ADD10R,1X1*%%ADD11C,0.5*%%ABD12*%%LPD*%G36*X0Y0D02*G01*X4000000D01*Y1000000D01*X1000000D01*Y3000000D01*X0D01*Y0D01*G37*\
        %LPC*%D11*X3500000Y500000D03*%LPD*%%AB*%D12*";
    let one = 4.0 + 2.0 - PI / 16.0;
    let flashed = |load: &str| image(&format!("{block}{load}X10000000Y0D03*"));
    assert_area(&flashed(""), one);
    assert_extents(&flashed(""), (10.0, 0.0), (14.0, 3.0));
    assert_extents(&flashed("%LMX*%"), (6.0, 0.0), (10.0, 3.0));
    assert_extents(&flashed("%LMY*%"), (10.0, -3.0), (14.0, 0.0));
    assert_extents(&flashed("%LMXY*%"), (6.0, -3.0), (10.0, 0.0));
    assert_extents(&flashed("%LR90*%"), (7.0, 0.0), (10.0, 4.0));
    // Mirrored first, then turned (section 4.9.1).
    assert_extents(&flashed("%LMX*%%LR90*%"), (7.0, -4.0), (10.0, 0.0));
    assert_extents(&flashed("%LS0.5*%"), (10.0, 0.0), (12.0, 1.5));
    assert_area(&flashed("%LS0.5*%%LR33*%%LMY*%"), one / 4.0);
    // In clear polarity what is dark erases and what is clear darkens (section 4.11.1).
    let clear = format!("{block}D10*%LPC*%X10000000Y0D03*");
    let clear = image(&clear.replace("D10*%LPC*%", "%LPC*%D12*"));
    assert_eq!(clear.objects.iter().map(|object| object.dark).collect::<Vec<_>>(), [false, true]);
    assert_area(&clear, PI / 16.0);
}

#[test]
fn blocks_in_blocks() {
    // The example of section 4.11.4, a tenth as large: D100 is two strokes and a disc.
    let text = "%FSLAX46Y46*%%MOMM*%%ADD10C,7.5*%%ADD11C,15*%%ADD12R,20X10*%%ADD13R,10X20*%\
        %ABD100*%D10*X65532000Y17605375D02*Y65865375D01*X-3556000D01*D11*X-3556000Y17605375D03*%AB*%\
        %ABD102*%%ABD101*%D100*X0Y0D03*X0Y70000000D03*X100000000Y0D03*X100000000Y70000000D03*%AB*%\
        D101*X0Y0D03*X0Y160000000D03*X0Y320000000D03*X230000000Y0D03*X230000000Y160000000D03*X230000000Y320000000D03*\
        D12*X19500000Y-10000000D03*%AB*%D13*X-30000000Y10000000D03*X143000000Y-30000000D03*\
        D102*X0Y0D03*X0Y520000000D03*X500000000Y0D03*X500000000Y520000000D03*X1000000000Y0D03*X1000000000Y520000000D03*M02*";
    let image = read("test.gbr", text.as_bytes()).unwrap().image;
    // 6 flashes of D102, each 6 of D101 with 4 of 3 objects, and one rectangle; two of D13 besides.
    assert_eq!(image.objects.len(), 6 * (6 * 4 * 3 + 1) + 2);
    // Farthest right: the stroke at 65.532 in the last block of all, half its width beyond.
    let (low, high) = image.extents().unwrap();
    assert!((high.x - (1000.0 + 230.0 + 100.0 + 65.532 + 3.75)).abs() < 1e-9);
    assert!((high.y - (520.0 + 320.0 + 70.0 + 65.865_375 + 3.75)).abs() < 1e-9);
    assert!((low.x + 35.0).abs() < 1e-9 && (low.y + 40.0).abs() < 1e-9);
}

#[test]
fn transformed_apertures_in_strokes_and_regions() {
    // The example of section 4.9.1: lines of 1 and 1.5 mm.
    let lines = image("%ADD10C,1*%D10*G01*X0Y0D02*X1000000D01*%LS1.5*%Y2000000D01*");
    let widths: Vec<f64> = lines
        .objects
        .iter()
        .map(|object| {
            let (low, high) = lines.pieces(object)[0].contours[0].extents();
            (high - low).min_element()
        })
        .collect();
    assert!((widths[0] - 1.0).abs() < 1e-9 && (widths[1] - 1.5).abs() < 1e-9);
    // Regions are not scaled.
    assert_area(&image("%LS3*%G36*X0Y0D02*X2000000D01*Y2000000D01*X0D01*Y0D01*G37*"), 4.0);
}

#[test]
fn attributes_are_kept() {
    let reading = layer(
        "%TF.FileFunction,Copper,L1,Top*%G04 #@! TF.Part,Single*%TA.AperFunction,SMDPad,CuDef*%%ADD10R,1X1*%%TD*%\
         %ADD11C,0.2*%%TO.N,GND*%%TO.P,U1,7,VSS*%D10*X0Y0D03*%TD.P*%D11*X0Y0D02*X1000000D01*\
         %TA.AperFunction,Conductor*%%TO.N,*%G36*X0Y0D02*X2000000D01*Y2000000D01*X0Y0D01*G37*%TD*%\
         %TO.N,A\\u002CB,C*%X0Y0D03*",
    );
    let image = &reading.image;
    let reported = |i: usize| {
        let object = &image.objects[i];
        let attributes = image.attributes(object);
        let nets = attributes.nets.as_deref().unwrap_or_default().join("|");
        let pin = attributes.pin.as_deref().unwrap_or_default().to_string();
        let component = attributes.component.as_deref().unwrap_or_default().to_string();
        (nets, component, pin, image.function(object).unwrap_or_default().to_string())
    };
    let say = |a: &str, b: &str, c: &str, d: &str| (a.into(), b.into(), c.into(), d.into());
    assert_eq!(reported(0), say("GND", "U1", "7", "SMDPad,CuDef"));
    assert_eq!(reported(1), say("GND", "", "", ""));
    assert_eq!(reported(2), say("", "", "", "Conductor"));
    assert_eq!(reported(3), say("A,B|C", "", "", ""));
    assert_eq!(image.file_attribute(".FileFunction").unwrap(), ["Copper", "L1", "Top"]);
    assert_eq!(image.file_attribute(".Part").unwrap(), ["Single"]);
    assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
}

#[test]
fn what_is_deprecated_is_read_with_a_warning() {
    let text = "%FSTAX23Y23*%\n%ASAXBY*OFA0.0B0.0*MIA0B0*SFA1.0B1.0*IPPOS*INold*%\nG70*G90*\nN01G54D10*\n%ADD10C,.1*%\nM01*";
    // The aperture comes first.
    let text = text.replace(
        "N01G54D10*\n%ADD10C,.1*%",
        "%ADD10C,.1*%\nN01G54D10*G01X1Y1D02*X02D01*Y02*G55D03*M02*",
    );
    let text = text.replace("M01*", "").replace("G90*", "G90*M01*");
    let reading = read("old.gbr", text.as_bytes()).unwrap_or_else(|e| panic!("{e:#?}"));
    assert!(reading.warnings.iter().all(|warning| warning.rule.name() == "deprecated"));
    assert!(reading.warnings.len() >= 8, "{:#?}", reading.warnings);
    let image = reading.image;
    // Trailing zeros are left out: X1 is 10 inches, X02 2 inches.
    let places: Vec<(Vec2, Vec2)> = image
        .objects
        .iter()
        .map(|object| match object.shape {
            Shape::Stroke { path, .. } => (path.start / 25.4, path.end / 25.4),
            Shape::Flash { at, .. } => (at / 25.4, at / 25.4),
            Shape::Region { .. } => panic!("no region"),
        })
        .collect();
    let at = |x: f64, y: f64| Vec2::new(x, y);
    assert_eq!(
        places,
        [
            (at(10.0, 10.0), at(2.0, 10.0)),
            (at(2.0, 10.0), at(2.0, 2.0)),
            (at(2.0, 2.0), at(2.0, 2.0))
        ]
    );
}

#[test]
fn incremental_coordinates_add_up() {
    let text = "%FSLIX24Y24*%%MOIN*%%ADD10C,0.1*%D10*X10000Y10000D03*X5000D03*Y-5000D03*M02*";
    let image = read("test.gbr", text.as_bytes()).unwrap().image;
    let Shape::Flash { at, .. } = image.objects[2].shape else { panic!("no flash") };
    assert!((at / 25.4).distance(Vec2::new(1.5, 0.5)) < 1e-9);
}

#[test]
fn the_fixtures_have_the_areas_of_their_shapes() {
    let inch = 25.4f64.powi(2);
    for (name, expected) in [
        ("pads/circle-with-hole.gbr", PI * (0.25 - 0.0625) / 4.0),
        ("pads/obround-with-rect-hole.gbr", 0.25 + PI * 0.0625 - 0.25 * 0.15),
        ("pads/polygon-rotated.gbr", 1.5 * 3f64.sqrt() * 0.0625),
        ("macro-primitives/rotated-center-rect-primitive.gbr", 0.125),
        ("macro-primitives/vector-primitive.gbr", 0.25 * 0.5f64.sqrt()),
        ("macro-primitives/outline-primitive.gbr", 0.125),
        ("regions/region-with-arc-cut-in.gbr", 0.8 - 0.09 * PI),
        // A square of 1.5 with four corners of radius 0.5, each bitten out.
        ("regions/region-with-arcs.gbr", 2.25 - 4.0 * (0.25 - PI * 0.0625)),
        ("regions/region-with-cut-in-line.gbr", 0.9 * 1.5 - 0.4 * 0.4 - 0.4 * 0.3),
        ("strokes/rect-tool-single-segment.gbr", 0.02 + 0.5 * 0.1 + 0.3 * 0.2),
        ("strokes/circle-tool-single-segment.gbr", 0.2 * 0.34f64.sqrt() + PI * 0.01),
        ("arc-strokes/zero-length.gbr", PI * 0.015_625),
        ("step-repeats/one-polarity.gbr", 1.5),
        ("step-repeats/multi-polarity.gbr", 6.0 * (0.25 - PI * (0.0625 - 0.0225) / 4.0)),
        // The four parts of a ring of 0.4 to 0.5 whose gaps are 0.1 wide.
        (
            "macros/clear-with-thermal.gbr",
            1.21 - {
                let corner = |r: f64| {
                    let far = (r * r - 0.0025f64).sqrt();
                    0.0025 - 0.05 * far + r * r * ((far / r).asin() - (0.05 / r).asin()) / 2.0
                };
                4.0 * (corner(0.25) - corner(0.2))
            },
        ),
    ] {
        let Some(reading) = real(&format!("features/{name}")) else { return };
        let area = Raster::of_image(&reading.image, 0.02, 100.0).unwrap().area() / inch;
        assert!((area - expected).abs() < 0.004 * expected, "{name}: {area} is not {expected}");
    }
}

#[test]
fn what_a_block_leaves_clear_stays_clear_of_its_copies_only() {
    // tracespace's discs in discs, 2 by 2: the last copy, painted over all others, is whole.
    let Some(reading) = real("features/step-repeats/multi-polarity-over-self.gbr") else { return };
    let raster = Raster::of_image(&reading.image, 0.0254, 100.0).unwrap();
    let dark = |x: f64, y: f64| {
        let at = (Vec2::new(x, y) * 25.4 - raster.origin) / raster.pixel;
        raster.dark[(raster.height - 1 - at.y as usize) * raster.width + at.x as usize]
    };
    // About (0.5, 0.5): dark to 0.1, clear to 0.2, dark to 0.3, clear to 0.4, dark to 0.5.
    for (radius, expected) in
        [(0.05, true), (0.15, false), (0.25, true), (0.35, false), (0.45, true)]
    {
        for angle in 0..12 {
            let at = Vec2::splat(0.5) + Vec2::from_angle(f64::from(angle)) * radius;
            assert_eq!(dark(at.x, at.y), expected, "{radius} {angle}");
        }
    }
}

#[test]
fn an_unclosed_region_of_the_fixtures_is_refused_with_its_gap() {
    let Some(folder) = data::folder() else { return };
    let file = folder.join("features/regions/region-with-lines.gbr");
    let errors = read("region-with-lines.gbr", &data::bytes(&file)).unwrap_err();
    // It starts at X 0.02 and ends at X 0.2 inches.
    assert_eq!((errors.len(), errors[0].rule.name(), errors[0].line), (1, "region-open", 14));
    assert!(errors[0].message.contains("4.572000 mm away"), "{}", errors[0].message);
}

#[test]
fn the_layers_of_kicad_say_what_they_are() {
    let Some(folder) = data::folder() else { return };
    let files = data::files(&folder.join("kicad"), ".gbr");
    assert_eq!(files.len(), 21);
    for file in files {
        let name = file.to_string_lossy();
        let reading = read(&name, &data::bytes(&file)).unwrap_or_else(|e| panic!("{e:#?}"));
        assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
        let function = reading.image.file_attribute(".FileFunction").unwrap().join(",");
        let expected = match () {
            () if name.ends_with("F_Cu.gbr") => "Copper,L1,Top",
            () if name.ends_with("Edge_Cuts.gbr") => "Profile,NP",
            () => "Copper,L",
        };
        assert!(function.starts_with(expected), "{name}: {function}");
        // Every operation of the file is an object, a move, or a segment of a region.
        let text = String::from_utf8(data::bytes(&file)).unwrap();
        let flashes = text.matches("D03*").count();
        let found = reading.image.objects.iter().filter(|o| matches!(o.shape, Shape::Flash { .. }));
        assert_eq!(found.count(), flashes, "{name}");
        assert_eq!(reading.image.regions.len(), text.matches("G37*").count(), "{name}");
    }
}
