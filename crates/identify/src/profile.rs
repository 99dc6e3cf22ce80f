//! The sum of squares of a first-order fit as a function of 1/T alone.
//!
//! Given 1/T everything else is linear: the anchor of every trial is eliminated by orthogonal projection, b and b δ_r
//! follow from two normal equations over all trials. The same projections give the exact step in 1/T, the Fisher
//! information and the scores. Work space is allocated once.

use nalgebra::{Matrix2, Matrix3, Vector2};
use ship::first_order::State;

use crate::track::{Coefficients, Columns, Track};

/// Workspace of one trial: columns after projection on the complement of (1, φ₁).
#[derive(Debug)]
struct Part {
    track: Track,
    columns: Columns,
    /// φ₁ less its mean, of unit length.
    homogeneous: Vec<f64>,
    /// Heading, projected.
    heading: Vec<f64>,
    /// ∂ψ/∂a, projected.
    sensitivity: Vec<f64>,
    /// Measured less fitted heading.
    residual: Vec<f64>,
}

/// The profiled sum of squares and everything at the point where it was last evaluated.
#[derive(Debug)]
pub(crate) struct Profile {
    parts: Vec<Part>,
    steering: Vector2<f64>,
    evaluations: usize,
}

impl Profile {
    pub fn new(tracks: Vec<Track>) -> Self {
        let parts = tracks
            .into_iter()
            .map(|track| {
                let rows = track.len();
                Part {
                    track,
                    columns: Columns::default(),
                    homogeneous: vec![0.0; rows],
                    heading: vec![0.0; rows],
                    sensitivity: vec![0.0; rows],
                    residual: vec![0.0; rows],
                }
            })
            .collect();
        Self { parts, steering: Vector2::zeros(), evaluations: 0 }
    }

    /// Sum of squares (rad²) of the best fit of a ship with this 1/T; `None` when the columns are dependent or b ≤ 0.
    pub fn evaluate(&mut self, inverse_time: f64) -> Option<f64> {
        let rss = self.fit(inverse_time)?;
        (self.steering[0] > 0.0).then_some(rss)
    }

    /// The same for whatever b is.
    pub fn fit(&mut self, inverse_time: f64) -> Option<f64> {
        self.evaluations += 1;
        let (mut gram, mut moment) = (Matrix2::zeros(), Vector2::zeros());
        for part in &mut self.parts {
            part.project_columns(inverse_time);
            part.project_heading();
            let (g, h) = (&part.columns.rudder, &part.columns.constant);
            let gh = dot(g, h);
            gram += Matrix2::new(dot(g, g), gh, gh, dot(h, h));
            moment += Vector2::new(dot(g, &part.heading), dot(h, &part.heading));
        }
        self.steering = solve2(&gram, &moment)?;
        let mut rss = 0.0;
        for part in &mut self.parts {
            let (b, q) = (self.steering[0], self.steering[1]);
            for (k, residual) in part.residual.iter_mut().enumerate() {
                *residual = part.heading[k] - b * part.columns.rudder[k] - q * part.columns.constant[k];
            }
            rss += dot(&part.residual, &part.residual);
        }
        rss.is_finite().then_some(rss)
    }

    /// Kaufman's step of 1/T from the point last evaluated.
    pub fn newton_step(&mut self, inverse_time: f64) -> f64 {
        let information = self.information(inverse_time);
        let score: f64 = self.parts.iter().map(|part| dot(&part.sensitivity, &part.residual)).sum();
        let gram = Matrix2::new(information[(1, 1)], information[(1, 2)], information[(2, 1)], information[(2, 2)]);
        let cross = Vector2::new(information[(0, 1)], information[(0, 2)]);
        let explained = solve2(&gram, &cross).map_or(0.0, |share| share.dot(&cross));
        let curvature = information[(0, 0)] - explained;
        if curvature > 0.0 { score / curvature } else { 0.0 }
    }

    /// JᵀJ of (1/T, b, b δ_r) with the anchors eliminated, at the point last evaluated; times 1/σ² it is the Fisher
    /// information.
    pub fn information(&mut self, inverse_time: f64) -> Matrix3<f64> {
        let coefficients: Vec<Coefficients> =
            self.parts.iter().map(|part| part.coefficients(inverse_time, self.steering[0], self.steering[1])).collect();
        self.accumulate(inverse_time, &coefficients)
    }

    /// The same at given coefficients, one set a trial, whatever the headings are; `None` when it is not finite.
    pub fn information_at(&mut self, inverse_time: f64, coefficients: &[Coefficients]) -> Option<Matrix3<f64>> {
        for part in &mut self.parts {
            part.project_columns(inverse_time);
        }
        let information = self.accumulate(inverse_time, coefficients);
        information.iter().all(|value| value.is_finite()).then_some(information)
    }

    fn accumulate(&mut self, inverse_time: f64, coefficients: &[Coefficients]) -> Matrix3<f64> {
        let mut information = Matrix3::zeros();
        for (part, coefficients) in self.parts.iter_mut().zip(coefficients) {
            let Part { track, sensitivity, homogeneous, columns, .. } = part;
            track.sensitivity(inverse_time, coefficients, sensitivity);
            project(homogeneous, sensitivity);
            let all = [sensitivity.as_slice(), &columns.rudder, &columns.constant];
            for i in 0..3 {
                for j in i..3 {
                    let product = dot(all[i], all[j]);
                    information[(i, j)] += product;
                    if i != j {
                        information[(j, i)] += product;
                    }
                }
            }
        }
        information
    }

    /// Residual times projected Jacobian row, trial by trial; after [`information`](Self::information).
    pub fn scores(&self) -> Vec<Vec<[f64; 3]>> {
        self.parts
            .iter()
            .map(|part| {
                (0..part.residual.len())
                    .map(|k| {
                        [part.sensitivity[k], part.columns.rudder[k], part.columns.constant[k]]
                            .map(|x| x * part.residual[k])
                    })
                    .collect()
            })
            .collect()
    }

    /// Residuals, trial by trial.
    pub fn residuals(&self) -> impl Iterator<Item = &[f64]> + Clone {
        self.parts.iter().map(|part| part.residual.as_slice())
    }

    /// (b, b δ_r) of the point last evaluated.
    pub fn steering(&self) -> (f64, f64) {
        (self.steering[0], self.steering[1])
    }

    /// Observed headings of all trials.
    pub fn observations(&self) -> usize {
        self.parts.iter().map(|part| part.heading.len()).sum()
    }

    /// Number of evaluations so far.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Σ(ψ − mean)² over all trials, rad².
    pub fn total_sum_of_squares(&self) -> f64 {
        self.parts
            .iter()
            .map(|part| {
                let heading = &part.track.heading;
                let mean = heading.iter().sum::<f64>() / heading.len() as f64;
                heading.iter().map(|psi| (psi - mean).powi(2)).sum::<f64>()
            })
            .sum()
    }
}

impl Part {
    fn project_columns(&mut self, inverse_time: f64) {
        self.track.fill(inverse_time, &mut self.columns);
        self.homogeneous.copy_from_slice(&self.columns.homogeneous);
        subtract_mean(&mut self.homogeneous);
        let length = dot(&self.homogeneous, &self.homogeneous).sqrt();
        if length > 0.0 {
            self.homogeneous.iter_mut().for_each(|x| *x /= length);
        }
        project(&self.homogeneous, &mut self.columns.rudder);
        project(&self.homogeneous, &mut self.columns.constant);
    }

    fn project_heading(&mut self) {
        self.heading.copy_from_slice(&self.track.heading);
        project(&self.homogeneous, &mut self.heading);
    }

    /// Coefficients of the track for given steering: the anchor is what the projections took out.
    fn coefficients(&self, inverse_time: f64, gain: f64, offset: f64) -> Coefficients {
        let free = Coefficients { anchor: State::default(), gain, offset };
        let forced = self.track.simulate(inverse_time, &free);
        let rest: Vec<f64> =
            self.track.observed().zip(&self.track.heading).map(|(row, psi)| psi - forced[row].heading).collect();
        let along = dot(&self.homogeneous, &rest);
        // φ₁ = mean + length · unit: the length is φ₁ · unit, because the unit column has no mean.
        let length = dot(&self.columns.homogeneous, &self.homogeneous);
        let yaw_rate = if length > 0.0 { along / length } else { 0.0 };
        let rows = rest.len() as f64;
        let mean = |values: &[f64]| values.iter().sum::<f64>() / rows;
        let heading = mean(&rest) - yaw_rate * mean(&self.columns.homogeneous);
        Coefficients { anchor: State { heading, yaw_rate }, ..free }
    }
}

/// Inverse of an [`information`](Profile::information) and the condition number of the Jacobian behind it, its columns
/// scaled. The error is the condition number where it exceeds `limit`: the digits of the inverse are then rounding, and
/// what it calls a variance may be negative.
pub(crate) fn invert(information: &Matrix3<f64>, limit: f64) -> Result<(Matrix3<f64>, f64), f64> {
    let scale = information.diagonal().map(|value| value.sqrt().recip());
    let scaled = |matrix: &Matrix3<f64>| Matrix3::from_fn(|i, j| matrix[(i, j)] * scale[i] * scale[j]);
    let correlation = scaled(information);
    // A column that vanished or overflowed; the search for eigenvalues need not end.
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

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

fn subtract_mean(column: &mut [f64]) {
    let mean = column.iter().sum::<f64>() / column.len() as f64;
    column.iter_mut().for_each(|x| *x -= mean);
}

/// Takes the constant and `unit` (of unit length, zero mean) out of a column.
fn project(unit: &[f64], column: &mut [f64]) {
    subtract_mean(column);
    let share = dot(unit, column);
    column.iter_mut().zip(unit).for_each(|(x, u)| *x -= share * u);
}

/// Solves a symmetric positive definite 2 × 2 system after scaling; `None` when it is singular to rounding.
fn solve2(gram: &Matrix2<f64>, moment: &Vector2<f64>) -> Option<Vector2<f64>> {
    let scale = Vector2::new(gram[(0, 0)].sqrt().recip(), gram[(1, 1)].sqrt().recip());
    let cosine = gram[(0, 1)] * scale[0] * scale[1];
    let determinant = 1.0 - cosine * cosine;
    // NaN is a column that vanished.
    if determinant.is_nan() || determinant <= 1e-14 {
        return None;
    }
    let (m0, m1) = (moment[0] * scale[0], moment[1] * scale[1]);
    Some(Vector2::new((m0 - cosine * m1) / determinant * scale[0], (m1 - cosine * m0) / determinant * scale[1]))
}
