//! Key figure of a trace: the first fitted record and one held-out record, each with the models before and after and
//! their heading residuals.

use campaign::curves::angle_curve_deg;
use document::names;
use document::trace::{RecordEntry, RecordReplayErrors, TraceDocument};
use report::figures::{AxisSpec, Layer, LayerKind, LayeredPanel, PanelGroup, PanelRow, Panels, TickRule};
use report::number::{counted, significant};
use report::palette::SOLID;
use report::{CurveOrigin, PageFigure};
use ship::dynamics::RegressorChannel;

use super::record_figures::heading_and_residual;
use super::trace_figures::{heading_error_ratio, heading_rms_deg, models_over_time};
use crate::documents::curves::{TraceCurves, TracedRecord};

/// Maximum number of names in a title.
const MAX_NAMES: usize = 3;

/// Finding: the missing effects, and the error ratios of fitted and held-out records.
fn finding(document: &TraceDocument) -> String {
    let mut ids: Vec<String> = document.trace.effects.iter().map(|effect| names::effect_name(&effect.id)).collect();
    ids.dedup();
    let more = ids.len().saturating_sub(MAX_NAMES);
    if more > 0 {
        ids.truncate(MAX_NAMES);
        ids.push(format!("{more} more"));
    }
    let with = match &ids[..] {
        [] => String::from("No effect is named:"),
        [only] => format!("With {only}"),
        [first @ .., last] => format!("With {} and {last}", first.join(", ")),
    };
    let error = &document.trace.error;
    let [fitted, held] = [&error.identification, &error.validation];
    format!(
        "{with} the heading error is {:.0} % of a first-order response’s, {:.0} % on {}",
        100.0 * heading_error_ratio(fitted.iter()),
        100.0 * heading_error_ratio(held.iter()),
        counted(held.len() as u64, "held-out record"),
    )
}

/// Index of the held-out record whose error ratio is nearest to the pooled one of the title; `None` without such a
/// record.
fn nearest(held: &[RecordReplayErrors]) -> Option<usize> {
    let off = |number: &usize| {
        (heading_error_ratio(held[*number..=*number].iter()) / heading_error_ratio(held.iter())).ln().abs()
    };
    (0..held.len()).min_by(|a, b| off(a).total_cmp(&off(b)))
}

/// Heading and residual of a record, headed by its role and name.
fn column(record: &TracedRecord, errors: &RecordReplayErrors, letters: [char; 2], role: &str) -> PanelGroup {
    let name = record.trial.title();
    let trial = &record.trial;
    let [mut upper, lower] =
        heading_and_residual(angle_curve_deg(trial.time(), trial.heading()), models_over_time(record, None));
    for layer in &mut upper {
        // As in the residuals below.
        if let LayerKind::Line(pen) = &mut layer.kind {
            pen.dash = SOLID;
        }
    }
    for name in upper.iter_mut().filter_map(|layer| layer.name.as_mut()) {
        let labels = [(CurveOrigin::Before, "first-order response"), (CurveOrigin::After, "with these effects")];
        let label = labels.iter().find(|(origin, _)| origin.label() == name);
        if let Some((_, labels)) = label {
            *name = (*labels).to_owned();
        }
    }
    let [before, after] = [&errors.before, &errors.after].map(|error| significant(error.heading_rmse_deg, 2));
    let share = 100.0 * heading_error_ratio([errors].into_iter());
    let heads = [
        format!("({}) {name}, {role}", letters[0]),
        format!("({}) rms {before}° → {after}°, {share:.0} %", letters[1]),
    ];
    let heights = [0.21, 0.15];
    let rulers = [AxisSpec::heading(), AxisSpec::new("residual [°]", TickRule::Angle)];
    let rows = [PanelRow::new, PanelRow::zeroed].into_iter().zip(rulers).zip(heights);
    let rows = rows.map(|((row, ruler), height)| row(ruler, height));
    let panels = [upper, lower].into_iter().zip(heads);
    let panels = panels
        .map(|(layers, head): (Vec<Layer>, String)| LayeredPanel {
            head: Some(head),
            layers,
            ..LayeredPanel::default()
        })
        .collect();
    PanelGroup { is_half: true, x: vec![AxisSpec::time()], rows: rows.collect(), panels, ..PanelGroup::default() }
}

/// Heading errors before and after of all held-out records with their names, the worst first, headed by their root mean
/// squares.
fn all_held(document: &TraceDocument) -> PanelGroup {
    let held = &document.trace.error.validation;
    let held_out = document.records.iter().filter(|record| record.held_out);
    let mut order: Vec<(&RecordEntry, &RecordReplayErrors)> = held_out.zip(held).collect();
    order.sort_by(|(_, a), (_, b)| b.before.heading_rmse_deg.total_cmp(&a.before.heading_rmse_deg));
    let layer = |origin: CurveOrigin, error: fn(&RecordReplayErrors) -> f64| {
        let points = order.iter().zip(0..).map(|((_, errors), place)| (f64::from(place), error(errors), None));
        Layer::marks("", origin.style(), points.collect())
    };
    let layers = vec![
        layer(CurveOrigin::Before, |errors| errors.before.heading_rmse_deg),
        layer(CurveOrigin::After, |errors| errors.after.heading_rmse_deg),
    ];
    let [before, after] = heading_rms_deg(held.iter()).map(|error| significant(error, 3));
    let head = format!(
        "(e) all {} held-out records, first-order response (squares) and with these effects (circles): rms {before}° → \
         {after}°, {:.0} %",
        held.len(),
        100.0 * heading_error_ratio(held.iter())
    );
    let row = PanelRow::new(AxisSpec::decimal("rms error [°]"), 0.13);
    let panel = LayeredPanel { head: Some(head), layers, ..LayeredPanel::default() };
    let names = order.iter().map(|(record, _)| names::record_name(&record.name)).collect();
    PanelGroup {
        x: vec![AxisSpec { title: "held-out record".into(), ..AxisSpec::of_names(names) }],
        rows: vec![row],
        panels: vec![panel],
        ..PanelGroup::default()
    }
}

/// Remark on the ship, if its name is given, and on the recorded channels that the models replay: the rudder, and the
/// channels that the named effects use.
fn inputs_remark(document: &TraceDocument) -> String {
    const CHANNELS: [(RegressorChannel, &str); 4] = [
        (RegressorChannel::Speed, "speed"),
        (RegressorChannel::Sway, "sway"),
        (RegressorChannel::Wind, "wind"),
        (RegressorChannel::Propeller, "propeller rate"),
    ];
    let named = document.trace.effects.iter();
    let named: Vec<_> = named.filter_map(|effect| ship::effects::effect_form(&effect.id, &effect.form)).collect();
    let is_used = |channel: RegressorChannel| named.iter().any(|effect| effect.uses(channel));
    let channels = CHANNELS.iter().filter(|(channel, _)| is_used(*channel)).map(|(_, name)| *name);
    let inputs: Vec<&str> = std::iter::once("rudder").chain(channels).collect();
    let ship_name = document.records.iter().find_map(|record| record.trial_particulars.ship_name.as_ref());
    let ship = ship_name.map_or_else(String::new, |name| format!("{name}. "));
    format!("{ship}Inputs of the models on every record: its recorded {}.", inputs.join(", "))
}

/// Key figure of a trace; `None` if no record was held out.
pub fn trace_key_figure(document: &TraceDocument, curves: &TraceCurves) -> Option<PageFigure> {
    let error = &document.trace.error;
    let number = nearest(&error.validation)?;
    let all = || document.records.iter().zip(&curves.records);
    let (_, fitted) = all().find(|(entry, _)| !entry.held_out)?;
    let (_, held) = all().filter(|(entry, _)| entry.held_out).nth(number)?;
    let role = match error.validation.len() {
        1 => String::from("held out"),
        count => format!("held out, ratio nearest to that of all {count}"),
    };
    let mut groups = vec![
        column(fitted, error.identification.first()?, ['a', 'b'], "fitted"),
        column(held, &error.validation[number], ['c', 'd'], &role),
    ];
    groups.extend((error.validation.len() > 1).then(|| all_held(document)));
    let caption = "(a), (b): a fitted record. (c), (d): the held-out record whose ratio of errors is nearest to the ratio of all \
                   held-out records; only its initial state was fitted. (a), (c): the heading, the best first-order response, and \
                   the model with the effects that were found, with its 95 % band. (b), (d): the residuals of both models. (e): \
                   the heading errors of both on every held-out record, the worst first.";
    let panels = Panels { groups, note: Some(inputs_remark(document)), ..Panels::default() };
    Some(PageFigure::new("hero", finding(document), caption, panels))
}
