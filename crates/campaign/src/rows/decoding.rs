//! What the pages of stored rows may state: the Parquet decoder trusts their heads.

use std::io;

use trial::decoder::{number, whole};

/// Bytes of a page before it is packed, at most; the writer begins a new page at about one megabyte.
const LARGEST_PAGE: u64 = 1 << 24;

/// Values of a page, at most.
const MOST_VALUES: u64 = 1 << 20;

/// Bytes at the beginning of a page that [`check_page`] looks at.
pub const PAGE_HEAD: usize = 40;

/// Refuses a page whose head states more than any page of a study has: the decoder would reserve it.
///
/// A head is a Thrift struct in compact form (Apache Parquet format, `PageHeader`): kind, size unpacked, size packed,
/// and then the head of a data page (field 5) or of a dictionary (field 7), which begins with the number of values.
pub fn check_page(head: &[u8]) -> io::Result<()> {
    let is_page = || {
        let mut rest = head;
        let mut field = || whole(number(&mut rest)?);
        let [_, unpacked, _] = [field()?, field()?, field()?];
        let (kind, inner) = rest.split_first()?;
        rest = inner;
        Some(unpacked <= LARGEST_PAGE && matches!(kind, 0x2c | 0x4c) && whole(number(&mut rest)?)? <= MOST_VALUES)
    };
    match is_page() {
        Some(true) => Ok(()),
        _ => Err(io::Error::other("the head of a page is damaged")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_of_any_size_are_not_believed() {
        // A data page (kind 0) of 300 bytes, 200 packed, with 100 values.
        let page = [0x15, 0x00, 0x15, 0xd8, 0x04, 0x15, 0x90, 0x03, 0x2c, 0x15, 0xc8, 0x01, 0x15, 0x00];
        assert!(check_page(&page).is_ok());
        let huge = [0x15, 0x00, 0x15, 0xfe, 0xff, 0xff, 0xff, 0x0f, 0x15, 0x90, 0x03, 0x2c, 0x15, 0xc8, 0x01];
        let many = [0x15, 0x04, 0x15, 0xd8, 0x04, 0x15, 0x90, 0x03, 0x4c, 0x15, 0xfe, 0xff, 0xff, 0xff, 0x0f];
        let negative = [0x15, 0x00, 0x15, 0xd7, 0x04, 0x15, 0x90, 0x03, 0x2c, 0x15, 0xc8, 0x01];
        for head in [&huge[..], &many, &negative, &page[..5], &[], &[0xff; 40]] {
            assert!(check_page(head).is_err(), "{head:x?}");
        }
    }
}
