//! Every real cutter-location file, written for every machine of the library.

use program::Diagnostic;
use std::path::{Path, PathBuf};

fn files() -> Vec<PathBuf> {
    let root = std::env::var("TOOLPOST_DATA").map_or_else(
        |_| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"),
        PathBuf::from,
    );
    let folders = ["nx", "makino", "solidworks"].map(|folder| root.join("cldata").join(folder));
    let entries = folders.iter().flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten());
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.sort();
    files
}

#[test]
fn every_real_file_is_written_or_refused_with_a_line() {
    let files = files();
    if files.is_empty() {
        eprintln!("no cutter-location data here: set TOOLPOST_DATA");
    }
    for file in files {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let text = std::fs::read(&file).unwrap();
        let reading = match source::apt::read(&name, &text, &source::apt::Options::default()) {
            Ok(reading) => reading,
            Err(errors) => panic!("{}", errors[0]),
        };
        for machine in machine::library::names(machine::library::MACHINES) {
            let loaded = machine::load(machine).unwrap_or_else(|error| panic!("{error}"));
            match toolpost_post::write(&reading.program, &loaded) {
                Ok(output) => {
                    assert_eq!(output.blocks, output.text.split(|&b| b == b'\n').count() - 1);
                    if let Ok(folder) = std::env::var("TOOLPOST_KEEP") {
                        let kept = format!("{name}.{machine}.{}", loaded.extension);
                        std::fs::write(Path::new(&folder).join(kept), &output.text).unwrap();
                        output.warnings.iter().for_each(|w| eprintln!("{name} {machine} {w}"));
                    }
                }
                Err(errors) => {
                    eprintln!("{name} {machine} {}", errors[0]);
                    let placed = |error: &Diagnostic| error.line > 0;
                    assert!(errors.iter().all(placed), "{name} on {machine}: {}", errors[0]);
                }
            }
        }
    }
}
