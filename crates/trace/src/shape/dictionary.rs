//! The moments that are looked for beside the list of effects: functions of heading, way to one side, yaw rate, rudder
//! and its history, and of time.

use std::f64::consts::{PI, TAU};

use document::trace::Dependence;

use super::motion::ForeseenMotion;

/// A signal of the ship.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShipSignal {
    /// Heading ψ.
    Heading,
    /// Way y.
    Way,
    /// Yaw rate r.
    YawRate,
    /// Rudder δ.
    Rudder,
}

impl ShipSignal {
    fn of<'a>(self, motion: &'a ForeseenMotion) -> &'a [f64] {
        match self {
            Self::Heading => &motion.heading,
            Self::Way => &motion.way,
            Self::YawRate => &motion.rate,
            Self::Rudder => &motion.rudder,
        }
    }

    /// What a moment with it depends on.
    pub fn dependence(self) -> Dependence {
        match self {
            Self::Heading => Dependence::Heading,
            Self::Way => Dependence::Way,
            Self::YawRate => Dependence::YawRate,
            Self::Rudder => Dependence::Rudder,
        }
    }

    /// On a page, and in a formula.
    fn names(self) -> [&'static str; 2] {
        match self {
            Self::Heading => ["ψ", "psi"],
            Self::Way => ["y", "y"],
            Self::YawRate => ["r", "r"],
            Self::Rudder => ["δ", "delta"],
        }
    }
}

/// A function of one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Power {
    /// x.
    Linear,
    /// x².
    Square,
    /// x³.
    Cube,
    /// |x|.
    Magnitude,
    /// x where it is positive, else 0.
    Positive,
    /// x |x|.
    SignedSquare,
}

impl Power {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::Linear, Self::Square, Self::Cube, Self::Magnitude, Self::Positive, Self::SignedSquare];

    fn at(self, x: f64) -> f64 {
        match self {
            Self::Linear => x,
            Self::Square => x * x,
            Self::Cube => x * x * x,
            Self::Magnitude => x.abs(),
            Self::Positive => x.max(0.0),
            Self::SignedSquare => x * x.abs(),
        }
    }

    fn of(self, name: &str) -> String {
        match self {
            Self::Linear => name.to_owned(),
            Self::Square => format!("{name}²"),
            Self::Cube => format!("{name}³"),
            Self::Magnitude => format!("|{name}|"),
            Self::Positive => format!("{name}⁺"),
            Self::SignedSquare => format!("{name}|{name}|"),
        }
    }

    fn formula(self, name: &str) -> String {
        match self {
            Self::Linear => name.to_owned(),
            Self::Square => format!("{name}^2"),
            Self::Cube => format!("{name}^3"),
            Self::Magnitude => format!("abs({name})"),
            Self::Positive => format!("max({name}, 0)"),
            Self::SignedSquare => format!("{name} * abs({name})"),
        }
    }
}

/// A moment but for its coefficients. Times are in s from the beginning of the record, lags in s, numbers of cycles in
/// the record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A power of one signal, or the product of two.
    Powers(Dependence, (ShipSignal, Power), Option<(ShipSignal, Power)>),
    /// δ(t − τ) − δ.
    Delay(f64),
    /// δ after a lag.
    RudderMemory(f64),
    /// r after a lag.
    RateMemory(f64),
    /// q δ and q r with r² after a lag.
    RateSquareMemory(f64),
    /// q δ and q r with |δ| after a lag.
    RudderSizeMemory(f64),
    /// δ with the sign of the last change of its size.
    Hysteresis,
    /// t, and t².
    Trend(Power),
    /// t ψ.
    HeadingTrend,
    /// t δ and t r.
    ResponseTrend,
    /// One from an instant on.
    Step(f64),
    /// δ and r from an instant on: another K and T.
    ResponseChange(f64),
    /// δ from an instant on: another K.
    GainChange(f64),
    /// r from an instant on: another T.
    TimeChange(f64),
    /// δ' from an instant on: another delay.
    DelayChange(f64),
    /// t − t₀ from an instant on.
    Bend(f64),
    /// One from an instant on for so long.
    Pulse(f64, f64),
    /// cos² about the middle of such a span.
    Squall(f64, f64),
    /// A rise from zero to one in such a span.
    Ramp(f64, f64),
    /// A cosine and a sine.
    Period(f64),
    /// The same with two harmonics.
    Harmonics(f64),
    /// A cosine and a sine whose frequency runs from one to another.
    Chirp(f64, f64),
}

/// Smallest rate, rad/s, at which the size of the rudder changes.
const TURNING: f64 = 0.005;

impl Shape {
    /// What it depends on.
    pub fn dependence(&self) -> Dependence {
        match self {
            Self::Powers(dependence, ..) => *dependence,
            Self::Delay(_) | Self::RudderMemory(_) | Self::RateMemory(_) => Dependence::History,
            Self::RateSquareMemory(_) | Self::RudderSizeMemory(_) | Self::Hysteresis => Dependence::History,
            Self::HeadingTrend => Dependence::Heading,
            _ => Dependence::Time,
        }
    }

    /// Whether it is a matter of time, and so of one record.
    pub fn is_of_time(&self) -> bool {
        self.dependence() == Dependence::Time || *self == Self::HeadingTrend
    }

    /// The class within which shapes are like one another, by its number.
    pub fn class(&self) -> usize {
        match self {
            Self::HeadingTrend => 6,
            Self::ResponseTrend => 7,
            Self::Trend(_) => 8,
            Self::Step(_) => 9,
            Self::ResponseChange(_) | Self::GainChange(_) | Self::TimeChange(_) | Self::DelayChange(_) => 10,
            Self::Bend(_) | Self::Ramp(..) => 11,
            Self::Pulse(..) | Self::Squall(..) => 12,
            Self::Period(_) | Self::Harmonics(_) | Self::Chirp(..) => 13,
            _ => self.dependence() as usize,
        }
    }

    /// Its moments at the rows of a record, one for every coefficient.
    pub fn moments(&self, motion: &ForeseenMotion) -> Vec<Vec<f64>> {
        let time = &motion.record.time;
        let [start, duration] = motion.span();
        let rows = |value: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..time.len()).map(value).collect() };
        let t = |row: usize| (time[row] - start) / duration;
        // Half a row on either side of an instant the moment is on its way.
        let after = |row: usize, at: f64| ((time[row] - start - at) / motion.record.spacing + 0.5).clamp(0.0, 1.0);
        let (rudder, rate) = (&motion.rudder, &motion.rate);
        let both =
            |of: &dyn Fn(usize) -> f64| vec![rows(&|row| of(row) * rudder[row]), rows(&|row| of(row) * rate[row])];
        let wave = |phase: &dyn Fn(f64) -> f64| [f64::cos, f64::sin].map(|wave| rows(&|row| wave(phase(t(row)))));
        match *self {
            Self::Powers(_, (one, power), other) => {
                let (one, other) = (one.of(motion), other.map(|(signal, power)| (signal.of(motion), power)));
                let beside = |row: usize| other.map_or(1.0, |(signal, power)| power.at(signal[row]));
                vec![rows(&|row| power.at(one[row]) * beside(row))]
            }
            Self::Delay(lag) => vec![rows(&|row| motion.record.rudder.at(time[row] - lag) - rudder[row])],
            Self::RudderMemory(lag) => vec![motion.lagged(|row| rudder[row], lag)],
            Self::RateMemory(lag) => vec![motion.lagged(|row| rate[row], lag)],
            Self::RateSquareMemory(lag) => {
                let memory = motion.lagged(|row| rate[row].powi(2), lag);
                both(&|row| memory[row])
            }
            Self::RudderSizeMemory(lag) => {
                let memory = motion.lagged(|row| rudder[row].abs(), lag);
                both(&|row| memory[row])
            }
            Self::Hysteresis => vec![hysteresis(motion)],
            Self::Trend(power) => vec![rows(&|row| power.at(t(row)))],
            Self::HeadingTrend => vec![rows(&|row| t(row) * motion.heading[row])],
            Self::ResponseTrend => both(&t),
            Self::Step(at) => vec![rows(&|row| after(row, at))],
            Self::ResponseChange(at) => both(&|row| after(row, at)),
            Self::GainChange(at) => vec![rows(&|row| after(row, at) * rudder[row])],
            Self::TimeChange(at) => vec![rows(&|row| after(row, at) * rate[row])],
            Self::DelayChange(at) => vec![rows(&|row| after(row, at) * motion.rudder_rate[row])],
            Self::Bend(at) => vec![rows(&|row| (time[row] - start - at).max(0.0) / duration)],
            Self::Pulse(at, length) => vec![rows(&|row| after(row, at) - after(row, at + length))],
            Self::Squall(at, length) => vec![rows(&|row| {
                let share = (time[row] - start - at) / length - 0.5;
                if share.abs() < 0.5 { (PI * share).cos().powi(2) } else { 0.0 }
            })],
            Self::Ramp(at, length) => vec![rows(&|row| ((time[row] - start - at) / length).clamp(0.0, 1.0))],
            Self::Period(cycles) => wave(&|t| TAU * cycles * t).to_vec(),
            Self::Harmonics(cycles) => {
                (1..=3).flat_map(|harmonic| wave(&|t| TAU * f64::from(harmonic) * cycles * t)).collect()
            }
            Self::Chirp(from, to) => wave(&|t| TAU * (from * t + 0.5 * (to - from) * t * t)).to_vec(),
        }
    }

    /// Its places, with the steps in which they are sought, for a record so long.
    fn places(&mut self, duration: f64) -> Vec<(&mut f64, f64)> {
        match self {
            Self::Step(at) | Self::ResponseChange(at) | Self::GainChange(at) => vec![(at, 0.01 * duration)],
            Self::TimeChange(at) | Self::DelayChange(at) => vec![(at, 0.01 * duration)],
            Self::Pulse(at, length) => vec![(at, 0.01 * duration), (length, 0.01 * duration)],
            Self::Squall(at, length) => vec![(at, 0.012 * duration), (length, 0.016 * duration)],
            Self::Ramp(at, length) => vec![(at, 0.02 * duration), (length, 0.03 * duration)],
            Self::Period(cycles) => vec![(cycles, 0.15)],
            Self::Harmonics(cycles) => vec![(cycles, 0.07)],
            Self::Chirp(from, to) => vec![(from, 0.5), (to, 0.5)],
            _ => Vec::new(),
        }
    }

    /// Number of its places.
    pub fn place_count(&self) -> usize {
        self.clone().places(1.0).len()
    }

    /// The same with one place moved by a share of its step; `None` where there is no such moment in a record so long
    /// with rows so far apart, s.
    pub fn moved(&self, place: usize, share: f64, [duration, spacing]: [f64; 2]) -> Option<Self> {
        let mut moved = *self;
        let (value, step) = moved.places(duration).into_iter().nth(place)?;
        *value += share * step;
        let least = match moved {
            Self::Period(_) | Self::Harmonics(_) | Self::Chirp(..) => 0.8,
            _ if place == 1 => 2.0 * spacing,
            _ => f64::NEG_INFINITY,
        };
        (*moved.places(duration)[place].0 >= least).then_some(moved)
    }

    /// From when until when it acts, s from the beginning of the record; `None` for one that is no matter of instants.
    pub fn span(&self, duration: f64) -> Option<[f64; 2]> {
        match *self {
            Self::Step(at) | Self::ResponseChange(at) | Self::GainChange(at) => Some([at, duration]),
            Self::TimeChange(at) | Self::DelayChange(at) | Self::Bend(at) => Some([at, duration]),
            Self::Pulse(at, length) | Self::Squall(at, length) | Self::Ramp(at, length) => Some([at, at + length]),
            _ => None,
        }
    }

    /// Whether the response of the ship is another one from an instant on.
    pub fn is_change(&self) -> bool {
        self.class() == Self::ResponseChange(0.0).class()
    }

    /// The moment in words, for a record that begins at a time and lasts so long, s.
    pub fn words(&self, [start, duration]: [f64; 2]) -> String {
        let at = |time: f64| format!("{:.0} s", start + time);
        let span = |from: f64, length: f64| format!("from {:.0} to {}", start + from, at(from + length));
        let period = |cycles: f64| format!("{:.0} s", duration / cycles);
        match *self {
            Self::Powers(_, (one, power), None) => format!("moment with {}", power.of(one.names()[0])),
            Self::Powers(_, (one, power), Some((other, second))) => {
                format!("moment with {} {}", power.of(one.names()[0]), second.of(other.names()[0]))
            }
            Self::Delay(lag) => format!("rudder of {lag:.1} s before"),
            Self::RudderMemory(lag) => format!("rudder after a lag of {lag:.0} s"),
            Self::RateMemory(lag) => format!("yaw rate after a lag of {lag:.0} s"),
            Self::RateSquareMemory(lag) => format!("K and T with r² after a lag of {lag:.0} s"),
            Self::RudderSizeMemory(lag) => format!("K and T with |δ| after a lag of {lag:.0} s"),
            Self::Hysteresis => String::from("another K while the rudder goes out than while it comes back"),
            Self::Trend(Power::Linear) => String::from("moment that grows with time"),
            Self::Trend(_) => String::from("moment that grows with the square of time"),
            Self::HeadingTrend => String::from("moment with ψ that grows with time"),
            Self::ResponseTrend => String::from("K and T that change with time"),
            Self::Step(from) => format!("moment from {} on", at(from)),
            Self::ResponseChange(from) => format!("another K and T from {} on", at(from)),
            Self::GainChange(from) => format!("another K from {} on", at(from)),
            Self::TimeChange(from) => format!("another T from {} on", at(from)),
            Self::DelayChange(from) => format!("another delay of the rudder from {} on", at(from)),
            Self::Bend(from) => format!("moment that grows from {} on", at(from)),
            Self::Pulse(from, length) => format!("moment {}", span(from, length)),
            Self::Squall(from, length) => format!("squall {}", span(from, length)),
            Self::Ramp(from, length) => format!("moment that rises {}", span(from, length)),
            Self::Period(cycles) => format!("moment with a period of {}", period(cycles)),
            Self::Harmonics(cycles) => format!("moment with a period of {} and its harmonics", period(cycles)),
            Self::Chirp(from, to) => format!("moment whose period runs from {} to {}", period(from), period(to)),
        }
    }

    /// The moment as a formula that a user can type, with its coefficient; `None` where no formula says it.
    pub fn formula(&self) -> Option<String> {
        let Self::Powers(_, (one, power), other) = *self else { return None };
        let beside = other.map(|(signal, power)| format!(" * {}", power.formula(signal.names()[1])));
        Some(format!("c * {}{}", power.formula(one.names()[1]), beside.unwrap_or_default()))
    }
}

/// The rudder with the sign of the last change of its size.
fn hysteresis(motion: &ForeseenMotion) -> Vec<f64> {
    let mut sign = 0.0;
    let turned = motion.rudder.iter().zip(&motion.rudder_rate).map(|(rudder, rate)| {
        let growth = rate * rudder.signum();
        if growth.abs() > TURNING {
            sign = growth.signum();
        }
        sign * rudder
    });
    turned.collect()
}
