//! Disk faults for tests: below one folder, a range of numbered operations fails.

use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Fault injected by tests: the disk operations below `root` with a number in `failing` fail; `seen` counts operations
/// so far.
struct DiskFault {
    root: PathBuf,
    failing: Range<u64>,
    seen: u64,
}

static FAULTS: Mutex<Vec<DiskFault>> = Mutex::new(Vec::new());

/// Number of folders with failing operations; 0 outside tests.
static ARMED: AtomicUsize = AtomicUsize::new(0);

/// Guard of an armed fault: operations below its folder fail until it is dropped.
pub struct FaultGuard(PathBuf);

/// Makes the operations below `root` with these numbers, counted from 0, fail.
pub fn arm(root: &Path, failing: Range<u64>) -> FaultGuard {
    let fault = DiskFault { root: root.to_owned(), failing, seen: 0 };
    FAULTS.lock().unwrap_or_else(PoisonError::into_inner).push(fault);
    ARMED.fetch_add(1, Ordering::SeqCst);
    FaultGuard(root.to_owned())
}

impl FaultGuard {
    /// Number of operations below the folder so far.
    pub fn seen(&self) -> u64 {
        let faults = FAULTS.lock().unwrap_or_else(PoisonError::into_inner);
        faults.iter().find(|fault| fault.root == self.0).map_or(0, |fault| fault.seen)
    }
}

impl Drop for FaultGuard {
    fn drop(&mut self) {
        FAULTS.lock().unwrap_or_else(PoisonError::into_inner).retain(|fault| fault.root != self.0);
        ARMED.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Counts an operation on a path, and fails if a test makes this operation fail.
pub(super) fn check_operation(path: &Path) -> io::Result<()> {
    if ARMED.load(Ordering::Relaxed) == 0 {
        return Ok(());
    }
    let mut faults = FAULTS.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(fault) = faults.iter_mut().find(|fault| path.starts_with(&fault.root)) else { return Ok(()) };
    let number = fault.seen;
    fault.seen += 1;
    match fault.failing.contains(&number) {
        true => Err(io::Error::other(format!("fault {number}"))),
        false => Ok(()),
    }
}
