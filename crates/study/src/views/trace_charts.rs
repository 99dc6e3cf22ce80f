//! Data of the figures about traces: the confusion matrix, and power over the size of an effect.

use report::Curve;
use report::figures::{HeatMap, HeatPanel, Power, PowerSeries, Scale};
use statrs::distribution::{ChiSquared, ContinuousCDF, Discrete, Poisson};

use campaign::design::Design;
use campaign::statistics::share;
use campaign::summary::{PROMISED, Promised, TraceSummary};

/// Name of the column of trials in which nothing was named.
const NOTHING: &str = "nothing";

/// The confusion matrices: rows are points of the first axis, one matrix for every combination of the others, with its
/// name.
pub fn confusion(design: &Design, lines: &[TraceSummary]) -> Vec<(String, HeatMap)> {
    let mut names: Vec<String> = vec![NOTHING.to_owned()];
    for id in lines.iter().flat_map(|line| line.named.keys()) {
        if !names.contains(id) {
            names.push(id.clone());
        }
    }
    names[1..].sort_unstable();
    let label = |line: &TraceSummary| design.cells[line.cell].labels.first().cloned().unwrap_or_default();
    let rest = |line: &TraceSummary| design.cells[line.cell].labels.get(1..).unwrap_or_default().join(", ");
    let mut rows: Vec<String> = Vec::new();
    let mut groups: Vec<String> = Vec::new();
    for line in lines {
        if !rows.contains(&label(line)) {
            rows.push(label(line));
        }
        if !groups.contains(&rest(line)) {
            groups.push(rest(line));
        }
    }
    if rows.len() < 2 {
        return Vec::new();
    }
    let value = |line: &TraceSummary, name: &String| {
        let count = if name == NOTHING { line.silent } else { line.named.get(name).copied().unwrap_or(0) };
        (count > 0 && line.trials > 0).then(|| 100.0 * count as f64 / line.trials as f64)
    };
    let other_axes = design.axes.get(1..).unwrap_or_default().join(", ");
    let panel = |group: &String| HeatPanel {
        title: if group.is_empty() { String::from("all trials") } else { format!("{other_axes}: {group}") },
        values: rows
            .iter()
            .map(|row| {
                let line = lines.iter().find(|line| label(line) == *row && rest(line) == *group);
                names.iter().map(|name| line.and_then(|line| value(line, name))).collect()
            })
            .collect(),
    };
    let map = |group: &String| HeatMap {
        title: None,
        x_title: String::from("named"),
        y_title: design.axes.first().cloned().unwrap_or_default(),
        x_labels: names.iter().map(|name| name.replace('_', " ")).collect(),
        y_labels: rows.clone(),
        value_title: String::from("share of trials [%]"),
        scale: Scale::Linear,
        panels: vec![panel(group)],
    };
    groups.iter().map(|group| (group.clone(), map(group))).collect()
}

/// Smallest expected likelihood ratio that is drawn.
const SMALLEST: f64 = 1.0;

/// Points of a curve of theory.
const POINTS: usize = 80;

/// Numbers of parameters whose power is drawn.
const PARAMETERS: [u32; 3] = [1, 2, 3];

/// Power over the expected likelihood ratio, for cells with one missing effect.
pub fn power(lines: &[TraceSummary]) -> Option<Power> {
    let points = |needs_search: bool| -> Vec<(f64, f64, Option<[f64; 2]>)> {
        let single = lines.iter().filter(|line| line.missing.len() == 1);
        single
            .filter(|line| is_of_time(&line.missing[0]) == needs_search)
            .filter_map(|line| {
                let share = line.complete_share()?;
                let percent = share.ci95.map(|ends| ends.map(|end| 100.0 * end));
                Some((line.expected.filter(|expected| *expected > SMALLEST)?, 100.0 * share.value, percent))
            })
            .collect()
    };
    let series = [(false, "an effect of the ship or its gear"), (true, "a moment that depends on time")];
    let series: Vec<PowerSeries> = series
        .into_iter()
        .map(|(of_time, name)| PowerSeries { name: name.to_owned(), points: points(of_time) })
        .filter(|series| !series.points.is_empty())
        .collect();
    let largest = series.iter().flat_map(|series| &series.points).map(|point| point.0).reduce(f64::max)?;
    let trace = ::trace::Settings::default().thresholds;
    let theory = PARAMETERS.map(|freedom| {
        // ln n of a record of 300 rows.
        let limit = trace.gain + f64::from(freedom) * 300f64.ln();
        let sizes: Vec<f64> =
            (0..POINTS).map(|k| SMALLEST * (largest / SMALLEST).powf(k as f64 / (POINTS - 1) as f64)).collect();
        let power: Vec<f64> = sizes.iter().map(|&size| 100.0 * exceeds(freedom, size, limit)).collect();
        let plural = if freedom == 1 { "" } else { "s" };
        (format!("likelihood-ratio test, {freedom} parameter{plural}"), Curve::new(sizes, power))
    });
    Some(Power {
        title: None,
        x_title: String::from("expected likelihood ratio against the best first-order response"),
        of_shares: false,
        y_title: String::from("named [%]"),
        series,
        theory: theory.into(),
    })
}

/// Probabilities and how often they came true, for traces of ships whose effects are known; `None` without any.
pub fn reliability(lines: &[TraceSummary]) -> Option<Power> {
    let points: Vec<_> = promised(lines)
        .iter()
        .filter_map(|range| {
            let share = share(range.present, range.effects)?;
            let percent = share.ci95.map(|ends| ends.map(|end| 100.0 * end));
            Some((100.0 * range.sum / range.effects as f64, 100.0 * share.value, percent))
        })
        .collect();
    let series = vec![PowerSeries { name: String::from("effects by their probability"), points }];
    let diagonal = Curve::new(vec![0.0, 100.0], vec![0.0, 100.0]);
    (!series[0].points.is_empty()).then(|| Power {
        title: None,
        x_title: String::from("mean probability given [%]"),
        of_shares: true,
        y_title: String::from("present [%]"),
        series,
        theory: vec![(String::from("as promised"), diagonal)],
    })
}

/// Effects by their probability, over all cells.
pub fn promised(lines: &[TraceSummary]) -> Vec<Promised> {
    let mut all = vec![Promised::default(); PROMISED.len() - 1];
    for line in lines {
        all.iter_mut().zip(&line.promised).for_each(|(all, own)| all.join(own));
    }
    all
}

fn is_of_time(id: &str) -> bool {
    ship::effects::all().iter().any(|effect| effect.id() == id && effect.is_of_time())
}

/// Probability that a noncentral χ² exceeds a limit: a Poisson mixture of central ones.
fn exceeds(freedom: u32, noncentrality: f64, limit: f64) -> f64 {
    let Ok(mixture) = Poisson::new((0.5 * noncentrality).max(f64::MIN_POSITIVE)) else { return 0.0 };
    let reach = 0.5 * noncentrality + 10.0 * (0.5 * noncentrality).sqrt() + 20.0;
    (0..reach as u64)
        .map(|k| {
            let central = ChiSquared::new(f64::from(freedom) + 2.0 * k as f64).map_or(0.0, |chi| chi.sf(limit));
            mixture.pmf(k) * central
        })
        .sum::<f64>()
        .min(1.0)
}

#[cfg(test)]
mod tests {
    use super::exceeds;

    /// P(χ'²₁(λ) > c) = P(|Z + √λ| > √c); for λ = 9, c = 4: Φ(1) + Φ(−5).
    #[test]
    fn the_power_of_one_parameter_is_that_of_a_normal() {
        assert!((exceeds(1, 9.0, 4.0) - 0.841_345_0).abs() < 1e-6);
        assert!((exceeds(1, 0.0, 3.841_459) - 0.05).abs() < 1e-6);
    }
}
