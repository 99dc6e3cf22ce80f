//! Coefficients together with the ship they are used on and how well they are known.

use serde::{Deserialize, Serialize};

use super::coefficients::{COEFFICIENTS, PlanarCoefficients};
use super::error::{MotionError, positive};
use super::record::MotionOutput;

/// Speed and drift of one ship: coefficients, length, approach speed, and what the fit tells about them.
///
/// Made by fit() or from known coefficients; immutable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Planar {
    /// The coefficients of the equations, dimensionless.
    pub coefficients: PlanarCoefficients,
    /// Length of the ship L, m.
    pub length: f64,
    /// Speed of the straight approach U₀, m/s.
    pub approach_speed: f64,
    /// Covariance of the coefficients in the order of SYMBOLS; zero for one that is
    /// known or that lies at the end of what its sign allows.
    pub covariance: [[f64; COEFFICIENTS]; COEFFICIENTS],
    /// The records of the fit, in their order; none where the coefficients were given.
    pub records: Vec<MotionRecordFit>,
}

/// What a fit tells about one record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionRecordFit {
    /// Name of the record.
    pub name: String,
    /// Approach speed U₀ of this record, m/s.
    pub approach_speed: f64,
    /// Surge and sway in the first row, m/s.
    pub start: [f64; 2],
    /// Current towards north and east, m/s, where the record told one.
    pub current: Option<[f64; 2]>,
    /// Residuals, one entry for each kind of output of the record.
    pub residuals: Vec<Residual>,
}

/// Residuals of one kind of output.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Residual {
    /// What was fitted.
    pub output: MotionOutput,
    /// Readings; of a position, those of north and east together.
    pub readings: usize,
    /// Root of their mean square, m/s, or m of a position.
    pub rms: f64,
}

impl Planar {
    /// A ship of length `length` (m) and approach speed `approach_speed` (m/s) with known coefficients.
    ///
    /// Fails with [`MotionError::NotPositive`].
    pub fn new(coefficients: PlanarCoefficients, length: f64, approach_speed: f64) -> Result<Self, MotionError> {
        let covariance = [[0.0; COEFFICIENTS]; COEFFICIENTS];
        let coefficients = PlanarCoefficients::from_array(coefficients.to_array());
        Self { coefficients, length, approach_speed, covariance, records: Vec::new() }.scaled_to(length, approach_speed)
    }

    /// Whether the records tell drift, and with it a track: one has sway or positions, or the coefficients were given.
    /// √(u² + v²) alone is the same for many pairs of surge and sway.
    pub fn tells_drift(&self) -> bool {
        let tells = |own: &Residual| matches!(own.output, MotionOutput::Sway | MotionOutput::Position);
        self.records.is_empty() || self.records.iter().flat_map(|record| &record.residuals).any(tells)
    }

    /// The same coefficients on a ship of another length (m) and approach speed (m/s).
    ///
    /// At the same Froude number, U₀² ~ L, this is the ship of the model: its time runs slower by the root of the ratio
    /// of lengths. At another, the residuary resistance is not that of the records, and the loss of speed is less sure.
    /// Fails with [`MotionError::NotPositive`].
    pub fn scaled_to(&self, length: f64, approach_speed: f64) -> Result<Self, MotionError> {
        positive("length", length)?;
        positive("approach speed", approach_speed)?;
        Ok(Self { length, approach_speed, ..self.clone() })
    }

    /// The same ship with its coefficients changed by so much, in the order of
    /// [`SYMBOLS`](super::coefficients::SYMBOLS): a draw from the covariance. A value of a sign that the equations do
    /// not allow is put to the nearest that they do.
    pub fn stepped(&self, step: &[f64]) -> Self {
        let coefficients = PlanarCoefficients::from_array(moved(self.coefficients.to_array(), step));
        Self { coefficients, ..self.clone() }
    }

    /// (u', v') in m/s² at surge u and sway v (m/s), yaw rate r (rad/s) and rudder (rad).
    pub fn rates(&self, u: f64, v: f64, r: f64, rudder: f64) -> [f64; 2] {
        let speed = self.approach_speed;
        let unit = speed * speed / self.length;
        let [a, b] = self.coefficients.rates(u / speed, v / speed, r * self.length / speed, rudder);
        [a * unit, b * unit]
    }

    /// Surge and sway (m/s) at all times (s, increasing) of a record of yaw rate (rad/s) and rudder (rad), both
    /// straight between the rows, from surge and sway `start` in the first row.
    ///
    /// As many rows as the shortest of the three columns has. Values that are not finite spread to all later rows.
    pub fn drive(&self, time: &[f64], yaw_rate: &[f64], rudder: &[f64], start: [f64; 2]) -> Vec<[f64; 2]> {
        let rows = time.len().min(yaw_rate.len()).min(rudder.len());
        let driven = [time, yaw_rate, rudder].map(|column| &column[..rows]);
        self.coefficients.velocities([self.length, self.approach_speed], driven, start)
    }
}

/// Values with a step added to each.
pub(crate) fn moved<const N: usize>(mut values: [f64; N], step: &[f64]) -> [f64; N] {
    values.iter_mut().zip(step).for_each(|(value, step)| *value += step);
    values
}

/// Root mean square of one kind of residual over records.
pub(crate) fn pooled(records: &[MotionRecordFit], output: MotionOutput) -> Option<f64> {
    let own = records.iter().flat_map(|record| &record.residuals).filter(|own| own.output == output);
    let (square, readings) = own.fold((0.0, 0), |(square, readings), own| {
        (square + own.rms * own.rms * own.readings as f64, readings + own.readings)
    });
    (readings > 0).then(|| (square / readings as f64).sqrt())
}
