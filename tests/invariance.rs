//! What must not matter: units, scale, the number of threads, the order in which trials are made.

use std::path::Path;
use std::sync::Arc;

use campaign::rows::{BlockLabel, RowLayout, StudyRow, encode};
use campaign::scenario::Scenario;
use campaign::shard::TrialId;
use campaign::{collect, engine};
use identify::registry;
use kempf_tests::records::{Case, zig_zag};
use ship::FirstOrder;
use ship::angle::{from_deg, to_deg};
use ship::ships::kvlcc2;
use ship::vessel::mmg::{Mmg, MmgParameters, Propeller, Rudder};
use simulate::{SimulatedShip, StreamKey, Truth};

/// Scale of the KVLCC2 model of HSVA; time goes with its square root.
const FROUDE: f64 = 45.714;

fn largest_apart_deg(left: &[f64], right: &[f64]) -> f64 {
    assert_eq!(left.len(), right.len());
    left.iter().zip(right).map(|(left, right)| to_deg((left - right).abs())).fold(0.0, f64::max)
}

/// The case on a clock that runs `s` times slower: T s, K/s, rudder rate/s.
fn slowed(case: &Case, s: f64) -> Case {
    let FirstOrder { inverse_T, K_over_T, rudder_bias } = case.ship;
    Case {
        ship: FirstOrder { inverse_T: inverse_T / s, K_over_T: K_over_T / (s * s), rudder_bias },
        rate_deg_s: case.rate_deg_s / s,
        duration_s: case.duration_s * s,
        period_s: case.period_s * s,
        ..*case
    }
}

#[test]
fn a_first_order_ship_turns_alike_on_any_clock() {
    let ship = FirstOrder::from_indices(0.1, 16.3, from_deg(0.5));
    for (rudder_deg, heading_deg) in [(10.0, 10.0), (20.0, 20.0), (10.0, 20.0)] {
        let case = Case { ship, rudder_deg, heading_deg, ..Case::default() };
        let full = case.run(0).truth;
        for s in [FROUDE.sqrt().recip(), 10.0, 1e-3] {
            let other = slowed(&case, s).run(0).truth;
            let apart = largest_apart_deg(&full.heading, &other.heading);
            assert!(apart < 1e-9, "{rudder_deg}/{heading_deg}, time times {s}: {apart} deg");
            for (left, right) in full.execute_orders.iter().zip(&other.execute_orders) {
                assert!((left.time * s - right.time).abs() <= 1e-11 * right.time.abs());
            }
        }
    }
}

/// The published Fourier method keeps instants two seconds away from a moving rudder, whatever the ship: it has no
/// scale.
#[test]
fn methods_find_the_same_ship_on_any_clock() {
    for settings in registry::default_settings() {
        let method = settings.build().expect("default settings are valid");
        if method.id() == "fourier-published" {
            continue;
        }
        let case = Case { noise_deg: 0.1, ..Case::default() };
        let full = method.identify(&[case.trial(3)]).expect("a zig-zag is identified").response;
        for s in [FROUDE.sqrt().recip(), 60.0] {
            let other = method.identify(&[slowed(&case, s).trial(3)]).expect("a zig-zag is identified").response;
            let (k, t) = (other.K() * s / full.K() - 1.0, other.T() / s / full.T() - 1.0);
            assert!(k.abs() < 1e-7 && t.abs() < 1e-7, "{}, time times {s}: K {k:e}, T {t:e}", method.id());
        }
    }
}

/// A hull reduced in size `scale` times, every length and area with it.
fn reduced(parameters: &MmgParameters, scale: f64) -> MmgParameters {
    MmgParameters {
        Lpp: parameters.Lpp / scale,
        d: parameters.d / scale,
        volume: parameters.volume / scale.powi(3),
        xG: parameters.xG / scale,
        propeller: Propeller { DP: parameters.propeller.DP / scale, ..parameters.propeller },
        rudder: Rudder { AR: parameters.rudder.AR / scale.powi(2), ..parameters.rudder },
        ..*parameters
    }
}

fn hull_zig_zag(parameters: MmgParameters, scale: f64) -> Arc<Truth> {
    let (time, speed) = (scale.sqrt().recip(), 7.97 / scale.sqrt());
    let hull = Mmg::at_speed(parameters, speed).expect("the set balances at any size");
    let mut simulation =
        zig_zag(SimulatedShip::from_dynamics(Arc::new(hull)), 20.0, 20.0, from_deg(2.32) / time, 900.0 * time);
    simulation.recording.sampling_period = time;
    simulation.run(&StreamKey::default()).expect("KVLCC2 reaches its executes").truth
}

/// Froude's law: a model of a hull in the same water turns as the ship does, √λ times faster, and keeps the same share
/// of its speed. Steps scale with the hull, so only rounding is left.
#[test]
fn a_geometric_model_of_a_hull_turns_as_the_ship() {
    let ship = hull_zig_zag(kvlcc2::FULL_SCALE, 1.0);
    for scale in [FROUDE, 4.0] {
        let model = hull_zig_zag(reduced(&kvlcc2::FULL_SCALE, scale), scale);
        let apart = largest_apart_deg(&ship.heading, &model.heading);
        assert!(apart < 1e-7, "scale {scale}: {apart} deg");
        let share =
            |truth: &Truth| truth.speed.as_ref().map(|speed| speed.iter().map(|u| u / speed[0]).collect::<Vec<_>>());
        let (ship, model) = (share(&ship).expect("a speed"), share(&model).expect("a speed"));
        assert!(ship.iter().zip(&model).all(|(left, right)| (left - right).abs() < 1e-9));
    }
}

/// Two cells, every method, everything random.
fn scenario(replicates: u64) -> Scenario {
    let text = format!(
        r#"
question = "Do threads and order matter?"
seed = 31
replicates = {replicates}
ship.yukun = {{}}
manoeuvre.zig-zag = {{ rudder-deg = 10.0, heading-deg = 10.0 }}
steering-gear.rate-deg-s = 2.5
helmsman.reads-display-every-s = 1.0
recording = {{ sampling-s = 1.0, duration-s = 200.0 }}
identifier = [
    {{ method.fourier-published = {{}} }},
    {{ method.fourier-projected = {{}} }},
    {{ method.characteristic-points = {{}} }},
    {{ method.least-squares = {{}} }},
    {{ method.integral-least-squares = {{}} }},
    {{ method.output-error = {{}} }},
    {{ method.srivc = {{}} }},
]
[sensor]
heading-noise-deg = 0.2
heading-quantum-deg = 0.1
heading-wander = {{ sd-deg = 0.1, correlation-s = 10.0 }}
heading-spikes = {{ probability = 0.01, size-deg = 2.0 }}
heading-every-rows = 2
rudder-noise-deg = 0.1
jitter-s = 0.05
drop-out = {{ probability = 0.02 }}
[disturbance]
gusts = {{ sd-deg = 0.2, correlation-s = 10.0 }}
[[sweep]]
key = "manoeuvre.zig-zag.heading-deg"
values = [10.0, 20.0]
"#
    );
    Scenario::parse(Path::new("threads.toml"), "threads", text, None)
        .unwrap_or_else(|failure| panic!("{}", failure.message))
}

#[test]
fn rows_have_the_same_bytes_on_any_number_of_threads() {
    let scenario = scenario(5);
    let label = |cell| BlockLabel { design: String::new(), seed: 0, program: String::new(), cell, block: 0 };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool of threads");
        let (design, rows) = pool.install(|| collect::collect_in_memory(&scenario));
        let layout = RowLayout::from_design(&design);
        let block = |rows: &[StudyRow]| encode(rows, &label(rows[0].cell as usize), &layout).expect("plain values");
        rows.chunk_by(|one, other| one.cell == other.cell).map(block).collect::<Vec<_>>().concat()
    };
    let one = on(1);
    assert!(one.len() > 1000, "{} bytes", one.len());
    assert!(one == on(2) && one == on(4), "rows depend on the number of threads");
}

#[test]
fn a_longer_study_begins_with_the_shorter_one() {
    let (short, long) = (collect::collect_in_memory(&scenario(2)).1, collect::collect_in_memory(&scenario(4)).1);
    let first: Vec<&StudyRow> = long.iter().filter(|row| row.replicate < 2).collect();
    assert_eq!(short.len(), 2 * 2 * 7);
    assert_eq!(short.iter().collect::<Vec<_>>(), first);
    assert!(short.iter().any(|row| row.failure.is_none()));
}

#[test]
fn any_trial_can_be_made_alone_and_in_any_order() {
    let scenario = scenario(4);
    let heading = |cell: usize, replicate: u64| -> Vec<u64> {
        let simulated = engine::simulate(&scenario, TrialId { cell, replicate }).expect("a noisy zig-zag");
        simulated[0].trial.heading().iter().map(|psi| psi.to_bits()).collect()
    };
    let places: Vec<(usize, u64)> = (0..2).flat_map(|cell| (0..4).map(move |replicate| (cell, replicate))).collect();
    let forth: Vec<Vec<u64>> = places.iter().map(|&(cell, replicate)| heading(cell, replicate)).collect();
    let back: Vec<Vec<u64>> = places.iter().rev().map(|&(cell, replicate)| heading(cell, replicate)).collect();
    assert!(forth.iter().eq(back.iter().rev()), "a trial depends on what was made before it");
    let mut distinct = forth.clone();
    distinct.sort();
    distinct.dedup();
    assert_eq!(distinct.len(), places.len(), "no two trials are the same");
}
