//! What is said about an analysis: the words on the screen, the tables, and `report.md`.

use std::fmt::Write as _;

use ::trace::analysis::{Fitted, Judged, Outcome, Prospect, Traced, Verdict};
use ::trace::noise::Moment;
use ::trace::replay_errors::{HORIZONS, replayed_zigzag};
use report::number::{self, MISSING, optional, significant, with_uncertainty};
use report::{Column, Table};
use ship::angle::to_deg;
use ship::effects::Parameter;
use trial::{Quantity, Trial, ZigZag};

use super::trace_report::TraceReport;

/// How a random moment is called.
pub fn moment(kind: Moment) -> &'static str {
    match kind {
        Moment::White => "white",
        Moment::Walk => "random walk",
    }
}

/// A parameter in degrees where its unit holds radians, and that unit; none where it is a plain number.
fn in_degrees(fitted: &Fitted) -> (Quantity, String) {
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

/// The words of one analysis.
pub fn words(report: &TraceReport) -> String {
    let analysis = report.analysis;
    let rows: usize = report.trials.iter().map(Trial::len).sum();
    let mut text = match report.trials {
        [only] => format!("{}: {rows} rows, {:.1} s", only.name(), only.duration()),
        several => format!("{} records together: {rows} rows", several.len()),
    };
    let verdict = match analysis.verdict {
        Verdict::Clean => "clean: nothing is missing",
        Verdict::Traced => "traced: what is missing has a name, and what is left is noise",
        Verdict::Unexplained if analysis.effects.is_empty() => {
            "unexplained: structure is left, and no effect carries it"
        }
        Verdict::Unexplained => "unexplained: some of what is missing has a name, some has not",
    };
    let _ = write!(text, "\nverdict: {verdict}");
    for effect in &analysis.effects {
        let _ = write!(text, "\n  {}", effect_line(effect));
    }
    for refused in &analysis.refused {
        let _ = write!(text, "\n  {refused}");
    }
    if let Some(signature) = signature(report) {
        let _ = write!(text, "\n  left: {signature}");
    }
    for warning in bounds(&analysis.parameters) {
        let _ = write!(text, "\nwarning: {warning}");
    }
    let _ = write!(text, "\nnext trial: {}", next_trial(report));
    text
}

/// A sentence for every parameter at an end of its range.
fn bounds(parameters: &[Fitted]) -> Vec<String> {
    let ends = parameters.iter().filter(|fitted| fitted.at_bound);
    ends.map(|fitted| {
        let (quantity, unit) = in_degrees(fitted);
        let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
        let only = fitted.only.as_ref().map_or_else(String::new, |name| format!(" of {name}"));
        let follows = match fitted.parameter.key {
            "inverse_T" => ", and K and T follow from it",
            "K_over_T" => ", and K follows from it",
            _ => "",
        };
        let (symbol, number) = (fitted.parameter.symbol, significant(quantity.value, 3));
        format!("{symbol} = {number}{unit}{only} is at its bound: the search ends there{follows}")
    })
    .collect()
}

fn effect_line(effect: &Traced) -> String {
    let parameters: Vec<String> = effect
        .parameters
        .iter()
        .map(|fitted| {
            let (quantity, unit) = in_degrees(fitted);
            let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
            format!("{} = {}{unit}", fitted.parameter.symbol, uncertain(quantity.value, quantity.sd))
        })
        .collect();
    let alike = match effect.aliases.as_slice() {
        [] => String::new(),
        aliases => {
            let names: Vec<String> = aliases.iter().map(|(id, form)| format!("{id} ({form})")).collect();
            format!("; cannot be told from {}", names.join(", "))
        }
    };
    let only = effect.only.as_ref().map_or_else(String::new, |name| format!(" in {name}"));
    format!("{} ({}){only}: {}{alike}", effect.id, effect.form, parameters.join(", "))
}

/// A value with its uncertainty, whatever its size.
fn uncertain(value: f64, sd: Option<f64>) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        let exponent = value.abs().log10().floor() as i32;
        let unit = 10f64.powi(exponent);
        return format!(
            "({})×{}",
            with_uncertainty(value / unit, sd.map(|sd| sd / unit)),
            number::power_of_ten(exponent)
        );
    }
    with_uncertainty(value, sd)
}

/// The unexplained rest in one sentence.
pub fn signature(report: &TraceReport) -> Option<String> {
    let signature = report.analysis.unexplained.as_ref()?;
    let degrees = |x: f64| significant(to_deg(x), 2);
    let [from, to] = signature.span.0;
    let record =
        if report.trials.len() > 1 { format!("in {}, ", report.names[signature.record]) } else { String::new() };
    let strongest = signature.line.map_or_else(String::new, |line| {
        let period = significant(line.frequency.recip(), 3);
        format!("strongest at a period of {period} s ({:.0} %); ", 100.0 * line.share)
    });
    let [low, high] = signature.heading.0;
    let [port, starboard] = signature.side;
    let random = report.analysis.randomness.moment.map_or("", |kind| match kind {
        Moment::White => "; it looks like a white random yaw moment",
        Moment::Walk => "; it looks like a yaw moment that wanders",
    });
    Some(format!(
        "{record}{}° rms; {:.0} % of it between {:.0} and {:.0} s; {strongest}largest at headings \
         from {:.0}° to {:.0}° ({}°); {}° with the rudder to port, {}° to starboard{random}",
        degrees(signature.all),
        100.0 * signature.span.1,
        from,
        to,
        to_deg(low),
        to_deg(high),
        degrees(signature.heading.1),
        degrees(port),
        degrees(starboard),
    ))
}

/// The best next trial in one sentence.
pub fn next_trial(report: &TraceReport) -> String {
    let Some(best) = report.prospects.first() else {
        return String::from("none of the standard manoeuvres can be steered with the fitted model");
    };
    let mut gains = Vec::new();
    let pairs = |pairs: &[[String; 2]]| -> String {
        pairs.iter().map(|[one, other]| format!("{one} from {other}")).collect::<Vec<_>>().join(", ")
    };
    if !best.separated.is_empty() {
        gains.push(format!("would separate {}", pairs(&best.separated)));
    }
    if !best.revealed.is_empty() {
        gains.push(format!("would make visible {}", best.revealed.join(", ")));
    }
    let mut limits = Vec::new();
    if !best.still_alike.is_empty() {
        limits.push(format!("would not separate {}", pairs(&best.still_alike)));
    }
    if !best.still_hidden.is_empty() {
        limits.push(format!("would not show {}", best.still_hidden.join(", ")));
    }
    let sharper = best.sharpening.map(|change| 100.0 * (1.0 - change.exp())).filter(|percent| *percent >= 1.0);
    if let (true, Some(percent)) = (gains.is_empty(), sharper) {
        gains.push(format!("would make the standard deviations of the parameters {percent:.0} % smaller"));
    }
    let what = if gains.is_empty() { String::from("is no worse than any other") } else { gains.join(" and ") };
    let but = if limits.is_empty() { String::new() } else { format!("; it {}", limits.join(" and ")) };
    format!(
        "a {} {what}{but} (expected information of {} manoeuvres with the fitted model)",
        best.name,
        report.prospects.len()
    )
}

/// Errors before and after on every record.
pub fn errors(report: &TraceReport) -> Table {
    let mut columns = vec![Column::left("record"), Column::left("use"), Column::left("model")];
    columns.push(Column::decimal("heading").unit("deg"));
    columns.extend(HORIZONS.map(|length| Column::decimal(format!("every {length:.0} s")).unit("deg")));
    columns.push(Column::decimal("yaw rate").unit("deg/s"));
    columns.push(Column::decimal("overshoots").unit("deg"));
    let mut table = Table::new(columns);
    let analysis = report.analysis;
    let fitted = analysis.identification.iter().map(|judged| (judged, "fitted"));
    let uses = fitted.chain(analysis.validation.iter().map(|judged| (judged, "held out")));
    for ((judged, used), name) in uses.zip(&report.names) {
        for (model, on) in [("before", &judged.before), ("after", &judged.after)] {
            let errors = &on.errors;
            let mut cells =
                if model == "before" { vec![name.clone(), used.to_owned()] } else { vec![String::new(); 2] };
            cells.push(model.to_owned());
            let numbers =
                [Some(errors.heading)].into_iter().chain(errors.horizon).chain([errors.yaw_rate, errors.overshoot]);
            cells.extend(
                numbers.map(|value| value.map_or_else(|| MISSING.into(), |value| significant(to_deg(value), 3))),
            );
            table.push(cells);
        }
    }
    table
}

/// Overshoots and period of the records and of both replays.
fn overshoots(report: &TraceReport) -> Option<Table> {
    let mut table = Table::new([
        Column::left("record"),
        Column::left("heading"),
        Column::left("overshoots [deg]"),
        Column::decimal("period").unit("s"),
    ]);
    let analysis = report.analysis;
    let trials = report.trials.iter().chain(report.others);
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
        zigzag.overshoots.iter().map(|overshoot| number::fixed(to_deg(overshoot.angle.value), 2)).collect();
    [name.to_owned(), label.to_owned(), angles.join(", "), optional(zigzag.period.map(|period| period.value), 1)]
}

fn parameters(report: &TraceReport) -> Table {
    let analysis = report.analysis;
    let remarks = analysis.parameters.iter().any(|fitted| fitted.at_bound);
    let mut columns = ["parameter", "value", "95 % interval", "unit", "record"].map(Column::left).to_vec();
    columns.extend(remarks.then(|| Column::left("remark")));
    let mut table = Table::new(columns);
    let mut push = |cells: [String; 5], at_bound: bool| {
        let remark = remarks.then(|| if at_bound { "at its bound".to_owned() } else { String::new() });
        table.push(cells.into_iter().chain(remark));
    };
    let ([k, t], [k_ends, t_ends, _]) = (analysis.indices, analysis.indices_at_bound());
    for (symbol, quantity, unit, ends) in [("K", k, "1/s", k_ends), ("T", t, "s", t_ends)] {
        let [value, interval] = [uncertain(quantity.value, quantity.sd), number::interval(quantity.ci95)];
        push([symbol.into(), value, interval, unit.into(), MISSING.into()], ends);
    }
    for fitted in &analysis.parameters {
        let (Quantity { value, sd, ci95 }, unit) = in_degrees(fitted);
        let only = fitted.only.clone().unwrap_or_else(|| MISSING.into());
        push([fitted.parameter.symbol.into(), uncertain(value, sd), interval(ci95), unit, only], fitted.at_bound);
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

fn candidates(report: &TraceReport) -> Table {
    let mut table = Table::new([
        Column::left("candidate"),
        Column::left("form"),
        Column::left("outcome"),
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
            one.gain_alone.map_or_else(|| MISSING.into(), signed),
            one.evidence.map_or_else(|| MISSING.into(), |evidence| signed(evidence.gain)),
            one.evidence.map_or_else(|| MISSING.into(), |evidence| significant(evidence.p_value, 2)),
            one.visibility.map_or_else(|| MISSING.into(), |visibility| significant(-visibility, 3)),
        ]);
    }
    table
}

fn prospects(prospects: &[Prospect]) -> Table {
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

/// `report.md`. `figures` are the stems and captions of what was drawn.
pub fn page(report: &TraceReport, figures: &[(String, String)]) -> String {
    let analysis = report.analysis;
    let mut text = format!("# Trace of {}\n\n", report.names[..report.trials.len()].join(", "));
    let _ = writeln!(text, "```text\n{}\n```\n", words(report));
    let _ = writeln!(text, "## Error before and after\n\n{}", errors(report).to_markdown());
    text += "Before is the best first-order base there is; after is the base with what was found. Heading and yaw rate are those of \
             the recorded rudder replayed over the whole record, *every 20 s* those of a heading that is restarted so often; \
             *overshoots* is the mean error of the overshoot angles. On held-out records nothing but the initial state is fitted.\n\n";
    if let Some(table) = overshoots(report) {
        let _ = writeln!(text, "## Overshoots and period\n\n{}", table.to_markdown());
    }
    text += "## What was added\n\n";
    if analysis.effects.is_empty() {
        text += "Nothing.\n\n";
    }
    for effect in &analysis.effects {
        let _ = writeln!(text, "**{} ({})**: `{}`\n\n{}.\n", effect.id, effect.form, effect.equation, effect.sentence);
        if !effect.aliases.is_empty() {
            let names: Vec<String> = effect.aliases.iter().map(|(id, form)| format!("{id} ({form})")).collect();
            let _ = writeln!(text, "These records cannot tell it from {}.\n", names.join(", "));
        }
    }
    for refused in &analysis.refused {
        let _ = writeln!(text, "{refused}.\n");
    }
    let _ = writeln!(text, "## The model\n\n{}", parameters(report).to_markdown());
    let noise = &analysis.randomness;
    let _ = write!(text, "Heading noise: {}° (white)", significant(to_deg(noise.white), 2));
    if let Some(kind) = noise.moment {
        let _ = write!(text, ", and a random yaw moment ({})", moment(kind));
    }
    if let Some(waves) = noise.waves {
        let (sd, frequency) = (significant(to_deg(waves.sd), 2), significant(waves.frequency, 3));
        let _ = write!(text, ", and waves of {sd}° at {frequency} rad/s");
    }
    text += ".\n\n";
    let _ = writeln!(text, "## Candidates\n\n{}", candidates(report).to_markdown());
    text += "ΔBIC is negative where a candidate helps. `alone` is on top of the base under white noise; `in the end` is on top of \
             the final model against the best random explanation (for an added one: of its removal). The last column is the \
             largest ΔBIC that an effect as large as can be expected would have in these records; what stays above the threshold \
             is not observable.\n\n";
    if let Some(signature) = signature(report) {
        let _ = writeln!(text, "## What is left\n\n{signature}.\n");
        if let Some(empirical) = &analysis.empirical {
            let _ = writeln!(
                text,
                "Empirical, without a name in the field: a term in {} would lower the heading error to {}° (ΔBIC {}). It is a \
                 proposal and not part of the model.\n",
                empirical.group.join(" or "),
                significant(to_deg(empirical.error), 2),
                number::fixed(-empirical.evidence.gain, 0)
            );
        }
    }
    let hidden: Vec<String> = analysis
        .candidates
        .iter()
        .filter(|one| one.outcome == Outcome::NotObservable)
        .map(|one| format!("{} ({})", one.id, one.form))
        .collect();
    if !hidden.is_empty() {
        let _ = writeln!(text, "## Blind spots\n\nNot observable in these records: {}.\n", hidden.join(", "));
    }
    let _ = writeln!(
        text,
        "## Next trial\n\nBest: {}.\n\n{}",
        next_trial(report),
        prospects(&report.prospects).to_markdown()
    );
    text += "Separated and revealed are counted over the aliases and blind spots above, for the records and the trial together; the \
             last column is the mean change of the standard deviations of the parameters.\n\n## Figures\n\n";
    for (stem, caption) in figures {
        let _ = writeln!(text, "![{caption}]({stem}.png)\n\n{caption}\n");
    }
    text
}

/// What the record of a judged pair is called in a figure.
pub fn title(judged: &Judged, name: &str, held_out: bool) -> String {
    let ratio = judged.after.errors.heading / judged.before.errors.heading;
    let held = if held_out { ", held out" } else { "" };
    format!("{name}{held}: heading error after / before {}", significant(ratio, 2))
}

#[cfg(test)]
mod tests {
    use ship::response::BASE;

    use super::*;

    #[test]
    fn a_parameter_at_its_bound_is_a_warning() {
        let fitted = |place: usize, value, at_bound| Fitted {
            parameter: &BASE[place],
            quantity: Quantity::bare(value),
            only: None,
            at_bound,
        };
        let all = [fitted(0, 10.0, true), fitted(2, 0.01, false)];
        assert_eq!(bounds(&all), ["1/T = 10.0 1/s is at its bound: the search ends there, and K and T follow from it"]);
    }
}
