//! The page of a report as files: `report.md`, and `report.html` made of it and of the figures that were just written.

use campaign::folder::ResultFolder;
use report::html::{self, Images};
use scenario::failure::{Failure, OnPath};

/// The page as Markdown.
pub const REPORT: &str = "report.md";

/// The same page for a browser, in one file.
pub const BROWSER: &str = "report.html";

/// Writes both pages. The figures that the Markdown names are those of the folder, so they are written before.
///
/// Fails when a file cannot be written.
pub fn write_page(folder: &ResultFolder, markdown: &str) -> Result<(), Failure> {
    folder.write(REPORT, markdown)?;
    let page =
        html::page(markdown, &|stem| Images::written(folder.path(), stem)).on("make", &folder.path().join(BROWSER))?;
    folder.write(BROWSER, page)
}
