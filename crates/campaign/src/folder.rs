//! A folder of results with atomic writes. Every file is written under a temporary name unique to this process and
//! renamed when it is complete. So a reader finds either the old or the new file, a link in the folder is replaced and
//! not followed, and several programs may write into one folder at once.

use std::hash::{BuildHasher, RandomState};
use std::io::{self, BufWriter, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;

use crate::disk;
use crate::failure::{Failure, OnPath};

/// Prefix of the names of temporary files, which no reader of the folder uses.
const TEMPORARY_PREFIX: &str = ".kempf-";

/// Age of a temporary file from which it counts as left behind by a killed program.
const MAX_AGE: Duration = Duration::from_secs(3600);

/// Folder of results.
#[derive(Debug)]
pub struct ResultFolder {
    path: PathBuf,
}

impl ResultFolder {
    /// Result folder at a path, created if missing.
    ///
    /// Fails if it cannot be created.
    pub fn make(path: &Path) -> Result<Self, Failure> {
        disk::create_folder(path).map_err(|error| {
            let place = path.display();
            Failure::execution(format!("failed to make the folder {place}: {error}; give another one with --out"))
        })?;
        Ok(Self { path: path.to_owned() })
    }

    /// Subfolder, created if missing.
    ///
    /// Fails if the name is a link, whose target does not belong to the study.
    pub fn subfolder(&self, name: &str) -> Result<Self, Failure> {
        let path = self.place(name)?;
        if disk::is_link(&path).on("look for", &path)? {
            return Err(Failure::input(format!(
                "{} is a link; expected a folder of this study; remove the link, or give another folder with --out",
                path.display()
            )));
        }
        Self::make(&path)
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of a file in the folder. Fails unless the name is a single component of a path.
    fn place(&self, name: &str) -> Result<PathBuf, Failure> {
        let mut parts = Path::new(name).components();
        match (parts.next(), parts.next()) {
            (Some(Component::Normal(only)), None) if only == name => Ok(self.path.join(name)),
            _ => Err(Failure::input(format!("{name:?} is not the name of a file; expected one without a path"))),
        }
    }

    /// Temporary file, renamed to the given name on [`TemporaryFile::persist`].
    pub fn create_temporary(&self, name: &str) -> Result<TemporaryFile, Failure> {
        let place = self.place(name)?;
        let path = self.place(&format!("{TEMPORARY_PREFIX}{:x}-{name}", process()))?;
        // An earlier failed write of this process may have left it.
        disk::remove_if_there(&path).on("remove", &path)?;
        let file = disk::File::create_new(&path).on("create", &path)?;
        Ok(TemporaryFile { file: BufWriter::new(file), place, path, is_put: false })
    }

    /// Writes a file.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        let mut file = self.create_temporary(name)?;
        file.write_all(content.as_ref()).on("write", &file.path)?;
        file.persist()
    }

    /// Writes a file and flushes it to the disk: for content that cannot be computed again.
    pub fn write_synced(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        let mut file = self.create_temporary(name)?;
        file.write_all(content.as_ref()).on("write", &file.path)?;
        file.flush().on("write", &file.path)?;
        file.file.get_ref().sync();
        file.persist()
    }

    /// Removes the selected files, and temporary files that killed programs left behind.
    pub fn remove_matching(&self, is_selected: impl Fn(&str) -> bool) -> Result<(), Failure> {
        let is_left =
            |name: &str| name.starts_with(TEMPORARY_PREFIX) && disk::file_age(&self.path.join(name)) > Some(MAX_AGE);
        let names = disk::entry_names(&self.path).on("list the folder", &self.path)?.into_iter();
        let names = names.filter(|name| is_selected(name) || is_left(name));
        names.map(|name| self.path.join(name)).try_for_each(|path| disk::remove_if_there(&path).on("remove", &path))
    }
}

/// Random number that is drawn once in this process.
fn process() -> u64 {
    static NUMBER: OnceLock<u64> = OnceLock::new();
    *NUMBER.get_or_init(|| RandomState::new().hash_one(std::process::id()))
}

/// Temporary file; it is removed on drop unless it was put in place.
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
    /// Flushes the file and renames it to its final name.
    pub fn persist(mut self) -> Result<(), Failure> {
        self.file.flush().on("write", &self.path)?;
        disk::rename(&self.path, &self.place).on("write", &self.place)?;
        self.is_put = true;
        Ok(())
    }

    /// Temporary path, for messages.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for TemporaryFile {
    fn drop(&mut self) {
        if !self.is_put {
            let _ = disk::remove_file(&self.path);
        }
    }
}
