//! Movement of a channel: range, reversals and mean rate. Ratios of these numbers hold for ships of every size.

/// Minimum and maximum finite value; ∞ and −∞ without finite values.
pub(crate) fn extremes(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

/// Maximum minus minimum finite value; 0 without finite values.
pub(crate) fn range(values: &[f64]) -> f64 {
    let (low, high) = extremes(values.iter().copied());
    if low <= high { high - low } else { 0.0 }
}

/// Number of reversals of a rudder (rad): movements from side to side of its range, by more than half of it.
pub fn count_reversals(rudder: &[f64]) -> usize {
    let (low, high) = extremes(rudder.iter().copied());
    let (middle, quarter) = (0.5 * (low + high), 0.25 * (high - low));
    let mut side = 0.0;
    let mut count = 0;
    for delta in rudder.iter().map(|delta| delta - middle).filter(|delta| delta.abs() > quarter) {
        if delta.signum() != side {
            count += usize::from(side != 0.0);
            side = delta.signum();
        }
    }
    count
}

/// Mean absolute rate of turn, rad/s, from changes of heading over a hundredth of the record each; NaN without two
/// headings.
pub(crate) fn mean_rate(time: &[f64], heading: &[f64]) -> f64 {
    let (turned, duration) = changes(time, heading)
        .fold((0.0, 0.0), |(turned, duration), (turn, step)| (turned + turn.abs(), duration + step));
    turned / duration
}

/// Changes of a channel (in its unit) and their durations (s), each over a hundredth of the readings to reduce noise.
pub(crate) fn changes<'a>(time: &'a [f64], values: &'a [f64]) -> impl Iterator<Item = (f64, f64)> + 'a {
    const PARTS: usize = 100;
    let read = values.iter().filter(|value| value.is_finite()).count();
    let every = (read / PARTS).max(1);
    let mut ends = (0..time.len()).filter(|&row| values[row].is_finite()).step_by(every);
    let mut from = ends.next().unwrap_or(0);
    ends.map(move |to| {
        let change = (values[to] - values[from], time[to] - time[from]);
        from = to;
        change
    })
}
