//! What a trace of measured records says of them: errors before and after, and what was named.

use document::trace::TraceDocument;
use document::trace::{BeforeAfter, EffectEntry, ErrorsEntry};
use estimation::statistics::median;
use report::number::fixed;
use trace::Document;

use super::sets::MeasuredSet;

/// A trace of measured records.
pub struct MeasuredAnalysis {
    /// Their set.
    pub set: &'static MeasuredSet,
    /// The fitted records, in words.
    pub label: String,
    /// Whether a single record was fitted with all that was recorded.
    pub is_single: bool,
    /// What the trace says.
    pub document: TraceDocument,
}

/// An error of a replay, deg; `None` where a record has none.
pub type ReplayError = fn(&ErrorsEntry) -> Option<f64>;

/// Of whole replays.
pub const WHOLE: ReplayError = |errors| Some(errors.heading_rmse_deg);
/// Of replays that are restarted every 20 s.
pub const WINDOWS_20_S: ReplayError = |errors| errors.horizon_rmse_deg.get("20").copied()?;
/// Of replays that are restarted every 60 s.
pub const WINDOWS_60_S: ReplayError = |errors| errors.horizon_rmse_deg.get("60").copied()?;

/// Root mean squares before and after over some records; not numbers where one has none.
fn pooled<'a>(records: impl Iterator<Item = &'a BeforeAfter> + Clone, of: ReplayError) -> [f64; 2] {
    let sides: [fn(&BeforeAfter) -> &ErrorsEntry; 2] = [|own| &own.before, |own| &own.after];
    sides.map(|side| {
        let squares = records.clone().map(|record| of(side(record)).unwrap_or(f64::NAN).powi(2));
        (squares.sum::<f64>() / records.clone().count() as f64).sqrt()
    })
}

impl MeasuredAnalysis {
    /// Errors on the records that were fitted, before and after, deg.
    pub fn fitted(&self, of: ReplayError) -> [f64; 2] {
        pooled(self.document.trace.error.identification.iter(), of)
    }

    /// Errors on the records that were held out, or left out in turn, before and after, deg.
    pub fn held_out(&self, of: ReplayError) -> [f64; 2] {
        let error = &self.document.trace.error;
        pooled(error.validation.iter().chain(&error.leave_one_out), of)
    }

    /// Mean of something over the records that were held out; not a number where one has none.
    pub fn mean_held_out(&self, of: ReplayError) -> f64 {
        let error = &self.document.trace.error;
        let records = error.validation.iter().chain(&error.leave_one_out);
        let values: Vec<f64> = records.map(|record| of(&record.after).unwrap_or(f64::NAN)).collect();
        values.iter().sum::<f64>() / values.len() as f64
    }

    /// What is named, in words.
    pub fn named(&self) -> String {
        named(&self.document.trace)
    }
}

/// What a trace names, in words.
pub fn named(document: &Document) -> String {
    let word = |effect: &EffectEntry| {
        let aliases: String = effect.aliases.iter().map(|alias| format!(" or {alias}")).collect();
        format!("{} ({}){aliases} {}", effect.id, effect.form, fixed(effect.probability, 2))
    };
    match document.effects.as_slice() {
        [] => "nothing".to_owned(),
        effects => effects.iter().map(word).collect::<Vec<_>>().join(", "),
    }
}

/// What the traces of the single records of a set say together.
pub struct SetSummary {
    /// The set.
    pub name: &'static str,
    /// How many records were traced alone.
    pub records: usize,
    /// Median error of the fitted records, before and after, deg.
    pub errors: [f64; 2],
    /// Median over the records of the ratio of errors on all others of the set, after over before: whole replays and
    /// windows of 60 s.
    pub held_out: [f64; 2],
    /// Effects that are named in at least half of the records, the most frequent first, and in how many.
    pub named: Vec<(String, usize)>,
}

impl SetSummary {
    /// That of a set; `None` where no record was traced alone.
    pub fn of(set: &MeasuredSet, analyses: &[MeasuredAnalysis]) -> Option<Self> {
        let own: Vec<&MeasuredAnalysis> =
            analyses.iter().filter(|one| one.set.folder == set.folder && one.is_single).collect();
        let middle =
            |of: &dyn Fn(&MeasuredAnalysis) -> f64| median(&mut own.iter().map(|one| of(one)).collect::<Vec<_>>());
        let ratio = |of: ReplayError| middle(&|one| one.held_out(of)[1] / one.held_out(of)[0]);
        let mut named: Vec<(String, usize)> = Vec::new();
        for effect in own.iter().flat_map(|one| &one.document.trace.effects) {
            match named.iter_mut().find(|(id, _)| *id == effect.id) {
                Some((_, count)) => *count += 1,
                None => named.push((effect.id.clone(), 1)),
            }
        }
        named.retain(|(_, count)| 2 * count >= own.len());
        named.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        Some(Self {
            name: set.name,
            records: own.len(),
            errors: [middle(&|one| one.fitted(WHOLE)[0])?, middle(&|one| one.fitted(WHOLE)[1])?],
            held_out: [ratio(WHOLE)?, ratio(WINDOWS_60_S)?],
            named,
        })
    }

    /// What is named, in words.
    pub fn words(&self) -> String {
        match self.named.as_slice() {
            [] => "nothing".to_owned(),
            named => named.iter().map(|(id, count)| format!("{id} ({count})")).collect::<Vec<_>>().join(", "),
        }
    }
}
