//! Binary files give the record of the same table in CSV, and damaged ones a message.

mod matlab;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(feature = "spreadsheets")]
mod spreadsheet;

use std::io::{Read, Write};

use crate::reader::lines::sha256;
use crate::reader::tests::{parse, parse_with, rows, simple};
use crate::reader::{ReadError, ReadRecord, read};
use crate::record::RecordOrigin;

/// Time, heading and rudder of the rows of the plainest table.
fn columns() -> [Vec<f64>; 3] {
    [0, 1, 2].map(|column| rows().iter().map(|row| row[column]).collect())
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Checks that two readings contain the same record.
fn assert_same(first: &ReadRecord, second: &ReadRecord) {
    let (first, second) = (&first.trial, &second.trial);
    assert_eq!(bits(first.time()), bits(second.time()));
    assert_eq!(bits(first.heading()), bits(second.heading()));
    assert_eq!(bits(first.rudder()), bits(second.rudder()));
}

/// Checks that a file contains the plainest record and has the hash of its bytes.
fn assert_plain(bytes: &[u8]) -> ReadRecord {
    let reading = parse(bytes).unwrap_or_else(|error| panic!("{error}"));
    assert_same(&reading, &parse(simple().as_bytes()).expect("a plain table"));
    assert_eq!(hash(&reading), sha256(bytes));
    reading
}

fn hash(reading: &ReadRecord) -> &str {
    let RecordOrigin::Measured { sha256, .. } = reading.trial.origin() else { panic!("it was read from a file") };
    sha256
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packed.write_all(bytes).expect("memory takes all");
    packed.finish().expect("memory takes all")
}

/// Checks that a message has these parts.
fn assert_refused(result: Result<ReadRecord, ReadError>, parts: &[&str]) {
    let message = result.expect_err("the file is wrong").to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

/// Truncates a file and changes its bytes one by one: the result is a record or a message about `format`.
fn assert_sound(file: &[u8], format: &str) {
    for end in (16..file.len()).step_by(7) {
        assert_refused(parse(&file[..end]), &[format]);
    }
    let mut bytes = file.to_vec();
    for index in 0..file.len() {
        for change in [0xff, 1 << (index % 8)] {
            bytes[index] ^= change;
            let _ = parse(&bytes);
            bytes[index] = file[index];
        }
    }
}

#[cfg(feature = "parquet")]
#[test]
fn the_hash_is_that_of_the_bytes_on_the_disk() {
    let folder = tempfile::tempdir().expect("a folder");
    let [time, heading, rudder] = columns();
    for text in [simple().into_bytes(), parquet::plain(&time, &heading, &rudder)] {
        for bytes in [text.clone(), packed(&text)] {
            assert_plain(&bytes);
            let path = folder.path().join("run.gz");
            std::fs::write(&path, &bytes).expect("written");
            assert_eq!(hash(&read(&path).expect("a record")), sha256(&bytes));
        }
    }
}

#[test]
fn what_is_not_read_is_named_with_a_cure() {
    assert_refused(parse(b"MATLAB 7.3 MAT-file, Platform: GLNXA64"), &["HDF5", "-v7"]);
    let candump = "(1436509052.249713) can0 09F1120A#FF1027FF7FFF7FFD\n".repeat(9);
    let table = format!("Time,ID,DLC,Data\n{}", "0.01,0x9F1120A,8,FF 10 27 FF 7F FF 7F FD\n".repeat(9));
    for frames in [candump, table] {
        assert_refused(
            parse(frames.as_bytes()),
            &["CAN frames in hexadecimal", "`candump2analyzer`", "`analyzer -json`"],
        );
    }
    assert_refused(parse(b"PARE and more"), &["encrypted"]);
    #[cfg(not(feature = "parquet"))]
    assert_refused(parse(b"PAR1 and more"), &["export it as CSV", "feature `parquet`"]);
    #[cfg(not(feature = "spreadsheets"))]
    assert_refused(parse(b"PK\x03\x04 and more"), &["export it as CSV", "feature `spreadsheets`"]);
}

#[test]
fn a_long_text_is_written_as_it_is_read() {
    let mut written = super::text::ChunkReader::new(std::iter::repeat_with(|| Ok("1\t2\t3\n".to_owned())));
    let mut first = [0; 10];
    written.read_exact(&mut first).expect("there is no end of it");
    assert_eq!(&first, b"1\t2\t3\n1\t2\t");
}
