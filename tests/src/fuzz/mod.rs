//! Damaged files for every reader. [`targets`] has one function per format: it passes bytes through the public
//! interface and asserts that the result is a valid reading or one message. Two programs generate the files:
//! [`runner`], with the small [`mutate`] on stable Rust and in every `cargo test`, and libFuzzer from the package in
//! `tests/fuzz`.
//!
//! `tests/fuzz/corpus/NAME` contains the initial files, `tests/fuzz/regressions/NAME` files that once caused a fault.

pub mod mutate;
pub mod runner;
mod seeds;
pub mod targets;

use std::path::PathBuf;

use targets::{cells, find, formula, gzip, manifest, nmea, record, rows, scenario, sidecar, stamp};

/// Target: a file format, and the check of a file in it.
#[derive(Clone, Copy)]
pub struct Target {
    /// Name of the folders of the target.
    pub name: &'static str,
    /// Check of one file; panics if an assertion fails. `true` if the file was accepted.
    pub run: fn(&[u8]) -> bool,
    /// Dictionary of words of the format, in `words/`; empty if there is none.
    dictionary: &'static str,
    /// Share of all cases, relative to the sum of all shares.
    pub share: usize,
    /// Initial files that are generated when the test runs.
    made: fn() -> Vec<Vec<u8>>,
}

/// All formats.
pub const TARGETS: [Target; 11] = [
    Target { name: "record", run: record, dictionary: "record", share: 6, made: Vec::new },
    Target { name: "nmea", run: nmea, dictionary: "nmea", share: 3, made: Vec::new },
    Target { name: "gzip", run: gzip, dictionary: "record", share: 2, made: seeds::packed },
    Target { name: "stamp", run: stamp, dictionary: "stamp", share: 2, made: Vec::new },
    Target { name: "find", run: find, dictionary: "record", share: 2, made: Vec::new },
    Target { name: "sidecar", run: sidecar, dictionary: "sidecar", share: 4, made: Vec::new },
    Target { name: "scenario", run: scenario, dictionary: "scenario", share: 4, made: Vec::new },
    Target { name: "rows", run: rows, dictionary: "", share: 2, made: seeds::rows },
    Target { name: "cells", run: cells, dictionary: "cells", share: 2, made: seeds::cells },
    Target { name: "manifest", run: manifest, dictionary: "scenario", share: 2, made: seeds::manifest },
    Target { name: "formula", run: formula, dictionary: "formula", share: 2, made: Vec::new },
];

impl Target {
    /// Initial files: files of the corpus, and generated files.
    pub fn corpus(&self) -> Vec<Vec<u8>> {
        let stored = self.files("corpus").into_iter().map(|path| read(&path));
        stored.chain((self.made)()).collect()
    }

    /// Files that once caused a fault.
    pub fn regressions(&self) -> Vec<PathBuf> {
        self.files("regressions")
    }

    /// Words of the format, from a dictionary in the format of libFuzzer: one quoted word a line, with `\xAB` for bytes
    /// that are not printable.
    pub fn words(&self) -> Vec<Vec<u8>> {
        let path = folder("words").join(self.dictionary).with_extension("dict");
        let text = if self.dictionary.is_empty() { Vec::new() } else { read(&path) };
        let text = String::from_utf8(text).expect("a dictionary is plain text");
        text.lines().filter_map(|line| line.strip_prefix('"')?.strip_suffix('"')).map(unescaped).collect()
    }

    fn files(&self, kind: &str) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder(kind).join(self.name)).into_iter().flatten();
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("the folder is readable").path()).collect();
        files.sort();
        files
    }
}

fn folder(kind: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("fuzz").join(kind)
}

fn unescaped(word: &str) -> Vec<u8> {
    let mut bytes = word.bytes();
    let mut plain = Vec::new();
    while let Some(byte) = bytes.next() {
        plain.push(match byte {
            b'\\' => match bytes.next().expect("a byte after a backslash") {
                b'x' => {
                    let digits: String = bytes.by_ref().take(2).map(char::from).collect();
                    u8::from_str_radix(&digits, 16).expect("two digits")
                }
                other => other,
            },
            byte => byte,
        });
    }
    plain
}

fn read(path: &std::path::Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
