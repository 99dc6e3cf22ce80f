//! Parquet files as text: every flat column of any type is a column, with every compression but zstd, brotli and LZO.
//! Rows are decoded a few thousand at a time, row group by row group. Nested columns are omitted.
//!
//! Source of the layout: Apache Parquet format, `parquet.thrift` (types, logical types and compression).

use std::io::Read;

use bytes::Bytes;
use half::f16;
use parquet::basic::{Compression, ConvertedType, LogicalType, TimeUnit, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{DataType, Int96};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use super::text::{self, ChunkReader};
use crate::decoder::{CheckedPages, PageHead, catch_panic};
use crate::reader::error::ReadProblem;

/// Rows decoded at a time.
const BATCH_ROWS: usize = 4096;

/// Maximum unpacked size of a page, bytes: some programs write a column of all rows as a single page.
const MAX_PAGE_BYTES: u64 = 8 * crate::reader::MAX_ROWS as u64;

/// Unpacked size of a page up to which any compression is accepted, bytes.
const SMALL_PAGE_BYTES: u64 = 1 << 24;

/// Maximum compression ratio of a larger page; deflate reaches 1032.
const MAX_COMPRESSION: u64 = 1100;

/// Maximum number of values of a dictionary; the decoder reserves some forty bytes for each.
const MAX_DICTIONARY_VALUES: u64 = 1 << 22;

/// `true` for a page whose stated sizes are within the limits.
fn fits(PageHead { is_dictionary, unpacked_bytes, packed_bytes, values }: PageHead) -> bool {
    unpacked_bytes <= SMALL_PAGE_BYTES.max(packed_bytes.saturating_mul(MAX_COMPRESSION))
        && unpacked_bytes <= MAX_PAGE_BYTES
        && (!is_dictionary || values <= MAX_DICTIONARY_VALUES.min(unpacked_bytes))
}

/// Meaning of the values of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Meaning {
    /// Number or text as stored, without a conversion.
    Plain,
    Unsigned,
    /// Integers with this number of decimal places.
    Decimal(u32),
    Half,
    Day,
    /// Time since midnight, in this part of a second.
    TimeOfDay(i64),
    /// Time since 1970, in this part of a second.
    Stamp {
        per_second: i64,
        utc: bool,
    },
}

impl Meaning {
    /// Meaning of a column; `None` for a type that is neither number, stamp nor text.
    fn from_descriptor(column: &ColumnDescriptor) -> Option<Self> {
        let per_second = |unit: &TimeUnit| match unit {
            TimeUnit::MILLIS => 1_000,
            TimeUnit::MICROS => 1_000_000,
            TimeUnit::NANOS => 1_000_000_000,
        };
        let decimals = || u32::try_from(column.type_scale()).ok().map(Self::Decimal);
        let meaning = match column.logical_type_ref() {
            Some(LogicalType::Timestamp(stamp)) => {
                Self::Stamp { per_second: per_second(&stamp.unit), utc: stamp.is_adjusted_to_u_t_c }
            }
            Some(LogicalType::Time(time)) => Self::TimeOfDay(per_second(&time.unit)),
            Some(LogicalType::Date) => Self::Day,
            Some(LogicalType::Decimal(_)) => decimals()?,
            Some(LogicalType::Integer(integer)) if !integer.is_signed => Self::Unsigned,
            Some(LogicalType::Float16) => Self::Half,
            _ => match column.converted_type() {
                // Converted types do not distinguish UTC from local time: many programs wrote local time.
                ConvertedType::TIMESTAMP_MILLIS => Self::Stamp { per_second: 1_000, utc: false },
                ConvertedType::TIMESTAMP_MICROS => Self::Stamp { per_second: 1_000_000, utc: false },
                ConvertedType::TIME_MILLIS => Self::TimeOfDay(1_000),
                ConvertedType::TIME_MICROS => Self::TimeOfDay(1_000_000),
                ConvertedType::DATE => Self::Day,
                ConvertedType::DECIMAL => decimals()?,
                ConvertedType::UINT_8 | ConvertedType::UINT_16 | ConvertedType::UINT_32 | ConvertedType::UINT_64 => {
                    Self::Unsigned
                }
                _ => Self::Plain,
            },
        };
        let plain_bytes =
            column.physical_type() == Type::FIXED_LEN_BYTE_ARRAY && !matches!(meaning, Self::Decimal(_) | Self::Half);
        (!plain_bytes).then_some(meaning)
    }
}

/// Column and its decoded rows.
struct Column {
    /// Index in the file.
    index: usize,
    name: String,
    meaning: Meaning,
    reader: Option<ColumnReader>,
    /// Cells of the decoded rows.
    cells: Cells,
}

/// Texts of cells in one string, with the end of each.
#[derive(Default)]
struct Cells {
    text: String,
    ends: Vec<usize>,
}

impl Cells {
    fn get(&self, row: usize) -> &str {
        let begin = row.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.text[begin..self.ends[row]]
    }
}

/// Rows of a file.
struct Rows {
    file: SerializedFileReader<CheckedPages<Bytes>>,
    columns: Vec<Column>,
    headed: bool,
    /// Number of row groups begun.
    groups: usize,
    /// Rows of the group that remain to be decoded.
    left: usize,
}

fn damaged(damage: String) -> ReadProblem {
    ReadProblem::Damaged { format: "a Parquet file", damage }
}

fn failed(error: ParquetError) -> ReadProblem {
    damaged(error.to_string())
}

/// Reader of a Parquet file as tab-separated text, decoded chunk by chunk; names first, then rows.
pub fn read_as_text(bytes: Vec<u8>) -> Result<Box<dyn Read>, ReadProblem> {
    let mut rows = checked(|| Rows::open(bytes))?;
    Ok(Box::new(ChunkReader::new(std::iter::from_fn(move || checked(|| rows.chunk()).transpose()))))
}

fn checked<T>(work: impl FnOnce() -> Result<T, ReadProblem>) -> Result<T, ReadProblem> {
    catch_panic(work).unwrap_or_else(|| Err(damaged("its content contradicts itself".to_owned())))
}

/// Name of a file with an unsupported compression; `None` for a supported compression.
fn unsupported(compression: Compression) -> Option<&'static str> {
    match compression {
        Compression::ZSTD(_) => Some("a Parquet file written with zstd compression, which is not read"),
        Compression::BROTLI(_) => Some("a Parquet file written with brotli compression, which is not read"),
        Compression::LZO => Some("a Parquet file written with LZO compression, which is not read"),
        _ => None,
    }
}

impl Rows {
    fn open(bytes: Vec<u8>) -> Result<Self, ReadProblem> {
        let file = SerializedFileReader::new(CheckedPages { bytes: Bytes::from(bytes), fits }).map_err(failed)?;
        let schema = file.metadata().file_metadata().schema_descr_ptr();
        let mut columns = Vec::new();
        for (index, column) in schema.columns().iter().enumerate() {
            let flat = column.max_rep_level() == 0 && column.path().parts().len() == 1;
            let Some(meaning) = Meaning::from_descriptor(column).filter(|_| flat) else { continue };
            let name = column.name().to_owned();
            columns.push(Column { index, name, meaning, reader: None, cells: Cells::default() });
        }
        if columns.is_empty() {
            let content = schema.columns().iter().map(|column| column.path().string()).collect();
            return Err(ReadProblem::NoTable { format: "a Parquet file", wanted: "flat columns", content });
        }
        for group in file.metadata().row_groups() {
            if group.num_rows() < 0 {
                return Err(damaged(format!("a group of it has {} rows", group.num_rows())));
            }
            for column in &columns {
                if let Some(format) = unsupported(group.column(column.index).compression()) {
                    return Err(ReadProblem::Format { format, cure: "write it with snappy compression or without" });
                }
            }
        }
        Ok(Self { file, columns, headed: false, groups: 0, left: 0 })
    }

    /// Line of names, then the next rows; `None` after the last row.
    fn chunk(&mut self) -> Result<Option<String>, ReadProblem> {
        let mut text = String::new();
        if !std::mem::replace(&mut self.headed, true) {
            text::write_line(&mut text, self.columns.len(), |text, at| text::write_cell(text, &self.columns[at].name));
            return Ok(Some(text));
        }
        while self.left == 0 {
            if self.groups == self.file.num_row_groups() {
                return Ok(None);
            }
            let group = self.file.get_row_group(self.groups).map_err(failed)?;
            self.left = group.metadata().num_rows().unsigned_abs() as usize;
            for column in &mut self.columns {
                column.reader = Some(group.get_column_reader(column.index).map_err(failed)?);
            }
            self.groups += 1;
        }
        let length = self.left.min(BATCH_ROWS);
        for column in &mut self.columns {
            column.decode(length)?;
        }
        self.left -= length;
        for row in 0..length {
            text::write_line(&mut text, self.columns.len(), |text, at| text.push_str(self.columns[at].cells.get(row)));
        }
        Ok(Some(text))
    }
}

impl Column {
    fn decode(&mut self, length: usize) -> Result<(), ReadProblem> {
        let Self { name, reader, cells, meaning, .. } = self;
        let meaning = *meaning;
        let early = || damaged(format!("its column `{}` ends too early", crate::wording::shortened(name)));
        let whole = match reader.as_mut().ok_or_else(early)? {
            ColumnReader::BoolColumnReader(reader) => {
                read(reader, length, cells, |text, &value| text.push(if value { '1' } else { '0' }))
            }
            ColumnReader::Int32ColumnReader(reader) => read(reader, length, cells, |text, &value| match meaning {
                Meaning::Unsigned => text::write_integer(text, value as u32),
                _ => integer(text, i64::from(value), meaning),
            }),
            ColumnReader::Int64ColumnReader(reader) => {
                read(reader, length, cells, |text, &value| integer(text, value, meaning))
            }
            ColumnReader::Int96ColumnReader(reader) => read(reader, length, cells, julian),
            ColumnReader::FloatColumnReader(reader) => {
                read(reader, length, cells, |text, &value| text::write_single(text, value))
            }
            ColumnReader::DoubleColumnReader(reader) => {
                read(reader, length, cells, |text, &value| text::write_number(text, value))
            }
            ColumnReader::ByteArrayColumnReader(reader) => {
                read(reader, length, cells, |text, value| bytes(text, value.data(), meaning))
            }
            ColumnReader::FixedLenByteArrayColumnReader(reader) => {
                read(reader, length, cells, |text, value| bytes(text, value.data(), meaning))
            }
        }?;
        if whole { Ok(()) } else { Err(early()) }
    }
}

/// Writes a stamp of nanoseconds of the day and a Julian day number; 1970-01-01 is 2 440 588.
fn julian(text: &mut String, stamp: &Int96) {
    let [low, high, day] = *stamp.data() else { return };
    let nanoseconds = (u64::from(high) << 32 | u64::from(low)) as i64;
    let seconds = (i64::from(day as i32) - 2_440_588) * 86_400 + nanoseconds.div_euclid(1_000_000_000);
    text::write_stamp(text, seconds, nanoseconds.rem_euclid(1_000_000_000), false);
}

fn integer(text: &mut String, value: i64, meaning: Meaning) {
    match meaning {
        Meaning::Unsigned => text::write_integer(text, value as u64),
        Meaning::Decimal(decimals) => text::write_decimal(text, value.into(), decimals),
        Meaning::Day => text::write_date(text, value),
        Meaning::TimeOfDay(per_second) => {
            text::write_time_of_day(text, value.saturating_mul(1_000_000_000 / per_second));
        }
        Meaning::Stamp { per_second, utc } => {
            let part = value.rem_euclid(per_second) * (1_000_000_000 / per_second);
            text::write_stamp(text, value.div_euclid(per_second), part, utc);
        }
        Meaning::Plain | Meaning::Half => text::write_integer(text, value),
    }
}

fn bytes(text: &mut String, bytes: &[u8], meaning: Meaning) {
    match (meaning, bytes) {
        (Meaning::Decimal(_), [] | [_, _, _, _, _, _, _, _, _, _, _, _, _, _, _, _, _, ..]) => {}
        (Meaning::Decimal(decimals), [first, ..]) => {
            // Big-endian two's complement.
            let sign = if first & 0x80 == 0 { 0 } else { -1 };
            let value = bytes.iter().fold(sign, |value: i128, &byte| value << 8 | i128::from(byte));
            text::write_decimal(text, value, decimals);
        }
        (Meaning::Half, &[low, high]) => text::write_single(text, f16::from_le_bytes([low, high]).to_f32()),
        (Meaning::Half, _) => {}
        _ => text::write_cell(text, &String::from_utf8_lossy(bytes)),
    }
}

/// Writes the next `length` rows of a column into cells; `false` if fewer are left.
fn read<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    length: usize,
    cells: &mut Cells,
    write: impl Fn(&mut String, &T::T),
) -> Result<bool, ReadProblem> {
    let (mut present, mut values) = (Vec::new(), Vec::with_capacity(length));
    let mut read = 0;
    while read < length {
        let (rows, ..) = reader.read_records(length - read, Some(&mut present), None, &mut values).map_err(failed)?;
        if rows == 0 {
            break;
        }
        read += rows;
    }
    cells.text.clear();
    cells.ends.clear();
    let mut values = values.iter();
    let rows = if present.is_empty() { values.len() } else { present.len() };
    for row in 0..rows {
        // Levels are absent if every row has a value.
        if present.get(row).is_none_or(|&level| level > 0) {
            let Some(value) = values.next() else { return Ok(false) };
            write(&mut cells.text, value);
        }
        cells.ends.push(cells.text.len());
    }
    Ok(rows == length && values.next().is_none())
}
