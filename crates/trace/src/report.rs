//! Document of a trace, assembled from the results of the stages. Nothing is fitted here.

use std::collections::BTreeMap;
use std::sync::Arc;

use document::trace::*;
use document::{HeadingNoise, Quantity, RandomMoment};
use estimation::mixture::{MixtureSummary, NormalMixture, NormalPair, ratio_summary};
use estimation::residuals::{GappedSeries, whiteness_test};
use ship::angle::to_deg;
use ship::effects::{self, Effect, Parameter};
use ship::particulars::prime_unit;
use ship::{Particulars, RegressorChannel};
use trial::Trial;

use crate::base::FittedBase;
use crate::candidates::{PRIOR_PROBABILITY, PRIOR_PROBABILITY_TIME_MOMENT, is_barred_by_calm};
use crate::comparison::{RecordComparison, ReplayResult};
use crate::fit::{FittedRecords, StructureFit};
use crate::full::FullModel;
use crate::location::Attribution;
use crate::model::{ModelParameter, Term, TermName};
use crate::naming::EffectNaming;
use crate::record::PreparedRecord;
use crate::residual_analysis::ResidualAnalysis;
use crate::rudder::RudderNoise;
use crate::sentences;
use crate::settings::Settings;
use crate::structures::Structures;

mod disturbance_and_shapes;
mod prior_odds;

/// Results of the stages of a trace.
pub struct TraceParts<'a> {
    /// Fitted records.
    pub trials: &'a [Trial],
    /// Settings of the trace.
    pub settings: &'a Settings,
    /// First-order base with its replays.
    pub base: &'a FittedBase,
    /// Full model with its noise law.
    pub full_model: &'a FullModel,
    /// Structures with their probabilities.
    pub structures: &'a Structures,
    /// Candidate terms.
    pub candidates: &'a [Arc<Term>],
    /// Comparisons on fitted records.
    pub identification: &'a [RecordComparison],
    /// Held-out records with their comparisons.
    pub validation: (&'a [Trial], &'a [RecordComparison]),
    /// Leave-one-out comparison of every fitted record; `None` for a fold without a base or a finite replay.
    pub leave_one_out: &'a [Option<RecordComparison>],
    /// Residual analysis.
    pub residual_analysis: &'a ResidualAnalysis,
    /// Named effects and shapes.
    pub attribution: &'a Attribution,
    /// Times of the removed compass outliers of the fitted records, s.
    pub outlier_times: &'a [Vec<f64>],
    /// Measurement error of the rudder of every fitted record; `None` without one.
    pub rudder_noises: &'a [Option<RudderNoise>],
    /// `true` if the replay of the base is kept on the fitted records.
    pub keeps_base: bool,
    /// `true` if the reported replays of the average include fitted hulls.
    pub has_hulls: bool,
    /// Prepared records.
    pub fitted_records: &'a FittedRecords,
}

/// Minimum visibility of an observable candidate.
const MIN_VISIBILITY: f64 = 4.0;

/// Maximum number of listed structures.
const MAX_LISTED: usize = 20;

impl TraceParts<'_> {
    /// Document of the trace.
    pub fn document(&self) -> AnalysisDocument {
        let selection = &self.settings.selection;
        let mut named = self.attribution.named_effects.clone();
        named.retain(|naming| self.residual_analysis.is_credible || selection.requires(naming.term.0));
        let effects = self.effects(&named);
        let residual_peak = self.residual_analysis.residual_peak.as_ref();
        let error = self.errors();
        let disturbance = self.disturbance();
        let verdict = self.verdict(effects.is_empty(), disturbance.is_some());
        let located = self.located();
        let (base, indices) = (&self.base.estimate, self.indices());
        let headline = sentences::Headline {
            verdict,
            effects: &effects,
            error: &error,
            disturbance,
            located: &located,
            has_hulls: self.has_hulls,
        };
        AnalysisDocument {
            schema: SCHEMA.into(),
            headline: headline.text(),
            verdict,
            base: self.with_prime([base.K(), base.T(), base.rudder_bias()]),
            candidates: selection.ids().into_iter().map(|id| self.candidate(id.as_str(), &named)).collect(),
            structures: self.listed(),
            prior: PriorEntry {
                candidates: self.candidates.len(),
                probability: PRIOR_PROBABILITY,
                time_moment_probability: PRIOR_PROBABILITY_TIME_MOMENT,
                min_named_probability: self.settings.min_probability,
                odds_factors: prior_odds::PRIOR_ODDS_FACTORS.into(),
                rule: self.settings.rule.as_str().into(),
            },
            unexplained: UnexplainedEntry {
                present: self.residual_analysis.is_unexplained,
                signature: residual_peak.map(|s| {
                    sentences::residual_peak_sentence(s, &self.trials[s.record_index].title()) + &self.bands()
                }),
            },
            disturbance,
            located,
            residual: ResidualWhitenessEntry {
                before: self.whiteness(|comparison| &comparison.base_replay),
                after: self.whiteness(|comparison| &comparison.average_replay),
            },
            noise: self.noise(),
            model: ModelEntry {
                equations: match effects.is_empty() {
                    true => vec!["T r' + r = K (δ + δ_r)".into()],
                    false => effects.iter().map(|effect| effect.equation.clone()).collect(),
                },
                indices,
                parameters: self.structures.weighed.first().map_or_else(Vec::new, |best| self.parameters(&best.fit)),
            },
            error,
            effects,
        }
    }

    /// Verdict of the trace, the first that holds.
    fn verdict(&self, is_unnamed: bool, is_disturbed: bool) -> TraceVerdict {
        match (self.attribution.has_significant_shapes(), is_unnamed, is_disturbed) {
            _ if self.residual_analysis.is_unexplained => TraceVerdict::Unexplained,
            (true, ..) => TraceVerdict::Located,
            (_, false, _) => TraceVerdict::Traced,
            (.., true) => TraceVerdict::Disturbed,
            _ => TraceVerdict::Clean,
        }
    }

    /// Text on the fitted records whose bands have less than their nominal coverage; empty without such records.
    fn bands(&self) -> String {
        let records = self.trials.iter().zip(self.identification);
        let bands = records.filter_map(|(trial, comparison)| Some((trial, comparison.average_replay.band_coverage()?)));
        bands
            .filter(|(_, band)| !band.is_nominal())
            .map(|(t, band)| sentences::band_sentence(&t.title(), &band))
            .collect()
    }

    fn ship(&self) -> Option<Particulars> {
        self.trials.iter().find_map(Trial::particulars)
    }

    fn record_name(&self, record: Option<usize>) -> Option<String> {
        record.map(|number| self.trials[number].name().to_owned())
    }

    fn equation(&self, id: &str, form: &str) -> &'static str {
        let mut effects = self.candidates.iter().map(|term| &term.effect);
        effects.find(|effect| effect.id() == id && effect.form() == form).map_or("", |effect| effect.equation())
    }

    fn with_prime(&self, [k, t, bias]: [Quantity; 3]) -> Indices {
        let prime = self.ship().map(|ship| PrimeIndices::new([k, t], ship));
        Indices { K_per_s: k, T_s: t, delta_r_deg: bias.scaled(to_deg(1.0)), prime }
    }

    /// K, T and δ_r averaged over the structures.
    fn indices(&self) -> Indices {
        let members = self.structures.weighted_members();
        let pair = |(weight, fit): &(f64, &StructureFit)| {
            let covariance = fit.covariance();
            let entry = |i, j| covariance.as_ref().map_or(f64::INFINITY, |all| all[(i, j)]);
            let (denominator, numerator) = ((fit.theta[0], entry(0, 0)), (fit.theta[1], entry(1, 1)));
            NormalPair { weight: *weight, denominator, numerator, covariance: entry(0, 1) }
        };
        let pairs: Vec<NormalPair> = members.iter().map(pair).collect();
        let reciprocal = |pair: &NormalPair| NormalPair { numerator: (1.0, 0.0), covariance: 0.0, ..*pair };
        let (k, t) = (ratio_summary(&pairs), ratio_summary(&pairs.iter().map(reciprocal).collect::<Vec<_>>()));
        let bias =
            members.iter().map(|(weight, fit)| (*weight, fit.physical_values()[2].0, fit.physical_values()[2].1));
        self.with_prime([k, t, NormalMixture { components: bias.collect() }.summary()].map(quantity))
    }

    /// Entries of θ of one structure in physical units, with their standard deviations.
    fn parameters(&self, fit: &StructureFit) -> Vec<ParameterEntry> {
        let values = fit.structure.entries().into_iter().zip(fit.physical_values()).zip(&fit.theta);
        values.map(|((entry, (value, sd)), &fitted)| self.parameter(&entry, vec![(1.0, value, sd)], fitted)).collect()
    }

    /// Entry of θ averaged over structures (weight, value, standard deviation); `fitted` is the fitted value in the
    /// first structure.
    fn parameter(&self, entry: &ModelParameter, parts: Vec<(f64, f64, f64)>, fitted: f64) -> ParameterEntry {
        let quantity = match entry.prior.is_fitted() {
            true => quantity(NormalMixture { components: parts }.summary()),
            false => Quantity::without_uncertainty(parts[0].1),
        };
        self.number(entry.parameter, quantity, entry.record_index, entry.is_at_bound(fitted))
    }

    fn number(&self, parameter: &Parameter, value: Quantity, record: Option<usize>, at_bound: bool) -> ParameterEntry {
        let prime = self.ship().filter(|_| parameter.dimension() != [0, 0]).map(|ship| NondimensionalValue {
            quantity: value.scaled(ship.prime_factor(parameter.dimension())),
            unit: prime_unit(parameter.unit),
        });
        let (key, symbol, unit) = (parameter.key.into(), parameter.symbol.into(), parameter.unit.into());
        ParameterEntry { key, symbol, quantity: value, unit, prime, only: self.record_name(record), at_bound }
    }

    /// Parameters of a term, averaged over the structures that have it.
    fn term_parameters(&self, name: TermName) -> BTreeMap<String, ParameterEntry> {
        let members = self.structures.weighted_members().into_iter();
        let all = members.chain(self.structures.weighed.iter().map(|weighed| (1e-9 * weighed.weight, &weighed.fit)));
        let with = all.filter_map(|(weight, fit)| {
            let place = fit.structure.terms.iter().position(|term| term.name() == name)?;
            let range = fit.structure.term_ranges()[place].clone();
            let values = fit.physical_values()[range.clone()].to_vec();
            Some((weight, values, fit.structure.entries()[range.clone()].to_vec(), fit.theta[range].to_vec()))
        });
        let fits: Vec<_> = with.collect();
        let Some((_, _, entries, first)) = fits.first() else { return BTreeMap::new() };
        let average = |k: usize| {
            let parts = fits.iter().map(|(weight, values, ..)| (*weight, values[k].0, values[k].1));
            let entry = self.parameter(&entries[k], parts.collect(), first[k]);
            (entry.symbol.clone(), entry)
        };
        (0..first.len()).map(average).collect()
    }

    fn effects(&self, named: &[EffectNaming]) -> Vec<EffectEntry> {
        let entry = |naming: &EffectNaming| {
            let (id, form, record) = naming.term;
            let evidence = self.structures.effect_evidence(id, record);
            let mut aliases: Vec<String> = naming.aliases.iter().map(|(id, ..)| String::from(*id)).collect();
            aliases.dedup();
            let alias_forms = naming.aliases.iter().chain(&naming.forms).map(|name| self.term(*name)).collect();
            let asked = self.settings.selection.requires(id);
            EffectEntry {
                id: id.into(),
                form: form.into(),
                equation: self.equation(id, form).into(),
                only: self.record_name(record),
                required: asked,
                alias_forms,
                parameters: self.term_parameters(naming.term),
                probability: naming.probability,
                probability_by_prior_odds: self.by_prior_odds(|name| naming.includes(name)),
                delta_bic: -2.0 * evidence.log_ratio,
                p_value: evidence.p_value,
                evidence: sentences::evidence(naming, evidence.log_ratio, asked, self.trials),
                aliases,
            }
        };
        let mut effects: Vec<EffectEntry> = named.iter().map(entry).collect();
        effects.extend(self.waves());
        effects
    }

    /// Waves as a named effect, if the noise law includes them.
    fn waves(&self) -> Option<EffectEntry> {
        let sea = self.full_model.noise_law.colour.waves?;
        let waves = effects::WaveHeading;
        let sd = sea.sd * self.full_model.noise_law.row_variance[0].sqrt();
        let values = [sd, sea.frequency, sea.damping];
        let parameters = waves.parameters().iter().zip(values).map(|(parameter, value)| {
            (parameter.symbol.into(), self.number(parameter, Quantity::without_uncertainty(value), None, false))
        });
        let gain = self.full_model.waves_gain;
        let probability = |factor: f64| prior_odds::probability_from_log_ratio(0.5 * gain, factor);
        Some(EffectEntry {
            id: waves.id().into(),
            form: waves.form().into(),
            equation: waves.equation().into(),
            only: None,
            required: self.settings.selection.requires(waves.id()),
            aliases: Vec::new(),
            alias_forms: Vec::new(),
            parameters: parameters.collect(),
            probability: probability(1.0),
            probability_by_prior_odds: prior_odds::PRIOR_ODDS_FACTORS.map(probability).into(),
            delta_bic: -gain,
            p_value: (-0.5 * gain).exp().min(1.0),
            evidence: sentences::wave_evidence(sd, sea.frequency),
        })
    }

    fn candidate(&self, id: &'static str, named: &[EffectNaming]) -> CandidateEntry {
        let terms = self.candidates.iter().filter(|term| term.effect.id() == id);
        let forms: Vec<FormEntry> = terms.map(|term| self.form(term.name(), named)).collect();
        let is_sea = id == effects::WaveHeading.id();
        let sea = self.full_model.noise_law.colour.waves.is_some();
        let selection = &self.settings.selection;
        let excluded = !selection.allows(id);
        let mut effects = selection.effects();
        effects.retain(|form| form.id() == id);
        let becalmed = effects.iter().any(|form| is_barred_by_calm(form.as_ref(), None, self.trials, selection));
        let reason = match (forms.is_empty(), excluded) {
            (_, true) => Some("excluded on request"),
            _ if becalmed => Some("the record declares a calm (weather = \"none\")"),
            (true, false) if !is_sea => {
                let needs = effects.iter().find_map(|form| form.needs());
                Some(needs.map_or("the records cannot show it", RegressorChannel::missing_message))
            }
            _ => None,
        };
        let best = forms.iter().min_by(|a, b| a.outcome.cmp(&b.outcome).then(b.probability.total_cmp(&a.probability)));
        let probability = match is_sea {
            true => f64::from(u8::from(sea)),
            false => self.structures.inclusion_probability(|name| name.0 == id),
        };
        let outcome = match (is_sea && !excluded && !becalmed, sea) {
            (true, true) => CandidateOutcome::Added,
            (true, false) => CandidateOutcome::Rejected,
            _ => best.map_or(CandidateOutcome::NotObservable, |best| best.outcome),
        };
        CandidateEntry {
            id: id.into(),
            outcome,
            probability,
            probability_by_prior_odds: self.by_prior_odds(|name| name.0 == id),
            delta_bic: best.and_then(|best| best.delta_bic),
            p_value: best.and_then(|best| best.p_value),
            reason: reason.map(String::from),
            sides: self.settings.selection.formula(id).map(|formula| formula.mirror_symmetry().as_str().into()),
            forms,
        }
    }

    fn form(&self, name: TermName, named: &[EffectNaming]) -> FormEntry {
        let (_, form, record) = name;
        let visibility = self.structures.visibility.get(&name).copied();
        let outcome = if named.iter().any(|naming| naming.term == name) {
            CandidateOutcome::Added
        } else if named.iter().any(|naming| naming.aliases.contains(&name) || naming.forms.contains(&name)) {
            CandidateOutcome::Alias
        } else if visibility.is_some_and(|visibility| visibility < MIN_VISIBILITY) {
            CandidateOutcome::NotObservable
        } else {
            CandidateOutcome::Rejected
        };
        let evidence = self.structures.evidence.get(&name);
        FormEntry {
            form: form.into(),
            only: self.record_name(record),
            outcome,
            probability: self.structures.probabilities.get(&name).map_or(0.0, |weight| weight.clamp(0.0, 1.0)),
            delta_bic: evidence.map(|evidence| -2.0 * evidence.log_ratio.clamp(-1e6, 1e6)),
            p_value: evidence.map(|evidence| evidence.p_value),
            visibility,
        }
    }

    fn term(&self, (id, form, record): TermName) -> TermEntry {
        TermEntry { id: id.into(), form: form.into(), only: self.record_name(record) }
    }

    fn listed(&self) -> Vec<StructureEntry> {
        let members = self.structures.weighted_members().len();
        let entry = |(number, weighed): (usize, &crate::structures::WeighedStructure)| StructureEntry {
            effects: weighed.fit.structure.terms.iter().map(|term| self.term(term.name())).collect(),
            weight: weighed.weight,
            parameters: self.parameters(&weighed.fit),
            member: number < members,
        };
        self.structures.weighed.iter().take(MAX_LISTED).enumerate().map(entry).collect()
    }

    fn errors(&self) -> ReplayErrorLists {
        let entry = |(trial, comparison): (&Trial, &RecordComparison)| RecordReplayErrors {
            file: sentences::record_label(trial),
            before: (&comparison.base_replay).into(),
            after: (&comparison.average_replay).into(),
            horizons: Vec::new(),
        };
        let unfitted = |(run, on)| RecordReplayErrors { horizons: RecordComparison::horizons(on), ..entry((run, on)) };
        let folds = self.trials.iter().zip(self.leave_one_out).filter_map(|(run, fold)| Some((run, fold.as_ref()?)));
        ReplayErrorLists {
            kept_base: match (self.residual_analysis.is_credible, self.keeps_base) {
                (false, _) => Some(sentences::NO_NAMED_EFFECT_REASON.into()),
                (true, keeps_base) => keeps_base.then(|| sentences::KEPT_BASE_REASON.into()),
            },
            identification: self.trials.iter().zip(self.identification).map(entry).collect(),
            validation: self.validation.0.iter().zip(self.validation.1).map(unfitted).collect(),
            leave_one_out: folds.map(unfitted).collect(),
        }
    }

    /// Whiteness test of the residual of one model, base or average, over all fitted records.
    fn whiteness(&self, model: fn(&RecordComparison) -> &ReplayResult) -> WhitenessEntry {
        let records = self.identification.iter().map(model).zip(self.trials);
        let series =
            records.map(|(on, trial)| GappedSeries::new(&on.replay.time, &on.replay.residual, trial.sampling_period()));
        whiteness_test(&series.collect::<Vec<_>>()).into()
    }

    /// Heading noise of every fitted record.
    pub fn heading_noise(&self) -> Vec<HeadingNoise> {
        let (law, base) = (&self.full_model.noise_law, &self.base.estimate.response);
        let gain = self.structures.weighed.first().map_or(base.K_over_T, |best| best.fit.theta[1]);
        let noise = |(variance, record): (&f64, &PreparedRecord)| HeadingNoise {
            heading_sd_rad: (variance * record.full_readings as f64).sqrt(),
            moment: law.colour.moment(*variance, self.fitted_records.longest_duration(), gain.abs()),
        };
        law.row_variance.iter().zip(&self.fitted_records.records).map(noise).collect()
    }

    fn noise(&self) -> Vec<RecordNoiseEntry> {
        let law = &self.full_model.noise_law;
        let entry = |(number, noise): (usize, HeadingNoise)| {
            let variance = law.row_variance[number];
            let heading = law.colour.correlated.filter(|(kind, _)| kind.is_heading_error());
            let (kind, correlation) = match noise.moment {
                RandomMoment::OrnsteinUhlenbeck { correlation_s, .. } => (noise.moment.kind(), Some(correlation_s)),
                other => (other.kind(), None),
            };
            RecordNoiseEntry {
                file: sentences::record_label(&self.trials[number]),
                heading_sd_deg: to_deg(noise.heading_sd_rad),
                heading_wander_sd_deg: heading.map(|(_, level)| to_deg((level * variance).sqrt())),
                heading_correlation_s: heading
                    .and_then(|(law, _)| law.correlation_time(self.fitted_records.longest_duration())),
                heading_wander: heading.map(|_| {
                    if law.includes_model_error() { HeadingErrorKind::Model } else { HeadingErrorKind::Compass }
                }),
                moment: kind,
                moment_sd_rudder_deg: (!noise.moment.is_none()).then(|| to_deg(noise.moment.size())),
                moment_correlation_s: correlation,
                waves_sd_deg: law.colour.waves.map(|sea| to_deg(sea.sd * variance.sqrt())),
                waves_frequency_rad_s: law.colour.waves.map(|sea| sea.frequency),
                is_adequate: self.residual_analysis.is_noise,
                rudder_sd_deg: self.rudder_noises[number].map(|error| to_deg(error.sd)),
                outliers_s: self.outlier_times[number].clone(),
            }
        };
        self.heading_noise().into_iter().enumerate().map(entry).collect()
    }
}

fn quantity((value, error): MixtureSummary) -> Quantity {
    Quantity { value, sd: error.map(|(sd, _)| sd), ci95: error.map(|(_, interval)| interval) }
}
