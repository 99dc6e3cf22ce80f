//! Verdict over the estimates of several methods: the recommended estimate, or the reason why none is accepted.
//!
//! Rule: [`Recommendation`]. Entries of the estimates: [`method_entry`](crate::method_entry::method_entry).

use document::fit::{KtUsability, VerdictEntry, VerdictReason};
use document::method::MethodEntry;
use ship::FirstOrder;
use ship::angle::to_deg;
use trial::Trial;

use crate::estimate::Estimate;
use crate::lack_of_fit::LackOfFit;
use crate::recommended::Recommendation;
use crate::replay::pooled_response_rms;

/// Maximum ratio of a replay error to the smallest; above it a method is listed separately.
const MAX_ERROR_RATIO: f64 = 10.0;

/// Minimum share of the variance of the headings explained by a replay. First-order responses to sound records of ships
/// and models explain 0.97 and more, also for strongly nonlinear ships and in gusts.
const MIN_EXPLAINED_SHARE: f64 = 0.9;

/// Ids of the methods whose estimates are compared with the accepted estimate, and may contradict it.
pub const REFERENCE_METHODS: [&str; 2] = ["output-error", "maximum-likelihood"];

/// Verdict over the estimates of several methods from the same records; `None` if no method gives an estimate.
pub fn from_estimates(trials: &[Trial], answers: &[(MethodEntry, Option<Estimate>)]) -> Option<VerdictEntry> {
    let entries: &Vec<MethodEntry> = &answers.iter().map(|(entry, _)| entry.clone()).collect();
    let estimate_of = |id: &str| answers.iter().find(|(entry, _)| entry.id() == id)?.1.as_ref();
    let straight =
        pooled_response_rms(trials, &FirstOrder { inverse_T: 0.0, K_over_T: 0.0, rudder_bias: 0.0 }).map(to_deg);
    let [nearest, likely] = REFERENCE_METHODS.map(estimate_of);
    let mut verdict = taken(&Recommendation::from_estimates(trials, nearest, likely), entries, straight)?;
    verdict.because = disbelief(&verdict, entries, straight);
    if verdict.because.is_some() {
        verdict.believe = KtUsability::No;
        (verdict.k_per_s, verdict.t_s) = (None, None);
    }
    Some(verdict)
}

/// Reason why no K and T are accepted from records whose headings have this scatter about straight lines, deg; `None`
/// if they are accepted.
///
/// A random moment turns the ship, too, so the nearest replay must explain the headings. An unstable ship has K and T
/// below zero: the interval of T must show it.
fn disbelief(verdict: &VerdictEntry, entries: &[MethodEntry], scatter_deg: Option<f64>) -> Option<String> {
    let taken = entries.iter().find(|entry| entry.method == verdict.method)?;
    let answered = || entries.iter().filter(|entry| entry.parameters.is_some());
    let [k, t] = taken.parameters.map(|parameters| [parameters.k_per_s, parameters.t_s])?;
    let left_deg = answered().filter_map(|entry| entry.heading_rmse_deg).fold(f64::INFINITY, f64::min);
    let explained = scatter_deg.map_or(1.0, |scatter| 1.0 - (left_deg / scatter).powi(2));
    let failed = |id: &&str| entries.iter().any(|entry| entry.id() == *id && entry.parameters.is_none());
    let is_usual = REFERENCE_METHODS.contains(&taken.id()) || !REFERENCE_METHODS.iter().all(failed);
    let is_unstable = t.ci95.is_some_and(|[_, high]| high < 0.0);
    if let Some(straight) = verdict.straight_lines_rms_deg {
        return Some(format!(
            "the best replay ({}) misses the headings by {}° (rms), and a straight line without any rudder only by {}°",
            verdict.method,
            tenths(left_deg),
            tenths(straight)
        ));
    }
    if explained.is_nan() || explained < MIN_EXPLAINED_SHARE {
        let [percent, least] = [explained.max(0.0), MIN_EXPLAINED_SHARE].map(|share| format!("{:.0}", 100.0 * share));
        return Some(format!(
            "the best replay explains {percent} % of the variance of the heading (error {}° rms), and K and T of a \
             ship explain {least} % or more",
            tenths(left_deg)
        ));
    }
    if !is_usual {
        return Some(format!(
            "{} found no answer, and noise and weather bias that of {}",
            REFERENCE_METHODS.join(" and "),
            verdict.method
        ));
    }
    ((k.value <= 0.0 || t.value <= 0.0) && !is_unstable).then(|| {
        String::from("K and T are below zero, as for a course-unstable ship, and the interval of T does not confirm it")
    })
}

fn tenths(degrees: f64) -> String {
    format!("{degrees:.1}")
}

/// Accepted estimate: the recommended estimate, or the nearest replay if no recommended estimate is among the entries
/// or none is accepted. `straight` is the heading residual of a ship without an effect of her rudder, about the
/// straight line nearest to each record, deg.
fn taken(recommendation: &Recommendation, entries: &[MethodEntry], straight: Option<f64>) -> Option<VerdictEntry> {
    let answered = || entries.iter().filter(|entry| entry.parameters.is_some());
    let rms = |entry: &&MethodEntry| entry.heading_rmse_deg.unwrap_or(f64::INFINITY);
    let is_own = |entry: &&MethodEntry| entry.id() == recommendation.method();
    let nearest = answered().min_by(|a, b| rms(a).total_cmp(&rms(b)))?;
    let straight_lines_deg = straight.filter(|straight| rms(&nearest) >= *straight);
    let taken = answered().find(is_own).filter(|_| straight_lines_deg.is_none());
    let reason = taken.map_or(VerdictReason::NearestReplay, |_| recommendation.reason);
    let taken = taken.unwrap_or(nearest);
    let is_far = |entry: &&MethodEntry| rms(entry) > MAX_ERROR_RATIO * rms(&nearest) && entry.method != taken.method;
    let degrees = |size: fn(&LackOfFit) -> f64| recommendation.lack_of_fit.as_ref().map(|lack| to_deg(size(lack)));
    let contradicts =
        |entry: &&MethodEntry| REFERENCE_METHODS.contains(&entry.id()) && (are_apart(taken, entry) || is_far(entry));
    Some(VerdictEntry {
        believe: KtUsability::Yes,
        because: None,
        method: taken.method.clone(),
        k_per_s: taken.parameters.map(|parameters| parameters.k_per_s),
        t_s: taken.parameters.map(|parameters| parameters.t_s),
        reason,
        residual: recommendation.residual_kind(),
        residual_deg: degrees(|lack| lack.residual_rms),
        with_ship_terms_deg: degrees(|lack| lack.rms_with_ship_terms),
        noise_deg: degrees(|lack| lack.noise_sd),
        rudder_delay_s: recommendation.lack_of_fit.and_then(|lack| lack.rudder_delay()),
        far_off_methods: answered().filter(is_far).map(|entry| entry.method.clone()).collect(),
        straight_lines_rms_deg: straight_lines_deg,
        contradicted_by: answered().find(contradicts).map(|entry| entry.method.clone()),
    })
}

/// `true` if the intervals of K or of T are disjoint.
fn are_apart(a: &MethodEntry, b: &MethodEntry) -> bool {
    let (Some(a), Some(b)) = (a.parameters, b.parameters) else { return false };
    [(a.k_per_s, b.k_per_s), (a.t_s, b.t_s)]
        .into_iter()
        .any(|(a, b)| a.ci95.zip(b.ci95).is_some_and(|([low, high], [from, to])| high < from || to < low))
}

#[cfg(test)]
mod tests {
    use document::method::{IndexEstimates, MethodStatus};
    use trial::Quantity;

    use super::*;

    /// An estimate is rejected if it explains too little of the headings, comes from no usual method or is below zero;
    /// a ship that is clearly course-unstable is accepted.
    #[test]
    fn an_answer_that_cannot_be_taken_says_why() {
        let entry = |method: &str, k_and_t: Option<[Quantity; 2]>| MethodEntry {
            method: method.into(),
            status: MethodStatus::Ok,
            parameters: k_and_t.map(|[k_per_s, t_s]| IndexEstimates {
                k_per_s,
                t_s,
                delta_r_deg: Quantity::without_uncertainty(0.0),
            }),
            heading_rmse_deg: k_and_t.map(|_| 2.0),
            ..MethodEntry::default()
        };
        let usual = |k: f64, t: f64, ci95: Option<[f64; 2]>| {
            let t = Quantity { ci95, ..Quantity::without_uncertainty(t) };
            [entry("output-error", Some([Quantity::without_uncertainty(k), t])), entry("maximum-likelihood", None)]
        };
        let nearest = Recommendation { reason: VerdictReason::NearestReplay, lack_of_fit: None, is_calm: false };
        let reason = |entries: &[MethodEntry], scatter: f64| {
            let verdict = taken(&nearest, entries, Some(scatter)).expect("an answer");
            disbelief(&verdict, entries, Some(scatter)).unwrap_or_default()
        };
        assert_eq!(reason(&usual(0.1, 40.0, None), 20.0), "");
        assert_eq!(reason(&usual(-0.1, -40.0, Some([-60.0, -30.0])), 20.0), "");
        assert!(reason(&usual(0.1, 40.0, None), 5.0).contains("explains 84 % of the variance"));
        assert!(reason(&usual(-0.1, -40.0, Some([-90.0, 20.0])), 20.0).contains("below zero"));
        let mut biased = usual(0.1, 40.0, None).to_vec();
        biased[0] = entry("output-error", None);
        biased.push(entry(
            "least-squares",
            Some([Quantity::without_uncertainty(0.1), Quantity::without_uncertainty(40.0)]),
        ));
        assert!(reason(&biased, 20.0).contains("found no answer"));
        assert!(reason(&usual(0.1, 40.0, None), 1.9).contains("a straight line"));
        assert_eq!(reason(&biased[2..], 20.0), "");
    }

    /// A method without an interval contradicts the estimate by its replay.
    #[test]
    fn a_replay_far_off_contradicts_the_answer() {
        let entry = |method: &str, t: f64, rms: f64| MethodEntry {
            method: method.into(),
            status: MethodStatus::Ok,
            parameters: Some(IndexEstimates {
                k_per_s: Quantity::without_uncertainty(0.1),
                t_s: Quantity::without_uncertainty(t),
                delta_r_deg: Quantity::without_uncertainty(0.0),
            }),
            heading_rmse_deg: Some(rms),
            ..MethodEntry::default()
        };
        let taken = Recommendation { reason: VerdictReason::NearestReplay, lack_of_fit: None, is_calm: false };
        let outcome = |rms: f64, straight: f64| {
            let far = [entry("output-error", 9.0, 1.9), entry("least-squares", 28.0, rms)];
            let all = [&far[..], &[entry("maximum-likelihood", 41.0, rms)]].concat();
            let verdict = super::taken(&taken, &all, Some(straight)).expect("an answer");
            (verdict.contradicted_by, verdict.far_off_methods.len(), verdict.straight_lines_rms_deg)
        };
        assert_eq!(outcome(38.0, 2.0), (Some("maximum-likelihood".into()), 2, None));
        assert_eq!(outcome(18.0, 1.9), (None, 0, Some(1.9)));
    }
}
