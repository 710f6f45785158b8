//! What drill files mean: the manual of the CNC-7, and what the files say.

use crate::data;
use geom::Vec2;
use std::f64::consts::PI;
use toolpost_pcb::HoleShape;
use toolpost_pcb::excellon::{Drill, Reading, read};

fn reading(text: &str) -> Reading {
    read("board.drl", text.as_bytes()).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

fn drill(text: &str) -> Drill {
    reading(text).drill
}

/// The holes, in mm.
fn holes(drill: &Drill) -> Vec<Vec2> {
    let hole = |path: &HoleShape| match path {
        HoleShape::Round(at) => Some(*at),
        _ => None,
    };
    drill.cuts.iter().filter_map(|cut| hole(&cut.path)).collect()
}

#[track_caller]
fn assert_near(found: &[Vec2], expected: &[(f64, f64)]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (point, (x, y)) in found.iter().zip(expected) {
        assert!(point.distance(Vec2::new(*x, *y)) < 1e-9, "{point} is not {x}, {y}");
    }
}

#[test]
fn the_manual_s_header_and_its_zeros() {
    // FlatCAM's example of the format: INCH,LZ with 00.0000.
    let text = "M48\nINCH,LZ\nVER,1\nFMAT,2\n1/2/3\nDETECT,ON\nT1C.04F200S65\nM95\nT1\nX12345Y23450\nX012345Y234500\nM30\n";
    let reading = reading(text);
    let inch = 25.4;
    assert_near(
        &holes(&reading.drill),
        &[(12.345 * inch, 23.45 * inch), (1.2345 * inch, 23.45 * inch)],
    );
    assert!((reading.drill.tools[0].diameter - 1.016).abs() < 1e-12);
    assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
}

#[test]
fn coordinates_are_modal_and_may_be_incremental() {
    let text = "M48\nMETRIC,TZ\nT1C0.8\nT02C1.0\n%\nT1\nX1000Y2000\nX1500\nG91\nY-500\nX10Y10\nG90\nT2\nX0Y0\nM30";
    let drill = drill(text);
    assert_near(&holes(&drill), &[(1.0, 2.0), (1.5, 2.0), (1.5, 1.5), (1.51, 1.51), (0.0, 0.0)]);
    assert_eq!(drill.cuts.iter().map(|cut| cut.tool).collect::<Vec<_>>(), [0, 0, 0, 0, 1]);
    assert_eq!(drill.cuts[2].line, 10);
    let incremental = "M48\nICI,ON\nMETRIC\nT1C1.0\n%\nT1\nX1.0Y1.0\nX1.0\nM30";
    assert_near(&holes(&self::drill(incremental)), &[(1.0, 1.0), (2.0, 1.0)]);
}

#[test]
fn formats_stated_in_the_header_and_in_comments() {
    let first = |text: &str| holes(&drill(text))[0];
    let near = |text: &str, x: f64, y: f64| assert_near(&[first(text)], &[(x, y)]);
    near("M48\nMETRIC,TZ,000.00\nT1C1.0\n%\nT1\nX12345Y1\nM30", 123.45, 0.01);
    near("M48\nMETRIC,LZ,0000.00\nT1C1.0\n%\nT1\nX012345Y1\nM30", 123.45, 1000.0);
    near(
        "M48\n;FILE_FORMAT=2:5\nINCH,TZ\nT1F00S00C0.03937\n%\nT01\nX0100000Y200000\nM30",
        25.4,
        50.8,
    );
    let kicad = "M48\n; FORMAT={3:3/ absolute / metric / suppress leading zeros}\nFMAT,2\nMETRIC,TZ\nT1C1.0\n%\nG90\nG05\nT1\nX12345Y-500\nT0\nM30";
    near(kicad, 12.345, -0.5);
    near("%\nM48\nM72,TZ\nT01C0.0236\n%\nT01\nX16910Y10810\nM30", 1.691 * 25.4, 1.081 * 25.4);
}

#[test]
fn what_is_not_said_is_concluded_from_the_coordinates() {
    let concluded = |text: &str| {
        let reading = reading(text);
        let rules: Vec<&str> = reading.warnings.iter().map(|warning| warning.rule.name()).collect();
        (holes(&reading.drill)[0], rules.join(" "))
    };
    // Short coordinates that end with zeros can only lack those in front.
    let (at, rules) = concluded("M48\nM72\nT01C0.0236\n%\nT01\nX16910Y10810\nM30");
    assert_near(&[at], &[(1.691 * 25.4, 1.081 * 25.4)]);
    assert_eq!(rules, "zeros-concluded");
    let (at, rules) = concluded("M48\nINCH\nT01C0.0236\n%\nT01\nX01691Y01081\nM30");
    assert_near(&[at], &[(1.691 * 25.4, 1.081 * 25.4)]);
    assert_eq!(rules, "zeros-concluded");
    // The unit from the diameters; coordinates with a point need no zeros.
    let (at, rules) = concluded("M48\nT01C0.3\nT02C1.2\n%\nT01\nX16.9Y10.8\nM30");
    assert_near(&[at], &[(16.9, 10.8)]);
    assert_eq!(rules, "unit-concluded");
    // The unit behind the tools is that of the tools too, whatever their widths could be.
    for text in
        ["M48\nT01C0.0320\n%\nM72\nT01\nX1.0Y2.0\nM30", "T01C0.125\nM72\nT01\nX1.0Y2.0\nM30"]
    {
        let (at, rules) = concluded(text);
        assert_near(&[at], &[(25.4, 50.8)]);
        assert_eq!(rules, "unit-concluded");
        assert!(
            reading(text).warnings[0].message.starts_with("M72 stands behind the first length")
        );
    }
    let (at, rules) = concluded("T01C0.020\nT01\nX1.0Y2.0\nM30");
    assert_near(&[at], &[(25.4, 50.8)]);
    assert_eq!(rules, "unit-concluded");
}

#[test]
fn repeats_slots_and_routes() {
    let text = "M48\nMETRIC\nT1C1.0\n%\nT1\nX1.0Y2.0\nR3X2.0Y-0.5\nX10.0Y0.0G85X14.0Y3.0\nY4.0\n\
        G00X20.0Y0.0\nM15\nG01X24.0\nG03X26.0Y2.0A2.0\nG02X26.0Y2.0I1.0J0.0\nM16\nG00X0.0Y0.0\nG05\nX5.0Y5.0\nM30";
    let drill = drill(text);
    let expected = [(1.0, 2.0), (3.0, 1.5), (5.0, 1.0), (7.0, 0.5), (14.0, 4.0), (5.0, 5.0)];
    assert_near(&holes(&drill), &expected);
    let slot = drill.cuts.iter().find_map(|cut| match cut.path {
        HoleShape::Slot(from, to) => Some([from, to]),
        _ => None,
    });
    assert_near(&slot.unwrap(), &[(10.0, 0.0), (14.0, 3.0)]);
    let route = drill.cuts.iter().find_map(|cut| match &cut.path {
        HoleShape::Route(elements) => Some(elements),
        _ => None,
    });
    let route = route.unwrap();
    assert_eq!(route.len(), 3);
    // The quarter turn to the left about (24, 2), then the whole circle about (27, 2).
    let turn = route[1].turn.unwrap();
    assert!(
        turn.center.distance(Vec2::new(24.0, 2.0)) < 1e-9 && (turn.sweep - PI / 2.0).abs() < 1e-9
    );
    let turn = route[2].turn.unwrap();
    assert!(
        turn.center.distance(Vec2::new(27.0, 2.0)) < 1e-9 && (turn.sweep + 2.0 * PI).abs() < 1e-9
    );
    let (low, high) = drill.extents().unwrap();
    assert!(
        low.distance(Vec2::new(0.5, -0.5)) < 1e-9 && high.distance(Vec2::new(28.5, 5.5)) < 1e-9
    );
}

#[test]
fn plated_or_not_by_attribute_comment_and_file_name() {
    let plated = |name: &str, head: &str| {
        let text = format!("M48\nMETRIC\n{head}\nT1C1.0\n%\nT1\nX1.0Y1.0\nM30");
        read(name, text.as_bytes()).unwrap().drill.tools[0].plated
    };
    assert_eq!(plated("board.drl", ""), None);
    assert_eq!(plated("out/board-PTH.drl", ""), Some(true));
    assert_eq!(plated("PTH/board-NPTH.drl", ""), Some(false));
    assert_eq!(plated("board.drl", ";TYPE=NON_PLATED"), Some(false));
    assert_eq!(plated("board.drl", "; #@! TF.FileFunction,Plated,1,2,PTH"), Some(true));
    let mixed = "; #@! TF.FileFunction,MixedPlating,1,2\n; #@! TA.AperFunction,NonPlated,NPTH,ComponentDrill";
    assert_eq!(plated("board.drl", mixed), Some(false));
}

#[test]
fn the_fixtures_are_what_their_names_say() {
    let Some(folder) = data::folder() else { return };
    let fixture = |name: &str| {
        let file = folder.join("features/drill").join(name);
        drill(std::str::from_utf8(&data::bytes(&file)).unwrap())
    };
    assert_near(&holes(&fixture("hit.drl")), &[(0.0, 0.0)]);
    assert_eq!(fixture("slot.drl").cuts[0].path, HoleShape::Slot(Vec2::ZERO, Vec2::new(12.7, 0.0)));
    let HoleShape::Route(lines) = &fixture("linear-route.drl").cuts[0].path.clone() else {
        panic!("no route")
    };
    let ends: Vec<Vec2> = lines.iter().map(|line| line.end / 25.4).collect();
    assert_near(&ends, &[(0.25, 0.25), (0.5, 0.0)]);
    let arcs = fixture("arc-route.drl");
    assert_eq!(arcs.cuts.len(), 2);
    for (cut, centers) in
        arcs.cuts.iter().zip([[(0.25, 0.0), (0.25, 0.5)], [(1.0, 0.0), (1.0, 0.5)]])
    {
        let HoleShape::Route(route) = &cut.path else { panic!("no route") };
        let found: Vec<Vec2> = route.iter().map(|arc| arc.turn.unwrap().center / 25.4).collect();
        assert_near(&found, &centers);
    }
}

#[test]
fn the_drill_files_of_kicad_hold_as_many_holes_as_lines() {
    let Some(folder) = data::folder() else { return };
    let files = data::files(&folder.join("kicad"), ".drl");
    assert_eq!(files.len(), 14);
    for file in files {
        let name = file.to_string_lossy();
        let text = String::from_utf8(data::bytes(&file)).unwrap();
        let reading = read(&name, text.as_bytes()).unwrap_or_else(|e| panic!("{e:#?}"));
        assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
        let lines = text.lines().filter(|line| line.starts_with('X')).count();
        let routes = text.lines().filter(|line| *line == "M15").count();
        assert_eq!(reading.drill.cuts.len(), lines + routes, "{name}");
        assert!(reading.drill.tools.iter().all(|tool| tool.plated == Some(!name.contains("NPTH"))));
        assert_eq!(
            reading.drill.tools.len(),
            text.lines().filter(|l| l.starts_with('T') && l.contains('C')).count()
        );
    }
}
