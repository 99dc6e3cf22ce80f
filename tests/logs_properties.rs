//! One log in every notation a table or a port can have: always the same record.

use std::path::Path;

use kempf_tests::logs::sentences::sentence;
use kempf_tests::logs::voyage::{EPOCH, every, seconds, time_of_day, time_of_half_day, voyage};
use rand::rngs::ChaCha8Rng;
use rand::seq::{IndexedRandom, SliceRandom};
use rand::{RngExt, SeedableRng};
use trial::channel::Unit;
use trial::names::{self, ColumnMeaning};
use trial::reader::read_from_reader;
use trial::{Channel, Trial};

/// Notations that are tried.
const CASES: u64 = 250;

/// Tenths of a second between rows: every other one has a fraction of a second.
const STEP: usize = 25;

/// How the time of a row is written.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Clock {
    /// A number with a unit, in the name or in the row of units.
    Count(Unit),
    /// A number without one.
    Bare,
    Epoch(f64),
    Iso,
    German,
    American,
    TimeOfDay,
    /// Date and time in two columns.
    Two,
}

/// Where the unit of a column stands.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    /// Before and after the unit.
    Name([&'static str; 2]),
    Below,
    /// Nowhere: it shows in the values.
    Open,
}

/// The name of a quantity and of its unit.
#[derive(Debug, Clone)]
struct Angle {
    name: &'static str,
    unit: (&'static str, Unit),
    upper: bool,
}

/// A way to write a table.
#[derive(Debug, Clone)]
struct Notation {
    clock: Clock,
    time: &'static str,
    time_unit: &'static str,
    heading: Angle,
    rudder: Angle,
    place: Place,
    separator: char,
    comma: bool,
    quoted: bool,
    more: bool,
    line_end: &'static str,
    mark: bool,
    order: Vec<usize>,
}

/// The record in plain numbers, degrees.
fn rows() -> Vec<[f64; 3]> {
    every(STEP).map(|tenth| [seconds(tenth), voyage().heading(tenth), voyage().rudder(tenth)]).collect()
}

fn read(name: &str, text: &str) -> Trial {
    let reading = read_from_reader(Path::new(name), text.as_bytes(), None, None);
    let begin: String = text.chars().take(300).collect();
    reading.unwrap_or_else(|error| panic!("{error}\n{begin}")).trial
}

fn clean() -> Trial {
    let lines: Vec<String> = rows().iter().map(|[t, psi, delta]| format!("{t},{psi:.12},{delta:.12}\n")).collect();
    read("clean.csv", &format!("t_s,heading_deg,rudder_deg\n{}", lines.concat()))
}

/// Holds a record to another one: whole turns of the heading aside, they are the same.
fn is_the_same(found: &Trial, sound: &Trial, what: &dyn std::fmt::Debug) {
    assert_eq!(found.len(), sound.len(), "{what:?}");
    for row in 0..sound.len() {
        let columns =
            [Trial::time, Trial::heading, Trial::rudder].map(|column| [column(found)[row], column(sound)[row]]);
        for ([own, expected], far) in columns.into_iter().zip([1e-6, 1e-9, 1e-9]) {
            assert!((own - expected).abs() <= far, "row {row}: {own}, expected {expected}: {what:?}");
        }
    }
}

impl Notation {
    /// The cells that tell of the time, and what stands above and below them.
    fn of_time(&self, tenth: usize) -> Vec<String> {
        let t = seconds(tenth);
        let number = |text: String| if self.comma { text.replace('.', ",") } else { text };
        match self.clock {
            Clock::Count(unit) => vec![number(format!("{:.10}", t / unit.si_factor()))],
            Clock::Bare => vec![number(format!("{t:.1}"))],
            Clock::Epoch(per_second) => vec![format!("{}", ((EPOCH as f64 + t) * per_second).round())],
            Clock::Iso => vec![format!("2026-11-20T{}Z", time_of_day(tenth, true))],
            Clock::German => vec![format!("20.11.2026 {}", time_of_day(tenth, true))],
            Clock::American => vec![format!("11/20/2026 {}", time_of_half_day(tenth, true))],
            Clock::TimeOfDay => vec![time_of_day(tenth, true)],
            Clock::Two => vec!["2026-11-20".into(), time_of_day(tenth, true)],
        }
    }

    /// Name and unit below of every column, in the order in which they are made.
    fn head(&self) -> Vec<[String; 2]> {
        let place = |name: &str, unit: &str| match self.place {
            Place::Name([before, behind]) => [format!("{name}{before}{unit}{behind}"), String::new()],
            Place::Below => [name.to_owned(), unit.to_owned()],
            Place::Open => [name.to_owned(), String::new()],
        };
        let plain = |name: &str| [name.to_owned(), String::new()];
        let mut head = match self.clock {
            // Seconds alone may be without a unit.
            Clock::Count(_) if self.place == Place::Open => {
                vec![[format!("{} [{}]", self.time, self.time_unit), String::new()]]
            }
            Clock::Count(_) => vec![place(self.time, self.time_unit)],
            Clock::Two => vec![plain("Date"), plain(self.time)],
            _ => vec![plain(self.time)],
        };
        for angle in [&self.heading, &self.rudder] {
            let name = if angle.upper { angle.name.to_uppercase() } else { angle.name.to_owned() };
            head.push(place(&name, angle.unit.0));
        }
        if self.more {
            head.push(plain("Remark"));
            head.push(plain("load_t"));
        }
        head
    }

    /// The table.
    fn text(&self) -> String {
        let head = self.head();
        // Columns that are there in this notation, in the order of this notation.
        let order: Vec<usize> = self.order.iter().copied().filter(|place| *place < head.len()).collect();
        let cell = |text: &str| {
            let needs = text.contains(self.separator) || (self.separator == ' ' && text.is_empty());
            if self.quoted || needs { format!("\"{text}\"") } else { text.to_owned() }
        };
        let line = |cells: &[String]| {
            let cells: Vec<String> = order.iter().map(|&place| cell(&cells[place])).collect();
            format!("{}{}", cells.join(&self.separator.to_string()), self.line_end)
        };
        let mut text = String::from(if self.mark { "\u{feff}" } else { "" });
        text += &line(&head.iter().map(|[name, _]| name.clone()).collect::<Vec<_>>());
        if head.iter().any(|[_, unit]| !unit.is_empty()) {
            text += &line(&head.iter().map(|[_, unit]| unit.clone()).collect::<Vec<_>>());
        }
        let number = |value: f64, unit: Unit| {
            let text = format!("{:.14}", value.to_radians() / unit.si_factor());
            if self.comma { text.replace('.', ",") } else { text }
        };
        for tenth in every(STEP) {
            let mut cells = self.of_time(tenth);
            cells.push(number(voyage().heading(tenth), self.heading.unit.1));
            cells.push(number(voyage().rudder(tenth), self.rudder.unit.1));
            if self.more {
                cells.extend(["calm sea".to_owned(), "12".to_owned()]);
            }
            text += &line(&cells);
        }
        text
    }
}

fn names_of(wanted: impl Fn(ColumnMeaning) -> bool) -> Vec<&'static str> {
    names::known_column_names().filter(|(_, said)| wanted(*said)).map(|(name, _)| name).collect()
}

fn one_of<T: Clone>(list: &[T], chance: &mut ChaCha8Rng) -> T {
    list.choose(chance).expect("a list of some").clone()
}

fn angle(channel: Channel, chance: &mut ChaCha8Rng) -> Angle {
    let names = names_of(|said| said == ColumnMeaning::Channel(channel, None));
    let units: Vec<(&'static str, Unit)> =
        names::known_unit_names().filter(|(_, unit)| channel.units().contains(unit)).collect();
    Angle { name: one_of(&names, chance), unit: one_of(&units, chance), upper: chance.random() }
}

fn clock(chance: &mut ChaCha8Rng) -> (Clock, &'static str) {
    if chance.random() {
        let seconds = [Unit::Second, Unit::Millisecond, Unit::Minute];
        let counts: Vec<_> = names::known_unit_names().filter(|(_, unit)| seconds.contains(unit)).collect();
        let (name, unit) = one_of(&counts, chance);
        return (Clock::Count(unit), name);
    }
    let [milliseconds, microseconds] = [1e3, 1e6].map(Clock::Epoch);
    let others = [Clock::Bare, Clock::Iso, Clock::German, Clock::American, Clock::TimeOfDay, Clock::Two];
    (one_of(&[&others[..], &[milliseconds, microseconds]].concat(), chance), "")
}

fn place(chance: &mut ChaCha8Rng) -> Place {
    let names = [
        [" [", "]"],
        [" (", ")"],
        ["[", "]"],
        [" / ", ""],
        ["_", ""],
        [" ", ""],
        [", ", ""],
        [" in ", ""],
        [" {", "}"],
    ];
    let mut all: Vec<Place> = names.into_iter().map(Place::Name).collect();
    all.extend([Place::Below; 4].into_iter().chain([Place::Open; 4]));
    one_of(&all, chance)
}

fn notation(chance: &mut ChaCha8Rng) -> Notation {
    let (clock, time_unit) = clock(chance);
    let (heading, mut rudder) = (angle(Channel::Heading, chance), angle(Channel::Rudder, chance));
    let separator = one_of(&[',', ';', '\t', ' '], chance);
    // A comma in a name between blanks: nobody can tell which of the two separates.
    let place = match place(chance) {
        Place::Name([", ", ""]) if separator == ' ' => Place::Name([" [", "]"]),
        place => place,
    };
    // Radians and degrees without a word would be told apart by their values: both alike is what loggers do.
    if place == Place::Open {
        rudder.unit = heading.unit;
    }
    let mut order: Vec<usize> = (0..6).collect();
    order.shuffle(chance);
    Notation {
        clock,
        time: one_of(&names_of(|said| said == ColumnMeaning::Time(None)), chance),
        time_unit,
        heading,
        rudder,
        place,
        separator,
        comma: chance.random(),
        quoted: chance.random(),
        more: chance.random(),
        line_end: one_of(&["\n", "\r\n", "\r\n\r\n"], chance),
        mark: chance.random(),
        order,
    }
}

#[test]
fn a_table_in_any_notation_is_one_record() {
    let clean = clean();
    for seed in 0..CASES {
        let notation = notation(&mut ChaCha8Rng::seed_from_u64(seed));
        is_the_same(&read("case.csv", &notation.text()), &clean, &notation);
    }
}

/// A log of sentences of three talkers, in an order.
fn sentences(talkers: &[String; 3], order: &[usize; 4], stamped: bool, line_end: &str) -> String {
    let of = |tenth: usize| {
        let clock = time_of_day(tenth, false).replace(':', "");
        let stamp = if stamped { format!("2026-11-20T{} ", time_of_day(tenth, true)) } else { String::new() };
        let more = [
            format!("{}HDT,{:.3},T", talkers[0], voyage().heading(tenth)),
            format!("{}RSA,{:.3},A,,V", talkers[1], voyage().rudder(tenth)),
            "PASHR,1,2".to_owned(),
            format!("{}XDR,C,19.5,C,ENV", talkers[2]),
        ];
        let first = sentence(&format!("{}ZDA,{clock}.00,20,11,2026,00,00", talkers[2]));
        let lines = std::iter::once(first).chain(order.iter().map(|&place| sentence(&more[place])));
        lines.map(|line| format!("{stamp}{line}{line_end}")).collect::<String>()
    };
    every(10).map(of).collect()
}

#[test]
fn sentences_of_any_talker_in_any_order_are_one_record() {
    let plain = |stamped| {
        let text = sentences(&["HE", "II", "GP"].map(str::to_owned), &[0, 1, 2, 3], stamped, "\n");
        read("clean.nmea", &text)
    };
    let plain = [plain(false), plain(true)];
    let letters: Vec<char> = ('A'..='Z').collect();
    // Talkers that begin with a P are firms of their own.
    let firsts: Vec<char> = letters.iter().copied().filter(|letter| *letter != 'P').collect();
    for seed in 0..CASES {
        let chance = &mut ChaCha8Rng::seed_from_u64(seed);
        let talkers = [(); 3].map(|()| String::from_iter([one_of(&firsts, chance), one_of(&letters, chance)]));
        let (mut order, stamped, line_end) = ([0, 1, 2, 3], chance.random(), one_of(&["\n", "\r\n"], chance));
        order.shuffle(chance);
        let found = read("case.nmea", &sentences(&talkers, &order, stamped, line_end));
        is_the_same(&found, &plain[usize::from(stamped)], &(talkers, order, stamped));
    }
}
