//! Weather of one run: the moments of [`Disturbances`] that depend on time, sampled cell by cell on a grid and linear
//! within a cell. Grid and weather are independent of solver, sampling and helmsman. Wind as a function of heading is
//! evaluated by the propagator.

use rand::rngs::ChaCha8Rng;

use crate::disturbance::{Disturbances, Squall};
use crate::stream::{RngPurpose, StreamKey, normal};

/// Default cell width, s: short against every correlation time of weather and every time constant of a ship.
pub(crate) const DEFAULT_CELL_S: f64 = 0.1;

/// Weather within one cell, linear in time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WeatherCell {
    /// Beginning, s.
    pub start: f64,
    /// End, s; infinite if the weather is constant.
    pub end: f64,
    /// Width, s.
    pub width: f64,
    moment: [f64; 2],
    gust_factor: [f64; 2],
}

impl WeatherCell {
    /// Slope of the moment, rad/s.
    #[inline]
    pub fn moment_slope(&self) -> f64 {
        (self.moment[1] - self.moment[0]) / self.width
    }

    /// Moment that depends on time alone, as equivalent rudder angle, rad.
    #[inline]
    pub fn moment(&self, t: f64) -> f64 {
        self.moment[0] + self.moment_slope() * (t - self.start)
    }

    /// Factor 1 + g on the moment of the wind.
    #[inline]
    pub fn gust_factor(&self, t: f64) -> f64 {
        self.gust_factor[0] + (self.gust_factor[1] - self.gust_factor[0]) / self.width * (t - self.start)
    }
}

/// Gauss–Markov process at the points of the grid.
#[derive(Debug)]
struct MarkovChain {
    rng: ChaCha8Rng,
    value: f64,
    decay: f64,
    kick: f64,
}

impl MarkovChain {
    fn new(sd: f64, correlation_time: f64, grid: f64, mut rng: ChaCha8Rng) -> Self {
        let decay = (-grid / correlation_time).exp();
        let value = sd * normal(&mut rng);
        Self { rng, value, decay, kick: sd * (1.0 - decay * decay).sqrt() }
    }

    fn advance(&mut self) {
        self.value = self.decay * self.value + self.kick * normal(&mut self.rng);
    }
}

/// Weather of one run, cell by cell.
#[derive(Debug)]
pub(crate) struct Weather {
    cell: WeatherCell,
    index: u64,
    drift: f64,
    squall: Option<Squall>,
    walk: Option<MarkovChain>,
    gusts: Option<MarkovChain>,
    gusting: Option<MarkovChain>,
}

impl Weather {
    /// Weather at the beginning of a run, in cells of `grid` s.
    pub fn new(disturbances: &Disturbances, grid: f64, key: &StreamKey) -> Self {
        let gusting = disturbances.wind.and_then(|wind| wind.gusting);
        let mut weather = Self {
            cell: WeatherCell { start: 0.0, end: f64::INFINITY, width: grid, moment: [0.0; 2], gust_factor: [1.0; 2] },
            index: 0,
            drift: disturbances.moment_drift,
            squall: disturbances.squall,
            walk: (disturbances.moment_random_walk > 0.0).then(|| MarkovChain {
                rng: key.rng(RngPurpose::RandomWalk),
                value: 0.0,
                decay: 1.0,
                kick: disturbances.moment_random_walk * grid.sqrt(),
            }),
            gusts: disturbances
                .gusts
                .map(|gusts| MarkovChain::new(gusts.sd, gusts.correlation_time, grid, key.rng(RngPurpose::Gust))),
            gusting: gusting.map(|g| MarkovChain::new(g.sd, g.correlation_time, grid, key.rng(RngPurpose::WindGust))),
        };
        if disturbances.are_time_dependent() {
            weather.cell.end = grid;
            let (moment, gust) = (weather.moment(0.0), weather.gust_factor());
            weather.step();
            weather.cell.moment = [moment, weather.moment(grid)];
            weather.cell.gust_factor = [gust, weather.gust_factor()];
        }
        weather
    }

    /// Current cell.
    #[inline]
    pub fn cell(&self) -> &WeatherCell {
        &self.cell
    }

    /// Advances to the next cell.
    pub fn enter_next(&mut self) {
        self.index += 1;
        let end = (self.index + 1) as f64 * self.cell.width;
        self.step();
        self.cell = WeatherCell {
            start: self.cell.end,
            end,
            width: self.cell.width,
            moment: [self.cell.moment[1], self.moment(end)],
            gust_factor: [self.cell.gust_factor[1], self.gust_factor()],
        };
    }

    fn step(&mut self) {
        for chain in [&mut self.walk, &mut self.gusts, &mut self.gusting].into_iter().flatten() {
            chain.advance();
        }
    }

    fn moment(&self, t: f64) -> f64 {
        let value = |chain: &Option<MarkovChain>| chain.as_ref().map_or(0.0, |chain| chain.value);
        self.drift * t + self.squall.map_or(0.0, |squall| squall.moment(t)) + value(&self.walk) + value(&self.gusts)
    }

    fn gust_factor(&self) -> f64 {
        1.0 + self.gusting.as_ref().map_or(0.0, |chain| chain.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disturbance::{GaussMarkov, Gusting};
    use approx::assert_relative_eq;

    fn path(disturbances: &Disturbances, cells: usize, replicate: u64) -> Vec<[f64; 2]> {
        let mut weather = Weather::new(disturbances, DEFAULT_CELL_S, &StreamKey { seed: 11, cell: 0, replicate });
        (0..cells)
            .map(|_| {
                let cell = *weather.cell();
                weather.enter_next();
                [cell.moment(cell.start), cell.gust_factor(cell.start)]
            })
            .collect()
    }

    #[test]
    fn a_random_walk_spreads_with_the_root_of_time() {
        let disturbances = Disturbances { moment_random_walk: 2e-3, ..Disturbances::default() };
        let runs = 400;
        let ends: Vec<f64> = (0..runs).map(|replicate| path(&disturbances, 401, replicate)[400][0]).collect();
        let variance = ends.iter().map(|x| x * x).sum::<f64>() / runs as f64;
        // 40 s: sd 2e-3·√40; the standard error of a variance from n samples is √(2/n); the tolerance is three of them.
        assert_relative_eq!(variance, 4e-6 * 40.0, max_relative = 3.0 * (2.0 / runs as f64).sqrt());
    }

    #[test]
    fn gusts_are_stationary_and_correlated() {
        let gusts = GaussMarkov { sd: 0.01, correlation_time: 5.0 };
        let disturbances = Disturbances { gusts: Some(gusts), ..Disturbances::default() };
        let runs = 600;
        let (mut first, mut late, mut product) = (0.0, 0.0, 0.0);
        for replicate in 0..runs {
            let path = path(&disturbances, 51, replicate);
            first += path[0][0] * path[0][0];
            late += path[50][0] * path[50][0];
            product += path[0][0] * path[50][0];
        }
        let scale = 1.0 / (runs as f64 * gusts.sd * gusts.sd);
        assert_relative_eq!(first * scale, 1.0, epsilon = 3.0 * (2.0 / runs as f64).sqrt());
        assert_relative_eq!(late * scale, 1.0, epsilon = 3.0 * (2.0 / runs as f64).sqrt());
        // One correlation time apart: exp(−1).
        assert_relative_eq!(product * scale, (-1.0_f64).exp(), epsilon = 3.0 * (1.2 / runs as f64).sqrt());
    }

    #[test]
    fn sources_do_not_disturb_one_another() {
        let walk = Disturbances { moment_random_walk: 1e-3, ..Disturbances::default() };
        let drift = 1e-5;
        let both = Disturbances {
            moment_drift: drift,
            wind: Some(crate::disturbance::Wind {
                moment: 0.01,
                from_direction: 0.0,
                speed: None,
                gusting: Some(Gusting { sd: 0.2, correlation_time: 10.0 }),
            }),
            ..walk
        };
        for (k, (alone, together)) in path(&walk, 50, 3).iter().zip(path(&both, 50, 3)).enumerate() {
            assert_relative_eq!(alone[0] + drift * k as f64 * DEFAULT_CELL_S, together[0], epsilon = 1e-15);
            assert!(alone[1] == 1.0 && together[1] != 1.0);
        }
    }

    #[test]
    fn a_squall_has_smooth_edges_and_leaves_nothing_behind() {
        let squall = Squall { start: 2.0, duration: 6.0, edge: 2.0, moment: 0.02 };
        let disturbances = Disturbances { squall: Some(squall), ..Disturbances::default() };
        let path = path(&disturbances, 100, 0);
        assert_eq!(path[20][0], 0.0);
        assert_relative_eq!(path[30][0], 0.01, epsilon = 1e-12);
        assert_relative_eq!(path[50][0], 0.02, epsilon = 1e-15);
        assert_eq!(path[81][0], 0.0);
    }
}
