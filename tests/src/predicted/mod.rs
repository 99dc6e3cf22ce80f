//! Measured trials predicted from other trials of the same ship, to which alone she is fitted: every figure of every
//! trial beside its interval, and the page that is made of them.

pub mod charts;
pub mod figure;
pub mod forecast;
pub mod page;
pub mod turn;
