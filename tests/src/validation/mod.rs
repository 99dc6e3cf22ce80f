//! Validation as data: every published or independently computed number, with our number and a tolerance.
//!
//! A [`Check`] is a value; [`sections`] computes all of them by real simulation and identification, [`pages`] writes
//! VALIDATION.md and docs/validation.csv from them, and a test asserts that every check holds. Sources are named by
//! author and year; "independent computation" is a program in Python (numpy and scipy) written for the project's
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

/// Tolerance between our number and the published number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// Absolute, in the unit of the number.
    Absolute(f64),
    /// Relative to the published number.
    Relative(f64),
    /// Lower limit: the published number is a minimum.
    AtLeast,
}

/// Check of our number against a published number.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    /// Identifier, unique among all checks.
    pub id: String,
    /// Compared quantity, in words.
    pub what: String,
    /// Source of the published number.
    pub source: &'static str,
    /// Number as published.
    pub published: f64,
    /// Number of decimals of the published number.
    pub decimals: usize,
    /// Our number.
    pub ours: f64,
    /// Tolerance between both numbers.
    pub tolerance: Tolerance,
    /// Unit of both numbers.
    pub unit: &'static str,
}

/// Source of numbers that were computed for this project by other means.
pub const INDEPENDENT: &str = "independent computation";

/// Source of numbers that are lower bounds for unbiased methods.
pub const BOUND: &str = "Cramér-Rao bound";

/// Source of numbers that follow from a definition.
pub const DEFINITION: &str = "definition";

impl Check {
    /// Check against an independently computed number, with its decimals.
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

    /// Check against a number from a published source.
    pub fn from(self, source: &'static str) -> Self {
        Self { source, ..self }
    }

    /// Our number minus the published number.
    pub fn difference(&self) -> f64 {
        self.ours - self.published
    }

    /// `true` if our number agrees within the tolerance; `false` if it is not finite.
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
    /// Method of computation, and origin of the tolerances.
    pub method: &'static str,
    /// Checks of the section.
    pub checks: Vec<Check>,
}

/// All sections, computed when called.
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
