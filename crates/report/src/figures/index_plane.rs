//! K and T of all methods in one plane: the region of 95 % of every method that has one, labelled beside it, and a
//! point for every method that has none.

use serde::{Deserialize, Serialize};

use super::shared::median;
use crate::axis::{self, Axis};
use crate::clip::Place;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::stroke_of;
use crate::markup::symbol;
use crate::number::significant;
use crate::palette::Origin;
use crate::panel::Panel;
use crate::scene::{Layer, Scene, Stroke, Text};
use crate::theme::Theme;
use crate::ticks::Steps;

/// K and T of one method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct IndexAnswer {
    /// Whose answer.
    pub origin: Origin,
    /// K and T.
    pub place: (f64, f64),
    /// Outline of the region that holds both with 95 %, T over K; empty where there is none or it has no bound.
    pub region: Curve,
}

/// What [`index_plane`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct IndexPlane {
    /// Title above the figure.
    pub title: Option<String>,
    /// Whether the numbers are K' and T', without unit.
    pub prime: bool,
    /// The methods.
    pub answers: Vec<IndexAnswer>,
}

/// Free space about the data, as a share of its range.
const PAD: f64 = 0.06;

/// How many times the middle distance from the middle is drawn; what lies farther off is named below.
const REACH: f64 = 4.0;

/// Draws the regions, the points and the labels right of the frame.
pub fn index_plane(data: &IndexPlane, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let [k, t] = match data.prime {
        true => [symbol("K′"), symbol("T′")],
        false => [format!("{} [1/s]", symbol("K")), format!("{} [s]", symbol("T"))],
    };
    let axes = [0, 1].map(|part| axis(data, part));
    let label = |answer: &IndexAnswer| Text::new(answer.origin.label(), theme.small_font);
    let names = data.answers.iter().map(|answer| label(answer).width()).fold(0.0, f64::max);
    let strip = theme.width - names - 1.2 * theme.small_font;
    let [across, up] = axes;
    let row = (Side::new(up, t), theme.tall(0.5));
    let grid = Grid::stack(Side::new(across, k), vec![row]);
    let mut outside: Vec<&IndexAnswer> = Vec::new();
    for panel in &sheet.grid_within(grid, (0.0, strip)) {
        let mut labels: Vec<(Place, &IndexAnswer)> = Vec::new();
        for answer in &data.answers {
            let look = answer.origin.look();
            // Two methods that agree would hide each other without their dashes.
            panel.line(&mut sheet.scene, answer.region.pairs(), stroke_of(&answer.origin, theme));
            panel.marker(&mut sheet.scene, answer.place, 0.95 * theme.marker, &look);
            match anchor(panel, answer) {
                Some(place) => labels.push((place, answer)),
                None => outside.push(answer),
            }
        }
        beside(panel, &mut sheet.scene, theme, labels);
    }
    let mut notes = Vec::new();
    if data.answers.iter().any(|answer| answer.region.finite().next().is_some()) {
        notes.push(format!("Outlines hold {} and {} together with 95 %.", symbol("K"), symbol("T")));
    }
    if !outside.is_empty() {
        let of = |answer: &&IndexAnswer| {
            let (k, t) = answer.place;
            format!("{} (K = {}, T = {})", answer.origin.label(), significant(k, 3), significant(t, 3))
        };
        notes.push(format!("Outside the axes: {}.", outside.iter().map(of).collect::<Vec<_>>().join(", ")));
    }
    if !notes.is_empty() {
        sheet.note(&notes.join(" "));
    }
    sheet.finish()
}

/// Where the label of an answer points: the rightmost place of its region in the frame, or its point.
fn anchor(panel: &Panel, answer: &IndexAnswer) -> Option<Place> {
    let point = panel.inside(answer.place)?;
    let rightmost = answer.region.finite().filter_map(|pair| panel.inside(pair)).max_by(|a, b| a.0.total_cmp(&b.0));
    Some(rightmost.unwrap_or(point))
}

/// Labels right of the frame, in the order of their places from top to bottom, none on another.
fn beside(panel: &Panel, scene: &mut Scene, theme: &Theme, mut labels: Vec<(Place, &IndexAnswer)>) {
    labels.sort_by(|one, other| one.0.1.total_cmp(&other.0.1));
    let wanted: Vec<f64> = labels.iter().map(|(place, _)| place.1).collect();
    let gap = 1.5 * theme.small_font;
    let places = spread(&wanted, gap, [panel.rect.y + 0.6 * gap, panel.rect.bottom() - 0.6 * gap]);
    let right = panel.rect.right();
    for ((from, answer), y) in labels.into_iter().zip(places) {
        let look = answer.origin.look();
        let knee = right + 0.5 * theme.small_font;
        let thin = Stroke { opacity: 0.6, ..Stroke::solid(look.colour, theme.thin) };
        scene.line(Layer::Grid, [from, (right, y), (knee, y)], thin);
        let text = Text::new(answer.origin.label(), theme.small_font).colour(look.colour);
        scene.text(Layer::Note, (knee + 0.3 * theme.small_font, y + text.centring()), text);
    }
}

/// Places at least `gap` apart and as near as may be to the wanted ones, which are in order.
fn spread(wanted: &[f64], gap: f64, [top, bottom]: [f64; 2]) -> Vec<f64> {
    let mut places: Vec<f64> = Vec::with_capacity(wanted.len());
    for &place in wanted {
        let least = places.last().map_or(top, |last| last + gap);
        places.push(place.max(least));
    }
    let mut most = bottom;
    for place in places.iter_mut().rev() {
        *place = place.min(most);
        most = *place - gap;
    }
    places
}

/// Covers regions and points of all that do not lie far off the middle one.
fn axis(data: &IndexPlane, part: usize) -> Axis {
    let of = |(k, t): (f64, f64)| if part == 0 { k } else { t };
    let centres = || data.answers.iter().map(|answer| of(answer.place));
    let middle = median(centres()).unwrap_or(0.0);
    let half = |answer: &IndexAnswer| {
        let ends = axis::range(answer.region.finite().map(of));
        ends.map_or(0.0, |(lo, hi)| 0.5 * (hi - lo)) + (of(answer.place) - middle).abs()
    };
    let room = REACH * median(data.answers.iter().map(half).filter(|half| *half > 0.0)).unwrap_or(f64::INFINITY);
    let limits = |value: f64| value.clamp(middle - room, middle + room);
    let near = data.answers.iter().filter(|answer| (of(answer.place) - middle).abs() <= room);
    let values = near.flat_map(|answer| answer.region.finite().map(of).map(limits).chain([of(answer.place)]));
    Axis::covering(values, PAD, Steps::Decimal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_their_order_and_their_distance() {
        assert_eq!(spread(&[10.0, 11.0, 50.0], 5.0, [0.0, 100.0]), [10.0, 15.0, 50.0]);
        assert_eq!(spread(&[97.0, 98.0, 99.0], 5.0, [0.0, 100.0]), [90.0, 95.0, 100.0]);
        assert_eq!(spread(&[-5.0], 5.0, [0.0, 100.0]), [0.0]);
    }

    #[test]
    fn a_wild_method_does_not_hide_the_others() {
        let answer = |id: &str, k: f64| IndexAnswer {
            origin: Origin::Method(id.into()),
            place: (k, 160.0 * k),
            region: Curve::new([0.99 * k, 1.01 * k, 0.99 * k], [158.0 * k, 162.0 * k, 158.0 * k]),
        };
        let answers =
            vec![answer("output-error", 0.1), answer("srivc", 0.101), answer("least-squares", 0.099), answer("x", 9.0)];
        let figure = index_plane(&IndexPlane { title: None, prime: false, answers }, &Theme::screen());
        assert!(figure.svg().contains("Outside the axes: x (K = 9.00, T = 1440)."), "{}", figure.svg());
    }
}
