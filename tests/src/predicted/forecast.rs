//! Measured trials predicted: a ship is traced from some records, and the others are held against what she then does.

use std::path::Path;

use campaign::known::{self, RecordFacts};
use document::IdentifiedShip;
use predict::steady::SteadyCurve;
use predict::turn::{HeldTurn, without_current};
use predict::{Prediction, ShipMixture};
use ship::Particulars;
use ship::angle::to_deg;
use trace::Settings;
use trial::{Channel, Manoeuvre, Trial};

use super::figure::{ForecastFigure, ForecastGroup};
use super::turn::TurnTrack;
use crate::measured::sets::{MeasuredSet, Outcome, SETS};

/// Ships that are drawn for every trial.
const DRAWS: usize = 500;

/// Ships that are drawn for a prediction, and those of them that a figure of steady turns shows.
const SHOWN: usize = 200;
const FIGURE: usize = 40;

/// A ship as some records show her.
pub struct TracedShip {
    /// The records.
    pub fitted: String,
    known: IdentifiedShip,
}

/// A circle, measured beside predicted.
pub struct PredictedTrack {
    /// Which circle, from what.
    pub title: String,
    /// Rudder, deg, positive to starboard.
    pub rudder_deg: f64,
    /// As it was measured, without the current.
    pub measured: TurnTrack,
    /// The most probable ship.
    pub probable: TurnTrack,
    /// Drawn ships, east and north in lengths.
    pub drawn: Vec<(Vec<f64>, Vec<f64>)>,
}

/// Steady turns, measured beside predicted.
pub struct PredictedSteady {
    /// Of which ship, from what.
    pub title: String,
    /// The most probable ship of each model.
    pub probable: Vec<SteadyCurve>,
    /// Drawn ones, of all models alike.
    pub drawn: Vec<SteadyCurve>,
    /// Models with which no circle could be sailed, which are left out.
    pub left_out: usize,
    /// Rudder, deg, and yaw rate, deg/s, of measured circles.
    pub measured: Vec<(f64, f64)>,
    /// What each model says of each of them.
    pub circles: Vec<PredictedRate>,
}

/// The yaw rate of a circle that a model predicts.
pub struct PredictedRate {
    /// Rudder, deg, positive to port.
    pub rudder_deg: f64,
    /// Median, over what was measured.
    pub ratio: f64,
    /// Its 90 % interval.
    pub ci90: [f64; 2],
    /// Whether that holds what was measured.
    pub inside: bool,
}

/// Everything that is predicted.
#[derive(Default)]
pub struct Forecasts {
    /// Figure by figure.
    pub figures: Vec<ForecastFigure>,
    /// Two circles.
    pub tracks: Vec<PredictedTrack>,
    /// Two ships.
    pub steady: Vec<PredictedSteady>,
}

fn set(folder: &str) -> &'static MeasuredSet {
    SETS.iter().find(|set| set.folder == folder).expect("a set of this name")
}

/// What a trace knows of the ship of some records.
fn traced(trials: &[Trial]) -> Outcome<IdentifiedShip> {
    let settings = Settings { thorough: false, hulls: true, ..Settings::default() };
    let analysis = trace::trace(trials, &[], &settings)?;
    Ok(known::of_analysis(&analysis, &RecordFacts::of(trials).with_motion(Some(&analysis), &[])))
}

impl TracedShip {
    /// The ship that a trace makes of some records together: of all channels, or, where a trial that was not made has
    /// not what its model needs, without speed and sway, as the program then advises.
    fn of(records: &[(&'static str, Trial)]) -> Outcome<Self> {
        let (names, trials): (Vec<&str>, Vec<Trial>) = records.iter().cloned().unzip();
        let fitted = names.join(", ");
        eprintln!("{fitted}");
        let mut known = traced(&trials)?;
        if ShipMixture::new(vec![(known.clone(), 1.0)]).is_err() {
            let withheld = [Channel::Speed, Channel::Surge, Channel::Sway];
            let without: Vec<Trial> = trials.iter().map(|trial| trial.clone().without(&withheld)).collect();
            known = traced(&without)?;
            eprintln!("{fitted}: traced without speed and sway");
        }
        Ok(Self { fitted, known })
    }

    /// The same ship at the scale and at the approach speed of a trial.
    fn at(&self, own: Particulars) -> Outcome<IdentifiedShip> {
        match self.known.length_m.zip(self.known.speed_m_s) {
            Some(_) => Ok(self.known.scaled_to(own.length, Some(own.speed))?),
            None => Ok(self.known.clone()),
        }
    }

    fn mixture(&self, trial: &Trial) -> Outcome<ShipMixture> {
        let own = trial.particulars().ok_or("a measured record has length and speed in its sidecar")?;
        Ok(ShipMixture::new(vec![(self.at(own)?, 1.0)])?)
    }

    /// Every figure of a trial, measured and predicted; none where the prediction is refused, which is told.
    fn figures(&self, group: ForecastGroup, name: &'static str, trial: &Trial) -> Outcome<Vec<ForecastFigure>> {
        let (trial, current) = without_current(trial.clone(), None);
        let replayed = match self.mixture(&trial).map(|ships| ships.replay(&trial, DRAWS, current)) {
            Ok(Ok(replayed)) => replayed.ok_or_else(|| format!("{name}: too few headings at its beginning"))?,
            Ok(Err(error)) => return Ok(self.refused(name, &error)),
            Err(error) => return Ok(self.refused(name, &*error)),
        };
        let figure = |(name_of, compared)| ForecastFigure {
            group,
            fitted: self.fitted.clone(),
            trial: name,
            name: name_of,
            compared,
        };
        Ok(replayed.figures.into_iter().map(figure).collect())
    }

    /// No figures, and why.
    fn refused(&self, trial: &str, error: &dyn std::fmt::Display) -> Vec<ForecastFigure> {
        eprintln!("{trial} from {}: {error}", self.fitted);
        Vec::new()
    }
}

/// A manoeuvre predicted for a trial from one or several ships alike.
fn predicted(ships: &[&TracedShip], trial: &Trial, kind: &str) -> Outcome<Prediction> {
    let own = trial.particulars().ok_or("a measured record has length and speed in its sidecar")?;
    let can_be_predicted = ships.iter().filter(|ship| ship.mixture(trial).is_ok());
    let known = can_be_predicted.map(|ship| Ok((ship.at(own)?, 1.0)));
    let kind: Manoeuvre = kind.parse().map_err(|error| format!("{kind}: {error}"))?;
    Ok(ShipMixture::new(known.collect::<Outcome<Vec<_>>>()?)?.predict(&kind, SHOWN, false)?)
}

/// A circle beside its prediction; `None` where one of the two has no track.
fn track(title: String, ships: &[&TracedShip], trial: &Trial) -> Outcome<Option<PredictedTrack>> {
    let (trial, _) = without_current(trial.clone(), None);
    let turn = HeldTurn::of(&trial).ok_or("a circle has a rudder that is held")?;
    let rudder_deg = to_deg(turn.side * turn.rudder).round();
    let curves = predicted(ships, &trial, &format!("turning-circle:{rudder_deg}"))?.curves;
    let length = trial.particulars().map_or(f64::NAN, |own| own.length);
    let probable = curves.most_probable.as_ref().and_then(TurnTrack::predicted);
    let drawn = curves.tracks.iter().map(|track| track.iter().map(|own| (own[1] / length, own[0] / length)).unzip());
    let both = TurnTrack::recorded(&trial, length).zip(probable);
    Ok(both.map(|(measured, probable)| PredictedTrack {
        title,
        rudder_deg,
        measured,
        probable,
        drawn: drawn.collect(),
    }))
}

/// Steady turns of some ships, each by itself, at the scale of the first circle, and the circles that were measured,
/// brought to its approach speed. A ship with which no circle could be sailed has no steady turns either.
fn steady(
    title: String,
    ships: &[&TracedShip],
    circles: &[(&'static str, Trial)],
    figures: &[ForecastFigure],
) -> Outcome<PredictedSteady> {
    let first = &circles[0].1;
    let is_circle = |own: &ForecastFigure| circles.iter().any(|(name, _)| *name == own.trial);
    let turns = |ship: &&&TracedShip| figures.iter().any(|own| own.fitted == ship.fitted && is_circle(own));
    let sailed: Vec<_> = ships.iter().filter(turns).collect();
    let (mut probable, mut drawn) = (Vec::new(), Vec::new());
    for ship in &sailed {
        let mut curves = predicted(&[**ship], first, "spiral:38")?.curves.steady.into_iter();
        probable.extend(curves.next());
        drawn.extend(curves.take(FIGURE / sailed.len()));
    }
    let (mut measured, mut rated) = (Vec::new(), Vec::new());
    for (name, trial) in circles {
        let facts = (HeldTurn::of(trial), first.particulars(), trial.particulars());
        let (Some(turn), Some(wanted), Some(own)) = facts else { continue };
        // Yaw rates go with the speed; a turn to port has a negative one.
        let (rudder, factor) = (to_deg(turn.side * turn.rudder), turn.side * wanted.speed / own.speed);
        let rates = || figures.iter().filter(|own| own.trial == *name && own.name == "steady_rate_deg_s");
        measured.extend(rates().next().map(|own| (rudder, factor * own.compared.measured)));
        let of_ship = |ship: &&&TracedShip| {
            let own = &rates().find(|own| own.fitted == ship.fitted)?.compared;
            let [ratio, lower, upper] =
                [own.interval.median, own.interval.ci90[0], own.interval.ci90[1]].map(|rate| rate / own.measured);
            Some(PredictedRate { rudder_deg: rudder, ratio, ci90: [lower, upper], inside: own.inside90 })
        };
        rated.extend(sailed.iter().filter_map(of_ship));
    }
    let left_out = ships.len() - sailed.len();
    Ok(PredictedSteady { title, probable, drawn, left_out, measured, circles: rated })
}

/// Every record of a set that is named, read.
fn read(set: &MeasuredSet, names: &[&'static str], scratch: &Path) -> Outcome<Vec<(&'static str, Trial)>> {
    names.iter().map(|name| Ok((*name, set.read(name, scratch)?))).collect()
}

impl Forecasts {
    /// Predicts trials from a ship.
    fn add(&mut self, group: ForecastGroup, ship: &TracedShip, trials: &[(&'static str, Trial)]) -> Outcome<()> {
        for (name, trial) in trials.iter().filter(|(name, _)| !ship.fitted.split(", ").any(|own| own == *name)) {
            self.figures.extend(ship.figures(group, name, trial)?);
        }
        Ok(())
    }

    /// KVLCC2: single records of HSVA, all of them, and the two 20/20 of MARIN.
    fn kvlcc2(&mut self, scratch: &Path) -> Outcome<()> {
        let [hsva, marin] = [set("kvlcc2_hsva"), set("kvlcc2_marin")];
        let (small, large) = (read(hsva, hsva.records, scratch)?, read(marin, marin.records, scratch)?);
        let circles = read(marin, marin.circles, scratch)?;
        let full_scale = [large, circles.clone()].concat();
        for record in &small {
            let ship = TracedShip::of(std::slice::from_ref(record))?;
            self.add(ForecastGroup::Hsva, &ship, &small)?;
            self.add(ForecastGroup::MarinOfOne, &ship, &full_scale)?;
        }
        let all = TracedShip::of(&small)?;
        self.add(ForecastGroup::MarinOfAll, &all, &full_scale)?;
        let pair = TracedShip::of(&read(marin, marin.pools[0], scratch)?)?;
        self.add(ForecastGroup::Marin, &pair, &full_scale)?;
        let title = || String::from("KVLCC2 in full-scale values, from HSVA's zig-zags");
        self.tracks.extend(track(title(), &[&all], &circles[0].1)?);
        self.steady.push(steady(title(), &[&all], &circles, &self.figures)?);
        Ok(())
    }

    /// Esso Osaka: every zig-zag alone.
    fn esso_osaka(&mut self, scratch: &Path) -> Outcome<()> {
        let set = set("esso_osaka");
        let (zigzags, circles) = (read(set, set.records, scratch)?, read(set, set.circles, scratch)?);
        let ships = zigzags.iter().map(|record| TracedShip::of(std::slice::from_ref(record)));
        let ships = ships.collect::<Outcome<Vec<_>>>()?;
        let trials = [zigzags, circles.clone()].concat();
        for ship in &ships {
            self.add(ForecastGroup::EssoOsaka, ship, &trials)?;
        }
        let alike: Vec<&TracedShip> = ships.iter().collect();
        let title = || String::from("Esso Osaka, 3 m, each curve from one zig-zag");
        self.tracks.extend(track(title(), &alike, &circles[2].1)?);
        self.steady.push(steady(title(), &alike, &circles, &self.figures)?);
        Ok(())
    }

    /// Everything of the sets that are there.
    ///
    /// Fails where a record cannot be read or traced.
    pub fn make(scratch: &Path) -> Outcome<Self> {
        let mut made = Self::default();
        let are_there = |folders: &[&str]| {
            let missing = folders.iter().filter(|folder| !set(folder).is_there());
            missing.inspect(|folder| eprintln!("skipped: no measured records {folder}")).count() == 0
        };
        if are_there(&["kvlcc2_hsva", "kvlcc2_marin"]) {
            made.kvlcc2(scratch)?;
        }
        if are_there(&["esso_osaka"]) {
            made.esso_osaka(scratch)?;
        }
        Ok(made)
    }
}
