//! How far a hull is from records: replays of the rudder over whole records and over windows, in which heading and yaw
//! rate at the start are fitted while speed and sway run on; and the speed, where it was recorded.

use estimation::levenberg_marquardt::{Normal, Objective};
use estimation::number::{Dual, Real};
use nalgebra::{DMatrix, DVector};
use ship::angle::DEGREE;
use ship::vessel::prime::PrimeHull;

use super::expected::ExpectedHull;
use super::replayed::{Replayed, replayed};
use super::track::HullTrack;
use super::turn::HardTurn;

/// Coefficients of the largest form, the yaw rate at the start, and room for one more.
const DIRECTIONS: usize = 26;

/// Steps of the search for a yaw rate at the start, and shares of them that are tried.
const STEPS: usize = 3;
const SHARES: [f64; 4] = [1.0, 0.4, 0.16, 0.06];

/// A gain of less than this share ends that search.
const NEGLIGIBLE: f64 = 1e-6;

/// Standard deviations of what a hull of the right form leaves, because no form is right: they say how far each kind of
/// reading is believed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HullDeviations {
    /// Heading of a whole replay, rad.
    pub whole: f64,
    /// Heading in a window, rad.
    pub window: f64,
    /// Speed over U₀.
    pub speed: f64,
}

/// The least that is believed of any record.
const LEAST: HullDeviations = HullDeviations { whole: 1.0 * DEGREE, window: 0.2 * DEGREE, speed: 0.1 };

/// Where a search begins: so much that the hull is hardly another than expected.
const FIRST: HullDeviations = HullDeviations { whole: 3.0 * DEGREE, window: 1.0 * DEGREE, speed: 0.3 };

/// Mean squares of what a hull leaves on one record, and the yaw rate with which the whole replay begins, U₀/L.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Left {
    pub whole: f64,
    pub window: f64,
    pub speed: f64,
    pub begins_with: f64,
}

/// The yaw rates at the start of a record and of its windows, kept from one evaluation to the next.
#[derive(Debug, Clone)]
struct Starts {
    whole: [f64; 1],
    windows: Vec<f64>,
}

/// Records, a form and its priors.
pub(super) struct HullObjective<'a> {
    expected: &'a ExpectedHull,
    tracks: &'a [HullTrack],
    deviations: Vec<HullDeviations>,
    starts: Vec<Starts>,
    /// Whether the starts were found once.
    is_begun: bool,
    turn: HardTurn,
}

/// What is left of the headings of a window, and how it grows with the yaw rate at its start.
struct WindowFit {
    square: f64,
    step: f64,
    end: [f64; 3],
    rows: Vec<[f64; 3]>,
    read: usize,
}

fn window(hull: &PrimeHull<Dual<1>>, track: &HullTrack, ends: [usize; 2], [u, v]: [f64; 2], rate: f64) -> WindowFit {
    let start = [Dual::from(u), Dual::from(v), Dual::variable(rate, 0, 1.0)];
    let Replayed { rows, end } = replayed(hull, track, ends, start);
    let pairs = || {
        let measured = &track.heading[ends[0]..ends[1]];
        measured.iter().zip(&rows).filter(|(measured, _)| measured.is_finite())
    };
    let read = pairs().count();
    let mean = |of: fn((&f64, &[Dual<1>; 3])) -> f64| pairs().map(of).sum::<f64>() / read.max(1) as f64;
    let [left, slope] = [mean(|(measured, row)| measured - row[0].value), mean(|(_, row)| row[0].by[0])];
    let (mut square, mut cross, mut own) = (0.0, 0.0, 0.0);
    for (measured, row) in pairs() {
        let (error, by) = (measured - row[0].value - left, row[0].by[0] - slope);
        square += error * error;
        cross += error * by;
        own += by * by;
    }
    let values = |state: [Dual<1>; 3]| state.map(|one| one.value);
    let step = if own > 0.0 { cross / own } else { 0.0 };
    WindowFit { square, step, end: values(end), rows: rows.into_iter().map(values).collect(), read }
}

/// The same from the best yaw rate, which is left in `rate`.
fn settled(
    hull: &PrimeHull<Dual<1>>,
    track: &HullTrack,
    ends: [usize; 2],
    start: [f64; 2],
    rate: &mut f64,
) -> WindowFit {
    let mut now = window(hull, track, ends, start, *rate);
    for _ in 0..STEPS {
        let tried = SHARES.iter().find_map(|share| {
            let ahead = *rate + share * now.step;
            let next = window(hull, track, ends, start, ahead);
            (next.square < now.square).then_some((ahead, next))
        });
        let Some((ahead, next)) = tried else { break };
        let is_enough = now.square - next.square < NEGLIGIBLE * now.square;
        (*rate, now) = (ahead, next);
        if is_enough {
            break;
        }
    }
    now
}

/// Replays all windows of a record, each from its best yaw rate; calls `visit` with what each leaves.
fn through(
    hull: &PrimeHull<Dual<1>>,
    track: &HullTrack,
    cuts: &[usize],
    rates: &mut [f64],
    is_begun: bool,
    mut visit: impl FnMut(&WindowFit),
) {
    let mut start = track.start;
    let mut before = rates[0];
    for (ends, rate) in cuts.windows(2).zip(rates) {
        if !is_begun {
            *rate = before;
        }
        let found = settled(hull, track, [ends[0], ends[1]], start, rate);
        start = [found.end[0], found.end[1]];
        before = found.end[2];
        visit(&found);
    }
}

/// Mean square that the windows of a record leave; `rates` are the yaw rates at their starts.
pub(super) fn left_of_windows(hull: &PrimeHull<Dual<1>>, track: &HullTrack, rates: &mut [f64], is_begun: bool) -> f64 {
    let (mut square, mut read) = (0.0, 0);
    through(hull, track, &track.cuts, rates, is_begun, |found| {
        (square, read) = (square + found.square, read + found.read);
    });
    square / read.max(1) as f64
}

impl<'a> HullObjective<'a> {
    pub fn new(expected: &'a ExpectedHull, tracks: &'a [HullTrack]) -> Self {
        assert!(expected.coefficients.len() < DIRECTIONS, "a form has fewer than {DIRECTIONS} coefficients");
        let starts = |track: &HullTrack| Starts { whole: [0.0], windows: vec![0.0; track.cuts.len() - 1] };
        let starts = tracks.iter().map(starts).collect();
        let deviations = vec![FIRST; tracks.len()];
        Self { expected, tracks, deviations, starts, is_begun: false, turn: HardTurn::new() }
    }

    /// Mean squares of what is left on every record; `None` where the values make no ship.
    pub fn left(&mut self, at: &[f64]) -> Option<Vec<Left>> {
        let values: Vec<Dual<1>> = at.iter().map(|&value| Dual::from(value)).collect();
        let hull = self.expected.form.with(&values)?;
        let is_begun = std::mem::replace(&mut self.is_begun, true);
        let of = |(track, starts): (&HullTrack, &mut Starts)| {
            let mut left = Left::default();
            through(&hull, track, &track.whole, &mut starts.whole, is_begun, |found| {
                left.whole = found.square / found.read.max(1) as f64;
                let pairs = track.speed.iter().flatten().zip(&found.rows);
                let squares = pairs.map(|(measured, row)| (measured - row[1].hypot(row[2])).powi(2));
                left.speed = squares.sum::<f64>() / found.rows.len() as f64;
            });
            left.begins_with = starts.whole[0];
            left.window = left_of_windows(&hull, track, &mut starts.windows, is_begun);
            left
        };
        Some(self.tracks.iter().zip(&mut self.starts).map(of).collect())
    }

    /// Believes every record as far as what is left of it, and no further than a hull of the right form.
    pub fn reweigh(&mut self, at: &[f64]) {
        let all = self.left(at).unwrap_or_default();
        for (believed, left) in self.deviations.iter_mut().zip(all) {
            *believed = HullDeviations {
                whole: LEAST.whole.max(left.whole.sqrt()),
                window: LEAST.window.max(left.window.sqrt()),
                speed: LEAST.speed.max(left.speed.sqrt()),
            };
        }
    }

    /// Weight of a record: its length in L/U₀ over the number of records. The error of the form is another in every
    /// ship length that is sailed, and the same in every record of alike manoeuvres.
    fn weight(&self, track: &HullTrack) -> f64 {
        track.duration() / self.tracks.len() as f64
    }

    /// Λ (μ − θ), and (θ − μ)ᵀ Λ (θ − μ).
    fn of_priors(&self, at: &[f64]) -> (DVector<f64>, f64) {
        let left = self.expected.mean() - DVector::from_column_slice(at);
        let pull = &self.expected.precision * &left;
        let square = pull.dot(&left);
        (pull, square)
    }
}

impl Objective for HullObjective<'_> {
    fn bounds(&self, unknown: usize) -> [f64; 2] {
        self.expected.coefficients[unknown].ends
    }

    /// Σ over records of their weights times mean squares over variances, the priors, and the turn with the rudder hard
    /// over.
    fn value(&mut self, at: &[f64]) -> f64 {
        let (Some(left), Some(hull)) = (self.left(at), self.expected.form.with(at)) else { return f64::INFINITY };
        let of = |((track, left), believed): ((&HullTrack, Left), &HullDeviations)| {
            let HullDeviations { whole, window, speed } = *believed;
            let share = |square: f64, deviation: f64| square / (deviation * deviation);
            let headings = share(left.whole, whole) + share(left.window, window);
            self.weight(track) * (headings + share(left.speed, speed))
        };
        self.of_priors(at).1
            + self.turn.departures(&hull).iter().map(|own| own.powi(2)).sum::<f64>()
            + self.tracks.iter().zip(left).zip(&self.deviations).map(of).sum::<f64>()
    }

    fn linearise(&mut self, at: &[f64], normal: &mut Normal) -> f64 {
        let value = self.value(at);
        *normal = Normal { matrix: self.expected.precision.clone(), gradient: self.of_priors(at).0 };
        let values: Vec<Dual<DIRECTIONS>> =
            at.iter().enumerate().map(|(place, &value)| Dual::variable(value, place, 1.0)).collect();
        let Some(hull) = self.expected.form.with(&values) else { return f64::INFINITY };
        for departure in self.turn.departures(&hull) {
            let by = DVector::from_column_slice(&departure.by[..at.len()]);
            normal.matrix.ger(1.0, &by, &by, 1.0);
            normal.gradient.axpy(-departure.value, &by, 1.0);
        }
        for ((track, starts), believed) in self.tracks.iter().zip(&self.starts).zip(&self.deviations) {
            let HullDeviations { whole, window, speed } = *believed;
            let lengths = self.weight(track);
            let read = track.heading.iter().filter(|heading| heading.is_finite()).count() as f64;
            let weight = |deviation: f64, rows: f64| lengths / (rows * deviation * deviation);
            let of_speed = Some(weight(speed, track.time.len() as f64));
            add(normal, &hull, track, &track.whole, &starts.whole, weight(whole, read), of_speed);
            add(normal, &hull, track, &track.cuts, &starts.windows, weight(window, read), None);
        }
        value
    }
}

/// Adds the normal equations of the windows of a record; `of_speed` is the weight of a speed.
fn add(
    normal: &mut Normal,
    hull: &PrimeHull<Dual<DIRECTIONS>>,
    track: &HullTrack,
    cuts: &[usize],
    rates: &[f64],
    weight: f64,
    of_speed: Option<f64>,
) {
    let unknowns = normal.gradient.len();
    let mut start = track.start.map(Dual::from);
    for (ends, &rate) in cuts.windows(2).zip(rates) {
        // What runs on does not depend on the yaw rate at this start.
        start.iter_mut().for_each(|one| one.by[unknowns] = 0.0);
        let variable = Dual::variable(rate, unknowns, 1.0);
        let Replayed { rows, end } = replayed(hull, track, [ends[0], ends[1]], [start[0], start[1], variable]);
        start = [end[0], end[1]];
        let (columns, follows) = of_headings(&rows, &track.heading[ends[0]..ends[1]], unknowns);
        add_squares(normal, &columns, unknowns + 1, weight);
        let Some((weight, measured)) = of_speed.zip(track.speed.as_ref()) else { continue };
        let columns = DMatrix::from_fn(rows.len(), unknowns + 2, |i, j| {
            let own = rows[i][1].hypot(rows[i][2]);
            match j {
                _ if j > unknowns => measured[ends[0] + i] - own.value,
                _ if j == unknowns => 0.0,
                _ => own.by[j] - follows[j] * own.by[unknowns],
            }
        });
        add_squares(normal, &columns, unknowns + 1, weight);
    }
}

/// How the headings that were read follow the coefficients from the best yaw rate at the start, and what is left of
/// them; and how that yaw rate follows the coefficients.
fn of_headings(rows: &[[Dual<DIRECTIONS>; 3]], measured: &[f64], unknowns: usize) -> (DMatrix<f64>, Vec<f64>) {
    let read: Vec<usize> = (0..rows.len()).filter(|&row| measured[row].is_finite()).collect();
    let heading = |i: usize, j: usize| {
        let own = &rows[read[i]][0];
        if j > unknowns { measured[read[i]] - own.value } else { own.by[j] }
    };
    let mut columns = DMatrix::from_fn(read.len(), unknowns + 2, heading);
    for mut column in columns.column_iter_mut() {
        let mean = column.mean();
        column.add_scalar_mut(-mean);
    }
    let by_rate = columns.column(unknowns).clone_owned();
    let own = by_rate.norm_squared();
    let follows: Vec<f64> =
        columns.column_iter().map(|column| if own > 0.0 { column.dot(&by_rate) / own } else { 0.0 }).collect();
    for (place, share) in follows.iter().enumerate().filter(|(place, _)| *place != unknowns) {
        columns.column_mut(place).axpy(-share, &by_rate, 1.0);
    }
    (columns, follows)
}

/// Times, in L/U₀, and variances of the heading of a whole replay where the coefficients have this covariance, rad².
/// `None` where the values make no ship.
pub(super) fn variances(
    expected: &ExpectedHull,
    track: &HullTrack,
    values: &[f64],
    covariance: &DMatrix<f64>,
) -> Option<[Vec<f64>; 2]> {
    let rate = HullObjective::new(expected, std::slice::from_ref(track)).left(values)?[0].begins_with;
    let unknowns = values.len();
    let variables: Vec<Dual<DIRECTIONS>> =
        values.iter().enumerate().map(|(place, &value)| Dual::variable(value, place, 1.0)).collect();
    let [u, v] = track.start.map(Dual::from);
    let start = [u, v, Dual::variable(rate, unknowns, 1.0)];
    let Replayed { rows, .. } = replayed(&expected.form.with(&variables)?, track, track.whole, start);
    let (columns, _) = of_headings(&rows, &track.heading, unknowns);
    let by = columns.columns(0, unknowns);
    let spread = by * covariance;
    let variance = (0..by.nrows()).map(|row| spread.row(row).dot(&by.row(row))).collect();
    let read = track.time.iter().zip(&track.heading).filter(|(_, heading)| heading.is_finite());
    Some([read.map(|(time, _)| *time).collect(), variance])
}

/// XᵀX and Xᵀe of the first columns and the error, which is the last.
fn add_squares(normal: &mut Normal, columns: &DMatrix<f64>, error: usize, weight: f64) {
    let of_unknowns = columns.columns(0, error - 1);
    normal.matrix.gemm_tr(weight, &of_unknowns, &of_unknowns, 1.0);
    normal.gradient.gemv_tr(weight, &of_unknowns, &columns.column(error), 1.0);
}
