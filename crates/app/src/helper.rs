//! Steps of work in processes of their own, which can be killed in the middle: what [`geom::ending::Helper`] wants.
//!
//! A process does one step. What is asked comes by its standard input, the answer leaves by its standard output, both as blocks, each with its
//! length and a sum of all up to there, so that what is damaged or cut off is never taken for a step or an answer. The input stays
//! open meanwhile: the process ends as soon as that is closed, which it is with the process that has started it, however that ends; on Linux the system kills it then.

mod blocks;

use blocks::{Reader, Writer};
use geom::ending::{self, Helper, Step, Take};
use std::ffi::OsString;
use std::io::{self, Read, Write};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;
use std::{panic, process, thread};

/// The steps that there are.
const STEPS: [(&str, Step); 2] = [geom::region::STEP, glass::picture::STEP];

/// How often who waits looks whether the work was ended.
const LOOK: Duration = Duration::from_millis(2);

/// Has the C library of Linux take memory in pages of 2 MB where the system has them: the system frees 1 GB of a process that is killed in 3 ms
/// then, and in 80 ms in pages of 4 kB. Elsewhere it means nothing.
const LARGE_PAGES: [(&str, &str); 1] = [("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1")];

/// What a step is named with: another version may do it otherwise.
fn name(step: &str) -> String {
    format!("{} {step}", env!("CARGO_PKG_VERSION"))
}

/// The longest of these, bytes.
const LONGEST_NAME: u8 = 64;

/// Starts a process for each step. The program that it starts calls [`serve`].
#[derive(Clone, Debug)]
pub struct Launcher {
    program: PathBuf,
    arguments: Vec<OsString>,
}

impl Launcher {
    /// By this program and its arguments.
    pub fn new(
        program: impl Into<PathBuf>,
        arguments: impl IntoIterator<Item = OsString>,
    ) -> Launcher {
        Launcher { program: program.into(), arguments: arguments.into_iter().collect() }
    }

    fn start(&self) -> io::Result<Child> {
        let mut command = Command::new(&self.program);
        command.args(&self.arguments).envs(LARGE_PAGES).stderr(Stdio::null());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()
    }
}

impl Helper for Launcher {
    fn help(&self, step: &'static str, asked: &[u8], take: &mut Take<'_>) -> bool {
        let Ok(child) = self.start() else { return false };
        let mut child = Killed(child);
        let (Some(input), Some(output)) = (child.0.stdin.take(), child.0.stdout.take()) else {
            return false;
        };
        // Stays open while the answer is waited for.
        let mut input = Writer::new(input);
        let (tells, told) = channel();
        let ask = || ask(step, asked, &mut input);
        let read = move || {
            let mut output = Reader::new(output);
            let is_answered = take(&mut output).and_then(|()| output.finish());
            // Nobody waits any more.
            let _ = tells.send(is_answered.is_ok());
        };
        thread::scope(|scope| {
            let begin = || thread::Builder::new();
            let is_begun = begin().spawn_scoped(scope, ask).is_ok()
                && begin().spawn_scoped(scope, read).is_ok();
            let is_answered = is_begun && is_told(&told);
            // Whatever still writes or reads ends with it.
            child.kill();
            is_answered
        })
    }
}

/// Waits for what is told, which is nothing where the work of this thread is ended.
fn is_told(told: &Receiver<bool>) -> bool {
    loop {
        match told.recv_timeout(LOOK) {
            Ok(told) => return told,
            Err(RecvTimeoutError::Timeout) if !ending::is_ended() => {}
            Err(_) => return false,
        }
    }
}

/// Asks a process for a step.
fn ask(step: &str, asked: &[u8], to: &mut Writer<impl Write>) -> io::Result<()> {
    let name = name(step);
    to.write_all(&[name.len() as u8])?;
    to.write_all(name.as_bytes())?;
    to.write_all(asked)?;
    to.finish()
}

/// A process that is killed when it is dropped.
struct Killed(Child);

impl Killed {
    fn kill(&mut self) {
        // It may be gone already.
        let _ = self.0.kill();
    }
}

impl Drop for Killed {
    fn drop(&mut self) {
        self.kill();
        let _ = self.0.wait();
    }
}

/// Does the step that comes by the standard input, once, as the process of a [`Launcher`]. Says nothing but the answer.
///
/// # Errors
/// What has come is no step, or who has asked is gone.
pub fn serve() -> io::Result<()> {
    panic::set_hook(Box::new(|_| {}));
    // The input is closed late where the system has much memory of the other process to free first. The signal comes with the end of the thread that has
    // started this process, which waits for it.
    #[cfg(target_os = "linux")]
    rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::KILL))?;
    let mut asked = Reader::new(io::stdin().lock());
    let step = named(&mut asked)?;
    let does = step(&mut asked)?;
    asked.finish()?;
    drop(asked);
    // Whoever says more, or nothing any more, waits for no answer.
    thread::Builder::new().spawn(|| {
        let _ = io::stdin().read(&mut [0]);
        process::exit(1);
    })?;
    let mut answer = Writer::new(io::stdout().lock());
    does(&mut answer)?;
    answer.finish()
}

/// Reads which step is asked for.
fn named(asked: &mut Reader<impl Read>) -> io::Result<Step> {
    let mut length = [0];
    asked.read_exact(&mut length)?;
    let [length] = length;
    let mut bytes = vec![0; length.min(LONGEST_NAME).into()];
    asked.read_exact(&mut bytes)?;
    let found = STEPS.into_iter().find(|(step, _)| name(step).as_bytes() == bytes);
    found.map(|(_, step)| step).ok_or_else(|| io::ErrorKind::Unsupported.into())
}
