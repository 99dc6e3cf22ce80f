//! Draws the figures of trials and records with made-up but realistic data, once for the screen and once for a journal
//! column: `cargo run -p report --example gallery -- DIR`; those of whole studies are seen in `results/`. The data come
//! from a first-order response stepped with Euler's method, which is enough to look right; nothing here is a result.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

use kempf_report::figures::*;
use kempf_report::{Curve, Figure, Origin, Theme, symbol};

/// A zig-zag of a first-order response: time, heading, yaw rate, yaw acceleration, rudder.
struct Run {
    t: Vec<f64>,
    heading: Vec<f64>,
    rate: Vec<f64>,
    acceleration: Vec<f64>,
    rudder: Vec<f64>,
    executes: Vec<Mark>,
}

fn zigzag(k: f64, time_constant: f64, angle: f64, duration: f64) -> Run {
    let (dt, rudder_rate) = (0.5, 2.5);
    let (mut r, mut psi, mut delta, mut order) = (0.0, 0.0, 0.0_f64, angle);
    let mut run = Run {
        t: vec![],
        heading: vec![],
        rate: vec![],
        acceleration: vec![],
        rudder: vec![],
        executes: vec![Mark { t_s: 0.0, heading_deg: 0.0 }],
    };
    for i in 0..=(duration / dt) as usize {
        let t = i as f64 * dt;
        if psi * order.signum() >= angle {
            order = -order;
            run.executes.push(Mark { t_s: t, heading_deg: psi });
        }
        let acceleration = (k * delta - r) / time_constant;
        run.t.push(t);
        run.heading.push(psi);
        run.rate.push(r);
        run.acceleration.push(acceleration);
        run.rudder.push(delta);
        delta += (order - delta).clamp(-rudder_rate * dt, rudder_rate * dt);
        psi += dt * r;
        r += dt * acceleration;
    }
    run
}

/// The heading that another pair of indices gives for the same rudder.
fn replay(run: &Run, k: f64, time_constant: f64) -> Vec<f64> {
    let (mut r, mut psi) = (0.0, 0.0);
    let step = |delta: &f64| {
        let now = psi;
        psi += 0.5 * r;
        r += 0.5 * (k * delta - r) / time_constant;
        now
    };
    run.rudder.iter().map(step).collect()
}

fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut uniform = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    move || (0..12).map(|_| uniform()).sum::<f64>()
}

fn noisy(clean: &[f64], sd: f64, seed: u64) -> Vec<f64> {
    let mut draw = noise(seed);
    clean.iter().map(|v| v + sd * draw()).collect()
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

fn overshoots(run: &Run) -> Vec<Overshoot> {
    let ends = run.executes.iter().skip(2).map(|m| m.t_s).chain([f64::INFINITY]);
    let pairs = run.executes.iter().skip(1).zip(ends);
    pairs
        .filter_map(|(execute, end)| {
            let side = execute.heading_deg.signum();
            let inside = (0..run.t.len()).filter(|i| run.t[*i] >= execute.t_s && run.t[*i] < end);
            let i = inside.max_by(|a, b| (side * run.heading[*a]).total_cmp(&(side * run.heading[*b])))?;
            let extremum = Mark { t_s: run.t[i], heading_deg: run.heading[i] };
            (i + 1 < run.t.len()).then_some(Overshoot {
                execute: *execute,
                extremum,
                angle_deg: side * (extremum.heading_deg - execute.heading_deg),
            })
        })
        .collect()
}

fn zigzag_figure(theme: &Theme, has_noise: bool) -> Figure {
    let run = zigzag(0.12, 18.0, 20.0, 260.0);
    let overshoots = overshoots(&run);
    let truth = Curve::new(run.t.clone(), run.heading.clone());
    let heading = if has_noise { Curve::new(run.t.clone(), noisy(&run.heading, 1.0, 3)) } else { truth.clone() };
    zigzag_trial(
        &ZigzagTrial {
            title: Some("20°/20° zig-zag of a training ship".into()),
            heading,
            heading_as_points: has_noise,
            rudder: Curve::new(run.t.clone(), run.rudder.clone()),
            truth: has_noise.then_some(truth),
            initial_turning: Some(Span { from_s: 0.0, to_s: run.executes[1].t_s }),
            check_yaw: overshoots.iter().map(|o| Span { from_s: o.execute.t_s, to_s: o.extremum.t_s }).collect(),
            period: Some(Span { from_s: run.executes[1].t_s, to_s: run.executes[3].t_s }),
            executes: run.executes,
            overshoots,
        },
        theme,
    )
}

fn curve_fit_figure(theme: &Theme) -> Figure {
    let run = zigzag(0.12, 18.0, 20.0, 260.0);
    let every = |v: &[f64]| v.iter().step_by(10).copied().collect::<Vec<f64>>();
    let measured = noisy(&every(&run.heading), 0.4, 5);
    let residual = difference(&measured, &every(&run.heading));
    curve_fit(
        &CurveFit {
            title: None,
            measured: Curve::new(every(&run.t), measured),
            fitted: Curve::new(run.t.clone(), run.heading.clone()),
            fitted_name: "Fourier series, 5 harmonics".into(),
            residual: Curve::new(every(&run.t), residual),
            r_squared: Some(0.999_83),
            fundamental_rad_s: Some(0.048_31),
        },
        theme,
    )
}

fn derivatives_figure(theme: &Theme) -> Figure {
    let run = zigzag(0.12, 18.0, 20.0, 260.0);
    let ripple = |v: &[f64], size: f64, w: f64| -> Vec<f64> {
        v.iter().zip(&run.t).map(|(v, t)| v + size * (w * t).sin() * (1.0 + t / 400.0)).collect()
    };
    let curves = |origin, size: f64| {
        let w = 0.29;
        MotionCurves {
            origin,
            name: None,
            heading: Curve::new(run.t.clone(), ripple(&run.heading, size, w)),
            yaw_rate: Curve::new(run.t.clone(), ripple(&run.rate, size * w, w)),
            yaw_acceleration: Curve::new(run.t.clone(), ripple(&run.acceleration, size * w * w, w)),
        }
    };
    let method = |id: &str| Origin::Method(id.into());
    derivatives(
        &Derivatives {
            title: None,
            curves: vec![
                curves(Origin::Truth, 0.0),
                curves(method("fourier-published"), 0.5),
                curves(method("fourier-projected"), -0.15),
            ],
        },
        theme,
    )
}

const GUESSES: [(&str, f64, f64); 7] = [
    ("fourier-published", 0.155, 26.0),
    ("fourier-projected", 0.121, 18.4),
    ("characteristic-points", 0.127, 17.0),
    ("least-squares", 0.116, 16.2),
    ("integral-least-squares", 0.1195, 17.8),
    ("output-error", 0.1201, 18.05),
    ("srivc", 0.1203, 18.1),
];

fn replays_figure(theme: &Theme) -> Figure {
    let run = zigzag(0.12, 18.0, 20.0, 260.0);
    let record = noisy(&run.heading, 0.3, 8);
    let replays_of = GUESSES.map(|(method, k, time_constant)| {
        let heading = replay(&run, k, time_constant);
        let residual = difference(&record, &heading);
        Replay {
            origin: Origin::Method(method.into()),
            rms_deg: Some(rms(&residual)),
            heading: Curve::new(run.t.clone(), heading),
            residual: Curve::new(run.t.clone(), residual),
        }
    });
    replays(
        &Replays {
            title: Some("Replay of the recorded rudder".into()),
            record: Curve::new(run.t.clone(), record),
            truth: None,
            replays: replays_of.into(),
        },
        theme,
    )
}

fn intervals_figure(theme: &Theme) -> Figure {
    let estimate =
        |value: f64, half: Option<f64>| Some(PointEstimate { value, interval: half.map(|h| [value - h, value + h]) });
    let estimates = GUESSES.iter().enumerate().map(|(i, (method, k, t))| match i {
        0 => MethodEstimate {
            origin: Origin::Method((*method).into()),
            k_per_s: estimate(0.31, None),
            t_s: estimate(-4.0, None),
        },
        2 => MethodEstimate { origin: Origin::Method((*method).into()), k_per_s: None, t_s: None },
        _ => {
            let half = if i == 3 { 8.0 } else { 1.0 };
            MethodEstimate {
                origin: Origin::Method((*method).into()),
                k_per_s: estimate(*k, Some(0.0009 * half)),
                t_s: estimate(*t, Some(0.3 * half)),
            }
        }
    });
    intervals(
        &Intervals {
            title: None,
            estimates: estimates.collect(),
            truth: Some(Reference { k_per_s: 0.12, t_s: 18.0 }),
            published: Some(Reference { k_per_s: 0.1225, t_s: 18.7 }),
        },
        theme,
    )
}

fn error_figure(theme: &Theme, x_scale: Scale) -> Figure {
    let noise_deg = [0.0, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0];
    let cell = |row: usize, column: usize| {
        let curve = |i: usize, method: &str| {
            let points = noise_deg.iter().map(|x| {
                let floor = [3.0, 0.3, 2.0, 0.05, 0.03, 0.01, 0.01][i];
                let slope = [4.0, 1.6, 9.0, 6.0, 1.9, 1.0, 1.2][i];
                let y = (floor + slope * x) * (1.0 + row as f64) * (1.0 + 0.4 * column as f64);
                ErrorPoint::new(*x, y, Some([0.9 * y, 1.1 * y]))
            });
            ErrorCurve::new(Origin::Method(method.into()), points.collect())
        };
        let lowest = |x: &f64| 0.95 * x * (1.0 + row as f64) * (1.0 + 0.4 * column as f64);
        let bound = noise_deg[1..].iter().map(|x| ErrorPoint::new(*x, lowest(x), None));
        let mut curves: Vec<ErrorCurve> = GUESSES.iter().enumerate().map(|(i, g)| curve(i, g.0)).collect();
        curves.push(ErrorCurve::new(Origin::Bound, bound.collect()));
        ErrorCell { row, column, curves }
    };
    error_curves(
        &ErrorCurves {
            title: None,
            x_title: "heading noise, standard deviation [°]".into(),
            x_scale,
            y_scale: Scale::Log,
            rows: ["K", "T"].map(|name| format!("rms error of {} [%]", symbol(name))).into(),
            columns: vec!["10°/10° zig-zag".into(), "20°/20° zig-zag".into()],
            cells: vec![cell(0, 0), cell(0, 1), cell(1, 0), cell(1, 1)],
            ..ErrorCurves::default()
        },
        theme,
    )
}

fn record_figure(theme: &Theme) -> Figure {
    let run = zigzag(0.05, 40.0, 20.0, 800.0);
    let record: Vec<f64> =
        noisy(&run.heading, 0.15, 11).iter().zip(&run.t).map(|(v, t)| v + 0.8 * (t / 90.0).sin()).collect();
    let fit = |method: &str, k: f64, time_constant: f64| {
        let heading = replay(&run, k, time_constant);
        let residual = difference(&record, &heading);
        Fit {
            origin: Origin::Method(method.into()),
            rms_deg: Some(rms(&residual)),
            heading: Curve::new(run.t.clone(), heading),
            residual: Curve::new(run.t.clone(), residual),
            band: None,
        }
    };
    record_fit(
        &RecordFit {
            title: Some("Esso Osaka, 20°/20° zig-zag".into()),
            fits: vec![fit("output-error", 0.0502, 40.3), fit("least-squares", 0.0487, 37.8)],
            heading: Curve::new(run.t.clone(), record.clone()),
            rudder: Curve::new(run.t.clone(), run.rudder.clone()),
        },
        theme,
    )
}

fn put(dir: &Path, style: &str, name: &str, draw: impl Fn() -> Figure) -> Result<(), Box<dyn Error>> {
    let start = Instant::now();
    let figure = draw();
    let drawn = start.elapsed();
    let (_, png) = figure.write(dir, &format!("{style}-{name}"))?;
    let (width, height) = figure.pixels();
    println!(
        "{:45} {width} x {height} px  draw {:6.1} ms  total {:6.1} ms  svg {} kB",
        png.display(),
        drawn.as_secs_f64() * 1e3,
        start.elapsed().as_secs_f64() * 1e3,
        figure.svg().len() / 1024
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let dir = std::env::args_os().nth(1).map(PathBuf::from).ok_or("usage: gallery DIR")?;
    for (style, theme) in [("screen", Theme::screen()), ("paper", Theme::paper(85.0, 600.0)?)] {
        put(&dir, style, "zigzag", || zigzag_figure(&theme, false))?;
        put(&dir, style, "zigzag-noisy", || zigzag_figure(&theme, true))?;
        put(&dir, style, "curve-fit", || curve_fit_figure(&theme))?;
        put(&dir, style, "derivatives", || derivatives_figure(&theme))?;
        put(&dir, style, "replays", || replays_figure(&theme))?;
        put(&dir, style, "intervals", || intervals_figure(&theme))?;
        put(&dir, style, "errors-log", || error_figure(&theme, Scale::Log))?;
        put(&dir, style, "errors-linear", || error_figure(&theme, Scale::Linear))?;
        put(&dir, style, "record-fit", || record_figure(&theme))?;
    }
    Ok(())
}
