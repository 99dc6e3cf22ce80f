//! What a fit of all three degrees of freedom minimises.

use nalgebra::{DMatrix, DVector};

use super::coefficients::{BOUNDS, COEFFICIENTS, Coefficients, TYPICAL};
use super::course::{Course, OUTPUTS};
use super::hull::HULL_COEFFICIENTS;
use super::search::{Local, Squares};
use super::yaw::{YAW_BOUNDS, Yaw};

/// Windows with the weights of their outputs.
pub(crate) struct Windows<'a> {
    pub courses: Vec<&'a Course>,
    /// Surge and sway as measured; only the yaw equation is searched.
    pub driven: bool,
    pub deviations: [f64; OUTPUTS],
}

impl Windows<'_> {
    /// All windows: record and number of the window.
    pub fn places(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.courses.iter().enumerate().flat_map(|(index, course)| (0..course.windows.len()).map(move |w| (index, w)))
    }

    fn coefficients(at: &[f64]) -> Coefficients {
        Coefficients::from_array(std::array::from_fn(|i| at[i]))
    }

    /// Residuals of one window over their deviations, row by row.
    pub fn residuals(&self, (index, window): (usize, usize), at: &[f64]) -> Vec<f64> {
        let course = self.courses[index];
        let yaw = Yaw::from_array(std::array::from_fn(|i| at[COEFFICIENTS + i]));
        let [first, last] = course.windows[window];
        let found = course.replay(&Self::coefficients(at), &yaw, [first, last], self.driven);
        let outputs = if self.driven { 2 } else { OUTPUTS };
        let mut residuals = Vec::with_capacity(found.len() * outputs);
        for (row, state) in (first..=last).zip(&found) {
            for (output, value) in state.iter().enumerate().take(outputs) {
                let reading = course.readings[output][row];
                let residual = (value - reading) / self.deviations[output];
                residuals.push(if reading.is_finite() { residual } else { 0.0 });
            }
        }
        residuals
    }

    /// Residuals of one window and their derivatives by the unknowns that are not fixed: forward differences, backward
    /// ones at an upper bound.
    pub fn derivatives(&self, place: (usize, usize), at: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let here = self.residuals(place, at);
        let by = |unknown: usize| {
            let [_, most] = self.bounds(unknown);
            if self.driven && unknown < COEFFICIENTS {
                return vec![0.0; here.len()];
            }
            let typical = TYPICAL.to_array().get(unknown).copied().unwrap_or(0.1);
            let step = 1e-6 * at[unknown].abs().max(typical);
            let step = if at[unknown] + step > most { -step } else { step };
            let mut moved = at.to_vec();
            moved[unknown] += step;
            self.residuals(place, &moved).iter().zip(&here).map(|(there, here)| (there - here) / step).collect()
        };
        let slopes = (0..HULL_COEFFICIENTS).map(by).collect();
        (here, slopes)
    }

    /// Root mean squares of the residuals in units of L and U₀, kind by kind.
    pub fn rms(&self, at: &[f64]) -> [f64; OUTPUTS] {
        let outputs = if self.driven { 2 } else { OUTPUTS };
        let mut squares = [0.0; OUTPUTS];
        let mut counts = [0.0; OUTPUTS];
        for place in self.places() {
            let residuals = self.residuals(place, at);
            for (i, residual) in residuals.iter().enumerate().filter(|(_, residual)| **residual != 0.0) {
                squares[i % outputs] += residual * residual;
                counts[i % outputs] += 1.0;
            }
        }
        std::array::from_fn(|i| (squares[i] / f64::max(counts[i], 1.0)).sqrt() * self.deviations[i])
    }
}

impl Squares for Windows<'_> {
    fn square(&self, at: &DVector<f64>) -> f64 {
        let of = |place| self.residuals(place, at.as_slice()).iter().map(|x| x * x).sum::<f64>();
        self.places().map(of).sum()
    }

    fn local(&self, at: &DVector<f64>) -> Local {
        let unknowns = HULL_COEFFICIENTS;
        let mut normal = DMatrix::zeros(unknowns, unknowns);
        let mut gradient = DVector::zeros(unknowns);
        let mut square = 0.0;
        let dot = |x: &[f64], y: &[f64]| -> f64 { x.iter().zip(y).map(|(x, y)| x * y).sum() };
        for place in self.places() {
            let (residuals, slopes) = self.derivatives(place, at.as_slice());
            square += dot(&residuals, &residuals);
            for i in 0..unknowns {
                gradient[i] += dot(&slopes[i], &residuals);
                for j in 0..=i {
                    let product = dot(&slopes[i], &slopes[j]);
                    normal[(i, j)] += product;
                    if i != j {
                        normal[(j, i)] += product;
                    }
                }
            }
        }
        Local { normal, gradient, square }
    }

    fn bounds(&self, unknown: usize) -> [f64; 2] {
        match unknown.checked_sub(COEFFICIENTS) {
            None => BOUNDS[unknown],
            Some(own) => YAW_BOUNDS[own],
        }
    }
}
