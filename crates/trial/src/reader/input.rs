//! What kind of file it is, told from its first bytes and lines, whatever its name: packed or plain, a table or
//! sentences.

use std::io::{self, Chain, Cursor, ErrorKind, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

use super::error::Problem;
use super::limits::RECORD;
use super::nmea;
use crate::file::{self, FileError};

/// Bytes and lines that are looked at to tell sentences from a table.
const LOOKED_AT: (u64, usize) = (1 << 14, 60);

/// The bytes of a file, from the first one on.
pub(super) type Bytes<'a> = Chain<Cursor<Vec<u8>>, Box<dyn Read + 'a>>;

/// The content of a file.
pub(super) enum Content<'a> {
    /// A table.
    Table(Bytes<'a>),
    /// Sentences, one a line.
    Sentences(Bytes<'a>),
}

/// Stops where a packed file gives more than a record may have.
struct Unpacked<R> {
    inner: R,
    left: u64,
}

impl<R: Read> Read for Unpacked<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        match self.left.checked_sub(count as u64) {
            Some(left) => {
                self.left = left;
                Ok(count)
            }
            None => Err(io::Error::new(ErrorKind::FileTooLarge, FileError::TooLarge { kind: RECORD, size: None })),
        }
    }
}

/// The name of a record: that of its file without its endings.
pub(super) fn stem(path: &Path) -> String {
    let packed = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    let inner = if packed { path.with_extension("") } else { path.to_path_buf() };
    inner.file_stem().map_or_else(|| "record".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Opens a file and tells what it holds; its size in bytes where that says how long its text is.
pub(super) fn open(path: &Path) -> Result<(Content<'static>, Option<u64>), Problem> {
    let file = file::open(path, RECORD)?;
    let size = file.size();
    let content = recognise(Box::new(file))?;
    Ok((content, size))
}

/// The first bytes, as many as there are up to what is looked at.
fn peek<'a>(mut input: Box<dyn Read + 'a>) -> Result<(Vec<u8>, Bytes<'a>), Problem> {
    let mut first = Vec::new();
    (&mut input).take(LOOKED_AT.0).read_to_end(&mut first).map_err(FileError::from)?;
    Ok((first.clone(), Cursor::new(first).chain(input)))
}

/// Tells what a file holds.
///
/// Fails for formats that are recognised and not read, and for packed data that are damaged.
pub(super) fn recognise<'a>(input: Box<dyn Read + 'a>) -> Result<Content<'a>, Problem> {
    let (mut first, mut bytes) = peek(input)?;
    if first.starts_with(&[0x1f, 0x8b]) {
        let unpacked = Unpacked { inner: MultiGzDecoder::new(bytes), left: RECORD.largest };
        (first, bytes) = peek(Box::new(unpacked))?;
    }
    let refused = |format, cure| Err(Problem::Format { format, cure });
    const AS_CSV: &str = "export it as CSV";
    match first.as_slice() {
        [b'P', b'K', 3, 4, ..] => refused("a spreadsheet or an archive (ZIP)", AS_CSV),
        [0xd0, 0xcf, 0x11, 0xe0, ..] => refused("an old spreadsheet (XLS)", AS_CSV),
        [b'P', b'A', b'R', b'1', ..] => refused("a Parquet file", AS_CSV),
        [0x89, b'H', b'D', b'F', ..] => refused("an HDF5 file (MATLAB 7.3 writes these)", AS_CSV),
        start if start.starts_with(b"MATLAB 5.0") => refused("a MATLAB file", AS_CSV),
        start if start.split(|&byte| byte == b'\n').take(LOOKED_AT.1).any(is_sentence) => Ok(Content::Sentences(bytes)),
        _ => Ok(Content::Table(bytes)),
    }
}

fn is_sentence(line: &[u8]) -> bool {
    nmea::is_sentence(&String::from_utf8_lossy(line))
}
