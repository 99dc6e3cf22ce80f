//! Errors of themes, image files and pages. Drawing itself never fails: undefined numbers are omitted.

use std::path::PathBuf;

use thiserror::Error;

/// Error of a theme, of an image file or of a page.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The width of a printed figure is outside the range of a page.
    #[error("a figure {width_mm} mm wide cannot be drawn: the width must lie between {min_mm} and {max_mm} mm")]
    Width {
        /// Requested width, mm.
        width_mm: f64,
        /// Minimum width, mm.
        min_mm: f64,
        /// Maximum width, mm.
        max_mm: f64,
    },
    /// The resolution of a printed figure is outside the accepted range.
    #[error("{dpi} dots per inch is not usable: the resolution must lie between {min} and {max} dpi")]
    Resolution {
        /// Requested resolution, dots per inch.
        dpi: f64,
        /// Minimum resolution, dots per inch.
        min: f64,
        /// Maximum resolution, dots per inch.
        max: f64,
    },
    /// The drawing needs more pixels than an image may have.
    #[error("an image of {width_px} x {height_px} pixels is too large; draw it narrower or at fewer dpi")]
    TooLarge {
        /// Width in pixels.
        width_px: u32,
        /// Height in pixels.
        height_px: u32,
    },
    /// The drawing could not be turned into pixels.
    #[error("failed to rasterise the figure")]
    Raster(#[from] resvg::usvg::Error),
    /// The pixels could not be packed into a PNG.
    #[error("failed to encode the PNG")]
    Png(#[from] png::EncodingError),
    /// The template of a page could not be filled in.
    #[error("failed to make the page")]
    Page(#[from] askama::Error),
    /// A file or folder could not be written.
    #[error("failed to write {}", path.display())]
    Write {
        /// Path of the file or folder.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
}
