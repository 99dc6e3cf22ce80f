//! An axis: from a value to its place along the axis, and the ticks that say so. Linear, logarithmic, logarithmic with
//! a separate place for zero, and a list of names.

use crate::number;
use crate::ticks::{self, TickSteps};

/// Share of a logarithmic axis that belongs to zero and the break.
const ZERO_SLOT: f64 = 0.21;
/// Where on the axis zero stands.
const ZERO_AT: f64 = 0.08;
/// Where the break is drawn.
const BREAK_AT: f64 = 0.155;

/// Largest magnitude on a linear axis.
const LARGEST: f64 = 1e100;

#[derive(Debug, Clone, PartialEq)]
enum AxisScale {
    Linear(TickSteps),
    Log {
        zero: bool,
    },
    /// One unit per name; the first name at 0, counted from the top of a vertical axis.
    Names(Vec<String>),
    /// The same, counted from the left of a horizontal axis.
    Columns(Vec<String>),
}

/// One axis of a panel.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlotAxis {
    lo: f64,
    hi: f64,
    scale: AxisScale,
    /// Distance of the ticks, where it is not for the axis to choose.
    step: Option<f64>,
    /// The last value with a tick: beyond is room for text.
    last: f64,
}

/// The marks of an axis, as fractions of its length.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Ticks {
    pub major: Vec<(f64, String)>,
    pub minor: Vec<f64>,
}

impl PlotAxis {
    fn new(lo: f64, hi: f64, scale: AxisScale) -> Self {
        Self { lo, hi, scale, step: None, last: f64::INFINITY }
    }

    /// From `lo` to `hi`; a range that is empty or not finite is widened to something that can be drawn.
    pub(crate) fn linear(lo: f64, hi: f64, steps: TickSteps) -> Self {
        let (lo, hi) = match (lo.is_finite(), hi.is_finite()) {
            (true, true) => (lo.min(hi), lo.max(hi)),
            (true, false) => (lo, lo),
            (false, true) => (hi, hi),
            (false, false) => (0.0, 1.0),
        };
        // Beyond this the arithmetic of ticks overflows; nothing a ship does comes near.
        let (lo, hi) = (lo.clamp(-LARGEST, LARGEST), hi.clamp(-LARGEST, LARGEST));
        let smallest = 1e-9 * lo.abs().max(hi.abs());
        let (lo, hi) = if hi - lo > smallest.max(1e-300) {
            (lo, hi)
        } else {
            let half = if lo == 0.0 { 1.0 } else { 0.05 * lo.abs() };
            (lo - half, hi + half)
        };
        Self::new(lo, hi, AxisScale::Linear(steps))
    }

    /// Covers the finite `values` with a margin of `pad` of their range on either side.
    pub(crate) fn covering(values: impl IntoIterator<Item = f64>, pad: f64, steps: TickSteps) -> Self {
        match range(values) {
            Some((lo, hi)) => Self::linear(lo - pad * (hi - lo), hi + pad * (hi - lo), steps),
            None => Self::linear(f64::NAN, f64::NAN, steps),
        }
    }

    /// Covers the positive `values` on a logarithmic scale; a zero among them gets a place of its own before a break.
    pub(crate) fn log_covering(values: impl IntoIterator<Item = f64> + Clone) -> Self {
        let zero = values.clone().into_iter().any(|v| v == 0.0);
        let positive = range(values.into_iter().filter(|v| *v > 0.0));
        let (lo, hi) = positive.unwrap_or((0.1, 10.0));
        let (lo, hi) = (lo.clamp(LARGEST.recip(), LARGEST), hi.clamp(LARGEST.recip(), LARGEST));
        let pad = ((hi / lo).log10() * 0.06).max(0.05);
        let widen = 10f64.powf(pad);
        Self::new(lo / widen, hi * widen, AxisScale::Log { zero })
    }

    /// From `lo` to `hi`, both positive, on a logarithmic scale.
    pub(crate) fn log_between(lo: f64, hi: f64) -> Self {
        Self::new(lo, hi, AxisScale::Log { zero: false })
    }

    /// A list of names, one unit each, the first at the top (of a vertical axis).
    pub(crate) fn names(names: Vec<String>) -> Self {
        Self::new(-0.6, names.len().max(1) as f64 - 0.4, AxisScale::Names(names))
    }

    /// Short names along a horizontal axis, one unit each, the first at the left; the axis ends where they do.
    pub(crate) fn columns(names: Vec<String>) -> Self {
        Self::new(-0.5, names.len().max(1) as f64 - 0.5, AxisScale::Columns(names))
    }

    /// The same axis with ticks at the multiples of `step`, as long as there are two.
    pub(crate) fn stepped(self, step: f64) -> Self {
        Self { step: Some(step), ..self }
    }

    /// The same axis without ticks beyond a value above its lower end.
    pub(crate) fn told_until(self, last: f64) -> Self {
        Self { last, ..self }
    }

    /// Kind, ends and where the scale begins as a fraction, or the names: what a value is found with from its place.
    pub(crate) fn described(&self) -> String {
        let Self { lo, hi, .. } = self;
        match &self.scale {
            AxisScale::Linear(_) => format!("linear|{lo}|{hi}"),
            AxisScale::Log { zero } => format!("log|{lo}|{hi}|{}", if *zero { ZERO_SLOT } else { 0.0 }),
            AxisScale::Names(names) | AxisScale::Columns(names) => format!("names|{lo}|{hi}|{}", names.join("|")),
        }
    }

    /// How much one step of `fraction` of the axis is worth on a linear scale.
    pub(crate) fn worth(&self, fraction: f64) -> f64 {
        fraction * (self.hi - self.lo)
    }

    /// The same axis from `lo` to `hi`, which are in order.
    pub(crate) fn between(self, lo: f64, hi: f64) -> Self {
        Self { lo, hi, ..self }
    }

    /// Whether it has numbers and no names.
    pub(crate) fn is_numeric(&self) -> bool {
        matches!(self.scale, AxisScale::Linear(_) | AxisScale::Log { .. })
    }

    /// Whether it is logarithmic.
    pub(crate) fn is_logarithmic(&self) -> bool {
        matches!(self.scale, AxisScale::Log { .. })
    }

    /// Whether it is a list of names from left to right.
    pub(crate) fn is_columns(&self) -> bool {
        matches!(self.scale, AxisScale::Columns(_))
    }

    /// Where the axis is broken, as a fraction.
    pub(crate) fn break_at(&self) -> Option<f64> {
        matches!(self.scale, AxisScale::Log { zero: true }).then_some(BREAK_AT)
    }

    /// Place of `value` as a fraction of the axis, outside 0..1 when it lies beyond the ends; `None` when it has no
    /// place (not finite, or not positive on a logarithmic scale).
    pub(crate) fn fraction(&self, value: f64) -> Option<f64> {
        if !value.is_finite() {
            return None;
        }
        match &self.scale {
            AxisScale::Linear(_) | AxisScale::Columns(_) => Some((value - self.lo) / (self.hi - self.lo)),
            AxisScale::Names(_) => Some(1.0 - (value - self.lo) / (self.hi - self.lo)),
            AxisScale::Log { zero } if value > 0.0 => {
                let along = (value / self.lo).log10() / (self.hi / self.lo).log10();
                let start = if *zero { ZERO_SLOT } else { 0.0 };
                Some(start + along * (1.0 - start))
            }
            AxisScale::Log { zero } => (*zero && value == 0.0).then_some(ZERO_AT),
        }
    }

    /// The marks, at most `count` intervals (names are always all shown).
    pub(crate) fn ticks(&self, count: usize) -> Ticks {
        match &self.scale {
            AxisScale::Linear(steps) => self.linear_ticks(count, *steps),
            AxisScale::Log { zero } => self.log_ticks(count, *zero),
            AxisScale::Names(names) | AxisScale::Columns(names) => {
                let at = |i: usize| self.fraction(i as f64).expect("an index is finite");
                Ticks { major: names.iter().enumerate().map(|(i, n)| (at(i), n.clone())).collect(), minor: vec![] }
            }
        }
    }

    fn linear_ticks(&self, count: usize, steps: TickSteps) -> Ticks {
        let multiples = |step: f64| ticks::multiples(self.lo, self.hi.min(self.last), step);
        let divide = |intervals: usize| {
            let step = ticks::nice_step(self.hi - self.lo, intervals, steps);
            (step, multiples(step))
        };
        let count = count.max(1);
        // One interval more can still give no more ticks than allowed, because the ends of the axis are not round. And
        // a single label says nothing about the scale, so the step shrinks until there are two.
        let given = self.step.map(|step| (step, multiples(step)));
        let (step, values) = given
            .into_iter()
            .chain(std::iter::once(divide(count + 1)).filter(|(_, values)| values.len() <= count + 1))
            .chain((count..).map(divide))
            .find(|(_, values)| values.len() > 1)
            .expect("a small enough step has two multiples in any range");
        let place = |v: f64| (v - self.lo) / (self.hi - self.lo);
        let labels = ticks::labels(&values, step);
        let minor = multiples(step / ticks::minor_parts(step) as f64);
        Ticks {
            minor: minor.into_iter().map(place).collect(),
            major: values.into_iter().map(place).zip(labels).collect(),
        }
    }

    fn log_ticks(&self, count: usize, zero: bool) -> Ticks {
        let (first, last) = ((self.lo.log10() - 1e-9).ceil() as i32, (self.hi.log10() + 1e-9).floor() as i32);
        let decades = (last - first + 1).max(0) as usize;
        // Few whole decades inside the range need the 2 and the 5 between them to be read.
        let leading: &[f64] = match decades {
            // On a narrow axis of more than a decade the 3 would touch the 2.
            0 | 1 if count < 5 && self.hi > 15.0 * self.lo => &[1.0, 2.0, 5.0],
            0 | 1 => &[1.0, 2.0, 3.0, 5.0],
            2 if count >= 5 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let every = decades.div_ceil(count.max(1)).max(1) as i32;
        let plain = self.lo >= 1e-3 && self.hi <= 1e4 && decades <= 4;
        let mut result = Ticks::default();
        if zero {
            result.major.push((ZERO_AT, "0".into()));
        }
        for exponent in first - 1..=last {
            for digit in 1..10 {
                let value = f64::from(digit) * 10f64.powi(exponent);
                let inside = value >= self.lo * (1.0 - 1e-9) && value <= self.hi * (1.0 + 1e-9);
                let Some(place) = self.fraction(value).filter(|_| inside) else { continue };
                if leading.contains(&f64::from(digit)) && exponent.rem_euclid(every) == 0 {
                    let label = match (plain, digit) {
                        (true, _) => number::fixed(value, (-exponent).max(0) as usize),
                        (false, 1) => number::power_of_ten(exponent),
                        (false, _) => format!("{digit}×{}", number::power_of_ten(exponent)),
                    };
                    result.major.push((place, label));
                } else {
                    result.minor.push(place);
                }
            }
        }
        result
    }
}

/// Smallest and largest finite value.
pub(crate) fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .into_iter()
        .filter(|v| v.is_finite())
        .fold(None, |acc, v| Some(acc.map_or((v, v), |(lo, hi): (f64, f64)| (lo.min(v), hi.max(v)))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &PlotAxis, count: usize) -> Vec<String> {
        axis.ticks(count).major.into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn degenerate_ranges_can_be_drawn() {
        for axis in [
            PlotAxis::covering([], 0.1, TickSteps::Time),
            PlotAxis::covering([3.0, 3.0], 0.1, TickSteps::Angle),
            PlotAxis::covering([0.0], 0.1, TickSteps::Decimal),
            PlotAxis::linear(f64::NAN, 4.0, TickSteps::Decimal),
            PlotAxis::linear(-1e308, 1e308, TickSteps::Angle),
            PlotAxis::linear(1e-320, 2e-320, TickSteps::Time),
            PlotAxis::linear(1e9, 1e9 + 1e-3, TickSteps::Time),
            PlotAxis::log_covering([0.0]),
            PlotAxis::log_covering([5.0]),
            PlotAxis::names(vec![]),
        ] {
            assert!(axis.lo < axis.hi && axis.lo.is_finite() && axis.hi.is_finite());
            assert!(axis.ticks(5).major.iter().all(|(f, _)| f.is_finite()));
        }
    }

    #[test]
    fn logarithmic_places_and_labels() {
        let axis = PlotAxis::log_between(1e-6, 1.0);
        assert!((axis.fraction(1e-3).unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(axis.fraction(0.0), None);
        assert_eq!(axis.fraction(-1.0), None);
        assert_eq!(labels(&axis, 8), ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰"]);
        assert_eq!(labels(&axis, 3), ["10⁻⁶", "10⁻³", "10⁰"]);
        assert_eq!(labels(&PlotAxis::log_covering([0.05, 0.5, 3.0]), 4), ["0.1", "1"]);
    }

    #[test]
    fn zero_has_its_place_on_a_logarithmic_axis() {
        let axis = PlotAxis::log_covering([0.0, 0.1, 1.0]);
        let (zero, tenth) = (axis.fraction(0.0).unwrap(), axis.fraction(0.1).unwrap());
        assert!(zero < axis.break_at().unwrap() && axis.break_at().unwrap() < tenth);
        assert_eq!(labels(&axis, 4)[0], "0");
    }

    #[test]
    fn a_given_step_is_kept_where_it_gives_two_ticks() {
        let axis = PlotAxis::linear(0.0, 10.0, TickSteps::Decimal);
        assert_eq!(labels(&axis.clone().stepped(4.0), 9), ["0", "4", "8"]);
        assert_eq!(labels(&axis.clone().stepped(50.0), 2), labels(&axis, 2));
    }

    #[test]
    fn names_run_downwards() {
        let axis = PlotAxis::names(vec!["a".into(), "b".into()]);
        assert!(axis.fraction(0.0) > axis.fraction(1.0));
        assert_eq!(labels(&axis, 1), ["a", "b"]);
    }
}
