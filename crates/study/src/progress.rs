//! How far work is, on standard error: a bar with the time that is left where that is a terminal, and elsewhere one
//! line with the time to expect, where that is long.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
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

/// Time after which the steps so far are taken for what comes: the first ones of many are slower.
const ENOUGH: Duration = Duration::from_secs(1);

/// A known number of steps that take about the same time.
pub struct ProgressSteps {
    bar: ProgressBar,
    what: &'static str,
    most: u64,
    done: AtomicU64,
    side_by_side: usize,
    begin: Instant,
    is_told: AtomicBool,
}

impl ProgressSteps {
    /// So many steps of which some are done already; `side_by_side` are worked on at a time.
    pub fn new(what: &'static str, most: u64, done: u64, side_by_side: usize, quiet: bool) -> Self {
        Self {
            bar: of(what, most, quiet).with_position(done).with_elapsed(Duration::ZERO),
            what,
            most: most.saturating_sub(done),
            done: AtomicU64::new(0),
            side_by_side,
            begin: Instant::now(),
            is_told: AtomicBool::new(quiet || std::io::stderr().is_terminal()),
        }
    }

    /// One more is done. The first one that takes a second, or those of a second, tell how long all will take.
    pub fn advance(&self) {
        self.bar.inc(1);
        let (done, elapsed) = (self.done.fetch_add(1, Ordering::Relaxed) + 1, self.begin.elapsed());
        if elapsed >= ENOUGH && !self.is_told.swap(true, Ordering::Relaxed) {
            // Those that are under way are about as far as the first that is done.
            let line = forecast(self.what, self.most, done.max(self.side_by_side as u64), elapsed);
            line.iter().for_each(|line| screen::warn(line));
        }
    }

    /// No more are done.
    pub fn finish(&self) {
        self.bar.finish();
    }
}

/// How long so many steps take of which some took so long, where that is long.
fn forecast(what: &str, most: u64, done: u64, elapsed: Duration) -> Option<String> {
    let seconds = elapsed.as_secs_f64() * (most as f64 / done as f64).max(1.0);
    (seconds >= LONG).then(|| format!("{most} {what}: about {seconds:.0} s"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_work_says_how_long() {
        let said = |most, done, elapsed: f64| forecast("trials", most, done, Duration::from_secs_f64(elapsed));
        assert_eq!(said(1000, 40, 1.0).as_deref(), Some("1000 trials: about 25 s"));
        assert_eq!(said(9, 2, 60.0).as_deref(), Some("9 trials: about 270 s"));
        assert_eq!((said(1000, 160, 1.0), said(1, 1, 9.0)), (None, None));
    }
}
