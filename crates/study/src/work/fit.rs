//! An identification: every method on the records together, its answer held against other records, and what is known of
//! the ship.

use identify::replay::replay;
use identify::{Estimate, Identifier, IdentifierSettings, registry};
use indicatif::ParallelProgressIterator;
use rayon::prelude::*;
use scenario::failure::Failure;
use ship::Particulars;
use ship::angle::to_deg;
use trial::{Trial, ZigZag, ZigZagError};

use super::alone::{self, Amplitudes};
use super::every_scale;
use crate::documents::fit::{FitDocument, TrialEntry, trial_entry};
use crate::outside::{self, Named, NamedCommand};
use crate::records::{file_of, warn_of_no_track};
use crate::scales::{self, Together};
use crate::{interrupt, progress};
use campaign::answer::{MethodEntry, Validation, entry};
use campaign::known::{self, RecordFacts};

/// What came out.
pub struct Fit {
    /// The records, brought to one scale.
    pub together: Together,
    /// Length and speed at which numbers with a dimension are told.
    pub ship: Option<Particulars>,
    /// Zig-zags of the records as they were read; times and limits of a record are those of its own scale.
    pub zigzags: Vec<Result<ZigZag, ZigZagError>>,
    /// The answers of the methods.
    pub answers: Vec<(MethodEntry, Option<Estimate>)>,
    /// Every zig-zag alone, where there are several.
    pub amplitudes: Option<Amplitudes>,
    /// What other programs read.
    pub file: FitDocument,
}

/// Identifies the records together by every method and replays the answers on `others`.
///
/// Fails when the records cannot be brought to one scale, and when no method can identify them: that is wrong input,
/// not a result.
pub fn fit(
    records: &[Trial],
    others: &[Trial],
    methods: &[Named],
    quiet: bool,
    warnings: &mut Vec<String>,
) -> Result<Fit, Failure> {
    let together = scales::together(records, others)?;
    let (trials, others) = (&together.trials[..], &together.others[..]);
    let ship = scales::particulars(trials);
    let answers: Vec<(MethodEntry, Option<Estimate>)> = methods
        .par_iter()
        .progress_with(progress::of("methods", methods.len() as u64, quiet))
        .map(|(label, method)| {
            let (mut entry, estimate) = entry(label, method.identify(trials), trials);
            entry.id = (method.id() != label).then(|| method.id().to_owned());
            entry.prime = entry.parameters.zip(ship).map(|(own, ship)| own.prime(ship));
            entry.validation = others.iter().map(|other| validate(other, estimate.as_ref())).collect();
            (entry, estimate)
        })
        .collect();
    let entries: Vec<MethodEntry> = answers.iter().map(|(entry, _)| entry.clone()).collect();
    if entries.iter().all(|entry| entry.parameters.is_none()) {
        return Err(unusable(&records[0], &entries, warnings));
    }
    let zigzags: Vec<Result<ZigZag, ZigZagError>> = records.iter().map(ZigZag::of).collect();
    let entries_of_trials: Vec<TrialEntry> =
        records.iter().zip(&zigzags).map(|(trial, zigzag)| trial_entry(trial, zigzag.as_ref().ok())).collect();
    let shown = RecordFacts::of(trials).with_motion();
    warn_of_no_track(&shown, warnings);
    let file = FitDocument {
        schema: "fit/1".into(),
        zigzag: entries_of_trials[0].zigzag.clone(),
        trials: entries_of_trials,
        ships: answers
            .iter()
            .filter_map(|(entry, estimate)| {
                Some((entry.method.clone(), known::of_estimate(estimate.as_ref()?, &shown)?))
            })
            .collect(),
        scales: every_scale::compared(methods, &answers, &together),
        methods: entries,
    };
    let amplitudes = alone::of_records(trials, &speakers(methods, &file.methods));
    Ok(Fit { ship, zigzags, answers, amplitudes, file, together })
}

/// The named methods of the project with their default settings, all for no name, and outside estimators behind them;
/// those that draw at random with this seed.
///
/// Fails for a name that no method has, and for a command that cannot be one.
pub fn methods(names: &[String], external: &[NamedCommand], seed: Option<u64>) -> Result<Vec<Named>, Failure> {
    let all: Vec<Box<dyn Identifier>> = registry::defaults()
        .iter()
        .map(IdentifierSettings::build)
        .collect::<Result<_, _>>()
        .map_err(|error| Failure::work(format!("default settings: {error}")))?;
    let known: Vec<&str> = all.iter().map(|method| method.id()).collect();
    if let Some(unknown) = names.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(Failure::input(format!("--method {unknown}: no such method; use one of {}", known.join(", "))));
    }
    let outside = outside::methods(external, &known)?;
    if !outside.is_empty() {
        interrupt::install();
    }
    Ok(all
        .into_iter()
        .filter(|method| names.is_empty() || names.iter().any(|name| name == method.id()))
        .map(|method| seed.and_then(|seed| method.with_seed(seed)).unwrap_or(method))
        .map(|method| (method.id().to_owned(), method))
        .chain(outside)
        .collect())
}

/// The methods that were used and gave an answer with an interval, those first whose intervals hold most.
fn speakers<'a>(methods: &'a [Named], entries: &[MethodEntry]) -> Vec<&'a dyn Identifier> {
    let has_interval = |entry: &&MethodEntry| entry.parameters.is_some_and(|own| own.k_per_s.ci95.is_some());
    let answered: Vec<&str> = entries.iter().filter(has_interval).map(|entry| entry.method.as_str()).collect();
    let answered = methods.iter().filter(|(label, _)| answered.contains(&label.as_str()));
    let mut found: Vec<&dyn Identifier> = answered.map(|(_, method)| method.as_ref()).collect();
    let rank = |id: &str| every_scale::SPEAKERS.iter().position(|speaker| *speaker == id);
    found.sort_by_key(|method| rank(method.id()).unwrap_or(every_scale::SPEAKERS.len()));
    found.truncate(every_scale::SPEAKERS.len());
    found
}

/// The message when no method gives an answer: every reason once.
fn unusable(record: &Trial, entries: &[MethodEntry], warnings: &[String]) -> Failure {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for entry in entries {
        let reason = entry.reason.as_deref().unwrap_or("no answer");
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, methods)) => methods.push(&entry.method),
            None => reasons.push((reason, vec![&entry.method])),
        }
    }
    let file = file_of(record).0;
    let mut message = match (entries, reasons.as_slice()) {
        ([only], _) => {
            let reason = only.reason.as_deref().unwrap_or("no answer");
            format!("{file}: {} cannot identify this record: {reason}", only.method)
        }
        (_, [(reason, _)]) => format!("{file}: no method can identify this record: {reason}"),
        _ => {
            let lines: Vec<String> =
                reasons.iter().map(|(reason, methods)| format!("\n  {}: {reason}", methods.join(", "))).collect();
            format!("{file}: no method can identify this record{}", lines.concat())
        }
    };
    for warning in warnings {
        message += &format!("\nnote: {warning}");
    }
    if entries.iter().any(|entry| entry.failure.as_deref() != Some("not-excited")) {
        message += "\nhelp: give a zig-zag, or a record in which the rudder is put to both sides for as long as the ship needs to answer";
    }
    Failure::input(message)
}

fn validate(other: &Trial, estimate: Option<&Estimate>) -> Validation {
    Validation {
        file: file_of(other).0.to_owned(),
        heading_rmse_deg: estimate
            .and_then(|estimate| replay(other, &estimate.response))
            .map(|replay| to_deg(replay.rms())),
    }
}
