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
