//! Maps over two axes, and distributions of errors: of all trials of a study with one cell, or of cells whose detail
//! was asked for.

use campaign::design::Design;
use campaign::summary::{self, PredictionSummary, Summary};
use report::Origin;
use report::figures::{
    Dot, DotColumn, DotPlot, Ellipse, HeatMap, HeatPanel, KtPanel, KtScatter, Reference95, Scale, Violin, ViolinPanel,
    Violins,
};

use super::charts::{Quantity, origin};

/// Fewest points of an axis that make a map.
const MAP: usize = 3;

/// Maps of the errors of K, of T and of the validation for a design of two axes.
pub fn heat_maps(design: &Design, summary: &Summary) -> Vec<(String, HeatMap)> {
    let labels = |axis: usize| {
        let mut labels: Vec<String> = Vec::new();
        for cell in &design.cells {
            if !labels.contains(&cell.labels[axis]) {
                labels.push(cell.labels[axis].clone());
            }
        }
        labels
    };
    if design.axes.len() != 2 {
        return Vec::new();
    }
    let (y_labels, x_labels) = (labels(0), labels(1));
    if y_labels.len() < MAP || x_labels.len() < MAP {
        return Vec::new();
    }
    let of = |quantity: Quantity, panel: usize, stem: &str, value_title: &str| {
        // Cells are the product of the axes, the first axis slowest.
        let value = |x: usize, y: usize, method: usize| {
            let record = summary.record(y * x_labels.len() + x, method)?;
            Some(quantity.of(record, panel)?.value)
        };
        let map = HeatMap {
            title: None,
            x_title: design.axes[1].clone(),
            y_title: design.axes[0].clone(),
            x_labels: x_labels.clone(),
            y_labels: y_labels.clone(),
            value_title: value_title.to_owned(),
            scale: Scale::Log,
            panels: (0..design.methods.len())
                .map(|method| HeatPanel {
                    title: design.methods[method].label.clone(),
                    values: (0..y_labels.len())
                        .map(|y| (0..x_labels.len()).map(|x| value(x, y, method)).collect())
                        .collect(),
                })
                .collect(),
        };
        (format!("heat-map-{stem}"), map)
    };
    let is_there =
        |(_, map): &(String, HeatMap)| map.panels.iter().flat_map(|panel| &panel.values).flatten().any(Option::is_some);
    let maps = [
        of(Quantity::Rms, 0, "K", "rms error of K [%]"),
        of(Quantity::Rms, 1, "T", "rms error of T [%]"),
        of(Quantity::Validation, 0, "validation", "validation error of the heading [°]"),
    ];
    maps.into_iter().filter(is_there).collect()
}

/// Distributions of the errors in the cells whose detail was asked for; nothing for fewer than ten trials.
pub fn violins(design: &Design, summary: &Summary) -> Vec<(usize, Violins)> {
    let panel = |detail: &summary::CellDetail,
                 x_title: &str,
                 violin: fn(&summary::MethodDetail) -> &Option<summary::ErrorDensity>| {
        let of_method = |(method, own): (usize, &summary::MethodDetail)| Violin {
            origin: origin(design, method),
            density: violin(own).as_ref().map_or_else(Vec::new, |violin| violin.density.clone()),
            quantiles: violin(own).as_ref().map(|violin| violin.quantiles),
        };
        let violins = detail.methods.iter().enumerate().map(of_method).collect();
        ViolinPanel { x_title: x_title.to_owned(), violins }
    };
    let of_cell = |detail: &summary::CellDetail| {
        let panels = vec![
            panel(detail, "error of K [%]", |own| &own.violin_k),
            panel(detail, "error of T [%]", |own| &own.violin_t),
        ];
        let trials = summary.record(detail.cell, 0).map_or(0, |record| record.trials);
        let known = panels.iter().flat_map(|panel| &panel.violins).any(|violin| violin.quantiles.is_some());
        (trials >= 10 && known).then_some((detail.cell, Violins { title: None, panels }))
    };
    summary.details.iter().filter_map(of_cell).collect()
}

/// Clouds of errors in the cells whose detail was asked for.
pub fn scatters(design: &Design, summary: &Summary) -> Vec<(usize, KtScatter)> {
    let of_cell = |detail: &summary::CellDetail| {
        let bound = design.cells[detail.cell].bound_percent2;
        let bound = bound.map(|covariance| Ellipse { centre: (0.0, 0.0), covariance });
        let panel = |(method, own): (usize, &summary::MethodDetail)| KtPanel {
            origin: origin(design, method),
            points: own.cloud.as_ref().map_or_else(Vec::new, |cloud| cloud.points.clone()),
            ellipse: own.cloud.as_ref().map(|cloud| Ellipse { centre: cloud.centre, covariance: cloud.covariance }),
            bound,
        };
        let panels: Vec<KtPanel> = detail.methods.iter().enumerate().map(panel).collect();
        let known = panels.iter().any(|panel| panel.ellipse.is_some());
        known.then_some((detail.cell, KtScatter { title: None, panels }))
    };
    summary.details.iter().filter_map(of_cell).collect()
}

/// K and T that the reference method finds at the named points of the last axis, over those of the first point, one
/// series for every point of the other axes; nothing unless some ships are not first order and have no K and T of their
/// own for all trials.
pub fn indices(design: &Design, summary: &Summary) -> Option<(DotPlot, String)> {
    let last = design.axes.len().checked_sub(1)?;
    let is_named = design.cells.iter().all(|cell| cell.values[last].is_none());
    if !is_named || design.cells.iter().all(|cell| !cell.is_nearest) || !summary.tracing.is_empty() {
        return None;
    }
    let mut names: Vec<&str> = Vec::new();
    let mut series: Vec<(String, Vec<usize>)> = Vec::new();
    for (index, cell) in design.cells.iter().enumerate() {
        let (own, rest) = (cell.labels[last].as_str(), cell.labels[..last].join(", "));
        if !names.contains(&own) {
            names.push(own);
        }
        match series.iter_mut().find(|(name, _)| *name == rest) {
            Some((_, cells)) => cells.push(index),
            None => series.push((rest, vec![index])),
        }
    }
    if names.len() < 2 || series.iter().any(|(_, cells)| cells.len() != names.len()) {
        return None;
    }
    let answer = |cell: usize, panel: usize| {
        let record = summary.record(cell, summary.reference)?;
        [&record.k, &record.t][panel].answer
    };
    let column = |panel: usize, symbol: &str| DotColumn {
        x_title: format!("{symbol} over that of a {}", names[0]),
        scale: Scale::Linear,
        reference: None,
        limit: None,
        rows: (0..names.len())
            .map(|row| {
                let dot = |(number, (label, cells)): (usize, &(String, Vec<usize>))| {
                    let first = answer(cells[0], panel)?;
                    let own = answer(cells[row], panel)?.times(1.0 / first.value);
                    let origin = Origin::Series { label: label.clone(), number };
                    Some(Dot { origin, x: own.value, interval: own.ci95, hollow: false })
                };
                series.iter().enumerate().filter_map(dot).collect()
            })
            .collect(),
    };
    let plot = DotPlot {
        title: None,
        names: names.iter().map(|name| (*name).to_owned()).collect(),
        columns: vec![column(0, "K"), column(1, "T")],
        rows_are_methods: false,
        quiet: Vec::new(),
        note: Some(format!("Rows: {}. Bars: 95 % intervals of the mean.", design.axes[last])),
    };
    Some((plot, design.methods[summary.reference].label.clone()))
}

/// How often 90 % intervals of predictions hold, cell by cell and method by method: the mean over the figures of the
/// shares of trials, and as a bar the lowest and the highest of them; nothing without predictions.
pub fn predictions(design: &Design, summary: &Summary) -> Option<DotPlot> {
    let of = |line: &PredictionSummary| 100.0 * line.inside as f64 / line.trials as f64;
    let dot = |cell: usize, method: usize| {
        let lines = || summary.predictions.iter().filter(move |line| (line.cell, line.method) == (cell, method));
        let shares: Vec<f64> = lines().map(of).collect();
        let ends = [shares.iter().copied().reduce(f64::min)?, shares.iter().copied().reduce(f64::max)?];
        let x = shares.iter().sum::<f64>() / shares.len() as f64;
        Some(Dot { origin: origin(design, method), x, interval: Some(ends), hollow: false })
    };
    let row = |cell: usize| (0..design.methods.len()).filter_map(|method| dot(cell, method)).collect();
    (!summary.predictions.is_empty()).then(|| DotPlot {
        title: None,
        names: design.cells.iter().map(|cell| cell.labels.join(", ")).collect(),
        columns: vec![DotColumn {
            x_title: "trials in which a 90 % interval holds [%]".to_owned(),
            scale: Scale::Linear,
            reference: Some(Reference95 { value: 90.0, band: [90.0; 2] }),
            limit: None,
            rows: (0..design.cells.len()).map(row).collect(),
        }],
        rows_are_methods: false,
        quiet: Vec::new(),
        note: Some("Markers: mean over the figures. Bars: from the lowest to the highest of them.".to_owned()),
    })
}
