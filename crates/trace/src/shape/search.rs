//! Forward search for shapes: all are screened in addition to the chosen shapes under some laws; for the best, the law
//! is chosen again among all laws, and the continuous parameters are refined.

use std::sync::Arc;

use estimation::column::dot;
use rayon::prelude::*;

use super::criterion::{GramProducts, HeadingColumn, WhitenedStructure, product};
use super::dictionary::Shape;
use super::laws::{RandomLaw, screening_law_indices};
use super::library::shapes;
use super::motion::PredictedMotion;
use crate::linear::{HeadingSensitivities, Linearisation};
use crate::noise_law::RecordWhitening;

/// Number of classes that the penalty of the choice of a shape assumes; [`Shape::class`] distinguishes 13.
const CLASSES: f64 = 11.0;

/// Maximum number of shapes.
const MAX_SHAPES: usize = 3;

/// Number of best shapes whose law is chosen again.
const FINALISTS: usize = 5;

/// Number of classes of shapes whose best shape has its law chosen again.
const CLASS_FINALISTS: usize = 6;

/// Maximum number of explanations that are refined.
const MAX_REFINED: usize = 2;

/// Number of shapes whitened together.
const CHUNK: usize = 8;

/// Candidate shape with its heading responses.
#[derive(Debug, Clone)]
pub struct ShapeCandidate {
    /// Shape.
    pub shape: Shape,
    /// Index of the record in which the shape acts; `None` for all records.
    pub record_index: Option<usize>,
    /// Penalty of the choice among places or forms, records and classes.
    pub penalty: f64,
    columns: Vec<HeadingColumn>,
}

/// Explanation of the residual: shapes with a random law.
#[derive(Debug, Clone)]
pub struct ShapeExplanation {
    /// Shapes.
    pub shapes: Vec<Arc<ShapeCandidate>>,
    /// Criterion −2 log p + penalties.
    pub criterion: f64,
    /// Index of the random law.
    pub random_law_index: usize,
}

/// Search for the shapes and the random law that explain a residual best.
pub struct ShapeSearch<'a> {
    /// Predicted motions of the records.
    pub motions: &'a [PredictedMotion<'a>],
    /// Random laws.
    pub random_laws: &'a [RandomLaw],
    /// Whitening under each law.
    pub whitening: &'a [RecordWhitening],
    /// Structure under each law; `None` if its columns are dependent.
    pub structure: &'a [Option<WhitenedStructure>],
    /// Number of unknowns of the structure.
    pub unknowns: usize,
}

/// Minimum root mean square of a nonzero moment.
const MIN_RMS: f64 = 1e-12;

impl ShapeSearch<'_> {
    /// Candidate of a shape that acts in all records or in one; `None` if its moment is zero there.
    fn candidate(&self, shape: Shape, record: Option<usize>, penalty: f64) -> Option<ShapeCandidate> {
        let acting = || self.motions.iter().filter(|motion| record.is_none_or(|record| record == motion.record_index));
        let moments: Vec<(&PredictedMotion, Vec<Vec<f64>>)> =
            acting().map(|motion| (motion, shape.moments(motion))).collect();
        let column = |k: usize| -> Option<HeadingColumn> {
            let values = moments.iter().flat_map(|(_, moments)| &moments[k]);
            let (square, rows) = values.fold((0.0, 0.0), |(sum, rows), m| (sum + m * m, rows + 1.0));
            let size = (square / rows).sqrt();
            let response = |(motion, moments): &(&PredictedMotion, Vec<Vec<f64>>)| {
                let moment: Vec<f64> = moments[k].iter().map(|m| m / size).collect();
                (motion.record_index, motion.heading_response(&moment))
            };
            (size.is_finite() && size > MIN_RMS).then(|| moments.iter().map(response).collect())
        };
        let columns = (0..moments.first()?.1.len()).map(column).collect::<Option<Vec<HeadingColumn>>>()?;
        Some(ShapeCandidate { shape, record_index: record, penalty, columns })
    }

    /// Candidates of all shapes; `unit` (s) is the time unit of the lags.
    fn library(&self, unit: f64) -> Vec<Arc<ShapeCandidate>> {
        let longest = self.motions.iter().max_by(|a, b| a.span()[1].total_cmp(&b.span()[1]));
        let Some(longest) = longest else { return Vec::new() };
        let all = |motion: &PredictedMotion| shapes([motion.span()[1], motion.record.spacing], unit);
        let forms = |class: usize, all: &[(Shape, usize)]| {
            all.iter().filter(|(shape, places)| *places == 1 && shape.class() == class).count()
        };
        let records = self.motions.len();
        let penalty = |shape: &Shape, places: usize, all: &[(Shape, usize)]| {
            let choices = if places > 1 { places } else { forms(shape.class(), all) };
            let records = if shape.is_time_dependent() { records } else { 1 };
            2.0 * ((choices * records) as f64).ln() + 2.0 * CLASSES.ln()
        };
        let of_ship = all(longest);
        let mut requested: Vec<(Shape, Option<usize>, f64)> = Vec::new();
        for (shape, places) in of_ship.iter().filter(|(shape, _)| !shape.is_time_dependent()) {
            requested.push((*shape, None, penalty(shape, *places, &of_ship)));
        }
        for motion in self.motions {
            let of_record = all(motion);
            for (shape, places) in of_record.iter().filter(|(shape, _)| shape.is_time_dependent()) {
                requested.push((*shape, Some(motion.record_index), penalty(shape, *places, &of_record)));
            }
        }
        let candidate = |(shape, record, penalty)| self.candidate(shape, record, penalty).map(Arc::new);
        requested.into_par_iter().filter_map(candidate).collect()
    }

    /// Columns of each candidate, whitened under the law of index `law`.
    fn white(&self, law: usize, candidates: &[&ShapeCandidate]) -> Vec<Vec<HeadingColumn>> {
        let mut all = candidates.iter().map(|candidate| candidate.columns.clone()).collect::<Vec<_>>();
        self.whiten(law, &mut all);
        all
    }

    /// Whitens columns of candidates record by record under the law of index `law`.
    fn whiten(&self, law: usize, all: &mut [Vec<HeadingColumn>]) {
        let columns = || all.iter().flatten().flatten();
        let mut records: Vec<usize> = columns().map(|(record, _)| *record).collect();
        records.sort_unstable();
        records.dedup();
        for record in records {
            let pieces = all.iter_mut().flatten().flatten().filter(|(number, _)| *number == record);
            self.whitening[law].apply(record, &mut pieces.map(|(_, values)| values).collect::<Vec<_>>());
        }
    }

    /// Structure with shapes appended under every law; `None` where its columns are dependent.
    fn extended(&self, shapes: &[Arc<ShapeCandidate>]) -> Vec<Option<WhitenedStructure>> {
        let all: Vec<&ShapeCandidate> = shapes.iter().map(Arc::as_ref).collect();
        let extend = |(law, structure): (usize, &Option<WhitenedStructure>)| {
            structure.as_ref()?.extended(&self.white(law, &all).concat())
        };
        self.structure.par_iter().enumerate().map(extend).collect()
    }

    /// Criterion and index of the law under which a structure with `shapes` appended is best; `structures` are the
    /// structure before, under every law.
    fn best_law(&self, structures: &[Option<WhitenedStructure>], shapes: &[&ShapeCandidate]) -> (f64, usize) {
        let penalty: f64 = shapes.iter().map(|shape| shape.penalty).sum();
        let criterion = |(law, structure): (usize, &Option<WhitenedStructure>)| {
            let criterion = structure.as_ref()?.criterion_with(&self.white(law, shapes).concat());
            Some((criterion + penalty, law))
        };
        structures.par_iter().enumerate().filter_map(criterion).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or(NONE)
    }

    /// Products of all candidates with the structure, under some laws.
    fn products(&self, laws: &[usize], library: &[Arc<ShapeCandidate>]) -> Vec<Vec<GramProducts>> {
        let products = |chunk: &[Arc<ShapeCandidate>]| {
            let mut white: Vec<Vec<HeadingColumn>> = chunk.iter().map(|candidate| candidate.columns.clone()).collect();
            let mut all = vec![Vec::with_capacity(laws.len()); chunk.len()];
            for &law in laws {
                let Some(structure) = &self.structure[law] else { continue };
                let raw = chunk.iter().flat_map(|candidate| &candidate.columns).flatten();
                for ((_, white), (_, raw)) in white.iter_mut().flatten().flatten().zip(raw) {
                    white.copy_from_slice(raw);
                }
                self.whiten(law, &mut white);
                all.iter_mut().zip(&white).for_each(|(products, columns)| products.push(structure.products(columns)));
            }
            all
        };
        library.par_chunks(CHUNK).flat_map_iter(products).collect()
    }

    /// Least criterion of every candidate in addition to the `chosen` shapes over some laws, from its products with the
    /// structure and with the chosen shapes.
    fn scan(
        &self,
        chosen: &[Arc<ShapeCandidate>],
        structures: &[Option<WhitenedStructure>],
        laws: &[usize],
        library: &[Arc<ShapeCandidate>],
        products: &mut [Vec<GramProducts>],
    ) -> Vec<f64> {
        let laws: Vec<usize> = laws.iter().copied().filter(|law| self.structure[*law].is_some()).collect();
        let weighted: Vec<Vec<HeadingColumn>> = laws.iter().map(|&law| self.weighted(law, chosen)).collect();
        let criterion = |(candidate, products): (&Arc<ShapeCandidate>, &mut Vec<GramProducts>)| {
            let mut lowest = f64::INFINITY;
            for ((products, &law), weighted) in products.iter_mut().zip(&laws).zip(&weighted) {
                for (cross, column) in products.cross.iter_mut().zip(&candidate.columns) {
                    cross.truncate(self.unknowns);
                    cross.extend(weighted.iter().map(|other| product(column, other)));
                }
                let structure = structures[law].as_ref();
                lowest = lowest.min(structure.map_or(f64::INFINITY, |s| s.criterion_with_products(products)));
            }
            lowest + candidate.penalty
        };
        library.par_iter().zip(products).map(criterion).collect()
    }

    /// Columns of shapes multiplied by the inverse covariance of a law: their products with raw columns equal the
    /// products of whitened columns.
    fn weighted(&self, law: usize, shapes: &[Arc<ShapeCandidate>]) -> Vec<HeadingColumn> {
        let mut columns = self.white(law, &shapes.iter().map(Arc::as_ref).collect::<Vec<_>>()).concat();
        for (record, values) in columns.iter_mut().flatten() {
            self.whitening[law].apply_transposed(*record, values);
        }
        columns
    }

    /// Finalists of a scan: the best candidates, and the best candidate of several classes.
    fn finalists(&self, criteria: &[f64], library: &[Arc<ShapeCandidate>]) -> Vec<Arc<ShapeCandidate>> {
        let mut order: Vec<usize> = (0..library.len()).filter(|&place| criteria[place].is_finite()).collect();
        order.sort_by(|&a, &b| criteria[a].total_cmp(&criteria[b]));
        let (mut classes, mut kept) = (Vec::new(), Vec::new());
        for (rank, place) in order.into_iter().enumerate() {
            let class = library[place].shape.class();
            let is_new = classes.len() < CLASS_FINALISTS && !classes.contains(&class);
            if is_new {
                classes.push(class);
            }
            if is_new || rank < FINALISTS {
                kept.push(Arc::clone(&library[place]));
            }
        }
        kept
    }

    /// Best explanation with the criteria without each shape, and all explanations that were tried; `unit` (s) is the
    /// time unit of the lags.
    pub fn explain(&self, unit: f64) -> ((ShapeExplanation, Vec<f64>), Vec<ShapeExplanation>) {
        let library = self.library(unit);
        let (criterion, law) = best_law(self.structure).unwrap_or(NONE);
        let laws = screening_law_indices(self.random_laws, law);
        let mut current = ShapeExplanation { shapes: Vec::new(), criterion, random_law_index: law };
        let mut all = vec![current.clone()];
        let mut products = self.products(&laws, &library);
        for _ in 0..MAX_SHAPES {
            let structures = self.extended(&current.shapes);
            let criteria = self.scan(&current.shapes, &structures, &laws, &library, &mut products);
            let penalty: f64 = current.shapes.iter().map(|shape| shape.penalty).sum();
            let with = |shape: Arc<ShapeCandidate>| {
                let (criterion, law_index) = self.best_law(&structures, &[&shape]);
                let shapes = [current.shapes.as_slice(), &[shape]].concat();
                ShapeExplanation { shapes, criterion: criterion + penalty, random_law_index: law_index }
            };
            let mut next: Vec<ShapeExplanation> = self.finalists(&criteria, &library).into_iter().map(with).collect();
            next.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
            let refined: Vec<ShapeExplanation> =
                next.iter().take(MAX_REFINED).filter_map(|e| self.refined(e)).collect();
            next.extend(refined);
            next.sort_by(|a, b| a.criterion.total_cmp(&b.criterion));
            let Some(lowest) = next.first().cloned() else { break };
            all.extend(next);
            current = lowest;
        }
        let lowest = all.iter().min_by(|a, b| a.criterion.total_cmp(&b.criterion)).cloned();
        (self.pruned(lowest.expect("the structure without shapes")), all)
    }

    /// Explanation after backward elimination of shapes that do not improve the criterion, with the criteria without
    /// each of the remaining shapes.
    fn pruned(&self, mut best: ShapeExplanation) -> (ShapeExplanation, Vec<f64>) {
        loop {
            let fewer: Vec<ShapeExplanation> = (0..best.shapes.len()).map(|place| self.without(&best, place)).collect();
            let lowest = fewer.iter().min_by(|a, b| a.criterion.total_cmp(&b.criterion));
            match lowest.filter(|next| best.shapes.len() > 1 && next.criterion < best.criterion) {
                Some(next) => best = next.clone(),
                None => return (best, fewer.iter().map(|without| without.criterion).collect()),
            }
        }
    }

    /// Explanation without the shape at `place`, under the law that is then best.
    fn without(&self, all: &ShapeExplanation, place: usize) -> ShapeExplanation {
        let mut shapes = all.shapes.clone();
        shapes.remove(place);
        self.explained(shapes)
    }

    /// Explanation by some shapes under their best law.
    fn explained(&self, shapes: Vec<Arc<ShapeCandidate>>) -> ShapeExplanation {
        let all: Vec<&ShapeCandidate> = shapes.iter().map(Arc::as_ref).collect();
        let (criterion, law_index) =
            if all.is_empty() { best_law(self.structure).unwrap_or(NONE) } else { self.best_law(self.structure, &all) };
        ShapeExplanation { shapes, criterion, random_law_index: law_index }
    }

    /// Explanation with the continuous parameters refined by coordinate search under its law, then under its best law;
    /// `None` if no parameter moves.
    fn refined(&self, from: &ShapeExplanation) -> Option<ShapeExplanation> {
        let structure = self.structure[from.random_law_index].as_ref()?;
        let mut shapes = from.shapes.clone();
        let white = |shape: &ShapeCandidate| self.white(from.random_law_index, &[shape]).concat();
        let mut columns: Vec<Vec<HeadingColumn>> = shapes.iter().map(|shape| white(shape)).collect();
        let mut lowest = structure.criterion_with(&columns.concat());
        let mut has_moved = false;
        for scale in [1.0, 0.5, 0.25] {
            for number in 0..shapes.len() {
                for (place, sign) in (0..shapes[number].shape.parameter_count()).flat_map(|k| [(k, 1.0), (k, -1.0)]) {
                    for _ in 0..3 {
                        let ShapeCandidate { shape, record_index: record, penalty, .. } = *shapes[number];
                        let motion = &self.motions[record.unwrap_or(0)];
                        let extent = [motion.span()[1], motion.record.spacing];
                        let moved = shape.moved(place, sign * scale, extent);
                        let Some(next) = moved.and_then(|shape| self.candidate(shape, record, penalty)) else { break };
                        let before = std::mem::replace(&mut columns[number], white(&next));
                        let criterion = structure.criterion_with(&columns.concat());
                        if criterion >= lowest - 1e-6 {
                            columns[number] = before;
                            break;
                        }
                        (lowest, has_moved) = (criterion, true);
                        shapes[number] = Arc::new(next);
                    }
                }
            }
        }
        has_moved.then(|| self.explained(shapes))
    }

    /// Whitened structure with the shapes of an explanation appended, under its law.
    pub fn with_shapes(&self, all: &ShapeExplanation) -> Option<WhitenedStructure> {
        let shapes: Vec<&ShapeCandidate> = all.shapes.iter().map(Arc::as_ref).collect();
        self.structure[all.random_law_index].as_ref()?.extended(&self.white(all.random_law_index, &shapes).concat())
    }
}

/// Coefficients of shapes, shape by shape, from the step of all unknowns, as root mean square moments, rad of rudder.
pub fn coefficients(shapes: &[Arc<ShapeCandidate>], step: &[f64]) -> Vec<Vec<f64>> {
    let count: usize = shapes.iter().map(|shape| shape.columns.len()).sum();
    let mut appended = step[step.len() - count..].iter().copied();
    shapes.iter().map(|shape| appended.by_ref().take(shape.columns.len()).collect()).collect()
}

/// Residual sum of squares (rad²) of a structure with shapes appended, after a step of all unknowns.
pub fn residual_sum_of_squares(linear: &Linearisation, shapes: &[Arc<ShapeCandidate>], step: &[f64]) -> f64 {
    let columns: Vec<&HeadingColumn> = shapes.iter().flat_map(|shape| &shape.columns).collect();
    let square = |(number, block): (usize, &HeadingSensitivities)| {
        let mut residual = block.residual.clone();
        let mut subtract = |by: f64, column: &[f64]| residual.iter_mut().zip(column).for_each(|(e, x)| *e -= by * x);
        block.columns.iter().for_each(|(unknown, column)| subtract(step[*unknown], column));
        for (column, by) in columns.iter().zip(&step[linear.unknowns..]) {
            column.iter().filter(|(record, _)| *record == number).for_each(|(_, column)| subtract(*by, column));
        }
        dot(&residual, &residual)
    };
    linear.blocks.iter().enumerate().map(square).sum()
}

/// Criterion and index if no law is possible.
const NONE: (f64, usize) = (f64::INFINITY, 0);

/// Criterion and index of the best law of structures; `None` if all are `None`.
pub fn best_law(structures: &[Option<WhitenedStructure>]) -> Option<(f64, usize)> {
    let criteria = structures.iter().enumerate().filter_map(|(law, s)| Some((s.as_ref()?.criterion(), law)));
    criteria.min_by(|a, b| a.0.total_cmp(&b.0))
}
