//! Replay as NumPy arrays, for figures.

use identify::replay::Replay;
use numpy::PyArray1;
use pyo3::prelude::*;
use ship::angle::to_deg;

/// Time (s), heading (deg) and heading residual (deg) of a replay.
pub type ReplayArrays<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// Arrays of a replay, with angles in degrees.
pub fn replay_arrays<'py>(py: Python<'py>, replay: &Replay) -> ReplayArrays<'py> {
    let degrees = |angles: &[f64]| PyArray1::from_vec(py, angles.iter().map(|&angle| to_deg(angle)).collect());
    (PyArray1::from_slice(py, &replay.time), degrees(&replay.heading), degrees(&replay.residual))
}
