//! Which way a rotary axis turns to a position: an axis that its control counts modulo 360° may go another way than one
//! that it does not.

/// How a control turns an axis that it counts modulo 360°.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Modulo {
    /// The shorter way.
    Shorter,
    /// The shorter way, or without passing 0°: a parameter says which.
    AsSetUp,
    /// The sign of the position is the direction, its amount the place within a turn.
    BySign,
    /// The shorter way, or by the sign: a parameter says which.
    ShorterOrBySign,
}

/// Degrees by which two ways are the same.
const SAME: f64 = 1e-6;

/// Whether an axis turns by `to - from` degrees however its control counts it. `counted` says whether it counts it modulo
/// 360°, where the machine's file does; an axis that stands where nobody knows turns by nothing that is known.
pub(crate) fn is_sure(from: f64, to: f64, counted: Option<bool>, modulo: Modulo) -> bool {
    let way = to - from;
    if counted == Some(false) || way.is_nan() || way == 0.0 {
        return true;
    }
    let same = |other: f64| (way - other).abs() < SAME;
    let shorter = geom::wrap(way.to_radians()).to_degrees();
    // 180° are as far one way as the other.
    let is_shorter = same(shorter) && shorter.abs() < 180.0 - SAME;
    let shown = |degrees: f64| ((degrees / SAME).round() * SAME).rem_euclid(360.0);
    let by_sign = || match to.is_sign_negative() {
        true => same(-shown(from + to)),
        false => same(shown(way)),
    };
    match modulo {
        Modulo::Shorter => is_shorter,
        Modulo::AsSetUp => is_shorter && same(shown(to) - shown(from)),
        Modulo::BySign => by_sign(),
        Modulo::ShorterOrBySign => is_shorter && by_sign(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// TNC 640 user's manual, "Shorter-path traverse of rotary axes: M126": from 350° to 10° by -340° without it, and by
    /// +20° with it; from 10° to 340° by +330°, and by -30°.
    #[test]
    fn the_way_hangs_on_the_count_where_it_passes_zero_or_half_a_turn() {
        for (from, to, as_set_up, shorter) in [
            (350.0, 10.0, false, false),
            (10.0, 340.0, false, false),
            (350.0, 370.0, false, true),
            (-9.8, 0.16, false, true),
            (10.0, -20.0, false, true),
            (10.0, 40.0, true, true),
            (-30.0, -10.0, true, true),
            (370.0, 400.0, true, true),
            (0.0, 180.0, false, false),
            (0.0, 179.0, true, true),
            (0.0, 0.0, true, true),
            (f64::NAN, 10.0, true, true),
        ] {
            assert_eq!(is_sure(from, to, None, Modulo::AsSetUp), as_set_up, "{from} {to}");
            assert_eq!(is_sure(from, to, Some(true), Modulo::Shorter), shorter, "{from} {to}");
            let either = shorter && is_sure(from, to, None, Modulo::BySign);
            assert_eq!(is_sure(from, to, None, Modulo::ShorterOrBySign), either, "{from} {to}");
            assert!(is_sure(from, to, Some(false), Modulo::AsSetUp), "{from} {to}");
        }
    }

    /// LinuxCNC, INI file, `WRAPPED_ROTARY`: A, B, C go to 0° to 359.999°, and the sign is the direction. From 10° to -20 by
    /// -350°, not by -30°.
    #[test]
    fn by_its_sign_a_position_names_the_direction() {
        for (from, to, sure) in [
            (10.0, 40.0, true),
            (10.0, 300.0, true),
            (350.0, 370.0, true),
            (40.0, 10.0, false),
            (10.0, -20.0, false),
            (-10.0, -20.0, false),
            (0.0, -360.0, false),
            (20.0, -20.0, false),
            (-30.0, 10.0, true),
        ] {
            assert_eq!(is_sure(from, to, None, Modulo::BySign), sure, "{from} {to}");
        }
        // From 30° to the place of -20, which is 20°, against the clock: by -10°, and plainly by -50°.
        assert!(!is_sure(30.0, -20.0, Some(true), Modulo::BySign));
    }
}
