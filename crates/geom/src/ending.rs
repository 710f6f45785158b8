//! Work that somebody may end while it is in the middle of a step that knows nothing of that.
//!
//! [`Ended::run`] does work on threads of its own. Whatever runs there, however deep, asks by [`go_on`]: where the work was ended, that does
//! not return but unwinds to `run`, which answers `None`. Everything on the way is dropped as it is when a function returns; no hook
//! of panics is called, and nothing is printed. On all other threads [`go_on`] does nothing.
//!
//! A long step that cannot ask, since it is the work of a library, is given to a [`Helper`] where the owner of the work has one: it does the step
//! in another process, which is killed where the work is ended ([`helped`]).
//!
//! ```
//! use toolpost_geom::ending::{Ended, go_on};
//!
//! let ended = Ended::default();
//! assert_eq!(ended.run(|| 6 * 7), Some(42));
//! ended.end();
//! assert_eq!(ended.run(|| loop { go_on() }), None::<()>);
//! go_on();
//! ```

use rayon::ThreadPoolBuilder;
use std::cell::OnceCell;
use std::fmt::Debug;
use std::io::{self, Read, Write};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

thread_local! {
    /// The work that this thread belongs to.
    static OWN: OnceCell<Ended> = const { OnceCell::new() };
}

/// Whether work shall end, for who does it and who ends it; and who helps to do it.
#[derive(Clone, Debug, Default)]
pub struct Ended {
    flag: Arc<AtomicBool>,
    helper: Option<Arc<dyn Helper>>,
}

/// Does steps of work in another process. A step is a function of bytes, which answers the same in each process.
pub trait Helper: Debug + Send + Sync {
    /// Has the step of this name do what is `asked`, and `take` read all of its answer. Whether that was done; if not, nothing of what was taken counts. Returns
    /// within some milliseconds where the work of this thread is ended meanwhile.
    fn help(&self, step: &'static str, asked: &[u8], take: &mut Take<'_>) -> bool;
}

/// Reads an answer.
pub type Take<'a> = dyn FnMut(&mut dyn Read) -> io::Result<()> + Send + 'a;

/// A step as the helping process has it: it reads all that is asked, bounded in memory whatever that says, and answers what will do it.
pub type Step = fn(&mut dyn Read) -> io::Result<Does>;

/// Does a step and writes its answer.
pub type Does = Box<dyn FnOnce(&mut dyn Write) -> io::Result<()>>;

/// What work unwinds with.
struct Unwound;

impl Ended {
    /// Ends it.
    pub fn end(&self) {
        self.flag.store(true, Ordering::Relaxed);
    }

    /// Whether it was ended.
    pub fn is_ended(&self) -> bool {
        self.flag.load(Ordering::Relaxed)
    }

    /// The same work, with somebody who helps to do it.
    pub fn with_helper(&self, helper: Option<Arc<dyn Helper>>) -> Ended {
        Ended { flag: Arc::clone(&self.flag), helper }
    }

    /// Does `work` on threads of its own, as many as all parallel work here takes; `None` where it was ended meanwhile. Where the system gives no
    /// threads, it is done here, and ends only where it asks for itself.
    pub fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> Option<T> {
        let belongs = self.clone();
        let threads = ThreadPoolBuilder::new().start_handler(move |_| {
            OWN.with(|own| _ = own.set(belongs.clone()));
        });
        let done = match threads.build() {
            Ok(threads) => catch_unwind(AssertUnwindSafe(|| threads.install(work))),
            Err(_) => catch_unwind(AssertUnwindSafe(work)),
        };
        match done {
            Ok(done) => Some(done),
            Err(unwound) if unwound.is::<Unwound>() => None,
            Err(panic) => resume_unwind(panic),
        }
    }
}

/// The same work for a thread that is begun for it: what it does there belongs to the work of this thread, and ends with it.
pub fn carried<T>(work: impl FnOnce() -> T) -> impl FnOnce() -> T {
    let belongs = OWN.with(|own| own.get().cloned());
    move || {
        if let Some(belongs) = belongs {
            OWN.with(|own| _ = own.set(belongs));
        }
        work()
    }
}

/// Whether the work that this thread belongs to was ended. Parallel work of many small pieces answers anything then, and asks by [`go_on`] behind all of them: each
/// piece that unwinds takes longer than it does.
#[inline]
pub fn is_ended() -> bool {
    OWN.with(|own| own.get().is_some_and(Ended::is_ended))
}

/// Who helps with the work that this thread belongs to.
fn helper() -> Option<Arc<dyn Helper>> {
    OWN.with(|own| own.get()?.helper.clone())
}

/// Whether anybody helps with the work that this thread belongs to.
pub fn has_helper() -> bool {
    helper().is_some()
}

/// What the helper of this work answers to a step, where there is one and it could be asked; otherwise the step is to be done here. Unwinds where the work was
/// ended. It is for steps of 10 ms and more that do not ask by [`go_on`]: to start the process takes some milliseconds.
pub fn helped<T: Send>(
    step: &'static str,
    asked: impl FnOnce() -> Vec<u8>,
    read: impl Fn(&mut dyn Read) -> io::Result<T> + Sync,
) -> Option<T> {
    let helper = helper()?;
    let mut answer = None;
    let is_done = helper.help(step, &asked(), &mut |from| {
        answer = Some(read(from)?);
        Ok(())
    });
    go_on();
    answer.filter(|_| is_done)
}

/// Unwinds where the work that this thread belongs to was ended. It takes some nanoseconds: a step asks every few microseconds or oftener.
#[inline]
pub fn go_on() {
    if is_ended() {
        unwind();
    }
}

#[cold]
fn unwind() {
    // Within a destructor that runs meanwhile, another one would end the process.
    if !std::thread::panicking() {
        resume_unwind(Box::new(Unwound));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;
    use std::sync::mpsc::channel;
    use std::thread;

    #[test]
    fn work_on_all_threads_unwinds_and_is_dropped() {
        struct Tells(std::sync::mpsc::Sender<()>);
        impl Drop for Tells {
            fn drop(&mut self) {
                self.0.send(()).unwrap();
            }
        }
        let (ended, (begins, begun), (tells, told)) = (Ended::default(), channel(), channel());
        let other = ended.clone();
        let work = thread::spawn(move || {
            other.run(|| {
                let _held = Tells(tells);
                begins.send(()).unwrap();
                (0..64).into_par_iter().for_each(|_| {
                    loop {
                        go_on();
                    }
                });
            })
        });
        begun.recv().unwrap();
        ended.end();
        assert!(work.join().unwrap().is_none());
        told.try_recv().unwrap();
        let begun = other_thread(&ended);
        assert!(begun.is_none());
        // The threads of others go on.
        assert_eq!(
            Ended::default().run(|| (0..64).into_par_iter().map(|_| go_on()).count()),
            Some(64)
        );
    }

    /// What is done on a thread that work begins.
    fn other_thread(ended: &Ended) -> Option<()> {
        ended.run(|| {
            thread::scope(|scope| match scope.spawn(carried(go_on)).join() {
                Ok(()) => (),
                Err(unwound) => resume_unwind(unwound),
            })
        })
    }

    #[test]
    fn a_panic_is_no_ending() {
        let panics = catch_unwind(|| Ended::default().run(|| resume_unwind(Box::new("other"))));
        assert_eq!(panics.map(|_: Option<()>| ()).unwrap_err().downcast_ref(), Some(&"other"));
    }
}
