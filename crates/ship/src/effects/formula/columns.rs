//! A formula over the columns of a table: the same language as that of an effect, with columns as its names.

use super::parse::{FormulaError, parse_columns};
use super::program::FormulaProgram;

/// A formula over named numbers, such as `(port - starboard) / 2`.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnFormula(FormulaProgram);

impl ColumnFormula {
    /// Reads a formula. Fails where the text is none, is too deep, or has more than four names.
    pub fn read(text: &str) -> Result<Self, FormulaError> {
        parse_columns(text).map(Self)
    }

    /// The names in the order of their first use.
    pub fn names(&self) -> &[String] {
        &self.0.constants
    }

    /// Its value where the names have these values, in the same order.
    pub fn value(&self, values: &[f64]) -> f64 {
        self.0.value(values, |_| f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_names_whatever_they_mean_in_an_effect() {
        let formula = ColumnFormula::read("(port - delta) / 2 + r").expect("a formula");
        assert_eq!(formula.names(), ["port", "delta", "r"]);
        assert_eq!(formula.value(&[10.0, -6.0, 0.5]), 8.5);
        assert!(ColumnFormula::read("(port - ").is_err());
    }
}
