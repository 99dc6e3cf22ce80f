//! Columns of counts, numbers and texts as a Parquet file of one row group.

use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::Result;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{Type, TypePtr};

/// Values of one column, one per row; `None` for a missing value.
#[derive(Debug, Clone, PartialEq)]
pub enum ColumnValues {
    /// Whole numbers.
    Counts(Vec<Option<i64>>),
    /// Numbers.
    Numbers(Vec<Option<f64>>),
    /// Texts.
    Texts(Vec<Option<String>>),
}

impl ColumnValues {
    /// Schema of the column; values may be missing.
    fn field(&self, name: &str) -> TypePtr {
        let (physical, logical) = match self {
            Self::Counts(_) => (Physical::INT64, None),
            Self::Numbers(_) => (Physical::DOUBLE, None),
            Self::Texts(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        field(name, physical, Repetition::OPTIONAL, logical)
    }
}

/// Schema of one column.
pub(crate) fn field(name: &str, physical: Physical, repetition: Repetition, logical: Option<LogicalType>) -> TypePtr {
    let field =
        Type::primitive_type_builder(name, physical).with_repetition(repetition).with_logical_type(logical).build();
    Arc::new(field.expect("kinds and logical types fit together"))
}

/// Schema of a table with columns of these schemas.
pub(crate) fn schema(fields: Vec<TypePtr>) -> TypePtr {
    Arc::new(Type::group_type_builder("rows").with_fields(fields).build().expect("a group of columns"))
}

/// Writes columns as one row group.
pub(crate) fn write_group(
    file: &mut SerializedFileWriter<Vec<u8>>,
    columns: impl IntoIterator<Item = ColumnValues>,
) -> Result<()> {
    let mut group = file.next_row_group()?;
    for values in columns {
        let mut target = group.next_column()?.expect("the file has the columns of its layout");
        match values {
            ColumnValues::Counts(values) => write::<Int64Type>(&mut target, values),
            ColumnValues::Numbers(values) => write::<DoubleType>(&mut target, values),
            ColumnValues::Texts(values) => {
                let bytes = |text: String| ByteArray::from(text.into_bytes());
                write::<ByteArrayType>(&mut target, values.into_iter().map(|text| text.map(bytes)).collect())
            }
        }?;
        target.close()?;
    }
    group.close().map(drop)
}

/// Writes the values of a column; a missing value has definition level 0.
fn write<T: DataType>(target: &mut SerializedColumnWriter<'_>, values: Vec<Option<T::T>>) -> Result<usize> {
    let present: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
    let values: Vec<T::T> = values.into_iter().flatten().collect();
    target.typed::<T>().write_batch(&values, Some(&present), None)
}

/// Bytes of a Parquet file of named columns, compressed with Snappy. Fails if their numbers of rows differ.
pub fn encode(columns: Vec<(String, ColumnValues)>) -> Result<Vec<u8>> {
    let fields = columns.iter().map(|(name, values)| values.field(name)).collect();
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let mut file = SerializedFileWriter::new(Vec::new(), schema(fields), Arc::new(properties))?;
    write_group(&mut file, columns.into_iter().map(|(_, values)| values))?;
    file.into_inner()
}
