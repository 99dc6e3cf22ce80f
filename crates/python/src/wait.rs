//! Work on a thread of its own, so that Python's other threads run meanwhile and Ctrl-C is heard while it goes on.

use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use campaign::failure::Failure;
use pyo3::prelude::*;

use crate::raise::raised;

/// Time between two looks for a signal.
const LOOK: Duration = Duration::from_millis(50);

/// Stack of a thread, bytes: that of the main thread of the command line.
const STACK: usize = 8 << 20;

/// Work that goes on.
pub struct Underway<T>(Receiver<Result<T, Failure>>);

impl<T: Send + 'static> Underway<T> {
    /// Begins it. Fails when the system gives no thread.
    pub fn start(work: impl FnOnce() -> Result<T, Failure> + Send + 'static) -> PyResult<Self> {
        let (send, receive) = channel();
        // Nobody receives any more where the wait was given up.
        let run = move || drop(send.send(work()));
        let thread = thread::Builder::new().name("kempf".into()).stack_size(STACK).spawn(run);
        thread.map_err(|error| raised(Failure::work(format!("failed to start a thread: {error}"))))?;
        Ok(Self(receive))
    }

    /// Waits a moment for its end, without the lock of the interpreter; `None` while it goes on.
    pub fn wait(&mut self, py: Python<'_>) -> Option<PyResult<T>> {
        let receive = &mut self.0;
        match py.detach(move || receive.recv_timeout(LOOK)) {
            Ok(done) => Some(done.map_err(raised)),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => {
                Some(Err(raised(Failure::work("the program failed where it should not; standard error says where"))))
            }
        }
    }
}

/// Has work done and waits for it. A signal that raises, as Ctrl-C does, ends the wait at once; the work ends by
/// itself.
pub fn patiently<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let mut underway = Underway::start(work)?;
    loop {
        if let Some(done) = underway.wait(py) {
            return done;
        }
        py.check_signals()?;
    }
}
