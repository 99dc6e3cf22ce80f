//! Checks of a scenario as a whole: sizes, titles, draws, marks, highlights.

use std::collections::HashSet;

use crate::scenario::cell::DesignCell;
use crate::scenario::draw::DrawWire;
use crate::scenario::limits;
use crate::scenario::method::Method;
use crate::scenario::name::{self, MAX_NAME_BYTES};
use crate::scenario::problem::{KeyFault, KeyPath, choice_index, text_fault};
use crate::scenario::prose::{Highlight, MarkedValue};
use crate::scenario::sweep::SweepAxis;

/// Maximum number of trials of a study; a larger one is a typing error.
const MAX_TRIALS: u64 = 1_000_000_000;

/// Checks the number of trials and of methods times cells.
pub fn check_study_size(replicates: u64, cells: usize, methods: usize) -> Result<(), KeyFault> {
    let key = KeyPath::from_dotted("replicates");
    if replicates == 0 {
        return Err(KeyFault::value(
            key,
            "`replicates` is 0, so nothing would be run",
            "expected at least 1",
            "give the number of trials in every cell, or leave the key out for one",
        ));
    }
    if cells * methods > limits::MAX_CELLS_TIMES_METHODS {
        return Err(KeyFault::name(
            KeyPath::from_dotted("sweep"),
            format!("the sweeps make {cells} cells, each with {methods} methods"),
            format!("expected at most {} cells times methods", limits::MAX_CELLS_TIMES_METHODS),
            "use fewer points or fewer methods, or split the scenario",
        ));
    }
    if replicates.saturating_mul(cells as u64) > MAX_TRIALS {
        return Err(KeyFault::value(
            key,
            format!("`replicates` is {replicates}, for a design of {cells} cells"),
            format!("expected at most {MAX_TRIALS} trials in all"),
            "use fewer replicates; 200 are enough for a first look",
        ));
    }
    Ok(())
}

/// Checks the length of cell titles, which are parts of file names.
pub fn check_cell_titles(axes: &[SweepAxis]) -> Result<(), KeyFault> {
    let longest = |axis: &SweepAxis| axis.points.iter().map(|point| point.label.chars().count()).max().unwrap_or(0);
    let characters = axes.iter().map(|axis| longest(axis) + ", ".len()).sum::<usize>();
    if characters <= MAX_NAME_BYTES {
        return Ok(());
    }
    Err(KeyFault::name(
        KeyPath::from_dotted("sweep"),
        format!("the labels of a cell have up to {characters} characters together"),
        format!("expected at most {MAX_NAME_BYTES}"),
        "shorten the longest labels, or sweep along fewer axes",
    ))
}

/// Checks that no key is changed by two draws, or by a draw and a sweep.
pub fn check_draws(draws: &[DrawWire], axes: &[SweepAxis]) -> Result<(), KeyFault> {
    limits::check_count("draw", draws.len(), limits::MAX_DRAW_ENTRIES)?;
    for (index, draw) in draws.iter().enumerate() {
        let key = KeyPath::from_dotted(draw.key());
        let place = KeyPath::from_dotted("draw").child(index).child("key");
        let by_draw = draws[..index].iter().any(|other| KeyPath::from_dotted(other.key()).is_related(&key));
        let by_sweep =
            axes.iter().flat_map(|axis| &axis.points).flat_map(|point| &point.set).any(|set| set.key.is_related(&key));
        if by_draw || by_sweep {
            return Err(KeyFault::value(
                place,
                format!("`{key}` is drawn, and {} changes it too", if by_draw { "another draw" } else { "a sweep" }),
                "expected a key that nothing else changes",
                "remove one of them; a sweep can change the numbers of a draw, for instance `draw.0.normal.sd`",
            ));
        }
    }
    Ok(())
}

/// Checks that every title of `output.detail` names a cell.
pub fn check_detail_titles(titles: &[String], cells: &[DesignCell]) -> Result<(), KeyFault> {
    let cell_titles: Vec<String> = cells.iter().map(DesignCell::title).filter(|title| !title.is_empty()).collect();
    let places: HashSet<&str> = cell_titles.iter().map(String::as_str).collect();
    let Some((index, title)) = titles.iter().enumerate().find(|(_, title)| !places.contains(title.as_str())) else {
        return Ok(());
    };
    let key = KeyPath::from_dotted("output.detail").child(index);
    let messages = ["no cell is called", "expected labels of points, joined by commas"];
    let fault = choice_index(title, &cell_titles[..cell_titles.len().min(20)], key, messages);
    fault.map(|_| ()).map_err(|fault| match cell_titles.is_empty() {
        true => KeyFault { advice: "leave the key out: a study without a sweep shows its only cell".into(), ..fault },
        false => fault,
    })
}

/// Checks that every mark has an axis, a finite place and a label.
pub fn check_marked_values(marks: &[MarkedValue], axes: &[SweepAxis]) -> Result<(), KeyFault> {
    let axis_names: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
    for (index, mark) in marks.iter().enumerate() {
        let key = KeyPath::from_dotted("output.marks").child(index);
        let problem = ["no axis is called", "expected the name of a sweep"];
        choice_index(&mark.axis, &axis_names, key.child("axis"), problem)?;
        if !mark.value.is_finite() {
            let advice = "give the place of the mark on the axis";
            return Err(KeyFault::value(key.child("at"), format!("found {}", mark.value), "expected a number", advice));
        }
        name::check_label(&mark.label).map_err(|unfit| text_fault(key.child("label"), &mark.label, unfit))?;
    }
    Ok(())
}

/// Checks that every highlighted name belongs to a method, a point of a sweep or a cell.
pub fn check_highlight(
    Highlight { series, rows, .. }: &Highlight,
    methods: &[Method],
    axes: &[SweepAxis],
    cells: &[DesignCell],
) -> Result<(), KeyFault> {
    let points = axes.iter().flat_map(|axis| &axis.points).map(|point| point.label.clone());
    let labels = methods.iter().map(|method| method.label.clone()).chain(points);
    let names_in_figures: Vec<String> = labels.chain(cells.iter().map(|cell| cell.labels.join(", "))).collect();
    let messages = ["nothing is called", "expected the label of an [[identifier]], of a point of a sweep or of a cell"];
    [("series", series), ("rows", rows)].into_iter().try_for_each(|(part, names)| {
        names.iter().enumerate().try_for_each(|(index, name)| {
            let key = KeyPath::from_dotted("output.highlight").child(part).child(index);
            choice_index(name, &names_in_figures, key, messages).map(|_| ())
        })
    })
}
