//! Variables of MATLAB files of either level, and their bytes.

use crate::reader::columnar::text;
use crate::reader::error::ReadProblem;

/// Kind of a data element that contains a compressed data element.
pub const COMPRESSED: u32 = 15;

/// Size of a number by the kind of its data element, bytes; `None` for a kind without numbers.
pub fn size(kind: u32) -> Option<usize> {
    Some(match kind {
        1 | 2 => 1,
        3 | 4 => 2,
        5..=7 => 4,
        9 | 12 | 13 => 8,
        _ => return None,
    })
}

/// Numeric variable.
pub struct Variable {
    pub name: String,
    pub rows: usize,
    pub columns: usize,
    /// Kind of the numbers.
    kind: u32,
    /// Numbers, column by column.
    bytes: Vec<u8>,
    big_endian: bool,
}

/// Variable that is not a column, with its kind for messages.
pub struct NonColumnVariable {
    pub name: String,
    pub kind: String,
}

/// Variables of a file that are columns, and all other variables.
pub type Variables = (Vec<Variable>, Vec<NonColumnVariable>);

/// Name of a cell array in messages.
pub const CELL_ARRAY: &str = "a cell array";

/// Name of a class without numbers in messages.
pub fn class_name(class: u32) -> &'static str {
    match class {
        1 => CELL_ARRAY,
        2 => "a structure",
        4 => "text",
        5 => "a sparse matrix",
        _ => "a variable without numbers",
    }
}

/// Cursor over bytes, read from the front.
pub struct ByteCursor<'a> {
    pub tail: &'a [u8],
    pub big_endian: bool,
}

impl<'a> ByteCursor<'a> {
    pub fn take(&mut self, length: usize) -> Option<&'a [u8]> {
        let (taken, tail) = self.tail.split_at_checked(length)?;
        self.tail = tail;
        Some(taken)
    }

    /// Next 32-bit unsigned integer, in the byte order of the file; `None` if fewer than four bytes are left.
    pub fn read_u32(&mut self) -> Option<u32> {
        let bytes = self.take(4)?.try_into().ok()?;
        Some(if self.big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }

    /// Next data element: its kind and its bytes; `None` if it is incomplete. Padding to eight bytes is skipped.
    pub fn element(&mut self) -> Option<(u32, &'a [u8])> {
        let tag = self.read_u32()?;
        if tag >> 16 != 0 {
            // Short elements are in their own tag.
            let data = self.take(4)?;
            return Some((tag & 0xffff, data.get(..(tag >> 16) as usize)?));
        }
        let length = self.read_u32()? as usize;
        let data = self.take(length)?;
        if tag != COMPRESSED {
            let filling = (8 - length % 8) % 8;
            self.tail = self.tail.get(filling..).unwrap_or_default();
        }
        Some((tag, data))
    }
}

/// Problem of a damaged MATLAB file.
pub fn damaged(damage: &str) -> ReadProblem {
    ReadProblem::Damaged { format: "a MATLAB file", damage: damage.to_owned() }
}

/// Problem of a variable whose stated sizes disagree.
pub fn contradiction() -> ReadProblem {
    damaged("a variable of it contradicts itself")
}

impl Variable {
    /// Variable of a size (rows, columns); a single row becomes a column.
    pub fn new(name: String, size: [usize; 2], kind: u32, numbers: &[u8], big_endian: bool) -> Self {
        let [rows, columns] = if size[0] == 1 { [size[1], 1] } else { size };
        Self { name, rows, columns, kind, bytes: numbers.to_vec(), big_endian }
    }

    /// Appends the number with an index, column by column from 0, to a text; no change beyond the last number.
    pub fn write(&self, text: &mut String, index: usize) {
        let size = size(self.kind).unwrap_or(0);
        let mut bytes = [0; 8];
        let Some(stored) = self.bytes.get(index * size..(index + 1) * size) else { return };
        bytes[..size].copy_from_slice(stored);
        if self.big_endian {
            bytes[..size].reverse();
        }
        let all = u64::from_le_bytes(bytes);
        match self.kind {
            1 => text::write_integer(text, all as i8),
            3 => text::write_integer(text, all as i16),
            5 => text::write_integer(text, all as i32),
            12 => text::write_integer(text, all as i64),
            7 => text::write_single(text, f32::from_bits(all as u32)),
            9 => text::write_number(text, f64::from_bits(all)),
            _ => text::write_integer(text, all),
        }
    }
}
