//! Calls that some file systems of clusters and networks do not have: the study goes on without, and says so once.

use std::io;
use std::path::Path;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use super::faults;

/// Takes a warning.
static LISTENER: OnceLock<fn(&str)> = OnceLock::new();

/// Who is told from now on that a file system lacks something; nobody, where this is not called.
pub fn warn_with(listener: fn(&str)) {
    let _ = LISTENER.set(listener);
}

/// Something that a file system may lack.
pub(super) struct Lack {
    /// What it is, and what follows.
    what: &'static str,
    was_told: AtomicBool,
}

/// Locks: Lustre without `flock`, some FUSE.
pub(super) static NO_LOCKS: Lack = Lack {
    what: "has no file locks, so nothing keeps two programs from writing into one folder of results; start one at a time",
    was_told: AtomicBool::new(false),
};

/// Waiting for the disk: folders on some FUSE and SMB.
pub(super) static NO_SYNC: Lack = Lack {
    what: "cannot tell when files or folders are on the disk, so a power failure may cost the last results; keep a copy elsewhere",
    was_told: AtomicBool::new(false),
};

impl Lack {
    /// The result of a call, or `otherwise` where the file system does not have it.
    pub fn or<T>(&self, otherwise: T, path: &Path, call: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
        match faults::is_lacking(path).and_then(|()| call()) {
            Err(error) if is_lack(&error) => {
                if let Some(warn) = LISTENER.get().filter(|_| !self.was_told.swap(true, Ordering::Relaxed)) {
                    warn(&format!("warning: the file system of {} {} ({error})", path.display(), self.what));
                }
                Ok(otherwise)
            }
            result => result,
        }
    }
}

/// Whether an error says that there is no such call for this file.
#[cfg(unix)]
fn is_lack(error: &io::Error) -> bool {
    use nix::errno::Errno;
    let lacks = [Errno::ENOSYS, Errno::EINVAL, Errno::EOPNOTSUPP, Errno::ENOLCK];
    error.kind() == io::ErrorKind::Unsupported
        || error.raw_os_error().is_some_and(|code| lacks.contains(&Errno::from_raw(code)))
}

#[cfg(not(unix))]
fn is_lack(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::Unsupported
}
