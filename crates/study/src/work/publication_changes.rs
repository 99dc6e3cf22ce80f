//! What a new publication changes: files, and figures of tables that moved beyond their noise.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use campaign::disk;
use campaign::files::{MANIFEST, TIMINGS};
use scenario::failure::{Failure, OnPath};

use super::publication::{STAMP, published_files};

/// Largest file that is compared, bytes.
const LARGEST: u64 = 1 << 28;

/// Smallest change that counts, relative: where there is no noise, arithmetic alone moves the last digits.
const LEAST: f64 = 1e-3;

/// What changed in the folder of a study or a program.
#[derive(Debug, Default, PartialEq)]
pub struct PublicationChanges {
    /// Files that are new, gone or other than they were. What says when and where something was run is not among them.
    pub files: Vec<PathBuf>,
    /// Figures with an interval in tables that have the same lines and columns as before.
    pub figures: usize,
    /// Those that changed by a thousandth or more and whose 95 % interval no longer touches what it was, the farthest
    /// first.
    pub moved: Vec<MovedFigure>,
}

/// A figure of a table that is another one.
#[derive(Debug, PartialEq)]
pub struct MovedFigure {
    /// Where it stands: the file, the words before the figures of its line, and the column.
    pub place: String,
    /// What it was, with its 95 % interval.
    pub before: [f64; 3],
    /// What it is.
    pub after: [f64; 3],
}

impl MovedFigure {
    /// Distance of the two intervals as a multiple of their mean width.
    fn distance(&self) -> f64 {
        let [[_, low, high], [_, least, most]] = [self.before, self.after];
        (least - high).max(low - most) / (0.5 * (high - low + most - least)).max(f64::MIN_POSITIVE)
    }
}

/// Holds a folder against what it was.
///
/// Fails when one of them cannot be read.
pub fn changes(before: &Path, after: &Path) -> Result<PublicationChanges, Failure> {
    let of = |folder: &Path| if folder.is_dir() { published_files(folder) } else { Ok(Vec::new()) };
    let files: BTreeSet<PathBuf> = of(before)?.into_iter().chain(of(after)?).collect();
    let mut found = PublicationChanges::default();
    for file in files.into_iter().filter(|file| ![MANIFEST, TIMINGS, STAMP].iter().any(|name| file.ends_with(name))) {
        let read = |folder: &Path| disk::read(&folder.join(&file), LARGEST).on("read", &folder.join(&file));
        let (old, new) = (read(before)?, read(after)?);
        if let (Some(old), Some(new), true) = (&old, &new, file.extension().is_some_and(|end| end == "csv")) {
            let name = file.display().to_string();
            let (figures, moved) = moved(&name, old, new).on("compare", &after.join(&file))?;
            found.figures += figures;
            found.moved.extend(moved);
        }
        if old != new {
            found.files.push(file);
        }
    }
    found.moved.sort_by(|one, other| other.distance().total_cmp(&one.distance()));
    Ok(found)
}

/// How many figures with an interval two tables have, and those that moved; none where their lines or columns differ.
fn moved(name: &str, old: &[u8], new: &[u8]) -> Result<(usize, Vec<MovedFigure>), csv::Error> {
    let lines = |bytes: &[u8]| -> Result<Vec<csv::StringRecord>, csv::Error> {
        csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(bytes).records().collect()
    };
    let (old, new) = (lines(old)?, lines(new)?);
    let (Some(head), true) = (new.first(), old.len() == new.len() && old.first() == new.first()) else {
        return Ok((0, Vec::new()));
    };
    let named = |column: usize, words: [&str; 2]| {
        head.get(column).is_some_and(|name| name.split_whitespace().any(|word| words.contains(&word)))
    };
    let has_interval = |column: &usize| {
        !named(*column, ["lower", "low"]) && named(column + 1, ["lower", "low"]) && named(column + 2, ["upper", "high"])
    };
    let columns: Vec<usize> = (0..head.len()).filter(has_interval).collect();
    let figure = |line: &csv::StringRecord, column: usize| -> Option<[f64; 3]> {
        let cell = |place: usize| line.get(place)?.parse().ok();
        Some([cell(column)?, cell(column + 1)?, cell(column + 2)?])
    };
    let (mut figures, mut found) = (0, Vec::new());
    for (old, new) in old.iter().zip(&new).skip(1) {
        for &column in &columns {
            let (Some(before), Some(after)) = (figure(old, column), figure(new, column)) else { continue };
            figures += 1;
            let is_same = (before[0] - after[0]).abs() <= LEAST * before[0].abs().max(after[0].abs());
            if !is_same && (before[2] < after[1] || after[2] < before[1]) {
                let line = new.iter().take(columns[0]).filter(|cell| !cell.is_empty()).collect::<Vec<_>>().join(", ");
                found.push(MovedFigure { place: format!("{name}, {line}: {}", &head[column]), before, after });
            }
        }
    }
    Ok((figures, found))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "noise,method,trials,T rms,T rms lower 95,T rms upper 95,all low,all low high\n";

    #[test]
    fn a_figure_has_moved_when_the_intervals_do_not_touch() {
        let old = format!("{HEAD}0.1,a,9,2,1,3,,\n0.2,a,9,5,4,6,,\n0.3,a,9,–,–,–,,\n0.4,a,9,7,7,7,,\n");
        let new = format!("{HEAD}0.1,a,9,3,2,4,,\n0.2,a,9,8,7,9,,\n0.3,a,9,1,1,1,,\n0.4,a,9,7.001,7.001,7.001,,\n");
        let (figures, moved) = moved("t.csv", old.as_bytes(), new.as_bytes()).expect("tables");
        let place = "t.csv, 0.2, a, 9: T rms".to_owned();
        assert_eq!(moved, [MovedFigure { place, before: [5.0, 4.0, 6.0], after: [8.0, 7.0, 9.0] }]);
        assert_eq!((figures, moved[0].distance()), (3, 0.5));
    }

    #[test]
    fn files_that_come_and_go_are_changes() {
        let desk = tempfile::tempdir().expect("a folder");
        let [before, after] = ["before", "after"].map(|name| desk.path().join(name));
        std::fs::create_dir_all(after.join("inside")).expect("a folder");
        assert_eq!(changes(&before, &after).expect("read"), PublicationChanges::default());
        for name in ["manifest.toml", "a.svg", "inside/a.png"] {
            std::fs::write(after.join(name), name).expect("a file");
        }
        assert_eq!(changes(&before, &after).expect("read").files, [PathBuf::from("inside/a.png")]);
        assert!(changes(&after, &after).expect("read").files.is_empty());
    }
}
