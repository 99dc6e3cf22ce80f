//! How far work is, on standard error: a bar with the time that is left where that is a terminal, and elsewhere one line
//! with the time to expect, where that is long.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle};

use crate::screen;

/// A bar over `length` of something; it goes away when the work is done.
pub fn of(what: &str, length: u64, quiet: bool) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}, {per_sec}, {eta} left")
        .expect("the template is valid");
    let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr())
        .with_style(style)
        .with_message(what.to_owned())
        .with_finish(ProgressFinish::AndClear);
    bar.enable_steady_tick(Duration::from_millis(500));
    bar
}

/// A sign on standard error that work of unknown length goes on; hidden like a bar.
pub fn busy(what: &'static str, quiet: bool) -> ProgressBar {
    if quiet {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{spinner} {msg} [{elapsed}]").expect("a fixed template");
    let bar = ProgressBar::new_spinner().with_style(style).with_message(what);
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// Time to expect, s, from which it is said where no bar is seen.
const LONG: f64 = 10.0;

/// A known number of steps that take about the same time.
pub struct Steps {
    bar: ProgressBar,
    what: &'static str,
    left: u64,
    side_by_side: usize,
    begin: Instant,
    is_told: AtomicBool,
}

impl Steps {
    /// So many steps of which some are done already; `side_by_side` are worked on at a time.
    pub fn new(what: &'static str, most: u64, done: u64, side_by_side: usize, quiet: bool) -> Self {
        Self {
            bar: of(what, most, quiet).with_position(done).with_elapsed(Duration::ZERO),
            what,
            left: most.saturating_sub(done),
            side_by_side,
            begin: Instant::now(),
            is_told: AtomicBool::new(quiet || std::io::stderr().is_terminal()),
        }
    }

    /// One more is done. The first one tells how long all will take.
    pub fn advance(&self) {
        self.bar.inc(1);
        if !self.is_told.swap(true, Ordering::Relaxed) {
            forecast(self.what, self.left, self.side_by_side, self.begin.elapsed())
                .iter()
                .for_each(|line| screen::warn(line));
        }
    }

    /// No more are done.
    pub fn finish(&self) {
        self.bar.finish();
    }
}

/// How long `left` steps will take of which the first took so long, where that is long.
fn forecast(what: &str, left: u64, side_by_side: usize, first: Duration) -> Option<String> {
    let seconds = first.as_secs_f64() * (left as f64 / side_by_side.max(1) as f64).ceil();
    (seconds >= LONG).then(|| format!("{left} {what}: about {seconds:.0} s"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_work_says_how_long() {
        let said =
            |left, side_by_side, first: f64| forecast("trials", left, side_by_side, Duration::from_secs_f64(first));
        assert_eq!(said(1000, 4, 0.1).as_deref(), Some("1000 trials: about 25 s"));
        assert_eq!(said(9, 2, 60.0).as_deref(), Some("9 trials: about 300 s"));
        assert_eq!((said(1000, 16, 0.1), said(1, 1, 9.0), said(0, 1, 60.0)), (None, None, None));
    }
}
