//! A table for the terminal.

use super::{Table, width};
use crate::printable::escaped;

pub(super) fn render(table: &Table) -> String {
    let mut out = String::new();
    if let Some(title) = &table.title {
        out.push_str(&escaped(title));
        out.push_str("\n\n");
    }
    for (i, line) in table.padded().iter().enumerate() {
        out.push_str(line.join("  ").trim_end());
        out.push('\n');
        if i == 0 {
            let rules: Vec<String> = line.iter().map(|cell| "─".repeat(width::columns(cell))).collect();
            out.push_str(&rules.join("  "));
            out.push('\n');
        }
    }
    out
}
