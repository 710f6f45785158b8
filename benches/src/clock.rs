//! Time that this thread, or a program that it has run, has had on a processor, so that other work on the machine does not count.

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

/// The same for the programs that this one has run to their end; none where the system does not tell.
/// Linux counts it in hundredths of a second, in fields 16 and 17.
pub fn children() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    let (_, fields) = text.rsplit_once(')')?;
    let fields: Vec<i64> = fields.split_whitespace().filter_map(|f| f.parse().ok()).collect();
    // The third field is a letter.
    let ticks = fields.get(12)? + fields.get(13)?;
    Some(Duration::from_millis(u64::try_from(ticks).ok()? * 10))
}
