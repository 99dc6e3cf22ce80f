//! Tables of results: one table, four renderings (terminal, Markdown, CSV, LaTeX). Cells are text that is already
//! rounded; [`crate::number`] does that. A cell that is missing is shown as "–" and is empty in CSV. Text stands for
//! itself in each of them: nothing in a cell or a heading is markup, a formula or a command.

mod content;
mod csv;
mod latex;
mod markdown;
mod text;
mod width;

pub use content::{Column, Table};
pub use width::Alignment;

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
