//! Measured records as commands are given them: read with their warnings, told apart by name.

use std::path::{Path, PathBuf};

use trial::{Origin, Reading, Trial};

use scenario::failure::Failure;
use scenario::name;

/// Reads a record; what the reader noticed goes to `warnings`. `columns` is a description of its columns, or a folder
/// that holds one for it.
pub fn read(path: &Path, columns: Option<&Path>, warnings: &mut Vec<String>) -> Result<Trial, Failure> {
    if path.extension().is_some_and(|extension| extension == "toml") && !path.to_string_lossy().ends_with(".trial.toml")
    {
        return Err(Failure::input(format!(
            "{0}: this is a TOML file and no record; expected a table of time, heading and rudder. A scenario is run with \
             `study {0}`, a description of columns is given with `--columns {0}`",
            path.display()
        )));
    }
    // A folder holds a description for each record, under the name of the record.
    let own = columns.filter(|columns| columns.is_dir()).and_then(|folder| {
        let stem = path.file_stem()?.to_string_lossy().into_owned();
        Some(folder.join(format!("{stem}.trial.toml"))).filter(|own| own.is_file())
    });
    // Folders and figures are named after the record.
    name::of_file(path)?;
    let reading = match (columns, &own) {
        (_, Some(own)) => trial::read_with(path, Some(own)),
        (Some(columns), None) if !columns.is_dir() => trial::read_with(path, Some(columns)),
        _ => trial::read(path),
    };
    let Reading { trial, warnings: found } = reading.map_err(Failure::input)?;
    warnings.extend(found.into_iter().map(|warning| format!("{}: {warning}", path.display())));
    Ok(trial)
}

/// The same record counts only once: given twice for identification its errors come out too small, and on a record that
/// was fitted there is nothing to validate.
pub fn warn_of_repetition(trials: &[Trial], others: &[Trial], warnings: &mut Vec<String>) {
    for (number, trial) in trials.iter().enumerate() {
        if trials[..number].iter().any(|before| file_of(before).1 == file_of(trial).1) {
            let (file, _) = file_of(trial);
            warnings.push(format!(
                "{file}: given twice with the same content; it counts twice, and the intervals are too narrow"
            ));
        }
    }
    for other in others {
        if trials.iter().any(|trial| file_of(trial).1 == file_of(other).1) {
            let (file, _) = file_of(other);
            warnings
                .push(format!("{file}: used for identification and for validation; the error on it validates nothing"));
        }
    }
}

/// A name for every record: its own, with a number where several have the same.
pub fn names(own: impl Iterator<Item = impl AsRef<str>>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in own {
        let name = name.as_ref();
        let numbered = (2..).map(|number| format!("{name}-{number}"));
        let unique = std::iter::once(name.to_owned()).chain(numbered).find(|candidate| !names.contains(candidate));
        names.push(unique.expect("one of the endless numbers is free"));
    }
    names
}

/// Where the results of a command go unless a folder is named: by the record, or by the first of several and their
/// number.
pub fn default_folder(trials: &[Trial], command: &str) -> PathBuf {
    let first = trials[0].name();
    PathBuf::from(match trials.len() {
        1 => format!("{first}-{command}"),
        several => format!("{first}-and-{}-more-{command}", several - 1),
    })
}

/// File and hash of a measured record.
pub fn file_of(trial: &Trial) -> (&str, &str) {
    match trial.origin() {
        Origin::Measured { file, sha256 } => (file, sha256),
        Origin::Simulated { scenario, .. } => (scenario, ""),
    }
}

#[cfg(test)]
mod tests {
    use super::names;

    #[test]
    fn no_two_records_have_the_same_name() {
        assert_eq!(names(["a", "b", "a", "a"].into_iter()), ["a", "b", "a-2", "a-3"]);
        assert_eq!(names(["a", "a-2", "a"].into_iter()), ["a", "a-2", "a-3"]);
        assert_eq!(names(["a", "a", "a-2"].into_iter()), ["a", "a-2", "a-2-2"]);
    }
}
