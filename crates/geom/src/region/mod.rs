//! Regions of the plane, bounded by lines and arcs: union, difference, intersection, offset.
//!
//! A [`Region`] is a set of [`Island`]s; an island is what is inside its outer [`Ring`] and outside its
//! holes. Regions are made of discs, strokes, polygons and rings, thousands at once, and everything that
//! is done to regions gives regions again, with arcs where arcs were.
//!
//! # How it is done
//!
//! ```text
//!  rings ──chords──▶ edges on a grid of 0.1 nm, ──kernel──▶ edges, each with ──refit──▶ rings
//!                    each with its line or circle           its line or circle
//! ```
//!
//! Arcs are cut into `chords`; the `kernel` does the boolean in whole numbers, which has no wrong
//! answer where edges lie on each other, circles touch and ends meet, as on a board they all do;
//! `refit` puts the arcs back. An `offset` is the union of what each element of the boundary sweeps,
//! in the same kernel. [`strokes`] makes the rings of a network of strokes, without the parts of them that
//! others cover; an [`Index`] finds what of a region is near a point.
//!
//! # What is promised
//!
//! - Ends of lines and arcs are kept to 0.1 nm, a step of the kernel's grid. Where two elements cross,
//!   the corner is where they do, to rounding, however flat; where only the lines or circles that they
//!   are pieces of would, it is where their chords do.
//! - Each operation adds less than 1 µm to what a boundary is off, and no arc gets longer than what it is
//!   made of. What is thinner than 1 µm may vanish, also where boundaries run next to each other, and arcs
//!   that come nearer to something than 1 µm may be joined with it, or not. Where they would cross it,
//!   they are left as chords, up to 0.9 µm from the arc; nothing else is. Where an arc does not reach
//!   the place that it must end in, a line of less than 1 µm leads there.
//! - What goes back on itself within 2 nm is no boundary: there are no slits or spikes of rounding.
//! - The rings of a region cross neither themselves nor each other, but by rounding (2 nm). They may
//!   touch in points; what is connected by a point alone is not connected.
//! - Outer rings run counter-clockwise, holes clockwise: the region is on the left of its boundary.
//! - The same regions in the same order give the same result, bit for bit, on any number of threads.
//! - Time and memory grow as n·log n of the elements, and with the number of places where they cross. An operation of more than 4 million chords is refused
//!   ([`RegionError::TooLarge`]); so is one in which more than a million crossings are more than 4 of each element ([`RegionError::TooTangled`]).
//!
//! The numbers behind this are constants: the chord's error in `chords`, the unit in `kernel`, what
//! counts as one place, line, circle or crossing in `refit` and `crossings`.

mod chords;
mod crossings;
mod index;
mod kernel;
mod offset;
mod refit;
mod ring;
mod shape;
mod step;
mod sweep;

pub use index::{Index, Nearest, Piece};
pub use ring::Ring;
pub use shape::Cap;
pub use step::STEP;
pub use sweep::strokes;

use crate::{Element, Transform, Vec2};
use chords::boolean;
use kernel::Keep;
use std::{fmt, iter};

/// The greatest coordinate or length that is taken, mm.
const FAR: f64 = 1e5;

/// What is inside some outer rings and outside their holes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Region {
    islands: Vec<Island>,
}

/// A connected piece of a region.
#[derive(Clone, Debug, PartialEq)]
pub struct Island {
    outer: Ring,
    holes: Vec<Ring>,
}

/// Which places rings enclose that overlap, or cross themselves, by how often they run around them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// An odd number of times.
    EvenOdd,
    /// More often in one direction than in the other.
    NonZero,
    /// More often counter-clockwise than clockwise.
    Positive,
}

/// Why there is no region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RegionError {
    /// A coordinate is no number, or beyond 100 m.
    NotAPlace(Vec2),
    /// A length (mm) is no number, not above zero, or beyond 100 m.
    NotALength(f64),
    /// An element ends where the next does not start.
    Gap {
        /// Index of the element.
        element: usize,
        /// How far apart they are, mm.
        gap: f64,
    },
    /// The ends of an arc are not where its centre and angle say.
    NotAnArc {
        /// Index of the element.
        element: usize,
        /// By how much, mm.
        off: f64,
    },
    /// More than 4 million chords.
    TooLarge {
        /// How many chords the lines and arcs become.
        edges: usize,
        /// How many are taken.
        most: usize,
    },
    /// More than a million crossings, and than 4 of each element.
    TooTangled {
        /// How many are taken.
        most: usize,
    },
}

impl fmt::Display for RegionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RegionError::NotAPlace(p) => {
                write!(f, "X {} Y {} is not a place within {FAR} mm", p.x, p.y)
            }
            RegionError::NotALength(length) => {
                write!(f, "{length} mm is not a length above 0 and up to {FAR} mm")
            }
            RegionError::Gap { element, gap } => {
                write!(f, "after element {} there is a gap of {gap} mm", element + 1)
            }
            RegionError::NotAnArc { element, off } => write!(
                f,
                "the ends of element {}, an arc, are {off} mm from where centre and angle say",
                element + 1
            ),
            RegionError::TooLarge { edges, most } => {
                write!(f, "{edges} straight edges of lines and arcs; {most} are the most")
            }
            RegionError::TooTangled { most } => {
                write!(f, "lines and arcs cross in more than {most} places")
            }
        }
    }
}

impl std::error::Error for RegionError {}

impl Region {
    /// What is in any of `regions`, each of which may be large or a single pad.
    ///
    /// # Errors
    /// [`RegionError::TooLarge`].
    pub fn union_of<'a, Regions>(regions: Regions) -> Result<Region, RegionError>
    where
        Regions: IntoIterator<Item = &'a Region, IntoIter: Clone>,
    {
        let chains = regions.into_iter().flat_map(Region::chains);
        boolean(chains, iter::empty(), Keep::Union, Fill::Positive)
    }

    /// What is in one of the two or both.
    ///
    /// # Errors
    /// [`RegionError::TooLarge`].
    pub fn union(&self, other: &Region) -> Result<Region, RegionError> {
        self.combined(other, Keep::Union)
    }

    /// What is in both.
    ///
    /// # Errors
    /// [`RegionError::TooLarge`].
    pub fn intersection(&self, other: &Region) -> Result<Region, RegionError> {
        self.combined(other, Keep::Intersection)
    }

    /// What is in this region and not in `other`.
    ///
    /// # Errors
    /// [`RegionError::TooLarge`].
    pub fn difference(&self, other: &Region) -> Result<Region, RegionError> {
        self.combined(other, Keep::Difference)
    }

    /// What is in one of the two alone.
    ///
    /// # Errors
    /// [`RegionError::TooLarge`].
    pub fn xor(&self, other: &Region) -> Result<Region, RegionError> {
        self.combined(other, Keep::Xor)
    }

    fn combined(&self, other: &Region, keep: Keep) -> Result<Region, RegionError> {
        boolean(self.chains(), other.chains(), keep, Fill::Positive)
    }

    /// The elements of each ring.
    fn chains(&self) -> impl Iterator<Item = &[Element]> + Clone {
        self.rings().map(Ring::elements)
    }

    /// The same elsewhere: transformed about the origin, which goes to `at`.
    pub fn placed(&self, transform: &Transform, at: Vec2) -> Region {
        let place = |island: &Island| Island {
            outer: island.outer.placed(transform, at),
            holes: island.holes.iter().map(|hole| hole.placed(transform, at)).collect(),
        };
        Region { islands: self.islands.iter().map(place).collect() }
    }

    /// Its connected pieces.
    pub fn islands(&self) -> &[Island] {
        &self.islands
    }

    /// All rings, of each island the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Ring> + Clone {
        self.islands.iter().flat_map(|island| iter::once(&island.outer).chain(&island.holes))
    }

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.islands.is_empty()
    }

    /// Its area, mm².
    pub fn area(&self) -> f64 {
        self.islands.iter().map(Island::area).sum()
    }

    /// The corners of the smallest box around it whose sides are parallel to the axes; `None` where
    /// it is empty.
    pub fn extents(&self) -> Option<(Vec2, Vec2)> {
        let boxes = self.islands.iter().map(|island| island.outer.extents());
        boxes.reduce(|(low, high), (other, second)| (low.min(other), high.max(second)))
    }

    /// Whether `point` is in it. On the boundary the answer may be either.
    pub fn contains(&self, point: Vec2) -> bool {
        self.islands.iter().any(|island| island.contains(point))
    }

    /// How far `point` is from it, mm; 0 inside. Infinite where the region is empty.
    pub fn distance(&self, point: Vec2) -> f64 {
        let each = self.islands.iter().map(|island| island.distance(point));
        each.fold(f64::INFINITY, f64::min)
    }
}

impl Island {
    /// Its outer boundary, counter-clockwise.
    pub fn outer(&self) -> &Ring {
        &self.outer
    }

    /// The boundaries of its holes, clockwise.
    pub fn holes(&self) -> &[Ring] {
        &self.holes
    }

    /// Its area without the holes, mm².
    pub fn area(&self) -> f64 {
        // Holes count negative.
        self.outer.area() + self.holes.iter().map(Ring::area).sum::<f64>()
    }

    /// Whether `point` is in it.
    pub fn contains(&self, point: Vec2) -> bool {
        self.outer.encloses(point) && !self.holes.iter().any(|hole| hole.encloses(point))
    }

    /// How far `point` is from it, mm; 0 inside.
    pub fn distance(&self, point: Vec2) -> f64 {
        if self.contains(point) {
            return 0.0;
        }
        let rings = iter::once(&self.outer).chain(&self.holes);
        rings.map(|ring| ring.distance(point)).fold(f64::INFINITY, f64::min)
    }
}

/// The islands of a region, or of several, which must not come within 1 µm of each other.
impl FromIterator<Island> for Region {
    fn from_iter<Islands: IntoIterator<Item = Island>>(islands: Islands) -> Region {
        Region { islands: islands.into_iter().collect() }
    }
}

/// More islands, which must not come within 1 µm of each other or of those that there are.
impl Extend<Island> for Region {
    fn extend<Islands: IntoIterator<Item = Island>>(&mut self, islands: Islands) {
        self.islands.extend(islands);
    }
}

impl IntoIterator for Region {
    type Item = Island;
    type IntoIter = std::vec::IntoIter<Island>;

    fn into_iter(self) -> Self::IntoIter {
        self.islands.into_iter()
    }
}

impl From<Island> for Region {
    fn from(island: Island) -> Region {
        Region { islands: vec![island] }
    }
}
