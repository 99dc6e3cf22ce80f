//! Data of the figures of traces: comparison of rules, the confusion matrix, power over the size of an effect.

use document::names;
use std::collections::BTreeSet;

use campaign::scenario::{HULL_ID, TRACE_ID};
use report::figures::{
    AxisSpec, CellMap, Layer, MapCell, NamedRows, Outline, PanelGroup, PanelRow, Panels, Pen, RowItem, RowKind,
    RowsColumn, Shades, TickRule,
};
use report::number::significant;
use report::palette::{
    CurveStyle, DIMENSION_LINE, HEADING, INK, MODEL_BEFORE, Marker, RECORD, RGBColor, RUDDER, SOLID,
};
use report::{CurveOrigin, PlotCurve};
use statrs::distribution::{ChiSquared, ContinuousCDF, Discrete, Poisson};

use campaign::design::Design;
use campaign::statistics::{Statistic, distinct, grouped, wilson_share};
use campaign::summary::{CALIBRATION_BIN_EDGES, CalibrationBin, TraceSummary};

use super::remarks::count_range;

/// Name of the row of ships without a missing effect, and of the column of trials in which no effect was named.
const NOTHING: &str = "nothing";

/// Confusion matrices with their names. A row is the missing effect of the ships of one or more cells. There is one
/// matrix for every combination of the other axes if the first axis decides the missing effect, and one for ships that
/// lack several effects.
pub fn confusion_matrices(design: &Design, lines: &[TraceSummary]) -> Vec<(String, CellMap)> {
    let other_labels = |line: &TraceSummary| design.cells[line.cell].labels.get(1..).unwrap_or_default().join(", ");
    let kinds = |lines: &[&TraceSummary]| lines.iter().map(|line| &line.missing_effects).collect::<BTreeSet<_>>().len();
    let mut groups = grouped(lines, |line| other_labels(line));
    if groups.iter().any(|(_, group)| kinds(group) < 2) {
        groups = vec![(String::new(), lines.iter().collect())];
    }
    let mut matrices = Vec::new();
    for (name, group) in groups {
        let (several, single): (Vec<_>, Vec<_>) = group.into_iter().partition(|line| line.missing_effects.len() > 1);
        for (kind, lines) in [("", single), ("several", several)] {
            if lines.len() > 1 {
                let name_parts = [name.as_str(), kind].into_iter().filter(|word| !word.is_empty());
                matrices.push((name_parts.collect::<Vec<_>>().join(", "), confusion(design, &lines)));
            }
        }
    }
    matrices
}

fn confusion(design: &Design, lines: &[&TraceSummary]) -> CellMap {
    let name = |line: &&TraceSummary| match &line.missing_effects[..] {
        [] => NOTHING.to_owned(),
        _ if line.is_hull() => design.cells[line.cell].labels.first().cloned().unwrap_or_default(),
        missing => names::effect_names(missing, " + "),
    };
    let rows = grouped(lines.iter().copied(), name);
    // Columns are in the order of the rows, so that correct names are on the diagonal.
    let missing =
        rows.iter().flat_map(|(_, lines)| lines).flat_map(|line| &line.missing_effects).filter(|id| *id != HULL_ID);
    let named = missing.chain(lines.iter().flat_map(|line| line.named_effect_counts.keys())).map(String::as_str);
    let is_silent = lines.iter().any(|line| line.nothing_named_count > 0 || line.missing_effects.is_empty());
    let columns = distinct(is_silent.then_some(NOTHING).into_iter().chain(named));
    let cell = |lines: &[&TraceSummary], id: &str| {
        let count = |line: &&TraceSummary| match id {
            NOTHING => line.nothing_named_count,
            id => line.named_effect_counts.get(id).copied().unwrap_or(0),
        };
        let trials: u64 = lines.iter().map(|line| line.trials).sum();
        let named = wilson_share(lines.iter().map(count).sum(), trials).map(|share| share.times(100.0));
        let is_right = lines[0].missing_effects.iter().any(|lack| lack == id)
            || (id == NOTHING && lines[0].missing_effects.is_empty());
        let of_alias: u64 = lines.iter().filter_map(|line| line.named_alias_counts.get(id)).sum();
        let is_alias = 2 * of_alias > lines.iter().map(count).sum();
        MapCell {
            value: Some(named.map_or(0.0, |share| share.value)),
            interval: named.and_then(|share| share.ci95),
            outline: if is_right { Some(Outline::Correct) } else { is_alias.then_some(Outline::Alias) },
            trial_count: trials,
        }
    };
    let trials = |lines: &[&TraceSummary]| lines.iter().map(|line| line.trials).sum::<u64>();
    let cells = rows.iter().map(|(_, lines)| columns.iter().map(|id| cell(lines, id)).collect());
    CellMap {
        axis_titles: [String::from("named by the trace"), String::from("missing")],
        columns: columns.iter().map(|id| names::effect_name(id)).collect(),
        // No line break within the count.
        rows: rows.iter().map(|(name, lines)| format!("{name} (n\u{a0}=\u{a0}{})", trials(lines))).collect(),
        shades: Shades::Shares,
        panels: vec![(None, cells.collect())],
        note: Some(String::from(
            "Shares of the trials in per cent; empty: never named. A trace may name several effects, so that a row may \
             exceed 100.",
        )),
    }
}

/// Comparison of several traces over all ships whose effects are known: the share of trials with exact names, of ships
/// that lack an effect, and the share of trials with a false name. `None` for one trace, or if no ship lacks an
/// effect.
pub fn trace_comparison_rows(design: &Design, lines: &[TraceSummary]) -> Option<NamedRows> {
    let listed: Vec<&TraceSummary> = lines.iter().filter(|line| !line.is_hull()).collect();
    let rules = grouped(listed, |line| line.method);
    if rules.len() < 2 {
        return None;
    }
    let sum = |lines: &[&TraceSummary], count: fn(&TraceSummary) -> u64, lacks: bool| {
        lines.iter().filter(|line| !lacks || !line.missing_effects.is_empty()).map(|line| count(line)).sum::<u64>()
    };
    let trials_of = |lines: &[&TraceSummary], lacks: bool| sum(lines, |line| line.trials, lacks);
    let share_of = |lines: &[&TraceSummary], count: fn(&TraceSummary) -> u64, lacks: bool| {
        wilson_share(sum(lines, count, lacks), trials_of(lines, lacks)).map(|all| all.times(100.0))
    };
    let of_rule = |(method, lines): &(usize, Vec<&TraceSummary>)| {
        let (wrong, exact) = (
            share_of(lines, |line| line.falsely_named_count, false)?,
            share_of(lines, |line| line.exactly_named_count, true)?,
        );
        Some((design.methods[*method].label.as_str(), wrong, exact))
    };
    let counts = [false, true].map(|lacks| trials_of(&rules[0].1, lacks));
    Some(trade_off(&rules.iter().map(of_rule).collect::<Option<Vec<_>>>()?, counts))
}

/// Share of false names of several traces on ships without a missing effect, with 95 % Wilson intervals, whose upper
/// end bounds the rate of false names; `None` for one trace, or if a ship lacks an effect.
pub fn false_positive_rows(design: &Design, lines: &[TraceSummary]) -> Option<NamedRows> {
    let rules = grouped(lines, |line| line.method);
    if rules.len() < 2 || lines.iter().any(|line| !line.missing_effects.is_empty()) {
        return None;
    }
    let style = CurveOrigin::Method(TRACE_ID.to_owned()).style();
    let counted = |(method, lines): &(usize, Vec<&TraceSummary>)| {
        let counts = [|line: &&TraceSummary| line.falsely_named_count, |line: &&TraceSummary| line.trials];
        (design.methods[*method].label.as_str(), counts.map(|count| lines.iter().map(count).sum::<u64>()))
    };
    let mut rules: Vec<(&str, [u64; 2])> = rules.iter().map(counted).collect();
    // Rules with equal counts share the rows of the variants after the comma of their labels.
    let parts = rules.iter().filter_map(|(label, counts)| {
        let (kind, variant) = label.split_once(", ")?;
        Some((variant, kind, *counts))
    });
    let variants = grouped(parts, |(variant, ..)| *variant);
    let kinds = distinct(variants.iter().flat_map(|(_, rows)| rows.iter().map(|(_, kind, _)| *kind)));
    let is_same = |rows: &[(&str, &str, [u64; 2])]| {
        rows.len() == kinds.len() && rows.iter().all(|(.., counts)| *counts == rows[0].2)
    };
    let mut note = String::from("Nothing is missing in any trial.");
    if kinds.len() > 1 && variants.iter().all(|(_, rows)| is_same(rows)) {
        rules = variants.iter().map(|(variant, rows)| (*variant, rows[0].2)).collect();
        note += &format!(" All {} rules give the same.", kinds.len());
    }
    let row = |(_, [wrong, trials]): &(&str, [u64; 2])| {
        let share = wilson_share(*wrong, *trials)?.times(100.0);
        let number = share.ci95.map(|[_, upper]| format!("{wrong} of {trials}: up to {upper:.0} %"));
        Some(vec![RowItem { number, ..RowItem::new("", RowKind::Mark(style, share.value, share.ci95)) }])
    };
    let column = RowsColumn {
        x: AxisSpec::decimal("trials with a false name [%]"),
        rows: rules.iter().map(row).collect::<Option<_>>()?,
        has_zero_line: true,
        ..RowsColumn::default()
    };
    Some(NamedRows {
        names: rules.iter().map(|(label, _)| (*label).to_owned()).collect(),
        names_title: String::from("list of effects"),
        columns: vec![column],
        note: Some(note),
        ..NamedRows::default()
    })
}

/// Rules as rows: one row for every variant after the comma of their labels, with every kind before it; `all` trials,
/// of which `lacking` are of ships that lack an effect.
fn trade_off(rules: &[(&str, Statistic, Statistic)], [all, lacking]: [u64; 2]) -> NamedRows {
    const COLOURS: [RGBColor; 3] = [HEADING, RUDDER, DIMENSION_LINE];
    const MARKERS: [Marker; 3] = [Marker::Circle, Marker::Square, Marker::Diamond];
    let parts: Vec<(&str, &str)> = rules.iter().map(|(name, ..)| name.split_once(", ").unwrap_or(("", name))).collect();
    let kinds = distinct(parts.iter().map(|(kind, _)| *kind));
    let variants = distinct(parts.iter().map(|(_, variant)| *variant));
    let column = |title: String, share: fn(&(&str, Statistic, Statistic)) -> Statistic| {
        let item = |(rule, (kind, _)): (&(&str, Statistic, Statistic), &(&str, &str))| {
            let number = kinds.iter().position(|other| other == kind).unwrap_or(0) % COLOURS.len();
            let style = CurveStyle { colour: COLOURS[number], marker: MARKERS[number], dash: SOLID, is_hollow: false };
            let share = share(rule);
            let number = Some(format!("{} %", significant(share.value, 2)));
            RowItem { number, ..RowItem::mark_below(*kind, style, share.value, share.ci95) }
        };
        let row = |variant: &&str| rules.iter().zip(&parts).filter(|(_, (_, of))| of == variant).map(item).collect();
        RowsColumn { x: AxisSpec::decimal(title), rows: variants.iter().map(row).collect(), ..RowsColumn::default() }
    };
    NamedRows {
        names_title: String::from("named if its probability is"),
        names: variants.iter().map(|variant| (*variant).to_owned()).collect(),
        columns: vec![
            column(format!("trials with a false name (n = {all}) [%]"), |(_, wrong, _)| *wrong),
            column(format!("trials named exactly (n = {lacking}) [%]"), |(.., exact)| *exact),
        ],
        ..NamedRows::default()
    }
}

/// Minimum expected 2 ln Λ, of the truth against the nearest first-order response, that is plotted.
const MIN_RATIO: f64 = 1.0;

/// Number of points of a theoretical curve.
const POINTS: usize = 240;

/// Excess of 2 ln Λ over its penalty at which an effect is named: 2 ln (19 · 9), which turns the prior odds of 1 to 9
/// into 19 to 1, a probability of 0.95.
const NAMING_SUPPORT: f64 = 10.283;

/// Number of rows of a typical record; its logarithm is the penalty of every parameter in 2 ln Λ, as in BIC.
const TYPICAL_ROWS: f64 = 300.0;

/// Smallest and largest number of parameters whose power is plotted.
const PARAMETERS: [u32; 2] = [1, 3];

/// Measured share: its abscissa, its value in per cent, and its 95 % interval.
type MeasuredShare = (f64, f64, Option<[f64; 2]>);

/// Measured shares by name over the layer of the theory.
fn shares(x: AxisSpec, y_title: &str, series: Vec<(String, Vec<MeasuredShare>)>, theory: Layer) -> Panels {
    const COLOURS: [RGBColor; MAX_SERIES] = [HEADING, MODEL_BEFORE, RUDDER, DIMENSION_LINE, RECORD, INK];
    const MARKERS: [Marker; MAX_SERIES] =
        [Marker::Circle, Marker::Square, Marker::Diamond, Marker::Up, Marker::Down, Marker::Star];
    let styles = COLOURS.into_iter().zip(MARKERS);
    let marks = |((name, points), (colour, marker)): ((String, Vec<MeasuredShare>), (RGBColor, Marker))| {
        Layer::marks(name, CurveStyle { colour, marker, dash: SOLID, is_hollow: false }, points)
    };
    let layers = std::iter::once(theory).chain(series.into_iter().zip(styles).map(marks)).collect();
    let row = PanelRow::new(AxisSpec::new(y_title, TickRule::Percent), 0.42);
    Panels::new(PanelGroup::over(x, vec![(row, layers)]))
}

/// Maximum number of named kinds of trial, and of series in a figure.
const MAX_SERIES: usize = 6;

/// Number of ranges per decade of the expected 2 ln Λ if there are many kinds of trial.
const RANGES_PER_DECADE: f64 = 3.0;

/// Chart of the detection power against the expected 2 ln Λ of the truth over the nearest first-order response, for
/// response models with one missing effect. A few cells are shown under the name of the effect; more are pooled over
/// ranges of 2 ln Λ. `None` without such a cell, or if the effect is named in every trial.
pub fn detection_power_curves(lines: &[TraceSummary]) -> Option<Panels> {
    let is_shown = |line: &&TraceSummary| {
        line.missing_effects.len() == 1
            && !line.is_hull()
            && line.mean_expected_2_ln_lambda.is_some_and(|expected| expected > MIN_RATIO)
    };
    let shown: Vec<&TraceSummary> = lines.iter().filter(is_shown).collect();
    if shown.iter().all(|line| line.all_named_count == line.trials) {
        return None;
    }
    let are_few = shown.len() <= MAX_SERIES;
    let expected = |line: &TraceSummary| line.mean_expected_2_ln_lambda.unwrap_or(MIN_RATIO);
    let name = |line: &&TraceSummary| match (are_few, is_time_dependent(&line.missing_effects[0])) {
        (true, _) => names::effect_name(&line.missing_effects[0]),
        (_, false) => String::from("an effect of the ship or its gear"),
        (_, true) => String::from("a moment that depends on time"),
    };
    let point = |lines: &[&TraceSummary]| {
        let share = wilson_share(
            lines.iter().map(|line| line.all_named_count).sum(),
            lines.iter().map(|line| line.trials).sum(),
        )?;
        let middle = (lines.iter().map(|line| expected(line).ln()).sum::<f64>() / lines.len() as f64).exp();
        let share = share.times(100.0);
        Some((middle, share.value, share.ci95))
    };
    let range = |line: &&TraceSummary| match are_few {
        true => line.cell,
        false => (RANGES_PER_DECADE * expected(line).log10()) as usize,
    };
    let marks = grouped(shown.iter().copied(), |line| (name(line), range(line)));
    let counts: Vec<u64> = marks.iter().map(|(_, lines)| lines.iter().map(|line| line.trials).sum()).collect();
    let note = format!(
        "{} trials at each mark. Λ: likelihood ratio of the truth to a first-order response.",
        count_range(&counts)
    );
    let series = grouped(marks, |((name, _), _)| name.clone()).into_iter();
    let series = series.map(|(name, marks)| (name, marks.iter().filter_map(|(_, lines)| point(lines)).collect()));
    let largest = shown.iter().map(|line| expected(line)).reduce(f64::max)?;
    let power = |freedom: u32| {
        let limit = NAMING_SUPPORT + f64::from(freedom) * TYPICAL_ROWS.ln();
        let sizes: Vec<f64> =
            (0..POINTS).map(|k| MIN_RATIO * (largest / MIN_RATIO).powf(k as f64 / (POINTS - 1) as f64)).collect();
        let power: Vec<f64> = sizes.iter().map(|&size| 100.0 * exceeds(freedom, size, limit)).collect();
        PlotCurve::new(sizes, power)
    };
    let [fewest, most] = PARAMETERS;
    let theory = format!("ideal test, {fewest} to {most} parameters");
    let theory = Layer::band(theory, [power(most), power(fewest)], INK, 0.2);
    let x = AxisSpec::new("size of the effect: expected 2 ln Λ", TickRule::Logarithmic);
    let data = shares(x, "trials in which it is named [%]", series.collect(), theory);
    Some(Panels { note: Some(note), ..data })
}

/// Number of trials with one missing effect in which it was named, and of all such trials.
pub fn single_effect_counts(lines: &[TraceSummary]) -> [u64; 2] {
    let single = || lines.iter().filter(|line| line.missing_effects.len() == 1 && !line.is_hull());
    [single().map(|line| line.all_named_count).sum(), single().map(|line| line.trials).sum()]
}

/// Finding: how many of the effects with the highest probabilities were present.
pub fn present_effects_finding(lines: &[TraceSummary]) -> String {
    let ranges = calibration_bins(lines);
    let Some((place, surest)) = ranges.iter().enumerate().rfind(|(_, bin)| bin.effect_count > 0) else {
        return String::from("No effect has a probability");
    };
    let CalibrationBin { present_count: present, effect_count: effects, .. } = surest;
    format!(
        "Of {effects} effects with a probability above {} %, {present} were there",
        100.0 * CALIBRATION_BIN_EDGES[place]
    )
}

/// Minimum number of effects of a share that is plotted as reliable.
const MANY: u64 = 30;

/// Reliability of probabilities, for traces of ships whose effects are known: the share of present effects over the
/// mean probability; `None` if no effect was present.
pub fn reliability_diagram(lines: &[TraceSummary]) -> Option<Panels> {
    let point = |range: &CalibrationBin| {
        let share = wilson_share(range.present_count, range.effect_count)?.times(100.0);
        Some((100.0 * range.probability_sum / range.effect_count as f64, share.value, share.ci95))
    };
    let ranges = calibration_bins(lines);
    let points = |few: bool| ranges.iter().filter(|bin| (bin.effect_count < MANY) == few).filter_map(point).collect();
    let series =
        [(format!("{MANY} effects and more"), points(false)), (format!("fewer than {MANY} effects"), points(true))];
    let series = series.into_iter().filter(|(_, points): &(_, Vec<MeasuredShare>)| !points.is_empty()).collect();
    let diagonal = PlotCurve::new(vec![0.0, 100.0], vec![0.0, 100.0]);
    let x = AxisSpec::new("mean probability given [%]", TickRule::Percent);
    let theory = Layer::line("calibrated", diagonal, Pen::new(INK).width(0.9));
    ranges.iter().any(|bin| bin.present_count > 0).then(|| shares(x, "present [%]", series, theory))
}

/// Calibration of the probabilities of effects: pairs of effect and trial by bins of [`CALIBRATION_BIN_EDGES`], summed
/// over all cells.
pub fn calibration_bins(lines: &[TraceSummary]) -> Vec<CalibrationBin> {
    let mut all = vec![CalibrationBin::default(); CALIBRATION_BIN_EDGES.len() - 1];
    for line in lines {
        all.iter_mut().zip(line.calibration).for_each(|(all, bin)| *all += bin);
    }
    all
}

fn is_time_dependent(id: &str) -> bool {
    ship::effects::all_effects().iter().any(|effect| effect.id() == id && effect.is_time_dependent())
}

/// Probability that a noncentral χ² exceeds a limit: a Poisson mixture of central ones.
fn exceeds(freedom: u32, noncentrality: f64, limit: f64) -> f64 {
    let Ok(mixture) = Poisson::new((0.5 * noncentrality).max(f64::MIN_POSITIVE)) else { return 0.0 };
    let reach = 0.5 * noncentrality + 10.0 * (0.5 * noncentrality).sqrt() + 20.0;
    let central = |k: u64| ChiSquared::new(f64::from(freedom) + 2.0 * k as f64).map_or(0.0, |chi| chi.sf(limit));
    (0..reach as u64).map(|k| mixture.pmf(k) * central(k)).sum::<f64>().min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use campaign::scenario::MethodName;

    /// One trial of four has a false name, and one of the two ships that lack an effect is named exactly.
    #[test]
    fn rules_are_held_against_what_was_missing() {
        let name = |label: &str| MethodName { id: "trace".into(), label: label.into() };
        let design = Design { methods: vec![name("bic, 0.5"), name("bic, 0.9")], ..Design::default() };
        let line = |method, missing: &[&str], exactly_named, falsely_named| TraceSummary {
            missing_effects: missing.iter().map(|&id| id.to_owned()).collect(),
            ..TraceSummary {
                method,
                trials: 2,
                exactly_named_count: exactly_named,
                falsely_named_count: falsely_named,
                ..TraceSummary::default()
            }
        };
        let lines =
            [line(0, &["wave_yaw"], 1, 1), line(0, &[], 2, 0), line(1, &["wave_yaw"], 0, 0), line(1, &[], 2, 0)];
        let data = trace_comparison_rows(&design, &lines).expect("two rules");
        assert_eq!(data.names, ["0.5", "0.9"]);
        let shares = |column: usize, row: usize| match &data.columns[column].rows[row][..] {
            [RowItem { name: Some(kind), kind: RowKind::Mark(_, share, _), .. }] if kind == "bic" => *share,
            _ => panic!(),
        };
        assert_eq!([shares(0, 0), shares(0, 1), shares(1, 0), shares(1, 1)], [25.0, 0.0, 50.0, 0.0]);
        assert!(trace_comparison_rows(&design, &[line(0, &[], 1, 1), line(1, &[], 2, 0)]).is_none());
        assert!(
            trace_comparison_rows(&design, &lines[..2]).is_none() && false_positive_rows(&design, &lines).is_none()
        );
        // For ships without a missing effect the bound is shown: Wilson's of 0 of 2.
        let clean = false_positive_rows(&design, &[line(0, &[], 2, 0), line(1, &[], 1, 1)]).expect("two rules");
        let text = |row: usize| clean.columns[0].rows[row][0].number.as_deref();
        assert_eq!((text(0), text(1)), (Some("0 of 2: up to 66 %"), Some("1 of 2: up to 91 %")));
        // Rules with equal counts have one row for each variant.
        let labels = ["bic, long list", "posterior, long list", "bic, short list", "posterior, short list"];
        let design = Design { methods: labels.map(name).into(), ..Design::default() };
        let lines: Vec<TraceSummary> = (0..4).map(|method| line(method, &[], 1, u64::from(method < 2))).collect();
        let clean = false_positive_rows(&design, &lines).expect("four rules");
        assert_eq!(
            (&clean.names[..], clean.columns[0].rows.len()),
            (&[String::from("long list"), "short list".into()][..], 2)
        );
    }

    /// Few kinds of trial by their names, many by ranges; none if every effect is always named, or if none is missing.
    #[test]
    fn power_is_drawn_where_something_is_missed() {
        let line = |cell: usize, all_named| TraceSummary {
            missing_effects: vec![String::from(if cell == 0 { "wave_yaw" } else { "steering_lag" })],
            ..TraceSummary {
                cell,
                trials: 4,
                all_named_count: all_named,
                mean_expected_2_ln_lambda: Some(20.0),
                ..TraceSummary::default()
            }
        };
        let marks = |lines: Vec<TraceSummary>| -> Option<Vec<(String, Vec<f64>)>> {
            let layers = detection_power_curves(&lines)?.groups.remove(0).panels.remove(0).layers.split_off(1);
            Some(layers.into_iter().map(|layer| (layer.name.unwrap_or_default(), layer.curve.y)).collect())
        };
        let named = |name: &str, y: &[f64]| (name.to_owned(), y.to_vec());
        let few = vec![named("yaw in waves", &[100.0]), named("steering lag", &[25.0, 50.0])];
        assert_eq!(marks(vec![line(0, 4), line(1, 1), line(2, 2)]), Some(few));
        let many = marks((0..8).map(|cell| line(cell, u64::from(cell > 3))).collect()).expect("some are missed");
        assert_eq!(many.iter().map(|(_, y)| y.len()).sum::<usize>(), many.len());
        assert!(marks(vec![line(0, 4), line(1, 4)]).is_none() && reliability_diagram(&[line(0, 4)]).is_none());
    }

    /// P(χ'²₁(λ) > c) = P(|Z + √λ| > √c); for λ = 9, c = 4: Φ(1) + Φ(−5).
    #[test]
    fn the_power_of_one_parameter_is_that_of_a_normal() {
        assert!((exceeds(1, 9.0, 4.0) - 0.841_345_0).abs() < 1e-6);
        assert!((exceeds(1, 0.0, 3.841_459) - 0.05).abs() < 1e-6);
    }
}
