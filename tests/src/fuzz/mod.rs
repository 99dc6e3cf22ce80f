//! Damaged files for every reader. [`targets`] holds one function a format: it feeds bytes through the public interface
//! and asserts what every reader promises, which is a reading that makes sense or one message. Two things feed them:
//! [`runner`], with the small [`mutate`] on stable Rust and in every `cargo test`, and libFuzzer from the package in
//! `tests/fuzz`.
//!
//! `tests/fuzz/corpus/NAME` holds whole files to begin with, `tests/fuzz/regressions/NAME` what once broke something.

pub mod mutate;
pub mod runner;
mod seeds;
pub mod targets;

use std::path::PathBuf;

use targets::{cells, find, gzip, manifest, nmea, record, rows, scenario, sidecar, stamp};

/// A format, and what is done with a file of it.
#[derive(Clone, Copy)]
pub struct Target {
    /// Name of its folders.
    pub name: &'static str,
    /// Feeds one file through and asserts, panicking when a promise is broken; whether the file was accepted.
    pub run: fn(&[u8]) -> bool,
    /// What files of the format are made of.
    pub words: &'static [&'static str],
    /// Its part of all cases, of the sum of all shares.
    pub share: usize,
    /// Files to begin with that are made when the test runs.
    made: fn() -> Vec<Vec<u8>>,
}

/// Every format.
pub const TARGETS: [Target; 10] = [
    Target { name: "record", run: record, words: mutate::RECORD, share: 6, made: Vec::new },
    Target { name: "nmea", run: nmea, words: mutate::NMEA, share: 3, made: Vec::new },
    Target { name: "gzip", run: gzip, words: mutate::RECORD, share: 2, made: seeds::packed },
    Target { name: "stamp", run: stamp, words: mutate::STAMP, share: 2, made: Vec::new },
    Target { name: "find", run: find, words: mutate::RECORD, share: 2, made: Vec::new },
    Target { name: "sidecar", run: sidecar, words: mutate::SIDECAR, share: 4, made: Vec::new },
    Target { name: "scenario", run: scenario, words: mutate::SCENARIO, share: 4, made: Vec::new },
    Target { name: "rows", run: rows, words: &[], share: 2, made: seeds::rows },
    Target { name: "cells", run: cells, words: mutate::CELLS, share: 2, made: seeds::cells },
    Target { name: "manifest", run: manifest, words: mutate::SCENARIO, share: 2, made: seeds::manifest },
];

impl Target {
    /// The files to begin with: those of the corpus, and those that are made.
    pub fn corpus(&self) -> Vec<Vec<u8>> {
        let stored = self.files("corpus").into_iter().map(|path| read(&path));
        stored.chain((self.made)()).collect()
    }

    /// Files that once broke something.
    pub fn regressions(&self) -> Vec<PathBuf> {
        self.files("regressions")
    }

    fn files(&self, kind: &str) -> Vec<PathBuf> {
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("fuzz").join(kind).join(self.name);
        let entries = std::fs::read_dir(&folder).into_iter().flatten();
        let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("the folder is readable").path()).collect();
        files.sort();
        files
    }
}

fn read(path: &std::path::Path) -> Vec<u8> {
    std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
