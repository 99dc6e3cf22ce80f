//! Small square matrices.

/// The unit matrix.
pub fn identity<const N: usize>() -> [[f64; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))))
}

/// A sum of matrices.
pub fn sum<const N: usize>(one: &[[f64; N]; N], other: &[[f64; N]; N]) -> [[f64; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| one[i][j] + other[i][j]))
}

/// A product of matrices of which the first has many zeros: nothing leads back from a ship to what disturbs it.
pub fn product<const N: usize>(one: &[[f64; N]; N], other: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut result = [[0.0; N]; N];
    for (result, one) in result.iter_mut().zip(one) {
        for (one, other) in one.iter().zip(other).filter(|(one, _)| **one != 0.0) {
            result.iter_mut().zip(other).for_each(|(result, other)| *result += one * other);
        }
    }
    result
}

/// F P Fᵀ of a symmetric P.
pub fn sandwich<const N: usize>(f: &[[f64; N]; N], p: &[[f64; N]; N]) -> [[f64; N]; N] {
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
