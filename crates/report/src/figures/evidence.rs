//! What an analysis says of every effect: how probable it is, and what the records say for it.

use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::colour::Colour;
use crate::figure::Figure;
use crate::layout::{Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::number;
use crate::palette::{HEADING, INK, Look, Marker, PAPER, RECORD, RUDDER, SOLID};
use crate::panel::Panel;
use crate::scene::{Anchor, Layer, Stroke, Text};
use crate::theme::Theme;
use crate::ticks::Steps;

/// What became of an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fate {
    /// Part of the model.
    Added,
    /// Not to be told from a part of the model.
    Alias,
    /// Not needed.
    Rejected,
    /// The records could not show it.
    NotObservable,
}

/// An effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EvidenceRow {
    /// The effect with its form.
    pub name: String,
    /// Its probability.
    pub probability: f64,
    /// What the records say for it, −ΔBIC; below zero against it.
    pub support: Option<f64>,
    /// What became of it.
    pub fate: Fate,
}

/// What [`evidence`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Evidence {
    /// Title above the figure.
    pub title: Option<String>,
    /// The effects from top to bottom.
    pub rows: Vec<EvidenceRow>,
}

const FATES: [(Fate, &str); 4] = [
    (Fate::Added, "named"),
    (Fate::Alias, "not told from one that is named"),
    (Fate::Rejected, "rejected"),
    (Fate::NotObservable, "not observable"),
];

/// Support beyond which a bar is cut, as many times the median of all.
const MOST: f64 = 30.0;

/// Share of the axis that is left for the numbers.
const ROOM: f64 = 0.3;

/// Probability from which a bar leaves no room beside it.
const FULL: f64 = 0.8;

fn look(fate: Fate) -> Look {
    let colour = match fate {
        Fate::Added => HEADING,
        Fate::Alias => RUDDER,
        Fate::Rejected => RECORD,
        Fate::NotObservable => Colour(0xC4, 0xC4, 0xC4),
    };
    Look { colour, marker: Marker::Square, dash: SOLID, hollow: fate == Fate::NotObservable }
}

/// Draws probability and support side by side, or above each other when the figure is narrow.
pub fn evidence(data: &Evidence, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let shown = FATES.iter().filter(|(fate, _)| data.rows.iter().any(|row| row.fate == *fate));
    sheet.legend(&shown.map(|(fate, label)| Entry::new(Sample::Marker(look(*fate)), *label)).collect::<Vec<_>>());
    let height = 1.75 * theme.tick_font;
    let names = Side::new(Axis::names(data.rows.iter().map(|row| row.name.clone()).collect()), "");
    let [low, high] = range(&data.rows);
    let sides = [
        Side::new(Axis::linear(0.0, 1.0, Steps::Decimal), "probability"),
        // Room for the numbers at the right.
        Side::new(Axis::linear(low, high + ROOM * (high - low), Steps::Decimal), "support −ΔBIC"),
    ];
    let panels = sheet.side_by_side(sides, (names, (data.rows.len().max(1) as f64 + 0.2) * height));
    for (panel, of_support) in panels.iter().zip([false, true]) {
        panel.vertical(&mut sheet.scene, Layer::Grid, 0.0, Stroke::solid(INK, theme.thin));
        for (number, row) in data.rows.iter().enumerate() {
            let value = if of_support { row.support } else { Some(row.probability) };
            let Some((value, y)) = value.zip(panel.up(number as f64)) else { continue };
            bar(&mut sheet, panel, y, value.clamp(low.min(0.0), high.max(1.0)), &look(row.fate));
            let words = if of_support { number::significant(value, 3) } else { number::fixed(value, 3) };
            // On a bar that is nearly full the number stands at its beginning.
            let (anchor, x) = match !of_support && value > FULL {
                true => (Anchor::Start, panel.rect.x + 0.6 * theme.small_font),
                false => (Anchor::End, panel.rect.right() - 0.4 * theme.small_font),
            };
            let text = Text::new(words, theme.small_font).anchor(anchor);
            sheet.scene.text_on_ground(Layer::Note, (x, y + 0.35 * theme.small_font), text);
        }
    }
    sheet.finish()
}

/// Where the axis of the support begins and ends: a few large values do not hide the others.
fn range(rows: &[EvidenceRow]) -> [f64; 2] {
    let mut sizes: Vec<f64> = rows.iter().filter_map(|row| row.support).filter(|own| own.is_finite()).collect();
    sizes.sort_by(|one, other| one.abs().total_cmp(&other.abs()));
    let cut = sizes.get(sizes.len() / 2).map_or(1.0, |median| MOST * median.abs()).max(1.0);
    let end = |most: fn(f64, f64) -> f64| sizes.iter().fold(0.0, |end, own| most(end, own.clamp(-cut, cut)));
    [end(f64::min), end(f64::max).max(1.0)]
}

/// A bar from zero.
fn bar(sheet: &mut Sheet, panel: &Panel, y: f64, value: f64, look: &Look) {
    let (Some(zero), Some(end)) = (panel.across(0.0), panel.across(value)) else { return };
    let inside = |x: f64| x.clamp(panel.rect.x, panel.rect.right());
    let (l, r, half) = (inside(zero.min(end)), inside(zero.max(end)), 0.56 * sheet.theme.tick_font);
    let box_of = |inset: f64| {
        let (t, b) = (y - half + inset, y + half - inset);
        [(l + inset, t), (r - inset, t), (r - inset, b), (l + inset, b)]
    };
    sheet.scene.fill(Layer::Data, box_of(0.0), look.colour, 1.0);
    if look.hollow && r - l > 2.4 {
        sheet.scene.fill(Layer::Data, box_of(1.2), PAPER, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_is_told_with_its_numbers() {
        let row =
            |name: &str, probability, support, fate| EvidenceRow { name: name.into(), probability, support, fate };
        let rows = vec![
            row("damping (cubic)", 0.9994, Some(2345.0), Fate::Added),
            row("wind", 0.031, Some(-5.5), Fate::Rejected),
            row("sway", 0.05, None, Fate::NotObservable),
        ];
        for theme in [Theme::paper(85.0, 300.0).unwrap(), Theme::screen()] {
            let figure = evidence(&Evidence { title: None, rows: rows.clone() }, &theme);
            for text in ["damping (cubic)", "0.999", "2345", "−5.50", "not observable", "named"] {
                assert!(figure.svg().contains(text), "{text}");
            }
            assert!(!figure.svg().contains("NaN"));
        }
        assert!(!evidence(&Evidence::default(), &Theme::screen()).svg().contains("NaN"));
    }
}
