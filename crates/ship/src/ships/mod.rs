//! The ships of the project, each in a file of its own with the source of every number.
//!
//! A ship is a set of particulars and one model: a response model with its parameters, or a hull with three degrees
//! of freedom. Only parameter sets whose source was seen are here. [`user`] makes ships from a user's own numbers.
//!
//! To add one: a file here with a function that returns the [`Ship`], and one line in [`all`].

use std::borrow::Cow;
use std::sync::Arc;

use crate::angle::KNOT;
use crate::dynamics::Dynamics;
use crate::first_order::FirstOrder;
use crate::particulars::Particulars;
use crate::response::Response;

pub mod amerongen;
pub mod kvlcc2;
pub mod mariner;
pub mod s175;
pub mod seiun_like;
pub mod tanker;
pub mod user;
pub mod yukun;

/// The equations of a ship.
#[derive(Clone)]
pub enum Model {
    /// A response model with its parameters.
    Response(Response),
    /// A hull with its own equations.
    Hull(Arc<dyn Dynamics>),
}

/// A ship: what it is called, where its numbers come from, and how it moves.
#[derive(Clone)]
pub struct Ship {
    /// Identifier used in scenario files.
    pub id: Cow<'static, str>,
    /// Name and condition, for people.
    pub name: Cow<'static, str>,
    /// Author and year of the numbers.
    pub source: Cow<'static, str>,
    /// Length and approach speed, where they are known.
    pub particulars: Option<Particulars>,
    /// Rudder rate of the steering gear, rad/s, where the source gives one.
    pub rudder_rate: Option<f64>,
    /// Largest rudder angle to either side, rad, where the source gives one.
    pub largest_rudder: Option<f64>,
    /// The equations.
    pub model: Model,
}

impl Ship {
    /// The equations as a system that can be simulated.
    pub fn dynamics(&self) -> Arc<dyn Dynamics> {
        match &self.model {
            Model::Response(response) => Arc::new(response.clone()),
            Model::Hull(hull) => Arc::clone(hull),
        }
    }

    /// The true K, T and δ_r, where the ship is exactly first order.
    pub fn first_order(&self) -> Option<FirstOrder> {
        match &self.model {
            Model::Response(response) if response.model().effects().is_empty() => Some(response.first_order()),
            _ => None,
        }
    }
}

/// Every ship of the project, in the order of reports: response models first.
pub fn all() -> Vec<Ship> {
    vec![
        yukun::ship(),
        mariner::second_order(),
        amerongen::zeefakkel(),
        amerongen::frigate(),
        mariner::hull(),
        kvlcc2::full_scale(),
        kvlcc2::model_l7(),
        tanker::ship(),
        s175::ship(),
        seiun_like::ship(),
    ]
}

/// The ship with this identifier.
pub fn find(id: &str) -> Option<Ship> {
    all().into_iter().find(|ship| ship.id == id)
}

#[cfg(test)]
mod tests;
