//! From a summary to the data of figures: what goes along which axis, what into panels, and what is left out.

use report::figures::{
    self, Dot, DotColumn, DotPlot, Ecdf, EcdfCurve, EcdfPanel, Ellipse, ErrorCell, ErrorCurve, ErrorCurves, ErrorPoint,
    HeatMap, HeatPanel, KtPanel, KtScatter, Reference95, Scale, Violin, ViolinPanel, Violins,
};
use report::{Figure, Origin, Theme, number};

use campaign::curves;
use campaign::design::Design;
use campaign::statistics::{Statistic, Z95};
use campaign::summary::{self, Record, Summary};

/// What a chart over the axes of a design shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Root mean square errors of K and T.
    Rms,
    /// Coverage of their intervals.
    Coverage,
    /// Trials without an answer.
    Failures,
    /// Error of the heading on the validation manoeuvre.
    Validation,
}

impl Quantity {
    /// In the order of the report.
    pub const ALL: [Self; 4] = [Self::Rms, Self::Validation, Self::Coverage, Self::Failures];

    /// Stem of the figure.
    pub fn stem(self) -> &'static str {
        match self {
            Self::Rms => "errors",
            Self::Coverage => "coverage",
            Self::Failures => "failures",
            Self::Validation => "validation",
        }
    }

    /// Titles of its panels.
    fn titles(self) -> &'static [&'static str] {
        match self {
            Self::Rms => &["rms error of K [%]", "rms error of T [%]"],
            Self::Coverage => &["coverage of K [%]", "coverage of T [%]"],
            Self::Failures => &["trials without answer [%]"],
            Self::Validation => &["validation error of the heading [°]"],
        }
    }

    fn scale(self) -> Scale {
        match self {
            Self::Rms | Self::Validation => Scale::Log,
            Self::Coverage | Self::Failures => Scale::Linear,
        }
    }

    /// The figure of one panel.
    fn of(self, record: &Record, panel: usize) -> Option<Statistic> {
        let errors = if panel == 0 { &record.k } else { &record.t };
        match self {
            Self::Rms => errors.rms,
            Self::Coverage => errors.coverage.map(|share| share.times(100.0)),
            Self::Failures => record.failure_rate.map(|share| share.times(100.0)),
            Self::Validation => record.validation_rmse_deg,
        }
    }

    /// The bound of one panel in a cell, per cent.
    fn bound(self, design: &Design, cell: usize, panel: usize) -> Option<f64> {
        let covariance = design.cells[cell].bound_percent2.filter(|_| self == Self::Rms)?;
        Some(covariance[panel][panel].sqrt())
    }

    /// What its values are held against; `trials` stand behind each of them.
    fn reference(self, trials: u64) -> Option<Reference95> {
        (self == Self::Coverage && trials > 0).then(|| {
            let reach = Z95 * (95.0 * 5.0 / trials as f64).sqrt();
            Reference95 { value: 95.0, band: [95.0 - reach, (95.0 + reach).min(100.0)] }
        })
    }
}

/// A chart, and which points of the other axes it belongs to where there are several.
pub struct Chart {
    /// Points of the other axes.
    pub group: Option<String>,
    data: Data,
}

enum Data {
    Curves(ErrorCurves),
    Dots(DotPlot),
}

impl Chart {
    /// Draws it.
    pub fn draw(&self, theme: &Theme) -> Figure {
        match &self.data {
            Data::Curves(data) => figures::error_curves(data, theme),
            Data::Dots(data) => figures::dots(data, theme),
        }
    }
}

/// More groups than this do not go side by side.
const MOST_COLUMNS: usize = 4;

/// A ratio of the ends of an axis above which it is divided by factors.
const WIDE: f64 = 12.0;

/// Charts of a quantity over the last axis that is a number, else over the names of the last axis; points of the other
/// axes side by side where they are few, else one chart each. Nothing where there is no axis or nothing to show.
pub fn over_axes(design: &Design, summary: &Summary, quantity: Quantity) -> Vec<Chart> {
    let is_number = |axis: &usize| design.cells.iter().all(|cell| cell.values[*axis].is_some());
    let has_several =
        |axis: &usize| design.cells.iter().any(|cell| cell.labels[*axis] != design.cells[0].labels[*axis]);
    let number = (0..design.axes.len()).rev().filter(has_several).find(is_number);
    let Some(x) = number.or_else(|| (0..design.axes.len()).rev().find(has_several)) else { return Vec::new() };
    // A chart without a value, or without a single failure, says nothing.
    let says_something = |record: &Record| {
        let mut figures = (0..quantity.titles().len()).filter_map(|panel| quantity.of(record, panel));
        figures.any(|figure| quantity != Quantity::Failures || figure.value > 0.0)
    };
    if !summary.methods.iter().any(|line| says_something(&line.record)) {
        return Vec::new();
    }
    let groups = groups(design, x);
    let is_crowded = groups.len() > MOST_COLUMNS;
    // A design over two numbers is shown as maps; of many groups only the errors are shown one by one.
    let is_map = design.axes.len() == 2 && (0..2).all(|axis| is_number(&axis));
    if is_crowded && (is_map || !matches!(quantity, Quantity::Rms | Quantity::Validation)) {
        return Vec::new();
    }
    let is_worth_it = |group: &&Group| {
        let records = |&cell: &usize| (0..design.methods.len()).filter_map(move |method| summary.record(cell, method));
        group.cells.iter().flat_map(records).any(says_something)
    };
    match number {
        Some(_) if !is_crowded => {
            vec![Chart { group: None, data: Data::Curves(curves(design, summary, quantity, x, &groups)) }]
        }
        Some(_) => groups
            .iter()
            .map(|group| Chart {
                group: Some(group.name.clone()),
                data: Data::Curves(curves(design, summary, quantity, x, std::slice::from_ref(group))),
            })
            .collect(),
        None => groups
            .iter()
            .filter(is_worth_it)
            .map(|group| Chart {
                group: (groups.len() > 1).then(|| group.name.clone()),
                data: Data::Dots(named(design, summary, quantity, x, group)),
            })
            .collect(),
    }
}

/// Cells that differ in one axis only.
struct Group {
    name: String,
    cells: Vec<usize>,
}

fn groups(design: &Design, x: usize) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (index, cell) in design.cells.iter().enumerate() {
        let others = cell.labels.iter().enumerate().filter(|(axis, _)| *axis != x).map(|(_, label)| label.as_str());
        let name = others.collect::<Vec<_>>().join(", ");
        match groups.iter_mut().find(|group| group.name == name) {
            Some(group) => group.cells.push(index),
            None => groups.push(Group { name, cells: vec![index] }),
        }
    }
    groups
}

fn origin(design: &Design, method: usize) -> Origin {
    curves::origin(&design.methods, &design.methods[method].label)
}

fn curves(design: &Design, summary: &Summary, quantity: Quantity, x: usize, groups: &[Group]) -> ErrorCurves {
    let titles = quantity.titles();
    let mut cells = Vec::new();
    for (column, group) in groups.iter().enumerate() {
        for row in 0..titles.len() {
            let at = |cell: usize| design.cells[cell].values[x];
            let mut curves: Vec<ErrorCurve> = (0..design.methods.len())
                .filter(|&method| quantity != Quantity::Failures || fails(summary, method))
                .map(|method| ErrorCurve {
                    origin: origin(design, method),
                    points: group
                        .cells
                        .iter()
                        .filter_map(|&cell| {
                            let figure = quantity.of(summary.record(cell, method)?, row)?;
                            Some(ErrorPoint { x: at(cell)?, y: figure.value, interval: figure.ci95 })
                        })
                        .collect(),
                })
                .collect();
            let bound = |&cell: &usize| {
                Some(ErrorPoint { x: at(cell)?, y: quantity.bound(design, cell, row)?, interval: None })
            };
            let bounds: Vec<ErrorPoint> = group.cells.iter().filter_map(bound).collect();
            if !bounds.is_empty() {
                curves.push(ErrorCurve { origin: Origin::Bound, points: bounds });
            }
            cells.push(ErrorCell { row, column, curves });
        }
    }
    let values: Vec<f64> = design.cells.iter().filter_map(|cell| cell.values[x]).collect();
    let (least, most) =
        values.iter().filter(|v| **v > 0.0).fold((f64::INFINITY, 0.0), |(a, b), &v| (v.min(a), v.max(b)));
    let is_wide = values.iter().all(|value| *value >= 0.0) && most > WIDE * least;
    ErrorCurves {
        title: None,
        x_title: design.axes[x].clone(),
        x_scale: if is_wide { Scale::Log } else { Scale::Linear },
        y_scale: quantity.scale(),
        rows: titles.iter().map(|title| (*title).to_owned()).collect(),
        columns: if groups.len() > 1 { groups.iter().map(|group| group.name.clone()).collect() } else { Vec::new() },
        cells,
        reference: quantity.reference(trials(summary, groups)),
    }
}

/// Whether a method has no answer to some trial of the study.
fn fails(summary: &Summary, method: usize) -> bool {
    summary.overall[method].record.failed() > 0
}

/// Usual number of trials behind a figure.
fn trials(summary: &Summary, groups: &[Group]) -> u64 {
    let cells = || groups.iter().flat_map(|group| &group.cells);
    cells().filter_map(|&cell| summary.record(cell, 0)).map(|record| record.trials).min().unwrap_or(0)
}

fn named(design: &Design, summary: &Summary, quantity: Quantity, x: usize, group: &Group) -> DotPlot {
    let column = |(panel, title): (usize, &&str)| {
        let rows = group.cells.iter().map(|&cell| {
            let dot = |method: usize| {
                if quantity == Quantity::Failures && !fails(summary, method) {
                    return None;
                }
                let figure = quantity.of(summary.record(cell, method)?, panel)?;
                Some(Dot { origin: origin(design, method), x: figure.value, interval: figure.ci95, hollow: false })
            };
            let bound = quantity.bound(design, cell, panel);
            let bound = bound.map(|x| Dot { origin: Origin::Bound, x, interval: None, hollow: false });
            (0..design.methods.len()).filter_map(dot).chain(bound).collect()
        });
        DotColumn {
            x_title: (*title).to_owned(),
            scale: quantity.scale(),
            reference: quantity.reference(trials(summary, std::slice::from_ref(group))),
            rows: rows.collect(),
        }
    };
    DotPlot {
        title: None,
        names: group.cells.iter().map(|&cell| design.cells[cell].labels[x].clone()).collect(),
        columns: quantity.titles().iter().enumerate().map(column).collect(),
        rows_are_methods: false,
        note: Some(format!("Rows: {}.", design.axes[x])),
    }
}

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

/// Methods by the median size of their error of T, and the name of the first; nothing without errors.
pub fn ranking(design: &Design, summary: &Summary) -> Option<(DotPlot, String)> {
    let record = |method: usize| &summary.overall[method].record;
    let size = |method: usize| record(method).t.median_size.map_or(f64::INFINITY, |figure| figure.value);
    let mut order: Vec<usize> = (0..design.methods.len()).collect();
    order.sort_by(|&one, &other| size(one).total_cmp(&size(other)));
    let first = *order.first().filter(|&&method| order.len() > 1 && size(method).is_finite())?;
    let column = |x_title: &str, errors: fn(&Record) -> &summary::Errors| DotColumn {
        x_title: x_title.to_owned(),
        scale: Scale::Log,
        reference: None,
        rows: order
            .iter()
            .map(|&method| {
                let errors = errors(record(method));
                let dot = |figure: Statistic, hollow: bool| Dot {
                    origin: origin(design, method),
                    x: figure.value,
                    interval: figure.ci95,
                    hollow,
                };
                let (median, high) = (errors.median_size, errors.high_size);
                median
                    .map(|figure| dot(figure, false))
                    .into_iter()
                    .chain(high.map(|figure| dot(figure, true)))
                    .collect()
            })
            .collect(),
    };
    let name = |&method: &usize| {
        let failed = record(method).failure_rate.map_or(0.0, |rate| rate.value);
        let label = &design.methods[method].label;
        match failed > 0.0 {
            // A rare failure is not "0.0 %".
            true => format!("{label} ({} % fail)", number::significant(100.0 * failed, 2)),
            false => label.clone(),
        }
    };
    let plot = DotPlot {
        title: None,
        names: order.iter().map(name).collect(),
        columns: vec![
            column("size of the error of K [%]", |record| &record.k),
            column("size of the error of T [%]", |record| &record.t),
        ],
        rows_are_methods: true,
        note: Some("Filled: median. Hollow: 90 % of the answers are within. Bars: 95 % intervals.".to_owned()),
    };
    Some((plot, design.methods[first].label.clone()))
}

/// Distributions of the sizes of all errors; nothing for fewer than ten trials.
pub fn ecdf(design: &Design, summary: &Summary) -> Option<Ecdf> {
    let panel = |x_title: &str, points: fn(&summary::MethodDetail) -> &Vec<(f64, f64)>| EcdfPanel {
        x_title: x_title.to_owned(),
        curves: (0..design.methods.len())
            .map(|method| EcdfCurve {
                origin: origin(design, method),
                points: points(&summary.overall[method].detail).clone(),
            })
            .filter(|curve| !curve.points.is_empty())
            .collect(),
    };
    let data = Ecdf {
        title: None,
        panels: vec![
            panel("size of the error of K [%]", |detail| &detail.ecdf_k),
            panel("size of the error of T [%]", |detail| &detail.ecdf_t),
        ],
    };
    let enough = summary.overall.iter().any(|overall| overall.record.trials >= 10);
    (enough && data.panels.iter().any(|panel| !panel.curves.is_empty())).then_some(data)
}

/// Distributions of the errors in the cells whose detail was asked for; nothing for fewer than ten trials.
pub fn violins(design: &Design, summary: &Summary) -> Vec<(usize, Violins)> {
    let panel = |detail: &summary::CellDetail,
                 x_title: &str,
                 violin: fn(&summary::MethodDetail) -> &Option<summary::Violin>| {
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
