//! The yaw moment that the base lacks on every fitted record: its table, its figure, and the sentence on it.

use std::fmt::Write as _;

use ::trace::analysis::Verdict;
use ::trace::missing_moment::{MissingMoment, Over, Panel};
use report::figures::{self, Banded, MomentPanel};
use report::number::significant;
use report::{Curve, Figure, Theme, symbol};
use serde::Serialize;
use ship::angle::to_deg;

use super::picture::slug;
use super::trace_report::TraceReport;
use crate::records::{file_of, names};

/// Panels of a figure at most.
const PANELS: usize = 4;

/// The missing moment of one record with the names of its files.
pub struct Shown<'a> {
    /// Number of the record.
    pub number: usize,
    /// Name of its files without an ending.
    pub stem: String,
    /// The moment.
    pub missing: &'a MissingMoment,
}

/// Every fitted record with enough headings.
pub fn shown<'a>(report: &'a TraceReport) -> Vec<Shown<'a>> {
    let slugs = names(report.names.iter().map(|name| slug(name)));
    let found = report.missing.iter().enumerate().filter_map(|(number, missing)| Some((number, missing.as_ref()?)));
    found
        .map(|(number, missing)| Shown { number, stem: format!("missing-moment-{}", slugs[number]), missing })
        .collect()
}

/// Name of a channel in a table, and its values there.
fn column(over: Over, values: &[f64]) -> (&'static str, Vec<f64>) {
    let (name, angle) = match over {
        Over::YawRate => ("yaw_rate_deg_s", true),
        Over::Rudder => ("rudder_deg", true),
        Over::Heading => ("heading_deg", true),
        Over::Speed => ("speed_m_s", false),
        Over::WindFrom => ("wind_relative_from_deg", true),
        Over::Sway => ("sway_m_s", false),
    };
    (name, values.iter().map(|&value| if angle { to_deg(value) } else { value }).collect())
}

fn degrees(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    values.into_iter().map(to_deg).collect()
}

/// The rows as CSV: moment with its band, and every channel that was recorded.
pub fn table(missing: &MissingMoment) -> String {
    let rows = 0..missing.time.len();
    let end = |k: usize| degrees(rows.clone().map(|row| missing.interval(row)[k]));
    let mut columns = vec![
        ("t_s", missing.time.clone()),
        ("moment_rudder_deg", degrees(missing.moment.iter().copied())),
        ("sd_rudder_deg", degrees(missing.sd.iter().copied())),
        ("lower95_rudder_deg", end(0)),
        ("upper95_rudder_deg", end(1)),
    ];
    columns.extend(missing.channels.iter().map(|(over, values)| column(*over, values)));
    let mut text = columns.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(",") + "\n";
    for row in rows {
        let values: Vec<String> = columns.iter().map(|(_, values)| format!("{:.6}", values[row])).collect();
        let _ = writeln!(text, "{}", values.join(","));
    }
    text
}

/// The explanation that is drawn: the named effects together, else the best candidate alone.
fn drawn(report: &TraceReport, missing: &MissingMoment) -> Option<String> {
    let ids = identifiers(missing, [0])?;
    Some(if report.analysis.explains_something() { ids } else { format!("best candidate: {ids}") })
}

/// Effects of some explanations, every one once.
fn identifiers(missing: &MissingMoment, places: impl IntoIterator<Item = usize>) -> Option<String> {
    let mut ids: Vec<&str> = Vec::new();
    for place in places {
        for (id, _) in missing.explanations.get(place).into_iter().flat_map(|one| &one.effects) {
            if !ids.contains(id) {
                ids.push(id);
            }
        }
    }
    (!ids.is_empty()).then(|| ids.join(", "))
}

fn title_of(over: Over) -> String {
    match over {
        Over::YawRate => format!("yaw rate {} [°/s]", symbol("r")),
        Over::Rudder => format!("rudder {} [°]", symbol("δ")),
        Over::Heading => format!("heading {} [°]", symbol("ψ")),
        Over::Speed => format!("speed {} [m/s]", symbol("U")),
        Over::WindFrom => String::from("relative wind from [° off the bow]"),
        Over::Sway => format!("sway velocity {} [m/s]", symbol("v")),
    }
}

fn percent(share: Option<f64>) -> String {
    match share {
        None => String::from("nothing to explain"),
        Some(share) if share > 0.99 => String::from("explains more than 99 %"),
        Some(share) => format!("explains {:.0} %", 100.0 * share),
    }
}

/// The figure of one record.
pub fn figure(report: &TraceReport, shown: &Shown, theme: &Theme) -> Figure {
    let missing = shown.missing;
    let known = drawn(report, missing);
    let over_time = |values: Vec<f64>| Curve::new(missing.time.clone(), values);
    let end = |k: usize| over_time(degrees((0..missing.time.len()).map(|row| missing.interval(row)[k])));
    let of_known = |curves: &[Vec<f64>]| known.as_ref().and(curves.first().cloned());
    let data = figures::MissingMoment {
        title: Some(format!("{}: yaw moment that the base lacks", report.names[shown.number])),
        time: Banded {
            middle: over_time(degrees(missing.moment.iter().copied())),
            lower: end(0),
            upper: end(1),
            known: of_known(&missing.explained).map(|values| over_time(degrees(values))),
        },
        panels: missing.panels.iter().take(PANELS).map(|panel| moment_panel(missing, panel, known.is_some())).collect(),
        known,
    };
    figures::missing_moment(&data, theme)
}

fn moment_panel(missing: &MissingMoment, panel: &Panel, known: bool) -> MomentPanel {
    let (_, rows) = missing
        .channels
        .iter()
        .find(|(over, _)| *over == panel.over)
        .map_or_else(|| ("", Vec::new()), |(over, values)| column(*over, values));
    let (_, x) = column(panel.over, &panel.curve.x);
    // A curve has mean zero over the rows; it is drawn where they are.
    let mean = missing.moment.iter().sum::<f64>() / missing.moment.len() as f64;
    let curve =
        |values: &mut dyn Iterator<Item = f64>| Curve::new(x.clone(), degrees(values.map(|value| value + mean)));
    let edges = || panel.curve.moment.iter().zip(&panel.curve.half_width);
    let others = panel.curve.others.first().filter(|_| known);
    MomentPanel {
        x_title: title_of(panel.over),
        head: match panel.curve.holds_nothing() {
            true => String::from("zero lies inside the band"),
            false => percent(panel.share),
        },
        rows: Curve::new(rows, degrees(missing.moment.iter().copied())),
        curve: Banded {
            middle: curve(&mut panel.curve.moment.iter().copied()),
            lower: curve(&mut edges().map(|(m, half)| m - half)),
            upper: curve(&mut edges().map(|(m, half)| m + half)),
            known: others.map(|other| curve(&mut other.iter().copied())),
        },
    }
}

/// Curves that are not zero throughout, the most likely first.
fn telling(missing: &MissingMoment) -> impl Iterator<Item = &Panel> + Clone {
    missing.panels.iter().filter(|panel| panel.share.is_some() && !panel.curve.holds_nothing())
}

/// Explanations inside the bands of all curves that tell something.
fn inside_all(missing: &MissingMoment) -> Vec<usize> {
    let holds = |place: &usize| telling(missing).all(|panel| panel.inside.contains(place));
    (0..missing.explanations.len()).filter(holds).collect()
}

/// Whether something is left unexplained and has the shape of no effect on the list.
fn is_unlisted(report: &TraceReport, missing: &MissingMoment) -> bool {
    let shows = telling(missing).next().is_some();
    shows && report.analysis.verdict == Verdict::Unexplained && inside_all(missing).is_empty()
}

/// What is said of the moment of one record.
pub fn sentence(report: &TraceReport, shown: &Shown) -> String {
    let missing = shown.missing;
    let mean_square = missing.moment.iter().map(|m| m * m).sum::<f64>() / missing.moment.len() as f64;
    let (name, size) = (&report.names[shown.number], significant(to_deg(mean_square.sqrt()), 2));
    let begin = format!("{name}: the base lacks a yaw moment of {size}° of rudder (rms)");
    let Some(best) = telling(missing).next() else {
        return format!("{begin}; over no channel does its curve leave the band about zero.");
    };
    let list = |places: &[usize]| {
        identifiers(missing, places.iter().copied()).unwrap_or_else(|| String::from("no effect on the list"))
    };
    let (over, share) = (best.over.as_str(), percent(best.share));
    let mut text = format!(
        "{begin}; its curve over the {over} {share} of its variance, and inside the band: {}",
        list(&best.inside)
    );
    let count = telling(missing).count();
    if count > 1 {
        let _ = write!(
            text,
            "; inside the bands of all {count} channels that show something: {}",
            list(&inside_all(missing))
        );
    }
    text + if is_unlisted(report, missing) { ". Unlisted, looks like this." } else { "." }
}

/// The moment of one record in `trace.json`.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct MissingMomentEntry {
    /// The record.
    file: String,
    /// The table of the smoothed moment.
    moment: String,
    /// Whether the verdict is unexplained and no effect lies inside the bands of all curves that show something.
    unlisted: bool,
    /// Curves over the channels, the most likely first.
    over: Vec<PanelEntry>,
}

/// One curve.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct PanelEntry {
    channel: &'static str,
    /// Share of the variance of its walk that the curve takes away.
    variance_share: Option<f64>,
    /// Whether the band leaves zero.
    shows: bool,
    /// Effects inside the band everywhere.
    inside: Vec<&'static str>,
}

/// The entries of all records.
pub fn entries(report: &TraceReport) -> Vec<MissingMomentEntry> {
    let of_panel = |missing: &MissingMoment, panel: &Panel| {
        let mut inside: Vec<&'static str> = Vec::new();
        let effects = panel.inside.iter().flat_map(|&place| &missing.explanations[place].effects);
        effects.for_each(|(id, _)| {
            if !inside.contains(id) {
                inside.push(id)
            }
        });
        PanelEntry {
            channel: panel.over.as_str(),
            variance_share: panel.share,
            shows: !panel.curve.holds_nothing(),
            inside,
        }
    };
    let entry = |one: Shown| MissingMomentEntry {
        file: file_of(&report.trials[one.number]).0.to_owned(),
        moment: format!("{}.csv", one.stem),
        unlisted: is_unlisted(report, one.missing),
        over: one.missing.panels.iter().map(|panel| of_panel(one.missing, panel)).collect(),
    };
    shown(report).into_iter().map(entry).collect()
}
