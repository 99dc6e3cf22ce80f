//! Records of similar ships of different size or speed: brought to the scale of the first, and said so.

use report::number::significant;
use ship::Particulars;
use trial::{Scales, Trial};

use campaign::failure::Failure;

/// Records as they are analysed together.
pub struct RescaledRecords {
    /// Records that are fitted, all at the scale of the first.
    pub trials: Vec<Trial>,
    /// Records that are held out, at the same scale.
    pub others: Vec<Trial>,
    /// The scales they had; `None` where all had one.
    pub scales: Option<Scales>,
}

/// Brings fitted and held-out records to the scale of the first where they differ.
///
/// Fails where they differ and a record does not declare length and speed.
pub fn together(trials: &[Trial], others: &[Trial]) -> Result<RescaledRecords, Failure> {
    let scales = Scales::among(trials.iter().chain(others)).map_err(Failure::input)?;
    let at_one = |records: &[Trial]| match &scales {
        Some(scales) => scales.bring_together(records.to_vec()),
        None => records.to_vec(),
    };
    Ok(RescaledRecords { trials: at_one(trials), others: at_one(others), scales })
}

/// Length and speed of a scale in words: "L = 7 m, V = 1.18 m/s".
pub fn scale_name(Particulars { length, speed }: Particulars) -> String {
    format!("L = {} m, V = {} m/s", significant(length, 3), significant(speed, 3))
}

impl RescaledRecords {
    /// What was done to the records, in a sentence; `None` where nothing was.
    pub fn sentence(&self) -> Option<String> {
        let scales = self.scales.as_ref()?;
        let first = scales.particulars[0];
        let of = |(scale, own): (usize, &Particulars)| {
            let count = scales.of.iter().filter(|record| **record == scale).count();
            let records = if count == 1 { "record" } else { "records" };
            let factor = significant(own.factor_to(first, [1, 0]), 4);
            let times = if scale == 0 { String::new() } else { format!(", time × {factor}") };
            format!("{count} {records} of {}{times}", scale_name(*own))
        };
        let parts: Vec<String> = scales.particulars.iter().enumerate().map(of).collect();
        Some(format!("one analysis in prime time, at the scale of the first record: {}", parts.join("; ")))
    }
}

/// Length and speed at which numbers with a dimension are told: those of the first record that declares them.
pub fn particulars(trials: &[Trial]) -> Option<Particulars> {
    trials.iter().find_map(Trial::particulars)
}
