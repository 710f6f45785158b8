//! Work that makes jobs. Each runs in a thread of its own, so that whoever waits for it goes as soon as it is ended, whatever step it is in.

use super::Studio;
use crate::ask::{Command, FileOrUpload, Given};
use crate::drawing::Piece;
use crate::edit::Existing;
use crate::inputs::Inputs;
use crate::job::{Asked, Job, Waits};
use crate::jobs::Jobs;
use app::{Stop, Verdict};
use geom::ending::Ended;
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// How often who waits looks whether the work was ended.
const LOOK: Duration = Duration::from_millis(4);

/// How many runs that nobody waits for may be in a step that goes on to its end, since no helper does it, while another begins.
const MOST_LEFT: usize = 1;

/// What is to be made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Order {
    /// The toolpath, or the board.
    pub source: Given,
    /// Name of the machine.
    pub machine: String,
    /// Options as the command line has them.
    pub options: Vec<(String, String)>,
    /// Name of the program's file.
    pub file: Option<String>,
    /// What is proven.
    pub program: Program,
}

/// What is proven.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Program {
    /// What is posted.
    Posted,
    /// A program that is there, and its text.
    There(FileOrUpload, Vec<u8>),
    /// A text.
    Text(Vec<u8>),
    /// An edit of files of the program of a job.
    Edited {
        /// Their texts, one behind the other.
        text: Vec<u8>,
        /// The job.
        revision: u64,
        /// Their names, none for the program itself, and how many bytes of the text each has; none: the program itself is all of it.
        files: Vec<(Option<String>, u64)>,
    },
}

/// What a run has made, or why it has made nothing.
type Made = Result<Vec<Job>, Stop>;

/// What a run tells.
enum Told {
    Step(&'static str),
    Reached(f64),
    Walked(String, Piece),
    Over(Made),
}

/// Tells whoever will wait for it.
struct Tells(Sender<Told>);

impl Tells {
    fn tell(&self, told: Told) {
        // Nobody waits any more.
        let _ = self.0.send(told);
    }
}

impl Waits for Tells {
    fn step(&self, what: &'static str) {
        self.tell(Told::Step(what));
    }

    fn reached(&self, part: f64) {
        self.tell(Told::Reached(part));
    }

    fn walked(&self, file: &str, piece: Piece) {
        self.tell(Told::Walked(file.to_owned(), piece));
    }
}

/// How many bytes a work takes at the most while it is made, for each byte that it is made of: 5 to 8.5 of toolpaths of a million moves and more.
const BYTES_OF_A_BYTE: usize = 10;

/// Makes place for a work when what it is made of has been read.
struct MakesRoom<'a> {
    waits: &'a dyn Waits,
    jobs: &'a Jobs,
    bytes: usize,
}

impl Waits for MakesRoom<'_> {
    fn step(&self, what: &'static str) {
        if what != "reading" {
            self.jobs.make_room(self.bytes);
        }
        self.waits.step(what);
    }

    fn reached(&self, part: f64) {
        self.waits.reached(part);
    }

    fn walked(&self, file: &str, piece: Piece) {
        self.waits.walked(file, piece);
    }
}

/// Work that has begun.
#[derive(Debug)]
struct Run {
    told: Receiver<Told>,
    thread: JoinHandle<()>,
    ended: Ended,
    /// The files that it has read so far.
    inputs: Arc<Inputs>,
}

impl Run {
    fn begin(studio: &Arc<Studio>, order: Order, ended: &Ended) -> Run {
        let (tells, told) = channel();
        let (tells, studio) = (Tells(tells), Arc::clone(studio));
        let own = ended.with_helper(studio.helper.clone());
        let inputs = Arc::<Inputs>::default();
        let read = Arc::clone(&inputs);
        studio.runs.begin();
        let thread = thread::spawn(move || {
            let _over = Over(&studio);
            let made = own.run(|| make(&studio, order, &read, &tells, &own));
            tells.tell(Told::Over(made.unwrap_or_else(|| Err(Stop::cancelled()))));
        });
        Run { told, thread, ended: ended.clone(), inputs }
    }

    /// Ends it, and does not wait for that.
    fn leave(self, studio: &Studio) {
        self.ended.end();
        studio.left.add(self.thread);
    }

    /// Waits until it is over or `ended`.
    fn wait(self, studio: &Studio, waits: &dyn Waits, ended: &Ended) -> Made {
        loop {
            match self.told.recv_timeout(LOOK) {
                Ok(Told::Step(what)) => waits.step(what),
                Ok(Told::Reached(part)) => waits.reached(part),
                Ok(Told::Walked(file, piece)) => waits.walked(&file, piece),
                Ok(Told::Over(made)) => return made,
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => match self.thread.join() {
                    Err(panic) => resume_unwind(panic),
                    Ok(()) => return Err(Stop::cancelled()),
                },
            }
            if ended.is_ended() {
                self.leave(studio);
                return Err(Stop::cancelled());
            }
        }
    }
}

/// Says that a run is over, however it ends.
struct Over<'a>(&'a Studio);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.runs.end();
    }
}

/// Runs that nobody waits for any more, and that have not ended yet. They do within milliseconds where helpers do the steps that are not asked meanwhile; such a step goes on
/// to its end where the system starts no process.
#[derive(Debug, Default)]
pub struct Left(Mutex<Vec<JoinHandle<()>>>);

impl Left {
    fn add(&self, thread: JoinHandle<()>) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(thread);
    }

    fn count(&self) -> usize {
        let mut threads = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        threads.retain(|thread| !thread.is_finished());
        threads.len()
    }

    /// Waits until there are few enough that another run may begin.
    ///
    /// # Errors
    /// That is ended meanwhile.
    fn wait(&self, ended: &Ended) -> Result<(), Stop> {
        while self.count() > MOST_LEFT {
            if ended.is_ended() {
                return Err(Stop::cancelled());
            }
            thread::sleep(LOOK);
        }
        Ok(())
    }
}

/// The work that the command line names: it begins with the server, and who asks for the same joins it.
#[derive(Debug)]
pub struct First {
    order: Order,
    run: Run,
}

impl First {
    /// Begins it, where source and machine are named.
    pub fn begin(studio: &Arc<Studio>) {
        let (Some(source), Some(machine)) = (studio.source.clone(), studio.machine.clone()) else {
            return;
        };
        let (options, file, program) = (Vec::new(), None, Program::Posted);
        let order = Order { source, machine, options, file, program };
        let run = Run::begin(studio, order.clone(), &Ended::default());
        *studio.first() = Some(First { order, run });
    }

    /// What it has made; `None` where that would be something else today.
    fn made(self, studio: &Studio, waits: &dyn Waits, ended: &Ended) -> Option<Made> {
        let inputs = Arc::clone(&self.run.inputs);
        let is_new = || inputs.changes(&studio.folder).files.is_empty();
        if !is_new() {
            self.run.leave(studio);
            return None;
        }
        let made = self.run.wait(studio, waits, ended);
        is_new().then_some(made)
    }
}

/// Makes what is ordered for a page, and answers the revision of its first job; where there is none, it is kept for the page what the work was
/// made of. The first work of all is joined where it is this one; where it is another, it is ended.
///
/// # Errors
/// Why there is no job; or that the work was ended.
pub fn made(
    studio: &Arc<Studio>,
    order: Order,
    page: u64,
    waits: &dyn Waits,
    ended: &Ended,
) -> Result<u64, Stop> {
    let first = studio.first().take();
    let joined = match first {
        Some(first) if first.order == order => {
            let inputs = Arc::clone(&first.run.inputs);
            first.made(studio, waits, ended).map(|made| (inputs, made))
        }
        Some(first) => {
            first.run.leave(studio);
            None
        }
        None => None,
    };
    let (inputs, made) = match joined {
        Some(joined) => joined,
        None => {
            studio.left.wait(ended)?;
            let run = Run::begin(studio, order, ended);
            (Arc::clone(&run.inputs), run.wait(studio, waits, ended))
        }
    };
    if made.as_ref().is_err_and(|stop| stop.verdict != Verdict::Cancelled) {
        studio.stopped().insert(page, inputs);
    }
    Ok(studio.jobs.keep(made?.into_iter().map(Arc::new).collect()))
}

/// Does the work.
fn make(
    studio: &Studio,
    order: Order,
    inputs: &Arc<Inputs>,
    waits: &dyn Waits,
    ended: &Ended,
) -> Made {
    let Order { source, machine, options, file, program } = order;
    if let Program::Edited { revision, .. } = &program {
        inputs.begin_as(studio.jobs.find(*revision)?.inputs());
    }
    let sources = studio.sources(&source, inputs)?;
    let more = match sources.command(None) {
        Command::Pcb => studio.more(&source, &options, inputs)?,
        Command::Post | Command::Wire | Command::Glass => None,
    };
    let text_bytes = match &program {
        Program::Posted => 0,
        Program::Text(text) | Program::There(_, text) | Program::Edited { text, .. } => text.len(),
    };
    let bytes = sources.bytes().saturating_add(text_bytes).saturating_mul(BYTES_OF_A_BYTE);
    let waits = MakesRoom { waits, jobs: &studio.jobs, bytes };
    let (named, program) = match program {
        Program::Posted => (None, None),
        Program::Text(text) | Program::There(FileOrUpload::Upload(_), text) => {
            (None, Some(Existing::new(text, Vec::new())))
        }
        // A program of the folder keeps its name, and calls what lies beside it.
        Program::There(FileOrUpload::File(path), text) => {
            let within = studio.folder.target(&path).ok();
            let beside = within.as_deref().and_then(Path::parent).map(Path::to_owned);
            let name = path.rsplit('/').next().map(str::to_owned);
            (name, Some(Existing::new(text, beside.into_iter().collect())))
        }
        Program::Edited { text, revision, mut files } => {
            let of = studio.jobs.find(revision)?;
            if files.is_empty() {
                files.push((None, text.len() as u64));
            }
            (Some(of.file().to_owned()), Some(Existing::edited(of, &files, &text)?))
        }
    };
    let asked = Asked {
        source: sources,
        machine: &machine,
        options: &|command| studio.options(command, &options, more.as_ref()),
        file: file.or(named),
        program,
        inputs,
    };
    Job::make(asked, &studio.folder, &waits, ended)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_run_begins_when_no_more_than_one_is_left() {
        let left = Left::default();
        let (mut ends, ended): (Vec<_>, Vec<_>) = (0..2).map(|_| channel::<()>()).unzip();
        for ended in ended {
            left.add(thread::spawn(move || _ = ended.recv()));
        }
        let one = Ended::default();
        one.end();
        assert!(left.wait(&one).is_err());
        assert_eq!(left.count(), 2);
        ends.pop();
        left.wait(&Ended::default()).unwrap();
        assert_eq!(left.count(), 1);
    }
}
