//! Minimum of a function of one variable.
//!
//! Source: Kiefer (1953), Proceedings of the American Mathematical Society 4:502-506, for the golden section.

/// Argument and value of the minimum on [lo, hi]: a grid of `points` intervals, then six golden sections about the grid
/// point of the least value.
pub fn golden_section_minimum(lo: f64, hi: f64, points: usize, mut value: impl FnMut(f64) -> f64) -> (f64, f64) {
    let at = |k: usize| lo + (hi - lo) * k as f64 / points as f64;
    let heights: Vec<f64> = (0..=points).map(|k| value(at(k))).collect();
    let best = (0..=points).min_by(|&i, &j| heights[i].total_cmp(&heights[j])).unwrap_or(0);
    let (mut left, mut right) = (at(best.saturating_sub(1)), at((best + 1).min(points)));
    let mut lowest = (at(best), heights[best]);
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut inner_left, mut inner_right) = (right - golden * (right - left), left + golden * (right - left));
    let (mut value_left, mut value_right) = (value(inner_left), value(inner_right));
    for _ in 0..6 {
        for candidate in [(inner_left, value_left), (inner_right, value_right)] {
            if candidate.1 < lowest.1 {
                lowest = candidate;
            }
        }
        if value_left < value_right {
            (right, inner_right, value_right) = (inner_right, inner_left, value_left);
            inner_left = right - golden * (right - left);
            value_left = value(inner_left);
        } else {
            (left, inner_left, value_left) = (inner_left, inner_right, value_right);
            inner_right = left + golden * (right - left);
            value_right = value(inner_right);
        }
    }
    lowest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_point_of_a_range_is_found_inside_and_at_its_ends() {
        let (place, value) = golden_section_minimum(-1.0, 3.0, 12, |x| (x - 0.7).powi(2) - 2.0);
        assert!((place - 0.7).abs() < 0.02 && (value + 2.0).abs() < 1e-3, "{place}, {value}");
        assert_eq!(golden_section_minimum(-1.0, 3.0, 12, |x| x).0, -1.0);
        assert_eq!(golden_section_minimum(-1.0, 3.0, 12, |x| -x).0, 3.0);
        // Two minima: the grid contains both.
        let (place, _) = golden_section_minimum(-2.0, 2.0, 12, |x: f64| (x * x - 1.0).powi(2) + 0.3 * x);
        assert!((place + 1.0).abs() < 0.1, "{place}");
    }
}
