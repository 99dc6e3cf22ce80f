//! Guards about decoders that trust what a file states: their panics are caught, and the head of a page of a Parquet
//! file is looked at before the decoder reserves what it states.

use std::cell::Cell;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

use bytes::Bytes;
use parquet::errors::Result;
use parquet::file::reader::{ChunkReader, Length};

thread_local! {
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
}

static QUIET: Once = Once::new();

/// Does work of a decoder; `None` where it panics, of which nothing is shown.
pub fn guarded<T>(work: impl FnOnce() -> T) -> Option<T> {
    QUIET.call_once(|| {
        let hook = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |about| {
            if !IS_GUARDED.get() {
                hook(about);
            }
        }));
    });
    let before = IS_GUARDED.replace(true);
    // What the work has changed is thrown away with the reader when it panics.
    let done = catch_unwind(AssertUnwindSafe(work));
    IS_GUARDED.set(before);
    done.ok()
}

/// Largest size of a page before it is packed, bytes: some programs write a column of all rows as one page.
const LARGEST_PAGE: u64 = 8 * crate::reader::MAX_ROWS as u64;

/// A page up to this size, bytes, may be packed to nothing.
const SMALL_PAGE: u64 = 1 << 24;

/// How often the size of what is packed a larger page may have; deflate reaches 1032.
const MOST_PACKED: u64 = 1100;

/// Most values of a dictionary; the decoder reserves some forty bytes for each.
const MOST_WORDS: u64 = 1 << 22;

/// Bytes at the beginning of a page that are looked at.
const PAGE_HEAD: usize = 40;

/// Length of the tail of a Parquet file, bytes.
const TAIL: u64 = 8;

/// The bytes of a Parquet file, whose pages are looked at before they are given out.
pub struct Checked(pub Bytes);

impl Length for Checked {
    fn len(&self) -> u64 {
        Length::len(&self.0)
    }
}

impl ChunkReader for Checked {
    type T = <Bytes as ChunkReader>::T;

    /// The decoder asks in this way for the tail of a file and for the head of every page.
    fn get_read(&self, start: u64) -> Result<Self::T> {
        if start.checked_add(TAIL) != Some(Length::len(self)) {
            let left = Length::len(self).saturating_sub(start);
            let head = self.get_bytes(start, PAGE_HEAD.min(usize::try_from(left)?))?;
            if !is_page(&head) {
                return Err(io::Error::other("the head of a page is damaged").into());
            }
        }
        self.0.get_read(start)
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes> {
        let end = start.checked_add(length as u64);
        if end.is_none_or(|end| end > Length::len(self)) {
            return Err(io::Error::other("a part of it lies beyond its end").into());
        }
        self.0.get_bytes(start, length)
    }
}

/// Whether bytes may be the head of a page.
///
/// A head is a Thrift struct in compact form (Apache Parquet format, `PageHeader`): kind, size unpacked, size packed,
/// perhaps a checksum, and then the head of a page of its kind, which begins with the number of values.
fn is_page(head: &[u8]) -> bool {
    const NEXT_FIELD_STRUCT: u8 = 0x0c;
    const DICTIONARY: u64 = 2;
    let read = || {
        let mut rest = head;
        let [kind, unpacked, packed] = [(); 3].map(|()| number(&mut rest));
        let (kind, unpacked, packed) = (whole(kind?)?, whole(unpacked?)?, whole(packed?)?);
        if rest.first()? & 0x0f != NEXT_FIELD_STRUCT {
            number(&mut rest)?;
        }
        let (field, inner) = rest.split_first()?;
        rest = inner;
        let values = whole(number(&mut rest)?)?;
        let fits = unpacked <= SMALL_PAGE.max(packed.saturating_mul(MOST_PACKED)) && unpacked <= LARGEST_PAGE;
        let few = kind != DICTIONARY || values <= MOST_WORDS.min(unpacked);
        Some(field & 0x0f == NEXT_FIELD_STRUCT && fits && few)
    };
    read() == Some(true)
}

/// The next field of a Thrift struct, if it is a whole number, still zigzag.
fn number(bytes: &mut &[u8]) -> Option<u64> {
    const NEXT_FIELD_INTEGER: u8 = 0x15;
    let (&field, mut rest) = bytes.split_first()?;
    let mut zigzag = 0_u64;
    for shift in (0..35).step_by(7) {
        let (&byte, tail) = rest.split_first()?;
        rest = tail;
        zigzag |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            *bytes = rest;
            return (field == NEXT_FIELD_INTEGER).then_some(zigzag);
        }
    }
    None
}

/// A zigzag number, if it is 0 or above.
fn whole(zigzag: u64) -> Option<u64> {
    zigzag.is_multiple_of(2).then_some(zigzag / 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_of_the_decoder_is_no_panic_of_the_program() {
        assert_eq!(guarded(|| 3), Some(3));
        assert_eq!(guarded(|| -> u8 { panic!("a decoder gave up") }), None);
        assert!(!IS_GUARDED.get());
    }

    #[test]
    fn pages_of_any_size_are_not_believed() {
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
