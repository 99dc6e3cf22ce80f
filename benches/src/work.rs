//! Benchmark: the measured work, its reference, and its limit.

use std::hint::black_box;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use rayon::ThreadPool;

/// Number of cores of a benchmark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cores {
    /// Single thread.
    One,
    /// Default number of threads of rayon.
    All,
}

/// Repeatable work of a benchmark.
pub struct Work {
    /// Name, unique within the group; part of a path.
    pub name: String,
    /// Cores of the work.
    pub cores: Cores,
    /// Number of units of work per repetition, for times per unit.
    pub units: f64,
    /// `true` if a repetition is so long that only few are measured.
    pub is_slow: bool,
    /// Maximum relative error of the estimates of K and T, for work that gives estimates.
    pub tolerance: Option<f64>,
    go: Box<dyn Fn() -> Option<[f64; 2]> + Send + Sync>,
}

impl Work {
    /// Work on one core without an estimate; its result is only protected from the optimiser.
    pub fn new<R>(name: impl Into<String>, go: impl Fn() -> R + Send + Sync + 'static) -> Self {
        let go = Box::new(move || {
            black_box(go());
            None
        });
        Self { name: name.into(), cores: Cores::One, units: 1.0, is_slow: false, tolerance: None, go }
    }

    /// Work on one core that estimates K and T, with a relative error of at most `tolerance`; `None` for no estimate.
    pub fn answering(
        name: impl Into<String>,
        tolerance: f64,
        go: impl Fn() -> Option<[f64; 2]> + Send + Sync + 'static,
    ) -> Self {
        Self { tolerance: Some(tolerance), go: Box::new(go), ..Self::new(name, || ()) }
    }

    /// Work on all cores.
    pub fn on_all_cores(self) -> Self {
        Self { cores: Cores::All, ..self }
    }

    /// Work with this number of units per repetition.
    pub fn of_units(self, units: usize) -> Self {
        Self { units: units as f64, ..self }
    }

    /// Work marked as slow.
    pub fn slow(self) -> Self {
        Self { is_slow: true, ..self }
    }

    /// Estimates of K and T from one repetition; `None` for work without estimates.
    pub fn answer(&self) -> Option<[f64; 2]> {
        (self.go)()
    }

    /// Total time of `goes` repetitions.
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

/// Thread pool of one thread, so that the work cannot use a second thread.
fn one_core() -> &'static ThreadPool {
    static POOL: OnceLock<ThreadPool> = OnceLock::new();
    POOL.get_or_init(|| rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread"))
}

/// Limit of a benchmark.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reach {
    /// Maximum time, relative to the reference.
    Ratio(f64),
    /// Minimum throughput of all cores, relative to the number of cores times the throughput of a single core, the
    /// reference.
    Scaling(f64),
}

/// Work with its reference and its limit.
pub struct TimedWork {
    /// Measured work.
    pub work: Work,
    /// Name of the reference in the group; `None` without a reference.
    pub beside: Option<String>,
    /// Limit; `None` for work that is reported only.
    pub reach: Option<Reach>,
}

/// Group of related benchmarks.
pub struct WorkGroup {
    /// Name; part of a path.
    pub name: &'static str,
    /// Heading of the table.
    pub title: &'static str,
    /// Explanation of the table.
    pub about: &'static str,
    /// Benchmarks, in the order of the table.
    pub rows: Vec<TimedWork>,
}

impl WorkGroup {
    /// Empty group.
    pub fn new(name: &'static str, title: &'static str, about: &'static str) -> Self {
        Self { name, title, about, rows: Vec::new() }
    }

    /// Name of work that is added without a reference.
    pub fn alone(&mut self, work: Work, reach: Option<Reach>) -> String {
        let name = work.name.clone();
        self.rows.push(TimedWork { work, beside: None, reach });
        name
    }

    /// Adds work with another work of the group as its reference.
    pub fn beside(&mut self, work: Work, beside: &str, reach: Option<Reach>) {
        self.rows.push(TimedWork { work, beside: Some(beside.to_owned()), reach });
    }
}
