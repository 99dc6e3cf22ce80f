//! K and T with their context: an amplitude, small motions, a record.

use document::names;
use document::single_records::{SingleRecord, SingleRecords, ZigZagAmplitude};
use document::trace::{Indices, TraceDocument};
use report::number::{fixed, significant};
use report::{Table, TableHead};

use super::method_table::estimate_and_interval;

/// Sentence on the amplitude at which K and T are valid; empty if the records are not zig-zags.
pub fn amplitude_sentence(amplitude: Option<&ZigZagAmplitude>) -> String {
    amplitude.map_or_else(String::new, |ZigZagAmplitude { rudder_deg, heading_deg }| {
        let [rudder, heading] = [rudder_deg, heading_deg].map(|angle| fixed(*angle, 0));
        format!("They are valid at this amplitude: rudder {rudder}°, heading to {heading}°.")
    })
}

/// Sentence on the range of K and T over the records, and whether they agree.
pub fn range_sentence(all: &SingleRecords) -> String {
    let range = |value_of: fn(&SingleRecord) -> f64, unit: &str| {
        let values = || all.records.iter().map(value_of);
        let ends = [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)];
        let [from, to] = ends.map(|end| significant(end, 2));
        format!("from {from} to {to} {unit}")
    };
    let [k, t] = [range(|record| record.k_per_s.value, "1/s"), range(|record| record.t_s.value, "s")];
    let agree = match all.is_consistent {
        Some(true) => "; they agree",
        Some(false) => "; they disagree: K and T depend on the record and its amplitude",
        None => "",
    };
    format!("Fitted one by one ({}), the records give K {k} and T {t}{agree}.", all.method)
}

/// Table of K and T of every record alone.
pub fn single_record_table(all: &SingleRecords) -> Table {
    let head = TableHead::default().texts(["record"]).numbers(["rudder", "heading"]).unit("deg");
    let head = head.numbers(["K"]).unit("1/s").interval95().numbers(["T"]).unit("s").interval95();
    let mut table = Table::new(head);
    for SingleRecord { record, amplitude, k_per_s, t_s } in &all.records {
        let angles = [amplitude.rudder_deg, amplitude.heading_deg].map(|angle| fixed(angle, 0));
        let cells = [names::record_name(record)].into_iter().chain(angles);
        table.push(cells.chain([k_per_s, t_s].into_iter().flat_map(estimate_and_interval)));
    }
    table
}

/// Table of K and T of the first-order response and of the model of a trace, with the use of each pair.
pub fn trace_table(document: &TraceDocument) -> Table {
    let head = TableHead::default().texts(["K and T of"]).numbers(["K"]).unit("1/s").interval95();
    let mut table = Table::new(head.numbers(["T"]).unit("s").interval95().texts(["for"]));
    let amplitude = document.amplitude.as_ref().map_or_else(
        || String::from("motions as large as these"),
        |amplitude| format!("this amplitude (rudder {}°)", fixed(amplitude.rudder_deg, 0)),
    );
    let trace = &document.trace;
    let is_same = trace.model.indices == trace.base;
    let most_probable = document.ship.members.first().and_then(|member| member.model().ok());
    let needs_channel =
        most_probable.is_some_and(|model| model.effects().iter().any(|effect| effect.needs().is_some()));
    // With sway or speed as an input K and T are not those of a ship that responds to her rudder alone.
    let (of_model, use_of_model) = match needs_channel {
        true => ("the model with measured speed or sway", "use in this model only"),
        false => ("small motions", "the model: its effects come on top"),
    };
    let rows: [(String, &Indices, &str); 2] = [
        (amplitude, &trace.base, "an autopilot at this rudder, comparing trials"),
        (String::from(of_model), &trace.model.indices, use_of_model),
    ];
    for (name, indices, purpose) in rows.into_iter().take(if is_same { 1 } else { 2 }) {
        let numbers = [&indices.K_per_s, &indices.T_s].into_iter().flat_map(estimate_and_interval);
        table.push([name].into_iter().chain(numbers).chain([purpose.to_owned()]));
    }
    table
}
