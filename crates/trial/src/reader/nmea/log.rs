//! What was read from a log so far: one table for each instrument, as long as its sentences are many, and counts of
//! all that was left out. Which instruments are used is not decided before the end of the log.

use super::frame::{Fields, Frame, Line, frame};
use super::sentence::{MOST_SLOTS, Row, Slot, XDR, sentence, transducers};
use super::stamp::Leading;
use crate::clock::Stamps;
use crate::reader::error::Problem;
use crate::reader::limits::MAX_CELLS;
use crate::words::shortened;

/// The sentences of one instrument.
#[derive(Debug)]
pub(super) struct NmeaInstrument {
    /// What it is called in messages: `$HEHDT`, `$HEHDT of GYRO1`.
    pub name: String,
    /// Talker and sentence.
    pub address: [u8; 5],
    /// Its quantities.
    slots: &'static [Slot],
    /// As in [`Row::part`].
    pub part: [u8; 2],
    /// Number of its source as in [`Leading`].
    pub source: u8,
    /// When each sentence was sent: the number of its line until the clock is known, then s; NaN where left out.
    pub at: Vec<f64>,
    /// The quantities, one number a sentence.
    pub columns: Vec<Vec<f64>>,
    /// Numbers that cannot be, by quantity.
    pub odd: [usize; MOST_SLOTS],
    /// Whether a checksum was seen.
    summed: bool,
}

impl NmeaInstrument {
    /// Whether it sends sentences with this formatter.
    pub fn sends(&self, formatter: &[u8; 3]) -> bool {
        self.address[2..] == *formatter
    }

    /// The place of a quantity among its columns.
    pub fn place(&self, slot: Slot) -> Option<usize> {
        self.slots.iter().position(|&own| own == slot)
    }

    /// Readings of a quantity.
    pub fn readings(&self, place: usize) -> usize {
        self.columns[place].iter().filter(|value| value.is_finite()).count()
    }
}

/// Most instruments that are told apart; what noise makes of addresses is not kept beyond that.
const MOST_INSTRUMENTS: usize = 256;
/// Stamps of two ports may be a little out of order, s.
const DISORDER: f64 = 1.0;

/// What was counted on the way.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct Counts {
    pub blank: usize,
    /// Lines of text without a sentence.
    pub text: usize,
    /// Sentences, read or not.
    pub sentences: usize,
    pub foreign: usize,
    pub wrong: usize,
    pub broken: usize,
    /// Sentences accepted without a checksum.
    pub unsummed: usize,
    /// Sentences without a stamp where others have one.
    pub unstamped: usize,
    /// Stamps that are far from their neighbours.
    pub strayed: usize,
}

/// What a log gave so far.
#[derive(Debug)]
pub(super) struct NmeaLog {
    pub instruments: Vec<NmeaInstrument>,
    /// What tells them apart, in the same order: apart from the tables, because every sentence looks through it.
    keys: Vec<u64>,
    pub counts: Counts,
    pub leading: Leading,
    pub stamps: Stamps,
    /// Whether the time is in stamps before the sentences.
    pub stamped: bool,
    /// The latest stamp, the one before it, and the lines with the latest one, s.
    latest: (f64, f64, usize),
    /// Line and time of the stamp read last, where it lies before the latest one.
    late: Option<(usize, f64)>,
    numbers: usize,
}

impl NmeaLog {
    /// A log whose time is in stamps before its sentences, or in some of the sentences.
    pub fn new(stamped: bool) -> Self {
        Self {
            instruments: Vec::new(),
            keys: Vec::new(),
            counts: Counts::default(),
            leading: Leading::default(),
            stamps: Stamps::default(),
            stamped,
            latest: (f64::NEG_INFINITY, f64::NEG_INFINITY, 0),
            late: None,
            numbers: 0,
        }
    }

    /// Takes one line.
    pub fn take(&mut self, line: &[u8], number: usize) -> Result<(), Problem> {
        match frame(line) {
            Line::Sentence(frame) => return self.sentence(&frame, number),
            Line::Foreign => self.counts.foreign += 1,
            Line::Blank => self.counts.blank += 1,
            Line::Text => self.counts.text += 1,
            Line::WrongSum => self.counts.wrong += 1,
            Line::Damaged => self.counts.broken += 1,
        }
        Ok(())
    }

    fn sentence(&mut self, frame: &Frame, number: usize) -> Result<(), Problem> {
        let Some((formatter, slots, read)) = sentence(&frame.address[2..]) else {
            self.count(frame);
            return Ok(());
        };
        let (stamp, source) = if frame.before.is_empty() { (None, 0) } else { self.leading.read(frame.before) };
        let mut at = number as f64;
        if self.stamped {
            let Some(stamp) = stamp else {
                self.counts.sentences += 1;
                self.counts.unstamped += 1;
                return Ok(());
            };
            let fault = |_| Problem::EitherMonth { line: number, value: shortened(frame.before.trim()) };
            at = self.stamps.seconds(stamp).map_err(fault)?;
            if !self.follows(at, number)? {
                self.counts.sentences += 1;
                return Ok(());
            }
        }
        if *formatter == XDR {
            self.count(frame);
            transducers(frame.body, |row| {
                self.add(slots, frame, source, at, &row);
            });
        } else {
            let mut row = Row::empty();
            read(&mut row, &Fields::new(frame.body));
            if self.add(slots, frame, source, at, &row) {
                self.count(frame);
            } else {
                self.counts.broken += 1;
            }
        }
        if self.numbers > MAX_CELLS {
            return Err(Problem::TooManyReadings { line: number, limit: MAX_CELLS });
        }
        Ok(())
    }

    /// Counts a sentence that is accepted.
    fn count(&mut self, frame: &Frame) {
        self.counts.sentences += 1;
        self.counts.unsummed += usize::from(!frame.summed);
    }

    /// Adds what a sentence says to the table of its instrument.
    ///
    /// `false` where an instrument that writes checksums wrote none: the end of the sentence is lost, and with it maybe
    /// a digit.
    fn add(&mut self, slots: &'static [Slot], frame: &Frame, source: u8, at: f64, row: &Row) -> bool {
        let [a, b, c, d, e] = frame.address;
        let key = u64::from_be_bytes([a, b, c, d, e, row.part[0], row.part[1], source]);
        let place = match self.keys.iter().position(|&own| own == key) {
            Some(place) => place,
            None if self.instruments.len() < MOST_INSTRUMENTS => {
                self.keys.push(key);
                self.instruments.push(NmeaInstrument {
                    name: self.name(frame.address, row.part, source),
                    address: frame.address,
                    slots,
                    part: row.part,
                    source,
                    at: Vec::new(),
                    columns: vec![Vec::new(); slots.len()],
                    odd: [0; MOST_SLOTS],
                    summed: false,
                });
                self.instruments.len() - 1
            }
            None => return true,
        };
        let instrument = &mut self.instruments[place];
        if instrument.summed && !frame.summed {
            return false;
        }
        instrument.summed = frame.summed;
        instrument.at.push(at);
        for (column, value) in instrument.columns.iter_mut().zip(row.values) {
            column.push(value);
        }
        for (count, odd) in instrument.odd.iter_mut().zip(row.odd) {
            *count += usize::from(odd);
        }
        self.numbers += 1 + instrument.columns.len();
        true
    }

    /// Whether a stamp fits in with those before. A single one that does not is left out; where time starts anew, the
    /// log is two.
    fn follows(&mut self, at: f64, number: usize) -> Result<bool, Problem> {
        let (latest, before, lines) = self.latest;
        if at >= latest - DISORDER {
            self.late = None;
            self.latest = if at > latest { (at, latest, 1) } else { (latest, before, lines + 1) };
            return Ok(true);
        }
        if lines == 1 && at >= before - DISORDER && before.is_finite() {
            // The one before was ahead of its time.
            for instrument in &mut self.instruments {
                if let Some(last) = instrument.at.last_mut().filter(|last| **last == latest) {
                    *last = f64::NAN;
                }
            }
            self.counts.strayed += 1;
            self.latest = (at.max(before), before, 2);
            return Ok(true);
        }
        if let Some((line, found)) = self.late {
            let clock = self.stamps.clock();
            let shown = |at: f64| clock.map_or_else(|| format!("{at} s"), |clock| clock.at(at));
            return Err(Problem::ClockBack { line, before: shown(latest), found: shown(found) });
        }
        self.counts.strayed += 1;
        self.late = Some((number, at));
        Ok(false)
    }

    /// The name of an instrument, for messages.
    fn name(&self, address: [u8; 5], [first, second]: [u8; 2], source: u8) -> String {
        let mut name: String = std::iter::once('$').chain(address.map(char::from)).collect();
        match &address[2..] {
            b"RPM" => name.push_str(&format!(" {}{}", char::from(first), shown(second))),
            b"MWV" => name.push_str(&format!(" {}", shown(first))),
            _ => {}
        }
        if let Some(source) = usize::from(source).checked_sub(1).and_then(|source| self.leading.sources.get(source)) {
            name.push_str(&format!(" of {}", shortened(source)));
        }
        name
    }
}

fn shown(byte: u8) -> char {
    if byte.is_ascii_graphic() { char::from(byte) } else { '?' }
}
