//! The file operations of result folders, in one place, so that a test can make any one of them fail. Everything else
//! in this crate that writes, goes through [`crate::folder`].

use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

pub mod faults;

/// An operation on a path, which a test may let fail.
fn at<T>(path: &Path, operation: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
    faults::strike(path)?;
    operation()
}

/// An open file.
#[derive(Debug)]
pub struct File {
    file: fs::File,
    path: PathBuf,
}

impl File {
    fn of(path: &Path, open: impl FnOnce() -> io::Result<fs::File>) -> io::Result<Self> {
        Ok(Self { file: at(path, open)?, path: path.to_owned() })
    }

    /// Waits until all that was written is on the disk, where the file system can tell.
    pub fn sync(&self) {
        let _ = self.file.sync_all();
    }

    /// Opens a file to read. Fails where something else has its name: a pipe would be waited for without an end.
    pub fn open(path: &Path) -> io::Result<Self> {
        Self::of(path, || regular(path).and_then(|_| fs::File::open(path)))
    }

    /// Makes a file that is not there yet; a link is not followed.
    pub fn create_new(path: &Path) -> io::Result<Self> {
        Self::of(path, || fs::File::create_new(path))
    }
}

impl Read for File {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        faults::strike(&self.path)?;
        self.file.read(buffer)
    }
}

impl Write for File {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        if let Err(error) = faults::strike(&self.path) {
            // A disk that is full takes the beginning.
            let _ = self.file.write(&buffer[..buffer.len() / 2]);
            return Err(error);
        }
        self.file.write(buffer)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Fails where something else than a file is there, before it is opened.
fn regular(path: &Path) -> io::Result<()> {
    match fs::metadata(path)?.is_file() {
        true => Ok(()),
        false => Err(io::Error::other("this is not a regular file")),
    }
}

/// The value of an operation on what is there; `None` where nothing is.
fn found<T>(result: io::Result<T>) -> io::Result<Option<T>> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        other => other.map(Some),
    }
}

/// Whether something is there, a link to nowhere included. Unlike `Path::exists`, fails where that cannot be told.
pub fn is_there(path: &Path) -> io::Result<bool> {
    at(path, || Ok(found(fs::symlink_metadata(path))?.is_some()))
}

/// Whether a link is there.
pub fn is_link(path: &Path) -> io::Result<bool> {
    Ok(is_there(path)? && fs::symlink_metadata(path)?.is_symlink())
}

/// Reads a file of at most `largest` bytes; `None` when there is none.
pub fn read(path: &Path, largest: u64) -> io::Result<Option<Vec<u8>>> {
    let too_large = || io::Error::other(format!("it has more than {largest} bytes"));
    let Some(mut file) = found(File::open(path))? else { return Ok(None) };
    if file.file.metadata()?.len() > largest {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    (&mut file).take(largest + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > largest { Err(too_large()) } else { Ok(Some(bytes)) }
}

/// Makes a folder and those above it.
pub fn create_folder(path: &Path) -> io::Result<()> {
    at(path, || fs::create_dir_all(path))
}

/// Gives a file another name in its folder, in the place of whatever had it.
pub fn rename(from: &Path, to: &Path) -> io::Result<()> {
    at(to, || fs::rename(from, to))
}

/// Removes a file or a link.
pub fn remove(path: &Path) -> io::Result<()> {
    at(path, || fs::remove_file(path))
}

/// Removes a file or a link if it is there.
pub fn remove_if_there(path: &Path) -> io::Result<()> {
    found(remove(path)).map(drop)
}

/// Names in a folder, sorted.
pub fn names(path: &Path) -> io::Result<Vec<String>> {
    let entries = at(path, || fs::read_dir(path)?.collect::<io::Result<Vec<_>>>())?;
    let mut names: Vec<String> = entries.iter().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

/// Time since a file was last written; `None` where it is not known.
pub fn age(path: &Path) -> Option<Duration> {
    fs::metadata(path).ok()?.modified().ok()?.elapsed().ok()
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    /// Whoever opens a pipe waits for somebody at its other end.
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
