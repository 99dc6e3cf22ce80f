//! Transient disturbance: a yaw moment during a part of the record only, such as a squall or a passing ship.

use std::sync::Arc;

use super::effect::{
    CandidateEffect, Effect, EffectDescription, EffectEquations, EffectTarget, OperatingPoint, Parameter,
    ParameterPrior, RecordScales,
};
use super::instant::{EDGE_ROWS, ONSET_TIME, REACH_WIDTHS};
use crate::angle::DEGREE;
use crate::particulars::Dimension;
use estimation::number::Real;

/// Transient yaw moment of amplitude m, as equivalent rudder angle, in one of two forms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TransientDisturbance {
    /// Pulse with smooth edges: m/2 [tanh((t − t_c + d/2)/w) − tanh((t − t_c − d/2)/w)], w = d/10.
    Passing,
    /// Step at an instant: m/2 [1 + tanh((t − t₀)/w)], such as a change of loading or wind, or the start of a pump.
    Lasting {
        /// Width w of the edge, s.
        edge: f64,
    },
}

const MOMENT: Parameter = Parameter::odd(["m", "m", "rad"], [0.0, 0.03], [-0.6, 0.6]);

const PASSING: [Parameter; 3] = [
    MOMENT.with_scenario_key("rudder-deg", DEGREE, "Largest moment, as rudder angle."),
    Parameter { key: "t_c", symbol: "t_c", ..ONSET_TIME }.with_scenario_key("centre-s", 1.0, "Time of its middle."),
    Parameter::even(["d", "d", "s"], [30.0, 30.0], [0.5, 1e5]).with_scenario_key(
        "duration-s",
        1.0,
        "How long it lasts.",
    ),
];

const LASTING: [Parameter; 2] = [MOMENT, ONSET_TIME];

/// Width of an edge relative to the duration.
const EDGE_SHARE: f64 = 0.1;

/// Prior standard deviation of the moment as equivalent rudder angle, rad: the moment of a strong squall.
const MOMENT_SD_RAD: f64 = 0.05;

/// Maximum duration of a pulse relative to the duration of its record.
const MAX_DURATION_SHARE: f64 = 0.2;

/// Share of a record at either end in which no step is fitted, because only a few rows would determine it.
const END_MARGIN_SHARE: f64 = 0.05;

impl Effect for TransientDisturbance {
    fn description(&self) -> EffectDescription {
        let (form, equation, parameters): (_, _, &[Parameter]) = match self {
            Self::Passing => ("moment for a while", "T r' + r = K (δ + δ_r + m s(t; t_c, d))", &PASSING),
            Self::Lasting { .. } => ("moment that stays", "T r' + r = K (δ + δ_r + m s(t; t₀))", &LASTING),
        };
        EffectDescription { id: "transient_disturbance", form, equation, parameters }
    }

    fn constants(&self) -> Vec<(f64, Dimension)> {
        match self {
            Self::Passing => Vec::new(),
            Self::Lasting { edge } => vec![(*edge, [1, 0])],
        }
    }

    fn with_constants(&self, constants: &[f64]) -> Option<Arc<dyn Effect>> {
        match (self, constants) {
            (Self::Lasting { .. }, &[edge]) => Some(Arc::new(Self::Lasting { edge })),
            _ => None,
        }
    }

    fn is_time_dependent(&self) -> bool {
        true
    }

    fn is_environmental(&self) -> bool {
        true
    }

    fn has_instant(&self) -> bool {
        true
    }

    fn candidate(&self, records: &RecordScales) -> Option<CandidateEffect> {
        let RecordScales { row_interval, time_span: [start, end], .. } = *records;
        let duration = end - start;
        let moment = ParameterPrior::normal(&MOMENT, 0.0, MOMENT_SD_RAD);
        if let Self::Lasting { .. } = self {
            let instant =
                ParameterPrior::uniform([start + END_MARGIN_SHARE * duration, end - END_MARGIN_SHARE * duration]);
            return Some(CandidateEffect::new(Self::Lasting { edge: EDGE_ROWS * row_interval }, [moment, instant]));
        }
        // The centre stays a quarter of the maximum duration away from both ends, so at least three quarters of every
        // pulse are in the record.
        let margin = MAX_DURATION_SHARE * 0.25 * duration;
        let range = [(3.0 * row_interval).max(0.5), MAX_DURATION_SHARE * duration];
        let place = [ParameterPrior::uniform([start + margin, end - margin]), ParameterPrior::uniform(range)];
        Some(CandidateEffect::new(*self, [moment, place[0], place[1]]))
    }

    fn acts_on(&self) -> EffectTarget {
        EffectTarget::MOMENT
    }

    fn min_time_constant(&self, p: &[f64]) -> f64 {
        match self {
            Self::Passing => EDGE_SHARE * p[2],
            Self::Lasting { edge } => *edge,
        }
    }

    fn fast_span(&self, p: &[f64]) -> [f64; 2] {
        let reach = match self {
            Self::Passing => (0.5 + REACH_WIDTHS * EDGE_SHARE) * p[2],
            Self::Lasting { edge } => REACH_WIDTHS * edge,
        };
        [p[1] - reach, p[1] + reach]
    }
}

impl<R: Real> EffectEquations<R> for TransientDisturbance {
    fn yaw_acceleration(&self, p: &[R], _z: &[R], now: &OperatingPoint<R>) -> R {
        let since = R::from(now.t) - p[1];
        let shape = match self {
            Self::Passing => {
                let (half, width) = (p[2] * 0.5, p[2] * EDGE_SHARE);
                ((since + half) / width).tanh() - ((since - half) / width).tanh()
            }
            Self::Lasting { edge } => (since / R::from(*edge)).tanh() + R::from(1.0),
        };
        now.K_over_T * 0.5 * p[0] * shape
    }
}
