//! Progress on standard error: on a terminal a bar with the remaining time, otherwise one line with the expected time
//! of long work.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle};

use crate::screen;

/// Progress bar over `length` steps, removed at the end of the work; hidden if `quiet`, or if standard error is no
/// terminal.
pub fn bar(label: &str, length: u64, quiet: bool) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}, {per_sec}, {eta} left")
        .expect("the template is valid");
    let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr())
        .with_style(style)
        .with_message(label.to_owned())
        .with_finish(ProgressFinish::AndClear);
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}

/// Spinner on standard error for work of unknown length; hidden under the same conditions as a bar.
pub fn spinner(label: &'static str, quiet: bool) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{spinner} {msg} [{elapsed}]").expect("a fixed template");
    let bar = ProgressBar::new_spinner().with_style(style).with_message(label);
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// Minimum expected time, s, that is printed if no bar is visible.
const MIN_FORECAST_S: f64 = 10.0;

/// Minimum elapsed time for a forecast: the first steps are slower than later ones.
const MIN_ELAPSED: Duration = Duration::from_secs(1);

/// Progress over a known number of steps of about equal duration.
pub struct ProgressSteps {
    bar: ProgressBar,
    label: &'static str,
    /// Number of steps that remained at the beginning.
    remaining_steps: u64,
    /// Number of these that are finished.
    done: AtomicU64,
    /// Number of steps that run at a time.
    parallel: usize,
    begin: Instant,
    /// `true` if the forecast has been printed, or is not to be printed.
    is_forecast_done: AtomicBool,
}

impl ProgressSteps {
    /// Progress over `total` steps, of which `done` are complete; `parallel` run at a time.
    pub fn new(label: &'static str, total: u64, done: u64, parallel: usize, quiet: bool) -> Self {
        Self {
            bar: bar(label, total, quiet).with_position(done).with_elapsed(Duration::ZERO),
            label,
            remaining_steps: total.saturating_sub(done),
            done: AtomicU64::new(0),
            parallel,
            begin: Instant::now(),
            is_forecast_done: AtomicBool::new(quiet || std::io::stderr().is_terminal()),
        }
    }

    /// Counts a finished step. Prints the forecast once, after the first second, if no bar is visible.
    pub fn advance(&self) {
        self.bar.inc(1);
        let (done, elapsed) = (self.done.fetch_add(1, Ordering::Relaxed) + 1, self.begin.elapsed());
        if elapsed >= MIN_ELAPSED && !self.is_forecast_done.swap(true, Ordering::Relaxed) {
            // Steps that run at the same time finish at about the same time as the first.
            let line = forecast(self.label, self.remaining_steps, done.max(self.parallel as u64), elapsed);
            line.iter().for_each(|line| screen::print_to_stderr(line));
        }
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish();
    }
}

/// Line with the expected total time of `most` steps if `done` steps took `elapsed`; `None` below [`MIN_FORECAST_S`].
fn forecast(label: &str, most: u64, done: u64, elapsed: Duration) -> Option<String> {
    let seconds = elapsed.as_secs_f64() * (most as f64 / done as f64).max(1.0);
    (seconds >= MIN_FORECAST_S).then(|| format!("{most} {label}: about {seconds:.0} s"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_work_says_how_long() {
        let line = |most, done, elapsed: f64| forecast("trials", most, done, Duration::from_secs_f64(elapsed));
        assert_eq!(line(1000, 40, 1.0).as_deref(), Some("1000 trials: about 25 s"));
        assert_eq!(line(9, 2, 60.0).as_deref(), Some("9 trials: about 270 s"));
        assert_eq!((line(1000, 160, 1.0), line(1, 1, 9.0)), (None, None));
    }
}
