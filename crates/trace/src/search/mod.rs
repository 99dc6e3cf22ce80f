//! The search for what is missing: terms are added one at a time, needless ones dropped again, and what remains has to
//! explain the records better than the best random moment.
//!
//! First as if the noise were white (or white with waves): the candidate with the lowest BIC is added while it gains
//! more than the threshold. Then every term so found is confronted with the random moments of [`crate::noise`]: it
//! stays if its likelihood ratio against the model without it, each with the noise that suits it best, passes the
//! threshold. If a random moment is still needed, sets of effects that pay only together are judged by the
//! sensitivities of one fit, and terms are looked for once more under it.

mod asked;
mod evidence;
mod ledger;
mod models;
mod resampled;
mod rounds;
mod rule;
#[cfg(test)]
mod tests;
mod together;
mod trying;
mod weights;

pub use asked::NotFitted;
pub use evidence::{Evidence, Thresholds};
pub use ledger::{Ledger, Names, Noted};
pub use models::{Model, NAMELESS, Search, Tested};
pub use rule::{Rule, UnknownRule};
pub use trying::Tried;
pub use weights::{Weighted, Weights};
