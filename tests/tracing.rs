//! Tracing, with the simulator in the loop: every effect that is put into a ship and not declared is named from the CSV
//! alone, and nothing is named where there is none. How often is a matter of `scenarios/undeclared.toml`; here single
//! trials are held to it.

use std::io::Write as _;
use std::sync::Arc;

use kempf_tests::records::{mirrored, zig_zag};
use ship::angle::from_deg;
use ship::dynamics::{Dynamics, Input, Motion};
use ship::effects::{self, Effect};
use ship::{Polyline, Response, ResponseModel};
use simulate::disturbance::{GaussMarkov, Squall};
use simulate::{Simulation, StreamKey, Vessel};
use trace::analysis::{Outcome, Verdict};
use trace::{Analysis, Settings};
use trial::{Channel, Columns, Origin, Trial};

/// An effect with its parameters.
type Missing = (Arc<dyn Effect>, Vec<f64>);

/// A channel as a function of time.
type Signal = (Channel, fn(f64) -> f64);

/// K = 0.1 1/s, T = 16.3 s, δ_r = 0.5 deg.
const BASE: [f64; 3] = [1.0 / 16.3, 0.1 / 16.3, 0.00873];

fn ship(effects: Vec<Missing>) -> Response {
    let mut parameters = BASE.to_vec();
    parameters.extend(effects.iter().flat_map(|(_, values)| values.iter().copied()));
    ResponseModel::new(effects.into_iter().map(|(effect, _)| effect).collect()).with(parameters)
}

fn steered(vessel: Vessel, angle_deg: f64) -> Simulation {
    let mut simulation = zig_zag(vessel, angle_deg, angle_deg, from_deg(2.5), 300.0);
    simulation.sensors.heading.noise = from_deg(0.05);
    simulation
}

fn run(simulation: &Simulation, replicate: u64) -> Trial {
    simulation.run(&StreamKey { seed: 77, cell: 0, replicate }).expect("the ship can be steered").trial
}

/// The trial as a file and nothing else knows it.
fn from_csv(trial: &Trial) -> Trial {
    let mut file = tempfile::Builder::new().suffix(".csv").tempfile().expect("a temporary file");
    let mut bytes = Vec::new();
    trial::write_csv(trial, &mut bytes).expect("a vector takes all bytes");
    file.write_all(&bytes).expect("a file takes them too");
    trial::read(file.path()).expect("a written record is readable").trial
}

fn analysed(trials: &[Trial], validation: &[Trial]) -> Analysis {
    trace::trace(trials, validation, &Settings::default()).expect("a zig-zag has a base")
}

fn names(analysis: &Analysis) -> Vec<&'static str> {
    analysis.effects.iter().map(|effect| effect.id).collect()
}

/// Whether an effect is named, itself or in a group.
fn is_named(analysis: &Analysis, id: &str) -> bool {
    analysis.effects.iter().any(|effect| effect.id == id || effect.aliases.iter().any(|(alias, _)| *alias == id))
}

/// Sizes that a 10/10 shows; other effects have their typical one.
fn sizes() -> Vec<Missing> {
    use effects::*;
    vec![
        (Arc::new(SecondOrder), vec![2.5, 6.2]),
        (Arc::new(NonlinearDamping::Cubic), vec![80.0]),
        (Arc::new(NonlinearDamping::Quadratic), vec![1.6]),
        (Arc::new(NonlinearDamping::Square), vec![1.0]),
        (Arc::new(WindMoment::Steady), vec![0.03, 0.02]),
        (Arc::new(SpeedLoss::Modelled), vec![13.0, 100.0, 2.0]),
        (Arc::new(SteeringLag::DeadTime), vec![1.0]),
        (Arc::new(SteeringLag::FirstOrder), vec![1.2]),
        (Arc::new(RudderDeadband::Backlash), vec![from_deg(1.5)]),
        (Arc::new(PortStarboardAsymmetry), vec![0.2]),
        (Arc::new(MomentDrift { reference_time: 0.0 }), vec![7e-5]),
        (Arc::new(TransientDisturbance::Passing), vec![0.04, 150.0, 30.0]),
        (Arc::new(WaveYaw), vec![from_deg(0.4), 0.6, 0.1]),
    ]
}

/// Forms that one 10/10 does not show: stall has its own test below, and a dead band acts only while the rudder passes
/// amidships.
const NOT_SHOWN: [(&str, &str); 2] = [("rudder_saturation", "stall"), ("rudder_deadband", "dead band")];

/// Every effect that acts without a measured channel, in a size that a 10/10 shows.
fn simulated() -> Vec<Missing> {
    let sizes = sizes();
    let name = |effect: &Arc<dyn Effect>| (effect.id(), effect.form());
    let shown = effects::all().into_iter().filter(|effect| effect.needs().is_none());
    let shown = shown.filter(|effect| !NOT_SHOWN.contains(&name(effect)));
    let sized = shown.map(|effect| {
        let known = sizes.iter().find(|(known, _)| name(known) == name(&effect));
        let typical = || effect.parameters().iter().map(|parameter| parameter.typical).collect();
        let values = known.map_or_else(typical, |(_, values)| values.clone());
        (effect, values)
    });
    sized.collect()
}

#[test]
fn every_effect_is_named_from_the_csv_alone() {
    for (effect, values) in simulated() {
        let (id, form) = (effect.id(), effect.form());
        let trial = from_csv(&run(&steered(Vessel::response(ship(vec![(effect, values.clone())])), 10.0), 1));
        let analysis = analysed(&[trial], &[]);
        assert!(
            is_named(&analysis, id),
            "{id} ({form}): named {:?}; if {values:?} is too small for a 10/10, say a size in sizes()",
            names(&analysis)
        );
        assert_eq!(analysis.verdict, Verdict::Traced, "{id} ({form})");
        assert_eq!(analysis.effects.len(), 1, "{id} ({form}): named {:?}", names(&analysis));
        let found = &analysis.effects[0];
        let error = analysis.identification[0].after.errors.heading;
        if id == "wave_yaw" {
            assert!(
                (found.parameters[0].quantity.value / values[0] - 1.0).abs() < 0.5
                    && (found.parameters[1].quantity.value - 0.6).abs() < 0.1
            );
        } else {
            // What is left is the noise of the compass, to a tenth.
            assert!((error / from_deg(0.05) - 1.0).abs() < 0.1, "{id} ({form}): {:.4} deg is left", error.to_degrees());
        }
        if found.form == form && id != "wave_yaw" {
            for (found, truth) in found.parameters.iter().zip(&values).filter(|(found, _)| found.quantity.sd.is_some())
            {
                let sd = found.quantity.sd.expect("filtered");
                assert!((found.quantity.value - truth).abs() < 5.0 * sd, "{id} ({form}): {found:?} is not {truth}");
            }
        }
    }
}

/// A record of a ship whose effect acts through a measured channel.
fn with_channel(effect: Arc<dyn Effect>, values: Vec<f64>, channels: &[Signal]) -> Trial {
    let helm = run(&steered(Vessel::response(ship(Vec::new())), 10.0), 3);
    let time = helm.time().to_vec();
    let signal = |of: Channel| {
        let found = channels.iter().find(|(channel, _)| *channel == of)?;
        Polyline::new(time.clone(), time.iter().map(|&t| found.1(t)).collect()).ok()
    };
    let (speed, sway) = (signal(Channel::Speed), signal(Channel::Sway));
    let (wind, from, propeller) =
        (signal(Channel::WindRelativeSpeed), signal(Channel::WindRelativeFrom), signal(Channel::PropellerRate));
    let recorded = ship::replay::Recorded {
        speed: speed.as_ref(),
        sway: sway.as_ref(),
        wind_speed: wind.as_ref(),
        wind_from: from.as_ref(),
        propeller: propeller.as_ref(),
        ..helm.recorded_rudder()
    };
    let response = ship(vec![(effect, values)]);
    let mut state = vec![0.0; response.dimension()];
    response.approach(0.0, 0.0, &mut state);
    let noise: Vec<f64> = {
        let quiet = run(
            &{
                let mut quiet = steered(Vessel::response(ship(Vec::new())), 10.0);
                quiet.sensors.heading.noise = 0.0;
                quiet
            },
            3,
        );
        helm.heading().iter().zip(quiet.heading()).map(|(noisy, quiet)| noisy - quiet).collect()
    };
    let mut heading = vec![0.0; time.len()];
    ship::replay::replay(&response, &recorded, &time, 0.05, &mut state, |row, motion| {
        heading[row] = motion.heading + noise[row]
    });
    let mut columns: std::collections::BTreeMap<Channel, Vec<f64>> =
        [(Channel::Heading, heading), (Channel::Rudder, helm.rudder().to_vec())].into();
    columns
        .extend(channels.iter().map(|(channel, value)| (*channel, time.iter().map(|&t| value(t)).collect::<Vec<_>>())));
    let origin = Origin::Simulated { scenario: "channel".into(), cell: 0, replicate: 0 };
    Trial::new("channel", origin, Columns { time, channels: columns, unknown: Vec::new() }).expect("a valid record")
}

#[test]
fn measured_channels_are_used_where_they_help() {
    use effects::*;
    let cases: [(Missing, Vec<Signal>); 4] = [
        ((Arc::new(SwayCouplingMeasured), vec![0.1]), vec![(Channel::Sway, |t| 0.4 * (0.11 * t).sin())]),
        (
            (Arc::new(SpeedLoss::Measured { approach_speed: 5.0 }), vec![0.5, 1.2]),
            vec![(Channel::Speed, |t| 5.0 - 0.006 * t + 0.3 * (0.05 * t).cos())],
        ),
        (
            (Arc::new(SpeedLoss::Propeller { approach_rate: 2.0 }), vec![1.5]),
            vec![(Channel::PropellerRate, |t| if t < 150.0 { 2.0 } else { 1.6 })],
        ),
        (
            (Arc::new(WindMoment::Measured), vec![4e-4]),
            vec![
                (Channel::WindRelativeSpeed, |t| 10.0 + 2.0 * (0.02 * t).sin()),
                (Channel::WindRelativeFrom, |t| 0.8 + 0.7 * (0.031 * t).sin()),
            ],
        ),
    ];
    for ((effect, values), channels) in cases {
        let (id, form) = (effect.id(), effect.form());
        let trial = from_csv(&with_channel(effect, values, &channels));
        let analysis = analysed(std::slice::from_ref(&trial), &[]);
        let found: Vec<_> = analysis.effects.iter().map(|effect| (effect.id, effect.form)).collect();
        assert!(found.contains(&(id, form)), "{id} ({form}): named {found:?}");
        // Without its column the effect cannot be named in this form.
        let all: Vec<Channel> = channels.iter().map(|(channel, _)| *channel).collect();
        let blind = analysed(&[trial.without(&all)], &[]);
        assert!(blind.effects.iter().all(|effect| effect.form != form), "{id} ({form})");
    }
}

#[test]
fn pairs_are_named() {
    use effects::*;
    let pairs: [[Missing; 2]; 3] = [
        [(Arc::new(SecondOrder), vec![2.5, 6.2]), (Arc::new(MomentDrift { reference_time: 0.0 }), vec![7e-5])],
        [(Arc::new(NonlinearDamping::Cubic), vec![80.0]), (Arc::new(PortStarboardAsymmetry), vec![0.2])],
        [(Arc::new(SpeedLoss::Modelled), vec![13.0, 100.0, 2.0]), (Arc::new(SteeringLag::DeadTime), vec![1.0])],
    ];
    for pair in pairs {
        let ids = pair.each_ref().map(|(effect, _)| effect.id());
        let trial = run(&steered(Vessel::response(ship(pair.into())), 10.0), 2);
        let analysis = analysed(&[from_csv(&trial)], &[]);
        assert!(ids.iter().all(|id| is_named(&analysis, id)), "{ids:?}: named {:?}", names(&analysis));
    }
}

#[test]
fn nothing_is_named_where_nothing_is_missing() {
    let calm = || steered(Vessel::response(ship(Vec::new())), 10.0);
    let mut cases: Vec<(&str, Simulation)> = vec![("white noise", calm())];
    let mut add = |name, change: &dyn Fn(&mut Simulation)| {
        let mut simulation = calm();
        change(&mut simulation);
        cases.push((name, simulation));
    };
    add("heading in whole degrees", &|s| s.sensors.heading.quantum = from_deg(1.0));
    add("rudder in whole degrees", &|s| s.sensors.rudder.quantum = from_deg(1.0));
    add("late stamps", &|s| s.sensors.clock.jitter = 0.3);
    add("random walk", &|s| s.disturbances.random_walk = from_deg(0.05));
    add("gusts", &|s| {
        s.disturbances.gusts = Some(GaussMarkov { sd: from_deg(0.5), correlation_time: 20.0 });
    });
    // A random moment is taken for a trend or a squall in up to one of twenty trials (`results/undeclared`).
    let mut mistaken = 0;
    for (name, simulation) in cases {
        for replicate in 0..4 {
            let analysis = analysed(&[run(&simulation, replicate)], &[]);
            let named = names(&analysis);
            let is_of_time = named.iter().all(|id| ["moment_drift", "transient_disturbance"].contains(id));
            let is_random = ["random walk", "gusts"].contains(&name);
            mistaken += usize::from(!named.is_empty());
            assert!(named.is_empty() || (is_random && is_of_time), "{name}, {replicate}: named {named:?}");
            if name == "white noise" {
                assert_eq!(analysis.verdict, Verdict::Clean);
                assert!(analysis.whiteness[0].p_value > 1e-4);
            }
        }
    }
    assert!(mistaken <= 1, "{mistaken} of 8 trials in a random moment");
}

#[test]
fn a_squall_of_another_shape_is_located_in_time() {
    let mut simulation = steered(Vessel::response(ship(Vec::new())), 10.0);
    simulation.disturbances.squall = Some(Squall { start: 130.0, duration: 50.0, edge: 20.0, moment: from_deg(3.0) });
    let analysis = analysed(&[run(&simulation, 5)], &[]);
    let [found] = &analysis.effects[..] else { panic!("named {:?}", names(&analysis)) };
    assert_eq!(found.id, "transient_disturbance");
    assert!((found.parameters[1].quantity.value - 155.0).abs() < 3.0, "{:?}", found.parameters);
}

/// A ship with a moment that grows with the distance from its first track, which is in no list.
#[derive(Debug)]
struct NearABank {
    response: Response,
}

impl Dynamics for NearABank {
    fn dimension(&self) -> usize {
        self.response.dimension() + 1
    }

    fn approach(&self, heading: f64, yaw_rate: f64, state: &mut [f64]) {
        let own = self.response.dimension();
        self.response.approach(heading, yaw_rate, &mut state[..own]);
        state[own] = 0.0;
    }

    fn rates(&self, t: f64, state: &[f64], input: &Input, rate: &mut [f64]) {
        let own = self.response.dimension();
        let disturbance = input.disturbance + 2e-4 * state[own];
        self.response.rates(t, &state[..own], &Input { disturbance, ..*input }, &mut rate[..own]);
        rate[own] = 7.0 * state[0].sin();
    }

    fn motion(&self, t: f64, state: &[f64], input: &Input) -> Motion {
        self.response.motion(t, &state[..self.response.dimension()], input)
    }
}

#[test]
fn what_no_candidate_carries_is_not_called_clean() {
    let vessel = Vessel::hull(Arc::new(NearABank { response: ship(Vec::new()) }));
    let analysis = analysed(&[run(&steered(vessel, 10.0), 6)], &[]);
    assert_ne!(analysis.verdict, Verdict::Clean);
    if let Some(signature) = &analysis.unexplained {
        assert!(
            signature.all > 0.0 && signature.line.is_some_and(|line| line.frequency > 0.0) && signature.span.1 > 0.0
        );
    }
}

/// Stall at one amplitude is a smaller K: not observable. At two it is seen, and the next trial says so beforehand.
#[test]
fn one_amplitude_is_blind_for_stall_and_two_are_not() {
    let vessel = || Vessel::response(ship(vec![(Arc::new(effects::RudderSaturation) as Arc<dyn Effect>, vec![0.88])]));
    let (small, large) = (run(&steered(vessel(), 10.0), 7), run(&steered(vessel(), 20.0), 8));
    let alone = analysed(std::slice::from_ref(&small), &[]);
    let outcome = |analysis: &Analysis| {
        let found = analysis.candidates.iter().find(|one| one.id == "rudder_saturation");
        found.map(|one| one.outcome)
    };
    assert_eq!((names(&alone), outcome(&alone)), (Vec::new(), Some(Outcome::NotObservable)));
    let planned = [("10/10 again".to_owned(), small.clone()), ("20/20".to_owned(), large.clone())];
    let prospects = alone.prospects(&planned);
    assert_eq!(prospects[0].name, "20/20");
    assert!(prospects[0].revealed.iter().any(|name| name.contains("rudder_saturation")), "{:?}", prospects[0]);
    assert!(prospects[1].still_hidden.iter().any(|name| name.contains("rudder_saturation")), "{:?}", prospects[1]);
    let both = analysed(&[small, large], &[]);
    assert!(is_named(&both, "rudder_saturation"), "named {:?}", names(&both));
}

#[test]
fn damping_of_either_power_is_one_group_and_a_validation_record_is_never_fitted() {
    let vessel =
        || Vessel::response(ship(vec![(Arc::new(effects::NonlinearDamping::Cubic) as Arc<dyn Effect>, vec![40.0])]));
    let (fitted, other) = (run(&steered(vessel(), 10.0), 9), run(&steered(vessel(), 20.0), 10));
    let analysis = analysed(std::slice::from_ref(&fitted), std::slice::from_ref(&other));
    let [found] = &analysis.effects[..] else { panic!("named {:?}", names(&analysis)) };
    assert_eq!(found.id, "nonlinear_damping");
    let forms = [found.form, found.aliases.first().map_or("", |(_, form)| *form)];
    assert!(forms.contains(&"r³") && forms.contains(&"r|r|"), "{found:?}");
    let judged = &analysis.validation[0];
    assert!(judged.after.errors.heading < 0.3 * judged.before.errors.heading);
    // The same model from the same record, whatever is held out.
    let alone = analysed(&[fitted], &[]);
    assert_eq!(alone.parameters, analysis.parameters);
}

/// A term that the fitted record wants and another record of the same kind contradicts is not kept, and that is said.
#[test]
fn what_makes_the_held_out_error_worse_is_not_kept() {
    let lagging =
        Vessel::response(ship(vec![(Arc::new(effects::SteeringLag::DeadTime) as Arc<dyn Effect>, vec![1.5])]));
    let fitted = run(&steered(lagging, 10.0), 11);
    let other = run(&steered(Vessel::response(ship(Vec::new())), 10.0), 12);
    assert_eq!(analysed(std::slice::from_ref(&fitted), &[]).effects.len(), 1);
    let analysis = analysed(&[fitted], &[other]);
    assert!(analysis.effects.is_empty(), "named {:?}", names(&analysis));
    assert!(analysis.refused[0].contains("steering_lag"), "{:?}", analysis.refused);
}

#[test]
fn records_of_one_ship_may_have_a_rudder_bias_each() {
    let biased = |bias_deg: f64| {
        let response = ResponseModel::first_order().with(vec![BASE[0], BASE[1], from_deg(bias_deg)]);
        steered(Vessel::response(response), 10.0)
    };
    let trials = [run(&biased(-1.0), 13), run(&biased(1.5), 14)];
    let settings = Settings { own_bias: true, ..Settings::default() };
    let analysis = trace::trace(&trials, &[], &settings).expect("two zig-zags have a base");
    assert!(analysis.effects.is_empty(), "named {:?}", names(&analysis));
    let biases: Vec<f64> = analysis
        .parameters
        .iter()
        .filter(|fitted| fitted.parameter.symbol == "δ_r")
        .map(|fitted| fitted.quantity.value.to_degrees())
        .collect();
    assert!((biases[0] + 1.0).abs() < 0.02 && (biases[1] - 1.5).abs() < 0.02, "{biases:?}");
}

#[test]
fn port_and_starboard_are_exchanged_and_nothing_else() {
    let effects: Vec<Missing> = vec![
        (Arc::new(effects::NonlinearDamping::Cubic), vec![80.0]),
        (Arc::new(effects::PortStarboardAsymmetry), vec![0.2]),
    ];
    let trial = run(&steered(Vessel::response(ship(effects)), 10.0), 15);
    let (one, other) = (analysed(std::slice::from_ref(&trial), &[]), analysed(&[mirrored(&trial)], &[]));
    assert_eq!(names(&one), names(&other));
    for (one, other) in one.parameters.iter().zip(&other.parameters) {
        let mirrored = other.quantity.scaled(if one.parameter.odd { -1.0 } else { 1.0 });
        let size = one.quantity.sd.expect("fitted");
        assert!((one.quantity.value - mirrored.value).abs() < 0.05 * size, "{one:?} and {other:?}");
    }
}

#[test]
fn threads_do_not_matter() {
    let vessel = Vessel::response(ship(vec![(Arc::new(effects::SecondOrder) as Arc<dyn Effect>, vec![2.5, 6.2])]));
    let trial = run(&steered(vessel, 10.0), 16);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| analysed(std::slice::from_ref(&trial), &[]))
    };
    let (one, three) = (with(1), with(3));
    assert_eq!(one.effects, three.effects);
    assert_eq!(one.candidates, three.candidates);
    assert_eq!(one.parameters, three.parameters);
}

#[test]
fn every_identifier_is_considered_and_equations_are_given() {
    let analysis = analysed(&[run(&steered(Vessel::response(ship(Vec::new())), 10.0), 17)], &[]);
    for effect in effects::all() {
        assert!(analysis.candidates.iter().any(|one| one.id == effect.id()), "{}", effect.id());
    }
    assert!(analysis.candidates.iter().all(|one| one.outcome != Outcome::Added));
}
