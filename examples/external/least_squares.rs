//! Least squares as an estimator outside a study: one record a line comes in, one answer a line goes out.
//!
//! `T r' + r = K (delta + delta_r)` integrated twice leaves no derivative:
//! `psi = -1/T int(psi) + K/T iint(delta) + K delta_r/T t^2/2 + c1 t + c0`.
//! White noise `n` of the heading leaves `n + int(n)/T`: a second fit makes it white again with the `T` of the first,
//! so that its standard deviations hold. The yaw rate and further records are left aside.

use std::io::{self, BufRead, Write};

use serde_json::{Value, json};

/// What the heading is a sum of.
const TERMS: usize = 5;

/// The coefficients of a linear fit and how they vary together.
struct Fit {
    coefficients: [f64; TERMS],
    covariance: [[f64; TERMS]; TERMS],
}

/// The integral from the first row on, by trapezoids.
fn integral(t: &[f64], y: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let areas = t.windows(2).zip(y.windows(2)).map(|(t, y)| {
        sum += (t[1] - t[0]) * (y[1] + y[0]) / 2.0;
        sum
    });
    std::iter::once(0.0).chain(areas).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Fits the last column by those before it: modified Gram-Schmidt on columns of length one.
fn fit(mut columns: [Vec<f64>; TERMS + 1]) -> Option<Fit> {
    let rows = columns[0].len();
    let lengths = columns.each_ref().map(|column| dot(column, column).sqrt());
    for (column, length) in columns.iter_mut().zip(lengths) {
        column.iter_mut().for_each(|value| *value /= length);
    }
    // Upper triangular; its last column is what the fitted one has along each direction.
    let mut r = [[0.0; TERMS + 1]; TERMS];
    for i in 0..TERMS {
        let (done, rest) = columns.split_at_mut(i + 1);
        let direction = &mut done[i];
        let left = dot(direction, direction).sqrt();
        // What is left is next to nothing where a column is a sum of those before it; it is not a number where one is.
        if left.is_nan() || left < 1e-11 {
            return None;
        }
        direction.iter_mut().for_each(|value| *value /= left);
        r[i][i] = left;
        for (j, column) in rest.iter_mut().enumerate() {
            let along = dot(direction, column);
            column.iter_mut().zip(direction.iter()).for_each(|(value, unit)| *value -= along * unit);
            r[i][i + 1 + j] = along;
        }
    }
    // The columns of its inverse.
    let inverse: [[f64; TERMS]; TERMS] = std::array::from_fn(|j| {
        let mut column = [0.0; TERMS];
        for i in (0..=j).rev() {
            let known: f64 = (i + 1..=j).map(|k| r[i][k] * column[k]).sum();
            column[i] = (if i == j { 1.0 } else { 0.0 } - known) / r[i][i];
        }
        column
    });
    let scale: [f64; TERMS] = std::array::from_fn(|i| lengths[TERMS] / lengths[i]);
    let variance = dot(&columns[TERMS], &columns[TERMS]) / (rows - TERMS) as f64;
    Some(Fit {
        coefficients: std::array::from_fn(|i| scale[i] * (0..TERMS).map(|k| inverse[k][i] * r[k][TERMS]).sum::<f64>()),
        covariance: std::array::from_fn(|i| {
            let with = |j: usize| inverse.iter().map(|column| column[i] * column[j]).sum::<f64>();
            std::array::from_fn(|j| scale[i] * scale[j] * variance * with(j))
        }),
    })
}

/// The numbers of one signal; `None` where a row is missing.
fn signal(record: &Value, key: &str) -> Result<Vec<Option<f64>>, String> {
    let list = record[key].as_array().ok_or_else(|| format!("no list `{key}`"))?;
    Ok(list.iter().map(Value::as_f64).collect())
}

fn estimate(record: &Value) -> Result<Value, String> {
    let (t, psi, delta) = (signal(record, "t_s")?, signal(record, "heading_rad")?, signal(record, "rudder_rad")?);
    if t.len() != psi.len() || t.len() != delta.len() {
        return Err("lists of different lengths".into());
    }
    let whole = t.iter().zip(&psi).zip(&delta).filter_map(|((t, psi), delta)| Some(((*t)?, ((*psi)?, (*delta)?))));
    let (mut t, (psi, delta)): (Vec<_>, (Vec<_>, Vec<_>)) = whole.unzip();
    let moved = delta.iter().copied().fold(f64::MIN, f64::max) - delta.iter().copied().fold(f64::MAX, f64::min);
    if t.len() < 2 * TERMS || moved < 1e-4 {
        return Err("too few rows, or the rudder does not move".into());
    }
    let start = t[0];
    t.iter_mut().for_each(|t| *t -= start);

    let columns = [
        integral(&t, &psi),
        integral(&t, &integral(&t, &delta)),
        t.iter().map(|t| t * t / 2.0).collect(),
        t.clone(),
        vec![1.0; t.len()],
        psi,
    ];
    let vague = || String::from("the record does not determine K and T");
    let rate = fit(columns.clone()).ok_or_else(vague)?.coefficients[0]; // -1/T
    let columns = columns.map(|column| {
        let weighted: Vec<f64> = t.iter().zip(&column).map(|(t, value)| (-rate * t).exp() * value).collect();
        let past = integral(&t, &weighted);
        t.iter().zip(column).zip(past).map(|((t, value), past)| value + rate * (rate * t).exp() * past).collect()
    });
    let Fit { coefficients: [a, b, c, ..], covariance } = fit(columns).ok_or_else(vague)?;

    let slope = [[b / (a * a), -1.0 / a, 0.0], [1.0 / (a * a), 0.0, 0.0], [0.0, -c / (b * b), 1.0 / b]];
    let sd = slope.map(|row| {
        let variance: f64 = (0..3).flat_map(|i| (0..3).map(move |j| row[i] * row[j] * covariance[i][j])).sum();
        variance.sqrt()
    });
    if ![b / a, 1.0 / a, c / b, sd[0], sd[1], sd[2]].iter().all(|value| value.is_finite()) {
        return Err(vague());
    }
    Ok(json!({
        "trial": record["trial"],
        "K_per_s": -b / a,
        "T_s": -1.0 / a,
        "delta_r_rad": c / b,
        "sd": { "K_per_s": sd[0], "T_s": sd[1], "delta_r_rad": sd[2] },
    }))
}

fn main() -> io::Result<()> {
    let mut out = io::stdout().lock();
    for line in io::stdin().lock().lines() {
        let record: Value = serde_json::from_str(&line?)?;
        let answer = estimate(&record).unwrap_or_else(|why| json!({ "trial": record["trial"], "failed": why }));
        writeln!(out, "{answer}")?;
        out.flush()?;
    }
    Ok(())
}
