//! Ship zig-zag trials: simulate them, identify the manoeuvrability indices K and T, trace what a first-order model
//! lacks, and benchmark the methods against each other.
//!
//! This is the one crate to depend on. It contains no code, but re-exports separate crates under short names.
//!
//! | to | use |
//! |---|---|
//! | describe a ship, its effects, a hull | [`ship`] |
//! | read a measured record, find its overshoots | [`trial`] |
//! | find manoeuvres in a long log | [`find`] |
//! | compute the track of a turn | [`simulate::motion`] |
//! | predict a manoeuvre that was not made, with intervals | [`predict`] |
//! | simulate a record | [`simulate`] |
//! | identify K, T and δ_r with intervals | [`identify`] |
//! | choose an estimate, or state why none can be used | [`identify::verdict`] |
//! | trace the effects that a first-order model lacks | [`trace`](mod@trace) |
//! | read the documents of a fit, trace or prediction | [`document`] |
//! | read a scenario file | [`scenario`] |
//! | run a scenario and summarise its rows | [`campaign`] |
//! | compare methods on published records | [`campaign::benchmark`] |
//!
//! ```
//! use kempf::prelude::*;
//!
//! let ship = SimulatedShip::from_first_order(FirstOrder::from_indices(0.1, 16.3, 0.0));
//! let zig_zag = Manoeuvre::zig_zag(from_deg(10.0), from_deg(10.0)).until_execute(5);
//! let mut simulation = Simulation::new(ship, zig_zag);
//! simulation.gear = SteeringGear::with_rate(from_deg(2.5));
//! simulation.sensors.heading_noise = from_deg(0.1);
//! let record = simulation.run(&StreamKey { seed: 1, cell: 0, replicate: 0 })?.trial;
//!
//! let method = output_error::Settings::default().build()?;
//! let estimate = method.identify(&[record])?;
//! let [low, high] = estimate.T().ci95.expect("output error has an interval");
//! assert!(low < high && (estimate.T().value - 16.3).abs() < 0.5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The examples of this package fit a CSV as `study fit` does, compare an estimate with the truth, trace a record, and
//! run a method of your own in a study.

pub use campaign::scenario;
pub use trial::find;
pub use {campaign, document, identify, predict, ship, simulate, trace, trial};

/// Names needed by most programs.
pub mod prelude {
    pub use campaign::collect::{collect, collect_in_memory};
    pub use campaign::folder::ResultFolder;
    pub use campaign::scenario::Scenario;
    pub use campaign::summary::summarise;
    pub use campaign::{NoObserver, Observer};
    pub use document::fit::{KtUsability, VerdictEntry};
    pub use document::{Warning, WarningSource, Warnings};
    pub use identify::method_entry::method_entry;
    pub use identify::{
        Estimate, Identifier, IdentifierSettings, IdentifyError, StopReason, Uncertainty, output_error, registry,
        verdict,
    };
    pub use ship::angle::{from_deg, to_deg};
    pub use ship::{FirstOrder, Particulars};
    pub use simulate::{Manoeuvre, SimulatedShip, Simulation, SteeringGear, StreamKey};
    pub use trial::{Channel, InstrumentLog, ReadRecord, Sidecar, Trial, ZigZag, read, write_csv};
}

/// Text of the README, whose example is compiled with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
