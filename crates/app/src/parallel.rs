//! Two pieces of work at the same time.

use geom::ending::carried;
use std::{panic, thread};

/// What both answer: `work` on this thread, `other` meanwhile in one of its own.
pub(crate) fn parallel<A, B: Send>(
    work: impl FnOnce() -> A,
    other: impl FnOnce() -> B + Send,
) -> (A, B) {
    thread::scope(|scope| {
        let other = scope.spawn(carried(other));
        let done = work();
        (done, other.join().unwrap_or_else(|cause| panic::resume_unwind(cause)))
    })
}
