//! The file operations of result folders, in one place, so that a test can make any one of them fail. Everything else
//! in this crate that writes, goes through [`crate::folder`].

use std::fs;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use parquet::file::reader::{ChunkReader, Length};

pub mod faults;
pub mod unsupported;

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

    /// Opens a file to read. Fails where something else has its name: a pipe would be waited for without an end.
    pub fn open(path: &Path) -> io::Result<Self> {
        Self::of(path, || regular(path).and_then(|_| fs::File::open(path)))
    }

    /// Makes a file that is not there yet; a link is not followed.
    pub fn create_new(path: &Path) -> io::Result<Self> {
        Self::of(path, || fs::File::create_new(path))
    }

    /// Opens a file that others may have open too, and makes it when it is missing; its content stays.
    pub fn open_shared(path: &Path) -> io::Result<Self> {
        Self::of(path, || {
            found(regular(path))?;
            fs::OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)
        })
    }

    /// Waits until all that was written is on the disk.
    pub fn sync(&self) -> io::Result<()> {
        at(&self.path, || sync(&self.path, &self.file))
    }

    /// Keeps all others out while the file is open; `false` when another one holds it. Where the file system has no
    /// locks, nobody is kept out.
    pub fn lock(&self) -> io::Result<bool> {
        at(&self.path, || unsupported::NO_LOCKS.or(true, &self.path, || is_taken(|| self.file.try_lock())))
    }

    /// Keeps out those who want to write while the file is open; `false` when one of them holds it. Where the file
    /// system has no locks, nobody is kept out.
    pub fn lock_for_reading(&self) -> io::Result<bool> {
        at(&self.path, || unsupported::NO_LOCKS.or(true, &self.path, || is_taken(|| self.file.try_lock_shared())))
    }
}

/// Time after which a lock that somebody holds is believed: a process that this program is about to start holds all its
/// files for a moment, those included that were closed meanwhile.
const MOMENT: Duration = Duration::from_millis(200);

fn is_taken(lock: impl Fn() -> Result<(), fs::TryLockError>) -> io::Result<bool> {
    let start = Instant::now();
    loop {
        match lock() {
            Ok(()) => return Ok(true),
            Err(fs::TryLockError::WouldBlock) if start.elapsed() < MOMENT => thread::sleep(MOMENT / 20),
            Err(fs::TryLockError::WouldBlock) => return Ok(false),
            Err(fs::TryLockError::Error(error)) => return Err(error),
        }
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

impl Length for File {
    fn len(&self) -> u64 {
        self.file.metadata().map_or(0, |about| about.len())
    }
}

impl ChunkReader for File {
    type T = io::BufReader<Self>;

    fn get_read(&self, start: u64) -> parquet::errors::Result<Self::T> {
        let mut file = Self { file: self.file.try_clone()?, path: self.path.clone() };
        file.file.seek(SeekFrom::Start(start))?;
        Ok(io::BufReader::new(file))
    }

    fn get_bytes(&self, start: u64, length: usize) -> parquet::errors::Result<bytes::Bytes> {
        let mut buffer = Vec::new();
        self.get_read(start)?.take(length as u64).read_to_end(&mut buffer)?;
        match buffer.len() == length {
            true => Ok(buffer.into()),
            false => Err(io::Error::from(io::ErrorKind::UnexpectedEof).into()),
        }
    }
}

/// Opens a file to write at its end, and makes it when it is missing. Fails where a link or a pipe is in its place.
pub fn append(path: &Path) -> io::Result<fs::File> {
    if is_link(path)? {
        return Err(io::Error::other("this is a link"));
    }
    found(regular(path))?;
    fs::OpenOptions::new().append(true).create(true).open(path)
}

/// Size of a file, looked at before it is opened, bytes. Fails where something else is there.
fn regular(path: &Path) -> io::Result<u64> {
    let about = fs::metadata(path)?;
    match about.is_file() {
        true => Ok(about.len()),
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
    if Length::len(&file) > largest {
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

/// Removes an empty folder.
pub fn remove_folder(path: &Path) -> io::Result<()> {
    at(path, || fs::remove_dir(path))
}

/// Names in a folder, sorted.
pub fn names(path: &Path) -> io::Result<Vec<String>> {
    let entries = at(path, || fs::read_dir(path)?.collect::<io::Result<Vec<_>>>())?;
    let mut names: Vec<String> = entries.iter().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

/// Waits until the names in a folder are on the disk.
pub fn sync_folder(path: &Path) -> io::Result<()> {
    // Other systems have no such call: there a name is as safe as the file system makes it.
    at(path, || if cfg!(unix) { sync(path, &fs::File::open(path)?) } else { Ok(()) })
}

fn sync(path: &Path, file: &fs::File) -> io::Result<()> {
    unsupported::NO_SYNC.or((), path, || file.sync_all())
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
        let errors = [
            read(&pipe, 10).map(drop).err(),
            File::open(&pipe).map(drop).err(),
            File::open_shared(&pipe).map(drop).err(),
            append(&pipe).map(drop).err(),
        ];
        for error in errors {
            assert!(error.expect("refused").to_string().contains("not a regular file"));
        }
    }
}
