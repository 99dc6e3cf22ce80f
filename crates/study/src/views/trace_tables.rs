//! Tables of a trace, from its document alone.

use ::trace::replay_errors::HORIZONS_S;
use document::identified_hull::IdentifiedCoefficient;
use document::trace::{
    AnalysisDocument, HeadingErrorKind, ModelReplayErrors, ParameterEntry, RecordErrors, RecordNoiseEntry, TermEntry,
    TraceDocument,
};
use document::{MomentKind, names};
use report::number::{self, MISSING, fixed, optional, significant, with_uncertainty_and_power};
use report::{Table, TableHead};
use ship::angle::to_deg;
use ship::vessel::prime::departure_cause;
use trial::Quantity;

/// Quantity in degrees if its unit contains radians, and that unit. Frequencies stay in radians.
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

/// Parameter as text: its symbol, value and unit.
pub fn parameter_text(parameter: &ParameterEntry) -> String {
    let (quantity, unit) = in_degrees(&parameter.symbol, parameter.quantity, &parameter.unit);
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    format!("{} = {}{unit}", parameter.symbol, with_uncertainty_and_power(quantity.value, quantity.sd))
}

/// Dimensionless form of a symbol: "n₃′/T′" for "n₃/T".
fn primed(symbol: &str) -> String {
    let part = |part: &str| if part == "1" { part.to_owned() } else { format!("{part}′") };
    symbol.split('/').map(part).collect::<Vec<String>>().join("/")
}

/// Text of an effect: its name, its form, and the record if it acts in only one.
pub fn effect_text(id: &str, form: &str, only: Option<&String>) -> String {
    let only = only.map_or_else(String::new, |only| format!(", in {}", names::record_name(only)));
    names::effect_form_name(id, form) + &only
}

/// Several effects, joined by `between`.
pub fn joined_effect_texts(all: &[TermEntry], between: &str) -> String {
    all.iter().map(|entry| effect_text(&entry.id, &entry.form, entry.only.as_ref())).collect::<Vec<_>>().join(between)
}

/// Remark behind the name of an effect that the model has without naming it; empty for a named one.
pub fn unnamed_remark(document: &TraceDocument, id: &str) -> String {
    let AnalysisDocument { effects, candidates, .. } = &document.trace;
    let is_named = effects.iter().any(|effect| effect.id == id || effect.aliases.iter().any(|alias| alias == id));
    let candidate = candidates.iter().find(|candidate| candidate.id == id).filter(|_| !is_named);
    candidate.map_or_else(String::new, |candidate| format!(", not named, p = {}", fixed(candidate.probability, 2)))
}

/// Table of named effects with their parameters.
pub fn effect_table(document: &TraceDocument) -> Table {
    let head = TableHead::default().texts(["effect"]).numbers(["probability", "ΔBIC"]);
    let mut table = Table::new(head.texts(["parameters", "indistinguishable from"]));
    for effect in &document.trace.effects {
        let asked = if effect.required { ", asked for" } else { "" };
        let parameters: Vec<String> = effect.parameters.values().map(parameter_text).collect();
        table.push([
            format!("{}{asked}", effect_text(&effect.id, &effect.form, effect.only.as_ref())),
            fixed(effect.probability, 3),
            fixed(effect.delta_bic, 1),
            parameters.join(", "),
            if effect.alias_forms.is_empty() { MISSING.into() } else { joined_effect_texts(&effect.alias_forms, ", ") },
        ]);
    }
    table
}

/// Table of errors before and after on some records.
pub fn replay_error_table(records: &[RecordErrors]) -> Table {
    let mut judged = records.iter().flat_map(|record| [&record.errors.before, &record.errors.after]);
    let with_moments =
        judged.any(|error| error.heading_rmse_own_bias_deg.or(error.heading_rmse_own_moment_deg).is_some());
    let moments = ["own bias", "own moment"].into_iter().filter(|_| with_moments);
    let head = TableHead::default().texts(["record", "use", "model"]).numbers(["heading"]).unit("deg");
    let head = head.numbers(moments).unit("deg").numbers(HORIZONS_S.map(|window_s| format!("every {window_s:.0} s")));
    let head = head.unit("deg").numbers(["yaw rate"]).unit("deg/s").numbers(["overshoots"]).unit("deg");
    let head = head.numbers(["after/before"]).numbers(["band covers"]).unit("%").numbers(["band width"]).unit("deg");
    let mut table = Table::new(head);
    let three = |value: Option<f64>| significant(value.unwrap_or(f64::NAN), 3);
    for RecordErrors { name, used, errors } in records {
        let ratio = errors.after.heading_rmse_deg / errors.before.heading_rmse_deg;
        let models = [("before", &errors.before, None), ("after", &errors.after, Some(ratio))];
        for (model, error, ratio) in models {
            let head =
                if model == "before" { [names::record_name(name), (*used).to_owned()] } else { Default::default() };
            let mut cells = head.to_vec();
            cells.push(model.to_owned());
            cells.push(three(Some(error.heading_rmse_deg)));
            let moments = [error.heading_rmse_own_bias_deg, error.heading_rmse_own_moment_deg].map(three);
            cells.extend(with_moments.then_some(moments).into_iter().flatten());
            cells.extend(HORIZONS_S.map(|window_s| three(restarted_heading_error(error, window_s))));
            cells.extend([error.yaw_rate_rmse_deg_s, error.overshoot_error_deg].map(three));
            cells.push(optional(ratio, 2));
            cells.push(optional(error.band_coverage_95.map(|share| 100.0 * share), 1));
            cells.push(three(error.band_width_95_deg));
            table.push(cells);
        }
    }
    table
}

/// Heading error of replays restarted after every `window_s` seconds, deg; `None` if the record is too short.
pub fn restarted_heading_error(errors: &ModelReplayErrors, window_s: f64) -> Option<f64> {
    *errors.horizon_rmse_deg.get(&format!("{window_s:.0}"))?
}

/// Interval as text, with three significant digits if both ends are below 10⁻³ in absolute value.
fn interval(ends: Option<[f64; 2]>) -> String {
    match ends {
        Some([lo, hi]) if lo.abs().max(hi.abs()) < 1e-3 => format!("[{}, {}]", significant(lo, 3), significant(hi, 3)),
        _ => number::interval(ends),
    }
}

/// Minimum departure of a listed hull coefficient, in standard deviations.
const MIN_DEPARTURE: f64 = 1.0;

/// Hull coefficients at least one standard deviation off their expected values, for each hull the farthest first.
pub fn departed_coefficient_table(document: &TraceDocument) -> Table {
    let head = TableHead::default().texts(["hull", "coefficient"]).numbers(["value", "expected"]);
    let mut table = Table::new(head.numbers(["departure"]).unit("sd").texts(["what it can mean"]));
    for hull in &document.ship.hulls {
        let mut far: Vec<&IdentifiedCoefficient> =
            hull.coefficients.iter().filter(|entry| entry.departure_from_prior().abs() >= MIN_DEPARTURE).collect();
        far.sort_by(|a, b| b.departure_from_prior().abs().total_cmp(&a.departure_from_prior().abs()));
        for entry in far {
            let expected = format!("{} ± {}", significant(entry.expected, 2), significant(entry.expected_sd, 2));
            let meaning = departure_cause(&entry.key).unwrap_or(MISSING).to_owned();
            let departure = fixed(entry.departure_from_prior(), 1);
            table.push([
                hull.form.clone(),
                entry.symbol.clone(),
                significant(entry.value, 3),
                expected,
                departure,
                meaning,
            ]);
        }
    }
    table
}

/// Table of K, T, δ_r and every parameter of the most probable structure.
pub fn parameter_table(document: &TraceDocument) -> Table {
    let model = &document.trace.model;
    let remarks = model.parameters.iter().any(|parameter| parameter.at_bound);
    let is_prime = model.indices.prime.is_some();
    let prime = ["prime", "value", "95 % interval"].into_iter().filter(|_| is_prime);
    let head = TableHead::default().texts(["parameter", "value", "95 % interval", "unit"]).texts(prime);
    let mut table = Table::new(head.texts(["record"]).texts(remarks.then_some("remark")));
    let mut push = |symbol: &str, (number, unit): (Quantity, String), prime: Option<Quantity>, tail: [&str; 2]| {
        let mut cells =
            vec![symbol.to_owned(), with_uncertainty_and_power(number.value, number.sd), interval(number.ci95), unit];
        let prime = prime
            .map(|prime| [primed(symbol), with_uncertainty_and_power(prime.value, prime.sd), interval(prime.ci95)]);
        let prime = prime.unwrap_or_else(|| [MISSING, MISSING, MISSING].map(String::from));
        cells.extend(is_prime.then_some(prime).into_iter().flatten());
        cells.extend(tail.into_iter().take(1 + usize::from(remarks)).map(String::from));
        table.push(cells);
    };
    let (indices, prime) = (&model.indices, model.indices.prime.as_ref());
    push("K", (indices.K_per_s, "1/s".into()), prime.map(|prime| prime.K), [MISSING, ""]);
    push("T", (indices.T_s, "s".into()), prime.map(|prime| prime.T), [MISSING, ""]);
    push("δ_r", (indices.delta_r_deg, "deg".into()), None, [MISSING, ""]);
    // The average above is the rudder bias of all records.
    for entry in model.parameters.iter().filter(|entry| entry.symbol != "δ_r" || entry.only.is_some()) {
        let shown = in_degrees(&entry.symbol, entry.quantity, &entry.unit);
        let tail = [entry.only.as_deref().unwrap_or(MISSING), if entry.at_bound { "at its bound" } else { "" }];
        push(&entry.symbol, shown, entry.prime.as_ref().map(|prime| prime.quantity), tail);
    }
    table
}

/// Table with outcome, probability and ΔBIC of every candidate effect.
pub fn candidate_table(document: &TraceDocument) -> Table {
    let head = TableHead::default().texts(["candidate", "form", "outcome"]).numbers(["probability", "ΔBIC"]);
    let mut table = Table::new(head.texts(["p"]).numbers(["visibility"]));
    let two = |value: Option<f64>| significant(value.unwrap_or(f64::NAN), 2);
    for entry in &document.trace.candidates {
        if entry.forms.is_empty() {
            let why = entry.reason.as_ref().map_or_else(String::new, |reason| format!(": {reason}"));
            let outcome = format!("{}{why}", entry.outcome.as_str());
            let numbers =
                [fixed(entry.probability, 3), optional(entry.delta_bic, 1), two(entry.p_value), MISSING.into()];
            table.push([names::effect_name(&entry.id), MISSING.into(), outcome].into_iter().chain(numbers));
        }
        for (number, form) in entry.forms.iter().enumerate() {
            let only = form.only.as_ref().map_or_else(String::new, |only| format!(", in {}", names::record_name(only)));
            table.push([
                if number == 0 { names::effect_name(&entry.id) } else { String::new() },
                format!("{}{only}", form.form),
                form.outcome.as_str().to_owned(),
                fixed(form.probability, 3),
                optional(form.delta_bic, 1),
                two(form.p_value),
                two(form.visibility),
            ]);
        }
    }
    table
}

/// Minimum probability of a listed structure.
const MIN_PROBABILITY: f64 = 1e-3;

/// Table of the structures with their probabilities.
pub fn structure_table(document: &TraceDocument) -> Table {
    let mut table =
        Table::new(TableHead::default().texts(["structure"]).numbers(["probability"]).texts(["in the average"]));
    for entry in document.trace.structures.iter().filter(|entry| entry.member || entry.weight > MIN_PROBABILITY) {
        let name =
            if entry.effects.is_empty() { "the base alone".into() } else { joined_effect_texts(&entry.effects, " + ") };
        table.push([name, fixed(entry.weight, 3), if entry.member { "yes" } else { "no" }.into()]);
    }
    table
}

/// Table of the noise of every fitted record.
pub fn noise_table(document: &TraceDocument) -> Table {
    let head = TableHead::default().texts(["record"]).numbers(["heading, white"]).unit("deg").texts(["beside it"]);
    let mut table = Table::new(head.texts(["headings left out at"]).unit("s"));
    for noise in &document.trace.noise {
        let name =
            document.records.iter().find(|entry| entry.file == noise.file).map_or(&noise.file, |entry| &entry.name);
        let beside = coloured_noise_phrases(noise);
        let times: Vec<String> = noise.outliers_s.iter().map(|time| fixed(*time, 1)).collect();
        table.push([
            names::record_name(name),
            significant(noise.heading_sd_deg, 2),
            if beside.is_empty() { MISSING.into() } else { beside.join(", ") },
            if times.is_empty() { MISSING.into() } else { times.join(", ") },
        ]);
    }
    table
}

/// Correlated parts of the noise of a record, a phrase each: yaw moment, heading error, waves.
pub fn coloured_noise_phrases(noise: &RecordNoiseEntry) -> Vec<String> {
    let two = |value: Option<f64>| significant(value.unwrap_or(f64::NAN), 2);
    let size = two(noise.moment_sd_rudder_deg);
    let moment = match noise.moment {
        MomentKind::White => Some(format!("a random yaw moment of {size}° of rudder (mean over 1 s)")),
        MomentKind::OrnsteinUhlenbeck => {
            let time = two(noise.moment_correlation_s);
            Some(format!("gusts of {size}° of rudder that last about {time} s"))
        }
        MomentKind::Walk => {
            Some(format!("a randomly drifting yaw moment ({size}° of rudder in 1 s, twice that in 4 s)"))
        }
        MomentKind::None => None,
    };
    let heading = noise.heading_wander_sd_deg.map(|sd| {
        let whose = noise.heading_wander.unwrap_or(HeadingErrorKind::Compass);
        let time = two(noise.heading_correlation_s);
        format!("an error of the {whose} of {}° that lasts about {time} s", significant(sd, 2))
    });
    let waves = noise
        .waves_sd_deg
        .map(|sd| format!("waves of {}° at {} rad/s", significant(sd, 2), two(noise.waves_frequency_rad_s)));
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
