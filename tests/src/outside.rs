//! What the outside estimator of the tests computes, so that a test can compute it without a process.

/// K (1/s), T (s) and δ_r (rad) of a record by least squares of T r' + r = K (δ + δ_r), integrated twice; rows without
/// a heading are left out. `None` where the equations are singular.
///
/// ψ = −1/T ∫ψ + K/T ∬δ + K δ_r/T t²/2 + c₁ t + c₀, integrals by trapezia.
pub fn least_squares(time: &[f64], heading: &[Option<f64>], rudder: &[f64]) -> Option<[f64; 3]> {
    let mut rows: Vec<[f64; 6]> = Vec::new();
    // Integrals of heading and rudder, and of the latter's.
    let (mut of_heading, mut once, mut twice) = (0.0, 0.0, 0.0);
    let mut last: Option<[f64; 3]> = None;
    for ((&t, heading), &delta) in time.iter().zip(heading).zip(rudder) {
        let Some(psi) = *heading else { continue };
        if let Some([t0, psi0, delta0]) = last {
            let (h, before) = (t - t0, once);
            of_heading += 0.5 * h * (psi + psi0);
            once += 0.5 * h * (delta + delta0);
            twice += 0.5 * h * (once + before);
        }
        last = Some([t, psi, delta]);
        rows.push([of_heading, twice, 0.5 * t * t, t, 1.0, psi]);
    }
    let mut equations = [[0.0; 6]; 5];
    for row in &rows {
        for (i, equation) in equations.iter_mut().enumerate() {
            equation.iter_mut().zip(row).for_each(|(sum, value)| *sum += row[i] * value);
        }
    }
    let [a, b, c, _, _] = solved(equations)?;
    Some([-b / a, -1.0 / a, c / b])
}

/// Five linear equations, each with its right side behind it.
fn solved(mut rows: [[f64; 6]; 5]) -> Option<[f64; 5]> {
    for pivot in 0..5 {
        let best = (pivot..5).max_by(|&i, &j| rows[i][pivot].abs().total_cmp(&rows[j][pivot].abs()))?;
        rows.swap(pivot, best);
        if rows[pivot][pivot] == 0.0 {
            return None;
        }
        let own = rows[pivot];
        let others = rows.iter_mut().enumerate().filter(|(i, _)| *i != pivot);
        for (_, row) in others {
            let factor = row[pivot] / own[pivot];
            row.iter_mut().zip(own).for_each(|(value, own)| *value -= factor * own);
        }
    }
    Some(std::array::from_fn(|i| rows[i][5] / rows[i][i]))
}
