//! Record folded about its middle: every row of a record in even steps has its mirror image, so that sums of even and
//! odd functions of time run over half the rows.

/// Number of instants summed in parallel: independent sums in a fixed order, few enough to stay in registers.
pub const LANES: usize = 4;

/// Maximum deviation from even steps, as a share of the step, that is treated as rounding of the clock.
const EVEN_STEP_TOLERANCE: f64 = 1e-7;

/// Instants u ≥ 0 from the middle of a record, such that for f = fₑ + fₒ, even and odd in u,
/// Σ f = Σ weight fₑ + skew fₒ and Σ y f = Σ even fₑ + odd fₒ, left sums over the rows of the record.
///
/// All columns have one length, a multiple of [`LANES`]; the padding holds zeros.
#[derive(Debug, Clone, Default)]
pub struct FoldedRows {
    /// Time u from the middle, s.
    pub time: Vec<f64>,
    /// Factor of fₑ in Σ y f: the signal, or its sum at u and −u if the row has its mirror image.
    pub even: Vec<f64>,
    /// Factor of fₒ in Σ y f: the signal with the sign of its side, or its difference between u and −u.
    pub odd: Vec<f64>,
    /// Factor of fₑ in Σ f: number of rows at ±u.
    pub weight: Vec<f64>,
    /// Factor of fₒ in Σ f: sign of the side of a single row, zero for a pair.
    pub skew: Vec<f64>,
    /// `true` if every row has its mirror image, so that `skew` is zero.
    pub is_symmetric: bool,
    /// Number of instants without the padding.
    pub used_rows: usize,
}

impl FoldedRows {
    /// Folded rows of a record of `values` at `time` (s, increasing, equal lengths, at least 2).
    pub fn from_rows(time: &[f64], values: &[f64]) -> Self {
        let rows = time.len();
        let centre = 0.5 * (time[0] + time[rows - 1]);
        let is_symmetric = has_even_steps(time);
        let mut nodes = Self { is_symmetric, ..Self::default() };
        // For an even record the rows from the middle on, each with its mirror image.
        for row in if is_symmetric { rows / 2 } else { 0 }..rows {
            let u = time[row] - centre;
            let mirror = rows - 1 - row;
            if !is_symmetric {
                nodes.push(u.abs(), [values[row], u.signum() * values[row]], [1.0, u.signum()]);
            } else if mirror == row {
                nodes.push(0.0, [values[row], 0.0], [1.0, 0.0]);
            } else {
                nodes.push(u, [values[row] + values[mirror], values[row] - values[mirror]], [2.0, 0.0]);
            }
        }
        nodes.pad();
        nodes
    }

    fn push(&mut self, time: f64, [even, odd]: [f64; 2], [weight, skew]: [f64; 2]) {
        self.time.push(time);
        self.even.push(even);
        self.odd.push(odd);
        self.weight.push(weight);
        self.skew.push(skew);
    }

    fn pad(&mut self) {
        self.used_rows = self.time.len();
        let padded = self.used_rows.next_multiple_of(LANES);
        for column in [&mut self.time, &mut self.even, &mut self.odd, &mut self.weight, &mut self.skew] {
            column.resize(padded, 0.0);
        }
    }
}

/// `true` if times (s, increasing, at least 2) have even steps to the rounding of a clock: then every time has its
/// mirror image about the middle.
pub fn has_even_steps(time: &[f64]) -> bool {
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    time.iter().enumerate().all(|(row, t)| (t - time[0] - row as f64 * step).abs() <= EVEN_STEP_TOLERANCE * step)
}

/// Block of [`LANES`] values of a padded column, from row `start` on.
pub fn lanes<T>(values: &[T], start: usize) -> &[T; LANES] {
    values[start..start + LANES].try_into().expect("columns are padded to whole blocks")
}

/// Sum of products Σ x y of columns of equal length, in [`LANES`] parallel sums.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    let ((x, x_tail), (y, y_tail)) = (x.as_chunks::<LANES>(), y.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (x, y) in x.iter().zip(y) {
        for i in 0..LANES {
            sums[i] += x[i] * y[i];
        }
    }
    let tail: f64 = x_tail.iter().zip(y_tail).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + tail
}
