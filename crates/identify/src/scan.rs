//! Scan of the profiled sum of squares of a first-order fit over many values of 1/T at once.
//!
//! [`crate::profile`] computes it by projection, to the last digit and for a single 1/T; this module uses normal
//! equations for several values in parallel: half the digits, which suffice to locate the valleys, in a small part of
//! the time. Source: variable projection, Golub and Pereyra (1973).

use estimation::column::{dot, sum};
use nalgebra::{Matrix2, Vector2};
use ship::first_order::FirstOrderTransition;

use crate::likelihood::track::{SignalStep, TrialSignals, durations_differ, is_backward};
use crate::profile::solve2;

/// Number of values of 1/T in parallel.
const LANES: usize = 8;

type Lanes = [f64; LANES];

/// Best fit of a ship with a given 1/T.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FitAtInverseT {
    /// Sum of squares, rad².
    pub rss: f64,
    /// b = K/T, 1/s², of any sign.
    pub K_over_T: f64,
}

/// Best fit for every value of `inverse_T` (1/s), in increasing order; `None` if the columns are dependent.
///
/// Every row of the signals has to be observed, and their rudder to have no corners between rows, as in
/// [thinned](TrialSignals::thinned) signals.
pub(crate) fn scan_inverse_T(trial_signals: &[TrialSignals], inverse_T: &[f64]) -> Vec<Option<FitAtInverseT>> {
    let centred: Vec<Vec<f64>> = trial_signals.iter().map(|signals| centred(&signals.heading)).collect();
    let squares: f64 = centred.iter().map(|heading| dot(heading, heading)).sum();
    let mut fits = Vec::with_capacity(inverse_T.len());
    // The columns of one block have their anchors at the same end of the record.
    for same_side in inverse_T.chunk_by(|&a, &b| is_backward(a) == is_backward(b)) {
        for block in same_side.chunks(LANES) {
            let values: Lanes = std::array::from_fn(|lane| block[lane.min(block.len() - 1)]);
            let mut products = [Products::default(); LANES];
            for (signals, heading) in trial_signals.iter().zip(&centred) {
                let trial_products = estimation::lanes::run_kernel(Sweep { signals, heading, inverse_T: &values });
                products.iter_mut().zip(trial_products).for_each(|(sum, term)| sum.add(&term));
            }
            fits.extend(products[..block.len()].iter().map(|products| products.fit(squares)));
        }
    }
    fits
}

fn centred(heading: &[f64]) -> Vec<f64> {
    let mean = sum(heading) / heading.len() as f64;
    heading.iter().map(|psi| psi - mean).collect()
}

/// Products of G, H and the heading ψ of one lane, after projection on the complement of (1, φ₁).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Products {
    gg: f64,
    gh: f64,
    hh: f64,
    g_psi: f64,
    h_psi: f64,
    /// Part of the heading explained by φ₁, rad².
    explained: f64,
}

impl Products {
    fn add(&mut self, other: &Self) {
        self.gg += other.gg;
        self.gh += other.gh;
        self.hh += other.hh;
        self.g_psi += other.g_psi;
        self.h_psi += other.h_psi;
        self.explained += other.explained;
    }

    /// Fit, for headings whose squares about their means add up to `squares`.
    fn fit(&self, squares: f64) -> Option<FitAtInverseT> {
        let moment = Vector2::new(self.g_psi, self.h_psi);
        let steering = solve2(&Matrix2::new(self.gg, self.gh, self.gh, self.hh), &moment)?;
        let rss = squares - self.explained - steering.dot(&moment);
        rss.is_finite().then_some(FitAtInverseT { rss, K_over_T: steering[0] })
    }
}

/// Pass over one trial with its heading minus the mean; 1/T has one sign in all lanes.
struct Sweep<'a> {
    signals: &'a TrialSignals,
    heading: &'a [f64],
    inverse_T: &'a Lanes,
}

/// Σ over rows of columns and of products of columns, by lane. f, g, h denote φ₁, G, H.
#[derive(Clone, Copy, Default)]
struct Sums {
    f: Lanes,
    g: Lanes,
    h: Lanes,
    ff: Lanes,
    fg: Lanes,
    fh: Lanes,
    gg: Lanes,
    gh: Lanes,
    hh: Lanes,
    f_psi: Lanes,
    g_psi: Lanes,
    h_psi: Lanes,
}

impl Sums {
    /// Products of one lane, with the constant and φ₁ eliminated.
    fn projected(&self, lane: usize, rows: f64) -> Products {
        let [f, g, h] = [self.f[lane], self.g[lane], self.h[lane]];
        let ff = self.ff[lane] - f * f / rows;
        let (fg, fh, f_psi) = (self.fg[lane] - f * g / rows, self.fh[lane] - f * h / rows, self.f_psi[lane]);
        let per = if ff > 0.0 { 1.0 / ff } else { 0.0 };
        Products {
            gg: self.gg[lane] - g * g / rows - fg * fg * per,
            gh: self.gh[lane] - g * h / rows - fg * fh * per,
            hh: self.hh[lane] - h * h / rows - fh * fh * per,
            g_psi: self.g_psi[lane] - fg * f_psi * per,
            h_psi: self.h_psi[lane] - fh * f_psi * per,
            explained: f_psi * f_psi * per,
        }
    }
}

impl estimation::lanes::Kernel for Sweep<'_> {
    type Output = [Products; LANES];

    /// Sums over the rows of a trial, by the recursions of [`TrialSignals::fill_columns`] in every lane. The anchor row
    /// has only zeros and is left out.
    #[inline(always)]
    fn call(self) -> Self::Output {
        let Self { signals, heading, inverse_T } = self;
        let mut sums = Sums::default();
        let (mut f, mut g, mut h) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let (mut f_rate, mut g_rate, mut h_rate) = ([1.0; LANES], [0.0; LANES], [0.0; LANES]);
        let mut duration = 0.0;
        let (mut decay, mut phi1, mut phi2, mut phi3) = ([0.0; LANES], [0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let rudder = &signals.rudder;
        let backward = is_backward(inverse_T[0]);
        for SignalStep { from_row, to_row, duration: step, rudder_rate: rate, .. } in signals.steps(backward) {
            if durations_differ(duration, step) {
                duration = step;
                for lane in 0..LANES {
                    let transition = FirstOrderTransition::new(inverse_T[lane], step);
                    (decay[lane], phi1[lane]) = (transition.decay, transition.phi1);
                    (phi2[lane], phi3[lane]) = (transition.phi2, transition.phi3);
                }
            }
            let (delta, psi) = (rudder[from_row], heading[to_row]);
            for lane in 0..LANES {
                f[lane] += phi1[lane] * f_rate[lane];
                f_rate[lane] *= decay[lane];
                g[lane] += phi1[lane] * g_rate[lane] + (phi2[lane] * delta + phi3[lane] * rate);
                g_rate[lane] = decay[lane] * g_rate[lane] + (phi1[lane] * delta + phi2[lane] * rate);
                h[lane] += phi1[lane] * h_rate[lane] + phi2[lane];
                h_rate[lane] = decay[lane] * h_rate[lane] + phi1[lane];
            }
            for lane in 0..LANES {
                sums.f[lane] += f[lane];
                sums.g[lane] += g[lane];
                sums.h[lane] += h[lane];
                sums.ff[lane] += f[lane] * f[lane];
                sums.fg[lane] += f[lane] * g[lane];
                sums.fh[lane] += f[lane] * h[lane];
                sums.gg[lane] += g[lane] * g[lane];
                sums.gh[lane] += g[lane] * h[lane];
                sums.hh[lane] += h[lane] * h[lane];
                sums.f_psi[lane] += f[lane] * psi;
                sums.g_psi[lane] += g[lane] * psi;
                sums.h_psi[lane] += h[lane] * psi;
            }
        }
        let rows = heading.len() as f64;
        std::array::from_fn(|lane| sums.projected(lane, rows))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::Profile;
    use crate::testing::Case;
    use approx::assert_relative_eq;

    fn signals(case: Case) -> TrialSignals {
        TrialSignals::new(&case.trial()).thinned(200)
    }

    #[test]
    fn the_scan_is_the_profile() {
        let trial_signals = [
            signals(Case { noise_deg: 0.5, ..Case::default() }),
            signals(Case { noise_deg: 0.2, rudder_deg: 20.0, seed: 2, ..Case::default() }),
        ];
        let grid: Vec<f64> = (-15..=15).map(|k| 0.01 * f64::from(k)).collect();
        let mut profile = Profile::new(trial_signals.to_vec());
        for (&a, fit) in grid.iter().zip(scan_inverse_T(&trial_signals, &grid)) {
            let fit = fit.expect("the columns are independent");
            if let Some(rss) = profile.residual_sum_of_squares_at(a) {
                assert_relative_eq!(fit.rss, rss, max_relative = 1e-8);
                assert_relative_eq!(fit.K_over_T, profile.K_over_T_and_offset().0, max_relative = 1e-7);
            } else {
                assert!(fit.K_over_T <= 0.0);
            }
        }
    }

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        let signals = signals(Case { noise_deg: 0.5, ..Case::default() });
        let heading = centred(&signals.heading);
        for sign in [1.0, -1.0] {
            let inverse_T = std::array::from_fn(|lane| sign * 0.003 * 2f64.powi(lane as i32));
            let results = estimation::lanes::on_every_instruction_set(|| Sweep {
                signals: &signals,
                heading: &heading,
                inverse_T: &inverse_T,
            });
            assert!(results.iter().all(|(_, products)| products == &results[0].1), "{results:?}");
        }
    }
}
