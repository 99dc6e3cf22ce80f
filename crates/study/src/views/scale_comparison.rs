//! What was found at each scale beside what was found at all of them together, without dimension: which terms scale.

use report::number::{MISSING, fixed, uncertain};
use report::{Column, Table};
use serde::{Deserialize, Serialize};
use ship::Particulars;
use trial::{Quantity, Scaling};

use super::method_table::estimate;
use crate::records::file_of;
use crate::scales::{Together, scale_name};

/// One number without dimension at every scale.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ComparedTerm {
    /// Symbol.
    pub symbol: String,
    /// Unit: 1, or an angle.
    pub unit: String,
    /// From the records of all scales.
    pub joint: Quantity,
    /// From those of every scale alone; none where they do not tell it.
    pub own: Vec<Option<Quantity>>,
    /// Largest difference of two scales in units of its standard deviation.
    pub difference_sd: Option<f64>,
    /// `scales`, `does not scale` or `cannot be told`.
    pub verdict: String,
}

/// The terms of one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ComparedModel {
    /// A method, or `traced`.
    pub model: String,
    /// Its terms.
    pub terms: Vec<ComparedTerm>,
}

/// The records of one scale.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ScaleEntry {
    /// Length, m.
    pub length_m: f64,
    /// Approach speed, m/s.
    pub speed_m_s: f64,
    /// What times are multiplied with to be those of the first scale.
    pub time_factor: f64,
    /// Its fitted records.
    pub files: Vec<String>,
}

/// Everything that is said of records of several scales.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ScalesEntry {
    /// The scales; numbers with a dimension are told at the first.
    pub groups: Vec<ScaleEntry>,
    /// The comparison of every model.
    pub comparisons: Vec<ComparedModel>,
}

impl ComparedTerm {
    /// Compares what was found at every scale.
    pub fn new(symbol: impl Into<String>, unit: &str, joint: Quantity, own: Vec<Option<Quantity>>) -> Self {
        let found: Vec<Quantity> = own.iter().map(|own| own.unwrap_or(Quantity::bare(f64::NAN))).collect();
        let (difference_sd, verdict) = Scaling::of(&found);
        let verdict = verdict.as_str().to_owned();
        Self { symbol: symbol.into(), unit: unit.to_owned(), joint, own, difference_sd, verdict }
    }
}

impl ScalesEntry {
    /// What is made of the records of every scale, given by their numbers, and of the first scale, at which all are
    /// told; `None` where the fitted records have one scale.
    pub fn compared(
        together: &Together,
        compare: impl FnOnce(&[(Particulars, Vec<usize>)], Particulars) -> Vec<ComparedModel>,
    ) -> Option<Self> {
        let scales = together.scales.as_ref()?;
        let first = scales.particulars[0];
        let groups = scales.groups(together.trials.len());
        let files: Vec<&str> = together.trials.iter().map(|trial| file_of(trial).0).collect();
        (groups.len() > 1).then(|| Self::new(&groups, &files, first, compare(&groups, first)))
    }

    /// The scales of these groups of records of these names.
    fn new(
        groups: &[(Particulars, Vec<usize>)],
        files: &[&str],
        first: Particulars,
        comparisons: Vec<ComparedModel>,
    ) -> Self {
        let of = |(own, records): &(Particulars, Vec<usize>)| ScaleEntry {
            length_m: own.length,
            speed_m_s: own.speed,
            time_factor: own.factor_to(first, [1, 0]),
            files: records.iter().map(|record| files[*record].to_owned()).collect(),
        };
        Self { groups: groups.iter().map(of).collect(), comparisons }
    }

    /// The terms of a model that do not scale, in a sentence.
    pub fn sentence(model: &ComparedModel) -> String {
        let of = |verdict: Scaling| -> Vec<&str> {
            let terms = model.terms.iter().filter(|term| term.verdict == verdict.as_str());
            terms.map(|term| term.symbol.as_str()).collect()
        };
        let [same, differing, open] = [Scaling::Scales, Scaling::DoesNotScale, Scaling::CannotBeTold].map(of);
        let mut parts = Vec::new();
        for (symbols, words) in [
            (differing, ["does not scale", "do not scale"]),
            (same, ["scales", "scale"]),
            (open, ["cannot be told", "cannot be told"]),
        ] {
            if !symbols.is_empty() {
                parts.push(format!("{} {}", symbols.join(", "), words[usize::from(symbols.len() > 1)]));
            }
        }
        parts.join("; ")
    }

    /// The table of one model.
    pub fn table(&self, model: &ComparedModel) -> Table {
        let mut columns = vec![Column::left("term"), Column::left("all together")];
        columns.extend(
            self.groups
                .iter()
                .map(|group| Column::left(scale_name(Particulars { length: group.length_m, speed: group.speed_m_s }))),
        );
        columns.extend([Column::decimal("difference").unit("sd"), Column::left("verdict")]);
        let mut table = Table::new(columns);
        let number = |quantity: &Quantity| match quantity.value.is_finite() {
            true => uncertain(quantity.value, quantity.sd),
            false => MISSING.to_owned(),
        };
        for term in &model.terms {
            let unit = if term.unit == "1" { String::new() } else { format!(" [{}]", term.unit) };
            let mut cells = vec![format!("{}{unit}", term.symbol), number(&term.joint)];
            cells.extend(term.own.iter().map(|own| own.as_ref().map_or_else(|| MISSING.to_owned(), number)));
            cells.push(term.difference_sd.map_or_else(|| MISSING.to_owned(), |far| fixed(far, 1)));
            cells.push(term.verdict.clone());
            table.push(cells);
        }
        table
    }
}

/// K' and T' with their intervals, one row for every name.
pub fn prime_table(rows: &[(String, Quantity, Quantity)]) -> Table {
    let mut table = Table::new([
        Column::left("method"),
        Column::decimal("K′"),
        Column::interval(),
        Column::left("sd"),
        Column::decimal("T′"),
        Column::interval(),
        Column::left("sd"),
    ]);
    let sd =
        |quantity: &Quantity| quantity.sd.map_or_else(|| MISSING.to_owned(), |sd| report::number::significant(sd, 2));
    for (name, k, t) in rows {
        let mut cells = vec![name.clone()];
        for quantity in [k, t] {
            cells.extend(estimate(quantity));
            cells.push(sd(quantity));
        }
        table.push(cells);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_term_has_its_word_and_the_sentence_begins_with_what_does_not_scale() {
        let of = |value: f64, sd: f64| Some(Quantity::new(value, Some(sd)));
        let joint = Quantity::new(1.0, Some(0.01));
        let terms = vec![
            ComparedTerm::new("K′", "1", joint, vec![of(1.0, 0.01), of(1.02, 0.01)]),
            ComparedTerm::new("n₃/T′", "1/rad²", joint, vec![of(1.0, 0.01), of(1.5, 0.01)]),
            ComparedTerm::new("δ_r", "deg", joint, vec![of(1.0, 0.5), None]),
        ];
        let model = ComparedModel { model: "traced".into(), terms };
        assert_eq!(ScalesEntry::sentence(&model), "n₃/T′ does not scale; K′ scales; δ_r cannot be told");
        let groups = [
            (Particulars { length: 7.0, speed: 1.18 }, vec![0, 2]),
            (Particulars { length: 320.0, speed: 7.97 }, vec![1]),
        ];
        let entry = ScalesEntry::new(&groups, &["a", "b", "c"], groups[0].0, vec![model]);
        assert_eq!(entry.groups[0].files, ["a", "c"]);
        assert!((entry.groups[1].time_factor - 7.0 / 1.18 / (320.0 / 7.97)).abs() < 1e-12);
        let text = entry.table(&entry.comparisons[0]).to_text();
        assert!(text.contains("L = 7.00 m, V = 1.18 m/s") && text.contains("35.4"), "{text}");
        assert!(text.contains("n₃/T′ [1/rad²]") && text.contains("does not scale"), "{text}");
    }
}
