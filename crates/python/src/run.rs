//! `run`: a complete scenario, as run by the command line.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use campaign::Observer;
use campaign::collect::collect;
use campaign::failure::Failure;
use campaign::folder::ResultFolder;
use campaign::shard::default_result_folder;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use study::options::{FigureChoice, FigureOptions, MAX_THREADS};
use study::views::publish;

use crate::raise::python_error;
use crate::scene::ScenarioInput;
use crate::wait::BackgroundWork;

/// Observer of background work: progress, messages and requests to stop.
#[derive(Default)]
pub struct WorkObserver {
    /// `true` after a request to stop.
    is_asked: AtomicBool,
    /// Maximum number of trials.
    most: AtomicU64,
    /// Number of finished trials.
    done: AtomicU64,
    /// Notes and warnings.
    messages: Mutex<[Vec<String>; 2]>,
    /// Thread pool for the trials; `None` for the global pool.
    threads: Option<ThreadPool>,
}

impl WorkObserver {
    /// Notes and warnings since the last call.
    pub fn take_messages(&self) -> [Vec<String>; 2] {
        std::mem::take(&mut *self.messages())
    }

    fn messages(&self) -> MutexGuard<'_, [Vec<String>; 2]> {
        self.messages.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Observer for WorkObserver {
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

/// JSON document of a study, after its missing trials were run and the study was published.
fn study(
    scene: &ScenarioInput,
    out: Option<PathBuf>,
    seed: Option<u64>,
    restart: bool,
    observer: &WorkObserver,
) -> Result<String, Failure> {
    let scenario = scene.read(seed)?;
    let theme = FigureOptions { paper: None, dpi: 600.0, style: None }.theme()?;
    let folder = ResultFolder::make(&out.unwrap_or_else(|| default_result_folder(&scenario.name)))?;
    let stored = collect(&scenario, &folder, restart, observer)?;
    let publish = || publish::write_files(&stored, &folder, &theme, FigureChoice::Named);
    let summary = match &observer.threads {
        Some(threads) => threads.install(publish),
        None => publish(),
    }?;
    publish::document(&stored, &summary, &folder)
}

/// JSON document, notes and warnings of a study whose results are in the folder `out`; `None` for the default folder.
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
    let threads = threads.map(pool).transpose().map_err(python_error)?;
    let observer = Arc::new(WorkObserver { threads, ..WorkObserver::default() });
    let shared = Arc::clone(&observer);
    let text = run_observed(py, &observer, progress.as_ref(), move || study(&scene, out, seed, restart, &shared))?;
    let [notes, warnings] = observer.take_messages();
    Ok((text, notes, warnings))
}

/// Result of observed work, after its end; `progress` is called with the number of finished trials and the maximum
/// number of trials.
pub fn run_observed<T: Send + 'static>(
    py: Python<'_>,
    observer: &WorkObserver,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce() -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let mut background_work = BackgroundWork::start(work)?;
    let mut last = None;
    loop {
        let done = background_work.wait(py);
        let now = (observer.done.load(Ordering::Relaxed), observer.most.load(Ordering::Relaxed));
        if let Some(progress) = progress.filter(|_| now.1 > 0 && last.replace(now) != Some(now))
            && let Err(raised) = progress.call1(py, now)
        {
            return Err(stopped(py, observer, background_work, raised));
        }
        if let Some(done) = done {
            return done;
        }
        if let Err(raised) = py.check_signals() {
            return Err(stopped(py, observer, background_work, raised));
        }
    }
}

/// Requests a stop and waits until the rows are stored, or for a second signal. The message of the interruption states
/// what was stored.
fn stopped<T: Send + 'static>(
    py: Python<'_>,
    observer: &WorkObserver,
    mut background_work: BackgroundWork<T>,
    raised: PyErr,
) -> PyErr {
    observer.is_asked.store(true, Ordering::Relaxed);
    loop {
        if let Some(done) = background_work.wait(py) {
            let kept = done.err().filter(|_| raised.is_instance_of::<PyKeyboardInterrupt>(py));
            return kept.map_or(raised, |kept| PyKeyboardInterrupt::new_err(kept.value(py).to_string()));
        }
        if let Err(again) = py.check_signals() {
            return again;
        }
    }
}
