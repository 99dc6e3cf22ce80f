//! Rows of a key figure: T alone, the highlighted methods and rows in colour with their values, all others pale.

use campaign::scenario::Highlight;
use campaign::statistics::distinct;
use report::CurveOrigin;
use report::figures::{NamedRows, RowItem, RowKind, RowPlace, RowsColumn};
use report::number::{counted, fixed, significant};
use report::palette::{CurveStyle, RECORD, RGBColor, UNHIGHLIGHTED};

use super::pooled_charts::{ALL_CELLS_ROW, COUNT_PREFIX};

/// Maximum number of rows that all have their values written.
const MAX_NUMBERED_ROWS: usize = 14;

/// Strength of the colour of marks in rows that are not highlighted.
const TINT: f64 = 0.5;

/// `true` if a layer or a row has the name of a method that is not highlighted; `false` if `about`, the highlighted
/// labels, is empty.
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
pub fn unit_suffix(title: &str) -> String {
    let units = [("[%]", " %"), ("[% of value]", " %"), ("[°]", "°")];
    units.iter().find(|(end, _)| title.ends_with(end)).map_or_else(String::new, |(_, unit)| (*unit).to_owned())
}

/// Pale tint of a colour; tints of different colours differ.
pub fn tint(colour: RGBColor) -> RGBColor {
    let pale = |part: u8| u8::MAX - (f64::from(u8::MAX - part) * TINT) as u8;
    RGBColor(pale(colour.0), pale(colour.1), pale(colour.2))
}

/// Ratio of an error to its bound, with hundredths near the bound.
pub fn ratio_text(ratio: f64) -> String {
    if ratio < 2.0 { fixed(ratio, 2) } else { significant(ratio, 2) }
}

/// Highlights rows; returns a remark on the dark rows, `None` if no row is pale.
pub fn highlight_rows(data: &mut NamedRows, highlight: &Highlight) -> Option<String> {
    let about = &highlight.method_labels();
    let Highlight { rows, over_bound, .. } = highlight;
    data.columns.retain(|column| !is_of_k(&column.x.title));
    for column in &mut data.columns {
        for (item, name) in
            column.rows.iter_mut().zip(&data.names).flat_map(|(row, name)| row.iter_mut().map(move |item| (item, name)))
        {
            let RowKind::Violin(style, density, quantiles) = &mut item.kind else { continue };
            if !about.is_empty() && !about.contains(name) {
                style.colour = tint(style.colour);
            }
            if about.contains(name) {
                column.included_values.extend(density.iter().map(|(value, _)| *value));
            }
            // Two digits, at most hundredths.
            let short = |value: f64| if value.abs() < 0.1 { fixed(value, 2) } else { significant(value, 2) };
            let [low, median, high] = [quantiles[0], quantiles[2], quantiles[4]].map(short);
            item.number = Some(format!("{median}{} ({low} to {high})", unit_suffix(&column.x.title)));
        }
    }
    let items = data.columns.iter().flat_map(|column| &column.rows).flatten();
    let quiet_names = distinct(items.filter_map(|item| item.name.clone()).filter(|name| is_quiet(Some(name), about)));
    if data.names_title.is_empty() {
        sort_rows(data, rows);
    }
    for row in data.columns.iter_mut().flat_map(|column| &mut column.rows) {
        let (quiet, shown): (Vec<RowItem>, _) = row.drain(..).partition(|item| is_quiet(item.name.as_ref(), about));
        *row = if about.len() == 1 { shown.into_iter().map(filled).collect() } else { shown };
        row.extend(pale(quiet, &quiet_names));
    }
    if rows.is_empty() {
        return None;
    }
    data.columns.iter_mut().for_each(|column| pale_rows(column, &data.names, rows, *over_bound));
    data.names
        .iter()
        .any(|name| name != ALL_CELLS_ROW && is_pale(name, rows))
        .then(|| String::from("Dark: the rows of the title."))
}

/// The item with a filled mark: hollow marks distinguish series, and a single highlighted series is distinct.
fn filled(mut item: RowItem) -> RowItem {
    if let RowKind::Mark(style, ..) = &mut item.kind {
        style.is_hollow = false;
    }
    item
}

/// `true` for a row that is not highlighted.
fn is_pale(name: &str, about: &[String]) -> bool {
    let label = name.split_once(COUNT_PREFIX).map_or(name, |(label, _)| label);
    !about.iter().any(|row| row == label)
}

/// Moves the highlighted rows up, below the row of all cells.
fn sort_rows(data: &mut NamedRows, about: &[String]) {
    let mut order: Vec<usize> = (0..data.names.len()).collect();
    order.sort_by_key(|&row| data.names[row] != ALL_CELLS_ROW && is_pale(&data.names[row], about));
    data.names = order.iter().map(|&row| data.names[row].clone()).collect();
    for column in &mut data.columns {
        column.rows = order.iter().map(|&row| std::mem::take(&mut column.rows[row])).collect();
    }
}

/// Marks that are not highlighted: those of one or two methods in grey, those of more as a range.
fn pale(quiet: Vec<RowItem>, names: &[String]) -> Vec<RowItem> {
    let below = |item: RowItem| RowItem { place: RowPlace::Below, ..item.clipped_if_far() };
    let marks = quiet.into_iter().filter_map(|item| {
        let RowKind::Mark(style, value, _) = item.kind else { return None };
        let kind = RowKind::Mark(CurveStyle { colour: UNHIGHLIGHTED, ..style }, value, None);
        Some((value, below(RowItem { kind, number: None, ..item })))
    });
    let (values, marks): (Vec<f64>, Vec<RowItem>) = marks.unzip();
    let ends = values.iter().copied().reduce(f64::min).zip(values.iter().copied().reduce(f64::max));
    match ends {
        Some((least, most)) if names.len() > 2 => {
            let name = format!("{}, range", counted(names.len() as u64, "other"));
            vec![below(RowItem::new(name, RowKind::WideInterval(RECORD, [least, most])))]
        }
        _ => marks,
    }
}

/// Pales the rows that are not highlighted, and writes the values of all highlighted methods; of many rows, only in
/// those that are highlighted.
fn pale_rows(column: &mut RowsColumn, names: &[String], about: &[String], over_bound: bool) {
    let unit = unit_suffix(&column.x.title);
    let is_long = names.len() > MAX_NUMBERED_ROWS;
    for (row, name) in column.rows.iter_mut().zip(names) {
        let is_pale = is_pale(name, about);
        let limit = row.iter().find_map(|item| if let RowKind::Limit(limit) = item.kind { Some(limit) } else { None });
        let limit = limit.filter(|_| over_bound);
        for item in row {
            let RowKind::Mark(style, value, _) = &mut item.kind else { continue };
            let is_quiet = style.colour == UNHIGHLIGHTED;
            if !(is_quiet || is_long && is_pale) {
                item.number = Some(match limit {
                    Some(limit) => format!("{}×", ratio_text(*value / limit)),
                    None if unit.is_empty() => fixed(*value, 2),
                    None => format!("{}{unit}", significant(*value, 2)),
                });
            }
            if is_pale {
                // The key shows the styles of the highlighted rows.
                item.name = None;
                style.colour = if is_quiet { style.colour } else { tint(style.colour) };
            }
        }
    }
}
