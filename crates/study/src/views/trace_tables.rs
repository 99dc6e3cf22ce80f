//! Tables of one analysis: errors, overshoots, parameters, candidates and planned trials.

use std::fmt::Write as _;

use ::trace::analysis::{Fitted, Prospect};
use ::trace::replay_errors::{HORIZONS, replayed_zigzag};
use ::trace::structure::TermName;
use report::number::{self, MISSING, optional, significant, uncertain};
use report::{Column, Table};
use ship::angle::to_deg;
use ship::effects::Parameter;
use trial::{Quantity, ZigZag};

use super::trace_report::TraceReport;
use super::trace_scales::prime;

/// A parameter in degrees where its unit holds radians, and that unit; none where it is a plain number.
pub fn in_degrees(fitted: &Fitted) -> (Quantity, String) {
    let degree = to_deg(1.0);
    let Parameter { symbol, unit, .. } = *fitted.parameter;
    let factor = match unit {
        unit if unit.contains("/rad²") => degree.powi(-2),
        unit if unit.contains("/rad") => degree.recip(),
        unit if unit.starts_with("rad") => degree,
        _ => 1.0,
    };
    // Frequencies stay in radians.
    let (factor, unit) = match symbol {
        "ω₀" => (1.0, unit.to_owned()),
        _ => (factor, unit.replace("rad", "deg")),
    };
    (fitted.quantity.scaled(factor), unit)
}

/// Errors before and after on every record.
pub fn errors(report: &TraceReport) -> Table {
    let mut columns = vec![Column::left("record"), Column::left("use"), Column::left("model")];
    columns.push(Column::decimal("heading").unit("deg"));
    columns.extend(HORIZONS.map(|length| Column::decimal(format!("every {length:.0} s")).unit("deg")));
    columns.push(Column::decimal("yaw rate").unit("deg/s"));
    columns.push(Column::decimal("overshoots").unit("deg"));
    columns.push(Column::decimal("band covers").unit("%"));
    let mut table = Table::new(columns);
    let analysis = &report.analysis;
    let fitted = analysis.identification.iter().map(|judged| (judged, "fitted"));
    let uses = fitted.chain(analysis.validation.iter().map(|judged| (judged, "held out")));
    let left_out = analysis.left_out.iter().zip(&report.names);
    let left_out = left_out.filter_map(|(judged, name)| Some(((judged.as_ref()?, "left out"), name)));
    for ((judged, used), name) in uses.zip(&report.names).chain(left_out) {
        let own = judged.own_moment.as_ref().map(|own| ("after, own moment", own));
        for (model, on) in [("before", &judged.before), ("after", &judged.after)].into_iter().chain(own) {
            let errors = &on.errors;
            let mut cells =
                if model == "before" { vec![name.clone(), used.to_owned()] } else { vec![String::new(); 2] };
            cells.push(model.to_owned());
            let numbers =
                [Some(errors.heading)].into_iter().chain(errors.horizon).chain([errors.yaw_rate, errors.overshoot]);
            cells.extend(
                numbers.map(|value| value.map_or_else(|| MISSING.into(), |value| significant(to_deg(value), 3))),
            );
            cells.push(optional(on.coverage().map(|share| 100.0 * share), 1));
            table.push(cells);
        }
    }
    table
}

/// Overshoots and period of the records and of both replays.
pub fn overshoots(report: &TraceReport) -> Option<Table> {
    let mut table = Table::new([
        Column::left("record"),
        Column::left("heading"),
        Column::left("overshoots [deg]"),
        Column::decimal("period").unit("s"),
    ]);
    let analysis = &report.analysis;
    let trials = report.trials.iter().chain(&report.others);
    let judged = analysis.identification.iter().chain(&analysis.validation);
    for ((trial, judged), name) in trials.zip(judged).zip(&report.names) {
        let Ok(measured) = ZigZag::of(trial) else { continue };
        table.push(zigzag_cells(name, "measured", &measured));
        for (label, on) in [("before", &judged.before), ("after", &judged.after)] {
            if let Some(zigzag) = replayed_zigzag(trial, &on.replay) {
                table.push(zigzag_cells("", label, &zigzag));
            }
        }
    }
    (!table.rows.is_empty()).then_some(table)
}

fn zigzag_cells(name: &str, label: &str, zigzag: &ZigZag) -> [String; 4] {
    let angles: Vec<String> =
        zigzag.swings().map(|swing| optional(swing.map(|overshoot| to_deg(overshoot.angle.value)), 2)).collect();
    [name.to_owned(), label.to_owned(), angles.join(", "), optional(zigzag.period.map(|period| period.value), 1)]
}

/// K, T and every parameter with its interval.
pub fn parameters(report: &TraceReport) -> Table {
    let analysis = &report.analysis;
    let remarks = analysis.parameters.iter().any(|fitted| fitted.at_bound);
    let mut columns = ["parameter", "value", "95 % interval", "unit"].map(Column::left).to_vec();
    columns.extend(report.ship.iter().flat_map(|_| ["prime", "95 % interval", "unit"].map(Column::left)));
    columns.push(Column::left("record"));
    columns.extend(remarks.then(|| Column::left("remark")));
    let mut table = Table::new(columns);
    let three = |Quantity { value, sd, ci95 }: Quantity, unit: String| [uncertain(value, sd), interval(ci95), unit];
    let none = || [MISSING.to_owned(), MISSING.to_owned(), String::new()];
    let mut push = |symbol: &str, own: [String; 3], prime: [String; 3], record: Option<String>, at_bound: bool| {
        let remark = remarks.then(|| if at_bound { "at its bound".to_owned() } else { String::new() });
        let record = record.unwrap_or_else(|| MISSING.into());
        let prime = report.ship.map(|_| prime);
        let cells = [symbol.to_owned()].into_iter().chain(own).chain(prime.into_iter().flatten());
        table.push(cells.chain([record]).chain(remark));
    };
    let ([k, t], [k_ends, t_ends, _]) = (analysis.indices, analysis.indices_at_bound());
    for (symbol, quantity, unit, dimension, ends) in [("K", k, "1/s", [-1, 0], k_ends), ("T", t, "s", [1, 0], t_ends)] {
        let own = [uncertain(quantity.value, quantity.sd), number::interval(quantity.ci95), unit.to_owned()];
        let prime = report.ship.map(|ship| three(quantity.scaled(ship.prime(dimension)), "1".into()));
        push(symbol, own, prime.unwrap_or_else(none), None, ends);
    }
    for fitted in &analysis.parameters {
        let (quantity, unit) = in_degrees(fitted);
        let prime = report.ship.and_then(|ship| prime(fitted, ship)).map(|(_, quantity, unit)| three(quantity, unit));
        let prime = prime.unwrap_or_else(none);
        push(fitted.parameter.symbol, three(quantity, unit), prime, fitted.only.clone(), fitted.at_bound);
    }
    table
}

/// An interval, whatever its size.
fn interval(ends: Option<[f64; 2]>) -> String {
    match ends {
        Some([lo, hi]) if lo.abs().max(hi.abs()) < 1e-3 => format!("[{}, {}]", significant(lo, 3), significant(hi, 3)),
        _ => number::interval(ends),
    }
}

/// What became of every candidate.
pub fn candidates(report: &TraceReport) -> Table {
    let mut table = Table::new([
        Column::left("candidate"),
        Column::left("form"),
        Column::left("outcome"),
        Column::decimal("probability"),
        Column::decimal("ΔBIC alone"),
        Column::decimal("ΔBIC in the end"),
        Column::left("p"),
        Column::decimal("visible ΔBIC at most"),
    ]);
    for one in &report.analysis.candidates {
        let signed = |gain: f64| number::fixed(-gain, 1);
        let mut form = one.form.to_owned();
        if let Some(only) = &one.only {
            let _ = write!(form, ", {only}");
        }
        let outcome = match (one.outcome, one.reason) {
            (outcome, Some(reason)) => format!("{}: {reason}", outcome.as_str()),
            (outcome, None) => outcome.as_str().to_owned(),
        };
        table.push([
            one.id.to_owned(),
            form,
            outcome,
            number::fixed(one.probability, 3),
            one.gain_alone.map_or_else(|| MISSING.into(), signed),
            one.evidence.map_or_else(|| MISSING.into(), |evidence| signed(evidence.gain)),
            one.evidence.map_or_else(|| MISSING.into(), |evidence| significant(evidence.p_value, 2)),
            one.visibility.map_or_else(|| MISSING.into(), |visibility| significant(-visibility, 3)),
        ]);
    }
    table
}

/// The structures that the records cannot tell apart.
pub fn structures(report: &TraceReport) -> Table {
    let mut table = Table::new([Column::left("structure"), Column::decimal("probability"), Column::decimal("ΔBIC")]);
    for one in report.analysis.weights.alike() {
        let term = |&(id, form, only): &TermName| {
            let only = only.map_or_else(String::new, |only| format!(", {}", report.names[only.0]));
            format!("{id} ({form}{only})")
        };
        let terms: Vec<String> = one.terms.iter().map(term).collect();
        let name = if terms.is_empty() { "the base alone".into() } else { terms.join(" + ") };
        table.push([name, number::fixed(one.weight, 3), number::fixed(one.bic, 1)]);
    }
    table
}

/// What every planned trial would tell.
pub fn prospects(prospects: &[Prospect]) -> Table {
    let mut table = Table::new([
        Column::left("manoeuvre"),
        Column::right("separated"),
        Column::right("revealed"),
        Column::decimal("information"),
        Column::decimal("standard deviations").unit("%"),
    ]);
    for prospect in prospects {
        let pairs = prospect.separated.len() + prospect.still_alike.len();
        let hidden = prospect.revealed.len() + prospect.still_hidden.len();
        table.push([
            prospect.name.clone(),
            format!("{} of {pairs}", prospect.separated.len()),
            format!("{} of {hidden}", prospect.revealed.len()),
            number::fixed(prospect.information, 1),
            optional(prospect.sharpening.map(|change| 100.0 * (change.exp() - 1.0)), 0),
        ]);
    }
    table
}
