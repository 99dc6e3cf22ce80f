//! Which manoeuvre of the form of MSC/Circ.1053 a record is, and what it shows of it.

use ship::angle::{from_deg, to_deg};
use trial::zigzag::BaseCourseSource;
use trial::{Quantity, ZigZag as Measured};

use crate::form::FormRecord;
use crate::imo::{CIRCLE, FormManoeuvre, TEN, TWENTY};
use crate::steered;
use crate::turn::{self, Turn};

/// Yaw rate of a straight approach as a share of the largest of the record.
const STRAIGHT: f64 = 0.05;

/// Difference from 35° at which a circle is still that of the form, and angle of a rudder that is amidships, rad.
const RUDDER: f64 = 0.05 * 35.0 * ship::angle::DEGREE;

/// Rows at least from which the yaw rate of an approach to a circle is read.
const FEWEST: usize = 3;

/// A record as the form sees it.
#[derive(Default)]
pub(crate) struct Tested {
    /// The manoeuvre with its side, where it is one of the form.
    pub what: Option<(FormManoeuvre, &'static str)>,
    /// Figures that it shows.
    pub figures: Vec<(&'static str, Quantity)>,
    /// Why it is none of the form, or what is to be said of it.
    pub remark: Option<String>,
}

impl Tested {
    /// Whether it is a manoeuvre of the form.
    pub fn is_used(&self) -> bool {
        self.what.is_some()
    }

    /// A figure of a manoeuvre to a side.
    pub fn figure(&self, manoeuvre: FormManoeuvre, side: &str, name: &str) -> Option<Quantity> {
        let is_it = self.what.is_some_and(|(own, to)| own == manoeuvre && to == side);
        self.figures.iter().find(|(own, _)| is_it && *own == name).map(|(_, value)| *value)
    }
}

/// The side of a sign.
pub(crate) fn side(sign: f64) -> &'static str {
    if sign < 0.0 { "port" } else { "starboard" }
}

/// The record as a manoeuvre of the form: a zig-zag of 10/10 or 20/20, or a circle with 35° (± 5 %) of rudder, from a
/// straight course: the rudder amidships, and, where the approach is recorded, a yaw rate below a twentieth of the
/// largest or below three times its error.
pub(crate) fn of(record: &FormRecord) -> Tested {
    let tested = match Measured::of(record.trial) {
        Ok(zigzag) if zigzag.executes.len() > 1 => zig_zag(record, &zigzag),
        _ => circle(record),
    };
    tested.unwrap_or_else(|remark| Tested { remark: Some(remark), ..Tested::default() })
}

fn zig_zag(record: &FormRecord, zigzag: &Measured) -> Result<Tested, String> {
    let is_pair = |angle: f64| zigzag.pair.is_some_and(|pair| pair.is_deg(angle, angle));
    let manoeuvre = match (is_pair(10.0), is_pair(20.0)) {
        (true, _) => TEN,
        (_, true) => TWENTY,
        _ => {
            let pair = zigzag.pair.map_or_else(|| String::from("no regular pair of angles"), |pair| pair.to_string());
            return Err(format!("a zig-zag of {pair}, which the form does not ask for"));
        }
    };
    let Some(first) = zigzag.side else {
        return Err(format!("the {manoeuvre} begins within the trial, so its overshoots cannot be counted"));
    };
    let begin = &zigzag.executes[0];
    if begin.rudder_before.abs() > 0.25 * begin.rudder_after.abs() {
        let before = to_deg(begin.rudder_before);
        return Err(format!("the {manoeuvre} begins with the rudder at {before:.1}°, not from a straight course"));
    }
    // A slope that is read off the few headings behind a first execute says nothing of the approach.
    let is_seen = zigzag.base_course.source == BaseCourseSource::Approach;
    if let (true, Some(rate), Some(largest)) = (is_seen, begin.yaw_rate, zigzag.largest_yaw_rate) {
        let allowed = (STRAIGHT * largest.value).max(3.0 * rate.sd.unwrap_or(0.0));
        if rate.value.abs() > allowed {
            let rate = to_deg(rate.value);
            return Err(format!("the {manoeuvre} begins at {rate:.2} deg/s, not from a straight course"));
        }
    }
    let trial = record.trial;
    let names: &[&'static str] = match manoeuvre {
        TEN => &["first_overshoot_deg", "second_overshoot_deg", "initial_turning_lengths"],
        _ => &["first_overshoot_deg"],
    };
    let show = |name: &&'static str| Some((*name, steered::shown(trial, zigzag, name, None, trial.particulars())?));
    let figures = names.iter().filter_map(show).collect();
    let stands_in = manoeuvre == TEN && zigzag.initial_turning_distance.is_none() && trial.particulars().is_some();
    let mut remarks = Vec::new();
    remarks.extend((!is_seen).then_some("the record begins with the first execute, and its approach is not seen"));
    remarks.extend(stands_in.then_some(
        "no speed is recorded: the distance of the initial turning is V times its time, which is slightly long",
    ));
    let remark = (!remarks.is_empty()).then(|| remarks.join("; "));
    Ok(Tested { what: Some((manoeuvre, side(first.sign()))), figures, remark })
}

fn circle(record: &FormRecord) -> Result<Tested, String> {
    let trial = record.trial;
    let neither = "neither a zig-zag nor a turning circle of the form";
    let Some(turn) = Turn::of(trial.rudder_signal()) else { return Err(neither.into()) };
    let Some(own) = trial.particulars() else {
        return Err("neither a zig-zag of the form nor, with an unknown length of the ship, a turning circle".into());
    };
    let Some(passage) = turn::recorded(trial, own.length / own.speed, Some(own.length)) else {
        return Err(neither.into());
    };
    let start = trial.time()[0];
    let shown = turn.figures(&passage.until(turn.until - start), start);
    let value = |name: &str| shown.iter().find(|(own, _)| *own == name).and_then(|(_, value)| *value);
    if value("time_to_90_s").is_none() {
        return Err(neither.into());
    }
    let rudder = to_deg(turn.rudder);
    if (turn.rudder - from_deg(35.0)).abs() > RUDDER {
        return Err(format!("a turning circle with {rudder:.1}° of rudder; the form asks for 35° or the largest"));
    }
    if turn.before.abs() > RUDDER {
        let before = to_deg(turn.before);
        return Err(format!("the turning circle begins with the rudder at {before:.1}°, not from a straight course"));
    }
    let approach = ((turn.execute - start) / passage.period) as usize;
    let largest = passage.largest_rate();
    if approach >= FEWEST {
        let rate = (passage.heading[approach - 1] - passage.heading[0]) / ((approach - 1) as f64 * passage.period);
        if rate.abs() > STRAIGHT * largest {
            let rate = to_deg(rate);
            return Err(format!("the turning circle begins at {rate:.2} deg/s, not from a straight course"));
        }
    }
    let names = ["advance_lengths", "tactical_diameter_lengths"];
    let figures: Vec<(&'static str, Quantity)> =
        names.into_iter().filter_map(|name| Some((name, Quantity::bare(value(name)?)))).collect();
    let remark = figures
        .is_empty()
        .then(|| String::from("a turning circle without a track: it shows neither advance nor diameter"));
    Ok(Tested { what: Some((CIRCLE, side(turn.side))), figures, remark })
}
