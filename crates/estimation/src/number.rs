//! Number types of equations: plain values, and dual numbers, which carry derivatives. One evaluation in dual numbers
//! gives a result and its exact derivatives with respect to several parameters (forward automatic differentiation).
//!
//! Equations are written once, for any [`Real`]; the values are computed by the same operations in all types.
//!
//! Source: Wengert (1964), Communications of the ACM 7:463-464.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Number type of an equation: a value, or a value with derivatives. [`abs`](Self::abs), [`at_least`](Self::at_least)
/// and [`clamped`](Self::clamped) compare the values alone; equality includes the derivatives.
pub trait Real:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// Value without derivatives.
    fn value(self) -> f64;

    /// Function of this number, given its value and its derivative `slope` with respect to this number (chain rule).
    fn lift_unary(self, value: f64, slope: f64) -> Self;

    /// Function of this number x and another number y, given its value and its total differential `by(dx, dy)`.
    fn lift_binary(self, other: Self, value: f64, by: impl Fn(f64, f64) -> f64) -> Self;

    /// Power of a positive number.
    fn powf(self, exponent: Self) -> Self;

    /// Sine and cosine.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value().sin_cos();
        (self.lift_unary(sin, cos), self.lift_unary(cos, -sin))
    }

    /// Angle of the point (x, y), rad, with this number as y.
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let square = (self.value() * self.value() + x.value() * x.value()).max(f64::MIN_POSITIVE);
        let (by_y, by_x) = (x.value() / square, -self.value() / square);
        self.lift_binary(x, self.value().atan2(x.value()), |dy, dx| by_y * dy + by_x * dx)
    }

    /// Root √(x² + y²), which must not be zero.
    #[inline(always)]
    fn hypot(self, other: Self) -> Self {
        let root = self.value().hypot(other.value());
        let (by_x, by_y) = (self.value() / root, other.value() / root);
        self.lift_binary(other, root, |x, y| by_x * x + by_y * y)
    }

    /// Hyperbolic tangent.
    #[inline(always)]
    fn tanh(self) -> Self {
        let tanh = self.value().tanh();
        self.lift_unary(tanh, 1.0 - tanh * tanh)
    }

    /// Exponential.
    #[inline(always)]
    fn exp(self) -> Self {
        let exp = self.value().exp();
        self.lift_unary(exp, exp)
    }

    /// Natural logarithm of a positive number.
    #[inline(always)]
    fn ln(self) -> Self {
        self.lift_unary(self.value().ln(), self.value().recip())
    }

    /// Square root of a positive number.
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value().sqrt();
        self.lift_unary(root, 0.5 / root)
    }

    /// Integer power.
    #[inline(always)]
    fn powi(self, exponent: i32) -> Self {
        if exponent == 0 {
            return Self::from(1.0);
        }
        self.lift_unary(self.value().powi(exponent), f64::from(exponent) * self.value().powi(exponent - 1))
    }

    /// Magnitude.
    #[inline(always)]
    fn abs(self) -> Self {
        if self.value() < 0.0 { -self } else { self }
    }

    /// Maximum of this number and a constant; this number, with its derivatives, if they are equal.
    #[inline(always)]
    fn at_least(self, least: f64) -> Self {
        if self.value() >= least { self } else { Self::from(least) }
    }

    /// Number clamped to [least, most].
    #[inline(always)]
    fn clamped(self, least: Self, most: Self) -> Self {
        if self.value() < least.value() {
            least
        } else if self.value() > most.value() {
            most
        } else {
            self
        }
    }
}

impl Real for f64 {
    #[inline(always)]
    fn value(self) -> f64 {
        self
    }

    #[inline(always)]
    fn lift_unary(self, value: f64, _slope: f64) -> Self {
        value
    }

    #[inline(always)]
    fn lift_binary(self, _other: Self, value: f64, _by: impl Fn(f64, f64) -> f64) -> Self {
        value
    }

    #[inline]
    fn powf(self, exponent: Self) -> Self {
        f64::powf(self, exponent)
    }

    #[inline]
    fn abs(self) -> Self {
        f64::abs(self)
    }
}

/// Dual number: a value with its derivatives in `DIRECTIONS` directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<const DIRECTIONS: usize> {
    /// Value of the quantity.
    pub value: f64,
    /// Derivative of the quantity in every direction.
    pub derivatives: [f64; DIRECTIONS],
}

impl<const N: usize> Dual<N> {
    /// Variable with this value, whose derivative in one direction is `slope` and zero in all other directions.
    pub fn variable(value: f64, direction: usize, slope: f64) -> Self {
        let mut derivatives = [0.0; N];
        derivatives[direction] = slope;
        Self { value, derivatives }
    }
}

impl<const N: usize> Default for Dual<N> {
    fn default() -> Self {
        Self::from(0.0)
    }
}

impl<const N: usize> From<f64> for Dual<N> {
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self { value, derivatives: [0.0; N] }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.lift_unary(-self.value, -1.0)
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.lift_binary(other, self.value + other.value, |x, y| x + y)
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.lift_binary(other, self.value - other.value, |x, y| x - y)
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "product rule")]
impl<const N: usize> Mul for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.lift_binary(other, self.value * other.value, |x, y| other.value * x + self.value * y)
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "quotient rule")]
impl<const N: usize> Div for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let (quotient, inverse) = (self.value / other.value, other.value.recip());
        self.lift_binary(other, quotient, |x, y| (x - quotient * y) * inverse)
    }
}

impl<const N: usize> Add<f64> for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl<const N: usize> Sub<f64> for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        Self { value: self.value - other, ..self }
    }
}

impl<const N: usize> Mul<f64> for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self.lift_unary(self.value * other, other)
    }
}

impl<const N: usize> Div<f64> for Dual<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: f64) -> Self {
        self.lift_unary(self.value / other, other.recip())
    }
}

impl<const N: usize> Real for Dual<N> {
    #[inline(always)]
    fn value(self) -> f64 {
        self.value
    }

    #[inline(always)]
    fn lift_unary(mut self, value: f64, slope: f64) -> Self {
        // In place: `array::map` copies.
        self.derivatives.iter_mut().for_each(|d| *d *= slope);
        self.value = value;
        self
    }

    #[inline(always)]
    fn lift_binary(mut self, other: Self, value: f64, by: impl Fn(f64, f64) -> f64) -> Self {
        self.derivatives.iter_mut().zip(&other.derivatives).for_each(|(x, y)| *x = by(*x, *y));
        self.value = value;
        self
    }

    fn powf(self, exponent: Self) -> Self {
        let power = self.value.powf(exponent.value);
        let by_base = exponent.value * power / self.value;
        // A logarithm costs as much as the power; a constant exponent requires none.
        let by_exponent = if exponent.derivatives == [0.0; N] { 0.0 } else { power * self.value.ln() };
        self.lift_binary(exponent, power, |x, y| by_base * x + by_exponent * y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Expression of two variables with every function of the trait.
    fn expression<R: Real>(x: R, y: R) -> R {
        let (sin, cos) = (x * y).sin_cos();
        let power = (x * x + 0.5).powf(y / 3.0) + (y - x).powi(3) * 2.0 + (x * x + 0.1).sqrt().ln() * (y * 0.3).exp();
        power / (cos + 2.0) - (sin - y).tanh()
            + (x * y).atan2(y - x) * x.hypot(y)
            + (-x).abs() * x.at_least(0.4).clamped(R::from(0.1), y + 5.0)
    }

    #[test]
    fn derivatives_are_those_of_the_value() {
        let h = 1e-6;
        for (x, y) in [(0.7, 1.3), (-0.4, 0.2), (2.0, -0.6)] {
            let dual = expression(Dual::<4>::variable(x, 0, 1.0), Dual::variable(y, 3, 1.0));
            assert_eq!(dual.value, expression(x, y));
            let by_x = (expression(x + h, y) - expression(x - h, y)) / (2.0 * h);
            let by_y = (expression(x, y + h) - expression(x, y - h)) / (2.0 * h);
            assert_relative_eq!(dual.derivatives[0], by_x, max_relative = 1e-7, epsilon = 1e-9);
            assert_relative_eq!(dual.derivatives[3], by_y, max_relative = 1e-7, epsilon = 1e-9);
            assert_eq!(dual.derivatives[1..3], [0.0; 2]);
        }
    }
}
