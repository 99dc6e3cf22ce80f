//! Tables of results: one table, four renderings (terminal, Markdown, CSV, LaTeX). Cells are text that is already
//! rounded; [`crate::number`] does that. A cell that is missing is shown as "–" and is empty in CSV. Text stands for itself
//! in each of them: nothing in a cell or a heading is markup, a formula or a command.

mod csv;
mod latex;
mod markdown;
mod text;
mod width;

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::printable::escaped;

/// Which side the cells of a column are pushed to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Alignment {
    /// Words.
    #[default]
    Left,
    /// Whole numbers.
    Right,
    /// Numbers with decimals: the decimal points of a column stand below each other.
    Decimal,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Column {
    /// What the column holds.
    pub heading: String,
    /// Its unit, without brackets.
    pub unit: Option<String>,
    /// How its cells are aligned.
    pub alignment: Alignment,
}

impl Column {
    /// A column of words.
    pub fn left(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), unit: None, alignment: Alignment::Left }
    }

    /// A column of whole numbers.
    pub fn right(heading: impl Into<String>) -> Self {
        Self { alignment: Alignment::Right, ..Self::left(heading) }
    }

    /// A column of numbers with decimals.
    pub fn decimal(heading: impl Into<String>) -> Self {
        Self { alignment: Alignment::Decimal, ..Self::left(heading) }
    }

    /// The same column with a unit.
    pub fn unit(self, unit: impl Into<String>) -> Self {
        Self { unit: Some(unit.into()), ..self }
    }

    /// Heading and unit, as in `K [1/s]`.
    fn head(&self) -> String {
        self.unit.as_ref().map_or_else(|| self.heading.clone(), |unit| format!("{} [{unit}]", self.heading))
    }
}

/// A table: columns, and rows of cells. `None` is a missing cell; a row shorter than the columns is filled up with
/// missing cells and what is beyond the last column is not shown.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Table {
    /// Title or caption.
    pub title: Option<String>,
    /// The columns from left to right.
    pub columns: Vec<Column>,
    /// The rows from top to bottom.
    pub rows: Vec<Vec<Option<String>>>,
}

impl Table {
    /// An empty table.
    pub fn new(columns: impl Into<Vec<Column>>) -> Self {
        Self { title: None, columns: columns.into(), rows: Vec::new() }
    }

    /// The same table with a title.
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self { title: Some(title.into()), ..self }
    }

    /// Adds a row; [`crate::number::MISSING`] counts as a missing cell.
    pub fn push<C: Into<String>>(&mut self, cells: impl IntoIterator<Item = C>) {
        let cell = |c: C| Some(c.into()).filter(|text: &String| text != crate::number::MISSING);
        self.rows.push(cells.into_iter().map(cell).collect());
    }

    /// For a terminal: columns separated by two spaces, a rule under the headings. Ends with a line break.
    pub fn to_text(&self) -> String {
        text::render(self)
    }

    /// As a Markdown table, padded so that the source can be read too. Ends with a line break.
    pub fn to_markdown(&self) -> String {
        markdown::render(self)
    }

    /// As CSV (RFC 4180, but with plain line breaks): headings with units in the first line, missing cells empty, and
    /// ASCII minus signs, so that numbers can be read back. A text that a spreadsheet would take for a formula stands behind
    /// an apostrophe. The title is not part of it.
    pub fn to_csv(&self) -> String {
        csv::render(self)
    }

    /// As LaTeX for the `booktabs` package, every character escaped or translated to mathematics.
    pub fn to_latex(&self) -> String {
        latex::render(self)
    }

    /// The cells of a row under the columns.
    fn cells<'a>(&'a self, row: &'a [Option<String>]) -> impl Iterator<Item = Option<&'a str>> {
        (0..self.columns.len()).map(|i| row.get(i).and_then(Option::as_deref))
    }

    /// Every cell padded within its column so that decimal points stand below each other; columns of width of their
    /// widest cell or heading. The first line is the headings.
    fn padded(&self) -> Vec<Vec<String>> {
        let mut lines = vec![Vec::new(); self.rows.len() + 1];
        for (i, column) in self.columns.iter().enumerate() {
            let cells: Vec<Cow<str>> = self
                .rows
                .iter()
                .map(|row| escaped(row.get(i).and_then(Option::as_deref).unwrap_or(crate::number::MISSING)))
                .collect();
            let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
            for (line, cell) in lines.iter_mut().zip(width::align(&escaped(&column.head()), &cells, column.alignment)) {
                line.push(cell);
            }
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn sample() -> Table {
        let mut table = Table::new([
            Column::left("method"),
            Column::decimal("K").unit("1/s"),
            Column::decimal("ψ rms").unit("°"),
            Column::right("n"),
        ])
        .titled("Estimates & errors");
        table.push(["output-error", "0.1003 ± 0.0007", "0.10", "271"]);
        table.push(["least_squares", "−0.25", "–", "12"]);
        table.push(["fourier|pub, \"5\"", "12.5", "100.5"]);
        table
    }

    #[test]
    fn terminal() {
        let expected = "\
Estimates & errors

method                     K [1/s]  ψ rms [°]    n
────────────────  ────────────────  ─────────  ───
output-error       0.1003 ± 0.0007       0.10  271
least_squares     −0.25                     –   12
fourier|pub, \"5\"  12.5                 100.5     –
";
        assert_eq!(sample().to_text(), expected);
    }

    #[test]
    fn markdown() {
        let expected = "\
**Estimates & errors**

| method            |          K [1/s] | ψ rms [°] |   n |
| ----------------- | ---------------: | --------: | --: |
| output-error      |  0.1003 ± 0.0007 |      0.10 | 271 |
| least\\_squares    | −0.25            |         – |  12 |
| fourier\\|pub, \"5\" | 12.5             |    100.5  |   – |
";
        assert_eq!(sample().to_markdown(), expected);
    }

    #[test]
    fn comma_separated() {
        let expected = "\
method,K [1/s],ψ rms [°],n
output-error,0.1003 ± 0.0007,0.10,271
least_squares,-0.25,,12
\"fourier|pub, \"\"5\"\"\",12.5,100.5,
";
        assert_eq!(sample().to_csv(), expected);
    }

    #[test]
    fn latex() {
        let expected = r#"\begin{table}
  \centering
  \caption{Estimates \& errors}
  \begin{tabular}{lrrr}
    \toprule
    method & K [1/s] & $\psi$ rms [$^\circ$] & n \\
    \midrule
    output-error & 0.1003 $\pm$ 0.0007 & 0.10 & 271 \\
    least\_squares & $-$0.25 & -- & 12 \\
    fourier$|$pub, "5" & 12.5 & 100.5 & -- \\
    \bottomrule
  \end{tabular}
\end{table}
"#;
        assert_eq!(sample().to_latex(), expected);
        let mut table = Table::new([Column::left("σ² 10⁻³ \\ x_1")]);
        table.push(["r₁₂"]);
        assert!(table.to_latex().contains("$\\sigma$$^{2}$ 10$^{-3}$ \\textbackslash{} x\\_1"));
        assert!(table.to_latex().contains("r$_{12}$"));
    }

    #[test]
    fn text_from_outside_is_only_text() {
        let mut table = Table::new([Column::left("=A1"), Column::left("<b>\u{1b}[31m")]).titled("\u{7}");
        table.push(["=HYPERLINK(\"http://a\")", "\u{1b}]0;x\n"]);
        table.push(["[2.5, 3]", "<script>|`&lt;"]);
        for text in [table.to_text(), table.to_markdown(), table.to_csv(), table.to_latex()] {
            assert!(!text.contains(['\u{1b}', '\u{7}']), "{text:?}");
        }
        assert!(table.to_markdown().contains("\\<script>\\|\\`\\&lt;"), "{}", table.to_markdown());
        let csv =
            "'=A1,<b>\\u{1b}[31m\n\"'=HYPERLINK(\"\"http://a\"\")\",\\u{1b}]0;x\\n\n\"[2.5, 3]\",<script>|`&lt;\n";
        assert_eq!(table.to_csv(), csv);
        // After a line break in LaTeX a bracket would be its length.
        assert!(table.to_latex().contains("    {}[2.5, 3] & "), "{}", table.to_latex());
    }

    #[test]
    fn empty_tables_are_only_headings() {
        assert_eq!(Table::new([Column::left("a"), Column::decimal("b")]).to_text(), "a  b\n─  ─\n");
        assert_eq!(Table::default().to_csv(), "\n");
        assert!(Table::default().to_latex().contains("\\begin{tabular}{}"));
    }
}
