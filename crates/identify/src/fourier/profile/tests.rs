//! Comparison of the profile with the orthogonal decomposition.

use std::f64::consts::TAU;

use super::super::basis::Basis;
use super::*;
use approx::assert_relative_eq;

#[test]
fn agrees_with_the_orthogonal_decomposition() {
    agree((0..157).map(|i| 1.5 * i as f64 + (3.0 * i as f64).sin() / 3.0).collect());
    for rows in [156, 157] {
        agree((0..rows).map(|i| 1.5 * f64::from(i)).collect());
    }
}

fn agree(time: Vec<f64>) {
    let values: Vec<f64> = time.iter().map(|t| 5.0 + (0.05 * t).sin() + 0.2 * (0.31 * t).cos()).collect();
    let mut profile = Profile::new(&time, &values, 5);
    let curve = profile.scan(0.02, 0.003, 20);
    for (k, scanned) in curve.into_iter().enumerate() {
        let w = 0.02 + 0.003 * k as f64;
        let basis = Basis::new(&time, w, 5).expect("enough rows");
        let exact: f64 = basis.project(&values).residual.iter().map(|e| e * e).sum();
        assert_relative_eq!(scanned, exact, max_relative = 1e-8);
        assert_relative_eq!(profile.rss(w), exact, max_relative = 1e-8);
    }
}

/// Harmonics beyond the sampling nearly repeat lower ones, and a record that is mostly a gap hardly separates them.
#[test]
fn goes_on_where_columns_are_nearly_dependent() {
    let even: Vec<f64> = (0..41).map(f64::from).collect();
    let gap: Vec<f64> = (0..60).map(|i| f64::from(if i < 30 { i } else { i + 240 })).collect();
    for (time, w) in [(even, 1.00001 * TAU / 10.0), (gap, 0.02)] {
        let values: Vec<f64> = time.iter().map(|t| (0.11 * t).sin() + 0.1 * (0.9 * t).cos()).collect();
        let mut profile = Profile::new(&time, &values, 8);
        let basis = Basis::new(&time, w, 8).expect("enough rows");
        assert!(basis.condition() > 1e3, "condition {}", basis.condition());
        let exact: f64 = basis.project(&values).residual.iter().map(|e| e * e).sum();
        assert_relative_eq!(profile.rss(w), exact, max_relative = 1e-6);
        assert!(explained(&mut profile.gram, &mut profile.right).is_none());
    }
}

#[test]
fn goes_on_where_the_normal_equations_end() {
    for (rows, unevenness) in [(100, 0.0), (101, 0.0), (100, 0.2)] {
        let time: Vec<f64> = (0..rows).map(|i| i as f64 + unevenness * (i as f64).sin()).collect();
        let values: Vec<f64> = time.iter().map(|t| (0.11 * t).sin() + 0.1 * (0.9 * t).cos()).collect();
        let w = 0.025;
        let basis = Basis::new(&time, w, 8).expect("enough rows");
        assert!(basis.condition() > 1e7, "condition {}", basis.condition());
        let exact: f64 = basis.project(&values).residual.iter().map(|e| e * e).sum();
        assert_relative_eq!(Profile::new(&time, &values, 8).rss(w), exact, max_relative = 1e-5);
    }
}
