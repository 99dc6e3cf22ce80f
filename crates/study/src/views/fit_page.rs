//! The page of `study fit`: what was read, the answers, what was measured, and the figures.

use report::markdown::text;
use report::{Table, markdown};

/// What the page is made of.
pub struct FitPage<'a> {
    /// What was read.
    pub headline: &'a str,
    /// One row per method.
    pub methods: &'a Table,
    /// Names of records, reasons of failures, characteristics; as on the screen.
    pub notes: &'a str,
    /// The same without dimension, and what of it scales; Markdown.
    pub scales: &'a str,
    /// What a reader has to know.
    pub warnings: &'a [String],
    /// Stems and captions of what was drawn.
    pub figures: &'a [(String, String)],
}

/// `report.md`.
pub fn page(fit: &FitPage) -> String {
    let mut page = String::from("# Identification\n\n");
    for line in fit.headline.lines() {
        page += &format!("{}\n\n", text(line));
    }
    page += &format!("## Methods\n\n{}\n", fit.methods.to_markdown());
    page += "The model is T dr/dt + r = K (δ + δ_r) with the yaw rate r and the rudder δ. *95 %* is the interval that a method \
             quotes beside its estimate, a dash where it quotes none. *rms ψ* is the root mean square of measured minus \
             replayed heading; on records that were kept for validation only the initial state is fitted.\n\n";
    if !fit.notes.trim().is_empty() {
        page += "## Records\n\n";
        for line in fit.notes.lines().filter(|line| !line.trim().is_empty()) {
            let place = if line.starts_with("  ") { "  - " } else { "- " };
            page += &format!("{place}{}\n", text(line.trim()));
        }
        page += "\n";
    }
    if !fit.scales.is_empty() {
        page += &format!("## Without dimension\n{}\n", fit.scales);
    }
    if !fit.warnings.is_empty() {
        page += "## Warnings\n\n";
        fit.warnings.iter().for_each(|warning| page += &format!("- {}\n", text(warning)));
        page += "\n";
    }
    page += "## Figures\n\n";
    for (stem, caption) in fit.figures {
        let caption = text(caption);
        page += &format!("![{caption}]({stem}.png)\n\n*{caption}*\n\n");
    }
    page += "`fit.json` has all of it with all digits: the records with their SHA-256 and their characteristics, every method \
             with its estimates, intervals, warnings and diagnostics, and what is known of the ship for `study predict`.\n";
    markdown::prose(&page)
}

#[cfg(test)]
mod tests {
    use report::Column;

    use super::*;

    #[test]
    fn names_of_records_are_words_and_what_is_empty_is_left_out() {
        let table = Table::new(vec![Column::left("method")]);
        let figures = [("fit".to_owned(), "a*b*: the record".to_owned())];
        let fit = FitPage {
            headline: "<b>: 3 rows",
            methods: &table,
            notes: "",
            scales: "",
            warnings: &[],
            figures: &figures,
        };
        let page = page(&fit);
        assert!(page.contains("\n\\<b>: 3 rows\n") && !page.contains("## Records") && !page.contains("## Warnings"));
        assert!(page.contains("![a\\*b\\*: the record](fit.png)"), "{page}");
    }
}
