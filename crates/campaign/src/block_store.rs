//! The blocks of a result folder: their presence, completeness and writing.
//!
//! A block is a file of rows and a file of timings. Each is written under a temporary name and renamed when it is
//! complete, the rows last. Every program computes the same rows for a block, so several programs may share a folder,
//! and files of several folders may be copied into one.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::block::Block;
use crate::design::Design;
use crate::disk;
use crate::failure::{Failure, OnPath};
use crate::files::{ROWS_FOLDER, TIMINGS_FOLDER};
use crate::folder::ResultFolder;
use crate::manifest::Manifest;
use crate::observer::Observer;
use crate::rows::{BlockFileError, BlockLabel, RowLayout, StudyRow, decode, encode};
use crate::timings::Timings;

/// Maximum size of a file of a block, bytes.
const MAX_BLOCK_BYTES: u64 = 1 << 30;

/// Blocks of one study in a folder.
pub struct TrialBlockStore<'a> {
    folder: PathBuf,
    design_sha256: String,
    seed: u64,
    program: String,
    design: &'a Design,
    layout: RowLayout,
}

impl<'a> TrialBlockStore<'a> {
    /// Store in a folder for the blocks of the study and the program that a manifest names.
    pub fn new(folder: &Path, manifest: &Manifest, design: &'a Design) -> Self {
        Self {
            folder: folder.to_owned(),
            design_sha256: manifest.design_sha256.clone(),
            seed: manifest.seed,
            program: manifest.program_label(),
            design,
            layout: RowLayout::from_design(design),
        }
    }

    fn label(&self, block: Block) -> BlockLabel {
        let (design, program) = (self.design_sha256.clone(), self.program.clone());
        BlockLabel { design, seed: self.seed, program, cell: block.cell, block: block.number }
    }

    /// File of a block.
    pub fn path(&self, block: Block) -> PathBuf {
        self.folder.join(ROWS_FOLDER).join(rows_name(block))
    }

    /// Stored rows of a block: all rows of its first trials; empty without a file. The inner error describes a damaged
    /// file.
    ///
    /// Fails if the file cannot be read, and if it is a block of another study, seed or program.
    pub fn read(&self, block: Block) -> Result<Result<Vec<StudyRow>, String>, Failure> {
        let path = self.path(block);
        let Some(bytes) = disk::read(&path, MAX_BLOCK_BYTES).on("read", &path)? else { return Ok(Ok(Vec::new())) };
        match decode(bytes, &self.label(block), &self.layout) {
            Ok(rows) => Ok(Ok(rows)),
            Err(BlockFileError::Changed(problem)) => Ok(Err(format!("{}: {problem}", path.display()))),
            Err(BlockFileError::OtherBlock(label)) => Err(Failure::in_file(&path, self.foreign(&label))),
        }
    }

    /// Rows of a block that was read before in this run.
    ///
    /// Fails as [`TrialBlockStore::read`] does, and if the file was damaged since.
    pub fn reread(&self, block: Block) -> Result<Vec<StudyRow>, Failure> {
        self.read(block)?.map_err(|problem| {
            Failure::execution(format!("{problem}; the file changed during this run; run the study again"))
        })
    }

    fn foreign(&self, label: &BlockLabel) -> String {
        let advice = "remove the file, give another folder with --out, or --restart to discard all rows";
        let problem = if label.design != self.design_sha256 {
            "it is a block of another study".to_owned()
        } else if label.seed != self.seed {
            format!("it is a block of the study with seed {}, expected seed {}", label.seed, self.seed)
        } else if label.program != self.program {
            format!("it was computed by {}, expected {}", label.program, self.program)
        } else {
            format!("it is block {}", label.block())
        };
        format!("{problem}; {advice}")
    }

    /// Number of stored trials of each block that `is_asked` selects and that has a file. A damaged block is omitted
    /// with a warning, in which `becomes` states what happens to its trials.
    ///
    /// Fails if a file cannot be read, and if one is a block of another study, seed or program.
    pub fn stored_trials(
        &self,
        is_asked: impl Fn(Block) -> bool + Sync,
        becomes: &str,
        observer: &dyn Observer,
    ) -> Result<HashMap<Block, u64>, Failure> {
        let trials = |rows: Vec<StudyRow>| (rows.len() / self.layout.method_count()) as u64;
        let look = |block: Block| match self.read(block)? {
            Ok(rows) => Ok(Some((block, trials(rows)))),
            Err(problem) => {
                observer.warn(&format!("{problem}; {becomes}"));
                Ok(None)
            }
        };
        let is_due = |block: &Block| block.cell < self.design.cells.len() && is_asked(*block);
        blocks_in(&self.folder)?.into_par_iter().filter(is_due).filter_map(|block| look(block).transpose()).collect()
    }

    /// Stores rows and timings of the trials of a block, from its first trial on.
    pub fn write(&self, block: Block, rows: &[StudyRow], timings: &Timings) -> Result<(), Failure> {
        let results = ResultFolder::make(&self.folder)?;
        let bytes = encode(rows, &self.label(block), &self.layout);
        let bytes = bytes.map_err(|error| Failure::execution(format!("{}: {error}", self.path(block).display())))?;
        results.subfolder(TIMINGS_FOLDER)?.write(&timings_name(block), timings.to_csv(self.design)?)?;
        results.subfolder(ROWS_FOLDER)?.write(&rows_name(block), bytes)
    }

    /// Timings of a block; empty if they are missing or damaged. Fails if the file cannot be read.
    pub fn timings(&self, block: Block) -> Result<Timings, Failure> {
        let path = self.folder.join(TIMINGS_FOLDER).join(timings_name(block));
        let text = disk::read(&path, MAX_BLOCK_BYTES).on("read", &path)?.unwrap_or_default();
        Ok(Timings::from_csv(&text, self.design).unwrap_or_default())
    }

    /// Blocks of the design in order, each with its number of trials.
    pub fn design_blocks(&self) -> impl Iterator<Item = (Block, u64)> {
        self.design.cells.iter().enumerate().flat_map(|(cell, facts)| {
            let count = facts.stored_replicates.end;
            let blocks = (0..Block::count_in_cell(count)).map(move |number| Block { cell, number });
            blocks.map(move |block| (block, block.replicate_range(count).count() as u64))
        })
    }

    /// Passes every row of the design to `take`, in order. Fails if a block is missing, incomplete or damaged.
    pub fn for_each_row(&self, mut take: impl FnMut(StudyRow) -> Result<(), Failure>) -> Result<(), Failure> {
        let blocks: Vec<(Block, u64)> = self.design_blocks().collect();
        let whole = |&(block, trials): &(Block, u64)| {
            let content = self.read(block)?;
            let expected = trials as usize * self.layout.method_count();
            let rows = content.and_then(|rows| match rows.len() == expected {
                true => Ok(rows),
                false => Err(format!("{}: the block is missing or incomplete", self.path(block).display())),
            });
            rows.map_err(|problem| Failure::input(format!("{problem}; run the study again; complete blocks are kept")))
        };
        // A chunk of blocks is decoded in parallel.
        for some in blocks.chunks(2 * rayon::current_num_threads()) {
            let read: Vec<Result<Vec<StudyRow>, Failure>> = some.par_iter().map(whole).collect();
            for rows in read {
                rows?.into_iter().try_for_each(&mut take)?;
            }
        }
        Ok(())
    }
}

/// Blocks of a result folder, from the file names.
fn blocks_in(folder: &Path) -> Result<Vec<Block>, Failure> {
    let rows = folder.join(ROWS_FOLDER);
    if !disk::path_exists(&rows).on("look for", &rows)? {
        return Ok(Vec::new());
    }
    let names = disk::entry_names(&rows).on("list", &rows)?;
    Ok(names.iter().filter_map(|name| block_from_file_name(name, "parquet")).collect())
}

/// `true` if a folder contains blocks, of any study. Fails if it cannot be listed.
pub fn has_blocks(folder: &Path) -> Result<bool, Failure> {
    Ok(!blocks_in(folder)?.is_empty())
}

/// Removes all blocks of a folder, of any study.
pub fn discard_blocks(folder: &ResultFolder) -> Result<(), Failure> {
    for (name, extension) in [(ROWS_FOLDER, "parquet"), (TIMINGS_FOLDER, "csv")] {
        if disk::path_exists(&folder.path().join(name)).on("look for", &folder.path().join(name))? {
            folder.subfolder(name)?.remove_matching(|file| block_from_file_name(file, extension).is_some())?;
        }
    }
    Ok(())
}

fn rows_name(block: Block) -> String {
    format!("{block}.parquet")
}

fn timings_name(block: Block) -> String {
    format!("{block}.csv")
}

/// Block whose file has this name; `None` for a name that is not of a block.
fn block_from_file_name(name: &str, extension: &str) -> Option<Block> {
    let (cell, number) = name.strip_suffix(extension)?.strip_suffix('.')?.split_once('-')?;
    let block = Block { cell: cell.parse().ok()?, number: number.parse().ok()? };
    (name == format!("{block}.{extension}")).then_some(block)
}
