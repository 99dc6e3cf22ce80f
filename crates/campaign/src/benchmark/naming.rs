//! How often methods name the effect that a ship lacks.

use serde::{Deserialize, Serialize};

use crate::benchmark::board::WilsonShare;
use crate::benchmark::cases::{BenchCase, BenchTask, Naming};
use crate::statistics::grouped;

/// What a method said of the ships of one set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NamingLine {
    /// Label of the method.
    pub method: String,
    /// Name of the set.
    pub set: String,
    /// The effect that its ships lack; none where they lack nothing.
    pub missing: Option<String>,
    /// How often each was said, in the order of [`Naming::ALL`].
    pub counts: [usize; Naming::ALL.len()],
    /// Trials without an answer.
    pub failed: usize,
    /// WilsonShare of trials in which the answer is right or holds what is missing among aliases, and nothing else.
    pub named: WilsonShare,
}

/// The lines of all methods, set by set.
pub fn lines(cases: &[BenchCase], methods: &[String]) -> Vec<NamingLine> {
    let own = cases.iter().filter(|case| case.task == BenchTask::Name);
    let sets = grouped(own, |case| case.set.as_str());
    methods.iter().flat_map(|method| sets.iter().filter_map(|(set, cases)| line(method, set, cases))).collect()
}

fn line(method: &str, set: &str, cases: &[&BenchCase]) -> Option<NamingLine> {
    let answers = || cases.iter().flat_map(|case| &case.answers).filter(|answer| answer.method == method);
    let counts = Naming::ALL.map(|one| answers().filter(|answer| answer.naming == Some(one)).count());
    Some(NamingLine {
        method: method.to_owned(),
        set: set.to_owned(),
        missing: cases.first()?.missing.clone(),
        failed: answers().filter(|answer| answer.naming.is_none()).count(),
        named: WilsonShare::new(counts[0] + counts[1], answers().count())?,
        counts,
    })
}

/// All ships of a method that lack an effect, or all that lack nothing, together.
pub fn total(lines: &[NamingLine], method: &str, is_missing: bool) -> Option<NamingLine> {
    let own = lines.iter().filter(|line| line.method == method && line.missing.is_some() == is_missing);
    let joined = own.cloned().reduce(|one, other| NamingLine {
        counts: std::array::from_fn(|place| one.counts[place] + other.counts[place]),
        failed: one.failed + other.failed,
        ..one
    })?;
    let of = joined.counts.iter().sum::<usize>() + joined.failed;
    Some(NamingLine { named: WilsonShare::new(joined.counts[0] + joined.counts[1], of)?, ..joined })
}
