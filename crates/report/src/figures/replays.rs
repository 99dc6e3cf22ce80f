//! The record, and the replay of the recorded rudder through the model every method found. The replays share one panel;
//! the residuals have one small panel each, because seven of them on top of each other cannot be read.

use serde::{Deserialize, Serialize};

use super::shared::{PAD, heading_title, record, record_entry, time_side, zero_line};
use crate::axis::{self, Axis};
use crate::curve::Curve;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, stroke_of};
use crate::number;
use crate::palette::Origin;
use crate::panel::Panel;
use crate::scene::{Anchor, Layer, Scene, Stroke, Text};
use crate::theme::Theme;
use crate::ticks::Steps;

/// The heading a method's model gives for the recorded rudder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Replay {
    /// The method; decides how its replay looks.
    pub origin: Origin,
    /// Replayed heading, degrees over seconds.
    pub heading: Curve,
    /// Recorded minus replayed heading, degrees over seconds.
    pub residual: Curve,
    /// Root mean square of the residual, degrees.
    pub rms_deg: Option<f64>,
}

/// What [`replays`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Replays {
    /// Title above the figure.
    pub title: Option<String>,
    /// Recorded heading, degrees over seconds.
    pub record: Curve,
    /// Noise-free heading, degrees over seconds.
    pub truth: Option<Curve>,
    /// One replay per method.
    pub replays: Vec<Replay>,
}

/// A replay may leave the range of the record by this share of it before it is cut.
const HEADING_ROOM: f64 = 0.25;
/// A residual is cut at this many times the middle one of all the largest residuals.
const RESIDUAL_ROOM: f64 = 4.0;

/// Draws record and replays above, one residual panel per method below. A replay or residual that runs far off is cut
/// at the frame, and its panel says how far it goes, so that one failure does not flatten the others.
pub fn replays(data: &Replays, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    sheet.legend(&entries(data, theme));
    let time = || {
        let side = time_side(data.replays.iter().flat_map(|r| [&r.heading, &r.residual]).chain([&data.record]));
        side.axis
    };
    let limit = residual_limit(&data.replays);
    let residual_axis = Axis::linear(-limit, limit, Steps::Angle);
    let columns = if theme.is_narrow() || data.replays.len() < 3 { 1 } else { 2 };
    let small = if columns == 1 { theme.tall(0.075) } else { theme.tall(0.085) };
    let column = Side::new(time(), time_side([&data.record]).title);
    let mut lower_grid = Grid {
        heads: data.replays.iter().map(|r| Some(entry(r, theme.is_narrow(), theme))).collect(),
        shared_title: Some("residual [°]".into()),
        ..Grid::alike(data.replays.len(), columns, column, (Side::new(residual_axis, ""), small))
    };
    let has_residuals = !data.replays.is_empty();
    let upper_title = if has_residuals { String::new() } else { time_side([&data.record]).title };
    let mut upper_grid = Grid::stack(Side::new(time(), upper_title), vec![(heading_side(data), theme.tall(0.28))]);
    let left = Some(sheet.left_margin(&upper_grid).max(sheet.left_margin(&lower_grid)));
    (upper_grid.left, lower_grid.left) = (left, left);
    let upper = sheet.grid(upper_grid);
    for panel in &upper {
        record(panel, &mut sheet.scene, theme, &data.record, 1.5 * theme.dot);
        if let Some(truth) = &data.truth {
            panel.line(&mut sheet.scene, truth.pairs(), stroke_of(&Origin::Truth, theme));
        }
        for replay in &data.replays {
            panel.line(&mut sheet.scene, replay.heading.pairs(), stroke_of(&replay.origin, theme));
        }
    }
    if has_residuals {
        let panels = sheet.grid(lower_grid);
        for (panel, replay) in panels.iter().zip(&data.replays) {
            residual(panel, replay, limit, &mut sheet.scene, theme);
        }
    }
    sheet.finish()
}

fn entries(data: &Replays, theme: &Theme) -> Vec<Entry> {
    let mut entries = vec![record_entry("record", theme, &data.record)];
    if data.truth.is_some() {
        entries.push(Entry::line_of(&Origin::Truth, theme));
    }
    entries.extend(data.replays.iter().map(|replay| entry(replay, !theme.is_narrow(), theme)));
    entries
}

/// The key of a method. Its rms error stands in the legend, or in a narrow figure at the small panel, where there is
/// room for it.
fn entry(replay: &Replay, with_rms: bool, theme: &Theme) -> Entry {
    let entry = Entry::line_of(&replay.origin, theme);
    if !with_rms {
        return entry;
    }
    let rms = replay.rms_deg.filter(|rms| rms.is_finite());
    let rms = rms.map_or_else(|| number::MISSING.into(), |rms| format!("{}°", number::significant(rms, 2)));
    Entry { label: format!("{}, rms {rms}", replay.origin.label()), ..entry }
}

fn heading_side(data: &Replays) -> Side {
    let values = || data.record.finite().map(|(_, y)| y).chain(data.truth.iter().flat_map(|c| c.finite().map(|p| p.1)));
    let all = data.replays.iter().flat_map(|r| r.heading.finite().map(|(_, y)| y));
    let axis = match (axis::range(values()), axis::range(all.chain(values()))) {
        (Some((lo, hi)), Some((lowest, highest))) if hi > lo => {
            let room = HEADING_ROOM * (hi - lo);
            let (lo, hi) = (lowest.max(lo - room), highest.min(hi + room));
            Axis::linear(lo - PAD * (hi - lo), hi + PAD * (hi - lo), Steps::Angle)
        }
        (_, whole) => {
            let (lo, hi) = whole.unwrap_or((f64::NAN, f64::NAN));
            Axis::linear(lo, hi, Steps::Angle)
        }
    };
    Side::new(axis, heading_title())
}

fn largest(curve: &Curve) -> Option<f64> {
    axis::range(curve.finite().map(|(_, y)| y.abs())).map(|(_, hi)| hi)
}

/// Half the height of the residual axis: the largest residual, but not more than [`RESIDUAL_ROOM`] times the middle
/// one.
fn residual_limit(replays: &[Replay]) -> f64 {
    let mut peaks: Vec<f64> = replays.iter().filter_map(|r| largest(&r.residual)).collect();
    peaks.sort_by(f64::total_cmp);
    let highest = peaks.last().copied().unwrap_or(0.0);
    let middle = peaks.get((peaks.len().max(1) - 1) / 2).copied().unwrap_or(0.0);
    let limit = 1.1 * if middle > 0.0 { highest.min(RESIDUAL_ROOM * middle) } else { highest };
    if limit > 0.0 { limit } else { 1.0 }
}

fn residual(panel: &Panel, replay: &Replay, limit: f64, scene: &mut Scene, theme: &Theme) {
    zero_line(panel, scene, theme);
    let look = replay.origin.look();
    panel.line(scene, replay.residual.pairs(), Stroke::solid(look.colour, 0.8 * theme.line));
    if let Some(peak) = largest(&replay.residual).filter(|peak| *peak > limit) {
        let text = format!("cut, reaches {}°", number::significant(peak, 2));
        let place = (panel.rect.right(), panel.rect.y - 0.45 * theme.small_font);
        scene.text(Layer::Note, place, Text::new(text, theme.small_font).anchor(Anchor::End));
    }
}
