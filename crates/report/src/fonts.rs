//! The typeface of every figure: a subset of DejaVu Sans compiled into the program, so that a figure looks the same on
//! a machine without any font. The subset holds Latin, Greek, combining accents, sub- and superscripts, arrows and the
//! common mathematical operators; a character outside it is drawn as an empty box.

use std::sync::{Arc, OnceLock};

use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};
use resvg::usvg::fontdb::Database;

/// Name of the embedded family.
const FAMILY: &str = "DejaVu Sans";

/// What an SVG viewer is asked for. Verdana comes second because its widths are nearest to those of DejaVu Sans, with
/// which the labels are measured.
pub(crate) const FAMILY_WITH_FALLBACK: &str = "DejaVu Sans, Verdana, Arial, sans-serif";

static REGULAR: &[u8] = include_bytes!("../fonts/DejaVuSans-subset.ttf");
static BOLD: &[u8] = include_bytes!("../fonts/DejaVuSans-Bold-subset.ttf");
static OBLIQUE: &[u8] = include_bytes!("../fonts/DejaVuSans-Oblique-subset.ttf");

/// plotters scales a font by its line height, which for DejaVu Sans is (1901 + 483) / 2048 of the em.
const LINE_HEIGHT_EM: f64 = 2384.0 / 2048.0;

fn register() {
    static ONCE: OnceLock<()> = OnceLock::new();
    ONCE.get_or_init(|| {
        for (style, bytes) in [(FontStyle::Normal, REGULAR), (FontStyle::Bold, BOLD)] {
            assert!(register_font(FAMILY, style, bytes).is_ok(), "the embedded font is a valid TrueType file");
        }
    });
}

/// The fonts as the rasteriser wants them.
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

/// Width of `text` in points at `size` points. Italic is as wide as upright in this family.
pub(crate) fn width(text: &str, size: f64, bold: bool) -> f64 {
    /// Widths come in whole pixels, so they are taken at a size where a pixel does not matter.
    const MEASURED_AT: f64 = 1000.0;
    register();
    let style = if bold { FontStyle::Bold } else { FontStyle::Normal };
    let font = FontDesc::new(FontFamily::Name(FAMILY), MEASURED_AT * LINE_HEIGHT_EM, style);
    let visible: String = text.chars().filter(|c| !crate::scene::is_markup(*c) && !is_combining(*c)).collect();
    let ((left, _), (right, _)) = font.layout_box(&visible).expect("the embedded font is registered above");
    f64::from(right - left) / MEASURED_AT * size
}

fn is_combining(c: char) -> bool {
    matches!(c, '\u{300}'..='\u{36f}')
}

#[cfg(test)]
mod tests {
    use super::*;

    // Advance widths of DejaVu Sans 2.37 in units of 1/2048 em: "A" 1401, "0" 1303.
    #[test]
    fn widths_are_those_of_the_font() {
        assert!((width("A", 2048.0, false) - 1401.0).abs() < 4.0, "{}", width("A", 2048.0, false));
        assert!((width("0000", 10.0, false) - 4.0 * 1303.0 / 204.8).abs() < 0.05);
        assert_eq!(width("K\u{302}", 10.0, false), width("K", 10.0, false));
        assert_eq!(width("", 10.0, false), 0.0);
    }

    #[test]
    fn three_faces_are_loaded() {
        assert_eq!(database().faces().count(), 3);
    }
}
