//! Records, read from files or built from columns, and their columns as arrays.

use std::path::PathBuf;

use campaign::failure::Failure;
use campaign::scenario::name;
use document::{Warning, Warnings};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use study::options::ReadingOptions;
use study::records::{file_and_hash, read_records, record_files, trial_from_log, warning_source};
use trial::channel::TIME_COLUMN;
use trial::{Channel, InstrumentLog, Sidecar, Trial};

use crate::options::parse_request;
use crate::raise::python_error;
use crate::wait::run_in_background;

/// Record of one trial, with the warnings of its reading.
#[pyclass(frozen, name = "Record", module = "kempf._kempf")]
pub struct PyRecord {
    /// Trial of the record.
    pub trial: Trial,
    warnings: Vec<Warning>,
}

impl PyRecord {
    /// Record of a trial, without warnings.
    pub fn from_trial(trial: Trial) -> Self {
        Self { trial, warnings: Vec::new() }
    }
}

/// Warnings of reading records, in order.
pub fn read_warnings(records: &[Py<PyRecord>]) -> impl Iterator<Item = Warning> {
    records.iter().flat_map(|record| record.get().warnings.clone())
}

/// Texts of warnings.
pub fn warning_texts<'a>(warnings: impl IntoIterator<Item = &'a Warning>) -> Vec<String> {
    warnings.into_iter().map(Warning::to_string).collect()
}

/// Trials of the records passed from Python.
pub fn cloned_trials(records: &[Py<PyRecord>]) -> Vec<Trial> {
    records.iter().map(|record| record.get().trial.clone()).collect()
}

#[pymethods]
impl PyRecord {
    fn __len__(&self) -> usize {
        self.trial.len()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        warning_texts(&self.warnings)
    }

    #[getter]
    fn name(&self) -> &str {
        self.trial.name()
    }

    #[getter]
    fn file(&self) -> &str {
        file_and_hash(&self.trial).0
    }

    #[getter]
    fn sha256(&self) -> &str {
        file_and_hash(&self.trial).1
    }

    #[getter]
    fn length_m(&self) -> Option<f64> {
        self.trial.particulars().map(|ship| ship.length)
    }

    #[getter]
    fn speed_m_s(&self) -> Option<f64> {
        self.trial.particulars().map(|ship| ship.speed)
    }

    #[getter]
    fn heading_from_yaw_rate(&self) -> bool {
        self.trial.is_heading_integrated()
    }

    /// Names of the columns, as in a file.
    fn columns(&self) -> Vec<String> {
        let channels = Channel::ALL.into_iter().filter(|channel| self.trial.channel(*channel).is_some());
        let unknown = self.trial.unknown_columns().iter().map(|(name, _)| name.clone());
        std::iter::once(TIME_COLUMN.to_owned()).chain(channels.map(Channel::column_name)).chain(unknown).collect()
    }

    /// Column in the unit of its name; `None` if the column is missing.
    fn column<'py>(&self, py: Python<'py>, name: &str) -> Option<Bound<'py, PyArray1<f64>>> {
        if name == TIME_COLUMN {
            return Some(PyArray1::from_slice(py, self.trial.time()));
        }
        let channel = Channel::ALL.into_iter().find(|channel| channel.column_name() == name);
        match channel {
            Some(channel) => {
                let factor = channel.written_unit().si_factor();
                let values = self.trial.channel(channel)?.iter().map(|value| value / factor);
                Some(PyArray1::from_vec(py, values.collect()))
            }
            None => {
                let (_, values) = self.trial.unknown_columns().iter().find(|(column, _)| column == name)?;
                Some(PyArray1::from_slice(py, values))
            }
        }
    }

    /// CSV text of the record.
    fn csv(&self) -> PyResult<String> {
        let mut table = Vec::new();
        trial::write_csv(&self.trial, &mut table).map_err(|error| python_error(Failure::execution(error)))?;
        String::from_utf8(table).map_err(|error| python_error(Failure::execution(error)))
    }
}

/// Records of a file or of a folder; `options` are options of the command line.
#[pyfunction]
pub fn read(py: Python<'_>, path: PathBuf, options: Vec<String>) -> PyResult<Vec<PyRecord>> {
    run_in_background(py, move || {
        let options: ReadingOptions = parse_request(options)?;
        let record = |file: PathBuf| {
            let mut warnings = Warnings::default();
            let mut trials = read_records(std::slice::from_ref(&file), &options, &mut warnings)?;
            Ok(PyRecord { trial: trials.remove(0), warnings: warnings.ranked() })
        };
        record_files(std::slice::from_ref(&path))?.into_iter().map(record).collect()
    })
}

/// Column passed from Python.
#[derive(FromPyObject)]
pub enum PyColumn<'py> {
    /// Numbers; NaN for a missing value.
    Numbers(PyReadonlyArray1<'py, f64>),
    /// Texts of any other content, such as stamps of date and time.
    Texts(Vec<String>),
}

/// Record from columns, read like a file with these columns.
#[pyfunction]
pub fn record_of(
    py: Python<'_>,
    name: String,
    columns: Vec<(String, PyColumn<'_>)>,
    options: Vec<String>,
) -> PyResult<PyRecord> {
    let table = table(&columns).map_err(python_error)?;
    run_in_background(py, move || record_from_table(&name, &table, &parse_request(options)?, None))
}

/// Record `name` from the text of a table and of its sidecar.
pub fn record_from_table(
    name: &str,
    table: &[u8],
    options: &ReadingOptions,
    sidecar: Option<&str>,
) -> Result<PyRecord, Failure> {
    let path = PathBuf::from(format!("{name}.csv"));
    name::study_name(&path)?;
    let sidecar = sidecar.map(|text| Sidecar::parse(text, &Sidecar::path_beside(&path))).transpose();
    let sidecar = sidecar.map_err(Failure::input)?;
    let mut log = InstrumentLog::from_reader(&path, table, None, sidecar.as_ref()).map_err(Failure::input)?;
    let mut warnings = Warnings::default();
    warnings.extend(warning_source(&path).attach_to(std::mem::take(&mut log.warnings)));
    let trial = trial_from_log(log, &path, options, &mut warnings)?;
    Ok(PyRecord { trial, warnings: warnings.ranked() })
}

/// CSV text of columns, with the digits that reproduce every number. Fails if lengths differ.
fn table(columns: &[(String, PyColumn)]) -> Result<Vec<u8>, Failure> {
    let lengths: Vec<usize> = columns.iter().map(|(_, column)| column.len()).collect();
    let rows = lengths.first().copied().unwrap_or_default();
    if let Some(other) = lengths.iter().position(|length| *length != rows) {
        return Err(Failure::input(format!(
            "{} has {} values and {} has {rows}; give one value a row, NaN where nothing was read",
            columns[other].0, lengths[other], columns[0].0
        )));
    }
    let mut table = csv::Writer::from_writer(Vec::new());
    let written = (|| {
        table.write_record(columns.iter().map(|(name, _)| name))?;
        for row in 0..rows {
            for (_, column) in columns {
                table.write_field(column.cell(row))?;
            }
            table.write_record(None::<&[u8]>)?;
        }
        Ok::<(), csv::Error>(())
    })();
    written.map_err(Failure::execution)?;
    table.into_inner().map_err(Failure::execution)
}

impl PyColumn<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.as_array().len(),
            Self::Texts(texts) => texts.len(),
        }
    }

    fn cell(&self, row: usize) -> String {
        match self {
            Self::Numbers(values) => {
                let value = values.as_array()[row];
                if value.is_nan() { String::new() } else { value.to_string() }
            }
            Self::Texts(texts) => texts[row].clone(),
        }
    }
}
