//! Points at which a formula is looked at: signals of the sizes of some records.

use super::program::FormulaSignal;
use crate::effects::effect::Manoeuvres;

/// Sizes of the signals in some records.
#[derive(Debug, Clone, Copy)]
pub(super) struct SignalSizes {
    yaw_rate: f64,
    rudder: f64,
    pub(super) speed: f64,
    propeller: f64,
    duration: f64,
    wind: f64,
    gain: f64,
    pub(super) length: f64,
    lateral_way: f64,
}

impl SignalSizes {
    pub(super) fn ones() -> Self {
        Self {
            yaw_rate: 1.0,
            rudder: 1.0,
            speed: 1.0,
            propeller: 1.0,
            duration: 1.0,
            wind: 1.0,
            gain: 1.0,
            length: 1.0,
            lateral_way: 1.0,
        }
    }

    /// r L/U of a zig-zag is about 0.3, K′/T′ about 1, y/L about three times the rudder.
    pub(super) fn of(about: &Manoeuvres) -> Self {
        let speed = about.speed.or(about.sway).unwrap_or(1.0);
        Self {
            yaw_rate: 0.3 / about.time,
            rudder: about.rudder,
            speed,
            propeller: about.propeller.unwrap_or(1.0),
            duration: about.duration,
            wind: about.wind_square.unwrap_or(1.0).sqrt(),
            gain: about.time.powi(-2),
            length: about.time * speed,
            lateral_way: 3.0 * about.rudder * about.time * way_speed(about),
        }
    }
}

/// Speed by which a lateral way grows in these records, m/s: 1 where one of them has none.
pub(super) fn way_speed(about: &Manoeuvres) -> f64 {
    about.speed.unwrap_or(1.0)
}

/// The signals at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct SignalPoint {
    pub(super) scales: SignalSizes,
    /// From −1 to 1: yaw rate, rudder, heading, sway, direction of the wind, lateral way.
    pub(super) signed: [f64; 6],
    /// From 0.5 to 1: speed, propeller, time, speed of the wind.
    pub(super) positive: [f64; 4],
    /// Numbers of units that go into a second and into a metre.
    pub(super) second: f64,
    pub(super) metre: f64,
}

impl SignalPoint {
    /// Points at which a formula is looked at.
    pub(super) const COUNT: usize = 64;

    /// Points all over the range of the signals, always the same.
    pub(super) fn all(scales: &SignalSizes) -> impl Iterator<Item = Self> + use<> {
        let scales = *scales;
        (1..=Self::COUNT).map(move |number| Self::of_number(number, &scales))
    }

    /// The point of a number: parts of multiples of roots, which fill a box evenly (Weyl).
    fn of_number(number: usize, scales: &SignalSizes) -> Self {
        const ROOTS: [f64; 10] = [2.0, 3.0, 5.0, 7.0, 11.0, 29.0, 13.0, 17.0, 19.0, 23.0];
        let part = |root: f64| (number as f64 * root.sqrt()).fract();
        Self {
            scales: *scales,
            signed: std::array::from_fn(|place| 2.0 * part(ROOTS[place]) - 1.0),
            positive: std::array::from_fn(|place| 0.5 + 0.5 * part(ROOTS[6 + place])),
            second: 1.0,
            metre: 1.0,
        }
    }

    pub(super) fn mirrored(self) -> Self {
        Self { signed: self.signed.map(|value| -value), ..self }
    }

    pub(super) fn of(&self, signal: FormulaSignal) -> f64 {
        let Self { scales, signed: [r, delta, psi, v, angle, y], positive: [speed, n, t, wind], second, metre } = *self;
        let per_second = metre / second;
        match signal {
            FormulaSignal::YawRate => r * scales.yaw_rate / second,
            FormulaSignal::Rudder => delta * scales.rudder,
            // A zig-zag turns about as far as its rudder goes.
            FormulaSignal::Heading => psi * scales.rudder,
            FormulaSignal::LateralWay => y * scales.lateral_way * metre,
            FormulaSignal::Sway => 0.15 * v * scales.speed * per_second,
            FormulaSignal::Surge | FormulaSignal::Speed => speed * scales.speed * per_second,
            FormulaSignal::Propeller => n * scales.propeller / second,
            FormulaSignal::Time => t * scales.duration * second,
            FormulaSignal::WindSpeed => wind * scales.wind * per_second,
            FormulaSignal::WindAngle => std::f64::consts::PI * angle,
            FormulaSignal::PrimeYawRate => r * scales.yaw_rate * scales.length / (speed * scales.speed),
            FormulaSignal::PrimeSway => 0.15 * v / speed,
            FormulaSignal::SpeedRatio => speed,
            FormulaSignal::Start => 0.0,
            FormulaSignal::Gain => scales.gain / (second * second),
        }
    }
}
