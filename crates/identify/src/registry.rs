//! The methods of the project by name, with their settings as they are written in scenario files.
//!
//! To add a method: a file with its `Settings` and an [`Identifier`], one variant here and one line in
//! [`IdentifierSettings::build`] and [`defaults`]. The contract suite then runs it.

use serde::{Deserialize, Serialize};

use crate::settings::SettingsError;
use crate::{
    Identifier, characteristic_points, fourier_projected, fourier_published, integral_least_squares, least_squares,
    output_error, srivc,
};

/// A method and its settings; the variant is the key in a scenario file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IdentifierSettings {
    /// The Fourier method as printed.
    FourierPublished(fourier_published::Settings),
    /// The Fourier method mended.
    FourierProjected(fourier_projected::Settings),
    /// The traditional method.
    CharacteristicPoints(characteristic_points::Settings),
    /// Regression on derivatives.
    LeastSquares(least_squares::Settings),
    /// Regression on integrals.
    IntegralLeastSquares(integral_least_squares::Settings),
    /// Maximum likelihood by simulation.
    OutputError(output_error::Settings),
    /// Refined instrumental variables.
    Srivc(srivc::Settings),
}

impl IdentifierSettings {
    /// Checks the settings and makes the method.
    pub fn build(&self) -> Result<Box<dyn Identifier>, SettingsError> {
        Ok(match self.clone() {
            Self::FourierPublished(settings) => Box::new(settings.build()?),
            Self::FourierProjected(settings) => Box::new(settings.build()?),
            Self::CharacteristicPoints(settings) => Box::new(settings.build()?),
            Self::LeastSquares(settings) => Box::new(settings.build()?),
            Self::IntegralLeastSquares(settings) => Box::new(settings.build()?),
            Self::OutputError(settings) => Box::new(settings.build()?),
            Self::Srivc(settings) => Box::new(settings.build()?),
        })
    }
}

/// Every method with its default settings, in the order of reports.
pub fn defaults() -> Vec<IdentifierSettings> {
    vec![
        IdentifierSettings::FourierPublished(fourier_published::Settings::default()),
        IdentifierSettings::FourierProjected(fourier_projected::Settings::default()),
        IdentifierSettings::CharacteristicPoints(characteristic_points::Settings::default()),
        IdentifierSettings::LeastSquares(least_squares::Settings::default()),
        IdentifierSettings::IntegralLeastSquares(integral_least_squares::Settings::default()),
        IdentifierSettings::OutputError(output_error::Settings::default()),
        IdentifierSettings::Srivc(srivc::Settings::default()),
    ]
}
