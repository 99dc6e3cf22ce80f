//! Figures of K and T, and of the phase plane, that `study fit` and `study trace` have in common.

use identify::Estimate;
use identify::estimate::Uncertainty;
use identify::replay::Replay;
use report::figures::{
    Amplitude, AmplitudePanel, AmplitudePoint, IndexAnswer, IndexPlane, PhaseCurve, PhasePlane, Reference95,
};
use report::{Curve, Origin, symbol};
use ship::Particulars;
use ship::angle::to_deg;
use trial::zigzag::PhasePlane as Phase;
use trial::{Quantity, Trial};

use crate::work::alone::{Alone, Amplitudes};
use campaign::answer::MethodEntry;

/// Radians a second over radians, as degrees.
fn phase_curve(heading: &[f64], yaw_rate: &[f64]) -> Curve {
    let degrees = |values: &[f64]| values.iter().copied().map(to_deg).collect::<Vec<f64>>();
    Curve { x: degrees(heading), y: degrees(yaw_rate) }
}

/// The way of a replay.
pub fn phase_of(origin: Origin, replay: &Replay) -> PhaseCurve {
    PhaseCurve { origin, name: None, curve: phase_curve(&replay.heading, &replay.yaw_rate) }
}

/// The way of any passage.
pub fn phase_named(name: &str, heading: &[f64], yaw_rate: &[f64]) -> PhaseCurve {
    PhaseCurve { origin: Origin::After, name: Some(name.to_owned()), curve: phase_curve(heading, yaw_rate) }
}

/// A record in the phase plane with models of it.
pub fn phase_plane(title: String, trial: &Trial, fits: Vec<PhaseCurve>) -> PhasePlane {
    let phase = Phase::of(trial);
    PhasePlane {
        title: Some(title),
        record: phase.as_ref().map_or_else(Curve::default, |phase| phase_curve(&phase.heading, &phase.yaw_rate)),
        smoothed: phase.is_some_and(|phase| phase.smoothed),
        fits,
        drawn: Vec::new(),
    }
}

/// K and T of all methods that have an answer, prime where the ship is known.
pub fn index_plane(
    title: String,
    answers: &[(MethodEntry, Option<Estimate>)],
    ship: Option<Particulars>,
) -> IndexPlane {
    let [by_k, by_t] = factors(ship);
    let answer = |(entry, estimate): &(MethodEntry, Option<Estimate>)| {
        let estimate = estimate.as_ref()?;
        let place = (by_k * estimate.response.K(), by_t * estimate.response.T());
        let outline = match &estimate.uncertainty {
            Uncertainty::Covariance(covariance) => covariance.outline(&estimate.response),
            _ => None,
        };
        let (x, y): (Vec<f64>, Vec<f64>) = outline.into_iter().flatten().map(|[k, t]| (by_k * k, by_t * t)).unzip();
        let origin = Origin::Method(entry.method.clone());
        Some(IndexAnswer { origin, place, region: Curve { x, y } })
    };
    IndexPlane { title: Some(title), prime: ship.is_some(), answers: answers.iter().filter_map(answer).collect() }
}

/// What K and T are multiplied with in a figure.
fn factors(ship: Option<Particulars>) -> [f64; 2] {
    ship.map_or([1.0; 2], |ship| [ship.prime([-1, 0]), ship.prime([1, 0])])
}

/// K and T of every record alone over its amplitude, with those of all together.
pub fn amplitude(
    title: String,
    all: &Amplitudes,
    joint: Option<[Quantity; 2]>,
    ship: Option<Particulars>,
) -> Amplitude {
    let name = |letter: &str, unit: &str| match ship {
        Some(_) => symbol(&format!("{letter}′")),
        None => format!("{} [{unit}]", symbol(letter)),
    };
    let panel = |place: usize, letter: &str, unit: &str| {
        let factor = factors(ship)[place];
        let of = |own: &Alone| [own.k, own.t][place].scaled(factor);
        let joint = joint.map(|joint| joint[place].scaled(factor)).filter(|joint| joint.value.is_finite());
        AmplitudePanel {
            title: name(letter, unit),
            points: all
                .records
                .iter()
                .map(|own| AmplitudePoint {
                    amplitudes_deg: own.amplitudes.map(to_deg),
                    value: of(own).value,
                    interval: of(own).ci95,
                })
                .collect(),
            joint: joint.map(|own| Reference95 { value: own.value, band: own.ci95.unwrap_or([own.value; 2]) }),
        }
    };
    Amplitude {
        title: Some(title),
        x_titles: [format!("rudder {} [°]", symbol("δ")), format!("peak heading {} [°]", symbol("ψ"))],
        origin: Origin::Method(all.method.to_owned()),
        joint_name: String::from("all records together, 95 %"),
        panels: vec![panel(0, "K", "1/s"), panel(1, "T", "s")],
    }
}
