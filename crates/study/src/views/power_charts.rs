//! Data of the figures of traces over the size of an effect and over its probability: detection power, reliability.

use campaign::statistics::{grouped, wilson_share};
use campaign::summary::{CALIBRATION_BIN_EDGES, CalibrationBin, TraceSummary};
use document::names;
use report::PlotCurve;
use report::figures::{AxisSpec, Layer, LayerKind, PanelGroup, PanelRow, Panels, Pen, TickRule};
use report::palette::{
    CurveStyle, DIMENSION_LINE, HEADING, INK, MODEL_BEFORE, Marker, RECORD, RGBColor, RUDDER, SOLID,
};
use statrs::distribution::{ChiSquared, ContinuousCDF, Discrete, Poisson};

use super::remarks::count_range;

/// Minimum expected 2 ln Λ, of the truth against the nearest first-order response, that is plotted.
const MIN_RATIO: f64 = 1.0;

/// Number of points of a theoretical curve.
const POINTS: usize = 240;

/// Excess of 2 ln Λ over its penalty at which an effect is named: 2 ln (19 · 9), which turns the prior odds of 1 to 9
/// into 19 to 1, a probability of 0.95.
const NAMING_SUPPORT: f64 = 10.283;

/// Number of rows of a typical record; its logarithm is the penalty of every parameter in 2 ln Λ, as in BIC.
const TYPICAL_ROWS: f64 = 300.0;

/// Power at which the ideal test has its label, per cent.
const LABELLED_POWER: f64 = 60.0;

/// Smallest and largest number of parameters whose power is plotted.
const PARAMETERS: [u32; 2] = [1, 3];

/// Measured share: its abscissa, its value in per cent, and its 95 % interval.
type MeasuredShare = (f64, f64, Option<[f64; 2]>);

/// Measured shares by name over the layers of the theory.
fn shares(x: AxisSpec, y_title: &str, series: Vec<(String, Vec<MeasuredShare>)>, theory: Vec<Layer>) -> Panels {
    const COLOURS: [RGBColor; MAX_SERIES] = [HEADING, MODEL_BEFORE, RUDDER, DIMENSION_LINE, RECORD, INK];
    const MARKERS: [Marker; MAX_SERIES] =
        [Marker::Circle, Marker::Square, Marker::Diamond, Marker::Up, Marker::Down, Marker::Star];
    let styles = COLOURS.into_iter().zip(MARKERS);
    let marks = |((name, points), (colour, marker)): ((String, Vec<MeasuredShare>), (RGBColor, Marker))| {
        Layer::marks(name, CurveStyle { colour, marker, dash: SOLID, is_hollow: false }, points)
    };
    let layers = theory.into_iter().chain(series.into_iter().zip(styles).map(marks)).collect();
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
        "{} trials at each mark. Λ: likelihood ratio of the truth to a first-order response. Ideal test: {} parameters.",
        count_range(&counts),
        count_range(&PARAMETERS.map(u64::from)),
    );
    let series = grouped(marks, |((name, _), _)| name.clone()).into_iter();
    let series = series.map(|(name, marks)| (name, marks.iter().filter_map(|(_, lines)| point(lines)).collect()));
    let largest = shown.iter().map(|line| expected(line)).reduce(f64::max)?;
    let x = AxisSpec::new("size of the effect: expected 2 ln Λ", TickRule::Logarithmic);
    let data = shares(x, "trials in which it is named [%]", series.collect(), ideal_test(largest));
    Some(Panels { note: Some(note), ..data })
}

/// Power of a likelihood-ratio test with [`PARAMETERS`] under white noise up to the expected 2 ln Λ `largest`, with its
/// label: a band, and its edges, which show it where it has no height.
fn ideal_test(largest: f64) -> Vec<Layer> {
    let power = |freedom: u32| {
        let limit = NAMING_SUPPORT + f64::from(freedom) * TYPICAL_ROWS.ln();
        let sizes: Vec<f64> =
            (0..POINTS).map(|k| MIN_RATIO * (largest / MIN_RATIO).powf(k as f64 / (POINTS - 1) as f64)).collect();
        let power: Vec<f64> = sizes.iter().map(|&size| 100.0 * exceeds(freedom, size, limit)).collect();
        PlotCurve::new(sizes, power)
    };
    let curves = PARAMETERS.map(power);
    let edges = curves.clone().map(|curve| Layer::line("", curve, Pen { opacity: 0.4, ..Pen::new(INK).width(0.5) }));
    let place = curves[0].pairs().find(|(_, share)| *share > LABELLED_POWER);
    let label = place.map(|(x, y)| {
        let text = LayerKind::Labels(vec![String::from("ideal test")], INK);
        Layer::new("", PlotCurve { x: vec![x], y: vec![y] }, text)
    });
    [Layer::band("", curves, INK, 0.2)].into_iter().chain(edges).chain(label).collect()
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
    ranges.iter().any(|bin| bin.present_count > 0).then(|| shares(x, "present [%]", series, vec![theory]))
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
            let layers = detection_power_curves(&lines)?.groups.remove(0).panels.remove(0).layers.split_off(4);
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
