//! Identification: all requested methods on the records together, validation on other records, and the identified ship.

use campaign::failure::Failure;
use campaign::stored_figures::Replays;
use document::fit::{CircleEntry, CriterionEntry, FitDocument, SCHEMA, TrialEntry, VerdictEntry, ZigZagEntry};
use document::method::{MethodEntry, ValidationEntry};
use document::trace::PrimeIndices;
use document::{ErrorCode, ImoFormEntry, Warning, WarningCode, WarningSource, Warnings};
use identify::estimate::Uncertainty;
use identify::method_entry::method_entry;
use identify::plausibility::unusual_ship;
use identify::replay::replay;
use identify::{Estimate, Identifier, IdentifierSettings, registry, verdict};
use indicatif::ParallelProgressIterator;
use predict::form::{self, FormRecord, ImoForm};
use predict::turn::{self, Current, MeasuredCircle};
use rayon::prelude::*;
use report::{CurveOrigin, PlotCurve};
use ship::Particulars;
use ship::angle::to_deg;
use trial::{Channel, Side, Trial, ZigZag, imo};

use super::earlier_trials::{self, EarlierModel};
use super::loading::{FORM_RULED_OUT, is_form_ruled_out};
use super::predicted_circle::PredictedCircle;
use super::scale_comparison::{self, LabelledMethod, PREFERRED_METHODS};
use super::single_records::RecordedZigZags;
use crate::completed::ALL_METHODS;
use crate::documents::fit_curves::{FitCurves, FitRecord};
use crate::documents::prior;
use crate::progress;
use crate::records::{self, file_and_hash, missing_track_warning, warning_source_of};
use crate::scales::{self, RescaledRecords};
use campaign::curves::{angle_curve_deg, replay_curves, zigzag_plot_data};
use campaign::identified_ship::{self, RecordFacts};
use campaign::statistics::grouped;

/// Result of an identification.
pub struct FitResult {
    /// Records, brought to one scale.
    pub records: RescaledRecords,
    /// Entries of the methods, with their estimates if they gave one.
    pub answers: Vec<(MethodEntry, Option<Estimate>)>,
    /// Document of `fit.json`.
    pub document: FitDocument,
    /// Median track of the turning circle predicted from the recommended estimate, north and east in ship lengths;
    /// `None` if the circle was not predicted.
    circle_track: Option<Vec<[f64; 2]>>,
}

/// Track as a curve: east as abscissa, north as ordinate.
fn from_above(track: Vec<[f64; 2]>) -> PlotCurve {
    let (x, y): (Vec<f64>, Vec<f64>) = track.into_iter().map(|[north, east]| (east, north)).unzip();
    PlotCurve { x, y }
}

impl FitResult {
    /// The same fit with the turning circle predicted from the recommended estimate.
    #[must_use]
    pub fn with_predicted_circle(mut self) -> Self {
        let circle = PredictedCircle::from_document(&self.document);
        (self.document.predicted_circle, self.circle_track) = circle.map(|circle| (circle.entry, circle.track)).unzip();
        self
    }

    /// Curves of the figures: records, replays, and 95 % regions of K and T.
    pub fn curves(&self) -> FitCurves {
        let RescaledRecords { trials, held_out, .. } = &self.records;
        let stems = records::unique_names(trials.iter().chain(held_out).map(Trial::name));
        let records = trials.iter().chain(held_out).zip(stems).enumerate();
        let record = |(number, (trial, name))| self.record(trial, name, number >= trials.len());
        let regions = self.answers.iter().filter_map(|(entry, estimate)| {
            let estimate = estimate.as_ref()?;
            let Uncertainty::Covariance(covariance) = &estimate.uncertainty else { return None };
            let outline = covariance.joint_region_outline(&estimate.response)?;
            let (x, y): (Vec<f64>, Vec<f64>) = outline.into_iter().map(|[k, t]| (k, t)).unzip();
            Some((entry.method.clone(), PlotCurve { x, y }))
        });
        let predicted_circle = self.circle_track.clone().map(from_above);
        FitCurves { records: records.map(record).collect(), regions: regions.collect(), predicted_circle }
    }

    fn record(&self, trial: &Trial, name: String, validation: bool) -> FitRecord {
        let zigzag = ZigZag::from_trial(trial).ok().filter(|_| !validation);
        let rejected = |channel: Channel| {
            let marks = trial.rejected().iter().filter(|mark| mark.channel == channel);
            let (time, values): (Vec<f64>, Vec<f64>) = marks.map(|mark| (mark.time, mark.value)).unzip();
            angle_curve_deg(&time, &values)
        };
        FitRecord {
            file: file_and_hash(trial).0.to_owned(),
            is_renamed: name != trial.name(),
            validation,
            zigzag: zigzag.map(|zigzag| zigzag_plot_data(trial, &zigzag)),
            replays: Replays {
                record: angle_curve_deg(trial.time(), trial.heading()),
                truth: None,
                replays: replay_curves(trial, &self.answers, |method| CurveOrigin::Method(method.to_owned())),
            },
            rudder: angle_curve_deg(trial.time(), trial.rudder()),
            circle_track: (!validation).then(|| MeasuredCircle::from_trial(trial)?.track).flatten().map(from_above),
            rejected: (!trial.rejected().is_empty()).then(|| [Channel::Heading, Channel::Rudder].map(rejected)),
            name,
        }
    }
}

/// Identification of the records together by every method, with replays on `validation`; `priors` apply to the hull.
/// The document has the `warnings` of the records and those of the fit.
///
/// Fails, as for wrong input, if the records cannot be brought to one scale, if no method identifies them, or if there
/// are priors and no hull can be fitted.
pub fn fit(
    [records, validation]: [&[Trial]; 2],
    methods: &[LabelledMethod],
    priors: &[EarlierModel],
    quiet: bool,
    mut warnings: Warnings,
) -> Result<FitResult, Failure> {
    let together = scales::to_common_scale(records, validation)?;
    let (trials, held_out) = (&together.trials[..], &together.held_out[..]);
    warnings.extend(earlier_trials::check_usable_as_priors(priors, trials)?);
    let ship = scales::declared_particulars(trials);
    let answers: Vec<(MethodEntry, Option<Estimate>)> = methods
        .par_iter()
        .progress_with(progress::bar("methods", methods.len() as u64, quiet))
        .map(|(label, method)| {
            let (mut entry, estimate) = method_entry(label, method.identify(trials), trials);
            entry.id = (method.id() != label).then(|| method.id().to_owned());
            entry.prime = entry.parameters.zip(ship).map(|(fit, ship)| PrimeIndices::new([fit.k_per_s, fit.t_s], ship));
            entry.validation = held_out.iter().map(|other| validate(other, estimate.as_ref())).collect();
            (entry, estimate)
        })
        .collect();
    let entries: Vec<MethodEntry> = answers.iter().map(|(entry, _)| entry.clone()).collect();
    if entries.iter().all(|entry| entry.parameters.is_none()) {
        return Err(unusable(&records[0], &entries, &warnings.ranked()));
    }
    let surest = answers.iter().filter_map(|(_, estimate)| estimate.as_ref()).find(|fit| fit.K().sd.is_some());
    warnings.extend(surest.and_then(|estimate| unusual_ship(estimate, ship, records)));
    let records: Vec<TrialEntry> = records.iter().map(|trial| trial_entry(trial, &mut warnings)).collect();
    let shown = RecordFacts::from_trials(trials).with_motion(None, &earlier_trials::hulls_of_models(priors));
    warnings.extend(missing_track_warning(&shown).into_iter().chain(no_loading(trials, &shown)));
    let earlier_trials = earlier_trials::earlier_trials_entry(priors, trials, &shown);
    warnings.extend(earlier_trials.as_ref().and_then(prior::contradiction_warning));
    warnings.extend(answers.iter().flat_map(method_warnings));
    let ship_of = |(entry, estimate): &(MethodEntry, Option<Estimate>)| {
        Some((entry.method.clone(), identified_ship::from_estimate(estimate.as_ref()?, &shown)?))
    };
    let (verdict, zigzags) = (verdict::from_estimates(trials, &answers), RecordedZigZags::from_trials(trials));
    let (form, form_remarks) = form_of(trials, ship).map(|form| (form.entries, form.remarks)).unwrap_or_default();
    let document = FitDocument {
        schema: SCHEMA.into(),
        zigzag: records[0].zigzag.clone(),
        trials: records,
        ships: answers.iter().filter_map(ship_of).collect(),
        earlier_trials,
        scales: scale_comparison::scales_entry(methods, &answers, &together),
        scaling: together.scaling_sentence(),
        length_m: ship.map(|ship| ship.length),
        speed_m_s: ship.map(|ship| ship.speed),
        amplitude: zigzags.mean_amplitude(),
        form,
        form_remarks,
        predicted_circle: None,
        single_records: zigzags.single_records(&preferred(methods, &entries, verdict.as_ref())),
        verdict,
        warnings: warnings.ranked(),
        methods: entries,
    };
    Ok(FitResult { records: together, answers, document, circle_track: None })
}

/// Document entry of a record; adds a warning if its first overshoot cannot be read.
fn trial_entry(trial: &Trial, warnings: &mut Warnings) -> TrialEntry {
    let ((file, sha256), zigzag) = (file_and_hash(trial), ZigZag::from_trial(trial));
    warnings.extend(zigzag.as_ref().ok().and_then(|zigzag| late_begin(trial, zigzag)));
    TrialEntry {
        file: file.into(),
        sha256: sha256.into(),
        samples: trial.len(),
        duration_s: trial.duration(),
        trial_particulars: records::trial_particulars_entry(trial),
        zigzag: zigzag.as_ref().ok().map(|zigzag| zigzag_entry(zigzag, trial)),
        no_zigzag: zigzag.as_ref().err().map(ToString::to_string),
        circle: MeasuredCircle::from_trial(trial).map(|circle| circle_entry(&circle, trial.particulars())),
    }
}

fn circle_entry(circle: &MeasuredCircle, ship: Option<Particulars>) -> CircleEntry {
    let lengths = |name: &str| Some(circle.figures.get(name).copied().flatten()? / ship?.length);
    CircleEntry {
        side: Side::from_angle(circle.turn.side).to_string(),
        rudder_deg: to_deg(circle.turn.max_rudder),
        advance_lengths: lengths("advance_m"),
        transfer_lengths: lengths("transfer_m"),
        tactical_diameter_lengths: lengths("tactical_diameter_m"),
    }
}

/// Form of MSC/Circ.1053 with the quantities that the records measure; `None` if they measure none.
fn form_of(records: &[Trial], ship: Option<Particulars>) -> Option<ImoForm> {
    let records: Vec<(Trial, Option<Current>)> =
        records.iter().map(|trial| turn::without_current(trial.clone(), None)).collect();
    let held = records.iter().map(|(trial, current)| FormRecord { trial, correction: None, current: *current });
    let form = form::fill_form(&[], ship, "", &held.collect::<Vec<_>>(), None);
    let is_measured = |entry: &ImoFormEntry| entry.side.is_some() && entry.value.is_some();
    form.entries.iter().any(is_measured).then_some(form)
}

/// Document entry of a zig-zag; with criteria if length and speed are declared.
fn zigzag_entry(zigzag: &ZigZag, trial: &Trial) -> ZigZagEntry {
    let criteria = trial.particulars().map(|particulars| imo::imo_criteria(zigzag, particulars)).unwrap_or_default();
    let criterion = |criterion: &imo::ImoCriterion| CriterionEntry {
        criterion: criterion.name.into(),
        measured: criterion.measured.map(|measured| measured.value),
        limit: criterion.limit,
        unit: criterion.unit.symbol().into(),
        verdict: criterion.verdict(),
    };
    ZigZagEntry {
        initial_turning_time_s: zigzag.initial_turning_time.map(|time| time.value),
        overshoots_deg: zigzag.overshoots_by_execute().map(|swing| Some(to_deg(swing?.angle.value))).collect(),
        overshoots_sd_deg: zigzag.overshoots_by_execute().map(|swing| swing?.angle.sd.map(to_deg)).collect(),
        period_s: zigzag.period.map(|period| period.value),
        imo: criteria.iter().map(criterion).collect(),
        imo_caution: trial.particulars().and_then(imo::short_ship_caution),
    }
}

/// Warnings of a method.
fn method_warnings((entry, estimate): &(MethodEntry, Option<Estimate>)) -> Vec<Warning> {
    let warnings = estimate.iter().flat_map(|estimate| estimate.warnings.clone());
    WarningSource::Method(entry.method.clone()).attach_to(warnings).collect()
}

/// Warning for a ship of known draught whose model cannot be converted to another loading.
fn no_loading(trials: &[Trial], shown: &RecordFacts) -> Option<Warning> {
    let has_form = trials.iter().filter_map(Trial::hull).any(|ship| ship.draught.is_some());
    let text = format!("{FORM_RULED_OUT}; `study predict --load` cannot take this ship to another loading");
    (has_form && is_form_ruled_out(&shown.hulls)).then(|| WarningCode::NoLoading.warning(text))
}

/// Warning for a record whose first overshoot cannot be read.
fn late_begin(trial: &Trial, zigzag: &ZigZag) -> Option<Warning> {
    let text = "the record begins at a reversal of the rudder, so the first overshoot is not read; begin it earlier if the log allows";
    zigzag.begins_at_reversal.then(|| Warning::new(WarningCode::LateBegin, warning_source_of(trial), text))
}

/// Methods with these ids, or all for `all`, with their default settings and the best first; without names those of
/// [`registry::DEFAULT_METHODS`]. A method that uses random numbers gets the `seed`, if there is one.
///
/// Fails if no method has such a name.
pub fn labelled_methods(names: &[String], seed: Option<u64>) -> Result<Vec<LabelledMethod>, Failure> {
    let all = registry::default_settings().iter().map(IdentifierSettings::build).collect::<Result<Vec<_>, _>>();
    let mut all = all.map_err(|error| Failure::execution(format!("default settings: {error}")))?;
    let place = |id: &str| registry::DEFAULT_METHODS.iter().position(|usual| *usual == id);
    all.sort_by_key(|method| place(method.id()).unwrap_or(usize::MAX));
    let ids: Vec<&str> = all.iter().map(|method| method.id()).collect();
    if let Some(unknown) = names.iter().find(|name| *name != ALL_METHODS && !ids.contains(&name.as_str())) {
        let ids = ids.join(", ");
        return Err(Failure::input(format!("--method {unknown}: no such method; use {ALL_METHODS}, or one of {ids}")));
    }
    let is_named = |id: &str| match names {
        [] => place(id).is_some(),
        names => names.iter().any(|name| name == id || name == ALL_METHODS),
    };
    let chosen = all.into_iter().filter(|method| is_named(method.id())).map(|method| {
        let method = seed.and_then(|seed| method.with_seed(seed)).unwrap_or(method);
        (method.id().to_owned(), method)
    });
    Ok(chosen.collect())
}

/// Methods that can represent all, in order of preference: that of the verdict, then two with an interval, of which
/// [`PREFERRED_METHODS`] come first.
fn preferred<'a>(
    methods: &'a [LabelledMethod],
    entries: &[MethodEntry],
    verdict: Option<&VerdictEntry>,
) -> Vec<&'a dyn Identifier> {
    let has_interval = |label: &str| {
        let parameters = entries.iter().find(|entry| entry.method == label).and_then(|entry| entry.parameters);
        parameters.is_some_and(|parameters| parameters.k_per_s.ci95.is_some())
    };
    let answered = methods.iter().filter(|(label, _)| has_interval(label));
    let mut ranked: Vec<&dyn Identifier> = answered.map(|(_, method)| method.as_ref()).collect();
    ranked.sort_by_key(|method| PREFERRED_METHODS.iter().position(|id| *id == method.id()).unwrap_or(usize::MAX));
    ranked.truncate(PREFERRED_METHODS.len());
    let taken = methods.iter().find(|(label, _)| verdict.is_some_and(|verdict| verdict.method == *label));
    taken.map(|(_, method)| method.as_ref()).into_iter().chain(ranked).collect()
}

/// Failure if no method gives an estimate: every reason once.
fn unusable(record: &Trial, entries: &[MethodEntry], warnings: &[Warning]) -> Failure {
    let reasons = grouped(entries, |entry| entry.reason.as_deref().unwrap_or("no answer"));
    let mut message = match (entries, reasons.as_slice()) {
        ([only], [(reason, _)]) => format!("{} cannot identify this record: {reason}", only.method),
        (_, [(reason, _)]) => format!("no method can identify this record: {reason}"),
        _ => {
            let line = |(reason, failed): &(&str, Vec<&MethodEntry>)| {
                let methods: Vec<&str> = failed.iter().map(|entry| entry.method.as_str()).collect();
                format!("\n  {}: {reason}", methods.join(", "))
            };
            format!("no method can identify this record{}", reasons.iter().map(line).collect::<String>())
        }
    };
    warnings.iter().for_each(|warning| message += &format!("\nnote: {warning}"));
    if entries.iter().any(|entry| entry.failure.as_deref() != Some("not-excited")) {
        message += "\nhelp: give a zig-zag, or a record in which the rudder is put to both sides for as long as the ship needs to answer";
    }
    Failure::in_file(file_and_hash(record).0, message).with_code(ErrorCode::NoAnswer)
}

fn validate(other: &Trial, estimate: Option<&Estimate>) -> ValidationEntry {
    let replay = estimate.and_then(|estimate| replay(other, &estimate.response));
    ValidationEntry {
        file: file_and_hash(other).0.to_owned(),
        heading_rmse_deg: replay.map(|replay| to_deg(replay.rms())),
    }
}
