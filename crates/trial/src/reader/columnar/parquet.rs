//! Parquet files as text: one flat column is one column, whatever it holds and however it is packed (zstd and brotli
//! aside). Rows are decoded a few thousand at a time, row group by row group. Columns inside columns are left out.

use std::io::Read;

use bytes::Bytes;
use parquet::basic::{Compression, ConvertedType, LogicalType, TimeUnit, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{DataType, Int96};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use super::decoding::Checked;
use super::text::{self, Lines, Written};
use crate::decoder::guarded;
use crate::reader::error::Problem;

/// Rows decoded at a time.
const BATCH: usize = 4096;

/// What the values of a column mean.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Meaning {
    /// What their type says.
    Plain,
    Unsigned,
    /// Units of this decimal place.
    Decimal(u32),
    Half,
    Day,
    /// Since midnight, in this part of a second.
    TimeOfDay(i64),
    /// Since 1970, in this part of a second.
    Stamp {
        per_second: i64,
        utc: bool,
    },
}

impl Meaning {
    /// What a column holds; `None` for what is neither number, stamp nor text.
    fn of(column: &ColumnDescriptor) -> Option<Self> {
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
                // These do not say whether they are UTC: many programs wrote local time so.
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
        let other_bytes =
            column.physical_type() == Type::FIXED_LEN_BYTE_ARRAY && !matches!(meaning, Self::Decimal(_) | Self::Half);
        (!other_bytes).then_some(meaning)
    }
}

/// Writes one of the values that are there by its place.
type Write = Box<dyn Fn(&mut String, usize)>;

/// A column as far as it is decoded.
struct Column {
    /// Its place in the file.
    place: usize,
    name: String,
    meaning: Meaning,
    reader: Option<ColumnReader>,
    write: Write,
    /// For each row whether it has a value; empty where every row has one.
    present: Vec<i16>,
    /// Values written already.
    written: usize,
}

/// The rows of a file.
struct Rows {
    file: SerializedFileReader<Checked>,
    columns: Vec<Column>,
    headed: bool,
    /// Row groups begun.
    groups: usize,
    /// Rows of the group that are not decoded yet.
    left: usize,
    /// Rows decoded, and those of them that are written.
    decoded: usize,
    written: usize,
}

fn damaged(found: String) -> Problem {
    Problem::Damaged { format: "a Parquet file", found }
}

fn failed(error: ParquetError) -> Problem {
    damaged(error.to_string())
}

/// The text of a file.
pub fn text(bytes: Vec<u8>) -> Result<Box<dyn Read>, Problem> {
    Ok(Box::new(Written::new(checked(|| Rows::open(bytes))?)))
}

fn checked<T>(work: impl FnOnce() -> Result<T, Problem>) -> Result<T, Problem> {
    guarded(work).unwrap_or_else(|| Err(damaged("what it holds contradicts itself".to_owned())))
}

/// What a file is called where the way it is packed is not read.
fn unread(compression: Compression) -> Option<&'static str> {
    match compression {
        Compression::ZSTD(_) => Some("a Parquet file written with zstd compression, which is not read"),
        Compression::BROTLI(_) => Some("a Parquet file written with brotli compression, which is not read"),
        Compression::LZO => Some("a Parquet file written with LZO compression, which is not read"),
        _ => None,
    }
}

impl Rows {
    fn open(bytes: Vec<u8>) -> Result<Self, Problem> {
        let file = SerializedFileReader::new(Checked(Bytes::from(bytes))).map_err(failed)?;
        let schema = file.metadata().file_metadata().schema_descr_ptr();
        let mut columns = Vec::new();
        for (place, column) in schema.columns().iter().enumerate() {
            let flat = column.max_rep_level() == 0 && column.path().parts().len() == 1;
            let Some(meaning) = Meaning::of(column).filter(|_| flat) else { continue };
            let name = column.name().to_owned();
            let write = Box::new(|_: &mut String, _| {});
            columns.push(Column { place, name, meaning, reader: None, write, present: Vec::new(), written: 0 });
        }
        if columns.is_empty() {
            let found = schema.columns().iter().map(|column| column.path().string()).collect();
            return Err(Problem::NoTable { format: "a Parquet file", wanted: "flat columns", found });
        }
        for group in file.metadata().row_groups() {
            if group.num_rows() < 0 {
                return Err(damaged(format!("a group of it has {} rows", group.num_rows())));
            }
            for column in &columns {
                if let Some(format) = unread(group.column(column.place).compression()) {
                    return Err(Problem::Format { format, cure: "write it with snappy compression or without" });
                }
            }
        }
        Ok(Self { file, columns, headed: false, groups: 0, left: 0, decoded: 0, written: 0 })
    }

    /// Decodes the next rows; `false` where there are none.
    fn decode(&mut self) -> Result<bool, Problem> {
        while self.left == 0 {
            if self.groups == self.file.num_row_groups() {
                return Ok(false);
            }
            let group = self.file.get_row_group(self.groups).map_err(failed)?;
            self.left = group.metadata().num_rows().unsigned_abs() as usize;
            for column in &mut self.columns {
                column.reader = Some(group.get_column_reader(column.place).map_err(failed)?);
            }
            self.groups += 1;
        }
        let length = self.left.min(BATCH);
        for column in &mut self.columns {
            column.decode(length)?;
        }
        self.left -= length;
        (self.decoded, self.written) = (length, 0);
        Ok(true)
    }
}

impl Lines for Rows {
    fn write_line(&mut self, text: &mut String) -> Result<bool, Problem> {
        if !self.headed {
            for (place, column) in self.columns.iter().enumerate() {
                if place > 0 {
                    text.push('\t');
                }
                text::words(text, &column.name);
            }
            text.push('\n');
            self.headed = true;
            return Ok(true);
        }
        if self.written == self.decoded && !checked(|| self.decode())? {
            return Ok(false);
        }
        for (place, column) in self.columns.iter_mut().enumerate() {
            if place > 0 {
                text.push('\t');
            }
            column.write(text, self.written);
        }
        text.push('\n');
        self.written += 1;
        Ok(true)
    }
}

impl Column {
    fn decode(&mut self, length: usize) -> Result<(), Problem> {
        let Self { name, reader, present, meaning, .. } = self;
        let meaning = *meaning;
        present.clear();
        self.written = 0;
        let early = || damaged(format!("its column `{}` ends too early", crate::words::shortened(name)));
        let (values, write) = match reader.as_mut().ok_or_else(early)? {
            ColumnReader::BoolColumnReader(reader) => {
                read(reader, length, present, |text, &value| text.push(if value { '1' } else { '0' }))
            }
            ColumnReader::Int32ColumnReader(reader) => {
                read(reader, length, present, move |text, &value| match meaning {
                    Meaning::Unsigned => text::whole(text, value as u32),
                    _ => integer(text, i64::from(value), meaning),
                })
            }
            ColumnReader::Int64ColumnReader(reader) => {
                read(reader, length, present, move |text, &value| integer(text, value, meaning))
            }
            ColumnReader::Int96ColumnReader(reader) => read(reader, length, present, julian),
            ColumnReader::FloatColumnReader(reader) => {
                read(reader, length, present, |text, &value| text::single(text, value))
            }
            ColumnReader::DoubleColumnReader(reader) => {
                read(reader, length, present, |text, &value| text::number(text, value))
            }
            ColumnReader::ByteArrayColumnReader(reader) => {
                read(reader, length, present, move |text, value| bytes(text, value.data(), meaning))
            }
            ColumnReader::FixedLenByteArrayColumnReader(reader) => {
                read(reader, length, present, move |text, value| bytes(text, value.data(), meaning))
            }
        }?;
        self.write = write;
        let rows = if present.is_empty() { values } else { present.len() };
        let there = if present.is_empty() { rows } else { present.iter().filter(|&&level| level > 0).count() };
        if rows != length || there != values { Err(early()) } else { Ok(()) }
    }

    /// Writes the value of a row; nothing where it has none. Rows are asked for in their order.
    fn write(&mut self, text: &mut String, row: usize) {
        if self.present.get(row).is_none_or(|&level| level > 0) {
            (self.write)(text, self.written);
            self.written += 1;
        }
    }
}

/// A stamp in nanoseconds of a day, and days of the Julian calendar of astronomers; 1970-01-01 is 2 440 588.
fn julian(text: &mut String, stamp: &Int96) {
    let [low, high, day] = *stamp.data() else { return };
    let nanoseconds = (u64::from(high) << 32 | u64::from(low)) as i64;
    let seconds = (i64::from(day as i32) - 2_440_588) * 86_400 + nanoseconds.div_euclid(1_000_000_000);
    text::stamp(text, seconds, nanoseconds.rem_euclid(1_000_000_000), false);
}

fn integer(text: &mut String, value: i64, meaning: Meaning) {
    match meaning {
        Meaning::Unsigned => text::whole(text, value as u64),
        Meaning::Decimal(decimals) => text::decimal(text, value.into(), decimals),
        Meaning::Day => text::day(text, value),
        Meaning::TimeOfDay(per_second) => {
            text::time_of_day(text, value.saturating_mul(1_000_000_000 / per_second));
        }
        Meaning::Stamp { per_second, utc } => {
            let part = value.rem_euclid(per_second) * (1_000_000_000 / per_second);
            text::stamp(text, value.div_euclid(per_second), part, utc);
        }
        Meaning::Plain | Meaning::Half => text::whole(text, value),
    }
}

fn bytes(text: &mut String, bytes: &[u8], meaning: Meaning) {
    match (meaning, bytes) {
        (Meaning::Decimal(_), [] | [_, _, _, _, _, _, _, _, _, _, _, _, _, _, _, _, _, ..]) => {}
        (Meaning::Decimal(decimals), [first, ..]) => {
            // The largest digits first, in two's complement.
            let sign = if first & 0x80 == 0 { 0 } else { -1 };
            let value = bytes.iter().fold(sign, |value: i128, &byte| value << 8 | i128::from(byte));
            text::decimal(text, value, decimals);
        }
        (Meaning::Half, &[low, high]) => text::single(text, half(u16::from_le_bytes([low, high]))),
        (Meaning::Half, _) => {}
        _ => text::words(text, &String::from_utf8_lossy(bytes)),
    }
}

/// A number of half precision (IEEE 754 binary16).
fn half(bits: u16) -> f32 {
    let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1f), f32::from(bits & 0x3ff));
    let size = match exponent {
        0 => fraction * 2f32.powi(-24),
        0x1f if fraction == 0.0 => f32::INFINITY,
        0x1f => f32::NAN,
        _ => (1024.0 + fraction) * 2f32.powi(exponent - 25),
    };
    sign * size
}

/// How many values `length` rows have and how each is written, and into `present` which rows have one.
fn read<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    length: usize,
    present: &mut Vec<i16>,
    write: impl Fn(&mut String, &T::T) + 'static,
) -> Result<(usize, Write), Problem> {
    let mut values = Vec::with_capacity(length);
    let mut read = 0;
    while read < length {
        let (rows, ..) = reader.read_records(length - read, Some(present), None, &mut values).map_err(failed)?;
        if rows == 0 {
            break;
        }
        read += rows;
    }
    Ok((values.len(), Box::new(move |text, at| write(text, &values[at]))))
}
