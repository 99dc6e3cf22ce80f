//! Typeface of every figure: a subset of DejaVu Sans compiled into the program, so that a figure looks the same on a
//! machine without any font. The subset holds Latin, Greek, combining accents, sub- and superscripts, arrows and the
//! common mathematical operators; a character outside it is not drawn.

use std::sync::{Arc, OnceLock};

use resvg::usvg::fontdb::Database;
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

use crate::markup::is_markup;

/// Name of the embedded font family.
pub(crate) const FAMILY: &str = "DejaVu Sans";

/// Font families in an SVG. Verdana is second because its widths are nearest to those of DejaVu Sans, with which the
/// labels are measured.
pub(crate) const FAMILY_WITH_FALLBACK: &str = "DejaVu Sans, Verdana, Arial, sans-serif";

/// Line spacing of a text, in font sizes.
pub(crate) const LINE_SPACING: f64 = 1.15;

/// Number of font units per em.
const UNITS_PER_EM: f64 = 2048.0;

static REGULAR: &[u8] = include_bytes!("../fonts/DejaVuSans-subset.ttf");
static BOLD: &[u8] = include_bytes!("../fonts/DejaVuSans-Bold-subset.ttf");
static OBLIQUE: &[u8] = include_bytes!("../fonts/DejaVuSans-Oblique-subset.ttf");

/// Database of the embedded fonts, for the rasteriser.
pub(crate) fn database() -> Arc<Database> {
    static DATABASE: OnceLock<Arc<Database>> = OnceLock::new();
    DATABASE
        .get_or_init(|| {
            let mut database = Database::new();
            for bytes in [REGULAR, BOLD, OBLIQUE] {
                database.load_font_data(bytes.to_vec());
            }
            database.set_sans_serif_family(FAMILY);
            Arc::new(database)
        })
        .clone()
}

/// Width of the widest line of `text` in points at `size` points. Italic is as wide as upright in this family.
pub(crate) fn text_width(text: &str, size: f64, bold: bool) -> f64 {
    static FONTS: OnceLock<[FontRef; 2]> = OnceLock::new();
    let fonts = FONTS.get_or_init(|| {
        [REGULAR, BOLD].map(|bytes| FontRef::new(bytes).expect("the embedded font is a valid TrueType file"))
    });
    let font = &fonts[usize::from(bold)];
    let (glyphs, metrics) = (font.charmap(), font.glyph_metrics(Size::unscaled(), LocationRef::default()));
    let advance = |c: char| metrics.advance_width(glyphs.map(c).unwrap_or_default()).unwrap_or(0.0);
    let visible = |c: &char| !is_markup(*c) && !is_combining(*c);
    let width = |line: &str| line.chars().filter(visible).map(|c| f64::from(advance(c))).sum::<f64>();
    text.split('\n').map(width).fold(0.0, f64::max) / UNITS_PER_EM * size
}

fn is_combining(c: char) -> bool {
    matches!(c, '\u{300}'..='\u{36f}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_faces_are_loaded() {
        assert_eq!(database().faces().count(), 3);
    }
    // Advance widths of DejaVu Sans 2.37 in units of 1/2048 em: "A" 1401, "0" 1303.
    #[test]
    fn widths_are_those_of_the_font() {
        assert_eq!(text_width("A", 2048.0, false), 1401.0);
        assert!((text_width("0000", 10.0, false) - 4.0 * 1303.0 / 204.8).abs() < 1e-9);
        assert_eq!(text_width("K\u{302}", 10.0, false), text_width("K", 10.0, false));
        assert_eq!(text_width("", 10.0, false), 0.0);
    }
}
