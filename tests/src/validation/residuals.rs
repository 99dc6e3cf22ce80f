//! Residual of a first-order fit if an effect is missing, and estimates after the effect is added, against an
//! independent computation of the same trials.
#![expect(clippy::approx_constant, reason = "6.28 s is a published T₃ and not 2π")]

use std::sync::Arc;

use identify::{Identifier, output_error};
use rayon::prelude::*;
use ship::angle::{DEGREE, from_deg, to_deg};
use ship::effects::{Effect, SecondOrder, SteeringLag, listed_effect};
use ship::{Response, ResponseModel};
use simulate::{SimulatedShip, StreamKey};
use trace::candidates;
use trace::fit::{FittedRecords, StoppingRule, StructureFit};
use trace::full::start_point;
use trace::model::Structure;
use trace::noise_law::NoiseLaw;
use trace::record::PreparedRecord;
use trace::{EffectId, Selection};

use super::{Check, Section, Tolerance};
use crate::records::zig_zag;

/// Line of the independent table.
struct Line {
    name: &'static str,
    effect: Arc<dyn Effect>,
    /// Parameters in SI; and T₁ if the base has a time constant other than 16.3 s.
    truth: Vec<f64>,
    time: f64,
    /// Root mean square residual of the base, deg.
    rms: f64,
    /// Bias of K and T of the base against 0.1 1/s and 16.3 s, %.
    bias: [f64; 2],
    /// Index, unit in SI and estimate of the parameter after the effect is added.
    found: (usize, f64, f64),
}

fn lines() -> Vec<Line> {
    let line = |name, effect: Arc<dyn Effect>, truth: Vec<f64>, rms, bias, found| Line {
        name,
        effect,
        truth,
        time: 16.3,
        rms,
        bias,
        found,
    };
    let per_degree = 1.0 / DEGREE;
    let cubic = per_degree * per_degree / 16.3;
    vec![
        Line {
            time: 20.0,
            ..line(
                "second order 20, 2.5, 6.2 s",
                Arc::new(SecondOrder),
                vec![2.5, 6.2],
                0.272,
                [-12.3, -18.4],
                (1, 1.0, 6.28),
            )
        },
        Line {
            time: 25.0,
            ..line(
                "second order 25, 4, 12.7 s",
                Arc::new(SecondOrder),
                vec![4.0, 12.7],
                0.329,
                [-18.5, -35.0],
                (1, 1.0, 12.8),
            )
        },
        line(
            "n₂ = 0.2 s/deg",
            listed_effect("nonlinear_damping", "r|r|"),
            vec![0.2 * per_degree / 16.3],
            0.047,
            [-12.7, -13.6],
            (0, per_degree / 16.3, 0.196),
        ),
        line(
            "n₃ = 0.2 s²/deg²",
            listed_effect("nonlinear_damping", "r³"),
            vec![0.2 * cubic],
            0.067,
            [-10.1, -11.3],
            (0, cubic, 0.2006),
        ),
        line(
            "asymmetry 5 %",
            listed_effect("port_starboard_asymmetry", "gain by side"),
            vec![0.05],
            0.026,
            [0.0, 0.0],
            (0, 1.0, 0.0524),
        ),
        line(
            "drift 0.004 deg/s",
            listed_effect("moment_drift", "linear trend"),
            vec![from_deg(0.004)],
            0.774,
            [0.6, -1.9],
            (0, DEGREE, 0.004),
        ),
        line("rudder lag 1 s", Arc::new(SteeringLag::FirstOrder), vec![1.0], 0.123, [4.6, 11.4], (0, 1.0, 1.006)),
        line(
            "heading stamped 1 s late",
            Arc::new(SteeringLag::DeadTime),
            vec![1.0],
            0.123,
            [5.1, 11.9],
            (0, 1.0, 0.998),
        ),
    ]
}

/// Heading noise, deg, of the trials.
const NOISE: f64 = 0.01;

/// Effort of fits that run to convergence.
const EFFORT: StoppingRule = StoppingRule { max_steps: 60, min_decrease: 1e-4 };

/// Residual of the base (deg), K (1/s), T (s); residual (deg) and parameters of the effect after it is added.
fn fitted(line: &Line) -> (f64, f64, f64, f64, Vec<f64>) {
    let mut parameters = vec![1.0 / line.time, 0.1 / line.time, 0.0];
    parameters.extend(&line.truth);
    let ship: Response = ResponseModel::new(vec![Arc::clone(&line.effect)]).with_parameters(parameters);
    let mut simulation = zig_zag(SimulatedShip::from_response(ship), 10.0, 10.0, from_deg(2.5), 270.0);
    simulation.sensors.heading_noise = from_deg(NOISE);
    let trial = simulation.run(&StreamKey { seed: 52, cell: 0, replicate: 0 }).expect("a plain zig-zag").trial;
    let method = output_error::Settings::default().build().expect("default settings are valid");
    let base = method.identify(std::slice::from_ref(&trial)).expect("a zig-zag").response;
    let replay = identify::replay::replay(&trial, &base).expect("finite");
    let trials = [trial];
    let time = candidates::ship_length_time(&trials, base.K_over_T);
    let problem = FittedRecords::new(vec![PreparedRecord::unaveraged(&trials[0])], base.inverse_T, time);
    let selection = Selection::only(vec![EffectId::find(line.effect.id()).expect("on the list")]);
    let all = candidates::candidate_terms(&problem.records, &trials, time, &selection);
    let term = all.into_iter().find(|term| term.effect.form() == line.effect.form());
    let term = term.expect("a candidate");
    let own = Structure::base(1, time);
    let structure = own.with_terms(vec![Arc::clone(&term)]);
    let whitening = problem.whitening(&NoiseLaw::white(1, from_deg(NOISE).powi(2)));
    let starts = [term.priors.iter().map(|prior| prior.mean).collect(), term.neutral()];
    let fits = starts.map(|values: Vec<f64>| {
        let theta = start_point(&own, &base, values.into_iter());
        problem.fit(&structure, theta, vec![replay.initial_state()], &whitening, EFFORT)
    });
    let height = |fit: &StructureFit| fit.misfit + fit.prior_penalty;
    let best = fits.into_iter().min_by(|one, other| height(one).total_cmp(&height(other))).expect("two starts");
    let square: f64 = best.residual.iter().flatten().map(|e| e * e).sum();
    let rms = to_deg((square / problem.heading_count() as f64).sqrt());
    let terms = structure.physical(&best.theta)[own.base_parameter_count()..].to_vec();
    (to_deg(replay.rms()), base.K(), base.T(), rms, terms)
}

/// Section of the checks.
pub fn section() -> Section {
    let lines = lines();
    let checks = lines
        .par_iter()
        .flat_map_iter(|line| {
            let (rms, gain, time, after, own) = fitted(line);
            let check = |what: &str, published: f64, decimals, ours, tolerance, unit| {
                Check::new(
                    format!("residual/{}/{what}", line.name),
                    format!("{}: {what}", line.name),
                    (published, decimals),
                    ours,
                    tolerance,
                    unit,
                )
            };
            let (place, unit, value) = line.found;
            let digits = if value < 0.01 { 4 } else { 3 };
            [
                check("rms of what the base leaves", line.rms, 3, rms, Tolerance::Relative(0.04), "deg"),
                check("bias of K", line.bias[0], 1, 100.0 * (gain / 0.1 - 1.0), Tolerance::Absolute(0.5), "%"),
                check("bias of T", line.bias[1], 1, 100.0 * (time / 16.3 - 1.0), Tolerance::Absolute(0.5), "%"),
                check("rms with the effect added", 0.010, 3, after, Tolerance::Absolute(0.003), "deg"),
                check("its parameter", value, digits, own[place] / unit, Tolerance::Relative(0.02), ""),
            ]
        })
        .collect();
    Section {
        title: "What a missing effect leaves, and what is found when it is added",
        method: "A 10/10 of 270 s at 1 s with 0.01 deg of heading noise, K = 0.1 1/s, T = 16.3 s (for a second-order ship T₁+T₂−T₃): the best \
                 first-order fit, and the fit of `study trace` with the effect that is missing. Another noise, another integrator and another \
                 search move the numbers of the independent program by a few per cent.",
        checks,
    }
}
