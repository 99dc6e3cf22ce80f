//! Data of the figures of traces: confusion matrices, comparison of rules.

use document::names;
use std::collections::BTreeSet;

use campaign::scenario::{HULL_ID, TRACE_ID};
use report::CurveOrigin;
use report::figures::{AxisSpec, CellMap, MapCell, NamedRows, Outline, RowItem, RowKind, RowsColumn, Shades};
use report::number::significant;
use report::palette::{CurveStyle, DIMENSION_LINE, HEADING, Marker, RGBColor, RUDDER, SOLID};

use campaign::design::Design;
use campaign::statistics::{Statistic, distinct, grouped, wilson_share};
use campaign::summary::TraceSummary;

/// Name of the row of ships without a missing effect, and of the column of trials in which no effect was named.
const NOTHING: &str = "nothing";

/// Confusion matrices with their names. A row is the missing effect of the ships of one or more cells. There is one
/// matrix for every combination of the other axes if the first axis decides the missing effect, and one for ships that
/// lack several effects.
pub fn confusion_matrices(design: &Design, lines: &[TraceSummary]) -> Vec<(String, CellMap)> {
    let other_labels = |line: &TraceSummary| design.cells[line.cell].labels.get(1..).unwrap_or_default().join(", ");
    let kinds = |lines: &[&TraceSummary]| lines.iter().map(|line| &line.missing_effects).collect::<BTreeSet<_>>().len();
    let mut groups = grouped(lines, |line| other_labels(line));
    if groups.iter().any(|(_, group)| kinds(group) < 2) {
        groups = vec![(String::new(), lines.iter().collect())];
    }
    let mut matrices = Vec::new();
    for (name, group) in groups {
        let (several, single): (Vec<_>, Vec<_>) = group.into_iter().partition(|line| line.missing_effects.len() > 1);
        for (kind, lines) in [("", single), ("several", several)] {
            if lines.len() > 1 {
                let name_parts = [name.as_str(), kind].into_iter().filter(|word| !word.is_empty());
                matrices.push((name_parts.collect::<Vec<_>>().join(", "), confusion(design, &lines)));
            }
        }
    }
    matrices
}

fn confusion(design: &Design, lines: &[&TraceSummary]) -> CellMap {
    let name = |line: &&TraceSummary| match &line.missing_effects[..] {
        [] => NOTHING.to_owned(),
        _ if line.is_hull() => design.cells[line.cell].labels.first().cloned().unwrap_or_default(),
        missing => names::effect_names(missing, " + "),
    };
    let rows = grouped(lines.iter().copied(), name);
    // Columns are in the order of the rows, so that correct names are on the diagonal.
    let missing =
        rows.iter().flat_map(|(_, lines)| lines).flat_map(|line| &line.missing_effects).filter(|id| *id != HULL_ID);
    let named = missing.chain(lines.iter().flat_map(|line| line.named_effect_counts.keys())).map(String::as_str);
    let is_silent = lines.iter().any(|line| line.nothing_named_count > 0 || line.missing_effects.is_empty());
    let columns = distinct(is_silent.then_some(NOTHING).into_iter().chain(named));
    let cell = |lines: &[&TraceSummary], id: &str| {
        let count = |line: &&TraceSummary| match id {
            NOTHING => line.nothing_named_count,
            id => line.named_effect_counts.get(id).copied().unwrap_or(0),
        };
        let trials: u64 = lines.iter().map(|line| line.trials).sum();
        let named = wilson_share(lines.iter().map(count).sum(), trials).map(|share| share.times(100.0));
        let is_right = lines[0].missing_effects.iter().any(|lack| lack == id)
            || (id == NOTHING && lines[0].missing_effects.is_empty());
        let of_alias: u64 = lines.iter().filter_map(|line| line.named_alias_counts.get(id)).sum();
        let is_alias = 2 * of_alias > lines.iter().map(count).sum();
        MapCell {
            value: Some(named.map_or(0.0, |share| share.value)),
            interval: named.and_then(|share| share.ci95),
            outline: if is_right { Some(Outline::Correct) } else { is_alias.then_some(Outline::Alias) },
            trial_count: trials,
        }
    };
    let trials = |lines: &[&TraceSummary]| lines.iter().map(|line| line.trials).sum::<u64>();
    let cells = rows.iter().map(|(_, lines)| columns.iter().map(|id| cell(lines, id)).collect());
    CellMap {
        axis_titles: [String::from("named by the trace"), String::from("missing")],
        columns: columns.iter().map(|id| names::effect_name(id)).collect(),
        // No line break within the count.
        rows: rows.iter().map(|(name, lines)| format!("{name} (n\u{a0}=\u{a0}{})", trials(lines))).collect(),
        shades: Shades::Shares,
        panels: vec![(None, cells.collect())],
        note: Some(String::from(
            "Shares of the trials in per cent; empty: never named. A trace may name several effects, so that a row may \
             exceed 100.",
        )),
    }
}

/// Comparison of several traces over all ships whose effects are known: the share of trials with exact names, of ships
/// that lack an effect, and the share of trials with a false name. `None` for one trace, or if no ship lacks an
/// effect.
pub fn trace_comparison_rows(design: &Design, lines: &[TraceSummary]) -> Option<NamedRows> {
    let listed: Vec<&TraceSummary> = lines.iter().filter(|line| !line.is_hull()).collect();
    let rules = grouped(listed, |line| line.method);
    if rules.len() < 2 {
        return None;
    }
    let sum = |lines: &[&TraceSummary], count: fn(&TraceSummary) -> u64, lacks: bool| {
        lines.iter().filter(|line| !lacks || !line.missing_effects.is_empty()).map(|line| count(line)).sum::<u64>()
    };
    let trials_of = |lines: &[&TraceSummary], lacks: bool| sum(lines, |line| line.trials, lacks);
    let share_of = |lines: &[&TraceSummary], count: fn(&TraceSummary) -> u64, lacks: bool| {
        wilson_share(sum(lines, count, lacks), trials_of(lines, lacks)).map(|all| all.times(100.0))
    };
    let of_rule = |(method, lines): &(usize, Vec<&TraceSummary>)| {
        let (wrong, exact) = (
            share_of(lines, |line| line.falsely_named_count, false)?,
            share_of(lines, |line| line.exactly_named_count, true)?,
        );
        Some((design.methods[*method].label.as_str(), wrong, exact))
    };
    let counts = [false, true].map(|lacks| trials_of(&rules[0].1, lacks));
    Some(trade_off(&rules.iter().map(of_rule).collect::<Option<Vec<_>>>()?, counts))
}

/// Share of false names of several traces on ships without a missing effect, with 95 % Wilson intervals, whose upper
/// end bounds the rate of false names; `None` for one trace, or if a ship lacks an effect.
pub fn false_positive_rows(design: &Design, lines: &[TraceSummary]) -> Option<NamedRows> {
    let rules = grouped(lines, |line| line.method);
    if rules.len() < 2 || lines.iter().any(|line| !line.missing_effects.is_empty()) {
        return None;
    }
    let style = CurveOrigin::Method(TRACE_ID.to_owned()).style();
    let counted = |(method, lines): &(usize, Vec<&TraceSummary>)| {
        let counts = [|line: &&TraceSummary| line.falsely_named_count, |line: &&TraceSummary| line.trials];
        (design.methods[*method].label.as_str(), counts.map(|count| lines.iter().map(count).sum::<u64>()))
    };
    let mut rules: Vec<(&str, [u64; 2])> = rules.iter().map(counted).collect();
    // Rules with equal counts share the rows of the variants after the comma of their labels.
    let parts = rules.iter().filter_map(|(label, counts)| {
        let (kind, variant) = label.split_once(", ")?;
        Some((variant, kind, *counts))
    });
    let variants = grouped(parts, |(variant, ..)| *variant);
    let kinds = distinct(variants.iter().flat_map(|(_, rows)| rows.iter().map(|(_, kind, _)| *kind)));
    let is_same = |rows: &[(&str, &str, [u64; 2])]| {
        rows.len() == kinds.len() && rows.iter().all(|(.., counts)| *counts == rows[0].2)
    };
    let mut note = String::from("Nothing is missing in any trial.");
    if kinds.len() > 1 && variants.iter().all(|(_, rows)| is_same(rows)) {
        rules = variants.iter().map(|(variant, rows)| (*variant, rows[0].2)).collect();
        note += &format!(" The same by each of {} rules: {}.", kinds.len(), kinds.join(", "));
    }
    let row = |(_, [wrong, trials]): &(&str, [u64; 2])| {
        let share = wilson_share(*wrong, *trials)?.times(100.0);
        let number = share.ci95.map(|[_, upper]| format!("{wrong} of {trials}: up to {upper:.0} %"));
        Some(vec![RowItem { number, ..RowItem::new("", RowKind::Mark(style, share.value, share.ci95)) }])
    };
    let column = RowsColumn {
        x: AxisSpec::decimal("trials with a false name [%]"),
        rows: rules.iter().map(row).collect::<Option<_>>()?,
        has_zero_line: true,
        ..RowsColumn::default()
    };
    Some(NamedRows {
        names: rules.iter().map(|(label, _)| (*label).to_owned()).collect(),
        names_title: String::from("list of effects"),
        columns: vec![column],
        note: Some(note),
        ..NamedRows::default()
    })
}

/// Rules as rows: one row for every variant after the comma of their labels, with every kind before it; `all` trials,
/// of which `lacking` are of ships that lack an effect.
fn trade_off(rules: &[(&str, Statistic, Statistic)], [all, lacking]: [u64; 2]) -> NamedRows {
    const COLOURS: [RGBColor; 3] = [HEADING, RUDDER, DIMENSION_LINE];
    const MARKERS: [Marker; 3] = [Marker::Circle, Marker::Square, Marker::Diamond];
    let parts: Vec<(&str, &str)> = rules.iter().map(|(name, ..)| name.split_once(", ").unwrap_or(("", name))).collect();
    let kinds = distinct(parts.iter().map(|(kind, _)| *kind));
    let variants = distinct(parts.iter().map(|(_, variant)| *variant));
    let column = |title: String, share: fn(&(&str, Statistic, Statistic)) -> Statistic| {
        let item = |(rule, (kind, _)): (&(&str, Statistic, Statistic), &(&str, &str))| {
            let number = kinds.iter().position(|other| other == kind).unwrap_or(0) % COLOURS.len();
            let style = CurveStyle { colour: COLOURS[number], marker: MARKERS[number], dash: SOLID, is_hollow: false };
            let share = share(rule);
            let number = Some(format!("{} %", significant(share.value, 2)));
            RowItem { number, ..RowItem::mark_below(*kind, style, share.value, share.ci95) }
        };
        let row = |variant: &&str| rules.iter().zip(&parts).filter(|(_, (_, of))| of == variant).map(item).collect();
        RowsColumn { x: AxisSpec::decimal(title), rows: variants.iter().map(row).collect(), ..RowsColumn::default() }
    };
    NamedRows {
        names_title: String::from("limit of the probability"),
        names: variants.iter().map(|variant| (*variant).to_owned()).collect(),
        columns: vec![
            column(format!("trials with a false name (n = {all}) [%]"), |(_, wrong, _)| *wrong),
            column(format!("trials named exactly (n = {lacking}) [%]"), |(.., exact)| *exact),
        ],
        note: Some(RULES.iter().filter(|(rule, _)| kinds.contains(rule)).map(|(_, meaning)| *meaning).collect())
            .filter(|note: &String| !note.is_empty()),
        ..NamedRows::default()
    }
}

/// Meaning of the rules with which labels of traces may begin.
const RULES: [(&str, &str); 2] =
    [("posterior", "Posterior: by marginal likelihood. "), ("bic", "Bic: by exp(−BIC/2); its intervals are as wide.")];

#[cfg(test)]
mod tests {
    use super::*;
    use campaign::scenario::MethodName;

    /// One trial of four has a false name, and one of the two ships that lack an effect is named exactly.
    #[test]
    fn rules_are_held_against_what_was_missing() {
        let name = |label: &str| MethodName { id: "trace".into(), label: label.into() };
        let design = Design { methods: vec![name("bic, 0.5"), name("bic, 0.9")], ..Design::default() };
        let line = |method, missing: &[&str], exactly_named, falsely_named| TraceSummary {
            missing_effects: missing.iter().map(|&id| id.to_owned()).collect(),
            ..TraceSummary {
                method,
                trials: 2,
                exactly_named_count: exactly_named,
                falsely_named_count: falsely_named,
                ..TraceSummary::default()
            }
        };
        let lines =
            [line(0, &["wave_yaw"], 1, 1), line(0, &[], 2, 0), line(1, &["wave_yaw"], 0, 0), line(1, &[], 2, 0)];
        let data = trace_comparison_rows(&design, &lines).expect("two rules");
        assert_eq!(data.names, ["0.5", "0.9"]);
        let shares = |column: usize, row: usize| match &data.columns[column].rows[row][..] {
            [RowItem { name: Some(kind), kind: RowKind::Mark(_, share, _), .. }] if kind == "bic" => *share,
            _ => panic!(),
        };
        assert_eq!([shares(0, 0), shares(0, 1), shares(1, 0), shares(1, 1)], [25.0, 0.0, 50.0, 0.0]);
        assert!(trace_comparison_rows(&design, &[line(0, &[], 1, 1), line(1, &[], 2, 0)]).is_none());
        assert!(
            trace_comparison_rows(&design, &lines[..2]).is_none() && false_positive_rows(&design, &lines).is_none()
        );
        // For ships without a missing effect the bound is shown: Wilson's of 0 of 2.
        let clean = false_positive_rows(&design, &[line(0, &[], 2, 0), line(1, &[], 1, 1)]).expect("two rules");
        let text = |row: usize| clean.columns[0].rows[row][0].number.as_deref();
        assert_eq!((text(0), text(1)), (Some("0 of 2: up to 66 %"), Some("1 of 2: up to 91 %")));
        // Rules with equal counts have one row for each variant.
        let labels = ["bic, long list", "posterior, long list", "bic, short list", "posterior, short list"];
        let design = Design { methods: labels.map(name).into(), ..Design::default() };
        let lines: Vec<TraceSummary> = (0..4).map(|method| line(method, &[], 1, u64::from(method < 2))).collect();
        let clean = false_positive_rows(&design, &lines).expect("four rules");
        assert_eq!(
            (&clean.names[..], clean.columns[0].rows.len()),
            (&[String::from("long list"), "short list".into()][..], 2)
        );
    }
}
