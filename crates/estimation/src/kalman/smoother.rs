//! The states of a system given all that was read, before and after.
//!
//! Source: Bryson and Frazier (1963), whose smoother inverts no matrix.

use super::{Filter, Reading, SETTLED, Sensor, System, identity, sandwich};

/// The states of a system given all readings.
#[derive(Debug, Clone)]
pub struct Smoother<const N: usize> {
    /// The filter, which gives the innovations.
    pub filter: Filter<N>,
    /// Covariance of the state of every gain before the reading is known.
    predicted: Vec<[[f64; N]; N]>,
}

impl<const N: usize> Smoother<N> {
    /// The smoother of a system.
    pub fn new(system: System<N>) -> Self {
        let mut predicted = Vec::new();
        let filter = Filter::visiting(system, SETTLED, |covariance| predicted.push(*covariance));
        Self { filter, predicted }
    }

    /// Predicted state and innovation of every reading, where a known input adds `forced` to the state in the step
    /// before each.
    fn run(&self, column: &[f64], forced: impl Fn(usize) -> [f64; N]) -> Vec<([f64; N], f64)> {
        let mut x = [0.0; N];
        let step = |(row, &Reading { step, sensor }): (usize, &Reading)| {
            if let Some(step) = step {
                let f = &self.filter.system.steps[step].transition;
                let added = forced(row);
                x = std::array::from_fn(|i| (0..N).map(|j| f[i][j] * x[j]).sum::<f64>() + added[i]);
            }
            let predicted = x;
            let Sensor { state, beside, .. } = self.filter.system.sensors[sensor];
            let innovation = column[row] - predicted[state] - beside.map_or(0.0, |beside| predicted[beside]);
            let gain = &self.filter.gains[self.filter.of[row] as usize].gain;
            x.iter_mut().zip(gain).for_each(|(x, gain)| *x += gain * innovation);
            (predicted, innovation)
        };
        self.filter.system.readings.iter().enumerate().map(step).collect()
    }

    /// The innovations in units of their standard deviation.
    pub fn whitened(&self, column: &[f64], forced: impl Fn(usize) -> [f64; N]) -> Vec<f64> {
        let weight = |row: usize| self.filter.weights[self.filter.of[row] as usize];
        self.run(column, forced).iter().enumerate().map(|(row, (_, innovation))| innovation * weight(row)).collect()
    }

    /// The state at every reading given all of them: x = x⁻ + P⁻ s with the score s of all later innovations.
    pub fn smoothed(&self, column: &[f64], forced: impl Fn(usize) -> [f64; N]) -> Vec<[f64; N]> {
        let mut states = self.run(column, forced);
        let mut score = [0.0; N];
        for (row, (state, innovation)) in states.iter_mut().enumerate().rev() {
            let place = self.filter.of[row] as usize;
            let (own, Reading { step, sensor }) = (&self.filter.gains[place], self.filter.system.readings[row]);
            // Through the correction of the reading, then its own innovation.
            let through = *innovation / own.variance - (0..N).map(|i| own.gain[i] * score[i]).sum::<f64>();
            let Sensor { state: first, beside, .. } = self.filter.system.sensors[sensor];
            [Some(first), beside].into_iter().flatten().for_each(|place| score[place] += through);
            let predicted = &self.predicted[place];
            *state = std::array::from_fn(|i| state[i] + (0..N).map(|j| predicted[i][j] * score[j]).sum::<f64>());
            if let Some(step) = step {
                let f = &self.filter.system.steps[step].transition;
                score = std::array::from_fn(|j| (0..N).map(|i| f[i][j] * score[i]).sum());
            }
        }
        states.into_iter().map(|(state, _)| state).collect()
    }

    /// Variance of one state at every reading given all of them: V = P⁻ − P⁻ N P⁻ with the variance N of the score.
    pub fn variances(&self, state: usize) -> Vec<f64> {
        let mut information = [[0.0; N]; N];
        let mut variances = vec![0.0; self.filter.of.len()];
        for row in (0..variances.len()).rev() {
            let place = self.filter.of[row] as usize;
            let (own, Reading { step, sensor }) = (&self.filter.gains[place], self.filter.system.readings[row]);
            let Sensor { state: first, beside, .. } = self.filter.system.sensors[sensor];
            let seen = |k: usize| f64::from(u8::from(k == first)) + f64::from(u8::from(Some(k) == beside));
            let unit = identity::<N>();
            // Transposed, since N = Aᵀ N A.
            let through: [[f64; N]; N] =
                std::array::from_fn(|i| std::array::from_fn(|j| unit[i][j] - own.gain[j] * seen(i)));
            information = sandwich(&through, &information);
            for (i, row) in information.iter_mut().enumerate() {
                row.iter_mut().enumerate().for_each(|(j, x)| *x += seen(i) * seen(j) / own.variance);
            }
            let column = &self.predicted[place][state];
            let square: f64 =
                (0..N).map(|i| column[i] * (0..N).map(|j| information[i][j] * column[j]).sum::<f64>()).sum();
            variances[row] = (column[state] - square).max(0.0);
            if let Some(step) = step {
                let f = &self.filter.system.steps[step].transition;
                let back: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| f[j][i]));
                information = sandwich(&back, &information);
            }
        }
        variances
    }
}
