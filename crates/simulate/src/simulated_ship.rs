//! Ship for the simulator, with its equations and its closed form, if any.

use std::sync::Arc;

use ship::narrow_band::NarrowBandProcess;
use ship::ships::ShipModel;
use ship::{Dynamics, FirstOrder, Particulars, Response, Ship};

/// Method of integration.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Solver {
    /// Closed form if it is exact (a first-order ship with an input that is piecewise linear in time), else Runge–Kutta
    /// with the maximum step of the ship.
    #[default]
    Automatic,
    /// Runge–Kutta of order four, with steps up to this length, s.
    RungeKutta(f64),
}

/// Ship for simulation: equations, closed form, if any, and random headings of its response.
#[derive(Clone)]
pub struct SimulatedShip {
    dynamics: Arc<dyn Dynamics>,
    first_order: Option<FirstOrder>,
    random_headings: Vec<NarrowBandProcess>,
    particulars: Option<Particulars>,
}

impl std::fmt::Debug for SimulatedShip {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SimulatedShip")
            .field("states", &self.dynamics.dimension())
            .field("first_order", &self.first_order)
            .field("random_headings", &self.random_headings)
            .field("particulars", &self.particulars)
            .finish()
    }
}

impl SimulatedShip {
    /// Ship of a response model; without effects it has a closed form.
    pub fn from_response(response: Response) -> Self {
        let first_order = response.model().effects().is_empty().then(|| response.first_order());
        let random_headings = response.random_headings().collect();
        Self { dynamics: Arc::new(response), first_order, random_headings, particulars: None }
    }

    /// Ship of a first-order response.
    pub fn from_first_order(ship: FirstOrder) -> Self {
        Self::from_response(Response::first_order_ship(ship))
    }

    /// Ship of any system of equations.
    pub fn from_dynamics(dynamics: Arc<dyn Dynamics>) -> Self {
        Self { dynamics, first_order: None, random_headings: Vec::new(), particulars: None }
    }

    /// Simulated ship from a ship of the registry, with its particulars.
    pub fn from_ship(ship: &Ship) -> Self {
        let simulated = match &ship.model {
            ShipModel::Response(response) => Self::from_response(response.clone()),
            ShipModel::Hull(hull) => Self::from_dynamics(Arc::clone(hull)),
        };
        Self { particulars: ship.particulars, ..simulated }
    }

    /// Ship with other equations, without a closed form.
    pub fn with_dynamics(self, dynamics: Arc<dyn Dynamics>) -> Self {
        Self { dynamics, first_order: None, ..self }
    }

    /// Ship with declared length and approach speed.
    pub fn with_particulars(self, particulars: Particulars) -> Self {
        Self { particulars: Some(particulars), ..self }
    }

    /// Equations.
    pub fn dynamics(&self) -> &dyn Dynamics {
        self.dynamics.as_ref()
    }

    /// First-order ship with a closed form; `None` for other equations.
    pub fn closed_form(&self) -> Option<FirstOrder> {
        self.first_order
    }

    /// Random headings of the response model, as narrow-band processes.
    pub fn random_headings(&self) -> &[NarrowBandProcess] {
        &self.random_headings
    }

    /// Length and approach speed; `None` if unknown.
    pub fn particulars(&self) -> Option<Particulars> {
        self.particulars
    }
}
