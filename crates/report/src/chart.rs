//! One pair of axes on the page: a chart of plotters, and the elements that all figures draw in it. Lines and areas are
//! clipped at the frame; markers and dots are drawn whole if they are inside it. Undefined values are omitted.

use plotters::chart::ChartContext;
use plotters::coord::cartesian::Cartesian2d;
use plotters::drawing::DrawingArea;
use plotters::element::{Circle, ErrorBar, IntoDynElement as _, PathElement, Polygon};
use plotters::series::LineSeries;
use plotters::style::{Color as _, RGBAColor};

use crate::axis::Axis;
use crate::backend::{Bounds, PlotResult, Svg, SvgGroup, UNITS_PER_POINT, units};
use crate::canvas::{Canvas, Element, PagePoint, Rect, Stroke, marker};
use crate::curve::PlotCurve;
use crate::palette::{BACKGROUND, CurveStyle, INK};
use crate::theme::Theme;

/// Chart of plotters with two axes, drawn as SVG.
pub(crate) type SvgChart = ChartContext<'static, Svg, Cartesian2d<Axis, Axis>>;

/// Distance beyond the frame, units, from which plotters moves points to the edge. It is large, so that the lines to
/// these points leave the frame at the correct places; the part beyond the frame is clipped.
const BEYOND: i32 = 1_000_000;

/// Framed pair of axes on the page.
pub(crate) struct Chart {
    data: DrawingArea<Svg, Cartesian2d<Axis, Axis>>,
    pub canvas: Canvas,
    pub rect: Rect,
    pub x: Axis,
    pub y: Axis,
}

/// Horizontal bar of an interval.
pub(crate) struct Bar {
    /// Height of the interval, a value of the vertical axis.
    pub y: f64,
    /// Ends of the interval, values of the horizontal axis.
    pub ends: [f64; 2],
    /// `true` if the interval has caps.
    pub is_capped: bool,
    pub stroke: Stroke,
}

impl Chart {
    /// Chart of plotters on a page, with its horizontal and its vertical axis.
    pub(crate) fn new(chart: &SvgChart, canvas: Canvas, [x, y]: [Axis; 2]) -> Self {
        let (across, down) = chart.plotting_area().get_pixel_range();
        let [left, right, top, bottom] =
            [across.start, across.end - 1, down.start, down.end - 1].map(|place| f64::from(place) / UNITS_PER_POINT);
        let rect = Rect { x: left, y: top, w: right - left, h: bottom - top };
        let wide = chart.plotting_area().strip_coord_spec().margin(-BEYOND, -BEYOND, -BEYOND, -BEYOND);
        Self { data: wide.apply_coord_spec(chart.as_coord_spec().clone()), canvas, rect, x, y }
    }

    /// Right end of the data, points: the beginning of the space for numbers, or the frame without such a space.
    pub(crate) fn data_right(&self) -> f64 {
        Some(self.x.last)
            .filter(|last| last.is_finite())
            .and_then(|last| self.page_x(last))
            .unwrap_or(self.rect.right())
    }

    /// Frame in units of the SVG.
    pub(crate) fn bounds(&self) -> Bounds {
        [self.rect.x, self.rect.y, self.rect.right(), self.rect.bottom()].map(units)
    }

    /// Horizontal page coordinate of a value, points; `None` if it is not on the scale.
    pub(crate) fn page_x(&self, x: f64) -> Option<f64> {
        let at = || f64::from(self.data.map_coordinate(&(x, self.y.ends().0)).0) / UNITS_PER_POINT;
        self.x.is_plottable(x).then(at)
    }

    /// Vertical page coordinate of a value, points; `None` if it is not on the scale.
    pub(crate) fn page_y(&self, y: f64) -> Option<f64> {
        let at = || f64::from(self.data.map_coordinate(&(self.x.ends().0, y)).1) / UNITS_PER_POINT;
        self.y.is_plottable(y).then(at)
    }

    /// Page point of a data point, also outside the frame; `None` if it is not on the scales.
    pub(crate) fn page_point(&self, x: f64, y: f64) -> Option<PagePoint> {
        self.unclipped_page_point(x, y).filter(|_| self.is_plottable(&(x, y)))
    }

    /// Page point of a data point; one below a logarithmic scale is put far beyond the lower end. `None` for NaN.
    pub(crate) fn unclipped_page_point(&self, x: f64, y: f64) -> Option<PagePoint> {
        let (across, up) = self.data.map_coordinate(&(x, y));
        (!x.is_nan() && !y.is_nan()).then_some((f64::from(across) / UNITS_PER_POINT, f64::from(up) / UNITS_PER_POINT))
    }

    /// Page point of a pair of values; `None` if it is not inside the frame.
    pub(crate) fn inside(&self, x: f64, y: f64) -> Option<PagePoint> {
        self.page_point(x, y).filter(|place| self.rect.contains(*place))
    }

    /// Draws elements at values of the axes, all in one group.
    pub(crate) fn draw(&self, group: SvgGroup, elements: impl IntoIterator<Item = Element<(f64, f64)>>) -> PlotResult {
        self.canvas.svg.begin(group);
        elements.into_iter().try_for_each(|element| self.data.draw(&element))?;
        self.canvas.svg.end();
        Ok(())
    }

    /// SVG group of the series `name` of the legend, clipped at the frame.
    fn cut(&self, name: Option<&str>) -> SvgGroup {
        SvgGroup { clip: Some(self.bounds()), ..SvgGroup::named(name) }
    }

    fn is_plottable(&self, (x, y): &(f64, f64)) -> bool {
        self.x.is_plottable(*x) && self.y.is_plottable(*y)
    }

    /// Draws a line through pairs, broken at pairs that are not on the scales.
    pub(crate) fn line(
        &self,
        name: Option<&str>,
        pairs: impl IntoIterator<Item = (f64, f64)>,
        stroke: Stroke,
    ) -> PlotResult {
        // An infinite value is far beyond the panel.
        let pairs = pairs.into_iter().map(|(x, y)| (x, y.clamp(-f64::MAX, f64::MAX)));
        let pairs: Vec<(f64, f64)> = pairs.collect();
        let parts = pairs.split(|pair| !self.is_plottable(pair)).filter(|part| part.len() > 1);
        let lines = parts.flat_map(|part| LineSeries::new(part.to_vec(), stroke.style()));
        self.draw(SvgGroup { dash: Some((stroke.dash, stroke.width)), ..self.cut(name) }, lines)
    }

    /// Draws the area between two curves.
    pub(crate) fn band(&self, name: Option<&str>, [lower, upper]: [&PlotCurve; 2], colour: RGBAColor) -> PlotResult {
        let edge = |curve: &PlotCurve| curve.finite_pairs().filter(|pair| self.is_plottable(pair)).collect::<Vec<_>>();
        self.area(name, edge(lower).into_iter().chain(edge(upper).into_iter().rev()), colour)
    }

    /// Draws the area with these corners.
    pub(crate) fn area(
        &self,
        name: Option<&str>,
        corners: impl IntoIterator<Item = (f64, f64)>,
        colour: RGBAColor,
    ) -> PlotResult {
        let area = Polygon::new(corners.into_iter().collect::<Vec<_>>(), colour.filled());
        self.draw(self.cut(name), [area.into_dyn()])
    }

    /// Draws a rectangle from its ends on both axes.
    pub(crate) fn rectangle(&self, [left, right]: [f64; 2], [low, high]: [f64; 2], colour: RGBAColor) -> PlotResult {
        self.area(None, [(left, low), (right, low), (right, high), (left, high)], colour)
    }

    /// Draws dots of `radius` points at the pairs inside the frame.
    pub(crate) fn dots(
        &self,
        name: Option<&str>,
        pairs: impl IntoIterator<Item = (f64, f64)>,
        radius: f64,
        colour: RGBAColor,
    ) -> PlotResult {
        let dot = |pair| Circle::new(pair, units(radius).max(1) as u32, colour.filled()).into_dyn();
        self.draw(SvgGroup::named(name), pairs.into_iter().filter(|&(x, y)| self.inside(x, y).is_some()).map(dot))
    }

    /// Draws a marker of `radius` points at a pair inside the frame, whole even on the frame.
    pub(crate) fn marker(&self, name: Option<&str>, x: f64, y: f64, radius: f64, style: &CurveStyle) -> PlotResult {
        let is_inside = self.inside(x, y).is_some();
        self.draw(SvgGroup::named(name), marker((x, y), radius, style).into_iter().filter(|_| is_inside))
    }

    /// Draws an interval with an arrow head at an end beyond the frame; returns whether there is such an end. An
    /// infinite end is beyond every frame.
    pub(crate) fn bar(&self, name: Option<&str>, bar: &Bar, theme: &Theme) -> PlotResult<bool> {
        let Bar { y, ends, is_capped, stroke } = *bar;
        let [lo, hi] = [ends[0].min(ends[1]), ends[0].max(ends[1])].map(|end| end.clamp(-f64::MAX, f64::MAX));
        let [Some((left, height)), Some((right, _))] = [lo, hi].map(|end| self.unclipped_page_point(end, y)) else {
            return Ok(false);
        };
        let width = units(theme.marker).max(2) as u32;
        let element = match is_capped {
            true => ErrorBar::new_horizontal(y, lo, lo, hi, stroke.style(), width).into_dyn(),
            false => PathElement::new(vec![(lo, y), (hi, y)], stroke.style()).into_dyn(),
        };
        self.draw(SvgGroup { is_interval: true, ..self.cut(name) }, [element])?;
        let slack = 0.1;
        let edges = [self.rect.x, self.data_right()];
        let beyond = [(left < edges[0] - slack, edges[0], -1.0), (right > edges[1] + slack, edges[1], 1.0)];
        for (_, edge, direction) in beyond.into_iter().filter(|end| end.0) {
            self.canvas.arrow_head((edge, height), (direction, 0.0), 0.6 * theme.small_font, stroke.colour)?;
        }
        Ok(beyond.iter().any(|end| end.0))
    }

    /// Draws a line from bottom to top, if its value `x` is inside the frame.
    pub(crate) fn vertical(&self, name: Option<&str>, x: f64, stroke: Stroke) -> PlotResult {
        let is_inside = self.page_x(x).is_some_and(|place| self.rect.contains((place, self.rect.y)));
        let (low, high) = self.y.ends();
        self.line(name, [(x, low), (x, high)].into_iter().filter(|_| is_inside), stroke)
    }

    /// Draws a line from left to right at the value `y`.
    pub(crate) fn horizontal(&self, y: f64, stroke: Stroke) -> PlotResult {
        let (low, high) = self.x.ends();
        self.line(None, [(low, y), (high, y)], stroke)
    }

    /// Draws the frame over the data, with two short slanted lines at the break of a logarithmic axis.
    pub(crate) fn frame(&self, theme: &Theme) -> PlotResult {
        let stroke = Stroke::solid(INK, theme.thin);
        self.canvas.outline(self.rect, stroke)?;
        let Rect { x, y: _, w, h } = self.rect;
        let breaks = [
            self.x.break_at().map(|share| ((x + share * w, self.rect.bottom()), (1.0, 0.0))),
            self.y.break_at().map(|share| ((x, self.rect.bottom() - share * h), (0.0, 1.0))),
        ];
        let size = 0.45 * theme.tick_font;
        for (centre, along) in breaks.into_iter().flatten() {
            // Perpendicular to the axis, slanted along it.
            let (dx, dy) = (size * (along.1 + 0.4 * along.0), size * (along.0 + 0.4 * along.1));
            let [one, other] = [-0.35, 0.35].map(|side| {
                let (x, y) = (centre.0 + side * size * along.0, centre.1 + side * size * along.1);
                [(x - dx, y + dy), (x + dx, y - dy)]
            });
            self.canvas.fill(&[one[0], one[1], other[1], other[0]], BACKGROUND, 1.0)?;
            [one, other].iter().try_for_each(|ends| self.canvas.line(ends, stroke))?;
        }
        Ok(())
    }
}
