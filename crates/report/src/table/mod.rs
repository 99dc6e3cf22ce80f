//! Tables of results: one table, four renderings (terminal, Markdown, CSV, LaTeX). Cells are text that is already
//! rounded by [`crate::number`]. A missing cell is shown as "–" and is empty in CSV. Text is literal in each rendering:
//! no cell or heading is markup, a formula or a command.

mod content;
mod csv;
mod head;
mod latex;
mod latex_text;
mod markdown;
mod text;
mod width;

pub use content::Table;
pub use head::{TableColumn, TableHead};
pub use width::Alignment;

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn sample() -> Table {
        let mut table = Table::new(
            TableHead::default()
                .texts(["method"])
                .numbers(["K"])
                .unit("1/s")
                .numbers(["ψ rms"])
                .unit("°")
                .counts(["n"]),
        )
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
        let expected = r#"% Needs \usepackage{booktabs,siunitx,adjustbox}.
\begin{table}
  \centering
  \caption{Estimates \& errors}\label{tab:sample}
  \par\smallskip\small
  \setlength{\tabcolsep}{4pt}
  \begin{adjustbox}{max width=\linewidth}
  \begin{tabular}{@{}l S[table-format=-2.4(1)] S[table-format=3.2] S[table-format=3]@{}}
    \toprule
    {method} & {$K$ [1/s]} & {$\psi$ rms [$^{\circ}$]} & {n} \\
    \midrule
    output-error & 0.1003(7) & 0.10 & 271 \\
    least\_squares & -0.25 & {--} & 12 \\
    fourier$|$pub, "5" & 12.5 & 100.5 & {--} \\
    \bottomrule
  \end{tabular}
  \end{adjustbox}
\end{table}
"#;
        assert_eq!(sample().labelled("sample").to_latex(), expected);
    }

    #[test]
    fn latex_of_wide_tables_is_scaled_and_of_long_ones_over_pages() {
        let names = (0..12).map(|i| format!("quantity {i}"));
        let mut table = Table::new(TableHead::default().texts(["method"]).numbers(names).unit("1/s"));
        (0..5).for_each(|_| table.push([&["one"][..], &["(1.234 ± 0.012)×10⁻⁵"; 12]].concat()));
        let text = table.to_latex();
        assert!(text.contains("\\begin{adjustbox}{max width=\\linewidth}"), "{text}");
        assert!(text.contains("S[table-format=1.3(2)e-1]") && text.contains(" 1.234(12)e-5 &"), "{text}");
        (0..50).for_each(|_| table.push(["two", "1 ± 0.5", "n/a"]));
        let text = table.to_latex();
        assert!(text.contains("\\endhead") && text.contains("two & 1 $\\pm$ 0.5 & n/a"), "{text}");
    }

    #[test]
    fn text_from_outside_is_only_text() {
        let mut table = Table::new(TableHead::default().texts(["=A1", "<b>\u{1b}[31m"])).titled("\u{7}");
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
        assert_eq!(Table::new(TableHead::default().texts(["a"]).numbers(["b"])).to_text(), "a  b\n─  ─\n");
        assert_eq!(Table::default().to_csv(), "\n");
        assert!(Table::default().to_latex().starts_with('%'));
    }
}
