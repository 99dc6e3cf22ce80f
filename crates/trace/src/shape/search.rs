//! The search for shapes: all are tried beside those that stand, under some laws; the law of the best is found anew
//! among all, and their places are refined.

use std::sync::Arc;

use estimation::column::dot;
use rayon::prelude::*;

use super::conditioned::{ColumnProducts, Conditioned, HeadingColumn, product};
use super::dictionary::Shape;
use super::laws::{RandomLaw, tried};
use super::library::shapes;
use super::motion::ForeseenMotion;
use crate::linear::{HeadingSensitivities, Linear};
use crate::weights::Weights;

/// Classes of shapes: each had its chance.
const CLASSES: f64 = 11.0;

/// Rounds, each with one shape more.
const ROUNDS: usize = 3;

/// Shapes whose law is found anew: the best of all, the best of so many classes; and those that are refined.
const BEST: usize = 5;
const BEST_OF_CLASSES: usize = 6;
const REFINED: usize = 2;

/// Shapes that are made white side by side.
const SIDE_BY_SIDE: usize = 8;

/// A shape with what the headings answer.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// The shape.
    pub shape: Shape,
    /// The record in which it acts; `None` for all.
    pub only: Option<usize>,
    /// −2 log of the prior odds of its places and forms.
    pub price: f64,
    columns: Vec<HeadingColumn>,
}

/// Shapes that stand together, with the law beside them.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// The shapes.
    pub shapes: Vec<Arc<Candidate>>,
    /// −2 log p with the price of all.
    pub height: f64,
    /// Place of the law.
    pub law: usize,
}

/// What a search needs.
pub struct ShapeSearch<'a> {
    /// The records.
    pub motions: &'a [ForeseenMotion<'a>],
    /// Laws.
    pub laws: &'a [RandomLaw],
    /// What makes columns white under each.
    pub weights: &'a [Weights],
    /// The structure under each; `None` where its unknowns cannot be told apart.
    pub structure: &'a [Option<Conditioned>],
    /// Number of its unknowns.
    pub unknowns: usize,
}

/// Sizes below which a moment is none.
const LEAST: f64 = 1e-12;

impl ShapeSearch<'_> {
    /// A shape in all records, or in one; `None` where the records do not hold it.
    fn candidate(&self, shape: Shape, only: Option<usize>, price: f64) -> Option<Candidate> {
        let acting = || self.motions.iter().filter(|motion| only.is_none_or(|only| only == motion.number));
        let moments: Vec<(&ForeseenMotion, Vec<Vec<f64>>)> =
            acting().map(|motion| (motion, shape.moments(motion))).collect();
        let column = |k: usize| -> Option<HeadingColumn> {
            let values = moments.iter().flat_map(|(_, own)| &own[k]);
            let (square, rows) = values.fold((0.0, 0.0), |(sum, rows), m| (sum + m * m, rows + 1.0));
            let size = (square / rows).sqrt();
            let answer = |(motion, own): &(&ForeseenMotion, Vec<Vec<f64>>)| {
                let moment: Vec<f64> = own[k].iter().map(|m| m / size).collect();
                (motion.number, motion.answer(&moment))
            };
            (size.is_finite() && size > LEAST).then(|| moments.iter().map(answer).collect())
        };
        let columns = (0..moments.first()?.1.len()).map(column).collect::<Option<Vec<HeadingColumn>>>()?;
        Some(Candidate { shape, only, price, columns })
    }

    /// Every shape.
    fn library(&self, unit: f64) -> Vec<Arc<Candidate>> {
        let longest = self.motions.iter().max_by(|one, other| one.span()[1].total_cmp(&other.span()[1]));
        let Some(longest) = longest else { return Vec::new() };
        let all = |motion: &ForeseenMotion| shapes([motion.span()[1], motion.record.spacing], unit);
        let forms = |class: usize, all: &[(Shape, usize)]| {
            all.iter().filter(|(shape, places)| *places == 1 && shape.class() == class).count()
        };
        let records = self.motions.len();
        let price = |shape: &Shape, places: usize, all: &[(Shape, usize)]| {
            let tried = if places > 1 { places } else { forms(shape.class(), all) };
            let records = if shape.is_of_time() { records } else { 1 };
            2.0 * ((tried * records) as f64).ln() + 2.0 * CLASSES.ln()
        };
        let of_ship = all(longest);
        let mut wanted: Vec<(Shape, Option<usize>, f64)> = Vec::new();
        for (shape, places) in of_ship.iter().filter(|(shape, _)| !shape.is_of_time()) {
            wanted.push((*shape, None, price(shape, *places, &of_ship)));
        }
        for motion in self.motions {
            let of_record = all(motion);
            for (shape, places) in of_record.iter().filter(|(shape, _)| shape.is_of_time()) {
                wanted.push((*shape, Some(motion.number), price(shape, *places, &of_record)));
            }
        }
        let made = |(shape, only, price)| self.candidate(shape, only, price).map(Arc::new);
        wanted.into_par_iter().filter_map(made).collect()
    }

    /// The columns of a shape, white under a law.
    fn white(&self, law: usize, candidates: &[&Candidate]) -> Vec<Vec<HeadingColumn>> {
        let mut all: Vec<Vec<HeadingColumn>> = candidates.iter().map(|own| own.columns.clone()).collect();
        let columns = || all.iter().flatten().flatten();
        let mut records: Vec<usize> = columns().map(|(record, _)| *record).collect();
        records.sort_unstable();
        records.dedup();
        for record in records {
            let pieces = all.iter_mut().flatten().flatten().filter(|(number, _)| *number == record);
            self.weights[law].apply(record, &mut pieces.map(|(_, values)| values).collect::<Vec<_>>());
        }
        all
    }

    /// The structures with shapes behind them, under every law.
    fn extended(&self, shapes: &[Arc<Candidate>]) -> Vec<Option<Conditioned>> {
        let all: Vec<&Candidate> = shapes.iter().map(Arc::as_ref).collect();
        let under = |(law, structure): (usize, &Option<Conditioned>)| {
            structure.as_ref()?.extended(&self.white(law, &all).concat())
        };
        self.structure.par_iter().enumerate().map(under).collect()
    }

    /// The best law of a structure with one shape more.
    fn judged(&self, under: &[Option<Conditioned>], shapes: &[&Candidate]) -> (f64, usize) {
        let price: f64 = shapes.iter().map(|own| own.price).sum();
        let height = |(law, structure): (usize, &Option<Conditioned>)| {
            let own = structure.as_ref()?.height_of(&self.white(law, shapes).concat());
            Some((own + price, law))
        };
        under.par_iter().enumerate().filter_map(height).min_by(|one, other| one.0.total_cmp(&other.0)).unwrap_or(NONE)
    }

    /// The products of every shape with the structure, under some laws.
    fn products(&self, laws: &[usize], library: &[Arc<Candidate>]) -> Vec<Vec<ColumnProducts>> {
        let of = |chunk: &[Arc<Candidate>]| {
            let candidates: Vec<&Candidate> = chunk.iter().map(Arc::as_ref).collect();
            let mut all = vec![Vec::with_capacity(laws.len()); chunk.len()];
            for &law in laws {
                let Some(structure) = &self.structure[law] else { continue };
                let white = self.white(law, &candidates);
                all.iter_mut().zip(white).for_each(|(own, columns)| own.push(structure.products(&columns)));
            }
            all
        };
        library.par_chunks(SIDE_BY_SIDE).flat_map_iter(of).collect()
    }

    /// The lowest height of every shape behind the structure and the shapes that `stand`, under some laws, from
    /// products to which those with the shapes that stand are added.
    fn scan(
        &self,
        stand: &[Arc<Candidate>],
        under: &[Option<Conditioned>],
        laws: &[usize],
        library: &[Arc<Candidate>],
        products: &mut [Vec<ColumnProducts>],
    ) -> Vec<f64> {
        let laws: Vec<usize> = laws.iter().copied().filter(|law| self.structure[*law].is_some()).collect();
        let behind: Vec<Vec<HeadingColumn>> = laws.iter().map(|&law| self.weighted(law, stand)).collect();
        let height = |(candidate, products): (&Arc<Candidate>, &mut Vec<ColumnProducts>)| {
            let mut lowest = f64::INFINITY;
            for ((products, &law), behind) in products.iter_mut().zip(&laws).zip(&behind) {
                for (cross, column) in products.cross.iter_mut().zip(&candidate.columns) {
                    cross.truncate(self.unknowns);
                    cross.extend(behind.iter().map(|other| product(column, other)));
                }
                let structure = under[law].as_ref();
                lowest = lowest.min(structure.map_or(f64::INFINITY, |own| own.height_of_products(products)));
            }
            lowest + candidate.price
        };
        library.par_iter().zip(products).map(height).collect()
    }

    /// The columns of shapes after the inverse covariance of a law: their products with raw columns are those of white
    /// ones.
    fn weighted(&self, law: usize, shapes: &[Arc<Candidate>]) -> Vec<HeadingColumn> {
        let mut columns = self.white(law, &shapes.iter().map(Arc::as_ref).collect::<Vec<_>>()).concat();
        for (record, values) in columns.iter_mut().flatten() {
            self.weights[law].apply_transposed(*record, values);
        }
        columns
    }

    /// The best shapes of a scan: those of all, and those of some classes.
    fn finalists(&self, heights: &[f64], library: &[Arc<Candidate>]) -> Vec<Arc<Candidate>> {
        let mut order: Vec<usize> = (0..library.len()).filter(|&place| heights[place].is_finite()).collect();
        order.sort_by(|&one, &other| heights[one].total_cmp(&heights[other]));
        let (mut classes, mut kept) = (Vec::new(), Vec::new());
        for (rank, place) in order.into_iter().enumerate() {
            let class = library[place].shape.class();
            let is_new = classes.len() < BEST_OF_CLASSES && !classes.contains(&class);
            if is_new {
                classes.push(class);
            }
            if is_new || rank < BEST {
                kept.push(Arc::clone(&library[place]));
            }
        }
        kept
    }

    /// The best explanation with the heights without each of its shapes, and all that were tried.
    pub fn explain(&self, unit: f64) -> ((Explanation, Vec<f64>), Vec<Explanation>) {
        let library = self.library(unit);
        let (height, law) = best(self.structure).unwrap_or(NONE);
        let laws = tried(self.laws, law);
        let mut stand = Explanation { shapes: Vec::new(), height, law };
        let mut all = vec![stand.clone()];
        let mut products = self.products(&laws, &library);
        for _ in 0..ROUNDS {
            let under = self.extended(&stand.shapes);
            let heights = self.scan(&stand.shapes, &under, &laws, &library, &mut products);
            let price: f64 = stand.shapes.iter().map(|own| own.price).sum();
            let with = |shape: Arc<Candidate>| {
                let (height, law) = self.judged(&under, &[&shape]);
                let shapes = [stand.shapes.as_slice(), &[shape]].concat();
                Explanation { shapes, height: height + price, law }
            };
            let mut next: Vec<Explanation> = self.finalists(&heights, &library).into_iter().map(with).collect();
            next.sort_by(|one, other| one.height.total_cmp(&other.height));
            let refined: Vec<Explanation> = next.iter().take(REFINED).filter_map(|own| self.refined(own)).collect();
            next.extend(refined);
            next.sort_by(|one, other| one.height.total_cmp(&other.height));
            let Some(lowest) = next.first().cloned() else { break };
            all.extend(next);
            stand = lowest;
        }
        let lowest = all.iter().min_by(|one, other| one.height.total_cmp(&other.height)).cloned();
        (self.pruned(lowest.expect("the structure alone is one")), all)
    }

    /// Without the shapes that do not pay, and the heights without each of the others.
    fn pruned(&self, mut best: Explanation) -> (Explanation, Vec<f64>) {
        loop {
            let fewer: Vec<Explanation> = (0..best.shapes.len()).map(|place| self.without(&best, place)).collect();
            let lowest = fewer.iter().min_by(|one, other| one.height.total_cmp(&other.height));
            match lowest.filter(|next| best.shapes.len() > 1 && next.height < best.height) {
                Some(next) => best = next.clone(),
                None => return (best, fewer.iter().map(|own| own.height).collect()),
            }
        }
    }

    /// An explanation without one of its shapes, its law found anew.
    fn without(&self, all: &Explanation, place: usize) -> Explanation {
        let mut shapes = all.shapes.clone();
        shapes.remove(place);
        self.explained(shapes)
    }

    /// Shapes with their best law.
    fn explained(&self, shapes: Vec<Arc<Candidate>>) -> Explanation {
        let all: Vec<&Candidate> = shapes.iter().map(Arc::as_ref).collect();
        let (height, law) =
            if all.is_empty() { best(self.structure).unwrap_or(NONE) } else { self.judged(self.structure, &all) };
        Explanation { shapes, height, law }
    }

    /// The places of all shapes refined under their law by steps that are halved, and the law found anew; `None` where
    /// nothing moves.
    fn refined(&self, from: &Explanation) -> Option<Explanation> {
        let structure = self.structure[from.law].as_ref()?;
        let mut shapes = from.shapes.clone();
        let white = |own: &Candidate| self.white(from.law, &[own]).concat();
        let mut columns: Vec<Vec<HeadingColumn>> = shapes.iter().map(|own| white(own)).collect();
        let mut lowest = structure.height_of(&columns.concat());
        let mut has_moved = false;
        for scale in [1.0, 0.5, 0.25] {
            for number in 0..shapes.len() {
                for (place, sign) in (0..shapes[number].shape.place_count()).flat_map(|k| [(k, 1.0), (k, -1.0)]) {
                    for _ in 0..3 {
                        let Candidate { shape, only, price, .. } = *shapes[number];
                        let motion = &self.motions[only.unwrap_or(0)];
                        let about = [motion.span()[1], motion.record.spacing];
                        let moved = shape.moved(place, sign * scale, about);
                        let Some(next) = moved.and_then(|shape| self.candidate(shape, only, price)) else { break };
                        let before = std::mem::replace(&mut columns[number], white(&next));
                        let height = structure.height_of(&columns.concat());
                        if height >= lowest - 1e-6 {
                            columns[number] = before;
                            break;
                        }
                        (lowest, has_moved) = (height, true);
                        shapes[number] = Arc::new(next);
                    }
                }
            }
        }
        has_moved.then(|| self.explained(shapes))
    }

    /// The structure with an explanation behind it, under its law.
    pub fn whole(&self, all: &Explanation) -> Option<Conditioned> {
        let shapes: Vec<&Candidate> = all.shapes.iter().map(Arc::as_ref).collect();
        self.structure[all.law].as_ref()?.extended(&self.white(all.law, &shapes).concat())
    }
}

/// The coefficients of shapes, shape by shape, from the step of all unknowns: rad of rudder at the root mean square of
/// every moment.
pub fn coefficients(shapes: &[Arc<Candidate>], step: &[f64]) -> Vec<Vec<f64>> {
    let count: usize = shapes.iter().map(|own| own.columns.len()).sum();
    let mut behind = step[step.len() - count..].iter().copied();
    shapes.iter().map(|own| behind.by_ref().take(own.columns.len()).collect()).collect()
}

/// Σ e² of the headings, rad², that a structure leaves after a step, with shapes behind its unknowns.
pub fn square_left(linear: &Linear, shapes: &[Arc<Candidate>], step: &[f64]) -> f64 {
    let columns: Vec<&HeadingColumn> = shapes.iter().flat_map(|own| &own.columns).collect();
    let of = |(number, block): (usize, &HeadingSensitivities)| {
        let mut left = block.residual.clone();
        let mut take = |by: f64, column: &[f64]| left.iter_mut().zip(column).for_each(|(e, x)| *e -= by * x);
        block.columns.iter().for_each(|(unknown, column)| take(step[*unknown], column));
        for (column, by) in columns.iter().zip(&step[linear.unknowns..]) {
            column.iter().filter(|(record, _)| *record == number).for_each(|(_, column)| take(*by, column));
        }
        dot(&left, &left)
    };
    linear.blocks.iter().enumerate().map(of).sum()
}

/// No explanation.
const NONE: (f64, usize) = (f64::INFINITY, 0);

/// Height and place of the best law of a structure.
pub fn best(under: &[Option<Conditioned>]) -> Option<(f64, usize)> {
    let heights = under.iter().enumerate().filter_map(|(law, own)| Some((own.as_ref()?.height(), law)));
    heights.min_by(|one, other| one.0.total_cmp(&other.0))
}
