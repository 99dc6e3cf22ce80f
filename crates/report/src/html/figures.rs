//! Figures inside a page: the drawing itself if it is small enough, otherwise its pixels, otherwise a link.

use std::fs;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::escape::escaped;

/// Maximum size of a drawing that is embedded as SVG, bytes: larger ones are slow in browsers, and pixels are smaller.
const MAX_DRAWING_BYTES: usize = 300_000;

/// Maximum size of a file that is read for a figure, bytes.
const MAX_FILE_BYTES: u64 = 1 << 26;

/// Maximum size of all figures of a page together, bytes: the whole page stays below 2 MB.
const ROOM: usize = 1_850_000;

/// Files of a written figure.
#[derive(Debug, Clone, Default)]
pub struct FigureFiles {
    /// SVG document; `None` without one.
    pub svg: Option<String>,
    /// Content of the PNG file; `None` without one.
    pub png: Option<Vec<u8>>,
}

impl FigureFiles {
    /// Files that [`crate::Drawing::write`] wrote into a folder under a stem. `None` for a file that cannot be read or
    /// is larger than 64 MiB: a page is complete without a figure.
    pub fn from_folder(folder: &Path, stem: &str) -> Self {
        let file = |kind: &str| {
            let path = folder.join(format!("{stem}.{kind}"));
            // Reading a pipe could wait forever.
            let is_figure = path.metadata().is_ok_and(|about| about.is_file() && about.len() <= MAX_FILE_BYTES);
            is_figure.then(|| fs::read(path).ok())?
        };
        Self { svg: file("svg").and_then(|bytes| String::from_utf8(bytes).ok()), png: file("png") }
    }
}

/// Remaining size for figures, bytes, and the number of placed figures.
pub(super) struct SizeBudget {
    bytes: usize,
    figures: usize,
}

impl SizeBudget {
    pub(super) fn new() -> Self {
        Self { bytes: ROOM, figures: 0 }
    }

    /// HTML of a figure with its name and caption; the name is omitted if it equals the caption. If no drawing fits, it
    /// is a link to `file`, the path of the PNG.
    pub(super) fn figure(&mut self, file: &str, [name, caption]: [&str; 2], images: &FigureFiles) -> String {
        let id = format!("caption-{}", self.figures + 1);
        let drawn = images.svg.as_deref().and_then(|svg| inline(svg, &id));
        let drawn = drawn.filter(|drawn| drawn.len() <= MAX_DRAWING_BYTES);
        let (file, name, caption) = (escaped(file), escaped(name), escaped(caption));
        let name = if name == caption { "" } else { &name };
        let pixels = || {
            let encoded = STANDARD.encode(images.png.as_deref()?);
            Some(format!("<img src=\"data:image/png;base64,{encoded}\" alt=\"{name}\">"))
        };
        let fitting = |image: &String| image.len() <= self.bytes;
        let image = drawn.filter(fitting).or_else(|| pixels().filter(fitting));
        match image {
            Some(image) => {
                self.bytes -= image.len();
                self.figures += 1;
                format!(
                    "<figure>\n<div class=\"plot\" role=\"group\" tabindex=\"0\" aria-labelledby=\"{id}\">{image}</div>\n\
                     <figcaption id=\"{id}\">{caption}</figcaption>\n</figure>\n"
                )
            }
            None => format!("<p>Figure: <a href=\"{file}\">{caption}</a></p>\n"),
        }
    }
}

/// SVG document as an element of a page, without the size and the name space that only a file needs. `caption` is the
/// id of its caption. `None` if the text has no SVG element with a size.
fn inline(svg: &str, caption: &str) -> Option<String> {
    let (head, shapes) = svg.split_once('>')?;
    let attribute = |name: &str| Some(head.split_once(&format!(" {name}=\""))?.1.split_once('"')?.0);
    let (view, width) = (attribute("viewBox")?, attribute("width")?);
    // The clip rectangle of a panel must be that of its own figure, even if another figure has an equal panel.
    let shapes = shapes.replace("id=\"clip-", &format!("id=\"{caption}-clip-"));
    let shapes = shapes.replace("url(#clip-", &format!("url(#{caption}-clip-"));
    Some(format!(
        "<svg viewBox=\"{view}\" style=\"max-width:{width}\" role=\"img\" aria-labelledby=\"{caption}\">{}",
        shapes.trim_start()
    ))
}
