//! Figures of measured trials beside their predictions.

use campaign::statistics::grouped;
use estimation::statistics::median;
use report::figures::{
    Division, Layer, LayerKind, LayeredPanel, NamedRows, PanelRow, Panels, Pen, Reference95, RowItem, RowKind,
    RowsColumn, Ruler, Stack,
};
use report::number::{fixed, significant};
use report::palette::{DASHED, HEADING, INK, Look, Marker, RECORD, RUDDER, SOLID};
use report::{CurveOrigin, PageFigure, PlotCurve};
use ship::angle::to_deg;

use super::figure::{FigureKind, ForecastFigure, ForecastGroup, ForecastScore, KINDS};
use super::forecast::{PredictedRate, PredictedSteady, PredictedTrack};
use super::turn::TurnTrack;

/// Largest rudder of steady turns that is drawn, degrees.
const LARGEST: f64 = 38.1;

/// Drawn ships that a figure shows.
const SHOWN: usize = 20;

/// Fewest figures whose share is drawn.
const FEWEST: usize = 5;

/// The predictions of one overshoot by all models of a group.
struct PredictedOvershoot<'a> {
    group: ForecastGroup,
    is_first: bool,
    /// In the order of what they predict.
    models: Vec<&'a ForecastFigure>,
}

impl<'a> PredictedOvershoot<'a> {
    fn of(mut models: Vec<&'a ForecastFigure>) -> Self {
        models.sort_by(|one, other| one.compared.interval.median.total_cmp(&other.compared.interval.median));
        Self { group: models[0].group, is_first: models[0].name.starts_with("first"), models }
    }

    /// What was measured, and the middle prediction with its interval.
    fn middle(&self) -> (f64, f64, Option<[f64; 2]>) {
        let own = &self.models[self.models.len() / 2].compared;
        (own.measured, own.interval.median, Some(own.interval.ci90))
    }
}

/// The overshoots in the order of their names.
fn by_overshoot(figures: &[ForecastFigure]) -> Vec<PredictedOvershoot<'_>> {
    let wanted = figures.iter().filter(|own| own.name.ends_with("overshoot_deg"));
    let own = grouped(wanted, |own| (own.group.words(), own.trial, own.name.as_str()));
    own.into_iter().map(|(_, models)| PredictedOvershoot::of(models)).collect()
}

/// Median sizes of the errors of first and of later overshoots of a group over all models.
fn errors(overshoots: &[PredictedOvershoot], group: ForecastGroup) -> [f64; 2] {
    [true, false].map(|is_first| {
        let own = overshoots.iter().filter(|own| own.group == group && own.is_first == is_first);
        let mut sizes: Vec<f64> = own.flat_map(|own| &own.models).map(|own| own.error().abs()).collect();
        median(&mut sizes).unwrap_or(f64::NAN)
    })
}

/// Overshoots as predicted against measured ones, a panel for each group that has some.
pub fn overshoots(figures: &[ForecastFigure]) -> PageFigure {
    let overshoots = by_overshoot(figures);
    let largest = overshoots.iter().map(|own| own.middle().0).fold(0.0, f64::max) * 1.1;
    let panel = |group: ForecastGroup| {
        let of = |is_first: bool| overshoots.iter().filter(move |own| own.group == group && own.is_first == is_first);
        let marks =
            |name: &str, look: Look, is_first| Layer::marks(name, look, of(is_first).map(|own| own.middle()).collect());
        let every =
            [true, false].into_iter().flat_map(of).filter(|own| own.models.len() > 1).flat_map(|own| &own.models);
        let (x, y) = every.map(|own| (own.compared.measured, own.compared.interval.median)).unzip();
        let blue = Look { colour: HEADING, marker: Marker::Circle, dash: SOLID, hollow: false };
        let red = Look { colour: RUDDER, marker: Marker::Square, dash: SOLID, hollow: true };
        let line = PlotCurve::new([0.0, largest], [0.0, largest]);
        let layers = vec![
            marks("later overshoots", red, false),
            Layer::new("from single records", PlotCurve { x, y }, LayerKind::Dots(RECORD)).within(0.1),
            marks("first overshoot", blue, true),
            Layer::line("predicted = measured", line, Pen { dash: DASHED, ..Pen::new(INK).width(0.8) }),
        ];
        let [first, later] = errors(&overshoots, group).map(|size| significant(size, 2));
        let words = group.words().trim_start_matches("KVLCC2: ");
        LayeredPanel { head: Some(format!("{words}: first\u{a0}{first}°, later\u{a0}{later}°")), layers }
    };
    let groups = ForecastGroup::ALL.into_iter().filter(|group| overshoots.iter().any(|own| own.group == *group));
    let groups: Vec<ForecastGroup> = groups.collect();
    let row = PanelRow::new(Ruler::decimal("predicted overshoot [°]").within(2.0, None), 0.28);
    let stack =
        Stack::multiples(3, Ruler::decimal("measured overshoot [°]"), row, groups.iter().copied().map(panel).collect());
    let caption = "Overshoots of trials that were not fitted, predicted against measured: medians from every single record as \
                   dots, the middle one of them as a mark with its 90 % interval.";
    let marin = groups.iter().filter(|group| **group != ForecastGroup::Hsva);
    let marin = marin.map(|group| errors(&overshoots, *group)[0]);
    let (least, most) = (marin.clone().fold(f64::INFINITY, f64::min), marin.fold(0.0, f64::max));
    let [hsva, least, most] =
        [errors(&overshoots, ForecastGroup::Hsva)[0], least, most].map(|size| significant(size, 2));
    let title =
        format!("KVLCC2: first overshoots off by {hsva}° in the median at HSVA, by {least} to {most}° at MARIN");
    let note = "Degrees: median errors. Bars: 90 % intervals.";
    let data = Panels { title: Some(title), note: Some(note.to_owned()), ..Panels::of(stack) };
    PageFigure::new("overshoots", caption, data)
}

fn curve(track: &TurnTrack) -> PlotCurve {
    let (east, north) = track.curve();
    PlotCurve::new(east, north)
}

/// A circle from above, the one of this number.
pub fn track(number: usize, own: &PredictedTrack) -> PageFigure {
    let drawn = own.drawn.iter().take(SHOWN);
    let drawn = drawn.map(|(east, north)| PlotCurve::new(east.as_slice(), north.as_slice()));
    let mut layers: Vec<Layer> =
        drawn.map(|curve| Layer::line("drawn ships", curve, Pen::pale()).within(0.15)).collect();
    layers.push(Layer::line("measured", curve(&own.measured), Pen::new(INK).width(1.8)));
    let predicted = Pen { dash: DASHED, ..Pen::new(HEADING).width(1.4) };
    layers.push(Layer::line("most probable ship", curve(&own.probable), predicted));
    let [measured, probable] = [&own.measured, &own.probable].map(TurnTrack::quarters);
    let both = |place: usize, of: fn((f64, f64)) -> f64| -> String {
        let shown = |found: Option<(f64, f64)>| found.map_or_else(String::new, |own| significant(of(own).abs(), 3));
        format!("{} L, predicted {} L (hollow)", shown(measured[place]), shown(probable[place]))
    };
    let names = [format!("advance: {}", both(0, |own| own.1)), format!("tactical diameter: {}", both(1, |own| own.0))];
    for (quarters, colour, hollow) in [(measured, INK, false), (probable, HEADING, true)] {
        for ((name, marker), place) in names.iter().zip([Marker::Up, Marker::Square]).zip(quarters) {
            let look = Look { colour, marker, dash: SOLID, hollow };
            let name = if hollow { "" } else { name };
            layers.push(Layer::marks(name, look, place.iter().map(|(x, y)| (*x, *y, None)).collect()));
        }
    }
    let row = PanelRow::new(Ruler::decimal("north [L]"), 0.62);
    let stack = Stack { equal: true, ..Stack::over(Ruler::decimal("east [L]"), vec![(row, layers)]) };
    let side = if own.rudder_deg < 0.0 { "port" } else { "starboard" };
    let what = format!("{}: {:.0}° circle to {side}", own.title, own.rudder_deg.abs());
    // The tactical diameter lies across the approach.
    let excess = measured[1].zip(probable[1]).map(|(measured, probable)| 100.0 * (probable.0 / measured.0 - 1.0));
    let words = |own: f64| format!(", diameter {:.0} % too {}", own.abs(), if own < 0.0 { "small" } else { "large" });
    let title = format!("{what}{}", excess.map_or_else(String::new, words));
    let caption = format!(
        "{what}. A turning circle that was not fitted, from the execute on, in lengths of the ship; a current that the \
         record shows is taken out. Steps in the measured track are those of positions that the record has with three \
         digits."
    );
    let data = Panels { title: Some(title), ..Panels::of(stack) };
    PageFigure::new(format!("circle-{}", number + 1), caption, data)
}

/// Steady turns of two ships.
pub fn steady(ships: &[PredictedSteady]) -> PageFigure {
    let stack = |own: &PredictedSteady| {
        let curve = |of: &predict::steady::SteadyCurve| {
            let points = of.rudder.iter().zip(&of.yaw_rate).map(|(rudder, rate)| (to_deg(*rudder), to_deg(*rate)));
            let (x, y) = points.filter(|(rudder, _)| rudder.abs() <= LARGEST).unzip();
            PlotCurve { x, y }
        };
        let drawn = own.drawn.iter().map(|ship| Layer::line("drawn ships", curve(ship), Pen::pale()).within(0.2));
        let probable = own
            .probable
            .iter()
            .map(|ship| Layer::line("most probable ship of a model", curve(ship), Pen::new(HEADING).width(1.3)));
        let mut layers: Vec<Layer> = drawn.chain(probable).collect();
        let look = Look { colour: RUDDER, marker: Marker::Diamond, dash: SOLID, hollow: false };
        let points = own.measured.iter().map(|(rudder, rate)| (*rudder, *rate, None)).collect();
        layers.push(Layer::marks("measured circle", look, points));
        let panels = vec![LayeredPanel { head: Some(own.title.clone()), layers }];
        let rows = vec![PanelRow::zeroed(Ruler::yaw_rate(), 0.42)];
        // As far to either side, whatever is cut.
        let x = vec![Ruler::rudder().about_zero(f64::MAX)];
        Stack { x, rows, panels, is_half: true, zero: true, ..Stack::default() }
    };
    let stacks = ships.iter().map(stack).collect();
    let caption = "Steady turns: the yaw rate that belongs to every rudder angle up to 38°, as the most probable ship of each \
                   model and drawn ships have it, and measured circles, those of the Esso Osaka at 10 turns of the \
                   propeller a second. A line ends where the ship has no faster steady turn.";
    let left_out: usize = ships.iter().map(|own| own.left_out).sum();
    let note = format!("Models with which no circle could be sailed are left out: {left_out}.");
    let title = String::from("Steady turns of drawn ships and measured circles");
    PageFigure::new(
        "steady-turns",
        caption,
        Panels { title: Some(title), stacks, note: (left_out > 0).then_some(note), ..Panels::default() },
    )
}

/// Yaw rates of measured circles as every model predicts them, row by row.
pub fn rates(ships: &[PredictedSteady]) -> PageFigure {
    let look = |inside: bool| Look { colour: HEADING, marker: Marker::Circle, dash: SOLID, hollow: !inside };
    let row = |own: &PredictedRate| {
        let name = if own.inside { "holds the measured rate" } else { "does not hold it" };
        vec![RowItem::new(name, RowKind::Mark(look(own.inside), own.ratio, Some(own.ci90)))]
    };
    let rows = ships.iter().flat_map(|ship| [RowItem::heading()].into_iter().chain(ship.circles.iter().map(row)));
    let rudder = |own: &PredictedRate| format!("{}°", fixed(own.rudder_deg, 0));
    let names =
        ships.iter().flat_map(|ship| [format!("{}:", ship.title)].into_iter().chain(ship.circles.iter().map(rudder)));
    let all = || ships.iter().flat_map(|ship| &ship.circles);
    let column = RowsColumn {
        x: Ruler::new("predicted / measured yaw rate", Division::Factors),
        rows: rows.collect(),
        reference: Some(Reference95::line(1.0)),
        ..RowsColumn::default()
    };
    let data = NamedRows {
        title: Some(format!(
            "Steady turns: {} of {} intervals hold the measured yaw rate",
            all().filter(|own| own.inside).count(),
            all().count()
        )),
        of: String::from("rudder angle of a circle [°], each mark from one model"),
        names: names.collect(),
        columns: vec![column],
        note: Some(String::from("Bars: 90 % intervals.")),
    };
    PageFigure::new(
        "turn-rates",
        "The yaw rates of these circles as each model predicts them, over what was measured.",
        data,
    )
}

/// A value with its interval, where it has one.
type WithInterval = (f64, Option<[f64; 2]>);

/// Share that 90 % intervals hold beside their width, kind by kind.
pub fn coverage(figures: &[ForecastFigure]) -> PageFigure {
    let score = |group: ForecastGroup, kind| {
        let of: Vec<&ForecastFigure> =
            figures.iter().filter(|own| own.group == group && own.kind() == Some(kind)).collect();
        ForecastScore::of(&of).filter(|score| score.count >= FEWEST)
    };
    // Of zig-zags and of circles what all their intervals hold, the kinds that are judged, and counts.
    let parts = [("zig-zags", false), ("circles", true)].map(|(name, is_circle)| {
        let is_of = |own: &&ForecastFigure| own.kind().is_some() && own.trial.starts_with("turn") == is_circle;
        let own: Vec<&ForecastFigure> = figures.iter().filter(is_of).collect();
        let is_there = |kind: &FigureKind| own.iter().any(|own| own.kind() == Some(*kind));
        let inside = own.iter().filter(|own| own.compared.inside90).count();
        let share = fixed(100.0 * inside as f64 / own.len().max(1) as f64, 0);
        let kinds: Vec<FigureKind> = KINDS.into_iter().filter(is_there).collect();
        (format!("{name} {share} %"), kinds, [inside, own.len()])
    });
    let rows = |item: &dyn Fn(&ForecastScore) -> WithInterval| -> Vec<Vec<RowItem>> {
        let of_kind = |kind| {
            let marks = ForecastGroup::ALL.into_iter().enumerate().filter_map(|(number, group)| {
                let (value, interval) = item(&score(group, kind)?);
                let series = CurveOrigin::Series { label: group.words().to_owned(), number };
                Some(RowItem::below(series.label(), series.look(), value, interval))
            });
            marks.collect()
        };
        let part =
            |kinds: &[FigureKind]| [vec![RowItem::heading()], kinds.iter().copied().map(of_kind).collect()].concat();
        parts.iter().flat_map(|(_, kinds, _)| part(kinds)).collect()
    };
    let held = RowsColumn {
        x: Ruler::decimal("held by the 90 % interval [%]"),
        rows: rows(&|own| (own.held.value, own.held.ci95)),
        reference: Some(Reference95 { value: 90.0, band: [85.0, 95.0] }),
        zero: true,
        ..RowsColumn::default()
    };
    let width = RowsColumn {
        x: Ruler::new("width [% of the value]", Division::Factors),
        rows: rows(&|own| (100.0 * own.relative_width, None)),
        ..RowsColumn::default()
    };
    let named = parts.iter().flat_map(|(held, kinds, _)| {
        [format!("{held}:")].into_iter().chain(kinds.iter().map(|kind| kind.words.to_owned()))
    });
    let names = named.collect();
    let caption = format!(
        "How often the 90 % interval holds what was measured, with the 95 % interval of that share (Wilson, as if all \
         figures were independent), and the median width of the intervals. Grey: 85 to 95 %, which was to be reached. \
         What rests on fewer than {FEWEST} figures is left out."
    );
    let [inside, all] = [0, 1].map(|place| parts.iter().map(|(.., counts)| counts[place]).sum::<usize>());
    let [(zig_zags, ..), (circles, ..)] = &parts;
    let title = format!("90 % intervals hold {inside} of {all} predicted figures: of {zig_zags}, of {circles}");
    let note = format!("{all} figures; a mark rests on {FEWEST} or more. Grey: 85 to 95 %. Bars: 95 % intervals.");
    let (title, note) = (Some(title), Some(note));
    let data = NamedRows { title, names, columns: vec![held, width], note, ..NamedRows::default() };
    PageFigure::new("coverage", caption, data)
}
