//! The search for the parameters and initial states that bring the whitened replay nearest to the records
//! (Levenberg–Marquardt; Moré 1978).

use lanes::column::dot;
use nalgebra::DVector;

use super::linear::{Columns, Normal, log_variance, solve, whiten};
use super::linearised::Linearised;
use super::memory::question;
use super::outcome::Fit;
use super::problem::Problem;
use crate::index::ThetaPlace;
use crate::noise::{Colour, Whitener};
use crate::structure::{Entry, Structure, fitted};

/// A step that lowers RSS by less than this many mean squares ends the search: far below what any test could see.
const NEGLIGIBLE: f64 = 0.02;

/// Most steps.
const MOST_STEPS: usize = 25;

/// Damping of the first step, which leaves a Gauss–Newton step as it is.
const SMALLEST_DAMPING: f64 = 1e-9;

/// A step whose gain is further from what was promised than this share calls for new sensitivities.
const SURPRISE: f64 = 0.1;

/// Up to this share the old sensitivities are mended by what the step has taught (Broyden 1965).
const LESSON: f64 = 0.7;

/// Dampings of one step that are tried before it counts as a minimum.
const MOST_DAMPINGS: usize = 9;

/// Where a search stands.
struct Point {
    theta: Vec<f64>,
    initial: Vec<[f64; 2]>,
    /// Measured less replayed headings, rad.
    residual: Vec<Vec<f64>>,
    /// The same, whitened.
    white: Vec<Vec<f64>>,
    rss: f64,
}

impl Point {
    fn new(theta: Vec<f64>, initial: Vec<[f64; 2]>, residual: Vec<Vec<f64>>, whiteners: &[Whitener]) -> Self {
        let white = whiten(&residual, whiteners);
        let rss = white.iter().map(|white| dot(white, white)).sum();
        Self { theta, initial, residual, white, rss }
    }

    /// The unknowns that lead from here to another point.
    fn step_to(&self, other: &Self, fitted: &[ThetaPlace]) -> DVector<f64> {
        let parameters = fitted.iter().map(|&ThetaPlace(k)| other.theta[k] - self.theta[k]);
        let states = self.initial.iter().zip(&other.initial).flat_map(|(from, to)| [to[0] - from[0], to[1] - from[1]]);
        DVector::from_vec(parameters.chain(states).collect())
    }
}

impl Problem {
    /// Fits a structure from a start, under one colour of noise.
    pub fn fit(&self, structure: &Structure, theta: &[f64], initial: &[[f64; 2]], colour: &Colour) -> Fit {
        self.memory.once(question(structure, theta, initial, colour, None), || {
            let theta = self.inside(structure, theta);
            let whiteners = self.whiteners(colour);
            let linear = self.linear(structure, &theta, initial);
            let columns = linear.whitened(&whiteners);
            let lost = self.lost(colour, || self.under_white(&linear), &columns);
            let start = Point::new(theta, initial.to_vec(), linear.into_residual(), &whiteners);
            self.search(structure, start, (columns, true), &whiteners, (colour, lost))
        })
    }

    /// Fits a fitted model with one more term from a start of it; the sensitivities of the model are known.
    pub fn fit_with(&self, structure: &Structure, start: &[f64], from: &Fit, known: &Linearised) -> Fit {
        self.memory.once(question(structure, &from.theta, &from.initial, &from.colour, Some(start)), || {
            let theta = [from.theta.as_slice(), start].concat();
            let (_, tangents) = self.columns_of_last(structure, &theta, &from.initial, &known.headings);
            let mut columns = known.columns.clone();
            let at = structure.free_count() - tangents.len();
            columns.insert(at, &tangents, &known.whiteners);
            let plain = || {
                let mut plain = known.plain.clone();
                plain.insert(at, &tangents, &self.whiteners(&Colour::WHITE));
                plain
            };
            let lost = self.lost(&from.colour, plain, &columns);
            let theta = self.inside(structure, &theta);
            let residual = self.residual(structure, &theta, &from.initial);
            let start = Point::new(theta, from.initial.clone(), residual, &known.whiteners);
            self.search(structure, start, (columns, false), &known.whiteners, (&from.colour, lost))
        })
    }

    fn inside(&self, structure: &Structure, theta: &[f64]) -> Vec<f64> {
        let entries = self.entries(structure);
        theta.iter().zip(&entries).map(|(x, entry)| x.clamp(entry.lowest, entry.highest)).collect()
    }

    /// Searches for the minimum from a point with whitened sensitivities, which are fresh or those of a point near by,
    /// under a noise that takes so much from the price of the unknowns.
    ///
    /// Sensitivities are computed anew only when a step did not do what they promised: most terms change the response
    /// so little that one set serves the whole search.
    fn search(
        &self,
        structure: &Structure,
        mut now: Point,
        known: (Columns, bool),
        whiteners: &[Whitener],
        noise: (&Colour, f64),
    ) -> Fit {
        let entries = self.entries(structure);
        let mut damping = SMALLEST_DAMPING;
        let negligible = |rss: f64| NEGLIGIBLE * rss / self.observations() as f64;
        let fitted = fitted(&entries);
        // Whitened columns; `None` when they have to be computed anew.
        let mut sensitivities = Some(known);
        for _ in 0..MOST_STEPS {
            if !now.rss.is_finite() {
                break;
            }
            let (mut columns, fresh) = sensitivities
                .take()
                .unwrap_or_else(|| (self.linear(structure, &now.theta, &now.initial).whitened(whiteners), true));
            let normal = columns.normal(&now.white);
            let mut improved = None;
            for _ in 0..if fresh { MOST_DAMPINGS } else { 1 } {
                let Some((step, promised)) = self.step(&normal, damping, &now.theta, &entries, &fitted) else {
                    damping = 10.0 * damping.max(1e-7);
                    continue;
                };
                if promised < negligible(now.rss) && fresh {
                    break;
                }
                let mut theta = now.theta.clone();
                for (place, &ThetaPlace(k)) in fitted.iter().enumerate() {
                    theta[k] = (theta[k] + step[place]).clamp(entries[k].lowest, entries[k].highest);
                }
                let mut initial = now.initial.clone();
                for (record, initial) in initial.iter_mut().enumerate() {
                    initial[0] += step[fitted.len() + 2 * record];
                    initial[1] += step[fitted.len() + 2 * record + 1];
                }
                let residual = self.residual(structure, &theta, &initial);
                let next = Point::new(theta, initial, residual, whiteners);
                if next.rss < now.rss {
                    improved = Some((next, promised));
                    damping = if damping <= 1e-6 { SMALLEST_DAMPING } else { 0.1 * damping };
                    break;
                }
                damping = (damping * 8.0).max(1e-4);
            }
            let Some((next, promised)) = improved else {
                if fresh {
                    break;
                } else {
                    continue;
                };
            };
            let gain = now.rss - next.rss;
            let surprise = (gain - promised).abs() / promised;
            let before = std::mem::replace(&mut now, next);
            if damping <= 1e-6 && surprise < LESSON {
                if surprise < SURPRISE && promised < negligible(before.rss) {
                    break;
                }
                if surprise >= SURPRISE {
                    columns.learn(&before.step_to(&now, &fitted), &before.white, &now.white);
                }
                sensitivities = Some((columns, false));
            } else if gain < negligible(before.rss) && fresh {
                break;
            }
        }
        self.finished(structure, now, whiteners, noise)
    }

    /// A damped step and how much it lowers RSS if the heading is linear; parameters that would leave their range go to
    /// its end.
    fn step(
        &self,
        normal: &Normal,
        damping: f64,
        theta: &[f64],
        entries: &[Entry],
        fitted: &[ThetaPlace],
    ) -> Option<(DVector<f64>, f64)> {
        let mut fixed: Vec<Option<f64>> = vec![None; normal.gradient.len()];
        for _ in 0..fitted.len() + 1 {
            let mut matrix = normal.matrix.clone();
            let mut gradient = normal.gradient.clone();
            for (place, &own) in fixed.iter().enumerate().filter_map(|(place, own)| Some((place, own.as_ref()?))) {
                gradient.axpy(-own, &normal.matrix.column(place), 1.0);
            }
            for place in (0..fixed.len()).filter(|&place| fixed[place].is_some()) {
                matrix.row_mut(place).fill(0.0);
                matrix.column_mut(place).fill(0.0);
                gradient[place] = 0.0;
            }
            let mut step = solve(&matrix, &gradient, damping)?;
            for (place, own) in fixed.iter().enumerate() {
                step[place] = own.unwrap_or(step[place]);
            }
            let beyond: Vec<(usize, f64)> = (0..fitted.len())
                .filter(|&place| fixed[place].is_none())
                .filter_map(|place| {
                    let ThetaPlace(at) = fitted[place];
                    let (x, entry) = (theta[at], &entries[at]);
                    let inside = (x + step[place]).clamp(entry.lowest, entry.highest);
                    (inside != x + step[place]).then_some((place, inside - x))
                })
                .collect();
            if beyond.is_empty() {
                let promised = 2.0 * step.dot(&normal.gradient) - (&normal.matrix * &step).dot(&step);
                return Some((step, promised));
            }
            for (place, own) in beyond {
                fixed[place] = Some(own);
            }
        }
        None
    }

    fn finished(&self, structure: &Structure, point: Point, whiteners: &[Whitener], noise: (&Colour, f64)) -> Fit {
        let (n, (colour, lost)) = (self.observations() as f64, noise);
        let freedom = structure.free_count() + 2 * self.records.len() + colour.freedom() + 1;
        let deviance = self.deviance(point.rss, log_variance(whiteners));
        let Point { theta, initial, residual, rss, .. } = point;
        let bic = deviance + freedom as f64 * n.ln() + lost;
        Fit { theta, initial, colour: *colour, residual, rss, deviance, freedom, lost, bic }
    }
}
