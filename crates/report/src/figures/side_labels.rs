//! Layer names right of the frame, in place of a legend: as near to their layers as possible without touching.

use plotters::style::text_anchor::HPos;

use super::panels::{Layer, PanelGroup, Panels};
use crate::backend::PlotResult;
use crate::canvas::{PagePoint, Stroke, TextLine};
use crate::chart::Chart;
use crate::markup::is_markup;
use crate::number::significant;
use crate::theme::Theme;

/// Free space between the frame and a name, in small-font sizes.
const GAP: f64 = 0.8;

fn text(layer: &Layer, theme: &Theme) -> TextLine {
    let name = layer.name.as_deref().unwrap_or_default();
    TextLine { is_bold: true, colour: layer.colour(), ..TextLine::new(name, theme.small_font, HPos::Left) }
}

/// Width of the names with the gap to the frame, points.
pub(super) fn width(data: &Panels, theme: &Theme) -> f64 {
    let layers = data.groups.iter().flat_map(|group| &group.panels).flat_map(|panel| &panel.layers);
    let named = layers.filter(|layer| data.names_aside && layer.name.is_some());
    let widths = named.map(|layer| text(layer, theme).width());
    widths.reduce(f64::max).map_or(0.0, |width| width + GAP * theme.small_font)
}

/// Anchor of a name: the rightmost point of its layer in the frame, where an infinite value is at the upper edge;
/// `None` without a point in the frame.
fn anchor(chart: &Chart, layer: &Layer) -> Option<PagePoint> {
    let place = |(x, y): (f64, f64)| match y.is_infinite() {
        true => Some((chart.page_x(x)?, chart.rect.y)),
        false => chart.inside(x, y),
    };
    layer.curve.pairs().filter_map(place).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Writes the names right of the last panel of every row of `count`; returns the names of the layers without a point in
/// the frame, with the coordinates of their first point.
pub(super) fn draw(charts: &[Chart], group: &PanelGroup, count: usize, theme: &Theme) -> PlotResult<Vec<String>> {
    let symbol = |title: &str| title.split(" [").next().unwrap_or_default().replace(is_markup, "");
    let across = group.x.first().map_or_else(String::new, |ruler| symbol(&ruler.title));
    let mut outside = Vec::new();
    for (index, (chart, panel)) in charts.iter().zip(&group.panels).enumerate().filter(|(k, _)| (k + 1) % count == 0) {
        let row = &group.rows[if group.multiples_across.is_some() { 0 } else { index / count }];
        for layer in names(chart, theme, &panel.layers)? {
            let (x, y) = layer.curve.pairs().next().unwrap_or((f64::NAN, f64::NAN));
            let (x, y) = (significant(x, 3), significant(y, 3));
            let name = layer.name.as_deref().unwrap_or_default();
            outside.push(format!("{name} ({across} = {x}, {} = {y})", symbol(&row.y.title)));
        }
    }
    Ok(outside)
}

/// Writes the names of a panel; returns the layers without a point in the frame.
fn names<'a>(chart: &Chart, theme: &Theme, layers: &'a [Layer]) -> PlotResult<Vec<&'a Layer>> {
    let (named, outside): (Vec<_>, Vec<_>) = layers
        .iter()
        .filter(|layer| layer.name.is_some())
        .map(|layer| (layer, anchor(chart, layer)))
        .partition(|(_, anchor)| anchor.is_some());
    let mut labels: Vec<(PagePoint, &Layer)> =
        named.into_iter().filter_map(|(layer, anchor)| Some((anchor?, layer))).collect();
    labels.sort_by(|a, b| a.0.1.total_cmp(&b.0.1));
    let line = 1.2 * theme.small_font;
    let wanted: Vec<f64> = labels.iter().map(|(at, _)| at.1).collect();
    let middles = spread(&wanted, line, [chart.rect.y - 0.5 * line, chart.rect.bottom() + 0.5 * line]);
    let right = chart.rect.right();
    for ((from, layer), middle) in labels.iter().zip(middles) {
        let knee = right + 0.4 * theme.small_font;
        let thin = Stroke { opacity: 0.6, ..Stroke::solid(layer.colour(), theme.thin) };
        chart.canvas.line(&[*from, (right, middle), (knee, middle)], thin)?;
        chart.canvas.text((knee + 0.3 * theme.small_font, middle), &text(layer, theme))?;
    }
    Ok(outside.into_iter().map(|(layer, _)| layer).collect())
}

/// Middles of labels of equal height, without overlap and near the `wanted` middles, which ascend; all in points.
fn spread(wanted: &[f64], height: f64, [top, bottom]: [f64; 2]) -> Vec<f64> {
    let mut free = top;
    let mut tops: Vec<f64> = Vec::with_capacity(wanted.len());
    for middle in wanted {
        tops.push((middle - 0.5 * height).max(free));
        free = tops[tops.len() - 1] + height;
    }
    let mut limit = bottom;
    for top in tops.iter_mut().rev() {
        *top = top.min(limit - height);
        limit = *top;
    }
    tops.iter().map(|top| top + 0.5 * height).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_their_order_and_their_distance() {
        let of = |wanted: &[f64]| spread(wanted, 5.0, [-2.5, 102.5]);
        assert_eq!(of(&[10.0, 11.0, 50.0]), [10.0, 15.0, 50.0]);
        assert_eq!(of(&[97.0, 98.0, 99.0]), [90.0, 95.0, 100.0]);
        assert_eq!(of(&[-5.0]), [0.0]);
    }
}
