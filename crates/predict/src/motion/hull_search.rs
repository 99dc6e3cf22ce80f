//! What a fit of all three degrees of freedom minimises.

use super::coefficients::{BOUNDS, COEFFICIENTS, PlanarCoefficients, TYPICAL};
use super::course::{OUTPUTS, WindowedRecord};
use super::hull::HULL_COEFFICIENTS;
use super::search::{ResidualColumn, Squares};
use super::yaw::{YAW_BOUNDS, Yaw};

/// Windows with the weights of their outputs.
pub(crate) struct Windows<'a> {
    courses: Vec<&'a WindowedRecord>,
    /// All windows: record and number of the window.
    places: Vec<(usize, usize)>,
    /// Surge and sway as measured; only the yaw equation is searched.
    driven: bool,
    pub deviations: [f64; OUTPUTS],
}

impl<'a> Windows<'a> {
    pub fn new(courses: Vec<&'a WindowedRecord>, driven: bool, deviations: [f64; OUTPUTS]) -> Self {
        let of =
            |(index, course): (usize, &&WindowedRecord)| (0..course.windows.len()).map(move |window| (index, window));
        Self { places: courses.iter().enumerate().flat_map(of).collect(), courses, driven, deviations }
    }

    /// Outputs that are compared.
    fn outputs(&self) -> usize {
        if self.driven { Self::WIDTH } else { OUTPUTS }
    }

    /// Root mean squares of the residuals in units of L and U₀, kind by kind.
    pub fn rms(&self, at: &[f64]) -> [f64; OUTPUTS] {
        let mut squares = [0.0; OUTPUTS];
        let mut counts = [0.0; OUTPUTS];
        for group in 0..self.groups() {
            let residuals = self.residuals(group, at);
            let there = residuals[0].iter().enumerate().filter(|(_, residual)| **residual != 0.0);
            for (i, residual) in there {
                squares[i % self.outputs()] += residual * residual;
                counts[i % self.outputs()] += 1.0;
            }
        }
        std::array::from_fn(|i| (squares[i] / f64::max(counts[i], 1.0)).sqrt() * self.deviations[i])
    }
}

impl Squares for Windows<'_> {
    /// Heading and yaw rate.
    const WIDTH: usize = 2;

    fn unknowns(&self) -> usize {
        HULL_COEFFICIENTS
    }

    fn groups(&self) -> usize {
        self.places.len()
    }

    /// Row by row in one column.
    fn residuals(&self, group: usize, at: &[f64]) -> Vec<ResidualColumn> {
        let (index, window) = self.places[group];
        let course = self.courses[index];
        let planar = PlanarCoefficients::from_array(std::array::from_fn(|i| at[i]));
        let yaw = Yaw::from_array(std::array::from_fn(|i| at[COEFFICIENTS + i]));
        let [first, last] = course.windows[window];
        let found = course.replay(&planar, &yaw, [first, last], self.driven);
        let mut residuals = Vec::with_capacity(found.len() * self.outputs());
        for (row, state) in (first..=last).zip(&found) {
            for (output, value) in state.iter().enumerate().take(self.outputs()) {
                let reading = course.readings[output][row];
                let residual = (value - reading) / self.deviations[output];
                residuals.push(if reading.is_finite() { residual } else { 0.0 });
            }
        }
        vec![residuals]
    }

    /// Forward differences, backward ones at an upper bound; zero by what is fixed.
    fn derivatives(&self, group: usize, at: &[f64]) -> (Vec<ResidualColumn>, Vec<Vec<ResidualColumn>>) {
        let here = self.residuals(group, at);
        let by = |unknown: usize| {
            if self.driven && unknown < COEFFICIENTS {
                return vec![vec![0.0; here[0].len()]];
            }
            let [_, most] = self.bounds(unknown);
            let typical = TYPICAL.to_array().get(unknown).copied().unwrap_or(0.1);
            let step = 1e-6 * at[unknown].abs().max(typical);
            let step = if at[unknown] + step > most { -step } else { step };
            let mut moved = at.to_vec();
            moved[unknown] += step;
            let there = self.residuals(group, &moved);
            vec![there[0].iter().zip(&here[0]).map(|(there, here)| (there - here) / step).collect()]
        };
        let slopes = (0..HULL_COEFFICIENTS).map(by).collect();
        (here, slopes)
    }

    fn global(&self, _group: usize, unknown: usize) -> usize {
        unknown
    }

    fn bounds(&self, unknown: usize) -> [f64; 2] {
        match unknown.checked_sub(COEFFICIENTS) {
            None => BOUNDS[unknown],
            Some(own) => YAW_BOUNDS[own],
        }
    }
}
