//! Bracketed root of a function, for events inside a step.

/// Root of `f` between `a` and `b`, at which the values `fa` and `fb` have different signs (or one is zero).
///
/// Hybrid of inverse quadratic interpolation and bisection; the bracket is never left. Stops when the bracket is
/// shorter than `tolerance` or f is zero, and returns the end with the smaller |f|.
///
/// Source: Chandrupatla (1997), Advances in Engineering Software 28:145-149.
pub(crate) fn bracketed_root(mut f: impl FnMut(f64) -> f64, a: (f64, f64), b: (f64, f64), tolerance: f64) -> f64 {
    // `a` is the newest point, `b` the opposite end of the bracket, `c` the discarded point.
    let ((mut a, mut fa), (mut b, mut fb)) = (a, b);
    let mut share = 0.5_f64;
    // Two passes at least halve the bracket; no finite bracket of f64 requires 200 passes.
    for _ in 0..200 {
        let (best, f_best) = if fa.abs() < fb.abs() { (a, fa) } else { (b, fb) };
        let reach = (0.5 * tolerance + 2.0 * f64::EPSILON * best.abs()) / (b - a).abs();
        if reach > 0.5 || f_best == 0.0 {
            return best;
        }
        let t = a + share.clamp(reach, 1.0 - reach) * (b - a);
        let ft = f(t);
        let (c, fc);
        if (ft > 0.0) == (fa > 0.0) {
            (c, fc) = (a, fa);
        } else {
            (c, fc) = (b, fb);
            (b, fb) = (a, fa);
        }
        (a, fa) = (t, ft);
        let xi = (a - b) / (c - b);
        let phi = (fa - fb) / (fc - fb);
        // Inverse quadratic interpolation only if it is monotone over the bracket.
        share = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        } else {
            0.5
        };
    }
    if fa.abs() < fb.abs() { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_roots_to_the_tolerance_in_few_evaluations() {
        type Case = (fn(f64) -> f64, f64, f64, f64);
        let cases: [Case; 4] = [
            (|x| x * x * x - 2.0, 0.0, 3.0, 2.0_f64.cbrt()),
            (|x| x.exp() - 10.0, 0.0, 60.0, 10.0_f64.ln()),
            (|x| x - 0.25, 0.0, 1.0, 0.25),
            (|x| (x - 0.7).signum(), 0.0, 1.0, 0.7),
        ];
        for (f, low, high, root) in cases {
            let mut evaluations = 0;
            let counted = |x| {
                evaluations += 1;
                f(x)
            };
            let located = bracketed_root(counted, (low, f(low)), (high, f(high)), 1e-13);
            assert!((located - root).abs() < 2e-13, "{located} {root}");
            assert!(evaluations < 60, "{evaluations}");
        }
    }

    #[test]
    fn a_root_at_an_end_is_found() {
        assert_eq!(bracketed_root(|x| x, (0.0, 0.0), (1.0, 1.0), 1e-13), 0.0);
        assert_eq!(bracketed_root(|x| x - 1.0, (0.0, -1.0), (1.0, 0.0), 1e-13), 1.0);
    }
}
