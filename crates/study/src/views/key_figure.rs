//! The figure that stands for a study: its finding above it, T alone where a figure shows errors of K and of T, what it
//! is about in colour and everything else pale.

use campaign::scenario::Highlight;
use report::CurveOrigin;
use report::figures::{
    Layer, LayerKind, LayeredPanel, NamedRows, Panels, Plot, RowItem, RowKind, RowPlace, RowsColumn, Stack,
};
use report::number::{counted, significant};
use report::palette::{Look, Marker, QUIET, SOLID};

use campaign::statistics::distinct;

/// Look of a method that the figure does not highlight.
const OTHER: Look = Look { colour: QUIET, marker: Marker::Circle, dash: SOLID, hollow: false };

/// Share of the range of what a figure is about by which everything else may widen its axes.
const ASIDE: f64 = 0.25;

/// Share of an axis that is left free for the values of rows.
const ROOM: f64 = 0.12;

/// A chart as the figure that stands for a study.
pub fn of_chart(mut plot: Plot, highlight: &Highlight) -> Plot {
    match &mut plot {
        Plot::Panels(data) => of_panels(data, &highlight.series),
        Plot::Rows(data) => of_rows(data, highlight),
        Plot::Cells(data) => data.panels.retain(|(name, _)| !is_quiet(name.as_ref(), &highlight.series)),
        Plot::ZigZag(_) => {}
    }
    plot
}

fn is_quiet(name: Option<&String>, about: &[String]) -> bool {
    let is_method = |name: &String| name != CurveOrigin::Bound.label();
    !about.is_empty() && name.is_some_and(|name| is_method(name) && !about.contains(name))
}

/// A layer that the figure is not about.
fn paled(layer: Layer) -> Layer {
    let mut kind = layer.kind;
    match &mut kind {
        LayerKind::Line(pen) => pen.colour = QUIET,
        LayerKind::Band(_, colour, _) | LayerKind::Dots(colour) | LayerKind::Cloud(colour) => *colour = QUIET,
        LayerKind::Ships(colour, _) | LayerKind::Words(colour, ..) => *colour = QUIET,
        LayerKind::Marks(marks) => {
            (marks.look.colour, marks.intervals) = (QUIET, Vec::new());
            marks.joined.iter_mut().for_each(|pen| pen.colour = QUIET);
        }
        LayerKind::Record => {}
    }
    Layer { name: None, kind, ..layer }.within(ASIDE)
}

/// Whether an axis is of errors or intervals of K.
fn is_of_k(title: &str) -> bool {
    title.contains(" K ")
}

fn of_panels(data: &mut Panels, about: &[String]) {
    let (mut pale_names, mut notes) = (Vec::new(), Vec::new());
    let marks = |layer: &Layer| layer.name.clone().filter(|_| matches!(layer.kind, LayerKind::Marks(_)));
    for stack in &mut data.stacks {
        if stack.across.is_some() {
            // Small multiples are of one method each.
            stack.panels.retain(|panel| !is_quiet(panel.head.as_ref(), about));
            continue;
        }
        data.names_aside = true;
        keep_t(stack);
        for panel in &mut stack.panels {
            let (quiet, mut shown): (Vec<Layer>, Vec<Layer>) =
                panel.layers.drain(..).partition(|layer| is_quiet(layer.name.as_ref(), about));
            pale_names.extend(quiet.iter().filter_map(|layer| layer.name.clone()));
            panel.layers = quiet.into_iter().map(paled).collect();
            panel.layers.append(&mut shown);
        }
        let marked = |panel: &LayeredPanel| panel.layers.iter().filter_map(marks).collect::<Vec<_>>();
        let all = distinct(stack.panels.iter().flat_map(marked));
        let is_of_intervals = stack.rows.iter().any(|row| row.y.title.contains("interval"));
        let kind = if is_of_intervals { "intervals" } else { "answers" };
        for panel in &stack.panels {
            let missing = all.iter().filter(|name| !marked(panel).contains(name));
            notes.extend(missing.zip(&panel.head).map(|(name, head)| format!("{head}: {name} gives too few {kind}.")));
        }
    }
    let pale_names = distinct(pale_names).len();
    if pale_names > 0 {
        notes.push(format!("Pale: {}.", counted(pale_names as u64, "other method")));
    }
    notes.insert(0, data.note.take().unwrap_or_default());
    data.note = Some(notes.join(" ").trim().to_owned()).filter(|note| !note.is_empty());
}

/// Leaves the rows of K out, and hands their heads on.
fn keep_t(stack: &mut Stack) {
    let across = stack.x.len();
    let heads: Vec<Option<String>> = stack.panels.iter_mut().map(|panel| panel.head.take()).collect();
    let is_kept: Vec<bool> = stack.rows.iter().map(|row| !is_of_k(&row.y.title)).collect();
    let mut row = 0..;
    stack.panels.retain(|_| row.next().is_some_and(|panel| is_kept[panel / across]));
    stack.rows.retain(|row| !is_of_k(&row.y.title));
    stack.panels.iter_mut().zip(heads).for_each(|(panel, head)| panel.head = head);
    stack.rows.iter_mut().for_each(|row| row.height = 0.34);
}

fn of_rows(data: &mut NamedRows, Highlight { series: about, rows }: &Highlight) {
    data.columns.retain(|column| !is_of_k(&column.x.title));
    for column in &mut data.columns {
        let shown =
            column.rows.iter().zip(&data.names).filter(|(_, name)| about.contains(name)).flat_map(|(row, _)| row);
        let densities =
            shown.filter_map(|item| if let RowKind::Violin(_, shown, _) = &item.kind { Some(shown) } else { None });
        column.reached = densities.flat_map(|shown| shown.iter().map(|(value, _)| *value)).collect();
    }
    for row in data.columns.iter_mut().flat_map(|column| &mut column.rows) {
        // The others share a line, and have no ranges.
        row.retain(|item| !matches!(item.kind, RowKind::Range(..)) || !is_quiet(item.name.as_ref(), about));
        row.sort_by_key(|item| is_quiet(item.name.as_ref(), about));
        let value = |item: &RowItem| if let RowKind::Mark(_, value, _) = item.kind { Some(value) } else { None };
        let drawn_values: Vec<_> = row.iter().filter(|item| !is_quiet(item.name.as_ref(), about)).map(value).collect();
        row.retain(|item| !is_quiet(item.name.as_ref(), about) || !drawn_values.contains(&value(item)));
        let mut place = RowPlace::Below;
        for item in row.iter_mut().filter(|item| is_quiet(item.name.as_ref(), about)) {
            if let RowItem { kind: RowKind::Mark(look, _, interval), .. } = item {
                (*look, *interval) = (OTHER, None);
                (item.name, item.place) = (Some(String::from("others")), place);
                place = RowPlace::Beside;
            }
        }
    }
    if !rows.is_empty() {
        data.columns.iter_mut().for_each(|column| pale_rows(column, &data.names, rows));
    }
}

/// Pales the rows that a figure is not about, and writes the values of all others beside their marks.
fn pale_rows(column: &mut RowsColumn, names: &[String], about: &[String]) {
    column.room = ROOM;
    for (row, name) in column.rows.iter_mut().zip(names) {
        let is_quiet = !about.contains(name);
        for item in row {
            let RowKind::Mark(look, value, _) = &mut item.kind else { continue };
            if is_quiet || look.colour == QUIET {
                look.colour = QUIET;
            } else {
                item.number = Some(significant(*value, 2));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use report::figures::{PanelRow, Ruler};

    use super::*;

    fn about_output_error() -> Highlight {
        Highlight { series: vec![String::from("output-error")], rows: Vec::new() }
    }

    fn method(id: &str) -> (String, Look) {
        (id.to_owned(), CurveOrigin::Method(id.to_owned()).look())
    }

    #[test]
    fn rows_of_t_stay_with_the_heads_of_their_columns() {
        let panel = |column: usize, row: usize| LayeredPanel {
            head: (row == 0).then(|| format!("column {column}")),
            layers: ["output-error", "srivc"]
                .map(|id| Layer::marks(method(id).0, method(id).1, vec![(row as f64, 1.0, None)]))
                .into(),
        };
        let titles = ["95 % intervals that hold K [%]", "… that hold T [%]", "width of K [%]", "width of T [%]"];
        let stack = Stack {
            x: vec![Ruler::decimal("x"); 2],
            rows: titles.iter().map(|title| PanelRow::new(Ruler::decimal(*title), 0.2)).collect(),
            panels: (0..4).flat_map(|row| [panel(0, row), panel(1, row)]).collect(),
            ..Stack::default()
        };
        let Plot::Panels(data) = of_chart(Panels::of(stack).into(), &about_output_error()) else { panic!() };
        let panels = &data.stacks[0].panels;
        let row_of = |panel: &LayeredPanel| panel.layers[0].curve.x[0] as usize;
        assert_eq!(panels.iter().map(row_of).collect::<Vec<_>>(), [1, 1, 3, 3]);
        assert_eq!(panels[1].head.as_deref(), Some("column 1"));
        // What the figure is not about lies below, without a name.
        let names: Vec<Option<&str>> = panels[0].layers.iter().map(|layer| layer.name.as_deref()).collect();
        assert_eq!(names, [None, Some("output-error")]);
        let LayerKind::Marks(marks) = &panels[0].layers[0].kind else { panic!() };
        assert_eq!((marks.look.colour, panels[0].layers[0].room), (QUIET, Some(ASIDE)));
        assert_eq!(data.note.as_deref(), Some("Pale: 1 other method."));
    }

    #[test]
    fn other_methods_share_a_line_below_those_the_figure_is_about() {
        let item = |id: &str, value: f64| RowItem::below(method(id).0, method(id).1, value, None);
        // What coincides with one of those is not drawn.
        let items = [("srivc", 2.0), ("output-error", 1.0), ("least-squares", 3.0), ("maximum-likelihood", 1.0)];
        let column = |title: &str| RowsColumn {
            x: Ruler::decimal(title),
            rows: vec![items.map(|(id, value)| item(id, value)).into()],
            ..RowsColumn::default()
        };
        let rows =
            NamedRows { columns: vec![column("error of K [%]"), column("error of T [%]")], ..NamedRows::default() };
        let Plot::Rows(data) = of_chart(rows.into(), &about_output_error()) else { panic!() };
        assert_eq!(data.columns.len(), 1);
        let row = &data.columns[0].rows[0];
        assert_eq!(row[0].name.as_deref(), Some("output-error"));
        assert_eq!((row.len(), row[1].place, row[2].place), (3, RowPlace::Below, RowPlace::Beside));
        assert_eq!(row[1].name, row[2].name);
    }

    #[test]
    fn rows_that_a_figure_is_about_have_their_value_beside_them() {
        let (name, look) = method("output-error");
        let row = |value: f64| vec![RowItem::below(name.as_str(), look, value, None)];
        let column = RowsColumn {
            x: Ruler::decimal("error of T [%]"),
            rows: vec![row(1.25), row(2.0)],
            ..RowsColumn::default()
        };
        let rows =
            NamedRows { names: vec!["5/5".into(), "20/20".into()], columns: vec![column], ..NamedRows::default() };
        let highlight = Highlight { rows: vec![String::from("20/20")], ..Highlight::default() };
        let Plot::Rows(data) = of_chart(rows.into(), &highlight) else { panic!() };
        let shown = |row: usize| match &data.columns[0].rows[row][0] {
            RowItem { kind: RowKind::Mark(look, ..), number, .. } => (look.colour == QUIET, number.as_deref()),
            _ => panic!(),
        };
        assert_eq!((shown(0), shown(1)), ((true, None), (false, Some("2.0"))));
    }
}
