//! What is left beside the named effects: a random moment, and moments that are no effects of the list.

use document::names;
use document::trace::{DisturbanceEntry, LocatedEntry};
use ship::angle::to_deg;

use super::TraceParts;
use crate::model::TermName;
use crate::remainder::squares;
use crate::shape::{Candidate, NamedShape};

impl TraceParts<'_> {
    /// The random moment beside what is named and located, and its share of the heading error of the replays.
    pub(super) fn disturbance(&self) -> Option<DisturbanceEntry> {
        let shapes = self.location.shapes.as_ref()?;
        let rudder_deg = to_deg(self.location.moment(self.rudder_errors)?.rudder);
        let [_, after] = squares(self.identification);
        let rows = || self.identification.iter().map(|one| one.after.errors.rows as f64);
        let of_row = self.problem.records.iter().zip(&shapes.heading_sd);
        let noise = of_row.zip(rows()).map(|((record, sd), rows)| sd * sd * record.full_readings as f64 * rows);
        let left = shapes.mean_square.map_or(after, |square| square * rows().sum::<f64>());
        let share = (left - noise.sum::<f64>()).max(0.0) / after.max(left);
        Some(DisturbanceEntry { rudder_deg, heading_error_share: share })
    }

    /// The shapes that are believed; what belongs to the change of a ship is no shape of its own.
    pub(super) fn located(&self) -> Vec<LocatedEntry> {
        let Some(shapes) = self.location.shapes.as_ref().filter(|own| own.is_located()) else { return Vec::new() };
        let mut alternatives = shapes.alternatives(|only| self.span(only));
        let label = |(id, form, _): TermName| names::effect_form(id, form);
        alternatives.extend(self.location.displaced.iter().map(|effect| label(effect.term)));
        let entry = |named: &NamedShape| {
            let Candidate { shape, only, .. } = *named.candidate;
            let span = self.span(only);
            let acts = shape.span(span[1]).map(|times| times.map(|t| span[0] + t.clamp(0.0, span[1])));
            LocatedEntry {
                depends_on: shape.dependence(),
                form: shape.words(span),
                only: self.only(only),
                from_s: acts.map(|[from, _]| from),
                until_s: acts.map(|[_, until]| until),
                nats: named.loss,
                rudder_deg: to_deg(named.size),
                alternatives: alternatives.clone(),
                formula: shape.formula().map(|formula| format!("located = {formula}")),
            }
        };
        shapes.named(|only| self.span(only)[1]).iter().map(entry).collect()
    }

    /// Beginning and length, s, of a record, or of the longest.
    fn span(&self, only: Option<usize>) -> [f64; 2] {
        let records = &self.problem.records;
        let longest = || records.iter().max_by(|one, other| one.duration().total_cmp(&other.duration()));
        let record = only.map_or_else(longest, |number| records.get(number));
        record.map_or([0.0; 2], |record| [record.time[0], record.duration()])
    }
}
