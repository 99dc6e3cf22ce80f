//! Identification of the manoeuvrability indices K and T (and the rudder bias δ_r) from recorded trials.
//!
//! Every method is one module and one line in [`registry`], all behind one trait, [`Identifier`]: settings first, then
//! trials, then an [`Estimate`] or a typed [`IdentifyError`]. There is no dependency on the simulator: a method has
//! only the record.
//!
//! | id | method |
//! |---|---|
//! | `fourier-published` | eight harmonics with a free fundamental, triples of instants (Ge, Hu, Yin and Sun) |
//! | `fourier-projected` | the corrected form: rudder on the same basis, all samples |
//! | `characteristic-points` | extrema and zero crossings of the heading (Nomoto 1960) |
//! | `least-squares` | regression on differentiated heading or on the yaw rate of a rate gyro |
//! | `integral-least-squares` | the equation of motion integrated twice |
//! | `output-error` | maximum likelihood by simulation with the recorded rudder, global in T |
//! | `maximum-likelihood` | maximum likelihood under a random yaw moment, rudder error and coloured compass error |
//! | `srivc` | refined instrumental variables for continuous time (Young and Jakeman 1980) |
//! | `recommended` | output error or maximum likelihood, selected by a rule on the record |
//!
//! Among several estimates, [`verdict`] selects the recommended estimate, or rejects all.
#![expect(non_snake_case, reason = "K and T are the symbols of the field")]

pub mod characteristic_points;
pub mod error;
pub mod estimate;
pub mod fourier;
pub mod fourier_projected;
pub mod fourier_published;
mod gaps;
pub mod hull;
pub mod identifier;
pub mod integral_least_squares;
pub mod lack_of_fit;
pub mod least_squares;
pub mod likelihood;
pub mod maximum_likelihood;
pub mod method_entry;
pub mod output_error;
mod outside_fit;
pub mod plausibility;
mod profile;
pub mod recommended;
pub mod registry;
pub mod replay;
mod robust;
mod samples;
pub mod savitzky_golay;
mod scan;
pub mod settings;
pub mod srivc;
#[cfg(test)]
mod testing;
pub mod verdict;

pub use error::IdentifyError;
pub use estimate::{Estimate, StopReason, Uncertainty};
pub use identifier::Identifier;
pub use outside_fit::{OutsideErrors, OutsideFit};
pub use registry::IdentifierSettings;
