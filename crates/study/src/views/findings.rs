//! Findings of figures, one sentence each, from the plotted data.

use report::figures::{CellMap, LayerKind, NamedRows, Outline, Panels, Plot, RowKind, ZigZagPlot};
use report::number::{fixed, significant};

/// A value and its name.
type Named = (String, f64);

/// A number with its unit, which is in brackets after the title of an axis.
fn with_unit(value: f64, unit: &str) -> String {
    let number = significant(value, 2);
    match unit {
        "" => number,
        "°" => format!("{number}°"),
        unit => format!("{number} {unit}"),
    }
}

/// Range of the values of an axis, with the names at both ends.
pub fn range_phrase(axis: &str, values: impl IntoIterator<Item = Named>) -> String {
    let axis = axis.replace(['*', '_'], "");
    let (quantity, unit) =
        axis.split_once(" [").map_or((axis.as_str(), ""), |(quantity, unit)| (quantity, unit.trim_end_matches(']')));
    let mut values: Vec<Named> = values.into_iter().filter(|(_, value)| value.is_finite()).collect();
    values.sort_by(|a, b| a.1.total_cmp(&b.1));
    let value_words = |(name, value): &Named| match name.as_str() {
        "" => with_unit(*value, unit),
        name => format!("{} ({name})", with_unit(*value, unit)),
    };
    match &values[..] {
        [] => format!("{quantity}: no answer"),
        [only] => format!("{quantity}: {}", value_words(only)),
        [least, .., most] => format!("{quantity} from {} to {}", value_words(least), value_words(most)),
    }
}

/// Finding of a figure: the range of its values, of T if the figure has K and T; for a zig-zag its overshoots.
pub fn chart_finding(plot: &Plot) -> String {
    match plot {
        Plot::Panels(data) => of_curves(data),
        Plot::Rows(data) => of_rows(data),
        Plot::Cells(data) => of_map(data),
        Plot::ZigZag(data) => zigzag_finding(data),
    }
}

/// Range at the end of the axis, in the last column of panels.
fn of_curves(data: &Panels) -> String {
    let Some(group) = data.groups.first().filter(|group| !group.rows.is_empty()) else {
        return String::from("No data");
    };
    if group.multiples_across.is_some() {
        return of_clouds(data);
    }
    let (across, row) = (group.x.len().max(1), group.rows.len().min(2) - 1);
    let Some(panel) = group.panels.get((row + 1) * across - 1) else { return String::from("No data") };
    let marks = || panel.layers.iter().filter(|layer| matches!(layer.kind, LayerKind::Marks(_)));
    let end = marks().flat_map(|layer| &layer.curve.x).copied().fold(f64::NEG_INFINITY, f64::max);
    let at_end = marks().filter_map(|layer| {
        let (_, value) = layer.curve.pairs().filter(|(x, _)| *x == end).last()?;
        Some((layer.name.clone().unwrap_or_default(), value))
    });
    let head = panel.head.as_ref().or(group.panels.get(across - 1).and_then(|panel| panel.head.as_ref()));
    let head = head.map_or_else(String::new, |head| format!("{head}, "));
    let x = group.x.last().map_or("", |ruler| ruler.title.as_str());
    format!(
        "At {head}{}, {}",
        range_phrase(x, [(String::new(), end)]).replace(": ", " "),
        range_phrase(&group.rows[row].y.title, at_end)
    )
}

/// Range of the standard deviations of T in clouds of errors.
fn of_clouds(data: &Panels) -> String {
    let group = &data.groups[0];
    let spread = |panel: &report::figures::LayeredPanel| {
        let cloud = panel.layers.iter().find(|layer| matches!(layer.kind, LayerKind::Cloud(_)))?;
        let values: Vec<f64> = cloud.curve.pairs().map(|(_, t)| t).filter(|t| t.is_finite()).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let square = values.iter().map(|t| (t - mean).powi(2)).sum::<f64>() / values.len() as f64;
        Some((panel.head.clone().unwrap_or_default(), square.sqrt()))
    };
    range_phrase("scatter of T [%]", group.panels.iter().filter_map(spread))
}

/// Range of values in the row with the largest ratio of its values; over all rows if none has several values.
fn of_rows(data: &NamedRows) -> String {
    let Some(column) = data.columns.get(data.columns.len().min(2).wrapping_sub(1)) else {
        return String::from("No data");
    };
    let values = |row: usize| -> Vec<Named> {
        let named_value = |item: &report::figures::RowItem| match &item.kind {
            RowKind::Mark(_, value, _) => Some((item.name.clone().unwrap_or_default(), *value)),
            RowKind::Violin(_, _, quantiles) => Some((String::new(), quantiles[2])),
            _ => None,
        };
        column.rows[row].iter().filter_map(named_value).filter(|(_, value)| value.is_finite()).collect()
    };
    let name = |row: usize| data.names.get(row).cloned().unwrap_or_default();
    let rows = 0..column.rows.len();
    if rows.clone().all(|row| values(row).len() < 2) {
        // A row is one method or record.
        return range_phrase(&column.x.title, rows.filter_map(|row| Some((name(row), values(row).first()?.1))));
    }
    let spread = |row: &usize| {
        let values = values(*row);
        let end = |pick: fn(f64, f64) -> f64| values.iter().map(|(_, value)| value.abs()).reduce(pick).unwrap_or(1.0);
        end(f64::max) / end(f64::min).max(f64::MIN_POSITIVE)
    };
    let widest = rows.max_by(|a, b| spread(a).total_cmp(&spread(b))).unwrap_or(0);
    format!("{}: {}", name(widest), range_phrase(&column.x.title, values(widest)))
}

/// Range over the cells of a map; over the correct ones if it shows shares of trials.
fn of_map(data: &CellMap) -> String {
    let mut values = Vec::new();
    for (head, rows) in &data.panels {
        for (cells, row) in rows.iter().zip(&data.rows) {
            for (cell, column) in cells.iter().zip(&data.columns) {
                let place = head.iter().chain([row, column]).cloned().collect::<Vec<String>>().join(", ");
                values.extend(cell.value.map(|value| (place, row, value, cell.outline == Some(Outline::Correct))));
            }
        }
    }
    if let report::figures::Shades::Range(_, title) = &data.shades {
        return range_phrase(title, values.into_iter().map(|(place, _, value, _)| (place, value)));
    }
    let right = values.into_iter().filter(|(.., is_right)| *is_right);
    let of_row = |row: &str| row.split(" (n").next().unwrap_or(row).to_owned();
    range_phrase("right answers [% of the trials]", right.map(|(_, row, value, _)| (of_row(row), value)))
}

/// Finding of a figure of a zig-zag: its overshoots.
pub fn zigzag_finding(data: &ZigZagPlot) -> String {
    let angles: Vec<String> = data.overshoots.iter().map(|swing| format!("{}°", fixed(swing.angle_deg, 1))).collect();
    match &angles[..] {
        [] => String::from("The trial has no overshoot"),
        [only] => format!("The only overshoot is {only}"),
        [first @ .., last] => format!("The overshoots are {} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use report::CurveOrigin;
    use report::figures::{AxisSpec, Layer, PanelGroup, PanelRow};

    use super::*;

    #[test]
    fn the_ends_of_an_axis_are_told_with_their_owners() {
        let named =
            |all: &[(&str, f64)]| all.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect::<Vec<_>>();
        assert_eq!(
            range_phrase("rms error of T [%]", named(&[("a", 3.0), ("b", 1.25), ("c", f64::NAN)])),
            "rms error of T from 1.2 % (b) to 3.0 % (a)"
        );
        assert_eq!(range_phrase("overshoot [°]", named(&[("", 8.0)])), "overshoot: 8.0°");
        assert_eq!(range_phrase("K [1/s]", named(&[])), "K: no answer");
    }

    #[test]
    fn curves_are_told_at_the_end_of_their_axis_and_of_t() {
        let style = CurveOrigin::After.style();
        let layers = |scale: f64| {
            ["a", "b"]
                .map(|name| {
                    Layer::marks(
                        name,
                        style,
                        vec![(0.1, 9.0, None), (1.0, scale * if name == "a" { 2.0 } else { 4.0 }, None)],
                    )
                })
                .into()
        };
        let rows = vec![
            (PanelRow::new(AxisSpec::decimal("rms error of K [%]"), 0.2), layers(1.0)),
            (PanelRow::new(AxisSpec::decimal("rms error of T [%]"), 0.2), layers(10.0)),
        ];
        let data = Panels::new(PanelGroup::over(AxisSpec::decimal("heading noise [°]"), rows));
        assert_eq!(chart_finding(&data.into()), "At heading noise 1.0°, rms error of T from 20 % (a) to 40 % (b)");
    }
}
