//! What is being done, for who waits: on the error stream, on a terminal only, after a second.

use app::Watch;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

/// How long a job may take without a word.
const PATIENCE: Duration = Duration::from_secs(1);

/// The bar of a job of several steps; it goes when it is dropped.
pub struct Progress {
    bar: ProgressBar,
    /// Hanging up tells the waiting thread that the job is over.
    _alive: Sender<()>,
}

impl Progress {
    /// A job of so many steps; with `silent` it never shows.
    pub fn new(steps: u64, silent: bool) -> Progress {
        let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{bar:24} {pos}/{len} {msg} {elapsed}") {
            bar.set_style(style);
        }
        let (alive, over) = mpsc::channel();
        if !silent {
            let bar = bar.clone();
            thread::spawn(move || {
                if over.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                    bar.enable_steady_tick(Duration::from_millis(200));
                }
            });
        }
        Progress { bar, _alive: alive }
    }
}

impl Watch for Progress {
    fn step(&self, what: &'static str) {
        if !self.bar.message().is_empty() {
            self.bar.inc(1);
        }
        self.bar.set_message(what);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
