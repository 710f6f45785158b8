//! Fewer stays of the tool in the board: paths that share ends become trails, and contours that are near each other are cut
//! in one, along links that the tool goes forth and back.
//!
//! ```text
//!   ┌──────┐   ┌──────┐        ┌──────┐   ┌──────┐
//!   │      │   │      │   ──▶  │      ╞═══╡      │     from the first to the second, around it,
//!   └──────┘   └──────┘        └──────┘   └──────┘     back to the first, and around the rest of that
//! ```

use crate::path::PathPoint;
use crate::{Path, SAME};
use geom::ending::go_on;
use geom::region::{Index, Region};
use geom::{Element, Vec2};
use static_aabb2d_index::{StaticAABB2DIndex, StaticAABB2DIndexBuilder};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Ends of paths that are nearer to each other than this are one, mm.
const ONE: f64 = 1e-4;

/// How far a link may be inside of what the tool stays out of, mm: paths are merged within 5 µm, and regions exact to 1 µm.
const NEAR: f64 = 0.006;

/// No link is longer than this, mm: farther apart there is nearly always something to stay out of between two contours, and all that
/// is within it of each element is looked at.
const FAR: f64 = 4.0;

/// From place to place of a link that is looked at, mm.
const STEP: f64 = 0.02;

/// A link does not cut less than this off an element, mm.
const SHORT: f64 = 0.005;

/// So many nodes are looked at, at most, for one to which the tool goes again from another.
const MOST_PASSED: usize = 256;

/// `paths` in as few trails as there are without lifting the tool: each path is part of one. Some are gone along twice where that
/// saves a trail, up to `longest` mm for each.
pub(crate) fn trails(paths: &[Path], longest: f64) -> Vec<Path> {
    let mut graph = Graph::default();
    for (i, path) in paths.iter().enumerate() {
        let ends = [path.start(), path.end()].map(|end| graph.node(end));
        graph.edge(i, ends);
    }
    let lengths: Vec<f64> = paths.iter().map(Path::length).collect();
    for i in graph.gone_along_twice(&lengths, longest) {
        graph.edge(i, graph.edges[i].ends);
    }
    let trails = graph.trails().into_iter();
    let path = |trail: Vec<(usize, bool)>| {
        let along = trail.into_iter().filter_map(|(i, back)| {
            let path = paths.get(i)?;
            Some(if back { path.reversed() } else { path.clone() })
        });
        Path::new(along.flat_map(|path| path.elements().to_vec()).collect())
    };
    trails.filter_map(path).collect()
}

/// Paths between nodes.
#[derive(Default)]
struct Graph {
    known: BTreeMap<[i64; 2], usize>,
    /// The edges at each node.
    at: Vec<Vec<usize>>,
    edges: Vec<Edge>,
}

struct Edge {
    /// The path; `None` where the tool is lifted.
    path: Option<usize>,
    ends: [usize; 2],
}

impl Edge {
    fn other(&self, node: usize) -> usize {
        self.ends[usize::from(self.ends[0] == node)]
    }
}

/// From one node to another.
struct Way {
    to: usize,
    /// Without what was gone along twice before, mm.
    length: f64,
    edges: Vec<usize>,
}

/// A path, or `None` where the tool is lifted, and whether it is gone along backwards.
type Along = (Option<usize>, bool);

impl Graph {
    fn node(&mut self, at: Vec2) -> usize {
        let cell = [at.x, at.y].map(|value| (value / ONE).round() as i64);
        let around = (-1..=1).flat_map(|x| (-1..=1).map(move |y| [cell[0] + x, cell[1] + y]));
        if let Some(known) = around.into_iter().find_map(|cell| self.known.get(&cell)) {
            return *known;
        }
        self.known.insert(cell, self.at.len());
        self.at.push(Vec::new());
        self.at.len() - 1
    }

    fn edge(&mut self, path: impl Into<Option<usize>>, ends: [usize; 2]) {
        for end in ends {
            self.at[end].push(self.edges.len());
        }
        self.edges.push(Edge { path: path.into(), ends });
    }

    fn is_odd(&self, node: usize) -> bool {
        self.at[node].len() % 2 == 1
    }

    /// The edges that are gone along twice, so that fewer nodes are odd: between two of these along `longest` mm at most, the nearest
    /// two first. A way along an edge that is gone along twice already costs nothing: once is enough for it from then on.
    fn gone_along_twice(&self, lengths: &[f64], longest: f64) -> Vec<usize> {
        let mut is_odd: Vec<bool> = (0..self.at.len()).map(|node| self.is_odd(node)).collect();
        let mut piece_of = vec![0; self.at.len()];
        let mut odd = BTreeMap::new();
        for (piece, nodes) in self.pieces() {
            nodes.iter().for_each(|node| piece_of[*node] = piece);
            odd.insert(piece, nodes.iter().filter(|node| is_odd[**node]).count());
        }
        let mut twice = vec![false; self.edges.len()];
        loop {
            // Two ends are one trail in any case.
            let from = (0..is_odd.len()).filter(|node| is_odd[*node] && odd[&piece_of[*node]] > 2);
            let mut ways: Vec<(u64, usize, Way)> = from
                .filter_map(|node| {
                    let way = self.way_to_odd(node, &is_odd, &twice, lengths, longest)?;
                    Some((way.length.to_bits(), node, way))
                })
                .collect();
            ways.sort_by_key(|(length, from, _)| (*length, *from));
            let mut is_changed = vec![false; self.edges.len()];
            let mut found = false;
            for (_, from, Way { to, edges, .. }) in ways {
                let Some(ends) = odd.get_mut(&piece_of[from]).filter(|ends| **ends > 2) else {
                    continue;
                };
                if is_odd[from] && is_odd[to] && !edges.iter().any(|edge| is_changed[*edge]) {
                    *ends -= 2;
                    (is_odd[from], is_odd[to], found) = (false, false, true);
                    for edge in edges {
                        twice[edge] = !twice[edge];
                        is_changed[edge] = true;
                    }
                }
            }
            if !found {
                return (0..twice.len()).filter(|edge| twice[*edge]).collect();
            }
        }
    }

    /// The shortest way from a node to another one that is odd, of no more than `longest` mm without what is gone along `twice`.
    fn way_to_odd(
        &self,
        from: usize,
        is_odd: &[bool],
        twice: &[bool],
        lengths: &[f64],
        longest: f64,
    ) -> Option<Way> {
        // A length that is not negative is ordered as its bits are.
        let mut open = BinaryHeap::from([Reverse((0_u64, from))]);
        let mut reached: BTreeMap<usize, (f64, Option<usize>)> =
            BTreeMap::from([(from, (0.0, None))]);
        while let Some(Reverse((length, node))) = open.pop() {
            go_on();
            let length = f64::from_bits(length);
            if reached.get(&node).is_none_or(|(least, _)| length > *least) {
                continue;
            }
            if is_odd[node] && node != from {
                let mut way = Way { to: node, length, edges: Vec::new() };
                let mut at = node;
                while let Some((_, Some(edge))) = reached.get(&at) {
                    way.edges.push(*edge);
                    at = self.edges[*edge].other(at);
                }
                return Some(way);
            }
            if reached.len() > MOST_PASSED {
                return None;
            }
            for &edge in &self.at[node] {
                let to = self.edges[edge].other(node);
                let on = length + if twice[edge] { 0.0 } else { lengths[edge] };
                if on <= longest && reached.get(&to).is_none_or(|(least, _)| on < *least) {
                    reached.insert(to, (on, Some(edge)));
                    open.push(Reverse((on.to_bits(), to)));
                }
            }
        }
        None
    }

    /// The nodes of each piece, by the least of them.
    fn pieces(&self) -> BTreeMap<usize, Vec<usize>> {
        let mut group = Groups::new(self.at.len());
        for edge in &self.edges {
            group.join(edge.ends[0], edge.ends[1]);
        }
        let mut pieces: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for node in 0..self.at.len() {
            pieces.entry(group.of(node)).or_default().push(node);
        }
        pieces
    }

    /// Trails that have each edge once: paths, and whether each is gone along backwards.
    fn trails(mut self) -> Vec<Vec<(usize, bool)>> {
        let mut trails = Vec::new();
        for nodes in self.pieces().into_values() {
            // With an edge between two odd nodes after the other there is one way around, which is cut there.
            let odd: Vec<usize> = nodes.iter().copied().filter(|node| self.is_odd(*node)).collect();
            for pair in odd.chunks_exact(2) {
                self.edge(None, [pair[0], pair[1]]);
            }
            let Some(first) = odd.first().or(nodes.first()) else { continue };
            let mut around = self.around(*first);
            let is_lift = |step: &Along| step.0.is_none();
            let lift = around.iter().position(is_lift).unwrap_or(0);
            around.rotate_left(lift);
            trails.extend(around.split(is_lift).filter(|trail| !trail.is_empty()).map(|trail| {
                trail.iter().filter_map(|(path, back)| Some(((*path)?, *back))).collect()
            }));
        }
        trails
    }

    /// The way around that has each edge of a piece once (Hierholzer); its edges are used up.
    fn around(&mut self, from: usize) -> Vec<Along> {
        let mut used = vec![false; self.edges.len()];
        let mut stack: Vec<(usize, Option<Along>)> = vec![(from, None)];
        let mut around = Vec::new();
        while let Some((node, _)) = stack.last().copied() {
            let next = loop {
                match self.at[node].pop() {
                    Some(edge) if std::mem::replace(&mut used[edge], true) => {}
                    other => break other,
                }
            };
            match next {
                Some(edge) => {
                    let Edge { path, ends } = self.edges[edge];
                    let back = ends[0] != node;
                    let to = if back { ends[0] } else { ends[1] };
                    stack.push((to, Some((path, back))));
                }
                None => around.extend(stack.pop().and_then(|(_, step)| step)),
            }
        }
        around.reverse();
        around
    }
}

/// What is joined with what.
struct Groups(Vec<usize>);

impl Groups {
    fn new(count: usize) -> Groups {
        Groups((0..count).collect())
    }

    fn of(&mut self, mut one: usize) -> usize {
        while self.0[one] != one {
            self.0[one] = self.0[self.0[one]];
            one = self.0[one];
        }
        one
    }

    /// Whether the two were apart.
    fn join(&mut self, one: usize, other: usize) -> bool {
        let (a, b) = (self.of(one), self.of(other));
        self.0[a.max(b)] = a.min(b);
        a != b
    }
}

/// Where the tool goes from one contour to another.
struct Link {
    /// The contours.
    of: [usize; 2],
    /// Where on each.
    at: [PathPoint; 2],
    /// From the first to the second.
    way: Path,
}

/// `paths` with those contours in one from one to another of which the tool may go: straight, outside of `kept`, along no
/// more than `longest` mm forth and back, and [`FAR`] at most; or along an open path between them. Open paths that lead from a contour nowhere
/// are part of it where that is as short.
pub(crate) fn linked(paths: &[Path], kept: &Region, longest: f64) -> Vec<Path> {
    let (rings, mut open): (Vec<&Path>, Vec<&Path>) =
        paths.iter().partition(|path| path.is_closed());
    let kept = Index::new(kept);
    let elements = Elements::new(&rings);
    let most = FAR.min(longest / 2.0);
    let mut links = elements.links(&rings, most);
    links.extend(open.iter().enumerate().filter_map(|(i, path)| {
        let ends = [path.start(), path.end()].map(|end| elements.nearest(&rings, &kept, end, most));
        let [Some((a, at)), Some((b, to))] = ends else { return None };
        let way = way(&[rings[a].at(at), path.start()], path, &[path.end(), rings[b].at(to)])?;
        Some((way.length(), Some(i), Link { of: [a, b], at: [at, to], way }))
    }));
    links.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut groups = Groups::new(rings.len());
    let mut taken = vec![false; open.len()];
    let mut tree: Vec<Vec<Step>> = rings.iter().map(|_| Vec::new()).collect();
    let mut ways: Vec<Link> = Vec::new();
    for (length, path, link) in links {
        let [a, b] = link.of;
        // Most pairs are joined by others before: whether a link is free is asked of those alone that would join two.
        let may_join = (path.is_some() || 2.0 * length <= longest) && groups.of(a) != groups.of(b);
        let is_free = || path.is_some() || is_free(&kept, [link.way.start(), link.way.end()]);
        let goes_on = may_join && is_free() && groups.join(a, b);
        let is_spur = !goes_on && path.is_some() && 2.0 * length <= longest;
        if !goes_on && !is_spur {
            continue;
        }
        if let Some(path) = path {
            taken[path] = true;
        }
        tree[a].push(Step { at: link.at[0], link: ways.len(), to: goes_on.then_some(b) });
        if goes_on {
            tree[b].push(Step { at: link.at[1], link: ways.len(), to: Some(a) });
        }
        ways.push(link);
    }
    let mut done = vec![false; rings.len()];
    let mut walks: Vec<Path> = Vec::new();
    for ring in 0..rings.len() {
        if !done[ring] {
            walks.extend(walk(ring, &rings, &tree, &ways, &mut done));
        }
    }
    let mut is_taken = taken.into_iter();
    open.retain(|_| !is_taken.next().unwrap_or(false));
    walks.extend(open.into_iter().cloned());
    walks
}

/// From one place to another, along `path`, and again from one place to another.
fn way(before: &[Vec2; 2], path: &Path, behind: &[Vec2; 2]) -> Option<Path> {
    let line =
        |[from, to]: &[Vec2; 2]| (from.distance(*to) > SHORT).then(|| Element::line(*from, *to));
    let elements =
        line(before).into_iter().chain(path.elements().iter().copied()).chain(line(behind));
    Path::new(elements.collect())
}

/// Where a walk around a contour leaves it.
#[derive(Clone, Copy)]
struct Step {
    at: PathPoint,
    link: usize,
    /// The contour that is walked around next; `None` where the walk comes back at once.
    to: Option<usize>,
}

/// Around a contour and all that are linked with it.
fn walk(
    first: usize,
    rings: &[&Path],
    tree: &[Vec<Step>],
    links: &[Link],
    done: &mut [bool],
) -> Option<Path> {
    let mut elements: Vec<Element> = Vec::new();
    // What is still to be done, the next at last.
    let mut stack: Vec<Task> = vec![Task::Around(first, PathPoint { element: 0, t: 0.0 })];
    while let Some(task) = stack.pop() {
        go_on();
        match task {
            Task::Along(element) => elements.push(element),
            Task::Link(link, is_back) => {
                let way = &links[link].way;
                match is_back {
                    false => elements.extend(way.elements()),
                    true => elements.extend(way.reversed().elements()),
                }
            }
            Task::Around(ring, from) => {
                done[ring] = true;
                let steps = tree[ring].iter().filter(|step| step.to.is_none_or(|to| !done[to]));
                let mut tasks = around(rings[ring], from, steps.copied().collect(), links, ring);
                tasks.reverse();
                stack.append(&mut tasks);
            }
        }
    }
    // Elements meet to rounding.
    let start = elements.first()?.start;
    if let Some(last) = elements.last_mut().filter(|last| last.end.distance(start) <= SAME) {
        last.end = start;
    }
    Path::new(elements)
}

enum Task {
    Along(Element),
    /// Along a link, or back.
    Link(usize, bool),
    /// Around a contour, from a place on it.
    Around(usize, PathPoint),
}

/// Once around a contour from a place on it, leaving it where `steps` say.
fn around(
    ring: &Path,
    from: PathPoint,
    mut steps: Vec<Step>,
    links: &[Link],
    own: usize,
) -> Vec<Task> {
    let elements = ring.elements();
    steps.sort_by(|a, b| a.at.element.cmp(&b.at.element).then(a.at.t.total_cmp(&b.at.t)));
    let others = (1..elements.len()).map(|i| ((from.element + i) % elements.len(), 0.0, 1.0));
    let pieces = std::iter::once((from.element, from.t, 1.0)).chain(others);
    let mut tasks = Vec::new();
    for (i, low, high) in pieces.chain([(from.element, 0.0, from.t)]) {
        let Some(element) = elements.get(i) else { continue };
        let go = |tasks: &mut Vec<Task>, t: [f64; 2]| {
            if (t[1] - t[0]) * element.length() > SAME {
                tasks.push(Task::Along(element.part(t[0], t[1])));
            }
        };
        let mut at = low;
        let first = steps.partition_point(|step| (step.at.element, step.at.t) < (i, low));
        let here =
            steps[first..].iter().take_while(|step| step.at.element == i && step.at.t < high);
        for step in here {
            go(&mut tasks, [at, step.at.t]);
            at = step.at.t;
            let is_back = links.get(step.link).is_some_and(|link| link.of[0] != own);
            tasks.push(Task::Link(step.link, is_back));
            if let Some((to, link)) = step.to.zip(links.get(step.link)) {
                tasks.push(Task::Around(to, link.at[usize::from(!is_back)]));
            }
            tasks.push(Task::Link(step.link, !is_back));
        }
        go(&mut tasks, [at, high]);
    }
    tasks
}

/// The elements of all contours, in a tree of boxes.
struct Elements {
    /// The contour of each, and which it is there.
    of: Vec<(usize, usize)>,
    tree: Option<StaticAABB2DIndex<f64>>,
}

impl Elements {
    fn new(rings: &[&Path]) -> Elements {
        let of: Vec<(usize, usize)> = rings
            .iter()
            .enumerate()
            .flat_map(|(ring, path)| (0..path.elements().len()).map(move |i| (ring, i)))
            .collect();
        let mut tree = StaticAABB2DIndexBuilder::new(of.len());
        for (low, high) in rings.iter().flat_map(|path| path.elements()).map(Element::extents) {
            tree.add(low.x, low.y, high.x, high.y);
        }
        Elements { of, tree: tree.build().ok() }
    }

    /// Those that may be in a box.
    fn within(&self, low: Vec2, high: Vec2) -> impl Iterator<Item = (usize, usize)> + '_ {
        let found = self.tree.iter().flat_map(move |tree| tree.query(low.x, low.y, high.x, high.y));
        found.filter_map(|i| self.of.get(i).copied())
    }

    /// Of each two contours the shortest link that is no longer than `longest` mm, whether the tool may go along it or not.
    fn links(&self, rings: &[&Path], longest: f64) -> Vec<(f64, Option<usize>, Link)> {
        let mut best: BTreeMap<[usize; 2], (f64, Vec2, Vec2)> = BTreeMap::new();
        for &(ring, i) in &self.of {
            go_on();
            let Some(element) = rings[ring].elements().get(i) else { continue };
            let (low, high) = element.extents();
            for (other, k) in self.within(low - longest, high + longest) {
                if other <= ring {
                    continue;
                }
                let known = best.get(&[ring, other]).map_or(longest, |best| best.0);
                let next = &rings[other].elements()[k];
                let (p, q) = next.extents();
                if (p - high).max(low - q).max(Vec2::ZERO).length() >= known {
                    continue;
                }
                let (one, two) = element.closest(next);
                if one.distance(two) < known {
                    best.insert([ring, other], (one.distance(two), one, two));
                }
            }
        }
        let link = |(of, (_, one, two)): ([usize; 2], (f64, Vec2, Vec2))| {
            let at = [entry(rings[of[0]], one), entry(rings[of[1]], two)];
            let ends = [rings[of[0]].at(at[0]), rings[of[1]].at(at[1])];
            let way = Path::new(vec![Element::line(ends[0], ends[1])])?;
            Some((way.length(), None, Link { of, at, way }))
        };
        best.into_iter().filter_map(link).collect()
    }

    /// The contour nearest to a place, and where on it, where the tool may go there.
    fn nearest(
        &self,
        rings: &[&Path],
        kept: &Index,
        from: Vec2,
        most: f64,
    ) -> Option<(usize, PathPoint)> {
        go_on();
        let mut best: Option<(f64, usize)> = None;
        for (ring, i) in self.within(from - most, from + most) {
            let away =
                rings[ring].elements().get(i).map_or(f64::INFINITY, |element| element.away(from));
            if away < best.map_or(most, |best| best.0) {
                best = Some((away, ring));
            }
        }
        let (_, ring) = best?;
        let at = entry(rings[ring], from);
        is_free(kept, [from, rings[ring].at(at)]).then_some((ring, at))
    }
}

/// Where on a contour a link to `point` begins: not so near to the end of an element that what is left of it is short.
fn entry(ring: &Path, point: Vec2) -> PathPoint {
    let near = ring.nearest(point);
    let length = ring.elements().get(near.element).map_or(0.0, Element::length);
    match (near.t * length < SHORT, (1.0 - near.t) * length < SHORT) {
        (true, _) => PathPoint { t: 0.0, ..near },
        (_, true) => PathPoint { element: (near.element + 1) % ring.elements().len(), t: 0.0 },
        _ => near,
    }
}

/// Whether the tool stays out of `kept` from one place to another, both of which may be on its boundary.
fn is_free(kept: &Index, ends: [Vec2; 2]) -> bool {
    let line = Element::line(ends[0], ends[1]);
    let steps = (line.length() / STEP).ceil().max(1.0) as usize;
    let is_out = |at: Vec2| kept.island_at(at).is_none() || kept.nearest(at, NEAR).is_some();
    line.length() < STEP || (0..=steps).all(|i| is_out(line.at(i as f64 / steps as f64)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::region::Fill;
    use geom::region::Ring;

    fn line(from: (f64, f64), to: (f64, f64)) -> Path {
        Path::new(vec![Element::line(from.into(), to.into())]).unwrap()
    }

    fn square(x: f64, y: f64) -> Ring {
        let corners = [(x, y), (x + 2.0, y), (x + 2.0, y + 2.0), (x, y + 2.0)].map(Vec2::from);
        Ring::polygon(&corners).unwrap()
    }

    /// How far is cut in all, mm.
    fn length(paths: &[Path]) -> f64 {
        paths.iter().map(Path::length).sum()
    }

    #[test]
    fn lines_that_meet_are_as_few_trails_as_euler_says() {
        // The bridges of Koenigsberg, seven between four places all of which are odd: two trails.
        let (a, b, c, d) = ((0.0, 0.0), (0.0, 10.0), (0.0, -10.0), (12.0, 0.0));
        let over = |from: (f64, f64), to: (f64, f64), x: f64| {
            let middle = Vec2::new(x, (from.1 + to.1) / 2.0);
            Path::new(vec![Element::line(from.into(), middle), Element::line(middle, to.into())])
                .unwrap()
        };
        let bridges = [
            over(a, b, -1.0),
            over(a, b, 1.0),
            over(a, c, -1.0),
            over(a, c, 1.0),
            line(a, d),
            line(b, d),
            line(c, d),
        ];
        let all = trails(&bridges, 0.0);
        assert_eq!(all.len(), 2);
        assert!((length(&all) - length(&bridges)).abs() < 1e-9);
        // One of them twice, and there is one trail, between two places.
        let all = trails(&bridges, 13.0);
        assert_eq!(all.len(), 1);
        assert!(length(&all) > length(&bridges) + 10.0);
        // A cross of four lines is two, a square of four one that is closed.
        let cross =
            [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|to| line((0.0, 0.0), to));
        assert_eq!(trails(&cross, 0.0).len(), 2);
        let around = [line(a, b), line(d, b), line(d, c), line(a, c)];
        let [one] = &trails(&around, 0.0)[..] else { panic!() };
        assert!(one.is_closed());
        assert_eq!(trails(&[line(a, b), line(c, d)], 0.0).len(), 2);
    }

    /// A ladder: two sides of five pieces, with four rungs that are too long to be gone along twice. All eight ends of the rungs are
    /// odd. The nearest are joined in the middle of either side, which leaves the outer ones over, three pieces apart.
    #[test]
    fn ends_that_others_have_left_over_are_joined_through_what_is_gone_along_twice() {
        let mut paths = Vec::new();
        for y in [0.0, 20.0] {
            for (from, to) in [(0.0, 5.0), (5.0, 7.0), (7.0, 8.0), (8.0, 10.0), (10.0, 15.0)] {
                paths.push(line((from, y), (to, y)));
            }
        }
        for x in [5.0, 7.0, 8.0, 10.0] {
            paths.push(line((x, 0.0), (x, 20.0)));
        }
        paths.push(line((0.0, 0.0), (0.0, 20.0)));
        paths.push(line((15.0, 0.0), (15.0, 20.0)));
        // Without a detour four trails, each of which has two of the eight ends.
        assert_eq!(trails(&paths, 0.0).len(), 4);
        // By hand: on one side its two pieces of 2 mm twice and that of 1 mm between them once, on the other that of 1 mm twice. The
        // two ends that are left there are one trail in any case.
        let all = trails(&paths, 4.5);
        assert_eq!(all.len(), 1);
        let more = length(&all) - length(&paths);
        assert!((more - 5.0).abs() < 1e-9, "{more}");
    }

    #[test]
    fn contours_near_each_other_are_one_walk_and_nothing_is_cut_through() {
        // Three squares 0.5 mm apart, and one far away.
        let rings = [square(0.0, 0.0), square(2.5, 0.0), square(5.0, 0.0), square(20.0, 0.0)];
        let paths: Vec<Path> = rings.iter().filter_map(Path::around).collect();
        let kept = Region::inside(&rings, Fill::NonZero).unwrap();
        let walks = linked(&paths, &kept, 2.0);
        assert_eq!(walks.len(), 2);
        assert!(walks.iter().all(Path::is_closed));
        // Two links, forth and back.
        assert!((length(&walks) - 32.0 - 2.0).abs() < 1e-9, "{}", length(&walks));
        let inside = kept.offset(-0.01).unwrap();
        for element in walks.iter().flat_map(Path::elements) {
            assert!(
                (0..=10).all(|i| !inside.contains(element.at(f64::from(i) / 10.0))),
                "{element:?}"
            );
        }
        assert_eq!(linked(&paths, &kept, 0.9).len(), 4);
        // The last is 13 mm away: no link is so long, however fast the tool cuts and slowly it comes down.
        assert_eq!(linked(&paths, &kept, 100.0).len(), 2);
        // What stands between two may not be cut.
        let wall =
            Ring::polygon(&[(2.1, -5.0), (2.4, -5.0), (2.4, 5.0), (2.1, 5.0)].map(Vec2::from))
                .unwrap();
        let kept = kept.union(&Region::inside([&wall], Fill::NonZero).unwrap()).unwrap();
        assert_eq!(linked(&paths, &kept, 2.0).len(), 3);
    }

    #[test]
    fn a_path_between_two_contours_links_them_and_a_spur_is_part_of_its_contour() {
        let rings = [square(0.0, 0.0), square(7.0, 0.0)];
        let kept = Region::inside(&rings, Fill::NonZero).unwrap();
        let mut paths: Vec<Path> = rings.iter().filter_map(Path::around).collect();
        paths.push(line((2.0, 1.0), (7.0, 1.0)));
        let [walk] = &linked(&paths, &kept, 2.0)[..] else { panic!() };
        assert!(walk.is_closed() && (walk.length() - 26.0).abs() < 1e-9);
        // A short one from one place of a contour to another.
        paths.pop();
        paths.push(
            Path::new(vec![Element::arc(
                Vec2::new(2.0, 0.9),
                Vec2::new(2.0, 1.1),
                Vec2::new(2.0, 1.0),
                3.2,
            )])
            .unwrap(),
        );
        let walks = linked(&paths, &kept, 2.0);
        assert_eq!(walks.len(), 2);
        assert!((length(&walks) - 16.0 - 2.0 * 0.32).abs() < 0.01, "{}", length(&walks));
    }
}
