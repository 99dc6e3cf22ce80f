//! An entry of the form of MSC/Circ.1053, and a record as the form takes it.

use trial::{Loading, Origin, Trial};

use crate::correction::Correction;
use crate::interval::Interval;
use crate::turn::Current;

/// What an entry says.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// Words.
    Text(String),
    /// A number that was declared or follows from what was declared.
    Number(f64),
    /// A measured number with its standard deviation, where the record tells it.
    Measured {
        /// The value.
        value: f64,
        /// Its standard deviation.
        sd: Option<f64>,
    },
    /// A predicted or corrected number.
    Interval(Interval),
}

/// Where an entry comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum Basis {
    /// Declared in the sidecar of a record.
    Declared {
        /// The record.
        file: String,
    },
    /// The scale for which manoeuvres are predicted.
    Scale,
    /// Measured, in the condition of the form.
    Measured {
        /// The record.
        file: String,
        /// Whether the trial was made at partial load, and nothing corrects it.
        partial: bool,
    },
    /// Measured at partial load and corrected by F/B.
    Corrected {
        /// The record.
        file: String,
        /// F/B.
        factor: Interval,
        /// Whether something is said against it.
        doubtful: bool,
    },
    /// Predicted from the models.
    Predicted {
        /// Whether beyond what their records have seen.
        extrapolated: bool,
        /// Share of the drawn ships that keep within the limit; one without the figure does not.
        passing: Option<f64>,
    },
    /// Found from the records that are given.
    Loading,
    /// Nobody declared or measured it.
    NotInRecords,
    /// The models do not tell it.
    NotTold {
        /// Why.
        why: &'static str,
    },
}

/// An entry of the form.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Heading it stands under.
    pub section: &'static str,
    /// What it is called.
    pub name: &'static str,
    /// "port" or "starboard", where the form has one for either side.
    pub side: Option<&'static str>,
    /// What is filled in.
    pub value: Option<Value>,
    /// Unit of value and limit.
    pub unit: &'static str,
    /// Largest value allowed.
    pub limit: Option<f64>,
    /// Where it comes from.
    pub basis: Basis,
}

/// The form.
#[derive(Debug, Clone, PartialEq)]
pub struct Form {
    /// Entries in the order of the form.
    pub entries: Vec<Entry>,
    /// Conditions that are not met or not known, and what else is to be said.
    pub remarks: Vec<String>,
}

/// A record with what corrects it to full load.
#[derive(Debug, Clone, Copy)]
pub struct Record<'a> {
    /// The record.
    pub trial: &'a Trial,
    /// Its correction, where a model of its condition was given.
    pub correction: Option<&'a Correction>,
    /// The current that was taken out of its positions.
    pub current: Option<Current>,
}

impl Record<'_> {
    /// The file as the user named it.
    pub(crate) fn file(&self) -> &str {
        match self.trial.origin() {
            Origin::Measured { file, .. } => file,
            Origin::Simulated { .. } => self.trial.name(),
        }
    }

    /// How the ship was loaded; a record that is to be corrected was at partial load whatever else is known.
    pub(crate) fn loading(&self) -> Option<Loading> {
        self.correction.map(|_| Loading::Partial).or_else(|| self.trial.conditions().loading())
    }
}
