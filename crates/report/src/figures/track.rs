//! Where ships go: tracks seen from above, a metre as long on one axis as on the other.

use serde::{Deserialize, Serialize};

use super::shared::{drawn_stroke, record, record_entry, widened};
use crate::axis::{self, Axis};
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side, fitting_step};
use crate::legend::{Entry, Sample};
use crate::palette::HEADING;
use crate::panel::Panel;
use crate::scene::{Layer, Stroke};
use crate::theme::Theme;
use crate::ticks::Steps;

/// What [`track`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Track {
    /// Title above the figure.
    pub title: Option<String>,
    /// Unit of all places: "m", or "L" for ship lengths.
    pub unit: String,
    /// Track of the most probable ship, north over east.
    pub most_probable: Curve,
    /// Tracks of drawn ships.
    pub drawn: Vec<Curve>,
    /// Measured track, where a record is replayed.
    pub recorded: Option<Curve>,
    /// East, north and heading in degrees where a small ship is drawn on the track of the most probable one.
    pub headings: Vec<[f64; 3]>,
}

/// Drawn ships may leave the range of everything else by this share of its longer side before they are cut.
const ROOM: f64 = 0.35;
/// Free space around the tracks, as a share of the longer side.
const MARGIN: f64 = 0.05;
/// A coordinate beyond this is no place of a ship.
const FARTHEST: f64 = 1e12;

/// Draws the tracks in one panel.
pub fn track(data: &Track, theme: &Theme) -> Figure {
    draw(data, theme).0.finish()
}

fn draw(data: &Track, theme: &Theme) -> (Sheet, Vec<Panel>) {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let (ranges, cut) = ranges(data);
    let (grid, width) = fitted(&sheet, &data.unit, ranges);
    let strip = sheet.left_margin(&grid) + width + Sheet::right_margin(theme);
    let panels = sheet.grid_within(grid, ((theme.width - strip) / 2.0, strip));
    for panel in &panels {
        for ship in &data.drawn {
            panel.line(&mut sheet.scene, ship.pairs(), drawn_stroke(theme));
        }
        if let Some(recorded) = &data.recorded {
            record(panel, &mut sheet.scene, theme, recorded, 1.3 * theme.dot);
        }
        panel.line(&mut sheet.scene, data.most_probable.pairs(), own(theme));
        for [east, north, heading] in &data.headings {
            let (sine, cosine) = heading.to_radians().sin_cos();
            if let Some(place) = panel.inside((*east, *north)) {
                sheet.scene.hull(Layer::Data, place, (sine, -cosine), 1.6 * theme.small_font, HEADING);
            }
        }
    }
    if cut {
        sheet.note("Some drawn ships are cut at the frame.");
    }
    (sheet, panels)
}

fn own(theme: &Theme) -> Stroke {
    Stroke::solid(HEADING, 1.2 * theme.line)
}

fn entries(data: &Track, theme: &Theme) -> Vec<Entry> {
    let mut entries = vec![Entry::new(Sample::Line(own(theme)), "most probable ship")];
    if !data.headings.is_empty() {
        entries.push(Entry::new(Sample::Hull(HEADING), "its heading (not to scale)"));
    }
    if !data.drawn.is_empty() {
        entries.push(Entry::new(Sample::Line(drawn_stroke(theme)), "drawn ships"));
    }
    entries.extend(data.recorded.iter().map(|recorded| record_entry("recorded track", theme, recorded)));
    entries
}

/// East or north of a pair.
type Part = fn(&(f64, f64)) -> f64;

/// The ends of both axes as the data want them, and whether drawn ships leave them.
fn ranges(data: &Track) -> ([(f64, f64); 2], bool) {
    let near = |pair: &(f64, f64)| pair.0.abs() < FARTHEST && pair.1.abs() < FARTHEST;
    let marks = data.headings.iter().map(|[east, north, _]| (*east, *north));
    let curves = [&data.most_probable].into_iter().chain(&data.recorded);
    let core: Vec<(f64, f64)> = curves.flat_map(Curve::finite).chain(marks).filter(near).collect();
    let drawn: Vec<(f64, f64)> = data.drawn.iter().flat_map(Curve::finite).filter(near).collect();
    let parts: [Part; 2] = [|pair| pair.0, |pair| pair.1];
    let of = |pairs: &[(f64, f64)]| parts.map(|part| axis::range(pairs.iter().map(part)));
    let longer = |ranges: &[(f64, f64); 2]| ranges.iter().map(|(lo, hi)| hi - lo).fold(0.0, f64::max);
    let [Some(east), Some(north)] = of(if core.is_empty() { &drawn } else { &core }) else {
        return ([(0.0, 1.0); 2], false);
    };
    let mut found = [east, north];
    let mut cut = false;
    let room = match longer(&found) {
        0.0 => f64::INFINITY,
        side => ROOM * side,
    };
    for (range, part) in found.iter_mut().zip(parts) {
        let (ends, beyond) = widened(*range, drawn.iter().map(part), room);
        *range = ends;
        cut |= beyond;
    }
    // A ship that stays where it is, and one so far off that numbers have no digits left for its way.
    let farthest = found.iter().flat_map(|(lo, hi)| [lo.abs(), hi.abs()]).fold(0.0, f64::max);
    let side = longer(&found).max(1e-6 * farthest);
    let side = if side > 0.0 { side } else { 1.0 };
    (found.map(|(lo, hi)| (lo - MARGIN * side, hi + MARGIN * side)), cut)
}

/// The panel with equal scales that shows both ranges, and its width in points.
fn fitted(sheet: &Sheet, unit: &str, [east, north]: [(f64, f64); 2]) -> (Grid, f64) {
    let theme = &sheet.theme;
    let of_unit = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
    let around = |(lo, hi): (f64, f64), length: f64| {
        let (middle, half) = ((lo + hi) / 2.0, length / 2.0);
        Axis::linear(middle - half, middle + half, Steps::Decimal)
    };
    let (wide, high) = (east.1 - east.0, north.1 - north.0);
    let with_margin = |left: f64| {
        let whole = (theme.width - left - Sheet::right_margin(theme)).max(theme.tick_font);
        let most = theme.tall(0.72);
        let height = (whole * high / wide).clamp(theme.tall(0.25), most);
        // A track that is much longer than wide has a narrow panel.
        let width = if whole * high > most * wide { (most * wide / high).max(0.5 * whole) } else { whole };
        // What a point on the page is worth, the same on both axes.
        let scale = (wide / width).max(high / height);
        let (across, up) = (around(east, scale * width), around(north, scale * height));
        // The grid is of squares.
        let (across, up) = match fitting_step(&across, width, theme) {
            Some(step) => (across.stepped(step), up.stepped(step)),
            None => (across, up),
        };
        let row = (Side::new(up, format!("north{of_unit}")), height);
        (Grid::stack(Side::new(across, format!("east{of_unit}")), vec![row]), width)
    };
    // Longer labels of the vertical axis take from the width, which changes the axis and may change the labels.
    let mut left = 0.0;
    for _ in 0..4 {
        left = sheet.left_margin(&with_margin(left).0).max(left);
    }
    with_margin(left)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_axes_have_the_same_scale() {
        let turn = |east: f64, north: f64| {
            let angles = || (0..100).map(|k| 0.1 * f64::from(k));
            Curve::new(
                angles().map(|a| east * (1.0 - a.cos())).collect::<Vec<_>>(),
                angles().map(|a| north * a.sin()).collect::<Vec<_>>(),
            )
        };
        let still = Curve::new([1e9; 3], [-3.0; 3]);
        for theme in [Theme::screen(), Theme::paper(85.0, 300.0).unwrap(), Theme::paper(60.0, 300.0).unwrap()] {
            for curve in [turn(700.0, 800.0), turn(5.0, 900.0), turn(9e4, 1.0), turn(2e-3, 1e-3), still.clone()] {
                let data = Track {
                    unit: "m".into(),
                    drawn: vec![turn(1e3, 1e3), curve.clone()],
                    most_probable: curve,
                    ..Track::default()
                };
                let (_, panels) = draw(&data, &theme);
                let [panel] = &panels[..] else { panic!("one panel") };
                let (x, y) = data.most_probable.finite().next().unwrap();
                let step = 0.01 * panel.rect.w / (panel.across(x + 1.0).unwrap() - panel.across(x).unwrap());
                let east = panel.across(x + step).unwrap() - panel.across(x).unwrap();
                let north = panel.up(y).unwrap() - panel.up(y + step).unwrap();
                assert!((east / north - 1.0).abs() < 1e-6, "{east} and {north} points");
                assert!(data.most_probable.finite().all(|pair| panel.inside(pair).is_some()));
                assert!(panel.rect.x > 0.0 && panel.rect.right() < theme.width);
            }
        }
    }
}
