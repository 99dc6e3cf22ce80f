//! Block of rows as a Parquet file of one row group. Its metadata state study, program and block, and the SHA-256
//! of the values, so that a reader can verify a file in any folder.

use std::sync::Arc;

use bytes::Bytes;
use parquet::basic::Compression;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::file::metadata::{FileMetaData, KeyValue};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::ColumnPath;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use trial::decoder::{CheckedPages, PageHead};

use super::layout::RowLayout;
use super::row::StudyRow;
use crate::block::Block;
use crate::parquet_table::{self, ColumnValues};
use crate::scenario::hex_digits;

/// Metadata key of the label.
const LABEL: &str = "kempf.block";
/// Metadata key of the SHA-256 of the label.
const LABEL_SHA256: &str = "kempf.block-sha256";

/// Maximum size of a text of a row, bytes; failure messages of outside programs are far shorter.
const MAX_TEXT_BYTES: usize = 4096;

/// Maximum size of an uncompressed column of a block, bytes.
const MAX_COLUMN_BYTES: i64 = 1 << 28;

/// Maximum size of an uncompressed page, bytes.
const MAX_PAGE_BYTES: u64 = 1 << 24;

/// Maximum number of values in a page.
const MAX_PAGE_VALUES: u64 = 1 << 20;

/// `true` if a page is within the limits of a block.
fn fits(page: PageHead) -> bool {
    page.unpacked_bytes <= MAX_PAGE_BYTES && page.values <= MAX_PAGE_VALUES
}

/// Label of a block: its study, program and position.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct BlockLabel {
    /// SHA-256 of the design of the study.
    pub design: String,
    /// Seed of the study.
    pub seed: u64,
    /// Program that computed the block.
    pub program: String,
    /// Index of the cell.
    pub cell: usize,
    /// Index of the block in its cell.
    pub block: u64,
}

impl BlockLabel {
    /// Position of the block: its cell and its number in the cell.
    pub fn block(&self) -> Block {
        Block { cell: self.cell, number: self.block }
    }
}

/// Label with row count and SHA-256 of the values of the file.
#[derive(Serialize, Deserialize)]
struct SealedLabel {
    #[serde(flatten)]
    label: BlockLabel,
    rows: usize,
    values_sha256: String,
}

/// Reason why a file is not the expected block.
#[derive(Debug, Clone, PartialEq)]
pub enum BlockFileError {
    /// Damaged or altered; the text describes how.
    Changed(String),
    /// Block of another study, seed, program or position, according to its sound label.
    OtherBlock(BlockLabel),
}

impl From<String> for BlockFileError {
    fn from(problem: String) -> Self {
        Self::Changed(problem)
    }
}

/// SHA-256 of the injective encodings of columns in their order, hexadecimal.
fn values_hash(columns: &[ColumnValues]) -> String {
    let mut digest = Sha256::new();
    let mut bytes = Vec::new();
    for column in columns {
        bytes.clear();
        column.write_to(&mut bytes);
        digest.update(&bytes);
    }
    hex_digits(&digest.finalize())
}

/// Bytes of the Parquet file of a block.
pub fn encode(rows: &[StudyRow], label: &BlockLabel, layout: &RowLayout) -> Result<Vec<u8>, String> {
    written(rows, label, layout).map_err(|error| error.to_string())
}

fn written(rows: &[StudyRow], label: &BlockLabel, layout: &RowLayout) -> parquet::errors::Result<Vec<u8>> {
    let mut properties = WriterProperties::builder().set_compression(Compression::SNAPPY);
    for name in layout.names().filter(|name| !RowLayout::is_dictionary_encoded(name)) {
        properties = properties.set_column_dictionary_enabled(ColumnPath::new(vec![name]), false);
    }
    let mut file = SerializedFileWriter::new(Vec::new(), layout.schema(), Arc::new(properties.build()))?;
    let columns: Vec<ColumnValues> = layout.value_columns(rows).collect();
    let label = SealedLabel { label: label.clone(), rows: rows.len(), values_sha256: values_hash(&columns) };
    parquet_table::write_group(&mut file, columns)?;
    let label = serde_json::to_string(&label).expect("texts and numbers");
    let sha256 = hex_digits(&Sha256::digest(&label));
    file.append_key_value_metadata(KeyValue::new(LABEL.to_owned(), label));
    file.append_key_value_metadata(KeyValue::new(LABEL_SHA256.to_owned(), sha256));
    file.into_inner()
}

/// Rows of a block: complete trials, from the first of the block on.
///
/// Fails unless [`encode`] wrote the file for this block of this study and program.
pub fn decode(bytes: Vec<u8>, expected: &BlockLabel, layout: &RowLayout) -> Result<Vec<StudyRow>, BlockFileError> {
    let damaged = || BlockFileError::Changed("it is damaged".to_owned());
    let rows = trial::decoder::catch_panic(|| read_file(bytes, expected, layout)).unwrap_or_else(|| Err(damaged()))?;
    let methods = layout.method_count();
    let is_next = |(place, row): (usize, &StudyRow)| {
        let replicate = expected.block * Block::REPLICATES + (place / methods) as u64;
        (row.cell, row.replicate, row.method) == (expected.cell as u64, replicate, place % methods)
    };
    let most = Block::REPLICATES as usize * methods;
    match rows.len().is_multiple_of(methods) && rows.len() <= most && rows.iter().enumerate().all(is_next) {
        true => Ok(rows),
        false => Err(BlockFileError::Changed("its rows are not complete trials in order".to_owned())),
    }
}

fn read_file(bytes: Vec<u8>, expected: &BlockLabel, layout: &RowLayout) -> Result<Vec<StudyRow>, BlockFileError> {
    let message = |error: parquet::errors::ParquetError| error.to_string();
    let file = SerializedFileReader::new(CheckedPages { bytes: Bytes::from(bytes), fits }).map_err(message)?;
    let SealedLabel { label, rows, values_sha256 } = label_of(file.metadata().file_metadata())?;
    if label != *expected {
        return Err(BlockFileError::OtherBlock(label));
    }
    let schema = file.metadata().file_metadata().schema_descr_ptr();
    if *schema.root_schema() != *layout.schema() || file.num_row_groups() != 1 {
        return Err("its columns are not those of this study".to_owned().into());
    }
    let group = file.metadata().row_group(0);
    let is_sound = |size: i64| (0..=MAX_COLUMN_BYTES).contains(&size);
    let sizes = group.columns().iter().map(|column| column.uncompressed_size());
    let most = Block::REPLICATES as usize * layout.method_count();
    if rows > most || group.num_rows() != rows as i64 || !sizes.into_iter().all(is_sound) {
        return Err("its number of rows differs from its label".to_owned().into());
    }
    let group = file.get_row_group(0).map_err(message)?;
    let column = |place: usize| values(&mut group.get_column_reader(place).map_err(message)?, rows);
    let columns: Vec<ColumnValues> = (0..group.num_columns()).map(column).collect::<Result<_, String>>()?;
    if values_hash(&columns) != values_sha256 {
        return Err("the SHA-256 of its values differs from its label".to_owned().into());
    }
    Ok(layout.rows_from(columns, rows)?)
}

/// Verified label of a file.
fn label_of(file: &FileMetaData) -> Result<SealedLabel, String> {
    let value = |name: &str| {
        file.key_value_metadata()?.iter().find(|pair| pair.key == name).and_then(|pair| pair.value.as_deref())
    };
    let label = value(LABEL).ok_or("it is not a block of a study")?;
    if value(LABEL_SHA256) != Some(hex_digits(&Sha256::digest(label)).as_str()) {
        return Err("its label is damaged".to_owned());
    }
    serde_json::from_str(label).map_err(|error| error.to_string())
}

fn values(column: &mut ColumnReader, length: usize) -> Result<ColumnValues, String> {
    Ok(match column {
        ColumnReader::Int64ColumnReader(reader) => ColumnValues::Counts(read(reader, length)?),
        ColumnReader::DoubleColumnReader(reader) => ColumnValues::Numbers(read(reader, length)?),
        ColumnReader::ByteArrayColumnReader(reader) => {
            let texts = read(reader, length)?.into_iter().map(|bytes| bytes.map(|bytes| text(&bytes)).transpose());
            ColumnValues::Texts(texts.collect::<Result<_, _>>()?)
        }
        _ => unreachable!("the schema was compared before"),
    })
}

fn text(bytes: &ByteArray) -> Result<String, String> {
    match bytes.len() {
        0..=MAX_TEXT_BYTES => bytes.as_utf8().map(str::to_owned).map_err(|error| error.to_string()),
        long => Err(format!("a text in it has {long} bytes; the limit is {MAX_TEXT_BYTES}")),
    }
}

/// Values of `length` rows of a column.
fn read<T: DataType>(reader: &mut ColumnReaderImpl<T>, length: usize) -> Result<Vec<Option<T::T>>, String> {
    let (mut present, mut values) = (Vec::with_capacity(length), Vec::with_capacity(length));
    let mut read = 0;
    while read < length {
        let (rows, ..) = (reader.read_records(length - read, Some(&mut present), None, &mut values))
            .map_err(|error| error.to_string())?;
        if rows == 0 {
            return Err("it ends too early".to_owned());
        }
        read += rows;
    }
    // A required column has no definition levels: every row has a value.
    present.resize(length, 1);
    let mut values = values.into_iter();
    Ok(present.into_iter().map(|level| if level > 0 { values.next() } else { None }).collect())
}
