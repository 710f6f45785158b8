//! The works that are open, each with its jobs: so many, and no more memory than there is for them.

use crate::job::Job;
use program::{Diagnostic, Rule};
use std::sync::{Arc, Mutex, PoisonError};

/// How many works are open at the same time: a program, or all programs of a board.
pub const MOST_JOBS: usize = 8;

/// How much memory they take together, bytes.
const MOST_BYTES: usize = 3 << 30;

/// The works that are open. Where there are more, or they are larger than the studio has memory for, the oldest goes; the newest stays.
#[derive(Debug)]
pub struct Jobs(Mutex<Open>);

#[derive(Debug)]
struct Open {
    last: u64,
    /// The oldest first, each with the revision of its first job: those of the others follow.
    works: Vec<(u64, Vec<Arc<Job>>)>,
}

impl Jobs {
    /// None. Revisions are counted from a number of this server's own: those of another one at the same port are other numbers, whatever
    /// the browser has kept of them.
    pub fn new(own: u32) -> Jobs {
        Jobs(Mutex::new(Open { last: u64::from(own) << 16, works: Vec::new() }))
    }

    /// Keeps the jobs of a work, and answers the revision of the first; those of the others follow it.
    pub fn keep(&self, jobs: Vec<Arc<Job>>) -> u64 {
        let mut open = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let first = open.last + 1;
        open.last += jobs.len() as u64;
        open.works.push((first, jobs));
        let too_much = |works: &[(u64, Vec<Arc<Job>>)]| {
            let bytes: usize = works.iter().flat_map(|(_, jobs)| jobs).map(|job| job.bytes()).sum();
            works.len() > 1 && (works.len() > MOST_JOBS || bytes > MOST_BYTES)
        };
        let mut old = Vec::new();
        while too_much(&open.works) {
            old.push(open.works.remove(0));
        }
        // Giving back their memory takes long: nobody waits for it.
        drop(open);
        first
    }

    /// The job of a revision.
    ///
    /// # Errors
    /// It is not open any more.
    pub fn find(&self, revision: u64) -> Result<Arc<Job>, Box<Diagnostic>> {
        let open = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let of = |(first, jobs): &(u64, Vec<Arc<Job>>)| {
            let place = usize::try_from(revision.checked_sub(*first)?).ok()?;
            jobs.get(place).map(Arc::clone)
        };
        let job = open.works.iter().find_map(of).ok_or_else(|| {
            let message = format!("this program is not open any more: {MOST_JOBS} newer ones, or larger ones, have taken its place");
            Diagnostic::error(Rule::StudioLimit, message).help("post or prove it again")
        })?;
        Ok(job)
    }
}
