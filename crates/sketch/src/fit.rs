//! Curves as arcs: pairs of arcs that keep the direction of the curve where they join.

use crate::element::Element;
use geom::{Vec2, turn_angle};
use std::f64::consts::PI;

/// How often a piece of a curve is halved at most.
const DEEPEST: u32 = 30;

/// At how many points of a pair of arcs the distance is measured.
const MEASURED: i32 = 12;

/// A smooth curve in the plane.
pub(crate) trait Curve {
    /// The point at `t`.
    fn at(&self, t: f64) -> Vec2;
    /// The direction of travel at `t`, of any length.
    fn travel(&self, t: f64) -> Vec2;
}

/// Adds arcs and lines that follow `curve` from `from` to `to` within `tolerance` mm; `None` where
/// halving does not get there, or more than `most` elements come together.
pub(crate) fn fit(
    curve: &impl Curve,
    from: f64,
    to: f64,
    tolerance: f64,
    most: usize,
    elements: &mut Vec<Element>,
) -> Option<()> {
    let mut pieces = vec![(from, to, 0)];
    while let Some((from, to, depth)) = pieces.pop() {
        if let Some(pair) = biarc(curve, from, to, tolerance) {
            elements.extend(pair);
        } else if depth < DEEPEST && elements.len() < most {
            let middle = f64::midpoint(from, to);
            pieces.extend([(middle, to, depth + 1), (from, middle, depth + 1)]);
        } else {
            return None;
        }
    }
    Some(())
}

/// Two arcs from one end of a piece of a curve to the other, where they are near enough to it.
fn biarc(curve: &impl Curve, from: f64, to: f64, tolerance: f64) -> Option<[Element; 2]> {
    let (p, q) = (curve.at(from), curve.at(to));
    let whole = q - p;
    if whole.length() < tolerance {
        // Below the tolerance the direction is the curve's noise; a loop would be seen below.
        let pair = [Element::line(p, (p + q) / 2.0), Element::line((p + q) / 2.0, q)];
        return near(curve, from, to, tolerance, &pair).then_some(pair);
    }
    let (u, v) = (curve.travel(from).try_normalize()?, curve.travel(to).try_normalize()?);
    // Tangents of equal length d meet the join: |q − p − d (u + v)| = 2 d.
    let (both, spread) = (whole.dot(u + v), 2.0 * (1.0 - u.dot(v)));
    let reach = if spread < 1e-12 {
        whole.length_squared() / (2.0 * both)
    } else {
        ((both * both + spread * whole.length_squared()).sqrt() - both) / spread
    };
    if !reach.is_finite() || reach <= 0.0 {
        return None;
    }
    let join = (p + u * reach + q - v * reach) / 2.0;
    let pair = [tangent_arc(p, u, join)?, tangent_arc(q, -v, join)?.reversed()];
    near(curve, from, to, tolerance, &pair).then_some(pair)
}

/// The arc from `start` in the direction `travel` to `end`.
fn tangent_arc(start: Vec2, travel: Vec2, end: Vec2) -> Option<Element> {
    let chord = end - start;
    let sweep = 2.0 * turn_angle(travel, chord);
    if sweep.abs() > PI {
        return None;
    }
    // What leaves the chord by less than a millionth of a millimetre is a line.
    if chord.length() * sweep.abs() < 1e-5 {
        return Some(Element::line(start, end));
    }
    let center = (start + end) / 2.0 + chord.perp() / (2.0 * (sweep / 2.0).tan());
    Some(Element::arc(start, end, center, sweep))
}

fn near(curve: &impl Curve, from: f64, to: f64, tolerance: f64, pair: &[Element; 2]) -> bool {
    (1..MEASURED).all(|i| {
        let point = curve.at(from + (to - from) * f64::from(i) / f64::from(MEASURED));
        // Between the measured points the curve may be a little farther away.
        let distance = pair[0].nearest(point).1.min(pair[1].nearest(point).1);
        distance <= 0.9 * tolerance
    })
}

/// An ellipse.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ellipse {
    /// Its centre.
    pub center: Vec2,
    /// From the centre to where the parameter is 0.
    pub major: Vec2,
    /// From the centre to where it is π/2.
    pub minor: Vec2,
}

impl Curve for Ellipse {
    fn at(&self, t: f64) -> Vec2 {
        self.center + self.major * t.cos() + self.minor * t.sin()
    }

    fn travel(&self, t: f64) -> Vec2 {
        self.minor * t.cos() - self.major * t.sin()
    }
}

/// A rational B-spline.
#[derive(Clone, Debug)]
pub(crate) struct Spline {
    degree: usize,
    knots: Vec<f64>,
    /// Control points (x w, y w, w).
    poles: Vec<[f64; 3]>,
}

/// The highest degree that is taken.
const HIGHEST: usize = 15;

impl Spline {
    /// A spline of `poles` with their weights; says what is wrong with it.
    pub fn new(
        degree: usize,
        knots: Vec<f64>,
        poles: &[Vec2],
        weights: &[f64],
    ) -> Result<Spline, String> {
        let count = poles.len();
        if !(1..=HIGHEST).contains(&degree) || count <= degree {
            return Err(format!("a spline of degree {degree} with {count} control points"));
        }
        if knots.len() != count + degree + 1 {
            let needed = count + degree + 1;
            return Err(format!("{} knots where {needed} belong", knots.len()));
        }
        if knots.windows(2).any(|pair| pair[0] > pair[1]) {
            return Err("knots that go back".into());
        }
        if !weights.is_empty() && weights.len() != count {
            return Err(format!("{} weights for {count} control points", weights.len()));
        }
        if weights.iter().any(|w| *w <= 0.0) {
            return Err("a weight that is not above 0".into());
        }
        let weights = weights.iter().copied().chain(std::iter::repeat(1.0));
        let poles = poles.iter().zip(weights).map(|(p, w)| [p.x * w, p.y * w, w]).collect();
        Ok(Spline { degree, knots, poles })
    }

    /// The pieces between knots: within each the curve is smooth.
    pub fn spans(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let inner = self.knots.get(self.degree..=self.poles.len()).unwrap_or_default();
        inner.windows(2).filter(|pair| pair[0] < pair[1]).map(|pair| (pair[0], pair[1]))
    }

    /// De Boor's algorithm: the last two points of the triangle's last row but one, the share of the
    /// second, and the width of the span.
    fn triangle(&self, t: f64) -> ([f64; 3], [f64; 3], f64, f64) {
        let (p, n) = (self.degree, self.poles.len());
        let span = self.knots.partition_point(|knot| *knot <= t).clamp(p + 1, n) - 1;
        let mut row = [[0.0; 3]; HIGHEST + 1];
        row[..=p].copy_from_slice(&self.poles[span - p..=span]);
        let mut share = 0.0;
        for level in 1..=p {
            for j in (level..=p).rev() {
                let i = span - p + j;
                let (low, high) = (self.knots[i], self.knots[i + p - level + 1]);
                share = if high > low { (t - low) / (high - low) } else { 0.0 };
                if level < p {
                    row[j] = mixed(row[j - 1], row[j], share);
                }
            }
        }
        (row[p - 1], row[p], share, self.knots[span + 1] - self.knots[span])
    }
}

impl Curve for Spline {
    fn at(&self, t: f64) -> Vec2 {
        let (a, b, share, _) = self.triangle(t);
        let [x, y, weight] = mixed(a, b, share);
        Vec2::new(x, y) / weight
    }

    fn travel(&self, t: f64) -> Vec2 {
        let (a, b, share, width) = self.triangle(t);
        let [x, y, weight] = mixed(a, b, share);
        let point = Vec2::new(x, y) / weight;
        // The slope of a quotient, but for factors that do not turn it.
        let slope = Vec2::new(b[0] - a[0], b[1] - a[1]) - point * (b[2] - a[2]);
        if slope.length() > 1e-9 * weight {
            return slope;
        }
        // Where control points coincide, the direction is that of the curve next to them.
        let around = width * 1e-4;
        self.at(t + around) - self.at(t - around)
    }
}

fn mixed(a: [f64; 3], b: [f64; 3], share: f64) -> [f64; 3] {
    std::array::from_fn(|i| a[i] * (1.0 - share) + b[i] * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, TAU};

    fn checked(curve: &impl Curve, from: f64, to: f64, tolerance: f64) -> Vec<Element> {
        let mut elements = Vec::new();
        fit(curve, from, to, tolerance, 100_000, &mut elements).unwrap();
        for i in 0..=5000 {
            let point = curve.at(from + (to - from) * f64::from(i) / 5000.0);
            let distance = elements.iter().map(|e| e.nearest(point).1).fold(f64::MAX, f64::min);
            assert!(distance <= tolerance, "{distance}");
        }
        assert!(elements.windows(2).all(|pair| pair[0].end.distance(pair[1].start) < 1e-12));
        elements
    }

    #[test]
    fn an_ellipse_becomes_few_arcs_that_join_smoothly() {
        let (major, minor) = (Vec2::new(20.0, 0.0), Vec2::new(0.0, 8.0));
        let ellipse = Ellipse { center: Vec2::new(3.0, 4.0), major, minor };
        let elements = checked(&ellipse, 0.0, TAU, 1e-3);
        assert!(elements.len() <= 128, "{}", elements.len());
        for pair in elements.windows(2) {
            assert!(turn_angle(pair[0].tangent(1.0), pair[1].tangent(0.0)).abs() < 1e-6);
        }
    }

    /// The quarter circle as a rational spline of degree 2: weights 1, 1/√2, 1.
    #[test]
    fn a_rational_spline_that_is_a_circle_is_one() {
        let poles = [Vec2::new(10.0, 0.0), Vec2::new(10.0, 10.0), Vec2::new(0.0, 10.0)];
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let spline = Spline::new(2, knots, &poles, &[1.0, 0.5f64.sqrt(), 1.0]).unwrap();
        for i in 0..=20 {
            let t = f64::from(i) / 20.0;
            assert!((spline.at(t).length() - 10.0).abs() < 1e-12);
            assert!(spline.at(t).normalize().dot(spline.travel(t).normalize()).abs() < 1e-9);
        }
        let elements = checked(&spline, 0.0, 1.0, 1e-3);
        assert_eq!(elements.len(), 2);
        let sweep: f64 = elements.iter().filter_map(|e| e.turn).map(|turn| turn.sweep).sum();
        assert!((sweep - FRAC_PI_2).abs() < 1e-6);
    }

    /// A cubic Bézier curve at t = 1/2: (p0 + 3 p1 + 3 p2 + p3) / 8.
    #[test]
    fn a_cubic_spline_passes_where_it_must() {
        let poles =
            [Vec2::ZERO, Vec2::new(0.0, 10.0), Vec2::new(20.0, 10.0), Vec2::new(20.0, -10.0)];
        let knots = vec![0.0, 0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 2.0];
        let spline = Spline::new(3, knots, &poles, &[]).unwrap();
        assert!(spline.at(1.0).distance(Vec2::new(80.0 / 8.0, 50.0 / 8.0)) < 1e-12);
        checked(&spline, 0.0, 2.0, 1e-3);
    }

    #[test]
    fn what_is_no_spline_is_refused() {
        let poles = [Vec2::ZERO, Vec2::X, Vec2::Y];
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        assert!(Spline::new(2, knots.clone(), &poles, &[]).is_ok());
        assert!(Spline::new(3, knots.clone(), &poles, &[]).is_err());
        assert!(Spline::new(0, knots.clone(), &poles, &[]).is_err());
        assert!(Spline::new(2, knots[1..].to_vec(), &poles, &[]).is_err());
        assert!(Spline::new(2, knots.clone(), &poles, &[1.0, 0.0, 1.0]).is_err());
        assert!(Spline::new(2, vec![0.0, 0.0, 0.0, 1.0, 0.5, 1.0], &poles, &[]).is_err());
    }
}
