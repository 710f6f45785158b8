//! What every front end relies on: sources in memory, reach, steps, cancelling, wires and boards without a command line.

use ::wire::cutting::{Cutting, Side};
use ::wire::taper::Rounding;
use control::{Units, WholeNumbers};
use geom::Vec3;
use machine::Reach;
use pcb::plan::Settings;
use program::{CompensatedPath, Purpose};
use proof::Tolerances;
use source::apt::Csys;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use toolpost_app::{
    Origin, Source, Stop, Verdict, Watch, pcb as board, post, prove, toolpath, wire,
};

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name)
}

/// A file of the examples, and the same in memory.
fn both(name: &str) -> [Source; 2] {
    let bytes = std::fs::read(example(name)).unwrap();
    [Source::File(example(name)), Source::memory(name, bytes)]
}

/// The program and the report of a toolpath.
fn posted(
    source: &Source,
    origin: &Origin,
    machine: &str,
    watch: &dyn Watch,
) -> Result<(Vec<u8>, String), Stop> {
    let machine = toolpath::machine(machine)?;
    let toolpath = toolpath::read(source, false, origin, Some(&machine), Purpose::Program)?;
    let posted = post::proven(&toolpath, &machine, "p", &Tolerances::default(), watch)?;
    assert_eq!(posted.account.verdict, Verdict::Done, "{:?}", posted.account.findings);
    let report = posted.account.report();
    Ok((posted.text, report))
}

#[test]
fn a_source_in_memory_gives_the_program_and_the_report_of_its_file() {
    let made = |origin: &Origin, [file, memory]: [Source; 2]| {
        let file = posted(&file, origin, "generic-3axis-linuxcnc", &()).unwrap();
        assert_eq!(file, posted(&memory, origin, "generic-3axis-linuxcnc", &()).unwrap());
        file
    };
    made(&Origin::default(), both("plate.cls"));
    let [table, in_memory] = both("flange.tbl");
    let from = Some(String::from("fanuc-31i"));
    let with = |tools| Origin { from: from.clone(), tools: Some(tools), ..Origin::default() };
    assert_eq!(made(&with(table), both("flange.nc")), made(&with(in_memory), both("flange.nc")));
}

#[test]
fn a_finding_quotes_the_line_of_a_source_in_memory() {
    let source = Source::memory("bad.cls", *b"PPRINT/A\nGOTO/1,2\n");
    let stop =
        toolpath::read(&source, false, &Origin::default(), None, Purpose::Program).unwrap_err();
    let shown = stop.findings[0].to_string();
    assert!(shown.starts_with("bad.cls:2:") && shown.contains("GOTO/1,2"), "{shown}");
}

#[test]
fn the_machine_of_an_nc_program_is_read_within_the_reach_of_the_caller() {
    let folder = tempfile::tempdir().unwrap();
    let [inside, outside] = ["shop/mine.toml", "other.toml"].map(|name| folder.path().join(name));
    std::fs::create_dir(folder.path().join("shop")).unwrap();
    std::fs::write(&outside, "extends = \"fanuc-31i\"\n").unwrap();
    let [source, _] = both("flange.nc");
    let read = |extends: &str| {
        std::fs::write(&inside, format!("extends = \"{extends}\"\n")).unwrap();
        let reach = Reach::Folder(folder.path().join("shop"));
        let from = Some(inside.display().to_string());
        toolpath::read(
            &source,
            false,
            &Origin { from, reach, ..Origin::default() },
            None,
            Purpose::Program,
        )
    };
    assert!(read("fanuc-31i").is_ok());
    let stop = read("../other.toml").unwrap_err();
    assert!(stop.findings[0].message.contains("may not be read here"), "{:?}", stop.findings);
    assert!(toolpath::machine_of("page.toml", "extends = \"grbl-3018\"", &Reach::Library).is_ok());
    let stop = toolpath::machine_of("page.toml", "extends = \"./x.toml\"", &Reach::Library);
    assert!(stop.unwrap_err().findings[0].message.contains("may not be read here"));
}

/// Notes the steps, and cancels after it was asked so many times.
struct Patience {
    left: AtomicUsize,
    steps: Mutex<Vec<&'static str>>,
}

impl Patience {
    fn of(asked: usize) -> Patience {
        Patience { left: AtomicUsize::new(asked), steps: Mutex::default() }
    }

    fn steps(&self) -> Vec<&'static str> {
        self.steps.lock().unwrap().clone()
    }
}

impl Watch for Patience {
    fn step(&self, what: &'static str) {
        self.steps.lock().unwrap().push(what);
    }

    fn is_cancelled(&self) -> bool {
        self.left.fetch_update(Ordering::SeqCst, Ordering::SeqCst, |n| n.checked_sub(1)).is_err()
    }
}

#[test]
fn who_watches_hears_of_each_step_and_ends_the_work_between_two_and_within_a_proof() {
    let mut text = String::from(
        "PPRINT/LONG\nUNITS/MM\nLOADTL/1\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,10\nFEDRAT/90\n",
    );
    (0..20_000).for_each(|i| text.push_str(&format!("GOTO/{}.5,{},-1\n", i % 100, i % 7)));
    text.push_str("RAPID\nGOTO/0,0,10\n");
    let source = Source::memory("long.cls", text.into_bytes());
    let post = |watch: &Patience| {
        posted(&source, &Origin::default(), "generic-3axis-linuxcnc", watch).map_err(|stop| {
            assert_eq!(stop.findings[0].rule, "cancelled");
            stop.verdict
        })
    };
    let patient = Patience::of(usize::MAX);
    post(&patient).unwrap();
    assert_eq!(patient.steps(), ["writing", "proving"]);
    let asked = usize::MAX - patient.left.load(Ordering::SeqCst);
    // Before each step and behind it, and every 256 of 20,000 records and of as many events.
    let most = 4 + 2 * 80;
    assert!((most - 20..most + 4).contains(&asked), "{asked}");
    for (asked, steps) in [(0, &[][..]), (1, &["writing"]), (120, &["writing", "proving"])] {
        let watch = Patience::of(asked);
        assert_eq!(post(&watch), Err(Verdict::Cancelled), "{asked}");
        assert_eq!(watch.steps(), steps);
    }
}

#[test]
fn a_wire_is_cut_without_a_command_line_from_memory_as_from_a_file() {
    let made = both("sector.nc").map(|source| {
        let origin = Origin { from: Some("fanuc-31i".into()), ..Origin::default() };
        let machine = toolpath::machine("bp-95d").unwrap();
        let cutting = ::wire::cutting::Cutting {
            side: Some(::wire::cutting::Side::Inside),
            wire: 0.25,
            gap: 0.02,
            leave: vec![0.03],
            thread: vec![geom::Vec2::new(15.0, 15.0)],
            round_corners: true,
            feeds: vec![0.1, 0.2],
            ..Default::default()
        };
        let settings = wire::Settings { cutting, ..wire::Settings::default() };
        let tolerances = Tolerances::default();
        let made =
            wire::make(&source, false, &origin, machine, &settings, "p", &tolerances, &()).unwrap();
        assert_eq!(made.posted.account.verdict, Verdict::Done);
        assert!(made.picture().starts_with("<svg"));
        let report = made.report();
        (made.posted.text, report)
    });
    assert_eq!(made[0], made[1]);
    let sample = include_bytes!("../../../machines/samples/bp-95d.pts");
    assert!(made[0].0 == sample, "the sample of the machine is cut with the same settings");
}

#[test]
fn a_board_is_made_without_a_command_line_from_memory_as_from_a_file() {
    let machine = toolpath::machine("grbl-3018").unwrap();
    let mut settings = Settings::default();
    settings.isolation.tool = Some(0.3);
    let tolerances = Tolerances::default();
    let made = both("lamp.toml").map(|source| {
        let job = board::Job::new(&machine, &settings, &tolerances).unwrap();
        let watch = Patience::of(usize::MAX);
        let made = job.make(&[source], &watch).unwrap();
        assert_eq!(watch.steps(), ["reading", "planning", "writing and proving"]);
        let account = made.account(&job, Vec::new());
        assert_eq!(account.verdict, Verdict::Done);
        let texts =
            made.programs.iter().map(|program| (program.name.clone(), program.posted.text.clone()));
        (texts.collect::<Vec<_>>(), account.report())
    });
    assert_eq!(
        made[0].0.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(),
        ["front", "drill", "back", "outline"]
    );
    assert_eq!(made[0], made[1]);
}

#[test]
fn a_setting_that_makes_no_sense_is_refused_by_its_name() {
    let machine = toolpath::machine("grbl-3018").unwrap();
    let refused = |change: &dyn Fn(&mut Settings)| {
        let mut settings = Settings::default();
        change(&mut settings);
        let stop = board::Job::new(&machine, &settings, &Tolerances::default()).err().unwrap();
        assert_eq!(stop.findings[0].rule, "setting");
        stop.findings[0].message.clone()
    };
    assert_eq!(refused(&|s| s.isolation.tool = Some(-1.0)), "`tool` is -1");
    assert_eq!(refused(&|s| s.running.feed = f64::NAN), "`feed` is NaN");
    assert_eq!(refused(&|s| s.outline.tabs = 101), "`tabs` is 101");
    assert_eq!(refused(&|s| s.placing.panel = Some([3, 0])), "`panel` is 0");
    assert!(
        refused(&|s| (s.placing.corner, s.placing.as_drawn) = (Some(geom::Vec2::ONE), true))
            .starts_with("`corner` and `as_drawn`")
    );
}

/// What the command line and Python say alike: a setting without the one that gives it a meaning, and two that exclude each
/// other.
#[test]
fn settings_that_do_not_go_together_are_refused_whoever_gives_them() {
    let read = |name: &str, origin: Origin| {
        let source = Source::File(example(name));
        let read = toolpath::read(&source, false, &origin, None, Purpose::Program);
        read.map(|_| ()).unwrap_err().findings.remove(0)
    };
    let nothing = Origin::default;
    let fanuc = Origin { from: Some("fanuc-31i".into()), ..nothing() };
    let alone = [
        ("--tools", Origin { tools: Some(Source::File(example("flange.tbl"))), ..nothing() }),
        ("--folder", Origin { folders: vec![example("")], ..nothing() }),
        ("--whole-numbers", Origin { whole_numbers: WholeNumbers::Units, ..nothing() }),
        ("--units", Origin { units: Some(Units::Inches), ..nothing() }),
        ("--aside", Origin { aside: Some(Vec3::X), ..nothing() }),
        ("--block-delete", Origin { block_delete: true, ..nothing() }),
        ("--start", Origin { start: Some(Vec3::ZERO), ..nothing() }),
    ];
    for (name, origin) in alone {
        let found = read("plate.cls", origin);
        assert!(found.rule == "origin" && found.message.starts_with(name), "{found}");
        assert!(found.help.contains("--from"), "{found}");
    }
    let frame = Origin { csys: Some(Csys::Local), ..fanuc.clone() };
    let path = Origin { cutcom: Some(CompensatedPath::Center), ..fanuc.clone() };
    for (name, origin) in [("--csys", frame), ("--cutcom", path)] {
        let found = read("flange.nc", origin);
        assert!(found.rule == "origin" && found.message.starts_with(name), "{found}");
    }

    let machine = toolpath::machine("bp-95d").unwrap();
    let tolerances = Tolerances::default();
    let wire_of = |settings: wire::Settings| {
        let source = Source::File(example("sector.nc"));
        let (machine, file) = (machine.clone(), "sector.pts");
        let made = wire::make(&source, false, &fanuc, machine, &settings, file, &tolerances, &());
        made.map(|_| ()).unwrap_err().findings.remove(0)
    };
    let inside = Cutting { side: Some(Side::Inside), ..Cutting::default() };
    let upper = || Some(Source::File(example("sector.nc")));
    let pairs = || vec![[0.0; 4]];
    let of = |cutting: Cutting| wire::Settings { cutting, ..Default::default() };
    let settings = [
        (["layer", "drawing"], wire::Settings { layers: vec!["0".into()], ..Default::default() }),
        (["close", "drawing"], wire::Settings { close: 0.1, ..Default::default() }),
        (["sync", "upper"], wire::Settings { sync: wire::Sync::Length, ..Default::default() }),
        (["pair", "upper"], wire::Settings { pairs: pairs(), ..Default::default() }),
        (
            ["pair", "sync"],
            wire::Settings {
                upper: upper(),
                sync: wire::Sync::Length,
                pairs: pairs(),
                ..Default::default()
            },
        ),
        (["rounding", "taper"], of(Cutting { rounding: Rounding::Constant, ..inside.clone() })),
        (["by_control", "tab"], of(Cutting { by_control: true, tab: Some(2.0), ..inside.clone() })),
        (["next to the contours", "side"], of(Cutting { wire: 0.25, ..Cutting::default() })),
    ];
    for ([name, other], settings) in settings {
        let found = wire_of(settings);
        let said = format!("{found}");
        assert!(["setting", "origin"].contains(&found.rule.name()), "{said}");
        assert!(said.contains(name) && said.contains(other), "{said}");
    }
    for (length, chord, fit) in
        [(Some(1.0), Some(0.1), false), (Some(1.0), None, true), (None, Some(0.1), true)]
    {
        assert_eq!(wire::step(length, chord, fit).unwrap_err().rule, "setting");
    }

    let mill = toolpath::machine("grbl-3018").unwrap();
    let plain = Settings::default();
    let of_running = |change: &dyn Fn(&mut Settings)| {
        let mut settings = plain.clone();
        change(&mut settings);
        settings
    };
    let boards = [
        (["tip", "vee"], of_running(&|s| s.isolation.tip = 0.2)),
        (["margin", "clear"], of_running(&|s| s.clearing.margin = 1.0)),
        (["spacing", "panel"], of_running(&|s| s.placing.spacing = 5.0)),
        (["on_control", "probe"], of_running(&|s| s.running.on_control = true)),
        (
            ["tool", "vee"],
            of_running(&|s| (s.isolation.tool, s.isolation.vee) = (Some(1.0), Some(30.0))),
        ),
        (
            ["corner", "as_drawn"],
            of_running(&|s| {
                (s.placing.corner, s.placing.as_drawn) = (Some(Default::default()), true)
            }),
        ),
    ];
    for ([name, other], settings) in boards {
        let Err(stop) = board::Job::new(&mill, &settings, &tolerances) else { panic!("{name}") };
        let message = &stop.findings[0].message;
        assert!(stop.findings[0].rule == "setting", "{message}");
        assert!(message.contains(name) && message.contains(other), "{message}");
    }
    let measuring = of_running(&|s| {
        (s.running.on_control, s.running.probe) = (true, Some([2, 2]));
    });
    let mut job = board::Job::new(&mill, &measuring, &tolerances).unwrap();
    job.surface = Some(Source::memory("z.txt", *b"0 0 0"));
    let Err(stop) = job.make(&[Source::File(example("lamp.toml"))], &()) else { panic!() };
    assert!(stop.findings[0].message.contains("heights"), "{:?}", stop.findings);
}

/// A follower of proofs: for each program that is proven its name, machine, motions and verdict.
#[derive(Default)]
struct Walks(Mutex<Vec<(String, Vec<proof::Motion>, bool)>>);

struct WalkOf<'a> {
    file: String,
    motions: Vec<proof::Motion>,
    walks: &'a Walks,
}

impl Watch for Walks {
    fn follow<'a>(
        &'a self,
        file: &str,
        source: &'a program::Program,
        machine: &'a machine::Machine,
    ) -> Box<dyn proof::Observer + 'a> {
        assert!(!source.records.is_empty() && !machine.name.is_empty());
        Box::new(WalkOf { file: file.to_owned(), motions: Vec::new(), walks: self })
    }
}

impl proof::Observer for WalkOf<'_> {
    fn wants_motions(&self) -> bool {
        true
    }

    fn moved(&mut self, motion: &proof::Motion) {
        self.motions.push(motion.clone());
    }

    fn ended(&mut self, report: &proof::Report) {
        let motions = std::mem::take(&mut self.motions);
        self.walks.0.lock().unwrap().push((self.file.clone(), motions, report.proven));
    }
}

#[test]
fn who_watches_follows_each_proof_and_changes_nothing() {
    let [source, _] = both("plate.cls");
    let origin = Origin::default();
    let walks = Walks::default();
    let machine = "generic-3axis-linuxcnc";
    let followed = posted(&source, &origin, machine, &walks).unwrap();
    assert_eq!(followed, posted(&source, &origin, machine, &()).unwrap());
    let walked = walks.0.into_inner().unwrap();
    let [(file, motions, true)] = &walked[..] else { panic!("{walked:?}") };
    assert_eq!(file, "p");
    let text = String::from_utf8(followed.0).unwrap();
    let lines = std::fs::read_to_string(example("plate.cls")).unwrap();
    let cuts = motions.iter().filter(|motion| motion.kind == proof::MotionKind::Line);
    let mut compared = 0;
    for motion in cuts {
        let block = text.lines().nth(motion.line as usize - 1).unwrap();
        let record = lines.lines().nth(motion.source_line as usize - 1).unwrap();
        assert!(record.starts_with("GOTO") && block.contains(['X', 'Y', 'Z']), "{record}: {block}");
        compared += 1;
    }
    assert!(compared > 10, "{compared}");

    // The same text, proven alone, and damaged.
    let machine = toolpath::machine(machine).unwrap();
    let toolpath =
        toolpath::read(&source, false, &origin, Some(&machine), Purpose::Program).unwrap();
    let compare = |text: &str| {
        let (walks, tolerances) = (Walks::default(), Tolerances::default());
        let program = ("q", text.as_bytes(), &control::Folders::default());
        prove::compare(&toolpath, &machine, program, &tolerances, &walks).unwrap();
        walks.0.into_inner().unwrap().pop().unwrap()
    };
    let whole = compare(&text);
    assert!(whole.2 && whole.1.len() == motions.len());
    let damaged = compare(&text.replacen("G3", "G2", 1));
    assert!(!damaged.2 && !damaged.1.is_empty() && damaged.1.len() < motions.len());
    // What is not known is NaN: shown, it is alike.
    let before = &motions[..damaged.1.len()];
    assert_eq!(format!("{:?}", damaged.1), format!("{before:?}"));
}

#[test]
fn each_program_of_a_board_and_a_wire_has_a_follower_of_its_own() {
    let machine = toolpath::machine("grbl-3018").unwrap();
    let mut settings = Settings::default();
    settings.isolation.tool = Some(0.3);
    let tolerances = Tolerances::default();
    let [source, _] = both("lamp.toml");
    let walks = Walks::default();
    let job = board::Job::new(&machine, &settings, &tolerances).unwrap();
    let made = job.make(&[source], &walks).unwrap();
    let mut walked = walks.0.into_inner().unwrap();
    walked.sort_by(|a, b| a.0.cmp(&b.0));
    let mut files: Vec<&str> = made.programs.iter().map(|program| &*program.file).collect();
    files.sort_unstable();
    assert_eq!(walked.iter().map(|(file, ..)| file).collect::<Vec<_>>(), files);
    assert!(walked.iter().all(|(_, motions, proven)| *proven && !motions.is_empty()));

    let [source, _] = both("sector.nc");
    let origin = Origin { from: Some("fanuc-31i".into()), ..Origin::default() };
    let machine = toolpath::machine("bp-95d").unwrap();
    let settings = wire::Settings::default();
    let walks = Walks::default();
    wire::make(&source, false, &origin, machine, &settings, "w", &tolerances, &walks).unwrap();
    let walked = walks.0.into_inner().unwrap();
    let [(file, motions, true)] = &walked[..] else { panic!("{walked:?}") };
    assert!(file == "w" && !motions.is_empty());
}

/// A list of points says no feed: it is set at the machine.
#[test]
fn cuts_of_points_take_the_time_of_the_feed_that_is_set_at_the_machine() {
    let [source, _] = both("sector.nc");
    let origin = Origin { from: Some("fanuc-31i".into()), ..Origin::default() };
    let feeds = [vec![0.1], vec![0.1, 0.2], vec![]];
    for feeds in feeds {
        let machine = toolpath::machine("bp-95d").unwrap();
        let cutting = Cutting {
            side: Some(Side::Inside),
            wire: 0.25,
            round_corners: true,
            thread: vec![geom::Vec2::new(15.0, 15.0)],
            leave: feeds.iter().skip(1).map(|_| 0.03).collect(),
            feeds: feeds.clone(),
            ..Default::default()
        };
        let settings = wire::Settings { cutting, ..wire::Settings::default() };
        let (tolerances, walks) = (Tolerances::default(), Walks::default());
        let made =
            wire::make(&source, false, &origin, machine, &settings, "w", &tolerances, &walks)
                .unwrap();
        let report: serde_json::Value = serde_json::from_str(&made.report()).unwrap();
        let walked = walks.0.into_inner().unwrap();
        let cuts = walked[0].1.iter().filter(|motion| motion.kind == proof::MotionKind::Line);
        let seconds: f64 = cuts.clone().map(|motion| motion.seconds).sum();
        match feeds.is_empty() {
            true => assert!(cuts.clone().all(|motion| motion.feed.is_none())),
            false => {
                let said = report["wire"]["cutting_time_s"].as_f64().unwrap();
                assert!((seconds / said - 1.0).abs() < 1e-3, "{seconds} s, {said} s");
                assert!(cuts.clone().all(|motion| motion.feed.is_some()));
            }
        }
    }
}

/// A watch that ends the work when a step is so far, and hears how far each is.
struct Until {
    end: Option<(&'static str, f64)>,
    now: Mutex<(&'static str, f64)>,
    /// Of each step: how often it was told how far it is, and whether that never went back.
    told: Mutex<Vec<(&'static str, usize, bool)>>,
    /// How often it was asked whether the work goes on after the end.
    late: AtomicUsize,
}

impl Until {
    fn new(end: Option<(&'static str, f64)>) -> Until {
        Until {
            end,
            now: Mutex::new(("reading", 0.0)),
            told: Mutex::new(vec![("reading", 0, true)]),
            late: AtomicUsize::new(0),
        }
    }
}

impl Watch for Until {
    fn step(&self, what: &'static str) {
        *self.now.lock().unwrap() = (what, 0.0);
        self.told.lock().unwrap().push((what, 0, true));
    }

    fn reached(&self, part: f64) {
        assert!((0.0..=1.0).contains(&part), "{part}");
        let mut now = self.now.lock().unwrap();
        let mut told = self.told.lock().unwrap();
        let told = told.last_mut().unwrap();
        told.1 += 1;
        told.2 &= now.1 <= part;
        now.1 = part;
    }

    fn is_cancelled(&self) -> bool {
        let (step, part) = *self.now.lock().unwrap();
        let over = self.end.is_some_and(|(end, at)| step == end && part >= at);
        self.late.fetch_add(usize::from(over), Ordering::SeqCst);
        over
    }
}

/// Each step asks every few milliseconds and ends where it is asked: what is between two asks is bounded by the number of lines,
/// records and events.
#[test]
fn each_step_tells_how_far_it_is_and_ends_where_it_is_asked() {
    let mut cls = String::from(
        "PPRINT/LONG\nUNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,90,0,0,1\nFEDRAT/900\n",
    );
    let mut nc = String::from(
        "%\nO1\nG21 G90 G17 G40 G49 G80 G94\nT1 M6\nG54 G43 H1 S900 M3\nG0 X0. Y0. Z90.\n",
    );
    for i in 0..20_000 {
        let (x, y) = (i % 100, i % 7);
        let tilt = f64::from(i % 200 - 100).abs() / 1000.0 + 0.2;
        cls += &format!("GOTO/{x}.5,{y},60,{:.6},0,{:.6}\n", tilt.sin(), tilt.cos());
        nc += &format!("G1 X{x}.5 Y{y}. Z-1. F900.\n");
    }
    cls += "RAPID\nGOTO/0,0,90,0,0,1\nFINI\n";
    nc += "G0 Z90.\nM5\nG28 Z0.\nM30\n%\n";
    let fanuc = Origin { from: Some("fanuc-31i".into()), ..Origin::default() };
    let jobs = [
        (Source::memory("long.cls", cls.into_bytes()), Origin::default(), "fanuc-table-bc"),
        (Source::memory("long.nc", nc.into_bytes()), fanuc, "generic-3axis-linuxcnc"),
    ];
    for (source, origin, machine) in jobs {
        let machine = toolpath::machine(machine).unwrap();
        let work = |watch: &Until| {
            let purpose = Purpose::Program;
            let toolpath =
                toolpath::read_for(&source, false, &origin, Some(&machine), purpose, watch)?;
            post::proven(&toolpath, &machine, "p", &Tolerances::default(), watch)
        };
        let whole = Until::new(None);
        let posted = work(&whole).unwrap();
        assert_eq!(posted.account.verdict, Verdict::Done, "{:?}", posted.account.findings);
        let told = whole.told.lock().unwrap().clone();
        let [("reading", read, true), ("writing", written, true), ("proving", proven, true)] =
            told[..]
        else {
            panic!("{told:?}")
        };
        // 20,000 lines, 1024 at once; as many records and events, 256 at once.
        assert!(read >= 19 && written >= 78 && proven >= 78, "{told:?}");

        for step in ["reading", "writing", "proving"] {
            let watch = Until::new(Some((step, 0.3)));
            let stop = work(&watch).unwrap_err();
            assert_eq!((stop.verdict, stop.findings.len()), (Verdict::Cancelled, 1), "{step}");
            assert_eq!(stop.findings[0].rule, "cancelled");
            let told = watch.told.lock().unwrap().clone();
            assert_eq!(told.last().unwrap().0, step);
            let (_, part) = *watch.now.lock().unwrap();
            assert!((0.3..0.4).contains(&part), "{step} went on to {part}");
            assert!(watch.late.load(Ordering::SeqCst) < 8, "{step}");
        }
    }
}

/// A program that calls another one, and a tool table: all of them from memory as from files.
#[test]
fn called_programs_are_read_from_memory_as_from_a_folder() {
    let main = "%\nO1\nG21 G90 G17 G40 G49 G80 G94\nT1 M6\nG54 G43 H1 S900 M3\nG0 X0. Y0.\nZ5.\nM98 P2\nG0 Z5.\nM5\nG28 Z0.\nM30\n%\n";
    let called = "%\nO2\nG1 Z-1. F100.\nX20.\nM99\n%\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("O0002"), called).unwrap();
    let source = Source::memory("main.nc", main.as_bytes());
    let fanuc = || Origin { from: Some("fanuc-31i".into()), ..Origin::default() };
    let read = |origin: &Origin| {
        toolpath::read(&source, false, origin, None, Purpose::Program).map(|read| {
            let files = read.files().len();
            (read.program, files)
        })
    };
    let (of_folder, files) =
        read(&Origin { folders: vec![folder.path().to_owned()], ..fanuc() }).unwrap();
    assert_eq!(files, 1, "the called file");
    let texts = || [(String::from("O0002"), called.as_bytes().to_vec())].into();
    let (of_memory, files) = read(&Origin { called: texts(), ..fanuc() }).unwrap();
    assert_eq!(files, 0);
    assert_eq!(of_folder.records, of_memory.records);
    // Before those of a folder.
    std::fs::write(folder.path().join("O0002"), called.replace("20.", "30.")).unwrap();
    let both = Origin { folders: vec![folder.path().to_owned()], called: texts(), ..fanuc() };
    assert_eq!(read(&both).unwrap().0.records, of_memory.records);
    let stop = read(&fanuc()).unwrap_err();
    assert!(stop.findings[0].message.contains("O2") || stop.findings[0].message.contains("O0002"));
    let stop = read(&Origin { called: texts(), ..Origin::default() }).unwrap_err();
    assert_eq!(stop.findings[0].rule, "origin");
}

/// The layers of a board, of which the caller says what one holds.
#[test]
fn the_layers_of_a_board_are_read_from_memory_as_from_a_folder() {
    let head = "%FSLAX46Y46*%\n%MOMM*%\n";
    let copper =
        format!("{head}%ADD10C,1.0*%\nD10*\nX2000000Y2000000D02*\nX8000000Y2000000D01*\nM02*\n");
    let outline = format!(
        "{head}%ADD10C,0.1*%\nD10*\nX0Y0D02*\nX10000000Y0D01*\nX10000000Y5000000D01*\nX0Y5000000D01*\nX0Y0D01*\nM02*\n"
    );
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("b.one"), &copper).unwrap();
    std::fs::write(folder.path().join("b.gko"), &outline).unwrap();
    let machine = toolpath::machine("grbl-3018").unwrap();
    let mut settings = Settings::default();
    settings.isolation.tool = Some(0.3);
    let tolerances = Tolerances::default();
    let file = |name: &str| Source::File(folder.path().join(name));
    let memory = |name: &str, text: &str| Source::memory(name, text.as_bytes());
    let made = |given: &[Source], copper: Source| {
        let mut job = board::Job::new(&machine, &settings, &tolerances).unwrap();
        job.named = vec![(copper, ::pcb::board::Layer::Copper(::pcb::board::Face::Front))];
        let made = job.make(given, &()).unwrap();
        made.programs.iter().map(|program| program.posted.text.clone()).collect::<Vec<_>>()
    };
    let of_files = made(&[Source::File(folder.path().to_owned())], file("b.one"));
    let (one, two) = (memory("b.one", &copper), memory("b.gko", &outline));
    let of_memory = made(&[one.clone(), two], one);
    // The copper, and the board cut out.
    assert_eq!(of_files.len(), 2);
    let lines = |texts: &[Vec<u8>]| -> Vec<String> {
        let cuts = |text: &Vec<u8>| {
            String::from_utf8_lossy(text)
                .lines()
                .filter(|line| line.starts_with(['G', 'X', 'Y', 'Z']))
                .collect::<Vec<_>>()
                .join("\n")
        };
        texts.iter().map(cuts).collect()
    };
    assert_eq!(lines(&of_files), lines(&of_memory));
}

/// All that is in a folder, in memory: settings and copies that KiCad makes are none of the board, and the folder is its name.
#[test]
fn a_folder_in_memory_is_a_board_as_on_disk() {
    let text = std::fs::read(example("lamp.toml")).unwrap();
    let machine = toolpath::machine("grbl-3018").unwrap();
    let mut settings = Settings::default();
    settings.isolation.tool = Some(0.3);
    let tolerances = Tolerances::default();
    let files = [
        Source::memory("lamp.toml", text),
        Source::memory("toolpost.toml", &b"passes = 2\n"[..]),
        Source::memory("_autosave-lamp.kicad_pcb", &b"(kicad_pcb)"[..]),
    ];
    let made = |folder: Option<&str>| {
        let mut job = board::Job::new(&machine, &settings, &tolerances).unwrap();
        job.folder = folder.map(str::to_owned);
        job.make(&files, &())
    };
    let whole = made(Some("lights")).unwrap();
    assert_eq!((whole.programs.len(), whole.files.len()), (4, 1));
    // Files that are given by themselves are all meant.
    assert_eq!(made(None).err().unwrap().findings[0].rule, "board");
    // Each program knows the board as it lies for it, and how wide it cuts.
    let [front, _, back, _] = &whole.programs[..] else { panic!() };
    let [(number, _, width)] = &front.widths()[..] else { panic!() };
    assert_eq!((*number, *width), (1, 0.3));
    let copper = |program| {
        let areas = whole.areas(program);
        let copper = areas.areas.iter().filter(|area| area.kind == drawing::AreaKind::Copper);
        let low = |area: &drawing::Area| {
            let own = &areas.trapezoids[area.first..area.first + area.count];
            own.iter().map(|own| own[2].min(own[4])).fold(f64::INFINITY, f64::min)
        };
        (copper.clone().count(), copper.map(low).fold(f64::INFINITY, f64::min))
    };
    assert_ne!(copper(front), copper(back));
    assert!(copper(front).0 > 1 && copper(front).1.is_finite());
}

/// A watch that counts how often it is asked while a board is planned, and ends that at one of the times.
struct Planning {
    end: Option<usize>,
    is_on: AtomicBool,
    asked: AtomicUsize,
}

impl Watch for Planning {
    fn step(&self, what: &'static str) {
        self.is_on.store(what == "planning", Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        if !self.is_on.load(Ordering::Relaxed) {
            return false;
        }
        let asked = self.asked.fetch_add(1, Ordering::Relaxed) + 1;
        self.end.is_some_and(|end| asked >= end)
    }
}

/// Two sides with two parts each: asked for each side, for each part, and between the four steps of isolating a side.
#[test]
fn planning_a_board_is_asked_between_its_steps_and_ends_there() {
    let machine = toolpath::machine("grbl-3018").unwrap();
    let mut settings = Settings::default();
    settings.isolation.tool = Some(0.3);
    let tolerances = Tolerances::default();
    let planned = |end| {
        let watch = Planning { end, is_on: AtomicBool::new(false), asked: AtomicUsize::new(0) };
        let job = board::Job::new(&machine, &settings, &tolerances).unwrap();
        let made = job.make(&[Source::File(example("lamp.toml"))], &watch);
        (made.map(|made| made.programs.len()), watch.asked.into_inner())
    };
    let (made, whole) = planned(None);
    assert_eq!(made.unwrap(), 4);
    assert!(whole >= 2 + 4 + 2 * 3, "{whole}");
    for end in 1..=whole {
        let (made, asked) = planned(Some(end));
        assert_eq!(made.unwrap_err().verdict, Verdict::Cancelled, "{end}");
        // Each of those who run at the same time asks once more, and who waits for them.
        assert!(asked <= end + 8, "{end}: {asked}");
    }
}

#[test]
fn a_board_is_known_by_its_name_and_in_json_by_what_it_says() {
    let is = |name: &str, text: &str| board::is_board(&Source::memory(name, text.as_bytes()));
    for name in ["a.kicad_pcb", "F.Cu.GBR", "holes.drl", "lamp.toml", "x.gtl"] {
        assert!(is(name, ""), "{name}");
    }
    for name in ["dome.cls", "a.nc", "a.txt", "folder", "a.json"] {
        assert!(!is(name, ""), "{name}");
    }
    assert!(is("a.json", r#"{ "nodes": {}, "tracks": [] }"#));
    let job = std::fs::read_to_string(example("bracket.json")).unwrap();
    assert!(!is("bracket.json", &job));
    let named = |name: &str| board::is_named_board(Path::new(name));
    assert_eq!(["a.GBR", "a.cls", "a.JSON"].map(named), [Some(true), Some(false), None]);
}

/// Of a board it is told how many of its programs are made.
#[test]
fn a_board_tells_how_many_of_its_programs_are_made() {
    #[derive(Default)]
    struct Parts(Mutex<Vec<f64>>);
    impl Watch for Parts {
        fn reached(&self, part: f64) {
            self.0.lock().unwrap().push(part);
        }
    }
    let machine = toolpath::machine("grbl-3018").unwrap();
    let mut settings = Settings::default();
    settings.isolation.tool = Some(0.3);
    let tolerances = Tolerances::default();
    let job = board::Job::new(&machine, &settings, &tolerances).unwrap();
    let watch = Parts::default();
    let made = job.make(&[Source::File(example("lamp.toml"))], &watch).unwrap();
    let mut parts = watch.0.into_inner().unwrap();
    parts.sort_by(f64::total_cmp);
    assert_eq!(made.programs.len(), 4);
    assert_eq!(parts, [0.25, 0.5, 0.75, 1.0]);
}
