//! Table of the estimates of all methods: columns as narrow as the numbers allow, every estimate next to its 95 %
//! interval, a failed method as a row with its reason. All digits are in the stored JSON.

use identify::StopReason;
use report::number::{self, MISSING};
use report::{Table, TableHead};

use document::method::{MethodEntry, MethodStatus};
use trial::Quantity;

/// One row per method; `validated` names the records of the validation columns.
pub fn table(entries: &[MethodEntry], validated: &[String]) -> Table {
    let remarks = entries.iter().any(|entry| !remark(entry).is_empty());
    let mut head = TableHead::default().texts(["method"]);
    for (symbol, unit) in [("K", "1/s"), ("T", "s"), ("δ_r", "deg")] {
        head = head.numbers([symbol]).unit(unit).interval95();
    }
    head = head.numbers(["rms ψ"]).unit("deg").numbers(validated.iter().map(|name| format!("on {name}"))).unit("deg");
    let mut table = Table::new(head.texts(remarks.then_some("remark")));
    for entry in entries {
        let mut cells = vec![entry.method.clone()];
        match &entry.parameters {
            Some(parameters) => cells.extend(
                [&parameters.k_per_s, &parameters.t_s, &parameters.delta_r_deg]
                    .into_iter()
                    .flat_map(estimate_and_interval),
            ),
            None => cells.extend((0..6).map(|_| MISSING.to_owned())),
        }
        let rmse = |value: Option<f64>| value.map_or_else(|| MISSING.to_owned(), |value| number::significant(value, 3));
        cells.push(rmse(entry.heading_rmse_deg));
        cells.extend(entry.validation.iter().map(|validation| rmse(validation.heading_rmse_deg)));
        cells.push(remark(entry));
        table.push(cells);
    }
    table
}

/// Maximum number of significant digits.
const DIGITS: i32 = 5;

/// Value and interval, with the digits that the interval supports, at most five significant ones.
pub fn estimate_and_interval(quantity: &Quantity) -> [String; 2] {
    let value = quantity.value;
    if !value.is_finite() {
        return [MISSING.to_owned(), MISSING.to_owned()];
    }
    let Some([low, high]) = quantity.ci95 else {
        return [number::significant(value, DIGITS as usize - 1), MISSING.to_owned()];
    };
    let magnitude = |number: f64| if number == 0.0 { 0 } else { number.abs().log10().floor() as i32 };
    let largest = value.abs().max(low.abs()).max(high.abs());
    let half_width = 0.5 * (high - low);
    let supported = if half_width > 0.0 { 1 - magnitude(half_width) } else { i32::MAX };
    let decimals = supported.min(DIGITS - 1 - magnitude(largest)).clamp(0, 9) as usize;
    [number::fixed(value, decimals), format!("[{}, {}]", number::fixed(low, decimals), number::fixed(high, decimals))]
}

fn remark(entry: &MethodEntry) -> String {
    match (entry.status, &entry.failure) {
        (MethodStatus::Failed, Some(failure)) => format!("failed: {}", failure.replace('-', " ")),
        (MethodStatus::Failed, None) => "failed".to_owned(),
        (MethodStatus::Ok, _) => {
            let at_bound = entry.stop.as_deref() == Some(StopReason::RangeLimit.as_str());
            let remarks = [(entry.course_unstable, "course-unstable"), (at_bound, "at a bound")];
            let holding: Vec<&str> = remarks.iter().filter(|(holds, _)| *holds).map(|(_, remark)| *remark).collect();
            holding.join(", ")
        }
    }
}

#[cfg(test)]
mod tests {
    use identify::method_entry::{failure_entry, success_entry};
    use identify::{Estimate, IdentifyError, Uncertainty};
    use ship::FirstOrder;

    use super::*;

    #[test]
    fn digits_follow_the_interval_and_stop_at_five() {
        let shown = |value, ci95| estimate_and_interval(&Quantity { value, sd: None, ci95 });
        assert_eq!(shown(0.18713, Some([0.166, 0.215])), ["0.187", "[0.166, 0.215]"]);
        assert_eq!(shown(0.1748075, Some([0.1748052, 0.1748099])), ["0.17481", "[0.17481, 0.17481]"]);
        assert_eq!(shown(-0.7, Some([-5.83, 4.42])), ["−0.7", "[−5.8, 4.4]"]);
        assert_eq!(shown(2662.0, None), ["2662", "–"]);
        assert_eq!(shown(148.2, Some([142.0, 154.0])), ["148.2", "[142.0, 154.0]"]);
    }

    #[test]
    fn a_failed_method_is_a_row_with_its_reason() {
        let failed = failure_entry("srivc", &IdentifyError::NoTrial);
        let text = table(&[failed], &[]).to_text();
        assert!(text.contains("srivc") && text.contains("failed: no trial"), "{text}");
    }

    #[test]
    fn an_answer_at_the_end_of_a_search_has_a_remark() {
        let estimate = |stop, inverse_time| Estimate {
            response: FirstOrder { inverse_T: inverse_time, K_over_T: 0.01, rudder_bias: 0.0 },
            uncertainty: Uncertainty::None { reason: "not asked for" },
            robust_covariance: None,
            stop,
            evaluations: 1,
            noise: None,
            diagnostics: Vec::new(),
            warnings: Vec::new(),
        };
        let remark_at = |stop, inverse_time| remark(&success_entry("one", &estimate(stop, inverse_time), None));
        assert_eq!(remark_at(StopReason::Converged, 0.1), "");
        assert_eq!(remark_at(StopReason::RangeLimit, 0.1), "at a bound");
        assert_eq!(remark_at(StopReason::RangeLimit, -0.1), "course-unstable, at a bound");
    }
}
