//! The numbers of settings by their keys, so that a study can set one that it draws without reading its settings again.

/// Settings that hold numbers.
pub trait Numbers {
    /// Sets the number at a key, given name by name; `false` where there is none, or one that was left out.
    fn set(&mut self, key: &[String], value: f64) -> bool;
}

impl Numbers for f64 {
    fn set(&mut self, key: &[String], value: f64) -> bool {
        if key.is_empty() {
            *self = value;
        }
        key.is_empty()
    }
}

impl<T: Numbers> Numbers for Option<T> {
    fn set(&mut self, key: &[String], value: f64) -> bool {
        self.as_mut().is_some_and(|settings| settings.set(key, value))
    }
}

impl<T: Numbers> Numbers for Vec<T> {
    fn set(&mut self, key: &[String], value: f64) -> bool {
        let Some((index, below)) = key.split_first() else { return false };
        index.parse().ok().and_then(|index: usize| self.get_mut(index)).is_some_and(|item| item.set(below, value))
    }
}

/// Whether a name of a scenario is that of a field: `rate-deg-s` of `rate_deg_s`.
pub fn is_name_of(field: &str, name: &str) -> bool {
    name.bytes().eq(field.bytes().map(|letter| if letter == b'_' { b'-' } else { letter }))
}

/// Implements [`Numbers`]: `Type: field …;` for a table, whose keys are the names of its fields, and
/// `Type = Variant …;` for a choice, whose one key names the variant there is.
#[macro_export]
macro_rules! numbers {
    () => {};
    ($type:ty: $($field:ident)*; $($rest:tt)*) => {
        impl $crate::settings::Numbers for $type {
            fn set(&mut self, key: &[String], value: f64) -> bool {
                let Some((name, below)) = key.split_first() else { return false };
                $(if $crate::settings::is_name_of(stringify!($field), name) {
                    return $crate::settings::Numbers::set(&mut self.$field, below, value);
                })*
                false
            }
        }
        $crate::numbers!($($rest)*);
    };
    ($type:ty = $($variant:ident)*; $($rest:tt)*) => {
        impl $crate::settings::Numbers for $type {
            fn set(&mut self, key: &[String], value: f64) -> bool {
                let Some((_, below)) = key.split_first() else { return false };
                match self {
                    $(Self::$variant(settings) => $crate::settings::Numbers::set(settings, below, value),)*
                    #[allow(unreachable_patterns, reason = "of some choices every variant holds numbers")]
                    _ => false,
                }
            }
        }
        $crate::numbers!($($rest)*);
    };
}

numbers! {
    super::ManoeuvreSettings = ZigZag TurningCircle PullOut;
    super::ZigZagSettings: rudder_deg heading_deg duration_s;
    super::TurningCircleSettings: rudder_deg duration_s heading_change_deg;
    super::PullOutSettings: rudder_deg hold_s duration_s;
    super::GearSettings: rate_deg_s lag_s dead_time_s dead_band_deg maximum_deg;
    super::HelmsmanSettings: reads_display_every_s reaction_time_s;
    super::ApproachSettings: heading_deg yaw_rate_deg_s rudder_deg lead_in_s;
    super::RecordingSettings: sampling_s duration_s offset_s assumed_rudder_rate_deg_s;
    super::SensorSettings: heading_noise_deg heading_quantum_deg heading_lag_s heading_bias_deg heading_wander
        heading_spikes yaw_rate_noise_deg_s yaw_rate_bias_deg_s yaw_rate_scale_error rudder_noise_deg
        rudder_quantum_deg jitter_s heading_delay_s drop_out;
    super::HeadingWanderSettings: sd_deg correlation_s;
    super::HeadingSpikesSettings: probability size_deg;
    super::DropOutSettings: probability burst_probability burst_mean_rows;
    super::DisturbanceSettings: wind gusts drift_deg_per_s squall random_walk_deg_per_root_s waves;
    super::WindSettings: moment_deg from_deg speed_m_s gusting;
    super::GustingSettings: sd correlation_s;
    super::GustSettings: sd_deg correlation_s;
    super::SquallSettings: moment_deg start_s duration_s edge_s;
    super::WavesSettings: sd_deg frequency_rad_s damping;
}
