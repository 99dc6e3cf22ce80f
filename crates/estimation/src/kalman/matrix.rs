//! Small square matrices of numbers that may carry derivatives.

use crate::number::Real;

/// The unit matrix.
pub fn identity<R: Real, const N: usize>() -> [[R; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| R::from(f64::from(u8::from(i == j)))))
}

/// A sum of matrices.
pub fn sum<R: Real, const N: usize>(one: &[[R; N]; N], other: &[[R; N]; N]) -> [[R; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| one[i][j] + other[i][j]))
}

/// A product of matrices of which the first has many zeros: nothing leads back from a ship to what disturbs it.
pub fn product<R: Real, const N: usize>(one: &[[R; N]; N], other: &[[R; N]; N]) -> [[R; N]; N] {
    let mut result = [[R::from(0.0); N]; N];
    for (result, one) in result.iter_mut().zip(one) {
        for (one, other) in one.iter().zip(other).filter(|(one, _)| !one.vanishes()) {
            for (result, other) in result.iter_mut().zip(other) {
                *result = *result + *one * *other;
            }
        }
    }
    result
}

/// F P Fᵀ of a symmetric P.
pub fn sandwich<R: Real, const N: usize>(f: &[[R; N]; N], p: &[[R; N]; N]) -> [[R; N]; N] {
    let half = product(f, p);
    let mut result = [[R::from(0.0); N]; N];
    for (j, f) in f.iter().enumerate() {
        for (k, f) in f.iter().enumerate().filter(|(_, f)| !f.vanishes()) {
            for i in j..N {
                result[i][j] = result[i][j] + half[i][k] * *f;
            }
        }
    }
    std::array::from_fn(|i| std::array::from_fn(|j| result[i.max(j)][i.min(j)]))
}
