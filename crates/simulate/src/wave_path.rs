//! Realisation of a narrow-band wave heading, at any non-decreasing times. It is sampled on a separate grid and
//! interpolated by the cubic Hermite polynomial of ξ and ξ', so two readers of one stream obtain identical waves at any
//! sampling.

use rand::rngs::ChaCha8Rng;
use ship::narrow_band::{NarrowBandProcess, NarrowBandStep};

use crate::disturbance::Disturbances;
use crate::simulated_ship::SimulatedShip;
use crate::stream::{RngPurpose, StreamKey, normal};

/// Phase ω₀ h of a cell of width h; at 0.2 the cubic is within 10⁻⁵ σ of the smooth part of the path.
const PHASE_PER_CELL: f64 = 0.2;

/// Width of a cell, s.
pub(crate) fn cell_width(waves: &NarrowBandProcess) -> f64 {
    PHASE_PER_CELL / waves.frequency
}

/// Realisation of one narrow-band process; `ends` has ξ (rad) and ξ' (rad/s) at both ends of the current cell.
#[derive(Debug)]
struct WavePath {
    rng: ChaCha8Rng,
    step: NarrowBandStep,
    width: f64,
    cell: u64,
    ends: [[f64; 2]; 2],
}

impl WavePath {
    fn new(waves: &NarrowBandProcess, mut rng: ChaCha8Rng) -> Self {
        let width = cell_width(waves);
        let step = waves.step(width);
        let start = waves.stationary_sd().map(|sd| sd * normal(&mut rng));
        let end = step.advance(start, [normal(&mut rng), normal(&mut rng)]);
        Self { rng, step, width, cell: 0, ends: [start, end] }
    }

    fn at(&mut self, t: f64) -> [f64; 2] {
        while t > (self.cell + 1) as f64 * self.width {
            self.cell += 1;
            let draw = [normal(&mut self.rng), normal(&mut self.rng)];
            self.ends = [self.ends[1], self.step.advance(self.ends[1], draw)];
        }
        let h = self.width;
        let s = (t / h - self.cell as f64).max(0.0);
        let [[x0, v0], [x1, v1]] = self.ends;
        let (rise, a, b) = (x1 - x0, h * v0, h * v1);
        // Cubic Hermite: x0 + a s + c2 s² + c3 s³.
        let (c2, c3) = (3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise);
        [x0 + s * (a + s * (c2 + s * c3)), (a + s * (2.0 * c2 + s * 3.0 * c3)) / h]
    }
}

/// Sum of all waves of a run: waves declared as a disturbance, and waves of the response model.
#[derive(Debug)]
pub(crate) struct SeaWaves {
    paths: Vec<WavePath>,
}

impl SeaWaves {
    /// Waves of one run.
    pub fn new(disturbances: &Disturbances, ship: &SimulatedShip, key: &StreamKey) -> Self {
        let declared = disturbances.waves.iter().map(|sea| WavePath::new(&sea.process(), key.rng(RngPurpose::Waves)));
        let of_response = ship
            .random_headings()
            .iter()
            .enumerate()
            .map(|(index, waves)| WavePath::new(waves, key.indexed_rng(RngPurpose::EffectWaves, index as u32)));
        Self { paths: declared.chain(of_response).collect() }
    }

    /// `true` if there are no waves.
    pub fn is_empty(&self) -> bool {
        self.paths.is_empty()
    }

    /// Wave heading ξ (rad) and its rate ξ' (rad/s) at time `t` (s), which must not decrease from call to call.
    pub fn heading_and_rate_at(&mut self, t: f64) -> [f64; 2] {
        self.paths.iter_mut().fold([0.0; 2], |[x, v], path| {
            let [dx, dv] = path.at(t);
            [x + dx, v + dv]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const WAVES: NarrowBandProcess = NarrowBandProcess { sd: 0.01, frequency: 0.6, damping: 0.1 };

    fn path(replicate: u64) -> WavePath {
        WavePath::new(&WAVES, StreamKey { seed: 5, cell: 1, replicate }.rng(RngPurpose::Waves))
    }

    #[test]
    fn two_readers_see_the_same_sea() {
        let (mut fine, mut coarse) = (path(0), path(0));
        for k in 0..200 {
            let t = 1.7 * k as f64;
            for part in 0..5 {
                fine.at(t - 1.7 + 0.34 * f64::from(part));
            }
            assert_eq!(fine.at(t), coarse.at(t));
        }
    }

    #[test]
    fn standard_deviations_are_those_of_the_spectrum() {
        let runs = 500;
        let (mut heading, mut rate) = (0.0, 0.0);
        for replicate in 0..runs {
            // Between grid points, where the cubic interpolates.
            let [x, v] = path(replicate).at(40.123);
            heading += x * x / f64::from(runs as u32);
            rate += v * v / f64::from(runs as u32);
        }
        let tolerance = 3.0 * (2.0 / runs as f64).sqrt();
        assert_relative_eq!(heading, WAVES.sd * WAVES.sd, max_relative = tolerance);
        assert_relative_eq!(rate, (WAVES.sd * WAVES.frequency).powi(2), max_relative = tolerance);
    }

    #[test]
    fn the_rate_is_the_derivative_of_the_heading() {
        let mut waves = path(2);
        let h = 1e-4;
        for k in 1..50 {
            let t = 0.913 * f64::from(k);
            let before = waves.at(t - h)[0];
            let rate = waves.at(t)[1];
            let after = waves.at(t + h)[0];
            assert_relative_eq!(rate, (after - before) / (2.0 * h), epsilon = 1e-7);
        }
    }
}
