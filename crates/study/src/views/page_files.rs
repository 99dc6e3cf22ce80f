//! A page as files: its figures as SVG and PNG, `report.md`, and `report.html` made of both.

use campaign::disk;
use campaign::failure::{Failure, OnPath};
use campaign::folder::ResultFolder;
use rayon::prelude::*;
use report::html::{self, FigureFiles};
use report::{Page, PageFigure, Theme};

use crate::documents;

/// Name of the page in Markdown.
pub const MARKDOWN_REPORT_FILE: &str = "report.md";

/// Name of the page for a browser, a single file.
pub const HTML_REPORT_FILE: &str = "report.html";

/// File stem of the key figure of a page.
pub const KEY_FIGURE_STEM: &str = "hero";

/// Writes a page in both forms with its figures; without a theme only texts and tables.
///
/// Fails if the style has limits for an axis that is in none of the figures, or if a file cannot be written; the
/// failure is the first one in the order of the page.
pub fn write_page(folder: &ResultFolder, page: Page, theme: Option<&Theme>) -> Result<(), Failure> {
    let page = if theme.is_some() { page } else { page.without_figures() };
    remove_former(folder, &page)?;
    if let Some(theme) = theme {
        draw(folder, &page, theme)?;
    }
    let markdown = page.to_markdown();
    let browser = html::page(&markdown, &page.folded_titles(), &|stem| FigureFiles::from_folder(folder.path(), stem));
    folder.write(MARKDOWN_REPORT_FILE, markdown)?;
    folder.write(HTML_REPORT_FILE, browser.on("make", &folder.path().join(HTML_REPORT_FILE))?)
}

/// Removes the figures of the former page in this folder, which may be of another ship. Figures that are made again are
/// kept.
fn remove_former(folder: &ResultFolder, page: &Page) -> Result<(), Failure> {
    let place = folder.path().join(MARKDOWN_REPORT_FILE);
    let former = disk::read(&place, documents::MAX_FILE_BYTES).on("read", &place)?.unwrap_or_default();
    let former = String::from_utf8_lossy(&former);
    let images = former.split("](").filter_map(|link| link.split_once(')')?.0.strip_suffix(".png"));
    let has = |stem: &str, kind: &str| folder.path().join(stem).with_extension(kind).is_file();
    let is_old = |stem: &&str| has(stem, "svg") && page.figures().iter().all(|figure| figure.stem != *stem);
    let old: Vec<&str> = images.filter(is_old).collect();
    folder.remove_matching(|name| {
        let stem = name.strip_suffix(".png").or_else(|| name.strip_suffix(".svg"));
        stem.is_some_and(|stem| old.contains(&stem))
    })
}

fn draw(folder: &ResultFolder, page: &Page, theme: &Theme) -> Result<(), Failure> {
    let figures = page.figures();
    let mut titles: Vec<String> = figures.iter().flat_map(|figure| figure.plot.axis_titles()).collect();
    titles.sort_unstable();
    titles.dedup();
    if let Some(title) = theme.limits_without_axis(&titles).first() {
        let axes = titles.join("\", \"");
        return Err(Failure::input(format!(
            "[limits] \"{title}\": no figure of this page has an axis with this title; take one of \"{axes}\" in the style, \
             or a style of its own for this page"
        )));
    }
    run_all_in_parallel(figures.par_iter().map(|PageFigure { stem, finding, plot, .. }| {
        let figure = plot.draw(finding, theme);
        folder.write(&format!("{stem}.svg"), figure.svg())?;
        folder.write(&format!("{stem}.png"), figure.png().on("draw the figure", &folder.path().join(stem))?)
    }))
}

/// Runs all work in parallel and fails with the first failure in order, not in time.
pub fn run_all_in_parallel(work: impl IndexedParallelIterator<Item = Result<(), Failure>>) -> Result<(), Failure> {
    work.collect::<Vec<_>>().into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_failure_in_order_is_told() {
        let work = (0..64).into_par_iter().map(|k| match k {
            // The earlier in order, the later in time.
            8.. => Err(Failure::execution(format!("figure {k}"))),
            7 => {
                std::thread::sleep(std::time::Duration::from_millis(5));
                Err(Failure::execution("figure 7".to_owned()))
            }
            _ => Ok(()),
        });
        assert_eq!(run_all_in_parallel(work).map_err(|failure| failure.message), Err("figure 7".to_owned()));
    }
}
