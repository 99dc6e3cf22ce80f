//! Entries in addition to the named effects: the random moment, and located shapes.

use document::names;
use document::trace::{DisturbanceEntry, LocatedMomentEntry};
use ship::angle::to_deg;

use super::TraceParts;
use crate::model::TermName;
use crate::residual_analysis::heading_error_squares;
use crate::shape::{NamedShape, ShapeCandidate};

impl TraceParts<'_> {
    /// Random moment in addition to named effects and shapes, with its share of the squared heading error; `None`
    /// without a random moment.
    pub(super) fn disturbance(&self) -> Option<DisturbanceEntry> {
        let shapes = self.attribution.shapes.as_ref()?;
        let rudder_deg = to_deg(self.attribution.unexplained_random_moment(self.rudder_noises)?.rudder_rms);
        let [_, after] = heading_error_squares(self.identification);
        let rows =
            || self.identification.iter().map(|comparison| comparison.average_replay.errors.heading_count as f64);
        let of_row = self.fitted_records.records.iter().zip(&shapes.white_heading_sd);
        let noise = of_row.zip(rows()).map(|((record, sd), rows)| sd * sd * record.full_readings as f64 * rows);
        let square = shapes.heading_mean_square.map_or(after, |mean| mean * rows().sum::<f64>());
        let share = (square - noise.sum::<f64>()).max(0.0) / after.max(square);
        Some(DisturbanceEntry { rudder_deg, heading_error_share: share })
    }

    /// Located shapes; a shape that accompanies a change of the ship is not listed separately.
    pub(super) fn located(&self) -> Vec<LocatedMomentEntry> {
        let Some(shapes) = self.attribution.shapes.as_ref().filter(|all| all.has_significant_shapes()) else {
            return Vec::new();
        };
        let mut alternatives = shapes.alternatives(|record| self.span(record));
        let displaced = self.attribution.displaced_effects.iter().map(|effect| effect.term);
        alternatives.extend(displaced.map(|(id, form, _): TermName| names::effect_form_name(id, form)));
        let entry = |named: &NamedShape| {
            let ShapeCandidate { shape, record_index: record, .. } = *named.candidate;
            let span = self.span(record);
            let acts = shape.span(span[1]).map(|times| times.map(|t| span[0] + t.clamp(0.0, span[1])));
            LocatedMomentEntry {
                depends_on: shape.dependence(),
                form: shape.description(span),
                only: self.record_name(record),
                from_s: acts.map(|[from, _]| from),
                until_s: acts.map(|[_, until]| until),
                nats: named.loss_nats,
                rudder_deg: to_deg(named.rudder_rms),
                alternatives: alternatives.clone(),
                formula: shape.formula().map(|formula| format!("located = {formula}")),
            }
        };
        shapes.named_shapes(|record| self.span(record)[1]).iter().map(entry).collect()
    }

    /// Start and duration, s, of a record; for `None`, of the longest record.
    fn span(&self, record: Option<usize>) -> [f64; 2] {
        let records = &self.fitted_records.records;
        let longest = || records.iter().max_by(|a, b| a.duration().total_cmp(&b.duration()));
        let record = record.map_or_else(longest, |number| records.get(number));
        record.map_or([0.0; 2], |record| [record.time[0], record.duration()])
    }
}
