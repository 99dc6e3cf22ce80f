//! Interleaved columns: rows that hold one value of every column, so that sums over all columns take one pass.
//!
//! Source: modified Gram–Schmidt orthogonalisation, Golub and Van Loan (2013), Matrix Computations, section 5.2.

use std::array;

use crate::lanes::{Kernel, run_kernel};

/// Number of partial sums computed in parallel.
const SUMS: usize = 4;

/// Orthonormalises the first `L` of `C` columns and projects the last `M` columns off them; returns the last columns
/// and the triangular factor. Row j of the factor holds the components of the later columns along column j, and on the
/// diagonal the length of column j before its normalisation.
///
/// L + M = C. The rows keep the orthonormal columns. A column of zeros remains zero.
pub fn orthonormalise<const C: usize, const L: usize, const M: usize>(
    rows: &mut [[f64; C]],
) -> ([Vec<f64>; M], [[f64; C]; L]) {
    const { assert!(L > 0 && L + M == C) };
    run_kernel(Orthonormalise { rows })
}

struct Orthonormalise<'a, const C: usize, const L: usize, const M: usize> {
    rows: &'a mut [[f64; C]],
}

impl<const C: usize, const L: usize, const M: usize> Kernel for Orthonormalise<'_, C, L, M> {
    type Output = ([Vec<f64>; M], [[f64; C]; L]);

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Self { rows } = self;
        let mut projected: [Vec<f64>; M] = array::from_fn(|_| vec![0.0; rows.len()]);
        let mut triangle = [[0.0; C]; L];
        let mut products = products_after(rows, 0, |_| {});
        for lane in 0..L {
            let length = products[lane].sqrt();
            let per = if length > 0.0 { length.recip() } else { 0.0 };
            let components: [f64; C] = array::from_fn(|k| if k > lane { products[k] * per } else { 0.0 });
            triangle[lane] = components;
            triangle[lane][lane] = length;
            let project = |row: &mut [f64; C]| {
                let unit = row[lane] * per;
                for k in 0..C {
                    row[k] -= components[k] * unit;
                }
                row[lane] = unit;
            };
            if lane + 1 < L {
                products = products_after(rows, lane + 1, project);
                continue;
            }
            let columns = projected.each_mut().map(|column| &mut column[..rows.len()]);
            for (number, row) in rows.iter_mut().enumerate() {
                project(row);
                for k in 0..M {
                    columns[k][number] = row[L + k];
                }
            }
        }
        (projected, triangle)
    }
}

/// Applies `change` to every row and returns the scalar products Σ `row[k] row[lane]` of every column k of the changed
/// rows with column `lane`.
#[inline(always)]
fn products_after<const C: usize>(
    rows: &mut [[f64; C]],
    lane: usize,
    mut change: impl FnMut(&mut [f64; C]),
) -> [f64; C] {
    let mut sums = [[0.0; C]; SUMS];
    let mut rest = [0.0; C];
    let (chunks, tail) = rows.as_chunks_mut::<SUMS>();
    for chunk in chunks {
        for (sum, row) in sums.iter_mut().zip(chunk) {
            change(row);
            let by = row[lane];
            for k in 0..C {
                sum[k] += by * row[k];
            }
        }
    }
    for row in tail {
        change(row);
        for k in 0..C {
            rest[k] += row[lane] * row[k];
        }
    }
    array::from_fn(|k| ((sums[0][k] + sums[1][k]) + (sums[2][k] + sums[3][k])) + rest[k])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::on_every_instruction_set;
    use approx::assert_relative_eq;

    fn rows() -> Vec<[f64; 3]> {
        (0..101).map(|row| [0.7, 0.13, 1.9].map(|frequency| (frequency * f64::from(row)).sin() + 0.1)).collect()
    }

    fn product(rows: &[[f64; 3]], i: usize, j: usize) -> f64 {
        rows.iter().map(|row| row[i] * row[j]).sum()
    }

    #[test]
    fn projected_columns_have_no_component_along_the_first() {
        let before = rows();
        let mut units = before.clone();
        let ([projected], triangle) = orthonormalise::<3, 2, 1>(&mut units);
        let after: Vec<[f64; 3]> = units.iter().zip(&projected).map(|(unit, x)| [unit[0], unit[1], *x]).collect();
        assert_relative_eq!(triangle[0][0], product(&before, 0, 0).sqrt(), epsilon = 1e-12);
        for (i, j, expected) in [(0, 0, 1.0), (1, 1, 1.0), (0, 1, 0.0), (0, 2, 0.0), (1, 2, 0.0)] {
            assert_relative_eq!(product(&after, i, j), expected, epsilon = 1e-12);
        }
        let [first, second] = triangle;
        for (whole, row) in before.iter().zip(&after) {
            assert_relative_eq!(whole[1], first[1] * row[0] + second[1] * row[1], epsilon = 1e-12);
            assert_relative_eq!(whole[2], first[2] * row[0] + second[2] * row[1] + row[2], epsilon = 1e-12);
        }
    }

    #[test]
    fn a_column_of_zeros_takes_nothing_from_the_others() {
        let mut rows: Vec<[f64; 2]> = vec![[0.0, 1.5]; 7];
        assert_eq!(orthonormalise::<2, 1, 1>(&mut rows), ([vec![1.5; 7]], [[0.0, 0.0]]));
    }

    /// [`Orthonormalise`] that owns its rows.
    struct Orthonormalised(Vec<[f64; 3]>);

    impl Kernel for Orthonormalised {
        type Output = ([Vec<f64>; 1], [[f64; 3]; 2]);

        #[inline(always)]
        fn call(mut self) -> Self::Output {
            Orthonormalise { rows: &mut self.0 }.call()
        }
    }

    #[test]
    fn every_instruction_set_gives_the_same_bits() {
        let outputs = on_every_instruction_set(|| Orthonormalised(rows()));
        assert!(outputs.iter().all(|(_, output)| output == &outputs[0].1));
    }
}
