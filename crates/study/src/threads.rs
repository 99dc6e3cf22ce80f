//! Number of threads of the program.

use campaign::failure::Failure;

use crate::options::{CommonOptions, MAX_THREADS};

/// Environment variable for the number of threads, used if the command line gives none.
const THREADS: &str = "RAYON_NUM_THREADS";

/// Number of processors available to this program.
pub fn core_count() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Number of threads for parallel work: that of the option, else of the environment, else one for every processor.
pub fn thread_count(common: &CommonOptions) -> usize {
    let variable = std::env::var(THREADS).ok().filter(|text| text.bytes().all(|byte| byte.is_ascii_digit()));
    common.threads.map_or_else(|| threads_of(variable.as_deref(), core_count()), usize::from)
}

/// Number of threads on a machine with the given `cores` and this value of the `variable` [`THREADS`]: a number above
/// 0, up to [`MAX_THREADS`]; else `cores`.
fn threads_of(variable: Option<&str>, cores: usize) -> usize {
    // A number too large to parse is above the maximum, too.
    let asked = variable.filter(|digits| !digits.is_empty()).map(|digits| digits.parse().unwrap_or(usize::MAX));
    asked.filter(|threads| *threads > 0).unwrap_or(cores).min(MAX_THREADS as usize)
}

/// Starts the threads of all parallel work. Fails if the system refuses them.
pub fn start_threads(common: &CommonOptions) -> Result<(), Failure> {
    let threads = thread_count(common);
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()
        .map_err(|error| Failure::execution(format!("failed to start {threads} threads: {error}")))
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
