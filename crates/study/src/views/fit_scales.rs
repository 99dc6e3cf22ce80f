//! What `study fit` says of indices without dimension, and of records of several scales.

use report::Table;
use ship::Particulars;
use trial::Quantity;

use super::scale_tables;
use crate::documents::fit::FitDocument;
use crate::scales::scale_name;
use crate::work::every_scale::SPEAKERS;

/// What is said on the screen and on the page, which render tables in their own way: K' and T' of every method, and
/// which terms scale.
pub fn words(file: &FitDocument, ship: Option<Particulars>, render: &dyn Fn(&Table) -> String) -> String {
    let mut text = String::new();
    let rows: Vec<(String, Quantity, Quantity)> = file
        .methods
        .iter()
        .filter_map(|entry| entry.prime.map(|prime| (entry.method.clone(), prime.k, prime.t)))
        .collect();
    if let Some(ship) = ship.filter(|_| !rows.is_empty()) {
        text += &format!("\nprime indices K′ = K L/V, T′ = T V/L with {}\n", scale_name(ship));
        text += &render(&scale_tables::prime_table(&rows));
    }
    let Some(scales) = &file.scales else { return text };
    let speaker = SPEAKERS.iter().find_map(|id| scales.comparisons.iter().find(|one| one.model == *id));
    if let Some(model) = speaker.or(scales.comparisons.first()) {
        text += &format!(
            "\nevery scale alone, {}: {}\n{}",
            model.model,
            scale_tables::sentence(model),
            render(&scale_tables::table(scales, model))
        );
        text += "a first-order response that lacks something differs between manoeuvres, too; `study trace` tells the two apart\n";
    }
    text
}
