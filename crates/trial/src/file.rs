//! Files named by a user: scenarios, sidecars and records are opened here. Only files and pipes are opened, and
//! reading stops at the maximum size of the kind of file, so that no name can fill the memory.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use thiserror::Error;

/// Kind of a file, with its maximum size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FileKind {
    /// Name in messages, with its article.
    pub name: &'static str,
    /// Maximum size, bytes.
    pub max_bytes: u64,
}

/// Error of opening or reading a file, without the name of the file.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum FileError {
    /// No such file.
    #[error("there is no such file; check its name and folder")]
    NotFound,
    /// Folder in place of a file.
    #[error("this is a folder; name one file in it")]
    Folder,
    /// Device or a socket in place of a file.
    #[error("this is neither a file nor a pipe (a device or a socket); name a file")]
    NotAFile,
    /// File larger than the maximum size of its kind; `size` (bytes) is `None` if it is unknown before reading.
    #[error(
        "this file has {} bytes, {} has at most {}; name another file or use a part of this one",
        size.map_or_else(|| "more".to_owned(), |size| size.to_string()), kind.name, kind.max_bytes
    )]
    TooLarge { kind: FileKind, size: Option<u64> },
    /// Bytes that are not text.
    #[error("line {line} holds the byte 0x{byte:02x}, which is not UTF-8 text; save the file as UTF-8")]
    NotUtf8 { line: usize, byte: u8 },
    /// Input/output error of the system.
    #[error("the file cannot be read: {0}; check its access rights and the disk")]
    Io(io::Error),
}

impl From<io::Error> for FileError {
    fn from(error: io::Error) -> Self {
        // The limit of `LimitedReader` arrives wrapped in an input error.
        match error.downcast::<Self>() {
            Ok(limit) => limit,
            Err(error) if error.kind() == ErrorKind::NotFound => Self::NotFound,
            Err(error) => Self::Io(error),
        }
    }
}

/// Reader of an open file; reading fails beyond the maximum size of its kind.
pub struct LimitedReader<'a> {
    file: Box<dyn Read + 'a>,
    kind: FileKind,
    /// Size in bytes; `None` for a pipe and standard input.
    pub size: Option<u64>,
    left: u64,
}

impl<'a> LimitedReader<'a> {
    pub(crate) fn new(file: Box<dyn Read + 'a>, kind: FileKind, size: Option<u64>) -> Self {
        Self { file, kind, size, left: kind.max_bytes }
    }
}

impl Read for LimitedReader<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        let Some(left) = self.left.checked_sub(count as u64) else {
            let Self { kind, .. } = *self;
            return Err(io::Error::new(ErrorKind::FileTooLarge, FileError::TooLarge { kind, size: None }));
        };
        self.left = left;
        Ok(count)
    }
}

/// Name that means standard input.
pub const STDIN_PATH: &str = "-";

/// Path of a file for names and messages; `stdin` for standard input.
pub fn display_path(path: &Path) -> &Path {
    if path == Path::new(STDIN_PATH) { Path::new("stdin") } else { path }
}

/// Opens a file, a pipe or standard input ([`STDIN_PATH`]).
///
/// Fails for an absent file, a folder, a device or socket, and a file larger than its kind allows. If the size is
/// unknown, reading fails instead, with an error that `FileError::from` converts back to a [`FileError`].
pub fn open(path: &Path, kind: FileKind) -> Result<LimitedReader<'static>, FileError> {
    if path == Path::new(STDIN_PATH) {
        return Ok(LimitedReader::new(Box::new(io::stdin().lock()), kind, None));
    }
    let about = fs::metadata(path)?;
    let size = match about.file_type() {
        kind if kind.is_dir() => return Err(FileError::Folder),
        kind if kind.is_file() => Some(about.len()),
        kind if is_pipe(kind) => None,
        _ => return Err(FileError::NotAFile),
    };
    if size.is_some_and(|size| size > kind.max_bytes) {
        return Err(FileError::TooLarge { kind, size });
    }
    Ok(LimitedReader::new(Box::new(File::open(path)?), kind, size))
}

#[cfg(unix)]
fn is_pipe(kind: fs::FileType) -> bool {
    std::os::unix::fs::FileTypeExt::is_fifo(&kind)
}

#[cfg(not(unix))]
fn is_pipe(_: fs::FileType) -> bool {
    false
}

/// Text of a file or a pipe. Fails as [`open`] does, and if it is not UTF-8.
pub fn read_text(path: &Path, kind: FileKind) -> Result<String, FileError> {
    let mut bytes = Vec::new();
    open(path, kind)?.read_to_end(&mut bytes)?;
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..valid].iter().filter(|&&byte| byte == b'\n').count();
        FileError::NotUtf8 { line, byte: error.as_bytes()[valid] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: FileKind = FileKind { name: "a note", max_bytes: 8 };

    #[test]
    fn a_file_is_read_up_to_its_limit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("note");
        fs::write(&path, "12345678").expect("written");
        assert_eq!(read_text(&path, SMALL).expect("just as long as it may be"), "12345678");
        fs::write(&path, "123456789").expect("written");
        let error = read_text(&path, SMALL).expect_err("one byte too long").to_string();
        assert!(error.starts_with("this file has 9 bytes, a note has at most 8"), "{error}");
        fs::write(&path, [b'a', b'\n', 0xff]).expect("written");
        assert!(matches!(read_text(&path, SMALL), Err(FileError::NotUtf8 { line: 2, byte: 0xff })));
        assert!(matches!(read_text(folder.path(), SMALL), Err(FileError::Folder)));
        assert!(matches!(read_text(&folder.path().join("none"), SMALL), Err(FileError::NotFound)));
    }

    /// Files under /proc state a size of zero; so does a file that grows while it is read.
    #[cfg(target_os = "linux")]
    #[test]
    fn what_hides_its_size_is_stopped_while_it_is_read() {
        let error = read_text(Path::new("/proc/self/status"), SMALL).expect_err("it is longer");
        assert!(matches!(error, FileError::TooLarge { size: None, .. }), "{error}");
        assert!(matches!(open(Path::new("/dev/zero"), SMALL), Err(FileError::NotAFile)));
    }
}
