//! Running the program itself, in folders that vanish.

#![allow(dead_code, reason = "each test file uses its part")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;
use tempfile::TempDir;

/// A cut that every machine of the library can make.
pub const SOURCE: &str = "\
PARTNO/SAMPLE
UNITS/MM
LOAD/TOOL,1
SPINDL/RPM,2000,CLW
COOLNT/ON
RAPID
GOTO/0,0,50,0,0,1
RAPID
GOTO/0,0,5
FEDRAT/MMPM,200
GOTO/0,0,-2
GOTO/40,0,-2
GOTO/40,30,-2
RAPID
GOTO/40,30,50
FINI
";

/// A machine that can make it.
pub const MACHINE: &str = "generic-3axis-sinumerik";

/// What a run said.
#[derive(Debug)]
pub struct Said {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Said {
    /// The one JSON object that was said.
    pub fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.out).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }
}

/// A folder to work in.
pub struct Folder(TempDir);

impl Folder {
    /// One with nothing in it.
    pub fn empty() -> Folder {
        Folder(tempfile::tempdir().unwrap())
    }

    /// One with [`SOURCE`] in `part.cls`.
    pub fn new() -> Folder {
        let folder = Folder::empty();
        folder.write("part.cls", SOURCE);
        folder
    }

    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path().join(name);
        fs::write(&path, text).unwrap();
        path
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path().join(name)).unwrap()
    }

    /// What is in it, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.path()).unwrap();
        let mut names: Vec<_> =
            entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Runs the program here.
    pub fn run(&self, arguments: &[&str]) -> Said {
        let output = Command::new(env!("CARGO_BIN_EXE_toolpost"))
            .args(arguments)
            .current_dir(self.path())
            .output()
            .unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Said {
            code: output.status.code().expect("it ends by itself"),
            out: text(output.stdout),
            err: text(output.stderr),
        }
    }

    /// Runs the program here, and answers its exit code and the most memory that it has held, MB.
    #[cfg(target_os = "linux")]
    pub fn most_memory(&self, arguments: &[&str]) -> (i32, f64) {
        let mut child = Command::new(env!("CARGO_BIN_EXE_toolpost"))
            .args(arguments)
            .current_dir(self.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let status = format!("/proc/{}/status", child.id());
        let mut most = 0.0_f64;
        loop {
            // The system keeps the most itself, up to the end of the process.
            let held = fs::read_to_string(&status).ok().and_then(|text| {
                let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
                line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()
            });
            most = most.max(held.unwrap_or(0.0) / 1000.0);
            if let Some(status) = child.try_wait().unwrap() {
                return (status.code().expect("it ends by itself"), most);
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    /// Posts `part.cls` to `out.mpf`.
    pub fn post(&self) -> Said {
        self.run(&["post", "part.cls", "-m", MACHINE, "-o", "out.mpf"])
    }
}
