//! Figures of a trace, from its document and its curves: every record with the model before and after, errors on
//! records that were not fitted, the evidence, the moment that the base lacks, and the residuals from several sides.

use ::trace::document::{BeforeAfter, Outcome};
use ::trace::replay_errors::{HORIZONS, replayed_zigzag};
use campaign::curves::curve;
use campaign::folder::ResultFolder;
use estimation::residuals::{GappedSeries, SpectralLine, autocorrelation, spectrum};
use identify::replay::Replay;
use predict::known::ValidityRange;
use predict::steady::SteadyCurve;
use rayon::prelude::*;
use report::figures::{
    self, Division, Dot, DotColumn, DotPlot, Drawn as Layered, Evidence, EvidenceRow, Fate, Fit, FitBand, Layer,
    Layers, Panels, Pen, RecordFit, Reference95, RowPart, Rows, Ruler, Scale, Stack,
};
use report::number::significant;
use report::{Curve, Figure, Origin, Theme};
use scenario::failure::Failure;
use ship::angle::to_deg;
use trial::{Trial, ZigZag, imo};

use super::picture::{first_failure, write_figure};
use super::predict_figures::steady;
use super::trace_tables::{horizon, term};
use super::{index_figures, missing_moment};
use crate::documents::curves::{Curves, TracedRecord};
use crate::documents::trace::{RecordEntry, TraceDocument, slugs, suffix};

/// Lags of the autocorrelation, at least where the record has them and at most.
const LAGS: [usize; 2] = [60, 4000];

/// Lines of a spectrum whose frequencies differ by no more than this factor are averaged into one.
const LINE: f64 = 1.06;

/// Where a figure stands in the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// A fitted record.
    Record,
    /// Records that were not fitted.
    HeldOut,
    /// What the effects rest on.
    Evidence,
    /// The moment that the base lacks.
    Moment,
    /// All else.
    Further,
}

/// A figure that was drawn.
pub struct Drawn {
    /// Where it stands.
    pub part: Part,
    /// Stem of its files.
    pub stem: String,
    /// What is to be seen.
    pub caption: String,
}

/// A figure to draw.
type Drawing<'a> = (Drawn, Box<dyn Fn(&Theme) -> Figure + Sync + Send + 'a>);

fn drawing<'a>(
    part: Part,
    stem: impl Into<String>,
    caption: impl Into<String>,
    draw: impl Fn(&Theme) -> Figure + Sync + Send + 'a,
) -> Drawing<'a> {
    (Drawn { part, stem: stem.into(), caption: caption.into() }, Box::new(draw))
}

/// Draws everything into `folder`; `turns` are the steady turns of the model. Fails when a file cannot be written.
pub fn draw(
    document: &TraceDocument,
    curves: &Curves,
    turns: Option<&(Vec<SteadyCurve>, ValidityRange)>,
    theme: &Theme,
    folder: &ResultFolder,
) -> Result<Vec<Drawn>, Failure> {
    let names: Vec<String> = document.records.iter().map(|record| record.name.clone()).collect();
    let mut drawings = of_the_trace(document, curves, turns);
    let (fitted, judged) = document.errors();
    let errors = fitted.iter().chain(judged.iter().filter(|one| one.used == "held out")).map(|one| one.errors);
    for (number, ((entry, record), errors)) in document.records.iter().zip(&curves.records).zip(errors).enumerate() {
        drawings.extend(of_record(entry, record, errors, &suffix(&names, number)));
    }
    for (entry, tables) in document.missing_moment.iter().zip(&curves.moments) {
        let number = names.iter().position(|name| *name == entry.record).unwrap_or(0);
        let stem = format!("missing-moment-{}", slugs(&names)[number]);
        let draw = move |theme: &Theme| missing_moment::figure(entry, tables, theme);
        drawings.push(drawing(Part::Moment, stem, missing_moment::sentence(entry), draw));
    }
    first_failure(drawings.par_iter().map(|(drawn, draw)| write_figure(&draw(theme), folder, &drawn.stem)))?;
    Ok(drawings.into_iter().map(|(drawn, _)| drawn).collect())
}

/// Figures of all records together, and of the model.
fn of_the_trace<'a>(
    document: &'a TraceDocument,
    curves: &'a Curves,
    turns: Option<&'a (Vec<SteadyCurve>, ValidityRange)>,
) -> Vec<Drawing<'a>> {
    let mut drawings = Vec::new();
    if let Some(data) = held_out(document) {
        let caption = "Error of the heading on records that were not fitted, before and after: of the whole replay, \
                       and of replays that begin anew every 20 and 60 s.";
        drawings.push(drawing(Part::HeldOut, "held-out", caption, move |theme| figures::dots(&data, theme)));
    }
    let caption =
        "Probability of every effect with its most probable form, and the support −ΔBIC that it has beside all others.";
    let data = evidence(document);
    drawings.push(drawing(Part::Evidence, "evidence", caption, move |theme| figures::evidence(&data, theme)));
    let data = overshoots(document, curves);
    if !data.names.is_empty() {
        let caption = "Overshoots of the records and of the replays of their rudder before and after, with the \
                       limits of IMO MSC.137(76) where one is for this zig-zag.";
        let draw = move |theme: &Theme| figures::rows(&data, theme);
        drawings.push(drawing(Part::Further, "overshoots", caption, draw));
    }
    if let Some((curves, seen)) = turns {
        let caption = "Steady yaw rate against rudder of the model, an unstable branch dashed; thin: ships that the \
                       records cannot tell from it; grey: the range of the records.";
        let draw = move |theme: &Theme| figures::steady_curves(&steady(curves, *seen), theme);
        drawings.push(drawing(Part::Further, "steady", caption, draw));
    }
    drawings
}

/// Figures of a record. Held-out records are judged, not studied.
fn of_record<'a>(
    entry: &'a RecordEntry,
    record: &'a TracedRecord,
    errors: &BeforeAfter,
    suffix: &str,
) -> Vec<Drawing<'a>> {
    let name = &entry.name;
    let ratio = significant(errors.after.heading_rmse_deg / errors.before.heading_rmse_deg, 2);
    let held = if entry.held_out { ", held out" } else { "" };
    let data = record_fit(record, errors, format!("{name}{held}: heading error after / before {ratio}"));
    let caption = format!("{name}{held}: heading, residual and rudder, with the 95 % band of the model after.");
    let part = if entry.held_out { Part::HeldOut } else { Part::Record };
    let mut drawings =
        vec![drawing(part, format!("record{suffix}"), caption, move |theme| figures::record_fit(&data, theme))];
    let caption = format!("{name}: yaw rate against heading, with the replays of the model before and after.");
    let draw = move |theme: &Theme| {
        let fits = models(record).map(|(origin, replay)| index_figures::phase_of(origin, replay)).into();
        figures::phase_plane(&index_figures::phase_plane(name.clone(), &record.trial, fits), theme)
    };
    drawings.push(drawing(Part::Further, format!("phase{suffix}"), caption, draw));
    if !entry.held_out {
        let caption = format!(
            "{name}: the residual against time, heading, yaw rate and rudder, its spectrum and autocorrelation."
        );
        let draw = move |theme: &Theme| figures::panels(&residual(record, name), theme);
        drawings.push(drawing(Part::Further, format!("residual{suffix}"), caption, draw));
    }
    drawings
}

fn models(record: &TracedRecord) -> [(Origin, &Replay); 2] {
    let [before, after] = &record.replays;
    [(Origin::Before, before), (Origin::After, after)]
}

/// A record with the models before and after.
fn record_fit(record: &TracedRecord, errors: &BeforeAfter, title: String) -> RecordFit {
    let (trial, after) = (&record.trial, &record.replays[1]);
    // The ends of the band about some headings.
    let about = |middle: &dyn Fn(usize) -> f64| -> Option<[Curve; 2]> {
        let end = |side: f64, band: &[f64]| -> Vec<f64> {
            band.iter().enumerate().map(|(row, half)| middle(row) + side * half).collect()
        };
        record.band.as_ref().map(|band| [-1.0, 1.0].map(|side| curve(&after.time, &end(side, band))))
    };
    let band = about(&|row| after.heading[row]).zip(about(&|_| 0.0));
    let fit = |((origin, replay), rms): ((Origin, &Replay), f64)| Fit {
        band: if origin == Origin::After {
            band.clone().map(|(heading, residual)| FitBand { heading, residual })
        } else {
            None
        },
        origin,
        heading: curve(&replay.time, &replay.heading),
        residual: curve(&replay.time, &replay.residual),
        rms_deg: Some(rms),
    };
    let sizes = [errors.before.heading_rmse_deg, errors.after.heading_rmse_deg];
    RecordFit {
        title: Some(title),
        heading: curve(trial.time(), trial.heading()),
        rudder: curve(trial.time(), trial.rudder()),
        fits: models(record).into_iter().zip(sizes).map(fit).collect(),
    }
}

/// Errors on records that were not fitted; `None` where there are none.
fn held_out(document: &TraceDocument) -> Option<DotPlot> {
    let (_, judged) = document.errors();
    let column = |x_title: String, of: &dyn Fn(&::trace::document::ErrorsEntry) -> Option<f64>| {
        let row = |errors: &BeforeAfter| -> Vec<Dot> {
            let pairs = [(Origin::Before, &errors.before), (Origin::After, &errors.after)];
            let dot = |(origin, own)| Some(Dot { origin, x: of(own)?, interval: None, hollow: false });
            pairs.into_iter().filter_map(dot).collect()
        };
        let rows = judged.iter().map(|one| row(one.errors)).collect();
        // From zero, so that a ratio can be seen.
        let reference = Some(Reference95 { value: 0.0, band: [0.0; 2] });
        DotColumn { x_title, scale: Scale::Linear, reference, limit: None, rows }
    };
    let mut columns = vec![column(String::from("whole replay [°]"), &|own| Some(own.heading_rmse_deg))];
    columns.extend(HORIZONS.map(|length| column(format!("every {length:.0} s [°]"), &move |own| horizon(own, length))));
    (!judged.is_empty()).then(|| DotPlot {
        title: Some(String::from("Error of the heading on records that were not fitted")),
        names: judged.iter().map(|one| format!("{}, {}", one.name, one.used)).collect(),
        columns,
        ..DotPlot::default()
    })
}

/// Every effect with its probability and support: the named ones first, then the others by their probability.
fn evidence(document: &TraceDocument) -> Evidence {
    let trace = &document.trace;
    let named = trace.effects.iter().map(|one| EvidenceRow {
        name: term(&one.id, &one.form, one.only.as_ref()),
        probability: one.probability,
        support: Some(-one.delta_bic),
        fate: Fate::Added,
    });
    let others = trace.candidates.iter().filter(|one| trace.effects.iter().all(|effect| effect.id != one.id));
    let mut others: Vec<EvidenceRow> = others
        .map(|one| {
            let best = one.forms.iter().max_by(|own, other| own.probability.total_cmp(&other.probability));
            EvidenceRow {
                name: best.map_or_else(|| one.id.clone(), |best| term(&one.id, &best.form, best.only.as_ref())),
                probability: one.probability,
                support: one.delta_bic.map(|change| -change),
                fate: match one.outcome {
                    Outcome::Added => Fate::Added,
                    Outcome::Alias => Fate::Alias,
                    Outcome::Rejected => Fate::Rejected,
                    Outcome::NotObservable => Fate::NotObservable,
                },
            }
        })
        .collect();
    others.sort_by(|one, other| other.probability.total_cmp(&one.probability));
    Evidence { title: Some(document.title()), rows: named.chain(others).collect() }
}

/// The first two overshoots of every zig-zag, which are those that have a limit, with those of both replays.
fn overshoots(document: &TraceDocument, curves: &Curves) -> Rows {
    let mut names = Vec::new();
    let [mut measured, mut before, mut after, mut limits] = [const { Vec::new() }; 4];
    for (entry, TracedRecord { trial, replays, .. }) in document.records.iter().zip(&curves.records) {
        let Ok(zigzag) = ZigZag::of(trial) else { continue };
        let replays = replays.each_ref().map(|replay| replayed_zigzag(trial, replay));
        let criteria: Vec<_> = entry.particulars().map(|ship| imo::criteria(&zigzag, ship)).unwrap_or_default();
        for (number, word) in [(0, "first"), (1, "second")] {
            let of = |zigzag: &ZigZag| Some(to_deg(zigzag.swings().nth(number)??.angle.value));
            let Some(angle) = of(&zigzag) else { continue };
            let limit = criteria.iter().find(|limit| {
                limit.unit == imo::Unit::Degrees && limit.measured.is_some() && limit.name.contains(word)
            });
            names.push((format!("{}, {word}", entry.name), false));
            measured.push(Some(angle));
            let [one, other] = replays.each_ref().map(|replay| replay.as_ref().and_then(of));
            before.push(one);
            after.push(other);
            limits.push(limit.map(|limit| limit.limit));
        }
    }
    // One mark above the other, so that neither hides the other.
    let marks = |origin: Origin, aside: f64, values| RowPart::Marks(origin.look(), aside, values);
    Rows {
        title: Some(String::from("Overshoots of the records and of their replays")),
        x_title: String::from("overshoot [°]"),
        names,
        parts: vec![
            ("measured", RowPart::Bars(measured), false),
            ("IMO limit", RowPart::Limits(limits), false),
            ("before", marks(Origin::Before, -0.16, before), true),
            ("after", marks(Origin::After, 0.16, after), true),
        ],
    }
}

/// The residual before and after from all sides.
fn residual(record: &TracedRecord, name: &str) -> Panels {
    let trial: &Trial = &record.trial;
    let first = trial.time().partition_point(|&t| t < record.replays[0].time[0]);
    let degrees = |values: &[f64]| -> Vec<f64> { values.iter().map(|&x| to_deg(x)).collect() };
    let stack = |x: Ruler, y: Ruler, joined: bool, of: &dyn Fn(&Replay) -> Curve| {
        let layer = |(origin, replay): (Origin, &Replay)| {
            let colour = origin.look().colour;
            let drawn =
                if joined { Layered::Line(Pen { width: 0.9, ..Pen::new(colour) }) } else { Layered::Dots(colour) };
            Layer::new(origin.label(), of(replay), drawn)
        };
        let zero = y.division != Division::Factors;
        let panel = Layers { y, height: 0.17, zero, layers: models(record).map(layer).into(), levels: Vec::new() };
        Stack { x, is_half: true, panels: vec![panel], ..Stack::default() }
    };
    let decimal = |title: &str| Ruler::new(title, Division::Decimal);
    let against = |x_title: &str, x: &dyn Fn(&Replay) -> Vec<f64>| {
        let of = |replay: &Replay| thinned(x(replay), degrees(&replay.residual));
        stack(decimal(x_title), decimal("residual [°]"), false, &of)
    };
    let series = |replay: &Replay| GappedSeries::new(&replay.time, &degrees(&replay.residual), trial.sampling_period());
    let period = ZigZag::of(trial).ok().and_then(|zigzag| zigzag.period).map(|period| period.value);
    let rows = series(&record.replays[0]).values.len();
    let band = 1.96 / (rows as f64).sqrt();
    let lags = |replay: &Replay| {
        let series = series(replay);
        // A little more than a period, which shows at its lag what the manoeuvre repeats.
        let wanted = period.map_or(rows / 3, |period| (1.1 * period / series.spacing) as usize);
        let points = autocorrelation(&series, wanted.clamp(LAGS[0], LAGS[1]).min(rows / 2)).into_iter();
        let (lags, values): (Vec<f64>, Vec<f64>) =
            points.map(|one| (one.lag as f64 * series.spacing, one.value)).unzip();
        Curve::new(lags, values)
    };
    let frequency = Ruler::new("frequency [Hz]", Division::Factors);
    let density = Ruler::new("power [°²/Hz]", Division::Factors);
    let spectrum = stack(frequency, density, true, &|replay| power(&series(replay)));
    let mut correlation = stack(decimal("lag [s]"), decimal("autocorrelation"), true, &lags);
    correlation.panels[0].levels = vec![-band, band];
    let stacks = vec![
        against("time [s]", &|replay| replay.time.clone()),
        against("heading [°]", &|replay| degrees(&replay.heading)),
        against("yaw rate [°/s]", &|replay| degrees(&replay.yaw_rate)),
        against("rudder [°]", &|replay| degrees(&trial.rudder()[first..first + replay.time.len()])),
        Stack { mark: period.map(f64::recip), ..spectrum },
        Stack { mark: period, ..correlation },
    ];
    let mark_name = Some(String::from("period of the manoeuvre"));
    Panels { title: Some(name.to_owned()), stacks, mark_name, ..Panels::default() }
}

/// Points of a cloud, not more than a figure can show.
fn thinned(x: Vec<f64>, y: Vec<f64>) -> Curve {
    let step = x.len().div_ceil(1500).max(1);
    let every = |values: Vec<f64>| values.into_iter().step_by(step).collect::<Vec<f64>>();
    Curve::new(every(x), every(y))
}

/// Power spectral density of a residual in degrees, neighbouring lines averaged.
fn power(residual: &GappedSeries) -> Curve {
    let count = residual.values.len().max(1) as f64;
    let square = residual.values.iter().map(|e| e * e).sum::<f64>() / count;
    let lines = spectrum(residual);
    let width = 1.0 / (count * residual.spacing);
    let mut groups: Vec<&[SpectralLine]> = Vec::new();
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
