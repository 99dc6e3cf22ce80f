//! Tables of predictions.

use document::names;
use predict::correction::CorrectedFigure;
use predict::interval::PredictionInterval;
use predict::{PredictDocument, Prediction};
use report::number::{MISSING, fixed, significant, with_uncertainty};
use report::{Table, TableHead};

/// Interval in brackets.
pub fn bracketed_interval(ends: [f64; 2], decimals: usize) -> String {
    format!("[{}, {}]", fixed(ends[0], decimals), fixed(ends[1], decimals))
}

/// Median and both intervals, with as many decimals as the width requires.
fn cells(interval: &PredictionInterval) -> [String; 3] {
    let decimals = interval.decimals();
    let [half, most] = [interval.ci50, interval.ci90].map(|ends| bracketed_interval(ends, decimals));
    [fixed(interval.median, decimals), half, most]
}

/// Table of every characteristic of every manoeuvre and of every record.
pub fn characteristics_table(document: &PredictDocument) -> Table {
    let head = TableHead::default().texts(["manoeuvre", "figure", "unit"]).numbers(["median"]);
    // Of a replayed record no source is drawn alone.
    let has_sources = !document.manoeuvres.is_empty();
    let head = head.texts(["50 %", "90 %"]).texts(has_sources.then_some("mostly from")).texts(["remark"]);
    let mut table = Table::new(head);
    let mut push = |manoeuvre: &str, name: &str, interval: &PredictionInterval, source: String, remark: String| {
        let ((name, unit), [median, half, most]) = (names::figure_of_merit(name), cells(interval));
        let cells = [manoeuvre.to_owned(), name, unit.to_owned(), median, half, most];
        table.push(cells.into_iter().chain(has_sources.then_some(source)).chain([remark]));
    };
    for Prediction { kind, figures, .. } in &document.manoeuvres {
        for (name, figure) in figures {
            let source = figure.shares.iter().max_by(|a, b| a.1.total_cmp(b.1)).map_or_else(
                || MISSING.to_owned(),
                |(source, share)| format!("{} {} %", source_name(source), fixed(100.0 * share, 0)),
            );
            let in_some = || format!("reached in {} % of the draws", significant(100.0 * figure.share_of_draws, 3));
            let remarks = [
                figure.extrapolated.then(|| String::from("extrapolated")),
                (figure.share_of_draws < 1.0).then(in_some),
            ];
            let remark = remarks.into_iter().flatten().collect::<Vec<_>>().join(", ");
            push(&kind.to_string(), name, &figure.interval, source, remark);
        }
    }
    for replayed in &document.replays {
        for (name, figure) in &replayed.figures {
            let place = if figure.inside90 { "inside" } else { "outside" };
            let beyond = if replayed.extrapolated { ", extrapolated" } else { "" };
            let remark = format!("measured {}, {place}{beyond}", fixed(figure.measured, figure.interval.decimals()));
            push(&names::record_name(&replayed.name), name, &figure.interval, MISSING.to_owned(), remark);
        }
    }
    table
}

/// Source of uncertainty in plain words: "choice of model" for `structure`.
fn source_name(source: &str) -> String {
    source.replace("structure", "choice of model").replace("process-noise", "random yaw moment").replace('-', " ")
}

/// Table of the IMO criteria.
pub fn criterion_table(document: &PredictDocument) -> Table {
    let head = TableHead::default().texts(["criterion", "manoeuvre"]).numbers(["limit"]).texts(["unit"]);
    let head = head.numbers(["median"]).texts(["90 %"]).numbers(["passes"]).unit("%");
    let mut table = Table::new(head.texts(["remark"]));
    for criterion in &document.imo {
        let [median, _, most] = cells(&criterion.interval);
        table.push([
            criterion.criterion.clone(),
            criterion.manoeuvre.clone(),
            fixed(criterion.limit, 1),
            criterion.unit.clone(),
            median,
            most,
            fixed(100.0 * criterion.probability_of_passing, 1),
            if criterion.extrapolated { "extrapolated".to_owned() } else { String::new() },
        ]);
    }
    table
}

/// Table of every characteristic that was corrected to another loading.
pub fn loading_correction_table(document: &PredictDocument) -> Table {
    let head = TableHead::default().texts(["record", "figure", "unit", "T measured"]).numbers(["F/B"]);
    let head = head.texts(["F/B 90 %"]).numbers(["R"]).texts(["R 50 %", "R 90 %", "remark"]);
    let mut table = Table::new(head);
    for correction in &document.corrected {
        for (name, CorrectedFigure { measured, sd, factor, corrected: result, warnings, .. }) in &correction.figures {
            let ([factor, _, of_factor], [median, half, most]) = (cells(factor), cells(result));
            let measured = match sd {
                Some(_) => with_uncertainty(*measured, *sd),
                None => fixed(*measured, result.decimals()),
            };
            let doubts: Vec<&str> = warnings.iter().map(|doubt| doubt.text.as_str()).collect();
            let ((name, unit), remark) = (names::figure_of_merit(name), doubts.join("; "));
            let record = correction.name.clone();
            table.push([record, name, unit.to_owned(), measured, factor, of_factor, median, half, most, remark]);
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_has_the_decimals_of_its_width() {
        let interval = PredictionInterval { median: 6.35, ci50: [6.3, 6.4], ci90: [6.2, 6.5] };
        assert_eq!(bracketed_interval(interval.ci90, interval.decimals()), "[6.20, 6.50]");
    }
}
