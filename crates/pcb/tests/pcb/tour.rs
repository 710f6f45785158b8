//! Tours: whole, short, and the same each time.

use geom::{Element, Vec2};
use proptest::prelude::*;
use toolpost_pcb::Path;
use toolpost_pcb::tour::Tour;

fn tour(from: Vec2, to: Option<Vec2>) -> Tour {
    Tour { from, to, reversible: true }
}

/// Points all over a square of 100 mm.
fn points(count: usize, seed: u64) -> Vec<Vec2> {
    let mut state = seed;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 * 100.0
    };
    (0..count).map(|_| Vec2::new(next(), next())).collect()
}

fn length(from: Vec2, to: Option<Vec2>, points: impl IntoIterator<Item = Vec2>) -> f64 {
    let mut at = from;
    let mut length = 0.0;
    for point in points.into_iter().chain(to) {
        length += at.distance(point);
        at = point;
    }
    length
}

/// The shortest tour, by trying all.
fn shortest(from: Vec2, to: Option<Vec2>, points: &mut Vec<Vec2>) -> f64 {
    if points.is_empty() {
        return to.map_or(0.0, |to| from.distance(to));
    }
    let mut best = f64::INFINITY;
    for i in 0..points.len() {
        let next = points.swap_remove(i);
        best = best.min(from.distance(next) + shortest(next, to, points));
        points.push(next);
        let last = points.len() - 1;
        points.swap(i, last);
    }
    best
}

/// A length that no closed tour falls below (Held and Karp, 1970): the least 1-tree, with the weights of
/// the points moved until it is nearly a tour.
fn bound(points: &[Vec2]) -> f64 {
    let count = points.len();
    let mut weights = vec![0.0; count];
    let mut best = 0.0f64;
    for round in 0..300 {
        let cost = |i: usize, j: usize| points[i].distance(points[j]) + weights[i] + weights[j];
        let mut degree = vec![0i32; count];
        let mut tree = vec![(f64::INFINITY, 1); count];
        let mut inside = vec![false; count];
        let mut length = 0.0;
        let mut next = 1;
        for _ in 1..count {
            inside[next] = true;
            if next != 1 {
                length += tree[next].0;
                degree[next] += 1;
                degree[tree[next].1] += 1;
            }
            for i in 1..count {
                if !inside[i] && cost(i, next) < tree[i].0 {
                    tree[i] = (cost(i, next), next);
                }
            }
            next = (1..count)
                .filter(|i| !inside[*i])
                .min_by(|i, j| tree[*i].0.total_cmp(&tree[*j].0))
                .unwrap_or(0);
        }
        let mut order: Vec<usize> = (1..count).collect();
        order.sort_by(|i, j| cost(0, *i).total_cmp(&cost(0, *j)));
        for i in &order[..2] {
            length += cost(0, *i);
            degree[0] += 1;
            degree[*i] += 1;
        }
        best = best.max(length - 2.0 * weights.iter().sum::<f64>());
        let step = 2.0 * 0.98f64.powi(round);
        for (weight, degree) in weights.iter_mut().zip(&degree) {
            *weight += step * f64::from(degree - 2);
        }
    }
    best
}

#[test]
fn up_to_eight_points_are_visited_in_the_shortest_way() {
    for seed in 0..60 {
        let mut all = points(1 + (seed % 8) as usize, seed);
        let from = Vec2::new(50.0, 0.0);
        for to in [None, Some(from), Some(Vec2::new(100.0, 100.0))] {
            let order = tour(from, to).of_points(&all);
            let ours = length(from, to, order.iter().map(|i| all[*i]));
            let best = shortest(from, to, &mut all);
            assert!(ours <= best * 1.02 + 1e-9, "{seed} {to:?}: {ours} for {best}");
        }
    }
}

#[test]
fn an_even_grid_is_visited_from_neighbour_to_neighbour() {
    // A closed tour of k·k points one apart cannot be shorter than k·k, and for even k there is one.
    for k in [4, 10, 20] {
        let grid: Vec<Vec2> =
            (1..k * k).map(|i| Vec2::new((i % k) as f64, (i / k) as f64)).collect();
        let order = tour(Vec2::ZERO, Some(Vec2::ZERO)).of_points(&grid);
        let ours = length(Vec2::ZERO, Some(Vec2::ZERO), order.iter().map(|i| grid[*i]));
        assert!(ours <= (k * k) as f64 * 1.05, "{k}: {ours}");
    }
}

#[test]
fn many_points_are_visited_within_six_percent_of_what_is_possible() {
    for seed in [1, 2, 3] {
        let all = points(250, seed);
        let order = tour(all[0], Some(all[0])).of_points(&all[1..]);
        let ours = length(all[0], Some(all[0]), order.iter().map(|i| all[i + 1]));
        let bound = bound(&all);
        assert!(ours <= bound * 1.06, "{seed}: {ours} over {bound}");
    }
}

#[test]
fn ten_thousand_points_in_a_line_on_one_place_and_all_over() {
    let line: Vec<Vec2> =
        (0..10_000).map(|i| Vec2::new(((i * 7919) % 10_000) as f64, 0.0)).collect();
    let order = tour(Vec2::ZERO, None).of_points(&line);
    assert_eq!(length(Vec2::ZERO, None, order.iter().map(|i| line[*i])), 9_999.0);
    let place = vec![Vec2::ONE; 10_000];
    assert_eq!(tour(Vec2::ONE, None).of_points(&place).len(), 10_000);
    let all = points(10_000, 5);
    let order = tour(Vec2::ZERO, None).of_points(&all);
    // The expected length of the shortest tour of many points: 0.7124 √(n·A) (Johnson and McGeoch).
    let expected = 0.7124 * (10_000.0f64 * 1e4).sqrt();
    let ours = length(Vec2::ZERO, None, order.iter().map(|i| all[*i]));
    assert!(ours < 1.06 * expected, "{}", ours / expected);
}

fn square(low: Vec2, side: f64) -> Path {
    let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y].map(|corner| low + corner * side);
    let next = corners.iter().cycle().skip(1);
    Path::new(corners.iter().zip(next).map(|(a, b)| Element::line(*a, *b)).collect()).unwrap()
}

#[test]
fn a_closed_path_begins_where_the_travel_is_shortest() {
    // Between its right side and the far upper right: at its upper right corner, 1.118 + 2.010 mm;
    // the lower right one is 1.118 + 2.332 mm away.
    let tour = tour(Vec2::new(2.0, 0.5), Some(Vec2::new(3.0, 1.2)));
    let paths = tour.of_paths(&[square(Vec2::ZERO, 1.0)]);
    assert_eq!((paths[0].start(), paths[0].length()), (Vec2::ONE, 4.0));
    // A long side within it too.
    let large = square(Vec2::ZERO, 40.0);
    let tour = Tour { from: Vec2::new(20.0, -1.0), to: Some(Vec2::new(20.0, -1.0)), ..tour };
    let paths = tour.of_paths(&[large]);
    assert_eq!((paths[0].start(), paths[0].elements().len()), (Vec2::new(20.0, 0.0), 5));
    assert!(paths[0].is_closed());
}

#[test]
fn open_paths_are_turned_round_where_they_may_be() {
    let line =
        |y: f64| Path::new(vec![Element::line(Vec2::new(0.0, y), Vec2::new(9.0, y))]).unwrap();
    let lines: Vec<Path> = [3.0, 1.0, 2.0, 0.0].map(line).to_vec();
    let there_and_back = tour(Vec2::ZERO, None);
    assert_eq!(there_and_back.travel(&there_and_back.of_paths(&lines)), 3.0);
    let one_way = Tour { reversible: false, ..there_and_back };
    let paths = one_way.of_paths(&lines);
    assert!(paths.iter().all(|path| path.start().x == 0.0));
    assert!((one_way.travel(&paths) - 3.0 * 82f64.sqrt()).abs() < 1e-9);
}

fn any_path() -> impl Strategy<Value = Path> {
    let point = || (0.0..50.0, 0.0..50.0).prop_map(|(x, y)| Vec2::new(x, y));
    prop_oneof![
        (point(), 0.1..5.0).prop_map(|(low, side)| square(low, side)),
        (point(), point()).prop_map(|(a, b)| Path::new(vec![Element::line(a, b)]).unwrap()),
        (point(), 0.1..5.0).prop_map(|(center, radius)| {
            let start = center + Vec2::X * radius;
            Path::new(vec![Element::arc(start, start, center, std::f64::consts::TAU)]).unwrap()
        }),
    ]
}

/// What a path is, wherever it begins and in whichever direction an open one runs, to 0.1 µm.
fn nature(path: &Path) -> [i64; 6] {
    let area: f64 = path.elements().iter().map(|element| element.area(Vec2::ZERO)).sum();
    let area = if path.is_closed() { area } else { area.abs() };
    let extents = path.elements().iter().map(Element::extents);
    let (low, high) = extents.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap();
    [path.length(), low.x, low.y, high.x, high.y, area].map(|value| (value * 1e4).round() as i64)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn every_path_is_cut_once(
        paths in prop::collection::vec(any_path(), 0..40),
        back in any::<bool>(),
        reversible in any::<bool>(),
    ) {
        let tour = Tour { from: Vec2::ZERO, to: back.then_some(Vec2::ZERO), reversible };
        let ordered = tour.of_paths(&paths);
        let sorted = |paths: &[Path]| {
            let mut all: Vec<_> = paths.iter().map(nature).collect();
            all.sort();
            all
        };
        prop_assert_eq!(ordered.len(), paths.len());
        prop_assert_eq!(sorted(&ordered), sorted(&paths));
        for path in &ordered {
            prop_assert!(reversible || path.is_closed() || paths.contains(path));
        }
        prop_assert!(tour.travel(&ordered) <= tour.travel(&paths) + 1e-9);
        prop_assert_eq!(&tour.of_paths(&paths), &ordered);
    }
}
