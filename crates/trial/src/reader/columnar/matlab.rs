//! MATLAB files of level 5 (`save -v6`, `-v7`) and level 4 (`save -v4`) as text: numeric variables of equal length are
//! the columns of a table. Texts, cells, structures, sparse and complex variables and those of more than two dimensions
//! are omitted; a cell array with the name of a quantity in no other variable is refused.
//!
//! Source of the layout: MathWorks, "MAT-File Format", chapter 1 (level 5 MAT-files).

mod level4;
mod variable;

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::text::{self, ChunkReader};
use crate::file::FileError;
use crate::names::{self, ColumnMeaning};
use crate::reader::error::ReadProblem;
use crate::reader::{MAX_CELLS, RECORD_FILE};
use variable::{
    ByteCursor, CELL_ARRAY, COMPRESSED, NonColumnVariable, Variable, Variables, class_name, contradiction, damaged,
    size,
};

pub use level4::is_level4;

/// Length of the head of a file, bytes.
const HEAD_BYTES: usize = 128;

/// Length of an unpacked variable up to the end of the flags, bytes.
const FLAGS_END_BYTES: usize = 24;

/// Length of an unpacked variable up to the end of the name, bytes, for every class.
const NAME_END_BYTES: usize = 192;

/// Maximum size of all unpacked variables, bytes.
const MAX_UNPACKED_BYTES: u64 = 8 * MAX_CELLS as u64;

/// Kind of a data element with a variable.
const MATRIX: u32 = 14;

/// Class of the numbers of a variable, and `true` for complex numbers.
fn flags(word: u32) -> (u32, bool) {
    (word & 0xff, word & 0x0800 != 0)
}

fn is_numeric(class: u32) -> bool {
    (6..=15).contains(&class)
}

/// Variable, or the description of a variable without numbers; `None` for bytes that are not a variable.
fn variable(bytes: &[u8], big_endian: bool) -> Option<Result<Variable, NonColumnVariable>> {
    let mut scan = ByteCursor { tail: bytes, big_endian };
    let (_, flag_bytes) = scan.element()?;
    let (class, complex) = flags(ByteCursor { tail: flag_bytes, big_endian }.read_u32()?);
    if !is_numeric(class) {
        let name = scan.element().and_then(|_| scan.element()).map(|(_, name)| String::from_utf8_lossy(name));
        let name = name.map_or_else(String::new, |name| name.into_owned());
        return Some(Err(NonColumnVariable { name, kind: class_name(class).to_owned() }));
    }
    let mut sizes = ByteCursor { tail: scan.element()?.1, big_endian };
    let mut dimensions = Vec::new();
    while !sizes.tail.is_empty() {
        dimensions.push(usize::try_from(sizes.read_u32()?).ok()?);
    }
    let name = String::from_utf8_lossy(scan.element()?.1).into_owned();
    let sizes = dimensions.iter().map(usize::to_string).collect::<Vec<_>>().join("x");
    // MATLAB stores objects in a variable of bytes without a name.
    if name.is_empty() || complex || dimensions.len() != 2 {
        return Some(Err(NonColumnVariable { name, kind: sizes }));
    }
    let (kind, data) = scan.element()?;
    let [rows, columns] = *dimensions.first_chunk()?;
    (rows.checked_mul(columns)?.checked_mul(size(kind)?)? == data.len()).then_some(())?;
    Some(Ok(Variable::new(name, [rows, columns], kind, data, big_endian)))
}

/// Unpacks a variable with its tag; if it has no numbers, only up to its name. `left` is the number of bytes that may
/// still be unpacked.
fn unpacked(packed: &[u8], big_endian: bool, left: &mut u64) -> Result<Vec<u8>, ReadProblem> {
    let mut decoder = ZlibDecoder::new(packed);
    let mut bytes = Vec::new();
    let mut read = |bytes: &mut Vec<u8>, most: u64| {
        let from = bytes.len() as u64;
        let result = (&mut decoder).take(most).read_to_end(bytes);
        *left = left.saturating_sub(bytes.len() as u64 - from);
        result.map(|_| *left).map_err(|_| damaged("a variable cannot be unpacked"))
    };
    read(&mut bytes, FLAGS_END_BYTES as u64)?;
    let flag_word = bytes.get(16..20).and_then(|word| ByteCursor { tail: word, big_endian }.read_u32());
    if flag_word.is_some_and(|word| is_numeric(flags(word).0)) {
        let length = ByteCursor { tail: &bytes[4..], big_endian }.read_u32().unwrap_or(0);
        let remaining = (u64::from(length) + 8).saturating_sub(FLAGS_END_BYTES as u64);
        if read(&mut bytes, remaining.min(MAX_UNPACKED_BYTES))? == 0 {
            return Err(FileError::TooLarge { kind: RECORD_FILE, size: None }.into());
        }
    } else {
        read(&mut bytes, (NAME_END_BYTES - FLAGS_END_BYTES) as u64)?;
    }
    Ok(bytes)
}

/// Variables of a file of level 5.
fn variables(bytes: &[u8]) -> Result<Variables, ReadProblem> {
    let big_endian = match bytes.get(HEAD_BYTES - 2..HEAD_BYTES) {
        Some(b"IM") => false,
        Some(b"MI") => true,
        _ => return Err(damaged("its head is incomplete")),
    };
    let mut scan = ByteCursor { tail: &bytes[HEAD_BYTES..], big_endian };
    let (mut numeric, mut left_out) = (Vec::new(), Vec::new());
    let mut left = MAX_UNPACKED_BYTES;
    while !scan.tail.is_empty() {
        let (kind, data) = scan.element().ok_or_else(|| damaged("its last variable is incomplete"))?;
        let unpacked = match kind {
            COMPRESSED => unpacked(data, big_endian, &mut left)?,
            MATRIX => Vec::new(),
            _ => continue,
        };
        let mut inner = ByteCursor { tail: &unpacked, big_endian };
        let content = match kind {
            COMPRESSED => inner.read_u32().zip(inner.read_u32()).filter(|pair| pair.0 == MATRIX).map(|_| inner.tail),
            _ => Some(data),
        };
        match content.and_then(|content| variable(content, big_endian)).ok_or_else(contradiction)? {
            Ok(variable) => numeric.push(variable),
            Err(variable) => left_out.push(variable),
        }
    }
    Ok((numeric, left_out))
}

/// Reader of a MATLAB file as tab-separated text: the variables of the length that has the most recognised names, at
/// equality the most numbers.
///
/// Fails for a damaged file, for a file without numeric variables of at least two rows, and for a cell array with the
/// name of a quantity in no other variable.
pub fn read_as_text(bytes: Vec<u8>) -> Result<Box<dyn Read>, ReadProblem> {
    let (numeric, left_out) = if is_level4(&bytes) { level4::variables(&bytes)? } else { variables(&bytes)? };
    let quantity = |name: &str| match names::column_meaning(name)? {
        ColumnMeaning::Channel(channel, _) => Some(ColumnMeaning::Channel(channel, None)),
        ColumnMeaning::Time(_) => Some(ColumnMeaning::Time(None)),
        _ => None,
    };
    let is_lacking = |cell: &&NonColumnVariable| {
        let wanted = quantity(&cell.name);
        cell.kind == CELL_ARRAY && wanted.is_some() && numeric.iter().all(|variable| quantity(&variable.name) != wanted)
    };
    if let Some(cell) = left_out.iter().find(is_lacking) {
        return Err(ReadProblem::CellArray { column: cell.name.clone() });
    }
    let worth = |rows: usize| {
        let of_length = || numeric.iter().filter(|variable| variable.rows == rows);
        let named = of_length().filter(|variable| names::column_meaning(&variable.name).is_some()).count();
        (named, rows * of_length().map(|variable| variable.columns).sum::<usize>(), rows)
    };
    let mut lengths: Vec<usize> = numeric.iter().map(|variable| variable.rows).filter(|&rows| rows > 1).collect();
    lengths.sort_unstable();
    lengths.dedup();
    let Some(length) = lengths.into_iter().max_by_key(|&rows| worth(rows)) else {
        let sizes = numeric.iter().map(|Variable { name, rows, columns, .. }| format!("{name} ({rows}x{columns})"));
        let kinds = left_out.iter().map(|NonColumnVariable { name, kind }| format!("{name} ({kind})"));
        let (wanted, content) = ("numeric variables of equal length", sizes.chain(kinds).collect());
        return Err(ReadProblem::NoTable { format: "a MATLAB file", wanted, content });
    };
    let variables: Vec<Variable> = numeric.into_iter().filter(|variable| variable.rows == length).collect();
    let columns: Vec<(usize, usize)> = (variables.iter().enumerate())
        .flat_map(|(number, variable)| (0..variable.columns).map(move |column| (number, column)))
        .collect();
    let line = move |line: usize| {
        let mut text = String::new();
        text::write_line(&mut text, columns.len(), |text, place| {
            let (number, column) = columns[place];
            let variable = &variables[number];
            match line {
                0 if variable.columns == 1 => text::write_cell(text, &variable.name),
                0 => text::write_cell(text, &format!("{}_{}", variable.name, column + 1)),
                line => variable.write(text, column * variable.rows + line - 1),
            }
        });
        Ok(text)
    };
    Ok(Box::new(ChunkReader::new((0..=length).map(line))))
}
