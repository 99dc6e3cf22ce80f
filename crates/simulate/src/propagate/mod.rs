//! Moving the ship through time: the interface that both ways share, and the search for a heading inside a step.
//!
//! A propagator offers steps that are smooth: none crosses a corner of the rudder or of the weather, so an event is
//! located by shortening the one step in which it lies. It knows nothing of helms and records.

mod closed_form;
pub(crate) mod exposed;
mod integrated;
mod propagator;

pub(crate) use closed_form::ClosedForm;
pub(crate) use exposed::ShipInWeather;
pub(crate) use integrated::Integrated;
pub(crate) use propagator::{AwaitedHeading, Limits, Propagator, has_diverged};
