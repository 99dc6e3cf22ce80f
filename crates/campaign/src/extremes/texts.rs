//! Scenarios that together hold every number that can be written.

/// Scenarios that together hold every key with a number.
pub const EVERYTHING: [&str; 5] = [
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
heading-every-rows = 2

[sensor.heading-wander]
sd-deg = 0.1
correlation-s = 10.0

[sensor.heading-spikes]
probability = 0.01
size-deg = 5.0

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
port_starboard_asymmetry.moment-by-drift-s = 0.5

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

[[also]]
[also.manoeuvre.zig-zag]
rudder-deg = 20.0
heading-deg = 20.0

[also.recording]
sampling-s = 1.0
duration-s = 270.0

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

/// Numbers of the study and of its methods, as far as [`EVERYTHING`] has none of them.
pub const OF_STUDY: &str = "
replicates = 3

[ship.yukun]

[manoeuvre.zig-zag]
rudder-deg = 10.0
heading-deg = 10.0
executes = 5

[recording]
sampling-s = 1.0

[sensor]
heading-noise-deg = 0.1
yaw-rate-noise-deg-s = 0.1

[published]
K-per-s = 0.1
T-s = 16.3

[[sweep]]
key = \"sensor.rudder-noise-deg\"
[sweep.linear]
from = 0.1
to = 0.2
points = 2

[[sweep]]
key = \"sensor.heading-quantum-deg\"
[sweep.log]
from = 0.1
to = 0.2
points = 2

[[sweep]]
name = \"point\"
[[sweep.points]]
label = \"one\"
value = 1.0
set = {}

[[identifier]]
label = \"separated\"
[identifier.method.fourier-published]
harmonics = 4
triples = 10
seed = 1
fundamental.fixed-rad-s = 0.02
selection.separated.separation-s = 2.0

[[identifier]]
label = \"well conditioned\"
[identifier.method.fourier-published]
fundamental.record-and-periods = 0.5
[identifier.method.fourier-published.selection.well-conditioned]
condition-limit = 10.0
interior-share = 0.9
rudder-rest-s = 2.0
rudder-rest-deg = 0.5

[[identifier]]
label = \"fixed\"
[identifier.method.fourier-projected]
fundamental.record-lengths = 1.5
harmonics.fixed = 6
skip-s = 1.0
trim-share = 0.05
condition-limit = 1e4

[[identifier]]
label = \"gcv\"
[identifier.method.fourier-projected]
fundamental.best-conditioned.r-squared-loss = 0.01
harmonics.gcv.reach = 4.0

[[identifier]]
label = \"aicc\"
[identifier.method.fourier-projected]
harmonics.aicc.reach = 4.0

[[identifier]]
[identifier.method.characteristic-points]
half-width-s = 3.0
base-course-deg = 1.0
rudder-bias-deg = 0.1
condition-limit = 1e6

[[identifier]]
[identifier.method.least-squares]
longest-gap-s = 5.0
condition-limit = 1e6
[identifier.method.least-squares.smoothing]
window-samples = 15
order = 3

[[identifier]]
[identifier.method.integral-least-squares]
longest-gap-s = 5.0
condition-limit = 1e6

[[identifier]]
[identifier.method.output-error]
grid-per-decade = 8
smallest-time-constant-s = 0.5
iterations = 50

[[identifier]]
label = \"refined\"
[identifier.method.srivc]
max-iterations = 50
relative-step = 1e-9
condition-limit = 1e6
";

/// Numbers of a trace.
pub const OF_TRACE: &str = "
[ship.yukun]

[manoeuvre.zig-zag]
rudder-deg = 10.0
heading-deg = 10.0

[recording]
sampling-s = 1.0
duration-s = 270.0

[[identifier]]
[identifier.trace]
probability = 0.95
monomials = 4
";
