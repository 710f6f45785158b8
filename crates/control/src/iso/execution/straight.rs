//! A straight move behind a block that only moved: all that it says is where the tool goes.
//!
//! Most of a long program is that, and most of what a [`Step`](super::step::Step) asks of a block has one answer for
//! all of them: the modes that answer it are looked at once, behind the block before them.

use super::motion::LINEAR;
use super::state::State;
use super::step::Control;
use crate::WholeNumbers;
use crate::event::Action;
use crate::iso::language::block::{Block, Word};
use crate::iso::language::words::{Motion, bit, index};

/// What holds from one straight move to the next.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StraightContinuation {
    /// mm in the unit of length.
    unit: f64,
    /// The F that is in effect, where the block before has it.
    feed: Option<Word>,
}

impl StraightContinuation {
    /// What holds behind `block`, which has been executed; `None` where straight moves behind it are not simple.
    pub(crate) fn behind(block: &Block, state: &State) -> Option<StraightContinuation> {
        let unit = match state.inches? {
            true => geom::INCH,
            false => 1.0,
        };
        let goes = block.only_moves() && state.moves_straight(block.facts);
        // F of a CAM system next to a rapid is none of the moves behind it, and that of FANUC next to G33 is a pitch.
        let cuts = matches!(state.motion, Some(Motion::Line | Motion::Arc { .. }));
        let feed = (cuts && block.gives(b'F')).then(|| block.words[index(b'F')]);
        goes.then_some(StraightContinuation { unit, feed })
    }
}

impl Control {
    /// Executes a block of these words where it is a straight move behind another one, as `continuation` holds it, as
    /// [`Control::execute`] would. `None` where it is not: nothing has changed.
    pub(crate) fn go_on(
        &mut self,
        continuation: &StraightContinuation,
        words: &[Word],
    ) -> Option<Action> {
        let state = &mut self.state;
        let (mut motion, mut point) = (state.motion?, state.position);
        let mut given = 0;
        for word in words {
            let letter = bit(word.letter);
            let largest = self.facts.source.map_or(f64::INFINITY, |source| source.largest);
            if given & letter != 0 || word.value.abs() >= largest {
                return None;
            }
            match word.letter {
                b'G' if word.value == 1.0 => motion = Motion::Line,
                b'G' if word.value == 0.0 => motion = Motion::Rapid,
                b'X' | b'Y' | b'Z' => {
                    let counts_units = word.point || self.whole_numbers == WholeNumbers::Units;
                    if !counts_units && word.value != 0.0 {
                        return None;
                    }
                    // Not -0.
                    point[usize::from(word.letter - b'X')] = word.value * continuation.unit + 0.0;
                }
                b'F' if continuation.feed.is_some_and(|feed| feed.says_the_same_as(word)) => {}
                b'N' if given == 0 && !word.point && word.value >= 0.0 => {}
                _ => return None,
            }
            given |= letter;
        }
        let moves = LINEAR.iter().any(|&letter| given & bit(letter) != 0);
        if !moves || !matches!(motion, Motion::Line | Motion::Rapid) {
            return None;
        }
        state.motion = Some(motion);
        state.arrive(point, state.rotary);
        let pose = state.pose(point, state.rotary);
        Some(if motion == Motion::Line { Action::Line(pose) } else { Action::Rapid(pose) })
    }
}
