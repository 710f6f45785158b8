//! What work takes: processor time and wall.
//!
//! Processor time is that of all threads of the process together, including those that have ended. It counts work
//! alone, so other programs on the machine change it little; threads that work at the same time do not make it less.
//! Wall is what someone waits for. A figure has both, and is compared with both of the floor or of the peer.

use std::fmt;
use std::time::{Duration, Instant};

/// What work has taken.
#[derive(Clone, Copy, Debug)]
pub struct Taken {
    /// On processors, all threads together.
    pub processor: Duration,
    /// From its start to its end.
    pub wall: Duration,
}

impl Taken {
    /// More than any work takes.
    pub const MAX: Taken = Taken { processor: Duration::MAX, wall: Duration::MAX };

    /// The one of two rounds that counts: the faster one by wall, with its own processor time.
    pub fn faster(self, other: Taken) -> Taken {
        if other.wall < self.wall { other } else { self }
    }

    /// The least of both rounds, each by itself.
    pub fn least(self, other: Taken) -> Taken {
        Taken { processor: self.processor.min(other.processor), wall: self.wall.min(other.wall) }
    }

    /// What it takes beyond `other`.
    pub fn beyond(self, other: Taken) -> Taken {
        Taken {
            processor: self.processor.saturating_sub(other.processor),
            wall: self.wall.saturating_sub(other.wall),
        }
    }

    /// This divided by `other`: processor time by processor time, and wall by wall.
    pub fn times(self, other: Taken) -> Times {
        Times {
            processor: self.processor.as_secs_f64() / other.processor.as_secs_f64(),
            wall: self.wall.as_secs_f64() / other.wall.as_secs_f64(),
        }
    }

    /// The part of this that each of so many has.
    pub fn share(self, parts: u32) -> Taken {
        Taken { processor: self.processor / parts, wall: self.wall / parts }
    }
}

/// In seconds, with three decimals where the format names no other number.
impl fmt::Display for Taken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (decimals, processor) = (f.precision().unwrap_or(3), self.processor.as_secs_f64());
        let wall = self.wall.as_secs_f64();
        write!(f, "{processor:.decimals$} s of processor time, {wall:.decimals$} s of wall")
    }
}

/// What one thing takes, divided by what another takes.
#[derive(Clone, Copy, Debug)]
pub struct Times {
    pub processor: f64,
    pub wall: f64,
}

/// With one decimal where the format names no other number.
impl fmt::Display for Times {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (decimals, Times { processor, wall }) = (f.precision().unwrap_or(1), self);
        write!(f, "{processor:.decimals$} (processor time), {wall:.decimals$} (wall)")
    }
}

/// Does `work` in this process, and tells what it took. Its threads have to end, or to rest, with it.
pub fn time<T>(work: impl FnOnce() -> T) -> (T, Taken) {
    timed(system::process, work)
}

/// Does `work`, which runs other programs to their end, and tells what those took.
pub fn time_children<T>(work: impl FnOnce() -> T) -> (T, Taken) {
    timed(system::children, work)
}

fn timed<T>(processor: fn() -> Duration, work: impl FnOnce() -> T) -> (T, Taken) {
    let (before, start) = (processor(), Instant::now());
    let result = work();
    let wall = start.elapsed();
    (result, Taken { processor: processor().saturating_sub(before), wall })
}

/// What a Unix system accounts.
#[cfg(unix)]
mod system {
    use nix::sys::resource::{UsageWho, getrusage};
    use nix::sys::time::TimeValLike;
    use std::time::Duration;

    /// To all threads of this process.
    pub fn process() -> Duration {
        of(UsageWho::RUSAGE_SELF)
    }

    /// To the programs that this process has run to their end.
    pub fn children() -> Duration {
        of(UsageWho::RUSAGE_CHILDREN)
    }

    /// The user's part and the kernel's. A call that fails counts nothing, which `outside` finds.
    pub fn of(who: UsageWho) -> Duration {
        let sum = getrusage(who).map(|usage| usage.user_time() + usage.system_time());
        let micros = sum.map_or(0, |time| time.num_microseconds());
        Duration::from_micros(u64::try_from(micros).unwrap_or(0))
    }
}

/// Elsewhere no processor time is known; it counts as none, which `outside` refuses.
#[cfg(not(unix))]
mod system {
    use std::time::Duration;

    pub fn process() -> Duration {
        Duration::ZERO
    }

    pub fn children() -> Duration {
        Duration::ZERO
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use nix::sys::resource::UsageWho;
    use std::process::{Command, Stdio};
    use std::sync::mpsc::channel;
    use std::thread;

    /// Processor time that a thread of these tests uses, by its own account.
    const WORK: Duration = Duration::from_millis(60);

    /// Both threads, less what the system's account is behind.
    const BOTH: Duration = Duration::from_millis(2 * 60 - 2);

    fn work() {
        let thread = || system::of(UsageWho::RUSAGE_THREAD);
        let start = thread();
        while thread() - start < WORK {
            std::hint::black_box((0..10_000u64).fold(0, |sum, i| sum ^ std::hint::black_box(i)));
        }
    }

    #[test]
    fn threads_that_are_joined_are_counted() {
        let ((), taken) = time(|| {
            thread::scope(|scope| {
                scope.spawn(work);
                scope.spawn(work);
            });
        });
        assert!(taken.processor >= BOTH, "{taken}");
    }

    #[test]
    fn threads_that_nobody_has_joined_are_counted() {
        let (done, ends) = channel();
        let ((), taken) = time(|| {
            for done in [done.clone(), done] {
                thread::spawn(move || {
                    work();
                    // The end of the test is the only reader.
                    let _ = done.send(());
                });
            }
            assert_eq!(ends.iter().count(), 2);
        });
        assert!(taken.processor >= BOTH, "{taken}");
    }

    #[test]
    fn threads_that_rest_are_counted() {
        let (go, asked) = channel::<()>();
        let (done, worked) = channel();
        // Each time it is asked, until nobody can ask any more.
        let resting = thread::spawn(move || {
            for () in asked {
                work();
                done.send(()).unwrap();
            }
        });
        let ((), taken) = time(|| {
            go.send(()).unwrap();
            work();
            worked.recv().unwrap();
        });
        drop(go);
        resting.join().unwrap();
        assert!(taken.processor >= BOTH, "{taken}");
    }

    #[test]
    fn a_program_that_has_ended_is_counted_as_such() {
        let (status, taken) = time_children(|| {
            let count = "i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done";
            Command::new("sh").args(["-c", count]).stdin(Stdio::null()).status()
        });
        assert!(status.unwrap().success());
        assert!(taken.processor > Duration::from_millis(10), "{taken}");
        assert!(taken.processor <= taken.wall + Duration::from_millis(2), "{taken}");
    }

    #[test]
    fn the_faster_round_by_wall_counts_with_its_own_processor_time() {
        let taken = |processor, wall| Taken {
            processor: Duration::from_secs(processor),
            wall: Duration::from_secs(wall),
        };
        let best = taken(4, 3).faster(taken(5, 2)).faster(taken(1, 6));
        assert_eq!(format!("{best:.1}"), "5.0 s of processor time, 2.0 s of wall");
        let times = best.times(taken(2, 4));
        assert_eq!(times.to_string(), "2.5 (processor time), 0.5 (wall)");
    }
}
