//! A manoeuvre predicted: every figure of merit with its intervals and where they come from, and bands of its curves.

use estimation::statistics::median;
use indexmap::IndexMap;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::Particulars;

use crate::error::PredictError;
use crate::figures::{self, Figure};
use crate::interval::{PredictionInterval, band};
use crate::kind::Kind;
use crate::known::ValidityRange;
use crate::mixture::{ShipMixture, UncertaintySource};
use crate::passage::{self, SimulatedManoeuvre};
use crate::steady::SteadyCurve;

/// Draws for every source alone, as a share of all.
const ALONE: usize = 4;

/// Share of the draws that have to come to the end of a manoeuvre.
const FEWEST: f64 = 0.5;

/// How far beyond what was seen is still within it: a rudder overshoots its order, a largest rate is that of one
/// record.
const MARGIN: f64 = 1.05;

/// A figure of merit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Predicted {
    /// Median and intervals of the draws that have it.
    #[serde(flatten)]
    pub interval: PredictionInterval,
    /// Whether rudder or yaw rate of the manoeuvre are beyond those of the records.
    pub extrapolated: bool,
    /// Share of the draws that have the figure.
    pub defined: f64,
    /// Share of every source of doubt in the spread.
    pub shares: IndexMap<String, f64>,
    /// The draws, in the order of their numbers.
    #[serde(skip)]
    pub draws: Vec<Option<f64>>,
}

impl Predicted {
    /// Share of the drawn ships that keep within a limit; one without the figure does not.
    pub fn share_within(&self, limit: f64) -> f64 {
        let kept = self.draws.iter().filter(|draw| draw.is_some_and(|value| value <= limit)).count();
        kept as f64 / self.draws.len() as f64
    }
}

/// A curve over time with its bands; angles in rad.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bands {
    /// Time from the first execute, s.
    pub time: Vec<f64>,
    /// The most probable ship without chance, as far as it goes; NaN beyond.
    pub most_probable: Vec<f64>,
    /// Quantiles of 5, 25, 50, 75 and 95 % of the draws.
    pub quantiles: Vec<[f64; 5]>,
}

/// A manoeuvre predicted; its curves are no part of the document.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Prediction {
    /// The manoeuvre.
    pub kind: Kind,
    /// Its figures by name, with the unit.
    pub figures: IndexMap<String, Predicted>,
    /// Draws that did not come to the end.
    pub lost: usize,
    /// Heading, but for a spiral.
    #[serde(skip)]
    pub heading: Bands,
    /// The most probable ship without chance, but for a spiral.
    #[serde(skip)]
    pub most_probable: Option<SimulatedManoeuvre>,
    /// Tracks of some of the draws, north and east, m; empty where nothing is known of speed and drift.
    #[serde(skip)]
    pub tracks: Vec<Vec<[f64; 2]>>,
    /// Steady curves of the most probable ship and of some others, for a spiral.
    #[serde(skip)]
    pub curves: Vec<SteadyCurve>,
}

impl Prediction {
    /// Whether rudder or yaw rate are beyond those of the records.
    pub fn is_extrapolated(&self) -> bool {
        self.figures.values().any(|figure| figure.extrapolated)
    }
}

/// One draw of a manoeuvre.
struct Draw {
    figures: Vec<Figure>,
    heading: Vec<f64>,
    largest_rate: f64,
    track: Option<Vec<[f64; 2]>>,
}

/// Draws whose tracks are kept.
const TRACKS: u64 = 40;

/// Refuses what less than half of the drawn ships come to the end of.
pub(crate) fn enough(what: impl ToString, made: usize, draws: usize) -> Result<(), PredictError> {
    if made == 0 || (made as f64) < FEWEST * draws as f64 {
        return Err(PredictError::Lost { kind: what.to_string(), made, draws });
    }
    Ok(())
}

impl ShipMixture {
    /// Length and speed, where the first file has them.
    pub fn particulars(&self) -> Option<Particulars> {
        let first = self.first();
        Some(Particulars { length: first.length_m?, speed: first.speed_m_s? })
    }

    /// Predicts a manoeuvre from so many draws; `shares` asks for the share of every source of doubt.
    ///
    /// Fails where less than half of the drawn ships come to the end of it.
    pub fn predict(&self, kind: &Kind, draws: usize, shares: bool) -> Result<Prediction, PredictError> {
        let Some(manoeuvre) = kind.manoeuvre(self.timescale()) else { return Ok(self.spiral(kind, draws, shares)) };
        let sail = |number: u64, sources: &[UncertaintySource]| {
            let passage = SimulatedManoeuvre::sail(&self.draw(number, sources), &manoeuvre, self.timescale()).ok()?;
            Some((figures::of(kind, &passage, self.particulars()), passage))
        };
        let all: Vec<Option<Draw>> = drawn(draws, |number| {
            let (figures, passage) = sail(number, &UncertaintySource::ALL)?;
            let largest_rate = passage.largest_rate();
            let track = passage.way.filter(|_| number < TRACKS).map(|way| way.track);
            Some(Draw { figures, heading: passage.heading, largest_rate, track })
        });
        let made: Vec<&Draw> = all.iter().flatten().collect();
        enough(kind, made.len(), draws)?;
        let values: Vec<Option<&[Figure]>> =
            all.iter().map(|draw| draw.as_ref().map(|draw| draw.figures.as_slice())).collect();
        let extrapolated = self.is_unseen(kind.rudder, made.iter().map(|draw| draw.largest_rate));
        let alone = |source| drawn(draws.div_ceil(ALONE), |number| Some(sail(number, &[source])?.0));
        let sources: &[UncertaintySource] = if shares { &UncertaintySource::ALL } else { &[] };
        let most_probable = sail(0, &[]).map(|(_, passage)| passage);
        Ok(Prediction {
            kind: *kind,
            figures: predicted(&values, extrapolated, sources, alone),
            heading: bands(&made, most_probable.as_ref(), passage::period(self.timescale())),
            lost: draws - made.len(),
            most_probable,
            tracks: made.iter().filter_map(|draw| draw.track.clone()).collect(),
            curves: Vec::new(),
        })
    }

    /// Steady turns; chance has no part in them.
    fn spiral(&self, kind: &Kind, draws: usize, shares: bool) -> Prediction {
        let curve = |number, sources: &[UncertaintySource]| {
            SteadyCurve::of(&self.draw(number, sources), kind.rudder, self.timescale())
        };
        let all: Vec<SteadyCurve> = drawn(draws, |number| curve(number, &UncertaintySource::ALL));
        let own: Vec<Vec<Figure>> = all.iter().map(|curve| curve.figures(kind.rudder)).collect();
        let values: Vec<Option<&[Figure]>> = own.iter().map(|figures| Some(figures.as_slice())).collect();
        let alone = |source| drawn(draws.div_ceil(ALONE), |number| Some(curve(number, &[source]).figures(kind.rudder)));
        let sources: &[UncertaintySource] =
            if shares { &[UncertaintySource::Parameters, UncertaintySource::Structure] } else { &[] };
        let most_probable = curve(0, &[]);
        let rates = std::iter::once(most_probable.yaw_rate.iter().fold(0.0, |most: f64, rate| most.max(rate.abs())));
        Prediction {
            kind: *kind,
            figures: predicted(&values, self.is_unseen(kind.rudder, rates), sources, alone),
            lost: 0,
            heading: Bands::default(),
            most_probable: None,
            tracks: Vec::new(),
            curves: std::iter::once(most_probable).chain(all).collect(),
        }
    }

    /// Whether a rudder (rad) or the median of the largest yaw rates (rad/s) is beyond what the records have seen.
    pub(crate) fn is_unseen(&self, rudder: f64, rates: impl Iterator<Item = f64>) -> bool {
        let rate = median(&mut rates.collect::<Vec<f64>>()).unwrap_or(0.0);
        let most =
            |value: fn(&ValidityRange) -> f64| self.files().iter().map(|known| value(&known.seen)).fold(0.0, f64::max);
        rudder > MARGIN * most(|seen| seen.rudder_rad) || rate > MARGIN * most(|seen| seen.yaw_rate_rad_s)
    }
}

/// What is made of so many draws, in the order of their numbers.
pub(crate) fn drawn<T: Send>(draws: usize, one: impl Fn(u64) -> T + Sync + Send) -> Vec<T> {
    (0..draws as u64).into_par_iter().map(one).collect()
}

/// Figures from the draws, with the shares of sources that are drawn alone.
fn predicted(
    draws: &[Option<&[Figure]>],
    extrapolated: bool,
    sources: &[UncertaintySource],
    alone: impl Fn(UncertaintySource) -> Vec<Option<Vec<Figure>>>,
) -> IndexMap<String, Predicted> {
    let Some(names) = draws.iter().flatten().next() else { return IndexMap::new() };
    let alone: Vec<_> = sources.iter().map(|source| (source.as_str(), alone(*source))).collect();
    let figure = |(place, &(name, _)): (usize, &Figure)| {
        let of_draws: Vec<Option<f64>> = draws.iter().map(|draw| draw.and_then(|figures| figures[place].1)).collect();
        let mut values: Vec<f64> = of_draws.iter().copied().flatten().collect();
        let defined = values.len() as f64 / draws.len() as f64;
        let interval = PredictionInterval::of(&mut values)?;
        let spread = |few: &[Option<Vec<Figure>>]| {
            let mut values: Vec<f64> = few.iter().flatten().filter_map(|figures| figures[place].1).collect();
            PredictionInterval::of(&mut values).map_or(0.0, |interval| (interval.ci90[1] - interval.ci90[0]).powi(2))
        };
        let spreads: Vec<(&str, f64)> = alone.iter().map(|(source, few)| (*source, spread(few))).collect();
        let sum: f64 = spreads.iter().map(|(_, spread)| spread).sum();
        let shares = spreads.into_iter().filter(|_| sum > 0.0);
        let shares = shares.map(|(source, spread)| (source.to_owned(), spread / sum)).collect();
        Some((name.to_owned(), Predicted { interval, extrapolated, defined, shares, draws: of_draws }))
    };
    names.iter().enumerate().filter_map(figure).collect()
}

/// Quantiles row by row, as long as nine tenths of the draws go on.
fn bands(draws: &[&Draw], most_probable: Option<&SimulatedManoeuvre>, period: f64) -> Bands {
    let mut bands = Bands::default();
    let mut values = Vec::with_capacity(draws.len());
    for row in 0.. {
        values.clear();
        values.extend(draws.iter().filter_map(|draw| draw.heading.get(row)));
        if (values.len() as f64) < 0.9 * draws.len() as f64 || values.is_empty() {
            break;
        }
        bands.time.push(row as f64 * period);
        bands.quantiles.push(band(&mut values));
        let known = most_probable.and_then(|passage| passage.heading.get(row));
        bands.most_probable.push(known.copied().unwrap_or(f64::NAN));
    }
    bands
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::known::Moment;
    use crate::made_up;

    fn mixture(change: impl Fn(&mut crate::known::IdentifiedShip)) -> ShipMixture {
        let mut known = made_up::known();
        change(&mut known);
        ShipMixture::new(vec![(known, 1.0)]).expect("made up")
    }

    fn kind(text: &str) -> Kind {
        text.parse().expect("known")
    }

    /// Without doubt every draw is the most probable ship.
    #[test]
    fn what_is_known_for_certain_has_no_interval() {
        let sure = mixture(|known| {
            known.members[0].covariance.clear();
            known.members[0].fitted.clear();
            known.noise.moment = Moment::None;
            known.gear.as_mut().expect("made up").sd_rad_s = 0.0;
            known.approach_yaw_rate_rad_s = 0.0;
        });
        let prediction = sure.predict(&kind("zig-zag:10/10"), 8, true).expect("a manoeuvre");
        for (name, figure) in &prediction.figures {
            assert_eq!(figure.interval.ci90[0], figure.interval.ci90[1], "{name}");
            assert!(figure.shares.is_empty() && figure.defined == 1.0);
        }
        assert!(!prediction.is_extrapolated() && prediction.lost == 0);
        assert!(prediction.heading.time.len() > 100);
    }

    /// A source that is not there has no share, and shares are shares.
    #[test]
    fn shares_add_up_and_name_the_source() {
        let noisy = mixture(|known| {
            known.members[0].covariance.clear();
            known.members[0].fitted.clear();
        });
        let prediction = noisy.predict(&kind("zig-zag:10/10"), 200, true).expect("a manoeuvre");
        let first = &prediction.figures["first_overshoot_deg"];
        let share = |of: UncertaintySource| first.shares[of.as_str()];
        assert!((first.shares.values().sum::<f64>() - 1.0).abs() < 1e-12);
        assert_eq!((share(UncertaintySource::Parameters), share(UncertaintySource::Structure)), (0.0, 0.0));
        assert!(share(UncertaintySource::ProcessNoise) > 0.3, "{:?}", first.shares);
        let [low, high] = first.interval.ci90;
        assert!(high - low > 0.2 && low < first.interval.median && first.interval.median < high);
    }

    #[test]
    fn beyond_what_was_seen_is_said() {
        let ship = mixture(|_| {});
        assert!(ship.predict(&kind("turning-circle:35"), 8, false).expect("a turn").is_extrapolated());
        assert!(!ship.predict(&kind("zig-zag:10/10"), 8, false).expect("a zig-zag").is_extrapolated());
        let spiral = ship.predict(&kind("spiral:15"), 8, true).expect("a curve");
        assert_eq!(spiral.curves.len(), 9);
        assert_eq!(spiral.figures[2].interval.median, 0.0, "a stable ship has no loop");
    }

    /// The same in any number of threads, and for the mirrored ship on the other side.
    #[test]
    fn predictions_are_repeated_to_the_bit() {
        let ship = mixture(|_| {});
        let [one, again] = [0, 1].map(|_| ship.predict(&kind("zig-zag:20/20"), 40, true).expect("a zig-zag"));
        assert_eq!(one.figures, again.figures);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
        let alone = pool.install(|| ship.predict(&kind("zig-zag:20/20"), 40, true).expect("a zig-zag"));
        assert_eq!(one.figures, alone.figures);
    }

    #[test]
    fn a_ship_that_does_not_answer_is_refused() {
        let lost = mixture(|known| known.members[0].parameters[2] = -0.5);
        let error = lost.predict(&kind("zig-zag:10/10"), 8, false).expect_err("it never turns to starboard");
        assert!(error.to_string().contains("0 of 8"), "{error}");
    }
}
