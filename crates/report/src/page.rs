//! Page of a report: a filled-in Markdown template, and its figures at the places given by the template.
//!
//! A template is Markdown with two additional marks: a paragraph `![stem]` is the figure of that stem, and a headline
//! `##~ Title` begins a part that a browser shows on request.

use crate::figures::Plot;
use crate::markdown::{escaped_text, html_escaped_prose};

/// Figure of a page.
#[derive(Debug, Clone, PartialEq)]
pub struct PageFigure {
    /// Stem of the file names.
    pub stem: String,
    /// Finding of the figure, one sentence with its numbers and without its full stop: the line above it.
    pub finding: String,
    /// Content of the figure and how to read it.
    pub caption: String,
    /// Plot of the figure.
    pub plot: Plot,
}

impl PageFigure {
    /// Figure with its finding and caption.
    pub fn new(
        stem: impl Into<String>,
        finding: impl Into<String>,
        caption: impl Into<String>,
        plot: impl Into<Plot>,
    ) -> Self {
        Self { stem: stem.into(), finding: finding.into(), caption: caption.into(), plot: plot.into() }
    }

    /// Figure with its number, as Markdown.
    fn to_markdown(&self, number: usize) -> String {
        let (finding, caption) = (escaped_text(&self.finding), escaped_text(&self.caption));
        format!("![Figure {number}]({}.png)\n\n*Figure {number}. {finding}. {caption}*", self.stem)
    }
}

/// Figures by their places in a template.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlacedFigures<P>(pub Vec<(P, PageFigure)>);

impl<P: PartialEq> PlacedFigures<P> {
    /// Adds figures at a place.
    pub fn put(&mut self, place: P, figures: impl IntoIterator<Item = PageFigure>)
    where
        P: Copy,
    {
        self.0.extend(figures.into_iter().map(|figure| (place, figure)));
    }

    /// `true` if a place has a figure.
    pub fn has_figure_at(&self, place: P) -> bool {
        self.0.iter().any(|(other, _)| *other == place)
    }

    /// Marks of the figures of a place, for a template; empty without figures.
    pub fn marks_at(&self, place: P) -> String {
        self.0
            .iter()
            .filter(|(other, _)| *other == place)
            .map(|(_, figure)| format!("\n\n![{}]\n\n", figure.stem))
            .collect()
    }
}

/// Page with its figures.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// Paragraphs, headlines, tables and places of figures, without the blank lines between them.
    blocks: Vec<String>,
    /// Figures in reading order.
    figures: Vec<PageFigure>,
    /// Titles of the parts that a browser shows on request.
    folded: Vec<String>,
}

impl Page {
    /// Page from a filled-in template; figures without a place in it are dropped.
    ///
    /// # Panics
    ///
    /// If the template was not filled in, which cannot happen if all its values can be written into a string.
    pub fn new(filled: askama::Result<String>, figures: PlacedFigures<impl Sized>) -> Self {
        let filled = html_escaped_prose(&filled.expect("writing to a string does not fail"));
        let mut folded = Vec::new();
        let mut blocks = Vec::new();
        for block in filled.split("\n\n").map(|block| block.trim_matches('\n')).filter(|block| !block.trim().is_empty())
        {
            let title = block.strip_prefix("##~ ");
            folded.extend(title.map(str::to_owned));
            blocks.push(title.map_or_else(|| block.to_owned(), |title| format!("## {title}")));
        }
        let place = |figure: &PageFigure| blocks.iter().position(|block| stem(block) == Some(figure.stem.as_str()));
        let mut placed: Vec<(usize, PageFigure)> =
            figures.0.into_iter().filter_map(|(_, figure)| Some((place(&figure)?, figure))).collect();
        placed.sort_by_key(|(place, _)| *place);
        Self { figures: placed.into_iter().map(|(_, figure)| figure).collect(), blocks, folded }
    }

    /// Titles of the parts that a browser shows on request.
    pub fn folded_titles(&self) -> Vec<&str> {
        self.folded.iter().map(String::as_str).collect()
    }

    /// Figures in reading order.
    pub fn figures(&self) -> &[PageFigure] {
        &self.figures
    }

    fn figure(&self, block: &str) -> Option<(usize, &PageFigure)> {
        let stem = stem(block)?;
        self.figures.iter().enumerate().find(|(_, figure)| figure.stem == stem)
    }

    /// The page with only texts and tables: without figures, and without headlines that have no other content.
    pub fn without_figures(self) -> Self {
        let mut blocks: Vec<String> = Vec::new();
        for block in self.blocks.iter().rev() {
            let stays = match level(block) {
                Some(level) => blocks.last().is_some_and(|next| self::level(next).is_none_or(|next| next > level)),
                None => self.figure(block).is_none(),
            };
            blocks.extend(stays.then(|| block.clone()));
        }
        blocks.reverse();
        Self { blocks, figures: Vec::new(), ..self }
    }

    /// Markdown text (the GitHub flavour), every figure with its number and caption. HTML in it is shown and not
    /// interpreted.
    pub fn to_markdown(&self) -> String {
        let block = |block: &String| match self.figure(block) {
            Some((place, figure)) => html_escaped_prose(&figure.to_markdown(place + 1)),
            None => block.clone(),
        };
        self.blocks.iter().map(block).collect::<Vec<String>>().join("\n\n") + "\n"
    }
}

/// Level of a headline, 1 for the title of the page; `None` for any other block.
fn level(block: &str) -> Option<usize> {
    let level = block.len() - block.trim_start_matches('#').len();
    (level > 0 && block[level..].starts_with(' ')).then_some(level)
}

/// Stem of the figure whose place a block is; `None` for any other block.
fn stem(block: &str) -> Option<&str> {
    block.strip_prefix("![")?.strip_suffix(']')
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Panels;

    fn figure(stem: &str) -> PageFigure {
        PageFigure::new(stem, "K is 0.1", "a*b", Panels::default())
    }

    #[test]
    fn figures_are_numbered_where_the_template_has_them() {
        let figures = PlacedFigures([("b", figure("fit")), ("c", figure("nowhere")), ("a", figure("last"))].to_vec());
        let [first, next] = ["a", "b"].map(|place| figures.marks_at(place));
        let filled = format!("# Trial\n\n\n\n{first}\n<b>c\n{next}##~ Numbers\n\n- one\n- two\n![none]\n");
        assert!(figures.has_figure_at("c") && !figures.has_figure_at("d"));
        let page = Page::new(Ok(filled), figures);
        let markdown = "# Trial\n\n![Figure 1](last.png)\n\n*Figure 1. K is 0.1. a\\*b*\n\n\\<b>c\n\n![Figure 2](fit.png)\n\n\
                        *Figure 2. K is 0.1. a\\*b*\n\n## Numbers\n\n- one\n- two\n![none]\n";
        assert_eq!(page.to_markdown(), markdown);
        assert_eq!(page.folded_titles(), ["Numbers"]);
        assert_eq!(page.figures().iter().map(|figure| figure.stem.as_str()).collect::<Vec<_>>(), ["last", "fit"]);
    }

    #[test]
    fn without_figures_no_headline_stands_over_nothing() {
        let filled = String::from(
            "# Trial\n\n![fit]\n\n## Seen\n\n### Here\n\n![fit]\n\n## Said\n\n### There\n\nwords\n\n##~ Further\n\n![fit]",
        );
        let page = Page::new(Ok(filled), PlacedFigures([((), figure("fit"))].to_vec())).without_figures();
        assert_eq!(page.to_markdown(), "# Trial\n\n## Said\n\n### There\n\nwords\n");
        assert!(page.figures().is_empty());
    }
}
