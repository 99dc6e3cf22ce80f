//! Instruments against their specification, at a fixed key and within the sampling error.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use ship::angle::{from_deg, to_deg};
use ship::{Particulars, ShipInput};
use trial::{Channel, DeclaredWeather};

use super::{KEY, TestShip, zig_zag};
use crate::disturbance::{GaussMarkov, Gusting, WaveSpectrum, Wind};
use crate::recording::RudderSource;
use crate::sensor::Spikes;
use crate::{Recording, SimulatedTrial, Simulation};

const ROWS: f64 = 2001.0;

fn long() -> Simulation {
    zig_zag(10.0, 10.0, 2.5, ROWS - 1.0)
}

fn run(simulation: &Simulation) -> SimulatedTrial {
    simulation.run(&KEY).expect("a zig-zag of a stable ship")
}

/// Mean and standard deviation of the differences.
fn statistics(measured: &[f64], truth: &[f64]) -> (f64, f64) {
    assert_eq!(measured.len(), truth.len());
    let count = measured.len() as f64;
    let mean = measured.iter().zip(truth).map(|(x, y)| x - y).sum::<f64>() / count;
    let square = measured.iter().zip(truth).map(|(x, y)| (x - y - mean).powi(2)).sum::<f64>();
    (mean, (square / (count - 1.0)).sqrt())
}

/// Relative tolerance of an sd estimated from all rows: three standard errors.
fn sd_tolerance() -> f64 {
    3.0 / (2.0 * ROWS).sqrt()
}

#[test]
fn heading_noise_bias_and_its_declaration() {
    let mut simulation = long();
    let (noise, bias) = (from_deg(0.3), from_deg(1.0));
    simulation.sensors.heading_noise = noise;
    simulation.sensors.heading_bias = bias;
    let SimulatedTrial { trial, truth } = run(&simulation);
    let (mean, sd) = statistics(trial.heading(), &truth.heading);
    assert_relative_eq!(sd, noise, max_relative = sd_tolerance());
    assert_abs_diff_eq!(mean, bias, epsilon = 3.0 * noise / ROWS.sqrt());
    assert_eq!(trial.noise().heading_sd, Some(noise));
    assert_eq!(trial.noise().rudder_sd, None);
    assert_eq!(trial.rudder(), truth.rudder);
}

#[test]
fn quantisation_is_uniform_and_declared_so() {
    let mut simulation = long();
    let quantum = from_deg(0.5);
    simulation.sensors.heading_quantum = quantum;
    simulation.sensors.rudder_quantum = from_deg(1.0);
    let SimulatedTrial { trial, truth } = run(&simulation);
    let (_, sd) = statistics(trial.heading(), &truth.heading);
    let uniform = quantum / 12.0_f64.sqrt();
    // The samples are not independent but belong to a periodic motion: the sd agrees within 5 %.
    assert_relative_eq!(sd, uniform, max_relative = 0.05);
    assert_relative_eq!(trial.noise().heading_sd.expect("declared"), uniform, max_relative = 1e-12);
    for (psi, delta) in trial.heading().iter().zip(trial.rudder()) {
        assert_abs_diff_eq!(to_deg(*psi) * 2.0, (to_deg(*psi) * 2.0).round(), epsilon = 1e-9);
        assert_abs_diff_eq!(to_deg(*delta), to_deg(*delta).round(), epsilon = 1e-9);
    }
}

#[test]
fn the_yaw_rate_sensor_scales_shifts_and_adds_noise() {
    let mut simulation = long();
    let [noise, bias] = [0.05, 0.02].map(from_deg);
    assert!(run(&simulation).trial.yaw_rate().is_none());
    simulation.sensors.yaw_rate_noise = Some(noise);
    simulation.sensors.yaw_rate_bias = Some(bias);
    simulation.sensors.yaw_rate_scale_error = Some(0.05);
    let SimulatedTrial { trial, truth } = run(&simulation);
    let scaled: Vec<f64> = truth.yaw_rate.iter().map(|r| 1.05 * r).collect();
    let (mean, sd) = statistics(trial.yaw_rate().expect("there is a sensor"), &scaled);
    assert_relative_eq!(sd, noise, max_relative = sd_tolerance());
    assert_abs_diff_eq!(mean, bias, epsilon = 3.0 * noise / ROWS.sqrt());
}

#[test]
fn rudder_noise_has_its_sd_and_the_order_has_none() {
    let mut simulation = long();
    simulation.sensors.rudder_noise = from_deg(0.4);
    let SimulatedTrial { trial, truth } = run(&simulation);
    let (_, sd) = statistics(trial.rudder(), &truth.rudder);
    assert_relative_eq!(sd, from_deg(0.4), max_relative = sd_tolerance());
    let order = trial.channel(Channel::RudderOrder).expect("a helmsman gives orders");
    assert!(order.iter().all(|delta| (to_deg(delta.abs()) - 10.0).abs() < 1e-12));
    assert_eq!(order[0], from_deg(10.0));
}

/// Lag τ in a motion that is slow compared with τ: ψ_g(t) ≈ ψ(t − τ), and the error ψ_g − ψ satisfies its differential
/// equation.
#[test]
fn gyro_lag_trails_the_heading() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 270.0);
    let lag = 0.8;
    simulation.sensors.heading_lag = lag;
    simulation.recording.sampling_period = 0.05;
    let SimulatedTrial { trial, truth } = run(&simulation);
    let trail: Vec<f64> = trial.heading().iter().zip(&truth.heading).map(|(gyro, psi)| gyro - psi).collect();
    for row in 20..trail.len() - 1 {
        let slope = (trail[row + 1] - trail[row - 1]) / 0.1;
        assert_abs_diff_eq!(slope, -truth.yaw_rate[row] - trail[row] / lag, epsilon = 3e-6);
    }
    let exact = run(&zig_zag(10.0, 10.0, 2.5, 270.0)).truth;
    assert_abs_diff_eq!(exact.execute_orders[3].time, truth.execute_orders[3].time, epsilon = 1e-8);
}

#[test]
fn a_delayed_heading_is_the_heading_of_then() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 100.0);
    (simulation.recording.after_execute, simulation.recording.first_row_offset) = (Some(2), Some(0.0));
    let prompt = run(&simulation);
    simulation.sensors.heading_delay = 2.0;
    let late = run(&simulation);
    // The delay is a whole number of rows; the first two rows have headings from before the execute.
    assert_eq!(late.trial.time(), prompt.trial.time());
    for (late, prompt) in late.trial.rudder().iter().zip(prompt.trial.rudder()) {
        assert_abs_diff_eq!(late, prompt, epsilon = 1e-12);
    }
    for row in 2..late.trial.len() {
        assert_abs_diff_eq!(late.trial.heading()[row], prompt.trial.heading()[row - 2], epsilon = 1e-12);
        assert_abs_diff_eq!(late.truth.heading[row], prompt.truth.heading[row], epsilon = 1e-12);
    }
    assert!(late.trial.heading()[0] < prompt.trial.heading()[0] - from_deg(1.0));
    simulation.sensors.heading_delay = -2.0;
    let early = run(&simulation);
    for row in 0..early.trial.len() - 2 {
        assert_abs_diff_eq!(early.trial.heading()[row], prompt.trial.heading()[row + 2], epsilon = 1e-12);
    }
}

#[test]
fn jitter_moves_heading_and_rudder_by_the_same_instants() {
    let mut simulation = zig_zag(20.0, 20.0, 2.5, 400.0);
    let jitter = 0.2;
    simulation.sensors.sampling_jitter = jitter;
    let SimulatedTrial { trial, truth } = run(&simulation);
    // Δψ = r j + r' j²/2, so that j can be computed while the ship turns.
    let (mut instants, mut agreeing) = (Vec::new(), 0);
    for row in 1..trial.len() {
        if truth.yaw_rate[row].abs() > from_deg(1.2) {
            let moved = (trial.heading()[row] - truth.heading[row]) / truth.yaw_rate[row];
            instants.push(moved);
            let ramp = (trial.rudder()[row] - truth.rudder[row]) / from_deg(2.5);
            if ramp.abs() > 1e-6 && (ramp.abs() - moved.abs()).abs() < 0.03 {
                agreeing += 1;
            }
        }
    }
    let zeros = vec![0.0; instants.len()];
    let (mean, sd) = statistics(&instants, &zeros);
    let count = instants.len() as f64;
    // Clamping at 0.45 s (2.25 sd) reduces the sd by 2 %; the tolerance covers the difference to 3 %.
    assert_relative_eq!(sd, 0.97 * jitter, max_relative = 3.0 / (2.0 * count).sqrt());
    assert_abs_diff_eq!(mean, 0.0, epsilon = 3.0 * jitter / count.sqrt());
    assert!(agreeing >= 10, "{agreeing}");
    assert_eq!(trial.time(), truth.time);
}

#[test]
fn lost_headings_are_nan_and_lost_rows_are_gone() {
    let mut simulation = long();
    simulation.sensors.drop_out.probability = 0.2;
    let headings = run(&simulation);
    let lost = headings.trial.heading().iter().filter(|psi| psi.is_nan()).count() as f64;
    let tolerance = 3.0 * (0.2 * 0.8 * ROWS).sqrt();
    assert_abs_diff_eq!(lost, 0.2 * ROWS, epsilon = tolerance);
    assert!(headings.truth.heading.iter().all(|psi| psi.is_finite()));

    simulation.sensors.drop_out.whole_row = true;
    simulation.sensors.drop_out.burst_probability = Some(0.01);
    simulation.sensors.drop_out.burst_mean_rows = Some(5.0);
    let rows = run(&simulation);
    assert!(rows.trial.len() < headings.trial.len() - lost as usize);
    assert_eq!(rows.trial.time(), rows.truth.time);
    assert_eq!(rows.trial.heading(), rows.truth.heading);
}

/// w' = −w/τ + white noise: standard deviation σ, autocorrelation exp(−h/τ), and absent from the truth.
#[test]
fn the_coloured_error_has_its_sd_and_its_correlation() {
    let (mut wandering, mut calm) = (long(), long());
    let wander = GaussMarkov { sd: from_deg(0.3), correlation_time: 5.0 };
    for simulation in [&mut wandering, &mut calm] {
        simulation.sensors.heading_noise = from_deg(0.1);
        simulation.sensors.yaw_rate_noise = Some(1e-3);
    }
    wandering.sensors.heading_wander = Some(wander);
    let (wandering, calm) = (run(&wandering), run(&calm));
    let errors: Vec<f64> = wandering.trial.heading().iter().zip(calm.trial.heading()).map(|(x, y)| x - y).collect();
    // ΣΣ exp(−|i − j|/τ)/n² is 2τ/n, and for the squares τ/n.
    let mean_square = errors.iter().map(|w| w * w).sum::<f64>() / ROWS;
    let tolerance = 3.0 * (2.0 * 5.0 / ROWS).sqrt();
    assert_relative_eq!(mean_square, wander.sd.powi(2), max_relative = tolerance);
    for lag in [1, 3, 10] {
        let product = errors.iter().zip(&errors[lag..]).map(|(x, y)| x * y).sum::<f64>() / ROWS;
        assert_relative_eq!(product / mean_square, (-(lag as f64) / 5.0).exp(), epsilon = tolerance);
    }
    assert_eq!(wandering.trial.yaw_rate(), calm.trial.yaw_rate());
    assert_eq!(wandering.trial.rudder(), calm.trial.rudder());
    assert_eq!(wandering.truth, calm.truth);
    assert_eq!(wandering.trial.noise().heading_sd, Some(from_deg(0.1)), "what is white is declared, and nothing else");
}

/// A helmsman who reads the display sees the error of the compass, and the readings lie on the error path of the
/// record.
#[test]
fn a_display_shows_the_coloured_error() {
    let mut simulation = long();
    simulation.helmsman.reads_display_every = Some(1.0);
    // Rows between the readings.
    (simulation.recording.sampling_period, simulation.recording.duration) = (0.5, Some(0.5 * (ROWS - 1.0)));
    let calm = run(&simulation).truth;
    let wander = GaussMarkov { sd: from_deg(0.3), correlation_time: 20.0 };
    simulation.sensors.heading_wander = Some(wander);
    let SimulatedTrial { trial, truth } = run(&simulation);
    assert_ne!(truth.execute_orders, calm.execute_orders);
    let errors: Vec<f64> = trial.heading().iter().zip(&truth.heading).map(|(psi, truth)| psi - truth).collect();
    let steps: Vec<f64> = errors.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (_, sd) = statistics(&steps, &vec![0.0; steps.len()]);
    assert_relative_eq!(sd, wander.sd * (2.0 * (1.0 - (-0.5_f64 / 20.0).exp())).sqrt(), max_relative = sd_tolerance());
}

#[test]
fn spikes_are_as_many_and_as_large_as_asked_for() {
    let mut simulation = long();
    simulation.sensors.heading_noise = from_deg(0.1);
    let calm = run(&simulation);
    let size = from_deg(5.0);
    simulation.sensors.heading_spikes = Some(Spikes { probability: 0.05, size });
    let spiked = run(&simulation);
    let (mut to_port, mut to_starboard) = (0, 0);
    for (psi, unspiked) in spiked.trial.heading().iter().zip(calm.trial.heading()) {
        if psi != unspiked {
            assert_abs_diff_eq!((psi - unspiked).abs(), size, epsilon = 1e-12);
            *(if psi < unspiked { &mut to_port } else { &mut to_starboard }) += 1;
        }
    }
    for count in [to_port, to_starboard] {
        assert_abs_diff_eq!(f64::from(count), 0.025 * ROWS, epsilon = 3.0 * (0.025 * ROWS).sqrt());
    }
    assert_eq!(spiked.truth, calm.truth);
    assert_eq!(spiked.trial.noise(), calm.trial.noise());

    // Spikes come after the display: they do not trigger an order, and the recorded heading is still a multiple of its
    // quantum.
    simulation.helmsman.reads_display_every = Some(1.0);
    simulation.sensors.heading_quantum = from_deg(1.0);
    let seen = run(&simulation);
    simulation.sensors.heading_spikes = None;
    assert_eq!(seen.truth, run(&simulation).truth);
    assert!(seen.trial.heading().iter().all(|psi| (to_deg(*psi) - to_deg(*psi).round()).abs() < 1e-9));
}

#[test]
fn a_heading_in_every_fifth_row_leaves_the_others_their_rudder() {
    let mut simulation = long();
    simulation.sensors.heading_noise = from_deg(0.1);
    simulation.sensors.yaw_rate_noise = Some(0.0);
    let full = run(&simulation);
    simulation.sensors.heading_every_rows = Some(5);
    let rare = run(&simulation);
    assert!(rare.trial.observed_rows().eq((0..ROWS as usize).step_by(5)));
    assert!(rare.trial.observed_rows().all(|row| rare.trial.heading()[row] == full.trial.heading()[row]));
    assert_eq!(rare.trial.rudder(), full.trial.rudder());
    assert_eq!(rare.trial.yaw_rate(), full.trial.yaw_rate());
    assert_eq!(rare.trial.noise(), full.trial.noise());
    assert_eq!(rare.truth, full.truth);

    // Rows are counted before drop-outs.
    simulation.sensors.drop_out.probability = 0.2;
    simulation.sensors.drop_out.whole_row = true;
    let lossy = run(&simulation).trial;
    assert!(lossy.len() < rare.trial.len());
    for (time, psi) in lossy.time().iter().zip(lossy.heading()) {
        assert_eq!(psi.is_finite(), time.rem_euclid(5.0) == 0.0, "{time}");
    }
}

#[test]
fn the_display_helmsman_acts_on_readings_and_the_record_holds_what_he_read() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 600.0);
    simulation.helmsman.reads_display_every = Some(1.0);
    simulation.sensors.heading_noise = from_deg(0.5);
    simulation.sensors.heading_quantum = from_deg(0.1);
    let SimulatedTrial { trial, truth } = run(&simulation);
    let mut off = 0;
    for execute in &truth.execute_orders[1..] {
        assert_eq!(execute.time, execute.time.round());
        let row = execute.time as usize;
        // The reading at the execute has reached the required heading, the reading before it has not.
        let side = -execute.ordered_rudder.signum();
        assert!(to_deg(side * trial.heading()[row]) >= 10.0 - 1e-6);
        assert!(to_deg(side * trial.heading()[row - 1]) < 10.0);
        off += usize::from((to_deg(side * execute.heading) - 10.0).abs() > 0.05);
    }
    // The displayed heading is not the true heading: noise and sampling shift the executes.
    assert!(off >= 4, "{off}");

    simulation.helmsman.reaction_time = 0.6;
    let slow = run(&simulation).truth;
    for execute in &slow.execute_orders[1..] {
        assert_abs_diff_eq!(execute.time - execute.time.floor(), 0.6, epsilon = 1e-9);
    }
}

#[test]
fn without_noise_a_display_only_delays_to_the_next_reading() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 100.0);
    let exact = run(&simulation).truth.execute_orders[1].time;
    simulation.helmsman.reads_display_every = Some(0.5);
    let read = run(&simulation).truth.execute_orders[1].time;
    assert_eq!(read, (exact / 0.5).ceil() * 0.5);
}

#[test]
fn waves_are_seen_but_do_not_steer() {
    let mut simulation = long();
    let calm = run(&simulation).truth;
    let sd = from_deg(0.6);
    simulation.disturbances.waves = Some(WaveSpectrum { sd, frequency: 0.8, damping: 0.2 });
    simulation.sensors.yaw_rate_noise = Some(0.0);
    let SimulatedTrial { trial, truth } = run(&simulation);
    assert_eq!(truth.heading, calm.heading);
    let (_, heading) = statistics(trial.heading(), &truth.heading);
    let (_, rate) = statistics(trial.yaw_rate().expect("there is a sensor"), &truth.yaw_rate);
    // Correlated over about 1/(ζω₀) = 6 s: some 2000/6 independent squares.
    let tolerance = 3.0 / (2.0 * ROWS / 6.0).sqrt();
    assert_relative_eq!(heading, sd, max_relative = tolerance);
    assert_relative_eq!(rate, 0.8 * sd, max_relative = tolerance);
}

#[test]
fn wind_acts_by_heading_and_is_recorded() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 200.0);
    let wind = Wind { moment: from_deg(1.0), from_direction: from_deg(60.0), speed: Some(10.0), gusting: None };
    simulation.disturbances.wind = Some(wind);
    simulation.ship = simulation.ship.with_particulars(Particulars { length: 105.0, speed: 8.0 });
    let SimulatedTrial { trial, truth } = run(&simulation);
    for (psi, moment) in truth.heading.iter().zip(&truth.disturbance_rudder) {
        assert_abs_diff_eq!(*moment, wind.moment * (2.0 * (wind.from_direction - psi)).sin(), epsilon = 1e-15);
    }
    // r' + a r = b (δ + moment), row by row.
    let ship = super::training_ship();
    for row in 0..trial.len() {
        let steering = truth.rudder[row] + truth.disturbance_rudder[row];
        let expected = ship.K_over_T * steering - ship.inverse_T * truth.yaw_rate[row];
        assert_abs_diff_eq!(truth.yaw_acceleration[row], expected, epsilon = 1e-15);
    }
    let from = trial.channel(Channel::WindRelativeFrom).expect("speed of wind and ship are known");
    assert!(from.iter().all(|from| (0.0..from_deg(60.0)).contains(from)));
    assert_eq!(trial.channel(Channel::WindTrueSpeed).expect("recorded")[5], 10.0);
}

#[test]
fn the_wind_a_ship_feels_is_the_wind_its_record_holds() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 60.0);
    // A ship with a weathervane moment: its yaw moment is proportional to the relative wind direction in the input.
    let vane = |r: f64, input: &ShipInput| 1e-3 * input.measured.wind_from.unwrap_or(f64::NAN) - 0.05 * r;
    simulation.ship = TestShip::simulated(vane, |_| 6.0, 0.0);
    simulation.longest_wait = 1e3;
    let gusting = Some(Gusting { sd: 0.3, correlation_time: 5.0 });
    simulation.disturbances.wind = Some(Wind { moment: 0.0, from_direction: 1.5, speed: Some(9.0), gusting });
    let SimulatedTrial { trial, truth } = run(&simulation);
    let from = trial.channel(Channel::WindRelativeFrom).expect("speed of wind and ship are known");
    let rows = from.iter().zip(&truth.yaw_rate).zip(&truth.yaw_acceleration);
    for ((from, r), yaw_acceleration) in rows {
        assert_abs_diff_eq!(*yaw_acceleration, 1e-3 * from - 0.05 * r, epsilon = 1e-15);
    }
    assert!(trial.channel(Channel::Speed).expect("the ship has a speed").iter().all(|speed| *speed == 6.0));
}

#[test]
fn a_record_declares_the_weather_that_its_recording_says_and_is_the_same() {
    let mut simulation = zig_zag(10.0, 20.0, 2.5, 300.0);
    let silent = run(&simulation).trial;
    simulation.recording.weather = Some(DeclaredWeather::Calm);
    let calm = run(&simulation).trial;
    assert_eq!((silent.is_calm(), calm.is_calm()), (false, true));
    assert_eq!(silent.heading(), calm.heading());
}

#[test]
fn a_rudder_rebuilt_from_orders_is_as_right_as_its_rate() {
    let trial = || zig_zag(10.0, 20.0, 2.5, 300.0);
    let recorded = |assumed_rudder_rate: Option<f64>| {
        let rudder = if assumed_rudder_rate.is_some() { RudderSource::Orders } else { RudderSource::Feedback };
        let recording = Recording { rudder, assumed_rudder_rate, ..trial().recording };
        Simulation { recording, ..trial() }.run(&KEY)
    };
    let rudder = |assumed_rate| {
        let simulated = recorded(assumed_rate).expect("a plain zig-zag");
        (simulated.trial.time().to_vec(), simulated.trial.rudder().to_vec(), simulated.truth.execute_orders.clone())
    };
    let (time, feedback, executes) = rudder(None);
    let (_, same, _) = rudder(trial().gear.rudder_rate);
    let (_, jumping, _) = rudder(Some(f64::INFINITY));
    for (row, &t) in time.iter().enumerate() {
        assert_abs_diff_eq!(same[row], feedback[row], epsilon = 1e-12);
        let ordered = executes.iter().rfind(|execute| execute.time <= t).map_or(0.0, |execute| execute.ordered_rudder);
        assert_abs_diff_eq!(jumping[row], ordered, epsilon = 1e-12);
    }
    assert!(jumping.iter().zip(&feedback).any(|(a, b)| (a - b).abs() > 0.05), "the ramps differ");
    assert!(recorded(Some(0.0)).is_err());
}
