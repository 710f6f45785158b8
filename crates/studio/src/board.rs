//! Boards: several programs that are made of one source and saved together, and what a board is drawn with.

use crate::ask::{
    BoardAbout, BoardArea, BoardAreaKind, BoardPicture, BoardPlace, BoardProgram, LeftOut, Of,
    Saved, Turning,
};
use crate::edit::Existing;
use crate::folder::Folder;
use crate::inputs::Inputs;
use crate::job::{
    Follows, Job, Made, Options, Reported, Sources, called, called_from, complete, rows,
};
use crate::lines::Lines;
use crate::machines::Any;
use crate::message::{Array, Values};
use crate::origin::Texts;
use ::post::Origins;
use app::pcb::{AreaKind, Axis, BoardAreas, Layer};
use app::{Account, Source, Stop, Verdict, Watch, files, pcb, post};
use machine::Machine;
use program::{Diagnostic, Rule, encoding};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The report of all programs of a board.
pub const REPORT: &str = "report.json";

/// How a board is made, as the options of the command say it.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// What is cut, and with what.
    pub plan: pcb::Settings,
    /// Measured heights that the programs follow.
    pub heights: Option<Source>,
    /// Files of which the options say what they hold.
    pub named: Vec<(Source, Layer)>,
    /// The options as they are typed: the report keeps them.
    pub typed: Vec<String>,
    /// Those of them that stand in a file, and in which.
    pub stated: Option<String>,
    /// What was found in a file with options.
    pub found: Vec<Diagnostic>,
}

impl Settings {
    /// What of it is reported: that options of a file count.
    fn row(&self) -> Option<(&'static str, String)> {
        Some(("options", self.stated.clone()?))
    }

    /// The files that it names.
    pub(crate) fn files(&mut self) -> impl Iterator<Item = &mut Source> {
        self.heights.iter_mut().chain(self.named.iter_mut().map(|(file, _)| file))
    }
}

/// All that is made of a board.
#[derive(Debug)]
struct Whole {
    name: String,
    account: Account,
    /// Names and files of the programs, and how many findings each has.
    programs: Vec<(String, String, usize)>,
    /// Files that such boards have and this one does not.
    others: Vec<String>,
    left_out: Vec<(String, Vec<Diagnostic>)>,
    /// What is saved: the report, and the programs.
    contents: Vec<(String, Vec<u8>)>,
}

/// A program's place in its board.
#[derive(Debug)]
pub struct Place {
    whole: Arc<Whole>,
    /// Which of the programs it is.
    number: usize,
    areas: BoardAreas,
    /// How wide its only tool cuts, mm.
    width: Option<f64>,
}

/// Writes the programs of a board and proves them: a job for each.
///
/// # Errors
/// Why there is none, or that the work was ended.
pub(crate) fn make(
    source: Sources,
    options: &Options,
    (machine_name, machine): (&str, &Machine),
    follows: &Follows,
) -> Result<Vec<Job>, Stop> {
    let settings = options.board.as_deref().cloned().unwrap_or_default();
    let (job, board) = begun(source, options, machine, &settings)?;
    let made = job.make(&board, follows)?;
    let mut account = made.account(&job, settings.found.clone());
    if !matches!(account.verdict, Verdict::Done | Verdict::Partly) {
        return Err(account.into());
    }
    follows.step("drawing");
    account.rows.extend(settings.row());
    let report = format!("{:#}\n", account.data);
    let contents = made.contents(&job, &report);
    let contents = contents.into_iter().map(|(name, bytes)| (name, bytes.to_vec())).collect();
    let left_out = made.left_out.iter().map(|left| (left.file.clone(), left.findings().collect()));
    let named = |made: &pcb::Program| {
        (made.name.clone(), made.file.clone(), made.posted.account.findings.len())
    };
    let whole = Arc::new(Whole {
        name: made.name().to_owned(),
        programs: made.programs.iter().map(named).collect(),
        others: pcb::other_files(machine, &made.programs),
        left_out: left_out.collect(),
        contents,
        account,
    });
    let texts = Arc::new(texts(made.name(), &made.files, made.layers()));
    let drawn = made.drawn(&job);
    let areas: Vec<BoardAreas> = made.programs.iter().map(|program| made.areas(program)).collect();
    let lines = made
        .programs
        .iter()
        .map(|program| numbered(&made.lines(&job, &drawn, program), &texts, &made.files));
    let lines: Vec<Vec<u32>> = lines.collect();
    drop(drawn);
    let programs = made.programs.into_iter().zip(areas).zip(lines).enumerate();
    let job = |(number, ((program, areas), lines)): (usize, ((pcb::Program, BoardAreas), _))| {
        let widths = program.widths();
        let pcb::Program { file, mut toolpath, machine, posted, .. } = program;
        let post::Posted { text: written, origins, parts, account } = posted;
        texts.name().clone_into(&mut toolpath.file);
        let width = match widths[..] {
            [(.., width)] => Some(width),
            _ => None,
        };
        let board = Some(Place { whole: Arc::clone(&whole), number, areas, width });
        let made = Made {
            toolpath,
            account,
            text: written,
            origins,
            parts,
            report: None,
            widths,
            board,
            lines: Some(lines),
        };
        let machine = (machine_name, Any::Moves(machine.into()));
        Job::of(made, Arc::clone(&texts), (file, machine), follows)
    };
    programs.map(job).collect()
}

/// What is to be made, and the files that the board is.
fn begun<'a>(
    source: Sources,
    options: &'a Options,
    machine: &'a Machine,
    settings: &'a Settings,
) -> Result<(pcb::Job<'a>, Vec<Source>), Stop> {
    let mut job = pcb::Job::new(machine, &settings.plan, &options.tolerances)?;
    (job.surface, job.named) = (settings.heights.clone(), settings.named.clone());
    (job.strict, job.options) = (options.strict, settings.typed.clone());
    let board = match source {
        Sources::One(file) => vec![file],
        Sources::Several(files) => files,
        Sources::Folder(name, files) => {
            job.folder = Some(name);
            files
        }
    };
    Ok((job, board))
}

/// Proves a program of a board that was edited, by itself: what it is called says which of the programs it is.
///
/// # Errors
/// What is wrong with the board, that it has no such program, or that the work was ended.
pub(crate) fn prove(
    source: Sources,
    options: &Options,
    (machine_name, machine): (&str, &Machine),
    (file, given): (String, Existing),
    follows: &Follows,
) -> Result<Job, Stop> {
    let settings = options.board.as_deref().cloned().unwrap_or_default();
    let (job, board) = begun(source, options, machine, &settings)?;
    let folders = called_from(machine, &given);
    let program = (encoding::without_mark(&given.text), &folders);
    // By its whole name: beside `drill.gcode` there is no program `drill.ngc`.
    let compared = job.prove(&board, (&file, &file), program, follows)?;
    let lines = compared.lines(&job);
    let pcb::Compared { mut account, mut toolpath, machine, widths, board, files, layers, .. } =
        compared;
    account.rows.extend(settings.row());
    let (text, parts) = called(&account, given, &folders);
    complete(&mut account, &text, &parts, &toolpath, &machine);
    let texts = texts(&board, &files, &layers);
    let lines = Some(numbered(&lines, &texts, &files));
    texts.name().clone_into(&mut toolpath.file);
    follows.step("drawing");
    let (origins, board, report) = (Origins::default(), None, Some(Reported::Account));
    let made = Made { toolpath, account, text, origins, parts, report, widths, board, lines };
    let machine = (machine_name, Any::Moves(machine.into()));
    let job = Job::of(made, texts.into(), (file, machine), follows)?;
    Ok(job.keeping_its_name())
}

/// What is shown as the source: the file of a board that is one file; of others what each was taken for, and those files.
fn texts(board: &str, files: &[Source], layers: &[(String, String)]) -> Texts {
    let text = |file: &Source| Lines::of(file.text().unwrap_or_default().into_owned());
    if let [file] = files {
        return Texts::of(file.name(), text(file));
    }
    let line = |(file, layer): &(String, String)| format!("{file}: {layer}\n");
    let listed = Lines::of(layers.iter().map(line).collect::<String>().into_bytes());
    let of_layer = |file: &&Source| layers.iter().any(|(name, _)| *name == file.name());
    let files = files.iter().filter(of_layer);
    files.fold(Texts::of(board.to_owned(), listed), |all, file| all.with(file.name(), text(file)))
}

/// The lines of records as the texts count them; 0 for none.
fn numbered(lines: &[Option<pcb::Line>], texts: &Texts, files: &[Source]) -> Vec<u32> {
    let names: Vec<String> = files.iter().map(Source::name).collect();
    let number = |line: &pcb::Line| texts.number(Some(names.get(line.file as usize)?), line.line);
    lines.iter().map(|line| line.as_ref().and_then(number).unwrap_or(0)).collect()
}

impl Place {
    /// How much memory it takes, bytes: its share of what all programs have together.
    pub fn bytes(&self) -> usize {
        let contents: usize = self.whole.contents.iter().map(|(_, bytes)| bytes.len()).sum();
        size_of_val(&self.areas.trapezoids[..])
            + size_of_val(&self.areas.holes[..])
            + contents / self.whole.programs.len().max(1)
    }

    /// What is wrong with the board, or worth knowing.
    pub fn findings(&self) -> &[Diagnostic] {
        &self.whole.account.findings
    }

    /// What is said of the board, where the job of this program has the revision.
    pub fn about(&self, revision: u64) -> BoardAbout {
        let Whole { name, account, programs, left_out, .. } = &*self.whole;
        let first = revision - self.number as u64;
        let program = |((name, file, findings), revision): (&(String, String, usize), u64)| {
            let (name, file, findings) = (name.clone(), file.clone(), *findings as u32);
            BoardProgram { name, file, revision, findings }
        };
        let left = |(file, findings): &(String, Vec<Diagnostic>)| LeftOut {
            file: file.clone(),
            findings: findings.iter().cloned().map(Into::into).collect(),
        };
        BoardAbout {
            name: name.clone(),
            verdict: account.verdict.into(),
            rows: rows(account),
            programs: programs.iter().zip(first..).map(program).collect(),
            left_out: left_out.iter().map(left).collect(),
        }
    }

    /// What the board is drawn with below the cuts of this program.
    pub fn picture(&self) -> (BoardPicture, Vec<Array>) {
        let BoardAreas { areas, trapezoids, holes, tabs, problems, turning, chord, is_whole } =
            &self.areas;
        let area = |area: &pcb::Area| BoardArea {
            kind: match area.kind {
                AreaKind::Board => BoardAreaKind::Board,
                AreaKind::Copper => BoardAreaKind::Copper,
                AreaKind::Rest => BoardAreaKind::Rest,
            },
            net: area.net.clone(),
            conductor: area.conductor as u32,
            count: area.count as u32,
        };
        let place = |problem: &pcb::Problem| BoardPlace {
            x: problem.at.x,
            y: problem.at.y,
            kind: problem.kind.name(),
            what: problem.what.clone(),
        };
        let turned = |axis: Axis| match axis {
            Axis::X(at) => Turning { along: "Y", at },
            Axis::Y(at) => Turning { along: "X", at },
        };
        let about = BoardPicture {
            areas: areas.iter().map(area).collect(),
            places: problems.iter().map(place).collect(),
            turning: turning.map(turned),
            width: self.width,
            error: *chord,
            is_whole: *is_whole,
        };
        fn array(name: &str, numbers: impl Iterator<Item = f64>) -> Array {
            Array::new(name, Values::F32(numbers.map(|number| number as f32).collect()))
        }
        let arrays = vec![
            array("areas", trapezoids.iter().flatten().copied()),
            array("holes", holes.iter().flatten().copied()),
            array("tabs", tabs.iter().flatten().copied()),
        ];
        (about, arrays)
    }

    /// Saves all programs of the board and their report in a folder, all or none.
    ///
    /// # Errors
    /// The path leads out of the folder, one of the files is there already, or cannot be saved; nothing is changed then.
    pub fn save(
        &self,
        folder: &Folder,
        path: &str,
        replace: bool,
        inputs: &Inputs,
    ) -> Result<Saved, Stop> {
        let Whole { contents, .. } = &*self.whole;
        let target = folder.target(path)?;
        let refused = |message: String, help: &str| {
            Stop::from(Diagnostic::error(Rule::OutputFolder, message).help(help).file(path))
        };
        let of_board = inputs.files(folder, Some(Of::Source));
        if of_board.iter().any(|input| input.parent() == Some(&target)) {
            let message = String::from("the programs would be saved among the files of the board");
            return Err(refused(message, "give a folder of its own"));
        }
        let mut saved = Vec::with_capacity(contents.len());
        for (name, _) in contents {
            let path = format!("{path}/{name}");
            if folder.target(&path)?.exists() && !replace {
                let message = format!("{name} is there already");
                return Err(refused(message, "give another folder, or replace what is there"));
            }
            saved.push(path);
        }
        let contents: Vec<(String, &[u8])> =
            contents.iter().map(|(name, bytes)| (name.clone(), &bytes[..])).collect();
        let inputs = inputs.files(folder, None);
        let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
        files::save_in(&target, &contents, &inputs)?;
        // The programs first.
        saved.rotate_left(1);
        let programs =
            self.whole.programs.iter().map(|(_, file, _)| files::report_of(&target.join(file)));
        let left = programs.filter(|report| report.exists()).map(|report| {
            let message = "is of an edited program that these have taken the place of";
            let found = Diagnostic::warning(Rule::ReportPair, message);
            let name = format!("{path}/{}", files::name(&report));
            found.help("remove it").file(name).into()
        });
        let older = pcb::older(&self.whole.others, &target);
        let older = older.into_iter().map(|found| found.file(path).into());
        Ok(Saved { files: saved, findings: left.chain(older).collect() })
    }
}
