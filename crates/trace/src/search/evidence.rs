//! How much a term explains, and how much it has to.

/// What decides whether a term is believed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds {
    /// Smallest gain in BIC (Kass and Raftery 1995: above 10 is very strong).
    pub gain: f64,
    /// Probability of naming any effect where there is none, shared by all candidates (Bonferroni).
    pub false_discovery: f64,
    /// Most terms.
    pub most_terms: usize,
}

/// How much a term explains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// BIC without it less BIC with it.
    pub gain: f64,
    /// Probability of a likelihood ratio as large by chance, times the number of candidates.
    pub p_value: f64,
}
