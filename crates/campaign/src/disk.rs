//! File operations of result folders, in one place, so that a test can make any of them fail. All other code of this
//! crate writes through [`crate::folder`].

use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

pub mod faults;

/// Runs an operation on a path, unless a test makes it fail.
fn at<T>(path: &Path, operation: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
    faults::check_operation(path)?;
    operation()
}

/// Open file, whose operations a test can make fail.
#[derive(Debug)]
pub struct File {
    file: fs::File,
    path: PathBuf,
}

impl File {
    fn from_opened(path: &Path, open: impl FnOnce() -> io::Result<fs::File>) -> io::Result<Self> {
        Ok(Self { file: at(path, open)?, path: path.to_owned() })
    }

    /// Waits until the content is on the disk, if the file system supports it.
    pub fn sync(&self) {
        let _ = self.file.sync_all();
    }

    /// Opens a regular file for reading. Fails for any other kind: opening a pipe would block for ever.
    pub fn open(path: &Path) -> io::Result<Self> {
        Self::from_opened(path, || regular(path).and_then(|_| fs::File::open(path)))
    }

    /// Creates a new file; links are not followed. Fails if the name is taken.
    pub fn create_new(path: &Path) -> io::Result<Self> {
        Self::from_opened(path, || fs::File::create_new(path))
    }
}

impl Read for File {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        faults::check_operation(&self.path)?;
        self.file.read(buffer)
    }
}

impl Write for File {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        if let Err(error) = faults::check_operation(&self.path) {
            // A full disk accepts the first part.
            let _ = self.file.write(&buffer[..buffer.len() / 2]);
            return Err(error);
        }
        self.file.write(buffer)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Checks before opening that a path, or the target of a link, is a regular file.
fn regular(path: &Path) -> io::Result<()> {
    match fs::metadata(path)?.is_file() {
        true => Ok(()),
        false => Err(io::Error::other("this is not a regular file")),
    }
}

/// Result of an operation; "not found" becomes `None`.
fn if_present<T>(result: io::Result<T>) -> io::Result<Option<T>> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        other => other.map(Some),
    }
}

/// `true` if the path exists, even as a dangling link. Unlike `Path::exists`, fails if that cannot be
/// determined.
pub fn path_exists(path: &Path) -> io::Result<bool> {
    at(path, || Ok(if_present(fs::symlink_metadata(path))?.is_some()))
}

/// `true` if the path is a link.
pub fn is_link(path: &Path) -> io::Result<bool> {
    Ok(path_exists(path)? && fs::symlink_metadata(path)?.is_symlink())
}

/// Content of a regular file; `None` if there is no file. Fails for a file of more than `largest` bytes.
pub fn read(path: &Path, largest: u64) -> io::Result<Option<Vec<u8>>> {
    let too_large = || io::Error::other(format!("it has more than {largest} bytes"));
    let Some(mut file) = if_present(File::open(path))? else { return Ok(None) };
    if file.file.metadata()?.len() > largest {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    (&mut file).take(largest + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > largest { Err(too_large()) } else { Ok(Some(bytes)) }
}

/// Creates a folder and its parents.
pub fn create_folder(path: &Path) -> io::Result<()> {
    at(path, || fs::create_dir_all(path))
}

/// Renames a file, replacing any file of the new name.
pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
    at(to, || fs::rename(from, to))
}

/// Removes a file or a link.
pub fn remove_file(path: &Path) -> io::Result<()> {
    at(path, || fs::remove_file(path))
}

/// Removes a file or a link if it is there.
pub fn remove_if_there(path: &Path) -> io::Result<()> {
    if_present(remove_file(path)).map(drop)
}

/// Names of the files and subfolders of a folder, sorted.
pub fn entry_names(path: &Path) -> io::Result<Vec<String>> {
    let entries = at(path, || fs::read_dir(path)?.collect::<io::Result<Vec<_>>>())?;
    let mut names: Vec<String> = entries.iter().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

/// Time since the last write of a file; `None` if it cannot be determined.
pub fn file_age(path: &Path) -> Option<Duration> {
    fs::metadata(path).ok()?.modified().ok()?.elapsed().ok()
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// Opening a pipe would block until another process opens its other end.
    #[test]
    fn a_pipe_in_the_place_of_a_file_is_not_opened() {
        let desk = tempfile::tempdir().expect("a folder");
        let pipe = desk.path().join("showcase.json");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo").success());
        let errors = [read(&pipe, 10).map(drop).err(), File::open(&pipe).map(drop).err()];
        for error in errors {
            assert!(error.expect("refused").to_string().contains("not a regular file"));
        }
    }
}
