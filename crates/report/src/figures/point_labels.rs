//! Labels beside points: each on the side of its point where it covers least of the lines, marks and other labels.

use plotters::style::text_anchor::HPos;

use super::panels::{Layer, LayerKind};
use crate::backend::PlotResult;
use crate::canvas::{PagePoint, Rect, Stroke, TextLine};
use crate::chart::Chart;
use crate::theme::Theme;

/// Distance that a label keeps from lines, in font sizes.
const CLEARANCE: f64 = 0.25;

/// Minimum cost of covering a line, that of pale lines; an opaque line costs 1.
const PALE: f64 = 0.3;

/// Cost of covering another label.
const LABEL: f64 = 5.0;

/// Cost of a place with a leader to its point, and of each step farther away.
const LEADER: [f64; 2] = [0.8, 0.05];

/// Maximum number of steps that a label is from its point.
const MAX_STEPS: i32 = 8;

/// Cost of a place beyond the frame.
const BEYOND: f64 = 100.0;

/// Lines on the page that labels should not cover, each with its cost.
struct Obstacles(Vec<([PagePoint; 2], f64)>);

impl Obstacles {
    fn new(chart: &Chart, layers: &[Layer]) -> Self {
        let mut segments = Vec::new();
        for layer in layers {
            let cost = match &layer.kind {
                LayerKind::Line(pen) => pen.opacity.max(PALE),
                LayerKind::Marks(_) => 1.0,
                _ => continue,
            };
            let points: Vec<Option<PagePoint>> =
                layer.curve.pairs().map(|(x, y)| chart.page_point(x, y.min(f64::MAX))).collect();
            let joined = points.windows(2).filter_map(|ends| Some([ends[0]?, ends[1]?]));
            segments.extend(joined.map(|ends| (ends, cost)));
            let LayerKind::Marks(marks) = &layer.kind else { continue };
            // A mark is a line without length.
            segments.extend(points.iter().flatten().map(|point| ([*point; 2], cost)));
            let bars = layer.curve.x.iter().zip(&marks.intervals).filter_map(|(x, ends)| Some((*x, (*ends)?)));
            let bar = |(x, [low, high]): (f64, [f64; 2])| {
                Some([chart.page_point(x, low)?, chart.page_point(x, high.min(f64::MAX))?])
            };
            segments.extend(bars.filter_map(bar).map(|ends| (ends, cost)));
        }
        Self(segments)
    }

    /// Cost of a label that fills the rectangle `place`.
    fn cost(&self, place: Rect) -> f64 {
        self.0.iter().filter(|(ends, _)| crosses(place, *ends)).map(|(_, cost)| cost).sum()
    }

    /// Cost of a leader.
    fn crossing_cost(&self, leader: [PagePoint; 2]) -> f64 {
        self.0.iter().filter(|(ends, _)| intersects(leader, *ends)).map(|(_, cost)| cost).sum::<f64>()
    }
}

/// Ends of the leader from a point to its label, whose middle is `middle`.
fn leader(point: PagePoint, middle: PagePoint, theme: &Theme) -> [PagePoint; 2] {
    let towards = (middle.1 - point.1).signum();
    [(point.0, point.1 + towards * 1.2 * theme.marker), (middle.0, middle.1 - towards * 0.5 * theme.small_font)]
}

/// `true` if two segments cross.
fn intersects([a, b]: [PagePoint; 2], [c, d]: [PagePoint; 2]) -> bool {
    let side = |p: PagePoint, q: PagePoint, r: PagePoint| (q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

/// `true` if one of many equidistant points of a segment lies in a rectangle.
fn crosses(place: Rect, [from, to]: [PagePoint; 2]) -> bool {
    const STEPS: u32 = 64;
    let between = |from: f64, to: f64, step| from + (to - from) * f64::from(step) / f64::from(STEPS);
    (0..=STEPS).any(|step| place.contains((between(from.0, to.0, step), between(from.1, to.1, step))))
}

/// Shift of a label from its point, in units of its size, with the least cost: to the right or left, above or below,
/// near or up to [`MAX_STEPS`] steps farther, in order of preference. A place farther away needs a leader.
fn best_shift(cost_at: impl Fn([f64; 2]) -> f64) -> [f64; 2] {
    let sides = |far: f64| [1.0, -1.0, 0.0, 2.0, -2.0].map(|right| [[right, -far], [right, far]]);
    let is_near_enough = |[right, down]: &[f64; 2]| right.abs() < 2.0 || needs_leader(*down);
    let shifts = (1..=MAX_STEPS).flat_map(|far| sides(f64::from(far)).concat()).filter(is_near_enough);
    let steps = |down: f64| if needs_leader(down) { LEADER[0] + LEADER[1] * (down.abs() - 1.0) } else { 0.0 };
    let costs = shifts.map(|shift| (shift, cost_at(shift) + steps(shift[1])));
    costs.min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or([1.0, -1.0], |(shift, _)| shift)
}

fn needs_leader(down: f64) -> bool {
    down.abs() > 1.0
}

/// Writes the labels of all layers of a panel, each with a leader if it is far from its point.
pub(super) fn draw(chart: &Chart, layers: &[Layer], theme: &Theme) -> PlotResult {
    let mut obstacles = Obstacles::new(chart, layers);
    let frame = chart.rect;
    for layer in layers {
        let LayerKind::Labels(labels, colour) = &layer.kind else { continue };
        for ((x, y), label) in layer.curve.pairs().zip(labels) {
            let Some((x, y)) = chart.inside(x, y) else { continue };
            let text = TextLine { colour: *colour, ..TextLine::new(label, theme.small_font, HPos::Center) };
            let (width, height) = (text.width(), theme.small_font);
            let at = |[right, down]: [f64; 2]| {
                let farther = 0.7 * (down - down.signum()) * height;
                let below = y + down.signum() * (theme.marker + 0.4 * height) + farther;
                (x + right * (1.2 * theme.marker + 0.5 * width), below)
            };
            let place = |(x, y): PagePoint, clear: f64| {
                let (half_width, half_height) = (0.5 * width + clear, 0.45 * height + clear);
                Rect { x: x - half_width, y: y - half_height, w: 2.0 * half_width, h: 2.0 * half_height }
            };
            let shift = best_shift(|shift| {
                let letters = place(at(shift), 0.0);
                let corners = [(letters.x, letters.y), (letters.right(), letters.bottom())];
                let beyond = if corners.into_iter().all(|corner| frame.contains(corner)) { 0.0 } else { BEYOND };
                let crossing = match needs_leader(shift[1]) {
                    true => obstacles.crossing_cost(leader((x, y), at(shift), theme)),
                    false => 0.0,
                };
                obstacles.cost(place(at(shift), CLEARANCE * height)) + beyond + crossing
            });
            let middle = at(shift);
            if needs_leader(shift[1]) {
                let ends = leader((x, y), middle, theme);
                chart.canvas.line(&ends, Stroke { opacity: 0.6, ..Stroke::solid(*colour, theme.thin) })?;
            }
            chart.canvas.text_with_halo(middle, &text)?;
            obstacles.0.push(([(middle.0 - 0.5 * width, middle.1), (middle.0 + 0.5 * width, middle.1)], LABEL));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_stays_at_its_point_unless_that_covers_more_than_a_leader_costs() {
        let covered = |near: f64| move |[_, down]: [f64; 2]| if needs_leader(down) { 0.0 } else { near };
        assert_eq!(best_shift(|_| 0.0), [1.0, -1.0]);
        assert_eq!(best_shift(|[right, _]| 0.5 * right), [-1.0, -1.0]);
        assert_eq!(best_shift(covered(0.8)), [1.0, -1.0]);
        assert_eq!(best_shift(covered(1.0)), [1.0, -2.0]);
        assert_eq!(best_shift(|[right, _]| if right.abs() < 2.0 { 2.0 } else { 0.0 }), [2.0, -2.0]);
    }

    #[test]
    fn a_leader_ends_at_mark_and_text_and_costs_the_lines_that_it_crosses() {
        let theme = Theme::screen();
        let (mark, half_text) = (1.2 * theme.marker, 0.5 * theme.small_font);
        assert_eq!(leader((10.0, 50.0), (30.0, 20.0), &theme), [(10.0, 50.0 - mark), (30.0, 20.0 + half_text)]);
        assert_eq!(leader((10.0, 50.0), (30.0, 90.0), &theme), [(10.0, 50.0 + mark), (30.0, 90.0 - half_text)]);
        let across = |y: f64| [(0.0, y), (4.0, y)];
        let obstacles = Obstacles(vec![(across(1.0), 1.0), (across(2.0), 0.45), (across(9.0), 1.0)]);
        assert!((obstacles.crossing_cost([(2.0, 0.0), (2.0, 3.0)]) - 1.45).abs() < 1e-12);
        assert_eq!(obstacles.crossing_cost([(2.0, 3.0), (2.0, 4.0)]), 0.0);
    }

    #[test]
    fn segments_that_only_touch_do_not_cross() {
        assert!(intersects([(0.0, 0.0), (2.0, 2.0)], [(0.0, 2.0), (2.0, 0.0)]));
        assert!(!intersects([(0.0, 0.0), (1.0, 1.0)], [(1.0, 1.0), (2.0, 0.0)]));
        assert!(!intersects([(0.0, 0.0), (2.0, 2.0)], [(3.0, 0.0), (3.0, 9.0)]));
        assert!(!intersects([(3.0, 0.0), (3.0, 9.0)], [(0.0, 0.0), (2.0, 2.0)]));
    }

    #[test]
    fn a_segment_crosses_a_rectangle_that_it_touches() {
        let place = Rect { x: 0.0, y: 0.0, w: 4.0, h: 2.0 };
        let is_crossed = |from, to| crosses(place, [from, to]);
        assert!(is_crossed((-1.0, 1.0), (5.0, 1.0)) && is_crossed((1.0, -9.0), (1.0, 9.0)));
        assert!(is_crossed((1.0, 1.0), (1.0, 1.0)) && is_crossed((-1.0, 0.0), (2.0, 3.0)));
        assert!(!is_crossed((-1.0, 1.5), (0.5, 3.0)) && !is_crossed((5.0, 1.0), (6.0, 1.0)));
        assert!(!is_crossed((-1.0, 2.5), (5.0, 2.5)) && !is_crossed((-2.0, 1.0), (-1.0, 1.0)));
    }
}
