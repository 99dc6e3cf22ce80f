//! Parquet files of rows, written and read a few rows at a time, so that neither needs memory in proportion to the file.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::sync_channel;

use parquet::basic::Compression;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::ColumnPath;

use super::Row;
use super::columns::{Layout, Values};
use crate::failure::{Failure, OnPath};

/// Rows of a row group. Part of the identity of a file: groups are cut here however the rows arrive.
const GROUP: usize = 65_536;

/// Rows handed out at a time.
const BATCH: usize = 4096;

/// Writes rows in their order to a new file, which appears under its name whole or not at all.
pub struct Writer<'a> {
    layout: &'a Layout,
    path: PathBuf,
    unfinished: PathBuf,
    file: SerializedFileWriter<File>,
    waiting: Vec<Row>,
}

impl<'a> Writer<'a> {
    /// Begins a file.
    pub fn create(path: &Path, layout: &'a Layout) -> Result<Self, Failure> {
        let unfinished = path.with_extension("tmp");
        let file = File::create(&unfinished).on("create", &unfinished)?;
        let mut properties = WriterProperties::builder().set_compression(Compression::SNAPPY);
        for name in layout.names().filter(|name| !Layout::repeats(name)) {
            properties = properties.set_column_dictionary_enabled(ColumnPath::new(vec![name]), false);
        }
        let file = SerializedFileWriter::new(file, Arc::new(layout.schema()), Arc::new(properties.build()))
            .on("write", &unfinished)?;
        Ok(Self { layout, path: path.to_owned(), unfinished, file, waiting: Vec::new() })
    }

    /// Adds rows.
    pub fn push(&mut self, rows: impl IntoIterator<Item = Row>) -> Result<(), Failure> {
        for row in rows {
            self.waiting.push(row);
            if self.waiting.len() == GROUP {
                self.write_group()?;
            }
        }
        Ok(())
    }

    /// Ends the file and gives it its name, once it is safe on the disk.
    pub fn finish(mut self) -> Result<(), Failure> {
        if !self.waiting.is_empty() {
            self.write_group()?;
        }
        let Self { file, unfinished, path, .. } = self;
        let file = file.into_inner().on("finish", &unfinished)?;
        file.sync_all().on("finish", &unfinished)?;
        std::fs::rename(&unfinished, &path).on("finish", &path)
    }

    fn write_group(&mut self) -> Result<(), Failure> {
        let path = &self.unfinished;
        let mut group = self.file.next_row_group().on("write", path)?;
        for values in self.layout.take(&self.waiting) {
            let mut target = group.next_column().on("write", path)?.expect("the file has the columns of its layout");
            match values {
                Values::Counts(values) => {
                    target.typed::<Int64Type>().write_batch(&values, None, None).on("write", path)?;
                }
                Values::Numbers(values) => {
                    let (present, values) = presence(values);
                    target.typed::<DoubleType>().write_batch(&values, Some(&present), None).on("write", path)?;
                }
                Values::Texts(values) => {
                    let (present, values) = presence(values);
                    let values: Vec<ByteArray> = values.iter().map(|text| ByteArray::from(text.as_str())).collect();
                    target.typed::<ByteArrayType>().write_batch(&values, Some(&present), None).on("write", path)?;
                }
            }
            target.close().on("write", path)?;
        }
        group.close().on("write", path)?;
        self.waiting.clear();
        Ok(())
    }
}

/// Definition levels, and the values that are there.
fn presence<T>(values: Vec<Option<T>>) -> (Vec<i16>, Vec<T>) {
    (values.iter().map(|value| i16::from(value.is_some())).collect(), values.into_iter().flatten().collect())
}

/// Reads rows back in their order.
pub struct Reader<'a> {
    layout: &'a Layout,
    path: PathBuf,
    file: SerializedFileReader<File>,
    group: usize,
    columns: Vec<ColumnReader>,
    left: usize,
}

impl<'a> Reader<'a> {
    /// Opens a file. Fails as wrong input when there is none, or when its columns are not those of the layout.
    pub fn open(path: &Path, layout: &'a Layout) -> Result<Self, Failure> {
        let refuse =
            |problem: String| Failure::input(format!("{}: {problem}; expected the rows of this study", path.display()));
        let file = File::open(path).map_err(|error| refuse(format!("cannot be opened: {error}")))?;
        let file = SerializedFileReader::new(file).map_err(|error| refuse(error.to_string()))?;
        let schema = file.metadata().file_metadata().schema_descr_ptr();
        let found: Vec<&str> = schema.columns().iter().map(|column| column.name()).collect();
        if let Some(name) = layout.names().find(|name| !found.contains(&name.as_str())) {
            return Err(refuse(format!("there is no column `{name}`")));
        }
        if *schema.root_schema() != layout.schema() {
            return Err(refuse(format!("the columns are {}", found.join(", "))));
        }
        Ok(Self { layout, path: path.to_owned(), file, group: 0, columns: Vec::new(), left: 0 })
    }

    /// Number of rows in the file.
    pub fn len(&self) -> u64 {
        self.file.metadata().file_metadata().num_rows().unsigned_abs()
    }

    /// Whether the file holds no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The next rows, a few thousand at most; nothing when all have been read.
    pub(super) fn next_rows(&mut self) -> Result<Vec<Row>, Failure> {
        while self.left == 0 {
            if self.group == self.file.num_row_groups() {
                return Ok(Vec::new());
            }
            let group = self.file.get_row_group(self.group).on("read", &self.path)?;
            self.left = group.metadata().num_rows().unsigned_abs() as usize;
            self.columns = (0..group.metadata().num_columns())
                .map(|column| group.get_column_reader(column).on("read", &self.path))
                .collect::<Result<_, _>>()?;
            self.group += 1;
        }
        let length = self.left.min(BATCH);
        self.left -= length;
        let path = &self.path;
        let values: Vec<Values> =
            self.columns.iter_mut().map(|column| values(column, length, path)).collect::<Result<_, _>>()?;
        self.layout.put(values, length).map_err(|problem| {
            Failure::input(format!("{}: {problem}; the file was changed or is of another study", path.display()))
        })
    }

    /// Hands every row to `take`, in order.
    pub fn for_each(mut self, mut take: impl FnMut(Row) -> Result<(), Failure>) -> Result<(), Failure> {
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

fn values(column: &mut ColumnReader, length: usize, path: &Path) -> Result<Values, Failure> {
    Ok(match column {
        ColumnReader::Int64ColumnReader(reader) => {
            let (_, values) = read(reader, length, path)?;
            Values::Counts(values)
        }
        ColumnReader::DoubleColumnReader(reader) => {
            let (present, values) = read(reader, length, path)?;
            Values::Numbers(spread(&present, values))
        }
        ColumnReader::ByteArrayColumnReader(reader) => {
            let (present, values) = read(reader, length, path)?;
            let texts: Result<Vec<String>, Failure> =
                values.iter().map(|text| text.as_utf8().map(str::to_owned).on("read", path)).collect();
            Values::Texts(spread(&present, texts?))
        }
        _ => unreachable!("the schema was compared when the file was opened"),
    })
}

/// Definition levels and values of `length` rows.
fn read<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    length: usize,
    path: &Path,
) -> Result<(Vec<i16>, Vec<T::T>), Failure> {
    let (mut present, mut values) = (Vec::with_capacity(length), Vec::with_capacity(length));
    let mut read = 0;
    while read < length {
        let (rows, ..) = reader.read_records(length - read, Some(&mut present), None, &mut values).on("read", path)?;
        if rows == 0 {
            return Err(Failure::work(format!("failed to read {}: it ends too early", path.display())));
        }
        read += rows;
    }
    Ok((present, values))
}

fn spread<T>(present: &[i16], values: Vec<T>) -> Vec<Option<T>> {
    let mut values = values.into_iter();
    present.iter().map(|&level| if level > 0 { values.next() } else { None }).collect()
}
