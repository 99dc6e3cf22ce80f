//! Zig-zags of the ship K = 0.1 1/s, T = 16.3 s against numbers computed by independent code, and against closed forms
//! of the instantaneous rudder.
//!
//! The independent code steps by 0.01 s and reverses the rudder at the first step beyond the heading asked for, so
//! every reversal is up to 0.01 s late and the delays add up: its fifth execute is 0.03 to 0.06 s late. A helmsman who
//! reads the heading every 0.01 s does the same and is held against the table itself; exact events are held against it
//! with the delays allowed for. Its rudder without rate limit moves within a step: half a step late.
//!
//! Its period is the median over all pairs of executes to the same side in some 434 s, the first included: the one
//! reading with which all nine rows agree. For 10/20 the median falls into the transient; the limit cycle is 160.00 s.

use approx::assert_abs_diff_eq;
use ship::angle::to_deg;

use super::{KEY, zig_zag};
use crate::Helmsman;
use crate::vessel::Solver;
use crate::{Simulated, Simulation};

/// One row of the table: δ, ψ (deg), rate (deg/s), executes 2 to 5 (s), overshoots 1 to 3 (deg), period (s), yaw rate
/// at executes 2 to 4 and its largest value (deg/s).
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

fn run(simulation: &Simulation) -> Simulated {
    simulation.run(&KEY).expect("a zig-zag of a stable ship")
}

/// Largest deviation beyond `psi_deg` between executes `k` and `k + 1` (from 0), deg.
fn overshoot_deg(simulated: &Simulated, k: usize, psi_deg: f64) -> f64 {
    let truth = &simulated.truth;
    let span = truth.executes[k].time..truth.executes[k + 1].time;
    let rows = truth.time.iter().zip(&truth.heading).filter(|(t, _)| span.contains(t));
    to_deg(rows.map(|(_, psi)| psi.abs()).fold(0.0, f64::max)) - psi_deg
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len().is_multiple_of(2) { 0.5 * (values[middle - 1] + values[middle]) } else { values[middle] }
}

/// Half of the last digit of the table, added to the tolerance of 0.02.
const TOLERANCE: f64 = 0.02 + 0.005;

/// Holds every row against the table; `lateness` is allowed once more for every execute, s.
fn check_table(solver: Solver, reads_display_every: Option<f64>, lateness: f64) {
    for (delta_deg, psi_deg, rate, executes, overshoots, period, rates, largest) in TABLE {
        let mut simulation = zig_zag(delta_deg, psi_deg, rate, 434.0);
        simulation.solver = solver;
        simulation.helmsman = Helmsman { reads_display_every, ..Helmsman::default() };
        let jumps = rate.is_infinite();
        if jumps && reads_display_every == STEPPED {
            simulation.gear.dead_time = 0.5 * STEP;
        }
        let lateness = if jumps { 2.0 * lateness } else { lateness };
        simulation.recording.period = 0.05;
        let simulated = run(&simulation);
        let made = &simulated.truth.executes;
        for (k, expected) in executes.into_iter().enumerate() {
            let late = expected - made[k + 1].time;
            let allowed = TOLERANCE + lateness * k as f64;
            assert!(late > -TOLERANCE && late < allowed, "{delta_deg}/{psi_deg} at {rate}: {k} late by {late}");
        }
        for (k, expected) in overshoots.into_iter().enumerate() {
            assert_abs_diff_eq!(overshoot_deg(&simulated, k + 1, psi_deg), expected, epsilon = TOLERANCE);
        }
        let periods: Vec<f64> = made.windows(3).map(|three| three[2].time - three[0].time).collect();
        assert_abs_diff_eq!(median(periods), period, epsilon = TOLERANCE + 2.0 * lateness);
        for (execute, expected) in made[1..4].iter().zip(rates) {
            assert_abs_diff_eq!(to_deg(execute.yaw_rate.abs()), expected, epsilon = 0.002);
        }
        let swing = simulated.truth.yaw_rate.iter().fold(0.0_f64, |largest, r| largest.max(r.abs()));
        assert_abs_diff_eq!(to_deg(swing), largest, epsilon = 0.002);
    }
}

/// The independent code's own way of reversing the rudder.
const STEPPED: Option<f64> = Some(STEP);

/// Step of the independent code, s.
const STEP: f64 = 0.01;

#[test]
fn reversals_on_the_steps_of_the_independent_code_meet_its_table() {
    check_table(Solver::Automatic, STEPPED, 0.0);
    check_table(Solver::RungeKutta(STEP), STEPPED, 0.0);
}

#[test]
fn exact_reversals_meet_the_table_but_for_its_steps() {
    check_table(Solver::Automatic, None, STEP);
    check_table(Solver::RungeKutta(0.1), None, STEP);
}

/// t_peak = T ln(1 + r_e/A), overshoot = T r_e − A T ln(1 + r_e/A) with A = K δ = 1 deg/s.
#[test]
fn instantaneous_rudder_overshoots_by_its_closed_form() {
    let mut simulation = zig_zag(10.0, 10.0, f64::INFINITY, 60.0);
    simulation.recording.period = 0.001;
    let simulated = run(&simulation);
    let execute = simulated.truth.executes[1];
    let r = to_deg(execute.yaw_rate);
    assert_abs_diff_eq!(r, 0.742, epsilon = 1e-3);
    let (time, heading) = (&simulated.truth.time, &simulated.truth.heading);
    let peak = (0..time.len()).max_by(|&i, &j| heading[i].total_cmp(&heading[j])).expect("a record has rows");
    let log = 16.3 * (1.0 + r).ln();
    assert_abs_diff_eq!(time[peak] - execute.time, log, epsilon = 1e-3);
    assert_abs_diff_eq!(time[peak] - execute.time, 9.05, epsilon = 0.01);
    assert_abs_diff_eq!(to_deg(heading[peak]) - 10.0, 16.3 * r - log, epsilon = 1e-6);
    // The formula gives 3.047 deg for 0.742 deg/s; the stepped code of the table 3.06.
    assert_abs_diff_eq!(to_deg(heading[peak]) - 10.0, 3.06, epsilon = 0.02);
}

/// Time to check yaw at 2.5 deg/s, independent code: 13.74, 14.95, 15.01 s in 10/10 and 18.64, 19.63, 19.68 s in 20/20.
#[test]
fn time_to_check_yaw_meets_independent_numbers() {
    for (angle, expected) in [(10.0, [13.74, 14.95, 15.01]), (20.0, [18.64, 19.63, 19.68])] {
        let mut simulation = zig_zag(angle, angle, 2.5, 300.0);
        simulation.recording.period = 0.005;
        let truth = run(&simulation).truth;
        for (pair, expected) in truth.executes[1..5].windows(2).zip(expected) {
            let span = (0..truth.time.len()).filter(|&i| (pair[0].time..pair[1].time).contains(&truth.time[i]));
            let peak = span.max_by(|&i, &j| truth.heading[i].abs().total_cmp(&truth.heading[j].abs()));
            let peak = truth.time[peak.expect("rows between two executes")];
            assert_abs_diff_eq!(peak - pair[0].time, expected, epsilon = 0.02);
        }
    }
}
