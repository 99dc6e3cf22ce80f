//! Figures over all sets of measured records: errors before and after, and indices that change with the amplitude.

use campaign::statistics::grouped;
use identify::{Identifier, output_error};
use report::figures::{Division, Layer, NamedRows, PanelRow, Panels, RowItem, RowKind, RowsColumn, Ruler, Stack};
use report::palette::{BEFORE, Look, Marker, SOLID};
use report::{CurveOrigin, PageFigure, symbol};
use trial::{Quantity, Trial};

use super::analysis::{MeasuredAnalysis, ReplayError, WHOLE, WINDOWS_60_S};
use super::sets::{MeasuredSet, Outcome};

/// Errors on records that were held out, before and after, a row for each analysis.
pub fn before_after(analyses: &[MeasuredAnalysis]) -> PageFigure {
    let ship = |own: &&MeasuredAnalysis| {
        let set = own.set.name.split(',').next().unwrap_or_default();
        let basin = own.set.folder.rsplit('_').next().unwrap_or_default().to_uppercase();
        if set == "KVLCC2" { format!("{set}, {basin}") } else { set.to_owned() }
    };
    let ships = grouped(analyses, ship);
    let rows = |of: ReplayError| -> Vec<Vec<RowItem>> {
        let pair = |own: &MeasuredAnalysis| {
            let [before, after] = own.held_out(of);
            let base = Look { colour: BEFORE, marker: Marker::Circle, dash: SOLID, hollow: true };
            let traced = CurveOrigin::Method(String::from("trace"));
            vec![
                RowItem::new("", RowKind::Thin([before.min(after), before.max(after)])),
                RowItem::new(traced.label(), RowKind::Mark(traced.look(), after, None)),
                // Over it, so that both are seen where they coincide.
                RowItem::new("first-order base", RowKind::Mark(base, before, None)),
            ]
        };
        ships
            .iter()
            .flat_map(|(_, own)| [RowItem::heading()].into_iter().chain(own.iter().map(|own| pair(own))))
            .collect()
    };
    let column = |title: &str, of| RowsColumn {
        x: Ruler::new(title, Division::Factors),
        rows: rows(of),
        ..RowsColumn::default()
    };
    let is_better = |own: &&MeasuredAnalysis| {
        let [before, after] = own.held_out(WHOLE);
        after < before
    };
    let better = analyses.iter().filter(is_better).count();
    let all = analyses.len();
    let title = format!(
        "Whole replays of records that were not fitted: the traced model is better in {better} of {all} analyses"
    );
    let names = ships
        .iter()
        .flat_map(|(ship, own)| [format!("{ship}:")].into_iter().chain(own.iter().map(|own| short(&own.label))));
    let caption = "Heading error on records that were not fitted, of the best first-order base and of what was traced: whole \
                   replays, and replays restarted every 60 s. A row is one analysis; what was fitted stands at its left.";
    PageFigure::new(
        "held-out",
        caption,
        NamedRows {
            names: names.collect(),
            columns: vec![
                column("rms heading error, whole replay [°]", WHOLE),
                column("rms heading error, windows of 60\u{a0}s [°]", WINDOWS_60_S),
            ],
            title: Some(title),
            of: String::from("fitted: zig-zag (rudder/heading angle), or how many together"),
            note: Some(String::from(
                "Side of the first execute, or turns of the propeller a second. One mark: both coincide.",
            )),
        },
    )
}

/// A label in one line: how many records were fitted together, and what was held out.
fn short(label: &str) -> String {
    match label.strip_prefix("together: ") {
        Some(pool) => {
            let circles = if pool.contains("circles") { ", to circles" } else { "" };
            format!("{} together{circles}", pool.matches("zigzag_").count())
        }
        None => {
            let record = label.strip_prefix("zigzag_").unwrap_or_default();
            // HSVA: rudder and heading, all to starboard first.
            let angles = record.trim_end_matches("_s").split_once('_');
            let angles = angles.and_then(|(rudder, heading)| Some((rudder.parse().ok()?, heading.parse().ok()?)));
            let hsva = angles.map(|(rudder, heading): (u32, u32)| format!("{rudder}/{heading} starboard"));
            let words = || IN_WORDS.iter().find(|(known, _)| *known == record).map_or(label, |(_, words)| words);
            hsva.unwrap_or_else(|| words().to_owned())
        }
    }
}

/// Zig-zags in words: MARIN by the side of the first execute, Esso Osaka by the turns of the propeller.
const IN_WORDS: [(&str, &str); 9] = [
    ("20", "20/20 port"),
    ("-20", "20/20 starboard"),
    ("10", "10/10 port"),
    ("13_57_45", "20/20 at 15 1/s"),
    ("13_04_24", "20/20 at 16.7 1/s"),
    ("13_14_21", "30/30 at 16.7 1/s"),
    ("13_42_53", "30/30 at 10 1/s"),
    ("14_10_05", "20/20 at 12 1/s"),
    ("30_inter_xy", "zig-zag"),
];

/// K′, T′ and root mean square yaw rate r′ of one record.
struct PrimeIndex {
    rate: f64,
    indices: [(f64, Option<[f64; 2]>); 2],
}

/// First-order indices of a record by output error; `None` where it has none.
fn index(trial: &Trial) -> Option<PrimeIndex> {
    let own = trial.particulars()?;
    let estimate = output_error::Settings::default().build().ok()?.identify(std::slice::from_ref(trial)).ok()?;
    let rates: Vec<f64> = trial.yaw_rate()?.iter().copied().filter(|rate| rate.is_finite()).collect();
    let rms = (rates.iter().map(|rate| rate * rate).sum::<f64>() / rates.len() as f64).sqrt();
    // Where 1/T is below zero the ship is not stable on a straight course: T lies beyond every bound.
    let shown = |of: Quantity, factor: f64| match of.value > 0.0 {
        true => (of.value * factor, of.ci95.map(|ends| ends.map(|end| end * factor))),
        false => (f64::INFINITY, None),
    };
    let time = own.time();
    Some(PrimeIndex { rate: rms * time, indices: [shown(estimate.K(), time), shown(estimate.T(), 1.0 / time)] })
}

/// K′ and T′ of the records of some sets over the yaw rate in them.
///
/// Fails where a record cannot be read.
pub fn amplitude(sets: &[&MeasuredSet], scratch: &std::path::Path) -> Outcome<PageFigure> {
    let mut is_unstable = false;
    let mut rows = ["K", "T"].map(|name| {
        let ruler = Ruler::new(format!("{}′", symbol(name)), Division::Factors);
        (PanelRow::new(ruler, 0.24), Vec::new())
    });
    for (number, set) in sets.iter().enumerate() {
        let trials = set.records.iter().map(|record| set.read(record, scratch)).collect::<Outcome<Vec<_>>>()?;
        let found: Vec<PrimeIndex> = trials.iter().filter_map(index).collect();
        is_unstable |= found.iter().flat_map(|own| &own.indices).any(|(value, _)| value.is_infinite());
        let series = CurveOrigin::Series { label: set.name.to_owned(), number };
        for (place, (_, layers)) in rows.iter_mut().enumerate() {
            let points = found.iter().map(|own| (own.rate, own.indices[place].0, own.indices[place].1));
            layers.push(Layer::marks(series.label(), series.look(), points.collect()));
        }
    }
    let x = Ruler::decimal(format!("root mean square yaw rate {}′", symbol("r")));
    let arrow = match is_unstable {
        true => " An arrow: the record is best described by a ship that is unstable on a straight course.",
        false => "",
    };
    let caption = format!(
        "KVLCC2 has no K and T: first-order indices of single zig-zags, by output error with 95 % intervals (white noise: \
         they hold no error of the model), without dimension (L/U), over the yaw rate in the record.{arrow}"
    );
    let title = String::from("KVLCC2 has no K and T of her own: both change with the yaw rate of the zig-zag");
    let note = Some(String::from("A mark is a zig-zag. Bars: 95 % intervals."));
    let data = Panels { title: Some(title), note, ..Panels::of(Stack::over(x, rows.into())) };
    Ok(PageFigure::new("amplitude", caption, data))
}
