//! Table in Markdown (the GitHub flavour).

use super::content::Table;
use super::head::TableColumn;
use super::width::{self, Alignment};
use crate::markdown::escaped_text as escape;

impl Table {
    /// Markdown table, padded so that the source is legible too. Ends with a line break.
    pub fn to_markdown(&self) -> String {
        render(self)
    }
}

fn render(table: &Table) -> String {
    // Escaping comes before padding, so that the columns of the source are aligned too.
    let escaped = Table {
        label: None,
        title: None,
        columns: table
            .columns
            .iter()
            .map(|c| TableColumn { heading: escape(&c.heading), unit: c.unit.as_deref().map(escape), ..c.clone() })
            .collect(),
        rows: table.rows.iter().map(|r| r.iter().map(|c| c.as_deref().map(escape)).collect()).collect(),
    };
    let mut out = table.title.as_ref().map_or_else(String::new, |title| format!("**{}**\n\n", escape(title)));
    for (i, line) in escaped.padded().iter().enumerate() {
        out.push_str(&format!("| {} |\n", line.join(" | ")));
        if i == 0 {
            let rules: Vec<String> = line
                .iter()
                .zip(&table.columns)
                .map(|(cell, column)| {
                    let dashes = "-".repeat(width::columns(cell).max(2) - 1);
                    if column.alignment == Alignment::Left { format!("-{dashes}") } else { format!("{dashes}:") }
                })
                .collect();
            out.push_str(&format!("| {} |\n", rules.join(" | ")));
        }
    }
    out
}
