//! Guards around third-party decoders, which trust the sizes stated in a file and panic on some damaged files. Each
//! reader sets limits on the stated sizes.

use std::cell::Cell;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

use bytes::Bytes;
use parquet::errors::Result;
use parquet::file::reader::{ChunkReader, Length};

/// Number of bytes of a page that are read for its head.
const PAGE_HEAD_BYTES: usize = 40;

/// Length of the tail of a Parquet file, bytes.
const TAIL_BYTES: u64 = 8;

thread_local! {
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
}

static QUIET: Once = Once::new();

/// Result of a decoder; `None` if it panics. The message of the panic is not shown.
pub fn catch_panic<T>(work: impl FnOnce() -> T) -> Option<T> {
    QUIET.call_once(|| {
        let hook = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |about| {
            if !IS_GUARDED.get() {
                hook(about);
            }
        }));
    });
    let before = IS_GUARDED.replace(true);
    // The work of a decoder that panics is discarded with the reader.
    let done = catch_unwind(AssertUnwindSafe(work));
    IS_GUARDED.set(before);
    done.ok()
}

/// Head of a page of a Parquet file: the sizes for which the decoder reserves memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PageHead {
    /// `true` for a dictionary page.
    pub is_dictionary: bool,
    /// Size unpacked, bytes.
    pub unpacked_bytes: u64,
    /// Size packed, bytes.
    pub packed_bytes: u64,
    /// Number of values.
    pub values: u64,
}

impl PageHead {
    /// Reads a head; `None` for bytes that are not a head.
    ///
    /// A head is a Thrift struct in compact form (Apache Parquet format, `PageHeader`): kind, size unpacked, size
    /// packed, an optional checksum, and then the head of a page of its kind, which begins with the number of values.
    fn read(head: &[u8]) -> Option<Self> {
        const NEXT_FIELD_STRUCT: u8 = 0x0c;
        const DICTIONARY: u64 = 2;
        let mut bytes = head;
        let [kind, unpacked_bytes, packed_bytes] = [(); 3].map(|()| number(&mut bytes));
        let (kind, unpacked_bytes, packed_bytes) = (whole(kind?)?, whole(unpacked_bytes?)?, whole(packed_bytes?)?);
        if bytes.first()? & 0x0f != NEXT_FIELD_STRUCT {
            number(&mut bytes)?;
        }
        let (field, inner) = bytes.split_first()?;
        bytes = inner;
        let values = whole(number(&mut bytes)?)?;
        let is_dictionary = kind == DICTIONARY;
        (field & 0x0f == NEXT_FIELD_STRUCT).then_some(Self { is_dictionary, unpacked_bytes, packed_bytes, values })
    }
}

/// Next field of a Thrift struct, still in zigzag encoding; `None` for a field that is not an integer of 32 bits.
fn number(bytes: &mut &[u8]) -> Option<u64> {
    const NEXT_FIELD_INTEGER: u8 = 0x15;
    let (&field, mut digits) = bytes.split_first()?;
    let mut zigzag = 0_u64;
    for shift in (0..35).step_by(7) {
        let (&byte, tail) = digits.split_first()?;
        digits = tail;
        zigzag |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            *bytes = digits;
            return (field == NEXT_FIELD_INTEGER).then_some(zigzag);
        }
    }
    None
}

/// Number from its zigzag encoding; `None` for a negative number.
fn whole(zigzag: u64) -> Option<u64> {
    zigzag.is_multiple_of(2).then_some(zigzag / 2)
}

/// Bytes of a Parquet file; the head of a page is checked before the page is decoded.
pub struct CheckedPages<B> {
    /// Bytes of the file.
    pub bytes: B,
    /// `true` for a page whose stated sizes are within the limits.
    pub fits: fn(PageHead) -> bool,
}

impl<B: ChunkReader> Length for CheckedPages<B> {
    fn len(&self) -> u64 {
        self.bytes.len()
    }
}

impl<B: ChunkReader> ChunkReader for CheckedPages<B> {
    type T = B::T;

    /// The decoder reads the tail of a file and the head of every page through this function.
    fn get_read(&self, start: u64) -> Result<Self::T> {
        if start.checked_add(TAIL_BYTES) != Some(self.len()) {
            let left = self.len().saturating_sub(start);
            let head = self.get_bytes(start, PAGE_HEAD_BYTES.min(usize::try_from(left)?))?;
            if !PageHead::read(&head).is_some_and(self.fits) {
                return Err(io::Error::other("the head of a page is damaged").into());
            }
        }
        self.bytes.get_read(start)
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes> {
        let end = start.checked_add(length as u64);
        if end.is_none_or(|end| end > self.len()) {
            return Err(io::Error::other("a part of it lies beyond its end").into());
        }
        self.bytes.get_bytes(start, length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_of_the_decoder_is_no_panic_of_the_program() {
        assert_eq!(catch_panic(|| 3), Some(3));
        assert_eq!(catch_panic(|| -> u8 { panic!("a decoder gave up") }), None);
        assert!(!IS_GUARDED.get());
    }

    #[test]
    fn pages_of_any_size_are_not_believed() {
        let is_page = |head: &[u8]| {
            PageHead::read(head).is_some_and(|page| page.unpacked_bytes < 1 << 24 && page.values < 1 << 20)
        };
        // A data page (kind 0) of 300 bytes, 200 packed, with 100 values; the same with a checksum of -1.
        let page = [0x15, 0x00, 0x15, 0xd8, 0x04, 0x15, 0x90, 0x03, 0x2c, 0x15, 0xc8, 0x01, 0x15, 0x00];
        let summed = [0x15, 0x00, 0x15, 0xd8, 0x04, 0x15, 0x90, 0x03, 0x15, 0x01, 0x1c, 0x15, 0xc8, 0x01, 0x15, 0x00];
        assert!(is_page(&page) && is_page(&summed));
        let huge = [0x15, 0x00, 0x15, 0xfe, 0xff, 0xff, 0xff, 0x0f, 0x15, 0x90, 0x03, 0x2c, 0x15, 0xc8, 0x01];
        let many = [0x15, 0x04, 0x15, 0xd8, 0x04, 0x15, 0x90, 0x03, 0x4c, 0x15, 0xfe, 0xff, 0xff, 0xff, 0x0f];
        let negative = [0x15, 0x00, 0x15, 0xd7, 0x04, 0x15, 0x90, 0x03, 0x2c, 0x15, 0xc8, 0x01];
        for head in [&huge[..], &many, &negative, &page[..5], &[], &[0xff; 40]] {
            assert!(!is_page(head), "{head:x?}");
        }
    }
}
