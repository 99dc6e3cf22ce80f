//! Attributes of a group of elements in an SVG document.

use crate::palette::Dash;

/// Rectangle in units of the SVG: left, top, right and bottom.
pub(crate) type Bounds = [i32; 4];

/// Attributes shared by elements that are drawn together.
#[derive(Debug, Clone, Default)]
pub(crate) struct SvgGroup {
    /// Name in the legend, by which a page in a browser finds the elements; `None` for elements without an entry.
    pub series: Option<String>,
    /// `true` if the elements are intervals of the values of that series, not values.
    pub is_interval: bool,
    /// Dash pattern of the lines in line widths, and the line width in points; `None` for solid lines.
    pub dash: Option<(Dash, f64)>,
    /// Clip rectangle of the elements; `None` if they are drawn whole.
    pub clip: Option<Bounds>,
    /// Width of a white edge on either side of the letters of texts, points; `None` without an edge.
    pub halo: Option<f64>,
}

impl SvgGroup {
    /// Group of a series, by its name in the legend; `None` for elements without an entry.
    pub(crate) fn named(series: Option<&str>) -> Self {
        Self { series: series.map(str::to_owned), ..Self::default() }
    }
}
