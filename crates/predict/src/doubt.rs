//! Why a figure that was corrected to full load says little.

use std::fmt;

/// Why a corrected figure says little.
#[derive(Debug, Clone, PartialEq)]
pub enum Doubt {
    /// F/B is hardly known.
    Wide {
        /// Half width of its 90 % interval as a share of its median.
        share: f64,
    },
    /// B may be zero, or nearly so.
    NearZero {
        /// 90 % interval of B.
        ci90: [f64; 2],
    },
    /// What was measured is not what the model of the condition of the trial does.
    Outside {
        /// What was measured.
        measured: f64,
        /// 90 % interval of B.
        ci90: [f64; 2],
    },
    /// Not every drawn ship comes that far.
    Undefined {
        /// Share of the pairs of ships that do.
        share: f64,
    },
    /// A model is used beyond the rudder or the yaw rate of its records.
    Extrapolated {
        /// Which model.
        condition: &'static str,
    },
    /// The models are of different structure.
    Structure {
        /// That at full load.
        full: String,
        /// That in the condition of the trial.
        trial: String,
    },
    /// The models were identified by different methods.
    Method {
        /// That at full load.
        full: String,
        /// That in the condition of the trial.
        trial: String,
    },
    /// The models are of ships of different length.
    Scale {
        /// Length at full load, m.
        full: Option<f64>,
        /// Length in the condition of the trial, m.
        trial: Option<f64>,
    },
    /// The models approach at different speeds.
    Speed {
        /// Speed at full load, m/s.
        full: f64,
        /// Speed in the condition of the trial, m/s.
        trial: f64,
    },
}

/// Four digits, as far as they are behind the point.
fn short(value: f64) -> String {
    let decimals = if value == 0.0 { 1.0 } else { (3.0 - value.abs().log10().floor()).clamp(0.0, 6.0) };
    format!("{value:.*}", decimals as usize)
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let length = |length: &Option<f64>| length.map_or_else(|| String::from("unknown"), |l| format!("{l} m"));
        match self {
            Self::Wide { share } => write!(f, "F/B is known to ±{:.0} % only", 100.0 * share),
            Self::NearZero { ci90 } => {
                let [low, high] = ci90.map(short);
                write!(f, "B is near zero (90 % [{low}, {high}]), so its ratio says little")
            }
            Self::Outside { measured, ci90 } => {
                let ([low, high], measured) = (ci90.map(short), short(*measured));
                write!(f, "the model of the trial does not do what was measured: {measured}, not in [{low}, {high}]")
            }
            Self::Undefined { share } => {
                write!(f, "{:.0} % of the pairs of drawn ships come that far", 100.0 * share)
            }
            Self::Extrapolated { condition } => {
                write!(f, "the model {condition} is extrapolated beyond its records")
            }
            Self::Structure { full, trial } => {
                write!(f, "different structure: {full} at full load, {trial} in the condition of the trial")
            }
            Self::Method { full, trial } => {
                write!(f, "different methods: {full} at full load, {trial} in the condition of the trial")
            }
            Self::Scale { full, trial } => write!(
                f,
                "different scale: length {} at full load, {} in the condition of the trial",
                length(full),
                length(trial)
            ),
            Self::Speed { full, trial } => write!(
                f,
                "different approach speeds: {full:.2} m/s at full load, {trial:.2} m/s in the condition of the trial; \
                 F/B holds that, too"
            ),
        }
    }
}
