//! Yaw moment that the base lacks on every fitted record: its figure, and the sentence on it.

use std::fmt::Write as _;

use document::names;
use document::trace::{ChannelCurveEntry, MissingMomentEntry};
use report::figures::{AxisSpec, Layer, LayerKind, PanelGroup, PanelRow, Panels, Pen};
use report::number::significant;
use report::palette::{HEADING, RECORD, RUDDER, SHORT_DASH};
use report::{PlotCurve, symbol};
use trace::missing_moment::MomentChannel;

use crate::documents::missing_moment::{ChannelCurve, MissingMomentCurves};

/// Maximum number of panels over channels in a figure.
const MAX_PANELS: usize = 4;

/// Maximum plotted moment over time, and over a channel, in medians of its size: otherwise a jump would set the axis.
const REACHES: [f64; 2] = [8.0, 2.5];

/// Title of the axis of a channel: name, symbol and unit.
fn title_of(over: MomentChannel) -> String {
    match over {
        MomentChannel::YawRate => format!("yaw rate {} [°/s]", symbol("r")),
        MomentChannel::Rudder => format!("rudder {} [°]", symbol("δ")),
        MomentChannel::Heading => format!("heading {} [°]", symbol("ψ")),
        MomentChannel::Speed => format!("speed {} [m/s]", symbol("U")),
        MomentChannel::Sway => format!("sway velocity {} [m/s]", symbol("v")),
        MomentChannel::WindFrom => String::from("relative wind from [° off the bow]"),
    }
}

fn percent(share: Option<f64>) -> String {
    match share {
        None => String::from("has nothing to explain"),
        Some(share) if share > 0.99 => String::from("explains more than 99 % of the variance"),
        Some(share) if share < 0.01 => String::from("explains less than 1 % of the variance"),
        Some(share) => format!("explains {:.0} % of the variance", 100.0 * share),
    }
}

/// Layers of the moment with its band, and of its explanation if there is one.
fn banded(explanation: Option<&String>, [middle, lower, upper]: [PlotCurve; 3], explained: PlotCurve) -> Vec<Layer> {
    let dashed = Pen { dash: SHORT_DASH, ..Pen::new(RUDDER) };
    let mut layers = vec![
        Layer::band("95 % band", [lower, upper], HEADING, 0.2).widening_at_most(0.3),
        Layer::line("missing moment (over a channel: its curve)", middle, Pen::new(HEADING)),
    ];
    let together = |names: &String| if names.contains(", ") { format!("{names} together") } else { names.clone() };
    layers.extend(explanation.map(|names| Layer::line(together(names), explained, dashed)));
    layers
}

/// Panels of the missing moment of a record: over time, and over the channels on which it depends.
pub fn missing_moment_figure(entry: &MissingMomentEntry, curves: &MissingMomentCurves) -> Panels {
    let cause = entry.explanation.as_ref();
    let over = |x: AxisSpec, height: f64, reach: f64, layers: Vec<Layer>| {
        let moment = AxisSpec::decimal("moment [° rudder]").limited_around(reach, Some(0.0));
        PanelGroup::over(x, vec![(PanelRow::zeroed(moment, height), layers)])
    };
    let over_time = |values: &Vec<f64>| PlotCurve::new(curves.time.clone(), values.clone());
    let [lower, upper] = &curves.band95;
    let moment = banded(cause, [&curves.moment, lower, upper].map(over_time), over_time(&curves.explained_moment));
    let mut groups = vec![over(AxisSpec::time(), 0.24, REACHES[0], moment)];
    let channels = entry.channel_curves.iter().zip(&curves.by_channel);
    let (shown, undrawn): (Vec<_>, Vec<_>) = channels.partition(|(channel, _)| channel.is_significant);
    groups.extend(shown.into_iter().take(MAX_PANELS).map(
        |(channel_entry, channel): (&ChannelCurveEntry, &ChannelCurve)| {
            let ChannelCurve { moment, half_width95, .. } = channel;
            let curve = |y: Vec<f64>| PlotCurve::new(channel.abscissae.clone(), y);
            let edge = |side: f64| curve(moment.iter().zip(half_width95).map(|(m, half)| m + side * half).collect());
            let rows = PlotCurve::new(channel.channel_values.clone(), curves.moment.clone());
            let mut layers = vec![Layer::new("its smoothed rows", rows, LayerKind::Dots(RECORD)).widening_at_most(0.1)];
            layers.extend(banded(
                cause,
                [curve(moment.clone()), edge(-1.0), edge(1.0)],
                curve(channel.explained_moment.clone()),
            ));
            let mut group = over(
                AxisSpec::decimal(channel.channel.map_or_else(|| channel_entry.channel.clone(), title_of)),
                0.2,
                REACHES[1],
                layers,
            );
            (group.panels[0].head, group.is_half) = (Some(percent(channel_entry.variance_share)), true);
            group
        },
    ));
    let undrawn: Vec<&str> = undrawn.iter().map(|(channel, _)| channel.channel.as_str()).collect();
    let undrawn = match undrawn.is_empty() {
        true => String::new(),
        false => format!(" Not drawn, because the band includes zero: {}.", undrawn.join(", ")),
    };
    let note = Some(format!("Over a channel, moments beyond {} times the usual size are cut.{undrawn}", REACHES[1]));
    Panels { groups, note, ..Panels::default() }
}

/// Finding: size of the moment of one record and the channel with the highest share of its variance.
pub fn missing_moment_finding(entry: &MissingMomentEntry) -> String {
    let (name, size) = (names::record_name(&entry.record), significant(entry.rms_rudder_deg, 2));
    let begin = format!("{name}: the base lacks a yaw moment of {size}° of rudder (rms)");
    let telling = entry.channel_curves.iter().find(|panel| panel.is_significant && panel.variance_share.is_some());
    match telling {
        None => format!("{begin}; it depends on no recorded channel"),
        Some(best) => format!("{begin}; its curve over the {} {}", best.channel, percent(best.variance_share)),
    }
}

/// Caption: effects that have the shape of the moment of one record.
pub fn missing_moment_sentence(entry: &MissingMomentEntry) -> String {
    let telling = || entry.channel_curves.iter().filter(|panel| panel.is_significant && panel.variance_share.is_some());
    let Some(best) = telling().next() else { return String::from("The moment depends on time alone.") };
    let list = |ids: &[String]| {
        if ids.is_empty() { "no effect on the list".to_owned() } else { names::effect_names(ids, ", ") }
    };
    let mut text = format!("Effects inside the band over the {}: {}", best.channel, list(&best.effects_inside_band));
    let count = telling().count();
    if count > 1 {
        let _ = write!(
            text,
            "; inside the bands of all {count} channels with a dependence: {}",
            list(&entry.effects_inside_bands)
        );
    }
    text + if entry.is_unlisted { ". No effect of the list has this shape." } else { "." }
}
