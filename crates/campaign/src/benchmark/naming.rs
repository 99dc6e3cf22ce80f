//! Counts of correct and wrong effect names, by method and set.

use serde::{Deserialize, Serialize};

use crate::benchmark::board::WilsonShare;
use crate::benchmark::cases::{BenchCase, BenchTask, Naming};
use crate::statistics::grouped;

/// Counts of the effects that a method named in one set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NamingLine {
    /// Label of the method.
    pub method: String,
    /// Name of the set.
    pub set: String,
    /// Missing effect; `null` if no effect is missing.
    pub missing: Option<String>,
    /// Number of results by correctness, in the order of [`Naming::ALL`].
    pub counts: [usize; Naming::ALL.len()],
    /// Number of failed trials.
    pub failed: usize,
    /// Share of trials whose one named group contains the missing effect, or in which correctly no effect is named.
    pub named: WilsonShare,
}

/// Counts of effect names for every method and, within it, every set.
pub fn naming_lines(cases: &[BenchCase], methods: &[String]) -> Vec<NamingLine> {
    let naming_cases = cases.iter().filter(|case| case.task == BenchTask::Name);
    let sets = grouped(naming_cases, |case| case.set.as_str());
    methods.iter().flat_map(|method| sets.iter().filter_map(|(set, cases)| line(method, set, cases))).collect()
}

fn line(method: &str, set: &str, cases: &[&BenchCase]) -> Option<NamingLine> {
    let answers = || cases.iter().flat_map(|case| &case.answers).filter(|answer| answer.method == method);
    let counts = Naming::ALL.map(|naming| answers().filter(|answer| answer.naming == Some(naming)).count());
    Some(NamingLine {
        method: method.to_owned(),
        set: set.to_owned(),
        missing: cases.first()?.missing.clone(),
        failed: answers().filter(|answer| answer.naming.is_none()).count(),
        named: WilsonShare::new(counts[0] + counts[1], answers().count())?,
        counts,
    })
}

/// Sum of the lines of a method over all sets with a missing effect, or over all without; `None` if there is no such
/// line. Set and effect of the sum are those of its first line.
pub fn naming_total(lines: &[NamingLine], method: &str, is_missing: bool) -> Option<NamingLine> {
    let selected = lines.iter().filter(|line| line.method == method && line.missing.is_some() == is_missing);
    let joined = selected.cloned().reduce(|sum, line| NamingLine {
        counts: std::array::from_fn(|place| sum.counts[place] + line.counts[place]),
        failed: sum.failed + line.failed,
        ..sum
    })?;
    let trials = joined.counts.iter().sum::<usize>() + joined.failed;
    Some(NamingLine { named: WilsonShare::new(joined.counts[0] + joined.counts[1], trials)?, ..joined })
}
