//! How many threads the program starts.

use campaign::failure::Failure;

use crate::options::{Common, MOST_THREADS};

/// The variable of the environment that says how many threads to start where the command line does not.
const THREADS: &str = "RAYON_NUM_THREADS";

/// Processors that this program may use.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Threads that parallel work gets.
pub fn count(common: &Common) -> usize {
    let variable = std::env::var(THREADS).ok().filter(|text| text.bytes().all(|byte| byte.is_ascii_digit()));
    common.threads.map_or_else(|| threads_of(variable.as_deref(), cores()), usize::from)
}

/// How many threads a machine of so many `cores` starts where the `variable` [`THREADS`] is all that is said: a number
/// above 0 is meant, up to the most that can be asked for.
fn threads_of(variable: Option<&str>, cores: usize) -> usize {
    // Digits beyond all bounds are a number that is too large.
    let asked = variable.filter(|digits| !digits.is_empty()).map(|digits| digits.parse().unwrap_or(usize::MAX));
    asked.filter(|threads| *threads > 0).unwrap_or(cores).min(MOST_THREADS as usize)
}

/// Starts the threads of all parallel work.
pub fn start(common: &Common) -> Result<(), Failure> {
    let threads = count(common);
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::work(format!("failed to start {threads} threads: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_environment_starts_more_threads_than_can_be_asked_for() {
        assert_eq!([None, Some(""), Some("0")].map(|variable| threads_of(variable, 8)), [8; 3]);
        assert_eq!((threads_of(Some("3"), 8), threads_of(None, 4000)), (3, 1024));
        assert_eq!(["1025", "99999999999999999999999"].map(|far| threads_of(Some(far), 8)), [1024; 2]);
    }
}
