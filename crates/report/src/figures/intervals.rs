//! Estimates of K and T with their 95 % intervals, one row per method, against the truth and the published value.

use serde::{Deserialize, Serialize};

use super::shared::median;
use crate::axis::Axis;
use crate::colour::Colour;
use crate::dimension::Dimensions;
use crate::figure::Figure;
use crate::layout::{Sheet, Side};
use crate::legend::{Entry, Sample, stroke_of};
use crate::markup::symbol;
use crate::number;
use crate::palette::{INK, Look, Origin, RECORD};
use crate::panel::Panel;
use crate::scene::{Anchor, Layer, Scene, Stroke, Text};
use crate::theme::Theme;
use crate::ticks::Steps;

/// A value and, where the method gives one, its interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PointEstimate {
    /// The value.
    pub value: f64,
    /// 95 % interval.
    pub interval: Option<[f64; 2]>,
}

/// What one method found; `None` where it found nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MethodEstimate {
    /// The method; decides how its row looks.
    pub origin: Origin,
    /// Gain, 1/s.
    pub k_per_s: Option<PointEstimate>,
    /// Time constant, s.
    pub t_s: Option<PointEstimate>,
}

/// A pair of values to compare with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Gain, 1/s.
    pub k_per_s: f64,
    /// Time constant, s.
    pub t_s: f64,
}

/// What [`intervals`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Intervals {
    /// Title above the figure.
    pub title: Option<String>,
    /// The estimates, from top to bottom.
    pub estimates: Vec<MethodEstimate>,
    /// The parameters the trial was simulated with.
    pub truth: Option<Reference>,
    /// The parameters printed in the literature.
    pub published: Option<Reference>,
}

/// The axis reaches this many times the usual spread from the middle; what lies beyond is an outlier.
const SPREADS: f64 = 7.0;

/// One of the two panels.
struct Quantity {
    title: String,
    estimates: Vec<Option<PointEstimate>>,
    truth: Option<f64>,
    published: Option<f64>,
}

impl Quantity {
    fn references(&self) -> impl Iterator<Item = f64> {
        [self.truth, self.published].into_iter().flatten().filter(|v| v.is_finite())
    }

    /// Covers references, values and intervals, without those so far off that the others would shrink to a point.
    fn axis(&self) -> Axis {
        let values: Vec<f64> = self.known().map(|e| e.value).collect();
        let half_widths = self.known().filter_map(|e| e.interval).map(|[lo, hi]| (hi - lo).abs() / 2.0);
        let centre = self.truth.filter(|v| v.is_finite()).or_else(|| median(values.iter().copied())).unwrap_or(0.0);
        let deviation = median(values.iter().map(|v| (v - centre).abs())).unwrap_or(0.0);
        let spread = median(half_widths).unwrap_or(0.0).max(deviation).max(1e-3 * centre.abs());
        let window = (centre - SPREADS * spread, centre + SPREADS * spread);
        let inside = values.iter().copied().filter(|v| (window.0..=window.1).contains(v));
        let ends = self.known().filter_map(|e| e.interval).flatten().map(|v| v.clamp(window.0, window.1));
        Axis::covering(inside.chain(ends).chain(self.references()), 0.06, Steps::Decimal)
    }

    fn known(&self) -> impl Iterator<Item = &PointEstimate> {
        self.estimates.iter().flatten().filter(|e| e.value.is_finite())
    }
}

/// Draws K and T side by side (one above the other when the figure is narrow).
///
/// An estimate without interval is a dot, a method without estimate says so, and an estimate beyond the axis is an
/// arrow with its number.
pub fn intervals(data: &Intervals, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let names: Vec<String> = data.estimates.iter().map(|e| e.origin.label().to_owned()).collect();
    let height = (names.len().max(2) as f64 + 0.4) * 2.0 * theme.tick_font;
    let quantities = quantities(data);
    let sides = quantities.iter().map(|q| Side::new(q.axis(), q.title.clone()));
    let panels = sheet.side_by_side(sides, (Side::new(Axis::names(names), ""), height));
    let mut beyond = false;
    for (panel, quantity) in panels.iter().zip(&quantities) {
        for (value, origin) in [(quantity.published, Origin::Published), (quantity.truth, Origin::Truth)] {
            if let Some(value) = value {
                panel.vertical(&mut sheet.scene, Layer::Data, value, reference_stroke(&origin, theme));
            }
        }
        for (row, (estimate, method)) in quantity.estimates.iter().zip(&data.estimates).enumerate() {
            let look = method.origin.look();
            beyond |= draw_row(panel, &mut sheet.scene, theme, row, *estimate, &look);
        }
    }
    if let Some(text) = remark(data, beyond) {
        sheet.note(&text);
    }
    sheet.finish()
}

fn quantities(data: &Intervals) -> [Quantity; 2] {
    [
        Quantity {
            title: format!("{} [1/s]", symbol("K")),
            estimates: data.estimates.iter().map(|e| e.k_per_s).collect(),
            truth: data.truth.map(|r| r.k_per_s),
            published: data.published.map(|r| r.k_per_s),
        },
        Quantity {
            title: format!("{} [s]", symbol("T")),
            estimates: data.estimates.iter().map(|e| e.t_s).collect(),
            truth: data.truth.map(|r| r.t_s),
            published: data.published.map(|r| r.t_s),
        },
    ]
}

fn reference_stroke(origin: &Origin, theme: &Theme) -> Stroke {
    Stroke { width: 0.8 * theme.line, ..stroke_of(origin, theme) }
}

fn entries(data: &Intervals, theme: &Theme) -> Vec<Entry> {
    let line = |origin: Origin| Entry::new(Sample::Line(reference_stroke(&origin, theme)), origin.label());
    let truth = data.truth.map(|_| line(Origin::Truth));
    truth.into_iter().chain(data.published.map(|_| line(Origin::Published))).collect()
}

/// Draws one estimate; tells whether something lies beyond the axis.
fn draw_row(
    panel: &Panel,
    scene: &mut Scene,
    theme: &Theme,
    row: usize,
    estimate: Option<PointEstimate>,
    look: &Look,
) -> bool {
    let Some(y) = panel.up(row as f64) else { return false };
    let rect = panel.rect;
    let text = |label: &str, colour: Colour| Text::new(label, theme.small_font).colour(colour);
    let Some((estimate, x)) = estimate.and_then(|e| Some((e, panel.across(e.value)?))) else {
        let label = text("no estimate", RECORD).anchor(Anchor::Middle);
        let place = (rect.x + rect.w / 2.0, y + label.centring());
        scene.text_on_ground(Layer::Note, place, label);
        return false;
    };
    let mut beyond = bar(panel, scene, theme, y, estimate.interval, look.colour);
    if rect.contains((x, y)) {
        scene.marker(Layer::Data, (x, y), 1.15 * theme.marker, look);
    } else {
        beyond = true;
        let to_the_right = x > rect.x;
        let (edge, direction) = if to_the_right { (rect.right(), 1.0) } else { (rect.x, -1.0) };
        let size = 0.7 * theme.small_font;
        let tip = edge - direction * 0.3 * theme.small_font;
        Dimensions::head(scene, (tip, y), (direction, 0.0), size, look.colour);
        let label = text(&number::significant(estimate.value, 3), INK);
        let anchor = if to_the_right { Anchor::End } else { Anchor::Start };
        let place = (tip - direction * 1.3 * size, y + label.centring());
        scene.text_on_ground(Layer::Note, place, label.anchor(anchor));
    }
    beyond
}

/// The interval as a bar with caps; an end beyond the axis is an arrow head. Tells whether one was.
fn bar(panel: &Panel, scene: &mut Scene, theme: &Theme, y: f64, interval: Option<[f64; 2]>, colour: Colour) -> bool {
    let Some(ends) = interval else { return false };
    let (stroke, cap) = (Stroke::solid(colour, theme.line), 0.9 * theme.marker);
    for x in ends.into_iter().filter_map(|end| panel.across(end)).filter(|x| panel.rect.contains((*x, y))) {
        scene.line(Layer::Data, [(x, y - cap), (x, y + cap)], stroke);
    }
    panel.bar(scene, y, ends, stroke, 0.6 * theme.small_font)
}

fn remark(data: &Intervals, beyond: bool) -> Option<String> {
    let has_interval = |e: &Option<PointEstimate>| e.is_some_and(|e| e.interval.is_some());
    let any = |wanted: fn(&PointEstimate) -> bool| {
        data.estimates.iter().flat_map(|e| [e.k_per_s, e.t_s]).flatten().any(|e| wanted(&e))
    };
    let mut parts = Vec::new();
    if data.estimates.iter().any(|e| has_interval(&e.k_per_s) || has_interval(&e.t_s)) {
        parts.push("Bars: 95 % intervals.");
    }
    if any(|e| e.interval.is_none()) {
        parts.push("Without bar: the method gives no interval.");
    }
    if beyond {
        parts.push("Arrows: beyond the axis.");
    }
    (!parts.is_empty()).then(|| parts.join(" "))
}
