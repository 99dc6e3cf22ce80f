//! Figures of an analysis: every record with the model before and after, the residuals from several sides, the moment
//! that the base lacks, and the candidates with the threshold.

use ::trace::analysis::{Analysis, Judged, OnRecord, Outcome, Step, StepOnRecord};
use ::trace::diagnostics::{Line, Series, autocorrelation, spectrum};
use ::trace::replay_errors::replayed_zigzag;
use identify::replay::Replay;
use rayon::prelude::*;
use report::figures::{
    self, Evidence, EvidenceBar, EvidenceStep, Fate, Fit, FitBand, OvershootReplays, RecordFit, ReplayedOvershoot,
    Replays, ResidualPanel, ResidualPanels,
};
use report::{Curve, Figure, Origin, Theme};
use ship::angle::to_deg;
use trial::{Trial, ZigZag, imo};

use super::curve_tables;
use super::index_figures;
use super::missing_moment;
use super::picture::{first_failure, slug, write_figure};
use super::predict_figures::steady;
use super::trace_page;
use super::trace_report::TraceReport;
use crate::records::names;
use campaign::curves::curve;
use campaign::folder::ResultFolder;
use scenario::failure::Failure;

/// Lags of the autocorrelation, at least where the record has them and at most.
const LAGS: [usize; 2] = [60, 4000];

/// Lines of a spectrum whose frequencies differ by no more than this factor are averaged into one.
const LINE: f64 = 1.06;

/// Stem, caption and what is drawn.
type Drawing<'a> = (String, String, Box<dyn Fn() -> Figure + Sync + Send + 'a>);

/// Draws everything into `folder` and returns stems and captions.
pub fn draw(report: &TraceReport, theme: &Theme, folder: &ResultFolder) -> Result<Vec<(String, String)>, Failure> {
    let analysis = &report.analysis;
    let trials: Vec<&Trial> = report.trials.iter().chain(&report.others).collect();
    let judged: Vec<&Judged> = analysis.identification.iter().chain(&analysis.validation).collect();
    // Two names may make one slug.
    let slugs = names(report.names.iter().map(|name| slug(name)));
    let curves: Vec<(RecordFit, Option<ResidualPanels>)> = trials
        .par_iter()
        .zip(&judged)
        .enumerate()
        .map(|(number, (&trial, &judged))| {
            let (name, held_out) = (&report.names[number], number >= report.trials.len());
            // Held-out records are judged, not studied.
            let residual = (!held_out).then(|| residual(trial, judged, name));
            (record(trial, judged, trace_page::title(judged, name, held_out)), residual)
        })
        .collect();
    let mut drawings: Vec<Drawing> = Vec::new();
    let suffix = |number: usize| if number == 0 { String::new() } else { format!("-{}", slugs[number]) };
    for (number, (record, residual)) in curves.iter().enumerate() {
        folder.write(&format!("replay{}.csv", suffix(number)), curve_tables::of_record(record))?;
        for (stem, table) in residual.iter().flat_map(curve_tables::of_residual) {
            folder.write(&format!("{stem}{}.csv", suffix(number)), table)?;
        }
    }
    for (number, (&trial, &judged)) in trials.iter().zip(&judged).enumerate() {
        let name = &report.names[number];
        let suffix = suffix(number);
        let (record, residual) = &curves[number];
        let title = record.title.as_deref().unwrap_or_default();
        let caption = format!("{title}: heading, residual and rudder, with the 95 % band of the model after.");
        drawings.push((format!("record{suffix}"), caption, Box::new(move || figures::record_fit(record, theme))));
        let caption = format!("{name}: yaw rate against heading, with the replays of the model before and after.");
        let of_record = name.clone();
        let draw = move || {
            let models = [(Origin::Before, &judged.before), (Origin::After, &judged.after)];
            let fits = models.map(|(origin, on)| index_figures::phase_of(origin, &on.replay)).into();
            figures::phase_plane(&index_figures::phase_plane(of_record.clone(), trial, fits), theme)
        };
        drawings.push((format!("phase{suffix}"), caption, Box::new(draw)));
        if let Some(steps) = steps(analysis, number, trial, name) {
            let caption = format!(
                "{name}: the recorded rudder replayed with the base and after every effect that was added; in `report.html` each \
                 can be switched off and on."
            );
            drawings.push((format!("steps{suffix}"), caption, Box::new(move || figures::replays(&steps, theme))));
        }
        let Some(residual) = residual else { continue };
        let caption = format!(
            "{name}: the residual against heading, yaw rate, rudder and time, its spectrum and autocorrelation."
        );
        drawings.push((
            format!("residual{suffix}"),
            caption,
            Box::new(move || figures::residual_panels(residual, theme)),
        ));
    }
    for shown in missing_moment::shown(report) {
        let caption = missing_moment::sentence(report, &shown);
        let stem = shown.stem.clone();
        let draw = move || missing_moment::figure(report, &shown, theme);
        drawings.push((stem, caption, Box::new(draw)));
    }
    drawings.extend(of_the_ship(report, theme));
    let caption = "Above: the error of the heading on the fitted records after every effect that was added, in the order \
                   of discovery, and on held-out records. Below: what every other candidate would gain beside them; colours \
                   say what became of it.";
    drawings.push((String::from("candidates"), caption.into(), Box::new(move || candidates(report, theme))));
    first_failure(drawings.par_iter().map(|(stem, _, draw)| write_figure(&draw(), folder, stem)))?;
    Ok(drawings.into_iter().map(|(stem, caption, _)| (stem, caption)).collect())
}

/// Figures of the model and not of a record: steady turns, K and T over the amplitude, overshoots.
fn of_the_ship<'a>(report: &'a TraceReport, theme: &'a Theme) -> Vec<Drawing<'a>> {
    let mut drawings: Vec<Drawing> = Vec::new();
    if let Some((curves, seen)) = &report.steady {
        let caption = "Steady yaw rate against rudder of the model, an unstable branch dashed; thin: ships that the \
                       records cannot tell from it; grey: the range of the records.";
        let draw = move || figures::steady_curves(&steady(curves, *seen), theme);
        drawings.push((String::from("steady"), caption.to_owned(), Box::new(draw)));
    }
    if let Some(all) = &report.amplitudes {
        let caption = "K and T of a first-order response fitted to every record alone, over the amplitude of its zig-zag, \
                       and what such a fit finds in zig-zags of the model.";
        let base = &report.analysis.base;
        let title = format!("{} records", all.records.len());
        let data = index_figures::amplitude(title, all, Some([base.K(), base.T()]), report.ship);
        drawings.push((
            String::from("amplitude"),
            caption.to_owned(),
            Box::new(move || figures::amplitude(&data, theme)),
        ));
    }
    let rows = overshoot_rows(report);
    if !rows.is_empty() {
        let caption = "Overshoots of the records and of the replays of their rudder before and after, with the limits of \
                       IMO MSC.137(76) where one is for this zig-zag.";
        let data =
            OvershootReplays { title: Some(String::from("Overshoots of the records and of their replays")), rows };
        let draw = move || figures::overshoot_replays(&data, theme);
        drawings.push((String::from("overshoots"), caption.to_owned(), Box::new(draw)));
    }
    drawings
}

/// The first two overshoots of every zig-zag, which are those that have a limit.
fn overshoot_rows(report: &TraceReport) -> Vec<ReplayedOvershoot> {
    let analysis = &report.analysis;
    let trials = report.trials.iter().chain(&report.others);
    let judged = analysis.identification.iter().chain(&analysis.validation);
    let mut rows = Vec::new();
    for (((trial, judged), name), ship) in trials.zip(judged).zip(&report.names).zip(&report.sailed_by) {
        let Ok(measured) = ZigZag::of(trial) else { continue };
        let replays = [&judged.before, &judged.after].map(|on| replayed_zigzag(trial, &on.replay));
        let limits: Vec<_> = ship.map(|ship| imo::criteria(&measured, ship)).unwrap_or_default();
        for (number, word) in [(0, "first"), (1, "second")] {
            let of = |zigzag: &ZigZag| Some(to_deg(zigzag.swings().nth(number)??.angle.value));
            let Some(angle) = of(&measured) else { continue };
            let limit = limits.iter().find(|limit| {
                limit.unit == imo::Unit::Degrees && limit.measured.is_some() && limit.name.contains(word)
            });
            let [before, after] = replays.each_ref().map(|replay| replay.as_ref().and_then(of));
            rows.push(ReplayedOvershoot {
                label: format!("{name}, {word}"),
                measured: Some(angle),
                before,
                after,
                limit: limit.map(|limit| limit.limit),
            });
        }
    }
    rows
}

/// A record with the models before and after.
fn record(trial: &Trial, judged: &Judged, title: String) -> RecordFit {
    let fit = |origin: Origin, on: &OnRecord| {
        let Replay { time, heading, residual, .. } = &on.replay;
        Fit {
            origin,
            heading: curve(time, heading),
            residual: curve(time, residual),
            rms_deg: Some(to_deg(on.errors.heading)),
            band: None,
        }
    };
    // The ends of the band about some headings.
    let about = |middle: &dyn Fn(usize) -> f64| -> Option<[Curve; 2]> {
        let OnRecord { replay, band, .. } = &judged.after;
        let end = |side: f64, band: &[f64]| -> Vec<f64> {
            band.iter().enumerate().map(|(row, half)| middle(row) + side * half).collect()
        };
        band.as_ref().map(|band| [-1.0, 1.0].map(|side| curve(&replay.time, &end(side, band))))
    };
    let (before, after) = (&judged.before, &judged.after);
    let band = about(&|row| after.replay.heading[row]).zip(about(&|_| 0.0));
    let band = band.map(|(heading, residual)| FitBand { heading, residual });
    RecordFit {
        title: Some(title),
        heading: curve(trial.time(), trial.heading()),
        rudder: curve(trial.time(), trial.rudder()),
        fits: vec![fit(Origin::Before, before), Fit { band, ..fit(Origin::After, after) }],
    }
}

/// A fitted record with the replays of all steps; `None` for a held-out record, and where nothing was added.
fn steps(analysis: &Analysis, place: usize, trial: &Trial, name: &str) -> Option<Replays> {
    let replay = |(number, step): (usize, &Step)| {
        let StepOnRecord { time, heading, residual } = step.records.get(place)?;
        let label = step.added.map_or_else(|| String::from("base"), |(id, ..)| format!("+ {id}"));
        let square: f64 = residual.iter().map(|left| left * left).sum();
        Some(figures::Replay {
            origin: Origin::Series { label, number },
            heading: curve(time, heading),
            residual: curve(time, residual),
            rms_deg: Some(to_deg((square / residual.len() as f64).sqrt())),
        })
    };
    let replays: Vec<figures::Replay> = analysis.steps.iter().enumerate().filter_map(replay).collect();
    let record = curve(trial.time(), trial.heading());
    (replays.len() > 1).then(|| Replays { title: Some(name.to_owned()), record, truth: None, replays })
}

/// The residual before and after from all sides.
fn residual(trial: &Trial, judged: &Judged, name: &str) -> ResidualPanels {
    let first = trial.time().partition_point(|&t| t < judged.before.replay.time[0]);
    let models = [(Origin::Before, &judged.before.replay), (Origin::After, &judged.after.replay)];
    let degrees = |values: &[f64]| -> Vec<f64> { values.iter().map(|&x| to_deg(x)).collect() };
    let against = |x_title: &str, x: &dyn Fn(&Replay) -> Vec<f64>| ResidualPanel {
        x_title: x_title.to_owned(),
        y_title: String::from("residual [°]"),
        logarithmic: false,
        joined: false,
        of_frequency: false,
        mark: None,
        curves: models
            .iter()
            .map(|(origin, replayed)| (origin.clone(), thinned_pairs(x(replayed), degrees(&replayed.residual))))
            .collect(),
        band: None,
    };
    let rudder = |replayed: &Replay| degrees(&trial.rudder()[first..first + replayed.time.len()]);
    let series = |replayed: &Replay| Series::new(&replayed.time, &degrees(&replayed.residual), trial.sampling_period());
    let period = ZigZag::of(trial).ok().and_then(|zigzag| zigzag.period).map(|period| period.value);
    let lines = ResidualPanel {
        x_title: String::from("frequency [Hz]"),
        y_title: String::from("power [°²/Hz]"),
        logarithmic: true,
        joined: true,
        of_frequency: true,
        mark: period.map(f64::recip),
        curves: models.iter().map(|(origin, replayed)| (origin.clone(), power(&series(replayed)))).collect(),
        band: None,
    };
    let rows = series(models[0].1).values.len();
    let band = 1.96 / (rows as f64).sqrt();
    let correlations = ResidualPanel {
        x_title: String::from("lag [s]"),
        y_title: String::from("autocorrelation"),
        logarithmic: false,
        joined: true,
        of_frequency: false,
        mark: period,
        curves: models
            .iter()
            .map(|(origin, replayed)| {
                let series = series(replayed);
                // A little more than a period, which shows at its lag what the manoeuvre repeats.
                let wanted = period.map_or(rows / 3, |period| (1.1 * period / series.spacing) as usize);
                let points = autocorrelation(&series, wanted.clamp(LAGS[0], LAGS[1]).min(rows / 2)).into_iter();
                let (lags, values): (Vec<f64>, Vec<f64>) =
                    points.map(|one| (one.lag as f64 * series.spacing, one.value)).unzip();
                (origin.clone(), Curve::new(lags, values))
            })
            .collect(),
        band: Some([-band, band]),
    };
    ResidualPanels {
        title: Some(name.to_owned()),
        panels: vec![
            against("time [s]", &|replayed| replayed.time.clone()),
            against("heading [°]", &|replayed| degrees(&replayed.heading)),
            against("yaw rate [°/s]", &|replayed| degrees(&replayed.yaw_rate)),
            against("rudder [°]", &rudder),
            lines,
            correlations,
        ],
    }
}

/// Points of a cloud, not more than a figure can show.
fn thinned_pairs(x: Vec<f64>, y: Vec<f64>) -> Curve {
    let step = x.len().div_ceil(1500).max(1);
    let every = |values: Vec<f64>| values.into_iter().step_by(step).collect::<Vec<f64>>();
    Curve::new(every(x), every(y))
}

/// Power spectral density of a residual in degrees, neighbouring lines averaged.
fn power(residual: &Series) -> Curve {
    let count = residual.values.len().max(1) as f64;
    let square = residual.values.iter().map(|e| e * e).sum::<f64>() / count;
    let lines = spectrum(residual);
    let width = 1.0 / (count * residual.spacing);
    let mut groups: Vec<&[Line]> = Vec::new();
    let mut rest = &lines[..];
    while let Some(first) = rest.first() {
        let (group, others) = rest.split_at(rest.partition_point(|line| line.frequency <= LINE * first.frequency));
        groups.push(group);
        rest = others;
    }
    let points = groups.into_iter().map(|lines| {
        let count = lines.len() as f64;
        let frequency = lines.iter().map(|line| line.frequency).sum::<f64>() / count;
        (frequency, lines.iter().map(|line| line.share).sum::<f64>() / count * square / width)
    });
    let (x, y): (Vec<f64>, Vec<f64>) = points.unzip();
    Curve::new(x, y)
}

/// The way of the model and the candidates beside it.
fn candidates(report: &TraceReport, theme: &Theme) -> Figure {
    let analysis = &report.analysis;
    let only = |name: Option<&String>| name.map_or_else(String::new, |name| format!(", {name}"));
    let steps = analysis.steps.iter().map(|step| EvidenceStep {
        name: step.added.map_or_else(
            || String::from("base"),
            |(id, form, record)| format!("+ {id} ({form}){}", only(record.map(|record| &report.names[record.0]))),
        ),
        fitted_deg: to_deg(step.fitted),
        held_out_deg: step.held_out.map(to_deg),
    });
    let mut bars: Vec<EvidenceBar> = analysis
        .candidates
        .iter()
        .filter_map(|one| {
            let gain = one.evidence?.gain;
            Some(EvidenceBar {
                name: format!("{} ({}){}", one.id, one.form, only(one.only.as_ref())),
                gain,
                threshold: one.needed,
                fate: match one.outcome {
                    Outcome::Added => return None,
                    Outcome::Alias => Fate::Alias,
                    Outcome::Rejected => Fate::Rejected,
                    Outcome::NotObservable => Fate::NotObservable,
                },
            })
        })
        .collect();
    bars.sort_by(|one, other| other.gain.total_cmp(&one.gain));
    // What came back later is not gone.
    let is_gone = |sentence: &str| {
        !analysis.effects.iter().any(|effect| sentence.starts_with(&format!("{} ({}) ", effect.id, effect.form)))
    };
    let data = Evidence {
        title: Some(report.names[..report.trials.len()].join(", ")),
        steps: steps.collect(),
        bars,
        dropped: analysis.refused.iter().filter(|sentence| is_gone(sentence)).cloned().collect(),
    };
    figures::evidence(&data, theme)
}
