//! A finished figure and its files: an SVG, and a PNG of the same drawing with its resolution stored inside, so that
//! both have the intended size on a page. Equal figures give equal bytes.

use std::fs;
use std::path::{Path, PathBuf};

use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use crate::error::ReportError;
use crate::fonts;
use crate::indexed::IndexedImage;

const POINTS_PER_INCH: f64 = 72.0;
const METRES_PER_INCH: f64 = 0.0254;
/// Maximum side of an image, pixels.
const MAX_SIDE_PX: u32 = 20_000;

/// Compression level of PNGs: the maximum.
const LEVEL: u8 = 9;

/// Drawing that is ready to be written.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    svg: String,
    /// Width on the page, points.
    width: f64,
    /// Height on the page, points.
    height: f64,
    /// Resolution of the PNG, dots per inch.
    dpi: f64,
}

impl Drawing {
    pub(crate) fn new(svg: String, width: f64, height: f64, dpi: f64) -> Self {
        Self { svg, width, height, dpi }
    }

    /// Text of the SVG document.
    pub fn svg(&self) -> &str {
        &self.svg
    }

    /// Width and height on the page, points.
    pub fn size(&self) -> (f64, f64) {
        (self.width, self.height)
    }

    /// Width and height of the PNG, pixels.
    pub fn pixels(&self) -> (u32, u32) {
        let side = |points: f64| (points / POINTS_PER_INCH * self.dpi).round().max(1.0) as u32;
        (side(self.width), side(self.height))
    }

    /// PNG of the drawing with at most 256 colours and its resolution in pixels per metre.
    ///
    /// Fails with [`ReportError::TooLarge`] if a side is longer than 20 000 pixels, and if the SVG cannot be rasterised
    /// or the PNG cannot be encoded.
    pub fn png(&self) -> Result<Vec<u8>, ReportError> {
        let (width_px, height_px) = self.pixels();
        let too_large = || ReportError::TooLarge { width_px, height_px };
        if width_px.max(height_px) > MAX_SIDE_PX {
            return Err(too_large());
        }
        let options = Options { fontdb: fonts::database(), ..Options::default() };
        let tree = Tree::from_str(&self.svg, &options)?;
        let mut pixmap = Pixmap::new(width_px, height_px).ok_or_else(too_large)?;
        pixmap.fill(Color::WHITE);
        let scale =
            Transform::from_scale(width_px as f32 / tree.size().width(), height_px as f32 / tree.size().height());
        resvg::render(&tree, scale, &mut pixmap.as_mut());
        self.encode(pixmap)
    }

    fn encode(&self, pixmap: Pixmap) -> Result<Vec<u8>, ReportError> {
        let (width, height) = (pixmap.width(), pixmap.height());
        // The page is opaque, so the alpha channel is constant and the colours are not premultiplied.
        let IndexedImage { palette, pixels } = IndexedImage::from_rgba(&pixmap.take());
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(palette);
        encoder.set_deflate_compression(png::DeflateCompression::Level(LEVEL));
        // Indices of a palette are not quantities: a difference between neighbours carries no information.
        encoder.set_filter(png::Filter::NoFilter);
        let per_metre = (self.dpi / METRES_PER_INCH).round() as u32;
        let dims = png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit: png::Unit::Meter };
        encoder.set_pixel_dims(Some(dims));
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&pixels)?;
        writer.finish()?;
        Ok(bytes)
    }

    /// Writes `stem.svg` and `stem.png` into `dir`, which is made if it is missing; returns their paths in this order.
    ///
    /// Fails with [`ReportError::Write`] if a file or the folder cannot be written, and as [`Self::png`] does.
    pub fn write(&self, dir: &Path, stem: &str) -> Result<(PathBuf, PathBuf), ReportError> {
        let put = |path: PathBuf, bytes: &[u8]| match fs::write(&path, bytes) {
            Ok(()) => Ok(path),
            Err(source) => Err(ReportError::Write { path, source }),
        };
        fs::create_dir_all(dir).map_err(|source| ReportError::Write { path: dir.to_path_buf(), source })?;
        let svg = put(dir.join(format!("{stem}.svg")), self.svg.as_bytes())?;
        let png = put(dir.join(format!("{stem}.png")), &self.png()?)?;
        Ok((svg, png))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::style::text_anchor::HPos;

    use crate::canvas::TextLine;
    use crate::sheet::Sheet;
    use crate::theme::Theme;

    fn sample() -> Drawing {
        let sheet = Sheet::new(&Theme::screen(), "").unwrap();
        sheet.canvas.text((10.0, 22.0), &TextLine::new("ψ", 24.0, HPos::Left)).unwrap();
        let svg = sheet.canvas.svg.finish(36.0).replace("width=\"675.000pt\"", "width=\"72.000pt\"");
        Drawing::new(svg.replace("0 0 13500 720", "0 0 1440 720"), 72.0, 36.0, 300.0)
    }

    #[test]
    fn png_has_the_size_and_resolution_asked_for() {
        let bytes = sample().png().unwrap();
        let reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        assert_eq!((reader.info().width, reader.info().height), (300, 150));
        // 300 dpi = 11811 pixels per metre.
        assert_eq!(reader.info().pixel_dims.map(|d| (d.xppu, d.yppu)), Some((11811, 11811)));
        assert_eq!(bytes, sample().png().unwrap());
    }

    #[test]
    fn text_reaches_the_pixels() {
        let bytes = sample().png().unwrap();
        let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut pixels).unwrap();
        let dark = pixels.chunks_exact(3).filter(|p| p[0] < 64).count();
        assert!((500..6000).contains(&dark), "{dark} dark pixels");
    }

    #[test]
    fn writes_both_files_or_says_where_it_failed() {
        let dir = std::env::temp_dir().join(format!("report-figure-{}", std::process::id()));
        let (svg, png) = sample().write(&dir, "psi").unwrap();
        assert_eq!(fs::read_to_string(&svg).unwrap(), sample().svg());
        assert!(png.ends_with("psi.png"));
        let error = sample().write(&svg, "psi").unwrap_err();
        assert!(error.to_string().contains("psi.svg"), "{error}");
        fs::remove_dir_all(&dir).unwrap();
    }

    #[test]
    fn refuses_an_image_nobody_can_hold() {
        let figure = Drawing::new(String::new(), 1e5, 10.0, 300.0);
        assert!(matches!(figure.png(), Err(ReportError::TooLarge { width_px: 416_667, .. })));
    }
}
