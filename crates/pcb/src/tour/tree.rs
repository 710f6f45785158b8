//! Points of which the nearest are asked for, and which can be taken away (a k-d tree).

use geom::Vec2;

/// Ranges of at most so many points are looked through one by one.
const LEAF: usize = 8;

/// The points, in an order in which the middle one of a range parts it: by X, then by Y, and so on.
pub(super) struct Tree<'a> {
    points: &'a [Vec2],
    order: Vec<u32>,
    /// Where in `order` each point stands.
    rank: Vec<u32>,
    /// How many are left of the range that is parted at this rank.
    left: Vec<u32>,
    gone: Vec<bool>,
}

impl<'a> Tree<'a> {
    pub(super) fn new(points: &'a [Vec2]) -> Tree<'a> {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let mut left = vec![0; points.len()];
        part(points, &mut order, &mut left, false);
        let mut rank = vec![0; points.len()];
        for (at, point) in order.iter().enumerate() {
            rank[*point as usize] = at as u32;
        }
        Tree { points, order, rank, left, gone: vec![false; points.len()] }
    }

    /// Takes away the point of this index, which must still be there.
    pub(super) fn remove(&mut self, point: usize) {
        let rank = self.rank[point] as usize;
        self.gone[point] = true;
        let (mut low, mut high) = (0, self.order.len());
        while high - low > LEAF {
            let middle = low.midpoint(high);
            self.left[middle] -= 1;
            match rank.cmp(&middle) {
                std::cmp::Ordering::Less => high = middle,
                std::cmp::Ordering::Equal => break,
                std::cmp::Ordering::Greater => low = middle + 1,
            }
        }
    }

    /// The index of the nearest point.
    pub(super) fn nearest(&self, to: Vec2) -> Option<usize> {
        let mut found = Nearest { to, wanted: 1, points: Vec::with_capacity(2) };
        self.search(0, self.order.len(), false, &mut found);
        found.points.first().map(|(_, point)| *point as usize)
    }

    /// The indices of up to `wanted` points, the nearest first.
    pub(super) fn nearest_of(&self, to: Vec2, wanted: usize) -> impl Iterator<Item = usize> {
        let mut found = Nearest { to, wanted, points: Vec::with_capacity(wanted + 1) };
        self.search(0, self.order.len(), false, &mut found);
        found.points.into_iter().map(|(_, point)| point as usize)
    }

    fn search(&self, low: usize, high: usize, by_y: bool, found: &mut Nearest) {
        if high - low <= LEAF {
            for point in &self.order[low..high] {
                self.take(*point, found);
            }
            return;
        }
        let middle = low.midpoint(high);
        if self.left[middle] == 0 {
            return;
        }
        let point = self.order[middle];
        let beyond = along(found.to, by_y) - along(self.points[point as usize], by_y);
        let (near, far) = ((low, middle), (middle + 1, high));
        let (near, far) = if beyond < 0.0 { (near, far) } else { (far, near) };
        self.search(near.0, near.1, !by_y, found);
        self.take(point, found);
        if beyond * beyond < found.reach() {
            self.search(far.0, far.1, !by_y, found);
        }
    }

    fn take(&self, point: u32, found: &mut Nearest) {
        if !self.gone[point as usize] {
            found.take(point, self.points[point as usize].distance_squared(found.to));
        }
    }
}

fn along(point: Vec2, by_y: bool) -> f64 {
    if by_y { point.y } else { point.x }
}

fn part(points: &[Vec2], order: &mut [u32], left: &mut [u32], by_y: bool) {
    if order.len() <= LEAF {
        return;
    }
    let middle = order.len() / 2;
    left[middle] = order.len() as u32;
    let at = |point: &u32| along(points[*point as usize], by_y);
    let (below, _, above) =
        order.select_nth_unstable_by(middle, |a, b| at(a).total_cmp(&at(b)).then(a.cmp(b)));
    let (left_below, left_above) = left.split_at_mut(middle);
    part(points, below, left_below, !by_y);
    part(points, above, &mut left_above[1..], !by_y);
}

/// The nearest points so far, the nearest first, with their squared distances.
struct Nearest {
    to: Vec2,
    wanted: usize,
    points: Vec<(f64, u32)>,
}

impl Nearest {
    /// The squared distance within which a point is of interest.
    fn reach(&self) -> f64 {
        match self.points.get(self.wanted - 1) {
            Some((distance, _)) => *distance,
            None => f64::INFINITY,
        }
    }

    fn take(&mut self, point: u32, distance: f64) {
        if distance < self.reach() {
            let at = self.points.partition_point(|(other, _)| *other <= distance);
            self.points.insert(at, (distance, point));
            self.points.truncate(self.wanted);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_of_a_grid_until_none_is_left() {
        // Many at one place, and many at one distance.
        let points: Vec<Vec2> =
            (0..400).map(|i| Vec2::new((i % 10) as f64, (i / 40) as f64)).collect();
        let mut tree = Tree::new(&points);
        let mut left: Vec<usize> = (0..points.len()).collect();
        let mut at = Vec2::new(3.2, 4.1);
        while let Some(next) = tree.nearest(at) {
            let least = left.iter().map(|i| points[*i].distance(at)).fold(f64::INFINITY, f64::min);
            assert_eq!(points[next].distance(at), least);
            let mut near: Vec<f64> = left.iter().map(|i| points[*i].distance(at)).collect();
            near.sort_by(f64::total_cmp);
            near.truncate(5);
            let found: Vec<f64> = tree.nearest_of(at, 5).map(|i| points[i].distance(at)).collect();
            assert_eq!(found, near);
            left.retain(|i| *i != next);
            tree.remove(next);
            at = points[next];
        }
        assert!(left.is_empty());
    }
}
