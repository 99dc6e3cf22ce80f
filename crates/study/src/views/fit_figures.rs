//! Figures of a fit, from its document and its curves: every record with its characteristic points, with the replays of
//! all methods, and with one method over time; K and T of all methods, and of every record alone.

use document::fit::FitDocument;
use document::method::MethodEntry;
use document::names;
use document::single_records::{SingleRecord, SingleRecords};
use report::figures::{
    AxisSpec, Layer, LayerKind, LayeredPanel, PanelGroup, PanelRow, Panels, Pen, Plot, ReferenceBand95, TickRule,
};
use report::number::{counted, fixed, significant};
use report::palette::{CurveStyle, MODEL_BEFORE, Marker, SOLID};
use report::{CurveOrigin, PageFigure, PlotCurve, symbol};
use ship::Particulars;
use trial::Quantity;

use super::bench_figures::capital;
use super::record_figures::{ModelOverTime, over_time, rudder};
use super::{findings, study_figures};
use crate::documents::fit_curves::{FitCurves, FitRecord};

/// All figures, in the order of the page.
pub fn figures(document: &FitDocument, curves: &FitCurves) -> Vec<PageFigure> {
    let fitted: Vec<&FitRecord> = curves.records.iter().filter(|record| !record.validation).collect();
    let name = match fitted[..] {
        [only] => names::record_name(&only.name),
        _ => format!("{} records together", fitted.len()),
    };
    let caption = format!("{name}: K and T of every method with its intervals and regions.");
    let mut figures = vec![PageFigure::new("indices", agreement(document), caption, index_plane(document, curves))];
    figures.extend(document.single_records.as_ref().map(|all| {
        let caption = format!(
            "{name}: K and T of a first-order response fitted to every record alone, over the amplitude of its zig-zag."
        );
        let gain = |fit: &SingleRecord| (format!("rudder {}°", fixed(fit.amplitude.rudder_deg, 0)), fit.k_per_s.value);
        let finding = format!("Record by record {}", findings::range_phrase("K [1/s]", all.records.iter().map(gain)));
        PageFigure::new("amplitude", finding, caption, single_records(all, document))
    }));
    let shown = document.plotted_method();
    for (number, record) in curves.records.iter().enumerate() {
        figures.extend(of_record(record, if number == 0 { "" } else { &record.name }, shown));
    }
    figures
}

/// Relative tolerance for two estimates to agree.
const TOLERANCE: f64 = 0.1;

/// Finding: K and T of the shown method, and how many other methods agree.
fn agreement(document: &FitDocument) -> String {
    let answer = |entry: &MethodEntry| Some([entry.parameters?.k_per_s.value, entry.parameters?.t_s.value]);
    let shown = document.plotted_method();
    let (of_shown, other_answers): (Vec<_>, Vec<_>) =
        document.methods.iter().partition(|entry| Some(entry.method.as_str()) == shown);
    let Some([k, t]) = of_shown.first().and_then(|entry| answer(entry)) else {
        return String::from("No method answers");
    };
    let is_near =
        |[other_k, other_t]: &[f64; 2]| (other_k / k - 1.0).abs() < TOLERANCE && (other_t / t - 1.0).abs() < TOLERANCE;
    let agreeing = other_answers.iter().filter_map(|entry| answer(entry)).filter(is_near).count();
    format!(
        "{}: K = {} 1/s, T = {} s; {agreeing} of {} agree within {:.0} %",
        capital(shown.unwrap_or_default()),
        significant(k, 3),
        significant(t, 3),
        counted(other_answers.len() as u64, "other method"),
        100.0 * TOLERANCE
    )
}

/// Figures of a record; `suffix` ends their names, `shown` is the method whose fit has a figure of its own.
fn of_record(record: &FitRecord, suffix: &str, shown: Option<&str>) -> Vec<PageFigure> {
    let FitRecord { replays, rejected, .. } = record;
    let name = names::record_name(&record.name) + if record.validation { " (validation)" } else { "" };
    let figure = |kind: &str, finding: String, description: &str, plot: Plot| {
        let stem = if suffix.is_empty() { kind.to_owned() } else { format!("{kind}-{suffix}") };
        PageFigure::new(stem, finding, format!("{name}: {description}"), plot)
    };
    let mut figures = Vec::new();
    figures.extend(record.zigzag.as_ref().map(|data| {
        let description = "heading and rudder, with the characteristics of the zig-zag.";
        figure("trial", findings::zigzag_finding(data), description, data.clone().into())
    }));
    figures.extend(rejected.as_ref().map(|marks| {
        let description = "the record as read, with marks at readings that are left out or doubtful.";
        let count = marks.iter().map(|curve| curve.x.len() as u64).sum();
        let finding = format!("{} left out or doubtful", counted(count, "reading"));
        figure("raw", finding, description, raw(record, marks).into())
    }));
    let description = "the recorded rudder replayed with the answer of every method, and the heading errors.";
    figures.push(figure("replays", study_figures::replay_error_finding(replays), description, replays.panels().into()));
    let replay = replays.replays.iter().find(|replay| shown == Some(replay.origin.label()));
    let replay = replay.or_else(|| replays.replays.first());
    let extent = replays
        .record
        .finite_pairs()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (_, y)| [low.min(y), high.max(y)]);
    let finding = replay.and_then(|replay| {
        let (rms, swing) = (significant(replay.rms_deg?, 2), significant(extent[1] - extent[0], 2));
        Some(format!("{}: heading error {rms}° (rms) of a swing of {swing}°", capital(replay.origin.label())))
    });
    let model = replay.map(|replay| ModelOverTime {
        origin: replay.origin.clone(),
        heading: replay.heading.clone(),
        residual: replay.residual.clone(),
        rms_deg: replay.rms_deg,
        band: None,
    });
    let data = over_time(replays.record.clone(), record.rudder.clone(), model.into_iter().collect());
    let finding = finding.unwrap_or_else(|| String::from("No method answers"));
    figures.push(figure("fit", finding, "heading, residual and rudder with the replay of one method.", data.into()));
    figures
}

/// Record with marks at excluded or doubtful readings.
fn raw(record: &FitRecord, marks: &[PlotCurve; 2]) -> Panels {
    let style = CurveStyle { colour: MODEL_BEFORE, marker: Marker::Diamond, dash: SOLID, is_hollow: true };
    let marks = marks.each_ref().map(|curve| {
        Layer::marks("left out or doubtful", style, curve.pairs().map(|(time, value)| (time, value, None)).collect())
    });
    let [of_heading, of_rudder] = marks;
    let heading = Layer::new("recorded heading", record.replays.record.clone(), LayerKind::Record);
    let mut lower = rudder("recorded rudder", record.rudder.clone(), 0.16);
    lower.1.push(of_rudder);
    let rows = vec![(PanelRow::new(AxisSpec::heading(), 0.3), vec![heading, of_heading]), lower];
    Panels::over_time(rows)
}

/// Factors of K and T in a figure: to prime values if length and speed are known.
fn factors(ship: Option<Particulars>) -> [f64; 2] {
    ship.map_or([1.0; 2], |ship| [ship.prime_factor([-1, 0]), ship.prime_factor([1, 0])])
}

/// Titles of axes of K and T: prime if length and speed are known.
fn titles(ship: Option<Particulars>) -> [String; 2] {
    match ship {
        Some(_) => [symbol("K′"), symbol("T′")],
        None => [format!("{} [1/s]", symbol("K")), format!("{} [s]", symbol("T"))],
    }
}

/// Half range of an axis in median distances from the median; methods farther off are listed below the figure.
const PLANE_REACH: f64 = 4.0;

/// K and T of all methods with an estimate, with their joint 95 % regions.
fn index_plane(document: &FitDocument, curves: &FitCurves) -> Panels {
    let ship = document.particulars();
    let [by_k, by_t] = factors(ship);
    let scaled = |x: f64, y: f64| (by_k * x, by_t * y);
    let layers = |entry: &MethodEntry| -> Option<[Option<Layer>; 2]> {
        let estimates = entry.parameters.as_ref()?;
        let style = CurveOrigin::Method(entry.method.clone()).style();
        let pen = Pen { dash: style.dash, ..Pen::new(style.colour) };
        let region = curves.regions.get(&entry.method).map(|region| {
            let (x, y) = region.pairs().map(|(k, t)| scaled(k, t)).unzip();
            Layer::line("", PlotCurve { x, y }, pen)
        });
        let (k, t) = scaled(estimates.k_per_s.value, estimates.t_s.value);
        Some([region, Some(Layer::marks(entry.method.as_str(), style, vec![(k, t, None)]))])
    };
    let [k, t] = titles(ship).map(|title| AxisSpec::decimal(title).limited_around(PLANE_REACH, None));
    let layers = document.methods.iter().filter_map(layers).flatten().flatten().collect();
    let note = format!("Outlines hold {} and {} together with 95 %.", symbol("K"), symbol("T"));
    Panels {
        names_aside: true,
        note: (!curves.regions.is_empty()).then_some(note),
        ..Panels::new(PanelGroup::over(k, vec![(PanelRow::new(t, 0.5), layers)]))
    }
}

/// Maximum distance from zero, in medians, of a plotted value; a larger one is shown as an arrow.
const AMPLITUDE_REACH: f64 = 3.0;

/// K and T of every record alone over the amplitude of its zig-zag, with the joint estimate of all records.
fn single_records(all: &SingleRecords, document: &FitDocument) -> Panels {
    type Of = fn(&SingleRecord) -> Quantity;
    let ship = document.particulars();
    let joint = document.methods.iter().find(|entry| entry.method == all.method).and_then(|entry| entry.parameters);
    // Points are not joined: a cross or a star would hide its bar.
    let style = CurveStyle { marker: Marker::Circle, ..CurveOrigin::Method(all.method.clone()).style() };
    let name = format!("{}, every record alone, 95 %", all.method);
    let panel = |quantity: Of, factor: f64, amplitude: fn(&SingleRecord) -> f64| {
        let point = |record: &SingleRecord| {
            let value = quantity(record).scaled(factor);
            (amplitude(record), value.value, value.ci95)
        };
        let marks = Layer::marks(name.as_str(), style, all.records.iter().map(point).collect());
        LayeredPanel { head: None, layers: vec![marks.side_by_side()], ..LayeredPanel::default() }
    };
    let row = |title: String, joint: Option<Quantity>, factor: f64| {
        let joint = joint.map(|joint| joint.scaled(factor)).filter(|joint| joint.value.is_finite());
        PanelRow {
            reference: joint.map(|all| ReferenceBand95 { value: all.value, band: all.ci95.unwrap_or([all.value; 2]) }),
            ..PanelRow::new(AxisSpec::decimal(title).limited_around(AMPLITUDE_REACH, Some(0.0)), 0.3)
        }
    };
    let ([by_k, by_t], [k, t]) = (factors(ship), titles(ship));
    let x = [format!("rudder {} [°]", symbol("δ")), format!("peak heading {} [°]", symbol("ψ"))];
    let amplitudes: [fn(&SingleRecord) -> f64; 2] = [|fit| fit.amplitude.rudder_deg, |fit| fit.amplitude.heading_deg];
    let mut panels: Vec<LayeredPanel> = amplitudes.map(|of_axis| panel(|fit| fit.k_per_s, by_k, of_axis)).into();
    panels.extend(amplitudes.map(|of_axis| panel(|fit| fit.t_s, by_t, of_axis)));
    let rows = vec![row(k, joint.map(|fit| fit.k_per_s), by_k), row(t, joint.map(|fit| fit.t_s), by_t)];
    let group = PanelGroup {
        x: x.map(|title| AxisSpec::new(title, TickRule::Angle)).into(),
        rows,
        panels,
        ..PanelGroup::default()
    };
    let note = joint.map(|_| String::from("Line and grey band: all records together, 95 %."));
    Panels { note, ..Panels::new(group) }
}
