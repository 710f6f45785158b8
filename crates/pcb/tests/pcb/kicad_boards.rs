//! Boards of KiCad 6 to 9 written by hand: what each version writes differently, and what is refused.

use geom::Vec2;
use geom::region::Region;
use program::Diagnostic;
use std::f64::consts::PI;
use toolpost_pcb::kicad::{self, Reading};
use toolpost_pcb::{Hole, HoleShape};

fn read(text: &str) -> Result<Reading, Vec<Diagnostic>> {
    kicad::read("some/board.kicad_pcb", text.as_bytes())
}

/// A board of KiCad 9 with these items.
fn board(items: &str) -> Reading {
    read(&whole(items)).unwrap_or_else(|errors| panic!("{items}: {errors:#?}"))
}

fn whole(items: &str) -> String {
    format!(
        "(kicad_pcb (version 20241229) (generator \"pcbnew\") (generator_version \"9.0\")\n\
         (general (thickness 1.6)) (paper \"A4\")\n\
         (layers (0 \"F.Cu\" signal) (2 \"B.Cu\" signal) (25 \"Edge.Cuts\" user))\n\
         (setup (pad_to_mask_clearance 0) (tenting front back))\n\
         (net 0 \"\") (net 1 \"GND\") (net 2 \"/A\\\"B\")\n{items}\n(embedded_fonts no))\n"
    )
}

/// A pad in a footprint at 100, 50.
fn pad(pad: &str) -> Reading {
    board(&format!("(footprint \"X\" (layer \"F.Cu\") (at 100 50) {pad})"))
}

fn front(reading: &Reading) -> &Region {
    &reading.board.front.copper.as_ref().expect("there is copper").region
}

fn back(reading: &Reading) -> &Region {
    &reading.board.back.copper.as_ref().expect("there is copper").region
}

#[track_caller]
fn assert_area(region: &Region, expected: f64) {
    let area = region.area();
    assert!((area - expected).abs() < 5e-6 * expected, "{area} is not {expected}");
}

#[track_caller]
fn assert_box(region: &Region, low: (f64, f64), high: (f64, f64)) {
    let (a, b) = region.extents().unwrap();
    let near = |p: Vec2, (x, y): (f64, f64)| p.distance(Vec2::new(x, y)) < 1e-6;
    assert!(near(a, low) && near(b, high), "{a} to {b}");
}

#[track_caller]
fn assert_refused(text: &str, rule: &str, line: u32) {
    let errors = read(text).expect_err("it is refused");
    assert_eq!((errors[0].rule.name(), errors[0].line), (rule, line), "{errors:#?}");
    assert!(!errors[0].help.is_empty() && errors[0].file.ends_with("board.kicad_pcb"));
}

fn rules(reading: &Reading) -> Vec<&str> {
    reading.warnings.iter().map(|warning| warning.rule.name()).collect()
}

/// The same board as each version writes it: a resistor that is turned, a track with an arc, a via, a zone, a
/// line, a round edge.
const VERSIONS: [&str; 4] = [
    r#"(kicad_pcb (version 20211014) (generator pcbnew)
  (general (thickness 1.6)) (paper "A4")
  (layers (0 "F.Cu" signal) (31 "B.Cu" signal) (44 "Edge.Cuts" user))
  (setup (pad_to_mask_clearance 0) (pcbplotparams (viasonmask false)))
  (net 0 "") (net 1 "GND")
  (footprint "R:R" locked (layer "F.Cu") (tedit 5F68FEEE) (tstamp 0a) (at 20 20 30)
    (descr "a resistor") (property "Sheetfile" "x.kicad_sch") (path "/1") (attr smd)
    (fp_text reference "R1" (at 0 -1 30) (layer "F.Cu") hide (effects (font (size 1 1) (thickness 0.15))) (tstamp 1))
    (fp_line (start -2 1) (end 2 1) (layer "F.Cu") (width 0.2) (tstamp 2))
    (pad "1" smd roundrect locked (at -1 0 30) (size 1 1.5) (layers "F.Cu" "F.Paste" "F.Mask") (roundrect_rratio 0.25) (net 1 "GND") (tstamp 3))
    (pad "2" thru_hole oval (at 1 0 30) (size 1 1.5) (drill oval 0.5 0.8 (offset 0.1 0)) (layers *.Cu *.Mask) (remove_unused_layers) (keep_end_layers) (tstamp 4)))
  (gr_circle (center 20 20) (end 35 20) (layer "Edge.Cuts") (width 0.1) (fill none) (tstamp 5))
  (segment (start 25 20) (end 28 20) (width 0.5) (layer "B.Cu") (net 1) (tstamp 6))
  (arc (start 28 20) (mid 28.707107 20.292893) (end 29 21) (width 0.5) (layer "B.Cu") (net 1) (tstamp 7))
  (via (at 25 20) (size 0.8) (drill 0.4) (layers "F.Cu" "B.Cu") (free) (net 1) (tstamp 8))
  (zone (net 1) (net_name "GND") (layer "F.Cu") (tstamp 9) (hatch edge 0.508)
    (connect_pads (clearance 0.3)) (min_thickness 0.254) (filled_areas_thickness no)
    (fill yes (thermal_gap 0.5) (thermal_bridge_width 0.5))
    (polygon (pts (xy 20 25) (xy 24 25) (xy 24 28) (xy 20 28)))
    (filled_polygon (layer "F.Cu") (island) (pts (xy 20 25) (xy 24 25) (xy 24 28) (xy 20 28))))
)"#,
    r#"(kicad_pcb (version 20221018) (generator pcbnew)
  (general (thickness 1.6)) (paper "A4")
  (layers (0 "F.Cu" signal) (31 "B.Cu" signal) (44 "Edge.Cuts" user))
  (setup (pad_to_mask_clearance 0) (pcbplotparams (viasonmask false)))
  (net 0 "") (net 1 "GND")
  (footprint "R:R" locked (layer "F.Cu") (tstamp 0a) (at 20 20 30)
    (descr "a resistor") (property "Sheetfile" "x.kicad_sch") (path "/1") (attr smd)
    (fp_text reference "R1" (at 0 -1 30) (layer "F.Cu") hide (effects (font (size 1 1) (thickness 0.15))) (tstamp 1))
    (fp_line (start -2 1) (end 2 1) (stroke (width 0.2) (type solid)) (layer "F.Cu") (tstamp 2))
    (pad "1" smd roundrect (at -1 0 30) (size 1 1.5) (layers "F.Cu" "F.Paste" "F.Mask") (roundrect_rratio 0.25) (net 1 "GND") (pintype "passive") (tstamp 3))
    (pad "2" thru_hole oval (at 1 0 30) (size 1 1.5) (drill oval 0.5 0.8 (offset 0.1 0)) (layers "*.Cu" "*.Mask") (remove_unused_layers) (keep_end_layers) (zone_layer_connections) (tstamp 4)))
  (gr_circle (center 20 20) (end 35 20) (stroke (width 0.1) (type default)) (fill none) (layer "Edge.Cuts") (tstamp 5))
  (segment (start 25 20) (end 28 20) (width 0.5) (layer "B.Cu") (net 1) (tstamp 6))
  (arc (start 28 20) (mid 28.707107 20.292893) (end 29 21) (width 0.5) (layer "B.Cu") (net 1) (tstamp 7))
  (via (at 25 20) (size 0.8) (drill 0.4) (layers "F.Cu" "B.Cu") (free) (net 1) (tstamp 8))
  (zone (net 1) (net_name "GND") (layers "F.Cu") (tstamp 9) (name "pour") (hatch edge 0.5) (priority 30000)
    (attr (teardrop (type padvia)))
    (connect_pads yes (clearance 0)) (min_thickness 0.0254) (filled_areas_thickness no)
    (fill yes (thermal_gap 0.5) (thermal_bridge_width 0.5) (island_removal_mode 1) (island_area_min 10))
    (polygon (pts (xy 20 25) (xy 24 25) (xy 24 28) (xy 20 28)))
    (filled_polygon (layer "F.Cu") (pts (xy 20 25) (xy 24 25) (xy 24 28) (xy 20 28))))
  (group "" (id 10) (members 6 7))
)"#,
    r#"(kicad_pcb
	(version 20240108)
	(generator "pcbnew")
	(generator_version "8.0")
	(general (thickness 1.6) (legacy_teardrops no))
	(paper "A4")
	(layers (0 "F.Cu" signal) (31 "B.Cu" signal) (44 "Edge.Cuts" user))
	(setup (pad_to_mask_clearance 0) (allow_soldermask_bridges_in_footprints no))
	(net 0 "")
	(net 1 "GND")
	(footprint "R:R" (locked yes) (layer "F.Cu") (uuid "0a") (at 20 20 30)
		(descr "a resistor")
		(property "Reference" "R1" (at 0 -1 30) (unlocked yes) (layer "F.Cu") (hide yes) (uuid "1")
			(effects (font (size 1 1) (thickness 0.15))))
		(property "Datasheet" "" (at 0 0 30) (layer "F.Fab") (hide yes) (uuid "1b") (effects (font (size 1 1))))
		(path "/1") (sheetname "Root") (sheetfile "x.kicad_sch") (attr smd)
		(fp_line (start -2 1) (end 2 1) (stroke (width 0.2) (type solid)) (layer "F.Cu") (uuid "2"))
		(pad "1" smd roundrect (at -1 0 30) (size 1 1.5) (layers "F.Cu" "F.Paste" "F.Mask") (roundrect_rratio 0.25) (net 1 "GND") (teardrops (best_length_ratio 0.5) (enabled yes)) (uuid "3"))
		(pad "2" thru_hole oval (at 1 0 30) (size 1 1.5) (drill oval 0.5 0.8 (offset 0.1 0)) (layers "*.Cu" "*.Mask") (remove_unused_layers no) (uuid "4"))
		(model "${KICAD8_3DMODEL_DIR}/R.wrl" (offset (xyz 0 0 0)) (scale (xyz 1 1 1)) (rotate (xyz 0 0 0))))
	(gr_circle (center 20 20) (end 35 20) (stroke (width 0.1) (type default)) (fill none) (locked yes) (layer "Edge.Cuts") (uuid "5"))
	(segment (start 25 20) (end 28 20) (width 0.5) (locked yes) (layer "B.Cu") (net 1) (uuid "6"))
	(arc (start 28 20) (mid 28.707107 20.292893) (end 29 21) (width 0.5) (layer "B.Cu") (net 1) (uuid "7"))
	(via (at 25 20) (size 0.8) (drill 0.4) (layers "F.Cu" "B.Cu") (free yes) (net 1) (uuid "8"))
	(zone (net 1) (net_name "GND") (layer "F.Cu") (uuid "9") (hatch edge 0.5)
		(connect_pads (clearance 0.3)) (min_thickness 0.25) (filled_areas_thickness no)
		(fill yes (mode hatch) (thermal_gap 0.5) (thermal_bridge_width 0.5) (hatch_thickness 1) (hatch_gap 1.5))
		(polygon (pts (xy 20 25) (xy 24 25) (xy 24 28) (xy 20 28)))
		(filled_polygon (layer "F.Cu") (island) (pts (xy 20 25) (xy 24 25) (xy 24 28) (xy 20 28))))
	(group "" (uuid "10") (members "6" "7"))
	(generated (uuid "11") (type tuning_pattern) (name "Tuning Pattern") (layer "B.Cu")
		(base_line (pts (xy 25 20) (xy 28 20))) (last_netname "GND") (members "6" "7"))
)"#,
    r#"(kicad_pcb
	(version 20241229)
	(generator "pcbnew")
	(generator_version "9.0")
	(general (thickness 1.6) (legacy_teardrops no))
	(paper "A4")
	(layers (0 "F.Cu" signal) (2 "B.Cu" signal) (25 "Edge.Cuts" user) (1 "F.Mask" user))
	(setup (pad_to_mask_clearance 0) (tenting front back))
	(net 0 "")
	(net 1 "GND")
	(footprint "R:R" (locked yes) (layer "F.Cu") (uuid "0a") (at 20 20 30)
		(descr "a resistor")
		(property "Reference" "R1" (at 0 -1 30) (unlocked yes) (layer "F.Cu") (hide yes) (uuid "1")
			(effects (font (size 1 1) (thickness 0.15))))
		(component_classes (class "power"))
		(path "/1") (sheetname "Root") (sheetfile "x.kicad_sch") (attr smd)
		(fp_line (start -2 1) (end 2 1) (stroke (width 0.2) (type solid)) (layers "F.Cu" "F.Mask") (solder_mask_margin 0.1) (uuid "2"))
		(pad "1" smd roundrect (at -1 0 30) (size 1 1.5) (layers "F.Cu" "F.Mask" "F.Paste") (roundrect_rratio 0.25) (net 1 "GND") (tenting front) (uuid "3"))
		(pad "2" thru_hole oval (at 1 0 30) (size 1 1.5) (drill oval 0.5 0.8 (offset 0.1 0)) (layers "*.Cu" "*.Mask") (remove_unused_layers no) (uuid "4"))
		(embedded_fonts no)
		(embedded_files (file (name "R.step") (type model) (data |KLUv/WBkAQ0AAA==| ) (checksum "0"))))
	(gr_circle (center 20 20) (end 35 20) (stroke (width 0.1) (type default)) (fill no) (layer "Edge.Cuts") (uuid "5"))
	(segment (start 25 20) (end 28 20) (width 0.5) (locked yes) (layers "B.Cu" "B.Mask") (solder_mask_margin 0.1) (net 1) (uuid "6"))
	(arc (start 28 20) (mid 28.707107 20.292893) (end 29 21) (width 0.5) (layer "B.Cu") (net 1) (uuid "7"))
	(via (at 25 20) (size 0.8) (drill 0.4) (layers "F.Cu" "B.Cu") (free yes) (tenting none) (net 1) (uuid "8"))
	(zone (net 1) (net_name "GND") (layer "F.Cu") (uuid "9") (hatch edge 0.5)
		(connect_pads (clearance 0.3)) (min_thickness 0.25) (filled_areas_thickness no)
		(fill yes (thermal_gap 0.5) (thermal_bridge_width 0.5))
		(polygon (pts (xy 20 25) (xy 24 25) (xy 24 28) (xy 20 28)))
		(filled_polygon (layer "F.Cu") (pts (xy 20 25) (xy 24 25) (xy 24 28) (xy 20 28))))
	(group "" (uuid "10") (locked yes) (members "6" "7"))
	(embedded_fonts no)
)"#,
];

#[test]
fn every_version_says_the_same() {
    let first = read(VERSIONS[0]).unwrap();
    for text in VERSIONS {
        let reading = read(text).unwrap_or_else(|errors| panic!("{errors:#?}"));
        assert_eq!(reading.warnings, [], "{:#?}", reading.warnings);
        assert_eq!(reading.board, first.board);
    }
    let board = &first.board;
    assert_eq!(board.name, "board");
    assert_area(board.outline.as_ref().unwrap(), PI * 225.0);
    // Zone, rounded pad (radius 0.25), oval pad, line, via; nothing touches.
    let oval = 0.5 + PI / 4.0;
    let parts = [12.0, 1.5 - (4.0 - PI) / 16.0, oval, 0.8 + PI / 100.0, 0.16 * PI];
    assert_area(front(&first), parts.iter().sum());
    let nets: Vec<Option<&str>> =
        board.front.copper.as_ref().unwrap().nets.iter().map(|net| net.as_deref()).collect();
    assert_eq!(nets.iter().filter(|net| **net == Some("GND")).count(), 3);
    assert_eq!(nets.iter().filter(|net| net.is_none()).count(), 2);
    // Turned by 30° against the clock, and on the screen Y points down: up and to the right.
    let pad = Vec2::new(20.0, -20.0) + Vec2::from_angle(PI / 6.0);
    assert!(front(&first).contains(pad) && back(&first).contains(pad));
    let [slot, via] = &board.holes[..] else { panic!("{:?}", board.holes) };
    let HoleShape::Slot(a, b) = &slot.shape else { panic!("{slot:?}") };
    let along = Vec2::from_angle(PI / 6.0 + PI / 2.0) * 0.15;
    assert!(a.distance(pad - along) < 1e-9 && b.distance(pad + along) < 1e-9);
    assert_eq!((slot.diameter, slot.plated), (0.5, Some(true)));
    let at = HoleShape::Round(Vec2::new(25.0, -20.0));
    assert_eq!(*via, Hole { shape: at, diameter: 0.4, plated: Some(true) });
    // The track, straight and round, from the middle of the via, and half a disc at its end.
    let under_via = 0.25 * 0.0975f64.sqrt() + 0.16 * 0.625f64.asin();
    let track = 1.5 + 0.5 * PI / 2.0 + PI / 32.0 - under_via;
    assert_area(back(&first), oval + 0.16 * PI + track);
    assert!(back(&first).contains(Vec2::new(28.0, -21.0) + Vec2::from_angle(PI / 4.0)));
}

#[test]
fn pads_of_every_shape() {
    // (area, low corner, high corner), about the middle of the footprint.
    type Expected = (f64, (f64, f64), (f64, f64));
    let shapes: [(&str, Expected); 12] = [
        ("circle (at 0 0) (size 2 2)", (PI, (-1.0, -1.0), (1.0, 1.0))),
        ("rect (at 1 2) (size 2 3)", (6.0, (0.0, -3.5), (2.0, -0.5))),
        ("rect (at 1 2 90) (size 2 3)", (6.0, (-0.5, -3.0), (2.5, -1.0))),
        ("oval (at 0 0) (size 3 2)", (2.0 + PI, (-1.5, -1.0), (1.5, 1.0))),
        // The left side is 1 mm longer than the right one.
        ("trapezoid (at 0 0) (size 4 2) (rect_delta 1 0)", (8.0, (-2.0, -1.5), (2.0, 1.5))),
        // The lower side is 1 mm longer than the upper one.
        ("trapezoid (at 0 0) (size 4 2) (rect_delta 0 1)", (8.0, (-2.5, -1.0), (2.5, 1.0))),
        (
            "roundrect (at 0 0) (size 4 2) (roundrect_rratio 0.5)",
            (4.0 + PI, (-2.0, -1.0), (2.0, 1.0)),
        ),
        (
            "roundrect (at 0 0) (size 4 2) (roundrect_rratio 0) (chamfer_ratio 0.25) (chamfer top_left bottom_right)",
            (7.75, (-2.0, -1.0), (2.0, 1.0)),
        ),
        (
            "roundrect (at 0 0) (size 4 2) (roundrect_rratio 0.1) (chamfer_ratio 0.5) (chamfer top_right)",
            (7.5 - 3.0 * (0.04 - 0.01 * PI), (-2.0, -1.0), (2.0, 1.0)),
        ),
        (
            "custom (at 0 0) (size 1 1) (options (clearance outline) (anchor rect)) (primitives (gr_poly (pts (xy 0.5 -0.5) (xy 1.5 -0.5) (xy 0.5 0.5)) (width 0) (fill yes)))",
            (1.5, (-0.5, -0.5), (1.5, 0.5)),
        ),
        (
            "custom (at 0 0) (size 1 1) (options (anchor circle)) (primitives (gr_line (start 0 0) (end 3 0) (width 1)) (gr_bbox (start 0 0) (end 9 9)) (gr_vector (start 0 0) (end 9 9)))",
            (3.0 + PI / 4.0, (-0.5, -0.5), (3.5, 0.5)),
        ),
        // Turned by 90° to the left: what is to the right goes up.
        (
            "custom (at 0 0 90) (size 0.2 0.2) (primitives (gr_rect (start 0 -1) (end 3 1) (width 0) (fill yes)) (gr_circle (center 3 0) (end 4 0) (width 0) (fill yes)) (gr_arc (start 0 -1) (mid -1 0) (end 0 1) (width 0)))",
            (6.0 + PI / 2.0 + PI * 0.005, (-1.0, -0.1), (1.0, 4.0)),
        ),
    ];
    for (shape, (area, low, high)) in shapes {
        let reading =
            pad(&format!("(pad \"1\" smd {shape} (layers \"F.Cu\" \"F.Mask\") (net 1 \"GND\"))"));
        assert_area(front(&reading), area);
        let moved = |(x, y): (f64, f64)| (100.0 + x, -50.0 + y);
        assert_box(front(&reading), moved(low), moved(high));
        assert_eq!(reading.board.back.copper, None);
        assert_eq!(reading.board.front.copper.as_ref().unwrap().nets[0].as_deref(), Some("GND"));
    }
    // Which corners are cut off: top is up, also here.
    let cut = pad(
        "(pad \"1\" smd roundrect (at 0 0) (size 2 2) (layers \"F.Cu\") (chamfer_ratio 0.3) (chamfer top_right))",
    );
    assert!(!front(&cut).contains(Vec2::new(100.9, -49.1)));
    assert!(
        front(&cut).contains(Vec2::new(99.1, -49.1))
            && front(&cut).contains(Vec2::new(100.9, -50.9))
    );
    let trapezoid =
        pad("(pad \"1\" smd trapezoid (at 0 0) (size 4 2) (rect_delta 0 1) (layers \"F.Cu\"))");
    assert!(front(&trapezoid).contains(Vec2::new(102.3, -50.9)));
    assert!(!front(&trapezoid).contains(Vec2::new(102.3, -49.1)));
}

#[test]
fn a_pad_turns_with_its_footprint_and_stands_on_its_side() {
    // Its place is relative, its angle is not. To the right of a part that is turned by 90° is above it.
    let reading = board(
        "(footprint \"X\" (layer \"B.Cu\") (at 10 10 90) \
         (pad \"1\" smd rect (at 3 0 90) (size 2 1) (drill (offset 0.5 0)) (layers \"B.Cu\" \"B.Mask\")))",
    );
    assert_eq!((&reading.board.front.copper, reading.board.holes.len()), (&None, 0));
    assert_box(back(&reading), (9.5, -7.5), (10.5, -5.5));
}

#[test]
fn holes_plated_or_not_round_or_long() {
    let hole = |text: &str| pad(text).board;
    let board = hole(
        "(pad \"\" np_thru_hole circle (at 1 1) (size 3 3) (drill 3) (layers \"*.Cu\" \"*.Mask\"))",
    );
    assert_eq!(board.front.copper, None);
    let at = HoleShape::Round(Vec2::new(101.0, -51.0));
    assert_eq!(board.holes, [Hole { shape: at, diameter: 3.0, plated: Some(false) }]);
    // With a ring of copper.
    let ring =
        hole("(pad \"\" np_thru_hole circle (at 0 0) (size 4 4) (drill 3) (layers \"F&B.Cu\"))");
    assert_area(&ring.back.copper.unwrap().region, 4.0 * PI);
    let slot = hole(
        "(pad \"1\" thru_hole oval (at 0 0 90) (size 4 2) (drill oval 3 1) (layers \"*.Cu\"))",
    );
    let HoleShape::Slot(a, b) = slot.holes[0].shape else { panic!("{:?}", slot.holes) };
    assert!(
        a.distance(Vec2::new(100.0, -51.0)) < 1e-9 && b.distance(Vec2::new(100.0, -49.0)) < 1e-9
    );
    assert_eq!(slot.holes[0].diameter, 1.0);
}

#[test]
fn stacks_of_pads_and_vias_differ_between_the_sides() {
    let reading =
        pad("(pad \"1\" thru_hole circle (at 0 0) (size 2 2) (drill 1) (layers \"*.Cu\") \
         (padstack (mode front_inner_back) (layer \"Inner\" (shape circle) (size 1.2 1.2)) \
         (layer \"B.Cu\" (shape rect) (size 4 3) (offset 1 0))))");
    assert_area(front(&reading), PI);
    assert_box(back(&reading), (99.0, -51.5), (103.0, -48.5));
    let via = board(
        "(via (at 5 5) (size 1) (drill 0.4) (layers \"F.Cu\" \"B.Cu\") \
         (padstack (mode custom) (layer \"In1.Cu\" (size 0.7)) (layer \"B.Cu\" (size 2))) (net 2))",
    );
    assert_area(front(&via), PI / 4.0);
    assert_area(back(&via), PI);
    assert_eq!(via.board.back.copper.unwrap().nets[0].as_deref(), Some("/A\"B"));
}

#[test]
fn zones_have_the_fill_that_is_stored() {
    let zone = |head: &str, fills: &str| {
        let text = format!(
            "(zone (net 1) (net_name \"GND\") {head} (hatch edge 0.5) (min_thickness 0.2) \
            (fill yes) (polygon (pts (xy 0 0) (xy 9 0) (xy 9 9))) {fills})"
        );
        board(&text)
    };
    let square = "(pts (xy 0 0) (xy 4 0) (xy 4 4) (xy 0 4))";
    let both = zone(
        "(layers \"F.Cu\" \"B.Cu\") (filled_areas_thickness no)",
        &format!(
            "(filled_polygon (layer \"F.Cu\") {square}) (filled_polygon (layer \"B.Cu\") (island) {square})"
        ),
    );
    assert_eq!(rules(&both), [""; 0]);
    assert_area(front(&both), 16.0);
    assert_area(back(&both), 16.0);
    // The path of a pen, where the zone does not say that it is not.
    let stroked = zone("(layer \"F.Cu\")", &format!("(filled_polygon (layer \"F.Cu\") {square})"));
    assert_area(front(&stroked), 16.0 + 4.0 * 0.4 + PI * 0.01);
    // A hole that is cut into the outline, as KiCad stores it.
    let cut = zone(
        "(layer \"F.Cu\") (filled_areas_thickness no)",
        "(filled_polygon (layer \"F.Cu\") (pts (xy 0 0) (xy 4 0) (xy 4 4) (xy 2 4) (xy 2 3) (xy 3 3) (xy 3 1) (xy 1 1) (xy 1 3) (xy 2 3) (xy 2 4) (xy 0 4)))",
    );
    assert_area(front(&cut), 12.0);
    assert_eq!(front(&cut).islands()[0].holes().len(), 1);
    // Not filled on the back.
    let hollow = zone(
        "(layers \"F&B.Cu\") (filled_areas_thickness no)",
        &format!("(filled_polygon (layer \"F.Cu\") {square})"),
    );
    assert_eq!(rules(&hollow), ["zone-fill"]);
    let keepout = zone("(layers \"F&B.Cu\") (keepout (tracks not_allowed))", "");
    assert_eq!((rules(&keepout), &keepout.board.front.copper), (vec![], &None));
    // In a footprint it is where it is on the board.
    let inside = board(&format!(
        "(footprint \"X\" (layer \"F.Cu\") (at 50 50 45) (zone (net 0) (net_name \"\") (layer \"F.Cu\") \
        (filled_areas_thickness no) (fill yes) (polygon {square}) (filled_polygon (layer \"F.Cu\") {square})))"
    ));
    assert_box(front(&inside), (0.0, -4.0), (4.0, 0.0));
}

#[test]
fn graphics_and_texts_on_copper() {
    let drawn = board(
        "(gr_rect (start 0 0) (end 4 3) (stroke (width 0) (type default)) (fill yes) (layers \"B.Cu\" \"B.Mask\") (net 2))",
    );
    assert_area(back(&drawn), 12.0);
    assert_eq!(drawn.board.back.copper.unwrap().nets[0].as_deref(), Some("/A\"B"));
    let dashed =
        board("(gr_line (start 0 0) (end 4 0) (stroke (width 1) (type dash)) (layer \"F.Cu\"))");
    assert_eq!(rules(&dashed), ["line-style"]);
    // A font of the system: its outlines, with holes, where they are on the board.
    let stored = board(
        "(footprint \"X\" (layer \"F.Cu\") (at 50 50 45) (fp_text user \"O\" (at 0 0 45) (layer \"F.Cu\") \
         (effects (font (face \"Arial\") (size 1 1) (thickness 0.1))) \
         (render_cache \"O\" 45 (polygon (pts (xy 0 0) (xy 4 0) (xy 4 4) (xy 0 4)) (pts (xy 1 1) (xy 3 1) (xy 3 3) (xy 1 3))))))",
    );
    assert_eq!(rules(&stored), [""; 0]);
    assert_area(front(&stored), 12.0);
    assert_box(front(&stored), (0.0, -4.0), (4.0, 0.0));
    // Our L: 2 mm high, 1 mm wide for a width of 1.5 mm, with a pen of 0.2 mm; then from right to left.
    let text = |effects: &str, at: &str| {
        board(&format!(
            "(gr_text \"L\" (at {at}) (layer \"F.Cu\") (effects (font (size 2 1.5) (thickness 0.2)) {effects}))"
        ))
    };
    let letter = text("(justify left bottom)", "10 10");
    assert_eq!(rules(&letter), ["text-letters"]);
    assert_box(front(&letter), (9.9, -10.1), (11.1, -7.9));
    assert_box(
        front(&text("(justify left bottom mirror)", "10 10 90")),
        (9.9 - 2.0, -11.1),
        (10.1, -9.9),
    );
    assert_box(front(&text("(justify right top)", "10 10")), (8.5, -12.1), (9.7, -9.9));
    for hidden in ["(effects (font (size 1 1)) hide)", "(hide yes) (effects (font (size 1 1)))"] {
        let text = format!("(gr_text \"x\" (at 0 0) (layer \"F.Cu\") {hidden})");
        assert_eq!(board(&text).board.front.copper, None);
    }
    let variable =
        board("(gr_text \"${REVISION}\" (at 0 0) (layer \"F.Cu\") (effects (font (size 1 1))))");
    assert_eq!((rules(&variable), &variable.board.front.copper), (vec!["text-variable"], &None));
    // Elsewhere they are of no meaning.
    let silk = board(
        "(gr_text \"x\" (at 0 0) (layer \"F.SilkS\") (effects (font (size 1 1)))) (dimension (type aligned) (layer \"Cmts.User\")) (table (column_count 1) (layer \"F.Fab\")) (image (at 0 0) (layer \"F.SilkS\"))",
    );
    assert_eq!((rules(&silk), &silk.board.front.copper), (vec![], &None));
}

#[test]
fn the_edge_has_lines_arcs_curves_and_cut_outs_also_in_footprints() {
    let edge = |items: &str| {
        board(&items.replace("EDGE", "(stroke (width 0.1) (type default)) (layer \"Edge.Cuts\")"))
            .board
            .outline
            .unwrap()
    };
    let rounded = edge(
        "(gr_line (start 0 0) (end 10 0) EDGE) (gr_arc (start 10 0) (mid 15 5) (end 10 10) EDGE) \
        (gr_poly (pts (xy 2 2) (xy 4 2) (xy 4 4) (xy 2 4)) (fill no) EDGE) (gr_line (start 10 10) (end 0 10) EDGE) (gr_line (start 0 0) (end 0 10) EDGE) \
        (footprint \"hole\" (layer \"F.Cu\") (at 7 7 90) (fp_circle (center 1 0) (end 2 0) EDGE))",
    );
    assert_area(&rounded, 100.0 + 12.5 * PI - 4.0 - PI);
    assert!(!rounded.contains(Vec2::new(7.0, -6.0)) && rounded.contains(Vec2::new(8.5, -7.0)));
    // A Bézier's area with its chord: 3/20 of the cross products of its points.
    let curved = edge(
        "(gr_curve (pts (xy 0 0) (xy 0 -10) (xy 20 -10) (xy 20 0)) EDGE) (gr_line (start 20 0) (end 0 0) EDGE)",
    );
    assert!((curved.area() - 120.0).abs() < 0.02, "{}", curved.area());
    let arcs = curved.rings().flat_map(|ring| ring.elements()).filter(|e| e.turn.is_some()).count();
    assert!((4..40).contains(&arcs), "{arcs}");
    assert_eq!(
        board("(segment (start 0 0) (end 1 0) (width 1) (layer \"F.Cu\") (net 0))").board.outline,
        None
    );
    let target = board("(target plus (at 0 0) (size 5) (width 0.1) (layer \"Edge.Cuts\"))");
    assert_eq!((rules(&target), &target.board.outline), (vec!["not-an-edge"], &None));
}

#[test]
fn what_cannot_be_made_is_refused() {
    let item = |text: &str, rule: &str| assert_refused(&whole(text), rule, 6);
    item(
        "(via blind (at 0 0) (size 1) (drill 0.4) (layers \"F.Cu\" \"In1.Cu\") (net 1))",
        "blind-via",
    );
    item(
        "(via (at 0 0) (size 1) (drill 0.4) (layers \"F.Cu\" \"B.Cu\") (remove_unused_layers yes) (keep_end_layers no) (zone_layer_connections) (net 1))",
        "unused-layers",
    );
    item("(dimension (type aligned) (layer \"F.Cu\") (pts (xy 0 0) (xy 1 1)))", "item");
    item("(table (column_count 2) (layer \"B.Cu\"))", "item");
    item("(gr_text_box \"x\" (start 0 0) (end 1 1) (layer \"F.Cu\"))", "item");
    item(
        "(gr_text \"x\" (at 0 0) (layer \"F.Cu\" knockout) (effects (font (size 1 1))))",
        "text-knockout",
    );
    item(
        "(zone (net 1) (layer \"F.Cu\") (fill yes) (fill_segments (pts (xy 0 0) (xy 1 1))))",
        "zone-fill",
    );
    item("(segment (start 0 0) (end 1 1) (width 1) (layer \"F.Cu\") (net 7))", "net");
    item("(segment (start 0 0) (width 1) (layer \"F.Cu\") (net 1))", "missing");
    item("(segment (start 0 x) (end 1 1) (width 1) (layer \"F.Cu\") (net 1))", "not-a-number");
    item("(segment (start 0 3000) (end 1 1) (width 1) (layer \"F.Cu\") (net 1))", "not-a-number");
    item("(segment (start 0 0) (end 1 1) (width -1) (layer \"F.Cu\") (net 1))", "not-a-length");
    item("(gr_curve (pts (xy 0 0) (xy 1 1)) (width 1) (layer \"F.Cu\"))", "curve");
    item("(gr_arc (start 0 0) (mid 100 0.04) (end 200 0) (width 1) (layer \"F.Cu\"))", "arc");
    item("(gr_line (start 0 0) (end 10 0) (width 0.1) (layer \"Edge.Cuts\"))", "outline-open");
    let footprint = |pad: &str, rule: &str| {
        item(&format!("(footprint \"X\" (layer \"F.Cu\") (at 0 0) {pad})"), rule)
    };
    footprint("(pad \"1\" smd star (at 0 0) (size 1 1) (layers \"F.Cu\"))", "pad");
    footprint("(pad \"1\" odd rect (at 0 0) (size 1 1) (layers \"F.Cu\"))", "pad");
    footprint("(pad \"1\" smd rect (at 0 0) (size 0 1) (layers \"F.Cu\"))", "pad");
    footprint(
        "(pad \"1\" thru_hole rect (at 0 0) (size 2 2) (drill 0) (layers \"*.Cu\"))",
        "drill",
    );
    footprint(
        "(pad \"1\" smd roundrect (at 0 0) (size 1 1) (layers \"F.Cu\") (roundrect_rratio 0.7))",
        "pad",
    );
    footprint(
        "(pad \"1\" smd trapezoid (at 0 0) (size 1 1) (rect_delta 3 0) (layers \"F.Cu\"))",
        "pad",
    );
}

/// What KiCad 5.1 writes: modules, words without quotes, vias with the drill of their class, and polygons without a word for their
/// filling.
#[test]
fn a_board_of_kicad_5() {
    let text = "(kicad_pcb (version 20171130) (host pcbnew 5.1.9)\n(general (thickness 1.6) (nets 3))\n\
        (layers (0 F.Cu signal) (31 B.Cu signal) (44 Edge.Cuts user))\n\
        (net 0 \"\") (net 1 GND) (net 2 /A)\n\
        (net_class Default \"This is the default net class.\" (via_dia 0.8) (via_drill 0.4) (add_net GND))\n\
        (net_class Power \"\" (via_dia 1.2) (via_drill 0.6) (add_net /A))\n\
        (module R_0805 (layer F.Cu) (tedit 5B36C52B) (tstamp 5C1B2A3D) (at 10 10 90)\n\
        (fp_text reference R1 (at 0 0 90) (layer F.SilkS) (effects (font (size 1 1))))\n\
        (fp_poly (pts (xy 0 0) (xy 2 0) (xy 2 2) (xy 0 2)) (layer F.Cu) (width 0))\n\
        (pad 1 thru_hole circle (at -3 0 90) (size 2 2) (drill 0.8) (layers *.Cu *.Mask) (net 1 GND)))\n\
        (segment (start 20 10) (end 30 10) (width 0.5) (layer B.Cu) (net 2))\n\
        (via (at 20 10) (size 1.2) (layers F.Cu B.Cu) (net 2)) (via (at 5 5) (size 0.8) (layers F.Cu B.Cu) (net 1))\n\
        (gr_line (start 0 0) (end 40 0) (angle 90) (layer Edge.Cuts) (width 0.1))\n\
        (gr_line (start 40 0) (end 40 20) (layer Edge.Cuts) (width 0.1))\n\
        (gr_line (start 40 20) (end 0 20) (layer Edge.Cuts) (width 0.1))\n\
        (gr_line (start 0 20) (end 0 0) (layer Edge.Cuts) (width 0.1)))\n";
    let board = read(text).unwrap().board;
    // Y points down in the file: the module is turned by 90° counter-clockwise, its pad 3 mm below its place.
    let mut holes: Vec<_> = board
        .holes
        .iter()
        .map(|hole| match hole.shape {
            HoleShape::Round(at) => (hole.diameter, at.x, at.y),
            _ => panic!("{hole:?}"),
        })
        .collect();
    holes.sort_by(|a, b| a.partial_cmp(b).unwrap());
    let near = |a: (f64, f64, f64), b: (f64, f64, f64)| {
        (a.0 - b.0).abs() < 1e-9 && (a.1 - b.1).abs() < 1e-9 && (a.2 - b.2).abs() < 1e-9
    };
    assert!(near(holes[0], (0.4, 5.0, -5.0)) && near(holes[1], (0.6, 20.0, -10.0)), "{holes:?}");
    assert!(near(holes[2], (0.8, 10.0, -13.0)), "{holes:?}");
    let front = board.front.copper.as_ref().unwrap();
    // A pad of 2 mm, two vias of 1.2 and 0.8 mm, and a filled square of 2 mm, which goes up and to the left of its place.
    let right = PI * (1.0 + 0.36 + 0.16) + 4.0;
    assert!((front.region.area() - right).abs() < 1e-3, "{}", front.region.area());
    assert!(front.region.contains(Vec2::new(11.0, -9.0)));
    assert_eq!(board.outline.unwrap().area().round(), 800.0);
}

#[test]
fn what_is_no_board_of_these_versions_is_refused() {
    assert_refused("(kicad_pcb\n(version 4) (host pcbnew 4.0.7))", "version", 2);
    assert_refused("(kicad_pcb\n(version 20200119) (host pcbnew 5.99))", "version", 2);
    let named = "(kicad_pcb (version 20171130)\n(layers (0 Dessus signal) (31 B.Cu signal)))";
    assert_refused(named, "layer", 2);
    assert_refused("(kicad_pcb (version 20260101) (generator_version \"10.0\"))", "version", 1);
    let newer = read("(kicad_pcb (version 20260101))").unwrap_err();
    assert!(newer[0].message.contains("20260101") && newer[0].message.contains("20241229"));
    assert_refused("(kicad_pcb (generator pcbnew))", "missing", 1);
    assert_refused("(kicad_pcb (version new))", "version", 1);
    assert_refused("(kicad_sch (version 20211014))", "not-kicad", 1);
    assert_refused("%FSLAX46Y46*%\n", "not-kicad", 1);
    assert_refused("", "not-kicad", 1);
    assert_refused("(kicad_pcb (version 20211014)) (more)", "not-kicad", 1);
    assert_refused("(kicad_pcb\n (version 20211014)\n (footprint", "list-open", 3);
    assert_refused("(kicad_pcb (version 20211014)))", "list-closed", 1);
    assert_refused("(kicad_pcb (version 20211014) (paper \"A4))", "text-open", 1);
    assert_refused(&format!("{}\n", "(a".repeat(1000)), "list-depth", 1);
}

/// Text of several lines moves the lines behind it.
#[test]
fn findings_are_at_their_line() {
    let text = "(kicad_pcb (version 20241229)\n(title_block (comment 1 \"two\nlines\"))\n(via (at 0 0) (size 1) (layers \"F.Cu\" \"B.Cu\")))";
    let errors = read(text).unwrap_err();
    assert_eq!((errors[0].rule.name(), errors[0].line, errors[0].column), ("missing", 4, 1));
    assert!(errors[0].message.contains("drill"), "{}", errors[0].message);
}

#[test]
fn time_grows_with_the_file() {
    let mut text = String::from("(kicad_pcb (version 20241229) (net 1 \"GND\")");
    while text.len() < 10_000_000 {
        text.push_str("(gr_line (start 0 0) (end 1 1) (stroke (width 0.1) (type solid)) (layer \"F.SilkS\"))\n");
    }
    text.push(')');
    let begun = std::time::Instant::now();
    assert_eq!(read(&text).unwrap().board.front.copper, None);
    assert!(begun.elapsed().as_secs() < 30);
}
