//! Key figure of a study: its finding above it, T alone if a figure shows errors of K and of T, the highlighted series
//! in colour and all others pale.

use campaign::scenario::Highlight;
use report::figures::{
    CellMap, Layer, LayerKind, LayeredPanel, MapCell, Marks, Outline, PanelGroup, Panels, Pen, Plot,
};
use report::number::{counted, significant};
use report::palette::{RECORD, UNHIGHLIGHTED};
use report::{CurveOrigin, PlotCurve};

use campaign::statistics::{distinct, grouped, wilson_share};

use super::charts::{EXACT_NOTE, MIN_ERROR};
use super::key_rows::{highlight_rows, is_of_k, is_quiet, ratio_text, unit_suffix};
use super::remarks::sd_half_width_percent;

/// Maximum share of the range of the highlighted data by which other data may widen the axes.
const ASIDE: f64 = 0.25;

/// A chart as the key figure of a study with `trials` trials in a cell.
pub fn highlighted_chart(mut plot: Plot, highlight: &Highlight, trials: u64) -> Plot {
    let remark = match &mut plot {
        Plot::Panels(data) => of_panels(data, highlight),
        Plot::Rows(data) => highlight_rows(data, highlight),
        Plot::Cells(data) => {
            of_cells(data, highlight);
            None
        }
        Plot::ZigZag(_) => None,
    };
    let over_bound = highlight.over_bound.then(|| String::from("×: times the Cramér–Rao bound, methods in colour."));
    let at_bound = (has_bound(&plot) && trials > 0).then(|| {
        format!("95 % interval of an error at the bound: ±{} %.", significant(sd_half_width_percent(trials), 2))
    });
    if let Some(note) = plot.note_mut() {
        let remarks: Vec<String> = over_bound.into_iter().chain(at_bound).chain(note.take()).chain(remark).collect();
        *note = Some(remarks.join(" ")).filter(|note| !note.is_empty());
    }
    plot
}

/// `true` if a chart of errors has a Cramér–Rao bound.
fn has_bound(plot: &Plot) -> bool {
    let is_of_errors = plot.axis_titles().iter().any(|title| title.starts_with("rms"));
    is_of_errors && plot.series_names().contains(&CurveOrigin::Bound.label())
}

/// Layers that are not highlighted, in pale colours. Several layers share a single name, at the median of the lines
/// that end with a finite value.
fn paled(quiet: Vec<Layer>, names: &[String]) -> Vec<Layer> {
    let mut layers: Vec<Layer> = quiet.into_iter().map(pale).collect();
    if names.len() < 2 {
        return layers;
    }
    let end =
        |layer: &Layer| layer.curve.pairs().last().filter(|(_, y)| y.is_finite()).map_or(f64::INFINITY, |(_, y)| y);
    layers.sort_by(|a, b| end(a).total_cmp(&end(b)));
    let ended = layers.iter().filter(|layer| end(layer).is_finite()).count();
    let middle = ended.saturating_sub(1) / 2;
    for (number, layer) in layers.iter_mut().enumerate() {
        layer.name = (number == middle).then(|| counted(names.len() as u64, "other method"));
    }
    layers
}

/// A layer in pale colours, which keeps its name; a line has a gap at values beyond the axis.
fn pale(mut layer: Layer) -> Layer {
    match &mut layer.kind {
        LayerKind::Line(_) | LayerKind::Marks(Marks { joining_line: Some(_), .. }) => {
            layer.kind = LayerKind::Line(Pen { opacity: 0.45, ..Pen::new(RECORD).width(0.6) });
            layer.curve.y.iter_mut().filter(|y| y.is_infinite()).for_each(|y| *y = f64::NAN);
        }
        LayerKind::Marks(marks) => (marks.style.colour, marks.intervals) = (UNHIGHLIGHTED, Vec::new()),
        LayerKind::Band(_, colour, _) | LayerKind::Dots(colour) | LayerKind::Cloud(colour) => *colour = UNHIGHLIGHTED,
        LayerKind::Ships(..) | LayerKind::Record | LayerKind::Labels(..) => {}
    }
    layer.widening_at_most(ASIDE)
}

/// Highlights layers of panels; returns remarks on missing methods and on grey lines beyond the axes, `None` without
/// any.
fn of_panels(data: &mut Panels, highlight: &Highlight) -> Option<String> {
    let about = &highlight.method_labels();
    let Highlight { rows, over_bound, .. } = highlight;
    let points: Vec<f64> = rows.iter().filter_map(|label| label.parse().ok()).collect();
    let mut notes = Vec::new();
    let [mut are_exact, mut are_cut, mut are_low, mut are_missing, mut are_hidden] = [false; 5];
    let mut has_grey = false;
    let marks = |layer: &Layer| layer.name.clone().filter(|_| matches!(layer.kind, LayerKind::Marks(_)));
    for group in &mut data.groups {
        if group.multiples_across.is_some() {
            // Small multiples show one method each.
            group.panels.retain(|panel| !is_quiet(panel.head.as_ref(), about));
            continue;
        }
        keep_t(group);
        let is_shown = |layer: &&Layer| !is_quiet(layer.name.as_ref(), about);
        let shown = group.panels.iter().flat_map(|panel| &panel.layers).filter(is_shown);
        are_exact |= shown.flat_map(|layer| &layer.curve.y).any(|y| *y == MIN_ERROR);
        let names = group.panels.iter().flat_map(|panel| &panel.layers).filter_map(|layer| layer.name.clone());
        let quiet_names = distinct(names.filter(|name| is_quiet(Some(name), about)));
        let unit = group.rows.first().map_or_else(String::new, |row| unit_suffix(&row.y.title));
        for panel in &mut group.panels {
            let (quiet, shown): (Vec<Layer>, Vec<Layer>) =
                panel.layers.drain(..).partition(|layer| is_quiet(layer.name.as_ref(), about));
            are_cut |= quiet.iter().any(|layer| layer.curve.y.iter().any(|y| y.is_infinite()));
            has_grey |= !quiet.is_empty();
            are_missing |= quiet.len() < quiet_names.len();
            let lone = quiet.iter().filter(|_| quiet_names.len() == 1);
            let lines: Vec<&Layer> = shown.iter().chain(lone).collect();
            are_hidden |=
                lines.iter().enumerate().any(|(k, line)| lines[..k].iter().any(|other| coincide(line, other)));
            are_low |= quiet.iter().any(|layer| layer.curve.y.contains(&MIN_ERROR));
            panel.layers = paled(quiet, &quiet_names);
            let values = point_values(&shown, &points, &unit);
            panel.result = shown_over_bound(&shown).filter(|_| *over_bound);
            panel.layers.extend(shown.into_iter().chain(values));
        }
        data.names_aside = group.panels.iter().all(has_distinct_names);
        let marked = |panel: &LayeredPanel| panel.layers.iter().filter_map(marks).collect::<Vec<_>>();
        let all = distinct(group.panels.iter().flat_map(marked));
        let is_of_intervals = group.rows.iter().any(|row| row.y.title.contains("interval"));
        let kind = if is_of_intervals { "intervals" } else { "answers" };
        for panel in &group.panels {
            let missing = all.iter().filter(|name| !marked(panel).contains(name));
            notes.extend(missing.zip(&panel.head).map(|(name, head)| format!("{head}: {name} gives too few {kind}.")));
        }
    }
    data.note.take_if(|note| note == EXACT_NOTE && !are_exact);
    notes.extend(are_cut.then(|| String::from("Grey lines end where an error exceeds 100 %.")));
    notes.extend(are_low.then(|| String::from("Grey lines leave at the bottom where they are exact.")));
    notes.extend(are_hidden.then(|| String::from("Lines that cannot be seen lie under others.")));
    notes.extend(are_missing.then(|| String::from("Methods without an answer have no line.")));
    data.clipping_note = has_grey.then(|| String::from("Some grey lines lie beyond the axes."));
    (!notes.is_empty()).then(|| notes.join(" "))
}

/// Maximum relative difference of values whose marks cannot be told apart.
const INDISTINGUISHABLE: f64 = 0.1;

/// `true` if two layers of marks have indistinguishable values at every abscissa of the first.
fn coincide(layer: &Layer, other: &Layer) -> bool {
    let is_at = |(x, y): (f64, f64)| {
        other.curve.finite_pairs().any(|(at, value)| at == x && (y - value).abs() <= INDISTINGUISHABLE * value.abs())
    };
    let are_marks = [layer, other].iter().all(|layer| matches!(layer.kind, LayerKind::Marks(_)));
    are_marks && layer.curve.finite_pairs().next().is_some() && layer.curve.finite_pairs().all(is_at)
}

/// Range of the values of marks in multiples of the Cramér–Rao bound of their panel; `None` without bound.
fn shown_over_bound(layers: &[Layer]) -> Option<String> {
    let bound = layers.iter().find(|layer| layer.name.as_deref() == Some(CurveOrigin::Bound.label()))?;
    let marks = layers.iter().filter(|layer| matches!(layer.kind, LayerKind::Marks(_)));
    let ratio = |(x, y): (f64, f64)| bound.curve.finite_pairs().find(|(at, _)| *at == x).map(|(_, bound)| y / bound);
    let ratios = || marks.clone().flat_map(|layer| layer.curve.finite_pairs()).filter_map(ratio);
    let [least, most] = [ratios().reduce(f64::min)?, ratios().reduce(f64::max)?].map(ratio_text);
    Some(if least == most { format!("{least}×") } else { format!("{least}–{most}×") })
}

/// `true` if every named layer of a panel has a name and a colour that no other named layer has.
fn has_distinct_names(panel: &LayeredPanel) -> bool {
    let named: Vec<&Layer> = panel.layers.iter().filter(|layer| layer.name.is_some()).collect();
    let colours = named.iter().map(|layer| layer.colour()).map(|colour| (colour.0, colour.1, colour.2));
    distinct(named.iter().map(|layer| &layer.name)).len() == named.len() && distinct(colours).len() == named.len()
}

/// Values of marks at points of the axis, written next to them; of two equal texts only the first.
fn point_values(layers: &[Layer], points: &[f64], unit: &str) -> Vec<Layer> {
    let mut written: Vec<(f64, String)> = Vec::new();
    let mut values = Vec::new();
    for layer in layers.iter().filter(|layer| matches!(layer.kind, LayerKind::Marks(_))) {
        for (x, y) in layer.curve.finite_pairs().filter(|(x, _)| points.contains(x)) {
            let text = (x, format!("{}{unit}", significant(y, 2)));
            if written.contains(&text) {
                continue;
            }
            let labels = LayerKind::Labels(vec![text.1.clone()], layer.colour());
            values.push(Layer::new("", PlotCurve { x: vec![x], y: vec![y] }, labels));
            written.push(text);
        }
    }
    values
}

/// Removes the rows of K and moves their heads to the remaining rows.
fn keep_t(group: &mut PanelGroup) {
    let across = group.x.len();
    let heads: Vec<Option<String>> = group.panels.iter_mut().map(|panel| panel.head.take()).collect();
    let is_kept: Vec<bool> = group.rows.iter().map(|row| !is_of_k(&row.y.title)).collect();
    let mut row = 0..;
    group.panels.retain(|_| row.next().is_some_and(|panel| is_kept[panel / across]));
    group.rows.retain(|row| !is_of_k(&row.y.title));
    group.panels.iter_mut().zip(heads).for_each(|(panel, head)| panel.head = head);
    group.rows.iter_mut().for_each(|row| row.height = 0.34);
}

/// Keeps the highlighted panels and rows, and outlines the highlighted cells. All other rows with the same name up to a
/// colon become one row, their mean.
fn of_cells(data: &mut CellMap, highlight: &Highlight) {
    let (about, rows) = (&highlight.method_labels(), &highlight.rows);
    data.panels.retain(|(name, _)| !is_quiet(name.as_ref(), about));
    let is_empty = |column: &usize| {
        let mut cells = data.panels.iter().flat_map(|(_, panel)| panel).map(|row| &row[*column]);
        cells.all(|cell| cell.value == Some(0.0) && cell.outline.is_none())
    };
    let kept: Vec<usize> = (0..data.columns.len()).filter(|column| !is_empty(column)).collect();
    let keep = |row: &mut Vec<MapCell>| *row = kept.iter().map(|&column| row[column]).collect();
    data.panels.iter_mut().flat_map(|(_, panel)| panel).for_each(keep);
    data.columns = kept.iter().map(|&column| data.columns[column].clone()).collect();
    let is_highlighted =
        |row: usize, column: usize| rows.contains(&format!("{}, {}", data.rows[row], data.columns[column]));
    let mut are_cells = false;
    for (row, cells) in data.panels.iter_mut().flat_map(|(_, panel)| panel.iter_mut().enumerate()) {
        for (_, cell) in cells.iter_mut().enumerate().filter(|(column, _)| is_highlighted(row, *column)) {
            cell.outline = Some(Outline::Finding);
            are_cells = true;
        }
    }
    if rows.is_empty() || are_cells {
        return;
    }
    let kind = |name: &str| name.split_once(": ").map_or(name, |(kind, _)| kind).to_owned();
    let is_about = |name: &String| rows.contains(name) || rows.iter().any(|row| name.ends_with(&format!(": {row}")));
    let mut groups = grouped(0..data.rows.len(), |&row| (kind(&data.rows[row]), is_about(&data.rows[row])));
    groups.sort_by_key(|((_, is_about), _)| *is_about);
    let mut parts: Vec<(String, Vec<usize>)> = Vec::new();
    for ((kind, is_about), members) in groups {
        match is_about {
            true => parts.extend(members.into_iter().map(|row| (data.rows[row].clone(), vec![row]))),
            false => parts.push((format!("{kind} ({})", counted(members.len() as u64, "kind")), members)),
        }
    }
    for (_, panel) in &mut data.panels {
        *panel = parts.iter().map(|(_, members)| mean_row(panel, members)).collect();
    }
    data.rows = parts.into_iter().map(|(name, _)| name).collect();
}

/// Mean of rows of a map, column by column, with the interval of the share of all their trials; a single row is
/// unchanged.
fn mean_row(panel: &[Vec<MapCell>], members: &[usize]) -> Vec<MapCell> {
    let [first, further @ ..] = members else { return Vec::new() };
    let mean = |column: usize| {
        let values = members.iter().filter_map(|&row| panel[row][column].value).collect::<Vec<_>>();
        let value = (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64);
        let counted =
            || members.iter().map(|&row| (panel[row][column].value.unwrap_or(0.0), panel[row][column].trial_count));
        let positive = counted().map(|(share, trials)| 0.01 * share * trials as f64).sum::<f64>().round();
        let interval = wilson_share(positive as u64, counted().map(|(_, trials)| trials).sum());
        let interval = interval.and_then(|share| share.times(100.0).ci95);
        MapCell { value, interval, ..panel[*first][column] }
    };
    if further.is_empty() { panel[*first].clone() } else { (0..panel[*first].len()).map(mean).collect() }
}

#[cfg(test)]
mod tests {
    use report::figures::{AxisSpec, NamedRows, PanelRow, RowItem, RowKind, RowsColumn};
    use report::palette::CurveStyle;

    use super::super::key_rows::tint;
    use super::*;

    fn about_output_error() -> Highlight {
        Highlight { series: vec![String::from("output-error")], ..Highlight::default() }
    }

    fn method(id: &str) -> (String, CurveStyle) {
        (id.to_owned(), CurveOrigin::Method(id.to_owned()).style())
    }

    #[test]
    fn rows_of_t_stay_with_the_heads_of_their_columns() {
        let panel = |column: usize, row: usize| LayeredPanel {
            head: (row == 0).then(|| format!("column {column}")),
            layers: ["output-error", "srivc"]
                .map(|id| Layer::marks(method(id).0, method(id).1, vec![(row as f64, 1.0, None)]))
                .into(),
            ..LayeredPanel::default()
        };
        let titles = ["95 % intervals that contain K [%]", "… that contain T [%]", "width of K [%]", "width of T [%]"];
        let group = PanelGroup {
            x: vec![AxisSpec::decimal("x"); 2],
            rows: titles.iter().map(|title| PanelRow::new(AxisSpec::decimal(*title), 0.2)).collect(),
            panels: (0..4).flat_map(|row| [panel(0, row), panel(1, row)]).collect(),
            ..PanelGroup::default()
        };
        let Plot::Panels(data) = highlighted_chart(Panels::new(group).into(), &about_output_error(), 100) else {
            panic!()
        };
        let panels = &data.groups[0].panels;
        let row_of = |panel: &LayeredPanel| panel.layers[0].curve.x[0] as usize;
        assert_eq!(panels.iter().map(row_of).collect::<Vec<_>>(), [1, 1, 3, 3]);
        assert_eq!(panels[1].head.as_deref(), Some("column 1"));
        // A single layer that is not highlighted is below, in grey.
        let names: Vec<Option<&str>> = panels[0].layers.iter().map(|layer| layer.name.as_deref()).collect();
        assert_eq!(names, [Some("srivc"), Some("output-error")]);
        let LayerKind::Marks(marks) = &panels[0].layers[0].kind else { panic!() };
        assert_eq!((marks.style.colour, panels[0].layers[0].max_axis_widening), (UNHIGHLIGHTED, Some(ASIDE)));
        assert_eq!(data.note.as_deref(), Some("Lines that cannot be seen lie under others."));
    }

    #[test]
    fn other_methods_share_a_line_below_those_the_figure_is_about() {
        let item = |id: &str, value: f64| RowItem::mark_below(method(id).0, method(id).1, value, None);
        let items = [("srivc", 2.0), ("output-error", 1.0), ("least-squares", 3.0), ("maximum-likelihood", 1.0)];
        let column = |title: &str| RowsColumn {
            x: AxisSpec::decimal(title),
            rows: vec![items.map(|(id, value)| item(id, value)).into()],
            ..RowsColumn::default()
        };
        let rows = NamedRows {
            names: vec!["calm".into()],
            columns: vec![column("error of K [%]"), column("error of T [%]")],
            ..NamedRows::default()
        };
        let Plot::Rows(data) = highlighted_chart(rows.into(), &about_output_error(), 100) else { panic!() };
        assert_eq!(data.columns.len(), 1);
        let row = &data.columns[0].rows[0];
        assert_eq!(row[0].name.as_deref(), Some("output-error"));
        assert_eq!((row.len(), row[1].name.as_deref()), (2, Some("3 others, range")));
        assert!(matches!(row[1].kind, RowKind::WideInterval(_, [1.0, 3.0])));
    }

    #[test]
    fn rows_that_a_figure_is_about_have_their_value_beside_them() {
        let (name, style) = method("output-error");
        let row = |value: f64| vec![RowItem::mark_below(name.as_str(), style, value, None)];
        let column = RowsColumn {
            x: AxisSpec::decimal("error of T [%]"),
            rows: vec![row(1.25), row(2.0)],
            ..RowsColumn::default()
        };
        let rows =
            NamedRows { names: vec!["5/5".into(), "20/20".into()], columns: vec![column], ..NamedRows::default() };
        let highlight = Highlight { rows: vec![String::from("20/20")], ..Highlight::default() };
        let Plot::Rows(data) = highlighted_chart(rows.into(), &highlight, 100) else { panic!() };
        let shown = |row: usize| match &data.columns[0].rows[row][0] {
            RowItem { kind: RowKind::Mark(drawn, ..), number, .. } => {
                (drawn.colour == tint(style.colour), number.as_deref())
            }
            _ => panic!(),
        };
        // Highlighted rows are on top.
        assert_eq!((shown(0), shown(1)), ((false, Some("2.0 %")), (true, Some("1.2 %"))));
    }

    #[test]
    fn points_of_curves_have_their_values_once() {
        let layer = |id: &str, y: f64| {
            let pen = Pen::new(method(id).1.colour);
            Layer::marks(id, method(id).1, vec![(2.0, y, None), (5.0, 3.0 * y, None)]).with_line(pen)
        };
        let layers = vec![
            layer("least-squares", f64::INFINITY),
            layer("output-error", 0.125),
            layer("maximum-likelihood", 0.1251),
            layer("srivc", 9.0),
            Layer::line(
                CurveOrigin::Bound.label(),
                PlotCurve::new(vec![2.0, 5.0], vec![0.1, 0.15]),
                Pen::new(UNHIGHLIGHTED),
            ),
        ];
        let group = PanelGroup::over(
            AxisSpec::decimal("executes"),
            vec![(PanelRow::new(AxisSpec::decimal("rms error of T [%]"), 0.2), layers)],
        );
        let highlight = Highlight {
            series: vec!["output-error".into()],
            scored: vec!["maximum-likelihood".into()],
            rows: vec!["2".into()],
            over_bound: true,
        };
        let data = Panels { note: Some(String::from("Marks.")), ..Panels::new(group) };
        let Plot::Panels(data) = highlighted_chart(data.into(), &highlight, 100) else { panic!() };
        let layers = &data.groups[0].panels[0].layers;
        let labels = layers.iter().filter_map(|layer| match &layer.kind {
            LayerKind::Labels(labels, _) => Some((layer.curve.x.clone(), labels.clone())),
            _ => None,
        });
        assert_eq!(
            labels.collect::<Vec<_>>(),
            [(vec![2.0], vec![String::from("0.12 %")]), (vec![2.0], vec![String::from("0.13 %")])]
        );
        // Those that are not highlighted are pale lines with one name.
        let pale = layers.iter().filter(|layer| matches!(layer.kind, LayerKind::Line(pen) if pen.colour == RECORD));
        let pale: Vec<_> =
            pale.map(|layer| (layer.name.as_deref(), layer.curve.y.clone(), layer.max_axis_widening)).collect();
        let [(name, ends, widening), (None, gap, _)] = &pale[..] else { panic!("{pale:?}") };
        assert_eq!((*name, &ends[..], *widening), (Some("2 other methods"), &[9.0, 27.0][..], Some(ASIDE)));
        assert!(gap.iter().all(|y| y.is_nan()));
        // Of 100 trials: 1.96 / √200.
        let note = "×: times the Cramér–Rao bound, methods in colour. 95 % interval of an error at the bound: ±14 %. \
                    Marks. Grey lines end where an error exceeds 100 %. Lines that cannot be seen lie under others.";
        assert_eq!(data.note.as_deref(), Some(note));
        assert_eq!(data.groups[0].panels[0].result.as_deref(), Some("1.25–2.5×"));
    }

    #[test]
    fn rows_of_a_map_that_are_alike_are_one() {
        let row = |value: f64| vec![MapCell { value: Some(value), trial_count: 10, ..MapCell::default() }];
        let map = CellMap {
            axis_titles: Default::default(),
            columns: vec!["right".into()],
            rows: ["known: a", "unknown: b", "known: c", "unknown: tug"].map(String::from).to_vec(),
            shades: report::figures::Shades::Shares,
            panels: vec![(None, vec![row(90.0), row(80.0), row(100.0), row(62.0)])],
            note: None,
        };
        let highlight = Highlight { rows: vec![String::from("tug")], ..Highlight::default() };
        let Plot::Cells(data) = highlighted_chart(map.clone().into(), &highlight, 100) else { panic!() };
        assert_eq!(data.rows, ["known (2 kinds)", "unknown (1 kind)", "unknown: tug"]);
        let values: Vec<_> = data.panels[0].1.iter().map(|row| row[0].value).collect();
        assert_eq!(values, [Some(95.0), Some(80.0), Some(62.0)]);
        // Wilson's interval of 19 of 20.
        let interval = data.panels[0].1[0][0].interval.expect("of 20 trials");
        assert!((interval[0] - 76.4).abs() < 0.1 && (interval[1] - 99.1).abs() < 0.1, "{interval:?}");
        let highlight = Highlight { rows: vec![String::from("known: c, right")], ..Highlight::default() };
        let Plot::Cells(data) = highlighted_chart(map.into(), &highlight, 100) else { panic!() };
        assert_eq!(
            data.panels[0].1.iter().map(|row| row[0].outline).collect::<Vec<_>>(),
            [None, None, Some(Outline::Finding), None]
        );
    }

    #[test]
    fn the_median_of_a_distribution_stands_in_its_row() {
        let violin = |median: f64| {
            let kind = RowKind::Violin(method("srivc").1, vec![(0.0, 1.0)], [-30.0, -25.0, median, -10.0, 5.0]);
            vec![RowItem::new("", kind)]
        };
        let column = RowsColumn { rows: vec![violin(-20.2), violin(1.0)], ..RowsColumn::default() };
        let rows = NamedRows { names: vec!["srivc".into(), "b".into()], columns: vec![column], ..NamedRows::default() };
        let highlight = Highlight { series: vec![String::from("srivc")], ..Highlight::default() };
        let Plot::Rows(data) = highlighted_chart(rows.into(), &highlight, 100) else { panic!() };
        let text = |row: usize| data.columns[0].rows[row][0].number.as_deref();
        assert_eq!((text(0), text(1)), (Some("−20 (−30 to 5.0)"), Some("1.0 (−30 to 5.0)")));
    }
}
