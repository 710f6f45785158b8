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

impl Open {
    /// Takes out the oldest that are too many beside one that takes so many bytes and is not kept yet; where there is none such, the newest stays.
    fn surplus(&mut self, bytes: usize) -> Vec<(u64, Vec<Arc<Job>>)> {
        let size = |(_, jobs): &(u64, Vec<Arc<Job>>)| jobs.iter().map(|job| job.bytes()).sum();
        let sizes: Vec<usize> = self.works.iter().map(size).collect();
        self.works.drain(..surplus(&sizes, bytes)).collect()
    }
}

/// How many of the works of these sizes, bytes, the oldest first, are too many beside one that takes `more` bytes.
fn surplus(sizes: &[usize], more: usize) -> usize {
    let newest = if more > 0 { sizes.len() } else { sizes.len().saturating_sub(1) };
    let is_enough = |gone: &usize| {
        let bytes = sizes[*gone..].iter().fold(more, |sum, size| sum.saturating_add(*size));
        sizes.len() - gone <= MOST_JOBS && bytes <= MOST_BYTES
    };
    (0..newest).find(is_enough).unwrap_or(newest)
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
        let old = open.surplus(0);
        // Giving back their memory takes long: nobody waits for it.
        drop(open);
        drop(old);
        first
    }

    /// Makes place for a work that is being made and takes so many bytes meanwhile: the oldest go, all of them where it has to be.
    pub fn make_room(&self, bytes: usize) {
        let mut open = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let old = open.surplus(bytes);
        drop(open);
        drop(old);
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

#[cfg(test)]
mod tests {
    use super::*;

    const GB: usize = 1 << 30;

    #[test]
    fn the_oldest_go_where_there_are_too_many_or_too_large_ones() {
        assert_eq!(surplus(&[], 0), 0);
        assert_eq!(surplus(&[1; 8], 0), 0);
        assert_eq!(surplus(&[1; 9], 0), 1);
        assert_eq!(surplus(&[GB, GB, 2 * GB], 0), 1);
        // One that is larger than all that there is room for stays as long as it is the newest.
        assert_eq!(surplus(&[GB, 4 * GB], 0), 1);
    }

    #[test]
    fn what_is_being_made_needs_a_place_beside_them() {
        assert_eq!(surplus(&[GB, GB], GB), 0);
        assert_eq!(surplus(&[GB, GB], 2 * GB), 1);
        assert_eq!(surplus(&[GB, GB], 3 * GB), 2);
        assert_eq!(surplus(&[GB, GB], usize::MAX), 2);
        assert_eq!(surplus(&[], 4 * GB), 0);
    }
}
