//! Tables of predictions.

use predict::interval::Interval;
use predict::prediction::Predicted as Figure;
use report::number::{MISSING, fixed, significant};
use report::{Column, Table};

use super::predict_report::Predicted;

/// Name and unit of a figure whose unit is the end of its name.
pub fn words(name: &str) -> (String, &'static str) {
    let units = [
        ("_deg_s", "deg/s"),
        ("_deg", "deg"),
        ("_lengths", "L"),
        ("_m_s", "m/s"),
        ("_share", "1"),
        ("_m", "m"),
        ("_s", "s"),
    ];
    let found = units.into_iter().find_map(|(end, unit)| Some((name.strip_suffix(end)?, unit)));
    let (stem, unit) = found.unwrap_or((name, ""));
    (stem.replace('_', " "), unit)
}

/// Numbers of an interval with as many decimals as its width asks for.
pub fn digits(interval: &Interval) -> usize {
    let width = interval.ci90[1] - interval.ci90[0];
    let decimals = if width > 0.0 { (1.0 - width.log10().floor()).max(0.0) } else { 2.0 };
    (decimals as usize).min(6)
}

/// An interval in brackets.
pub fn bracket(ends: [f64; 2], decimals: usize) -> String {
    format!("[{}, {}]", fixed(ends[0], decimals), fixed(ends[1], decimals))
}

/// The largest source of doubt with its share.
fn largest(figure: &Figure) -> String {
    let most = figure.shares.iter().max_by(|one, other| one.1.total_cmp(&other.1));
    most.map_or_else(
        || MISSING.to_owned(),
        |(source, share)| format!("{} {} %", source.as_str(), fixed(100.0 * share, 0)),
    )
}

/// Every figure of every manoeuvre.
pub fn figures(predicted: &Predicted) -> Table {
    let mut table = Table::new([
        Column::left("manoeuvre"),
        Column::left("figure"),
        Column::left("unit"),
        Column::decimal("median"),
        Column::left("50 %"),
        Column::left("90 %"),
        Column::left("mostly from"),
        Column::left("remark"),
    ]);
    for prediction in &predicted.manoeuvres {
        for figure in &prediction.figures {
            let (name, unit) = words(figure.name);
            let decimals = digits(&figure.interval);
            let mut remarks = Vec::new();
            if prediction.extrapolated {
                remarks.push(String::from("extrapolated"));
            }
            if figure.defined < 1.0 {
                remarks.push(format!("in {} % of the draws", significant(100.0 * figure.defined, 3)));
            }
            table.push([
                prediction.kind.to_string(),
                name,
                unit.to_owned(),
                fixed(figure.interval.median, decimals),
                bracket(figure.interval.ci50, decimals),
                bracket(figure.interval.ci90, decimals),
                largest(figure),
                remarks.join(", "),
            ]);
        }
    }
    for (trial, replayed) in &predicted.replays {
        for figure in &replayed.figures {
            let (name, unit) = words(figure.name);
            let decimals = digits(&figure.interval);
            let place = if figure.interval.holds90(figure.measured) { "inside" } else { "outside" };
            table.push([
                trial.name().to_owned(),
                name,
                unit.to_owned(),
                fixed(figure.interval.median, decimals),
                bracket(figure.interval.ci50, decimals),
                bracket(figure.interval.ci90, decimals),
                String::new(),
                format!("measured {}, {place}", fixed(figure.measured, decimals)),
            ]);
        }
    }
    table
}

/// The criteria of IMO.
pub fn criteria(predicted: &Predicted) -> Table {
    let mut table = Table::new([
        Column::left("criterion"),
        Column::left("manoeuvre"),
        Column::decimal("limit"),
        Column::left("unit"),
        Column::decimal("median"),
        Column::left("90 %"),
        Column::decimal("passes").unit("%"),
        Column::left("remark"),
    ]);
    for criterion in &predicted.criteria {
        let decimals = digits(&criterion.interval);
        table.push([
            criterion.name.to_owned(),
            criterion.manoeuvre.clone(),
            fixed(criterion.limit, 1),
            criterion.unit.symbol().to_owned(),
            fixed(criterion.interval.median, decimals),
            bracket(criterion.interval.ci90, decimals),
            fixed(100.0 * criterion.probability, 1),
            if criterion.extrapolated { "extrapolated".to_owned() } else { String::new() },
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_is_told_in_words() {
        assert_eq!(words("first_overshoot_deg"), (String::from("first overshoot"), "deg"));
        assert_eq!(words("steady_rate_deg_s"), (String::from("steady rate"), "deg/s"));
        assert_eq!(words("advance_lengths"), (String::from("advance"), "L"));
        assert_eq!(words("time_to_90_s"), (String::from("time to 90"), "s"));
        let interval = Interval { median: 6.35, ci50: [6.3, 6.4], ci90: [6.2, 6.5] };
        assert_eq!(bracket(interval.ci90, digits(&interval)), "[6.20, 6.50]");
    }
}
