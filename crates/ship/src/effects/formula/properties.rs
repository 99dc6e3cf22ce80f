//! Properties of a formula from its values at sample points: amplitudes (sizes) and shape constants, their
//! symmetry and units, and their priors.

use super::points::{SignalPoint, SignalScales};
use super::program::FormulaSignal;
use super::{Formula, MirrorSymmetry};
use crate::effects::effect::{Parameter, ParameterPrior, RecordScales};
use crate::particulars::{self, Dimension};

/// Bound of a constant without a given range.
const UNBOUNDED: f64 = 1e9;

/// Standard deviation of the moment over the maximum rudder angle, for a formula without expected values.
const MOMENT_SHARE: f64 = 0.2;

impl Formula {
    /// Value at a point: a yaw acceleration or a rudder angle.
    pub(super) fn value_at(&self, constants: &[f64], point: &SignalPoint) -> f64 {
        self.program.value(constants, |signal| point.signal(signal))
    }

    /// Moment as equivalent rudder angle, rad.
    fn moment(&self, constants: &[f64], point: &SignalPoint) -> f64 {
        self.value_at(constants, point) / point.signal(FormulaSignal::KOverT)
    }

    /// `true` for every constant that is a size (an amplitude): the moment is a linear function of it, c₀ + c₁ x, at
    /// all sample points. In the order of the constants.
    pub(super) fn amplitude_flags(&self) -> Vec<bool> {
        let count = self.program.constants.len();
        let is_size = |index: usize| {
            let value = |size: f64, point: &SignalPoint| {
                let mut constants: Vec<f64> = (0..count).map(|place| 0.7 + 0.3 * place as f64).collect();
                constants[index] = size;
                self.moment(&constants, point)
            };
            SignalPoint::all(&SignalScales::ones()).all(|point| {
                let [zero, one, three] = [0.0, 1.0, 3.0].map(|size| value(size, &point));
                let is_finite = [zero, one, three].iter().all(|value| value.is_finite());
                is_finite && (three - zero - 3.0 * (one - zero)).abs() <= 1e-9 * (three.abs() + zero.abs() + 1e-12)
            })
        };
        (0..count).map(is_size).collect()
    }

    /// `true` if the formula has sizes and the moment vanishes at all sample points when all sizes are zero.
    pub(super) fn can_be_absent(&self) -> bool {
        let ones = SignalScales::ones();
        let absent = self.with_size(None, &self.shapes(&ones));
        self.is_size.contains(&true) && SignalPoint::all(&ones).all(|point| self.moment(&absent, &point) == 0.0)
    }

    /// Constants with these shapes: one size (or none) equal to 1, all other sizes zero.
    fn with_size(&self, place: Option<usize>, shapes: &[f64]) -> Vec<f64> {
        let constant = |(index, shape): (usize, &f64)| match (self.is_size[index], place == Some(index)) {
            (false, _) => *shape,
            (true, is_selected) => f64::from(u8::from(is_selected)),
        };
        shapes.iter().enumerate().map(constant).collect()
    }

    /// Parameters for the constants of a formula.
    pub(super) fn derived_parameters(&self) -> Vec<Parameter> {
        let leaked = |text: String| -> &'static str { text.leak() };
        let shapes = self.shapes(&SignalScales::ones());
        let units = self.units(&shapes);
        let parameter = |place: usize| {
            let key = leaked(self.program.constants[place].clone());
            let unit =
                units[place].map_or(Parameter::NO_UNIT, |dimension| leaked(particulars::dimension_unit(dimension)));
            let size = if self.is_size[place] { 0.01 } else { shapes[place] };
            let typical = self.expected[place].about.unwrap_or(size);
            let neutral = if self.is_size[place] { 0.0 } else { typical };
            let ends = self.expected[place].ends.unwrap_or([-UNBOUNDED, UNBOUNDED]);
            Parameter {
                is_odd: self.is_size[place] && self.sides_of(place, &shapes) == MirrorSymmetry::Even,
                ..Parameter::even([key, key, unit], [neutral, typical], ends)
            }
        };
        (0..shapes.len()).map(parameter).collect()
    }

    /// Symmetry of the contribution of one size when port and starboard are exchanged.
    fn sides_of(&self, place: usize, shapes: &[f64]) -> MirrorSymmetry {
        let constants = self.with_size(Some(place), shapes);
        let agrees = |sign: f64| {
            SignalPoint::all(&SignalScales::ones()).all(|point| {
                let [moment, mirrored] = [&point, &point.mirrored()].map(|point| self.moment(&constants, point));
                (mirrored - sign * moment).abs() <= 1e-9 * (moment.abs() + mirrored.abs() + 1e-12)
            })
        };
        match (agrees(-1.0), agrees(1.0)) {
            (true, _) => MirrorSymmetry::Odd,
            (_, true) => MirrorSymmetry::Even,
            _ => MirrorSymmetry::Neither,
        }
    }

    /// Symmetry of the moment when port and starboard are exchanged at the same constants.
    pub fn mirror_symmetry(&self) -> MirrorSymmetry {
        let shapes = self.shapes(&SignalScales::ones());
        let sizes = (0..shapes.len()).filter(|place| self.is_size[*place]);
        let all = sizes.map(|place| self.sides_of(place, &shapes));
        all.reduce(|first, next| if first == next { first } else { MirrorSymmetry::Neither })
            .unwrap_or(MirrorSymmetry::Neither)
    }

    /// Dimension of every constant that follows from the signals, given that the result is an angle; `None` with
    /// several shapes, or if no integer powers of second and metre are consistent.
    fn units(&self, shapes: &[f64]) -> Vec<Option<Dimension>> {
        const POWERS: std::ops::RangeInclusive<i32> = -3..=3;
        let mut candidates: Vec<Dimension> =
            POWERS.flat_map(|seconds| POWERS.map(move |metres| [seconds, metres])).collect();
        match self.is_size.iter().filter(|is_size| !**is_size).count() {
            0 => candidates.truncate(1),
            1 => {}
            _ => candidates.clear(),
        }
        let all = |shape: Dimension| -> Option<Vec<Dimension>> {
            let dimension =
                |place| if self.is_size[place] { self.size_dimension(place, shapes, shape) } else { Some(shape) };
            (0..shapes.len()).map(dimension).collect()
        };
        let consistent = candidates.into_iter().find_map(all);
        (0..shapes.len()).map(|place| consistent.as_ref().map(|all| all[place])).collect()
    }

    /// Dimension of a size, given the dimension of the shapes; `None` if it is no integer power of second and metre.
    fn size_dimension(&self, place: usize, shapes: &[f64], of_shapes: Dimension) -> Option<Dimension> {
        let power = |second: f64, metre: f64| {
            let mut ratios = SignalPoint::all(&SignalScales::ones()).filter_map(|point| {
                let value = |point: &SignalPoint, grown: f64| {
                    let grown: Vec<f64> = shapes.iter().map(|shape| shape * grown).collect();
                    self.moment(&self.with_size(Some(place), &grown), point)
                };
                let grown = second.powi(of_shapes[0]) * metre.powi(of_shapes[1]);
                let ratio = value(&SignalPoint { second, metre, ..point }, grown) / value(&point, 1.0);
                ratio.is_finite().then(|| ratio.ln() / (second * metre).ln())
            });
            let first = ratios.next()?;
            let is_power = ratios.all(|other| (other - first).abs() < 1e-9) && (first - first.round()).abs() < 1e-9;
            is_power.then_some(-first.round() as i32)
        };
        Some([power(2.0, 1.0)?, power(1.0, 2.0)?])
    }

    /// Start values of the constants: the expected value; for a shape without one, the value at which the moment
    /// becomes nonlinear; otherwise 1.
    fn shapes(&self, scales: &SignalScales) -> Vec<f64> {
        let mut values: Vec<f64> = self.expected.iter().map(|constant| constant.about.unwrap_or(1.0)).collect();
        for place in 0..values.len() {
            if self.is_size[place] || self.expected[place].about.is_some() {
                continue;
            }
            let spread = |value: f64| {
                let mut constants = values.clone();
                constants[place] = value;
                let moments = SignalPoint::all(scales).map(|point| self.moment(&constants, &point));
                moments.map(|moment| moment * moment).sum::<f64>().sqrt()
            };
            // Exponent of the moment as a power of the constant: it changes where the moment becomes nonlinear in the
            // constant.
            let slope = |value: f64| (spread(1.1 * value) / spread(value)).ln() / 1.1_f64.ln();
            let first = slope(1e-6);
            let mut ladder = (-24..=24).map(|step| 10f64.powf(f64::from(step) / 4.0));
            let bend = ladder.find(|value| (slope(*value) - first).abs() > 0.5);
            values[place] = bend.filter(|_| first.is_finite()).unwrap_or(1.0);
            if let Some([lowest, highest]) = self.expected[place].ends {
                values[place] = values[place].clamp(lowest, highest);
            }
        }
        values
    }

    /// Priors of the constants. A size is normal about zero; its standard deviation is the magnitude of its expected
    /// value, or else the value at which the root mean square of the moment is a fifth of the maximum rudder angle. A
    /// shape is normal about its start value, with half the magnitude of that value as standard deviation. `None` if a
    /// prior is not finite.
    pub(super) fn derived_priors(&self, records: &RecordScales) -> Option<Vec<ParameterPrior>> {
        let scales = SignalScales::from_records(records);
        let shapes = self.shapes(&scales);
        let prior = |(place, parameter): (usize, &Parameter)| {
            if !self.is_size[place] {
                return ParameterPrior::normal(parameter, shapes[place], 0.5 * shapes[place].abs()).as_shape();
            }
            let alone = self.with_size(Some(place), &shapes);
            let square = SignalPoint::all(&scales).map(|point| self.moment(&alone, &point).powi(2)).sum::<f64>();
            let usual = MOMENT_SHARE * records.max_rudder / (square / SignalPoint::COUNT as f64).sqrt();
            ParameterPrior::normal(parameter, 0.0, self.expected[place].about.map_or(usual, f64::abs))
        };
        let priors: Vec<ParameterPrior> = self.description.parameters.iter().enumerate().map(prior).collect();
        priors.iter().all(|prior| prior.sd.is_finite() && prior.mean.is_finite()).then_some(priors)
    }
}
