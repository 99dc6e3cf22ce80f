//! Settings of a trial as a person writes them: degrees, seconds and their units in the names of the keys. Each is
//! declared once, in one of these files; `build` checks it and gives the specification in SI units and radians.
//!
//! Where the text of a scenario comes from, and where in it a fault stands, is for whoever reads it.

mod disturbance;
mod manoeuvre;
mod numbers;
mod recording;
mod refusal;
mod sensor;
mod steering;
mod trial;

pub use disturbance::{
    DisturbanceSettings, GustSettings, GustingSettings, SquallSettings, WavesSettings, WindSettings,
};
pub use manoeuvre::{ManoeuvreSettings, PullOutSettings, ReplaySettings, TurningCircleSettings, ZigZagSettings};
pub use numbers::{Numbers, is_name_of};
pub use recording::{RecordingSettings, RudderSource};
pub use refusal::SettingError;
pub use sensor::{DropOutSettings, HeadingSpikesSettings, HeadingWanderSettings, SensorSettings};
pub use steering::{ApproachSettings, GearSettings, HelmsmanSettings};
pub use trial::{Assumption, checked};

crate::numbers! {
    ManoeuvreSettings = ZigZag TurningCircle PullOut;
    ZigZagSettings: rudder_deg heading_deg duration_s;
    TurningCircleSettings: rudder_deg duration_s heading_change_deg;
    PullOutSettings: rudder_deg hold_s duration_s;
    GearSettings: rate_deg_s lag_s dead_time_s dead_band_deg maximum_deg;
    HelmsmanSettings: reads_display_every_s reaction_time_s;
    ApproachSettings: heading_deg yaw_rate_deg_s rudder_deg lead_in_s;
    RecordingSettings: sampling_s duration_s offset_s assumed_rudder_rate_deg_s;
    SensorSettings: heading_noise_deg heading_quantum_deg heading_lag_s heading_bias_deg heading_wander
        heading_spikes yaw_rate_noise_deg_s yaw_rate_bias_deg_s yaw_rate_scale_error rudder_noise_deg
        rudder_quantum_deg jitter_s heading_delay_s drop_out;
    HeadingWanderSettings: sd_deg correlation_s;
    HeadingSpikesSettings: probability size_deg;
    DropOutSettings: probability burst_probability burst_mean_rows;
    DisturbanceSettings: wind gusts drift_deg_per_s squall random_walk_deg_per_root_s waves;
    WindSettings: moment_deg from_deg speed_m_s gusting;
    GustingSettings: sd correlation_s;
    GustSettings: sd_deg correlation_s;
    SquallSettings: moment_deg start_s duration_s edge_s;
    WavesSettings: sd_deg frequency_rad_s damping;
}
