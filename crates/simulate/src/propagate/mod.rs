//! Propagation of the ship in time: closed form and integration with one interface, and the location of events in a
//! step.
//!
//! The steps of a propagator are smooth: none crosses a corner of the rudder or of the weather, so an event is located
//! by shortening the step that contains it. A propagator is independent of helm and record.

mod closed_form;
mod integrated;
mod propagator;
pub(crate) mod ship_in_weather;

pub(crate) use closed_form::ClosedForm;
pub(crate) use integrated::Integrated;
pub(crate) use propagator::{AwaitedHeading, Propagator, RowLimits, has_diverged};
pub(crate) use ship_in_weather::ShipInWeather;
