//! Sample points at which a formula is evaluated: signals with the scales of given records.

use super::program::FormulaSignal;
use crate::effects::effect::RecordScales;

/// Scales of the signals of a formula in given records, in SI units and radians.
#[derive(Debug, Clone, Copy)]
pub(super) struct SignalScales {
    yaw_rate: f64,
    rudder: f64,
    pub(super) speed: f64,
    propeller: f64,
    duration: f64,
    wind: f64,
    K_over_T: f64,
    pub(super) length: f64,
    lateral_distance: f64,
}

impl SignalScales {
    pub(super) fn ones() -> Self {
        Self {
            yaw_rate: 1.0,
            rudder: 1.0,
            speed: 1.0,
            propeller: 1.0,
            duration: 1.0,
            wind: 1.0,
            K_over_T: 1.0,
            length: 1.0,
            lateral_distance: 1.0,
        }
    }

    /// Magnitudes of the signals in records: r L/U = 0.3, K′/T′ = 1 and y/L = 3 δ_max are usual in zig-zags; the other
    /// magnitudes are those of the records. A quantity that the records do not have has the magnitude 1.
    pub(super) fn from_records(records: &RecordScales) -> Self {
        let speed = records.approach_speed.or(records.approach_speed_for_sway).unwrap_or(1.0);
        Self {
            yaw_rate: 0.3 / records.ship_length_time,
            rudder: records.max_rudder,
            speed,
            propeller: records.rms_propeller_rate.unwrap_or(1.0),
            duration: records.duration,
            wind: records.mean_square_wind_speed.unwrap_or(1.0).sqrt(),
            K_over_T: records.ship_length_time.powi(-2),
            length: records.ship_length_time * speed,
            lateral_distance: 3.0 * records.max_rudder * records.ship_length_time * lateral_distance_speed(records),
        }
    }
}

/// Speed in the rate of the lateral distance, m/s; 1 if a record has no measured speed.
pub(super) fn lateral_distance_speed(records: &RecordScales) -> f64 {
    records.approach_speed.unwrap_or(1.0)
}

/// Sample point: a value of every signal.
#[derive(Debug, Clone, Copy)]
pub(super) struct SignalPoint {
    pub(super) scales: SignalScales,
    /// Values from −1 to 1, relative to their scales, of yaw rate, rudder, heading, sway, direction of the wind,
    /// lateral distance.
    pub(super) signed: [f64; 6],
    /// Values from 0.5 to 1, relative to their scales, of speed, propeller, time, speed of the wind.
    pub(super) positive: [f64; 4],
    /// Number of time units in a second.
    pub(super) second: f64,
    /// Number of length units in a metre.
    pub(super) metre: f64,
}

impl SignalPoint {
    /// Number of sample points.
    pub(super) const COUNT: usize = 64;

    /// Sample points over the range of the signals, identical in every call.
    pub(super) fn all(scales: &SignalScales) -> impl Iterator<Item = Self> + use<> {
        let scales = *scales;
        (1..=Self::COUNT).map(move |number| Self::weyl(number, &scales))
    }

    /// Sample point of a Weyl sequence: fractional parts of multiples of square roots (Weyl 1916), equidistributed in a
    /// box.
    fn weyl(number: usize, scales: &SignalScales) -> Self {
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

    pub(super) fn signal(&self, signal: FormulaSignal) -> f64 {
        let Self { scales, signed: [r, delta, psi, v, angle, y], positive: [speed, n, t, wind], second, metre } = *self;
        let per_second = metre / second;
        match signal {
            FormulaSignal::YawRate => r * scales.yaw_rate / second,
            FormulaSignal::Rudder => delta * scales.rudder,
            // In a zig-zag the heading reaches about the rudder angle.
            FormulaSignal::Heading => psi * scales.rudder,
            FormulaSignal::LateralDistance => y * scales.lateral_distance * metre,
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
            FormulaSignal::KOverT => scales.K_over_T / (second * second),
        }
    }
}
