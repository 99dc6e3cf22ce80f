//! Table for other programs: CSV, after RFC 4180, and the values of a JSON document. Both have the same columns: an
//! interval is two columns.

use std::borrow::Cow;

use serde_json::{Map, Value};

use super::content::Table;
use super::width::Alignment;
use crate::printable::escaped;

impl Table {
    /// CSV text (RFC 4180, but with plain line breaks): headings with units in the first line, missing cells empty, and
    /// ASCII minus signs, so that numbers can be read back. An interval is two columns, `K lower 95` and `K upper 95`.
    /// A text that a spreadsheet would read as a formula has an apostrophe before it. The title is not part of it.
    pub fn to_csv(&self) -> String {
        let line = |cells: Vec<String>| cells.join(",") + "\n";
        let heads = line(self.heads().iter().map(|head| quote(head)).collect());
        let of = |row| line(self.flat(row).map(|cell| cell.map_or_else(String::new, |cell| quote(&cell))).collect());
        heads + &self.rows.iter().map(|row| of(row)).collect::<String>()
    }

    /// Rows as JSON: one object each, keyed by the headings of the CSV; numbers as numbers, missing cells as null.
    pub fn to_records(&self) -> Vec<Value> {
        let heads = self.heads();
        let is_number = self.columns.iter().flat_map(|column| {
            let is_number = column.is_interval || column.alignment != Alignment::Left;
            std::iter::repeat_n(is_number, if column.is_interval { 2 } else { 1 })
        });
        let is_number: Vec<bool> = is_number.collect();
        let value = |cell: Cow<str>, is_number: bool| match cell.parse::<f64>() {
            Ok(number) if is_number && number.is_finite() => match cell.parse::<i64>() {
                Ok(whole) => whole.into(),
                Err(_) => number.into(),
            },
            _ => Value::String(cell.into_owned()),
        };
        let record = |row| -> Value {
            let cells =
                self.flat(row).zip(&is_number).map(|(cell, is)| cell.map_or(Value::Null, |cell| value(cell, *is)));
            heads.iter().cloned().zip(cells).collect::<Map<String, Value>>().into()
        };
        self.rows.iter().map(|row| record(row)).collect()
    }

    /// Rows as a JSON document.
    pub fn to_json(&self) -> String {
        Value::from(self.to_records()).to_string()
    }

    /// Headings with units, two for an interval.
    fn heads(&self) -> Vec<String> {
        let mut heads = Vec::with_capacity(self.columns.len());
        let mut of = "";
        for column in &self.columns {
            if column.is_interval {
                heads.extend(["lower", "upper"].map(|end| column.named(&format!("{of} {end} 95"))));
            } else {
                heads.push(column.named(&column.heading));
            }
            of = if column.is_interval { of } else { &column.heading };
        }
        heads
    }

    /// Cells of a row with numbers in the form for programs, two for an interval.
    fn flat<'a>(&'a self, row: &'a [Option<String>]) -> impl Iterator<Item = Option<Cow<'a, str>>> {
        self.cells(row).zip(&self.columns).flat_map(|(cell, column)| {
            let ends = cell.filter(|_| column.is_interval).and_then(|cell| {
                let (low, high) = cell.strip_prefix('[')?.strip_suffix(']')?.split_once(", ")?;
                Some([low, high])
            });
            let cells = match (column.is_interval, ends) {
                (false, _) => [cell, None],
                (true, None) => [None, None],
                (true, Some(ends)) => ends.map(Some),
            };
            cells.into_iter().take(if column.is_interval { 2 } else { 1 }).map(|cell| cell.map(readable))
        })
    }
}

/// Cell with minus signs and powers of ten as other programs read them: `-1.3e-12` for `−1.3×10⁻¹²`.
fn readable(cell: &str) -> Cow<'_, str> {
    let plain = match cell.contains('−') {
        true => Cow::Owned(cell.replace('−', "-")),
        false => Cow::Borrowed(cell),
    };
    let Some((mantissa, exponent)) = plain.split_once("×10") else { return plain };
    let digits: Option<String> = exponent.chars().map(from_superscript).collect();
    match digits.filter(|digits| !digits.is_empty()) {
        Some(digits) => Cow::Owned(format!("{mantissa}e{digits}")),
        None => plain,
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

/// `true` if a text is a number, alone or with its uncertainty.
fn is_number(text: &str) -> bool {
    text.split(' ').all(|word| word == "±" || word.parse::<f64>().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number;
    use crate::table::TableHead;

    #[test]
    fn numbers_can_be_read_back() {
        for value in [-1.331_63e-12, 4.5e23, -0.25, 2.0e-4, 0.0, 1.0e-100] {
            let written = number::significant(value, 6);
            let text = readable(&written);
            assert_eq!(text.parse(), Ok(value), "{text}");
        }
        assert_eq!(quote(&readable("5×10 m, −3")), "\"5×10 m, -3\"");
        assert_eq!(readable("−12.5 ± 0.1"), "-12.5 ± 0.1");
    }

    #[test]
    fn an_interval_is_two_numbers() {
        let mut table = Table::new(TableHead::default().texts(["method"]).numbers(["K"]).unit("1/s").interval95());
        table.push(["one", "0.1", "[−0.2, 4×10⁻¹]"]);
        table.push(["two", number::MISSING, number::MISSING]);
        assert!(table.to_text().contains("[−0.2, 4×10⁻¹]"));
        let csv = "method,K [1/s],K lower 95 [1/s],K upper 95 [1/s]\none,0.1,-0.2,4e-1\ntwo,,,\n";
        assert_eq!(table.to_csv(), csv);
        let [one, two] = &table.to_records()[..] else { panic!("two rows") };
        assert_eq!((&one["method"], &one["K upper 95 [1/s]"]), (&"one".into(), &0.4.into()));
        assert_eq!((&two["K [1/s]"], &two["K lower 95 [1/s]"]), (&Value::Null, &Value::Null));
    }

    #[test]
    fn no_cell_is_a_formula() {
        for text in ["=1+1", "+A1", "-1+cmd|'/C calc'!A0", "@SUM(A1)", "−A1", "=A1×10²"] {
            assert!(quote(&readable(text)).starts_with('\''), "{text}");
        }
        assert_eq!(quote("\t=1+1"), "\\t=1+1");
    }
}
