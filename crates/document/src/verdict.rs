//! Which answer of a fit is to be taken, and what its residual says.

use serde::{Deserialize, Serialize};

/// Why an answer is to be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Reason {
    /// No first-order response replays the headings nearer.
    NearestReplay,
    /// A random yaw moment acts, and maximum likelihood counts it.
    RandomMoment,
    /// The recorded rudder is noisy, and maximum likelihood counts it.
    RudderNoise,
}

/// What the residual of the answer looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ResidualKind {
    /// White, and so the noise of the heading.
    Noise,
    /// Terms of a ship explain most of it: the model lacks an effect.
    LacksEffect,
    /// Terms of a ship do not explain it: random moments, waves or an error of the compass.
    Random,
}

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
