//! Bias of the characteristic-point method, without noise, against an independent computation.

use identify::Identifier;
use identify::characteristic_points::Settings;

use super::{Check, Section, Tolerance};
use crate::records::Case;

/// Half width of the local fits (s), K (1/s), T (s).
const TABLE: [(f64, f64, f64); 5] =
    [(2., 0.1002, 16.33), (3., 0.1004, 16.36), (4., 0.1007, 16.41), (6., 0.1015, 16.54), (8., 0.1026, 16.72)];

/// Checks of K and T for five half widths.
pub fn section() -> Section {
    let trial = Case::default().trial(0);
    let mut checks = Vec::new();
    for (half_width, k, t) in TABLE {
        let settings = Settings { half_width_s: Some(half_width), ..Settings::default() };
        let method = settings.build().expect("valid settings");
        let found = method.identify(std::slice::from_ref(&trial)).expect("a zig-zag has its points").response;
        // Two units of the last digit.
        for (symbol, published, decimals, ours, tolerance, unit) in
            [("K", k, 4, found.K(), 2e-4, "1/s"), ("T", t, 2, found.T(), 0.03, "s")]
        {
            checks.push(Check::new(
                format!("characteristic-points/{half_width}/{symbol}"),
                format!("10/10 from rest, half width {half_width} s: {symbol}"),
                (published, decimals),
                ours,
                Tolerance::Absolute(tolerance),
                unit,
            ));
        }
    }
    Section {
        title: "Characteristic points",
        method: "K = 0.1 1/s, T = 16.3 s, 10/10 at 2.5 deg/s from rest, 271 noise-free headings at 1 s. The peaks of a zig-zag are no \
            parabolas, so the answer is biased by the half width of the local fits. Tolerance two units of the last digit (T: \
            three), because our window moves to its own vertex and that of the independent program does not.",
        checks,
    }
}
