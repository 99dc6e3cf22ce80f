//! One log in every notation a table or a port can have: always the same record.

use std::path::Path;

use kempf_tests::logs::sentences::sentence;
use kempf_tests::logs::voyage::{EPOCH, every, seconds, time_of_day, time_of_half_day, voyage};
use proptest::prelude::*;
use proptest::sample::select;
use trial::channel::Unit;
use trial::names::{self, ColumnMeaning};
use trial::reader::read_bytes;
use trial::{Channel, Trial};

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
    let reading = read_bytes(Path::new(name), text.as_bytes(), None, None);
    let begin: String = text.chars().take(300).collect();
    reading.unwrap_or_else(|error| panic!("{error}\n{begin}")).trial
}

fn clean() -> Trial {
    let lines: Vec<String> = rows().iter().map(|[t, psi, delta]| format!("{t},{psi:.12},{delta:.12}\n")).collect();
    read("clean.csv", &format!("t_s,heading_deg,rudder_deg\n{}", lines.concat()))
}

/// The record by the contract: whole turns of the heading aside, the same as another.
fn is_the_same(found: &Trial, sound: &Trial) -> Result<(), TestCaseError> {
    prop_assert_eq!(found.len(), sound.len());
    for row in 0..sound.len() {
        let near = |one: f64, other: f64, far: f64| (one - other).abs() <= far;
        let (a, b) = (found.time()[row], sound.time()[row]);
        prop_assert!(near(a, b, 1e-6), "row {}: {} s, expected {} s", row, a, b);
        let (a, b) = (found.heading()[row], sound.heading()[row]);
        prop_assert!(near(a, b, 1e-9), "row {}: heading {}, expected {}", row, a, b);
        let (a, b) = (found.rudder()[row], sound.rudder()[row]);
        prop_assert!(near(a, b, 1e-9), "row {}: rudder {}, expected {}", row, a, b);
    }
    Ok(())
}

impl Notation {
    /// The cells that tell of the time, and what stands above and below them.
    fn of_time(&self, tenth: usize) -> Vec<String> {
        let t = seconds(tenth);
        let number = |text: String| if self.comma { text.replace('.', ",") } else { text };
        match self.clock {
            Clock::Count(unit) => vec![number(format!("{:.10}", t / unit.to_si()))],
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
            let text = format!("{:.14}", value.to_radians() / unit.to_si());
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
    names::names().filter(|(_, said)| wanted(*said)).map(|(name, _)| name).collect()
}

fn angle(channel: Channel) -> impl Strategy<Value = Angle> {
    let names = names_of(|said| said == ColumnMeaning::Channel(channel, None));
    let units: Vec<(&'static str, Unit)> = names::units().filter(|(_, unit)| channel.units().contains(unit)).collect();
    (select(names), select(units), any::<bool>()).prop_map(|(name, unit, upper)| Angle { name, unit, upper })
}

fn clock() -> impl Strategy<Value = (Clock, &'static str)> {
    let units = |wanted: Unit| names::units().filter(move |(_, unit)| *unit == wanted).map(|(name, _)| name);
    let counts = [Unit::Second, Unit::Millisecond, Unit::Minute]
        .into_iter()
        .flat_map(|unit| units(unit).map(move |name| (Clock::Count(unit), name)));
    let epochs = [1e3, 1e6].map(Clock::Epoch);
    let others = [Clock::Bare, Clock::Iso, Clock::German, Clock::American, Clock::TimeOfDay, Clock::Two];
    let others: Vec<(Clock, &'static str)> = others.into_iter().chain(epochs).map(|clock| (clock, "")).collect();
    prop_oneof![select(counts.collect::<Vec<_>>()), select(others)]
}

fn place() -> impl Strategy<Value = Place> {
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
    select(all)
}

fn notation() -> impl Strategy<Value = Notation> {
    let look = (select(vec![',', ';', '\t', ' ']), any::<[bool; 4]>(), select(vec!["\n", "\r\n", "\r\n\r\n"]));
    let order = Just((0..6).collect::<Vec<usize>>()).prop_shuffle();
    let names =
        (select(names_of(|said| said == ColumnMeaning::Time(None))), angle(Channel::Heading), angle(Channel::Rudder));
    (clock(), names, place(), look, order).prop_map(
        |((clock, time_unit), (time, heading, mut rudder), place, look, order)| {
            let (separator, [comma, quoted, more, mark], line_end) = look;
            // A comma in a name between blanks: nobody can tell which of the two separates.
            let place =
                if separator == ' ' && place == Place::Name([", ", ""]) { Place::Name([" [", "]"]) } else { place };
            // Radians and degrees without a word would be told apart by their values: both alike is what loggers do.
            if place == Place::Open {
                rudder.unit = heading.unit;
            }
            Notation {
                clock,
                time,
                time_unit,
                heading,
                rudder,
                place,
                separator,
                comma,
                quoted,
                more,
                line_end,
                mark,
                order,
            }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 250, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_table_in_any_notation_is_one_record(notation in notation()) {
        is_the_same(&read("case.csv", &notation.text()), &clean())?;
    }

    #[test]
    fn sentences_of_any_talker_in_any_order_are_one_record(
        talkers in proptest::array::uniform3("[A-OQ-Z][A-Z]"),
        shuffled in Just(vec![0_usize, 1, 2, 3]).prop_shuffle(),
        stamped in any::<bool>(),
        line_end in select(vec!["\n", "\r\n"]),
    ) {
        let text = |talkers: &[String], order: &[usize], line_end: &str| -> String {
            every(10).map(|tenth| {
                let clock = time_of_day(tenth, false).replace(':', "");
                let stamp = if stamped { format!("2026-11-20T{} ", time_of_day(tenth, true)) } else { String::new() };
                let more = [
                    format!("{}HDT,{:.3},T", talkers[0], voyage().heading(tenth)),
                    format!("{}RSA,{:.3},A,,V", talkers[1], voyage().rudder(tenth)),
                    "PASHR,1,2".to_owned(),
                    format!("{}XDR,C,19.5,C,ENV", talkers[2]),
                ];
                let first = sentence(&format!("{}ZDA,{clock}.00,20,11,2026,00,00", talkers[2]));
                let bodies = order.iter().map(|&place| sentence(&more[place]));
                std::iter::once(first).chain(bodies).map(|line| format!("{stamp}{line}{line_end}")).collect::<String>()
            }).collect()
        };
        let plain = text(&["HE", "II", "GP"].map(str::to_owned), &[0, 1, 2, 3], "\n");
        is_the_same(&read("case.nmea", &text(&talkers, &shuffled, line_end)), &read("clean.nmea", &plain))?;
    }
}
