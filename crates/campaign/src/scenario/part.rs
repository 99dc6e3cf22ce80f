//! Parts of a scenario by its top-level keys, which determine the identity of a study and the keys open to sweeps and
//! draws.

/// Part of a scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScenarioPart {
    /// Prose and presentation, which do not affect rows.
    Prose,
    /// Settings of the whole study, the same in every cell.
    Study,
    /// Methods and draws of a cell.
    Cell,
    /// Specification of a trial.
    Trial,
}

impl ScenarioPart {
    /// Part of a top-level key; unknown keys are refused elsewhere.
    pub fn from_key(key: &str) -> Self {
        match key {
            "question" | "analysis" | "finding" | "published" | "output" => Self::Prose,
            "seed" | "replicates" | "stop" | "sweep" | "predict" => Self::Study,
            "identifier" | "draw" => Self::Cell,
            _ => Self::Trial,
        }
    }
}
