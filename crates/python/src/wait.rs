//! Work on a separate thread, so that other Python threads run and Ctrl-C is handled meanwhile.

use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use campaign::failure::Failure;
use pyo3::prelude::*;

use crate::raise::python_error;

/// Polling interval for signals.
const LOOK: Duration = Duration::from_millis(50);

/// Stack size of the thread, bytes: equal to the main thread of the command line.
const STACK: usize = 8 << 20;

/// Work that runs on a separate thread, with the channel of its result.
pub struct BackgroundWork<T>(Receiver<Result<T, Failure>>);

impl<T: Send + 'static> BackgroundWork<T> {
    /// Work started on a new thread. Fails if no thread can be created.
    pub fn start(work: impl FnOnce() -> Result<T, Failure> + Send + 'static) -> PyResult<Self> {
        let (send, receive) = channel();
        // The receiver no longer exists if the wait was abandoned.
        let run = move || drop(send.send(work()));
        let thread = thread::Builder::new().name("kempf".into()).stack_size(STACK).spawn(run);
        thread.map_err(|error| python_error(Failure::execution(format!("failed to start a thread: {error}"))))?;
        Ok(Self(receive))
    }

    /// Result of the work, if it ends within one polling interval; `None` while the work runs. The interpreter lock is
    /// released meanwhile.
    pub fn wait(&mut self, py: Python<'_>) -> Option<PyResult<T>> {
        let receive = &mut self.0;
        match py.detach(move || receive.recv_timeout(LOOK)) {
            Ok(done) => Some(done.map_err(python_error)),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => {
                Some(Err(python_error(Failure::execution("internal error; details are on standard error"))))
            }
        }
    }
}

/// Result of work on a separate thread, after its end. A signal that raises, such as Ctrl-C, ends the wait at once,
/// while the work continues to its end.
pub fn run_in_background<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let mut background_work = BackgroundWork::start(work)?;
    loop {
        if let Some(done) = background_work.wait(py) {
            return done;
        }
        py.check_signals()?;
    }
}
