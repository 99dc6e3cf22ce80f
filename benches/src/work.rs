//! A benchmark: the measured work, its reference, and its limit.

use std::hint::black_box;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use rayon::ThreadPool;

/// Cores that a benchmark uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cores {
    /// A single thread.
    One,
    /// As many threads as rayon takes by default.
    All,
}

/// Repeatable work.
pub struct Work {
    /// Unique within its group; part of a path.
    pub name: String,
    /// Cores that it uses.
    pub cores: Cores,
    /// Units of work in one go, so that a time can be quoted per unit.
    pub units: f64,
    /// `true` if one go takes so long that few of them have to do.
    pub is_slow: bool,
    /// Share by which the answer may differ from the ship, for work that has an answer.
    pub tolerance: Option<f64>,
    go: Box<dyn Fn() -> Option<[f64; 2]> + Send + Sync>,
}

impl Work {
    /// Work on one core whose result is only kept from the optimiser.
    pub fn new<R>(name: impl Into<String>, go: impl Fn() -> R + Send + Sync + 'static) -> Self {
        let go = Box::new(move || {
            black_box(go());
            None
        });
        Self { name: name.into(), cores: Cores::One, units: 1.0, is_slow: false, tolerance: None, go }
    }

    /// Work on one core that finds K and T, at most `tolerance` (a share) from those of the ship.
    pub fn answering(
        name: impl Into<String>,
        tolerance: f64,
        go: impl Fn() -> Option<[f64; 2]> + Send + Sync + 'static,
    ) -> Self {
        Self { tolerance: Some(tolerance), go: Box::new(go), ..Self::new(name, || ()) }
    }

    /// The same on all cores.
    pub fn on_all_cores(self) -> Self {
        Self { cores: Cores::All, ..self }
    }

    /// The same, with so many units in one go.
    pub fn of_units(self, units: usize) -> Self {
        Self { units: units as f64, ..self }
    }

    /// The same, known to be slow.
    pub fn slow(self) -> Self {
        Self { is_slow: true, ..self }
    }

    /// Does it once and returns the answer.
    pub fn answer(&self) -> Option<[f64; 2]> {
        (self.go)()
    }

    /// Does it so often and returns the time of all goes together.
    pub fn time(&self, goes: u64) -> Duration {
        let all = || {
            let start = Instant::now();
            for _ in 0..goes {
                black_box((self.go)());
            }
            start.elapsed()
        };
        match self.cores {
            Cores::One => one_core().install(all),
            Cores::All => all(),
        }
    }
}

/// A pool of one thread, so that nothing inside can use a second one.
fn one_core() -> &'static ThreadPool {
    static POOL: OnceLock<ThreadPool> = OnceLock::new();
    POOL.get_or_init(|| rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread"))
}

/// What is to be reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reach {
    /// Maximum time, relative to that of the reference.
    Ratio(f64),
    /// Minimum throughput of all cores, relative to the number of cores times that of a single core, the reference.
    Scaling(f64),
}

/// Work with its reference and its limit.
pub struct TimedWork {
    /// What is measured.
    pub work: Work,
    /// Name of the reference in the group.
    pub beside: Option<String>,
    /// What is to be reached; `None` for work that is only shown.
    pub reach: Option<Reach>,
}

/// Work that belongs together.
pub struct WorkGroup {
    /// Part of a path.
    pub name: &'static str,
    /// Heading of its table.
    pub title: &'static str,
    /// Explanation of the table.
    pub about: &'static str,
    /// The work, in the order of the table.
    pub rows: Vec<TimedWork>,
}

impl WorkGroup {
    /// A group without work.
    pub fn new(name: &'static str, title: &'static str, about: &'static str) -> Self {
        Self { name, title, about, rows: Vec::new() }
    }

    /// Adds work with nothing beside it; returns its name.
    pub fn alone(&mut self, work: Work, reach: Option<Reach>) -> String {
        let name = work.name.clone();
        self.rows.push(TimedWork { work, beside: None, reach });
        name
    }

    /// Adds work beside other work of the group.
    pub fn beside(&mut self, work: Work, beside: &str, reach: Option<Reach>) {
        self.rows.push(TimedWork { work, beside: Some(beside.to_owned()), reach });
    }
}
