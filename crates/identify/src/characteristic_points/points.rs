//! Characteristic points of a zig-zag record: instants with r = 0 (heading extrema and a start at rest) and instants at
//! which the heading passes the base course, both as the zig-zag analysis of [`trial::zigzag`] finds them, with the
//! rudder integral up to each point and the base course.

use std::ops::Range;

use estimation::column::extremes;
use trial::zigzag::points;

use crate::samples::Samples;
use crate::savitzky_golay::local_polynomial;

/// Maximum rudder amidships, as a share of the maximum rudder angle, and maximum distance of the mean heading on the
/// approach from a given base course, as a share of half the range of the headings. In a zig-zag the rudder passes
/// amidships only near the reversals, where the heading is far off course: both conditions together identify the
/// approach.
const APPROACH_SHARE: f64 = 0.2;

/// Maximum number of window moves; an extremum that has not settled then keeps its first position.
const MAX_WINDOW_MOVES: usize = 10;

/// Minimum number of sampling intervals in half a window.
const MIN_INTERVALS: f64 = 3.0;

/// Origin of the base course.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BaseCourseOrigin {
    /// Given in the settings.
    Given,
    /// Mean heading before the first execute.
    Approach,
    /// No approach, and 0 is in the middle half of the range of the headings: heading 0 is used.
    Zero,
    /// No approach, and 0 is outside that half: the middle of the range is used.
    Middle,
}

/// Characteristic point of a record; the heading is relative to the base course.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CharacteristicPoint {
    /// Time since the first observed row, s.
    pub time: f64,
    /// Heading, rad.
    pub heading: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate: f64,
    /// ∫δ since the first row, rad s.
    pub rudder_integral: f64,
}

/// Characteristic points of one trial.
#[derive(Debug, Clone)]
pub struct TrialPoints {
    /// Points with r = 0 in order of time; a start at rest is the first point.
    pub zero_rate_points: Vec<CharacteristicPoint>,
    /// Passages of the base course in order of time.
    pub crossings: Vec<CharacteristicPoint>,
    /// `true` if the record starts at rest, so that the first of `zero_rate_points` is the execute and no extremum.
    pub starts_at_rest: bool,
    /// Base course, rad.
    pub base_course: f64,
    /// Origin of the base course.
    pub base_course_origin: BaseCourseOrigin,
    /// Half width of the local fits, s.
    pub fit_half_width: f64,
}

impl TrialPoints {
    /// Heading extrema, without a start at rest.
    pub fn extrema(&self) -> &[CharacteristicPoint] {
        &self.zero_rate_points[usize::from(self.starts_at_rest)..]
    }

    /// Leaves a start at rest out of the instants with r = 0.
    pub fn remove_start_at_rest(&mut self) {
        if std::mem::take(&mut self.starts_at_rest) {
            self.zero_rate_points.remove(0);
        }
    }

    /// Characteristic points of a record. `base_course` (rad) and `fit_half_width` (s) are estimated from the record if
    /// they are `None`, the half width as the share `width_share` of half a period, but at least three sampling
    /// intervals.
    pub fn find(samples: &Samples, base_course: Option<f64>, fit_half_width: Option<f64>, width_share: f64) -> Self {
        let time = &samples.time;
        let (lo, hi) = extremes(&samples.heading);
        let approach = approach(samples, base_course, [lo, hi]);
        let mean = |rows: Range<usize>| samples.heading[rows.clone()].iter().sum::<f64>() / rows.len() as f64;
        let (base_course, base_course_origin) = match (base_course, &approach) {
            (Some(base_course), _) => (base_course, BaseCourseOrigin::Given),
            (None, Some(rows)) => (mean(rows.clone()), BaseCourseOrigin::Approach),
            // A zero between the quarter points of the headings may be the base course.
            (None, None) if (lo + hi).abs() < 0.5 * (hi - lo) => (0.0, BaseCourseOrigin::Zero),
            (None, None) => (0.5 * (lo + hi), BaseCourseOrigin::Middle),
        };
        let off_course: Vec<f64> = samples.heading.iter().map(|heading| heading - base_course).collect();
        let interval = time[time.len() - 1] / (time.len() - 1) as f64;
        let fit_half_width = fit_half_width
            .unwrap_or_else(|| (width_share * half_period(time, &off_course)).max(MIN_INTERVALS * interval));
        let point = |time, heading, rate| {
            let rudder_integral = rudder_integral(samples, time);
            CharacteristicPoint { time, heading, yaw_rate: rate, rudder_integral }
        };
        let mut zero_rate_points: Vec<CharacteristicPoint> = points::extrema(time, &off_course, fit_half_width)
            .into_iter()
            .map(|[at, heading]| {
                let (at, heading) = centred(time, &off_course, fit_half_width, at).unwrap_or((at, heading));
                point(at, heading, 0.0)
            })
            .collect();
        let first_extremum = zero_rate_points.first().map_or(f64::INFINITY, |point| point.time);
        if let Some(rows) = &approach {
            let last = rows.end - 1;
            let recent = rows.clone().filter(|&k| time[k] >= time[last] - 2.0 * fit_half_width);
            let heading = mean(recent.min().unwrap_or(last)..rows.end) - base_course;
            zero_rate_points.insert(0, point(time[last], heading, 0.0));
        }
        // A window about a passage is not centred on a row: half an interval more gives it as many rows as a centred
        // window.
        let crossings = points::zero_crossings(time, &off_course, fit_half_width + 0.5 * interval)
            .into_iter()
            .map(|[time, yaw_rate]| point(time, 0.0, yaw_rate))
            // Noise on the approach crosses the base course too.
            .filter(|crossing| approach.is_none() || crossing.time > first_extremum)
            .collect();
        Self {
            zero_rate_points,
            crossings,
            starts_at_rest: approach.is_some(),
            base_course,
            base_course_origin,
            fit_half_width,
        }
    }
}

/// Rows before the first execute, with the rudder amidships and the heading on course; `None` if the record begins in
/// the manoeuvre.
fn approach(samples: &Samples, base: Option<f64>, [lo, hi]: [f64; 2]) -> Option<Range<usize>> {
    let largest = samples.rudder.iter().fold(0.0_f64, |largest, delta| largest.max(delta.abs()));
    let end = samples.rudder.iter().position(|delta| delta.abs() > APPROACH_SHARE * largest)?;
    let course = samples.heading[..end].iter().sum::<f64>() / end as f64;
    // A record that starts in the middle of the manoeuvre starts near one end of its headings.
    let off = (course - base.unwrap_or(0.5 * (lo + hi))).abs();
    let limit = if base.is_some() { APPROACH_SHARE } else { 0.5 } * 0.5 * (hi - lo);
    (end > 0 && off < limit).then_some(0..end)
}

/// Half period of the zig-zag, s: the mean time between departures from the base course after the first; the duration
/// of the record if there are fewer than three.
fn half_period(time: &[f64], off_course: &[f64]) -> f64 {
    let departures = points::departure_times(time, off_course);
    match departures[..] {
        // A record that starts in a swing departs before its first row.
        [_, first, .., last] => (last - first) / (departures.len() - 2) as f64,
        _ => time[time.len() - 1],
    }
}

/// Vertex (s, rad) of the parabola through the rows within `half_width` of the vertex.
///
/// The window of `start` is centred on the extreme reading, which noise selects, so that errors of one sign prevail
/// in it. Moving the window to the vertex of its parabola until it stays there removes this bias. `None` if the window
/// leaves the neighbourhood of the start or does not settle, or if the parabola bends away from the base course.
fn centred(time: &[f64], heading: &[f64], half_width: f64, start: f64) -> Option<(f64, f64)> {
    let mut vertex = start;
    for _ in 0..MAX_WINDOW_MOVES {
        // The window is centred on a row, so that it does not lose one side of an even record.
        let next = time.partition_point(|t| *t < vertex).clamp(1, time.len() - 1);
        let centre = if vertex - time[next - 1] < time[next] - vertex { time[next - 1] } else { time[next] };
        let reach = half_width * (1.0 + 1e-9);
        let rows = time.partition_point(|t| *t < centre - reach)..time.partition_point(|t| *t <= centre + reach);
        let [value, slope, curvature, ..] = local_polynomial(&time[rows.clone()], &heading[rows], centre, 2)?;
        let shift = -slope / (2.0 * curvature);
        if value * curvature >= 0.0 || (centre + shift - start).abs() > 2.0 * half_width {
            return None;
        }
        if (centre + shift - vertex).abs() < 1e-6 * half_width {
            return Some((centre + shift, value + 0.5 * slope * shift));
        }
        vertex = centre + shift;
    }
    None
}

/// Rudder integral ∫δ, rad s, at a time between rows: the parabola with the rudder at the row before and the exact
/// integral at both rows.
pub fn rudder_integral(samples: &Samples, time: f64) -> f64 {
    let next = samples.time.partition_point(|t| *t <= time).clamp(1, samples.len() - 1);
    let (k, h) = (next - 1, samples.time[next] - samples.time[next - 1]);
    let u = time - samples.time[k];
    let curvature = samples.rudder_integral[next] - samples.rudder_integral[k] - samples.rudder[k] * h;
    samples.rudder_integral[k] + samples.rudder[k] * u + curvature * (u / h) * (u / h)
}
