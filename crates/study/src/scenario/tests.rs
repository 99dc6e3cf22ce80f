//! Every number of a scenario is checked: put to NaN it is refused, and the message shows its own key at its own line.

use std::path::Path;

use super::Scenario;

/// Scenarios that together hold every key with a number.
const EVERYTHING: [&str; 5] = [
    "
[ship.first-order]
K-per-s = 0.1
T-s = 16.3
rudder-bias-deg = 0.1
length-m = 105.0
speed-kn = 16.7

[[effect]]
[effect.second_order]
T2-s = 2.0
T3-s = 3.0

[[effect]]
nonlinear_damping.n3-s2-per-deg2 = 0.1

[[effect]]
[effect.wind_moment]
rudder-deg = 1.0
from-deg = 30.0

[manoeuvre.zig-zag]
rudder-deg = 10.0
heading-deg = 20.0
duration-s = 200.0

[steering-gear]
rate-deg-s = 2.5
lag-s = 0.1
dead-time-s = 0.1
dead-band-deg = 0.1
maximum-deg = 35.0

[helmsman]
reads-display-every-s = 1.0
reaction-time-s = 0.5

[approach]
heading-deg = 10.0
yaw-rate-deg-s = 0.1
rudder-deg = 0.5
lead-in-s = 10.0

[recording]
sampling-s = 1.0
duration-s = 270.0
after-execute = 1
offset-s = 1.0

[sensor]
heading-noise-deg = 0.1
heading-quantum-deg = 0.1
heading-lag-s = 0.5
heading-bias-deg = 0.1
yaw-rate-noise-deg-s = 0.1
yaw-rate-bias-deg-s = 0.1
yaw-rate-scale-error = 0.01
rudder-noise-deg = 0.1
rudder-quantum-deg = 0.1
jitter-s = 0.1
heading-delay-s = 0.1

[sensor.drop-out]
probability = 0.1
burst-probability = 0.1
burst-mean-rows = 3.0

[disturbance]
drift-deg-per-s = 0.001
random-walk-deg-per-root-s = 0.01

[disturbance.wind]
moment-deg = 1.0
from-deg = 30.0
speed-m-s = 10.0

[disturbance.wind.gusting]
sd = 0.1
correlation-s = 20.0

[disturbance.gusts]
sd-deg = 0.1
correlation-s = 20.0

[disturbance.squall]
moment-deg = 1.0
start-s = 50.0
duration-s = 30.0
edge-s = 5.0

[disturbance.waves]
sd-deg = 0.2
frequency-rad-s = 0.6
damping = 0.1
",
    "
[ship.second-order]
K-per-s = 0.1
T1-s = 16.3
T2-s = 2.0
T3-s = 3.0
rudder-bias-deg = 0.1
length-m = 105.0
speed-kn = 16.7

[[effect]]
nonlinear_damping.n2-s-per-deg = 0.1

[[effect]]
steering_lag.dead-time-s = 0.5

[[effect]]
rudder_deadband.backlash-deg = 0.5

[[effect]]
[effect.speed_loss]
loss-s-per-deg2 = 0.1
recovery-s = 60.0
gain-exponent = 2.0

[manoeuvre.turning-circle]
rudder-deg = 35.0
duration-s = 600.0

[recording]
sampling-s = 1.0
",
    "
[ship.yukun]

[[effect]]
nonlinear_damping.n11-s-per-deg = 0.1

[[effect]]
steering_lag.first-order-s = 0.5

[[effect]]
rudder_deadband.dead-band-deg = 0.5

[[effect]]
rudder_saturation.c3-per-deg2 = 0.0001

[[effect]]
port_starboard_asymmetry.gain-share = 0.05

[[effect]]
moment_drift.rudder-deg-per-s = 0.01

[manoeuvre.turning-circle]
rudder-deg = 35.0
heading-change-deg = 540.0

[recording]
sampling-s = 1.0
",
    "
[ship.yukun]

[[effect]]
[effect.transient_disturbance]
rudder-deg = 2.0
centre-s = 100.0
duration-s = 30.0

[[effect]]
[effect.wave_yaw]
sd-deg = 0.2
frequency-rad-s = 0.6
damping = 0.1

[manoeuvre.pull-out]
rudder-deg = 35.0
hold-s = 200.0
duration-s = 200.0

[recording]
sampling-s = 1.0
",
    "
[ship.first-order]
K-prime = 1.2
T-prime = 1.1
length-m = 105.0
speed-kn = 16.7

[manoeuvre.zig-zag]
rudder-deg = 10.0
heading-deg = 10.0

[recording]
sampling-s = 1.0
duration-s = 270.0
rudder = \"orders\"
assumed-rudder-rate-deg-s = 2.5

[validation.manoeuvre.zig-zag]
rudder-deg = 20.0
heading-deg = 20.0

[validation.recording]
sampling-s = 1.0
duration-s = 270.0

[stop]
figure = \"rms-K\"
standard-error = 0.1
every = 100

[[draw]]
key = \"ship.first-order.K-prime\"
[draw.normal]
mean = 1.2
sd = 0.1

[[draw]]
key = \"ship.first-order.T-prime\"
[draw.log-normal]
median = 1.2
sigma = 0.1

[[draw]]
key = \"sensor.heading-noise-deg\"
[draw.uniform]
from = 0.1
to = 0.2

[[draw]]
key = \"disturbance.random-walk-deg-per-root-s\"
[draw.log-uniform]
from = 0.1
to = 0.2
",
];

fn parse(text: &str) -> Result<Scenario, String> {
    let text = format!("question = \"?\"\nseed = 1{text}\n[[identifier]]\nmethod.srivc = {{}}\n");
    Scenario::parse(Path::new("all.toml"), "all", text, None).map_err(|failure| failure.message)
}

#[test]
fn every_number_is_checked_and_found_again() {
    for text in EVERYTHING {
        parse(text).unwrap_or_else(|message| panic!("{message}"));
        let lines: Vec<&str> = text.lines().collect();
        for (number, line) in lines.iter().enumerate() {
            let Some((key, value)) = line.rsplit_once(" = ") else { continue };
            if value.parse::<f64>().is_err() || ["after-execute", "every"].contains(&key) {
                continue;
            }
            let changed: Vec<String> = lines
                .iter()
                .enumerate()
                .map(|(other, &text)| if other == number { format!("{key} = nan") } else { text.to_owned() })
                .collect();
            let Err(message) = parse(&changed.join("\n")) else { panic!("`{key} = nan` was accepted in\n{text}") };
            let own = key.rsplit('.').next().expect("a key");
            let place = format!("--> all.toml:{}:", number + 2);
            assert!(message.contains(&place) && message.contains(own), "{key}, expected {place}\n{message}");
            assert!(message.to_lowercase().contains("is nan"), "{key}\n{message}");
        }
    }
}

/// What `study list effects` says can be written in a scenario, and nothing else.
#[test]
fn the_listed_keys_of_an_effect_are_those_it_has() {
    for effect in ship::effects::all() {
        let Some(keys) = super::effect_keys(effect.as_ref()) else { continue };
        let lines: Vec<String> = keys.split(", ").map(|key| format!("{key} = 0.3\n")).collect();
        let text = format!(
            "\n[ship.yukun]\n[[effect]]\n[effect.{}]\n{}[manoeuvre.zig-zag]\nrudder-deg = 10\nheading-deg = 10\n[recording]\n\
             sampling-s = 1\nduration-s = 100",
            effect.id(),
            lines.concat(),
        );
        // 0.3 may be outside its range (no 0.3 s of squall), but every key is known.
        if let Err(message) = parse(&text) {
            assert!(message.contains("` is 0.3"), "{message}");
        }
    }
    let listed = ship::effects::all().iter().filter(|effect| super::effect_keys(effect.as_ref()).is_some()).count();
    assert_eq!(listed, 15, "all forms but measured wind, measured speed and measured sway");
}
