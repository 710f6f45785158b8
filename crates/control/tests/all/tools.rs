//! Tool tables: as LinuxCNC's documentation writes them, and what is wrong with others.

use toolpost_control::{ToolData, tools};

fn tool(number: u32, name: &str, radius: f64, length: f64) -> ToolData {
    ToolData { number, name: name.into(), radius, length }
}

#[test]
fn a_tool_is_a_line() {
    let table = "; my tools\r\n\nT1 P17 D0.5 Z-3.125 ;1/8 end mill\nt12p3z+25.4d6\n\
                 T99 P0 X0 Y0 Z1 D0 I0 J0 Q0 ;\n  T3 P3 ; probe\n";
    assert_eq!(
        tools::read(table.as_bytes()).unwrap(),
        [
            tool(1, "1/8 end mill", 0.25, -3.125),
            tool(12, "", 3.0, 25.4),
            tool(99, "", 0.0, 1.0),
            tool(3, "probe", 0.0, 0.0),
        ]
    );
    assert_eq!(tools::read(b"").unwrap(), []);
}

#[test]
fn what_is_no_table_is_refused_by_line_and_column() {
    for (table, line, column) in [
        ("T1 D6\nT1 D8", 2, 1),
        ("T1 D", 1, 4),
        ("T1 D6 D7", 1, 7),
        ("T1.5", 1, 1),
        ("T-1", 1, 1),
        ("\nD6 Z1", 2, 1),
        ("T1 X2", 1, 4),
        ("T1 R2", 1, 4),
        ("T1 Zabc", 1, 4),
        ("T1 =", 1, 4),
        ("G21", 1, 1),
        ("T1 D1e5", 1, 6),
    ] {
        let error = tools::read(table.as_bytes()).unwrap_err();
        assert_eq!(
            (error.rule.name(), error.line, error.column),
            ("tool-table", line, column),
            "{table}"
        );
    }
}

#[test]
fn the_tables_of_linuxcnc_are_read_or_refused_with_a_reason() {
    let folder = std::path::Path::new("/usr/share/doc/linuxcnc/examples/sample-configs");
    if !folder.is_dir() {
        return judge::missing("no sample tables of LinuxCNC (Debian package linuxcnc-uspace)");
    }
    let list = std::process::Command::new("find")
        .arg(folder)
        .args(["-type", "f", "-name", "*.tbl"])
        .output()
        .expect("find is run");
    let mut read = 0;
    for path in String::from_utf8_lossy(&list.stdout).lines() {
        match tools::read(&std::fs::read(path).unwrap()) {
            Ok(tools) => read += usize::from(!tools.is_empty()),
            // Turning tools, set up aside of the spindle, and tables older than the format.
            Err(error) => {
                assert!(error.line > 0 && error.rule.name() == "tool-table", "{path}: {error}")
            }
        }
    }
    assert!(read > 10, "{read} tables");
}
