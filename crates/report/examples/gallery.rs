//! Draws figures of made-up but realistic data, once for the screen and once for a journal column: `cargo run -p report
//! --example gallery -- DIR`; those of studies, fits and traces are seen in `results/`. The data come from a first-order
//! response stepped with Euler's method, which is enough to look right; nothing here is a result.

use std::error::Error;
use std::path::PathBuf;

use kempf_report::figures::*;
use kempf_report::{Curve, Figure, Origin, Theme, symbol};

const METHODS: [(&str, f64, f64); 4] = [
    ("fourier-published", 0.155, 26.0),
    ("least-squares", 0.116, 16.2),
    ("output-error", 0.1201, 18.05),
    ("srivc", 0.1203, 18.1),
];

fn method(id: &str) -> Origin {
    Origin::Method(id.into())
}

/// Time, heading and rudder of a 20/20 zig-zag, and its executes.
fn zigzag() -> ([Vec<f64>; 3], Vec<Mark>) {
    let (dt, k, time_constant, angle) = (0.5, 0.12, 18.0, 20.0_f64);
    let (mut r, mut psi, mut delta, mut order) = (0.0, 0.0, 0.0_f64, angle);
    let mut executes = vec![Mark { t_s: 0.0, heading_deg: 0.0 }];
    let mut columns = [const { Vec::new() }; 3];
    for step in 0..520 {
        let t = f64::from(step) * dt;
        if psi * order.signum() >= angle {
            order = -order;
            executes.push(Mark { t_s: t, heading_deg: psi });
        }
        columns.iter_mut().zip([t, psi, delta]).for_each(|(column, value)| column.push(value));
        psi += dt * r;
        r += dt * (k * delta - r) / time_constant;
        delta += (order - delta).clamp(-2.5 * dt, 2.5 * dt);
    }
    (columns, executes)
}

/// The heading with an error that looks like one of a model: larger for indices farther off.
fn replayed([time, heading, _]: &[Vec<f64>; 3], size: f64) -> Vec<f64> {
    time.iter().zip(heading).map(|(t, psi)| psi + size * (t / 21.0).sin() * (1.0 + t / 200.0)).collect()
}

fn all(theme: &Theme) -> Vec<(&'static str, Figure)> {
    let (columns, executes) = zigzag();
    let [time, heading, rudder] = &columns;
    let curve = |values: &[f64]| Curve::new(time.clone(), values.to_vec());
    let swing = |pair: &[Mark]| {
        let inside = (0..time.len()).filter(|&row| time[row] >= pair[0].t_s && time[row] < pair[1].t_s);
        let row = inside.max_by(|&one, &other| heading[one].abs().total_cmp(&heading[other].abs())).unwrap_or(0);
        let extremum = Mark { t_s: time[row], heading_deg: heading[row] };
        Overshoot { execute: pair[0], extremum, angle_deg: heading[row].abs() - pair[0].heading_deg.abs() }
    };
    let overshoots: Vec<Overshoot> = executes[1..].windows(2).map(swing).collect();
    let trial = ZigzagTrial {
        title: Some("20°/20° zig-zag of a training ship".into()),
        heading: curve(heading),
        rudder: curve(rudder),
        initial_turning: Some(Span { from_s: 0.0, to_s: executes[1].t_s }),
        check_yaw: overshoots.iter().map(|own| Span { from_s: own.execute.t_s, to_s: own.extremum.t_s }).collect(),
        period: Some(Span { from_s: executes[1].t_s, to_s: executes[3].t_s }),
        executes,
        overshoots,
        ..ZigzagTrial::default()
    };
    let fit = |(id, k, _): (&str, f64, f64)| {
        let own = replayed(&columns, 40.0 * (k - 0.12));
        let residual: Vec<f64> = heading.iter().zip(&own).map(|(measured, own)| measured - own).collect();
        (method(id), curve(&own), curve(&residual), Some(40.0 * (k - 0.12)))
    };
    let fits = METHODS.map(fit).map(|(origin, heading, residual, rms_deg)| Fit {
        origin,
        heading,
        residual,
        rms_deg,
        band: None,
    });
    let replay = |(origin, heading, residual, rms_deg)| Replay { origin, heading, residual, rms_deg };
    let record = RecordFit { title: None, heading: curve(heading), rudder: curve(rudder), fits: fits[2..].to_vec() };
    let of_methods =
        Replays { record: curve(heading), replays: METHODS.map(fit).map(replay).into(), ..Replays::default() };
    let point = |value: f64| Some(PointEstimate { value, interval: Some([0.98 * value, 1.02 * value]) });
    let estimate =
        |(id, k, t): (&str, f64, f64)| MethodEstimate { origin: method(id), k_per_s: point(k), t_s: point(t) };
    let estimates = Intervals {
        estimates: METHODS.map(estimate).into(),
        truth: Some(Reference { k_per_s: 0.12, t_s: 18.0 }),
        ..Intervals::default()
    };
    let error = |(id, k, _): (&str, f64, f64)| {
        let of = |x: &f64| (*x, 100.0 * (k - 0.1195) + 2.0 * x);
        let points =
            [0.0, 0.1, 0.2, 0.5, 1.0].iter().map(of).map(|(x, y)| ErrorPoint::new(x, y, Some([0.9 * y, 1.1 * y])));
        ErrorCurve::new(method(id), points.collect())
    };
    let errors = ErrorCurves {
        x_title: "heading noise, standard deviation [°]".into(),
        rows: vec![format!("rms error of {} [%]", symbol("K"))],
        columns: vec!["20°/20° zig-zag".into()],
        cells: vec![ErrorCell { row: 0, column: 0, curves: METHODS.map(error).into() }],
        ..ErrorCurves::default()
    };
    vec![
        ("zigzag", zigzag_trial(&trial, theme)),
        ("record-fit", record_fit(&record, theme)),
        ("replays", replays(&of_methods, theme)),
        ("intervals", intervals(&estimates, theme)),
        ("errors", error_curves(&errors, theme)),
    ]
}

fn main() -> Result<(), Box<dyn Error>> {
    let dir = std::env::args_os().nth(1).map(PathBuf::from).ok_or("usage: gallery DIR")?;
    for (style, theme) in [("screen", Theme::screen()), ("paper", Theme::paper(85.0, 600.0)?)] {
        for (name, figure) in all(&theme) {
            println!("{}", figure.write(&dir, &format!("{style}-{name}"))?.1.display());
        }
    }
    Ok(())
}
