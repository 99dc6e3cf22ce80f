//! Scenarios for tests.

use std::path::Path;

use crate::scenario::Scenario;

/// Scenario from a valid text.
pub fn scenario(text: impl Into<String>) -> Scenario {
    Scenario::parse(Path::new("it.toml"), "it", text.into(), None).unwrap_or_else(|failure| panic!("{failure}"))
}

/// Zig-zag of YUKUN identified by SRIVC, with `replicates` trials and `more` keys.
pub fn zig_zag(replicates: u64, more: &str) -> Scenario {
    scenario(format!(
        "question = \"?\"\nseed = 1\nreplicates = {replicates}\n[ship.yukun]\n[manoeuvre.zig-zag]\nrudder-deg = 10.0\n\
         heading-deg = 10.0\n[recording]\nsampling-s = 1.0\nduration-s = 60.0\n[[identifier]]\nmethod.srivc = {{}}\n{more}"
    ))
}
