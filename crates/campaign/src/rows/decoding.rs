//! Guards about the Parquet decoder, which trusts sizes that a file states and panics on some of what it does not
//! expect.

use std::cell::Cell;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

thread_local! {
    static IS_GUARDED: Cell<bool> = const { Cell::new(false) };
}

static QUIET: Once = Once::new();

/// Does work of the decoder; `None` where it panics, of which nothing is shown.
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
        let [_, unpacked, _] = [number(&mut rest)?, number(&mut rest)?, number(&mut rest)?];
        let (kind, inner) = rest.split_first()?;
        rest = inner;
        Some(unpacked <= LARGEST_PAGE && matches!(kind, 0x2c | 0x4c) && number(&mut rest)? <= MOST_VALUES)
    };
    match is_page() {
        Some(true) => Ok(()),
        _ => Err(io::Error::other("the head of a page is damaged")),
    }
}

/// The next field of a Thrift struct, if it is a whole number, 0 or above.
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
            return (field == NEXT_FIELD_INTEGER && zigzag.is_multiple_of(2)).then_some(zigzag / 2);
        }
    }
    None
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
