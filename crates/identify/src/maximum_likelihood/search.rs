//! Maximum likelihood over 1/T and the noise: Fisher scoring with the derivatives of [`super::score`], from starts over
//! all magnitudes. Sources: Fisher scoring and BFGS steps as in Nocedal and Wright (2006), Numerical Optimization,
//! chapter 6.

use nalgebra::{DMatrix, DVector};

use super::point::{Point, Record, SHARED_PARAMETERS, Start, evaluate};
use super::score::{ScoreAndInformation, score_and_information};
use crate::likelihood::NoiseVector;
use crate::likelihood::parameters::{COMPASS_INDEX, CORRELATION_INDEX, GYRO_INDEX, LEVEL_INDEX, RUDDER_INDEX};
use trial::noise_model::MomentKind;

/// Predicted decrease of −2 log L at which a search has converged: the unknowns are then about a hundredth of a
/// standard deviation from the maximum.
const MIN_DECREASE: f64 = 2e-4;

/// Predicted decrease of −2 log L at which a search over 1/T alone has converged; it must be as exact as
/// `output-error`.
const MIN_DECREASE_ALONE: f64 = 1e-12;

/// Maximum increase of −2 log of the restricted likelihood in a step.
const SLACK: f64 = 1e-2;

/// Rise of −2 log of the restricted likelihood with the size of a moment beyond which larger moments are hopeless.
const STEEP_RISE: f64 = 2.0;

/// Ridge, relative to the scaled information, for its regularity.
const RIDGE: f64 = 1e-10;

/// Maximum number of halvings of a step.
const HALVINGS: usize = 12;

/// Maximum change of a logarithm in one step.
const MAX_LOG_STEP: f64 = 2.5;

/// Scales of one record that set the ranges of the logarithms and the starts of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ranges {
    /// Duration of the record, s.
    pub duration: f64,
    /// Mean time between the headings of the record, s.
    pub spacing: f64,
    /// Root mean square residual of a fit without a moment, in units of the white part.
    pub residual: f64,
}

impl Ranges {
    /// Level of a moment that moves the heading of a ship without damping by `by` (in units of σ) over `time`.
    fn level(moment: MomentKind, by: f64, time: f64) -> f64 {
        match moment {
            MomentKind::Walk => by * (20.0 / time.powi(5)).sqrt(),
            MomentKind::White => by * (3.0 / time.powi(3)).sqrt(),
            MomentKind::None | MomentKind::OrnsteinUhlenbeck => 2.0 * by / (time * time),
        }
    }

    /// Minimum and maximum of the logarithm of an entry of the noise vector for this record.
    fn range(&self, vector: &NoiseVector, entry: usize) -> [f64; 2] {
        let Self { duration, spacing, .. } = *self;
        let ends = match entry {
            LEVEL_INDEX => [Self::level(vector.moment, 1e-3, duration), Self::level(vector.moment, 1e3, spacing)],
            CORRELATION_INDEX => [0.5 * spacing, 10.0 * duration],
            RUDDER_INDEX => [2e-3 / (duration * duration), 2e3 / (spacing * spacing)],
            COMPASS_INDEX => [0.1 * spacing, duration],
            _ => [1e-4 / duration, 1e4 / spacing],
        };
        ends.map(f64::ln)
    }

    /// Noise vector with one entry at a value, clamped to its range.
    fn with(&self, vector: &NoiseVector, entry: usize, log: f64) -> NoiseVector {
        let [low, high] = self.range(vector, entry);
        let mut moved = *vector;
        moved.log_entries[entry] = log.clamp(low, high);
        moved
    }
}

/// Search over all records.
pub(super) struct Search<'a> {
    pub records: &'a [Record],
    pub ranges: &'a [Ranges],
    pub iterations: usize,
    pub evaluations: usize,
    /// Moments without gain at any start, with their BIC.
    pub moments_without_gain: Vec<(MomentKind, f64)>,
}

/// Result of a search: maximum of the likelihood with its derivatives.
pub(super) struct Maximum {
    pub point: Point,
    pub derivatives: ScoreAndInformation,
    pub has_converged: bool,
}

impl Search<'_> {
    /// Point at a start; `None` if K/T is not positive or the likelihood not finite.
    pub fn evaluate(&mut self, start: Start) -> Option<Point> {
        self.evaluations += 1;
        evaluate(self.records, &[start]).pop()?
    }

    /// Points at starts, computed two at a time; `None` as for [`evaluate`](Self::evaluate).
    fn points(&mut self, starts: &[Start]) -> impl Iterator<Item = Option<Point>> {
        let records = self.records;
        let evaluations = &mut self.evaluations;
        starts.chunks(2).flat_map(move |pair| evaluate(records, pair)).inspect(|_| *evaluations += 1)
    }

    fn score_and_information(&mut self, point: &Point) -> Option<ScoreAndInformation> {
        let derivatives = score_and_information(self.records, point)?;
        // One filter for 1/T and one for every entry.
        self.evaluations += 1 + derivatives.gradient.len() - SHARED_PARAMETERS;
        Some(derivatives)
    }

    /// Point of the start with the lowest `height`: −2 log L, or restricted −2 log L if only the noise differs. `None`
    /// if no start has a point.
    pub fn best_start(&mut self, starts: &[Start], height: fn(&Point) -> f64) -> Option<Point> {
        self.points(starts).flatten().min_by(|a, b| height(a).total_cmp(&height(b)))
    }

    /// Point with the lowest restricted −2 log L among starts of increasing size. A rise by more than [`STEEP_RISE`]
    /// above both the start before and `without`, the value without a moment, ends the search.
    pub fn best_level(&mut self, starts: &[Start], without: Option<f64>) -> Option<Point> {
        let mut best: Option<Point> = None;
        let mut last = f64::INFINITY;
        for point in self.points(starts).flatten() {
            let is_steep = without.is_some_and(|without| point.restricted_deviance > last.max(without) + STEEP_RISE);
            last = point.restricted_deviance;
            if best.as_ref().is_none_or(|best| point.restricted_deviance < best.restricted_deviance) {
                best = Some(point);
            }
            if is_steep {
                break;
            }
        }
        best
    }

    /// Start at this 1/T with the noise vectors that `moved` makes of given vectors.
    fn start(
        &self,
        inverse_T: f64,
        vectors: &[NoiseVector],
        moved: impl Fn(&NoiseVector, &Ranges) -> NoiseVector,
    ) -> Start {
        (inverse_T, vectors.iter().zip(self.ranges).map(|(vector, ranges)| moved(vector, ranges)).collect())
    }

    /// Starts of several sizes for the moment of a kind.
    pub fn level_starts(&self, inverse_T: f64, vectors: &[NoiseVector], moment: MomentKind) -> Vec<Start> {
        let level = |by: f64| {
            self.start(inverse_T, vectors, |vector, ranges| {
                // The effect of a moment shows within a quarter of a record.
                let log = Ranges::level(moment, by * ranges.residual, 0.25 * ranges.duration).ln();
                ranges.with(&NoiseVector { moment, ..*vector }, LEVEL_INDEX, log)
            })
        };
        LEVELS.map(level).into()
    }

    /// Starts for gusts d' = −d/τ + w of standard deviation σ, with τ in shares of the record.
    ///
    /// Short gusts, τ = 0.01 and 0.05, act like a white moment of density q: σ² = q/(2τ). Long gusts, τ = 0.1 and 0.5,
    /// act like a walk whose increments have density q: σ² = q τ/2.
    pub fn gust_starts(&self, white: Option<&Point>, walk: Option<&Point>) -> Vec<Start> {
        let mut starts = Vec::new();
        for (point, shares) in [(white, [0.01, 0.05]), (walk, [0.1, 0.5])] {
            let Some(point) = point else { continue };
            starts.extend(shares.map(|share| {
                self.start(point.inverse_T, &point.vectors, |vector, ranges| {
                    let time = share * ranges.duration;
                    let factor = if vector.moment == MomentKind::White { 0.5 / time } else { 0.5 * time };
                    let gusts = NoiseVector { moment: MomentKind::OrnsteinUhlenbeck, ..*vector };
                    let gusts = ranges.with(&gusts, CORRELATION_INDEX, time.ln());
                    ranges.with(&gusts, LEVEL_INDEX, vector.log_entries[LEVEL_INDEX] + 0.5 * factor.ln())
                })
            }));
        }
        starts
    }

    /// Starts for an entry of all noise vectors: a few values over its range.
    pub fn entry_starts(&self, inverse_T: f64, vectors: &[NoiseVector], entry: usize) -> Vec<Start> {
        let start = |share: f64| {
            self.start(inverse_T, vectors, |vector, ranges| {
                let [low, high] = ranges.range(vector, entry);
                ranges.with(vector, entry, low + share * (high - low))
            })
        };
        [0.2, 0.35, 0.5, 0.65].map(start).into()
    }

    /// Maximum likelihood near a point: quasi-Newton steps (BFGS) that begin as Fisher scoring.
    ///
    /// 1/T follows the likelihood and the noise the restricted likelihood, so a step may lower the restricted
    /// likelihood by up to half of [`SLACK`]. `None` if the derivatives are not finite.
    pub fn maximise(&mut self, start: Point) -> Option<Maximum> {
        let mut point = start;
        let mut derivatives = self.score_and_information(&point)?;
        let mut free = self.free(&point, &derivatives.gradient);
        let mut inverse = inverse_information(&derivatives, &free);
        for _ in 0..self.iterations {
            let gradient = picked(&derivatives.gradient, &free);
            let Some(step) = inverse.as_ref().map(|inverse| -(inverse * &gradient)) else {
                return Some(Maximum { point, derivatives, has_converged: false });
            };
            let promise = -step.dot(&gradient);
            let settled = if free.len() > 1 { MIN_DECREASE } else { MIN_DECREASE_ALONE };
            if promise <= settled {
                return Some(Maximum { point, derivatives, has_converged: true });
            }
            let largest = step.iter().skip(1).fold(0.0_f64, |most, by| most.max(by.abs()));
            let mut share = if largest > MAX_LOG_STEP { MAX_LOG_STEP / largest } else { 1.0 };
            let lower = (0..HALVINGS).find_map(|_| {
                let moved = self.moved(&point, &free, &(&step * share));
                let next =
                    self.evaluate(moved).filter(|next| next.restricted_deviance < point.restricted_deviance + SLACK);
                if next.is_none() {
                    share *= 0.4;
                }
                next
            });
            let Some(lower) = lower else {
                // No step keeps the restricted likelihood: a maximum to rounding, if the predicted decrease is small.
                return Some(Maximum { point, derivatives, has_converged: promise < SLACK });
            };
            point = lower;
            derivatives = self.score_and_information(&point)?;
            let now = self.free(&point, &derivatives.gradient);
            if now == free && share == 1.0 {
                update(&mut inverse, &step, &(picked(&derivatives.gradient, &free) - gradient));
            } else {
                inverse = inverse_information(&derivatives, &now);
                free = now;
            }
        }
        Some(Maximum { point, derivatives, has_converged: false })
    }

    /// Indices of the free unknowns in the gradient: an entry at the edge of its range is free only if a step against
    /// the gradient points inwards.
    fn free(&self, point: &Point, gradient: &DVector<f64>) -> Vec<usize> {
        let mut free = vec![0];
        let mut index = SHARED_PARAMETERS;
        for ((record, vector), ranges) in self.records.iter().zip(&point.vectors).zip(self.ranges) {
            for entry in vector.active_entries(record.has_gyro()) {
                let [low, high] = ranges.range(vector, entry);
                let log = vector.log_entries[entry];
                let outward = (log <= low && gradient[index] > 0.0) || (log >= high && gradient[index] < 0.0);
                if !outward {
                    free.push(index);
                }
                index += 1;
            }
        }
        free
    }

    /// 1/T and noise vectors after a step of the free unknowns; the noise stays within its ranges.
    fn moved(&self, point: &Point, free: &[usize], step: &DVector<f64>) -> Start {
        let by = |index: usize| free.iter().position(|&number| number == index).map_or(0.0, |k| step[k]);
        let mut index = SHARED_PARAMETERS;
        let mut vectors = point.vectors.clone();
        for ((record, vector), ranges) in self.records.iter().zip(&mut vectors).zip(self.ranges) {
            for entry in vector.active_entries(record.has_gyro()) {
                *vector = ranges.with(vector, entry, vector.log_entries[entry] + by(index));
                index += 1;
            }
        }
        (point.inverse_T + by(0), vectors)
    }
}

/// Initial sizes of a moment, in units of the residual of a fit without a moment.
const LEVELS: [f64; 4] = [0.03, 0.2, 1.0, 5.0];

fn picked(gradient: &DVector<f64>, free: &[usize]) -> DVector<f64> {
    DVector::from_iterator(free.len(), free.iter().map(|&at| gradient[at]))
}

/// Inverse information of the free unknowns with b and b δ_r eliminated; `None` if it is singular.
fn inverse_information(derivatives: &ScoreAndInformation, free: &[usize]) -> Option<DMatrix<f64>> {
    let information = reduced(&derivatives.information, free)?;
    let scale = DVector::from_iterator(free.len(), information.diagonal().iter().map(|x| x.sqrt().recip()));
    if scale.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let count = free.len();
    let scaled = DMatrix::from_fn(count, count, |i, j| information[(i, j)] * scale[i] * scale[j]);
    let inverse = (scaled + DMatrix::identity(count, count) * RIDGE).cholesky()?.inverse();
    Some(DMatrix::from_fn(count, count, |i, j| inverse[(i, j)] * scale[i] * scale[j]))
}

/// Updates an inverse curvature with the change of the slope over a step (Broyden, Fletcher, Goldfarb and Shanno 1970).
fn update(inverse: &mut Option<DMatrix<f64>>, step: &DVector<f64>, change: &DVector<f64>) {
    let Some(matrix) = inverse else { return };
    let along = step.dot(change);
    let bent = &*matrix * change;
    // Without positive curvature along the step the update is skipped.
    if along <= 1e-3 * change.dot(&bent).sqrt() * along.abs().sqrt() || along <= 0.0 {
        return;
    }
    let outer = step * bent.transpose();
    *matrix +=
        step * step.transpose() * ((1.0 + change.dot(&bent) / along) / along) - (&outer + outer.transpose()) / along;
}

/// Information of selected unknowns with b and b δ_r eliminated.
fn reduced(information: &DMatrix<f64>, selected: &[usize]) -> Option<DMatrix<f64>> {
    let pick = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| information[(rows[i], columns[j])])
    };
    let steering = [1, 2];
    let cross = pick(selected, &steering);
    let inner = pick(&steering, &steering).cholesky()?;
    Some(pick(selected, selected) - &cross * inner.solve(&cross.transpose()))
}

/// Noise vector with the rate-gyro error from which a search begins: σ_r/σ = 1/(e √`spacing`).
pub(super) fn gyro_start(ranges: &Ranges, vector: &NoiseVector) -> NoiseVector {
    ranges.with(vector, GYRO_INDEX, -0.5 * ranges.spacing.max(1e-3).ln() - 1.0)
}
