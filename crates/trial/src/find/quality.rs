//! How good a log is where a manoeuvre was found: facts that a person wants before the part is analysed. Nothing is
//! refused for them.

use ship::angle::to_deg;

use super::pattern::Prepared;

/// Share of missing headings worth a remark.
const MISSING: f64 = 0.01;

/// Rows without a heading, in usual steps, that make a gap.
const GAP: f64 = 10.0;

/// Difference between holds to one side worth a remark, degrees.
const SPREAD_DEG: f64 = 1.5;

/// Change of speed and revolutions, as a share, from the first third of an approach of full length to the last: 5 %
/// over all of it.
pub(crate) const STEADY_SPEED: f64 = 0.033;

/// How a manoeuvre was approached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Approach {
    /// On a steady course at a steady speed; the part begins with the end of it.
    Steady,
    /// By hand, turning, or at a changing speed; the part begins with the first execute.
    Unsteady,
    /// The log begins in the manoeuvre.
    Absent,
}

/// How good a log is where a manoeuvre was found.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Quality {
    /// Share of the rows without a heading, 0 to 1.
    pub missing_headings: f64,
    /// Longest time without a heading, s; `None` where it is not much longer than usual.
    pub longest_gap: Option<f64>,
    /// Largest difference between the rudder angles held to one side of a zig-zag, rad.
    pub rudder_spread: f64,
    /// How it was approached; `None` for a pull-out and a straight piece.
    pub approach: Option<Approach>,
    /// Change of speed from the first third of the approach, at most one hold long, to the last, as a share of the
    /// larger; positive where it grew; `None` where it is not known.
    pub speed_change: Option<f64>,
}

impl Quality {
    /// What the rows of a part tell by themselves.
    pub(crate) fn of(record: &Prepared, first: usize, last: usize) -> Self {
        let (time, heading) = (&record.log.time[first..=last], &record.log.heading[first..=last]);
        let mut longest = 0.0_f64;
        let (mut read, mut missing) = (time[0], 0);
        for (&t, psi) in time.iter().zip(heading) {
            longest = longest.max(t - read);
            if psi.is_finite() { read = t } else { missing += 1 }
        }
        Self {
            missing_headings: f64::from(missing) / time.len() as f64,
            longest_gap: (longest > GAP * record.rest.step).then_some(longest),
            rudder_spread: 0.0,
            approach: None,
            speed_change: None,
        }
    }

    /// What is worth knowing, in sentences; empty where there is nothing.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        match self.approach {
            Some(Approach::Unsteady) => {
                remarks.push(String::from("The approach was not steady: the part begins at the first execute."));
            }
            Some(Approach::Absent) => {
                remarks.push(String::from("The log begins in the manoeuvre: there is no approach."));
            }
            Some(Approach::Steady) | None => {}
        }
        if let Some(change) = self.speed_change.filter(|change| change.abs() > STEADY_SPEED) {
            let verb = if change > 0.0 { "grew" } else { "fell" };
            remarks.push(format!("The speed still {verb} by {:.0} % in the approach.", 100.0 * change.abs()));
        }
        if self.missing_headings > MISSING {
            remarks.push(format!("{:.0} % of the headings are missing.", 100.0 * self.missing_headings));
        }
        if let Some(gap) = self.longest_gap {
            remarks.push(format!("There is no heading for {gap:.1} s."));
        }
        if to_deg(self.rudder_spread) > SPREAD_DEG {
            let spread = to_deg(self.rudder_spread);
            remarks.push(format!("The rudder angles held to one side differ by up to {spread:.1}°."));
        }
        remarks
    }
}
