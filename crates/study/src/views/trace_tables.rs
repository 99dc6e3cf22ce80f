//! Tables of a trace, from its document alone.

use ::trace::replay_errors::HORIZONS;
use document::stored_hull::StoredCoefficient;
use document::trace::{
    ErrorsEntry, HeadingWander, ParameterEntry, RecordErrors, RecordNoiseEntry, TermEntry, TraceDocument,
};
use document::{Moment, names};
use report::number::{self, MISSING, fixed, optional, significant, uncertain};
use report::{Table, TableHead};
use ship::angle::to_deg;
use ship::vessel::prime::meaning;
use trial::Quantity;

/// A quantity in degrees where its unit holds radians, and that unit. Frequencies stay in radians.
fn in_degrees(symbol: &str, quantity: Quantity, unit: &str) -> (Quantity, String) {
    let degree = to_deg(1.0);
    let factor = match unit {
        _ if symbol == "ω₀" => return (quantity, unit.to_owned()),
        unit if unit.contains("/rad²") => degree.powi(-2),
        unit if unit.contains("/rad") => degree.recip(),
        unit if unit.starts_with("rad") => degree,
        _ => 1.0,
    };
    (quantity.scaled(factor), unit.replace("rad", "deg"))
}

/// A parameter as text: its symbol, value and unit.
pub fn value(parameter: &ParameterEntry) -> String {
    let (quantity, unit) = in_degrees(&parameter.symbol, parameter.quantity, &parameter.unit);
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    format!("{} = {}{unit}", parameter.symbol, uncertain(quantity.value, quantity.sd))
}

/// A symbol without dimension: "n₃′/T′" of "n₃/T".
fn primed(symbol: &str) -> String {
    let part = |part: &str| if part == "1" { part.to_owned() } else { format!("{part}′") };
    symbol.split('/').map(part).collect::<Vec<String>>().join("/")
}

/// An effect with its form and the one record in which it acts.
pub fn term(id: &str, form: &str, only: Option<&String>) -> String {
    let only = only.map_or_else(String::new, |only| format!(", in {}", names::record(only)));
    names::effect_form(id, form) + &only
}

/// Several of them, joined.
pub fn terms(all: &[TermEntry], between: &str) -> String {
    all.iter().map(|own| term(&own.id, &own.form, own.only.as_ref())).collect::<Vec<_>>().join(between)
}

/// Named effects with their parameters.
pub fn effects(document: &TraceDocument) -> Table {
    let head = TableHead::default().texts(["effect"]).numbers(["probability", "ΔBIC"]);
    let mut table = Table::new(head.texts(["parameters", "not told from"]));
    for effect in &document.trace.effects {
        let asked = if effect.asked { ", asked for" } else { "" };
        let parameters: Vec<String> = effect.parameters.values().map(value).collect();
        table.push([
            format!("{}{asked}", term(&effect.id, &effect.form, effect.only.as_ref())),
            fixed(effect.probability, 3),
            fixed(effect.delta_bic, 1),
            parameters.join(", "),
            if effect.alias_forms.is_empty() { MISSING.into() } else { terms(&effect.alias_forms, ", ") },
        ]);
    }
    table
}

/// Errors before and after on some records.
pub fn errors(records: &[RecordErrors]) -> Table {
    let mut judged = records.iter().flat_map(|one| [&one.errors.before, &one.errors.after]);
    let with_moments = judged.any(|own| own.with_own_bias_deg.or(own.with_own_moment_deg).is_some());
    let moments = ["own bias", "own moment"].into_iter().filter(|_| with_moments);
    let head = TableHead::default().texts(["record", "use", "model"]).numbers(["heading"]).unit("deg");
    let head = head.numbers(moments).unit("deg").numbers(HORIZONS.map(|length| format!("every {length:.0} s")));
    let head = head.unit("deg").numbers(["yaw rate"]).unit("deg/s").numbers(["overshoots"]).unit("deg");
    let head = head.numbers(["after/before"]).numbers(["band covers"]).unit("%").numbers(["band width"]).unit("deg");
    let mut table = Table::new(head);
    let three = |value: Option<f64>| significant(value.unwrap_or(f64::NAN), 3);
    for RecordErrors { name, used, errors } in records {
        let ratio = errors.after.heading_rmse_deg / errors.before.heading_rmse_deg;
        let models = [("before", &errors.before, None), ("after", &errors.after, Some(ratio))];
        for (model, own, ratio) in models {
            let head = if model == "before" { [names::record(name), (*used).to_owned()] } else { Default::default() };
            let mut cells = head.to_vec();
            cells.push(model.to_owned());
            cells.push(three(Some(own.heading_rmse_deg)));
            let moments = [own.with_own_bias_deg, own.with_own_moment_deg].map(three);
            cells.extend(with_moments.then_some(moments).into_iter().flatten());
            cells.extend(HORIZONS.map(|length| three(horizon(own, length))));
            cells.extend([own.yaw_rate_rmse_deg_s, own.overshoot_error_deg].map(three));
            cells.push(optional(ratio, 2));
            cells.push(optional(own.band_coverage_95.map(|share| 100.0 * share), 1));
            cells.push(three(own.band_width_95_deg));
            table.push(cells);
        }
    }
    table
}

/// Error of replays that are restarted every so many seconds, deg.
pub fn horizon(errors: &ErrorsEntry, length: f64) -> Option<f64> {
    *errors.horizon_rmse_deg.get(&format!("{length:.0}"))?
}

/// An interval, whatever its size.
fn interval(ends: Option<[f64; 2]>) -> String {
    match ends {
        Some([lo, hi]) if lo.abs().max(hi.abs()) < 1e-3 => format!("[{}, {}]", significant(lo, 3), significant(hi, 3)),
        _ => number::interval(ends),
    }
}

/// Departures from what was expected, in standard deviations, that are listed.
const DEPARTS: f64 = 1.0;

/// Coefficients of the hulls that are not as expected, the farthest first.
pub fn hulls(document: &TraceDocument) -> Table {
    let head = TableHead::default().texts(["hull", "coefficient"]).numbers(["value", "expected"]);
    let mut table = Table::new(head.numbers(["departure"]).unit("sd").texts(["what it can mean"]));
    for hull in &document.ship.hulls {
        let mut far: Vec<&StoredCoefficient> =
            hull.coefficients.iter().filter(|own| own.departure().abs() >= DEPARTS).collect();
        far.sort_by(|one, other| other.departure().abs().total_cmp(&one.departure().abs()));
        for own in far {
            let expected = format!("{} ± {}", significant(own.expected, 2), significant(own.expected_sd, 2));
            let meaning = meaning(&own.key).unwrap_or(MISSING).to_owned();
            let departure = fixed(own.departure(), 1);
            table.push([
                hull.form.clone(),
                own.symbol.clone(),
                significant(own.value, 3),
                expected,
                departure,
                meaning,
            ]);
        }
    }
    table
}

/// K, T, δ_r and every parameter of the most probable structure.
pub fn parameters(document: &TraceDocument) -> Table {
    let model = &document.trace.model;
    let remarks = model.parameters.iter().any(|parameter| parameter.at_bound);
    let is_prime = model.indices.prime.is_some();
    let prime = ["prime", "value", "95 % interval"].into_iter().filter(|_| is_prime);
    let head = TableHead::default().texts(["parameter", "value", "95 % interval", "unit"]).texts(prime);
    let mut table = Table::new(head.texts(["record"]).texts(remarks.then_some("remark")));
    let mut push = |symbol: &str, (own, unit): (Quantity, String), prime: Option<Quantity>, rest: [&str; 2]| {
        let mut cells = vec![symbol.to_owned(), uncertain(own.value, own.sd), interval(own.ci95), unit];
        let prime = prime.map(|prime| [primed(symbol), uncertain(prime.value, prime.sd), interval(prime.ci95)]);
        let prime = prime.unwrap_or_else(|| [MISSING, MISSING, MISSING].map(String::from));
        cells.extend(is_prime.then_some(prime).into_iter().flatten());
        cells.extend(rest.into_iter().take(1 + usize::from(remarks)).map(String::from));
        table.push(cells);
    };
    let (indices, prime) = (&model.indices, model.indices.prime.as_ref());
    push("K", (indices.K_per_s, "1/s".into()), prime.map(|prime| prime.K), [MISSING, ""]);
    push("T", (indices.T_s, "s".into()), prime.map(|prime| prime.T), [MISSING, ""]);
    push("δ_r", (indices.delta_r_deg, "deg".into()), None, [MISSING, ""]);
    // The average above stands for the rudder bias of all records.
    for own in model.parameters.iter().filter(|own| own.symbol != "δ_r" || own.only.is_some()) {
        let shown = in_degrees(&own.symbol, own.quantity, &own.unit);
        let rest = [own.only.as_deref().unwrap_or(MISSING), if own.at_bound { "at its bound" } else { "" }];
        push(&own.symbol, shown, own.prime.as_ref().map(|prime| prime.quantity), rest);
    }
    table
}

/// What became of every candidate.
pub fn candidates(document: &TraceDocument) -> Table {
    let head = TableHead::default().texts(["candidate", "form", "outcome"]).numbers(["probability", "ΔBIC"]);
    let mut table = Table::new(head.texts(["p"]).numbers(["visibility"]));
    let two = |value: Option<f64>| significant(value.unwrap_or(f64::NAN), 2);
    for one in &document.trace.candidates {
        if one.forms.is_empty() {
            let why = one.reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
            let outcome = format!("{}{why}", one.outcome.as_str());
            let rest = [fixed(one.probability, 3), optional(one.delta_bic, 1), two(one.p_value), MISSING.into()];
            table.push([names::effect(&one.id), MISSING.into(), outcome].into_iter().chain(rest));
        }
        for (number, own) in one.forms.iter().enumerate() {
            let only = own.only.as_ref().map_or_else(String::new, |only| format!(", in {}", names::record(only)));
            table.push([
                if number == 0 { names::effect(&one.id) } else { String::new() },
                format!("{}{only}", own.form),
                own.outcome.as_str().to_owned(),
                fixed(own.probability, 3),
                optional(own.delta_bic, 1),
                two(own.p_value),
                two(own.visibility),
            ]);
        }
    }
    table
}

/// Structures of less probability are not told.
const NEGLIGIBLE: f64 = 1e-3;

/// The structures with their probabilities.
pub fn structures(document: &TraceDocument) -> Table {
    let mut table =
        Table::new(TableHead::default().texts(["structure"]).numbers(["probability"]).texts(["in the average"]));
    for one in document.trace.structures.iter().filter(|one| one.member || one.weight > NEGLIGIBLE) {
        let name = if one.effects.is_empty() { "the base alone".into() } else { terms(&one.effects, " + ") };
        table.push([name, fixed(one.weight, 3), if one.member { "yes" } else { "no" }.into()]);
    }
    table
}

/// The noise of every fitted record.
pub fn noise(document: &TraceDocument) -> Table {
    let head = TableHead::default().texts(["record"]).numbers(["heading, white"]).unit("deg").texts(["beside it"]);
    let mut table = Table::new(head.texts(["headings left out at"]).unit("s"));
    for own in &document.trace.noise {
        let name = document.records.iter().find(|record| record.file == own.file).map_or(&own.file, |one| &one.name);
        let beside = coloured(own);
        let times: Vec<String> = own.outliers_s.iter().map(|time| fixed(*time, 1)).collect();
        table.push([
            names::record(name),
            significant(own.heading_sd_deg, 2),
            if beside.is_empty() { MISSING.into() } else { beside.join(", ") },
            if times.is_empty() { MISSING.into() } else { times.join(", ") },
        ]);
    }
    table
}

/// What there is beside the white noise of a record, in words.
pub fn coloured(own: &RecordNoiseEntry) -> Vec<String> {
    let two = |value: Option<f64>| significant(value.unwrap_or(f64::NAN), 2);
    let size = two(own.moment_sd_rudder_deg);
    let moment = match own.moment {
        Moment::White => Some(format!("a white yaw moment of {size}° of rudder averaged over 1 s")),
        Moment::OrnsteinUhlenbeck => {
            let time = two(own.moment_correlation_s);
            Some(format!("gusts of {size}° of rudder that last about {time} s"))
        }
        Moment::Walk => Some(format!("a yaw moment that walks by {size}°/√s of rudder")),
        Moment::None => None,
    };
    let heading = own.heading_wander_sd_deg.map(|sd| {
        let whose = own.heading_wander.unwrap_or(HeadingWander::Compass);
        let time = two(own.heading_correlation_s);
        format!("an error of the {whose} of {}° that lasts about {time} s", significant(sd, 2))
    });
    let waves = own
        .waves_sd_deg
        .map(|sd| format!("waves of {}° at {} rad/s", significant(sd, 2), two(own.waves_frequency_rad_s)));
    [moment, heading, waves].into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_has_its_prime() {
        assert_eq!(["1/T", "K/T", "n₃/T", "T₂"].map(primed), ["1/T′", "K′/T′", "n₃′/T′", "T₂′"]);
    }
}
