//! Panels of layers (lines, bands, records, marks) over numeric axes: stacked if they share one axis, in rows and
//! columns if they share both, as small multiples if all are alike, side by side if they share none. A figure is data;
//! [`super::layers`] draws it.

use super::extents::{Extents, MAX_INTERVAL_SHARE, OutlierLimit};
use super::shared::{ReferenceBand95, record_symbol};
pub use crate::axis::TickRule;

use plotters::style::RGBColor;

use crate::axis::Axis;
use crate::canvas::Stroke;
use crate::curve::PlotCurve;
use crate::legend::LegendSymbol;
use crate::markup::symbol;
use crate::palette::{CurveOrigin, CurveStyle, Dash, HEADING, SOLID};
use crate::theme::Theme;

/// Specification of an axis: title with unit, tick rule and limits.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AxisSpec {
    /// Title with the unit.
    pub title: String,
    /// Rule by which the axis places its ticks.
    pub tick_rule: TickRule,
    /// Limit of the axis against outliers; `None` for an axis over all data.
    pub outlier_limit: Option<OutlierLimit>,
    /// Names of the values 0, 1, 2, … in place of numbers; empty for a numeric axis.
    pub names: Vec<String>,
}

impl AxisSpec {
    /// Axis over all data.
    pub fn new(title: impl Into<String>, tick_rule: TickRule) -> Self {
        Self { title: title.into(), tick_rule, ..Self::default() }
    }

    /// Axis of decimal numbers.
    pub fn decimal(title: impl Into<String>) -> Self {
        Self::new(title, TickRule::Decimal)
    }

    /// Axis of names, one unit each.
    pub fn of_names(names: Vec<String>) -> Self {
        Self { names, ..Self::default() }
    }

    /// Axis of time in seconds.
    pub fn time() -> Self {
        Self::new(format!("time {} [s]", symbol("t")), TickRule::Time)
    }

    /// Axis of heading in degrees.
    pub fn heading() -> Self {
        Self::new(format!("heading {} [°]", symbol("ψ")), TickRule::Angle)
    }

    /// Axis of rudder angle in degrees.
    pub fn rudder() -> Self {
        Self::new(format!("rudder {} [°]", symbol("δ")), TickRule::Angle)
    }

    /// Axis of yaw rate in degrees per second.
    pub fn yaw_rate() -> Self {
        Self::decimal(format!("yaw rate {} [°/s]", symbol("r")))
    }

    /// The axis limited to `extent_factor` times the median extent of the data from a centre; `None` for the median of
    /// the data.
    pub fn limited_around(self, extent_factor: f64, centre: Option<f64>) -> Self {
        Self { outlier_limit: Some(OutlierLimit { extent_factor, centre, is_symmetric: false }), ..self }
    }

    /// The axis limited to ±`extent_factor` times the median extent of the data, centred on zero.
    pub fn limited_about_zero(self, extent_factor: f64) -> Self {
        Self { outlier_limit: Some(OutlierLimit { extent_factor, centre: Some(0.0), is_symmetric: true }), ..self }
    }

    /// The axis over `data`, and whether data are cut. `pad` is the free space at both ends of a linear axis other than
    /// time, as a share of the range of the data.
    pub(super) fn axis(&self, data: &Extents, pad: f64) -> (Axis, bool) {
        match self.tick_rule {
            _ if !self.names.is_empty() => return (Axis::columns(&self.names), false),
            TickRule::Logarithmic => {
                let axis = Axis::log_covering(&data.positive());
                let (lo, hi) = axis.ends();
                let is_beyond = |value: f64| value > 0.0 && value.is_finite() && !(lo..=hi).contains(&value);
                // An interval that is cut ends at the frame without a cap.
                let layers = data.clippable_values.iter().filter(|(_, room)| *room != MAX_INTERVAL_SHARE);
                return (axis, layers.map(|(value, _)| *value).any(is_beyond));
            }
            TickRule::Percent => return (Axis::linear(-3.0, 103.0, TickRule::Percent), false),
            _ => {}
        }
        let pad = if self.tick_rule == TickRule::Time { 0.0 } else { pad };
        let (ends, is_cut) = data.ends(self.outlier_limit);
        (Axis::covering(ends.into_iter().flat_map(|(lo, hi)| [lo, hi]), pad, self.tick_rule), is_cut)
    }
}

/// Style of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pen {
    /// Colour of the line.
    pub colour: RGBColor,
    /// Width, as a multiple of the curve width of the theme.
    pub width: f64,
    /// Dash pattern, in line widths.
    pub dash: Dash,
    /// Opacity, from 0 to 1.
    pub opacity: f64,
}

impl Pen {
    /// Solid line.
    pub const fn new(colour: RGBColor) -> Self {
        Self { colour, width: 1.0, dash: SOLID, opacity: 1.0 }
    }

    /// Line with the colour and the dash of an origin.
    pub fn from_origin(origin: &CurveOrigin) -> Self {
        let style = origin.style();
        Self { dash: style.dash, ..Self::new(style.colour) }
    }

    /// Thin, pale line for one of many curves.
    pub const fn pale() -> Self {
        Self { width: 0.6, opacity: 0.35, ..Self::new(HEADING) }
    }

    /// The line with another width, as a multiple of the curve width of the theme.
    pub fn width(self, width: f64) -> Self {
        Self { width, ..self }
    }

    pub(super) fn stroke(&self, theme: &Theme) -> Stroke {
        Stroke { colour: self.colour, opacity: self.opacity, width: self.width * theme.line, dash: self.dash }
    }
}

/// Marks at the points of a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Marks {
    /// Style of the marks.
    pub style: CurveStyle,
    /// Intervals of the marks in their order, values of the vertical axis; `None` for a mark without an interval.
    pub intervals: Vec<Option<[f64; 2]>>,
    /// Line that joins the marks; `None` for separate marks.
    pub joining_line: Option<Pen>,
    /// `true` if marks that would overlap are drawn side by side.
    pub side_by_side: bool,
}

/// Kind of a layer: how its points are drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum LayerKind {
    /// Line through the points.
    Line(Pen),
    /// Area between the points and another curve, with colour and opacity.
    Band(PlotCurve, RGBColor, f64),
    /// Record: dots, or a wide line if there are too many points for dots.
    Record,
    /// Small dots. Single ones far from all others do not set the axis: they are arrows at its edge.
    Dots(RGBColor),
    /// Pale dots that do not set the axis; those outside are counted in the corner of the panel.
    Cloud(RGBColor),
    /// Marks with intervals. An infinite value is an arrow at the edge.
    Marks(Marks),
    /// Ships seen from above, with these headings in degrees.
    Ships(RGBColor, Vec<f64>),
    /// Labels next to the points, and their colour.
    Labels(Vec<String>, RGBColor),
}

/// One layer of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Name in the legend, where layers of one name are listed once; `None` for a layer that is not listed.
    pub name: Option<String>,
    /// Points of the layer.
    pub curve: PlotCurve,
    /// Kind of the layer.
    pub kind: LayerKind,
    /// Maximum share of the range of all other data by which the layer may widen the axes before it is cut; `None` for
    /// a layer that sets the axes.
    pub max_axis_widening: Option<f64>,
}

impl Layer {
    /// Layer that sets the axes.
    pub fn new(name: impl Into<String>, curve: PlotCurve, kind: LayerKind) -> Self {
        let name = Some(name.into()).filter(|name| !name.is_empty());
        Self { name, curve, kind, max_axis_widening: None }
    }

    /// Line through a curve.
    pub fn line(name: impl Into<String>, curve: PlotCurve, pen: Pen) -> Self {
        Self::new(name, curve, LayerKind::Line(pen))
    }

    /// Area between two curves.
    pub fn band(name: impl Into<String>, [lower, upper]: [PlotCurve; 2], colour: RGBColor, opacity: f64) -> Self {
        Self::new(name, lower, LayerKind::Band(upper, colour, opacity))
    }

    /// Marks at points, each with abscissa, value and interval.
    pub fn marks(name: impl Into<String>, style: CurveStyle, points: Vec<(f64, f64, Option<[f64; 2]>)>) -> Self {
        let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|(x, y, _)| (*x, *y)).unzip();
        let intervals = points.into_iter().map(|(.., interval)| interval).collect();
        Self::new(
            name,
            PlotCurve { x, y },
            LayerKind::Marks(Marks { style, intervals, joining_line: None, side_by_side: false }),
        )
    }

    /// The marks joined by a line; a layer of another kind is unchanged.
    pub fn with_line(mut self, pen: Pen) -> Self {
        if let LayerKind::Marks(marks) = &mut self.kind {
            marks.joining_line = Some(pen);
        }
        self
    }

    /// The marks side by side if they would overlap; a layer of another kind is unchanged.
    pub fn side_by_side(mut self) -> Self {
        if let LayerKind::Marks(marks) = &mut self.kind {
            marks.side_by_side = true;
        }
        self
    }

    /// Layer that may widen the axes by the share `widening` of the range of all other data, and is cut beyond.
    pub fn widening_at_most(self, widening: f64) -> Self {
        Self { max_axis_widening: Some(widening), ..self }
    }

    pub(super) fn curves(&self) -> impl Iterator<Item = &PlotCurve> {
        let other = if let LayerKind::Band(other, ..) = &self.kind { Some(other) } else { None };
        [&self.curve].into_iter().chain(other)
    }

    /// Colour of the layer.
    pub fn colour(&self) -> RGBColor {
        match &self.kind {
            LayerKind::Line(pen) => pen.colour,
            LayerKind::Band(_, colour, _) | LayerKind::Dots(colour) => *colour,
            LayerKind::Cloud(colour) | LayerKind::Ships(colour, _) | LayerKind::Labels(_, colour) => *colour,
            LayerKind::Marks(marks) => marks.style.colour,
            LayerKind::Record => crate::palette::RECORD,
        }
    }

    /// Symbol in the legend, that of a band with the opacity `shade`; `None` for labels, and for a record or ships
    /// without points.
    pub(super) fn legend_symbol(&self, theme: &Theme, shade: f64) -> Option<LegendSymbol> {
        Some(match &self.kind {
            LayerKind::Line(pen) => LegendSymbol::Line(pen.stroke(theme)),
            LayerKind::Band(_, colour, _) => {
                LegendSymbol::Line(Stroke { opacity: shade, ..Stroke::solid(*colour, 0.8 * theme.small_font) })
            }
            LayerKind::Record if self.curve.finite_pairs().next().is_none() => return None,
            LayerKind::Record => record_symbol(theme, &self.curve),
            LayerKind::Dots(colour) | LayerKind::Cloud(colour) => LegendSymbol::Dots(*colour),
            LayerKind::Marks(Marks { style, joining_line: Some(pen), .. }) => {
                LegendSymbol::LineAndMarker(pen.stroke(theme), *style)
            }
            LayerKind::Marks(Marks { style, .. }) => LegendSymbol::Marker(*style),
            LayerKind::Labels(..) => return None,
            LayerKind::Ships(..) if self.curve.finite_pairs().next().is_none() => return None,
            LayerKind::Ships(colour, _) => LegendSymbol::Hull(*colour),
        })
    }
}

/// Row of panels with a common vertical axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PanelRow {
    /// Vertical axis.
    pub y: AxisSpec,
    /// Height, as a share of the width of the figure.
    pub height: f64,
    /// `true` if there is a horizontal line at zero.
    pub has_zero_line: bool,
    /// Values on the vertical axis of horizontal dashed lines, such as the limits of white noise.
    pub dashed_levels: Vec<f64>,
    /// Reference value of the results with its 95 % band; `None` without a reference.
    pub reference: Option<ReferenceBand95>,
    /// Shares of the height that are free below and above the data.
    pub free_shares: [f64; 2],
}

impl PanelRow {
    /// Row of panels.
    pub fn new(y: AxisSpec, height: f64) -> Self {
        Self { y, height, ..Self::default() }
    }

    /// Row of panels with a horizontal line at zero.
    pub fn zeroed(y: AxisSpec, height: f64) -> Self {
        Self { has_zero_line: true, ..Self::new(y, height) }
    }
}

/// Panel of layers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LayeredPanel {
    /// Text above the panel; `None` without one.
    pub head: Option<String>,
    /// Result, written after the head; `None` without one.
    pub result: Option<String>,
    /// The layers, the first at the bottom.
    pub layers: Vec<Layer>,
}

/// Marked value of the horizontal axis, such as a limit of a rule.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisLine {
    /// Value on the axis.
    pub value: f64,
    /// Name in the legend; empty for a line that is not listed.
    pub label: String,
}

/// Panels with common axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PanelGroup {
    /// Horizontal axes, one per column.
    pub x: Vec<AxisSpec>,
    /// Rows of the group.
    pub rows: Vec<PanelRow>,
    /// The panels, row by row.
    pub panels: Vec<LayeredPanel>,
    /// Vertical lines through all panels.
    pub vertical_lines: Vec<AxisLine>,
    /// Number of small multiples side by side, all with the first horizontal axis and the first row; `None` for panels
    /// in rows and columns.
    pub multiples_across: Option<usize>,
    /// `true` if small multiples stay side by side on a narrow page, too: a row of them is a unit.
    pub is_unbroken: bool,
    /// `true` if the group has half the width of the figure; two of them are side by side if there is room.
    pub is_half: bool,
    /// `true` if there is a vertical line at zero.
    pub has_zero_line: bool,
    /// `true` if a unit has the same length on both axes.
    pub has_equal_scales: bool,
}

impl PanelGroup {
    /// Panels above each other over one horizontal axis.
    pub fn over(x: AxisSpec, rows: Vec<(PanelRow, Vec<Layer>)>) -> Self {
        let (rows, layers): (Vec<PanelRow>, Vec<Vec<Layer>>) = rows.into_iter().unzip();
        let panels = layers.into_iter().map(|layers| LayeredPanel { layers, ..LayeredPanel::default() }).collect();
        Self { x: vec![x], rows, panels, ..Self::default() }
    }

    /// Small multiples: panels with the same pair of axes, `across` of them side by side.
    pub fn multiples(across: usize, x: AxisSpec, row: PanelRow, panels: Vec<LayeredPanel>) -> Self {
        Self { x: vec![x], rows: vec![row], panels, multiples_across: Some(across), ..Self::default() }
    }
}

/// Groups of panels in one figure, with their legend and remarks.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panels {
    /// The groups, in reading order.
    pub groups: Vec<PanelGroup>,
    /// `true` if names are right of the frame, in place of a legend; on a narrow page they are always in the legend.
    pub names_aside: bool,
    /// Texts in the legend without a symbol, such as numbers.
    pub legend_texts: Vec<String>,
    /// Remark under the figure; `None` without a remark.
    pub note: Option<String>,
    /// Remark that is added if a layer is cut; `None` without a remark.
    pub clipping_note: Option<String>,
    /// Remark that is added if marks are beyond the axes; `None` for the usual remark.
    pub overflow_note: Option<String>,
}

impl Panels {
    /// Figure of one group.
    pub fn new(group: PanelGroup) -> Self {
        Self { groups: vec![group], ..Self::default() }
    }

    /// Panels above each other over time.
    pub fn over_time(rows: Vec<(PanelRow, Vec<Layer>)>) -> Self {
        Self::new(PanelGroup::over(AxisSpec::time(), rows))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_names_of_a_plot_are_those_of_layers_panels_rows_and_items() {
        use crate::figures::{CellMap, NamedRows, Plot, RowItem, RowsColumn, Shades};
        let labels = Layer::new("", PlotCurve::default(), LayerKind::Labels(Vec::new(), HEADING));
        assert_eq!(labels.colour(), HEADING);
        let line = Layer::line("srivc", PlotCurve::default(), Pen::pale());
        let panel = LayeredPanel { head: Some("calm".into()), layers: vec![labels, line], ..LayeredPanel::default() };
        let panels = Panels::new(PanelGroup { panels: vec![panel], ..PanelGroup::default() });
        assert_eq!(Plot::from(panels).series_names(), ["srivc", "calm"]);
        let item = RowItem::new("trace", crate::figures::RowKind::Limit(1.0));
        let columns = vec![RowsColumn { rows: vec![vec![item]], ..RowsColumn::default() }];
        let rows = NamedRows { names: vec!["gusts".into()], columns, ..NamedRows::default() };
        assert_eq!(Plot::from(rows).series_names(), ["trace", "gusts"]);
        let map = CellMap {
            axis_titles: Default::default(),
            columns: Vec::new(),
            rows: Vec::new(),
            shades: Shades::Shares,
            panels: vec![(Some("map".into()), Vec::new()), (None, Vec::new())],
            note: None,
        };
        assert_eq!(Plot::from(map).series_names(), ["map"]);
    }

    #[test]
    fn an_axis_of_names_has_one_unit_each() {
        let (axis, _) = AxisSpec::of_names(vec!["35/5".into(), "5/1".into()]).axis(&Extents::default(), 0.1);
        assert_eq!((axis.labels().collect::<Vec<_>>(), axis.ends()), (vec!["35/5", "5/1"], (-0.5, 1.5)));
    }
}
