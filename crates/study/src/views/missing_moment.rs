//! The yaw moment that the base lacks on every fitted record: its figure, and the sentence on it.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use report::figures::{Layer, LayerKind, PanelRow, Panels, Pen, Ruler, Stack};
use report::number::significant;
use report::palette::{HEADING, RECORD, RUDDER, SHORT_DASH};
use report::{PlotCurve, symbol};

use crate::documents::missing_moment::MissingMomentEntry;

/// Panels of a figure at most.
const PANELS: usize = 4;

/// Times the usual size at which a moment is cut over time, and over a channel: a jump would set the axis.
const REACHES: [f64; 2] = [8.0, 2.5];

/// Title of an axis over a channel.
fn title_of(column: &str) -> String {
    match column {
        "yaw_rate_deg_s" => format!("yaw rate {} [°/s]", symbol("r")),
        "rudder_deg" => format!("rudder {} [°]", symbol("δ")),
        "heading_deg" => format!("heading {} [°]", symbol("ψ")),
        "speed_m_s" => format!("speed {} [m/s]", symbol("U")),
        "sway_m_s" => format!("sway velocity {} [m/s]", symbol("v")),
        _ => String::from("relative wind from [° off the bow]"),
    }
}

fn percent(share: Option<f64>) -> String {
    match share {
        None => String::from("nothing to explain"),
        Some(share) if share > 0.99 => String::from("explains more than 99 % of the variance"),
        Some(share) if share < 0.01 => String::from("explains less than 1 % of the variance"),
        Some(share) => format!("explains {:.0} % of the variance", 100.0 * share),
    }
}

/// A table that was read.
type MomentTable = BTreeMap<String, Vec<f64>>;

/// A column of a table; empty where there is none.
fn values(table: &MomentTable, name: &str) -> Vec<f64> {
    table.get(name).cloned().unwrap_or_default()
}

/// The moment with its band, and what the known explanation makes of it.
fn banded(known: Option<&String>, [middle, lower, upper]: [PlotCurve; 3], explained: PlotCurve) -> Vec<Layer> {
    let dashed = Pen { dash: SHORT_DASH, ..Pen::new(RUDDER) };
    let mut layers = vec![
        Layer::band("95 % band", [lower, upper], HEADING, 0.2).within(0.3),
        Layer::line("missing moment (over a channel: its curve)", middle, Pen::new(HEADING)),
    ];
    let together = |names: &String| if names.contains(", ") { format!("{names} together") } else { names.clone() };
    layers.extend(known.map(|names| Layer::line(together(names), explained, dashed)));
    layers
}

/// The figure of one record, from its tables over time and over the channels.
pub fn figure(entry: &MissingMomentEntry, [time, channels]: &[MomentTable; 2]) -> Panels {
    let known = entry.explanation.as_ref();
    let over = |x: Ruler, height: f64, reach: f64, layers: Vec<Layer>| {
        let moment = Ruler::decimal("moment [° rudder]").within(reach, Some(0.0));
        Stack::over(x, vec![(PanelRow::zeroed(moment, height), layers)])
    };
    let over_time = |name: &str| PlotCurve::new(values(time, "t_s"), values(time, name));
    let ends = ["moment_rudder_deg", "lower95_rudder_deg", "upper95_rudder_deg"].map(over_time);
    let moment = banded(known, ends, over_time("explained_rudder_deg"));
    let mut stacks = vec![over(Ruler::time(), 0.24, REACHES[0], moment)];
    let (shown, others): (Vec<_>, Vec<_>) = entry.over.iter().partition(|own| own.shows);
    stacks.extend(shown.iter().take(PANELS).map(|own| {
        let name = &own.column;
        let of = |what: &str| values(channels, &format!("{name}_{what}_rudder_deg"));
        let curve = |y: Vec<f64>| PlotCurve::new(values(channels, name), y);
        let (moment, half) = (of("moment"), of("half_width95"));
        let edge = |side: f64| curve(moment.iter().zip(&half).map(|(m, half)| m + side * half).collect());
        let rows = PlotCurve::new(values(time, name), values(time, "moment_rudder_deg"));
        let mut layers = vec![Layer::new("its smoothed rows", rows, LayerKind::Dots(RECORD)).within(0.1)];
        layers.extend(banded(known, [curve(moment.clone()), edge(-1.0), edge(1.0)], curve(of("explained"))));
        let mut stack = over(Ruler::decimal(title_of(name)), 0.2, REACHES[1], layers);
        (stack.panels[0].head, stack.is_half) = (Some(percent(own.variance_share)), true);
        stack
    }));
    let others: Vec<&str> = others.iter().map(|own| own.channel.as_str()).collect();
    let others = match others.is_empty() {
        true => String::new(),
        false => format!(" Not drawn, because zero lies inside the band: {}.", others.join(", ")),
    };
    let note = Some(format!("Moments beyond {} times the usual size are cut.{others}", REACHES[1]));
    let title = Some(format!("{}: yaw moment that the base lacks", entry.record));
    Panels { title, stacks, note, ..Panels::default() }
}

/// What is said of the moment of one record.
pub fn sentence(entry: &MissingMomentEntry) -> String {
    let (name, size) = (&entry.record, significant(entry.rms_rudder_deg, 2));
    let begin = format!("{name}: the base lacks a yaw moment of {size}° of rudder (rms)");
    let telling = || entry.over.iter().filter(|panel| panel.shows && panel.variance_share.is_some());
    let Some(best) = telling().next() else {
        return format!("{begin}; it depends on no recorded channel.");
    };
    let list = |ids: &[String]| if ids.is_empty() { "no effect on the list".to_owned() } else { ids.join(", ") };
    let (over, share) = (&best.channel, percent(best.variance_share));
    let mut text = format!("{begin}; its curve over the {over} {share}, and inside the band: {}", list(&best.inside));
    let count = telling().count();
    if count > 1 {
        let _ =
            write!(text, "; inside the bands of all {count} channels that show something: {}", list(&entry.inside_all));
    }
    text + if entry.unlisted { ". No effect of the list has this shape." } else { "." }
}
