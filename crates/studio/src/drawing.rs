//! A walk is drawn while its proof runs: chunk by chunk, in a thread of its own.

use crate::geometry::{Exact, Geometry};
use geom::ending::Ended;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::JoinHandle;

/// How many chunks wait to be drawn; the proof waits with a further one.
const WAITING: usize = 8;

/// A chunk as it is shown while the proof runs.
#[derive(Debug)]
pub struct Piece {
    /// Its number.
    pub chunk: u32,
    /// How many moves there are with it.
    pub moves: u32,
    /// When the last one of them is over, s.
    pub seconds: f64,
    /// Its entry of the index, whose vertices of level 0 are those that follow.
    pub index: Vec<u8>,
    /// Its vertices.
    pub vertices: Vec<u8>,
}

/// What the thread is given.
enum Given {
    /// The next chunk.
    Next(Exact),
    /// A chunk again, whose marks are others now.
    Again(u32, Exact),
}

/// The thread, and the way there and back.
#[derive(Debug)]
pub struct Drawing {
    /// None once all is given.
    to: Option<SyncSender<Given>>,
    back: Receiver<Piece>,
    thread: Option<JoinHandle<Option<Geometry>>>,
}

impl Drawing {
    /// Begins a drawing in which each piece has `budget` vertices, where it can be made of so few.
    pub fn begin(budget: usize, ended: &Ended) -> Drawing {
        let (to, given) = sync_channel(WAITING);
        let (shown, back) = channel();
        let ended = ended.clone();
        let thread = std::thread::spawn(move || draw(&given, &shown, budget, &ended));
        Drawing { to: Some(to), back, thread: Some(thread) }
    }

    /// Gives the next chunk.
    pub fn next(&self, exact: Exact) {
        self.give(Given::Next(exact));
    }

    /// Gives a chunk again.
    pub fn again(&self, chunk: u32, exact: Exact) {
        self.give(Given::Again(chunk, exact));
    }

    fn give(&self, given: Given) {
        // The thread is gone only where the work is ended.
        let _ = self.to.as_ref().map(|to| to.send(given));
    }

    /// The pieces that have come back.
    pub fn pieces(&self) -> impl Iterator<Item = Piece> {
        self.back.try_iter()
    }

    /// Waits for the rest; nothing where the work was ended.
    pub fn finish(&mut self) -> Option<Geometry> {
        self.to = None;
        match self.thread.take()?.join() {
            Ok(geometry) => geometry,
            Err(panic) => std::panic::resume_unwind(panic),
        }
    }
}

fn draw(
    given: &Receiver<Given>,
    shown: &Sender<Piece>,
    budget: usize,
    ended: &Ended,
) -> Option<Geometry> {
    let mut geometry = Geometry::default();
    let mut goes_on = || !ended.is_ended();
    for given in given {
        match given {
            Given::Next(exact) => {
                let (number, first, seconds) = (geometry.chunks() as u32, exact.first, exact.end);
                let moves = first + exact.moves;
                geometry.add(exact, &mut goes_on)?;
                let piece = geometry.piece(number, budget);
                let (index, vertices) = (piece.entry(first), piece.octets());
                let _ = shown.send(Piece { chunk: number, moves, seconds, index, vertices });
            }
            Given::Again(number, exact) => geometry.again(number, exact, &mut goes_on)?,
        }
    }
    Some(geometry)
}
