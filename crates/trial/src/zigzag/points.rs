//! Heading extrema and zero-crossings by local least-squares polynomials: the points of the characteristic-point
//! identification of K and T. The rudder is not used.
//!
//! Source of the procedure: Nomoto (1960), Analysis of Kempf's standard maneuver test and proposed steering quality
//! indices, DTMB Report 1461; the equations are derived anew. The parabola at an extremum has a small bias, because
//! the turning rate of a ship does not change uniformly through a peak.

use super::local::{Cubic, Parabola};
use estimation::statistics::median;

/// Minimum size of an extremum as a share of the maximum |heading|; smaller extrema are ripples or the initial
/// transient.
const MIN_EXTREMUM_SHARE: f64 = 0.35;

/// Extrema of a heading (rad, measured from the base course) at increasing times (s): time (s) and heading (rad) of the
/// vertex of each, at zero yaw rate.
///
/// The record is split at its zero-crossings; in each part a parabola is fitted to the samples within ±`half_width` (s)
/// of the maximum |heading| of a lightly smoothed (three-point mean) record. At a sampling period of 1 s a half-width
/// of 3 samples suits a quiet record, of 4 to 6 samples a noisy record. A part gives no extremum if the parabola bends
/// the wrong way, its vertex lies outside the fit or the part, the record begins or ends within the half-width of the
/// maximum, or the extremum is below 0.35 of the maximum |heading|. Empty for a record without a swing.
pub fn extrema(time: &[f64], heading: &[f64], half_width: f64) -> Vec<[f64; 2]> {
    let Some((&start, &end)) = time.first().zip(time.last()) else { return Vec::new() };
    let largest = heading.iter().fold(0.0_f64, |most, psi| most.max(psi.abs()));
    let smooth = three_point_mean(heading);
    let mut bounds = vec![start];
    bounds.extend(passages(time, heading).iter().map(|(time, _)| time));
    bounds.push(end);
    let mut extrema = Vec::new();
    for (part, bound) in bounds.windows(2).enumerate() {
        let rows = time.partition_point(|&t| t < bound[0])..time.partition_point(|&t| t <= bound[1]);
        let Some(row) = rows.max_by(|&a, &b| smooth[a].abs().total_cmp(&smooth[b].abs())) else { continue };
        let centre = time[row];
        // One-sided fits at the ends of a record give an arbitrary vertex.
        let cut_off =
            (part == 0 && centre - half_width < start) || (part + 2 == bounds.len() && centre + half_width > end);
        if cut_off {
            continue;
        }
        let Some(fit) = Parabola::fit(time, heading, centre, half_width) else { continue };
        let Some(t) = fit.stationary_point() else { continue };
        let (psi, curvature) = (fit.value(t), fit.curvature(t));
        let outside = t < bound[0] || t > bound[1];
        if outside || psi * curvature >= 0.0 || psi.abs() < MIN_EXTREMUM_SHARE * largest {
            continue;
        }
        extrema.push([t, psi]);
    }
    extrema
}

/// Zero-crossings of a heading (rad, measured from the base course) at increasing times (s): time (s) and yaw rate
/// (rad/s) of each.
///
/// A cubic is fitted to the samples within ±`half_width` (s) of each crossing; its root gives the time, its slope there
/// the yaw rate. A crossing whose cubic has no root in the fit, or the wrong slope, is omitted.
pub fn zero_crossings(time: &[f64], heading: &[f64], half_width: f64) -> Vec<[f64; 2]> {
    let crossing = |(about, direction): (f64, f64)| {
        let fit = Cubic::fit(time, heading, about, half_width)?;
        let t = fit.crossing(0.0)?;
        let yaw_rate = fit.slope(t);
        (direction * yaw_rate > 0.0).then_some([t, yaw_rate])
    };
    passages(time, heading).into_iter().filter_map(crossing).collect()
}

/// Changes of sign of the heading, close ones merged: time (s), and +1 for a passage to starboard, −1 to port.
fn passages(time: &[f64], heading: &[f64]) -> Vec<(f64, f64)> {
    // Crossings within a twelfth of the period are merged: 10 s for a ship with a period of 120 s.
    let mut halves: Vec<f64> = departure_times(time, heading).windows(2).map(|pair| pair[1] - pair[0]).collect();
    let merge = median(&mut halves).map_or(0.0, |half| half / 6.0);
    let mut changes: Vec<(f64, f64)> = Vec::new();
    let mut last: Option<(f64, f64)> = None;
    // A heading of exactly zero has no side and is skipped.
    for (&t, &psi) in time.iter().zip(heading).filter(|&(_, &psi)| psi != 0.0) {
        if let Some((before, psi_before)) = last
            && psi * psi_before < 0.0
        {
            changes.push((before + (t - before) * psi_before / (psi_before - psi), psi.signum()));
        }
        last = Some((t, psi));
    }
    // A cluster with an even number of changes ends on the side on which it began: noise about zero, and no passage.
    changes
        .chunk_by(|a, b| b.0 - a.0 < merge)
        .filter(|cluster| cluster.len() % 2 == 1)
        .map(|cluster| (0.5 * (cluster[0].0 + cluster[cluster.len() - 1].0), cluster[0].1))
        .collect()
}

/// Times, s, at which a heading (rad, measured from the base course) departs to the opposite side by 0.35 of its
/// maximum absolute value: a time for every swing, because noise about zero is smaller.
pub fn departure_times(time: &[f64], heading: &[f64]) -> Vec<f64> {
    let largest = heading.iter().fold(0.0_f64, |most, psi| most.max(psi.abs()));
    let mut side = 0.0;
    let mut departures = Vec::new();
    for (&t, &psi) in time.iter().zip(heading) {
        if psi.abs() > MIN_EXTREMUM_SHARE * largest && psi.signum() != side {
            side = psi.signum();
            departures.push(t);
        }
    }
    departures
}

fn three_point_mean(values: &[f64]) -> Vec<f64> {
    (0..values.len())
        .map(|row| {
            let window = &values[row.saturating_sub(1)..(row + 2).min(values.len())];
            window.iter().sum::<f64>() / window.len() as f64
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Gaussian, Plant};
    use approx::assert_relative_eq;
    use ship::angle::{from_deg, to_deg};

    #[test]
    fn a_sine_gives_its_peaks_and_crossings() {
        let time: Vec<f64> = (0..400).map(|k| 0.5 * f64::from(k)).collect();
        let heading: Vec<f64> = time.iter().map(|t| 0.3 * (t / 15.0).sin()).collect();
        let extrema = extrema(&time, &heading, 2.0);
        assert_eq!(extrema.len(), 4);
        for (k, [time, heading]) in extrema.into_iter().enumerate() {
            let phase = (k as f64 + 0.5) * std::f64::consts::PI;
            assert_relative_eq!(time, 15.0 * phase, max_relative = 1e-3);
            assert_relative_eq!(heading, 0.3 * phase.sin(), max_relative = 1e-4);
        }
        let crossings = zero_crossings(&time, &heading, 2.0);
        assert_eq!(crossings.len(), 4);
        for (k, [time, yaw_rate]) in crossings.into_iter().enumerate() {
            let phase = (k as f64 + 1.0) * std::f64::consts::PI;
            assert_relative_eq!(time, 15.0 * phase, max_relative = 1e-6);
            assert_relative_eq!(yaw_rate, 0.02 * phase.cos(), max_relative = 1e-3);
        }
    }

    /// Noise of 1 degree makes several changes of sign at each passage; they count once.
    #[test]
    fn noise_about_zero_makes_one_crossing() {
        let (time, mut heading, _) = Plant::default().record(600.0, 0.1);
        let quiet = zero_crossings(&time, &heading, 4.0);
        let mut gaussian = Gaussian::new(4);
        heading.iter_mut().for_each(|psi| *psi += from_deg(gaussian.draw()));
        let changes = heading.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
        let noisy = zero_crossings(&time, &heading, 4.0);
        // The record begins on the base course, so noise may add a first crossing there.
        let [noisy, quiet] = [noisy, quiet].map(|mut points| {
            points.retain(|[time, _]| *time > 20.0);
            points
        });
        assert!(changes > quiet.len() + 4, "{changes} changes of sign");
        assert_eq!(noisy.len(), quiet.len());
        for ([noisy, _], [quiet, _]) in noisy.iter().zip(&quiet) {
            // A cubic through 81 samples passes 0.17 of the noise, and the ship turns at 0.86 deg/s: 0.2 s.
            assert!((noisy - quiet).abs() < 5.0 * 0.2, "{noisy} s for {quiet} s");
        }
    }

    #[test]
    fn extrema_of_a_zig_zag_match_the_simulation() {
        let plant = Plant::default();
        let (time, heading, _) = plant.record(300.0, 1.0);
        let extrema = extrema(&time, &heading, 3.0);
        // 10 degrees and the overshoots 6.35, 8.07, 8.14 (independent simulation, tolerance 0.02).
        let expected = [16.35, -18.07, 18.14, -18.14, 18.14];
        assert_eq!(extrema.len(), expected.len());
        for ([_, heading], expected) in extrema.into_iter().zip(expected) {
            assert_relative_eq!(to_deg(heading), expected, epsilon = 0.02);
        }
    }
}
