//! A folder of results: who holds it, and how files get into it. Every file is written beside its place and renamed
//! when it is whole, so a reader finds the old one or the new one and a link in the folder is replaced, not followed.
//! While one program writes in a folder all others are kept out.

use std::io::{self, BufReader, BufWriter, Write};
use std::path::{Component, Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::disk;
use scenario::failure::{Failure, OnPath};
use scenario::hex;

/// File that is locked while somebody writes in a folder. It stays there, empty.
const LOCK: &str = ".lock";

/// A folder of results that nobody else writes in while this lives.
#[derive(Debug)]
pub struct ResultFolder {
    path: PathBuf,
    /// `None` for a folder inside one that is held.
    _lock: Option<disk::File>,
}

/// A folder of results that nobody writes in while this lives.
#[derive(Debug)]
pub struct ReadLock {
    /// `None` where there is nothing to lock.
    _lock: Option<disk::File>,
}

impl ResultFolder {
    /// Makes a folder for results where there is none and keeps others out of it.
    ///
    /// Fails when the folder cannot be made or written, and when another program is at work there.
    pub fn hold(path: &Path) -> Result<Self, Failure> {
        let refuse = |tried: &str, error: io::Error| {
            Failure::work(format!(
                "failed to {tried} the folder {}: {error}; give another one with --out",
                path.display()
            ))
        };
        disk::create_folder(path).map_err(|error| refuse("make", error))?;
        let lock = lock_of(path)?;
        let file = disk::File::open_shared(&lock).map_err(|error| refuse("write to", error))?;
        match file.lock().on("lock", &lock)? {
            true => Ok(Self { path: path.to_owned(), _lock: Some(file) }),
            false => Err(at_work(path)),
        }
    }

    /// A folder of somebody else's, into which single files are put and out of which nobody is kept.
    ///
    /// Fails when there is no such folder and none can be made.
    pub fn shared(path: &Path) -> Result<Self, Failure> {
        disk::create_folder(path).on("make the folder", path)?;
        Ok(Self { path: path.to_owned(), _lock: None })
    }

    /// A folder inside this one, held with it; made when it is missing.
    ///
    /// Fails when its place is taken by a link: what is behind it belongs to somebody else.
    pub fn inside(&self, name: &str) -> Result<Self, Failure> {
        let path = self.place(name)?;
        if disk::is_link(&path).on("look for", &path)? {
            return Err(Failure::input(format!(
                "{} is a link; expected a folder of this study; remove the link, or give another folder with --out",
                path.display()
            )));
        }
        disk::create_folder(&path).on("make the folder", &path)?;
        Ok(Self { path, _lock: None })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Place of a file in it. Fails when the name leads elsewhere.
    fn place(&self, name: &str) -> Result<PathBuf, Failure> {
        let mut parts = Path::new(name).components();
        match (parts.next(), parts.next()) {
            (Some(Component::Normal(only)), None) if only == name => Ok(self.path.join(name)),
            _ => Err(Failure::input(format!("{name:?} is not the name of a file; expected one without a path"))),
        }
    }

    /// Begins a file, which appears under its name when it is [`TemporaryFile::put`] there.
    pub fn create(&self, name: &str) -> Result<TemporaryFile, Failure> {
        let place = self.place(name)?;
        let path = self.place(&format!("{name}.tmp"))?;
        // What a kill left there.
        disk::remove_if_there(&path).on("remove", &path)?;
        let file = disk::File::create_new(&path).on("create", &path)?;
        Ok(TemporaryFile { file: BufWriter::new(file), place, path, is_put: false })
    }

    /// Writes a file that can be made again from what is stored.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        let mut file = self.create(name)?;
        file.write_all(content.as_ref()).on("write", &file.path)?;
        file.put()
    }

    /// Writes a file that cannot be made again, and waits until it is on the disk; returns its SHA-256.
    pub fn keep(&self, name: &str, content: impl AsRef<[u8]>) -> Result<String, Failure> {
        let mut file = self.create(name)?;
        file.write_all(content.as_ref()).on("write", &file.path)?;
        let sha256 = file.seal()?;
        file.put()?;
        self.sync()?;
        Ok(sha256)
    }

    /// Removes the files whose names are of some kind: what an earlier run left, and this one may not make.
    pub fn remove_all(&self, is_old: impl Fn(&str) -> bool) -> Result<(), Failure> {
        let names = disk::names(&self.path).on("list the folder", &self.path)?.into_iter().filter(|name| is_old(name));
        names.map(|name| self.path.join(name)).try_for_each(|path| disk::remove(&path).on("remove", &path))
    }

    /// Waits until the names of its files are on the disk.
    pub fn sync(&self) -> Result<(), Failure> {
        disk::sync_folder(&self.path).on("finish", &self.path)
    }
}

impl ReadLock {
    /// Keeps those out who want to write in a folder. A folder that nobody ever wrote in with a lock, or in which none
    /// can be made, is read without one.
    ///
    /// Fails when somebody is writing there.
    pub fn begin(path: &Path) -> Result<Self, Failure> {
        let lock = lock_of(path)?;
        match disk::File::open(&lock) {
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::PermissionDenied) => {
                Ok(Self { _lock: None })
            }
            Err(error) => Err(Failure::work(format!("failed to open {}: {error}", lock.display()))),
            Ok(file) => match file.lock_for_reading().on("lock", &lock)? {
                true => Ok(Self { _lock: Some(file) }),
                false => Err(at_work(path)),
            },
        }
    }
}

fn at_work(path: &Path) -> Failure {
    Failure::work(format!(
        "another study is running in {}; wait for it, or give another folder with --out",
        path.display()
    ))
}

/// The file that is locked, which must not be a link: opening one could make a file elsewhere.
fn lock_of(folder: &Path) -> Result<PathBuf, Failure> {
    let lock = folder.join(LOCK);
    match disk::is_link(&lock).on("look for", &lock)? {
        true => Err(Failure::input(format!("{} is a link; expected a file; remove it", lock.display()))),
        false => Ok(lock),
    }
}

/// A file under way, beside its place. What is not put there goes away.
#[derive(Debug)]
pub struct TemporaryFile {
    file: BufWriter<disk::File>,
    place: PathBuf,
    path: PathBuf,
    is_put: bool,
}

impl Write for TemporaryFile {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        self.file.write(buffer)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl TemporaryFile {
    /// Waits until the content is on the disk; returns its SHA-256.
    pub fn seal(&mut self) -> Result<String, Failure> {
        self.file.flush().on("write", &self.path)?;
        self.file.get_ref().sync().on("finish", &self.path)?;
        sha256_of(&self.path).on("read", &self.path)
    }

    /// Gives the file its name.
    pub fn put(mut self) -> Result<(), Failure> {
        self.file.flush().on("write", &self.path)?;
        disk::rename(&self.path, &self.place).on("write", &self.place)?;
        self.is_put = true;
        Ok(())
    }

    /// Its path while it is under way, for messages.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for TemporaryFile {
    fn drop(&mut self) {
        if !self.is_put {
            let _ = disk::remove(&self.path);
        }
    }
}

/// SHA-256 of a file.
pub fn sha256_of(path: &Path) -> io::Result<String> {
    let mut digest = Sha256::new();
    io::copy(&mut BufReader::with_capacity(1 << 17, disk::File::open(path)?), &mut digest)?;
    Ok(hex(&digest.finalize()))
}

#[cfg(all(test, unix))]
mod tests {
    use nix::errno::Errno;

    use super::*;
    use crate::disk::faults;

    #[test]
    fn results_are_written_without_locks_and_without_waiting() {
        for lack in [Errno::ENOSYS, Errno::EINVAL, Errno::EOPNOTSUPP, Errno::ENOLCK] {
            let desk = tempfile::tempdir().expect("a folder");
            let _armed = faults::lack(desk.path(), lack as i32);
            let held = ResultFolder::hold(desk.path()).unwrap_or_else(|failure| panic!("{lack}: {failure}"));
            held.keep("a.txt", "a").unwrap_or_else(|failure| panic!("{lack}: {failure}"));
            ReadLock::begin(desk.path()).unwrap_or_else(|failure| panic!("{lack}: {failure}"));
            assert_eq!(std::fs::read(desk.path().join("a.txt")).expect("a file"), b"a");
        }
        let desk = tempfile::tempdir().expect("a folder");
        let _armed = faults::lack(desk.path(), Errno::EIO as i32);
        assert!(ResultFolder::hold(desk.path()).is_err(), "a broken disk is no lack");
    }
}
