//! Which body a point in the block comes from, and which point of a list.

use crate::cloud::{self, Point};
use glam::DVec3;
use std::ops::Range;

/// Places that are nearer to each other than this are one, µm: a machine rounds angles and depths, and no two points are so near.
const NEAR: i32 = 10;

/// The side of the cubes in which points are looked up, µm.
const SIDE: i32 = 32;

/// The body that a point comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Its number, from 0.
    pub body: usize,
    /// The number of the point in it, from 0, where it is a list of points.
    pub point: Option<usize>,
}

/// A body among all that are placed in a block.
#[derive(Clone, Debug)]
pub(crate) struct Placed {
    pub(crate) number: usize,
    /// Its corners, and its points, among those of all bodies.
    pub(crate) vertices: Range<usize>,
    pub(crate) points: Range<usize>,
    /// Whether the points that it becomes lie within the box around its corners.
    pub(crate) is_bounded: bool,
}

/// What bodies are where in a block.
#[derive(Clone, Debug, Default)]
pub struct Origins {
    /// The points of lists: the number of the cube, the body and the point, and where it is; ordered.
    points: Vec<(u64, Origin, Point)>,
    /// The boxes around bodies, mm.
    boxes: Vec<(usize, [DVec3; 2])>,
    /// The only body that may be anywhere, or several.
    elsewhere: Vec<usize>,
}

impl Origins {
    /// Of bodies by their corners and points, mm, as they lie in the block.
    pub(crate) fn new(bodies: &[Placed], vertices: &[DVec3], points: &[DVec3]) -> Origins {
        let mut origins = Origins::default();
        for Placed { number, vertices: own, points: listed, is_bounded } in bodies {
            let listed = points[listed.clone()].iter().enumerate();
            origins.points.extend(listed.filter_map(|(place, at)| {
                let (origin, at) =
                    (Origin { body: *number, point: Some(place) }, cloud::point(*at)?);
                Some((cube(at.map(|value| value.div_euclid(SIDE))), origin, at))
            }));
            match crate::mesh::bounds(&vertices[own.clone()]) {
                Some((low, high)) if *is_bounded => origins.boxes.push((*number, [low, high])),
                _ if *is_bounded => {}
                _ => origins.elsewhere.push(*number),
            }
        }
        origins.points.sort_unstable_by_key(|(cube, origin, _)| (*cube, origin.body, origin.point));
        origins
    }

    /// Where a point of the block comes from; `None` where it may be of several bodies.
    pub fn of(&self, at: Point) -> Option<Origin> {
        let cubes = |axis: usize| {
            let [low, high] = [-NEAR, NEAR].map(|off| (at[axis] + off).div_euclid(SIDE));
            low..=high
        };
        let all = cubes(0)
            .flat_map(|x| cubes(1).flat_map(move |y| cubes(2).map(move |z| cube([x, y, z]))));
        let listed = all.flat_map(|cube| {
            let first = self.points.partition_point(|(own, ..)| *own < cube);
            self.points[first..].iter().take_while(move |(own, ..)| *own == cube)
        });
        let near = listed.map(|(_, origin, own)| (cloud::squared(*own, at), origin));
        let near = near.filter(|(squared, _)| *squared <= i64::from(NEAR * NEAR));
        if let Some((_, origin)) =
            near.min_by_key(|(squared, origin)| (*squared, origin.body, origin.point))
        {
            return Some(*origin);
        }
        let (place, near) = (cloud::place(at), DVec3::splat(f64::from(NEAR) * 1e-3));
        let within = self.boxes.iter().filter(|(_, [low, high])| {
            place.cmpge(*low - near).all() && place.cmple(*high + near).all()
        });
        let mut bodies = within.map(|(number, _)| *number).chain(self.elsewhere.iter().copied());
        let body = bodies.next()?;
        bodies.next().is_none().then_some(Origin { body, point: None })
    }
}

/// The number of a cube: 21 bits for each axis.
fn cube(at: [i32; 3]) -> u64 {
    at.iter().fold(0, |number, value| number << 21 | (i64::from(*value) + (1 << 20)) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_of_its_line_and_else_of_the_only_body_around_it() {
        let at = |x: f64| DVec3::new(x, 5.0, 5.0);
        let corners = [at(0.0), at(10.0), at(9.0), at(20.0)];
        let points = [at(30.0), at(30.05), at(-0.001)];
        let body =
            |number, vertices, points, is_bounded| Placed { number, vertices, points, is_bounded };
        let mut bodies =
            vec![body(0, 0..2, 0..0, true), body(2, 2..4, 0..0, true), body(1, 4..4, 0..3, true)];
        let origins = Origins::new(&bodies, &corners, &points);
        let of = |origins: &Origins, x: i32| {
            origins.of([x, 5003, 4996]).map(|found| (found.body, found.point))
        };
        assert_eq!(of(&origins, 30_002), Some((1, Some(0))));
        assert_eq!(of(&origins, 30_049), Some((1, Some(1))));
        assert_eq!(of(&origins, 3), Some((1, Some(2))));
        assert_eq!((of(&origins, 30_025), of(&origins, 25_000)), (None, None));
        assert_eq!((of(&origins, 4000), of(&origins, 15_000)), (Some((0, None)), Some((2, None))));
        // Within both.
        assert_eq!(of(&origins, 9500), None);
        // What is repeated in layers may be anywhere.
        bodies.push(body(3, 4..4, 3..3, false));
        let origins = Origins::new(&bodies, &corners, &points);
        assert_eq!((of(&origins, 4000), of(&origins, 25_000)), (None, Some((3, None))));
        assert_eq!(of(&origins, 30_049), Some((1, Some(1))));
    }
}
