//! A record as a quadrature: instants with weights, folded about the middle of the record, and fewer of them in its
//! place.
//!
//! A sum over rows of a smooth function of time is, to rounding, a sum over Chebyshev nodes of the record: as many as
//! the function has Chebyshev coefficients. So a long record is turned once into the few nodes that the highest
//! frequency needs, and a search over frequencies costs the same whatever the sampling. It knows no model of the
//! signal.

use std::f64::consts::PI;

/// Instants handled together: as many sums that do not wait for each other, in an order that no machine changes, and as
/// few as stay in registers.
pub const LANES: usize = 4;

/// Deviation from even steps, as a share of the step, that is rounding of the clock.
const EVEN: f64 = 1e-7;

/// −ln of the error of a sum over nodes against the largest of its terms.
const NODE_DIGITS: f64 = 37.0;

/// Instants u ≥ 0 from the middle of a record, such that for f = fₑ + fₒ, even and odd in u,
/// Σ f = Σ weight fₑ + skew fₒ and Σ y f = Σ even fₑ + odd fₒ, left sums over the rows of the record.
///
/// All columns have one length, a multiple of [`LANES`]; the padding holds zeros.
#[derive(Debug, Clone, Default)]
pub struct Nodes {
    /// u, s.
    pub time: Vec<f64>,
    /// Even and odd part of the signal.
    pub even: Vec<f64>,
    /// See [`Self::even`].
    pub odd: Vec<f64>,
    /// Even and odd part of the number of rows.
    pub weight: Vec<f64>,
    /// See [`Self::weight`].
    pub skew: Vec<f64>,
    /// Whether every row has its mirror image, so that `skew` is zero.
    pub is_symmetric: bool,
    /// Instants without the padding.
    pub used: usize,
}

impl Nodes {
    /// The rows of a record of `values` at `time` (s, increasing, equal lengths, at least 2).
    pub fn of_rows(time: &[f64], values: &[f64]) -> Self {
        let rows = time.len();
        let centre = 0.5 * (time[0] + time[rows - 1]);
        let is_symmetric = has_even_steps(time);
        let mut nodes = Self { is_symmetric, ..Self::default() };
        // Of an even record the rows from the middle on, each with its mirror image.
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
        self.used = self.time.len();
        let padded = self.used.next_multiple_of(LANES);
        for column in [&mut self.time, &mut self.even, &mut self.odd, &mut self.weight, &mut self.skew] {
            column.resize(padded, 0.0);
        }
    }

    /// Chebyshev nodes, an even number, over a record of length L that carry Σ Tₖ(ξ), ξ = 1 − 2 (sin ½wu / sin a)², for
    /// k ≤ `order` and a = `quarter_turn` = ¼wL, or ½π where that is less.
    ///
    /// The coefficient m of a function bounded by M on the ellipse of sum of semi-axes e^σ is below 2 M e^−mσ
    /// (Bernstein), and Tₖ(ξ) is largest there at its imaginary end: Tₖ = cosh kη, sinh ½η = sinh(a sinh σ) / sin a.
    pub fn needed(order: usize, quarter_turn: f64) -> usize {
        let a = quarter_turn;
        let height = |sigma: f64| 2.0 * ((a * sigma.sinh()).sinh() / a.min(0.5 * PI).sin()).asinh();
        let count = |sigma: f64| (order as f64 * height(sigma) + NODE_DIGITS) / sigma;
        let least = (1..=30).map(|tenths| count(0.1 * f64::from(tenths))).fold(f64::INFINITY, f64::min);
        2 * (0.5 * least).ceil().min(1e9) as usize
    }

    /// `count` (even) Chebyshev nodes of the interval ±`half_length` (s) in place of these instants.
    ///
    /// With f(t) = Σ aₖ Tₖ(τ), τ = u/`half_length`, Σ y f = Σ aₖ μₖ, μₖ = Σ y Tₖ(τ); the coefficients are sums of f
    /// over the nodes τⱼ, aₖ = (2/n) Σ f(τⱼ) Tₖ(τⱼ), half that for k = 0, so that node j gets (2/n) Σ μₖ Tₖ(τⱼ).
    pub fn fewer(&self, count: usize, half_length: f64) -> Self {
        let relative: Vec<f64> = self.time.iter().map(|u| u / half_length).collect();
        let half = count / 2;
        let places: Vec<f64> = (0..half).map(|j| ((j as f64 + 0.5) * PI / count as f64).cos()).collect();
        let mut nodes = Self { is_symmetric: self.is_symmetric, ..Self::default() };
        places.iter().for_each(|tau| nodes.push(tau * half_length, [0.0; 2], [0.0; 2]));
        let carry = |first: usize, columns: &mut [(&[f64], &mut Vec<f64>)]| {
            let (mut here, mut there) = (EveryOther::new(&relative, first), EveryOther::new(&places, first));
            for k in (first..count).step_by(2) {
                // Twice the formula: a node stands for its mirror image too.
                let share = if k == 0 { 2.0 } else { 4.0 } / count as f64;
                for (from, to) in columns.iter_mut() {
                    let moment = share * dot(from, &here.values);
                    to.iter_mut().zip(&there.values).for_each(|(value, t)| *value += moment * t);
                }
                here.advance();
                there.advance();
            }
        };
        carry(0, &mut [(&self.even, &mut nodes.even), (&self.weight, &mut nodes.weight)]);
        if self.is_symmetric {
            carry(1, &mut [(&self.odd, &mut nodes.odd)]);
        } else {
            carry(1, &mut [(&self.odd, &mut nodes.odd), (&self.skew, &mut nodes.skew)]);
        }
        nodes.pad();
        nodes
    }
}

/// Whether times (s, increasing, at least 2) are a step apart to the rounding of a clock: then every one has its mirror
/// image about the middle.
pub fn has_even_steps(time: &[f64]) -> bool {
    let step = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    time.iter().enumerate().all(|(row, t)| (t - time[0] - row as f64 * step).abs() <= EVEN * step)
}

/// Chebyshev polynomials of every other order at given places: Tₖ₊₂ = 2 T₂ Tₖ − Tₖ₋₂.
struct EveryOther {
    twice_second: Vec<f64>,
    before: Vec<f64>,
    values: Vec<f64>,
}

impl EveryOther {
    /// From order `first`, 0 or 1, on.
    fn new(places: &[f64], first: usize) -> Self {
        let second = |x: &f64| 2.0 * x * x - 1.0;
        let twice_second = places.iter().map(|x| 2.0 * second(x)).collect();
        // T₋₂ = T₂ and T₋₁ = T₁.
        let (before, values) = if first == 0 {
            (places.iter().map(second).collect(), vec![1.0; places.len()])
        } else {
            (places.to_vec(), places.to_vec())
        };
        Self { twice_second, before, values }
    }

    fn advance(&mut self) {
        for ((next, here), twice) in self.before.iter_mut().zip(&self.values).zip(&self.twice_second) {
            *next = twice * here - *next;
        }
        std::mem::swap(&mut self.before, &mut self.values);
    }
}

/// The block of a padded column from `start` on.
pub fn lanes<T>(values: &[T], start: usize) -> &[T; LANES] {
    values[start..start + LANES].try_into().expect("columns are padded to whole blocks")
}

/// Σ x y of columns of one length, [`LANES`] sums at a time.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    let ((x, x_rest), (y, y_rest)) = (x.as_chunks::<LANES>(), y.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (x, y) in x.iter().zip(y) {
        for i in 0..LANES {
            sums[i] += x[i] * y[i];
        }
    }
    let rest: f64 = x_rest.iter().zip(y_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn sums(nodes: &Nodes, cosine: bool, rate: f64) -> [f64; 2] {
        let mut found = [0.0; 2];
        for j in 0..nodes.time.len() {
            let (s, c) = (rate * nodes.time[j]).sin_cos();
            let columns = if cosine { [nodes.weight[j], nodes.even[j]] } else { [nodes.skew[j], nodes.odd[j]] };
            found[0] += columns[0] * if cosine { c } else { s };
            found[1] += columns[1] * if cosine { c } else { s };
        }
        found
    }

    /// Sums of cos and sin of the rows against those of a tenth as many nodes, to 1e-12 of the number of rows.
    #[test]
    fn fewer_nodes_carry_the_same_sums() {
        for unevenness in [0.0, 0.2] {
            let time: Vec<f64> = (0..1201).map(|i| 0.5 * (i as f64 + unevenness * (i as f64).sin())).collect();
            let values: Vec<f64> = (0..1201).map(|i| ((i * i) as f64).sin()).collect();
            let rows = Nodes::of_rows(&time, &values);
            let length = time[1200] - time[0];
            let count = Nodes::needed(16, 0.25 * 0.01 * length);
            assert!(count < 120, "{count} nodes");
            let nodes = rows.fewer(count, 0.5 * length);
            for k in 0..=16 {
                let rate = 0.01 * f64::from(k);
                for cosine in [true, false] {
                    let (exact, found) = (sums(&rows, cosine, rate), sums(&nodes, cosine, rate));
                    assert_abs_diff_eq!(exact[0], found[0], epsilon = 1.2e-9);
                    assert_abs_diff_eq!(exact[1], found[1], epsilon = 1.2e-9);
                }
            }
        }
    }
}
