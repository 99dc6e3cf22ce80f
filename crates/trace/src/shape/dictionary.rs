//! Dictionary of moment shapes in addition to the listed effects: functions of heading, way to one side, yaw rate,
//! rudder and its history, and of time.

use std::f64::consts::{PI, TAU};

use document::trace::Dependence;

use super::motion::PredictedMotion;

/// Signal of the predicted motion on which a moment depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShipSignal {
    /// Heading ψ.
    Heading,
    /// Lateral way y to starboard of the initial course.
    Way,
    /// Yaw rate r.
    YawRate,
    /// Rudder δ.
    Rudder,
}

impl ShipSignal {
    /// Signal at every row of a motion: heading and rudder in rad, yaw rate in rad/s, way per m/s of speed in s.
    fn values<'a>(self, motion: &'a PredictedMotion) -> &'a [f64] {
        match self {
            Self::Heading => &motion.heading,
            Self::Way => &motion.way,
            Self::YawRate => &motion.yaw_rate,
            Self::Rudder => &motion.rudder,
        }
    }

    /// Dependence of a moment with this signal.
    pub fn dependence(self) -> Dependence {
        match self {
            Self::Heading => Dependence::Heading,
            Self::Way => Dependence::LateralDistance,
            Self::YawRate => Dependence::YawRate,
            Self::Rudder => Dependence::Rudder,
        }
    }

    /// Symbol of the signal in a description, and in a formula.
    fn names(self) -> [&'static str; 2] {
        match self {
            Self::Heading => ["ψ", "psi"],
            Self::Way => ["y", "y"],
            Self::YawRate => ["r", "r"],
            Self::Rudder => ["δ", "delta"],
        }
    }
}

/// Function of one variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SignalFunction {
    /// x.
    Linear,
    /// x².
    Square,
    /// x³.
    Cube,
    /// |x|.
    Magnitude,
    /// x if positive, else 0.
    Positive,
    /// x |x|.
    SignedSquare,
}

impl SignalFunction {
    /// All functions.
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

    fn notation(self, name: &str) -> String {
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

/// Shape of a moment, without its coefficients. Instants are in s from the start of the record, durations and lags in
/// s, frequencies in cycles per record. In functions of time, t is the time since the start as a share of the record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// Function of one signal, or the product of two such functions.
    Powers(Dependence, (ShipSignal, SignalFunction), Option<(ShipSignal, SignalFunction)>),
    /// Delay: δ(t − τ) − δ.
    Delay(f64),
    /// δ after a first-order lag.
    LaggedRudder(f64),
    /// r after a first-order lag.
    LaggedYawRate(f64),
    /// q δ and q r, with q = r² after a first-order lag.
    LaggedSquaredYawRate(f64),
    /// q δ and q r, with q = |δ| after a first-order lag.
    LaggedRudderMagnitude(f64),
    /// Hysteresis: δ with the sign of the last change of |δ|.
    Hysteresis,
    /// t or t².
    Trend(SignalFunction),
    /// t ψ.
    HeadingTrend,
    /// t δ and t r.
    ResponseTrend,
    /// Unit step at an instant.
    Step(f64),
    /// Change of K and T at an instant, s from the first row: δ and r from then on.
    ResponseChange(f64),
    /// δ from an instant on: change of K.
    GainChange(f64),
    /// r from an instant on: change of T.
    TimeConstantChange(f64),
    /// δ' from an instant on: change of the delay.
    DelayChange(f64),
    /// t − t₀ from an instant on.
    TrendFrom(f64),
    /// Box: instant, duration.
    Pulse(f64, f64),
    /// cos² pulse: instant, duration.
    Squall(f64, f64),
    /// Linear rise from zero to one: instant, duration.
    Ramp(f64, f64),
    /// Cosine and sine: frequency.
    Sinusoid(f64),
    /// Cosine and sine with their second and third harmonics: frequency.
    Harmonics(f64),
    /// Cosine and sine of linearly changing frequency: initial and final frequency.
    Chirp(f64, f64),
}

/// Minimum rudder rate that counts as a change of |δ|, rad/s.
const MIN_RATE: f64 = 0.005;

impl Shape {
    /// Dependence of the moment.
    pub fn dependence(&self) -> Dependence {
        match self {
            Self::Powers(dependence, ..) => *dependence,
            Self::Delay(_) | Self::LaggedRudder(_) | Self::LaggedYawRate(_) => Dependence::History,
            Self::LaggedSquaredYawRate(_) | Self::LaggedRudderMagnitude(_) | Self::Hysteresis => Dependence::History,
            Self::HeadingTrend => Dependence::Heading,
            _ => Dependence::Time,
        }
    }

    /// `true` if the shape depends on time, and so belongs to one record.
    pub fn is_time_dependent(&self) -> bool {
        self.dependence() == Dependence::Time || *self == Self::HeadingTrend
    }

    /// Class of similar shapes, as an index.
    pub fn class(&self) -> usize {
        match self {
            Self::HeadingTrend => 6,
            Self::ResponseTrend => 7,
            Self::Trend(_) => 8,
            Self::Step(_) => 9,
            Self::ResponseChange(_) | Self::GainChange(_) | Self::TimeConstantChange(_) | Self::DelayChange(_) => 10,
            Self::TrendFrom(_) | Self::Ramp(..) => 11,
            Self::Pulse(..) | Self::Squall(..) => 12,
            Self::Sinusoid(_) | Self::Harmonics(_) | Self::Chirp(..) => 13,
            _ => self.dependence() as usize,
        }
    }

    /// Moments at the rows of a record, one per coefficient.
    pub fn moments(&self, motion: &PredictedMotion) -> Vec<Vec<f64>> {
        let time = &motion.record.time;
        let [start, duration] = motion.span();
        let rows = |value: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..time.len()).map(value).collect() };
        let t = |row: usize| (time[row] - start) / duration;
        // An instant is smoothed over one row.
        let after = |row: usize, at: f64| ((time[row] - start - at) / motion.record.spacing + 0.5).clamp(0.0, 1.0);
        let (rudder, yaw_rate) = (&motion.rudder, &motion.yaw_rate);
        let both =
            |q: &dyn Fn(usize) -> f64| vec![rows(&|row| q(row) * rudder[row]), rows(&|row| q(row) * yaw_rate[row])];
        let wave = |phase: &dyn Fn(f64) -> f64| [f64::cos, f64::sin].map(|wave| rows(&|row| wave(phase(t(row)))));
        match *self {
            Self::Powers(_, (signal, power), factor) => {
                let factor = factor.map(|(signal, power)| (signal.values(motion), power));
                let factor = |row: usize| factor.map_or(1.0, |(signal, power)| power.at(signal[row]));
                vec![rows(&|row| power.at(signal.values(motion)[row]) * factor(row))]
            }
            Self::Delay(lag) => vec![rows(&|row| motion.record.rudder.value_at(time[row] - lag) - rudder[row])],
            Self::LaggedRudder(lag) => vec![motion.lagged(|row| rudder[row], lag)],
            Self::LaggedYawRate(lag) => vec![motion.lagged(|row| yaw_rate[row], lag)],
            Self::LaggedSquaredYawRate(lag) => {
                let lagged = motion.lagged(|row| yaw_rate[row].powi(2), lag);
                both(&|row| lagged[row])
            }
            Self::LaggedRudderMagnitude(lag) => {
                let lagged = motion.lagged(|row| rudder[row].abs(), lag);
                both(&|row| lagged[row])
            }
            Self::Hysteresis => vec![hysteresis(motion)],
            Self::Trend(power) => vec![rows(&|row| power.at(t(row)))],
            Self::HeadingTrend => vec![rows(&|row| t(row) * motion.heading[row])],
            Self::ResponseTrend => both(&t),
            Self::Step(at) => vec![rows(&|row| after(row, at))],
            Self::ResponseChange(at) => both(&|row| after(row, at)),
            Self::GainChange(at) => vec![rows(&|row| after(row, at) * rudder[row])],
            Self::TimeConstantChange(at) => vec![rows(&|row| after(row, at) * yaw_rate[row])],
            Self::DelayChange(at) => vec![rows(&|row| after(row, at) * motion.rudder_rate[row])],
            Self::TrendFrom(at) => vec![rows(&|row| (time[row] - start - at).max(0.0) / duration)],
            Self::Pulse(at, own_duration) => vec![rows(&|row| after(row, at) - after(row, at + own_duration))],
            Self::Squall(at, own_duration) => vec![rows(&|row| {
                let share = (time[row] - start - at) / own_duration - 0.5;
                if share.abs() < 0.5 { (PI * share).cos().powi(2) } else { 0.0 }
            })],
            Self::Ramp(at, own_duration) => {
                vec![rows(&|row| ((time[row] - start - at) / own_duration).clamp(0.0, 1.0))]
            }
            Self::Sinusoid(cycles) => wave(&|t| TAU * cycles * t).to_vec(),
            Self::Harmonics(cycles) => {
                (1..=3).flat_map(|harmonic| wave(&|t| TAU * f64::from(harmonic) * cycles * t)).collect()
            }
            Self::Chirp(from, to) => wave(&|t| TAU * (from * t + 0.5 * (to - from) * t * t)).to_vec(),
        }
    }

    /// Parameters that a search refines, with their initial steps, for a record of `duration` (s).
    fn places(&mut self, duration: f64) -> Vec<(&mut f64, f64)> {
        match self {
            Self::Step(at) | Self::ResponseChange(at) | Self::GainChange(at) => vec![(at, 0.01 * duration)],
            Self::TimeConstantChange(at) | Self::DelayChange(at) => vec![(at, 0.01 * duration)],
            Self::Pulse(at, own_duration) => vec![(at, 0.01 * duration), (own_duration, 0.01 * duration)],
            Self::Squall(at, own_duration) => vec![(at, 0.012 * duration), (own_duration, 0.016 * duration)],
            Self::Ramp(at, own_duration) => vec![(at, 0.02 * duration), (own_duration, 0.03 * duration)],
            Self::Sinusoid(cycles) => vec![(cycles, 0.15)],
            Self::Harmonics(cycles) => vec![(cycles, 0.07)],
            Self::Chirp(from, to) => vec![(from, 0.5), (to, 0.5)],
            _ => Vec::new(),
        }
    }

    /// Number of parameters that a search refines: instants, durations and frequencies, but not lags.
    pub fn parameter_count(&self) -> usize {
        self.clone().places(1.0).len()
    }

    /// Shape with a refined parameter moved by a share of its step; `None` if it leaves its range for a record of this
    /// duration and row spacing, s.
    pub fn moved(&self, place: usize, share: f64, [duration, spacing]: [f64; 2]) -> Option<Self> {
        let mut moved = *self;
        let (value, step) = moved.places(duration).into_iter().nth(place)?;
        *value += share * step;
        let min = match moved {
            Self::Sinusoid(_) | Self::Harmonics(_) | Self::Chirp(..) => 0.8,
            _ if place == 1 => 2.0 * spacing,
            _ => f64::NEG_INFINITY,
        };
        (*moved.places(duration)[place].0 >= min).then_some(moved)
    }

    /// Start and end of the action of a shape (of the rise for a ramp), s from the start of the record; `None` for a
    /// shape without instants.
    pub fn span(&self, duration: f64) -> Option<[f64; 2]> {
        match *self {
            Self::Step(at) | Self::ResponseChange(at) | Self::GainChange(at) => Some([at, duration]),
            Self::TimeConstantChange(at) | Self::DelayChange(at) | Self::TrendFrom(at) => Some([at, duration]),
            Self::Pulse(at, own_duration) | Self::Squall(at, own_duration) | Self::Ramp(at, own_duration) => {
                Some([at, at + own_duration])
            }
            _ => None,
        }
    }

    /// `true` if the response of the ship changes at an instant.
    pub fn is_change(&self) -> bool {
        self.class() == Self::ResponseChange(0.0).class()
    }

    /// Description for a record of this start and duration, s.
    pub fn description(&self, [start, duration]: [f64; 2]) -> String {
        let at = |time: f64| format!("{:.0} s", start + time);
        let span = |from: f64, own_duration: f64| format!("from {:.0} to {}", start + from, at(from + own_duration));
        let period = |cycles: f64| format!("{:.0} s", duration / cycles);
        match *self {
            Self::Powers(_, (signal, power), None) => format!("moment with {}", power.notation(signal.names()[0])),
            Self::Powers(_, (signal, power), Some((other, second))) => {
                format!("moment with {} {}", power.notation(signal.names()[0]), second.notation(other.names()[0]))
            }
            Self::Delay(lag) => format!("rudder delayed by {lag:.1} s"),
            Self::LaggedRudder(lag) => format!("rudder after a lag of {lag:.0} s"),
            Self::LaggedYawRate(lag) => format!("yaw rate after a lag of {lag:.0} s"),
            Self::LaggedSquaredYawRate(lag) => format!("K and T that vary with r² after a lag of {lag:.0} s"),
            Self::LaggedRudderMagnitude(lag) => format!("K and T that vary with |δ| after a lag of {lag:.0} s"),
            Self::Hysteresis => String::from("K that differs between rudder going out and coming back"),
            Self::Trend(SignalFunction::Linear) => String::from("moment that grows with time"),
            Self::Trend(_) => String::from("moment that grows with the square of time"),
            Self::HeadingTrend => String::from("moment with ψ that grows with time"),
            Self::ResponseTrend => String::from("K and T that change with time"),
            Self::Step(from) => format!("moment from {} on", at(from)),
            Self::ResponseChange(from) => format!("K and T that change at {}", at(from)),
            Self::GainChange(from) => format!("K that changes at {}", at(from)),
            Self::TimeConstantChange(from) => format!("T that changes at {}", at(from)),
            Self::DelayChange(from) => format!("rudder delay that changes at {}", at(from)),
            Self::TrendFrom(from) => format!("moment that grows from {} on", at(from)),
            Self::Pulse(from, own_duration) => format!("moment {}", span(from, own_duration)),
            Self::Squall(from, own_duration) => format!("squall {}", span(from, own_duration)),
            Self::Ramp(from, own_duration) => format!("moment that rises {}", span(from, own_duration)),
            Self::Sinusoid(cycles) => format!("moment with a period of {}", period(cycles)),
            Self::Harmonics(cycles) => format!("moment with a period of {} and its harmonics", period(cycles)),
            Self::Chirp(from, to) => format!("moment whose period runs from {} to {}", period(from), period(to)),
        }
    }

    /// Formula with its coefficient c, as a user can type it; `None` if the shape has no formula.
    pub fn formula(&self) -> Option<String> {
        let Self::Powers(_, (signal, power), factor) = *self else { return None };
        let factor = factor.map(|(signal, power)| format!(" * {}", power.formula(signal.names()[1])));
        Some(format!("c * {}{}", power.formula(signal.names()[1]), factor.unwrap_or_default()))
    }
}

/// δ times the sign of the last change of |δ|, + for growth; 0 before the first change.
fn hysteresis(motion: &PredictedMotion) -> Vec<f64> {
    let mut sign = 0.0;
    let signed = motion.rudder.iter().zip(&motion.rudder_rate).map(|(rudder, rate)| {
        let growth = rate * rudder.signum();
        if growth.abs() > MIN_RATE {
            sign = growth.signum();
        }
        sign * rudder
    });
    signed.collect()
}
