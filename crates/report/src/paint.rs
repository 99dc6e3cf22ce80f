//! A colour on the page.

/// Red, green and blue, 0 to 255 each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Paint(pub u8, pub u8, pub u8);
