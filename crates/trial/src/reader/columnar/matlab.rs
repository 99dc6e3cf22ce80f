//! MATLAB files of level 5 (`save -v6`, `-v7`) and level 4 (`save -v4`) as text: numeric variables of one length are
//! the columns of a table. Texts, cells, structures, sparse and complex variables are left out, and so is what has more
//! than two dimensions; a cell array with the name of a quantity that no other variable holds is refused.
//!
//! Source of the layout: MathWorks, "MAT-File Format", chapter 1 (level 5 MAT-files).

mod level4;
mod variable;

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::text::{self, Written};
use crate::file::FileError;
use crate::names::{self, ColumnMeaning};
use crate::reader::error::Problem;
use crate::reader::{MAX_CELLS, RECORD};
use variable::{CELL, COMPRESSED, OtherVariable, Scan, Variable, Variables, class_name, contradiction, damaged, size};

pub use level4::starts as is_level4;

/// Length of the head of a file, bytes.
const HEAD: usize = 128;

/// Bytes of an unpacked variable up to the end of its flags.
const UP_TO_FLAGS: usize = 24;

/// Bytes of an unpacked variable that hold its name as well, whatever is in it.
const UP_TO_NAME: usize = 192;

/// Most bytes of all variables when they are unpacked.
const MOST_UNPACKED: u64 = 8 * MAX_CELLS as u64;

/// Kind of a data element that holds a variable.
const MATRIX: u32 = 14;

/// Class of the numbers of a variable, and whether they are complex.
fn flags(word: u32) -> (u32, bool) {
    (word & 0xff, word & 0x0800 != 0)
}

fn is_numeric(class: u32) -> bool {
    (6..=15).contains(&class)
}

/// Reads a variable, or what one without numbers is; `None` where the bytes are none.
fn variable(bytes: &[u8], big_endian: bool) -> Option<Result<Variable, OtherVariable>> {
    let mut scan = Scan { rest: bytes, big_endian };
    let (_, own) = scan.element()?;
    let (class, complex) = flags(Scan { rest: own, big_endian }.word()?);
    if !is_numeric(class) {
        let name = scan.element().and_then(|_| scan.element()).map(|(_, name)| String::from_utf8_lossy(name));
        let name = name.map_or_else(String::new, |name| name.into_owned());
        return Some(Err(OtherVariable { name, what: class_name(class).to_owned() }));
    }
    let mut sizes = Scan { rest: scan.element()?.1, big_endian };
    let mut dimensions = Vec::new();
    while !sizes.rest.is_empty() {
        dimensions.push(usize::try_from(sizes.word()?).ok()?);
    }
    let name = String::from_utf8_lossy(scan.element()?.1).into_owned();
    let sizes = dimensions.iter().map(usize::to_string).collect::<Vec<_>>().join("x");
    // What MATLAB keeps for objects is a variable of bytes without a name.
    if name.is_empty() || complex || dimensions.len() != 2 {
        return Some(Err(OtherVariable { name, what: sizes }));
    }
    let (kind, data) = scan.element()?;
    let [rows, columns] = *dimensions.first_chunk()?;
    (rows.checked_mul(columns)?.checked_mul(size(kind)?)? == data.len()).then_some(())?;
    Some(Ok(Variable::new(name, [rows, columns], kind, data, big_endian)))
}

/// Unpacks a variable, with its tag; one that holds no numbers up to its name alone.
fn unpacked(packed: &[u8], big_endian: bool, left: &mut u64) -> Result<Vec<u8>, Problem> {
    let mut decoder = ZlibDecoder::new(packed);
    let mut bytes = Vec::new();
    let mut read = |bytes: &mut Vec<u8>, most: u64| {
        let from = bytes.len() as u64;
        let result = (&mut decoder).take(most).read_to_end(bytes);
        *left = left.saturating_sub(bytes.len() as u64 - from);
        result.map(|_| *left).map_err(|_| damaged("a variable cannot be unpacked"))
    };
    read(&mut bytes, UP_TO_FLAGS as u64)?;
    let flag_word = bytes.get(16..20).and_then(|word| Scan { rest: word, big_endian }.word());
    if flag_word.is_some_and(|word| is_numeric(flags(word).0)) {
        let length = Scan { rest: &bytes[4..], big_endian }.word().unwrap_or(0);
        let rest = (u64::from(length) + 8).saturating_sub(UP_TO_FLAGS as u64);
        if read(&mut bytes, rest.min(MOST_UNPACKED))? == 0 {
            return Err(FileError::TooLarge { kind: RECORD, size: None }.into());
        }
    } else {
        read(&mut bytes, (UP_TO_NAME - UP_TO_FLAGS) as u64)?;
    }
    Ok(bytes)
}

/// The variables of a file of level 5.
fn variables(bytes: &[u8]) -> Result<Variables, Problem> {
    let big_endian = match bytes.get(HEAD - 2..HEAD) {
        Some(b"IM") => false,
        Some(b"MI") => true,
        _ => return Err(damaged("its head is incomplete")),
    };
    let mut scan = Scan { rest: &bytes[HEAD..], big_endian };
    let (mut numeric, mut others) = (Vec::new(), Vec::new());
    let mut left = MOST_UNPACKED;
    while !scan.rest.is_empty() {
        let (kind, data) = scan.element().ok_or_else(|| damaged("its last variable is incomplete"))?;
        let unpacked = match kind {
            COMPRESSED => unpacked(data, big_endian, &mut left)?,
            MATRIX => Vec::new(),
            _ => continue,
        };
        let mut inner = Scan { rest: &unpacked, big_endian };
        let content = match kind {
            COMPRESSED => inner.word().zip(inner.word()).filter(|(kind, _)| *kind == MATRIX).map(|_| inner.rest),
            _ => Some(data),
        };
        match content.and_then(|content| variable(content, big_endian)).ok_or_else(contradiction)? {
            Ok(variable) => numeric.push(variable),
            Err(other) => others.push(other),
        }
    }
    Ok((numeric, others))
}

/// The text of a file: of the variables of one length with the most known names, or else the most numbers.
pub fn text(bytes: Vec<u8>) -> Result<Box<dyn Read>, Problem> {
    let (numeric, others) = if is_level4(&bytes) { level4::variables(&bytes)? } else { variables(&bytes)? };
    let quantity = |name: &str| match names::meaning(name)? {
        ColumnMeaning::Channel(channel, _) => Some(ColumnMeaning::Channel(channel, None)),
        ColumnMeaning::Time(_) => Some(ColumnMeaning::Time(None)),
        _ => None,
    };
    let is_lacking = |cell: &&OtherVariable| {
        let of_cell = quantity(&cell.name);
        cell.what == CELL && of_cell.is_some() && numeric.iter().all(|variable| quantity(&variable.name) != of_cell)
    };
    if let Some(cell) = others.iter().find(is_lacking) {
        return Err(Problem::CellArray { column: cell.name.clone() });
    }
    let worth = |rows: usize| {
        let of_length = || numeric.iter().filter(|variable| variable.rows == rows);
        let known = of_length().filter(|variable| names::meaning(&variable.name).is_some()).count();
        (known, rows * of_length().map(|variable| variable.columns).sum::<usize>(), rows)
    };
    let mut lengths: Vec<usize> = numeric.iter().map(|variable| variable.rows).filter(|&rows| rows > 1).collect();
    lengths.sort_unstable();
    lengths.dedup();
    let Some(length) = lengths.into_iter().max_by_key(|&rows| worth(rows)) else {
        let sizes = numeric.iter().map(|Variable { name, rows, columns, .. }| format!("{name} ({rows}x{columns})"));
        let others = others.iter().map(|OtherVariable { name, what }| format!("{name} ({what})"));
        let (wanted, found) = ("numeric variables of one length", sizes.chain(others).collect());
        return Err(Problem::NoTable { format: "a MATLAB file", wanted, found });
    };
    let variables: Vec<Variable> = numeric.into_iter().filter(|variable| variable.rows == length).collect();
    let columns: Vec<(usize, usize)> = (variables.iter().enumerate())
        .flat_map(|(number, variable)| (0..variable.columns).map(move |column| (number, column)))
        .collect();
    let line = move |line: usize| {
        let mut text = String::new();
        text::line(&mut text, columns.len(), |text, place| {
            let (number, column) = columns[place];
            let variable = &variables[number];
            match line {
                0 if variable.columns == 1 => text::words(text, &variable.name),
                0 => text::words(text, &format!("{}_{}", variable.name, column + 1)),
                line => variable.write(text, column * variable.rows + line - 1),
            }
        });
        Ok(text)
    };
    Ok(Box::new(Written::new((0..=length).map(line))))
}
