//! Conversions of degrees and knots to SI, for input and output.

/// Radians in one degree.
pub const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Metres per second in one knot (1852 m per hour).
pub const KNOT: f64 = 1852.0 / 3600.0;

/// Angle in radians, from an angle in degrees.
#[inline]
pub fn from_deg(angle_deg: f64) -> f64 {
    angle_deg * DEGREE
}

/// Angle in degrees, from an angle in radians.
#[inline]
pub fn to_deg(angle: f64) -> f64 {
    angle / DEGREE
}

/// Unwraps a heading (rad) in place: removes its jumps of 2π. Values that are not finite (missing) are skipped.
///
/// The first finite value is kept; every later value lies within π of the finite value before it.
pub fn unwrap_heading(heading: &mut [f64]) {
    let mut last: Option<f64> = None;
    for psi in heading.iter_mut().filter(|psi| psi.is_finite()) {
        if let Some(before) = last {
            *psi -= std::f64::consts::TAU * ((*psi - before) / std::f64::consts::TAU).round();
        }
        last = Some(*psi);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heading_is_continuous_across_north() {
        let mut heading: Vec<f64> = [350.0, 358.0, f64::NAN, 6.0, 20.0, 355.0].map(from_deg).to_vec();
        unwrap_heading(&mut heading);
        let deg: Vec<f64> = heading.iter().map(|&psi| to_deg(psi).round()).collect();
        assert_eq!(deg[..2], [350.0, 358.0]);
        assert!(deg[2].is_nan());
        assert_eq!(deg[3..], [366.0, 380.0, 355.0]);
    }
}
