//! The figure that says what a trace found: the first fitted record and one that was held out, each with the models
//! before and after, and what these leave of the heading.

use ::trace::document::BeforeAfter;
use campaign::curves::curve;
use report::PageFigure;
use report::figures::{Division, Layer, LayeredPanel, PanelRow, Panels, Ruler, Stack};
use report::number::significant;

use super::record_figures::heading_and_residual;
use super::trace_figures::{models_over_time, ratio};
use crate::documents::curves::{TraceCurves, TracedRecord};
use crate::documents::trace::TraceDocument;

/// Names in a title at most.
const NAMES: usize = 3;

/// The finding: what is missing, and both ratios.
fn title(document: &TraceDocument) -> String {
    let mut ids: Vec<String> = document.trace.effects.iter().map(|one| one.id.replace('_', " ")).collect();
    ids.dedup();
    let more = ids.len().saturating_sub(NAMES);
    if more > 0 {
        ids.truncate(NAMES);
        ids.push(format!("{more} more"));
    }
    let lacks = match &ids[..] {
        [] => String::from("No effect is named"),
        [one] => format!("The first-order response lacks {one}"),
        [first @ .., last] => format!("The first-order response lacks {} and {last}", first.join(", ")),
    };
    let error = &document.trace.error;
    let records = |count: usize| if count == 1 { "record" } else { "records" };
    let [fitted, held] = [&error.identification, &error.validation];
    format!(
        "{lacks}: heading error × {:.2} on {} fitted {}, × {:.2} on {} held out",
        ratio(fitted.iter()),
        fitted.len(),
        records(fitted.len()),
        ratio(held.iter()),
        held.len(),
    )
}

/// Number of the held-out record whose ratio is the middle one, the worse of two, among those of an errors table.
fn middle(held: &[BeforeAfter]) -> Option<usize> {
    let own = |number: usize| ratio(held[number..=number].iter());
    let mut order: Vec<usize> = (0..held.len()).collect();
    order.sort_by(|&one, &other| own(one).total_cmp(&own(other)));
    order.get(held.len() / 2).copied()
}

/// Heading and residual of a record, under what it is.
fn column(record: &TracedRecord, errors: &BeforeAfter, letters: [char; 2], what: &str) -> Stack {
    let name = record.trial.name();
    let trial = &record.trial;
    let [upper, lower] = heading_and_residual(curve(trial.time(), trial.heading()), models_over_time(record, None));
    let [before, after] = [&errors.before, &errors.after].map(|own| significant(own.heading_rmse_deg, 2));
    let heads = [format!("({}) {name}, {what}", letters[0]), format!("({}) rms {before}° → {after}°", letters[1])];
    let heights = [0.21, 0.15];
    let rulers = [Ruler::heading(), Ruler::new("residual [°]", Division::Angle)];
    let rows = [PanelRow::new, PanelRow::zeroed].into_iter().zip(rulers).zip(heights);
    let rows = rows.map(|((row, ruler), height)| row(ruler, height));
    let panels = [upper, lower].into_iter().zip(heads);
    let panels = panels.map(|(layers, head): (Vec<Layer>, String)| LayeredPanel { head: Some(head), layers }).collect();
    Stack { is_half: true, x: vec![Ruler::time()], rows: rows.collect(), panels, ..Stack::default() }
}

/// The figure; `None` where no record was held out.
pub fn figure(document: &TraceDocument, curves: &TraceCurves) -> Option<PageFigure> {
    let error = &document.trace.error;
    let number = middle(&error.validation)?;
    let all = || document.records.iter().zip(&curves.records);
    let (_, fitted) = all().find(|(entry, _)| !entry.held_out)?;
    let (_, held) = all().filter(|(entry, _)| entry.held_out).nth(number)?;
    let of = match error.validation.len() {
        1 => String::from("held out"),
        count => format!("held out, the middle one of {count}"),
    };
    let stacks = vec![
        column(fitted, error.identification.first()?, ['a', 'b'], "fitted"),
        column(held, &error.validation[number], ['c', 'd'], &of),
    ];
    let caption = "Left: a record that was fitted. Right: one of which nothing but the initial state was fitted, with the middle \
                   one of the ratios of all that were held out. Above the heading, below what the models leave of it. Before: the \
                   best first-order response; after: the same with the effects that were found, and its 95 % band.";
    Some(PageFigure::new("hero", caption, Panels { title: Some(title(document)), stacks, ..Panels::default() }))
}
