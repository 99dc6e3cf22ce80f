//! Validation as data: every published or independently computed number, ours beside it, and how far they may differ.
//!
//! A [`Check`] is a value; [`sections`] computes all of them by real simulation and identification, [`pages`] writes
//! VALIDATION.md and docs/validation.csv from them, and a test asserts that every one holds. Sources are named
//! by author and year; "independent computation" is a program in Python (numpy and scipy) written for the project's
//! technical reference, which shares no code with this workspace.

pub mod characteristic_points;
pub mod estimators;
pub mod first_order;
pub mod fourier;
pub mod hulls;
pub mod information;
pub mod likelihood;
pub mod pages;
pub mod published;
pub mod residuals;
pub mod table_1;
pub mod zig_zags_of_hulls;

/// How far our number may lie from the published one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// In the unit of the number.
    Absolute(f64),
    /// As a share of the published number.
    Relative(f64),
    /// The published number is a lower limit.
    AtLeast,
}

/// One published number and ours.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// Identifier, unique among all checks.
    pub id: String,
    /// What is compared, in words.
    pub what: String,
    /// Who published the number.
    pub source: &'static str,
    /// The number as published.
    pub published: f64,
    /// Digits after the point it was published with.
    pub decimals: usize,
    /// Our number.
    pub ours: f64,
    /// How far they may differ.
    pub tolerance: Tolerance,
    /// Unit of both.
    pub unit: &'static str,
}

/// Source of numbers that were computed for this project by other means.
pub const INDEPENDENT: &str = "independent computation";

/// Source of numbers that no unbiased method can go below.
pub const BOUND: &str = "Cramér-Rao bound";

/// Source of numbers that hold by what they mean.
pub const DEFINITION: &str = "definition";

impl Check {
    /// A number that was computed independently, with its decimals, and ours.
    pub fn new(
        id: impl Into<String>,
        what: impl Into<String>,
        (published, decimals): (f64, usize),
        ours: f64,
        tolerance: Tolerance,
        unit: &'static str,
    ) -> Self {
        Self { id: id.into(), what: what.into(), source: INDEPENDENT, published, decimals, ours, tolerance, unit }
    }

    /// The same, published by somebody.
    pub fn from(self, source: &'static str) -> Self {
        Self { source, ..self }
    }

    /// Ours less the published number.
    pub fn difference(&self) -> f64 {
        self.ours - self.published
    }

    /// `true` if our number agrees; one that is not finite never does.
    pub fn holds(&self) -> bool {
        match self.tolerance {
            Tolerance::Absolute(most) => self.difference().abs() <= most,
            Tolerance::Relative(share) => self.difference().abs() <= share * self.published.abs(),
            Tolerance::AtLeast => self.ours >= self.published && self.ours.is_finite(),
        }
    }

    /// Size of the difference as a share of the tolerance; `None` against a lower limit.
    pub fn share_of_tolerance(&self) -> Option<f64> {
        let tolerance = match self.tolerance {
            Tolerance::Absolute(most) => most,
            Tolerance::Relative(share) => share * self.published.abs(),
            Tolerance::AtLeast => return None,
        };
        Some(self.difference().abs() / tolerance)
    }
}

/// Checks of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Heading.
    pub title: &'static str,
    /// How the numbers were made, and where tolerances come from.
    pub method: &'static str,
    /// The checks.
    pub checks: Vec<Check>,
}

/// Every section, computed now.
pub fn sections() -> Vec<Section> {
    vec![
        published::limits(),
        published::hull_coefficients(),
        first_order::section(),
        fourier::section(),
        characteristic_points::section(),
        hulls::section(),
        zig_zags_of_hulls::section(),
        estimators::section(),
        information::bound(),
        information::efficiency(),
        likelihood::section(),
        residuals::section(),
        table_1::section(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(published: f64, ours: f64, tolerance: Tolerance) -> Check {
        let (id, what) = (String::from("id"), String::from("what"));
        Check { id, what, source: INDEPENDENT, published, decimals: 2, ours, tolerance, unit: "s" }
    }

    #[test]
    fn a_check_can_fail() {
        assert!(check(10.0, 10.1, Tolerance::Absolute(0.11)).holds());
        assert!(!check(10.0, 10.2, Tolerance::Absolute(0.11)).holds());
        assert!(check(-10.0, -10.1, Tolerance::Relative(0.011)).holds());
        assert!(!check(-10.0, -10.2, Tolerance::Relative(0.011)).holds());
        assert!(!check(10.0, f64::NAN, Tolerance::Absolute(1e9)).holds());
        assert!(!check(10.0, f64::INFINITY, Tolerance::AtLeast).holds());
        assert!(!check(10.0, 9.9, Tolerance::AtLeast).holds());
        let share = check(-10.0, -10.2, Tolerance::Relative(0.01)).share_of_tolerance();
        assert!(share.is_some_and(|share| (share - 2.0).abs() < 1e-9));
    }
}
