//! Prediction of a manoeuvre from a thousand drawn ships.

use document::{
    HeadingNoise, IdentifiedEffect, IdentifiedGear, IdentifiedShip, RandomMoment, ValidityRange, WeightedStructure,
};
use predict::ShipMixture;
use ship::angle::from_deg;
use ship::effects::{Effect, listed_effect};
use simulate::Manoeuvre;

use crate::records::{K, T};
use crate::work::{Work, WorkGroup};

/// Number of drawn ships of a prediction.
const DRAWS: usize = 1000;

/// Model of a ship of 75 m at 6 m/s, with the covariance of an accurate 10/10 zig-zag.
fn identified_ship(effect: Option<&dyn Effect>, moment: RandomMoment) -> IdentifiedShip {
    let damping = effect.map(|effect| IdentifiedEffect {
        id: effect.id().to_owned(),
        form: effect.form().to_owned(),
        constants: Vec::new(),
    });
    let (mut parameters, mut sd) = (vec![1.0 / T, K / T, 0.0], vec![2e-3, 1.5e-4, 1e-3]);
    if damping.is_some() {
        parameters.push(60.0);
        sd.push(6.0);
    }
    let count = parameters.len();
    let variance = |i: usize, j: usize| if i == j { sd[i] * sd[i] } else { 0.0 };
    IdentifiedShip {
        members: vec![WeightedStructure {
            weight: 1.0,
            effects: damping.into_iter().collect(),
            parameters,
            fitted: (0..count).collect(),
            covariance: (0..count).map(|i| (0..count).map(|j| variance(i, j)).collect()).collect(),
            degrees_of_freedom: None,
        }],
        noise: HeadingNoise { heading_sd_rad: from_deg(0.1), moment },
        gear: Some(IdentifiedGear { rate_rad_s: from_deg(2.5), sd_rad_s: from_deg(0.05) }),
        approach_yaw_rate_rad_s: from_deg(0.01),
        validity_range: ValidityRange { rudder_rad: from_deg(10.0), yaw_rate_rad_s: from_deg(1.0) },
        length_m: Some(75.0),
        speed_m_s: Some(6.0),
        hulls: Vec::new(),
    }
}

/// Benchmarks of a 20/20 zig-zag, characteristics and bands, of ships in a calm and in gusts, in closed form and
/// integrated.
pub fn prediction() -> WorkGroup {
    let mut group = WorkGroup::new(
        "predict",
        "Prediction",
        "A 20/20 zig-zag predicted from 1000 drawn ships, on one core: figures of merit with their intervals, and the bands \
         of the heading.",
    );
    let kind: Manoeuvre = "zig-zag:20/20".parse().expect("a manoeuvre");
    let mut add = |name: &str, identified_ship: IdentifiedShip| {
        let mixture = ShipMixture::new(vec![(identified_ship, 1.0)]).expect("a ship");
        let kind = kind.clone();
        let work = Work::new(name, move || mixture.predict(&kind, DRAWS, false).is_ok()).slow();
        group.alone(work, None);
    };
    let size = from_deg(0.5);
    let gusts = RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad: size, correlation_s: 10.0 };
    add("first order, calm", identified_ship(None, RandomMoment::None));
    add("first order, gusts", identified_ship(None, gusts));
    add("first order, white moment", identified_ship(None, RandomMoment::White { rudder_rad_root_s: size }));
    add(
        "cubic damping, calm",
        identified_ship(Some(listed_effect("nonlinear_damping", "r³").as_ref()), RandomMoment::None),
    );
    group
}
