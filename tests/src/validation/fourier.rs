//! Fourier fit of the heading and its results, without noise, against an independent computation.

use identify::Identifier;
use identify::fourier::regression::RegressionForm;
use identify::fourier::{self, Fundamental};
use identify::fourier_projected::{Order, RudderTreatment, Settings};
use trial::Trial;

use super::{Check, Section, Tolerance};
use crate::records::{Begin, Case};

/// Number of harmonics in the paper.
const HARMONICS: usize = 8;

/// Fit: rudder, heading (deg), beginning, global or local search, w (rad/s), R².
type Fit = (f64, f64, Begin, bool, f64, f64);

const FITS: [Fit; 7] = [
    (10., 10., Begin::Mid, true, 0.02039, 0.99989),
    (10., 10., Begin::Mid, false, 0.05395, 0.99828),
    (10., 10., Begin::Rest, false, 0.05377, 0.99274),
    (10., 20., Begin::Mid, true, 0.01620, 0.99987),
    (10., 20., Begin::Mid, false, 0.03929, 0.99981),
    (10., 20., Begin::Rest, true, 0.01109, 0.99984),
    (20., 20., Begin::Mid, true, 0.01807, 0.99996),
];

/// Regression on all samples: rudder, heading (deg), rudder in the equations, K (1/s), T (s).
const REGRESSIONS: [(f64, f64, RudderTreatment, f64, f64); 4] = [
    (10., 20., RudderTreatment::Recorded, 0.0930, 15.15),
    (10., 20., RudderTreatment::Projected, 0.1001, 16.32),
    (10., 10., RudderTreatment::Recorded, 0.0935, 15.09),
    (10., 10., RudderTreatment::Projected, 0.1001, 16.36),
];

/// Tolerance of the fundamental of an independent search, rad/s, stated with the anchors.
const FUNDAMENTAL_TOLERANCE: f64 = 3e-4;

/// Tolerance of R², stated with the anchors.
const R_SQUARED_TOLERANCE: f64 = 2e-5;

fn record(rudder_deg: f64, heading_deg: f64, begin: Begin) -> Trial {
    Case { rudder_deg, heading_deg, begin, ..Case::default() }.trial(0)
}

/// Checks of fundamentals and R² of the free-w fit, and K and T by regression.
pub fn section() -> Section {
    let mut checks = Vec::new();
    for (rudder, heading, begin, global, w, r_squared) in FITS {
        let trial = record(rudder, heading, begin);
        let time: Vec<f64> = trial.time().iter().map(|t| t - trial.time()[0]).collect();
        let search = if global { Fundamental::Global } else { Fundamental::FftPeak };
        let curve = fourier::fit(&time, trial.heading(), HARMONICS, &search).expect("271 headings are enough").curve;
        let from = if begin == Begin::Mid { "mid-trial" } else { "from rest" };
        let way = if global { "lowest sum of squares" } else { "local search from the peak of the spectrum" };
        let mut push = |symbol: &str, published, ours, tolerance, unit| {
            checks.push(Check::new(
                format!("fourier/{rudder}-{heading}/{from}/{way}/{symbol}"),
                format!("{rudder}/{heading} {from}, {way}: {symbol}"),
                (published, 5),
                ours,
                Tolerance::Absolute(tolerance),
                unit,
            ));
        };
        push("fundamental w", w, curve.fundamental, FUNDAMENTAL_TOLERANCE, "rad/s");
        push("R²", r_squared, curve.r_squared, R_SQUARED_TOLERANCE, "");
    }
    for (rudder, heading, side, k, t) in REGRESSIONS {
        let settings = Settings {
            fundamental: Fundamental::Global,
            harmonics: Order::Fixed(HARMONICS),
            rudder: side,
            response: RegressionForm::YawRate,
        };
        let method = settings.build().expect("valid settings");
        let found = method.identify(&[record(rudder, heading, Begin::Mid)]).expect("a zig-zag is identified").response;
        let name =
            if side == RudderTreatment::Recorded { "recorded rudder" } else { "rudder projected on the same basis" };
        for (symbol, published, decimals, ours, unit) in [("K", k, 4, found.K(), "1/s"), ("T", t, 2, found.T(), "s")] {
            checks.push(Check::new(
                format!("fourier/{rudder}-{heading}/{name}/{symbol}"),
                format!("{rudder}/{heading} mid-trial, all samples, {name}: {symbol}"),
                (published, decimals),
                ours,
                Tolerance::Relative(0.01),
                unit,
            ));
        }
    }
    Section {
        title: "Fourier fit of the heading",
        method: "Eight harmonics with a free fundamental w on 271 noise-free headings at 1 s of K = 0.1 1/s, T = 16.3 s, rudder at \
            2.5 deg/s; mid-trial begins 1.2 s after the second execute. K and T by least squares on all samples of the central \
            90 %. Tolerances are those stated with the anchors: 0.0003 rad/s, 2e-5 in R², 1 % in K and T. K and T of the \
            published method are far from the truth where the rudder is as recorded: that is a property of the method, and ours \
            has to share it.",
        checks,
    }
}
