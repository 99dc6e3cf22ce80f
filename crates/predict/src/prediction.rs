//! Prediction of a manoeuvre: characteristics with intervals and their sources, and bands of the curves. Source of the
//! method: propagation of distributions by Monte Carlo, JCGM 101:2008 (Supplement 1 to the GUM).

use document::identified_ship::ValidityRange;
use estimation::statistics::median;
use indexmap::IndexMap;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use ship::Particulars;
use simulate::Manoeuvre;
use trial::manoeuvre::{deserialize_text, serialize_text};

use crate::error::PredictError;
use crate::figures::{self, Characteristics};
use crate::interval::{PredictionInterval, quantiles};
use crate::median_track::{TurnTrack, median_track};
use crate::mixture::{ShipMixture, UncertaintySource};
use crate::simulated_manoeuvre::{SimulatedManoeuvre, row_interval};
use crate::steady::SteadyCurve;

/// Number of draws, relative to the number for a single source.
const RATIO: usize = 4;

/// Minimum share of the drawn ships that complete a manoeuvre.
const MIN_COMPLETED_SHARE: f64 = 0.5;

/// Factor on the range of the records beyond which a manoeuvre is extrapolated: a rudder overshoots its order, and the
/// maximum rate comes from a single record.
pub const RANGE_FACTOR: f64 = 1.05;

/// Predicted figure of merit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Predicted")]
pub struct PredictedFigure {
    /// Median and intervals of the samples that have it.
    #[serde(flatten)]
    pub interval: PredictionInterval,
    /// `true` if rudder or yaw rate of the manoeuvre are beyond the range of the records.
    pub extrapolated: bool,
    /// Share of the samples that have the figure of merit.
    #[serde(rename = "defined")]
    pub share_of_draws: f64,
    /// Share of every source of uncertainty in the spread.
    pub shares: IndexMap<String, f64>,
    /// Value of the figure in every drawn ship, by its number; `None` where the ship does not have it. The unit is in
    /// the name of the figure.
    #[serde(skip)]
    pub drawn_values: Vec<Option<f64>>,
}

impl PredictedFigure {
    /// Share of the drawn ships within a limit; a ship without the characteristic counts as outside.
    pub fn share_within(&self, limit: f64) -> f64 {
        let kept = self.drawn_values.iter().filter(|draw| draw.is_some_and(|value| value <= limit)).count();
        kept as f64 / self.drawn_values.len() as f64
    }
}

/// Curve against time with bands; angles in rad.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BandedCurve {
    /// Time from the first execute, s.
    pub time: Vec<f64>,
    /// Most probable ship without disturbances, to the end of its manoeuvre; NaN after it.
    #[serde(deserialize_with = "with_gaps")]
    pub most_probable: Vec<f64>,
    /// Quantiles of 5, 25, 50, 75 and 95 % of the draws.
    pub quantiles: Vec<[f64; 5]>,
}

/// Numbers of a list in JSON, with null for NaN.
fn with_gaps<'de, D: Deserializer<'de>>(list: D) -> Result<Vec<f64>, D::Error> {
    let numbers = Vec::<Option<f64>>::deserialize(list)?;
    Ok(numbers.into_iter().map(|number| number.unwrap_or(f64::NAN)).collect())
}

/// Prediction of a manoeuvre; its curves are in a separate file (PredictCurves).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Prediction {
    /// Manoeuvre.
    #[serde(serialize_with = "serialize_text", deserialize_with = "deserialize_text")]
    #[schemars(with = "String")]
    pub kind: Manoeuvre,
    /// Figures of merit by name; the unit is in the name.
    pub figures: IndexMap<String, PredictedFigure>,
    /// Number of drawn ships that did not complete the manoeuvre.
    #[serde(rename = "lost")]
    pub incomplete_draws: usize,
    /// Sizes of a turning circle whose interval reaches below zero: the records do not determine them.
    #[serde(skip)]
    pub undetermined: Vec<(String, PredictionInterval)>,
    /// Curves.
    #[serde(skip)]
    pub curves: ManoeuvreCurves,
}

/// Curves of a manoeuvre; angles in rad.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ManoeuvreCurves {
    /// Heading; empty for a spiral.
    pub heading: BandedCurve,
    /// Most probable ship without disturbances; `None` for a spiral.
    pub most_probable: Option<SimulatedManoeuvre>,
    /// Tracks of some samples, north and east, m; empty for a model without speed and drift.
    pub tracks: Vec<Vec<[f64; 2]>>,
    /// Median track of a turning circle: at every change of heading the median position of the samples, north and east,
    /// m.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub median_track: Vec<[f64; 2]>,
    /// Steady curves of the most probable ship and of some others, for a spiral.
    #[serde(rename = "curves")]
    pub steady: Vec<SteadyCurve>,
}

/// Results kept from the manoeuvre of a drawn ship.
struct DrawnSeries {
    heading: Vec<f64>,
    largest_rate: f64,
    track: Option<Vec<[f64; 2]>>,
    /// `true` if the track is plotted.
    is_shown: bool,
}

impl DrawnSeries {
    fn turn(&self) -> Option<TurnTrack<'_>> {
        Some(TurnTrack { heading: &self.heading, track: self.track.as_ref()? })
    }
}

impl Prediction {
    /// `true` if rudder or yaw rate are beyond the range of the records.
    pub fn is_extrapolated(&self) -> bool {
        self.figures.values().any(|figure| figure.extrapolated)
    }
}

/// Number of drawn ships whose tracks are kept.
const TRACKS: u64 = 40;

/// Error for a manoeuvre that too few drawn ships complete.
pub(crate) fn too_few_error(manoeuvre: impl ToString, made: usize, draws: usize) -> PredictError {
    PredictError::TooFewCompleted { manoeuvre: manoeuvre.to_string(), completed: made, draws }
}

/// Fails if less than half of the drawn ships complete a manoeuvre.
pub(crate) fn check_completed(manoeuvre: impl ToString, made: usize, draws: usize) -> Result<(), PredictError> {
    if made == 0 || (made as f64) < MIN_COMPLETED_SHARE * draws as f64 {
        Err(too_few_error(manoeuvre, made, draws))
    } else {
        Ok(())
    }
}

impl ShipMixture {
    /// Length and speed; `None` if the first file has none.
    pub fn particulars(&self) -> Option<Particulars> {
        self.first_ship().particulars()
    }

    /// Predicts a manoeuvre from `draws` drawn ships; `shares` adds the share of every source of uncertainty.
    ///
    /// Fails if less than half of the drawn ships complete the manoeuvre.
    pub fn predict(&self, kind: &Manoeuvre, draws: usize, shares: bool) -> Result<Prediction, PredictError> {
        let Some(manoeuvre) = crate::standard::with_predicted_end(kind, self.timescale()) else {
            return Ok(self.spiral(kind, draws, shares));
        };
        let sail = |number: u64, sources: &[UncertaintySource]| {
            let passage =
                SimulatedManoeuvre::simulate(&self.draw_ship(number, sources), &manoeuvre, self.timescale()).ok()?;
            Some((figures::characteristics(kind, &passage, self.particulars()), passage))
        };
        let is_circle = matches!(kind, Manoeuvre::TurningCircle { .. });
        let series = |number: u64, passage: SimulatedManoeuvre| DrawnSeries {
            largest_rate: passage.max_yaw_rate(),
            track: passage.track().filter(|_| is_circle || number < TRACKS).map(<[_]>::to_vec),
            heading: passage.heading,
            is_shown: number < TRACKS,
        };
        let all = parallel_draws(draws, |number| {
            let (figures, passage) = sail(number, &UncertaintySource::ALL)?;
            Some((figures, series(number, passage)))
        });
        let (values, made): (Vec<Option<Characteristics>>, Vec<_>) = all.into_iter().map(Option::unzip).unzip();
        let made: Vec<DrawnSeries> = made.into_iter().flatten().collect();
        check_completed(kind, made.len(), draws)?;
        let incomplete_draws = draws - made.len();
        let extrapolated = self.is_extrapolated(kind.max_rudder(), made.iter().map(|series| series.largest_rate));
        let sources: &[UncertaintySource] = if shares { &UncertaintySource::ALL } else { &[] };
        let most_probable = sail(0, &[]).map(|(_, passage)| passage);
        let headings: Vec<&[f64]> = made.iter().map(|series| series.heading.as_slice()).collect();
        let turns: Vec<TurnTrack> = made.iter().filter(|_| is_circle).filter_map(DrawnSeries::turn).collect();
        let curves = ManoeuvreCurves {
            heading: bands(&headings, most_probable.as_ref(), row_interval(self.timescale())),
            most_probable,
            median_track: median_track(&turns, kind.first_side().sign()),
            tracks: made.into_iter().filter(|series| series.is_shown).filter_map(|series| series.track).collect(),
            steady: Vec::new(),
        };
        let mut figures = predicted(&values, extrapolated, sources, |number, sources| Some(sail(number, sources)?.0));
        let mut undetermined = Vec::new();
        figures.retain(|name, figure| {
            let sound = figures::is_possible(name, &figure.interval);
            undetermined.extend((!sound).then(|| (name.clone(), figure.interval)));
            sound
        });
        Ok(Prediction { kind: kind.clone(), figures, incomplete_draws, undetermined, curves })
    }

    /// Prediction of the steady turns of a spiral, without disturbances.
    fn spiral(&self, kind: &Manoeuvre, draws: usize, shares: bool) -> Prediction {
        let curve = |number, sources: &[UncertaintySource]| {
            SteadyCurve::from_ship(&self.draw_ship(number, sources), kind.max_rudder(), self.timescale())
        };
        let all: Vec<SteadyCurve> = parallel_draws(draws, |number| curve(number, &UncertaintySource::ALL));
        let values: Vec<Option<Characteristics>> = all.iter().map(|run| Some(run.figures(kind.max_rudder()))).collect();
        let sources: &[_] = if shares { &[UncertaintySource::Parameters, UncertaintySource::Structure] } else { &[] };
        let most_probable = curve(0, &[]);
        let largest = most_probable.yaw_rate.iter().fold(0.0, |largest: f64, rate| largest.max(rate.abs()));
        let alone = |number, sources: &[UncertaintySource]| Some(curve(number, sources).figures(kind.max_rudder()));
        let figures =
            predicted(&values, self.is_extrapolated(kind.max_rudder(), std::iter::once(largest)), sources, alone);
        let steady = std::iter::once(most_probable).chain(all).collect();
        let curves = ManoeuvreCurves { steady, ..ManoeuvreCurves::default() };
        Prediction { kind: kind.clone(), figures, incomplete_draws: 0, undetermined: Vec::new(), curves }
    }

    /// `true` if a rudder (rad) or the median of the maximum yaw rates (rad/s) is beyond the range of the records.
    pub(crate) fn is_extrapolated(&self, rudder: f64, rates: impl Iterator<Item = f64>) -> bool {
        let rate = median(&mut rates.collect::<Vec<f64>>()).unwrap_or(0.0);
        let end = |value: fn(&ValidityRange) -> f64| {
            self.ships().iter().map(|ship| value(&ship.validity_range)).fold(0.0, f64::max)
        };
        rudder > RANGE_FACTOR * end(|seen| seen.rudder_rad) || rate > RANGE_FACTOR * end(|seen| seen.yaw_rate_rad_s)
    }
}

/// Results of `draws` drawn ships, computed in parallel, in the order of their numbers.
pub(crate) fn parallel_draws<T: Send>(draws: usize, draw: impl Fn(u64) -> T + Sync + Send) -> Vec<T> {
    (0..draws as u64).into_par_iter().map(draw).collect()
}

/// Characteristics of the samples, with the shares of single sources.
fn predicted(
    draws: &[Option<Characteristics>],
    extrapolated: bool,
    sources: &[UncertaintySource],
    draw: impl Fn(u64, &[UncertaintySource]) -> Option<Characteristics> + Sync + Send,
) -> IndexMap<String, PredictedFigure> {
    let alone = |source: &UncertaintySource| parallel_draws(draws.len().div_ceil(RATIO), |k| draw(k, &[*source]));
    let alone: Vec<(&str, Vec<_>)> = sources.iter().map(|source| (source.as_str(), alone(source))).collect();
    let figure = |&name: &&'static str| {
        let value = |draw: &Option<Characteristics>| draw.as_ref().and_then(|figures| *figures.get(name)?);
        let of_draws: Vec<Option<f64>> = draws.iter().map(value).collect();
        let mut values: Vec<f64> = of_draws.iter().copied().flatten().collect();
        let defined = values.len() as f64 / draws.len() as f64;
        let interval = PredictionInterval::from_samples(&mut values)?;
        let spread = |few: &[Option<Characteristics>]| {
            let interval = PredictionInterval::from_samples(&mut few.iter().filter_map(value).collect::<Vec<f64>>());
            interval.map_or(0.0, |interval| (interval.ci90[1] - interval.ci90[0]).powi(2))
        };
        let spreads: Vec<(&str, f64)> = alone.iter().map(|(source, few)| (*source, spread(few))).collect();
        let sum: f64 = spreads.iter().map(|(_, spread)| spread).sum();
        let shares = spreads.into_iter().filter(|_| sum > 0.0);
        let shares = shares.map(|(source, spread)| (source.to_owned(), spread / sum)).collect();
        Some((
            name.to_owned(),
            PredictedFigure { interval, extrapolated, share_of_draws: defined, shares, drawn_values: of_draws },
        ))
    };
    draws.iter().flatten().next().into_iter().flat_map(|first| first.keys()).filter_map(figure).collect()
}

/// Quantiles of the headings row by row, up to the last row that nine tenths of the drawn ships reach.
fn bands(draws: &[&[f64]], most_probable: Option<&SimulatedManoeuvre>, period: f64) -> BandedCurve {
    let mut bands = BandedCurve::default();
    let mut values = Vec::with_capacity(draws.len());
    for row in 0.. {
        values.clear();
        values.extend(draws.iter().filter_map(|heading| heading.get(row)));
        if (values.len() as f64) < 0.9 * draws.len() as f64 || values.is_empty() {
            break;
        }
        bands.time.push(row as f64 * period);
        bands.quantiles.push(quantiles(&mut values));
        let heading = most_probable.and_then(|passage| passage.heading.get(row));
        bands.most_probable.push(heading.copied().unwrap_or(f64::NAN));
    }
    bands
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    fn mixture(change: impl Fn(&mut document::identified_ship::IdentifiedShip)) -> ShipMixture {
        let mut ship = testing::identified_ship();
        change(&mut ship);
        testing::mixture(ship)
    }

    fn kind(text: &str) -> Manoeuvre {
        text.parse().expect("known")
    }

    /// Without uncertainty every drawn ship is the most probable ship.
    #[test]
    fn what_is_known_for_certain_has_no_interval() {
        let sure = mixture(|ship| {
            ship.members[0].covariance.clear();
            ship.members[0].fitted.clear();
            ship.noise.moment = document::RandomMoment::None;
            ship.gear.as_mut().expect("made up").sd_rad_s = 0.0;
            ship.approach_yaw_rate_rad_s = 0.0;
        });
        let prediction = sure.predict(&kind("zig-zag:10/10"), 8, true).expect("a manoeuvre");
        for (name, figure) in &prediction.figures {
            assert_eq!(figure.interval.ci90[0], figure.interval.ci90[1], "{name}");
            assert!(figure.shares.is_empty() && figure.share_of_draws == 1.0);
        }
        assert!(!prediction.is_extrapolated() && prediction.incomplete_draws == 0);
        assert!(prediction.curves.heading.time.len() > 100);
    }

    /// An absent source has a share of zero, and the shares add up to one.
    #[test]
    fn shares_add_up_and_name_the_source() {
        let noisy = mixture(|ship| {
            ship.members[0].covariance.clear();
            ship.members[0].fitted.clear();
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
    fn extrapolation_is_reported() {
        let ship = mixture(|_| {});
        assert!(ship.predict(&kind("turning-circle:35"), 8, false).expect("a turn").is_extrapolated());
        assert!(!ship.predict(&kind("zig-zag:10/10"), 8, false).expect("a zig-zag").is_extrapolated());
        let spiral = ship.predict(&kind("spiral:15"), 8, true).expect("a curve");
        assert_eq!(spiral.curves.steady.len(), 9);
        assert_eq!(spiral.figures[2].interval.median, 0.0, "a stable ship has no loop");
    }

    /// Equal results in any number of threads, and for the mirrored ship on the opposite side.
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
        let lost = mixture(|ship| ship.members[0].parameters[2] = -0.5);
        let error = lost.predict(&kind("zig-zag:10/10"), 8, false).expect_err("it never turns to starboard");
        assert!(error.to_string().contains("0 of 8"), "{error}");
    }
}
