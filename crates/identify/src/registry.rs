//! Registry of the methods by name, with their settings as written in scenario files.
//!
//! To add a method: a file with its `Settings` and an [`Identifier`], a `mod` for it, and one line in the table below.
//! The contract test of all methods then runs it. A method that combines other methods is listed last.

use serde::{Deserialize, Serialize};

use crate::identifier::Identifier;
use crate::settings::SettingsError;

macro_rules! methods {
    ($($Method:ident($file:ident)),+ $(,)?; combined: $($Chooser:ident($chooser:ident)),+ $(,)?) => {
        /// Method with its settings; the variant is the key in a scenario file.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
        #[serde(rename_all = "kebab-case")]
        pub enum IdentifierSettings {
            $(
                #[doc = concat!("Settings of ", stringify!($file), ".")]
                $Method(crate::$file::Settings),
            )+
            $(
                #[doc = concat!("Settings of ", stringify!($chooser), ".")]
                $Chooser(crate::$chooser::Settings),
            )+
        }

        impl IdentifierSettings {
            /// Method with these settings, which are checked.
            pub fn build(&self) -> Result<Box<dyn Identifier>, SettingsError> {
                Ok(match self.clone() {
                    $(Self::$Method(settings) => Box::new(settings.build()?),)+
                    $(Self::$Chooser(settings) => Box::new(settings.build()?),)+
                })
            }
        }

        /// Default settings of all methods that do not combine other methods, in the order of reports.
        pub fn default_settings() -> Vec<IdentifierSettings> {
            vec![$(IdentifierSettings::$Method(crate::$file::Settings::default())),+]
        }
    };
}

// The key in a scenario is the name in kebab-case; in brackets is the module. Order as in reports.
methods! {
    FourierPublished(fourier_published),
    FourierProjected(fourier_projected),
    CharacteristicPoints(characteristic_points),
    LeastSquares(least_squares),
    IntegralLeastSquares(integral_least_squares),
    OutputError(output_error),
    Srivc(srivc),
    MaximumLikelihood(maximum_likelihood);
    combined: Recommended(recommended),
}

/// Ids of the methods of a usual fit, the best first. Without `srivc`, whose estimate equals `output-error`, and
/// `fourier-published`, whose T is biased even without noise.
pub const DEFAULT_METHODS: [&str; 6] = [
    "output-error",
    "maximum-likelihood",
    "integral-least-squares",
    "least-squares",
    "fourier-projected",
    "characteristic-points",
];

/// Methods of [`DEFAULT_METHODS`] with default settings, the best first.
pub fn default_methods() -> Vec<Box<dyn Identifier>> {
    let all = default_settings().into_iter().map(|settings| settings.build().expect("default settings are valid"));
    let mut methods: Vec<Box<dyn Identifier>> = all.filter(|method| DEFAULT_METHODS.contains(&method.id())).collect();
    methods.sort_by_key(|method| DEFAULT_METHODS.iter().position(|id| *id == method.id()));
    methods
}

#[cfg(test)]
mod tests {
    use crate::fourier_projected::{self, Order};
    use crate::savitzky_golay::SavitzkyGolay;
    use crate::{characteristic_points, fourier_published, least_squares, output_error, srivc};

    use super::IdentifierSettings as Method;

    /// Settings with counts that would exhaust memory or time, extreme numbers, and meaningless values.
    #[test]
    fn settings_out_of_range_are_refused() {
        let published = |settings: fourier_published::Settings| Method::FourierPublished(settings);
        let triples = |triples| published(fourier_published::Settings { triples, ..Default::default() });
        let error = |settings| Method::OutputError(settings);
        let default = output_error::Settings::default;
        let smoothed = |window_samples, order| {
            let smoothing = Some(SavitzkyGolay { window_samples, order });
            Method::LeastSquares(least_squares::Settings { smoothing, ..Default::default() })
        };
        let projected =
            |harmonics| Method::FourierProjected(fourier_projected::Settings { harmonics, ..Default::default() });
        let points = |half_width_s, condition_limit| {
            let default = characteristic_points::Settings::default();
            Method::CharacteristicPoints(characteristic_points::Settings { half_width_s, condition_limit, ..default })
        };
        for (settings, key, value) in [
            (triples(usize::MAX), "triples", "18446744073709551615"),
            (triples(10_001), "triples", "10001"),
            (triples(0), "triples", "0"),
            (smoothed(1_000_000_001, 3), "window-samples", "1000000001"),
            (smoothed(14, 3), "window-samples", "14"),
            (smoothed(3, 3), "window-samples", "3"),
            (smoothed(15, 1), "order", "1"),
            (projected(Order::Fixed(65)), "harmonics.fixed", "65"),
            (projected(Order::Gcv { reach: 1.0 }), "harmonics.reach", "1"),
            (points(Some(-1.0), 1e6), "half-width-s", "-1"),
            (points(None, 0.5), "condition-limit", "0.5"),
            (error(output_error::Settings { iterations: 1001, ..default() }), "iterations", "1001"),
            (error(output_error::Settings { grid_per_decade: 1001, ..default() }), "grid-per-decade", "1001"),
            (
                error(output_error::Settings { smallest_time_constant_s: Some(1e-300), ..default() }),
                "smallest-time-constant-s",
                "1e-300",
            ),
            (Method::Srivc(srivc::Settings { max_iterations: 1001, ..Default::default() }), "max-iterations", "1001"),
        ] {
            let error = settings.build().err().expect("it cannot end");
            assert_eq!((error.key, error.value.as_str()), (key, value), "{error}");
        }
    }
}
