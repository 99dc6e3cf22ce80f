//! Whitening filter: the gains of a Kalman filter applied to columns of readings.
//!
//! The recursion within a column is serial: every row needs the row before it. Columns are independent, and so are
//! filters, so several columns and two filters advance side by side.

use super::{Gain, KalmanFilter, LinearStep, LinearSystem, MAX_STATES, SensorReading, StateSensor};
use crate::lanes::{Kernel, run_kernel};
use crate::with_states;

/// Whitening filter: turns columns of readings into innovations in units of their standard deviation.
#[derive(Debug, Clone)]
pub struct Whitener {
    states: usize,
    /// `true` if every transition matrix is upper triangular: no state acts on a later state.
    is_upper: bool,
    transitions: Vec<[[f64; MAX_STATES]; MAX_STATES]>,
    sensors: Vec<StateSensor>,
    gains: Vec<WhiteningGain>,
    readings: Vec<SensorReading>,
    /// Index of the gain of every reading.
    gain_of: Vec<u32>,
    /// Sum Σ log S over the readings, with the innovation variances S.
    pub log_determinant: f64,
}

/// Kalman gain, with 1/√S and log S of the innovation.
#[derive(Debug, Clone, Copy)]
struct WhiteningGain {
    gain: [f64; MAX_STATES],
    weight: f64,
    log_variance: f64,
}

impl<const N: usize> KalmanFilter<N> {
    /// Whitener with the gains of this filter of at most [`MAX_STATES`] states; the number of states is no part of its
    /// type.
    pub fn into_whitener(self) -> Whitener {
        let wide =
            |row: &[f64; N]| -> [f64; MAX_STATES] { std::array::from_fn(|k| row.get(k).copied().unwrap_or(0.0)) };
        let matrix = |f: &[[f64; N]; N]| -> [[f64; MAX_STATES]; MAX_STATES] {
            std::array::from_fn(|k| f.get(k).map_or([0.0; MAX_STATES], wide))
        };
        let log_determinant = self.log_determinant();
        let LinearSystem { steps, sensors, readings, .. } = self.system;
        let gains = self.gains.iter().zip(self.weights).zip(self.log_variances);
        let gain = |((gain, weight), log_variance): ((&Gain<N>, _), _)| WhiteningGain {
            gain: wide(&gain.gain),
            weight,
            log_variance,
        };
        Whitener {
            states: N,
            is_upper: steps.iter().all(LinearStep::is_upper),
            transitions: steps.iter().map(|step| matrix(&step.transition)).collect(),
            sensors,
            gains: gains.map(gain).collect(),
            readings,
            gain_of: self.gain_of,
            log_determinant,
        }
    }
}

impl Whitener {
    /// Log variance log S of every innovation.
    pub fn log_variances(&self) -> impl Iterator<Item = f64> {
        self.gain_of.iter().map(|&gain| self.gains[gain as usize].log_variance)
    }

    /// Whitens columns in place, each with one value per reading.
    pub fn apply(&self, columns: &mut [&mut Vec<f64>]) {
        for columns in columns.chunks_mut(INTERLEAVED_COLUMNS) {
            with_states!(self.states, N => match columns.len() {
                1 => run_kernel(WhiteningColumns::<N, 1> { whitener: self, columns }),
                _ => run_kernel(WhiteningColumns::<N, INTERLEAVED_COLUMNS> { whitener: self, columns }),
            });
        }
    }

    /// Whitens interleaved columns into `white`: a row holds one reading of every column.
    pub fn apply_to_rows(&self, rows: &[InterleavedRow], white: &mut Vec<InterleavedRow>) {
        white.resize(rows.len(), [0.0; INTERLEAVED_COLUMNS]);
        let (whiteners, readings, out) = ([self], [rows], [&mut white[..]]);
        with_states!(self.states, N => match self.is_upper {
            true => run_kernel(WhiteningRows::<N, 1, true> { whiteners, readings, out }),
            false => run_kernel(WhiteningRows::<N, 1, false> { whiteners, readings, out }),
        });
    }

    /// Whitens the interleaved columns of two filters: `rows[k]` by `whiteners[k]` into the k-th output.
    pub fn apply_pair(
        whiteners: [&Self; 2],
        rows: [&[InterleavedRow]; 2],
        [white, beside]: [&mut Vec<InterleavedRow>; 2],
    ) {
        let [first, second] = whiteners;
        let are_alike = first.states == second.states && first.readings.len() == second.readings.len();
        if are_alike && first.is_upper && second.is_upper {
            white.resize(rows[0].len(), [0.0; INTERLEAVED_COLUMNS]);
            beside.resize(rows[1].len(), [0.0; INTERLEAVED_COLUMNS]);
            let out = [&mut white[..], &mut beside[..]];
            with_states!(first.states, N => run_kernel(WhiteningRows::<N, 2, true> { whiteners, readings: rows, out }));
        } else {
            first.apply_to_rows(rows[0], white);
            second.apply_to_rows(rows[1], beside);
        }
    }

    /// Predicted state before every reading of a column, given the earlier readings; unused states are zero.
    pub fn predicted_states(&self, column: &[f64]) -> Vec<[f64; MAX_STATES]> {
        let mut x = [[0.0]; MAX_STATES];
        let predict = |((&value, &reading), &gain): ((&f64, &SensorReading), &u32)| {
            if let Some(step) = reading.step() {
                x = advanced::<_, _, false>(&self.transitions[step], &x);
            }
            let before = x.map(|[state]| state);
            let [seen] = if self.states == 0 { [0.0] } else { self.sensors[reading.sensor()].observe(&x) };
            let gain = &self.gains[gain as usize].gain;
            x.iter_mut().zip(gain).for_each(|(state, gain)| state[0] += gain * (value - seen));
            before
        };
        column.iter().zip(&self.readings).zip(&self.gain_of).map(predict).collect()
    }

    /// Applies the transpose Wᵀ of the whitening W to a column in place; WᵀW = Σ⁻¹, the inverse noise covariance.
    pub fn apply_transposed(&self, column: &mut [f64]) {
        let mut later = [0.0; MAX_STATES];
        for ((value, &reading), &gain) in column.iter_mut().zip(&self.readings).zip(&self.gain_of).rev() {
            let WhiteningGain { gain, weight, .. } = &self.gains[gain as usize];
            *value = *value * weight + (0..self.states).map(|i| gain[i] * later[i]).sum::<f64>();
            let StateSensor { state, second_state, .. } = self.sensors[reading.sensor()];
            [Some(state), second_state].into_iter().flatten().for_each(|state| later[state] -= *value);
            if let Some(step) = reading.step() {
                let f = &self.transitions[step];
                later = std::array::from_fn(|j| (0..self.states).map(|i| f[i][j] * later[i]).sum());
            }
        }
    }

    /// Whitened values of the reading in a row; corrects the states `x` of every column by their innovations.
    #[inline(always)]
    fn whiten<const N: usize, const C: usize, const UPPER: bool>(
        &self,
        row: usize,
        x: &mut [[f64; C]; N],
        values: &[f64; C],
    ) -> [f64; C] {
        let reading = self.readings[row];
        if let Some(step) = reading.step() {
            *x = advanced::<N, C, UPPER>(&self.transitions[step], x);
        }
        let WhiteningGain { gain, weight, .. } = &self.gains[self.gain_of[row] as usize];
        let seen = self.sensors[reading.sensor()].observe(x);
        let (mut innovation, mut white) = ([0.0; C], [0.0; C]);
        for k in 0..C {
            innovation[k] = values[k] - seen[k];
            white[k] = innovation[k] * weight;
        }
        for (x, gain) in x.iter_mut().zip(gain) {
            for k in 0..C {
                x[k] += gain * innovation[k];
            }
        }
        white
    }
}

/// Number of columns that are whitened side by side.
pub const INTERLEAVED_COLUMNS: usize = 8;

/// Number of rows that are copied at a time for the columns that are whitened side by side.
const ROWS: usize = 64;

/// One reading of every one of [`INTERLEAVED_COLUMNS`] columns.
pub type InterleavedRow = [f64; INTERLEAVED_COLUMNS];

/// Whitening of up to `C` columns.
struct WhiteningColumns<'a, 'b, const N: usize, const C: usize> {
    whitener: &'a Whitener,
    columns: &'a mut [&'b mut Vec<f64>],
}

impl<const N: usize, const C: usize> Kernel for WhiteningColumns<'_, '_, N, C> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { whitener, columns } = self;
        let mut x = [[0.0; C]; N];
        // A missing column contains zeros.
        let mut block = [[0.0; C]; ROWS];
        let count = whitener.readings.len();
        for first in (0..count).step_by(ROWS) {
            let rows = first..(first + ROWS).min(count);
            for (k, column) in columns.iter().enumerate() {
                block.iter_mut().zip(&column[rows.clone()]).for_each(|(values, value)| values[k] = *value);
            }
            for (values, row) in block.iter_mut().zip(rows.clone()) {
                *values = whitener.whiten::<N, C, false>(row, &mut x, values);
            }
            for (k, column) in columns.iter_mut().enumerate() {
                column[rows.clone()].iter_mut().zip(&block).for_each(|(value, values)| *value = values[k]);
            }
        }
    }
}

/// Whitening of interleaved columns by each of `FILTERS` filters with the same number of states and of readings.
struct WhiteningRows<'a, 'b, const N: usize, const FILTERS: usize, const UPPER: bool> {
    whiteners: [&'a Whitener; FILTERS],
    readings: [&'a [InterleavedRow]; FILTERS],
    out: [&'b mut [InterleavedRow]; FILTERS],
}

impl<const N: usize, const FILTERS: usize, const UPPER: bool> Kernel for WhiteningRows<'_, '_, N, FILTERS, UPPER> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { whiteners, readings, out } = self;
        let mut x = [[[0.0; INTERLEAVED_COLUMNS]; N]; FILTERS];
        for row in 0..whiteners[0].readings.len() {
            for filter in 0..FILTERS {
                let values = &readings[filter][row];
                out[filter][row] =
                    whiteners[filter].whiten::<N, INTERLEAVED_COLUMNS, UPPER>(row, &mut x[filter], values);
            }
        }
    }
}

/// Product F x for several state vectors at once; of an upper triangular F only the triangle is used.
#[inline(always)]
fn advanced<const N: usize, const C: usize, const UPPER: bool>(
    f: &[[f64; MAX_STATES]; MAX_STATES],
    x: &[[f64; C]; N],
) -> [[f64; C]; N] {
    let mut next = [[0.0; C]; N];
    for i in 0..N {
        for j in if UPPER { i } else { 0 }..N {
            for k in 0..C {
                next[i][k] += f[i][j] * x[j][k];
            }
        }
    }
    next
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::on_every_instruction_set;
    use approx::assert_relative_eq;

    const COUNT: usize = 203;

    /// Whitener of a ship with yaw rate and a random moment; `back` acts from the heading on the yaw rate.
    fn whitener(damping: f64, back: f64) -> Whitener {
        let transition = [[1.0, 0.9, 0.4], [back, damping, 0.9], [0.0, 0.0, 0.97]];
        let process_noise = [[1e-4, 0.0, 0.0], [0.0, 1e-3, 0.0], [0.0, 0.0, 0.02]];
        let sensors = vec![
            StateSensor { state: 0, second_state: None, variance: 0.5 },
            StateSensor { state: 1, second_state: None, variance: 0.2 },
        ];
        let readings =
            (0..COUNT).map(|row| SensorReading::new((row % 2 == 0 && row > 0).then_some(0), row % 2)).collect();
        let initial = [[0.3, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.4]];
        KalmanFilter::new(LinearSystem {
            steps: vec![LinearStep { transition, process_noise }],
            sensors,
            readings,
            initial_covariance: initial,
        })
        .into_whitener()
    }

    fn rows() -> Vec<InterleavedRow> {
        (0..COUNT).map(|row| std::array::from_fn(|k| ((1.3 + k as f64) * row as f64).sin())).collect()
    }

    fn column(rows: &[InterleavedRow], k: usize) -> Vec<f64> {
        rows.iter().map(|row| row[k]).collect()
    }

    #[test]
    fn columns_are_whitened_alike_alone_together_and_beside_another_filter() {
        for (first, second) in [(whitener(0.9, 0.0), whitener(0.8, 0.0)), (whitener(0.9, 0.01), whitener(0.8, 0.0))] {
            let mut pair = [Vec::new(), Vec::new()];
            let [left, right] = &mut pair;
            Whitener::apply_pair([&first, &second], [&rows(), &rows()], [left, right]);
            for (whitener, whitened) in [first, second].iter().zip(&pair) {
                let mut together = Vec::new();
                whitener.apply_to_rows(&rows(), &mut together);
                let mut columns: Vec<Vec<f64>> = (0..INTERLEAVED_COLUMNS).map(|k| column(&rows(), k)).collect();
                whitener.apply(&mut columns.iter_mut().collect::<Vec<_>>());
                for k in 0..INTERLEAVED_COLUMNS {
                    let mut alone = column(&rows(), k);
                    let predicted = whitener.predicted_states(&alone);
                    let read = |row: usize| predicted[row][row % 2];
                    let innovations: Vec<f64> = alone.iter().enumerate().map(|(row, x)| x - read(row)).collect();
                    whitener.apply(&mut [&mut alone]);
                    for row in 0..COUNT {
                        assert_relative_eq!(alone[row], whitened[row][k], epsilon = 1e-12);
                        assert_relative_eq!(alone[row], together[row][k], epsilon = 1e-12);
                        assert_relative_eq!(alone[row], columns[k][row], epsilon = 1e-12);
                        let log_variance = whitener.log_variances().nth(row).expect("a row");
                        let unit = innovations[row] * (-0.5 * log_variance).exp();
                        assert_relative_eq!(alone[row], unit, epsilon = 1e-12);
                    }
                }
            }
        }
    }

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        struct Whitened([Whitener; 2]);
        impl Kernel for Whitened {
            type Output = [Vec<InterleavedRow>; 2];

            #[inline(always)]
            fn call(self) -> Self::Output {
                let (rows, mut white) = (rows(), [rows(), rows()]);
                let (whiteners, out) = (self.0.each_ref(), white.each_mut().map(Vec::as_mut_slice));
                WhiteningRows::<3, 2, true> { whiteners, readings: [&rows, &rows], out }.call();
                white
            }
        }
        let outputs = on_every_instruction_set(|| Whitened([whitener(0.9, 0.0), whitener(0.8, 0.0)]));
        assert!(outputs.iter().all(|(_, output)| output == &outputs[0].1));
    }
}
