//! Part of a log that becomes a record: the selected manoeuvre, else its only zig-zag. A log with several zig-zags is
//! refused.

use document::{Warning, WarningCode};
use ship::Particulars;

use super::error::{ReadError, ReadProblem};
use super::log::ReadRecord;
use super::source::InstrumentLog;
use crate::channel::Channel;
use crate::find::{self, DetectedManoeuvre, LogSignals};
use crate::manoeuvre::Manoeuvre;

/// Maximum share of time outside the zig-zag of a record used as a whole; a larger share is a run-up, a stop, the way
/// back to the course or another manoeuvre, and is cut.
const MAX_SURPLUS_SHARE: f64 = 0.02;

impl InstrumentLog {
    /// Manoeuvres of the log, in order of time; empty without a heading.
    pub fn detected_manoeuvres(&self) -> Vec<DetectedManoeuvre> {
        let (Some(rudder), Some(heading)) = (self.channel(Channel::Rudder), self.channel(Channel::Heading)) else {
            return Vec::new();
        };
        find::detect_manoeuvres(&LogSignals {
            time: self.time(),
            rudder,
            heading,
            speed: self.channel(Channel::Speed),
            propeller_rate: self.channel(Channel::PropellerRate),
        })
    }

    /// Record of the only zig-zag in the log, or of the whole log if none is recognised; the warnings state the
    /// part. `ship` overrides the sidecar.
    ///
    /// Fails as [`into_trial`](Self::into_trial) does, and if the log contains several zig-zags.
    pub fn into_zig_zag(self, ship: Option<Particulars>) -> Result<ReadRecord, ReadError> {
        self.into_manoeuvre(None)?.into_trial(ship)
    }

    /// Part with the manoeuvre of this number, from 1. Without a number, the part of the only zig-zag if much of the
    /// log is outside it, else the whole log or the part declared by its sidecar. A choice adds a warning to the log.
    ///
    /// Fails for a number without a manoeuvre, and, without a number, if the log contains several zig-zags.
    pub fn into_manoeuvre(mut self, number: Option<usize>) -> Result<Self, ReadError> {
        if number.is_none() && self.has_declared_interval() {
            return Ok(self);
        }
        let manoeuvres = self.detected_manoeuvres();
        let file = self.path.display().to_string();
        let manoeuvre = match number {
            Some(number) => number
                .checked_sub(1)
                .and_then(|place| manoeuvres.get(place))
                .ok_or_else(|| self.fault(ReadProblem::NoManoeuvre { file, number, count: manoeuvres.len() }))?,
            None => match zig_zags(&manoeuvres)[..] {
                [] => {
                    self.warnings.extend(unrecognised(&manoeuvres, &file));
                    return Ok(self);
                }
                [(_, only)] => only,
                ref several => {
                    let line = |(number, zig_zag): &(usize, &DetectedManoeuvre)| {
                        let [from, until] = [zig_zag.start_time, zig_zag.end_time].map(|time| self.shown(time));
                        format!("\n  --trial {number}: {}, {from} to {until}", zig_zag.name())
                    };
                    let (count, lines) = (several.len(), several.iter().map(line).collect());
                    return Err(self.fault(ReadProblem::SeveralZigZags { count, lines }));
                }
            },
        };
        let (from, until, time) = (manoeuvre.start_time, manoeuvre.end_time, self.time());
        let surplus = (from - time[0]) + (time[time.len() - 1] - until);
        if number.is_none() && surplus <= MAX_SURPLUS_SHARE * (until - from) {
            return Ok(self);
        }
        let text = format!(
            "the {} from {} to {} is used, the rest is left out; for another part, write `from-s` and `until-s` under [part] \
             of its sidecar",
            manoeuvre.name(),
            self.shown(from),
            self.shown(until)
        );
        self.warnings.push(WarningCode::Part.warning(text));
        self.into_interval(from, until)
    }

    /// Text of a time (s) of the log: seconds, and the time of day if the log has a clock.
    fn shown(&self, time: f64) -> String {
        let clock = self.clock.map(|clock| format!(" ({})", clock.time_of_day_at(time)));
        format!("{time:.1} s{}", clock.unwrap_or_default())
    }
}

/// Zig-zags in a list of manoeuvres, with their numbers.
fn zig_zags(manoeuvres: &[DetectedManoeuvre]) -> Vec<(usize, &DetectedManoeuvre)> {
    let numbered = (1..).zip(manoeuvres);
    numbered.filter(|(_, entry)| matches!(entry.manoeuvre, Some(Manoeuvre::ZigZag { .. }))).collect()
}

/// Warning of a log without a recognised zig-zag but with a straight piece; `None` without such a piece.
fn unrecognised(manoeuvres: &[DetectedManoeuvre], file: &str) -> Option<Warning> {
    let has_straight = manoeuvres.iter().any(|entry| entry.manoeuvre.is_none());
    let text = format!(
        "no zig-zag is recognised, so the whole record is used; `study find {file}` lists its manoeuvres; to use a part, \
         write `from-s` and `until-s` under [part] of its sidecar"
    );
    has_straight.then(|| WarningCode::WholeRecord.warning(text))
}
