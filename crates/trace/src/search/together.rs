//! Effects that pay only together: all sets of a few candidates, judged at once by the sensitivities of one fit.
//!
//! To first order the heading is linear in the parameters of every candidate. With base and candidates whitened for
//! one colour of noise, −2 log L of any set of them follows from products of columns that are computed once, so
//! thousands of sets under dozens of colours cost less than one replay each. Only the few sets of lowest BIC are
//! fitted.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::models::{Model, Search};
use crate::fit::{Column, Linearised, Normal, log_determinant, log_variance, prior_and};
use crate::index::CandidatePlace;
use crate::noise::{Colour, Wander, Whitener};

/// Most effects of a set.
const MOST: usize = 3;

/// Most effects of a set that has to promise something before a search begins.
const PROMISED: usize = 2;

/// Levels of a random moment that are tried, over the decades a record can tell apart; the few that lead are refined.
const LEVELS: [f64; 9] = [1e-2, 1.0, 1e1, 1e2, 1e3, 1e4, 1e6, 1e8, 1e10];

/// Sets that are fitted.
const FITTED: usize = 6;

/// A candidate with the place of its columns among those of all.
struct Block {
    place: CandidatePlace,
    start: Vec<f64>,
    columns: std::ops::Range<usize>,
    freedom: usize,
}

/// Candidates with their columns, and the normal equations under every colour.
struct Promises {
    blocks: Vec<Block>,
    reduced: Vec<Reduced>,
    /// What the records would tell under white noise.
    plain: Information,
}

/// Information of some normal equations.
struct Information {
    /// Logarithm of its determinant for the unknowns of the model.
    of_model: f64,
    /// What is left of it for the columns of candidates.
    rest: DMatrix<f64>,
}

impl Information {
    /// `None` where the first `own` unknowns cannot be told apart.
    fn new(matrix: &DMatrix<f64>, own: usize) -> Option<Self> {
        let more = matrix.nrows() - own;
        let inner = matrix.view((0, 0), (own, own)).into_owned();
        let cross = matrix.view((0, own), (own, more)).into_owned();
        let shared = regular(inner.clone()).cholesky()?.solve(&cross);
        let rest = matrix.view((own, own), (more, more)) - cross.tr_mul(&shared);
        Some(Self { of_model: log_determinant(&inner), rest })
    }

    /// Logarithm of the determinant for the unknowns of the model and some columns.
    fn of(&self, columns: &[usize]) -> f64 {
        let n = columns.len();
        self.of_model + log_determinant(&DMatrix::from_fn(n, n, |i, j| self.rest[(columns[i], columns[j])]))
    }
}

/// A matrix that can be factored although some of its columns are parallel.
fn regular(mut matrix: DMatrix<f64>) -> DMatrix<f64> {
    for k in 0..matrix.nrows() {
        matrix[(k, k)] += 1e-11 * matrix[(k, k)] + f64::MIN_POSITIVE;
    }
    matrix
}

/// What is left of the normal equations when the unknowns of the model have taken their share.
struct Reduced {
    matrix: DMatrix<f64>,
    /// What prior and records tell under this colour.
    information: Information,
    gradient: DVector<f64>,
    rss: f64,
    log_variance: f64,
    colour: Colour,
}

impl Reduced {
    /// Projects the first `own` unknowns out; `None` where they cannot be told apart.
    fn new(normal: &Normal, information: Information, own: usize, log_variance: f64, colour: Colour) -> Option<Self> {
        let all = normal.matrix.nrows();
        let more = all - own;
        let factor = regular(normal.matrix.view((0, 0), (own, own)).into_owned()).cholesky()?;
        let cross = normal.matrix.view((0, own), (own, more)).into_owned();
        let gradient = normal.gradient.rows(0, own).into_owned();
        let (shared, explained) = (factor.solve(&cross), factor.solve(&gradient));
        Some(Self {
            matrix: normal.matrix.view((own, own), (more, more)) - cross.tr_mul(&shared),
            gradient: normal.gradient.rows(own, more) - cross.tr_mul(&explained),
            information,
            rss: normal.rss - gradient.dot(&explained),
            log_variance,
            colour,
        })
    }

    /// Sum of squares after the best linear step in some columns.
    fn rss_with(&self, columns: &[usize]) -> f64 {
        let n = columns.len();
        let scale = |k: usize| {
            let length = self.matrix[(columns[k], columns[k])].sqrt();
            if length > 0.0 && length.is_finite() { length.recip() } else { 0.0 }
        };
        // Parallel columns are nothing new: 1e-9 keeps them from promising anything.
        let matrix = DMatrix::from_fn(n, n, |i, j| {
            let own = if i == j { 1e-9 + if scale(i) == 0.0 { 1.0 } else { 0.0 } } else { 0.0 };
            self.matrix[(columns[i], columns[j])] * scale(i) * scale(j) + own
        });
        let gradient = DVector::from_fn(n, |k, _| self.gradient[columns[k]] * scale(k));
        let gain = matrix.cholesky().map_or(0.0, |factor| factor.solve(&gradient).dot(&gradient));
        (self.rss - gain).max(0.0)
    }
}

impl Search<'_> {
    /// Sets of up to three effects of different names that promise the lowest BIC on a model, each under the noise that
    /// suits it best: fitted and judged, not pruned, the lowest BIC first.
    pub(super) fn together(&self, model: &Model) -> Vec<Model> {
        let fit = &model.plain;
        let Some(promises) = self.promises(model, true) else { return Vec::new() };
        let blocks = &promises.blocks;
        let mut sets = self.sets(blocks, MOST);
        let mut judged: Vec<(f64, Colour, Vec<usize>)> = sets
            .par_drain(..)
            .filter_map(|set| {
                let (bic, colour) = self.promised(&promises, &set)?;
                Some((bic, colour, set))
            })
            .collect();
        judged.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut models: Vec<Model> = judged
            .into_par_iter()
            .take(FITTED)
            .map(|(_, colour, set)| {
                let mut structure = model.structure.clone();
                let mut theta = fit.theta.clone();
                for &k in &set {
                    structure = structure.with(self.candidate(blocks[k].place).term.clone());
                    theta.extend(&blocks[k].start);
                }
                // Under a random moment a search is not carried away by what the structure cannot follow yet.
                let under = self.problem.fit(&structure, &theta, &fit.initial, &colour);
                let plain = self.problem.fit(&structure, &under.theta, &under.initial, &fit.colour);
                let mut found = self.judge(structure, plain);
                if under.bic < found.judged.bic {
                    found.judged = under;
                }
                found
            })
            .collect();
        models.sort_by(|one, other| one.judged.bic.total_cmp(&other.judged.bic));
        models
    }

    /// Whether any effect, or two together, promise to gain what they need on a model, each under the noise that suits
    /// it best.
    pub(super) fn promises_anything(&self, model: &Model) -> bool {
        let Some(promises) = self.promises(model, false) else { return true };
        let blocks = &promises.blocks;
        let Some((without, _)) = self.promised(&promises, &[]) else { return true };
        let pays = |set: &Vec<usize>| {
            let needed: f64 = set.iter().map(|&k| self.needed(&self.candidate(blocks[k].place).term)).sum();
            self.promised(&promises, set).is_none_or(|(bic, _)| without - bic > needed)
        };
        self.sets(blocks, PROMISED).par_iter().any(pays)
    }

    /// Columns of the candidates, `timeless` without a trend, and the normal equations under every colour.
    fn promises(&self, model: &Model, timeless: bool) -> Option<Promises> {
        let fit = &model.plain;
        let known = Linearised::new(self.problem, &model.structure, fit);
        let (blocks, columns) = self.blocks(model, &known, timeless);
        let linear = self.problem.linear(&model.structure, &fit.theta, &fit.initial);
        let own = known.columns.unknowns();
        let waves = fit.colour.waves;
        let moments = self.kinds().iter().flat_map(|&kind| LEVELS.map(|level| (kind, level)));
        let colours: Vec<Option<(Wander, f64)>> = std::iter::once(None).chain(moments.map(Some)).collect();
        let under = |whiteners: &[Whitener]| {
            let mut whitened = linear.whitened(whiteners);
            whitened.insert(own, &columns, whiteners);
            whitened.normal(&linear.whitened_residual(whiteners))
        };
        let plain = under(&self.problem.whiteners(&Colour::WHITE)).matrix;
        let n = self.problem.observations() as f64;
        let reduced: Vec<Reduced> = colours
            .into_par_iter()
            .filter_map(|wander| {
                let colour = Colour { wander, waves };
                let whiteners = self.problem.whiteners(&colour);
                let normal = under(&whiteners);
                let information = Information::new(&prior_and(&plain, &normal.matrix, n), own)?;
                Reduced::new(&normal, information, own, log_variance(&whiteners), colour)
            })
            .collect();
        Information::new(&plain, own).map(|plain| Promises { blocks, reduced, plain })
    }

    /// The lowest BIC that a set promises under any colour, less what every model has, with that colour.
    fn promised(&self, promises: &Promises, set: &[usize]) -> Option<(f64, Colour)> {
        let Promises { blocks, reduced, plain } = promises;
        let all: Vec<usize> = set.iter().flat_map(|&k| blocks[k].columns.clone()).collect();
        let freedom: usize = set.iter().map(|&k| blocks[k].freedom).sum();
        let plain = plain.of(&all);
        let bic = |reduced: &Reduced| {
            let lost = if reduced.colour.is_white() { 0.0 } else { reduced.information.of(&all) - plain };
            let deviance = self.problem.deviance(reduced.rss_with(&all), reduced.log_variance);
            deviance + (freedom + reduced.colour.freedom()) as f64 * self.log_n() + lost
        };
        let under = reduced.iter().map(|reduced| (bic(reduced), reduced.colour));
        under.min_by(|one, other| one.0.total_cmp(&other.0))
    }

    /// Columns of every candidate whose place in time need not be looked for, at the start of largest score; `timeless`
    /// of those that hold in all time.
    fn blocks(&self, model: &Model, known: &Linearised, timeless: bool) -> (Vec<Block>, Vec<Column>) {
        let (mut blocks, mut columns): (Vec<Block>, Vec<Column>) = (Vec::new(), Vec::new());
        for (place, candidate) in self.candidates.iter().enumerate() {
            let term = &candidate.term;
            if (timeless && term.effect.is_of_time()) || self.excludes(&model.structure, term) {
                continue;
            }
            let best = candidate
                .starts
                .iter()
                .map(|start| {
                    let new = self.columns_at(model, &model.plain, known, term, start);
                    (self.gain_of(known, &new), start, new)
                })
                .max_by(|one, other| one.0.total_cmp(&other.0));
            if let Some((_, start, new)) = best {
                let range = columns.len()..columns.len() + new.len();
                let place = CandidatePlace(place);
                blocks.push(Block { place, start: start.clone(), columns: range, freedom: term.freedom() });
                columns.extend(new);
            }
        }
        (blocks, columns)
    }

    /// All sets of one to `most` blocks that may stand beside each other.
    fn sets(&self, blocks: &[Block], most: usize) -> Vec<Vec<usize>> {
        let id = |k: usize| self.candidate(blocks[k].place).term.effect.id();
        let mut sets: Vec<Vec<usize>> = Vec::new();
        let mut last: Vec<Vec<usize>> = vec![Vec::new()];
        for _ in 0..most {
            let mut longer = Vec::new();
            for set in &last {
                for k in set.last().map_or(0, |last| last + 1)..blocks.len() {
                    if set.iter().all(|&other| id(other) != id(k)) {
                        longer.push(set.iter().copied().chain([k]).collect());
                    }
                }
            }
            sets.extend(longer.iter().cloned());
            last = longer;
        }
        sets
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Projecting the model out first and a set of columns afterwards is projecting all of them out at once.
    #[test]
    fn a_set_is_judged_as_if_it_were_solved_whole() {
        let rows = 40;
        let column = |k: usize| -> Vec<f64> { (0..rows).map(|t| ((k + 1) as f64 * 0.17 * t as f64).sin()).collect() };
        let columns: Vec<Vec<f64>> = (0..5).map(column).collect();
        let measured: Vec<f64> = (0..rows).map(|t| 0.3 * (0.2 * t as f64).cos() + 0.01 * t as f64).collect();
        let product = |one: &[f64], other: &[f64]| one.iter().zip(other).map(|(x, y)| x * y).sum::<f64>();
        let normal = |chosen: &[usize]| Normal {
            matrix: DMatrix::from_fn(chosen.len(), chosen.len(), |i, j| {
                product(&columns[chosen[i]], &columns[chosen[j]])
            }),
            gradient: DVector::from_fn(chosen.len(), |i, _| product(&columns[chosen[i]], &measured)),
            rss: product(&measured, &measured),
        };
        let whole = normal(&[0, 1, 2, 3, 4]);
        let information = Information::new(&whole.matrix, 2).expect("independent columns");
        let reduced = Reduced::new(&whole, information, 2, 0.0, Colour::WHITE).expect("independent columns");
        for (set, chosen) in [(vec![0], vec![0, 1, 2]), (vec![0, 2], vec![0, 1, 2, 4]), (vec![], vec![0, 1])] {
            let whole = normal(&chosen).projected(chosen.len());
            let found = reduced.rss_with(&set);
            assert!((found / whole - 1.0).abs() < 1e-6, "{set:?}: {found} against {whole}");
            let told = reduced.information.of(&set) - log_determinant(&normal(&chosen).matrix);
            assert!(told.abs() < 1e-6, "{set:?}: {told}");
        }
    }
}
