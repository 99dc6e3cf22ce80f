//! Values of several methods in named rows: errors, coverage or failures at the named points of a study, or ratios with
//! the methods themselves as rows. Names stand where they can be long.

use serde::{Deserialize, Serialize};

use super::error_curves::Scale;
use super::shared::{Reference95, distinct};
use crate::axis::Axis;
use crate::dimension::Dimensions;
use crate::figure::Figure;
use crate::layout::{Sheet, Side};
use crate::legend::{Entry, Sample};
use crate::palette::{INK, Look, Origin, QUIET};
use crate::panel::Panel;
use crate::scene::{Layer, Scene, Stroke};
use crate::theme::Theme;

/// One value with its interval.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Dot {
    /// Whose value; decides how the marker looks.
    pub origin: Origin,
    /// The value.
    pub x: f64,
    /// 95 % interval of the value.
    pub interval: Option<[f64; 2]>,
    /// An outline: a second value of the same method.
    pub hollow: bool,
}

/// One panel: values of all rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DotColumn {
    /// Title with unit of its axis.
    pub x_title: String,
    /// Division of its axis.
    pub scale: Scale,
    /// A value to compare with.
    pub reference: Option<Reference95>,
    /// Values above it do not set the axis: an arrow at the edge stands for them.
    #[serde(default)]
    pub limit: Option<f64>,
    /// Per row, in the order of [`DotPlot::names`].
    pub rows: Vec<Vec<Dot>>,
}

/// What [`dots`] draws.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DotPlot {
    /// Title above the figure.
    pub title: Option<String>,
    /// Names of the rows, from the top.
    pub names: Vec<String>,
    /// The panels, side by side.
    pub columns: Vec<DotColumn>,
    /// Whether rows are methods, so that no key is needed.
    pub rows_are_methods: bool,
    /// Whom the figure is not about: grey, under one name in the key.
    #[serde(default)]
    pub quiet: Vec<Origin>,
    /// A remark under the figure.
    pub note: Option<String>,
}

/// Draws the panels side by side, or above each other when the figure is narrow.
pub fn dots(data: &DotPlot, theme: &Theme) -> Figure {
    let mut sheet = Sheet::new(theme, data.title.as_deref());
    if !data.rows_are_methods {
        let dots = data.columns.iter().flat_map(|column| &column.rows).flatten();
        let origins = distinct(dots.map(|dot| &dot.origin));
        let (quiet, loud): (Vec<_>, Vec<_>) = origins.into_iter().partition(|origin| data.quiet.contains(origin));
        let sample = |origin: &Origin| match origin {
            Origin::Bound => Sample::Upright(bound_stroke(theme)),
            _ => Sample::Marker(origin.look()),
        };
        let mut entries: Vec<Entry> = loud.iter().map(|origin| Entry::new(sample(origin), origin.label())).collect();
        let others = Look { colour: QUIET, ..Origin::Record.look() };
        entries.extend((!quiet.is_empty()).then(|| Entry::new(Sample::Marker(others), "other methods")));
        sheet.legend(&entries);
    }
    let in_lines = |dots: &Vec<Dot>| dots.iter().filter(|dot| dot.origin != Origin::Bound).count();
    let most = data.columns.iter().flat_map(|column| &column.rows).map(in_lines).max().unwrap_or(1);
    let lines = if data.rows_are_methods { 1.0 } else { most.max(1) as f64 };
    let row = (0.62 * lines + 1.1) * theme.tick_font;
    let names = Side::new(Axis::names(data.names.clone()), "");
    let height = (data.names.len().max(1) as f64 + 0.2) * row;
    let columns = data.columns.iter().map(|column| Side::new(axis(column), column.x_title.clone()));
    let panels = sheet.side_by_side(columns, (names, height));
    for (panel, column) in panels.iter().zip(&data.columns) {
        if let Some(reference) = &column.reference {
            reference.vertical(panel, &mut sheet.scene, theme);
        }
        for (row, dots) in column.rows.iter().enumerate() {
            draw_row(panel, &mut sheet.scene, theme, row, dots, data);
        }
    }
    if let Some(note) = &data.note {
        sheet.note(note);
    }
    sheet.finish()
}

fn axis(column: &DotColumn) -> Axis {
    let sets = |dot: &&Dot| column.limit.is_none_or(|limit| dot.x <= limit);
    let dots = || column.rows.iter().flatten().filter(sets);
    column.scale.around(dots().map(|dot| dot.x), dots().filter_map(|dot| dot.interval), column.reference)
}

fn bound_stroke(theme: &Theme) -> Stroke {
    Stroke::solid(INK, 1.3 * theme.line)
}

fn draw_row(panel: &Panel, scene: &mut Scene, theme: &Theme, row: usize, dots: &[Dot], data: &DotPlot) {
    let together = data.rows_are_methods;
    let Some(middle) = panel.up(row as f64) else { return };
    // A bound is a line over its row, as it is one in the other figures.
    for x in dots.iter().filter(|dot| dot.origin == Origin::Bound).filter_map(|dot| panel.across(dot.x)) {
        let half = 0.5 * (panel.up(0.0).unwrap_or(0.0) - panel.up(1.0).unwrap_or(0.0)).abs();
        let (top, bottom) = ((middle - half).max(panel.rect.y), (middle + half).min(panel.rect.bottom()));
        if panel.rect.contains((x, middle)) {
            scene.line(Layer::Grid, [(x, top), (x, bottom)], bound_stroke(theme));
        }
    }
    let dots: Vec<&Dot> = dots.iter().filter(|dot| dot.origin != Origin::Bound).collect();
    let lines = if together { 1 } else { dots.len() };
    for (line, dot) in dots.into_iter().enumerate() {
        // Methods of one row stand below each other, so that their bars do not hide each other.
        let aside = if together { 0.0 } else { (line as f64 - (lines - 1) as f64 / 2.0) * 0.62 * theme.tick_font };
        let Some(x) = panel.across(dot.x) else { continue };
        let y = middle + aside;
        let own = dot.origin.look();
        let colour = if data.quiet.contains(&dot.origin) { QUIET } else { own.colour };
        let look = Look { colour, hollow: dot.hollow || own.hollow, ..own };
        if let Some([low, high]) = dot.interval {
            let end =
                |value: f64, edge: f64| panel.across(value).unwrap_or(edge).clamp(panel.rect.x, panel.rect.right());
            let (left, right) = (end(low.min(high), panel.rect.x), end(low.max(high), panel.rect.right()));
            scene.line(Layer::Data, [(left, y), (right, y)], Stroke::solid(look.colour, 0.8 * theme.line));
        }
        if panel.rect.contains((x, y)) {
            scene.marker(Layer::Data, (x, y), theme.marker, &look);
        } else {
            let (edge, direction) = if x > panel.rect.x { (panel.rect.right(), 1.0) } else { (panel.rect.x, -1.0) };
            Dimensions::head(scene, (edge, y), (direction, 0.0), 0.6 * theme.small_font, look.colour);
        }
    }
    // A line between rows with several methods keeps them together.
    if !together
        && row > 0
        && let (Some(above), Some(own)) = (panel.up(row as f64 - 1.0), panel.up(row as f64))
    {
        let y = 0.5 * (above + own);
        let stroke = Stroke { opacity: 0.35, ..Stroke::solid(INK, 0.6 * theme.thin) };
        scene.line(Layer::Grid, [(panel.rect.x, y), (panel.rect.right(), y)], stroke);
    }
}
