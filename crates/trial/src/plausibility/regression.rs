//! Regressions for the checks of signs and units. They use integrals of the recorded signals, so that noise is smoothed
//! and no derivative is required.
//!
//! Source: Frisch & Waugh (1933), Partial time regressions as compared with individual trends, Econometrica 1(4).

use nalgebra::DMatrix;

use crate::record::{Trial, integrate};

/// Maximum number of rows of a regression; longer records are thinned after integration.
const MAX_ROWS: usize = 2000;

/// Slope of a response on a regressor, with nuisance signals projected out of both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PartialSlope {
    /// Slope: units of the response per unit of the regressor.
    pub value: f64,
    /// Explained share of the sum of squares that remains after the projection, 0 to 1.
    pub share: f64,
}

/// b = K/T (1/s²) of the first-order response by regression on integrals.
///
/// ψ = c₀ + c₁ t + c₂ t²/2 − a ∫ψ + b ∬δ, over the rows with a heading; linear, so initial heading, initial yaw rate
/// and rudder bias may be unknown. `None` without residual variance, or if numbers overflow.
pub(crate) fn first_order_gain(trial: &Trial) -> Option<PartialSlope> {
    let (time, psi, delta) = (trial.time(), trial.heading(), trial.rudder());
    let (mut once, mut twice) = (0.0, vec![0.0]);
    for i in 1..time.len() {
        // Exact for a rudder that is linear between rows.
        let h = time[i] - time[i - 1];
        twice.push(twice[i - 1] + (h * once + h * h * (2.0 * delta[i - 1] + delta[i]) / 6.0));
        once += 0.5 * h * (delta[i - 1] + delta[i]);
    }
    let heading = integrate(time, psi);
    let observed = (0..time.len()).filter(|&i| psi[i].is_finite());
    let row = |i: usize| {
        let t = time[i] - time[0];
        [1.0, t, t * t, heading[i], twice[i], psi[i]]
    };
    partial_slope(thinned(observed).map(row).collect())
}

/// Steady-turn estimate of K (1/s), ∫δ dψ / ∫δ² dt, with the share of ∫|δ dψ| of that sign. `None` without a rudder
/// angle or a change of heading.
pub(crate) fn steady_turn_gain(trial: &Trial) -> Option<PartialSlope> {
    let (time, psi, delta) = (trial.time(), trial.heading(), trial.rudder());
    let mut seen = (0..time.len()).filter(|&i| psi[i].is_finite());
    let (mut with, mut against, mut square) = (0.0, 0.0, 0.0);
    let mut from = seen.next()?;
    for to in seen {
        let rudder = 0.5 * (delta[from] + delta[to]);
        let work = rudder * (psi[to] - psi[from]);
        if work > 0.0 {
            with += work
        } else {
            against -= work
        }
        square += rudder * rudder * (time[to] - time[from]);
        from = to;
    }
    let share = f64::max(with, against) / (with + against);
    Some(PartialSlope { value: (with - against) / square, share })
        .filter(|slope| slope.value.is_finite() && slope.share.is_finite())
}

/// Slope of the heading on the integral of the yaw rate: 1 if both agree in unit and sign.
///
/// ψ = c₀ + c₁ t + s ∫r, over the rows with both; c₁ absorbs a bias of the rate. `None` without a recorded yaw rate,
/// with headings integrated from it, for at most four rows, if c₀ + c₁ t explains ψ or ∫r fully, and if numbers
/// overflow.
pub(super) fn heading_on_yaw_rate(trial: &Trial) -> Option<PartialSlope> {
    if trial.is_heading_integrated() {
        return None;
    }
    let (time, psi, rate) = (trial.time(), trial.heading(), trial.yaw_rate()?);
    let integral = integrate(time, rate);
    let both = (0..time.len()).filter(|&i| psi[i].is_finite() && rate[i].is_finite());
    partial_slope(thinned(both).map(|i| [1.0, time[i] - time[0], integral[i], psi[i]]).collect())
}

/// Every n-th row of a range, at most [`MAX_ROWS`].
pub(crate) fn thinned(rows: impl Iterator<Item = usize> + Clone) -> impl Iterator<Item = usize> {
    let every = rows.clone().count() / MAX_ROWS + 1;
    rows.step_by(every)
}

/// Partial slope of the last column on the last but one, with all other columns projected out of both (Frisch & Waugh
/// 1933): the last entries of R in the QR decomposition of the columns. `None` for at most N rows, if the other columns
/// explain either of the two fully, and if numbers overflow.
pub(crate) fn partial_slope<const N: usize>(rows: Vec<[f64; N]>) -> Option<PartialSlope> {
    let columns = DMatrix::from_row_iterator(rows.len(), N, rows.iter().flatten().copied());
    let before: Vec<f64> = columns.column_iter().map(|column| column.norm()).collect();
    if rows.len() <= N || !before.iter().all(|norm| norm.is_finite()) {
        return None;
    }
    let corner = columns.qr().unpack_r();
    let (x, along, across) = (corner[(N - 2, N - 2)], corner[(N - 2, N - 1)], corner[(N - 1, N - 1)]);
    let y = along.hypot(across);
    let noticeable = |left: f64, before: f64| left.abs() > 1e-9 * before;
    (noticeable(x, before[N - 2]) && noticeable(y, before[N - 1]))
        .then(|| PartialSlope { value: along / x, share: (along / y).powi(2) })
        .filter(|slope| slope.value.is_finite() && slope.share.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_is_found_beside_nuisance_signals() {
        let rows: Vec<[f64; 4]> = (0..50)
            .map(|i| {
                let t = f64::from(i);
                let x = (0.3 * t).sin();
                [1.0, t, x, 7.0 - 0.2 * t - 2.5 * x]
            })
            .collect();
        let slope = partial_slope(rows).expect("the signals are rich");
        approx::assert_relative_eq!(slope.value, -2.5, max_relative = 1e-12);
        approx::assert_relative_eq!(slope.share, 1.0, max_relative = 1e-12);
    }

    #[test]
    fn nothing_is_claimed_where_nothing_is_left() {
        let collinear: Vec<[f64; 4]> =
            (0..50).map(|i| [1.0, f64::from(i), 3.0 - f64::from(i), f64::from(i % 7)]).collect();
        assert_eq!(partial_slope(collinear), None);
        assert_eq!(partial_slope(vec![[1.0, 0.0, 1.0, 1.0]; 3]), None);
        let overflow: Vec<[f64; 4]> =
            (0..50).map(|i| [1.0, f64::from(i), 1e200 * f64::from(i % 3), f64::from(i % 7)]).collect();
        assert_eq!(partial_slope(overflow), None);
    }
}
