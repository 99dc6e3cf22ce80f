//! Table for the terminal.

use super::content::Table;
use super::width;
use crate::printable::escaped;

impl Table {
    /// Text for a terminal: columns separated by two spaces, a rule under the headings. Ends with a line break.
    pub fn to_text(&self) -> String {
        render(self)
    }
}

fn render(table: &Table) -> String {
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
