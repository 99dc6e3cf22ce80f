//! Figures of a trace, from its document and its curves: every fitted record with the base (before) and the average of
//! the structures (after), the evidence, the innovations, the moment that the base lacks, and plots of the residuals.

use campaign::curves::{angle_curve_deg, degrees};
use document::names;
use document::trace::{
    AnalysisDocument, CandidateOutcome, EffectEntry, MissingMomentEntry, ModelReplayErrors, RecordEntry,
    RecordReplayErrors, TraceDocument,
};
use estimation::residuals::{GappedSeries, SpectralLine, periodogram};
use identify::replay::Replay;
use report::figures::{
    AxisLine, AxisSpec, Layer, LayerKind, NamedRows, PanelGroup, PanelRow, Panels, Pen, RowItem, RowKind, RowsColumn,
    TickRule,
};
use report::number::{MISSING, fixed, significant};
use report::palette::{CurveStyle, HEADING, Marker, RGBColor, RUDDER, SOLID};
use report::{CurveOrigin, PageFigure, PlotCurve};
use ship::angle::to_deg;
use trial::{Trial, ZigZag};

use super::record_figures::{ModelOverTime, over_time};
use super::trace_tables::effect_text;
use super::{innovation_figure, missing_moment};
use crate::documents::curves::{TraceCurves, TracedRecord, file_name_suffix, record_slugs};
use crate::documents::missing_moment::MissingMomentCurves;

/// Maximum ratio of the frequencies of neighbouring spectral lines that are averaged.
const LINE: f64 = 1.06;

/// Figures of every fitted record with the models before and after.
pub fn record_figures(document: &TraceDocument, curves: &TraceCurves) -> Vec<PageFigure> {
    let stems = document.names();
    let fitted = document.records.iter().zip(&curves.records).enumerate().filter(|(_, (entry, _))| !entry.held_out);
    let figure =
        |((number, (entry, record)), errors): ((usize, (&RecordEntry, &TracedRecord)), &RecordReplayErrors)| {
            let name = names::record_name(&entry.name);
            let share = significant(errors.after.heading_rmse_deg / errors.before.heading_rmse_deg, 2);
            let finding = format!("{name}: heading error of the whole replay × {share}");
            let caption = format!("{name}: heading, residual and rudder, with the 95 % band of the model after.");
            PageFigure::new(
                format!("record{}", file_name_suffix(&stems, number)),
                finding,
                caption,
                record_fit(record, errors),
            )
        };
    fitted.zip(&document.trace.error.identification).map(figure).collect()
}

/// Figures of the innovations of every fitted record.
pub fn innovation_figures(document: &TraceDocument, curves: &TraceCurves) -> Vec<PageFigure> {
    let stems = document.names();
    let figure = |(number, record): (usize, &TracedRecord)| {
        innovation_figure::innovation_figure(
            format!("innovations{}", file_name_suffix(&stems, number)),
            &names::record_name(&stems[number]),
            record.innovations.as_ref()?,
        )
    };
    curves.records.iter().enumerate().filter_map(figure).collect()
}

/// Figures of the moment that the base lacks on every fitted record.
pub fn moment_figures(document: &TraceDocument, curves: &TraceCurves) -> Vec<PageFigure> {
    let stems = document.names();
    let figure = |(entry, tables): (&MissingMomentEntry, _)| {
        let number = stems.iter().position(|name| *name == entry.record).unwrap_or(0);
        let stem = format!("missing-moment-{}", record_slugs(&stems)[number]);
        let curves = MissingMomentCurves::read(entry, tables);
        PageFigure::new(
            stem,
            missing_moment::missing_moment_finding(entry),
            missing_moment::missing_moment_sentence(entry),
            missing_moment::missing_moment_figure(entry, &curves),
        )
    };
    document.missing_moment.iter().zip(&curves.moment_tables).map(figure).collect()
}

/// Figures of the residuals of fitted records; held-out ones serve for validation only.
pub fn residual_figures(document: &TraceDocument, curves: &TraceCurves) -> Vec<PageFigure> {
    let stems = document.names();
    let mut figures = Vec::new();
    for (number, (RecordEntry { name, held_out, .. }, record)) in
        document.records.iter().zip(&curves.records).enumerate()
    {
        let (suffix, name) = (file_name_suffix(&stems, number), names::record_name(name));
        if !held_out {
            let caption = format!(
                "{name}: the residual of the whole replay against heading, yaw rate and rudder, and its spectrum."
            );
            let [before, after] = replays_by_origin(record).map(|(_, replay)| significant(to_deg(replay.rms()), 2));
            let finding = format!("{name}: heading error {before}° (rms) before, {after}° after");
            figures.push(PageFigure::new(format!("residual{suffix}"), finding, caption, residual(record)));
        }
    }
    figures
}

/// Replays of a record by the models before and after.
pub fn replays_by_origin(record: &TracedRecord) -> [(CurveOrigin, &Replay); 2] {
    let [before, after] = &record.replays;
    [(CurveOrigin::Before, before), (CurveOrigin::After, after)]
}

/// Models before and after of a record over time, the model after with its band; `rms` are their errors, degrees, if
/// they are to be shown.
pub fn models_over_time(record: &TracedRecord, rms: Option<[f64; 2]>) -> Vec<ModelOverTime> {
    let after = &record.replays[1];
    // Ends of the band about given headings.
    let about = |band: &[f64], middle: &dyn Fn(usize) -> f64| {
        [-1.0, 1.0].map(|side| {
            let end = |(row, half): (usize, &f64)| middle(row) + side * half;
            angle_curve_deg(&after.time, &band.iter().enumerate().map(end).collect::<Vec<f64>>())
        })
    };
    let band = record.half_width95.as_ref().map(|half| [about(half, &|row| after.heading[row]), about(half, &|_| 0.0)]);
    let model = |(number, (origin, replay)): (usize, (CurveOrigin, &Replay))| ModelOverTime {
        band: band.clone().filter(|_| origin == CurveOrigin::After),
        origin,
        heading: angle_curve_deg(&replay.time, &replay.heading),
        residual: angle_curve_deg(&replay.time, &replay.residual),
        rms_deg: rms.map(|rms| rms[number]),
    };
    replays_by_origin(record).into_iter().enumerate().map(model).collect()
}

/// Heading and rudder of a record over time, with the replays before and after.
fn record_fit(record: &TracedRecord, errors: &RecordReplayErrors) -> Panels {
    let trial = &record.trial;
    let rms = [errors.before.heading_rmse_deg, errors.after.heading_rmse_deg];
    let (heading, rudder) =
        (angle_curve_deg(trial.time(), trial.heading()), angle_curve_deg(trial.time(), trial.rudder()));
    over_time(heading, rudder, models_over_time(record, Some(rms)))
}

/// Root mean square heading errors over some records, deg: of the base, and of the structure average.
pub fn heading_rms_deg<'a>(all: impl Iterator<Item = &'a RecordReplayErrors> + Clone) -> [f64; 2] {
    let count = all.clone().count() as f64;
    let models: [fn(&RecordReplayErrors) -> &ModelReplayErrors; 2] = [|errors| &errors.before, |errors| &errors.after];
    models.map(|model| (all.clone().map(|errors| model(errors).heading_rmse_deg.powi(2)).sum::<f64>() / count).sqrt())
}

/// Ratio of the root mean square heading errors over some records: structure average to base.
pub fn heading_error_ratio<'a>(all: impl Iterator<Item = &'a RecordReplayErrors> + Clone) -> f64 {
    let [before, after] = heading_rms_deg(all);
    after / before
}

/// Maximum length of a bar of ΔBIC, in medians of all bars.
const MAX_BAR_MEDIANS: f64 = 30.0;

fn outcome_style(outcome: CandidateOutcome) -> (&'static str, CurveStyle) {
    let (name, colour) = match outcome {
        CandidateOutcome::Added => ("named", HEADING),
        CandidateOutcome::Alias => ("indistinguishable from a named one", RUDDER),
        CandidateOutcome::Rejected => ("not named", RGBColor(0x8A, 0x8A, 0x8A)),
        CandidateOutcome::NotObservable => ("not observable", RGBColor(0xC4, 0xC4, 0xC4)),
    };
    (
        name,
        CurveStyle {
            colour,
            marker: Marker::Square,
            dash: SOLID,
            is_hollow: outcome == CandidateOutcome::NotObservable,
        },
    )
}

/// Names of the effects with their probabilities.
fn named_effects(trace: &AnalysisDocument) -> String {
    let name =
        |effect: &EffectEntry| format!("{} (p = {})", names::effect_name(&effect.id), fixed(effect.probability, 3));
    let named: Vec<String> = trace.effects.iter().map(name).collect();
    match &named[..] {
        [] => format!("None of {} effects is named", trace.candidates.len()),
        [only] => format!("Named of {} effects: {only}", trace.candidates.len()),
        [first @ .., last] => format!("Named of {} effects: {} and {last}", trace.candidates.len(), first.join(", ")),
    }
}

/// Figure of every effect with its probability and ΔBIC: the named effects first, then the others by their probability.
pub fn evidence(document: &TraceDocument) -> PageFigure {
    let trace = &document.trace;
    let single = |id: &str| trace.candidates.iter().find(|entry| entry.id == id).map(|entry| entry.probability);
    let named = trace.effects.iter().map(|effect| {
        let (name, alone) = (
            effect_text(&effect.id, &effect.form, effect.only.as_ref()),
            single(&effect.id).unwrap_or(effect.probability),
        );
        let text = match effect.aliases.is_empty() {
            true => fixed(alone, 3),
            false => format!("{} ({})", fixed(alone, 3), fixed(effect.probability, 3)),
        };
        (name, (alone, text), Some(effect.delta_bic), CandidateOutcome::Added)
    });
    let silent = trace.candidates.iter().filter(|entry| trace.effects.iter().all(|effect| effect.id != entry.id));
    let mut silent: Vec<_> = silent
        .map(|entry| {
            let best = entry.forms.iter().max_by(|a, b| a.probability.total_cmp(&b.probability));
            let name = best.map_or_else(
                || names::effect_name(&entry.id),
                |best| effect_text(&entry.id, &best.form, best.only.as_ref()),
            );
            (name, (entry.probability, fixed(entry.probability, 3)), entry.delta_bic, entry.outcome)
        })
        .collect();
    silent.sort_by(|a, b| b.1.0.total_cmp(&a.1.0));
    let rows: Vec<_> = named.chain(silent).collect();
    let bar = |value: f64, text: String, outcome: CandidateOutcome| {
        let (name, style) = outcome_style(outcome);
        vec![RowItem { number: Some(text), ..RowItem::new(name, RowKind::Bar(style, value)) }]
    };
    let column = |x: AxisSpec, rows| RowsColumn { x, rows, has_zero_line: true, ..RowsColumn::default() };
    let probability = rows.iter().map(|(_, (value, text), _, outcome)| bar(*value, text.clone(), *outcome));
    let change = rows.iter().map(|(_, _, bic, outcome)| {
        bar(bic.unwrap_or(0.0), bic.map_or_else(|| MISSING.to_owned(), |bic| significant(bic, 3)), *outcome)
    });
    let has_group = trace.effects.iter().any(|effect| !effect.aliases.is_empty());
    let cut = AxisSpec::decimal("ΔBIC (negative: it helps)").limited_around(MAX_BAR_MEDIANS, Some(0.0));
    let columns = vec![column(AxisSpec::decimal("probability"), probability.collect()), column(cut, change.collect())];
    let names = rows.iter().map(|row| row.0.clone()).collect();
    let data = NamedRows { names, columns, ..NamedRows::default() };
    let group = if has_group { " In brackets: probability of it or an indistinguishable effect." } else { "" };
    let caption = format!(
        "Probability of every effect with its most probable form, and ΔBIC beside all others: negative where it helps.{group}"
    );
    PageFigure::new("evidence", named_effects(trace), caption, data)
}

/// Residual of the replays before and after against heading, yaw rate and rudder, and its spectrum.
fn residual(record: &TracedRecord) -> Panels {
    let trial: &Trial = &record.trial;
    let first = trial.time().partition_point(|&t| t < record.replays[0].time[0]);
    let group = |x: AxisSpec, y: AxisSpec, joined: bool, curve_of: &dyn Fn(&Replay) -> PlotCurve| {
        let layer = |(origin, replay): (CurveOrigin, &Replay)| {
            let colour = origin.style().colour;
            let line = LayerKind::Line(Pen::new(colour).width(0.9));
            Layer::new(origin.label(), curve_of(replay), if joined { line } else { LayerKind::Dots(colour) })
        };
        let row = PanelRow { has_zero_line: y.tick_rule != TickRule::Logarithmic, ..PanelRow::new(y, 0.17) };
        PanelGroup { is_half: true, ..PanelGroup::over(x, vec![(row, replays_by_origin(record).map(layer).into())]) }
    };
    let against = |x_title: &str, x: &dyn Fn(&Replay) -> Vec<f64>| {
        let scatter = |replay: &Replay| thinned(x(replay), degrees(&replay.residual));
        group(AxisSpec::decimal(x_title), AxisSpec::decimal("residual [°]"), false, &scatter)
    };
    let series = |replay: &Replay| GappedSeries::new(&replay.time, &degrees(&replay.residual), trial.sampling_period());
    let period = ZigZag::from_trial(trial).ok().and_then(|zigzag| zigzag.period).map(|period| period.value);
    let frequency = AxisSpec::new("frequency [Hz]", TickRule::Logarithmic);
    let density = AxisSpec::new("power [°²/Hz]", TickRule::Logarithmic);
    let spectrum = group(frequency, density, true, &|replay| power_spectrum(&series(replay)));
    let mark = period.map(|period| AxisLine { value: period.recip(), label: String::from("period") });
    let groups = vec![
        against("heading [°]", &|replay| degrees(&replay.heading)),
        against("yaw rate [°/s]", &|replay| degrees(&replay.yaw_rate)),
        against("rudder [°]", &|replay| degrees(&trial.rudder()[first..first + replay.time.len()])),
        PanelGroup { vertical_lines: mark.into_iter().collect(), ..spectrum },
    ];
    Panels { groups, ..Panels::default() }
}

/// Points of a cloud, thinned to at most 1500.
fn thinned(x: Vec<f64>, y: Vec<f64>) -> PlotCurve {
    let step = x.len().div_ceil(1500).max(1);
    let every = |values: Vec<f64>| values.into_iter().step_by(step).collect::<Vec<f64>>();
    PlotCurve::new(every(x), every(y))
}

/// Power spectral density of a residual in degrees: °²/Hz over Hz, neighbouring lines averaged.
fn power_spectrum(residual: &GappedSeries) -> PlotCurve {
    let count = residual.values.len().max(1) as f64;
    let square = residual.values.iter().map(|e| e * e).sum::<f64>() / count;
    let lines = periodogram(residual);
    let width = 1.0 / (count * residual.spacing);
    let mut groups: Vec<&[SpectralLine]> = Vec::new();
    let mut tail = &lines[..];
    while let Some(first) = tail.first() {
        let (group, after) = tail.split_at(tail.partition_point(|line| line.frequency <= LINE * first.frequency));
        groups.push(group);
        tail = after;
    }
    let points = groups.into_iter().map(|lines| {
        let count = lines.len() as f64;
        let frequency = lines.iter().map(|line| line.frequency).sum::<f64>() / count;
        (frequency, lines.iter().map(|line| line.mean_square_share).sum::<f64>() / count * square / width)
    });
    let (x, y): (Vec<f64>, Vec<f64>) = points.unzip();
    PlotCurve::new(x, y)
}
