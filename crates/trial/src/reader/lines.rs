//! Lines of a file: bytes are hashed, checked to be text, cut at line ends and decoded, with a single line in memory.

use std::cell::RefCell;
use std::io::{BufRead, BufReader, Read};
use std::rc::Rc;

use sha2::{Digest, Sha256};

use super::error::ReadProblem;
use crate::encoding::{Encoding, windows_1252};

/// Maximum length of a line of a table, bytes.
pub const MAX_LINE_BYTES: usize = 1 << 20;

/// SHA-256 of the bytes read so far, shared with the reader that updates it.
#[derive(Clone, Default)]
pub struct RunningHash(Rc<RefCell<Sha256>>);

impl RunningHash {
    /// SHA-256 state that already contains `bytes`, for a file held in memory.
    pub fn from_bytes(bytes: &[u8]) -> Self {
        Self(Rc::new(RefCell::new(Sha256::new_with_prefix(bytes))))
    }

    /// SHA-256 of the bytes so far, 64 hexadecimal digits; after the last byte it identifies the file.
    pub fn finish(self) -> String {
        format!("{:x}", self.0.take().finalize())
    }
}

/// Reader that hashes its bytes in large pieces, which is faster than line by line.
pub struct HashingReader<R> {
    input: R,
    hash: RunningHash,
}

impl<R> HashingReader<R> {
    pub fn new(input: R) -> (Self, RunningHash) {
        let hash = RunningHash::default();
        (Self { input, hash: hash.clone() }, hash)
    }
}

impl<R: Read> Read for HashingReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let length = self.input.read(buffer)?;
        self.hash.0.borrow_mut().update(&buffer[..length]);
        Ok(length)
    }
}

/// Lines of a file, in order.
pub struct Lines<R> {
    input: BufReader<HashingReader<R>>,
    hash: RunningHash,
    encoding: Encoding,
    /// Byte at which lines end, determined with the first line.
    end: u8,
    bytes: Vec<u8>,
    text: String,
    number: usize,
    consumed: u64,
}

impl<R: Read> Lines<R> {
    /// Lines of `input` in `encoding`.
    pub fn new(input: R, encoding: Encoding) -> Self {
        let (hashed, hash) = HashingReader::new(input);
        let input = BufReader::with_capacity(1 << 16, hashed);
        Self { input, hash, encoding, end: b'\n', bytes: Vec::new(), text: String::new(), number: 0, consumed: 0 }
    }

    /// Number of the line read last, from 1; 0 before the first.
    pub fn line_number(&self) -> usize {
        self.number
    }

    /// Number of bytes read so far.
    pub fn consumed_bytes(&self) -> u64 {
        self.consumed
    }

    /// Reads the bytes of a line, or the beginning of a line that is too long, without line end and byte order mark.
    /// Returns the number of bytes read and `true` for a complete line; `None` at the end of the file.
    fn take_line(&mut self) -> Result<Option<(usize, bool)>, ReadProblem> {
        self.bytes.clear();
        if self.number == 0 {
            // Old Macintosh programs end lines with a carriage return alone.
            let begin = self.input.fill_buf().map_err(ReadProblem::from_input)?;
            self.end = if begin.contains(&b'\r') && !begin.contains(&b'\n') { b'\r' } else { b'\n' };
        }
        let mut limited = (&mut self.input).take(MAX_LINE_BYTES as u64 + 1);
        let length = limited.read_until(self.end, &mut self.bytes).map_err(ReadProblem::from_input)?;
        self.number += usize::from(length > 0);
        self.consumed += length as u64;
        let whole = length <= MAX_LINE_BYTES || self.bytes.last() == Some(&self.end);
        if self.number == 1 && self.bytes.starts_with(&[0xef, 0xbb, 0xbf]) {
            self.bytes.drain(..3);
        }
        while matches!(self.bytes.last(), Some(b'\n' | b'\r')) {
            self.bytes.pop();
        }
        Ok((length > 0).then_some((length, whole)))
    }

    /// Skips a line without decoding it; `false` at the end of the file.
    ///
    /// Fails for UTF-16, for a zero byte, and for a line longer than [`MAX_LINE_BYTES`].
    pub fn skip(&mut self) -> Result<bool, ReadProblem> {
        let Some((length, _)) = self.take_line()? else { return Ok(false) };
        let line = self.number;
        if line == 1 && (self.bytes.starts_with(&[0xff, 0xfe]) || self.bytes.starts_with(&[0xfe, 0xff])) {
            return Err(ReadProblem::Utf16);
        }
        if self.bytes.contains(&0) {
            return Err(ReadProblem::Binary { line });
        }
        if length > MAX_LINE_BYTES {
            return Err(ReadProblem::LongLine { line, limit: MAX_LINE_BYTES });
        }
        Ok(true)
    }

    /// Next line without its end; `None` at the end of the file. Fails as [`skip`](Self::skip) does, and for bytes that
    /// are not text in the encoding.
    pub fn next_line(&mut self) -> Result<Option<&str>, ReadProblem> {
        if !self.skip()? {
            return Ok(None);
        }
        if self.encoding == Encoding::Utf8 {
            let valid = std::str::from_utf8(&self.bytes).map_or_else(|error| error.valid_up_to(), str::len);
            if valid == self.bytes.len() {
                return Ok(std::str::from_utf8(&self.bytes).ok());
            }
            // Only the degree sign and accented letters are decoded as Windows 1252, as written by old programs.
            if self.bytes.iter().any(|byte| matches!(byte, 0x80..=0x9f)) {
                return Err(ReadProblem::NotUtf8 { line: self.number, byte: self.bytes[valid] });
            }
        }
        self.text.clear();
        self.text.extend(self.bytes.iter().map(|&byte| windows_1252(byte)));
        Ok(Some(&self.text))
    }

    /// Bytes of the next line without its end, text or not: for logs, in which noise damages a line and not the file.
    ///
    /// A line longer than [`MAX_LINE_BYTES`] is cut one byte beyond that, and its remainder is skipped; `None` at the
    /// end of the file.
    pub fn next_line_bytes(&mut self) -> Result<Option<&[u8]>, ReadProblem> {
        let Some((_, whole)) = self.take_line()? else { return Ok(None) };
        if !whole {
            self.consumed += self.input.skip_until(self.end).map_err(ReadProblem::from_input)? as u64;
        }
        Ok(Some(&self.bytes))
    }

    /// SHA-256 of all bytes read, hexadecimal; the hash of the file after its last line.
    pub fn sha256(self) -> String {
        self.hash.finish()
    }
}

/// SHA-256 of bytes, 64 hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    RunningHash::from_bytes(bytes).finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_ends_byte_order_mark_and_hash() {
        let mut lines = Lines::new(&b"\xef\xbb\xbfa\r\nb\n\nc"[..], Encoding::Utf8);
        assert_eq!(lines.next_line().expect("text"), Some("a"));
        assert_eq!(lines.next_line().expect("text"), Some("b"));
        assert_eq!(lines.next_line().expect("text"), Some(""));
        assert_eq!(lines.next_line().expect("text"), Some("c"));
        assert_eq!(lines.next_line().expect("text"), None);
        assert_eq!((lines.line_number(), lines.consumed_bytes()), (4, 10));
        let mut lines = Lines::new(&b"a\rb\r"[..], Encoding::Utf8);
        let mut next = || lines.next_line().expect("text").map(str::to_owned);
        assert_eq!([(); 3].map(|()| next()), [Some("a".to_owned()), Some("b".to_owned()), None]);
        // The digest of "abc" is the first example of FIPS 180-2, appendix B.1.
        let mut lines = Lines::new(&b"abc"[..], Encoding::Utf8);
        lines.next_line().expect("text");
        assert_eq!(lines.sha256(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }

    #[test]
    fn windows_1252_is_decoded_where_it_is_declared_or_plain() {
        let mut lines = Lines::new(&b"Z20\xb0 \x80\x9f"[..], Encoding::Windows1252);
        assert_eq!(lines.next_line().expect("text"), Some("Z20° €Ÿ"));
        let mut lines = Lines::new(&b"Z20\xb0\n\x80 5\n"[..], Encoding::Utf8);
        assert_eq!(lines.next_line().expect("text"), Some("Z20°"));
        assert!(matches!(lines.next_line(), Err(ReadProblem::NotUtf8 { line: 2, byte: 0x80 })));
    }

    #[test]
    fn bytes_of_a_log_are_given_whatever_they_are() {
        let mut file = b"\xef\xbb\xbf$A\r\nb\0\xffc\n".to_vec();
        file.extend(vec![b'7'; 3 * MAX_LINE_BYTES]);
        file.extend(b"\nlast");
        let mut lines = Lines::new(&file[..], Encoding::Utf8);
        assert_eq!(lines.next_line_bytes().expect("bytes"), Some(&b"$A"[..]));
        assert_eq!(lines.next_line_bytes().expect("bytes"), Some(&b"b\0\xffc"[..]));
        assert_eq!(lines.next_line_bytes().expect("bytes").map(<[u8]>::len), Some(MAX_LINE_BYTES + 1));
        assert_eq!(lines.next_line_bytes().expect("bytes"), Some(&b"last"[..]));
        assert_eq!(lines.next_line_bytes().expect("bytes"), None);
        assert_eq!((lines.line_number(), lines.consumed_bytes()), (4, file.len() as u64));
        let mut table = Lines::new(&file[..], Encoding::Utf8);
        assert_eq!(table.next_line().expect("text"), Some("$A"));
        let whole: String = Sha256::digest(&file).iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(lines.sha256(), whole);
    }

    #[test]
    fn a_line_without_end_is_refused_before_it_fills_the_memory() {
        let mut lines = Lines::new(std::io::repeat(b'7'), Encoding::Utf8);
        assert!(matches!(lines.next_line(), Err(ReadProblem::LongLine { line: 1, .. })));
        let mut lines = Lines::new(&b"a\nb\0c\n"[..], Encoding::Utf8);
        lines.next_line().expect("text");
        assert!(matches!(lines.next_line(), Err(ReadProblem::Binary { line: 2 })));
    }
}
