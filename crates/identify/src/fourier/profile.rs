//! The residual sum of squares as a function of the fundamental alone, the coefficients eliminated: cheap enough to
//! scan. The problem has many local minima in w, so a search from one start is only as good as its start.
//!
//! Source of the elimination: Golub and Pereyra (1973), variable projection.

use nalgebra::{DMatrix, DVector};

/// Instants handled together; eight doubles fill the widest vector registers in use.
const LANES: usize = 8;

/// Below this pivot against its column QR is used. A pivot of size p leaves an error of about ε/p in the pivots after
/// it: at 1e-6 that is harmless, from 1e-8 on pivots are made of their own error and false minima appear.
const SMALLEST_PIVOT: f64 = 1e-6;

/// Deviation from even steps, as a share of the step, that is rounding of the clock.
const EVEN: f64 = 1e-7;

/// RSS(w) of the best series with N harmonics of w, with its work space allocated once.
///
/// The Gram matrix of the basis holds only Σ cos k w t and Σ sin k w t, k = 0..2N, so that one pass over the instants
/// with a recurrence in k makes the normal equations. On even steps these sums have a closed form, and the record is
/// folded about its middle: the cosines see only the even part of the signal, the sines only the odd part.
#[derive(Debug, Clone)]
pub struct Profile {
    harmonics: usize,
    rows: usize,
    /// Step of an even record, s.
    step: Option<f64>,
    /// Time from the middle of the record, padded to whole blocks; of an even record the second half only.
    time: Vec<f64>,
    /// Signal less its mean, zero in the padding: sum and difference of the two halves when folded.
    even: Vec<f64>,
    odd: Vec<f64>,
    /// Instants behind a value: 0 in the padding, 2 for a folded pair.
    weight: Vec<f64>,
    /// cos w t and sin w t of the fundamental evaluated last.
    phasor: Vec<[f64; 2]>,
    total: f64,
    sums: Vec<[[f64; LANES]; 4]>,
    gram: Vec<f64>,
    right: Vec<f64>,
    evaluations: usize,
}

impl Profile {
    /// The profile of `values` at `time` (s, increasing, equal lengths, at least 2) for 1 to [`MOST_HARMONICS`] harmonics.
    pub fn new(time: &[f64], values: &[f64], harmonics: usize) -> Self {
        let rows = time.len();
        let centre = 0.5 * (time[0] + time[rows - 1]);
        let mean = values.iter().sum::<f64>() / rows as f64;
        let step = (time[rows - 1] - time[0]) / (rows - 1) as f64;
        let is_even = time.iter().enumerate().all(|(row, t)| (t - time[0] - row as f64 * step).abs() <= EVEN * step);
        // Of an even record the rows from the middle on, each with its mirror image.
        let first = if is_even { rows / 2 } else { 0 };
        let (mut even, mut odd, mut weight) = (Vec::new(), Vec::new(), Vec::new());
        for row in first..rows {
            let here = values[row] - mean;
            let mirror = rows - 1 - row;
            if is_even && mirror != row {
                let there = values[mirror] - mean;
                even.push(here + there);
                odd.push(here - there);
                weight.push(2.0);
            } else {
                even.push(here);
                odd.push(here);
                weight.push(1.0);
            }
        }
        let mut half: Vec<f64> = time[first..].iter().map(|t| t - centre).collect();
        let padded = half.len().next_multiple_of(LANES);
        for column in [&mut half, &mut even, &mut odd, &mut weight] {
            column.resize(padded, 0.0);
        }
        let width = 2 * harmonics + 1;
        Self {
            harmonics,
            rows,
            step: is_even.then_some(step),
            time: half,
            even,
            odd,
            weight,
            phasor: vec![[1.0, 0.0]; padded],
            total: values.iter().map(|v| (v - mean) * (v - mean)).sum(),
            sums: vec![[[0.0; LANES]; 4]; width],
            gram: vec![0.0; width * width],
            right: vec![0.0; width],
            evaluations: 0,
        }
    }

    /// Sum of squares about the mean.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Number of fundamentals tried so far.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// RSS at `fundamental` (rad/s, positive).
    pub fn rss(&mut self, fundamental: f64) -> f64 {
        for (value, u) in self.phasor.iter_mut().zip(&self.time) {
            *value = phasor(fundamental * u);
        }
        self.rss_of_phasor(fundamental)
    }

    /// RSS at `count` fundamentals from `lowest` in steps of `step` (rad/s).
    pub fn scan(&mut self, lowest: f64, step: f64, count: usize) -> Vec<f64> {
        let mut walk = self.walk(lowest, step);
        (0..count).map(|_| walk.next_rss()).collect()
    }

    /// Fundamentals from `from` in steps of `step` (rad/s, either sign).
    pub fn walk(&mut self, from: f64, step: f64) -> Walk<'_> {
        let turn = self.time.iter().map(|u| phasor(step * u)).collect();
        Walk { profile: self, turn, from, step, done: 0 }
    }

    fn rss_of_phasor(&mut self, fundamental: f64) -> f64 {
        self.evaluations += 1;
        self.accumulate();
        self.assemble(fundamental);
        let width = 2 * self.harmonics + 1;
        match explained(&mut self.gram, &mut self.right, width) {
            Some(explained) => (self.total - explained).max(0.0),
            None => self.rss_by_qr(fundamental),
        }
    }

    /// Sums of y cos k, y sin k (k ≤ N) and, on uneven steps, of cos k, sin k (k ≤ 2N), lane by lane.
    fn accumulate(&mut self) {
        let n = self.harmonics;
        let highest = if self.step.is_some() { n } else { 2 * n };
        self.sums.fill([[0.0; LANES]; 4]);
        for start in (0..self.time.len()).step_by(LANES) {
            let (even, odd) = (lanes(&self.even, start), lanes(&self.odd, start));
            let (weight, phasor) = (lanes(&self.weight, start), lanes(&self.phasor, start));
            let c1: [f64; LANES] = std::array::from_fn(|i| phasor[i][0]);
            let (mut c0, mut s0) = ([1.0; LANES], [0.0; LANES]);
            let mut c = c1;
            let mut s: [f64; LANES] = std::array::from_fn(|i| phasor[i][1]);
            for k in 1..=highest {
                let sums = &mut self.sums[k];
                if self.step.is_none() {
                    add(&mut sums[0], weight, &c);
                    add(&mut sums[1], weight, &s);
                }
                if k <= n {
                    add(&mut sums[2], even, &c);
                    add(&mut sums[3], odd, &s);
                }
                for i in 0..LANES {
                    // Chebyshev: cos (k+1)x = 2 cos x cos kx − cos (k−1)x, and the same for sin.
                    let (next_c, next_s) = (2.0 * c1[i] * c[i] - c0[i], 2.0 * c1[i] * s[i] - s0[i]);
                    (c0[i], s0[i]) = (c[i], s[i]);
                    (c[i], s[i]) = (next_c, next_s);
                }
            }
        }
    }

    /// Lower triangle of XᵀX and Xᵀy from the sums, order 1, cos 1..N, sin 1..N.
    fn assemble(&mut self, fundamental: f64) {
        let n = self.harmonics;
        let width = 2 * n + 1;
        let sum = |k: usize, part: usize| self.sums[k][part].iter().sum::<f64>();
        let (mut cosines, mut sines) = ([0.0; 2 * MOST_HARMONICS + 1], [0.0; 2 * MOST_HARMONICS + 1]);
        cosines[0] = self.rows as f64;
        for k in 1..width {
            (cosines[k], sines[k]) = match self.step {
                Some(step) => (even_cosines(self.rows as f64, k as f64 * fundamental * step), 0.0),
                None => (sum(k, 0), sum(k, 1)),
            };
        }
        self.right[0] = 0.0;
        for p in 1..=n {
            (self.right[p], self.right[n + p]) = (sum(p, 2), sum(p, 3));
        }
        for p in 0..=n {
            for q in 0..=p {
                self.gram[p * width + q] = 0.5 * (cosines[p - q] + cosines[p + q]);
            }
        }
        for p in 1..=n {
            let row = (n + p) * width;
            for q in 0..=n {
                // sin p cos q = ½ (sin (p+q) + sin (p−q)).
                let difference = if p >= q { sines[p - q] } else { -sines[q - p] };
                self.gram[row + q] = 0.5 * (sines[p + q] + difference);
            }
            for q in 1..=p {
                self.gram[row + n + q] = 0.5 * (cosines[p - q] - cosines[p + q]);
            }
        }
    }

    /// The same number from orthogonal decompositions, for fundamentals far below one period a record.
    fn rss_by_qr(&self, fundamental: f64) -> f64 {
        let n = self.harmonics;
        let values = self.weight.iter().position(|&weight| weight == 0.0).unwrap_or(self.time.len());
        let cosine = |row: usize, k: usize| (k as f64 * fundamental * self.time[row]).cos();
        let sine = |row: usize, k: usize| (k as f64 * fundamental * self.time[row]).sin();
        if self.step.is_none() {
            let design = DMatrix::from_fn(values, 2 * n + 1, |row, column| {
                if column <= n { cosine(row, column) } else { sine(row, column - n) }
            });
            return left_over(design, DVector::from_column_slice(&self.even[..values]));
        }
        // Even and odd part stand apart; a pair of instants weighs √2.
        let root: Vec<f64> = self.weight[..values].iter().map(|weight| weight.sqrt()).collect();
        let part = |signal: &[f64]| DVector::from_fn(values, |row, _| signal[row] / root[row]);
        let cosines = DMatrix::from_fn(values, n + 1, |row, column| root[row] * cosine(row, column));
        let even = left_over(cosines, part(&self.even));
        // The middle row of an odd number has no odd part.
        let first = usize::from(root[0] == 1.0);
        let sines =
            DMatrix::from_fn(values - first, n, |row, column| root[first + row] * sine(first + row, column + 1));
        even + left_over(sines, part(&self.odd).rows_range(first..).into_owned())
    }
}

/// A walk through fundamentals in even steps: phasors are turned by the step instead of being computed anew.
#[derive(Debug)]
pub struct Walk<'a> {
    profile: &'a mut Profile,
    turn: Vec<[f64; 2]>,
    from: f64,
    step: f64,
    done: usize,
}

impl Walk<'_> {
    /// RSS at the next fundamental, the first time at the start of the walk.
    pub fn next_rss(&mut self) -> f64 {
        let fundamental = self.from + self.done as f64 * self.step;
        self.done += 1;
        if self.done == 1 {
            return self.profile.rss(fundamental);
        }
        for (phasor, turn) in self.profile.phasor.iter_mut().zip(&self.turn) {
            let [c, s] = *phasor;
            *phasor = [c * turn[0] - s * turn[1], s * turn[0] + c * turn[1]];
        }
        self.profile.rss_of_phasor(fundamental)
    }
}

/// Most harmonics a series may have; far beyond what a zig-zag record can carry.
pub const MOST_HARMONICS: usize = 64;

fn phasor(angle: f64) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    [c, s]
}

fn lanes<T>(values: &[T], start: usize) -> &[T; LANES] {
    values[start..start + LANES].try_into().expect("columns are padded to whole blocks")
}

fn add(total: &mut [f64; LANES], factor: &[f64; LANES], term: &[f64; LANES]) {
    for i in 0..LANES {
        total[i] += factor[i] * term[i];
    }
}

/// Σ cos of `count` angles in steps of `angle`, symmetric about zero: sin(n x/2)/sin(x/2), Dirichlet's kernel.
fn even_cosines(count: f64, angle: f64) -> f64 {
    let (half, many) = (0.5 * angle, 0.5 * count * angle);
    let (above, below) = (many.sin(), half.sin());
    // At a multiple of the sampling frequency both vanish.
    if below.abs() < 1e-9 { count * many.cos() / half.cos() } else { above / below }
}

/// Squared length of what a design leaves of a signal.
fn left_over(design: DMatrix<f64>, mut signal: DVector<f64>) -> f64 {
    let width = design.ncols();
    design.qr().q_tr_mul(&mut signal);
    signal.rows_range(width..).norm_squared()
}

/// bᵀ G⁻¹ b by Cholesky in place on the lower triangle; `None` when a pivot is down to rounding.
fn explained(gram: &mut [f64], right: &mut [f64], width: usize) -> Option<f64> {
    let mut explained = 0.0;
    for p in 0..width {
        let diagonal = gram[p * width + p];
        let (done, rest) = gram.split_at_mut(p * width);
        let row = &mut rest[..=p];
        for q in 0..p {
            let above = &done[q * width..q * width + q + 1];
            let dot: f64 = row[..q].iter().zip(&above[..q]).map(|(x, y)| x * y).sum();
            row[q] = (row[q] - dot) / above[q];
        }
        let pivot = diagonal - row[..p].iter().map(|x| x * x).sum::<f64>();
        if pivot <= SMALLEST_PIVOT * diagonal || pivot.is_nan() {
            return None;
        }
        row[p] = pivot.sqrt();
        let dot: f64 = row[..p].iter().zip(right.iter()).map(|(x, y)| x * y).sum();
        right[p] = (right[p] - dot) / row[p];
        explained += right[p] * right[p];
    }
    Some(explained)
}

#[cfg(test)]
mod tests {
    use super::super::basis::Basis;
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn agrees_with_the_orthogonal_decomposition() {
        agree((0..157).map(|i| 1.5 * i as f64 + (3.0 * i as f64).sin() / 3.0).collect());
        for rows in [156, 157] {
            agree((0..rows).map(|i| 1.5 * f64::from(i)).collect());
        }
    }

    fn agree(time: Vec<f64>) {
        let values: Vec<f64> = time.iter().map(|t| 5.0 + (0.05 * t).sin() + 0.2 * (0.31 * t).cos()).collect();
        let mut profile = Profile::new(&time, &values, 5);
        let curve = profile.scan(0.02, 0.003, 20);
        for (k, scanned) in curve.into_iter().enumerate() {
            let w = 0.02 + 0.003 * k as f64;
            let basis = Basis::new(&time, w, 5).expect("enough rows");
            let exact: f64 = basis.project(&values).residual.iter().map(|e| e * e).sum();
            assert_relative_eq!(scanned, exact, max_relative = 1e-8);
            assert_relative_eq!(profile.rss(w), exact, max_relative = 1e-8);
        }
    }

    #[test]
    fn goes_on_where_the_normal_equations_end() {
        for (rows, unevenness) in [(100, 0.0), (101, 0.0), (100, 0.2)] {
            let time: Vec<f64> = (0..rows).map(|i| i as f64 + unevenness * (i as f64).sin()).collect();
            let values: Vec<f64> = time.iter().map(|t| (0.11 * t).sin() + 0.1 * (0.9 * t).cos()).collect();
            let w = 0.025;
            let basis = Basis::new(&time, w, 8).expect("enough rows");
            assert!(basis.condition() > 1e7, "condition {}", basis.condition());
            let exact: f64 = basis.project(&values).residual.iter().map(|e| e * e).sum();
            assert_relative_eq!(Profile::new(&time, &values, 8).rss(w), exact, max_relative = 1e-5);
        }
    }
}
