//! Boards from folders of files: the real ones, and layers by hand.

use crate::data;
use geom::Vec2;
use program::Diagnostic;
use proptest::prelude::*;
use std::f64::consts::PI;
use std::path::Path;
use toolpost_pcb::board::{self, Face, File, Layer, Reading};

/// What the files of a folder give.
pub fn folder(folder: &Path) -> Result<Reading, Vec<Diagnostic>> {
    let paths = data::files(folder, "");
    let texts: Vec<Vec<u8>> = paths.iter().map(|path| data::bytes(path)).collect();
    let names: Vec<String> = paths.iter().map(|path| path.to_string_lossy().into()).collect();
    let files: Vec<(&str, &[u8])> =
        names.iter().zip(&texts).map(|(name, text)| (name.as_str(), text.as_slice())).collect();
    read(&files)
}

pub fn read(files: &[(&str, &[u8])]) -> Result<Reading, Vec<Diagnostic>> {
    let files: Vec<File> =
        files.iter().map(|(name, text)| File { unit: None, name, layer: None, text }).collect();
    board::read("board", &files)
}

/// A layer in mm with three decimals: a pen of 0.2 mm, D10, and a pad of 1 mm, D11.
fn layer(function: &str, commands: &str) -> Vec<u8> {
    let says =
        if function.is_empty() { String::new() } else { format!("%TF.FileFunction,{function}*%") };
    format!("{says}%FSLAX33Y33*%%MOMM*%%ADD10C,0.2*%%ADD11C,1*%G75*\n{commands}M02*").into_bytes()
}

/// Lines through these places, mm, drawn with D10.
fn lines(places: &[(f64, f64)]) -> String {
    let units = |mm: f64| (mm * 1000.0).round() as i64;
    let mut text = String::from("D10*\n");
    for (i, (x, y)) in places.iter().enumerate() {
        text += &format!("G01X{}Y{}D0{}*\n", units(*x), units(*y), if i == 0 { 2 } else { 1 });
    }
    text
}

/// The square of 20 mm with its corner in the origin.
fn square() -> String {
    lines(&[(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0), (0.0, 0.0)])
}

/// The outline that these commands draw.
fn outline(commands: &str) -> Result<Reading, Vec<Diagnostic>> {
    read(&[("edge.gko", &layer("", commands))])
}

#[track_caller]
fn assert_area(reading: &Reading, expected: f64) {
    let area = reading.board.outline.as_ref().expect("there is an outline").area();
    assert!((area - expected).abs() < 1e-6 * expected, "{area} is not {expected}");
}

#[track_caller]
fn refused(reading: Result<Reading, Vec<Diagnostic>>, rule: &str, says: &str) -> Diagnostic {
    let errors = reading.expect_err("this is refused");
    assert_eq!(errors[0].rule.name(), rule, "{errors:#?}");
    assert!(errors[0].message.contains(says), "{errors:#?}");
    assert!(!errors[0].help.is_empty());
    errors[0].clone()
}

/// The rules of the warnings, but of that about the short coordinates of these tests.
fn rules(reading: &Reading) -> Vec<&str> {
    let rules = reading.warnings.iter().map(|found| found.rule.name());
    rules.filter(|rule| *rule != "deprecated").collect()
}

#[test]
fn the_folders_of_the_real_boards() {
    let Some(data) = data::folder() else { return };
    // Counted and read off in the files themselves: hits and routes; least and greatest X and Y.
    for (name, holes, low, high) in [
        ("StickHub", 88, (141.75, -120.0), (158.25, -80.0)),
        ("carte_test", 278, (94.615, -135.89), (196.215, -36.195)),
        ("ecc83-pp", 33, (121.285, -136.525), (173.355, -90.17)),
        ("interf_u", 401, (79.375, -142.494), (194.945, -34.29)),
        ("kit-dev-coldfire-xilinx_5213", 526, (71.12, -147.32), (228.6, -55.88)),
        ("microwave", 0, (59.69, -201.93), (351.79, -81.28)),
        ("pic_programmer", 251, (73.66, -139.7), (233.68, -40.64)),
    ] {
        let reading = folder(&data.join("kicad").join(name)).unwrap();
        let board = &reading.board;
        assert_eq!(board.holes.len(), holes, "{name}");
        let (a, b) = board.outline.as_ref().unwrap().extents().unwrap();
        let near = |p: Vec2, q: (f64, f64)| p.distance(Vec2::new(q.0, q.1)) < 1e-6;
        assert!(near(a, low) && near(b, high), "{name}: {a} {b}");
        assert!(board.front.copper.is_some(), "{name}");
        // This one has tracks on one side alone.
        let expected: &[&str] = if name == "microwave" { &["layer-empty"] } else { &[] };
        assert_eq!(rules(&reading), expected, "{name}");
        assert_eq!(board.back.copper.is_none(), name == "microwave");
        let npth = board.holes.iter().filter(|hole| hole.plated == Some(false)).count();
        assert!(board.holes.iter().all(|hole| hole.plated.is_some()) && npth <= holes, "{name}");
    }
}

#[test]
fn all_real_boards_in_one_folder_are_refused() {
    let Some(data) = data::folder() else { return };
    let errors = folder(&data.join("kicad")).unwrap_err();
    assert!(errors.iter().all(|error| error.rule.name() == "layer-twice"), "{errors:#?}");
    let names = |error: &Diagnostic| {
        error.file.contains("carte_test-F_Cu") && error.message.contains("StickHub-F_Cu")
    };
    assert!(errors.iter().any(names), "{errors:#?}");
}

#[test]
fn a_file_is_what_it_says_or_what_its_name_says() {
    let pad = "D11*\nX10000Y10000D03*\n";
    let drill = b"M48\nMETRIC\nT1C0.8\n%\nT1\nX10.0Y10.0\nM30\n";
    let reading = read(&[
        ("one.gbr", &layer("Copper,L1,Top", pad)),
        // What it says comes before what its name says.
        ("two.gtl", &layer("Copper,L2,Bot", pad)),
        ("three.gko", &layer("", &square())),
        ("holes.txt", drill),
        ("stuff.gbr", &layer("", pad)),
        ("paste.gtp", &layer("", pad)),
        ("readme.txt", b"Hello"),
    ])
    .unwrap();
    let names: Vec<(&str, Layer)> =
        reading.layers.iter().map(|(name, layer)| (name.as_str(), *layer)).collect();
    let expected = [
        ("one.gbr", Layer::Copper(Face::Front)),
        ("two.gtl", Layer::Copper(Face::Back)),
        ("three.gko", Layer::Outline),
        ("holes.txt", Layer::Holes(None)),
    ];
    assert_eq!(names, expected);
    assert_eq!(rules(&reading), ["layer-by-name", "layer-unknown", "file-unused"]);
    let of = |rule: &str| reading.warnings.iter().find(|found| found.rule.name() == rule).unwrap();
    assert!(of("layer-by-name").message.contains("outline"));
    assert!(of("layer-unknown").message.ends_with(": stuff.gbr"));
    assert!(of("file-unused").message.contains("paste.gtp, readme.txt"));
    assert_area(&reading, 400.0);
    for face in [Face::Front, Face::Back] {
        let copper = reading.board.side(face).copper.as_ref().unwrap();
        assert!((copper.region.area() - PI / 4.0).abs() < 1e-6);
    }
}

#[test]
fn somebody_may_say_which_layer_it_is() {
    let (edge, copper) = (layer("", &square()), layer("", "D11*\nX10000Y10000D03*\n"));
    let files = [
        File { unit: None, name: "a.gbr", layer: Some(Layer::Outline), text: &edge },
        File { unit: None, name: "b.gbl", layer: Some(Layer::Copper(Face::Front)), text: &copper },
    ];
    let reading = board::read("x", &files).unwrap();
    assert!(rules(&reading).is_empty() && reading.board.front.copper.is_some());
    assert_area(&reading, 400.0);
}

#[test]
fn a_surer_file_is_taken_of_two() {
    let (edge, copper) = (layer("", &square()), layer("", "D11*\nX10000Y10000D03*\n"));
    let stated = layer("Copper,L1,Top", "D11*\nX12000Y10000D03*\n");
    let texts: [(&str, &[u8]); 4] =
        [("b.outline.gbr", &edge), ("b.top.gbr", &copper), ("b.gtl", &copper), ("b.gbr", &stated)];
    let reading = read(&texts).unwrap();
    let x = |reading: &Reading| {
        reading.board.front.copper.as_ref().unwrap().region.extents().unwrap().0.x
    };
    assert!((x(&reading) - 11.5).abs() < 1e-9);
    let found = &reading.warnings[0];
    assert_eq!(found.message, "taken by the names of the files: b.outline.gbr as outline");
    let reading = read(&texts[..2]).unwrap();
    assert!(
        reading.warnings[0]
            .message
            .ends_with("b.outline.gbr as outline; b.top.gbr as front copper")
    );
    // Two that are as sure are refused.
    let twice = [texts[2], ("c.gtl", &copper[..])];
    refused(read(&twice), "layer-twice", "b.gtl");
}

#[test]
fn holes_that_gerber_paints() {
    let commands = "D11*\nX5000Y5000D03*\nD10*\nX1000Y1000D02*\nX4000Y5000D01*\n";
    let reading = read(&[("a.gbr", &layer("Plated,1,2,PTH", commands))]).unwrap();
    let widths: Vec<f64> = reading.board.holes.iter().map(|hole| hole.diameter).collect();
    assert_eq!(widths, [1.0, 0.2]);
    assert!(reading.board.holes.iter().all(|hole| hole.plated == Some(true)));
    // A slot of 3 by 4 from end to end.
    let (low, high) = reading.board.holes[1].extents();
    assert!(low.distance(Vec2::splat(0.9)) < 1e-9 && high.distance(Vec2::new(4.1, 5.1)) < 1e-9);
    let square = "%ADD12R,1X1*%D12*\nX5000Y5000D03*\n";
    refused(read(&[("a.gbr", &layer("Plated,1,2,PTH", square))]), "hole-form", "else");
}

#[test]
fn files_that_are_no_board() {
    refused(read(&[]), "no-board", "none of 0 files");
    refused(read(&[("a.step", b"ISO-10303-21;")]), "no-board", "none of 1 files");
    refused(read(&[("a.gtl", b"")]), "no-end", "");
    let twice = [("a.gtl", layer("", "")), ("b.cmp", layer("", ""))];
    let twice = [("a.gtl", &twice[0].1[..]), ("b.cmp", &twice[1].1[..])];
    assert_eq!(refused(read(&twice), "layer-twice", "a.gtl").file, "b.cmp");
    let negative = "%TF.FilePolarity,Negative*%D11*\nX0Y0D03*\n";
    refused(read(&[("a", &layer("Copper,L1,Top", negative))]), "layer-negative", "negative");
}

#[test]
fn the_middle_of_what_is_drawn_is_the_edge() {
    let reading = outline(&square()).unwrap();
    assert_area(&reading, 400.0);
    // In any order and direction, and one line twice.
    let loose = [
        [(0.0, 0.0), (20.0, 0.0)],
        [(20.0, 20.0), (0.0, 20.0)],
        [(20.0, 0.0), (20.0, 20.0)],
        [(0.0, 0.0), (0.0, 20.0)],
        [(20.0, 0.0), (0.0, 0.0)],
    ];
    let loose: String = loose.iter().map(|ends| lines(ends)).collect();
    assert_area(&outline(&loose).unwrap(), 400.0);
    // A cut-out of 4 by 4, and a round one, as a full circle.
    let cut = lines(&[(2.0, 2.0), (2.0, 6.0), (6.0, 6.0), (6.0, 2.0), (2.0, 2.0)]);
    let round = "G01X17000Y15000D02*\nG03X17000Y15000I-2000J0D01*\n";
    let reading = outline(&(square() + &cut + round)).unwrap();
    assert_area(&reading, 400.0 - 16.0 - 4.0 * PI);
    let outline = reading.board.outline.unwrap();
    assert_eq!((outline.islands().len(), outline.rings().count()), (1, 3));
}

#[test]
fn rounded_corners_stay_arcs() {
    // A slot: two straight sides, two half circles of radius 5.
    let sides = lines(&[(0.0, 0.0), (10.0, 0.0)]) + &lines(&[(10.0, 10.0), (0.0, 10.0)]);
    let ends = "G01X10000Y0D02*\nG03X10000Y10000I0J5000D01*\nG01X0Y0D02*\nG02X0Y10000I0J5000D01*\n";
    let reading = outline(&(sides + ends)).unwrap();
    assert_area(&reading, 100.0 + 25.0 * PI);
    let outline = reading.board.outline.unwrap();
    let arcs = outline.rings().flat_map(|ring| ring.elements()).filter(|e| e.turn.is_some());
    assert!(arcs.clone().count() >= 2 && arcs.clone().all(|arc| arc.radius() == Some(5.0)));
}

#[test]
fn several_boards_next_to_each_other() {
    let other = lines(&[(30.0, 0.0), (40.0, 0.0), (40.0, 10.0), (30.0, 10.0), (30.0, 0.0)]);
    let reading = outline(&(square() + &other)).unwrap();
    assert_area(&reading, 500.0);
    assert_eq!(reading.board.outline.unwrap().islands().len(), 2);
}

#[test]
fn gaps_are_closed_or_named() {
    let ring = |gap: f64| lines(&[(gap, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0), (0.0, 0.0)]);
    // 1 µm is rounding, 20 µm is worth a word.
    assert!(!rules(&outline(&ring(0.001)).unwrap()).contains(&"outline-gap"));
    let closed = outline(&ring(0.02)).unwrap();
    let gap = closed.warnings.iter().find(|found| found.rule.name() == "outline-gap").unwrap();
    assert!(gap.message.contains("0.0200 mm at X 0.0") && gap.file == "edge.gko", "{gap}");
    assert_area(&closed, 400.0);
    let open = refused(outline(&ring(0.3)), "outline-open", "a gap of 0.3000 mm");
    assert!(open.message.contains("X 0.3000 Y 0.0000") && open.line > 0, "{open}");
    assert_eq!(open.file, "edge.gko");
}

#[test]
fn what_is_no_outline() {
    let corner = square() + &lines(&[(0.0, 0.0), (5.0, 5.0)]);
    refused(outline(&corner), "outline-branch", "meet at X 0.0000 Y 0.0000");
    let middle = square() + &lines(&[(10.0, 0.0), (10.0, 5.0)]);
    refused(outline(&middle), "outline-branch", "at X 10.0000 Y 0.0000");
    let across =
        square() + &lines(&[(10.0, 5.0), (30.0, 5.0), (30.0, 9.0), (10.0, 9.0), (10.0, 5.0)]);
    refused(outline(&across), "outline-crosses", "X 20.0000");
    refused(outline(&(square() + "%LPC*%D11*\nX5000Y5000D03*\n")), "outline-mixed", "erased");
    let area = "G36*\nX0Y0D02*\nG01X5000Y0D01*\nX5000Y5000D01*\nX0Y0D01*\nG37*\n";
    refused(outline(&(square() + area)), "outline-mixed", "filled");
    assert_area(&outline(area).unwrap(), 12.5);
    // There and back encloses nothing.
    let flat = lines(&[(0.0, 0.0), (5.0, 0.0)])
        + "G02X0Y0I-2500J0D01*\n"
        + &lines(&[(0.0, 0.0), (5.0, 0.0)]);
    assert!(outline(&flat).is_ok());
    refused(outline(&lines(&[(0.0, 0.0), (5.0, 0.0)])), "outline-open", "a gap of 5.0000 mm");
}

/// The outline of these commands with gaps of so many mm closed.
fn mended(commands: &str, close: f64) -> Result<Reading, Vec<Diagnostic>> {
    let text = layer("", commands);
    let files = [File { unit: None, name: "edge.gko", layer: None, text: &text }];
    let (artwork, layers) = board::artwork("board", &files, |_| true)?;
    let (board, warnings) = artwork.outlined(close, None)?.united()?;
    Ok(Reading { board, layers, warnings })
}

/// Each line by itself.
fn loose(all: &[[(f64, f64); 2]]) -> String {
    all.iter().map(|ends| lines(ends)).collect()
}

/// Mended to this area, mm² to 1e-5 of it, with these rules.
#[track_caller]
fn means(commands: &str, area: f64, expected: &[&str]) -> Reading {
    assert!(outline(commands).is_err(), "it is whole without mending");
    let reading = mended(commands, 0.3).unwrap();
    let found = reading.board.outline.as_ref().unwrap().area();
    assert!((found - area).abs() < 1e-5 * area, "{found} is not {area}");
    let found: Vec<&str> =
        rules(&reading).into_iter().filter(|rule| *rule != "layer-by-name").collect();
    assert_eq!(found, expected, "{:?}", reading.warnings);
    reading
}

#[test]
fn an_outline_is_mended_as_people_draw_it() {
    let (bottom, right) = ([(0.0, 0.0), (20.0, 0.0)], [(20.0, 0.0), (20.0, 20.0)]);
    let (top, left) = ([(20.0, 20.0), (0.0, 20.0)], [(0.0, 20.0), (0.0, 0.0)]);
    let three = loose(&[bottom, right, top]);
    // A gap of 0.2 mm, at the end of a side and next to the middle of one that goes on.
    let gap = three.clone() + &loose(&[[(0.0, 20.0), (0.0, 0.2)]]);
    let found = means(&gap, 400.0, &["outline-gap"]);
    let gap = found.warnings.iter().find(|found| found.rule.name() == "outline-gap").unwrap();
    assert!(gap.message.contains("0.2000 mm at X 0.0") && gap.file == "edge.gko", "{gap}");
    let onto = loose(&[[(-1.0, 0.0), (20.0, 0.0)], right, top, [(0.0, 20.0), (0.0, 0.25)]]);
    means(&onto, 400.0, &["outline-gap", "outline-branch"]);
    // Lines that overlap, one drawn again in two pieces, one again 0.1 mm inside, sides that go on at the corners.
    let overlaps = loose(&[[(0.0, 0.0), (12.0, 0.0)], [(8.0, 0.0), (20.0, 0.0)], right, top, left]);
    means(&overlaps, 400.0, &[]);
    let pieces = loose(&[[(0.0, 0.0), (12.0, 0.0)], [(12.0, 0.0), (20.0, 0.0)]]);
    means(&(three.clone() + &loose(&[left]) + &pieces), 400.0, &[]);
    let twice = loose(&[left, [(0.1, 20.0), (0.1, 0.0)]]);
    means(&(three.clone() + &twice), 400.0, &["outline-branch"]);
    let longer = loose(&[
        [(-2.0, 0.0), (22.0, 0.0)],
        [(20.0, -2.0), (20.0, 22.0)],
        [(22.0, 20.0), (-2.0, 20.0)],
        [(0.0, 22.0), (0.0, -2.0)],
    ]);
    means(&longer, 400.0, &["outline-branch"]);
    // A branch that ends inside, with a cut-out; a line inside that meets nothing.
    let hole = lines(&[(4.0, 4.0), (8.0, 4.0), (8.0, 8.0), (4.0, 8.0), (4.0, 4.0)]);
    let branch = square() + &hole + &loose(&[[(0.0, 10.0), (3.0, 10.0)]]);
    means(&branch, 384.0, &["outline-branch"]);
    let stray = square() + &loose(&[[(10.0, 10.0), (13.0, 10.0)]]);
    means(&stray, 400.0, &["outline-branch", "outline-open"]);
    // The ink of a pen of 0.8 mm joins what is 0.6 mm apart.
    let pen = "%ADD13C,0.8*%\n".to_owned()
        + &lines(&[(0.0, 0.6), (0.0, 20.0), (20.0, 20.0), (20.0, 0.0), (0.0, 0.0)]);
    means(&pen.replace("D10*", "D13*"), 400.0, &["outline-gap"]);
}

#[test]
fn text_next_to_an_outline_is_no_edge() {
    // An H, a P and an 8 above the square.
    let letters = loose(&[
        [(1.0, 22.0), (1.0, 24.0)],
        [(2.0, 22.0), (2.0, 24.0)],
        [(1.0, 23.0), (2.0, 23.0)],
        [(4.0, 22.0), (4.0, 24.0)],
    ]);
    let round = lines(&[(4.0, 24.0), (5.0, 24.0), (5.0, 23.0), (4.0, 23.0)]);
    let eight = lines(&[(7.0, 22.0), (8.0, 22.0), (8.0, 24.0), (7.0, 24.0), (7.0, 22.0)])
        + &loose(&[[(7.0, 23.0), (8.0, 23.0)]]);
    let found = means(&(square() + &letters + &round + &eight), 400.0, &["outline-open"]);
    let text = found.warnings.iter().find(|found| found.rule.name() == "outline-open").unwrap();
    assert!(text.message.contains("next to the board is text: 3 drawings"), "{text}");
    // What may be a board, and is open, is none.
    let open = lines(&[(30.0, 0.0), (45.0, 0.0), (45.0, 15.0)]);
    refused(mended(&(square() + &open), 0.3), "outline-open", "");
}

#[test]
fn an_outline_that_nobody_can_know_is_not_mended() {
    let three = lines(&[(0.0, 1.0), (0.0, 20.0), (20.0, 20.0), (20.0, 0.0), (0.0, 0.0)]);
    refused(mended(&three, 0.3), "outline-open", "1.0000 mm");
    assert_area(&mended(&three, 1.0).unwrap(), 400.0);
    // A line from edge to edge; a closed contour in one that is open; two contours that cross.
    let across = square() + &loose(&[[(0.0, 10.0), (20.0, 10.0)]]);
    refused(mended(&across, 0.3), "outline-branch", "ends on another one");
    let hole = lines(&[(4.0, 4.0), (8.0, 4.0), (8.0, 8.0), (4.0, 8.0), (4.0, 4.0)]);
    refused(mended(&(hole + &three), 0.3), "outline-open", "1.0000 mm");
    let over = lines(&[(15.0, 5.0), (25.0, 5.0), (25.0, 9.0), (15.0, 9.0), (15.0, 5.0)]);
    refused(mended(&(square() + &over), 0.3), "outline-crosses", "");
}

#[test]
fn layers_that_do_not_fit() {
    let board = |pad: &str, hole: &str| {
        let drill = format!("M48\nMETRIC\nT1C0.8\n%\nT1\n{hole}\nM30\n");
        let copper = layer("Copper,L1,Top", &format!("D11*\n{pad}D03*\n"));
        let edge = layer("Profile,NP", &square());
        read(&[("a", &copper), ("b", &edge), ("c.drl", drill.as_bytes())])
    };
    assert_eq!(rules(&board("X10000Y10000", "X10.0Y10.0").unwrap()), [""; 0]);
    // Half of the pad, π/8 mm², is over the edge.
    let over = board("X20000Y10000", "X10.0Y10.0").unwrap();
    let found = over.warnings.iter().find(|found| found.rule.name() == "copper-outside").unwrap();
    assert!(
        found.message.starts_with("0.393 mm²") && found.message.contains("in 1 place,"),
        "{found}"
    );
    let beyond = board("X10000Y10000", "X10.0Y10.0\nX20.2Y5.0").unwrap();
    let found = beyond.warnings.iter().find(|found| found.rule.name() == "hole-outside").unwrap();
    assert!(found.message.contains("1 of 2 holes") && found.message.contains("X 20.2000 Y 5.0000"));
    let apart = board("X10000Y10000", "X110.0Y10.0");
    refused(apart, "layers-apart", "holes within X 109.600 to 110.400");
    // A pad of three quarters outside: this outline is another board's.
    let shifted = board("X20250Y10000", "X10.0Y10.0").unwrap();
    assert!(rules(&shifted).contains(&"layers-shifted"), "{:?}", rules(&shifted));
}

#[test]
fn how_large_a_board_is_is_known_before_its_copper_is_united() {
    // A pad of 1 mm on the front, and one on the back, in the square of 20 mm.
    let size = |front: &str, back: &str| {
        let pad = |at: &str| layer("", &format!("D11*\n{at}D03*\n"));
        let texts = [("a.gtl", pad(front)), ("a.gbl", pad(back)), ("a.gko", layer("", &square()))];
        let file = |(name, text)| File { unit: None, name, layer: None, text };
        let files: Vec<File> =
            texts.iter().map(|(name, text)| file((*name, text.as_slice()))).collect();
        let (artwork, _) = board::artwork("board", &files, |_| true).unwrap();
        let known = artwork.board().extents();
        let (sides, _) = artwork.each_side(|_, board| board.extents()).unwrap();
        assert_eq!(sides, [known; 2]);
        known.unwrap()
    };
    let (low, high) = (Vec2::ZERO, Vec2::splat(20.0));
    assert_eq!(size("X10000Y10000", "X5000Y5000"), (low, high));
    // At the edge, and over it: the outline is the board.
    assert_eq!(size("X19500Y10000", "X5000Y5000"), (low, high));
    assert_eq!(size("X10000Y10000", "X500Y0"), (low, high));
    assert_eq!(size("X19800Y10000", "X500Y0"), (low, high));
}

#[test]
fn what_is_outside_the_outline_is_cropped() {
    // On the square of 20 mm: a pad whose half is over the edge, a track out of it of 0.2 mm, and a pad far below.
    let copper = "%TO.N,A*%D11*\nX20000Y10000D03*\n%TO.N,B*%X10000Y10000D03*\nD10*\nX10000Y10000D02*\nX10000Y-5000D01*\n\
                  %TO.N,C*%D11*\nX10000Y-9000D03*\n";
    let print = "D10*\nX5000Y5000D02*\nX5000Y-5000D01*\nX15000Y-5000D01*\n";
    let board = |edge: &str| {
        let texts = [
            ("a.gtl", layer("", copper)),
            ("a.gko", layer("", edge)),
            ("a.gto", layer("", print)),
            ("a.gts", layer("", "D11*\nX0Y0D03*\nX10000Y10000D03*\n")),
        ];
        let files: Vec<(&str, &[u8])> =
            texts.iter().map(|(name, text)| (*name, &text[..])).collect();
        read(&files).unwrap()
    };
    let reading = board(&square());
    let front = &reading.board.front;
    let copper = front.copper.as_ref().unwrap();
    let (low, high) = copper.region.extents().unwrap();
    assert!(low.y.abs() < 1e-6 && (high.x - 20.0).abs() < 1e-6, "{low} {high}");
    let mut nets: Vec<_> = copper.nets.iter().map(|net| net.as_deref().unwrap()).collect();
    nets.sort_unstable();
    assert_eq!(nets, ["A", "B"]);
    // Half of A; all of C, and of the track of B 5 mm with its round end.
    let gone = PI / 8.0 + PI / 4.0 + 0.2 * 5.0 + PI * 0.005;
    let found =
        reading.warnings.iter().find(|found| found.rule.name() == "copper-outside").unwrap();
    assert!(found.message.starts_with(&format!("{gone:.3} mm²")), "{found}");
    assert!(found.message.contains("in 3 places"), "{found}");
    // Of the opening at the corner a quarter stays, of the printed line what is on the board.
    let mask = front.mask.as_ref().unwrap().area();
    assert!((mask - PI / 4.0 * 1.25).abs() < 1e-4, "{mask}");
    let legend = front.legend.as_ref().unwrap();
    let paths: Vec<_> = legend.objects.iter().filter_map(|one| legend.stroke(one)).collect();
    assert_eq!(paths.len(), 1);
    assert_eq!((paths[0].0.start, paths[0].0.end), (Vec2::new(5.0, 5.0), Vec2::new(5.0, 0.0)));
    // What is in another closed outline stays, in a board of its own as in what may be a cut-out.
    let all = lines(&[(-5.0, -12.0), (25.0, -12.0), (25.0, 25.0), (-5.0, 25.0), (-5.0, -12.0)]);
    let lower = lines(&[(0.0, -12.0), (20.0, -12.0), (20.0, -1.0), (0.0, -1.0), (0.0, -12.0)]);
    assert_eq!(board(&(square() + &all)).board.front.copper.unwrap().region.islands().len(), 3);
    let both = board(&(square() + &lower)).board.front.copper.unwrap();
    let nets: Vec<_> = both.nets.iter().flatten().map(|net| net.to_string()).collect();
    assert_eq!(nets.iter().filter(|net| *net == "C").count(), 1, "{nets:?}");
    // The track of B is parted between the two boards.
    assert_eq!(nets.iter().filter(|net| *net == "B").count(), 2, "{nets:?}");
}

#[test]
fn each_side_has_its_copper_and_what_is_odd_comes_in_order() {
    // On each side two nets that touch; on the back, and in a hole, next to the ring that is the board.
    let touching = |x: f64| {
        let (at, next) = ((x * 1e3) as i64, (x * 1e3) as i64 + 800);
        format!("D11*\n%TO.N,A*%X{at}Y10000D03*\n%TO.N,B*%X{next}Y10000D03*\n")
    };
    let edge =
        layer("", &(square() + &lines(&[(8.0, 8.0), (12.0, 8.0), (12.0, 12.0), (8.0, 8.0)])));
    let drill = b"M48\nMETRIC\nT1C0.8\n%\nT1\nX11.0Y9.5\nM30\n".to_vec();
    let texts = [
        ("a.gbl", layer("", &touching(11.0))),
        ("a.gko", edge),
        ("a.gtl", layer("", &touching(3.0))),
        ("a.drl", drill),
    ];
    let files: Vec<File> =
        texts.iter().map(|(name, text)| File { unit: None, name, layer: None, text }).collect();
    let (artwork, _) = board::artwork("board", &files, |_| true).unwrap();
    assert!(artwork.has_copper(Face::Front) && artwork.has_copper(Face::Back));
    let (sides, odd) = artwork.each_side(|face, board| (face, board)).unwrap();
    for ((face, board), expected) in sides.iter().zip([Face::Front, Face::Back]) {
        let copper = board.side(*face).copper.as_ref().unwrap();
        assert_eq!((*face, copper.region.islands().len()), (expected, 1));
    }
    let odd: Vec<(&str, &str)> =
        odd.iter().map(|found| (found.rule.name(), found.file.as_str())).collect();
    let joined = [("nets-joined", "a.gtl"), ("nets-joined", "a.gbl")];
    let named = [("layer-by-name", "")];
    let outside = [("copper-outside", ""), ("hole-outside", "")];
    let drawn = [("deprecated", "a.gko")];
    assert_eq!(odd, [&named[..], &drawn, &joined, &outside].concat());
}

#[test]
fn holes_that_do_not_go_through_are_reported() {
    let drill = b"M48\nMETRIC\nT1C0.8\n%\nT1\nX10.0Y10.0\nM30\n";
    let blind = b"M48\n; #@! TF.FileFunction,Plated,1,2,Blind,Drill\nMETRIC\nT1C0.3\n%\nT1\nX2.0Y2.0\nM30\n";
    let reading = read(&[("a.drl", drill), ("b.drl", blind)]).unwrap();
    assert_eq!((rules(&reading), reading.board.holes.len()), (vec!["holes-not-through"], 1));
    assert!(reading.warnings[0].message.contains("b.drl"), "{:?}", reading.warnings);
}

#[test]
fn many_files_are_read_in_their_order() {
    let drill = |i: usize| format!("M48\nMETRIC\nT1C0.8\n%\nT1\nX{i}.0Y10.0\nM30\n");
    let texts: Vec<(String, String)> = (0..100).map(|i| (format!("{i}.drl"), drill(i))).collect();
    let files: Vec<(&str, &[u8])> =
        texts.iter().map(|(name, text)| (name.as_str(), text.as_bytes())).collect();
    let holes = read(&files).unwrap().board.holes;
    let places: Vec<f64> = holes.iter().map(|hole| hole.extents().0.x.round()).collect();
    assert_eq!(places, (0..100).map(f64::from).collect::<Vec<f64>>());
}

#[test]
fn empty_layers_and_holes_that_come_twice() {
    let drill = b"M48\nMETRIC\nT1C0.8\n%\nT1\nX10.0Y10.0\nX12.0Y10.0\nM30\n";
    let empty = layer("Copper,L1,Top", "");
    let reading = read(&[("a", &empty), ("b.drl", drill), ("c.drl", drill)]).unwrap();
    assert_eq!(rules(&reading), ["layer-empty", "hole-twice"]);
    assert!(reading.board.front.copper.is_none());
    assert_eq!(reading.board.holes.len(), 2);
    // The same in inches, a slot from its other end, and a zero that has a sign.
    let mm = b"M48\nMETRIC\nT1C1.016\n%\nT1\nX2.54Y0.0\nX10.16Y0.0G85X12.7Y0.0\nM30\n";
    let inches = b"M48\nINCH\nT1C0.04\n%\nT1\nX0.1Y-0.0\nX0.5Y-0.0G85X0.4Y0.0\nM30\n";
    let reading = read(&[("a.drl", mm), ("b.drl", inches)]).unwrap();
    assert_eq!((rules(&reading), reading.board.holes.len()), (vec!["hole-twice"], 2));
}

#[test]
fn lists_of_drills_are_no_holes() {
    let copper = layer("Copper,L1,Top", "D11*\nX10000Y10000D03*\n");
    let reading = read(&[("a", &copper), ("a.drl", b"T01  0.024in\nT02  0.031in\n")]).unwrap();
    assert_eq!(rules(&reading), ["file-unused"]);
    // Holes without a header, known by their coordinates.
    let bare = b"%\nT1C0.8\nT1\nX10.0Y10.0\nM30\n";
    assert!(read(&[("a.drd", b"M48\nMETRIC\nT1C0.8\n%\nT1\nX1.0Y1.0\nM30\n")]).is_ok());
    assert_eq!(read(&[("a.txt", bare)]).unwrap().board.holes.len(), 1);
}

proptest! {
    /// A rectangle with rounded corners and a hole, in any order and direction, some pieces twice.
    #[test]
    fn an_outline_in_any_order(
        order in prop::collection::vec(any::<prop::sample::Index>(), 12),
        back in prop::collection::vec(any::<bool>(), 12),
        radius in 0.5..4.0f64,
    ) {
        let radius = (radius * 1000.0).round() / 1000.0;
        let (w, h, r) = (20.0, 12.0, radius);
        let sides = [((r, 0.0), (w - r, 0.0)), ((w, r), (w, h - r)), ((w - r, h), (r, h)), ((0.0, h - r), (0.0, r))];
        let corners = [(w - r, r), (w - r, h - r), (r, h - r), (r, r)];
        let hole = [((8.0, 5.0), (12.0, 5.0)), ((12.0, 5.0), (10.0, 8.0)), ((10.0, 8.0), (8.0, 5.0))];
        let units = |mm: f64| (mm * 1000.0).round() as i64;
        let piece = |i: usize| -> String {
            // A hole, four sides, and between two sides an arc.
            let (from, to, center) = match i {
                0..3 => (hole[i].0, hole[i].1, None),
                3..7 => (sides[i - 3].0, sides[i - 3].1, None),
                _ => (sides[(i - 7) % 4].1, sides[(i - 6) % 4].0, Some(corners[(i - 7) % 4])),
            };
            let (from, to, code) = if back[i] { (to, from, 2) } else { (from, to, 3) };
            let start = format!("D10*\nG01X{}Y{}D02*\n", units(from.0), units(from.1));
            let end = format!("X{}Y{}", units(to.0), units(to.1));
            let move_ = match center {
                None => format!("G01{end}D01*\n"),
                Some((x, y)) => {
                    format!("G0{code}{end}I{}J{}D01*\n", units(x - from.0), units(y - from.1))
                }
            };
            start + &move_
        };
        // All eleven, and one of them again.
        let mut pieces: Vec<usize> = (0..11).collect();
        pieces.push(order[0].index(11));
        for (i, with) in order.iter().enumerate() {
            pieces.swap(i, with.index(12));
        }
        let text: String = pieces.into_iter().map(piece).collect();
        let reading = outline(&text).unwrap();
        let area = reading.board.outline.as_ref().unwrap().area();
        let expected = w * h - (4.0 - PI) * r * r - 6.0;
        prop_assert!((area - expected).abs() < 1e-5, "{} is not {}", area, expected);
        prop_assert!(!rules(&reading).contains(&"outline-gap"));
    }
}
