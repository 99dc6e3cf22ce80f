//! The coefficients from records, by output error.

use nalgebra::{DMatrix, DVector};
use trial::Trial;

use super::coefficients::{BOUNDS, COEFFICIENTS, PlanarCoefficients, SYMBOLS, TYPICAL};
use super::error::MotionError;
use super::model::{Drive, velocities};
use super::planar::{MotionRecordFit, Planar, Residual, pooled};
use super::record::{MotionOutput, MotionRecord, median, range};
use super::search::{NormalEquations, ResidualColumn, Squares, determined, free, minimise, sandwich};

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
/// cannot be told, rows are further apart than two ship lengths, the search does not converge or leaves a coefficient
/// open. Records without any output are left out.
pub fn fit(trials: &[Trial], length: f64) -> Result<Planar, MotionError> {
    if !(length.is_finite() && length > 0.0) {
        return Err(MotionError::NotPositive { quantity: "length", value: length });
    }
    let with_output = trials.iter().map(|trial| MotionRecord::of(trial, length)).collect::<Result<Vec<_>, _>>()?;
    let records: Vec<MotionRecord> = with_output.into_iter().flatten().collect();
    if records.is_empty() {
        return Err(MotionError::NoOutput { records: trials.len() });
    }
    let found = records.iter().map(|record| range(&record.heading)).fold(0.0, f64::max);
    if found < TURNS {
        return Err(MotionError::NotExcited { found, needed: TURNS });
    }
    let speed = records.iter().map(|record| record.approach.speed);
    let speed = median(speed).expect("there are records");
    let scale = |output: MotionOutput| if output == MotionOutput::Position { length } else { speed };
    let mut problem = PlanarSquares::new(records, length, MotionOutput::ALL.map(|output| FIRST_SHARE * scale(output)));
    let mut at = problem.start();
    for round in 0..=REWEIGHTED {
        at = minimise(&problem, at).map_err(|iterations| MotionError::NoConvergence { iterations })?;
        if round < REWEIGHTED {
            let residuals = problem.summary(&at);
            problem.deviations = MotionOutput::ALL
                .map(|output| pooled(&residuals, output).unwrap_or(0.0).max(LEAST_SHARE * scale(output)));
        }
    }
    let covariance = problem.covariance(&at)?;
    let records = problem.summary(&at);
    let approach_speed = median(records.iter().map(|record| record.approach_speed)).expect("there are records");
    Ok(Planar { coefficients: problem.coefficients(at.as_slice()), length, approach_speed, covariance, records })
}

/// Unknowns of one record after the coefficients: surge, sway, approach speed, and of positions north, east, current.
fn unknowns(record: &MotionRecord) -> usize {
    let position = record.outputs.iter().any(|(output, _)| *output == MotionOutput::Position);
    3 + 2 * usize::from(position) + 2 * usize::from(record.current)
}

/// All records with the weights of their outputs.
struct PlanarSquares<'a> {
    records: Vec<MotionRecord<'a>>,
    /// First unknown of every record.
    places: Vec<usize>,
    unknowns: usize,
    length: f64,
    /// In the order of [`MotionOutput::ALL`].
    deviations: [f64; 4],
}

impl<'a> PlanarSquares<'a> {
    fn new(records: Vec<MotionRecord<'a>>, length: f64, deviations: [f64; 4]) -> Self {
        let mut unknowns_so_far = COEFFICIENTS;
        let mut places = Vec::new();
        for record in &records {
            places.push(unknowns_so_far);
            unknowns_so_far += unknowns(record);
        }
        Self { records, places, unknowns: unknowns_so_far, length, deviations }
    }

    fn start(&self) -> DVector<f64> {
        let mut at = DVector::zeros(self.unknowns);
        at.as_mut_slice()[..COEFFICIENTS].copy_from_slice(&TYPICAL.to_array());
        for (record, &place) in self.records.iter().zip(&self.places) {
            let own = [record.start[0], record.start[1], record.approach.speed];
            at.as_mut_slice()[place..place + 3].copy_from_slice(&own);
            let positions = record.outputs.iter().filter(|(output, _)| *output == MotionOutput::Position);
            for (axis, column) in positions.flat_map(|(_, columns)| columns).enumerate() {
                at[place + 3 + axis] = column.iter().copied().find(|value| value.is_finite()).unwrap_or(0.0);
            }
        }
        at
    }

    fn coefficients(&self, at: &[f64]) -> PlanarCoefficients {
        PlanarCoefficients::from_array(std::array::from_fn(|i| at[i]))
    }

    fn own<'b>(&self, index: usize, at: &'b [f64]) -> &'b [f64] {
        &at[self.places[index]..self.places[index] + unknowns(&self.records[index])]
    }

    fn summary(&self, at: &DVector<f64>) -> Vec<MotionRecordFit> {
        let one = |(index, record): (usize, &MotionRecord)| {
            let own = self.own(index, at.as_slice());
            let columns = self.residuals(index, at.as_slice());
            let mut columns = columns[1..].iter();
            let residuals = record.outputs.iter().map(|(output, readings)| {
                let square: f64 = columns.by_ref().take(readings.len()).flatten().map(|x| x * x).sum();
                let count = readings.iter().flat_map(|column| column.iter()).filter(|x| x.is_finite()).count();
                let rms = (square / count.max(1) as f64).sqrt() * self.deviations[*output as usize];
                Residual { output: *output, readings: count, rms }
            });
            MotionRecordFit {
                name: record.name.to_owned(),
                approach_speed: own[2],
                start: [own[0], own[1]],
                residuals: residuals.collect(),
                current: record.current.then(|| [own[5], own[6]]),
            }
        };
        self.records.iter().enumerate().map(one).collect()
    }

    /// A⁻¹ S A⁻¹ of the coefficients, with A the normal matrix and S the long-run covariance of the scores.
    fn covariance(&self, at: &DVector<f64>) -> Result<[[f64; COEFFICIENTS]; COEFFICIENTS], MotionError> {
        let NormalEquations { normal, gradient, .. } = self.local(at);
        let free = free(self, at, &gradient);
        let (scale, eigen) = determined(&normal, &free, |unknown| SYMBOLS.get(unknown).copied())?;
        let inverse = DMatrix::from_fn(free.len(), free.len(), |i, j| {
            let sum =
                (0..free.len()).map(|k| eigen.eigenvectors[(i, k)] * eigen.eigenvectors[(j, k)] / eigen.eigenvalues[k]);
            sum.sum::<f64>() / (scale[i] * scale[j])
        });
        let all = sandwich(&inverse, &self.long_run(at, |_| true), &free);
        Ok(std::array::from_fn(|i| std::array::from_fn(|j| all[(i, j)])))
    }
}

impl Squares for PlanarSquares<'_> {
    const WIDTH: usize = 1;

    fn unknowns(&self) -> usize {
        self.unknowns
    }

    fn groups(&self) -> usize {
        self.records.len()
    }

    /// What is known of the approach speed (in the first row), then model minus reading.
    fn residuals(&self, index: usize, at: &[f64]) -> Vec<ResidualColumn> {
        let (record, own, coefficients) = (&self.records[index], self.own(index, at), &self.coefficients(at));
        let drive = Drive { time: record.time, yaw_rate: &record.yaw_rate, rudder: record.rudder };
        let speed = own[2];
        let found = velocities(coefficients, [self.length, speed], drive, [own[0], own[1]]);
        let mut approach = vec![0.0; record.time.len()];
        let expected = if record.approach.is_start { own[0] } else { record.approach.speed };
        approach[0] = (speed - expected) / record.approach.deviation;
        let mut columns = vec![approach];
        for (output, readings) in &record.outputs {
            let weight = 1.0 / self.deviations[*output as usize];
            let compare = |readings: &[f64], model: &dyn Fn(usize) -> f64| -> ResidualColumn {
                let residual = |(row, reading): (usize, &f64)| {
                    if reading.is_finite() { (model(row) - reading) * weight } else { 0.0 }
                };
                readings.iter().enumerate().map(residual).collect()
            };
            match output {
                MotionOutput::Surge => columns.push(compare(readings[0], &|row| found[row][0])),
                MotionOutput::Sway => columns.push(compare(readings[0], &|row| found[row][1])),
                MotionOutput::Speed => columns.push(compare(readings[0], &|row| found[row][0].hypot(found[row][1]))),
                MotionOutput::Position => {
                    let current = if record.current { [own[5], own[6]] } else { [0.0; 2] };
                    let (surge, sway): (Vec<f64>, Vec<f64>) = found.iter().map(|[u, v]| (u, v)).unzip();
                    let path = super::circle::track(record.time, &record.heading, &surge, &sway);
                    for axis in 0..2 {
                        let place = |row: usize| {
                            own[3 + axis] + path[row][axis] + current[axis] * (record.time[row] - record.time[0])
                        };
                        columns.push(compare(readings[axis], &place));
                    }
                }
            }
        }
        columns
    }

    /// Central differences.
    fn derivatives(&self, index: usize, at: &[f64]) -> (Vec<ResidualColumn>, Vec<Vec<ResidualColumn>>) {
        let speed = self.records[index].approach.speed;
        let by = |unknown: usize| {
            let place = self.global(index, unknown);
            let step = match unknown.checked_sub(COEFFICIENTS) {
                None => 1e-6 * TYPICAL.to_array()[unknown].max(at[unknown].abs()),
                Some(0..=2) => 1e-6 * speed,
                Some(3 | 4) => 1e-4 * self.length,
                Some(_) => 1e-4 * speed,
            };
            let side = |sign: f64| {
                let mut moved = at.to_vec();
                moved[place] += sign * step;
                // At a bound of a coefficient the difference is one-sided.
                let width = BOUNDS.get(unknown).map_or(step, |[least, most]| {
                    moved[place] = moved[place].clamp(*least, *most);
                    (moved[place] - at[place]).abs()
                });
                (self.residuals(index, &moved), width)
            };
            let ((above, up), (below, down)) = (side(1.0), side(-1.0));
            let slope = |(above, below): (&ResidualColumn, &ResidualColumn)| -> ResidualColumn {
                above.iter().zip(below).map(|(above, below)| (above - below) / (up + down)).collect()
            };
            above.iter().zip(&below).map(slope).collect::<Vec<ResidualColumn>>()
        };
        let slopes = (0..COEFFICIENTS + unknowns(&self.records[index])).map(by).collect();
        (self.residuals(index, at), slopes)
    }

    fn global(&self, index: usize, unknown: usize) -> usize {
        unknown.checked_sub(COEFFICIENTS).map_or(unknown, |place| self.places[index] + place)
    }

    fn bounds(&self, unknown: usize) -> [f64; 2] {
        if let Some(bounds) = BOUNDS.get(unknown) {
            return *bounds;
        }
        match self.places.iter().position(|place| place + 2 == unknown) {
            Some(record) => [0.5, 2.0].map(|share| share * self.records[record].approach.speed),
            None => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }
}
