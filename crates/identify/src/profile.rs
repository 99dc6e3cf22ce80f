//! Profiled sum of squares of a first-order fit, a function of 1/T alone.
//!
//! For a given 1/T the other unknowns are linear: the anchor of every trial is eliminated by orthogonal projection, b
//! and b δ_r follow from two normal equations over all trials. The same projections give the exact step in 1/T, the
//! Fisher information and the scores. Work space is allocated once. Sources: variable projection, Golub and Pereyra
//! (1973); its step, Kaufman (1975).

use estimation::column::{ColumnProjection, dot, gram, subtract_projection, sum};
use nalgebra::{Matrix2, Matrix3, Vector2};
use ship::first_order::YawState;

use crate::likelihood::track::{MotionCoefficients, MotionColumns, TrialSignals};

/// Workspace of one trial: columns after projection on the complement of (1, φ₁).
#[derive(Debug)]
struct TrialColumns {
    signals: TrialSignals,
    columns: MotionColumns,
    /// Mean and length of φ₁ before it became a unit column.
    homogeneous: (f64, f64),
    /// Components of G, H and the heading that were projected out.
    removed: [ColumnProjection; 3],
    /// Heading, projected.
    heading: Vec<f64>,
    /// ∂ψ/∂a, projected.
    sensitivity: Vec<f64>,
    /// Measured minus fitted heading.
    residual: Vec<f64>,
}

/// Profiled sum of squares and the fit at the last evaluated point.
#[derive(Debug)]
pub(crate) struct Profile {
    parts: Vec<TrialColumns>,
    /// b (1/s²) and b δ_r (rad/s²).
    steering: Vector2<f64>,
    /// Last evaluated 1/T (1/s) and the sum of squares there (rad²), `None` as for
    /// [`residual_sum_of_squares_at`](Self::residual_sum_of_squares_at).
    last: Option<(f64, Option<f64>)>,
    /// Number of evaluations.
    pub evaluations: usize,
}

/// Step of 1/T by variable projection (Kaufman 1975).
#[derive(Debug, Clone, Copy)]
pub(crate) struct GaussNewtonStep {
    /// Change of 1/T, 1/s.
    pub change: f64,
    /// Predicted decrease of the sum of squares, rad².
    pub predicted_decrease: f64,
}

impl Profile {
    pub fn new(trial_signals: Vec<TrialSignals>) -> Self {
        let parts = trial_signals
            .into_iter()
            .map(|signals| {
                let rows = signals.len();
                TrialColumns {
                    signals,
                    columns: MotionColumns::default(),
                    homogeneous: (0.0, 0.0),
                    removed: [ColumnProjection::default(); 3],
                    heading: vec![0.0; rows],
                    sensitivity: Vec::new(),
                    residual: vec![0.0; rows],
                }
            })
            .collect();
        Self { parts, steering: Vector2::zeros(), last: None, evaluations: 0 }
    }

    /// Sum of squares (rad²) of the best fit of a ship with this 1/T; `None` if the columns are dependent or b ≤ 0.
    pub fn residual_sum_of_squares_at(&mut self, inverse_T: f64) -> Option<f64> {
        match self.last {
            Some((point, rss)) if point == inverse_T => rss,
            _ => {
                self.evaluations += 1;
                let rss = self.fit(inverse_T);
                self.last = Some((inverse_T, rss));
                rss
            }
        }
    }

    fn fit(&mut self, inverse_T: f64) -> Option<f64> {
        let (mut products, mut moment) = (Matrix2::zeros(), Vector2::zeros());
        for part in &mut self.parts {
            part.project_columns(inverse_T);
            part.project_heading();
            let [[gg, gh, gy], [_, hh, hy], _] = gram([&part.columns.rudder, &part.columns.constant, &part.heading]);
            products += Matrix2::new(gg, gh, gh, hh);
            moment += Vector2::new(gy, hy);
        }
        self.steering = solve2(&products, &moment)?;
        let [b, q] = self.steering.into();
        let mut rss = 0.0;
        for part in &mut self.parts {
            let columns = part.columns.rudder.iter().zip(&part.columns.constant);
            for (residual, (psi, (g, h))) in part.residual.iter_mut().zip(part.heading.iter().zip(columns)) {
                *residual = psi - b * g - q * h;
            }
            rss += dot(&part.residual, &part.residual);
        }
        (rss.is_finite() && b > 0.0).then_some(rss)
    }

    /// Kaufman's step of 1/T from the last evaluated point.
    pub fn gauss_newton_step(&mut self, inverse_T: f64) -> GaussNewtonStep {
        let information = self.information(inverse_T);
        let score: f64 = self.parts.iter().map(|part| dot(&part.sensitivity, &part.residual)).sum();
        let products = Matrix2::new(information[(1, 1)], information[(1, 2)], information[(2, 1)], information[(2, 2)]);
        let cross = Vector2::new(information[(0, 1)], information[(0, 2)]);
        let explained = solve2(&products, &cross).map_or(0.0, |share| share.dot(&cross));
        let curvature = information[(0, 0)] - explained;
        let by = if curvature > 0.0 { score / curvature } else { 0.0 };
        GaussNewtonStep { change: by, predicted_decrease: by * score }
    }

    /// JᵀJ of (1/T, b, b δ_r) with the anchors eliminated, at the last evaluated point; times 1/σ² it is the Fisher
    /// information.
    pub fn information(&mut self, inverse_T: f64) -> Matrix3<f64> {
        let [b, q] = self.steering.into();
        let mut information = Matrix3::zeros();
        for part in &mut self.parts {
            information += part.information(inverse_T, &part.coefficients(b, q));
        }
        information
    }

    /// Scores of (1/T, b, b δ_r), trial by trial: columns of the projected Jacobian times the residual, at the point of
    /// the last call of [`information`](Self::information).
    pub fn into_scores(self) -> Vec<[Vec<f64>; 3]> {
        let trial_scores = |part: TrialColumns| {
            let mut columns = [part.sensitivity, part.columns.rudder, part.columns.constant];
            columns.iter_mut().for_each(|column| column.iter_mut().zip(&part.residual).for_each(|(x, e)| *x *= e));
            columns
        };
        self.parts.into_iter().map(trial_scores).collect()
    }

    /// Residuals, trial by trial.
    pub fn residuals(&self) -> impl Iterator<Item = &[f64]> + Clone {
        self.parts.iter().map(|part| part.residual.as_slice())
    }

    /// b = K/T (1/s²) and b δ_r (rad/s²) of the last evaluated point.
    pub fn K_over_T_and_offset(&self) -> (f64, f64) {
        (self.steering[0], self.steering[1])
    }

    /// Number of trials.
    pub fn trial_count(&self) -> usize {
        self.parts.len()
    }

    /// Number of observed headings of all trials.
    pub fn heading_count(&self) -> usize {
        self.parts.iter().map(|part| part.heading.len()).sum()
    }

    /// Σ(ψ − mean)² over all trials, rad².
    pub fn total_sum_of_squares(&self) -> f64 {
        let trial_squares = |part: &TrialColumns| {
            let heading = &part.signals.heading;
            let mean = sum(heading) / heading.len() as f64;
            heading.iter().map(|psi| (psi - mean).powi(2)).sum::<f64>()
        };
        self.parts.iter().map(trial_squares).sum()
    }
}

impl TrialColumns {
    fn project_columns(&mut self, inverse_T: f64) {
        self.signals.fill_columns(inverse_T, &mut self.columns);
        let MotionColumns { homogeneous, rudder, constant, .. } = &mut self.columns;
        let mean = sum(homogeneous) / homogeneous.len() as f64;
        homogeneous.iter_mut().for_each(|x| *x -= mean);
        let length = dot(homogeneous, homogeneous).sqrt();
        if length > 0.0 {
            homogeneous.iter_mut().for_each(|x| *x /= length);
        }
        self.homogeneous = (mean, length);
        self.removed[0] = subtract_projection(homogeneous, rudder);
        self.removed[1] = subtract_projection(homogeneous, constant);
    }

    fn project_heading(&mut self) {
        self.heading.copy_from_slice(&self.signals.heading);
        self.removed[2] = subtract_projection(&self.columns.homogeneous, &mut self.heading);
    }

    /// Information XᵀX of (1/T, b, b δ_r), with the columns ∂ψ/∂a, G and H projected off the initial state.
    fn information(&mut self, inverse_T: f64, coefficients: &MotionCoefficients) -> Matrix3<f64> {
        self.signals.sensitivity(inverse_T, coefficients, &mut self.sensitivity);
        subtract_projection(&self.columns.homogeneous, &mut self.sensitivity);
        Matrix3::from(gram([&self.sensitivity, &self.columns.rudder, &self.columns.constant]))
    }

    /// Coefficients of the trial for given steering: the projected-out components give the anchor.
    fn coefficients(&self, K_over_T: f64, offset: f64) -> MotionCoefficients {
        let [rudder, constant, heading] = self.removed;
        let (mean, length) = self.homogeneous;
        // φ₁ = mean + length · unit.
        let along = heading.component - K_over_T * rudder.component - offset * constant.component;
        let yaw_rate = if length > 0.0 { along / length } else { 0.0 };
        let level = heading.mean - K_over_T * rudder.mean - offset * constant.mean;
        MotionCoefficients { anchor: YawState { heading: level - yaw_rate * mean, yaw_rate }, K_over_T, offset }
    }
}

/// Inverse of an [`information`](Profile::information) and the condition number of the Jacobian behind it, its columns
/// scaled. Fails with the condition number if it exceeds `limit`: the inverse is then dominated by rounding, and its
/// variances may be negative.
pub(crate) fn invert(information: &Matrix3<f64>, limit: f64) -> Result<(Matrix3<f64>, f64), f64> {
    let scale = information.diagonal().map(|value| value.sqrt().recip());
    let scaled = |matrix: &Matrix3<f64>| Matrix3::from_fn(|i, j| matrix[(i, j)] * scale[i] * scale[j]);
    let correlation = scaled(information);
    // For a column that vanished or overflowed the search for eigenvalues may not end.
    if correlation.iter().any(|value| !value.is_finite()) {
        return Err(f64::INFINITY);
    }
    let eigenvalues = correlation.symmetric_eigenvalues();
    let condition = (eigenvalues.max() / eigenvalues.min().max(0.0)).sqrt();
    if condition > limit {
        return Err(condition);
    }
    let inverse = correlation.cholesky().ok_or(condition)?.inverse();
    Ok((scaled(&inverse), condition))
}

/// Solves a symmetric positive definite 2 × 2 system after scaling; `None` if it is singular to rounding.
pub(crate) fn solve2(gram: &Matrix2<f64>, moment: &Vector2<f64>) -> Option<Vector2<f64>> {
    let scale = Vector2::new(gram[(0, 0)].sqrt().recip(), gram[(1, 1)].sqrt().recip());
    let cosine = gram[(0, 1)] * scale[0] * scale[1];
    let determinant = 1.0 - cosine * cosine;
    // NaN comes from a column that vanished.
    if determinant.is_nan() || determinant <= 1e-14 {
        return None;
    }
    let (m0, m1) = (moment[0] * scale[0], moment[1] * scale[1]);
    Some(Vector2::new((m0 - cosine * m1) / determinant * scale[0], (m1 - cosine * m0) / determinant * scale[1]))
}
