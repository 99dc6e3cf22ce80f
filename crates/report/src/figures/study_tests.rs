//! The figures of a Monte-Carlo study with ordinary, wild and missing values.

use super::tests::check;
use super::*;
use crate::Theme;
use crate::curve::Curve;
use crate::figure::Figure;
use crate::palette::{self, Origin};

fn methods() -> impl Iterator<Item = Origin> {
    palette::method_ids().map(|id| Origin::Method(id.to_owned()))
}

/// All of them; `n` values a method, the last method without any, `wild` among the others.
fn all(n: usize, wild: f64, theme: &Theme) -> Vec<(&'static str, Figure)> {
    let size = |method: usize, k: usize| if k == 1 { wild } else { 0.1 * (1 + method + k) as f64 };
    let count = |method: usize| if method == 6 { 0 } else { n };
    let dots = |row: usize| {
        let dot = |(method, origin)| Dot {
            origin,
            x: size(method, row),
            interval: Some([0.9 * size(method, row), 1.1 * size(method, row)]),
            hollow: method % 2 == 0,
        };
        methods().enumerate().filter(|(method, _)| count(*method) > 0).map(dot).collect()
    };
    let dot_column = |scale, reference| DotColumn {
        limit: None,
        x_title: "rms error of K [%]".into(),
        scale,
        reference,
        rows: (0..n.min(5)).map(dots).collect(),
    };
    let band = Some(Reference95 { value: 95.0, band: [92.0, 98.0] });
    let names: Vec<String> = (0..n.min(5)).map(|row| format!("orders at {row} °/s")).collect();
    let dot_plot = DotPlot {
        names: names.clone(),
        columns: vec![dot_column(Scale::Log, None), dot_column(Scale::Linear, band)],
        note: Some("Rows: rates.".into()),
        ..DotPlot::default()
    };
    let violin = |(method, origin): (usize, Origin)| Violin {
        origin,
        density: (0..count(method)).map(|k| (k as f64 - 0.5 * n as f64, wild.min(3.0) + (k % 7) as f64)).collect(),
        quantiles: (count(method) > 0)
            .then(|| [if method == 0 { -wild } else { -2.0 }, -1.0, 0.1, 1.0, 2.0 + method as f64]),
    };
    let violin_panel =
        ViolinPanel { x_title: "error of K [%]".into(), violins: methods().enumerate().map(violin).collect() };
    let ellipse = |a: f64| Some(Ellipse { centre: (0.1, 0.0), covariance: [[a, 0.5 * a], [0.5 * a, a]] });
    let cloud = |(method, origin): (usize, Origin)| KtPanel {
        origin,
        points: (0..count(method)).map(|k| (size(method, k), -size(method, k + 1))).collect(),
        ellipse: if method == 6 { None } else { ellipse(0.1 * wild * (1 + method) as f64) },
        bound: ellipse(0.02),
    };
    let heat = |(method, origin): (usize, Origin)| HeatPanel {
        title: origin.label().to_owned(),
        values: names.iter().map(|_| (0..3).map(|x| (method != 6).then(|| size(method, x))).collect()).collect(),
    };
    let map = HeatMap {
        x_title: "rudder step [°]".into(),
        y_title: "heading step [°]".into(),
        x_labels: ["0", "0.1", "1"].map(str::to_owned).into(),
        y_labels: names.clone(),
        value_title: "rms error of K [%]".into(),
        scale: Scale::Log,
        panels: methods().enumerate().map(heat).collect(),
        ..HeatMap::default()
    };
    let point = |method, k: usize| ErrorPoint::new(k as f64, 90.0 + size(method, k), None);
    let curve = |(method, origin)| ErrorCurve::new(origin, (0..count(method)).map(|k| point(method, k)).collect());
    let coverage = ErrorCurves {
        x_title: "noise [°]".into(),
        y_scale: Scale::Linear,
        rows: vec!["coverage of K [%]".into()],
        cells: vec![ErrorCell { row: 0, column: 0, curves: methods().enumerate().map(curve).collect() }],
        reference: band,
        ..ErrorCurves::default()
    };
    let quiet = |mut curve: ErrorCurve| {
        curve.is_quiet = curve.origin != Origin::Method("output-error".into());
        curve.points.iter_mut().for_each(|point| point.beyond = point.y > 1e6);
        curve
    };
    let hero = ErrorCurves {
        title: Some("Output error is best".into()),
        cells: vec![ErrorCell { row: 0, column: 0, curves: methods().enumerate().map(curve).map(quiet).collect() }],
        marks: vec![AxisMark { at: 2.0, label: "IMO circular".into() }],
        names_at_lines: true,
        note: Some("Arrows: too large.".into()),
        ..coverage.clone()
    };
    let share = |row: usize, column: usize| ConfusionCell {
        share: if row == column { 90.0 } else { size(row, column) },
        interval: Some([80.0, 95.0]),
        is_right: row == column,
        is_alias: column == row + 1,
    };
    let confused = Confusion {
        columns: names.clone(),
        rows: (0..names.len())
            .map(|row| ConfusionRow {
                name: names[row].clone(),
                trials: 50,
                cells: (0..names.len()).map(|column| share(row, column)).collect(),
            })
            .collect(),
        ..Confusion::default()
    };
    let line = |scale: f64| {
        Curve::new(
            (0..n).map(|k| k as f64).collect::<Vec<_>>(),
            (0..n).map(|k| scale * if k == 1 { wild } else { (0.3 * k as f64).sin() }).collect::<Vec<_>>(),
        )
    };
    let look = Origin::After.look();
    let layers = |division| Layers {
        y: Ruler::new("moment [° rudder]", division),
        height: 0.2,
        zero: true,
        levels: vec![-0.1, 0.1],
        layers: vec![
            Layer::new("95 % band", line(0.8), Drawn::Band(line(1.2), look.colour, 0.2)),
            Layer::new("rows", line(1.05), Drawn::Dots(look.colour)),
            Layer::new("line", line(1.0), Drawn::Line(Pen::of(&Origin::Before))).within(0.5),
            Layer::new("shares", line(1.0), Drawn::Marks(look, vec![Some([0.0, 1.0]); n])),
        ],
    };
    let stack = |division, is_half| Stack {
        x: Ruler::new("yaw rate [°/s]", division),
        head: Some("explains 93 %".into()),
        mark: Some(0.5),
        is_half,
        zero: true,
        panels: vec![layers(division)],
    };
    let layered = Panels {
        title: Some("a record".into()),
        stacks: vec![
            stack(Division::Time, false),
            stack(Division::Decimal, true),
            stack(Division::Factors, true),
            stack(Division::Percent, true),
        ],
        mark_name: Some("period".into()),
        said: vec!["R² = 1".into()],
        note: Some("Rows: rates.".into()),
        cut: Some("Cut.".into()),
    };
    vec![
        ("panels", panels(&layered, theme)),
        ("dots", super::dots(&dot_plot, theme)),
        ("violins", violins(&Violins { title: None, panels: vec![violin_panel.clone(), violin_panel] }, theme)),
        ("scatter", scatter(&KtScatter { title: None, panels: methods().enumerate().map(cloud).collect() }, theme)),
        ("heat map", heat_map(&map, theme)),
        ("coverage", error_curves(&coverage, theme)),
        ("hero", error_curves(&hero, theme)),
        ("confusion", confusion(&confused, theme)),
    ]
}

#[test]
fn figures_are_well_formed_whatever_the_data() {
    for theme in [Theme::screen(), Theme::paper(85.0, 300.0).unwrap(), Theme::paper(60.0, 300.0).unwrap()] {
        for n in [0, 1, 2, 40] {
            for wild in [0.3, 0.0, 1e9, f64::NAN, f64::INFINITY] {
                for (name, figure) in all(n, wild, &theme) {
                    check(&format!("{name}, {n} values, {wild} among them, {} pt", theme.width), &figure);
                }
            }
        }
    }
}

#[test]
fn nothing_is_nothing() {
    let theme = Theme::screen();
    check("dots", &dots(&DotPlot::default(), &theme));
    check("violins", &violins(&Violins::default(), &theme));
    check("scatter", &scatter(&KtScatter::default(), &theme));
    check("heat map", &heat_map(&HeatMap::default(), &theme));
    check("panels", &panels(&Panels::default(), &theme));
}

#[test]
fn methods_keep_their_colours() {
    for (name, figure) in all(40, 0.3, &Theme::screen()) {
        let coloured = ["heat map", "panels", "confusion"].contains(&name) || figure.svg().contains("#009E73");
        assert!(coloured, "output-error in {name}");
    }
}

#[test]
fn what_lies_outside_is_said() {
    let figures = all(40, 1e9, &Theme::screen());
    let svg = |name: &str| figures.iter().find(|(known, _)| *known == name).unwrap().1.svg();
    assert!(svg("violins").contains("Arrows: beyond the axis."));
    assert!(svg("scatter").contains("2 of 40 outside") && svg("scatter").contains("no estimate"));
    assert!(svg("heat map").contains("\n–\n"), "a method without values");
}

#[test]
fn what_sets_no_axis_is_an_arrow_at_its_edge() {
    let theme = Theme::screen();
    let point = |x: f64, y: f64, beyond: bool| ErrorPoint { beyond, ..ErrorPoint::new(x, y, None) };
    let of = |method: &str, points| ErrorCurve::new(Origin::Method(method.into()), points);
    let curves = vec![
        of("output-error", vec![point(1.0, 0.1, false), point(2.0, 0.2, false)]),
        of("least-squares", vec![point(1.0, 1.0, false), point(2.0, 1e6, true)]),
    ];
    let data = ErrorCurves {
        rows: vec!["rms error of T [%]".into()],
        cells: vec![ErrorCell { row: 0, column: 0, curves }],
        ..ErrorCurves::default()
    };
    let svg = error_curves(&data, &theme);
    assert!(!svg.svg().contains("10⁶") && svg.svg().contains(">\n1\n"), "the axis ends with what is worth something");
}

#[test]
fn names_stand_at_the_lines_once_each() {
    let theme = Theme::screen();
    let figures = all(5, 0.3, &theme);
    let svg = figures.iter().find(|(name, _)| *name == "hero").expect("it is drawn").1.svg();
    for name in ["output-error", "least-squares", "IMO circular", "Output error is best"] {
        assert_eq!(svg.matches(&format!(">\n{name}\n")).count(), 1, "{name}");
    }
}
