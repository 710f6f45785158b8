//! What the asks are answered.

use super::run::{self, Order, Program};
use super::socket::of_head;
use super::{LIMITS, Studio};
use crate::ask::{
    ChangesParams, CommandParams, DraftName, DraftParams, FolderParams, FormParams, JobParams,
    KindsParams, Listing, MovesParams, Nothing, Opened, PlaceParams, PlotParams, PostParams,
    ProveParams, SaveParams, SearchParams, TextParams,
};
use crate::job::Waits;
use crate::machines;
use crate::message::{Array, Frame};
use app::Stop;
use geom::ending::Ended;
use program::{Diagnostic, Rule};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::sync::{Arc, MutexGuard};

/// All asks there are.
const ASKS: &str = "open, folder, machines, command, form, post, prove, job, board, text, search, place, moves, plot, changes, save, drafts, draft, draft_text, drop_draft";

/// What an ask is answered: a head and arrays.
pub struct Answer {
    /// The head's `done`.
    pub done: Value,
    /// The arrays.
    pub arrays: Vec<Array>,
}

impl Answer {
    fn of(done: impl Serialize) -> Result<Answer, Stop> {
        Answer::with(done, Vec::new())
    }

    fn with(done: impl Serialize, arrays: Vec<Array>) -> Result<Answer, Stop> {
        let done = serde_json::to_value(done).map_err(|error| wrong(&error.to_string()))?;
        Ok(Answer { done, arrays })
    }
}

/// Whether an ask makes a job: of those of a page the newest ends the older.
pub fn makes_job(ask: &str) -> bool {
    ["post", "prove"].contains(&ask)
}

/// Answers an ask.
///
/// # Errors
/// It is none, its parameters are wrong, or it has no answer.
pub fn answer(
    studio: &Arc<Studio>,
    ask: &str,
    params: Map<String, Value>,
    arrays: Vec<Array>,
    page: u64,
    work: (&dyn Waits, &Ended),
) -> Result<Answer, Stop> {
    let folder = &studio.folder;
    let mut frame = Frame { head: Map::new(), arrays };
    match ask {
        "open" => {
            none(params)?;
            Answer::of(Opened {
                version: env!("CARGO_PKG_VERSION"),
                folder: folder.name(),
                source: studio.source.clone(),
                machine: studio.machine.clone(),
                drafts: folder.drafts(),
                limits: LIMITS,
            })
        }
        "folder" => {
            let FolderParams { path } = read(params)?;
            let (entries, is_whole) = folder.list(&path)?;
            Answer::of(Listing { entries, is_whole })
        }
        "machines" => {
            none(params)?;
            Answer::of(machines::list(folder))
        }
        "command" => {
            let CommandParams { source, machine } = read(params)?;
            let machine = machine.map(|name| machines::open(&name, folder)).transpose()?;
            Answer::of(studio.command(&source, machine.as_ref())?)
        }
        "kinds" => {
            let KindsParams { source } = read(params)?;
            Answer::of(studio.kinds(&source)?)
        }
        "form" => {
            let FormParams { command } = read(params)?;
            Answer::of(studio.form.map(|form| form(command)).unwrap_or_default())
        }
        "post" => {
            let PostParams { source, machine, options, file } = read(params)?;
            let order = Order { source, machine, options, file, program: Program::Posted };
            made(studio, order, page, work)
        }
        "prove" => {
            let ProveParams { source, machine, options, file, program, revision, files } =
                read(params)?;
            let program = match (program, frame.take_text("text"), revision) {
                (None, Some(text), Some(revision)) => Program::Edited { text, revision, files },
                (None, Some(text), None) if files.is_empty() => Program::Text(text),
                (Some(program), None, None) if files.is_empty() => {
                    let text = studio.source(&program)?.read()?.into_owned();
                    Program::There(program, text)
                }
                _ => {
                    return Err(wrong(
                        "a program is proven by `program`, or by the array `text`, also as an edit of a `revision` and its `files`",
                    ));
                }
            };
            let order = Order { source, machine, options, file, program };
            made(studio, order, page, work)
        }
        "job" => {
            let JobParams { revision } = read(params)?;
            Answer::of(studio.jobs.find(revision)?.about(revision, folder))
        }
        "board" => {
            let JobParams { revision } = read(params)?;
            let job = studio.jobs.find(revision)?;
            let board = job.board().ok_or_else(|| wrong("this is no program of a board"))?;
            let (about, arrays) = board.picture();
            Answer::with(about, arrays)
        }
        "text" => {
            let TextParams { revision, of, file, from, to } = read(params)?;
            let job = studio.jobs.find(revision)?;
            let (about, text) = job.text(of, file.as_deref(), from, to)?;
            Answer::with(about, vec![text])
        }
        "search" => {
            let SearchParams { revision, of, file, text, from } = read(params)?;
            Answer::of(studio.jobs.find(revision)?.search(of, file.as_deref(), &text, from)?)
        }
        "place" => {
            let PlaceParams { revision, by, value, file } = read(params)?;
            Answer::of(studio.jobs.find(revision)?.place(by, value, file.as_deref()))
        }
        "moves" => {
            let MovesParams { revision, by, value, file } = read(params)?;
            Answer::of(studio.jobs.find(revision)?.moves(by, value, file.as_deref())?)
        }
        "plot" => {
            let PlotParams { revision, what, from, to, pixels } = read(params)?;
            let job = studio.jobs.find(revision)?;
            Answer::with(Nothing {}, job.plot(&what, [from, to], pixels)?)
        }
        "changes" => {
            let ChangesParams { revision } = read(params)?;
            let inputs = match revision {
                Some(revision) => Some(studio.jobs.find(revision)?.inputs().changes(folder)),
                None => {
                    let stopped = studio.stopped().get(&page).map(Arc::clone);
                    stopped.map(|inputs| inputs.changes(folder))
                }
            };
            Answer::of(inputs.unwrap_or_default())
        }
        "save" => {
            let SaveParams { revision, path, replace } = read(params)?;
            Answer::of(studio.jobs.find(revision)?.save(folder, &path, replace)?)
        }
        "drafts" => {
            none(params)?;
            Answer::of(folder.drafts())
        }
        "draft" => {
            let DraftParams { name, of } = read(params)?;
            let text = frame.take_text("text").ok_or_else(|| wrong("`text` is missing"))?;
            let mut drafting = own_draft(studio, &name, page)?;
            folder.keep_draft(&name, &of, &text)?;
            drafting.insert(name, page);
            Answer::of(Nothing {})
        }
        "draft_text" => {
            let DraftName { name } = read(params)?;
            let text = folder.text_of_draft(&name)?;
            Answer::with(Nothing {}, vec![Array::text("text", text)])
        }
        "drop_draft" => {
            let DraftName { name } = read(params)?;
            let mut drafting = own_draft(studio, &name, page)?;
            folder.drop_draft(&name)?;
            drafting.remove(&name);
            Answer::of(Nothing {})
        }
        _ => Err(wrong(&format!("there is no ask `{ask}`; there are {ASKS}"))),
    }
}

/// Makes a job, and keeps it.
fn made(
    studio: &Arc<Studio>,
    order: Order,
    page: u64,
    (waits, ended): (&dyn Waits, &Ended),
) -> Result<Answer, Stop> {
    let revision = run::made(studio, order, page, waits, ended)?;
    Answer::of(studio.jobs.find(revision)?.about(revision, &studio.folder))
}

/// Checks that no other page that is open keeps a draft of this name, and holds that until it is kept or dropped.
///
/// # Errors
/// One does.
fn own_draft<'a>(
    studio: &'a Studio,
    name: &str,
    page: u64,
) -> Result<MutexGuard<'a, BTreeMap<String, u64>>, Stop> {
    let drafting = studio.drafting();
    match drafting.get(name) {
        Some(other) if *other != page => {
            let message =
                format!("another page that is open edits this too: the draft {name} is its own");
            Err(Diagnostic::error(Rule::StudioDraft, message).into())
        }
        _ => Ok(drafting),
    }
}

/// The parameters of an ask.
fn read<T: DeserializeOwned>(params: Map<String, Value>) -> Result<T, Stop> {
    of_head(params).map_err(|why| wrong(&why))
}

/// Checks that an ask has no parameters.
fn none(params: Map<String, Value>) -> Result<(), Stop> {
    if params.is_empty() { Ok(()) } else { Err(wrong("this ask has no parameters")) }
}

/// What the page has done wrong.
pub fn wrong(why: &str) -> Stop {
    let why: String = why.chars().take(300).collect();
    Diagnostic::error(Rule::StudioAsk, why).into()
}
