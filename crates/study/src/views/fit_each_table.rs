//! Table of logs that were fitted one by one: the recommended estimate of each, or the reason why there is none.

use campaign::failure::Failure;
use report::number::MISSING;
use report::{Table, TableHead};
use serde::Serialize;
use serde_json::Value;
use trial::Quantity;

use super::method_table::estimate_and_interval;
use crate::work::fit_each::LogFit;

/// Table with one row for every log.
pub fn table(fits: &[LogFit]) -> Table {
    let head = TableHead::default().texts(["file", "method"]);
    let head = head.numbers(["K"]).unit("1/s").interval95().numbers(["T"]).unit("s").interval95();
    let head = head.texts(["believe", "residual"]).counts(["warnings"]).texts(["codes", "reason"]);
    let mut table = Table::new(head);
    for LogFit { file, verdict, warnings, error, .. } in fits {
        let verdict = verdict.as_ref();
        let number = |index: Option<Quantity>| {
            index.map_or_else(|| [missing(), missing()], |index| estimate_and_interval(&index))
        };
        let mut codes: Vec<String> = warnings.iter().map(|warning| word(&warning.code)).collect();
        codes.dedup();
        let mut cells = vec![file.display().to_string(), verdict.map_or_else(missing, |taken| taken.method.clone())];
        cells.extend(number(verdict.and_then(|verdict| verdict.k_per_s)));
        cells.extend(number(verdict.and_then(|verdict| verdict.t_s)));
        cells.push(verdict.map_or_else(missing, |verdict| word(&verdict.believe)));
        cells.push(verdict.and_then(|verdict| verdict.residual).map_or_else(missing, |residual| word(&residual)));
        cells.extend([warnings.len().to_string(), codes.join(" ")]);
        cells.push(match error {
            // The line of JSON also contains the remedy.
            Some(Failure { parts, .. }) => {
                let problem = parts.problem.split(['\n', ';']).next().unwrap_or_default();
                format!("{}: {problem}", word(&parts.code))
            }
            None => verdict.and_then(|verdict| verdict.because.clone()).unwrap_or_default(),
        });
        table.push(cells);
    }
    table
}

fn missing() -> String {
    MISSING.to_owned()
}

/// Name of a value as in JSON; the mark of a missing value for what is no text.
fn word(value: &impl Serialize) -> String {
    match serde_json::to_value(value) {
        Ok(Value::String(word)) => word,
        _ => missing(),
    }
}
