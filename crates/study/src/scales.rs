//! Records of similar ships of different length, brought to the scale of the first record.

use report::number::significant;
use ship::Particulars;
use trial::{ShipScales, Trial};

use campaign::failure::Failure;

/// Records at one scale, to be analysed together.
pub struct RescaledRecords {
    /// Fitted records, all at the scale of the first.
    pub trials: Vec<Trial>,
    /// Held-out records, at the same scale.
    pub held_out: Vec<Trial>,
    /// Original scales of the records; `None` if the declared ones do not differ.
    pub scales: Option<ShipScales>,
}

/// Brings fitted and held-out records to the scale of the first if their scales differ.
///
/// Fails if the scales differ and a record does not declare length and speed.
pub fn to_common_scale(trials: &[Trial], held_out: &[Trial]) -> Result<RescaledRecords, Failure> {
    let scales = ShipScales::from_trials(trials.iter().chain(held_out)).map_err(Failure::input)?;
    let at_one = |records: &[Trial]| match &scales {
        Some(scales) => scales.to_first_scale(records.to_vec()),
        None => records.to_vec(),
    };
    Ok(RescaledRecords { trials: at_one(trials), held_out: at_one(held_out), scales })
}

/// Length and speed of a scale as text: "L = 7 m, V = 1.18 m/s".
pub fn scale_name(Particulars { length, speed }: Particulars) -> String {
    format!("L = {} m, V = {} m/s", significant(length, 3), significant(speed, 3))
}

impl RescaledRecords {
    /// Sentence on the scaling of the records; `None` for records of one scale.
    pub fn scaling_sentence(&self) -> Option<String> {
        let scales = self.scales.as_ref()?;
        let first = scales.particulars[0];
        let scale_part = |(scale, ship): (usize, &Particulars)| {
            let count = scales.scale_indices.iter().filter(|record| **record == scale).count();
            let records = if count == 1 { "record" } else { "records" };
            let factor = significant(ship.similarity_factor_to(first, [1, 0]), 4);
            let times = if scale == 0 { String::new() } else { format!(", time × {factor}") };
            format!("{count} {records} of {}{times}", scale_name(*ship))
        };
        let parts: Vec<String> = scales.particulars.iter().enumerate().map(scale_part).collect();
        Some(format!("analysed together in prime time, at the scale of the first record: {}", parts.join("; ")))
    }
}

/// Length and approach speed of the ship, from the first record that declares them; `None` if no record does.
pub fn declared_particulars(trials: &[Trial]) -> Option<Particulars> {
    trials.iter().find_map(Trial::particulars)
}
