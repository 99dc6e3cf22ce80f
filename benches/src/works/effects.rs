//! Cost of formulas: replay of a record with an effect of the list, and with the same equation written in Rust.

use std::sync::Arc;

use ship::effects::{
    CandidateEffect, Effect, EffectDescription, EffectEquations, EffectReal, EffectTarget, OperatingPoint,
    RecordScales, listed_effect,
};
use ship::replay::{RecordedSignals, replay_states};
use ship::{Dynamics, Polyline, Real, ResponseModel, Tangent};

use crate::records::{K, ROWS, T, first_order_zig_zag, record};
use crate::work::{Reach, Work, WorkGroup};

/// r' = … − (n₃/T) r³, in Rust.
#[derive(Debug)]
struct CubicByHand;

impl Effect for CubicByHand {
    fn description(&self) -> EffectDescription {
        listed_effect("nonlinear_damping", "r³").description()
    }

    fn candidate(&self, _about: &RecordScales) -> Option<CandidateEffect> {
        None
    }

    fn acts_on(&self) -> EffectTarget {
        EffectTarget::MOMENT
    }
}

impl<R: Real> EffectEquations<R> for CubicByHand {
    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &OperatingPoint<R>) -> R {
        let r = now.yaw_rate;
        -p[0] * r * r * r
    }
}

/// Heading at the end of a replay.
fn replayed<R: EffectReal>(effect: Arc<dyn Effect>, rudder: &Polyline) -> R {
    let values = [1.0 / T, K / T, 0.0, 60.0];
    let response = ResponseModel::new(vec![effect]).with_parameters(values.map(R::from).to_vec());
    let mut state = vec![R::default(); response.dimension()];
    let recorded = RecordedSignals::from_rudder(rudder);
    replay_states(&response, &recorded, rudder.times(), |_, _| 0.25, &mut state, |_, _, _| {});
    state[0]
}

/// Replays in plain numbers and in dual numbers, with a formula and with the equation in Rust.
pub fn effects() -> WorkGroup {
    let mut group = WorkGroup::new(
        "effects",
        "Formulas",
        "A record of 600 s replayed with damping that grows with r³, on one core: as a row of the list of effects, which is \
         a formula, and as the same equation written in Rust; in plain numbers, and with six derivatives.",
    );
    let trial = record(&first_order_zig_zag(ROWS));
    let rudder = Polyline::new(trial.time().to_vec(), trial.rudder().to_vec()).expect("increasing times");
    let mut pair = |kind: &str, go: fn(Arc<dyn Effect>, &Polyline) -> f64| {
        let (one, other) = (rudder.clone(), rudder.clone());
        let by_hand = Work::new(format!("by hand, {kind}"), move || go(Arc::new(CubicByHand), &one));
        let by_hand = group.alone(by_hand, None);
        let formula =
            Work::new(format!("formula, {kind}"), move || go(listed_effect("nonlinear_damping", "r³"), &other));
        group.beside(formula, &by_hand, Some(Reach::Ratio(3.0)));
    };
    pair("plain", replayed::<f64>);
    pair("with derivatives", |effect, rudder| replayed::<Tangent>(effect, rudder).value);
    group
}
