//! The numerics of estimation, each once. Nothing here knows of ships or records.
//!
//! | for | read |
//! |---|---|
//! | sums over columns of numbers, with the same bits on every machine | [`mod@column`], [`lanes`] |
//! | the Fourier transform | [`transform`] |
//! | the Kalman filter with its smoother | [`kalman`] |
//! | exact steps of such systems in time, and sample paths | [`stochastic`] |
//! | numbers that carry their derivatives | [`number`] |
//! | linear least squares with covariance and condition number | [`least_squares`] |
//! | nonlinear least squares between bounds | [`levenberg_marquardt`] |
//! | the lowest point of a function of one number | [`minimum`](fn@minimum::minimum) |
//! | covariances of scores that are correlated in time | [`covariance`] |
//! | medians and quantiles | [`statistics`] |
//! | mixtures of normal laws, and ratios over them | [`mixture`] |
//! | the evidence of every subset of some terms | [`subsets`] |
//! | whether a residual is white, and its spectrum | [`residuals`] |

pub mod column;
pub mod covariance;
pub mod kalman;
pub mod lanes;
pub mod least_squares;
pub mod levenberg_marquardt;
pub mod minimum;
pub mod mixture;
pub mod number;
pub mod residuals;
pub mod statistics;
pub mod stochastic;
pub mod subsets;
pub mod transform;
