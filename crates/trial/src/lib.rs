//! One manoeuvring trial as a time series, simulated or measured: the only thing an identification method sees.
//!
//! | to learn about | read |
//! |---|---|
//! | the record itself | [`record`] |
//! | names of columns and their units | [`channel`] |
//! | reading CSV and other tables | [`reader`] and [`sidecar`] |
//! | what is checked before a record is believed | [`plausibility`] |
//! | zig-zag characteristics (ITTC) | [`zigzag`] |
//! | IMO criteria | [`imo`] |

pub mod channel;
pub mod record;

pub use channel::Channel;
pub use record::{Columns, Noise, Origin, Trial, TrialError};
