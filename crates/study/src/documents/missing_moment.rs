//! Yaw moment that the base lacks on every fitted record, and its tables.

use std::collections::BTreeMap;

use ::trace::missing_moment::{MissingMoment, MomentChannel, MomentOverChannel};
use campaign::curves::degrees;
use campaign::statistics::distinct;
use document::names;
use document::trace::{ChannelCurveEntry, MissingMomentEntry, TraceVerdict};
use ship::angle::to_deg;

use super::columns::CsvColumns;

/// Missing moment of one record, read from its tables; an absent column is empty.
pub struct MissingMomentCurves {
    /// Times, s.
    pub time: Vec<f64>,
    /// The moment, deg of rudder.
    pub moment: Vec<f64>,
    /// Ends of the 95 % band of the moment, deg of rudder.
    pub band95: [Vec<f64>; 2],
    /// The moment according to the explanation, deg of rudder.
    pub explained_moment: Vec<f64>,
    /// Curves over the channels, in the order of the entry.
    pub by_channel: Vec<ChannelCurve>,
}

/// Missing moment over one channel; the channel is in deg or deg/s if it is an angle or a yaw rate, else in m/s.
pub struct ChannelCurve {
    /// The channel; `None` if no channel has the column name of the entry.
    pub channel: Option<MomentChannel>,
    /// The channel at the times of the moment.
    pub channel_values: Vec<f64>,
    /// Abscissae of the curve.
    pub abscissae: Vec<f64>,
    /// The moment at these abscissae, deg of rudder.
    pub moment: Vec<f64>,
    /// Half width of the 95 % band of the moment, deg of rudder.
    pub half_width95: Vec<f64>,
    /// The moment according to the explanation, deg of rudder.
    pub explained_moment: Vec<f64>,
}

impl MissingMomentCurves {
    /// Curves of an entry, from the tables of [`csv_over_time`] and [`csv_over_channels`].
    pub fn read(entry: &MissingMomentEntry, [time, channels]: &[BTreeMap<String, Vec<f64>>; 2]) -> Self {
        let column_of = |table: &BTreeMap<String, Vec<f64>>, name: &str| table.get(name).cloned().unwrap_or_default();
        let channel = |ChannelCurveEntry { column: name, .. }: &ChannelCurveEntry| ChannelCurve {
            channel: MomentChannel::ALL.into_iter().find(|over| column(*over).0 == name),
            channel_values: column_of(time, name),
            abscissae: column_of(channels, name),
            moment: column_of(channels, &format!("{name}_{MOMENT}")),
            half_width95: column_of(channels, &format!("{name}_{HALF_WIDTH}")),
            explained_moment: column_of(channels, &format!("{name}_{EXPLAINED}")),
        };
        Self {
            time: column_of(time, TIME),
            moment: column_of(time, MOMENT),
            band95: BAND.map(|end| column_of(time, end)),
            explained_moment: column_of(time, EXPLAINED),
            by_channel: entry.channel_curves.iter().map(channel).collect(),
        }
    }
}

const TIME: &str = "t_s";
const MOMENT: &str = "moment_rudder_deg";
const BAND: [&str; 2] = ["lower95_rudder_deg", "upper95_rudder_deg"];
const HALF_WIDTH: &str = "half_width95_rudder_deg";
const EXPLAINED: &str = "explained_rudder_deg";

/// Column name of a channel, and `true` if the channel is an angle or an angular rate.
fn column(over: MomentChannel) -> (&'static str, bool) {
    match over {
        MomentChannel::YawRate => ("yaw_rate_deg_s", true),
        MomentChannel::Rudder => ("rudder_deg", true),
        MomentChannel::Heading => ("heading_deg", true),
        MomentChannel::Speed => ("speed_m_s", false),
        MomentChannel::WindFrom => ("wind_relative_from_deg", true),
        MomentChannel::Sway => ("sway_m_s", false),
    }
}

/// Values of a channel as in the tables: converted to degrees if it is an angle.
fn shown(over: MomentChannel, values: &[f64]) -> Vec<f64> {
    if column(over).1 { degrees(values) } else { values.to_vec() }
}

/// CSV table over time: the moment with its standard deviation and band, the moment of the best explanation, and every
/// recorded channel; angles in degrees.
pub fn csv_over_time(missing: &MissingMoment) -> String {
    let mut columns = CsvColumns::default();
    columns.push(TIME, missing.time.clone());
    columns.push(MOMENT, degrees(&missing.moment));
    columns.push("sd_rudder_deg", degrees(&missing.moment_sd));
    for (k, name) in BAND.into_iter().enumerate() {
        columns.push(name, (0..missing.time.len()).map(|row| to_deg(missing.interval(row)[k])).collect());
    }
    if let Some(explained) = missing.explanation_moments.first() {
        columns.push(EXPLAINED, degrees(explained));
    }
    for (over, values) in &missing.channels {
        columns.push(column(*over).0, shown(*over, values));
    }
    columns.to_csv()
}

/// CSV table of the moment as a function of each channel, with up to four columns per channel: values of the channel
/// (deg, deg/s or m/s), the fitted moment there, the half width of its 95 % band, and the moment of the best
/// explanation if there is one, all three in degrees of rudder.
///
/// A fitted curve has mean zero over the rows; to it and to the explanation the mean of the moment is added.
pub fn csv_over_channels(missing: &MissingMoment) -> String {
    let mean = missing.moment.iter().sum::<f64>() / missing.moment.len() as f64;
    let mut columns = CsvColumns::default();
    for moment in &missing.channel_moments {
        let (name, curve) = (column(moment.channel).0, &moment.curve);
        columns.push(name, shown(moment.channel, &curve.channel_values));
        let about = |values: &[f64]| values.iter().map(|value| to_deg(value + mean)).collect::<Vec<f64>>();
        columns.push(format!("{name}_{MOMENT}"), about(&curve.moment));
        columns.push(format!("{name}_{HALF_WIDTH}"), degrees(&curve.half_width));
        if let Some(other) = curve.explanations.first() {
            columns.push(format!("{name}_{EXPLAINED}"), about(other));
        }
    }
    columns.to_csv()
}

/// Ids of the effects of the explanations with the indices `places`, without repetition.
fn effects(missing: &MissingMoment, places: &[usize]) -> Vec<String> {
    let explanations = places.iter().filter_map(|place| missing.explanations.get(*place));
    distinct(explanations.flat_map(|explanation| &explanation.effects).map(|(id, _)| (*id).to_owned()))
}

/// Entry of a record of this file and name; `stem` begins the names of its tables. `is_named` is `false` if the best
/// explanation is only a candidate.
pub fn missing_moment_entry(
    missing: &MissingMoment,
    [file, name, stem]: [&str; 3],
    verdict: TraceVerdict,
    is_named: bool,
) -> MissingMomentEntry {
    let shows = |moment: &&MomentOverChannel| moment.explained_share.is_some() && !moment.curve.contains_zero();
    let telling = || missing.channel_moments.iter().filter(shows);
    let everywhere = |place: &usize| telling().all(|moment| moment.explanations_inside.contains(place));
    let inside: Vec<usize> = (0..missing.explanations.len()).filter(everywhere).collect();
    let best = names::effect_names(&effects(missing, &[0]), ", ");
    let explanation = if is_named { best.clone() } else { format!("best candidate: {best}") };
    let of_channel = |moment: &MomentOverChannel| ChannelCurveEntry {
        channel: moment.channel.as_str().to_owned(),
        column: column(moment.channel).0.to_owned(),
        variance_share: moment.explained_share,
        is_significant: !moment.curve.contains_zero(),
        effects_inside_band: effects(missing, &moment.explanations_inside),
    };
    let square = missing.moment.iter().map(|m| m * m).sum::<f64>() / missing.moment.len() as f64;
    MissingMomentEntry {
        file: file.to_owned(),
        record: name.to_owned(),
        moment: format!("{stem}.csv"),
        curves: format!("{stem}-curves.csv"),
        rms_rudder_deg: to_deg(square.sqrt()),
        explanation: (!best.is_empty()).then_some(explanation),
        is_unlisted: matches!(verdict, TraceVerdict::Unexplained | TraceVerdict::Located)
            && inside.is_empty()
            && telling().next().is_some(),
        effects_inside_bands: effects(missing, &inside),
        channel_curves: missing.channel_moments.iter().map(of_channel).collect(),
    }
}
