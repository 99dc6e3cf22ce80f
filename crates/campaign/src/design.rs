//! The design of a study as stored in `cells.json`: axes, methods and cells, without the specification of trials.

use std::collections::HashSet;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::scenario::records::{RecordSet, RecordSplit};
use crate::scenario::{DesignCell, MethodName, MissingPhysics, Prose, Scenario, name};

/// Design of a study: the part of a scenario required by tables and plots.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Design {
    /// Names of the axes.
    pub axes: Vec<String>,
    /// Methods.
    pub methods: Vec<MethodName>,
    /// Keys that are sampled anew in every trial.
    #[serde(rename = "draws")]
    pub drawn_keys: Vec<String>,
    /// `true` if manoeuvres are predicted from every estimate.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub predicts: bool,
    /// Cells, in their order.
    pub cells: Vec<CellFacts>,
    /// Prose and presentation. They may change while the rows do not, so only the manifest stores them.
    #[serde(skip)]
    pub prose: Prose,
}

/// Facts of a cell that do not depend on its rows.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CellFacts {
    /// Labels of the points, one per axis.
    pub labels: Vec<String>,
    /// Values of the points; `null` for an axis of labels.
    pub values: Vec<Option<f64>>,
    /// Replicates whose rows are stored.
    #[serde(rename = "trials")]
    pub stored_replicates: Range<u64>,
    /// Identifiers of the effects that a first-order base lacks in its trials.
    #[serde(rename = "missing")]
    pub missing_effects: Vec<String>,
    /// Physics that the first-order base lacks, in a study whose scenario states it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub physics: Option<MissingPhysics>,
    /// `true` if the ship has K and T of its own in addition to those of the nearest first-order response: a response
    /// ship with effects.
    #[serde(rename = "has_own_indices", default, skip_serializing_if = "std::ops::Not::not")]
    pub is_base_with_effects: bool,
    /// `true` if K and T are compared with those of the first-order response nearest to a ship that is not first order.
    #[serde(rename = "is_nearest", default, skip_serializing_if = "std::ops::Not::not")]
    pub is_compared_with_nearest: bool,
    /// L/V, s, on which IMO limits depend; `null` unless manoeuvres are predicted and neither length nor speed is
    /// sampled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length_over_speed_s: Option<f64>,
    /// Fitted records and validation record of each trial, in a study of measured records.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub records: Vec<TrialRecords>,
    /// Cramér–Rao covariance of the relative errors of K and T, %²; `null` if every trial has its own
    /// bound, or if there is no bound.
    #[serde(rename = "bound_percent2")]
    pub cramer_rao_percent2: Option<[[f64; 2]; 2]>,
}

impl CellFacts {
    /// Number of trials whose rows are stored.
    pub fn trial_count(&self) -> u64 {
        self.stored_replicates.end - self.stored_replicates.start
    }
}

/// Records of one trial in a study of measured records.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrialRecords {
    /// Names of the records that were fitted together, joined by commas.
    pub fitted: String,
    /// Name of the validation record; `null` without one.
    #[serde(rename = "judge", default, skip_serializing_if = "Option::is_none")]
    pub validation: Option<String>,
}

fn trial_records(set: &RecordSet) -> Vec<TrialRecords> {
    let records = |split: &RecordSplit| TrialRecords {
        fitted: split.fitted_indices.iter().map(|place| set.name(*place)).collect::<Vec<_>>().join(", "),
        validation: split.validation_index.map(|place| set.name(place).to_owned()),
    };
    set.splits.iter().map(records).collect()
}

impl Design {
    /// Minimum number of trials over the cells; 0 without cells.
    pub fn min_trial_count(&self) -> u64 {
        self.cells.iter().map(CellFacts::trial_count).min().unwrap_or(0)
    }

    /// Design of a scenario, without stored trials and without bounds.
    pub fn from_scenario(scenario: &Scenario) -> Self {
        let predicts = scenario.predictions.is_some();
        let has_limits =
            predicts && !scenario.drawn_keys.iter().any(|key| key.contains("length") || key.contains("speed"));
        let is_stated = scenario.cells.iter().any(DesignCell::states_physics);
        let bare = |cell: &DesignCell| CellFacts {
            labels: cell.labels.clone(),
            values: cell.values.clone(),
            missing_effects: cell.missing_effects(),
            physics: cell.physics().filter(|_| is_stated),
            is_base_with_effects: cell.is_base_with_effects(),
            is_compared_with_nearest: cell.is_compared_with_nearest(),
            records: cell.record_set().map_or_else(Vec::new, trial_records),
            length_over_speed_s: cell.particulars().filter(|_| has_limits).map(|ship| ship.length / ship.speed),
            ..CellFacts::default()
        };
        Self {
            axes: scenario.axes.iter().map(|axis| axis.name.clone()).collect(),
            methods: scenario.method_names(),
            drawn_keys: scenario.drawn_keys.clone(),
            predicts,
            cells: scenario.cells.iter().map(bare).collect(),
            prose: scenario.prose.clone(),
        }
    }

    /// Design with cell facts renewed from a scenario; trials and bounds stay.
    pub(crate) fn with_renewed_descriptions(&self, scenario: &Scenario) -> Self {
        let mut design = Self::from_scenario(scenario);
        for (cell, stored) in design.cells.iter_mut().zip(&self.cells) {
            (cell.stored_replicates, cell.cramer_rao_percent2) =
                (stored.stored_replicates.clone(), stored.cramer_rao_percent2);
        }
        design
    }

    /// Design from the text of a `cells.json`.
    ///
    /// Fails if the text is no design or is inconsistent; the message names the place.
    pub fn from_json(text: &[u8]) -> Result<Self, String> {
        let design: Self = serde_json::from_slice(text).map_err(|error| error.to_string())?;
        design.check().map(|()| design)
    }

    fn check(&self) -> Result<(), String> {
        let cells = self.cells.iter().flat_map(|cell| &cell.labels);
        for text in self.axes.iter().chain(self.methods.iter().map(|method| &method.label)).chain(cells) {
            name::check_label(text).map_err(|unfit| format!("a label is {}; {unfit}", name::quoted_beginning(text)))?;
        }
        let mut labels = HashSet::new();
        if let Some(twice) = self.methods.iter().find(|method| !labels.insert(&method.label)) {
            return Err(format!("two methods are called {:?}", twice.label));
        }
        if self.methods.is_empty() || self.cells.is_empty() {
            return Err("there is no method or no cell".to_owned());
        }
        for (index, cell) in self.cells.iter().enumerate() {
            let counts = [cell.labels.len(), cell.values.len()];
            if counts != [self.axes.len(); 2] {
                let [labels, values] = counts;
                let axes = self.axes.len();
                return Err(format!("cell {index} has {labels} labels and {values} values for {axes} axes"));
            }
            if cell.stored_replicates.start > cell.stored_replicates.end {
                return Err(format!("the trials of cell {index} end before they begin"));
            }
        }
        Ok(())
    }

    /// `true` if the trials are measured records.
    pub fn is_measured(&self) -> bool {
        self.cells.iter().any(|cell| !cell.records.is_empty())
    }

    /// Indices of the cells shown in detail.
    pub fn detailed_cells(&self) -> Vec<usize> {
        if self.cells.len() == 1 {
            // A study of one cell shows that cell.
            return vec![0];
        }
        let place = |title: &String| self.cells.iter().position(|cell| cell.labels.join(", ") == *title);
        self.prose.output.detail.iter().filter_map(place).collect()
    }
}
