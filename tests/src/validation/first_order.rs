//! Zig-zags of the ship K = 0.1 1/s, T = 16.3 s against an independent simulation, by the closed form and by
//! Runge-Kutta.

use std::sync::Arc;

use estimation::statistics::median;
use ship::angle::to_deg;
use simulate::simulated_ship::Solver;
use simulate::{Simulation, StreamKey, Truth};

use super::{Check, INDEPENDENT, Section, Tolerance};
use crate::records::Case;

/// Row of the table: δ, ψ (deg), rate (deg/s), executes 2 to 5 (s), overshoots 1 to 3 (deg), period (s), yaw rate at
/// executes 2 to 4 and its maximum (deg/s).
type Row = (f64, f64, f64, [f64; 4], [f64; 3], f64, [f64; 3], f64);

const TABLE: [Row; 9] = [
    (10., 10., 2.32, [24.24, 79.98, 138.81, 197.79], [6.59, 8.35, 8.43], 117.97, [0.741, 0.922, 0.931], 0.932),
    (10., 10., 2.5, [24.09, 79.20, 137.37, 195.68], [6.35, 8.07, 8.14], 116.63, [0.741, 0.921, 0.929], 0.930),
    (10., 10., 3.0, [23.76, 77.49, 134.23, 191.11], [5.81, 7.44, 7.52], 113.78, [0.742, 0.918, 0.926], 0.927),
    (10., 10., f64::INFINITY, [22.11, 68.92, 118.44, 168.09], [3.06, 4.23, 4.28], 99.32, [0.742, 0.901, 0.909], 0.909),
    (20., 20., 2.32, [26.35, 90.91, 158.85, 226.94], [19.71, 24.28, 24.48], 136.12, [1.477, 1.875, 1.892], 1.894),
    (20., 20., 2.5, [26.05, 89.35, 155.99, 222.78], [18.81, 23.23, 23.43], 133.51, [1.478, 1.871, 1.888], 1.890),
    (20., 20., 3.0, [25.40, 85.98, 149.82, 213.81], [16.83, 20.93, 21.13], 127.91, [1.480, 1.862, 1.879], 1.882),
    (10., 20., 2.5, [36.31, 114.60, 194.58, 274.58], [7.64, 8.65, 8.66], 159.13, [0.878, 0.980, 0.981], 0.981),
    (5., 5., 2.5, [23.10, 74.07, 127.94, 181.95], [2.36, 3.09, 3.12], 108.04, [0.371, 0.456, 0.460], 0.460),
];

/// Times to check yaw at 2.5 deg/s, s: δ = ψ (deg) and the first three times.
const CHECK_YAW: [(f64, [f64; 3]); 2] = [(10.0, [13.74, 14.95, 15.01]), (20.0, [18.64, 19.63, 19.68])];

/// Tolerance stated with the table plus half of its last digit; s and deg, then deg/s.
const TOLERANCE: f64 = 0.02 + 0.005;
const RATE_TOLERANCE: f64 = 0.002;

/// Step of the independent program, s: its rudder is reversed at the first step beyond the requested heading.
const STEP: f64 = 0.01;

/// Simulated duration, s; the median periods of the independent program show that its duration is equal.
const LENGTH: f64 = 434.0;

/// Method of simulation of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// Closed form, executes exactly on the heading.
    Exact,
    /// Runge–Kutta by [`STEP`], executes on the first step beyond the heading.
    Stepped,
}

impl Way {
    fn name(self) -> &'static str {
        match self {
            Self::Exact => "closed form",
            Self::Stepped => "Runge-Kutta",
        }
    }

    /// Maximum delay, s, of the executes of the table relative to ours, for each preceding execute.
    fn lateness(self, jumps: bool) -> f64 {
        match self {
            Self::Exact => STEP * if jumps { 2.0 } else { 1.0 },
            Self::Stepped => 0.0,
        }
    }

    fn set(self, simulation: &mut Simulation, jumps: bool) {
        if self == Self::Stepped {
            simulation.solver = Solver::RungeKutta(STEP);
            simulation.helmsman.reads_display_every = Some(STEP);
            // A rudder without rate limit moves within a step of the independent program: it is late by half a step.
            simulation.gear.dead_time = if jumps { 0.5 * STEP } else { 0.0 };
        }
    }
}

/// Truth of a zig-zag (angles in deg, rate in deg/s) recorded every `period` s.
fn truth(way: Way, rudder_deg: f64, heading_deg: f64, rate_deg_s: f64, period_s: f64) -> Arc<Truth> {
    let case = Case { rudder_deg, heading_deg, rate_deg_s, period_s, duration_s: LENGTH, ..Case::default() };
    let mut simulation = case.simulation();
    way.set(&mut simulation, rate_deg_s.is_infinite());
    simulation.run(&StreamKey::default()).expect("a zig-zag of a stable ship").truth
}

/// Index of the row with the maximum deviation between executes `k` and `k + 1` (from 0).
pub(super) fn peak(truth: &Truth, k: usize) -> usize {
    let span = truth.execute_orders[k].time..truth.execute_orders[k + 1].time;
    let rows = (0..truth.time.len()).filter(|&row| span.contains(&truth.time[row]));
    rows.max_by(|&i, &j| truth.heading[i].abs().total_cmp(&truth.heading[j].abs())).expect("rows between two executes")
}

/// Checks of section 1: nine zig-zags twice, times to check yaw, and the closed form of an overshoot.
pub fn section() -> Section {
    let mut checks = Vec::new();
    for way in [Way::Exact, Way::Stepped] {
        TABLE.iter().for_each(|row| table_row(way, row, &mut checks));
    }
    for (angle, times) in CHECK_YAW {
        let truth = truth(Way::Exact, angle, angle, 2.5, 0.01);
        for (k, published) in times.into_iter().enumerate() {
            checks.push(Check::new(
                format!("first-order/{angle}-{angle}/check-yaw-{}", k + 1),
                format!("{angle}/{angle} at 2.5 deg/s, closed form: time to check yaw {}", k + 1),
                (published, 2),
                truth.time[peak(&truth, k + 1)] - truth.execute_orders[k + 1].time,
                Tolerance::Absolute(TOLERANCE),
                "s",
            ));
        }
    }
    checks.extend(overshoot_in_closed_form());
    Section {
        title: "Zig-zags of a first-order ship",
        method: "K = 0.1 1/s, T = 16.3 s, rudder with a limited rate (deg/s). The closed form puts every execute exactly on its \
            heading; the independent program (Runge-Kutta, 0.01 s) puts it on the first step beyond, so each of its executes \
            is up to 0.01 s late and the lateness adds up (twice that for a rudder that jumps). The lines of the closed form \
            allow for it; those of our Runge-Kutta step and reverse as that program does, and do not. Tolerance otherwise \
            0.025 s or deg, 0.002 deg/s. Its period is the median over all pairs of executes to the same side in 434 s, the \
            first included.",
        checks,
    }
}

fn table_row(way: Way, row: &Row, checks: &mut Vec<Check>) {
    let &(delta, psi, rate, executes, overshoots, period, rates, largest) = row;
    let jumps = rate.is_infinite();
    let truth = truth(way, delta, psi, rate, 0.05);
    let lateness = way.lateness(jumps);
    let rate_name = if jumps { "infinite rate".to_owned() } else { format!("{rate} deg/s") };
    let mut push = |id: String, what: String, published: f64, decimals: usize, ours: f64, tolerance: f64, unit| {
        let id = format!("first-order/{}/{delta}-{psi}/{rate}/{id}", way.name());
        let what = format!("{delta}/{psi} at {rate_name}, {}: {what}", way.name());
        let tolerance = Tolerance::Absolute(tolerance);
        checks.push(Check::new(id, what, (published, decimals), ours, tolerance, unit));
    };
    let made = &truth.execute_orders;
    for (k, published) in executes.into_iter().enumerate() {
        let what = if k == 0 { "initial turning time".to_owned() } else { format!("execute {}", k + 2) };
        let allowed = TOLERANCE + lateness * k as f64;
        push(format!("execute-{}", k + 2), what, published, 2, made[k + 1].time, allowed, "s");
    }
    for (k, published) in overshoots.into_iter().enumerate() {
        let ours = to_deg(truth.heading[peak(&truth, k + 1)].abs()) - psi;
        push(format!("overshoot-{}", k + 1), format!("overshoot {}", k + 1), published, 2, ours, TOLERANCE, "deg");
    }
    let mut periods: Vec<f64> = made.windows(3).map(|three| three[2].time - three[0].time).collect();
    let median = median(&mut periods).expect("three executes");
    push("period".into(), "period".into(), period, 2, median, TOLERANCE + 2.0 * lateness, "s");
    for (k, published) in rates.into_iter().enumerate() {
        let ours = to_deg(made[k + 1].yaw_rate.abs());
        let what = format!("yaw rate at execute {}", k + 2);
        push(format!("rate-{}", k + 2), what, published, 3, ours, RATE_TOLERANCE, "deg/s");
    }
    let swing = to_deg(truth.yaw_rate.iter().fold(0.0, |most, r| most.max(r.abs())));
    push("largest-rate".into(), "largest yaw rate".into(), largest, 3, swing, RATE_TOLERANCE, "deg/s");
}

/// t_peak = T ln(1 + r_e/A) and overshoot = T r_e − A T ln(1 + r_e/A) with A = K δ, for an instantaneous rudder.
fn overshoot_in_closed_form() -> Vec<Check> {
    let truth = truth(Way::Exact, 10.0, 10.0, f64::INFINITY, 0.001);
    let execute = truth.execute_orders[1];
    let peak = peak(&truth, 1);
    let log = 16.3 * to_deg(execute.yaw_rate).ln_1p();
    let formula = "re-derived from Nomoto et al. (1957)";
    let check = |id: &str, what: &str, source, published, decimals, ours, tolerance, unit| {
        Check::new(
            format!("first-order/jump/{id}"),
            format!("10/10, rudder jumps: {what}"),
            (published, decimals),
            ours,
            Tolerance::Absolute(tolerance),
            unit,
        )
        .from(source)
    };
    let (time, angle) = (truth.time[peak] - execute.time, to_deg(truth.heading[peak]) - 10.0);
    let derived = 16.3 * to_deg(execute.yaw_rate) - log;
    vec![
        check("time-formula", "time to check yaw, T ln(1 + r/A)", formula, log, 4, time, 1e-3, "s"),
        check("overshoot-formula", "overshoot, T r − A T ln(1 + r/A)", formula, derived, 6, angle, 1e-6, "deg"),
        check("time", "time to check yaw", INDEPENDENT, 9.05, 2, time, TOLERANCE, "s"),
        check("overshoot", "overshoot", INDEPENDENT, 3.06, 2, angle, TOLERANCE, "deg"),
    ]
}
