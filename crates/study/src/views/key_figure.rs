//! The figure that stands for a study: its finding above it, T alone where a figure shows errors of K and of T, the
//! methods it is about in colour; the others are left out of curves, and grey in rows.

use report::figures::{Layer, LayerKind, LayeredPanel, NamedRows, Panels, Plot, RowItem, RowKind, RowPlace, Stack};
use report::palette::{Look, Marker, QUIET, SOLID};
use report::{CurveOrigin, number::counted};

use super::charts::{CUT_NOTE, EXACT_NOTE};
use campaign::statistics::distinct;

/// How a method is drawn that the figure is not about.
const OTHER: Look = Look { colour: QUIET, marker: Marker::Circle, dash: SOLID, hollow: false };

/// A chart as the figure that stands for a study; `about` are the names of the methods it is about, none: all.
pub fn of_chart(mut plot: Plot, about: &[String]) -> Plot {
    match &mut plot {
        Plot::Panels(data) => of_panels(data, about),
        Plot::Rows(data) => of_rows(data, about),
        Plot::Cells(data) => data.panels.retain(|(name, _)| !is_quiet(name.as_ref(), about)),
        Plot::ZigZag(_) => {}
    }
    plot
}

fn is_quiet(name: Option<&String>, about: &[String]) -> bool {
    let is_method = |name: &String| name != CurveOrigin::Bound.label();
    !about.is_empty() && name.is_some_and(|name| is_method(name) && !about.contains(name))
}

/// Whether an axis is of errors or intervals of K.
fn is_of_k(title: &str) -> bool {
    title.contains(" K ")
}

fn of_panels(data: &mut Panels, about: &[String]) {
    let (mut others, mut said) = (Vec::new(), Vec::new());
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
            let left_out = panel.layers.extract_if(.., |layer| is_quiet(layer.name.as_ref(), about));
            others.extend(left_out.filter_map(|layer| layer.name));
        }
        let own = |panel: &LayeredPanel| panel.layers.iter().filter_map(marks).collect::<Vec<_>>();
        let all = distinct(stack.panels.iter().flat_map(own));
        let is_of_intervals = stack.rows.iter().any(|row| row.y.title.contains("interval"));
        let what = if is_of_intervals { "intervals" } else { "answers" };
        for panel in &stack.panels {
            let missing = all.iter().filter(|name| !own(panel).contains(name));
            said.extend(missing.zip(&panel.head).map(|(name, head)| format!("{head}: {name} gives too few {what}.")));
        }
    }
    let mut note = data.note.take().unwrap_or_default();
    let others = distinct(others).len();
    if others > 0 {
        // What is said of arrows and of the exact may hold for what is left out alone.
        note = note.replace(EXACT_NOTE, "");
        let mut layers = data.stacks.iter().flat_map(|stack| &stack.panels).flat_map(|panel| &panel.layers);
        if !layers.any(|layer| marks(layer).is_some() && layer.curve.y.contains(&f64::INFINITY)) {
            note = note.replace(CUT_NOTE, "");
        }
        said.push(format!("Left out: {}.", counted(others as u64, "other method")));
    }
    said.insert(0, note.trim().to_owned());
    data.note = Some(said.join(" ").trim().to_owned()).filter(|note| !note.is_empty());
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

fn of_rows(data: &mut NamedRows, about: &[String]) {
    data.columns.retain(|column| !is_of_k(&column.x.title));
    for column in &mut data.columns {
        let own = column.rows.iter().zip(&data.names).filter(|(_, name)| about.contains(name)).flat_map(|(row, _)| row);
        let densities =
            own.filter_map(|item| if let RowKind::Violin(_, own, _) = &item.kind { Some(own) } else { None });
        column.reached = densities.flat_map(|own| own.iter().map(|(value, _)| *value)).collect();
    }
    for row in data.columns.iter_mut().flat_map(|column| &mut column.rows) {
        // The others share a line.
        row.sort_by_key(|item| is_quiet(item.name.as_ref(), about));
        let value = |item: &RowItem| if let RowKind::Mark(_, value, _) = item.kind { Some(value) } else { None };
        let own: Vec<_> = row.iter().filter(|item| !is_quiet(item.name.as_ref(), about)).map(value).collect();
        row.retain(|item| !is_quiet(item.name.as_ref(), about) || !own.contains(&value(item)));
        let mut place = RowPlace::Below;
        for item in row.iter_mut().filter(|item| is_quiet(item.name.as_ref(), about)) {
            if let RowItem { kind: RowKind::Mark(look, _, interval), .. } = item {
                (*look, *interval) = (OTHER, None);
                (item.name, item.place) = (Some(String::from("other methods")), place);
                place = RowPlace::Beside;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use report::figures::{PanelRow, RowsColumn, Ruler};

    use super::*;

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
        let Plot::Panels(data) = of_chart(Panels::of(stack).into(), &[String::from("output-error")]) else { panic!() };
        let panels = &data.stacks[0].panels;
        let row_of = |panel: &LayeredPanel| panel.layers[0].curve.x[0] as usize;
        assert_eq!(panels.iter().map(row_of).collect::<Vec<_>>(), [1, 1, 3, 3]);
        assert_eq!(panels[1].head.as_deref(), Some("column 1"));
        assert_eq!((panels[0].layers.len(), panels[0].layers[0].name.as_deref()), (1, Some("output-error")));
        assert_eq!(data.note.as_deref(), Some("Left out: 1 other method."));
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
        let Plot::Rows(data) = of_chart(rows.into(), &[String::from("output-error")]) else { panic!() };
        assert_eq!(data.columns.len(), 1);
        let row = &data.columns[0].rows[0];
        assert_eq!(row[0].name.as_deref(), Some("output-error"));
        assert_eq!((row.len(), row[1].place, row[2].place), (3, RowPlace::Below, RowPlace::Beside));
        assert_eq!(row[1].name, row[2].name);
    }
}
