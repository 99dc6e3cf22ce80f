//! Initial files that are generated: packed records, and files of a small study that is run once.

use std::sync::LazyLock;

use campaign::block::Block;
use campaign::collect::collect;
use campaign::design::Design;
use campaign::files;
use campaign::folder::ResultFolder;
use campaign::manifest::Manifest;
use campaign::scenario::Scenario;
use campaign::store::StoredStudy;
use tempfile::TempDir;

/// Files of the study, with its design and its manifest.
pub(super) struct Seed {
    folder: TempDir,
    /// Design of the study.
    pub design: Design,
    /// Manifest of the study.
    pub manifest: Manifest,
}

static STUDY: LazyLock<Seed> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let path = folder.path().join("small.toml");
    let scenario =
        Scenario::parse(&path, "small", include_str!("../../fuzz/corpus/scenario/small.toml").to_owned(), None)
            .unwrap_or_else(|failure| panic!("{failure}"));
    ResultFolder::make(folder.path())
        .and_then(|held| collect(&scenario, &held, false, &campaign::NoObserver))
        .unwrap_or_else(|failure| panic!("{failure}"));
    let stored = StoredStudy::read(folder.path()).unwrap_or_else(|failure| panic!("{failure}"));
    let StoredStudy { design, manifest, .. } = stored;
    Seed { design, manifest, folder }
});

/// Small study, run once.
pub(super) fn study() -> &'static Seed {
    &STUDY
}

fn stored(name: &str) -> Vec<Vec<u8>> {
    vec![super::read(&study().folder.path().join(name))]
}

/// First block of rows.
pub(super) fn rows() -> Vec<Vec<u8>> {
    stored(&format!("{}/{}.parquet", files::ROWS_FOLDER, Block { cell: 0, number: 0 }))
}

pub(super) fn cells() -> Vec<Vec<u8>> {
    stored(files::DESIGN_FILE)
}

pub(super) fn manifest() -> Vec<Vec<u8>> {
    stored(files::MANIFEST_FILE)
}

/// Packed table and packed log of sentences.
pub(super) fn packed() -> Vec<Vec<u8>> {
    let plain: [&[u8]; 2] =
        [include_bytes!("../../fuzz/corpus/record/plain.csv"), include_bytes!("../../fuzz/corpus/nmea/receiver.nmea")];
    plain.map(crate::logs::tables::packed).to_vec()
}
