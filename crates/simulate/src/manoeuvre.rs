//! Validation of a manoeuvre, with the scenario keys for error messages.

use trial::manoeuvre::Manoeuvre;

use crate::error::{self, Check, Requirement};
use crate::limits::MAX_EXECUTES;

/// Check of every value of a manoeuvre; fails with the first invalid value.
pub(crate) fn check_manoeuvre(manoeuvre: &Manoeuvre) -> Check {
    let [rudder_key, duration_key] = scenario_keys(manoeuvre);
    if !matches!(manoeuvre, Manoeuvre::Replay { .. }) {
        error::check_positive(rudder_key, manoeuvre.max_rudder())?;
    }
    match manoeuvre {
        Manoeuvre::ZigZag { executes: Some(_), duration: Some(_), .. } => {
            return error::refuse(
                "manoeuvre.zig-zag.duration-s",
                Requirement::OtherKey([
                    "`manoeuvre.zig-zag` has both `executes` and `duration-s`",
                    "expected one end of the manoeuvre",
                    "leave out `executes` or `duration-s`",
                ]),
            );
        }
        Manoeuvre::ZigZag { heading, executes, .. } => {
            error::check_positive("manoeuvre.zig-zag.heading-deg", *heading)?;
            error::check_count("manoeuvre.zig-zag.executes", executes.unwrap_or(1), MAX_EXECUTES)?;
        }
        Manoeuvre::TurningCircle { duration: Some(_), heading_change: Some(_), .. } => {
            return error::refuse(
                "manoeuvre.turning-circle.heading-change-deg",
                Requirement::OtherKey([
                    "`manoeuvre.turning-circle` has both `duration-s` and `heading-change-deg`",
                    "expected one end of the manoeuvre",
                    "leave out `duration-s` or `heading-change-deg`",
                ]),
            );
        }
        Manoeuvre::TurningCircle { duration: None, heading_change: None, .. } => {
            return error::refuse(
                "manoeuvre.turning-circle",
                Requirement::OtherKey([
                    "nothing ends the turning circle",
                    "expected `duration-s` or `heading-change-deg` here",
                    "add a line `heading-change-deg = 540.0`, or one with `duration-s`",
                ]),
            );
        }
        Manoeuvre::TurningCircle { heading_change: Some(angle), .. } => {
            error::check_positive("manoeuvre.turning-circle.heading-change-deg", *angle)?;
        }
        Manoeuvre::PullOut { hold, .. } => error::check_positive_time("manoeuvre.pull-out.hold-s", *hold)?,
        _ => {}
    }
    match manoeuvre {
        Manoeuvre::ZigZag { duration: Some(duration), .. }
        | Manoeuvre::TurningCircle { duration: Some(duration), .. }
        | Manoeuvre::PullOut { duration, .. }
        | Manoeuvre::Williamson { duration, .. } => error::check_positive_time(duration_key, *duration),
        Manoeuvre::Replay { .. } => error::check_positive_time(duration_key, manoeuvre.duration()),
        _ => Ok(()),
    }
}

/// Scenario keys of the rudder angle and of the duration of a manoeuvre.
pub(crate) fn scenario_keys(manoeuvre: &Manoeuvre) -> [&'static str; 2] {
    match manoeuvre {
        Manoeuvre::ZigZag { .. } => ["manoeuvre.zig-zag.rudder-deg", "manoeuvre.zig-zag.duration-s"],
        Manoeuvre::TurningCircle { .. } => {
            ["manoeuvre.turning-circle.rudder-deg", "manoeuvre.turning-circle.duration-s"]
        }
        Manoeuvre::PullOut { .. } => ["manoeuvre.pull-out.rudder-deg", "manoeuvre.pull-out.duration-s"],
        Manoeuvre::Replay { .. } => ["manoeuvre.replay.file"; 2],
        _ => ["manoeuvre.rudder-deg", "manoeuvre.duration-s"],
    }
}
