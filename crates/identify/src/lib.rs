//! Identification of the manoeuvrability indices K and T (and the rudder bias δ_r) from recorded trials.
//!
//! Every method is one file and one line in [`registry`], all behind one trait, [`Identifier`]: settings first, then
//! trials, then an [`Estimate`] or a typed [`IdentifyError`]. There is no path from here to the simulator: a method
//! sees a record and nothing else.
//!
//! | id | method |
//! |---|---|
//! | `fourier-published` | eight harmonics with a free fundamental, triples of instants (Ge, Hu, Yin and Sun) |
//! | `fourier-projected` | the mended form: rudder on the same basis, all samples |
//! | `characteristic-points` | extrema and zero crossings of the heading (Nomoto 1960) |
//! | `least-squares` | regression on differentiated heading or on the gyro |
//! | `integral-least-squares` | the equation of motion integrated twice |
//! | `output-error` | maximum likelihood by simulation with the recorded rudder, global in T |
//! | `srivc` | refined instrumental variables for continuous time (Young and Jakeman 1980) |

pub mod characteristic_points;
pub mod error;
pub mod estimate;
pub mod fourier;
pub mod fourier_projected;
pub mod fourier_published;
mod gaps;
pub mod integral_least_squares;
pub mod least_squares;
pub mod linear;
pub mod output_error;
mod profile;
pub mod registry;
pub mod replay;
pub mod robust;
pub mod samples;
pub mod savitzky_golay;
mod scan;
pub mod settings;
pub mod srivc;
#[cfg(test)]
mod testing;
mod track;

pub use error::IdentifyError;
pub use estimate::{Estimate, StopReason, Uncertainty};
pub use registry::IdentifierSettings;

use trial::Trial;

/// A method that identifies a first-order response from one or several trials of the same ship.
///
/// A value of this type is a method with its settings. It holds no data: calling it twice with the same trials gives
/// the same bits.
pub trait Identifier: Send + Sync {
    /// Identifier used in scenario files, tables and JSON.
    fn id(&self) -> &'static str;

    /// One line on what the method does, for lists.
    fn summary(&self) -> &'static str;

    /// Identifies K, T and δ_r, common to all trials; every trial keeps its own initial state.
    ///
    /// Fails with a typed reason when a record does not excite the ship, is too short for the method, or the
    /// equations are singular; never panics on a valid [`Trial`].
    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError>;

    /// The same method with another seed, for methods that draw at random; `None` for all others.
    ///
    /// A benchmark gives every trial a seed of its own, so that the spread over trials holds the method's own chance.
    fn with_seed(&self, _seed: u64) -> Option<Box<dyn Identifier>> {
        None
    }
}
