use super::*;
use crate::dynamics::MeasuredChannels;
use crate::effects::effect::{EffectReal, OperatingPoint};
use crate::number::Tangent;
use estimation::number::Real;

/// Equations of the rows, re-derived by hand: the acting rudder, or the yaw acceleration.
fn by_hand<R: Real>(id: &str, form: &str, p: &[R], now: &OperatingPoint<R>) -> R {
    let OperatingPoint { rudder, K_over_T, yaw_rate: r, measured, .. } = *now;
    match (id, form) {
        ("nonlinear_damping", "r³") => -p[0] * r * r * r,
        ("nonlinear_damping", "r|r|") => -p[0] * r * r.abs(),
        ("nonlinear_damping", "r²") => -p[0] * r * r,
        ("wind_moment", "steady wind") => {
            let (sin, cos) = (now.heading * 2.0).sin_cos();
            K_over_T * (p[0] * cos + p[1] * sin)
        }
        ("wind_moment", "measured wind") => {
            let (speed, from) = (measured.wind_speed.expect("measured"), measured.wind_from.expect("measured"));
            K_over_T * p[0] * speed * speed * from.sin()
        }
        ("rudder_saturation", _) => rudder - p[0] * rudder * rudder * rudder,
        ("rudder_deadband", "dead band") => (rudder.abs() - p[0].at_least(0.0)).at_least(0.0) * rudder.value().signum(),
        ("port_starboard_asymmetry", "gain by side") => rudder + p[0] * rudder.abs(),
        ("port_starboard_asymmetry", "moment by drift") => K_over_T * p[0] * r.abs(),
        ("moment_drift", _) => K_over_T * p[0] * (now.t - 3.25),
        ("sway_coupling_measured", _) => {
            let ratio = measured.speed.map_or(1.0, |speed| speed / 7.3);
            K_over_T * p[0] * (ratio * measured.sway.expect("measured"))
        }
        _ => panic!("{id} ({form}) is not written by hand"),
    }
}

fn rows() -> impl Iterator<Item = &'static ListedFormula> {
    LIST.iter().filter_map(|effect| if let Row(row) = effect { Some(row) } else { None })
}

/// Number from −1 to 1 for every place and round; zero in some rounds.
fn number(round: u32, place: u32) -> f64 {
    match (round + place) % 11 {
        0 => 0.0,
        _ => 2.0 * (f64::from(round) * f64::from(2 + 3 * place).sqrt()).fract() - 1.0,
    }
}

/// Comparison to the last bit, because the published numbers were computed with exactly these operations.
#[test]
fn rows_are_their_equations_to_the_last_bit() {
    for row in rows() {
        let EffectDescription { id, form, parameters, .. } = row.description;
        let formula = Formula::listed(row);
        let constants: Vec<f64> =
            formula.constants().iter().map(|(neutral, _)| if *neutral > 0.0 { 7.3 } else { 3.25 }).collect();
        let formula = formula.with_constants(&constants).expect("as many");
        let acts = Tangent::effect_equations(formula.as_ref());
        for round in 0..500 {
            let variable = |place: u32, size: f64| {
                Tangent::variable(size * number(round, place), place as usize, 0.5 + number(round, place + 20).abs())
            };
            let measured = MeasuredChannels {
                speed: (round % 3 > 0).then(|| 5.0 + number(round, 6)),
                sway: Some(number(round, 7)),
                wind_speed: Some(10.0 * number(round, 8).abs()),
                wind_from: Some(3.0 * number(round, 9)),
                propeller_rate: None,
            };
            let mut now = OperatingPoint {
                t: 100.0 * number(round, 10),
                heading: variable(0, 1.0),
                yaw_rate: variable(1, 0.03),
                rudder: variable(2, 0.6),
                inverse_T: variable(3, 0.1),
                K_over_T: variable(3, 0.01),
                measured: &measured,
            };
            let p = [variable(4, 2.0 * parameters[0].typical), variable(5, 0.03)];
            // Edges of a dead band.
            now.rudder.value = match round % 7 {
                0 => p[0].value,
                1 => 0.0 - p[0].value,
                _ => now.rudder.value,
            };
            let p = &p[..parameters.len()];
            let (value, expected) = match row.acts_on.transforms_rudder {
                true => (acts.rudder(p, &[], now.rudder), by_hand(id, form, p, &now)),
                false => (acts.yaw_acceleration(p, &[], &now), by_hand(id, form, p, &now)),
            };
            // The sign of a zero may differ.
            assert!(value == expected, "{id} ({form}), {round}: {value:?} is not {expected:?}\n{now:?} {p:?}");
        }
    }
}

#[test]
fn a_calm_is_without_wind_waves_and_moments_from_outside() {
    let mut ids: Vec<&str> = ALL.iter().filter(|effect| effect.is_environmental()).map(|effect| effect.id()).collect();
    ids.dedup();
    assert_eq!(ids, ["wind_moment", "moment_drift", "transient_disturbance", "wave_yaw"]);
    assert!(
        !Formula::parse("trend = c * t").expect("a formula").is_environmental(),
        "nobody knows what a formula is of"
    );
}
