//! Curves of a trace, stored with `trace.json`: every record with its replays by the base ("before") and by the average
//! of the structures ("after"), its innovations, and the moment that the base lacks. They are written after the
//! analysis; figures are made from the tables read back.

use std::collections::BTreeMap;
use std::path::Path;

use ::trace::Innovations;
use ::trace::comparison::RecordComparison;
use ::trace::inclusion_path::{InclusionPath, InclusionStep};
use campaign::curves::degrees;
use campaign::failure::Failure;
use campaign::scenario::name::slug;
use document::trace::{InclusionStepEntry, RecordEntry, TraceDocument};
use identify::replay::Replay;
use ship::angle::{from_deg, to_deg};
use trial::{Channel, Columns as Channels, RecordOrigin, Trial};

use super::columns::CsvColumns;
use crate::records::unique_names;

/// Record with its replays by the base and by the average of the structures.
pub struct TracedRecord {
    /// The record.
    pub trial: Trial,
    /// Replays of the recorded rudder by the base and by the average of the structures.
    pub replays: [Replay; 2],
    /// Half width of the 95 % band of the second replay at its rows, rad; `None` if the table has no band.
    pub half_width95: Option<Vec<f64>>,
    /// Times, s, of the innovations of the most probable structure, and the innovations in standard deviations; `None`
    /// for a held-out record.
    pub innovations: Option<[Vec<f64>; 2]>,
}

/// All curves of a trace.
pub struct TraceCurves {
    /// Records in the order of the document.
    pub records: Vec<TracedRecord>,
    /// Tables of the missing moments, in the order of the document: over time, and over the channels.
    pub moment_tables: Vec<[BTreeMap<String, Vec<f64>>; 2]>,
    /// Times, s, as a single column, and the heading residual of the first record, deg, a column for every step of the
    /// staircase; both empty without a staircase.
    pub staircase_residuals: [Vec<Vec<f64>>; 2],
}

/// Unique slugs of record names for file names; equal slugs are numbered.
pub fn record_slugs(record_names: &[String]) -> Vec<String> {
    unique_names(record_names.iter().map(|name| slug(name)))
}

/// File name suffix of the record with the index `number`: empty for the first.
pub fn file_name_suffix(names: &[String], number: usize) -> String {
    if number == 0 { String::new() } else { format!("-{}", record_slugs(names)[number]) }
}

/// Column prefixes of the base and of the average of the structures.
const MODELS: [&str; 2] = ["before", "after"];

/// CSV table of a record and its replays by the base and by the average of the structures; angles in degrees.
pub fn record_csv(trial: &Trial, comparison: &RecordComparison) -> String {
    let mut columns = CsvColumns::default();
    columns.push("t_s", trial.time().to_vec());
    columns.push("heading_deg", degrees(trial.heading()));
    columns.push("rudder_deg", degrees(trial.rudder()));
    if let Some(rate) = trial.yaw_rate() {
        columns.push("yaw_rate_deg_s", degrees(rate));
    }
    // A replay begins at the first recorded heading.
    let first = trial.observed_rows().next().unwrap_or(0);
    let rows = |values: &[f64]| [vec![f64::NAN; first], degrees(values)].concat();
    for (model, on) in MODELS.iter().zip([&comparison.base_replay, &comparison.average_replay]) {
        let Replay { heading, yaw_rate, residual, .. } = &on.replay;
        let quantities = [("heading_deg", heading), ("yaw_rate_deg_s", yaw_rate), ("residual_deg", residual)];
        for (quantity, values) in quantities {
            columns.push(format!("{model}_{quantity}"), rows(values));
        }
    }
    if let Some(band) = &comparison.average_replay.band_half_width {
        columns.push("after_half_width95_deg", rows(band));
    }
    columns.to_csv()
}

/// File name of the table of the staircase.
const STAIRCASE: &str = "staircase.csv";

/// Column name of the residual after a step of the staircase.
fn column_of(step: usize) -> String {
    format!("step_{step}_residual_deg")
}

/// Document entries of the steps from the base to the model, and file name and CSV text of the table of the residuals
/// of the first record after each step. Empty and `None` without a staircase.
pub fn staircase_entries_and_csv(path: Option<InclusionPath>) -> (Vec<InclusionStepEntry>, Option<(String, String)>) {
    let Some(path) = path else { return (Vec::new(), None) };
    let mut columns = CsvColumns::default();
    columns.push("t_s", path.row_times);
    for (number, step) in path.steps.iter().enumerate() {
        columns.push(column_of(number), degrees(&step.heading_residual));
    }
    let entry = |step: &InclusionStep| InclusionStepEntry {
        id: step.term.map(|(id, ..)| id.to_owned()),
        form: step.term.map(|(_, form, _)| form.to_owned()),
        heading_rmse_deg: to_deg(step.heading_rmse),
    };
    (path.steps.iter().map(entry).collect(), Some((STAIRCASE.to_owned(), columns.to_csv())))
}

/// Names of the columns of [`innovations_csv`].
const INNOVATIONS: [&str; 2] = ["t_s", "innovation_sd"];

/// CSV table of the innovations of a record.
pub fn innovations_csv(series: &Innovations) -> String {
    let mut columns = CsvColumns::default();
    for (name, values) in INNOVATIONS.into_iter().zip([&series.time, &series.values]) {
        columns.push(name, values.clone());
    }
    columns.to_csv()
}

/// Record read from a table; `None` if the table does not have the form of [`record_csv`].
fn record(entry: &RecordEntry, text: &str) -> Option<TracedRecord> {
    let columns = CsvColumns::from_csv(text)?;
    let radians = |name: &str| columns.get(name).map(|all| all.iter().copied().map(from_deg).collect::<Vec<f64>>());
    let time = columns.get("t_s")?.clone();
    let channels = [
        (Channel::Heading, radians("heading_deg")),
        (Channel::Rudder, radians("rudder_deg")),
        (Channel::YawRate, radians("yaw_rate_deg_s")),
    ];
    let channels = channels.into_iter().filter_map(|(channel, values)| Some((channel, values?))).collect();
    let replayed = radians("before_heading_deg")?;
    let first = replayed.iter().position(|heading| heading.is_finite())?;
    let last = replayed.iter().rposition(|heading| heading.is_finite())?;
    let rows = |name: String| radians(&name).map(|all| all[first..=last].to_vec());
    let replay = |model: &str| {
        Some(Replay {
            time: time[first..=last].to_vec(),
            heading: rows(format!("{model}_heading_deg"))?,
            yaw_rate: rows(format!("{model}_yaw_rate_deg_s"))?,
            residual: rows(format!("{model}_residual_deg"))?,
        })
    };
    let replays = [replay(MODELS[0])?, replay(MODELS[1])?];
    let half_width95 = rows(String::from("after_half_width95_deg"));
    let origin = RecordOrigin::Measured { file: entry.file.clone(), sha256: String::new() };
    let trial = Trial::new(&entry.name, origin, Channels { time, channels, unknown_columns: Vec::new() }).ok()?;
    Some(TracedRecord { trial, replays, half_width95, innovations: None })
}

/// Content of a table of a trace. Fails if the table has another form; `place` is its path in messages.
fn read<T>(text: &str, place: &str, parse: impl FnOnce(&str) -> Option<T>) -> Result<T, Failure> {
    let again = "this is not a table of a trace; run `study trace` again";
    parse(text).ok_or_else(|| Failure::input(format!("{place}: {again}")))
}

impl TraceCurves {
    /// Curves of a document, read from the files in its folder.
    ///
    /// Fails if a file cannot be read or is not such a table.
    pub fn read(document: &TraceDocument, folder: &Path) -> Result<Self, Failure> {
        Self::from_tables(document, |name| {
            let path = folder.join(name);
            Ok((super::read_text(&path)?, path.display().to_string()))
        })
    }

    /// Curves of a document. `table` returns the text of the file of a name, and its path for messages.
    ///
    /// Fails as `table` does, or if a text is not such a table.
    pub fn from_tables(
        document: &TraceDocument,
        table: impl Fn(&str) -> Result<(String, String), Failure>,
    ) -> Result<Self, Failure> {
        let columns = |name: &str| table(name).and_then(|(text, place)| read(&text, &place, CsvColumns::from_csv));
        let records = document.records.iter().map(|entry| {
            let (text, place) = table(&entry.curves)?;
            let record = read(&text, &place, |text| record(entry, text))?;
            let numbers = |name: &String| {
                let columns = columns(name)?;
                Ok(INNOVATIONS.map(|name| columns.get(name).cloned().unwrap_or_default()))
            };
            let innovations = entry.innovations.as_ref().map(numbers).transpose()?;
            Ok(TracedRecord { innovations, ..record })
        });
        let moment_tables =
            document.missing_moment.iter().map(|entry| Ok([columns(&entry.moment)?, columns(&entry.curves)?]));
        let staircase_residuals = match document.staircase.len() {
            0 => Default::default(),
            steps => {
                let table = columns(STAIRCASE)?;
                let column = |name: &str| table.get(name).cloned().unwrap_or_default();
                [vec![column("t_s")], (0..steps).map(|step| column(&column_of(step))).collect()]
            }
        };
        Ok(Self {
            staircase_residuals,
            records: records.collect::<Result<_, Failure>>()?,
            moment_tables: moment_tables.collect::<Result<_, Failure>>()?,
        })
    }
}
