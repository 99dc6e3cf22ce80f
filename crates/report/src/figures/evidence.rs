//! How much every candidate explains: a bar each on a logarithmic axis, with the threshold it has to pass.

use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::colour::Colour;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::number;
use crate::palette::{DASHED, HEADING, INK, Look, Marker, PAPER, RECORD, RUDDER, SOLID};
use crate::scene::{Layer, Stroke, Text};
use crate::theme::Theme;

/// What became of a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fate {
    /// Part of the model.
    Added,
    /// Not to be told from a part of it.
    Alias,
    /// Not needed.
    Rejected,
    /// The record could not show it.
    NotObservable,
}

/// One bar.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EvidenceBar {
    /// The candidate.
    pub name: String,
    /// Gain in BIC; nothing is drawn below 1.
    pub gain: f64,
    /// Gain it has to pass.
    pub threshold: f64,
    /// What became of it.
    pub fate: Fate,
}

/// What [`evidence`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Evidence {
    /// Title above the figure.
    pub title: Option<String>,
    /// Horizontal axis.
    pub x_title: String,
    /// The bars from top to bottom.
    pub bars: Vec<EvidenceBar>,
}

const FATES: [(Fate, &str); 4] = [
    (Fate::Added, "added"),
    (Fate::Alias, "cannot be told from one that is added"),
    (Fate::Rejected, "rejected"),
    (Fate::NotObservable, "not observable in this record"),
];

fn colour(fate: Fate) -> Colour {
    match fate {
        Fate::Added => HEADING,
        Fate::Alias => RUDDER,
        Fate::Rejected => RECORD,
        Fate::NotObservable => Colour(0xC4, 0xC4, 0xC4),
    }
}

/// Draws the bars.
pub fn evidence(data: &Evidence, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let look =
        |fate| Look { colour: colour(fate), marker: Marker::Square, dash: SOLID, hollow: fate == Fate::NotObservable };
    let mut entries: Vec<Entry> = FATES
        .iter()
        .filter(|(fate, _)| data.bars.iter().any(|bar| bar.fate == *fate))
        .map(|(fate, label)| Entry::new(Sample::Marker(look(*fate)), *label))
        .collect();
    let limit = Stroke::solid(INK, theme.line).dashed(DASHED);
    entries.push(Entry::new(Sample::Line(limit), "needed to be added"));
    sheet.legend(&entries);
    // Room for the number beside the longest bar.
    let gains = data.bars.iter().flat_map(|bar| [3.0 * bar.gain, bar.threshold]).filter(|gain| *gain > 1.0);
    let x = Side::new(Axis::log_covering(gains.chain([1.0, 100.0]).collect::<Vec<_>>()), data.x_title.clone());
    let names = Side::new(Axis::names(data.bars.iter().map(|bar| bar.name.clone()).collect()), "");
    let row = 1.75 * theme.tick_font;
    let height = (data.bars.len().max(1) as f64 + 0.2) * row;
    let panels = sheet.grid(Grid::stack(x, vec![(names, height)]));
    for panel in &panels {
        for (number, bar) in data.bars.iter().enumerate() {
            let Some(y) = panel.up(number as f64) else { continue };
            let half = 0.32 * row;
            if let Some(end) = panel.across(bar.gain.max(1.0)).filter(|_| bar.gain > 1.0) {
                let end = end.min(panel.rect.right());
                let box_of = |inset: f64| {
                    let (l, r, t, b) = (panel.rect.x, end - inset, y - half + inset, y + half - inset);
                    [(l, t), (r, t), (r, b), (l, b)]
                };
                sheet.scene.fill(Layer::Data, box_of(0.0), colour(bar.fate), 1.0);
                if bar.fate == Fate::NotObservable {
                    sheet.scene.fill(Layer::Data, box_of(1.2), PAPER, 1.0);
                }
                let place = (end + 0.4 * theme.small_font, y + 0.35 * theme.small_font);
                let text = Text::new(number::significant(bar.gain, 3), theme.small_font);
                sheet.scene.text_on_ground(Layer::Note, place, text);
            }
            if let Some(x) = panel.across(bar.threshold) {
                sheet.scene.line(Layer::Note, [(x, y - 0.5 * row), (x, y + 0.5 * row)], limit);
            }
        }
    }
    sheet.finish()
}
