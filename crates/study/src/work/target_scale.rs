//! The scale of a prediction, and what is brought to it. What is said of a ship of one length does not hold for one of
//! another, so scales that differ are refused or told.

use campaign::failure::Failure;
use document::identified_ship::is_same_length;
use document::{Code, IdentifiedShip, IdentifiedShipError, Warnings};
use identify::hull::is_other_froude_number;
use report::number::fixed;
use ship::Particulars;
use ship::vessel::prior::HullParticulars;
use trial::{Conditions, Trial};

use crate::options::ScaleOptions;
use crate::records::{file_of, source_of};

/// What a sidecar says of the conditions, and its name.
pub type Declared<'a> = Option<(&'a str, &'a Conditions)>;

/// What ships are brought to: the length and approach speed that are asked for, or those of a trial.
#[derive(Clone, Copy)]
pub struct TargetScale {
    length: f64,
    /// That of Froude where it is not given.
    speed: Option<f64>,
    is_asked: bool,
}

impl TargetScale {
    pub fn of_trial(Particulars { length, speed }: Particulars) -> Self {
        Self { length, speed: Some(speed), is_asked: false }
    }

    /// The scale of a prediction: the one that is asked for, else that of the records, else that of the ship that a
    /// sidecar declares. `None` is that of the model.
    ///
    /// Fails for records of ships of several lengths.
    pub fn of(asked: &ScaleOptions, records: &[Trial], declared: Declared) -> Result<Option<Self>, Failure> {
        if let Some(length) = asked.length_m {
            return Ok(Some(Self { length, speed: asked.speed(), is_asked: true }));
        }
        let of_sidecar = declared.and_then(|(file, own)| Some((file, own.particulars?)));
        let of_records = records.iter().filter_map(|record| Some((file_of(record).0, record.particulars()?)));
        let mut known = of_records.chain(of_sidecar);
        let Some((file, first)) = known.next() else { return Ok(None) };
        match known.find(|(_, own)| !is_same_length(own.length, first.length)) {
            Some((other, own)) => Err(of_two_scales([(file, Some(first)), (other, Some(own))])),
            None => Ok(Some(Self::of_trial(first))),
        }
    }

    /// The scale that a record is replayed at: its own, unless a ship of its length is asked for. A speed that is not
    /// given is that of Froude, not that of the record, which loses speed from its first rows on.
    pub fn of_record(scale: Option<Self>, record: &Trial) -> Option<Self> {
        match (record.particulars(), scale) {
            (Some(own), Some(asked)) if asked.is_asked && is_same_length(own.length, asked.length) => scale,
            (own, _) => own.map(Self::of_trial).or(scale),
        }
    }
}

/// That two files are of ships of different scales, and what mends it.
pub fn of_two_scales([(first, of_first), (other, of_other)]: [(&str, Option<Particulars>); 2]) -> Failure {
    let told = |own: Option<Particulars>| match own {
        Some(own) => format!("{} m long at {} m/s", fixed(own.length, 2), fixed(own.speed, 2)),
        None => String::from("of no known length and speed"),
    };
    let [of_first, of_other] = [of_first, of_other].map(told);
    let cure = "give --length-m and --speed-kn of the ship that is predicted for, or predict one at a time";
    Failure::about(other, format!("its ship is {of_other}, that of {first} {of_first}; {cure}"))
}

/// Whether ships are of one length and Froude number, as those of earlier trials are compared.
pub fn is_alike(one: Particulars, other: Particulars) -> bool {
    let of = |Particulars { length, speed }| HullParticulars { length, speed, ..HullParticulars::default() };
    let [one, other] = [one, other].map(of);
    one.has_length_of(&other) && !is_other_froude_number(&one, &other)
}

/// A ship at a scale; one whose scale is not known takes it as its own.
pub fn at_scale(known: &IdentifiedShip, scale: Option<TargetScale>) -> Result<IdentifiedShip, IdentifiedShipError> {
    let Some(TargetScale { length, speed, is_asked }) = scale else { return Ok(known.clone()) };
    // The speed of a trial is read off its beginning and never quite that of another.
    let is_speed_of = |own: Particulars, speed| match is_asked {
        true => speed == own.speed,
        false => is_alike(own, Particulars { speed, ..own }),
    };
    match known.particulars() {
        None if speed.is_some() => Ok(IdentifiedShip { length_m: Some(length), speed_m_s: speed, ..known.clone() }),
        Some(own) if is_same_length(own.length, length) && speed.is_none_or(|speed| is_speed_of(own, speed)) => {
            Ok(known.clone())
        }
        _ => known.scaled_to(length, speed),
    }
}

/// A record at the scale that its sidecar declares, where another one is asked for: a model is replayed as a model.
pub fn at_own_scale(record: Trial, warnings: &mut Warnings) -> Trial {
    let is_other =
        |own: &Particulars| record.particulars().is_some_and(|given| !is_same_length(own.length, given.length));
    let Some(own) = record.conditions().particulars.filter(is_other) else { return record };
    let text = format!(
        "its sidecar says {} m at {} m/s; it is replayed at that scale, and manoeuvres are predicted at the other",
        fixed(own.length, 2),
        fixed(own.speed, 2)
    );
    warnings.push(Code::Scale, source_of(&record), text);
    record.with_particulars(own)
}
