//! Small square matrices of a fixed size.

/// Unit matrix.
pub fn identity<const N: usize>() -> [[f64; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))))
}

/// Sum of two matrices.
pub fn sum<const N: usize>(left: &[[f64; N]; N], right: &[[f64; N]; N]) -> [[f64; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| left[i][j] + right[i][j]))
}

/// Product of two matrices. Zeros of the first matrix are skipped: a transition matrix with states of a disturbance has
/// many.
pub fn product<const N: usize>(left: &[[f64; N]; N], right: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut result = [[0.0; N]; N];
    for (result, left) in result.iter_mut().zip(left) {
        for (factor, right) in left.iter().zip(right).filter(|(factor, _)| **factor != 0.0) {
            result.iter_mut().zip(right).for_each(|(result, right)| *result += factor * right);
        }
    }
    result
}

/// Congruence F P Fᵀ of a symmetric P.
pub fn congruence<const N: usize>(f: &[[f64; N]; N], p: &[[f64; N]; N]) -> [[f64; N]; N] {
    let half = product(f, p);
    let mut result = [[0.0; N]; N];
    for (j, f) in f.iter().enumerate() {
        for (k, f) in f.iter().enumerate().filter(|(_, f)| **f != 0.0) {
            for i in j..N {
                result[i][j] += half[i][k] * f;
            }
        }
    }
    std::array::from_fn(|i| std::array::from_fn(|j| result[i.max(j)][i.min(j)]))
}

/// Congruence F P Fᵀ of a symmetric P and an upper triangular F.
pub(super) fn congruence_upper<const N: usize>(f: &[[f64; N]; N], p: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut half = [[0.0; N]; N];
    for i in 0..N {
        for k in i..N {
            for j in 0..N {
                half[i][j] += f[i][k] * p[k][j];
            }
        }
    }
    let mut result = [[0.0; N]; N];
    for j in 0..N {
        for i in j..N {
            for k in j..N {
                result[i][j] += half[i][k] * f[j][k];
            }
            result[j][i] = result[i][j];
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn congruence_of_a_triangle_is_that_of_any_matrix() {
        let f = [[1.0, 0.9, 0.4, 0.3], [0.0, 0.8, 0.0, 0.2], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.5]];
        let p: [[f64; 4]; 4] =
            std::array::from_fn(|i| std::array::from_fn(|j| 1.0 / (1 + i + j) as f64 + f64::from(u8::from(i == j))));
        assert_eq!(congruence_upper(&f, &p), congruence(&f, &p));
    }
}
