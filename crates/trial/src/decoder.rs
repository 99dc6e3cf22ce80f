//! Guards about decoders of others, which trust what a file states and panic on some of what they do not expect. What a
//! file may state is for each reader to decide.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;

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

/// The next field of a Thrift struct, if it is a whole number, still zigzag.
pub fn number(bytes: &mut &[u8]) -> Option<u64> {
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
pub fn whole(zigzag: u64) -> Option<u64> {
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
}
