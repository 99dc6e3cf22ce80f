mod figures;
mod made_up;
mod measured;

use trial::{Channel, Columns, Trial};

/// Standard deviation of a coefficient.
fn sd(covariance: &[impl AsRef<[f64]>], place: usize) -> f64 {
    covariance[place].as_ref()[place].max(0.0).sqrt()
}

/// A record with its channels changed.
fn changed(trial: &Trial, change: impl Fn(Channel, &[f64]) -> Vec<f64>) -> Trial {
    let channels = trial.channels().chain([(Channel::Rudder, trial.rudder())]);
    let channels = channels.map(|(channel, values)| (channel, change(channel, values))).collect();
    let columns = Columns { time: trial.time().to_vec(), channels, unknown: Vec::new() };
    Trial::new("changed", trial.origin().clone(), columns).expect("a record")
}

/// The record of the ship in the mirror.
fn mirrored(trial: &Trial) -> Trial {
    changed(trial, |channel, values| {
        let is_ahead = [Channel::Surge, Channel::Speed, Channel::North].contains(&channel);
        values.iter().map(|value| if is_ahead { *value } else { -value }).collect()
    })
}
