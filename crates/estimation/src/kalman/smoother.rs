//! Fixed-interval smoother: the states of a system given all readings, earlier and later.
//!
//! Source: Bryson and Frazier (1963), whose smoother inverts no matrix.

use super::{GAIN_TOLERANCE, KalmanFilter, LinearSystem, SensorReading, StateSensor, congruence, identity};

/// Smoother of a system: the filter with the predicted covariance of every gain.
#[derive(Debug, Clone)]
pub struct KalmanSmoother<const N: usize> {
    /// Filter that gives the innovations.
    pub filter: KalmanFilter<N>,
    /// Predicted covariance of the state before the reading, for every gain.
    predicted: Vec<[[f64; N]; N]>,
}

impl<const N: usize> KalmanSmoother<N> {
    /// Smoother of a system.
    pub fn new(system: LinearSystem<N>) -> Self {
        let mut predicted = Vec::new();
        let filter = KalmanFilter::visiting(system, GAIN_TOLERANCE, |covariance| predicted.push(*covariance));
        Self { filter, predicted }
    }

    /// Predicted state and innovation of every reading; `forced(row)` is the state change by a known input in the step
    /// before the row.
    fn run(&self, column: &[f64], forced: impl Fn(usize) -> [f64; N]) -> Vec<([f64; N], f64)> {
        let mut x = [0.0; N];
        let step = |(row, reading): (usize, &SensorReading)| {
            let (step, sensor) = (reading.step(), reading.sensor());
            if let Some(step) = step {
                let f = &self.filter.system.steps[step].transition;
                let added = forced(row);
                x = std::array::from_fn(|i| (0..N).map(|j| f[i][j] * x[j]).sum::<f64>() + added[i]);
            }
            let predicted = x;
            let StateSensor { state, second_state, .. } = self.filter.system.sensors[sensor];
            let innovation =
                column[row] - predicted[state] - second_state.map_or(0.0, |second_state| predicted[second_state]);
            let gain = &self.filter.gains[self.filter.gain_of[row] as usize].gain;
            x.iter_mut().zip(gain).for_each(|(x, gain)| *x += gain * innovation);
            (predicted, innovation)
        };
        self.filter.system.readings.iter().enumerate().map(step).collect()
    }

    /// Innovations in units of their standard deviation; `forced(row)` is the state change by a known input in the step
    /// before the row.
    pub fn whitened(&self, column: &[f64], forced: impl Fn(usize) -> [f64; N]) -> Vec<f64> {
        let weight = |row: usize| self.filter.weights[self.filter.gain_of[row] as usize];
        self.run(column, forced).iter().enumerate().map(|(row, (_, innovation))| innovation * weight(row)).collect()
    }

    /// Smoothed state at every reading, x = x⁻ + P⁻ s with the predicted state x⁻, its covariance P⁻ and the score s of
    /// this and all later innovations; `forced` as in [`whitened`](Self::whitened).
    pub fn smoothed(&self, column: &[f64], forced: impl Fn(usize) -> [f64; N]) -> Vec<[f64; N]> {
        let mut states = self.run(column, forced);
        let mut score = [0.0; N];
        for (row, (state, innovation)) in states.iter_mut().enumerate().rev() {
            let index = self.filter.gain_of[row] as usize;
            let (gain, reading) = (&self.filter.gains[index], self.filter.system.readings[row]);
            let (step, sensor) = (reading.step(), reading.sensor());
            // Backwards through the correction by the reading.
            let through = *innovation / gain.variance - (0..N).map(|i| gain.gain[i] * score[i]).sum::<f64>();
            let StateSensor { state: first, second_state, .. } = self.filter.system.sensors[sensor];
            [Some(first), second_state].into_iter().flatten().for_each(|index| score[index] += through);
            let predicted = &self.predicted[index];
            *state = std::array::from_fn(|i| state[i] + (0..N).map(|j| predicted[i][j] * score[j]).sum::<f64>());
            if let Some(step) = step {
                let f = &self.filter.system.steps[step].transition;
                score = std::array::from_fn(|j| (0..N).map(|i| f[i][j] * score[i]).sum());
            }
        }
        states.into_iter().map(|(state, _)| state).collect()
    }

    /// Smoothed variance of one state at every reading: diagonal element of P⁻ − P⁻ Λ P⁻ with the predicted covariance
    /// P⁻ and the covariance Λ of the score.
    pub fn variances(&self, state: usize) -> Vec<f64> {
        let mut information = [[0.0; N]; N];
        let mut variances = vec![0.0; self.filter.gain_of.len()];
        for row in (0..variances.len()).rev() {
            let index = self.filter.gain_of[row] as usize;
            let (gain, reading) = (&self.filter.gains[index], self.filter.system.readings[row]);
            let (step, sensor) = (reading.step(), reading.sensor());
            let StateSensor { state: first, second_state, .. } = self.filter.system.sensors[sensor];
            let seen = |k: usize| f64::from(u8::from(k == first)) + f64::from(u8::from(Some(k) == second_state));
            let unit = identity::<N>();
            // Transpose of A = I − K H, with the gain K and the sensor H, because Λ becomes Aᵀ Λ A + Hᵀ H/S.
            let through: [[f64; N]; N] =
                std::array::from_fn(|i| std::array::from_fn(|j| unit[i][j] - gain.gain[j] * seen(i)));
            information = congruence(&through, &information);
            for (i, row) in information.iter_mut().enumerate() {
                row.iter_mut().enumerate().for_each(|(j, x)| *x += seen(i) * seen(j) / gain.variance);
            }
            let column = &self.predicted[index][state];
            let square: f64 =
                (0..N).map(|i| column[i] * (0..N).map(|j| information[i][j] * column[j]).sum::<f64>()).sum();
            variances[row] = (column[state] - square).max(0.0);
            if let Some(step) = step {
                let f = &self.filter.system.steps[step].transition;
                let back: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| f[j][i]));
                information = congruence(&back, &information);
            }
        }
        variances
    }
}
