//! Every kind of figure with ordinary, empty and damaged data: labels are there, coordinates are numbers, strokes are
//! scaled, the same data give the same bytes.

use super::*;
use crate::curve::Curve;
use crate::palette::{self, Origin};
use crate::svg::UNITS;
use crate::{Figure, Theme};

/// A sine of `n` points; every `gap`-th is undefined.
fn wave(n: usize, gap: usize) -> Curve {
    let x: Vec<f64> = (0..n).map(|i| i as f64 * 0.5).collect();
    let y = x.iter().enumerate().map(|(i, x)| if gap > 0 && i % gap == 1 { f64::NAN } else { 25.0 * (x / 20.0).sin() });
    Curve { y: y.collect(), x }
}

fn methods() -> impl Iterator<Item = String> {
    palette::method_ids().map(String::from)
}

/// All figures from curves of `n` points with gaps.
fn all(n: usize, gap: usize, theme: &Theme) -> Vec<(&'static str, Figure)> {
    let curve = wave(n, gap);
    let mark = |t_s: f64| Mark { t_s, heading_deg: 25.0 * (t_s / 20.0).sin() };
    let has_data = n > 0;
    let undefined = if gap > 0 { f64::NAN } else { 1.5 };
    let zigzag = ZigzagTrial {
        title: Some("a < b".into()),
        heading: curve.clone(),
        heading_as_points: gap > 0,
        rudder: curve.clone(),
        truth: has_data.then(|| curve.clone()),
        executes: if has_data { vec![mark(10.0), mark(90.0), mark(undefined)] } else { vec![] },
        overshoots: if has_data {
            vec![
                Overshoot { execute: mark(10.0), extremum: mark(31.0), angle_deg: 13.0 },
                Overshoot { execute: mark(undefined), extremum: mark(92.0), angle_deg: undefined },
            ]
        } else {
            vec![]
        },
        initial_turning: has_data.then_some(Span { from_s: 0.0, to_s: 10.0 }),
        check_yaw: if has_data {
            vec![Span { from_s: 10.0, to_s: 31.0 }, Span { from_s: 80.0, to_s: undefined }]
        } else {
            vec![]
        },
        period: has_data.then_some(Span { from_s: 10.0, to_s: 95.0 }),
    };
    let fit = CurveFit {
        measured: curve.clone(),
        fitted: curve.clone(),
        fitted_name: "Fourier series".into(),
        residual: curve.clone(),
        r_squared: Some(undefined),
        fundamental_rad_s: Some(0.05),
        ..CurveFit::default()
    };
    let motion = |origin| MotionCurves {
        origin,
        name: None,
        heading: curve.clone(),
        yaw_rate: curve.clone(),
        yaw_acceleration: curve.clone(),
    };
    let replay = |method| Replay {
        origin: Origin::Method(method),
        heading: curve.clone(),
        residual: curve.clone(),
        rms_deg: Some(undefined),
    };
    let point =
        |value: f64| Some(PointEstimate { value, interval: Some([value - 0.01, value + 0.01 + 0.0 * undefined]) });
    let estimate = |(i, method)| MethodEstimate {
        origin: Origin::Method(method),
        k_per_s: point(0.1 + 0.3 * (i / 6) as f64),
        t_s: None,
    };
    let error = |x: f64| ErrorPoint::new(x, undefined * x, Some([-1.0, 2.0 * x]));
    let cell = |row| ErrorCell {
        row,
        column: 0,
        curves: methods()
            .map(Origin::Method)
            .chain([Origin::Bound])
            .map(|origin| ErrorCurve::new(origin, (0..n.min(5)).map(|i| error(i as f64)).collect()))
            .collect(),
    };
    let errors = |x_scale| ErrorCurves {
        x_title: "noise [°]".into(),
        x_scale,
        rows: vec!["error of K [%]".into()],
        columns: vec!["zig-zag".into()],
        cells: if has_data { vec![cell(0), cell(7)] } else { vec![] },
        ..ErrorCurves::default()
    };
    let fits =
        [Fit { origin: Origin::Truth, heading: curve.clone(), residual: curve.clone(), rms_deg: None, band: None }];
    let record = RecordFit { heading: curve.clone(), rudder: curve.clone(), fits: fits.into(), title: None };
    let (replays_of, estimates): (Vec<_>, Vec<_>) = if has_data {
        (methods().map(replay).collect(), methods().enumerate().map(estimate).collect())
    } else {
        Default::default()
    };
    vec![
        ("zigzag", zigzag_trial(&zigzag, theme)),
        ("curve_fit", curve_fit(&fit, theme)),
        ("derivatives", derivatives(&Derivatives { title: None, curves: vec![motion(Origin::Truth)] }, theme)),
        ("replays", replays(&Replays { record: curve.clone(), replays: replays_of, ..Replays::default() }, theme)),
        ("intervals", intervals(&Intervals { estimates, ..Intervals::default() }, theme)),
        ("errors log", error_curves(&errors(Scale::Log), theme)),
        ("errors linear", error_curves(&errors(Scale::Linear), theme)),
        ("record_fit", record_fit(&record, theme)),
    ]
}

/// Every number of an attribute in the document.
fn numbers<'a>(svg: &'a str, attribute: &str) -> Vec<&'a str> {
    svg.split(&format!(" {attribute}=\"")).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// Every corner of an area and of a line in the document, in its units.
fn places(svg: &str) -> Vec<(i64, i64)> {
    let read = |text: &str| -> Vec<i64> { text.split([' ', ',']).filter_map(|number| number.parse().ok()).collect() };
    let pairs = |text: &str| read(text).chunks_exact(2).map(|pair| (pair[0], pair[1])).collect::<Vec<_>>();
    let mut places: Vec<(i64, i64)> = numbers(svg, "points").into_iter().flat_map(pairs).collect();
    for line in numbers(svg, "d").into_iter().flat_map(|data| data.split('M').skip(1)) {
        let (start, steps) = line.split_once(['l', 'h']).expect("a line or a dot");
        let mut place = pairs(start)[0];
        places.push(place);
        for (across, down) in pairs(steps) {
            place = (place.0 + across, place.1 + down);
            places.push(place);
        }
    }
    places
}

/// What every figure has to keep.
pub(super) fn check(name: &str, figure: &Figure) {
    let svg = figure.svg();
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}: undefined coordinate");
    let (width, height) = figure.size();
    let (right, bottom) = ((width * UNITS) as i64 + 1, (height * UNITS) as i64 + 1);
    for (x, y) in places(svg) {
        assert!((0..=right).contains(&x) && (0..=bottom).contains(&y), "{name}: {x},{y} is off the page");
    }
    // Nothing may be thinner than 0.3 points.
    for stroke in numbers(svg, "stroke-width") {
        assert!(stroke.parse::<f64>().unwrap() >= 0.3 * UNITS, "{name}: stroke {stroke}");
    }
    for size in numbers(svg, "font-size") {
        assert!(size.parse::<f64>().unwrap() >= 6.5 * UNITS, "{name}: font size {size}");
    }
    assert!(resvg::usvg::Tree::from_str(svg, &resvg::usvg::Options::default()).is_ok(), "{name}: invalid SVG");
}

#[test]
fn figures_are_well_formed_whatever_the_data() {
    for theme in [Theme::screen(), Theme::paper(85.0, 300.0).unwrap(), Theme::paper(60.0, 300.0).unwrap()] {
        for (n, gap) in [(200, 0), (200, 3), (2, 0), (1, 0), (0, 0), (3, 1), (20_000, 0)] {
            for (name, figure) in all(n, gap, &theme) {
                check(&format!("{name}, {n} points, gap {gap}, {} pt", theme.width), &figure);
            }
        }
    }
}

#[test]
fn constant_and_undefined_curves_are_drawn() {
    let theme = Theme::screen();
    for y in [0.0, 5.0, f64::NAN, f64::INFINITY, 1e300, -1e-300] {
        let curve = Curve::new(vec![2.0; 4], vec![y; 4]);
        let record = RecordFit { heading: curve.clone(), rudder: curve.clone(), ..RecordFit::default() };
        check("constant", &record_fit(&record, &theme));
        let trial = ZigzagTrial { heading: curve.clone(), rudder: curve, ..ZigzagTrial::default() };
        check("constant", &zigzag_trial(&trial, &theme));
    }
}

#[test]
fn same_data_same_bytes() {
    let theme = Theme::screen();
    assert_eq!(all(200, 3, &theme), all(200, 3, &theme));
}

#[test]
fn labels_carry_symbol_and_unit() {
    let figures = all(200, 0, &Theme::screen());
    let svg = |name: &str| figures.iter().find(|(n, _)| *n == name).unwrap().1.svg();
    let italic = |s: &str| format!("<tspan font-style=\"italic\">{s}</tspan>");
    assert!(svg("zigzag").contains(&format!("heading {} [°]", italic("ψ"))));
    assert!(svg("zigzag").contains(&format!("rudder {} [°]", italic("δ"))));
    assert!(svg("zigzag").contains(&format!("time {} [s]", italic("t"))));
    assert!(svg("zigzag").contains(&format!("{}OS₁ = 13.0°", italic("ψ"))));
    assert!(svg("zigzag").contains("a &lt; b") && svg("zigzag").contains("period 85.0 s"));
    assert!(svg("curve_fit").contains("fundamental") && svg("curve_fit").contains("0.05000 rad/s"));
    assert!(svg("derivatives").contains(" [°/s²]"));
    assert!(svg("intervals").contains(&format!("{} [1/s]", italic("K"))));
    assert!(svg("intervals").contains("no estimate"));
    assert!(svg("intervals").contains("Arrows: beyond the axis."), "the last estimate, 0.4, lies beyond");
    for id in palette::method_ids() {
        assert!(svg("replays").contains(&format!("\n{id}, rms 1.5°\n")), "{id}");
        assert!(svg("errors log").contains(&format!("\n{id}\n")), "{id}");
    }
}

#[test]
fn a_replay_that_runs_off_is_cut_and_says_so() {
    let replay = |method: &str, size: f64| Replay {
        origin: Origin::Method(method.into()),
        heading: wave(200, 0),
        residual: Curve { y: wave(200, 0).y.iter().map(|y| y * size).collect(), x: wave(200, 0).x },
        rms_deg: Some(size),
    };
    let data = Replays {
        record: wave(200, 0),
        replays: vec![replay("srivc", 0.01), replay("output-error", 0.02), replay("least-squares", 40.0)],
        ..Replays::default()
    };
    let figure = replays(&data, &Theme::screen());
    check("replays", &figure);
    // 25 degrees times 40, reached at the top of the sine.
    assert_eq!(figure.svg().matches("cut, reaches 1000°").count(), 1);
}

#[test]
fn a_method_keeps_its_colour_in_every_figure() {
    for (name, figure) in all(200, 0, &Theme::screen()) {
        if ["replays", "intervals", "errors log"].contains(&name) {
            assert!(figure.svg().contains("#009E73"), "output-error in {name}");
        }
    }
}

/// A run of days has thousands of executes; marks on top of each other once made a file that could not be drawn.
#[test]
fn a_zig_zag_of_very_many_executes_says_that_it_does_not_mark_them() {
    let curve = wave(400, 0);
    let mark = |k: usize| Mark { t_s: 0.05 * k as f64, heading_deg: 10.0 };
    let trial = |count: usize| ZigzagTrial {
        heading: curve.clone(),
        rudder: curve.clone(),
        executes: (0..count).map(mark).collect(),
        overshoots: (1..count).map(|k| Overshoot { execute: mark(k), extremum: mark(k), angle_deg: 2.0 }).collect(),
        ..ZigzagTrial::default()
    };
    let theme = Theme::screen();
    let [few, many] = [12, 3000].map(|count| zigzag_trial(&trial(count), &theme).svg().to_owned());
    assert!(few.contains("overshoot") && !few.contains("too many"));
    assert!(many.contains("3000 executes: too many to be marked"));
    assert!(many.len() < few.len());
}
