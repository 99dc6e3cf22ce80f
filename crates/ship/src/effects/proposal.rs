//! An effect as some records may lack it: the range, the scale and the starts of its parameters in the units of these records.

use std::sync::Arc;

use super::Effect;

/// The manoeuvres of some records in numbers, from which a proposal follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Manoeuvres {
    /// Time constant of the base, s, positive and shorter than a tenth of the longest record.
    pub time: f64,
    /// Root mean square yaw rate, rad/s.
    pub rate: f64,
    /// Largest rudder angle, rad.
    pub rudder: f64,
    /// Longest record, s.
    pub duration: f64,
    /// Usual time between rows, s.
    pub spacing: f64,
    /// Mean square speed, m²/s², where all records have it; so are the next three.
    pub speed_square: Option<f64>,
    /// Mean square sway velocity, m²/s².
    pub sway_square: Option<f64>,
    /// Mean square relative wind speed, m²/s².
    pub wind_square: Option<f64>,
    /// Root mean square, smallest and largest propeller revolutions, 1/s.
    pub propeller: Option<[f64; 3]>,
    /// First and last time, s, of the record in which an effect that depends on time would act.
    pub span: [f64; 2],
}

/// An effect that records may lack.
#[derive(Debug, Clone)]
pub struct Proposal {
    /// The effect, with its constants from the records.
    pub effect: Arc<dyn Effect>,
    /// Parameters that are not fitted but kept at their start.
    pub held: &'static [usize],
    /// Smallest values.
    pub lowest: Vec<f64>,
    /// Largest values.
    pub highest: Vec<f64>,
    /// Sizes against which steps are measured.
    pub scale: Vec<f64>,
    /// Where a fit starts; the best end counts. Empty where the start has to be looked for in the residual.
    pub starts: Vec<Vec<f64>>,
    /// Parameters of an effect as large as it can be expected: what a record cannot see of this size, it cannot see.
    pub large: Vec<f64>,
}

impl Proposal {
    /// An effect within its physical range.
    pub fn new(effect: impl Effect + 'static, scale: Vec<f64>, starts: Vec<Vec<f64>>, large: Vec<f64>) -> Self {
        let parameters = effect.parameters();
        Self {
            held: &[],
            lowest: parameters.iter().map(|p| p.lowest).collect(),
            highest: parameters.iter().map(|p| p.highest).collect(),
            scale,
            starts,
            large,
            effect: Arc::new(effect),
        }
    }

    /// An effect of one parameter, its start and its large value as shares of its scale.
    pub fn of_one(effect: impl Effect + 'static, scale: f64, start: f64, large: f64) -> Self {
        let mut proposal = Self::new(effect, vec![scale], Vec::new(), Vec::new());
        let (lowest, highest) = (proposal.lowest[0], proposal.highest[0]);
        let bounded = |share: f64| vec![(share * scale).clamp(lowest, highest)];
        (proposal.starts, proposal.large) = (vec![bounded(start)], bounded(large));
        proposal
    }

    /// The same with parameter number `place` in another range.
    #[must_use]
    pub fn within(mut self, place: usize, [lowest, highest]: [f64; 2]) -> Self {
        (self.lowest[place], self.highest[place]) = (lowest, highest);
        self
    }
}
