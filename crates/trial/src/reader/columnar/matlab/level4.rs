//! MATLAB files of level 4, which do not state their format: a sequence of variables, each with a head of five
//! numbers.
//!
//! Source of the layout: MathWorks, "MAT-File Format", chapter 2 (level 4 MAT-files).

use super::variable::{ByteCursor, NonColumnVariable, Variable, Variables, class_name, contradiction, damaged, size};
use crate::reader::error::ReadProblem;

/// Maximum length of the name of a variable with its terminator, bytes.
const MAX_NAME_BYTES: u32 = 64;

/// Codes of the number formats of level 5 in the order of the tens digit of level 4: `double`, `single`, `int32`,
/// `int16`, `uint16`, `uint8`.
const KINDS: [u32; 6] = [9, 7, 5, 3, 4, 2];

/// Head of a variable.
struct VariableHead {
    /// Kind of the numbers.
    kind: u32,
    /// 0 for numbers, 1 for text, 2 for a sparse matrix.
    class: u32,
    rows: usize,
    columns: usize,
    complex: bool,
    name: String,
}

impl VariableHead {
    /// Head of a variable at the beginning of a byte sequence; `None` for other bytes.
    fn read(scan: &mut ByteCursor) -> Option<Self> {
        let digits = scan.read_u32()?.checked_sub(if scan.big_endian { 1000 } else { 0 })?;
        let [rows, columns, complex, length] = [scan.read_u32()?, scan.read_u32()?, scan.read_u32()?, scan.read_u32()?];
        let (class, kind) = (digits % 10, *KINDS.get((digits / 10) as usize)?);
        let name = scan.take(length.min(MAX_NAME_BYTES) as usize)?.strip_suffix(&[0])?;
        let is_letter = |letter: &u8| *letter == b'_' || letter.is_ascii_alphanumeric();
        let is_head = class <= 2 && complex <= 1 && !name.is_empty() && name.iter().all(is_letter);
        let (rows, columns) = (usize::try_from(rows).ok()?, usize::try_from(columns).ok()?);
        let name = String::from_utf8_lossy(name).into_owned();
        is_head.then_some(Self { kind, class, rows, columns, complex: complex == 1, name })
    }

    /// Length of the numbers after the head, bytes; `None` if it overflows.
    fn length(&self) -> Option<usize> {
        let parts = if self.complex { 2 } else { 1 };
        self.rows.checked_mul(self.columns)?.checked_mul(parts * size(self.kind)?)
    }
}

/// `true` for a file that begins with a variable of level 4.
pub fn is_level4(bytes: &[u8]) -> bool {
    [false, true]
        .into_iter()
        .any(|big_endian| VariableHead::read(&mut ByteCursor { tail: bytes, big_endian }).is_some())
}

/// Variables of a file; all have the byte order of the first.
pub fn variables(bytes: &[u8]) -> Result<Variables, ReadProblem> {
    let (mut numeric, mut left_out) = (Vec::new(), Vec::new());
    let big_endian = VariableHead::read(&mut ByteCursor { tail: bytes, big_endian: false }).is_none();
    let mut scan = ByteCursor { tail: bytes, big_endian };
    while !scan.tail.is_empty() {
        let head = VariableHead::read(&mut scan).ok_or_else(contradiction)?;
        let data = head.length().and_then(|length| scan.take(length));
        let data = data.ok_or_else(|| damaged("its last variable is incomplete"))?;
        let VariableHead { kind, class, rows, columns, complex, name } = head;
        match class {
            0 if !complex => numeric.push(Variable::new(name, [rows, columns], kind, data, big_endian)),
            0 => left_out.push(NonColumnVariable { name, kind: format!("{rows}x{columns}") }),
            // Text is class 4 of level 5, a sparse matrix class 5.
            _ => left_out.push(NonColumnVariable { name, kind: class_name(3 + class).to_owned() }),
        }
    }
    Ok((numeric, left_out))
}
