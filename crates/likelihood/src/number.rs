//! The numbers of a filter: plain ones, and ones that carry as many derivatives as the noise has unknowns.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number that a filter can be written in.
pub trait Variable:
    Copy
    + Debug
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// A value whose derivative in one lane is `slope`.
    fn variable(value: f64, lane: usize, slope: f64) -> Self;

    /// The value alone.
    fn value(self) -> f64;

    /// Its derivatives, where it has some.
    fn slopes(&self) -> &[f64];

    /// A function of this number, from its value there and its slope.
    fn chained(self, value: f64, slope: f64) -> Self {
        (self + -self.value()) * slope + value
    }

    /// Whether it is zero and stays so.
    fn vanishes(&self) -> bool {
        self.value() == 0.0 && self.slopes().iter().all(|&by| by == 0.0)
    }
}

impl Variable for f64 {
    fn variable(value: f64, _: usize, _: f64) -> Self {
        value
    }

    #[inline]
    fn value(self) -> f64 {
        self
    }

    #[inline]
    fn slopes(&self) -> &[f64] {
        &[]
    }
}

/// A value and its derivatives in some lanes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<const LANES: usize> {
    /// The value.
    pub value: f64,
    /// Its derivatives.
    pub by: [f64; LANES],
}

impl<const LANES: usize> Dual<LANES> {
    #[inline(always)]
    fn joined(self, other: Self, value: f64, by: impl Fn(f64, f64) -> f64) -> Self {
        Self { value, by: std::array::from_fn(|k| by(self.by[k], other.by[k])) }
    }

    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        Self { value: self.value * factor, by: self.by.map(|by| by * factor) }
    }
}

impl<const LANES: usize> Variable for Dual<LANES> {
    fn variable(value: f64, lane: usize, slope: f64) -> Self {
        let mut by = [0.0; LANES];
        by[lane] = slope;
        Self { value, by }
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }

    #[inline(always)]
    fn slopes(&self) -> &[f64] {
        &self.by
    }
}

impl<const LANES: usize> From<f64> for Dual<LANES> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self { value, by: [0.0; LANES] }
    }
}

impl<const LANES: usize> Neg for Dual<LANES> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.scaled(-1.0)
    }
}

impl<const LANES: usize> Add for Dual<LANES> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.joined(other, self.value + other.value, |x, y| x + y)
    }
}

impl<const LANES: usize> Sub for Dual<LANES> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.joined(other, self.value - other.value, |x, y| x - y)
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "the rule of the product")]
impl<const LANES: usize> Mul for Dual<LANES> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.joined(other, self.value * other.value, |x, y| other.value * x + self.value * y)
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "the rule of the quotient")]
impl<const LANES: usize> Div for Dual<LANES> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let (quotient, inverse) = (self.value / other.value, other.value.recip());
        self.joined(other, quotient, |x, y| (x - quotient * y) * inverse)
    }
}

impl<const LANES: usize> Add<f64> for Dual<LANES> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl<const LANES: usize> Mul<f64> for Dual<LANES> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self.scaled(other)
    }
}

impl<const LANES: usize> Div<f64> for Dual<LANES> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: f64) -> Self {
        self.scaled(other.recip())
    }
}
