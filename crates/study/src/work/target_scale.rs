//! Scale of a prediction, and the ships and records brought to it. Results for one length are not valid for another, so
//! differing scales are refused or reported.

use campaign::failure::Failure;
use document::identified_ship::is_same_length;
use document::{IdentifiedShip, IdentifiedShipError, WarningCode, Warnings};
use identify::hull::differs_in_froude_number;
use report::number::fixed;
use ship::Particulars;
use ship::vessel::prior::HullParticulars;
use trial::{DeclaredConditions, Trial};

use crate::options::ScaleOptions;
use crate::records::{file_and_hash, warning_source_of};

/// Name and conditions of a sidecar; `None` without a sidecar.
pub type SidecarConditions<'a> = Option<(&'a str, &'a DeclaredConditions)>;

/// Length and approach speed that ships are scaled to: the requested ones, or those of a trial.
#[derive(Clone, Copy)]
pub struct TargetScale {
    length: f64,
    /// Approach speed; `None` for that of the same Froude number.
    speed: Option<f64>,
    /// `true` if the scale is requested, `false` if it is that of a trial.
    is_requested: bool,
}

impl TargetScale {
    /// Scale of a trial with these particulars.
    pub fn from_particulars(Particulars { length, speed }: Particulars) -> Self {
        Self { length, speed: Some(speed), is_requested: false }
    }

    /// Scale of a prediction: the requested one, else that of the records, else that of the ship that a sidecar
    /// declares. `None` for that of the model.
    ///
    /// Fails if the records are of ships of several lengths.
    pub fn from_request(
        asked: &ScaleOptions,
        records: &[Trial],
        declared: SidecarConditions,
    ) -> Result<Option<Self>, Failure> {
        if let Some(length) = asked.length_m {
            return Ok(Some(Self { length, speed: asked.speed(), is_requested: true }));
        }
        let of_sidecar = declared.and_then(|(file, conditions)| Some((file, conditions.particulars?)));
        let of_records = records.iter().filter_map(|record| Some((file_and_hash(record).0, record.particulars()?)));
        let mut scales = of_records.chain(of_sidecar);
        let Some((file, first)) = scales.next() else { return Ok(None) };
        match scales.find(|(_, ship)| !is_same_length(ship.length, first.length)) {
            Some((other, ship)) => Err(scale_mismatch([(file, Some(first)), (other, Some(ship))])),
            None => Ok(Some(Self::from_particulars(first))),
        }
    }

    /// Scale at which a record is replayed: the requested one if its length is that of the record, else that of the
    /// record, else `scale`. If a length is requested without a speed, the approach speed is that of equal Froude
    /// number, not the speed in the record, which falls from the first rows on.
    pub fn for_replay_of(scale: Option<Self>, record: &Trial) -> Option<Self> {
        match (record.particulars(), scale) {
            (Some(ship), Some(asked)) if asked.is_requested && is_same_length(ship.length, asked.length) => scale,
            (ship, _) => ship.map(Self::from_particulars).or(scale),
        }
    }
}

/// Failure for two files of ships of different scales.
pub fn scale_mismatch([(first, of_first), (other, of_other)]: [(&str, Option<Particulars>); 2]) -> Failure {
    let ship_words = |ship: Option<Particulars>| match ship {
        Some(ship) => format!("{} m long at {} m/s", fixed(ship.length, 2), fixed(ship.speed, 2)),
        None => String::from("of no known length and speed"),
    };
    let [of_first, of_other] = [of_first, of_other].map(ship_words);
    let cure = "give --length-m and --speed-kn of the ship to predict, or predict one at a time";
    Failure::in_file(other, format!("its ship is {of_other}, that of {first} {of_first}; {cure}"))
}

/// `true` if ships have equal length and Froude number, with the tolerances used for earlier trials.
pub fn is_same_scale(a: Particulars, b: Particulars) -> bool {
    let hull_at = |Particulars { length, speed }| HullParticulars { length, speed, ..HullParticulars::default() };
    let [a, b] = [a, b].map(hull_at);
    a.has_equal_length(&b) && !differs_in_froude_number(&a, &b)
}

/// Ship scaled to a length and approach speed; unchanged for `None`. A ship of unknown scale is assigned this scale if
/// it has a speed.
///
/// Fails if the ship cannot be scaled.
pub fn ship_at_scale(ship: &IdentifiedShip, scale: Option<TargetScale>) -> Result<IdentifiedShip, IdentifiedShipError> {
    let Some(TargetScale { length, speed, is_requested }) = scale else { return Ok(ship.clone()) };
    // The speed of a trial is estimated from its beginning and never quite equals that of another trial.
    let is_speed_of = |scale: Particulars, speed| match is_requested {
        true => speed == scale.speed,
        false => is_same_scale(scale, Particulars { speed, ..scale }),
    };
    match ship.particulars() {
        None if speed.is_some() => Ok(IdentifiedShip { length_m: Some(length), speed_m_s: speed, ..ship.clone() }),
        Some(scale) if is_same_length(scale.length, length) && speed.is_none_or(|speed| is_speed_of(scale, speed)) => {
            Ok(ship.clone())
        }
        _ => ship.scaled_to(length, speed),
    }
}

/// Record at the scale that its sidecar declares, with a warning if another length is requested: a scale model is
/// replayed at its scale.
pub fn at_declared_scale(record: Trial, warnings: &mut Warnings) -> Trial {
    let is_other =
        |other: &Particulars| record.particulars().is_some_and(|given| !is_same_length(other.length, given.length));
    let Some(declared) = record.conditions().particulars.filter(is_other) else { return record };
    let text = format!(
        "its sidecar declares {} m at {} m/s; it is replayed at that scale, and manoeuvres are predicted at the scale asked for",
        fixed(declared.length, 2),
        fixed(declared.speed, 2)
    );
    warnings.push(WarningCode::Scale, warning_source_of(&record), text);
    record.with_particulars(declared)
}
