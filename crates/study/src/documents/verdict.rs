//! Which answer of a fit is to be taken, and what its residual says.

use document::method::MethodEntry;
use identify::lack_of_fit::LackOfFit;
use identify::recommended::{Reason, Recommendation, ResidualKind};
use serde::{Deserialize, Serialize};
use ship::angle::to_deg;

/// A replay this many times worse than the best is set apart.
const FAR_WORSE: f64 = 10.0;

/// The answer to take.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct VerdictEntry {
    /// The method whose answer is to be taken.
    pub method: String,
    /// Why.
    pub reason: Reason,
    /// What the residual of output error looks like, where that has an answer.
    pub residual: Option<ResidualKind>,
    /// Root mean square of that residual, deg.
    pub residual_deg: Option<f64>,
    /// The same with nine more terms of a hull fitted to it, deg.
    pub with_ship_terms_deg: Option<f64>,
    /// Standard deviation of the noise of the heading, deg.
    pub noise_deg: Option<f64>,
    /// Time by which the rudder acts later than it was recorded, s, where that alone explains most of the residual;
    /// negative for a rudder that was recorded late.
    pub rudder_delay_s: Option<f64>,
    /// Methods whose replays are more than ten times worse than the best.
    pub set_apart: Vec<String>,
    /// Where no replay is nearer to the headings than straight lines are: the root mean square about these, deg. No
    /// method has an answer then, and `method` is the nearest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub straight_lines_deg: Option<f64>,
    /// Output error or maximum likelihood, where its 95 % interval of K or T lies wholly outside that of the answer to
    /// take, or its replay is set apart.
    pub contradicted_by: Option<String>,
}

impl VerdictEntry {
    /// From the answers of the methods; where the recommended one is not among them, or no answer is one, the nearest
    /// replay stands for it. `straight` is what a ship without an effect of her rudder leaves of the headings, the
    /// straight line nearest to each record, deg.
    pub fn of(recommendation: &Recommendation, entries: &[MethodEntry], straight: Option<f64>) -> Option<Self> {
        let answered = || entries.iter().filter(|entry| entry.parameters.is_some());
        let rms = |entry: &&MethodEntry| entry.heading_rmse_deg.unwrap_or(f64::INFINITY);
        let is_own = |entry: &&MethodEntry| entry.id() == recommendation.method();
        let nearest = answered().min_by(|one, other| rms(one).total_cmp(&rms(other)))?;
        let straight_lines_deg = straight.filter(|straight| rms(&nearest) >= *straight);
        let taken = answered().find(is_own).filter(|_| straight_lines_deg.is_none());
        let reason = taken.map_or(Reason::NearestReplay, |_| recommendation.reason);
        let taken = taken.unwrap_or(nearest);
        let is_far = |entry: &&MethodEntry| rms(entry) > FAR_WORSE * rms(&nearest) && entry.method != taken.method;
        let degrees = |of: fn(&LackOfFit) -> f64| recommendation.lack.as_ref().map(|lack| to_deg(of(lack)));
        let usual = ["output-error", "maximum-likelihood"];
        let contradicts =
            |entry: &&MethodEntry| usual.contains(&entry.id()) && (are_apart(taken, entry) || is_far(entry));
        Some(Self {
            method: taken.method.clone(),
            reason,
            residual: recommendation.residual(),
            residual_deg: degrees(|lack| lack.residual),
            with_ship_terms_deg: degrees(|lack| lack.with_ship_terms),
            noise_deg: degrees(|lack| lack.noise),
            rudder_delay_s: recommendation.lack.and_then(|lack| lack.rudder_delay()),
            set_apart: answered().filter(is_far).map(|entry| entry.method.clone()).collect(),
            straight_lines_deg,
            contradicted_by: answered().find(contradicts).map(|entry| entry.method.clone()),
        })
    }
}

/// Whether the intervals of K or of T have nothing in common.
fn are_apart(one: &MethodEntry, other: &MethodEntry) -> bool {
    let (Some(one), Some(other)) = (one.parameters, other.parameters) else { return false };
    [(one.k_per_s, other.k_per_s), (one.t_s, other.t_s)]
        .into_iter()
        .any(|(one, other)| one.ci95.zip(other.ci95).is_some_and(|([low, high], [from, to])| high < from || to < low))
}

#[cfg(test)]
mod tests {
    use document::method::{IndexEstimates, Status};
    use trial::Quantity;

    use super::*;

    /// A method without an interval contradicts by its replay.
    #[test]
    fn a_replay_far_off_contradicts_the_answer() {
        let entry = |method: &str, t: f64, rms: f64| MethodEntry {
            method: method.into(),
            status: Status::Ok,
            parameters: Some(IndexEstimates {
                k_per_s: Quantity::bare(0.1),
                t_s: Quantity::bare(t),
                delta_r_deg: Quantity::bare(0.0),
            }),
            heading_rmse_deg: Some(rms),
            ..MethodEntry::default()
        };
        let taken = Recommendation { reason: Reason::NearestReplay, lack: None };
        let told = |rms: f64, straight: f64| {
            let far = [entry("output-error", 9.0, 1.9), entry("least-squares", 28.0, rms)];
            let all = [&far[..], &[entry("maximum-likelihood", 41.0, rms)]].concat();
            let verdict = VerdictEntry::of(&taken, &all, Some(straight)).expect("an answer");
            (verdict.contradicted_by, verdict.set_apart.len(), verdict.straight_lines_deg)
        };
        assert_eq!(told(38.0, 2.0), (Some("maximum-likelihood".into()), 2, None));
        assert_eq!(told(18.0, 1.9), (None, 0, Some(1.9)));
    }
}
