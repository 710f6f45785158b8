//! Batches on their way from one thread to another. They come back to be filled again: fresh memory costs more
//! than what most of them are filled with.

use std::sync::mpsc::{self, Receiver, Sender, SyncSender};

/// Batches that wait at most: who fills them faster than they are taken waits, and memory stays bounded.
const WAITING: usize = 4;

/// The two ends of a queue: where batches are put in, and where they are taken out.
pub(crate) fn bounded<T>() -> (QueueSender<T>, QueueReceiver<T>) {
    let (full, taken) = mpsc::sync_channel(WAITING);
    let (back, empty) = mpsc::channel();
    (QueueSender { full, empty }, QueueReceiver { full: taken, back })
}

/// Where batches are laid on.
#[derive(Debug)]
pub(crate) struct QueueSender<T> {
    full: SyncSender<T>,
    empty: Receiver<T>,
}

/// Where batches are taken.
#[derive(Debug)]
pub(crate) struct QueueReceiver<T> {
    full: Receiver<T>,
    back: Sender<T>,
}

impl<T: Default> QueueSender<T> {
    /// Lays a batch on and gives an empty one for it; `None` where nobody takes batches any more.
    pub(crate) fn lay(&self, batch: T) -> Option<T> {
        self.full.send(batch).ok()?;
        Some(self.empty.try_recv().unwrap_or_default())
    }
}

impl<T> QueueReceiver<T> {
    /// The next batch; `None` behind the last.
    pub(crate) fn take(&self) -> Option<T> {
        self.full.recv().ok()
    }

    /// An empty one goes back.
    pub(crate) fn give_back(&self, batch: T) {
        // Where nobody fills it again, there is nothing to come.
        let _ = self.back.send(batch);
    }
}
