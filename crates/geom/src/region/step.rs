//! A boolean as a step of a [helper](crate::ending::Helper): its operands as bytes, and its result.
//!
//! All numbers are little-endian. An element is a byte that says whether it is an arc, its ends, and of an arc centre and angle; a chain is the
//! count of its elements and these. Asked is by a byte each what is kept and how is filled, and of each operand the count of its chains and these. The
//! answer is 1 and the most crossings where there are more, or 0, the count of the islands, and of each the count of its rings and these, as chains.

use super::chords::boolean;
use super::kernel::Keep;
use super::{FAR, Fill, Island, Region, RegionError, Ring};
use crate::ending::{self, Does, Step, go_on};
use crate::{Element, Turn, Vec2};
use std::io::{self, Read};
use std::iter;

/// The boolean of regions, for a helper: its name and what it does.
pub const STEP: (&str, Step) = ("region", read);

/// As they are numbered.
const KEEPS: [Keep; 4] = [Keep::Union, Keep::Intersection, Keep::Difference, Keep::Xor];
const FILLS: [Fill; 3] = [Fill::EvenOdd, Fill::NonZero, Fill::Positive];

/// The greatest coordinate, mm, and angle, radians.
const MOST_VALUE: f64 = 10.0 * FAR;

/// So many of a list have room before they have come.
const ROOM: usize = 1024;

/// The boolean, by the helper of this work; none where nobody helps.
pub(super) fn helped<'a>(
    first: impl Iterator<Item = &'a [Element]> + Clone,
    second: impl Iterator<Item = &'a [Element]> + Clone,
    keep: Keep,
    fill: Fill,
) -> Option<Result<Region, RegionError>> {
    ending::helped(STEP.0, || asked(first, second, keep, fill), answer)
}

fn asked<'a>(
    first: impl Iterator<Item = &'a [Element]> + Clone,
    second: impl Iterator<Item = &'a [Element]> + Clone,
    keep: Keep,
    fill: Fill,
) -> Vec<u8> {
    let keep = KEEPS.iter().take_while(|other| **other != keep).count();
    let fill = FILLS.iter().take_while(|other| **other != fill).count();
    let mut bytes = vec![keep as u8, fill as u8];
    put_chains(&mut bytes, first);
    put_chains(&mut bytes, second);
    bytes
}

/// Reads what is asked, and answers what will do it.
fn read(from: &mut dyn Read) -> io::Result<Does> {
    let [keep, fill] = array(from)?;
    let keep = KEEPS.get(usize::from(keep)).copied().ok_or_else(wrong)?;
    let fill = FILLS.get(usize::from(fill)).copied().ok_or_else(wrong)?;
    let [first, second] = [chains(from)?, chains(from)?];
    Ok(Box::new(move |to| {
        let [first, second] = [&first, &second].map(|chains| chains.iter().map(Vec::as_slice));
        let region = match boolean(first, second, keep, fill) {
            Ok(region) => region,
            Err(RegionError::TooTangled { most }) => {
                let mut bytes = vec![1];
                put_count(&mut bytes, most);
                return to.write_all(&bytes);
            }
            // What is too large is not asked for.
            Err(_) => return Err(wrong()),
        };
        let mut bytes = vec![0];
        put_count(&mut bytes, region.islands.len());
        for island in &region.islands {
            let rings = iter::once(&island.outer).chain(&island.holes);
            put_chains(&mut bytes, rings.map(Ring::elements));
            to.write_all(&bytes)?;
            bytes.clear();
        }
        to.write_all(&bytes)
    }))
}

/// Reads the answer.
fn answer(from: &mut dyn Read) -> io::Result<Result<Region, RegionError>> {
    match array(from)? {
        [0] => {}
        [1] => return Ok(Err(RegionError::TooTangled { most: number(from)? })),
        _ => return Err(wrong()),
    }
    let islands = number(from)?;
    let island = |from: &mut dyn Read| {
        let mut rings = chains(from)?.into_iter().map(|elements| Ring { elements });
        Ok(Island { outer: rings.next().ok_or_else(wrong)?, holes: rings.collect() })
    };
    Ok(Ok(Region { islands: list(from, islands, island)? }))
}

fn put_count(bytes: &mut Vec<u8>, count: usize) {
    // There are no more of anything than edges.
    bytes.extend((count as u32).to_le_bytes());
}

fn put_chains<'a>(bytes: &mut Vec<u8>, chains: impl Iterator<Item = &'a [Element]> + Clone) {
    put_count(bytes, chains.clone().count());
    for chain in chains {
        go_on();
        put_count(bytes, chain.len());
        for Element { start, end, turn } in chain {
            bytes.push(u8::from(turn.is_some()));
            let ends = [start.x, start.y, end.x, end.y];
            let turn = turn.map(|Turn { center, sweep }| [center.x, center.y, sweep]);
            let values = ends.into_iter().chain(turn.into_iter().flatten());
            bytes.extend(values.flat_map(f64::to_le_bytes));
        }
    }
}

fn chains(from: &mut dyn Read) -> io::Result<Vec<Vec<Element>>> {
    let count = number(from)?;
    list(from, count, |from| {
        let count = number(from)?;
        list(from, count, element)
    })
}

fn element(from: &mut dyn Read) -> io::Result<Element> {
    let [is_arc] = array(from)?;
    let [x, y, to_x, to_y] = values(from)?;
    let turn = match is_arc {
        0 => None,
        1 => {
            let [x, y, sweep] = values(from)?;
            Some(Turn { center: Vec2::new(x, y), sweep })
        }
        _ => return Err(wrong()),
    };
    Ok(Element { start: Vec2::new(x, y), end: Vec2::new(to_x, to_y), turn })
}

/// A list of so many, of which memory is taken as they come.
fn list<T>(
    from: &mut dyn Read,
    count: usize,
    mut read: impl FnMut(&mut dyn Read) -> io::Result<T>,
) -> io::Result<Vec<T>> {
    let mut list = Vec::with_capacity(count.min(ROOM));
    for _ in 0..count {
        list.push(read(from)?);
    }
    Ok(list)
}

fn number(from: &mut dyn Read) -> io::Result<usize> {
    Ok(u32::from_le_bytes(array(from)?) as usize)
}

/// Numbers, none of which is beyond what regions and their offsets have.
fn values<const N: usize>(from: &mut dyn Read) -> io::Result<[f64; N]> {
    let mut values = [0.0; N];
    for value in &mut values {
        *value = f64::from_le_bytes(array(from)?);
        if value.is_nan() || value.abs() > MOST_VALUE {
            return Err(wrong());
        }
    }
    Ok(values)
}

fn array<const N: usize>(from: &mut dyn Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    from.read_exact(&mut bytes)?;
    Ok(bytes)
}

/// What nobody here has written.
fn wrong() -> io::Error {
    io::ErrorKind::InvalidData.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ending::{Ended, Helper, Take};
    use crate::region::Cap;
    use proptest::prelude::*;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::thread;

    /// Does steps in this process, and counts them.
    #[derive(Debug, Default)]
    struct Here(AtomicUsize);

    impl Helper for Here {
        fn help(&self, step: &'static str, asked: &[u8], take: &mut Take<'_>) -> bool {
            assert_eq!(step, STEP.0);
            self.0.fetch_add(1, Ordering::Relaxed);
            let (mut asked, mut answer) = (asked, Vec::new());
            // On a thread of nobody's work, as in another process.
            let does = || STEP.1(&mut asked).unwrap()(&mut answer).unwrap();
            thread::scope(|scope| scope.spawn(does).join()).unwrap();
            let mut answer = answer.as_slice();
            take(&mut answer).unwrap();
            asked.is_empty() && answer.is_empty()
        }
    }

    /// Discs, strokes and rings on a coarse grid, so that they touch and lie on each other.
    fn shape() -> impl Strategy<Value = Region> {
        let at = || (0..12i32, 0..12i32).prop_map(|(x, y)| Vec2::new(x.into(), y.into()) * 0.5);
        let width = || (1..6i32).prop_map(|width| f64::from(width) * 0.4);
        prop_oneof![
            (at(), width()).prop_map(|(at, width)| Region::disc(at, width).unwrap()),
            (at(), at(), width()).prop_filter_map("a dot", |(from, to, width)| {
                Region::stroke(&Element::line(from, to), width, Cap::Square).ok()
            }),
            (at(), -6.0..6.0, width()).prop_filter_map("no arc", |(at, sweep, width)| {
                let end = Vec2::from_angle(sweep).rotate(Vec2::X) + at;
                let arc = Element::arc(at + Vec2::X, end, at, sweep);
                Region::stroke(&arc, width, Cap::Round).ok()
            }),
        ]
    }

    fn chains(regions: &[Region]) -> impl Iterator<Item = &[Element]> + Clone {
        regions.iter().flat_map(Region::chains)
    }

    proptest! {
        #[test]
        fn a_helper_answers_the_same_bits(
            first in prop::collection::vec(shape(), 0..12),
            second in prop::collection::vec(shape(), 0..6),
            keep in prop::sample::select(&KEEPS[..]),
            fill in prop::sample::select(&FILLS[..]),
        ) {
            let (one, two) = (|| chains(&first), || chains(&second));
            let here = boolean(one(), two(), keep, fill);
            let work = Ended::default().with_helper(Some(Arc::new(Here::default())));
            let apart = work.run(|| helped(one(), two(), keep, fill)).unwrap().unwrap();
            // Zeros have signs.
            prop_assert_eq!(format!("{here:?}"), format!("{apart:?}"));
        }

        #[test]
        fn what_nobody_has_asked_is_refused_or_done(
            regions in prop::collection::vec(shape(), 1..4),
            places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
            end in any::<prop::sample::Index>(),
            is_cut in any::<bool>(),
        ) {
            let mut bytes = asked(chains(&regions), chains(&regions[1..]), Keep::Xor, Fill::NonZero);
            for (place, byte) in places {
                *place.get_mut(&mut bytes) = byte;
            }
            if is_cut {
                bytes.truncate(end.index(bytes.len()));
            }
            if let Ok(does) = read(&mut bytes.as_slice()) {
                let mut answered = Vec::new();
                does(&mut answered).unwrap();
                let _: Result<Region, RegionError> = answer(&mut answered.as_slice()).unwrap();
            }
            let _ = answer(&mut bytes.as_slice());
        }
    }

    #[test]
    fn only_long_work_is_helped_with() {
        let discs = |count: i32| -> Vec<Region> {
            let disc = |i: i32| Region::disc(Vec2::new((3 * i).into(), 0.0), 1.0).unwrap();
            (0..count).map(disc).collect()
        };
        let helper = Arc::new(Here::default());
        let work = Ended::default().with_helper(Some(helper.clone()));
        let united = |count: i32| work.run(|| Region::union_of(&discs(count)).unwrap()).unwrap();
        assert_eq!(united(20).islands().len(), 20);
        assert_eq!(helper.0.load(Ordering::Relaxed), 0);
        assert_eq!(united(2000), Region::union_of(&discs(2000)).unwrap());
        assert_eq!(helper.0.load(Ordering::Relaxed), 1);
        // Few strokes with many crossings.
        let stroke = |i: i32| {
            let at = f64::from(i % 100);
            let (from, to) = (Vec2::new(at, -1.0), Vec2::new(at, 101.0));
            let turned = |place: Vec2| if i < 100 { place } else { Vec2::new(place.y, place.x) };
            Region::stroke(&Element::line(turned(from), turned(to)), 0.1, Cap::Square).unwrap()
        };
        let strokes: Vec<Region> = (0..200).map(stroke).collect();
        let net = work.run(|| Region::union_of(&strokes).unwrap()).unwrap();
        assert_eq!((net.islands().len(), net.islands()[0].holes().len()), (1, 99 * 99));
        assert_eq!(helper.0.load(Ordering::Relaxed), 2);
        // Why there is none.
        let tangle: Vec<Element> = (0..3000)
            .map(|i| Vec2::from_angle(f64::from(i * 1499) / 3000.0 * std::f64::consts::TAU))
            .collect::<Vec<_>>()
            .windows(2)
            .map(|ends| Element::line(ends[0], ends[1]))
            .collect();
        let star = [tangle.as_slice()];
        let made = work.run(|| helped(star.into_iter(), [].into_iter(), KEEPS[0], FILLS[0]));
        assert_eq!(made.unwrap(), Some(Err(RegionError::TooTangled { most: 1 << 20 })));
    }
}
