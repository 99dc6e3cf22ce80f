//! Ships drawn from the normal law of the coefficients of a hull of three degrees of freedom.

use document::{IdentifiedHull, IdentifiedShipError};
use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use rand_distr::StandardNormal;
use ship::vessel::prime::{HullCoefficient, HullModel};
use ship::vessel::prior::Particular;
use ship::vessel::scaled::ScaledHull;

use crate::error::PredictError;
use crate::root::covariance_root;

/// Maximum number of rejected samples, outside the range of a coefficient or without a ship; then the stored values are
/// used.
const MAX_TRIES: usize = 100;

/// Hull from which ships are drawn.
#[derive(Debug, Clone)]
pub(crate) struct HullSampler {
    pub stored: IdentifiedHull,
    form: HullModel,
    coefficients: Vec<HullCoefficient>,
    /// Square root of the covariance; at another loading, of the covariance that is independent of the trials.
    root: DMatrix<f64>,
    /// Sampler of the hull in the condition of the trials, and the gain G by which shifts of its coefficients move
    /// those of this hull; `None` unless this hull is at another loading.
    trial_hull: Option<(Box<HullSampler>, DMatrix<f64>)>,
}

/// Checks a hull; fails for an unknown form, wrong coefficients, or a matrix that is not a covariance.
pub fn check(hull: &IdentifiedHull) -> Result<(), PredictError> {
    HullSampler::new(hull).map(drop)
}

impl HullSampler {
    /// Prepares the sampling; fails as [`check`] does.
    pub fn new(stored: &IdentifiedHull) -> Result<Self, PredictError> {
        let form = stored.form()?;
        let range = |key| Particular::find(key).expect("it is one").range;
        let [length, speed] = ["length-m", "speed-m-s"].map(range);
        for (key, value, [least, most]) in [
            ("length-m", stored.length_m, length),
            ("speed-m-s", stored.speed_m_s, speed),
            ("weight", stored.weight, [0.0, f64::MAX]),
        ] {
            if !(least..=most).contains(&value) {
                return Err(IdentifiedShipError::Value { key, value }.into());
            }
        }
        let coefficients = form.coefficients().to_vec();
        let rows = stored.covariance.len();
        if rows != coefficients.len() {
            let (list, expected) = ("rows of the covariance of a hull", coefficients.len());
            return Err(IdentifiedShipError::Count { list, expected, length: rows }.into());
        }
        let root = covariance_root(
            stored.trial_hull.as_ref().map_or(&stored.covariance, |from| &from.conditional_covariance),
        )?;
        let trial_hull = stored
            .trial_hull
            .as_ref()
            .map(|from| Ok::<_, PredictError>((Box::new(Self::new(&from.hull)?), from.gain.clone())));
        let hull = Self { stored: stored.clone(), form, coefficients, root, trial_hull: trial_hull.transpose()? };
        hull.with_coefficients(&stored.values()).ok_or_else(|| stored.unknown_model_error())?;
        Ok(hull)
    }

    fn with_coefficients(&self, values: &[f64]) -> Option<ScaledHull> {
        let hull = self.form.with_coefficients(values)?;
        let IdentifiedHull { length_m: length, speed_m_s: speed, propeller_per_s: propeller, .. } = self.stored;
        (values.iter().all(|value| value.is_finite())).then_some(ScaledHull {
            hull,
            length,
            speed,
            propeller_rate: propeller,
        })
    }

    /// Hull with the stored values.
    pub fn most_probable(&self) -> ScaledHull {
        self.with_coefficients(&self.stored.values()).expect("checked when it was made")
    }

    /// Hull with these coefficients, or the most probable hull if they are not valid.
    pub fn hull_or_most_probable(&self, values: &[f64]) -> ScaledHull {
        self.with_coefficients(values).unwrap_or_else(|| self.most_probable())
    }

    /// Draw of the coefficients, by their covariance and within their ranges. At another loading `rng` draws the
    /// hull of the trials, which this hull follows, and `independent` the part that is independent of the trials.
    pub fn sample(&self, rng: &mut impl rand::Rng, independent: &mut impl rand::Rng) -> Vec<f64> {
        let mean = DVector::from(self.stored.values());
        let values = match &self.trial_hull {
            None => self.values(rng, &mean),
            Some((from, gain)) => {
                let of_trial = DVector::from(from.stored.values());
                let step = from.values(rng, &of_trial) - of_trial;
                self.values(independent, &(mean + gain * step))
            }
        };
        values.as_slice().to_vec()
    }

    /// Draw of the coefficients about a mean, within their ranges; the stored values after [`MAX_TRIES`] rejections.
    fn values(&self, rng: &mut impl rand::Rng, mean: &DVector<f64>) -> DVector<f64> {
        let is_within = |values: &DVector<f64>| {
            let mut pairs = self.coefficients.iter().zip(values);
            pairs.all(|(prior, value)| (prior.bounds[0]..=prior.bounds[1]).contains(value))
        };
        let mut tries = (0..MAX_TRIES)
            .map(|_| mean + &self.root * DVector::from_fn(mean.len(), |_, _| rng.sample::<f64, _>(StandardNormal)));
        let accepted = tries.find(|values| is_within(values) && self.with_coefficients(values.as_slice()).is_some());
        accepted.unwrap_or_else(|| self.stored.values().into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mixture::{ShipMixture, UncertaintySource};
    use crate::testing;
    use document::IdentifiedShip;
    use ship::{Dynamics, ShipInput};
    use simulate::Manoeuvre;

    fn ship() -> IdentifiedShip {
        IdentifiedShip { hulls: ["quadratic", "cubic", "mmg"].map(testing::hull).into(), ..testing::identified_ship() }
    }

    fn circle(mixture: &ShipMixture, draws: usize) -> crate::Prediction {
        let kind: Manoeuvre = "turning-circle:35".parse().expect("known");
        mixture.predict(&kind, draws, true).expect("a turn")
    }

    /// A ship with hulls is drawn from them by their weights and has a track.
    #[test]
    fn hulls_take_the_place_of_the_structures() {
        let mut stored = ship();
        stored.hulls[0].weight = 2.0;
        let mixture = testing::mixture(stored);
        let is_first = |number| {
            let hull = mixture.draw_ship(number, &[UncertaintySource::Structure]).hull.expect("a hull");
            hull == mixture.most_probable().hull.expect("a hull")
        };
        assert_eq!((0..1000).filter(|&number| is_first(number)).count(), 500);
        let prediction = circle(&mixture, 60);
        for name in ["advance_m", "transfer_m", "tactical_diameter_m", "speed_loss_share", "drift_angle_deg"] {
            let figure = &prediction.figures[name];
            assert!(figure.interval.median > 0.0 && figure.interval.ci90[0] < figure.interval.ci90[1], "{name}");
        }
        let shares = &prediction.figures["advance_m"].shares;
        assert!(["parameters", "structure", "process-noise"].iter().all(|source| shares[*source] > 0.0), "{shares:?}");
        let spiral = mixture.predict(&"spiral:15".parse().expect("known"), 40, true).expect("a curve");
        assert!(spiral.figures["rate_starboard_deg_s"].interval.median > 0.0);
    }

    /// A draw depends on its number alone, not on other draws.
    #[test]
    fn one_number_is_one_draw() {
        let mixture = testing::mixture(ship());
        let draw = |number| mixture.draw_ship(number, &UncertaintySource::ALL).hull.expect("a hull");
        assert_eq!(draw(7), draw(7));
        assert_ne!(draw(7), draw(8));
        assert_eq!(circle(&mixture, 20).figures, circle(&mixture, 20).figures);
        let bound = |hull: &ScaledHull| match &hull.hull.in_calm {
            ship::vessel::prime::CalmHull::Quadratic(values) => values[10] <= 0.9 && values[9] >= 0.005,
            _ => true,
        };
        assert!((0..300).map(draw).all(|hull| bound(&hull)), "coefficients keep within their ends");
    }

    /// At the same Froude number times grow with the root of the scale, including those of the random moment.
    #[test]
    fn a_hull_at_another_scale_moves_alike() {
        let stored = testing::hull("mmg");
        let ratio: f64 = 4.0;
        let (length, speed) = (stored.length_m * ratio, stored.speed_m_s * ratio.sqrt());
        let large = stored.scaled_to(length, speed);
        let of = |stored: &IdentifiedHull, state: [f64; 4]| {
            let mut rate = [0.0; 4];
            let input = ShipInput { rudder: 0.3, disturbance_rudder: 0.02, ..ShipInput::default() };
            HullSampler::new(stored).expect("a hull").most_probable().rates(0.0, &state, &input, &mut rate);
            rate
        };
        let time = ratio.sqrt();
        let small = of(&stored, [0.3, 0.02, 5.0, -0.8]);
        let other = of(&large, [0.3, 0.02 / time, 5.0 * time, -0.8 * time]);
        for (small, other) in small.iter().zip([other[0] * time, other[1] * ratio, other[2], other[3]]) {
            assert!((small - other).abs() <= 1e-12 * small.abs(), "{small} {other}");
        }
        assert_eq!(large.model_error_moment.correlation_s, stored.model_error_moment.correlation_s * time);
        assert_eq!(large.beginning_yaw_rate_rad_s, stored.beginning_yaw_rate_rad_s / time);
        assert_eq!(large.particulars, stored.particulars);
    }

    /// With G the identity and three times the standard deviations, the hull at another loading has the errors of the
    /// hull of the trial and independent errors of eight times their variance. δ_r is equal in both.
    #[test]
    fn a_hull_at_another_loading_follows_that_of_the_trial() {
        let one = testing::hull("quadratic");
        let [full, trial] = [testing::at_same_loading(&one, 3.0), one.clone()]
            .map(|hull| testing::mixture(IdentifiedShip { hulls: vec![hull], ..testing::identified_ship() }));
        let full = full.independent_of(&trial);
        let values = |ship: &ShipMixture, number| {
            let hull = ship.draw_ship(number, &[UncertaintySource::Parameters]).hull.expect("a hull").hull.in_calm;
            let ship::vessel::prime::CalmHull::Quadratic(values) = hull else { panic!("{hull:?}") };
            [0, 8].map(|place| (values[place] - one.coefficients[place].value) / one.covariance[place][place].sqrt())
        };
        let [mut of_full, mut common] = [0.0; 2];
        for number in 0..4000 {
            let [[full, full_bias], [trial, bias]] = [&full, &trial].map(|ship| values(ship, number));
            (of_full, common) = (of_full + full * full / 4000.0, common + full * trial / 4000.0);
            assert_eq!(full_bias, bias);
        }
        assert!((of_full / 9.0 - 1.0).abs() < 0.1 && (common - 1.0).abs() < 0.15, "{of_full} {common}");
    }

    #[test]
    fn what_is_written_is_read_again_and_nonsense_is_refused() {
        let stored = ship();
        let text = serde_json::to_string(&stored).expect("plain data");
        assert_eq!(serde_json::from_str::<IdentifiedShip>(&text).expect("the same"), stored);
        let refused = |change: fn(&mut IdentifiedHull)| {
            let mut hull = testing::hull("mmg");
            change(&mut hull);
            HullSampler::new(&hull).expect_err("refused").to_string()
        };
        assert!(refused(|hull| hull.form = "magic".into()).contains("magic"));
        assert!(refused(|hull| hull.coefficients[0].key = "magic".into()).contains("mmg"));
        assert!(refused(|hull| hull.particulars.clear()).contains("mmg"));
        assert!(refused(|hull| hull.coefficients[0].value = f64::NAN).contains("mmg"));
        assert!(refused(|hull| hull.covariance.truncate(2)).contains("rows"));
        assert!(refused(|hull| hull.covariance[0][0] = f64::NAN).contains("covariance"));
    }
}
