//! What a program leaves on behind its last motion: two proven programs, one behind the other, do what each was proven to do.

use crate::files::root;
use control::{Action, Dialect, Setup};
use machine::{Machine, load};
use program::{Coolant, Program, Spindle};
use std::collections::BTreeSet;
use std::path::Path;

/// A proven program of the library, and the line at which it ends.
struct Job {
    machine: Machine,
    source: Program,
    lines: Vec<String>,
    end: usize,
}

impl Job {
    fn new(name: &str) -> Job {
        let machine = load(name).unwrap_or_else(|found| panic!("{name}: {found:?}"));
        let axes = if machine.rotary.is_empty() { "three-axes" } else { "five-axes" };
        let file = root().join(format!("machines/samples/{axes}.cls"));
        let source = source::apt::read(axes, &std::fs::read(file).unwrap(), &Default::default());
        let source = source.unwrap().program;
        let text = post::write(&source, &machine).unwrap_or_else(|found| panic!("{found:?}")).text;
        let text = String::from_utf8(text).unwrap();
        let lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let is_end =
            |line: &String| line.split(' ').any(|word| matches!(word, "M2" | "M30" | "M17"));
        let end = lines.iter().rposition(is_end).unwrap_or(lines.len());
        Job { machine, source, lines, end }
    }

    fn dialect(&self) -> Dialect {
        Dialect::named(&self.machine.reader).unwrap()
    }

    /// The program with these blocks in front of its end.
    fn with(&self, blocks: &str) -> String {
        let mut lines = self.lines.clone();
        lines.splice(self.end..self.end, blocks.lines().map(str::to_owned));
        self.whole(&lines)
    }

    /// The program without its end, these blocks, and the program once more, as it comes behind an end that resets what this control
    /// is known to reset.
    fn twice(&self, blocks: &str) -> String {
        let starts = |line: &&String| !line.starts_with(['%', 'O']) && !line.contains("BEGIN PGM");
        let resets = match self.dialect() {
            // `G1` wants an F there, and `G94` leaves none.
            Dialect::LinuxCnc => "G94 F9\nG17 G90 G40 G54 G1\nG94\nM5\nM9",
            // The operator puts the first tool in.
            Dialect::Grbl => "G17 G90 G94 G40 G54 G1\nM5\nM9\nT1\nM0",
            Dialect::Marlin => "T1\nM0",
            Dialect::Haas => "M5\nM89\nM9",
            Dialect::Klartext => "M5\nM9",
            Dialect::Sinumerik if self.lines[self.end].contains("M30") => "M5",
            _ => "",
        };
        let first = self.lines[..self.end].iter().filter(|line| !line.starts_with(['%', 'O']));
        let between = blocks.lines().chain(resets.lines()).map(str::to_owned);
        let second = self.lines.iter().filter(starts);
        let lines: Vec<String> = first.cloned().chain(between).chain(second.cloned()).collect();
        self.whole(&lines)
    }

    /// The lines as one text, with the numbers of Klartext.
    fn whole(&self, lines: &[String]) -> String {
        if self.dialect() != Dialect::Klartext {
            return lines.join("\n") + "\n";
        }
        let mut number = 0;
        let numbered = lines.iter().map(|line| {
            if line.starts_with([' ', 'Q']) {
                return line.clone() + "\n";
            }
            let block = line.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start();
            number += 1;
            format!("{} {block}\n", number - 1)
        });
        numbered.collect()
    }

    /// The rules that the proof of a text names first, and all that it says.
    fn judged(&self, text: &str) -> Vec<&'static str> {
        let tolerances = proof::Tolerances::default();
        let report = proof::prove(&self.source, &self.machine, "t", text.as_bytes(), &tolerances);
        report.mismatches.iter().map(|found| found.rule.name()).collect()
    }

    /// What a text makes the machine do from its line `from` on.
    ///
    /// # Errors
    /// The rule by which the control refuses it.
    fn does(&self, text: &str, from: usize) -> Result<Vec<String>, &'static str> {
        let settings = nc::settings(&self.machine, Setup::default()).unwrap();
        let mut does = Vec::new();
        // What a cut depends on: feed, spindle, coolant, what F counts, the tool.
        let path = Action::FeedPath(nc::feed_path(&self.machine));
        let start = [Action::Spindle(Spindle::Off), Action::Coolant(Coolant::Off), path];
        let [spindle, coolant, path] = start.map(|action| format!("{action:?}"));
        let mut runs = [String::new(), spindle, coolant, path, String::new()];
        control::read(&settings, "t", text.as_bytes(), &mut |event| {
            let said = format!("{:?}", event.action);
            match event.action {
                Action::Feed(_) => runs[0] = said,
                Action::Spindle(_) => runs[1] = said,
                Action::Coolant(_) => runs[2] = said,
                Action::FeedPath(_) => runs[3] = said,
                Action::Tool(_) => runs[4] = said,
                Action::Line(_) | Action::Arc(_) | Action::Hole(_) | Action::Thread(_)
                    if event.line as usize > from =>
                {
                    does.push(format!("{said} {}", runs.join(" ")));
                }
                action if event.line as usize > from && acts(&action) => does.push(said),
                _ => {}
            }
            Ok(())
        })
        .map_err(|found| found.rule.name())?;
        Ok(does)
    }

    /// Whether the program does the same behind itself and these blocks.
    fn is_the_same_behind(&self, blocks: &str) -> Result<(), String> {
        let alone = self.does(&self.with(""), 0).unwrap();
        let text = self.twice(blocks);
        let from =
            text.lines().count() - self.lines.iter().filter(|l| !l.starts_with(['%', 'O'])).count();
        let again = match self.does(&text, from) {
            Ok(again) => again,
            // An alarm at the start moves nothing; a unit is said by each program, on this control before the first move.
            Err("units") => return Ok(()),
            // What G92.1 takes away was there before the first program, if anything was: nothing that it has left.
            Err("unknown-shift") => return Ok(()),
            Err(rule) => return Err(format!("the next program is refused: {rule}")),
        };
        match alone.iter().zip(&again).find(|(a, b)| !alike(a, b)) {
            Some((alone, again)) => Err(format!("{again}\nand alone\n{alone}")),
            None if alone.len() == again.len() => Ok(()),
            None => Err(format!("{} events, and alone {}", again.len(), alone.len())),
        }
    }
}

/// Whether an event moves the machine without a cut, or changes what moves.
fn acts(action: &Action) -> bool {
    matches!(
        action,
        Action::Rapid(_)
            | Action::Probe(_)
            | Action::Home(_)
            | Action::MachineMove(_)
            | Action::Swivel(_)
            | Action::Across(_)
            | Action::Compensation(_)
            | Action::Dwell(_)
    )
}

/// Whether the second says what the first does: what the first does not know may be known, since the program before has left it.
fn alike(alone: &str, again: &str) -> bool {
    let words = |text: &str| -> Vec<String> {
        text.split([' ', ',', '(', ')', '[', ']', '{', '}']).map(str::to_owned).collect()
    };
    let (alone, again) = (words(alone), words(again));
    let near = |a: &str, b: &str| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => a.is_nan() || (a - b).abs() < 1e-6,
        _ => a == b,
    };
    alone.len() == again.len() && alone.iter().zip(&again).all(|(a, b)| near(a, b))
}

/// The machines: two for each family of controls, where there are two.
const MACHINES: [&str; 14] = [
    "generic-3axis-linuxcnc",
    "linuxcnc-xyzac",
    "generic-3axis-mach3",
    "generic-3axis-marlin",
    "grbl-3018",
    "generic-3axis-fanuc",
    "fanuc-table-bc",
    "generic-3axis-haas",
    "haas-umc-750",
    "generic-3axis-sinumerik",
    "sinumerik-840d-table-ac",
    "sinumerik-840d-traori",
    "generic-3axis-heidenhain",
    "dmu50-heidenhain",
];

/// What may stand behind a code.
const ISO_WORDS: [&str; 9] = [
    "",
    " X0.",
    " Z-50.",
    " X0. Y0. R45.",
    " P5",
    " H2",
    " D1",
    " X0. Y0. Z0. I0. J30. K0.",
    " X0. Y0. Z0. P2.",
];

/// The same on a SINUMERIK.
const SINUMERIK_WORDS: [&str; 11] =
    ["", " X50", " Z-50", " X2", " RPL=45", "=2", "[C]=100", "()", "(X,Y,Z,C)", "(1)", " R2"];

/// Blocks of Klartext besides M functions.
const KLARTEXT: [&str; 16] = [
    "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+50",
    "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 Z-50",
    "TRANS DATUM AXIS X+50",
    "TRANS DATUM AXIS Z-50",
    "TRANS DATUM RESET",
    "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X",
    "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+45",
    "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 2",
    "CYCL DEF 26.0 AXIS-SPECIFIC SCALING\nCYCL DEF 26.1 X1.4 Y0.6 CCX+15 CCY+20",
    "CYCL DEF 247 DATUM SETTING ~\n  Q339=+2 ;DATUM NUMBER",
    "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.005",
    "PLANE SPATIAL SPA+10 SPB+0 SPC+0 STAY",
    "PLANE RESET STAY",
    "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS",
    "FUNCTION TCPM F TCP AXIS SPAT PATHCTRL VECTOR",
    "FUNCTION RESET TCPM",
];

/// The words in capitals that the source of the virtual control for SINUMERIK quotes: its own tables.
fn quoted(folder: &Path, words: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            quoted(&path, words);
        } else if path.to_string_lossy().contains("sinumerik") {
            let text = std::fs::read_to_string(&path).unwrap();
            let capital = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
            let is_word = |word: &&str| {
                word.len() > 1
                    && word.starts_with(|c: char| c.is_ascii_uppercase())
                    && word.chars().all(capital)
            };
            words.extend(text.split('"').filter(is_word).map(str::to_owned));
        }
    }
}

/// Blocks that may stand in front of the end of a program for a control: every word that it has, with what may stand behind it.
fn blocks(machine: &Machine, dialect: Dialect) -> Vec<String> {
    let codes = |letter: char, most: u32| (0..=most).map(move |code| format!("{letter}{code}"));
    let with = |words: Vec<String>, behind: &[&str]| -> Vec<String> {
        let each = |word: String| behind.iter().map(move |more| format!("{word}{more}"));
        words.into_iter().filter(|word| is_known(machine, word)).flat_map(each).collect()
    };
    match dialect {
        Dialect::Klartext => {
            let functions = codes('M', 199).filter(|m| !matches!(m.as_str(), "M2" | "M30"));
            functions.chain(KLARTEXT.map(str::to_owned)).collect()
        }
        Dialect::Sinumerik => {
            let mut words = BTreeSet::new();
            quoted(&root().join("crates/control/src"), &mut words);
            assert!(words.contains("TRAORI") && words.contains("TRANS"), "{words:?}");
            words.extend(codes('G', 999).chain(codes('M', 99)));
            let own = [
                "CYCLE800(0,\"\",0,57,0,0,0,30,0,0,0,0,0,1)",
                "MCALL CYCLE81(5,0,2,-5)",
                "M3 S500",
                "T5",
                "T5 D1",
                "D2",
                "R24=R24",
            ];
            let mut all = with(words.into_iter().collect(), &SINUMERIK_WORDS);
            all.extend(own.map(str::to_owned));
            all
        }
        _ => {
            let tenths = (0..=2559u32).map(|tenth| match tenth % 10 {
                0 => format!("G{}", tenth / 10),
                part => format!("G{}.{part}", tenth / 10),
            });
            let mut all = with(tenths.chain(codes('M', 199)).collect(), &ISO_WORDS);
            all.extend(["M3 S500", "T9", "S50", "F9", "G96 S100 D500"].map(str::to_owned));
            all
        }
    }
}

/// Whether the control knows a word at all: most codes are none.
fn is_known(machine: &Machine, word: &str) -> bool {
    let settings = nc::settings(machine, Setup::default()).unwrap();
    let found = control::read(&settings, "t", format!("{word}\n").as_bytes(), &mut |_| Ok(()));
    let unknown = ["unknown-word", "unknown-m"];
    found.err().is_none_or(|found| !unknown.contains(&found.rule.name()))
}

#[test]
fn what_stands_in_front_of_the_end_changes_nothing_of_the_next_program_or_is_refused() {
    for name in MACHINES {
        let job = Job::new(name);
        assert_eq!(job.judged(&job.with("")), [""; 0], "{name}");
        job.is_the_same_behind("").unwrap_or_else(|found| panic!("{name}: {found}"));
        let (mut refused, mut harmless) = (0, 0);
        for block in blocks(&job.machine, job.dialect()) {
            let rules = job.judged(&job.with(&block));
            // What stands behind an end is not run.
            let ends = ["M2", "M30", "M99", "M17", "RET", "ENDPROC"];
            let is_end = block.split([' ', '(', '=', '[']).any(|word| ends.contains(&word));
            if rules.is_empty() && !is_end {
                harmless += 1;
                job.is_the_same_behind(&block)
                    .unwrap_or_else(|found| panic!("{name}: {block} is proven, and\n{found}"));
            }
            refused += u32::from(rules.contains(&"left-on"));
        }
        println!("{name}: {refused} left on, {harmless} harmless");
        assert!(refused > 0 || job.dialect() == Dialect::Grbl, "{name}");
        assert!(harmless > 10, "{name}: {harmless}");
    }
}

/// The commands of a hostile test, and what else a manual says that the end keeps.
#[test]
fn what_a_program_leaves_on_is_refused_on_the_machines_of_the_library() {
    for (name, blocks) in [
        (
            "generic-3axis-fanuc",
            &[
                "G52 Z-50.",
                "G51.1 X0.",
                "G16",
                "G68 X0 Y0 R45.",
                "G54.1 P5",
                "G55",
                "G91",
                "G18",
                "G99",
                "M3 S500",
                "M8",
            ][..],
        ),
        (
            "fanuc-table-bc",
            &["G68.2 X0. Y0. Z0. I0. J30. K0.", "G43.4 H2", "G41 D1", "G43 H1", "G66 P1"],
        ),
        ("haas-umc-750", &["G234 H2", "G254", "G55", "G154 P3", "G41 D1", "G91"]),
        (
            "dmu50-heidenhain",
            &[
                "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+50",
                "TRANS DATUM AXIS X+50",
                "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+45",
                "CYCL DEF 8.0 MIRROR IMAGE\nCYCL DEF 8.1 X",
                "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 2",
                "CYCL DEF 247 DATUM SETTING ~\n  Q339=+2 ;DATUM NUMBER",
                "PLANE SPATIAL SPA+10 SPB+0 SPC+0 STAY",
                "M128",
                "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS",
            ],
        ),
        (
            "sinumerik-840d-traori",
            &[
                "TRANS X50",
                "G58 X5",
                "TRAORI",
                "CYCLE800(0,\"\",0,57,0,0,0,30,0,0,0,0,0,1)",
                "G55",
                "G91",
                "G18",
                "M8",
            ],
        ),
        (
            "sinumerik-840d-table-ac",
            &[
                "ROT RPL=45",
                "M3S12000",
                "M8",
                "G55",
                "G54G91",
                "G18",
                "TRANS X50",
                "T5D1",
                "FGROUP(X,Y,Z,A)",
            ],
        ),
        ("linuxcnc-xyzac", &["M428", "G7", "G96 S100"]),
        ("generic-3axis-mach3", &["G68 A0 B0 R45", "G91", "G55", "M3 S500", "G18", "G95"]),
        ("generic-3axis-marlin", &["G91", "M3 S500", "G55"]),
    ] {
        let job = Job::new(name);
        for block in blocks {
            let rules = job.judged(&job.with(block));
            assert!(rules.contains(&"left-on"), "{name}: {block}: {rules:?}");
        }
    }
}

/// Wherever X is a diameter: what differs then is a matter of the word, and the word is named first.
#[test]
fn a_word_of_lathes_in_a_program_is_refused_for_what_it_is() {
    for (name, word) in [
        ("generic-3axis-linuxcnc", "G7"),
        ("linuxcnc-xyzac", "G7"),
        ("generic-3axis-sinumerik", "DIAMON"),
        ("generic-3axis-sinumerik", "DIAM90"),
    ] {
        let job = Job::new(name);
        for line in 1..job.end {
            let mut lines = job.lines.clone();
            lines.insert(line, word.to_owned());
            let rules = job.judged(&job.whole(&lines));
            assert_eq!(
                rules.first(),
                Some(&"diameter-mode"),
                "{name}: {word} at {line}: {rules:?}"
            );
        }
    }
}

/// GRBL and LinuxCNC reset these; the rest each program says itself before it counts.
#[test]
fn what_each_program_says_anew_may_stay_at_the_end() {
    for (name, blocks) in [
        ("generic-3axis-grbl", &["G55", "G91", "G20", "G18", "G93"][..]),
        (
            "generic-3axis-linuxcnc",
            &["G55", "G91", "G20", "G18", "G93", "G95", "G99", "G43 H2", "G61", "M3 S500"],
        ),
        ("generic-3axis-mach3", &["G20", "G99"]),
        ("generic-3axis-marlin", &["G20"]),
        ("generic-3axis-heidenhain", &["M3"]),
        ("generic-3axis-fanuc", &["G49", "S50", "F9", "T9", "G54"]),
        ("generic-3axis-haas", &["G43 H2", "G49", "T9", "M3 S500"]),
        ("generic-3axis-sinumerik", &["G500", "D0", "T5", "F9", "S50", "M3 S500"]),
    ] {
        let job = Job::new(name);
        for block in blocks {
            assert_eq!(job.judged(&job.with(block)), [""; 0], "{name}: {block}");
        }
    }
}

/// A program that goes back to its caller brings Z home, the spindle to a stand and the coolant off.
#[test]
fn a_caller_gets_z_home_the_spindle_standing_and_the_coolant_off() {
    let job = Job::new("sinumerik-840d-table-ac");
    // Where Z stays below, the table does not turn either.
    for blocks in [&["M5"][..], &["G75Z0", "G0A0C=0+R24"], &["M9"]] {
        let mut damaged = job.lines.clone();
        for block in blocks {
            let is_it = |line: &String| line.ends_with(&format!(" {block}"));
            let at = damaged.iter().rposition(is_it).unwrap();
            damaged.remove(at);
        }
        let rules = job.judged(&job.whole(&damaged));
        assert!(rules.contains(&"left-on"), "without {blocks:?}: {rules:?}");
    }
}
