//! Named columns of numbers as CSV: the curves of figures, from which they can be plotted again.

use std::collections::BTreeMap;

/// Columns of numbers, each with a name that includes the unit. Cells below the end of a short column are empty.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CsvColumns(Vec<(String, Vec<f64>)>);

/// Number with up to seven significant digits, without trailing zeros; empty if it is not finite.
fn digits(value: f64) -> String {
    let shown = format!("{value:.6e}").parse::<f64>().ok().filter(|value| value.is_finite());
    shown.map_or_else(String::new, |value| value.to_string())
}

impl CsvColumns {
    /// Adds a column on the right, of any length.
    pub fn push(&mut self, name: impl Into<String>, values: Vec<f64>) {
        self.0.push((name.into(), values));
    }

    /// CSV text of the table. The first column has all digits, the others seven significant ones.
    pub fn to_csv(&self) -> String {
        let names: Vec<&str> = self.0.iter().map(|(name, _)| name.as_str()).collect();
        let rows = self.0.iter().map(|(_, values)| values.len()).max().unwrap_or(0);
        let cell = |place: usize, row: usize| match self.0[place].1.get(row) {
            Some(value) if place == 0 => value.to_string(),
            value => digits(value.copied().unwrap_or(f64::NAN)),
        };
        let line = |row: usize| (0..self.0.len()).map(|place| cell(place, row)).collect::<Vec<_>>().join(",");
        [names.join(",")].into_iter().chain((0..rows).map(line)).map(|line| line + "\n").collect()
    }

    /// Columns of a table by name; an empty cell is NaN. `None` if the text is empty, a cell is not a number, or a row
    /// is short.
    pub fn from_csv(text: &str) -> Option<BTreeMap<String, Vec<f64>>> {
        let mut lines = text.lines();
        let names: Vec<&str> = lines.next()?.split(',').collect();
        let mut columns = vec![Vec::new(); names.len()];
        for line in lines {
            let mut cells = line.split(',');
            for column in &mut columns {
                let cell = cells.next()?;
                column.push(if cell.is_empty() { f64::NAN } else { cell.parse().ok()? });
            }
        }
        Some(names.into_iter().map(String::from).zip(columns).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let mut columns = CsvColumns::default();
        columns.push("t_s", vec![0.0, 0.1 + 0.2]);
        columns.push("heading_deg", vec![f64::NAN, -1.0 / 3.0]);
        let text = columns.to_csv();
        assert_eq!(text, "t_s,heading_deg\n0,\n0.30000000000000004,-0.3333333\n");
        let read = CsvColumns::from_csv(&text).expect("it was written so");
        assert_eq!(read["t_s"], [0.0, 0.1 + 0.2]);
        assert!(read["heading_deg"][0].is_nan() && read["heading_deg"][1] == -0.333_333_3);
        assert_eq!(CsvColumns::from_csv("a,b\n1\n"), None);
        assert_eq!(CsvColumns::from_csv("a,b\n1,x\n"), None);
    }
}
