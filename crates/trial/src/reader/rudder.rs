//! What a sidecar says of the rudder: that it is read late, or that its column is the order.

use ship::Polyline;
use ship::angle::from_deg;

use crate::channel::Channel;
use crate::record::Columns;
use crate::sidecar_keys::RudderKeys;

/// Moves the readings of the rudder in time, and makes an angle of an order; a sentence for what was done.
pub(super) fn describe(columns: &mut Columns, keys: &RudderKeys) -> Vec<String> {
    let mut told = Vec::new();
    let Columns { time, channels, .. } = columns;
    if let Some(late) = keys.late_s {
        for channel in [Channel::Rudder, Channel::RudderOrder] {
            if let Some(values) = channels.get_mut(&channel) {
                *values = earlier(time, values, late);
            }
        }
        told.push(format!("the rudder is taken {late} s earlier than it was read, as the sidecar says"));
    }
    if let Some(rate) = keys.order_rate_deg_s {
        let order = channels.get(&Channel::RudderOrder).or_else(|| channels.get(&Channel::Rudder)).cloned();
        if let Some(order) = order {
            channels.insert(Channel::Rudder, following(time, &order, from_deg(rate)));
            channels.entry(Channel::RudderOrder).or_insert(order);
            told.push(format!("the rudder follows its order at {rate}°/s, as the sidecar says"));
        }
    }
    told
}

/// The values at the same rows if every reading was made `late` seconds before; missing beyond the ends.
fn earlier(time: &[f64], values: &[f64], late: f64) -> Vec<f64> {
    let read = time.iter().copied().zip(values.iter().copied()).filter(|(_, value)| value.is_finite());
    let (times, values): (Vec<f64>, Vec<f64>) = read.unzip();
    let Ok(signal) = Polyline::new(times, values) else { return vec![f64::NAN; time.len()] };
    let ends = signal.times()[0]..=signal.times()[signal.times().len() - 1];
    time.iter().map(|t| t + late).map(|t| if ends.contains(&t) { signal.at(t) } else { f64::NAN }).collect()
}

/// The angle of a gear that follows an order at one rate (rad/s); an order that changes between two rows changes
/// half-way.
fn following(time: &[f64], order: &[f64], rate: f64) -> Vec<f64> {
    let mut last = order.iter().copied().find(|order| order.is_finite()).unwrap_or(f64::NAN);
    let mut angle = last;
    let mut angles = Vec::with_capacity(time.len());
    for row in 0..time.len() {
        let half = if row > 0 { 0.5 * rate * (time[row] - time[row - 1]) } else { 0.0 };
        angle += (last - angle).clamp(-half, half);
        last = if order[row].is_finite() { order[row] } else { last };
        angle += (last - angle).clamp(-half, half);
        angles.push(angle);
    }
    angles
}

#[cfg(test)]
mod tests {
    use ship::angle::to_deg;

    use super::*;

    #[test]
    fn a_late_rudder_is_taken_earlier() {
        let time: Vec<f64> = (0..10).map(f64::from).collect();
        let values: Vec<f64> = time.iter().map(|t| (t - 2.5).max(0.0)).collect();
        let moved = earlier(&time, &values, 2.5);
        assert_eq!(moved[..3], [0.25, 1.0, 2.0]);
        assert!(moved[6] == 6.0 && moved[7].is_nan(), "{moved:?}");
        let back = earlier(&time, &values, -2.0);
        assert!(back[1].is_nan() && back[2] == 0.0 && back[9] == 4.5, "{back:?}");
    }

    #[test]
    fn a_gear_follows_its_order() {
        let time: Vec<f64> = (0..8).map(f64::from).collect();
        let order = [0.0, 10.0, 10.0, 10.0, 10.0, f64::NAN, -10.0, -10.0].map(from_deg);
        let angle = following(&time, &order, from_deg(4.0)).into_iter().map(to_deg);
        let expected = [0.0, 2.0, 6.0, 10.0, 10.0, 10.0, 8.0, 4.0];
        assert!(angle.zip(expected).all(|(angle, expected)| (angle - expected).abs() < 1e-12));
    }
}
