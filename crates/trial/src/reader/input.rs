//! What kind of file it is, told from its first bytes and lines, whatever its name: packed or plain, a table or
//! sentences.

use std::io::{self, Cursor, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

use super::columnar::Kind;
use super::error::Problem;
use super::limits::RECORD;
use super::lines::{Hash, Hashed};
use super::messages::{self, MessageFormat};
use super::nmea;
use crate::file::{self, FileError, Limited};

/// Bytes and lines that are looked at to tell sentences from a table.
const LOOKED_AT: (u64, usize) = (1 << 14, 60);

/// The text of a file, from its first byte on.
pub(super) struct Text<'a> {
    pub bytes: Box<dyn Read + 'a>,
    /// The hash of the file where that is not the hash of its text.
    pub on_disk: Option<Hash>,
    /// Whether it was written here from a file that is no text.
    pub is_made: bool,
}

/// The content of a file.
pub(super) enum Content<'a> {
    /// A table.
    Table(Text<'a>),
    /// Sentences, one a line.
    Sentences(Text<'a>),
    /// Messages, one a line.
    Messages(Text<'a>, MessageFormat),
}

impl Problem {
    /// What went wrong while a file was read; a problem found by a reader below comes back as it was.
    pub(super) fn of_input(error: io::Error) -> Self {
        error.downcast::<Self>().unwrap_or_else(|error| FileError::from(error).into())
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
    let size = file.size;
    let content = recognise(Box::new(file))?;
    let plain = matches!(&content, Content::Table(text) | Content::Sentences(text) | Content::Messages(text, _) if text.on_disk.is_none());
    Ok((content, size.filter(|_| plain)))
}

/// The first bytes, as many as there are up to what is looked at, and all bytes.
fn peek<'a>(mut input: Box<dyn Read + 'a>) -> Result<(Vec<u8>, Box<dyn Read + 'a>), Problem> {
    let mut first = Vec::new();
    (&mut input).take(LOOKED_AT.0).read_to_end(&mut first).map_err(FileError::from)?;
    Ok((first.clone(), Box::new(Cursor::new(first).chain(input))))
}

/// Tells what a file holds.
///
/// Fails for formats that are recognised and not read, and for packed data that are damaged.
pub(super) fn recognise<'a>(input: Box<dyn Read + 'a>) -> Result<Content<'a>, Problem> {
    let (mut first, mut bytes) = peek(input)?;
    let mut on_disk = None;
    if first.starts_with(&[0x1f, 0x8b]) {
        let (hashed, hash) = Hashed::new(bytes);
        on_disk = Some(hash);
        let unpacked = Limited::new(Box::new(MultiGzDecoder::new(hashed)), RECORD, None);
        (first, bytes) = peek(Box::new(unpacked))?;
    }
    let refused = |format, cure| Err(Problem::Format { format, cure });
    const AS_CSV: &str = "export it as CSV";
    const MATLAB_7_3: &str = "an HDF5 file (MATLAB 7.3 writes these)";
    const AS_LEVEL_5: &str = "save it with the option `-v7`, or export it as CSV";
    const CAN_FRAMES: &str = "a log of CAN frames in hexadecimal";
    const DECODED: &str = "decode it: NMEA 2000 with canboat (`candump2analyzer` for a log of candump, then `analyzer -json`), \
                           whose lines are read; another bus to a CSV with a column for each quantity";
    const PYTHON_CAN: &str = "a log of CAN frames with data in base64, as python-can writes CSV";
    const CONVERTED: &str = "make it a log of candump with `can_logconvert LOG.csv LOG.log`, and decode that: NMEA 2000 with canboat \
                             (`candump2analyzer`, then `analyzer -json`), whose lines are read; another bus to a CSV with a column for \
                             each quantity";
    if let Some(kind) = Kind::of(&first) {
        let mut all = Vec::new();
        bytes.read_to_end(&mut all).map_err(FileError::from)?;
        let hash = on_disk.unwrap_or_else(|| Hash::of(&all));
        return Ok(Content::Table(Text { bytes: kind.text(all)?, on_disk: Some(hash), is_made: true }));
    }
    match first.as_slice() {
        [0xd0, 0xcf, 0x11, 0xe0, ..] => refused("an old spreadsheet (XLS)", AS_CSV),
        [b'P', b'A', b'R', b'E', ..] => refused("an encrypted Parquet file", "write it without encryption"),
        [0x89, b'H', b'D', b'F', ..] => refused(MATLAB_7_3, AS_LEVEL_5),
        start if start.starts_with(b"MATLAB 7.3") => refused(MATLAB_7_3, AS_LEVEL_5),
        start => {
            let text = String::from_utf8_lossy(start);
            let lines = text.lines().take(LOOKED_AT.1);
            let has_sentence = lines.clone().any(nmea::is_sentence);
            let format = if has_sentence { None } else { messages::format(lines.clone()) };
            if format.is_none() && !has_sentence && messages::is_can_log(lines.clone()) {
                return refused(CAN_FRAMES, DECODED);
            }
            if format.is_none() && !has_sentence && messages::is_python_can(lines) {
                return refused(PYTHON_CAN, CONVERTED);
            }
            let text = Text { bytes, on_disk, is_made: false };
            Ok(match format {
                _ if has_sentence => Content::Sentences(text),
                Some(format) => Content::Messages(text, format),
                None => Content::Table(text),
            })
        }
    }
}
