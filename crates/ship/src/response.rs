//! Response models: a first-order base and any number of effects, as one system of differential equations.
//!
//! ψ' = r,  r' = −a s_a r + b s_b (δ_e + δ_r + disturbance) + Σ accelerations of effects,
//!
//! with δ_e the recorded rudder after dead time and every transformation, and s_a, s_b the products of the factors of
//! the effects. With [`SecondOrderTimeConstants`] the right-hand side f becomes the rate of an extra state s, and T₂ r'
//! = s − (1 + T₂ a s_a) r + b s_b T₃ (δ_e + δ_r). This is T₁T₂ r'' + (T₁+T₂) r' + r + n(r) = K (δ + δ_r) + K T₃ δ' with
//! T₁ = 1/a (Liénard form: no derivative of the rudder is needed, and a Bech polynomial in r stays a term of f).
//!
//! Sources: Nomoto, Taguchi, Honda and Hirano (1957), On the steering qualities of ships; Bech and Wagner Smitt (1969),
//! Analogue simulation of ship manoeuvres.

use std::ops::Range;
use std::sync::Arc;

use crate::dynamics::{Dynamics, Motion, RegressorChannel, ShipInput};
use crate::effects::{
    BaseFactors, Effect, EffectReal, EffectTarget, OperatingPoint, Parameter, SecondOrderTimeConstants,
};
use crate::first_order::FirstOrder;
use crate::number::Tangent;
use crate::replayable::{Replayable, ReplayedShip, ResolvedTimeConstants};

/// Number of base parameters: a = 1/T, b = K/T, δ_r.
pub const BASE_PARAMETER_COUNT: usize = 3;

/// Base parameters a = 1/T (1/s), b = K/T (1/s²) and δ_r (rad).
pub const BASE_PARAMETERS: [Parameter; BASE_PARAMETER_COUNT] = [
    Parameter::even(["inverse_T", "1/T", "1/s"], [0.05, 0.05], [-10.0, 10.0]),
    Parameter::even(["K_over_T", "K/T", "1/s²"], [5e-3, 5e-3], [0.0, 100.0]),
    Parameter::odd(["rudder_bias", "δ_r", "rad"], [0.0, 0.02], [-0.6, 0.6]),
];

/// Index ranges of the parameters and states of one effect, and the quantities on which it acts.
#[derive(Debug, Clone, Copy)]
struct Place {
    parameters: (usize, usize),
    states: (usize, usize),
    acts_on: EffectTarget,
}

impl Place {
    #[inline]
    fn parameters(&self) -> Range<usize> {
        self.parameters.0..self.parameters.1
    }

    #[inline]
    fn states(&self) -> Range<usize> {
        self.states.0..self.states.1
    }
}

/// Structure of a response model: base plus effects. Parameter values are separate, base first.
#[derive(Debug, Clone, Default)]
pub struct ResponseModel {
    effects: Vec<Arc<dyn Effect>>,
    places: Vec<Place>,
    parameters: usize,
    states: usize,
    /// Number of effects up to and including the last effect with states; later effects have no memory to advance.
    with_memory: usize,
    /// Index of the effect that makes the response second-order, whose first state is s; `None` for a first-order
    /// response.
    second_order: Option<usize>,
}

/// Combined action of the effects at one instant.
struct Instant<R> {
    rudder: R,
    scale: BaseFactors<R>,
    acceleration: R,
}

impl ResponseModel {
    /// First-order base with effects; the rudder passes through them in this order.
    pub fn new(effects: Vec<Arc<dyn Effect>>) -> Self {
        let (mut parameters, mut states) = (BASE_PARAMETER_COUNT, 2);
        let mut places = Vec::with_capacity(effects.len());
        let (mut second_order, mut with_memory) = (None, 0);
        for (index, effect) in effects.iter().enumerate() {
            let place = Place {
                parameters: (parameters, parameters + effect.parameters().len()),
                states: (states, states + effect.states()),
                acts_on: effect.acts_on(),
            };
            (parameters, states) = (place.parameters.1, place.states.1);
            if effect.states() > 0 {
                with_memory = index + 1;
            }
            let neutral: Vec<f64> = effect.parameters().iter().map(|p| p.typical).collect();
            if f64::effect_equations(effect.as_ref()).second_order_time_constants(&neutral).is_some() {
                second_order = Some(index);
            }
            places.push(place);
        }
        Self { effects, places, parameters, states, with_memory, second_order }
    }

    /// First-order response without effects.
    pub fn first_order() -> Self {
        Self::new(Vec::new())
    }

    /// Effects, in the order in which the rudder passes through them.
    pub fn effects(&self) -> &[Arc<dyn Effect>] {
        &self.effects
    }

    /// Effects, each with the index range of its parameters.
    pub fn effects_with_ranges(&self) -> impl Iterator<Item = (&dyn Effect, Range<usize>)> {
        self.effects.iter().zip(&self.places).map(|(effect, place)| (effect.as_ref(), place.parameters()))
    }

    /// Number of parameters, base included.
    pub fn parameter_count(&self) -> usize {
        self.parameters
    }

    /// Parameters in the order of their values, base first.
    pub fn parameters(&self) -> impl Iterator<Item = &'static Parameter> {
        BASE_PARAMETERS.iter().chain(self.effects.iter().flat_map(|effect| effect.parameters()))
    }

    /// Response with these parameter values.
    ///
    /// # Panics
    /// If the number of values is not [`parameter_count`](Self::parameter_count): a programming error, not a user's
    /// error.
    pub fn with_parameters<R: EffectReal>(self, parameters: Vec<R>) -> Response<R> {
        assert_eq!(parameters.len(), self.parameters, "one value per parameter");
        let coupling = self.second_order.and_then(|index| {
            let place = self.places[index];
            let effect = R::effect_equations(self.effects[index].as_ref());
            Some((effect.second_order_time_constants(&parameters[place.parameters()])?, place.states.0))
        });
        Response { model: self, parameters, coupling }
    }
}

/// Response model with its parameter values: a ship that can be simulated or replayed.
///
/// Parameters in dual numbers give motion in dual numbers.
#[derive(Debug, Clone)]
pub struct Response<R = f64> {
    model: ResponseModel,
    parameters: Vec<R>,
    /// T₂ and T₃ of a second-order response, and the index of its state s; `None` for a first-order response.
    coupling: Option<(SecondOrderTimeConstants<R>, usize)>,
}

impl Response {
    /// First-order ship without effects.
    pub fn first_order_ship(base: FirstOrder) -> Self {
        ResponseModel::first_order().with_parameters(vec![base.inverse_T, base.K_over_T, base.rudder_bias])
    }

    /// Base parameters a = 1/T, b = K/T and δ_r.
    pub fn first_order(&self) -> FirstOrder {
        FirstOrder { inverse_T: self.parameters[0], K_over_T: self.parameters[1], rudder_bias: self.parameters[2] }
    }

    /// Random headings that the effects add to the observed heading.
    pub fn random_headings(&self) -> impl Iterator<Item = crate::narrow_band::NarrowBandProcess> {
        self.effects().filter_map(|(effect, p, _)| effect.random_heading(p))
    }

    /// Ship in another number type, with constant parameters.
    pub fn to_real<R: EffectReal>(&self) -> Response<R> {
        self.model.clone().with_parameters(self.parameters.iter().map(|&value| R::from(value)).collect())
    }
}

impl<R: EffectReal> Response<R> {
    /// Structure of the response: base and effects, without parameter values.
    pub fn model(&self) -> &ResponseModel {
        &self.model
    }

    /// Parameter values, base first.
    pub fn parameters(&self) -> &[R] {
        &self.parameters
    }

    /// Shortest time constant of base and effects, s.
    pub fn min_time_constant(&self) -> f64 {
        self.time_constants().shortest(f64::NEG_INFINITY, f64::INFINITY)
    }

    fn effects(&self) -> impl Iterator<Item = (&dyn Effect, &[R], Place)> {
        self.model
            .effects
            .iter()
            .zip(&self.model.places)
            .map(|(effect, &place)| (effect.as_ref(), &self.parameters[place.parameters()], place))
    }

    fn now<'a>(&self, t: f64, state: &[R], rudder: R, input: &'a ShipInput<R>) -> OperatingPoint<'a, R> {
        OperatingPoint {
            t,
            heading: state[0],
            yaw_rate: state[1],
            rudder,
            inverse_T: self.parameters[0],
            K_over_T: self.parameters[1],
            measured: &input.measured,
        }
    }

    #[inline]
    fn instant(&self, t: f64, state: &[R], input: &ShipInput<R>) -> Instant<R> {
        let mut rudder = input.rudder;
        for (effect, p, place) in self.effects().filter(|(.., place)| place.acts_on.transforms_rudder) {
            rudder = R::effect_equations(effect).rudder(p, &state[place.states()], rudder);
        }
        let now = self.now(t, state, rudder, input);
        let mut scale = BaseFactors::unity();
        let mut acceleration = R::from(0.0);
        for (effect, p, place) in self.effects() {
            let z = &state[place.states()];
            if place.acts_on.scales_response {
                let factor = R::effect_equations(effect).base_factors(p, z, &now);
                scale.damping = scale.damping * factor.damping;
                scale.gain = scale.gain * factor.gain;
            }
            if place.acts_on.adds_moment {
                acceleration = acceleration + R::effect_equations(effect).yaw_acceleration(p, z, &now);
            }
        }
        Instant { rudder, scale, acceleration }
    }

    /// Right-hand side f of the module's equation, and r', which differs from f for a second-order response.
    #[inline]
    fn accelerations(&self, state: &[R], input: &ShipInput<R>, instant: &Instant<R>) -> (R, R) {
        let a = self.parameters[0] * instant.scale.damping;
        let b = self.parameters[1] * instant.scale.gain;
        let steering = instant.rudder + self.parameters[2] + input.disturbance_rudder;
        let f = -a * state[1] + b * steering + instant.acceleration;
        match &self.coupling {
            Some((coupling, s)) => {
                let (t2, t3) = (coupling.T2, coupling.T3);
                let lead = b * t3 * (instant.rudder + self.parameters[2]);
                (f, (state[*s] - (t2 * a + 1.0) * state[1] + lead) / t2)
            }
            None => (f, f),
        }
    }
}

impl<R: EffectReal> Replayable<R> for Response<R> {
    /// `true` if an effect of this response uses this measured channel.
    fn needs(&self, channel: RegressorChannel) -> bool {
        self.model.effects.iter().any(|effect| effect.uses(channel))
    }

    /// Time constants that steps must resolve.
    fn time_constants(&self) -> ResolvedTimeConstants {
        let values: Vec<f64> = self.parameters.iter().map(|p| p.value()).collect();
        let mut pace = ResolvedTimeConstants::at_all_times(values[0].abs().recip());
        for (effect, place) in self.model.effects.iter().zip(&self.model.places) {
            let p = &values[place.parameters()];
            let (time, span) = (effect.min_time_constant(p), effect.fast_span(p));
            pace.add(span, time);
        }
        pace
    }

    /// Initial state of a record that begins with this heading (rad), yaw rate (rad/s) and input: the states of the
    /// effects are those of a straight approach at a constant rudder angle.
    fn initialise(&self, heading: R, yaw_rate: R, input: &ShipInput<R>, state: &mut [R]) {
        state.fill(R::from(0.0));
        (state[0], state[1]) = (heading, yaw_rate);
        let mut now = self.now(0.0, &[heading, yaw_rate], input.rudder, input);
        for (effect, p, place) in self.effects() {
            let z = &mut state[place.states()];
            R::effect_equations(effect).approach(p, &now, z);
            now.rudder = R::effect_equations(effect).rudder(p, z, now.rudder);
        }
        if let Some((coupling, s)) = self.coupling {
            // Initial yaw acceleration of the first-order response, so that T₂ = T₃ reproduces that response.
            let lead = coupling.T2 - coupling.T3;
            state[s] = yaw_rate + self.parameters[1] * lead * (now.rudder + self.parameters[2]);
        }
    }

    /// Sets heading (rad) and yaw rate (rad/s) of a state and keeps the memory of all effects. The state s of a
    /// second-order response is adjusted so that the yaw acceleration is unchanged, except for effects that scale the
    /// damping.
    fn reset_motion(&self, heading: R, yaw_rate: R, state: &mut [R]) {
        let change = yaw_rate - state[1];
        (state[0], state[1]) = (heading, yaw_rate);
        if let Some((coupling, s)) = self.coupling {
            state[s] = state[s] + (coupling.T2 * self.parameters[0] + 1.0) * change;
        }
    }
}

impl ReplayedShip for Response {
    fn tangent(&self) -> Box<dyn Replayable<Tangent>> {
        Box::new(self.to_real::<Tangent>())
    }
}

impl<R: EffectReal> Dynamics<R> for Response<R> {
    fn dimension(&self) -> usize {
        self.model.states
    }

    fn approach(&self, heading: R, yaw_rate: R, state: &mut [R]) {
        self.initialise(heading, yaw_rate, &ShipInput::default(), state);
    }

    fn rates(&self, t: f64, state: &[R], input: &ShipInput<R>, rate: &mut [R]) {
        if self.model.effects.is_empty() {
            let [a, b, bias] = [self.parameters[0], self.parameters[1], self.parameters[2]];
            rate[0] = state[1];
            rate[1] = -a * state[1] + b * (input.rudder + bias + input.disturbance_rudder);
            return;
        }
        let instant = self.instant(t, state, input);
        let (f, yaw_acceleration) = self.accelerations(state, input, &instant);
        rate[0] = state[1];
        rate[1] = yaw_acceleration;
        if self.model.states > 2 {
            let now = self.now(t, state, instant.rudder, input);
            let mut before = input.rudder;
            for (effect, p, place) in self.effects().take(self.model.with_memory) {
                let z = &state[place.states()];
                if !z.is_empty() {
                    R::effect_equations(effect).rates(p, z, &now, before, &mut rate[place.states()]);
                }
                if place.acts_on.transforms_rudder {
                    before = R::effect_equations(effect).rudder(p, z, before);
                }
            }
            if let Some((_, s)) = self.coupling {
                rate[s] = f;
            }
        }
    }

    fn update_memory(&self, _t: f64, state: &mut [R], input: &ShipInput<R>) {
        if self.model.states == 2 {
            return;
        }
        let mut before = input.rudder;
        for (effect, p, place) in self.effects().take(self.model.with_memory) {
            let z = &mut state[place.states()];
            R::effect_equations(effect).update_memory(p, z, before);
            before = R::effect_equations(effect).rudder(p, z, before);
        }
    }

    fn motion(&self, t: f64, state: &[R], input: &ShipInput<R>) -> Motion {
        let instant = self.instant(t, state, input);
        let (_, yaw_acceleration) = self.accelerations(state, input, &instant);
        Motion {
            heading: state[0].value(),
            yaw_rate: state[1].value(),
            yaw_acceleration: yaw_acceleration.value(),
            speed: None,
            sway: None,
        }
    }

    fn dead_time(&self) -> R {
        self.effects().fold(R::from(0.0), |sum, (effect, p, _)| sum + R::effect_equations(effect).dead_time(p))
    }

    /// A fiftieth of the shortest time constant, at most 0.1 s and at least 1 ms.
    fn largest_step(&self) -> f64 {
        (self.min_time_constant() / 50.0).clamp(1e-3, 0.1)
    }
}

mod steady;
#[cfg(test)]
mod tests;
