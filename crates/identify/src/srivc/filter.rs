//! State-variable filters 1/(s (s + â)) run over a record, and the resulting normal equations, in a single pass without
//! storage by row; the two unknowns of the initial state of a record are eliminated. Source: Garnier and Wang (2008),
//! Identification of Continuous-time Models from Sampled Data, chapter 4.

use nalgebra::{Matrix2, Matrix3, Matrix3x2, SMatrix, SVector, Vector2, Vector3};
use ship::first_order::{TangentTransition, YawState};

use super::record::{FilterRow, SrivcRecord};

/// Parameters common to all records: 1/T, K/T and K/T δ_r. The regression is linear in them, except for the filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SharedParameters {
    /// a = 1/T in the direction of the filters, 1/s.
    pub inverse_T: f64,
    /// b = K/T, 1/s².
    pub K_over_T: f64,
    /// b δ_r, rad/s².
    pub offset: f64,
}

/// Point of the iteration: the shared unknowns and the state at the first row of each record.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Point {
    pub shared: SharedParameters,
    pub starts: Vec<YawState>,
}

impl Point {
    /// Point at `share` of the way to another point.
    pub fn towards(&self, other: &Self, share: f64) -> Self {
        let between = |from: f64, to: f64| from + share * (to - from);
        let (from, to) = (&self.shared, &other.shared);
        let shared = SharedParameters {
            inverse_T: between(from.inverse_T, to.inverse_T),
            K_over_T: between(from.K_over_T, to.K_over_T),
            offset: between(from.offset, to.offset),
        };
        let start = |(from, to): (&YawState, &YawState)| YawState {
            heading: between(from.heading, to.heading),
            yaw_rate: between(from.yaw_rate, to.yaw_rate),
        };
        Self { shared, starts: self.starts.iter().zip(&other.starts).map(start).collect() }
    }
}

/// Filters of one record, at one row.
///
/// With F = 1/(s (s + â)) and lp = 1/(s + â), the signals are F 1/s = φ₂(t) and its derivative φ₁(t) in `unit`, F δ in
/// `steered`, lp ψ in `lagged`, all exact for a rudder and a heading that are linear between rows; and the noise-free
/// heading x of `shared` with ∂x/∂a in `motion` and `sensitivity`. Since (s + a) ∂x/∂a = −(x − x(0)), the sensitivity
/// is the noise-free counterpart of −lp (ψ − ψ(0)): the instrument.
pub(super) struct Filters {
    shared: SharedParameters,
    transition: TangentTransition,
    unit: YawState,
    steered: YawState,
    lagged: f64,
    pub motion: YawState,
    sensitivity: YawState,
}

impl Filters {
    /// Filters with pole −a of `shared`, before the first row.
    fn new(shared: SharedParameters, start: YawState) -> Self {
        Self {
            shared,
            transition: TangentTransition::new(shared.inverse_T, 0.0),
            unit: YawState::default(),
            steered: YawState::default(),
            lagged: 0.0,
            motion: start,
            sensitivity: YawState::default(),
        }
    }

    /// Advances the filters through `record` from `start`; calls `visit` at every observed row.
    #[inline]
    pub fn run(
        record: &SrivcRecord,
        shared: SharedParameters,
        start: YawState,
        mut visit: impl FnMut(&FilterRow, &Self),
    ) {
        let mut filters = Self::new(shared, start);
        let mut before: Option<&FilterRow> = None;
        for row in &record.rows {
            if let Some(before) = before {
                filters.advance(before, row);
            }
            if row.is_observed {
                visit(row, &filters);
            }
            before = Some(row);
        }
    }

    /// Advances all filters from the row `before` to `row`, with rudder and heading linear between them.
    #[inline]
    fn advance(&mut self, before: &FilterRow, row: &FilterRow) {
        let h = row.interval;
        if h != self.transition.value.time_step {
            self.transition = TangentTransition::new(self.shared.inverse_T, h);
        }
        let SharedParameters { K_over_T: b, offset, .. } = self.shared;
        let exact = &self.transition.value;
        let rate = 1.0 / h;
        let slope = (row.rudder - before.rudder) * rate;
        let lag = YawState { heading: 0.0, yaw_rate: self.lagged };
        self.lagged = exact.advance(lag, before.heading, (row.heading - before.heading) * rate).yaw_rate;
        self.unit = exact.advance(self.unit, 1.0, 0.0);
        self.steered = exact.advance(self.steered, before.rudder, slope);
        let force = b * before.rudder + offset;
        self.sensitivity = self.transition.advance(self.motion, self.sensitivity, force, b * slope);
        self.motion = exact.advance(self.motion, force, b * slope);
    }

    /// Instruments of this row: ∂x/∂a, F δ, F 1/s, and the two instruments of the initial state, 1 and φ₁.
    #[inline]
    pub fn instrumental_variables(&self) -> SVector<f64, 5> {
        self.with_first(self.sensitivity.heading)
    }

    /// Regressors: the instruments with the measured −lp ψ in place of its noise-free counterpart.
    #[inline]
    fn regressors(&self) -> SVector<f64, 5> {
        self.with_first(-self.lagged)
    }

    #[inline]
    fn with_first(&self, first: f64) -> SVector<f64, 5> {
        SVector::<f64, 5>::new(first, self.steered.heading, self.unit.heading, 1.0, self.unit.yaw_rate)
    }
}

/// Choice of Z in the normal equations ZᵀX θ = Zᵀψ: regressors (least squares) or instruments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LeftColumns {
    /// Regressors: least squares.
    Regressors,
    /// Noise-free instruments.
    Instruments,
}

/// Normal equations of one record, Zᵀ[−lp ψ, F δ, F 1/s, 1, φ₁] θ = Zᵀψ, with the last two unknowns eliminated.
pub(super) struct InstrumentalEquations {
    /// Z̃ᵀZ̃ of the shared unknowns, Z̃ being Z projected off 1 and φ₁.
    pub instruments: Matrix3<f64>,
    /// Z̃ᵀX of the shared unknowns.
    pub regressors: Matrix3<f64>,
    /// Z̃ᵀψ.
    pub target: Vector3<f64>,
    /// Coefficients of Z along 1 and φ₁: Z̃ = Z − P `along`ᵀ, P = [1, φ₁].
    pub along: Matrix3x2<f64>,
    /// (PᵀP)⁻¹; with the next two it gives the initial state for given shared unknowns.
    inner: Matrix2<f64>,
    /// PᵀX.
    inner_regressors: SMatrix<f64, 2, 3>,
    /// Pᵀψ.
    inner_target: Vector2<f64>,
}

impl InstrumentalEquations {
    /// One pass over `record` with the filters of `shared`; `None` if 1 and φ₁ are parallel, as after an overflow.
    pub fn new(record: &SrivcRecord, shared: SharedParameters, start: YawState, left: LeftColumns) -> Option<Self> {
        let mut gram = SMatrix::<f64, 5, 5>::zeros();
        let mut cross = SMatrix::<f64, 5, 2>::zeros();
        Filters::run(record, shared, start, |row, filters| {
            let z = match left {
                LeftColumns::Regressors => filters.regressors(),
                LeftColumns::Instruments => filters.instrumental_variables(),
            };
            for column in 0..5 {
                gram.column_mut(column).axpy(z[column], &z, 1.0);
            }
            cross.column_mut(0).axpy(-filters.lagged, &z, 1.0);
            cross.column_mut(1).axpy(row.heading, &z, 1.0);
        });
        let outer = gram.fixed_view::<3, 3>(0, 0);
        let mixed = gram.fixed_view::<3, 2>(0, 3);
        let inner = gram.fixed_view::<2, 2>(3, 3).try_inverse()?;
        let along = mixed * inner;
        let instruments = outer - along * mixed.transpose();
        let projected = cross.fixed_rows::<3>(0) - along * cross.fixed_rows::<2>(3);
        let mut regressors = instruments;
        regressors.set_column(0, &projected.column(0));
        let mut inner_regressors = mixed.transpose();
        inner_regressors.set_column(0, &cross.fixed_view::<2, 1>(3, 0));
        Some(Self {
            instruments,
            regressors,
            target: projected.column(1).into_owned(),
            along,
            inner,
            inner_regressors,
            inner_target: cross.fixed_view::<2, 1>(3, 1).into_owned(),
        })
    }

    /// State at the first row for the solution θ = (a − â, b, b δ_r): the unknowns of 1 and φ₁ are ψ₀ and
    /// r₀ + (a − â) ψ₀.
    pub fn start(&self, theta: &Vector3<f64>) -> YawState {
        let inner = self.inner * (self.inner_target - self.inner_regressors * theta);
        YawState { heading: inner[0], yaw_rate: inner[1] - theta[0] * inner[0] }
    }
}
