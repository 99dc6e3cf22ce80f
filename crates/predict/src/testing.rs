//! A ship that tests know.

use ship::angle::from_deg;
use simulate::{Manoeuvre, Simulation, StreamKey, Vessel};
use trial::Trial;

use crate::identified_ship::{
    IdentifiedShip, KnownGear, KnownNoise, Moment, StoredEffect, ValidityRange, WeightedStructure,
};
use crate::mixture::{ShipMixture, UncertaintySource};
use crate::standard;

/// A ship of K = 0.1 1/s and T = 16.3 s whose damping grows with the cube of its yaw rate, 75 m long at 6 m/s.
pub(crate) fn known() -> IdentifiedShip {
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
            effects: vec![StoredEffect { id: "nonlinear_damping".into(), form: "r³".into(), constants: Vec::new() }],
            parameters,
            fitted: vec![0, 1, 2, 3],
            covariance: (0..4).map(|i| (0..4).map(|j| correlation(i, j) * sd[i] * sd[j]).collect()).collect(),
            degrees_of_freedom: None,
        }],
        noise: KnownNoise {
            heading_sd_rad: from_deg(0.1),
            moment: Moment::White,
            moment_sd_rudder_rad: from_deg(0.3),
            moment_correlation_s: None,
        },
        gear: Some(KnownGear { rate_rad_s: from_deg(2.5), sd_rad_s: from_deg(0.05) }),
        approach_yaw_rate_rad_s: from_deg(0.01),
        seen: ValidityRange { rudder_rad: from_deg(20.0), yaw_rate_rad_s: from_deg(1.5) },
        length_m: Some(75.0),
        speed_m_s: Some(6.0),
        motion: None,
        hull: None,
    }
}

/// The ships of what is known.
pub(crate) fn mixture(known: IdentifiedShip) -> ShipMixture {
    ShipMixture::new(vec![(known, 1.0)]).expect("made up")
}

/// A record of a drawn ship, a row every `period` s, with noise of the heading in rad; with number 0 of the most
/// probable one in a calm.
pub(crate) fn record(mixture: &ShipMixture, kind: &str, number: u64, noise: f64, period: f64) -> Trial {
    let ship = if number == 0 { mixture.most_probable() } else { mixture.draw(number, &UncertaintySource::ALL) };
    let asked: Manoeuvre = kind.parse().expect("known");
    let manoeuvre = standard::steered(&asked, mixture.timescale()).expect("steered");
    let mut simulation = Simulation::new(Vessel::response(ship.response), manoeuvre);
    simulation.gear = ship.gear;
    simulation.disturbances = ship.disturbances;
    simulation.sensors.heading_noise = noise;
    simulation.recording.period = period;
    simulation.run(&StreamKey { seed: 5, cell: 0, replicate: number }).expect("a trial").trial
}
