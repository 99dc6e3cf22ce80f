//! Validation as data: every published or independently computed number, ours beside it, and how far they may differ.
//!
//! A [`Check`] is a value; [`sections`] computes all of them by real simulation and identification, [`markdown`] writes
//! VALIDATION.md from them, and a test asserts that every one holds. Sources are named by author and year; "independent
//! computation" is a program in Python (numpy and scipy) written for the project's technical reference, which shares no
//! code with this workspace.

pub mod characteristic_points;
pub mod estimators;
pub mod first_order;
pub mod fourier;
pub mod hulls;
pub mod information;
pub mod likelihood;
pub mod residuals;
pub mod table_1;
pub mod zig_zags_of_hulls;

use std::collections::BTreeSet;

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

    /// Whether our number agrees; one that is not finite never does.
    pub fn holds(&self) -> bool {
        match self.tolerance {
            Tolerance::Absolute(most) => self.difference().abs() <= most,
            Tolerance::Relative(share) => self.difference().abs() <= share * self.published.abs(),
            Tolerance::AtLeast => self.ours >= self.published && self.ours.is_finite(),
        }
    }

    fn row(&self) -> String {
        let Self { what, source, published, decimals, ours, unit, .. } = self;
        let blank = if unit.is_empty() { "" } else { " " };
        let (published, own) = (written(*published, *decimals), written(*ours, decimals + 1));
        let tolerance = match self.tolerance {
            Tolerance::Absolute(most) => format!("{}{blank}{unit}", shortest(most)),
            Tolerance::Relative(share) => format!("{} %", shortest(100.0 * share)),
            Tolerance::AtLeast => "at least".to_owned(),
        };
        let difference = match self.tolerance {
            Tolerance::AtLeast => "–".to_owned(),
            _ => signed(self.difference(), decimals + 1),
        };
        let verdict = if self.holds() { "agrees" } else { "**differs**" };
        format!(
            "| {what} | {source} | {published}{blank}{unit} | {own}{blank}{unit} | {difference} | {tolerance} | {verdict} |"
        )
    }
}

/// A number with fixed decimals, or in powers of ten where those would be many; never "-0.00".
fn written(value: f64, decimals: usize) -> String {
    if value != 0.0 && value.abs() >= 1e5 {
        return format!("{value:.0e}");
    }
    let text = format!("{value:.decimals$}");
    if text.starts_with('-') && text[1..].chars().all(|c| c == '0' || c == '.') { text[1..].to_owned() } else { text }
}

/// A difference with its sign; none for one that is zero to its last digit.
fn signed(value: f64, decimals: usize) -> String {
    let text = written(value, decimals);
    let is_zero = text.chars().all(|c| c == '0' || c == '.');
    if value > 0.0 && !is_zero { format!("+{text}") } else { text }
}

/// A tolerance in at most three digits.
fn shortest(value: f64) -> String {
    let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
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

const PREFACE: &str = "\
Reference numbers stand beside the number that this workspace finds by the simulation or identification a user would run. \
Three parts keep apart where a reference number comes from. *Difference* is ours less the reference; *tolerance* is what the \
difference may be, and each section says where its tolerances come from. A reference number has the digits it was given \
with, ours has one more. Tests assert every line, and that this file is what the program writes.";

/// A part of VALIDATION.md: heading, what its reference numbers are, and whether a source is of it.
type Part = (&'static str, &'static str, fn(&str) -> bool);

/// The parts, of which every number belongs to one.
const PARTS: [Part; 3] = [
    ("Published by others", "Numbers that stand in print.", |source| source != INDEPENDENT && !is_theory(source)),
    ("By theory", "Numbers that follow from a closed form, a bound or a definition.", is_theory),
    (
        "Computed independently",
        "Numbers of a Python program (numpy, scipy) made for the project's technical reference, which shares no code with \
         this workspace. They are not published.",
        |source| source == INDEPENDENT,
    ),
];

fn is_theory(source: &str) -> bool {
    [BOUND, DEFINITION].contains(&source) || source.starts_with("re-derived")
}

/// VALIDATION.md.
pub fn markdown(sections: &[Section]) -> String {
    let all = || sections.iter().flat_map(|section| &section.checks);
    let agreeing = all().filter(|check| check.holds()).count();
    let made = "Made by `cargo run -p kempf-tests --bin validation > VALIDATION.md`.";
    let mut lines =
        vec![format!("# Validation\n\n{PREFACE}\n\n{made}\n{agreeing} of {} numbers agree.", all().count())];
    let mut described = BTreeSet::new();
    for (heading, what, is_of) in PARTS {
        let count = all().filter(|check| is_of(check.source)).count();
        lines.push(format!("\n## {heading}: {count} numbers\n\n{what}"));
        for section in sections {
            let rows: Vec<String> = section.checks.iter().filter(|check| is_of(check.source)).map(Check::row).collect();
            if rows.is_empty() {
                continue;
            }
            let method = if described.insert(section.title) { section.method } else { "Made as described above." };
            lines.push(format!("\n### {}\n\n{method}\n", section.title));
            lines.push("| what | source | reference | ours | difference | tolerance | verdict |".to_owned());
            lines.push("|---|---|---:|---:|---:|---:|---|".to_owned());
            lines.extend(rows);
        }
    }
    lines.join("\n") + "\n"
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
    }

    #[test]
    fn a_row_shows_what_a_reader_needs() {
        assert!(check(10.0, 10.0004, Tolerance::Relative(0.005)).row().contains("| 0.000 |"));
        let row = check(10.0, 9.9996, Tolerance::Relative(0.005)).row();
        assert_eq!(row, "| what | independent computation | 10.00 s | 10.000 s | 0.000 | 0.5 % | agrees |");
        assert!(check(10.0, 12.0, Tolerance::Absolute(0.025)).row().ends_with("| +2.000 | 0.025 s | **differs** |"));
    }
}
