//! What the keys at the top of a scenario are about. The identity of a study, sweeps and draws go by this.

/// What a part of a scenario decides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScenarioPart {
    /// What a person reads, and no row.
    Prose,
    /// The study as a whole: the same in every cell.
    Study,
    /// What is done in a cell with its trials.
    Cell,
    /// How a trial is made.
    Trial,
}

impl ScenarioPart {
    /// The part below a key; whether there is such a key is seen when it is read.
    pub fn of(key: &str) -> Self {
        match key {
            "question" | "analysis" | "finding" | "published" | "output" => Self::Prose,
            "seed" | "replicates" | "stop" | "sweep" | "predict" => Self::Study,
            "identifier" | "draw" => Self::Cell,
            _ => Self::Trial,
        }
    }
}
