//! What is steered: a ship seen from the simulator, which only asks whether its motion has a closed form.

use std::sync::Arc;

use ship::narrow_band::NarrowBand;
use ship::ships::Model;
use ship::{Dynamics, FirstOrder, Particulars, Response, Ship};

/// How the motion is computed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Solver {
    /// The closed form where it is exact (a first-order ship whose input is piecewise linear in time), else Runge–Kutta
    /// with the largest step the ship allows.
    #[default]
    Automatic,
    /// Runge–Kutta of order four whatever the ship, with steps no longer than this, s.
    RungeKutta(f64),
}

/// A ship ready to be simulated: its equations, its closed form where it has one, and the waves it sees by itself.
#[derive(Clone)]
pub struct Vessel {
    dynamics: Arc<dyn Dynamics>,
    first_order: Option<FirstOrder>,
    random_headings: Vec<NarrowBand>,
    particulars: Option<Particulars>,
}

impl std::fmt::Debug for Vessel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Vessel")
            .field("states", &self.dynamics.dimension())
            .field("first_order", &self.first_order)
            .field("random_headings", &self.random_headings)
            .field("particulars", &self.particulars)
            .finish()
    }
}

impl Vessel {
    /// A response model; without effects it has a closed form.
    pub fn response(response: Response) -> Self {
        let first_order = response.model().effects().is_empty().then(|| response.first_order());
        let random_headings = response.random_headings().collect();
        Self { dynamics: Arc::new(response), first_order, random_headings, particulars: None }
    }

    /// A purely first-order ship.
    pub fn first_order(ship: FirstOrder) -> Self {
        Self::response(Response::first_order_ship(ship))
    }

    /// Any other system of equations.
    pub fn hull(dynamics: Arc<dyn Dynamics>) -> Self {
        Self { dynamics, first_order: None, random_headings: Vec::new(), particulars: None }
    }

    /// A ship of the registry, with its particulars.
    pub fn ship(ship: &Ship) -> Self {
        let vessel = match &ship.model {
            Model::Response(response) => Self::response(response.clone()),
            Model::Hull(hull) => Self::hull(Arc::clone(hull)),
        };
        Self { particulars: ship.particulars, ..vessel }
    }

    /// The same vessel with equations that hold more than its own.
    pub fn with_dynamics(self, dynamics: Arc<dyn Dynamics>) -> Self {
        Self { dynamics, first_order: None, ..self }
    }

    /// The same vessel with length and approach speed declared.
    pub fn with_particulars(self, particulars: Particulars) -> Self {
        Self { particulars: Some(particulars), ..self }
    }

    /// The equations.
    pub fn dynamics(&self) -> &dyn Dynamics {
        self.dynamics.as_ref()
    }

    /// K, T and δ_r, where the ship is exactly first order.
    pub fn closed_form(&self) -> Option<FirstOrder> {
        self.first_order
    }

    /// Spectra of the random headings that belong to the ship's own equations.
    pub fn random_headings(&self) -> &[NarrowBand] {
        &self.random_headings
    }

    /// Length and approach speed, where they are known.
    pub fn particulars(&self) -> Option<Particulars> {
        self.particulars
    }
}
