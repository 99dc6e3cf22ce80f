//! The head of a page of a Parquet file is looked at before the decoder reserves what it states.

use std::io;

use bytes::Bytes;
use parquet::errors::Result;
use parquet::file::reader::{ChunkReader, Length};

use crate::decoder::{number, whole};

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

#[cfg(test)]
mod tests {
    use super::*;

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
