//! Axis over the coordinate ranges of plotters, with its ticks: linear, logarithmic, logarithmic with a separate place
//! for zero, or a list of names.

use std::ops::Range;

use plotters::coord::combinators::LogCoord;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::IntoLogRange;

use crate::fonts::text_width;
use crate::lines::wrap;
use crate::number;
pub use crate::tick_rule::TickRule;

/// Share of the length of a logarithmic axis that is kept for zero and the break.
const ZERO_SLOT: f64 = 0.21;
/// Position of zero, as a share of the length of the axis.
const ZERO_AT: f64 = 0.08;
/// Position of the break, as a share of the length of the axis.
const BREAK_AT: f64 = 0.155;
/// Maximum magnitude of the values that determine the ends of an axis; its reciprocal is the minimum on a logarithmic
/// axis.
const MAX_MAGNITUDE: f64 = 1e100;
/// Maximum distance beyond the ends of an axis at which values are drawn, in lengths of the axis. Farther out the
/// integer coordinates would overflow.
const FAR: f64 = 20.0;
/// Maximum number of intervals between the ticks of an axis.
pub(crate) const MAX_TICK_INTERVALS: usize = 10;
/// Maximum length of a label beyond the right end of an axis, in font sizes.
const MARGIN: f64 = 1.3;
/// Minimum distance of names under an axis, in font sizes; that of numbers is 1.
const NAMES_GAP: f64 = 0.25;
/// Maximum number of decades of a logarithmic axis with lines between the decades.
const MAX_TICKED_DECADES: i32 = 6;

#[derive(Debug, Clone, PartialEq)]
enum AxisScale {
    Linear(TickRule),
    Log {
        /// `true` if zero has a separate place before a break.
        zero: bool,
    },
    /// One unit per name, the first at 0.
    Names,
}

/// One axis of a panel: the ends, the scale, and the ticks.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Axis {
    /// Value at the left or lower end.
    lo: f64,
    /// Value at the right or upper end, below `lo` if names run downwards.
    hi: f64,
    scale: AxisScale,
    /// Maximum value with a tick: the range beyond is free for text. Infinite without such a range.
    pub last: f64,
    /// Tick values with their labels.
    pub ticks: Vec<(f64, String)>,
}

impl Axis {
    fn new(lo: f64, hi: f64, scale: AxisScale) -> Self {
        Self { lo, hi, scale, last: f64::INFINITY, ticks: Vec::new() }
    }

    /// Linear axis from `lo` to `hi`; a range that is empty or not finite is widened to one that can be drawn.
    pub(crate) fn linear(lo: f64, hi: f64, tick_rule: TickRule) -> Self {
        let (lo, hi) = match (lo.is_finite(), hi.is_finite()) {
            (true, true) => (lo.min(hi), lo.max(hi)),
            (true, false) => (lo, lo),
            (false, true) => (hi, hi),
            (false, false) => (0.0, 1.0),
        };
        // Beyond the maximum the arithmetic of ticks overflows; below the minimum all values are equal for plotters.
        let (lo, hi) = (lo.clamp(-MAX_MAGNITUDE, MAX_MAGNITUDE), hi.clamp(-MAX_MAGNITUDE, MAX_MAGNITUDE));
        let smallest = (1e-9 * lo.abs().max(hi.abs())).max(1e-15);
        let half = if lo.abs() < smallest { 1.0 } else { 0.05 * lo.abs() };
        let (lo, hi) = if hi - lo > smallest { (lo, hi) } else { (lo - half, hi + half) };
        Self::new(lo, hi, AxisScale::Linear(tick_rule))
    }

    /// Axis over the finite `values`, with a margin of `pad` times their range on either side; 0 to 1 without values.
    pub(crate) fn covering(values: impl IntoIterator<Item = f64>, pad: f64, tick_rule: TickRule) -> Self {
        let (lo, hi) = range(values).unwrap_or((f64::NAN, f64::NAN));
        Self::linear(lo - pad * (hi - lo), hi + pad * (hi - lo), tick_rule)
    }

    /// Logarithmic axis over the positive `values` with a margin, 0.1 to 10 without positive values; a zero among
    /// `values` gets a separate place before a break.
    pub(crate) fn log_covering(values: &[f64]) -> Self {
        let positive = range(values.iter().copied().filter(|v| *v > 0.0));
        let (lo, hi) = positive.unwrap_or((0.1, 10.0));
        let [lo, hi] = [lo, hi].map(|end| end.clamp(MAX_MAGNITUDE.recip(), MAX_MAGNITUDE));
        let widen = 10f64.powf(((hi / lo).log10() * 0.06).max(0.05));
        Self::new(lo / widen, hi * widen, AxisScale::Log { zero: values.contains(&0.0) })
    }

    /// Axis of row names, one unit each, the first at the top. `edge` is the distance of the ends from the first and
    /// the last name, in rows.
    pub(crate) fn rows(names: &[String], edge: f64) -> Self {
        Self::names(names, [names.len().max(1) as f64 - 1.0 + edge, -edge])
    }

    /// Axis of column names, one unit each, the first at the left.
    pub(crate) fn columns(names: &[String]) -> Self {
        Self::names(names, [-0.5, names.len().max(1) as f64 - 0.5])
    }

    fn names(names: &[String], [lo, hi]: [f64; 2]) -> Self {
        let ticks = names.iter().enumerate().map(|(number, name)| (number as f64, name.clone())).collect();
        Self { ticks, ..Self::new(lo, hi, AxisScale::Names) }
    }

    /// The axis with this share of its length free of data and ticks at the upper end.
    pub(crate) fn with_room(self, share: f64) -> Self {
        let part = share / (1.0 - share);
        let (lo, last) = (self.lo, self.hi);
        let hi = if self.is_logarithmic() { last * (last / lo).powf(part) } else { last + part * (last - lo) };
        if share > 0.0 { Self { hi, last: last.min(self.last), ..self } } else { self }
    }

    /// The axis with other ends, `lo` below `hi`.
    pub(crate) fn between(self, lo: f64, hi: f64) -> Self {
        Self { lo, hi, ..self }
    }

    /// Scale as text, by which a browser converts a place to a value: kind and ends, then the share of a logarithmic
    /// axis that is kept for zero, or the names.
    pub(crate) fn scale_text(&self) -> String {
        let (lo, hi) = (self.lo.min(self.hi), self.lo.max(self.hi));
        match &self.scale {
            AxisScale::Linear(_) => format!("linear|{lo}|{hi}"),
            AxisScale::Log { zero } => format!("log|{lo}|{hi}|{}", if *zero { ZERO_SLOT } else { 0.0 }),
            AxisScale::Names => format!("names|{lo}|{hi}|{}", self.labels().collect::<Vec<_>>().join("|")),
        }
    }

    /// Values at the ends of the axis.
    pub(crate) fn ends(&self) -> (f64, f64) {
        (self.lo, self.hi)
    }

    /// `true` if the axis is logarithmic.
    pub(crate) fn is_logarithmic(&self) -> bool {
        matches!(self.scale, AxisScale::Log { .. })
    }

    /// `true` if the axis is a list of names.
    pub(crate) fn is_names(&self) -> bool {
        self.scale == AxisScale::Names
    }

    /// Place of the break, as a fraction of the axis; `None` without a break.
    pub(crate) fn break_at(&self) -> Option<f64> {
        (self.scale == AxisScale::Log { zero: true }).then_some(BREAK_AT)
    }

    /// `true` if a value can be plotted, also beyond the ends of the axis: it is finite; on a logarithmic scale it is
    /// also positive, or zero if zero has a separate place.
    pub(crate) fn is_plottable(&self, value: f64) -> bool {
        let is_on_scale = match self.scale {
            AxisScale::Log { zero } => value > 0.0 || (zero && value == 0.0),
            _ => true,
        };
        is_on_scale && value.is_finite()
    }

    /// Labels of the ticks.
    pub(crate) fn labels(&self) -> impl Iterator<Item = &str> {
        self.ticks.iter().map(|(_, label)| label.as_str())
    }

    /// Label of the tick at `value`; empty without such a tick.
    pub(crate) fn label(&self, value: f64) -> String {
        self.ticks.iter().find(|(tick, _)| *tick == value).map_or_else(String::new, |(_, label)| label.clone())
    }

    /// Width of the widest label in a font of `font` points, points; 0 without labels.
    pub(crate) fn widest(&self, font: f64) -> f64 {
        self.labels().map(|label| text_width(label, font, false)).fold(0.0, f64::max)
    }

    /// The axis with its labels wrapped to a width; `font` and `width` in points.
    pub(crate) fn wrapped(mut self, font: f64, width: f64) -> Self {
        self.ticks.iter_mut().for_each(|(_, label)| *label = wrap(label, font, false, width).join("\n"));
        self
    }

    /// The axis with about `count` intervals between its ticks, and at least two ticks; names are all shown.
    pub(crate) fn ticked(mut self, count: usize) -> Self {
        match self.scale {
            AxisScale::Linear(tick_rule) => self.ticks = self.linear_ticks(count.max(1), tick_rule),
            AxisScale::Log { zero } => self.ticks = self.log_ticks(count.max(1), zero),
            AxisScale::Names => {}
        }
        self
    }

    /// The axis with as many ticks as there is room for labels, `width` and `font` in points. Names are wrapped if
    /// their words fit.
    pub(crate) fn with_fitting_ticks(self, width: f64, font: f64) -> Self {
        let pitch = width / self.ticks.len().max(1) as f64 - NAMES_GAP * font;
        let has_room = |label: &str| label.split(' ').all(|word| text_width(word, font, false) <= pitch);
        if self.is_names() {
            let is_wrapped = !self.fits(width, font) && self.labels().all(has_room);
            return if is_wrapped { self.wrapped(font, pitch) } else { self };
        }
        let fitting =
            (2..=MAX_TICK_INTERVALS).rev().map(|count| self.clone().ticked(count)).find(|axis| axis.fits(width, font));
        let mut fewest = fitting.unwrap_or_else(|| self.ticked(1));
        if !fewest.fits(width, font) && fewest.ticks.len() > 2 {
            // The first and the last tick suffice to read the scale.
            fewest.ticks.drain(1..fewest.ticks.len() - 1);
        }
        fewest
    }

    /// `true` if the labels under the axis touch neither each other nor the next panel; `width` and `font` in points.
    pub(crate) fn fits(&self, width: f64, font: f64) -> bool {
        let place = |value: f64| f64::from(self.map(&value, (0, 1_000_000))) * 1e-6 * width;
        let half = |label: &str| text_width(label, font, false) / 2.0;
        let gap = if self.is_names() { NAMES_GAP } else { 1.0 } * font;
        let clear = |pair: &[(f64, String)]| half(&pair[0].1) + half(&pair[1].1) + gap;
        let is_clear = |pair: &[(f64, String)]| (place(pair[1].0) - place(pair[0].0)).abs() >= clear(pair);
        let end = self.ticks.last().map_or(0.0, |(value, label)| place(*value) + half(label));
        self.ticks.windows(2).all(is_clear) && end <= width + MARGIN * font
    }

    fn linear_ticks(&self, count: usize, tick_rule: TickRule) -> Vec<(f64, String)> {
        let (lo, hi) = (self.lo, self.hi.min(self.last));
        let unit = tick_rule.unit(hi - lo);
        // A single label does not determine the scale, so the step shrinks until there are two.
        let mut values = (count + 1..count + 20).map(|max| RangedCoordf64::from(lo / unit..hi / unit).key_points(max));
        let values: Vec<f64> = values.find(|values| values.len() > 1).unwrap_or_default();
        let values: Vec<f64> = values.into_iter().map(|value| unit * value).collect();
        let labels = linear_labels(&values);
        values.into_iter().zip(labels).collect()
    }

    /// Ticks of a logarithmic axis: powers of ten; if these are few, also the digits between them that are needed to
    /// read the scale; equal steps if even these give fewer than two labels.
    fn log_ticks(&self, count: usize, zero: bool) -> Vec<(f64, String)> {
        const LEADING: [&[i32]; 4] = [&[1], &[1, 2, 5], &[1, 2, 3, 5], &[1, 2, 3, 4, 5, 6, 7, 8, 9]];
        let hi = self.hi.min(self.last);
        let (first, last) = ((self.lo.log10() - 1e-9).ceil() as i32, (hi.log10() + 1e-9).floor() as i32);
        let decades = (last - first + 1).max(0) as usize;
        let is_plain = self.lo >= 1e-3 && hi <= 1e6 && decades <= 6;
        let label = |exponent: i32, digit: i32| match (is_plain, digit) {
            (true, _) => number::fixed(f64::from(digit) * 10f64.powi(exponent), (-exponent).max(0) as usize),
            (false, 1) => number::power_of_ten(exponent),
            (false, _) => format!("{digit}×{}", number::power_of_ten(exponent)),
        };
        let is_inside = |value: f64| value >= self.lo * (1.0 - 1e-9) && value <= hi * (1.0 + 1e-9);
        let ticks = |(every, leading): (i32, &[i32])| -> Vec<(f64, String)> {
            let shown = (first - 1..=last).filter(|exponent| exponent.rem_euclid(every) == 0);
            let digits = shown.flat_map(|exponent| leading.iter().map(move |digit| (exponent, *digit)));
            let ticks = digits.map(|(power, digit)| (f64::from(digit) * 10f64.powi(power), label(power, digit)));
            ticks.filter(|(value, _)| is_inside(*value)).collect()
        };
        let every = decades.div_ceil(count).max(1) as i32;
        let fewest = usize::from(decades < 2 || decades == 2 && count >= 5);
        let sparse = (1..=every).rev().map(|every| (every, LEADING[fewest]));
        let dense = LEADING.iter().skip(fewest + 1).map(|leading| (1, *leading));
        let marked = sparse.chain(dense).map(ticks).find(|ticks| ticks.len() > 1);
        let marked = marked.unwrap_or_else(|| self.linear_ticks(count, TickRule::Decimal));
        zero.then(|| (0.0, String::from("0"))).into_iter().chain(marked).collect()
    }
}

/// First and last pixel of an axis.
type PixelRange = (i32, i32);

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    /// Pixel of a value, with the ends of the axis at the pixels `limit`; a value that is not on a logarithmic scale is
    /// far beyond the lower end.
    fn map(&self, value: &f64, limit: PixelRange) -> i32 {
        let (start, end) = limit;
        let AxisScale::Log { zero } = self.scale else {
            let ends = [-FAR, 1.0 + FAR].map(|share| self.lo + share * (self.hi - self.lo));
            let value = value.clamp(ends[0].min(ends[1]), ends[0].max(ends[1]));
            return RangedCoordf64::from(self.lo..self.hi).map(&value, limit);
        };
        let part = |share: f64| start + (share * f64::from(end - start)).round() as i32;
        if zero && *value == 0.0 {
            return part(ZERO_AT);
        }
        let [least, most] = [-FAR, 1.0 + FAR].map(|share| self.lo * (self.hi / self.lo).powf(share));
        let value = value.max(least.max(f64::MIN_POSITIVE)).min(most);
        LogCoord::from((self.lo..self.hi).log_scale()).map(&value, (part(if zero { ZERO_SLOT } else { 0.0 }), end))
    }

    /// Key points: the ticks; for light lines on a logarithmic axis of few decades, 1 to 9 times each power of ten.
    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if !hint.weight().allow_light_points() {
            return self.ticks.iter().map(|(value, _)| *value).collect();
        }
        if !self.is_logarithmic() {
            return Vec::new();
        }
        let (first, last) = (self.lo.log10().floor() as i32, self.hi.log10().ceil() as i32);
        let exponents = (first..last).filter(|_| last - first <= MAX_TICKED_DECADES);
        let digits = exponents.flat_map(|power| (1..10).map(move |digit| f64::from(digit) * 10f64.powi(power)));
        digits.filter(|value| *value > self.lo && *value < self.hi).collect()
    }

    fn range(&self) -> Range<f64> {
        self.lo..self.hi
    }
}

/// Labels of equidistant ticks, all with the decimals that their distance requires; very small or large values have a
/// power of ten.
fn linear_labels(ticks: &[f64]) -> Vec<String> {
    let step = if let [first, second, ..] = ticks { second - first } else { 0.0 };
    let largest = ticks.iter().fold(0.0_f64, |most, tick| most.max(tick.abs()));
    let is_whole = |decimals: &i32| {
        let scaled = step * 10f64.powi(*decimals);
        (scaled - scaled.round()).abs() < 1e-6 * scaled.max(1.0)
    };
    let decimals = (0..9).find(is_whole).unwrap_or(9) as usize;
    // Enough digits to distinguish neighbouring ticks.
    let digits = (largest / step).log10().clamp(1.0, 12.0).ceil() as usize + 1;
    let label = |tick: &f64| match (step < 1e-5 || largest >= 1e6, tick.abs() < step / 2.0) {
        (true, true) => String::from("0"),
        (true, false) => number::significant(*tick, digits.max(3)),
        (false, _) => number::fixed(*tick, decimals),
    };
    ticks.iter().map(label).collect()
}

/// Minimum and maximum of the finite values; `None` if no value is finite.
pub(crate) fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|v| v.is_finite()).map(|v| (v, v));
    finite.reduce(|(lo, hi), (v, _)| (lo.min(v), hi.max(v)))
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
            Axis::covering([], 0.1, TickRule::Time),
            Axis::covering([3.0, 3.0], 0.1, TickRule::Angle),
            Axis::covering([0.0], 0.1, TickRule::Decimal),
            Axis::linear(f64::NAN, 4.0, TickRule::Decimal),
            Axis::linear(-1e308, 1e308, TickRule::Angle),
            Axis::linear(1e-320, 2e-320, TickRule::Time),
            Axis::linear(1e9, 1e9 + 1e-3, TickRule::Time),
            Axis::linear(1e-12, 3e-12, TickRule::Decimal),
            Axis::log_covering(&[0.0]),
            Axis::log_covering(&[5.0]),
            Axis::rows(&[], 0.6),
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

    /// Ranges over twenty decades: at most the allowed number of ticks, at least two, inside the range, with different
    /// labels.
    #[test]
    fn ticks_fit_every_range() {
        for (lo, hi) in [(2.05, 4.95), (5.1, 9.9), (0.015, 0.045), (3.1, 3.9), (1e-9, 1e9), (0.5, 2e3)] {
            for count in [1, 2, 3, 5, 8] {
                let axis = Axis::log_covering(&[lo, hi]).between(lo, hi).ticked(count);
                assert!(axis.ticks.len() > 1 && axis.ticks.len() < 12, "{count}: {:?}", axis.ticks);
            }
        }
        let large = labels(&Axis::linear(1.7e9, 1.7e9 + 100.0, TickRule::Decimal), 4);
        assert!(large[0] != large[1], "{large:?}");
        for tick_rule in [TickRule::Decimal, TickRule::Time, TickRule::Angle] {
            for (exponent, leading) in (-10..10).flat_map(|e| [1.0, 1.3, 2.7, 4.9, 9.99].map(|leading| (e, leading))) {
                for count in [3_usize, 5, 8] {
                    let span = leading * 10f64.powi(exponent);
                    let axis = Axis::linear(-0.37 * span, 0.63 * span, tick_rule).ticked(count);
                    let case = format!("{tick_rule:?}, span {span}, {count}: {:?}", axis.ticks);
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
        assert_eq!(labels(&Axis::linear(0.0, 240.0, TickRule::Time), 8)[1], "30");
        assert_eq!(labels(&Axis::linear(0.0, 120.0, TickRule::Angle), 6)[1], "30");
        assert_eq!(labels(&Axis::linear(0.0, 540.0, TickRule::Angle), 8)[1], "90");
        assert_eq!(labels(&Axis::linear(0.0, 5.0, TickRule::Decimal).with_room(0.4), 9).last().unwrap(), "5");
        assert_eq!(labels(&Axis::linear(-2.5, 2.6, TickRule::Decimal), 6), ["−2", "−1", "0", "1", "2"]);
        assert_eq!(labels(&Axis::linear(0.0, 3e-7, TickRule::Decimal), 3)[..2], ["0", "1.00×10⁻⁷"]);
    }

    #[test]
    fn logarithmic_places_and_labels() {
        let axis = Axis::log_covering(&[1e-6, 1.0]).between(1e-6, 1.0);
        assert!((place(&axis, 1e-3) - 0.5).abs() < 1e-4);
        assert!(!axis.is_plottable(0.0) && place(&axis, -1.0) < -10.0);
        assert_eq!(labels(&axis, 8), ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰"]);
        assert_eq!(labels(&axis, 3), ["10⁻⁶", "10⁻³", "10⁰"]);
        assert_eq!(labels(&Axis::log_covering(&[0.05, 0.5, 3.0]), 4), ["0.1", "1"]);
        assert_eq!(labels(&Axis::log_covering(&[0.5, 1.5e5]), 8), ["1", "10", "100", "1000", "10000", "100000"]);
        // The room for numbers has no ticks.
        assert_eq!(labels(&Axis::log_covering(&[1.0, 15.0]).with_room(0.5), 8), ["1", "2", "5", "10"]);
    }

    #[test]
    fn zero_has_its_place_on_a_logarithmic_axis() {
        let axis = Axis::log_covering(&[0.0, 0.1, 1.0]);
        let (zero, tenth) = (place(&axis, 0.0), place(&axis, 0.1));
        assert!(zero > 0.0 && zero < axis.break_at().unwrap() && axis.break_at().unwrap() < tenth);
        assert_eq!(labels(&axis, 4)[0], "0");
    }

    #[test]
    fn names_run_downwards() {
        let axis = Axis::rows(&["a".into(), "b".into()], 0.6);
        assert!(place(&axis, 0.0) > place(&axis, 1.0));
        assert_eq!(labels(&axis, 1), ["a", "b"]);
    }
}
