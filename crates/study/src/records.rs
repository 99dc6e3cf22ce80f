//! Measured records of a command: expanded from folders, read with their warnings, named uniquely.

use std::path::{Path, PathBuf};

use document::{TrialParticularsEntry, Warning, WarningCode, WarningSource, Warnings};
use estimation::statistics::upper_median;
use report::number::fixed;
use ship::angle::KNOT;
use ship::vessel::prior::HullParticulars;
use ship::{Particulars, ShortNumber};
use trial::file::{STDIN_PATH, display_path};
use trial::{Channel, InstrumentLog, ReadError, ReadRecord, RecordOrigin, Sidecar, SidecarError, Trial};

use crate::options::{ReadingOptions, TimePoint};
use campaign::failure::{Failure, FailureParts, OnPath};
use campaign::identified_ship::RecordFacts;
use campaign::outside_estimates::TRIALS_FILE;
use campaign::scenario::name;

/// File name extensions of records in a folder.
const ENDINGS: [&str; 11] = ["csv", "tsv", "txt", "dat", "asc", "log", "nmea", "gz", "parquet", "xlsx", "mat"];

/// Files of the given paths. A folder means all its records, in the order of their names, and `-` means standard input.
///
/// Fails if a folder has no record, or if standard input is to be read twice.
pub fn record_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    if paths.iter().filter(|path| *path == Path::new(STDIN_PATH)).count() > 1 {
        return Err(Failure::input("- is given twice, but standard input holds one record; give files for the others"));
    }
    let mut files = Vec::new();
    for path in paths {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        // A folder of simulated records also holds a list and answers; only records have a file of true values.
        let is_simulated = path.join(TRIALS_FILE).is_file();
        let is_record = |file: &PathBuf| {
            let ending = file.extension().map(|ending| ending.to_string_lossy().to_ascii_lowercase());
            file.is_file()
                && ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()))
                && (!is_simulated || file.with_extension("truth.json").is_file())
        };
        let entries = std::fs::read_dir(path).on("read", path)?;
        let mut records: Vec<PathBuf> = entries.filter_map(|file| Some(file.ok()?.path())).filter(is_record).collect();
        records.sort();
        if records.is_empty() {
            let endings = ENDINGS.join(", .");
            return Err(Failure::in_file(
                path,
                format!("this folder holds no record; expected files that end in .{endings}"),
            ));
        }
        files.extend(records);
    }
    Ok(files)
}

/// Log of a file, joined with the channels of the files `parts`. `columns` is a description of its columns (a sidecar),
/// or a folder with such a description. Adds the warnings of the reader to `warnings`.
///
/// Fails if the file is not a log, or if no results can be named after it.
pub fn open_log(
    path: &Path,
    columns: Option<&Path>,
    parts: &[PathBuf],
    warnings: &mut Warnings,
) -> Result<InstrumentLog, Failure> {
    if path.extension().is_some_and(|extension| extension == "toml") && !path.to_string_lossy().ends_with(".trial.toml")
    {
        return Err(Failure::input(format!(
            "{0}: this is a TOML file, not a record; expected a table of time, heading and rudder. Run a scenario with `study {0}`; give \
             a description of columns with `--columns {0}`",
            path.display()
        )));
    }
    // Folders and figures are named after the record.
    name::study_name(display_path(path))?;
    let sidecar = Sidecar::path_for(path, columns);
    let mut log = InstrumentLog::open(path, sidecar.as_deref(), parts).map_err(refused)?;
    warnings.extend(warning_source(display_path(path)).attach_to(std::mem::take(&mut log.warnings)));
    Ok(log)
}

/// A record as the source of warnings; `path` is its name in messages.
pub fn warning_source(path: &Path) -> WarningSource {
    WarningSource::Record(path.display().to_string())
}

/// Failure for a file that is not a usable record, with file, line and code as parts.
fn refused(error: ReadError) -> Failure {
    let code = error.code();
    let failure = match error {
        ReadError::Table { file, problem } => Failure::in_file(&file, problem),
        ReadError::Sidecar(error) => {
            let SidecarError { file, line, problem } = &error;
            let (file, problem) = (Some(file.display().to_string()), problem.to_string());
            let parts = FailureParts { file, line: *line, problem, ..FailureParts::default() };
            Failure { parts: Box::new(parts), ..Failure::input(&error) }
        }
    };
    failure.with_code(code)
}

/// Records to identify: the selected part of each log, else its only zig-zag, or the whole log if it holds none.
///
/// Fails if a record cannot be read, if a log holds several zig-zags and none is selected, or if an option for one
/// record is given for several.
pub fn read_records(
    paths: &[PathBuf],
    options: &ReadingOptions,
    warnings: &mut Warnings,
) -> Result<Vec<Trial>, Failure> {
    let files = record_files(paths)?;
    let one_only = [
        ("--with-columns", !options.with_columns.is_empty()),
        ("--trial", options.trial.is_some()),
        ("--from and --until", options.from.is_some() || options.until.is_some()),
    ];
    if let Some((option, _)) = one_only.iter().find(|(_, given)| *given && files.len() > 1) {
        return Err(Failure::input(format!("{option} is for one record, but {} are given; give one", files.len())));
    }
    files.iter().map(|path| read(path, options, warnings)).collect()
}

/// Records for replay only, without the options for one record: the only zig-zag of each log, or the whole log.
pub fn read_for_replay(
    paths: &[PathBuf],
    options: &ReadingOptions,
    warnings: &mut Warnings,
) -> Result<Vec<Trial>, Failure> {
    let (columns, ship) = (options.columns.clone(), options.ship.clone());
    let plain = ReadingOptions { columns, ship, ..ReadingOptions::default() };
    record_files(paths)?.iter().map(|path| read(path, &plain, warnings)).collect()
}

fn read(path: &Path, options: &ReadingOptions, warnings: &mut Warnings) -> Result<Trial, Failure> {
    trial_from_log(
        open_log(path, options.columns.as_deref(), &options.with_columns, warnings)?,
        display_path(path),
        options,
        warnings,
    )
}

/// Record in a log: the selected part, else the only zig-zag, or the whole log if it holds none. `path` is its name in
/// messages.
///
/// Fails if that part is not a record, or if the log holds several zig-zags and none is selected.
pub fn trial_from_log(
    log: InstrumentLog,
    path: &Path,
    options: &ReadingOptions,
    warnings: &mut Warnings,
) -> Result<Trial, Failure> {
    let (from, until) = (moment(&log, path, options.from.as_ref())?, moment(&log, path, options.until.as_ref())?);
    let log = if from.is_some() || until.is_some() {
        log.into_interval(from.unwrap_or(f64::NEG_INFINITY), until.unwrap_or(f64::INFINITY)).map_err(refused)?
    } else {
        log.into_manoeuvre(options.trial).map_err(refused)?
    };
    let ship = ship(&log, path, options, warnings)?;
    let ReadRecord { trial, warnings: reader_warnings } = log.into_trial(ship).map_err(refused)?;
    warnings.extend(warning_source(path).attach_to(reader_warnings));
    with_declared(trial, path, options)
}

/// Record with the particulars of hull and trial given as options, which override those of a sidecar. Particulars of a
/// ship of another length are dropped.
///
/// Fails if the draughts contradict one another, if particulars of the hull are given without length and speed, or if
/// one is out of range.
fn with_declared(trial: Trial, path: &Path, options: &ReadingOptions) -> Result<Trial, Failure> {
    let mut conditions = trial.conditions().clone();
    let length = trial.particulars().map(|ship| ship.length);
    if conditions.particulars.is_some_and(|ship| Some(ship.length) != length) {
        conditions.hull = HullParticulars::default();
        (conditions.trial.draught_fore, conditions.trial.draught_aft) = (None, None);
    }
    conditions.trial = options.trial_particulars.completed_by(&conditions.trial);
    let options = &options.ship.form;
    options.apply(&mut conditions.hull);
    conditions.hull.draught = conditions.hull.draught.or(conditions.trial.mean_draught());
    if let Some(draught) = conditions.hull.draught.filter(|draught| !conditions.trial.admits_draught(*draught)) {
        let [fore, aft] = conditions.trial.draughts().unwrap_or_default();
        let text = format!("draught-m = {draught} is not between the draughts fore, {fore} m, and aft, {aft} m");
        return Err(Failure::in_file(path, format!("{text}; give --draught-m as well, or leave these out")));
    }
    let trial = trial.with_conditions(conditions);
    if let Some(key) = options.first_key() {
        let advice = "give --length-m as well, or declare it under [ship] in a sidecar";
        let unknown = || Failure::in_file(path, format!("--{key} needs length and speed of the ship; {advice}"));
        trial.hull().ok_or_else(unknown)?.check().map_err(|error| Failure::in_file(path, error))?;
    }
    Ok(trial)
}

/// Document entry with ship, date and draughts of a record.
pub fn trial_particulars_entry(trial: &Trial) -> TrialParticularsEntry {
    let (of_trial, hull) = (&trial.conditions().trial, trial.conditions().hull);
    TrialParticularsEntry {
        ship_name: of_trial.ship_name.clone(),
        date: of_trial.date.clone(),
        draught_fore_m: of_trial.draught_fore,
        draught_aft_m: of_trial.draught_aft,
        draught_m: of_trial.mean_draught().or(hull.draught),
    }
}

/// Requested time on the clock of a record, s; `None` if none is requested.
///
/// Fails for a time of day that the clock does not show.
fn moment(log: &InstrumentLog, path: &Path, asked: Option<&TimePoint>) -> Result<Option<f64>, Failure> {
    match asked {
        None => Ok(None),
        Some(TimePoint::Seconds(seconds)) => Ok(Some(*seconds)),
        Some(TimePoint::Clock(stamp, text)) => {
            let time = log.clock.and_then(|clock| clock.record_time(stamp));
            time.map(Some).ok_or_else(|| {
                Failure::in_file(
                    path,
                    format!("`{text}` is a time of day that the clock of this record does not show; give seconds"),
                )
            })
        }
    }
}

/// Length and approach speed from the options; `None` without a length. A speed that is not given is the median of the
/// positive speeds in the first tenth of the record, with a warning.
///
/// Fails if no speed is given and the record has none there.
fn ship(
    log: &InstrumentLog,
    path: &Path,
    options: &ReadingOptions,
    warnings: &mut Warnings,
) -> Result<Option<Particulars>, Failure> {
    let Some(length) = options.ship.scale.length_m else { return Ok(None) };
    if let Some(speed) = options.ship.scale.speed() {
        return Ok(Some(Particulars { length, speed }));
    }
    let first = log.channel(Channel::Speed).map(|speed| &speed[..speed.len().div_ceil(10)]);
    let speeds = first.into_iter().flatten().copied().filter(|speed| *speed > 0.0);
    let Some(speed) = upper_median(speeds) else {
        let advice = "add --speed-kn or --speed-m-s to --length-m";
        return Err(Failure::in_file(path, format!("the record has no speed; {advice}")));
    };
    let text = format!("the approach speed is taken from the record, {} kn in its first tenth", fixed(speed / KNOT, 2));
    warnings.push(WarningCode::Scale, warning_source(path), text);
    Ok(Some(Particulars { length, speed }))
}

/// Warning with the reason why records with a speed or positions give no track; `None` if they give one or have
/// neither.
pub fn missing_track_warning(shown: &RecordFacts) -> Option<Warning> {
    shown.no_track_reason.as_ref().map(|why| WarningCode::NoTrack.warning(why))
}

/// Message on a rudder that was logged `late` seconds late, which shows as a negative dead time; with the remedy.
pub fn late_rudder_message(late: f64) -> String {
    let late = ShortNumber::rounded(late, 2);
    format!(
        "the dead time is −{late} s, which no steering gear has: the rudder was logged {late} s late; write `late-s = {late}` under \
         [rudder] in a sidecar NAME.trial.toml"
    )
}

/// Warnings on repeated records. A record given twice for identification makes the standard deviations too small, and a
/// fitted record gives no validation.
pub fn repetition_warnings(trials: &[Trial], held_out: &[Trial]) -> Vec<Warning> {
    let is_in =
        |records: &[Trial], trial: &Trial| records.iter().any(|other| file_and_hash(other).1 == file_and_hash(trial).1);
    let twice = trials.iter().enumerate().filter(|(k, trial)| is_in(&trials[..*k], trial)).map(|(_, trial)| trial);
    let in_both = held_out.iter().filter(|trial| is_in(trials, trial));
    let narrow = "given twice with the same content; it counts twice, and the intervals are too narrow";
    let idle = "used for identification and for validation; the error on it validates nothing";
    let all = twice.map(|trial| (trial, narrow)).chain(in_both.map(|trial| (trial, idle)));
    all.map(|(trial, text)| Warning::new(WarningCode::Repetition, warning_source_of(trial), text)).collect()
}

/// Unique names: the given ones, with a number if several are equal.
pub fn unique_names(given: impl Iterator<Item = impl AsRef<str>>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in given {
        let name = name.as_ref();
        let numbered = (2..).map(|number| format!("{name}-{number}"));
        let unique = std::iter::once(name.to_owned()).chain(numbered).find(|candidate| !names.contains(candidate));
        names.push(unique.expect("one of the endless numbers is free"));
    }
    names
}

/// Default folder of the results, named after the record, or after the first of several records and their number.
pub fn default_folder(trials: &[Trial], command: &str) -> PathBuf {
    let first = trials[0].name();
    PathBuf::from(match trials.len() {
        1 => format!("{first}-{command}"),
        several => format!("{first}-and-{}-more-{command}", several - 1),
    })
}

/// A record as the source of warnings.
pub fn warning_source_of(trial: &Trial) -> WarningSource {
    WarningSource::Record(file_and_hash(trial).0.to_owned())
}

/// Path and SHA-256 of a measured record; for a simulated one its scenario and an empty hash.
pub fn file_and_hash(trial: &Trial) -> (&str, &str) {
    match trial.origin() {
        RecordOrigin::Measured { file, sha256 } => (file, sha256),
        RecordOrigin::Simulated { scenario, .. } => (scenario, ""),
    }
}

#[cfg(test)]
mod tests {
    use super::unique_names;

    #[test]
    fn no_two_records_have_the_same_name() {
        assert_eq!(unique_names(["a", "b", "a", "a"].into_iter()), ["a", "b", "a-2", "a-3"]);
        assert_eq!(unique_names(["a", "a-2", "a", "a"].into_iter()), ["a", "a-2", "a-3", "a-4"]);
        assert_eq!(unique_names(["a", "a", "a-2"].into_iter()), ["a", "a-2", "a-2-2"]);
    }
}
