//! An axis over the coordinate ranges of plotters: linear, logarithmic, logarithmic with a separate place for zero, and
//! a list of names; with its ticks at numbers that a reader counts in.

use std::ops::Range;

use plotters::coord::combinators::LogCoord;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::IntoLogRange;

use crate::fonts::text_width;
use crate::lines::wrap;
use crate::number;

/// Share of a logarithmic axis that belongs to zero and the break.
const ZERO_SLOT: f64 = 0.21;
/// Where on the axis zero stands.
const ZERO_AT: f64 = 0.08;
/// Where the break is drawn.
const BREAK_AT: f64 = 0.155;

/// Largest magnitude on a linear axis.
const LARGEST: f64 = 1e100;
/// Lengths of the axis beyond its ends where all that lies farther off is drawn.
const FAR: f64 = 20.0;
/// Largest number of ticks that an axis asks for.
const MAX_TICKS: usize = 10;

/// Steps of the ticks of an angle in degrees, from half a degree on.
const DEGREES: [f64; 11] = [1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0, 90.0, 180.0];
/// Steps of the ticks of a time in seconds, from half a second on.
const SECONDS: [f64; 13] = [1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0, 900.0, 1800.0, 3600.0];

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Division {
    /// Equal steps of 1, 2 or 5 times a power of ten.
    #[default]
    Decimal,
    /// Degrees.
    Angle,
    /// Seconds and minutes, without free space at the ends.
    Time,
    /// Equal factors; a zero has a place of its own beyond a break, negative values are left out.
    Factors,
    /// From 0 to 100 %, whatever the data.
    Percent,
}

#[derive(Debug, Clone, PartialEq)]
enum AxisScale {
    Linear(Division),
    Log {
        zero: bool,
    },
    /// One unit a name, the first at 0.
    Names(Vec<String>),
}

/// One axis of a panel: the ends, the scale, and the ticks that are drawn.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Axis {
    /// Value at the left or lower end.
    lo: f64,
    /// Value at the right or upper end, below `lo` where names run downwards.
    hi: f64,
    scale: AxisScale,
    /// Distance of the ticks, where it is not for the axis to choose.
    step: Option<f64>,
    /// The last value with a tick: beyond is room for text.
    last: f64,
    /// Values with their labels.
    ticks: Vec<(f64, String)>,
}

impl Axis {
    fn new(lo: f64, hi: f64, scale: AxisScale) -> Self {
        Self { lo, hi, scale, step: None, last: f64::INFINITY, ticks: Vec::new() }
    }

    /// From `lo` to `hi`; a range that is empty or not finite is widened to something that can be drawn.
    pub(crate) fn linear(lo: f64, hi: f64, division: Division) -> Self {
        let (lo, hi) = match (lo.is_finite(), hi.is_finite()) {
            (true, true) => (lo.min(hi), lo.max(hi)),
            (true, false) => (lo, lo),
            (false, true) => (hi, hi),
            (false, false) => (0.0, 1.0),
        };
        // Beyond this the arithmetic of ticks overflows; nothing a ship does comes near.
        let (lo, hi) = (lo.clamp(-LARGEST, LARGEST), hi.clamp(-LARGEST, LARGEST));
        // Below this all values are one to the ticks of plotters.
        let smallest = (1e-9 * lo.abs().max(hi.abs())).max(1e-15);
        let (lo, hi) = if hi - lo > smallest {
            (lo, hi)
        } else {
            let half = if lo.abs() < smallest { 1.0 } else { 0.05 * lo.abs() };
            (lo - half, hi + half)
        };
        Self::new(lo, hi, AxisScale::Linear(division))
    }

    /// Covers the finite `values` with a margin of `pad` of their range on either side.
    pub(crate) fn covering(values: impl IntoIterator<Item = f64>, pad: f64, division: Division) -> Self {
        match range(values) {
            Some((lo, hi)) => Self::linear(lo - pad * (hi - lo), hi + pad * (hi - lo), division),
            None => Self::linear(f64::NAN, f64::NAN, division),
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

    /// Names of rows, one unit each, the first at the top; the axis ends at the edges of the rows.
    pub(crate) fn rows(names: Vec<String>, edge: f64) -> Self {
        Self::new(names.len().max(1) as f64 - 1.0 + edge, -edge, AxisScale::Names(names))
    }

    /// Names of columns, one unit each, the first at the left.
    pub(crate) fn columns(names: Vec<String>) -> Self {
        Self::new(-0.5, names.len().max(1) as f64 - 0.5, AxisScale::Names(names))
    }

    /// The same axis with ticks at the multiples of `step`, as long as there are two.
    pub(crate) fn stepped(self, step: f64) -> Self {
        Self { step: Some(step), ..self }
    }

    /// The same axis without ticks beyond a value above its lower end.
    pub(crate) fn labelled_until(self, last: f64) -> Self {
        Self { last, ..self }
    }

    /// The same axis from `lo` to `hi`, which are in order.
    pub(crate) fn between(self, lo: f64, hi: f64) -> Self {
        Self { lo, hi, ..self }
    }

    /// Kind, ends and where the scale begins as a fraction, or the names: what a value is found with from its place.
    pub(crate) fn described(&self) -> String {
        let (lo, hi) = (self.lo.min(self.hi), self.lo.max(self.hi));
        match &self.scale {
            AxisScale::Linear(_) => format!("linear|{lo}|{hi}"),
            AxisScale::Log { zero } => format!("log|{lo}|{hi}|{}", if *zero { ZERO_SLOT } else { 0.0 }),
            AxisScale::Names(names) => format!("names|{lo}|{hi}|{}", names.join("|")),
        }
    }

    /// Values at its ends.
    pub(crate) fn ends(&self) -> (f64, f64) {
        (self.lo, self.hi)
    }

    /// A value that has a place on it.
    pub(crate) fn middle(&self) -> f64 {
        if self.is_logarithmic() { self.lo } else { 0.5 * (self.lo + self.hi) }
    }

    /// How much one step of `fraction` of the axis is worth on a linear scale.
    pub(crate) fn worth(&self, fraction: f64) -> f64 {
        fraction * (self.hi - self.lo)
    }

    /// Whether it has numbers and no names.
    pub(crate) fn is_numeric(&self) -> bool {
        !self.is_names()
    }

    /// Whether it is logarithmic.
    pub(crate) fn is_logarithmic(&self) -> bool {
        matches!(self.scale, AxisScale::Log { .. })
    }

    /// Whether it is a list of names.
    pub(crate) fn is_names(&self) -> bool {
        matches!(self.scale, AxisScale::Names(_))
    }

    /// Where the axis is broken, as a fraction.
    pub(crate) fn break_at(&self) -> Option<f64> {
        matches!(self.scale, AxisScale::Log { zero: true }).then_some(BREAK_AT)
    }

    /// Whether a value has a place on the axis or beyond its ends: it is finite, and positive on a logarithmic scale.
    pub(crate) fn has_place(&self, value: f64) -> bool {
        let is_on_scale = match self.scale {
            AxisScale::Log { zero } => value > 0.0 || (zero && value == 0.0),
            _ => true,
        };
        is_on_scale && value.is_finite()
    }

    /// Its ticks: values with their labels.
    pub(crate) fn ticks(&self) -> &[(f64, String)] {
        &self.ticks
    }

    /// The same axis with labels broken into lines of a width, points.
    pub(crate) fn wrapped(mut self, font: f64, width: f64) -> Self {
        self.ticks.iter_mut().for_each(|(_, label)| *label = wrap(label, font, false, width).join("\n"));
        self
    }

    /// The labels of its ticks.
    pub(crate) fn labels(&self) -> impl Iterator<Item = &str> {
        self.ticks.iter().map(|(_, label)| label.as_str())
    }

    /// The label of a tick.
    pub(crate) fn label(&self, value: f64) -> String {
        self.ticks.iter().find(|(tick, _)| *tick == value).map_or_else(String::new, |(_, label)| label.clone())
    }

    /// Distance of the ticks.
    pub(crate) fn pitch(&self) -> Option<f64> {
        Some(self.ticks.get(1)?.0 - self.ticks.first()?.0)
    }

    /// The same axis with about as many ticks as wanted, no more; names are always all shown.
    pub(crate) fn ticked(mut self, count: usize) -> Self {
        self.ticks = match &self.scale {
            AxisScale::Linear(division) => self.linear_ticks(count, *division),
            AxisScale::Log { zero } => self.log_ticks(count, *zero),
            AxisScale::Names(names) => names.iter().enumerate().map(|(i, name)| (i as f64, name.clone())).collect(),
        };
        self
    }

    /// The same axis with as many ticks as their labels leave room for, `width` and `font` in points.
    pub(crate) fn fitted(self, width: f64, font: f64) -> Self {
        let fitting = (2..=MAX_TICKS).rev().map(|count| self.clone().ticked(count)).find(|own| own.fits(width, font));
        fitting.unwrap_or_else(|| self.ticked(1))
    }

    /// Whether the labels under an axis of this width stand clear of each other.
    pub(crate) fn fits(&self, width: f64, font: f64) -> bool {
        let place = |value: f64| f64::from(self.map(&value, (0, 1_000_000))) * 1e-6 * width;
        let half = |label: &str| text_width(label, font, false) / 2.0;
        let labelled: Vec<(f64, f64)> = self.ticks.iter().map(|(value, label)| (place(*value), half(label))).collect();
        labelled.windows(2).all(|pair| (pair[1].0 - pair[0].0).abs() >= pair[0].1 + pair[1].1 + font)
    }

    fn linear_ticks(&self, count: usize, division: Division) -> Vec<(f64, String)> {
        let (lo, hi) = (self.lo, self.hi.min(self.last));
        let listed: &[f64] = match division {
            Division::Angle => &DEGREES,
            Division::Time => &SECONDS,
            _ => &[],
        };
        let values = |count: usize| {
            let wanted = (hi - lo) / count as f64;
            let step = listed.iter().copied().find(|step| *step >= wanted * (1.0 - 1e-9)).filter(|_| wanted > 0.5);
            step.map_or_else(|| RangedCoordf64::from(lo..hi).key_points(count + 1), |step| multiples(lo, hi, step))
        };
        // One interval more can still give no more ticks than allowed, because the ends of the axis are not round. A
        // single label says nothing about the scale, so the step shrinks until there are two.
        let count = count.max(1);
        let given = self.step.map(|step| multiples(lo, hi, step));
        let values = given
            .into_iter()
            .chain(std::iter::once(values(count + 1)).filter(|values| values.len() <= count + 1))
            .chain((count..count + 20).map(values))
            .find(|values| values.len() > 1)
            .unwrap_or_default();
        let labels = linear_labels(&values);
        values.into_iter().zip(labels).collect()
    }

    fn log_ticks(&self, count: usize, zero: bool) -> Vec<(f64, String)> {
        let (first, last) = ((self.lo.log10() - 1e-9).ceil() as i32, (self.hi.log10() + 1e-9).floor() as i32);
        let decades = (last - first + 1).max(0) as usize;
        // Few whole decades inside the range need the 2 and the 5 between them to be read.
        let leading: &[i32] = match decades {
            // On a narrow axis of more than a decade the 3 would touch the 2.
            0 | 1 if count < 5 && self.hi > 15.0 * self.lo => &[1, 2, 5],
            0 | 1 => &[1, 2, 3, 5],
            2 if count >= 5 => &[1, 2, 5],
            _ => &[1],
        };
        let every = decades.div_ceil(count.max(1)).max(1) as i32;
        let is_plain = self.lo >= 1e-3 && self.hi <= 1e4 && decades <= 4;
        let mut ticks: Vec<(f64, String)> = zero.then(|| (0.0, String::from("0"))).into_iter().collect();
        for exponent in (first - 1..=last).filter(|exponent| exponent.rem_euclid(every) == 0) {
            for digit in leading {
                let value = f64::from(*digit) * 10f64.powi(exponent);
                let label = match (is_plain, digit) {
                    (true, _) => number::fixed(value, (-exponent).max(0) as usize),
                    (false, 1) => number::power_of_ten(exponent),
                    (false, _) => format!("{digit}×{}", number::power_of_ten(exponent)),
                };
                if value >= self.lo * (1.0 - 1e-9) && value <= self.hi * (1.0 + 1e-9) {
                    ticks.push((value, label));
                }
            }
        }
        ticks
    }
}

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    /// Place of a value; one without a place is far beyond the lower end.
    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        // Farther off lines run the same way, and whole numbers would overflow.
        let (least, most) = (-FAR, 1.0 + FAR);
        match self.scale {
            AxisScale::Log { zero } => {
                let slot = if zero { ZERO_SLOT } else { 0.0 };
                let part = |share: f64| start + (share * f64::from(end - start)).round() as i32;
                if zero && *value == 0.0 {
                    return part(ZERO_AT);
                }
                let at = |share: f64| self.lo * (self.hi / self.lo).powf(share);
                let value =
                    if *value > 0.0 { value.clamp(at(least).max(f64::MIN_POSITIVE), at(most)) } else { at(least) };
                LogCoord::from((self.lo..self.hi).log_scale()).map(&value, (part(slot), end))
            }
            _ => {
                let (one, other) = (self.lo + self.worth(least), self.lo + self.worth(most));
                let value = value.clamp(one.min(other), one.max(other));
                RangedCoordf64::from(self.lo..self.hi).map(&value, (start, end))
            }
        }
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // Lines between those of the ticks belong to a logarithmic scale alone.
        match hint.weight().allow_light_points() {
            true if self.is_logarithmic() => self.digits(),
            true => Vec::new(),
            false => self.ticks.iter().map(|(value, _)| *value).collect(),
        }
    }

    fn range(&self) -> Range<f64> {
        self.lo..self.hi
    }
}

impl Axis {
    /// The multiples by 1 to 9 of all powers of ten on a logarithmic axis of few decades.
    fn digits(&self) -> Vec<f64> {
        let (first, last) = (self.lo.log10().floor() as i32, self.hi.log10().ceil() as i32);
        let all = (first..last)
            .filter(|_| last - first <= 6)
            .flat_map(|exponent| (1..10).map(move |digit| f64::from(digit) * 10f64.powi(exponent)));
        all.filter(|value| *value > self.lo && *value < self.hi).collect()
    }
}

/// The multiples of `step` inside `lo..=hi`.
fn multiples(lo: f64, hi: f64, step: f64) -> Vec<f64> {
    // A tick on the end of the axis must not fall victim to rounding.
    let slack = 1e-9 * (hi - lo).abs() / step;
    let (first, last) = ((lo / step - slack).ceil(), (hi / step + slack).floor());
    let count = (last - first + 1.0).clamp(0.0, 1000.0) as usize;
    (0..count).map(|i| (first + i as f64) * step).collect()
}

/// Labels of equidistant ticks, all with the decimals that their distance needs.
fn linear_labels(ticks: &[f64]) -> Vec<String> {
    let [first, second, ..] = ticks else { return ticks.iter().map(|tick| number::significant(*tick, 3)).collect() };
    let step = second - first;
    let largest = ticks.iter().fold(0.0_f64, |most, tick| most.max(tick.abs()));
    if step < 1e-5 || largest >= 1e6 {
        let label = |tick: &f64| if tick.abs() < step / 2.0 { "0".into() } else { number::significant(*tick, 3) };
        return ticks.iter().map(label).collect();
    }
    let is_whole = |decimals: &i32| {
        let scaled = step * 10f64.powi(*decimals);
        (scaled - scaled.round()).abs() < 1e-6 * scaled.max(1.0)
    };
    let decimals = (0..9).find(is_whole).unwrap_or(9) as usize;
    ticks.iter().map(|tick| number::fixed(*tick, decimals)).collect()
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

    fn labels(axis: &Axis, count: usize) -> Vec<String> {
        axis.clone().ticked(count).labels().map(str::to_owned).collect()
    }

    fn place(axis: &Axis, value: f64) -> f64 {
        f64::from(axis.map(&value, (0, 100_000))) / 1e5
    }

    #[test]
    fn degenerate_ranges_can_be_drawn() {
        for axis in [
            Axis::covering([], 0.1, Division::Time),
            Axis::covering([3.0, 3.0], 0.1, Division::Angle),
            Axis::covering([0.0], 0.1, Division::Decimal),
            Axis::linear(f64::NAN, 4.0, Division::Decimal),
            Axis::linear(-1e308, 1e308, Division::Angle),
            Axis::linear(1e-320, 2e-320, Division::Time),
            Axis::linear(1e9, 1e9 + 1e-3, Division::Time),
            Axis::linear(1e-12, 3e-12, Division::Decimal),
            Axis::log_covering([0.0]),
            Axis::log_covering([5.0]),
            Axis::rows(vec![], 0.6),
        ] {
            assert!(axis.lo != axis.hi && axis.lo.is_finite() && axis.hi.is_finite(), "{axis:?}");
            let ticked = axis.ticked(5);
            assert!(ticked.ticks.iter().all(|(value, _)| value.is_finite()), "{ticked:?}");
            for value in [0.0, -1e300, 1e300, 1e-300] {
                let at = ticked.map(&value, (-50_000, 50_000));
                assert!(at.abs() <= 2_200_000, "{value} at {at} of {ticked:?}");
            }
        }
    }

    /// Ranges over twenty decades: never more ticks than allowed, two at least, inside the range, with different labels.
    #[test]
    fn ticks_fit_every_range() {
        for division in [Division::Decimal, Division::Time, Division::Angle] {
            for (exponent, leading) in (-10..10).flat_map(|e| [1.0, 1.3, 2.7, 4.9, 9.99].map(|leading| (e, leading))) {
                for count in [3_usize, 5, 8] {
                    let span = leading * 10f64.powi(exponent);
                    let axis = Axis::linear(-0.37 * span, 0.63 * span, division).ticked(count);
                    let case = format!("{division:?}, span {span}, {count}: {:?}", axis.ticks);
                    assert!((2..=count + 1).contains(&axis.ticks.len()), "{case}");
                    let is_inside = |value: f64| value >= axis.lo - 1e-9 * span && value <= axis.hi + 1e-9 * span;
                    assert!(axis.ticks.iter().all(|(value, _)| is_inside(*value)), "{case}");
                    let mut labels: Vec<&str> = axis.labels().collect();
                    labels.dedup();
                    assert_eq!(labels.len(), axis.ticks.len(), "{case}");
                }
            }
        }
    }

    #[test]
    fn ticks_are_numbers_that_a_reader_counts_in() {
        assert_eq!(labels(&Axis::linear(0.0, 240.0, Division::Time), 8)[1], "30");
        assert_eq!(labels(&Axis::linear(0.0, 120.0, Division::Angle), 6)[1], "20");
        assert_eq!(labels(&Axis::linear(-2.5, 2.6, Division::Decimal), 6), ["−2", "−1", "0", "1", "2"]);
        assert_eq!(labels(&Axis::linear(0.0, 3e-7, Division::Decimal), 3)[..2], ["0", "1.00×10⁻⁷"]);
    }

    #[test]
    fn logarithmic_places_and_labels() {
        let axis = Axis::log_covering([1e-6, 1.0]).between(1e-6, 1.0);
        assert!((place(&axis, 1e-3) - 0.5).abs() < 1e-4);
        assert!(!axis.has_place(0.0) && !axis.has_place(-1.0) && place(&axis, -1.0) < -10.0);
        assert_eq!(labels(&axis, 8), ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰"]);
        assert_eq!(labels(&axis, 3), ["10⁻⁶", "10⁻³", "10⁰"]);
        assert_eq!(labels(&Axis::log_covering([0.05, 0.5, 3.0]), 4), ["0.1", "1"]);
    }

    #[test]
    fn zero_has_its_place_on_a_logarithmic_axis() {
        let axis = Axis::log_covering([0.0, 0.1, 1.0]);
        let (zero, tenth) = (place(&axis, 0.0), place(&axis, 0.1));
        assert!(zero > 0.0 && zero < axis.break_at().unwrap() && axis.break_at().unwrap() < tenth);
        assert_eq!(labels(&axis, 4)[0], "0");
    }

    #[test]
    fn a_given_step_is_kept_where_it_gives_two_ticks() {
        let axis = Axis::linear(0.0, 10.0, Division::Decimal);
        assert_eq!(labels(&axis.clone().stepped(4.0), 9), ["0", "4", "8"]);
        assert_eq!(labels(&axis.clone().stepped(50.0), 2), labels(&axis, 2));
        assert_eq!(labels(&axis.labelled_until(5.0), 9).last().map(String::as_str), Some("5"));
    }

    #[test]
    fn names_run_downwards() {
        let axis = Axis::rows(vec!["a".into(), "b".into()], 0.6);
        assert!(place(&axis, 0.0) > place(&axis, 1.0));
        assert_eq!(labels(&axis, 1), ["a", "b"]);
    }
}
