//! A trace: the analysis of the crate [`trace`](mod@::trace), the particulars of the ship, and the files from which all
//! output is made.

use ::trace::{Analysis, FoldObserver, Innovations, Settings, TraceError};
use campaign::Observer;
use campaign::failure::Failure;
use campaign::folder::ResultFolder;
use campaign::identified_ship::{self, RecordFacts};
use document::trace::{MissingMomentEntry, RecordEntry, TraceDocument};
use document::{WarningCode, Warnings, names};
use identify::output_error;
use identify::plausibility::unusual_ship;
use indicatif::ProgressBar;
use predict::prediction::RANGE_FACTOR;
use report::number::fixed;
use ship::angle::to_deg;
use trial::{Channel, Trial};

use super::earlier_trials::{self, EarlierModel};
use super::planned;
use super::single_records::RecordedZigZags;
use crate::documents::curves::{self, TraceCurves, file_name_suffix, record_slugs};
use crate::documents::{self, TRACE_FILE, missing_moment, prior};
use crate::options::{TraceRequest, WithheldChannel};
use crate::progress;
use crate::records::{
    file_and_hash, late_rudder_message, missing_track_warning, trial_particulars_entry, unique_names,
};
use crate::scales::{self, RescaledRecords};
use crate::terminal::Terminal;

/// Trace before it is written: its document, and the tables of its curves by file name.
pub struct TraceResult {
    /// Document of `trace.json`.
    pub document: TraceDocument,
    tables: Vec<(String, String)>,
}

impl TraceResult {
    /// Curves, as they are read back from the files.
    pub fn curves(&self) -> Result<TraceCurves, Failure> {
        TraceCurves::from_tables(&self.document, |name| {
            let table = self.tables.iter().find(|(file, _)| file == name).map(|(_, text)| text.clone());
            Ok((table.unwrap_or_default(), name.to_owned()))
        })
    }

    /// Writes document and tables; returns the text of the document. Fails if a file cannot be written.
    pub fn write(&self, folder: &ResultFolder) -> Result<String, Failure> {
        let text = documents::write_document(folder, TRACE_FILE, &self.document)?;
        self.tables.iter().try_for_each(|(name, table)| folder.write(name, table)).map(|()| text)
    }
}

/// Progress and interruption of a trace. The search has no known length; the later checks have, and can be skipped.
struct TraceWatch {
    busy: ProgressBar,
    terminal: Terminal,
}

impl TraceWatch {
    fn end(&self) {
        self.busy.finish_and_clear();
        self.terminal.end();
    }
}

impl FoldObserver for TraceWatch {
    fn begin_folds(&self, count: usize) {
        self.busy.finish_and_clear();
        self.terminal.begin(count as u64, 0);
    }

    fn end_fold(&self) {
        self.terminal.advance();
    }

    fn should_stop(&self) -> bool {
        self.terminal.should_stop()
    }
}

/// Message for a trace interrupted during its checks.
pub const STOPPED_MESSAGE: &str = "stopped before every record had been left out in turn; all other results are there";

/// Analysis of the records together; those of `validation` are held out. `priors` are the prior of the hull.
///
/// Fails if the records cannot be brought to one scale, if the base cannot be fitted, if a requested effect cannot be
/// in the model, or if there are priors and no hull can be fitted.
pub fn trace(
    [records, validation]: [&[Trial]; 2],
    settings: &Settings,
    priors: &[EarlierModel],
    quiet: bool,
    warnings: &mut Warnings,
) -> Result<TraceResult, Failure> {
    let together = scales::to_common_scale(records, validation)?;
    warnings.extend(earlier_trials::check_usable_as_priors(priors, &together.trials)?);
    let settings = &Settings { earlier_hulls: earlier_trials::hulls_of_models(priors), ..settings.clone() };
    let watch = TraceWatch {
        busy: progress::spinner("searching for what the model lacks", quiet),
        terminal: Terminal::new("records left out in turn", quiet),
    };
    let analysis = ::trace::trace_with_observer(&together.trials, &together.held_out, settings, &watch);
    watch.end();
    let analysis = analysis.map_err(|error| refused(&records[0], &error))?;
    let (scales, RescaledRecords { trials, held_out, .. }) = (together.scaling_sentence(), together);
    let shown = RecordFacts::from_trials(&trials).with_motion(Some(&analysis), &settings.earlier_hulls);
    warnings.extend(missing_track_warning(&shown));
    warnings.extend(unusual_ship(&analysis.base, scales::declared_particulars(&trials), records));
    let names = unique_names(trials.iter().chain(&held_out).map(Trial::name));
    let innovations = analysis.innovations();
    let entry = |((number, trial), name): ((usize, &Trial), &String)| RecordEntry {
        name: name.clone(),
        file: file_and_hash(trial).0.to_owned(),
        sha256: file_and_hash(trial).1.to_owned(),
        held_out: number >= trials.len(),
        curves: format!("replay{}.csv", file_name_suffix(&names, number)),
        innovations: innovations.get(number).map(|_| format!("innovations{}.csv", file_name_suffix(&names, number))),
        length_m: trial.particulars().map(|ship| ship.length),
        speed_m_s: trial.particulars().map(|ship| ship.speed),
        trial_particulars: trial_particulars_entry(trial),
    };
    let entries: Vec<RecordEntry> = records.iter().chain(validation).enumerate().zip(&names).map(entry).collect();
    let mut tables = tables(&analysis, [&trials, &held_out], &entries, &innovations);
    let (staircase, table) = curves::staircase_entries_and_csv(analysis.inclusion_path());
    let (moments, curves_of_moments) = missing_moments(&analysis, &entries, &record_slugs(&names));
    tables.extend(curves_of_moments.into_iter().chain(table));
    let ship = identified_ship::from_analysis(&analysis, &shown);
    warnings.extend(ship.logged_rudder_delay().map(|late| WarningCode::LateRudder.warning(late_rudder_message(late))));
    let earlier_trials = earlier_trials::earlier_trials_entry(priors, &trials, &shown);
    warnings.extend(earlier_trials.as_ref().and_then(prior::contradiction_warning));
    let output_error = output_error::Settings::default().build().map_err(Failure::input)?;
    let zigzags = RecordedZigZags::from_trials(&trials);
    let document = TraceDocument {
        earlier_trials,
        ship,
        records: entries,
        missing_moment: moments,
        staircase,
        amplitude: zigzags.mean_amplitude(),
        single_records: zigzags.single_records(&[&output_error]),
        scales,
        next_trial: next_trial(&analysis, &trials, &held_out),
        trace: analysis.document,
        warnings: warnings.ranked(),
    };
    Ok(TraceResult { document, tables })
}

/// Tables of the records and of their innovations, by file name.
fn tables(
    analysis: &Analysis,
    [fitted, held_out]: [&[Trial]; 2],
    entries: &[RecordEntry],
    innovations: &[Innovations],
) -> Vec<(String, String)> {
    let compared = fitted.iter().chain(held_out).zip(analysis.identification.iter().chain(&analysis.validation));
    let tables = compared.map(|(trial, comparison)| curves::record_csv(trial, comparison));
    let tables = entries.iter().map(|entry| entry.curves.clone()).zip(tables);
    let innovations = entries.iter().zip(innovations);
    let innovations =
        innovations.filter_map(|(entry, series)| Some((entry.innovations.clone()?, curves::innovations_csv(series))));
    tables.chain(innovations).collect()
}

/// Moments that the base lacks on the fitted records, and their tables by file name.
fn missing_moments(
    analysis: &Analysis,
    entries: &[RecordEntry],
    slugs: &[String],
) -> (Vec<MissingMomentEntry>, Vec<(String, String)>) {
    let explains =
        analysis.structures.weighted_members().first().is_some_and(|(_, fit)| !fit.structure.terms.is_empty());
    let (mut moments, mut tables) = (Vec::new(), Vec::new());
    for ((record, slug), missing) in entries.iter().zip(slugs).zip(analysis.missing_moments()) {
        let Some(missing) = missing else { continue };
        let stem = format!("missing-moment-{slug}");
        let labels = [record.file.as_str(), &record.name, &stem];
        let entry = missing_moment::missing_moment_entry(&missing, labels, analysis.document.verdict, explains);
        tables.push((entry.moment.clone(), missing_moment::csv_over_time(&missing)));
        tables.push((entry.curves.clone(), missing_moment::csv_over_channels(&missing)));
        moments.push(entry);
    }
    (moments, tables)
}

/// Failure for records that cannot be traced.
fn refused(first: &Trial, error: &TraceError) -> Failure {
    let why = match error {
        TraceError::Base(_) | TraceError::Replay { .. } => {
            "; the record cannot be traced because no base model fits it"
        }
        TraceError::NoCandidate { .. } => "; leave it out of --with and --only",
        TraceError::Settings(error) => return Failure::input(error),
    };
    Failure::in_file(file_and_hash(first).0, format!("{error}{why}"))
}

/// Sentence on a trial with more rudder, if the band of the model fails on a held-out record beyond the fitted rudder.
fn larger_rudder(analysis: &Analysis, fitted: &[Trial], held_out: &[Trial]) -> Option<String> {
    let seen = fitted.iter().map(Trial::largest_rudder).fold(0.0, f64::max);
    let failed = held_out.iter().zip(&analysis.validation).filter_map(|(trial, comparison)| {
        let coverage = comparison.average_replay.band_coverage().filter(|coverage| !coverage.is_nominal())?;
        (trial.largest_rudder() > RANGE_FACTOR * seen).then_some((trial, coverage))
    });
    let (trial, coverage) = failed.max_by(|(a, _), (b, _)| a.largest_rudder().total_cmp(&b.largest_rudder()))?;
    let [rudder, seen] = [trial.largest_rudder(), seen].map(|angle| fixed(to_deg(angle), 0));
    Some(format!(
        "First a trial with {rudder}° of rudder: beyond the fitted {seen}° the model fails, and its 95 % band holds {} % \
         of the headings of {}. ",
        fixed(100.0 * coverage.share(), 0),
        names::record_name(trial.name())
    ))
}

/// Sentence on the most informative next trial.
fn next_trial(analysis: &Analysis, trials: &[Trial], held_out: &[Trial]) -> String {
    let first = larger_rudder(analysis, trials, held_out).unwrap_or_default();
    let values = analysis.planned_trial_values(&planned::planned_trials(analysis, trials));
    let Some(best) = values.first() else {
        return first + "The fitted model cannot be steered through any standard manoeuvre.";
    };
    let pairs = |pairs: &[[String; 2]]| -> String {
        pairs.iter().map(|[a, b]| format!("{a} from {b}")).collect::<Vec<_>>().join(", ")
    };
    let gains = [(pairs(&best.separated_pairs), "separate"), (best.revealed_effects.join(", "), "show")];
    let gains: Vec<String> =
        gains.iter().filter(|(pairs, _)| !pairs.is_empty()).map(|(pairs, verb)| format!("{verb} {pairs}")).collect();
    let gains = match gains.as_slice() {
        [] => String::from("is the most informative of the standard manoeuvres"),
        gains => format!("would {}", gains.join(" and ")),
    };
    let limits = match best.inseparable_pairs.as_slice() {
        [] => String::new(),
        alike => format!("; it would not separate {}", pairs(alike)),
    };
    format!("{first}A {} {gains}{limits}.", best.name)
}

/// Settings of the analysis of a request.
///
/// Fails with the name of an unknown effect.
pub fn settings(request: &TraceRequest) -> Result<Settings, Failure> {
    let fits_hulls = !request.without_hull;
    Ok(Settings { rule: request.rule, selection: request.selection()?, fits_hulls, ..Settings::default() })
}

/// Records of a request without the withheld channels.
pub fn withhold_channels(request: &TraceRequest, trials: Vec<Trial>) -> Vec<Trial> {
    let withheld: Vec<Channel> = request.without.iter().flat_map(|channel| channels(*channel)).copied().collect();
    trials.into_iter().map(|trial| trial.without_channels(&withheld)).collect()
}

fn channels(channel: WithheldChannel) -> &'static [Channel] {
    match channel {
        WithheldChannel::Wind => {
            &[Channel::WindRelativeSpeed, Channel::WindRelativeFrom, Channel::WindTrueSpeed, Channel::WindTrueFrom]
        }
        WithheldChannel::Speed => &[Channel::Speed, Channel::Surge],
        WithheldChannel::Propeller => &[Channel::PropellerRate],
        WithheldChannel::Sway => &[Channel::Sway],
    }
}
