//! Named rows below each other over one axis, their names left of the frame and broken where they are long: intervals,
//! bars from zero, marks and limits.

use serde::{Deserialize, Serialize};

use super::shared::widened;
use crate::axis::{self, Axis};
use crate::figure::Figure;
use crate::layout::{Grid, Sheet, Side, wrap};
use crate::legend::{Entry, Sample};
use crate::palette::{BEFORE, HEADING, INK, Look, Marker, RECORD, SOLID};
use crate::panel::Panel;
use crate::scene::{Anchor, Layer, Scene, Stroke, Text};
use crate::theme::Theme;
use crate::ticks::Steps;

/// What one part of all rows is.
#[derive(Debug, Clone, PartialEq)]
pub enum RowPart {
    /// Thin intervals.
    Thin(Vec<Option<[f64; 2]>>),
    /// Thick intervals.
    Thick(Vec<Option<[f64; 2]>>),
    /// Bars from zero.
    Bars(Vec<Option<f64>>),
    /// Marks, this share of a row below its middle.
    Marks(Look, f64, Vec<Option<f64>>),
    /// Lines from the bottom to the top of a row.
    Limits(Vec<Option<f64>>),
}

/// Rows with their parts.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rows {
    /// Title above the figure.
    pub title: Option<String>,
    /// Title of the axis with unit.
    pub x_title: String,
    /// Names from top to bottom, and whether they are grey.
    pub names: Vec<(String, bool)>,
    /// Name in the key and values of every part, the first at the bottom; and whether it may be cut where it leaves the
    /// range of everything else by more than that range.
    pub parts: Vec<(&'static str, RowPart, bool)>,
}

impl RowPart {
    /// All ends of a row.
    fn values(&self, row: usize) -> [Option<f64>; 2] {
        match self {
            Self::Thin(own) | Self::Thick(own) => {
                own.get(row).copied().flatten().map_or([None; 2], |ends| ends.map(Some))
            }
            Self::Bars(own) | Self::Limits(own) | Self::Marks(_, _, own) => [own.get(row).copied().flatten(), None],
        }
    }

    fn stroke(&self, theme: &Theme) -> Stroke {
        match self {
            Self::Thin(_) | Self::Marks(..) => Stroke::solid(HEADING, theme.line),
            // Pale, so that the marks on it can be seen, and higher than a mark, so that a narrow one is seen too.
            Self::Thick(_) => Stroke { opacity: 0.55, ..Stroke::solid(HEADING, 2.9 * theme.marker) },
            Self::Bars(_) => Stroke { opacity: 0.45, ..Stroke::solid(RECORD, 0.75 * theme.tick_font) },
            Self::Limits(_) => Stroke::solid(INK, 1.6 * theme.line),
        }
    }

    fn sample(&self, theme: &Theme) -> Sample {
        match self {
            Self::Marks(look, ..) => Sample::Marker(*look),
            Self::Limits(_) => Sample::Upright(self.stroke(theme)),
            _ => Sample::Line(self.stroke(theme)),
        }
    }

    /// Draws the part of a row about its height; tells whether something lies beyond the axis.
    fn draw(&self, scene: &mut Scene, theme: &Theme, panel: &Panel, (row, y, pitch): (usize, f64, f64)) -> bool {
        let stroke = self.stroke(theme);
        let head = 0.6 * theme.small_font;
        match (self, self.values(row)) {
            (Self::Thin(_) | Self::Thick(_), [Some(low), Some(high)]) => panel.bar(scene, y, [low, high], stroke, head),
            (Self::Bars(_), [Some(value), _]) => panel.bar(scene, y, [0.0, value], stroke, head),
            (Self::Limits(_), [Some(limit), _]) => {
                if let Some(x) = panel.across(limit).filter(|x| panel.rect.contains((*x, y))) {
                    let half = 0.42 * pitch;
                    scene.line(Layer::Data, [(x, y - half), (x, y + half)], stroke);
                }
                false
            }
            (Self::Marks(look, aside, _), [Some(value), _]) if value.is_finite() => {
                let y = y + aside * pitch;
                match panel.across(value).map(|x| (x, y)) {
                    Some(place) if panel.rect.contains(place) => scene.marker(Layer::Data, place, theme.marker, look),
                    _ => return panel.bar(scene, y, [value; 2], Stroke { colour: look.colour, ..stroke }, head),
                }
                false
            }
            _ => false,
        }
    }
}

/// Largest share of the page for the names of the rows.
const NAMES: f64 = 0.42;

/// Draws the rows below each other.
pub fn rows(data: &Rows, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    let is_there = |part: &RowPart| (0..data.names.len()).any(|row| part.values(row)[0].is_some());
    let shown = data.parts.iter().filter(|(_, part, _)| is_there(part));
    sheet.legend(&shown.map(|(name, part, _)| Entry::new(part.sample(theme), *name)).collect::<Vec<_>>());
    let names: Vec<Vec<String>> =
        data.names.iter().map(|(name, _)| wrap(name, theme.tick_font, false, NAMES * theme.width)).collect();
    let lines = names.iter().map(Vec::len).max().unwrap_or(1).max(1);
    let pitch = (0.95 + 1.15 * lines as f64) * theme.tick_font;
    let widest = names.iter().flatten().map(|name| Text::new(name.as_str(), theme.tick_font).width());
    let side = Side::new(Axis::names(vec![String::new(); names.len()]), "");
    let row = (side, (names.len().max(1) as f64 + 0.2) * pitch);
    let mut grid = Grid::stack(Side::new(axis(data), data.x_title.clone()), vec![row]);
    grid.left = Some(sheet.left_margin(&grid) + widest.fold(0.0, f64::max));
    let mut beyond = false;
    for panel in &sheet.grid(grid) {
        for (row, lines) in names.iter().enumerate() {
            let Some(y) = panel.up(row as f64) else { continue };
            label(&mut sheet.scene, theme, panel, y, lines, data.names[row].1);
            for (_, part, _) in &data.parts {
                beyond |= part.draw(&mut sheet.scene, theme, panel, (row, y, pitch));
            }
            let is_finite = |part: &RowPart| part.values(row)[0].is_some_and(f64::is_finite);
            if !data
                .parts
                .iter()
                .any(|(_, part, _)| !matches!(part, RowPart::Thin(_) | RowPart::Thick(_)) && is_finite(part))
            {
                let text = Text::new("no value", theme.small_font).anchor(Anchor::Middle).colour(RECORD);
                let place = (panel.rect.x + panel.rect.w / 2.0, y + text.centring());
                sheet.scene.text_on_ground(Layer::Note, place, text);
            }
        }
    }
    if beyond {
        sheet.note("Arrows: beyond the axis.");
    }
    sheet.finish()
}

/// Writes the name of a row left of the frame.
fn label(scene: &mut Scene, theme: &Theme, panel: &Panel, y: f64, lines: &[String], is_grey: bool) {
    let right = panel.rect.x - 0.62 * theme.tick_font;
    let colour = if is_grey { RECORD } else { INK };
    for (index, line) in lines.iter().enumerate() {
        let text = Text::new(line.as_str(), theme.tick_font).anchor(Anchor::End).colour(colour);
        let down = (index as f64 - (lines.len() - 1) as f64 / 2.0) * 1.15 * theme.tick_font;
        scene.text(Layer::Frame, (right, y + down + text.centring()), text);
    }
}

/// Covers zero and everything that is not cut, and the rest as far as there is room.
fn axis(data: &Rows) -> Axis {
    let ends = |may_be_cut: bool| {
        let parts = data.parts.iter().filter(move |(_, _, own)| *own == may_be_cut);
        parts.flat_map(|(_, part, _)| (0..data.names.len()).flat_map(|row| part.values(row))).flatten()
    };
    let (lo, hi) = axis::range(ends(false).chain([0.0])).unwrap_or((0.0, 0.0));
    let room = if hi > lo { hi - lo } else { f64::INFINITY };
    let ((lo, hi), _) = widened((lo, hi), ends(true).filter(|end| end.is_finite()), room);
    if lo == hi {
        return Axis::linear(0.0, 1.0, Steps::Decimal);
    }
    // The axis ends at zero where everything lies on one side of it.
    let pad = 0.05 * (hi - lo);
    Axis::linear(if lo < 0.0 { lo - pad } else { lo }, if hi > 0.0 { hi + pad } else { hi }, Steps::Decimal)
}

/// One predicted quantity; all numbers in the unit of the figure.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct OvershootRow {
    /// Name of the quantity, such as "20/20 first overshoot".
    pub label: String,
    /// Median of the drawn ships.
    pub median: f64,
    /// The interval that holds half of them.
    pub ci50: [f64; 2],
    /// The interval that holds nine tenths of them.
    pub ci90: [f64; 2],
    /// What was measured.
    pub measured: Option<f64>,
    /// The largest value that the IMO standard allows.
    pub limit: Option<f64>,
    /// Whether the manoeuvre goes beyond what the records hold.
    pub extrapolated: bool,
}

/// What [`overshoots`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Overshoots {
    /// Title above the figure.
    pub title: Option<String>,
    /// Unit of every number, such as "°" or "L".
    pub unit: String,
    /// The rows from top to bottom.
    pub rows: Vec<OvershootRow>,
}

/// Draws predicted quantities of manoeuvres as intervals, against what was measured and what is allowed.
pub fn overshoots(data: &Overshoots, theme: &Theme) -> Figure {
    self::rows(&data.named(), theme)
}

impl Overshoots {
    fn named(&self) -> Rows {
        let rows = &self.rows;
        let of = |of: &dyn Fn(&OvershootRow) -> Option<f64>| rows.iter().map(of).collect::<Vec<_>>();
        let median = |hollow: bool| {
            let look = Look { colour: HEADING, marker: Marker::Circle, dash: SOLID, hollow };
            RowPart::Marks(look, 0.0, of(&|row| Some(row.median).filter(|_| row.extrapolated == hollow)))
        };
        let measured = Look { colour: BEFORE, marker: Marker::Diamond, dash: SOLID, hollow: true };
        let unit = if self.unit.is_empty() { String::new() } else { format!(" [{}]", self.unit) };
        Rows {
            title: self.title.clone(),
            x_title: format!("predicted value{unit}"),
            names: rows.iter().map(|row| (row.label.clone(), row.extrapolated)).collect(),
            parts: vec![
                ("90 %", RowPart::Thin(rows.iter().map(|row| Some(row.ci90)).collect()), true),
                ("50 % of the drawn ships", RowPart::Thick(rows.iter().map(|row| Some(row.ci50)).collect()), false),
                ("IMO limit", RowPart::Limits(of(&|row| row.limit)), false),
                ("median", median(false), false),
                ("extrapolated (name in grey)", median(true), false),
                // Under the bar, so that it does not hide a median nearby.
                ("measured", RowPart::Marks(measured, 0.34, of(&|row| row.measured)), false),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(median: f64, half: f64) -> OvershootRow {
        OvershootRow {
            median,
            ci50: [median - 0.4 * half, median + 0.4 * half],
            ci90: [median - half, median + half],
            ..OvershootRow::default()
        }
    }

    #[test]
    fn the_axis_begins_at_zero_where_nothing_is_negative() {
        let of = |rows: Vec<OvershootRow>| axis(&Overshoots { rows, ..Overshoots::default() }.named());
        assert_eq!(of(vec![row(10.0, 2.0), row(20.0, 3.0)]).fraction(0.0), Some(0.0));
        assert!(of(vec![row(10.0, 12.0)]).fraction(-2.0).is_some_and(|f| f > 0.0));
        // An interval that runs far off is cut.
        let wide = of(vec![row(10.0, 5.0), OvershootRow { ci90: [8.0, 1e6], ..row(20.0, 3.0) }]);
        assert!(wide.fraction(20.0).is_some_and(|f| f > 0.4));
    }
}
