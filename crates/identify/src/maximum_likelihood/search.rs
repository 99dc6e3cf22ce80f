//! The largest likelihood over 1/T and the noise: Fisher scoring with exact slopes from starts of every size.

use nalgebra::{DMatrix, DVector};

use super::point::{Point, Record, SHARED, evaluate};
use super::score::{Linearised, linearise};
use crate::likelihood::NoiseVector;
use crate::likelihood::parameters::{COMPASS, CORRELATION, GYRO, LEVEL, RUDDER};
use trial::noise_model::Moment;

/// Steps end when they promise less than this in −log L: a hundredth of a standard deviation of the noise. Where there
/// is none to find, 1/T alone has to be as exact as that of `output-error`.
const PROMISE: f64 = 2e-4;
const PROMISE_ALONE: f64 = 1e-12;

/// By how much a step may raise −2 log of the restricted likelihood.
const SLACK: f64 = 1e-2;

/// Share of the information that keeps it regular.
const RIDGE: f64 = 1e-10;

/// Halvings of a step.
const HALVINGS: usize = 12;

/// Largest change of a logarithm in one step.
const LONGEST_STEP: f64 = 2.5;

/// Ranges of the logarithms of one record, and where the search begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ranges {
    /// Length of the record and usual time between its readings, s.
    pub duration: f64,
    pub spacing: f64,
    /// Root mean square residual of a fit without a moment, in units of what of it is white.
    pub residual: f64,
}

impl Ranges {
    /// The level of a moment that moves the heading of a ship without damping by `by` (in units of σ) over `time`.
    fn level(moment: Moment, by: f64, time: f64) -> f64 {
        match moment {
            Moment::Walk => by * (20.0 / time.powi(5)).sqrt(),
            Moment::White => by * (3.0 / time.powi(3)).sqrt(),
            Moment::None | Moment::OrnsteinUhlenbeck => 2.0 * by / (time * time),
        }
    }

    /// Smallest and largest logarithm of an entry.
    fn of(&self, place: &NoiseVector, entry: usize) -> [f64; 2] {
        let Self { duration, spacing, .. } = *self;
        let ends = match entry {
            LEVEL => [Self::level(place.moment, 1e-3, duration), Self::level(place.moment, 1e3, spacing)],
            CORRELATION => [0.5 * spacing, 10.0 * duration],
            RUDDER => [2e-3 / (duration * duration), 2e3 / (spacing * spacing)],
            COMPASS => [0.1 * spacing, duration],
            _ => [1e-4 / duration, 1e4 / spacing],
        };
        ends.map(f64::ln)
    }

    /// The same place with one entry at a value, inside its range.
    fn with(&self, place: &NoiseVector, entry: usize, log: f64) -> NoiseVector {
        let [low, high] = self.of(place, entry);
        let mut moved = *place;
        moved.log[entry] = log.clamp(low, high);
        moved
    }
}

/// Where a search begins: 1/T, and the noise of every record.
pub(super) type Start = (f64, Vec<NoiseVector>);

/// A search over all records.
pub(super) struct Search<'a> {
    pub records: &'a [Record],
    pub ranges: &'a [Ranges],
    pub iterations: usize,
    pub evaluations: usize,
    /// Moments that no start showed, with what their BIC would be.
    pub unseen: Vec<(Moment, f64)>,
}

/// The end of a search.
pub(super) struct Maximum {
    pub point: Point,
    pub linearised: Linearised,
    pub converged: bool,
}

impl Search<'_> {
    fn evaluate(&mut self, inverse_time: f64, places: &[NoiseVector]) -> Option<Point> {
        self.evaluations += 1;
        evaluate(self.records, inverse_time, places)
    }

    fn linearise(&mut self, point: &Point) -> Option<Linearised> {
        let found = linearise(self.records, point)?;
        // One filter for 1/T and one for every entry.
        self.evaluations += 1 + found.score.len() - SHARED;
        Some(found)
    }

    /// The start with the lowest −2 log L, or restricted one where only the noise differs.
    pub fn best(&mut self, starts: Vec<Start>, height: fn(&Point) -> f64) -> Option<Point> {
        let points = starts.iter().filter_map(|(a, places)| self.evaluate(*a, places));
        points.min_by(|one, other| height(one).total_cmp(&height(other)))
    }

    /// A start at the places that `moved` makes of some places.
    fn start(
        &self,
        inverse_time: f64,
        places: &[NoiseVector],
        moved: impl Fn(&NoiseVector, &Ranges) -> NoiseVector,
    ) -> Start {
        (inverse_time, places.iter().zip(self.ranges).map(|(place, ranges)| moved(place, ranges)).collect())
    }

    /// Starts of several sizes for the moment of a kind.
    pub fn levels(&self, inverse_time: f64, places: &[NoiseVector], moment: Moment) -> Vec<Start> {
        let level = |by: f64| {
            self.start(inverse_time, places, |place, ranges| {
                // A record shows what a moment does in a quarter of it.
                let log = Ranges::level(moment, by * ranges.residual, 0.25 * ranges.duration).ln();
                ranges.with(&NoiseVector { moment, ..*place }, LEVEL, log)
            })
        };
        LEVELS.map(level).into()
    }

    /// Starts for gusts: short ones that act like a white moment, and long ones like a walk.
    pub fn gusts(&self, white: Option<&Point>, walk: Option<&Point>) -> Vec<Start> {
        let mut starts = Vec::new();
        for (point, shares) in [(white, [0.01, 0.05]), (walk, [0.1, 0.5])] {
            let Some(point) = point else { continue };
            starts.extend(shares.map(|share| {
                self.start(point.inverse_time, &point.places, |place, ranges| {
                    let time = share * ranges.duration;
                    let factor = if place.moment == Moment::White { 0.5 / time } else { 0.5 * time };
                    let gusts = NoiseVector { moment: Moment::OrnsteinUhlenbeck, ..*place };
                    let gusts = ranges.with(&gusts, CORRELATION, time.ln());
                    ranges.with(&gusts, LEVEL, place.log[LEVEL] + 0.5 * factor.ln())
                })
            }));
        }
        starts
    }

    /// Starts for an entry of all places: a few sizes over its range.
    pub fn spread(&self, inverse_time: f64, places: &[NoiseVector], entry: usize) -> Vec<Start> {
        let start = |share: f64| {
            self.start(inverse_time, places, |place, ranges| {
                let [low, high] = ranges.of(place, entry);
                ranges.with(place, entry, low + share * (high - low))
            })
        };
        [0.2, 0.35, 0.5, 0.65].map(start).into()
    }

    /// The largest likelihood near a point: quasi-Newton steps (BFGS) with exact slopes that begin as Fisher scoring.
    ///
    /// 1/T follows the likelihood and the noise the restricted one, so steps need not lower the latter to the last
    /// digit.
    pub fn maximise(&mut self, start: Point) -> Option<Maximum> {
        let mut point = start;
        let mut linearised = self.linearise(&point)?;
        let mut free = self.free(&point, &linearised.score);
        let mut inverse = inverse_information(&linearised, &free);
        for _ in 0..self.iterations {
            let score = picked(&linearised.score, &free);
            let Some(step) = inverse.as_ref().map(|inverse| -(inverse * &score)) else {
                return Some(Maximum { point, linearised, converged: false });
            };
            let promise = -step.dot(&score);
            let settled = if free.len() > 1 { PROMISE } else { PROMISE_ALONE };
            if promise <= settled {
                return Some(Maximum { point, linearised, converged: true });
            }
            let longest = step.iter().skip(1).fold(0.0_f64, |most, by| most.max(by.abs()));
            let mut share = if longest > LONGEST_STEP { LONGEST_STEP / longest } else { 1.0 };
            let lower = (0..HALVINGS).find_map(|_| {
                let (inverse_time, places) = self.moved(&point, &free, &(&step * share));
                let next =
                    self.evaluate(inverse_time, &places).filter(|next| next.restricted < point.restricted + SLACK);
                if next.is_none() {
                    share *= 0.4;
                }
                next
            });
            let Some(lower) = lower else {
                // No step downhill is left: a minimum to rounding.
                return Some(Maximum { point, linearised, converged: promise < SLACK });
            };
            point = lower;
            linearised = self.linearise(&point)?;
            let now = self.free(&point, &linearised.score);
            if now == free && share == 1.0 {
                learn(&mut inverse, &step, &(picked(&linearised.score, &free) - score));
            } else {
                inverse = inverse_information(&linearised, &now);
                free = now;
            }
        }
        Some(Maximum { point, linearised, converged: false })
    }

    /// Where in the score the unknowns are that may move: an entry at the end of its range only if it leads back.
    fn free(&self, point: &Point, score: &DVector<f64>) -> Vec<usize> {
        let mut free = vec![0];
        let mut at = SHARED;
        for ((record, place), ranges) in self.records.iter().zip(&point.places).zip(self.ranges) {
            for entry in place.entries(record.has_gyro()) {
                let [low, high] = ranges.of(place, entry);
                let log = place.log[entry];
                let outward = (log <= low && score[at] > 0.0) || (log >= high && score[at] < 0.0);
                if !outward {
                    free.push(at);
                }
                at += 1;
            }
        }
        free
    }

    /// The place a step away.
    fn moved(&self, point: &Point, free: &[usize], step: &DVector<f64>) -> Start {
        let by = |at: usize| free.iter().position(|&place| place == at).map_or(0.0, |k| step[k]);
        let mut at = SHARED;
        let mut places = point.places.clone();
        for ((record, place), ranges) in self.records.iter().zip(&mut places).zip(self.ranges) {
            for entry in place.entries(record.has_gyro()) {
                *place = ranges.with(place, entry, place.log[entry] + by(at));
                at += 1;
            }
        }
        (point.inverse_time + by(0), places)
    }
}

/// Sizes of a moment that are tried, in units of what a fit without one leaves.
const LEVELS: [f64; 4] = [0.03, 0.2, 1.0, 5.0];

fn picked(score: &DVector<f64>, free: &[usize]) -> DVector<f64> {
    DVector::from_iterator(free.len(), free.iter().map(|&at| score[at]))
}

/// Inverse information of the free unknowns with b and b δ_r following.
fn inverse_information(linearised: &Linearised, free: &[usize]) -> Option<DMatrix<f64>> {
    let information = reduced(&linearised.information, free)?;
    let scale = DVector::from_iterator(free.len(), information.diagonal().iter().map(|x| x.sqrt().recip()));
    if scale.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let count = free.len();
    let scaled = DMatrix::from_fn(count, count, |i, j| information[(i, j)] * scale[i] * scale[j]);
    let inverse = (scaled + DMatrix::identity(count, count) * RIDGE).cholesky()?.inverse();
    Some(DMatrix::from_fn(count, count, |i, j| inverse[(i, j)] * scale[i] * scale[j]))
}

/// Teaches an inverse curvature what a step has done to the slope (Broyden, Fletcher, Goldfarb and Shanno 1970).
fn learn(inverse: &mut Option<DMatrix<f64>>, step: &DVector<f64>, change: &DVector<f64>) {
    let Some(matrix) = inverse else { return };
    let along = step.dot(change);
    let bent = &*matrix * change;
    // A slope that did not rise along the step says nothing of a minimum.
    if along <= 1e-3 * change.dot(&bent).sqrt() * along.abs().sqrt() || along <= 0.0 {
        return;
    }
    let outer = step * bent.transpose();
    *matrix +=
        step * step.transpose() * ((1.0 + change.dot(&bent) / along) / along) - (&outer + outer.transpose()) / along;
}

/// Information of some unknowns when b and b δ_r follow them.
fn reduced(information: &DMatrix<f64>, wanted: &[usize]) -> Option<DMatrix<f64>> {
    let pick = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| information[(rows[i], columns[j])])
    };
    let steering = [1, 2];
    let cross = pick(wanted, &steering);
    let inner = pick(&steering, &steering).cholesky()?;
    Some(pick(wanted, wanted) - &cross * inner.solve(&cross.transpose()))
}

/// The logarithm of the gyro error with which a search begins.
pub(super) fn gyro_start(ranges: &Ranges, place: &NoiseVector) -> NoiseVector {
    ranges.with(place, GYRO, -0.5 * ranges.spacing.max(1e-3).ln() - 1.0)
}
