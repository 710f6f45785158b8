//! The jobs that are open: so many, and no more memory than there is for them.

use crate::job::Job;
use program::{Diagnostic, Rule};
use std::sync::{Arc, Mutex, PoisonError};

/// How many jobs are open at the same time.
pub const MOST_JOBS: usize = 8;

/// How much memory they take together, bytes.
const MOST_BYTES: usize = 3 << 30;

/// The jobs that are open. Where there are more, or they are larger than the studio has memory for, the oldest goes; the newest stays.
#[derive(Debug)]
pub struct Jobs(Mutex<Open>);

#[derive(Debug)]
struct Open {
    last: u64,
    /// The oldest first.
    jobs: Vec<(u64, Arc<Job>)>,
}

impl Jobs {
    /// None. Revisions are counted from a number of this server's own: those of another one at the same port are other numbers, whatever
    /// the browser has kept of them.
    pub fn new(own: u32) -> Jobs {
        Jobs(Mutex::new(Open { last: u64::from(own) << 16, jobs: Vec::new() }))
    }

    /// Keeps a job, and answers its revision.
    pub fn keep(&self, job: Arc<Job>) -> u64 {
        let mut open = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        open.last += 1;
        let revision = open.last;
        open.jobs.push((revision, job));
        let too_much = |jobs: &[(u64, Arc<Job>)]| {
            let bytes: usize = jobs.iter().map(|(_, job)| job.bytes()).sum();
            jobs.len() > 1 && (jobs.len() > MOST_JOBS || bytes > MOST_BYTES)
        };
        while too_much(&open.jobs) {
            open.jobs.remove(0);
        }
        revision
    }

    /// The job of a revision.
    ///
    /// # Errors
    /// It is not open any more.
    pub fn find(&self, revision: u64) -> Result<Arc<Job>, Box<Diagnostic>> {
        let open = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let found = open.jobs.iter().find(|(of, _)| *of == revision);
        let job = found.map(|(_, job)| Arc::clone(job)).ok_or_else(|| {
            let message = format!("this program is not open any more: {MOST_JOBS} newer ones, or larger ones, have taken its place");
            Diagnostic::error(Rule::StudioLimit, message).help("post or prove it again")
        })?;
        Ok(job)
    }
}
