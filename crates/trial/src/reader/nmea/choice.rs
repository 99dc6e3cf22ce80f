//! Which instrument gives which channel, and the channels made of them. One channel never mixes instruments: the better
//! kind goes first (true heading before magnetic, speed through the water before speed over ground), then the one with
//! the most readings, then the one that appeared first. What was chosen among several is said.

use ship::angle::to_deg;

use super::epochs::{median, rounded};
use super::log::{Log, Sensor, name};
use super::position::plane;
use super::sentence::{Kind, Slot, turned};
use crate::channel::Channel;
use crate::reader::source::Series;
use crate::words::counted;

/// An instrument that may give a channel.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    sensor: usize,
    /// Place among its columns.
    place: usize,
    /// 0 is preferred to 1.
    class: usize,
    readings: usize,
}

/// One with fewer readings than the fullest by this factor is no candidate, of whatever class it is.
const SPARSE: usize = 100;
/// Rudders that differ by more than this (rms) are not one, degrees.
const RUDDERS_APART_DEG: f64 = 2.0;

/// Makes the channels of a log.
pub(super) struct Choice<'a> {
    log: &'a Log,
    pub series: Vec<Series>,
    /// One sentence each.
    pub warnings: Vec<String>,
}

impl<'a> Choice<'a> {
    /// All channels the log gives.
    pub fn of(log: &'a Log) -> Self {
        let mut choice = Self { log, series: Vec::new(), warnings: Vec::new() };
        choice.heading();
        choice.rudder();
        choice.one("rudder order", Slot::RudderOrder, Channel::RudderOrder, |_| true);
        choice.one("yaw rate", Slot::YawRate, Channel::YawRate, |_| true);
        choice.one("roll angle", Slot::Transducer, Channel::Roll, |sensor| sensor.part[0] == b'O');
        choice.speed();
        choice.surge_and_sway();
        choice.position();
        choice.propeller();
        choice.wind();
        choice
    }

    /// The instruments that give one of some quantities, each with the class of the quantity.
    fn candidates(&self, slots: &[(Slot, usize)], wanted: impl Fn(&Sensor) -> bool) -> Vec<Candidate> {
        let mut found = Vec::new();
        for &(slot, class) in slots {
            for (sensor, table) in self.log.sensors.iter().enumerate().filter(|(_, table)| wanted(table)) {
                if let Some(place) = table.place(slot) {
                    found.push(Candidate { sensor, place, class, readings: table.readings(place) });
                }
            }
        }
        found
    }

    /// The best candidate; what was chosen among several is said, and always where `always`.
    fn pick(&mut self, what: &str, mut candidates: Vec<Candidate>, always: bool) -> Option<Candidate> {
        candidates.retain(|candidate| candidate.readings > 0);
        let most = candidates.iter().map(|candidate| candidate.readings).max()?;
        let order = |candidate: &Candidate| {
            let sparse = candidate.readings.saturating_mul(SPARSE) < most;
            (sparse, candidate.class, usize::MAX - candidate.readings, candidate.sensor, candidate.place)
        };
        let chosen = *candidates.iter().min_by_key(|candidate| order(candidate))?;
        let mut others: Vec<Candidate> = Vec::new();
        for candidate in candidates {
            if candidate.sensor != chosen.sensor && others.iter().all(|other| other.sensor != candidate.sensor) {
                others.push(candidate);
            }
        }
        let label = name(self.log, chosen.sensor);
        if always || !others.is_empty() {
            let mut text = format!("{what} from {label} ({})", counted(chosen.readings, "reading"));
            let unused: Vec<String> =
                others.iter().map(|other| format!("{} ({})", name(self.log, other.sensor), other.readings)).collect();
            match unused.as_slice() {
                [] => {}
                [one] => text.push_str(&format!("; {one} is not used")),
                [first @ .., last] => text.push_str(&format!("; {} and {last} are not used", first.join(", "))),
            }
            self.warnings.push(text);
        }
        self.tell_odd(what, chosen);
        Some(chosen)
    }

    fn tell_odd(&mut self, what: &str, chosen: Candidate) {
        let odd = self.log.sensors[chosen.sensor].odd[chosen.place];
        if odd > 0 {
            let label = name(self.log, chosen.sensor);
            let text = counted(odd, "entry").replace("entrys", "entries");
            self.warnings.push(format!("{text} of {label} cannot be a {what}, taken as missing"));
        }
    }

    /// Adds a channel with the instants of an instrument.
    fn push(&mut self, channel: Channel, chosen: Candidate, values: impl Iterator<Item = f64>) {
        let at = &self.log.sensors[chosen.sensor].at;
        let room = || Vec::with_capacity(at.len());
        let mut series = Series { channel, time: room(), values: room() };
        for (&time, value) in at.iter().zip(values) {
            let time = rounded(time);
            // Two readings at one instant would be a step without time.
            if series.time.last().is_none_or(|&last| time > last) {
                series.time.push(time);
                series.values.push(value);
            }
        }
        self.series.push(series);
    }

    fn push_column(&mut self, channel: Channel, chosen: Candidate) {
        let log = self.log;
        self.push(channel, chosen, log.sensors[chosen.sensor].columns[chosen.place].iter().copied());
    }

    /// A channel that is one column of one instrument.
    fn one(&mut self, what: &str, slot: Slot, channel: Channel, wanted: impl Fn(&Sensor) -> bool) {
        let candidates = self.candidates(&[(slot, 0)], wanted);
        if let Some(chosen) = self.pick(what, candidates, false) {
            self.push_column(channel, chosen);
        }
    }

    /// True before magnetic; a magnetic heading with variation is a true one.
    fn heading(&mut self) {
        let log = self.log;
        let variation = |sensor: usize| {
            let sensor = &log.sensors[sensor];
            sensor.place(Slot::Variation).map(|place| &sensor.columns[place])
        };
        let first = |column: &Vec<f64>| column.iter().copied().find(|value| value.is_finite());
        let mut candidates = self.candidates(&[(Slot::HeadingTrue, 0), (Slot::HeadingMagnetic, 1)], |_| true);
        for candidate in candidates.iter_mut().filter(|candidate| candidate.class == 1) {
            candidate.class = usize::from(variation(candidate.sensor).and_then(first).is_none());
        }
        let Some(chosen) = self.pick("heading", candidates, false) else { return };
        if chosen.class == 1 {
            self.warnings.push(format!(
                "the heading of {} is magnetic, because no variation is given; changes of heading are right, the direction \
                 of north is not",
                name(log, chosen.sensor)
            ));
        }
        match variation(chosen.sensor).and_then(|column| Some((column, first(column)?))) {
            Some((column, mut held)) => {
                let sensor = &log.sensors[chosen.sensor];
                let values = sensor.columns[chosen.place].iter().zip(column).map(|(heading, variation)| {
                    if variation.is_finite() {
                        held = *variation;
                    }
                    if heading.is_finite() { turned(heading + held) } else { f64::NAN }
                });
                self.push(Channel::Heading, chosen, values);
            }
            None => self.push_column(Channel::Heading, chosen),
        }
    }

    /// One rudder, or the mean of two that go together.
    fn rudder(&mut self) {
        let log = self.log;
        let mut candidates = self.candidates(&[(Slot::RudderStarboard, 0), (Slot::RudderPort, 0)], |_| true);
        candidates.extend(self.candidates(&[(Slot::Transducer, 1)], |sensor| sensor.part[0] == b'R'));
        let Some(chosen) = self.pick("rudder angle", candidates, false) else { return };
        let sensor = &log.sensors[chosen.sensor];
        if sensor.kind != Kind::Rsa {
            return self.push_column(Channel::Rudder, chosen);
        }
        let [starboard, port] = [&sensor.columns[0], &sensor.columns[1]];
        let pairs = || starboard.iter().zip(port).filter(|(one, other)| one.is_finite() && other.is_finite());
        let number = pairs().count();
        let side = ["starboard", "port"][chosen.place];
        // A second rudder that speaks now and then is no second reading.
        if 2 * number < chosen.readings {
            let spoken = sensor.readings(1 - chosen.place);
            if chosen.place == 1 || spoken > 0 {
                self.warnings.push(format!(
                    "the rudder angle is that of the {side} rudder; the other one has {}",
                    counted(spoken, "reading")
                ));
            }
            return self.push_column(Channel::Rudder, chosen);
        }
        let rms = (pairs().map(|(one, other)| (one - other).powi(2)).sum::<f64>() / number as f64).sqrt();
        let rms_deg = to_deg(rms);
        if rms_deg > RUDDERS_APART_DEG {
            self.warnings.push(format!(
                "the two rudders differ by {rms_deg:.1}° (rms); the rudder angle is that of the {side} rudder"
            ));
            return self.push_column(Channel::Rudder, chosen);
        }
        self.warnings.push(format!("the rudder angle is the mean of two rudders, {rms_deg:.1}° apart (rms)"));
        let mean = starboard.iter().zip(port).map(|(one, other)| 0.5 * (one + other));
        self.push(Channel::Rudder, chosen, mean);
    }

    /// Through the water before over ground.
    fn speed(&mut self) {
        let log = self.log;
        let slots = [(Slot::SpeedWater, 0), (Slot::SurgeWater, 0), (Slot::SpeedGround, 1), (Slot::SurgeGround, 1)];
        let candidates = self.candidates(&slots, |_| true);
        let most = candidates.iter().map(|candidate| candidate.readings).max().unwrap_or(0);
        let is_water = |one: &Candidate| one.readings > 0 && one.class == 0 && one.readings * SPARSE >= most;
        let water = candidates.iter().any(is_water);
        let what = if water { "speed through the water" } else { "speed over ground" };
        let Some(chosen) = self.pick(what, candidates, true) else { return };
        let sensor = &log.sensors[chosen.sensor];
        if sensor.kind == Kind::Vbw {
            // A log with one axis gives no sway.
            let (ahead, across) = (&sensor.columns[chosen.place], &sensor.columns[chosen.place + 1]);
            let speed = ahead.iter().zip(across).map(|(u, v)| if v.is_finite() { u.hypot(*v) } else { u.abs() });
            self.push(Channel::Speed, chosen, speed);
        } else {
            self.push_column(Channel::Speed, chosen);
        }
    }

    /// Both of one instrument and one reference.
    fn surge_and_sway(&mut self) {
        let candidates = self.candidates(&[(Slot::SurgeWater, 0), (Slot::SurgeGround, 1)], |_| true);
        let Some(surge) = self.pick("surge velocity", candidates, false) else { return };
        if surge.class == 1 {
            self.warnings.push(format!("surge and sway of {} are over ground", name(self.log, surge.sensor)));
        }
        self.push_column(Channel::Surge, surge);
        let sway = Candidate { place: surge.place + 1, ..surge };
        if self.log.sensors[sway.sensor].readings(sway.place) > 0 {
            self.tell_odd("sway velocity", sway);
            self.push_column(Channel::Sway, sway);
        }
    }

    fn position(&mut self) {
        let log = self.log;
        let candidates = self.candidates(&[(Slot::Latitude, 0)], |_| true);
        let Some(chosen) = self.pick("position", candidates, false) else { return };
        let sensor = &log.sensors[chosen.sensor];
        let (north, east) = plane(&sensor.columns[chosen.place], &sensor.columns[chosen.place + 1]);
        self.push(Channel::North, chosen, north.into_iter());
        self.push(Channel::East, chosen, east.into_iter());
    }

    /// Shafts before engines; several shafts give their mean.
    fn propeller(&mut self) {
        let log = self.log;
        let mut candidates = self.candidates(&[(Slot::Revolutions, 0)], |_| true);
        candidates.retain(|candidate| candidate.readings > 0);
        let group = |candidate: &Candidate| {
            let sensor = &log.sensors[candidate.sensor];
            (sensor.address, sensor.source, sensor.part[0])
        };
        for candidate in &mut candidates {
            candidate.class = usize::from(log.sensors[candidate.sensor].part[0] == b'E');
        }
        let mut leaders: Vec<Candidate> = Vec::new();
        for candidate in &candidates {
            match leaders.iter_mut().find(|leader| group(leader) == group(candidate)) {
                Some(leader) if leader.readings < candidate.readings => *leader = *candidate,
                Some(_) => {}
                None => leaders.push(*candidate),
            }
        }
        let Some(chosen) = self.pick("propeller rate", leaders, false) else { return };
        let shafts: Vec<Candidate> = candidates
            .into_iter()
            .filter(|candidate| group(candidate) == group(&chosen))
            .filter(|candidate| candidate.readings.saturating_mul(SPARSE) >= chosen.readings)
            .collect();
        let lead = &log.sensors[chosen.sensor];
        // The sign tells how a shaft turns, seen from astern; outward turning ones have one of each.
        let sign = |shaft: &Candidate| {
            let sum: f64 =
                log.sensors[shaft.sensor].columns[shaft.place].iter().filter(|value| value.is_finite()).sum();
            if sum < 0.0 { -1.0 } else { 1.0 }
        };
        let mut values = vec![0.0; lead.at.len()];
        for shaft in &shafts {
            let sensor = &log.sensors[shaft.sensor];
            let factor = sign(shaft) / shafts.len() as f64;
            let mut near = Nearest::new(&sensor.at, &sensor.columns[shaft.place]);
            for (value, &time) in values.iter_mut().zip(&lead.at) {
                *value += factor * near.at(time);
            }
        }
        if shafts.len() > 1 {
            self.warnings.push(format!("the propeller rate is the mean of {} shafts", shafts.len()));
        }
        let turned: Vec<String> =
            shafts.iter().filter(|shaft| sign(shaft) < 0.0).map(|shaft| name(log, shaft.sensor)).collect();
        if !turned.is_empty() {
            self.warnings.push(format!(
                "{} turns counter-clockwise (below zero) in most readings; its rate is taken as positive",
                turned.join(" and ")
            ));
        }
        self.push(Channel::PropellerRate, chosen, values.into_iter());
    }

    fn wind(&mut self) {
        let reference = |letter: u8| move |sensor: &Sensor| sensor.kind == Kind::Mwv && sensor.part[0] == letter;
        let relative = self.candidates(&[(Slot::WindFrom, 0)], reference(b'R'));
        if let Some(chosen) = self.pick("relative wind", relative, false) {
            self.push_column(Channel::WindRelativeSpeed, Candidate { place: 0, ..chosen });
            self.push_column(Channel::WindRelativeFrom, chosen);
        }
        let log = self.log;
        let mut real = self.candidates(&[(Slot::WindFrom, 0)], |sensor| sensor.kind == Kind::Mwd);
        real.extend(self.candidates(&[(Slot::WindFrom, 1)], reference(b'T')));
        let Some(chosen) = self.pick("true wind", real, false) else { return };
        self.push_column(Channel::WindTrueSpeed, Candidate { place: 0, ..chosen });
        let sensor = &log.sensors[chosen.sensor];
        if sensor.kind == Kind::Mwd {
            return self.push_column(Channel::WindTrueFrom, chosen);
        }
        let from_bow = name(log, chosen.sensor);
        let Some(heading) = self.series.iter().find(|series| series.channel == Channel::Heading) else {
            self.warnings.push(format!(
                "{from_bow} gives the true wind from the bow; without a heading its direction is left out"
            ));
            return;
        };
        let mut near = Nearest::new(&heading.time, &heading.values);
        let readings = sensor.at.iter().zip(&sensor.columns[chosen.place]);
        let north = readings.map(|(&time, from)| from + near.at(time));
        let values: Vec<f64> = north.map(|from| if from.is_finite() { turned(from) } else { f64::NAN }).collect();
        self.push(Channel::WindTrueFrom, chosen, values.into_iter());
        self.warnings
            .push(format!("{from_bow} gives the direction of the true wind from the bow; the heading is added to it"));
    }
}

/// Looks for the reading nearest in time, for times that do not go back.
struct Nearest<'a> {
    time: &'a [f64],
    values: &'a [f64],
    place: usize,
    /// One farther away is none, s.
    farthest: f64,
}

impl<'a> Nearest<'a> {
    fn new(time: &'a [f64], values: &'a [f64]) -> Self {
        let usual = median(time.windows(2).map(|pair| pair[1] - pair[0]));
        Self { time, values, place: 0, farthest: 3.0 * usual }
    }

    fn at(&mut self, time: f64) -> f64 {
        let distance = |place: usize| (self.time[place] - time).abs();
        while self.place + 1 < self.time.len() && distance(self.place + 1) <= distance(self.place) {
            self.place += 1;
        }
        match self.values.get(self.place) {
            Some(&value) if (self.time[self.place] - time).abs() <= self.farthest => value,
            _ => f64::NAN,
        }
    }
}
