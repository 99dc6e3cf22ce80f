//! The exact step of the state over a time in which the noise goes on, with its derivatives.

use crate::law::Law;
use crate::noise::Moment;
use crate::number::Variable;
use crate::schedule::Span;
use ship::first_order::TangentTransition;

/// Terms of the series of the matrix exponential over one scaled step.
const TERMS: usize = 16;

/// Longest scaled step, in time constants: the series then ends below rounding. Longer ones are doubled.
const LONGEST: f64 = 0.25;

/// Nodes and weights on (0, 1) of the Gauss–Legendre rule of eight points, exact up to degree 15.
const NODES: [(f64, f64); 8] = [
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_63, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_64),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

/// Transition F and added covariance Q over a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step<R, const N: usize> {
    pub transition: [[R; N]; N],
    pub added: [[R; N]; N],
}

type Small<R> = [[R; 3]; 3];

impl<R: Variable, const N: usize> Step<R, N> {
    /// The step over the time between two readings.
    pub fn new(law: &Law<R>, span: &Span) -> Self {
        let zero = [[R::from(0.0); N]; N];
        let mut whole = match law.rudder {
            None => Self::of_moment(law, span.length()),
            Some(size) => {
                let mut pieces =
                    span.pieces.iter().map(|&length| Self::of_moment(law, length).erring(law, size, length));
                let first = pieces.next().unwrap_or(Self { transition: identity(), added: zero });
                pieces.fold(first, |before, piece| before.then(&piece))
            }
        };
        if let (Some(place), Some(rate)) = (law.compass_state(), law.compass_rate) {
            let decay = (-rate.value() * span.length()).exp();
            let decay = rate.chained(decay, -span.length() * decay);
            whole.transition[place][place] = decay;
            whole.added[place][place] = -(decay * decay) + 1.0;
        }
        whole
    }

    /// Ship and moment alone.
    fn of_moment(law: &Law<R>, length: f64) -> Self {
        let rates = law.inverse_time.value().abs() + law.rate.value();
        let doublings = (rates * length / LONGEST).log2().ceil().max(0.0);
        let (mut f, mut q) = short(law, length / doublings.exp2());
        for _ in 0..doublings as usize {
            q = sum(&q, &sandwich(&f, &q));
            f = product(&f, &f);
        }
        let mut step = Self { transition: identity(), added: [[R::from(0.0); N]; N] };
        let own = if law.has_moment_state() { 3 } else { 2 };
        for i in 0..own {
            for j in 0..own {
                (step.transition[i][j], step.added[i][j]) = (f[i][j], q[i][j]);
            }
        }
        step
    }

    /// With the error of the recorded rudder at both ends of a piece, between which it is linear.
    fn erring(mut self, law: &Law<R>, size: R, length: f64) -> Self {
        let Some(place) = law.rudder_state() else { return self };
        let TangentTransition { value, by_inverse_T: by } = TangentTransition::new(law.inverse_time.value(), length);
        let phi = |value: f64, slope: f64| law.inverse_time.chained(value, slope);
        let [one, two, three] = [phi(value.phi1, by.phi1), phi(value.phi2, by.phi2), phi(value.phi3, by.phi3)];
        let after = [three / length, two / length];
        let before = [two - after[0], one - after[1]];
        let zero = R::from(0.0);
        let mut fresh = [zero; N];
        for i in 0..2 {
            self.transition[i][place] = size * before[i];
            fresh[i] = size * after[i];
        }
        self.transition[place] = [zero; N];
        fresh[place] = R::from(1.0);
        for (row, one) in self.added.iter_mut().zip(fresh) {
            for (value, other) in row.iter_mut().zip(fresh) {
                *value = *value + one * other;
            }
        }
        self
    }

    /// This step and then another one.
    fn then(&self, next: &Self) -> Self {
        Self {
            transition: product(&next.transition, &self.transition),
            added: sum(&next.added, &sandwich(&next.transition, &self.added)),
        }
    }

    /// The covariance after the step: F P Fᵀ + Q.
    pub fn propagate(&self, covariance: &[[R; N]; N]) -> [[R; N]; N] {
        sum(&self.added, &sandwich(&self.transition, covariance))
    }
}

/// Transition and covariance over a step that is short against T and τ. Time is counted in steps, so that the series
/// has no units: z = (ψ, r h, m h²).
fn short<R: Variable>(law: &Law<R>, h: f64) -> (Small<R>, Small<R>) {
    let zero = R::from(0.0);
    let (x, y) = (law.inverse_time * h, law.rate * h);
    // Coefficients of the motion after an impulse on r, and on m: (ψ, r, m) as polynomials of time.
    let mut of_rate = [[zero; TERMS]; 3];
    let mut of_moment = [[zero; TERMS]; 3];
    of_rate[1][0] = R::from(1.0);
    of_moment[2][0] = R::from(1.0);
    for j in 1..TERMS {
        let per = 1.0 / j as f64;
        of_rate[0][j] = of_rate[1][j - 1] * per;
        of_rate[1][j] = -(x * of_rate[1][j - 1]) * per;
        of_moment[0][j] = of_moment[1][j - 1] * per;
        of_moment[1][j] = (of_moment[2][j - 1] - x * of_moment[1][j - 1]) * per;
        of_moment[2][j] = -(y * of_moment[2][j - 1]) * per;
    }
    let at = |polynomial: &[R; TERMS], s: f64| polynomial.iter().rev().fold(zero, |sum, &term| sum * s + term);
    let [r, m] = [&of_rate, &of_moment].map(|motion| motion.each_ref().map(|polynomial| at(polynomial, 1.0)));
    let transition = [[R::from(1.0), r[0] * h, m[0] * (h * h)], [zero, r[1], m[1] * h], [zero, zero, m[2]]];

    let (impulse, density) = match law.moment {
        Moment::None => return (transition, [[zero; 3]; 3]),
        Moment::White => (&of_rate, law.level * law.level * h.powi(3)),
        Moment::Walk => (&of_moment, law.level * law.level * h.powi(5)),
        Moment::OrnsteinUhlenbeck => (&of_moment, law.level * law.level * law.rate * (2.0 * h.powi(5))),
    };
    let mut added = [[zero; 3]; 3];
    for (s, weight) in NODES {
        let motion = impulse.each_ref().map(|polynomial| at(polynomial, s));
        for i in 0..3 {
            for j in 0..=i {
                added[i][j] = added[i][j] + motion[i] * motion[j] * weight;
            }
        }
    }
    let units = [1.0, h, h * h];
    let entry = |i: usize, j: usize| added[i.max(j)][i.min(j)] * density / (units[i] * units[j]);
    (transition, std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j))))
}

fn identity<R: Variable, const N: usize>() -> [[R; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| R::from(f64::from(u8::from(i == j)))))
}

fn sum<R: Variable, const N: usize>(one: &[[R; N]; N], other: &[[R; N]; N]) -> [[R; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|j| one[i][j] + other[i][j]))
}

fn product<R: Variable, const N: usize>(one: &[[R; N]; N], other: &[[R; N]; N]) -> [[R; N]; N] {
    let mut result = [[R::from(0.0); N]; N];
    for (result, one) in result.iter_mut().zip(one) {
        // Most of a transition is zero: nothing leads back from the ship to what disturbs it.
        for (one, other) in one.iter().zip(other).filter(|(one, _)| !one.vanishes()) {
            for (result, other) in result.iter_mut().zip(other) {
                *result = *result + *one * *other;
            }
        }
    }
    result
}

/// F P Fᵀ of a symmetric P.
fn sandwich<R: Variable, const N: usize>(f: &[[R; N]; N], p: &[[R; N]; N]) -> [[R; N]; N] {
    let half = product(f, p);
    let mut result = [[R::from(0.0); N]; N];
    for (j, f) in f.iter().enumerate() {
        for (k, f) in f.iter().enumerate().filter(|(_, f)| !f.vanishes()) {
            for i in j..N {
                result[i][j] = result[i][j] + half[i][k] * *f;
            }
        }
    }
    std::array::from_fn(|i| std::array::from_fn(|j| result[i.max(j)][i.min(j)]))
}
