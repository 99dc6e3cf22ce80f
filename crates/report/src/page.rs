//! A page: blocks in reading order, from which the terminal, Markdown and (of the Markdown) a browser are written. What
//! a figure shows is part of the page, so a page can be drawn again wherever it was made.

use crate::figures::Plot;
use crate::markdown::{prose, text};
use crate::table::Table;

/// A figure of a page.
#[derive(Debug, Clone, PartialEq)]
pub struct PageFigure {
    /// Stem of its files.
    pub stem: String,
    /// What it shows, one sentence with its numbers and without its full stop: the line above it.
    pub finding: String,
    /// What is drawn and how it is read.
    pub caption: String,
    /// What is drawn.
    pub plot: Plot,
}

impl PageFigure {
    /// A figure.
    pub fn new(
        stem: impl Into<String>,
        finding: impl Into<String>,
        caption: impl Into<String>,
        plot: impl Into<Plot>,
    ) -> Self {
        Self { stem: stem.into(), finding: finding.into(), caption: caption.into(), plot: plot.into() }
    }
}

/// A part of a page.
#[derive(Debug, Clone, PartialEq)]
pub enum PageBlock {
    /// A headline, read as it is, and its level, 1 for the page itself.
    Headline(usize, String),
    /// A headline of a part that a browser shows when it is asked for.
    Folded(String),
    /// A paragraph of Markdown.
    Prose(String),
    /// A list, every entry Markdown.
    List(Vec<String>),
    /// A table.
    Table(Table),
    /// A figure.
    Figure(Box<PageFigure>),
}

impl PageBlock {
    /// Level of a headline.
    fn level(&self) -> Option<usize> {
        match self {
            Self::Headline(level, _) => Some(*level),
            Self::Folded(_) => Some(2),
            _ => None,
        }
    }
}

/// Blocks in reading order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Page {
    /// The blocks.
    pub blocks: Vec<PageBlock>,
}

impl Page {
    /// A page of this title.
    pub fn titled(title: impl Into<String>) -> Self {
        Self { blocks: vec![PageBlock::Headline(1, title.into())] }
    }

    /// Adds a headline of a part.
    pub fn part(&mut self, title: impl Into<String>) {
        self.blocks.push(PageBlock::Headline(2, title.into()));
    }

    /// Adds a headline of a part that a browser shows when it is asked for; elsewhere it is a part as any other.
    pub fn folded_part(&mut self, title: impl Into<String>) {
        self.blocks.push(PageBlock::Folded(title.into()));
    }

    /// Titles of the parts that a browser shows when it is asked for.
    pub fn folded(&self) -> Vec<&str> {
        let titles = self.blocks.iter().filter_map(|block| match block {
            PageBlock::Folded(title) => Some(title.as_str()),
            _ => None,
        });
        titles.collect()
    }

    /// Adds a headline below that of a part.
    pub fn subpart(&mut self, title: impl Into<String>) {
        self.blocks.push(PageBlock::Headline(3, title.into()));
    }

    /// Adds a paragraph of Markdown, unless it is empty.
    pub fn say(&mut self, prose: impl AsRef<str>) {
        let prose = prose.as_ref().trim();
        if !prose.is_empty() {
            self.blocks.push(PageBlock::Prose(prose.to_owned()));
        }
    }

    /// Adds paragraphs of words that are read as they are, one a line.
    pub fn words(&mut self, lines: &str) {
        lines.lines().for_each(|line| self.say(text(line)));
    }

    /// Adds a list of Markdown, unless it is empty.
    pub fn list(&mut self, entries: impl IntoIterator<Item = String>) {
        let entries: Vec<String> = entries.into_iter().collect();
        if !entries.is_empty() {
            self.blocks.push(PageBlock::List(entries));
        }
    }

    /// Adds a table.
    pub fn table(&mut self, table: Table) {
        self.blocks.push(PageBlock::Table(table));
    }

    /// Adds figures.
    pub fn figures(&mut self, figures: impl IntoIterator<Item = PageFigure>) {
        self.blocks.extend(figures.into_iter().map(|figure| PageBlock::Figure(Box::new(figure))));
    }

    /// The figures in reading order.
    pub fn drawings(&self) -> impl Iterator<Item = &PageFigure> {
        self.blocks
            .iter()
            .filter_map(|block| if let PageBlock::Figure(own) = block { Some(own.as_ref()) } else { None })
    }

    /// The same in words and tables: without figures, and without headlines that have nothing else below them.
    pub fn without_figures(self) -> Self {
        let mut blocks: Vec<PageBlock> = Vec::new();
        for block in self.blocks.into_iter().rev() {
            let stays = match (&block, block.level()) {
                (PageBlock::Figure(_), _) => false,
                (_, Some(level)) => blocks.last().is_some_and(|next| next.level().is_none_or(|next| next > level)),
                _ => true,
            };
            blocks.extend(stays.then_some(block));
        }
        blocks.reverse();
        Self { blocks }
    }

    /// As Markdown (the GitHub flavour), every figure with its number and caption. HTML in it is shown and not obeyed.
    pub fn to_markdown(&self) -> String {
        let mut number = 0;
        let block = |block: &PageBlock| match block {
            PageBlock::Headline(level, title) => format!("{} {title}\n", "#".repeat(*level), title = text(title)),
            PageBlock::Folded(title) => format!("## {}\n", text(title)),
            PageBlock::Prose(prose) => format!("{prose}\n"),
            PageBlock::List(entries) => entries.iter().map(|entry| format!("- {entry}\n")).collect(),
            PageBlock::Table(table) => table.to_markdown(),
            PageBlock::Figure(figure) => {
                let PageFigure { stem, finding, caption, .. } = figure.as_ref();
                number += 1;
                format!("![Figure {number}]({stem}.png)\n\n*Figure {number}. {}. {}*\n", text(finding), text(caption))
            }
        };
        prose(&self.blocks.iter().map(block).collect::<Vec<String>>().join("\n"))
    }

    /// For a terminal: words and tables.
    pub fn to_text(&self) -> String {
        let block = |block: &PageBlock| match block {
            PageBlock::Headline(_, words) | PageBlock::Folded(words) | PageBlock::Prose(words) => {
                Some(format!("{words}\n"))
            }
            PageBlock::List(entries) => Some(entries.join("\n") + "\n"),
            PageBlock::Table(table) => Some(table.to_text()),
            PageBlock::Figure(_) => None,
        };
        self.blocks.iter().filter_map(block).collect::<Vec<String>>().join("\n")
    }

    /// The tables in LaTeX, below each other.
    pub fn to_latex(&self) -> String {
        let tables =
            self.blocks.iter().filter_map(|block| if let PageBlock::Table(own) = block { Some(own) } else { None });
        tables.map(Table::to_latex).collect::<Vec<String>>().join("\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::Panels;
    use crate::table::TableHead;

    #[test]
    fn blocks_stand_apart_in_every_form() {
        let mut page = Page::titled("Trial [1](x) a_b");
        page.words("a*b\n<b>c");
        page.say("  ");
        page.part("Numbers");
        let mut table = Table::new(TableHead::default().texts(["K"]));
        table.push(["0.1"]);
        page.table(table);
        page.figures([PageFigure::new("fit", "K is 0.1", "a*b", Panels::default())]);
        page.list(["one".to_owned(), "two".to_owned()]);
        let markdown = "# Trial [1]\\(x) a\\_b\n\na\\*b\n\n\\<b>c\n\n## Numbers\n\n| K   |\n| --- |\n| 0.1 |\n\n![Figure 1](fit.png)\n\n\
                        *Figure 1. K is 0.1. a\\*b*\n\n- one\n- two\n";
        assert_eq!(page.to_markdown(), markdown);
        assert!(page.to_text().ends_with("Numbers\n\nK\n───\n0.1\n\none\ntwo\n"), "{}", page.to_text());
        assert!(page.to_latex().contains("toprule") && page.drawings().count() == 1);
    }

    #[test]
    fn without_figures_no_headline_stands_over_nothing() {
        let figure = || [PageFigure::new("fit", "K is 0.1", "one", Panels::default())];
        let mut page = Page::titled("Trial");
        page.figures(figure());
        page.part("Seen");
        page.subpart("Here");
        page.figures(figure());
        page.part("Told");
        page.subpart("There");
        page.say("words");
        page.folded_part("Further figures");
        page.figures(figure());
        assert_eq!(page.folded(), ["Further figures"]);
        assert_eq!(page.without_figures().to_markdown(), "# Trial\n\n## Told\n\n### There\n\nwords\n");
    }
}
