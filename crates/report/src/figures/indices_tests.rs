//! The phase plane, the plane of the indices, indices over the amplitude and replayed overshoots with ordinary, wild
//! and missing values.

use super::tests::check;
use super::*;
use crate::Theme;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::palette::{self, Origin};

/// All of them from `n` points, `wild` among the others.
fn all(n: usize, wild: f64, theme: &Theme) -> Vec<(&'static str, Figure)> {
    let orbit = |size: f64| {
        let turn = |k: usize| 0.15 * k as f64;
        let x: Vec<f64> = (0..n).map(|k| size * turn(k).cos()).collect();
        let y: Vec<f64> = (0..n).map(|k| if k == 1 { wild } else { 0.05 * size * turn(k).sin() }).collect();
        Curve { x, y }
    };
    let way = |origin: Origin, size: f64| PhaseCurve { origin, name: None, curve: orbit(size) };
    let plane = PhasePlane {
        title: Some("a < b".into()),
        record: orbit(20.0),
        smoothed: n > 2,
        fits: vec![way(Origin::Before, 22.0), way(Origin::After, 20.1)],
        drawn: (0..n.min(5)).map(|k| orbit(18.0 + k as f64)).collect(),
    };
    let answer = |(number, id): (usize, &'static str)| {
        let (k, t) = (0.1 + 0.001 * number as f64, if number == 1 { wild } else { 16.0 + 0.2 * number as f64 });
        let region = if number % 3 == 0 { Curve::default() } else { Curve { x: vec![k, k], y: vec![t, 1.1 * t] } };
        IndexAnswer { origin: Origin::Method(id.to_owned()), place: (k, t), region }
    };
    let answers = palette::method_ids().take(n).enumerate().map(answer).collect();
    let plane_of_indices = IndexPlane { title: None, prime: n > 2, answers };
    let point = |k: usize| AmplitudePoint {
        amplitudes_deg: [5.0 * k as f64, 7.0 + k as f64],
        value: if k == 1 { wild } else { 0.1 + 0.01 * k as f64 },
        interval: (k != 2).then_some([0.08, if k == 3 { wild } else { 0.13 }]),
    };
    let panel = |title: &str| AmplitudePanel {
        title: title.to_owned(),
        points: (0..n.min(12)).map(point).collect(),
        joint: (n > 1).then_some(Reference95 { value: 0.12, band: [0.11, if n == 2 { wild } else { 0.13 }] }),
    };
    let over = Amplitude {
        title: None,
        x_titles: ["rudder [°]", "heading amplitude [°]"].map(str::to_owned),
        origin: Origin::Method("output-error".into()),
        joint_name: "all records together, 95 %".into(),
        panels: vec![panel("K [1/s]"), panel("T [s]")],
    };
    let row = |k: usize, scale: f64| Some(if k == 1 { wild } else { scale * (8.0 + k as f64) });
    let values = |scale: f64| (0..n.min(14)).map(|k| row(k, scale)).collect::<Vec<_>>();
    let replayed = Rows {
        title: None,
        x_title: "overshoot [°]".into(),
        names: (0..n.min(14)).map(|k| (format!("record {k}, first"), k == 3)).collect(),
        parts: vec![
            ("measured", RowPart::Bars(values(1.0)), false),
            ("IMO limit", RowPart::Limits(values(2.0)), false),
            ("before", RowPart::Marks(Origin::Before.look(), -0.16, values(1.5)), true),
        ],
    };
    vec![
        ("phase", phase_plane(&plane, theme)),
        ("indices", index_plane(&plane_of_indices, theme)),
        ("amplitude", amplitude(&over, theme)),
        ("replayed overshoots", rows(&replayed, theme)),
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
    check("phase", &phase_plane(&PhasePlane::default(), &theme));
    check("indices", &index_plane(&IndexPlane::default(), &theme));
    check("replayed overshoots", &rows(&Rows::default(), &theme));
}

#[test]
fn labels_carry_symbol_and_unit() {
    let figures = all(40, 17.0, &Theme::screen());
    let svg = |name: &str| figures.iter().find(|(known, _)| *known == name).unwrap().1.svg();
    let italic = |s: &str| format!("<tspan font-style=\"italic\">{s}</tspan>");
    for symbol in [format!("heading {} [°]", italic("ψ")), format!("yaw rate {} [°/s]", italic("r"))] {
        assert!(svg("phase").contains(&symbol), "{symbol}");
    }
    for text in ["record, slope of its smoothed heading", "before", "after", "drawn ships"] {
        assert!(svg("phase").contains(&format!("\n{text}\n")), "{text}");
    }
    assert!(svg("indices").contains(&italic("K′")) && svg("indices").contains("maximum-likelihood"));
    for text in ["all records together, 95 %", "Arrows: beyond the axis.", "heading amplitude [°]"] {
        assert!(svg("amplitude").contains(text), "{text}");
    }
    for text in ["overshoot [°]", "measured", "IMO limit", "record 0, first"] {
        assert!(svg("replayed overshoots").contains(text), "{text}");
    }
}
