//! List of effects, in the order of reports. An effect that is algebraic in the signals is a row with a formula; an
//! effect with memory or states is written in Rust.

use std::sync::{Arc, LazyLock};

use super::backlash::Backlash;
use super::effect::{Effect, EffectDescription, EffectTarget, Parameter};
use super::formula::{Formula, ListedFormula, ListedPrior};
use super::scenario_key::NumberConversion::{Direction, OverT};
use super::scenario_key::{PER_DEGREE, PER_DEGREE_SQUARED};
use super::second_order::SecondOrder;
use super::speed_loss::SpeedLoss;
use super::steering_lag::SteeringLag;
use super::transient_disturbance::TransientDisturbance;
use super::wave_heading::WaveHeading;
use crate::angle::DEGREE;
use ListedEffect::{Row, Rust};

/// Entry of the list: one effect in one form.
pub(super) enum ListedEffect {
    /// Effect written as a formula.
    Row(ListedFormula),
    /// Effect written in Rust.
    Rust(fn() -> Arc<dyn Effect>),
}

/// Row: identifier, form and equation; quantity on which the effect acts, and its formula; parameters in the order in
/// which the formula names them, with their keys in scenario files; prior (mean, standard deviation and maximum) in
/// given records.
///
/// With [`EffectTarget::RUDDER`] the formula is the acting rudder, from `delta` alone, rad; with
/// [`EffectTarget::MOMENT`] a yaw acceleration, rad/s²: `K_over_T` times a moment as equivalent rudder angle.
const fn row(
    [id, form, equation]: [&'static str; 3],
    acts_on: EffectTarget,
    formula: &'static str,
    parameters: &'static [Parameter],
    prior: ListedPrior,
) -> ListedEffect {
    let description = EffectDescription { id, form, equation, parameters };
    Row(ListedFormula { description, acts_on, formula, prior, is_weather: false })
}

/// Row of a moment of the weather.
const fn weather(
    [id, form, equation]: [&'static str; 3],
    formula: &'static str,
    parameters: &'static [Parameter],
    prior: ListedPrior,
) -> ListedEffect {
    let description = EffectDescription { id, form, equation, parameters };
    Row(ListedFormula { description, acts_on: EffectTarget::MOMENT, formula, prior, is_weather: true })
}

/// Maximum of a prior that is limited by the range of its parameter alone.
const UNBOUNDED: f64 = f64::INFINITY;

/// List of effects. The order of factors in a formula determines the last bit of the published numbers.
#[rustfmt::skip]
pub(super) static LIST: [ListedEffect; 22] = [
    Rust(|| Arc::new(SecondOrder)),
    // Norrbin (1963) for r|r| and r³; Bech (1968) for the polynomial T₁T₂ r'' + (T₁+T₂) r' + K H(r) = K (δ + T₃ δ'), H
    // = b₃r³ + b₂r² + b₁r + b₀. It is the second-order effect with n₃/T = K b₃/T, n₁₁/T = K b₂/T, 1/T times K b₁, and
    // δ_r = −b₀. Divided by T a coefficient stays regular when 1/T passes through zero. Nondimensional prior standard
    // deviations: 8 for r³, 1.2 for r|r|, 0.4 for r² (damping that differs by side).
    row(["nonlinear_damping", "r³", "T r' + r + n₃ r³ = K (δ + δ_r)"],
        EffectTarget::MOMENT, "-n3_over_T * r * r * r",
        &[Parameter::even(["n3_over_T", "n₃/T", "s/rad²"], [0.0, 40.0], [0.0, 1e7])
            .with_scenario_key("n3-s2-per-deg2", PER_DEGREE_SQUARED, "+ n3 r³ on the left (Norrbin, Bech).")
            .with_conversion(OverT)],
        |records| Some([0.0, 8.0 * records.ship_length_time, UNBOUNDED])),
    row(["nonlinear_damping", "r|r|", "T r' + r + n₂ r|r| = K (δ + δ_r)"],
        EffectTarget::MOMENT, "-n2_over_T * r * abs(r)",
        &[Parameter::even(["n2_over_T", "n₂/T", "1/rad"], [0.0, 0.7], [0.0, 1e4])
            .with_scenario_key("n2-s-per-deg", PER_DEGREE, "+ n2 r|r| on the left.").with_conversion(OverT)],
        |_| Some([0.0, 1.2, UNBOUNDED])),
    row(["nonlinear_damping", "r²", "T r' + r + n₁₁ r² = K (δ + δ_r)"],
        EffectTarget::MOMENT, "-n11_over_T * r * r",
        &[Parameter::odd(["n11_over_T", "n₁₁/T", "1/rad"], [0.0, 0.2], [-1e3, 1e3])
            .with_scenario_key("n11-s-per-deg", PER_DEGREE, "+ n11 r² on the left.").with_conversion(OverT)],
        |_| Some([0.0, 0.4, UNBOUNDED])),
    // Prior standard deviation: the moment of 0.05 rad of rudder in a beam wind of the root mean square speed.
    weather(["wind_moment", "measured wind", "T r' + r = K (δ + δ_r + c_w U_rel² sin γ_rel)"],
        "K_over_T * c_w * wind_speed * wind_speed * sin(wind_angle)",
        &[Parameter::even(["c_w", "c_w", "rad s²/m²"], [0.0, 0.01], [-10.0, 10.0])],
        |records| Some([0.0, 0.05 / records.mean_square_wind_speed?, UNBOUNDED])),
    // w sin 2(ψ_w − ψ): steady wind of unknown strength and direction. A moderate wind has the moment of 0.025 rad of
    // rudder.
    weather(["wind_moment", "steady wind", "T r' + r = K (δ + δ_r + w_c cos 2ψ + w_s sin 2ψ)"],
        "K_over_T * (w_c * cos(2 * psi) + w_s * sin(2 * psi))",
        &[Parameter::odd(["w_c", "w_c", "rad"], [0.0, 0.02], [-0.6, 0.6])
            .with_scenario_key("rudder-deg", DEGREE, "Largest moment, as rudder angle."),
          Parameter::even(["w_s", "w_s", "rad"], [0.0, 0.02], [-0.6, 0.6])
            .with_scenario_key("from-deg", DEGREE, "Direction the wind comes from, clockwise from north.")
            .with_conversion(Direction)],
        |_| Some([0.0, 0.025, UNBOUNDED])),
    Rust(|| Arc::new(SpeedLoss::Modelled)),
    Rust(|| Arc::new(SpeedLoss::Measured { approach_speed: 1.0 })),
    Rust(|| Arc::new(SpeedLoss::Inflow { approach_speed: 1.0, approach_revolutions: 1.0 })),
    Rust(|| Arc::new(SpeedLoss::Propeller { approach_revolutions: 1.0 })),
    Rust(|| Arc::new(SteeringLag::DeadTime)),
    Rust(|| Arc::new(SteeringLag::FirstOrder)),
    // A rudder that loses lift at large angles. Half of sin 2δ, the side force of a rudder whose lift is normal to its
    // blade, is δ − ⅔ δ³; the yaw rate of the hull reduces that angle. Within the rudder angles of the records the
    // effect grows with the angle: c₃ < 1/(3 δ²).
    row(["rudder_saturation", "stall", "T r' + r = K (δ − c₃ δ³ + δ_r)"],
        EffectTarget::RUDDER, "delta - c3 * delta * delta * delta",
        &[Parameter::even(["c3", "c₃", "1/rad²"], [0.0, 0.5], [-2.0, 5.0])
            .with_scenario_key("c3-per-deg2", PER_DEGREE_SQUARED, "Coefficient c3.")],
        |records| Some([0.0, 0.4, (records.max_rudder * records.max_rudder * 3.0).recip()])),
    Rust(|| Arc::new(Backlash)),
    // Angles below g have no effect; larger angles act with g subtracted.
    row(["rudder_deadband", "dead band", "T r' + r = K (sgn δ max(|δ| − g, 0) + δ_r)"],
        EffectTarget::RUDDER, "max(abs(delta) - max(g, 0), 0) * (1 - 2 * step(-delta))",
        &[Backlash::HALF_WIDTH.with_scenario_key("dead-band-deg", DEGREE, "Half width of a dead band.")],
        |records| Some(Backlash::prior(records))),
    // The gain is 1 + a to starboard and 1 − a to port.
    row(["port_starboard_asymmetry", "gain by side", "T r' + r = K (δ + a |δ| + δ_r)"],
        EffectTarget::RUDDER, "delta + a * abs(delta)",
        &[Parameter::odd(["a", "a", "1"], [0.0, 0.05], [-0.8, 0.8])
            .with_scenario_key("gain-share", 1.0,
                               "Share a of K (δ + a |δ|); above 0 the rudder acts more to starboard.")],
        |_| Some([0.0, 0.12, UNBOUNDED])),
    // Moment that is even in the yaw rate, and so in the drift that accompanies it. A rudder whose inflow is
    // straightened differently on either side causes it (Yasukawa and Yoshimura 2015, γ_R).
    row(["port_starboard_asymmetry", "moment by drift", "T r' + r = K (δ + c_r |r| + δ_r)"],
        EffectTarget::MOMENT, "K_over_T * c_r * abs(r)",
        &[Parameter::odd(["c_r", "c_r", "s"], [0.0, 0.5], [-1e3, 1e3])
            .with_scenario_key("moment-by-drift-s", 1.0,
                               "Time c_r of K (δ + c_r |r|); above 0 the moment is to starboard in any turn.")],
        |records| Some([0.0, 0.1 * records.ship_length_time, UNBOUNDED])),
    // The trend starts with the record, which separates it from δ_r.
    weather(["moment_drift", "linear trend", "T r' + r = K (δ + δ_r + m (t − t₀))"],
        "K_over_T * m * (t - start)",
        &[Parameter::odd(["m", "m", "rad/s"], [0.0, 7e-5], [-0.01, 0.01])
            .with_scenario_key("rudder-deg-per-s", DEGREE, "Change of the moment, as rudder angle.")],
        |records| Some([0.0, 0.02 / records.duration, UNBOUNDED])),
    Rust(|| Arc::new(TransientDisturbance::Passing)),
    Rust(|| Arc::new(TransientDisturbance::Lasting { edge: 1.0 })),
    Rust(|| Arc::new(WaveHeading)),
    // The moment of a drifting hull is N_v u v, so it falls with the measured speed. For hulls N_v/N_δ is −3 ± 1.5,
    // nondimensional.
    row(["sway_coupling_measured", "measured sway", "T r' + r = K (δ + δ_r + c_v q v), q = U/U₀"],
        EffectTarget::MOMENT, "K_over_T * c_v * (q * v)",
        &[Parameter::even(["c_v", "c_v", "rad s/m"], [0.0, 0.1], [-100.0, 100.0])],
        |records| records.approach_speed_for_sway.map(|speed| [-3.0 / speed, 1.5 / speed, UNBOUNDED])),
];

/// Meanings of the effects that a scenario can add.
const MEANINGS: [(&str, &str); 11] = [
    ("second_order", "Sway coupling: T1 T2 r'' + (T1 + T2) r' + r = K (δ + δ_r) + K T3 δ'"),
    ("nonlinear_damping", "Damping that grows with the yaw rate"),
    ("wind_moment", "A yaw moment of steady wind, by the heading"),
    ("speed_loss", "Speed that falls in the turn: K ~ U, T ~ 1/U"),
    ("steering_lag", "A rudder that acts later than the one recorded"),
    ("rudder_saturation", "Stall: the rudder acts as δ − c3 δ³"),
    ("rudder_deadband", "Play between the recorded rudder and the one that acts"),
    ("port_starboard_asymmetry", "A ship that turns more readily to one side"),
    ("moment_drift", "A slow trend of the yaw moment"),
    ("transient_disturbance", "A moment for a part of the record"),
    ("wave_yaw", "Narrow-band yaw from waves"),
];

static ALL: LazyLock<Vec<Arc<dyn Effect>>> = LazyLock::new(|| {
    let made = |listed: &ListedEffect| -> Arc<dyn Effect> {
        match listed {
            Row(row) => Arc::new(Formula::listed(row)),
            Rust(make) => make(),
        }
    };
    LIST.iter().map(made).collect()
});

/// Every effect in every form, in the order of reports.
///
/// Constants of the record are at their neutral values: approach speed 1 m/s, one propeller revolution a second, first
/// time 0 s, edge of a lasting moment 1 s.
pub fn all_effects() -> Vec<Arc<dyn Effect>> {
    ALL.clone()
}

/// Meaning of an effect, without a full stop; empty for an effect that no scenario can add.
pub fn effect_meaning(id: &str) -> &'static str {
    MEANINGS.iter().find(|(other, _)| *other == id).map_or("", |(_, meaning)| meaning)
}

/// Effect of the list with this identifier and form.
///
/// # Panics
/// If there is none: a programming error, not a user's error.
pub fn listed_effect(id: &str, form: &str) -> Arc<dyn Effect> {
    let effect = ALL.iter().find(|effect| (effect.id(), effect.form()) == (id, form));
    Arc::clone(effect.unwrap_or_else(|| panic!("no effect of the list is {id} ({form})")))
}

#[cfg(test)]
mod tests;
