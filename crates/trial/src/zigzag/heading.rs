//! Smoothed heading of a record: noise, width of the local fits, and values, slopes, peaks and crossings with their
//! uncertainty.
//!
//! Source of local polynomial fits and their optimal width: Fan & Gijbels (1996), Local Polynomial Modelling and Its
//! Applications.

use super::local::Cubic;
use crate::plausibility::range;
use document::Quantity;
use estimation::statistics::median;

/// Half-width of the window of the noise estimate, periods of the manoeuvre.
const NOISE_WINDOW: f64 = 0.02;

/// Maximum half-width of a local fit, periods: in a wider window a cubic does not follow a swing.
const MAX_HALF_WIDTH: f64 = 0.1;

/// Ratio of the width of a fit for slopes to that for values. Slopes, and with them the times of peaks, are noisier
/// (variance h⁻³ against h⁻¹), so their optimal window is wider.
const SLOPE_WIDENING: f64 = 1.5;

/// Factors by which a local fit is widened until it contains sufficient headings.
const WIDENINGS: [f64; 5] = [1.0, 1.5, 2.25, 3.4, 5.1];

/// Maximum number of local fits for a single characteristic of a record.
const MAX_FITS: usize = 2000;

/// Robust standard deviation of the white noise of a sampled signal, in the unit of the signal.
///
/// Every value is compared with the cubic fitted to the samples within `half_width` (s) of it; the result is 1.4826
/// times the median absolute residual, each residual divided by √(1 − leverage). The result is robust against jumps and
/// outliers in less than a few tenths of the rows. NaN values are skipped. `None` if fewer than 8 windows contain 6
/// values or more.
pub fn noise_sd(time: &[f64], value: &[f64], half_width: f64) -> Option<f64> {
    // A median over a part of the rows is as good; the time for all rows of a densely sampled record grows as their
    // square.
    let every = time.len().div_ceil(MAX_FITS);
    let mut residuals: Vec<f64> = time
        .iter()
        .zip(value)
        .step_by(every)
        .filter(|(_, y)| y.is_finite())
        .filter_map(|(&t, &y)| {
            let fit = Cubic::fit(time, value, t, half_width).filter(|fit| fit.samples >= 6)?;
            let leverage = fit.value_gain(t).powi(2);
            (leverage < 0.99).then(|| (y - fit.value(t)).abs() / (1.0 - leverage).sqrt())
        })
        .collect();
    if residuals.len() < 8 {
        return None;
    }
    median(&mut residuals).map(|deviation| 1.4826 * deviation)
}

/// Observed headings of a record, relative to the first heading, so that a large heading does not cost digits.
#[derive(Debug, Clone)]
pub(super) struct Heading {
    /// Times, s.
    pub time: Vec<f64>,
    /// Headings less the first heading, rad.
    pub relative: Vec<f64>,
    /// Heading at a relative heading of zero, rad.
    pub origin: f64,
    /// Standard deviation of the noise, rad; `None` if it is neither declared nor can be estimated.
    pub noise_sd: Option<f64>,
    /// Half-width of local fits for values, s.
    pub half_width: f64,
    /// Maximum step between headings around a peak, s.
    max_step: f64,
}

impl Heading {
    /// Observed headings of a manoeuvre with the given period (s).
    ///
    /// The half-width of the fits balances noise against the bend of the heading at the start or end of a rudder ramp:
    /// h = 0.35 P ((σ/A)² Δt/P)^(1/7), with the period P, the amplitude A and the sampling interval Δt. (The variance
    /// of a local cubic falls as σ²Δt/h, its bias at a jump J of ψ''' grows as J h³/192, and J is about 6 A (2π/P)³ for
    /// ships whose rudder ramp is a tenth of the period.) `None` with fewer than 8 headings.
    pub fn new(time: &[f64], heading: &[f64], period: f64, declared_noise: Option<f64>) -> Option<Self> {
        let (time, mut relative): (Vec<f64>, Vec<f64>) =
            time.iter().zip(heading).filter(|(_, psi)| psi.is_finite()).map(|(&t, &psi)| (t, psi)).unzip();
        if time.len() < 8 {
            return None;
        }
        let origin = relative[0];
        relative.iter_mut().for_each(|psi| *psi -= origin);
        let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let step = median(&mut steps)?;
        let noise = declared_noise.or_else(|| noise_sd(&time, &relative, (NOISE_WINDOW * period).max(3.0 * step)));
        let amplitude = 0.5 * range(&relative);
        let ratio = noise.unwrap_or(0.0) / amplitude.max(f64::MIN_POSITIVE);
        let best = 0.35 * period * (ratio * ratio * step / period).powf(1.0 / 7.0);
        let narrowest = 2.0 * step;
        let half_width = best.clamp(narrowest, narrowest.max(MAX_HALF_WIDTH * period));
        let max_step = (2.0 * half_width).max(4.0 * step);
        Some(Self { time, relative, origin, noise_sd: noise, half_width, max_step })
    }

    /// Half-width of local fits for slopes, s.
    pub fn slope_half_width(&self) -> f64 {
        SLOPE_WIDENING * self.half_width
    }

    /// Maximum half-width of a fit at missing headings, s.
    pub fn widest_half_width(&self) -> f64 {
        WIDENINGS[WIDENINGS.len() - 1] * self.half_width
    }

    /// Local cubic at time `t`; widened if headings are missing, `None` if the gap is longer than the maximum width.
    fn local(&self, t: f64, half_width: f64) -> Option<Cubic> {
        WIDENINGS.iter().find_map(|widening| Cubic::fit(&self.time, &self.relative, t, widening * half_width))
    }

    /// Heading at time `t` relative to the origin, rad; `None` in a long gap.
    pub fn heading_at(&self, t: f64) -> Option<Quantity> {
        Some(self.local(t, self.half_width)?.value_at(t, self.noise_sd))
    }

    /// Yaw rate at time `t`, rad/s; `None` in a long gap.
    pub fn rate_at(&self, t: f64) -> Option<Quantity> {
        Some(self.local(t, self.slope_half_width())?.slope_at(t, self.noise_sd))
    }

    /// Maximum |yaw rate| between two times, rad/s, at the rows whose fit has samples on both sides; `None` without
    /// such rows.
    ///
    /// The maximum of many noisy slopes is biased upwards by about one standard deviation.
    pub fn largest_rate(&self, from: f64, to: f64) -> Option<Quantity> {
        let reach = self.slope_half_width();
        let (start, end) = (self.time[0] + reach, self.time[self.time.len() - 1] - reach);
        let rows = self.rows(from.max(start), to.min(end));
        let every = rows.len().div_ceil(MAX_FITS).max(1);
        rows.step_by(every)
            .filter_map(|row| self.rate_at(self.time[row]))
            .map(|rate| Quantity { value: rate.value.abs(), ..rate })
            .max_by(|a, b| a.value.total_cmp(&b.value))
    }

    /// Time (s) and relative heading (rad) of the peak towards `side` (+1 or −1) between two times.
    ///
    /// `None` if the record does not contain the peak: the heading has its maximum at the end of the span, or nearer to
    /// it than half a fit, or next to a gap longer than a fit.
    pub fn peak(&self, side: f64, from: f64, to: f64) -> Option<(Quantity, Quantity)> {
        let rows = self.rows(from, to);
        let every = rows.len().div_ceil(MAX_FITS).max(1);
        let highest = rows
            .step_by(every)
            .filter_map(|row| Some((row, side * self.local(self.time[row], self.half_width)?.value(self.time[row]))))
            .max_by(|a, b| a.1.total_cmp(&b.1))?
            .0;
        let half_width = self.slope_half_width();
        let mut fit = self.local(self.time[highest], half_width)?;
        // A cubic centred on the peak has no first-order error there; two iterations are sufficient.
        for _ in 0..2 {
            fit = self.local(fit.stationary_point()?, half_width)?;
        }
        let t = fit.stationary_point()?;
        let (end, reach) = (to.min(self.time[self.time.len() - 1]), t + self.half_width);
        let is_seen = side * fit.curvature(t) < 0.0 && t > from && reach <= end && !self.has_a_gap(from, reach);
        is_seen.then(|| (fit.time_of_peak(t, self.noise_sd), fit.value_at(t, self.noise_sd)))
    }

    /// `true` if the headings have a gap between two times, longer than a local fit and the usual steps.
    fn has_a_gap(&self, from: f64, to: f64) -> bool {
        let within = self.rows(from, to);
        let around = within.start.saturating_sub(1)..(within.end + 1).min(self.time.len());
        self.time[around].windows(2).any(|pair| pair[1] - pair[0] > self.max_step)
    }

    /// First time between two times at which the relative heading passes `level` (rad) in the direction `side` (+1
    /// rising, −1 falling); `None` if it does not.
    ///
    /// Standard deviation: error of the heading over the slope.
    pub fn crossing(&self, level: f64, side: f64, from: f64, to: f64) -> Option<Quantity> {
        let row = self.rows(from, to).find(|&row| {
            let t = self.time[row];
            self.local(t, self.half_width).is_some_and(|fit| side * (fit.value(t) - level) >= 0.0)
        })?;
        let mut t = self.time[row];
        for _ in 0..3 {
            t = self.local(t, self.half_width)?.crossing(level)?;
        }
        let fit = self.local(t, self.half_width)?;
        (side * fit.slope(t) > 0.0).then(|| fit.time_of_crossing(t, self.noise_sd))
    }

    /// Rows between two times, both included.
    pub fn rows(&self, from: f64, to: f64) -> std::ops::Range<usize> {
        let first = self.time.partition_point(|&t| t < from);
        first..self.time.partition_point(|&t| t <= to).max(first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Gaussian;
    use approx::assert_relative_eq;

    fn sine(noise: f64) -> (Vec<f64>, Vec<f64>) {
        let time: Vec<f64> = (0..240).map(f64::from).collect();
        let mut gaussian = Gaussian::new(2);
        let value = time.iter().map(|t| (t / 19.0).sin() + noise * gaussian.draw()).collect();
        (time, value)
    }

    #[test]
    fn noise_is_seen_apart_from_the_motion() {
        let (time, value) = sine(0.0);
        assert!(noise_sd(&time, &value, 4.0).expect("enough rows") < 1e-4);
        let (time, mut value) = sine(0.01);
        let quiet = noise_sd(&time, &value, 4.0).expect("enough rows");
        assert_relative_eq!(quiet, 0.01, max_relative = 0.15);
        value[100] += 5.0;
        value[101] += 5.0;
        assert_relative_eq!(noise_sd(&time, &value, 4.0).expect("enough rows"), quiet, max_relative = 0.15);
        assert_eq!(noise_sd(&time[..6], &value[..6], 4.0), None);
    }

    #[test]
    fn peak_and_crossing_of_a_sine() {
        let (time, value) = sine(0.0);
        let heading = Heading::new(&time, &value, 119.4, None).expect("enough rows");
        let (t, psi) = heading.peak(1.0, 5.0, 55.0).expect("peak inside");
        assert_relative_eq!(t.value, 19.0 * std::f64::consts::FRAC_PI_2, max_relative = 1e-4);
        assert_relative_eq!(psi.value, 1.0, max_relative = 1e-5);
        assert!(heading.peak(1.0, 5.0, 30.0).is_none(), "the span ends at the peak");
        let gap: Vec<f64> = (0..240).map(|row| if (28..46).contains(&row) { f64::NAN } else { value[row] }).collect();
        let broken = Heading::new(&time, &gap, 119.4, None).expect("enough rows");
        assert!(broken.peak(1.0, 5.0, 55.0).is_none(), "the peak lies in the gap");
        assert!(broken.peak(-1.0, 60.0, 110.0).is_some(), "the other one does not");
        let t = heading.crossing(0.5, -1.0, 31.0, 80.0).expect("falls through 0.5");
        assert_relative_eq!(t.value, 19.0 * 5.0 * std::f64::consts::PI / 6.0, max_relative = 1e-5);
    }
}
