//! Maps over two axes, and distributions of errors: of all trials of a study with one cell, or of cells whose detail
//! was requested.

use campaign::design::Design;
use campaign::statistics::{NORMAL_QUANTILE_95, Statistic, distinct, grouped};
use campaign::summary::{self, CellDetail, MethodDetail, PredictionSummary, Summary};
use estimation::statistics::median;
use report::figures::{
    AxisSpec, CellMap, Layer, LayerKind, LayeredPanel, MapCell, NamedRows, PanelGroup, PanelRow, Panels, Pen, RowItem,
    RowKind, RowPlace, RowsColumn, Shades, TickRule,
};
use report::number::significant;
use report::palette::{DASHED, DOTTED, INK};
use report::{CurveOrigin, PlotCurve, symbol};

use super::charts::{ErrorMeasure, comparable_methods, curve_origin, rms_title};
use super::remarks::sd_half_width_percent;

/// Minimum number of points of an axis for a map.
const MIN_MAP_POINTS: usize = 3;

/// Maps of the errors of K, of T and of the validation for a design of two axes: stem, title of the quantity, and map
/// of each; empty if an axis has fewer than three points.
pub fn error_heat_maps(design: &Design, summary: &Summary) -> Vec<(String, String, CellMap)> {
    let labels = |axis: usize| distinct(design.cells.iter().map(|cell| cell.labels[axis].clone()));
    if design.axes.len() != 2 {
        return Vec::new();
    }
    let (rows, columns) = (labels(0), labels(1));
    if rows.len() < MIN_MAP_POINTS || columns.len() < MIN_MAP_POINTS {
        return Vec::new();
    }
    let map_of = |(measure, panel, stem): (ErrorMeasure, usize, &str)| {
        let (methods, to_nearest) = comparable_methods(design, measure, design.cells.iter())?;
        let title = match measure {
            ErrorMeasure::Rms => rms_title(stem, to_nearest),
            _ => String::from("median error of an unseen heading [°]"),
        };
        // Cells are the product of the axes, the first axis slowest.
        let figure = |x: usize, y: usize, method: usize| {
            measure.statistic(summary.performance(y * columns.len() + x, method)?, panel)
        };
        let cell = |x: usize, y: usize, method: usize| MapCell {
            value: figure(x, y, method).map(|figure| figure.value),
            ..MapCell::default()
        };
        let places = (0..rows.len()).flat_map(|y| (0..columns.len()).map(move |x| (x, y)));
        let figures = places.flat_map(|(x, y)| methods.iter().filter_map(move |&method| figure(x, y, method)));
        let half_width = |figure: Statistic| figure.ci95.map(|[low, high]| 50.0 * (high - low) / figure.value);
        let widest = figures.filter_map(half_width).filter(|width| width.is_finite()).reduce(f64::max);
        let panel = |method: usize| {
            let row = |y: usize| (0..columns.len()).map(|x| cell(x, y, method)).collect();
            (Some(design.methods[method].label.clone()), (0..rows.len()).map(row).collect())
        };
        let map = CellMap {
            axis_titles: [design.axes[1].clone(), design.axes[0].clone()],
            columns: columns.clone(),
            rows: rows.clone(),
            shades: Shades::Range(TickRule::Logarithmic, title.clone()),
            note: widest.map(|width| format!("95 % intervals: at most ±{} % of the value.", significant(width, 1))),
            panels: methods.into_iter().map(panel).collect(),
        };
        Some((format!("heat-map-{stem}"), title, map))
    };
    let is_there = |(_, _, map): &(String, String, CellMap)| {
        map.panels.iter().flat_map(|(_, rows)| rows).flatten().any(|cell| cell.value.is_some())
    };
    let maps = [(ErrorMeasure::Rms, 0, "K"), (ErrorMeasure::Rms, 1, "T"), (ErrorMeasure::Validation, 0, "validation")];
    maps.into_iter().filter_map(map_of).filter(is_there).collect()
}

/// Maximum distance of the end of a whisker from zero, in medians of these distances; longer whiskers are cut.
const MAX_SPREADS: f64 = 4.0;

/// Distributions of the errors in the cells whose detail was requested, by cell index; none for fewer than ten trials.
pub fn error_violins(design: &Design, summary: &Summary) -> Vec<(usize, NamedRows)> {
    type Of = fn(&MethodDetail) -> &Option<summary::ErrorDensity>;
    let column = |detail: &CellDetail, title: &str, density_of: Of| RowsColumn {
        x: AxisSpec::decimal(title).limited_around(MAX_SPREADS, Some(0.0)),
        rows: (detail.methods.iter().enumerate())
            .map(|(method, detail)| {
                let style = curve_origin(design, method).style();
                let violin = |pdf: &summary::ErrorDensity| RowKind::Violin(style, pdf.density.clone(), pdf.quantiles);
                density_of(detail).as_ref().map(|density| RowItem::new("", violin(density))).into_iter().collect()
            })
            .collect(),
        has_zero_line: true,
        ..RowsColumn::default()
    };
    let of_cell = |detail: &CellDetail| {
        let columns = vec![
            column(detail, "error of K [%]", |detail| &detail.k_errors),
            column(detail, "error of T [%]", |detail| &detail.t_errors),
        ];
        let trials = summary.performance(detail.cell, 0).map_or(0, |performance| performance.trials);
        let is_drawn = columns.iter().flat_map(|column| &column.rows).any(|row| !row.is_empty());
        let names = (0..detail.methods.len()).map(|method| design.methods[method].label.clone()).collect();
        let note =
            Some(String::from("Shape: density. Box: quartiles, with the median. Line and numbers: 2.5 to 97.5 %."));
        (trials >= 10 && is_drawn).then_some((detail.cell, NamedRows { names, columns, note, ..NamedRows::default() }))
    };
    summary.details.iter().filter_map(of_cell).collect()
}

/// Half width of the axes of clouds, in median sizes of the ellipses.
const REACH: f64 = 2.2;

/// Maximum size of an ellipse with a panel, in medians: a larger one would leave its panel empty.
const FAR: f64 = 3.0;

/// Clouds of errors in the cells whose detail was requested: index of the cell, `true` if it has a bound, and the
/// clouds.
pub fn error_clouds(design: &Design, summary: &Summary) -> Vec<(usize, bool, Panels)> {
    let of_cell = |detail: &CellDetail| {
        let covariance_bound = design.cells[detail.cell].cramer_rao_percent2;
        let bound = covariance_bound.map(|covariance| PlotCurve::contour95([0.0; 2], covariance));
        let panel = |(method, detail): (usize, &MethodDetail)| {
            let (origin, cloud) = (curve_origin(design, method), detail.joint_errors.as_ref());
            let (x, y) = cloud.map(|cloud| cloud.points.iter().copied().unzip()).unwrap_or_default();
            let ellipse = cloud
                .map_or_else(PlotCurve::default, |cloud| PlotCurve::contour95(cloud.centre.into(), cloud.covariance));
            let mut layers = vec![
                Layer::new("", PlotCurve { x, y }, LayerKind::Cloud(origin.style().colour)),
                Layer::line("", ellipse, Pen::new(origin.style().colour).width(1.3)),
            ];
            let pen = Pen { dash: DOTTED, ..Pen::from_origin(&CurveOrigin::Bound) };
            let name = "Cramér–Rao bound, 95 %";
            layers.extend(
                bound.as_ref().map(|bound| Layer::line(name, bound.clone(), pen.width(1.2)).widening_at_most(REACH)),
            );
            let detail = covariance_bound.zip(cloud).map(|(bound, cloud)| {
                let sd_over_bound = (cloud.covariance[1][1] / bound[1][1]).sqrt();
                format!("T {}× the bound", significant(sd_over_bound, 3))
            });
            LayeredPanel { head: Some(design.methods[method].label.clone()), result: detail, layers }
        };
        let spread = |detail: &MethodDetail| {
            detail.joint_errors.as_ref().map_or(0.0, |cloud| (cloud.covariance[0][0] + cloud.covariance[1][1]).sqrt())
        };
        let usual = median(&mut detail.methods.iter().map(spread).filter(|spread| *spread > 0.0).collect::<Vec<_>>());
        let is_near = |(_, detail): &(usize, &MethodDetail)| usual.is_none_or(|usual| spread(detail) <= FAR * usual);
        let (near, far): (Vec<_>, Vec<_>) = detail.methods.iter().enumerate().partition(is_near);
        let far: Vec<&str> = far.iter().map(|(method, _)| design.methods[*method].label.as_str()).collect();
        let count = near.len();
        let axis = |index: &str| AxisSpec::decimal(format!("error of {} [%]", symbol(index))).limited_about_zero(REACH);
        let panels = near.into_iter().map(panel).collect();
        let across = if count == 4 { 2 } else { count.clamp(1, 3) };
        let multiples = PanelGroup::multiples(across, axis("K"), PanelRow::zeroed(axis("T"), 0.24), panels);
        let points =
            detail.methods.iter().flat_map(|fit| &fit.joint_errors).map(|cloud| cloud.points.len()).max().unwrap_or(0);
        let trials = summary.performance(detail.cell, 0).map_or(0, |performance| performance.trials);
        let mut note = format!(
            "Outlines: 95 % ellipses, solid for the trials, dotted for the bound. Points: {points} of {trials}. 95 % \
             intervals of the multiples of the bound: ±{:.1} %.",
            sd_half_width_percent(trials)
        );
        if !far.is_empty() {
            note += &format!(" Not drawn, because they scatter more than {FAR} times as far: {}.", far.join(", "));
        }
        let data = Panels { note: Some(note), ..Panels::new(PanelGroup { has_zero_line: true, ..multiples }) };
        let is_drawn = detail.methods.iter().any(|detail| detail.joint_errors.is_some());
        is_drawn.then_some((detail.cell, bound.is_some(), data))
    };
    summary.details.iter().filter_map(of_cell).collect()
}

/// Mean K and T by the reference method at the named points of the last axis, relative to those at the first point,
/// with a series for every point of the other axes; and the label of the method. `None` if all ships are of first
/// order, if the study has traces, or if the last axis has numbers or a single point.
pub fn ratios_to_first_point(design: &Design, summary: &Summary) -> Option<(NamedRows, String)> {
    let last = design.axes.len().checked_sub(1)?;
    let is_named = design.cells.iter().all(|cell| cell.values[last].is_none());
    if !is_named || design.cells.iter().all(|cell| !cell.is_compared_with_nearest) || !summary.tracing.is_empty() {
        return None;
    }
    let names = distinct(design.cells.iter().map(|cell| cell.labels[last].as_str()));
    let series = grouped(0..design.cells.len(), |&cell| design.cells[cell].labels[..last].join(", "));
    if names.len() < 2 || series.iter().any(|(_, cells)| cells.len() != names.len()) {
        return None;
    }
    let answer = |cell: usize, panel: usize| {
        let performance = summary.performance(cell, summary.reference)?;
        [&performance.k, &performance.t][panel].mean_estimate
    };
    let column = |panel: usize, symbol: &str| {
        let row = |row: usize| {
            let dot = |(number, (label, cells)): (usize, &(String, Vec<usize>))| {
                let first = answer(cells[0], panel)?;
                let ratio = answer(cells[row], panel)?.times(1.0 / first.value);
                let origin = CurveOrigin::Series { label: label.clone(), number };
                Some(RowItem::mark_below(origin.label(), origin.style(), ratio.value, ratio.ci95))
            };
            series.iter().enumerate().filter_map(dot).collect()
        };
        let x = AxisSpec::decimal(format!("{symbol} / {symbol} of the {}", names[0]));
        RowsColumn { x, rows: (0..names.len()).map(row).collect(), ..RowsColumn::default() }
    };
    let rows = NamedRows {
        names_title: design.axes[last].clone(),
        names: names.iter().map(|name| (*name).to_owned()).collect(),
        columns: vec![column(0, "K"), column(1, "T")],
        note: Some(format!("Marks: means by {}.", design.methods[summary.reference].label)),
        ..NamedRows::default()
    };
    Some((rows, design.methods[summary.reference].label.clone()))
}

/// Name of the row of all cells together.
pub const ALL_CELLS_ROW: &str = "all";

/// Maximum number of rows of single cells in a figure of predictions; for more cells the rows are the points of the
/// longest axis.
const MAX_ROWS: usize = 10;

/// Cells that share one row of predictions, with the name of the row.
fn prediction_rows(design: &Design) -> Vec<(String, Vec<usize>)> {
    let labels = |axis: usize| distinct(design.cells.iter().map(|cell| cell.labels[axis].as_str())).len();
    let longest = (0..design.axes.len()).max_by_key(|&axis| labels(axis));
    let name = |cell: usize| {
        let facts = &design.cells[cell];
        match longest.filter(|_| design.cells.len() > MAX_ROWS) {
            Some(axis) => facts.labels[axis].clone(),
            // Records of measured rows differ in number.
            None if design.is_measured() => {
                format!("{}{COUNT_PREFIX} {})", facts.labels.join(", "), facts.trial_count())
            }
            None => facts.labels.join(", "),
        }
    };
    grouped(0..design.cells.len(), |&cell| name(cell))
}

/// Text between the name of a row and the number of its records.
pub const COUNT_PREFIX: &str = " (n =";

/// Centre and ends of some values after `outer` per cent are cut at either end: the mean without a cut, else the
/// median; `None` without values.
fn centre(mut values: Vec<f64>, outer: usize) -> Option<(f64, [f64; 2])> {
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    let cut = last * outer / 100;
    let ends = [values[cut], values[last - cut]];
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    Some((if outer > 0 { median(&mut values)? } else { mean }, ends))
}

/// Row items of a prediction: the range as a bar, and the value as a mark beside it.
fn prediction_items(origin: &CurveOrigin, value: f64, ends: [f64; 2]) -> Vec<RowItem> {
    let style = origin.style();
    let range = RowItem::new(origin.label(), RowKind::WideInterval(style.colour, ends));
    let mark = RowItem::new(origin.label(), RowKind::Mark(style, value, None));
    vec![RowItem { place: RowPlace::Below, ..range }, RowItem { place: RowPlace::SameLine, ..mark }]
}

/// Sentence on the maximum half width over the cells of the 95 % interval of a share of 90 %. Characteristics of a
/// trial may be correlated, so each trial counts once. Measured records are not independent and have no interval.
fn certainty(design: &Design) -> String {
    let trials = design.min_trial_count();
    if design.is_measured() {
        return String::from(" Records of one ship are not independent: no intervals.");
    }
    if trials == 0 {
        return String::new();
    }
    let half_width = 100.0 * NORMAL_QUANTILE_95 * (0.9 * 0.1 / trials as f64).sqrt();
    format!(" 95 % interval of a share of 90 %: at most ±{half_width:.0} points.")
}

/// Coverage and width of 90 % prediction intervals, by row and method: as marks the mean share and the median width
/// over the predicted characteristics, as bars the range of the shares and the middle half of the widths; `None`
/// without predictions.
pub fn prediction_coverage(design: &Design, summary: &Summary) -> Option<NamedRows> {
    type Of = fn(&PredictionSummary) -> f64;
    let rows = prediction_rows(design);
    let several = rows.len() > 1;
    let column = |x: AxisSpec, pick: Of, outer: usize, lines: Vec<(String, Pen, f64)>| {
        let of_method = |method: usize| -> Vec<Vec<RowItem>> {
            let origin = curve_origin(design, method);
            let items = |(value, ends): (f64, [f64; 2])| prediction_items(&origin, value, ends);
            let is_of =
                |line: &&PredictionSummary, cells: &[usize]| line.method == method && cells.contains(&line.cell);
            let of_cells = |cells: &[usize]| {
                centre(summary.predictions.iter().filter(|line| is_of(line, cells)).map(pick).collect(), outer)
            };
            // The first row has the marks of all cells.
            let cells = (0..design.cells.len()).filter_map(|cell| of_cells(&[cell]));
            let all = centre(cells.map(|(value, _)| value).collect(), outer);
            let all = several.then(|| all.map_or_else(Vec::new, |(value, _)| items((value, [value; 2]))));
            let rows = rows.iter().map(|(_, cells)| of_cells(cells).map_or_else(Vec::new, items));
            all.into_iter().chain(rows).collect()
        };
        let columns: Vec<_> = (0..design.methods.len()).map(of_method).collect();
        let row = |row: usize| columns.iter().flat_map(|column| column[row].clone()).collect();
        let rows = (0..rows.len() + usize::from(several)).map(row).collect();
        RowsColumn { x, rows, vertical_lines: lines, ..RowsColumn::default() }
    };
    let names = rows.iter().map(|(name, _)| name.clone());
    let names = several.then(|| String::from(ALL_CELLS_ROW)).into_iter().chain(names).collect();
    let truth = if design.is_measured() { "measured value" } else { "truth" };
    let inside = |line: &PredictionSummary| 100.0 * line.inside_share();
    let width = |line: &PredictionSummary| 100.0 * line.relative_to_truth(line.mean_interval_width());
    (!summary.predictions.is_empty()).then(|| NamedRows {
        names,
        columns: vec![
            column(
                AxisSpec::new(format!("90 % intervals that contain the {truth} [%]"), TickRule::Percent),
                inside,
                0,
                vec![(String::from("90 %"), Pen { dash: DASHED, ..Pen::new(INK) }, 90.0)],
            ),
            column(AxisSpec::new("width [% of value]", TickRule::Logarithmic), width, 25, Vec::new()),
        ],
        note: Some(format!(
            "Over the predicted overshoots, times and turns. Marks: mean share, median width. Bands: from the worst to the \
             best quantity, the middle half of the widths.{}",
            certainty(design)
        )),
        ..NamedRows::default()
    })
}
