//! Rows of a key figure: T alone, the highlighted methods and rows in colour with their values, all others pale.

use campaign::scenario::Highlight;
use campaign::statistics::distinct;
use report::CurveOrigin;
use report::figures::{NamedRows, RowItem, RowKind, RowPlace, RowsColumn};
use report::number::significant;
use report::palette::{Look, Marker, QUIET, RGBColor, SOLID};

use super::pooled_charts::ALL;

/// Look of a method that the figure does not highlight.
const OTHER: Look = Look { colour: QUIET, marker: Marker::Circle, dash: SOLID, hollow: false };

/// Strength of the colour of marks in rows that are not highlighted.
const TINT: f64 = 0.5;

/// `true` if a layer or a row with this name is not highlighted.
pub fn is_quiet(name: Option<&String>, about: &[String]) -> bool {
    let is_method = |name: &String| name != CurveOrigin::Bound.label();
    // A line of rules is identified by the common beginning of their labels.
    let is_of = |label: &String, name: &String| label == name || label.starts_with(&format!("{name}, "));
    !about.is_empty() && name.is_some_and(|name| is_method(name) && !about.iter().any(|label| is_of(label, name)))
}

/// `true` if an axis is of errors or intervals of K.
pub fn is_of_k(title: &str) -> bool {
    title.contains(" K ")
}

/// Unit of the values of an axis as it follows a number: per cent or degrees, else none.
pub fn unit(title: &str) -> String {
    let units = [("[%]", " %"), ("[°]", "°")];
    units.iter().find(|(end, _)| title.ends_with(end)).map_or_else(String::new, |(_, unit)| (*unit).to_owned())
}

/// Pale tint of a colour, which still tells it from others.
pub fn tint(colour: RGBColor) -> RGBColor {
    let pale = |part: u8| u8::MAX - (f64::from(u8::MAX - part) * TINT) as u8;
    RGBColor(pale(colour.0), pale(colour.1), pale(colour.2))
}

/// Highlights rows.
pub fn of_rows(data: &mut NamedRows, Highlight { series: about, rows, over_bound }: &Highlight) {
    data.columns.retain(|column| !is_of_k(&column.x.title));
    for column in &mut data.columns {
        for (item, name) in
            column.rows.iter_mut().zip(&data.names).flat_map(|(row, name)| row.iter_mut().map(move |item| (item, name)))
        {
            let RowKind::Violin(_, density, quantiles) = &item.kind else { continue };
            if about.contains(name) {
                column.reached.extend(density.iter().map(|(value, _)| *value));
            }
            let [low, median, high] = [quantiles[0], quantiles[2], quantiles[4]].map(|value| significant(value, 2));
            item.number = Some(format!("{median}{} ({low} to {high})", unit(&column.x.title)));
        }
    }
    let items = data.columns.iter().flat_map(|column| &column.rows).flatten();
    let pale_names = distinct(items.filter_map(|item| item.name.clone()).filter(|name| is_quiet(Some(name), about)));
    let others = if let [other] = &pale_names[..] { other.clone() } else { String::from("others") };
    data.note =
        data.note.take().into_iter().chain(pale_note(&pale_names)).reduce(|note, grey| format!("{note} {grey}"));
    if data.of.is_empty() {
        sort_rows(data, rows);
    }
    for row in data.columns.iter_mut().flat_map(|column| &mut column.rows) {
        // The other rows share a line and have no ranges.
        row.retain(|item| !matches!(item.kind, RowKind::Range(..)) || !is_quiet(item.name.as_ref(), about));
        row.sort_by_key(|item| is_quiet(item.name.as_ref(), about));
        let value = |item: &RowItem| if let RowKind::Mark(_, value, _) = item.kind { Some(value) } else { None };
        let drawn_values: Vec<_> = row.iter().filter(|item| !is_quiet(item.name.as_ref(), about)).map(value).collect();
        row.retain(|item| !is_quiet(item.name.as_ref(), about) || !drawn_values.contains(&value(item)));
        let mut place = RowPlace::Below;
        for item in row.iter_mut().filter(|item| is_quiet(item.name.as_ref(), about)) {
            if let RowItem { kind: RowKind::Mark(look, _, interval), .. } = item {
                (*look, *interval) = (OTHER, None);
                (item.name, item.place, item.number) = (Some(others.clone()), place, None);
                place = RowPlace::Beside;
            }
        }
    }
    if !rows.is_empty() {
        data.columns.iter_mut().for_each(|column| pale_rows(column, &data.names, rows, *over_bound));
    }
}

/// Moves the highlighted rows up, below the row of all.
fn sort_rows(data: &mut NamedRows, about: &[String]) {
    let mut order: Vec<usize> = (0..data.names.len()).collect();
    order.sort_by_key(|&row| data.names[row] != ALL && !about.contains(&data.names[row]));
    data.names = order.iter().map(|&row| data.names[row].clone()).collect();
    for column in &mut data.columns {
        column.rows = order.iter().map(|&row| std::mem::take(&mut column.rows[row])).collect();
    }
}

/// Remark that names what is grey; `None` if nothing is.
pub fn pale_note(names: &[String]) -> Option<String> {
    (!names.is_empty()).then(|| format!("Grey: {}.", names.join(", ")))
}

/// Pales the rows that are not highlighted, and writes the values of all others next to their marks.
fn pale_rows(column: &mut RowsColumn, names: &[String], about: &[String], over_bound: bool) {
    let unit = unit(&column.x.title);
    for (row, name) in column.rows.iter_mut().zip(names) {
        let is_quiet = name != ALL && !about.contains(name);
        let limit = row.iter().find_map(|item| if let RowKind::Limit(limit) = item.kind { Some(limit) } else { None });
        let limit = limit.filter(|_| over_bound);
        for item in row {
            let RowKind::Mark(look, value, _) = &mut item.kind else { continue };
            if is_quiet {
                // The key shows the looks of the highlighted rows.
                look.colour = if look.colour == QUIET { QUIET } else { tint(look.colour) };
                item.name = None;
            } else if look.colour != QUIET {
                let number = significant(*value / limit.unwrap_or(1.0), 2);
                item.number = Some(format!("{number}{}", if limit.is_some() { "×" } else { unit.as_str() }));
            }
        }
    }
}
