//! Parser of formulas: recursive descent over sums, products, signs, powers and atoms.
//!
//! Source: Aho, Lam, Sethi and Ullman (2006), Compilers, second edition, section 4.4.

use super::program::{
    FormulaFunction, FormulaOperator, FormulaProgram, FormulaSignal, Instruction, Operand, STACK_SIZE,
};

/// Maximum number of characters in a formula.
pub(super) const MAX_FORMULA_CHARS: usize = 400;
/// Maximum nesting depth of brackets, signs and powers.
const MAX_DEPTH: usize = 24;
/// Maximum number of fitted constants.
const MAX_CONSTANTS: usize = 4;

/// Error of a formula, with its position in the text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{problem}\n{}", marked(text, *position))]
pub struct FormulaError {
    /// Text of the formula.
    pub text: String,
    /// Position: number of characters before it.
    pub position: usize,
    /// Problem at the position, with the expected input.
    pub problem: String,
}

/// Text around a position, with a mark under it.
fn marked(text: &str, at: usize) -> String {
    let left_out = at.saturating_sub(MAX_FORMULA_CHARS);
    let near: String = text.chars().skip(left_out).take(2 * MAX_FORMULA_CHARS).collect();
    format!("  {near}\n  {}^", " ".repeat(at - left_out))
}

/// Program of a formula. For a moment (equivalent rudder angle) it is the yaw acceleration, K/T times the moment.
///
/// Fails for a syntax error, nesting that is too deep, or too many constants.
pub fn parse(text: &str, is_moment: bool) -> Result<FormulaProgram, FormulaError> {
    FormulaParser::new(text, false).program(is_moment)
}

/// Program of a formula whose names are columns, which become constants. Fails if [`parse`] fails.
pub(super) fn parse_columns(text: &str) -> Result<FormulaProgram, FormulaError> {
    FormulaParser::new(text, true).program(false)
}

struct FormulaParser {
    letters: Vec<char>,
    at: usize,
    depth: usize,
    /// Number of intermediate values on the stack.
    waiting: usize,
    /// `true` if every name is a column.
    of_columns: bool,
    program: FormulaProgram,
}

impl FormulaParser {
    fn new(text: &str, of_columns: bool) -> Self {
        let (letters, program) = (text.chars().collect(), FormulaProgram::default());
        Self { letters, at: 0, depth: 0, waiting: 0, of_columns, program }
    }

    fn program(mut self, is_moment: bool) -> Result<FormulaProgram, FormulaError> {
        if let Some(at) = self.letters.iter().position(|letter| letter.is_control()) {
            return Err(self.error(at, "a control character"));
        }
        if is_moment {
            self.signal(FormulaSignal::KOverT)?;
        }
        self.sum()?;
        match self.peek() {
            None => {
                if is_moment {
                    self.push(Instruction::Operate(FormulaOperator::Multiply))?;
                }
                Ok(self.program)
            }
            Some(')') => Err(self.error(self.at, "a closing bracket without an opening one")),
            Some(letter) => Err(self.error(self.at, format!("`{letter}`, expected an operator or the end"))),
        }
    }

    fn error(&self, at: usize, problem: impl Into<String>) -> FormulaError {
        FormulaError { text: self.letters.iter().collect(), position: at, problem: problem.into() }
    }

    /// Next character that is not white space; `None` at the end.
    fn peek(&mut self) -> Option<char> {
        while self.letters.get(self.at).is_some_and(|letter| letter.is_whitespace()) {
            self.at += 1;
        }
        self.letters.get(self.at).copied()
    }

    /// Next character, which is consumed, if it is one of `any`; else `None`.
    fn take(&mut self, any: &[char]) -> Option<char> {
        let taken = self.peek().filter(|letter| any.contains(letter));
        self.at += usize::from(taken.is_some());
        taken
    }

    fn push(&mut self, step: Instruction) -> Result<(), FormulaError> {
        if let (Instruction::Operate(operator), Some(&Instruction::Take(operand))) =
            (step, self.program.instructions.last())
        {
            self.waiting -= 1;
            self.program.instructions.pop();
            self.program.instructions.push(Instruction::With(operator, operand));
            return Ok(());
        }
        self.program.max_stack = self.program.max_stack.max(self.waiting.saturating_sub(1));
        match step {
            Instruction::Take(_) => self.waiting += 1,
            Instruction::Operate(_) => self.waiting -= 1,
            _ => {}
        }
        if self.waiting > STACK_SIZE {
            let problem = format!("more than {STACK_SIZE} intermediate values; use fewer brackets");
            return Err(self.error(self.at, problem));
        }
        self.program.instructions.push(step);
        Ok(())
    }

    /// Parses `part` one nesting level deeper. Fails if the nesting is too deep.
    fn deeper(&mut self, part: fn(&mut Self) -> Result<(), FormulaError>) -> Result<(), FormulaError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(self.error(self.at, format!("more than {MAX_DEPTH} levels of brackets, signs and powers")));
        }
        part(self)?;
        self.depth -= 1;
        Ok(())
    }

    /// Parses a chain of parts joined by operators of equal precedence, evaluated from left to right.
    fn chain(
        &mut self,
        operators: &[(char, FormulaOperator)],
        part: fn(&mut Self) -> Result<(), FormulaError>,
    ) -> Result<(), FormulaError> {
        part(self)?;
        while let Some(sign) = self.peek()
            && let Some((_, operator)) = operators.iter().find(|(symbol, _)| *symbol == sign)
        {
            self.at += 1;
            part(self)?;
            self.push(Instruction::Operate(*operator))?;
        }
        Ok(())
    }

    fn sum(&mut self) -> Result<(), FormulaError> {
        use FormulaOperator::{Add, Subtract};
        self.chain(&[('+', Add), ('-', Subtract), ('−', Subtract)], Self::product)
    }

    fn product(&mut self) -> Result<(), FormulaError> {
        use FormulaOperator::{Divide, Multiply};
        self.chain(&[('*', Multiply), ('·', Multiply), ('/', Divide)], |parser| parser.deeper(Self::signed))
    }

    /// Sign before a power: −x² is −(x²).
    fn signed(&mut self) -> Result<(), FormulaError> {
        match self.take(&['+', '-', '−']) {
            None => self.power(),
            Some('+') => self.deeper(Self::signed),
            Some(_) => {
                self.deeper(Self::signed)?;
                self.push(Instruction::Negate)
            }
        }
    }

    fn power(&mut self) -> Result<(), FormulaError> {
        self.atom()?;
        if self.take(&['^']).is_some() {
            let from = self.program.instructions.len();
            self.deeper(Self::signed)?;
            return self.raise(from);
        }
        Ok(())
    }

    /// Adds a power whose exponent starts at instruction `from`; an integer exponent up to ±20 allows negative bases.
    fn raise(&mut self, from: usize) -> Result<(), FormulaError> {
        let exponent = match self.program.instructions[from..] {
            [Instruction::Take(Operand::Number(number))] => Some(number),
            [Instruction::Take(Operand::Number(number)), Instruction::Negate] => Some(-number),
            _ => None,
        };
        match exponent.filter(|number| number.fract() == 0.0 && number.abs() <= 20.0) {
            Some(whole) => {
                self.program.instructions.truncate(from);
                self.waiting -= 1;
                self.push(Instruction::WholePower(whole as i32))
            }
            None => self.push(Instruction::Operate(FormulaOperator::Power)),
        }
    }

    fn atom(&mut self) -> Result<(), FormulaError> {
        match self.peek() {
            Some('(') => {
                let open = self.at;
                self.at += 1;
                self.deeper(Self::sum)?;
                self.close(open)
            }
            Some(letter) if letter.is_ascii_digit() || letter == '.' => self.number(),
            Some(letter) if letter.is_alphabetic() || letter == '_' => self.name(),
            Some(letter) => Err(self.error(self.at, format!("`{letter}`, expected a number, a name or a bracket"))),
            None => Err(self.error(self.at, "the formula ends here, expected a number, a name or a bracket")),
        }
    }

    fn close(&mut self, open: usize) -> Result<(), FormulaError> {
        match self.take(&[')']) {
            Some(_) => Ok(()),
            None if self.peek().is_none() => Err(self.error(open, "an opening bracket without a closing one")),
            None => Err(self.error(self.at, "expected `)` or an operator")),
        }
    }

    fn number(&mut self) -> Result<(), FormulaError> {
        let from = self.at;
        let letter = |at: usize| self.letters.get(at).copied().unwrap_or(' ');
        let after_digits = |from: usize| (from..).find(|at| !matches!(letter(*at), '0'..='9' | '.')).unwrap_or(from);
        let mut end = after_digits(from);
        let power = end + 1 + usize::from(matches!(letter(end + 1), '+' | '-'));
        if matches!(letter(end), 'e' | 'E') && letter(power).is_ascii_digit() {
            end = after_digits(power);
        }
        let text: String = self.letters[from..end].iter().collect();
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        let number = number.ok_or_else(|| self.error(from, format!("`{text}` is not a number")))?;
        self.at = end;
        self.push(Instruction::Take(Operand::Number(number)))
    }

    fn name(&mut self) -> Result<(), FormulaError> {
        let from = self.at;
        let is_of_name = |letter: &&char| letter.is_alphanumeric() || **letter == '_';
        let name: String = self.letters[from..].iter().take_while(is_of_name).collect();
        self.at += name.chars().count();
        if self.peek() == Some('(') {
            return self.call(&name, from);
        }
        if self.of_columns {
            return self.constant(name, from);
        }
        if let Some((_, signal)) = FormulaSignal::NAMES.iter().find(|(symbol, _)| *symbol == name) {
            return self.signal(*signal);
        }
        if name == "pi" {
            return self.push(Instruction::Take(Operand::Number(std::f64::consts::PI)));
        }
        if let Some(signal) = misspelt(&name) {
            return Err(self.error(from, format!("`{name}` is not a signal; did you mean `{signal}`?")));
        }
        if !name.is_ascii() {
            return Err(self.error(from, format!("`{name}`: expected letters without accents, digits and _")));
        }
        if FormulaFunction::NAMES.iter().any(|(symbol, _)| *symbol == name) {
            return Err(self.error(self.at, format!("expected `(` after the function `{name}`")));
        }
        self.constant(name, from)
    }

    fn constant(&mut self, name: String, from: usize) -> Result<(), FormulaError> {
        let constants = &mut self.program.constants;
        let place = constants.iter().position(|constant| *constant == name).unwrap_or(constants.len());
        if place == MAX_CONSTANTS {
            let what = if self.of_columns { "columns" } else { "constants" };
            return Err(self.error(from, format!("`{name}` is too many: at most {MAX_CONSTANTS} {what} are possible")));
        }
        if place == constants.len() {
            constants.push(name);
        }
        self.push(Instruction::Take(Operand::Constant(place)))
    }

    fn signal(&mut self, signal: FormulaSignal) -> Result<(), FormulaError> {
        let signals = &mut self.program.signals;
        let place = signals.iter().position(|used| *used == signal).unwrap_or(signals.len());
        if place == signals.len() {
            signals.push(signal);
        }
        self.push(Instruction::Take(Operand::Signal(place)))
    }

    fn call(&mut self, name: &str, from: usize) -> Result<(), FormulaError> {
        let unary = FormulaFunction::NAMES.iter().find(|(symbol, _)| *symbol == name);
        let binary = FormulaOperator::NAMES.iter().find(|(symbol, _)| *symbol == name);
        if unary.is_none() && binary.is_none() {
            let names: Vec<&str> =
                FormulaFunction::NAMES.iter().map(|(name, _)| *name).chain(["min", "max", "pow"]).collect();
            return Err(self.error(from, format!("`{name}` is not a function; use one of {}", names.join(", "))));
        }
        let open = self.at;
        self.at += 1;
        self.deeper(Self::sum)?;
        let separator = self.take(&[',', ';']);
        match (unary, binary, separator) {
            (_, Some((_, operator)), Some(_)) => {
                let second = self.program.instructions.len();
                self.deeper(Self::sum)?;
                self.close(open)?;
                if *operator == FormulaOperator::Power {
                    self.raise(second)
                } else {
                    self.push(Instruction::Operate(*operator))
                }
            }
            (Some((_, function)), _, None) => {
                self.close(open)?;
                self.push(Instruction::Call(*function))
            }
            (None, ..) => Err(self.error(self.at, format!("`{name}` takes two values, as in `{name}(r, 0)`"))),
            (Some(_), None, Some(_)) => Err(self.error(self.at - 1, format!("`{name}` takes one value"))),
        }
    }
}

/// Signal meant by another or a misspelt name; `None` if no signal is similar.
fn misspelt(name: &str) -> Option<&'static str> {
    const SPELLINGS: [(&str, &[&str]); 9] = [
        ("delta", &["δ", "rudder", "rudder_angle"]),
        ("psi", &["ψ", "heading"]),
        ("y", &["Y", "lateral", "lateral_way", "cross_track"]),
        ("r", &["R", "yaw_rate", "yawrate"]),
        ("v", &["V", "sway", "sway_velocity"]),
        ("U", &["speed", "Speed"]),
        ("n", &["rpm", "rps", "propeller"]),
        ("wind_speed", &["windspeed", "Vw", "U_wind"]),
        ("wind_angle", &["winddir", "wind_direction", "wind_from", "windangle"]),
    ];
    let is_near = |signal: &str| signal.len() > 2 && strsim::damerau_levenshtein(signal, name) == 1;
    let spelt = SPELLINGS.iter().find(|(signal, spellings)| spellings.contains(&name) || is_near(signal));
    spelt.map(|(signal, _)| *signal)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        let signal = |signal: FormulaSignal| match signal {
            FormulaSignal::YawRate => -0.5,
            FormulaSignal::Rudder => 2.0,
            FormulaSignal::Sway => -3.0,
            _ => 1.5,
        };
        parse(text, false).unwrap_or_else(|error| panic!("{error}")).value(&[2.0, 3.0, 5.0, 7.0], signal)
    }

    #[test]
    fn formulas_are_worked_out_as_they_are_written() {
        for (text, expected) in [
            ("1 + 2 * 3", 7.0),
            ("8 / 4 / 2", 1.0),
            ("2 - 3 - 4", -5.0),
            ("-r^2", -0.25),
            ("2^-1", 0.5),
            ("2^3^2", 512.0),
            ("(r)^3", -0.125),
            ("c * r * abs(v)", -3.0),
            ("a*r + b*delta", 5.0),
            ("max(r, 0) + min(r, 0)", -0.5),
            ("pow(delta, 1.5)", 2f64.powf(1.5)),
            ("pow(r, 3)", -0.125),
            ("step(delta) + step(r)", 1.0),
            ("step(delta, 2)", 0.5 * (1.0 + 1f64.tanh())),
            ("sign(v) * sqrt(4) * exp(0) + log(1)", -2.0),
            ("sin(0) + cos(0) + tan(0) + tanh(0)", 1.0),
            (".5e1 · 2 − pi", 10.0 - std::f64::consts::PI),
            ("- - 2", 2.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-12, "{text}: {} is not {expected}", value(text));
        }
        assert_eq!(parse("k*tanh(c*psi)*k", false).expect("a formula").constants, ["k", "c"]);
    }

    #[test]
    fn what_is_no_formula_is_marked() {
        for (text, at, message) in [
            ("", 0, "ends here"),
            ("c * ", 4, "ends here"),
            ("c * r r", 6, "`r`, expected an operator"),
            ("c * (r + 1", 4, "without a closing one"),
            ("c * r)", 5, "without an opening one"),
            ("c * dleta", 4, "did you mean `delta`"),
            ("c * rudder", 4, "did you mean `delta`"),
            ("c * windspeed", 4, "did you mean `wind_speed`"),
            ("c * foo(r)", 4, "`foo` is not a function; use one of abs"),
            ("c * max(r)", 9, "takes two values"),
            ("c * abs(r, 1)", 9, "takes one value"),
            ("c * abs", 7, "expected `(`"),
            ("c $ r", 2, "`$`, expected an operator"),
            ("1.2.3 * c", 0, "is not a number"),
            ("a*b*c*d*e*r", 8, "at most 4 constants"),
            ("c*é", 2, "without accents"),
        ] {
            let error = parse(text, false).expect_err(text);
            assert!(error.position == at && error.problem.contains(message), "{text}: {error:?}");
        }
        let marked = parse("c * dleta", false).expect_err("misspelt").to_string();
        assert!(marked.ends_with("\n  c * dleta\n      ^"), "{marked}");
    }

    #[test]
    fn depth_is_bounded() {
        for text in
            ["(".repeat(300), "-".repeat(300), "2^".repeat(150), "r+(".repeat(100), "c*".repeat(300), "a\u{0}".into()]
        {
            assert!(parse(&text, false).is_err(), "{text}");
        }
    }
}
