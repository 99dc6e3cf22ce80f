//! Figures of a summary over the axes of a study: choice of axis and panels, and what is omitted.

use campaign::scenario::TRACE_ID;
use report::figures::{
    AxisLine, AxisSpec, Layer, LayeredPanel, NamedRows, PanelGroup, PanelRow, Panels, Pen, Plot, ReferenceBand95,
    RowItem, RowKind, RowsColumn, TickRule,
};
use report::{CurveOrigin, PlotCurve};

use campaign::curves;
use campaign::design::{CellFacts, Design};
use campaign::statistics::{Statistic, grouped};
use campaign::summary::{MethodPerformance, Summary};

/// Quantity of a chart over the axes of a design.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorMeasure {
    /// Root mean square errors of K and T.
    Rms,
    /// Root mean square errors of K and T relative to the Cramér–Rao bound.
    RatioToBound,
    /// Coverage and width of the intervals of K and T.
    Coverage,
    /// Trials without an estimate.
    Failures,
    /// Heading error on the validation manoeuvre.
    Validation,
}

impl ErrorMeasure {
    /// All measures in the order of the report.
    pub const ALL: [Self; 5] = [Self::Rms, Self::RatioToBound, Self::Validation, Self::Coverage, Self::Failures];

    /// File stem of the figure.
    pub fn stem(self) -> &'static str {
        match self {
            Self::Rms => "errors",
            Self::RatioToBound => "errors-over-bound",
            Self::Coverage => "coverage",
            Self::Failures => "failures",
            Self::Validation => "validation",
        }
    }

    fn panels(self) -> usize {
        match self {
            Self::Rms | Self::RatioToBound => 2,
            Self::Coverage => 4,
            Self::Failures | Self::Validation => 1,
        }
    }

    fn ruler(self, panel: usize, title: String) -> AxisSpec {
        let is_log =
            matches!(self, Self::Rms | Self::RatioToBound | Self::Validation) || self == Self::Coverage && panel > 1;
        AxisSpec::new(title, if is_log { TickRule::Logarithmic } else { TickRule::Decimal })
    }

    /// Statistic of a panel, in per cent, for the validation in degrees; `None` if the method has none. Panels are
    /// counted from 0; those with an even number are of K, those with an odd number of T.
    pub fn statistic(self, performance: &MethodPerformance, panel: usize) -> Option<Statistic> {
        let errors = if panel.is_multiple_of(2) { &performance.k } else { &performance.t };
        match self {
            Self::Rms | Self::RatioToBound => errors.rms,
            // A few estimates with an interval do not characterise a method.
            Self::Coverage => {
                let often = errors.share_with_interval.is_some_and(|share| share.value >= MIN_QUOTING_SHARE);
                let figure = if panel > 1 {
                    errors.median_interval_width
                } else {
                    errors.coverage.map(|share| share.times(100.0))
                };
                figure.filter(|_| often)
            }
            Self::Failures => performance.failure_rate.map(|share| share.times(100.0)),
            Self::Validation => performance.validation_rmse_deg,
        }
    }

    /// `true` if the measure is an error of K and T.
    fn is_of_errors(self) -> bool {
        matches!(self, Self::Rms | Self::RatioToBound)
    }

    /// Nominal coverage, 95 %, for the two panels of coverage; `None` for every other panel.
    fn reference(self, panel: usize) -> Option<ReferenceBand95> {
        (self == Self::Coverage && panel < 2).then(|| ReferenceBand95::line_at(95.0))
    }
}

/// Minimum share of estimates with an interval for their coverage to be plotted.
const MIN_QUOTING_SHARE: f64 = 0.5;

/// Maximum error that sets an axis, per cent: estimates with larger errors are useless.
const MAX_ERROR: f64 = 100.0;

/// Minimum error that is plotted, per cent: smaller errors count as exact.
pub const MIN_ERROR: f64 = 1e-4;

/// Note on the nominal coverage.
const LINE_NOTE: &str = "Line: 95 %.";
/// Note on errors beyond the axis.
const CUT_NOTE: &str = "Arrows: rms error of more than 100 % of the true value.";
/// Note on exact errors.
pub const EXACT_NOTE: &str = "Errors below 0.0001 % are drawn there.";

/// Indices of the methods that can be compared in some cells, and `true` if their errors are relative to the
/// first-order response nearest to the ship. A trace estimates K and T of the ship herself, so it is left out of such a
/// comparison. `None` for a measure of K and T if a cell is compared with the nearest response in a study of
/// predictions, or if the coverage of intervals would refer to that response.
pub fn comparable_methods<'a>(
    design: &Design,
    measure: ErrorMeasure,
    mut cells: impl Iterator<Item = &'a CellFacts>,
) -> Option<(Vec<usize>, bool)> {
    let is_trace = |method: &usize| design.methods[*method].id == TRACE_ID;
    let of_indices = measure.is_of_errors() || measure == ErrorMeasure::Coverage;
    let is_nearest = of_indices && cells.any(|cell| cell.is_compared_with_nearest);
    let mut methods: Vec<usize> = (0..design.methods.len()).collect();
    let to_nearest = is_nearest && !methods.iter().all(is_trace);
    if is_nearest && design.predicts || to_nearest && measure == ErrorMeasure::Coverage {
        return None;
    }
    methods.retain(|method| !to_nearest || !is_trace(method));
    Some((methods, to_nearest))
}

/// Title of the axis of root mean square errors of K or T, whichever is the `symbol`.
pub fn rms_title(symbol: &str, to_nearest: bool) -> String {
    match to_nearest {
        true => format!("rms difference of {symbol} from the nearest first-order response [%]"),
        false => format!("rms error of {symbol} [%]"),
    }
}

/// A measure in the cells of one figure, restricted to methods that can be compared there.
struct ComparedMethods<'a> {
    design: &'a Design,
    summary: &'a Summary,
    measure: ErrorMeasure,
    /// `true` if errors are relative to the first-order response nearest to the ship.
    to_nearest: bool,
    /// Methods that can be compared.
    methods: Vec<usize>,
}

impl<'a> ComparedMethods<'a> {
    /// The comparison; `None` as from [`comparable_methods`], or if a cell lacks the bound that the measure needs.
    fn new(design: &'a Design, summary: &'a Summary, measure: ErrorMeasure, groups: &[ChartGroup]) -> Option<Self> {
        let cells = || groups.iter().flat_map(|group| &group.cells).map(|&cell| &design.cells[cell]);
        let (mut methods, to_nearest) = comparable_methods(design, measure, cells())?;
        let is_bounded = cells().all(|cell| cell.cramer_rao_percent2.is_some() && !cell.is_compared_with_nearest);
        if measure == ErrorMeasure::RatioToBound && !is_bounded {
            return None;
        }
        if measure == ErrorMeasure::Failures {
            methods.retain(|&method| summary.overall[method].failed() > 0);
        }
        Some(Self { design, summary, measure, to_nearest, methods })
    }

    /// Titles of the panels.
    fn titles(&self) -> Vec<String> {
        let of_both = |pattern: &str| ["K", "T"].map(|symbol| pattern.replace('#', symbol));
        match self.measure {
            ErrorMeasure::RatioToBound => of_both("rms error of # / Cramér–Rao bound").to_vec(),
            ErrorMeasure::Rms => ["K", "T"].map(|symbol| rms_title(symbol, self.to_nearest)).to_vec(),
            ErrorMeasure::Coverage => {
                [of_both("95 % intervals that contain # [%]"), of_both("median width for # [%]")].concat()
            }
            ErrorMeasure::Failures => vec!["trials without answer [%]".to_owned()],
            ErrorMeasure::Validation => vec!["median error of an unseen heading [°]".to_owned()],
        }
    }

    /// Caption: the quantity and how to read it.
    fn reading(&self) -> &'static str {
        match self.measure {
            ErrorMeasure::RatioToBound => {
                "Root mean square error of K and T over the Cramér–Rao bound, with 95 % bootstrap intervals. A \
                 constant bias falls here as the noise grows."
            }
            ErrorMeasure::Rms if self.to_nearest => {
                "Root mean square difference of K and T from those of the nearest first-order response, with 95 % bootstrap \
                 intervals. It is not an error: the ship has no K and T of its own."
            }
            ErrorMeasure::Rms => "Root mean square error of K and T, with 95 % bootstrap intervals.",
            ErrorMeasure::Coverage => {
                "Share of the 95 % intervals that contain the truth, with Wilson's intervals, and their median width. Below the line at \
                 95 % a method is overconfident; above it its intervals are too wide. Methods that give an interval in fewer than \
                 half of the trials are left out."
            }
            ErrorMeasure::Failures => {
                "Share of trials without an answer, with Wilson's intervals; methods that always answer are left out. The \
                 reasons are listed below."
            }
            ErrorMeasure::Validation => {
                "Median heading error on the validation manoeuvre, whose rudder is replayed with the answer: the value of K and T for \
                 prediction. Where all methods agree, the model dominates the error."
            }
        }
    }

    /// Cramér–Rao bound of the standard deviation of K (panel 0) or T (panel 1), %; `None` if the cell has none, or if
    /// the measure is not an error of K and T.
    fn bound(&self, cell: usize, panel: usize) -> Option<f64> {
        let covariance = self.design.cells[cell].cramer_rao_percent2.filter(|_| self.measure.is_of_errors())?;
        Some(covariance[panel][panel].sqrt())
    }

    /// Statistic of a panel, and whether it is too large to set an axis.
    fn statistic(&self, cell: usize, method: usize, panel: usize) -> Option<(Statistic, bool)> {
        let figure = self.measure.statistic(self.summary.performance(cell, method)?, panel)?;
        let is_worthless = self.measure.is_of_errors() && figure.value > MAX_ERROR;
        let unit = if self.measure == ErrorMeasure::RatioToBound { self.bound(cell, panel)? } else { 1.0 };
        let figure = figure.times(1.0 / unit);
        match self.measure == ErrorMeasure::Rms && figure.value > 0.0 && figure.value < MIN_ERROR {
            // The remainder is rounding error.
            true => Some((Statistic { value: MIN_ERROR, ci95: None }, false)),
            false => Some((figure, is_worthless)),
        }
    }

    /// Plotted value and interval; infinite for a value that is too large.
    fn drawn(&self, cell: usize, method: usize, panel: usize) -> Option<(f64, Option<[f64; 2]>)> {
        let (figure, is_worthless) = self.statistic(cell, method, panel)?;
        Some(if is_worthless { (f64::INFINITY, None) } else { (figure.value, figure.ci95) })
    }

    /// Bound in the unit of the panel; `None` if it is not shown.
    fn shown_bound(&self, cell: usize, panel: usize) -> Option<f64> {
        if self.measure == ErrorMeasure::RatioToBound {
            Some(1.0)
        } else {
            self.bound(cell, panel).filter(|_| !self.to_nearest)
        }
    }

    /// Note under a figure: meaning of the line and of clipped values.
    fn note(&self, groups: &[ChartGroup]) -> Option<String> {
        let cells = || groups.iter().flat_map(|group| &group.cells);
        let places = cells().flat_map(|&cell| self.methods.iter().map(move |&method| (cell, method)));
        let panels = 0..self.measure.panels();
        let figures_at = |(cell, method)| panels.clone().filter_map(move |panel| self.statistic(cell, method, panel));
        let is_exact = self.measure == ErrorMeasure::Rms
            && places.flat_map(figures_at).any(|(figure, _)| figure.value == MIN_ERROR);
        let is_share = self.measure == ErrorMeasure::Coverage;
        let remark = if is_share { Some(LINE_NOTE) } else { is_exact.then_some(EXACT_NOTE) };
        remark.map(str::to_owned)
    }

    /// Note on the arrows at the axes, for a measure that is an error; `None` for any other.
    fn beyond(&self) -> Option<String> {
        self.measure.is_of_errors().then(|| CUT_NOTE.to_owned())
    }
}

/// Maximum number of groups side by side.
const MAX_GROUPS: usize = 4;

/// Minimum ratio of the ends of an axis for a logarithmic scale.
const MIN_LOG_AXIS_RATIO: f64 = 12.0;

/// Charts of a measure, each with the name of its points and a caption; empty if there is no axis or no value to show.
/// The horizontal axis is the last numeric axis with few points of the other axes, else the last numeric axis, else the
/// names of the last axis. The points of the other axes are side by side if they are few, else in one chart each.
pub fn error_charts_over_axes(
    design: &Design,
    summary: &Summary,
    measure: ErrorMeasure,
) -> Vec<(Option<String>, &'static str, Plot)> {
    let is_number = |axis: &usize| design.cells.iter().all(|cell| cell.values[*axis].is_some());
    let has_several =
        |axis: &usize| design.cells.iter().any(|cell| cell.labels[*axis] != design.cells[0].labels[*axis]);
    let numbers: Vec<usize> = (0..design.axes.len()).rev().filter(has_several).filter(is_number).collect();
    let leaves_few = |axis: &&usize| groups(design, **axis).len() <= MAX_GROUPS;
    let number = numbers.iter().find(leaves_few).or(numbers.first()).copied();
    let Some(x) = number.or_else(|| (0..design.axes.len()).rev().find(has_several)) else { return Vec::new() };
    // A chart without a value, or without a single failure, has no information.
    let says_something = |performance: &MethodPerformance| {
        let mut figures = (0..measure.panels()).filter_map(|panel| measure.statistic(performance, panel));
        figures.any(|figure| measure != ErrorMeasure::Failures || figure.value > 0.0)
    };
    let groups = groups(design, x);
    let is_crowded = groups.len() > MAX_GROUPS;
    // A design over two numbers is shown as maps; of many groups only the errors are shown one by one.
    let is_map = design.axes.len() == 2 && (0..2).all(|axis| is_number(&axis));
    if is_crowded && (is_map || !matches!(measure, ErrorMeasure::Rms | ErrorMeasure::Validation)) {
        return Vec::new();
    }
    let is_worth_it = |group: &ChartGroup| {
        let records = |&cell: &usize| (0..design.methods.len()).filter_map(move |k| summary.performance(cell, k));
        group.cells.iter().flat_map(records).any(says_something)
    };
    let parts: Vec<&[ChartGroup]> = match number {
        Some(_) if !is_crowded => vec![&groups],
        _ => groups.iter().map(std::slice::from_ref).collect(),
    };
    let parts = parts.into_iter().filter(|part| part.iter().any(is_worth_it));
    let chart = |part: &[ChartGroup]| {
        let compared = ComparedMethods::new(design, summary, measure, part)?;
        let plot = match (number, part) {
            (None, [group]) => Plot::Rows(named(&compared, x, group)),
            _ => Plot::Panels(curves(&compared, x, part)),
        };
        Some(((part.len() < groups.len()).then(|| part[0].name.clone()), compared.reading(), plot))
    };
    parts.filter_map(chart).collect()
}

/// Cells that differ in one axis only.
struct ChartGroup {
    /// Labels of the other axes.
    name: String,
    /// The same for a heading: a number is preceded by the name of its axis.
    head: String,
    /// Indices of the cells.
    cells: Vec<usize>,
}

fn groups(design: &Design, x: usize) -> Vec<ChartGroup> {
    let other_axes = |label: &dyn Fn(usize) -> String| {
        (0..design.axes.len()).filter(|axis| *axis != x).map(label).collect::<Vec<_>>().join(", ")
    };
    let name = |cell: &usize| other_axes(&|axis| design.cells[*cell].labels[axis].clone());
    let head = |cell: usize| {
        let CellFacts { labels, values, .. } = &design.cells[cell];
        other_axes(&|axis| match values[axis] {
            Some(_) => format!("{} = {}", design.axes[axis], labels[axis]),
            None => labels[axis].clone(),
        })
    };
    let groups = grouped(0..design.cells.len(), name).into_iter();
    groups.map(|(name, cells)| ChartGroup { name, head: head(cells[0]), cells }).collect()
}

/// Origin of the curves of a method, which sets their colour, mark and dash.
pub fn curve_origin(design: &Design, method: usize) -> CurveOrigin {
    curves::curve_origin(&design.methods, &design.methods[method].label)
}

fn curves(compared: &ComparedMethods, x: usize, groups: &[ChartGroup]) -> Panels {
    let ComparedMethods { design, measure, .. } = *compared;
    let titles = compared.titles();
    let values: Vec<f64> = design.cells.iter().filter_map(|cell| cell.values[x]).collect();
    let positive = || values.iter().copied().filter(|value| *value > 0.0);
    let (least, most) = (positive().fold(f64::INFINITY, f64::min), positive().fold(0.0, f64::max));
    let is_wide = values.iter().all(|value| *value >= 0.0) && most > MIN_LOG_AXIS_RATIO * least;
    let across = AxisSpec::new(design.axes[x].clone(), if is_wide { TickRule::Logarithmic } else { TickRule::Decimal });
    let height = if groups.len() == 1 && titles.len() < 3 { 0.3 } else { 0.24 };
    let row = |(panel, title): (usize, &String)| PanelRow {
        reference: measure.reference(panel),
        ..PanelRow::new(measure.ruler(panel, title.clone()), height)
    };
    let panel = |panel: usize, group: &ChartGroup| {
        let at = |cell: usize| design.cells[cell].values[x];
        let of_method = |&method: &usize| {
            let point = |&cell: &usize| {
                let (value, interval) = compared.drawn(cell, method, panel)?;
                Some((at(cell)?, value, interval))
            };
            let origin = curve_origin(design, method);
            let points: Vec<_> = group.cells.iter().filter_map(point).collect();
            (!points.is_empty())
                .then(|| Layer::marks(origin.label(), origin.style(), points).with_line(Pen::from_origin(&origin)))
        };
        let bound = |&cell: &usize| Some((at(cell)?, compared.shown_bound(cell, panel)?));
        let (bx, by): (Vec<f64>, Vec<f64>) = group.cells.iter().filter_map(bound).unzip();
        let pen = Pen::from_origin(&CurveOrigin::Bound).width(1.3);
        let bound = (!bx.is_empty()).then(|| Layer::line(CurveOrigin::Bound.label(), PlotCurve { x: bx, y: by }, pen));
        LayeredPanel {
            head: (panel == 0 && groups.len() > 1).then(|| group.head.clone()),
            layers: compared.methods.iter().filter_map(of_method).chain(bound).collect(),
            ..LayeredPanel::default()
        }
    };
    let marks = design.prose.output.marks.iter().filter(|mark| mark.axis == design.axes[x]);
    let panel_group = PanelGroup {
        x: vec![across; groups.len()],
        rows: titles.iter().enumerate().map(row).collect(),
        panels: (0..titles.len()).flat_map(|row| groups.iter().map(move |group| panel(row, group))).collect(),
        vertical_lines: marks.map(|mark| AxisLine { value: mark.value, label: mark.label.clone() }).collect(),
        ..PanelGroup::default()
    };
    Panels { note: compared.note(groups), overflow_note: compared.beyond(), ..Panels::new(panel_group) }
}

fn named(compared: &ComparedMethods, x: usize, group: &ChartGroup) -> NamedRows {
    let ComparedMethods { design, measure, .. } = *compared;
    let part = std::slice::from_ref(group);
    let column = |(panel, title): (usize, String)| {
        let items_of = |&cell: &usize| {
            let dot = |&method: &usize| {
                let (value, interval) = compared.drawn(cell, method, panel)?;
                let origin = curve_origin(design, method);
                Some(RowItem::mark_below(origin.label(), origin.style(), value, interval))
            };
            let bound = compared.shown_bound(cell, panel);
            let bound = bound.map(|bound| RowItem::new(CurveOrigin::Bound.label(), RowKind::Limit(bound)));
            bound.into_iter().chain(compared.methods.iter().filter_map(dot)).collect()
        };
        RowsColumn {
            x: measure.ruler(panel, title),
            reference: measure.reference(panel),
            rows: group.cells.iter().map(items_of).collect(),
            ..RowsColumn::default()
        }
    };
    NamedRows {
        // Names of trials need no title.
        names_title: if design.axes[x].contains('[') { design.axes[x].clone() } else { String::new() },
        names: group.cells.iter().map(|&cell| design.cells[cell].labels[x].clone()).collect(),
        columns: compared.titles().into_iter().enumerate().map(column).collect(),
        note: compared.note(part),
        overflow_note: compared.beyond(),
        ..NamedRows::default()
    }
}
