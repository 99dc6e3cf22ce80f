//! A folder of results, and how files get into it. Every file is written beside its place under a name of this process
//! alone and renamed when it is whole, so a reader finds the old one or the new one, a link in the folder is replaced
//! and not followed, and programs that write into one folder at once do no harm to each other.

use std::hash::{BuildHasher, RandomState};
use std::io::{self, BufWriter, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;

use crate::disk;
use crate::failure::{Failure, OnPath};

/// What the names of files under way begin with: other programs take such files for none of the folder.
const UNDER_WAY: &str = ".kempf-";

/// Age at which a file under way was left by a program that was killed.
const MAX_AGE: Duration = Duration::from_secs(3600);

/// A folder of results.
#[derive(Debug)]
pub struct ResultFolder {
    path: PathBuf,
}

impl ResultFolder {
    /// Makes a folder for results where there is none.
    ///
    /// Fails when the folder cannot be made.
    pub fn make(path: &Path) -> Result<Self, Failure> {
        disk::create_folder(path).map_err(|error| {
            Failure::work(format!("failed to make the folder {}: {error}; give another one with --out", path.display()))
        })?;
        Ok(Self { path: path.to_owned() })
    }

    /// A folder inside this one; made when it is missing.
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
        Self::make(&path)
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
        let path = self.place(&format!("{UNDER_WAY}{:x}-{name}", process()))?;
        // What a fault left there.
        disk::remove_if_there(&path).on("remove", &path)?;
        let file = disk::File::create_new(&path).on("create", &path)?;
        Ok(TemporaryFile { file: BufWriter::new(file), place, path, is_put: false })
    }

    /// Writes a file.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        let mut file = self.create(name)?;
        file.write_all(content.as_ref()).on("write", &file.path)?;
        file.put()
    }

    /// Writes a file that nothing else tells of, and waits until it is on the disk.
    pub fn keep(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        let mut file = self.create(name)?;
        file.write_all(content.as_ref()).on("write", &file.path)?;
        file.flush().on("write", &file.path)?;
        file.file.get_ref().sync();
        file.put()
    }

    /// Removes the files whose names are of some kind, and what programs that were killed left under way.
    pub fn remove_all(&self, is_old: impl Fn(&str) -> bool) -> Result<(), Failure> {
        let is_left = |name: &str| name.starts_with(UNDER_WAY) && disk::age(&self.path.join(name)) > Some(MAX_AGE);
        let names = disk::names(&self.path).on("list the folder", &self.path)?.into_iter();
        let names = names.filter(|name| is_old(name) || is_left(name));
        names.map(|name| self.path.join(name)).try_for_each(|path| disk::remove_if_there(&path).on("remove", &path))
    }
}

/// A number that no other process on any machine has.
fn process() -> u64 {
    static NUMBER: OnceLock<u64> = OnceLock::new();
    *NUMBER.get_or_init(|| RandomState::new().hash_one(std::process::id()))
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
