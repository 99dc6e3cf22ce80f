//! A formula as a program: names, numbers, operators and functions in the order in which they are worked out. Made from
//! text by the parser, evaluated in plain numbers and in numbers that carry derivatives.

use estimation::number::Real;

use crate::dynamics::{Measured, Regressor};
use crate::effects::effect::Now;
use crate::particulars::Dimension;

/// Most values that wait for an operator at once, and as many as most formulas have, of signals too.
pub(super) const STACK: usize = 16;
const FEW: usize = 3;

/// A signal that a formula may name. Units and signs are those of NOTATION.md.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FormulaSignal {
    /// `r`, yaw rate, rad/s.
    YawRate,
    /// `delta`, rudder that acts, rad.
    Rudder,
    /// `psi`, heading, rad.
    Heading,
    /// `y`, way to starboard of the course at which the record begins, m: y' = U sin(ψ − ψ₀). The speed is the measured
    /// one; 1 m/s where records have none, so that y is in metres for every m/s.
    LateralWay,
    /// `v`, sway velocity to starboard, m/s.
    Sway,
    /// `u`, surge velocity, m/s: √(U² − v²).
    Surge,
    /// `U`, speed through the water, m/s.
    Speed,
    /// `n`, propeller revolutions, 1/s.
    Propeller,
    /// `t`, time on the clock of the record, s.
    Time,
    /// `wind_speed`, relative wind speed, m/s.
    WindSpeed,
    /// `wind_angle`, direction the relative wind comes from, clockwise from the bow, rad.
    WindAngle,
    /// `rp`, yaw rate without dimension, r L/U.
    PrimeYawRate,
    /// `vp`, sway velocity without dimension, v/U.
    PrimeSway,
    /// `q`, speed over that of the approach, U/U₀; 1 where the record has no speed.
    SpeedRatio,
    /// `start`, time of the first row, s.
    Start,
    /// `K_over_T`, K/T of the ship, 1/s²: a moment divided by it is a yaw acceleration.
    Gain,
}

/// Numbers that a formula takes from a record: the signal that needs it, its neutral value and its dimension.
pub(super) const OF_RECORD: [(FormulaSignal, f64, Dimension); 5] = [
    (FormulaSignal::SpeedRatio, 1.0, [-1, 1]),
    (FormulaSignal::Start, 0.0, [1, 0]),
    (FormulaSignal::PrimeYawRate, 1.0, [0, 1]),
    (FormulaSignal::LateralWay, 1.0, [-1, 1]),
    (FormulaSignal::LateralWay, 0.0, [0, 0]),
];

/// Their values: approach speed, m/s, first time, s, and length of the ship, m; the speed by which a lateral way grows
/// where none is measured, m/s, and 1 where it always does, else 0.
pub(super) type OfRecord = [f64; OF_RECORD.len()];

impl FormulaSignal {
    /// Every signal with its name.
    pub const NAMES: [(&'static str, Self); 16] = [
        ("r", Self::YawRate),
        ("delta", Self::Rudder),
        ("psi", Self::Heading),
        ("y", Self::LateralWay),
        ("v", Self::Sway),
        ("u", Self::Surge),
        ("U", Self::Speed),
        ("n", Self::Propeller),
        ("t", Self::Time),
        ("wind_speed", Self::WindSpeed),
        ("wind_angle", Self::WindAngle),
        ("rp", Self::PrimeYawRate),
        ("vp", Self::PrimeSway),
        ("q", Self::SpeedRatio),
        ("start", Self::Start),
        ("K_over_T", Self::Gain),
    ];

    /// The measured channels it needs.
    pub(super) fn channels(self) -> &'static [Regressor] {
        match self {
            Self::Sway => &[Regressor::Sway],
            Self::Surge | Self::PrimeSway => &[Regressor::Sway, Regressor::Speed],
            Self::Speed | Self::PrimeYawRate => &[Regressor::Speed],
            Self::Propeller => &[Regressor::Propeller],
            Self::WindSpeed | Self::WindAngle => &[Regressor::Wind],
            _ => &[],
        }
    }

    /// Its value at an instant of a record that has its channels; `z` are the states of the formula.
    #[inline(always)]
    pub(super) fn at<R: Real>(self, now: &Now<R>, z: &[R], &[approach_speed, start, length, ..]: &OfRecord) -> R {
        let Measured { speed, sway, wind_speed, wind_from, propeller } = *now.measured;
        let there = |channel: Option<f64>| channel.unwrap_or(f64::NAN);
        let of = |channel: Option<f64>| R::from(there(channel));
        match self {
            Self::YawRate => now.yaw_rate,
            Self::Rudder => now.rudder,
            Self::Heading => now.heading,
            Self::LateralWay => z[0],
            Self::Sway => of(sway),
            Self::Surge => R::from((there(speed).powi(2) - there(sway).powi(2)).max(0.0).sqrt()),
            Self::Speed => of(speed),
            Self::Propeller => of(propeller),
            Self::Time => R::from(now.t),
            Self::WindSpeed => of(wind_speed),
            Self::WindAngle => of(wind_from),
            Self::PrimeYawRate => now.yaw_rate * (length / there(speed)),
            Self::PrimeSway => R::from(there(sway) / there(speed)),
            Self::SpeedRatio => R::from(speed.map_or(1.0, |speed| speed / approach_speed)),
            Self::Start => R::from(start),
            Self::Gain => now.gain,
        }
    }
}

/// A function of one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FormulaFunction {
    /// Magnitude.
    Abs,
    /// −1, 0 or 1.
    Sign,
    /// Square root.
    Sqrt,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Log,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Tangent.
    Tan,
    /// Hyperbolic tangent.
    Tanh,
    /// 1 above zero, else 0.
    Step,
}

impl FormulaFunction {
    /// Every function of one value with its name.
    pub const NAMES: [(&'static str, Self); 10] = [
        ("abs", Self::Abs),
        ("sign", Self::Sign),
        ("sqrt", Self::Sqrt),
        ("exp", Self::Exp),
        ("log", Self::Log),
        ("sin", Self::Sin),
        ("cos", Self::Cos),
        ("tan", Self::Tan),
        ("tanh", Self::Tanh),
        ("step", Self::Step),
    ];

    #[inline(always)]
    fn of<R: Real>(self, x: R) -> R {
        match self {
            Self::Abs => x.abs(),
            Self::Sign if x.value() == 0.0 => R::from(0.0),
            Self::Sign => R::from(x.value().signum()),
            Self::Sqrt => x.sqrt(),
            Self::Exp => x.exp(),
            Self::Log => x.ln(),
            Self::Sin => x.sin_cos().0,
            Self::Cos => x.sin_cos().1,
            Self::Tan => {
                let (sin, cos) = x.sin_cos();
                sin / cos
            }
            Self::Tanh => x.tanh(),
            Self::Step => R::from(if x.value() > 0.0 { 1.0 } else { 0.0 }),
        }
    }
}

/// An operator or a function of two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FormulaOperator {
    /// Sum.
    Add,
    /// Difference.
    Subtract,
    /// Product.
    Multiply,
    /// Quotient.
    Divide,
    /// Power of a positive number.
    Power,
    /// The smaller one.
    Min,
    /// The larger one.
    Max,
    /// `step(x, width)`, a step of this width: (1 + tanh(x/width))/2.
    SmoothStep,
}

impl FormulaOperator {
    /// Functions of two values with their names.
    pub const NAMES: [(&'static str, Self); 4] =
        [("min", Self::Min), ("max", Self::Max), ("pow", Self::Power), ("step", Self::SmoothStep)];

    #[inline(always)]
    fn of<R: Real>(self, x: R, y: R) -> R {
        match self {
            Self::Add => x + y,
            Self::Subtract => x - y,
            Self::Multiply => x * y,
            Self::Divide => x / y,
            Self::Power => x.powf(y),
            Self::Min => {
                if y.value() < x.value() {
                    y
                } else {
                    x
                }
            }
            Self::Max => {
                if y.value() > x.value() {
                    y
                } else {
                    x
                }
            }
            Self::SmoothStep => ((x / y).tanh() + 1.0) * 0.5,
        }
    }
}

/// What needs no working out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Operand {
    /// A number.
    Number(f64),
    /// A constant that is fitted, by its place.
    Constant(usize),
    /// A signal, by its place.
    Signal(usize),
}

/// One step of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Instruction {
    /// The last value waits; this is the last one now.
    Take(Operand),
    /// Minus.
    Negate,
    /// A whole power.
    WholePower(i32),
    /// A function of the last value.
    Call(FormulaFunction),
    /// An operator between the value that has waited least and the last one.
    Operate(FormulaOperator),
    /// An operator between the last value and this: what would be a `Take` and an `Operate`.
    With(FormulaOperator, Operand),
}

/// A formula ready to be evaluated.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FormulaProgram {
    pub(super) instructions: Vec<Instruction>,
    /// The constants in the order of their first use, in which their values travel.
    pub(super) constants: Vec<String>,
    /// The signals in the order of their first use.
    pub(super) signals: Vec<FormulaSignal>,
    /// Most values that wait at once beside the last one.
    pub(super) waiting: usize,
}

impl FormulaProgram {
    /// The measured channels that these need, the sway first.
    pub(super) fn channels(&self) -> Vec<Regressor> {
        let all = [Regressor::Sway, Regressor::Speed, Regressor::Wind, Regressor::Propeller];
        all.into_iter().filter(|own| self.signals.iter().any(|signal| signal.channels().contains(own))).collect()
    }

    /// Its value with these constants; `signal` gives the signals.
    #[inline]
    pub(super) fn value<R: Real>(&self, constants: &[R], signal: impl Fn(FormulaSignal) -> R) -> R {
        match (self.signals.len(), self.waiting) {
            (0..=2, 0..=1) => self.run::<R, 2, 1>(constants, signal),
            (0..=FEW, 0..=FEW) => self.run::<R, FEW, FEW>(constants, signal),
            _ => self.run::<R, STACK, STACK>(constants, signal),
        }
    }

    #[inline]
    fn run<R: Real, const SIGNALS: usize, const WAITING: usize>(
        &self,
        constants: &[R],
        signal: impl Fn(FormulaSignal) -> R,
    ) -> R {
        let mut signals = [R::from(0.0); SIGNALS];
        for (value, own) in signals.iter_mut().zip(&self.signals) {
            *value = signal(*own);
        }
        let value = |operand: Operand| match operand {
            Operand::Number(number) => R::from(number),
            Operand::Constant(place) => constants[place],
            Operand::Signal(place) => signals[place],
        };
        let Some((&Instruction::Take(first), rest)) = self.instructions.split_first() else { return R::from(0.0) };
        let mut last = value(first);
        let (mut waiting, mut count) = ([R::from(0.0); WAITING], 0);
        for step in rest {
            match *step {
                // Products are most of what formulas do.
                Instruction::With(FormulaOperator::Multiply, Operand::Signal(place)) => last = last * signals[place],
                Instruction::With(FormulaOperator::Multiply, operand) => last = last * value(operand),
                Instruction::Take(operand) => {
                    waiting[count] = last;
                    count += 1;
                    last = value(operand);
                }
                Instruction::Negate => last = -last,
                Instruction::WholePower(power) => last = last.powi(power),
                Instruction::Call(function) => last = function.of(last),
                Instruction::Operate(operator) => {
                    count -= 1;
                    last = operator.of(waiting[count], last);
                }
                Instruction::With(operator, operand) => last = operator.of(last, value(operand)),
            }
        }
        last
    }
}
