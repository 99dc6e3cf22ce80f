//! Table of the minimum sizes at which effects are named: `blind-spots.csv`, also in the report.

use report::number::{fixed, significant};
use report::{Table, TableHead};

use super::tracing_table::has_several_traces;
use campaign::design::Design;
use campaign::summary::{BlindSpot, effect_size_axis};

/// Legend above the table in the report.
pub const LEGEND: &str = "The size of an effect at which the trace names it (itself or its group) in 90 % of the trials, by a \
                           logistic regression on the logarithm of the size, with its 95 % interval by profile likelihood. \
                           A size outside the tested range is given as more or less than its end; *at the largest*: \
                           share named at the largest size.";

/// One row for every effect with sizes, called by its `name`, at every point of the other axes.
pub fn blind_spots_table(spots: &[BlindSpot], design: &Design, name: impl Fn(&str) -> String) -> Table {
    let of_sizes = effect_size_axis(design);
    let other_axes = design.axes.iter().enumerate().filter(|(axis, _)| Some(*axis) != of_sizes);
    let several = has_several_traces(design);
    let head = TableHead::default().texts(["effect"]).texts(other_axes.map(|(_, name)| name));
    let head = head.texts(several.then_some("method")).texts(["unit"]).counts(["smallest", "largest", "trials"]);
    let head = head.counts(["at the largest"]).unit("%").counts(["named in 90 % from", "low", "high"]);
    let mut table = Table::new(head);
    for spot in spots {
        let [smallest, largest] = spot.size_range();
        let within = |size: f64| match size {
            size if size > largest => format!("more than {largest}"),
            size if size < smallest => format!("less than {smallest}"),
            size => significant(size, 3),
        };
        let at_largest = spot.counts.iter().filter(|trial| trial.effect_size == largest);
        let [named, total] =
            at_largest.fold([0, 0], |[named, total], size| [named + size.detections, total + size.trials]);
        let mut cells = vec![name(&spot.effect)];
        cells.extend(spot.conditions.iter().cloned());
        cells.extend(several.then(|| design.methods[spot.method].label.clone()));
        let trials: u64 = spot.counts.iter().map(|trial| trial.trials).sum();
        cells.extend([spot.unit.clone(), smallest.to_string(), largest.to_string(), trials.to_string()]);
        cells.push(fixed(100.0 * named as f64 / total as f64, 0));
        let [low, high] = spot.size.ci95.unwrap_or([0.0, f64::INFINITY]);
        cells.extend([spot.size.value, low, high].map(within));
        table.push(cells);
    }
    table
}
