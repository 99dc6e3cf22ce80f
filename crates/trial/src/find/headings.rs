//! Heading of a log: its value near a time and its change between two times. The caller limits the gaps that are
//! bridged.

use estimation::statistics::median;

/// Maximum number of rows of a median: more rows slow the search without a better median.
const MAX_MEDIAN_ROWS: usize = 64;

/// Times and headings of the rows of a log that have a heading.
#[derive(Debug)]
pub(crate) struct HeadingReadings {
    /// Times, s.
    pub time: Vec<f64>,
    /// Headings, rad.
    pub heading: Vec<f64>,
}

impl HeadingReadings {
    pub fn from_columns(time: &[f64], heading: &[f64]) -> Self {
        let read = time.iter().zip(heading).filter(|(_, psi)| psi.is_finite());
        let (time, heading) = read.map(|(&t, &psi)| (t, psi)).unzip();
        Self { time, heading }
    }

    /// Heading at a time, rad: the median within `half_width` (s) of it, else interpolated between its neighbours if
    /// both are within `reach` (s), else that of the only neighbour within reach. `None` without such a neighbour.
    pub fn heading_near(&self, time: f64, half_width: f64, reach: f64) -> Option<f64> {
        // The window is symmetric: at the end of a record a one-sided median would lag behind a turn.
        let (begin, end) = (*self.time.first()?, *self.time.last()?);
        let half_width = half_width.min(time - begin).min(end - time).max(0.0);
        let first = self.time.partition_point(|&t| t < time - half_width);
        let last = self.time.partition_point(|&t| t <= time + half_width);
        if last > first {
            return thinned_median(&self.heading[first..last]);
        }
        let neighbours = [first.checked_sub(1), Some(first)];
        let [before, after] = neighbours
            .map(|row| row.filter(|&row| (self.time.get(row).copied().unwrap_or(f64::INFINITY) - time).abs() <= reach));
        match (before, after) {
            (Some(a), Some(b)) => {
                let share = (time - self.time[a]) / (self.time[b] - self.time[a]);
                Some(self.heading[a] + share * (self.heading[b] - self.heading[a]))
            }
            (Some(row), None) | (None, Some(row)) => Some(self.heading[row]),
            (None, None) => None,
        }
    }

    /// Change of heading between two times, rad; each heading is a median over a tenth of the time between them, half
    /// before and half after. `None` if headings are missing there.
    pub fn heading_change(&self, from: f64, to: f64) -> Option<f64> {
        let time = to - from;
        let [before, after] = [from, to].map(|t| self.heading_near(t, 0.05 * time, 0.25 * time));
        Some(after? - before?)
    }

    /// Mean rate between two times, rad/s; `None` if headings are missing there, and unless `to` is later than `from`.
    pub fn mean_rate(&self, from: f64, to: f64) -> Option<f64> {
        (to > from).then(|| self.heading_change(from, to))?.map(|change| change / (to - from))
    }
}

/// Median of at most [`MAX_MEDIAN_ROWS`] values, evenly selected; `None` if none of them is finite.
pub(crate) fn thinned_median(values: &[f64]) -> Option<f64> {
    median(&mut thinned(values))
}

/// At most [`MAX_MEDIAN_ROWS`] values, evenly selected; those that are not finite are omitted.
pub(crate) fn thinned(values: &[f64]) -> Vec<f64> {
    let step = values.len().div_ceil(MAX_MEDIAN_ROWS).max(1);
    // The selection is centred, so that a slope is thinned to its middle.
    let skip = values.len().saturating_sub(1) % step / 2;
    values.iter().skip(skip).step_by(step).copied().filter(|x| x.is_finite()).collect()
}
