//! How a model was found: the error after every effect that was added, and what every other candidate would gain
//! beside them.

use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::canvas::Anchor;
use crate::clip::Place;
use crate::colour::Colour;
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::markup::symbol;
use crate::number;
use crate::palette::{BEFORE, DASHED, HEADING, INK, Look, Marker, PAPER, RECORD, RUDDER, SOLID};
use crate::panel::Panel;
use crate::scene::{Layer, Stroke, Text};
use crate::theme::Theme;
use crate::ticks::Steps;

/// A model on the way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EvidenceStep {
    /// What was added.
    pub name: String,
    /// Error on the fitted records, degrees.
    pub fitted_deg: f64,
    /// Error on the held-out records, degrees.
    pub held_out_deg: Option<f64>,
}

/// What became of a candidate that is not part of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fate {
    /// Not to be told from a part of the model.
    Alias,
    /// Not needed.
    Rejected,
    /// The record could not show it.
    NotObservable,
}

/// A candidate that is not part of the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EvidenceBar {
    /// The candidate.
    pub name: String,
    /// Gain in BIC beside the final model.
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
    /// The models from top to bottom, the base first.
    pub steps: Vec<EvidenceStep>,
    /// The candidates that are not part of the last one, from top to bottom.
    pub bars: Vec<EvidenceBar>,
    /// What was found and dropped again, a sentence each.
    pub dropped: Vec<String>,
}

const FATES: [(Fate, &str); 3] = [
    (Fate::Alias, "cannot be told from one that is added"),
    (Fate::Rejected, "rejected"),
    (Fate::NotObservable, "not observable in this record"),
];

fn colour(fate: Fate) -> Colour {
    match fate {
        Fate::Alias => RUDDER,
        Fate::Rejected => RECORD,
        Fate::NotObservable => Colour(0xC4, 0xC4, 0xC4),
    }
}

fn square(colour: Colour, hollow: bool) -> Look {
    Look { colour, marker: Marker::Square, dash: SOLID, hollow }
}

/// A record that was not fitted.
const HELD_OUT: Look = Look { colour: INK, marker: Marker::Diamond, dash: SOLID, hollow: true };

/// Draws the way of the error above, the other candidates below.
pub fn evidence(data: &Evidence, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    if !data.steps.is_empty() {
        steps(data, &mut sheet, theme);
    }
    if !data.bars.is_empty() || data.steps.is_empty() {
        bars(data, &mut sheet, theme);
    }
    data.dropped.iter().for_each(|sentence| sheet.note(sentence));
    sheet.finish()
}

fn rows(names: Vec<String>, theme: &Theme) -> (Side, f64) {
    let height = (names.len().max(1) as f64 + 0.2) * row(theme);
    (Side::new(Axis::names(names), ""), height)
}

fn row(theme: &Theme) -> f64 {
    1.75 * theme.tick_font
}

/// A bar between two places on the horizontal axis.
fn bar(sheet: &mut Sheet, panel: &Panel, number: usize, [from, to]: [f64; 2], look: &Look) {
    let row = row(&sheet.theme);
    let (Some(y), Some(from), Some(to)) = (panel.up(number as f64), panel.across(from), panel.across(to)) else {
        return;
    };
    let inside = |x: f64| x.clamp(panel.rect.x, panel.rect.right());
    let (l, r, half) = (inside(from.min(to)), inside(from.max(to)), 0.32 * row);
    let box_of = |inset: f64| {
        let (t, b) = (y - half + inset, y + half - inset);
        [(l + inset, t), (r - inset, t), (r - inset, b), (l + inset, b)]
    };
    sheet.scene.fill(Layer::Data, box_of(0.0), look.colour, 1.0);
    if look.hollow && r - l > 2.4 {
        sheet.scene.fill(Layer::Data, box_of(1.2), PAPER, 1.0);
    }
}

/// The place to the right of a value for its number.
fn beside(panel: &Panel, number: usize, value: f64, theme: &Theme) -> Option<Place> {
    let x = panel.across(value)?.clamp(panel.rect.x, panel.rect.right());
    Some((x + 0.5 * theme.small_font, panel.up(number as f64)? + 0.35 * theme.small_font))
}

fn steps(data: &Evidence, sheet: &mut Sheet, theme: &Theme) {
    let mut entries = vec![Entry::new(Sample::Marker(square(RECORD, false)), "error of the base")];
    let falls = |pair: &[EvidenceStep]| pair[1].fitted_deg <= pair[0].fitted_deg;
    if data.steps.windows(2).any(falls) {
        entries.push(Entry::new(Sample::Marker(square(HEADING, false)), "taken away by an effect"));
    }
    if !data.steps.windows(2).all(falls) {
        entries.push(Entry::new(Sample::Marker(square(BEFORE, false)), "added by an effect"));
    }
    if data.steps.iter().any(|step| step.held_out_deg.is_some()) {
        entries.push(Entry::new(Sample::Marker(HELD_OUT), "(on held-out records)"));
    }
    sheet.legend(&entries);
    let errors = data.steps.iter().flat_map(|step| [Some(step.fitted_deg), step.held_out_deg]).flatten();
    let most = errors.filter(|error| error.is_finite()).fold(0.0, f64::max);
    // Room for the number beside the longest bar.
    let reach = if theme.is_narrow() { 1.4 } else { 1.2 };
    let x = Side::new(Axis::linear(0.0, reach * most, Steps::Decimal), "rms error of the heading [°]");
    let names = data.steps.iter().map(|step| step.name.clone()).collect();
    for panel in &sheet.grid(Grid::stack(x, vec![rows(names, theme)])) {
        let mut before = 0.0;
        for (number, step) in data.steps.iter().enumerate() {
            let look = match number {
                0 => square(RECORD, false),
                _ if step.fitted_deg <= before => square(HEADING, false),
                _ => square(BEFORE, false),
            };
            bar(sheet, panel, number, [before, step.fitted_deg], &look);
            // Where this bar ends, the next one begins.
            if let (Some(x), Some(y), true) =
                (panel.across(step.fitted_deg), panel.up(number as f64), number + 1 < data.steps.len())
            {
                sheet.scene.line(Layer::Grid, [(x, y), (x, y + row(theme))], Stroke::solid(INK, theme.thin));
            }
            if let Some(error) = step.held_out_deg {
                panel.marker(&mut sheet.scene, (error, number as f64), 1.3 * theme.marker, &HELD_OUT);
            }
            let bar_end = before.max(step.fitted_deg);
            let mark = step.held_out_deg.filter(|error| *error > bar_end);
            let [fitted, held_out] = [Some(step.fitted_deg), step.held_out_deg]
                .map(|error| error.map(|error| format!("{}°", number::significant(error, 3))).unwrap_or_default());
            // Between the bar and the mark where there is room, else both behind the mark.
            let room = mark.and_then(|mark| Some(panel.across(mark)? - panel.across(bar_end)?));
            let needed = Text::new(fitted.as_str(), theme.small_font).width() + 2.0 * theme.marker + theme.small_font;
            let words = match (mark, step.held_out_deg) {
                (Some(mark), _) if room.is_some_and(|room| room > needed) => vec![(bar_end, fitted), (mark, held_out)],
                (_, Some(_)) => vec![(mark.unwrap_or(bar_end), format!("{fitted} ({held_out})"))],
                (_, None) => vec![(bar_end, fitted)],
            };
            for (value, words) in words {
                let text = Text::new(words, theme.small_font);
                let Some((x, y)) = beside(panel, number, value, theme) else { continue };
                let x = x.min(panel.rect.right() - text.width() - 0.3 * theme.small_font);
                sheet.scene.text_on_ground(Layer::Note, (x, y), text);
            }
            before = step.fitted_deg;
        }
    }
}

fn bars(data: &Evidence, sheet: &mut Sheet, theme: &Theme) {
    let look = |fate| square(colour(fate), fate == Fate::NotObservable);
    let mut entries: Vec<Entry> = FATES
        .iter()
        .filter(|(fate, _)| data.bars.iter().any(|bar| bar.fate == *fate))
        .map(|(fate, label)| Entry::new(Sample::Marker(look(*fate)), *label))
        .collect();
    let limit = Stroke::solid(INK, theme.line).dashed(DASHED);
    entries.push(Entry::new(Sample::Line(limit), "needed to be added"));
    sheet.legend(&entries);
    let gains = || data.bars.iter().flat_map(|bar| [bar.gain, bar.threshold]).filter(|gain| gain.is_finite());
    let (least, most) = (gains().fold(0.0, f64::min), gains().fold(0.0, f64::max));
    // Room for the numbers at the right.
    let room = if theme.is_narrow() { 0.6 } else { 0.14 } * (most - least);
    let least = if least < 0.0 { least - 0.04 * (most - least) } else { least };
    let title = format!("fall of {} when added to the final model", symbol("BIC"));
    let x = Side::new(Axis::linear(least, most + room, Steps::Decimal), title);
    let names = data.bars.iter().map(|bar| bar.name.clone()).collect();
    for panel in &sheet.grid(Grid::stack(x, vec![rows(names, theme)])) {
        panel.vertical(&mut sheet.scene, Layer::Grid, 0.0, Stroke::solid(INK, theme.thin));
        for (number, one) in data.bars.iter().enumerate() {
            bar(sheet, panel, number, [0.0, one.gain], &look(one.fate));
            if let Some(y) = panel.up(number as f64) {
                let text = Text::new(number::significant(one.gain, 3), theme.small_font).anchor(Anchor::End);
                let place = (panel.rect.right() - 0.4 * theme.small_font, y + 0.35 * theme.small_font);
                sheet.scene.text_on_ground(Layer::Note, place, text);
            }
            if let (Some(x), Some(y)) = (panel.across(one.threshold), panel.up(number as f64)) {
                let half = 0.5 * row(theme);
                sheet.scene.line(Layer::Note, [(x, y - half), (x, y + half)], limit);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_and_what_was_left_are_told_with_their_numbers() {
        let step = |name: &str, fitted_deg, held_out_deg| EvidenceStep { name: name.into(), fitted_deg, held_out_deg };
        let data = Evidence {
            steps: vec![step("base", 2.0, Some(2.5)), step("+ damping", 0.5, None), step("+ delay", 0.75, Some(0.7))],
            bars: vec![EvidenceBar { name: "wind".into(), gain: -5.5, threshold: 10.0, fate: Fate::Rejected }],
            dropped: vec!["memory is not kept".into()],
            ..Evidence::default()
        };
        let figure = evidence(&data, &Theme::paper(85.0, 300.0).unwrap());
        for text in
            ["2.00° (2.50°)", "0.500°", "held-out", "−5.50", "+ delay", "memory is not kept", "added by an effect"]
        {
            assert!(figure.svg().contains(text), "{text}");
        }
        assert!(!evidence(&Evidence::default(), &Theme::screen()).svg().contains("NaN"));
    }
}
