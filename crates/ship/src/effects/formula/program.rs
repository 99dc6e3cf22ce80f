//! Formula as a stack program: operands, operators and functions in the order of evaluation. Compiled from text by the
//! parser, evaluated in plain numbers and in dual numbers.

use estimation::number::Real;

use crate::dynamics::{MeasuredChannels, RegressorChannel};
use crate::effects::effect::OperatingPoint;
use crate::particulars::Dimension;

/// Capacity of the stack, in values.
pub(super) const STACK_SIZE: usize = 16;

/// Stack capacity and number of signals that suffice for most formulas.
const SMALL_STACK: usize = 3;

/// Signal that a formula can name. Units and signs as in NOTATION.md.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FormulaSignal {
    /// `r`, yaw rate, rad/s.
    YawRate,
    /// `delta`, acting rudder, rad.
    Rudder,
    /// `psi`, heading, rad.
    Heading,
    /// `y`, lateral distance to starboard of the initial course, m: y' = U sin(ψ − ψ₀). U is the measured speed, or
    /// 1 m/s if records have none, so that y is in metres per m/s.
    LateralDistance,
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
    /// `rp`, prime yaw rate r L/U.
    PrimeYawRate,
    /// `vp`, prime sway velocity v/U.
    PrimeSway,
    /// `q`, speed ratio U/U₀ to the approach; 1 if the record has no speed.
    SpeedRatio,
    /// `start`, time of the first row, s.
    Start,
    /// `K_over_T`, K/T of the ship, 1/s²: the factor from an equivalent rudder angle to a yaw acceleration.
    KOverT,
}

/// Record constants of a formula, each with the signal that uses it, its neutral value and its dimension.
pub(super) const RECORD_CONSTANTS: [(FormulaSignal, f64, Dimension); 5] = [
    (FormulaSignal::SpeedRatio, 1.0, [-1, 1]),
    (FormulaSignal::Start, 0.0, [1, 0]),
    (FormulaSignal::PrimeYawRate, 1.0, [0, 1]),
    (FormulaSignal::LateralDistance, 1.0, [-1, 1]),
    (FormulaSignal::LateralDistance, 0.0, [0, 0]),
];

/// Values of the record constants: approach speed, m/s; first time, s; ship length, m; speed in the rate of the lateral
/// distance if no speed is measured, m/s; and 1 if this speed always applies, else 0.
pub(super) type RecordConstants = [f64; RECORD_CONSTANTS.len()];

impl FormulaSignal {
    /// Names of all signals.
    pub const NAMES: [(&'static str, Self); 16] = [
        ("r", Self::YawRate),
        ("delta", Self::Rudder),
        ("psi", Self::Heading),
        ("y", Self::LateralDistance),
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
        ("K_over_T", Self::KOverT),
    ];

    /// Measured channels that the signal requires.
    pub(super) fn channels(self) -> &'static [RegressorChannel] {
        match self {
            Self::Sway => &[RegressorChannel::Sway],
            Self::Surge | Self::PrimeSway => &[RegressorChannel::Sway, RegressorChannel::Speed],
            Self::Speed | Self::PrimeYawRate => &[RegressorChannel::Speed],
            Self::Propeller => &[RegressorChannel::Propeller],
            Self::WindSpeed | Self::WindAngle => &[RegressorChannel::Wind],
            _ => &[],
        }
    }

    /// Value at an operating point with its channels; `z` are the states of the formula.
    #[inline(always)]
    pub(super) fn at<R: Real>(
        self,
        now: &OperatingPoint<R>,
        z: &[R],
        &[approach_speed, start, length, ..]: &RecordConstants,
    ) -> R {
        let MeasuredChannels { speed, sway, wind_speed, wind_from, propeller_rate: propeller } = *now.measured;
        let value = |channel: Option<f64>| channel.unwrap_or(f64::NAN);
        let constant = |channel: Option<f64>| R::from(value(channel));
        match self {
            Self::YawRate => now.yaw_rate,
            Self::Rudder => now.rudder,
            Self::Heading => now.heading,
            Self::LateralDistance => z[0],
            Self::Sway => constant(sway),
            Self::Surge => R::from((value(speed).powi(2) - value(sway).powi(2)).max(0.0).sqrt()),
            Self::Speed => constant(speed),
            Self::Propeller => constant(propeller),
            Self::Time => R::from(now.t),
            Self::WindSpeed => constant(wind_speed),
            Self::WindAngle => constant(wind_from),
            Self::PrimeYawRate => now.yaw_rate * (length / value(speed)),
            Self::PrimeSway => R::from(value(sway) / value(speed)),
            Self::SpeedRatio => R::from(speed.map_or(1.0, |speed| speed / approach_speed)),
            Self::Start => R::from(start),
            Self::KOverT => now.K_over_T,
        }
    }
}

/// Function of one argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FormulaFunction {
    /// Magnitude.
    Abs,
    /// Sign: −1, 0 or 1.
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
    /// Step: 1 above zero, else 0.
    Step,
}

impl FormulaFunction {
    /// Names of all functions of one argument.
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
    fn apply<R: Real>(self, x: R) -> R {
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

/// Operator or function of two arguments.
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
    /// Minimum.
    Min,
    /// Maximum.
    Max,
    /// `step(x, width)`, smooth step of this width: (1 + tanh(x/width))/2.
    SmoothStep,
}

impl FormulaOperator {
    /// Names of the functions of two arguments.
    pub const NAMES: [(&'static str, Self); 4] =
        [("min", Self::Min), ("max", Self::Max), ("pow", Self::Power), ("step", Self::SmoothStep)];

    #[inline(always)]
    fn apply<R: Real>(self, x: R, y: R) -> R {
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

/// Operand: a value that needs no evaluation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Operand {
    /// Number.
    Number(f64),
    /// Fitted constant, by its index.
    Constant(usize),
    /// Signal, by its index.
    Signal(usize),
}

/// Instruction of a program; the last value is kept outside the stack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Instruction {
    /// Pushes the last value on the stack and loads an operand as the last value.
    Take(Operand),
    /// Negates the last value.
    Negate,
    /// Raises the last value to an integer power.
    WholePower(i32),
    /// Applies a function to the last value.
    Call(FormulaFunction),
    /// Applies an operator to the top of the stack and the last value.
    Operate(FormulaOperator),
    /// Applies an operator to the last value and an operand: combines `Take` and `Operate`.
    With(FormulaOperator, Operand),
}

/// Compiled formula.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FormulaProgram {
    pub(super) instructions: Vec<Instruction>,
    /// Constants in the order of their first use, which is the order of their values.
    pub(super) constants: Vec<String>,
    /// Signals in the order of their first use.
    pub(super) signals: Vec<FormulaSignal>,
    /// Maximum number of values on the stack.
    pub(super) max_stack: usize,
}

impl FormulaProgram {
    /// Measured channels that its signals require, the sway first.
    pub(super) fn channels(&self) -> Vec<RegressorChannel> {
        let all =
            [RegressorChannel::Sway, RegressorChannel::Speed, RegressorChannel::Wind, RegressorChannel::Propeller];
        all.into_iter().filter(|c| self.signals.iter().any(|signal| signal.channels().contains(c))).collect()
    }

    /// Value at these constants; `signal` returns the value of a signal.
    #[inline]
    pub(super) fn value<R: Real>(&self, constants: &[R], signal: impl Fn(FormulaSignal) -> R) -> R {
        match (self.signals.len(), self.max_stack) {
            (0..=2, 0..=1) => self.run::<R, 2, 1>(constants, signal),
            (0..=SMALL_STACK, 0..=SMALL_STACK) => self.run::<R, SMALL_STACK, SMALL_STACK>(constants, signal),
            _ => self.run::<R, STACK_SIZE, STACK_SIZE>(constants, signal),
        }
    }

    #[inline]
    fn run<R: Real, const SIGNALS: usize, const WAITING: usize>(
        &self,
        constants: &[R],
        signal: impl Fn(FormulaSignal) -> R,
    ) -> R {
        let mut signals = [R::from(0.0); SIGNALS];
        for (value, kind) in signals.iter_mut().zip(&self.signals) {
            *value = signal(*kind);
        }
        let value = |operand: Operand| match operand {
            Operand::Number(number) => R::from(number),
            Operand::Constant(place) => constants[place],
            Operand::Signal(place) => signals[place],
        };
        let Some((&Instruction::Take(first), tail)) = self.instructions.split_first() else { return R::from(0.0) };
        let mut last = value(first);
        let (mut waiting, mut count) = ([R::from(0.0); WAITING], 0);
        for step in tail {
            match *step {
                // Products are the most frequent instructions.
                Instruction::With(FormulaOperator::Multiply, Operand::Signal(place)) => last = last * signals[place],
                Instruction::With(FormulaOperator::Multiply, operand) => last = last * value(operand),
                Instruction::Take(operand) => {
                    waiting[count] = last;
                    count += 1;
                    last = value(operand);
                }
                Instruction::Negate => last = -last,
                Instruction::WholePower(power) => last = last.powi(power),
                Instruction::Call(function) => last = function.apply(last),
                Instruction::Operate(operator) => {
                    count -= 1;
                    last = operator.apply(waiting[count], last);
                }
                Instruction::With(operator, operand) => last = operator.apply(last, value(operand)),
            }
        }
        last
    }
}
