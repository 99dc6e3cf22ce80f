//! Interface of the identification methods.

use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::Estimate;

/// Method that identifies a first-order response from one or several trials of one ship.
///
/// A value of this type is a method with its settings. It holds no data: two calls with equal trials give equal bits.
///
/// ```
/// # let mut table = String::from("t_s,heading_deg,rudder_deg\n");
/// # let (mut psi, mut r, mut delta) = (0.0_f64, 0.0_f64, 10.0_f64);
/// # for t in 0..300 {
/// #     table += &format!("{t},{psi},{delta}\n");
/// #     for _ in 0..100 {
/// #         r += 0.01 * (0.1 * delta - r) / 16.0;
/// #         psi += 0.01 * r;
/// #     }
/// #     delta = if psi * delta.signum() > 10.0 { -delta } else { delta };
/// # }
/// # let read = trial::reader::read_from_reader("run.csv".as_ref(), table.as_bytes(), None, None)?;
/// // A zig-zag of a ship with K = 0.1 1/s and T = 16 s, read from a table.
/// let record = read.trial;
/// for settings in kempf_identify::registry::default_settings() {
///     let method = settings.build()?;
///     match method.identify(std::slice::from_ref(&record)) {
///         Ok(estimate) => println!("{}: K = {:.3} 1/s", method.id(), estimate.K().value),
///         Err(error) => println!("{}: {error}", method.id()),
///     }
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Identifier: Send + Sync {
    /// Name of the method in scenario files, tables and JSON.
    fn id(&self) -> &'static str;

    /// Summary of the method in one line, for lists.
    fn summary(&self) -> &'static str;

    /// Identifies K, T and δ_r, common to all trials; every trial has a separate initial state.
    ///
    /// Fails with a typed reason if a record does not excite the ship, is too short for the method, or the equations
    /// are singular; never panics on a valid [`Trial`].
    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError>;

    /// Method with another seed, for methods with random samples; `None` for deterministic methods.
    ///
    /// A benchmark gives every trial another seed, so that the spread over trials includes the randomness of the
    /// method.
    fn with_seed(&self, _seed: u64) -> Option<Box<dyn Identifier>> {
        None
    }
}
