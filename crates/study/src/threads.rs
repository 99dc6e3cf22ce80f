//! How many threads the program starts.

use scenario::failure::Failure;

use crate::options::{Common, MOST_THREADS};
use crate::screen;

/// The variable of the environment that says how many threads to start where the command line does not.
const THREADS: &str = "RAYON_NUM_THREADS";

/// How many threads to start on a machine of so many `cores`, and what to say of it, where the `variable` [`THREADS`]
/// is all there is: a number above 0 is meant, anything else is none.
fn threads_of(variable: Option<&str>, cores: usize) -> (usize, Option<String>) {
    let most = MOST_THREADS as usize;
    // Digits alone, so that a number beyond all bounds is one that is too large.
    let digits = variable.filter(|text| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit()));
    match digits.map(|digits| digits.parse().unwrap_or(usize::MAX)) {
        None | Some(0) => (cores.min(most), None),
        Some(asked) if asked <= most => (asked, None),
        Some(_) => {
            let asked = variable.unwrap_or_default();
            (
                most,
                Some(format!(
                    "warning: {THREADS} is {asked}; {most} threads are started, which is the most there can be"
                )),
            )
        }
    }
}

/// Processors that this program may use.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Threads that parallel work gets.
pub fn count(common: &Common) -> usize {
    match common.threads {
        Some(threads) => usize::from(threads),
        None => {
            let (threads, remark) = threads_of(std::env::var(THREADS).ok().as_deref(), cores());
            remark.iter().for_each(|remark| screen::warn(remark));
            threads
        }
    }
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
        let threads = |variable, cores| threads_of(variable, cores).0;
        assert_eq!([None, Some(""), Some("0"), Some("many"), Some("-3")].map(|variable| threads(variable, 8)), [8; 5]);
        assert_eq!((threads(Some("3"), 8), threads(Some("1024"), 8), threads(None, 4000)), (3, 1024, 1024));
        for far in ["1025", "12000", "99999999999999999999999"] {
            let (threads, remark) = threads_of(Some(far), 8);
            let remark = remark.expect("it is said");
            assert!(threads == 1024 && remark.contains(far) && remark.contains("1024"), "{remark}");
        }
    }
}
