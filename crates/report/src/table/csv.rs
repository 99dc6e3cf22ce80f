//! A table as CSV, after RFC 4180.

use super::content::Table;
use crate::printable::escaped;

impl Table {
    /// As CSV (RFC 4180, but with plain line breaks): headings with units in the first line, missing cells empty, and
    /// ASCII minus signs, so that numbers can be read back. A text that a spreadsheet would take for a formula stands
    /// behind an apostrophe. The title is not part of it.
    pub fn to_csv(&self) -> String {
        render(self)
    }
}

fn render(table: &Table) -> String {
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

/// A cell with minus signs and powers of ten as other programs read them: `-1.3e-12` for `−1.3×10⁻¹²`.
fn readable(cell: &str) -> String {
    let plain = cell.replace('−', "-");
    let Some((mantissa, exponent)) = plain.split_once("×10") else { return quote(&plain) };
    let digits: Option<String> = exponent.chars().map(from_superscript).collect();
    match digits.filter(|digits| !digits.is_empty()) {
        Some(digits) => quote(&format!("{mantissa}e{digits}")),
        None => quote(&plain),
    }
}

fn from_superscript(c: char) -> Option<char> {
    Some(match c {
        '⁻' => '-',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁰' | '⁴'..='⁹' => char::from_u32(c as u32 - '⁰' as u32 + '0' as u32)?,
        _ => return None,
    })
}

fn quote(text: &str) -> String {
    let text = escaped(text);
    // Spreadsheets run such a text as a formula, and some formulas run programs.
    let guard = if text.starts_with(['=', '+', '-', '@']) && !is_number(&text) { "'" } else { "" };
    if text.contains([',', '"']) {
        format!("\"{guard}{}\"", text.replace('"', "\"\""))
    } else {
        format!("{guard}{text}")
    }
}

/// Whether a text is a number, alone or with its uncertainty.
fn is_number(text: &str) -> bool {
    text.split(' ').all(|word| word == "±" || word.parse::<f64>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number;

    #[test]
    fn numbers_can_be_read_back() {
        for value in [-1.331_63e-12, 4.5e23, -0.25, 2.0e-4, 0.0, 1.0e-100] {
            let text = readable(&number::significant(value, 6));
            assert_eq!(text.parse(), Ok(value), "{text}");
        }
        assert_eq!(readable("5×10 m, −3"), "\"5×10 m, -3\"");
        assert_eq!(readable("−12.5 ± 0.1"), "-12.5 ± 0.1");
    }

    #[test]
    fn no_cell_is_a_formula() {
        for text in ["=1+1", "+A1", "-1+cmd|'/C calc'!A0", "@SUM(A1)", "−A1", "=A1×10²"] {
            assert!(readable(text).starts_with('\''), "{text}");
        }
        assert_eq!(readable("\t=1+1"), "\\t=1+1");
    }
}
