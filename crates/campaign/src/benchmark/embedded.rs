//! The benchmark of the project with all texts it names, so that it runs from anywhere.

/// What a definition is called in messages and where its files are looked for.
pub const PLACE: &str = "scenarios/bench/zigzag-bench.toml";

/// The definition.
pub const DEFINITION: &str = include_str!("../../../../scenarios/bench/zigzag-bench.toml");

macro_rules! texts {
    ($($name:literal),+ $(,)?) => {
        &[$(($name, include_str!(concat!("../../../../scenarios/bench/", $name)))),+]
    };
}

/// Files that the definition names, by the names it gives them.
const TEXTS: &[(&str, &str)] = texts![
    "first-order.toml",
    "hulls.toml",
    "missing.toml",
    "../measured/HSVA_CPMC_KVLCC2_Z_20_10_S.trial.toml",
    "../measured/MARIN_FREE_KVLCC2_zz_20_m.trial.toml",
    "../measured/esso_osaka_zigzag_31-Jul-2020_13_57_45.trial.toml",
    "../measured/kvlcc2_hsva.trial.toml",
    "../measured/kvlcc2_marin.trial.toml",
    "../measured/turning_oct14_14_29_49.trial.toml",
    "../measured/turning_oct14_15_06_53.trial.toml",
    "../measured/turning_sep14_13_51_45.trial.toml",
    "../measured/zigzag_13_04_24.trial.toml",
    "../measured/zigzag_13_14_21.trial.toml",
    "../measured/zigzag_13_42_53.trial.toml",
    "../measured/zigzag_13_57_45.trial.toml",
    "../measured/zigzag_14_10_05.trial.toml",
];

/// The text of a file that the definition names.
pub fn text(name: &str) -> Option<&'static str> {
    TEXTS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
