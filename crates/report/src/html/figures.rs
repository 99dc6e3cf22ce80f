//! Figures inside a page: the drawing itself where it is small enough, otherwise its pixels, otherwise a link.

use std::fs;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::escape::escaped;

/// Largest drawing that stands in a page as shapes, bytes: beyond it browsers become slow, and pixels are smaller.
const LARGEST_DRAWING: usize = 300_000;

/// Most bytes of a file that is looked at for a figure.
const LARGEST_FILE: u64 = 1 << 26;

/// Bytes that all figures of a page have together: the whole page stays below 2 MB.
const ROOM: usize = 1_850_000;

/// A figure as it was written.
#[derive(Debug, Clone, Default)]
pub struct Images {
    /// The SVG document, where there is one.
    pub svg: Option<String>,
    /// The PNG file, where there is one.
    pub png: Option<Vec<u8>>,
}

impl Images {
    /// What [`crate::Drawing::write`] has put into a folder under a stem; a file that cannot be read is none, because a
    /// page can do without a figure.
    pub fn written(folder: &Path, stem: &str) -> Self {
        let file = |kind: &str| {
            let path = folder.join(format!("{stem}.{kind}"));
            // A pipe would be waited for without an end.
            let is_figure = path.metadata().is_ok_and(|about| about.is_file() && about.len() <= LARGEST_FILE);
            is_figure.then(|| fs::read(path).ok())?
        };
        Self { svg: file("svg").and_then(|bytes| String::from_utf8(bytes).ok()), png: file("png") }
    }
}

/// The room that is left for figures.
pub(super) struct Room(usize);

impl Room {
    pub(super) fn new() -> Self {
        Self(ROOM)
    }

    /// The figure with its caption; `file` is where its PNG is.
    pub(super) fn figure(&mut self, file: &str, caption: &str, images: &Images) -> String {
        let drawn = images.svg.as_deref().and_then(|svg| inline(svg, caption));
        let drawn = drawn.filter(|drawn| drawn.len() <= LARGEST_DRAWING);
        let pixels = || {
            let encoded = STANDARD.encode(images.png.as_deref()?);
            let caption = escaped(caption);
            Some(format!("<img src=\"data:image/png;base64,{encoded}\" alt=\"{caption}\">"))
        };
        let fitting = |image: &String| image.len() <= self.0;
        let image = drawn.filter(fitting).or_else(|| pixels().filter(fitting));
        let (file, caption) = (escaped(file), escaped(caption));
        match image {
            Some(image) => {
                self.0 -= image.len();
                format!(
                    "<figure>\n<div class=\"plot\" role=\"group\" tabindex=\"0\" aria-label=\"Figure: {caption}\">{image}\
                     </div>\n<figcaption>{caption}</figcaption>\n</figure>\n"
                )
            }
            None => format!("<p>Figure: <a href=\"{file}\">{caption}</a></p>\n"),
        }
    }
}

/// An SVG document as an element of a page: without the size and the name space that only a file needs.
fn inline(svg: &str, caption: &str) -> Option<String> {
    let (head, shapes) = svg.split_once('>')?;
    let attribute = |name: &str| Some(head.split_once(&format!(" {name}=\""))?.1.split_once('"')?.0);
    let (view, width) = (attribute("viewBox")?, attribute("width")?);
    Some(format!(
        "<svg viewBox=\"{view}\" style=\"max-width:{width}\" role=\"img\" aria-label=\"{}\">{}",
        escaped(caption),
        shapes.trim_start()
    ))
}
