//! Particulars of a ship as options, shared by all commands that need them.

use clap::error::ErrorKind;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use ship::angle::KNOT;
use ship::vessel::prior::{HullParticulars, PARTICULARS, Particular};
use trial::{TrialParticulars, clock};

use crate::style_options::within;

/// Length and approach speed of a ship.
#[derive(Debug, Clone, Default, Args)]
pub struct ScaleOptions {
    /// Length of the ship between perpendiculars, m
    #[arg(long, value_name = "L", value_parser = within([0.1, 1000.0]), allow_negative_numbers = true)]
    pub length_m: Option<f64>,
    /// Approach speed, m/s [default: that of the record]
    #[arg(long, value_name = "V", value_parser = within([0.01, 100.0]), requires = "length_m",
        conflicts_with = "speed_kn", allow_negative_numbers = true)]
    pub speed_m_s: Option<f64>,
    /// Approach speed, kn
    #[arg(long, value_name = "V", value_parser = within([0.01, 200.0]), allow_negative_numbers = true, requires = "length_m")]
    pub speed_kn: Option<f64>,
}

impl ScaleOptions {
    /// Approach speed from either option, m/s; `None` without both.
    pub fn speed(&self) -> Option<f64> {
        self.speed_m_s.or(self.speed_kn.map(|speed| speed * KNOT))
    }
}

/// Known particulars of a ship.
#[derive(Debug, Clone, Default, Args)]
pub struct ShipOptions {
    /// Her length and approach speed
    #[command(flatten)]
    pub scale: ScaleOptions,
    /// Her hull, rudder and propeller
    #[command(flatten)]
    pub form: FormOptions,
}

impl ShipOptions {
    /// `true` if no particular is given.
    pub fn is_empty(&self) -> bool {
        self.scale.length_m.is_none() && self.form.0.is_empty()
    }
}

/// Particulars of a trial for the first page of its report.
#[derive(Debug, Clone, Default, Args)]
pub struct TrialOptions {
    /// Name of the ship, for the first page of the report
    #[arg(long, value_name = "NAME")]
    pub ship_name: Option<String>,
    /// Day of the trial [default: that of the sidecar or of the time stamps of the record]
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = day)]
    pub date: Option<String>,
    /// Draught at the fore perpendicular, m, for the first page
    #[arg(long, value_name = "D", value_parser = within(DRAUGHT), allow_negative_numbers = true)]
    pub draught_fore_m: Option<f64>,
    /// Draught at the aft perpendicular, m, for the first page
    #[arg(long, value_name = "D", value_parser = within(DRAUGHT), allow_negative_numbers = true)]
    pub draught_aft_m: Option<f64>,
}

/// Range of draughts of ships and models, m.
const DRAUGHT: [f64; 2] = [0.01, 50.0];

fn day(text: &str) -> Result<String, String> {
    clock::parse_date(text).ok_or_else(|| String::from("expected a day of the calendar, such as 2026-11-20"))
}

impl TrialOptions {
    /// Particulars given as options; missing ones are taken from a record.
    pub fn completed_by(&self, of_record: &TrialParticulars) -> TrialParticulars {
        let Self { ship_name, date, draught_fore_m, draught_aft_m } = self.clone();
        TrialParticulars { ship_name, date, draught_fore: draught_fore_m, draught_aft: draught_aft_m }
            .with_missing_from(of_record)
    }
}

/// Given particulars of hull, rudder and propeller, each with its value in the unit of [`PARTICULARS`]. Length and
/// speed are in [`ScaleOptions`].
#[derive(Debug, Clone, Default)]
pub struct FormOptions(Vec<(&'static Particular, f64)>);

impl FormOptions {
    /// Key of the first given particular; `None` if none is given.
    pub fn first_key(&self) -> Option<&'static str> {
        self.0.first().map(|(particular, _)| particular.key)
    }

    /// Sets the given particulars of a hull.
    pub fn apply(&self, hull: &mut HullParticulars) {
        self.0.iter().for_each(|(particular, value)| particular.set(hull, *value));
    }

    fn particulars() -> impl Iterator<Item = &'static Particular> {
        PARTICULARS.iter().filter(|particular| !matches!(particular.key, "length-m" | "speed-m-s"))
    }
}

impl Args for FormOptions {
    fn augment_args(command: Command) -> Command {
        Self::particulars().fold(command, |command, Particular { key, symbol, unit, meaning, range, .. }| {
            let unit = if *unit == "1" { String::new() } else { format!(", {unit}") };
            let option = Arg::new(*key).long(*key).value_name(*symbol).help(format!("{meaning}{unit}"));
            command.arg(option.value_parser(within(*range)).allow_negative_numbers(true))
        })
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for FormOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut given = Vec::new();
        for particular in Self::particulars() {
            let value = matches.try_get_one::<f64>(particular.key);
            let value = value.map_err(|error| clap::Error::raw(ErrorKind::InvalidValue, error))?;
            given.extend(value.map(|value| (particular, *value)));
        }
        Ok(Self(given))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}
