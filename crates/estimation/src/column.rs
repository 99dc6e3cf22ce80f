//! Sums over columns of numbers. Every sum has eight lanes that are added pairwise at the end: the lanes are
//! independent, so a processor can compute them in parallel, and pairwise sums have smaller rounding errors.
//!
//! Source: Higham (2002), Accuracy and Stability of Numerical Algorithms, second edition, chapter 4.

use crate::lanes::{Kernel, run_kernel};

/// Number of partial sums computed in parallel.
const LANES: usize = 8;

/// Pairwise sum of the lanes.
#[inline(always)]
fn total(lanes: [f64; LANES]) -> f64 {
    let [a, b, c, d, e, f, g, h] = lanes;
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

/// Gram matrix Σ xᵢ xⱼ of `N` columns; columns of different length are truncated to the shortest.
pub fn gram<const N: usize>(columns: [&[f64]; N]) -> [[f64; N]; N] {
    run_kernel(Gram(columns))
}

struct Gram<'a, const N: usize>([&'a [f64]; N]);

impl<const N: usize> Kernel for Gram<'_, N> {
    type Output = [[f64; N]; N];

    #[inline(always)]
    fn call(self) -> Self::Output {
        let rows = self.0.iter().map(|column| column.len()).min().unwrap_or(0);
        let columns = self.0.map(|column| &column[..rows]);
        let mut sums = [[[0.0; LANES]; N]; N];
        let blocks = columns.map(|column| column.as_chunks::<LANES>().0);
        for block in 0..rows / LANES {
            let x = blocks.map(|column| column[block]);
            for i in 0..N {
                for j in i..N {
                    for lane in 0..LANES {
                        sums[i][j][lane] += x[i][lane] * x[j][lane];
                    }
                }
            }
        }
        for row in rows - rows % LANES..rows {
            for i in 0..N {
                for j in i..N {
                    sums[i][j][row % LANES] += columns[i][row] * columns[j][row];
                }
            }
        }
        let mut products = [[0.0; N]; N];
        for i in 0..N {
            for j in i..N {
                (products[i][j], products[j][i]) = (total(sums[i][j]), total(sums[i][j]));
            }
        }
        products
    }
}

/// Projection of a column on the constant and on a unit column.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ColumnProjection {
    /// Mean of the column.
    pub mean: f64,
    /// Component along the unit column.
    pub component: f64,
}

/// Subtracts from a column, in place, its projection on the constant and on `unit` (length 1, mean 0, as many rows),
/// and returns the projection.
pub fn subtract_projection(unit: &[f64], column: &mut [f64]) -> ColumnProjection {
    run_kernel(Project { unit, column })
}

struct Project<'a> {
    unit: &'a [f64],
    column: &'a mut [f64],
}

impl Kernel for Project<'_> {
    type Output = ColumnProjection;

    #[inline(always)]
    fn call(self) -> ColumnProjection {
        let Self { unit, column } = self;
        let mean = sum(column) / column.len() as f64;
        for x in column.iter_mut() {
            *x -= mean;
        }
        let component = dot(unit, column);
        for (x, u) in column.iter_mut().zip(unit) {
            *x -= component * u;
        }
        ColumnProjection { mean, component }
    }
}

/// Scalar product Σ x y over the rows that both columns have.
#[inline(always)]
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    let rows = x.len().min(y.len());
    let ((x, x_tail), (y, y_tail)) = (x[..rows].as_chunks::<LANES>(), y[..rows].as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (x, y) in x.iter().zip(y) {
        for lane in 0..LANES {
            sums[lane] += x[lane] * y[lane];
        }
    }
    for (sum, (x, y)) in sums.iter_mut().zip(x_tail.iter().zip(y_tail)) {
        *sum += x * y;
    }
    total(sums)
}

/// Sum Σ x.
#[inline(always)]
pub fn sum(x: &[f64]) -> f64 {
    let (blocks, tail) = x.as_chunks::<LANES>();
    let mut sums = [0.0; LANES];
    for x in blocks {
        for lane in 0..LANES {
            sums[lane] += x[lane];
        }
    }
    for (sum, x) in sums.iter_mut().zip(tail) {
        *sum += x;
    }
    total(sums)
}

/// Minimum and maximum of a column. NaN is ignored; an empty column gives (∞, −∞).
#[inline]
pub fn extremes(x: &[f64]) -> (f64, f64) {
    let (blocks, tail) = x.as_chunks::<LANES>();
    let (mut lo, mut hi) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
    let mut include = |lane: usize, x: f64| {
        lo[lane] = if x < lo[lane] { x } else { lo[lane] };
        hi[lane] = if x > hi[lane] { x } else { hi[lane] };
    };
    for block in blocks {
        for (lane, &x) in block.iter().enumerate() {
            include(lane, x);
        }
    }
    tail.iter().for_each(|&x| include(0, x));
    (lo.into_iter().fold(f64::INFINITY, f64::min), hi.into_iter().fold(f64::NEG_INFINITY, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::on_every_instruction_set;
    use approx::assert_relative_eq;

    fn columns(rows: usize) -> [Vec<f64>; 3] {
        let column = |frequency: f64| (0..rows).map(|k| (frequency * k as f64).sin() + 0.1).collect();
        [0.7, 0.13, 1.9].map(column)
    }

    #[test]
    fn extremes_pass_over_what_is_no_number() {
        assert_eq!(extremes(&[f64::NAN, 2.0, -1.0, f64::NAN, 5.0, 3.0, 9.5, 0.0, 1.0, f64::NAN, -7.0]), (-7.0, 9.5));
        assert_eq!(extremes(&[]), (f64::INFINITY, f64::NEG_INFINITY));
    }

    #[test]
    fn sums_are_those_of_the_textbook() {
        for rows in [0, 1, 7, 8, 9, 31, 200] {
            let [x, y, _] = columns(rows);
            let plain = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
            assert_relative_eq!(dot(&x, &y), plain(&x, &y), epsilon = 1e-12);
            assert_relative_eq!(sum(&y), y.iter().sum::<f64>(), epsilon = 1e-12);
            assert_eq!(gram([&x, &y]), [[dot(&x, &x), dot(&x, &y)], [dot(&y, &x), dot(&y, &y)]]);
        }
    }

    #[test]
    fn a_projected_column_has_no_part_left() {
        let [mut unit, column, _] = columns(301);
        let mean = sum(&unit) / 301.0;
        unit.iter_mut().for_each(|x| *x -= mean);
        let length = dot(&unit, &unit).sqrt();
        unit.iter_mut().for_each(|x| *x /= length);
        let mut projected = column.clone();
        let removed = subtract_projection(&unit, &mut projected);
        assert_relative_eq!(sum(&projected), 0.0, epsilon = 1e-12);
        assert_relative_eq!(dot(&unit, &projected), 0.0, epsilon = 1e-12);
        for (row, (whole, residual)) in column.iter().zip(&projected).enumerate() {
            assert_relative_eq!(*whole, residual + removed.mean + removed.component * unit[row], epsilon = 1e-12);
        }
    }

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        for rows in [5, 8, 271, 1201] {
            let [x, y, z] = columns(rows);
            let products = on_every_instruction_set(|| Gram([&x, &y, &z]));
            assert!(products.iter().all(|(_, output)| output == &products[0].1), "{products:?}");
            let projected = on_every_instruction_set(|| Projected { unit: &x, column: z.clone() });
            assert!(projected.iter().all(|(_, output)| output == &projected[0].1), "{projected:?}");
        }
    }

    /// [`Project`] that returns the projected column, too.
    struct Projected<'a> {
        unit: &'a [f64],
        column: Vec<f64>,
    }

    impl Kernel for Projected<'_> {
        type Output = (ColumnProjection, Vec<f64>);

        #[inline(always)]
        fn call(mut self) -> Self::Output {
            let removed = Project { unit: self.unit, column: &mut self.column }.call();
            (removed, self.column)
        }
    }
}
