//! Every kind of figure with ordinary, empty, wild and damaged data: labels are present, coordinates are numbers,
//! strokes are visible, cuts are noted.

use super::*;
use crate::backend::UNITS_PER_POINT;
use crate::curve::PlotCurve;
use crate::palette::{self, CurveOrigin, CurveStyle, DASHED, HEADING, INK};
use crate::{Drawing, Theme};

/// Sine of `n` points with amplitude `size`; the second point is `wild`.
fn wave(n: usize, wild: f64, size: f64) -> PlotCurve {
    let x: Vec<f64> = (0..n).map(|k| 0.5 * k as f64).collect();
    let y = x.iter().enumerate().map(|(k, x)| if k == 1 { wild } else { size * (x / 20.0).sin() });
    PlotCurve { y: y.collect(), x }
}

fn methods() -> impl Iterator<Item = CurveOrigin> {
    palette::method_ids().map(|id| CurveOrigin::Method(id.to_owned()))
}

fn zigzag(n: usize, wild: f64) -> ZigZagPlot {
    let curve = wave(n, wild, 25.0);
    let mark = |t_s: f64| ZigZagMark { t_s, heading_deg: 25.0 * (t_s / 20.0).sin() };
    let some = |count: usize| if n > 0 { count } else { 0 };
    let overshoots = [
        OvershootMark { execute: mark(10.0), extremum: mark(31.0), angle_deg: 13.0 },
        OvershootMark { execute: mark(wild), extremum: mark(92.0), angle_deg: wild },
    ];
    let spans = [TimeSpan { from_s: 10.0, to_s: 31.0 }, TimeSpan { from_s: 80.0, to_s: wild }];
    ZigZagPlot {
        heading: curve.clone(),
        heading_as_points: n > 100,
        rudder: curve.clone(),
        truth: (n > 0).then_some(curve),
        executes: [mark(10.0), mark(90.0), mark(wild)][..some(3)].to_vec(),
        overshoots: overshoots[..some(2)].to_vec(),
        initial_turning: (n > 0).then_some(TimeSpan { from_s: 0.0, to_s: 10.0 }),
        check_yaw: spans[..some(2)].to_vec(),
        period: (n > 0).then_some(TimeSpan { from_s: 10.0, to_s: 95.0 }),
    }
}

/// Panels of every layer, small multiples, and a figure with names right of the frame.
fn panels(n: usize, wild: f64) -> Vec<(&'static str, Plot)> {
    let style = CurveOrigin::After.style();
    let points =
        |size: f64| (0..n).map(|k| (k as f64, if k == 1 { wild } else { size }, Some([0.5 * size, wild]))).collect();
    let layers = || {
        vec![
            Layer::band("95 % band", [wave(n, wild, 0.8), wave(n, 0.1, 1.2)], style.colour, 0.2),
            Layer::new("record", wave(n, 0.2, 1.0), LayerKind::Record),
            Layer::new("rows", wave(n, wild, 1.05), LayerKind::Dots(style.colour)),
            Layer::line("line", wave(n, wild, 1.0), Pen { dash: DASHED, ..Pen::from_origin(&CurveOrigin::Before) })
                .widening_at_most(0.5),
            Layer::marks("shares", style, points(0.7)),
        ]
    };
    let row = |tick_rule| PanelRow {
        dashed_levels: vec![-0.1, 0.1],
        reference: Some(ReferenceBand95 { value: 0.5, band: [0.4, 0.6] }),
        ..PanelRow::zeroed(AxisSpec::new("moment [° rudder]", tick_rule), 0.2)
    };
    let group = |tick_rule, is_half| {
        let mut group = PanelGroup::over(AxisSpec::new("yaw rate [°/s]", tick_rule), vec![(row(tick_rule), layers())]);
        group.panels[0].head = Some("explains 93 %".into());
        let vertical_lines = vec![AxisLine { value: 0.5, label: "period".into() }];
        PanelGroup { vertical_lines, is_half, has_zero_line: true, ..group }
    };
    let layered = Panels {
        groups: vec![
            group(TickRule::Time, false),
            group(TickRule::Decimal, true),
            group(TickRule::Logarithmic, true),
            group(TickRule::Percent, true),
        ],
        legend_texts: vec!["R² = 1".into()],
        clipping_note: Some("Cut.".into()),
        ..Panels::default()
    };
    let cloud = |(number, origin): (usize, CurveOrigin)| {
        let count = if number == 6 { 0 } else { n };
        let ellipse = PlotCurve::contour95(
            [0.1, 0.0],
            [[0.1, 0.05], [0.05, 0.1]].map(|row| row.map(|v: f64| v * (1 + number) as f64)),
        );
        let layers = vec![
            Layer::new("", wave(count, wild, 0.4), LayerKind::Cloud(origin.style().colour)),
            Layer::line("", ellipse, Pen::new(origin.style().colour)),
        ];
        LayeredPanel { head: Some(origin.label().into()), layers, ..LayeredPanel::default() }
    };
    let ruler = |title: &str| AxisSpec::decimal(title).limited_about_zero(2.2);
    let t_row = PanelRow::zeroed(ruler("error of T [%]"), 0.24);
    let clouds = PanelGroup::multiples(3, ruler("error of K [%]"), t_row, methods().enumerate().map(cloud).collect());
    let named = |(number, origin): (usize, CurveOrigin)| {
        let marks = Layer::marks(origin.label(), origin.style(), points(1.0 + number as f64));
        if number % 2 == 0 { marks.with_line(Pen::from_origin(&origin)) } else { marks.side_by_side() }
    };
    let marks = PanelGroup::over(
        ruler("noise [°]"),
        vec![(PanelRow { height: 0.3, ..row(TickRule::Logarithmic) }, methods().enumerate().map(named).collect())],
    );
    let ships = LayerKind::Ships(INK, vec![wild, 10.0]);
    let track = vec![
        Layer::line("drawn ships", wave(n, wild, 300.0), Pen::pale()).widening_at_most(0.35),
        Layer::line("most probable ship", wave(n, 3.0, 250.0), Pen::new(INK)),
        Layer::new("its heading", wave(n.min(2), wild, 250.0), ships),
    ];
    let northings = PanelRow::new(AxisSpec::decimal("north [m]"), 0.7);
    let track = PanelGroup::over(AxisSpec::decimal("east [m]"), vec![(northings, track)]);
    vec![
        ("layers", layered.into()),
        ("clouds", Panels::new(clouds).into()),
        ("aside", Panels { names_aside: true, ..Panels::new(marks) }.into()),
        ("track", Panels::new(PanelGroup { has_equal_scales: true, ..track }).into()),
    ]
}

/// Rows of every kind of item, and maps of both kinds.
fn rows_and_maps(n: usize, wild: f64) -> Vec<(&'static str, Plot)> {
    let size = |k: usize| if k == 1 { wild } else { 0.1 * (1 + k) as f64 };
    let items = |row: usize| {
        let marks =
            methods().map(|own| RowItem::mark_below(own.label(), own.style(), size(row), Some([0.0, 2.0 * size(row)])));
        let style = CurveStyle { is_hollow: row.is_multiple_of(2), ..CurveOrigin::After.style() };
        let others = [
            RowItem::new("90 %", RowKind::ThinInterval([size(row), 9.0])).clipped_if_far(),
            RowItem::new("50 %", RowKind::WideInterval(HEADING, [0.1, size(row)])),
            RowItem { number: Some("0.9".into()), ..RowItem::new("bar", RowKind::Bar(style, size(row))) },
            RowItem::new("limit", RowKind::Limit(size(row))),
            RowItem::new(
                "",
                RowKind::Violin(
                    style,
                    vec![(0.1, 0.0), (size(row), 1.0), (0.5, wild.min(3.0))],
                    [-size(row), -0.1, 0.0, 0.1, 0.2],
                ),
            ),
        ];
        marks.take(if row == 3 { 0 } else { 8 }).chain(others).collect::<Vec<RowItem>>()
    };
    let column = |x: AxisSpec, has_zero_line| RowsColumn {
        x,
        rows: (0..n.min(5)).map(items).collect(),
        has_zero_line,
        reference: Some(ReferenceBand95::line_at(1.0)),
        vertical_lines: vec![("truth".into(), Pen::new(INK), 0.2)],
        included_values: vec![-0.1],
    };
    let names: Vec<String> =
        (0..n.min(5)).map(|row| format!("orders at {row} °/s, a name of a row that is long")).collect();
    let rows = NamedRows {
        names_title: "rates [°/s]".into(),
        names: names.clone(),
        columns: vec![
            column(AxisSpec::new("rms error [%]", TickRule::Logarithmic), false),
            column(AxisSpec::decimal("coverage [%]").limited_around(4.0, Some(0.0)), true),
        ],
        shaded_rows: Some(("as fitted".into(), vec![0])),
        note: Some("Rates are those of the gear.".into()),
        ..NamedRows::default()
    };
    let cell = |x: usize, y: usize, empty: bool| MapCell {
        value: (!empty).then(|| size(x + y)),
        interval: Some([80.0, 95.0]),
        outline: if x == y { Some(Outline::Correct) } else { (x == y + 1).then_some(Outline::Alias) },
        trial_count: 0,
    };
    let map = |shades: Shades, count: usize| CellMap {
        axis_titles: ["rudder step [°]".into(), "heading step [°]".into()],
        columns: ["0", "0.1", "1"].map(str::to_owned).into(),
        rows: names.clone(),
        shades,
        panels: (0..count)
            .map(|panel| {
                let row = |y: usize| (0..3).map(|x| cell(x, y, panel == 6)).collect();
                (Some(format!("method {panel}")), (0..names.len()).map(row).collect())
            })
            .collect(),
        note: None,
    };
    vec![
        ("rows", rows.into()),
        ("map", map(Shades::Range(TickRule::Logarithmic, "rms error of K [%]".into()), 8).into()),
        ("shares", map(Shades::Shares, 1).into()),
    ]
}

fn all(n: usize, wild: f64, theme: &Theme) -> Vec<(&'static str, Drawing)> {
    let zigzag = vec![("zigzag", Plot::from(zigzag(n, wild)))];
    let plots = [zigzag, panels(n, wild), rows_and_maps(n, wild)].concat();
    plots.into_iter().map(|(name, plot)| (name, plot.draw("a < b", theme))).collect()
}

/// Every number of an attribute in the document.
fn numbers<'a>(svg: &'a str, attribute: &str) -> Vec<&'a str> {
    svg.split(&format!(" {attribute}=\"")).skip(1).filter_map(|tail| tail.split('"').next()).collect()
}

/// The document without the parts clipped at a frame.
fn uncut(svg: &str) -> String {
    let group = |piece: &str| match piece.split_once('>').is_some_and(|(head, _)| head.contains("clip-path")) {
        true => piece.split_once("</g>").map_or("", |(_, after)| after).to_owned(),
        false => format!("<g{piece}"),
    };
    svg.split("<g").map(group).collect()
}

/// Corners of all areas and lines in the document, in its units.
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

/// Requirements of every figure.
fn check(name: &str, figure: &Drawing) {
    let svg = figure.svg();
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}: undefined coordinate");
    let (width, height) = figure.size();
    let (right, bottom) = ((width * UNITS_PER_POINT) as i64 + 1, (height * UNITS_PER_POINT) as i64 + 1);
    for (x, y) in places(&uncut(svg)) {
        assert!((0..=right).contains(&x) && (0..=bottom).contains(&y), "{name}: {x},{y} is off the page");
    }
    // Minimum stroke width: 0.3 points.
    for stroke in numbers(svg, "stroke-width") {
        assert!(stroke.parse::<f64>().unwrap() >= 0.3 * UNITS_PER_POINT, "{name}: stroke {stroke}");
    }
    for size in numbers(svg, "font-size") {
        assert!(size.parse::<f64>().unwrap() >= 6.5 * UNITS_PER_POINT, "{name}: font size {size}");
    }
    assert!(resvg::usvg::Tree::from_str(svg, &resvg::usvg::Options::default()).is_ok(), "{name}: invalid SVG");
}

#[test]
fn figures_are_well_formed_whatever_the_data() {
    let are_drawn = |theme: &Theme, counts: &[usize], values: &[f64]| {
        for (&n, &wild) in counts.iter().flat_map(|n| values.iter().map(move |wild| (n, wild))) {
            for (name, figure) in all(n, wild, theme) {
                check(&format!("{name}, {n} points, {wild} among them, {} pt", theme.width), &figure);
            }
        }
    };
    are_drawn(&Theme::screen(), &[0, 1, 2, 40, 1000], &[0.3, 0.0, -0.3, 1e9, 1e300, f64::NAN, f64::INFINITY]);
    // There is less room on paper.
    for width in [85.0, 60.0] {
        are_drawn(&Theme::paper(width, 300.0).unwrap(), &[0, 40], &[0.3, 1e9, f64::NAN]);
    }
}

#[test]
fn nothing_is_nothing() {
    let theme = Theme::screen();
    check("panels", &Plot::from(Panels::default()).draw("", &theme));
    check("rows", &Plot::from(NamedRows::default()).draw("", &theme));
    check("zigzag", &Plot::from(ZigZagPlot::default()).draw("", &theme));
}

#[test]
fn constant_and_undefined_curves_are_drawn() {
    let theme = Theme::screen();
    for y in [0.0, 5.0, f64::NAN, f64::INFINITY, 1e300, -1e-300] {
        let curve = PlotCurve::new(vec![2.0; 4], vec![y; 4]);
        let layer = Layer::new("record", curve.clone(), LayerKind::Record);
        check("constant", &Plot::from(Panels::over_time(vec![(PanelRow::default(), vec![layer])])).draw("", &theme));
        let trial = ZigZagPlot { heading: curve.clone(), rudder: curve, ..ZigZagPlot::default() };
        check("constant", &Plot::from(trial).draw("", &theme));
    }
}

#[test]
fn labels_carry_symbol_and_unit() {
    let figures = all(200, 1.5, &Theme::screen());
    let svg = |name: &str| figures.iter().find(|(n, _)| *n == name).unwrap().1.svg();
    let italic = |s: &str| format!("<tspan font-style=\"italic\">{s}</tspan>");
    let symbols = [
        ("zigzag", format!("heading {} [°]", italic("ψ"))),
        ("zigzag", format!("rudder {} [°]", italic("δ"))),
        ("zigzag", format!("time {} [s]", italic("t"))),
        ("zigzag", format!("{}OS₁ = 13.0°", italic("ψ"))),
    ];
    for (name, text) in symbols {
        assert!(svg(name).contains(&text), "{text}");
    }
    for (name, text) in [
        ("zigzag", "a &lt; b"),
        ("zigzag", "period 85.0 s"),
        ("clouds", "no estimate"),
        ("map", "– is not defined."),
        ("shares", "mostly indistinguishable from it"),
        ("track", "drawn ships"),
        ("aside", "maximum-likelihood"),
    ] {
        assert!(svg(name).contains(text), "{text} in {name}");
    }
    for id in palette::method_ids() {
        assert_eq!(svg("aside").matches(&format!("\n{id}\n")).count(), 1, "{id}");
    }
    for name in ["clouds", "aside", "rows"] {
        assert!(svg(name).contains("#009E73"), "output-error in {name}");
    }
}

#[test]
fn what_runs_off_is_cut_and_says_so() {
    let drawn = |layers: Vec<Layer>, cut: &str| {
        let data = Panels {
            clipping_note: Some(cut.into()),
            ..Panels::over_time(vec![(PanelRow::new(AxisSpec::heading(), 0.2), layers)])
        };
        Plot::from(data).draw("", &Theme::screen()).svg().to_owned()
    };
    let band = |high: f64| {
        let line = |y: f64| PlotCurve::new([0.0, 1.0, 2.0], [-y, y, 0.0]);
        let band = Layer::band("90 %", [line(15.0), line(high)], INK, 0.2).widening_at_most(1.0);
        drawn(vec![band, Layer::line("ship", line(20.0), Pen::new(INK))], "It is cut.").contains("It is cut.")
    };
    assert!(band(1e4) && !band(25.0));
    let mut wild = wave(400, 0.0, 1.0);
    let dots = |curve: PlotCurve| drawn(vec![Layer::new("rows", curve, LayerKind::Dots(INK))], "");
    assert!(!dots(wild.clone()).contains("beyond a panel"));
    wild.y[200] = 500.0;
    assert!(dots(wild).contains("1 point lies beyond a panel"));
}

#[test]
fn large_type_leaves_a_heading_upright() {
    let style = crate::Style { font_size_pt: Some(16.0), ..Default::default() };
    let theme = style.apply_to(Theme::paper(60.0, 300.0).unwrap()).unwrap();
    let figure = Plot::from(zigzag(40, 0.3)).draw("", &theme);
    let ends: Vec<f64> = numbers(figure.svg(), "data-y")[0].split('|').skip(1).map(|x| x.parse().unwrap()).collect();
    assert!(ends[0] < -20.0 && ends[1] > 20.0 && ends[1] - ends[0] < 400.0, "{ends:?}");
}

#[test]
fn names_that_cannot_stand_side_by_side_are_turned() {
    let drawn = |name: &str| {
        let map = CellMap {
            axis_titles: ["named".into(), "missing".into()],
            columns: vec![name.into(); 12],
            rows: vec!["a".into()],
            shades: Shades::Shares,
            panels: vec![(None, vec![vec![MapCell { value: Some(50.0), ..MapCell::default() }; 12]])],
            note: None,
        };
        Plot::from(map).draw("", &Theme::screen()).svg().matches("text-anchor=\"end\" transform=\"rotate(270").count()
    };
    assert_eq!([drawn("b"), drawn("port_starboard_asymmetry")], [0, 12]);
}

#[test]
fn limits_make_room_for_their_labels() {
    let limits = [(String::from("heading ψ [°]"), [0.0, 1e-4])].into();
    let theme = crate::Style { limits, ..Default::default() }.apply_to(Theme::screen()).unwrap();
    let heading = vec![Layer::line("", wave(40, 0.3, 25.0), Pen::new(INK))];
    let draw = |theme: &Theme| {
        let figure = Plot::from(Panels::over_time(vec![(PanelRow::new(AxisSpec::heading(), 0.2), heading.clone())]))
            .draw("", theme);
        numbers(figure.svg(), "data-panel")[0].split(' ').next().unwrap().parse::<f64>().unwrap()
    };
    assert!(draw(&theme) > draw(&Theme::screen()) + 100.0);
}

#[test]
fn a_line_leaves_its_panel_where_it_does() {
    let line = |end: f64, pen| Layer::line("", PlotCurve::new([0.0, 1.0], [0.0, end]), pen);
    let layers = vec![line(1.0, Pen::new(INK)), line(10.0, Pen::new(palette::RUDDER)).widening_at_most(0.0)];
    let data = Panels::over_time(vec![(PanelRow::new(AxisSpec::decimal("y"), 0.2), layers)]);
    let svg = Plot::from(data).draw("", &Theme::screen()).svg().to_owned();
    let rise = |colour: &str| -> f64 {
        let path = svg.split(&format!("stroke=\"{colour}\" stroke-width=\"27\" d=\"")).nth(1).expect("a line");
        let steps = path.split(['l', '"']).nth(1).expect("its step");
        let [across, up] = [0, 1].map(|part| steps.split(' ').nth(part).unwrap().parse::<f64>().unwrap());
        up / across
    };
    let ratio = rise("#D55E00") / rise("#111111");
    assert!((ratio - 10.0).abs() < 0.05, "{ratio}");
    assert_eq!(svg.matches(" clip-path=\"url(#").count(), 1);
}

#[test]
fn what_sets_no_axis_is_an_arrow_at_its_edge() {
    let marks = |name: &str, far: f64| {
        let points = vec![(1.0, 0.1, None), (2.0, far, None)];
        Layer::marks(name, CurveOrigin::After.style(), points).with_line(Pen::new(INK))
    };
    let row = PanelRow::new(AxisSpec::new("rms error of T [%]", TickRule::Logarithmic), 0.3);
    let layers = vec![marks("output-error", 1.0), marks("least-squares", f64::INFINITY)];
    let data = Panels::new(PanelGroup::over(AxisSpec::decimal("noise [°]"), vec![(row, layers)]));
    let svg = Plot::from(data).draw("", &Theme::screen()).svg().to_owned();
    assert!(!svg.contains("10⁶") && svg.contains(">\n1\n"), "the axis ends with what is worth something");
    let far = |id: &str, k: f64| Layer::marks(id, CurveOrigin::Method(id.into()).style(), vec![(k, 160.0 * k, None)]);
    let answers = vec![far("output-error", 0.1), far("srivc", 0.101), far("least-squares", 0.099), far("x", 9.0)];
    let axis = |title: &str| AxisSpec::decimal(title).limited_around(4.0, None);
    let group = PanelGroup::over(axis("K [1/s]"), vec![(PanelRow::new(axis("T [s]"), 0.5), answers)]);
    let figure = Plot::from(Panels { names_aside: true, ..Panels::new(group) }).draw("", &Theme::screen());
    assert!(figure.svg().contains("Outside the axes: x (K = 9.00, T = 1440)."), "{}", figure.svg());
}

#[test]
fn a_metre_is_as_long_on_both_axes_of_a_track() {
    for theme in [Theme::screen(), Theme::paper(85.0, 300.0).unwrap(), Theme::paper(60.0, 300.0).unwrap()] {
        for (east, north) in [(700.0, 800.0), (5.0, 900.0), (9e4, 1.0), (2e-3, 1e-3)] {
            let angles = || (0..100).map(|k| 0.1 * f64::from(k));
            let x: Vec<f64> = angles().map(|a| east * (1.0 - a.cos())).collect();
            let curve = PlotCurve::new(x, angles().map(|a| north * a.sin()).collect::<Vec<_>>());
            let layers = vec![Layer::line("ship", curve, Pen::new(INK))];
            let rows = vec![(PanelRow::new(AxisSpec::decimal("north [m]"), 0.7), layers)];
            let group = PanelGroup { has_equal_scales: true, ..PanelGroup::over(AxisSpec::decimal("east [m]"), rows) };
            let figure =
                Plot::from(Panels { clipping_note: Some("Cut.".into()), ..Panels::new(group) }).draw("", &theme);
            let panel = numbers(figure.svg(), "data-panel")[0].split(' ').map(|side| side.parse::<f64>().unwrap());
            let sides: Vec<f64> = panel.skip(2).collect();
            let lengths = ["data-x", "data-y"].map(|axis| {
                let ends: Vec<f64> =
                    numbers(figure.svg(), axis)[0].split('|').skip(1).map(|end| end.parse().unwrap()).collect();
                ends[1] - ends[0]
            });
            let ratio = sides[0] / lengths[0] / (sides[1] / lengths[1]);
            assert!((ratio - 1.0).abs() < 2e-3 && !figure.svg().contains("Cut."), "{ratio}");
        }
    }
}

/// A record of several days has thousands of executes; with all of them marked, the file is too large to be drawn.
#[test]
fn a_zig_zag_of_very_many_executes_says_that_it_does_not_mark_them() {
    let mark = |k: usize| ZigZagMark { t_s: 0.05 * k as f64, heading_deg: 10.0 };
    let trial = |count: usize| ZigZagPlot {
        heading: wave(400, 0.0, 25.0),
        rudder: wave(400, 0.0, 25.0),
        executes: (0..count).map(mark).collect(),
        overshoots: (1..count).map(|k| OvershootMark { execute: mark(k), extremum: mark(k), angle_deg: 2.0 }).collect(),
        ..ZigZagPlot::default()
    };
    let [few, many] = [12, 3000].map(|count| Plot::from(trial(count)).draw("", &Theme::screen()).svg().to_owned());
    assert!(few.contains("overshoot") && !few.contains("too many"));
    assert!(many.contains("3000 executes: too many to be marked"));
    assert!(many.len() < few.len());
}
