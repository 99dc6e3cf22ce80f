//! The ships of the project, each in a file of its own with the source of every number.
//!
//! A ship is a set of particulars and one model: a response model with its parameters, or a hull with three degrees
//! of freedom. Only parameter sets whose source was seen are here.

use std::sync::Arc;

use crate::dynamics::Dynamics;
use crate::first_order::FirstOrder;
use crate::response::Response;

/// Length and speed, the two numbers every nondimensional index needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particulars {
    /// Length between perpendiculars L, m.
    pub length: f64,
    /// Approach speed V, m/s.
    pub speed: f64,
}

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
    pub id: &'static str,
    /// Name and condition, for people.
    pub name: &'static str,
    /// Author and year of the numbers.
    pub source: &'static str,
    /// Length and approach speed, where they are known.
    pub particulars: Option<Particulars>,
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
