//! The figures of a prediction with ordinary, wild and missing values.

use super::tests::check;
use super::*;
use crate::Theme;
use crate::curve::Curve;
use crate::figure::Figure;

/// All of them from `n` points, `wild` among the others.
fn all(n: usize, wild: f64, theme: &Theme) -> Vec<(&'static str, Figure)> {
    let wave = |scale: f64, shift: f64| {
        let x: Vec<f64> = (0..n).map(|k| 0.5 * k as f64).collect();
        let y = x.iter().enumerate().map(|(k, x)| if k == 1 { wild } else { shift + scale * (0.1 * x).sin() });
        Curve { y: y.collect(), x }
    };
    let swapped = |curve: Curve| Curve { x: curve.y, y: curve.x };
    let bands = PredictionBands {
        title: Some("a < b".into()),
        heading: wave(20.0, 0.0),
        band50: [wave(19.0, -2.0), wave(21.0, 2.0)],
        band90: [wave(18.0, -5.0), wave(22.0, wild)],
        recorded: (n > 2).then(|| wave(20.5, 0.5)),
        rudder: wave(10.0, 0.0),
    };
    let steady = SteadyCurves {
        title: None,
        most_probable: swapped(wave(20.0, 0.0)),
        unstable: swapped(wave(3.0, 0.0)),
        drawn: (0..n.min(12)).map(|k| swapped(wave(k as f64, wild))).collect(),
        seen_rudder_deg: Some(wild),
        seen_rate_deg_s: (n > 2).then_some(0.5),
    };
    let row = |k: usize| OvershootRow {
        label: format!("{k}/{k} first overshoot"),
        median: if k == 1 { wild } else { 3.0 + k as f64 },
        ci50: [2.0, if k == 2 { wild } else { 4.0 + k as f64 }],
        ci90: [if k == 3 { -wild } else { 1.0 }, if k == 4 { wild } else { 6.0 + k as f64 }],
        measured: k.is_multiple_of(2).then_some(if k == 6 { wild } else { 3.5 }),
        limit: k.is_multiple_of(3).then_some(if k == 9 { wild } else { 20.0 }),
        extrapolated: k % 4 == 3,
    };
    let limits = Overshoots { title: None, unit: "°".into(), rows: (0..n.min(14)).map(row).collect() };
    let tracks = Track {
        title: None,
        unit: "m".into(),
        most_probable: wave(300.0, 0.0),
        drawn: (0..n.min(12)).map(|k| wave(200.0 + 10.0 * k as f64, wild)).collect(),
        recorded: (n > 2).then(|| wave(290.0, 5.0)),
        headings: (0..n.min(6)).map(|k| [k as f64, wild, 30.0 * k as f64 + wild]).collect(),
    };
    vec![
        ("bands", prediction_bands(&bands, theme)),
        ("steady", steady_curves(&steady, theme)),
        ("overshoots", overshoots(&limits, theme)),
        ("track", track(&tracks, theme)),
    ]
}

#[test]
fn figures_are_well_formed_whatever_the_data() {
    for theme in [Theme::screen(), Theme::paper(85.0, 300.0).unwrap(), Theme::paper(60.0, 300.0).unwrap()] {
        for n in [0, 1, 2, 40] {
            for wild in [0.3, -0.3, 1e9, 1e300, f64::NAN, f64::INFINITY] {
                for (name, figure) in all(n, wild, &theme) {
                    check(&format!("{name}, {n} points, {wild} among them, {} pt", theme.width), &figure);
                }
            }
        }
    }
}

#[test]
fn nothing_is_nothing() {
    let theme = Theme::screen();
    check("bands", &prediction_bands(&PredictionBands::default(), &theme));
    check("steady", &steady_curves(&SteadyCurves::default(), &theme));
    check("overshoots", &overshoots(&Overshoots::default(), &theme));
    check("track", &track(&Track::default(), &theme));
}

#[test]
fn same_data_same_bytes() {
    let theme = Theme::screen();
    assert_eq!(all(200, 0.3, &theme), all(200, 0.3, &theme));
}

#[test]
fn labels_carry_symbol_and_unit() {
    let figures = all(40, 0.3, &Theme::screen());
    let svg = |name: &str| figures.iter().find(|(known, _)| *known == name).unwrap().1.svg();
    let italic = |s: &str| format!("<tspan font-style=\"italic\">{s}</tspan>");
    for text in ["90 % of the drawn ships", "50 %", "most probable ship", "recorded heading", "rudder"] {
        assert!(svg("bands").contains(&format!("\n{text}\n")), "{text}");
    }
    for symbol in [format!("heading {} [°]", italic("ψ")), format!("time {} [s]", italic("t"))] {
        assert!(svg("bands").contains(&symbol));
    }
    for symbol in [format!("rudder {} [°]", italic("δ")), format!("yaw rate {} [°/s]", italic("r"))] {
        assert!(svg("steady").contains(&symbol));
    }
    for text in ["most probable ship", "unstable branch", "drawn ships", "seen in the records"] {
        assert!(svg("steady").contains(&format!("\n{text}\n")), "{text}");
    }
    for text in ["0/0 first overshoot", "predicted value [°]", "measured", "IMO limit", "90 %"] {
        assert!(svg("overshoots").contains(&format!("\n{text}\n")), "{text}");
    }
    assert!(svg("overshoots").contains("extrapolated"));
    for text in ["east [m]", "north [m]", "recorded track", "drawn ships"] {
        assert!(svg("track").contains(&format!("\n{text}\n")), "{text}");
    }
}

#[test]
fn what_is_cut_is_said() {
    let row = OvershootRow { median: 5.0, ci50: [4.0, 6.0], ci90: [3.0, f64::INFINITY], ..OvershootRow::default() };
    let limits = Overshoots { rows: vec![row], ..Overshoots::default() };
    assert!(overshoots(&limits, &Theme::screen()).svg().contains("Arrows: beyond the axis."));
    let band = |high: f64| {
        let line = |y: f64| Curve::new([0.0, 1.0, 2.0], [-y, y, 0.0]);
        let data = PredictionBands {
            heading: line(20.0),
            band50: [line(18.0), line(22.0)],
            band90: [line(15.0), line(high)],
            ..PredictionBands::default()
        };
        prediction_bands(&data, &Theme::screen()).svg().contains("is cut at the frame")
    };
    assert!(band(1e4) && !band(25.0));
}
