//! Numbers in messages, in plain or scientific notation by their size.

use std::fmt;

/// Number for a message, with all digits; with a power of ten instead of many zeros (1e-12, 1e300).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShortNumber(pub f64);

impl ShortNumber {
    /// Number rounded to significant digits, at least one.
    pub fn rounded(value: f64, digits: usize) -> Self {
        let rounded = format!("{value:.*e}", digits.saturating_sub(1)).parse();
        Self(rounded.expect("a number that was just written"))
    }

    /// `true` if it is written without a power of ten.
    pub fn is_plain(&self) -> bool {
        self.0 == 0.0 || !self.0.is_finite() || PLAIN.contains(&self.0.abs())
    }
}

/// Range of magnitudes written without a power of ten.
const PLAIN: std::ops::Range<f64> = 1e-5..1e16;

impl fmt::Display for ShortNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = *self;
        if self.is_plain() { write!(f, "{value}") } else { write!(f, "{value:e}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_size_hides_the_digits() {
        let shown = [0.0, 10.0, -0.25, 1e-12, 1e300, -2.5e-7, 1e15, f64::NAN, f64::INFINITY]
            .map(|x| ShortNumber(x).to_string());
        assert_eq!(shown, ["0", "10", "-0.25", "1e-12", "1e300", "-2.5e-7", "1000000000000000", "NaN", "inf"]);
    }

    #[test]
    fn rounding_keeps_digits_whatever_the_size() {
        let third =
            [1.0, 1e-30, -1e30, f64::NAN, f64::INFINITY].map(|size| ShortNumber::rounded(size / 3.0, 3).to_string());
        assert_eq!(third, ["0.333", "3.33e-31", "-3.33e29", "NaN", "inf"]);
    }
}
