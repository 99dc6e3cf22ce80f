//! Report for a browser: the page that is written as Markdown, in one file that needs no other. Figures and tables are
//! embedded; no file is loaded. The Markdown is the only source: the page adds no statement.

mod body;
mod escape;
mod figures;

use askama::Template;

use crate::error::ReportError;
use body::PageHeading;

pub(crate) use escape::escaped;
pub use figures::FigureFiles;

/// Style sheet of the page.
const STYLE: &str = include_str!("../../templates/report.css");

/// Script of the page: the interaction of tables and figures.
const SCRIPT: &str = include_str!("../../templates/report.js");

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    title: &'a str,
    style: &'a str,
    script: &'a str,
    contents: &'a [PageHeading],
    body: &'a str,
}

/// Page of a report in Markdown (the GitHub flavour, tables included).
///
/// `images` finds the drawing of a figure `![name](stem.png)` by its stem. If there is none, or if the page would
/// become too large to be mailed, it is replaced by a link to the file. A paragraph of emphasis alone below it is its
/// caption. Parts whose titles are among `folded` are closed until a reader opens them. HTML in the Markdown is shown,
/// not interpreted.
///
/// Fails with [`ReportError::Page`] if the page cannot be filled in.
pub fn page(markdown: &str, folded: &[&str], images: &dyn Fn(&str) -> FigureFiles) -> Result<String, ReportError> {
    let body = body::from_markdown(markdown, folded, images);
    let contents: Vec<PageHeading> =
        body.headings.iter().filter(|heading| matches!(heading.level, 2 | 3)).cloned().collect();
    let title = body.headings.first().map_or("Report", |first| &first.text);
    let page = Page { title, style: STYLE, script: SCRIPT, contents: &contents, body: &body.html };
    Ok(page.render()?)
}

#[cfg(test)]
mod tests;
