//! `run`: a complete scenario, as run by the command line.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use campaign::Observer;
use campaign::collect::collect;
use campaign::failure::Failure;
use campaign::folder::ResultFolder;
use campaign::shard::default_folder;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use study::options::{FigureChoice, FigureOptions, MAX_THREADS};
use study::views::publish;

use crate::raise::raised;
use crate::scene::ScenarioInput;
use crate::wait::Underway;

/// Observer of background work: progress, messages and requests to stop.
#[derive(Default)]
pub struct Watch {
    /// `true` after a request to stop.
    is_asked: AtomicBool,
    /// Maximum number of steps.
    most: AtomicU64,
    /// Number of finished steps.
    done: AtomicU64,
    /// Notes and warnings.
    messages: Mutex<[Vec<String>; 2]>,
    /// Threads of the work; `None` for the global pool.
    threads: Option<ThreadPool>,
}

impl Watch {
    /// Notes and warnings since the last call.
    pub fn take_messages(&self) -> [Vec<String>; 2] {
        std::mem::take(&mut *self.messages())
    }

    fn messages(&self) -> MutexGuard<'_, [Vec<String>; 2]> {
        self.messages.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Observer for Watch {
    fn begin(&self, most: u64, done: u64) {
        self.most.store(most, Ordering::Relaxed);
        self.done.store(done, Ordering::Relaxed);
    }

    fn advance(&self) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }

    fn note(&self, line: &str) {
        self.messages()[0].push(line.to_owned());
    }

    fn warn(&self, line: &str) {
        self.messages()[1].push(line.to_owned());
    }

    fn should_stop(&self) -> bool {
        self.is_asked.load(Ordering::Relaxed)
    }

    fn threads(&self) -> Option<&ThreadPool> {
        self.threads.as_ref()
    }
}

/// Thread pool of a study. Fails if the number of threads is out of range or the threads cannot be started.
fn pool(count: i64) -> Result<ThreadPool, Failure> {
    if !(1..=MAX_THREADS).contains(&count) {
        return Err(Failure::input(format!("threads = {count}: expected a whole number from 1 to {MAX_THREADS}")));
    }
    let pool = ThreadPoolBuilder::new().num_threads(count as usize).build();
    pool.map_err(|error| Failure::execution(format!("failed to start {count} threads: {error}")))
}

/// Document of a study, after its missing trials were run and the study was published.
fn study(
    scene: &ScenarioInput,
    out: Option<PathBuf>,
    seed: Option<u64>,
    restart: bool,
    watch: &Watch,
) -> Result<String, Failure> {
    let scenario = scene.read(seed)?;
    let theme = FigureOptions { paper: None, dpi: 600.0, style: None }.theme()?;
    let folder = ResultFolder::make(&out.unwrap_or_else(|| default_folder(&scenario.name)))?;
    let stored = collect(&scenario, &folder, restart, watch)?;
    let publish = || publish::write_files(&stored, &folder, &theme, FigureChoice::Named);
    let summary = match &watch.threads {
        Some(threads) => threads.install(publish),
        None => publish(),
    }?;
    publish::document(&stored, &summary, &folder)
}

/// Document, notes and warnings of a scenario that is run into the folder `out`; `None` for the default folder.
/// `progress` is called with the number of finished trials and the maximum number of trials.
#[pyfunction]
#[pyo3(signature = (scene, out, threads, seed, restart, progress))]
pub fn run(
    py: Python<'_>,
    scene: ScenarioInput,
    out: Option<PathBuf>,
    threads: Option<i64>,
    seed: Option<u64>,
    restart: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, Vec<String>, Vec<String>)> {
    let threads = threads.map(pool).transpose().map_err(raised)?;
    let watch = Arc::new(Watch { threads, ..Watch::default() });
    let observer = Arc::clone(&watch);
    let text = watched(py, &watch, progress.as_ref(), move || study(&scene, out, seed, restart, &observer))?;
    let [notes, warnings] = watch.take_messages();
    Ok((text, notes, warnings))
}

/// Result of observed work, after waiting; `progress` is called with the number of finished steps and the maximum
/// number of steps.
pub fn watched<T: Send + 'static>(
    py: Python<'_>,
    watch: &Watch,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce() -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let mut underway = Underway::start(work)?;
    let mut last = None;
    loop {
        let done = underway.wait(py);
        let now = (watch.done.load(Ordering::Relaxed), watch.most.load(Ordering::Relaxed));
        if let Some(progress) = progress.filter(|_| now.1 > 0 && last.replace(now) != Some(now))
            && let Err(raised) = progress.call1(py, now)
        {
            return Err(stopped(py, watch, underway, raised));
        }
        if let Some(done) = done {
            return done;
        }
        if let Err(raised) = py.check_signals() {
            return Err(stopped(py, watch, underway, raised));
        }
    }
}

/// Requests a stop and waits until the rows are stored, or for a second signal. The message of the interruption states
/// what was stored.
fn stopped<T: Send + 'static>(py: Python<'_>, watch: &Watch, mut underway: Underway<T>, raised: PyErr) -> PyErr {
    watch.is_asked.store(true, Ordering::Relaxed);
    loop {
        if let Some(done) = underway.wait(py) {
            let kept = done.err().filter(|_| raised.is_instance_of::<PyKeyboardInterrupt>(py));
            return kept.map_or(raised, |kept| PyKeyboardInterrupt::new_err(kept.value(py).to_string()));
        }
        if let Err(again) = py.check_signals() {
            return again;
        }
    }
}
