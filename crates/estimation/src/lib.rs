//! Numerical methods of estimation, independent of ships and records.
//!
//! | for | read |
//! |---|---|
//! | sums over columns of numbers, with the same bits on every machine | [`mod@column`], [`rows`], [`lanes`] |
//! | the discrete Fourier transform | [`transform`] |
//! | the Kalman filter with its smoother | [`kalman`] |
//! | exact discretisation of linear stochastic systems, and sample paths | [`stochastic`] |
//! | dual numbers, which carry derivatives | [`number`] |
//! | linear least squares with covariance and condition number | [`least_squares`] |
//! | nonlinear least squares between bounds | [`levenberg_marquardt`] |
//! | the minimum of a function of one variable | [`minimum`](minimum::golden_section_minimum) |
//! | covariances of scores that are correlated in time | [`covariance`] |
//! | medians, quantiles and intervals of proportions | [`statistics`] |
//! | mixtures of normal distributions, and ratios over them | [`mixture`] |
//! | the evidence of every subset of terms | [`subsets`] |
//! | whiteness and spectrum of a residual | [`residuals`] |
//! | work space without page faults | [`memory`](memory::keep_freed_memory) |

pub mod column;
pub mod covariance;
pub mod kalman;
pub mod lanes;
pub mod least_squares;
pub mod levenberg_marquardt;
pub mod memory;
pub mod minimum;
pub mod mixture;
pub mod number;
pub mod residuals;
pub mod rows;
pub mod statistics;
pub mod stochastic;
pub mod subsets;
pub mod transform;
