//! The coefficients from records, by output error.

use estimation::statistics::upper_median;
use nalgebra::DMatrix;
use trial::Trial;

use super::circle::track;
use super::coefficients::{BOUNDS, COEFFICIENTS, PlanarCoefficients, SYMBOLS, TYPICAL};
use super::error::{MotionError, positive};
use super::planar::{MotionRecordFit, Planar, Residual, pooled};
use super::record::{MotionOutput, MotionRecord, range};
use super::search::GroupedSquares;

/// Range of the heading that at least one record must have, rad (5°).
const TURNS: f64 = 0.087;

/// Times the weights of the kinds of output are taken anew from their residuals.
const REWEIGHTED: usize = 2;

/// First guess of the residuals, as a share of approach speed or length.
const FIRST_SHARE: f64 = 0.01;

/// Least residuals that are believed, as a share of approach speed or length.
const LEAST_SHARE: f64 = 1e-6;

/// Fits the planar equations to records of a ship of length `length` (m), all of them together.
///
/// Yaw rate and rudder are taken as measured; without a yaw rate it is the slope of a parabola through the headings
/// within 0.25 L/U₀. Fitted are surge and sway where a record has them, the speed where it has no surge, and the
/// position where it lacks surge or sway. Surge and sway at the beginning are free in every record; with positions also
/// the place of the beginning and, where the heading covers more than 360°, a uniform current. Less than a circle tells
/// a current from drift only badly, and there is none. A measured speed is taken to be that through the water.
///
/// The sum of squares over all readings is weighed with the standard deviation of each kind of output, taken twice from
/// the residuals. The covariance is that of a sandwich whose middle is the long-run covariance of the scores, because
/// residuals of such simple equations are coloured.
///
/// The approach speed of a record is free as well, near what is known of it: the mean speed (of positions, the way
/// made) before the rudder has moved by 1°, with its standard deviation, where five rows show it; else the declared
/// one, else that of the first readings, to 1 %. Where a current is free the declared speed comes first, and without
/// one the approach is steady: it has the speed of the first row. The result has the median over records.
///
/// Fails when the length is not positive, no record has a speed or positions, none turns by 5°, an approach speed
/// cannot be told, the search does not converge or leaves a coefficient open. Records without any output are left out.
pub fn fit(trials: &[Trial], length: f64) -> Result<Planar, MotionError> {
    positive("length", length)?;
    let with_output = trials.iter().filter_map(|trial| MotionRecord::of(trial, length).transpose());
    let records = with_output.collect::<Result<Vec<_>, _>>()?;
    let speed = upper_median(records.iter().map(|record| record.approach.speed));
    let speed = speed.ok_or(MotionError::NoOutput { records: trials.len() })?;
    let found = records.iter().map(|record| range(&record.heading)).fold(0.0, f64::max);
    if found < TURNS {
        return Err(MotionError::NotExcited { found, needed: TURNS });
    }
    let scale = |output: MotionOutput| if output == MotionOutput::Position { length } else { speed };
    let mut problem = PlanarProblem::new(records, length, MotionOutput::ALL.map(|output| FIRST_SHARE * scale(output)));
    let mut at = problem.start();
    for round in 0..=REWEIGHTED {
        at = problem.squares().minimise(&at)?;
        if round < REWEIGHTED {
            let records = problem.summary(&at);
            problem.deviations = MotionOutput::ALL
                .map(|output| pooled(&records, output).unwrap_or(0.0).max(LEAST_SHARE * scale(output)));
        }
    }
    let covariance = problem.squares().covariance(&at, &SYMBOLS)?;
    let records = problem.summary(&at);
    let approach_speed = upper_median(records.iter().map(|record| record.approach_speed)).expect("there are records");
    Ok(Planar {
        coefficients: coefficients(&at),
        length,
        approach_speed,
        covariance: std::array::from_fn(|i| std::array::from_fn(|j| covariance[(i, j)])),
        records,
    })
}

fn coefficients(at: &[f64]) -> PlanarCoefficients {
    PlanarCoefficients::from_array(std::array::from_fn(|i| at[i]))
}

/// All records with the weights of their outputs. The unknowns of a record follow the coefficients: surge, sway,
/// approach speed, and of positions north, east and the current.
struct PlanarProblem<'a> {
    records: Vec<MotionRecord<'a>>,
    /// Unknowns of every record.
    places: Vec<std::ops::Range<usize>>,
    length: f64,
    /// In the order of [`MotionOutput::ALL`].
    deviations: [f64; 4],
}

impl<'a> PlanarProblem<'a> {
    fn new(records: Vec<MotionRecord<'a>>, length: f64, deviations: [f64; 4]) -> Self {
        let mut end = COEFFICIENTS;
        let place = |record: &MotionRecord| {
            let has_position = record.outputs.iter().any(|(output, _)| *output == MotionOutput::Position);
            let first = end;
            end += 3 + 2 * usize::from(has_position) + 2 * usize::from(record.current);
            first..end
        };
        Self { places: records.iter().map(place).collect(), records, length, deviations }
    }

    fn start(&self) -> Vec<f64> {
        let mut at = TYPICAL.to_array().to_vec();
        for record in &self.records {
            at.extend([record.start[0], record.start[1], record.approach.speed]);
            let positions = record.outputs.iter().filter(|(output, _)| *output == MotionOutput::Position);
            let first = |column: &&[f64]| column.iter().copied().find(|value| value.is_finite()).unwrap_or(0.0);
            at.extend(positions.flat_map(|(_, columns)| columns).map(first));
            at.extend([0.0; 2].iter().filter(|_| record.current));
        }
        at
    }

    fn squares(&self) -> GroupedSquares<'_> {
        let (mut bounds, mut scales) = (BOUNDS.to_vec(), TYPICAL.to_array().to_vec());
        let free = [f64::NEG_INFINITY, f64::INFINITY];
        for (record, place) in self.records.iter().zip(&self.places) {
            let speed = record.approach.speed;
            let own = [free, free, [0.5 * speed, 2.0 * speed], free, free, free, free];
            bounds.extend(&own[..place.len()]);
            let metre = 100.0 * self.length;
            scales.extend(&[speed, speed, speed, metre, metre, 100.0 * speed, 100.0 * speed][..place.len()]);
        }
        let groups = self.places.iter().map(|own| (0..COEFFICIENTS).chain(own.clone()).collect()).collect();
        GroupedSquares { groups, bounds, scales, residuals: Box::new(|index, at| self.residuals(index, at)) }
    }

    fn summary(&self, at: &[f64]) -> Vec<MotionRecordFit> {
        let one = |(index, record): (usize, &MotionRecord)| {
            let own = &at[self.places[index].clone()];
            let residuals = self.residuals(index, at);
            let mut squares = residuals.column_iter().map(|column| column.norm_squared()).skip(1);
            let residual = |(output, readings): &(MotionOutput, Vec<&[f64]>)| {
                let square: f64 = squares.by_ref().take(readings.len()).sum();
                let count = readings.iter().flat_map(|column| column.iter()).filter(|x| x.is_finite()).count();
                let rms = (square / count.max(1) as f64).sqrt() * self.deviations[*output as usize];
                Residual { output: *output, readings: count, rms }
            };
            MotionRecordFit {
                name: record.name.to_owned(),
                approach_speed: own[2],
                start: [own[0], own[1]],
                residuals: record.outputs.iter().map(residual).collect(),
                current: record.current.then(|| [own[5], own[6]]),
            }
        };
        self.records.iter().enumerate().map(one).collect()
    }

    /// What is known of the approach speed (in the first row), then model minus reading; over their deviations.
    fn residuals(&self, index: usize, at: &[f64]) -> DMatrix<f64> {
        let (record, own) = (&self.records[index], &at[self.places[index].clone()]);
        let (time, speed) = (record.time, own[2]);
        let found = coefficients(at).velocities(
            [self.length, speed],
            [time, &record.yaw_rate, record.rudder],
            [own[0], own[1]],
        );
        let path = if own.len() > 3 { track(time, &record.heading, &found) } else { Vec::new() };
        let current = if record.current { [own[5], own[6]] } else { [0.0; 2] };
        let model = |output: MotionOutput, axis: usize, row: usize| match output {
            MotionOutput::Surge => found[row][0],
            MotionOutput::Sway => found[row][1],
            MotionOutput::Speed => found[row][0].hypot(found[row][1]),
            MotionOutput::Position => own[3 + axis] + path[row][axis] + current[axis] * (time[row] - time[0]),
        };
        let mut values = vec![0.0; time.len()];
        let expected = if record.approach.is_start { own[0] } else { record.approach.speed };
        values[0] = (speed - expected) / record.approach.deviation;
        for (output, columns) in &record.outputs {
            let weight = 1.0 / self.deviations[*output as usize];
            for (axis, readings) in columns.iter().enumerate() {
                let residual = |(row, reading): (usize, &f64)| match reading.is_finite() {
                    true => (model(*output, axis, row) - reading) * weight,
                    false => 0.0,
                };
                values.extend(readings.iter().enumerate().map(residual));
            }
        }
        DMatrix::from_vec(time.len(), values.len() / time.len(), values)
    }
}
