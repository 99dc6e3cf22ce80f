//! A formula as a program: names, numbers, operators and functions in the order in which they are worked out. Made from
//! text by the parser, evaluated in plain numbers and in numbers that carry derivatives.

use estimation::number::Real;

use crate::effects::effect::Now;

/// Most values that wait for an operator at once.
pub(super) const STACK: usize = 16;

/// A signal that a formula may name. Units and signs are those of NOTATION.md.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FormulaSignal {
    /// `r`, yaw rate, rad/s.
    YawRate,
    /// `delta`, rudder that acts, rad.
    Rudder,
    /// `psi`, heading, rad.
    Heading,
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
}

impl FormulaSignal {
    /// Every signal with its name.
    pub const NAMES: [(&'static str, Self); 12] = [
        ("r", Self::YawRate),
        ("delta", Self::Rudder),
        ("psi", Self::Heading),
        ("v", Self::Sway),
        ("u", Self::Surge),
        ("U", Self::Speed),
        ("n", Self::Propeller),
        ("t", Self::Time),
        ("wind_speed", Self::WindSpeed),
        ("wind_angle", Self::WindAngle),
        ("rp", Self::PrimeYawRate),
        ("vp", Self::PrimeSway),
    ];

    /// Its value at an instant; `None` where the record has no such channel. `length` is that of the ship, m.
    pub(super) fn at<R: Real>(self, now: &Now<R>, length: f64) -> Option<R> {
        let measured = now.measured;
        Some(match self {
            Self::YawRate => now.yaw_rate,
            Self::Rudder => now.rudder,
            Self::Heading => now.heading,
            Self::Sway => R::from(measured.sway?),
            Self::Surge => R::from((measured.speed?.powi(2) - measured.sway?.powi(2)).max(0.0).sqrt()),
            Self::Speed => R::from(measured.speed?),
            Self::Propeller => R::from(measured.propeller?),
            Self::Time => R::from(now.t),
            Self::WindSpeed => R::from(measured.wind_speed?),
            Self::WindAngle => R::from(measured.wind_from?),
            Self::PrimeYawRate => now.yaw_rate * (length / measured.speed?),
            Self::PrimeSway => R::from(measured.sway? / measured.speed?),
        })
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

/// One step of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Instruction {
    /// A number.
    Number(f64),
    /// A constant that is fitted, by its place.
    Constant(usize),
    /// A signal.
    Signal(FormulaSignal),
    /// Minus.
    Negate,
    /// A whole power.
    WholePower(i32),
    /// A function of the last value.
    Call(FormulaFunction),
    /// An operator between the last two values.
    Operate(FormulaOperator),
}

/// A formula ready to be evaluated.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FormulaProgram {
    pub(super) instructions: Vec<Instruction>,
    /// The constants in the order of their first use.
    pub(super) constants: Vec<String>,
}

impl FormulaProgram {
    /// Names of the constants, in the order in which their values travel.
    pub fn constants(&self) -> &[String] {
        &self.constants
    }

    /// The signals it names, each once.
    pub fn signals(&self) -> Vec<FormulaSignal> {
        let named = self.instructions.iter().filter_map(|step| match step {
            Instruction::Signal(signal) => Some(*signal),
            _ => None,
        });
        let mut signals: Vec<FormulaSignal> = named.collect();
        signals.sort_unstable();
        signals.dedup();
        signals
    }

    /// Its value with these constants; `signal` gives the signals. `None` where one is missing.
    #[inline]
    pub(super) fn value<R: Real>(&self, constants: &[R], signal: impl Fn(FormulaSignal) -> Option<R>) -> Option<R> {
        let mut stack = [R::from(0.0); STACK];
        let mut top = 0;
        for step in &self.instructions {
            match *step {
                Instruction::Number(number) => {
                    stack[top] = R::from(number);
                    top += 1;
                }
                Instruction::Constant(place) => {
                    stack[top] = constants[place];
                    top += 1;
                }
                Instruction::Signal(own) => {
                    stack[top] = signal(own)?;
                    top += 1;
                }
                Instruction::Negate => stack[top - 1] = -stack[top - 1],
                Instruction::WholePower(power) => stack[top - 1] = stack[top - 1].powi(power),
                Instruction::Call(function) => stack[top - 1] = function.of(stack[top - 1]),
                Instruction::Operate(operator) => {
                    top -= 1;
                    stack[top - 1] = operator.of(stack[top - 1], stack[top]);
                }
            }
        }
        Some(stack[0])
    }
}
