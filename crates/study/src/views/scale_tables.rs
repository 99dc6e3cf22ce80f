//! Estimates at each scale compared with the joint estimate, as a sentence and as tables.

use document::scales::{ComparedModel, ScalesEntry, ScalingVerdict};
use report::number::{MISSING, fixed, with_uncertainty_and_power};
use report::{Table, TableHead};
use ship::Particulars;
use trial::Quantity;

use super::method_table::estimate_and_interval;
use crate::scales::scale_name;

/// Sentence on the terms of a model: which do not scale, which scale, and which are undecided.
pub fn scaling_terms_sentence(model: &ComparedModel) -> String {
    let symbols_of = |verdict: ScalingVerdict| -> Vec<&str> {
        let terms = model.terms.iter().filter(|term| term.verdict == verdict);
        terms.map(|term| term.symbol.as_str()).collect()
    };
    let [same, differing, open] =
        [ScalingVerdict::Scales, ScalingVerdict::DoesNotScale, ScalingVerdict::Undecided].map(symbols_of);
    let mut parts = Vec::new();
    for (symbols, predicates) in [
        (differing, ["does not scale", "do not scale"]),
        (same, ["scales", "scale"]),
        (open, ["is undecided", "are undecided"]),
    ] {
        if !symbols.is_empty() {
            parts.push(format!("{} {}", symbols.join(", "), predicates[usize::from(symbols.len() > 1)]));
        }
    }
    parts.join("; ")
}

/// Table of the terms of a model: joint estimate, estimate at each scale, difference and verdict.
pub fn table(scales: &ScalesEntry, model: &ComparedModel) -> Table {
    let groups = scales.groups.iter();
    let groups = groups.map(|group| scale_name(Particulars { length: group.length_m, speed: group.speed_m_s }));
    let head = TableHead::default().texts(["term", "all together"]).texts(groups);
    let mut table = Table::new(head.numbers(["difference"]).unit("sd").texts(["verdict"]));
    let number = |quantity: &Quantity| match quantity.value.is_finite() {
        true => with_uncertainty_and_power(quantity.value, quantity.sd),
        false => MISSING.to_owned(),
    };
    for term in &model.terms {
        let unit = if term.unit == "1" { String::new() } else { format!(" [{}]", term.unit) };
        let mut cells = vec![format!("{}{unit}", term.symbol), number(&term.joint)];
        cells.extend(term.by_scale.iter().map(|quantity| quantity.as_ref().map_or_else(|| MISSING.to_owned(), number)));
        cells.push(term.difference_sd.map_or_else(|| MISSING.to_owned(), |far| fixed(far, 1)));
        cells.push(term.verdict.to_string());
        table.push(cells);
    }
    table
}

/// Table of K' and T' with their intervals, one row for every name.
pub fn prime_table(rows: &[(String, Quantity, Quantity)]) -> Table {
    let head = TableHead::default().texts(["method"]).numbers(["K′"]).interval95().texts(["sd"]);
    let mut table = Table::new(head.numbers(["T′"]).interval95().texts(["sd"]));
    let sd = |value: &Quantity| value.sd.map_or_else(|| MISSING.to_owned(), |sd| report::number::significant(sd, 2));
    for (name, k, t) in rows {
        let mut cells = vec![name.clone()];
        for quantity in [k, t] {
            cells.extend(estimate_and_interval(quantity));
            cells.push(sd(quantity));
        }
        table.push(cells);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::scale_comparison::compared_term;

    #[test]
    fn every_term_has_its_word_and_the_sentence_begins_with_what_does_not_scale() {
        let quantity = |value: f64, sd: f64| Some(Quantity::new(value, Some(sd)));
        let joint = Quantity::new(1.0, Some(0.01));
        let terms = vec![
            compared_term(["K′", "1"], joint, vec![quantity(1.0, 0.01), quantity(1.02, 0.01)]),
            compared_term(["n₃/T′", "1/rad²"], joint, vec![quantity(1.0, 0.01), quantity(1.5, 0.01)]),
            compared_term(["δ_r", "deg"], joint, vec![quantity(1.0, 0.5), None]),
        ];
        let model = ComparedModel { model: "traced".into(), terms };
        assert_eq!(scaling_terms_sentence(&model), "n₃/T′ does not scale; K′ scales; δ_r is undecided");
        let groups = [
            (Particulars { length: 7.0, speed: 1.18 }, vec![0, 2]),
            (Particulars { length: 320.0, speed: 7.97 }, vec![1]),
        ];
        let entry = ScalesEntry::new(&groups, &["a", "b", "c"], groups[0].0, vec![model]);
        assert_eq!(entry.groups[0].files, ["a", "c"]);
        assert!((entry.groups[1].time_factor - 7.0 / 1.18 / (320.0 / 7.97)).abs() < 1e-12);
        let text = table(&entry, &entry.comparisons[0]).to_text();
        assert!(text.contains("L = 7.00 m, V = 1.18 m/s") && text.contains("35.4"), "{text}");
        assert!(text.contains("n₃/T′ [1/rad²]") && text.contains("does not scale"), "{text}");
    }
}
