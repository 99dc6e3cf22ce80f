//! Errors of K and T together: the cloud of each method with its 95 % ellipse, beside the ellipse of the Cramér–Rao
//! bound.

use serde::{Deserialize, Serialize};

use super::shared::{median, zero_line, zero_upright};
use crate::axis::Axis;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample, stroke_of};
use crate::markup::symbol;
use crate::palette::{INK, Origin};
use crate::panel::Panel;
use crate::scene::{Anchor, Layer, Scene, Stroke, Text};
use crate::theme::Theme;
use crate::ticks::Steps;

/// The 95 % contour of a normal distribution in two dimensions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ellipse {
    /// Its centre, errors of K and T in per cent.
    pub centre: (f64, f64),
    /// Covariance of the errors, per cent squared.
    pub covariance: [[f64; 2]; 2],
}

/// One method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KtPanel {
    /// Whose errors.
    pub origin: Origin,
    /// Errors of K and T, per cent.
    pub points: Vec<(f64, f64)>,
    /// Their ellipse.
    pub ellipse: Option<Ellipse>,
    /// Ellipse of the bound.
    pub bound: Option<Ellipse>,
}

/// What [`scatter`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct KtScatter {
    /// Title above the figure.
    pub title: Option<String>,
    /// One panel a method.
    pub panels: Vec<KtPanel>,
}

/// 95 % quantile of χ² with two degrees of freedom.
const CONTOUR: f64 = 5.991_464_547;

/// Corners of a drawn ellipse.
const CORNERS: usize = 96;

/// Half the width of the axes over the middle one of the ellipses.
const REACH: f64 = 2.2;

impl Ellipse {
    /// Points of the contour, closed; nothing when the covariance is none.
    fn contour(&self) -> Vec<(f64, f64)> {
        let [[a, b], [_, c]] = self.covariance;
        // Cholesky: a point of the unit circle goes to L times it.
        let l11 = a.sqrt();
        let l21 = b / l11;
        let l22 = (c - l21 * l21).max(0.0).sqrt();
        if !(l11 > 0.0 && l21.is_finite() && l22.is_finite()) {
            return Vec::new();
        }
        let radius = CONTOUR.sqrt();
        let corner = |k: usize| {
            let angle = 2.0 * std::f64::consts::PI * k as f64 / CORNERS as f64;
            let (u, v) = (radius * angle.cos(), radius * angle.sin());
            (self.centre.0 + l11 * u, self.centre.1 + l21 * u + l22 * v)
        };
        (0..=CORNERS).map(corner).collect()
    }

    /// Largest distance from zero along both axes.
    fn reach(&self) -> [f64; 2] {
        let half = |variance: f64| (CONTOUR * variance.max(0.0)).sqrt();
        [self.centre.0.abs() + half(self.covariance[0][0]), self.centre.1.abs() + half(self.covariance[1][1])]
    }
}

/// Draws small panels with common axes.
pub fn scatter(data: &KtScatter, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let bound = Entry::new(Sample::Line(bound_stroke(theme)), "Cramér–Rao bound, 95 %");
    let own = Entry::new(Sample::Line(Stroke::solid(INK, theme.line)), "method, 95 %");
    let with_bound = data.panels.iter().any(|panel| panel.bound.is_some());
    sheet.legend(&if with_bound { vec![own, bound] } else { vec![own] });
    let count = data.panels.len().max(1);
    let across = if theme.is_narrow() { count.min(2) } else { count.min(if count == 4 { 2 } else { 3 }) };
    let [k, t] = reach(data);
    let title = |index: &str| format!("error of {} [%]", symbol(index));
    let column = Side::new(Axis::linear(-k, k, Steps::Decimal), title("K"));
    let height = theme.tall(if theme.is_narrow() { 0.26 } else { 0.24 });
    let row = (Side::new(Axis::linear(-t, t, Steps::Decimal), title("T")), height);
    let heads = data
        .panels
        .iter()
        .map(|panel| Some(Entry::new(Sample::Dots(panel.origin.look().colour), panel.origin.label())));
    let panels = sheet.grid(Grid { heads: heads.collect(), ..Grid::alike(count, across, column, row) });
    for (panel, content) in panels.iter().zip(&data.panels) {
        zero_line(panel, &mut sheet.scene, theme);
        zero_upright(panel, &mut sheet.scene, theme);
        draw(panel, &mut sheet.scene, theme, content);
    }
    sheet.finish()
}

fn bound_stroke(theme: &Theme) -> Stroke {
    Stroke { width: 1.2 * theme.line, ..stroke_of(&Origin::Bound, theme) }
}

/// Half the widths of the common axes: the middle one of the methods decides, so that a wild one does not hide the
/// others, but no less than the bound needs.
fn reach(data: &KtScatter) -> [f64; 2] {
    [0, 1].map(|axis| {
        let reaches = || data.panels.iter().filter_map(|panel| panel.ellipse).map(|ellipse| ellipse.reach()[axis]);
        let middle = median(reaches()).unwrap_or(1.0);
        let widest = reaches().filter(|reach| reach.is_finite()).reduce(f64::max).unwrap_or(1.0);
        let bound =
            data.panels.iter().filter_map(|panel| panel.bound).map(|bound| bound.reach()[axis]).fold(0.0, f64::max);
        (REACH * middle).min(1.15 * widest).max(1.3 * bound).max(1e-6)
    })
}

fn draw(panel: &Panel, scene: &mut Scene, theme: &Theme, content: &KtPanel) {
    let look = content.origin.look();
    for place in content.points.iter().filter_map(|point| panel.inside(*point)) {
        scene.disc(Layer::Data, place, 0.75 * theme.dot, look.colour, 0.45);
    }
    let outside = content.points.iter().filter(|point| panel.inside(**point).is_none()).count();
    if let Some(ellipse) = &content.ellipse {
        panel.line(scene, ellipse.contour(), Stroke::solid(look.colour, 1.3 * theme.line));
    }
    if let Some(bound) = &content.bound {
        panel.line(scene, bound.contour(), bound_stroke(theme));
    }
    let note = match (content.points.len(), outside) {
        (0, _) => "no estimate".to_owned(),
        (_, 0) => return,
        (all, outside) => format!("{outside} of {all} outside"),
    };
    let text = Text::new(note, theme.small_font).anchor(Anchor::End);
    let place = (panel.rect.right() - 0.4 * theme.small_font, panel.rect.bottom() - 0.5 * theme.small_font);
    scene.text_on_ground(Layer::Note, place, text);
}
