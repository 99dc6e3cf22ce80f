//! Panels of layers (lines, bands, records, marks) over numeric axes: stacked over one axis where they belong to the
//! same one, in rows and columns where they share both, as small multiples where all are alike, side by side where they
//! have nothing in common. What a figure shows is data; [`super::layers`] draws it.

use super::reach::{AxisReach, Extents};
use super::shared::{Reference95, record_sample};
pub use crate::axis::Division;

use plotters::style::RGBColor;

use crate::axis::Axis;
use crate::canvas::Stroke;
use crate::curve::PlotCurve;
use crate::key::KeySample;
use crate::markup::symbol;
use crate::palette::{CurveOrigin, Dash, HEADING, Look, SOLID};
use crate::theme::Theme;

/// An axis: its title with the unit, how it is divided and how far it goes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ruler {
    /// Title with unit.
    pub title: String,
    /// Division.
    pub division: Division,
    /// How far it goes where the data are wild; `None`: all the way.
    pub reach: Option<AxisReach>,
}

impl Ruler {
    /// An axis over everything.
    pub fn new(title: impl Into<String>, division: Division) -> Self {
        Self { title: title.into(), division, reach: None }
    }

    /// Decimal numbers.
    pub fn decimal(title: impl Into<String>) -> Self {
        Self::new(title, Division::Decimal)
    }

    /// Time in seconds.
    pub fn time() -> Self {
        Self::new(format!("time {} [s]", symbol("t")), Division::Time)
    }

    /// Heading in degrees.
    pub fn heading() -> Self {
        Self::new(format!("heading {} [°]", symbol("ψ")), Division::Angle)
    }

    /// Rudder in degrees.
    pub fn rudder() -> Self {
        Self::new(format!("rudder {} [°]", symbol("δ")), Division::Angle)
    }

    /// Yaw rate in degrees a second.
    pub fn yaw_rate() -> Self {
        Self::decimal(format!("yaw rate {} [°/s]", symbol("r")))
    }

    /// The same axis, as far as so many times the middle extent of the data from a centre.
    pub fn within(self, times: f64, centre: Option<f64>) -> Self {
        Self { reach: Some(AxisReach { times, centre, symmetric: false }), ..self }
    }

    /// The same about zero, as far to one side as to the other.
    pub fn about_zero(self, times: f64) -> Self {
        Self { reach: Some(AxisReach { times, centre: Some(0.0), symmetric: true }), ..self }
    }

    /// The axis over some data with free space at the ends; and whether something is cut.
    pub(super) fn axis(&self, data: &Extents, pad: f64) -> (Axis, bool) {
        match self.division {
            Division::Factors => return (Axis::log_covering(&data.positive()), false),
            Division::Percent => return (Axis::linear(-3.0, 103.0, Division::Percent), false),
            _ => {}
        }
        let pad = if self.division == Division::Time { 0.0 } else { pad };
        let (ends, is_cut) = data.ends(self.reach);
        (Axis::covering(ends.into_iter().flat_map(|(lo, hi)| [lo, hi]), pad, self.division), is_cut)
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pen {
    /// Colour.
    pub colour: RGBColor,
    /// In usual widths.
    pub width: f64,
    /// Dashes.
    pub dash: Dash,
    /// From 0 to 1.
    pub opacity: f64,
}

impl Pen {
    /// A solid line.
    pub const fn new(colour: RGBColor) -> Self {
        Self { colour, width: 1.0, dash: SOLID, opacity: 1.0 }
    }

    /// The line of an origin.
    pub fn of(origin: &CurveOrigin) -> Self {
        let look = origin.look();
        Self { dash: look.dash, ..Self::new(look.colour) }
    }

    /// One of many lines: thin and pale.
    pub const fn pale() -> Self {
        Self { width: 0.6, opacity: 0.35, ..Self::new(HEADING) }
    }

    /// The same line in another width.
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
    /// How they look.
    pub look: Look,
    /// Their intervals, where they have some.
    pub intervals: Vec<Option<[f64; 2]>>,
    /// The line that joins them.
    pub joined: Option<Pen>,
    /// `true` if marks that would hide each other stand side by side.
    pub apart: bool,
}

/// How the points of a layer are drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum LayerKind {
    /// A line through them.
    Line(Pen),
    /// The area between them and another curve, in a colour and as dense as is said.
    Band(PlotCurve, RGBColor, f64),
    /// A record: dots, or a wide line where it is dense.
    Record,
    /// Small dots. Single ones far from all others do not set the axis: an arrow at its edge stands for them.
    Dots(RGBColor),
    /// Pale dots that set no axis; those outside are counted in the corner of the panel.
    Cloud(RGBColor),
    /// Marks with intervals. A value without bound is an arrow at the edge.
    Marks(Marks),
    /// Ships seen from above, with these headings in degrees.
    Ships(RGBColor, Vec<f64>),
    /// Words beside the points, above them at their right, or below them at their left.
    Words(RGBColor, bool, Vec<String>),
}

/// One thing in a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Its name in the key; layers of one name are told once.
    pub name: Option<String>,
    /// The points.
    pub curve: PlotCurve,
    /// How they are drawn.
    pub kind: LayerKind,
    /// Share of the range of everything else by which it may widen the axes before it is cut; `None`: never cut.
    pub room: Option<f64>,
}

impl Layer {
    /// A layer that sets the axes.
    pub fn new(name: impl Into<String>, curve: PlotCurve, kind: LayerKind) -> Self {
        let name = Some(name.into()).filter(|name| !name.is_empty());
        Self { name, curve, kind, room: None }
    }

    /// A line.
    pub fn line(name: impl Into<String>, curve: PlotCurve, pen: Pen) -> Self {
        Self::new(name, curve, LayerKind::Line(pen))
    }

    /// The area between two curves.
    pub fn band(name: impl Into<String>, [lower, upper]: [PlotCurve; 2], colour: RGBColor, opacity: f64) -> Self {
        Self::new(name, lower, LayerKind::Band(upper, colour, opacity))
    }

    /// Points with the middle of each, its value and its interval.
    pub fn marks(name: impl Into<String>, look: Look, points: Vec<(f64, f64, Option<[f64; 2]>)>) -> Self {
        let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|(x, y, _)| (*x, *y)).unzip();
        let intervals = points.into_iter().map(|(.., interval)| interval).collect();
        Self::new(name, PlotCurve { x, y }, LayerKind::Marks(Marks { look, intervals, joined: None, apart: false }))
    }

    /// The same marks, joined by a line.
    pub fn joined(mut self, pen: Pen) -> Self {
        if let LayerKind::Marks(marks) = &mut self.kind {
            marks.joined = Some(pen);
        }
        self
    }

    /// The same marks, side by side where they would hide each other.
    pub fn apart(mut self) -> Self {
        if let LayerKind::Marks(marks) = &mut self.kind {
            marks.apart = true;
        }
        self
    }

    /// The same, cut where it leaves the range of everything else by more than this share of it.
    pub fn within(self, room: f64) -> Self {
        Self { room: Some(room), ..self }
    }

    pub(super) fn curves(&self) -> impl Iterator<Item = &PlotCurve> {
        let other = if let LayerKind::Band(other, ..) = &self.kind { Some(other) } else { None };
        [&self.curve].into_iter().chain(other)
    }

    pub(super) fn colour(&self) -> RGBColor {
        match &self.kind {
            LayerKind::Line(pen) => pen.colour,
            LayerKind::Band(_, colour, _) | LayerKind::Dots(colour) => *colour,
            LayerKind::Cloud(colour) | LayerKind::Ships(colour, _) | LayerKind::Words(colour, ..) => *colour,
            LayerKind::Marks(marks) => marks.look.colour,
            LayerKind::Record => crate::palette::RECORD,
        }
    }

    /// How it looks in the key; a band where others lie under it as dense as `shade`.
    pub(super) fn sample(&self, theme: &Theme, shade: f64) -> Option<KeySample> {
        Some(match &self.kind {
            LayerKind::Line(pen) => KeySample::Line(pen.stroke(theme)),
            LayerKind::Band(_, colour, _) => {
                KeySample::Line(Stroke { opacity: shade, ..Stroke::solid(*colour, 0.8 * theme.small_font) })
            }
            LayerKind::Record if self.curve.finite().next().is_none() => return None,
            LayerKind::Record => record_sample(theme, &self.curve),
            LayerKind::Dots(colour) | LayerKind::Cloud(colour) => KeySample::Dots(*colour),
            LayerKind::Marks(Marks { look, joined: Some(pen), .. }) => {
                KeySample::LineAndMarker(pen.stroke(theme), *look)
            }
            LayerKind::Marks(Marks { look, .. }) => KeySample::Marker(*look),
            LayerKind::Words(..) => return None,
            LayerKind::Ships(..) if self.curve.finite().next().is_none() => return None,
            LayerKind::Ships(colour, _) => KeySample::Hull(*colour),
        })
    }
}

/// A row of panels with a common vertical axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PanelRow {
    /// Vertical axis.
    pub y: Ruler,
    /// Height, as a share of the width of the figure.
    pub height: f64,
    /// `true` if there is a line at zero.
    pub zero: bool,
    /// Dashed lines from left to right, such as the ends of what chance leaves.
    pub levels: Vec<f64>,
    /// A value to compare with.
    pub reference: Option<Reference95>,
    /// Shares of the height that are left free below and above the data.
    pub room: [f64; 2],
}

impl PanelRow {
    /// A row.
    pub fn new(y: Ruler, height: f64) -> Self {
        Self { y, height, ..Self::default() }
    }

    /// A row with a line at zero.
    pub fn zeroed(y: Ruler, height: f64) -> Self {
        Self { zero: true, ..Self::new(y, height) }
    }
}

/// A panel.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LayeredPanel {
    /// A line above it.
    pub head: Option<String>,
    /// The layers, the first at the bottom.
    pub layers: Vec<Layer>,
}

/// A value of the horizontal axis, such as a limit of a rule.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisLine {
    /// The value.
    pub at: f64,
    /// Its name in the key; nothing if it has none.
    pub label: String,
}

/// Panels with common axes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stack {
    /// Horizontal axes, one a column.
    pub x: Vec<Ruler>,
    /// The rows.
    pub rows: Vec<PanelRow>,
    /// The panels, row by row.
    pub panels: Vec<LayeredPanel>,
    /// Lines from bottom to top.
    pub marks: Vec<AxisLine>,
    /// Small multiples, so many side by side: the one axis and the one row are those of all.
    pub across: Option<usize>,
    /// `true` if these stay side by side on a narrow page, too: a row of them is one thing.
    pub unbroken: bool,
    /// `true` if it takes half the width of the figure; two of them stand side by side where there is room.
    pub is_half: bool,
    /// `true` if there is a line at zero from bottom to top.
    pub zero: bool,
    /// `true` if one unit is as long on one axis as on the other.
    pub equal: bool,
}

impl Stack {
    /// Panels above each other over one horizontal axis.
    pub fn over(x: Ruler, rows: Vec<(PanelRow, Vec<Layer>)>) -> Self {
        let (rows, layers): (Vec<PanelRow>, Vec<Vec<Layer>>) = rows.into_iter().unzip();
        let panels = layers.into_iter().map(|layers| LayeredPanel { head: None, layers }).collect();
        Self { x: vec![x], rows, panels, ..Self::default() }
    }

    /// Panels with one pair of axes, so many side by side.
    pub fn multiples(across: usize, x: Ruler, row: PanelRow, panels: Vec<LayeredPanel>) -> Self {
        Self { x: vec![x], rows: vec![row], panels, across: Some(across), ..Self::default() }
    }
}

/// What [`super::Plot::Panels`] draws.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panels {
    /// The stacks, in reading order.
    pub stacks: Vec<Stack>,
    /// `true` if names stand right of the frame, in place of a key; on a narrow page they are in the key all the same.
    pub names_aside: bool,
    /// Numbers that stand in the key.
    pub said: Vec<String>,
    /// A remark under the figure.
    pub note: Option<String>,
    /// A remark where a layer is cut.
    pub cut: Option<String>,
}

impl Panels {
    /// A figure of one stack.
    pub fn of(stack: Stack) -> Self {
        Self { stacks: vec![stack], ..Self::default() }
    }

    /// Panels above each other over time.
    pub fn over_time(rows: Vec<(PanelRow, Vec<Layer>)>) -> Self {
        Self::of(Stack::over(Ruler::time(), rows))
    }
}
