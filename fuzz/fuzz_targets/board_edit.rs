//! Any lines as edits of a board in the studio: its layers dropped, exchanged and overwritten, its options, the texts of its programs, all of it
//! asked for as a page asks. No panic; what is saved is proven, and is the text that was proven; a program that nobody has changed is
//! proven; a save that is refused changes nothing, and one that is not changes no more than it says.
#![no_main]

use app::Stop;
use app::pcb::Layer;
use geom::ending::Ended;
use libfuzzer_sys::fuzz_target;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::time::Duration;
use studio::ask::Command;
use studio::board::Settings as BoardSettings;
use studio::message::{Array, Values};
use studio::server::{More, Session};
use studio::{Options, Settings};

/// The most edits of an input.
const MOST: usize = 12;

/// How long a work goes on until the page gives it up.
const PATIENCE: Duration = Duration::from_secs(8);

const MACHINE: &str = "grbl-3018";

/// The files of the board: a track of 6 mm and a hole at its end, on 10 x 5 mm.
const FILES: [(&str, &str); 3] = [
    (
        "b-F_Cu.gbr",
        "%FSLAX46Y46*%\n%MOMM*%\n%ADD10C,1.0*%\nD10*\nX2000000Y2000000D02*\nX8000000Y2000000D01*\nM02*\n",
    ),
    (
        "b-Edge_Cuts.gbr",
        "%FSLAX46Y46*%\n%MOMM*%\n%ADD10C,0.1*%\nD10*\nX0Y0D02*\nX10000000Y0D01*\nX10000000Y5000000D01*\nX0Y5000000D01*\nX0Y0D01*\nM02*\n",
    ),
    ("b.drl", "M48\nMETRIC\nT1C0.8\n%\nT1\nX8.0Y2.0\nM30\n"),
];

/// What options mean here: those that change what is cut, by the names that the command has.
fn options(_: Command, given: &[(String, String)], _: Option<&More>) -> Result<Options, Stop> {
    let mut board = BoardSettings::default();
    board.plan.isolation.tool = Some(0.3);
    let mut strict = false;
    for (name, value) in given {
        let number = || value.parse().ok();
        match &**name {
            "tool" => board.plan.isolation.tool = number(),
            "depth" => board.plan.isolation.depth = number().unwrap_or(f64::NAN),
            "passes" => board.plan.isolation.passes = value.parse().unwrap_or(0).min(4),
            "cut" => board.plan.outline.outline_tool = number().unwrap_or(f64::NAN),
            "outline" => board.named.push((app::Source::File(value.into()), Layer::Outline)),
            "drill" => board.named.push((app::Source::File(value.into()), Layer::Holes(None))),
            "strict" => strict = true,
            _ => {}
        }
    }
    Ok(Options { strict, board: Some(Box::new(board)), ..Options::default() })
}

/// All files below a folder, but those of the studio itself.
fn files(folder: &Path, into: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in fs::read_dir(folder).expect("the folder is there").flatten() {
        let path = entry.path();
        match path.is_dir() {
            true => files(&path, into),
            false => _ = into.insert(path.clone(), fs::read(&path).expect("it can be read")),
        }
    }
}

/// The job that was made last.
struct Last {
    revision: u64,
    is_proven: bool,
    /// The name of its file and its text, where it is an edited program; otherwise it is the whole board.
    edit: Option<(String, Vec<u8>)>,
}

/// A page, and the folder of its studio.
struct Page {
    folder: tempfile::TempDir,
    session: Session,
    options: Vec<[String; 2]>,
    /// The programs of the board that was posted last: their revisions, the names of their files, and their texts.
    programs: Vec<(u64, String, Vec<u8>)>,
    last: Option<Last>,
}

impl Page {
    fn open() -> Page {
        let folder = tempfile::tempdir().expect("there is room for a folder");
        fs::create_dir(folder.path().join("b")).expect("there is room for a folder");
        let settings = Settings {
            folder: folder.path().into(),
            options: Some(options),
            ..Settings::default()
        };
        let session = Session::open(&settings).expect("the folder opens");
        let page = Page { folder, session, options: Vec::new(), programs: Vec::new(), last: None };
        for (name, text) in FILES {
            fs::write(page.layer(name), text).expect("there is room for a file");
        }
        page
    }

    fn layer(&self, name: &str) -> PathBuf {
        self.folder.path().join("b").join(name)
    }

    fn files(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut all = BTreeMap::new();
        files(self.folder.path(), &mut all);
        all
    }

    /// What an ask is answered within the page's patience; a finding always says something.
    fn ask(
        &self,
        ask: &str,
        params: Value,
        text: Option<&[u8]>,
    ) -> Result<(Value, Vec<Array>), Stop> {
        let ended = Ended::default();
        let (over, waits) = channel::<()>();
        let others = ended.clone();
        let watchdog = std::thread::spawn(move || {
            if waits
                .recv_timeout(PATIENCE)
                .is_err_and(|why| why == std::sync::mpsc::RecvTimeoutError::Timeout)
            {
                others.end();
            }
        });
        let params: Map<String, Value> = params.as_object().expect("it is one").clone();
        let arrays = text.map(|text| Array::text("text", text.to_vec())).into_iter().collect();
        let answer = self.session.answer(ask, params, arrays, &ended);
        drop(over);
        watchdog.join().expect("it only waits");
        if let Err(stop) = &answer {
            let says =
                |found: &program::Diagnostic| !found.message.is_empty() && !found.help.is_empty();
            assert!(!stop.findings.is_empty() && stop.findings.iter().all(says), "{stop:?}");
        }
        answer
    }

    fn work(&self, ask: &str, more: Value, text: Option<&[u8]>) -> Result<Value, Stop> {
        let mut params =
            json!({ "source": { "folder": "b" }, "machine": MACHINE, "options": self.options });
        params
            .as_object_mut()
            .expect("it is one")
            .extend(more.as_object().expect("it is one").clone());
        Ok(self.ask(ask, params, text)?.0)
    }

    fn post(&mut self) {
        // What was there before is of another board.
        (self.programs, self.last) = (Vec::new(), None);
        let Ok(job) = self.work("post", json!({}), None) else { return };
        let board = &job["board"]["programs"];
        let programs = board.as_array().expect("a board has programs").clone();
        self.programs = programs
            .iter()
            .map(|program| {
                let revision = program["revision"].as_u64().expect("it has one");
                let (own, _) =
                    self.ask("job", json!({ "revision": revision }), None).expect("it is kept");
                assert_eq!(own["verdict"], "done", "{own}");
                (
                    revision,
                    program["file"].as_str().expect("it has one").to_owned(),
                    self.text(revision),
                )
            })
            .collect();
        let revision = job["revision"].as_u64().expect("it has one");
        self.last = Some(Last { revision, is_proven: true, edit: None });
    }

    fn text(&self, revision: u64) -> Vec<u8> {
        let params = json!({ "revision": revision, "of": "program", "from": 1, "to": 1_000_000 });
        let (_, arrays) = self.ask("text", params, None).expect("it has a text");
        match &arrays[0].values {
            Values::U8(text) => text.clone(),
            other => panic!("{other:?}"),
        }
    }

    /// Proves a text of a program of the board.
    fn prove(&mut self, at: u8, changed: impl FnOnce(&[u8]) -> Vec<u8>) {
        let Some((_, file, text)) = self.programs.get(usize::from(at) % self.programs.len().max(1))
        else {
            return;
        };
        let (file, edited) = (file.clone(), changed(text));
        let job = self.work("prove", json!({ "file": file }), Some(&edited));
        if let Ok(job) = &job {
            let is_proven = job["verdict"] == "done";
            let revision = job["revision"].as_u64().expect("it has one");
            self.last = Some(Last { revision, is_proven, edit: Some((file, edited)) });
        }
    }

    /// Proves each program that nobody has changed; nothing of the board has changed either since it was posted.
    fn unchanged(&mut self) {
        self.post();
        for (_, file, text) in &self.programs {
            match self.work("prove", json!({ "file": file }), Some(text)) {
                Ok(job) => assert_eq!(job["verdict"], "done", "{file}: {job}"),
                Err(stop) => assert_eq!(stop.verdict, app::Verdict::Cancelled, "{file}: {stop:?}"),
            }
        }
    }

    fn save(&self, replace: bool, within: &str) {
        let Some(Last { revision, is_proven, edit }) = &self.last else { return };
        let path = match edit {
            Some((file, _)) => format!("{within}/{file}"),
            None => within.to_owned(),
        };
        let before = self.files();
        let params = json!({ "revision": revision, "path": path, "replace": replace });
        let saved = self.ask("save", params, None);
        let after = self.files();
        let Ok((saved, _)) = saved else {
            assert!(before == after, "a save that was refused has changed something");
            return;
        };
        assert!(is_proven, "what is not proven is saved");
        let named: Vec<PathBuf> = saved["files"]
            .as_array()
            .expect("a list")
            .iter()
            .map(|file| self.folder.path().join(file.as_str().expect("a name")))
            .collect();
        for (file, bytes) in &after {
            assert!(
                named.contains(file) || before.get(file) == Some(bytes),
                "{file:?} is not named"
            );
        }
        assert!(before.keys().all(|file| after.contains_key(file)), "something is gone");
        assert!(named.iter().all(|file| after.contains_key(file)), "something is missing");
        let texts: Vec<(&str, &[u8])> = match edit {
            Some((file, text)) => vec![(file, text)],
            None => self.programs.iter().map(|(_, file, text)| (&**file, &**text)).collect(),
        };
        for (file, text) in texts {
            let path = self.folder.path().join(within).join(file);
            assert!(named.contains(&path) && after[&path] == text, "{file} is another");
        }
    }

    /// Writes the bytes of a layer anew.
    fn change(&self, at: u8, changed: impl FnOnce(Vec<u8>) -> Vec<u8>) {
        let path = self.layer(FILES[usize::from(at) % FILES.len()].0);
        let bytes = changed(fs::read(&path).unwrap_or_default());
        fs::write(path, bytes).expect("there is room for a file");
    }
}

/// Another line in the place of one, or none.
fn with_line(text: &[u8], at: u8, line: Option<&[u8]>) -> Vec<u8> {
    let mut lines: Vec<&[u8]> = text.split_inclusive(|byte| *byte == b'\n').collect();
    let at = usize::from(at) * lines.len() / 256;
    let own = line.map(|line| [line, b"\n"].concat());
    match &own {
        Some(own) => lines[at] = own,
        None => _ = lines.remove(at),
    }
    lines.concat()
}

fuzz_target!(|data: &[u8]| {
    let mut page = Page::open();
    for edit in data.split(|byte| *byte == b'\n').take(MOST) {
        match *edit {
            [b'D', at, ..] => {
                _ = fs::remove_file(page.layer(FILES[usize::from(at) % FILES.len()].0))
            }
            [b'B', at, ..] => page.change(at, |_| FILES[usize::from(at) % FILES.len()].1.into()),
            [b'X', one, other, ..] => {
                let [one, other] =
                    [one, other].map(|at| page.layer(FILES[usize::from(at) % FILES.len()].0));
                let (first, second) =
                    (fs::read(&one).unwrap_or_default(), fs::read(&other).unwrap_or_default());
                fs::write(one, second).expect("there is room for a file");
                fs::write(other, first).expect("there is room for a file");
            }
            [b'L', at, line, ref text @ ..] => page.change(at, |bytes| match bytes.is_empty() {
                true => text.to_vec(),
                false => with_line(&bytes, line, Some(text)),
            }),
            [b'O', ref words @ ..] => {
                let words = String::from_utf8_lossy(words);
                let pair = |word: &str| {
                    let (name, value) = word.split_once('=').unwrap_or((word, ""));
                    [name.to_owned(), value.to_owned()]
                };
                page.options = words.split_whitespace().take(4).map(pair).collect();
            }
            [b'P', ..] => page.post(),
            [b'E', at, line, ref text @ ..] => {
                page.prove(at, |own| with_line(own, line, Some(text)))
            }
            [b'C', at, line, ..] => page.prove(at, |own| with_line(own, line, None)),
            [b'U', ..] => page.unchanged(),
            [b'S', replace, ..] => page.save(replace % 2 == 1, "out"),
            [b'I', replace, ..] => page.save(replace % 2 == 1, "b"),
            _ => {}
        }
    }
});
