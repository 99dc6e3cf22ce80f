//! Residual sum of squares as a function of the fundamental alone, with the coefficients eliminated: cheap enough to
//! scan. It has many local minima in w, so the result of a search depends on its start.
//!
//! With time u from the middle of a record of length L, cos k w u is a polynomial of degree k in cos w u, and sin k w u
//! is sin w u times one of degree k − 1. Over less than one period cos w u runs through a part of [−1, 1] only and its
//! Chebyshev polynomials are nearly dependent; the polynomials of ξ = 1 − 2 (sin ½wu / sin ¼wL)², which always runs
//! through all of [−1, 1], span the same space and are not: Tₖ(ξ), k = 0..N, and sin w u Tₖ(ξ), k < N. Their normal
//! equations hold only Σ Tₖ(ξ) and Σ sin w u Tₖ(ξ), and are well conditioned down to the lowest w.
//!
//! Source of the elimination: Golub and Pereyra (1973), variable projection.

use nalgebra::{DMatrix, DVector};
use std::array::from_fn;
use std::f64::consts::FRAC_PI_2;

use super::folded_rows::{FoldedRows, LANES, lanes};

/// Minimum pivot, relative to its column, of the normal equations; below it QR is used. A pivot of size p leaves an
/// error of about ε/p in the pivots after it: at 1e-6 that is harmless, from 1e-8 on pivots consist of error and false
/// minima appear. This happens if gaps leave too little of the record, or if the highest harmonics are beyond the
/// sampling.
const MIN_PIVOT: f64 = 1e-6;

/// Number of steps of a walk after which its phasors are computed anew, to limit rounding.
const ANCHOR_STEPS: usize = 32;

/// Profile RSS(w) of the best series with N harmonics of w; the work space is allocated once.
#[derive(Debug, Clone)]
pub struct Profile {
    harmonics: usize,
    /// Duration of the record, s.
    duration: f64,
    total: f64,
    /// Rows of the record.
    rows: FoldedRows,
    /// cos ½wu and sin ½wu of the last evaluated fundamental.
    phasor: Vec<[f64; 2]>,
    sums: Vec<Sums>,
    gram: Vec<f64>,
    right: Vec<f64>,
    /// Number of fundamentals tried.
    pub evaluations: usize,
}

/// Sums over the folded rows with one Chebyshev polynomial Tₖ(ξ), lane by lane.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// Σ Tₖ.
    weight: [f64; LANES],
    /// Σ sin w u Tₖ, zero for even steps.
    skew: [f64; LANES],
    /// Σ y Tₖ.
    even: [f64; LANES],
    /// Σ y sin w u Tₖ.
    odd: [f64; LANES],
}

impl Profile {
    /// Profile of `values` at `time` (s, increasing, equal lengths, at least 2) for 1 to [`MAX_HARMONICS`] harmonics.
    pub fn new(time: &[f64], values: &[f64], harmonics: usize) -> Self {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let centred: Vec<f64> = values.iter().map(|v| v - mean).collect();
        let rows = FoldedRows::from_rows(time, &centred);
        let width = 2 * harmonics + 1;
        Self {
            harmonics,
            duration: time[time.len() - 1] - time[0],
            total: centred.iter().map(|v| v * v).sum(),
            phasor: vec![[1.0, 0.0]; rows.time.len()],
            rows,
            sums: vec![Sums::default(); width],
            gram: vec![0.0; width * width],
            right: vec![0.0; width],
            evaluations: 0,
        }
    }

    /// RSS at `fundamental` (rad/s, positive).
    pub fn rss(&mut self, fundamental: f64) -> f64 {
        self.anchor(fundamental);
        self.rss_of_phasor(fundamental)
    }

    /// RSS at `count` fundamentals from `lowest` in steps of `step` (rad/s).
    pub fn scan(&mut self, lowest: f64, step: f64, count: usize) -> Vec<f64> {
        let mut walk = self.sweep(lowest, step);
        (0..count).map(|_| walk.next_rss()).collect()
    }

    /// Walk over fundamentals from `from` in steps of `step` (rad/s, either sign).
    pub fn sweep(&mut self, from: f64, step: f64) -> FrequencySweep<'_> {
        let turn = self.rows.time.iter().map(|u| phasor(0.5 * step * u)).collect();
        FrequencySweep { profile: self, turn, from, step, done: 0 }
    }

    /// Sets the phasor of every row, (cos, sin) of ½wu, for w = `fundamental`.
    fn anchor(&mut self, fundamental: f64) {
        for (value, u) in self.phasor.iter_mut().zip(&self.rows.time) {
            *value = phasor(0.5 * fundamental * u);
        }
    }

    fn rss_of_phasor(&mut self, fundamental: f64) -> f64 {
        self.evaluations += 1;
        let share = cosine_share(fundamental, self.duration);
        accumulate(&self.rows, &self.phasor, share, self.harmonics, &mut self.sums);
        self.assemble(share);
        match explained(&mut self.gram, &mut self.right) {
            Some(explained) => (self.total - explained).max(0.0),
            None => self.rss_by_qr(fundamental),
        }
    }

    /// Upper triangle of XᵀX and Xᵀy from the sums, order Tₖ, sin w u Tₖ.
    fn assemble(&mut self, share: f64) {
        let n = self.harmonics;
        let (cosines, width) = (n + 1, 2 * n + 1);
        let sum = |lanes: [f64; LANES]| lanes.iter().sum::<f64>();
        // Σ Tₖ, Σ sin w u Tₖ and Σ sin² w u Tₖ.
        let (mut plain, mut sine) = ([0.0; MAX_COLUMNS], [0.0; MAX_COLUMNS]);
        for (k, sums) in self.sums.iter().enumerate() {
            (plain[k], sine[k]) = (sum(sums.weight), sum(sums.skew));
        }
        let square = with_square_of_sine(&plain[..width], share);
        // 2 Tₚ T_q = Tₚ₊_q + T_|p−q|.
        let product = |sums: &[f64], p: usize, q: usize| 0.5 * (sums[p + q] + sums[p.abs_diff(q)]);
        for p in 0..=n {
            let row = &mut self.gram[p * width..][..width];
            (p..=n).for_each(|q| row[q] = product(&plain, p, q));
            (0..n).for_each(|q| row[cosines + q] = product(&sine, p, q));
            self.right[p] = sum(self.sums[p].even);
        }
        for p in 0..n {
            let row = &mut self.gram[(cosines + p) * width..][..width];
            (p..n).for_each(|q| row[cosines + q] = product(&square, p, q));
            self.right[cosines + p] = sum(self.sums[p].odd);
        }
    }

    /// RSS from an orthogonal decomposition, for columns that are nearly dependent on the given rows.
    fn rss_by_qr(&self, fundamental: f64) -> f64 {
        let FoldedRows { time, even, odd, weight, skew, is_symmetric, used_rows } = &self.rows;
        let (n, share) = (self.harmonics, cosine_share(fundamental, self.duration));
        let (mut cosines, mut sines) = (DMatrix::zeros(*used_rows, n + 1), DMatrix::zeros(*used_rows, n));
        // A pair of instants has the weight √2; a single instant has the sign of its side in `skew`.
        let root: Vec<f64> = weight[..*used_rows].iter().map(|weight| weight.sqrt()).collect();
        for row in 0..*used_rows {
            let [xi, sine] = arguments(phasor(0.5 * fundamental * time[row]), share);
            let (mut before, mut here) = (xi, 1.0);
            for k in 0..=n {
                cosines[(row, k)] = root[row] * here;
                if k < n {
                    sines[(row, k)] = if *is_symmetric { root[row] } else { skew[row] } * sine * here;
                }
                (before, here) = (here, 2.0 * xi * here - before);
            }
        }
        let part = |signal: &[f64]| DVector::from_fn(*used_rows, |row, _| signal[row] / root[row]);
        if *is_symmetric {
            // The cosines act only on the even part of the record, the sines only on the odd part.
            return residual_sum_of_squares(cosines, part(even)) + residual_sum_of_squares(sines, part(odd));
        }
        let mut design = cosines.resize_horizontally(2 * n + 1, 0.0);
        design.columns_mut(n + 1, n).copy_from(&sines);
        residual_sum_of_squares(design, part(even))
    }
}

/// Walk through fundamentals in even steps: phasors are rotated by the step instead of being computed anew.
#[derive(Debug)]
pub struct FrequencySweep<'a> {
    profile: &'a mut Profile,
    turn: Vec<[f64; 2]>,
    from: f64,
    step: f64,
    done: usize,
}

impl FrequencySweep<'_> {
    /// RSS at the next fundamental; the first call is at the start of the walk.
    pub fn next_rss(&mut self) -> f64 {
        let fundamental = self.from + self.done as f64 * self.step;
        if self.done.is_multiple_of(ANCHOR_STEPS) {
            self.profile.anchor(fundamental);
        } else {
            for (phasor, turn) in self.profile.phasor.iter_mut().zip(&self.turn) {
                let [c, s] = *phasor;
                *phasor = [c * turn[0] - s * turn[1], s * turn[0] + c * turn[1]];
            }
        }
        self.done += 1;
        self.profile.rss_of_phasor(fundamental)
    }
}

/// Maximum number of harmonics of a series, far beyond the information of a zig-zag record.
pub const MAX_HARMONICS: usize = 64;

const MAX_COLUMNS: usize = 2 * MAX_HARMONICS + 1;

/// Share sin² ¼wL of [−1, 1] covered by cos w u over a record of length L; 1 from one period on.
fn cosine_share(fundamental: f64, duration: f64) -> f64 {
    (0.25 * fundamental * duration).min(FRAC_PI_2).sin().powi(2)
}

/// (cos, sin) of an angle, rad.
fn phasor(angle: f64) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    [c, s]
}

/// ξ, which is cos w u stretched from its `share` to [−1, 1], and sin w u, from (cos, sin) of ½wu.
fn arguments([c, s]: [f64; 2], share: f64) -> [f64; 2] {
    [1.0 - 2.0 * (s * s) / share, 2.0 * c * s]
}

/// Sums over the folded rows with Tₖ(ξ) for k ≤ 2N; those with the signal only for k ≤ N.
fn accumulate(nodes: &FoldedRows, phasor: &[[f64; 2]], share: f64, harmonics: usize, sums: &mut [Sums]) {
    sums.fill(Sums::default());
    for start in (0..nodes.time.len()).step_by(LANES) {
        let turned = lanes(phasor, start);
        let (even, odd) = (lanes(&nodes.even, start), lanes(&nodes.odd, start));
        let (weight, skew) = (lanes(&nodes.weight, start), lanes(&nodes.skew, start));
        let arguments = turned.map(|phasor| arguments(phasor, share));
        let xi = arguments.map(|[xi, _]| xi);
        let twice = xi.map(|xi| 2.0 * xi);
        let odd: [f64; LANES] = from_fn(|i| arguments[i][1] * odd[i]);
        let skew: [f64; LANES] = from_fn(|i| arguments[i][1] * skew[i]);
        // T₋₁ = T₁.
        let (mut before, mut here) = (xi, [1.0; LANES]);
        for (k, sums) in sums.iter_mut().enumerate() {
            add(&mut sums.weight, weight, &here);
            if !nodes.is_symmetric {
                add(&mut sums.skew, &skew, &here);
            }
            if k <= harmonics {
                add(&mut sums.even, even, &here);
                add(&mut sums.odd, &odd, &here);
            }
            // Tₖ₊₁ = 2 ξ Tₖ − Tₖ₋₁.
            (before, here) = (here, from_fn(|i| twice[i] * here[i] - before[i]));
        }
    }
}

fn add(total: &mut [f64; LANES], factor: &[f64; LANES], term: &[f64; LANES]) {
    for i in 0..LANES {
        total[i] += factor[i] * term[i];
    }
}

/// Σ sin² w u Tₖ from Σ Tₖ, for two fewer orders: sin² w u = x (2 − x), x = 1 − cos w u = `share` (1 − ξ), and (1 − ξ)
/// Tₖ = Tₖ − ½ (Tₖ₊₁ + T_|k−1|).
fn with_square_of_sine(sums: &[f64], share: f64) -> [f64; MAX_COLUMNS] {
    let by_x = |sums: &[f64], orders: usize| {
        let mut product = [0.0; MAX_COLUMNS];
        for k in 0..orders {
            product[k] = share * (sums[k] - 0.5 * (sums[k + 1] + sums[k.abs_diff(1)]));
        }
        product
    };
    let once = by_x(sums, sums.len() - 1);
    let mut twice = by_x(&once, sums.len() - 2);
    for k in 0..sums.len() - 2 {
        twice[k] = 2.0 * once[k] - twice[k];
    }
    twice
}

/// Residual sum of squares of a signal after projection on the columns of a design.
fn residual_sum_of_squares(design: DMatrix<f64>, mut signal: DVector<f64>) -> f64 {
    let width = design.ncols();
    design.qr().q_tr_mul(&mut signal);
    signal.rows_range(width..).norm_squared()
}

/// Explained sum of squares bᵀ G⁻¹ b by elimination in place in the upper triangle; `None` if a pivot is at most
/// [`MIN_PIVOT`] of its diagonal element, or NaN.
fn explained(gram: &mut [f64], right: &mut [f64]) -> Option<f64> {
    let width = right.len();
    let mut diagonal = [0.0; MAX_COLUMNS];
    for p in 0..width {
        diagonal[p] = gram[p * width + p];
    }
    let mut explained = 0.0;
    for p in 0..width {
        let (eliminated, remaining) = gram.split_at_mut((p + 1) * width);
        let row = &eliminated[p * width..];
        let pivot = row[p];
        if pivot <= MIN_PIVOT * diagonal[p] || pivot.is_nan() {
            return None;
        }
        let inverse = 1.0 / pivot;
        for (i, below) in (p + 1..).zip(remaining.chunks_exact_mut(width)) {
            let factor = row[i] * inverse;
            // On even steps cosines and sines are orthogonal.
            if factor == 0.0 {
                continue;
            }
            below[i..].iter_mut().zip(&row[i..]).for_each(|(value, above)| *value -= factor * above);
            right[i] -= factor * right[p];
        }
        explained += right[p] * right[p] * inverse;
    }
    Some(explained)
}

#[cfg(test)]
mod tests;
