//! The figure that stands for a study: its finding above it, the last of its rows of panels (T before K), the methods
//! it is about in colour and the others grey, methods with one line as one.

use campaign::statistics::distinct;
use report::figures::{Layer, LayerKind, LayeredPanel, NamedRows, Panels, Plot, RowItem, RowKind};
use report::palette::QUIET;
use report::{CurveOrigin, PlotCurve};

/// A chart as the figure that stands for a study; `about` are the names of the methods it is about, none: all.
pub fn of_chart(mut plot: Plot, about: &[String]) -> Plot {
    match &mut plot {
        Plot::Panels(data) => of_panels(data, about),
        Plot::Rows(data) => of_rows(data, about),
        Plot::Cells(_) | Plot::ZigZag(_) => {}
    }
    plot
}

fn is_quiet(name: Option<&String>, about: &[String]) -> bool {
    let is_method = |name: &String| name != CurveOrigin::Bound.label();
    !about.is_empty() && name.is_some_and(|name| is_method(name) && !about.contains(name))
}

fn of_panels(data: &mut Panels, about: &[String]) {
    data.names_aside = true;
    for stack in &mut data.stacks {
        let last = stack.rows.len().saturating_sub(1);
        let heads: Vec<Option<String>> = stack.panels.iter_mut().map(|panel| panel.head.take()).collect();
        stack.rows.drain(..last);
        stack.panels.drain(..last * stack.x.len());
        stack.panels.iter_mut().zip(heads).for_each(|(panel, head)| panel.head = head);
        stack.rows.iter_mut().for_each(|row| row.height = 0.3);
        merge(&mut stack.panels, about);
        for panel in &mut stack.panels {
            for layer in &mut panel.layers {
                let first = layer.name.as_ref().and_then(|name| name.split('\n').next()).map(str::to_owned);
                if is_quiet(first.as_ref(), about)
                    && let LayerKind::Marks(marks) = &mut layer.kind
                {
                    marks.look.colour = QUIET;
                    marks.joined = marks.joined.map(|pen| report::figures::Pen { colour: QUIET, ..pen.width(0.7) });
                }
            }
            // What the figure is about stands over the rest.
            panel.layers.sort_by_key(|layer| !matches!(&layer.kind, LayerKind::Marks(own) if own.look.colour == QUIET));
        }
    }
}

fn of_rows(data: &mut NamedRows, about: &[String]) {
    data.columns.drain(..data.columns.len().saturating_sub(1));
    for RowItem { name, kind, .. } in data.columns.iter_mut().flat_map(|column| &mut column.rows).flatten() {
        if let RowKind::Mark(look, ..) = kind
            && is_quiet(name.as_ref(), about)
        {
            look.colour = QUIET;
            *name = Some(String::from("other methods"));
        }
    }
}

/// Lines nearer to each other than this share of their values are one.
const SAME_LINE: f64 = 0.03;

fn is_same(one: &PlotCurve, other: &PlotCurve) -> bool {
    let near = |((x, y), (own_x, own_y)): ((f64, f64), (f64, f64))| {
        x == own_x && (y == own_y || (y - own_y).abs() <= SAME_LINE * y.abs() && y.is_finite())
    };
    one.x.len() == other.x.len() && one.pairs().zip(other.pairs()).all(near)
}

/// Joins methods whose lines lie on each other in all panels, under the names of all; one that the figure is about
/// gives the line its look.
fn merge(panels: &mut [LayeredPanel], about: &[String]) {
    let is_method = |layer: &&Layer| matches!(layer.kind, LayerKind::Marks(_));
    let layers = panels.iter().flat_map(|panel| &panel.layers).filter(is_method);
    let mut names = distinct(layers.filter_map(|layer| layer.name.clone()));
    names.sort_by_key(|name| about.iter().position(|one| one == name).unwrap_or(about.len()));
    let own = |panel: &LayeredPanel, name: &String| -> PlotCurve {
        let layer = panel.layers.iter().find(|layer| layer.name.as_ref() == Some(name));
        layer.map_or_else(PlotCurve::default, |layer| layer.curve.clone())
    };
    let mut lines: Vec<Vec<String>> = Vec::new();
    for name in names {
        let same = |line: &&mut Vec<String>| panels.iter().all(|one| is_same(&own(one, &line[0]), &own(one, &name)));
        match lines.iter_mut().find(same) {
            Some(line) => line.push(name),
            None => lines.push(vec![name]),
        }
    }
    for panel in panels {
        panel
            .layers
            .retain(|layer| !is_method(&layer) || lines.iter().any(|line| layer.name.as_ref() == Some(&line[0])));
        for layer in &mut panel.layers {
            let line = lines.iter().find(|line| layer.name.as_ref() == Some(&line[0]));
            layer.name = line.map_or_else(|| layer.name.take(), |line| Some(line.join("\n")));
        }
    }
}
