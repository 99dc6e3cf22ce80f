//! Content of a log so far: a table for each instrument, with a row per sentence, and counts of the omitted lines. The
//! instruments are chosen at the end of the log.

use super::frame::{Fields, Frame, Line, frame};
use super::sentence::{MAX_SLOTS, NmeaQuantity, Row, XDR, sentence, transducers};
use super::stamp::PrefixReader;
use crate::clock::StampConverter;
use crate::reader::error::ReadProblem;
use crate::reader::limits::MAX_CELLS;
use crate::wording::shortened;

/// Instrument of a log: its sentences of a single formatter, as a table.
#[derive(Debug)]
pub(super) struct NmeaInstrument {
    /// Name in messages: `$HEHDT`, `$HEHDT of GYRO1`.
    pub name: String,
    /// Talker and sentence.
    pub address: [u8; 5],
    /// Quantities of the sentence.
    slots: &'static [NmeaQuantity],
    /// Mark as in [`Row::instrument_mark`].
    pub instrument_mark: [u8; 2],
    /// Number of the source as in [`PrefixReader`].
    pub source: u8,
    /// Instant of each sentence: its line number until the clock is determined, then s; NaN for an omitted sentence.
    pub instants: Vec<f64>,
    /// Values of each quantity, one per sentence.
    pub columns: Vec<Vec<f64>>,
    /// Number of invalid entries of each quantity.
    pub invalid: [usize; MAX_SLOTS],
    /// `true` once a sentence had a checksum.
    writes_checksums: bool,
}

impl NmeaInstrument {
    /// `true` for an instrument whose sentences have a formatter.
    pub fn sends(&self, formatter: &[u8; 3]) -> bool {
        self.address[2..] == *formatter
    }

    /// Index of the column of a quantity; `None` if the sentence does not have it.
    pub fn column(&self, slot: NmeaQuantity) -> Option<usize> {
        self.slots.iter().position(|&quantity| quantity == slot)
    }

    /// Number of readings in a column.
    pub fn readings(&self, column: usize) -> usize {
        self.columns[column].iter().filter(|value| value.is_finite()).count()
    }
}

/// Maximum number of instruments; addresses garbled by noise are dropped beyond it.
const MAX_INSTRUMENTS: usize = 256;
/// Tolerance of the order of stamps from two ports, s.
const MAX_DISORDER_S: f64 = 1.0;

/// Numbers of lines and sentences by kind.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct LineCounts {
    pub blank_lines: usize,
    /// Lines of text without a sentence.
    pub text_lines: usize,
    /// Undamaged sentences of the standard, read or not.
    pub sentences: usize,
    /// AIS and proprietary sentences, and those with an address outside the standard; they are not read.
    pub foreign_sentences: usize,
    pub wrong_checksums: usize,
    /// Sentences cut short, and lines that are not text.
    pub broken_sentences: usize,
    /// Sentences accepted without a checksum.
    pub without_checksum: usize,
    /// Sentences without a stamp in a log with stamps.
    pub without_stamp: usize,
    /// Stamps far from their neighbours.
    pub stray_stamps: usize,
}

/// Sentences of a log read so far.
#[derive(Debug, Default)]
pub(super) struct NmeaLog {
    pub instruments: Vec<NmeaInstrument>,
    /// Keys of the instruments, in the same order; separate from the tables because they are searched for every
    /// sentence.
    keys: Vec<u64>,
    pub counts: LineCounts,
    pub leading: PrefixReader,
    pub stamps: StampConverter,
    /// `true` for a log with stamps before its sentences.
    pub has_stamps: bool,
    /// Latest stamp and the stamp before it, s, and the number of lines with the latest stamp.
    latest: (f64, f64, usize),
    /// Line and time of the last stamp, if it is before the latest stamp.
    late: Option<(usize, f64)>,
    /// Number of values in the tables, instants included.
    numbers: usize,
}

impl NmeaLog {
    /// Empty log; `has_stamps` for stamps before the sentences.
    pub fn new(has_stamps: bool) -> Self {
        Self { has_stamps, latest: (f64::NEG_INFINITY, f64::NEG_INFINITY, 0), ..Self::default() }
    }

    /// Adds the line with a number.
    ///
    /// Fails for a date with two readings, for a clock that goes back, and beyond [`MAX_CELLS`] values.
    pub fn take(&mut self, line: &[u8], number: usize) -> Result<(), ReadProblem> {
        match frame(line) {
            Line::Sentence(frame) => return self.sentence(&frame, number),
            Line::Foreign => self.counts.foreign_sentences += 1,
            Line::Blank => self.counts.blank_lines += 1,
            Line::Text => self.counts.text_lines += 1,
            Line::WrongSum => self.counts.wrong_checksums += 1,
            Line::Damaged => self.counts.broken_sentences += 1,
        }
        Ok(())
    }

    fn sentence(&mut self, frame: &Frame, number: usize) -> Result<(), ReadProblem> {
        let Some((formatter, slots, read)) = sentence(&frame.address[2..]) else {
            self.count(frame);
            return Ok(());
        };
        let (stamp, source) = if frame.before.is_empty() { (None, 0) } else { self.leading.read(frame.before) };
        let mut at = number as f64;
        if self.has_stamps {
            let Some(stamp) = stamp else {
                self.counts.sentences += 1;
                self.counts.without_stamp += 1;
                return Ok(());
            };
            let fault = |_| ReadProblem::AmbiguousDate { line: number, value: shortened(frame.before.trim()) };
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
                self.counts.broken_sentences += 1;
            }
        }
        if self.numbers > MAX_CELLS {
            return Err(ReadProblem::TooManyReadings { line: number, limit: MAX_CELLS });
        }
        Ok(())
    }

    /// Counts an accepted sentence.
    fn count(&mut self, frame: &Frame) {
        self.counts.sentences += 1;
        self.counts.without_checksum += usize::from(!frame.has_checksum);
    }

    /// Adds the readings of a sentence to the table of its instrument.
    ///
    /// `false` for a sentence without checksum from an instrument that writes checksums: its end is lost, possibly with
    /// a digit.
    fn add(&mut self, slots: &'static [NmeaQuantity], frame: &Frame, source: u8, at: f64, row: &Row) -> bool {
        let [a, b, c, d, e] = frame.address;
        let key = u64::from_be_bytes([a, b, c, d, e, row.instrument_mark[0], row.instrument_mark[1], source]);
        let number = match self.keys.iter().position(|&earlier| earlier == key) {
            Some(number) => number,
            None if self.instruments.len() < MAX_INSTRUMENTS => {
                self.keys.push(key);
                self.instruments.push(NmeaInstrument {
                    name: self.name(frame.address, row.instrument_mark, source),
                    address: frame.address,
                    slots,
                    instrument_mark: row.instrument_mark,
                    source,
                    instants: Vec::new(),
                    columns: vec![Vec::new(); slots.len()],
                    invalid: [0; MAX_SLOTS],
                    writes_checksums: false,
                });
                self.instruments.len() - 1
            }
            None => return true,
        };
        let instrument = &mut self.instruments[number];
        if instrument.writes_checksums && !frame.has_checksum {
            return false;
        }
        instrument.writes_checksums = frame.has_checksum;
        instrument.instants.push(at);
        for (column, value) in instrument.columns.iter_mut().zip(row.values) {
            column.push(value);
        }
        for (count, invalid) in instrument.invalid.iter_mut().zip(row.invalid) {
            *count += usize::from(invalid);
        }
        self.numbers += 1 + instrument.columns.len();
        true
    }

    /// `true` for a stamp not before its predecessors. A single earlier stamp is omitted; fails if time restarts,
    /// as in two joined logs.
    fn follows(&mut self, at: f64, number: usize) -> Result<bool, ReadProblem> {
        let (latest, before, lines) = self.latest;
        if at >= latest - MAX_DISORDER_S {
            self.late = None;
            self.latest = if at > latest { (at, latest, 1) } else { (latest, before, lines + 1) };
            return Ok(true);
        }
        if lines == 1 && at >= before - MAX_DISORDER_S && before.is_finite() {
            // The previous stamp was too late.
            for instrument in &mut self.instruments {
                if let Some(last) = instrument.instants.last_mut().filter(|last| **last == latest) {
                    *last = f64::NAN;
                }
            }
            self.counts.stray_stamps += 1;
            self.latest = (at.max(before), before, 2);
            return Ok(true);
        }
        if let Some((line, after)) = self.late {
            let clock = self.stamps.clock();
            let shown = |at: f64| clock.map_or_else(|| format!("{at} s"), |clock| clock.time_of_day_at(at));
            return Err(ReadProblem::ClockBack { line, before: shown(latest), after: shown(after) });
        }
        self.counts.stray_stamps += 1;
        self.late = Some((number, at));
        Ok(false)
    }

    /// Name of an instrument in messages.
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
