//! Ships of the project, one file per source of their numbers.
//!
//! A ship is a set of particulars and one model: a response model with its parameters, or a hull with three degrees of
//! freedom. Only parameter sets whose source was seen are included. [`user`] makes ships from the numbers of a user.
//!
//! To add a ship, add a file with a function that returns the [`Ship`], and one line in [`all_ships`].

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

/// Equations of a ship.
#[derive(Clone)]
pub enum ShipModel {
    /// Response model with its parameters.
    Response(Response),
    /// Hull with three degrees of freedom.
    Hull(Arc<dyn Dynamics>),
}

/// Ship of the registry: name, source, particulars and equations.
#[derive(Clone)]
pub struct Ship {
    /// Identifier used in scenario files.
    pub id: Cow<'static, str>,
    /// Name and condition, for display.
    pub name: Cow<'static, str>,
    /// Author and year of the numbers.
    pub source: Cow<'static, str>,
    /// Length and approach speed; `None` if they are unknown.
    pub particulars: Option<Particulars>,
    /// Rudder rate of the steering gear, rad/s; `None` if the source gives none.
    pub rudder_rate: Option<f64>,
    /// Maximum rudder angle to either side, rad; `None` if the source gives none.
    pub largest_rudder: Option<f64>,
    /// Equations.
    pub model: ShipModel,
}

impl Ship {
    /// Equations as a system that can be simulated.
    pub fn dynamics(&self) -> Arc<dyn Dynamics> {
        match &self.model {
            ShipModel::Response(response) => Arc::new(response.clone()),
            ShipModel::Hull(hull) => Arc::clone(hull),
        }
    }

    /// True K, T and δ_r; `None` unless the ship is exactly first order.
    pub fn first_order(&self) -> Option<FirstOrder> {
        match &self.model {
            ShipModel::Response(response) if response.model().effects().is_empty() => Some(response.first_order()),
            _ => None,
        }
    }
}

/// All ships of the project, in the order of reports: response models first.
pub fn all_ships() -> Vec<Ship> {
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

/// Ship with this identifier; `None` for an unknown identifier.
pub fn find_ship(id: &str) -> Option<Ship> {
    all_ships().into_iter().find(|ship| ship.id == id)
}

#[cfg(test)]
mod tests;
