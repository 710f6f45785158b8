//! Time that this thread has had on a processor, so that other work on the machine does not count.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// The time so far; wall time where the system does not tell.
pub fn now() -> Duration {
    static START: OnceLock<Instant> = OnceLock::new();
    on_processor().unwrap_or_else(|| START.get_or_init(Instant::now).elapsed())
}

/// Linux tells nanoseconds on a processor in the first field.
fn on_processor() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(Duration::from_nanos(text.split_whitespace().next()?.parse().ok()?))
}
