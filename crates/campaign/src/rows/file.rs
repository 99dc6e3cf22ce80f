//! Parquet files of rows, written and read a few rows at a time, so that neither needs memory in proportion to the
//! file.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::sync_channel;

use bytes::Bytes;
use parquet::basic::Compression;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{ChunkReader, FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::ColumnPath;

use super::layout::{RowLayout, Values};
use super::row::StudyRow;
use crate::disk;
use crate::folder::{ResultFolder, TemporaryFile};
use scenario::failure::{Failure, OnPath};
use trial::decoder::{CheckedPages, PageHead};

/// Rows of a row group. Part of the identity of a file: groups are cut here however the rows arrive.
const GROUP: usize = 65_536;

/// Rows handed out at a time.
const BATCH: usize = 4096;

/// Longest text in a row, bytes; the labels and words that studies write are shorter.
const LONGEST_TEXT: usize = 4096;

/// Largest size of one column of a row group before it is packed, bytes.
const LARGEST_COLUMN: i64 = 1 << 28;

/// Writes rows in their order to a new file, which appears under its name whole or not at all.
pub struct RowWriter<'a> {
    layout: &'a RowLayout,
    path: PathBuf,
    file: SerializedFileWriter<TemporaryFile>,
    waiting: Vec<StudyRow>,
}

impl<'a> RowWriter<'a> {
    /// Begins a file.
    pub fn create(folder: &ResultFolder, name: &str, layout: &'a RowLayout) -> Result<Self, Failure> {
        let file = folder.create(name)?;
        let path = file.path().to_owned();
        let mut properties = WriterProperties::builder().set_compression(Compression::SNAPPY);
        for name in layout.names().filter(|name| !RowLayout::repeats(name)) {
            properties = properties.set_column_dictionary_enabled(ColumnPath::new(vec![name]), false);
        }
        let file = SerializedFileWriter::new(file, Arc::new(layout.schema()), Arc::new(properties.build()))
            .on("write", &path)?;
        Ok(Self { layout, path, file, waiting: Vec::new() })
    }

    /// Adds rows.
    pub fn push(&mut self, rows: impl IntoIterator<Item = StudyRow>) -> Result<(), Failure> {
        for row in rows {
            self.waiting.push(row);
            if self.waiting.len() == GROUP {
                self.write_group()?;
            }
        }
        Ok(())
    }

    /// Ends the file, waits until it is on the disk and returns it, still without its name, and its SHA-256.
    pub fn finish(mut self) -> Result<(TemporaryFile, String), Failure> {
        if !self.waiting.is_empty() {
            self.write_group()?;
        }
        let mut file = self.file.into_inner().on("finish", &self.path)?;
        let sha256 = file.seal()?;
        Ok((file, sha256))
    }

    fn write_group(&mut self) -> Result<(), Failure> {
        let path = &self.path;
        let mut group = self.file.next_row_group().on("write", path)?;
        for values in self.layout.take(&self.waiting) {
            let mut target = group.next_column().on("write", path)?.expect("the file has the columns of its layout");
            match values {
                Values::Counts(values) => write::<Int64Type>(&mut target, values),
                Values::Numbers(values) => write::<DoubleType>(&mut target, values),
                Values::Texts(values) => {
                    let bytes = |text: String| ByteArray::from(text.into_bytes());
                    write::<ByteArrayType>(&mut target, values.into_iter().map(|text| text.map(bytes)).collect())
                }
            }
            .on("write", path)?;
            target.close().on("write", path)?;
        }
        group.close().on("write", path)?;
        self.waiting.clear();
        Ok(())
    }
}

/// Writes the values that are there, and where they are.
fn write<T: DataType>(
    target: &mut SerializedColumnWriter<'_>,
    values: Vec<Option<T::T>>,
) -> parquet::errors::Result<usize> {
    let present: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
    let values: Vec<T::T> = values.into_iter().flatten().collect();
    target.typed::<T>().write_batch(&values, Some(&present), None)
}

/// Reads rows back in their order. What it reads may have been damaged, or made to do harm: sizes are looked at before
/// anything is unpacked, and where the decoder gives up the reader fails.
pub struct RowReader<'a, B: ChunkReader + 'static> {
    layout: &'a RowLayout,
    path: PathBuf,
    file: SerializedFileReader<CheckedPages<B>>,
    group: usize,
    columns: Vec<ColumnReader>,
    left: usize,
}

/// Bytes of a page before it is packed, at most; the writer begins a new page at about one megabyte.
const LARGEST_PAGE: u64 = 1 << 24;

/// Values of a page, at most.
const MOST_VALUES: u64 = 1 << 20;

/// Whether a page of a study may state so much: the decoder would reserve it.
fn fits(page: PageHead) -> bool {
    page.unpacked <= LARGEST_PAGE && page.values <= MOST_VALUES
}

impl<'a> RowReader<'a, disk::File> {
    /// Opens a file. Fails as wrong input when there is none, or when its columns are not those of the layout.
    pub fn open(path: &Path, layout: &'a RowLayout) -> Result<Self, Failure> {
        let file =
            disk::File::open(path).map_err(|error| Failure::about(path, format!("cannot be opened: {error}")))?;
        Self::new(file, path, layout)
    }
}

impl<'a> RowReader<'a, Bytes> {
    /// Reads from memory what `path` held. Fails as [`RowReader::open`] does.
    pub fn of_bytes(bytes: Vec<u8>, path: &Path, layout: &'a RowLayout) -> Result<Self, Failure> {
        Self::new(bytes.into(), path, layout)
    }
}

impl<'a, B: ChunkReader + 'static> RowReader<'a, B> {
    fn new(file: B, path: &Path, layout: &'a RowLayout) -> Result<Self, Failure> {
        let refuse = |problem: String| Failure::about(path, format!("{problem}; expected the rows of this study"));
        trial::decoder::guarded(|| {
            let file = SerializedFileReader::new(CheckedPages { bytes: file, fits })
                .map_err(|error| refuse(error.to_string()))?;
            let schema = file.metadata().file_metadata().schema_descr_ptr();
            let found: Vec<&str> = schema.columns().iter().map(|column| column.name()).collect();
            if let Some(name) = layout.names().find(|name| !found.contains(&name.as_str())) {
                return Err(refuse(format!("there is no column `{name}`")));
            }
            if *schema.root_schema() != layout.schema() {
                return Err(refuse(format!("the columns are {}", found.join(", "))));
            }
            for group in file.metadata().row_groups() {
                if !(0..=GROUP as i64).contains(&group.num_rows()) {
                    return Err(refuse(format!("a group of it has {} rows", group.num_rows())));
                }
                let sizes = || group.columns().iter().map(|column| column.uncompressed_size());
                if let Some(size) = sizes().find(|size| !(0..=LARGEST_COLUMN).contains(size)) {
                    return Err(refuse(format!("a column of it has {size} bytes")));
                }
            }
            Ok(Self { layout, path: path.to_owned(), file, group: 0, columns: Vec::new(), left: 0 })
        })
        .unwrap_or_else(|| Err(refuse("it is damaged".to_owned())))
    }

    /// The next rows, a few thousand at most; nothing when all have been read.
    pub(super) fn next_rows(&mut self) -> Result<Vec<StudyRow>, Failure> {
        let path = self.path.clone();
        trial::decoder::guarded(|| self.decoded())
            .unwrap_or_else(|| Err(Failure::about(&path, "it is damaged; expected the rows of this study")))
    }

    fn decoded(&mut self) -> Result<Vec<StudyRow>, Failure> {
        while self.left == 0 {
            if self.group == self.file.num_row_groups() {
                return Ok(Vec::new());
            }
            let group = self.file.get_row_group(self.group).map_err(|error| self.damaged(&error.to_string()))?;
            self.left = group.metadata().num_rows().unsigned_abs() as usize;
            let columns = (0..group.metadata().num_columns()).map(|column| group.get_column_reader(column));
            let columns: Result<Vec<ColumnReader>, _> = columns.collect();
            self.columns = columns.map_err(|error| self.damaged(&error.to_string()))?;
            self.group += 1;
        }
        let length = self.left.min(BATCH);
        self.left -= length;
        let values: Result<Vec<Values>, String> =
            self.columns.iter_mut().map(|column| values(column, length)).collect();
        values.and_then(|values| self.layout.put(values, length)).map_err(|problem| self.damaged(&problem))
    }

    fn damaged(&self, problem: &str) -> Failure {
        Failure::about(&self.path, format!("{problem}; the file was changed or is of another study"))
    }

    /// Hands every row to `take`, in order.
    pub fn for_each(mut self, mut take: impl FnMut(StudyRow) -> Result<(), Failure>) -> Result<(), Failure> {
        // Rows are decoded while those before them are taken.
        std::thread::scope(|scope| {
            let (send, receive) = sync_channel(1);
            let decoder = scope.spawn(move || {
                loop {
                    let rows = self.next_rows()?;
                    if rows.is_empty() || send.send(rows).is_err() {
                        return Ok(());
                    }
                }
            });
            let taken = receive.into_iter().flatten().try_for_each(&mut take);
            let decoded = decoder.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            taken.and(decoded)
        })
    }
}

fn values(column: &mut ColumnReader, length: usize) -> Result<Values, String> {
    Ok(match column {
        ColumnReader::Int64ColumnReader(reader) => Values::Counts(read(reader, length)?),
        ColumnReader::DoubleColumnReader(reader) => Values::Numbers(read(reader, length)?),
        ColumnReader::ByteArrayColumnReader(reader) => {
            let texts = read(reader, length)?.into_iter().map(|bytes| bytes.map(|bytes| text(&bytes)).transpose());
            Values::Texts(texts.collect::<Result<_, _>>()?)
        }
        _ => unreachable!("the schema was compared when the file was opened"),
    })
}

fn text(bytes: &ByteArray) -> Result<String, String> {
    match bytes.len() {
        0..=LONGEST_TEXT => bytes.as_utf8().map(str::to_owned).map_err(|error| error.to_string()),
        long => Err(format!("a text of it has {long} bytes, more than the {LONGEST_TEXT} of any study")),
    }
}

/// Values of `length` rows.
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
    // A column that has a value in every row has no levels.
    present.resize(length, 1);
    let mut values = values.into_iter();
    Ok(present.into_iter().map(|level| if level > 0 { values.next() } else { None }).collect())
}
