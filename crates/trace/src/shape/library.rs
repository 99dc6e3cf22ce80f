//! Library of the shapes that are tried.

use document::trace::Dependence;

use super::dictionary::{Shape, ShipSignal, SignalFunction};

/// Delays of the rudder, in units of T/16.
const DELAYS: [f64; 3] = [1.0, 2.0, 4.0];

/// Time constants of the lags of a signal, in units of T/16.
const LAGS: [f64; 4] = [3.0, 8.0, 20.0, 50.0];

/// Number of intervals into which the instants that are tried divide a record.
const INSTANTS: usize = 48;

/// Durations of transient moments, as shares of the record.
const DURATION_SHARES: [f64; 4] = [1.0 / 40.0, 1.0 / 20.0, 1.0 / 10.0, 1.0 / 5.0];

/// Duration of a squall over that of a pulse.
const SQUALL: f64 = 1.6;

/// Durations of ramps, as shares of the record.
const RAMPS: [f64; 3] = [0.08, 0.15, 0.3];

/// Minimum number of rows in the shortest period of a shape.
const MIN_ROWS_PER_CYCLE: f64 = 6.0;

/// All shapes with the number of places at which their kind is tried, for a record of this duration and row spacing;
/// `unit` is the time unit of the lags, all in s.
pub fn shapes([duration, spacing]: [f64; 2], unit: f64) -> Vec<(Shape, usize)> {
    let mut all: Vec<(Shape, usize)> = state_shapes(unit).into_iter().map(|shape| (shape, 1)).collect();
    all.extend([Shape::Trend(SignalFunction::Linear), Shape::Trend(SignalFunction::Square)].map(|shape| (shape, 1)));
    all.extend([Shape::HeadingTrend, Shape::ResponseTrend].map(|shape| (shape, 1)));
    for k in 2..INSTANTS - 1 {
        let at = duration * k as f64 / INSTANTS as f64;
        let changes =
            [Shape::ResponseChange(at), Shape::GainChange(at), Shape::TimeConstantChange(at), Shape::DelayChange(at)];
        all.push((Shape::Step(at), INSTANTS));
        all.extend(changes.map(|shape| (shape, INSTANTS)));
        all.extend(k.is_multiple_of(3).then_some((Shape::TrendFrom(at), INSTANTS)));
    }
    for own_duration in DURATION_SHARES.map(|share| share * duration) {
        let count = (2.0 * (duration - own_duration) / own_duration) as usize;
        for k in 1..=count {
            let at = (0.5 * k as f64 - 0.25) * own_duration;
            let both = [Shape::Pulse(at, own_duration), Shape::Squall(at, SQUALL * own_duration)];
            all.extend(both.map(|shape| (shape, 2 * DURATION_SHARES.len() * count)));
        }
    }
    for share in RAMPS {
        let count = ((0.85 - share) / 0.05) as usize;
        let ramp = |k| Shape::Ramp((0.1 + 0.05 * k as f64) * duration, share * duration);
        all.extend((0..=count).map(|k| (ramp(k), INSTANTS)));
    }
    let max_cycles = duration / (MIN_ROWS_PER_CYCLE * spacing);
    let grid = |from: f64, to: f64, step: f64| -> Vec<f64> {
        let count = ((to - from) / step).max(0.0) as usize;
        (0..=count).map(|k| from + step * k as f64).filter(|cycles| *cycles < max_cycles).collect()
    };
    let periods = grid(1.5, 16.0, 0.33);
    all.extend(periods.iter().map(|&cycles| (Shape::Sinusoid(cycles), periods.len())));
    let repeated = grid(2.0, (max_cycles / 3.0).min(10.0), 0.15);
    all.extend(repeated.iter().map(|&cycles| (Shape::Harmonics(cycles), repeated.len())));
    let ends = grid(1.5, 14.0, 1.0);
    for &from in &ends {
        let other_ends = ends.iter().filter(|to| **to != from);
        all.extend(other_ends.map(|&to| (Shape::Chirp(from, to), ends.len() * ends.len())));
    }
    all
}

/// All shapes that depend on the motion of the ship or on its rudder, except r and δ themselves.
fn state_shapes(unit: f64) -> Vec<Shape> {
    let mut all = Vec::new();
    for signal in [ShipSignal::Heading, ShipSignal::Way, ShipSignal::YawRate, ShipSignal::Rudder] {
        // The base has the linear terms in r and δ.
        let is_base = matches!(signal, ShipSignal::YawRate | ShipSignal::Rudder);
        let powers = SignalFunction::ALL.into_iter().filter(|power| !is_base || *power != SignalFunction::Linear);
        all.extend(powers.map(|power| Shape::Powers(signal.dependence(), (signal, power), None)));
    }
    let product = |dependence, signal, power, other| {
        Shape::Powers(dependence, (signal, power), Some((other, SignalFunction::Linear)))
    };
    let (heading, way) = (Dependence::Heading, Dependence::LateralDistance);
    all.extend([
        product(Dependence::YawRate, ShipSignal::YawRate, SignalFunction::Linear, ShipSignal::Rudder),
        product(Dependence::Rudder, ShipSignal::YawRate, SignalFunction::Magnitude, ShipSignal::Rudder),
        product(heading, ShipSignal::Heading, SignalFunction::Linear, ShipSignal::Rudder),
        product(heading, ShipSignal::Heading, SignalFunction::Linear, ShipSignal::YawRate),
        product(heading, ShipSignal::Heading, SignalFunction::Square, ShipSignal::YawRate),
        product(heading, ShipSignal::Heading, SignalFunction::Square, ShipSignal::Rudder),
        product(way, ShipSignal::Way, SignalFunction::Linear, ShipSignal::YawRate),
        product(way, ShipSignal::Way, SignalFunction::Linear, ShipSignal::Rudder),
        product(way, ShipSignal::Way, SignalFunction::Linear, ShipSignal::Heading),
    ]);
    all.extend(DELAYS.map(|lag| Shape::Delay(lag * unit)));
    for lag in LAGS.map(|lag| lag * unit) {
        all.extend([Shape::LaggedRudder(lag), Shape::LaggedSquaredYawRate(lag), Shape::LaggedRudderMagnitude(lag)]);
    }
    // Short lags of yaw rate and rudder together can represent any moment, so short lags of r are omitted.
    all.extend(LAGS[2..].iter().map(|lag| Shape::LaggedYawRate(lag * unit)));
    all.push(Shape::Hysteresis);
    all
}
