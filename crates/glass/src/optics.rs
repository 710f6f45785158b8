//! Refraction, as programs are planned: how far the focus has to be driven for a point below the top face.

use crate::cloud::Point;
use crate::machine::Lens;

/// By which ray of the beam the focus is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Ray {
    /// The outermost ray of the cone.
    Marginal,
    /// Rays next to the axis: depth divided by the index.
    Paraxial,
}

/// A converging beam that enters glass through its top face.
#[derive(Clone, Copy, Debug)]
pub struct Beam {
    /// Index of refraction of the glass.
    pub index: f64,
    /// Tangent of the half angle of the cone in air.
    pub slope: f64,
}

impl Beam {
    /// The beam of `diameter` (mm) behind `lens`, in glass of `index`.
    pub fn new(lens: &Lens, diameter: f64, index: f64) -> Beam {
        Beam { index, slope: 0.5 * diameter / lens.focal }
    }

    /// How far the focus in air has to be driven below the top face for each mm of depth. Both rays: tan θ / tan θ' with
    /// n sin θ' = sin θ is the root of n² + t² (n² − 1), of which the paraxial limit is n.
    pub fn drive(&self, ray: Ray) -> f64 {
        let n = self.index;
        match ray {
            Ray::Marginal => 1.0 / (n * n + self.slope * self.slope * (n * n - 1.0)).sqrt(),
            Ray::Paraxial => 1.0 / n,
        }
    }

    /// How far below the focus of its outermost ray that of its innermost rays lies, mm of each mm of depth: the spherical aberration
    /// of a plane face.
    pub fn aberration(&self) -> f64 {
        self.drive(Ray::Paraxial) / self.drive(Ray::Marginal) - 1.0
    }

    /// Tangent of the half angle of the cone in the glass.
    pub fn slope_in_glass(&self) -> f64 {
        self.slope * self.drive(Ray::Marginal)
    }
}

/// Diameter of the spot of a Gaussian beam (at 1/e² of its intensity) behind a perfect lens, mm: `4 λ f / (π D)`, of wavelength,
/// focal length and diameter in mm. A beam of quality M² has M² times as much. Glass does not change it.
pub fn spot(wavelength: f64, focal: f64, diameter: f64) -> f64 {
    4.0 * wavelength * focal / (std::f64::consts::PI * diameter)
}

/// How far from its waist a Gaussian beam with a spot of this diameter is `√2` times as wide, mm, in glass of `index`: Rayleigh's length.
pub fn rayleigh(spot: f64, wavelength: f64, index: f64) -> f64 {
    std::f64::consts::PI * index * spot * spot / (4.0 * wavelength)
}

/// Where the side faces of a block cut the cone.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Cut {
    /// Points whose cone a side face cuts.
    pub points: u64,
    /// How much farther from the sides the worst of them would have to be, mm.
    pub more: f64,
}

/// Looks at the cone of every point of a cloud in a block of `size` (mm), whose corner is the origin, for a cone that grows by
/// `slope` for each mm upwards.
pub fn cut(points: &[Point], size: [f64; 3], slope: f64) -> Cut {
    let lacking = |point: &Point| {
        let [x, y, z] = point.map(|value| f64::from(value) * 1e-3);
        let side = x.min(size[0] - x).min(y).min(size[1] - y);
        (size[2] - z) * slope - side
    };
    let lacking = points.iter().map(lacking).filter(|more| *more > 0.0);
    lacking.fold(Cut { points: 0, more: 0.0 }, |cut, more| Cut {
        points: cut.points + 1,
        more: cut.more.max(more),
    })
}
