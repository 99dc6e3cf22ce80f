//! A table as CSV, after RFC 4180.

use super::Table;

pub(super) fn render(table: &Table) -> String {
    let mut out = String::new();
    let heads: Vec<String> = table.columns.iter().map(|column| quote(&column.head())).collect();
    out.push_str(&heads.join(","));
    out.push('\n');
    for row in &table.rows {
        let cells: Vec<String> = table.cells(row).map(|cell| cell.map_or_else(String::new, readable)).collect();
        out.push_str(&cells.join(","));
        out.push('\n');
    }
    out
}

/// A cell with the minus sign that other programs read as one.
fn readable(cell: &str) -> String {
    quote(&cell.replace('−', "-"))
}

fn quote(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}
