//! Memory that work has used goes back to the system when there has been none for a while.

use super::Studio;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// How long there is no work until memory is given back: work that follows sooner uses it again, which is faster.
const IDLE: Duration = Duration::from_secs(3);

/// How many runs have begun, and how many are over.
#[derive(Debug, Default)]
pub struct Runs {
    begun: AtomicU64,
    over: AtomicU64,
}

impl Runs {
    /// Another one has begun.
    pub fn begin(&self) {
        self.begun.fetch_add(1, Ordering::Relaxed);
    }

    /// One is over.
    pub fn end(&self) {
        self.over.fetch_add(1, Ordering::Relaxed);
    }

    /// How many there were, where none goes on.
    fn ended(&self) -> Option<u64> {
        let over = self.over.load(Ordering::Relaxed);
        (self.begun.load(Ordering::Relaxed) == over).then_some(over)
    }
}

/// Gives memory back each time that there is no work any more.
pub async fn give_back(studio: Arc<Studio>) -> ! {
    let (mut given, mut before) = (Some(0), Some(0));
    loop {
        tokio::time::sleep(IDLE).await;
        let now = studio.runs.ended();
        if now.is_some() && now == before && now != given {
            given = now;
            let _ = tokio::task::spawn_blocking(trim).await;
        }
        before = now;
    }
}

/// glibc keeps what is freed, for each thread and up to all that there was at once: half a gigabyte behind a large board of which nothing is kept. Other
/// allocators give it back by themselves.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[expect(unsafe_code, reason = "the C library offers it to everybody, and Rust only so")]
fn trim() {
    // SAFETY: malloc_trim(3) may be called at any time, from any thread; it takes no pointer.
    let _ = unsafe { libc::malloc_trim(0) };
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn trim() {}
