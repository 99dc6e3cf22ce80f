//! Trials and replays as plot data, in degrees.

use document::method::MethodEntry;
use identify::Estimate;
use identify::replay::replay;
use report::figures::{OvershootMark, TimeSpan, ZigZagMark, ZigZagPlot};
use report::{CurveOrigin, PlotCurve};
use ship::angle::to_deg;
use trial::zigzag::{Execute, Overshoot};
use trial::{Quantity, Trial, ZigZag};

use crate::scenario::MethodName;
use crate::stored_figures::ReplayCurves;

/// Plot origin of a method: the method itself if its label is its id, otherwise a numbered variant.
pub fn curve_origin(names: &[MethodName], label: &str) -> CurveOrigin {
    match names.iter().find(|name| name.label == label) {
        Some(method) if method.id != label => {
            let mut variants = names.iter().filter(|name| name.id == method.id && name.label != name.id);
            let number = variants.position(|name| name.label == label).unwrap_or(0);
            CurveOrigin::Variant { label: label.to_owned(), method: method.id.clone(), number }
        }
        _ => CurveOrigin::Method(label.to_owned()),
    }
}

/// Angles in rad converted to degrees.
pub fn degrees(values: &[f64]) -> Vec<f64> {
    values.iter().copied().map(to_deg).collect()
}

/// Plot curve of an angle, given in rad and plotted in deg, against time, s.
pub fn angle_curve_deg(time: &[f64], angle: &[f64]) -> PlotCurve {
    PlotCurve::new(time, degrees(angle))
}

/// Plot data of a zig-zag with its characteristic points marked.
pub fn zigzag_plot_data(trial: &Trial, zigzag: &ZigZag) -> ZigZagPlot {
    let mark = |time: Quantity, heading: Quantity| ZigZagMark { t_s: time.value, heading_deg: to_deg(heading.value) };
    let execute = |execute: &Execute| mark(execute.time, execute.heading);
    let overshoot = |overshoot: &Overshoot| OvershootMark {
        execute: execute(&zigzag.executes[overshoot.execute]),
        extremum: mark(overshoot.peak_time, overshoot.peak_heading),
        angle_deg: to_deg(overshoot.angle.value),
    };
    let from = |execute: Option<&Execute>, duration: Option<Quantity>| {
        let (begin, duration) = execute.map(|execute| execute.time.value).zip(duration)?;
        Some(TimeSpan { from_s: begin, to_s: begin + duration.value })
    };
    let check_yaw = |peak: &Overshoot| from(zigzag.executes.get(peak.execute), Some(peak.time_to_check_yaw));
    // The cycle from the second execute on contains the starting transient: plotted only if there is no later one.
    let settled = if zigzag.lacks_first_execute() { 0 } else { 2 };
    let cycle_start = match zigzag.executes.len() > settled + 2 {
        true => zigzag.executes.get(settled),
        false => zigzag.executes.get(1),
    };
    ZigZagPlot {
        heading: angle_curve_deg(trial.time(), trial.heading()),
        // A thinned record keeps only its extremes; as points they would look like the record.
        heading_as_points: trial.len() <= PlotCurve::MAX_PAIRS
            && zigzag.heading_noise_sd.is_some_and(|sd| to_deg(sd) > 0.02),
        rudder: angle_curve_deg(trial.time(), trial.rudder()),
        truth: None,
        executes: zigzag.executes.iter().map(execute).collect(),
        overshoots: zigzag.overshoots.iter().map(overshoot).collect(),
        initial_turning: from(zigzag.executes.first(), zigzag.initial_turning_time),
        check_yaw: zigzag.overshoots.iter().filter_map(check_yaw).collect(),
        period: from(cycle_start, zigzag.period),
    }
}

/// Replays of all estimates on a trial, without failed methods and replays that are not finite.
pub fn replay_curves(
    trial: &Trial,
    answers: &[(MethodEntry, Option<Estimate>)],
    origin: impl Fn(&str) -> CurveOrigin,
) -> Vec<ReplayCurves> {
    let curves = |(entry, estimate): &(MethodEntry, Option<Estimate>)| {
        let replay = replay(trial, &estimate.as_ref()?.response)?;
        let (time, residual): (Vec<f64>, Vec<f64>) = replay.observed_residuals().unzip();
        Some(ReplayCurves {
            origin: origin(&entry.method),
            heading: angle_curve_deg(&replay.time, &replay.heading),
            residual: angle_curve_deg(&time, &residual),
            rms_deg: Some(to_deg(replay.rms())),
        })
    };
    answers.iter().filter_map(curves).collect()
}
