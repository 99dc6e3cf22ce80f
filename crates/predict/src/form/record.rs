//! Records for the form of MSC/Circ.1053: classification of a record as a manoeuvre of the form, and its
//! characteristics.

use ship::{Particulars, angle::to_deg};
use simulate::motion::Current;
use trial::zigzag::BaseCourseSource;
use trial::{Loading, Quantity, Trial, ZigZag as Measured};

use crate::correction::Correction;
use crate::helm_replay;
use crate::imo::{
    CIRCLE_RUDDER, CIRCLE_RUDDER_TOLERANCE, FormManoeuvre, TURNING_CIRCLE_35, ZIG_ZAG_10_10, ZIG_ZAG_20_20,
};
use crate::turn::{self, HeldTurn};

/// Maximum yaw rate of a straight approach, relative to the maximum yaw rate of the record.
const MAX_STRAIGHT_RATE: f64 = 0.05;

/// Minimum number of rows for the yaw rate of an approach to a circle.
const MIN_APPROACH_ROWS: usize = 3;

/// Record with its correction to full load.
#[derive(Debug, Clone, Copy)]
pub struct FormRecord<'a> {
    /// Record.
    pub trial: &'a Trial,
    /// Correction; `None` without a model of the condition of the trial.
    pub correction: Option<&'a Correction>,
    /// Current that was removed from the positions; `None` if no current was removed.
    pub current: Option<Current>,
}

impl FormRecord<'_> {
    /// Loading of the ship; a corrected record was at partial load, even if it declares full load. `None` if it is
    /// unknown.
    pub(crate) fn loading(&self) -> Option<Loading> {
        self.correction.map(|_| Loading::Partial).or_else(|| self.trial.conditions().loading())
    }
}

/// Record with its manoeuvre of the form, characteristics and remark.
pub(crate) struct TestedManoeuvre<'a> {
    pub record: FormRecord<'a>,
    /// Manoeuvre and side; `None` if it is not a manoeuvre of the form.
    pub manoeuvre: Option<(FormManoeuvre, &'static str)>,
    /// Characteristics that the record shows.
    pub figures: Vec<(&'static str, Quantity)>,
    /// Reason why the record is not a manoeuvre of the form, or a remark; `None` without a remark.
    pub remark: Option<String>,
}

/// Manoeuvre and side, characteristics and remark of a record, or the reason why it is not a manoeuvre of the form.
type Classified = Result<((FormManoeuvre, &'static str), Vec<(&'static str, Quantity)>, Option<String>), String>;

impl<'a> TestedManoeuvre<'a> {
    /// Record as a manoeuvre of the form: a zig-zag of 10/10 or 20/20, or a circle with 35° (± 5 %) of rudder, from a
    /// straight course: the rudder amidships, and, if the approach is recorded, a yaw rate below a twentieth of the
    /// maximum or below three times its error.
    pub fn from_record(record: &FormRecord<'a>) -> Self {
        let classified = match Measured::from_trial(record.trial) {
            Ok(zigzag) if zigzag.executes.len() > 1 => zig_zag(record.trial, &zigzag),
            _ => circle(record.trial),
        };
        let record = *record;
        match classified {
            Ok((manoeuvre, figures, remark)) => Self { record, manoeuvre: Some(manoeuvre), figures, remark },
            Err(remark) => Self { record, manoeuvre: None, figures: Vec::new(), remark: Some(remark) },
        }
    }

    /// `true` if the record is of this manoeuvre to this side.
    pub fn matches(&self, manoeuvre: FormManoeuvre, side: &str) -> bool {
        self.manoeuvre.is_some_and(|(tested, to)| tested == manoeuvre && to == side)
    }

    /// Characteristic of the record, by name; `None` if the record does not show it.
    pub fn figure(&self, name: &str) -> Option<Quantity> {
        self.figures.iter().find(|(figure, _)| *figure == name).map(|(_, value)| *value)
    }
}

/// Name of the side of a sign.
fn side(sign: f64) -> &'static str {
    if sign < 0.0 { "port" } else { "starboard" }
}

fn zig_zag(trial: &Trial, zigzag: &Measured) -> Classified {
    let is_pair = |angle: f64| zigzag.nominal_angles.is_some_and(|pair| pair.is_deg(angle, angle));
    let manoeuvre = match (is_pair(10.0), is_pair(20.0)) {
        (true, _) => ZIG_ZAG_10_10,
        (_, true) => ZIG_ZAG_20_20,
        _ => {
            let pair = zigzag
                .nominal_angles
                .map_or_else(|| String::from("no regular pair of angles"), |pair| pair.to_string());
            return Err(format!("a zig-zag of {pair}, which is not part of the form"));
        }
    };
    let Some(first) = zigzag.first_side else {
        return Err(format!("the {manoeuvre} begins within the trial, so its overshoots cannot be counted"));
    };
    let begin = &zigzag.executes[0];
    if begin.rudder_before.abs() > 0.25 * begin.rudder_after.abs() {
        let before = to_deg(begin.rudder_before);
        return Err(format!("the {manoeuvre} begins with the rudder at {before:.1}°, not from a straight course"));
    }
    // A slope from the few headings after a first execute is not the yaw rate of the approach.
    let is_seen = zigzag.base_course.source == BaseCourseSource::Approach;
    if let (true, Some(rate), Some(largest)) = (is_seen, begin.yaw_rate, zigzag.largest_yaw_rate) {
        let allowed = (MAX_STRAIGHT_RATE * largest.value).max(3.0 * rate.sd.unwrap_or(0.0));
        if rate.value.abs() > allowed {
            let rate = to_deg(rate.value);
            return Err(format!("the {manoeuvre} begins at {rate:.2} deg/s, not from a straight course"));
        }
    }
    let names: &[&'static str] = match manoeuvre {
        ZIG_ZAG_10_10 => &["first_overshoot_deg", "second_overshoot_deg", "initial_turning_lengths"],
        _ => &["first_overshoot_deg"],
    };
    let show = |name: &&'static str| {
        Some((*name, helm_replay::measured_characteristic(trial, zigzag, name, None, trial.particulars())?))
    };
    let stands_in =
        manoeuvre == ZIG_ZAG_10_10 && zigzag.initial_turning_distance.is_none() && trial.particulars().is_some();
    let remarks = [
        (!is_seen).then_some("the record begins with the first execute, so its approach is not recorded"),
        stands_in.then_some(
            "no speed is recorded: the distance of the initial turning is V times its time, which is slightly long",
        ),
    ];
    let remarks: Vec<&str> = remarks.into_iter().flatten().collect();
    let remark = (!remarks.is_empty()).then(|| remarks.join("; "));
    Ok(((manoeuvre, side(first.sign())), names.iter().filter_map(show).collect(), remark))
}

fn circle(trial: &Trial) -> Classified {
    let neither = || String::from("neither a zig-zag nor a turning circle of the form");
    let turn = HeldTurn::from_trial(trial).ok_or_else(neither)?;
    let Particulars { length, speed } = trial.particulars().ok_or_else(|| {
        String::from("neither a zig-zag of the form nor, with an unknown length of the ship, a turning circle")
    })?;
    let passage = turn::resampled_record(trial, length / speed, Some(length)).ok_or_else(neither)?;
    let shown = turn.characteristics_within_record(&passage);
    shown["time_to_90_s"].ok_or_else(neither)?;
    let rudder = to_deg(turn.max_rudder);
    if (turn.max_rudder - CIRCLE_RUDDER).abs() > CIRCLE_RUDDER_TOLERANCE {
        return Err(format!("a turning circle with {rudder:.1}° of rudder; the form needs 35° or the largest angle"));
    }
    if turn.rudder_before.abs() > CIRCLE_RUDDER_TOLERANCE {
        let before = to_deg(turn.rudder_before);
        return Err(format!("the turning circle begins with the rudder at {before:.1}°, not from a straight course"));
    }
    let approach = (turn.approach_duration() / passage.period) as usize;
    if approach >= MIN_APPROACH_ROWS {
        let rate = (passage.heading[approach - 1] - passage.heading[0]) / ((approach - 1) as f64 * passage.period);
        if rate.abs() > MAX_STRAIGHT_RATE * passage.max_yaw_rate() {
            let rate = to_deg(rate);
            return Err(format!("the turning circle begins at {rate:.2} deg/s, not from a straight course"));
        }
    }
    let names = ["advance_lengths", "tactical_diameter_lengths"].into_iter();
    let figures: Vec<(&'static str, Quantity)> =
        names.filter_map(|name| Some((name, Quantity::without_uncertainty(shown.get(name).copied()??)))).collect();
    let remark = figures
        .is_empty()
        .then(|| String::from("a turning circle without a track: it shows neither advance nor diameter"));
    Ok(((TURNING_CIRCLE_35, side(turn.side)), figures, remark))
}
