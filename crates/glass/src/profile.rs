//! Motion from rest to rest over a length: three speed profiles, and how long each takes.

/// The law by which the speed of an axis rises and falls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Profile {
    /// Full acceleration to the middle, or to the speed limit, then full braking: the fastest.
    Triangle,
    /// A third of the time accelerating, a third at constant speed, a third braking.
    Trapezoid,
    /// One cubic with zero speed at both ends.
    Spline,
}

/// What an axis can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest acceleration, mm/s².
    pub acceleration: f64,
    /// Largest speed, mm/s.
    pub speed: f64,
}

impl Limits {
    /// From m/s² and m/s, as data sheets state them.
    pub fn metric(acceleration: f64, speed: f64) -> Limits {
        Limits { acceleration: acceleration * 1e3, speed: speed * 1e3 }
    }
}

/// The fastest motion of a profile over a length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Duration, s.
    pub time: f64,
    /// Highest speed, mm/s.
    pub speed: f64,
    /// Highest acceleration, mm/s².
    pub acceleration: f64,
}

impl Profile {
    /// All of them.
    pub const ALL: [Profile; 3] = [Profile::Triangle, Profile::Trapezoid, Profile::Spline];

    /// What it is called in machine files.
    pub fn name(self) -> &'static str {
        match self {
            Profile::Triangle => "triangle",
            Profile::Trapezoid => "trapezoid",
            Profile::Spline => "spline",
        }
    }

    /// Peak acceleration times T²/L, and peak speed times T/L, of a motion over L in the time T that no speed limit cuts.
    pub fn peaks(self) -> (f64, f64) {
        match self {
            Profile::Triangle => (4.0, 2.0),
            Profile::Trapezoid => (4.5, 1.5),
            Profile::Spline => (6.0, 1.5),
        }
    }

    /// The fastest motion over `length` (mm, not negative) within `limits`.
    pub fn fastest(self, length: f64, limits: Limits) -> Motion {
        let (by_acceleration, by_speed) = self.peaks();
        let Limits { acceleration, speed } = limits;
        let free = (by_acceleration * length / acceleration).sqrt();
        let time = match self {
            // Cruising at the limit is faster than a longer triangle; the other two keep their shape.
            Profile::Triangle if (acceleration * length).sqrt() > speed => {
                length / speed + speed / acceleration
            }
            Profile::Triangle => free,
            Profile::Trapezoid | Profile::Spline => free.max(by_speed * length / speed),
        };
        if time == 0.0 {
            return Motion { time, speed: 0.0, acceleration: 0.0 };
        }
        let free_speed = by_speed * length / time;
        match self {
            Profile::Triangle => Motion { time, speed: free_speed.min(speed), acceleration },
            Profile::Trapezoid | Profile::Spline => {
                let acceleration = by_acceleration * length / (time * time);
                Motion { time, speed: free_speed, acceleration }
            }
        }
    }

    /// How far a motion from rest to rest gets in `time` (s): the inverse of [`Profile::fastest`], mm.
    pub fn reach(self, time: f64, limits: Limits) -> f64 {
        let (by_acceleration, by_speed) = self.peaks();
        let Limits { acceleration, speed } = limits;
        let free = acceleration * time * time / by_acceleration;
        match self {
            Profile::Triangle if (acceleration * free).sqrt() > speed => {
                speed * (time - speed / acceleration)
            }
            Profile::Triangle => free,
            Profile::Trapezoid | Profile::Spline => free.min(speed * time / by_speed),
        }
    }

    /// The acceleration that a step over `length` (mm) takes when it is stretched to exactly `time` (s): mm/s². Less than
    /// the limit shakes the machine less.
    pub fn stretched(self, length: f64, time: f64) -> f64 {
        self.peaks().0 * length / (time * time)
    }
}
