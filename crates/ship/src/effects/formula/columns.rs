//! Formula over the columns of a table, in the language of effects with column names instead of signals.

use super::parse::{FormulaError, parse_columns};
use super::program::FormulaProgram;

/// Formula over named columns, such as `(port - starboard) / 2`.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnFormula(FormulaProgram);

impl ColumnFormula {
    /// Formula parsed from text. Fails for a syntax error, nesting that is too deep, or more than four names.
    pub fn parse(text: &str) -> Result<Self, FormulaError> {
        parse_columns(text).map(Self)
    }

    /// Column names in the order of their first use.
    pub fn column_names(&self) -> &[String] {
        &self.0.constants
    }

    /// Value of the formula; `values` belong to [`column_names`](Self::column_names), in their order.
    pub fn value(&self, values: &[f64]) -> f64 {
        self.0.value(values, |_| f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_names_whatever_they_mean_in_an_effect() {
        let formula = ColumnFormula::parse("(port - delta) / 2 + r").expect("a formula");
        assert_eq!(formula.column_names(), ["port", "delta", "r"]);
        assert_eq!(formula.value(&[10.0, -6.0, 0.5]), 8.5);
        assert!(ColumnFormula::parse("(port - ").is_err());
    }
}
