//! All benchmarks, in groups: the measured work, its reference and its limit.

mod effects;
mod identification;
mod prediction;
mod simulation;
mod studies;
mod tracing;

pub use effects::effects;
pub use identification::identification;
pub use prediction::prediction;
pub use simulation::simulation;
pub use studies::studies;
pub use tracing::tracing;

use crate::work::WorkGroup;

/// All groups, in the order of the report.
pub fn all() -> Vec<WorkGroup> {
    vec![simulation(), effects(), identification(), tracing(), prediction(), studies()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::records::{K, T};

    #[test]
    fn names_can_be_told_apart_and_be_part_of_a_path() {
        for group in all() {
            let mut names: Vec<&str> = group.rows.iter().map(|row| row.work.name.as_str()).collect();
            assert!(names.iter().all(|name| name.len() < 60 && !name.contains(['/', '"', ':', '?', '*', '|', '^'])));
            let count = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), count, "{}", group.name);
        }
    }

    /// Estimates of every benchmark against the ship, within their tolerance.
    #[test]
    fn answers_are_those_of_the_ship() {
        for group in all() {
            for work in group.rows.into_iter().map(|row| row.work) {
                let Some(tolerance) = work.tolerance else { continue };
                let [k, t] = work.answer().unwrap_or_else(|| panic!("{} has no answer", work.name));
                let worst = (k / K - 1.0).abs().max((t / T - 1.0).abs());
                assert!(worst < tolerance, "{}: K {k} 1/s, T {t} s", work.name);
            }
        }
    }
}
