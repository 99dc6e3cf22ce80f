//! A manoeuvre predicted: every figure of merit with its intervals and where they come from, and bands of its curves.

use rayon::prelude::*;
use ship::Particulars;

use crate::error::PredictError;
use crate::figures::{self, Figure};
use crate::interval::{Interval, band, quantile};
use crate::kind::Kind;
use crate::mixture::{Mixture, Source};
use crate::passage::{self, Passage};
use crate::steady::SteadyCurve;

/// Draws for every source alone, as a share of all.
const ALONE: usize = 4;

/// Share of the draws that have to come to the end of a manoeuvre.
const FEWEST: f64 = 0.5;

/// How far beyond what was seen is still within it: a rudder overshoots its order, a largest rate is that of one
/// record.
const MARGIN: f64 = 1.05;

/// A figure of merit.
#[derive(Debug, Clone, PartialEq)]
pub struct Predicted {
    /// Its name, with the unit.
    pub name: &'static str,
    /// Median and intervals of the draws that have it.
    pub interval: Interval,
    /// Share of the draws that have it.
    pub defined: f64,
    /// Share of every source of doubt in the spread, all together 1; empty where they were not asked for.
    pub shares: Vec<(Source, f64)>,
    /// The draws, in the order of their numbers.
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

/// A manoeuvre predicted.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// The manoeuvre.
    pub kind: Kind,
    /// Its figures.
    pub figures: Vec<Predicted>,
    /// Heading, but for a spiral.
    pub heading: Bands,
    /// The most probable ship without chance, but for a spiral.
    pub most_probable: Option<Passage>,
    /// Tracks of some of the draws, north and east, m; empty where nothing is known of speed and drift.
    pub tracks: Vec<Vec<[f64; 2]>>,
    /// Steady curves of the most probable ship and of some others, for a spiral.
    pub curves: Vec<SteadyCurve>,
    /// Whether rudder or yaw rate are beyond what the records have seen.
    pub extrapolated: bool,
    /// Draws that did not come to the end of it.
    pub lost: usize,
}

/// One draw of a manoeuvre.
struct Draw {
    figures: Vec<Figure>,
    heading: Vec<f64>,
    largest_rate: f64,
    track: Option<Vec<[f64; 2]>>,
}

/// Draws whose tracks are kept.
const TRACKS: usize = 40;

/// Refuses what less than half of the drawn ships come to the end of.
pub(crate) fn enough(what: impl ToString, made: usize, draws: usize) -> Result<(), PredictError> {
    if made == 0 || (made as f64) < FEWEST * draws as f64 {
        return Err(PredictError::Lost { kind: what.to_string(), made, draws });
    }
    Ok(())
}

impl Mixture {
    /// Length and speed, where the first file has them.
    pub fn particulars(&self) -> Option<Particulars> {
        let first = self.first();
        Some(Particulars { length: first.length_m?, speed: first.speed_m_s? })
    }

    /// Predicts a manoeuvre from so many draws; `shares` asks for the share of every source of doubt.
    ///
    /// Fails where less than half of the drawn ships come to the end of it.
    pub fn predict(&self, kind: &Kind, draws: usize, shares: bool) -> Result<Prediction, PredictError> {
        if let Kind::Spiral { rudder } = *kind {
            return Ok(self.spiral(rudder, draws, shares));
        }
        let Some(manoeuvre) = kind.manoeuvre(self.timescale()) else { unreachable!("all but a spiral are steered") };
        let sail = |number: usize, sources: &[Source]| {
            let passage = Passage::sail(&self.draw(number as u64, sources), &manoeuvre, self.timescale()).ok()?;
            Some((figures::of(kind, &passage, self.particulars()), passage))
        };
        let all: Vec<Option<Draw>> = (0..draws)
            .into_par_iter()
            .map(|number| {
                let (figures, passage) = sail(number, &Source::ALL)?;
                let largest_rate = passage.largest_rate();
                let track = passage.way.filter(|_| number < TRACKS).map(|way| way.track);
                Some(Draw { figures, heading: passage.heading, largest_rate, track })
            })
            .collect();
        let made: Vec<&Draw> = all.iter().flatten().collect();
        enough(kind, made.len(), draws)?;
        let values: Vec<Option<&[Figure]>> =
            all.iter().map(|draw| draw.as_ref().map(|draw| draw.figures.as_slice())).collect();
        let alone = shares.then(|| {
            Source::ALL.map(|source| {
                let one = |number| sail(number, &[source]).map(|(figures, _)| figures);
                let few: Vec<Option<Vec<Figure>>> = (0..draws.div_ceil(ALONE)).into_par_iter().map(one).collect();
                (source, few)
            })
        });
        let figures = predicted(&values, alone.as_ref().map(|alone| alone.as_slice()).unwrap_or_default());
        let most_probable = sail(0, &[]).map(|(_, passage)| passage);
        let mut rates: Vec<f64> = made.iter().map(|draw| draw.largest_rate).collect();
        rates.sort_by(f64::total_cmp);
        let heading = bands(&made, most_probable.as_ref(), passage::period(self.timescale()));
        Ok(Prediction {
            kind: *kind,
            figures,
            heading,
            extrapolated: self.is_unseen(kind.rudder(), quantile(&rates, 0.5)),
            lost: draws - made.len(),
            most_probable,
            tracks: all.iter().flatten().filter_map(|draw| draw.track.clone()).collect(),
            curves: Vec::new(),
        })
    }

    /// Steady turns; chance has no part in them.
    fn spiral(&self, rudder: f64, draws: usize, shares: bool) -> Prediction {
        let curve = |number: usize, sources: &[Source]| {
            SteadyCurve::of(&self.draw(number as u64, sources), rudder, self.timescale())
        };
        let all: Vec<SteadyCurve> = (0..draws).into_par_iter().map(|number| curve(number, &Source::ALL)).collect();
        let own: Vec<Vec<Figure>> = all.iter().map(|curve| curve.figures(rudder)).collect();
        let values: Vec<Option<&[Figure]>> = own.iter().map(|figures| Some(figures.as_slice())).collect();
        let alone: Vec<(Source, Vec<Option<Vec<Figure>>>)> = match shares {
            true => [Source::Parameters, Source::Structure]
                .into_iter()
                .map(|source| {
                    let one = |number| Some(curve(number, &[source]).figures(rudder));
                    (source, (0..draws.div_ceil(ALONE)).into_par_iter().map(one).collect())
                })
                .collect(),
            false => Vec::new(),
        };
        let most_probable = curve(0, &[]);
        let largest = most_probable.yaw_rate.iter().fold(0.0, |largest: f64, rate| largest.max(rate.abs()));
        let mut curves = vec![most_probable];
        curves.extend(all);
        Prediction {
            kind: Kind::Spiral { rudder },
            figures: predicted(&values, &alone),
            heading: Bands::default(),
            most_probable: None,
            tracks: Vec::new(),
            curves,
            extrapolated: self.is_unseen(rudder, largest),
            lost: 0,
        }
    }

    /// Whether a rudder (rad) or a yaw rate (rad/s) is beyond what the records have seen.
    pub(crate) fn is_unseen(&self, rudder: f64, rate: f64) -> bool {
        let most = |value: fn(&crate::known::Seen) -> f64| {
            self.files().iter().map(|known| value(&known.seen)).fold(0.0, f64::max)
        };
        rudder > MARGIN * most(|seen| seen.rudder_rad) || rate > MARGIN * most(|seen| seen.yaw_rate_rad_s)
    }
}

/// Figures from the draws, with the shares of sources that were drawn alone.
fn predicted(draws: &[Option<&[Figure]>], alone: &[(Source, Vec<Option<Vec<Figure>>>)]) -> Vec<Predicted> {
    let Some(names) = draws.iter().flatten().next() else { return Vec::new() };
    names
        .iter()
        .enumerate()
        .filter_map(|(place, &(name, _))| {
            let of_draws: Vec<Option<f64>> =
                draws.iter().map(|draw| draw.and_then(|figures| figures[place].1)).collect();
            let mut values: Vec<f64> = of_draws.iter().copied().flatten().collect();
            let defined = values.len() as f64 / draws.len() as f64;
            let interval = Interval::of(&mut values)?;
            let spread = |few: &[Option<Vec<Figure>>]| {
                let mut values: Vec<f64> = few.iter().flatten().filter_map(|figures| figures[place].1).collect();
                Interval::of(&mut values).map_or(0.0, |interval| (interval.ci90[1] - interval.ci90[0]).powi(2))
            };
            let spreads: Vec<(Source, f64)> = alone.iter().map(|(source, few)| (*source, spread(few))).collect();
            let sum: f64 = spreads.iter().map(|(_, spread)| spread).sum();
            let shares = match sum > 0.0 {
                true => spreads.into_iter().map(|(source, spread)| (source, spread / sum)).collect(),
                false => Vec::new(),
            };
            Some(Predicted { name, interval, defined, shares, draws: of_draws })
        })
        .collect()
}

/// Quantiles row by row, as long as nine tenths of the draws go on.
fn bands(draws: &[&Draw], most_probable: Option<&Passage>, period: f64) -> Bands {
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

    fn mixture(change: impl Fn(&mut crate::known::KnownShip)) -> Mixture {
        let mut known = made_up::known();
        change(&mut known);
        Mixture::new(vec![(known, 1.0)]).expect("made up")
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
        for figure in &prediction.figures {
            assert_eq!(figure.interval.ci90[0], figure.interval.ci90[1], "{}", figure.name);
            assert!(figure.shares.is_empty() && figure.defined == 1.0);
        }
        assert!(!prediction.extrapolated && prediction.lost == 0);
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
        let first = prediction.figures.iter().find(|figure| figure.name == "first_overshoot_deg").expect("a zig-zag");
        let share = |of: Source| first.shares.iter().find(|(source, _)| *source == of).map_or(0.0, |(_, share)| *share);
        assert!((first.shares.iter().map(|(_, share)| share).sum::<f64>() - 1.0).abs() < 1e-12);
        assert_eq!((share(Source::Parameters), share(Source::Structure)), (0.0, 0.0));
        assert!(share(Source::ProcessNoise) > 0.3, "{:?}", first.shares);
        let [low, high] = first.interval.ci90;
        assert!(high - low > 0.2 && low < first.interval.median && first.interval.median < high);
    }

    #[test]
    fn beyond_what_was_seen_is_said() {
        let ship = mixture(|_| {});
        assert!(ship.predict(&kind("turning-circle:35"), 8, false).expect("a turn").extrapolated);
        assert!(!ship.predict(&kind("zig-zag:10/10"), 8, false).expect("a zig-zag").extrapolated);
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
