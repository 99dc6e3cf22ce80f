//! Kind of a file by its first bytes and lines, not by its name: compressed or plain, table, sentences or messages.

use std::io::{self, Cursor, Read};
use std::path::Path;

use flate2::read::MultiGzDecoder;

use super::columnar::BinaryFormat;
use super::error::ReadProblem;
use super::limits::RECORD_FILE;
use super::lines::{HashingReader, RunningHash};
use super::messages::{self, MessageFormat};
use super::nmea;
use crate::file::{self, FileError, LimitedReader};

/// Number of bytes at the beginning of a file from which its content is recognised.
const HEAD_BYTES: u64 = 1 << 14;

/// Maximum number of lines in these bytes that are searched for sentences and messages.
const HEAD_LINES: usize = 60;

/// Text of a file, from its first byte on.
pub(super) struct Text<'a> {
    pub bytes: Box<dyn Read + 'a>,
    /// Hash of the file; `None` if it is the hash of the text.
    pub file_hash: Option<RunningHash>,
    /// `true` for a text that was generated here from a binary table.
    pub is_generated: bool,
}

/// Content of a file.
pub(super) enum FileContent<'a> {
    /// Table.
    Table(Text<'a>),
    /// Sentences, one per line.
    Sentences(Text<'a>),
    /// Messages, one per line.
    Messages(Text<'a>, MessageFormat),
}

impl ReadProblem {
    /// Problem of an input error; a problem that a decoder wrapped in the error is unwrapped.
    pub(super) fn from_input(error: io::Error) -> Self {
        error.downcast::<Self>().unwrap_or_else(|error| FileError::from(error).into())
    }
}

/// Name of a record: the name of its file without its endings.
pub(super) fn stem(path: &Path) -> String {
    let packed = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    let inner = if packed { path.with_extension("") } else { path.to_path_buf() };
    inner.file_stem().map_or_else(|| "record".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Opens a file and recognises its content. The size (bytes) is `None` for a pipe, and if the text has another length
/// than the file. Fails as [`file::open`] and [`detect_content`] do.
pub(super) fn open(path: &Path) -> Result<(FileContent<'static>, Option<u64>), ReadProblem> {
    let file = file::open(path, RECORD_FILE)?;
    let (size, content) = (file.size, detect_content(Box::new(file))?);
    let (FileContent::Table(text) | FileContent::Sentences(text) | FileContent::Messages(text, _)) = &content;
    let size = size.filter(|_| text.file_hash.is_none());
    Ok((content, size))
}

/// First bytes of an input, and all its bytes.
fn peek<'a>(mut input: Box<dyn Read + 'a>) -> Result<(Vec<u8>, Box<dyn Read + 'a>), ReadProblem> {
    let mut first = Vec::new();
    (&mut input).take(HEAD_BYTES).read_to_end(&mut first).map_err(FileError::from)?;
    Ok((first.clone(), Box::new(Cursor::new(first).chain(input))))
}

/// Recognises the content of a file.
///
/// Fails for formats that are recognised but not read, and for damaged compressed data.
pub(super) fn detect_content<'a>(input: Box<dyn Read + 'a>) -> Result<FileContent<'a>, ReadProblem> {
    let (mut first, mut bytes) = peek(input)?;
    let mut file_hash = None;
    if first.starts_with(&[0x1f, 0x8b]) {
        let (hashed, hash) = HashingReader::new(bytes);
        file_hash = Some(hash);
        let unpacked = LimitedReader::new(Box::new(MultiGzDecoder::new(hashed)), RECORD_FILE, None);
        (first, bytes) = peek(Box::new(unpacked))?;
    }
    let refused = |format, cure| Err(ReadProblem::Format { format, cure });
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
    if let Some(kind) = BinaryFormat::detect(&first) {
        let mut all = Vec::new();
        bytes.read_to_end(&mut all).map_err(FileError::from)?;
        let hash = file_hash.unwrap_or_else(|| RunningHash::from_bytes(&all));
        return Ok(FileContent::Table(Text {
            bytes: kind.read_as_text(all)?,
            file_hash: Some(hash),
            is_generated: true,
        }));
    }
    match first.as_slice() {
        [0xd0, 0xcf, 0x11, 0xe0, ..] => refused("an old spreadsheet (XLS)", AS_CSV),
        [b'P', b'A', b'R', b'E', ..] => refused("an encrypted Parquet file", "write it without encryption"),
        [0x89, b'H', b'D', b'F', ..] => refused(MATLAB_7_3, AS_LEVEL_5),
        start if start.starts_with(b"MATLAB 7.3") => refused(MATLAB_7_3, AS_LEVEL_5),
        start => {
            let text = String::from_utf8_lossy(start);
            let lines = text.lines().take(HEAD_LINES);
            let has_sentence = lines.clone().any(nmea::is_sentence);
            let format = if has_sentence { None } else { messages::format(lines.clone()) };
            if format.is_none() && !has_sentence && messages::is_can_log(lines.clone()) {
                return refused(CAN_FRAMES, DECODED);
            }
            if format.is_none() && !has_sentence && messages::is_python_can(lines) {
                return refused(PYTHON_CAN, CONVERTED);
            }
            let text = Text { bytes, file_hash, is_generated: false };
            Ok(match format {
                _ if has_sentence => FileContent::Sentences(text),
                Some(format) => FileContent::Messages(text, format),
                None => FileContent::Table(text),
            })
        }
    }
}
