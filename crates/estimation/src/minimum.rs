//! The lowest point of a function of one number.

/// Smallest value on a range: a grid, then golden sections about its lowest point.
pub fn minimum(lo: f64, hi: f64, points: usize, mut value: impl FnMut(f64) -> f64) -> (f64, f64) {
    let at = |k: usize| lo + (hi - lo) * k as f64 / points as f64;
    let heights: Vec<f64> = (0..=points).map(|k| value(at(k))).collect();
    let best = (0..=points).min_by(|&i, &j| heights[i].total_cmp(&heights[j])).unwrap_or(0);
    let (mut left, mut right) = (at(best.saturating_sub(1)), at((best + 1).min(points)));
    let mut found = (at(best), heights[best]);
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut one, mut two) = (right - golden * (right - left), left + golden * (right - left));
    let (mut f_one, mut f_two) = (value(one), value(two));
    for _ in 0..6 {
        for candidate in [(one, f_one), (two, f_two)] {
            if candidate.1 < found.1 {
                found = candidate;
            }
        }
        if f_one < f_two {
            (right, two, f_two) = (two, one, f_one);
            one = right - golden * (right - left);
            f_one = value(one);
        } else {
            (left, one, f_one) = (one, two, f_two);
            two = left + golden * (right - left);
            f_two = value(two);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_point_of_a_range_is_found_inside_and_at_its_ends() {
        let (place, value) = minimum(-1.0, 3.0, 12, |x| (x - 0.7).powi(2) - 2.0);
        assert!((place - 0.7).abs() < 0.02 && (value + 2.0).abs() < 1e-3, "{place}, {value}");
        assert_eq!(minimum(-1.0, 3.0, 12, |x| x).0, -1.0);
        assert_eq!(minimum(-1.0, 3.0, 12, |x| -x).0, 3.0);
        // Two valleys: the grid sees both.
        let (place, _) = minimum(-2.0, 2.0, 12, |x: f64| (x * x - 1.0).powi(2) + 0.3 * x);
        assert!((place + 1.0).abs() < 0.1, "{place}");
    }
}
