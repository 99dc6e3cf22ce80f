//! Figures of measured trials beside their predictions.

use report::figures::{
    Division, Layer, LayeredPanel, NamedRows, PanelRow, Panels, Pen, Reference95, RowItem, RowsColumn, Ruler, Stack,
};
use report::number::significant;
use report::palette::{BEFORE, DASHED, DIMENSION, HEADING, INK, Look, Marker, RUDDER, SOLID};
use report::{PageFigure, PlotCurve};
use ship::angle::to_deg;

use super::figure::{ForecastFigure, ForecastGroup, ForecastScore, KINDS};
use super::forecast::{PredictedSteady, PredictedTrack};
use super::turn::TurnTrack;

/// Drawn ships that a figure shows.
const SHOWN: usize = 40;

fn look(group: ForecastGroup) -> Look {
    let (colour, marker) = match group {
        ForecastGroup::Hsva => (HEADING, Marker::Circle),
        ForecastGroup::MarinOfOne => (RUDDER, Marker::Square),
        ForecastGroup::MarinOfAll => (DIMENSION, Marker::Diamond),
        ForecastGroup::Marin => (BEFORE, Marker::Up),
        ForecastGroup::EssoOsaka => (INK, Marker::Down),
    };
    Look { colour, marker, dash: SOLID, hollow: false }
}

/// Overshoots as predicted against measured ones, a panel for each group that has some.
pub fn overshoots(figures: &[ForecastFigure]) -> PageFigure {
    let of = |group: ForecastGroup| -> Vec<&ForecastFigure> {
        figures.iter().filter(|own| own.group == group && own.name.ends_with("overshoot_deg")).collect()
    };
    let largest = figures.iter().filter(|own| own.name.ends_with("overshoot_deg"));
    let largest = largest.map(|own| own.compared.measured).fold(0.0, f64::max) * 1.1;
    let panel = |group: ForecastGroup| {
        let marks = |name: &str, look: Look, is_wanted: fn(&ForecastFigure) -> bool| {
            let points = of(group).into_iter().filter(|own| is_wanted(own));
            let points = points
                .map(|own| (own.compared.measured, own.compared.interval.median, Some(own.compared.interval.ci90)));
            Layer::marks(name, look, points.collect())
        };
        let blue = Look { colour: HEADING, marker: Marker::Circle, dash: SOLID, hollow: false };
        let red = Look { colour: RUDDER, marker: Marker::Square, dash: SOLID, hollow: true };
        let line = PlotCurve::new([0.0, largest], [0.0, largest]);
        let layers = vec![
            marks("first overshoot", blue, |own| own.name.starts_with("first")),
            marks("later overshoots", red, |own| !own.name.starts_with("first")),
            Layer::line("predicted = measured", line, Pen { dash: DASHED, ..Pen::new(INK).width(0.8) }),
        ];
        LayeredPanel { head: Some(group.words().to_owned()), layers }
    };
    let groups = ForecastGroup::ALL.into_iter().filter(|group| !of(*group).is_empty());
    let row = PanelRow::new(Ruler::decimal("predicted overshoot [°]").within(2.0, None), 0.36);
    let stack = Stack::multiples(2, Ruler::decimal("measured overshoot [°]"), row, groups.map(panel).collect());
    let caption = "Overshoots of trials that were not fitted: predicted median with its 90 % interval against what was \
                   measured, one mark for every overshoot and model.";
    PageFigure::new("overshoots", caption, Panels::of(stack))
}

fn curve(track: &TurnTrack) -> PlotCurve {
    let (east, north) = track.curve();
    PlotCurve::new(east, north)
}

/// A circle from above.
pub fn track((number, own): (usize, &PredictedTrack)) -> PageFigure {
    let drawn = own.drawn.iter().take(SHOWN);
    let drawn = drawn.map(|(east, north)| PlotCurve::new(east.as_slice(), north.as_slice()));
    let mut layers: Vec<Layer> =
        drawn.map(|curve| Layer::line("drawn ships", curve, Pen::pale()).within(0.15)).collect();
    layers.push(Layer::line("measured", curve(&own.measured), Pen::new(INK).width(1.8)));
    let predicted = Pen { dash: DASHED, ..Pen::new(HEADING).width(1.4) };
    layers.push(Layer::line("most probable ship", curve(&own.probable), predicted));
    for (track, colour, hollow) in [(&own.measured, INK, false), (&own.probable, HEADING, true)] {
        let marks = [("heading changed by 90° (advance)", Marker::Up), ("by 180° (tactical diameter)", Marker::Square)];
        for ((name, marker), place) in marks.into_iter().zip(track.quarters()) {
            let look = Look { colour, marker, dash: SOLID, hollow };
            let name = if hollow { "" } else { name };
            layers.push(Layer::marks(name, look, place.iter().map(|(x, y)| (*x, *y, None)).collect()));
        }
    }
    let [measured, probable] = [&own.measured, &own.probable].map(TurnTrack::quarters);
    let both = |place: usize, of: fn((f64, f64)) -> f64| -> String {
        let shown = |found: Option<(f64, f64)>| found.map_or_else(String::new, |own| significant(of(own).abs(), 3));
        format!("{} L measured, {} L predicted", shown(measured[place]), shown(probable[place]))
    };
    let said =
        vec![format!("advance: {}", both(0, |own| own.1)), format!("tactical diameter: {}", both(1, |own| own.0))];
    let row = PanelRow::new(Ruler::decimal("north [L]"), 0.62);
    let stack = Stack { equal: true, ..Stack::over(Ruler::decimal("east [L]"), vec![(row, layers)]) };
    let caption = format!(
        "{}: a turning circle that was not fitted, from the execute on, in lengths of the ship; a current that the record \
         shows is taken out.",
        own.title
    );
    let data = Panels { title: Some(own.title.clone()), said, ..Panels::of(stack) };
    PageFigure::new(format!("circle-{}", number + 1), caption, data)
}

/// Steady turns of two ships.
pub fn steady(ships: &[PredictedSteady]) -> PageFigure {
    let stack = |own: &PredictedSteady| {
        let curve = |of: &predict::steady::SteadyCurve| {
            let [rudder, rate] = [&of.rudder, &of.yaw_rate].map(|values| values.iter().map(|own| to_deg(*own)));
            PlotCurve::new(rudder.collect::<Vec<f64>>(), rate.collect::<Vec<f64>>())
        };
        let drawn = own.curves.iter().skip(1).take(SHOWN);
        let mut layers: Vec<Layer> =
            drawn.map(|ship| Layer::line("drawn ships", curve(ship), Pen::pale()).within(0.2)).collect();
        layers.extend(
            own.curves.first().map(|ship| Layer::line("most probable ship", curve(ship), Pen::new(HEADING).width(1.3))),
        );
        let look = Look { colour: RUDDER, marker: Marker::Diamond, dash: SOLID, hollow: false };
        let points = own.measured.iter().map(|(rudder, rate)| (*rudder, *rate, None)).collect();
        layers.push(Layer::marks("measured circle", look, points));
        let row = PanelRow::zeroed(Ruler::yaw_rate(), 0.42);
        Stack { is_half: true, zero: true, ..Stack::over(Ruler::rudder(), vec![(row, layers)]) }
    };
    let stacks = ships.iter().map(stack).collect();
    let caption = "Steady turns: the yaw rate that belongs to every rudder angle, as drawn ships have it, and measured \
                   circles. Left KVLCC2 at full scale from HSVA's zig-zags, right Esso Osaka at 10 turns of the propeller \
                   a second, from each of five zig-zags.";
    PageFigure::new("steady-turns", caption, Panels { stacks, ..Panels::default() })
}

/// A value with its interval, where it has one.
type WithInterval = (f64, Option<[f64; 2]>);

/// Share that 90 % intervals hold beside their width, kind by kind.
pub fn coverage(figures: &[ForecastFigure]) -> PageFigure {
    let score = |group: ForecastGroup, kind| {
        let of: Vec<&ForecastFigure> =
            figures.iter().filter(|own| own.group == group && own.kind() == Some(kind)).collect();
        ForecastScore::of(&of)
    };
    let rows = |item: &dyn Fn(&ForecastScore) -> WithInterval| -> Vec<Vec<RowItem>> {
        let of_kind = |kind| {
            let marks = ForecastGroup::ALL.into_iter().filter_map(|group| {
                let (value, interval) = item(&score(group, kind)?);
                Some(RowItem::below(group.words(), look(group), value, interval))
            });
            marks.collect()
        };
        KINDS.into_iter().map(of_kind).collect()
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
    let names = KINDS.into_iter().map(|kind| kind.words.to_owned()).collect();
    let caption = "How often the 90 % interval holds what was measured, with the 95 % interval of that share (Wilson, as if \
                   all figures were independent), and the median width of the intervals.";
    PageFigure::new("coverage", caption, NamedRows { names, columns: vec![held, width], ..NamedRows::default() })
}
