//! A predicted figure beside what was measured, and what many of them say together.

use campaign::statistics::{Statistic, share};
use estimation::statistics::median;
use predict::replay::Compared;

/// What is predicted from what.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ForecastGroup {
    /// Zig-zags of HSVA from one of them.
    Hsva,
    /// All of MARIN from one zig-zag of HSVA.
    MarinOfOne,
    /// All of MARIN from the eight zig-zags of HSVA together.
    MarinOfAll,
    /// The other trials of MARIN from its two 20/20.
    Marin,
    /// All of the Esso Osaka from one zig-zag.
    EssoOsaka,
}

impl ForecastGroup {
    /// In the order of the page.
    pub const ALL: [Self; 5] = [Self::Hsva, Self::MarinOfOne, Self::MarinOfAll, Self::Marin, Self::EssoOsaka];

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Hsva => "KVLCC2: HSVA from one HSVA zig-zag",
            Self::MarinOfOne => "KVLCC2: MARIN from one HSVA zig-zag",
            Self::MarinOfAll => "KVLCC2: MARIN from all eight of HSVA",
            Self::Marin => "KVLCC2: MARIN from its two 20/20",
            Self::EssoOsaka => "Esso Osaka: all from one zig-zag",
        }
    }
}

/// A kind of figure: names of the program that are judged together, and whether errors are told as a share of what was
/// measured, in per cent, and not in degrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FigureKind {
    /// In words.
    pub words: &'static str,
    names: &'static [&'static str],
    is_relative: bool,
}

const fn degrees(words: &'static str, names: &'static [&'static str]) -> FigureKind {
    FigureKind { words, names, is_relative: false }
}

const fn relative(words: &'static str, names: &'static [&'static str]) -> FigureKind {
    FigureKind { words, names, is_relative: true }
}

/// Every kind that is judged. A length stands in lengths of the ship only, so that none counts twice.
pub const KINDS: [FigureKind; 10] = [
    degrees("first overshoot", &["first_overshoot_deg"]),
    degrees("later overshoots", &["second_overshoot_deg", "third_overshoot_deg", "fourth_overshoot_deg"]),
    relative(
        "executes and period",
        &["second_execute_s", "third_execute_s", "fourth_execute_s", "fifth_execute_s", "sixth_execute_s", "period_s"],
    ),
    relative("initial turning", &["initial_turning_lengths"]),
    relative("time to 90° and 180°", &["time_to_90_s", "time_to_180_s"]),
    relative("advance", &["advance_lengths"]),
    relative("transfer", &["transfer_m"]),
    relative("tactical diameter", &["tactical_diameter_lengths"]),
    relative("speed loss", &["speed_loss_share"]),
    relative("steady yaw rate", &["steady_rate_deg_s"]),
];

impl FigureKind {
    /// The kind of a figure of the program; `None` for one that is not judged.
    pub fn of(name: &str) -> Option<Self> {
        KINDS.into_iter().find(|kind| kind.names.contains(&name))
    }

    /// The unit of errors and widths.
    pub fn unit(self) -> &'static str {
        if self.is_relative { "%" } else { "°" }
    }
}

/// A figure of a measured trial beside its prediction.
#[derive(Debug, Clone)]
pub struct ForecastFigure {
    /// What is predicted from what.
    pub group: ForecastGroup,
    /// The records that were fitted.
    pub fitted: String,
    /// The trial.
    pub trial: &'static str,
    /// Name of the figure, with its unit.
    pub name: String,
    /// What was measured and predicted.
    pub compared: Compared,
}

impl ForecastFigure {
    /// Its kind, where it is judged.
    pub fn kind(&self) -> Option<FigureKind> {
        FigureKind::of(&self.name)
    }

    fn in_unit(&self, value: f64) -> f64 {
        match self.kind().is_some_and(|kind| kind.is_relative) {
            true => 100.0 * value / self.compared.measured.abs(),
            false => value,
        }
    }

    /// Median of the prediction less what was measured, in the unit of its kind.
    pub fn error(&self) -> f64 {
        self.in_unit(self.compared.interval.median - self.compared.measured)
    }

    /// Width of the 90 % interval, in the unit of its kind.
    pub fn width(&self) -> f64 {
        let [low, high] = self.compared.interval.ci90;
        self.in_unit(high - low)
    }

    /// Width of the 90 % interval over what was measured.
    pub fn relative_width(&self) -> f64 {
        let [low, high] = self.compared.interval.ci90;
        (high - low) / self.compared.measured.abs()
    }
}

/// What some figures of one kind say together.
#[derive(Debug, Clone, Copy)]
pub struct ForecastScore {
    /// How many there are.
    pub count: usize,
    /// Median of the size of the error, in the unit of the kind.
    pub error: f64,
    /// Share that the 90 % interval holds, with its own 95 % interval (Wilson 1927).
    pub held: Statistic,
    /// Median width of the 90 % interval, in the unit of the kind.
    pub width: f64,
    /// The same over what was measured.
    pub relative_width: f64,
}

impl ForecastScore {
    /// Of some figures; `None` of none.
    pub fn of(figures: &[&ForecastFigure]) -> Option<Self> {
        let held = figures.iter().filter(|own| own.compared.inside90).count();
        let middle =
            |of: fn(&ForecastFigure) -> f64| median(&mut figures.iter().map(|own| of(own)).collect::<Vec<_>>());
        Some(Self {
            count: figures.len(),
            error: middle(|own| own.error().abs())?,
            held: share(held as u64, figures.len() as u64)?.times(100.0),
            width: middle(ForecastFigure::width)?,
            relative_width: middle(ForecastFigure::relative_width)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use predict::PredictionInterval;

    fn figure(name: &str, measured: f64, draws: [f64; 3]) -> ForecastFigure {
        let interval = PredictionInterval::of(&mut draws.to_vec()).expect("three");
        let compared = Compared { measured, interval, inside90: interval.holds90(measured) };
        let (fitted, name) = (String::new(), name.to_owned());
        ForecastFigure { group: ForecastGroup::Hsva, fitted, trial: "", name, compared }
    }

    #[test]
    fn errors_are_degrees_of_overshoots_and_per_cent_of_lengths() {
        let overshoot = figure("second_overshoot_deg", 20.0, [17.0, 18.0, 19.0]);
        assert!((overshoot.error() + 2.0).abs() < 1e-12 && (overshoot.width() - 1.8).abs() < 1e-12);
        let advance = figure("advance_lengths", 3.0, [3.0, 3.3, 3.6]);
        assert!((advance.error() - 10.0).abs() < 1e-9, "{}", advance.error());
        assert_eq!(figure("advance_m", 3.0, [3.0; 3]).kind(), None, "a length counts once");
    }

    #[test]
    fn a_score_counts_what_is_held() {
        let all = [[1.0, 2.0, 3.0], [3.0, 4.0, 5.0]].map(|draws| figure("first_overshoot_deg", 2.0, draws));
        let score = ForecastScore::of(&all.iter().collect::<Vec<_>>()).expect("two");
        assert_eq!((score.count, score.error, score.held.value), (2, 1.0, 50.0));
        assert!(ForecastScore::of(&[]).is_none());
    }
}
