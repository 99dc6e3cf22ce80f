//! Simulation of a measured zig-zag by a helm that reverses the rudder at the recorded headings, because a replayed
//! rudder does not follow the heading; and the characteristics of the record for comparison.

use ship::Particulars;
use ship::angle::to_deg;
use simulate::Manoeuvre;
use trial::{Quantity, Trial, ZigZag as Measured};

use crate::figures::{self, Characteristics, EXECUTE_TIME_NAMES, OVERSHOOT_NAMES};
use crate::mixture::{ShipMixture, UncertaintySource};
use crate::prediction::parallel_draws;
use crate::simulated_manoeuvre::SimulatedManoeuvre;
use crate::standard::{self, ZIG_ZAG_EXECUTES};

/// Relative tolerance between a mean angle of a zig-zag and the nominal angle.
const TOLERANCE: f64 = 0.05;

/// Result of one drawn ship.
pub(crate) struct SampleResult {
    /// Characteristics; their names are the same for every draw.
    pub figures: Characteristics,
    /// Maximum |yaw rate|, rad/s.
    pub max_yaw_rate: f64,
}

/// Manoeuvre, initial yaw rate and rudder rate of a measured zig-zag, with which drawn ships are steered.
pub(crate) struct SteeredZigZag {
    pub manoeuvre: Manoeuvre,
    /// Change of heading that ends the initial turning, rad: the nominal change, also if the helm is late.
    turned: f64,
    /// Number of executes of the record, which determine its period.
    executes: usize,
    /// Yaw rate at the first execute, rad/s.
    yaw_rate: f64,
    /// Rudder rate, rad/s; `None` if the record does not show it.
    rudder_rate: Option<f64>,
}

impl SteeredZigZag {
    /// Zig-zag of a record; `approach_yaw_rate` is the root mean square of the yaw rate at the end of a straight
    /// approach of the ship, rad/s. `None` if the record begins within the trial, or has a single execute.
    pub fn from_measured(measured: &Measured, approach_yaw_rate: f64) -> Option<Self> {
        let side = measured.first_side?;
        let executes = &measured.executes;
        if executes.len() < 2 {
            return None;
        }
        let base = measured.base_course.heading.value;
        let mean = |values: Vec<f64>| values.iter().sum::<f64>() / values.len() as f64;
        let rudder = mean(executes.iter().map(|execute| execute.rudder_after.abs()).collect());
        let heading = mean(executes[1..].iter().map(|execute| (execute.heading.value - base).abs()).collect());
        // Angles near the nominal pair are set to it.
        let [rudder, heading] = match measured.nominal_angles {
            Some(pair) => [(rudder, pair.rudder), (heading, pair.heading)]
                .map(|(mean, nominal)| if (mean - nominal).abs() < TOLERANCE * nominal { nominal } else { mean }),
            None => [rudder, heading],
        };
        let yaw_rate = match measured.straight_yaw_rate() {
            // A slope from few headings is shrunk towards zero by its error.
            Some(rate) => {
                let variance = approach_yaw_rate.powi(2) + rate.sd.unwrap_or(0.0).powi(2);
                if variance > 0.0 { rate.value * approach_yaw_rate.powi(2) / variance } else { 0.0 }
            }
            None => executes[0].yaw_rate.map_or(0.0, |rate| rate.value),
        };
        let kind = Manoeuvre::zig_zag(rudder, heading).with_first_side(side);
        let turned = measured.nominal_angles.map_or(heading, |pair| pair.heading);
        Some(Self { manoeuvre: kind, turned, executes: executes.len(), yaw_rate, rudder_rate: measured.rudder_rate })
    }

    /// Results of drawn ships, in the order of their numbers; `None` for a ship that does not complete the manoeuvre.
    pub fn draws(&self, mixture: &ShipMixture, draws: usize) -> Vec<Option<SampleResult>> {
        let manoeuvre =
            standard::with_predicted_end(&self.manoeuvre, mixture.timescale()).expect("a zig-zag is steered");
        // The record gives the yaw rate of the approach.
        let is_drawn = |source: &UncertaintySource| *source != UncertaintySource::InitialState;
        let sources: Vec<UncertaintySource> = UncertaintySource::ALL.into_iter().filter(is_drawn).collect();
        parallel_draws(draws, |number| {
            let mut ship = mixture.draw_ship(number, &sources);
            ship.initial_yaw_rate += self.yaw_rate;
            ship.gear.rudder_rate = self.rudder_rate.or(ship.gear.rudder_rate);
            let passage = SimulatedManoeuvre::simulate(&ship, &manoeuvre, mixture.timescale()).ok()?;
            let mut figures = figures::characteristics(&self.manoeuvre, &passage, mixture.particulars());
            let turned = passage.time_of_heading_change(self.turned, self.manoeuvre.first_side().sign());
            let shown = passage.executes.get(..self.executes).unwrap_or(&passage.executes);
            figures.insert("period_s", figures::execute_period(shown));
            figures.extend(figures::initial_turning(&passage, turned, mixture.particulars()));
            Some(SampleResult { figures, max_yaw_rate: passage.max_yaw_rate() })
        })
    }
}

/// Characteristic of a measured zig-zag by name; angles in degrees, times in s from the first execute. `None` if the
/// record does not show it.
///
/// The distance of the initial turning uses the recorded speed; without it, V times the time if `particulars` are
/// given. `length` (m) stands in for an undeclared length of the ship.
pub(crate) fn measured_characteristic(
    trial: &Trial,
    measured: &Measured,
    name: &str,
    length: Option<f64>,
    particulars: Option<Particulars>,
) -> Option<Quantity> {
    let place = |names: &[&str]| names.iter().position(|figure| *figure == name).map(|place| place + 1);
    let begin = measured.executes.first()?.time;
    let since = |time: Quantity| {
        let sd = time.sd.zip(begin.sd).map(|(end, start)| end.hypot(start));
        Quantity::new(time.value - begin.value, sd)
    };
    match (place(&OVERSHOOT_NAMES), place(&EXECUTE_TIME_NAMES), name) {
        (Some(number), ..) => Some(measured.nth_overshoot(number)?.angle.scaled(to_deg(1.0))),
        (_, Some(number), _) => Some(since(measured.executes.get(number)?.time)),
        (.., "initial_turning_time_s") => measured.initial_turning_time,
        (.., "initial_turning_lengths") => {
            let length = trial.particulars().map(|particulars| particulars.length).or(length)?;
            let time = measured.initial_turning_time?;
            let speed = particulars.map(|particulars| particulars.speed);
            let way = measured.initial_turning_distance.or_else(|| Some(speed? * time.value))?;
            Some(Quantity::new(way / length, time.sd.map(|sd| sd * way / (time.value * length))))
        }
        (.., "period_s") => measured.period_over(ZIG_ZAG_EXECUTES),
        _ => None,
    }
}
