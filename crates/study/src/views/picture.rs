//! Figures as files: names, SVG and PNG.

use campaign::folder::ResultFolder;
use rayon::prelude::*;
use report::Figure;
use scenario::failure::{Failure, OnPath};
pub use scenario::name::slug;

/// Does all of it in parallel and fails with the first failure in order, whichever came first in time.
pub fn first_failure(work: impl IndexedParallelIterator<Item = Result<(), Failure>>) -> Result<(), Failure> {
    work.collect::<Vec<_>>().into_iter().collect()
}

/// Writes SVG and PNG of a figure.
pub fn write_figure(figure: &Figure, folder: &ResultFolder, stem: &str) -> Result<(), Failure> {
    folder.write(&format!("{stem}.svg"), figure.svg())?;
    folder.write(&format!("{stem}.png"), figure.png().on("draw the figure", &folder.path().join(stem))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_failure_in_order_is_told() {
        let work = (0..64).into_par_iter().map(|k| match k {
            // The earlier it is in order, the later it comes.
            8.. => Err(Failure::work(format!("figure {k}"))),
            7 => {
                std::thread::sleep(std::time::Duration::from_millis(5));
                Err(Failure::work("figure 7".to_owned()))
            }
            _ => Ok(()),
        });
        assert_eq!(first_failure(work).map_err(|failure| failure.message), Err("figure 7".to_owned()));
    }
}
