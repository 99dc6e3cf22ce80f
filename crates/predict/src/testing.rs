//! Synthetic ships and records for tests.

use document::{
    HeadingNoise, IdentifiedCoefficient, IdentifiedEffect, IdentifiedGear, IdentifiedHull, IdentifiedShip,
    RandomMoment, RandomYawMoment, ValidityRange, WeightedStructure,
};
use nalgebra::DMatrix;
use ship::angle::from_deg;
use ship::vessel::prime::HullModel;
use ship::vessel::prior::HullParticulars;
use simulate::{Manoeuvre, SimulatedShip, Simulation, StreamKey};
use trial::Trial;

use crate::mixture::{ShipMixture, UncertaintySource};
use crate::standard;

/// Ship of K = 0.1 1/s and T = 16.3 s whose damping grows with the cube of its yaw rate, 75 m long at 6 m/s.
pub(crate) fn identified_ship() -> IdentifiedShip {
    let parameters = vec![1.0 / 16.3, 0.1 / 16.3, 0.0, 60.0];
    let sd = [2e-3, 1.5e-4, 1e-3, 6.0];
    let correlation = |i: usize, j: usize| match (i, j) {
        _ if i == j => 1.0,
        (0, 1) | (1, 0) => 0.8,
        (0, 3) | (3, 0) => -0.5,
        _ => 0.0,
    };
    IdentifiedShip {
        members: vec![WeightedStructure {
            weight: 1.0,
            effects: vec![IdentifiedEffect {
                id: "nonlinear_damping".into(),
                form: "r³".into(),
                constants: Vec::new(),
            }],
            parameters,
            fitted: vec![0, 1, 2, 3],
            covariance: (0..4).map(|i| (0..4).map(|j| correlation(i, j) * sd[i] * sd[j]).collect()).collect(),
            degrees_of_freedom: None,
        }],
        noise: HeadingNoise {
            heading_sd_rad: from_deg(0.1),
            moment: RandomMoment::White { rudder_rad_root_s: from_deg(0.3) },
        },
        gear: Some(IdentifiedGear { rate_rad_s: from_deg(2.5), sd_rad_s: from_deg(0.05) }),
        approach_yaw_rate_rad_s: from_deg(0.01),
        validity_range: ValidityRange { rudder_rad: from_deg(20.0), yaw_rate_rad_s: from_deg(1.5) },
        length_m: Some(75.0),
        speed_m_s: Some(6.0),
        hulls: Vec::new(),
    }
}

/// Hull of a form with the expected coefficients of [`identified_ship`] and a tenth of the expected deviations.
pub(crate) fn hull(form: &str) -> IdentifiedHull {
    let (length_m, speed_m_s) = (75.0, 6.0);
    let particulars = HullParticulars { length: length_m, speed: speed_m_s, ..HullParticulars::default() };
    let forms = HullModel::candidates(Some(&particulars)).into_iter();
    let priors = forms.filter(|candidate| candidate.as_str() == form).flat_map(|form| form.coefficients().to_vec());
    let coefficients: Vec<IdentifiedCoefficient> = priors
        .map(|prior| IdentifiedCoefficient {
            key: prior.key.into(),
            symbol: prior.symbol.into(),
            value: prior.mean,
            expected: prior.mean,
            expected_sd: prior.sd,
        })
        .collect();
    let variance = |coefficient: &IdentifiedCoefficient| (0.1 * coefficient.expected_sd).powi(2);
    let row =
        |i: usize| (0..coefficients.len()).map(|j| if i == j { variance(&coefficients[i]) } else { 0.0 }).collect();
    IdentifiedHull {
        form: form.into(),
        weight: 1.0,
        length_m,
        speed_m_s,
        propeller_per_s: None,
        particulars: [("length-m".into(), length_m), ("speed-m-s".into(), speed_m_s)].into(),
        covariance: (0..coefficients.len()).map(row).collect(),
        coefficients,
        model_error_moment: RandomYawMoment { sd_rudder_rad: from_deg(0.5), correlation_s: 25.0 },
        beginning_yaw_rate_rad_s: from_deg(0.01),
        trial_hull: None,
    }
}

/// Hull converted from another hull at the same loading, with its deviations times `factor`.
pub(crate) fn at_same_loading(hull: &IdentifiedHull, factor: f64) -> IdentifiedHull {
    let form = hull.form().expect("made up");
    let size = hull.coefficients.len();
    let covariance = DMatrix::from_fn(size, size, |i, j| factor * factor * hull.covariance[i][j]);
    let ship = HullParticulars { length: hull.length_m, speed: hull.speed_m_s, ..HullParticulars::default() };
    hull.at_loading(&ship, form.coefficients(), [covariance, DMatrix::identity(size, size)])
}

/// Mixture of one identified ship.
pub(crate) fn mixture(known: IdentifiedShip) -> ShipMixture {
    ShipMixture::new(vec![(known, 1.0)]).expect("made up")
}

/// Record of a drawn ship, a row every `period` s, with noise of the heading in rad; number 0 is the most probable
/// ship in a calm.
pub(crate) fn record(mixture: &ShipMixture, kind: &str, number: u64, noise: f64, period: f64) -> Trial {
    let ship = if number == 0 { mixture.most_probable() } else { mixture.draw_ship(number, &UncertaintySource::ALL) };
    let requested: Manoeuvre = kind.parse().expect("known");
    let manoeuvre = standard::with_predicted_end(&requested, mixture.timescale()).expect("steered");
    let mut simulation = Simulation::new(SimulatedShip::from_response(ship.response), manoeuvre);
    simulation.gear = ship.gear;
    simulation.disturbances = ship.disturbances;
    simulation.sensors.heading_noise = noise;
    simulation.recording.sampling_period = period;
    simulation.run(&StreamKey { seed: 5, cell: 0, replicate: number }).expect("a trial").trial
}
