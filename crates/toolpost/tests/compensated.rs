//! Cutter compensation, by what the coordinates of the source are and by what the tool table keeps: the path of the tool's
//! centre is not offset by the tool once more, and a contour is.

mod files;

use machine::{Machine, load, load_text};
use program::{CompensatedPath, Op, Program};
use source::apt::Options;
use std::path::Path;

const CONTROLS: [&str; 4] = [
    "generic-3axis-sinumerik",
    "generic-3axis-heidenhain",
    "generic-3axis-fanuc",
    "generic-3axis-linuxcnc",
];

fn read(path: &Path) -> Program {
    let text = std::fs::read(path).unwrap();
    source::apt::read("part.apt", &text, &Options::default()).unwrap().program
}

/// A tool of 10 mm along two walls, with a way in of radius 2 towards the tool.
fn centre() -> Program {
    let text = "UNITS/MM\nCUTTER/10,0\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/0,-5,5\nFEDRAT/300,MMPM\n\
                GOTO/0,-5,-1\nCUTCOM/LEFT\nGOTO/10,0,-1\nCIRCLE/10,2,-1,0,0,1,2\nGOTO/12,2,-1\nGOTO/12,30,-1\n\
                GOTO/-9,30,-1\nCUTCOM/OFF\nGOTO/-9,20,-1\nRAPID\nGOTO/-9,20,5\nFINI\n";
    source::apt::read("part.apt", text.as_bytes(), &Options::default()).unwrap().program
}

/// The machine with this in its `[settings]`.
fn keeping(machine: &str, table: Option<&str>) -> Machine {
    let mut loaded = load(machine).unwrap();
    loaded.settings.tool_radius = match table {
        None => None,
        Some(table) => {
            let text = format!("extends = \"{machine}\"\n[settings]\ntool_radius = \"{table}\"\n");
            load_text("m.toml", &text).unwrap().settings.tool_radius
        }
    };
    loaded
}

/// The proven program and the rules of its warnings, or the rule of the refusal.
fn posted(
    source: &Program,
    machine: &Machine,
) -> Result<(String, Vec<&'static str>), &'static str> {
    let output = post::write(source, machine).map_err(|found| found[0].rule)?;
    let report = proof::prove(source, machine, "p", &output.text, &Default::default());
    assert!(report.proven, "{}: {:?}", machine.name, report.mismatches);
    let text = String::from_utf8(output.text).unwrap();
    Ok((text, output.warnings.iter().map(|found| found.rule).collect()))
}

/// Whether a block switches compensation on.
fn compensates(text: &str) -> bool {
    let on = |word: &str| ["G41", "G42", "RL", "RR"].contains(&word);
    text.lines().any(|line| !line.contains('(') && line.split(' ').any(on))
}

#[test]
fn the_path_of_the_centre_is_written_without_compensation() {
    for name in CONTROLS.into_iter().chain(["generic-3axis-grbl", "generic-3axis-haas"]) {
        for table in [Some("full"), None] {
            let (text, warnings) = posted(&centre(), &keeping(name, table)).unwrap();
            assert!(!compensates(&text), "{name}: {text}");
            assert!(warnings.contains(&"compensated-path"), "{name}");
        }
    }
}

#[test]
fn the_path_of_the_centre_is_compensated_for_wear_where_the_table_keeps_wear() {
    for name in CONTROLS {
        let (text, warnings) = posted(&centre(), &keeping(name, Some("wear"))).unwrap();
        assert!(compensates(&text), "{name}: {text}");
        assert!(!warnings.contains(&"compensated-path"), "{name}");
    }
}

#[test]
fn a_contour_is_compensated_only_where_the_table_is_known_to_keep_the_radius() {
    let mut contour = centre();
    // A tool of 2 mm could cut it.
    for record in &mut contour.records {
        if let Op::Tool(tool) = &mut record.op {
            tool.diameter = Some(2.0);
        }
    }
    contour.compensated_path = Some(CompensatedPath::Contour);
    for name in CONTROLS {
        assert!(compensates(&posted(&contour, &keeping(name, Some("full"))).unwrap().0), "{name}");
        for table in [Some("wear"), None] {
            let machine = keeping(name, table);
            assert_eq!(posted(&contour, &machine), Err("compensated-path"), "{name} {table:?}");
            // The judge does not take it either.
            let text = posted(&contour, &keeping(name, Some("full"))).unwrap().0;
            let report =
                proof::prove(&contour, &machine, "p", text.as_bytes(), &Default::default());
            assert_eq!(report.mismatches[0].rule, "compensated-path", "{name} {table:?}");
        }
    }
}

#[test]
fn where_nothing_shows_which_path_it_is_nothing_is_written() {
    let unknown = Program { compensated_path: None, ..centre() };
    for name in CONTROLS {
        let found = post::write(&unknown, &load(name).unwrap()).unwrap_err();
        assert_eq!(found[0].rule, "compensated-path");
        assert!(found[0].help.contains("--cutcom centre"), "{}", found[0].help);
        let text = posted(&centre(), &load(name).unwrap()).unwrap().0;
        let report =
            proof::prove(&unknown, &load(name).unwrap(), "p", text.as_bytes(), &Default::default());
        assert_eq!(report.mismatches[0].rule, "compensated-path");
    }
}

/// The program that was written before: with `G41`, so that the control offsets the path of the centre by the radius in its
/// table once more.
#[test]
fn a_centre_path_that_is_offset_once_more_is_refused() {
    let Some(folder) = judge::data("cldata/solidworks") else { return };
    let real = read(&folder.join("Teflon-gasket.apt"));
    for source in [centre(), real] {
        for name in CONTROLS {
            let doubled = posted(&source, &keeping(name, Some("wear"))).unwrap().0;
            for table in [Some("full"), None] {
                let machine = keeping(name, table);
                let report =
                    proof::prove(&source, &machine, "p", doubled.as_bytes(), &Default::default());
                assert_eq!(report.mismatches[0].rule, "compensation", "{name}");
                assert!(report.mismatches[0].message.contains("once more"), "{name}");
            }
        }
    }
}

#[test]
fn the_real_files_of_solidworks_are_written_as_paths_of_the_centre() {
    let Some(folder) = judge::data("cldata/solidworks") else { return };
    let mut made = 0;
    for file in [
        "Dem-target2.apt",
        "Interface-glue.apt",
        "SupPetriLED.apt",
        "Teflon-gasket.apt",
        "Top-light-cover.apt",
        "basemach.apt",
    ] {
        let source = read(&folder.join(file));
        for name in CONTROLS {
            let (text, _) = posted(&source, &load(name).unwrap()).unwrap();
            assert!(!compensates(&text), "{file} {name}");
            let wear = posted(&source, &keeping(name, Some("wear"))).unwrap().0;
            assert!(compensates(&wear), "{file} {name}");
            made += 2;
        }
    }
    assert_eq!(made, 48);
}
