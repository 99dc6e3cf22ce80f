//! Blind spots of a trace: the minimum size at which a missing effect is named, in studies that vary the size.

use super::tracing::TraceSummary;
use crate::design::Design;
use crate::statistics::{DetectionCount, Statistic, detection_size, grouped};

/// Share of the trials that name an effect at its detection size.
pub const MIN_NAMED_SHARE: f64 = 0.9;

/// Blind spot: the minimum size at which a trace names an effect, under one set of conditions.
#[derive(Debug, Clone, PartialEq)]
pub struct BlindSpot {
    /// Name of the effect in the labels.
    pub effect: String,
    /// Unit of the sizes.
    pub unit: String,
    /// Labels of the other axes.
    pub conditions: Vec<String>,
    /// Index of the method, a trace.
    pub method: usize,
    /// Trials by size, with the number that name the effect.
    pub counts: Vec<DetectionCount>,
    /// Size at which 90 % of the trials name the effect; extrapolated beyond the tried sizes.
    pub size: Statistic,
}

impl BlindSpot {
    /// Minimum and maximum tried size.
    pub fn size_range(&self) -> [f64; 2] {
        let sizes = || self.counts.iter().map(|level| level.effect_size);
        [sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max)]
    }
}

/// Index of the axis of effect sizes, the first with a label that consists of an effect and its size; `None` without
/// one.
pub fn effect_size_axis(design: &Design) -> Option<usize> {
    let has_size = |axis: &usize| {
        design
            .cells
            .iter()
            .any(|cell| !cell.missing_effects.is_empty() && parts(&cell.labels[*axis], cell.values[*axis]).is_some())
    };
    (0..design.axes.len()).find(has_size)
}

/// Blind spots in the order of the cells; empty for a study without sizes.
pub fn blind_spots(lines: &[TraceSummary], design: &Design) -> Vec<BlindSpot> {
    let Some(axis) = effect_size_axis(design) else { return Vec::new() };
    let sized = lines.iter().filter(|line| line.missing_effects.len() == 1 && !line.is_hull()).filter_map(|line| {
        let cell = &design.cells[line.cell];
        let (effect, size, unit) = parts(&cell.labels[axis], cell.values[axis])?;
        let mut place = cell.labels.clone();
        place.remove(axis);
        let level = DetectionCount { effect_size: size, trials: line.trials, detections: line.all_named_count };
        Some(((effect, unit, place, line.method, &line.missing_effects), level))
    });
    let groups = grouped(sized, |(kind, _)| kind.clone());
    let spot = |((effect, unit, place, method, _), levels): (_, Vec<(_, DetectionCount)>)| {
        let tried: Vec<DetectionCount> = levels.into_iter().map(|(_, level)| level).collect();
        let size = detection_size(&tried, MIN_NAMED_SHARE)?;
        Some(BlindSpot { effect, unit, conditions: place, method, counts: tried, size })
    };
    groups.into_iter().filter_map(spot).collect()
}

/// Effect, size and unit in a label such as `wind 0.7°` of a point with the value 0.7; `None` for any other label.
fn parts(label: &str, value: Option<f64>) -> Option<(String, f64, String)> {
    let size = value.filter(|size| *size > 0.0)?;
    let (effect, unit) = label.split_once(&format!(" {size}"))?;
    let is_whole = !unit.starts_with(|next: char| next.is_ascii_digit() || next == '.');
    (is_whole && !effect.is_empty()).then(|| (effect.to_owned(), size, unit.trim_start().to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::CellFacts;

    #[test]
    fn a_label_with_its_value_is_an_effect_with_a_size() {
        let of = |label: &str, value| parts(label, Some(value)).map(|(effect, _, unit)| (effect, unit));
        let named = |effect: &str, unit: &str| Some((effect.to_owned(), unit.to_owned()));
        assert_eq!(of("wind 0.7°", 0.7), named("wind", "°"));
        assert_eq!(of("second order, T₂ 2 s", 2.0), named("second order, T₂", "s"));
        assert_eq!(of("wave 0.5", 0.5), named("wave", ""));
        assert_eq!(
            [of("0.1", 0.1), of("wind 0.75°", 0.7), of("wind 20°", 2.0), of("calm 0", 0.0)],
            [const { None }; 4]
        );
        assert_eq!(parts("wind 0.7°", None), None);
    }

    /// Two effects on two ships: one is named from size 1 on, the second never.
    #[test]
    fn every_effect_has_its_own_size() {
        let sizes = [0.25, 0.5, 1.0, 2.0];
        let cells = |label: &str, id: &str| {
            let cell = |size: &f64, ship: &str| CellFacts {
                labels: vec![ship.into(), format!("{label} {size}°")],
                values: vec![None, Some(*size)],
                missing_effects: vec![id.to_owned()],
                ..CellFacts::default()
            };
            sizes.iter().flat_map(|size| ["tanker", "ferry"].map(|ship| cell(size, ship))).collect::<Vec<_>>()
        };
        let nothing = ["tanker", "ferry"].map(|ship| CellFacts {
            labels: vec![ship.into(), "nothing".into()],
            values: vec![None, None],
            ..CellFacts::default()
        });
        let axes = vec!["ship".into(), "missing".into()];
        let cells: Vec<_> =
            nothing.into_iter().chain(cells("wind", "wind_moment")).chain(cells("waves", "wave_yaw")).collect();
        let design = Design { axes, cells, ..Design::default() };
        let line = |cell: usize| TraceSummary {
            missing_effects: design.cells[cell].missing_effects.clone(),
            trials: 40,
            all_named_count: if (6..10).contains(&cell) { 40 } else { 0 },
            cell,
            ..TraceSummary::default()
        };
        let lines: Vec<TraceSummary> = (0..design.cells.len()).map(line).collect();
        let spots = blind_spots(&lines, &design);
        let names: Vec<_> =
            spots.iter().map(|spot| format!("{} {}", spot.effect, spot.conditions.join(", "))).collect();
        assert_eq!(names, ["wind tanker", "wind ferry", "waves tanker", "waves ferry"]);
        assert!(spots.iter().all(|spot| spot.size_range() == [0.25, 2.0] && spot.unit == "°"));
        assert!((0.5..1.0).contains(&spots[0].size.value) && spots[2].size.value > 2.0, "{spots:?}");
        assert_eq!(effect_size_axis(&Design::default()), None);
    }
}
