//! Single marks in one line of a row, moved up or down where they would hide each other.

use super::rows::{RowItem, RowKind};
use crate::chart::Chart;
use crate::theme::Theme;

/// Minimum distance of two marks in one lane, in radii.
const GAP: f64 = 1.7;

/// Distance of two lanes, in radii.
const STEP: f64 = 1.05;

/// Minimum number of marks that are drawn smaller.
const CROWD: usize = 12;

/// Factor of the size of marks in a crowd.
const CROWD_SIZE: f64 = 0.75;

/// Item of a row with its vertical place (in rows) and the radius of its mark, points.
pub(super) struct PlacedItem<'a> {
    pub item: &'a RowItem,
    pub y: f64,
    pub radius: f64,
}

/// `true` for a mark without name, number and interval: one of several cases.
pub(super) fn is_single(item: &RowItem) -> bool {
    matches!(item.kind, RowKind::Mark(_, _, None)) && item.name.is_none() && item.number.is_none()
}

/// Moves the single marks of every line apart, at most `room` points up or down; `pitch` is the distance of the rows,
/// points.
pub(super) fn spread(items: &mut [PlacedItem], chart: &Chart, theme: &Theme, room: f64, pitch: f64) {
    for line in items.chunk_by_mut(|item, next| is_single(item.item) && is_single(next.item) && item.y == next.y) {
        if !is_single(line[0].item) {
            continue;
        }
        let radius = theme.marker * size_factor(line.len());
        let places: Vec<f64> = line.iter().map(|placed| abscissa(placed.item, chart)).collect();
        for (placed, lane) in line.iter_mut().zip(lanes(&places, GAP * radius, lanes_beside(room, radius))) {
            placed.y += f64::from(lane) * STEP * radius / pitch;
            placed.radius = radius;
        }
    }
}

/// Number of lanes above a line, and below it, for marks that leave it by at most `room` points.
fn lanes_beside(room: f64, radius: f64) -> i32 {
    ((room - radius) / (STEP * radius)) as i32
}

/// Factor of the size of the single marks of a line.
fn size_factor(count: usize) -> f64 {
    if count < CROWD { 1.0 } else { CROWD_SIZE }
}

/// Abscissa of a mark on the page, points; at the edge for a mark beyond the axis, NaN for a value without a place.
fn abscissa(item: &RowItem, chart: &Chart) -> f64 {
    let RowKind::Mark(_, value, _) = item.kind else { return f64::NAN };
    let place = chart.page_x(value.clamp(-f64::MAX, f64::MAX)).unwrap_or(f64::NAN);
    place.clamp(chart.rect.x, chart.data_right())
}

/// Lane of every abscissa: 0 is the line, ±1 the lanes next to it, up to ±`beside`. Two marks of a lane are at least
/// `gap` apart; if no lane has room, the lane with the farthest mark is taken.
fn lanes(places: &[f64], gap: f64, beside: i32) -> Vec<i32> {
    let mut last: Vec<(i32, f64)> =
        (0..=beside).flat_map(|lane| [lane, -lane]).map(|lane| (lane, f64::NEG_INFINITY)).collect();
    last.remove(1);
    let mut order: Vec<usize> = (0..places.len()).filter(|&index| !places[index].is_nan()).collect();
    order.sort_by(|&a, &b| places[a].total_cmp(&places[b]));
    let mut chosen = vec![0; places.len()];
    for index in order {
        let x = places[index];
        let is_free = |lane: &usize| x - last[*lane].1 >= gap;
        let farthest = || (0..last.len()).min_by(|&a, &b| last[a].1.total_cmp(&last[b].1));
        if let Some(lane) = (0..last.len()).find(is_free).or_else(farthest) {
            (chosen[index], last[lane].1) = (last[lane].0, x);
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::{AxisSpec, NamedRows, Plot, RowsColumn};
    use crate::palette::{CurveOrigin, CurveStyle, Marker};

    /// Ordinate, relative to the first mark, and diameter of the marks of one row, in twentieths of a point.
    fn drawn(values: &[f64], name: &str) -> Vec<[i32; 2]> {
        let style = CurveStyle { marker: Marker::Circle, is_hollow: false, ..CurveOrigin::After.style() };
        let row = values.iter().map(|value| RowItem::new(name, RowKind::Mark(style, *value, None))).collect();
        let column = RowsColumn { x: AxisSpec::decimal("x"), rows: vec![row], ..RowsColumn::default() };
        let data = NamedRows { names: vec!["row".into()], columns: vec![column], ..NamedRows::default() };
        let drawing = Plot::from(data).draw("", &Theme::screen());
        // Every mark has a white rim, and is drawn as a round point.
        let points = drawing.svg().split("<path ").filter(|path| path.contains("h0\"") && !path.contains("#FFFFFF"));
        let number = |text: &str, before: &str, after: &str| -> i32 {
            let (_, tail) = text.split_once(before).expect("the number");
            tail.split_once(after).expect("its end").0.parse().expect("a number")
        };
        let marks = points.map(|path| {
            let point = path.split_once("d=\"M").expect("a path").1;
            [number(point, " ", "h0"), number(path, "stroke-width=\"", "\"")]
        });
        let mut marks: Vec<[i32; 2]> = marks.collect();
        // The legend comes first.
        marks.drain(..marks.len() - values.len());
        marks.iter().map(|[y, width]| [y - marks[0][0], *width]).collect()
    }

    /// A row has room for lanes a radius of 3 points and 5 % apart; marks with a name stay on their line.
    #[test]
    fn single_marks_at_one_value_are_drawn_above_each_other() {
        assert_eq!(drawn(&[1.0, 1.0, 1.0, 3.0], ""), [[0, 120], [63, 120], [-63, 120], [0, 120]]);
        assert_eq!(drawn(&[1.0; CROWD], "")[..3], [[0, 90], [47, 90], [-47, 90]]);
        assert!(drawn(&[1.0, 1.0, 3.0], "named").iter().all(|[y, _]| *y == 0));
    }

    #[test]
    fn marks_that_would_hide_each_other_are_in_different_lanes() {
        assert_eq!(lanes(&[5.0, 0.0, 10.0], 3.0, 2), [0, 0, 0]);
        assert_eq!(lanes(&[1.0, 0.0, 2.0, 2.5, 3.0], 3.0, 2), [1, 0, -1, 2, 0]);
        assert_eq!(lanes(&[0.0, 0.0, f64::NAN], 3.0, 0), [0, 0, 0]);
    }

    #[test]
    fn marks_of_a_crowd_are_smaller() {
        assert_eq!([CROWD - 1, CROWD, CROWD + 1].map(size_factor), [1.0, CROWD_SIZE, CROWD_SIZE]);
    }

    /// Radius 2 points, so lanes are 2.1 points apart: 2 + 2 · 2.1 = 6.2.
    #[test]
    fn lanes_keep_within_the_room() {
        assert_eq!([2.0, 4.0, 4.2, 6.1, 6.3].map(|room| lanes_beside(room, 2.0)), [0, 0, 1, 1, 2]);
        assert_eq!(lanes(&[0.0, 0.0], 1.0, lanes_beside(0.0, 2.0)), [0, 0]);
    }

    #[test]
    fn lanes_without_room_share_the_farthest() {
        assert_eq!(lanes(&[0.0, 1.0, 2.0, 2.5], 3.0, 1), [0, 1, -1, 0]);
    }
}
