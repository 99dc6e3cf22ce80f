//! MATLAB files of level 4, which begin with no name of their format: one variable behind the other, each with a head of
//! five numbers.
//!
//! Source of the layout: MathWorks, "MAT-File Format", chapter 2 (level 4 MAT-files).

use super::{OtherVariable, Scan, Variable, Variables, class_name, contradiction, damaged};
use crate::reader::error::Problem;

/// Longest name of a variable with its end, bytes.
const MAX_NAME: u32 = 64;

/// Kinds of data elements of level 5 and bytes of the numbers, by the digit of level 4.
const STORED: [(u32, usize); 6] = [(9, 8), (7, 4), (5, 4), (3, 2), (4, 2), (2, 1)];

/// The head of a variable.
struct VariableHead {
    big_endian: bool,
    stored: (u32, usize),
    /// 0 of numbers, 1 of text, 2 of a sparse matrix.
    kind: u32,
    size: [u32; 2],
    complex: bool,
    name: String,
}

impl VariableHead {
    /// The head in front, in one order of bytes; `None` where there is none.
    fn ordered(scan: &mut Scan) -> Option<Self> {
        let [digits, rows, columns, complex, length] =
            [scan.word()?, scan.word()?, scan.word()?, scan.word()?, scan.word()?];
        let kind = digits % 10;
        let stored = *STORED.get((digits / 10 % 10) as usize)?;
        let is_head = digits / 100 == if scan.big_endian { 10 } else { 0 } && kind <= 2 && complex <= 1;
        let name = (1..=MAX_NAME).contains(&length).then(|| scan.take(length as usize)).flatten()?;
        let (end, letters) = name.split_last()?;
        let is_name =
            *end == 0 && !letters.is_empty() && letters.iter().all(|&c| c == b'_' || c.is_ascii_alphanumeric());
        let name = String::from_utf8_lossy(letters).into_owned();
        let size = [rows, columns];
        let big_endian = scan.big_endian;
        (is_head && is_name).then_some(Self { big_endian, stored, kind, size, complex: complex == 1, name })
    }

    /// The head in front, and what is behind it.
    fn of(bytes: &[u8]) -> Option<(Self, &[u8])> {
        [false, true].into_iter().find_map(|big_endian| {
            let mut scan = Scan { rest: bytes, big_endian };
            Some((Self::ordered(&mut scan)?, scan.rest))
        })
    }
}

/// Whether a file begins with a variable.
pub fn starts(bytes: &[u8]) -> bool {
    VariableHead::of(bytes).is_some()
}

/// The variables of a file.
pub fn variables(bytes: &[u8]) -> Result<Variables, Problem> {
    let (mut numeric, mut others, mut rest) = (Vec::new(), Vec::new(), bytes);
    while !rest.is_empty() {
        let (head, behind) = VariableHead::of(rest).ok_or_else(contradiction)?;
        let [rows, columns] = head.size.map(|count| count as usize);
        let length = rows.checked_mul(columns).and_then(|count| count.checked_mul(head.stored.1));
        let parts = 1 + usize::from(head.complex);
        let data = length.and_then(|length| behind.split_at_checked(length.checked_mul(parts)?));
        let (data, behind) = data.ok_or_else(|| damaged("its last variable is incomplete"))?;
        rest = behind;
        let VariableHead { big_endian, stored, name, .. } = head;
        match head.kind {
            0 if !head.complex => numeric.push(Variable::new(name, [rows, columns], stored, data, big_endian)),
            0 => others.push(OtherVariable { name, what: format!("{rows}x{columns}") }),
            // Text is class 4 of level 5, a sparse matrix class 5.
            kind => others.push(OtherVariable { name, what: class_name(3 + kind).to_owned() }),
        }
    }
    Ok((numeric, others))
}
