//! Where an axis is marked: round numbers in the steps a reader counts in (decimal, seconds and minutes, degrees).
//! Labels are made here too, so that all labels of an axis have the same number of decimals.

use crate::number;

/// The steps an axis is divided in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TickSteps {
    /// 1, 2, 2.5, 5 times a power of ten.
    Decimal,
    /// Seconds: 1, 2, 5, 10, 20, 30 s, then whole minutes' worth.
    Time,
    /// Degrees: 1, 2, 5, 10, 15, 20, 30, 45, 60, 90, 180.
    Angle,
}

const DECIMAL: [f64; 4] = [1.0, 2.0, 2.5, 5.0];
const TIME: [f64; 14] = [1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0, 900.0, 1800.0, 3600.0, 7200.0];
const ANGLE: [f64; 11] = [1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0, 180.0];

/// The smallest step that divides `span` into at most `intervals` parts.
pub(crate) fn nice_step(span: f64, intervals: usize, steps: TickSteps) -> f64 {
    let wanted = span / intervals.max(1) as f64;
    let listed: &[f64] = match steps {
        TickSteps::Decimal => &[],
        TickSteps::Time => &TIME,
        TickSteps::Angle => &ANGLE,
    };
    // Below one unit seconds and degrees are divided decimally, as everything is beyond the end of the list.
    if wanted > 0.5
        && let Some(step) = listed.iter().find(|step| **step >= wanted * (1.0 - 1e-9))
    {
        return *step;
    }
    let power = 10f64.powf(wanted.log10().floor());
    let leading = wanted / power * (1.0 - 1e-9);
    DECIMAL.iter().find(|d| **d >= leading).map_or(10.0 * power, |d| d * power)
}

/// The multiples of `step` inside `lo..=hi`.
pub(crate) fn multiples(lo: f64, hi: f64, step: f64) -> Vec<f64> {
    // A tick on the end of the axis must not fall victim to rounding.
    let slack = 1e-9 * (hi - lo).abs() / step;
    let first = (lo / step - slack).ceil();
    let last = (hi / step + slack).floor();
    let count = (last - first + 1.0).clamp(0.0, 1000.0) as usize;
    (0..count).map(|i| (first + i as f64) * step).collect()
}

/// How many parts an interval of `step` is divided in by minor ticks, so that these are round numbers too.
pub(crate) fn minor_parts(step: f64) -> usize {
    let leading = step / 10f64.powf((step.log10() + 1e-9).floor());
    match (10.0 * leading).round() as i64 {
        15 | 18 | 30 | 45 | 90 => 3,
        12 | 20 | 36 | 60 | 72 => 4,
        _ => 5,
    }
}

/// Labels of `ticks`, all with the decimals that `step` needs.
pub(crate) fn labels(ticks: &[f64], step: f64) -> Vec<String> {
    let largest = ticks.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if step < 1e-5 || largest >= 1e6 {
        return ticks
            .iter()
            .map(|v| if v.abs() < step / 2.0 { "0".into() } else { number::significant(*v, 3) })
            .collect();
    }
    let decimals = (0..9)
        .find(|d| {
            let scaled = step * 10f64.powi(*d);
            (scaled - scaled.round()).abs() < 1e-6 * scaled.max(1.0)
        })
        .unwrap_or(9) as usize;
    ticks.iter().map(|v| number::fixed(*v, decimals)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_those_a_reader_counts_in() {
        assert_eq!(nice_step(240.0, 8, TickSteps::Time), 30.0);
        assert_eq!(nice_step(120.0, 6, TickSteps::Angle), 20.0);
        assert_eq!(nice_step(100.0, 10, TickSteps::Decimal), 10.0);
        assert!((nice_step(0.07, 7, TickSteps::Decimal) - 0.01).abs() < 1e-15);
        assert!((nice_step(0.9, 5, TickSteps::Angle) - 0.2).abs() < 1e-15);
        assert_eq!(nice_step(80_000.0, 5, TickSteps::Time), 20_000.0);
    }

    /// Ranges over twenty decades: never more intervals than allowed, never fewer than a third, ticks inside the range.
    #[test]
    fn chooser_properties() {
        for steps in [TickSteps::Decimal, TickSteps::Time, TickSteps::Angle] {
            for exponent in -10..10 {
                for leading in [1.0, 1.3, 2.7, 4.9, 9.99] {
                    for intervals in [3_usize, 5, 8] {
                        let span = leading * 10f64.powi(exponent);
                        let lo = -0.37 * span;
                        let step = nice_step(span, intervals, steps);
                        let ticks = multiples(lo, lo + span, step);
                        let case = format!("{steps:?} span {span} in {intervals}: {ticks:?}");
                        assert!(ticks.len() <= intervals + 1, "{case}");
                        assert!(3 * ticks.len() >= intervals, "{case}");
                        assert!(
                            ticks.iter().all(|t| *t >= lo - 1e-9 * span && *t <= lo + span * (1.0 + 1e-9)),
                            "{case}"
                        );
                        assert!(ticks.windows(2).all(|w| (w[1] - w[0] - step).abs() < 1e-9 * span), "{case}");
                        let mut unique = labels(&ticks, step);
                        unique.dedup();
                        assert_eq!(unique.len(), ticks.len(), "{case}");
                    }
                }
            }
        }
    }

    #[test]
    fn labels_share_decimals_and_use_a_true_minus() {
        assert_eq!(labels(&[-2.5, 0.0, 2.5], 2.5), ["−2.5", "0.0", "2.5"]);
        assert_eq!(labels(&[0.0, 2e-7], 2e-7), ["0", "2.00×10⁻⁷"]);
    }
}
