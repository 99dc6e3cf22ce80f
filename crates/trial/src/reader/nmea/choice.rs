//! Choice of an instrument for every channel. A channel never mixes instruments: the better kind is preferred (true
//! heading before magnetic, speed through the water before speed over ground), then the instrument with the most
//! readings, then the first in the log. A choice among several is a warning.

use document::{Warning, WarningCode};
use estimation::statistics::upper_median;
use ship::angle::to_deg;

use super::epochs::rounded;
use super::log::NmeaInstrument;
use super::sentence::{NmeaQuantity, wrapped_to_circle};
use crate::channel::Channel;
use crate::reader::position::plane_positions;
use crate::reader::source::Series;
use crate::wording::counted;

/// Candidate for a channel: an instrument with a quantity.
#[derive(Clone, Copy)]
struct Offer<'a> {
    instrument: &'a NmeaInstrument,
    /// Index of the instrument.
    number: usize,
    /// Index of the quantity among the columns of the instrument.
    column: usize,
    /// 0 is preferred to 1.
    class: usize,
    readings: usize,
}

impl<'a> Offer<'a> {
    fn name(&self) -> &'a str {
        &self.instrument.name
    }

    fn values(&self) -> &'a [f64] {
        &self.instrument.columns[self.column]
    }

    /// Candidate with another quantity of the same instrument.
    fn sibling(self, column: usize) -> Self {
        Self { column, readings: self.instrument.readings(column), ..self }
    }

    /// `true` for a candidate with less than 1 % of `most` readings; it is the last choice in any class.
    fn is_sparse(&self, most: usize) -> bool {
        const SPARSE: usize = 100;
        self.readings.saturating_mul(SPARSE) < most
    }
}

/// Maximum difference of two rudders whose mean is used (rms), degrees.
const MAX_RUDDER_DIFFERENCE_DEG: f64 = 2.0;

/// Series of the instruments chosen for every channel, with the warnings of the choice.
pub(super) struct ChosenInstruments<'a> {
    instruments: &'a [NmeaInstrument],
    pub series: Vec<Series>,
    /// Warnings of decisions between instruments, and of invalid entries.
    pub warnings: Vec<Warning>,
}

impl<'a> ChosenInstruments<'a> {
    /// Channels of the instruments, each from the best instrument.
    pub fn from_instruments(instruments: &'a [NmeaInstrument]) -> Self {
        let mut choice = Self { instruments, series: Vec::new(), warnings: Vec::new() };
        choice.heading();
        choice.rudder();
        choice.single("rudder order", NmeaQuantity::RudderOrder, Channel::RudderOrder, |_| true);
        choice.single("yaw rate", NmeaQuantity::YawRate, Channel::YawRate, |_| true);
        choice.single("roll angle", NmeaQuantity::Transducer, Channel::Roll, |instrument| {
            instrument.instrument_mark[0] == b'O'
        });
        choice.speed();
        choice.surge_and_sway();
        choice.position();
        choice.propeller();
        choice.wind();
        choice
    }

    /// Candidates for some quantities, each with the class of its quantity.
    fn offers(&self, slots: &[(NmeaQuantity, usize)], wanted: impl Fn(&NmeaInstrument) -> bool) -> Vec<Offer<'a>> {
        let mut offers = Vec::new();
        for &(slot, class) in slots {
            for (number, instrument) in self.instruments.iter().enumerate().filter(|(_, x)| wanted(x)) {
                let Some(column) = instrument.column(slot) else { continue };
                let readings = instrument.readings(column);
                if readings > 0 {
                    offers.push(Offer { instrument, number, column, class, readings });
                }
            }
        }
        offers
    }

    /// Best candidate, with a warning if there are several, or `always`; `None` without candidates.
    fn pick(&mut self, what: &str, offers: Vec<Offer<'a>>, always: bool) -> Option<Offer<'a>> {
        let most = offers.iter().map(|offer| offer.readings).max()?;
        let order = |offer: &&Offer| {
            (offer.is_sparse(most), offer.class, usize::MAX - offer.readings, offer.number, offer.column)
        };
        let chosen = *offers.iter().min_by_key(order)?;
        let mut unused: Vec<Offer> = Vec::new();
        for offer in offers {
            if offer.number != chosen.number && unused.iter().all(|earlier| earlier.number != offer.number) {
                unused.push(offer);
            }
        }
        if always || !unused.is_empty() {
            let mut text = format!("{what} from {} ({})", chosen.name(), counted(chosen.readings, "reading"));
            let names: Vec<String> = unused.iter().map(|seen| format!("{} ({})", seen.name(), seen.readings)).collect();
            match names.as_slice() {
                [] => {}
                [name] => text.push_str(&format!("; {name} is not used")),
                [first @ .., last] => text.push_str(&format!("; {} and {last} are not used", first.join(", "))),
            }
            self.warn(WarningCode::Instrument, text);
        }
        self.warn_of_invalid(what, chosen);
        Some(chosen)
    }

    fn warn(&mut self, code: WarningCode, text: String) {
        self.warnings.push(code.warning(text));
    }

    fn warn_of_invalid(&mut self, what: &str, chosen: Offer) {
        let invalid = chosen.instrument.invalid[chosen.column];
        if invalid > 0 {
            let text = counted(invalid, "entry").replace("entrys", "entries");
            self.warn(
                WarningCode::MissingValues,
                format!("{text} of {} cannot be a {what}, taken as missing", chosen.name()),
            );
        }
    }

    /// Adds a channel with the instants of an instrument.
    fn push(&mut self, channel: Channel, chosen: Offer, values: impl IntoIterator<Item = f64>) {
        let source = Some(chosen.name().to_owned());
        let mut series = Series { channel, time: Vec::new(), values: Vec::new(), source };
        for (&time, value) in chosen.instrument.instants.iter().zip(values) {
            let time = rounded(time);
            // Two readings at the same instant would be a step without duration.
            if series.time.last().is_none_or(|&last| time > last) {
                series.time.push(time);
                series.values.push(value);
            }
        }
        self.series.push(series);
    }

    fn push_column(&mut self, channel: Channel, chosen: Offer) {
        self.push(channel, chosen, chosen.values().iter().copied());
    }

    /// Adds a channel that is a column of an instrument.
    fn single(&mut self, what: &str, slot: NmeaQuantity, channel: Channel, wanted: impl Fn(&NmeaInstrument) -> bool) {
        let offers = self.offers(&[(slot, 0)], wanted);
        if let Some(chosen) = self.pick(what, offers, false) {
            self.push_column(channel, chosen);
        }
    }

    /// Adds the heading: true before magnetic; a magnetic heading with variation counts as true.
    fn heading(&mut self) {
        let variation =
            |offer: &Offer<'a>| offer.instrument.column(NmeaQuantity::Variation).map(|column| offer.sibling(column));
        let variation = |offer: &Offer<'a>| variation(offer).filter(|variation| variation.readings > 0);
        let mut offers = self.offers(&[(NmeaQuantity::HeadingTrue, 0), (NmeaQuantity::HeadingMagnetic, 1)], |_| true);
        for offer in offers.iter_mut().filter(|offer| offer.class == 1) {
            offer.class = usize::from(variation(offer).is_none());
        }
        let Some(chosen) = self.pick("heading", offers, false) else { return };
        if chosen.class == 1 {
            self.warn(WarningCode::OtherReference, format!(
                "the heading of {} is magnetic, because no variation is given; changes of heading are correct, its zero is \
                 not true north",
                chosen.name()
            ));
        }
        let Some(variation) = variation(&chosen) else { return self.push_column(Channel::Heading, chosen) };
        let mut held = variation.values().iter().copied().find(|value| value.is_finite()).unwrap_or(f64::NAN);
        let values = chosen.values().iter().zip(variation.values()).map(|(heading, variation)| {
            if variation.is_finite() {
                held = *variation;
            }
            wrapped_to_circle(heading + held)
        });
        self.push(Channel::Heading, chosen, values);
    }

    /// Adds the rudder: a single rudder, or the mean of two that agree.
    fn rudder(&mut self) {
        let mut offers = self.offers(&[(NmeaQuantity::RudderStarboard, 0), (NmeaQuantity::RudderPort, 0)], |_| true);
        offers
            .extend(self.offers(&[(NmeaQuantity::Transducer, 1)], |instrument| instrument.instrument_mark[0] == b'R'));
        let Some(chosen) = self.pick("rudder angle", offers, false) else { return };
        if !chosen.instrument.sends(b"RSA") {
            return self.push_column(Channel::Rudder, chosen);
        }
        let [starboard, port] = [0, 1].map(|column| chosen.sibling(column).values());
        let pairs = || starboard.iter().zip(port).filter(|(a, b)| a.is_finite() && b.is_finite());
        let number = pairs().count();
        let side = ["starboard", "port"][chosen.column];
        // A second rudder with few readings is not averaged.
        if 2 * number < chosen.readings {
            let second = chosen.sibling(1 - chosen.column).readings;
            if chosen.column == 1 || second > 0 {
                let readings = counted(second, "reading");
                let text = format!("the rudder angle is that of the {side} rudder; the other rudder has {readings}");
                self.warn(WarningCode::Instrument, text);
            }
            return self.push_column(Channel::Rudder, chosen);
        }
        let rms_deg = to_deg((pairs().map(|(a, b)| (a - b).powi(2)).sum::<f64>() / number as f64).sqrt());
        if rms_deg > MAX_RUDDER_DIFFERENCE_DEG {
            let text =
                format!("the rudders differ by {rms_deg:.1}° (rms); the rudder angle is that of the {side} rudder");
            self.warn(WarningCode::RuddersApart, text);
            return self.push_column(Channel::Rudder, chosen);
        }
        self.warn(
            WarningCode::Instrument,
            format!("the rudder angle is the mean of two rudders, {rms_deg:.1}° apart (rms)"),
        );
        let mean = starboard.iter().zip(port).map(|(a, b)| 0.5 * (a + b));
        self.push(Channel::Rudder, chosen, mean);
    }

    /// Adds the speed: through the water before over ground.
    fn speed(&mut self) {
        let slots = [
            (NmeaQuantity::SpeedWater, 0),
            (NmeaQuantity::SurgeWater, 0),
            (NmeaQuantity::SpeedGround, 1),
            (NmeaQuantity::SurgeGround, 1),
        ];
        let offers = self.offers(&slots, |_| true);
        let most = offers.iter().map(|offer| offer.readings).max().unwrap_or(0);
        let water = offers.iter().any(|offer| offer.class == 0 && !offer.is_sparse(most));
        let what = if water { "speed through the water" } else { "speed over ground" };
        let Some(chosen) = self.pick(what, offers, true) else { return };
        if !chosen.instrument.sends(b"VBW") {
            return self.push_column(Channel::Speed, chosen);
        }
        // A log with one axis gives no sway.
        let speed = |(u, v): (&f64, &f64)| if v.is_finite() { u.hypot(*v) } else { u.abs() };
        let across = chosen.sibling(chosen.column + 1).values();
        self.push(Channel::Speed, chosen, chosen.values().iter().zip(across).map(speed));
    }

    /// Adds surge and sway of the same instrument and reference.
    fn surge_and_sway(&mut self) {
        let offers = self.offers(&[(NmeaQuantity::SurgeWater, 0), (NmeaQuantity::SurgeGround, 1)], |_| true);
        let Some(surge) = self.pick("surge velocity", offers, false) else { return };
        if surge.class == 1 {
            self.warn(WarningCode::OtherReference, format!("surge and sway of {} are over ground", surge.name()));
        }
        self.push_column(Channel::Surge, surge);
        let sway = surge.sibling(surge.column + 1);
        if sway.readings > 0 {
            self.warn_of_invalid("sway velocity", sway);
            self.push_column(Channel::Sway, sway);
        }
    }

    fn position(&mut self) {
        let offers = self.offers(&[(NmeaQuantity::Latitude, 0)], |_| true);
        let Some(chosen) = self.pick("position", offers, false) else { return };
        for (channel, values) in
            plane_positions(chosen.values(), chosen.sibling(chosen.column + 1).values()).into_iter().flatten()
        {
            self.push(channel, chosen, values);
        }
    }

    /// Adds the propeller rate: shafts before engines, the mean of several shafts.
    fn propeller(&mut self) {
        let mut offers = self.offers(&[(NmeaQuantity::Revolutions, 0)], |_| true);
        let group =
            |offer: &Offer| (offer.instrument.address, offer.instrument.source, offer.instrument.instrument_mark[0]);
        let mut leaders: Vec<Offer> = Vec::new();
        for offer in &mut offers {
            offer.class = usize::from(offer.instrument.instrument_mark[0] == b'E');
            match leaders.iter_mut().find(|leader| group(leader) == group(offer)) {
                Some(leader) if leader.readings < offer.readings => *leader = *offer,
                Some(_) => {}
                None => leaders.push(*offer),
            }
        }
        let Some(chosen) = self.pick("propeller rate", leaders, false) else { return };
        offers.retain(|shaft| group(shaft) == group(&chosen) && !shaft.is_sparse(chosen.readings));
        // The sign is the sense of rotation seen from astern: outward turning shafts have opposite signs.
        let is_counter = |shaft: &&Offer| shaft.values().iter().filter(|value| value.is_finite()).sum::<f64>() < 0.0;
        let mut values = vec![0.0; chosen.instrument.instants.len()];
        for shaft in &offers {
            let factor = if is_counter(&shaft) { -1.0 } else { 1.0 } / offers.len() as f64;
            let mut near = Nearest::new(&shaft.instrument.instants, shaft.values());
            for (value, &time) in values.iter_mut().zip(&chosen.instrument.instants) {
                *value += factor * near.at(time);
            }
        }
        if offers.len() > 1 {
            self.warn(WarningCode::Instrument, format!("the propeller rate is the mean of {} shafts", offers.len()));
        }
        let counter: Vec<&str> = offers.iter().filter(is_counter).map(Offer::name).collect();
        if !counter.is_empty() {
            let text = "turns counter-clockwise (negative) in most readings; its rate is taken as positive";
            self.warn(WarningCode::TurnedSign, format!("{} {text}", counter.join(" and ")));
        }
        self.push(Channel::PropellerRate, chosen, values);
    }

    fn wind(&mut self) {
        let reference = |letter: u8| move |mwv: &NmeaInstrument| mwv.sends(b"MWV") && mwv.instrument_mark[0] == letter;
        let relative = self.offers(&[(NmeaQuantity::WindFrom, 0)], reference(b'R'));
        if let Some(chosen) = self.pick("relative wind", relative, false) {
            self.push_column(Channel::WindRelativeSpeed, chosen.sibling(0));
            self.push_column(Channel::WindRelativeFrom, chosen);
        }
        let mut real = self.offers(&[(NmeaQuantity::WindFrom, 0)], |instrument| instrument.sends(b"MWD"));
        real.extend(self.offers(&[(NmeaQuantity::WindFrom, 1)], reference(b'T')));
        let Some(chosen) = self.pick("true wind", real, false) else { return };
        self.push_column(Channel::WindTrueSpeed, chosen.sibling(0));
        if chosen.instrument.sends(b"MWD") {
            return self.push_column(Channel::WindTrueFrom, chosen);
        }
        let from_bow = chosen.name();
        let Some(heading) = self.series.iter().find(|series| series.channel == Channel::Heading) else {
            let text = "gives the true wind from the bow; without a heading its direction is left out";
            return self.warn(WarningCode::LeftOut, format!("{from_bow} {text}"));
        };
        let mut near = Nearest::new(&heading.time, &heading.values);
        let readings = chosen.instrument.instants.iter().zip(chosen.values());
        let values: Vec<f64> = readings.map(|(&time, from)| wrapped_to_circle(from + near.at(time))).collect();
        self.push(Channel::WindTrueFrom, chosen, values);
        let text = "gives the direction of the true wind from the bow; the heading is added to it";
        self.warn(WarningCode::Instrument, format!("{from_bow} {text}"));
    }
}

/// Search for the reading nearest in time, for times that do not decrease.
struct Nearest<'a> {
    time: &'a [f64],
    values: &'a [f64],
    index: usize,
    /// Maximum distance in time, s.
    reach: f64,
}

impl<'a> Nearest<'a> {
    fn new(time: &'a [f64], values: &'a [f64]) -> Self {
        let usual = upper_median(time.windows(2).map(|pair| pair[1] - pair[0])).unwrap_or(f64::INFINITY);
        Self { time, values, index: 0, reach: 3.0 * usual }
    }

    fn at(&mut self, time: f64) -> f64 {
        let distance = |index: usize| (self.time[index] - time).abs();
        while self.index + 1 < self.time.len() && distance(self.index + 1) <= distance(self.index) {
            self.index += 1;
        }
        match self.values.get(self.index) {
            Some(&value) if (self.time[self.index] - time).abs() <= self.reach => value,
            _ => f64::NAN,
        }
    }
}
