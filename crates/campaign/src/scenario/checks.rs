//! What has to hold for a scenario as a whole: sizes, titles, draws.

use std::collections::HashSet;

use crate::scenario::cell::DesignCell;
use crate::scenario::draw::DrawWire;
use crate::scenario::limits;
use crate::scenario::method::Method;
use crate::scenario::name::{self, LONGEST_NAME};
use crate::scenario::problem::{KeyFault, KeyPath, of_text, place_among};
use crate::scenario::sweep::SweepAxis;
use crate::scenario::words::{Highlight, MarkedValue};

/// Largest number of trials; more is a slip of the pen.
const MOST_TRIALS: u64 = 1_000_000_000;

pub fn size(replicates: u64, cells: usize, methods: usize) -> Result<(), KeyFault> {
    let key = KeyPath::dotted("replicates");
    if replicates == 0 {
        return Err(KeyFault::value(
            key,
            "`replicates` is 0, so nothing would be run",
            "expected at least 1",
            "give the number of trials in every cell, or leave the key out for one",
        ));
    }
    if cells * methods > limits::MOST_METHODS_OF_CELLS {
        return Err(KeyFault::name(
            KeyPath::dotted("sweep"),
            format!("the sweeps make {cells} cells, each with {methods} methods"),
            format!("expected at most {} methods of cells in all", limits::MOST_METHODS_OF_CELLS),
            "use fewer points or fewer methods, or make several scenarios of this one",
        ));
    }
    if replicates.saturating_mul(cells as u64) > MOST_TRIALS {
        return Err(KeyFault::value(
            key,
            format!("`replicates` is {replicates}, for a design of size {cells}"),
            format!("expected at most {MOST_TRIALS} trials in all"),
            "use fewer replicates; 200 are enough for a first look",
        ));
    }
    Ok(())
}

/// Files are named after cells, so their labels are not too long together.
pub fn titles(axes: &[SweepAxis]) -> Result<(), KeyFault> {
    let longest = |axis: &SweepAxis| axis.points.iter().map(|point| point.label.chars().count()).max().unwrap_or(0);
    let found = axes.iter().map(|axis| longest(axis) + ", ".len()).sum::<usize>();
    if found <= LONGEST_NAME {
        return Ok(());
    }
    Err(KeyFault::name(
        KeyPath::dotted("sweep"),
        format!("the labels of a cell have up to {found} characters together"),
        format!("expected at most {LONGEST_NAME}"),
        "shorten the longest labels, or sweep along fewer axes",
    ))
}

/// Draws and sweeps change different keys, and no key twice.
pub fn draws(draws: &[DrawWire], axes: &[SweepAxis]) -> Result<(), KeyFault> {
    limits::entries("draw", draws.len(), limits::MOST_DRAWS)?;
    for (index, draw) in draws.iter().enumerate() {
        let own = KeyPath::dotted(draw.key());
        let place = KeyPath::dotted("draw").child(index).child("key");
        let by_draw = draws[..index].iter().any(|other| KeyPath::dotted(other.key()).is_related(&own));
        let by_sweep =
            axes.iter().flat_map(|axis| &axis.points).flat_map(|point| &point.set).any(|set| set.key.is_related(&own));
        if by_draw || by_sweep {
            return Err(KeyFault::value(
                place,
                format!("`{own}` is drawn, and {} changes it too", if by_draw { "another draw" } else { "a sweep" }),
                "expected a key that nothing else changes",
                "remove one of them; a sweep can change the numbers of a draw, for instance `draw.0.normal.sd`",
            ));
        }
    }
    Ok(())
}

/// Every title is that of a cell.
pub fn detail(titles: &[String], cells: &[DesignCell]) -> Result<(), KeyFault> {
    let known: Vec<String> = cells.iter().map(DesignCell::title).filter(|title| !title.is_empty()).collect();
    let places: HashSet<&str> = known.iter().map(String::as_str).collect();
    let Some((index, title)) = titles.iter().enumerate().find(|(_, title)| !places.contains(title.as_str())) else {
        return Ok(());
    };
    let key = KeyPath::dotted("output.detail").child(index);
    let words = ["no cell is called", "expected labels of points, joined by commas"];
    let fault = place_among(title, &known[..known.len().min(20)], key, words);
    fault.map(|_| ()).map_err(|fault| match known.is_empty() {
        true => KeyFault { advice: "leave the key out: a study without a sweep shows its only cell".into(), ..fault },
        false => fault,
    })
}

/// Every mark is on an axis, at a number, and has a name.
pub fn marks(marks: &[MarkedValue], axes: &[SweepAxis]) -> Result<(), KeyFault> {
    let known: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
    for (index, mark) in marks.iter().enumerate() {
        let key = KeyPath::dotted("output.marks").child(index);
        place_among(&mark.axis, &known, key.child("axis"), ["no axis is called", "expected the name of a sweep"])?;
        if !mark.at.is_finite() {
            let advice = "give the place of the mark on the axis";
            return Err(KeyFault::value(key.child("at"), format!("found {}", mark.at), "expected a number", advice));
        }
        name::label(&mark.label).map_err(|unfit| of_text(key.child("label"), &mark.label, unfit))?;
    }
    Ok(())
}

/// Every highlighted name is that of a method, of a point of a sweep or of a cell.
pub fn highlight(
    Highlight { series, rows }: &Highlight,
    methods: &[Method],
    axes: &[SweepAxis],
    cells: &[DesignCell],
) -> Result<(), KeyFault> {
    let points = axes.iter().flat_map(|axis| &axis.points).map(|point| point.label.clone());
    let labels = methods.iter().map(|method| method.label.clone()).chain(points);
    let known: Vec<String> = labels.chain(cells.iter().map(|cell| cell.labels.join(", "))).collect();
    let words = ["nothing is called", "expected the label of an [[identifier]], of a point of a sweep or of a cell"];
    [("series", series), ("rows", rows)].into_iter().try_for_each(|(part, names)| {
        names.iter().enumerate().try_for_each(|(index, name)| {
            let key = KeyPath::dotted("output.highlight").child(part).child(index);
            place_among(name, &known, key, words).map(|_| ())
        })
    })
}
