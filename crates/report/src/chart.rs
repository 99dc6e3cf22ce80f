//! One pair of axes on the page: a chart of plotters, and what every figure draws in it. Everything is cut at the
//! frame; undefined values are left out.

use plotters::chart::ChartContext;
use plotters::coord::cartesian::Cartesian2d;
use plotters::drawing::DrawingArea;
use plotters::element::{Circle, ErrorBar, IntoDynElement as _, PathElement, Polygon};
use plotters::series::LineSeries;
use plotters::style::{Color as _, RGBAColor, RGBColor};

use crate::axis::Axis;
use crate::backend::{Bounds, Drawn, Group, Svg, UNITS, units};
use crate::canvas::{Canvas, Element, PagePoint, Rect, Stroke, marker};
use crate::curve::PlotCurve;
use crate::palette::{INK, Look, PAPER};
use crate::theme::Theme;

/// A chart of plotters.
pub(crate) type Context = ChartContext<'static, Svg, Cartesian2d<Axis, Axis>>;

/// Distance beyond the frame, units, from which on plotters moves what is drawn to the edge; all beyond the frame is
/// cut, so lines leave it where they do.
const BEYOND: i32 = 1_000_000;

/// A rectangle with two axes.
pub(crate) struct Chart {
    data: DrawingArea<Svg, Cartesian2d<Axis, Axis>>,
    pub canvas: Canvas,
    pub rect: Rect,
    pub x: Axis,
    pub y: Axis,
}

impl Chart {
    /// The chart on the page.
    pub(crate) fn new(context: &Context, canvas: Canvas, [x, y]: [Axis; 2]) -> Self {
        let (across, down) = context.plotting_area().get_pixel_range();
        let [left, right, top, bottom] =
            [across.start, across.end - 1, down.start, down.end - 1].map(|place| f64::from(place) / UNITS);
        let rect = Rect { x: left, y: top, w: right - left, h: bottom - top };
        let wide = context.plotting_area().strip_coord_spec().margin(-BEYOND, -BEYOND, -BEYOND, -BEYOND);
        Self { data: wide.apply_coord_spec(context.as_coord_spec().clone()), canvas, rect, x, y }
    }

    /// The frame in units.
    pub(crate) fn bounds(&self) -> Bounds {
        [self.rect.x, self.rect.y, self.rect.right(), self.rect.bottom()].map(units)
    }

    /// Horizontal place of a value.
    pub(crate) fn across(&self, x: f64) -> Option<f64> {
        let at = || f64::from(self.data.map_coordinate(&(x, self.y.middle())).0) / UNITS;
        self.x.has_place(x).then(at)
    }

    /// Vertical place of a value.
    pub(crate) fn up(&self, y: f64) -> Option<f64> {
        let at = || f64::from(self.data.map_coordinate(&(self.x.middle(), y)).1) / UNITS;
        self.y.has_place(y).then(at)
    }

    /// Place of a pair of values, also outside the frame.
    pub(crate) fn place(&self, (x, y): (f64, f64)) -> Option<PagePoint> {
        Some((self.across(x)?, self.up(y)?))
    }

    /// Place of a pair of values inside the frame.
    pub(crate) fn inside(&self, pair: (f64, f64)) -> Option<PagePoint> {
        self.place(pair).filter(|place| self.rect.contains(*place))
    }

    /// Draws elements at values, all that belong to a group.
    pub(crate) fn draw(&self, group: Group, elements: impl IntoIterator<Item = Element<(f64, f64)>>) -> Drawn {
        self.canvas.svg.begin(group);
        elements.into_iter().try_for_each(|element| self.data.draw(&element))?;
        self.canvas.svg.end();
        Ok(())
    }

    /// The group of a series of the key, cut at the frame.
    fn cut(&self, name: Option<&str>) -> Group {
        Group { clip: Some(self.bounds()), ..Group::named(name) }
    }

    /// A line through pairs, broken at gaps.
    pub(crate) fn line(
        &self,
        name: Option<&str>,
        pairs: impl IntoIterator<Item = (f64, f64)>,
        stroke: Stroke,
    ) -> Drawn {
        let pairs: Vec<(f64, f64)> = pairs.into_iter().collect();
        let has_place: Vec<bool> = pairs.iter().map(|(x, y)| self.x.has_place(*x) && self.y.has_place(*y)).collect();
        let mut start = 0;
        let runs = has_place.chunk_by(|one, next| one == next).map(|run| {
            start += run.len();
            (run[0], start - run.len()..start)
        });
        let parts = runs.filter(|(is_drawn, _)| *is_drawn).map(|(_, rows)| pairs[rows].to_vec());
        let lines = parts.flat_map(|part| LineSeries::new(part, stroke.style()));
        self.draw(Group { dash: Some((stroke.dash, stroke.width)), ..self.cut(name) }, lines)
    }

    /// The area between two curves.
    pub(crate) fn band(
        &self,
        name: Option<&str>,
        [lower, upper]: [&PlotCurve; 2],
        colour: RGBColor,
        opacity: f64,
    ) -> Drawn {
        let has_place = |(x, y): &(f64, f64)| self.x.has_place(*x) && self.y.has_place(*y);
        let edge = |curve: &PlotCurve| curve.finite().filter(has_place).collect::<Vec<_>>();
        let outline: Vec<(f64, f64)> = edge(lower).into_iter().chain(edge(upper).into_iter().rev()).collect();
        self.area(name, outline, colour, opacity)
    }

    /// An area with these corners.
    pub(crate) fn area(&self, name: Option<&str>, corners: Vec<(f64, f64)>, colour: RGBColor, opacity: f64) -> Drawn {
        self.draw(self.cut(name), [Polygon::new(corners, colour.mix(opacity).filled()).into_dyn()])
    }

    /// Dots at pairs inside the frame.
    pub(crate) fn dots(
        &self,
        name: Option<&str>,
        pairs: impl IntoIterator<Item = (f64, f64)>,
        radius: f64,
        colour: RGBAColor,
    ) -> Drawn {
        let dot = |pair| Circle::new(pair, units(radius).max(1) as u32, colour.filled()).into_dyn();
        self.draw(Group::named(name), pairs.into_iter().filter(|pair| self.inside(*pair).is_some()).map(dot))
    }

    /// Markers at pairs inside the frame, whole where they stand on it.
    pub(crate) fn markers(&self, name: Option<&str>, pairs: &[(f64, f64)], radius: f64, look: &Look) -> Drawn {
        let markers = pairs.iter().filter(|pair| self.inside(**pair).is_some());
        self.draw(Group::named(name), markers.flat_map(|pair| marker(*pair, radius, look)))
    }

    /// An interval from left to right at height `y` about a marked value, with an arrow head of `head` points at an end
    /// that lies beyond the frame; returns whether one does. An end without bound lies beyond every frame. Without a
    /// mark there are no caps.
    pub(crate) fn bar(
        &self,
        name: Option<&str>,
        (y, ends, marked): (f64, [f64; 2], Option<f64>),
        stroke: Stroke,
        (cap, head): (f64, f64),
    ) -> Drawn<bool> {
        let [lo, hi] = [ends[0].min(ends[1]), ends[0].max(ends[1])].map(|end| end.clamp(-f64::MAX, f64::MAX));
        let line = || PathElement::new(vec![(lo, y), (hi, y)], stroke.style()).into_dyn();
        // The ring that plotters draws at the value lies below the mark.
        let width = units(cap).max(2) as u32;
        let capped = |value| ErrorBar::new_horizontal(y, lo, value, hi, stroke.style(), width).into_dyn();
        let (Some(left), Some(right)) = (self.across(lo), self.across(hi)) else { return Ok(false) };
        let bar = marked.filter(|value| value.is_finite()).map_or_else(line, capped);
        self.draw(Group { is_interval: true, ..self.cut(name) }, [bar])?;
        let height = self.up(y).unwrap_or(f64::NAN);
        let Rect { x, .. } = self.rect;
        let slack = 0.1;
        let beyond = [(left < x - slack, x, -1.0), (right > self.rect.right() + slack, self.rect.right(), 1.0)];
        for (_, edge, direction) in beyond.into_iter().filter(|end| end.0) {
            self.canvas.head((edge, height), (direction, 0.0), head, stroke.colour)?;
        }
        Ok(beyond.iter().any(|end| end.0))
    }

    /// A line from bottom to top.
    pub(crate) fn vertical(&self, name: Option<&str>, x: f64, stroke: Stroke) -> Drawn {
        let (low, high) = self.y.ends();
        if !self.across(x).is_some_and(|place| self.rect.contains((place, self.rect.y))) {
            return Ok(());
        }
        self.line(name, [(x, low), (x, high)], stroke)
    }

    /// A line from left to right.
    pub(crate) fn horizontal(&self, y: f64, stroke: Stroke) -> Drawn {
        let (low, high) = self.x.ends();
        self.line(None, [(low, y), (high, y)], stroke)
    }

    /// The frame over the data, with two short slanted lines where a logarithmic axis jumps to zero.
    pub(crate) fn frame(&self, theme: &Theme) -> Drawn {
        self.canvas.outline(self.rect, Stroke::solid(INK, theme.thin))?;
        let size = 0.45 * theme.tick_font;
        let mark = |centre: PagePoint, along: PagePoint| {
            // Perpendicular to the axis, leaning along it.
            let (dx, dy) = (along.1 + 0.4 * along.0, along.0 + 0.4 * along.1);
            let slant = |side: f64| {
                let (x, y) = (centre.0 + side * size * along.0, centre.1 + side * size * along.1);
                [(x - size * dx, y + size * dy), (x + size * dx, y - size * dy)]
            };
            let [one, other] = [slant(-0.35), slant(0.35)];
            self.canvas.fill(&[one[0], one[1], other[1], other[0]], PAPER, 1.0)?;
            [one, other].iter().try_for_each(|ends| self.canvas.line(ends, Stroke::solid(INK, theme.thin)))
        };
        if let Some(fraction) = self.x.break_at() {
            mark((self.rect.x + fraction * self.rect.w, self.rect.bottom()), (1.0, 0.0))?;
        }
        if let Some(fraction) = self.y.break_at() {
            mark((self.rect.x, self.rect.bottom() - fraction * self.rect.h), (0.0, 1.0))?;
        }
        Ok(())
    }
}
