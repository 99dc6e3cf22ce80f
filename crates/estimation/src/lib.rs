//! The numerics of estimation, each once. Nothing here knows of ships or records.
//!
//! | for | read |
//! |---|---|
//! | sums over columns of numbers, with the same bits on every machine | [`column`], [`lanes`] |
//! | the Fourier transform | [`transform`] |
//! | the Kalman filter with its smoother and its derivatives | [`kalman`] |
//! | numbers that carry their derivatives | [`number`] |
//! | covariances of scores that are correlated in time | [`covariance`] |
//! | medians and quantiles | [`statistics`] |

pub mod column;
pub mod covariance;
pub mod kalman;
pub mod lanes;
pub mod number;
pub mod statistics;
pub mod transform;
