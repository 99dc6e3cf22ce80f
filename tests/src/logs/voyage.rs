//! Zig-zag of all logs, on a grid of a tenth of a second, and the stamps of its instants. Every log has its own
//! selection and format.

use std::sync::LazyLock;

use rand::{SeedableRng, rngs::ChaCha8Rng};
use rand_distr::{Distribution, StandardNormal};

/// K of the ship, 1/s.
pub const K: f64 = 0.06;

/// T of the ship, s.
pub const T: f64 = 25.0;

/// Number of rows per second.
pub const TENTHS: usize = 10;

/// Length of the log, tenths of a second.
pub const LENGTH: usize = 400 * TENTHS;

/// Angles of rudder and heading at an execute, deg.
const ANGLE: f64 = 10.0;

/// Rate of the rudder, deg/s: it starts and stops at full seconds, so that straight lines between these are exact.
const RUDDER_RATE: f64 = 2.5;

/// Time of the first execute, s.
const FIRST: usize = 30;

/// Course of the approach, deg: the heading crosses north.
const COURSE: f64 = 355.0;

/// Standard deviation of the compass noise, deg.
const NOISE: f64 = 0.1;

/// Beginning of the log, seconds of the day: 14:03:05.
pub const BEGIN: f64 = 50_585.0;

/// Beginning of the log on 2026-11-20, UTC (day 20777), in seconds from 1970-01-01.
pub const EPOCH: u64 = 20_777 * 86_400 + 50_585;

/// Readings of the instruments, one row every tenth of a second.
pub struct Voyage {
    /// Heading of the compass, deg, continuous.
    heading: Vec<f64>,
    /// Rudder angle, deg, positive to starboard.
    rudder: Vec<f64>,
    /// Rate of turn, deg/s.
    rate: Vec<f64>,
}

static VOYAGE: LazyLock<Voyage> = LazyLock::new(Voyage::steered);

/// Voyage of all logs, computed once.
pub fn voyage() -> &'static Voyage {
    &VOYAGE
}

impl Voyage {
    /// Simulated zig-zag, starboard first; the helmsman reads the compass once a second.
    fn steered() -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(1957);
        let (mut psi, mut r, mut delta, mut order) = (0.0, 0.0, 0.0, 0.0);
        let mut own = Self { heading: Vec::new(), rudder: Vec::new(), rate: Vec::new() };
        let step = 1.0 / TENTHS as f64;
        for tenth in 0..=LENGTH {
            let draw: f64 = StandardNormal.sample(&mut generator);
            let read = psi + NOISE * draw;
            own.heading.push(COURSE + read);
            own.rudder.push(delta);
            own.rate.push(r);
            if tenth == FIRST * TENTHS {
                order = ANGLE;
            } else if tenth % TENTHS == 0 && read * order > 0.0 && read.abs() >= ANGLE {
                order = -order;
            }
            let next = delta + f64::clamp(order - delta, -RUDDER_RATE * step, RUDDER_RATE * step);
            // T r' + r = K δ, solved for a rudder that is linear in time within the step.
            let slope = (next - delta) / step;
            let steady = K * (delta - slope * T);
            let (free, decay) = (r - steady, (-step / T).exp());
            psi += steady * step + 0.5 * K * slope * step * step + free * T * (1.0 - decay);
            r = steady + K * slope * step + free * decay;
            delta = next;
        }
        own
    }

    /// Heading, deg, in [0, 360).
    pub fn heading(&self, tenth: usize) -> f64 {
        self.heading[tenth].rem_euclid(360.0)
    }

    /// Rudder angle, deg.
    pub fn rudder(&self, tenth: usize) -> f64 {
        self.rudder[tenth]
    }

    /// Rate of turn, deg/s.
    pub fn rate(&self, tenth: usize) -> f64 {
        self.rate[tenth]
    }

    /// Time of execute `n` (from 0), tenths of a second: the rudder begins to move.
    ///
    /// # Panics
    /// If there are fewer executes: a programming error of the test.
    pub fn execute(&self, n: usize) -> usize {
        let moves = |tenth: &usize| self.rudder[*tenth] == self.rudder[tenth - 1];
        let begins = (1..LENGTH).filter(|tenth| moves(tenth) && self.rudder[*tenth] != self.rudder[tenth + 1]);
        begins.into_iter().nth(n).expect("the zig-zag has the executes that are asked for")
    }
}

/// Times of rows that are `step` tenths apart, tenths of a second.
pub fn every(step: usize) -> impl Iterator<Item = usize> + Clone {
    (0..=LENGTH).step_by(step)
}

/// Time in seconds, from tenths of a second.
pub fn seconds(tenth: usize) -> f64 {
    tenth as f64 / TENTHS as f64
}

/// Hour, minute, second and tenth of the clock.
fn clock(tenth: usize) -> [usize; 4] {
    let second = BEGIN as usize + tenth / TENTHS;
    [second / 3600, second / 60 % 60, second % 60, tenth % TENTHS]
}

/// Time of day as `14:03:05`, with one decimal if requested.
pub fn time_of_day(tenth: usize, decimal: bool) -> String {
    let [hour, minute, second, rest] = clock(tenth);
    let fraction = if decimal { format!(".{rest}") } else { String::new() };
    format!("{hour:02}:{minute:02}:{second:02}{fraction}")
}

/// Time of day as `2:03:05 PM`.
pub fn time_of_half_day(tenth: usize, decimal: bool) -> String {
    let [hour, minute, second, rest] = clock(tenth);
    let fraction = if decimal { format!(".{rest}") } else { String::new() };
    format!("{}:{minute:02}:{second:02}{fraction} {}", (hour + 11) % 12 + 1, if hour < 12 { "AM" } else { "PM" })
}
