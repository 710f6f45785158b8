//! Which path the coordinates behind `CUTCOM` are, and what shows it. Worked out by hand.

use program::CompensatedPath::{self, Center, Contour};
use toolpost_source::apt::{Options, Reading, read};

/// A file with an end mill of this diameter, and this behind its plunge to X0 Y0 Z-1.
fn file(cutter: &str, path: &str) -> String {
    format!(
        "UNITS/MM\nCUTTER/{cutter}\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/0,0,5\nFEDRAT/300,MMPM\n\
         GOTO/0,0,-1\n{path}\nFINI\n"
    )
}

fn reading(text: &str, cutcom: Option<CompensatedPath>) -> Result<Reading, (&'static str, u32)> {
    let options = Options { cutcom, ..Options::default() };
    read("part.apt", text.as_bytes(), &options)
        .map_err(|found| (found[0].rule.name(), found[0].line))
}

/// The path that the file shows, and the line that shows it.
fn shown(cutter: &str, path: &str) -> Option<(CompensatedPath, u32)> {
    let reading = reading(&file(cutter, path), None).unwrap();
    let evidence = reading.cutcom.expect("no CUTCOM is known").evidence;
    assert_eq!(reading.program.compensated_path, evidence.map(|evidence| evidence.path));
    evidence.map(|evidence| (evidence.path, evidence.line))
}

/// To (10, 0), an arc of radius 2 about (10, 2) to (12, 2), and on; the arc ends in line 11.
fn corner(side: &str, direction: i32) -> String {
    let (center, end) = if direction > 0 { ("10,2", "12,2") } else { ("10,-2", "12,-2") };
    format!(
        "CUTCOM/{side}\nGOTO/10,0,-1\nCIRCLE/{center},-1,0,0,{direction},2\nGOTO/{end},-1\nGOTO/20,9,-1\n\
         CUTCOM/OFF\nGOTO/30,9,-1"
    )
}

#[test]
fn an_arc_towards_the_tool_that_is_smaller_than_the_tool_is_no_contour() {
    // Left of the path and counter-clockwise, right of it and clockwise: the tool is where the centre of the arc is.
    for (side, direction) in [("LEFT", 1), ("RIGHT", -1)] {
        assert_eq!(shown("10,0", &corner(side, direction)), Some((Center, 12)), "{side}");
        // A tool of that radius, or a smaller one, may cut it.
        assert_eq!(shown("4,0", &corner(side, direction)), None, "{side}");
        assert_eq!(shown("3,0", &corner(side, direction)), None, "{side}");
    }
    // Away from the tool a corner is rounded: as either.
    assert_eq!(shown("10,0", &corner("LEFT", -1)), None);
    assert_eq!(shown("10,0", &corner("RIGHT", 1)), None);
    // A second `CUTCOM` is as good as the first.
    let later = format!("CUTCOM/LEFT\nGOTO/5,0,-1\nCUTCOM/OFF\nGOTO/6,0,-1\n{}", corner("LEFT", 1));
    let reading = reading(&file("10,0", &later), None).unwrap();
    let evidence = reading.cutcom.unwrap().evidence.unwrap();
    assert_eq!((evidence.line, evidence.stretches, evidence.showing), (16, 2, 1));
    assert_eq!((evidence.radius, evidence.tool_radius), (2.0, 5.0));
}

#[test]
fn an_island_that_the_tool_would_cut_away_is_a_contour() {
    // Round (10, -2) clockwise with the tool on the left: the island is on the right, of radius 2.
    let round = |ends: &[&str], direction: i32, rise: &str| {
        let arcs: String = ends
            .iter()
            .map(|end| format!("CIRCLE/10,-2,-1,0,0,{direction},2\nGOTO/{end},-1{rise}\n"))
            .collect();
        format!("CUTCOM/LEFT\nGOTO/10,0,-1\n{arcs}CUTCOM/OFF\nGOTO/30,9,-1")
    };
    assert_eq!(shown("10,0", &round(&["10,0"], -1, "")), Some((Contour, 12)));
    // In two halves; in three quarters, of which two are enough.
    assert_eq!(shown("10,0", &round(&["10,-4", "10,0"], -1, "")), Some((Contour, 12)));
    assert_eq!(shown("10,0", &round(&["12,-2", "10,-4", "8,-2"], -1, "")), Some((Contour, 14)));
    // A quarter is a rounded corner; a larger island stays; a helix leads in.
    assert_eq!(shown("10,0", &round(&["12,-2"], -1, "")), None);
    assert_eq!(shown("4,0", &round(&["10,0"], -1, "")), None);
    assert_eq!(shown("10,0", &round(&["10,0"], -1, ".5")), None);
}

#[test]
fn a_tool_whose_radius_hangs_on_the_depth_shows_nothing() {
    // CUTTER/d,r,e,f,a,b,h (ISO 4343): `a` and `b` are the angles of end and side.
    for cutter in ["10,0,5,3,31,0,60", "10,0,5,5,0,45,60", "10,0,0,0,45,0,60"] {
        assert_eq!(shown(cutter, &corner("LEFT", 1)), None, "{cutter}");
    }
    assert_eq!(shown("10,0,5,0,0,0,60", &corner("LEFT", 1)), Some((Center, 12)));
    let unknown = file("10,0", &corner("LEFT", 1)).replace("CUTTER/10,0\n", "");
    assert_eq!(reading(&unknown, None).unwrap().program.compensated_path, None);
}

#[test]
fn what_is_given_does_not_contradict_what_the_file_shows() {
    let silent = file("3,0", &corner("LEFT", 1));
    for path in [Center, Contour] {
        let reading = reading(&silent, Some(path)).unwrap();
        assert_eq!(reading.program.compensated_path, Some(path));
    }
    let center = file("10,0", &corner("LEFT", 1));
    assert!(reading(&center, Some(Center)).is_ok());
    assert_eq!(reading(&center, Some(Contour)), Err(("compensated-path", 12)));
    let neither = file("10,0", "GOTO/9,9,-1");
    assert_eq!(reading(&neither, None).unwrap().cutcom, None);
    assert_eq!(reading(&neither, Some(Contour)).unwrap_err().0, "compensated-path");
    // One CAM system writes one kind: a file that shows both is not read.
    let island = "CUTCOM/LEFT\nGOTO/10,0,-1\nCIRCLE/10,-2,-1,0,0,-1,2\nGOTO/10,0,-1\nCUTCOM/OFF\nGOTO/0,0,-1";
    let both = file("10,0", &format!("{island}\n{}", corner("LEFT", 1)));
    for given in [None, Some(Center), Some(Contour)] {
        assert_eq!(reading(&both, given).unwrap_err().0, "compensated-path");
    }
}

/// Nine real files of SolidWorks CAM have `CUTCOM`: in each the ways in are arcs of a tenth of the tool's diameter, on the
/// tool's side. Line and radii are those of `CIRCLE` and `CUTTER` in the files.
#[test]
fn the_real_files_of_solidworks_show_the_path_of_the_centre() {
    let Some(folder) = judge::data("cldata/solidworks") else { return };
    for (file, stretches, radius, tool) in [
        ("Dem-target2.apt", 33, 0.2, 1.0),
        ("Interface-glue.apt", 10, 1.4, 7.0),
        ("Sacrifice-Board.apt", 42, 0.1, 7.0),
        ("SupPetriLED.apt", 13, 1.4, 7.0),
        ("Teflon-gasket.apt", 15, 1.0, 5.0),
        ("Teste-Metrologia.apt", 8, 1.4, 7.0),
        ("Top-light-cover.apt", 22, 1.6, 7.0),
        ("basemach.apt", 62, 0.5, 2.5),
        ("shimemcunha.apt", 4, 0.4, 2.0),
    ] {
        let text = std::fs::read(folder.join(file)).unwrap();
        let reading = read(file, &text, &Options::default()).unwrap();
        let shown = reading.cutcom.unwrap().evidence.unwrap();
        assert_eq!((shown.path, shown.stretches), (Center, stretches), "{file}");
        assert!((shown.radius - radius).abs() < 1e-3, "{file}: {shown:?}");
        assert_eq!(shown.tool_radius, tool, "{file}");
    }
}
