//! The typeface of every figure: a subset of DejaVu Sans compiled into the program, so that a figure looks the same on
//! a machine without any font. The subset holds Latin, Greek, combining accents, sub- and superscripts, arrows and the
//! common mathematical operators; a character outside it is drawn as an empty box.

use std::sync::{Arc, OnceLock};

use resvg::usvg::fontdb::Database;

/// Name of the embedded family.
pub(crate) const FAMILY: &str = "DejaVu Sans";

/// What an SVG viewer is asked for. Verdana comes second because its widths are nearest to those of DejaVu Sans, with
/// which the labels are measured.
pub(crate) const FAMILY_WITH_FALLBACK: &str = "DejaVu Sans, Verdana, Arial, sans-serif";

pub(crate) static REGULAR: &[u8] = include_bytes!("../fonts/DejaVuSans-subset.ttf");
pub(crate) static BOLD: &[u8] = include_bytes!("../fonts/DejaVuSans-Bold-subset.ttf");
static OBLIQUE: &[u8] = include_bytes!("../fonts/DejaVuSans-Oblique-subset.ttf");

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_faces_are_loaded() {
        assert_eq!(database().faces().count(), 3);
    }
}
