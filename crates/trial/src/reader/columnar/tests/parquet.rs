//! Parquet files, written with the crate that reads them.

use std::sync::Arc;

use ::parquet::basic::{Compression, GzipLevel};
use ::parquet::data_type::{
    BoolType, ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int32Type, Int64Type, Int96, Int96Type,
};
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use ::parquet::schema::parser::parse_message_type;

use super::*;
use crate::channel::Channel;

enum Values {
    Booleans(Vec<Option<bool>>),
    Integers(Vec<Option<i32>>),
    Longs(Vec<Option<i64>>),
    Days(Vec<Option<Int96>>),
    Singles(Vec<Option<f32>>),
    Doubles(Vec<Option<f64>>),
    Texts(Vec<Option<ByteArray>>),
}

fn some<T: Copy>(values: &[T]) -> Vec<Option<T>> {
    values.iter().copied().map(Some).collect()
}

fn put<T: DataType>(group: &mut SerializedRowGroupWriter<Vec<u8>>, values: &[Option<T::T>]) {
    let mut column = group.next_column().expect("written").expect("a column of the schema");
    let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
    let values: Vec<T::T> = values.iter().flatten().cloned().collect();
    column.typed::<T>().write_batch(&values, Some(&levels), None).expect("written");
    column.close().expect("written");
}

/// A file of optional columns, `rows` in a group.
fn file(schema: &str, columns: &[Values], compression: Compression, rows: usize) -> Vec<u8> {
    let schema = parse_message_type(&format!("message run {{ {schema} }}")).expect("a schema");
    let properties = WriterProperties::builder().set_compression(compression).build();
    let mut file = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties)).expect("written");
    let length = match &columns[0] {
        Values::Doubles(values) => values.len(),
        Values::Longs(values) => values.len(),
        _ => columns.len(),
    };
    for from in (0..length).step_by(rows) {
        let part = from..length.min(from + rows);
        let mut group = file.next_row_group().expect("written");
        for column in columns {
            match column {
                Values::Booleans(values) => put::<BoolType>(&mut group, &values[part.clone()]),
                Values::Integers(values) => put::<Int32Type>(&mut group, &values[part.clone()]),
                Values::Longs(values) => put::<Int64Type>(&mut group, &values[part.clone()]),
                Values::Days(values) => put::<Int96Type>(&mut group, &values[part.clone()]),
                Values::Singles(values) => put::<FloatType>(&mut group, &values[part.clone()]),
                Values::Doubles(values) => put::<DoubleType>(&mut group, &values[part.clone()]),
                Values::Texts(values) => put::<ByteArrayType>(&mut group, &values[part.clone()]),
            }
        }
        group.close().expect("written");
    }
    file.into_inner().expect("written")
}

const SCHEMA: &str = "optional double t_s; optional double heading_deg; optional double rudder_deg;";

fn table(columns: [&[f64]; 3], compression: Compression, rows: usize) -> Vec<u8> {
    file(SCHEMA, &columns.map(|values| Values::Doubles(some(values))), compression, rows)
}

pub fn plain(time: &[f64], heading: &[f64], rudder: &[f64]) -> Vec<u8> {
    table([time, heading, rudder], Compression::SNAPPY, 1000)
}

/// The text of a file.
fn text(bytes: Vec<u8>) -> String {
    let mut text = String::new();
    crate::reader::columnar::BinaryFormat::Parquet
        .read_as_text(bytes)
        .expect("a file")
        .read_to_string(&mut text)
        .expect("UTF-8");
    text
}

#[test]
fn a_file_gives_the_record_of_its_csv_however_it_is_packed() {
    let [time, heading, rudder] = columns();
    let packings = [
        Compression::UNCOMPRESSED,
        Compression::SNAPPY,
        Compression::GZIP(GzipLevel::default()),
        Compression::LZ4,
        Compression::LZ4_RAW,
    ];
    for (compression, rows) in packings.into_iter().zip([1000, 100, 1, 240, 7]) {
        assert_plain(&table([&time, &heading, &rudder], compression, rows));
    }
    // More rows than are decoded at a time.
    let long: Vec<f64> = (0..10_000).map(f64::from).collect();
    let written = text(table([&long, &long, &long], Compression::SNAPPY, 9000));
    let expected = long.iter().map(|value| format!("{value:?}\t{value:?}\t{value:?}"));
    assert!(written.lines().skip(1).eq(expected));
}

#[test]
fn stamps_of_every_unit_are_those_of_the_csv() {
    let [time, heading, rudder] = columns();
    let begin = 1_795_183_385; // 2026-11-20T14:03:05Z
    let angles = || vec![Values::Doubles(some(&heading)), Values::Doubles(some(&rudder))];
    let csv: String = std::iter::once("time,heading_deg,rudder_deg\n".to_owned())
        .chain(rows().iter().map(|[t, psi, delta]| {
            let second = 3 * 60 + 5 + (t / 10.0) as u32;
            let part = *t as u32 % 10;
            format!("2026-11-20T14:{:02}:{:02}.{part},{psi},{delta}\n", second / 60, second % 60)
        }))
        .collect();
    let csv = parse(csv.as_bytes()).expect("stamps");
    for (unit, per_second) in [("MILLIS", 1_000), ("MICROS", 1_000_000), ("NANOS", 1_000_000_000)] {
        for utc in [true, false] {
            let stamps = time.iter().map(|t| Some(begin * per_second + *t as i64 * per_second / 10)).collect();
            let schema = format!(
                "optional int64 time (TIMESTAMP({unit},{utc})); optional double heading_deg; \
                 optional double rudder_deg;"
            );
            let columns: Vec<Values> = std::iter::once(Values::Longs(stamps)).chain(angles()).collect();
            let bytes = file(&schema, &columns, Compression::SNAPPY, 100);
            assert_same(&parse(&bytes).unwrap_or_else(|error| panic!("{error}")), &csv);
            let text = text(bytes);
            let line = text.lines().nth(2).expect("rows");
            assert!(
                line.starts_with(if utc { "2026-11-20T14:03:05.1Z\t" } else { "2026-11-20T14:03:05.1\t" }),
                "{line}"
            );
        }
    }
    let (seconds, parts) = (14 * 3600 + 3 * 60 + 5, 100_000_000);
    let old = time.iter().map(|t| {
        let nanoseconds = seconds * 1_000_000_000 + *t as u64 * parts;
        let mut stamp = Int96::new();
        stamp.set_data(nanoseconds as u32, (nanoseconds >> 32) as u32, 2_440_588 + 20_777);
        Some(stamp)
    });
    let old = Values::Days(old.collect());
    let [heading, rudder] = <[Values; 2]>::try_from(angles()).ok().expect("two");
    let schema = "optional double heading_deg; optional double rudder_deg; optional int96 time;";
    let bytes = file(schema, &[heading, rudder, old], Compression::SNAPPY, 100);
    assert_same(&parse(&bytes).expect("stamps of 96 bits"), &csv);
}

#[test]
fn values_of_every_type_are_written_as_text() {
    let schema = "optional int64 __index_level_0__; optional boolean on; optional int32 small (INTEGER(32,false)); \
                  optional int32 date (DATE); optional int32 price (DECIMAL(9,2)); optional float speed; \
                  optional binary note (UTF8); optional int64 at (TIME(MICROS,true)); \
                  optional binary big (DECIMAL(20,1)); \
                  optional group inner { optional double x; }";
    let columns = [
        Values::Longs(vec![Some(-7), None]),
        Values::Booleans(vec![Some(true), Some(false)]),
        Values::Integers(vec![Some(-1), None]),
        Values::Integers(vec![Some(20_777), None]),
        Values::Integers(vec![Some(-1234), None]),
        Values::Singles(vec![Some(0.1), Some(f32::NAN)]),
        Values::Texts(vec![Some("a\tb".into()), None]),
        Values::Longs(vec![Some(50_585_200_000), None]),
        Values::Texts(vec![Some(vec![0xff, 0x85].into()), None]),
        Values::Doubles(vec![Some(1.0), None]),
    ];
    let expected = "__index_level_0__\ton\tsmall\tdate\tprice\tspeed\tnote\tat\tbig\n\
                    -7\t1\t4294967295\t2026-11-20\t-12.34\t0.1\ta b\t14:03:05.2\t-12.3\n\t0\t\t\t\t\t\t\t\n";
    assert_eq!(text(file(schema, &columns, Compression::SNAPPY, 10)), expected);
    let nested = "optional group inner { optional double x; }";
    let bytes = file(nested, &[Values::Doubles(vec![Some(1.0)])], Compression::SNAPPY, 10);
    assert_refused(parse(&bytes), &["a Parquet file", "flat columns", "inner.x"]);
}

#[test]
fn missing_values_are_missing_and_sidecars_name_columns() {
    let [time, heading, rudder] = columns();
    let gappy = |values: &[f64], missing: usize| -> Vec<Option<f64>> {
        values.iter().enumerate().map(|(row, &value)| (row % 40 != missing).then_some(value)).collect()
    };
    let (heading, rudder, time) = (gappy(&heading, 5), gappy(&rudder, 11), gappy(&time, 23));
    let cell = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let lines =
        (0..time.len()).map(|row| format!("{},{},{},2.5\n", cell(time[row]), cell(heading[row]), cell(rudder[row])));
    let csv: String = std::iter::once("Zeit #1,kurs,ruder,speed_kn\n".to_owned()).chain(lines).collect();
    let sidecar = "[table]\nencoding = \"windows-1252\"\nseparator = \"comma\"\n[part]\nfrom-s = 10\nuntil-s = 200\n\
                   [[column]]\nname = \"Zeit #1\"\nis = \"t_s\"\n[[column]]\nname = \"kurs\"\nis = \"heading_deg\"\n\
                   [[column]]\nname = \"ruder\"\nis = \"rudder_deg\"\n";
    let csv = parse_with(csv.as_bytes(), sidecar).expect("a described table");
    let schema = "optional double #t; optional double kurs; optional double ruder; optional double speed_kn;";
    let schema = schema.replace("#t", "Zeit");
    let speed = vec![Some(2.5); time.len()];
    let columns = [time, heading, rudder, speed].map(Values::Doubles);
    let bytes = file(&schema, &columns, Compression::SNAPPY, 50);
    let reading = parse_with(&bytes, &sidecar.replace("Zeit #1", "Zeit")).expect("a described file");
    assert_same(&reading, &csv);
    assert_eq!(reading.trial.channel(Channel::Speed), csv.trial.channel(Channel::Speed));
    assert_eq!(reading.warnings, csv.warnings);
}

#[test]
fn damaged_files_and_other_packings_are_told() {
    let [time, heading, rudder] = columns().map(|values| values[..40].to_vec());
    assert_sound(&plain(&time, &heading, &rudder), "Parquet");
    assert_sound(&table([&time, &heading, &rudder], Compression::GZIP(GzipLevel::default()), 20), "Parquet");
    // Codecs that the writer does not support are set by hand: once for each column, after its path.
    let bytes = plain(&time, &heading, &rudder);
    for (codec, word) in [(6_u8, "zstd"), (4, "brotli"), (3, "LZO")] {
        let mut changed = bytes.clone();
        let at = codec_place(&changed, b"rudder_deg");
        changed[at] = 2 * codec;
        assert_refused(parse(&changed), &[word, "snappy"]);
    }
}

/// Position of the codec of the column with this name: after the path, as the next field of a Thrift struct.
fn codec_place(bytes: &[u8], name: &[u8]) -> usize {
    let ends = bytes.windows(name.len() + 1).enumerate();
    let matches = ends.filter(|(_, window)| window.starts_with(name) && window[name.len()] == 0x15);
    matches.map(|(at, _)| at + name.len() + 1).find(|&at| bytes[at] == 2).expect("snappy is there")
}
