//! Outside estimators of a study: said and looked for before the first trial, given a log, and ended with the study.

use std::path::PathBuf;

use identify::Outside;
use identify::external::shown;
use scenario::failure::Failure;
use scenario::{Method, Scenario, name};

use crate::disk;
use crate::folder::ResultFolder;
use crate::observer::Observer;

/// Most commands that are said one by one.
const MOST_SAID: usize = 10;

/// The outside estimators of a study; when this goes, their processes end.
pub struct RunningEstimators<'a>(Vec<(&'a Method, &'a dyn Outside)>);

impl<'a> RunningEstimators<'a> {
    /// Says which commands will be started. What they say beside their answers goes into `external-LABEL.log` of the
    /// folder. Nothing is started before a trial asks.
    ///
    /// Fails when a program, or a script that it is given, is not there.
    pub fn begin(scenario: &'a Scenario, folder: &ResultFolder, observer: &dyn Observer) -> Result<Self, Failure> {
        let this = Self(scenario.outside());
        for (method, outside) in &this.0 {
            outside.find().map_err(|problem| {
                Failure::input(format!(
                    "the method `{}` runs `{}` in the folder of its scenario, or of the manifest that is run again: {problem}; \
                     a manifest can be copied to where the scenario was",
                    method.label,
                    shown(outside.command())
                ))
            })?;
            keep_log(*outside, &method.label, folder);
        }
        told(scenario).iter().for_each(|line| observer.note(line));
        Ok(this)
    }

    /// Tells of those that were given up since this was asked last.
    pub fn tell(&self, observer: &dyn Observer) {
        self.0.iter().for_each(|(method, outside)| tell(&method.label, *outside, observer));
    }
}

/// Tells, once, that an estimator was given up.
pub(crate) fn tell(label: &str, outside: &dyn Outside, observer: &dyn Observer) {
    outside.notice().iter().for_each(|notice| observer.warn(&format!("{label}: {notice}")));
}

impl Drop for RunningEstimators<'_> {
    fn drop(&mut self) {
        self.0.iter().for_each(|(_, outside)| outside.end());
    }
}

/// Lets what an outside estimator says beside its answers go into `external-LABEL.log` of a folder, up to a bounded
/// size.
pub fn keep_log(outside: &dyn Outside, label: &str, folder: &ResultFolder) {
    let log = folder.path().join(log_of(label));
    outside.log_to(Box::new(move || disk::append(&log)));
}

/// The name of the log of a method.
fn log_of(label: &str) -> PathBuf {
    match name::slug(label).as_str() {
        "" => PathBuf::from("external.log"),
        slug => PathBuf::from(format!("external-{slug}.log")),
    }
}

/// One line for every command that a run of a scenario starts.
pub fn told(scenario: &Scenario) -> Vec<String> {
    let outside = scenario.outside();
    let line = |(method, outside): &(&Method, &dyn Outside)| {
        format!("a run starts `{}` for `{}`", shown(outside.command()), method.label)
    };
    let mut lines: Vec<String> = outside.iter().take(MOST_SAID).map(line).collect();
    if let Some(more) = outside.len().checked_sub(MOST_SAID).filter(|more| *more > 0) {
        lines.push(format!("and {more} more commands"));
    }
    lines
}
