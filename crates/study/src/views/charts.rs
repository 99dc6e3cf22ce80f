//! From a summary to the data of figures over the axes of a study: what goes along which axis, what into panels, what
//! is left out, and which of them stands for the study.

use report::figures::{
    self, AxisMark, Dot, DotColumn, DotPlot, ErrorCell, ErrorCurve, ErrorCurves, ErrorPoint, Reference95, Scale,
};
use report::{Figure, Origin, Theme};
use scenario::TRACE;

use campaign::curves;
use campaign::design::Design;
use campaign::statistics::{Statistic, Z95};
use campaign::summary::{Performance, Summary};

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

    fn panels(self) -> usize {
        if matches!(self, Self::Rms | Self::Coverage) { 2 } else { 1 }
    }

    fn scale(self) -> Scale {
        match self {
            Self::Rms | Self::Validation => Scale::Log,
            Self::Coverage | Self::Failures => Scale::Linear,
        }
    }

    /// The figure of one panel.
    pub fn of(self, record: &Performance, panel: usize) -> Option<Statistic> {
        let errors = if panel == 0 { &record.k } else { &record.t };
        match self {
            Self::Rms => errors.rms,
            // What a few answers quote says nothing of a method.
            Self::Coverage => {
                let often = errors.quoting.is_some_and(|share| share.value >= OFTEN);
                errors.coverage.filter(|_| often).map(|share| share.times(100.0))
            }
            Self::Failures => record.failure_rate.map(|share| share.times(100.0)),
            Self::Validation => record.validation_rmse_deg,
        }
    }

    /// What its values are held against; `trials` stand behind each of them.
    fn reference(self, trials: u64) -> Option<Reference95> {
        (self == Self::Coverage && trials > 0).then(|| {
            let reach = Z95 * (95.0 * 5.0 / trials as f64).sqrt();
            Reference95 { value: 95.0, band: [95.0 - reach, (95.0 + reach).min(100.0)] }
        })
    }
}

/// Smallest share of answers with an interval whose coverage is drawn.
const OFTEN: f64 = 0.5;

/// Error beyond which an answer is worth nothing, per cent: larger ones do not set an axis.
const WORTHLESS: f64 = 100.0;

/// Error below which an answer is exact, per cent.
const EXACT: f64 = 1e-4;

/// A quantity in the cells of one figure, as it can be compared there.
struct Measure<'a> {
    design: &'a Design,
    summary: &'a Summary,
    quantity: Quantity,
    /// Whether errors are in units of the Cramér–Rao bound.
    over_bound: bool,
    /// Whether errors are differences from a first-order response that is nearest to the ship.
    to_nearest: bool,
    /// Methods that can be compared.
    methods: Vec<usize>,
}

impl<'a> Measure<'a> {
    /// `None` where nothing can be compared: intervals of a response that is only the nearest one hold no truth.
    fn new(design: &'a Design, summary: &'a Summary, quantity: Quantity, groups: &[Group]) -> Option<Self> {
        let cells = || groups.iter().flat_map(|group| &group.cells).map(|&cell| &design.cells[cell]);
        let is_trace = |method: &usize| design.methods[*method].id == TRACE;
        let of_indices = matches!(quantity, Quantity::Rms | Quantity::Coverage);
        let mut methods: Vec<usize> = (0..design.methods.len()).collect();
        let mut to_nearest = of_indices && cells().any(|cell| cell.is_nearest);
        if to_nearest && !methods.iter().all(is_trace) {
            // A trace is held against the ship's own K and T.
            methods.retain(|method| !is_trace(method));
        } else {
            to_nearest = false;
        }
        if to_nearest && quantity == Quantity::Coverage {
            return None;
        }
        let is_bounded = quantity == Quantity::Rms && cells().all(|cell| cell.bound_percent2.is_some());
        let over_bound = is_bounded && !cells().any(|cell| cell.is_nearest);
        if quantity == Quantity::Failures {
            methods.retain(|&method| summary.overall[method].failed() > 0);
        }
        Some(Self { design, summary, quantity, over_bound, to_nearest, methods })
    }

    /// Titles of the panels.
    fn titles(&self) -> Vec<String> {
        let of_both = |words: &str| ["K", "T"].map(|symbol| words.replace('#', symbol)).to_vec();
        match self.quantity {
            Quantity::Rms if self.over_bound => of_both("rms error of # over the Cramér–Rao bound"),
            Quantity::Rms if self.to_nearest => of_both("# less that of the nearest first-order response, rms [%]"),
            Quantity::Rms => of_both("rms error of # [%]"),
            Quantity::Coverage => of_both("95 % intervals that hold # [%]"),
            Quantity::Failures => vec!["trials without answer [%]".to_owned()],
            Quantity::Validation => vec!["median error of a heading not seen [°]".to_owned()],
        }
    }

    fn bound(&self, cell: usize, panel: usize) -> Option<f64> {
        let covariance = self.design.cells[cell].bound_percent2.filter(|_| self.quantity == Quantity::Rms)?;
        Some(covariance[panel][panel].sqrt())
    }

    /// The figure, and whether it is too large to set an axis.
    fn of(&self, cell: usize, method: usize, panel: usize) -> Option<(Statistic, bool)> {
        let figure = self.quantity.of(self.summary.record(cell, method)?, panel)?;
        let is_worthless = self.quantity == Quantity::Rms && figure.value > WORTHLESS;
        let unit = if self.over_bound { self.bound(cell, panel)? } else { 1.0 };
        let figure = figure.times(1.0 / unit);
        match self.is_exact(&figure) {
            // What is left is the rounding of the arithmetic.
            true => Some((Statistic { value: EXACT, ci95: None }, false)),
            false => Some((figure, is_worthless)),
        }
    }

    fn is_exact(&self, figure: &Statistic) -> bool {
        self.quantity == Quantity::Rms && !self.over_bound && figure.value > 0.0 && figure.value < EXACT
    }

    /// The bound in the unit of the panel; `None` where it is not shown.
    fn shown_bound(&self, cell: usize, panel: usize) -> Option<f64> {
        if self.over_bound { Some(1.0) } else { self.bound(cell, panel).filter(|_| !self.to_nearest) }
    }

    /// What is said under a figure some of whose values are drawn elsewhere.
    fn note(&self, groups: &[Group]) -> Option<String> {
        let mut figures = Vec::new();
        for &cell in groups.iter().flat_map(|group| &group.cells) {
            for &method in &self.methods {
                figures.extend((0..self.quantity.panels()).filter_map(|panel| self.of(cell, method, panel)));
            }
        }
        let is_cut = figures.iter().any(|(_, is_worthless)| *is_worthless);
        let is_exact = self.quantity == Quantity::Rms && figures.iter().any(|(figure, _)| figure.value == EXACT);
        let remarks =
            [(is_cut, "Arrows: rms error above 100 %."), (is_exact, "Errors below 0.0001 % are drawn there.")];
        let said: Vec<&str> = remarks.into_iter().filter(|(holds, _)| *holds).map(|(_, remark)| remark).collect();
        (!said.is_empty()).then(|| said.join(" "))
    }
}

/// A chart, and which points of the other axes it belongs to where there are several.
#[derive(Clone)]
pub struct Chart {
    /// Points of the other axes.
    pub group: Option<String>,
    data: Data,
}

#[derive(Clone)]
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

    /// The same as the figure that stands for a study: its finding above it, the last of its rows of panels (T before
    /// K), the methods it is about in colour and the others grey, methods with one line as one.
    pub fn hero(&self, title: Option<&str>, about: &[Origin]) -> Self {
        let mut hero = self.clone();
        let is_quiet = |origin: &Origin| *origin != Origin::Bound && !about.is_empty() && !about.contains(origin);
        match &mut hero.data {
            Data::Curves(data) => {
                data.title = title.map(str::to_owned);
                let last = data.rows.len().saturating_sub(1);
                data.rows.drain(..last);
                data.cells.retain(|cell| cell.row == last);
                data.cells.iter_mut().for_each(|cell| cell.row = 0);
                data.names_at_lines = true;
                merge(&mut data.cells, about);
                data.cells
                    .iter_mut()
                    .flat_map(|cell| &mut cell.curves)
                    .for_each(|curve| curve.is_quiet = is_quiet(&curve.origin));
            }
            Data::Dots(data) => {
                data.title = title.map(str::to_owned);
                data.columns.drain(..data.columns.len().saturating_sub(1));
                let dots = data.columns.iter().flat_map(|column| &column.rows).flatten();
                let mut quiet: Vec<Origin> = Vec::new();
                for dot in dots.filter(|dot| is_quiet(&dot.origin)) {
                    if !quiet.contains(&dot.origin) {
                        quiet.push(dot.origin.clone());
                    }
                }
                data.quiet = quiet;
            }
        }
        hero
    }
}

/// Lines nearer to each other than this share of their values are one.
const SAME_LINE: f64 = 0.03;

/// Joins methods whose lines lie on each other in all panels, under the names of all; one that the figure is about
/// gives the line its look.
fn merge(cells: &mut [ErrorCell], about: &[Origin]) {
    let mut origins: Vec<Origin> = Vec::new();
    for curve in cells.iter().flat_map(|cell| &cell.curves).filter(|curve| curve.origin != Origin::Bound) {
        if !origins.contains(&curve.origin) {
            origins.push(curve.origin.clone());
        }
    }
    origins.sort_by_key(|origin| about.iter().position(|one| one == origin).unwrap_or(about.len()));
    let points = |cell: &ErrorCell, origin: &Origin| -> Vec<ErrorPoint> {
        let own = cell.curves.iter().find(|curve| curve.origin == *origin);
        own.map_or_else(Vec::new, |curve| curve.points.clone())
    };
    let near = |one: &ErrorPoint, other: &ErrorPoint| {
        one.x == other.x && one.beyond == other.beyond && (one.y - other.y).abs() <= SAME_LINE * one.y.abs()
    };
    let same = |one: &Origin, other: &Origin| {
        cells.iter().all(|cell| {
            let (one, other) = (points(cell, one), points(cell, other));
            one.len() == other.len() && one.iter().zip(&other).all(|(one, other)| near(one, other))
        })
    };
    let mut lines: Vec<Vec<Origin>> = Vec::new();
    for origin in origins {
        match lines.iter_mut().find(|line| same(&line[0], &origin)) {
            Some(line) => line.push(origin),
            None => lines.push(vec![origin]),
        }
    }
    for cell in cells {
        cell.curves.retain(|curve| curve.origin == Origin::Bound || lines.iter().any(|line| line[0] == curve.origin));
        for curve in &mut cell.curves {
            let line = lines.iter().find(|line| line[0] == curve.origin && line.len() > 1);
            curve.label = line.map(|line| line.iter().map(Origin::label).collect::<Vec<_>>().join("\n"));
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
    let says_something = |record: &Performance| {
        let mut figures = (0..quantity.panels()).filter_map(|panel| quantity.of(record, panel));
        figures.any(|figure| quantity != Quantity::Failures || figure.value > 0.0)
    };
    let groups = groups(design, x);
    let is_crowded = groups.len() > MOST_COLUMNS;
    // A design over two numbers is shown as maps; of many groups only the errors are shown one by one.
    let is_map = design.axes.len() == 2 && (0..2).all(|axis| is_number(&axis));
    if is_crowded && (is_map || !matches!(quantity, Quantity::Rms | Quantity::Validation)) {
        return Vec::new();
    }
    let is_worth_it = |group: &Group| {
        let records = |&cell: &usize| (0..design.methods.len()).filter_map(move |method| summary.record(cell, method));
        group.cells.iter().flat_map(records).any(says_something)
    };
    let parts: Vec<&[Group]> = match number {
        Some(_) if !is_crowded => vec![&groups],
        _ => groups.iter().map(std::slice::from_ref).collect(),
    };
    let parts = parts.into_iter().filter(|part| part.iter().any(is_worth_it));
    let chart = |part: &[Group]| {
        let measure = Measure::new(design, summary, quantity, part)?;
        let data = match (number, part) {
            (None, [group]) => Data::Dots(named(&measure, x, group)),
            _ => Data::Curves(curves(&measure, x, part)),
        };
        Some(Chart { group: (part.len() < groups.len()).then(|| part[0].name.clone()), data })
    };
    parts.filter_map(chart).collect()
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

/// How a method is drawn.
pub fn origin(design: &Design, method: usize) -> Origin {
    curves::origin(&design.methods, &design.methods[method].label)
}

fn curves(measure: &Measure, x: usize, groups: &[Group]) -> ErrorCurves {
    let Measure { design, summary, quantity, .. } = *measure;
    let titles = measure.titles();
    let mut cells = Vec::new();
    for (column, group) in groups.iter().enumerate() {
        for row in 0..titles.len() {
            let at = |cell: usize| design.cells[cell].values[x];
            let of_method = |&method: &usize| {
                let point = |&cell: &usize| {
                    let (figure, beyond) = measure.of(cell, method, row)?;
                    Some(ErrorPoint { beyond, ..ErrorPoint::new(at(cell)?, figure.value, figure.ci95) })
                };
                ErrorCurve::new(origin(design, method), group.cells.iter().filter_map(point).collect())
            };
            let mut curves: Vec<ErrorCurve> = measure.methods.iter().map(of_method).collect();
            let bound = |&cell: &usize| Some(ErrorPoint::new(at(cell)?, measure.shown_bound(cell, row)?, None));
            let bounds: Vec<ErrorPoint> = group.cells.iter().filter_map(bound).collect();
            if !bounds.is_empty() {
                curves.push(ErrorCurve::new(Origin::Bound, bounds));
            }
            cells.push(ErrorCell { row, column, curves });
        }
    }
    let values: Vec<f64> = design.cells.iter().filter_map(|cell| cell.values[x]).collect();
    let (least, most) =
        values.iter().filter(|v| **v > 0.0).fold((f64::INFINITY, 0.0), |(a, b), &v| (v.min(a), v.max(b)));
    let is_wide = values.iter().all(|value| *value >= 0.0) && most > WIDE * least;
    let mark = |mark: &scenario::MarkedValue| AxisMark { at: mark.at, label: mark.label.clone() };
    let marks = design.words.output.marks.iter().filter(|mark| mark.axis == design.axes[x]);
    ErrorCurves {
        x_title: design.axes[x].clone(),
        x_scale: if is_wide { Scale::Log } else { Scale::Linear },
        y_scale: quantity.scale(),
        rows: titles,
        columns: if groups.len() > 1 { groups.iter().map(|group| group.name.clone()).collect() } else { Vec::new() },
        cells,
        reference: quantity.reference(trials(summary, groups)),
        marks: marks.map(mark).collect(),
        note: measure.note(groups),
        ..ErrorCurves::default()
    }
}

/// Usual number of trials behind a figure.
fn trials(summary: &Summary, groups: &[Group]) -> u64 {
    let cells = || groups.iter().flat_map(|group| &group.cells);
    cells().filter_map(|&cell| summary.record(cell, 0)).map(|record| record.trials).min().unwrap_or(0)
}

fn named(measure: &Measure, x: usize, group: &Group) -> DotPlot {
    let Measure { design, summary, quantity, .. } = *measure;
    let part = std::slice::from_ref(group);
    let column = |(panel, x_title): (usize, String)| {
        let of = |&cell: &usize| {
            let dot = |&method: &usize| {
                let (figure, _) = measure.of(cell, method, panel)?;
                Some(Dot { origin: origin(design, method), x: figure.value, interval: figure.ci95, hollow: false })
            };
            let bound = measure.shown_bound(cell, panel);
            let bound = bound.map(|x| Dot { origin: Origin::Bound, x, interval: None, hollow: false });
            measure.methods.iter().filter_map(dot).chain(bound).collect::<Vec<Dot>>()
        };
        // The largest value that is worth something.
        let useful = group.cells.iter().flat_map(|&cell| measure.methods.iter().map(move |&method| (cell, method)));
        let useful = useful.filter_map(|(cell, method)| measure.of(cell, method, panel)).filter(|(_, cut)| !cut);
        DotColumn {
            x_title,
            scale: quantity.scale(),
            reference: quantity.reference(trials(summary, part)),
            limit: useful.map(|(figure, _)| figure.value).reduce(f64::max),
            rows: group.cells.iter().map(of).collect(),
        }
    };
    let rows = format!("Rows: {}.", design.axes[x]);
    DotPlot {
        title: None,
        names: group.cells.iter().map(|&cell| design.cells[cell].labels[x].clone()).collect(),
        columns: measure.titles().into_iter().enumerate().map(column).collect(),
        rows_are_methods: false,
        quiet: Vec::new(),
        note: Some(measure.note(part).map_or(rows.clone(), |note| format!("{rows} {note}"))),
    }
}
