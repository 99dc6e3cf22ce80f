//! Columns of a trial with their derivatives with respect to 1/T.

use estimation::lanes::{Kernel, run_kernel};
use ship::first_order::TangentTransition;

use super::columns::MotionColumns;
use super::track::{RudderCorner, SignalStep, TrialSignals, durations_differ, is_backward};

/// Fills the columns of a trial and their derivatives with respect to a = `inverse_T`, 1/s.
pub fn fill_with_tangents(
    signals: &TrialSignals,
    inverse_T: f64,
    columns: &mut MotionColumns,
    tangents: &mut MotionColumns,
) {
    let (rows, anchor) = (signals.time.len(), signals.anchor_row(is_backward(inverse_T)));
    let has_rates = !signals.yaw_rate_rows.is_empty();
    for (columns, rate) in [(&mut *columns, 1.0), (&mut *tangents, 0.0)] {
        columns.reset(rows, has_rates.then_some((anchor, rate)));
    }
    run_kernel(MotionsWithTangents { signals, inverse_T, columns, tangents });
    for columns in [columns, tangents] {
        columns.keep(&signals.heading_rows, &signals.yaw_rate_rows);
    }
}

/// Heading and yaw rate of the motions φ₁, G, H and their derivatives with respect to a, at every row.
struct MotionsWithTangents<'a> {
    signals: &'a TrialSignals,
    inverse_T: f64,
    columns: &'a mut MotionColumns,
    tangents: &'a mut MotionColumns,
}

impl Kernel for MotionsWithTangents<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { signals, inverse_T, columns, tangents } = self;
        let has_rates = !signals.yaw_rate_rows.is_empty();
        let ([f, g, h], [fr, gr, hr]) = columns.slices();
        let ([df, dg, dh], [dfr, dgr, dhr]) = tangents.slices();
        // A fourth motion rests, for alignment.
        let (mut heading, mut by_heading) = ([0.0; 4], [0.0; 4]);
        let (mut rate, mut by_rate) = ([1.0, 0.0, 0.0, 0.0], [0.0; 4]);
        let mut step = TangentTransition::new(inverse_T, 0.0);
        for SignalStep { from_row, to_row, duration, rudder_rate: slope, corner } in
            signals.steps(is_backward(inverse_T))
        {
            if durations_differ(step.value.time_step, duration) {
                step = TangentTransition::new(inverse_T, duration);
            }
            let (f0, d, delta) = (&step.value, &step.by_inverse_T, signals.rudder[from_row]);
            let forced = |[one, two]: [f64; 2]| [0.0, one * delta + two * slope, one, 0.0];
            let (of_heading, of_rate) = (forced([f0.phi2, f0.phi3]), forced([f0.phi1, f0.phi2]));
            let (of_by_heading, of_by_rate) = (forced([d.phi2, d.phi3]), forced([d.phi1, d.phi2]));
            for motion in 0..4 {
                by_heading[motion] += f0.phi1 * by_rate[motion] + (d.phi1 * rate[motion] + of_by_heading[motion]);
                by_rate[motion] = f0.decay * by_rate[motion] + (d.decay * rate[motion] + of_by_rate[motion]);
                heading[motion] += f0.phi1 * rate[motion] + of_heading[motion];
                rate[motion] = f0.decay * rate[motion] + of_rate[motion];
            }
            if let Some(RudderCorner { remaining, change }) = corner {
                let TangentTransition { value, by_inverse_T } = TangentTransition::new(inverse_T, remaining);
                heading[1] += value.phi3 * change;
                rate[1] += value.phi2 * change;
                by_heading[1] += by_inverse_T.phi3 * change;
                by_rate[1] += by_inverse_T.phi2 * change;
            }
            [f[to_row], g[to_row], h[to_row], _] = heading;
            [df[to_row], dg[to_row], dh[to_row], _] = by_heading;
            if has_rates {
                [fr[to_row], gr[to_row], hr[to_row], _] = rate;
                [dfr[to_row], dgr[to_row], dhr[to_row], _] = by_rate;
            }
        }
    }
}
